//! JSON text from plain data, for results that other programs read; and back, for what we wrote.

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::FileError;

/// A value as indented JSON with a final newline; numbers that are not finite become `null`.
/// `path` only names the file in errors.
pub fn to_json_string<T: Serialize>(value: &T, path: &Path) -> Result<String, FileError> {
    let mut text = serde_json::to_string_pretty(value)
        .map_err(|e| FileError::content(path, 1, e.to_string(), "this cannot be saved as JSON"))?;
    text.push('\n');
    Ok(text)
}

/// Most bytes of what is read.
const MAX_BYTES: usize = 16_000_000;

/// A value from JSON text. `path` only names the file in errors.
pub fn from_json_str<T: DeserializeOwned>(text: &str, path: &Path) -> Result<T, FileError> {
    if text.len() > MAX_BYTES {
        let what = format!("this file is larger than {} MB", MAX_BYTES / 1_000_000);
        let mend = "give a file that Selvedge wrote";
        return Err(FileError::whole(path, what, mend));
    }
    serde_json::from_str(text).map_err(|error| {
        let mend = "mend it, or remove the file";
        FileError::content(path, error.line(), error.to_string(), mend)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_digits_and_infinity_is_null() {
        let text = to_json_string(&[0.1, f64::INFINITY], Path::new("a.json")).unwrap();
        assert_eq!(text.split_whitespace().collect::<String>(), "[0.1,null]");
    }
}
