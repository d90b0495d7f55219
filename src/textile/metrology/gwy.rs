//! GWY, Gwyddion's native files: a tree of objects, of which the first field of heights is read.
//! A mask over it marks points as missing.

use std::path::Path;

use super::reading::Stated;
use super::{HeightOptions, Reading, n_points};
use selvedge_foundation::files::{ByteReader, FileError, Number};

/// Deepest nesting that is read.
const MAX_DEEP: usize = 32;

/// A component of an object; kinds that are not needed are passed over.
enum Value<'a> {
    Whole(i32),
    Real(f64),
    Text(String),
    Reals(&'a [u8]),
    Object(Object<'a>),
    Other,
}

struct Object<'a> {
    class: String,
    components: Vec<(String, Value<'a>)>,
}

impl<'a> Object<'a> {
    fn of(reader: &mut ByteReader<'a>, path: &Path, depth: usize) -> Result<Self, FileError> {
        if depth > MAX_DEEP {
            let what = format!("objects stand more than {MAX_DEEP} deep");
            return Err(FileError::whole(path, what, "get an intact copy"));
        }
        let class = reader.text()?;
        let n_bytes = usize::try_from(reader.u32()?).unwrap_or(usize::MAX);
        let mut inner = ByteReader::new(reader.take(n_bytes)?, path);
        let mut components = Vec::new();
        while inner.n_left() > 0 {
            let name = inner.text()?;
            let value = Value::of(&mut inner, path, depth)?;
            if !matches!(value, Value::Other) {
                components.push((name, value));
            }
        }
        Ok(Self { class, components })
    }

    fn get(&self, name: &str) -> Option<&Value<'a>> {
        let found = self.components.iter().find(|(key, _)| key == name);
        found.map(|(_, value)| value)
    }

    fn whole(&self, name: &str) -> usize {
        match self.get(name) {
            Some(Value::Whole(n)) => usize::try_from(*n).unwrap_or(0),
            _ => 0,
        }
    }

    fn real(&self, name: &str) -> f64 {
        match self.get(name) {
            Some(Value::Real(number)) => *number,
            _ => f64::NAN,
        }
    }

    fn text(&self, name: &str) -> &str {
        match self.get(name) {
            Some(Value::Text(text)) => text,
            _ => "",
        }
    }

    fn object(&self, name: &str) -> Option<&Self> {
        match self.get(name) {
            Some(Value::Object(object)) => Some(object),
            _ => None,
        }
    }

    /// Points along and across, and their numbers.
    fn field(&self, path: &Path) -> Result<([usize; 2], Vec<f64>), FileError> {
        let size = [self.whole("xres"), self.whole("yres")];
        let n = n_points(size[0], size[1], path)?;
        match self.get("data") {
            Some(Value::Reals(data)) if data.len() == 8 * n => Ok((size, Number::F64.decode(data))),
            _ => {
                let what = format!("no {} × {} heights in the field", size[0], size[1]);
                Err(FileError::whole(path, what, "get an intact copy"))
            }
        }
    }

    /// The unit in an object of units; empty if it states none.
    fn unit(&self, name: &str) -> &str {
        self.object(name).map_or("", |unit| unit.text("unitstr"))
    }
}

impl<'a> Value<'a> {
    fn of(reader: &mut ByteReader<'a>, path: &Path, depth: usize) -> Result<Self, FileError> {
        let [kind] = reader.array()?;
        let mut skip = |n: usize| reader.take(n).map(|_| Self::Other);
        match kind {
            b'b' | b'c' => skip(1),
            b'q' => skip(8),
            b'i' => reader.i32().map(Self::Whole),
            b'd' => reader.f64().map(Self::Real),
            b's' => reader.text().map(Self::Text),
            b'o' => Object::of(reader, path, depth + 1).map(Self::Object),
            b'C' | b'I' | b'Q' | b'D' => {
                let n = usize::try_from(reader.u32()?).unwrap_or(usize::MAX);
                let size = match kind {
                    b'C' => 1,
                    b'I' => 4,
                    _ => 8,
                };
                let data = reader.take(n.saturating_mul(size))?;
                Ok(if kind == b'D' {
                    Self::Reals(data)
                } else {
                    Self::Other
                })
            }
            b'S' => {
                for _ in 0..reader.u32()? {
                    reader.text()?;
                }
                Ok(Self::Other)
            }
            b'O' => {
                for _ in 0..reader.u32()? {
                    Object::of(reader, path, depth + 1)?;
                }
                Ok(Self::Other)
            }
            other => {
                let what = format!("a component of unknown kind {other}");
                Err(FileError::whole(path, what, "get an intact copy"))
            }
        }
    }
}

/// Reads a field: the channel with the lowest number, or the one asked for.
pub(super) fn read(bytes: &[u8], path: &Path, asked: &HeightOptions) -> Result<Reading, FileError> {
    let mut reader = ByteReader::new(bytes, path);
    reader.seek(4)?;
    let top = Object::of(&mut reader, path, 0)?;
    let channels = top.components.iter().filter_map(|(key, value)| {
        let number: u32 = key.strip_prefix('/')?.strip_suffix("/data")?.parse().ok()?;
        let Value::Object(object) = value else {
            return None;
        };
        (object.class == "GwyDataField").then_some((number, object))
    });
    let mut channels: Vec<(u32, &Object<'_>)> = channels.collect();
    channels.sort_by_key(|(number, _)| *number);
    if channels.is_empty() {
        let mend = "save a channel of heights from Gwyddion";
        return Err(FileError::whole(path, "no field of heights in it", mend));
    }
    let n = channels.len();
    let nth = asked.layer.unwrap_or(1);
    let Some(&(number, field)) = nth.checked_sub(1).and_then(|index| channels.get(index)) else {
        let what = format!("no layer {nth}: the file has {n}");
        let mend = format!("give layer (--layer) from 1 to {n}");
        return Err(FileError::whole(path, what, mend));
    };
    let title_of = |number: u32| top.text(&format!("/{number}/data/title")).to_owned();
    let (size, mut values) = field.field(path)?;
    let mut warnings = Vec::new();
    if n > 1 && asked.layer.is_none() {
        warnings.push(format!("channel {number}, the first of {n}, was read"));
    }
    if let Some(mask) = top.object(&format!("/{number}/mask")) {
        let (_, marks) = mask.field(path)?;
        let marked = values.iter_mut().zip(marks).filter(|(_, mark)| *mark > 0.0);
        let n_masked = marked.map(|(value, _)| *value = f64::NAN).count();
        warnings.push(format!("{n_masked} masked points count as missing"));
    }
    let mut reading = Reading::of_rows(size[0], values, "GWY", path)?.turned_over();
    let extents = [field.real("xreal"), field.real("yreal")];
    reading.steps = Some([extents[0] / size[0] as f64, extents[1] / size[1] as f64]);
    reading.length_unit = Stated::of(field.unit("si_unit_xy"));
    reading.height_unit = Stated::of(field.unit("si_unit_z"));
    reading.about.title = title_of(number);
    reading.layers = channels
        .iter()
        .map(|(number, _)| title_of(*number))
        .collect();
    reading.warnings = warnings;
    Ok(reading)
}
