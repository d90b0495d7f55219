//! The hand that leads both fingers: where the pointer is, how far it is open, how far the fingers
//! are shifted against each other.

use selvedge_drape::Hand;

/// How fast it opens and closes, mm/s.
const SPEED_MM_PER_S: f64 = 160.0;
/// Openings that a hand has, mm; below 0 it presses.
pub(crate) const OPENINGS_MM: [f64; 2] = [-10.0, 100.0];
/// Where the second finger begins beside the first, where both are in front, mm.
const BESIDE_MM: f64 = 30.0;
/// The farthest that fingers are shifted, mm.
const MAX_SHIFT_MM: f64 = 150.0;
/// The farthest from the cloth, mm.
const MAX_OFF_MM: f64 = 300.0;

/// A grasp.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Grasp {
    /// Its centre, mm.
    pub(crate) centre_mm: [f64; 3],
    /// How far it is open now, open or closed, mm.
    pub(crate) opening_mm: f64,
    pub(crate) open_mm: f64,
    pub(crate) closed_mm: f64,
    /// From the second finger to the first, mm.
    pub(crate) shift_mm: [f64; 2],
    /// The shift and the height above the plane that it goes back to when it is let go, mm.
    rest_mm: ([f64; 2], f64),
    /// From the pointer to its centre, mm: a drag that shifts or pulls leaves the centre.
    off_mm: [f64; 2],
    /// Whether it closes, by the pointer's button and by a key.
    pub(crate) is_pressed: bool,
    pub(crate) is_held: bool,
}

impl Grasp {
    /// As hands of a scene start.
    pub(crate) fn starting(hands: &[Hand], is_one_sided: bool) -> Self {
        let first = hands.first().copied().unwrap_or_default();
        let beside = if is_one_sided { BESIDE_MM } else { 0.0 };
        Self {
            centre_mm: first.centre_mm,
            opening_mm: first.opening_mm,
            open_mm: first.opening_mm,
            closed_mm: -3.0,
            shift_mm: [beside, 0.0],
            rest_mm: ([beside, 0.0], first.centre_mm[2]),
            off_mm: [0.0; 2],
            is_pressed: false,
            is_held: false,
        }
    }

    /// Whether it closes or is closed.
    pub(crate) fn is_closing(&self) -> bool {
        self.is_pressed || self.is_held
    }

    /// Whether the button is held; let go, the fingers are as they were before they were shifted.
    pub(crate) fn press(&mut self, is_pressed: bool) {
        if std::mem::replace(&mut self.is_pressed, is_pressed) && !is_pressed {
            (self.shift_mm, self.centre_mm[2]) = self.rest_mm;
            self.off_mm = [0.0; 2];
        }
    }

    /// Stays where it is while the pointer goes to a place.
    pub(crate) fn stay(&mut self, pointer_mm: [f64; 2]) {
        self.off_mm = [0, 1].map(|axis| self.centre_mm[axis] - pointer_mm[axis]);
    }

    /// Goes where the pointer leads it.
    pub(crate) fn go_to(&mut self, pointer_mm: [f64; 2]) {
        let [x_mm, y_mm] = [0, 1].map(|axis| pointer_mm[axis] + self.off_mm[axis]);
        let [.., z_mm] = self.centre_mm;
        self.centre_mm = [x_mm, y_mm, z_mm].map(|mm| mm.clamp(-MAX_OFF_MM, 3.0 * MAX_OFF_MM));
    }

    /// Moves along the cloth's plane by so much.
    pub(crate) fn move_by(&mut self, by_mm: [f64; 2]) {
        self.off_mm = [0.0; 2];
        self.go_to([0, 1].map(|axis| self.centre_mm[axis] + by_mm[axis]));
    }

    /// Pulls towards the viewer, or pushes away.
    pub(crate) fn pull_by(&mut self, by_mm: f64) {
        self.centre_mm[2] = (self.centre_mm[2] + by_mm).clamp(-MAX_OFF_MM, MAX_OFF_MM);
    }

    /// Shifts the fingers against each other: rubs between them, or stretches.
    pub(crate) fn shift_by(&mut self, by_mm: [f64; 2]) {
        for (shift, by) in self.shift_mm.iter_mut().zip(by_mm) {
            *shift = (*shift + by).clamp(-MAX_SHIFT_MM, MAX_SHIFT_MM);
        }
    }

    /// Opens farther, or presses less where it is closed.
    pub(crate) fn open_by(&mut self, by_mm: f64) {
        let [least, most] = OPENINGS_MM;
        if self.is_closing() {
            self.closed_mm = (self.closed_mm + by_mm).clamp(least, 10.0);
        } else {
            self.open_mm = (self.open_mm + by_mm).clamp(0.0, most);
        }
    }

    /// Lets time pass.
    pub(crate) fn lead(&mut self, for_s: f64) {
        let to = if self.is_closing() {
            self.closed_mm
        } else {
            self.open_mm
        };
        let most = SPEED_MM_PER_S * for_s;
        self.opening_mm += (to - self.opening_mm).clamp(-most, most);
    }

    /// What its so many fingers do.
    pub(crate) fn hands(&self, n_fingers: usize) -> Vec<Hand> {
        let hand = |nth: usize| {
            let half = [0.5, -0.5][nth.min(1)];
            let [x, y, z] = self.centre_mm;
            Hand {
                centre_mm: [x + half * self.shift_mm[0], y + half * self.shift_mm[1], z],
                opening_mm: self.opening_mm,
            }
        };
        (0..n_fingers).map(hand).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grasp_closes_while_it_is_pressed_and_rubs_by_opposite_shifts() {
        let start = Hand {
            centre_mm: [100.0, 60.0, 0.0],
            opening_mm: 60.0,
        };
        let mut grasp = Grasp::starting(&[start; 2], false);
        grasp.lead(1.0);
        assert_eq!(grasp.hands(2), [start; 2], "nobody presses");
        grasp.press(true);
        grasp.lead(0.1);
        assert!((grasp.opening_mm - 44.0).abs() < 1e-9, "not at once");
        grasp.lead(1.0);
        assert!((grasp.opening_mm + 3.0).abs() < 1e-9);
        grasp.open_by(-2.0);
        grasp.shift_by([8.0, -4.0]);
        grasp.lead(1.0);
        let hands = grasp.hands(2);
        assert_eq!(hands[0].centre_mm, [104.0, 58.0, 0.0]);
        assert_eq!(hands[1].centre_mm, [96.0, 62.0, 0.0]);
        assert!((hands[1].opening_mm + 5.0).abs() < 1e-9);
        grasp.stay([110.0, 60.0]);
        grasp.go_to([112.0, 60.0]);
        assert_eq!(
            grasp.centre_mm,
            [102.0, 60.0, 0.0],
            "a rub leaves the centre"
        );
        grasp.press(false);
        grasp.lead(1.0);
        assert!((grasp.opening_mm - 60.0).abs() < 1e-9, "as open as before");
        assert_eq!(grasp.shift_mm, [0.0; 2]);
        grasp.move_by([1e6, f64::MAX]);
        grasp.pull_by(1e6);
        assert!(grasp.centre_mm.iter().all(|mm| *mm <= 900.0));
        assert_eq!(Grasp::starting(&[start; 2], true).shift_mm, [30.0, 0.0]);
    }
}
