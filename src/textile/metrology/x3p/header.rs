//! The XML of an X3P file: axes, sizes, where the points are, who measured.

use std::path::Path;

use crate::metrology::About;
use selvedge_foundation::files::{FileError, Number, visit_elements};

/// One axis.
#[derive(Debug)]
pub(super) struct Axis {
    pub(super) is_absolute: bool,
    pub(super) number: Number,
    /// m
    pub(super) increment: f64,
    /// m
    pub(super) offset: f64,
}

impl Default for Axis {
    fn default() -> Self {
        Self {
            is_absolute: false,
            number: Number::F64,
            increment: 1.0,
            offset: 0.0,
        }
    }
}

/// What `main.xml` says.
#[derive(Debug, Default)]
pub(super) struct Header {
    feature: String,
    /// x, y, z.
    pub(super) axes: [Axis; 3],
    matrix: [usize; 3],
    list: usize,
    pub(super) n_layers: usize,
    /// The member with the points; empty if they are listed.
    pub(super) link: String,
    pub(super) link_md5: String,
    pub(super) valid_link: String,
    pub(super) valid_md5: String,
    pub(super) checksum: String,
    /// Listed points by axis; NaN where there is none.
    pub(super) data: Vec<[f64; 3]>,
    pub(super) about: About,
}

impl Header {
    /// Reads the XML. `path` only names it in errors.
    pub(super) fn read(xml: &[u8], path: &Path) -> Result<Self, FileError> {
        let mut header = Self::default();
        header.about.format = "X3P";
        visit_elements(xml, path, |name, text| {
            // Without the root, which has more than one name.
            let name = name.split_once('/').map_or("", |(_, name)| name);
            header.set(name, text).ok_or_else(|| {
                let what = format!("{name} is \"{text}\"");
                FileError::whole(path, what, "correct it, or get an intact copy")
            })
        })?;
        header.n_layers = header.matrix[2].max(1);
        Ok(header)
    }

    /// Takes the text of an element; `None` if it makes no sense.
    fn set(&mut self, name: &str, text: &str) -> Option<()> {
        if let Some(rest) = name.strip_prefix("Record1/Axes/C") {
            let (axis, key) = rest.split_once('/').unwrap_or((rest, ""));
            let axis = "XYZ".find(axis).filter(|_| axis.len() == 1)?;
            return self.axes[axis].set(key, text);
        }
        let field = match name {
            "Record1/FeatureType" => &mut self.feature,
            "Record2/Date" => &mut self.about.date,
            "Record2/Comment" => &mut self.about.comment,
            "Record2/Instrument/Manufacturer" | "Record2/Instrument/Model" => {
                if !text.is_empty() && !self.about.instrument.is_empty() {
                    self.about.instrument.push(' ');
                }
                self.about.instrument.push_str(text);
                return Some(());
            }
            "Record3/DataLink/PointDataLink" => &mut self.link,
            "Record3/DataLink/MD5ChecksumPointData" => &mut self.link_md5,
            "Record3/DataLink/ValidPointsLink" => &mut self.valid_link,
            "Record3/DataLink/MD5ChecksumValidPoints" => &mut self.valid_md5,
            "Record4/ChecksumFile" => &mut self.checksum,
            "Record3/ListDimension" => return text.parse().ok().map(|n| self.list = n),
            "Record3/DataList/Datum" => return self.datum(text),
            _ => {
                let size = name.strip_prefix("Record3/MatrixDimension/Size");
                let axis = size.and_then(|axis| "XYZ".find(axis).filter(|_| axis.len() == 1));
                return match axis {
                    Some(axis) => text.parse().ok().map(|n| self.matrix[axis] = n),
                    None => Some(()),
                };
            }
        };
        text.clone_into(field);
        Some(())
    }

    /// A listed point: `x;y;z`, of which incremental x and y are mostly left out.
    fn datum(&mut self, text: &str) -> Option<()> {
        let mut datum = [f64::NAN; 3];
        if !text.is_empty() {
            let mut cells = [0.0; 3];
            let mut n = 0;
            for cell in text.split(';') {
                *cells.get_mut(n)? = cell.trim().parse().ok()?;
                n += 1;
            }
            datum[2] = cells[n - 1];
            match n {
                3 => datum = cells,
                2 => datum[usize::from(!self.axes[0].is_absolute)] = cells[0],
                _ => {}
            }
        }
        self.data.push(datum);
        Some(())
    }

    /// Points along and across of the first layer.
    pub(super) fn size(
        &self,
        path: &Path,
        warnings: &mut Vec<String>,
    ) -> Result<[usize; 2], FileError> {
        let wrong = |what: String, mend: &str| Err(FileError::whole(path, what, mend));
        match self.feature.as_str() {
            "SUR" | "PRF" => {}
            "PCL" => {
                let what = "a cloud of points (PCL), not a grid".to_owned();
                return wrong(what, "interpolate it to a grid and save it as a surface");
            }
            other => {
                let what = format!("a feature of type \"{other}\"");
                return wrong(what, "give a surface (SUR) or a profile (PRF)");
            }
        }
        let [width, height, n_layers] = self.matrix;
        if n_layers > 1 {
            warnings.push(format!("the first of {n_layers} layers was read"));
        }
        if width == 0 && self.list > 0 && self.feature == "PRF" {
            return Ok([self.list, 1]);
        }
        if width == 0 {
            return wrong("no size of a matrix".to_owned(), "get an intact copy");
        }
        Ok([width, height.max(1)])
    }
}

impl Axis {
    fn set(&mut self, key: &str, text: &str) -> Option<()> {
        match (key, text) {
            ("AxisType", "I") => self.is_absolute = false,
            ("AxisType", "A") => self.is_absolute = true,
            ("DataType", "I") => self.number = Number::I16,
            ("DataType", "L") => self.number = Number::I32,
            ("DataType", "F") => self.number = Number::F32,
            ("DataType", "D") => self.number = Number::F64,
            // Writers leave what they do not use empty.
            ("Increment" | "Offset" | "DataType", "") => {}
            ("AxisType" | "DataType", _) => return None,
            ("Increment", _) => self.increment = finite(text)?,
            ("Offset", _) => self.offset = finite(text)?,
            _ => {}
        }
        Some(())
    }
}

fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}
