//! What cloth from a picture costs: the autocorrelation alone, and all stages in a row.

#![expect(clippy::print_stdout, reason = "a bench prints its figures")]

use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::Instant;

use selvedge_foundation::numerics::{Grid, Random, median};
use selvedge_foundation::progress::Progress;
use selvedge_textile::picture::brightness::Brightness;
use selvedge_textile::picture::shading::{ShadingError, ShadingOptions};
use selvedge_textile::picture::{
    Analysis, AnalysisOptions, Autocorrelation, DirectionOptions, EvenLight, Picture, Relief,
    ReliefOf,
};
use selvedge_textile::{Ensemble, HeightScale, Lamp, PictureTextile, TextileError};

const ROUNDS: usize = 5;

fn main() {
    for n_threads in [1, 2] {
        for side in [1024, 2362] {
            let picture = weave(side);
            let seconds = timed(|| {
                black_box(Autocorrelation::of(&picture, n_threads));
            });
            println!("autocorrelation of {side} × {side}, {n_threads} threads: {seconds:.3} s");
        }
        for side in [1024, 2362] {
            let picture = Picture::grey(weave(side));
            let options = AnalysisOptions {
                light: EvenLight::Auto,
                directions: DirectionOptions::default(),
                n_threads,
            };
            let seconds = timed(|| {
                let analysis =
                    Progress::unheard(|progress| Analysis::of(picture.clone(), &options, progress));
                let is_found = analysis.is_ok_and(|analysis| analysis.found.is_ok());
                assert!(black_box(is_found), "the bench's weave has a lattice");
            });
            println!("all stages of {side} × {side}, {n_threads} threads: {seconds:.3} s");
            let seconds = timed(|| {
                let files = felt(picture.clone(), &options);
                assert!(black_box(files.is_ok_and(|n| n > 0)), "it can be felt");
            });
            println!("a textile of {side} × {side}, {n_threads} threads: {seconds:.3} s");
        }
    }
}

/// A textile of a picture whose light nobody knows; how many files it has.
fn felt(picture: Picture, options: &AnalysisOptions) -> Result<usize, TextileError> {
    Progress::unheard(|progress| {
        let analysis = Analysis::of(picture, options, progress)?;
        let found = analysis.found.as_ref().ok();
        let ground = (ReliefOf::Picture, &analysis.luminance);
        let brightness = Brightness::ground(ground, found, None, options.n_threads);
        let brightness = brightness.ok_or(ShadingError::Empty)?;
        let mut about = PictureTextile {
            name: "Weave".to_owned(),
            px_per_mm: 24.0,
            scale: HeightScale::SmdUm(5.0),
            size_px: Some(brightness.size_px),
            ..PictureTextile::default()
        };
        // Another relief is kept than the first.
        let shading = ShadingOptions {
            iterations: Some(1),
            ..ShadingOptions::default()
        };
        let mut relief = Relief::of(brightness, None, &shading, progress)?;
        let (own, n) = ((&mut relief, false), options.n_threads);
        Ensemble::believe(own, &mut about, Lamp::Unknown, n, progress)?;
        let tile = found.map(|found| &found.tile);
        let made = PictureTextile::files_of(&relief.shape, &relief.brightness, tile, &about)?;
        Ok(made.files.len())
    })
}

/// The median time of several rounds.
fn timed(mut work: impl FnMut()) -> f64 {
    let mut round = |_| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64()
    };
    median(&mut (0..ROUNDS).map(&mut round).collect::<Vec<f64>>())
}

/// A turned weave with as much noise as signal, in uneven light.
fn weave(side: usize) -> Grid<f64> {
    let mut random = Random::new(1);
    let value = |i: usize| {
        let (x, y) = ((i % side) as f64, (i / side) as f64);
        let (u, v) = (0.061 * x + 0.007 * y, 0.055 * y - 0.006 * x);
        let threads = (TAU * u).cos() + (TAU * v).cos() + (TAU * 0.5 * (u + v)).cos();
        let light = 0.8 + 0.4 * x / side as f64;
        light * (0.5 + 0.1 * threads + 0.12 * random.normal())
    };
    let values = (0..side * side).map(value).collect();
    Grid::from_rows(side, values).unwrap_or_else(|| Grid::filled(1, 1, 0.0))
}
