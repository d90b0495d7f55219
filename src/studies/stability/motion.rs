//! Speeds that cannot be felt, poses that are no numbers, heights and scenes at their ends.

use std::sync::Arc;

use super::case::{Case, Verdict, cases, failed, verdict};
use super::scene::{METHODS, extent_um, moving, placed, range_um, renderer, scene};
use super::scene::{waves, wavy_scene};
use crate::textiles::of_heights;
use selvedge_device::{ArrayProfile, Coder};
use selvedge_foundation::geometry::Point;
use selvedge_render::array::{DisplayFrame, Method};
use selvedge_render::scene::Pose;
use selvedge_textile::surface::Surface;
use selvedge_textile::tactile::{Filters, Levels, MAX_SPEED_MM_PER_S};

/// Speeds, heights and scenes.
pub(super) fn cases() -> Vec<Case> {
    let mut cases = speeds();
    cases.extend(cases! { "heights";
        "heights all equal" => "silent, level none", level_of_equal_heights;
        "heights of 1e−12 µm" => "computed", tiny_heights;
        "heights of 1e12 µm" => "computed, then limited", huge_heights;
    });
    cases.extend(cases! { "scene";
        "no textile" => "silent", no_textile;
        "a hundred textiles overlapping" => "the topmost wins", hundred_overlapping;
        "a display half outside" =>
            "contactors inside sound, the others do not", half_outside;
    });
    cases
}

/// Speeds and places.
fn speeds() -> Vec<Case> {
    let at = |tried: String, pose: Pose, is_counted: bool| {
        let should = if is_counted {
            "silent and counted"
        } else {
            "silent"
        };
        Case::new("speed", tried, should, move || silent_at(pose, is_counted))
    };
    let speeds = [
        ("0", 0.0, false),
        ("1e−300", 1e-300, false),
        ("0.0099", 0.0099, false),
        ("−0.0099", -0.0099, false),
        ("1000/0.23", MAX_SPEED_MM_PER_S, true),
        ("1e6", 1e6, true),
        ("∞", f64::INFINITY, true),
        ("−∞", f64::NEG_INFINITY, true),
        ("NaN", f64::NAN, true),
    ];
    let speeds = speeds
        .map(|(spelt, speed, is_counted)| at(format!("{spelt} mm/s"), moving(speed), is_counted));
    let nowhere = Pose {
        position: Point::new(f64::NAN, f64::INFINITY),
        ..moving(100.0)
    };
    let nowhere = at("a place of NaN and ∞ mm".to_owned(), nowhere, true);
    speeds.into_iter().chain([nowhere]).collect()
}

/// Silence by every method, where 100 mm/s sounds before and after.
fn silent_at(pose: Pose, is_counted: bool) -> Verdict {
    let scene = wavy_scene()?;
    let mut n_counted = 0;
    for method in METHODS {
        let mut renderer = renderer(&scene, method)?;
        let heard =
            [moving(100.0), pose, moving(100.0)].map(|pose| extent_um(&renderer.tick(&[pose])[0]));
        let [before, silent, after] = heard;
        if silent != [0.0; 2] || before != after || before[1] <= 0.0 {
            let [silent, after] = [silent, after].map(range_um);
            return Err(format!("{method:?}: {silent}, then {after}"));
        }
        let counters = renderer.counters();
        n_counted += counters.directions_over_speed + counters.poses_not_finite;
    }
    let came_back = format!("0 µm everywhere by every method, {n_counted} counted");
    verdict((n_counted > 0) == is_counted, came_back)
}

fn level_of_equal_heights() -> Verdict {
    let flat = of_heights(|_| 7.25).map_err(failed)?;
    let level_db = Levels::of(&flat, &Filters::default()).level_db();
    let heard = extent_um(&felt(&flat, Method::Reference)?);
    let level = level_db.map_or_else(|| "none".to_owned(), |level_db| format!("{level_db} dB"));
    let is_kept = heard == [0.0; 2] && level_db.is_none();
    verdict(is_kept, format!("{}, level {level}", range_um(heard)))
}

fn tiny_heights() -> Verdict {
    let mut came_back = Vec::new();
    for method in METHODS {
        let heard = extent_um(&felt(&waves(1e-12)?, method)?);
        let is_computed = heard[1] > 0.0 && heard[1] < 1e-11;
        came_back.push(range_um(heard));
        if !is_computed {
            return Err(format!("{method:?}: {}", range_um(heard)));
        }
    }
    Ok(came_back.swap_remove(0))
}

fn huge_heights() -> Verdict {
    let mut came_back = String::new();
    for method in METHODS {
        let frame = felt(&waves(1e12)?, method)?;
        let heard = extent_um(&frame);
        let mut coder = Coder::new(&ArrayProfile::default(), 24);
        let codes = coder.encode(frame.amplitudes_um(), 1.0);
        let largest = codes
            .iter()
            .map(|[low, high]| u32::from(*low) + u32::from(*high))
            .max();
        let [n_low, n_high] = coder.counters().limited;
        came_back = format!("{}, {} limited", range_um(heard), n_low + n_high);
        let is_limited = n_low + n_high > 0 && largest.is_some_and(|codes| codes <= 65_535);
        if !(heard[1].is_finite() && heard[1] > 1e9 && is_limited) {
            return Err(format!("{method:?}: {came_back}, codes up to {largest:?}"));
        }
    }
    Ok(came_back)
}

fn no_textile() -> Verdict {
    let mut renderer = renderer(&scene(Vec::new()), Method::Auto)?;
    let frame = &renderer.tick(&[moving(100.0)])[0];
    let n_owned = (0..24)
        .filter(|contactor| frame.textile(*contactor).is_some())
        .count();
    let heard = extent_um(frame);
    verdict(heard == [0.0; 2] && n_owned == 0, range_um(heard))
}

fn hundred_overlapping() -> Verdict {
    let (below, top) = (waves(1.0)?, waves(3.0)?);
    let mut textiles = vec![placed(&below, 100.0); 99];
    textiles.push(placed(&top, 100.0));
    let alone = extent_um(&felt(&top, Method::Reference)?);
    let mut renderer = renderer(&scene(textiles), Method::Reference)?;
    let frame = &renderer.tick(&[moving(100.0)])[0];
    let n_topmost = (0..24)
        .filter(|contactor| frame.textile(*contactor) == Some(99))
        .count();
    let is_kept = n_topmost == 24 && extent_um(frame) == alone;
    let came_back = format!("{n_topmost} of 24 contactors feel the topmost, as if it lay alone");
    verdict(is_kept, came_back)
}

fn half_outside() -> Verdict {
    // The columns of the display stand at −3, −1, 1 and 3 mm from its centre.
    let half = scene(vec![placed(&waves(3.0)?, 50.0)]);
    let mut renderer = renderer(&half, Method::Reference)?;
    let frame = &renderer.tick(&[moving(100.0)])[0];
    let sounds = |contactor: &usize| frame.amplitudes_um()[*contactor][0] > 0.0;
    let is_inside = |contactor: &usize| frame.textile(*contactor) == Some(0);
    let n_inside = (0..24).filter(is_inside).count();
    let is_kept =
        n_inside == 12 && (0..24).all(|contactor| sounds(&contactor) == is_inside(&contactor));
    let came_back = format!("{n_inside} of 24 inside; those sound, the others are at 0 µm");
    verdict(is_kept, came_back)
}

/// What a surface feels like at 100 mm/s.
fn felt(surface: &Arc<Surface>, method: Method) -> Result<DisplayFrame, String> {
    let mut renderer = renderer(&scene(vec![placed(surface, 100.0)]), method)?;
    Ok(renderer.tick(&[moving(100.0)])[0].clone())
}
