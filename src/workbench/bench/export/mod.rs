//! Export: what a pane shows, as a table and as a figure, with where it comes from.
//!
//! ```text
//! button ─▶ FileCommand::Ask(Purpose::Export(what)) ─▶ Tool::export of the pane's tool
//!      ─▶ Exported { sheet, figure, origin }, kept while the path is asked for
//!      ─▶ .csv, .svg or .png by the name's ending, written whole in the background
//! ```
//!
//! A pane that shows a chart exports that chart: `exported` in the tool's own files joins it with a
//! note and its origin. To export another pane, write its tool's `Tool::export`. Button, menu,
//! dialog, notices, kinds of files and provenance come with that.
//!
//! # Tables
//! UTF-8, comma, decimal point, one header line with units in the names, one row an observation,
//! shortest round-trip digits; a cell is empty where there is no finite number (silence has no
//! level). Before the header stand lines `# key = value` that say where the numbers come from. What
//! reads tables in this program passes over such lines; others call them comments.
//!
//! # Invariants
//! - every number is one that the pane shows, from the same functions
//! - the same view gives the same bytes: no clock, no path, no name of a machine
//! - what is exported is what was seen when it was asked for, however long the path takes

pub(crate) mod button;
pub(crate) mod cells;
pub(crate) mod origin;
#[cfg(test)]
mod tests;
pub(crate) mod write;

pub(crate) use crate::bench::export::origin::Origin;
#[cfg(test)]
pub(crate) use crate::bench::export::write::Kind;
pub(crate) use crate::bench::pane::Exportable;
pub(crate) use selvedge_chart::Columns as Sheet;

use crate::kit::theme::colour_map::ColourMap;
use selvedge_chart::{Axis, Chart, ColourBar, Figure, Ink, Row};
use selvedge_textile::tactile::Band;

/// Colours of a bar: more than the eye tells apart.
pub(crate) const N_COLOURS: u8 = 33;

/// Why there is nothing to export before anything was felt.
pub(crate) const NOTHING_FELT: &str =
    "There is nothing to export yet: move over a textile, or let the display explore by itself";
/// Why there is nothing to export of no contactor.
pub(crate) const NO_CONTACTOR: &str =
    "There is nothing to export: choose a contactor first, by a click on a cell of the heatmaps";

/// What a band is drawn with.
pub(crate) fn ink(band: Band) -> Ink {
    match band {
        Band::Low => Ink::Amber,
        Band::High => Ink::Cyan,
    }
}

/// A table and a figure of the same numbers, and where they come from.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Exported {
    /// The numbers.
    pub sheet: Sheet,
    /// The picture, without provenance.
    pub figure: Figure,
    /// Where they come from.
    pub origin: Origin,
}

impl Exported {
    /// A table and the rows of its figure. `note` says what is drawn how.
    pub(crate) fn new(
        title: String,
        sheet: Sheet,
        rows: Vec<Row>,
        note: &str,
        origin: Origin,
    ) -> Self {
        let figure = Figure {
            title,
            rows,
            notes: std::iter::once(note.to_owned())
                .chain(origin.lines())
                .collect(),
            about: origin.pairs(),
        };
        Self {
            sheet,
            figure,
            origin,
        }
    }
}

impl Exported {
    /// A chart with its numbers. `note` says what is drawn how.
    pub(crate) fn of_chart(
        title: &str,
        chart: Chart,
        height_px: f64,
        note: &str,
        origin: Origin,
    ) -> Self {
        let sheet = chart.columns.clone();
        let rows = vec![row(chart, height_px)];
        Self::new(title.to_owned(), sheet, rows, note, origin)
    }
}

/// A row of one panel, without a bar of colours.
pub(crate) fn row(panel: Chart, height_px: f64) -> Row {
    Row {
        panels: vec![panel],
        height_px,
        bar: None,
    }
}

/// The colour of a share 0…1 of a map's scale.
pub(crate) fn rgb(map: ColourMap, share: f64) -> [u8; 3] {
    let [r, g, b, _] = map.colour(share).to_array();
    [r, g, b]
}

/// The bar of a map over an axis.
pub(crate) fn bar(map: ColourMap, axis: Axis) -> ColourBar {
    let last = f64::from(N_COLOURS - 1);
    let colours = (0..N_COLOURS).map(|i| rgb(map, f64::from(i) / last));
    ColourBar {
        axis,
        colours: colours.collect(),
    }
}
