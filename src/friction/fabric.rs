//! Fabrics that somebody photographed and stroked: learnt from like procedural cloth, and what the
//! simple methods and the shipped networks make of them.

use selvedge_foundation::numerics::{Grid, at_place, in_pieces, median, n_threads, to_index};
use selvedge_foundation::progress::Progress;

use crate::FrictionError;
use crate::baseline::Baseline;
use crate::cloth::PER_MM;
use crate::example::{Example, SHORT_WINDOW, WINDOW};
use crate::picture::middle_strip;
use crate::predict::Predictor;
use crate::runs::{Contestant, Taken};
use crate::score::{Measure, Prediction, score};

/// Of so many fabrics one is held back.
const ONE_OF: usize = 5;
/// Points of a trace whose shapes are compared.
const N_POINTS: usize = 200;
/// How far a place may be stretched to another when shapes are compared, points.
const REACH: usize = 20;
/// How many times as far from the others as is usual a fabric is told of.
const UNLIKE: f64 = 2.0;

/// A fabric with its picture and the friction that was felt along it.
#[derive(Debug, Clone, PartialEq)]
pub struct Fabric {
    /// What it is called.
    pub name: String,
    /// Its picture, brightness 0 to 1, whose left edge is where the stroke began.
    pub picture: Grid<f32>,
    /// Pixels a millimetre.
    pub px_per_mm: f64,
    /// Coefficient of friction along the middle of the picture; a single one is the mean of all.
    pub trace: Vec<f64>,
    /// Its samples a millimetre.
    pub samples_per_mm: f64,
}

/// How far a method is from what was felt on fabrics that it has not seen.
#[derive(Debug, Clone, PartialEq)]
pub struct LeftOut {
    /// What it is called.
    pub method: &'static str,
    /// Root mean square of the level's error.
    pub level_rmse: f64,
    /// Mean distance of spectra, dB; `None` where only means of friction are known.
    pub log_spectral_distance_db: Option<f64>,
}

impl Fabric {
    /// The fabrics whose traces are unlike all others', by their places: how far each is from
    /// the others at the median (dynamic time warping of 200 points of its shape and level, in
    /// units of friction), as a multiple of what is usual. A trace that slipped, was cut short or
    /// belongs to another picture stands here.
    pub fn unlike(fabrics: &[Self]) -> Vec<(usize, f64)> {
        let shapes: Vec<Vec<f64>> = fabrics.iter().map(Self::shape).collect();
        let mut distances = vec![0.0; shapes.len()];
        in_pieces(
            &mut distances,
            1,
            n_threads(),
            Vec::new,
            |room, one, found| {
                let others = shapes.iter().enumerate().filter(|(other, _)| *other != one);
                let distances = others.map(|(_, shape)| warped(&shapes[one], shape, room));
                found[0] = median(&mut distances.collect::<Vec<_>>());
            },
        );
        let usual = median(&mut distances.clone());
        let ratios = distances
            .into_iter()
            .map(|distance| distance / usual.max(1e-9));
        ratios
            .enumerate()
            .filter(|(_, ratio)| *ratio > UNLIKE)
            .collect()
    }

    fn shape(&self) -> Vec<f64> {
        let step = self.trace.len().saturating_sub(1) as f64 / (N_POINTS - 1) as f64;
        (0..N_POINTS)
            .map(|point| at_place(&self.trace, point as f64 * step))
            .collect()
    }

    /// Its trace with [`PER_MM`] samples a millimetre, as long as its strip or shorter.
    fn resampled(&self, n: usize) -> Vec<f64> {
        if let [level] = *self.trace {
            return vec![level; n];
        }
        let step = self.samples_per_mm / PER_MM;
        let n = n.min(to_index((self.trace.len() - 1) as f64 / step) + 1);
        (0..n)
            .map(|at| at_place(&self.trace, at as f64 * step))
            .collect()
    }

    /// Its strip and its trace, registered.
    fn registered(&self) -> Result<(Grid<f32>, Vec<f64>), FrictionError> {
        let wrong = |what: &str| FrictionError::Fabric {
            name: self.name.clone(),
            what: what.to_owned(),
        };
        let is_friction = |mu: &f64| mu.is_finite() && *mu >= 0.0;
        if self.trace.is_empty() || !self.trace.iter().all(is_friction) {
            return Err(wrong("its friction is none: give numbers from 0 up"));
        }
        let strip = middle_strip(&self.picture, self.px_per_mm).ok_or_else(|| {
            wrong("its picture is lower than 10 mm: give a larger one or its true scale")
        })?;
        let trace = self.resampled(strip.width());
        if trace.len() < SHORT_WINDOW {
            return Err(wrong(
                "picture and friction share less than 40 mm: give longer ones",
            ));
        }
        Ok((strip, trace))
    }

    /// Windows of every fabric, all of the same length: 100 mm where every fabric has them.
    fn examples(fabrics: &[Self]) -> Result<Vec<Vec<Example>>, FrictionError> {
        let all: Result<Vec<_>, _> = fabrics.iter().map(Self::registered).collect();
        let all = all?;
        let is_long = all.iter().all(|(_, trace)| trace.len() >= WINDOW);
        let window = if is_long { WINDOW } else { SHORT_WINDOW };
        let of_fabric = |(fabric, (strip, trace)): (&Self, &(Grid<f32>, Vec<f64>))| {
            let starts = (0..=trace.len() - window).step_by(window);
            let part = |from| strip.part([from, 0, window, strip.height()]);
            let example = |from| {
                Some(Example::given(
                    &fabric.name,
                    from,
                    part(from)?,
                    &trace[from..from + window],
                ))
            };
            starts.filter_map(example).collect()
        };
        Ok(fabrics.iter().zip(&all).map(of_fabric).collect())
    }

    /// Refuses fewer than something can be learnt from while one is held back.
    fn are_enough(fabrics: &[Self]) -> Result<(), FrictionError> {
        match fabrics.len() {
            n @ 0..3 => Err(FrictionError::Few { n }),
            _ => Ok(()),
        }
    }

    /// What simple methods make of each fabric that have learnt from all others, and the networks
    /// that are shipped.
    ///
    /// # Errors
    /// Fewer than three fabrics, one without a strip or friction; cancelled.
    pub fn left_out(
        fabrics: &[Self],
        progress: &mut Progress<'_>,
    ) -> Result<Vec<LeftOut>, FrictionError> {
        Self::are_enough(fabrics)?;
        let n = fabrics.len();
        let examples = Self::examples(fabrics)?;
        let n_windows: Vec<usize> = examples.iter().map(Vec::len).collect();
        let mut examples: Vec<Example> = examples.into_iter().flatten().collect();
        let predictor = Predictor::shipped()?;
        let has_spectra = fabrics.iter().all(|fabric| fabric.trace.len() > 1);
        let simple = [
            Baseline::Mean,
            Baseline::Nearest,
            Baseline::FiveNearest,
            Baseline::Ridge,
        ];
        let mut rows: Vec<_> = simple.map(Baseline::word).to_vec();
        rows.push(Contestant::SHIPPED);
        let mut sums = vec![[0.0; 3]; rows.len()];
        for (out, n_out) in n_windows.into_iter().enumerate() {
            let share = out as f64 / n as f64;
            progress
                .step(share, "leaving one out")
                .map_err(|_stopped| FrictionError::Cancelled)?;
            // The next fabric stands at the front, and goes behind all others.
            examples.rotate_left(n_out);
            let (learnt, of_fabric) = examples.split_at(examples.len() - n_out);
            for (method, sum) in sums.iter_mut().enumerate() {
                let fitted = simple.get(method).map(|simple| simple.fitted(learnt));
                for example in of_fabric {
                    let found = match &fitted {
                        Some(fitted) => fitted.predict(example),
                        None => Prediction::of_course(&predictor.course(&example.looks)),
                    };
                    let scores = score(&found, &example.trace);
                    let off = 0.01 * Measure::LevelError.of(&scores) * example.course.level;
                    *sum = [
                        sum[0] + 1.0,
                        sum[1] + off * off,
                        sum[2] + Measure::LogSpectral.of(&scores),
                    ];
                }
            }
        }
        let row = |(method, [n, squares, db]): (_, [f64; 3])| LeftOut {
            method,
            level_rmse: (squares / n).sqrt(),
            log_spectral_distance_db: has_spectra.then_some(db / n),
        };
        Ok(rows.into_iter().zip(sums).map(row).collect())
    }
}

impl Taken {
    /// Fabrics to learn from, and every fifth (the last of fewer) to hold back whole.
    ///
    /// # Errors
    /// Fewer than three fabrics, or one without a strip or friction.
    pub fn of_fabrics(fabrics: &[Fabric]) -> Result<Self, FrictionError> {
        Fabric::are_enough(fabrics)?;
        let n = fabrics.len();
        let mut taken = Self {
            learnt: Vec::new(),
            held_back: Vec::new(),
        };
        for (nth, examples) in Fabric::examples(fabrics)?.into_iter().enumerate() {
            let is_held_back = nth % ONE_OF == ONE_OF - 1 || (n < ONE_OF && nth == n - 1);
            let side = if is_held_back {
                &mut taken.held_back
            } else {
                &mut taken.learnt
            };
            side.extend(examples);
        }
        Ok(taken)
    }
}

/// Mean difference of two shapes of the same length along the path that makes its sum least, within
/// [`REACH`] points. `room` is overwritten.
fn warped(one: &[f64], other: &[f64], room: &mut Vec<f64>) -> f64 {
    let n = one.len();
    room.clear();
    room.resize(2 * (n + 1), f64::INFINITY);
    room[0] = 0.0;
    for (at, value) in one.iter().enumerate() {
        let (before, now) = if at % 2 == 0 { (0, n + 1) } else { (n + 1, 0) };
        room[now..=now + n].fill(f64::INFINITY);
        for (place, other) in other
            .iter()
            .enumerate()
            .take(at + REACH + 1)
            .skip(at.saturating_sub(REACH))
        {
            let least = room[before + place]
                .min(room[before + place + 1])
                .min(room[now + place]);
            room[now + place + 1] = (value - other).abs() + least;
        }
    }
    room[if n.is_multiple_of(2) { n } else { 2 * n + 1 }] / n.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::split::Split;
    use selvedge_foundation::progress::Progress;

    fn fabrics() -> Vec<Fabric> {
        let window = |n: usize| Split::Cloths.windows(4)[1][n].taken();
        (0..6)
            .map(|n| {
                let example = window(n);
                Fabric {
                    name: format!("fabric {n}"),
                    picture: example.strip,
                    px_per_mm: PER_MM,
                    trace: example.trace,
                    samples_per_mm: PER_MM,
                }
            })
            .collect()
    }

    #[test]
    fn fabrics_are_learnt_from_as_they_were_felt_and_some_are_held_back_whole() {
        let fabrics = fabrics();
        let taken = Taken::of_fabrics(&fabrics).unwrap();
        let names =
            |examples: &[Example]| examples.iter().map(|e| e.cloth.clone()).collect::<Vec<_>>();
        assert_eq!(names(&taken.held_back), ["fabric 4"]);
        assert_eq!(names(&taken.learnt).len(), 5);
        assert_eq!(taken.held_back[0].trace, fabrics[4].trace);
        let mut halved = fabrics[4].clone();
        halved.trace = (0..640)
            .map(|at| at_place(&fabrics[4].trace, 2.0 * f64::from(at)))
            .collect();
        halved.samples_per_mm = 0.5 * PER_MM;
        let (_, trace) = halved.registered().unwrap();
        assert!((trace[600] - fabrics[4].trace[600]).abs() < 1e-12);
    }

    #[test]
    fn what_is_no_fabric_is_refused_with_its_name() {
        let mut fabrics = fabrics();
        fabrics[2].trace[7] = f64::NAN;
        let refused = Taken::of_fabrics(&fabrics).unwrap_err().to_string();
        assert!(
            refused.contains("fabric 2") && refused.contains("numbers from 0"),
            "{refused}"
        );
        fabrics[2].trace = vec![0.3; 100];
        let refused = Taken::of_fabrics(&fabrics).unwrap_err().to_string();
        assert!(refused.contains("less than 40 mm"), "{refused}");
        for trace in [
            vec![],
            vec![-0.1; 1280],
            vec![-0.3],
            vec![f64::INFINITY; 1280],
        ] {
            fabrics[2].trace = trace;
            let refused = Taken::of_fabrics(&fabrics).unwrap_err().to_string();
            assert!(
                refused.contains("fabric 2: its friction is none"),
                "{refused}"
            );
        }
        for n in 0..3 {
            let refused = Taken::of_fabrics(&fabrics[..n]).unwrap_err().to_string();
            let said = format!("{n} fabrics are too few: give at least 3");
            assert!(refused.starts_with(&said), "{refused}");
        }
    }

    #[test]
    fn a_trace_unlike_all_others_is_told_of_and_a_shifted_one_is_not() {
        let mut fabrics = fabrics();
        for (nth, fabric) in fabrics.iter_mut().enumerate() {
            fabric.trace = (0..1280)
                .map(|at| 0.3 + 0.02 * (0.02 * f64::from(at) + nth as f64).sin())
                .collect();
        }
        assert_eq!(Fabric::unlike(&fabrics), []);
        fabrics[3].trace.iter_mut().for_each(|mu| *mu += 0.4);
        let unlike = Fabric::unlike(&fabrics);
        assert!(
            matches!(&*unlike, [(3, ratio)] if *ratio > 5.0),
            "{unlike:?}"
        );
        let [a, b] = [[0.0, 0.0, 1.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0]];
        assert_eq!(warped(&a, &b, &mut Vec::new()), 0.0);
        assert_eq!(warped(&a, &[0.5; 5], &mut Vec::new()), 0.5);
    }

    #[test]
    fn one_that_is_left_out_is_missed_by_the_mean_as_the_closed_form_says() {
        let mut fabrics = fabrics();
        for (nth, fabric) in fabrics.iter_mut().enumerate() {
            fabric.trace = vec![0.3 + 0.01 * nth as f64];
        }
        let rows = Progress::unheard(|progress| Fabric::left_out(&fabrics, progress)).unwrap();
        // Each is off by 6/5 of what it differs from the mean of all.
        let expected = 1.2 * 0.01 * (35.0_f64 / 12.0).sqrt();
        assert!((rows[0].level_rmse - expected).abs() < 1e-9, "{rows:?}");
        assert!(
            rows.iter()
                .all(|row| row.level_rmse.is_finite() && row.log_spectral_distance_db.is_none())
        );
        assert_eq!(rows.len(), 5);
        assert!(Progress::unheard(|progress| Fabric::left_out(&fabrics[..2], progress)).is_err());
    }
}
