//! What the user has chosen and typed of a picture so far.

use serde::{Deserialize, Serialize};

use crate::bench::source_file::SourceFile;
use selvedge_textile::picture::shading::{Light, Method};
use selvedge_textile::picture::{Lattice, PictureScale, Relief, ReliefOf};
use selvedge_textile::surface::Representation;
use selvedge_textile::{HeightScale, id_of};

/// Which part of the picture is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) enum Part {
    /// All of it.
    #[default]
    Whole,
    /// x, y, width, height, px.
    Region([usize; 4]),
    /// What lies between four corners: upper left, upper right, lower right, lower left, px.
    Corners([[f64; 2]; 4]),
}

/// What a scale is typed in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) enum ScaleUnit {
    /// Dots to an inch, as scanners count.
    #[default]
    Dpi,
    /// Pixels to a millimetre.
    PxPerMm,
    /// Millimetres of a line drawn on the picture.
    Ruler,
    /// Threads to a centimetre, with the thread grid that is found.
    Threads,
}

/// Which height of a relief is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) enum Known {
    /// From the lowest to the highest point.
    #[default]
    Relief,
    /// What the surface tester reads.
    Smd,
}

/// Everything that the stages depend on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Draft {
    /// The picture.
    pub source: Option<SourceFile>,
    /// Further pictures of the cloth, turned.
    #[serde(default)]
    pub turned: Vec<SourceFile>,
    /// The part of it.
    pub part: Part,
    /// How far a region is turned, degrees clockwise.
    #[serde(default)]
    pub(crate) turn_deg: f64,
    /// Whether uneven light is divided out where it matters.
    pub(crate) is_evened: bool,
    /// The scale as typed.
    pub scale: String,
    /// In what.
    pub unit: ScaleUnit,
    /// The ends of the ruler, px of the whole picture; `None` until it is drawn.
    #[serde(default)]
    pub ruler: Option<[[f64; 2]; 2]>,
    /// λ of the mean concentration, 1/px; `None`: from the maxima.
    pub lambda: Option<f64>,
    /// The lattice's vectors if they were drawn or chosen, px; `None`: those that are found.
    #[serde(default)]
    pub lattice: Option<[[f64; 2]; 2]>,
    /// Whether the light is estimated.
    pub(crate) is_light_estimated: bool,
    /// The light if it is not.
    pub light: Light,
    /// What heights are found on and felt.
    #[serde(default)]
    pub relief_of: ReliefOf,
    /// How heights are found; `None`: by what the picture speaks for.
    pub method: Option<Method>,
    /// The height as typed, µm.
    pub height: String,
    /// Of what.
    pub known: Known,
    /// How it is felt.
    pub representation: Representation,
    /// The name as typed.
    pub name: String,
}

impl Default for Draft {
    fn default() -> Self {
        Self {
            source: None,
            turned: Vec::new(),
            part: Part::Whole,
            turn_deg: 0.0,
            is_evened: true,
            scale: String::new(),
            unit: ScaleUnit::Dpi,
            ruler: None,
            lambda: None,
            lattice: None,
            is_light_estimated: false,
            // A scanner's lamp shines along the way of its carriage.
            light: Light {
                slant_deg: 45.0,
                tilt_deg: 90.0,
            },
            relief_of: ReliefOf::Picture,
            method: None,
            height: String::new(),
            known: Known::Relief,
            representation: Representation::Economical,
            name: String::new(),
        }
    }
}

fn number(typed: &str) -> Option<f64> {
    let typed = typed.trim().replace(',', ".");
    typed
        .parse()
        .ok()
        .filter(|x: &f64| x.is_finite() && *x > 0.0)
}

impl Draft {
    /// What is known of the scale; `None` while it is no positive number.
    pub(crate) fn picture_scale(&self) -> Option<PictureScale> {
        if self.unit == ScaleUnit::Threads {
            let counts: Option<Vec<f64>> = self.scale.split_whitespace().map(number).collect();
            return match counts?[..] {
                [both] => Some(PictureScale::ThreadsPerCm([both; 2])),
                [warp, weft] => Some(PictureScale::ThreadsPerCm([warp, weft])),
                _ => None,
            };
        }
        let typed = number(&self.scale)?;
        match self.unit {
            ScaleUnit::Dpi => Some(PictureScale::Dpi(typed)),
            ScaleUnit::PxPerMm => Some(PictureScale::PxPerMm(typed)),
            ScaleUnit::Ruler => {
                let [[x0, y0], [x1, y1]] = self.ruler.filter(|_| !self.is_slanted())?;
                let is_line = (x1 - x0).hypot(y1 - y0) >= 1.0;
                is_line.then_some(PictureScale::Ruler([x0, y0, x1, y1, typed]))
            }
            ScaleUnit::Threads => None,
        }
    }

    /// Whether it is seen at a slant, so that no ruler holds for all of it.
    fn is_slanted(&self) -> bool {
        matches!(self.part, Part::Corners(_))
    }

    /// How far the part that is looked at is turned against the photograph, degrees clockwise.
    fn turned_by_deg(&self) -> f64 {
        match self.part {
            Part::Region(_) => self.turn_deg,
            Part::Whole | Part::Corners(_) => 0.0,
        }
    }

    /// The light on the part that is looked at.
    pub(crate) fn light_on_part(&self) -> Light {
        self.light.turned(self.turned_by_deg())
    }

    /// The light on the photograph: as it is told, or as it was estimated on the part.
    pub(crate) fn light_shown(&self, shaped: Option<&Relief>) -> Light {
        let estimated = shaped.filter(|_| self.is_light_estimated);
        estimated.map_or(self.light, |relief| {
            relief.light.turned(-self.turned_by_deg())
        })
    }

    /// The scale, px/mm, as far as it needs no threads, or with those of this lattice.
    pub(crate) fn px_per_mm(&self, lattice: Option<&Lattice>) -> Option<f64> {
        self.picture_scale()?.px_per_mm(lattice).ok()
    }

    /// What is known of the height; `None` while it is no positive number.
    pub(crate) fn height_scale(&self) -> Option<HeightScale> {
        let um = number(&self.height)?;
        Some(match self.known {
            Known::Relief => HeightScale::ReliefUm(um),
            Known::Smd => HeightScale::SmdUm(um),
        })
    }

    /// The name that the file suggests.
    pub(crate) fn own_name(&self) -> String {
        let stem = self
            .source
            .as_ref()
            .and_then(|file| file.path().file_stem());
        stem.unwrap_or_default().to_string_lossy().into_owned()
    }

    /// The name that the textile gets.
    pub(crate) fn final_name(&self) -> String {
        if self.name.trim().is_empty() {
            self.own_name()
        } else {
            self.name.trim().to_owned()
        }
    }

    /// The id that it is wished to have; never empty.
    pub(crate) fn id(&self) -> String {
        let id = id_of(&self.final_name());
        if id.is_empty() {
            "picture".to_owned()
        } else {
            id
        }
    }

    /// What is still to be said before there can be a textile.
    pub(crate) fn missing(&self) -> Option<&'static str> {
        if self.picture_scale().is_none() {
            return Some(match self.unit {
                ScaleUnit::Dpi | ScaleUnit::PxPerMm => {
                    "Type the picture's scale: what the scanner was set to, dpi"
                }
                ScaleUnit::Ruler if self.is_slanted() => {
                    "A ruler does not hold at a slant: type dpi or px/mm of what the corners span"
                }
                ScaleUnit::Ruler => "Drag the ruler on the picture and type its length, mm",
                ScaleUnit::Threads => "Type threads to a centimetre, warp and weft: 24 20",
            });
        }
        if self.height_scale().is_none() {
            return Some("Type how high the cloth's relief is, µm, or its SMD");
        }
        None
    }

    /// Whether the pictures before any analysis are the same.
    pub(crate) fn has_same_file(&self, other: &Self) -> bool {
        self.source == other.source
    }

    /// Whether the autocorrelations are the same.
    pub(crate) fn has_same_part(&self, other: &Self) -> bool {
        let part = |draft: &Self| (draft.part, draft.turned_by_deg(), draft.is_evened);
        self.has_same_file(other) && part(self) == part(other)
    }

    /// Whether the same further pictures are laid over the same picture.
    pub(crate) fn has_same_turned(&self, other: &Self) -> bool {
        self.has_same_part(other) && self.turned == other.turned
    }

    /// Whether the tiles are the same.
    pub(crate) fn has_same_tile(&self, other: &Self) -> bool {
        self.has_same_part(other) && (self.lambda, self.lattice) == (other.lambda, other.lattice)
    }

    fn is_cell(&self) -> bool {
        self.relief_of == ReliefOf::Cell
    }

    /// Whether the heights in pixels are the same.
    pub(crate) fn has_same_shape(&self, other: &Self) -> bool {
        let light = |draft: &Self| (!draft.is_light_estimated).then_some(draft.light);
        self.has_same_tile(other)
            && self.turned == other.turned
            && (!self.is_cell() || self.picture_scale() == other.picture_scale())
            && self.is_light_estimated == other.is_light_estimated
            && light(self) == light(other)
            && (self.is_cell(), self.method) == (other.is_cell(), other.method)
    }

    /// Whether the textiles are the same.
    pub(crate) fn has_same_textile(&self, other: &Self) -> bool {
        self.has_same_shape(other)
            && self.picture_scale() == other.picture_scale()
            && self.height_scale() == other.height_scale()
            && (self.relief_of, self.representation) == (other.relief_of, other.representation)
            && self.final_name() == other.final_name()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scale_is_read_in_either_unit_and_never_guessed() {
        let mut draft = Draft::default();
        assert_eq!(draft.px_per_mm(None), None);
        draft.scale = "600".to_owned();
        let px_per_mm = draft.px_per_mm(None).unwrap();
        assert!((px_per_mm - 23.622).abs() < 1e-3, "{px_per_mm}");
        draft.unit = ScaleUnit::PxPerMm;
        draft.scale = " 23,5".to_owned();
        assert_eq!(draft.px_per_mm(None), Some(23.5));
        draft.scale = "-3".to_owned();
        assert_eq!(draft.px_per_mm(None), None);
    }

    #[test]
    fn threads_and_a_ruler_are_scales_too() {
        let mut draft = Draft {
            unit: ScaleUnit::Threads,
            scale: "24 20,5".to_owned(),
            ..Draft::default()
        };
        let counted = Some(PictureScale::ThreadsPerCm([24.0, 20.5]));
        assert_eq!(draft.picture_scale(), counted);
        assert_eq!(draft.px_per_mm(None), None, "none before they are found");
        draft.scale = "1 2 3".to_owned();
        assert_eq!(draft.picture_scale(), None);
        draft.unit = ScaleUnit::Ruler;
        draft.scale = "10".to_owned();
        assert_eq!(draft.picture_scale(), None, "not drawn yet");
        draft.ruler = Some([[0.0, 5.0], [200.0, 5.0]]);
        assert_eq!(draft.px_per_mm(None), Some(20.0));
        draft.part = Part::Corners([[0.0; 2]; 4]);
        assert!(draft.missing().unwrap().contains("slant"), "at a slant");
    }

    #[test]
    fn what_is_typed_touches_only_the_stages_behind_it() {
        let draft = Draft::default();
        let higher = Draft {
            height: "80".to_owned(),
            ..draft.clone()
        };
        assert!(higher.has_same_shape(&draft) && !higher.has_same_textile(&draft));
        let linear = Draft {
            method: Some(Method::Linear),
            ..draft.clone()
        };
        assert!(linear.has_same_tile(&draft) && !linear.has_same_shape(&draft));
        let part = Draft {
            part: Part::Region([1, 2, 30, 40]),
            ..draft.clone()
        };
        assert!(part.has_same_file(&draft) && !part.has_same_part(&draft));
    }

    #[test]
    fn the_light_turns_with_a_region() {
        let draft = Draft {
            part: Part::Region([1, 2, 30, 40]),
            turn_deg: 20.0,
            ..Draft::default()
        };
        assert!((draft.light_on_part().tilt_deg - 110.0).abs() < 1e-9);
        let whole = Draft {
            part: Part::Whole,
            ..draft.clone()
        };
        assert!((whole.light_on_part().tilt_deg - 90.0).abs() < 1e-9);
        assert!(!whole.has_same_part(&draft));
    }
}
