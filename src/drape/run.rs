//! A scene in motion, seen from outside: in millimetres, step by step.

use super::cloth::{Cloth, DrapeCounters, EXACT};
use super::finger::{Finger, Point};
use super::hands::Hand;
use super::integrator::Integrator;
use super::local::{Local, TICK_S};
use super::mesh::Vector;
use super::pad;
use super::scene::FingerSpec;
use super::{DrapeError, DrapeScene};
use selvedge_foundation::geometry::{Displacement, Rotation};

/// A hanging cloth that is stepped.
#[derive(Debug, Clone)]
pub struct Drape {
    pub(crate) cloth: Cloth,
    specs: Vec<FingerSpec>,
    why: String,
    targets: Vec<Vector>,
    /// How far every point of each finger had slipped a step ago, m.
    slipped_m: Vec<Vec<[f64; 2]>>,
    /// The same for contactors at the last tick of the displays.
    ticked_m: Vec<[[f64; 2]; 24]>,
    newton_before: u64,
    asleep_before: u64,
    /// When steps were last of another length, s, and how many there were by then.
    since: (f64, u64),
    has_back: bool,
    /// What is felt between long steps, and whether it knows of the last one.
    local: (Local, bool),
}

/// The pad of a finger where it is now: a paraboloid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pad {
    /// Its point that is nearest to the cloth, mm.
    pub tip_mm: [f64; 3],
    /// The side of the cloth that it comes from: +1 is the face.
    pub side: f64,
    rotation_deg: f64,
}

impl Pad {
    /// A place of its surface, so far across and along the finger from its tip, mm.
    pub fn at_mm(&self, [across_mm, along_mm]: [f64; 2]) -> [f64; 3] {
        let [a, b] = pad::RADII_M.map(|m| 2e3 * m);
        let sag = across_mm * across_mm / a + along_mm * along_mm / b;
        let turn = Rotation::from_degrees(self.rotation_deg);
        let turned = turn.turn(Displacement::new(across_mm, along_mm));
        let [x, y, z] = self.tip_mm;
        [x + turned.x_mm, y + turned.y_mm, z + self.side * sag]
    }

    /// Where its contactors are, in the display's order, mm.
    pub fn contactors_mm(&self) -> [[f64; 3]; 24] {
        let points: Vec<Vector> = pad::points(self.rotation_deg).collect();
        let mut places = [self.tip_mm; 24];
        for (place, point) in places.iter_mut().zip(pad::contactors()) {
            let off = points[point] * 1e3;
            place[0] += off.x;
            place[1] += off.y;
            place[2] += self.side * off.z;
        }
        places
    }
}

/// What a finger feels after a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FingerRow {
    /// Force on the hand, N.
    pub force_n: [f64; 3],
    /// Points of its pad that feel the cloth.
    pub n_contacts: usize,
    /// How fast these slip over the cloth on average, mm/s of the cloth's own length.
    pub slip_mm_per_s: f64,
    /// Force of the pad across the cloth, N.
    pub press_n: f64,
}

impl Drape {
    /// A scene's cloth where it comes to rest, fingers where they start. An integrator or a step in
    /// s takes the place of the scene's.
    ///
    /// # Errors
    /// A step that cannot be.
    pub fn new(
        scene: &DrapeScene,
        integrator: Option<Integrator>,
        step_s: Option<f64>,
    ) -> Result<Self, DrapeError> {
        let (mut cloth, why) = scene.cloth(integrator, step_s)?;
        if scene.is_hung() && !cloth.settle_to_rest()? {
            let mend = "give another grid, or figures nearer to a cloth's";
            return Err(DrapeError::input("the cloth comes to no rest", mend));
        }
        let slipped = |finger: &Finger| vec![[0.0; 2]; finger.points.len()];
        Ok(Self {
            slipped_m: cloth.fingers().iter().map(slipped).collect(),
            ticked_m: vec![[[0.0; 2]; 24]; scene.fingers().len()],
            specs: scene.fingers().to_vec(),
            targets: vec![Vector::zeros(); scene.fingers().len()],
            newton_before: cloth.counters.newton,
            has_back: scene.surfaces().count() > 1,
            local: (Local::new(&cloth), true),
            asleep_before: cloth.counters.asleep,
            since: (0.0, cloth.counters.steps),
            cloth,
            why,
        })
    }

    /// The hands where the scene lets them start.
    pub fn start_hands(&self) -> Vec<Hand> {
        let hand = |spec: &FingerSpec| Hand {
            centre_mm: spec.start_mm,
            opening_mm: spec.opening_mm,
        };
        self.specs.iter().map(hand).collect()
    }

    /// Puts the fingers where hands are, before the first step: nothing flies there.
    pub fn place(&mut self, hands: &[Hand]) {
        self.aim(hands);
        self.cloth.place_fingers(&self.targets);
        self.local = (Local::new(&self.cloth), true);
    }

    /// Whether its next step can be taken.
    ///
    /// # Errors
    /// An explicit step beyond its limit.
    pub fn holds(&self) -> Result<(), DrapeError> {
        self.cloth.holds()
    }

    /// Takes another cloth where this one is: the clock goes on.
    pub(crate) fn take(&mut self, cloth: Cloth, why: String) {
        self.since = (self.t_s(), cloth.counters.steps);
        self.local = (Local::new(&cloth), false);
        (self.cloth, self.why) = (cloth, why);
    }

    /// Lays it flat, turned about its upper edge, at rest: 0° is where it hung before its weight.
    pub fn tilt(&mut self, degrees: f64) {
        self.cloth.tilt(degrees);
    }

    /// Pulls what holds it along its width so many times as far from the middle as at rest.
    pub fn pull(&mut self, times: f64) {
        self.cloth.pull(times);
    }

    /// The longest explicit step with what is stretched now, s.
    pub fn limit_s(&self) -> f64 {
        self.cloth.limit_s()
    }

    /// What energies are measured by: its weight times its length, J.
    pub fn scale_j(&self) -> f64 {
        self.cloth.system.sheet.scale_j()
    }

    /// Solves implicit steps as far as studies ask, not only as far as is felt.
    pub fn solve_exactly(&mut self) {
        self.cloth.stepping.gain = EXACT;
    }

    /// Iterations of conjugate gradients to a thousandth for the first Newton step of the step that
    /// comes: by the diagonal of each vertex, and with the lines of yarn solved.
    pub fn linear_iterations(&self) -> [u32; 2] {
        let mut ahead = self.cloth.clone();
        ahead.prepare(2);
        let step_s = ahead.stepping.step_s;
        let start = ahead.x.iter().zip(&ahead.v).map(|(x, v)| x + v * step_s);
        let start: Vec<Vector> = start.collect();
        let Cloth { system, newton, .. } = &mut ahead;
        [false, true].map(|lines| newton.iterations(system, &start, lines))
    }

    fn aim(&mut self, hands: &[Hand]) {
        for ((target, spec), hand) in self.targets.iter_mut().zip(&self.specs).zip(hands) {
            *target = spec.target(hand.centre_mm, hand.opening_mm);
        }
    }

    /// Takes a step towards where hands are. Allocates nothing.
    ///
    /// # Errors
    /// An explicit step beyond its limit; nothing has moved then.
    pub fn step(&mut self, hands: &[Hand]) -> Result<(), DrapeError> {
        self.aim(hands);
        for (before, finger) in self.slipped_m.iter_mut().zip(self.cloth.fingers()) {
            for (before, point) in before.iter_mut().zip(&finger.points) {
                *before = point.slipped_m;
            }
        }
        self.newton_before = self.cloth.counters.newton;
        self.asleep_before = self.cloth.counters.asleep;
        self.cloth.step(&self.targets)?;
        self.local.1 = false;
        Ok(())
    }

    /// Between two calls of [`Self::feel`], s.
    pub const FEELS_EVERY_S: f64 = TICK_S;

    /// Leads the fingers alone a millisecond on, by what the cloth answered in its last step: where
    /// steps are longer than that, hands are not to wait for them. Says the forces on the hands, N.
    /// Allocates nothing.
    pub fn feel(&mut self, hands: &[Hand], forces_n: &mut [[f64; 3]]) {
        if !self.has_touch() {
            return forces_n.fill([0.0; 3]);
        }
        self.aim(hands);
        let (local, has_learned) = &mut self.local;
        if !std::mem::replace(has_learned, true) {
            local.learn(&mut self.cloth);
        }
        local.tick(&self.targets, self.cloth.stepping.step_s);
        for (finger, force_n) in forces_n.iter_mut().enumerate() {
            *force_n = local.force_n(finger).into();
        }
    }

    /// Time since the start, s.
    pub fn t_s(&self) -> f64 {
        let (since, steps) = self.since;
        since + Self::after_s(self.cloth.counters.steps - steps, self.step_s())
    }

    /// So many steps, s: by their rate, so that 13 of 2 ms are 0.026 s to the last bit.
    pub fn after_s(n_steps: u64, step_s: f64) -> f64 {
        n_steps as f64 / step_s.recip()
    }

    /// Length of a step, s.
    pub fn step_s(&self) -> f64 {
        self.cloth.stepping.step_s
    }

    /// How it is stepped, and why.
    pub fn integrator(&self) -> (Integrator, &str) {
        (self.cloth.stepping.integrator, &self.why)
    }

    /// Whether fingers touch the cloth: by XPBD and projective dynamics they are only led, and
    /// there are no forces to tell.
    pub fn has_touch(&self) -> bool {
        self.cloth.stepping.integrator.has_touch()
    }

    /// What a finger feels.
    pub fn finger(&self, index: usize) -> FingerRow {
        let Some(finger) = self.cloth.fingers().get(index) else {
            return FingerRow::default();
        };
        let felt = finger.points.iter().zip(&self.slipped_m[index]);
        let felt = felt.filter(|(point, _)| point.is_felt());
        let (mut n_contacts, mut slipped_m) = (0, 0.0);
        for (point, before) in felt {
            n_contacts += 1;
            let moved = [0, 1].map(|axis| point.slipped_m[axis] - before[axis]);
            slipped_m += moved[0].hypot(moved[1]);
        }
        let mean_m = slipped_m / (n_contacts.max(1) as f64);
        FingerRow {
            force_n: finger.force_n().into(),
            n_contacts,
            slip_mm_per_s: 1e3 * mean_m / self.step_s(),
            press_n: finger.press_n(),
        }
    }

    /// The points of a finger's pad, and how far each had slipped a step ago, m.
    pub(crate) fn points(&self, finger: usize) -> Option<(&[Point], &[[f64; 2]])> {
        let points = &self.cloth.fingers().get(finger)?.points;
        Some((points, &self.slipped_m[finger]))
    }

    pub(crate) fn ticked_mut(&mut self, finger: usize) -> &mut [[f64; 2]; 24] {
        &mut self.ticked_m[finger]
    }

    /// Which of the scene's surfaces a finger touches: 0, or 1 where the back is one of its own.
    pub(crate) fn surface(&self, finger: usize) -> usize {
        let finger = self.cloth.fingers().get(finger);
        usize::from(self.has_back && finger.is_some_and(Finger::is_behind))
    }

    /// Whether the last step was left out because everything rests.
    pub fn is_asleep(&self) -> bool {
        self.cloth.counters.asleep > self.asleep_before
    }

    /// The pads of its fingers.
    pub fn pads(&self) -> impl Iterator<Item = Pad> + '_ {
        let n = self.cloth.system.sheet.mesh.n_vertices();
        let tips = self.cloth.x[n..].iter().zip(&self.specs);
        tips.map(|(tip, spec)| Pad {
            tip_mm: (*tip * 1e3).into(),
            side: spec.side,
            rotation_deg: spec.rotation_deg,
        })
    }

    /// What a row of forces holds.
    pub const FORCE_COLUMNS: [&str; 9] = [
        "t_s",
        "finger",
        "fx_n",
        "fy_n",
        "fz_n",
        "n_contacts",
        "slip_mm_per_s",
        "energy_j",
        "iterations",
    ];

    /// The row of a finger after a step; one of no finger where there is none. What is not told of
    /// fingers that touch nothing is no number.
    pub fn force_row(&self, finger: usize, energy_j: f64) -> [f64; 9] {
        let felt = self.finger(finger);
        let [fx_n, fy_n, fz_n] = felt.force_n;
        let slip = felt.slip_mm_per_s;
        let mut told = [fx_n, fy_n, fz_n, felt.n_contacts as f64, slip];
        if !self.has_touch() {
            told = [f64::NAN; 5];
        }
        let [fx_n, fy_n, fz_n, n_contacts, slip] = told;
        let (t_s, finger, iterations) = (self.t_s(), finger as f64, self.iterations() as f64);
        [
            t_s, finger, fx_n, fy_n, fz_n, n_contacts, slip, energy_j, iterations,
        ]
    }

    /// Energy of cloth and fingers, J, and the work that hands did since the start.
    pub fn energy_j(&mut self) -> [f64; 2] {
        [self.cloth.energy_j(), self.cloth.work_j]
    }

    /// Newton steps of the last step.
    pub fn iterations(&self) -> u64 {
        self.cloth.counters.newton - self.newton_before
    }

    /// Vertices along warp and weft.
    pub fn grid(&self) -> [usize; 2] {
        self.cloth.system.sheet.mesh.n
    }

    /// Where the vertices are, mm, row by row along the warp.
    pub fn places_mm(&self) -> impl ExactSizeIterator<Item = [f64; 3]> + '_ {
        let n = self.cloth.system.sheet.mesh.n_vertices();
        self.cloth.x[..n].iter().map(|x| (*x * 1e3).into())
    }

    /// What was done.
    pub fn counters(&self) -> &DrapeCounters {
        &self.cloth.counters
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn the_shipped_cloth_is_pinched_and_let_go() {
        let path =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/scenes/denim.drape.toml");
        let scene = DrapeScene::read(&path).unwrap();
        let mut drape = Drape::new(&scene, None, None).unwrap();
        let places: Vec<[f64; 3]> = drape.places_mm().collect();
        let lowest = places
            .iter()
            .map(|place| place[1])
            .fold(f64::INFINITY, f64::min);
        assert!(
            (-2.0..0.0).contains(&lowest),
            "{lowest} mm: it hangs by its weight"
        );
        let mut hands = drape.start_hands();
        drape.place(&hands);
        let [start_j, _] = drape.energy_j();
        let mut most = 0;
        for step in 0..800 {
            let opening = if step < 600 {
                60.0 - 0.2 * f64::from(step.min(310))
            } else {
                60.0
            };
            for hand in &mut hands {
                hand.opening_mm = opening;
            }
            drape.step(&hands).unwrap();
            most = most.max(drape.finger(0).n_contacts);
            if step == 599 {
                let pushed = [0, 1].map(|finger| drape.finger(finger).force_n[2]);
                assert!(pushed[0] > 0.1 && pushed[1] < -0.1, "{pushed:?}");
                assert!((pushed[0] + pushed[1]).abs() < 0.05, "{pushed:?}");
            }
        }
        assert!(most >= 12, "{most} points felt it");
        assert_eq!(drape.finger(0).n_contacts, 0);
        let [end_j, work_j] = drape.energy_j();
        assert!(
            end_j <= start_j + work_j + 1e-4,
            "{start_j} {end_j} {work_j}"
        );
    }

    #[test]
    fn a_hand_that_starts_closed_has_its_fingers_on_their_own_sides() {
        let scene = DrapeScene::shipped().unwrap();
        let mut drape = Drape::new(&scene, None, None).unwrap();
        let mut hands = drape.start_hands();
        for hand in &mut hands {
            hand.opening_mm = -4.0;
        }
        drape.place(&hands);
        for _ in 0..300 {
            drape.step(&hands).unwrap();
        }
        let pushed = [0, 1].map(|finger| drape.finger(finger).force_n[2]);
        assert!(pushed[0] > 0.1 && pushed[1] < -0.1, "{pushed:?}");
        assert!((pushed[0] + pushed[1]).abs() < 0.05, "{pushed:?}");
    }

    #[test]
    fn a_step_allocates_nothing_with_whatever_method() {
        let path =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/scenes/denim.drape.toml");
        let scene = DrapeScene::read(&path).unwrap();
        for (integrator, step_s) in [
            (Integrator::Explicit, 5e-6),
            (Integrator::ImplicitEuler, 2e-3),
            (Integrator::Bdf2, 2e-3),
            (Integrator::Xpbd, 1e-3),
            (Integrator::Projective, 4e-3),
        ] {
            let mut drape = Drape::new(&scene, Some(integrator), Some(step_s)).unwrap();
            let mut hands = drape.start_hands();
            for hand in &mut hands {
                hand.opening_mm = 0.5;
            }
            drape.place(&hands);
            let (mut contacts, mut forces_n) = ([None; 24], [[0.0; 3]; 2]);
            let mut felt = 0;
            for step in 0..40 {
                let rubbed = 0.05 * f64::from(step);
                for hand in &mut hands {
                    hand.opening_mm = -rubbed;
                }
                hands[0].centre_mm[0] += 0.5;
                assert_no_alloc::assert_no_alloc(|| {
                    drape.step(&hands).unwrap();
                    drape.tick_contacts((0, drape.t_s()), &mut contacts);
                    drape.feel(&hands, &mut forces_n);
                    felt += drape.finger(0).n_contacts + contacts.iter().flatten().count();
                });
            }
            if integrator.has_touch() {
                assert!(felt > 40, "{integrator:?}: {felt}");
                continue;
            }
            // Led through the cloth: nothing is felt, told or put in.
            let row = drape.force_row(0, 0.0);
            assert!(row[2..7].iter().all(|cell| cell.is_nan()), "{row:?}");
            assert_eq!((felt, forces_n), (0, [[0.0; 3]; 2]), "{integrator:?}");
            assert_eq!(drape.energy_j()[1], 0.0, "{integrator:?}");
        }
    }
}
