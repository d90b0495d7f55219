//! The vibration that arrives at a contactor at a tick, in rows of log frequency.

use crate::bench::signals::rows::{N_ROWS, RowEdges, Rows};
use selvedge_foundation::numerics::to_single;
use selvedge_foundation::quantity::level_db;
use selvedge_render::array::{ContactInspector, VibrationBin};
use selvedge_render::scene::Pose;

/// Computes columns of the contact spectrogram; reuses what it needs for that.
#[derive(Debug, Clone, Default)]
pub(crate) struct ContactColumns {
    edges: RowEdges,
    bins: Vec<VibrationBin>,
}

impl ContactColumns {
    /// The level of every row, dB re 1 µm: of the peak amplitude `√(2 Σ P)` of the power that the
    /// surface's heights bring into the row at this pose, before filters and gains. A bin's power
    /// lies evenly over `[f − Δf/2, f + Δf/2]`, `Δf = |v|·0.23` Hz. −∞ where nothing arrives.
    pub(crate) fn levels_db(
        &mut self,
        inspector: &mut ContactInspector,
        [display, contactor]: [usize; 2],
        pose: &Pose,
        levels_db: &mut Rows,
    ) {
        inspector.vibration_into(display, contactor, pose, &mut self.bins);
        let mut powers_um2 = [0.0; N_ROWS];
        self.edges.add(&self.bins, &mut powers_um2);
        for (level, power) in levels_db.iter_mut().zip(powers_um2) {
            let rounded = to_single(level_db((2.0 * power).sqrt()));
            *level = rounded;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::signals::rows::row_at;
    use crate::bench::signals::spatial::tests::scene;
    use selvedge_foundation::geometry::Velocity;
    use selvedge_render::RenderScene;

    #[test]
    fn a_sine_arrives_with_its_amplitude_where_its_speed_puts_it() {
        let mut inspector = ContactInspector::new(&scene());
        let pose = Pose {
            position: [20.0, 5.0].into(),
            velocity: Velocity::new(273.2, 0.0),
            ..Pose::default()
        };
        let mut levels_db = [0.0; N_ROWS];
        ContactColumns::default().levels_db(&mut inspector, [0, 0], &pose, &mut levels_db);
        let squares = levels_db.map(|db| 10_f64.powf(f64::from(db) / 10.0));
        let amplitude_um = squares.iter().sum::<f64>().sqrt();
        // 1 µm, but for what the window leaves of a sine that does not fit into it.
        assert!((amplitude_um - 1.0).abs() < 0.02, "{amplitude_um}");
        let strongest = (0..N_ROWS).max_by(|a, b| squares[*a].total_cmp(&squares[*b]));
        let expected = row_at(200.0);
        let off = strongest.unwrap().abs_diff(expected);
        assert!(off <= 5, "bins are 63 Hz wide: {off} rows off 200 Hz");
    }

    #[test]
    fn nothing_arrives_without_a_textile() {
        let mut inspector = ContactInspector::new(&RenderScene::default());
        let mut levels = [0.0; N_ROWS];
        let mut columns = ContactColumns::default();
        columns.levels_db(&mut inspector, [0, 3], &Pose::default(), &mut levels);
        assert_eq!(levels, [f32::NEG_INFINITY; N_ROWS]);
    }
}
