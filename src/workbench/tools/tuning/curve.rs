//! What compression does: level in, level out, and the library's textiles as dots on the curve.

use eframe::egui::{self, Align2, Painter, Pos2, Rect, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use crate::bench::command::{Part, ShowCommand, Wishes};
use crate::bench::view::{LibraryDot, SceneView};
use crate::kit::theme;
use crate::kit::theme::Palette;
use selvedge_foundation::quantity;
use selvedge_textile::tactile::{Band, Tuning};

/// Height of the plot, points.
const HEIGHT: f32 = 90.0;

/// The spread of a library's mean amplitudes, by band, dB.
pub(crate) fn ranges_db(library: &[LibraryDot], tuning: &Tuning, reference_db: f64) -> [f64; 2] {
    Band::ALL.map(|band| {
        let levels = library.iter().map(|dot| {
            quantity::level_db(dot.mean_um[band.index()])
                + dot.gain_db
                + tuning.compression_gain_db(Some(dot.level_db), reference_db)
        });
        let heard = levels.filter(|level| level.is_finite());
        let (least, most) = heard.fold(
            (f64::INFINITY, f64::NEG_INFINITY),
            |(least, most), level| (least.min(level), most.max(level)),
        );
        (most - least).max(0.0)
    })
}

/// The ends of both axes: whole tens of decibels around every level.
pub(crate) fn ends_db(library: &[LibraryDot], reference_db: f64) -> [f64; 2] {
    let levels = library.iter().map(|dot| dot.level_db).chain([reference_db]);
    let (least, most) = levels.fold(
        (f64::INFINITY, f64::NEG_INFINITY),
        |(least, most), level| (least.min(level), most.max(level)),
    );
    [
        (least / 10.0 - 0.2).floor() * 10.0,
        (most / 10.0 + 0.2).ceil() * 10.0,
    ]
}

/// Shows the curve, or what it waits for; a click on a dot chooses its textile, if it is placed.
pub(crate) fn show(ui: &mut Ui, scene: &SceneView, wishes: &mut Wishes) {
    let palette = Palette::in_ui(ui);
    let size = vec2(ui.available_width(), HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Canvas, true, "Compression curve"));
    let Some(reference_db) = scene.reference_db.filter(|_| !scene.library.is_empty()) else {
        let words = "Levels are being computed: compression is pending";
        ui.painter().text(
            rect.center(),
            Align2::CENTER_CENTER,
            words,
            theme::small(),
            palette.dim,
        );
        return;
    };
    let plot = Plot::new(rect, &scene.library, reference_db);
    plot.paint_axes(ui.painter());
    plot.paint_curve(ui.painter(), &scene.tuning);
    for dot in &scene.library {
        plot.paint_dot(ui.painter(), dot, &scene.tuning);
        if scene.is_marked_id(&dot.id) {
            plot.paint_mark(ui.painter(), dot, &scene.tuning);
        }
    }
    let pointer = response.hover_pos();
    if let Some(dot) = pointer.and_then(|at| plot.dot_near(at, &scene.library, &scene.tuning)) {
        if let Some(index) = scene.placed(&dot.id) {
            wishes.push(ShowCommand::Hover(Part::Cloth(index)).into());
            if response.clicked() {
                wishes.push(ShowCommand::SelectCloth(Some(index)).into());
            }
        }
        let out_db = plot.out_db(&scene.tuning, dot.level_db);
        let words = format!(
            "{}\nlevel {} → {}\nmean of both bands at 100 mm/s, re 1 µm, without other gains",
            dot.name,
            quantity::with_unit(dot.level_db, 1, "dB"),
            quantity::with_unit(out_db, 1, "dB"),
        );
        response.on_hover_text_at_pointer(words);
    }
}

struct Plot {
    area: Rect,
    least_db: f64,
    most_db: f64,
    reference_db: f64,
}

impl Plot {
    fn new(rect: Rect, library: &[LibraryDot], reference_db: f64) -> Self {
        let [least_db, most_db] = ends_db(library, reference_db);
        Self {
            area: Rect::from_min_max(rect.min + vec2(30.0, 6.0), rect.max - vec2(6.0, 18.0)),
            least_db,
            most_db,
            reference_db,
        }
    }

    fn out_db(&self, tuning: &Tuning, level_db: f64) -> f64 {
        level_db + tuning.compression_gain_db(Some(level_db), self.reference_db)
    }

    fn at(&self, in_db: f64, out_db: f64) -> Pos2 {
        #[expect(clippy::cast_possible_truncation, reason = "a share, for the screen")]
        let share = |db: f64| ((db - self.least_db) / (self.most_db - self.least_db)) as f32;
        pos2(
            self.area.left() + share(in_db) * self.area.width(),
            self.area.bottom() - share(out_db) * self.area.height(),
        )
    }

    fn paint_axes(&self, painter: &Painter) {
        let palette = Palette::of(painter.ctx().theme());
        let hairline = Stroke::new(1.0, palette.hairline);
        let n_steps = ((self.most_db - self.least_db) / 10.0)
            .round()
            .clamp(1.0, 20.0);
        for i in (0..=20_u8).take_while(|i| f64::from(*i) <= n_steps) {
            let level_db = self.least_db + 10.0 * f64::from(i);
            let at = self.at(level_db, level_db);
            let (x, y) = (
                painter.round_to_pixel_center(at.x),
                painter.round_to_pixel_center(at.y),
            );
            painter.hline(self.area.x_range(), y, hairline);
            painter.vline(x, self.area.y_range(), hairline);
            let digits = quantity::fixed(level_db, 0);
            let below = pos2(x, self.area.bottom() + 3.0);
            let font = theme::small_number();
            painter.text(
                below,
                Align2::CENTER_TOP,
                &digits,
                font.clone(),
                palette.dim,
            );
            let before = pos2(self.area.left() - 5.0, y);
            painter.text(before, Align2::RIGHT_CENTER, &digits, font, palette.dim);
        }
        let corner = self.area.left_top() + vec2(6.0, 4.0);
        painter.text(
            corner,
            Align2::LEFT_TOP,
            "dB out",
            theme::small(),
            palette.dim,
        );
        let corner = self.area.right_bottom() - vec2(6.0, 4.0);
        painter.text(
            corner,
            Align2::RIGHT_BOTTOM,
            "dB in",
            theme::small(),
            palette.dim,
        );
    }

    fn paint_curve(&self, painter: &Painter, tuning: &Tuning) {
        let palette = Palette::of(painter.ctx().theme());
        let ends = [self.least_db, self.most_db];
        let unchanged = ends.map(|level_db| self.at(level_db, level_db));
        painter.add(egui::Shape::dashed_line(
            &unchanged,
            Stroke::new(1.0, palette.line),
            3.0,
            4.0,
        ));
        let curve = ends.map(|level_db| self.at(level_db, self.out_db(tuning, level_db)));
        painter.line_segment(curve, Stroke::new(1.5, palette.text));
    }

    fn paint_dot(&self, painter: &Painter, dot: &LibraryDot, tuning: &Tuning) {
        let palette = Palette::of(painter.ctx().theme());
        let at = self.at(dot.level_db, self.out_db(tuning, dot.level_db));
        if dot.is_placed {
            painter.circle_filled(at, 4.5, palette.panel);
            painter.circle_filled(at, 3.5, palette.selection);
        } else {
            painter.circle(at, 2.5, palette.panel, Stroke::new(1.0, palette.line));
        }
    }

    /// The ring around a textile that is chosen or pointed at.
    fn paint_mark(&self, painter: &Painter, dot: &LibraryDot, tuning: &Tuning) {
        let palette = Palette::of(painter.ctx().theme());
        let at = self.at(dot.level_db, self.out_db(tuning, dot.level_db));
        painter.circle_stroke(at, 7.0, Stroke::new(1.5, palette.selection));
    }

    fn dot_near<'a>(
        &self,
        pointer: Pos2,
        library: &'a [LibraryDot],
        tuning: &Tuning,
    ) -> Option<&'a LibraryDot> {
        let distance = |dot: &LibraryDot| {
            self.at(dot.level_db, self.out_db(tuning, dot.level_db))
                .distance(pointer)
        };
        library
            .iter()
            .filter(|dot| distance(dot) < 8.0)
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn library() -> Vec<LibraryDot> {
        let dot = |low_um: f64, high_um: f64| LibraryDot {
            id: String::new(),
            name: String::new(),
            mean_um: [low_um, high_um],
            gain_db: 0.0,
            level_db: 0.5 * (quantity::level_db(low_um) + quantity::level_db(high_um)),
            is_placed: false,
        };
        vec![dot(1.0, 1.0), dot(10.0, 10.0), dot(100.0, 1.0)]
    }

    #[test]
    fn without_compression_the_range_is_the_librarys_own() {
        let range = ranges_db(&library(), &Tuning::default(), 0.0);
        assert!(
            (range[0] - 40.0).abs() < 1e-9 && (range[1] - 20.0).abs() < 1e-9,
            "{range:?}"
        );
    }

    #[test]
    fn full_compression_leaves_only_what_tells_the_bands_apart() {
        let tuning = Tuning {
            compression: 1.0,
            ..Tuning::default()
        };
        let range = ranges_db(&library(), &tuning, -3.0);
        // Levels 0, 20, 20 dB: out of 40 Hz come −3, −3, +17 dB.
        assert!((range[0] - 20.0).abs() < 1e-9, "{range:?}");
    }

    #[test]
    fn a_library_without_textiles_has_no_range() {
        assert_eq!(ranges_db(&[], &Tuning::default(), 0.0), [0.0, 0.0]);
    }
}
