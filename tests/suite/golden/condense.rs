//! Long texts in short: enough of them that a difference can be seen, and a hash of all.

use sha2::{Digest as _, Sha256};

/// Texts up to this length are told whole, bytes.
const LONG: usize = 4_000;
/// Lines at the beginning that are told in any case: headers and what comes first.
const N_FIRST: usize = 8;
/// Lines that are told from the rest, evenly spread.
const N_SPREAD: usize = 16;
/// Letters of a line.
const N_LETTERS: usize = 200;

/// A text, or its first lines, some of the others by their numbers, and its hash.
pub(super) fn condensed(text: &str) -> String {
    if text.len() <= LONG {
        return text.to_owned();
    }
    let lines: Vec<&str> = text.lines().collect();
    let apart = lines.len().div_ceil(N_SPREAD).max(1);
    let is_told = |nth: &usize| *nth < N_FIRST || nth.is_multiple_of(apart);
    let described = (0..lines.len()).filter(is_told);
    let described = described.map(|nth| format!("{}: {}", nth + 1, shortened(lines[nth])));
    let described: Vec<String> = described.collect();
    let n = lines.len();
    format!(
        "{}\n… of {n} lines, {}",
        described.join("\n"),
        hash(text.as_bytes())
    )
}

/// The hash of some bytes in words.
pub(super) fn hash(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    let hex = digest.iter().map(|byte| format!("{byte:02x}"));
    format!("SHA-256 {}", hex.collect::<String>())
}

fn shortened(line: &str) -> &str {
    let end = line.char_indices().nth(N_LETTERS);
    &line[..end.map_or(line.len(), |(at, _)| at)]
}
