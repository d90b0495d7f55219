//! Where textiles that are added together find room: side by side, from the top left, over nothing
//! that lies there already.

use crate::bench::editing::{LEAST_SIDE_MM, new_size_mm};
use selvedge_foundation::geometry::Point;
use selvedge_render::scene::{PlacedTextile, Scene};

/// Between neighbours, mm.
const GAP_MM: f64 = 10.0;
/// Places are tried this far apart, mm; at most [`MOST_TRIED`] of them along a side.
const TRIED_MM: f64 = 5.0;
const MOST_TRIED: f64 = 100.0;
/// Where whole textiles have no room, smaller ones are laid, each so much of the last size.
const SMALLER: f64 = 0.8;
/// A display still fits on textiles as small as this, mm.
const SMALLEST_MM: f64 = 20.0;

/// An upright rectangle: low and high end along x and along y, mm.
type Upright = [[f64; 2]; 2];

/// The side of `n` new textiles, mm, and the middle of each.
///
/// Where there is no room for them at a useful size, they lie side by side on top of what is there:
/// of what lies lowest, as long as that leaves room, so that the last one is not covered.
pub(crate) fn free_places(scene: &Scene, n: usize) -> (f64, Vec<Point>) {
    let taken: Vec<Upright> = scene.textiles.iter().map(upright).collect();
    let [largest_mm, _] = new_size_mm(scene.size_mm);
    let halves = std::iter::successors(Some(1), |n| Some(2 * n));
    let lowest = halves.take_while(|n| *n < taken.len());
    let tried = std::iter::once(0).chain(lowest).chain([taken.len()]);
    for covered in tried.map(|n| &taken[n..]) {
        let smallest_mm = if covered.is_empty() {
            LEAST_SIDE_MM
        } else {
            SMALLEST_MM
        };
        let mut side_mm = largest_mm;
        while side_mm >= smallest_mm {
            let middles = laid(scene.size_mm, covered, side_mm, n);
            if middles.len() == n {
                return (side_mm, middles);
            }
            side_mm = (SMALLER * side_mm).floor();
        }
    }
    // More than the workspace holds of the smallest: what is left lies in its middle.
    let [width_mm, height_mm] = scene.size_mm;
    let middle = Point::new(width_mm / 2.0, height_mm / 2.0);
    (LEAST_SIDE_MM, vec![middle; n])
}

/// As many of `n` middles as there is room for, in rows from the top.
fn laid(size_mm: [f64; 2], taken: &[Upright], side_mm: f64, n: usize) -> Vec<Point> {
    let [width_mm, height_mm] = size_mm;
    let mut covered = taken.to_vec();
    let mut middles = Vec::new();
    let [step_x, step_y] = size_mm.map(|mm| TRIED_MM.max(mm / MOST_TRIED));
    let mut top = height_mm;
    while top >= side_mm && middles.len() < n {
        let mut left = 0.0;
        while left + side_mm <= width_mm && middles.len() < n {
            let own = [[left, left + side_mm], [top - side_mm, top]];
            if covered.iter().all(|other| is_apart(&own, other)) {
                middles.push(Point::new(left + side_mm / 2.0, top - side_mm / 2.0));
                covered.push(own);
                left += side_mm + GAP_MM;
            } else {
                left += step_x;
            }
        }
        top -= step_y;
    }
    middles
}

fn is_apart(one: &Upright, other: &Upright) -> bool {
    (0..2).any(|axis| {
        let ([low, high], [other_low, other_high]) = (one[axis], other[axis]);
        low >= other_high + GAP_MM || high + GAP_MM <= other_low
    })
}

/// The upright rectangle that a textile needs, however it is turned.
fn upright(cloth: &PlacedTextile) -> Upright {
    let [width_mm, height_mm] = cloth.size_mm;
    let own = [
        [0.0, 0.0],
        [width_mm, 0.0],
        [width_mm, height_mm],
        [0.0, height_mm],
    ];
    let frame = cloth.workspace_from_textile();
    let corners = own.map(|[u, w]| frame.point(Point::new(u, w)));
    let ends = |of: fn(&Point) -> f64| {
        let low = corners.iter().map(of).fold(f64::INFINITY, f64::min);
        let high = corners.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
        [low, high]
    };
    [ends(|corner| corner.x_mm), ends(|corner| corner.y_mm)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_render::scene::LoadedScene;

    fn is_clear(scene: &Scene, side_mm: f64, middles: &[Point]) -> bool {
        let own = |middle: &Point| {
            let half = side_mm / 2.0;
            [middle.x_mm, middle.y_mm].map(|mm| [mm - half, mm + half])
        };
        let all: Vec<Upright> = middles.iter().map(own).collect();
        let taken: Vec<Upright> = scene.textiles.iter().map(upright).collect();
        all.iter().enumerate().all(|(i, one)| {
            let is_inside = (0..2).all(|axis| one[axis][0] >= 0.0)
                && (0..2).all(|axis| one[axis][1] <= scene.size_mm[axis]);
            is_inside
                && all[..i].iter().all(|other| is_apart(one, other))
                && taken.iter().all(|other| is_apart(one, other))
        })
    }

    #[test]
    fn an_empty_workspace_takes_four_whole_textiles_in_rows() {
        let scene = Scene {
            textiles: Vec::new(),
            ..LoadedScene::shipped().unwrap().scene().clone()
        };
        let (side_mm, middles) = free_places(&scene, 4);
        assert_eq!(side_mm, 100.0);
        assert!(is_clear(&scene, side_mm, &middles), "{middles:?}");
        assert!(middles[0].y_mm > middles[2].y_mm, "from the top");
        assert!(middles[0].x_mm < middles[1].x_mm, "from the left");
    }

    #[test]
    fn what_lies_there_is_not_covered_while_there_is_room_beside_it() {
        let mut scene = LoadedScene::shipped().unwrap().scene().clone();
        scene.textiles.truncate(2);
        scene.textiles[1].rotation_deg = 30.0;
        for n in [1, 2, 5] {
            let (side_mm, middles) = free_places(&scene, n);
            assert_eq!(middles.len(), n);
            assert!(side_mm >= SMALLEST_MM, "{n}: {side_mm}");
            assert!(is_clear(&scene, side_mm, &middles), "{n}: {middles:?}");
        }
    }

    #[test]
    fn in_a_full_workspace_the_last_textile_is_not_covered_by_the_next() {
        let mut scene = LoadedScene::shipped().unwrap().scene().clone();
        let whole = scene.size_mm.map(|mm| 0.5 * mm);
        for (nth, cloth) in scene.textiles.iter_mut().enumerate() {
            let at = [nth % 2, nth / 2].map(|half| half as f64);
            cloth.origin_mm = Point::new(at[0] * whole[0], at[1] * whole[1]);
            cloth.size_mm = whole;
            cloth.rotation_deg = 0.0;
        }
        for _ in 0..2 {
            let (side_mm, middles) = free_places(&scene, 1);
            let last = scene.textiles.pop().unwrap();
            scene.textiles = vec![last.clone()];
            assert!(is_clear(&scene, side_mm, &middles), "{middles:?}");
            let half = side_mm / 2.0;
            scene.textiles.push(PlacedTextile {
                origin_mm: Point::new(middles[0].x_mm - half, middles[0].y_mm - half),
                size_mm: [side_mm; 2],
                ..last
            });
        }
    }

    #[test]
    fn a_workspace_that_is_covered_takes_them_on_top_side_by_side() {
        let mut scene = LoadedScene::shipped().unwrap().scene().clone();
        scene.textiles.truncate(1);
        scene.textiles[0].origin_mm = Point::default();
        scene.textiles[0].size_mm = scene.size_mm;
        let (side_mm, middles) = free_places(&scene, 74);
        scene.textiles.clear();
        assert!(is_clear(&scene, side_mm, &middles), "{side_mm}");
        assert_eq!(middles.len(), 74);
        assert_eq!(free_places(&scene, 0).1, Vec::new());
    }
}
