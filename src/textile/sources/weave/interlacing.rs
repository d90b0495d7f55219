//! Which yarn lies on top at every crossing: the interlacing matrices of common weaves.
//!
//! After any weaving textbook's point papers: rows are picks, columns are ends, `X` where the warp
//! end lies on top.

use serde::{Deserialize, Serialize};

use crate::recipe::{KeyType, ParameterKind};

/// An interlacing: a name, or a matrix of rows of `X` (warp on top) and `.` (weft on top).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub(crate) enum Interlacing {
    /// One of [`NAMES`].
    Named(String),
    /// Rows are picks, from the first pick on.
    Rows(Vec<String>),
}

/// The interlacings known by name, with their rows.
pub(super) const NAMES: [(&str, &[&str]); 15] = [
    ("plain", &["X.", ".X"]),
    ("twill-2-1", &["XX.", ".XX", "X.X"]),
    ("twill-2-2", &["XX..", ".XX.", "..XX", "X..X"]),
    ("twill-3-1", &["XXX.", ".XXX", "X.XX", "XX.X"]),
    ("twill-1-3", &["X...", ".X..", "..X.", "...X"]),
    (
        "herringbone",
        &[
            "XX..XX..", ".XX..XX.", "..XX..XX", "X..XX..X", "..XX..XX", ".XX..XX.", "XX..XX..",
            "X..XX..X",
        ],
    ),
    ("satin-5", &[".XXXX", "XXX.X", "X.XXX", "XXXX.", "XX.XX"]),
    (
        "satin-8",
        &[
            ".XXXXXXX", "XXX.XXXX", "XXXXXX.X", "X.XXXXXX", "XXXX.XXX", "XXXXXXX.", "XX.XXXXX",
            "XXXXX.XX",
        ],
    ),
    ("sateen-5", &["X....", "...X.", ".X...", "....X", "..X.."]),
    ("basket-2-2", &["XX..", "XX..", "..XX", "..XX"]),
    (
        "basket-3-3",
        &["XXX...", "XXX...", "XXX...", "...XXX", "...XXX", "...XXX"],
    ),
    ("warp-rib", &["X.", "X.", ".X", ".X"]),
    ("weft-rib", &["XX..", "..XX"]),
    (
        "crepe",
        &[
            "X.XX..X.", ".XX.X.XX", "X..X.XX.", "XX.XX..X", ".X..XX.X", "X.XX..X.", "..X.XX.X",
            "XX.X.X.X",
        ],
    ),
    (
        "honeycomb",
        &[
            "...XXX..", "..X...X.", ".XX.X.XX", "X..XXX..", "X.XXXXX.", "X..XXX..", ".XX.X.XX",
            "..X...X.",
        ],
    ),
];

/// A repeat of crossings: whether the warp lies on top, by pick and end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Repeat {
    rows: Vec<Vec<bool>>,
}

impl KeyType for Interlacing {
    fn kind(_: [f64; 2], _: &'static str) -> ParameterKind {
        ParameterKind::Interlacing
    }
}

impl Interlacing {
    /// The repeat, or why there is none.
    pub(crate) fn repeat(&self) -> Result<Repeat, String> {
        match self {
            Self::Named(name) => {
                let known = NAMES.iter().find(|(known, _)| known == name);
                let Some((_, rows)) = known else {
                    return Err(format!("unknown interlacing \"{name}\""));
                };
                Repeat::parse(rows.iter().copied())
            }
            Self::Rows(rows) => Repeat::parse(rows.iter().map(String::as_str)),
        }
    }
}

impl Repeat {
    fn parse<'a>(rows: impl Iterator<Item = &'a str>) -> Result<Self, String> {
        let cell = |c: char| match c {
            'X' => Ok(true),
            '.' => Ok(false),
            _ => Err(format!("interlacing holds '{c}'")),
        };
        let rows: Vec<Vec<bool>> = rows
            .map(|row| row.chars().map(cell).collect())
            .collect::<Result<_, String>>()?;
        let width = rows.first().map_or(0, Vec::len);
        if !(2..=32).contains(&width) || !(2..=32).contains(&rows.len()) {
            return Err("the interlacing is not 2 to 32 crossings wide and high".to_owned());
        }
        if rows.iter().any(|row| row.len() != width) {
            return Err("the rows of the interlacing differ in length".to_owned());
        }
        let binds = |mut line: Box<dyn Iterator<Item = bool> + '_>| {
            let first = line.next();
            line.any(|cell| Some(cell) != first)
        };
        let all_bind = rows.iter().all(|row| binds(Box::new(row.iter().copied())))
            && (0..width).all(|end| binds(Box::new(rows.iter().map(move |row| row[end]))));
        if !all_bind {
            return Err("a yarn of the interlacing never changes sides".to_owned());
        }
        Ok(Self { rows })
    }

    /// Picks in a repeat.
    pub(crate) fn n_picks(&self) -> usize {
        self.rows.len()
    }

    /// Ends in a repeat.
    pub(crate) fn n_ends(&self) -> usize {
        self.rows[0].len()
    }

    /// Whether the warp lies on top where an end crosses a pick.
    pub(crate) fn is_warp_on_top(&self, end: usize, pick: usize) -> bool {
        self.rows[pick % self.n_picks()][end % self.n_ends()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_named_weave_holds_together() {
        for (name, rows) in NAMES {
            let repeat = Interlacing::Named(name.to_owned()).repeat();
            assert!(repeat.is_ok(), "{name}: {repeat:?}");
            assert_eq!(repeat.unwrap().n_picks(), rows.len());
        }
    }

    #[test]
    fn what_cannot_be_woven_says_why() {
        let rows = |rows: &[&str]| Interlacing::Rows(rows.iter().map(|&r| r.to_owned()).collect());
        for (interlacing, reason) in [
            (
                Interlacing::Named("tartan".to_owned()),
                "unknown interlacing \"tartan\"",
            ),
            (rows(&["X.", "XX"]), "never changes sides"),
            (rows(&["X.", "."]), "differ in length"),
            (rows(&["Xo", ".X"]), "holds 'o'"),
            (rows(&[]), "not 2 to 32"),
        ] {
            let error = interlacing.repeat().unwrap_err();
            assert!(error.contains(reason), "{error}");
        }
    }
}
