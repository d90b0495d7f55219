//! The sheet of a textile: picture, amplitudes against speed, four profiles, local spectra,
//! friction; figures and provenance below.

use crate::curve::{corners, line, row};
use crate::surface::{BIN_SPACING_PER_MM, Direction};
use crate::tactile::{Band, Filters, LEVEL_SPEED_MM_PER_S, Levels, SpeedResponse};
use crate::{MeasuredFigure, Source, Textile, TextileError, Uncertainty};
use selvedge_chart::{
    Axis, Chart, ColourBar, Figure, Ink, Raster, Row, Series, Upright, Weight, Words,
};
use selvedge_foundation::numerics::{to_byte, to_index};
use selvedge_foundation::quantity::{factor_of_gain, level_db};

/// The side of the textile that is shown, mm.
const PICTURE_MM: f64 = 20.0;
/// Cells along that side.
const N_CELLS: u16 = 240;
/// Speeds of the curves, mm/s, and how many.
const SPEEDS_MM_PER_S: [f64; 2] = [10.0, 1000.0];
const N_SPEEDS: u8 = 61;
/// Amplitudes of the curves, µm: the same on every sheet.
const AMPLITUDES_UM: [f64; 2] = [0.01, 100.0];
/// Powers of a bin, dB re 1 µm²: the same on every sheet.
const POWERS_DB: [f64; 2] = [-50.0, 20.0];
/// Bins shown: up to 11.5 cycles/mm.
const N_BINS_SHOWN: usize = 50;

/// The sheet of a textile.
///
/// # Errors
/// Its picture or its friction cannot be read.
pub(super) fn sheet(textile: &Textile) -> Result<Figure, TextileError> {
    let manifest = textile.manifest();
    let mut rows = vec![row(vec![picture(textile)?, amplitudes(textile)], 250.0)];
    rows.extend(profiles(textile));
    rows.push(spectra(textile));
    rows.extend(friction(textile)?);
    let fibre = if manifest.fibre.is_empty() { "" } else { ", " };
    let made = manifest.construction.word();
    Ok(Figure {
        title: format!("{}: {made}{fibre}{}", manifest.name, manifest.fibre),
        rows,
        notes: notes(textile),
        about: about(textile),
    })
}

/// The textile from its lower left corner, tiled as on a display.
fn picture(textile: &Textile) -> Result<Chart, TextileError> {
    let side = |label| Axis::linear(label).within([0.0, PICTURE_MM]);
    let mut panel = Chart {
        title: "appearance".to_owned(),
        width: 250.0,
        x: side("along the warp, mm"),
        y: side("along the weft, mm"),
        ..Chart::default()
    };
    let Some(appearance) = textile.appearance()? else {
        panel.words.push(Words {
            at: [0.5 * PICTURE_MM; 2],
            text: "no picture".to_owned(),
            ..Words::default()
        });
        return Ok(panel);
    };
    let image = &appearance.image;
    let pixel = |mm: f64, n: usize| to_index(mm * appearance.px_per_mm) % n.max(1);
    let place = |cell: u16| (f64::from(cell) + 0.5) * PICTURE_MM / f64::from(N_CELLS);
    let mut cells = Vec::new();
    for row in (0..N_CELLS).rev() {
        let from_top = image
            .height
            .saturating_sub(1 + pixel(place(row), image.height));
        for column in 0..N_CELLS {
            let index = from_top * image.width + pixel(place(column), image.width);
            cells.push(image.pixels.get(index).copied());
        }
    }
    panel.raster = Some(Raster {
        n_columns: usize::from(N_CELLS),
        cells,
    });
    Ok(panel)
}

/// Both amplitudes against speed along one axis: the mean of all directions, and each thin.
fn amplitudes(textile: &Textile) -> Chart {
    let [slow, fast] = SPEEDS_MM_PER_S;
    let share = |i: u8| f64::from(i) / f64::from(N_SPEEDS - 1);
    let speeds: Vec<f64> = (0..N_SPEEDS)
        .map(|i| slow * (fast / slow).powf(share(i)))
        .collect();
    let responses: Vec<SpeedResponse> = speeds
        .iter()
        .map(|speed| SpeedResponse::at(*speed, &Filters::default()))
        .collect();
    let curve = |direction: Direction, band: Band| -> Vec<f64> {
        let spectra = textile.surface().spectra(direction);
        let mean = |response: &SpeedResponse| {
            let points = 0..spectra.n_points();
            let all = points.map(|point| {
                response.squared_amplitudes_um2(spectra.powers_um2(point))[band.index()].sqrt()
            });
            all.sum::<f64>() / spectra.n_points() as f64
        };
        responses.iter().map(mean).collect()
    };
    let mut series = Vec::new();
    for band in Band::ALL {
        let ink = match band {
            Band::Low => Ink::Amber,
            Band::High => Ink::Cyan,
        };
        let line = |values: Vec<f64>, weight| {
            let points = speeds.iter().zip(&values).map(|(speed, um)| [*speed, *um]);
            line(points.collect(), ink, weight)
        };
        let curves = Direction::ALL.map(|direction| curve(direction, band));
        let mean = (0..speeds.len()).map(|i| 0.25 * curves.iter().map(|c| c[i]).sum::<f64>());
        let mean: Vec<f64> = mean.collect();
        series.extend(curves.map(|values| line(values, Weight::Thin)));
        series.extend(whisker(textile, band, ink));
        series.push(Series {
            name: format!("A{}", band.carrier_hz()),
            ..line(mean, Weight::Bold)
        });
    }
    Chart {
        title: "amplitude against speed".to_owned(),
        width: 430.0,
        x: Axis::log("speed along one axis, mm/s").within(SPEEDS_MM_PER_S),
        y: Axis::log("peak amplitude, µm").within(AMPLITUDES_UM),
        series,
        ..Chart::default()
    }
}

/// From where to where the mean amplitude at 100 mm/s may lie, where it is not measured.
fn whisker(textile: &Textile, band: Band, ink: Ink) -> Option<Series> {
    let known = textile
        .manifest()
        .uncertainty
        .as_ref()
        .filter(|known| !known.levels.is_empty())?;
    let mean_um = Levels::of(textile.surface(), &Filters::default()).mean_um[band.index()];
    // A little apart, so that both are seen where they overlap.
    let speed = LEVEL_SPEED_MM_PER_S * (1.0 + 0.04 * band.index() as f64);
    let ends = known
        .mean_level_db(band)
        .map(|db| [speed, mean_um * factor_of_gain(db)]);
    Some(line(ends.to_vec(), ink, Weight::Bold))
}

/// The profiles that were measured, warp above weft, forward beside reverse.
fn profiles(textile: &Textile) -> Vec<Row> {
    let surface = textile.surface();
    let all = Direction::ALL
        .into_iter()
        .filter_map(|direction| surface.profile(direction));
    let largest_um = all
        .flat_map(|profile| {
            let heights = profile.heights_um();
            let mean = heights.iter().sum::<f64>() / heights.len() as f64;
            heights.iter().map(move |height| (height - mean).abs())
        })
        .fold(0.1, f64::max);
    let heights_um = Axis::linear("height, µm").within([-1.05 * largest_um, 1.05 * largest_um]);
    let panel = |direction: Direction| {
        let mut panel = Chart {
            title: direction.label().to_owned(),
            x: Axis::linear("distance travelled, mm").within([0.0, PICTURE_MM]),
            y: heights_um.clone(),
            upright: if direction.is_reverse() {
                Upright::Shared
            } else {
                Upright::Upward
            },
            is_x_shared: !direction.is_weft(),
            ..Chart::default()
        };
        let Some(profile) = surface.profile(direction) else {
            panel.title = format!("{}: not measured", direction.label());
            return panel;
        };
        let heights = profile.heights_um();
        let mean = heights.iter().sum::<f64>() / heights.len() as f64;
        let heights: Vec<f64> = heights.iter().map(|height| height - mean).collect();
        let length_mm = heights.len() as f64 * profile.step_mm();
        panel.x.range = Some([0.0, length_mm.max(PICTURE_MM)]);
        let points = corners(|i| i as f64 * profile.step_mm(), &heights);
        panel.series.push(line(points, Ink::Black, Weight::Thin));
        panel
    };
    Direction::BY_AXIS
        .map(|pair| row(pair.map(panel).to_vec(), 100.0))
        .to_vec()
}

/// White paper for little power, black ink for much.
fn grey(share: f64) -> [u8; 3] {
    let lightness = 252.0 - 236.0 * share.clamp(0.0, 1.0);
    [to_byte(lightness.round()); 3]
}

/// Power by wavenumber and place, one panel a direction.
fn spectra(textile: &Textile) -> Row {
    let [min, max] = POWERS_DB;
    let cell = |power_um2: f64| {
        let db = 0.5 * level_db(power_um2.max(1e-30));
        Some(grey((db - min) / (max - min)))
    };
    let panel = |direction: Direction| {
        let spectra = textile.surface().spectra(direction);
        let n_points = spectra.n_points();
        let mut cells = Vec::new();
        for bin in (0..N_BINS_SHOWN).rev() {
            cells.extend((0..n_points).map(|point| cell(spectra.powers_um2(point)[bin])));
        }
        let highest_per_mm = BIN_SPACING_PER_MM * (N_BINS_SHOWN as f64 + 0.5);
        Chart {
            title: direction.label().to_owned(),
            x: Axis::linear("point, mm").within([-0.5, n_points as f64 - 0.5]),
            y: Axis::linear("cycles/mm").within([0.5 * BIN_SPACING_PER_MM, highest_per_mm]),
            upright: if direction == Direction::WarpForward {
                Upright::Upward
            } else {
                Upright::Shared
            },
            raster: Some(Raster {
                n_columns: n_points,
                cells,
            }),
            ..Chart::default()
        }
    };
    Row {
        panels: Direction::ALL.map(panel).to_vec(),
        height_px: 190.0,
        bar: Some(ColourBar {
            axis: Axis::linear("power, dB re 1 µm²").within(POWERS_DB),
            colours: (0..=8).map(|i| grey(f64::from(i) / 8.0)).collect(),
        }),
    }
}

/// The trace of friction, if there is one.
fn friction(textile: &Textile) -> Result<Option<Row>, TextileError> {
    let Some(trace) = textile.friction()? else {
        return Ok(None);
    };
    let points = corners(|i| i as f64 * trace.step_mm(), trace.mu());
    let panel = Chart {
        title: "friction along the warp".to_owned(),
        x: Axis::linear("distance travelled, mm"),
        y: Axis::linear("coefficient"),
        series: vec![line(points, Ink::Black, Weight::Thin)],
        ..Chart::default()
    };
    Ok(Some(row(vec![panel], 90.0)))
}

/// Figures, where it comes from, and how to read the sheet.
fn notes(textile: &Textile) -> Vec<String> {
    let manifest = textile.manifest();
    let figures: Vec<String> = MeasuredFigure::all_of(&manifest.measured)
        .into_iter()
        .map(|figure| {
            let line = format!("{} {} {}", figure.name, figure.value, figure.unit);
            line.trim_end().replace('-', "−")
        })
        .collect();
    let mut notes = Vec::new();
    if !figures.is_empty() {
        notes.push(format!("Measured: {}.", figures.join(" · ")));
    }
    notes.push(manifest.notes.clone());
    notes.push(origin(textile));
    let assumed = manifest.source.assumed();
    notes.extend(assumed.map(|words| format!("Assumed: {words}.")));
    let known = manifest.uncertainty.as_ref().and_then(Uncertainty::words);
    notes.extend(known.map(|words| format!("Known to: {words} (upright lines at 100 mm/s).")));
    notes.extend(textile.fall_backs());
    notes.push(
        "Amplitudes: means over all points, default filters, no gain; thin: each direction. \
         Spectra: one-sided power a bin of 0.23 cycles/mm; below the probe's radius of 0.25 mm \
         what is seen is the instrument."
            .to_owned(),
    );
    notes.retain(|note| !note.is_empty());
    notes
}

/// Where a textile comes from, one line.
fn origin(textile: &Textile) -> String {
    let manifest = textile.manifest();
    let source = match &manifest.source {
        Source::Profiles(keys) => keys.imported.as_ref().map_or_else(
            || "measured profiles".to_owned(),
            |origin| format!("measured; imported from {}", origin.files.join(", ")),
        ),
        other => format!("model of kind \"{}\", not measured on cloth", other.kind()),
    };
    let licence = match manifest.licence.as_str() {
        "" => String::new(),
        licence => format!("; licence {licence}"),
    };
    format!("Source: {source}{licence}.")
}

/// All that is known of where a sheet comes from.
fn about(textile: &Textile) -> Vec<(String, String)> {
    let mut about = vec![
        ("textile".to_owned(), textile.id().to_owned()),
        (
            "program".to_owned(),
            selvedge_foundation::PROGRAM.to_owned(),
        ),
    ];
    if let Source::Profiles(keys) = &textile.manifest().source
        && let Some(origin) = &keys.imported
    {
        let files = origin.files.iter().zip(&origin.sha256);
        about.extend(files.map(|(file, hash)| (format!("sha256 {file}"), hash.clone())));
    }
    about
}
