//! What is felt of a surface: roughness, levels of both bands, and the spectrum.

use crate::ReportError;
use crate::textiles::wrong;
use selvedge_foundation::quantity::level_db;
use selvedge_textile::surface::{Direction, ProfileSet, Surface};
use selvedge_textile::tactile::{Filters, Levels};

/// What is felt, as the mean over several sets of strokes.
#[derive(Debug, Clone)]
pub(super) struct Felt {
    /// Mean absolute deviation of the strokes, µm.
    pub(super) smd_um: f64,
    /// Levels of 40 Hz and 320 Hz at 100 mm/s, dB re 1 µm.
    pub(super) levels_db: [f64; 2],
    /// The same of warp and weft on their own.
    pub(super) axis_levels_db: [[f64; 2]; 2],
    /// Amplitude of every bin of the local spectra, rms over places, µm: the warp's bins, then the
    /// weft's.
    pub(super) spectrum_um: Vec<f64>,
}

impl Felt {
    /// What is felt of strokes; levels and powers are means over the sets.
    pub(super) fn of(sets: Vec<ProfileSet>, name: &str) -> Result<Self, ReportError> {
        let n = sets.len().max(1) as f64;
        let (mut smd_um, mut means_um, mut powers) = (0.0, [0.0; 2], Vec::new());
        let mut axis_um = [[0.0; 2]; 2];
        for profiles in sets {
            let surface = Surface::from_profiles(profiles, 0.0);
            let surface = surface.map_err(|(_, source)| wrong(name)(source))?;
            smd_um += surface.smd_um() / n;
            let levels = Levels::of(&surface, &Filters::default());
            for (sum, mean_um) in means_um.iter_mut().zip(levels.mean_um) {
                *sum += mean_um / n;
            }
            let along = [Direction::WarpForward, Direction::WeftForward];
            for (sums, direction) in axis_um.iter_mut().zip(along) {
                for (sum, um) in sums
                    .iter_mut()
                    .zip(levels.direction_mean_um[direction.index()])
                {
                    *sum += um / n;
                }
            }
            let of_set = powers_um2(&surface);
            powers.resize(of_set.len(), 0.0);
            for (sum, power) in powers.iter_mut().zip(of_set) {
                *sum += power / n;
            }
        }
        Ok(Self {
            smd_um,
            levels_db: means_um.map(level_db),
            axis_levels_db: axis_um.map(|um| um.map(level_db)),
            spectrum_um: powers.into_iter().map(f64::sqrt).collect(),
        })
    }

    /// Differences of levels to another, dB.
    pub(super) fn apart_db(&self, other: &Self) -> [f64; 2] {
        [0, 1].map(|band| self.levels_db[band] - other.levels_db[band])
    }

    /// How far its roughness is from another's, %.
    pub(super) fn smd_off_percent(&self, truth: &Self) -> f64 {
        100.0 * (self.smd_um / truth.smd_um - 1.0)
    }

    /// Rms of the difference of amplitudes over all bins, as a share of the other's rms, %. Phases
    /// do not enter: a restored profile and a mean cell have their own.
    pub(super) fn spectrum_off_percent(&self, truth: &Self) -> f64 {
        let pairs = self.spectrum_um.iter().zip(&truth.spectrum_um);
        let off: f64 = pairs.map(|(a, b)| (a - b).powi(2)).sum();
        let all: f64 = truth.spectrum_um.iter().map(|b| b * b).sum();
        100.0 * (off / all).sqrt()
    }
}

/// Mean powers of the bins over all points of the forward strokes, warp then weft.
fn powers_um2(surface: &Surface) -> Vec<f64> {
    let of_direction = |direction: Direction| {
        let spectra = surface.spectra(direction);
        let n = spectra.n_points().max(1) as f64;
        let mut mean = vec![0.0; spectra.n_bins()];
        for point in 0..spectra.n_points() {
            for (sum, power) in mean.iter_mut().zip(spectra.powers_um2(point)) {
                *sum += power / n;
            }
        }
        mean
    };
    [Direction::WarpForward, Direction::WeftForward]
        .into_iter()
        .flat_map(of_direction)
        .collect()
}
