//! Strips: speed and mean amplitudes of an exploration, tick for tick, and as few columns as the
//! screen has room for, in which no peak is lost.

use selvedge_foundation::quantity;
use selvedge_render::scene::{ExplorationPath, Pose};
use selvedge_textile::tactile::vibrating_mean_um;

/// Entries in a strip. An exploration with more ticks (seven hours) has several in each.
const MOST_ENTRIES: u64 = 1 << 20;

/// Speed and mean amplitudes of an exploration over time.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Strips {
    n_ticks: u64,
    ticks_per_entry: u64,
    speed_mm_per_s: Vec<f32>,
    fastest_mm_per_s: f32,
    /// As long as the speeds, or empty when nobody knows them.
    mean_um: Vec<[f32; 2]>,
}

/// One tick of an exploration.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Felt {
    /// How fast the display moves, mm/s.
    pub speed_mm_per_s: f64,
    /// Mean amplitudes of both bands over the contactors that vibrate, µm; `None` when unknown.
    pub mean_um: Option<[f64; 2]>,
}

/// From the least of some values to the most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Extent {
    /// The least.
    pub least: f64,
    /// The most.
    pub most: f64,
}

/// What a column of the screen shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Column {
    /// Speed, mm/s.
    pub speed_mm_per_s: Extent,
    /// Mean level of both bands, dB re 1 µm, in the ticks that were felt; `None` without any.
    pub level_db: [Option<Extent>; 2],
}

impl Strips {
    /// The strips of ticks that were felt: pose and the amplitudes of all contactors in µm.
    pub(crate) fn felt<'a>(ticks: impl Iterator<Item = (Pose, &'a [[f32; 2]])>) -> Self {
        let (speed_mm_per_s, mean_um): (Vec<_>, Vec<_>) = ticks
            .map(|(pose, amplitudes_um)| (speed(pose), mean_um(amplitudes_um)))
            .unzip();
        Self {
            n_ticks: speed_mm_per_s.len() as u64,
            ticks_per_entry: 1,
            fastest_mm_per_s: fastest(&speed_mm_per_s),
            speed_mm_per_s,
            mean_um,
        }
    }

    /// The strips of a path, whose amplitudes nobody knows. Of several ticks in one entry the
    /// fastest counts.
    pub(crate) fn moved(path: &ExplorationPath) -> Self {
        let n_ticks = path.n_ticks();
        let ticks_per_entry = n_ticks.div_ceil(MOST_ENTRIES).max(1);
        let mut speed_mm_per_s: Vec<f32> = Vec::new();
        for (tick, pose) in path.ticks() {
            match speed_mm_per_s.last_mut() {
                Some(last) if tick % ticks_per_entry != 0 => *last = last.max(speed(pose)),
                _ => speed_mm_per_s.push(speed(pose)),
            }
        }
        Self {
            n_ticks,
            ticks_per_entry,
            fastest_mm_per_s: fastest(&speed_mm_per_s),
            speed_mm_per_s,
            mean_um: Vec::new(),
        }
    }

    /// Ticks of the exploration.
    pub(crate) fn n_ticks(&self) -> u64 {
        self.n_ticks
    }

    /// Ticks that one entry stands for: 1 in all but the longest explorations.
    pub(crate) fn ticks_per_entry(&self) -> u64 {
        self.ticks_per_entry.max(1)
    }

    /// Whether amplitudes are known.
    pub(crate) fn has_levels(&self) -> bool {
        !self.mean_um.is_empty()
    }

    /// The highest speed, mm/s.
    pub(crate) fn fastest_mm_per_s(&self) -> f64 {
        f64::from(self.fastest_mm_per_s)
    }

    /// What was at a tick; `None` past the end.
    pub(crate) fn at(&self, tick: u64) -> Option<Felt> {
        let entry = usize::try_from(tick / self.ticks_per_entry.max(1)).ok()?;
        Some(Felt {
            speed_mm_per_s: f64::from(*self.speed_mm_per_s.get(entry)?),
            mean_um: self.mean_um.get(entry).map(|um| um.map(f64::from)),
        })
    }

    /// The whole in `n_columns`, or one column for each entry where there is room for that. Walks
    /// through everything: keep what it gives.
    pub(crate) fn columns(&self, n_columns: usize) -> Vec<Column> {
        let n = self.speed_mm_per_s.len();
        let n_columns = n_columns.min(n);
        (0..n_columns)
            .map(|column| self.column(column * n / n_columns, (column + 1) * n / n_columns))
            .collect()
    }

    fn column(&self, from: usize, to: usize) -> Column {
        let speeds = self.speed_mm_per_s[from..to].iter().copied();
        let felt_um = self.mean_um.get(from..to).unwrap_or_default();
        let level_db = [0, 1].map(|band| {
            let extent = extent(felt_um.iter().map(|um| um[band]).filter(|um| *um > 0.0))?;
            Some(Extent {
                least: quantity::level_db(extent.least),
                most: quantity::level_db(extent.most),
            })
        });
        Column {
            speed_mm_per_s: extent(speeds).unwrap_or(Extent {
                least: 0.0,
                most: 0.0,
            }),
            level_db,
        }
    }
}

fn extent(values: impl Iterator<Item = f32>) -> Option<Extent> {
    let none = (f32::INFINITY, f32::NEG_INFINITY);
    let (least, most) = values.fold(none, |(least, most), value| {
        (least.min(value), most.max(value))
    });
    (least <= most).then(|| Extent {
        least: f64::from(least),
        most: f64::from(most),
    })
}

fn fastest(speed_mm_per_s: &[f32]) -> f32 {
    speed_mm_per_s.iter().copied().fold(0.0, f32::max)
}

fn speed(pose: Pose) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "a speed, for the screen")]
    let speed = pose.velocity.speed_mm_per_s() as f32;
    if speed.is_finite() { speed } else { 0.0 }
}

/// Mean over the contactors that vibrate in either band, µm; 0 when none does. A recording does
/// not say which contactors lie on a textile; those that vibrate do.
fn mean_um(amplitudes_um: &[[f32; 2]]) -> [f32; 2] {
    let amplitudes_um = amplitudes_um.iter().map(|um| um.map(f64::from));
    let (_, mean_um) = vibrating_mean_um(amplitudes_um);
    #[expect(clippy::cast_possible_truncation, reason = "a mean, for the screen")]
    let single = mean_um.map(|um| um as f32);
    single
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::geometry::{Point, Velocity};
    use selvedge_render::scene::PathRow;

    fn pose(speed_mm_per_s: f64) -> Pose {
        Pose {
            velocity: Velocity::new(0.0, -speed_mm_per_s),
            ..Pose::default()
        }
    }

    /// A long quiet exploration with one loud and fast tick in it.
    fn with_a_peak(n: usize, peak: usize) -> Strips {
        let (quiet, loud) = ([[1.0, 10.0]; 2], [[100.0, 10.0]; 2]);
        let tick = |i| {
            if i == peak {
                (pose(300.0), &loud[..])
            } else {
                (pose(50.0), &quiet[..])
            }
        };
        Strips::felt((0..n).map(tick))
    }

    #[test]
    fn a_tick_holds_its_speed_and_the_mean_of_what_vibrates() {
        let amplitudes_um = [[2.0, 0.0], [4.0, 6.0], [0.0, 0.0]];
        let ticks = [(pose(30.0), &amplitudes_um[..]), (pose(0.0), &[][..])];
        let strips = Strips::felt(ticks.into_iter());
        let felt = Felt {
            speed_mm_per_s: 30.0,
            mean_um: Some([3.0, 3.0]),
        };
        let still = Felt {
            speed_mm_per_s: 0.0,
            mean_um: Some([0.0, 0.0]),
        };
        assert_eq!(
            (strips.at(0), strips.at(1), strips.at(2)),
            (Some(felt), Some(still), None)
        );
        assert_eq!((strips.n_ticks(), strips.has_levels()), (2, true));
    }

    #[test]
    fn columns_keep_every_peak() {
        for peak in [0, 1, 4_999, 99_998, 99_999] {
            let strips = with_a_peak(100_000, peak);
            let columns = strips.columns(777);
            assert_eq!(columns.len(), 777);
            let peaks: Vec<&Column> = columns
                .iter()
                .filter(|column| column.speed_mm_per_s.most > 299.0)
                .collect();
            assert_eq!(peaks.len(), 1, "peak at {peak}");
            assert_eq!(peaks[0].speed_mm_per_s.least, 50.0);
            let low = peaks[0].level_db[0].unwrap();
            assert!((low.most - 40.0).abs() < 1e-6 && low.least.abs() < 1e-6);
        }
    }

    #[test]
    fn few_ticks_have_a_column_each() {
        let columns = with_a_peak(5, 2).columns(900);
        assert_eq!(columns.len(), 5);
        assert_eq!(columns[2].speed_mm_per_s.least, 300.0);
    }

    #[test]
    fn silence_has_no_level_and_nothing_has_no_columns() {
        let silent = [[0.0; 2]; 3];
        let columns = Strips::felt([(pose(9.0), &silent[..])].into_iter()).columns(10);
        assert_eq!(columns[0].level_db, [None, None]);
        assert!(Strips::default().columns(10).is_empty());
        assert!(with_a_peak(5, 2).columns(0).is_empty());
        assert_eq!(Strips::default().at(0), None);
    }

    #[test]
    fn what_is_not_finite_is_drawn_as_rest() {
        let broken = [[f32::INFINITY, 1.0]];
        let strips = Strips::felt([(pose(f64::NAN), &broken[..])].into_iter());
        let instant = strips.at(0).unwrap();
        assert_eq!(instant.speed_mm_per_s, 0.0);
        assert_eq!(instant.mean_um, Some([0.0, 1.0]));
    }

    #[test]
    fn a_path_of_days_stays_small_and_keeps_its_fastest_tick() {
        let row = |t_s, x_mm| PathRow {
            t_s,
            position: Point::new(x_mm, 0.0),
            ..PathRow::default()
        };
        let rows = vec![row(0.0, 0.0), row(60_000.0, 0.0), row(60_000.025, 5.0)];
        let path = ExplorationPath::new(rows).unwrap();
        let strips = Strips::moved(&path);
        assert_eq!(strips.n_ticks(), path.n_ticks());
        assert!(strips.speed_mm_per_s.len() as u64 <= MOST_ENTRIES);
        assert!((strips.fastest_mm_per_s() - 200.0).abs() < 0.1);
        let last = strips.at(path.n_ticks() - 1).unwrap();
        assert!((last.speed_mm_per_s - 200.0).abs() < 0.1, "{last:?}");
        assert_eq!(strips.at(path.n_ticks() + 2), None);
    }
}
