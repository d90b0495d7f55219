//! Heights in texts: one column, places and heights, `X;Y;valid`, a matrix, or several profiles
//! side by side, of which one is asked for. Headers are looked through for units.

use std::path::Path;

use super::reading::{About, Stated, UNEVEN_MEND};
use super::{HeightOptions, LengthUnit, Reading, n_points};
use crate::number_table::{NoTable, RawTable, table_with_gaps};
use selvedge_foundation::files::FileError;
use selvedge_foundation::files::decoded;

/// Reads a profile or a map.
pub(super) fn read(bytes: &[u8], path: &Path, asked: &HeightOptions) -> Result<Reading, FileError> {
    let text = decoded(bytes).unwrap_or_default();
    let table = table_with_gaps(&text).map_err(|none| no_table(&none, path))?;
    n_points(table.columns.len(), table.lines.len(), path)?;
    let columns = Columns::of(table);
    let keys = MatrixKeys::of(&columns.table.header);
    let is_named = columns.headings.iter().any(|heading| !heading.is_empty());
    let is_matrix = keys.extents[0].is_some()
        || keys.steps[0].is_some()
        || (columns.numbers().len() > 3 && !is_named);
    if is_matrix && asked.column.is_none() {
        return matrix(columns.numbers(), keys, path);
    }
    let choice = Choice::of(&columns, asked, path)?;
    let mut reading = profile(&columns, &choice, path)?;
    if let Some(x) = choice.x {
        take_places(&mut reading, (&columns, x), asked, path)?;
    }
    Ok(reading)
}

/// Steps and their unit by the column of places. A step that was given stands for places whose unit
/// is not stated.
fn take_places(
    reading: &mut Reading,
    (columns, x): (&Columns, usize),
    asked: &HeightOptions,
    path: &Path,
) -> Result<(), FileError> {
    let unit = LengthUnit::in_heading(&columns.headings[x]);
    if asked.step_mm.is_some() && unit.is_none() {
        return Ok(());
    }
    let places = &columns.numbers()[x];
    let slack = rounding(places, columns.table.quanta[x]);
    let may_resample = asked.resample && rises(places);
    let step = reading.even_step((places, 0), slack, may_resample);
    let step = step.map_err(|what| {
        let what = format!("from line {}: {what}", columns.table.lines[0]);
        FileError::whole(path, what, UNEVEN_MEND)
    })?;
    if step < 0.0 {
        reading.values.values_mut().reverse();
    }
    // Nine digits: what is left of binary fractions goes.
    let step = format!("{:.8e}", step.abs())
        .parse()
        .unwrap_or_else(|_| step.abs());
    reading.steps = Some([step; 2]);
    reading.length_unit = unit.into();
    Ok(())
}

fn no_table(none: &NoTable, path: &Path) -> FileError {
    match *none {
        NoTable::Broken {
            line, n_columns, ..
        } => {
            let what = format!("not {n_columns} numbers as in the lines before");
            FileError::content(path, line, what, "correct or remove the line")
        }
        NoTable::NoNumbers { line } | NoTable::Ambiguous { line } => {
            let mend = "give lines of numbers, parted by tab, semicolon, comma or blanks";
            FileError::content(path, line, "no numbers at the end of the text", mend)
        }
        NoTable::TooLong => {
            let [what, mend] = NoTable::TOO_LONG;
            FileError::whole(path, what, mend)
        }
    }
}

/// The columns of a table with their headings, empty where there is none.
struct Columns {
    table: RawTable,
    headings: Vec<String>,
}

impl Columns {
    fn of(mut table: RawTable) -> Self {
        // Separators at the end of lines make columns that hold nothing and have no heading.
        let holds = |column: &Vec<f64>| column.iter().any(|number| !number.is_nan());
        let last = table.columns.iter().rposition(holds);
        let headed = table.header.last().and_then(|line| {
            let cells = table.dialect.cells(line);
            cells.iter().rposition(|cell| !cell.is_empty())
        });
        let n = headed.max(last).map_or(0, |last| last + 1);
        table.columns.truncate(n);
        let n = table.columns.len();
        let headings = table.headings(n).filter(|_| n > 1);
        let plain = |heading: String| {
            let plain = heading.replace(" #", " ");
            plain.trim_matches(['"', '#', ' ']).to_owned()
        };
        let headings = headings.unwrap_or_else(|| vec![String::new(); n]);
        Self {
            headings: headings.into_iter().map(plain).collect(),
            table,
        }
    }

    fn numbers(&self) -> &[Vec<f64>] {
        &self.table.columns
    }
}

/// Places that rounding may displace: fewer cannot show that they were even before.
const MIN_ROUNDED: usize = 32;

/// How far the digits that were written may displace places: a unit of the last `digit`, for a
/// place against the line between two others, where steps are longer than that.
fn rounding(places: &[f64], digit: f64) -> f64 {
    let span = (places[places.len() - 1] - places[0]).abs();
    let is_fine = span > digit * places.len() as f64;
    if is_fine && places.len() >= MIN_ROUNDED {
        digit
    } else {
        0.0
    }
}

/// Which columns are what.
struct Choice {
    x: Option<usize>,
    height: usize,
    valid: Option<usize>,
}

impl Choice {
    fn of(columns: &Columns, asked: &HeightOptions, path: &Path) -> Result<Self, FileError> {
        let n = columns.numbers().len();
        let x = (n > 1 && rises(&columns.numbers()[0])).then_some(0);
        if let Some(name) = &asked.column {
            let height = column_of(columns, name, path)?;
            // Numbers of rows are no places.
            let has_unit = LengthUnit::in_heading(&columns.headings[0]).is_some();
            let x = x.filter(|&x| x != height && (has_unit || asked.length_unit.is_some()));
            return Ok(Self {
                x,
                height,
                valid: None,
            });
        }
        let valid = (n == 3).then_some(2).filter(|&last| {
            let marks = columns.numbers()[last].iter();
            columns.headings[last].to_lowercase().contains("valid")
                || marks
                    .into_iter()
                    .all(|mark| *mark == 0.0 || (*mark - 1.0).abs() < 1e-9)
        });
        match (n, x, valid) {
            (1, ..) => Ok(Self {
                x: None,
                height: 0,
                valid: None,
            }),
            (2, Some(_), _) | (3, Some(_), Some(_)) => Ok(Self {
                x,
                height: 1,
                valid,
            }),
            _ => {
                let names: Vec<String> = (1..).zip(&columns.headings).map(named).collect();
                let what = format!("{n} columns: {}", names.join(", "));
                let mend = "say which holds the heights: column (--column), a name or a number";
                Err(FileError::whole(path, what, mend))
            }
        }
    }
}

fn named((number, heading): (usize, &String)) -> String {
    if heading.is_empty() {
        number.to_string()
    } else {
        format!("{number} \"{heading}\"")
    }
}

/// Whether places go one way.
fn rises(places: &[f64]) -> bool {
    let goes = |is_way: fn(f64, f64) -> bool| places.windows(2).all(|p| is_way(p[0], p[1]));
    places.len() > 1
        && (goes(|a, b| a <= b) || goes(|a, b| a >= b))
        && (places[0] - places[places.len() - 1]).abs() > 0.0
}

fn column_of(columns: &Columns, name: &str, path: &Path) -> Result<usize, FileError> {
    let by_name = columns.headings.iter().position(|heading| heading == name);
    let by_number = || {
        let number: usize = name.parse().ok()?;
        (1..=columns.numbers().len())
            .contains(&number)
            .then(|| number - 1)
    };
    by_name.or_else(by_number).ok_or_else(|| {
        let names: Vec<String> = (1..).zip(&columns.headings).map(named).collect();
        let what = format!("no column \"{name}\"");
        FileError::whole(path, what, format!("the columns are {}", names.join(", ")))
    })
}

fn profile(columns: &Columns, choice: &Choice, path: &Path) -> Result<Reading, FileError> {
    let mut heights = columns.numbers()[choice.height].clone();
    if let Some(valid) = choice.valid {
        for (height, mark) in heights.iter_mut().zip(&columns.numbers()[valid]) {
            if mark.is_nan() || *mark <= 0.0 {
                *height = f64::NAN;
            }
        }
    } else if choice.x.is_none() {
        // Columns of a table end where their profile does.
        let end = heights.iter().rposition(|height| !height.is_nan());
        heights.truncate(end.map_or(1, |end| end + 1));
    }
    let mut reading = Reading::of_rows(heights.len(), heights, "text", path)?;
    reading.height_unit = LengthUnit::in_heading(&columns.headings[choice.height]).into();
    reading
        .about
        .title
        .clone_from(&columns.headings[choice.height]);
    Ok(reading)
}

/// A matrix: rows from the top.
fn matrix(columns: &[Vec<f64>], keys: MatrixKeys, path: &Path) -> Result<Reading, FileError> {
    let (width, height) = (columns.len(), columns.first().map_or(0, Vec::len));
    let rows = (0..height).flat_map(|row| columns.iter().map(move |column| column[row]));
    let mut reading = Reading::of_rows(width, rows.collect(), "text matrix", path)?.turned_over();
    if let [Some((x, unit_x)), Some((y, unit_y))] = keys.extents {
        let step_y = y * unit_y.um() / unit_x.um() / height as f64;
        reading.steps = Some([x / width as f64, step_y]);
        reading.length_unit = Stated::Length(unit_x);
    }
    if let [Some((x, unit_x)), Some((y, unit_y))] = keys.steps {
        reading.steps = Some([x, y * unit_y.um() / unit_x.um()]);
        reading.length_unit = Stated::Length(unit_x);
    }
    reading.height_unit = keys.height_unit;
    reading.about.title = keys.about.title;
    Ok(reading)
}

/// What the lines above a text matrix say: extents and units as Gwyddion writes them, and sizes of
/// a pixel and units as people do.
#[derive(Debug, Default)]
struct MatrixKeys {
    /// Extents with their units.
    extents: [Option<(f64, LengthUnit)>; 2],
    /// Steps with their units.
    steps: [Option<(f64, LengthUnit)>; 2],
    height_unit: Stated,
    about: About,
}

impl MatrixKeys {
    /// The keys among the lines above the data.
    fn of(header: &[String]) -> Self {
        let mut keys = Self::default();
        for line in header {
            let line = line.trim_start_matches(['#', ';', '%', '/', ' ']);
            let Some((key, value)) = line.split_once([':', '=', '\t', ';', ',']) else {
                continue;
            };
            let value = value.trim();
            match key.trim() {
                "Width" => keys.extents[0] = extent(key, value),
                "Height" => keys.extents[1] = extent(key, value),
                "Channel" => value.clone_into(&mut keys.about.title),
                key => keys.take(key, value),
            }
        }
        keys
    }

    /// A key by its words: a size of a pixel, or the unit of heights.
    fn take(&mut self, key: &str, value: &str) {
        let lower = key.to_lowercase();
        let is_break = |c: char| !c.is_alphanumeric();
        let has = |words: &[&str]| lower.split(is_break).any(|word| words.contains(&word));
        let is_step = has(&["pixel", "pixelsize", "step", "spacing", "dx", "dy"]);
        if let Some(step) = extent(key, value).filter(|_| is_step) {
            let [is_x, is_y] = [has(&["x", "dx", "width"]), has(&["y", "dy", "height"])];
            for (axis, is_other) in [(0, is_y && !is_x), (1, is_x && !is_y)] {
                if !is_other {
                    self.steps[axis] = Some(step);
                }
            }
        } else if has(&["unit", "units"]) && has(&["z", "height", "heights", "value"])
            || has(&["heights", "values"]) && LengthUnit::of(value).is_some()
        {
            self.height_unit = Stated::of(value);
        }
    }
}

/// A length such as `10.00 µm`, or a number under a heading such as `Pixel size [µm]`.
fn extent(key: &str, text: &str) -> Option<(f64, LengthUnit)> {
    let digits = text.find(|c: char| !(c.is_ascii_digit() || "+-.eE".contains(c)));
    let (number, unit) = text.split_at(digits.unwrap_or(text.len()));
    let unit = match unit.trim() {
        "" => LengthUnit::in_heading(key)?,
        unit => LengthUnit::of(unit)?,
    };
    let number: f64 = number.parse().ok()?;
    Some((number, unit)).filter(|(number, _)| *number > 0.0 && number.is_finite())
}

#[cfg(test)]
pub(super) mod tests;
