//! Amplitudes tick by tick: what one contactor feels on strokes over the shipped textiles, and
//! steps.

use std::f64::consts::TAU;

use crate::{ReportError, textiles};
use selvedge_foundation::geometry::{Displacement, Point};
use selvedge_foundation::numerics::Random;
use selvedge_render::array::Method;
use selvedge_render::scene::{ExplorationPath, LoadedScene, PathRow, Pose};
use selvedge_render::{RenderScene, single};

/// A case: its name, and `[A40, A320]` of every tick, µm.
pub(super) type Case = (String, Vec<[f32; 2]>);

/// The contactor that is listened to: in the middle of the display.
const CONTACTOR: usize = 9;
/// Half the way of the stroke, mm, and its rounds a second.
const REACH: Displacement = Displacement::new(24.0, 9.0);
const ROUNDS_PER_S: f64 = 0.7;
/// The level between which steps go, µm.
const HIGHEST_UM: f64 = 20.0;
/// Ticks that a step's level stays.
const STEP_TICKS: usize = 4;

/// A stroke back and forth over each of the first `n_textiles` of the shipped scene.
pub(super) fn strokes(n_textiles: usize, n_ticks: usize) -> Result<Vec<Case>, ReportError> {
    let loaded = LoadedScene::shipped()?;
    let scene = RenderScene::of(&loaded);
    let mut cases = Vec::new();
    for placed in loaded.scene().textiles.iter().take(n_textiles) {
        let [width_mm, height_mm] = placed.size_mm;
        let middle = placed.origin_mm + Displacement::new(0.5 * width_mm, 0.5 * height_mm);
        let amplitudes = felt(&scene, &back_and_forth(middle, n_ticks)?)?;
        cases.push((format!("stroke over {}", placed.id), amplitudes));
    }
    Ok(cases)
}

/// Levels that are drawn at random and stay for some ticks each, silence among them.
pub(super) fn steps(n_ticks: usize, mut random: Random) -> Case {
    let mut amplitudes = Vec::with_capacity(n_ticks);
    let mut now = [0.0; 2];
    for tick in 0..n_ticks {
        if tick % STEP_TICKS == 0 {
            let mut level = || single(random.index(5) as f64 * 0.25 * HIGHEST_UM);
            now = [level(), level()];
        }
        amplitudes.push(now);
    }
    ("steps every 100 ms".to_owned(), amplitudes)
}

fn back_and_forth(middle: Point, n_ticks: usize) -> Result<ExplorationPath, ReportError> {
    let row = |tick: usize| {
        let t_s = tick as f64 / 40.0;
        let share = (TAU * ROUNDS_PER_S * t_s).sin();
        PathRow {
            t_s,
            position: middle + Displacement::new(share * REACH.x_mm, share * REACH.y_mm),
            ..PathRow::default()
        }
    };
    Ok(ExplorationPath::new(
        (0..n_ticks.max(1)).map(row).collect(),
    )?)
}

fn felt(scene: &RenderScene, path: &ExplorationPath) -> Result<Vec<[f32; 2]>, ReportError> {
    let mut renderer = textiles::prepared(scene, Method::Auto)?;
    let mut poses = vec![Pose::default(); scene.displays.len()];
    let at_pose = |(_, pose): (_, Pose)| {
        poses.fill(pose);
        let frame = renderer.tick(&poses).first();
        let of_contactor = frame.and_then(|frame| frame.amplitudes_um().get(CONTACTOR));
        of_contactor.copied().unwrap_or_default()
    };
    Ok(path.ticks().map(at_pose).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stroke_over_a_textile_is_felt_and_varies() {
        for (name, amplitudes) in strokes(4, 80).unwrap() {
            assert_eq!(amplitudes.len(), 80, "{name}");
            let largest = amplitudes.iter().map(|a| a[1]).fold(0.0, f32::max);
            let smallest = amplitudes
                .iter()
                .skip(1)
                .map(|a| a[1])
                .fold(f32::MAX, f32::min);
            assert!(
                largest > 0.1 && smallest < 0.8 * largest,
                "{name}: {smallest}, {largest} µm"
            );
        }
    }
}
