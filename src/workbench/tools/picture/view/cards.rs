//! What every stage made, as pictures side by side.

use std::sync::Arc;

use eframe::egui::{
    Align2, Color32, Painter, Rect, Role, Sense, Stroke, Ui, UiBuilder, WidgetInfo, vec2,
};

use crate::bench::latest::Standing;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::relief3d;
use crate::kit::widgets::relief3d::View3d;
use crate::kit::widgets::text::paint_quiet;
use crate::tools::picture::draft::{Draft, ScaleUnit};
use crate::tools::picture::found::{Cloth, Found, Made};
use crate::tools::picture::state::Picture;
use crate::tools::picture::textures::Textures;
use crate::tools::picture::view::{before_after, frame, plots, sun};
use selvedge_foundation::numerics::to_single;
use selvedge_foundation::quantity;

/// Distance of cards and height of their titles, points.
const GAP: f32 = 12.0;
const TITLE: f32 = 18.0;
/// How much of what is past shows while something newer is made.
const PAST: f32 = 0.45;
/// Maxima that are drawn, and those that are numbered.
const N_MAXIMA: usize = 60;
const N_NUMBERED: usize = 6;
/// A card is small: the relief is first drawn this near.
const FIRST_ZOOM: f32 = 1.6;
/// What the cards are called.
const TITLES: [&str; 9] = [
    "1  The picture",
    "Autocorrelation",
    "Directions",
    "2  Lattice",
    "3  Cloth of the tile",
    "Not explained",
    "4  Relief",
    "5  Strokes",
    "4  Before → after",
];
/// Those that are always shown, and all, in their order.
const PLAIN: [usize; 4] = [0, 3, 8, 6];
const ALL: [usize; 9] = [0, 1, 2, 3, 4, 5, 8, 6, 7];

/// Columns of so many cards that make them largest in a room.
fn n_columns(n_cards: usize, size: eframe::egui::Vec2) -> usize {
    let side = |n: usize| {
        let rows = n_cards.div_ceil(n) as f32;
        let (w, h) = (size.x / n as f32 - GAP, size.y / rows - GAP - TITLE);
        w.min(h)
    };
    [1, 2, 3, 4]
        .into_iter()
        .max_by(|a, b| side(*a).total_cmp(&side(*b)))
        .unwrap_or(4)
}

/// Shows the cards.
pub(crate) fn show(ui: &mut Ui, picture: &mut Picture) {
    let whole = ui.available_rect_before_wrap();
    let cards: &[usize] = if picture.is_expert { &ALL } else { &PLAIN };
    let columns = n_columns(cards.len(), whole.size());
    let rows = cards.len().div_ceil(columns);
    let size = vec2(
        (whole.width() - GAP * (columns - 1) as f32) / columns as f32,
        (whole.height() - GAP * (rows - 1) as f32) / rows as f32,
    );
    let found = picture.found().cloned();
    let is_fresh = picture.standing() == Standing::Fresh;
    let is_same_file = |found: &&Found| found.inputs.source == picture.draft.source;
    let found = found.as_deref().filter(is_same_file);
    for (nth, &card) in cards.iter().enumerate() {
        let title = TITLES[card];
        let place = vec2((nth % columns) as f32, (nth / columns) as f32);
        let at = whole.min + place * (size + vec2(GAP, GAP));
        let rect = Rect::from_min_size(at, size);
        paint_quiet(ui.painter(), rect.min, Align2::LEFT_TOP, title);
        let room = rect.with_min_y(rect.top() + TITLE);
        let mut child = ui.new_child(UiBuilder::new().max_rect(room).id_salt(title));
        child.set_clip_rect(room.expand(4.0).intersect(ui.clip_rect()));
        // The part is dragged on the picture itself, which is never past.
        let is_past = found.is_some_and(|found| match card {
            0 => false,
            1..=5 => !found.inputs.has_same_tile(&picture.draft),
            _ => !is_fresh,
        });
        if is_past {
            child.multiply_opacity(PAST);
        }
        show_card(&mut child, card, picture, found);
    }
}

fn show_card(ui: &mut Ui, card: usize, picture: &mut Picture, found: Option<&Found>) {
    let room = ui.max_rect();
    let cloth = found.and_then(|found| found.cloth.as_deref());
    let waiting = waiting(card, picture, cloth);
    let (textures, draft) = (&mut picture.textures, &mut picture.draft);
    let dragged = &mut picture.dragged;
    let images = cloth.and_then(|cloth| cloth.images.as_ref());
    if let 6 | 8 = card {
        let Some(made) = found.and_then(|found| found.made.as_ref()) else {
            return nothing(ui, room, waiting);
        };
        if card == 6 {
            return show_relief(ui, made, textures);
        }
        return before_after::show(ui, room, &made.compared, (textures, card));
    }
    let title = TITLES[card];
    let title = title.split_once("  ").map_or(title, |(_, title)| title);
    let response = ui.interact(room, ui.scope_id().with("card"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, title));
    let painter = ui.painter().clone();
    let is_shown = match card {
        0 => found.and_then(|found| photograph(ui, room, (textures, draft), found)),
        1 => cloth.and_then(|cloth| correlation(&painter, room, cloth, textures)),
        2 => cloth
            .and_then(|cloth| cloth.directions.as_ref())
            .map(|directions| plots::directions(ui, room, directions)),
        3..=5 => images.map(|images| {
            let rect = textures.paint(&painter, room, card, &images[card - 3]);
            let lattice = found.and_then(Found::lattice).filter(|_| card == 3);
            if let (Some(lattice), Some(cloth)) = (lattice, cloth) {
                let found = [lattice.p1_px, lattice.p2_px];
                let vectors = dragged.unwrap_or(found);
                let moved = frame::show_vectors(ui, (rect, cloth.shown_px), vectors);
                *dragged = moved.map(|(vectors, _)| vectors);
                if moved.is_some_and(|(_, is_let_go)| is_let_go) {
                    draft.lattice = dragged.take();
                }
            }
        }),
        _ => found
            .and_then(|found| found.made.as_deref())
            .map(|made| plots::strokes(ui, room, made)),
    };
    if is_shown.is_none() {
        nothing(ui, room, waiting);
    }
}

/// The photograph, with what is dragged on it: part, ruler and sun.
fn photograph(
    ui: &Ui,
    room: Rect,
    (textures, draft): (&mut Textures, &mut Draft),
    found: &Found,
) -> Option<()> {
    let loaded = found.loaded.as_deref()?;
    let rect = textures.paint(ui.painter(), room, 0, &loaded.image);
    frame::show(ui, rect, loaded.size, (&mut draft.part, draft.turn_deg));
    let is_measured = draft.unit == ScaleUnit::Ruler;
    if let Some(ends) = draft.ruler.as_mut().filter(|_| is_measured) {
        frame::show_ruler(ui, rect, loaded.size, ends);
    }
    let light = draft.light_shown(found.shaped.as_deref());
    if let Some(light) = sun::show(ui, rect, light) {
        (draft.light, draft.is_light_estimated) = (light, false);
    }
    Some(())
}

/// Why a card is empty.
fn waiting(card: usize, picture: &Picture, cloth: Option<&Cloth>) -> &'static str {
    match (card, cloth.map(|cloth| cloth.found.is_ok())) {
        (3..=5, Some(false)) => "no lattice",
        (6.., _) if picture.draft.missing().is_some() => "needs scale and height",
        _ if matches!(picture.standing(), Standing::Working(_)) => "being worked out",
        _ => "–",
    }
}

fn nothing(ui: &Ui, room: Rect, words: &str) {
    let palette = Palette::in_ui(ui);
    ui.painter().rect_filled(room, 2, palette.raised);
    let centre = room.center();
    paint_quiet(ui.painter(), centre, Align2::CENTER_CENTER, words);
}

/// The matrix with its maxima, the most dominant ones numbered, and the lattice vectors.
fn correlation(
    painter: &Painter,
    room: Rect,
    cloth: &Cloth,
    textures: &mut Textures,
) -> Option<()> {
    let (image, radius) = cloth.correlation.as_ref()?;
    let rect = textures.paint(painter, room, 1, image);
    let painter = painter.with_clip_rect(rect.intersect(painter.clip_rect()));
    let palette = Palette::of(painter.ctx().theme());
    let px = rect.width() / (2 * radius + 1) as f32;
    let at = |[x, y]: [f64; 2]| rect.center() + vec2(to_single(x), to_single(y)) * px;
    let radius = *radius as f64;
    let is_seen = |(place, _): &&([f64; 2], f64)| place.iter().all(|px| px.abs() < radius);
    let seen = cloth.maxima.iter().filter(is_seen).take(N_MAXIMA);
    for (nth, (place, _)) in seen.enumerate() {
        for place in [*place, place.map(|x| -x)] {
            painter.circle_stroke(at(place), 3.0, Stroke::new(1.0, palette.rim));
            painter.circle_filled(at(place), 2.0, Color32::WHITE);
        }
        if nth < N_NUMBERED {
            let corner = at(*place) + vec2(4.0, -3.0);
            let label = quantity::fixed((nth + 1) as f64, 0);
            let font = theme::small_number();
            painter.text(corner, Align2::LEFT_BOTTOM, label, font, Color32::WHITE);
        }
    }
    if let Ok(tiled) = &cloth.found {
        for vector in [tiled.lattice.p1_px, tiled.lattice.p2_px] {
            painter.arrow(
                rect.center(),
                at(vector) - rect.center(),
                Stroke::new(2.0, Color32::WHITE),
            );
        }
    }
    Some(())
}

fn show_relief(ui: &mut Ui, made: &Arc<Made>, textures: &mut Textures) {
    let is_same = textures
        .made
        .as_ref()
        .is_some_and(|before| Arc::ptr_eq(before, made));
    let usual = View3d {
        zoom: FIRST_ZOOM,
        ..View3d::for_relief(&made.relief)
    };
    if !is_same {
        // Turned as before; how much heights are drawn too high follows the relief.
        let exaggeration = usual.exaggeration;
        textures.view = Some(View3d {
            exaggeration,
            ..textures.view.unwrap_or(usual)
        });
        textures.made = Some(Arc::clone(made));
    }
    let view = textures.view.unwrap_or(usual);
    if let Some(turned) = relief3d(ui, "Relief of the cloth", &made.relief, view) {
        textures.view = Some(turned);
    }
}
