//! Measurements and pictures that are made anew, the same every time.

use std::f64::consts::TAU;
use std::fmt::Write as _;

/// A profile of 20 mm that repeats, as CSV.
pub(super) fn profile(phase: f64) -> String {
    let mut text = String::from("x_mm,height_um\n");
    for i in 0..4600_u16 {
        let x_mm = f64::from(i) / 230.0;
        let height_um = 7.0 * (TAU * x_mm / 0.8 + phase).sin() + (53.0 * x_mm + phase).cos();
        writeln!(text, "{x_mm:.6},{height_um:.3}").unwrap();
    }
    text
}

/// What a probe and a tracker read over time, as CSV: a stroke of 60 mm in 3 s.
pub(super) fn readings(phase: f64) -> [String; 2] {
    let mut probe = String::from("t_s,height_um\n");
    let mut tracker = String::from("t_s,x_mm\n");
    for i in 0..600_u16 {
        let t_s = f64::from(i) * 0.005;
        let x_mm = 20.0 * t_s;
        writeln!(
            probe,
            "{t_s:.3},{:.3}",
            9.0 * (TAU * x_mm / 4.0 + phase).sin()
        )
        .unwrap();
        writeln!(tracker, "{t_s:.3},{x_mm:.3}").unwrap();
    }
    [probe, tracker]
}

/// An export of the surface tester: both ways over 30 mm, by place, and the friction.
pub(super) fn export() -> String {
    let mut text = String::from("KES-FB4\n\ndistance mm;forward um;return um;mu\n");
    for i in 0..1500_u16 {
        let x_mm = f64::from(i) * 0.02;
        let is_calm = (8.0..28.0).contains(&x_mm);
        let calm = if is_calm { 1.0 } else { 1.6 };
        let z = calm * 6.0 * (15.0 * x_mm).sin() + 3.0 * (0.7 * x_mm * x_mm).sin();
        let mu = 0.21 + 0.02 * (9.0 * x_mm).sin();
        writeln!(text, "{x_mm:.2};{z:.3};{:.3};{mu:.4}", z + 0.5).unwrap();
    }
    text
}

/// What the matrix of heights does not say of itself.
pub(super) const MATRIX_SCALE: &str = "--height-unit um --step-mm 0.05";

/// 220 × 200 heights: a ripple, one of them missing.
pub(super) fn height_matrix() -> String {
    let mut text = String::new();
    for row in 0..200_u16 {
        for column in 0..220_u16 {
            let height = 5.0 * (f64::from(column) * 0.3).sin() + 0.01 * f64::from(row);
            let end = if column == 219 { '\n' } else { '\t' };
            if (column, row) == (3, 4) {
                write!(text, "nan{end}").unwrap();
            } else {
                write!(text, "{height:.6}{end}").unwrap();
            }
        }
    }
    text
}

/// A lit cloth with a cell of 20 × 24 px, in grey.
pub(super) fn lit_cloth() -> image::GrayImage {
    image::GrayImage::from_fn(300, 240, |x, y| {
        let (u, v) = (TAU * f64::from(x) / 20.0, TAU * f64::from(y) / 24.0);
        let slope = 0.5 * (v + 0.4).cos() + 0.3 * (u + v).sin() + 0.2 * (2.0 * u - v).cos();
        let grain = ((f64::from(x) * 12.989 + f64::from(y) * 78.233).sin() * 43_758.5).fract();
        let grey = 128.0 + 60.0 * slope + 20.0 * (u + 1.0).cos() + 3.0 * grain;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "0 … 255"
        )]
        let grey = grey.clamp(0.0, 255.0) as u8;
        image::Luma([grey])
    })
}
