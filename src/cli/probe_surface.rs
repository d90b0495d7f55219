//! What `selvedge probe` feels, and with what.

use std::path::Path;

use clap::Args;

use super::CliError;
use super::textile::FromLibrary;
use super::textile_import::AskedArgs;
use selvedge_render::contact::{Compression, Friction, Relief, Tip};
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

/// A surface, and what a textile says of it.
pub(super) struct Felt {
    pub(super) relief: Relief,
    pub(super) friction: Friction,
    pub(super) cloth: Option<Compression>,
}

impl Felt {
    /// A plane, a file of heights, or a textile, as a tip presses it.
    pub(super) fn open(name: &str, args: &FeltArgs, tip: &Tip) -> Result<Self, CliError> {
        let rigid = |relief: Relief| Self {
            relief,
            friction: Friction::none(),
            cloth: None,
        };
        if name == "flat" {
            return Ok(rigid(Relief::flat()));
        }
        let path = Path::new(name);
        if path.is_file() {
            let heights = metrology::open(&read_measurement(path)?, path, &args.asked.asked())?;
            let map = HeightMap::new(heights.heights_um, heights.step_mm);
            let map = map.map_err(|source| TextileError::Surface {
                path: path.to_owned(),
                source,
            })?;
            let map = if args.periodic { map.periodic() } else { map };
            return Ok(rigid(Relief::of_map(&map)));
        }
        let textile = args.from.open()?.load(name)?;
        let relief = match textile.height_map()? {
            Some(map) => Relief::of_map(&map),
            None => Relief::of_surface(textile.surface()),
        };
        let measured = &textile.manifest().measured;
        let figure = |key: &str| measured.get(key).copied();
        let area_mm2 = std::f64::consts::PI * tip.radius_mm * tip.radius_mm;
        let n_contacts = tip.contacts_mm.len() as f64;
        let friction = textile.friction()?;
        Ok(Self {
            relief,
            friction: friction.map_or_else(Friction::none, |trace| Friction {
                trace: Some(trace),
                ..Friction::coulomb(1.0)
            }),
            cloth: Compression::of_figures(figure, n_contacts * area_mm2),
        })
    }
}
