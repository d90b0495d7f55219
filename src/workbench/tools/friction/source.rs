//! Where a picture comes from, and the friction that networks predict of it, on a thread.

use std::sync::Arc;

use eframe::egui::{Color32, ColorImage};

use crate::bench::command::friction::PictureAtHand;
use crate::bench::latest::Computed;
use crate::bench::source_file::SourceFile;
use selvedge_foundation::numerics::{Grid, at_place, to_byte, to_index, to_single};
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_friction::{PredictedFriction, Predictor};
use selvedge_textile::Textile;
use selvedge_textile::picture::Picture;

/// A textile's own picture is repeated to such a length and height, mm.
const REPEATED_MM: [f64; 2] = [100.0, 20.0];

/// A picture of cloth.
#[derive(Debug, Clone)]
pub(crate) enum Source {
    /// A file.
    File(SourceFile),
    /// What another tool had at hand.
    AtHand(PictureAtHand),
    /// How a textile of the scene looks.
    Textile(Arc<Textile>),
}

impl PartialEq for Source {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::File(a), Self::File(b)) => a == b,
            (Self::AtHand(a), Self::AtHand(b)) => a == b,
            (Self::Textile(a), Self::Textile(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }
}

impl Source {
    /// What people call it.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::File(file) => file.name(),
            Self::AtHand(picture) => picture.name.clone(),
            Self::Textile(textile) => textile.manifest().name.clone(),
        }
    }

    /// Brightness 0 to 1; why there is none, in one line.
    fn brightness(&self, px_per_mm: f64) -> Result<Arc<Grid<f32>>, String> {
        match self {
            Self::File(file) => {
                let picture = Picture::load(file.bytes()?, file.file_name());
                let picture = picture.map_err(|error| error.to_string())?;
                Ok(Arc::new(picture.luminance.map(to_single)))
            }
            Self::AtHand(picture) => Ok(Arc::clone(&picture.brightness)),
            Self::Textile(textile) => {
                let appearance = textile.appearance().map_err(|error| error.to_string())?;
                let image = appearance.map(|appearance| appearance.image);
                let Some(image) = image.filter(|image| !image.pixels.is_empty()) else {
                    return Err("It has no picture of its own; open a picture of it".to_owned());
                };
                let [width, height] = REPEATED_MM.map(|mm| to_index((mm * px_per_mm).ceil()));
                Ok(Arc::new(Grid::from_fn(width, height, |x, y| {
                    let at = y % image.height * image.width + x % image.width;
                    let [r, g, b] = image.pixels[at].map(f32::from);
                    (0.2126 * r + 0.7152 * g + 0.0722 * b) / 255.0
                })))
            }
        }
    }
}

/// A picture of a scale.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Asked {
    pub(crate) source: Source,
    pub(crate) px_per_mm: f64,
}

/// Friction along the strip in the middle of a picture.
#[derive(Debug)]
pub(crate) struct Trace {
    /// The strip.
    pub(crate) strip: Arc<ColorImage>,
    pub(crate) predicted: PredictedFriction,
}

impl Trace {
    /// Length of the strip, mm.
    pub(crate) fn length_mm(&self) -> f64 {
        self.predicted.mu.len() as f64 / PredictedFriction::PER_MM
    }

    /// Where on the strip a finger at an x of the workspace is, mm: the strip begins at its left
    /// edge and is repeated to and fro, so that nothing jumps where it ends.
    pub(crate) fn place_mm(&self, x_mm: f64) -> f64 {
        let length = self.length_mm();
        let way = x_mm.rem_euclid(2.0 * length);
        way.min(2.0 * length - way)
    }

    /// The coefficient of friction at a place of the strip, mm.
    pub(crate) fn mu(&self, place_mm: f64) -> f64 {
        at_place(&self.predicted.mu, place_mm * PredictedFriction::PER_MM)
    }
}

/// What came of a picture. The networks stay for the next.
#[derive(Debug)]
pub(crate) struct Found {
    predictor: Option<Arc<Predictor>>,
    /// Why there is none, in one line.
    pub(crate) trace: Result<Arc<Trace>, String>,
}

impl Computed<Asked> for Found {
    const THREAD: &str = "selvedge-friction";

    fn compute(
        asked: &Asked,
        prior: Option<(&Asked, &Self)>,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        progress.step(0.0, "reading the picture")?;
        let brightness = asked.source.brightness(asked.px_per_mm);
        progress.step(0.2, "cutting the strip")?;
        let strip = brightness.and_then(|picture| {
            Predictor::strip(&picture, asked.px_per_mm).map_err(|error| error.to_string())
        });
        progress.step(0.4, "reading the networks")?;
        let known = prior.and_then(|(_, found)| found.predictor.clone());
        let strip = match strip {
            Ok(strip) => strip,
            Err(why) => return Ok(Self::failed(known, why)),
        };
        let predictor = match known.map_or_else(|| Predictor::shipped().map(Arc::new), Ok) {
            Ok(predictor) => predictor,
            Err(error) => return Ok(Self::failed(None, error.to_string())),
        };
        progress.step(0.5, "asking them")?;
        let predicted = predictor.of_picture(&strip, PredictedFriction::PER_MM);
        progress.step(1.0, "done")?;
        let trace = predicted.map_err(|error| error.to_string());
        Ok(Self {
            predictor: Some(predictor),
            trace: trace.map(|predicted| {
                Arc::new(Trace {
                    strip: Arc::new(grey(&strip)),
                    predicted,
                })
            }),
        })
    }

    fn broken(_: &Asked, why: &str) -> Self {
        Self::failed(None, format!("nothing was predicted: {why}"))
    }

    fn serves(under_way: &Asked, now: &Asked) -> bool {
        under_way == now
    }
}

impl Found {
    fn failed(predictor: Option<Arc<Predictor>>, why: String) -> Self {
        Self {
            predictor,
            trace: Err(why),
        }
    }
}

fn grey(strip: &Grid<f32>) -> ColorImage {
    let pixel = |value: &f32| Color32::from_gray(to_byte(255.0 * f64::from(*value)));
    let pixels = strip.values().iter().map(pixel).collect();
    ColorImage::new([strip.width(), strip.height()], pixels)
}
