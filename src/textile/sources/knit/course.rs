//! The path of the yarn through a course of loops.

use std::f64::consts::{PI, TAU};

use super::Knit;
use super::structure::{Pile, Stitch};
use crate::yarns::{Drift, Field, Node, YarnPath, YarnRun, count};
use selvedge_foundation::numerics::Random;

/// The patch is at least this large, mm: the stroke of 20 mm and what the probe touches around it.
const MIN_SIZE_MM: f64 = 22.0;
/// Straight pieces a loop is drawn with.
const PIECES: u8 = 24;
/// Straight pieces a loop of pile is drawn with.
const PILE_PIECES: u8 = 9;

/// The bed of stitches: how many, where, and how they vary.
pub(super) struct Bed<'a> {
    knit: &'a Knit,
    n: [usize; 2],
    pitch_mm: [f64; 2],
    pub(super) size_mm: [f64; 2],
    wales_mm: Vec<f64>,
    courses_mm: Vec<f64>,
    needles_um: Vec<f64>,
    bow: [Drift; 2],
    tension: Field,
    pucker: Field,
}

impl<'a> Bed<'a> {
    pub(super) fn new(knit: &'a Knit, random: &Random) -> Self {
        let repeat = knit.structure.repeat();
        let whole = |per_cm: f64, repeat: usize| {
            count((MIN_SIZE_MM * per_cm / 10.0 / repeat as f64).ceil()) * repeat
        };
        let n = [
            whole(knit.wales_per_cm, repeat[0]),
            whole(knit.courses_per_cm, repeat[1]),
        ];
        let pitch_mm = [10.0 / knit.wales_per_cm, 10.0 / knit.courses_per_cm];
        let size_mm = [n[1] as f64 * pitch_mm[1], n[0] as f64 * pitch_mm[0]];
        let places = |k: usize, purpose: &str| -> Vec<f64> {
            let mut random = random.branch(purpose);
            let place = |i: usize| (i as f64 + knit.pitch_cv * random.normal()) * pitch_mm[k];
            (0..n[k]).map(place).collect()
        };
        let mut needle = random.branch("needles");
        let needles_um = (0..n[0])
            .map(|_| knit.needle_um * needle.normal())
            .collect();
        let mut bow = random.branch("bow");
        Self {
            knit,
            n,
            pitch_mm,
            size_mm,
            wales_mm: places(0, "wales"),
            courses_mm: places(1, "courses"),
            needles_um,
            bow: [0, 1].map(|_| Drift::new(size_mm[0], knit.drift_mm, &mut bow)),
            tension: Field::new(size_mm, knit.drift_mm, &mut random.branch("tension")),
            pucker: Field::new(size_mm, knit.pucker_mm, &mut random.branch("pucker")),
        }
    }

    /// The courses; those of a second bed lie `behind_um` lower and half a wale aside. `facing` is
    /// 1 where face stitches show their legs above, −1 where they show them below.
    pub(super) fn courses(&self, behind_um: f64, facing: f64, random: &Random) -> Vec<YarnPath> {
        let yarn = &self.knit.yarn;
        let bands = yarn.bands(self.size_mm[0], &mut random.branch("bands"));
        let mut run = random.branch("yarns");
        // A loop takes about twice its height and its width in yarn.
        let loop_mm = 2.0 * self.height_mm() + self.pitch_mm[0];
        let course = |course: usize| {
            let length = loop_mm * self.n[0] as f64;
            let run = YarnRun::new(yarn, length, bands.at(self.courses_mm[course]), &mut run);
            let mut nodes = Vec::with_capacity(self.n[0] * usize::from(PIECES) + 1);
            for wale in 0..self.n[0] {
                for k in 0..PIECES {
                    nodes.push(self.node(&run, [wale, course], (k, loop_mm), (behind_um, facing)));
                }
            }
            if let Some(&first) = nodes.first() {
                let w_mm = first.w_mm + self.size_mm[1];
                nodes.push(Node { w_mm, ..first });
            }
            run.path(nodes)
        };
        (0..self.n[1]).map(course).collect()
    }

    /// Height of a loop, mm.
    fn height_mm(&self) -> f64 {
        self.knit.loop_height * self.pitch_mm[1]
    }

    /// A node of the loop on wale and course. With t from 0 (foot) over π (head) to 2π:
    /// `w = W (t/2π + β sin 2t − σ sin t)`, `u = −½ H cos t`, `z = −d cos 2t` on the face.
    fn node(
        &self,
        run: &YarnRun<'_>,
        [wale, course]: [usize; 2],
        (piece, loop_mm): (u8, f64),
        (behind_um, facing): (f64, f64),
    ) -> Node {
        let share = f64::from(piece) / f64::from(PIECES);
        let t = TAU * share;
        let stitch = self.blended(wale, course, share);
        let aside = if behind_um > 0.0 { 0.5 } else { 0.0 };
        let next = self.wales_mm[(wale + 1) % self.n[0]]
            + if wale + 1 == self.n[0] {
                self.size_mm[1]
            } else {
                0.0
            };
        let here = self.wales_mm[wale];
        let across =
            share + aside + self.knit.bulge * (2.0 * t).sin() - self.knit.leg_spread * t.sin();
        let w_mm = here + (next - here) * across;
        let middle = self.courses_mm[course] + self.bow_mm(self.courses_mm[course], w_mm);
        let pull = 1.0 + self.knit.tension_drift * self.tension.at(middle, w_mm);
        let pull = pull.clamp(0.3, 1.7);
        let height = self.height_mm() * stitch.length * (0.5 + 0.5 * pull);
        let u_mm = middle + stitch.shift * self.pitch_mm[1] - 0.5 * height * t.cos();
        let depth = self.knit.loop_depth_um * pull;
        let z_um = stitch.lift * self.knit.relief_um * pull
            - facing * stitch.face * depth * (2.0 * t).cos()
            + self.needles_um[wale] * (0.5 - 0.5 * t.cos())
            + self.knit.pucker_um * self.pucker.at(u_mm, w_mm)
            - behind_um;
        run.node([u_mm, w_mm], z_um, (wale as f64 + share) * loop_mm)
    }

    fn bow_mm(&self, u_mm: f64, w_mm: f64) -> f64 {
        let turn = TAU * w_mm / self.size_mm[1];
        0.001
            * self.knit.bow_um
            * (self.bow[0].at(u_mm) * turn.sin() + self.bow[1].at(u_mm) * turn.cos())
    }

    /// The stitch at a share of the way through it: near its foot it becomes its neighbour.
    fn blended(&self, wale: usize, course: usize, share: f64) -> Stitch {
        let own = self.knit.structure.stitch(wale, course);
        let (beside, apart) = if share < 0.5 {
            ((wale + self.n[0] - 1) % self.n[0], share)
        } else {
            ((wale + 1) % self.n[0], 1.0 - share)
        };
        let other = self.knit.structure.stitch(beside, course);
        // Half of either at the foot, itself from a quarter of the way on.
        let weight = if apart < 0.25 {
            0.25 + 0.25 * (4.0 * PI * apart).cos()
        } else {
            0.0
        };
        let mix = |own: f64, other: f64| own + (other - own) * weight;
        Stitch {
            face: mix(own.face, other.face),
            lift: mix(own.lift, other.lift),
            shift: mix(own.shift, other.shift),
            length: mix(own.length, other.length),
        }
    }

    /// The pile, a loop or a tuft from every stitch, leaning with the nap; none for other
    /// structures.
    pub(super) fn pile(&self, random: &Random) -> Vec<YarnPath> {
        let Some(pile) = self.knit.structure.pile() else {
            return Vec::new();
        };
        let mut random = random.branch("pile");
        let field = Field::new(self.size_mm, 2.5, &mut random);
        let mut paths = Vec::with_capacity(self.n[0] * self.n[1]);
        for course in 0..self.n[1] {
            let run = YarnRun::new(&self.knit.yarn, self.size_mm[1], 0.0, &mut random);
            for wale in 0..self.n[0] {
                let root = [self.courses_mm[course], self.wales_mm[wale]];
                let clump = (self.knit.pile_clump * field.at(root[0], root[1])).exp();
                paths.push(match pile {
                    Pile::Loops => self.pile_loop(&run, root, clump, &mut random),
                    Pile::Cut => self.tuft(&run, root, clump, &mut random),
                });
            }
        }
        paths
    }

    fn pile_loop(
        &self,
        run: &YarnRun<'_>,
        root: [f64; 2],
        clump: f64,
        random: &mut Random,
    ) -> YarnPath {
        let knit = self.knit;
        let height = knit.pile_um * clump * random.uniform_in(0.75, 1.25);
        let lean = [
            0.6 * self.pitch_mm[1] * (1.0 + 0.5 * random.normal()),
            0.5 * self.pitch_mm[0] * random.normal(),
        ];
        let width = 0.45 * self.pitch_mm[0] * random.uniform_in(0.7, 1.3);
        let heading = random.normal() * 0.7;
        let node = |k: u8| {
            let share = f64::from(k) / f64::from(PILE_PIECES);
            let (across, rise) = (-(PI * share).cos(), (PI * share).sin());
            let place = [
                root[0] + lean[0] * rise + width * across * heading.sin(),
                root[1] + lean[1] * rise + width * across * heading.cos(),
            ];
            run.node(place, height * rise, place[1])
        };
        let nodes = (0..=PILE_PIECES).map(node).collect();
        run.path(nodes)
    }

    /// The cut ends of a loop of pile: they bend with the nap and open like a brush.
    fn tuft(&self, run: &YarnRun<'_>, root: [f64; 2], clump: f64, random: &mut Random) -> YarnPath {
        // Shearing leaves less difference in height than loops have.
        let height = self.knit.pile_um * clump * random.uniform_in(0.9, 1.1);
        let lean = [
            self.pitch_mm[1] * (1.0 + 0.3 * random.normal()),
            0.3 * self.pitch_mm[0] * random.normal(),
        ];
        let node = |k: u8| {
            let share = f64::from(k) / f64::from(PILE_PIECES);
            let place = [
                root[0] + lean[0] * share * share,
                root[1] + lean[1] * share * share,
            ];
            let rise = (0.5 * PI * share).sin();
            let mut node = run.node(place, height * rise, place[1]);
            node.half_width_mm *= 0.5 + share;
            node
        };
        let nodes = (0..=PILE_PIECES).map(node).collect();
        run.path(nodes)
    }
}
