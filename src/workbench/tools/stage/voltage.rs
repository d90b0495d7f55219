//! When high voltage may be on: only while the operator permits it, only for a visitor who holds a
//! button for a second, and never longer than 20 s after the finger has left. Pure.

/// How long the button is held before the array is armed, s.
pub(crate) const HOLD_S: f64 = 1.0;
/// How long after the last touch it stays armed, s.
const LIFTED_S: f64 = 20.0;
/// A device that is not armed by then is not to arm later by itself, s.
const ANSWER_S: f64 = 3.0;

/// The device, as far as arming goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum DeviceState {
    /// None, or on its way.
    #[default]
    Absent,
    /// It may be armed.
    Ready,
    /// High voltage is on, or about to be.
    Armed,
    /// It refused, failed, or is gone.
    Failed,
}

/// What is asked of the device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Switch {
    /// High voltage on.
    Arm,
    /// High voltage off.
    Disarm,
}

/// The rules, and how it stands with them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Voltage {
    /// Whether the operator permits arming.
    is_permitted: bool,
    /// Since when the button is held, s.
    held_since_s: Option<f64>,
    /// When this visit asked for high voltage, s.
    asked_s: Option<f64>,
    /// Whether the device has answered by arming.
    was_armed: bool,
    /// When a finger was down last, s.
    touched_s: f64,
}

impl Voltage {
    /// The operator permits arming, or no longer.
    pub(crate) fn permit(&mut self, is_permitted: bool) {
        self.is_permitted = is_permitted;
    }

    pub(crate) fn is_permitted(&self) -> bool {
        self.is_permitted
    }

    /// Whether this visit asked for high voltage.
    pub(crate) fn has_asked(&self) -> bool {
        self.asked_s.is_some()
    }

    /// The button is held from now on, or no longer.
    pub(crate) fn hold(&mut self, now_s: f64, is_held: bool) {
        if !is_held {
            self.held_since_s = None;
        } else if self.held_since_s.is_none() {
            self.held_since_s = Some(now_s);
        }
    }

    /// How much of the second is over, 0…1.
    pub(crate) fn held_share(&self, now_s: f64) -> f64 {
        let held = self.held_since_s.map(|since_s| (now_s - since_s) / HOLD_S);
        held.map_or(0.0, |share| share.clamp(0.0, 1.0))
    }

    /// Forgets what the visit asked for: the next one has to ask anew.
    pub(crate) fn release(&mut self) {
        self.held_since_s = None;
        self.asked_s = None;
        self.was_armed = false;
    }

    /// What to ask of the device now. `has_visitor`: a visit is under way; `is_down`: a finger is.
    pub(crate) fn step(
        &mut self,
        now_s: f64,
        device: DeviceState,
        (has_visitor, is_down): (bool, bool),
    ) -> Option<Switch> {
        if is_down || self.held_since_s.is_some() {
            self.touched_s = now_s;
        }
        if device == DeviceState::Failed {
            self.is_permitted = false;
        }
        if device != DeviceState::Ready || !has_visitor || !self.is_permitted {
            // What was held before may not arm later.
            self.held_since_s = None;
        }
        let is_armed = device == DeviceState::Armed;
        if self.asked_s.is_some() {
            self.was_armed |= is_armed;
            let is_over = self.was_armed && !is_armed;
            let waited_s = now_s - self.asked_s.unwrap_or(now_s);
            let is_unanswered = !self.was_armed && waited_s > ANSWER_S;
            let is_left = now_s - self.touched_s >= LIFTED_S;
            if is_over || is_unanswered || is_left || !has_visitor || !self.is_permitted {
                self.release();
                return Some(Switch::Disarm);
            }
            return None;
        }
        if is_armed {
            // Nobody of this visit asked for it.
            return Some(Switch::Disarm);
        }
        let is_due = self.held_share(now_s) >= 1.0;
        if is_due && self.is_permitted && has_visitor && device == DeviceState::Ready {
            self.held_since_s = None;
            self.asked_s = Some(now_s);
            return Some(Switch::Arm);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps of a tenth of a second from `from_s` to `to_s`; what was asked, and when.
    fn run(
        voltage: &mut Voltage,
        (from_s, to_s): (f64, f64),
        device: DeviceState,
        hand: (bool, bool),
    ) -> Vec<(f64, Switch)> {
        let mut asked = Vec::new();
        let mut now_s = from_s;
        while now_s < to_s {
            asked.extend(voltage.step(now_s, device, hand).map(|asks| (now_s, asks)));
            now_s = (10.0 * now_s).round() / 10.0 + 0.1;
        }
        asked
    }

    fn permitted() -> Voltage {
        let mut voltage = Voltage::default();
        voltage.permit(true);
        voltage
    }

    #[test]
    fn a_second_of_holding_arms_once_and_only_with_permission() {
        for (is_permitted, expected) in [(false, 0), (true, 1)] {
            let mut voltage = Voltage::default();
            voltage.permit(is_permitted);
            voltage.hold(0.0, true);
            let asked = run(&mut voltage, (0.0, 2.5), DeviceState::Ready, (true, true));
            assert_eq!(asked.len(), expected, "{asked:?}");
            assert!(
                asked
                    .iter()
                    .all(|(at, asks)| *at >= 1.0 && *asks == Switch::Arm)
            );
        }
        let mut voltage = permitted();
        voltage.hold(0.0, true);
        assert_eq!(
            run(&mut voltage, (0.0, 0.9), DeviceState::Ready, (true, true)),
            []
        );
        voltage.hold(0.9, false);
        voltage.hold(1.0, true);
        let asked = run(&mut voltage, (1.0, 1.9), DeviceState::Ready, (true, true));
        assert_eq!(asked, [], "it was let go in between");
    }

    #[test]
    fn off_twenty_seconds_after_the_finger_and_with_the_visit() {
        let armed = |voltage: &mut Voltage| {
            voltage.hold(0.0, true);
            let asked = run(voltage, (0.0, 1.2), DeviceState::Ready, (true, true));
            assert_eq!(asked.len(), 1);
            voltage.hold(1.2, false);
        };
        let mut voltage = permitted();
        armed(&mut voltage);
        let asked = run(&mut voltage, (1.3, 10.0), DeviceState::Armed, (true, true));
        assert_eq!(asked, [], "as long as a finger is down");
        let asked = run(
            &mut voltage,
            (10.0, 40.0),
            DeviceState::Armed,
            (true, false),
        );
        let (at_s, asks) = asked[0];
        assert!(
            asks == Switch::Disarm && (29.0..30.2).contains(&at_s),
            "{at_s}"
        );
        let mut voltage = permitted();
        armed(&mut voltage);
        run(&mut voltage, (1.3, 3.0), DeviceState::Armed, (true, true));
        let asked = run(&mut voltage, (3.0, 3.1), DeviceState::Armed, (false, false));
        assert_eq!(asked[0].1, Switch::Disarm, "the visit is over");
    }

    #[test]
    fn a_fault_takes_the_permission_and_what_armed_by_itself_is_disarmed() {
        let mut voltage = permitted();
        voltage.hold(0.0, true);
        run(&mut voltage, (0.0, 1.2), DeviceState::Ready, (true, true));
        run(&mut voltage, (1.2, 2.0), DeviceState::Armed, (true, true));
        let asked = run(&mut voltage, (2.0, 2.1), DeviceState::Failed, (true, true));
        assert_eq!(asked[0].1, Switch::Disarm);
        assert!(!voltage.is_permitted());
        voltage.hold(2.2, true);
        let asked = run(&mut voltage, (2.2, 9.0), DeviceState::Ready, (true, true));
        assert_eq!(asked, [], "not before the operator permits it again");
        for mut voltage in [permitted(), Voltage::default()] {
            let asked = voltage.step(0.0, DeviceState::Armed, (true, true));
            assert_eq!(asked, Some(Switch::Disarm), "nobody asked for it");
        }
    }

    #[test]
    fn what_was_stopped_or_never_answered_does_not_arm_by_itself() {
        for then in [DeviceState::Ready, DeviceState::Absent] {
            let mut voltage = permitted();
            voltage.hold(0.0, true);
            run(&mut voltage, (0.0, 1.2), DeviceState::Ready, (true, true));
            voltage.hold(1.2, false);
            let asked = run(&mut voltage, (1.2, 60.0), then, (true, true));
            assert_eq!(asked.len(), 1, "{asked:?}");
            assert_eq!(asked[0].1, Switch::Disarm);
        }
    }
}
