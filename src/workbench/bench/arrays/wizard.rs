//! Channels that are being identified: the walk, the device that it is for, and what it last said.

use selvedge_device::wiring::{Answer, WiringWalk};
use selvedge_device::{BridgeEvent, DeviceUid};
use selvedge_foundation::numerics::to_single;

/// Part of the limit at 320 Hz that a channel is driven with.
const SHARE: f64 = 0.5;
/// How long a channel is driven, ms.
pub(crate) const PULSE_MS: u16 = 600;

/// What can be done with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum WizardCommand {
    /// Begin, with a device that is not armed.
    Begin,
    /// Drive the channel that is asked for, or this one, which is asked for again.
    Drive(Option<usize>),
    /// This was felt.
    Answer(Answer),
    /// Ask for the channel before again.
    Back,
    /// Keep what was found in the profile, and end.
    Keep,
    /// End; nothing is kept.
    End,
}

/// A walk over the channels of one device.
#[derive(Debug)]
pub(crate) struct Wizard {
    /// What was said so far.
    pub walk: WiringWalk,
    /// The device.
    pub uid: DeviceUid,
    /// The channel that the device said it drives.
    pub driven: Option<usize>,
    /// Why the last channel was not driven.
    pub trouble: Option<String>,
}

impl Wizard {
    /// A walk over `n` channels of a device, at the first.
    pub(crate) fn new(n: usize, uid: DeviceUid) -> Self {
        Self {
            walk: WiringWalk::new(n),
            uid,
            driven: None,
            trouble: None,
        }
    }

    /// Takes in what the device says.
    pub(crate) fn hear(&mut self, event: &BridgeEvent) {
        match event {
            BridgeEvent::Identified { channel } => {
                self.driven = Some(usize::from(*channel));
                self.trouble = None;
            }
            BridgeEvent::NotIdentified { channel, reason } => {
                self.trouble = Some(format!("Channel {channel}: {reason}"));
            }
            BridgeEvent::Disarmed { .. } => self.driven = None,
            _ => {}
        }
    }

    /// The amplitude that a channel is driven with under this limit at 320 Hz, µm.
    pub(crate) fn amplitude_um(limit_320_um: f64) -> f32 {
        to_single(SHARE * limit_320_um)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_device_says_of_a_channel_is_kept_until_it_is_disarmed() {
        let mut wizard = Wizard::new(3, DeviceUid([1; 12]));
        wizard.hear(&BridgeEvent::NotIdentified {
            channel: 2,
            reason: "no".to_owned(),
        });
        assert_eq!(wizard.trouble.as_deref(), Some("Channel 2: no"));
        wizard.hear(&BridgeEvent::Identified { channel: 2 });
        assert_eq!((wizard.driven, &wizard.trouble), (Some(2), &None));
        wizard.hear(&BridgeEvent::Disarmed {
            by: selvedge_device::DisarmedBy::Host,
            reason: String::new(),
        });
        assert_eq!(wizard.driven, None);
        assert_eq!(Wizard::amplitude_um(50.0), 25.0);
    }
}
