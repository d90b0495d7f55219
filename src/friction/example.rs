//! Pictures with their traces, and which of them are learnt from and which are held back.

use std::sync::OnceLock;

use selvedge_foundation::named;
use selvedge_foundation::numerics::{Grid, Random, in_pieces, to_byte};

use crate::cloth::{Area, Camera, FINGER_ROWS, Family, Recipe};
use crate::picture::Looks;
use crate::signal::{Course, HOP};

/// Samples of a window: 100 mm.
pub(crate) const WINDOW: usize = 1280;
/// Samples of a window of split C: 40 mm.
pub(crate) const SHORT_WINDOW: usize = 512;
/// Samples of a whole trace: 155 mm.
const TRACE: usize = 1984;
/// Pixels of a side of the picture that networks of whole pictures see.
pub(crate) const SQUARE: usize = 512;
/// Seed of the first cloth that is held back.
const HELD_BACK: u64 = 10_000;
/// Strokes that the best possible prediction is the mean of.
const N_STROKES: u64 = 16;

named! {
    /// What is held back.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Split {
        /// Cloths of known families that were never seen: the main result.
        Cloths = "A", "unseen cloths of known families",
        /// A family that was never seen: twills.
        Family = "B", "an unseen family (twill)",
        /// Known cloths at a place 50 mm from any that was seen.
        Places = "C", "unseen places of known cloths, 40 mm each",
        /// The protocol of the paper, where a test window shares nearly all its pixels with one
        /// that was learnt.
        Leaky = "D", "leaky, for comparison only: windows 2 pixels apart",
    }
    /// Its letter.
    pub fn letter;
    /// What it holds back.
    pub fn describe;
}

/// Where a picture and its trace are taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Window {
    /// The family of the cloth.
    pub family: Family,
    /// The seed of the cloth.
    pub seed: u64,
    /// The columns and rows.
    pub area: Area,
    /// The seed of camera and stroke.
    pub take: u64,
}

/// A picture, what it looks like, and the friction along it.
#[derive(Debug, Clone)]
pub(crate) struct Example {
    /// The family, or the name of a fabric that was given.
    pub cloth: String,
    /// The first sample of its cloth.
    pub column: usize,
    /// Where a procedural one was taken.
    pub window: Option<Window>,
    /// See [`Self::square`]: made when it is asked for first, of 256 shades.
    square: OnceLock<Grid<u8>>,
    /// The strip under the finger, brightness 0 to 1.
    pub strip: Grid<f32>,
    /// What is read from it.
    pub looks: Looks,
    /// Friction, one value a sample.
    pub trace: Vec<f64>,
    /// The same, taken apart.
    pub course: Course,
    /// The part of the friction that hangs on the surface.
    pub of_surface: Vec<f64>,
}

impl Window {
    /// The picture and the trace.
    pub(crate) fn taken(self) -> Example {
        let recipe = Recipe::of(self.family, self.seed);
        let relief_um = recipe.relief_um(self.area);
        let rubbed = recipe.rubbed(&relief_um, self.area, self.take);
        let strip = recipe.photo(&relief_um, self.area, &Camera::of(self.take));
        Example {
            cloth: self.family.word().to_owned(),
            column: self.area.columns[0],
            window: Some(self),
            square: OnceLock::new(),
            looks: Looks::of(&strip),
            strip,
            course: Course::of(&rubbed.friction),
            trace: rubbed.friction,
            of_surface: rubbed.of_surface,
        }
    }
}

/// Windows taken, on several threads; the result does not depend on how many.
pub(crate) fn all_taken(windows: &[Window], n_threads: usize) -> Vec<Example> {
    let mut taken: Vec<Option<Example>> = vec![None; windows.len()];
    in_pieces(
        &mut taken,
        1,
        n_threads,
        || (),
        |(), number, piece| {
            piece[0] = Some(windows[number].taken());
        },
    );
    taken.into_iter().flatten().collect()
}

impl Example {
    /// Of a fabric that was given: its strip from a column on, and what was felt there.
    pub(crate) fn given(name: &str, column: usize, strip: Grid<f32>, trace: &[f64]) -> Self {
        Self {
            cloth: name.to_owned(),
            column,
            window: None,
            square: OnceLock::new(),
            looks: Looks::of(&strip),
            strip,
            course: Course::of(trace),
            of_surface: trace.to_vec(),
            trace: trace.to_vec(),
        }
    }

    /// The picture around the middle of the finger's path, [`SQUARE`] a side, brightness 0 to 1; of
    /// a fabric that was given the strip, mirrored beyond its edges.
    pub(crate) fn square(&self) -> Grid<f32> {
        let square = self.square.get_or_init(|| {
            let [n, height] = [self.strip.width(), self.strip.height()];
            let left = n.saturating_sub(SQUARE) / 2;
            let Some(window) = self.window else {
                let below = SQUARE.saturating_sub(height) / 2;
                let row = |row: usize| mirrored(row.cast_signed() - below.cast_signed(), height);
                let shade = |x: usize, y: usize| self.strip.row(row(y))[(left + x).min(n - 1)];
                return Grid::from_fn(SQUARE, SQUARE, |x, y| {
                    to_byte(f64::from(255.0 * shade(x, y)))
                });
            };
            let recipe = Recipe::of(window.family, window.seed);
            let around = Area {
                columns: [window.area.columns[0] + left, SQUARE],
                rows: [0, SQUARE],
            };
            let camera = Camera::of(window.take);
            let square = recipe.photo(&recipe.relief_um(around), around, &camera);
            square.map(|v| to_byte(f64::from(255.0 * v)))
        });
        square.map(|v| f32::from(v) / 255.0)
    }

    /// The best that anybody could predict: what hangs on the surface, and the mean of what
    /// differs from stroke to stroke. Of a fabric that was given nothing but the answer is known.
    pub(crate) fn best_possible(&self) -> Course {
        let Some(window) = self.window else {
            return self.course.clone();
        };
        let recipe = Recipe::of(window.family, window.seed);
        let stroke = |n: u64| {
            let take = u64::MAX - n;
            Course::of(&recipe.once_more(&self.of_surface, window.area, take))
        };
        let strokes: Vec<Course> = (0..N_STROKES).map(stroke).collect();
        let share = 1.0 / N_STROKES as f32;
        let mut log_magnitudes = self.course.log_magnitudes.map(|_| 0.0);
        for stroke in &strokes {
            let sums = log_magnitudes.values_mut().iter_mut();
            sums.zip(stroke.log_magnitudes.values())
                .for_each(|(sum, log)| *sum += share * log);
        }
        Course {
            log_magnitudes,
            ..Course::of(&self.of_surface)
        }
    }
}

/// A place beyond the edges of `n` brought back within, there and back again.
fn mirrored(place: isize, n: usize) -> usize {
    let n = n.cast_signed();
    let turn = place.rem_euclid(2 * n);
    turn.min(2 * n - 1 - turn).cast_unsigned()
}

impl Split {
    /// Cloths of each family that are learnt from.
    pub const N_CLOTHS: usize = 150;

    /// Windows to learn from, and those that are held back. `scale` cloths of each family are
    /// learnt from ([`Self::N_CLOTHS`] is what results are told of), a quarter of that held back,
    /// at most 20; those do not depend on how many are learnt from.
    pub(crate) fn windows(self, scale: usize) -> [Vec<Window>; 2] {
        let n_held_back = (scale / 4).clamp(1, 20);
        match self {
            Self::Cloths => [
                apart(&Family::ALL, 0, scale, 2),
                apart(&Family::ALL, HELD_BACK, n_held_back, 1),
            ],
            Self::Family => {
                let known: Vec<_> = Family::ALL
                    .into_iter()
                    .filter(|&family| family != Family::Twill)
                    .collect();
                [
                    apart(&known, 0, scale, 2),
                    apart(&[Family::Twill], HELD_BACK, 4 * n_held_back, 1),
                ]
            }
            Self::Places => [&[0, HOP] as &[usize], &[WINDOW]].map(|starts| {
                cloths(&Family::ALL, 0, scale)
                    .flat_map(|cloth| {
                        starts
                            .iter()
                            .map(move |&from| at(cloth, [from, SHORT_WINDOW]))
                    })
                    .collect()
            }),
            Self::Leaky => leaky(scale),
        }
    }
}

/// Cloths of each family from a seed on.
fn cloths(families: &[Family], from: u64, n: usize) -> impl Iterator<Item = (Family, u64)> {
    families
        .iter()
        .flat_map(move |&family| (from..from + n as u64).map(move |seed| (family, seed)))
}

/// One window of a cloth, taken in a way of its own.
fn at((family, seed): (Family, u64), columns: [usize; 2]) -> Window {
    let take = Random::new(seed)
        .branch(&format!("{} {}", family.word(), columns[0]))
        .seed();
    Window {
        family,
        seed,
        area: Area {
            columns,
            rows: [(SQUARE - FINGER_ROWS) / 2, FINGER_ROWS],
        },
        take,
    }
}

/// So many windows of each cloth, far from each other.
fn apart(families: &[Family], from: u64, n_cloths: usize, n_windows: usize) -> Vec<Window> {
    cloths(families, from, n_cloths)
        .flat_map(|cloth| (0..n_windows).map(move |n| at(cloth, [n * 2 * WINDOW, WINDOW])))
        .collect()
}

/// Windows two pixels apart, eight of nine learnt from.
fn leaky(scale: usize) -> [Vec<Window>; 2] {
    let starts = (0..=TRACE - WINDOW).step_by(2).take(2 * scale);
    let mut windows: Vec<Window> = cloths(&Family::ALL, 0, 1)
        .flat_map(|cloth| starts.clone().map(move |from| at(cloth, [from, WINDOW])))
        .collect();
    Random::new(669).shuffle(&mut windows);
    let held_back = windows.split_off(windows.len() - windows.len() / 9);
    [windows, held_back]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether both see the same place of the same cloth.
    fn overlap(one: &Window, other: &Window) -> bool {
        let [a, b] = [one, other].map(|window| window.area.columns);
        let is_same = (one.family, one.seed) == (other.family, other.seed);
        is_same && a[0] < b[0] + b[1] && b[0] < a[0] + a[1]
    }

    #[test]
    fn nothing_that_is_held_back_was_seen() {
        for split in [Split::Cloths, Split::Family, Split::Places] {
            let [learnt, held_back] = split.windows(8);
            assert!(!held_back.is_empty());
            for test in &held_back {
                let leak = learnt.iter().find(|window| overlap(window, test));
                assert_eq!(leak, None, "{split:?}: {test:?}");
                if split == Split::Places {
                    let same = |w: &&Window| (w.family, w.seed) == (test.family, test.seed);
                    let end = learnt
                        .iter()
                        .filter(same)
                        .map(|w| w.area.columns[0] + SHORT_WINDOW);
                    let gap = test.area.columns[0] - end.max().unwrap();
                    assert!(gap >= 640, "{gap} samples");
                }
                if split == Split::Family {
                    assert!(learnt.iter().all(|window| window.family != test.family));
                }
            }
        }
        let [learnt, held_back] = Split::Leaky.windows(8);
        let leaks = held_back
            .iter()
            .filter(|test| learnt.iter().any(|w| overlap(w, test)));
        assert_eq!(leaks.count(), held_back.len(), "the leaky split leaks");
    }

    #[test]
    fn the_same_windows_are_taken_whatever_the_number_of_threads() {
        let windows = &Split::Places.windows(1)[0][..4];
        let [one, two] = [1, 2].map(|n| all_taken(windows, n));
        for (one, two) in one.iter().zip(&two) {
            assert_eq!((&one.trace, &one.looks), (&two.trace, &two.looks));
        }
    }

    #[test]
    fn nobody_predicts_a_stroke_better_than_the_mean_of_strokes() {
        let example = Split::Places.windows(1)[1][0].taken();
        let miss = |course: &Course| {
            let pairs = course
                .log_magnitudes
                .values()
                .iter()
                .zip(example.course.log_magnitudes.values());
            pairs.map(|(a, b)| f64::from((a - b).abs())).sum::<f64>()
        };
        let best = miss(&example.best_possible());
        let without_noise = miss(&Course::of(&example.of_surface));
        assert!(
            best > 0.0 && best < without_noise,
            "{best} of {without_noise}"
        );
    }
}
