//! A table: numbers right-aligned in fixed decimals; what is not computable a dash with its reason.
//!
//! Only rows in sight are laid out. While the rest is scrolled, the headings stay above and the
//! first column at the left.

use eframe::egui::text::{LayoutJob, TextFormat, TextWrapping};
use eframe::egui::{
    Align, Align2, FontId, Label, Layout, Painter, Rect, RichText, Role, ScrollArea, Sense, Stroke,
    Ui, WidgetInfo, pos2, vec2,
};

use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::toggle;
use crate::tools::analysis::view::columns::{ColumnLook, GAP, TableLook, described, tip};
use selvedge_experiment::analysis::{Cell, Table};

/// Height of a row, points.
const LINE: f32 = 20.0;
/// Height of a line of a heading, points.
const HEAD_LINE: f32 = 14.0;
/// Lines of a heading at most.
const MOST_HEAD_LINES: usize = 3;
/// Tables with more rows say how many.
const MANY: usize = 12;

/// Shows a table; says whether it is to be copied.
pub(crate) fn show(
    ui: &mut Ui,
    (nth, table): (usize, &Table),
    looks: &mut [Option<TableLook>],
) -> bool {
    let Some(look) = looks.get_mut(nth) else {
        return false;
    };
    let look = look.get_or_insert_with(|| TableLook::of(ui, table));
    let is_copied = show_caption(ui, table);
    let area = ScrollArea::horizontal()
        .id_salt(("table", nth))
        .auto_shrink([false, true]);
    area.show(ui, |ui| {
        let lines = look.columns.iter().map(|column| n_lines(ui, column)).max();
        let n_lines = lines.unwrap_or(1) + usize::from(look.has_units);
        let head = HEAD_LINE * n_lines as f32 + 2.0 * STEP;
        let size = vec2(look.width, head + LINE * table.rows.len() as f32);
        let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
        let sheet = Sheet {
            table,
            look,
            rect,
            head,
            nth,
        };
        sheet.show_rows(ui);
        sheet.show_head(ui);
    });
    is_copied
}

fn show_caption(ui: &mut Ui, table: &Table) -> bool {
    let palette = Palette::in_ui(ui);
    let size = vec2(ui.available_width(), LINE + STEP);
    let line = Layout::left_to_right(Align::Center);
    ui.allocate_ui_with_layout(size, line, |ui| {
        let words = RichText::new(&table.title).color(palette.text);
        ui.add(Label::new(words).truncate());
        if table.rows.len() > MANY {
            let n = format!("{} rows", table.rows.len());
            ui.label(RichText::new(n).font(theme::small()).color(palette.dim));
        }
        let label = format!("Copy “{}” as CSV", table.title);
        toggle(ui, "copy", false, &label)
    })
    .inner
}

/// Lines that a heading takes without its unit.
fn n_lines(ui: &Ui, column: &ColumnLook) -> usize {
    let job = heading(ui, column, &column.heading);
    ui.painter().layout_job(job).rows.len().min(MOST_HEAD_LINES)
}

/// A heading, or its unit, which is dimmer.
fn heading(ui: &Ui, column: &ColumnLook, words: &str) -> LayoutJob {
    let palette = Palette::in_ui(ui);
    let is_unit = words == column.unit;
    let format = TextFormat {
        font_id: theme::small(),
        color: if is_unit { palette.dim } else { palette.text },
        line_height: Some(HEAD_LINE),
        ..TextFormat::default()
    };
    let mut job = LayoutJob {
        wrap: TextWrapping {
            max_width: column.width,
            max_rows: MOST_HEAD_LINES,
            ..TextWrapping::default()
        },
        halign: if column.decimals.is_some() {
            Align::RIGHT
        } else {
            Align::LEFT
        },
        ..LayoutJob::default()
    };
    job.append(words, 0.0, format);
    job
}

/// A table in its place.
struct Sheet<'a> {
    table: &'a Table,
    look: &'a TableLook,
    rect: Rect,
    head: f32,
    nth: usize,
}

impl Sheet<'_> {
    /// The first row in sight and the one after the last.
    fn in_sight(&self, clip: Rect) -> [usize; 2] {
        let top = self.rect.top() + self.head;
        let row_at = |y: f32| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a cast from a float saturates"
            )]
            let row = ((y - top) / LINE).max(0.0) as usize;
            row
        };
        let last = row_at(clip.bottom()) + usize::from(clip.bottom() > top);
        [row_at(clip.top()), last].map(|row| row.min(self.table.rows.len()))
    }

    /// Where a column lies; the first stays in sight.
    fn across(&self, at: usize, clip: Rect) -> (f32, &ColumnLook) {
        let before: f32 = self.look.columns[..at].iter().map(|c| c.width + GAP).sum();
        let column = &self.look.columns[at];
        let left = if at == 0 {
            let most = (self.rect.right() - column.width - GAP).max(self.rect.left());
            clip.left().clamp(self.rect.left(), most)
        } else {
            self.rect.left() + before
        };
        (left, column)
    }

    /// What is painted of the first column, and of the others, which go behind it.
    fn painters(&self, ui: &Ui) -> [Painter; 2] {
        let clip = ui.clip_rect();
        let first = self
            .look
            .columns
            .first()
            .map_or(0.0, |c| c.width + 0.5 * GAP);
        let edge = clip.left().max(self.rect.left()) + first;
        let rest = clip.with_min_x(edge.min(clip.right()));
        [ui.painter().clone(), ui.painter().with_clip_rect(rest)]
    }

    fn show_rows(&self, ui: &Ui) {
        let clip = ui.clip_rect();
        let [from, to] = self.in_sight(clip);
        let painters = self.painters(ui);
        for row in from..to {
            let top = self.rect.top() + self.head + LINE * row as f32;
            let line =
                Rect::from_min_size(pos2(self.rect.left(), top), vec2(self.rect.width(), LINE));
            let id = ui.scope_id().with(("row", self.nth, row));
            let response = ui.interact(line, id, Sense::hover());
            response.widget_info(|| WidgetInfo::labeled(Role::ListItem, true, self.said(row)));
            if response.hovered() {
                let fill = Palette::in_ui(ui).raised;
                ui.painter().rect_filled(line, 3, fill);
            }
            for at in 0..self.look.columns.len() {
                let (left, column) = self.across(at, clip);
                let cell = Rect::from_min_size(pos2(left, top), vec2(column.width, LINE));
                self.paint(ui, &painters[at.min(1)], (row, at), (cell, column));
            }
            if let Some(at) = response
                .hover_pos()
                .and_then(|to| self.column_at(to.x, clip))
            {
                let words = tip(&self.table.rows[row][at], &self.table.columns[at]);
                response.on_hover_text_at_pointer(words);
            }
        }
    }

    /// The column under the pointer.
    fn column_at(&self, x: f32, clip: Rect) -> Option<usize> {
        let mut columns = 0..self.look.columns.len();
        columns.find(|at| {
            let (left, column) = self.across(*at, clip);
            (left - 0.5 * GAP..left + column.width + 0.5 * GAP).contains(&x)
        })
    }

    fn paint(
        &self,
        ui: &Ui,
        painter: &Painter,
        (row, at): (usize, usize),
        (cell, look): (Rect, &ColumnLook),
    ) {
        if !painter.clip_rect().intersects(cell) {
            return;
        }
        let palette = Palette::in_ui(ui);
        let (value, column) = (&self.table.rows[row][at], &self.table.columns[at]);
        let text = described(value, column, look.decimals);
        let ink = match value {
            Cell::Undefined(_) => palette.dim,
            Cell::Number(_) | Cell::Text(_) => palette.text,
        };
        if look.decimals.is_some() {
            let font = number_font(value);
            let right = pos2(cell.right(), cell.center().y);
            painter.text(right, Align2::RIGHT_CENTER, text, font, ink);
            return;
        }
        let mut job = LayoutJob::simple_singleline(text, theme::body(), ink);
        job.wrap = TextWrapping::truncate_at_width(cell.width());
        let galley = painter.layout_job(job);
        let corner = pos2(cell.left(), cell.center().y - 0.5 * galley.size().y);
        painter.galley(corner, galley, ink);
    }

    /// The headings, above everything while their table is in sight.
    fn show_head(&self, ui: &Ui) {
        let clip = ui.clip_rect();
        let palette = Palette::in_ui(ui);
        let most = (self.rect.bottom() - self.head).max(self.rect.top());
        let top = clip.top().clamp(self.rect.top(), most);
        let head = Rect::from_min_size(
            pos2(self.rect.left(), top),
            vec2(self.rect.width(), self.head),
        );
        ui.painter().rect_filled(head, 0, palette.panel);
        let bottom = head.bottom() - 1.0;
        let line = Stroke::new(1.0, palette.hairline);
        ui.painter().hline(head.x_range(), bottom, line);
        let painters = self.painters(ui);
        for at in 0..self.look.columns.len() {
            let (left, column) = self.across(at, clip);
            let x = match column.decimals {
                Some(_) => left + column.width,
                None => left,
            };
            let painter = &painters[at.min(1)];
            let mut below = bottom - STEP;
            if self.look.has_units {
                let galley = painter.layout_job(heading(ui, column, &column.unit));
                below -= HEAD_LINE;
                painter.galley(pos2(x, below), galley, palette.dim);
            }
            let galley = painter.layout_job(heading(ui, column, &column.heading));
            painter.galley(pos2(x, below - galley.size().y), galley, palette.text);
        }
    }

    /// A row as it is read out.
    fn said(&self, row: usize) -> String {
        let cells = self.table.rows[row].iter().zip(&self.table.columns);
        let cells = cells.zip(&self.look.columns);
        let said = |((cell, column), look): ((&Cell, _), &ColumnLook)| match cell {
            Cell::Undefined(_) => tip(cell, column),
            Cell::Number(_) | Cell::Text(_) => {
                let described = described(cell, column, look.decimals);
                format!("{} {described} {}", look.heading, look.unit)
                    .trim()
                    .to_owned()
            }
        };
        cells.map(said).collect::<Vec<_>>().join(", ")
    }
}

fn number_font(cell: &Cell) -> FontId {
    match cell {
        Cell::Text(_) => theme::body(),
        Cell::Number(_) | Cell::Undefined(_) => theme::number(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_ten_thousand_rows_those_in_sight_are_laid_out() {
        let table = Table {
            rows: vec![Vec::new(); 10_000],
            ..Table::default()
        };
        let look = TableLook {
            columns: Vec::new(),
            width: 100.0,
            has_units: false,
        };
        let sheet = |top: f32| {
            let head = 22.0;
            let size = vec2(100.0, head + LINE * 10_000.0);
            let rect = Rect::from_min_size(pos2(0.0, top), size);
            let (table, look) = (&table, &look);
            Sheet {
                table,
                look,
                rect,
                head,
                nth: 0,
            }
        };
        let clip = Rect::from_min_max(pos2(0.0, 0.0), pos2(100.0, 400.0));
        assert_eq!(sheet(0.0).in_sight(clip), [0, 19], "from its top");
        assert_eq!(
            sheet(500.0).in_sight(clip),
            [0, 0],
            "below what is in sight"
        );
        let [from, to] = sheet(-100_022.0).in_sight(clip);
        assert_eq!((from, to), (5000, 5021), "in its middle");
        let [from, to] = sheet(-300_000.0).in_sight(clip);
        assert_eq!((from, to), (10_000, 10_000), "above what is in sight");
    }
}
