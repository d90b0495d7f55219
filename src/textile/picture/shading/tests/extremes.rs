//! What has no shape, or too much: an outcome for each.

use super::*;
use selvedge_foundation::progress::{CancelFlag, Cancelled};

fn is_finite(found: &Shape) -> bool {
    let numbers = found.height_px.values().iter().chain(&found.residuals);
    numbers.copied().all(f64::is_finite) && found.albedo.is_finite()
}

#[test]
fn one_colour_and_one_pixel_are_flat() {
    for method in Method::ALL {
        for (width, height) in [(1, 1), (1, 9), (2, 2), (7, 1), (33, 20)] {
            for value in [1.0, 0.5, 1e-3] {
                let tile = Grid::filled(width, height, value);
                let found = shape(&tile, light(45.0, 20.0), method).unwrap();
                assert!(is_finite(&found) && found.is_flat(), "{method:?} {found:?}");
            }
        }
    }
}

#[test]
fn black_empty_and_impossible_brightness_is_refused() {
    let refused = |tile: &Grid<f64>| {
        let error = shape(tile, light(45.0, 20.0), Method::Linear).unwrap_err();
        error.to_string()
    };
    assert!(refused(&Grid::filled(4, 4, 0.0)).contains("black"));
    assert!(refused(&Grid::filled(4, 0, 0.0)).contains("no pixel"));
    for wrong in [f64::NAN, f64::INFINITY, -0.1, 1.5] {
        let mut tile = Grid::filled(4, 4, 0.5);
        tile.row_mut(2)[1] = wrong;
        assert!(refused(&tile).contains("row 3, column 2"), "{wrong}");
    }
    let wide = Grid::filled(MAX_POINTS + 1, 1, 0.5);
    assert!(refused(&wide).contains("scale"));
    assert_eq!(
        LightEstimate::of(&Grid::filled(3, 3, 0.0)),
        Err(ShadingError::Black)
    );
    assert_eq!(
        LightEstimate::of(&Grid::filled(3, 0, 0.0)),
        Err(ShadingError::Empty)
    );
    assert_eq!(
        LightEstimate::of(&Grid::filled(3, 3, f64::NAN)),
        Err(ShadingError::Black)
    );
}

#[test]
fn every_light_has_an_outcome() {
    let e = Truth::egg_crate(16, 2.0).picture(45.0, 20.0);
    for slant in [
        -1.0,
        0.0,
        1.0,
        5.0,
        45.0,
        80.0,
        85.0,
        86.0,
        90.0,
        f64::NAN,
        f64::INFINITY,
    ] {
        for tilt in [-360.0, -45.0, 0.0, 44.9, 135.0, 179.0, 361.0, f64::NAN] {
            for method in Method::OF_SHADING {
                match shape(&e, light(slant, tilt), method) {
                    Ok(found) => {
                        assert!(is_finite(&found), "{slant} {tilt} {method:?}");
                        assert!((2.0..=85.0).contains(&slant), "{slant}");
                        assert!(!found.reliability.is_empty());
                    }
                    Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
                }
            }
        }
    }
}

#[test]
fn the_light_along_which_tsai_and_shah_stand_still_is_refused_with_advice() {
    let e = Truth::egg_crate(16, 2.0).picture(45.0, 135.0);
    for from in [
        light(45.0, 135.0),
        light(45.0, -45.0),
        light(0.0, 0.0),
        light(1.0, 45.0),
    ] {
        let error = shape(&e, from, Method::TsaiShah).unwrap_err();
        if from.slant_deg > 1.0 {
            assert_eq!(error, ShadingError::Singular);
        }
        let error = error.to_string();
        assert!(
            error.contains("turn the picture") || error.contains("front"),
            "{error}"
        );
    }
    let found = shape(&e, light(45.0, 130.0), Method::TsaiShah).unwrap();
    assert!(
        found.reliability.contains("stands still"),
        "{}",
        found.reliability
    );
    let error = shape(&e, light(0.0, 0.0), Method::Variational).unwrap_err();
    assert!(error.to_string().contains("front"), "{error}");
}

#[test]
fn noise_steps_and_wild_options_stay_finite() {
    let mut steps = Grid::filled(24, 24, 0.0);
    for row in 0..24 {
        for column in 0..24 {
            steps.row_mut(row)[column] = if (row / 3 + column / 5) % 2 == 0 {
                1.0
            } else {
                0.0
            };
        }
    }
    for method in Method::ALL {
        for (albedo, regulariser, iterations) in [
            (None, None, Some(1)),
            (Some(1e-3), Some(1e-9), Some(40)),
            (Some(1e3), Some(1e3), Some(3)),
        ] {
            let options = ShadingOptions {
                method,
                iterations,
                albedo,
                regulariser,
                ..ShadingOptions::default()
            };
            for slant in [2.0, 45.0, 85.0] {
                let run = |progress: &mut Progress<'_>| {
                    Shape::from_shading(&steps, light(slant, 30.0), &options, progress)
                };
                let found = Progress::unheard(run).unwrap();
                assert!(is_finite(&found), "{options:?} {slant}");
            }
        }
        for (albedo, regulariser, iterations) in [
            (Some(0.0), None, None),
            (Some(f64::NAN), None, None),
            (None, Some(0.0), None),
            (None, None, Some(0)),
            (None, None, Some(10_001)),
        ] {
            let options = ShadingOptions {
                method,
                iterations,
                albedo,
                regulariser,
                ..ShadingOptions::default()
            };
            let run = |progress: &mut Progress<'_>| {
                Shape::from_shading(&steps, light(45.0, 30.0), &options, progress)
            };
            let error = Progress::unheard(run).unwrap_err();
            assert!(matches!(error, ShadingError::Option { .. }), "{error}");
        }
    }
}

#[test]
fn the_work_tells_how_far_it_is_stops_when_asked_and_repeats() {
    let e = Truth::plain_weave(32, 0.1, 0.1).picture(45.0, 30.0);
    for method in Method::ALL {
        let mut heard = Vec::new();
        let mut report = |share: f64, _: &str| heard.push(share);
        let mut progress = Progress::new(&mut report, CancelFlag::new());
        let from = light(45.0, 30.0);
        let first = Shape::from_shading(&e, from, &with(method), &mut progress).unwrap();
        assert!(heard.windows(2).all(|pair| pair[0] <= pair[1]), "{heard:?}");
        assert_eq!(heard.last(), Some(&1.0));
        assert_eq!(shape(&e, from, method).unwrap(), first);
        let cancel = CancelFlag::new();
        cancel.cancel();
        let mut report = |_: f64, _: &str| {};
        let mut progress = Progress::new(&mut report, cancel);
        let stopped = Shape::from_shading(&e, from, &with(method), &mut progress);
        assert_eq!(stopped, Err(ShadingError::Cancelled(Cancelled)));
    }
}

#[test]
fn a_picture_turned_over_twice_is_itself() {
    let e = Truth::plain_weave(8, 0.1, 0.1).picture(45.0, 30.0);
    let turned = e.turned_over();
    assert_eq!(turned.row(0), e.row(7));
    assert_eq!(turned.turned_over(), e);
}
