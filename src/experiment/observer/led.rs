//! What the array does where a stylus is led over a textile: how strongly its vibration drives all
//! contactors, straight on at the speed of levels.

use std::sync::Arc;

use crate::ExperimentError;
use selvedge_render::RenderError;
use selvedge_render::contact::{FeltSurface, Tip};
use selvedge_render::stylus::StylusSettings;
use selvedge_textile::Textile;
use selvedge_textile::surface::Direction;
use selvedge_textile::tactile::{Filters, LEVEL_SPEED_MM_PER_S, Levels};

/// Ticks that are felt in each direction: a second.
const N_TICKS: u32 = 40;
/// Ticks before them: the window of two ticks fills, and the tip comes to its speed.
const N_BEFORE: u32 = 4;
/// How far it is led in a tick of 25 ms, mm.
const WAY_MM: f64 = 0.025 * LEVEL_SPEED_MM_PER_S;

/// The levels of a textile under a stylus, before any gain.
///
/// # Errors
/// The textile's files cannot be read, or no such stylus is led over it.
pub(super) fn levels(
    textile: &Textile,
    settings: &StylusSettings,
) -> Result<Levels, ExperimentError> {
    let tip = Tip::stylus(settings.radius_mm);
    let felt = FeltSurface::of_textile(textile, &tip)?;
    let refused = |error: RenderError| {
        let mend = "mend [presentation.stylus]";
        ExperimentError::value(format!("{}: {error}", textile.id()), mend)
    };
    let setup = settings.setup(felt.contact(tip).map_err(refused)?);
    let on = vec![(Arc::clone(textile.surface()), Some(setup))];
    let mut drive = settings.drive(on, &Filters::default()).map_err(refused)?;
    Ok(Levels::of_amplitudes(&Direction::ALL.map(|direction| {
        drive.leave();
        let mut um = Vec::new();
        for nth in 0..N_BEFORE + N_TICKS {
            drive.follow(Some((0, place_mm(direction, f64::from(nth)))));
            um.push(drive.driven().1);
        }
        um.split_off(N_BEFORE as usize)
    })))
}

fn place_mm(direction: Direction, n_ticks: f64) -> [f64; 2] {
    let way_mm = WAY_MM * n_ticks;
    match direction {
        Direction::WarpForward => [way_mm, 0.0],
        Direction::WarpReverse => [-way_mm, 0.0],
        Direction::WeftForward => [0.0, way_mm],
        Direction::WeftReverse => [0.0, -way_mm],
    }
}
