//! The files of an analysis: `periodicity.json`, the maxima as a table, and pictures.

use std::path::Path;

use serde::Serialize;

use super::analysis::{Analysis, Found, Measurements};
use super::autocorrelation::correlated_part;
use super::basis::{Place, length};
use super::overlay::{overlay, range};
use super::relief::{Relief, object};
use super::scale::PictureScale;
use selvedge_foundation::files::{FileError, GrayImage, TableWriter, to_json_string};

/// Rows of the table of maxima at most.
const MAX_ROWS: usize = 5000;

/// Every name that [`write_files`] may give.
pub const FILE_NAMES: [&str; 8] = [
    "periodicity.json",
    "overlay.png",
    "autocorrelation.png",
    "maxima.csv",
    "tile.png",
    "synthesized.png",
    "residual.png",
    "height.png",
];

/// What the files say beside the result.
#[derive(Debug, Clone, Default)]
pub struct About {
    /// Pixels of the picture to a millimetre, if known.
    pub px_per_mm: Option<f64>,
    /// How that is known.
    pub scale: Option<PictureScale>,
    /// The picture's name.
    pub image: String,
    /// The part that was analysed: x, y, width, height.
    pub region: Option<[usize; 4]>,
    /// The corners that it was rectified from.
    pub corners: Option<[Place; 4]>,
    /// Heights that were found on it, and from the lowest to the highest of them, µm, if known.
    pub relief: Option<(Relief, Option<f64>)>,
    /// Why there are no heights, where they were looked for.
    pub no_relief: Option<String>,
}

/// Writes the files of an analysis by name, each as soon as it is made.
///
/// `periodicity.json`, `overlay.png`, and as far as there is anything to show
/// `autocorrelation.png`, `maxima.csv`, `tile.png`, `synthesized.png` and `residual.png`;
/// `height.png` of a relief. Pictures of luminance are stretched to the picture's own range. Of a
/// large picture only what the next file shows is held.
///
/// # Errors
/// A picture that is too large for its format, or what `write` says.
pub fn write_files<E: From<FileError>>(
    analysis: Analysis,
    about: &About,
    mut write: impl FnMut(&'static str, &[u8]) -> Result<(), E>,
) -> Result<(), E> {
    let name = "periodicity.json";
    let json = to_json_string(&reported(&analysis, about), Path::new(name))?;
    write(name, json.as_bytes())?;
    let Analysis {
        luminance,
        measured,
        found,
        ..
    } = analysis;
    let lattice = found.as_ref().ok().map(|f| f.lattice.basis());
    let (ground, tile) = match found {
        Ok(Found { unwarped, tile, .. }) => {
            (unwarped.map_or(luminance, |u| u.luminance), Some(tile))
        }
        Err(_) => (luminance, None),
    };
    let name = "overlay.png";
    write(name, &overlay(&ground, lattice).to_png(Path::new(name))?)?;
    if let Some(measured) = measured {
        let name = "autocorrelation.png";
        write(name, &measured.rho.picture().to_png(Path::new(name))?)?;
        write("maxima.csv", &maxima_table(&measured)?)?;
    }
    if let Some(tile) = tile {
        let (low, high) = range(&ground);
        let mut write_grey = |name, size, values: &mut dyn Iterator<Item = f64>| -> Result<(), E> {
            let shares = values.map(|x| (x - low) / (high - low));
            write(
                name,
                &GrayImage::of_shares(size, shares).to_png(Path::new(name))?,
            )
        };
        let folded = &tile.values;
        let size = [folded.width(), folded.height()];
        write_grey("tile.png", size, &mut folded.values().iter().copied())?;
        let size = [ground.width(), ground.height()];
        write_grey("synthesized.png", size, &mut tile.samples(size))?;
        let rest = ground.values().iter().zip(tile.samples(size));
        let mut rest = rest.map(|(value, made)| value + 0.5 * (low + high) - made);
        write_grey("residual.png", size, &mut rest)?;
    }
    if let Some((relief, relief_um)) = &about.relief {
        write("height.png", &relief.picture(about.px_per_mm, *relief_um)?)?;
    }
    Ok(())
}

fn maxima_table(measured: &Measurements) -> Result<Vec<u8>, FileError> {
    let mut bytes = Vec::new();
    let header = ["rank", "dx_px", "dy_px", "correlation", "dominance_px"];
    let mut table = TableWriter::new(&mut bytes, Path::new("maxima.csv"), &header)?;
    for (rank, maximum) in (1_u32..).zip(measured.maxima.ranked().iter().take(MAX_ROWS)) {
        table.number(rank);
        for x in [
            maximum.place[0],
            maximum.place[1],
            maximum.height,
            maximum.dominance_px,
        ] {
            table.number(x);
        }
        table.end_row()?;
    }
    table.finish()?;
    Ok(bytes)
}

/// What `periodicity.json` says.
fn reported(analysis: &Analysis, about: &About) -> impl Serialize {
    let (width, height) = (analysis.luminance.width(), analysis.luminance.height());
    let found = analysis.found.as_ref().ok();
    let lattice = found.map(|f| f.lattice);
    let vector = |i: usize| lattice.map(|l| [l.p1_px, l.p2_px][i]);
    let mm = |px: f64| about.px_per_mm.map(|per_mm| px / per_mm);
    let vector_mm = |i: usize| Some([mm(vector(i)?[0])?, mm(vector(i)?[1])?]);
    let lengths = [0, 1].map(|i| vector(i).map(length));
    let measured = analysis.measured.as_ref();
    object! {
        image: object! {
            file: &about.image,
            width: width,
            height: height,
            region: about.region,
            corners_px: about.corners,
            light_was_evened: analysis.was_evened,
            correlated_part: correlated_part(width, height),
        },
        px_per_mm: about.px_per_mm,
        scale: about.scale,
        lattice: lattice,
        thread_grid: lattice.and_then(|l| l.thread_grid).map(|grid| object! {
            p1_px: grid.p1,
            p2_px: grid.p2,
        }),
        weave: lattice.and_then(|l| l.weave_name()),
        reason: analysis.found.as_ref().err().map(ToString::to_string),
        p1_mm: vector_mm(0),
        p2_mm: vector_mm(1),
        p1_length_mm: lengths[0].and_then(mm),
        p2_length_mm: lengths[1].and_then(mm),
        p1_length_px: lengths[0],
        p2_length_px: lengths[1],
        angle_deg: lattice.map(|l| l.basis().angle_rad().to_degrees()),
        n_cells: lattice.map(|l| (width * height) as f64 / l.basis().area()),
        explained_variance: found.map(|f| f.explained_variance),
        bend_px: found.and_then(|f| f.unwarped.as_ref()).map(|u| u.bend_px),
        local_stretch: found.and_then(|f| f.unwarped.as_ref()).map(|u| u.stretch),
        flat_part: found.and_then(|f| f.flat_part).map(|part| part.0),
        explained_variance_of_flat_part: found.and_then(|f| f.flat_part).map(|part| part.1),
        from_maxima_px: found.map(|f| f.from_maxima),
        tile: found.map(|f| [f.tile.values.width(), f.tile.values.height()]),
        tile_p1_px: found.map(|f| f.tile.p1_px),
        tile_p2_px: found.map(|f| f.tile.p2_px),
        colour_spread: found.map(|f| f.colour.colour_spread),
        brightness_spread: found.map(|f| f.colour.brightness_spread),
        colour_carries_the_period: found.map(|f| f.colour.is_printed()),
        n_maxima: measured.map_or(0, |m| m.maxima.all().len() / 2),
        n_significant_maxima: measured.map_or(0, |m| m.significant.all().len()),
        directions: measured.map(readings),
        shading: about.relief.as_ref().map(|(relief, um)| relief.report(*um)),
        no_shading: about.no_relief.as_deref(),
    }
}

/// Directions and lengths by either measure.
fn readings(measured: &Measurements) -> [impl Serialize; 2] {
    let d = &measured.directions;
    let pairs = [
        ("mean concentration", &d.by_concentration),
        ("hough", &d.by_hough),
    ];
    pairs.map(|(measure, by)| {
        object! {
            measure: measure,
            lambda_per_px: d.lambda_per_px,
            directions_deg: by.best.map(|both| both.map(f64::to_degrees)),
            p1_px: by.basis.map(|b| b.p1),
            p2_px: by.basis.map(|b| b.p2),
        }
    })
}
