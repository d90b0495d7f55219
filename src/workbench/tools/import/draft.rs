//! What the user has chosen and typed so far, and what the readers are told of it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::bench::source_file::SourceFile;
use crate::tools::import::failure::{Failure, Step};
use selvedge_textile::metrology::HeightOptions;
use selvedge_textile::surface::{Levelling, Preparation, Representation};
use selvedge_textile::{
    ColumnRole, Construction, DecimalSign, Description, ImportOptions, KesOptions, KesPlace,
    KnownFigure, LengthUnit, Measurement, ReturnOrder, Unit, id_of,
};

/// A file and what was said of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct DraftFile {
    /// The file.
    pub source: SourceFile,
    /// What it holds; `None`: by its columns and its name.
    pub place: Option<KesPlace>,
    /// Whether it is a trace of friction alone.
    pub is_friction: bool,
}

/// What the tester's files do not say.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct StrokesDraft {
    /// What the columns are.
    pub columns: Option<Vec<ColumnRole>>,
    /// The decimal sign.
    pub decimal: Option<DecimalSign>,
    /// The unit of places.
    pub x_unit: Option<LengthUnit>,
    /// The unit of heights.
    pub height_unit: Option<Unit>,
    /// How return strokes are stored.
    pub return_order: Option<ReturnOrder>,
    /// µm for a volt, as typed.
    pub um_per_volt: String,
    /// The step in mm, as typed.
    pub step_mm: String,
    /// The speed in mm/s, as typed.
    pub speed_mm_per_s: String,
    /// Samples a second, as typed.
    pub rate_hz: String,
}

/// What a file of heights does not say, and what is done to them.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct HeightsDraft {
    /// The unit of heights.
    pub height_unit: Option<LengthUnit>,
    /// The unit of places.
    pub length_unit: Option<LengthUnit>,
    /// The distance of points in mm, as typed.
    pub step_mm: String,
    /// White above black in µm, as typed.
    pub range_um: String,
    /// The column of heights, as typed.
    pub column: String,
    /// Which field of several, from 1.
    pub layer: Option<usize>,
    /// Whether uneven points are brought to even steps.
    pub is_resampled: bool,
    /// The part that is taken, as typed: u, w to u, w, mm.
    pub crop: String,
    /// Robust spreads from which on a height is a spike, as typed.
    pub despike: String,
    /// What is taken off; `None`: the best plane, or nothing of a repeat.
    pub level: Option<Levelling>,
    /// Whether it is one repeat of the cloth.
    pub is_periodic: bool,
    /// How it is felt.
    pub representation: Representation,
}

/// Everything that the readers are told.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct ReaderDraft {
    /// The files.
    pub files: Vec<DraftFile>,
    /// What they are; `None`: by their content.
    pub kind: Option<Measurement>,
    /// Of the tester's files.
    pub strokes: StrokesDraft,
    /// Of a file of heights.
    pub heights: HeightsDraft,
}

/// What is looked at of what was read.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct EvaluationDraft {
    /// The evaluated sections of warp and weft, mm; `None`: the one suggested.
    pub sections: [Option<[f64; 2]>; 2],
    /// Whether figures against the official band are asked for.
    pub is_official: bool,
    /// Where strokes cross on a map, mm; none: in the middle.
    pub places: Vec<[f64; 2]>,
}

/// What is said of the textile.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct WordsDraft {
    /// Its name; empty: the one that the file suggests.
    pub name: String,
    /// Its id; empty: from the name.
    pub id: String,
    /// How it is made.
    pub construction: Option<Construction>,
    /// What it is made of.
    pub fibre: String,
    /// The licence of its files.
    pub licence: String,
    /// One line of description.
    pub notes: String,
    /// Measured figures by their keys, as typed.
    pub figures: Vec<(String, String)>,
}

/// All of it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Draft {
    /// What the readers are told.
    pub described: ReaderDraft,
    /// What is looked at.
    pub looked: EvaluationDraft,
    /// What is said of the textile.
    pub words: WordsDraft,
}

impl Draft {
    /// Whether more was chosen and typed than which files there are.
    pub(crate) fn is_begun(&self) -> bool {
        let described = ReaderDraft {
            files: self.described.files.clone(),
            ..ReaderDraft::default()
        };
        let fresh = Self {
            described,
            ..Self::default()
        };
        let is_placed = |file: &DraftFile| file.place.is_some() || file.is_friction;
        let files = &self.described.files;
        !files.is_empty() && (*self != fresh || files.iter().any(is_placed))
    }
}

/// A number that was typed, or none; `what` names it, with its unit.
pub(crate) fn number(text: &str, what: &str) -> Result<Option<f64>, String> {
    let plain = text.trim().replace(',', ".").replace('\u{2212}', "-");
    if plain.is_empty() {
        return Ok(None);
    }
    let number = plain
        .parse::<f64>()
        .ok()
        .filter(|number| number.is_finite());
    let wrong = || {
        format!(
            "“{}” is no number for {what}; type one, or nothing",
            text.trim()
        )
    };
    number.map(Some).ok_or_else(wrong)
}

/// The corners of a part that were typed, mm, or none.
fn corners(text: &str) -> Result<Option<[f64; 4]>, String> {
    let parts: Vec<&str> = text
        .split([' ', ';'])
        .filter(|part| !part.is_empty())
        .collect();
    if parts.is_empty() {
        return Ok(None);
    }
    let numbers: Result<Vec<_>, _> = parts.iter().map(|part| number(part, "the part")).collect();
    let numbers: Option<Vec<f64>> = numbers?.into_iter().collect();
    let four = numbers.and_then(|numbers| numbers.try_into().ok());
    four.map(Some)
        .ok_or_else(|| format!("“{text}” is no part; type four numbers in mm: u w u w"))
}

impl ReaderDraft {
    /// The tester's options.
    pub(crate) fn kes_options(&self) -> Result<KesOptions, Failure> {
        let typed = &self.strokes;
        let number = |text: &str, what: &str| {
            number(text, what).map_err(|line| Failure::at(Step::Meaning, line))
        };
        let files = self.files.iter().filter(|file| !file.is_friction);
        Ok(KesOptions {
            directions: files.map(|file| file.place).collect(),
            step_mm: number(&typed.step_mm, "the step in mm")?,
            speed_mm_per_s: number(&typed.speed_mm_per_s, "the speed in mm/s")?,
            rate_hz: number(&typed.rate_hz, "samples a second")?,
            um_per_volt: number(&typed.um_per_volt, "the sensitivity in µm/V")?,
            x_unit: typed.x_unit,
            height_unit: typed.height_unit,
            decimal: typed.decimal,
            columns: typed.columns.clone(),
            return_order: typed.return_order,
        })
    }

    /// The options of a file of heights.
    pub(crate) fn height_options(&self) -> Result<ImportOptions, Failure> {
        let typed = &self.heights;
        let number = |text: &str, what: &str| {
            number(text, what).map_err(|line| Failure::at(Step::Meaning, line))
        };
        let column = typed.column.trim();
        Ok(ImportOptions {
            asked: HeightOptions {
                height_unit: typed.height_unit,
                length_unit: typed.length_unit,
                step_mm: number(&typed.step_mm, "the distance of points in mm")?,
                range_um: number(&typed.range_um, "white above black in µm")?,
                column: (!column.is_empty()).then(|| column.to_owned()),
                layer: typed.layer,
                resample: typed.is_resampled,
            },
            preparation: Preparation {
                crop_mm: corners(&typed.crop).map_err(|line| Failure::at(Step::Meaning, line))?,
                despike: number(&typed.despike, "robust spreads")?,
                level: typed.level,
            },
            is_periodic: typed.is_periodic,
            representation: typed.representation,
        })
    }
}

impl WordsDraft {
    /// The name: as typed, or the one suggested.
    pub(crate) fn name<'a>(&'a self, suggested: &'a str) -> &'a str {
        let typed = self.name.trim();
        if typed.is_empty() { suggested } else { typed }
    }

    /// The id: as typed, or from the name.
    pub(crate) fn id(&self, suggested: &str) -> String {
        let typed = self.id.trim();
        let from = if typed.is_empty() {
            self.name(suggested)
        } else {
            typed
        };
        id_of(from)
    }

    /// The words; why not, in one line.
    pub(crate) fn words(&self, suggested: &str, kind: Measurement) -> Result<Description, Failure> {
        let mut figures = BTreeMap::new();
        for (key, text) in &self.figures {
            let figure = KnownFigure::all().find(|figure| figure.key == *key);
            let name = figure.map_or_else(|| key.clone(), |figure| figure.name);
            let value = number(text, &name).map_err(|line| Failure::at(Step::Keep, line))?;
            if let Some(value) = value {
                figures.insert(key.clone(), value);
            }
        }
        let usual = match kind {
            Measurement::Strokes => Construction::Woven,
            Measurement::Heights => Construction::Other,
        };
        Ok(Description {
            name: self.name(suggested).to_owned(),
            construction: self.construction.unwrap_or(usual),
            fibre: self.fibre.trim().to_owned(),
            licence: self.licence.trim().to_owned(),
            notes: self.notes.trim().to_owned(),
            figures,
        })
    }
}
