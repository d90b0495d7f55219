//! Cloths that are drawn by formula, so that the lattice of their pictures is known.

use std::f64::consts::TAU;

use selvedge_foundation::numerics::{Grid, Random};
use selvedge_textile::picture::{Basis, Place};

/// A pattern whose lattice is known.
#[derive(Debug, Clone)]
pub(super) struct Drawing {
    /// Vectors from thread to thread of a weave, or those of the lattice itself.
    frame: Basis,
    pattern: Pattern,
}

#[derive(Debug, Clone)]
enum Pattern {
    Weave(Binding),
    /// Orders of waves, their cosine and sine amplitudes.
    Waves(Vec<([f64; 2], [f64; 2])>),
}

/// A weave: warp end i lies over pick j where `(shift·i + j) mod repeat < over`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Binding {
    /// What people call it.
    pub(super) name: &'static str,
    shift: f64,
    repeat: f64,
    over: f64,
}

const fn binding(name: &'static str, [shift, repeat, over]: [f64; 3]) -> Binding {
    Binding {
        name,
        shift,
        repeat,
        over,
    }
}

/// The weaves that are drawn.
pub(super) const BINDINGS: [Binding; 5] = [
    binding("plain", [1.0, 2.0, 1.0]),
    binding("twill 2/2", [1.0, 4.0, 2.0]),
    binding("twill 3/1", [1.0, 4.0, 3.0]),
    binding("satin of 5", [2.0, 5.0, 1.0]),
    binding("satin of 8", [3.0, 8.0, 1.0]),
];

/// Orders of the waves of an oblique pattern.
const ORDERS: [[f64; 2]; 7] = [
    [1.0, 0.0],
    [0.0, 1.0],
    [1.0, 1.0],
    [1.0, -1.0],
    [2.0, 0.0],
    [0.0, 2.0],
    [2.0, 1.0],
];

fn polar(length: f64, angle: f64) -> Place {
    [length * angle.cos(), length * angle.sin()]
}

impl Binding {
    /// The lattice where threads are `pitch_px` apart, turned by `turn` radians.
    pub(super) fn drawing(self, pitch_px: [f64; 2], turn: f64) -> Drawing {
        let right = std::f64::consts::FRAC_PI_2;
        Drawing {
            frame: Basis::new(polar(pitch_px[0], turn), polar(pitch_px[1], turn + right)),
            pattern: Pattern::Weave(self),
        }
    }

    /// The shorter lattice vector in threads, where both sets are equally far apart.
    pub(super) fn period_threads(self) -> f64 {
        self.drawing([1.0; 2], 0.0).lattice().shorter()
    }
}

impl Drawing {
    /// Waves that repeat by two vectors of any lengths and any angle from 50° to 130°, the first
    /// turned by `turn` radians.
    pub(super) fn oblique(lengths_px: [f64; 2], turn: f64, random: &mut Random) -> Self {
        let between = random.uniform_in(50.0, 130.0).to_radians();
        let frame = Basis::new(
            polar(lengths_px[0], turn),
            polar(lengths_px[1], turn + between),
        )
        .reduced();
        let wave = |order: [f64; 2]| {
            let is_first = order[0].abs() + order[1].abs() < 1.5;
            let most = if is_first { 1.0 } else { 0.5 };
            let amplitude = random.uniform_in(0.3, 1.0) * most;
            (order, polar(amplitude, random.uniform_in(0.0, TAU)))
        };
        Self {
            frame,
            pattern: Pattern::Waves(ORDERS.map(wave).into()),
        }
    }

    /// The two shortest vectors that repeat it, px.
    pub(super) fn lattice(&self) -> Basis {
        match &self.pattern {
            Pattern::Weave(weave) => {
                let first = self.frame.place([1.0, -weave.shift]);
                Basis::new(first, self.frame.place([0.0, weave.repeat])).reduced()
            }
            Pattern::Waves(_) => self.frame.reduced(),
        }
    }

    /// Whether it is a weave.
    pub(super) fn is_weave(&self) -> bool {
        matches!(self.pattern, Pattern::Weave(_))
    }

    /// How bright it is at a place, no unit.
    pub(super) fn at(&self, place: Place) -> f64 {
        let [u, v] = self.frame.coordinates(place);
        match &self.pattern {
            Pattern::Weave(weave) => {
                let inside = |t: f64| 2.0 * (t - t.floor()) - 1.0;
                let (x, y) = (inside(u), inside(v));
                let count = weave.shift * u.floor() + v.floor();
                // Yarns shine along their middle and darken where they dive.
                if count.rem_euclid(weave.repeat) < weave.over {
                    1.0 - 0.9 * x * x - 0.3 * y * y
                } else {
                    0.75 - 0.9 * y * y - 0.3 * x * x
                }
            }
            Pattern::Waves(waves) => {
                let term = |([m, n], [c, s]): &([f64; 2], [f64; 2])| {
                    let turns = TAU * (m * u + n * v);
                    c * turns.cos() + s * turns.sin()
                };
                waves.iter().map(term).sum()
            }
        }
    }

    /// Its brightness on `n` × `n` pixels, each the mean of 3 × 3 places, about 0 and of spread 1.
    /// `moved` says which place of the cloth lies at a place of the picture.
    pub(super) fn drawn(&self, n: usize, moved: impl Fn(Place) -> Place) -> Grid<f64> {
        let mut grid = of_nine(n, |place| self.at(moved(place)));
        standardised(&mut grid);
        grid
    }
}

/// Waves that a cloth lies in, one over the side of its picture.
pub(super) struct Bend {
    turns: f64,
    amplitude_px: f64,
    phases: [f64; 2],
}

impl Bend {
    /// Of a largest local stretch.
    pub(super) fn new(side_px: f64, stretch: f64, random: &mut Random) -> Self {
        let turns = TAU / side_px;
        Self {
            turns,
            amplitude_px: stretch / turns,
            phases: [0; 2].map(|_| random.uniform_in(0.0, TAU)),
        }
    }

    /// Which place of the cloth lies at a place of the picture.
    pub(super) fn at(&self, [x, y]: Place) -> Place {
        let turns = self.turns;
        let across = (turns * y + self.phases[0]).sin() + 0.5 * (turns * x).sin();
        let down = (turns * x + self.phases[1]).sin();
        [x + self.amplitude_px * across, y + self.amplitude_px * down]
    }
}

/// Sums of 3 × 3 places of each of `n` × `n` pixels.
pub(super) fn of_nine(n: usize, at: impl Fn(Place) -> f64) -> Grid<f64> {
    Grid::from_fn(n, n, |column, row| {
        let parts = (0..9_u8).map(|part| {
            let [i, j] = [part % 3, part / 3].map(|i| (f64::from(i) - 1.0) / 3.0);
            at([column as f64 + i, row as f64 + j])
        });
        parts.sum()
    })
}

/// Brings values to a mean of 0 and a standard deviation of 1.
pub(super) fn standardised(grid: &mut Grid<f64>) {
    let n = grid.values().len().max(1) as f64;
    let mean = grid.values().iter().sum::<f64>() / n;
    let square = grid.values().iter().map(|x| (x - mean).powi(2));
    let spread = (square.sum::<f64>() / n).sqrt().max(f64::MIN_POSITIVE);
    for value in grid.values_mut() {
        *value = (*value - mean) / spread;
    }
}
