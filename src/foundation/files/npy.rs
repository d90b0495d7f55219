//! NPY: one array of numbers, as `NumPy` writes it.

use std::path::Path;

use super::{ByteReader, FileError, Number};

/// An array of one or two dimensions.
#[derive(Debug, Clone, PartialEq)]
pub struct NumberArray {
    /// Rows; 1 for an array of one dimension.
    pub n_rows: usize,
    /// Numbers in a row.
    pub n_columns: usize,
    /// The numbers, row by row.
    pub values: Vec<f64>,
}

impl NumberArray {
    /// How an NPY file begins.
    pub const MAGIC: &[u8] = b"\x93NUMPY";

    /// Decodes an array of at most `most` numbers. `path` only names it in errors.
    ///
    /// # Errors
    /// What is no NPY file, is cut short, has more dimensions or numbers, or holds no numbers.
    pub fn from_npy(bytes: &[u8], path: &Path, most: usize) -> Result<Self, FileError> {
        let mend = "save a plain array of numbers with one or two dimensions";
        let wrong = |what: String| FileError::whole(path, what, mend);
        let mut reader = ByteReader::new(bytes, path);
        if reader.take(Self::MAGIC.len())? != Self::MAGIC {
            return Err(wrong("this is no NPY file".to_owned()));
        }
        let [major, _minor] = reader.array()?;
        let n_header = if major == 1 {
            usize::from(reader.u16()?)
        } else {
            usize::try_from(reader.u32()?).unwrap_or(usize::MAX)
        };
        let header = reader.latin1(n_header)?;
        let descr = value_of(&header, "descr").unwrap_or_default();
        let (number, is_big_endian) = number_of(descr.trim_matches(['\'', '"']))
            .ok_or_else(|| wrong(format!("numbers of kind {descr} are not read")))?;
        let is_fortran = value_of(&header, "fortran_order") == Some("True");
        let shape = shape_of(&header).ok_or_else(|| {
            wrong("the shape is not stated or not of one or two dimensions".into())
        })?;
        let [n_rows, n_columns] = shape;
        let n = n_rows.checked_mul(n_columns).filter(|&n| n <= most);
        let n = n.ok_or_else(|| wrong(format!("{n_rows} × {n_columns} numbers are too many")))?;
        // At most `most` × 8 bytes, and no more than the file holds.
        let data = reader.take(n * number.size())?;
        let values = if is_big_endian {
            let mut swapped = data.to_vec();
            swapped
                .chunks_exact_mut(number.size())
                .for_each(<[u8]>::reverse);
            number.decode(&swapped)
        } else {
            number.decode(data)
        };
        let values = if is_fortran {
            let place = |i: usize| values[(i % n_columns) * n_rows + i / n_columns];
            (0..n).map(place).collect()
        } else {
            values
        };
        Ok(Self {
            n_rows,
            n_columns,
            values,
        })
    }

    /// Encodes rows of numbers as float64.
    pub fn to_npy(&self) -> Vec<u8> {
        let Self {
            n_rows, n_columns, ..
        } = self;
        let mut header = format!(
            "{{'descr': '<f8', 'fortran_order': False, 'shape': ({n_rows}, {n_columns}), }}"
        );
        // Magic, version and length are 10 bytes; the data begin at a multiple of 64.
        while (header.len() + 11) % 64 != 0 {
            header.push(' ');
        }
        header.push('\n');
        let mut bytes = Self::MAGIC.to_vec();
        bytes.extend([1, 0]);
        bytes.extend(u16::try_from(header.len()).unwrap_or(0).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(Number::F64.encode(self.values.iter().copied()));
        bytes
    }
}

/// The text after a key of the header, up to the comma that ends it.
fn value_of<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    let (_, rest) = header
        .split_once(&format!("'{key}'"))
        .or_else(|| header.split_once(&format!("\"{key}\"")))?;
    let rest = rest.trim_start().strip_prefix(':')?.trim_start();
    let end = rest.find([',', '}']).unwrap_or(rest.len());
    Some(rest[..end].trim())
}

fn number_of(descr: &str) -> Option<(Number, bool)> {
    let order = descr.get(..1)?;
    let number = match descr.get(1..)? {
        "u1" => Number::U8,
        "i2" => Number::I16,
        "u2" => Number::U16,
        "i4" => Number::I32,
        "u4" => Number::U32,
        "f4" => Number::F32,
        "f8" => Number::F64,
        _ => return None,
    };
    matches!(order, "<" | ">" | "|" | "=").then_some((number, order == ">"))
}

/// Rows and columns; an array of one dimension is one row.
fn shape_of(header: &str) -> Option<[usize; 2]> {
    let (_, rest) = header.split_once("shape")?;
    let (_, rest) = rest.split_once('(')?;
    let (inside, _) = rest.split_once(')')?;
    let parts = inside
        .split(',')
        .map(str::trim)
        .filter(|part| !part.is_empty());
    let sizes: Option<Vec<usize>> = parts.map(|part| part.parse().ok()).collect();
    match *sizes?.as_slice() {
        [n] if n > 0 => Some([1, n]),
        [rows, columns] if rows > 0 && columns > 0 => Some([rows, columns]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PATH: &str = "a.npy";

    fn npy(dictionary: &str, data: &[u8]) -> Vec<u8> {
        let mut bytes = b"\x93NUMPY\x02\x00".to_vec();
        bytes.extend(u32::try_from(dictionary.len()).unwrap().to_le_bytes());
        bytes.extend(dictionary.as_bytes());
        bytes.extend(data);
        bytes
    }

    fn read(bytes: &[u8]) -> Result<NumberArray, FileError> {
        NumberArray::from_npy(bytes, Path::new(PATH), 1000)
    }

    #[test]
    fn arrays_come_back() {
        let array = NumberArray {
            n_rows: 2,
            n_columns: 3,
            values: vec![1.0, -2.5, 0.1, 4.0, 5.0, 1e-9],
        };
        let bytes = array.to_npy();
        assert_eq!((bytes.len() - 48) % 64, 0);
        assert_eq!(read(&bytes).unwrap(), array);
    }

    #[test]
    fn columns_first_and_big_endian_are_turned_round() {
        let header = "{'descr': '>i2', 'fortran_order': True, 'shape': (2, 3), }";
        let data: Vec<u8> = (1..7_i16).flat_map(i16::to_be_bytes).collect();
        let array = read(&npy(header, &data)).unwrap();
        assert_eq!(array.values, [1.0, 3.0, 5.0, 2.0, 4.0, 6.0]);
        let header = "{'descr': '|u1', 'fortran_order': False, 'shape': (4,), }";
        let array = read(&npy(header, &[1, 2, 3, 4])).unwrap();
        assert_eq!((array.n_rows, array.n_columns), (1, 4));
    }

    #[test]
    fn what_is_no_plain_array_is_refused() {
        for (header, expected) in [
            (
                "{'descr': '|O', 'fortran_order': False, 'shape': (1,), }",
                "kind '|O'",
            ),
            (
                "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1, 1), }",
                "dimensions",
            ),
            (
                "{'descr': '<f8', 'fortran_order': False, 'shape': (9, 9), }",
                "bytes are missing",
            ),
            (
                "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999, 99999999999), }",
                "too many",
            ),
            ("", "kind"),
        ] {
            let error = read(&npy(header, &[0; 8])).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
