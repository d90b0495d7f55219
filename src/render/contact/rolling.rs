//! A sphere rolled over heights: grey dilation by a ball, exact to the bit, without looking at all
//! that lies below it.
//!
//! A square of places is asked together. Whatever lies below the sphere is at most so far from the
//! square, and at least so far from its other side: what cannot reach, at its nearest, as high as
//! another reaches at its farthest is passed over for the whole square. What is left is asked again
//! by each quarter of it, down to a single place, which takes the highest of the few that remain.
//!
//! Where few samples lie below the sphere it is quicker to look at them all, for a run of places in
//! a row together: a sample beside each place lies in a row, too, and what cannot lift any is
//! passed over for the whole run.
#![expect(
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "numbers of samples: at most 64 million, and never negative where they are places"
)]

use crate::RenderError;
use selvedge_foundation::numerics::{Grid, extent, in_pieces, n_threads, to_whole};

/// Sides of the squares that are asked first, samples.
const SIDES: [usize; 2] = [4, 256];
/// Most samples below the sphere anywhere over such a square: 100 MB of them.
const MAX_BELOW: usize = 4_000_000;
/// Most samples that a sphere looked at sample by sample reaches to one side.
const NEAR: usize = 32;
/// Places of a row that are asked together then, and rows of a strip.
const RUN: usize = 64;
/// What rounding may make of two drops that are the same, mm.
const ROUNDING_MM: f64 = 1e-12;

/// A height that a sphere may rest on, mm, and its sample.
#[derive(Debug, Clone, Copy)]
struct Summit {
    height_mm: f64,
    at: [isize; 2],
}

/// A square of places.
#[derive(Debug, Clone, Copy)]
struct Square {
    corner: [isize; 2],
    side: usize,
}

impl Square {
    fn quarters(self) -> impl Iterator<Item = Self> {
        let side = self.side / 2;
        [[0, 0], [1, 0], [0, 1], [1, 1]].into_iter().map(move |by| {
            let corner = [0, 1].map(|axis| self.corner[axis] + by[axis] * side as isize);
            Self { corner, side }
        })
    }

    /// How many samples the nearest of its places is away from one.
    fn nearest(&self, at: [isize; 2]) -> [usize; 2] {
        [0, 1].map(|axis| {
            let before = self.corner[axis] - at[axis];
            before.max(1 - before - self.side as isize).max(0) as usize
        })
    }

    /// The same of the farthest.
    fn farthest(&self, at: [isize; 2]) -> [usize; 2] {
        [0, 1].map(|axis| {
            let before = self.corner[axis] - at[axis];
            before.min(1 - before - self.side as isize).unsigned_abs()
        })
    }
}

/// How far a sphere's underside is above its lowest point, mm, by samples along both axes; infinite
/// beside it, and where no relief reaches.
struct Sphere(Grid<f64>);

impl Sphere {
    fn new(radius_mm: f64, step_mm: [f64; 2], [reach_u, reach_w]: [usize; 2]) -> Self {
        Self(Grid::from_fn(reach_u + 1, reach_w + 1, |du, dw| {
            drop_mm(radius_mm, step_mm, [du, dw])
        }))
    }

    /// How many samples it reaches to one side, along both axes.
    fn reach(&self) -> [usize; 2] {
        [self.0.width() - 1, self.0.height() - 1]
    }

    /// How high a summit lifts it that is so many samples away, mm.
    fn lifted_mm(&self, summit: &Summit, [du, dw]: [usize; 2]) -> f64 {
        if du >= self.0.width() || dw >= self.0.height() {
            return f64::NEG_INFINITY;
        }
        summit.height_mm - self.0.row(dw)[du]
    }

    /// Where it rests on each place of a square of a strip of rows. What it may rest on there is at
    /// the end of `room`, from `begin` on.
    fn roll(&self, room: &mut Vec<Summit>, begin: usize, square: Square, strip: &mut Strip<'_>) {
        let end = room.len();
        let Some(out) = strip.place(square.corner) else {
            return;
        };
        let mut sure_mm = f64::NEG_INFINITY;
        for summit in &room[begin..end] {
            sure_mm = sure_mm.max(self.lifted_mm(summit, square.farthest(summit.at)));
        }
        if square.side == 1 {
            *out = sure_mm;
            return;
        }
        for i in begin..end {
            let summit = room[i];
            if self.lifted_mm(&summit, square.nearest(summit.at)) >= sure_mm - ROUNDING_MM {
                room.push(summit);
            }
        }
        for quarter in square.quarters() {
            self.roll(room, end, quarter, strip);
        }
        room.truncate(end);
    }
}

/// How far a sphere's underside is above its lowest point so many samples away, mm; infinite beside
/// it.
fn drop_mm(radius_mm: f64, step_mm: [f64; 2], [du, dw]: [usize; 2]) -> f64 {
    let away_mm = (du as f64 * step_mm[0]).hypot(dw as f64 * step_mm[1]);
    let depth_mm2 = (radius_mm - away_mm) * (radius_mm + away_mm);
    if away_mm > radius_mm {
        return f64::INFINITY;
    }
    radius_mm - depth_mm2.sqrt()
}

/// Rows of what is computed, and the number of the first.
struct Strip<'a> {
    rows: &'a mut [f64],
    width: usize,
    first: usize,
}

impl Strip<'_> {
    /// A place, if it is one of it.
    fn place(&mut self, [u, w]: [isize; 2]) -> Option<&mut f64> {
        let (u, w) = (u as usize, w as usize - self.first);
        (u < self.width).then_some(())?;
        self.rows.get_mut(w * self.width + u)
    }
}

/// Heights of a strip of rows and as far around it as a sphere reaches, mm.
#[derive(Default)]
struct Around {
    rows: Vec<Vec<f64>>,
    /// The highest that may lift each run of places, by row.
    highest: Vec<Vec<f64>>,
}

impl Around {
    /// Looks at `n_rows` of `width` places from row `first` on.
    fn look(
        &mut self,
        sphere: &Sphere,
        (width, first, n_rows): (usize, usize, usize),
        at: impl Fn([isize; 2]) -> f64,
    ) {
        let [reach_u, reach_w] = sphere.reach().map(|reach| reach as isize);
        let first = first as isize;
        let places = || -reach_u..width as isize + reach_u;
        self.rows.clear();
        for w in first - reach_w..first + n_rows as isize + reach_w {
            self.rows.push(places().map(|u| at([u, w])).collect());
        }
        let n_below = RUN + 2 * sphere.reach()[0];
        let of_row = |row: &Vec<f64>| {
            let below = |begin: usize| &row[begin..row.len().min(begin + n_below)];
            let runs = (0..width).step_by(RUN);
            runs.map(|begin| extent(below(begin).iter().copied())[1])
                .collect()
        };
        self.highest = self.rows.iter().map(of_row).collect();
    }

    /// Where the sphere rests on the places of row `w` of the strip.
    fn rest(&self, sphere: &Sphere, w: usize, out: &mut [f64]) {
        let [reach_u, reach_w] = sphere.reach();
        let middle = w + reach_w;
        for (nth, out) in out.chunks_mut(RUN).enumerate() {
            let begin = nth * RUN;
            for (out, height_mm) in out.iter_mut().zip(&self.rows[middle][begin + reach_u..]) {
                *out = height_mm - sphere.0.row(0)[0];
            }
            for dw in 0..=reach_w {
                for row in [middle - dw, middle + dw] {
                    let below = &self.rows[row][begin..];
                    let sure_mm = extent(out.iter().copied())[0] - ROUNDING_MM;
                    for (du, drop_mm) in sphere.0.row(dw).iter().enumerate() {
                        if self.highest[row][nth] - drop_mm < sure_mm {
                            break;
                        }
                        let (left, right) = (&below[reach_u - du..], &below[reach_u + du..]);
                        for (out, (left, right)) in out.iter_mut().zip(left.iter().zip(right)) {
                            let lifted = if left > right { left } else { right } - drop_mm;
                            *out = if lifted > *out { lifted } else { *out };
                        }
                    }
                }
            }
        }
    }
}

/// Where the lowest point of a sphere rests on heights of such steps, which go on as `at` says.
///
/// # Errors
/// A radius that covers more than can be kept in mind.
pub(super) fn dilated(
    heights_mm: &Grid<f64>,
    step_mm: [f64; 2],
    radius_mm: f64,
    at: impl Fn([isize; 2]) -> f64 + Sync,
) -> Result<Grid<f64>, RenderError> {
    let n = [heights_mm.width(), heights_mm.height()];
    let [low, high] = extent(heights_mm.values().iter().copied());
    // What is farther than the heights reach cannot touch.
    let deep_mm = (high - low).min(radius_mm);
    let half_mm = (deep_mm * (2.0 * radius_mm - deep_mm)).sqrt();
    let reach = [0, 1].map(|axis| match n[axis] {
        // The same everywhere along it.
        1 => 0,
        _ => to_whole::<usize>((half_mm / step_mm[axis]).min(1e6)) + 1,
    });
    let mut rested = heights_mm.clone();
    if reach.iter().all(|reach| *reach <= NEAR) {
        let sphere = Sphere::new(radius_mm, step_mm, reach);
        dilated_near(&mut rested, &sphere, &at);
        return Ok(rested);
    }
    let [least, most] = SIDES;
    let side = reach[0]
        .max(reach[1])
        .next_power_of_two()
        .clamp(least, most);
    let n_below = (side + 2 * reach[0]).saturating_mul(side + 2 * reach[1]);
    if n_below > MAX_BELOW {
        return Err(RenderError::stylus(
            format!("a tip of {radius_mm} mm covers {n_below} points"),
            "give a smaller radius, or a map of coarser steps",
        ));
    }
    let sphere = Sphere::new(radius_mm, step_mm, reach);
    let work = |room: &mut Vec<Summit>, nth: usize, rows: &mut [f64]| {
        let first = nth * side;
        let mut strip = Strip {
            rows,
            width: n[0],
            first,
        };
        for left in (0..n[0]).step_by(side) {
            let corner = [left as isize, first as isize];
            let around = |axis: usize| {
                corner[axis] - reach[axis] as isize..corner[axis] + (side + reach[axis]) as isize
            };
            room.clear();
            let places = around(1).flat_map(|w| around(0).map(move |u| [u, w]));
            room.extend(places.map(|place| Summit {
                height_mm: at(place),
                at: place,
            }));
            sphere.roll(room, 0, Square { corner, side }, &mut strip);
        }
    };
    in_pieces(
        rested.values_mut(),
        n[0] * side,
        n_threads(),
        Vec::new,
        work,
    );
    Ok(rested)
}

/// The same for a sphere that covers few points about each, run by run.
fn dilated_near(rested: &mut Grid<f64>, sphere: &Sphere, at: &(impl Fn([isize; 2]) -> f64 + Sync)) {
    let width = rested.width();
    let work = |around: &mut Around, nth: usize, rows: &mut [f64]| {
        around.look(sphere, (width, nth * RUN, rows.len() / width), at);
        for (w, out) in rows.chunks_mut(width).enumerate() {
            around.rest(sphere, w, out);
        }
    };
    let n_values = width * RUN;
    in_pieces(
        rested.values_mut(),
        n_values,
        n_threads(),
        Around::default,
        work,
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;

    /// The highest of all that lies below a sphere, one after the other.
    fn by_force(
        (radius_mm, step_mm): (f64, [f64; 2]),
        [u, w]: [isize; 2],
        at: impl Fn([isize; 2]) -> f64,
    ) -> f64 {
        let reach = step_mm.map(|step_mm| to_whole::<isize>(radius_mm / step_mm) + 1);
        let mut best = f64::NEG_INFINITY;
        for dw in -reach[1]..=reach[1] {
            for du in -reach[0]..=reach[0] {
                let away = [du, dw].map(isize::unsigned_abs);
                best = best.max(at([u + du, w + dw]) - drop_mm(radius_mm, step_mm, away));
            }
        }
        best
    }

    #[test]
    fn a_rolled_sphere_rests_where_brute_force_finds_it_to_the_bit() {
        let mut random = Random::new(11);
        for ([n_u, n_w], step_mm, radius_mm, rough_mm) in [
            ([61, 45], [0.02, 0.03], 0.3, 0.02),
            ([40, 37], [0.02, 0.02], 0.5, 0.2),
            ([9, 70], [0.05, 0.01], 0.4, 1.0),
            ([130, 1], [0.004, 0.004], 0.2, 0.01),
            ([33, 33], [0.02, 0.02], 0.0, 0.05),
            ([20, 20], [0.1, 0.1], 0.05, 0.05),
        ] {
            let wave = |i: usize| (i as f64 / 7.0).sin();
            let grid = Grid::from_fn(n_u, n_w, |u, w| {
                rough_mm * (wave(u) * wave(w) + 0.2 * random.normal())
            });
            let at = |[u, w]: [isize; 2]| {
                let u = u.rem_euclid(n_u as isize) as usize;
                grid.row(w.rem_euclid(n_w as isize) as usize)[u]
            };
            let found = dilated(&grid, step_mm, radius_mm, at).unwrap();
            for w in 0..n_w {
                for u in 0..n_u {
                    let place = [u as isize, w as isize];
                    let truth = by_force((radius_mm, step_mm), place, at);
                    let found = found.row(w)[u];
                    assert_eq!(found.to_bits(), truth.to_bits(), "{radius_mm}: {place:?}");
                }
            }
        }
    }

    #[test]
    fn a_sphere_over_more_than_can_be_kept_in_mind_is_refused() {
        let grid = Grid::from_fn(64, 64, |u, _| u as f64);
        let error = dilated(&grid, [0.001; 2], 50.0, |_| 0.0).unwrap_err();
        assert!(error.to_string().contains("covers"), "{error}");
    }
}
