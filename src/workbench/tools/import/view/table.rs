//! The first lines of a file in cells, what each column holds above them.

use eframe::egui::{
    Align2, ComboBox, Rect, RichText, ScrollArea, Sense, Ui, UiBuilder, pos2, vec2,
};

use crate::kit::theme;
use crate::kit::theme::Palette;
use selvedge_textile::{ColumnRole, KesKnown, KesLook, StrokeSide, TextileAxis};

/// Height of a line, points.
const LINE: f32 = 14.0;
/// Height of the row of roles, points.
const ROLES: f32 = 22.0;
/// Width of the number of a line, of a letter, and of a column at least, points.
const NUMBER: f32 = 26.0;
const LETTER: f32 = 6.1;
const LEAST: f32 = 84.0;

/// What a column may be said to hold.
pub(crate) const ROLES_OFFERED: [ColumnRole; 14] = {
    use ColumnRole::{Distance, Friction, Height, Skip, Time};
    use StrokeSide::{Forward, Return};
    use TextileAxis::{Warp, Weft};
    [
        Distance,
        Time,
        Height(None, None),
        Height(None, Some(Forward)),
        Height(None, Some(Return)),
        Height(Some(Warp), None),
        Height(Some(Warp), Some(Forward)),
        Height(Some(Warp), Some(Return)),
        Height(Some(Weft), None),
        Height(Some(Weft), Some(Forward)),
        Height(Some(Weft), Some(Return)),
        Friction(None),
        Friction(Some(Return)),
        Skip,
    ]
};

/// Shows the lines; says the roles that were chosen, if others were.
pub(crate) fn show(ui: &mut Ui, look: &KesLook, is_asked: bool) -> Option<Vec<ColumnRole>> {
    let widths: Vec<f32> = (0..look.columns.len()).map(|i| width_of(look, i)).collect();
    let whole = NUMBER + widths.iter().sum::<f32>();
    let height = ROLES + LINE * look.lines.len() as f32 + 8.0;
    let mut chosen = None;
    let area = ScrollArea::horizontal()
        .id_salt("import-lines")
        .auto_shrink([false, true]);
    area.show(ui, |ui| {
        let size = vec2(whole.max(ui.available_width()), height);
        let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
        ui.ctx().accesskit_node_builder(response.id, |node| {
            node.set_label(format!("First lines: {}", described(look)));
        });
        paint_grounds(ui, rect, look, &widths);
        chosen = show_roles(ui, rect, look, (&widths, is_asked));
        paint_lines(ui, rect, look, &widths);
    });
    chosen
}

/// What the columns hold, for those who do not see the table.
fn described(look: &KesLook) -> String {
    let column = |(nth, column): (usize, &selvedge_textile::KesColumn)| {
        format!("column {} {}", nth + 1, column.role.label())
    };
    let columns: Vec<String> = look.columns.iter().enumerate().map(column).collect();
    format!("{}, {} rows", columns.join(", "), look.n_rows)
}

fn width_of(look: &KesLook, column: usize) -> f32 {
    let lines = look
        .lines
        .iter()
        .filter(|line| line.cells.len() == look.columns.len());
    let letters = lines.map(|line| line.cells[column].chars().count()).max();
    (letters.unwrap_or(0).min(20) as f32 * LETTER + 12.0).max(LEAST)
}

/// Grounds behind the columns: what is measured stands out, what is left out does not.
fn paint_grounds(ui: &Ui, rect: Rect, look: &KesLook, widths: &[f32]) {
    let palette = Palette::in_ui(ui);
    let mut left = rect.left() + NUMBER;
    for (column, width) in look.columns.iter().zip(widths) {
        let ground = match column.role {
            ColumnRole::Height(..) => Some(palette.hovered),
            ColumnRole::Friction(_) => Some(palette.raised),
            ColumnRole::Distance | ColumnRole::Time | ColumnRole::Skip => None,
        };
        let cell = Rect::from_min_max(
            pos2(left, rect.top()),
            pos2(left + width - 2.0, rect.bottom()),
        );
        if let Some(ground) = ground {
            ui.painter().rect_filled(cell, 2, ground);
        }
        left += width;
    }
}

/// The role of every column, to be chosen.
fn show_roles(
    ui: &mut Ui,
    rect: Rect,
    look: &KesLook,
    (widths, is_asked): (&[f32], bool),
) -> Option<Vec<ColumnRole>> {
    let roles: Vec<ColumnRole> = look.columns.iter().map(|column| column.role).collect();
    let mut chosen = roles.clone();
    let mut left = rect.left() + NUMBER;
    for (nth, width) in widths.iter().enumerate() {
        let at = Rect::from_min_size(pos2(left, rect.top()), vec2(width - 4.0, ROLES - 2.0));
        let mut child = ui.new_child(UiBuilder::new().max_rect(at));
        child.spacing_mut().interact_size.y = ROLES - 2.0;
        child.spacing_mut().button_padding = vec2(4.0, 0.0);
        let is_open = is_asked && look.columns[nth].known == KesKnown::Unknown;
        let words = if is_open { "?" } else { roles[nth].label() };
        let text = RichText::new(words).font(theme::small());
        let list = ComboBox::from_id_salt(("import-role", nth))
            .width(width - 8.0)
            .truncate();
        let shown = list.selected_text(text).show_ui(&mut child, |ui| {
            for role in ROLES_OFFERED {
                ui.selectable_value(&mut chosen[nth], role, role.label());
            }
        });
        let label = format!("What column {} holds", nth + 1);
        let tip = look.columns[nth].known.label();
        let id = shown.response.id;
        ui.ctx()
            .accesskit_node_builder(id, |node| node.set_label(label));
        shown.response.on_hover_text(tip);
        left += width;
    }
    (chosen != roles).then_some(chosen)
}

fn paint_lines(ui: &Ui, rect: Rect, look: &KesLook, widths: &[f32]) {
    let palette = Palette::in_ui(ui);
    let painter = ui.painter();
    let mut y = rect.top() + ROLES + 0.5 * LINE;
    for line in &look.lines {
        let number = pos2(rect.left() + NUMBER - 6.0, y);
        let font = theme::small_number();
        painter.text(
            number,
            Align2::RIGHT_CENTER,
            line.number,
            font.clone(),
            palette.line,
        );
        if line.cells.len() == look.columns.len() {
            let mut right = rect.left() + NUMBER;
            for ((cell, width), column) in line.cells.iter().zip(widths).zip(&look.columns) {
                right += width;
                let is_quiet = !line.is_row || !is_measured(column.role);
                let ink = if is_quiet { palette.dim } else { palette.text };
                let at = pos2(right - 8.0, y);
                let clip = Rect::from_x_y_ranges(right - width..=right - 2.0, rect.y_range());
                let painter = painter.with_clip_rect(clip.intersect(ui.clip_rect()));
                let drawn = painter.text(at, Align2::RIGHT_CENTER, cell, font.clone(), ink);
                if line.is_row && column.role == ColumnRole::Skip {
                    painter.hline(drawn.x_range(), y, (1.0, palette.line));
                }
            }
        } else {
            let words = line.cells.join(" ");
            let at = pos2(rect.left() + NUMBER + 2.0, y);
            painter.text(at, Align2::LEFT_CENTER, words, font, palette.dim);
        }
        y += LINE;
    }
}

fn is_measured(role: ColumnRole) -> bool {
    matches!(role, ColumnRole::Height(..) | ColumnRole::Friction(_))
}
