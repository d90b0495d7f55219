//! Friction from a picture, with how far it may be off: the networks that are shipped, together.

use nalgebra::DMatrix;

use selvedge_foundation::numerics::{Grid, Random, Stft, extent, to_single};
use selvedge_foundation::quantity::fixed;

use crate::FrictionError;
use crate::cloth::PER_MM;
use crate::network::{OurNetwork, Size, Weights};
use crate::picture::{Looks, N_BANDS, band_edges, middle_strip};
use crate::score::{Measures, Prediction, score};
use crate::signal::{Course, FRAME, HOP, MAGNITUDE_SCALE, spectra};

/// Weights learnt from other seeds, and what was found of them on cloths that were held back.
const SHIPPED: [&[u8]; 4] = [
    include_bytes!("../../../assets/friction/ours-A-1.weights"),
    include_bytes!("../../../assets/friction/ours-A-2.weights"),
    include_bytes!("../../../assets/friction/ours-A-3.weights"),
    include_bytes!("../../../assets/friction/ours-A-4.weights"),
];
/// What 95 of 100 levels of held-back cloths are off at most beside the networks' own spread, a
/// share of the level, as `assets/friction/provenance.toml` has it.
const LEVEL_WITHIN: f64 = 0.157;
/// The same of log magnitudes by band, dB: neither is spread normally.
const BANDS_DB: [f64; N_BANDS] = [
    10.7, 13.5, 13.1, 13.4, 13.3, 11.8, 11.5, 10.1, 10.0, 8.5, 8.1, 8.3, 8.9, 7.0, 6.7, 6.5,
];
/// Standard deviations to either side of an interval of 95 % of networks.
const WIDE: f64 = 1.96;

/// A picture of more has another scale than was said, and would fill the memory.
const LARGEST_MM: f64 = 500.0;

/// Networks that are asked together.
#[derive(Debug)]
pub struct Predictor {
    networks: Vec<OurNetwork>,
}

/// Friction along a strip.
#[derive(Debug, Clone, PartialEq)]
pub struct PredictedFriction {
    /// Coefficient of friction, [`Self::PER_MM`] a millimetre.
    pub mu: Vec<f64>,
    /// The level may be so far off, either way, in 95 of 100 cloths like those that were learnt.
    pub level_within: f64,
    /// For bands of wavenumbers (from, to, cycles/mm): how far magnitudes may be off, dB.
    pub bands: Vec<[f64; 3]>,
    /// What `mu` was put together from.
    course: Course,
}

impl PredictedFriction {
    /// Samples of [`Self::mu`] to a millimetre.
    pub const PER_MM: f64 = PER_MM;

    /// The mean coefficient of friction.
    pub fn level(&self) -> f64 {
        self.course.level
    }

    /// Log magnitudes of what is not slow: a row a centimetre, a column a bin of 1/40 cycles/mm.
    pub fn log_magnitudes(&self) -> &Grid<f32> {
        &self.course.log_magnitudes
    }

    /// The same of a trace that was felt.
    pub fn log_magnitudes_of(felt: &[f64]) -> Grid<f32> {
        Course::of(felt).log_magnitudes
    }

    /// What is left of a trace without its level and what is slow: phases are found of that alone.
    pub fn rest_of(felt: &[f64]) -> Vec<f64> {
        Course::rest_of(felt)
    }

    /// The spectra that a trace is told by.
    pub fn spectra() -> Stft {
        spectra()
    }

    /// Log magnitudes as a picture: the lowest `n_bins` bins upward, a column a frame, from 0 at
    /// the lower of two ends to 1 at the upper.
    pub fn shades(log_magnitudes: &Grid<f32>, n_bins: usize, [low, high]: [f64; 2]) -> Grid<f64> {
        let n_bins = n_bins.min(log_magnitudes.width());
        Grid::from_fn(log_magnitudes.height(), n_bins, |frame, row| {
            let log = log_magnitudes.row(frame)[n_bins - 1 - row];
            (f64::from(log) - low) / (high - low).max(1e-9)
        })
    }

    /// How sure it is, for people, behind "mean friction".
    pub fn certainty(&self) -> String {
        let [least, most] = extent(self.bands.iter().map(|[.., db]| *db));
        format!(
            "{} ± {} in 95 % of cloths like those learnt, procedural ones; spectrum within {} to \
             {} dB by band. A picture tells little of an unseen material’s friction.",
            fixed(self.level(), 3),
            fixed(self.level_within, 3),
            fixed(least, 1),
            fixed(most, 1)
        )
    }

    /// How far it is from the trace that was felt there, by each [`Measure`](crate::Measure).
    pub fn scores(&self, felt: &[f64]) -> Measures {
        score(&Prediction::of_course(&self.course), felt)
    }
}

impl Predictor {
    /// The networks that are shipped.
    ///
    /// # Errors
    /// Weights that do not fit: a fault of the program.
    pub fn shipped() -> Result<Self, FrictionError> {
        let network =
            |bytes: &&[u8]| OurNetwork::from_weights(&Weights::from_bytes(bytes)?, Size::default());
        let networks: Result<_, _> = SHIPPED.iter().map(network).collect();
        Ok(Self {
            networks: networks?,
        })
    }

    /// A network of so many channels that was taught nothing: for what an answer costs.
    pub fn untaught(width: usize) -> Self {
        let size = Size {
            width,
            ..Size::default()
        };
        Self {
            networks: vec![OurNetwork::untaught(size)],
        }
    }

    /// The strip in the middle of a picture, [`PredictedFriction::PER_MM`] a millimetre: what is
    /// looked at of it, and all of it if it is such a strip.
    ///
    /// # Errors
    /// A picture without a strip of 10 mm × 40 mm, or of more cloth than a finger strokes.
    pub fn strip(picture: &Grid<f32>, px_per_mm: f64) -> Result<Grid<f32>, FrictionError> {
        let size_mm = [picture.width(), picture.height()].map(|n| n as f64 / px_per_mm);
        let refused = Err(FrictionError::Size { size_mm });
        if !size_mm.iter().all(|mm| *mm <= LARGEST_MM) {
            return refused;
        }
        let strip = middle_strip(picture, px_per_mm);
        let Some(strip) = strip.filter(|strip| strip.width() >= FRAME) else {
            return refused;
        };
        let part = strip.part([0, 0, strip.width() / HOP * HOP, strip.height()]);
        Ok(part.unwrap_or(strip))
    }

    /// Friction along the middle of a picture, brightness 0 to 1, of a scale.
    ///
    /// # Errors
    /// As [`Self::strip`].
    pub fn of_picture(
        &self,
        picture: &Grid<f32>,
        px_per_mm: f64,
    ) -> Result<PredictedFriction, FrictionError> {
        let looks = Looks::of(&Self::strip(picture, px_per_mm)?);
        Ok(together(&self.each(&looks)))
    }

    /// The same where latents are shaken by so much of their own size: what hangs on them.
    ///
    /// # Errors
    /// As [`Self::of_picture`].
    pub fn shaken(
        &self,
        picture: &Grid<f32>,
        px_per_mm: f64,
        share: f64,
        random: &mut Random,
    ) -> Result<PredictedFriction, FrictionError> {
        let looks = Looks::of(&Self::strip(picture, px_per_mm)?);
        let mut course = |network: &OurNetwork| {
            let noise = std::iter::repeat_with(|| to_single(share * random.normal()));
            network.shaken(&looks, noise)
        };
        let courses: Vec<_> = self.networks.iter().map(&mut course).collect();
        Ok(together(&courses))
    }

    /// Where cloths lie for the first network, seen from where they differ most: the first two
    /// principal components of what stands for each strip, each with its larger side upward, and
    /// each axis' share of their variance.
    ///
    /// # Errors
    /// As [`Self::of_picture`].
    pub fn plane(&self, strips: &[&Grid<f32>]) -> Result<(Vec<[f64; 2]>, [f64; 2]), FrictionError> {
        let latent = |picture: &&Grid<f32>| {
            let looks = Looks::of(&Self::strip(picture, PER_MM)?);
            Ok(self.networks[0].latent(&looks))
        };
        let latents: Result<Vec<Vec<f32>>, FrictionError> = strips.iter().map(latent).collect();
        let latents = latents?;
        let n = latents.len().max(1) as f64;
        let width = latents.first().map_or(0, Vec::len);
        let codes = DMatrix::from_fn(latents.len(), width, |row, column| {
            f64::from(latents[row][column])
        });
        let means = codes.row_sum() / n;
        let apart = DMatrix::from_fn(latents.len(), width, |row, column| {
            codes[(row, column)] - means[column]
        });
        let axes = (apart.transpose() * &apart / n).symmetric_eigen();
        let mut order: Vec<usize> = (0..width).collect();
        order.sort_by(|&a, &b| axes.eigenvalues[b].total_cmp(&axes.eigenvalues[a]));
        let all = axes.eigenvalues.sum().max(f64::MIN_POSITIVE);
        let mut places = vec![[0.0; 2]; latents.len()];
        let mut shares = [0.0; 2];
        for (nth, &axis) in order.iter().take(2).enumerate() {
            let along = &apart * axes.eigenvectors.column(axis);
            let sign = if along.map(|x| x.powi(3)).sum() < 0.0 {
                -1.0
            } else {
                1.0
            };
            shares[nth] = axes.eigenvalues[axis] / all;
            for (place, value) in places.iter_mut().zip(along.iter()) {
                place[nth] = sign * value;
            }
        }
        Ok((places, shares))
    }

    /// What each network says of a strip.
    fn each(&self, looks: &Looks) -> Vec<Course> {
        let networks = self.networks.iter();
        networks
            .flat_map(|network| network.courses(&[looks]))
            .collect()
    }

    /// What they say together.
    pub(crate) fn course(&self, looks: &Looks) -> Course {
        mean(&self.each(looks))
    }

    /// Friction of a cloth that lies so far (0 to 1) from one picture's to another's, as long as
    /// the shorter of both.
    ///
    /// # Errors
    /// As [`Self::of_picture`].
    pub fn between(
        &self,
        pictures: [(&Grid<f32>, f64); 2],
        share: f64,
    ) -> Result<PredictedFriction, FrictionError> {
        let [from, to] = pictures.map(|(picture, px_per_mm)| Self::strip(picture, px_per_mm));
        let (from, to) = (from?, to?);
        let n = from.width().min(to.width());
        let [from, to] = [from, to].map(|strip| {
            let part = strip.part([0, 0, n, strip.height()]);
            Looks::of(&part.unwrap_or(strip))
        });
        let between = |network: &OurNetwork| network.between(&from, &to, share);
        let courses: Vec<_> = self.networks.iter().filter_map(between).collect();
        Ok(together(&courses))
    }
}

/// What several networks say of one strip.
fn together(courses: &[Course]) -> PredictedFriction {
    let course = mean(courses);
    let n_samples = (course.trend.len() - 1) * HOP;
    let share = 1.0 / courses.len() as f64;
    let spread = courses
        .iter()
        .map(|c| share * (c.level - course.level).powi(2))
        .sum::<f64>();
    PredictedFriction {
        mu: course.trace(n_samples, None),
        level_within: (LEVEL_WITHIN * course.level).hypot(WIDE * spread.sqrt()),
        bands: bands(courses, &course),
        course,
    }
}

/// The mean of courses of the same length; there is at least one.
fn mean(courses: &[Course]) -> Course {
    let share = 1.0 / courses.len() as f64;
    let mut mean = courses[0].clone();
    mean.level = share * courses.iter().map(|c| c.level).sum::<f64>();
    for (frame, trend) in mean.trend.iter_mut().enumerate() {
        *trend = share * courses.iter().map(|c| c.trend[frame]).sum::<f64>();
    }
    for (at, log) in mean.log_magnitudes.values_mut().iter_mut().enumerate() {
        let logs = courses.iter().map(|c| c.log_magnitudes.values()[at]);
        *log = to_single(share) * logs.sum::<f32>();
    }
    mean
}

/// A log magnitude in dB, above half of what a sensor's noise leaves.
fn db(log: f32) -> f64 {
    20.0 * (MAGNITUDE_SCALE * f64::from(log).exp_m1() + 0.5 * MAGNITUDE_SCALE).log10()
}

/// By band: the networks' spread and what was found on held-back cloths.
fn bands(courses: &[Course], mean: &Course) -> Vec<[f64; 3]> {
    let edges = band_edges();
    let wavenumber = |bin: usize| bin as f64 * PER_MM / FRAME as f64;
    edges
        .windows(2)
        .zip(BANDS_DB)
        .map(|(band, off_db)| {
            let height = mean.log_magnitudes.height();
            let (mut squares, mut n) = (0.0, 0.0);
            for (frame, bin) in (0..height).flat_map(|f| (band[0]..band[1]).map(move |b| (f, b))) {
                let middle = db(mean.log_magnitudes.row(frame)[bin]);
                for course in courses {
                    squares += (db(course.log_magnitudes.row(frame)[bin]) - middle).powi(2);
                    n += 1.0;
                }
            }
            let spread_db = (squares / f64::max(n, 1.0)).sqrt();
            [
                wavenumber(band[0]),
                wavenumber(band[1]),
                (WIDE * spread_db).hypot(off_db),
            ]
        })
        .collect()
}

#[cfg(test)]
mod tests;
