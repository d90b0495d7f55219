//! Pictures of known lattices, spoiled in every way at once; extreme pictures.

use std::f64::consts::{PI, TAU};

use super::*;
use selvedge_foundation::files::FileError;
use selvedge_foundation::numerics::{Grid, Random, to_whole};
use selvedge_foundation::progress::{CancelFlag, Progress};

const WIDTH: usize = 360;
const HEIGHT: usize = 320;

fn options(n_threads: usize) -> AnalysisOptions {
    AnalysisOptions {
        light: EvenLight::Auto,
        directions: DirectionOptions::default(),
        n_threads,
    }
}

fn analysed(luminance: Grid<f64>) -> Analysis {
    Progress::unheard(|progress| Analysis::of(Picture::grey(luminance), &options(2), progress))
        .unwrap()
}

/// A picture of a value at every pixel.
fn drawn(width: usize, height: usize, mut value: impl FnMut(f64, f64) -> f64) -> Grid<f64> {
    let places = (0..width * height).map(|i| ((i % width) as f64, (i / width) as f64));
    Grid::from_rows(width, places.map(|(x, y)| value(x, y)).collect()).unwrap()
}

/// A lattice of any size, angle and turn, and a smooth cell with random detail.
struct Cloth {
    basis: Basis,
    /// Orders, cosine and sine amplitudes.
    detail: Vec<([f64; 2], [f64; 2])>,
}

impl Cloth {
    fn random(random: &mut Random) -> Self {
        let lengths = [random.uniform_in(8.0, 30.0), random.uniform_in(8.0, 30.0)];
        let turn = random.uniform_in(0.0, TAU);
        let between = random.uniform_in(50.0, 130.0).to_radians();
        let vector = |length: f64, angle: f64| [length * angle.cos(), length * angle.sin()];
        let basis =
            Basis::new(vector(lengths[0], turn), vector(lengths[1], turn + between)).reduced();
        let mut detail = Vec::new();
        for order in [
            [1.0, 0.0],
            [0.0, 1.0],
            [1.0, 1.0],
            [1.0, -1.0],
            [2.0, 0.0],
            [0.0, 2.0],
            [2.0, 1.0],
        ] {
            let is_first = order.iter().map(|x: &f64| x.abs()).sum::<f64>() < 1.5;
            let amplitude = random.uniform_in(0.3, 1.0) * if is_first { 1.0 } else { 0.5 };
            let phase = random.uniform_in(0.0, TAU);
            detail.push((order, vector(amplitude, phase)));
        }
        Self { basis, detail }
    }

    fn at(&self, place: Place) -> f64 {
        let [u, v] = self.basis.coordinates(place);
        let term = |([m, n], [c, s]): &([f64; 2], [f64; 2])| {
            let turns = TAU * (m * u + n * v);
            c * turns.cos() + s * turns.sin()
        };
        self.detail.iter().map(term).sum()
    }

    fn variance(&self) -> f64 {
        self.detail
            .iter()
            .map(|(_, [c, s])| 0.5 * (c * c + s * s))
            .sum()
    }
}

/// A textile in uneven light, slightly bent, with as much noise as signal, in 8 bits.
fn spoiled(cloth: &Cloth, random: &mut Random) -> Grid<f64> {
    let spread = cloth.variance().sqrt();
    let [bend, phase] = [random.uniform_in(0.2, 0.5), random.uniform_in(0.0, TAU)];
    drawn(WIDTH, HEIGHT, |x, y| {
        let light = 0.7 + 0.5 * x / WIDTH as f64 + 0.1 * (PI * y / HEIGHT as f64).sin();
        let moved = [
            x + bend * (TAU * y / HEIGHT as f64 + phase).sin(),
            y + bend * (PI * x / WIDTH as f64).sin(),
        ];
        let signal = cloth.at(moved) / spread + random.normal();
        ((0.45 + 0.08 * signal) * light * 255.0)
            .round()
            .clamp(0.0, 255.0)
            / 255.0
    })
}

/// What the quantisation of a JPEG of quality 50 leaves of a picture: its table for luminance, on
/// cosine transforms of 8 × 8 pixels.
fn compressed(picture: &Grid<f64>) -> Grid<f64> {
    const TABLE: [[f64; 8]; 8] = [
        [16.0, 11.0, 10.0, 16.0, 24.0, 40.0, 51.0, 61.0],
        [12.0, 12.0, 14.0, 19.0, 26.0, 58.0, 60.0, 55.0],
        [14.0, 13.0, 16.0, 24.0, 40.0, 57.0, 69.0, 56.0],
        [14.0, 17.0, 22.0, 29.0, 51.0, 87.0, 80.0, 62.0],
        [18.0, 22.0, 37.0, 56.0, 68.0, 109.0, 103.0, 77.0],
        [24.0, 35.0, 55.0, 64.0, 81.0, 104.0, 113.0, 92.0],
        [49.0, 64.0, 78.0, 87.0, 103.0, 121.0, 120.0, 101.0],
        [72.0, 92.0, 95.0, 98.0, 112.0, 100.0, 103.0, 99.0],
    ];
    let mut basis = [[0.0; 8]; 8];
    for (k, row) in basis.iter_mut().enumerate() {
        for (i, c) in row.iter_mut().enumerate() {
            let scale = if k == 0 { 0.125_f64.sqrt() } else { 0.5 };
            *c = scale * (PI * (2.0 * i as f64 + 1.0) * k as f64 / 16.0).cos();
        }
    }
    let product = |a: &[[f64; 8]; 8], b: &[[f64; 8]; 8]| {
        std::array::from_fn::<[f64; 8], 8, _>(|i| {
            std::array::from_fn(|j| (0..8).map(|k| a[i][k] * b[k][j]).sum())
        })
    };
    let turned = |a: &[[f64; 8]; 8]| std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]));
    let across = turned(&basis);
    let mut out = picture.clone();
    for top in (0..picture.height()).step_by(8) {
        for left in (0..picture.width()).step_by(8) {
            let block = std::array::from_fn(|j| {
                std::array::from_fn(|i| picture.row(top + j)[left + i] * 255.0 - 128.0)
            });
            let mut spectrum = product(&product(&basis, &block), &across);
            for (row, steps) in spectrum.iter_mut().zip(&TABLE) {
                for (x, step) in row.iter_mut().zip(steps) {
                    *x = (*x / step).round() * step;
                }
            }
            let again: [[f64; 8]; 8] = product(&product(&across, &spectrum), &basis);
            for (j, row) in again.iter().enumerate() {
                for (i, x) in row.iter().enumerate() {
                    out.row_mut(top + j)[left + i] =
                        ((x + 128.0).round().clamp(0.0, 255.0)) / 255.0;
                }
            }
        }
    }
    out
}

#[test]
fn lattices_turned_noisy_bent_shaded_and_compressed_are_found() {
    let mut random = Random::new(20);
    let mut n_right = 0;
    for n in 0..20 {
        let cloth = Cloth::random(&mut random);
        let picture = compressed(&spoiled(&cloth, &mut random));
        match analysed(picture).found {
            Ok(found) => {
                let off = found.lattice.basis().distance_to(&cloth.basis);
                println!(
                    "{n}: {:?} found {:?}, off {off:.3} px",
                    cloth.basis, found.lattice
                );
                n_right += usize::from(off <= 0.2);
            }
            Err(reason) => println!("{n}: {:?}: {reason}", cloth.basis),
        }
    }
    assert!(n_right >= 19, "{n_right} of 20 are right");
}

#[test]
fn a_clean_cloth_is_explained_and_its_tile_is_its_cell() {
    let cloth = Cloth::random(&mut Random::new(3));
    let found = analysed(drawn(WIDTH, HEIGHT, |x, y| 0.5 + 0.1 * cloth.at([x, y])))
        .found
        .unwrap();
    let off = found.lattice.basis().distance_to(&cloth.basis);
    assert!(off < 0.003, "vectors to a small part of a pixel: off {off}");
    assert!(
        found.explained_variance > 0.98,
        "{}",
        found.explained_variance
    );
    assert!(found.lattice.confidence > 0.9, "{:?}", found.lattice);
    for k in 0..50 {
        let place = [3.7 * f64::from(k), 2.9 * f64::from(k % 13)];
        let at = found.tile.at(found.tile.basis().coordinates(place));
        let expected = 0.5 + 0.1 * cloth.at(place);
        assert!((at - expected).abs() < 0.03, "{at} for {expected}");
    }
    assert!(!found.drifts(), "a cloth that lies flat");
}

#[test]
fn of_a_bent_cloth_the_part_that_lies_flat_is_averaged() {
    let cloth = Cloth::random(&mut Random::new(5));
    let bent = |x: f64, y: f64| {
        let fold = ((x + y - 500.0) / 150.0).max(0.0).powi(2);
        0.5 + 0.1 * cloth.at([x + 20.0 * fold, y - 15.0 * fold])
    };
    let found = analysed(drawn(600, 600, bent)).found.unwrap();
    assert!(found.drifts(), "{} explained", found.explained_variance);
    let (part, explained) = found.flat_part.unwrap();
    assert!(
        explained > 2.0 * found.explained_variance && explained > 0.5,
        "{part:?}: {explained}"
    );
    assert_eq!(part[..2], [0, 0], "the flat corner");
    let off = found.tile.basis().distance_to(&cloth.basis);
    assert!(off < 0.1, "the vectors of the flat part: off {off}");
}

#[test]
fn a_weave_repeats_from_every_second_thread_to_every_second() {
    // Threads every 12 and 10 px; warp on top at every second crossing, only slightly brighter.
    let value = |x: f64, y: f64| {
        let threads = (TAU * x / 12.0).cos() + (TAU * y / 10.0).cos();
        0.5 + 0.1 * threads + 0.05 * (PI * x / 12.0).cos() * (PI * y / 10.0).cos()
    };
    let found = analysed(drawn(240, 200, value)).found.unwrap();
    let truth = Basis::new([12.0, 10.0], [12.0, -10.0]);
    assert!(
        found.lattice.basis().distance_to(&truth) < 0.1,
        "{:?}",
        found.lattice
    );
    let sheet = found.tile.rectangle(1.0, 1).unwrap();
    assert!(
        (sheet.size_px[0] - 24.0).abs() < 0.1 && (sheet.size_px[1] - 20.0).abs() < 0.1,
        "{:?}",
        sheet.size_px
    );
    assert_eq!((sheet.values.width(), sheet.values.height()), (24, 20));
    let first = sheet.values.row(0)[0];
    assert!((first - value(0.0, 0.0)).abs() < 0.02, "{first}");
    // The rectangle repeats: what follows its last column is its first.
    let patch = found.tile.patch(49, 1, 0.5, sheet.angle_rad, 1);
    assert!(
        (patch.row(0)[48] - patch.row(0)[0]).abs() < 0.01,
        "{:?}",
        patch.row(0)
    );
}

/// A weave of threads 9 and 8 px apart, turned: at crossing (i, j) the warp lies on top where
/// `(shift·i + j) mod repeat` is 0, and is brighter by a little; threads differ, the camera has
/// noise.
fn woven([shift, repeat]: [f64; 2], random: &mut Random) -> (Grid<f64>, Basis, Basis) {
    let (s, c) = 0.2_f64.sin_cos();
    let threads = Basis::new([9.0 * c, 9.0 * s], [-8.0 * s, 8.0 * c]);
    let truth = Basis::new(threads.place([1.0, -shift]), threads.place([0.0, repeat])).reduced();
    let yarns: Vec<f64> = (0..400).map(|_| 0.02 * random.normal()).collect();
    let picture = drawn(300, 280, |x, y| {
        let [u, v] = threads.coordinates([x, y]);
        let is_warp = (shift * u.floor() + v.floor()).rem_euclid(repeat) < 1.0;
        let at = if is_warp { u } else { v };
        let round = (PI * (at - at.floor())).sin();
        let number = selvedge_foundation::numerics::to_index(at.floor() + 150.0);
        let own = yarns[2 * number.min(199) + usize::from(is_warp)];
        let bright = if is_warp { 0.08 } else { 0.0 };
        0.3 + (0.25 + bright + own) * round + 0.05 * random.normal()
    });
    (picture, threads, truth)
}

#[test]
fn the_repeat_of_a_weave_is_told_from_its_threads_and_named() {
    let mut random = Random::new(9);
    for (weave, name) in [
        ([1.0, 3.0], "twill of 3 threads"),
        ([2.0, 5.0], "satin of 5 threads"),
    ] {
        let (picture, threads, truth) = woven(weave, &mut random);
        let found = analysed(picture).found;
        let lattice = found.unwrap_or_else(|why| panic!("{name}: {why}")).lattice;
        let off = lattice.basis().distance_to(&truth);
        assert!(off < 0.3, "{name}: {lattice:?}, off {off}");
        let grid = lattice.thread_grid;
        let grid = grid.unwrap_or_else(|| panic!("{name}: no threads, {lattice:?}"));
        let off = grid.reduced().distance_to(&threads.reduced());
        assert!(off < 0.3, "{name}: threads {grid:?}, off {off}");
        assert_eq!(lattice.weave_name().as_deref(), Some(name));
        assert!(lattice.held_out.unwrap() > 0.2, "{lattice:?}");
    }
}

#[test]
fn pictures_that_repeat_nowhere_get_no_lattice() {
    let mut random = Random::new(11);
    let mut n_invented = 0;
    for _ in 0..12 {
        let bumps: Vec<[f64; 3]> = (0..160)
            .map(|_| [240.0, 240.0, 1.0].map(|most| random.uniform_in(0.0, most)))
            .collect();
        let picture = drawn(240, 240, |x, y| {
            let bump = |[at_x, at_y, height]: &[f64; 3]| {
                height * (-((x - at_x).powi(2) + (y - at_y).powi(2)) / 50.0).exp()
            };
            0.2 + 0.3 * bumps.iter().map(bump).sum::<f64>()
        });
        n_invented += usize::from(analysed(picture).found.is_ok());
    }
    assert!(n_invented <= 1, "{n_invented} of 12 were given a lattice");
}

/// The reason why a picture has no lattice.
fn reason(luminance: Grid<f64>) -> NoLattice {
    analysed(luminance).found.unwrap_err()
}

#[test]
fn pictures_without_a_lattice_say_why() {
    let mut random = Random::new(6);
    assert_eq!(reason(Grid::filled(1, 1, 0.5)), NoLattice::TooSmall(1, 1));
    assert_eq!(
        reason(Grid::filled(300, 5, 0.5)),
        NoLattice::TooSmall(300, 5)
    );
    assert_eq!(reason(Grid::filled(200, 150, 0.5)), NoLattice::OneColour);
    assert_eq!(reason(Grid::filled(200, 150, 0.0)), NoLattice::OneColour);
    let noise = reason(drawn(200, 150, |_, _| 0.5 + 0.1 * random.normal()));
    assert!(
        matches!(
            noise,
            NoLattice::NotResolved { .. } | NoLattice::Weak { .. }
        ),
        "{noise}"
    );
    let stripes = reason(drawn(200, 150, |x, y| {
        0.5 + 0.2 * (0.6 * x + 0.1 * y).sin()
    }));
    let is_stripes = matches!(
        stripes,
        NoLattice::OneDirection
            | NoLattice::Parallel
            | NoLattice::NotResolved { .. }
            | NoLattice::NothingRepeats
    );
    assert!(is_stripes, "{stripes}");
    let noisy_stripes = reason(drawn(200, 150, |x, _| {
        0.5 + 0.2 * (0.6 * x).sin() + 0.05 * random.normal()
    }));
    assert!(
        !matches!(
            noisy_stripes,
            NoLattice::OneColour | NoLattice::TooSmall(..)
        ),
        "{noisy_stripes}"
    );
    let slope = reason(drawn(200, 150, |x, y| 0.2 + 0.001 * x + 0.002 * y));
    assert!(!slope.to_string().is_empty(), "{slope}");
}

#[test]
fn a_picture_with_less_than_two_periods_has_no_lattice() {
    let cell = |x: f64, y: f64| 0.5 + 0.1 * ((TAU * x / 170.0).cos() + (TAU * y / 160.0).cos());
    let less = reason(drawn(200, 180, cell));
    assert!(
        matches!(
            less,
            NoLattice::NothingRepeats
                | NoLattice::NotResolved { .. }
                | NoLattice::TooFewRepeats { .. }
        ),
        "{less}"
    );
    let two = |x: f64, y: f64| 0.5 + 0.1 * ((TAU * x / 97.0).cos() + (TAU * y / 89.0).cos());
    let few = reason(drawn(200, 180, two));
    assert!(
        matches!(
            few,
            NoLattice::TooFewRepeats { .. }
                | NoLattice::NothingRepeats
                | NoLattice::NotResolved { .. }
        ),
        "{few}"
    );
}

#[test]
fn long_thin_cells_are_found_and_parallel_vectors_are_refused() {
    // Repeats by (40, 0) and (0.7, 3.4).
    let basis = Basis::new([40.0, 0.0], [0.7, 3.4]);
    let cell = |x: f64, y: f64| {
        let [u, v] = basis.coordinates([x, y]);
        0.5 + 0.1 * (TAU * u).cos() + 0.1 * (TAU * v).cos()
    };
    let found = analysed(drawn(300, 200, cell)).found.unwrap();
    assert!(
        found.lattice.basis().distance_to(&basis) < 0.2,
        "{:?}",
        found.lattice
    );
    // A ruler: points along one line through the picture.
    let ruler = drawn(300, 80, |x, y| {
        let is_mark = (y - 40.0).abs() < 0.5 && (x % 12.0) < 0.5;
        if is_mark { 1.0 } else { 0.2 }
    });
    assert_eq!(reason(ruler), NoLattice::Parallel);
}

#[test]
fn the_bytes_of_every_file_are_the_same_for_any_number_of_threads() {
    let mut random = Random::new(12);
    let cloth = Cloth::random(&mut random);
    let picture = Picture::grey(spoiled(&cloth, &mut random));
    let made = |n_threads: usize| {
        let analysis = Progress::unheard(|progress| {
            Analysis::of(picture.clone(), &options(n_threads), progress)
        })
        .unwrap();
        let mut files = Vec::new();
        write_files(analysis, &About::default(), |name, bytes| {
            files.push((name, bytes.to_vec()));
            Ok::<(), FileError>(())
        })
        .unwrap();
        files
    };
    let one = made(1);
    let names: Vec<&str> = one.iter().map(|(name, _)| *name).collect();
    for name in [
        "periodicity.json",
        "autocorrelation.png",
        "maxima.csv",
        "tile.png",
        "synthesized.png",
        "residual.png",
        "overlay.png",
    ] {
        assert!(names.contains(&name), "{name} in {names:?}");
    }
    for n_threads in [2, 3] {
        assert!(one == made(n_threads), "{n_threads} threads");
    }
}

#[test]
fn work_that_is_cancelled_ends() {
    let cancel = CancelFlag::new();
    cancel.cancel();
    let mut nobody = |_: f64, _: &str| {};
    let mut progress = Progress::new(&mut nobody, cancel);
    let picture = Picture::grey(Grid::filled(50, 50, 0.1));
    assert!(
        Analysis::of(picture, &options(1), &mut progress).is_err(),
        "cancelled"
    );
}

#[test]
fn a_printed_pattern_is_told_by_its_colour() {
    let square = |x: f64, y: f64| ((x / 10.0).floor() + (y / 10.0).floor()).rem_euclid(2.0) < 0.5;
    let luminance = drawn(200, 200, |x, y| if square(x, y) { 0.6 } else { 0.4 });
    let shares = |red: f64| [red, 0.33].map(|share| to_whole::<u16>(65535.0 * share));
    let colours = (0..200 * 200_u32).map(|i| {
        let (x, y) = (f64::from(i % 200), f64::from(i / 200));
        shares(if square(x, y) { 0.5 } else { 0.33 })
    });
    let printed = Picture {
        luminance: luminance.clone(),
        colour: Grid::from_rows(200, colours.collect()),
    };
    let dyed = Picture {
        luminance,
        colour: Some(Grid::filled(200, 200, shares(0.5))),
    };
    for (picture, is_printed) in [(printed, true), (dyed, false)] {
        let analysis =
            Progress::unheard(|progress| Analysis::of(picture, &options(1), progress)).unwrap();
        let found = analysis.found.unwrap();
        assert_eq!(found.colour.is_printed(), is_printed, "{:?}", found.colour);
    }
}

#[test]
fn a_lattice_that_is_given_is_judged_by_what_it_explains() {
    let cloth = Cloth::random(&mut Random::new(3));
    let analysis = analysed(drawn(WIDTH, HEIGHT, |x, y| 0.5 + 0.1 * cloth.at([x, y])));
    let measured = analysis.measured.unwrap();
    let read = (&measured.rho, &measured.maxima, &measured.significant);
    let found = analysis.found.unwrap().lattice;
    let given = |basis: Basis| Lattice::given(read, basis).held_out.unwrap();
    let right = given(found.basis());
    let Basis { p1, p2 } = found.basis();
    let wrong = given(Basis::new(
        [1.13 * p1[0], p1[1] + 2.3],
        [p2[0] - 1.7, 0.91 * p2[1]],
    ));
    assert!(right > 0.9 && wrong < 0.9 * right, "{right} and {wrong}");
    let others = Lattice::others(read, &measured.directions, Some(&found));
    assert!(others.len() <= 3, "{others:?}");
    for other in others {
        let off = found.basis().distance_to(&other.basis());
        assert!(off > 0.05 * found.basis().shorter(), "{other:?}");
    }
}
