//! The emulated device and contactors that a recorded host's packets are played to.

use std::collections::VecDeque;

use crate::BridgeError;
use crate::actuator_model::{ActuatorModel, ContactorModel};
use crate::device::{DeviceCore, DeviceModel, DeviceSink, Moment};
use crate::framing::{Decoder, LARGEST_BODY};
use crate::message::{
    Ack, Caps, Config, DeviceMessage, DeviceState, LARGEST_CHANNELS, Status, TICK_US,
};

const MS_US: u64 = 1000;
const TICK: u64 = TICK_US as u64;
/// Samples of the contactors to a step of the device's clock.
const SAMPLES_PER_MS: usize = 8;
/// Moments that are remembered, one a ms: what a STATUS may be off by an edge.
const N_MOMENTS: usize = 64;
/// Ticks without drive after which contactors are taken to be at rest.
const SETTLING_TICKS: u32 = 20;

/// What the finger got in one tick, by the emulator and the contactor model.
#[derive(Clone, Debug, PartialEq)]
pub struct ReplayedTick {
    /// Number of the link in its log.
    pub link: u32,
    /// Ticks since the device's boot.
    pub tick: u32,
    /// State from the start of the tick on.
    pub state: DeviceState,
    /// Hold and ramp gain then, 0…1.
    pub gain: f64,
    /// Sum of all output codes then; `None` where the log has no frames.
    pub amp_sum: Option<u32>,
    /// Code of the state, and `amp_sum`, that the device itself told of this tick, if it was heard.
    pub told: Option<(u8, u32)>,
    /// Output codes at the start of the tick, `[40 Hz, 320 Hz]` per channel; empty without frames.
    pub codes: Vec<[u16; 2]>,
    /// Largest distance from rest within the tick per channel, µm, by the model; empty without
    /// frames.
    pub peak_um: Vec<f64>,
}

/// Device, contactors, and what both do.
pub(super) struct Twin {
    core: DeviceCore,
    ear: Ear,
}

/// Listens to the device.
struct Ear {
    link: u32,
    decoder: Decoder,
    /// Without frames in the log nothing is driven.
    has_frames: bool,
    plant: ActuatorModel,
    codes: Vec<[u16; 2]>,
    rail_v: f64,
    n_silent_ticks: u32,
    open: Option<ReplayedTick>,
    ticks: Vec<ReplayedTick>,
    moments: VecDeque<Moment>,
    status: Option<Status>,
    config: Option<Config>,
    acks: Vec<Ack>,
}

impl Twin {
    /// A device with these CAPS.
    ///
    /// # Errors
    /// One line: there can be no such device.
    pub(super) fn new(
        link: u32,
        caps: &Caps,
        contactors: &ContactorModel,
        has_frames: bool,
    ) -> Result<Self, String> {
        let model = model_of(caps)?;
        let n_channels = model.n_channels();
        let contactors = ContactorModel {
            full_scale_v: f64::from(caps.fs_mv) / 1000.0,
            ..*contactors
        };
        let plant = ActuatorModel::new(&contactors, n_channels);
        Ok(Self {
            core: DeviceCore::new(model),
            ear: Ear {
                link,
                decoder: Decoder::new(LARGEST_BODY),
                has_frames,
                plant: plant.map_err(|error: BridgeError| error.to_string())?,
                codes: vec![[0; 2]; n_channels],
                rail_v: 0.0,
                n_silent_ticks: SETTLING_TICKS,
                open: None,
                ticks: Vec::new(),
                moments: VecDeque::with_capacity(N_MOMENTS),
                status: None,
                config: None,
                acks: Vec::new(),
            },
        })
    }

    /// Lets device time pass, µs since its boot.
    pub(super) fn advance(&mut self, device_us: u64) {
        self.core.advance(device_us, &mut self.ear);
    }

    /// Gives it bytes.
    pub(super) fn receive(&mut self, device_us: u64, bytes: &[u8]) {
        self.core.receive(device_us, bytes, &mut self.ear);
    }

    /// Something in it broke, as the device told; the cause is gone at once, so that CLEAR clears.
    pub(super) fn break_down(&mut self, bits: u16) {
        self.core.raise_fault(bits, u16::MAX, 0, &mut self.ear);
        self.core.end_fault_cause(bits);
    }

    /// The STATUS that it sent last, once.
    pub(super) fn take_status(&mut self) -> Option<Status> {
        self.ear.status.take()
    }

    /// The CFG that it sent last, once.
    pub(super) fn take_config(&mut self) -> Option<Config> {
        self.ear.config.take()
    }

    /// The ACKs that it sent since the last call.
    pub(super) fn take_acks(&mut self) -> Vec<Ack> {
        std::mem::take(&mut self.ear.acks)
    }

    pub(super) fn state(&self) -> DeviceState {
        self.core.state()
    }

    /// What the device told of the tick that runs.
    pub(super) fn was_told(&mut self, status: &Status) {
        if let Some(open) = &mut self.ear.open
            && open.tick == status.tick
        {
            open.told = Some((status.state, status.amp_sum));
        }
    }

    /// Ticks that are over.
    pub(super) fn take_ticks(&mut self) -> Vec<ReplayedTick> {
        std::mem::take(&mut self.ear.ticks)
    }

    /// The same at the end, with the tick that runs.
    pub(super) fn finish(&mut self) -> Vec<ReplayedTick> {
        let tick_end = (u64::from(self.core.tick()) + 1) * TICK;
        self.advance(tick_end.saturating_sub(1));
        self.ear.close();
        self.take_ticks()
    }

    /// Every moment from `before_us` before now until as long after it, as far as nothing arrives.
    pub(super) fn moments(&self, before_us: u64, after_us: u64) -> Vec<Moment> {
        let now_us = self.core.moment().dev_us;
        let since_us = now_us.saturating_sub(before_us);
        let past = self.ear.moments.iter();
        let mut moments: Vec<Moment> = past
            .filter(|moment| moment.dev_us >= since_us)
            .copied()
            .collect();
        let mut ahead = self.core.clone();
        for step in 1..=after_us / MS_US {
            ahead.advance(now_us + step * MS_US, &mut Vec::new());
            moments.push(ahead.moment());
        }
        moments
    }
}

impl Ear {
    fn close(&mut self) {
        if let Some(mut tick) = self.open.take() {
            let reading = self.plant.reading();
            if self.has_frames && self.n_silent_ticks < SETTLING_TICKS {
                let peaks = reading.contactors.iter().map(|one| one.peak_um);
                tick.peak_um = peaks.collect();
            } else if self.has_frames {
                tick.peak_um = vec![0.0; self.codes.len()];
            }
            self.ticks.push(tick);
        }
    }

    /// The tick that begins now.
    fn begin(&mut self, device: &DeviceCore) {
        let moment = device.moment();
        let is_driven = self.codes.iter().any(|codes| *codes != [0; 2]);
        self.n_silent_ticks = if is_driven {
            0
        } else {
            self.n_silent_ticks.saturating_add(1)
        };
        if self.n_silent_ticks >= SETTLING_TICKS {
            self.plant.rest();
        }
        self.open = Some(ReplayedTick {
            link: self.link,
            tick: moment.tick,
            state: moment.state,
            gain: moment.gain,
            amp_sum: self.has_frames.then_some(moment.amp_sum),
            told: None,
            codes: if self.has_frames {
                self.codes.clone()
            } else {
                Vec::new()
            },
            peak_um: Vec::new(),
        });
    }
}

impl DeviceSink for Ear {
    fn packet(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            let Some(packet) = self.decoder.push(byte) else {
                continue;
            };
            match DeviceMessage::decode(&packet, self.codes.len()) {
                Ok(DeviceMessage::Status(status)) => self.status = Some(status),
                Ok(DeviceMessage::Cfg(config)) => self.config = Some(config),
                Ok(DeviceMessage::Ack(ack)) => self.acks.push(ack),
                _ => {}
            }
        }
    }

    /// What was put out until now is played, what is put out now comes next.
    fn stepped(&mut self, device: &DeviceCore) {
        let moment = device.moment();
        if self.moments.len() == N_MOMENTS {
            self.moments.pop_front();
        }
        self.moments.push_back(moment);
        let is_moving = self.has_frames && self.n_silent_ticks < SETTLING_TICKS;
        if is_moving && self.open.is_some() {
            self.plant.run(&self.codes, self.rail_v, SAMPLES_PER_MS);
        }
        let is_tick = moment.dev_us.is_multiple_of(TICK);
        if is_tick {
            self.close();
        }
        device.write_output(&mut self.codes);
        self.rail_v = device.rail_v();
        if is_tick {
            self.begin(device);
        }
    }
}

/// The device that says this of itself.
fn model_of(caps: &Caps) -> Result<DeviceModel, String> {
    let n_channels = usize::from(caps.rows) * usize::from(caps.cols);
    let (n_ch, rows, cols) = (caps.n_ch, caps.rows, caps.cols);
    if n_channels != usize::from(n_ch) || n_channels == 0 || n_channels > LARGEST_CHANNELS {
        return Err(format!(
            "CAPS of {rows} × {cols} contactors and {n_ch} channels: no emulator can be so"
        ));
    }
    if caps.version != 1 || caps.n_comp != 2 || caps.tick_us != TICK_US {
        return Err(String::from(
            "CAPS of another protocol: no emulator can be so",
        ));
    }
    Ok(DeviceModel {
        rows,
        cols,
        pitch_um: caps.pitch_um,
        queue: caps.queue,
        modes: caps.modes,
        slew_max: caps.slew_max,
        comp_limit: caps.comp_limit,
        max_body: caps.max_body,
        hv_max_dv: caps.hv_max_dv,
        ..DeviceModel::default()
    })
}
