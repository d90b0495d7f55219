//! The pad of a finger: where its points sit, and how pulp and cloth yield under pressure.
//!
//! A paraboloid of radii 8 mm across and 12 mm along; 8 × 6 points, 2 mm apart, each for 4 mm²: the
//! 24 contactors of the display and one ring around them that is felt but not shown.

use super::fabric::Compression;
use super::mesh::Vector;
use selvedge_foundation::geometry::{Displacement, Rotation};
use selvedge_foundation::numerics::{bisected, to_index};

/// Radii across and along the finger, m.
pub(crate) const RADII_M: [f64; 2] = [8e-3, 12e-3];
/// Rows and columns of points.
const POINTS: [usize; 2] = [8, 6];
/// Between points, m.
const PITCH_M: f64 = 2e-3;
/// What a point stands for, m².
pub(crate) const POINT_M2: f64 = PITCH_M * PITCH_M;
/// The larger radius: what is beyond twice of it is away.
pub(crate) const REACH_M: f64 = RADII_M[1];
/// Stiffness of the pulp, Pa/m.
pub(crate) const PULP_PA_PER_M: f64 = 5e6;

/// Places of the points about the lowest one: across, along, and how far the pad curves away, m.
pub(crate) fn points(rotation_deg: f64) -> impl Iterator<Item = Vector> {
    let turn = Rotation::from_degrees(rotation_deg);
    let [rows, columns] = POINTS;
    (0..rows * columns).map(move |point| {
        let [row, column] = [point / columns, point % columns];
        let across = (column as f64 - 0.5 * (columns - 1) as f64) * PITCH_M;
        let along = (0.5 * (rows - 1) as f64 - row as f64) * PITCH_M;
        let sag = across * across / (2.0 * RADII_M[0]) + along * along / (2.0 * RADII_M[1]);
        let turned = turn.turn(Displacement::new(across, along));
        Vector::new(turned.x_mm, turned.y_mm, sag)
    })
}

/// The points that are contactors, in the display's order.
pub(crate) fn contactors() -> impl Iterator<Item = usize> {
    let [rows, columns] = POINTS;
    (1..rows - 1).flat_map(move |row| (1..columns - 1).map(move |column| row * columns + column))
}

/// Pressure by overlap of pulp and cloth in series, `δ = p/k_f + ½ (T₀ − T(p))`: piecewise linear.
#[derive(Debug, Clone)]
pub(crate) struct Pulp {
    /// Energy (J/m²) and pressure (Pa) at each step of overlap.
    table: Vec<[f64; 2]>,
}

/// Between entries, m.
const STEP_M: f64 = 5e-6;
const N_STEPS: usize = 800;

impl Pulp {
    pub(crate) fn new(cloth: &Compression) -> Self {
        let overlap_m = |pa: f64| pa / PULP_PA_PER_M + 0.5 * cloth.thinner_m(pa);
        let mut table = vec![[0.0; 2]];
        for step in 1..=N_STEPS {
            let wanted_m = step as f64 * STEP_M;
            let most_pa = wanted_m * PULP_PA_PER_M;
            let pa = bisected([0.0, most_pa], 60, |pa| overlap_m(pa) < wanted_m);
            let [energy, before_pa] = table[step - 1];
            table.push([energy + 0.5 * (before_pa + pa) * STEP_M, pa]);
        }
        Self { table }
    }

    /// Energy (J/m²), pressure (Pa) and its slope (Pa/m) at an overlap in m.
    #[inline]
    pub(crate) fn at(&self, overlap_m: f64) -> [f64; 3] {
        if overlap_m.is_nan() || overlap_m <= 0.0 {
            return [0.0; 3];
        }
        let entry = to_index(overlap_m / STEP_M).min(N_STEPS);
        let [energy, pa] = self.table[entry];
        let next = self.table.get(entry + 1);
        let slope = next.map_or(PULP_PA_PER_M, |[_, next_pa]| (next_pa - pa) / STEP_M);
        let into_m = overlap_m - entry as f64 * STEP_M;
        let more = slope * into_m;
        [energy + (pa + 0.5 * more) * into_m, pa + more, slope]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contactors_sit_where_the_display_has_them() {
        let places: Vec<Vector> = points(0.0).collect();
        let shown: Vec<usize> = contactors().collect();
        assert_eq!((places.len(), shown.len()), (48, 24));
        let near = |point: usize, x_mm: f64, y_mm: f64| {
            let off = places[point] - Vector::new(1e-3 * x_mm, 1e-3 * y_mm, places[point].z);
            assert!(off.norm() < 1e-12, "{point}: {}", places[point]);
        };
        near(shown[0], -3.0, 5.0);
        near(shown[23], 3.0, -5.0);
        near(shown[5], -1.0, 3.0);
    }

    #[test]
    fn pulp_and_cloth_yield_together_and_energy_is_the_work() {
        let thick = Pulp::new(&Compression::new(1e-3, 0.4e-3, 0.4));
        let thin = Pulp::new(&Compression::new(1e-9, 0.0, 1.0));
        assert!((thin.at(1e-3)[1] - 5e3).abs() < 1e-6);
        assert!(thick.at(1e-3)[1] < 0.9 * thin.at(1e-3)[1]);
        let mut work = 0.0;
        for step in 0..6000 {
            let middle = (f64::from(step) + 0.5) * 1e-6;
            work += thick.at(middle)[1] * 1e-6;
        }
        assert!(
            (work / thick.at(6e-3)[0] - 1.0).abs() < 1e-9,
            "beyond the table too"
        );
        assert_eq!(thick.at(-1e-3), [0.0; 3]);
        assert_eq!(thick.at(f64::NAN), [0.0; 3]);
    }
}
