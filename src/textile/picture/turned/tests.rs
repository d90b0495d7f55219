//! Rendered cloth, photographed turned: where it lies, and what several pictures tell of it.

use std::f64::consts::FRAC_PI_2;

use super::super::brightness::Brightness;
use super::super::light::mean_and_variance;
use super::super::shading::Light;
use super::super::source::between;
use super::*;
use crate::{Ensemble, HeightScale, Lamp, PictureTextile};
use selvedge_foundation::numerics::Random;

const LAMP: Light = Light {
    slant_deg: 45.0,
    tilt_deg: 30.0,
};
/// Of the cloth and of pictures, px.
const CLOTH: usize = 420;
const SIZE: [usize; 2] = [280, 260];
/// From yarn to yarn, px.
const PITCH: f64 = 9.0;

/// A piece of plain weave, px; yarns differ by this share of a pitch, and hairs lie on them so
/// high, px.
struct Cloth {
    heights: Grid<f64>,
    slopes: [Grid<f64>; 2],
}

impl Cloth {
    fn woven(seed: u64, uneven: f64, hairs_px: f64) -> Self {
        let mut random = Random::new(seed);
        let n = to_index(CLOTH as f64 / PITCH) + 2;
        let mut yarns = || -> Vec<[f64; 2]> {
            (0..n)
                .map(|_| {
                    [
                        uneven * random.normal(),
                        1.0 + 2.0 * uneven * random.normal(),
                    ]
                })
                .collect()
        };
        let (ends, picks) = (yarns(), yarns());
        let mut hairs = Grid::filled(CLOTH, CLOTH, 0.0);
        for value in hairs.values_mut() {
            *value = random.normal();
        }
        for _ in 0..2 {
            let rows = Grid::from_fn(CLOTH, CLOTH, |x, y| {
                (0..5).map(|i| hairs.row(y)[(x + i) % CLOTH]).sum::<f64>() / 5.0_f64.sqrt()
            });
            hairs = rows.transposed();
        }
        let heights = Grid::from_fn(CLOTH, CLOTH, |x, y| {
            let [u, v] = [x, y].map(|at| at as f64 / PITCH);
            let (end, pick) = (ends[to_index(u)], picks[to_index(v)]);
            let inside = |at: f64, moved: f64| (2.0 * (at.fract() + moved) - 1.0).clamp(-1.0, 1.0);
            let (a, b) = (inside(u, end[0]), inside(v, pick[0]));
            let sign = if (to_index(u) + to_index(v)).is_multiple_of(2) {
                1.0
            } else {
                -1.0
            };
            let warp = sign * (FRAC_PI_2 * b).cos() * end[1] + 1.0 - a * a;
            let weft = -sign * (FRAC_PI_2 * a).cos() * pick[1] + 1.0 - b * b;
            0.12 * PITCH * warp.max(weft) + hairs_px * hairs.row(y)[x]
        });
        let at = |x: usize, y: usize| heights.row(y.min(CLOTH - 1))[x.min(CLOTH - 1)];
        let slopes = [[1, 0], [0, 1]].map(|[i, j]| {
            Grid::from_fn(CLOTH, CLOTH, |x, y| {
                0.5 * (at(x + i, y + j) - at(x.saturating_sub(i), y.saturating_sub(j)))
            })
        });
        Self { heights, slopes }
    }

    fn map(turn_deg: f64, scale: f64, shift: Place) -> Similarity {
        let middle = SIZE.map(|n| 0.5 * (n as f64 - 1.0));
        Similarity::new(
            [
                [0.5 * (CLOTH as f64 - 1.0); 2],
                mix(middle, 1.0, shift, 1.0),
            ],
            turn_deg,
            scale,
        )
    }

    /// Its picture where the map puts it: shaded, with noise, in so many steps.
    fn photograph(&self, map: Similarity, (noise, steps): (f64, f64), seed: u64) -> Grid<f64> {
        let mut random = Random::new(seed);
        let back = |[x, y]: Place| map.back([x, y]);
        let (s, c) = map.turn_deg().to_radians().sin_cos();
        let lean = LAMP.lean();
        Grid::from_fn(SIZE[0], SIZE[1], |x, y| {
            let place = back([x as f64, y as f64]);
            let [p, q] =
                [0, 1].map(|axis| between(&self.slopes[axis], place, |a, b, t| a + (b - a) * t));
            // Turned as the cloth is; y up.
            let (p, q) = (c * p + s * q, s * p - c * q);
            let facing = 1.0 - p * lean[0] - q * lean[1];
            let norm = ((1.0 + p * p + q * q) * (1.0 + lean[0].hypot(lean[1]).powi(2))).sqrt();
            let seen = 0.8 * facing.max(0.0) / norm + noise * random.normal();
            (seen.clamp(0.0, 1.0) * steps).round() / steps
        })
    }
}

const EIGHT_BITS: (f64, f64) = (0.02, 255.0);
const SIXTEEN_BITS: (f64, f64) = (0.005, 65535.0);

fn first(cloth: &Cloth) -> Grid<f64> {
    cloth.photograph(Cloth::map(0.0, 1.0, [0.0; 2]), SIXTEEN_BITS, 1)
}

fn laid(first: &Grid<f64>, other: &Grid<f64>) -> Result<Turned, PictureError> {
    Progress::unheard(|p| Turned::of(first, (other, Path::new("b.png")), 2, p))
}

#[test]
fn a_turned_cloth_is_found_to_a_fraction_of_a_pixel() {
    let cloth = Cloth::woven(3, 0.03, 0.1);
    let first = first(&cloth);
    let back = Cloth::map(0.0, 1.0, [0.0; 2]);
    for (i, (turn_deg, scale, shift, taken)) in [
        (17.0, 1.0, [13.0, -9.5], EIGHT_BITS),
        (90.0, 1.02, [-8.0, 4.0], SIXTEEN_BITS),
        (143.0, 0.985, [5.5, 11.0], EIGHT_BITS),
    ]
    .into_iter()
    .enumerate()
    {
        let true_map = Cloth::map(turn_deg, scale, shift);
        let other = cloth.photograph(true_map, taken, 10 + i as u64);
        let found = laid(&first, &other).unwrap();
        let turn_off = found.map.turn_deg() - turn_deg;
        let off = [[40.0, 40.0], [240.0, 40.0], [140.0, 130.0], [40.0, 220.0]].map(|place| {
            let truth = true_map.at(back.back(place));
            length(mix(found.map.at(place), 1.0, truth, -1.0))
        });
        let most = off.into_iter().fold(0.0, f64::max);
        assert!(
            turn_off.abs() < 0.1 && most < 0.4,
            "{turn_deg}°: {turn_off}°, {most} px"
        );
        assert!(found.score > 0.5, "{turn_deg}°: {}", found.score);
    }
}

#[test]
fn another_cloth_is_refused_by_name_and_so_is_one_that_fits_everywhere() {
    let first = first(&Cloth::woven(3, 0.03, 0.1));
    let other = Cloth::woven(4, 0.03, 0.1);
    for turn_deg in [0.0, 90.0] {
        let other = other.photograph(Cloth::map(turn_deg, 1.0, [0.0; 2]), EIGHT_BITS, 5);
        let error = laid(&first, &other).unwrap_err().to_string();
        assert!(
            error.starts_with("b.png: it does not show the cloth"),
            "{error}"
        );
    }
    let even = Cloth::woven(1, 0.0, 0.0);
    let first = even.photograph(Cloth::map(0.0, 1.0, [0.0; 2]), SIXTEEN_BITS, 7);
    let other = even.photograph(Cloth::map(90.0, 1.0, [0.0; 2]), SIXTEEN_BITS, 8);
    let error = laid(&first, &other).unwrap_err().to_string();
    assert!(
        error.contains("b.png: it ") && error.contains("match"),
        "{error}"
    );
    for tiny in [
        Grid::filled(1, 1, 0.5),
        Grid::filled(400, 63, 0.5),
        Grid::filled(0, 0, 0.5),
    ] {
        let error = laid(&first, &tiny).unwrap_err().to_string();
        assert!(error.contains("64 px or more"), "{error}");
    }
    let flat = Grid::filled(200, 200, 0.5);
    assert!(laid(&first, &flat).is_err(), "one colour");
}

/// Levels that are off from the truth, and how wide their bands are, dB; whether each holds it; and
/// how the kept relief correlates with the truth.
fn judged(brightness: &Brightness, truth: &Grid<f64>) -> ([f64; 4], [f64; 4], usize, f64) {
    let about = PictureTextile {
        px_per_mm: 18.0,
        scale: HeightScale::SmdUm(6.0),
        ..PictureTextile::default()
    };
    let (ensemble, mut shape) = Progress::unheard(|p| {
        let all = Ensemble::of(brightness, &about, Lamp::Unknown, 2, p).unwrap();
        let shape = all.shape(&about).unwrap();
        (all, shape)
    });
    let [mean_z, mean_t] = [&shape.height_px, truth].map(|grid| mean_and_variance(grid).0);
    let pairs = shape.height_px.values().iter().zip(truth.values());
    let sums = pairs.fold([0.0; 3], |[zz, tt, zt], (z, t)| {
        let (z, t) = (z - mean_z, t - mean_t);
        [zz + z * z, tt + t * t, zt + z * t]
    });
    let r = sums[2] / (sums[0] * sums[1]).sqrt();
    shape.height_px = truth.clone();
    let levels = ensemble.levels(about.levels_db(&shape).unwrap());
    let each = |of: fn(&[f64; 4]) -> f64| [0, 1, 2, 3].map(|i| of(&levels[i]));
    let off = each(|[.., low, high]| (0.5 * (low + high)).abs());
    let wide = each(|[.., low, high]| high - low);
    let n_held = levels
        .iter()
        .filter(|[.., low, high]| *low <= 0.0 && 0.0 <= *high);
    (off, wide, n_held.count(), r)
}

#[test]
fn turned_pictures_under_an_unknown_light_tell_more_than_one_and_say_so() {
    let cloth = Cloth::woven(5, 0.03, 0.05);
    let first = first(&cloth);
    let others = [(62.0, [6.0, -5.0]), (141.0, [-9.0, 4.0])].map(|(turn_deg, shift)| {
        let map = Cloth::map(turn_deg, 1.0, shift);
        laid(&first, &cloth.photograph(map, EIGHT_BITS, 20)).unwrap()
    });
    let region = Turned::common(&others).unwrap();
    let corner = SIZE.map(|n| (CLOTH - n) / 2);
    let heights = cloth.heights.part([corner[0], corner[1], SIZE[0], SIZE[1]]);
    let heights = heights.unwrap().part(region).unwrap();
    // Cut and faded as the pictures are.
    let [low, high] = selvedge_foundation::numerics::extent(heights.values().iter().copied());
    let shares = heights.map(|z| (z - low) / (high - low));
    let truth = Brightness::of_picture(&shares, 0.0).values;
    let alone = Brightness::of_picture(&first.part(region).unwrap(), 0.0);
    let both = Brightness::of_turned(&first, &others, None).unwrap();
    assert_eq!(both.values, alone.values);
    // Levels off by 4.8 dB in all with one picture, 0.7 with three, when this was written.
    let [one, three] = [&alone, &both].map(|brightness| judged(brightness, &truth));
    let light = both.estimated_light().unwrap().light;
    let sum = |all: [f64; 4]| all.iter().sum::<f64>();
    assert!((light.tilt_deg - LAMP.tilt_deg).abs() < 8.0, "{light:?}");
    assert!(three.3 > 0.98 && three.3 > one.3.abs(), "{three:?} {one:?}");
    assert!(sum(three.0) < 0.5 * sum(one.0), "{three:?} {one:?}");
    assert!(sum(three.1) < 0.8 * sum(one.1), "{three:?} {one:?}");
    assert_eq!(three.2, 4, "{three:?}");
}
