//! Both bands of every contactor as two heatmaps on one scale, with its colour bar.

use eframe::egui::{
    self, Align2, Painter, Rect, Response, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2,
};

use crate::app::amplitude::AmplitudeScale;
use crate::app::theme::{self, ColourMap, Palette};
use crate::app::view::{Dot, Live, SceneView};
use crate::quantity;
use crate::tactile::Band;

/// Height of a title, points.
const TITLE: f32 = 20.0;
/// Space between cells, points.
const GAP: f32 = 2.0;
/// Width of the colour bar with its numbers, points.
const BAR: f32 = 36.0;
/// Largest cell, points.
const MAX_CELL: f32 = 30.0;

/// How wide the heatmaps and their colour bar are at this height, points.
pub(crate) fn width_at(height: f32, (n_rows, n_columns): (usize, usize)) -> f32 {
    let cell = cell_size(height, n_rows);
    2.0 * n_columns as f32 * cell + 28.0 + BAR
}

fn cell_size(height: f32, n_rows: usize) -> f32 {
    ((height - TITLE) / n_rows.max(1) as f32)
        .floor()
        .clamp(4.0, MAX_CELL)
}

/// Shows both heatmaps and the colour bar.
pub(crate) fn show(ui: &mut Ui, scene: &SceneView, live: &Live, map: ColourMap) {
    let palette = Palette::in_ui(ui);
    let Some(grid) = scene.grid else {
        ui.label("The contactors of this display form no grid: the workspace shows them");
        return;
    };
    let height = ui.available_height();
    let (rect, response) =
        ui.allocate_exact_size(vec2(width_at(height, grid), height), Sense::hover());
    response.widget_info(|| {
        WidgetInfo::labeled(
            egui::Role::Canvas,
            true,
            "Heatmaps of both bands, 0.5 to 50 µm",
        )
    });
    let cell = cell_size(height, grid.0);
    let size = vec2(grid.1 as f32 * cell, grid.0 as f32 * cell);
    for band in Band::ALL {
        let left = rect.left() + band.index() as f32 * (size.x + 16.0);
        let cells = Rect::from_min_size(pos2(left, rect.top() + TITLE), size);
        let title_at = pos2(left, rect.top() + 0.5 * TITLE - 1.0);
        let title = format!("{} Hz", quantity::fixed(band.carrier_hz(), 0));
        ui.painter().text(
            title_at,
            Align2::LEFT_CENTER,
            title,
            theme::body(),
            palette.band(band),
        );
        let map_of = Heatmap {
            cells,
            cell,
            n_columns: grid.1,
            band,
        };
        map_of.paint(ui.painter(), &live.dots, map);
        map_of.tell(ui, &response, &live.dots, scene);
    }
    let bar_left = rect.left() + 2.0 * size.x + 28.0;
    let bar = Rect::from_min_size(pos2(bar_left, rect.top() + TITLE), vec2(8.0, size.y));
    paint_bar(ui.painter(), bar, map);
}

struct Heatmap {
    cells: Rect,
    cell: f32,
    n_columns: usize,
    band: Band,
}

impl Heatmap {
    fn cell(&self, index: usize) -> Rect {
        let (row, column) = (index / self.n_columns, index % self.n_columns);
        let corner = self.cells.min + vec2(column as f32, row as f32) * self.cell;
        Rect::from_min_size(corner, vec2(self.cell - GAP, self.cell - GAP))
    }

    fn paint(&self, painter: &Painter, dots: &[Dot], map: ColourMap) {
        let palette = Palette::of(painter.ctx().theme());
        for (index, dot) in dots.iter().enumerate() {
            let rect = self.cell(index);
            if dot.cloth.is_some() {
                let share = AmplitudeScale::default().share(dot.amplitude_um[self.band.index()]);
                painter.rect_filled(rect, 2, map.colour(share));
                if dot.is_limited {
                    let corner = rect.right_top() + vec2(-5.0, 5.0);
                    painter.circle(
                        corner,
                        2.0,
                        palette.selection,
                        Stroke::new(1.5, palette.panel),
                    );
                }
            } else {
                // Off every textile: an empty frame, which no amplitude looks like.
                painter.rect_stroke(
                    rect,
                    2,
                    Stroke::new(1.0, palette.hovered),
                    StrokeKind::Inside,
                );
            }
        }
    }

    /// Says what is under the pointer.
    fn tell(&self, ui: &Ui, response: &Response, dots: &[Dot], scene: &SceneView) {
        let Some(at) = response.hover_pos().filter(|at| self.cells.contains(*at)) else {
            return;
        };
        let hit = dots
            .iter()
            .enumerate()
            .find(|(index, _)| self.cell(*index).contains(at));
        let Some((index, dot)) = hit else { return };
        let on = match dot.cloth.and_then(|cloth| scene.cloths.get(cloth)) {
            Some(cloth) => format!("on {} {}", cloth.label, cloth.name),
            None => "off every textile".to_owned(),
        };
        let [low, high] = dot.amplitude_um.map(|um| quantity::with_unit(um, 2, "µm"));
        let limited = if dot.is_limited {
            "\nan output limit bites"
        } else {
            ""
        };
        let words = format!(
            "Contactor {index}, {on}\n40 Hz  {low}\n320 Hz  {high}\npeak, after gains, before \
             output limits{limited}"
        );
        response.clone().on_hover_ui_at_pointer(|ui| {
            ui.label(words);
        });
        let palette = Palette::in_ui(ui);
        let edge = Stroke::new(1.5, palette.selection);
        ui.painter()
            .rect_stroke(self.cell(index), 2, edge, StrokeKind::Outside);
    }
}

fn paint_bar(painter: &Painter, bar: Rect, map: ColourMap) {
    let palette = Palette::of(painter.ctx().theme());
    let n_steps = 64_u8;
    let step = bar.height() / f32::from(n_steps);
    for i in 0..n_steps {
        let y = bar.bottom() - f32::from(i + 1) * step;
        // Half a point of overlap hides the seams.
        let slice = Rect::from_min_size(pos2(bar.left(), y), vec2(bar.width(), step + 0.5));
        painter.rect_filled(
            slice.intersect(bar),
            0,
            map.colour(f64::from(i) / f64::from(n_steps - 1)),
        );
    }
    for amplitude_um in AmplitudeScale::default().marks_um() {
        #[expect(clippy::cast_possible_truncation, reason = "a share, for the screen")]
        let share = AmplitudeScale::default().share(amplitude_um) as f32;
        let y = bar.bottom() - bar.height() * share;
        let decimals = usize::from(amplitude_um < 1.0);
        let digits = quantity::fixed(amplitude_um, decimals);
        painter.hline(
            bar.right()..=bar.right() + 3.0,
            y,
            Stroke::new(1.0, palette.line),
        );
        let at = pos2(
            bar.right() + 7.0,
            y.clamp(bar.top() + 4.0, bar.bottom() - 4.0),
        );
        painter.text(
            at,
            Align2::LEFT_CENTER,
            digits,
            theme::small_number(),
            palette.dim,
        );
    }
    let unit_at = pos2(bar.left(), bar.top() - 11.0);
    painter.text(
        unit_at,
        Align2::LEFT_CENTER,
        "µm",
        theme::small(),
        palette.dim,
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_fit_the_height() {
        let cell = cell_size(160.0, 6);
        assert!(TITLE + 6.0 * cell <= 160.0, "{cell}");
    }
}
