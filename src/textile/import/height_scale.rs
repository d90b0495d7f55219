//! From heights in pixels to heights in µm.

use crate::error::TextileError;
use crate::picture::shading::{ShadingError, Shape};
use crate::surface::{HeightMap, ProfileSet, SurfaceError};

/// What is known of the height of a relief.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum HeightScale {
    /// Nothing: heights stay in pixels, and no textile can be made of them.
    #[default]
    Unscaled,
    /// From the lowest to the highest height, µm.
    ReliefUm(f64),
    /// The roughness SMD that the surface tester reads, mean of the four strokes, µm.
    SmdUm(f64),
}

/// Rounds that bring a wire's reading to the SMD asked for.
const N_ROUNDS: usize = 24;
/// How near it must come, share of it.
const NEAR: f64 = 1e-3;
/// The highest relief that is made, µm.
const MAX_RELIEF_UM: f64 = 1e5;

/// A relief in µm, and how its height was found.
#[derive(Debug)]
pub struct ScaledRelief {
    /// The relief of one repeat.
    pub map: HeightMap,
    /// From its lowest to its highest height.
    pub(crate) relief_um: f64,
    /// The SMD that was asked for.
    pub(crate) smd_um: Option<f64>,
}

impl ScaledRelief {
    /// Gives a shape its heights; `strokes` draws the tester over a map of so much relief, µm.
    pub fn of(
        shape: &Shape,
        step_mm: [f64; 2],
        scale: HeightScale,
        strokes: &impl Fn(&HeightMap, f64) -> Result<ProfileSet, TextileError>,
    ) -> Result<Self, TextileError> {
        if shape.is_flat() {
            return Err(ShadingError::Flat.into());
        }
        let [low, high] = shape.range_px();
        let of = |relief_um: f64| -> Result<HeightMap, TextileError> {
            let factor = relief_um / (high - low);
            let map = HeightMap::new(shape.height_px.map(|height| height * factor), step_mm);
            Ok(map.map_err(no_surface)?.periodic())
        };
        let (relief_um, smd_um) = match scale {
            HeightScale::Unscaled => return Err(ShadingError::Unscaled.into()),
            HeightScale::ReliefUm(relief_um) => (checked("the relief", relief_um)?, None),
            HeightScale::SmdUm(smd_um) => {
                let wanted = checked("the SMD", smd_um)?;
                let of_relief = |relief_um: f64| {
                    let strokes = strokes(&of(relief_um)?, relief_um)?;
                    Ok(crate::surface::smd_um(&strokes))
                };
                (relief_for(wanted, of_relief)?, Some(wanted))
            }
        };
        Ok(Self {
            map: of(relief_um)?,
            relief_um,
            smd_um,
        })
    }
}

fn checked(key: &'static str, um: f64) -> Result<f64, ShadingError> {
    if (1e-6..=MAX_RELIEF_UM).contains(&um) {
        return Ok(um);
    }
    Err(ShadingError::Option {
        key,
        value: um,
        range: "0.000001 to 100000 µm",
    })
}

/// The relief at which the tester reads an SMD: more relief reads rougher, though not in
/// proportion, as its wire bridges steep valleys. Proportion first, then halving between.
fn relief_for(
    smd_um: f64,
    smd_of: impl Fn(f64) -> Result<f64, TextileError>,
) -> Result<f64, TextileError> {
    let [mut low, mut high] = [0.0, MAX_RELIEF_UM];
    let mut relief_um = (4.0 * smd_um).min(MAX_RELIEF_UM);
    let mut found = f64::NAN;
    for round in 0..N_ROUNDS {
        found = smd_of(relief_um)?;
        if (found / smd_um - 1.0).abs() <= NEAR {
            return Ok(relief_um);
        }
        if found < smd_um {
            low = relief_um;
        } else {
            high = relief_um;
        }
        let proportion = relief_um * smd_um / found;
        let is_between = proportion > low && proportion < high;
        let middle = if low > 0.0 {
            (low * high).sqrt()
        } else {
            0.1 * high
        };
        relief_um = if is_between && round < N_ROUNDS / 2 {
            proportion
        } else {
            middle
        };
    }
    Err(ShadingError::Smd {
        smd_um,
        found_um: found,
    }
    .into())
}

pub(super) fn no_surface(source: SurfaceError) -> TextileError {
    TextileError::surface("the relief of a picture")(source)
}
