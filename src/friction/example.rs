//! Pictures with their traces, taken where a window of a cloth lies, or of a fabric that was given.

use std::sync::{Arc, OnceLock};

use selvedge_foundation::numerics::{Grid, in_pieces, to_byte};

use crate::cloth::{Area, Camera, Family, Recipe, Rubbed};
use crate::picture::Looks;
use crate::signal::Course;

/// Samples of a window: 100 mm.
pub(crate) const WINDOW: usize = 1280;
/// Samples of a short window: 40 mm.
pub(crate) const SHORT_WINDOW: usize = 512;
/// Samples of a whole trace: 155 mm.
pub(crate) const TRACE: usize = 1984;
/// Pixels of a side of the picture that networks of whole pictures see.
pub(crate) const SQUARE: usize = 512;
/// Strokes that the best possible prediction is the mean of.
const N_STROKES: u64 = 16;

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
    /// Whether it is cut from one [`Sheet`] of its cloth that others are cut from, too.
    pub is_cut: bool,
}

/// A whole cloth, photographed once and stroked once.
#[derive(Debug)]
struct Sheet {
    /// [`SQUARE`] rows, brightness 0 to 1.
    photo: Grid<f32>,
    rubbed: Rubbed,
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
    /// What it was cut from.
    sheet: Option<Arc<Sheet>>,
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
        if self.is_cut {
            return self.cut(&Arc::new(Sheet::of(self)));
        }
        let recipe = Recipe::of(self.family, self.seed);
        let relief_um = recipe.relief_um(self.area);
        let rubbed = recipe.rubbed(&relief_um, self.area, self.take);
        let strip = recipe.photo(&relief_um, self.area, &Camera::of(self.take));
        self.with(strip, rubbed)
    }

    /// Its part of a sheet of its cloth.
    fn cut(self, sheet: &Arc<Sheet>) -> Example {
        let [[left, n], [top, height]] = [self.area.columns, self.area.rows];
        let part = |all: &[f64]| all[left..left + n].to_vec();
        let strip = Grid::from_fn(n, height, |x, y| sheet.photo.row(top + y)[left + x]);
        let rubbed = Rubbed {
            friction: part(&sheet.rubbed.friction),
            of_surface: part(&sheet.rubbed.of_surface),
        };
        Example {
            sheet: Some(Arc::clone(sheet)),
            ..self.with(strip, rubbed)
        }
    }

    fn with(self, strip: Grid<f32>, rubbed: Rubbed) -> Example {
        Example {
            cloth: self.family.word().to_owned(),
            column: self.area.columns[0],
            window: Some(self),
            sheet: None,
            square: OnceLock::new(),
            looks: Looks::of(&strip),
            strip,
            course: Course::of(&rubbed.friction),
            trace: rubbed.friction,
            of_surface: rubbed.of_surface,
        }
    }
}

impl Sheet {
    /// The sheet that a window is cut from.
    fn of(window: Window) -> Self {
        let recipe = Recipe::of(window.family, window.seed);
        let columns = [0, TRACE];
        let photographed = Area {
            columns,
            rows: [0, SQUARE],
        };
        let stroked = Area {
            columns,
            rows: window.area.rows,
        };
        let camera = Camera::of(window.take);
        Self {
            photo: recipe.photo(&recipe.relief_um(photographed), photographed, &camera),
            rubbed: recipe.rubbed(&recipe.relief_um(stroked), stroked, window.take),
        }
    }
}

/// Windows taken, on several threads; the result does not depend on how many.
pub(crate) fn all_taken(windows: &[Window], n_threads: usize) -> Vec<Example> {
    let cloth = |window: &Window| (window.family, window.seed);
    let mut cut: Vec<Window> = windows.iter().copied().filter(|w| w.is_cut).collect();
    cut.sort_by_key(cloth);
    cut.dedup_by_key(|window| cloth(window));
    let sheets = on_threads(&cut, n_threads, |window| Arc::new(Sheet::of(*window)));
    on_threads(windows, n_threads, |window| {
        let place = cut.binary_search_by_key(&cloth(window), cloth);
        match place.ok().filter(|_| window.is_cut) {
            Some(place) => window.cut(&sheets[place]),
            None => window.taken(),
        }
    })
}

/// What is made of each item, on several threads.
fn on_threads<T: Sync, U: Clone + Send>(
    items: &[T],
    n_threads: usize,
    make: impl Fn(&T) -> U + Sync,
) -> Vec<U> {
    let mut made: Vec<Option<U>> = vec![None; items.len()];
    in_pieces(
        &mut made,
        1,
        n_threads,
        || (),
        |(), number, piece| {
            piece[0] = Some(make(&items[number]));
        },
    );
    made.into_iter().flatten().collect()
}

impl Example {
    /// Of a fabric that was given: its strip from a column on, and what was felt there.
    pub(crate) fn given(name: &str, column: usize, strip: Grid<f32>, trace: &[f64]) -> Self {
        Self {
            cloth: name.to_owned(),
            column,
            window: None,
            sheet: None,
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
            if let Some(sheet) = &self.sheet {
                let left = self.column + left;
                return Grid::from_fn(SQUARE, SQUARE, |x, y| {
                    to_byte(f64::from(255.0 * sheet.photo.row(y)[left + x]))
                });
            }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::FINGER_ROWS;
    use crate::split::Split;

    #[test]
    fn the_same_windows_are_taken_whatever_the_number_of_threads() {
        let windows = &Split::Places.windows(1)[0][..4];
        let [one, two] = [1, 2].map(|n| all_taken(windows, n));
        for (one, two) in one.iter().zip(&two) {
            assert_eq!((&one.trace, &one.looks), (&two.trace, &two.looks));
        }
    }

    #[test]
    fn windows_of_the_leaky_split_share_all_pixels_and_samples_where_they_overlap() {
        let [learnt, held_back] = Split::Leaky.windows(3);
        for test in held_back {
            let of_cloth = |w: &&Window| (w.family, w.seed) == (test.family, test.seed);
            let distance = |w: &&Window| w.area.columns[0].abs_diff(test.area.columns[0]);
            let near = learnt.iter().filter(of_cloth).min_by_key(distance).unwrap();
            let pair = all_taken(&[test, *near], 2);
            let [a, b] = if pair[0].column < pair[1].column {
                [&pair[0], &pair[1]]
            } else {
                [&pair[1], &pair[0]]
            };
            let shift = b.column - a.column;
            assert!(shift > 0 && shift <= 4, "{shift}");
            assert_eq!(a.trace[shift..], b.trace[..WINDOW - shift]);
            assert_eq!(a.of_surface[shift..], b.of_surface[..WINDOW - shift]);
            let shared = |one: &Grid<f32>, from: usize, width: usize| {
                one.part([from, 0, width, one.height()]).unwrap()
            };
            for (a, b) in [(&a.strip, &b.strip), (&a.square(), &b.square())] {
                let n = a.width() - shift;
                assert!(shared(a, shift, n) == shared(b, 0, n), "{test:?}");
            }
            // The strip is the middle of the same picture.
            let (square, left) = (a.square(), (WINDOW - SQUARE) / 2);
            let middle = square.part([0, test.area.rows[0], SQUARE, FINGER_ROWS]);
            let strip = a.strip.part([left, 0, SQUARE, FINGER_ROWS]).unwrap();
            let bytes = |grid: Grid<f32>| grid.map(|v| to_byte(f64::from(255.0 * v)));
            assert!(bytes(middle.unwrap()) == bytes(strip));
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
