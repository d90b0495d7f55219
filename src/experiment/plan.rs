//! A plan that is frozen before the first subject comes: what is asked of the data, by which tests,
//! of how many people, and what will be left out. Its hash stands in the sidecar of every session
//! that is held beside it, and analyses set it beside what was done.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::ExperimentError;
use crate::design::{Design, Kind, Rules};
use selvedge_foundation::files::{self, FileError, sha256_hex};

/// A plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// The study's id.
    pub study: String,
    /// Which experiment of the study.
    pub experiment: String,
    /// The design that it is for.
    pub design_sha256: String,
    /// How many people take part.
    pub subjects: usize,
    /// How often a test may reject what is true, 0 to 1.
    pub alpha: f64,
    /// Between which differences two conditions count as equal, in the unit of what is compared;
    /// left out where no equality is claimed.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub equivalence: Option<[f64; 2]>,
    /// What is left out, as the design's rules have it.
    pub exclusions: Rules,
    /// What is asked of the data.
    #[serde(rename = "hypothesis", default)]
    pub(crate) hypotheses: Vec<Hypothesis>,
}

/// Something that is expected, and how it is tested.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Hypothesis {
    /// What is expected, in a sentence.
    pub expected: String,
    /// The test.
    pub test: String,
}

/// A plan and the hash of its file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FrozenPlan {
    /// The plan.
    pub plan: Plan,
    /// SHA-256 of its file.
    pub sha256: String,
}

impl Plan {
    /// What a design and its method suggest, to be edited before it is frozen.
    pub fn suggested(design: &Design) -> Self {
        let (expected, test) = suggested(design.composition.kind());
        Self {
            study: design.study.clone(),
            experiment: design.experiment.clone(),
            design_sha256: design.hash.clone(),
            subjects: design.rules.subjects,
            alpha: 0.05,
            equivalence: None,
            exclusions: design.rules,
            hypotheses: vec![Hypothesis {
                expected: expected.to_owned(),
                test: test.to_owned(),
            }],
        }
    }

    /// Where the plan of a design lies in the folder of its sessions.
    pub fn path(folder: &Path, design: &Design) -> PathBuf {
        folder.join(format!("{}_{}.plan.toml", design.study, design.experiment))
    }

    /// As its file has it.
    ///
    /// # Errors
    /// None that a plan could have.
    pub fn to_toml(&self, path: &Path) -> Result<String, ExperimentError> {
        Ok(files::keys_to_string(self, path)?)
    }

    /// Whether its numbers make sense; `path` names it in errors.
    ///
    /// # Errors
    /// A number makes none.
    pub fn check(&self, path: &Path) -> Result<(), FileError> {
        let is_alpha = self.alpha > 0.0 && self.alpha < 1.0;
        let are_bounds = self.equivalence.is_none_or(|[low, high]| low < high);
        let (what, mend) = match (is_alpha, are_bounds) {
            (true, true) => return Ok(()),
            (false, _) => (
                format!("alpha is {}", self.alpha),
                "give a number between 0 and 1",
            ),
            (_, false) => (
                format!("equivalence is {:?}", self.equivalence),
                "give a lower and a higher bound",
            ),
        };
        Err(FileError::whole(path, what, mend))
    }
}

impl FrozenPlan {
    /// The plan of a design in the folder of its sessions, if there is one.
    ///
    /// # Errors
    /// It cannot be read, or is none.
    pub(crate) fn find(folder: &Path, design: &Design) -> Result<Option<Self>, ExperimentError> {
        let path = Plan::path(folder, design);
        if !path.exists() {
            return Ok(None);
        }
        let text = files::read_text(&path)?;
        let plan: Plan = files::keys_from_str(&text, &path)?;
        plan.check(&path)?;
        Ok(Some(Self {
            plan,
            sha256: sha256_hex([text.as_bytes()]),
        }))
    }

    /// The plan by which a session is begun.
    ///
    /// # Errors
    /// Likewise, or it is for another text of the design.
    pub(crate) fn to_begin(
        folder: &Path,
        design: &Design,
    ) -> Result<Option<Self>, ExperimentError> {
        let found = Self::find(folder, design)?;
        if found
            .as_ref()
            .is_none_or(|one| one.plan.design_sha256 == design.hash)
        {
            return Ok(found);
        }
        let what = "the plan was frozen for another text of the design";
        let mend = "restore the design, or freeze a plan for this one in another folder";
        Err(FileError::whole(&Plan::path(folder, design), what, mend).into())
    }
}

/// What a composition usually asks, and the test that its analysis makes of it.
fn suggested(kind: Kind) -> (&'static str, &'static str) {
    match kind {
        Kind::Ranking => (
            "the target is ranked first more often than by chance",
            "one-sample t of the shares against 25 %, two-sided",
        ),
        Kind::OddOneOut => (
            "the odd one is found more often than by chance",
            "one-sample t of the shares against a third, two-sided",
        ),
        Kind::Adjustment => (
            "what is adjusted differs from textile to textile",
            "analysis of variance with repeated measures, Greenhouse–Geisser",
        ),
        Kind::Judgement => (
            "real and generated ones are not called real equally often",
            "analysis of variance with repeated measures of signal × material",
        ),
        Kind::Levels => (
            "none: a threshold is estimated",
            "interval of the group's threshold, 95 %",
        ),
        Kind::Magnitude => (
            "strength grows with amplitude by a power",
            "interval of the group's exponent, 95 %",
        ),
        Kind::Rating => (
            "places differ from stimulus to stimulus",
            "analysis of variance with repeated measures, Greenhouse–Geisser",
        ),
        Kind::Equality => (
            "none: a point of equality is estimated",
            "interval of the group's point of equality, 95 %",
        ),
        Kind::Choice => (
            "answers are right more often than by chance",
            "one-sample t of the shares against chance, two-sided",
        ),
        Kind::Preference | Kind::Orders => (
            "some stimuli are put before others",
            "Bradley and Terry's model against equal values",
        ),
        Kind::Dissimilarity | Kind::Sorting => (
            "subjects agree on what is alike",
            "Kendall's W over the pairs",
        ),
    }
}
