//! Mode B: what the device does with samples that the host made, packet by packet and tick by tick.

use super::requests::Answer;
use super::sample_ring::{FULL, Taken, scaled};
use super::sink::{SampleCount, SampledTick};
use super::{DeviceCore, DeviceSink};
use crate::message::{AckCode, Config, DeviceState};

impl DeviceCore {
    /// Whether this session plays samples (mode B) and not amplitudes.
    pub(super) fn plays_samples(&self) -> bool {
        self.config.mode == Config::SAMPLES
    }

    /// A SAMPLES packet. One that is accepted has no ACK and is as good as a frame for the age.
    pub(super) fn take_samples(&mut self, payload: &[u8]) -> Answer {
        if self.state == DeviceState::Fault {
            return Answer::Ack(AckCode::Faulted);
        }
        let live = self.state.is_live() && self.descent.is_none();
        if !live || !self.plays_samples() {
            return Answer::Ack(AckCode::WrongState);
        }
        let (mask, [low, high]) = (self.config.mask, self.config.comp_limit);
        let peak = half(low.saturating_add(high));
        let is_on = |channel| mask.contains(channel);
        match self.samples.take(self.now_us, payload, peak, is_on) {
            Taken::Odd => Answer::Ack(AckCode::OutOfRange),
            Taken::TooFar => Answer::Ack(AckCode::QueueFull),
            Taken::Yes { clipped, is_late } => {
                self.counters.clipped = self.counters.clipped.wrapping_add(clipped);
                self.counters.late = self.counters.late.wrapping_add(u16::from(is_late));
                self.output.ident = None;
                self.last_frame_us = Some(self.now_us);
                if matches!(self.state, DeviceState::Armed | DeviceState::Ramp) {
                    self.state = DeviceState::Run;
                }
                Answer::Silence
            }
        }
    }

    /// Plays the samples of the millisecond that is over.
    pub(super) fn play_samples(&mut self, sink: &mut impl DeviceSink) {
        let step = half(self.config.slew);
        let (first, samples) =
            self.samples
                .play(self.now_us, step.unsigned_abs(), self.output.gain());
        sink.played(first, samples);
    }

    /// At the start of a tick: tells what the one before brought.
    pub(super) fn report_samples(&mut self, sink: &mut impl DeviceSink) {
        let count = std::mem::take(&mut self.samples.count);
        if count != SampleCount::default() {
            let moment = self.moment();
            sink.sampled(&SampledTick {
                moment,
                count,
                peaks: &self.samples.peaks,
            });
        }
        self.samples.peaks.fill(0);
    }

    /// At the start of a tick: one in which samples were missing is an underrun, and holds.
    pub(super) fn count_missing_samples(&mut self) {
        let missing = self.samples.take_missing();
        if self.last_frame_us.is_none() {
            return;
        }
        self.counters.underrun = self.counters.underrun.wrapping_add(u16::from(missing));
        self.state = match (self.state, missing) {
            (DeviceState::Run, true) => DeviceState::Hold,
            (DeviceState::Hold, false) => DeviceState::Run,
            (state, _) => state,
        };
    }

    /// What sounds, as codes: twice the size of each sample.
    pub(super) fn write_samples_to(&self, codes: &mut [[u16; 2]]) {
        let gain = self.output.gain();
        for (code, value) in codes.iter_mut().zip(self.samples.sounding()) {
            *code = [2 * scaled(*value, gain).unsigned_abs().min(FULL), 0];
        }
    }

    pub(super) fn sample_sum(&self) -> u32 {
        let gain = self.output.gain();
        let sounding = self.samples.sounding().iter();
        let sizes = sounding.map(|value| 2 * u32::from(scaled(*value, gain).unsigned_abs()));
        sizes.sum()
    }
}

/// Half a code: what a sample of 16 bits with a sign can be.
fn half(code: u16) -> i16 {
    i16::try_from(code / 2).unwrap_or(i16::MAX)
}
