//! Profile files: CSV of `x_mm,height_um`; friction files: CSV of `x_mm,mu`.

use std::path::Path;

use crate::error::TextileError;
use crate::surface::{FrictionTrace, Profile};
use selvedge_foundation::files::{FileError, Table, TableWriter};

const COLUMNS: [&str; 2] = ["x_mm", "height_um"];
const FRICTION_COLUMNS: [&str; 2] = ["x_mm", "mu"];

impl Profile {
    /// Reads a profile file. `path` only names it in errors.
    pub fn read(text: &str, path: &Path) -> Result<Self, TextileError> {
        let (x_mm, heights_um) = match plain(text) {
            Some(columns) => columns,
            None => columns(text, path, COLUMNS)?,
        };
        Self::from_positions(&x_mm, heights_um).map_err(TextileError::surface(path))
    }
}

/// The columns of a file as this program writes it: no quotes, comments or odd headers. Reading
/// a library is most of the time that a scene takes to open, and this is most of the reading.
fn plain(text: &str) -> Option<(Vec<f64>, Vec<f64>)> {
    let (header, rows) = text.split_once('\n')?;
    if header != "x_mm,height_um" {
        return None;
    }
    let finite = |cell: &str| cell.parse().ok().filter(|number: &f64| number.is_finite());
    let row = |line: &str| {
        let (x_mm, height_um) = line.split_once(',')?;
        Some((finite(x_mm)?, finite(height_um)?))
    };
    rows.lines().map(row).collect()
}

/// The columns of any file, or what is wrong with it and where.
fn columns(text: &str, path: &Path, [x, y]: [&str; 2]) -> Result<(Vec<f64>, Vec<f64>), FileError> {
    let table = Table::read(text, path, &[x, y], &[])?;
    Ok((table.required_numbers(x)?, table.required_numbers(y)?))
}

/// Reads a friction trace. `path` only names it in errors.
pub(crate) fn read_friction(text: &str, path: &Path) -> Result<FrictionTrace, TextileError> {
    let (x_mm, mu) = columns(text, path, FRICTION_COLUMNS)?;
    FrictionTrace::from_positions(&x_mm, mu).map_err(TextileError::surface(path))
}

/// Writes a friction trace: places to a nanometre, coefficients to a millionth.
pub(crate) fn write_friction(trace: &FrictionTrace, path: &Path) -> Result<String, FileError> {
    written(trace.mu(), trace.step_mm(), 1e6, (path, FRICTION_COLUMNS))
}

/// Writes heights in µm, `step_mm` apart: places to a nanometre, heights to a nanometre. What the
/// rounding hides cannot differ from machine to machine.
pub(crate) fn write(heights_um: &[f64], step_mm: f64, path: &Path) -> Result<String, FileError> {
    written(heights_um, step_mm, 1e3, (path, COLUMNS))
}

fn written(
    values: &[f64],
    step_mm: f64,
    per_unit: f64,
    (path, columns): (&Path, [&str; 2]),
) -> Result<String, FileError> {
    let mut table = TableWriter::new(Vec::new(), path, &columns)?;
    for (i, value) in values.iter().enumerate() {
        let x_mm = (i as f64 * step_mm * 1e6).round() / 1e6;
        // Adding 0 turns −0 into 0.
        let value = (value * per_unit).round() / per_unit + 0.0;
        table.number(x_mm).number(value).end_row()?;
    }
    let bytes = table.finish()?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_back_with_the_instruments_step() {
        let heights: Vec<f64> = (0..4600).map(|i| f64::from(i).sin() * 10.0).collect();
        let path = Path::new("warp_forward.csv");
        let text = write(&heights, 1.0 / 230.0, path).unwrap();
        let profile = Profile::read(&text, path).unwrap();
        assert_eq!(profile.step_mm(), 1.0 / 230.0);
        for (read, given) in profile.heights_um().iter().zip(&heights) {
            assert!((read - given).abs() <= 5.001e-4, "{read} against {given}");
        }
    }

    #[test]
    fn other_spellings_of_a_file_hold_the_same_profile() {
        let path = Path::new("a.csv");
        let text = write(&[1.0, -2.5, 3.25], 0.01, path).unwrap();
        let other = text
            .replace("x_mm,", "\u{feff}x_mm, ")
            .replace("0.01,", "# aside\n0.01, ");
        assert!(plain(&text).is_some() && plain(&other).is_none(), "{other}");
        assert_eq!(
            Profile::read(&text, path).unwrap(),
            Profile::read(&other, path).unwrap()
        );
    }

    #[test]
    fn wrong_profiles_name_file_and_line() {
        let path = Path::new("a.csv");
        for (text, expected) in [
            (
                "x_mm,height_um\n0,1\n0.1,inf\n",
                "a.csv:3: height_um is \"inf\"",
            ),
            (
                "x_mm,height_um\n0,1\n",
                "a.csv: 1 samples where one window takes 1000",
            ),
            ("x_mm,height_um\n0,1\n1,1\n", "a.csv: the step is 1.0 mm"),
            ("x_mm,height\n0,1\n", "a.csv:1: unknown column"),
        ] {
            let error = Profile::read(text, path).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
    }

    proptest::proptest! {
        #[test]
        fn no_rows_make_the_reader_panic(rows in "[-0-9.,enaif#\"\n]{0,80}") {
            let path = Path::new("a.csv");
            drop(Profile::read(&rows, path));
            if let Ok(profile) = Profile::read(&format!("x_mm,height_um\n{rows}"), path) {
                let is_finite = profile.heights_um().iter().all(|height| height.is_finite());
                proptest::prop_assert!(is_finite && profile.step_mm() > 0.0);
            }
        }
    }
}
