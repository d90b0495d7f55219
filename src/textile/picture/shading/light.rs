//! Where light comes from: given, or estimated from the picture itself.

use serde::{Deserialize, Serialize};

use super::error::ShadingError;
use super::shape::mean;
use selvedge_foundation::numerics::Grid;

use super::reflectance::{across, along};

/// Lights from less than this slant show no direction, degrees.
const FRONTAL_DEG: f64 = 2.0;
/// Lights from more than this graze, degrees.
const GRAZING_DEG: f64 = 85.0;

/// The direction that light comes from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Light {
    /// From straight above (0°) to grazing, degrees.
    pub slant_deg: f64,
    /// Towards the light, counter-clockwise from +x (to the right) with **y up**, degrees: 90° is
    /// light from the top of the picture, though its rows count downwards.
    pub tilt_deg: f64,
}

impl Light {
    /// `[cos tilt, sin tilt]·tan slant`: how far the light leans, y up.
    pub(crate) fn lean(self) -> [f64; 2] {
        let (sin, cos) = self.tilt_deg.to_radians().sin_cos();
        let tan = self.slant_deg.to_radians().tan();
        [cos * tan, sin * tan]
    }

    /// With its tilt grown by so much, −180° (not included) to 180°.
    #[must_use]
    pub fn turned(self, by_deg: f64) -> Self {
        let tilt_deg = (self.tilt_deg + by_deg).rem_euclid(360.0);
        let tilt_deg = if tilt_deg > 180.0 {
            tilt_deg - 360.0
        } else {
            tilt_deg
        };
        Self { tilt_deg, ..self }
    }

    pub(super) fn is_frontal(self) -> bool {
        self.slant_deg < FRONTAL_DEG
    }

    /// Refuses a light that is none, or that grazes.
    ///
    /// # Errors
    /// With key, value and range.
    pub fn check(self) -> Result<(), ShadingError> {
        if !(0.0..=GRAZING_DEG).contains(&self.slant_deg) {
            return Err(ShadingError::Light {
                key: "slant",
                value: self.slant_deg,
                range: "0 to 85, 30 to 60 if you can: nearer 90 everything lies in shadow",
            });
        }
        if !(-360.0..=360.0).contains(&self.tilt_deg) {
            return Err(ShadingError::Light {
                key: "tilt",
                value: self.tilt_deg,
                range: "-360 to 360",
            });
        }
        Ok(())
    }
}

/// Brightness 0…1, and the light that it was taken under; row 0 is the lowest y.
pub(crate) type View<'a> = (&'a Grid<f64>, Light);

/// A light found on a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct LightEstimate {
    /// The light. The same picture is that of the surface turned inside out under light from the
    /// other side (tilt + 180°).
    pub light: Light,
    /// The albedo.
    pub albedo: f64,
    /// How much the gradients of brightness agree on the tilt: 0 not at all, 1 wholly. A tile
    /// that repeats is near 0.
    pub(crate) tilt_agreement: f64,
    /// How much more the brightness changes along the tilt than across it: 0 no more, 1 along it
    /// alone. An even surface gives 0.5; a weave has directions of its own and misleads it.
    pub(crate) axis_coherence: f64,
    /// How sure all this is, in a sentence or two.
    pub words: String,
}

/// Slants that an estimate is believed in, degrees; what is taken instead, as flatbed scanners
/// have it.
const BELIEVED_DEG: std::ops::RangeInclusive<f64> = 20.0..=70.0;
const ASSUMED_DEG: f64 = 45.0;

/// Gradients that agree less than this tell no side.
const AGREE: f64 = 0.1;

impl LightEstimate {
    /// Estimates light and albedo of a picture (after Zheng & Chellappa 1991).
    ///
    /// It takes normals to lie as on a ball and the albedo to be even: no cloth does. Slant and
    /// albedo follow from mean and mean square of the brightness; the tilt from the mean direction
    /// of its gradient, or where that says nothing, from the axis along which it changes most.
    ///
    /// # Errors
    /// An empty or black tile.
    pub fn of(brightness: &Grid<f64>) -> Result<Self, ShadingError> {
        if brightness.values().is_empty() {
            return Err(ShadingError::Empty);
        }
        let level = mean(brightness);
        if level.is_nan() || level < 1e-9 {
            return Err(ShadingError::Black);
        }
        let n = brightness.values().len() as f64;
        let square = brightness.values().iter().map(|e| e * e).sum::<f64>() / n;
        let pi = std::f64::consts::PI;
        let albedo = (6.0 * pi * pi * square - 48.0 * level * level)
            .max(0.0)
            .sqrt()
            / pi;
        let cos_slant = 4.0 * level / (pi * albedo);
        let is_slant_known = cos_slant.is_finite() && cos_slant < 1.0;
        let slant_deg = if is_slant_known {
            cos_slant.acos().to_degrees()
        } else {
            0.0
        };
        let gradients = Gradients::of(brightness);
        let [agreement, mean_deg] = gradients.mean_direction();
        let [coherence, axis_deg] = gradients.axis();
        let is_sided = agreement >= AGREE;
        let tilt_deg = if is_sided { mean_deg } else { axis_deg };
        let words = [
            slant_words(is_slant_known),
            tilt_words(is_sided, coherence),
            "Light from the other side (tilt + 180°) shows the same picture of the surface turned \
             inside out.",
        ];
        Ok(Self {
            light: Light {
                slant_deg: slant_deg.min(GRAZING_DEG),
                tilt_deg,
            },
            albedo,
            tilt_agreement: agreement,
            axis_coherence: coherence,
            words: words.join(" "),
        })
    }
}

impl LightEstimate {
    /// The estimate with another slant where its own cannot be.
    #[must_use]
    pub fn believed(mut self) -> Self {
        if !BELIEVED_DEG.contains(&self.light.slant_deg) {
            self.light.slant_deg = ASSUMED_DEG;
            let words = format!(
                "{} {ASSUMED_DEG}° is taken instead, as in a flatbed scanner.",
                self.words
            );
            self.words = words;
        }
        self
    }
}

fn slant_words(is_known: bool) -> &'static str {
    if is_known {
        "The slant holds for a surface whose normals lie as on a ball; a cloth's do not, so take \
         it as a guess and give the slant if you know it."
    } else {
        "The slant is not to be had from this picture: it has too little contrast for a ball in \
         any light. Give it."
    }
}

fn tilt_words(is_sided: bool, coherence: f64) -> &'static str {
    match (is_sided, coherence >= 0.2) {
        (true, _) => "The gradients agree on a tilt.",
        (false, true) => {
            "The gradients tell the tilt's axis, not its side, and yarns that run one way look \
             like it."
        }
        (false, false) => "The gradients tell next to nothing of the tilt. Give it.",
    }
}

/// Gradients of brightness, y up.
struct Gradients(Vec<[f64; 2]>);

impl Gradients {
    fn of(brightness: &Grid<f64>) -> Self {
        let (x, y) = (along(brightness), across(brightness));
        let pairs = x.values().iter().zip(y.values());
        Self(pairs.map(|(x, y)| [*x, *y]).collect())
    }

    /// Length and direction (degrees) of the mean of the unit gradients.
    fn mean_direction(&self) -> [f64; 2] {
        let (mut sum, mut n) = ([0.0; 2], 0.0);
        for [x, y] in &self.0 {
            let length = x.hypot(*y);
            if length > 1e-12 {
                sum = [sum[0] + x / length, sum[1] + y / length];
                n += 1.0;
            }
        }
        let length = sum[0].hypot(sum[1]) / f64::max(n, 1.0);
        [length, sum[1].atan2(sum[0]).to_degrees()]
    }

    /// Coherence and direction (degrees, −90 to 90) of the axis of most change.
    fn axis(&self) -> [f64; 2] {
        let [xx, yy, xy] = self.0.iter().fold([0.0; 3], |[xx, yy, xy], [x, y]| {
            [xx + x * x, yy + y * y, xy + x * y]
        });
        let sum: f64 = xx + yy;
        let coherence = if sum > 1e-24 {
            (xx - yy).hypot(2.0 * xy) / sum
        } else {
            0.0
        };
        [coherence, (0.5 * (2.0 * xy).atan2(xx - yy)).to_degrees()]
    }
}
