//! Lines with as few corners as they need: every corner costs vertices, and software that stands in
//! for a graphics card takes its time for each.

use eframe::egui::Pos2;

/// How far a line may pass above or below a point, points of the screen.
const TOLERANCE: f32 = 0.2;

/// Those of some points, from left to right or from right to left, that a line needs as corners to
/// pass close to all.
pub(crate) fn corners(points: &[Pos2]) -> Vec<Pos2> {
    let mut kept: Vec<Pos2> = points.first().copied().into_iter().collect();
    let mut slopes = Slopes::ALL;
    for pair in points.windows(2) {
        let (Some(&corner), &[before, at]) = (kept.last(), pair) else {
            break;
        };
        let goes_on = (at.x - before.x) * (before.x - corner.x) >= 0.0;
        if goes_on && slopes.lead_to(corner, at) {
            slopes = slopes.passing(corner, at);
        } else {
            if before != corner {
                kept.push(before);
            }
            slopes = Slopes::ALL.passing(before, at);
        }
    }
    if points.len() > 1 {
        kept.extend(points.last());
    }
    kept
}

/// Slopes at which a line from the last corner passes close to all points since.
#[derive(Debug, Clone, Copy)]
struct Slopes {
    least: f32,
    most: f32,
}

impl Slopes {
    const ALL: Self = Self {
        least: f32::NEG_INFINITY,
        most: f32::INFINITY,
    };

    /// Whether a line from `corner` to `at` is among them.
    fn lead_to(self, corner: Pos2, at: Pos2) -> bool {
        let slope = (at.y - corner.y) / (at.x - corner.x).abs();
        (self.least..=self.most).contains(&slope)
    }

    const NONE: Self = Self {
        least: f32::INFINITY,
        most: f32::NEG_INFINITY,
    };

    /// Those of them that pass close to `at`, too.
    fn passing(self, corner: Pos2, at: Pos2) -> Self {
        let across = (at.x - corner.x).abs();
        if across <= 0.0 {
            return Self::NONE;
        }
        let slope = |y: f32| (y - corner.y) / across;
        Self {
            least: self.least.max(slope(at.y - TOLERANCE)),
            most: self.most.min(slope(at.y + TOLERANCE)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::pos2;

    fn wave(n_points: u16, height: f32) -> Vec<Pos2> {
        let point = |i| {
            let x = f32::from(i);
            pos2(x, height * (x * 0.1).sin())
        };
        (0..n_points).map(point).collect()
    }

    /// How far the line through corners passes from a point, above or below it.
    fn distance(corners: &[Pos2], at: Pos2) -> f32 {
        let pair = corners
            .windows(2)
            .find(|pair| pair[0].x <= at.x && at.x <= pair[1].x);
        let [from, to] = [pair.unwrap()[0], pair.unwrap()[1]];
        let share = (at.x - from.x) / (to.x - from.x);
        (from.y + share * (to.y - from.y) - at.y).abs()
    }

    #[test]
    fn a_line_passes_close_to_every_point_with_far_fewer_corners() {
        for height in [0.1, 3.0, 40.0] {
            let points = wave(500, height);
            let kept = corners(&points);
            assert!(kept.len() < 250, "{height}: {}", kept.len());
            let farthest = points.iter().map(|at| distance(&kept, *at));
            assert!(farthest.fold(0.0, f32::max) <= TOLERANCE + 1e-3, "{height}");
            let back: Vec<Pos2> = points.iter().rev().copied().collect();
            assert!(corners(&back).len() < 250, "{height}, from the right");
        }
    }

    #[test]
    fn ends_peaks_and_steps_stay_where_they_are() {
        let mut points: Vec<Pos2> = (0..100_u8).map(|x| pos2(f32::from(x), 5.0)).collect();
        points[40].y = 90.0;
        let kept = corners(&points);
        assert_eq!(
            kept,
            [points[0], points[39], points[40], points[41], points[99]]
        );
        let step = [pos2(0.0, 0.0), pos2(0.0, 9.0), pos2(4.0, 9.0)];
        assert_eq!(corners(&step), step);
        let turn = [pos2(0.0, 0.0), pos2(4.0, 0.0), pos2(1.0, 0.0)];
        assert_eq!(corners(&turn), turn);
    }

    #[test]
    fn nothing_and_a_single_point_are_left_alone() {
        assert!(corners(&[]).is_empty());
        assert_eq!(corners(&[pos2(1.0, 2.0)]), [pos2(1.0, 2.0)]);
    }
}
