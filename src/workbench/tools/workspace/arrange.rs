//! The geometry of arranging textiles: what is hit, where handles are, what a drag snaps to.
//!
//! Pure: mm in, mm out. Draws nothing and wants nothing.

use eframe::egui::{Pos2, Rect};

use crate::bench::view::Cloth;
use crate::kit::view_transform::ViewTransform;
use selvedge_foundation::geometry::{Displacement, Point};

/// How near on the screen something is snapped to, points.
pub(crate) const SNAP_POINTS: f64 = 5.0;
/// How far the handle that turns is from the upper edge, points.
const TURN_HANDLE_AWAY: f32 = 22.0;
/// How near a handle counts as hit, points.
const HANDLE_REACH: f32 = 9.0;
/// The smallest extent that a drag makes, mm.
const LEAST_MM: f64 = 5.0;
/// Angles snap to multiples of this, degrees.
const ANGLE_STEP_DEG: f64 = 15.0;

/// The corners of a textile: origin, end of warp, far corner, end of weft.
pub(crate) fn corners(cloth: &Cloth) -> [Point; 4] {
    let [width, height] = cloth.size_mm;
    [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]]
        .map(|[u, w]| cloth.workspace_from_textile.point(Point::new(u, w)))
}

/// The corners on the screen.
pub(crate) fn screen_corners(view: &ViewTransform, cloth: &Cloth) -> [Pos2; 4] {
    corners(cloth).map(|corner| view.screen(corner))
}

/// The upright rectangle of the screen that a textile needs.
pub(crate) fn screen_bounds(view: &ViewTransform, cloth: &Cloth) -> Rect {
    Rect::from_points(&screen_corners(view, cloth))
}

/// The middle of a textile.
pub(crate) fn middle(cloth: &Cloth) -> Point {
    let [width, height] = cloth.size_mm;
    let local = Point::new(0.5 * width, 0.5 * height);
    cloth.workspace_from_textile.point(local)
}

/// The textile on top of those that cover a place.
pub(crate) fn topmost(cloths: &[Cloth], place: Point) -> Option<usize> {
    cloths.iter().rposition(|cloth| covers(cloth, place))
}

fn covers(cloth: &Cloth, place: Point) -> bool {
    let is_felt_at = |[from, to]: [Point; 2]| {
        (from.x_mm..=to.x_mm).contains(&place.x_mm) && (from.y_mm..=to.y_mm).contains(&place.y_mm)
    };
    let local = cloth.workspace_from_textile.into_point(place);
    cloth.within_mm.is_none_or(is_felt_at)
        && (0.0..=cloth.size_mm[0]).contains(&local.x_mm)
        && (0.0..=cloth.size_mm[1]).contains(&local.y_mm)
}

/// What can be pulled at on the selected textile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Handle {
    /// Its far corner: makes it larger or smaller.
    Size,
    /// The round one at its upper edge: turns it.
    Turn,
}

/// Where the handles of a textile are on the screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Handles {
    /// The handle at the far corner.
    pub(crate) size: Pos2,
    /// The handle that turns.
    pub(crate) turn: Pos2,
    /// The middle of the upper edge, from which the handle that turns stands off.
    pub(crate) foot: Pos2,
}

impl Handles {
    /// The handles of a textile.
    pub(crate) fn of(view: &ViewTransform, cloth: &Cloth) -> Self {
        let [_, _, far, weft_end] = screen_corners(view, cloth);
        let foot = far.lerp(weft_end, 0.5);
        let outward = (foot - view.screen(middle(cloth))).normalized();
        let outside = foot + TURN_HANDLE_AWAY * outward;
        // Where there is no room outside, it stands inside.
        let turn = if view.rect.expand(8.0).contains(outside) {
            outside
        } else {
            foot - TURN_HANDLE_AWAY * outward
        };
        Self {
            size: far,
            turn,
            foot,
        }
    }

    /// The handle at a place of the screen.
    pub(crate) fn hit(&self, at: Pos2) -> Option<Handle> {
        let is_near = |handle: Pos2| handle.distance(at) <= HANDLE_REACH;
        if is_near(self.turn) {
            Some(Handle::Turn)
        } else {
            is_near(self.size).then_some(Handle::Size)
        }
    }
}

/// Lines that textiles snap to, by the axis that they cross, mm.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Lines {
    x_mm: Vec<f64>,
    y_mm: Vec<f64>,
}

impl Lines {
    /// Edges and middles of the workspace and of every textile but one.
    pub(crate) fn of(size_mm: [f64; 2], cloths: &[Cloth], except: usize) -> Self {
        let mut lines = Self {
            x_mm: vec![0.0, 0.5 * size_mm[0], size_mm[0]],
            y_mm: vec![0.0, 0.5 * size_mm[1], size_mm[1]],
        };
        for (_, cloth) in cloths.iter().enumerate().filter(|(i, _)| *i != except) {
            let [x_mm, y_mm] = stations(&corners(cloth));
            lines.x_mm.extend(x_mm);
            lines.y_mm.extend(y_mm);
        }
        lines
    }
}

/// Low end, middle and high end of some corners along x and along y, mm.
fn stations(corners: &[Point; 4]) -> [[f64; 3]; 2] {
    let along = |pick: fn(&Point) -> f64| {
        let low = corners.iter().map(pick).fold(f64::INFINITY, f64::min);
        let high = corners.iter().map(pick).fold(f64::NEG_INFINITY, f64::max);
        [low, 0.5 * (low + high), high]
    };
    [along(|p| p.x_mm), along(|p| p.y_mm)]
}

/// Where something was snapped: the lines that it lies on now, mm.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Guides {
    /// A line across x.
    pub(crate) x_mm: Option<f64>,
    /// A line across y.
    pub(crate) y_mm: Option<f64>,
}

/// The origin of a textile that is moved near `origin`: on a line within reach, else on whole mm.
pub(crate) fn snapped_origin(
    cloth: &Cloth,
    origin: Point,
    lines: &Lines,
    reach_mm: f64,
) -> (Point, Guides) {
    let shift = origin - cloth.workspace_from_textile.origin;
    let moved = corners(cloth).map(|corner| corner + shift);
    let [own_x_mm, own_y_mm] = stations(&moved);
    let along = |own: [f64; 3], lines: &[f64], at_mm: f64| match nearest(&own, lines, reach_mm) {
        Some((shift_mm, line_mm)) => (at_mm + shift_mm, Some(line_mm)),
        None => (on_whole_mm(at_mm, reach_mm), None),
    };
    let (x_mm, guide_x_mm) = along(own_x_mm, &lines.x_mm, origin.x_mm);
    let (y_mm, guide_y_mm) = along(own_y_mm, &lines.y_mm, origin.y_mm);
    let guides = Guides {
        x_mm: guide_x_mm,
        y_mm: guide_y_mm,
    };
    (fine(Point::new(x_mm, y_mm)), guides)
}

/// The extent of a textile whose far corner is pulled to `corner`. Upright ones snap to lines, all
/// to whole mm.
pub(crate) fn snapped_size(
    cloth: &Cloth,
    corner: Point,
    lines: &Lines,
    reach_mm: f64,
) -> ([f64; 2], Guides) {
    let mut guides = Guides::default();
    let mut corner = corner;
    if cloth.rotation_deg % 90.0 == 0.0 {
        if let Some((shift_mm, line_mm)) = nearest(&[corner.x_mm], &lines.x_mm, reach_mm) {
            corner.x_mm += shift_mm;
            guides.x_mm = Some(line_mm);
        }
        if let Some((shift_mm, line_mm)) = nearest(&[corner.y_mm], &lines.y_mm, reach_mm) {
            corner.y_mm += shift_mm;
            guides.y_mm = Some(line_mm);
        }
    }
    let size_mm = size_to(cloth, corner).map(|mm| on_whole_mm(mm, reach_mm));
    // On a line the extent is what the line says, whole or not.
    let exact_mm = size_to(cloth, corner);
    let is_swapped = (cloth.rotation_deg / 90.0).rem_euclid(2.0) > 0.5;
    let is_on_line = if is_swapped {
        [guides.y_mm.is_some(), guides.x_mm.is_some()]
    } else {
        [guides.x_mm.is_some(), guides.y_mm.is_some()]
    };
    let pick = |i: usize| {
        if is_on_line[i] {
            exact_mm[i]
        } else {
            size_mm[i]
        }
    };
    ([pick(0), pick(1)], guides)
}

/// The extent of a textile whose far corner is at `corner`, mm; never too small to get hold of.
pub(crate) fn size_to(cloth: &Cloth, corner: Point) -> [f64; 2] {
    let local = cloth.workspace_from_textile.into_point(corner);
    [local.x_mm, local.y_mm].map(|mm| fine_mm(mm.max(LEAST_MM)))
}

/// The angle under which a place is seen from another, degrees counter-clockwise from +x.
pub(crate) fn bearing_deg(from: Point, to: Point) -> f64 {
    let Displacement { x_mm, y_mm } = to - from;
    y_mm.atan2(x_mm).to_degrees()
}

/// An angle between −180 (exclusive) and 180, in steps of 15° or, freely, of 0.1°.
pub(crate) fn tidy_angle(angle_deg: f64, is_free: bool) -> f64 {
    let stepped = if is_free {
        (angle_deg * 10.0).round() / 10.0
    } else {
        (angle_deg / ANGLE_STEP_DEG).round() * ANGLE_STEP_DEG
    };
    180.0 - (180.0 - stepped).rem_euclid(360.0)
}

/// A place in whole micrometres: what a file says of it stays short.
pub(crate) fn fine(place: Point) -> Point {
    Point::new(fine_mm(place.x_mm), fine_mm(place.y_mm))
}

fn fine_mm(mm: f64) -> f64 {
    (mm * 1000.0).round() / 1000.0
}

/// How far to go, and to which line, so that one of `own` lies on one of `lines`.
fn nearest(own: &[f64], lines: &[f64], reach_mm: f64) -> Option<(f64, f64)> {
    let pairs = own.iter().flat_map(|own_mm| {
        lines
            .iter()
            .map(move |line_mm| (line_mm - own_mm, *line_mm))
    });
    pairs
        .filter(|(shift_mm, _)| shift_mm.abs() <= reach_mm)
        .min_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))
}

fn on_whole_mm(at_mm: f64, reach_mm: f64) -> f64 {
    let whole = at_mm.round();
    if (whole - at_mm).abs() <= reach_mm {
        whole
    } else {
        at_mm
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{pos2, vec2};
    use proptest::prelude::*;

    use super::*;
    use selvedge_foundation::geometry::{Frame, Rotation};

    fn cloth(origin: [f64; 2], size_mm: [f64; 2], rotation_deg: f64) -> Cloth {
        Cloth {
            id: "felt".to_owned(),
            name: "Felt".to_owned(),
            workspace_from_textile: Frame {
                origin: origin.into(),
                rotation: Rotation::from_degrees(rotation_deg),
            },
            size_mm,
            rotation_deg,
            ..Cloth::default()
        }
    }

    #[test]
    fn the_topmost_of_overlapping_textiles_is_hit() {
        let cloths = [
            cloth([0.0, 0.0], [100.0, 100.0], 0.0),
            cloth([50.0, 50.0], [100.0, 100.0], 0.0),
        ];
        assert_eq!(topmost(&cloths, Point::new(75.0, 75.0)), Some(1));
        assert_eq!(topmost(&cloths, Point::new(25.0, 75.0)), Some(0));
        assert_eq!(topmost(&cloths, Point::new(25.0, 125.0)), None);
        assert_eq!(topmost(&cloths, Point::new(f64::NAN, 0.0)), None);
    }

    #[test]
    fn a_turned_textile_is_hit_where_it_lies() {
        let turned = [cloth([100.0, 100.0], [80.0, 20.0], 45.0)];
        assert_eq!(topmost(&turned, Point::new(140.0, 145.0)), Some(0));
        assert_eq!(
            topmost(&turned, Point::new(150.0, 110.0)),
            None,
            "inside its upright bounds, not on the cloth"
        );
    }

    #[test]
    fn a_move_snaps_to_edges_and_middles_and_else_to_whole_millimetres() {
        let cloths = [
            cloth([20.0, 20.0], [100.0, 100.0], 0.0),
            cloth([140.0, 20.0], [100.0, 40.0], 0.0),
        ];
        let lines = Lines::of([260.0, 260.0], &cloths, 1);
        let near = Point::new(121.3, 21.1);
        let (origin, guides) = snapped_origin(&cloths[1], near, &lines, 2.0);
        assert_eq!(origin, Point::new(120.0, 20.0));
        assert_eq!((guides.x_mm, guides.y_mm), (Some(120.0), Some(20.0)));
        let (origin, guides) = snapped_origin(&cloths[1], Point::new(81.2, 221.4), &lines, 2.0);
        assert_eq!(guides.x_mm, Some(130.0), "its middle on the workspace's");
        assert_eq!(origin.x_mm, 80.0);
        assert_eq!(
            guides.y_mm,
            Some(260.0),
            "its upper edge on the workspace's"
        );
        let away = Point::new(90.3, 150.6);
        let (origin, guides) = snapped_origin(&cloths[1], away, &lines, 2.0);
        assert_eq!(
            (origin, guides),
            (Point::new(90.0, 151.0), Guides::default())
        );
        let (origin, _) = snapped_origin(&cloths[1], away, &lines, 0.1);
        assert_eq!(origin, away, "closely magnified, nothing pulls from afar");
    }

    #[test]
    fn a_turned_textile_snaps_by_its_upright_bounds() {
        let cloths = [cloth([100.0, 100.0], [40.0, 20.0], 90.0)];
        let lines = Lines::of([260.0, 260.0], &cloths, 0);
        let (origin, guides) = snapped_origin(&cloths[0], Point::new(21.5, 90.0), &lines, 2.0);
        assert_eq!(
            guides.x_mm,
            Some(0.0),
            "its left edge is 20 mm left of its origin"
        );
        assert_eq!(origin.x_mm, 20.0);
    }

    #[test]
    fn a_pulled_corner_snaps_and_never_makes_nothing() {
        let cloths = [
            cloth([20.0, 20.0], [100.0, 100.0], 0.0),
            cloth([140.0, 20.0], [50.5, 50.0], 0.0),
        ];
        let lines = Lines::of([260.0, 260.0], &cloths, 0);
        let corner = Point::new(189.9, 101.3);
        let (size_mm, guides) = snapped_size(&cloths[0], corner, &lines, 1.0);
        assert_eq!(size_mm, [170.5, 81.0], "on the line, and on whole mm");
        assert_eq!((guides.x_mm, guides.y_mm), (Some(190.5), None));
        let (size_mm, _) = snapped_size(&cloths[0], Point::new(-50.0, 21.0), &lines, 1.0);
        assert_eq!(size_mm, [5.0, 5.0]);
    }

    #[test]
    fn handles_stand_on_the_far_corner_and_outside_the_upper_edge() {
        let rect = Rect::from_min_size(pos2(0.0, 0.0), vec2(520.0, 520.0));
        let view = ViewTransform::new(rect, Point::new(130.0, 130.0), 2.0);
        let handles = Handles::of(&view, &cloth([80.0, 80.0], [100.0, 100.0], 0.0));
        assert_eq!(handles.size, pos2(360.0, 160.0));
        assert_eq!(handles.turn, pos2(260.0, 160.0 - TURN_HANDLE_AWAY));
        assert_eq!(handles.hit(pos2(362.0, 158.0)), Some(Handle::Size));
        assert_eq!(handles.hit(handles.turn), Some(Handle::Turn));
        assert_eq!(handles.hit(pos2(260.0, 260.0)), None);
        let full = Handles::of(&view, &cloth([0.0, 0.0], [260.0, 260.0], 0.0));
        assert_eq!(full.turn, pos2(260.0, TURN_HANDLE_AWAY), "no room outside");
        let nothing = Handles::of(&view, &cloth([0.0, 0.0], [0.0, 0.0], 0.0));
        assert!(nothing.turn.is_finite(), "{nothing:?}");
    }

    #[test]
    fn angles_step_by_fifteen_degrees_unless_they_are_free() {
        for (angle, stepped, free) in [
            (7.0, 0.0, 7.0),
            (8.0, 15.0, 8.0),
            (-44.04, -45.0, -44.0),
            (181.0, 180.0, -179.0),
            (-180.0, 180.0, 180.0),
            (725.0, 0.0, 5.0),
        ] {
            assert!((tidy_angle(angle, false) - stepped).abs() < 1e-9, "{angle}");
            assert!((tidy_angle(angle, true) - free).abs() < 1e-9, "{angle}");
        }
    }

    proptest! {
        #[test]
        fn turning_about_the_middle_keeps_the_middle(
            origin in prop::array::uniform2(-100.0_f64..100.0),
            size_mm in prop::array::uniform2(1.0_f64..100.0),
            from_deg in -180.0_f64..180.0,
            to_deg in -180.0_f64..180.0,
        ) {
            let before = cloth(origin, size_mm, from_deg);
            let half = Displacement::new(0.5 * size_mm[0], 0.5 * size_mm[1]);
            let turned = middle(&before) - Rotation::from_degrees(to_deg).turn(half);
            let after = cloth(turned.into(), size_mm, to_deg);
            prop_assert!((middle(&after) - middle(&before)).length_mm() < 1e-9);
        }
    }
}
