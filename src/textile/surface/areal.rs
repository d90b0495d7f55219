//! The areal representation of a surface: local spectra at every point of a grid over it.
//!
//! Philpott & Summers (2012), section 2.2, call this ideal and feel one profile a direction
//! instead, repeated across: then moving along a row changes no column. Here the spectra of a
//! direction are those of the profiles through the points, 1 mm apart both ways, so they vary in
//! both. The wire that a profile is read with has the tester's radius, 0.25 mm, but rides on 1 mm
//! of textile instead of 5: each point stands for its own millimetre, the size of a contactor.
//! Heights are read without friction or noise, so both ways along an axis feel the same.

use std::sync::Arc;

use super::spectra::starts_of_points;
use super::tracks::Tracks;
use super::{
    BIN_SPACING_PER_MM, Direction, HeightMap, LocalSpectra, N_BINS, Probe, Profile, ProfileSet,
    Representation, SpectralPlan, Surface, SurfaceError, WINDOW_LENGTH_MM,
};
use selvedge_foundation::numerics::{Random, to_index};

/// Points along a repeat of a periodic map at which looking for a better fit ends.
const MAX_POINTS_OF_REPEATS: usize = 64;
/// How far the last point of a periodic map may miss the first, mm, without looking further.
const SEAM_MM: f64 = 0.05;

impl Surface {
    /// The surface of a height map with spectra at every point of a grid, 1 mm apart along u and
    /// w; `noise_floor_um2_mm` is a constant power density taken off every bin.
    ///
    /// Point (0, 0) has its window in the map's lower left corner. A map that is not periodic has
    /// as many points as windows fit, and is repeated after them; a periodic one is continued, and
    /// has so many points that a whole number of its repeats follows them as closely as can be.
    /// Its profiles are the strokes through the middle.
    ///
    /// # Errors
    /// A map that is narrower than one window either way and not periodic, with the direction.
    pub fn areal(
        map: &HeightMap,
        noise_floor_um2_mm: f64,
    ) -> Result<Self, (Direction, SurfaceError)> {
        let probe = Probe::contactor();
        let middle_mm = map.size_mm().map(|size_mm| 0.5 * size_mm);
        let [warp, _, weft, _] = map.strokes(&probe, middle_mm, &Random::new(0))?;
        let profiles: ProfileSet = [warp, None, weft, None];
        let [forward, across] = [Direction::WarpForward, Direction::WeftForward];
        let points = [
            Points::of(map, false).map_err(|error| (forward, error))?,
            Points::of(map, true).map_err(|error| (across, error))?,
        ];
        let [warp, weft] = [false, true].map(|is_weft| {
            let spectra = spectra_of(map, &probe, &points, is_weft);
            Arc::new(spectra.minus_noise_floor(noise_floor_um2_mm))
        });
        Ok(Self {
            profiles,
            spectra: [Arc::clone(&warp), warp, Arc::clone(&weft), weft],
            taken_from: [forward, forward, across, across],
            representation: Representation::Areal,
        })
    }
}

/// The spectra of one axis at every point.
fn spectra_of(map: &HeightMap, probe: &Probe, points: &[Points; 2], is_weft: bool) -> LocalSpectra {
    let [along, across] = [is_weft, !is_weft].map(|axis| &points[usize::from(axis)]);
    let n_bins = n_bins_below_nyquist(along.step_mm);
    let plan = SpectralPlan::with_bins(along.step_mm, n_bins);
    let tracks = Tracks::of(map, is_weft);
    let margin = probe.margin_samples(along.step_mm);
    let mut powers_um2 = vec![0.0; across.starts.len() * along.starts.len() * n_bins];
    let rows = powers_um2.chunks_exact_mut(along.starts.len() * n_bins);
    for (track, row) in across.starts.iter().zip(rows) {
        let middle_mm = (*track as f64 * across.step_mm + 0.5 * WINDOW_LENGTH_MM) % across.size_mm;
        let strip = tracks.strip(middle_mm, probe.width_mm, margin);
        let mut lift = probe.lift_um(&strip, along.step_mm);
        // Windows that begin before the end of what repeats go on at its beginning.
        for i in 0..along.n_beyond {
            lift.push(lift[i]);
        }
        for (start, powers) in along.starts.iter().zip(row.chunks_exact_mut(n_bins)) {
            plan.powers_um2(&lift[*start..start + plan.n_window()], powers);
            if plan.ends_at_nyquist() {
                powers[n_bins - 1] *= 0.5;
            }
        }
    }
    LocalSpectra::over_area(powers_um2, along.starts.len(), n_bins)
}

/// The points along one axis of a map.
struct Points {
    step_mm: f64,
    size_mm: f64,
    /// The first sample of each point's window.
    starts: Vec<usize>,
    /// Samples of windows beyond the map's last.
    n_beyond: usize,
}

impl Points {
    fn of(map: &HeightMap, is_weft: bool) -> Result<Self, SurfaceError> {
        let axis = usize::from(is_weft);
        let n_samples = [map.heights_um().width(), map.heights_um().height()][axis];
        // What a profile of this step would take as its step.
        let step_mm = Profile::new(map.step_mm()[axis], Vec::new())?.step_mm();
        let n_window = SpectralPlan::with_bins(step_mm, 1).n_window();
        let size_mm = n_samples as f64 * step_mm;
        let (starts, n_beyond) = if map.is_periodic() {
            let starts = starts_in_repeats(n_samples, step_mm);
            (starts, n_window)
        } else {
            let slack = n_samples.checked_sub(n_window);
            let slack = slack.ok_or(SurfaceError::TooShort {
                n_samples,
                n_window,
            })?;
            (starts_of_points(slack, step_mm), 0)
        };
        Ok(Self {
            step_mm,
            size_mm,
            starts,
            n_beyond,
        })
    }
}

/// The first samples of points 1 mm apart over what repeats after `n_samples`: the fewest points
/// that a whole number of repeats follows within [`SEAM_MM`], else those that miss it least.
fn starts_in_repeats(n_samples: usize, step_mm: f64) -> Vec<usize> {
    let repeat_mm = n_samples as f64 * step_mm;
    let miss_mm = |n: usize| {
        let n_repeats = (n as f64 / repeat_mm).round().max(1.0);
        (n as f64 - n_repeats * repeat_mm).abs()
    };
    let max = MAX_POINTS_OF_REPEATS.max(to_index(repeat_mm + 0.5));
    let closer = |best: usize, n: usize| if miss_mm(n) < miss_mm(best) { n } else { best };
    let first_fit = (1..=max).find(|&n| miss_mm(n) <= SEAM_MM);
    let n_points = first_fit.unwrap_or_else(|| (2..=max).fold(1, closer));
    (0..n_points)
        .map(|j| to_index(j as f64 / step_mm + 0.5) % n_samples)
        .collect()
}

/// Bins up to the Nyquist wavenumber of a step; at least one.
fn n_bins_below_nyquist(step_mm: f64) -> usize {
    let nyquist_per_mm = 0.5 / step_mm * (1.0 + 1e-9);
    let is_below = |k: &u16| BIN_SPACING_PER_MM * f64::from(*k) <= nyquist_per_mm;
    let last = (1..=500_u16).take_while(is_below).last();
    usize::from(last.unwrap_or(1)).min(N_BINS)
}

#[cfg(test)]
mod tests;
