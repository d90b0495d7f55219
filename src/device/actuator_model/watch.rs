//! From a running emulator to whoever looks at its contactors: readings one way, models the other.
//!
//! Only the latest matters of both, so both are triple buffers. While nobody looks nothing is
//! computed: the actuators wait at rest.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use triple_buffer::{Input, Output, triple_buffer};

use super::{ActuatorModel, ActuatorReading, ContactorModel, SAMPLES_PER_TICK};
use crate::device::{DeviceCore, Load};
use crate::message::DeviceState;

/// Samples of the device's 1 ms clock.
const SAMPLES_PER_MS: usize = 8;
/// One step of the device's clock, µs.
const MS_US: u64 = 1000;
/// Steps of the device's clock in a tick.
const MS_PER_TICK: u64 = (SAMPLES_PER_TICK / SAMPLES_PER_MS) as u64;

/// The end of who looks.
pub struct ActuatorWatch {
    is_looking: Arc<AtomicBool>,
    readings: Output<ActuatorReading>,
    models: Input<ContactorModel>,
    model: ContactorModel,
}

/// The end of the device.
pub(crate) struct ActuatorFeed {
    is_looked_at: Arc<AtomicBool>,
    readings: Input<ActuatorReading>,
    models: Output<ContactorModel>,
    n_contactors: usize,
    load: Load,
    /// Made when somebody looks for the first time; `None` also where the model is refused.
    actuators: Option<Box<ActuatorModel>>,
    codes: Vec<[u16; 2]>,
    next_codes: Vec<[u16; 2]>,
    rail_v: f64,
    /// Up to when the actuators were stepped, µs of the device; `None` while nobody looks.
    until_us: Option<u64>,
}

/// Both ends for an array of `n_contactors`; nobody looks yet.
pub(crate) fn actuator_watch(
    model: ContactorModel,
    n_contactors: usize,
) -> (ActuatorFeed, ActuatorWatch) {
    let is_looking = Arc::new(AtomicBool::new(false));
    let (readings_in, readings) = triple_buffer(&ActuatorReading::new(n_contactors));
    let (models, models_out) = triple_buffer(&model);
    let feed = ActuatorFeed {
        is_looked_at: Arc::clone(&is_looking),
        readings: readings_in,
        models: models_out,
        n_contactors,
        load: model.load(),
        actuators: None,
        codes: vec![[0; 2]; n_contactors],
        next_codes: vec![[0; 2]; n_contactors],
        rail_v: 0.0,
        until_us: None,
    };
    let watch = ActuatorWatch {
        is_looking,
        readings,
        models,
        model,
    };
    (feed, watch)
}

impl ActuatorWatch {
    /// Whether readings are wanted from now on.
    pub fn look(&self, is_looking: bool) {
        self.is_looking.store(is_looking, Ordering::Relaxed);
    }

    /// Whether they are.
    pub fn is_looking(&self) -> bool {
        self.is_looking.load(Ordering::Relaxed)
    }

    /// The latest reading; of 0 ticks before the first.
    pub fn reading(&mut self) -> &ActuatorReading {
        self.readings.read()
    }

    /// What is assumed of the contactors.
    pub fn model(&self) -> &ContactorModel {
        &self.model
    }

    /// Assumes something else from the next tick on. A model that fails its check is ignored there.
    pub fn set_model(&mut self, model: ContactorModel) {
        self.model = model;
        self.models.write(model);
    }
}

impl ActuatorFeed {
    /// What the contactors take of their amplifiers, by the model that the feed was made with:
    /// whoever looks, and whatever finger is laid on them since, the device tells the same.
    pub(crate) fn load(&self) -> Load {
        self.load
    }

    /// A device has done a step of its 1 ms clock: what it put out until then is played, what it
    /// puts out now comes next.
    ///
    /// While nothing changes that is done once a tick, after its STATUS is on its way.
    pub(crate) fn stepped(&mut self, device: &DeviceCore) {
        if !self.is_looked_at.load(Ordering::Relaxed) {
            if self.until_us.take().is_some() {
                self.rail_v = 0.0;
                self.codes.fill([0; 2]);
            }
            return;
        }
        let now_us = device.moment().dev_us;
        device.write_output(&mut self.next_codes);
        let rail_v = device.rail_v();
        let is_same = self.next_codes == self.codes && rail_v.to_bits() == self.rail_v.to_bits();
        let is_tick = now_us.is_multiple_of(MS_PER_TICK * MS_US);
        if is_same && !is_tick {
            return;
        }
        self.play(now_us, device.state());
        self.codes.copy_from_slice(&self.next_codes);
        self.rail_v = rail_v;
        if let Some(actuators) = &mut self.actuators {
            actuators.set_state(device.state());
        }
    }

    /// Steps the actuators up to now. A device that slept was silent meanwhile.
    fn play(&mut self, now_us: u64, state: DeviceState) {
        let is_changed = self.models.updated();
        if self.actuators.is_none() || is_changed {
            self.remodel();
        }
        let Some(actuators) = &mut self.actuators else {
            return;
        };
        let now_ms = now_us / MS_US;
        let last_ms = self.until_us.replace(now_us).map(|us| us / MS_US);
        let passed_ms = last_ms.and_then(|last_ms| now_ms.checked_sub(last_ms));
        let behind_ms = passed_ms
            .filter(|passed| *passed <= 2 * MS_PER_TICK)
            .unwrap_or_else(|| {
                actuators.rest();
                actuators.set_state(state);
                now_ms % MS_PER_TICK
            });
        let behind = usize::try_from(behind_ms).unwrap_or(0) * SAMPLES_PER_MS;
        if actuators.run(&self.codes, self.rail_v, behind) {
            self.readings
                .input_buffer_mut()
                .copy_from(actuators.reading());
            self.readings.publish();
        }
    }

    /// Makes the actuators of the model that is wanted. One that is refused leaves the last.
    fn remodel(&mut self) {
        let model = *self.models.read();
        match &mut self.actuators {
            Some(actuators) => drop(actuators.set_model(&model)),
            None => {
                self.actuators = ActuatorModel::new(&model, self.n_contactors)
                    .map(Box::new)
                    .ok();
            }
        }
    }
}

impl fmt::Debug for ActuatorWatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PlantWatch")
            .field("is_looking", &self.is_looking())
            .finish_non_exhaustive()
    }
}

impl fmt::Debug for ActuatorFeed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PlantFeed")
            .field("n_contactors", &self.n_contactors)
            .finish_non_exhaustive()
    }
}
