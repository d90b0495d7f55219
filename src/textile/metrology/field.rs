//! The keys of a Gwyddion field, which GSF files and pictures spell alike: extents and units.

use std::path::Path;

use super::reading::Stated;
use super::{Measured, Reading};
use selvedge_foundation::files::FileError;

/// Extents and units, as text; empty where not stated.
#[derive(Debug, Default)]
pub(super) struct FieldKeys {
    x_real: String,
    y_real: String,
    xy_unit: String,
    z_unit: String,
    title: String,
}

impl FieldKeys {
    /// The keys of a map: metres.
    pub(super) fn of(measured: &Measured) -> Self {
        let grid = &measured.heights_um;
        let [step_x, step_y] = measured.step_mm;
        Self {
            x_real: (grid.width() as f64 * step_x / 1000.0).to_string(),
            y_real: (grid.height() as f64 * step_y / 1000.0).to_string(),
            xy_unit: "m".to_owned(),
            z_unit: "m".to_owned(),
            title: measured.about.title.replace('\n', " "),
        }
    }

    /// Sets the value of a key; others are passed over. Both spellings of units occur.
    pub(super) fn set(&mut self, key: &str, value: &str) {
        let field = match key {
            "XReal" => &mut self.x_real,
            "YReal" => &mut self.y_real,
            "XYUnits" | "XYUnit" => &mut self.xy_unit,
            "ZUnits" | "ZUnit" => &mut self.z_unit,
            "Title" => &mut self.title,
            _ => return,
        };
        value.clone_into(field);
    }

    /// Keys and values as GSF files spell them.
    pub(super) fn pairs(&self) -> [(&'static str, &str); 5] {
        [
            ("XReal", &self.x_real),
            ("YReal", &self.y_real),
            ("XYUnits", &self.xy_unit),
            ("ZUnits", &self.z_unit),
            ("Title", &self.title),
        ]
    }
}

/// A reading of a field that begins at the top.
pub(super) fn field_reading(
    [width, height]: [usize; 2],
    values: Vec<f64>,
    keys: &FieldKeys,
    format: &'static str,
    path: &Path,
) -> Result<Reading, FileError> {
    let mut reading = Reading::of_rows(width, values, format, path)?.turned_over();
    let number = |text: &str| text.parse().ok().filter(|extent: &f64| *extent > 0.0);
    if let (Some(x), Some(y)) = (number(&keys.x_real), number(&keys.y_real)) {
        reading.steps = Some([x / width as f64, y / height as f64]);
    }
    reading.length_unit = Stated::of(&keys.xy_unit);
    reading.height_unit = Stated::of(&keys.z_unit);
    keys.title.clone_into(&mut reading.about.title);
    Ok(reading)
}
