//! Changes of array profiles, and the walk over the channels of a device.

use crate::bench::arrays::wizard::{Wizard, WizardCommand};
use crate::bench::command::array::ArrayCommand;
use crate::bench::view::BridgePhase;
use crate::bench::{Bench, arrays};
use selvedge_device::ArrayProfile;
use selvedge_engine::Command;

impl Bench {
    pub(crate) fn dispatch_array(&mut self, command: ArrayCommand) {
        match command {
            ArrayCommand::Choose(name) => self.settings.preferences.array = name,
            ArrayCommand::Forget => {
                let name = self.array().name;
                self.device.arrays.forget(&name);
            }
            ArrayCommand::Copy(name) => self.copy_array(&name),
            ArrayCommand::Identify(command) => self.identify(command),
            change => {
                let mut profile = self.array();
                apply(&change, &mut profile);
                self.change_array(profile);
            }
        }
    }

    /// Takes a changed profile in if it makes sense.
    fn change_array(&mut self, profile: ArrayProfile) {
        match profile.check() {
            Ok(()) if profile == self.array() => {}
            Ok(()) => self.device.arrays.keep(profile),
            Err(error) => self.notices.give(error.to_string()),
        }
    }

    fn copy_array(&mut self, name: &str) {
        let name = name.trim();
        if !self.device.arrays.is_free(name) {
            let words = format!("\"{name}\" is the name of an array already; type another");
            self.notices.give(words);
            return;
        }
        let mut profile = self.array();
        name.clone_into(&mut profile.name);
        self.change_array(profile);
        self.settings.preferences.array = Some(name.to_owned());
    }

    fn identify(&mut self, command: WizardCommand) {
        match command {
            WizardCommand::Begin => self.begin_to_identify(),
            WizardCommand::Drive(channel) => {
                if let (Some(wizard), Some(channel)) = (&mut self.device.arrays.wizard, channel) {
                    wizard.walk.ask(channel);
                }
                self.drive_channel();
            }
            WizardCommand::Answer(answer) => {
                let wizard = self.device.arrays.wizard.as_mut();
                if wizard.is_some_and(|wizard| wizard.walk.answer(answer)) {
                    self.drive_channel();
                }
            }
            WizardCommand::Back => {
                if let Some(wizard) = &mut self.device.arrays.wizard {
                    wizard.walk.back();
                }
                self.drive_channel();
            }
            WizardCommand::Keep => {
                let wizard = self.device.arrays.wizard.as_ref();
                let found = wizard.and_then(|wizard| Some((wizard.walk.found()?, wizard.uid)));
                if let Some((found, uid)) = found {
                    let profile = found.in_profile(&self.array(), uid);
                    self.change_array(profile);
                    self.end_to_identify();
                }
            }
            WizardCommand::End => self.end_to_identify(),
        }
    }

    fn begin_to_identify(&mut self) {
        let bridge = self.live.bridge.as_ref();
        let ready = bridge.filter(|bridge| bridge.phase == BridgePhase::Ready);
        let Some(uid) = ready.and_then(|bridge| bridge.uid) else {
            let words = "Channels are identified on a device that is ready and not armed";
            self.notices.give(words);
            return;
        };
        self.device.arrays.wizard = Some(Wizard::new(self.array().n_contactors(), uid));
        self.send(Command::Identify(true));
    }

    /// Drives the channel that is asked for, if the device is armed.
    fn drive_channel(&mut self) {
        let channel = self
            .device
            .arrays
            .wizard
            .as_ref()
            .and_then(|wizard| wizard.walk.channel());
        let channel = channel.and_then(|channel| u16::try_from(channel).ok());
        if let Some(channel) = channel.filter(|_| self.live.takes_ident()) {
            self.send(Command::IdentifyChannel {
                channel,
                amplitude_um: Wizard::amplitude_um(self.array().limit_um[1]),
                duration_ms: arrays::PULSE_MS,
            });
        }
    }

    fn end_to_identify(&mut self) {
        self.device.arrays.wizard = None;
        self.send(Command::Identify(false));
    }
}

/// Changes a profile. Numbers are brought within what a file takes.
fn apply(change: &ArrayCommand, profile: &mut ArrayProfile) {
    let most_ms = f64::from(ArrayProfile::LONGEST_SILENCING_MS);
    match *change {
        ArrayCommand::Limit(band, limit_um) => {
            let band = band.index();
            let most_um = profile.full_scale_um[band];
            profile.limit_um[band] = within(limit_um, 0.0, most_um);
        }
        ArrayCommand::FullScale(band, full_um) => {
            let band = band.index();
            let [least, most] = [
                ArrayProfile::SMALLEST_SCALE_UM,
                ArrayProfile::LARGEST_SCALE_UM,
            ];
            profile.full_scale_um[band] = within(full_um, least, most);
            profile.limit_um[band] = profile.limit_um[band].min(profile.full_scale_um[band]);
        }
        ArrayCommand::Hold(hold_ms) => {
            profile.hold_ms = whole(within(hold_ms, 0.0, most_ms));
            let left = ArrayProfile::LONGEST_SILENCING_MS - profile.hold_ms;
            profile.ramp_ms = profile.ramp_ms.min(left);
        }
        ArrayCommand::Ramp(ramp_ms) => {
            let left_ms = most_ms - f64::from(profile.hold_ms);
            profile.ramp_ms = whole(within(ramp_ms, 0.0, left_ms));
        }
        ArrayCommand::HighVoltage(volts) => {
            let most = f64::from(ArrayProfile::LARGEST_HV_DV);
            profile.hv_dv = Some(whole(within(10.0 * volts, 0.0, most)));
        }
        ArrayCommand::Calibrate(contactor, mut calibration) => {
            let [least, most] = selvedge_device::Calibration::DRIVE_GAIN;
            calibration.drive_gain = calibration.drive_gain.map(|gain| within(gain, least, most));
            profile.set_calibration(contactor, calibration);
        }
        ArrayCommand::LevelOut => {
            for contactor in 0..profile.n_contactors() {
                let level = selvedge_device::Calibration {
                    is_off: profile.calibration_of(contactor).is_off,
                    ..selvedge_device::Calibration::default()
                };
                profile.set_calibration(contactor, level);
            }
        }
        ArrayCommand::WireStraight => profile.wiring = None,
        ArrayCommand::Choose(_)
        | ArrayCommand::Forget
        | ArrayCommand::Copy(_)
        | ArrayCommand::Identify(_) => {}
    }
}

/// The value within its bounds; what is no number is the lower one.
fn within(value: f64, least: f64, most: f64) -> f64 {
    if value.is_nan() {
        least
    } else {
        value.clamp(least, most)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "within 0 and a bound that is a u16"
)]
fn whole(value: f64) -> u16 {
    value.round() as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_device::Calibration;
    use selvedge_textile::tactile::Band;

    fn changed(changes: &[ArrayCommand]) -> ArrayProfile {
        let mut profile = ArrayProfile::default();
        for change in changes {
            apply(change, &mut profile);
            assert!(profile.check().is_ok(), "{change:?}: {profile:?}");
        }
        profile
    }

    #[test]
    fn whatever_is_asked_for_the_profile_stays_one_that_a_file_may_hold() {
        let wild = [
            f64::NAN,
            f64::NEG_INFINITY,
            -1.0,
            0.0,
            33.3,
            1e9,
            f64::INFINITY,
        ];
        for value in wild {
            let gain = Calibration {
                drive_gain: [value; 2],
                is_off: false,
            };
            changed(&[
                ArrayCommand::Limit(Band::Low, value),
                ArrayCommand::FullScale(Band::Low, value),
                ArrayCommand::Hold(value),
                ArrayCommand::Ramp(value),
                ArrayCommand::HighVoltage(value),
                ArrayCommand::Calibrate(3, gain),
                ArrayCommand::Calibrate(99, gain),
            ]);
        }
    }

    #[test]
    fn limits_follow_full_scale_down_and_a_ramp_its_hold() {
        let profile = changed(&[
            ArrayCommand::Limit(Band::High, 30.0),
            ArrayCommand::FullScale(Band::High, 20.0),
            ArrayCommand::Hold(80.0),
        ]);
        assert_eq!(
            (profile.full_scale_um, profile.limit_um),
            ([50.0, 20.0], [50.0, 20.0])
        );
        assert_eq!((profile.hold_ms, profile.ramp_ms), (80, 20));
    }

    #[test]
    fn levelling_out_leaves_dead_contactors_off() {
        let off = Calibration {
            drive_gain: [2.0, 1.0],
            is_off: true,
        };
        let gain = Calibration {
            drive_gain: [1.5, 0.5],
            is_off: false,
        };
        let profile = changed(&[
            ArrayCommand::Calibrate(1, off),
            ArrayCommand::Calibrate(2, gain),
            ArrayCommand::LevelOut,
        ]);
        assert_eq!(profile.calibration_of(2), Calibration::default());
        assert!(profile.calibration_of(1).is_off);
        assert_eq!(profile.calibration_of(1).drive_gain, [1.0; 2]);
    }
}
