//! The stages from a picture to a textile, on a thread. What was made before of the same words is
//! used again, so that whoever changes a parameter waits for the later stages only.

use std::sync::Arc;

use crate::bench::latest::Computed;
use crate::tools::picture::draft::{Draft, Part};
use crate::tools::picture::found::{Cloth, Correlated, Found, Loaded, Step};
use crate::tools::picture::images;
use crate::tools::picture::region::turned_corners;
use crate::tools::picture::textile::made;
use crate::tools::picture::turned::{even, laid, turned};
use selvedge_foundation::files::sha256_hex;
use selvedge_foundation::numerics::Grid;
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_textile::picture::brightness::Brightness;
use selvedge_textile::picture::shading::{ShadingError, ShadingOptions};
use selvedge_textile::picture::{
    Autocorrelation, Basis, DirectionOptions, Directions, Found as Tiled, Lattice, Maxima, Picture,
    PictureError, Relief, ReliefOf, SignificantMaxima, Turned, even_light,
};
use selvedge_textile::{TextileError, n_threads};

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

    fn is_whole(&self) -> bool {
        !self.is_partial
    }

    /// What was made so far of a file is kept only when the run ends.
    fn serves(under_way: &Draft, now: &Draft) -> bool {
        under_way.source == now.source
    }
}

/// Runs the stages that are not known from `prior`, as far as there is something to show.
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

/// Whether a stage was made anew, so that it is shown before the work goes on.
fn is_new<T>(before: Option<&Arc<T>>, now: &Arc<T>) -> bool {
    before.is_none_or(|before| !Arc::ptr_eq(before, now))
}

/// The photograph is shown before it is correlated, its lattice before bent cloth is laid straight,
/// and then before heights are found.
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
    if is_new(prior.and_then(|prior| prior.loaded.as_ref()), &loaded) {
        found.is_partial = true;
        return Ok(());
    }
    progress.step(0.1, "correlating")?;
    let correlated = match known(prior, |of| of.has_same_part(&inputs), |f| &f.correlated) {
        Some(correlated) => correlated,
        None => Arc::new(correlated(&inputs, &loaded)?),
    };
    found.correlated = Some(Arc::clone(&correlated));
    progress.step(0.5, "fitting the lattice")?;
    let cloth = match known(prior, |of| of.has_same_tile(&inputs), |found| &found.cloth) {
        Some(cloth) if cloth.is_first => Arc::new(completed(&cloth, &correlated, progress)?),
        Some(cloth) => cloth,
        None => {
            let mut cloth = cloth(&inputs, &correlated, progress)?;
            let is_same = |of: &Draft| of.has_same_part(&inputs) && of.lambda == inputs.lambda;
            if let Some(before) = known(prior, is_same, |found| &found.cloth) {
                before.offered.clone_into(&mut cloth.offered);
            }
            Arc::new(cloth)
        }
    };
    found.cloth = Some(Arc::clone(&cloth));
    if is_new(prior.and_then(|prior| prior.cloth.as_ref()), &cloth) {
        found.is_partial = true;
        return Ok(());
    }
    progress.step(0.6, "laying pictures over each other")?;
    let turned = match known(
        prior,
        |of| of.has_same_turned(&inputs),
        |found| &found.turned,
    ) {
        Some(turned) => turned,
        None => Arc::new(turned(&inputs, &correlated, progress)?),
    };
    found.turned = Some(turned);
    let of = (&*loaded, &*correlated, &*cloth);
    felt(found, of, prior, progress)
}

/// The stages from the lattice on.
fn felt(
    found: &mut Found,
    (loaded, correlated, cloth): (&Loaded, &Correlated, &Cloth),
    prior: Option<&Found>,
    progress: &mut Progress<'_>,
) -> Result<(), End> {
    let inputs = found.inputs.clone();
    let tiled = cloth.found.as_deref().ok();
    let px_per_mm = px_per_mm(&inputs, tiled)?;
    progress.step(0.7, "shape from shading")?;
    let is_same_shape = |of: &Draft| of.has_same_shape(&inputs);
    let shaped = if let Some(shaped) = known(prior, is_same_shape, |found| &found.shaped) {
        shaped
    } else {
        let ground = (&correlated.luminance, tiled, px_per_mm);
        Arc::new(shaped(&inputs, ground, &laid(found).0, progress)?)
    };
    found.shaped = Some(Arc::clone(&shaped));
    progress.step(0.9, "drawing the tester over it")?;
    if inputs.missing().is_none() {
        let known = known(prior, |of| of.has_same_textile(&inputs), |f| &f.made);
        found.made = Some(if let Some(made) = known {
            made
        } else {
            let of = (tiled, Relief::clone(&shaped), px_per_mm.unwrap_or_default());
            let seen = (loaded, correlated.picture.colour.as_ref(), laid(found));
            let make = |p: &mut Progress<'_>| made(&inputs, seen, of, p);
            let made = progress.within([0.9, 1.0], make);
            Arc::new(made.map_err(|error| match error {
                TextileError::Cancelled(cancelled) => End::Cancelled(cancelled),
                error => End::Failed(Step::Felt, error.to_string()),
            })?)
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
        Part::Region(region) if inputs.turn_deg.abs() < 0.01 => loaded.picture.part(region),
        Part::Region(region) => {
            let corners = turned_corners(region, inputs.turn_deg, loaded.size);
            loaded.picture.rectified(corners)
        }
        Part::Corners(corners) => loaded.picture.rectified(corners),
    };
    let picture = part.map_err(|error| End::Failed(Step::Picture, error.to_string()))?;
    let (luminance, was_evened) = even_light(picture.luminance.clone(), even(inputs));
    let looked = Lattice::worth_looking(&luminance);
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
                found_by_itself: None,
                offered: Vec::new(),
                found: Err(reason.clone()),
                images: None,
                shown_px: 1.0,
                is_first: false,
            });
        }
    };
    let options = DirectionOptions {
        lambda_per_px: inputs.lambda,
    };
    let directions = Directions::of(significant, options);
    let read = (rho, maxima, significant);
    let by_itself = Lattice::find(rho, maxima, significant, &directions);
    let given = inputs
        .lattice
        .map(|[p1, p2]| Lattice::given(read, Basis::new(p1, p2)));
    let found_by_itself = by_itself.as_ref().ok().copied();
    let lattice = given.map_or(by_itself, Ok);
    let luminance = &correlated.luminance;
    let found = match lattice {
        Ok(lattice) => {
            let colour = correlated.picture.colour.as_ref();
            let tiled = Tiled::averaged(luminance, colour, lattice, n_threads(), progress)?;
            Ok(Box::new(tiled))
        }
        Err(reason) => Err(reason.to_string()),
    };
    let lattice = found.as_deref().ok().map(|tiled| &tiled.lattice);
    let mut ranked: Vec<_> = significant.all().to_vec();
    ranked.sort_by(|a, b| b.dominance_px.total_cmp(&a.dominance_px));
    let cloth = Cloth {
        correlation: Some(images::correlation(rho, lattice)),
        maxima: ranked.iter().map(|m| (m.place, m.height)).collect(),
        directions: Some(directions),
        found_by_itself,
        offered: Vec::new(),
        images: None,
        shown_px: 1.0,
        is_first: true,
        found,
    };
    Ok(pictured(cloth, luminance))
}

/// A cloth with its pictures: of a piece of it.
fn pictured(mut cloth: Cloth, luminance: &Grid<f64>) -> Cloth {
    if let Ok(tiled) = &cloth.found {
        let corner = tiled.flat_part.map_or([0, 0], |([x, y, ..], _)| [x, y]);
        let part = images::part(tiled.laid(luminance), &tiled.lattice, corner);
        let [again, rest] = images::synthesized(&part, &tiled.tile, n_threads());
        cloth.shown_px = part.width() as f64;
        cloth.images = Some([images::with_lattice(&part, &tiled.lattice), again, rest]);
    }
    cloth
}

/// A cloth with the lattices beside its own, laid straight where it is bent.
fn completed(
    cloth: &Cloth,
    correlated: &Correlated,
    progress: &mut Progress<'_>,
) -> Result<Cloth, Cancelled> {
    let mut cloth = Cloth {
        is_first: false,
        ..cloth.clone()
    };
    let luminance = &correlated.luminance;
    if let (Ok((rho, maxima, significant)), Some(directions)) =
        (&correlated.read, &cloth.directions)
        && cloth.offered.is_empty()
    {
        let itself = cloth.found_by_itself;
        let others = Lattice::others((rho, maxima, significant), directions, itself.as_ref());
        let all = itself.into_iter().chain(others);
        let folded = all.map(|lattice| (lattice, images::folded(luminance, &lattice)));
        cloth.offered = folded.collect();
    }
    let Some(tiled) = cloth.found.as_mut().ok().filter(|tiled| !tiled.lies_flat()) else {
        return Ok(cloth);
    };
    tiled.lay(luminance, n_threads(), progress)?;
    if let Ok((rho, ..)) = &correlated.read {
        cloth.correlation = Some(images::correlation(rho, Some(&tiled.lattice)));
    }
    Ok(pictured(cloth, luminance))
}

fn shaped(
    inputs: &Draft,
    (luminance, tiled, px_per_mm): (&Grid<f64>, Option<&Tiled>, Option<f64>),
    turned: &[Turned],
    progress: &mut Progress<'_>,
) -> Result<Relief, End> {
    let failed = |error: ShadingError| match error {
        ShadingError::Cancelled(cancelled) => End::Cancelled(cancelled),
        error => End::Failed(Step::Light, error.to_string()),
    };
    let ground = (inputs.relief_of, luminance);
    let brightness = match (turned, inputs.relief_of) {
        ([], _) => Brightness::ground(ground, tiled, px_per_mm, n_threads()),
        (_, ReliefOf::Cell) => {
            let line = "further pictures do not go with the mean cell; choose “as scanned”";
            return Err(End::Failed(Step::Light, line.to_owned()));
        }
        _ => {
            let failed = |error: PictureError| End::Failed(Step::Light, error.to_string());
            Some(Brightness::of_turned(luminance, turned, tiled).map_err(failed)?)
        }
    };
    let no_cell = "there is no lattice and so no mean cell; choose “as scanned”";
    let brightness = brightness.ok_or_else(|| End::Failed(Step::Light, no_cell.to_owned()))?;
    let light = (!inputs.is_light_estimated).then(|| inputs.light_on_part());
    let options = ShadingOptions {
        method: inputs.method.unwrap_or_default(),
        ..ShadingOptions::default()
    };
    Relief::of(brightness, light, &options, progress).map_err(failed)
}

/// Pixels to a millimetre, if anything is known of it.
fn px_per_mm(inputs: &Draft, tiled: Option<&Tiled>) -> Result<Option<f64>, End> {
    let lattice = tiled.map(|tiled| &tiled.lattice);
    let scale = inputs.picture_scale().map(|s| s.px_per_mm(lattice));
    let failed = |error: PictureError| End::Failed(Step::Picture, error.to_string());
    scale.transpose().map_err(failed)
}
