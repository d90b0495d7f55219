//! Numbers as files hold them: the shortest decimal digits that read back to the same number.

use std::fmt::{Display, Write as _};

/// Appends a number with its shortest round-trip digits (Rust's own formatting does just that).
pub fn push_number(text: &mut String, value: impl Display) {
    let written = write!(text, "{value}");
    debug_assert!(written.is_ok(), "a String takes everything");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_read_back_the_same() {
        for value in [0.1, 1.0 / 230.0, 1e-300, 123_456_789.125] {
            let mut text = String::new();
            push_number(&mut text, value);
            assert_eq!(text.parse::<f64>().unwrap(), value);
        }
    }
}
