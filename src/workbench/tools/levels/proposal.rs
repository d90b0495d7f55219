//! The smallest change of gains that brings a set of textiles to its levels and ends clipping.
//!
//! What is wanted of a textile and band is its target, or without any target in the set the set's
//! mean of the band. The wanted changes are taken apart by least squares into one for everything,
//! one for each band and one for each textile (a two-way analysis with cells that may be empty);
//! what would not be noticed is left out. At last the master gives way until nothing clips.

use selvedge_foundation::quantity::factor_of_gain;

/// Passes of the fit: it converges at once where no cell is empty.
const N_PASSES: usize = 200;
/// Gains are proposed in steps of this, dB.
const STEP_DB: f64 = 0.1;

/// A textile of the set.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Row {
    /// Levels above threshold, dB; −∞ for silence.
    pub(crate) level_db: [f64; 2],
    /// What they are to be, where it is said.
    pub(crate) target_db: [Option<f64>; 2],
    /// The change that is just noticed, dB.
    pub(crate) noticed_db: f64,
    /// Its loudest amplitudes with the gains in force.
    pub(crate) peaks: Peaks,
}

/// The loudest amplitudes of a textile, as shares of the full scales.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Peaks {
    /// Pairs of 40 and 320 Hz, of which none beats another in both.
    pub(crate) shares: Vec<[f64; 2]>,
    /// What each band alone may reach; both together may reach 1.
    pub(crate) limits: [f64; 2],
}

impl Default for Peaks {
    fn default() -> Self {
        Self {
            shares: Vec::new(),
            limits: [1.0; 2],
        }
    }
}

impl Peaks {
    /// How far the loudest is below clipping after a change of both bands, dB; `None` for silence.
    pub(crate) fn headroom_db(&self, by_db: [f64; 2]) -> Option<f64> {
        let [low, high] = by_db.map(factor_of_gain);
        let used = self.shares.iter().map(|share| {
            let [low, high] = [low * share[0], high * share[1]];
            (low + high)
                .max(low / self.limits[0])
                .max(high / self.limits[1])
        });
        let most = used.fold(0.0, f64::max);
        (most > 0.0).then(|| -20.0 * most.log10())
    }
}

/// A change of gains, dB.
#[derive(Debug, Clone, PartialEq, Default)]
#[expect(clippy::struct_field_names, reason = "units are in names")]
pub(crate) struct Change {
    /// Of everything.
    pub(crate) master_db: f64,
    /// Of each band.
    pub(crate) band_db: [f64; 2],
    /// Of each textile.
    pub(crate) own_db: Vec<f64>,
}

/// The change that is proposed; all zero where nothing is to be changed. Nothing of the set clips
/// then, nor any other that is heard by the same gains.
pub(crate) fn propose<'a>(rows: &'a [Row], others: impl Iterator<Item = &'a Peaks>) -> Change {
    let mut change = levelled(rows);
    let set = rows.iter().map(|row| &row.peaks).zip(&change.own_db);
    let over = set.chain(others.zip(std::iter::repeat(&0.0)));
    let over = over.filter_map(|(peaks, own_db)| {
        let by_db = change
            .band_db
            .map(|band_db| change.master_db + band_db + own_db);
        Some(-peaks.headroom_db(by_db)?)
    });
    let over_db = over.fold(0.0, f64::max);
    change.master_db -= (over_db / STEP_DB).ceil() * STEP_DB;
    change.master_db = in_steps(change.master_db);
    change
}

/// The change that brings levels where they are wanted, of noticeable parts alone.
fn levelled(rows: &[Row]) -> Change {
    let has_targets = rows.iter().any(|row| row.target_db != [None; 2]);
    let mean = |band: usize| {
        let heard = rows.iter().map(|row| row.level_db[band]);
        mean_of(heard.filter(|db| db.is_finite())).unwrap_or(0.0)
    };
    let means = [mean(0), mean(1)];
    let wanted: Vec<[Option<f64>; 2]> = rows
        .iter()
        .map(|row| {
            [0, 1].map(|band| {
                let target = if has_targets {
                    row.target_db[band]
                } else {
                    Some(means[band])
                };
                let by_db = target? - row.level_db[band];
                by_db.is_finite().then_some(by_db)
            })
        })
        .collect();
    let mut fit = Change {
        own_db: vec![0.0; rows.len()],
        ..Change::default()
    };
    for _ in 0..N_PASSES {
        let rest = |fit: &Change, nth: usize, band: usize| {
            Some(wanted[nth][band]? - fit.master_db - fit.band_db[band] - fit.own_db[nth])
        };
        let all = (0..rows.len()).flat_map(|nth| [0, 1].map(|band| rest(&fit, nth, band)));
        fit.master_db += mean_of(all.flatten()).unwrap_or(0.0);
        for band in 0..2 {
            let of_band = (0..rows.len()).filter_map(|nth| rest(&fit, nth, band));
            fit.band_db[band] += mean_of(of_band).unwrap_or(0.0);
        }
        for nth in 0..rows.len() {
            let own = [0, 1].into_iter().filter_map(|band| rest(&fit, nth, band));
            fit.own_db[nth] += mean_of(own).unwrap_or(0.0);
        }
    }
    noticeable(fit, rows)
}

/// A change without the parts that nobody would notice, in whole steps.
fn noticeable(mut change: Change, rows: &[Row]) -> Change {
    let least = rows
        .iter()
        .map(|row| row.noticed_db)
        .fold(f64::INFINITY, f64::min);
    let kept = |db: f64, noticed_db: f64| {
        let is_noticed = db.abs() > noticed_db;
        if is_noticed { in_steps(db) } else { 0.0 }
    };
    change.master_db = kept(change.master_db, least);
    change.band_db = change.band_db.map(|db| kept(db, least));
    for (own_db, row) in change.own_db.iter_mut().zip(rows) {
        *own_db = kept(*own_db, row.noticed_db);
    }
    change
}

/// Whole steps, as short in files as on the screen.
fn in_steps(db: f64) -> f64 {
    (db / STEP_DB).round() / (1.0 / STEP_DB).round()
}

fn mean_of(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (n, sum) = values.fold((0.0, 0.0), |(n, sum), value| (n + 1.0, sum + value));
    (n > 0.0).then(|| sum / n)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn peaks(shares: &[[f64; 2]]) -> Peaks {
        Peaks {
            shares: shares.to_vec(),
            ..Peaks::default()
        }
    }

    fn row(level_db: [f64; 2], target_db: [Option<f64>; 2]) -> Row {
        Row {
            level_db,
            target_db,
            noticed_db: 1.0,
            peaks: peaks(&[[0.2, 0.3]]),
        }
    }

    #[test]
    fn without_targets_the_set_meets_in_its_mean_and_near_ones_are_left_alone() {
        let rows = [[10.0, 20.0], [16.0, 26.0], [13.5, 23.0]].map(|level| row(level, [None; 2]));
        let change = propose(&rows, [].iter());
        assert_eq!((change.master_db, change.band_db), (0.0, [0.0; 2]));
        assert_eq!(change.own_db, [3.1, -2.9, 0.0]);
    }

    #[test]
    fn targets_are_reached_by_master_bands_and_textiles() {
        let rows = [
            row([10.0, 20.0], [Some(16.0), Some(20.0)]),
            row([12.0, 25.0], [Some(21.0), Some(28.0)]),
        ];
        let change = propose(&rows, [].iter());
        for (row, own_db) in rows.iter().zip(&change.own_db) {
            for band in 0..2 {
                let by_db = change.master_db + change.band_db[band] + own_db;
                let off = row.level_db[band] + by_db - row.target_db[band].unwrap();
                assert!(off.abs() < 0.16, "{change:?}: {off}");
            }
        }
    }

    #[test]
    fn cells_without_a_target_or_a_level_are_not_chased() {
        let silent = f64::NEG_INFINITY;
        let rows = [
            row([10.0, silent], [Some(14.0), Some(20.0)]),
            row([12.0, 25.0], [None, None]),
        ];
        let change = propose(&rows, [].iter());
        let on_first = change.master_db + change.band_db[0] + change.own_db[0];
        assert!((on_first - 4.0).abs() < 0.16, "{change:?}");
        assert!(change.own_db.iter().all(|db| db.is_finite()));
    }

    #[test]
    fn the_master_gives_way_until_nothing_clips() {
        let mut rows = [row([20.0, 20.0], [None; 2]), row([20.0, 20.0], [None; 2])];
        rows[1].peaks = peaks(&[[0.1, 0.1], [0.9, 0.6]]);
        let change = propose(&rows, [].iter());
        assert_eq!(change.master_db, -3.6, "1.5 is 3.52 dB too much");
        let by_db = [change.master_db; 2];
        assert!(rows[1].peaks.headroom_db(by_db).unwrap() >= 0.0);
        rows[1].peaks.limits[1] = 0.3;
        let headroom_db = rows[1].peaks.headroom_db([0.0; 2]).unwrap();
        assert!(
            (headroom_db + 6.02).abs() < 0.01,
            "320 Hz is twice its limit: {headroom_db}"
        );
        assert_eq!(Peaks::default().headroom_db([0.0; 2]), None);
        assert_eq!(propose(&[], [].iter()), Change::default());
    }

    #[test]
    fn the_master_gives_way_to_a_loud_textile_that_is_not_placed() {
        let rows = [row([20.0, 20.0], [None; 2])];
        let loud = [peaks(&[[0.9, 0.6]])];
        assert_eq!(
            propose(&rows, [].iter()),
            Change {
                own_db: vec![0.0],
                ..Change::default()
            }
        );
        let change = propose(&rows, loud.iter());
        assert_eq!(change.master_db, -3.6, "1.5 is 3.52 dB too much");
    }
}
