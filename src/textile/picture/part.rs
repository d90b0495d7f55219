//! The part of a bent textile that lies flat enough for its cells to be averaged.

use super::basis::Basis;
use super::tile::Tile;
use selvedge_foundation::numerics::Grid;

/// Sides of a part, as shares of the picture's, largest first.
const SHARES: [usize; 3] = [2, 4, 8];
/// Parts of a size that are tried at most, spread evenly.
const MAX_PARTS: usize = 24;
/// A part must hold this many cells.
const MIN_CELLS: f64 = 40.0;

/// A part of a picture, the mean of its cells, and what that explains of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FlatPart {
    /// Left, top, width and height, px.
    pub(super) place: [usize; 4],
    pub(super) tile: Tile,
    pub(super) explained_variance: f64,
}

/// The largest part (a half, a quarter, an eighth of either side) whose mean cell explains at least
/// `wanted` of its variance; if none does, the part whose explains most. `None` if no part holds
/// enough cells. `step` hears how far it is, 0…1, and may stop it.
pub(super) fn flattest<E>(
    luminance: &Grid<f64>,
    basis: Basis,
    wanted: f64,
    n_threads: usize,
    mut step: impl FnMut(f64) -> Result<(), E>,
) -> Result<Option<FlatPart>, E> {
    let mut best: Option<FlatPart> = None;
    for (round, share) in SHARES.into_iter().enumerate() {
        let size = [luminance.width() / share, luminance.height() / share];
        if ((size[0] * size[1]) as f64) < MIN_CELLS * basis.area() {
            break;
        }
        let every = (share * share).div_ceil(MAX_PARTS);
        for n in (0..share * share).step_by(every) {
            let done = n as f64 / (share * share) as f64;
            step((round as f64 + done) / SHARES.len() as f64)?;
            let place = [n % share * size[0], n / share * size[1], size[0], size[1]];
            let Some(part) = luminance.part(place) else {
                continue;
            };
            let (tile, explained_variance) = Tile::refine(&part, basis, n_threads, |_| Ok(()))?;
            let is_better = |b: &FlatPart| explained_variance > b.explained_variance;
            if best.as_ref().is_none_or(is_better) {
                best = Some(FlatPart {
                    place,
                    tile,
                    explained_variance,
                });
            }
        }
        if best
            .as_ref()
            .is_some_and(|b| b.explained_variance >= wanted)
        {
            break;
        }
    }
    Ok(best)
}
