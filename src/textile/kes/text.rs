//! The text of a tester's export: UTF-8, UTF-16 or Latin-1, as old programs write it.

use std::borrow::Cow;
use std::path::Path;

use selvedge_foundation::files::FileError;
use selvedge_foundation::files::decoded;

/// Larger files are refused before they are read as text.
const MAX_BYTES: usize = 64 << 20;

/// The text of a file, without a byte-order mark; line ends are what they are.
///
/// # Errors
/// An empty file, one that is no text, one above 64 MB.
pub(super) fn text_of<'a>(bytes: &'a [u8], path: &Path) -> Result<Cow<'a, str>, FileError> {
    let mend = "give the tester's export as text: rows of numbers under an optional header";
    let wrong = |what: &str| FileError::content(path, 1, what, mend);
    if bytes.len() > MAX_BYTES {
        return Err(wrong("this file is larger than 64 MB"));
    }
    let is_binary = |text: &Cow<'_, str>| {
        text.chars()
            .any(|c| c.is_control() && !matches!(c, '\t' | '\n' | '\r' | '\x0c' | '\x1a'))
    };
    match decoded(bytes).filter(|text| !is_binary(text)) {
        None => Err(wrong("this is not text")),
        Some(text) if text.trim().is_empty() => Err(wrong("this file is empty")),
        Some(text) => Ok(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Result<String, String> {
        let text = text_of(bytes, Path::new("a.txt"));
        text.map(Cow::into_owned).map_err(|error| error.to_string())
    }

    #[test]
    fn what_old_programs_write_is_text() {
        assert_eq!(read("\u{feff}x µm".as_bytes()).unwrap(), "x µm");
        assert_eq!(read(b"x \xb5m").unwrap(), "x µm");
        let utf16: Vec<u8> = "\u{feff}x µm"
            .encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect();
        assert_eq!(read(&utf16).unwrap(), "x µm");
    }

    #[test]
    fn what_is_no_text_is_refused_in_a_line() {
        for (bytes, what) in [
            (b"".as_slice(), "empty"),
            (b" \r\n\t", "empty"),
            (b"\x89PNG\r\n\x1a\n\0\0", "not text"),
            (b"\xff\xfe\x00\xd8", "not text"),
        ] {
            let error = read(bytes).unwrap_err();
            assert!(
                error.starts_with("a.txt:1: this") && error.contains(what),
                "{error}"
            );
            assert!(error.contains("; "), "{error}");
        }
    }
}
