//! Mode B in a link: a waveform made of codes, cut to packets, in a ring between owner and writer.

use std::time::{Duration, Instant};

use super::Bridge;
use crate::host::{MAX_TICKS, SentFrame, Waveform};
use crate::link::{QueuedFrame, QueuedSamples, SAMPLE_TICKS};
use crate::message::TICK_US;
use crate::session_log::Note;

const TICK_MS: u32 = TICK_US / 1000;
const TICK: Duration = Duration::from_micros(TICK_US as u64);

/// How samples reach a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampleStream {
    /// Samples a second and channel.
    pub rate_hz: u32,
    /// Samples of each channel in a packet, at most.
    pub per_packet: usize,
    /// What the ring between this program and the port holds at most, ms.
    pub ring_ms: u32,
    /// What the device's own ring holds at most, ms.
    pub device_ring_ms: u32,
}

/// Who makes the samples, and where they go once the device is configured for them.
#[derive(Debug)]
pub(super) struct Sampling {
    wave: Box<dyn Waveform>,
    stream: Option<SampleStream>,
}

impl Bridge {
    /// Plays by samples that `wave` makes wherever the device takes them (mode B): call it before
    /// the first [`poll`](Self::poll). [`sample_stream`](Self::sample_stream) says whether it does.
    pub fn prefer_samples(&mut self, wave: Box<dyn Waveform>) {
        self.session.prefer_samples();
        self.sampling = Some(Sampling { wave, stream: None });
    }

    /// How samples reach the device; `None` where it is sent amplitudes.
    pub fn sample_stream(&self) -> Option<SampleStream> {
        let sampling = self.sampling.as_ref();
        sampling
            .and_then(|sampling| sampling.stream)
            .filter(|_| self.session.plays_samples())
    }

    /// Why a configured device is not played by samples; `None` when it is.
    pub fn no_samples(&self) -> Option<&'static str> {
        let no_ring = (self.sample_stream().is_none()).then_some("samples were not asked for");
        self.session.no_samples().or(no_ring)
    }

    /// The device is configured: makes waveform and ring ready for its rate and its packets.
    pub(super) fn open_samples(&mut self) {
        let Some((sampling, link)) = self.sampling.as_mut().zip(self.link.as_mut()) else {
            return;
        };
        sampling.stream = None;
        let Some(caps) = self.session.caps().filter(|_| self.session.plays_samples()) else {
            return;
        };
        let rate_hz = u32::from(caps.sample_hz);
        let is_ready = sampling.wave.prepare(rate_hz, usize::from(caps.n_ch));
        if !is_ready || !link.open_samples(self.session.sample_packets_per_tick()) {
            return;
        }
        let stream = SampleStream {
            rate_hz,
            per_packet: self.session.samples_per_packet(),
            ring_ms: TICK_MS * u32::try_from(SAMPLE_TICKS).unwrap_or(u32::MAX),
            device_ring_ms: TICK_MS * u32::from(caps.queue),
        };
        sampling.stream = Some(stream);
        self.session.note(
            Instant::now(),
            Note::Said(
                "samples",
                format!(
                    "rate_hz={rate_hz} per_packet={} ring_ms={} device_ring_ms={}",
                    stream.per_packet, stream.ring_ms, stream.device_ring_ms
                ),
            ),
        );
    }

    /// The samples of the coming tick, into the ring; a tick that finds no room there is left out.
    pub(super) fn send_samples(
        &mut self,
        amplitudes_um: &[[f32; 2]],
        stamp: Option<Instant>,
    ) -> Option<SentFrame> {
        let link = self.link.as_mut()?;
        let sampling = self.sampling.as_mut()?;
        sampling.stream?;
        let most = MAX_TICKS * self.session.sample_packets_per_tick();
        if !self.session.state().takes_frames() || !link.has_room(most) {
            return None;
        }
        let now = Instant::now();
        let session = &mut self.session;
        session.play(now, amplitudes_um, sampling.wave.as_mut(), |cut| {
            link.send_samples(&QueuedSamples {
                frame: QueuedFrame {
                    packet: cut.packet,
                    due: cut.due,
                    stamp,
                },
                ends_tick: cut.ends_tick,
                until: now + cut.ahead + TICK,
            });
        })
    }
}
