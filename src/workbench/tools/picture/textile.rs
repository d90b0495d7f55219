//! The textile that becomes of a picture's relief.

use std::sync::Arc;

use crate::bench::keep::NewTextile;
use crate::bench::source_file::SourceFile;
use crate::kit::widgets::relief3d::Relief3d;
use crate::tools::picture::draft::Draft;
use crate::tools::picture::found::{Loaded, Made};
use crate::tools::picture::images;
use selvedge_foundation::numerics::{Grid, extent};
use selvedge_foundation::progress::Progress;
use selvedge_textile::picture::{Found as Tiled, Relief, ReliefOf, Turned, TurnedPicture};
use selvedge_textile::surface::Direction;
use selvedge_textile::{
    Construction, Ensemble, Lamp, PictureTextile, TextileError, Uncertainty, n_threads, smd_um,
};

/// The picture, its shares of red and green, and further ones.
pub(super) type Photographed<'a> = (
    &'a Loaded,
    Option<&'a Grid<[u16; 2]>>,
    (Vec<Turned>, Vec<TurnedPicture>),
);

/// Makes it, with how far its levels may be off.
///
/// # Errors
/// It cannot be felt, or the work was cancelled.
pub(super) fn made(
    inputs: &Draft,
    (loaded, shares, (turned, kept)): Photographed<'_>,
    (tiled, mut relief, px_per_mm): (Option<&Tiled>, Relief, f64),
    progress: &mut Progress<'_>,
) -> Result<Made, TextileError> {
    let file = inputs.source.as_ref().map(SourceFile::name);
    let mut about = PictureTextile {
        name: inputs.final_name(),
        construction: Construction::Other,
        px_per_mm,
        px_scale: inputs.picture_scale(),
        scale: inputs.height_scale().unwrap_or_default(),
        picture: file.map(|name| [name, loaded.sha256.clone()]),
        turned: kept,
        colours: Some(
            relief
                .brightness
                .colours((shares, &turned), (inputs.relief_of, tiled)),
        ),
        size_px: Some(relief.brightness.size_px),
        extent_mm: (inputs.relief_of == ReliefOf::Synthesized).then_some(PictureTextile::EXTENT_MM),
        light_is_estimated: relief.estimate.is_some(),
        representation: inputs.representation,
        ..PictureTextile::default()
    };
    let own = (&mut relief, inputs.method.is_some());
    let believed = Ensemble::believe(own, &mut about, lamp(inputs), n_threads(), progress);
    let advice = believed?;
    let (shape, brightness) = (&relief.shape, &relief.brightness);
    let tile = tiled.map(|tiled| &tiled.tile);
    let made = PictureTextile::files_of(shape, brightness, tile, &about)?;
    let strokes = Direction::ALL
        .into_iter()
        .zip(made.profiles.iter().flatten());
    let profiles = strokes.map(|(direction, profile)| {
        let heights_um = profile.heights_um().to_vec();
        (direction, heights_um, profile.step_mm())
    });
    let [low_um, high_um] = extent(made.map.heights_um().values().iter().copied());
    let uncertainty = Uncertainty {
        levels: about.levels,
        ..Uncertainty::default()
    };
    Ok(Made {
        compared: images::compared(&relief, &made.map),
        relief: Relief3d::of(&made.map),
        relief_um: high_um - low_um,
        smd_um: smd_um(&made.profiles),
        known: [uncertainty.words(), advice],
        profiles: profiles.collect(),
        textile: Arc::new(vec![NewTextile {
            id: inputs.id(),
            name: about.name,
            files: made.files,
        }]),
    })
}

/// The lamp, as far as it is known where it stands.
fn lamp(inputs: &Draft) -> Lamp {
    if inputs.is_light_estimated {
        Lamp::Unknown
    } else {
        Lamp::Known {
            light: inputs.light_on_part(),
            within_deg: Lamp::WITHIN_DEG,
        }
    }
}
