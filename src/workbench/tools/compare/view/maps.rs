//! Where A and B differ: the mean difference of every contactor in both bands.

use eframe::egui::{
    self, Align2, Painter, Rect, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2,
};

use crate::bench::command::ShowCommand;
use crate::bench::tool::PaneContext;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::axis::Tick;
use crate::kit::widgets::bar::colour_bar;
use crate::kit::widgets::cells::{GAP, NUMBER_WIDTH, Places, TITLE};
use crate::kit::widgets::text::paint_quiet;
use crate::tools::compare::words::{
    alone_words, band_name, decimals_of, describe, scale_db, signed_db, unit_of,
};
use selvedge_foundation::quantity::fixed;
use selvedge_render::{LevelDifference, Tally};
use selvedge_textile::tactile::Band;

/// Shows both maps and their colour bar in `rect`.
pub(crate) fn show(ui: &Ui, rect: Rect, found: &LevelDifference, context: &mut PaneContext<'_>) {
    let Some(grid) = context.scene.grid else {
        let at = rect.left_top();
        let words = "The contactors of this display form no grid";
        paint_quiet(ui.painter(), at, Align2::LEFT_TOP, words);
        return;
    };
    let cells = &found.by_contactor;
    let means = cells.iter().flatten().filter_map(Tally::mean_db);
    let most_db = scale_db(means);
    let id = ui.scope_id().with("difference maps");
    let response = ui.interact(rect, id, Sense::click());
    response.widget_info(|| {
        let words = format!(
            "Mean level differences, B less A, up to {most_db} dB. {}",
            describe(found)
        );
        WidgetInfo::labeled(egui::Role::Canvas, true, words)
    });
    let places = Places::new(rect, grid);
    let painter = ui.painter_at(rect.expand(2.0));
    for band in Band::ALL {
        let corner = places.corners[band.index()] - vec2(0.0, 0.5 * TITLE + 1.0);
        let ink = Palette::in_ui(ui).band(band);
        let name = band_name(band);
        painter.text(corner, Align2::LEFT_CENTER, name, theme::body(), ink);
        for (index, cell) in cells.iter().enumerate() {
            let place = places.cell(band.index(), index);
            paint_cell(&painter, place, &cell[band.index()], most_db);
        }
    }
    paint_selection(
        &painter,
        &places,
        cells.len(),
        context.bench.selection.contactor,
    );
    let right = places.corners[1].x + grid.1 as f32 * places.cell.x + 10.0;
    let height = grid.0 as f32 * places.cell.y - GAP;
    let bar = Rect::from_min_size(pos2(right, places.corners[1].y), vec2(8.0, height));
    paint_bar(&painter, bar, most_db);
    let hit = response
        .hover_pos()
        .and_then(|at| places.at(at, cells.len()));
    let Some((band, index)) = hit else {
        return;
    };
    if response.clicked() {
        context
            .commands
            .push(ShowCommand::SelectContactor(index).into());
    }
    let tally = &cells[index][band];
    let band = Band::ALL[band];
    response.on_hover_ui_at_pointer(|ui| {
        ui.label(words(index, band, tally));
    });
}

fn paint_cell(painter: &Painter, rect: Rect, tally: &Tally, most_db: f64) {
    let palette = Palette::of(painter.ctx().theme());
    let font = theme::small_number();
    let centre = Align2::CENTER_CENTER;
    let Some(mean_db) = tally.mean_db() else {
        // Without a difference there is no colour: an empty frame, and who sounds.
        let edge = Stroke::new(1.0, palette.line);
        painter.rect_stroke(rect, 2, edge, StrokeKind::Inside);
        let letters = match tally.n_only {
            [0, 0] => "",
            [_, 0] => "A",
            [0, _] => "B",
            _ => "A/B",
        };
        painter.text(rect.center(), centre, letters, font, palette.text);
        return;
    };
    let colours = palette.differences();
    let share = mean_db / most_db;
    painter.rect_filled(rect, 2, colours.colour(share));
    if rect.width() >= NUMBER_WIDTH && rect.height() >= 10.0 {
        // Four signs fit into the narrowest cell that holds numbers.
        let decimals = usize::from(mean_db.abs() < 9.95) + usize::from(most_db < 0.5);
        let digits = fixed(mean_db, decimals);
        let room = rect.width() / 6.2;
        if digits.chars().count() as f32 <= room {
            painter.text(rect.center(), centre, digits, font, colours.ink(share));
        }
    }
}

fn paint_selection(painter: &Painter, places: &Places, n_cells: usize, selected: Option<usize>) {
    let palette = Palette::of(painter.ctx().theme());
    if let Some(selected) = selected.filter(|index| *index < n_cells) {
        for band in 0..2 {
            let cell = places.cell(band, selected).expand(1.0);
            let edge = Stroke::new(1.5, palette.selection);
            painter.rect_stroke(cell, 3, edge, StrokeKind::Inside);
        }
    }
}

fn paint_bar(painter: &Painter, bar: Rect, most_db: f64) {
    let palette = Palette::of(painter.ctx().theme());
    let colours = palette.differences();
    colour_bar(painter, bar, |share| colours.colour(2.0 * share - 1.0));
    let (unit, factor) = unit_of(most_db);
    let most = Tick::number(most_db * factor).label;
    let marks = [
        (bar.top() + 4.0, format!("+{most}")),
        (bar.center().y, "0".to_owned()),
        (bar.bottom() - 4.0, format!("−{most}")),
    ];
    for (y, digits) in marks {
        let at = pos2(bar.right() + 5.0, y);
        let font = theme::small_number();
        painter.text(at, Align2::LEFT_CENTER, digits, font, palette.dim);
    }
    let at = pos2(bar.left(), bar.top() - 11.0);
    paint_quiet(painter, at, Align2::LEFT_CENTER, unit);
}

fn words(index: usize, band: Band, tally: &Tally) -> String {
    let head = format!("Contactor {index}, {}", band_name(band));
    let [n_a, n_b] = tally.n_only;
    let difference = match (tally.mean_db(), tally.largest) {
        (Some(mean_db), Some(largest)) => format!(
            "B less A: mean {} over {} ticks\nlargest {} at tick {}",
            signed_db(mean_db, decimals_of(mean_db)),
            tally.n_both,
            signed_db(largest.difference_db, decimals_of(largest.difference_db)),
            largest.tick,
        ),
        _ => alone_words(tally).to_owned(),
    };
    format!("{head}\n{difference}\nA only in {n_a} ticks, B only in {n_b}\nclick to choose it")
}
