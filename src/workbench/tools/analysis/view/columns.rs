//! How the columns of a table are laid out: decimals, words, widths; and what is kept of that.

use std::sync::Arc;

use eframe::egui::{ColorImage, FontId, TextureHandle, Ui};

use crate::kit::theme;
use crate::tools::analysis::findings::Findings;
use crate::tools::analysis::view::words::plain;
use selvedge_experiment::analysis::{Cell, Column, Section, Table};
use selvedge_foundation::quantity;

/// Space between columns, points.
pub(crate) const GAP: f32 = 18.0;
/// Texts are cut off at this width, points.
const WIDEST_TEXT: f32 = 260.0;
/// Headings are broken at this width unless what is below is wider, points.
const HEADING: f32 = 84.0;
/// Of so many of the longest texts of a column the width is measured.
const N_MEASURED: usize = 6;
/// The most decimals.
const MOST_DECIMALS: usize = 4;
/// How the names of columns end, and the unit that this means.
const UNITS: [(&str, &str); 8] = [
    ("_percent", "%"),
    ("_mm_per_s", "mm/s"),
    ("_um", "µm"),
    ("_db", "dB"),
    ("_hz", "Hz"),
    ("_deg", "°"),
    ("_mm", "mm"),
    ("_s", "s"),
];

/// How a table is laid out.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TableLook {
    /// Its columns.
    pub(crate) columns: Vec<ColumnLook>,
    /// All of them with the space between, points.
    pub(crate) width: f32,
    /// Whether one of them has a unit.
    pub(crate) has_units: bool,
}

/// How a column is laid out.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ColumnLook {
    /// What stands above it, without the unit.
    pub(crate) heading: String,
    /// Its unit; may be empty.
    pub(crate) unit: String,
    /// Digits after the point; `None` for a column of texts.
    pub(crate) decimals: Option<usize>,
    /// Its width, points.
    pub(crate) width: f32,
}

/// Tables and figures of the section at hand as they are laid out.
#[derive(Default)]
pub(crate) struct Looks {
    of: Option<(Arc<Findings>, usize)>,
    /// By their place in the section.
    pub(crate) tables: Vec<Option<TableLook>>,
    /// The same; the picture that each was made of.
    pub(crate) textures: Vec<Option<(Arc<ColorImage>, TextureHandle)>>,
}

impl Looks {
    /// Forgets what belongs to another section.
    pub(crate) fn turn_to(&mut self, found: &Arc<Findings>, nth: usize, section: &Section) {
        let is_same = |(of, at): &(Arc<Findings>, usize)| Arc::ptr_eq(of, found) && *at == nth;
        if self.of.as_ref().is_some_and(is_same) {
            return;
        }
        self.of = Some((Arc::clone(found), nth));
        self.tables = section.tables.iter().map(|_| None).collect();
        self.textures = section.figures.iter().map(|_| None).collect();
    }
}

impl std::fmt::Debug for Looks {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Looks")
            .field("section", &self.of.as_ref().map(|(_, nth)| nth))
            .finish_non_exhaustive()
    }
}

impl TableLook {
    /// Lays a table out.
    pub(crate) fn of(ui: &Ui, table: &Table) -> Self {
        let columns: Vec<ColumnLook> = (0..table.columns.len())
            .map(|at| ColumnLook::of(ui, table, at))
            .collect();
        let widths: f32 = columns.iter().map(|column| column.width + GAP).sum();
        Self {
            has_units: columns.iter().any(|column| !column.unit.is_empty()),
            columns,
            width: widths,
        }
    }
}

impl ColumnLook {
    fn of(ui: &Ui, table: &Table, at: usize) -> Self {
        let column = &table.columns[at];
        let cells = || table.rows.iter().filter_map(move |row| row.get(at));
        let has_texts = cells().any(|cell| matches!(cell, Cell::Text(_)));
        let digits = decimals(cells().filter_map(Cell::number), &column.name);
        // Dashes alone stand where numbers would.
        let decimals = if has_texts {
            digits
        } else {
            digits.or(Some(0))
        };
        let (heading, unit) = headed(column);
        let mut texts: Vec<String> = cells()
            .map(|cell| described(cell, column, decimals))
            .collect();
        texts.sort_by_key(|text| std::cmp::Reverse(text.chars().count()));
        let font = match decimals {
            Some(_) => theme::number(),
            None => theme::body(),
        };
        let longest = texts.into_iter().take(N_MEASURED);
        let content = longest.map(|text| measured(ui, text, font.clone()));
        let content = content.fold(0.0_f32, f32::max).min(WIDEST_TEXT);
        let small = |words: &str| measured(ui, words.to_owned(), theme::small());
        let word = heading.split(' ').map(small).fold(0.0_f32, f32::max);
        let least = word.max(small(&heading).min(HEADING)).max(small(&unit));
        Self {
            heading,
            unit,
            decimals,
            // Letters are placed to whole pixels.
            width: content.max(least).ceil() + 1.0,
        }
    }
}

fn measured(ui: &Ui, text: String, font: FontId) -> f32 {
    let ink = eframe::egui::Color32::PLACEHOLDER;
    ui.painter().layout_no_wrap(text, font, ink).size().x
}

/// A heading and its unit: what stands behind its comma, or what the column's name ends in.
fn headed(column: &Column) -> (String, String) {
    let heading = plain(&column.heading);
    let is_unit = |unit: &str| UNITS.iter().any(|(_, known)| *known == unit);
    if is_unit(&heading) {
        return (heading, String::new());
    }
    if let Some((words, unit)) = heading.rsplit_once(", ")
        && (is_unit(unit) || unit.starts_with("dB re"))
    {
        return (words.to_owned(), unit.to_owned());
    }
    let known = UNITS.iter().find(|(end, _)| column.name.ends_with(end));
    let says = |unit: &&str| heading.split(' ').next_back() == Some(unit);
    let unit = known.map(|(_, unit)| *unit).filter(|unit| !says(unit));
    (heading, unit.unwrap_or_default().to_owned())
}

/// Digits after the point that all numbers of a column have: four that count for the smallest, as
/// far as there is room; `None` where there is no number.
fn decimals(numbers: impl Iterator<Item = f64>, name: &str) -> Option<usize> {
    let mut n_decimals = None;
    for value in numbers {
        let own = if is_probability(name) {
            MOST_DECIMALS
        } else if is_whole(value) {
            0
        } else {
            let digits = 3.0 - value.abs().log10().floor();
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "between 0 and 4"
            )]
            let digits = digits.clamp(0.0, MOST_DECIMALS as f64) as usize;
            digits
        };
        n_decimals = n_decimals.max(Some(own));
    }
    n_decimals
}

fn is_whole(value: f64) -> bool {
    (value - value.round()).abs() < 1e-9
}

fn is_probability(name: &str) -> bool {
    name == "p" || name.starts_with("p_") || name.ends_with("_p")
}

/// What stands in a cell.
pub(crate) fn described(cell: &Cell, column: &Column, decimals: Option<usize>) -> String {
    match cell {
        Cell::Number(value) => number(*value, decimals.unwrap_or(0), &column.name),
        Cell::Text(text) => plain(text),
        Cell::Undefined(_) => "–".to_owned(),
    }
}

/// A number with these digits after the point; where none of them counts, how small it is.
fn number(value: f64, decimals: usize, name: &str) -> String {
    let least = 0.1_f64.powi(i32::try_from(decimals).unwrap_or(0));
    let is_lost = value.abs() < 0.5 * least && value.abs() > 0.0;
    if is_lost && is_probability(name) {
        return format!("<{}", quantity::fixed(least, decimals));
    }
    if is_lost || value.abs() >= 1e7 {
        return format!("{value:.1e}").replace('-', "−");
    }
    quantity::fixed(value, decimals)
}

/// All that is known of a cell.
pub(crate) fn tip(cell: &Cell, column: &Column) -> String {
    let (heading, unit) = headed(column);
    let name = if heading.is_empty() {
        String::new()
    } else {
        format!("{heading}: ")
    };
    match cell {
        Cell::Number(value) => {
            let digits = value.to_string().replace('-', "−");
            format!("{name}{digits} {unit}").trim_end().to_owned()
        }
        Cell::Text(text) => format!("{name}{}", plain(text)),
        Cell::Undefined(reason) => format!("{name}not computable: {reason}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(name: &str, heading: &str) -> Column {
        Column {
            name: name.to_owned(),
            heading: heading.to_owned(),
        }
    }

    #[test]
    fn numbers_of_a_column_share_their_decimals() {
        let of = |numbers: &[f64], name| decimals(numbers.iter().copied(), name);
        assert_eq!(of(&[80.0, 4.0], "n"), Some(0));
        assert_eq!(of(&[50.78, 2.908], "mean"), Some(3));
        assert_eq!(of(&[0.8612, 25.0], "mean"), Some(4));
        assert_eq!(of(&[25.08, -28.08], "value"), Some(2));
        assert_eq!(of(&[1.0], "p"), Some(4));
        assert_eq!(of(&[], "mean"), None);
    }

    #[test]
    fn what_is_lost_in_rounding_is_said_to_be_small_and_never_to_be_nothing() {
        assert_eq!(number(4.1e-8, 4, "p"), "<0.0001");
        assert_eq!(number(0.049_96, 4, "two_sided_p"), "0.0500");
        assert_eq!(number(-3.2e-7, 4, "mean"), "−3.2e−7");
        assert_eq!(number(0.0, 4, "p"), "0.0000");
        assert_eq!(number(-28.08, 2, "value"), "−28.08");
    }

    #[test]
    fn units_stand_apart_from_headings() {
        let of = |name, heading| headed(&column(name, heading));
        let pair = |heading: &str, unit: &str| (heading.to_owned(), unit.to_owned());
        assert_eq!(of("angle_deg", "angle, °"), pair("angle", "°"));
        assert_eq!(of("threshold_db", "threshold"), pair("threshold", "dB"));
        let from = pair("95 % CI from", "%");
        assert_eq!(of("ci_low_percent", "95 % CI from"), from);
        assert_eq!(
            of("share_percent", "called real %"),
            pair("called real %", "")
        );
        assert_eq!(of("percent", "%"), pair("%", ""));
        assert_eq!(of("d_prime", "d′, 4-AFC"), pair("d′, 4-AFC", ""));
    }

    #[test]
    fn an_empty_cell_says_why() {
        let p = column("p", "p");
        let cell = Cell::Undefined("one subject has no spread".to_owned());
        assert_eq!(described(&cell, &p, Some(4)), "–");
        assert_eq!(
            tip(&cell, &p),
            "p: not computable: one subject has no spread"
        );
        assert_eq!(tip(&Cell::Number(-0.125), &p), "p: −0.125");
    }
}
