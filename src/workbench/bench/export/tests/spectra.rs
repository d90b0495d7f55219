//! Exports of what the chosen contactor reads and is driven by: spectra and the waveform.

use super::*;
use crate::bench::signals::rows::N_ROWS;
use crate::bench::signals::spatial::density_db;
use crate::tools::spectra::wave::TwoTicks;

#[test]
fn spectrograms_hold_what_was_computed_even_behind_other_panes() {
    let mut desk = Headless::explored(400);
    for (what, name) in [
        (Pane::ContactSpectrum, "level_db"),
        (Pane::DriveSpectrum, "amplitude_um"),
    ] {
        let exported = desk.exported(Exportable::Pane(what));
        let (values, ticks) = (column(&exported, name), column(&exported, "tick"));
        let n_columns = values.len() / N_ROWS;
        assert!(
            (200..320).contains(&n_columns),
            "8 s less the gaps between textiles, whether drawn or not: {n_columns}"
        );
        for rows in values.chunks_exact(N_ROWS) {
            assert!(
                rows.iter().any(|value| value.is_finite()),
                "a gap has no rows"
            );
        }
        let mut samples = desk.workbench.bench.past.history.tick_samples();
        let shown = samples.rfind(|one| ticks.last() == Some(&(one.tick as f64)));
        let newest = *shown.unwrap();
        let times = column(&exported, "t_s");
        assert!(times[0] >= -319.0 / 40.0 && times.is_sorted(), "{times:?}");
        let last = &values[values.len() - N_ROWS..];
        if what == Pane::DriveSpectrum {
            let largest = last.iter().copied().fold(0.0, f64::max);
            let louder = newest.watched_um.map(f64::from);
            let most = louder[0].max(louder[1]);
            assert!(
                largest > 0.3 * most && largest < 3.0 * most,
                "{largest} of {most}"
            );
        } else {
            let contactor = desk.workbench.bench.selection.contactor.unwrap();
            let mut expected = [0.0; N_ROWS];
            crate::bench::signals::contact::ContactColumns::default().levels_db(
                &mut desk.workbench.bench.inspection.inspector,
                [0, contactor],
                &newest.pose,
                &mut expected,
            );
            for (read, shown) in last.iter().zip(expected) {
                let is_same = if shown.is_finite() {
                    (*read - f64::from(shown)).abs() < 1e-5
                } else {
                    read.is_nan()
                };
                assert!(is_same, "{read} for {shown}");
            }
        }
    }
}

#[test]
fn the_waveform_is_the_sum_of_both_bands_with_their_amplitudes() {
    let mut desk = Headless::explored(60);
    let exported = desk.exported(Exportable::Pane(Pane::DriveWave));
    let shown = TwoTicks::of_chosen(&desk.workbench.bench);
    let times = column(&exported, "t_s");
    for (band, name) in ["wave_40_um", "wave_320_um"].into_iter().enumerate() {
        let wave = column(&exported, name);
        let second = times.iter().position(|t_s| *t_s >= 0.025).unwrap();
        let most = wave[second..].iter().copied().fold(0.0, f64::max);
        let amplitude = shown.now_um[band];
        assert!(
            (most - amplitude).abs() < 0.02 * amplitude,
            "{most} of {amplitude}"
        );
    }
    let waves = ["wave_40_um", "wave_320_um", "sum_um"].map(|name| column(&exported, name));
    for ((low, high), sum) in waves[0].iter().zip(&waves[1]).zip(&waves[2]) {
        assert!((low + high - sum).abs() < 1e-9, "{low} + {high} = {sum}");
    }
}

#[test]
fn spatial_spectra_hold_every_bin_of_every_direction() {
    let mut desk = Headless::explored(60);
    let exported = desk.exported(Exportable::Pane(Pane::SpatialSpectra));
    let (density, level) = (
        column(&exported, "density_um2_mm"),
        column(&exported, "level_db"),
    );
    assert_eq!(density.len(), 4 * 500);
    for (density, level) in density
        .iter()
        .zip(&level)
        .filter(|(density, _)| **density > 0.0)
    {
        assert!((density_db(*density) - level).abs() < 1e-9, "{level}");
    }
    let sounds = column(&exported, "sounds_at_hz");
    assert!(sounds.iter().any(|hz| *hz > 0.0), "something sounds");
    let rules = &exported.figure.rows[0].panels[0].rules;
    assert_eq!(rules.len(), 2, "40 and 320 Hz are marked");
}
