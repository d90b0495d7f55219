//! The dot that leads a movement that is practised.

use selvedge_experiment::design::{Familiarisation, Movement};
use selvedge_foundation::geometry::Point;

/// Radius of the circle, mm.
pub(crate) const RADIUS_MM: f64 = 30.0;
/// Half the length of the line, mm.
pub(crate) const HALF_MM: f64 = 40.0;

/// Where the guide is so many seconds after the movement began, around `middle`.
pub(crate) fn place(movement: &Familiarisation, middle: Point, t_s: f64) -> Point {
    let way_mm = movement.speed_mm_per_s * t_s;
    match movement.movement {
        Movement::Circular => {
            let (sin, cos) = (way_mm / RADIUS_MM).sin_cos();
            Point::new(middle.x_mm + RADIUS_MM * cos, middle.y_mm + RADIUS_MM * sin)
        }
        Movement::Linear => {
            // There and back again, beginning on the left.
            let along = way_mm.rem_euclid(4.0 * HALF_MM);
            let x_mm = if along < 2.0 * HALF_MM {
                along - HALF_MM
            } else {
                3.0 * HALF_MM - along
            };
            Point::new(middle.x_mm + x_mm, middle.y_mm)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_guide_keeps_its_speed_and_its_course() {
        let middle = Point::new(60.0, 60.0);
        for movement in [Movement::Circular, Movement::Linear] {
            let practised = Familiarisation {
                movement,
                for_s: 30.0,
                speed_mm_per_s: 100.0,
            };
            for n in 0..400 {
                let t_s = f64::from(n) * 0.013;
                let here = place(&practised, middle, t_s);
                let next = place(&practised, middle, t_s + 1e-4);
                let speed = (next - here).length_mm() / 1e-4;
                assert!(
                    (speed - 100.0).abs() < 1.0 || speed < 100.0 && movement == Movement::Linear
                );
                assert!((here - middle).length_mm() <= HALF_MM + 1e-9);
            }
        }
    }
}
