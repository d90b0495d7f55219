//! What estimates of a lattice and the steps of the pipeline cost.

use std::convert::Infallible;

use super::analysed;
use super::lattice::shortest;
use super::spoilt::Spoilt;
use crate::{Bench, Row};
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_textile::picture::{
    Autocorrelation, DirectionOptions, EvenLight, Lattice, Maxima, Measured, Measurements,
    SignificantMaxima, even_light, refine,
};

/// What estimates and steps cost on one usual picture.
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
    rows.extend(steps(&picture, n, bench));
}

/// A row without an error for every step of the pipeline.
fn steps(picture: &Grid<f64>, n: usize, bench: &Bench<'_>) -> Vec<Row> {
    let (light, _) = even_light(picture, EvenLight::Auto);
    let rho = Autocorrelation::of(&light, 1);
    let maxima = Maxima::of(&rho);
    let significant = SignificantMaxima::of(&maxima, &rho);
    let options = DirectionOptions::default();
    let directions = selvedge_textile::picture::Directions::of(&significant, options);
    let measured = Measurements {
        rho,
        maxima,
        significant,
        directions,
    };
    let lattice = measured.lattice();
    let mut costs = vec![
        (
            "light",
            bench.time_repeated(n, 1, || even_light(picture, EvenLight::Auto)),
        ),
        (
            "autocorrelation",
            bench.time_repeated(n, 1, || Autocorrelation::of(&light, 1)),
        ),
        (
            "maxima",
            bench.time_repeated(n, 1, || Maxima::of(&measured.rho)),
        ),
        (
            "directions by mean concentration",
            bench.time_repeated(n, 1, || {
                Measured::by_concentration(&measured.significant, options)
            }),
        ),
        (
            "directions by Hough",
            bench.time_repeated(n, 1, || Measured::by_hough(&measured.significant, options)),
        ),
        ("lattice", bench.time_repeated(n, 1, || measured.lattice())),
    ];
    if let Some(basis) = lattice.as_ref().ok().map(Lattice::basis) {
        costs.push((
            "refining",
            bench.time_repeated(n, 1, || {
                refine(&light, basis, 1, |_| Ok::<(), Infallible>(()))
            }),
        ));
    }
    let row = |(name, cost): (&str, crate::Timing)| Row {
        method: format!("step: {name}"),
        case: "usual".to_owned(),
        size: Some(picture.values().len() as f64),
        cost: Some(cost),
        ..Row::default()
    };
    costs.into_iter().map(row).collect()
}
