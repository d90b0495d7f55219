//! Tiles and lights from which no shape follows, or too much.

use super::case::{Case, Verdict, cases, failed};
use selvedge_foundation::numerics::Grid;
use selvedge_foundation::progress::Progress;
use selvedge_textile::picture::shading::{Light, Method, ShadingOptions, Shape};

/// A side of the tiles, px.
const N: usize = 24;

pub(super) fn cases() -> Vec<Case> {
    cases! { "shading";
        "a black tile" => "refused", || refused(&even(0.0), 45.0, "black");
        "a white tile" => "flat", || flat(&even(1.0));
        "a grey tile" => "flat", || flat(&even(0.5));
        "a tile of 1 × 1" => "flat", || flat(&Grid::filled(1, 1, 0.7));
        "brightness that is no number" => "refused with its place", || {
            let mut tile = even(0.5);
            tile.values_mut()[N + 2] = f64::NAN;
            refused(&tile, 45.0, "row 2, column 3")
        };
        "light from straight above" => "refused", || refused(&checks(), 0.0, "front");
        "light from the level" => "refused", || refused(&checks(), 90.0, "slant");
        "black and white checks in any light" => "finite", any_light;
        "light along which Tsai & Shah stand still" => "refused with advice", || {
            let found = found(&checks(), [45.0, 135.0], Method::TsaiShah);
            refused_with(found, "turn the picture")
        };
    }
}

fn even(brightness: f64) -> Grid<f64> {
    Grid::filled(N, N, brightness)
}

fn checks() -> Grid<f64> {
    let mut tile = even(0.0);
    for row in 0..N {
        for (column, value) in tile.row_mut(row).iter_mut().enumerate() {
            *value = f64::from(u8::from((row / 3 + column / 5) % 2 == 0));
        }
    }
    tile
}

fn found(
    tile: &Grid<f64>,
    [slant_deg, tilt_deg]: [f64; 2],
    method: Method,
) -> Result<Shape, String> {
    let light = Light {
        slant_deg,
        tilt_deg,
    };
    let options = ShadingOptions {
        method,
        ..ShadingOptions::default()
    };
    let run = |progress: &mut Progress<'_>| Shape::from_shading(tile, light, &options, progress);
    Progress::unheard(run).map_err(failed)
}

/// That it was refused, with these words.
fn refused_with(found: Result<Shape, String>, word: &str) -> Verdict {
    match found {
        Err(text) if text.contains(word) => Ok(text),
        Err(text) => Err(text),
        Ok(_) => Err("a shape".to_owned()),
    }
}

fn refused(tile: &Grid<f64>, slant_deg: f64, word: &str) -> Verdict {
    let all =
        Method::OF_SHADING.map(|method| refused_with(found(tile, [slant_deg, 20.0], method), word));
    let texts: Vec<String> = all.into_iter().collect::<Result<_, _>>()?;
    Ok(texts.into_iter().next().unwrap_or_default())
}

fn flat(tile: &Grid<f64>) -> Verdict {
    for method in Method::OF_SHADING {
        if !found(tile, [45.0, 20.0], method)?.is_flat() {
            return Err(format!("{}: a relief", method.label()));
        }
    }
    Ok("flat".to_owned())
}

fn any_light() -> Verdict {
    let (mut n_found, mut n_refused) = (0, 0);
    for slant in [2.0, 45.0, 85.0] {
        for tilt in [-180.0, -45.0, 0.0, 60.0, 135.0, 270.0] {
            for method in Method::OF_SHADING {
                let Ok(shape) = found(&checks(), [slant, tilt], method) else {
                    n_refused += 1;
                    continue;
                };
                n_found += 1;
                let numbers = shape.height_px.values().iter().chain(&shape.residuals);
                if numbers.copied().any(|x| !x.is_finite()) {
                    return Err(format!("{} at {slant}°, {tilt}°", method.label()));
                }
            }
        }
    }
    Ok(format!("{n_found} shapes, all finite; {n_refused} refused"))
}
