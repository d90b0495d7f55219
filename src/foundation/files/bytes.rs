//! Numbers in binary files, little endian, read one after the other; nothing past the end.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use super::FileError;

/// A place in the bytes of a file.
#[derive(Debug, Clone)]
pub struct ByteReader<'a> {
    bytes: &'a [u8],
    at: usize,
    path: PathBuf,
}

impl<'a> ByteReader<'a> {
    /// At the first byte. `path` only names the file in errors.
    pub fn new(bytes: &'a [u8], path: &Path) -> Self {
        Self {
            bytes,
            at: 0,
            path: path.to_owned(),
        }
    }

    /// Bytes that are left.
    pub fn n_left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Moves to a byte, counted from 0.
    ///
    /// # Errors
    /// There is no such byte.
    pub fn seek(&mut self, at: usize) -> Result<(), FileError> {
        self.at = 0;
        self.take(at).map(drop)
    }

    /// The next `n` bytes.
    ///
    /// # Errors
    /// Fewer are left.
    pub fn take(&mut self, n: usize) -> Result<&'a [u8], FileError> {
        if n > self.n_left() {
            let what = format!("{n} bytes are missing at byte {}", self.at);
            let mend = "the file is cut short or its header lies; get an intact copy";
            return Err(FileError::whole(&self.path, what, mend));
        }
        let taken = &self.bytes[self.at..self.at + n];
        self.at += n;
        Ok(taken)
    }

    /// The next `N` bytes.
    ///
    /// # Errors
    /// Fewer are left.
    pub fn array<const N: usize>(&mut self) -> Result<[u8; N], FileError> {
        let taken = self.take(N)?;
        let mut array = [0; N];
        array.copy_from_slice(taken);
        Ok(array)
    }

    /// A 16-bit number without a sign.
    ///
    /// # Errors
    /// The file ends before it.
    pub fn u16(&mut self) -> Result<u16, FileError> {
        self.array().map(u16::from_le_bytes)
    }

    /// A 32-bit number without a sign.
    ///
    /// # Errors
    /// The file ends before it.
    pub fn u32(&mut self) -> Result<u32, FileError> {
        self.array().map(u32::from_le_bytes)
    }

    /// A 32-bit number.
    ///
    /// # Errors
    /// The file ends before it.
    pub fn i32(&mut self) -> Result<i32, FileError> {
        self.array().map(i32::from_le_bytes)
    }

    /// A 32-bit floating number.
    ///
    /// # Errors
    /// The file ends before it.
    pub fn f32(&mut self) -> Result<f32, FileError> {
        self.array().map(f32::from_le_bytes)
    }

    /// A 64-bit floating number.
    ///
    /// # Errors
    /// The file ends before it.
    pub fn f64(&mut self) -> Result<f64, FileError> {
        self.array().map(f64::from_le_bytes)
    }

    /// Text in Latin-1 in a field of `n` bytes, up to its NUL, trimmed.
    ///
    /// # Errors
    /// The file ends before it.
    pub fn latin1(&mut self, n: usize) -> Result<String, FileError> {
        let field = self.take(n)?;
        let end = field.iter().position(|&byte| byte == 0).unwrap_or(n);
        Ok(latin1(&field[..end]).trim().to_owned())
    }

    /// Text up to a NUL, which is passed over.
    ///
    /// # Errors
    /// There is no NUL.
    pub fn text(&mut self) -> Result<String, FileError> {
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(|&byte| byte == 0);
        let text = self.take(end.unwrap_or(rest.len() + 1))?;
        self.at += 1;
        Ok(String::from_utf8(text.to_vec()).unwrap_or_else(|_| latin1(text)))
    }
}

/// Latin-1 bytes as text.
pub fn latin1(bytes: &[u8]) -> String {
    bytes.iter().map(|&byte| char::from(byte)).collect()
}

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Number {
    /// 8 bits without a sign.
    U8,
    /// 16 bits with a sign.
    I16,
    /// 16 bits without a sign.
    U16,
    /// 32 bits with a sign.
    I32,
    /// 32 bits without a sign.
    U32,
    /// 32 bits, floating.
    F32,
    /// 64 bits, floating.
    F64,
}

impl Number {
    /// Bytes of one number.
    pub fn size(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The numbers in these bytes, little endian; what is left over at the end is not read.
    pub fn decode(self, bytes: &[u8]) -> Vec<f64> {
        match self {
            Self::U8 => bytes.iter().map(|&byte| f64::from(byte)).collect(),
            Self::I16 => each(bytes, |b| f64::from(i16::from_le_bytes(b))),
            Self::U16 => each(bytes, |b| f64::from(u16::from_le_bytes(b))),
            Self::I32 => each(bytes, |b| f64::from(i32::from_le_bytes(b))),
            Self::U32 => each(bytes, |b| f64::from(u32::from_le_bytes(b))),
            Self::F32 => each(bytes, |b| f64::from(f32::from_le_bytes(b))),
            Self::F64 => each(bytes, f64::from_le_bytes),
        }
    }

    /// Numbers as bytes, little endian, each rounded to the nearest that can be stored.
    pub fn encode(self, numbers: impl Iterator<Item = f64>) -> Vec<u8> {
        let mut bytes = Vec::new();
        for number in numbers {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "rounding to what can be stored is what is asked for"
            )]
            match self {
                Self::U8 => bytes.push(number.round() as u8),
                Self::I16 => bytes.extend((number.round() as i16).to_le_bytes()),
                Self::U16 => bytes.extend((number.round() as u16).to_le_bytes()),
                Self::I32 => bytes.extend((number.round() as i32).to_le_bytes()),
                Self::U32 => bytes.extend((number.round() as u32).to_le_bytes()),
                Self::F32 => bytes.extend((number as f32).to_le_bytes()),
                Self::F64 => bytes.extend(number.to_le_bytes()),
            }
        }
        bytes
    }
}

fn each<const N: usize>(bytes: &[u8], decode: impl Fn([u8; N]) -> f64) -> Vec<f64> {
    bytes.as_chunks().0.iter().map(|&b| decode(b)).collect()
}

/// A text, without a byte-order mark: UTF-8, UTF-16 or Latin-1, as old programs write it. `None`
/// where it begins as UTF-16 and is none.
pub fn decoded(bytes: &[u8]) -> Option<Cow<'_, str>> {
    match bytes {
        [0xff, 0xfe, rest @ ..] => utf16(rest, u16::from_le_bytes).map(Cow::Owned),
        [0xfe, 0xff, rest @ ..] => utf16(rest, u16::from_be_bytes).map(Cow::Owned),
        _ => Some(match std::str::from_utf8(bytes) {
            Ok(text) => Cow::Borrowed(text.strip_prefix('\u{feff}').unwrap_or(text)),
            Err(_) => Cow::Owned(latin1(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes))),
        }),
    }
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Option<String> {
    let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    char::decode_utf16(units).collect::<Result<_, _>>().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back_as_they_were_stored() {
        for (number, values) in [
            (Number::U8, [0.0, 255.0]),
            (Number::I16, [-32768.0, 32767.0]),
            (Number::U16, [0.0, 65535.0]),
            (Number::I32, [-2_147_483_648.0, 2_147_483_647.0]),
            (Number::U32, [0.0, 4_294_967_295.0]),
            (Number::F32, [-0.5, 1.5]),
            (Number::F64, [0.1, 1e-300]),
        ] {
            let bytes = number.encode(values.into_iter());
            assert_eq!(bytes.len(), 2 * number.size(), "{number:?}");
            assert_eq!(number.decode(&bytes), values, "{number:?}");
        }
    }

    #[test]
    fn nothing_is_read_past_the_end() {
        let mut reader = ByteReader::new(b"\x01\x00ab\0c", Path::new("a.bin"));
        assert_eq!(reader.u16().unwrap(), 1);
        assert_eq!(reader.text().unwrap(), "ab");
        assert!(reader.text().is_err() && reader.clone().u32().is_err());
        assert!(reader.seek(7).is_err());
        let error = reader.take(9).unwrap_err().to_string();
        assert!(error.starts_with("a.bin: 9 bytes are missing"), "{error}");
    }
}
