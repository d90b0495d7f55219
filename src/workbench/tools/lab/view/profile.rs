//! The heights along one stroke, in travel order: what a probe reads.

use eframe::egui::{
    self, Align2, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2,
};

use crate::kit::theme::Palette;
use crate::kit::widgets::axis::{Axis, Side, paint_ticks, paint_unit, round_step};
use crate::kit::widgets::polyline::corners;
use crate::kit::widgets::text::toggle;
use crate::tools::lab::preview::Preview;
use crate::tools::lab::state::{Lab, Look};
use crate::tools::lab::view::parts;
use crate::tools::lab::view::parts::within;
use selvedge_foundation::quantity;
use selvedge_textile::surface::{Direction, Profile};

/// The spans that can be chosen, mm; the longest is the whole stroke.
const SPANS: [(f64, &str); 3] = [(20.0, "20 mm"), (10.0, "10 mm"), (2.0, "2 mm")];
/// Least and largest span of a wheel, mm.
const ENDS: [f64; 2] = [0.5, 100.0];
/// How opaque the compared profile is drawn.
const COMPARED: f32 = 0.8;

/// Shows the plot, with what is looked at above it.
pub(crate) fn show(ui: &mut Ui, rect: Rect, lab: &mut Lab, preview: &Preview) {
    let head = rect.with_max_y(rect.top() + 20.0);
    within(ui, head, |ui| show_head(ui, &mut lab.look));
    let look = lab.look;
    let area = Rect::from_min_max(
        pos2(rect.left() + 34.0, rect.top() + 24.0),
        pos2(rect.right() - 8.0, rect.bottom() - 16.0),
    );
    if area.width() < 40.0 || area.height() < 20.0 {
        return;
    }
    let id = ui.scope_id().with("lab profile");
    let response = ui.interact(area, id, Sense::click_and_drag());
    let name = format!("Profile, {}", look.direction.label());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Canvas, true, &name));
    let Some(profile) = preview.felt.profile(look.direction) else {
        return;
    };
    let compared = lab.compared.as_ref();
    let compared = compared.and_then(|compared| compared.felt.profile(look.direction));
    let plot = Plot::new(area, look, [Some(profile), compared]);
    plot.paint_axes(ui.painter());
    let palette = Palette::in_ui(ui);
    if let Some(compared) = compared {
        let ink = palette.line.gamma_multiply(COMPARED);
        plot.paint(ui.painter(), compared, Stroke::new(1.0, ink));
    }
    plot.paint(ui.painter(), profile, Stroke::new(1.25, palette.text));
    plot.paint_units(ui.painter());
    if let Some(look) = moved(ui, &response, look, profile) {
        lab.look = look;
    }
    tell(response, &plot, (profile, compared));
}

/// Which stroke, and how much of it.
fn show_head(ui: &mut Ui, look: &mut Look) {
    let palette = Palette::in_ui(ui);
    ui.horizontal(|ui| {
        ui.label(parts::small("profile", palette.dim));
        for (direction, letters) in
            Direction::ALL
                .into_iter()
                .zip(["warp", "warp back", "weft", "weft back"])
        {
            let tip = format!("Profile along {}", direction.label());
            if toggle(ui, letters, direction == look.direction, &tip) {
                look.direction = direction;
            }
        }
        ui.add_space(8.0);
        for (span_mm, words) in SPANS {
            let is_shown = (look.span_mm - span_mm).abs() < 1e-6;
            let tip = format!("Look at {words} of it; the wheel looks closer, a drag moves along");
            if toggle(ui, words, is_shown, &tip) {
                look.span_mm = span_mm;
            }
        }
    });
}

/// What is looked at after a drag, the wheel or a double click; `None` if it stays.
fn moved(ui: &Ui, response: &Response, look: Look, profile: &Profile) -> Option<Look> {
    let length_mm = length_mm(profile);
    let mut next = look;
    if response.double_clicked() {
        next = Look {
            direction: look.direction,
            ..Look::default()
        };
    }
    let per_point = look.span_mm / f64::from(response.rect.width().max(1.0));
    if response.dragged() {
        next.from_mm -= f64::from(response.drag_delta().x) * per_point;
    }
    if let Some(at) = response.hover_pos() {
        let wheel =
            ui.input(|input| input.smooth_scroll_delta().y + 200.0 * (input.zoom_delta() - 1.0));
        if wheel.abs() > 0.1 && ui.input(|input| input.modifiers.command || input.modifiers.shift) {
            let held = look.from_mm + f64::from(at.x - response.rect.left()) * per_point;
            let span = look.span_mm * (1.003_f64).powf(-f64::from(wheel));
            next.span_mm = span.clamp(ENDS[0], ENDS[1]);
            next.from_mm = held - (held - look.from_mm) * next.span_mm / look.span_mm;
        }
    }
    next.from_mm = next.from_mm.clamp(0.0, (length_mm - next.span_mm).max(0.0));
    (next != look).then_some(next)
}

fn length_mm(profile: &Profile) -> f64 {
    profile.step_mm() * profile.heights_um().len() as f64
}

fn tell(response: Response, plot: &Plot, (profile, compared): (&Profile, Option<&Profile>)) {
    let Some(at) = response.hover_pos().filter(|_| !response.dragged()) else {
        return;
    };
    let x_mm = plot.places_mm.value_at_x(plot.area.x_range(), at.x);
    let Some(height) = height_at(profile, x_mm) else {
        return;
    };
    let other = compared.and_then(|compared| height_at(compared, x_mm));
    let other = other.map_or_else(String::new, |height| {
        format!("\ncompared {}", quantity::with_unit(height, 1, "µm"))
    });
    let place = quantity::with_unit(x_mm, 2, "mm");
    let height = quantity::with_unit(height, 1, "µm");
    let words = format!(
        "{place}  {height}{other}\nIn travel order. Drag to move along, Ctrl+wheel to look closer, \
         double click to see all"
    );
    response.on_hover_text_at_pointer(words);
}

fn height_at(profile: &Profile, x_mm: f64) -> Option<f64> {
    let place = (x_mm / profile.step_mm()).round();
    if place < 0.0 {
        return None;
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "not negative; beyond the end is none"
    )]
    let height = profile.heights_um().get(place as usize).copied();
    height
}

struct Plot {
    area: Rect,
    places_mm: Axis,
    heights_um: Axis,
}

impl Plot {
    /// Heights in round numbers around the whole of both profiles, so that the scale stays while
    /// the view moves along.
    fn new(area: Rect, look: Look, profiles: [Option<&Profile>; 2]) -> Self {
        let heights = profiles.into_iter().flatten().flat_map(Profile::heights_um);
        let (least, most) = heights.fold((0.0_f64, 0.0_f64), |(least, most), height| {
            (least.min(*height), most.max(*height))
        });
        let step = round_step((most - least) / 4.0);
        Self {
            area,
            places_mm: Axis::linear(look.from_mm, look.from_mm + look.span_mm),
            heights_um: Axis::linear((least / step).floor() * step, (most / step).ceil() * step),
        }
    }

    fn paint_axes(&self, painter: &Painter) {
        let heights = self.heights_um.ticks(self.area.height(), 20.0);
        paint_ticks(painter, self.area, (&self.heights_um, Side::Left), &heights);
        let places = self.places_mm.ticks(self.area.width(), 60.0);
        paint_ticks(painter, self.area, (&self.places_mm, Side::Bottom), &places);
    }

    fn paint_units(&self, painter: &Painter) {
        let corner = self.area.left_top() + vec2(4.0, 1.0);
        paint_unit(painter, corner, Align2::LEFT_TOP, "µm");
        let corner = self.area.right_bottom() + vec2(-2.0, -1.0);
        paint_unit(painter, corner, Align2::RIGHT_BOTTOM, "mm");
    }

    /// A profile; where many samples fall on one point of the screen, their ends.
    fn paint(&self, painter: &Painter, profile: &Profile, stroke: Stroke) {
        let painter = painter.with_clip_rect(self.area);
        let at = |place: usize, height: f64| -> Pos2 {
            let x_mm = place as f64 * profile.step_mm();
            pos2(
                self.places_mm.x(self.area.x_range(), x_mm),
                self.heights_um.y(self.area.y_range(), height),
            )
        };
        let heights = profile.heights_um();
        let per_mm = 1.0 / profile.step_mm();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped to the samples"
        )]
        let index = |x_mm: f64| (x_mm * per_mm).clamp(0.0, heights.len() as f64) as usize;
        let from = index(self.places_mm.least()).saturating_sub(1);
        let to = (index(self.places_mm.most()) + 2).min(heights.len());
        let n = to.saturating_sub(from);
        let stride = (n as f32 / (self.area.width() * 1.5)).ceil().max(1.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at least one"
        )]
        let stride = stride as usize;
        let mut points = Vec::with_capacity(2 * n / stride + 2);
        for (nth, some) in heights[from.min(to)..to].chunks(stride).enumerate() {
            let place = from + nth * stride;
            let least = some.iter().copied().fold(f64::INFINITY, f64::min);
            let most = some.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            points.push(at(place, least));
            if stride > 1 {
                points.push(at(place, most));
            }
        }
        painter.add(Shape::line(corners(&points), stroke));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_are_read_at_places_and_nowhere_beyond_the_ends() {
        let profile = Profile::new(0.1, vec![1.0, 2.0, 3.0]).unwrap();
        assert_eq!(height_at(&profile, 0.11), Some(2.0));
        assert_eq!(height_at(&profile, -0.2), None);
        assert_eq!(height_at(&profile, 0.3), None);
    }

    #[test]
    fn the_scale_of_heights_does_not_depend_on_where_one_looks() {
        let profile = Profile::new(0.1, (0..200).map(f64::from).collect()).unwrap();
        let at = |from_mm| {
            let look = Look {
                from_mm,
                span_mm: 2.0,
                ..Look::default()
            };
            let area = Rect::from_min_size(Pos2::ZERO, vec2(200.0, 100.0));
            Plot::new(area, look, [Some(&profile), None]).heights_um
        };
        assert_eq!(at(0.0), at(17.0));
        assert_eq!((at(0.0).least(), at(0.0).most()), (0.0, 200.0));
    }
}
