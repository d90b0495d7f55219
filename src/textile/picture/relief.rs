//! Heights of a picture's cell: found, described and drawn.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::brightness::{Brightness, Extent};
use super::shading::{Light, LightEstimate, ShadingError, ShadingOptions, Shape};
use selvedge_foundation::files::{FileError, GrayImage};
use selvedge_foundation::progress::Progress;

/// What heights are found on, and what becomes of what varies from cell to cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ReliefOf {
    /// The picture as it is, over and over.
    #[default]
    Picture,
    /// The picture as it is; of that, cloth without a visible repetition.
    Synthesized,
    /// The mean cell, over and over: nothing varies.
    Cell,
}

/// Heights found on a picture, with where they come from.
#[derive(Debug, Clone)]
pub struct Relief {
    /// The brightness that they were found of.
    pub brightness: Brightness,
    /// The heights.
    pub shape: Shape,
    /// The light on the picture, y up.
    pub light: Light,
    /// How it was estimated, if it was not given.
    pub estimate: Option<LightEstimate>,
}

/// An object of a file, key by key in their order.
macro_rules! object {
    ($($key:ident: $value:expr,)+) => {{
        #[expect(non_camel_case_types, reason = "the type of every key is called like the key")]
        fn object<$($key: serde::Serialize),+>(($($key,)+): ($($key,)+)) -> impl serde::Serialize {
            #[derive(serde::Serialize)]
            struct Object<$($key),+> {
                $($key: $key,)+
            }

            Object { $($key,)+ }
        }

        object(($($value,)+))
    }};
}
pub(super) use object;

/// How high a relief is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
struct Span {
    /// From the lowest to the highest height.
    relief: f64,
    /// Root of the mean square about the mean.
    rms: f64,
}

impl Relief {
    /// Finds the heights of a brightness under a light, or under the light that it suggests.
    ///
    /// # Errors
    /// See `shading`.
    pub fn of(
        brightness: Brightness,
        light: Option<Light>,
        options: &ShadingOptions,
        progress: &mut Progress<'_>,
    ) -> Result<Self, ShadingError> {
        let estimate = match light {
            Some(_) => None,
            None => Some(brightness.estimated_light()?.believed()),
        };
        let light = light.or_else(|| estimate.as_ref().map(|e| e.light));
        let light = light.ok_or(ShadingError::Empty)?;
        let shape = brightness.shape(light, options, progress)?;
        Ok(Self {
            brightness,
            shape,
            light,
            estimate,
        })
    }

    /// From the lowest to the highest height, widths of a sample.
    pub fn relief_px(&self) -> f64 {
        let [low, high] = self.shape.range_px();
        high - low
    }

    /// What files say of it: angles in degrees, the light on the picture from +x with y up, the
    /// rows clockwise from +x; heights in widths of a sample and, if `relief_um`, from lowest to
    /// highest, is known, in µm. Residuals are means of |E/a − R|.
    pub(crate) fn report(&self, relief_um: Option<f64>) -> impl Serialize {
        let shape = &self.shape;
        let heights = &shape.height_px;
        let n = heights.values().len().max(1) as f64;
        let height_px = Span {
            relief: self.relief_px(),
            rms: (heights.values().iter().map(|z| z * z).sum::<f64>() / n).sqrt(),
        };
        let (shear_deg, seam_px) = match self.brightness.extent {
            Extent::Repeat { shear_rad } => (Some(shear_rad.to_degrees()), None),
            Extent::Patch { seam_px } => (None, Some(seam_px)),
        };
        let estimate = self.estimate.as_ref();
        let residual = |at: usize| shape.residuals.get(at).copied().unwrap_or(0.0);
        object! {
            method: shape.method.word(),
            iterations: shape.n_iterations(),
            rounds: shape.n_rounds,
            light_deg: [self.light.slant_deg, self.light.tilt_deg],
            light_estimated: estimate.is_some(),
            light_words: estimate.map(|e| &e.words),
            tilt_agreement: estimate.map(|e| e.tilt_agreement),
            axis_coherence: estimate.map(|e| e.axis_coherence),
            albedo: shape.albedo,
            residual_of_level: residual(0),
            residual: residual(shape.n_iterations()),
            reliability: &shape.reliability,
            samples: [heights.width(), heights.height()],
            size_px: self.brightness.size_px,
            angle_deg: self.brightness.angle_rad.to_degrees(),
            shear_deg: shear_deg,
            seam_px: seam_px,
            height_px: height_px,
            height_um: relief_um.filter(|_| height_px.relief > 0.0).map(|um| Span {
                relief: um,
                rms: height_px.rms * um / height_px.relief,
            }),
        }
    }

    /// The heights as a grey picture of 16 bits with the keys of Gwyddion, rows from the top.
    ///
    /// Metres where they are known; what has no scale says `px`: extents in pixels of the picture,
    /// heights in widths of a sample.
    ///
    /// # Errors
    /// More samples than the format holds.
    pub fn picture(
        &self,
        px_per_mm: Option<f64>,
        relief_um: Option<f64>,
    ) -> Result<Vec<u8>, FileError> {
        let heights = &self.shape.height_px;
        let [low, high] = self.shape.range_px();
        let span = if high > low { high - low } else { 1.0 };
        let rows = (0..heights.height()).rev();
        let shares = rows.flat_map(|row| heights.row(row).iter().map(|z| (z - low) / span));
        let (height, height_unit) = relief_um.map_or((1.0, "px"), |um| (um * 1e-6 / span, "m"));
        let (length, length_unit) = px_per_mm.map_or((1.0, "px"), |n| (1e-3 / n, "m"));
        let size = self.brightness.size_px;
        let texts = [
            ("ZMin", (low * height).to_string()),
            ("ZMax", (high * height).to_string()),
            ("XReal", (size[0] * length).to_string()),
            ("YReal", (size[1] * length).to_string()),
            ("XYUnit", length_unit.to_owned()),
            ("ZUnit", height_unit.to_owned()),
        ];
        let texts = texts.map(|(key, text)| (format!("Gwy::{key}"), text));
        let picture = GrayImage {
            texts: texts.to_vec(),
            ..GrayImage::of_shares([heights.width(), heights.height()], shares)
        };
        picture.to_png(Path::new("height.png"))
    }
}
