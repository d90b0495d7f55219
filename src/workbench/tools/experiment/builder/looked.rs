//! What a design comes to, counted in the background: trials, minutes, balance, power, its first
//! trial, textiles that its library has not; and a whole study of simulated observers.

use std::path::{Path, PathBuf};

use crate::bench::latest::Computed;
use crate::bench::settings::build_cache;
use selvedge_experiment::analysis::{self, Analysis};
use selvedge_experiment::design::{Design, Source, Subject};
use selvedge_experiment::observer::{Observer, Stimuli};
use selvedge_experiment::{Preview, PreviewOptions, Procedure, Simulation, Trial};
use selvedge_foundation::progress::{Cancelled, Progress};

/// Standard deviation over simulated observers of the logarithm of their noise.
const SPREAD: f64 = 0.2;

/// A design, and what is asked of it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Looking {
    /// Its text.
    pub(crate) text: String,
    /// Its file, which its library is relative to.
    pub(crate) path: PathBuf,
    /// The effect that power is for.
    pub(crate) effect: f64,
}

/// What a design comes to.
#[derive(Debug)]
pub(crate) struct Looked {
    /// What it is counted to, or why it cannot be.
    pub(crate) preview: Result<Preview, String>,
    /// A trial that counts, the first.
    pub(crate) trial: Option<Trial>,
    /// Why textiles of it cannot be felt, a line each.
    pub(crate) missing: Vec<String>,
}

impl Computed<Looking> for Looked {
    const THREAD: &str = "selvedge-design";

    fn compute(
        key: &Looking,
        _: Option<(&Looking, &Self)>,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let design = match Design::from_toml(&key.text, &key.path) {
            Ok(design) => design,
            Err(error) => return Ok(Self::broken(key, &error.to_string())),
        };
        progress.step(0.1, "schedules")?;
        let options = PreviewOptions {
            n_subjects: None,
            effect: key.effect,
            seed: 1,
        };
        let preview = Preview::of(&design, &options).map_err(|error| error.to_string());
        progress.step(0.6, "textiles")?;
        Ok(Self {
            preview,
            trial: first_trial(&design),
            missing: missing(&design, &key.path),
        })
    }

    fn broken(_: &Looking, why: &str) -> Self {
        Self {
            preview: Err(why.to_owned()),
            trial: None,
            missing: Vec::new(),
        }
    }

    fn serves(under_way: &Looking, now: &Looking) -> bool {
        under_way == now
    }
}

fn first_trial(design: &Design) -> Option<Trial> {
    let subject = Subject {
        pseudonym: "p01".to_owned(),
        nth: 0,
        session: 1,
    };
    let procedure = Procedure::of(design, &subject).ok()?;
    let mut listed = procedure.listed().iter();
    let counts = listed.find(|trial| !trial.is_practice);
    counts.or_else(|| procedure.trial()).cloned()
}

/// Why textiles cannot be felt: each is looked for in the library that the design names.
fn missing(design: &Design, path: &Path) -> Vec<String> {
    let ids = design.stimuli.iter().filter_map(|one| match &one.source {
        Source::Textile { id, .. } => Some(id.as_str()),
        _ => None,
    });
    let mut ids: Vec<&str> = ids.collect();
    if ids.is_empty() {
        return Vec::new();
    }
    ids.sort_unstable();
    ids.dedup();
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    match design.open_library(folder, build_cache().as_ref()) {
        Err(error) => vec![error.to_string()],
        Ok(library) => {
            let fault = |id: &str| Some(library.manifest(id).err()?.to_string());
            ids.into_iter().filter_map(fault).collect()
        }
    }
}

/// A study of the size that the design plans, by simulated observers who differ: its first page, a
/// line each.
///
/// # Errors
/// Its textiles or schedules are none, or it was stopped, in one line.
pub(crate) fn simulated(
    design: &Design,
    path: &Path,
    progress: &mut Progress<'_>,
) -> Result<Vec<String>, String> {
    let failed = |error: selvedge_experiment::ExperimentError| error.to_string();
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    let library = design.open_library(folder, build_cache().as_ref());
    let library = library.map_err(|error| error.to_string())?;
    let stimuli = progress.within([0.0, 0.4], |part| Stimuli::of(design, &library, part));
    let observer = Observer {
        jnd_spread: SPREAD,
        ..Observer::default()
    };
    let simulation = Simulation {
        design,
        stimuli: &stimuli.map_err(failed)?,
        observer: &observer,
        seed: 1,
    };
    let n_subjects = design.rules.subjects;
    let n_subjects = if n_subjects == 0 { 8 } else { n_subjects };
    let found = simulation.sessions(n_subjects, 1).map_err(failed)?;
    let options = analysis::Options::default();
    let page = progress.within([0.5, 1.0], |part| Analysis::of(&found, &options, part));
    let sections = page.map_err(failed)?.sections;
    let notes = sections.first().map_or(&[][..], |section| &section.notes);
    let mut lines = vec![format!("{n_subjects} observers; {}", observer.describe())];
    lines.extend(notes.iter().map(|line| line.replace("**", "")));
    Ok(lines)
}
