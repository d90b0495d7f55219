//! An import that is decided upon: which section, what figures; and the textile's files.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use super::description::{Description, manifest_file};
use crate::build::BuiltFile;
use crate::error::{KesAsk, TextileError};
use crate::kes::{
    KesReading, KesSection, KesStroke, TextileAxis, asks, covered_mm, n_samples, suggested,
};
use crate::manifest::MANIFEST;
use crate::profile_file;
use crate::sources::Source;
use crate::sources::profiles::{IMPORTER, KesOrigin, Profiles};
use crate::surface::{
    Direction, FrictionTrace, OFFICIAL_CUT_OFF_MM, WINDOW_LENGTH_MM, mean_deviation,
    without_long_waves,
};

/// The file of a trace of friction.
const FRICTION: &str = "friction.csv";

/// A reading with its sections: what a window shows before a textile is made.
#[derive(Debug, Clone, PartialEq)]
pub struct KesImport {
    reading: Arc<KesReading>,
    sections: [Option<KesSection>; 2],
    friction_section: Option<KesSection>,
    figures: KesFigures,
}

/// The figures of the evaluated sections.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct KesFigures {
    /// Roughness of every stroke, µm.
    pub smd_um: Vec<(Direction, f64)>,
    /// The same against the official band, if asked.
    pub smd_official_um: Vec<(Direction, f64)>,
    /// Mean friction.
    pub miu: Option<f64>,
    /// Mean deviation of friction.
    pub mmd: Option<f64>,
    /// The same against the official band, if asked.
    pub mmd_official: Option<f64>,
}

impl KesImport {
    /// An import of a reading. `said` are sections by axis, in mm along the forward axis; where
    /// none is said, the most stationary 20 mm are taken. `is_official` asks for figures against
    /// the official band too.
    ///
    /// # Errors
    /// A section that a stroke does not cover, or shorter than 4.35 mm.
    pub fn new(
        reading: impl Into<Arc<KesReading>>,
        said: [Option<[f64; 2]>; 2],
        is_official: bool,
    ) -> Result<Self, TextileError> {
        let reading = reading.into();
        let [warp, weft] = said;
        let sections = [
            section_of(&reading, TextileAxis::Warp, warp)?,
            section_of(&reading, TextileAxis::Weft, weft)?,
        ];
        let friction = friction_stroke(&reading);
        let friction_section = friction.as_ref().and_then(|stroke| {
            let along_warp = sections[0].filter(|section| stroke.samples_of(section).is_some());
            along_warp.or_else(|| suggested(&[stroke]))
        });
        let mut import = Self {
            reading,
            sections,
            friction_section,
            figures: KesFigures::default(),
        };
        import.figures = import.evaluated(is_official)?;
        Ok(import)
    }

    /// What the files hold.
    pub fn reading(&self) -> &KesReading {
        &self.reading
    }

    /// The evaluated section of an axis, if anything was measured along it.
    pub fn section(&self, axis: TextileAxis) -> Option<&KesSection> {
        self.sections[usize::from(axis == TextileAxis::Weft)].as_ref()
    }

    /// The evaluated section of the friction trace.
    pub fn friction_section(&self) -> Option<&KesSection> {
        self.friction_section.as_ref()
    }

    /// The figures of the sections.
    pub fn figures(&self) -> &KesFigures {
        &self.figures
    }

    /// The section of a stroke, as samples in the order of travel.
    pub fn samples(&self, stroke: &KesStroke) -> std::ops::Range<usize> {
        let section = self.section(stroke.axis());
        section
            .and_then(|section| stroke.samples_of(section))
            .unwrap_or(0..0)
    }

    /// The friction of its section.
    pub(crate) fn friction(&self) -> Result<Option<FrictionTrace>, TextileError> {
        let (Some(stroke), Some(friction)) =
            (friction_stroke(&self.reading), &self.reading.friction)
        else {
            return Ok(None);
        };
        let section = self
            .friction_section
            .and_then(|section| stroke.samples_of(&section));
        let mu = friction.mu[section.unwrap_or(0..friction.mu.len())].to_vec();
        let trace = FrictionTrace::new(friction.step_mm, mu);
        trace.map(Some).map_err(TextileError::surface(FRICTION))
    }

    fn evaluated(&self, is_official: bool) -> Result<KesFigures, TextileError> {
        let mut figures = KesFigures::default();
        for stroke in &self.reading.strokes {
            let samples = self.samples(stroke);
            let smd_um = mean_deviation(&stroke.heights_um[samples.clone()]);
            figures.smd_um.push((stroke.direction, smd_um));
            if is_official {
                // With what the filter reaches on either side, so that the section has no ends.
                let reach = n_samples(OFFICIAL_CUT_OFF_MM, stroke.step_mm) + 1;
                let first = samples.start.saturating_sub(reach);
                let last = (samples.end + reach).min(stroke.heights_um.len());
                let rough = without_long_waves(stroke.step_mm, &stroke.heights_um[first..last]);
                let smd_um = mean_deviation(&rough[samples.start - first..samples.end - first]);
                figures.smd_official_um.push((stroke.direction, smd_um));
            }
        }
        if let Some(friction) = self.friction()? {
            figures.miu = Some(friction.miu());
            figures.mmd = Some(friction.mmd());
            figures.mmd_official = is_official.then(|| friction.mmd_official());
        }
        Ok(figures)
    }

    /// The files of the textile: profiles of the sections, friction, the manifest last.
    pub fn files(&self, description: &Description) -> Result<Vec<BuiltFile>, TextileError> {
        let mut files = Vec::new();
        let mut profiles = Profiles::default();
        for stroke in &self.reading.strokes {
            let name = format!("{}.csv", stroke.direction.key());
            let heights = &stroke.heights_um[self.samples(stroke)];
            let text = profile_file::write(heights, stroke.step_mm, Path::new(&name))?;
            files.push(BuiltFile::new(&name, text));
            *profiles.file_mut(stroke.direction) = Some(name);
        }
        if let Some(friction) = self.friction()? {
            let text = profile_file::write_friction(&friction, Path::new(FRICTION))?;
            files.push(BuiltFile::new(FRICTION, text));
            profiles.friction = Some(FRICTION.to_owned());
        }
        profiles.imported = Some(Box::new(self.origin()));
        let source = Source::Profiles(Box::new(profiles));
        let manifest = description.manifest(source, self.figures.measured());
        files.push(manifest_file(&manifest, Path::new(MANIFEST))?);
        Ok(files)
    }

    fn origin(&self) -> KesOrigin {
        let [files, sha256] = [0, 1].map(|which| {
            self.reading
                .files
                .iter()
                .map(|file| file[which].clone())
                .collect()
        });
        let bounds = |section: Option<KesSection>| {
            section.map(|section| [section.from_mm, section.to_mm].map(|mm| rounded(mm, 1e6)))
        };
        let tilt = |stroke: &KesStroke| {
            let key = stroke.direction.key().to_owned();
            (key, rounded(stroke.tilt_um_per_mm, 1e6))
        };
        KesOrigin {
            importer: IMPORTER.to_owned(),
            files,
            sha256,
            assumed: self.reading.assumed.clone(),
            um_per_volt: self.reading.um_per_volt,
            warp_section_mm: bounds(self.sections[0]),
            weft_section_mm: bounds(self.sections[1]),
            is_section_suggested: self.sections.iter().flatten().all(|one| one.is_suggested),
            tilt_um_per_mm: self.reading.strokes.iter().map(tilt).collect(),
        }
    }
}

impl KesFigures {
    /// The figures by the keys of a manifest's `[measured]`.
    pub fn measured(&self) -> BTreeMap<String, f64> {
        use TextileAxis::{Warp, Weft};

        let both = |values: &[(Direction, f64)]| {
            let has = |axis| mean_of(values, Some(axis)).is_some();
            has(Warp) && has(Weft)
        };
        let axes = both(&self.smd_um);
        let of_axis = |values, axis| mean_of(values, Some(axis)).filter(|_| axes);
        let um = |value: Option<f64>| value.map(|value| rounded(value, 1e2));
        let plain = |value: Option<f64>| value.map(|value| rounded(value, 1e5));
        let (smd, official) = (&self.smd_um[..], &self.smd_official_um[..]);
        let all = [
            ("smd_um", um(mean_of(smd, None))),
            ("smd_warp_um", um(of_axis(smd, Warp))),
            ("smd_weft_um", um(of_axis(smd, Weft))),
            ("smd_official_um", um(mean_of(official, None))),
            ("miu", plain(self.miu)),
            ("mmd", plain(self.mmd)),
            ("mmd_official", plain(self.mmd_official)),
        ];
        all.into_iter()
            .filter_map(|(key, value)| Some((key.to_owned(), value?)))
            .collect()
    }
}

/// The mean over the strokes of an axis, or of both; `None` of none.
fn mean_of(values: &[(Direction, f64)], axis: Option<TextileAxis>) -> Option<f64> {
    let is_meant = |(direction, _): &&(Direction, f64)| {
        axis.is_none_or(|axis| direction.is_weft() == (axis == TextileAxis::Weft))
    };
    let of_axis: Vec<f64> = values
        .iter()
        .filter(is_meant)
        .map(|(_, value)| *value)
        .collect();
    (!of_axis.is_empty()).then(|| of_axis.iter().sum::<f64>() / of_axis.len() as f64)
}

fn rounded(value: f64, per_unit: f64) -> f64 {
    // Adding 0 turns −0 into 0.
    (value * per_unit).round() / per_unit + 0.0
}

/// The section of an axis: the one said, or the one suggested.
fn section_of(
    reading: &KesReading,
    axis: TextileAxis,
    said: Option<[f64; 2]>,
) -> Result<Option<KesSection>, TextileError> {
    let along = |stroke: &&KesStroke| stroke.axis() == axis;
    let strokes: Vec<&KesStroke> = reading.strokes.iter().filter(along).collect();
    let name = match axis {
        TextileAxis::Warp => "warp",
        TextileAxis::Weft => "weft",
    };
    let first = reading.files.first().map_or("-", |[name, _]| name);
    let wrong = |what: String| asks(Path::new(first), 1, what, KesAsk::Section);
    let Some([low, high]) = covered_mm(&strokes) else {
        return Ok(None);
    };
    let found = match said {
        None => suggested(&strokes),
        Some([from_mm, to_mm]) => {
            let is_long = (WINDOW_LENGTH_MM..1e6).contains(&(to_mm - from_mm));
            if !is_long {
                return Err(wrong(format!(
                    "the {name} section from {from_mm} to {to_mm} mm is shorter than 4.35 mm"
                )));
            }
            let section = KesSection {
                from_mm,
                to_mm,
                is_suggested: false,
            };
            let is_covered = |stroke: &&KesStroke| stroke.samples_of(&section).is_some();
            strokes.iter().all(is_covered).then_some(section)
        }
    };
    found.map(Some).ok_or_else(|| {
        let [from, to] = said.unwrap_or([low, high]);
        wrong(format!(
            "the {name} strokes cover {low:.3} to {high:.3} mm, not {from} to {to} mm"
        ))
    })
}

/// The friction as a stroke, so that sections are chosen on it alike.
fn friction_stroke(reading: &KesReading) -> Option<KesStroke> {
    let friction = reading.friction.as_ref()?;
    Some(KesStroke {
        direction: Direction::WarpForward,
        step_mm: friction.step_mm,
        start_mm: friction.start_mm,
        // In thousandths, so that differences are of the size that heights have.
        heights_um: friction.mu.iter().map(|mu| mu * 1e3).collect(),
        tilt_um_per_mm: 0.0,
        marks: Vec::new(),
    })
}
