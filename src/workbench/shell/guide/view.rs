//! The guide in a window over the panes: its contents, a search through all pages, and the page.

use eframe::egui::{
    self, Align, Color32, Id, Layout, RichText, ScrollArea, Sense, TextEdit, Ui, Window, vec2,
};

use crate::bench::command::{Command, Commands};
use crate::kit::pane::scroll_area;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::{named, paragraph, quiet};
use crate::shell::guide::markdown::{Block, Span, anchor, blocks};
use crate::shell::guide::{GuidePage, guide_pages, page};

/// Width of the contents, points.
const CONTENTS: f32 = 220.0;
/// Size of the window at first, points.
const SIZE: [f32; 2] = [900.0, 640.0];
/// Space before a point of a list, points.
const INDENT: f32 = 28.0;
/// Letters around what was found.
const AROUND: usize = 48;

/// What is read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Reading {
    page: &'static GuidePage,
    /// What is sought in all pages.
    search: String,
    /// The heading to be scrolled to.
    goes_to: Option<String>,
}

impl Reading {
    /// Begins with the page of this name, or with the first; a heading may follow after a `#`.
    pub(crate) fn of(target: Option<&str>) -> Self {
        let mut reading = Self {
            page: &guide_pages()[0],
            search: String::new(),
            goes_to: None,
        };
        if let Some(target) = target {
            reading.follow(target);
        }
        reading
    }

    /// Goes where a link leads; elsewhere than in the guide it leads nowhere.
    fn follow(&mut self, target: &str) {
        let (name, heading) = target.split_once('#').unwrap_or((target, ""));
        let name = name.strip_suffix(".md").unwrap_or(name);
        if let Some(page) = page(name) {
            self.page = page;
        }
        self.goes_to = Some(heading.to_owned());
    }
}

/// Shows the guide.
pub(crate) fn show(ui: &Ui, reading: &mut Reading, commands: &mut Commands) {
    let room = ui.ctx().content_rect().shrink(24.0);
    let size = egui::Vec2::from(SIZE).min(room.size());
    let mut is_open = true;
    let window = Window::new("Guide")
        .id(Id::unique("guide"))
        .open(&mut is_open)
        .collapsible(false)
        .default_rect(egui::Rect::from_center_size(room.center(), size))
        .constrain_to(room);
    window.show(ui.ctx(), |ui| {
        ui.horizontal_top(|ui| {
            let height = ui.available_height();
            ui.allocate_ui_with_layout(
                vec2(CONTENTS, height),
                Layout::top_down(Align::Min),
                |ui| {
                    ui.set_width(CONTENTS);
                    show_contents(ui, reading);
                },
            );
            ui.separator();
            ui.vertical(|ui| {
                let goes_to = reading.goes_to.take();
                let scrolled = scroll_area(reading.page.name);
                let scrolled = if goes_to.as_deref() == Some("") {
                    scrolled.vertical_scroll_offset(0.0)
                } else {
                    scrolled
                };
                let went = scrolled.show(ui, |ui| show_page(ui, reading.page, goes_to.as_deref()));
                if let Some(target) = went.inner {
                    reading.follow(&target);
                }
            });
        });
    });
    if !is_open {
        commands.push(Command::Dismiss);
    }
}

/// The pages with the headings of the one that is read, or where what is sought stands.
fn show_contents(ui: &mut Ui, reading: &mut Reading) {
    let field = TextEdit::singleline(&mut reading.search)
        .desired_width(f32::INFINITY)
        .hint_text("Search the guide");
    let response = ui.add(field);
    named(&response, "Search the guide");
    let mut goes = None;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let sought = reading.search.trim().to_lowercase();
        if sought.is_empty() {
            for page in guide_pages() {
                let is_read = page.name == reading.page.name;
                if ui.selectable_label(is_read, page.about).clicked() {
                    goes = Some(page.name.to_owned());
                }
                if is_read {
                    goes = show_headings(ui, page).or_else(|| goes.take());
                }
            }
            return;
        }
        let hits: Vec<Hit> = guide_pages()
            .iter()
            .flat_map(|page| hits(page, &sought))
            .collect();
        if hits.is_empty() {
            ui.label("Nothing in the guide holds that");
        }
        for hit in hits {
            let title = RichText::new(format!("{} · {}", hit.page.about, hit.heading));
            if ui.selectable_label(false, title).clicked() {
                goes = Some(format!("{}#{}", hit.page.name, anchor(&hit.heading)));
            }
            paragraph(ui, quiet(hit.words));
        }
    });
    if let Some(target) = goes {
        reading.follow(&target);
    }
}

fn show_headings(ui: &mut Ui, page: &GuidePage) -> Option<String> {
    let mut goes = None;
    for block in blocks(page.text) {
        if let Block::Heading(2, title) = block {
            ui.horizontal(|ui| {
                ui.add_space(3.0 * STEP);
                let text = RichText::new(&title).font(theme::small());
                if ui.selectable_label(false, text).clicked() {
                    goes = Some(format!("{}#{}", page.name, anchor(&title)));
                }
            });
        }
    }
    goes
}

/// A place of the guide where what is sought stands.
#[derive(Debug, PartialEq, Eq)]
struct Hit {
    page: &'static GuidePage,
    /// The heading above it.
    heading: String,
    /// What stands around it.
    words: String,
}

/// The sections of a page that hold what is sought, each once.
fn hits(page: &'static GuidePage, sought: &str) -> Vec<Hit> {
    let mut hits: Vec<Hit> = Vec::new();
    let mut heading = String::new();
    for block in blocks(page.text) {
        let text = match &block {
            Block::Heading(_, title) => {
                heading.clone_from(title);
                title.clone()
            }
            Block::Paragraph(spans) | Block::Point(_, spans) => joined(spans),
            Block::Code(code) => code.clone(),
            Block::Table(rows) => {
                let rows = rows.iter().map(|cells| {
                    let cells: Vec<String> = cells.iter().map(|cell| joined(cell)).collect();
                    cells.join(" · ")
                });
                rows.collect::<Vec<_>>().join("\n")
            }
        };
        let is_new = hits.last().is_none_or(|last| last.heading != heading);
        if let (true, Some(words)) = (is_new, around(&text, sought)) {
            hits.push(Hit {
                page,
                heading: heading.clone(),
                words,
            });
        }
    }
    hits
}

fn joined(spans: &[Span]) -> String {
    spans.iter().map(Span::text).collect()
}

/// What stands around the first place of `sought` in lower case; `None` if it is not there.
fn around(text: &str, sought: &str) -> Option<String> {
    let letters: Vec<char> = text.chars().collect();
    let lower: Vec<char> = text.chars().flat_map(char::to_lowercase).collect();
    let sought: Vec<char> = sought.chars().collect();
    let at = lower
        .windows(sought.len())
        .position(|window| window == sought)?;
    let start = at.saturating_sub(AROUND / 2);
    let end = (at + sought.len() + AROUND).min(letters.len());
    let words: String = letters.get(start..end)?.iter().collect();
    let [before, after] = [start > 0, end < letters.len()].map(|cut| if cut { "…" } else { "" });
    Some(format!("{before}{}{after}", words.replace('\n', " ")))
}

/// Shows a page; says where a link that was clicked leads.
fn show_page(ui: &mut Ui, page: &GuidePage, goes_to: Option<&str>) -> Option<String> {
    let mut went = None;
    ui.set_width(ui.available_width() - 2.0 * STEP);
    for block in blocks(page.text) {
        match block {
            Block::Heading(depth, title) => {
                ui.add_space(if depth < 3 { 3.0 * STEP } else { STEP });
                let font = if depth < 3 {
                    theme::title()
                } else {
                    theme::body()
                };
                let ink = Palette::in_ui(ui).text;
                let response = ui.label(RichText::new(&title).font(font).strong().color(ink));
                if goes_to.is_some_and(|heading| heading == anchor(&title)) {
                    response.scroll_to_me(Some(Align::Min));
                }
            }
            Block::Paragraph(spans) => went = show_spans(ui, &spans).or(went),
            Block::Point(bullet, spans) => {
                ui.horizontal_top(|ui| {
                    let size = vec2(INDENT, theme::body().size);
                    let (place, _) = ui.allocate_exact_size(size, Sense::hover());
                    let ink = Palette::in_ui(ui).text;
                    let at = place.right_top() - vec2(STEP, 0.0);
                    let font = theme::body();
                    ui.painter()
                        .text(at, egui::Align2::RIGHT_TOP, bullet.trim(), font, ink);
                    ui.vertical(|ui| went = show_spans(ui, &spans).or_else(|| went.take()));
                });
            }
            Block::Code(code) => {
                let frame = egui::Frame::new().fill(Palette::in_ui(ui).floor);
                frame.inner_margin(2.0 * STEP).show(ui, |ui| {
                    ui.set_width(ui.available_width());
                    let text = RichText::new(code).font(theme::small_number());
                    ui.add(egui::Label::new(text).wrap().selectable(true));
                });
            }
            Block::Table(rows) => went = show_table(ui, &rows).or(went),
        }
        ui.add_space(STEP);
    }
    went
}

/// A table: the first column narrow, the rest as wide as there is room.
fn show_table(ui: &mut Ui, rows: &[Vec<Vec<Span>>]) -> Option<String> {
    let mut went = None;
    let n_columns = rows.iter().map(Vec::len).max().unwrap_or(1).max(1);
    let width = ui.available_width() - STEP * n_columns as f32;
    let first = if n_columns > 1 { 0.28 } else { 1.0 };
    let others = (1.0 - first) / (n_columns.max(2) - 1) as f32;
    for row in rows {
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = STEP;
            for (column, cell) in row.iter().enumerate() {
                let share = if column == 0 { first } else { others };
                let size = vec2(share * width, 0.0);
                ui.allocate_ui_with_layout(size, Layout::top_down(Align::Min), |ui| {
                    ui.set_width(size.x);
                    went = show_spans(ui, cell).or_else(|| went.take());
                });
            }
        });
        ui.separator();
    }
    went
}

/// Lines that flow; says where a link that was clicked leads.
fn show_spans(ui: &mut Ui, spans: &[Span]) -> Option<String> {
    let palette = Palette::in_ui(ui);
    let mut went = None;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        for span in spans {
            let text = RichText::new(span.text()).font(theme::body());
            let show = |ui: &mut Ui, text: RichText, ink: Color32| {
                ui.add(egui::Label::new(text.color(ink)).selectable(true));
            };
            match span {
                Span::Plain(_) => show(ui, text, palette.text),
                Span::Bold(_) => show(ui, text.strong(), palette.selection),
                Span::Slanted(_) => show(ui, text.italics(), palette.text),
                Span::Code(_) => show(ui, text.font(theme::number()), palette.text),
                Span::Link(_, target) => {
                    if ui.link(text).clicked() {
                        went = Some(target.clone());
                    }
                }
            }
        }
    });
    went
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::bench::command::ShowCommand;
    use crate::shell::headless::Headless;
    use crate::shell::state::Cover;

    #[test]
    fn a_search_finds_each_section_once_with_the_words_around() {
        let found = hits(&guide_pages()[0], "compression");
        assert!(!found.is_empty());
        for (one, next) in found.iter().zip(&found[1..]) {
            assert_ne!(one.heading, next.heading);
        }
        assert!(found[0].words.to_lowercase().contains("compression"));
        assert!(hits(&guide_pages()[0], "no such words at all").is_empty());
    }

    #[test]
    fn every_page_is_shown_and_escape_closes_the_guide() {
        let mut window = Headless::shipped();
        window.pass(2);
        for page in guide_pages() {
            window.dispatch(ShowCommand::Guide(Some(page.name.to_owned())));
            window.pass(2);
            let Some(Cover::Guide(reading)) = &window.workbench.shell.cover else {
                panic!("the guide is not shown")
            };
            assert_eq!(reading.page.name, page.name);
        }
        window.dispatch(Command::Escape);
        assert_eq!(window.workbench.shell.cover, None);
    }

    #[test]
    fn every_letter_of_the_guide_can_be_drawn() {
        let mut window = Headless::shipped();
        window.pass(2);
        for font in [theme::body(), theme::number()] {
            for page in guide_pages() {
                let is_missing = |c: &char| {
                    !c.is_control() && !window.ctx.fonts_mut(|fonts| fonts.has_glyph(&font, *c))
                };
                let missing: String = page.text.chars().filter(is_missing).collect();
                assert_eq!(missing, "", "{} in {font:?}", page.name);
            }
        }
    }

    #[test]
    fn a_link_leads_to_its_page_and_heading() {
        let mut reading = Reading::of(None);
        reading.follow("bridge.md#session-log");
        assert_eq!(reading.page.name, "bridge");
        assert_eq!(reading.goes_to.as_deref(), Some("session-log"));
        reading.follow("#armed");
        assert_eq!(reading.page.name, "bridge", "a heading of the same page");
    }
}
