//! Lets engine, tuning, sound and device follow the machine.

use std::sync::Arc;

use crate::bench::Bench;
use crate::bench::command::DeviceCommand;
use crate::bench::settings::preferences::{Loudness, SoundPreferences};
use crate::bench::sound::Heard;
use crate::bench::view::BridgePhase;
use crate::tools::stage::act::{Choices, Motion};
use crate::tools::stage::voltage::DeviceState;
use crate::tools::stage::{Stage, ghost};
use selvedge_engine::{Command as EngineCommand, InputSource};

/// How often a device that is lost is asked for, s.
const ASK_S: f64 = 2.0;

/// What the bench was told last.
#[derive(Debug, Default)]
pub(super) struct Told {
    pub(super) motion: Option<Motion>,
    pub(super) choices: Option<Choices>,
    pub(super) trouble: Option<String>,
    pub(super) asked_s: f64,
    /// Whether a device that was permitted to arm is away.
    pub(super) is_resting: bool,
}

impl Stage {
    /// The device, as far as arming goes. What it stopped by itself counts as a failure once.
    pub(super) fn device_state(&mut self, bench: &Bench) -> DeviceState {
        let trouble = &bench.device.trouble;
        if *trouble != self.told.trouble {
            self.told.trouble.clone_from(trouble);
            if trouble.is_some() {
                return DeviceState::Failed;
            }
        }
        match bench.live.bridge.as_ref().map(|bridge| bridge.phase) {
            None | Some(BridgePhase::Opening) => DeviceState::Absent,
            Some(BridgePhase::Ready) => DeviceState::Ready,
            Some(BridgePhase::Armed) => DeviceState::Armed,
            Some(BridgePhase::Broken) => DeviceState::Failed,
        }
    }

    /// Lets engine, tuning and sound follow.
    pub(super) fn follow(&mut self, bench: &mut Bench) {
        let motion = self.machine.motion();
        if self.told.motion != Some(motion) {
            self.told.motion = Some(motion);
            self.move_by(motion, bench);
        }
        let choices = self.machine.choices();
        let before = self.told.choices.replace(choices);
        if before.map(|before| before.same_strength) != Some(choices.same_strength) {
            let mut tuning = bench.document.tuning();
            if choices.same_strength {
                tuning.compression = 1.0;
            }
            bench.send(EngineCommand::SetTuning(tuning));
        }
        bench.settings.preferences.sound = SoundPreferences {
            is_on: true,
            loudness: choices.loudness.unwrap_or(Loudness::Quiet),
            as_driven: false,
        };
        bench.device.sound.of_display = if self.machine.is_heard() {
            Heard::All
        } else {
            Heard::Nothing
        };
    }

    fn move_by(&self, motion: Motion, bench: &mut Bench) {
        let cloths = match motion {
            Motion::Finger => &[],
            Motion::Ghost => &self.cloths[..],
            Motion::Tour(nth) => self.cloths.get(nth..=nth).unwrap_or_default(),
        };
        let Some(path) = ghost::course(cloths) else {
            return bench.send(EngineCommand::SetSource(InputSource::Pointer));
        };
        bench.send(EngineCommand::SetSource(InputSource::Replay(Arc::new(
            path,
        ))));
        bench.send(EngineCommand::SetLoop(motion == Motion::Ghost));
        bench.send(EngineCommand::Play);
    }

    /// Asks for a device that is away, every two seconds. Only the operator permits arming again.
    pub(super) fn ask_for_device(&mut self, now_s: f64, device: DeviceState, bench: &mut Bench) {
        let Some(port) = self.options.port() else {
            return;
        };
        let is_away = match device {
            DeviceState::Failed => true,
            DeviceState::Absent => bench.live.bridge.is_none(),
            DeviceState::Ready | DeviceState::Armed => {
                self.told.is_resting = false;
                false
            }
        };
        if is_away && now_s - self.told.asked_s >= ASK_S {
            self.told.asked_s = now_s;
            bench
                .commands
                .push(DeviceCommand::ConnectPort(port.to_owned()).into());
        }
    }
}
