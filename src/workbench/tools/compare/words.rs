//! What is said of differences, and the scales they are drawn on.

use crate::kit::widgets::axis::round_step;
use selvedge_foundation::quantity::{fixed, with_unit};
use selvedge_render::{LevelDifference, Tally};
use selvedge_textile::tactile::Band;

/// A band's name.
pub(crate) fn band_name(band: Band) -> String {
    with_unit(band.carrier_hz(), 0, "Hz")
}

/// What was found of a band, in a line.
pub(crate) fn summary(tally: &Tally) -> String {
    let (Some(mean_db), Some(largest)) = (tally.mean_db(), tally.largest) else {
        return alone_words(tally).to_owned();
    };
    let n_apart = tally.n_only[0] + tally.n_only[1];
    if largest.difference_db.abs() < 1e-9 && n_apart == 0 {
        return "no difference at any tick, 0.00 dB".to_owned();
    }
    let decimals = decimals_of(largest.difference_db);
    let [mean, most] = [mean_db, largest.difference_db].map(|db| with_unit(db, decimals, "dB"));
    let (tick, contactor) = (largest.tick, largest.contactor);
    let n_all = tally.n_both + n_apart;
    let alone = ["A", "B"].into_iter().zip(tally.n_only);
    let alone = alone
        .filter(|(_, n_only)| *n_only > 0)
        .map(|(name, n_only)| {
            let share = fixed(100.0 * n_only as f64 / n_all as f64, 1);
            format!(", {name} only in {share} %")
        });
    let alone: String = alone.collect();
    format!("mean {mean}, largest {most} at tick {tick}, contactor {contactor}{alone}")
}

/// What is said where no difference can be.
pub(crate) fn alone_words(tally: &Tally) -> &'static str {
    match tally.n_only {
        [0, 0] => "silent in both",
        [_, 0] => "A only: B is silent",
        [0, _] => "B only: A is silent",
        _ => "never both at once: A only or B only",
    }
}

/// Half the range of a scale of differences: the least of 1, 2, 5 · 10ⁿ that holds the largest;
/// 1 dB where there are none.
pub(crate) fn scale_db(differences_db: impl Iterator<Item = f64>) -> f64 {
    let largest = differences_db.map(f64::abs).fold(0.0, f64::max);
    if largest > 1e-6 {
        round_step(largest.max(1e-4))
    } else {
        1.0
    }
}

/// The unit of a scale of differences and how many of it are a dB: methods differ by so little that
/// thousandths are needed.
pub(crate) fn unit_of(most_db: f64) -> (&'static str, f64) {
    if most_db < 0.1 {
        ("mdB", 1000.0)
    } else {
        ("dB", 1.0)
    }
}

/// Decimals that a difference is written with: methods differ by very little.
pub(crate) fn decimals_of(difference_db: f64) -> usize {
    let magnitude = difference_db.abs();
    if magnitude > 1e-6 && magnitude < 0.1 {
        4
    } else {
        2
    }
}

/// Sounding contactors by band, for those who do not see the maps.
pub(crate) fn describe(found: &LevelDifference) -> String {
    let of_band = |band: Band| {
        let cells = || found.by_contactor.iter().map(|cell| &cell[band.index()]);
        let n_both = cells().filter(|tally| tally.n_both > 0).count();
        let n_only = [0, 1].map(|side| {
            let is_only = |t: &&Tally| t.n_both == 0 && t.n_only[side] > 0;
            cells().filter(is_only).count()
        });
        let [n_a, n_b] = n_only;
        format!(
            "{}: {n_both} in both, {n_a} A only, {n_b} B only",
            band_name(band)
        )
    };
    Band::ALL.map(of_band).join("; ")
}

/// A difference as people read it: with its sign.
pub(crate) fn signed_db(difference_db: f64, decimals: usize) -> String {
    let words = with_unit(difference_db, decimals, "dB");
    if difference_db > 0.0 {
        format!("+{words}")
    } else {
        words
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_render::Largest;

    fn tally(mean_db: Option<f64>, n_only: [u64; 2]) -> Tally {
        let mut tally = Tally::default();
        tally.n_only = n_only;
        if let Some(difference_db) = mean_db {
            tally = Tally::of_one(Largest {
                difference_db,
                tick: 80,
                contactor: 5,
            });
            tally.n_only = n_only;
        }
        tally
    }

    #[test]
    fn a_band_is_summed_up_with_where_it_differs_most() {
        let words = summary(&tally(Some(-3.414), [0, 0]));
        assert_eq!(
            words,
            "mean −3.41 dB, largest −3.41 dB at tick 80, contactor 5"
        );
        assert!(summary(&tally(Some(0.0), [0, 0])).starts_with("no difference"));
        let words = summary(&tally(Some(1.0), [0, 3]));
        assert!(words.ends_with("contactor 5, B only in 75.0 %"), "{words}");
    }

    #[test]
    fn where_one_is_silent_no_number_is_made_up() {
        let said = [[0, 0], [2, 0], [0, 2], [2, 2]].map(|n_only| summary(&tally(None, n_only)));
        assert_eq!(said[0], "silent in both");
        assert_eq!(said[1], "A only: B is silent");
        assert_eq!(said[2], "B only: A is silent");
        assert!(said[3].starts_with("never both at once"));
        for words in said {
            assert!(!words.contains('∞') && !words.contains("NaN"), "{words}");
        }
    }

    #[test]
    fn the_scale_is_round_and_holds_the_largest() {
        assert_eq!(scale_db([0.4, -3.0].into_iter()), 5.0);
        assert_eq!(scale_db([0.0].into_iter()), 1.0);
        assert_eq!(scale_db(std::iter::empty()), 1.0);
        assert_eq!([0.0, 0.0123, -3.0].map(decimals_of), [2, 4, 2]);
        assert_eq!([0.05, 0.1].map(|db| unit_of(db).0), ["mdB", "dB"]);
        assert_eq!(signed_db(0.5, 1), "+0.5 dB");
        assert_eq!(signed_db(-0.5, 1), "−0.5 dB");
    }
}
