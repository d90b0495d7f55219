//! The display: its contactors as green dots at their true places, and the trail behind it.
//!
//! Dots show amplitudes on the scale of the heatmaps; outside every textile a contactor is a ring,
//! and a muted one is hollow and struck through. What is too weak to be felt, by a model, is a grey
//! ring. The less of a dot is on the finger the fainter it is.

use eframe::egui::{Color32, Mesh, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};

use crate::bench::command::DotStyle;
use crate::bench::on_finger::{OnFinger, is_muted};
use crate::bench::perceptual_level::PerceptualLevel;
use crate::bench::selection::Selection;
use crate::bench::trail::TRAIL_S;
use crate::bench::view::{Dot, EngineView};
use crate::kit::amplitude::AmplitudeScale;
use crate::kit::theme::Palette;
use crate::kit::view_transform::ViewTransform;
use crate::kit::widgets::limit_mark::paint_limit_mark;
use selvedge_foundation::geometry::Point;
use selvedge_foundation::numerics::to_single;

/// Dots closer together than this have no room for a ring, points per mm.
const LEAST_FOR_RING: f32 = 4.0;
/// Dots closer together than this have no room for the mark of a limit, points per mm.
const LEAST_FOR_LIMIT: f32 = 6.0;
/// Corners of a glow.
const GLOW_CORNERS: u32 = 20;
/// Half of what a contactor has for itself: their pitch is 2 mm.
const HALF_PITCH_MM: f64 = 1.0;
/// Dots are drawn as if a millimetre were at least this long, points.
const LEAST_SCALE: f32 = 2.4;

/// How much of its ink a display has that the panes do not look at.
const BESIDE: f32 = 0.6;

/// Draws every contactor that is in sight, with rings around the chosen one and the one that is
/// pointed at in some view.
pub(crate) fn paint(
    painter: &Painter,
    view: &ViewTransform,
    live: &EngineView,
    (selection, pointed): (&Selection, Option<usize>),
) {
    let dots = &live.dots;
    let brush = Brush {
        painter: painter.clone(),
        palette: Palette::of(painter.ctx().theme()),
        points_per_mm: view.length(1.0).max(LEAST_SCALE),
        scale: selection.scale,
        style: selection.dot_style,
        perceptual_level: selection.greys_below.then_some(live.perceptual_level),
    };
    let sight = painter.clip_rect().expand(2.5 * brush.points_per_mm);
    let beside = brush.fainter(BESIDE);
    for dot in live.others.iter().flat_map(|other| &other.dots) {
        if sight.contains(view.screen(dot.position)) {
            beside.faded(dot).dot(view.screen(dot.position), dot);
        }
    }
    let in_sight = |dot: &&Dot| sight.contains(view.screen(dot.position));
    if brush.style == DotStyle::SizeAndGlow {
        for dot in dots.iter().filter(in_sight) {
            brush.faded(dot).glow(view.screen(dot.position), dot);
        }
    }
    for dot in dots.iter().filter(in_sight) {
        brush.faded(dot).dot(view.screen(dot.position), dot);
    }
    for dot in dots.iter().filter(in_sight) {
        brush.limit(view.screen(dot.position), dot);
    }
    if let Some(dot) = pointed.and_then(|index| dots.get(index)) {
        brush.pointed(view.screen(dot.position));
    }
    if let Some(dot) = selection.contactor.and_then(|index| dots.get(index)) {
        brush.selection(view.screen(dot.position));
    }
}

/// The contactor at a place of the screen.
pub(crate) fn hit(view: &ViewTransform, dots: &[Dot], at: Pos2) -> Option<usize> {
    let reach = view.length(HALF_PITCH_MM).max(4.0);
    let distance = |dot: &Dot| view.screen(dot.position).distance(at);
    let near = dots.iter().enumerate();
    near.map(|(index, dot)| (index, distance(dot)))
        .filter(|(_, distance)| *distance <= reach)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(index, _)| index)
}

/// Draws where the display was: `(age in s, place)` from old to new.
pub(crate) fn paint_trail(
    painter: &Painter,
    view: &ViewTransform,
    trail: impl Iterator<Item = (f64, Point)>,
) {
    let palette = Palette::of(painter.ctx().theme());
    let sight = painter.clip_rect().expand(8.0);
    let mut before = None;
    for (age_s, place) in trail {
        let end = view.screen(place);
        if let Some((age_s, start)) = before.replace((age_s, end)) {
            if !sight.intersects(Rect::from_two_pos(start, end)) {
                continue;
            }
            let freshness = share(1.0 - age_s / TRAIL_S);
            let fading = freshness * freshness;
            let ink = palette.lit.gamma_multiply(0.85 * fading);
            let rim = palette.rim.gamma_multiply(0.5 * fading);
            let ends = [start, end];
            painter.line_segment(ends, Stroke::new(2.5 + 2.0 * freshness, rim));
            painter.line_segment(ends, Stroke::new(1.0 + 2.0 * freshness, ink));
        }
    }
}

/// What dots are drawn with.
struct Brush {
    painter: Painter,
    palette: &'static Palette,
    points_per_mm: f32,
    scale: AmplitudeScale,
    style: DotStyle,
    /// By what to grey what is not felt, if it is greyed.
    perceptual_level: Option<PerceptualLevel>,
}

impl Brush {
    /// The same for one dot: fainter the less of it is on the finger.
    fn faded(&self, dot: &Dot) -> Self {
        let [low, high] = dot.on_finger.map(OnFinger::presence);
        self.fainter(low.max(high))
    }

    /// The same with so much of its ink, 0…1.
    fn fainter(&self, share: f32) -> Self {
        let mut painter = self.painter.clone();
        painter.multiply_opacity(share);
        Self { painter, ..*self }
    }

    /// How strongly both amplitudes of a dot are drawn, 0…1.
    fn strengths(&self, dot: &Dot) -> [f32; 2] {
        dot.amplitude_um.map(|um| share(self.scale.share(um)))
    }

    fn glow(&self, at: Pos2, dot: &Dot) {
        let [_, strength] = self.strengths(dot);
        if dot.cloth.is_none()
            || is_muted(dot.on_finger)
            || strength <= 0.0
            || self.is_below(dot)[1]
        {
            return;
        }
        let radius = (1.0 + 1.3 * strength) * self.points_per_mm;
        let ink = self.palette.lit.gamma_multiply(0.55 * strength);
        self.painter.add(halo(at, radius, ink));
    }

    fn dot(&self, at: Pos2, dot: &Dot) {
        if dot.cloth.is_none() {
            let ring = Stroke::new(1.0, self.palette.contactor);
            let radius = 0.34 * self.points_per_mm;
            self.painter.circle_stroke(at, radius, ring);
        } else if is_muted(dot.on_finger) {
            self.muted(at);
        } else {
            self.felt(at, self.strengths(dot), self.is_below(dot));
        }
    }

    /// Where the dots have room, the mark of an output limit that bites stands beside them.
    fn limit(&self, at: Pos2, dot: &Dot) {
        let has_room = self.points_per_mm >= LEAST_FOR_LIMIT;
        if has_room && dot.limiter.any() && dot.cloth.is_some() && !is_muted(dot.on_finger) {
            let beside = 0.7 * self.points_per_mm;
            paint_limit_mark(&self.painter, at + vec2(beside, -beside));
        }
    }

    fn muted(&self, at: Pos2) {
        let radius = 0.42 * self.points_per_mm;
        let across = 1.5 * vec2(radius, -radius);
        for (width, ink) in [(2.5, self.palette.rim), (1.0, self.palette.lit)] {
            let stroke = Stroke::new(width, ink);
            self.painter.circle_stroke(at, radius, stroke);
            self.painter
                .line_segment([at - across, at + across], stroke);
        }
    }

    /// Whether each band is greyed because it is too weak to be felt.
    fn is_below(&self, dot: &Dot) -> [bool; 2] {
        let is_below = |s: PerceptualLevel| s.is_below(dot.amplitude_um);
        self.perceptual_level.map_or([false; 2], is_below)
    }

    /// Below threshold a disc is a grey ring.
    fn disc(&self, at: Pos2, radius: f32, ink: Color32, is_below: bool) {
        let rim = self.palette.rim;
        self.painter.circle_filled(at, radius + 0.75, rim);
        if is_below {
            let ring = Stroke::new(1.25, self.palette.faint);
            self.painter.circle_stroke(at, radius - 0.5, ring);
        } else {
            self.painter.circle_filled(at, radius, ink);
        }
    }

    fn felt(&self, at: Pos2, [low, high]: [f32; 2], is_below: [bool; 2]) {
        let disc = |radius, ink, is_below| self.disc(at, radius, ink, is_below);
        let radius_of = |strength: f32| (0.26 + 0.62 * strength) * self.points_per_mm;
        match self.style {
            DotStyle::SizeAndGlow => disc(radius_of(low), self.palette.lit, is_below[0]),
            DotStyle::Size => {
                disc(0.8 * radius_of(low), self.palette.lit, is_below[0]);
                let width = (0.1 * self.points_per_mm).max(1.0);
                let around = 0.8 * radius_of(high) + 1.5 * width;
                let rim = Stroke::new(width + 1.5, self.palette.rim);
                self.painter.circle_stroke(at, around, rim);
                let ink = if is_below[1] {
                    self.palette.faint
                } else {
                    self.palette.lit
                };
                let ring = Stroke::new(width, ink);
                self.painter.circle_stroke(at, around, ring);
            }
            DotStyle::Brightness => {
                let brightness = 0.12 + 0.88 * low.max(high);
                let ink = Color32::BLACK.lerp_to_gamma(self.palette.lit, brightness);
                disc(0.72 * self.points_per_mm, ink, is_below == [true; 2]);
            }
        }
    }

    /// A thin ring, for as long as the pointer rests on it somewhere.
    fn pointed(&self, at: Pos2) {
        let radius = 1.05 * self.points_per_mm + 1.5;
        let rim = Stroke::new(2.5, self.palette.tag);
        self.painter.circle_stroke(at, radius, rim);
        let ring = Stroke::new(1.0, self.palette.selection.gamma_multiply(0.7));
        self.painter.circle_stroke(at, radius, ring);
    }

    fn selection(&self, at: Pos2) {
        if self.points_per_mm < LEAST_FOR_RING {
            // It would hide its neighbours; the lens shows it.
            return;
        }
        let radius = 1.05 * self.points_per_mm + 1.5;
        // Told apart from cloth of any brightness, in both themes.
        let rim = Stroke::new(3.5, self.palette.tag);
        self.painter.circle_stroke(at, radius, rim);
        let ring = Stroke::new(1.5, self.palette.selection);
        self.painter.circle_stroke(at, radius, ring);
    }
}

fn share(value: f64) -> f32 {
    to_single(value.clamp(0.0, 1.0))
}

/// A disc that fades from `colour` in the middle to nothing at its rim.
fn halo(centre: Pos2, radius: f32, colour: Color32) -> Shape {
    let mut mesh = Mesh::default();
    mesh.colored_vertex(centre, colour);
    for i in 0..GLOW_CORNERS {
        let (sin, cos) = (i as f32 / GLOW_CORNERS as f32 * std::f32::consts::TAU).sin_cos();
        mesh.colored_vertex(
            pos2(centre.x + radius * cos, centre.y + radius * sin),
            Color32::TRANSPARENT,
        );
        mesh.add_triangle(0, 1 + i, 1 + (i + 1) % GLOW_CORNERS);
    }
    Shape::mesh(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_contactor_within_half_a_pitch_is_hit() {
        let rect = Rect::from_min_size(pos2(0.0, 0.0), vec2(200.0, 200.0));
        let view = ViewTransform::new(rect, Point::default(), 10.0);
        let dots: Vec<Dot> = (0..3_u8)
            .map(|i| Dot {
                position: Point::new(2.0 * f64::from(i), 0.0),
                ..Dot::default()
            })
            .collect();
        assert_eq!(hit(&view, &dots, pos2(121.0, 97.0)), Some(1));
        assert_eq!(hit(&view, &dots, pos2(109.0, 100.0)), Some(0));
        assert_eq!(hit(&view, &dots, pos2(120.0, 115.0)), None);
        assert_eq!(hit(&view, &[], pos2(100.0, 100.0)), None);
    }
}
