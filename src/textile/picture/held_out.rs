//! What a lattice predicts of a picture where it was not looked at: the evidence for threads and
//! for the repeat of their weave.
//!
//! Every pixel is predicted from the same place in the cells around it, its own left out. The share
//! of the variance that this explains follows from the autocorrelation at lattice points alone:
//! with `a` the mean of ρ(l) over n neighbours and `b` that of ρ(l − l′), the best multiple of
//! their mean explains a²/b. Finer lattices that are wrong lose by `a`, coarser ones by few
//! neighbours in `b`.
//!
//! A weave repeats nearly from thread to thread. Its repeat is the coarser lattice whose points
//! stand out from all its other cosets, by a gap that is larger than chance. Threads differ among
//! themselves, and a thread predicts itself best: points along the threads are left out, and what
//! all points a thread apart share is taken from them.

use super::basis::{Basis, Place, generated, length, mix};
use super::multiples::{Evidence, sublattices};

/// Rows of whole numbers that span a coarser lattice.
type Rows = [[isize; 2]; 2];
/// Most neighbours that predict, and points that are compared.
const MOST: usize = 64;
/// Fewest neighbours that predict.
const FEWEST: usize = 4;
/// The largest index of a repeat in its threads.
const MAX_INDEX: isize = 25;
/// Gaps are larger than chance from this many standard errors on.
const MIN_T: f64 = 3.0;
/// Of what is explained, the share that a gap must reach: without what threads share, and with it.
const MIN_GAP: f64 = 0.07;
const MIN_RAW_GAP: f64 = 0.15;
/// Gaps this near to the largest are as good.
const AS_GOOD: f64 = 0.9;
/// Threads are this far apart at least, px.
const MIN_THREAD_PX: f64 = 4.0;
/// Of the points of a thread grid, the share that are maxima.
const MIN_HITS: f64 = 0.9;
/// Rounds of making coarser.
const MAX_ROUNDS: usize = 3;

/// What is explained where it was not looked at.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct HeldOut {
    /// Share of the variance of the picture.
    pub(super) share: f64,
    /// Neighbours that it is predicted from; 0 where the picture holds too few.
    pub(super) n_neighbours: usize,
}

/// The repeat of a weave in its threads.
#[derive(Debug, Clone, Copy)]
pub(super) struct Repeat {
    pub(super) basis: Basis,
    pub(super) explained: HeldOut,
    /// Whether its points stand out from those between; those of the threads alone do not.
    pub(super) stands_out: bool,
}

/// Half the way that shifts are known: neighbours of neighbours must be known too.
fn reach_px(evidence: &Evidence<'_>) -> f64 {
    0.5 * evidence.rho.radius()
}

/// What a lattice explains: in all, and without the places in the same threads.
pub(super) fn explained(evidence: &Evidence<'_>, basis: &Basis) -> [HeldOut; 2] {
    let reach = reach_px(evidence);
    let heights = Heights::of(evidence, &basis.reduced(), 2.0 * reach);
    [false, true].map(|is_apart| heights.explained(ITSELF, reach, is_apart))
}

/// The repeat that explains most, in the threads of any of several lattices.
pub(super) fn repeat(evidence: &Evidence<'_>, lattices: &[Basis]) -> Option<Repeat> {
    let finest = finest(lattices);
    let grids = finest.iter().flat_map(|basis| {
        let threads = thread_grid(evidence, lattices, basis);
        threads.into_iter().chain([*basis])
    });
    let repeats = grids.map(|threads| {
        let mut found = coarsened(evidence, threads.reduced());
        for _ in 1..MAX_ROUNDS {
            let next = coarsened(evidence, found.basis);
            if !(found.stands_out && next.stands_out)
                || next.explained.share < found.explained.share
            {
                break;
            }
            found = next;
        }
        found
    });
    repeats.reduce(|best, next| {
        if next.explained.share > best.explained.share {
            next
        } else {
            best
        }
    })
}

/// Those that are no coarser lattices of another.
fn finest(lattices: &[Basis]) -> Vec<Basis> {
    let mut by_area = lattices.to_vec();
    by_area.sort_by(|a, b| a.area().total_cmp(&b.area()));
    let mut finest: Vec<Basis> = Vec::new();
    for basis in by_area {
        if !finest.iter().any(|fine| holds(fine, &basis)) {
            finest.push(basis);
        }
    }
    finest
}

/// The grid of threads in which a lattice repeats: of those looked at and those around it the
/// finest whose points are maxima.
pub(super) fn thread_grid(
    evidence: &Evidence<'_>,
    lattices: &[Basis],
    basis: &Basis,
) -> Option<Basis> {
    let is_around = |grid: &Basis| {
        let index = basis.area() / grid.area();
        (1.5..MAX_INDEX as f64 + 0.5).contains(&index) && holds(grid, basis)
    };
    let others = lattices.iter().copied().filter(is_around);
    let grids = others.chain(around(basis)).filter(is_grid);
    let seen = grids.filter(|grid| are_maxima(evidence, grid, basis));
    let finest = seen.min_by(|a, b| a.area().total_cmp(&b.area()));
    finest.map(|grid| inside(&grid, basis))
}

/// A finer lattice whose points include those of `basis` exactly.
fn inside(fine: &Basis, basis: &Basis) -> Basis {
    let steps = [basis.p1, basis.p2].map(|vector| fine.coordinates(vector).map(f64::round));
    let [[a, b], [c, d]] = steps;
    let index = a * d - b * c;
    let part = |first: f64, second: f64| mix(basis.p1, first / index, basis.p2, second / index);
    Basis::new(part(d, -b), part(-c, a)).reduced()
}

fn is_grid(grid: &Basis) -> bool {
    grid.shorter() >= MIN_THREAD_PX && grid.sine() >= 0.9 && grid.longer() <= 1.6 * grid.shorter()
}

/// Whether both vectors of a lattice are about points of a finer one.
pub(super) fn holds(fine: &Basis, coarse: &Basis) -> bool {
    let tolerance = 0.12 * fine.shorter();
    [coarse.p1, coarse.p2].iter().all(|vector| {
        let point = fine.place(fine.coordinates(*vector).map(f64::round));
        length(mix(point, 1.0, *vector, -1.0)) < tolerance
    })
}

/// The lattices of small index around one.
fn around(basis: &Basis) -> impl Iterator<Item = Basis> {
    (2..=10_isize).flat_map(move |index| {
        let part = |vector: Place| vector.map(|px| px / index as f64);
        let parts = Basis::new(part(basis.p1), part(basis.p2));
        let steps = (1..index * index).map(move |n| [n % index, n / index]);
        steps.filter_map(move |step| {
            let rows = generated(&[[index, 0], [0, index], step])?;
            let is_of_index = rows[0][0] * rows[1][1] == index;
            is_of_index.then(|| parts.coarser(rows))
        })
    })
}

/// Whether the points of a finer lattice that are none of `basis` are maxima.
fn are_maxima(evidence: &Evidence<'_>, fine: &Basis, basis: &Basis) -> bool {
    let tolerance = (0.2 * fine.shorter()).max(1.0);
    let points = fine.indices_within(3.0 * fine.longer()).into_iter();
    let places = points.map(|[i, j]| fine.place([i as f64, j as f64]));
    let is_new = |place: &Place| {
        let [u, v] = basis.coordinates(*place);
        (u - u.round()).abs().max((v - v.round()).abs()) > 0.05
    };
    let new: Vec<Place> = places.filter(is_new).collect();
    let is_maximum = |place: &&Place| evidence.maxima.nearest(**place, tolerance).is_some();
    let n_hit = new.iter().filter(is_maximum).count();
    !new.is_empty() && n_hit as f64 >= MIN_HITS * new.len() as f64
}

const ITSELF: Rows = [[1, 0], [0, 1]];

/// The coarser lattice whose points stand out most, or the threads themselves.
fn coarsened(evidence: &Evidence<'_>, threads: Basis) -> Repeat {
    let reach = reach_px(evidence);
    let heights = Heights::of(evidence, &threads, 2.0 * reach);
    let of_threads = heights.explained(ITSELF, reach, true).share;
    let mut found: Vec<(f64, Rows, HeldOut)> = Vec::new();
    for rows in (2..=MAX_INDEX).flat_map(sublattices) {
        let pure = heights.gap(rows, reach, &heights.pure);
        let raw = heights.gap(rows, reach, &heights.raw);
        let is_clear = raw.is_some_and(|gap| gap > MIN_RAW_GAP * of_threads);
        if pure.is_none() && !is_clear {
            continue;
        }
        let apart = heights.explained(rows, reach, true).share;
        let pure = pure.filter(|gap| *gap > MIN_GAP * apart);
        let raw = raw.filter(|gap| *gap > MIN_RAW_GAP * apart);
        if let Some(gap) = pure.into_iter().chain(raw).reduce(f64::max)
            && apart > of_threads
        {
            found.push((gap, rows, heights.explained(rows, reach, false)));
        }
    }
    let most = found.iter().map(|one| one.0).fold(0.0, f64::max);
    found.retain(|one| one.0 >= AS_GOOD * most);
    let most = found.iter().map(|one| one.2.share).fold(0.0, f64::max);
    let index = |[[a, _], [_, d]]: Rows| a * d;
    let as_good = found.iter().filter(|one| one.2.share >= 0.97 * most);
    let chosen = as_good.min_by_key(|one| index(one.1));
    Repeat {
        basis: chosen.map_or(threads, |one| threads.coarser(one.1)),
        explained: chosen.map_or_else(|| heights.explained(ITSELF, reach, false), |one| one.2),
        stands_out: chosen.is_some(),
    }
}

/// ρ at the points of a lattice.
struct Heights {
    basis: Basis,
    /// Most steps along either vector.
    n: isize,
    /// Row by row of the second index; NaN where it is not known.
    all: Vec<f64>,
    /// Without points along the threads.
    raw: Vec<f64>,
    /// The same without what all points on a line along either thread share.
    pure: Vec<f64>,
}

impl Heights {
    fn of(evidence: &Evidence<'_>, basis: &Basis, reach: f64) -> Self {
        let steps = (reach * basis.longer() / basis.area()).ceil().min(120.0);
        let n = super::basis::whole(steps) + 1;
        let indices = (-n..=n).flat_map(|j| (-n..=n).map(move |i| [i, j]));
        let height = |[i, j]: [isize; 2]| {
            let place = basis.place([i as f64, j as f64]);
            let is_near = length(place) <= reach;
            let height = is_near.then(|| evidence.rho.between(place)).flatten();
            if [i, j] == [0, 0] {
                1.0
            } else {
                height.unwrap_or(f64::NAN)
            }
        };
        let all: Vec<f64> = indices.clone().map(height).collect();
        let off = |([i, j], height): ([isize; 2], &f64)| {
            if i == 0 || j == 0 { f64::NAN } else { *height }
        };
        let raw: Vec<f64> = indices.zip(&all).map(off).collect();
        let pure = centred(&raw, (2 * n + 1).cast_unsigned());
        Self {
            basis: *basis,
            n,
            all,
            raw,
            pure,
        }
    }

    fn at(&self, of: &[f64], [i, j]: [isize; 2]) -> Option<f64> {
        if i.abs().max(j.abs()) > self.n {
            return None;
        }
        let index = (j + self.n) * (2 * self.n + 1) + i + self.n;
        Some(of[index.cast_unsigned()]).filter(|height| height.is_finite())
    }

    /// The points of a coarser lattice within reach with their distances, nearest first.
    fn points(&self, [[a, b], [_, d]]: Rows, reach: f64, of: &[f64]) -> Vec<(f64, [isize; 2])> {
        let n = self.n;
        let indices = (-(n / a)..=n / a).flat_map(|k| {
            let rows = -(n + b * k).div_euclid(d)..=(n - b * k).div_euclid(d);
            rows.map(move |l| [a * k, b * k + d * l])
        });
        let mut points: Vec<(f64, [isize; 2])> = indices
            .filter(|index| *index != [0, 0] && self.at(of, *index).is_some())
            .map(|[i, j]| (length(self.basis.place([i as f64, j as f64])), [i, j]))
            .filter(|(distance, _)| *distance <= reach)
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        points.truncate(MOST);
        points
    }

    /// What a coarser lattice explains from as many rings of neighbours as do it best; perhaps from
    /// those in other threads only.
    fn explained(&self, rows: Rows, reach: f64, is_apart: bool) -> HeldOut {
        let of = if is_apart { &self.raw } else { &self.all };
        let points = self.points(rows, reach, of);
        let (mut best, mut first, mut second) = (HeldOut::default(), 0.0, 0.0);
        for (n, (distance, point)) in points.iter().enumerate() {
            first += self.at(&self.all, *point).unwrap_or(0.0);
            second += 1.0;
            for (_, other) in &points[..n] {
                let apart = [point[0] - other[0], point[1] - other[1]];
                let Some(height) = self.at(&self.all, apart) else {
                    return best;
                };
                second += 2.0 * height;
            }
            let ends_ring = points.get(n + 1).is_none_or(|next| next.0 > distance + 0.3);
            let share = first * first / second;
            if ends_ring && n + 1 >= FEWEST && first > 0.0 && share > best.share {
                best = HeldOut {
                    share,
                    n_neighbours: n + 1,
                };
            }
        }
        best
    }

    /// How much higher the points of a coarser lattice are than those of its highest other coset
    /// beside them; `None` where that may be chance.
    fn gap(&self, rows: Rows, reach: f64, of: &[f64]) -> Option<f64> {
        let is_half = |[i, j]: [isize; 2]| j > 0 || (j == 0 && i > 0);
        let mut points = self.points(rows, reach, of);
        points.retain(|(_, index)| is_half(*index));
        let [[a, _], [_, d]] = rows;
        let mut least = f64::INFINITY;
        for coset in (1..a * d).map(|n| [n % a, n / a]) {
            let [x, y] = self.shortest(rows, coset);
            let gaps = points.iter().filter_map(|(_, [i, j])| {
                let beside = [[i + x, j + y], [i - x, j - y]].map(|index| self.at(of, index));
                let known = beside.iter().flatten().count();
                let sum: f64 = beside.into_iter().flatten().sum();
                let gap = self.at(of, [*i, *j])? - sum / known as f64;
                (known > 0).then_some(gap)
            });
            let (n, sum, square) = gaps.fold((0.0, 0.0, 0.0), |(n, sum, square), gap| {
                (n + 1.0, sum + gap, square + gap * gap)
            });
            let mean: f64 = sum / n;
            let spread = ((square / n - mean * mean).max(0.0) / (n - 1.0)).sqrt();
            if !(n >= 2.0 && mean >= MIN_T * spread) {
                return None;
            }
            least = least.min(mean);
        }
        (least > 0.0).then_some(least)
    }

    /// The shortest shift to a coset.
    fn shortest(&self, [[a, b], [_, d]]: Rows, [x, y]: [isize; 2]) -> [isize; 2] {
        let near = (-3..=3).flat_map(|l| (-3..=3).map(move |k| [x + a * k, y + b * k + d * l]));
        let distance = |[i, j]: [isize; 2]| length(self.basis.place([i as f64, j as f64]));
        near.min_by(|p, q| distance(*p).total_cmp(&distance(*q)))
            .unwrap_or([x, y])
    }
}

/// Rows and columns about their means; lines of fewer than three known heights are none.
fn centred(heights: &[f64], side: usize) -> Vec<f64> {
    let mut centred = heights.to_vec();
    for _ in 0..4 {
        for is_row in [true, false] {
            for line in 0..side {
                let at = |k: usize| {
                    if is_row {
                        line * side + k
                    } else {
                        k * side + line
                    }
                };
                let known = (0..side).map(|k| centred[at(k)]).filter(|x| x.is_finite());
                let (n, sum) = known.fold((0.0, 0.0), |(n, sum), x| (n + 1.0, sum + x));
                let mean = if n < 3.0 { f64::NAN } else { sum / n };
                for k in 0..side {
                    centred[at(k)] -= mean;
                }
            }
        }
    }
    centred
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::super::{Autocorrelation, Maxima, SignificantMaxima};
    use super::*;
    use selvedge_foundation::numerics::{Grid, Random};

    fn with_evidence<T>(picture: &Grid<f64>, work: impl FnOnce(&Evidence<'_>) -> T) -> T {
        let rho = Autocorrelation::of(picture, 1);
        let maxima = Maxima::of(&rho);
        let significant = SignificantMaxima::of(&maxima, &rho);
        work(&Evidence {
            rho: &rho,
            maxima: &maxima,
            significant: &significant,
        })
    }

    #[test]
    fn a_lattice_explains_the_share_that_repeats_and_a_wrong_one_less() {
        // Waves of variance 1/4 in noise of variance 1/4.
        let mut random = Random::new(4);
        let value = |i: usize| {
            let (x, y) = ((i % 240) as f64, (i / 240) as f64);
            0.5 * ((TAU * x / 12.0).cos() + (TAU * y / 10.0).cos()) + 0.5 * random.normal()
        };
        let picture = Grid::from_rows(240, (0..240 * 240).map(value).collect()).unwrap();
        with_evidence(&picture, |evidence| {
            let of = |basis: Basis| explained(evidence, &basis);
            let [all, apart] = of(Basis::new([12.0, 0.0], [0.0, 10.0]));
            assert!((all.share - 0.5).abs() < 0.03, "{all:?}");
            assert!((apart.share - 0.5).abs() < 0.03, "{apart:?}");
            let [double, _] = of(Basis::new([24.0, 0.0], [0.0, 20.0]));
            assert!(double.share < all.share, "{double:?} from fewer neighbours");
            let [half, _] = of(Basis::new([6.0, 0.0], [0.0, 10.0]));
            assert!(half.share < 0.75 * all.share, "{half:?}");
            let [other, _] = of(Basis::new([9.1, 4.3], [-5.2, 7.9]));
            assert!(other.share < 0.05, "{other:?}");
        });
    }

    #[test]
    fn heights_are_about_the_means_of_their_lines() {
        let heights: Vec<f64> = (0..25)
            .map(|i| f64::from(i % 5) + 10.0 * f64::from(i / 5))
            .collect();
        let centred = centred(&heights, 5);
        assert!(
            centred.iter().all(|height| height.abs() < 1e-12),
            "{centred:?}"
        );
    }
}
