//! Displacements of bent cloth: found knot by knot, and brought to little bending.

use super::super::basis::{Basis, Place, dot, length, mix};
use super::super::source::between;
use super::Unwarped;
use super::pattern::{Local, Pattern};
use selvedge_foundation::numerics::{Grid, extent, in_pieces, to_index};

/// Knots each way at most.
const MAX_KNOTS: f64 = 64.0;
/// How much bending costs, and sweeps that make the field smooth.
const STIFFNESS: f64 = 0.3;
const N_SWEEPS: usize = 120;

/// Displacements at knots.
#[derive(Clone)]
pub(super) struct Field {
    apart_px: f64,
    off: Grid<Place>,
}

/// Displacements and how far each is believed.
pub(super) struct Found {
    pub(super) field: Field,
    weights: Grid<f64>,
}

impl Field {
    pub(super) fn level(luminance: &Grid<f64>, pattern: &Pattern) -> Self {
        let size = [luminance.width(), luminance.height()].map(|n| n as f64);
        let apart_px = (0.5 * pattern.side_px()).max(size[0].max(size[1]) / MAX_KNOTS);
        let n = size.map(|px| to_index((px / apart_px).ceil()) + 1);
        Self {
            apart_px,
            off: Grid::filled(n[0], n[1], [0.0; 2]),
        }
    }

    fn place(&self, [i, j]: [usize; 2]) -> Place {
        [i as f64 * self.apart_px, j as f64 * self.apart_px]
    }

    fn at(&self, place: Place) -> Place {
        let knot = place.map(|px| px / self.apart_px);
        between(&self.off, knot, |a, b, share| mix(a, 1.0 - share, b, share))
    }

    /// Follows the cells from the knots of a part outward, always on to the knot with the surest
    /// neighbours.
    pub(super) fn grown(
        &self,
        luminance: &Grid<f64>,
        pattern: &Pattern,
        part: [usize; 4],
    ) -> Found {
        let [width, height] = [self.off.width(), self.off.height()];
        let mut found = Found {
            field: self.clone(),
            weights: Grid::filled(width, height, 0.0),
        };
        // How sure the knots around each are; of one that is taken, nothing.
        let mut sure = Grid::filled(width, height, Some(0.0));
        let [x, y, w, h] = part.map(|px| px as f64);
        let middle = [x + 0.5 * w, y + 0.5 * h].map(|px| to_index((px / self.apart_px).round()));
        let mut next = Some([middle[0].min(width - 1), middle[1].min(height - 1)]);
        while let Some(knot) = next {
            let near = found.predicted(knot);
            found.take(knot, pattern.matched(luminance, (self.place(knot), near)));
            sure.row_mut(knot[1])[knot[0]] = None;
            for ([i, j], _) in found.near(knot, 1) {
                let around = found.around([i, j], 1);
                sure.row_mut(j)[i] = sure.row(j)[i].map(|_| around);
            }
            let open = (0..height).flat_map(|j| (0..width).map(move |i| [i, j]));
            let open = open.filter_map(|knot| Some((sure.row(knot[1])[knot[0]]?, knot)));
            let surest = open.max_by(|a: &(f64, _), b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
            next = surest.map(|(_, knot)| knot);
        }
        found
    }

    /// Finds every knot again, from where it is.
    pub(super) fn tracked(
        &self,
        luminance: &Grid<f64>,
        pattern: &Pattern,
        n_threads: usize,
    ) -> Found {
        let [width, height] = [self.off.width(), self.off.height()];
        let mut matched = vec![([0.0; 2], 0.0); width * height];
        let work = |(): &mut (), j: usize, row: &mut [(Place, f64)]| {
            for (i, one) in row.iter_mut().enumerate() {
                let place = self.place([i, j]);
                let slope = |axis: usize| {
                    let mut ends = [place; 2];
                    ends[0][axis] -= 0.5 * self.apart_px;
                    ends[1][axis] += 0.5 * self.apart_px;
                    let [from, to] = ends.map(|end| self.at(end));
                    mix(to, 1.0 / self.apart_px, from, -1.0 / self.apart_px)
                };
                let near = Local {
                    off: self.off.row(j)[i],
                    slopes: [slope(0), slope(1)],
                };
                *one = pattern.matched(luminance, (place, near));
            }
        };
        in_pieces(&mut matched, width, n_threads, || (), work);
        let of = |column: usize, row: usize| matched[row * width + column];
        Found {
            field: Self {
                apart_px: self.apart_px,
                off: Grid::from_fn(width, height, |i, j| of(i, j).0),
            },
            weights: Grid::from_fn(width, height, |i, j| of(i, j).1),
        }
    }

    /// Takes off what is a change of the lattice alone, and gives the lattice that is left.
    pub(super) fn take_mean_off(&mut self, basis: Basis) -> Basis {
        let [width, height] = [self.off.width(), self.off.height()];
        let middle = self
            .place([width, height])
            .map(|px| 0.5 * (px - self.apart_px));
        let (mut mean, mut slopes, mut spread) = ([0.0; 2], [[0.0; 2]; 2], [0.0; 2]);
        let n = (width * height) as f64;
        for j in 0..height {
            for (i, &off) in self.off.row(j).iter().enumerate() {
                let at = mix(self.place([i, j]), 1.0, middle, -1.0);
                mean = mix(mean, 1.0, off, 1.0 / n);
                for axis in [0, 1] {
                    slopes[axis] = mix(slopes[axis], 1.0, off, at[axis]);
                    spread[axis] += at[axis] * at[axis];
                }
            }
        }
        let [along, down] = [0, 1].map(|axis| slopes[axis].map(|x| x / spread[axis].max(1e-9)));
        // x + d = (1 + A)(x + d′) + b, so that d′ has neither slope nor mean.
        let matrix = Basis::new([1.0 + along[0], along[1]], [down[0], 1.0 + down[1]]);
        for j in 0..height {
            for i in 0..width {
                let at = mix(self.place([i, j]), 1.0, middle, -1.0);
                let off = mix(self.off.row(j)[i], 1.0, mean, -1.0);
                let left = mix(matrix.coordinates(mix(at, 1.0, off, 1.0)), 1.0, at, -1.0);
                self.off.row_mut(j)[i] = left;
            }
        }
        Basis::new(matrix.coordinates(basis.p1), matrix.coordinates(basis.p2))
    }

    /// The picture laid straight, and the place of its first pixel; `None` where the margin leaves
    /// nothing.
    pub(super) fn unwarped(
        &self,
        luminance: &Grid<f64>,
        n_threads: usize,
    ) -> Option<(Unwarped, Place)> {
        let bend_px = self
            .off
            .values()
            .iter()
            .map(|off| length(*off))
            .fold(0.0, f64::max);
        let margin = to_index(bend_px.ceil());
        let size = [luminance.width(), luminance.height()];
        let [width, height] = size.map(|n| n.saturating_sub(2 * margin));
        if width < size[0] / 2 || height < size[1] / 2 {
            return None;
        }
        let mut straight = Grid::filled(width, height, 0.0);
        let work = |(): &mut (), row: usize, values: &mut [f64]| {
            for (column, value) in values.iter_mut().enumerate() {
                let goal = [column, row].map(|n| (n + margin) as f64);
                let mut place = goal;
                for _ in 0..4 {
                    place = mix(goal, 1.0, self.at(place), -1.0);
                }
                *value = between(luminance, place, |a, b, share| a + (b - a) * share);
            }
        };
        in_pieces(straight.values_mut(), width, n_threads, || (), work);
        let unwarped = Unwarped {
            luminance: straight,
            bend_px,
            stretch: self.stretch(),
        };
        Some((unwarped, [margin as f64; 2]))
    }

    /// The largest change of the displacement from knot to knot, as a share of their distance.
    fn stretch(&self) -> f64 {
        let turned = self.off.transposed();
        let pairs = [&self.off, &turned].into_iter().flat_map(|off| {
            let rows = (0..off.height()).map(|j| off.row(j));
            rows.flat_map(|row| row.windows(2).map(|pair| mix(pair[1], 1.0, pair[0], -1.0)))
        });
        extent(pairs.map(length))[1].max(0.0) / self.apart_px
    }
}

impl Found {
    fn take(&mut self, [i, j]: [usize; 2], (off, weight): (Place, f64)) {
        self.field.off.row_mut(j)[i] = off;
        self.weights.row_mut(j)[i] = weight;
    }

    /// Knots around one, itself left out, with what they count.
    fn near(&self, [i, j]: [usize; 2], reach: usize) -> impl Iterator<Item = ([usize; 2], f64)> {
        let columns = i.saturating_sub(reach)..(i + reach + 1).min(self.weights.width());
        let rows = j.saturating_sub(reach)..(j + reach + 1).min(self.weights.height());
        let all = rows.flat_map(move |row| columns.clone().map(move |column| [column, row]));
        let others = all.filter(move |&knot| knot != [i, j]);
        others.map(|[i, j]| ([i, j], self.weights.row(j)[i]))
    }

    /// How sure the knots around one are.
    fn around(&self, knot: [usize; 2], reach: usize) -> f64 {
        self.near(knot, reach).map(|(_, weight)| weight).sum()
    }

    /// Where the knots around one point to: the plane through them, hardly steeper than they are.
    fn predicted(&self, knot: [usize; 2]) -> Local {
        let place = self.field.place(knot);
        let known: Vec<(Place, Place, f64)> = self
            .near(knot, 2)
            .filter(|(_, weight)| *weight > 0.0)
            .map(|([i, j], weight)| {
                let at = mix(self.field.place([i, j]), 1.0, place, -1.0);
                let away = dot(at, at) / self.field.apart_px.powi(2);
                (at, self.field.off.row(j)[i], weight / away)
            })
            .collect();
        let all: f64 = known.iter().map(|one| one.2).sum();
        if all <= 0.0 {
            return Local::default();
        }
        let mean = |of: &dyn Fn(&(Place, Place, f64)) -> f64| {
            known.iter().map(|one| one.2 * of(one)).sum::<f64>() / all
        };
        let at = [0, 1].map(|axis| mean(&|one| one.0[axis]));
        let off = [0, 1].map(|axis| mean(&|one| one.1[axis]));
        let square = |a: usize, b: usize| mean(&|one| (one.0[a] - at[a]) * (one.0[b] - at[b]));
        let ridge = 0.05 * self.field.apart_px.powi(2);
        let matrix = Basis::new(
            [square(0, 0) + ridge, square(0, 1)],
            [square(0, 1), square(1, 1) + ridge],
        );
        let slope = |of: usize| {
            let pull = |a: usize| mean(&|one| (one.0[a] - at[a]) * (one.1[of] - off[of]));
            matrix.coordinates([pull(0), pull(1)])
        };
        let [of_x, of_y] = [slope(0), slope(1)];
        let slopes = [[of_x[0], of_y[0]], [of_x[1], of_y[1]]];
        let moved = mix(slopes[0], -at[0], slopes[1], -at[1]);
        Local {
            off: mix(off, 1.0, moved, 1.0),
            slopes,
        }
    }

    /// Brings the field near to what was found and to little bending, knot by knot.
    pub(super) fn smooth(&mut self) {
        let found = self.field.off.clone();
        let [width, height] = [found.width(), found.height()];
        for _ in 0..N_SWEEPS {
            for j in 0..height {
                for i in 0..width {
                    let weight = self.weights.row(j)[i];
                    let mut sum = found.row(j)[i].map(|px| weight * px);
                    let mut all = weight;
                    for axis in [0, 1] {
                        self.bend([i, j], axis, (&mut sum, &mut all));
                    }
                    self.field.off.row_mut(j)[i] = sum.map(|px| px / all);
                }
            }
        }
    }

    /// What the second differences along an axis that a knot is part of ask of it.
    fn bend(&self, knot: [usize; 2], axis: usize, (sum, all): (&mut Place, &mut f64)) {
        let n = [self.weights.width(), self.weights.height()][axis];
        let at = knot[axis];
        let off = |k: usize| {
            let mut other = knot;
            other[axis] = k;
            self.field.off.row(other[1])[other[0]]
        };
        for middle in at.saturating_sub(1).max(1)..=(at + 1).min(n.saturating_sub(2)) {
            let mut rest = [0.0; 2];
            let mut own = 0.0;
            for (k, share) in [(middle - 1, 1.0), (middle, -2.0), (middle + 1, 1.0)] {
                if k == at {
                    own = share;
                } else {
                    rest = mix(rest, 1.0, off(k), share);
                }
            }
            *sum = mix(*sum, 1.0, rest, -STIFFNESS * own);
            *all += STIFFNESS * own * own;
        }
    }
}
