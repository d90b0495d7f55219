//! What a surface is: height maps, measured height profiles in four directions, and their local
//! spectra; friction traces beside them.
//!
//! Knows nothing of where a surface came from, of fingers, or of vibrations.
//!
//! # Invariants
//! - every height is finite; every step lies within 0.0005–0.5 mm
//! - spectra are one-sided powers in µm², bins 0.23 cycles/mm apart, bin k in slot k − 1
//! - a [`Surface`] has spectra in all four directions: fall-backs are applied once, and named

mod areal;
mod band;
mod direction;
mod error;
mod friction;
mod height_map;
mod preparation;
mod probe;
mod profile;
mod spectra;
mod tracks;

pub(crate) use band::{OFFICIAL_CUT_OFF_MM, without_long_waves};
pub use direction::{Direction, Representation};
pub use error::SurfaceError;
pub use friction::FrictionTrace;
pub(crate) use friction::mean_deviation;
pub use height_map::HeightMap;
pub(crate) use height_map::MAX_POINTS;
pub(crate) use preparation::despiked;
pub use preparation::{Levelling, Preparation};
pub use probe::Probe;
pub use profile::{Profile, ProfileSet, smd_um};
pub(crate) use spectra::SpectralPlan;
pub use spectra::{BIN_SPACING_PER_MM, LocalSpectra, N_BINS, WINDOW_LENGTH_MM};

use std::sync::Arc;

/// A surface: its profiles, and local spectra in every direction, along one profile each or at
/// every point of an area.
#[derive(Debug, Clone)]
pub struct Surface {
    profiles: ProfileSet,
    spectra: [Arc<LocalSpectra>; 4],
    taken_from: [Direction; 4],
    representation: Representation,
}

impl Surface {
    /// The surface of the profiles that are there; `noise_floor_um2_mm` is a constant power
    /// density taken off every bin.
    ///
    /// Where both weft profiles are missing the weft takes the warp's, direction for direction;
    /// then a missing direction takes the spectra of its opposite (power has no direction).
    ///
    /// # Errors
    /// A profile shorter than one window, with its direction; no warp profile at all.
    pub fn from_profiles(
        profiles: ProfileSet,
        noise_floor_um2_mm: f64,
    ) -> Result<Self, (Direction, SurfaceError)> {
        let taken_from =
            sources(&profiles).ok_or((Direction::WarpForward, SurfaceError::NoWarp))?;
        let mut own: [Option<Arc<LocalSpectra>>; 4] = [const { None }; 4];
        for direction in Direction::ALL {
            let Some(profile) = &profiles[direction.index()] else {
                continue;
            };
            let spectra = LocalSpectra::of(profile, direction.is_reverse())
                .map_err(|error| (direction, error))?;
            own[direction.index()] = Some(Arc::new(spectra.minus_noise_floor(noise_floor_um2_mm)));
        }
        let find = |direction: Direction| own[direction.index()].clone();
        let [a, b, c, d] = taken_from.map(find);
        let (Some(a), Some(b), Some(c), Some(d)) = (a, b, c, d) else {
            return Err((Direction::WarpForward, SurfaceError::NoWarp));
        };
        Ok(Self {
            profiles,
            spectra: [a, b, c, d],
            taken_from,
            representation: Representation::Economical,
        })
    }

    /// A surface without a height: one silent point in every direction.
    pub(crate) fn flat() -> Self {
        let spectra = Arc::new(LocalSpectra::over_area(vec![0.0], 1, 1));
        Self {
            profiles: ProfileSet::default(),
            spectra: std::array::from_fn(|_| Arc::clone(&spectra)),
            taken_from: [Direction::WarpForward; 4],
            representation: Representation::Economical,
        }
    }

    /// How its spectra are laid out.
    pub fn representation(&self) -> Representation {
        self.representation
    }

    /// The local spectra felt in a direction.
    pub fn spectra(&self, direction: Direction) -> &Arc<LocalSpectra> {
        &self.spectra[direction.index()]
    }

    /// The direction whose profile a direction's spectra come from: itself, or its fall-back.
    pub fn taken_from(&self, direction: Direction) -> Direction {
        self.taken_from[direction.index()]
    }

    /// The profile measured in a direction, if there is one.
    pub fn profile(&self, direction: Direction) -> Option<&Profile> {
        self.profiles[direction.index()].as_ref()
    }

    /// The KES roughness figure SMD in µm: the mean over the profiles that were measured, or, of an
    /// areal surface, over the strokes through its middle.
    pub fn smd_um(&self) -> f64 {
        smd_um(&self.profiles)
    }
}

/// Which profile each direction takes; `None` without any warp profile.
fn sources(profiles: &ProfileSet) -> Option<[Direction; 4]> {
    use Direction::{WarpForward, WarpReverse, WeftForward, WeftReverse};

    let has = |direction: Direction| profiles[direction.index()].is_some();
    let pick = |wanted: Direction, opposite: Direction| {
        if has(wanted) {
            Some(wanted)
        } else {
            has(opposite).then_some(opposite)
        }
    };
    let warp = [
        pick(WarpForward, WarpReverse)?,
        pick(WarpReverse, WarpForward)?,
    ];
    let weft = match (
        pick(WeftForward, WeftReverse),
        pick(WeftReverse, WeftForward),
    ) {
        (Some(forward), Some(reverse)) => [forward, reverse],
        _ => warp,
    };
    Some([warp[0], warp[1], weft[0], weft[1]])
}

#[cfg(test)]
mod tests {
    use super::Direction::{WarpForward, WarpReverse, WeftForward, WeftReverse};
    use super::*;

    fn wave(amplitude_um: f64) -> Profile {
        let heights = (0..4600)
            .map(|i| amplitude_um * (f64::from(i) * 0.02).sin())
            .collect();
        Profile::new(1.0 / 230.0, heights).unwrap()
    }

    fn with(directions: &[Direction]) -> Surface {
        let mut profiles = ProfileSet::default();
        for &direction in directions {
            profiles[direction.index()] = Some(wave(1.0));
        }
        Surface::from_profiles(profiles, 0.0).unwrap()
    }

    #[test]
    fn missing_directions_take_what_is_there() {
        let taken = |directions: &[Direction]| {
            let surface = with(directions);
            Direction::ALL.map(|direction| surface.taken_from(direction))
        };
        assert_eq!(taken(&Direction::ALL), Direction::ALL);
        assert_eq!(taken(&[WarpForward]), [WarpForward; 4]);
        assert_eq!(
            taken(&[WarpForward, WarpReverse]),
            [WarpForward, WarpReverse, WarpForward, WarpReverse]
        );
        assert_eq!(
            taken(&[WarpReverse, WeftForward]),
            [WarpReverse, WarpReverse, WeftForward, WeftForward]
        );
        assert_eq!(
            taken(&[WarpForward, WeftReverse]),
            [WarpForward, WarpForward, WeftReverse, WeftReverse]
        );
    }

    #[test]
    fn no_warp_is_refused() {
        let mut profiles = ProfileSet::default();
        profiles[WeftForward.index()] = Some(wave(1.0));
        let error = Surface::from_profiles(profiles, 0.0).unwrap_err();
        assert_eq!(error, (WarpForward, SurfaceError::NoWarp));
    }

    #[test]
    fn a_short_profile_is_refused_with_its_direction() {
        let mut profiles = ProfileSet::default();
        profiles[WarpForward.index()] = Some(wave(1.0));
        profiles[WeftForward.index()] = Some(Profile::new(1.0 / 230.0, vec![0.0; 999]).unwrap());
        let (direction, error) = Surface::from_profiles(profiles, 0.0).unwrap_err();
        assert_eq!(direction, WeftForward);
        assert!(
            error
                .to_string()
                .starts_with("999 samples where one window takes 1000")
        );
    }
}
