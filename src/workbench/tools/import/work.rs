//! Reading what was chosen, on a thread: files, strokes or a map, figures of what is looked at.
//!
//! What was read before for the same words is used again: only sections and places are worked out
//! anew while they are dragged.

use std::sync::Arc;

use crate::bench::latest::Computed;
use crate::kit::widgets::relief::Relief;
use crate::tools::import::draft::{DraftFile, EvaluationDraft, ReaderDraft};
use crate::tools::import::envelope::Envelope;
use crate::tools::import::failure::{Failure, Step};
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_foundation::quantity::with_unit;
use selvedge_textile::{
    HeightImport, HeightPlace, KesFile, KesImport, KesLook, KesOptions, KesReading, Measurement,
    TextileError,
};

/// Everything that a reading depends on.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Inputs {
    /// What the readers are told.
    pub described: ReaderDraft,
    /// What is looked at.
    pub looked: EvaluationDraft,
}

/// What was read.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    /// Of what.
    pub(crate) inputs: Inputs,
    /// What kind the files are.
    pub kind: Measurement,
    /// What is in them.
    pub body: Body,
    /// What is wrong, at the first step where something is.
    pub failure: Option<Failure>,
}

/// What is in the files.
#[derive(Debug, Clone)]
pub(crate) enum Body {
    /// Nothing that could be read.
    Nothing,
    /// Strokes of the tester.
    Strokes(Box<Strokes>),
    /// Heights.
    Heights(Box<Heights>),
}

/// Strokes of the tester.
#[derive(Debug, Clone)]
pub(crate) struct Strokes {
    /// Every file's first lines, or why they cannot be shown.
    pub looks: Vec<Result<KesLook, String>>,
    /// The strokes, once nothing is left to be asked.
    pub reading: Option<Arc<KesReading>>,
    /// The strokes as they are drawn, in their order.
    pub(crate) envelopes: Arc<Vec<Envelope>>,
    /// The friction as it is drawn.
    pub friction: Option<Arc<Envelope>>,
    /// Sections and figures.
    pub import: Option<KesImport>,
}

/// Heights.
#[derive(Debug, Clone)]
pub(crate) struct Heights {
    /// The heights, once nothing is left to be asked.
    pub import: Arc<HeightImport>,
    /// The same as they are drawn; a profile has none.
    pub relief: Option<Arc<Relief>>,
    /// A profile as it is drawn.
    pub profile: Option<Arc<Envelope>>,
    /// Every place with its strokes, or why there are none.
    pub places: Vec<Result<Arc<HeightPlace>, String>>,
}

impl Found {
    fn failed(inputs: Inputs, kind: Measurement, failure: Failure) -> Self {
        Self {
            inputs,
            kind,
            body: Body::Nothing,
            failure: Some(failure),
        }
    }

    /// Whether what it holds was read as its words say.
    pub(crate) fn is_read(&self) -> bool {
        (self.failure.as_ref()).is_none_or(|failure| failure.step >= Step::Look)
    }

    /// The strokes, if these are strokes.
    pub(crate) fn strokes(&self) -> Option<&Strokes> {
        match &self.body {
            Body::Strokes(strokes) => Some(strokes),
            _ => None,
        }
    }

    /// The heights, if these are heights.
    pub(crate) fn heights(&self) -> Option<&Heights> {
        match &self.body {
            Body::Heights(heights) => Some(heights),
            _ => None,
        }
    }

    /// Its roughness, a line for every stroke or every place.
    pub(crate) fn figures(&self) -> Vec<String> {
        let of_strokes = self.strokes().and_then(|strokes| strokes.import.as_ref());
        let of_strokes = of_strokes
            .into_iter()
            .flat_map(|import| &import.figures().smd_um);
        let of_strokes = of_strokes.map(|(direction, smd_um)| {
            format!("{} SMD {}", direction.label(), with_unit(*smd_um, 2, "µm"))
        });
        let places = self.heights().map_or(&[][..], |heights| &heights.places);
        let of_places = (1..)
            .zip(places.iter().flatten())
            .map(|(nth, place)| format!("place {nth} SMD {}", with_unit(place.smd_um(), 2, "µm")));
        of_strokes.chain(of_places).collect()
    }

    /// The name that the files suggest.
    pub(crate) fn own_name(&self) -> String {
        if let Some(heights) = self.heights() {
            return heights.import.own_name();
        }
        let first = self.inputs.described.files.first();
        let stem = first.and_then(|file| file.source.path().file_stem());
        stem.unwrap_or_default().to_string_lossy().into_owned()
    }
}

impl Computed<Inputs> for Found {
    const THREAD: &str = "selvedge-import";

    fn compute(
        inputs: &Inputs,
        prior: Option<(&Inputs, &Self)>,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        read(inputs.clone(), prior.map(|(_, found)| found), progress)
    }

    fn broken(inputs: &Inputs, why: &str) -> Self {
        let failure = Failure::at(Step::Files, format!("nothing was read: {why}"));
        Self::failed(inputs.clone(), Measurement::Heights, failure)
    }

    fn serves(under_way: &Inputs, now: &Inputs) -> bool {
        under_way.described == now.described
    }
}

/// Reads; `prior` is what was read before.
pub(crate) fn read(
    inputs: Inputs,
    prior: Option<&Found>,
    progress: &mut Progress<'_>,
) -> Result<Found, Cancelled> {
    progress.step(0.0, "reading")?;
    let n = inputs.described.files.len().max(1) as f64;
    for (nth, file) in inputs.described.files.iter().enumerate() {
        if let Err(line) = file.source.bytes() {
            let mut failure = Failure::at(Step::Files, line);
            failure.file = Some(nth);
            let kind = inputs.described.kind.unwrap_or(Measurement::Strokes);
            return Ok(Found::failed(inputs, kind, failure));
        }
        progress.step(0.2 * (nth + 1) as f64 / n, "reading")?;
    }
    let first = inputs.described.files.first();
    let content = first.and_then(|file| file.source.bytes().ok());
    let kind = inputs.described.kind;
    let kind = kind.unwrap_or_else(|| Measurement::of(content.unwrap_or_default()));
    let is_same = |of: &&Found| of.is_read() && of.inputs.described == inputs.described;
    let again = prior.filter(is_same);
    match kind {
        Measurement::Strokes => strokes(inputs, again, progress),
        Measurement::Heights => heights(inputs, (again, prior), progress),
    }
}

fn kes_file(file: &DraftFile) -> KesFile<'_> {
    KesFile {
        path: file.source.file_name(),
        bytes: file.source.bytes().unwrap_or_default(),
    }
}

fn strokes(
    inputs: Inputs,
    prior: Option<&Found>,
    progress: &mut Progress<'_>,
) -> Result<Found, Cancelled> {
    let kind = Measurement::Strokes;
    let options = match inputs.described.kes_options() {
        Ok(options) => options,
        Err(failure) => {
            let looks = looks(&inputs.described.files, &KesOptions::default());
            let body = Body::Strokes(Box::new(Strokes::only(looks)));
            let failure = Some(failure);
            return Ok(Found {
                inputs,
                kind,
                body,
                failure,
            });
        }
    };
    let again = prior
        .and_then(Found::strokes)
        .filter(|strokes| strokes.reading.is_some());
    let (mut strokes, mut failure) = match again {
        Some(strokes) => (strokes.clone(), None),
        None => read_strokes(&inputs.described.files, &options, progress)?,
    };
    progress.step(0.8, "evaluating")?;
    if let Some(reading) = &strokes.reading {
        let looked = &inputs.looked;
        let import = KesImport::new(Arc::clone(reading), looked.sections, looked.is_official);
        strokes.import = match import {
            Ok(import) => Some(import),
            Err(error) => {
                failure = Some(Failure::of(Step::Look, &error));
                None
            }
        };
    }
    let body = Body::Strokes(Box::new(strokes));
    Ok(Found {
        inputs,
        kind,
        body,
        failure,
    })
}

fn looks(files: &[DraftFile], options: &KesOptions) -> Vec<Result<KesLook, String>> {
    let look = |file: &DraftFile| {
        let look = KesLook::of(&kes_file(file), options, file.is_friction);
        look.map_err(|error| error.to_string())
    };
    files.iter().map(look).collect()
}

fn read_strokes(
    files: &[DraftFile],
    options: &KesOptions,
    progress: &mut Progress<'_>,
) -> Result<(Strokes, Option<Failure>), Cancelled> {
    let mut strokes = Strokes::only(looks(files, options));
    progress.step(0.4, "reading")?;
    let (friction, heights): (Vec<&DraftFile>, Vec<&DraftFile>) =
        files.iter().partition(|file| file.is_friction);
    if friction.len() > 1 {
        let line = "two files of friction; a textile has one trace: leave the other out";
        return Ok((strokes, Some(Failure::at(Step::Files, line))));
    }
    if heights.is_empty() {
        let line = "friction alone; add the file of the roughness strokes along the warp";
        return Ok((strokes, Some(Failure::at(Step::Files, line))));
    }
    let given: Vec<KesFile<'_>> = heights.into_iter().map(kes_file).collect();
    let friction = friction.first().map(|file| kes_file(file));
    let failure = match KesReading::of(&given, friction, options) {
        Err(error) => {
            let mut failure = Failure::of(Step::Meaning, &error);
            failure.file = file_of(files, &error);
            Some(failure)
        }
        Ok(reading) => {
            let envelope = |stroke: &selvedge_textile::KesStroke| Envelope::of(&stroke.heights_um);
            strokes.envelopes = Arc::new(reading.strokes.iter().map(envelope).collect());
            let friction = reading.friction.as_ref();
            strokes.friction = friction.map(|friction| Arc::new(Envelope::of(&friction.mu)));
            strokes.reading = Some(Arc::new(reading));
            None
        }
    };
    Ok((strokes, failure))
}

/// Which of the files an error names.
fn file_of(files: &[DraftFile], error: &TextileError) -> Option<usize> {
    let TextileError::Kes { path, .. } = error else {
        return None;
    };
    files
        .iter()
        .position(|file| file.source.file_name() == path)
}

impl Strokes {
    fn only(looks: Vec<Result<KesLook, String>>) -> Self {
        Self {
            looks,
            reading: None,
            envelopes: Arc::default(),
            friction: None,
            import: None,
        }
    }
}

/// `again` is what was read of the same words, `prior` of whatever words before.
fn heights(
    inputs: Inputs,
    (again, prior): (Option<&Found>, Option<&Found>),
    progress: &mut Progress<'_>,
) -> Result<Found, Cancelled> {
    let kind = Measurement::Heights;
    if inputs.described.files.len() > 1 {
        let line = "one file of heights makes an import; leave the others out";
        return Ok(Found::failed(inputs, kind, Failure::at(Step::Files, line)));
    }
    let mut heights = match again.and_then(Found::heights) {
        Some(heights) => heights.clone(),
        None => match read_heights(&inputs.described, progress)? {
            Ok(heights) => heights,
            Err(failure) => {
                // What the same file held before stays in sight while something is being typed.
                let files = &inputs.described.files;
                let is_same =
                    |prior: &&Found| prior.kind == kind && prior.inputs.described.files == *files;
                let last = prior.filter(is_same);
                let body = last.map_or(Body::Nothing, |last| last.body.clone());
                return Ok(Found {
                    body,
                    ..Found::failed(inputs, kind, failure)
                });
            }
        },
    };
    let said: Vec<Option<[f64; 2]>> = match &inputs.looked.places[..] {
        [] => vec![None],
        places => places.iter().copied().map(Some).collect(),
    };
    let known = std::mem::take(&mut heights.places);
    let (n, mut failure) = (said.len(), None);
    for (nth, place_mm) in said.into_iter().enumerate() {
        progress.step(
            0.6 + 0.4 * nth as f64 / n as f64,
            "drawing the tester over it",
        )?;
        let is_known = |place: &&Arc<HeightPlace>| place.place_mm == place_mm;
        let again = known.iter().flatten().find(is_known).map(Arc::clone);
        let place = match again {
            Some(place) => Ok(place),
            None => heights.import.place(place_mm).map(Arc::new),
        };
        heights.places.push(place.map_err(|error| {
            let wrong = Failure::of(Step::Look, &error);
            let line = wrong.line.clone();
            failure.get_or_insert(wrong);
            line
        }));
    }
    let body = Body::Heights(Box::new(heights));
    Ok(Found {
        inputs,
        kind,
        body,
        failure,
    })
}

fn read_heights(
    described: &ReaderDraft,
    progress: &mut Progress<'_>,
) -> Result<Result<Heights, Failure>, Cancelled> {
    let options = match described.height_options() {
        Ok(options) => options,
        Err(failure) => return Ok(Err(failure)),
    };
    let Some(file) = described.files.first() else {
        return Ok(Err(Failure::at(Step::Files, "no file; add one")));
    };
    let bytes = file.source.bytes().unwrap_or_default();
    let import = match HeightImport::of(bytes, file.source.file_name(), &options) {
        Ok(import) => import,
        Err(error) => return Ok(Err(Failure::of_heights(&error))),
    };
    progress.step(0.5, "reading")?;
    let is_profile = import.measured().is_profile();
    let relief = (!is_profile).then(|| Arc::new(Relief::of(import.map())));
    let row = || Envelope::of(import.map().heights_um().values());
    let profile = is_profile.then(|| Arc::new(row()));
    Ok(Ok(Heights {
        import: Arc::new(import),
        relief,
        profile,
        places: Vec::new(),
    }))
}
