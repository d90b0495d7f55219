//! Nearest point against the mean over the points that a contactor crosses in a tick.
//!
//! The truth is the power of the product's window averaged over every tenth of a millimetre of the
//! way. The nearest point is that where the tick ends, as the product takes it.

use crate::{Bench, Row, Timing};
use selvedge_foundation::numerics::{Random, quantile};
use selvedge_textile::tactile::Filters;

use super::PRODUCT;
use super::surfaces::Surface;
use super::window::Model;
use crate::readable::{largest, power_level_db, rms, whole};

/// Places a mm at which the truth is known.
const PLACES_PER_MM: f64 = 10.0;
/// Speeds, mm/s; the first when there is little time.
const SPEEDS_MM_PER_S: [f64; 4] = [100.0, 40.0, 200.0, 400.0];
/// Amplitudes are compared where they are at least this share of the band's largest.
const LEAST_SHARE: f64 = 1e-3;

/// Powers of a surface at places a tenth of a mm apart.
struct Places {
    model: Model,
    powers: Vec<Vec<f64>>,
}

/// Two rows for every surface and speed.
pub(super) fn rows(surfaces: &[Surface], bench: &mut Bench<'_>) -> Vec<Row> {
    let speeds = &SPEEDS_MM_PER_S[..bench.effort.pick(1, SPEEDS_MM_PER_S.len())];
    let n_ticks = bench.effort.pick(60, 300);
    let random = Random::new(bench.seed).branch("ticks");
    let mut rows = Vec::new();
    for surface in surfaces {
        let places = Places::of(surface);
        for &speed in speeds {
            let mut random = random.branch(&surface.label);
            let errors = places.errors_db(speed, n_ticks, &mut random);
            let methods = [
                ("nearest point", 1),
                ("mean over points crossed", whole(speed / 40.0) + 1),
            ];
            for ((method, n_points), mut errors_db) in methods.into_iter().zip(errors) {
                let case = format!("{} at {speed} mm/s", surface.label);
                let row = Row::of(method, "", case)
                    .error(errors_db.iter().copied().reduce(f64::max))
                    .p99(quantile(&mut errors_db, 0.99))
                    .cost(places.cost(speed, n_points, bench))
                    .number("rms_db", 3, rms(&errors_db))
                    .number("points_crossed", 2, speed / 40.0);
                rows.push(row);
            }
        }
    }
    rows
}

impl Places {
    fn of(surface: &Surface) -> Self {
        let model = Model::new(surface.step_mm, PRODUCT[0], PRODUCT[1]);
        let powers = model.powers_along(surface, PLACES_PER_MM);
        Self { model, powers }
    }

    /// Level errors of the nearest point and of the mean over the points crossed, dB, over ticks
    /// that end at random places.
    fn errors_db(&self, speed: f64, n_ticks: usize, random: &mut Random) -> [Vec<f64>; 2] {
        let filters = Filters::default();
        let at = |powers: &Vec<f64>| self.model.squared_amplitudes_um2(powers, speed, &filters);
        let squared: Vec<[f64; 2]> = self.powers.iter().map(at).collect();
        let last_mm = (squared.len().saturating_sub(1)) as f64 / PLACES_PER_MM;
        let way_mm = speed / 40.0;
        let mut errors = [Vec::new(), Vec::new()];
        for _ in 0..n_ticks {
            let end_mm = random.uniform_in(way_mm, last_mm.floor());
            let way = [(end_mm - way_mm).max(0.0), end_mm];
            for b in 0..2 {
                let largest = largest(squared.iter().map(|pair| pair[b]));
                let truth = mean_over(&squared, b, way, PLACES_PER_MM);
                if truth < LEAST_SHARE * LEAST_SHARE * largest || truth <= 0.0 {
                    continue;
                }
                let nearest = mean_over(&squared, b, [end_mm; 2], 1.0);
                let crossed = mean_over(&squared, b, way, 1.0);
                errors[0].push(power_level_db(nearest / truth).abs());
                errors[1].push(power_level_db(crossed / truth).abs());
            }
        }
        errors
    }

    /// The cost of a tick of one contactor that takes `n_points` points.
    fn cost(&self, speed: f64, n_points: usize, bench: &mut Bench<'_>) -> Timing {
        let filters = Filters::default();
        bench.time(1, || {
            let mut sums = [0.0; 2];
            for powers in self.powers.iter().take(n_points) {
                let own = self.model.squared_amplitudes_um2(powers, speed, &filters);
                (0..2).for_each(|b| sums[b] += own[b]);
            }
            sums
        })
    }
}

/// The mean of a band's power along a way from one place to another, mm, each stretch of it taken
/// from the nearest of points that lie `per_mm` to a mm.
fn mean_over(squared: &[[f64; 2]], b: usize, [from_mm, to_mm]: [f64; 2], per_mm: f64) -> f64 {
    let cell = |mm: f64| whole(mm * per_mm + 0.5 + 1e-6);
    let stride = whole(PLACES_PER_MM / per_mm + 0.5);
    let value = |cell: usize| squared[(cell * stride).min(squared.len() - 1)][b];
    let (first, last) = (cell(from_mm), cell(to_mm));
    if first == last {
        return value(last);
    }
    let (mut sum, mut way) = (0.0, 0.0);
    for n in first..=last {
        let low_mm = ((n as f64 - 0.5) / per_mm).max(from_mm);
        let high_mm = ((n as f64 + 0.5) / per_mm).min(to_mm);
        let stretch = (high_mm - low_mm).max(0.0);
        sum += stretch * value(n);
        way += stretch;
    }
    if way > 0.0 { sum / way } else { value(last) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_along_a_way_weighs_every_point_by_its_stretch() {
        // Points at 0, 1 and 2 mm of power 0, 10 and 20, filled in between.
        let squared: Vec<[f64; 2]> = (0..=20).map(|n| [f64::from(n), 0.0]).collect();
        let mean = |way, per_mm| mean_over(&squared, 0, way, per_mm);
        assert_eq!(mean([1.2, 1.2], 1.0), 10.0);
        // From 0.5 to 1.0 the point at 1 mm, of 10.
        assert!((mean([0.5, 1.0], 1.0) - 10.0).abs() < 1e-9, "one point");
        // 0.25 mm of the point at 0, 0.75 mm of that at 1 mm.
        assert!((mean([0.25, 1.25], 1.0) - 7.5).abs() < 1e-9, "two points");
        assert!(
            (mean([0.25, 1.25], 10.0) - 7.5).abs() < 0.26,
            "the line itself"
        );
    }
}
