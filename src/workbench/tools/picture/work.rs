//! The stages from a picture to a textile, on a thread. What was made before of the same words is
//! used again, so that whoever changes a parameter waits for the later stages only.

use std::path::Path;
use std::sync::Arc;

use crate::bench::keep::NewTextile;
use crate::bench::latest::Computed;
use crate::bench::source_file::SourceFile;
use crate::kit::widgets::relief3d::Relief3d;
use crate::tools::picture::draft::{Draft, Part};
use crate::tools::picture::found::{Cloth, Correlated, Found, Loaded, Made, Step};
use crate::tools::picture::images;
use selvedge_foundation::files::sha256_hex;
use selvedge_foundation::numerics::Grid;
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_textile::picture::brightness::Brightness;
use selvedge_textile::picture::shading::{ShadingError, ShadingOptions, Shape};
use selvedge_textile::picture::{
    Autocorrelation, DirectionOptions, Directions, EvenLight, Found as Tiled, Lattice, Maxima,
    Picture, PictureError, Relief, SignificantMaxima, even_light,
};
use selvedge_textile::surface::{Direction, HeightMap, ProfileSet};
use selvedge_textile::{
    Construction, Ensemble, Lamp, Manifest, PictureTextile, Source, TextileError, Uncertainty,
    n_threads, smd_um,
};

/// Why a run ended early.
enum End {
    Cancelled(Cancelled),
    Failed(Step, String),
}

impl From<Cancelled> for End {
    fn from(cancelled: Cancelled) -> Self {
        Self::Cancelled(cancelled)
    }
}

impl Computed<Draft> for Found {
    const THREAD: &str = "selvedge-picture";

    fn compute(
        inputs: &Draft,
        prior: Option<(&Draft, &Self)>,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        read(inputs.clone(), prior.map(|(_, found)| found), progress)
    }

    fn broken(inputs: &Draft, why: &str) -> Self {
        let line = format!("nothing was worked out: {why}");
        Self::failed(inputs.clone(), Step::Picture, line)
    }

    /// What was made so far of a file is kept only when the run ends.
    fn serves(under_way: &Draft, now: &Draft) -> bool {
        under_way.source == now.source
    }
}

/// Runs the stages that are not known from `prior`.
pub(crate) fn read(
    inputs: Draft,
    prior: Option<&Found>,
    progress: &mut Progress<'_>,
) -> Result<Found, Cancelled> {
    let mut found = Found::begun(inputs);
    match stages(&mut found, prior, progress) {
        Ok(()) => {}
        Err(End::Cancelled(cancelled)) => return Err(cancelled),
        Err(End::Failed(step, line)) => found.failure = Some((step, line)),
    }
    Ok(found)
}

/// A stage of before, if it was made of the same words.
fn known<T>(
    prior: Option<&Found>,
    is_same: impl Fn(&Draft) -> bool,
    stage: impl Fn(&Found) -> &Option<Arc<T>>,
) -> Option<Arc<T>> {
    let prior = prior.filter(|prior| is_same(&prior.inputs))?;
    stage(prior).clone()
}

fn stages(
    found: &mut Found,
    prior: Option<&Found>,
    progress: &mut Progress<'_>,
) -> Result<(), End> {
    let inputs = found.inputs.clone();
    progress.step(0.0, "reading the picture")?;
    let loaded = match known(prior, |of| of.has_same_file(&inputs), |found| &found.loaded) {
        Some(loaded) => loaded,
        None => Arc::new(loaded(&inputs)?),
    };
    found.loaded = Some(Arc::clone(&loaded));
    progress.step(0.1, "correlating")?;
    let correlated = match known(prior, |of| of.has_same_part(&inputs), |f| &f.correlated) {
        Some(correlated) => correlated,
        None => Arc::new(correlated(&inputs, &loaded)?),
    };
    found.correlated = Some(Arc::clone(&correlated));
    progress.step(0.5, "fitting the lattice")?;
    let cloth = match known(prior, |of| of.has_same_tile(&inputs), |found| &found.cloth) {
        Some(cloth) => cloth,
        None => Arc::new(cloth(&inputs, &correlated, progress)?),
    };
    found.cloth = Some(Arc::clone(&cloth));
    let Ok(tiled) = &cloth.found else {
        return Ok(());
    };
    progress.step(0.7, "shape from shading")?;
    let shaped = match known(
        prior,
        |of| of.has_same_shape(&inputs),
        |found| &found.shaped,
    ) {
        Some(shaped) => shaped,
        None => Arc::new(shaped(&inputs, (&correlated.luminance, tiled), progress)?),
    };
    found.shaped = Some(Arc::clone(&shaped));
    progress.step(0.9, "drawing the tester over it")?;
    if inputs.missing().is_none() {
        let known = known(prior, |of| of.has_same_textile(&inputs), |f| &f.made);
        found.made = Some(if let Some(made) = known {
            made
        } else {
            let relief = Relief::clone(&shaped);
            let make = |p: &mut Progress<'_>| made(&inputs, &loaded, (tiled, relief), p);
            Arc::new(progress.within([0.9, 1.0], make)?)
        });
    }
    progress.step(1.0, "done")?;
    Ok(())
}

fn loaded(inputs: &Draft) -> Result<Loaded, End> {
    let failed = |line: String| End::Failed(Step::Picture, line);
    let file = inputs.source.as_ref();
    let file = file.ok_or_else(|| failed("no picture was chosen".to_owned()))?;
    let bytes = file.bytes().map_err(|line| failed(line.to_owned()))?;
    let picture =
        Picture::load(bytes, file.file_name()).map_err(|error| failed(error.to_string()))?;
    Ok(Loaded {
        sha256: sha256_hex([bytes]),
        image: images::thumbnail(&picture.luminance),
        size: [picture.luminance.width(), picture.luminance.height()],
        picture,
    })
}

fn correlated(inputs: &Draft, loaded: &Loaded) -> Result<Correlated, End> {
    let part = match inputs.part {
        Part::Whole => Ok(loaded.picture.clone()),
        Part::Region(region) => loaded.picture.part(region),
        Part::Corners(corners) => loaded.picture.rectified(corners),
    };
    let picture = part.map_err(|error| End::Failed(Step::Picture, error.to_string()))?;
    let how = if inputs.is_evened {
        EvenLight::Auto
    } else {
        EvenLight::Off
    };
    let (luminance, was_evened) = even_light(&picture.luminance, how);
    let n = luminance.values().len().max(1) as f64;
    let mean = luminance.values().iter().sum::<f64>() / n;
    let variance = luminance
        .values()
        .iter()
        .map(|x| (x - mean).powi(2))
        .sum::<f64>()
        / n;
    let looked = Lattice::worth_looking(luminance.width(), luminance.height(), variance);
    let read = looked.map_err(|reason| reason.to_string()).map(|()| {
        let rho = Autocorrelation::of(&luminance, n_threads());
        let maxima = Maxima::of(&rho);
        let significant = SignificantMaxima::of(&maxima, &rho);
        (rho, maxima, significant)
    });
    Ok(Correlated {
        picture,
        luminance,
        was_evened,
        read,
    })
}

fn cloth(
    inputs: &Draft,
    correlated: &Correlated,
    progress: &mut Progress<'_>,
) -> Result<Cloth, Cancelled> {
    let (rho, maxima, significant) = match &correlated.read {
        Ok(read) => read,
        Err(reason) => {
            return Ok(Cloth {
                correlation: None,
                maxima: Vec::new(),
                directions: None,
                found: Err(reason.clone()),
                images: None,
            });
        }
    };
    let options = DirectionOptions {
        lambda_per_px: inputs.lambda,
    };
    let directions = Directions::of(significant, options);
    let lattice = Lattice::find(rho, maxima, significant, &directions);
    let luminance = &correlated.luminance;
    let found = match lattice {
        Ok(lattice) => {
            let picture = &correlated.picture;
            let tiled = Tiled::of(luminance, picture, lattice, n_threads(), progress)?;
            Ok(Box::new(tiled))
        }
        Err(reason) => Err(reason.to_string()),
    };
    let images = found.as_deref().ok().map(|tiled| {
        let corner = tiled.flat_part.map_or([0, 0], |([x, y, ..], _)| [x, y]);
        let part = images::part(tiled.laid(luminance), &tiled.lattice, corner);
        let [again, rest] = images::synthesized(&part, &tiled.tile, n_threads());
        [images::with_lattice(&part, &tiled.lattice), again, rest]
    });
    let lattice = found.as_deref().ok().map(|tiled| &tiled.lattice);
    let mut ranked: Vec<_> = significant.all().to_vec();
    ranked.sort_by(|a, b| b.dominance_px.total_cmp(&a.dominance_px));
    Ok(Cloth {
        correlation: Some(images::correlation(rho, lattice)),
        maxima: ranked.iter().map(|m| (m.place, m.height)).collect(),
        directions: Some(directions),
        images,
        found,
    })
}

fn shaped(
    inputs: &Draft,
    (luminance, tiled): (&Grid<f64>, &Tiled),
    progress: &mut Progress<'_>,
) -> Result<Relief, End> {
    let failed = |error: ShadingError| match error {
        ShadingError::Cancelled(cancelled) => End::Cancelled(cancelled),
        error => End::Failed(Step::Light, error.to_string()),
    };
    let whole = (!inputs.is_cell).then_some(luminance);
    let px_per_mm = px_per_mm(inputs, tiled)?;
    let brightness = tiled.brightness(whole, px_per_mm, n_threads());
    let light = (!inputs.is_light_estimated).then_some(inputs.light);
    let options = ShadingOptions {
        method: inputs.method.unwrap_or_default(),
        ..ShadingOptions::default()
    };
    Relief::of(brightness, light, &options, progress).map_err(failed)
}

fn made(
    inputs: &Draft,
    loaded: &Loaded,
    (tiled, mut relief): (&Tiled, Relief),
    progress: &mut Progress<'_>,
) -> Result<Made, End> {
    let failed = |error: TextileError| match error {
        TextileError::Cancelled(cancelled) => End::Cancelled(cancelled),
        error => End::Failed(Step::Felt, error.to_string()),
    };
    let file = inputs.source.as_ref().map(SourceFile::name);
    let px_per_mm = px_per_mm(inputs, tiled)?.unwrap_or_default();
    let mut about = PictureTextile {
        name: inputs.final_name(),
        construction: Construction::Other,
        px_per_mm,
        px_scale: inputs.picture_scale(),
        scale: inputs.height_scale().unwrap_or_default(),
        picture: file.map(|name| [name, loaded.sha256.clone()]),
        size_px: Some(relief.brightness.size_px),
        light_is_estimated: relief.estimate.is_some(),
        representation: inputs.representation,
        ..PictureTextile::default()
    };
    let own = (&mut relief, inputs.method.is_some());
    let advice = Ensemble::believe(own, &mut about, lamp(inputs), n_threads(), progress);
    let advice = advice.map_err(failed)?;
    let (shape, brightness) = (&relief.shape, &relief.brightness);
    let files = PictureTextile::files_of(shape, brightness, &tiled.tile, &about).map_err(failed)?;
    let text = |name: &str| {
        let file = files.iter().find(|file| file.name == name)?;
        String::from_utf8(file.bytes.clone()).ok()
    };
    let manifest = text("textile.toml").unwrap_or_default();
    let manifest = Manifest::from_toml(&manifest, Path::new("textile.toml")).map_err(failed)?;
    let relief_um = match &manifest.source {
        Source::Picture(keys) => keys.relief_um,
        _ => 0.0,
    };
    let (mut profiles, mut strokes) = (Vec::new(), ProfileSet::default());
    for direction in Direction::ALL {
        let name = format!("{}.csv", direction.key());
        if let Some(text) = text(&name) {
            let profile = selvedge_textile::surface::Profile::read(&text, Path::new(&name))
                .map_err(failed)?;
            profiles.push((direction, profile.heights_um().to_vec(), profile.step_mm()));
            strokes[direction.index()] = Some(profile);
        }
    }
    let map = map_of(shape, brightness, (relief_um, px_per_mm));
    let map = map.map_err(|error| End::Failed(Step::Felt, error.to_string()))?;
    Ok(Made {
        relief: Relief3d::of(&map),
        relief_um,
        smd_um: smd_um(&strokes),
        known: [
            manifest.uncertainty.as_ref().and_then(Uncertainty::words),
            advice,
        ],
        profiles,
        textile: Arc::new(vec![NewTextile {
            id: inputs.id(),
            name: about.name,
            files,
        }]),
    })
}

/// Pixels to a millimetre, if anything is known of it.
fn px_per_mm(inputs: &Draft, tiled: &Tiled) -> Result<Option<f64>, End> {
    let scale = inputs.picture_scale().map(|s| s.px_per_mm(&tiled.lattice));
    let failed = |error: PictureError| End::Failed(Step::Picture, error.to_string());
    scale.transpose().map_err(failed)
}

/// The lamp, as far as it is known where it stands.
fn lamp(inputs: &Draft) -> Lamp {
    if inputs.is_light_estimated {
        Lamp::Unknown
    } else {
        Lamp::Known {
            light: inputs.light,
            within_deg: Lamp::WITHIN_DEG,
        }
    }
}

/// The heights as the textile has them.
fn map_of(
    shape: &Shape,
    brightness: &Brightness,
    (relief_um, px_per_mm): (f64, f64),
) -> Result<HeightMap, selvedge_textile::surface::SurfaceError> {
    let [low, high] = shape.range_px();
    let mut heights_um = shape.height_px.clone();
    for height in heights_um.values_mut() {
        *height *= relief_um / (high - low);
    }
    let n = [heights_um.width() as f64, heights_um.height() as f64];
    let step_mm = [0, 1].map(|axis| brightness.size_px[axis] / n[axis] / px_per_mm);
    HeightMap::new(heights_um, step_mm)
}
