//! What both plots are drawn from, what is said of it, and the marks that they share.

use eframe::egui::{self, Color32, Painter, Rect, Ui, vec2};

use crate::bench::probe::Probe;
use crate::kit::amplitude::AmplitudeScale;
use crate::kit::theme::Palette;
use crate::tools::response::curves::Curves;
use selvedge_foundation::geometry::Velocity;
use selvedge_foundation::quantity;
use selvedge_render::array::PointSpread;
use selvedge_textile::Uncertainty;
use selvedge_textile::tactile::Band;

/// How opaque the range over all points is drawn.
const RANGE: f32 = 0.16;
/// How opaque the mean over all points is drawn.
pub(crate) const MEAN: f32 = 0.6;

/// What both plots are drawn from.
#[derive(Debug, Clone)]
pub(crate) struct ResponseView<'a> {
    /// What the scene calls the textile: label and name.
    pub textile: String,
    /// How it is turned, degrees counter-clockwise.
    pub rotation_deg: f64,
    /// The amplitude factors of its gains, by band.
    pub factors: [f64; 2],
    /// How far its levels may be off, where that is said.
    pub uncertainty: Option<Uncertainty>,
    /// The chosen contactor and the points that it reads, one for each direction; `None` while it
    /// is not on the textile.
    pub place: Option<(usize, [usize; 4])>,
    /// Amplitudes over direction and speed, before gains.
    pub curves: &'a Curves,
    /// The chosen velocity.
    pub probe: Probe,
    /// The chosen contactor's own velocity, in the workspace.
    pub moving: Option<Velocity>,
    /// The scale of amplitudes.
    pub scale: AmplitudeScale,
}

/// What a plot draws of a spread, after gains, by band: at the place, mean, least, most.
pub(crate) fn levels_db(spread: &PointSpread, factors: [f64; 2], band: Band) -> [f64; 4] {
    let spread = spread.scaled(factors);
    let level = |um: [f64; 2]| quantity::level_db(um[band.index()]);
    [
        spread.at_place_um.map_or(f64::NAN, level),
        level(spread.rms_um),
        level(spread.min_um),
        level(spread.max_um),
    ]
}

/// What a spread says, in words, and how far it may be off in a direction from the warp.
pub(crate) fn words_of(
    view: &ResponseView<'_>,
    spread: &PointSpread,
    from_warp_deg: f64,
) -> String {
    let band_words = Band::ALL.map(|band| {
        let levels = levels_db(spread, view.factors, band);
        let [place, mean, least, most] = levels.map(|db| quantity::fixed(db, 1));
        let here = if view.place.is_some() {
            format!("{place} dB at the contactor, ")
        } else {
            String::new()
        };
        format!(
            "{} Hz  {here}mean {mean} dB, {least} to {most} dB",
            quantity::fixed(band.carrier_hz(), 0)
        )
    });
    let points = view.place.map_or_else(String::new, |(_, points)| {
        let [warp, warp_back, weft, weft_back] = points;
        format!(
            "\nPoints: warp {warp} forward, {warp_back} reverse; weft {weft} forward, {weft_back} \
             reverse"
        )
    });
    let band = view.uncertainty.as_ref().map_or_else(String::new, |known| {
        let ends =
            Band::ALL.map(|band| Uncertainty::range_words(known.level_db(band, from_warp_deg)));
        format!(
            "\nHeights from a picture: all may lie {} dB from this",
            ends.join(" / ")
        )
    });
    format!(
        "{}\nLevel re 1 µm peak, after gains, before output limits; the mean is the root mean \
         square over all pairs of points{points}{band}",
        band_words.join("\n")
    )
}

/// Fills between two rows of places: the range over all points.
pub(crate) fn fill_between(
    painter: &Painter,
    lower: &[egui::Pos2],
    upper: &[egui::Pos2],
    ink: Color32,
) {
    fill_range(painter, (lower, upper), ink.gamma_multiply(RANGE));
}

/// Fills between two rows of places with an ink.
pub(crate) fn fill_range(
    painter: &Painter,
    (lower, upper): (&[egui::Pos2], &[egui::Pos2]),
    ink: Color32,
) {
    let mut mesh = egui::Mesh::default();
    for (low, high) in lower.iter().zip(upper) {
        mesh.colored_vertex(*low, ink);
        mesh.colored_vertex(*high, ink);
    }
    let n_pairs = u32::try_from(lower.len().min(upper.len())).unwrap_or(0);
    for pair in 1..n_pairs {
        let [a, b, c, d] = [2 * pair - 2, 2 * pair - 1, 2 * pair, 2 * pair + 1];
        mesh.add_triangle(a, b, c);
        mesh.add_triangle(b, c, d);
    }
    painter.add(egui::Shape::mesh(mesh));
}

/// A small handle that can be dragged.
pub(crate) fn paint_handle(painter: &Painter, at: egui::Pos2, is_held: bool) {
    let palette = Palette::of(painter.ctx().theme());
    let radius = if is_held { 5.0 } else { 4.0 };
    let edge = egui::Stroke::new(1.5, palette.panel);
    painter.circle(at, radius, palette.selection, edge);
}

/// The dot of the contactor's own velocity.
pub(crate) fn paint_moving(painter: &Painter, at: egui::Pos2) {
    let palette = Palette::of(painter.ctx().theme());
    let edge = egui::Stroke::new(1.5, palette.panel);
    painter.circle(at, 4.0, palette.contactor, edge);
}

/// A line around what has the keyboard.
pub(crate) fn paint_focus(ui: &Ui, response: &egui::Response, area: Rect) {
    if response.has_focus() {
        let edge = egui::Stroke::new(1.0, Palette::in_ui(ui).selection);
        let inside = egui::StrokeKind::Inside;
        ui.painter()
            .rect_stroke(area.expand2(vec2(4.0, 4.0)), 4, edge, inside);
    }
}
