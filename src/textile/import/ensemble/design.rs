//! The reliefs that are tried: which model, under which light, how smooth.

use serde::{Deserialize, Serialize};

use super::super::picture::PictureTextile;
use crate::error::TextileError;
use crate::picture::brightness::Brightness;
use crate::picture::shading::{Light, Method, ShadingOptions, Shape};
use selvedge_foundation::progress::Progress;

/// Reliefs of shading, and of dark is deep.
pub(super) const N_SHADED: usize = 16;
pub(super) const N_DEEP: usize = 4;
/// Slants that an unknown light is drawn from, degrees: a scanner's lamp, a lamp on a table.
const SLANTS_DEG: [f64; 2] = [25.0, 65.0];
/// Weights of curvature of the variational method, powers of ten; powers of brightness by which
/// depth follows it, powers of two.
const LOG_SMOOTHNESS: [f64; 2] = [-4.0, -2.0];
const LOG_POWER: [f64; 2] = [-1.0, 1.0];

/// What is known of the lamp over a picture.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Lamp {
    /// Where it stood, and within how many degrees that is right.
    Known {
        /// On the picture, y up.
        light: Light,
        /// Half of the interval that tilt and slant are drawn from, degrees.
        within_deg: f64,
    },
    /// Nothing.
    Unknown,
    /// What pictures of the cloth turned under it say.
    Turned {
        /// On the first picture, y up.
        tilt_deg: f64,
        /// Half of the interval that it is drawn from, degrees.
        within_deg: f64,
    },
}

impl Lamp {
    /// Within so many degrees a lamp stands where people say, unless they say otherwise. Of 5°
    /// bands are too narrow where a lamp is told wrong by 15°; 20° widen those of one that is told
    /// right by 0.6 dB.
    pub const WITHIN_DEG: f64 = 10.0;

    /// The light at a place of the unit square.
    fn at(self, [a, b]: [f64; 2]) -> Light {
        let along = |[low, high]: [f64; 2], share: f64| low + (high - low) * share;
        match self {
            Self::Known { light, within_deg } => Light {
                slant_deg: (light.slant_deg + along([-within_deg, within_deg], b)).clamp(5.0, 80.0),
                tilt_deg: light.tilt_deg + along([-within_deg, within_deg], a),
            },
            Self::Unknown => Light {
                slant_deg: along(SLANTS_DEG, b),
                tilt_deg: along([-180.0, 180.0], a),
            },
            Self::Turned {
                tilt_deg,
                within_deg,
            } => Light {
                slant_deg: along(SLANTS_DEG, b),
                tilt_deg: tilt_deg + along([-within_deg, within_deg], a),
            },
        }
    }
}

/// A relief that was tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Member {
    /// The model.
    pub(super) method: Method,
    /// The light on the picture, of shading.
    pub(super) light: Light,
    /// What the method is tuned by: see [`ShadingOptions::regulariser`].
    pub(super) regulariser: f64,
    /// Its share of the belief; all sum to 1.
    pub(super) weight: f64,
    /// Levels of warp and weft by band, dB re 1 µm, at the standard stroke.
    pub(super) levels_db: [[f64; 2]; 2],
}

/// The design: members with even weights.
pub(super) fn drawn(lamp: Lamp) -> Vec<Member> {
    // Powers of the inverse of the root of x⁴ = x + 1: three numbers that fill a cube evenly.
    let root = 1.220_744_084_605_759_5_f64;
    let place = |i: usize| [1, 2, 3].map(|power| (0.5 + (i + 1) as f64 / root.powi(power)).fract());
    let along = |[low, high]: [f64; 2], share: f64| low + (high - low) * share;
    let member = |method, light, regulariser| Member {
        method,
        light,
        regulariser,
        weight: 0.0,
        levels_db: [[0.0; 2]; 2],
    };
    let shaded = (0..N_SHADED).map(|i| {
        let [a, b, c] = place(i);
        member(
            Method::Variational,
            lamp.at([a, b]),
            10.0_f64.powf(along(LOG_SMOOTHNESS, c)),
        )
    });
    let deep = (0..N_DEEP).map(|i| {
        let share = (i as f64 + 0.5) / N_DEEP as f64;
        member(
            Method::DarkIsDeep,
            lamp.at([0.5; 2]),
            2.0_f64.powf(along(LOG_POWER, share)),
        )
    });
    shaded.chain(deep).collect()
}

impl Member {
    /// Whether its model is shading; the other is dark is deep.
    pub(super) fn is_shaded(&self) -> bool {
        self.method != Method::DarkIsDeep
    }

    /// Levels, the share of the picture that it does not explain, and its relief.
    pub(super) fn tried(
        &self,
        brightness: &Brightness,
        about: &PictureTextile,
    ) -> Result<([[f64; 2]; 2], f64, Shape), TextileError> {
        let options = ShadingOptions {
            method: self.method,
            regulariser: Some(self.regulariser),
            ..ShadingOptions::default()
        };
        let shape = Progress::unheard(|p| brightness.shape(self.light, &options, p))?;
        let unexplained = shape.unexplained(&brightness.views(self.light));
        Ok((about.levels_db(&shape)?, unexplained, shape))
    }
}
