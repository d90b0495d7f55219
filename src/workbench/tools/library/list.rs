//! The libraries: which are shown, what of them matches the search, and what can be done with a
//! textile.

use std::sync::Arc;

use eframe::egui::{
    self, DragAndDrop, Rect, Response, RichText, Sense, TextEdit, Ui, WidgetInfo, pos2, vec2,
};

use crate::bench::command::edit::Edit;
use crate::bench::command::{Command, Part, ShowCommand};
use crate::bench::library_selection::Joining;
use crate::bench::library_shelf::{OWN, plain_id};
use crate::bench::library_view::LibraryItem;
use crate::bench::tool::PaneContext;
use crate::bench::view::{LibraryEntry, SceneView};
use crate::kit::pane::scroll_area;
use crate::kit::swatch;
use crate::kit::theme::Palette;
use crate::kit::widgets::text::{named, paint_focus, paint_line, paint_name, quiet};
use crate::tools::library::menus::{show_chooser, show_item_menu};
use crate::tools::library::state::{Library, Shown};
use selvedge_foundation::geometry::Point;
use selvedge_foundation::quantity;

/// Height of a row, points.
pub(crate) const ROW: f32 = 36.0;
/// Side of the piece of cloth that a row shows, points.
const SWATCH: f32 = 28.0;
/// How much cloth that piece shows, mm.
const SWATCH_MM: f32 = 14.0;

/// The textiles of a library.
struct Group {
    title: Arc<str>,
    items: Arc<[LibraryEntry]>,
}

/// The libraries that are shown, as much of them as matches the search.
pub(crate) fn show(ui: &mut Ui, state: &mut Library, context: &mut PaneContext<'_>) {
    show_head(ui, state, context);
    let groups = groups(state, context);
    let matching = |group: &Group| -> Vec<usize> {
        let places = group.items.iter().enumerate();
        places
            .filter(|(_, item)| item.matches(&state.search))
            .map(|(place, _)| place)
            .collect()
    };
    let matching: Vec<Vec<usize>> = groups.iter().map(matching).collect();
    let has_heads = matching.iter().filter(|places| !places.is_empty()).count() > 1;
    let mut rows: Vec<(&Group, Option<usize>)> = Vec::new();
    for (group, places) in groups.iter().zip(&matching) {
        if has_heads && !places.is_empty() {
            rows.push((group, None));
        }
        rows.extend(places.iter().map(|place| (group, Some(*place))));
    }
    if rows.is_empty() {
        let words = nothing(state, context);
        ui.label(RichText::new(words).color(Palette::in_ui(ui).dim));
    }
    let area = scroll_area("shelf");
    let height = ROW - ui.spacing().item_spacing.y;
    area.show_rows(ui, height, rows.len(), |ui, range| {
        for (group, place) in &rows[range] {
            match place.and_then(|place| group.items.get(place)) {
                Some(item) => show_item(ui, item, state, context),
                None => show_title(ui, group),
            }
        }
    });
}

/// Why there is nothing to see.
fn nothing(state: &Library, context: &PaneContext<'_>) -> &'static str {
    if context.bench.library.view.is_opening() {
        return "The libraries are being opened";
    }
    if !state.search.is_empty() {
        return "Nothing by that name in any library: clear the field to see all";
    }
    "No textiles here yet: keep one in the textile lab, import one, or choose another library"
}

/// The libraries that are shown. A search goes through all.
fn groups(state: &Library, context: &mut PaneContext<'_>) -> Vec<Group> {
    let is_near = state.shown == Shown::Near && state.search.is_empty();
    if !is_near {
        context.bench.open_all_libraries();
    }
    let shelves = context.bench.library.view.shelves();
    let is_shown = |title: &Arc<str>, is_scene: bool| match &state.shown {
        Shown::Near => !is_near || is_scene || &**title == OWN,
        Shown::All => true,
        Shown::One(one) => one == title,
    };
    let shown = shelves.filter(|shelf| is_shown(&shelf.title, shelf.name().is_none()));
    shown
        .map(|shelf| Group {
            title: Arc::clone(&shelf.title),
            items: Arc::clone(&shelf.items),
        })
        .collect()
}

/// What is sought, and in which libraries.
fn show_head(ui: &mut Ui, state: &mut Library, context: &mut PaneContext<'_>) {
    let field = TextEdit::singleline(&mut state.search)
        .desired_width(f32::INFINITY)
        .margin(egui::Margin::symmetric(6, 4))
        .hint_text("Search all libraries");
    let response = ui.add(field);
    named(&response, "Search the library");
    show_chooser(ui, state, context);
}

/// The name of a library over its textiles.
fn show_title(ui: &mut Ui, group: &Group) {
    let size = vec2(ui.available_width(), ROW - ui.spacing().item_spacing.y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let words = format!("{} · {}", group.title, group.items.len());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, &words));
    let text = quiet(&words);
    let at = pos2(rect.left() + 2.0, rect.bottom() - 9.0);
    paint_line(ui, at, rect.width(), text);
}

/// One textile of the library: dragged into the workspace, or added by a double click.
fn show_item(ui: &mut Ui, item: &LibraryEntry, state: &mut Library, context: &mut PaneContext<'_>) {
    context.bench.library.view.want(&item.id);
    let picture = context.bench.library.view.picture(&item.id);
    let scene = context.scene;
    let palette = Palette::in_ui(ui);
    let size = vec2(ui.available_width(), ROW - ui.spacing().item_spacing.y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let is_usable = item.flaw.is_none();
    response.widget_info(|| {
        WidgetInfo::labeled(
            egui::Role::ListItem,
            is_usable,
            format!("Add {}", item.name),
        )
    });
    if let Some(index) = scene.placed(&item.id).filter(|_| response.hovered()) {
        let hover = ShowCommand::Hover(Part::Cloth(index));
        context.commands.push(hover.into());
    }
    let is_lit = response.hovered() || response.has_focus() || scene.is_marked_id(&item.id);
    if is_usable && is_lit {
        ui.painter().rect_filled(rect, 4, palette.raised);
    }
    paint_focus(ui, &response);
    let side = SWATCH.min(rect.height());
    let square = Rect::from_min_size(
        pos2(rect.left() + 2.0, rect.center().y - 0.5 * side),
        vec2(side, side),
    );
    swatch::paint(ui.painter(), square, SWATCH_MM, picture);
    let ink = if is_usable { palette.text } else { palette.dim };
    let left = square.right() + 8.0;
    let room = rect.right() - left;
    let at = pos2(left, rect.center().y - 7.0);
    paint_name(ui, at, room, (&item.name, ink));
    let second = if is_usable {
        item.kind.as_str()
    } else {
        "cannot be read"
    };
    let second = quiet(second);
    paint_line(ui, pos2(left, rect.center().y + 8.0), room, second);
    answer_item(ui, response, item, (state, context));
}

fn answer_item(
    ui: &Ui,
    response: Response,
    item: &LibraryEntry,
    (state, context): (&mut Library, &mut PaneContext<'_>),
) {
    let scene = context.scene;
    if let Some(flaw) = &item.flaw {
        response.on_hover_text(format!("{flaw}\nIn: {}", item.home));
        return;
    }
    let is_entered = response.has_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
    if response.double_clicked() || is_entered {
        context.commands.push(added(item, scene));
    } else if response.clicked() {
        let joining = if ui.input(|input| input.modifiers.command) {
            Joining::Toggled
        } else {
            Joining::Alone
        };
        let selection = &mut context.bench.library.selection;
        selection.select(vec![item.id.clone()], joining);
        ui.ctx().request_repaint();
    }
    response.context_menu(|ui| show_item_menu(ui, item, state, context));
    if response.drag_started() {
        let id = item.id.clone();
        DragAndDrop::set_payload(ui.ctx(), LibraryItem { id });
    }
    let level = item.level_db.map_or_else(String::new, |level_db| {
        format!(
            "\nlevel {}, mean of both bands at 100 mm/s, re 1 µm",
            quantity::with_unit(level_db, 1, "dB")
        )
    });
    response
        .on_hover_cursor(egui::CursorIcon::Grab)
        .on_hover_text(format!(
            "{}\n{}\nIn: {} (id {}){level}\nDrag it into the workspace, or double click; more \
             with the right button",
            item.name,
            item.kind,
            item.home,
            plain_id(&item.id)
        ));
}

/// The act that adds a textile in the middle of the workspace.
pub(crate) fn added(item: &LibraryEntry, scene: &SceneView) -> Command {
    let [width_mm, height_mm] = scene.size_mm;
    let middle = Point::new(width_mm / 2.0, height_mm / 2.0);
    Edit::AddCloth(item.id.clone(), middle).into()
}
