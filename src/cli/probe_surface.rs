//! What `selvedge probe` feels, and with what.

use std::path::Path;

use clap::Args;

use super::CliError;
use super::textile::FromLibrary;
use super::textile_import::AskedArgs;
use selvedge_render::contact::{FeltSurface, Relief, Tip};
use selvedge_render::scene::{ArrayLayout, Geometry};
use selvedge_textile::metrology;
use selvedge_textile::surface::HeightMap;
use selvedge_textile::{TextileError, read_measurement};

/// Where a surface is found, and what its file leaves open.
#[derive(Debug, Args)]
pub(super) struct FeltArgs {
    #[command(flatten)]
    from: FromLibrary,
    #[command(flatten)]
    asked: AskedArgs,
    /// The file of heights is one repeat of the surface
    #[arg(long)]
    periodic: bool,
}

/// A tip by its name, of this radius in mm.
pub(super) fn tip(name: &str, radius_mm: f64) -> Result<Tip, CliError> {
    Ok(match name {
        "stylus" => Tip::stylus(radius_mm),
        "fingertip" => Tip::fingertip(),
        name => {
            let Some(layout) = ArrayLayout::named(name) else {
                let what =
                    format!("no tip {name:?}; use stylus, fingertip, exeter-24, 5x5 or 10x10");
                return Err(CliError::Input(what));
            };
            Tip::array(&Geometry::Array(layout).contactors(), radius_mm)
        }
    })
}

/// A plane, a file of heights, or a textile, as a tip presses it.
pub(super) fn felt(name: &str, args: &FeltArgs, tip: &Tip) -> Result<FeltSurface, CliError> {
    if name == "flat" {
        return Ok(FeltSurface::rigid(Relief::flat()));
    }
    let path = Path::new(name);
    if path.is_file() {
        let heights =
            metrology::Measured::open(&read_measurement(path)?, path, &args.asked.asked())?;
        let map = HeightMap::new(heights.heights_um, heights.step_mm);
        let map = map.map_err(|source| TextileError::Surface {
            path: path.to_owned(),
            source,
        })?;
        let map = if args.periodic { map.periodic() } else { map };
        return Ok(FeltSurface::rigid(Relief::of_map(&map)));
    }
    let textile = args.from.of(name)?.load(name)?;
    Ok(FeltSurface::of_textile(&textile, tip)?)
}
