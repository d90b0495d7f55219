//! Rendering written out once more, from heights to amplitudes, with nothing of the product's code
//! but its plain data: transforms by their sums, filters by their formula, rotations by angles.

use std::f64::consts::{PI, TAU};

use super::cloth::{self, STEP_MM};
use super::*;
use selvedge_foundation::numerics::Random;
use selvedge_textile::surface::Profile;

struct Naive<'a> {
    scene: &'a RenderScene,
    profiles: [&'a Profile; 4],
    angle_of_textile_deg: f64,
}

/// Powers of one window by the sum itself.
fn powers(heights: &[f64]) -> Vec<f64> {
    let w = |i: usize| 0.54 - 0.46 * (TAU * i as f64 / 1000.0).cos();
    let sum_w: f64 = (0..1000).map(w).sum();
    let mean = (0..1000).map(|i| w(i) * heights[i]).sum::<f64>() / sum_w;
    let sum_ww: f64 = (0..1000).map(|i| w(i) * w(i)).sum();
    let turns: Vec<(f64, f64)> = (0..1000)
        .map(|i| (TAU * f64::from(i) / 1000.0).sin_cos())
        .collect();
    (1..=500)
        .map(|k| {
            let (mut re, mut im) = (0.0, 0.0);
            for i in 0..1000 {
                let (sin, cos) = turns[i * k % 1000];
                re += w(i) * (heights[i] - mean) * cos;
                im -= w(i) * (heights[i] - mean) * sin;
            }
            let power = 2.0 * (re * re + im * im) / (1000.0 * sum_ww);
            if k == 500 { power / 2.0 } else { power }
        })
        .collect()
}

impl Naive<'_> {
    /// Σ P H² of one direction, for both bands.
    fn sums(&self, direction: usize, place: f64, speed: f64) -> [f64; 2] {
        if !(0.01..1000.0 / 0.23).contains(&speed) {
            return [0.0; 2];
        }
        let heights = self.profiles[direction].heights_um();
        let n_points = ((heights.len() - 1000) as f64 / 230.0 + 1e-6).floor() + 1.0;
        let point = (place + 0.5 + 1e-6).floor().rem_euclid(n_points);
        let mut start = (point * 230.0 + 0.5).floor();
        if direction % 2 == 1 {
            start = (heights.len() - 1000) as f64 - start;
        }
        let start = (0..heights.len()).find(|&s| s as f64 == start).unwrap();
        let mut sums = [0.0; 2];
        for (index, power) in powers(&heights[start..start + 1000]).iter().enumerate() {
            let f = speed * 0.23 * (index as f64 + 1.0);
            if f < 1000.0 {
                for (sum, b) in sums.iter_mut().zip([40.0_f64, 320.0]) {
                    let gain = (-0.5 * ((f / b).ln() / 2.0_f64.ln()).powi(2) * 2.0_f64.ln()).exp();
                    *sum += power * gain * gain;
                }
            }
        }
        sums
    }

    fn amplitudes(&self, pose: &Pose) -> Vec<[f64; 2]> {
        let display = &self.scene.displays[0];
        let alpha = (display.rotation_deg + pose.angle_deg) * PI / 180.0;
        let beta = self.angle_of_textile_deg * PI / 180.0;
        let textile = &self.scene.textiles[0];
        let origin = textile.workspace_from_textile.origin;
        let of_contactor = |offset: &Displacement| {
            let (x, y) = (
                offset.x_mm * alpha.cos() - offset.y_mm * alpha.sin(),
                offset.x_mm * alpha.sin() + offset.y_mm * alpha.cos(),
            );
            let omega = pose.angular_rad_per_s;
            let (vx, vy) = (
                pose.velocity.x_mm_per_s - omega * y,
                pose.velocity.y_mm_per_s + omega * x,
            );
            let (dx, dy) = (
                pose.position.x_mm + x - origin.x_mm,
                pose.position.y_mm + y - origin.y_mm,
            );
            let into = |x: f64, y: f64| {
                (
                    x * beta.cos() + y * beta.sin(),
                    y * beta.cos() - x * beta.sin(),
                )
            };
            let ((u, w), (vu, vw)) = (into(dx, dy), into(vx, vy));
            let is_on = |place: f64, size: f64| place >= -1e-6 && place < size - 1e-6;
            if !is_on(u, textile.size_mm[0]) || !is_on(w, textile.size_mm[1]) {
                return [0.0; 2];
            }
            let warp = self.sums(usize::from(vu < 0.0), u, vu.abs());
            let weft = self.sums(2 + usize::from(vw < 0.0), w, vw.abs());
            [0, 1].map(|b| (2.0 * (warp[b] + weft[b])).sqrt())
        };
        display.offsets.iter().map(of_contactor).collect()
    }
}

#[test]
fn the_reference_is_the_formula() {
    let mut random = Random::new(11);
    let lengths = [4600, 3700, 1000, 2300];
    let profiles = lengths.map(|n| cloth::weave(&mut random, n));
    let cloth = cloth::surface(profiles.clone().map(Some));
    let rotation_deg = 33.0;
    let mut scene = scene_of(vec![placed(&cloth, [40.0, 10.0], rotation_deg)], exeter());
    scene.displays[0].rotation_deg = -12.0;
    let naive = Naive {
        scene: &scene,
        profiles: profiles.each_ref(),
        angle_of_textile_deg: rotation_deg,
    };
    let mut reference = renderer(&scene, Method::Reference);
    assert_eq!(profiles[0].step_mm(), STEP_MM);
    for (position, velocity, angle_deg, omega) in [
        ([60.0, 60.0], [100.0, 20.0], 0.0, 0.0),
        ([41.0, 14.0], [-70.0, 300.0], 5.0, 1.0),
        ([20.3, 55.1], [3.0, -8.0], -40.0, -4.0),
    ] {
        let pose = Pose {
            angle_deg,
            angular_rad_per_s: omega,
            ..pose(position, velocity)
        };
        let expected = naive.amplitudes(&pose);
        let found = amplitudes(&mut reference, &pose);
        let largest = expected.iter().flatten().fold(0.0_f64, |m, a| m.max(*a));
        assert!(largest > 0.1, "{pose:?} touches something");
        for (a, b) in expected.iter().flatten().zip(found.iter().flatten()) {
            assert!((a - b).abs() <= 1e-9 * largest, "{a} for {b} at {pose:?}");
        }
    }
}
