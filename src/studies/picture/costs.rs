//! What estimates of a lattice and the steps of the pipeline cost.

use std::convert::Infallible;

use super::analysed;
use super::lattice::shortest;
use super::spoilt::Spoilt;
use crate::{Bench, Row, Timing};
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_textile::picture::{
    Autocorrelation, DirectionOptions, Directions, EvenLight, Maxima, Measured, Measurements,
    SignificantMaxima, Tile, even_light,
};

/// Adds what estimates and steps cost on one usual picture.
pub(super) fn of_costs(usual: &Spoilt, rows: &mut Vec<Row>, bench: &Bench<'_>) {
    let picture = usual.picture(0, &Random::new(bench.seed)).luminance;
    let options = DirectionOptions::default();
    let significant = |light: &Grid<f64>| {
        let rho = Autocorrelation::of(light, 1);
        SignificantMaxima::of(&Maxima::of(&rho), &rho)
    };
    let n = bench.effort.pick(2, 7);
    let whole = bench.time_repeated(n, 1, || analysed(&picture));
    let concentration = bench.time_repeated(n, 1, || {
        Measured::by_concentration(&significant(&picture), options)
    });
    let hough = bench.time_repeated(n, 1, || Measured::by_hough(&significant(&picture), options));
    let short = bench.time_repeated(n, 1, || shortest(&significant(&picture)));
    for row in rows.iter_mut() {
        row.cost = match row.method.as_str() {
            "whole pipeline" => Some(whole),
            "mean concentration" => Some(concentration),
            "Hough" => Some(hough),
            "shortest vectors alone" => Some(short),
            _ => None,
        };
    }
    steps(&picture, n, bench, rows);
}

/// Adds a row without an error for every step of the pipeline.
fn steps(picture: &Grid<f64>, n: usize, bench: &Bench<'_>, rows: &mut Vec<Row>) {
    let row = |name: &str, cost: Timing| {
        let row = Row::of(format!("step: {name}"), "", "usual");
        row.size(picture.values().len() as f64).cost(cost)
    };
    let (light, _) = even_light(picture.clone(), EvenLight::Auto);
    let rho = Autocorrelation::of(&light, 1);
    let maxima = Maxima::of(&rho);
    let significant = SignificantMaxima::of(&maxima, &rho);
    let options = DirectionOptions::default();
    let directions = Directions::of(&significant, options);
    let measured = Measurements {
        rho,
        maxima,
        significant,
        directions,
    };
    let of_light = bench.time_repeated(n, 1, || even_light(picture.clone(), EvenLight::Auto));
    rows.push(row("light", of_light));
    let of_rho = bench.time_repeated(n, 1, || Autocorrelation::of(&light, 1));
    rows.push(row("autocorrelation", of_rho));
    let of_maxima = bench.time_repeated(n, 1, || Maxima::of(&measured.rho));
    rows.push(row("maxima", of_maxima));
    let significant = &measured.significant;
    let concentration = || Measured::by_concentration(significant, options);
    let of_concentration = bench.time_repeated(n, 1, concentration);
    rows.push(row("directions by mean concentration", of_concentration));
    let of_hough = bench.time_repeated(n, 1, || Measured::by_hough(significant, options));
    rows.push(row("directions by Hough", of_hough));
    let of_lattice = bench.time_repeated(n, 1, || measured.lattice());
    rows.push(row("lattice", of_lattice));
    if let Ok(lattice) = measured.lattice() {
        let basis = lattice.basis();
        let refining = || Tile::refine(&light, basis, 1, |_| Ok::<(), Infallible>(()));
        rows.push(row("refining", bench.time_repeated(n, 1, refining)));
    }
}
