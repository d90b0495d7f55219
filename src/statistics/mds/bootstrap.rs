//! Maps of subjects drawn anew, with replacement: how much a map hangs on who took part.

use super::{Dissimilarities, Mds};
use selvedge_foundation::numerics::Random;
use selvedge_foundation::progress::{Cancelled, Progress};

/// Maps of resampled subjects.
#[derive(Debug, Clone, PartialEq)]
pub struct Resampled {
    /// Points of every map, to be laid over the map of all subjects.
    pub maps: Vec<Vec<Vec<f64>>>,
    /// Draws that could not be mapped, for want of pairs or of an order.
    pub n_unmapped: usize,
}

impl Mds {
    /// Maps in `dims` dimensions of the mean dissimilarities of as many subjects, drawn with
    /// replacement `n_draws` times. `subjects` holds a square matrix each, row by row, as
    /// [`Dissimilarities::new`] takes it; a pair is the mean of those who judged it.
    ///
    /// # Errors
    /// It was cancelled.
    pub fn resampled(
        &self,
        names: &[String],
        subjects: &[Vec<Option<f64>>],
        (dims, n_draws): (usize, usize),
        progress: &mut Progress<'_>,
    ) -> Result<Resampled, Cancelled> {
        let mut found = Resampled {
            maps: Vec::with_capacity(n_draws),
            n_unmapped: 0,
        };
        let random = Random::new(self.seed).branch("subjects drawn");
        let mut unheard_report = |_: f64, _: &str| {};
        for draw in 0..n_draws {
            progress.step(draw as f64 / n_draws as f64, "subjects drawn anew")?;
            let mut random = random.branch(&format!("draw {draw}"));
            let drawn: Vec<&Vec<Option<f64>>> = subjects
                .iter()
                .map(|_| &subjects[random.index(subjects.len())])
                .collect();
            let values = mean_of(&drawn, names.len());
            let mut own = Progress::new(
                &mut unheard_report,
                selvedge_foundation::progress::CancelFlag::new(),
            );
            let map = Dissimilarities::new(names.to_vec(), &values)
                .ok()
                .map(|data| self.maps(&data, dims..=dims, &mut own))
                .transpose()?
                .and_then(|mut maps| maps.pop());
            match map {
                Some(map) => found.maps.push(map.points),
                None => found.n_unmapped += 1,
            }
        }
        Ok(found)
    }
}

/// The mean of every pair over those who judged it, both sides together.
fn mean_of(subjects: &[&Vec<Option<f64>>], n: usize) -> Vec<Option<f64>> {
    let mean = |at: usize| {
        let sides = [at, (at % n) * n + at / n];
        let judged = subjects
            .iter()
            .flat_map(|subject| sides.map(|side| subject.get(side).copied().flatten()))
            .flatten();
        let (sum, count) = judged.fold((0.0, 0_u32), |(sum, count), x| (sum + x, count + 1));
        (count > 0).then(|| sum / f64::from(count))
    };
    (0..n * n).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::properties::Ellipse;
    use selvedge_foundation::progress::Progress;

    /// Subjects who feel the same points of a plane, each with noise of their own.
    fn subjects(noise: f64) -> Vec<Vec<Option<f64>>> {
        let mut random = Random::new(2);
        let x: Vec<[f64; 2]> = (0..9).map(|_| [random.normal(), random.normal()]).collect();
        let mut matrix = |_| {
            let mut values = vec![None; 81];
            for i in 0..9 {
                for j in i + 1..9 {
                    let d = (x[i][0] - x[j][0]).hypot(x[i][1] - x[j][1]);
                    values[9 * i + j] = Some(d * (noise * random.normal()).exp());
                }
            }
            values
        };
        (0..8).map(&mut matrix).collect()
    }

    #[test]
    fn ellipses_grow_with_what_subjects_disagree_about() {
        let names: Vec<String> = (0..9).map(|i| format!("t{i}")).collect();
        let mds = Mds {
            n_starts: 10,
            ..Mds::default()
        };
        let size = |noise: f64| {
            let subjects = subjects(noise);
            let draws = (2, 30);
            let found = Progress::unheard(|p| mds.resampled(&names, &subjects, draws, p)).unwrap();
            let again = Progress::unheard(|p| mds.resampled(&names, &subjects, draws, p)).unwrap();
            assert_eq!((found.maps.len(), found.n_unmapped), (30, 0));
            assert_eq!(found, again, "the same draws");
            let ellipses = Ellipse::of_bootstrap(&found.maps[0], &found.maps, 0.95).unwrap();
            ellipses.iter().map(|e| e.half_axes[0]).sum::<f64>() / 9.0
        };
        let [little, much] = [0.02, 0.3].map(size);
        assert!(much > 1.5 * little, "{little} and {much}");
    }

    #[test]
    fn draws_without_an_order_are_counted() {
        let names: Vec<String> = (0..3).map(|i| format!("t{i}")).collect();
        let even = vec![vec![Some(1.0); 9]; 2];
        let found =
            Progress::unheard(|p| Mds::default().resampled(&names, &even, (1, 4), p)).unwrap();
        assert_eq!((found.maps.len(), found.n_unmapped), (0, 4));
    }
}
