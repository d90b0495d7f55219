//! A figure of panels as SVG text: where every panel lies, and what is drawn in it.

use super::frame::Frame;
use super::legend::{self, LINE_PX};
use super::look::{Inks, looks};
use super::marks::{hairline, text, upward_text};
use super::raster::{Placed, hex};
use super::svg::{MARGIN_PX, WIDTH_PX, opening, paper};
use super::text::{escaped, wrapped};
use super::ticks::Ruler;
use super::{Chart, ColourBar, Figure, FigureError, Paper, Row, Upright};

/// Above the first row: the title.
const TITLE_PX: f64 = 40.0;
/// Above a frame: its title and its legend; and where it has neither.
const HEADS_PX: [f64; 2] = [26.0, 12.0];
/// Below a frame: labels and the title of the axis; and where it has neither.
const FEET_PX: [f64; 2] = [50.0, 6.0];
/// Left of a frame: labels and the title of the axis; and of another on its left.
const LABELS_PX: [f64; 2] = [56.0, 72.0];
/// Left of a frame that shares its axis.
const SHARED_PX: f64 = 22.0;
/// From a row's last frame to the colour bar.
const BAR_GAP_PX: f64 = 12.0;
/// Right of a row's last frame, and of the colour bar's labels.
const RIGHT_PX: f64 = 24.0;
/// Characters of a note that fit in a line.
const NOTE_CHARACTERS: usize = 140;
/// The colour bar with its labels and its title.
const BAR_PX: f64 = 84.0;
/// The bar itself.
const BAR_WIDTH_PX: f64 = 12.0;

/// A panel and its frame.
struct Laid<'a> {
    panel: &'a Chart,
    frame: Frame,
}

/// A row and where it lies.
struct LaidRow<'a> {
    row: &'a Row,
    panels: Vec<Laid<'a>>,
}

/// A figure with every place in it.
pub(super) struct Page<'a> {
    figure: &'a Figure,
    inks: &'static Inks,
    rows: Vec<LaidRow<'a>>,
    notes_px: f64,
    notes: Vec<String>,
}

impl Figure {
    /// The picture as SVG text. The same figure gives the same bytes.
    ///
    /// # Errors
    /// A raster cannot be made into a picture: it has no cells, or too many.
    pub fn to_svg(&self) -> Result<String, FigureError> {
        let page = Page::of(self, Paper::White);
        let images: Result<Vec<String>, _> = page.pictures().map(|one| one.image()).collect();
        let ground = paper(page.height_px(), page.inks) + &images?.concat();
        Ok(page.document(&ground))
    }
}

impl Figure {
    /// Where a point of its first panel lies in its picture at the size that it is laid out for,
    /// px; `None` for one that has no place in it.
    pub fn point_px(&self, at: [f64; 2]) -> Option<[f64; 2]> {
        let page = Page::of(self, Paper::White);
        let laid = page.panels().next()?;
        laid.frame.place(at).filter(|at_px| laid.frame.has(*at_px))
    }
}

impl<'a> Page<'a> {
    /// Lays a figure out.
    pub(super) fn of(figure: &'a Figure, paper: Paper) -> Self {
        let inks = paper.inks();
        let mut top_px = TITLE_PX;
        let mut rows = Vec::new();
        for (row, has_bar) in figure.rows.iter().zip(leave_room_for_bars(&figure.rows)) {
            top_px += head_px(row);
            rows.push(LaidRow::of((row, has_bar), top_px, inks));
            top_px += row.height_px + foot_px(row);
        }
        let lines = figure.notes.iter();
        let notes = lines.flat_map(|note| wrapped(note, NOTE_CHARACTERS));
        Self {
            figure,
            inks,
            rows,
            notes_px: top_px + 12.0,
            notes: notes.collect(),
        }
    }

    /// Its height, px.
    pub(super) fn height_px(&self) -> f64 {
        self.notes_px + self.notes.len() as f64 * LINE_PX + 4.0
    }

    /// The rasters that are pictures within.
    pub(super) fn pictures(&self) -> impl Iterator<Item = Placed<'_>> {
        self.panels()
            .filter_map(Laid::raster)
            .filter(Placed::is_picture)
    }

    /// Everything that is drawn over a ground.
    pub(super) fn document(&self, ground: &str) -> String {
        let mut body = Vec::new();
        let (title, inks) = (&self.figure.title, self.inks);
        text(&mut body, [MARGIN_PX, 28.0], ("start", 16, inks.ink), title);
        let mut clips = Vec::new();
        for (index, laid) in self.panels().enumerate() {
            let clip = format!("frame{index}");
            laid.draw(&clip, &mut body);
            clips.push((clip, &laid.frame));
        }
        for (index, laid) in self.rows.iter().enumerate() {
            laid.draw_bar(index, &mut body);
        }
        for (line, note) in self.notes.iter().enumerate() {
            let at = [MARGIN_PX, self.notes_px + line as f64 * LINE_PX];
            text(&mut body, at, ("start", 11, inks.grey), note);
        }
        let opening = opening(title, self.height_px(), &clips);
        let about = self.about();
        let body = body.concat();
        format!("{opening}{about}{ground}{body}</svg>\n")
    }

    fn about(&self) -> String {
        let line = |(name, value): &(String, String)| format!("{name} = {value}\n");
        let lines: Vec<String> = self.figure.about.iter().map(line).collect();
        if lines.is_empty() {
            return String::new();
        }
        let lines: String = lines
            .iter()
            .map(|line| escaped(line.trim_end()) + "\n")
            .collect();
        format!("<desc>{lines}</desc>\n")
    }

    fn panels(&self) -> impl Iterator<Item = &Laid<'a>> {
        self.rows.iter().flat_map(|row| &row.panels)
    }
}

/// Whether a bar's room is left at the right end of each row: rows over one axis that they share
/// have frames that are equally wide.
fn leave_room_for_bars(rows: &[Row]) -> Vec<bool> {
    let is_last = |row: &Row| !row.panels.iter().all(|panel| panel.is_x_shared);
    let together = rows.split_inclusive(is_last);
    let has_bar = |group: &[Row]| vec![group.iter().any(|row| row.bar.is_some()); group.len()];
    together.flat_map(has_bar).collect()
}

/// What stands above the frames of a row, px.
fn head_px(row: &Row) -> f64 {
    let is_named = |panel: &Chart| {
        let has_legend = panel.series.iter().any(|series| !series.name.is_empty());
        !panel.title.is_empty() || has_legend
    };
    HEADS_PX[usize::from(!row.panels.iter().any(is_named))]
}

/// What stands below the frames of a row, px.
fn foot_px(row: &Row) -> f64 {
    FEET_PX[usize::from(row.panels.iter().all(|panel| panel.is_x_shared))]
}

impl<'a> LaidRow<'a> {
    fn of((row, has_bar): (&'a Row, bool), top_px: f64, inks: &'static Inks) -> Self {
        let before_px = |(index, panel): (usize, &Chart)| match panel.upright {
            Upright::Shared => SHARED_PX,
            Upright::Upward | Upright::Downward => LABELS_PX[index.min(1)],
        };
        let share = |panel: &Chart| if panel.width > 0.0 { panel.width } else { 1.0 };
        let bar_px = if has_bar { BAR_PX } else { 0.0 };
        let taken_px: f64 = row.panels.iter().enumerate().map(before_px).sum();
        let shares: f64 = row.panels.iter().map(share).sum();
        let room_px = WIDTH_PX - MARGIN_PX - RIGHT_PX - bar_px - taken_px;
        let mut left_px = MARGIN_PX;
        let mut panels = Vec::new();
        for (index, panel) in row.panels.iter().enumerate() {
            left_px += before_px((index, panel));
            let width_px = (room_px * share(panel) / shares).floor();
            let size_px = [width_px, row.height_px];
            panels.push(Laid::of(panel, [left_px, top_px], size_px, inks));
            left_px += width_px;
        }
        Self { row, panels }
    }

    /// The colour bar right of the last panel.
    fn draw_bar(&self, index: usize, body: &mut Vec<String>) {
        let (Some(bar), Some(last)) = (&self.row.bar, self.panels.last()) else {
            return;
        };
        let frame = Frame {
            x: Ruler::of(&super::Axis::default(), std::iter::empty()),
            y: Ruler::of(&bar.axis, std::iter::empty()),
            corner_px: [last.frame.right_px() + BAR_GAP_PX, last.frame.corner_px[1]],
            size_px: [BAR_WIDTH_PX, self.row.height_px],
            is_downward: false,
            inks: last.frame.inks,
        };
        draw_gradient(bar, index, &frame, body);
        let title = super::label::Labels::of(&frame.y, &bar.axis.label);
        for (value, label) in frame.y.labelled.iter().zip(&title.ticks) {
            let y_px = frame.y_px(*value).unwrap_or_else(|| frame.bottom_px());
            let right_px = frame.right_px();
            hairline(
                body,
                frame.inks.grey,
                [right_px, y_px],
                [right_px + 4.0, y_px],
            );
            let at = [right_px + 8.0, y_px + 4.0];
            text(body, at, ("start", 11, frame.inks.grey), label);
        }
        let middle_px = frame.corner_px[1] + 0.5 * frame.size_px[1];
        let at = [frame.right_px() + 52.0, middle_px];
        upward_text(body, at, frame.inks.ink, &title.title);
    }
}

fn draw_gradient(bar: &ColourBar, index: usize, frame: &Frame, body: &mut Vec<String>) {
    let last = bar.colours.len().saturating_sub(1).max(1) as f64;
    let stop = |(i, colour): (usize, &[u8; 3])| {
        let (share, colour) = (i as f64 / last, hex(*colour));
        format!("<stop offset=\"{share:.4}\" stop-color=\"{colour}\"/>")
    };
    let stops: String = bar.colours.iter().enumerate().map(stop).collect();
    let ([x, y], [width, height]) = (frame.corner_px, frame.size_px);
    body.push(format!(
        "<linearGradient id=\"bar{index}\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">{stops}\
         </linearGradient>\n<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" \
         fill=\"url(#bar{index})\"/>\n"
    ));
}

impl<'a> Laid<'a> {
    fn of(panel: &'a Chart, corner_px: [f64; 2], size_px: [f64; 2], inks: &'static Inks) -> Self {
        let [x, y] = panel.rulers();
        let frame = Frame {
            x,
            y,
            corner_px,
            size_px,
            is_downward: panel.upright == Upright::Downward,
            inks,
        };
        Self { panel, frame }
    }

    fn raster(&self) -> Option<Placed<'_>> {
        let raster = self.panel.raster.as_ref()?;
        Some(Placed {
            raster,
            corner_px: self.frame.corner_px,
            size_px: self.frame.size_px,
        })
    }

    fn draw(&self, clip: &str, body: &mut Vec<String>) {
        let (panel, frame) = (self.panel, &self.frame);
        match self.raster() {
            Some(placed) => {
                if !placed.is_picture() {
                    body.push(placed.rectangles());
                }
                frame.draw_marks(body);
            }
            None => frame.draw_hairlines(body),
        }
        frame.draw_areas(panel, clip, body);
        for rule in &panel.rules {
            frame.draw_rule(rule, body);
        }
        let looks = looks(&panel.series, frame.inks);
        for (series, look) in panel.series.iter().zip(&looks) {
            // Gaps in a panel mean something: a pause, silence.
            frame.draw_series(series, *look, clip, body);
        }
        frame.draw_edge(body);
        self.draw_axes(body);
        frame.draw_words(panel, body);
        let [left_px, top_px] = frame.corner_px;
        let head = ("start", 12, panel.ink.letters(frame.inks));
        text(body, [left_px, top_px - 9.0], head, &panel.title);
        let legend_at = [frame.right_px(), top_px - 13.0];
        legend::draw_across(&panel.series, (&looks, frame.inks), legend_at, body);
    }

    fn draw_axes(&self, body: &mut Vec<String>) {
        let (panel, frame) = (self.panel, &self.frame);
        if !panel.is_x_shared {
            let x_title = frame.draw_x_labels(&panel.x.label, body);
            let middle_px = frame.corner_px[0] + 0.5 * frame.size_px[0];
            let below = [middle_px, frame.bottom_px() + 38.0];
            text(body, below, ("middle", 12, frame.inks.ink), &x_title);
        }
        if panel.upright != Upright::Shared {
            let y_title = frame.draw_y_labels(&panel.y.label, body);
            let middle_px = frame.corner_px[1] + 0.5 * frame.size_px[1];
            let at = [frame.corner_px[0] - 46.0, middle_px];
            upward_text(body, at, frame.inks.ink, &y_title);
        }
    }
}
