//! Maps of what textiles would give at one velocity, as coloured cells over the cloth, with the bar
//! that says which colour is how much.

use eframe::egui::{Align2, Color32, Painter, Pos2, Rect, Shape, Stroke, TextureId, pos2, vec2};
use selvedge_foundation::numerics::to_single;

use crate::bench::probe::Probe;
use crate::bench::view::Cloth;
use crate::kit::swatch::tiled;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::view_transform::ViewTransform;
use crate::kit::widgets::bar::amplitude_bar;
use crate::tools::workspace::arrange::{screen_bounds, screen_corners};
use crate::tools::workspace::stage::Stage;
use selvedge_foundation::geometry::Point;
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// Size of the legend, points.
const LEGEND: [f32; 2] = [104.0, 176.0];
/// From the legend to the edge of the ground, points.
const AWAY: f32 = 12.0;

/// Draws a map over its textile: one quad, whatever the number of cells.
pub(crate) fn paint(
    painter: &Painter,
    view: &ViewTransform,
    cloth: &Cloth,
    (picture, n_points): (TextureId, [usize; 2]),
) {
    if !painter.clip_rect().intersects(screen_bounds(view, cloth)) {
        return;
    }
    // The cell of point i reaches from half a millimetre before it to half a millimetre behind.
    let share = |axis: usize, place_mm: f64| {
        let n_points = n_points[axis].max(1) as f64;
        to_single((place_mm + 0.5) / n_points)
    };
    let [width, height] = cloth.size_mm;
    let uv = Rect::from_min_max(
        pos2(share(0, 0.0), share(1, 0.0)),
        pos2(share(0, width), share(1, height)),
    );
    let corners = screen_corners(view, cloth);
    let mesh = tiled(corners, uv, picture, Color32::WHITE);
    painter.add(Shape::mesh(mesh));
}

/// Draws what the colours mean, and at which velocity: beside the ground where there is room, else
/// on it.
pub(crate) fn paint_legend(
    painter: &Painter,
    stage: &Stage<'_>,
    (beside, band): (Option<Rect>, Band),
) {
    let palette = Palette::of(painter.ctx().theme());
    let size = vec2(LEGEND[0], LEGEND[1]);
    let card = if let Some(room) = beside {
        let height = size.y.min(room.height() - AWAY);
        Rect::from_min_size(room.min - vec2(10.0, 0.0), vec2(size.x, height))
    } else {
        let ground = stage.ground;
        if ground.width() < 3.0 * size.x || ground.height() < size.y + 4.0 * AWAY {
            return;
        }
        let card = Rect::from_min_size(ground.max - size - vec2(AWAY, AWAY), size);
        painter.rect_filled(card, 6, palette.tag.gamma_multiply(0.92));
        card
    };
    let left = card.left() + 10.0;
    let title = format!("{} Hz", quantity::fixed(band.carrier_hz(), 0));
    let at = pos2(left, card.top() + 13.0);
    painter.text(
        at,
        Align2::LEFT_CENTER,
        title,
        theme::body(),
        palette.band(band),
    );
    let probe = stage.sight.selection.probe;
    let at = pos2(left, card.top() + 31.0);
    let words = velocity_words(probe);
    let font = theme::small_number();
    painter.text(at, Align2::LEFT_CENTER, words, font, palette.text);
    let middle = pos2(card.right() - 15.0, card.top() + 14.0);
    paint_heading(painter, middle, probe, palette.text);
    let bar = Rect::from_min_max(
        pos2(left, card.top() + 58.0),
        pos2(left + 8.0, card.bottom() - 10.0),
    );
    amplitude_bar(
        painter,
        bar,
        stage.sight.layers.colours,
        stage.sight.selection.scale,
    );
}

/// How a chosen velocity is written: `100 mm/s, 35°`.
fn velocity_words(probe: Probe) -> String {
    let decimals = usize::from(probe.speed_mm_per_s < 9.95);
    let speed = quantity::with_unit(probe.speed_mm_per_s, decimals, "mm/s");
    format!("{speed}, {}°", quantity::fixed(probe.direction_deg, 0))
}

/// A small arrow that points where the velocity does.
fn paint_heading(painter: &Painter, middle: Pos2, probe: Probe, ink: Color32) {
    let along =
        crate::tools::workspace::overlay::motion::on_screen(probe.velocity()).normalized() * 16.0;
    painter.arrow(middle - 0.5 * along, along, Stroke::new(1.5, ink));
}

/// What a map shows at a place of the workspace on a textile, in words; empty without a map.
pub(crate) fn words_at(stage: &Stage<'_>, index: usize, cloth: &Cloth, place: Point) -> String {
    let own = cloth.workspace_from_textile.into_point(place);
    let found = stage
        .sight
        .layers
        .maps
        .amplitude_um(index, [own.x_mm, own.y_mm]);
    let Some((band, amplitude_um)) = stage.state.overlays.map.zip(found) else {
        return String::new();
    };
    format!(
        "\n{} Hz here {} at {}",
        quantity::fixed(band.carrier_hz(), 0),
        quantity::with_unit(amplitude_um, 2, "µm"),
        velocity_words(stage.sight.selection.probe)
    )
}
