//! A figure as a picture, drawn on a thread for the width and the theme at hand.

use std::sync::Arc;

use eframe::egui::emath::GuiRounding as _;
use eframe::egui::{
    Align2, Color32, ColorImage, ImageData, Pos2, Rect, Role, ScrollArea, Sense, Stroke,
    TextureOptions, Ui, UiBuilder, WidgetInfo, pos2, vec2,
};

use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::text::toggle;
use crate::tools::analysis::findings::Findings;
use crate::tools::analysis::pictures::Wanted;
use crate::tools::analysis::state::Analysis;
use crate::tools::analysis::view::columns::Looks;
use selvedge_chart::Paper;
use selvedge_experiment::analysis::{Cell, Drawn};

/// Widths that a figure can be read at, points.
const WIDTHS: [f32; 2] = [540.0, 900.0];
/// How near a point of a map is pointed at, points.
const POINT: f32 = 9.0;
/// The room of the button on a figure, points.
const SAVE: [f32; 2] = [64.0, 24.0];

/// How wide a figure is in a room of this width, points.
fn width(room: f32) -> f32 {
    room.clamp(WIDTHS[0], WIDTHS[1])
}

/// How the figures of a section are wanted in a room of this width.
pub(crate) fn wanted(ui: &Ui, room: f32, (findings, section): (Arc<Findings>, usize)) -> Wanted {
    let px = (width(room) * ui.ctx().pixels_per_point()).round();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "within what can be drawn"
    )]
    let width_px = px.clamp(64.0, 8192.0) as u32;
    let paper = if ui.visuals().dark_mode {
        Paper::OnDark
    } else {
        Paper::OnLight
    };
    Wanted {
        findings,
        section,
        width_px,
        paper,
    }
}

/// The picture of a figure of the section at hand, if it is drawn; of whatever width.
fn picture_of<'a>(
    analysis: &'a Analysis,
    found: &Arc<Findings>,
    nth: usize,
) -> Option<&'a Result<Arc<ColorImage>, String>> {
    let pictures = analysis.pictures.value()?;
    let wanted = analysis.pictures.key()?;
    let is_same = Arc::ptr_eq(&wanted.findings, found) && wanted.section == analysis.section;
    pictures.images.get(nth).filter(|_| is_same)
}

/// What is wanted of a figure.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Asked {
    /// It is to be saved.
    Save,
    /// The textile of a point is to be felt: its id in scenes.
    Feel(String),
}

/// Shows a figure in a room of this width; says what is wanted of it.
pub(crate) fn show(
    ui: &mut Ui,
    (nth, drawn, room): (usize, &Drawn, f32),
    found: &Arc<Findings>,
    analysis: &mut Analysis,
) -> Option<Asked> {
    let picture = picture_of(analysis, found, nth).cloned();
    let looks = &mut analysis.looks;
    let [laid_width, laid_height] = drawn.figure.size_px();
    #[expect(clippy::cast_possible_truncation, reason = "a ratio, for the screen")]
    let size = vec2(1.0, (laid_height / laid_width) as f32) * width(room);
    let area = ScrollArea::horizontal()
        .id_salt(("figure", nth))
        .auto_shrink([false, true]);
    area.show(ui, |ui| {
        let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
        let title = &drawn.figure.title;
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, title));
        match &picture {
            Some(Ok(image)) => paint(ui, rect, (nth, image), looks),
            Some(Err(line)) => say(ui, rect, line),
            None => say(ui, rect, title),
        }
        let felt = show_points(ui, rect, drawn, found);
        // Within reach however wide the picture is.
        let right = rect.right().min(ui.clip_rect().right());
        let corner = Rect::from_min_size(
            pos2(right - SAVE[0], rect.top() + 10.0),
            vec2(SAVE[0], SAVE[1]),
        );
        let mut child = ui.new_child(UiBuilder::new().max_rect(corner));
        let label = format!("Save “{title}” as PNG, SVG or CSV");
        let is_saved = toggle(&mut child, "save…", false, &label);
        is_saved
            .then_some(Asked::Save)
            .or_else(|| felt.map(Asked::Feel))
    })
    .inner
}

/// The points of a map that stand for textiles: one that is clicked is felt.
fn show_points(ui: &Ui, rect: Rect, drawn: &Drawn, found: &Findings) -> Option<String> {
    let points = textiles_at(drawn, found);
    #[expect(clippy::cast_possible_truncation, reason = "px of the screen")]
    let scale = rect.width() / drawn.figure.size_px()[0] as f32;
    let mut felt = None;
    for (name, key, [x, y]) in points {
        #[expect(clippy::cast_possible_truncation, reason = "px of the screen")]
        let at = rect.min + scale * vec2(x as f32, y as f32);
        let spot = Rect::from_center_size(at, vec2(2.0 * POINT, 2.0 * POINT));
        let id = ui.scope_id().with((&drawn.key, &name));
        let response = ui.interact(spot, id, Sense::click());
        let words = format!("Feel {name} in the workspace");
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &words));
        if response.hovered() || response.has_focus() {
            let edge = Stroke::new(1.5, Palette::in_ui(ui).selection);
            ui.painter().circle_stroke(at, POINT, edge);
        }
        if response.on_hover_text(words).clicked() {
            felt = Some(key);
        }
    }
    felt
}

/// The points of a map by name, the textile of each as scenes find it, and where it lies in the
/// picture, px.
pub(crate) fn textiles_at(drawn: &Drawn, found: &Findings) -> Vec<(String, String, [f64; 2])> {
    let points = &drawn.points;
    let names: Vec<&str> = points
        .columns
        .iter()
        .map(|column| column.name.as_str())
        .collect();
    if !matches!(names[..], ["name", "x1", "x2", ..]) {
        return Vec::new();
    }
    let point = |row: &Vec<Cell>| {
        let [Cell::Text(name), x, y, ..] = &row[..] else {
            return None;
        };
        let at = [x.number()?, y.number().unwrap_or(0.0)];
        let key = found.textiles.get(name)?.clone();
        Some((name.clone(), key, drawn.figure.point_px(at)?))
    };
    points.rows.iter().filter_map(point).collect()
}

fn paint(ui: &Ui, rect: Rect, (nth, image): (usize, &Arc<ColorImage>), looks: &mut Looks) {
    let Some(kept) = looks.textures.get_mut(nth) else {
        return;
    };
    let is_same = kept.as_ref().is_some_and(|(of, _)| Arc::ptr_eq(of, image));
    if !is_same {
        let data = ImageData::Color(Arc::clone(image));
        let name = format!("analysis figure {nth}");
        let texture = ui.ctx().load_texture(name, data, TextureOptions::LINEAR);
        *kept = Some((Arc::clone(image), texture));
    }
    if let Some((_, texture)) = kept {
        let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        let rect = sharp(rect, image.size, ui.ctx().pixels_per_point());
        ui.painter()
            .image(texture.id(), rect, whole, Color32::WHITE);
    }
}

/// Where a picture stands pixel on pixel; as it is while it is drawn for another width.
fn sharp(rect: Rect, size_px: [usize; 2], pixels_per_point: f32) -> Rect {
    let size = vec2(size_px[0] as f32, size_px[1] as f32) / pixels_per_point;
    let is_as_wide = (size.x - rect.width()).abs() * pixels_per_point < 1.0;
    if is_as_wide {
        Rect::from_min_size(rect.min.round_to_pixels(pixels_per_point), size)
    } else {
        rect
    }
}

/// Words in the place of a picture.
fn say(ui: &Ui, rect: Rect, words: &str) {
    let palette = Palette::in_ui(ui);
    ui.painter().rect_filled(rect, 4, palette.raised);
    let (font, ink) = (theme::small(), palette.dim);
    ui.painter()
        .text(rect.center(), Align2::CENTER_CENTER, words, font, ink);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_of_the_right_width_stands_pixel_on_pixel() {
        let rect = Rect::from_min_size(pos2(10.3, 20.6), vec2(600.2, 300.0));
        let stands = sharp(rect, [1200, 601], 2.0);
        assert_eq!(stands.min, pos2(10.5, 20.5));
        assert_eq!(stands.size(), vec2(600.0, 300.5));
        assert_eq!(
            sharp(rect, [900, 451], 2.0),
            rect,
            "drawn for another width"
        );
    }
}
