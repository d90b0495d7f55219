//! Both spectrograms: every cell that is shown, and the picture with its axes and its colour bar.

use crate::bench::amplitude::AmplitudeScale;
use crate::bench::export::origin::Origin;
use crate::bench::export::{Exported, Sheet, bar, ink, rgb};
use crate::bench::signals::ring::N_COLUMNS;
use crate::bench::signals::rows::{LEAST_HZ, MOST_HZ, N_ROWS, row_centre_hz};
use crate::kit::spectrogram::ShownColumn;
use crate::kit::theme::colour_map::ColourMap;
use crate::tools::spectra::contact::{
    ContactSpectrumView, LEVELS_DB as CONTACT_LEVELS_DB, share_of as contact_share,
};
use selvedge_chart::{At, Axis, Chart, Extent, Raster, Row, Rule, Series, Style, Upright};
use selvedge_render::scene::TICKS_PER_S;
use selvedge_textile::tactile::{Band, Filters};

/// Height of the picture, px.
const HEIGHT_PX: f64 = 300.0;
/// Steps of a filter's curve.
const N_STEPS: u8 = 96;

/// The spectrum that arrives at a contactor.
pub(crate) fn contact(
    columns: &[ShownColumn],
    view: &ContactSpectrumView<'_>,
    origin: Origin,
) -> Exported {
    let map = view.map;
    let colour = |level_db: f32| rgb(map, contact_share(level_db));
    let picture = Chart {
        width: 9.0,
        ..picture(columns, colour)
    };
    let bar = bar(
        map,
        Axis::linear("level, dB re 1 µm").within(CONTACT_LEVELS_DB),
    );
    let row = Row {
        panels: vec![picture, filters(view.filters)],
        height_px: HEIGHT_PX,
        bar: Some(bar),
    };
    let title = format!("Vibration that arrives at contactor {}", view.contactor);
    let note = "Peak amplitude at the surface, before filters and gains, in rows 4.9 % of the \
                frequency wide; each column is a tick of 25 ms, white where nothing was felt. \
                Right: amplitude gain of the filters.";
    let ticks = columns.iter().map(|column| column.tick);
    let origin = origin.of_contactor(view.contactor).in_ticks(ticks);
    Exported::new(title, sheet(columns, "level_db"), vec![row], note, origin)
}

/// The spectrum of what drives a contactor.
pub(crate) fn drive(
    columns: &[ShownColumn],
    contactor: usize,
    (scale, map): (AmplitudeScale, ColourMap),
    origin: Origin,
) -> Exported {
    let colour = |um: f32| rgb(map, scale.share(f64::from(um)));
    let carrier = |band: Band| Rule {
        at: At::Y(band.carrier_hz()),
        ink: ink(band),
        extent: Extent::Edge,
        ..Rule::default()
    };
    let picture = Chart {
        rules: Band::ALL.map(carrier).to_vec(),
        ..picture(columns, colour)
    };
    let ends = [scale.least_um(), scale.most_um()];
    let row = Row {
        panels: vec![picture],
        height_px: HEIGHT_PX,
        bar: Some(bar(map, Axis::log("peak amplitude, µm").within(ends))),
    };
    let title = format!("Spectrum that drives contactor {contactor}");
    let note = "Amplitude spectrum (peak) of the drive, after gains and before output limits: \
                100 ms under a Hann window whose gain is compensated; the largest in rows 4.9 % of \
                the frequency wide. Marks on the right: 40 and 320 Hz.";
    let ticks = columns.iter().map(|column| column.tick);
    let origin = origin.of_contactor(contactor).in_ticks(ticks);
    Exported::new(
        title,
        sheet(columns, "amplitude_um"),
        vec![row],
        note,
        origin,
    )
}

/// One row a cell, old to new and low to high.
fn sheet(columns: &[ShownColumn], value: &'static str) -> Sheet {
    let each = |of: &dyn Fn(&ShownColumn) -> f64| -> Vec<f64> {
        let each_row = |column| std::iter::repeat_n(of(column), N_ROWS);
        columns.iter().flat_map(each_row).collect()
    };
    let ticks = columns.iter().map(|column| column.tick);
    let ticks: Vec<u64> = ticks.flat_map(|tick| [tick; N_ROWS]).collect();
    let frequencies = (0..columns.len()).flat_map(|_| (0..N_ROWS).map(row_centre_hz));
    let values = columns.iter().flat_map(|column| column.rows);
    Sheet::default()
        .with("tick", ticks)
        .with("t_s", each(&|column| -(column.ago as f64) / TICKS_PER_S))
        .with("frequency_hz", frequencies.collect::<Vec<f64>>())
        .with(value, values.collect::<Vec<f32>>())
}

fn frequencies() -> Axis {
    Axis::log("frequency, Hz").within([LEAST_HZ, MOST_HZ])
}

/// The picture with its axes, the newest column at its right edge.
fn picture(columns: &[ShownColumn], colour: impl Fn(f32) -> [u8; 3]) -> Chart {
    let mut cells = vec![None; N_COLUMNS * N_ROWS];
    for column in columns {
        let from_right = usize::try_from(column.ago).unwrap_or(usize::MAX);
        let Some(x) = N_COLUMNS.checked_sub(from_right.saturating_add(1)) else {
            continue;
        };
        for (y, value) in column.rows.iter().rev().enumerate() {
            cells[y * N_COLUMNS + x] = (!value.is_nan()).then(|| colour(*value));
        }
    }
    let shown_s = N_COLUMNS as f64 / TICKS_PER_S;
    let felt = "felt time before the newest tick, s";
    Chart {
        x: Axis::linear(felt).within([-shown_s, 0.0]),
        y: frequencies(),
        raster: Some(Raster {
            n_columns: N_COLUMNS,
            cells,
        }),
        ..Chart::default()
    }
}

/// Both filters upright on the frequency axis of the picture.
fn filters(filters: &Filters) -> Chart {
    let curve = |band: Band| {
        let point = |i: u8| {
            let share = f64::from(i) / f64::from(N_STEPS);
            let frequency_hz = LEAST_HZ * (MOST_HZ / LEAST_HZ).powf(share);
            [filters.gain(band, frequency_hz), frequency_hz]
        };
        Series {
            points: (0..=N_STEPS).map(point).collect(),
            style: Style::Line,
            ink: ink(band),
            ..Series::default()
        }
    };
    Chart {
        x: Axis::whole("gain").within([0.0, 1.0]),
        y: frequencies(),
        upright: Upright::Shared,
        series: Band::ALL.map(curve).to_vec(),
        ..Chart::default()
    }
}
