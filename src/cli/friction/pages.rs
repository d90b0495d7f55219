//! What the shipped networks make of cloths that were held back, as pictures: spectra and traces
//! beside what was felt, and where cloths lie in the first network.

use std::path::Path;

use crate::CliError;
use crate::output::{write_bytes, write_text};
use selvedge_chart::{Axis, Chart, Figure, FigureError, Ink, Raster, Row, Series, Style, Weight};
use selvedge_foundation::files::encode_png_rgba;
use selvedge_foundation::numerics::{Grid, extent, to_byte};
use selvedge_foundation::quantity::fixed;
use selvedge_friction::{Measure, PredictedFriction, Predictor, Split, Taken};

/// Width of a picture, px.
const WIDTH_PX: u32 = 1720;
/// Cloths of a family that are drawn.
const N_CLOTHS: usize = 10;
/// Bins of a spectrogram that are drawn: up to 3.2 cycles/mm, where cloth ends.
const N_BINS: usize = 128;

/// A cloth that was held back, and what is predicted of it.
struct Shown<'a> {
    family: &'a str,
    felt: &'a [f64],
    found: PredictedFriction,
}

/// Draws `traces.svg`, `traces.png`, `latents.svg` and `latents.png` into a folder.
pub(super) fn draw(out: &Path, split: Split, n_threads: usize) -> Result<(), CliError> {
    let predictor = Predictor::shipped()?;
    // A quarter as many are held back as are learnt from, but of known cloths at other places.
    let share = if split == Split::Places { 1 } else { 4 };
    let taken = Taken::held_back(split, share * N_CLOTHS, n_threads);
    let mut shown = Vec::new();
    for (family, strip, felt) in taken.pictures() {
        let found = predictor.of_picture(strip, PredictedFriction::PER_MM)?;
        shown.push(Shown {
            family,
            felt,
            found,
        });
    }
    write(out, "traces", &traces(&shown, split))?;
    let strips: Vec<_> = taken.pictures().map(|(_, strip, _)| strip).collect();
    let plane = predictor.plane(&strips)?;
    write(out, "latents", &latents(&shown, plane))
}

fn write(out: &Path, name: &str, figure: &Figure) -> Result<(), CliError> {
    let failed = |error: FigureError| CliError::Failed(error.to_string());
    let svg = figure.to_svg().map_err(failed)?;
    write_text(Some(&out.join(format!("{name}.svg"))), &svg)?;
    let pixels = figure.to_pixels(WIDTH_PX).map_err(failed)?;
    let path = out.join(format!("{name}.png"));
    let png = encode_png_rgba(&pixels.rgba, pixels.width, pixels.height, &path)?;
    write_bytes(&path, &png)
}

/// Of every family the cloth whose spectrum is missed as much as its family's usually is.
fn traces(shown: &[Shown<'_>], split: Split) -> Figure {
    let missed = |one: &Shown<'_>| Measure::LogSpectral.of(&one.found.scores(one.felt));
    let rows = families(shown).into_iter().filter_map(|family| {
        let mut of_family: Vec<_> = shown.iter().filter(|one| one.family == family).collect();
        of_family.sort_by(|a, b| missed(a).total_cmp(&missed(b)));
        of_family.get(of_family.len() / 2).map(|one| Row {
            panels: panels(one, missed(one)),
            height_px: 90.0,
            bar: None,
        })
    });
    Figure {
        title: "Friction that was felt and friction from the picture".to_owned(),
        rows: rows.collect(),
        notes: vec![format!(
            "Split {}, {}; of every family the cloth with the middle distance of spectra. The \
             networks that are shipped, together; phases are not told by a picture.",
            split.letter(),
            split.describe()
        )],
        about: Vec::new(),
    }
}

/// Families in the order that they come in.
fn families<'a>(shown: &[Shown<'a>]) -> Vec<&'a str> {
    let mut families: Vec<_> = shown.iter().map(|one| one.family).collect();
    families.dedup();
    families
}

/// Two spectrograms in the same shades, and both traces.
fn panels(one: &Shown<'_>, missed_db: f64) -> Vec<Chart> {
    let truth = PredictedFriction::log_magnitudes_of(one.felt);
    let both = [&truth, one.found.log_magnitudes()];
    let ends = extent(
        both.iter()
            .flat_map(|grid| grid.values())
            .map(|&log| f64::from(log)),
    );
    let length_mm = one.felt.len() as f64 / PredictedFriction::PER_MM;
    let titles = [
        format!("{}: felt", one.family),
        format!("from the picture, {} dB off", fixed(missed_db, 1)),
    ];
    let mut panels: Vec<Chart> = both
        .into_iter()
        .zip(titles)
        .map(|(log, title)| Chart {
            title,
            x: Axis::linear("place, mm").within([0.0, length_mm]),
            y: Axis::linear("cycles/mm").within([0.0, N_BINS as f64 / 40.0]),
            raster: Some(raster(log, ends)),
            width: 0.3,
            ..Chart::default()
        })
        .collect();
    let line = |name: &str, ink, trace: &[f64]| Series {
        ink,
        weight: Weight::Thin,
        ..Series::of(name, Style::Line, along(trace))
    };
    panels.push(Chart {
        x: Axis::linear("place, mm").within([0.0, length_mm]),
        y: Axis::linear("friction"),
        series: vec![
            line("felt", Ink::Grey, one.felt),
            line("from the picture", Ink::Violet, &one.found.mu),
        ],
        width: 0.4,
        ..Chart::default()
    });
    panels
}

fn along(trace: &[f64]) -> impl Iterator<Item = [f64; 2]> {
    let at_mm = |(at, mu): (usize, &f64)| [at as f64 / PredictedFriction::PER_MM, *mu];
    trace.iter().enumerate().map(at_mm)
}

/// Log magnitudes from white to black, a column a frame.
fn raster(log: &Grid<f32>, ends: [f64; 2]) -> Raster {
    let shades = PredictedFriction::shades(log, N_BINS, ends);
    let cell = |shade: &f64| Some([to_byte(255.0 * (1.0 - shade)); 3]);
    Raster {
        n_columns: shades.width(),
        cells: shades.values().iter().map(cell).collect(),
    }
}

/// Where cloths lie: the plane in which they differ most.
fn latents(shown: &[Shown<'_>], (places, shares): (Vec<[f64; 2]>, [f64; 2])) -> Figure {
    let of = |family: &str| {
        let places = shown.iter().zip(&places);
        let of_family = places.filter(|(one, _)| one.family == family);
        Series::of(family, Style::Dots, of_family.map(|(_, place)| *place))
    };
    let axis = |nth: usize| {
        let share = fixed(100.0 * shares[nth], 0);
        Axis::linear(format!("component {}, {share} % of the variance", nth + 1))
    };
    Figure {
        title: "Cloths as the first network has them, from where they differ most".to_owned(),
        rows: vec![Row {
            panels: vec![Chart {
                x: axis(0),
                y: axis(1),
                series: families(shown).into_iter().map(of).collect(),
                ..Chart::default()
            }],
            height_px: 480.0,
            bar: None,
        }],
        notes: vec!["The first two principal components of 64 numbers of a cloth.".to_owned()],
        about: Vec::new(),
    }
}
