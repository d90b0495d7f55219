//! The scenes that savings are counted on.

use std::path::Path;

use crate::textiles::{exeter, placed, scene_of, scene_with, shipped, square};
use crate::{Effort, ReportError};
use selvedge_foundation::geometry::{Point, Velocity};
use selvedge_render::scene::{LoadedScene, Pose, Stroke, TICKS_PER_S};
use selvedge_render::{PlacedSurface, RenderScene};
use selvedge_textile::tactile::Tuning;

/// The scene of all textiles of the library.
pub(super) const ALL_SIXTEEN: &str = include_str!("../../../assets/scenes/all-sixteen.scene.toml");

/// How long every stroke takes, s.
const SECONDS: f64 = 2.0;

/// A scene and the poses that it is felt at.
#[derive(Debug, Clone)]
pub(super) struct Case {
    pub(super) name: &'static str,
    pub(super) scene: RenderScene,
    pub(super) poses: Vec<Pose>,
}

impl Case {
    /// Contactors of its one display.
    pub(super) fn n_contactors(&self) -> usize {
        self.scene.displays[0].offsets.len()
    }
}

/// Seven of them.
pub(super) fn cases(effort: Effort) -> Result<Vec<Case>, ReportError> {
    let n_ticks = effort.pick(12, 80);
    let alone = scene_with(&shipped("denim")?);
    let four = ungained(&LoadedScene::shipped()?);
    let sixteen = ungained(&LoadedScene::from_toml(
        ALL_SIXTEEN,
        Path::new("all-sixteen.scene.toml"),
    )?);
    let hundred = scene_of(overlapping(&sixteen.textiles, 100), exeter());
    let mut many = four.clone();
    many.displays = vec![square(10_000)];
    let still = Pose {
        position: Point::new(60.0, 60.0),
        velocity: Velocity::ZERO,
        ..Pose::default()
    };
    // Around the middle of the scene, over one textile after another and the gaps between.
    let across = |middle_mm: f64| circle(middle_mm, 70.0, n_ticks);
    let case = |name, scene, poses| Case { name, scene, poses };
    Ok(vec![
        case("one textile at rest", alone.clone(), vec![still; n_ticks]),
        case("one textile", alone.clone(), swing(n_ticks)),
        case("one textile, turning", alone, turning(n_ticks)),
        case("four alternatives", four, across(130.0)),
        case("sixteen", sixteen, across(170.0)),
        case("a hundred overlapping", hundred, swing(n_ticks)),
        case("10,000 contactors", many, across(130.0)),
    ])
}

/// A loaded scene without any gain, so that amplitudes are those of the surfaces.
fn ungained(loaded: &LoadedScene) -> RenderScene {
    let mut scene = RenderScene::of(loaded);
    scene.tuning = Tuning::default();
    for placed in &mut scene.textiles {
        placed.manifest_gain_db = 0.0;
        placed.scene_gain_db = 0.0;
    }
    scene
}

/// So many textiles, a millimetre beside each other, one over the other.
fn overlapping(textiles: &[PlacedSurface], n_textiles: usize) -> Vec<PlacedSurface> {
    let place = |(number, textile): (usize, &PlacedSurface)| {
        let origin = [number % 10, number / 10].map(|n| n as f64);
        placed(&textile.surface, Point::from(origin))
    };
    let repeated = textiles.iter().cycle().take(n_textiles);
    repeated.enumerate().map(place).collect()
}

/// Aslant there and back over a textile in two seconds, as a finger does: fast in the middle, slow
/// at the ends.
fn swing(n_ticks: usize) -> Vec<Pose> {
    let (reach_mm, per_s) = ([30.0, 9.0], std::f64::consts::PI);
    let at = |t_s: f64| {
        let (sin, cos) = (per_s * t_s).sin_cos();
        let [vx, vy] = reach_mm.map(|reach| reach * per_s * cos);
        let position = Point::new(60.0 + reach_mm[0] * sin, 60.0 + reach_mm[1] * sin);
        (position, Velocity::new(vx, vy))
    };
    poses(n_ticks, 0.5 * step_s(n_ticks), at)
}

/// The same while the display turns at a turn in two seconds.
fn turning(n_ticks: usize) -> Vec<Pose> {
    let mut poses = swing(n_ticks);
    for pose in &mut poses {
        pose.angular_rad_per_s = std::f64::consts::PI;
        pose.angle_deg = 180.0 * pose.t_s;
    }
    poses
}

/// How far apart ticks lie: fewer lie farther apart, so that the way is the same.
fn step_s(n_ticks: usize) -> f64 {
    (SECONDS / n_ticks.max(1) as f64).max(1.0 / TICKS_PER_S)
}

/// Poses at so many ticks of a motion from a time on, s.
fn poses(n_ticks: usize, first_s: f64, at: impl Fn(f64) -> (Point, Velocity)) -> Vec<Pose> {
    let pose = |n: usize| {
        let t_s = first_s + n as f64 * step_s(n_ticks);
        let (position, velocity) = at(t_s);
        Pose {
            t_s,
            position,
            velocity,
            ..Pose::default()
        }
    };
    (0..n_ticks).map(pose).collect()
}

/// Once around in two seconds, or as far as the ticks go, from the upper right on.
fn circle(middle_mm: f64, radius_mm: f64, n_ticks: usize) -> Vec<Pose> {
    let stroke = Stroke::Circle {
        centre: Point::new(middle_mm, middle_mm),
        radius_mm,
        speed_mm_per_s: std::f64::consts::TAU * radius_mm / SECONDS,
    };
    poses(n_ticks, SECONDS / 8.0, |t_s| stroke.at(t_s))
}
