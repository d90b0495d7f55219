//! What the columns of a table are: by what the user says, by their names, else by their number.

use serde::{Deserialize, Serialize};

use crate::number_table::RawTable;
use crate::unit::{LengthUnit, Unit};

/// One of the two axes of a textile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum TextileAxis {
    /// Along the warp.
    Warp,
    /// Along the weft.
    Weft,
}

/// Out, or back.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum StrokeSide {
    /// Out.
    Forward,
    /// Back.
    Return,
}

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ColumnRole {
    /// The distance, or the place.
    Distance,
    /// The time.
    Time,
    /// Heights of a stroke; what is not said is that of the file.
    Height(Option<TextileAxis>, Option<StrokeSide>),
    /// The coefficient of friction.
    Friction(Option<StrokeSide>),
    /// Nothing of interest.
    Skip,
}

/// A column: what it is, and its unit if its header states one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Column {
    pub(super) role: ColumnRole,
    pub(super) unit: Option<Unit>,
}

impl ColumnRole {
    /// What people call it.
    pub fn label(self) -> &'static str {
        use StrokeSide::{Forward, Return};
        use TextileAxis::{Warp, Weft};

        match self {
            Self::Distance => "distance",
            Self::Time => "time",
            Self::Height(None, None) => "height",
            Self::Height(None, Some(Forward)) => "forward",
            Self::Height(None, Some(Return)) => "return",
            Self::Height(Some(Warp), None) => "warp",
            Self::Height(Some(Warp), Some(Forward)) => "warp forward",
            Self::Height(Some(Warp), Some(Return)) => "warp return",
            Self::Height(Some(Weft), None) => "weft",
            Self::Height(Some(Weft), Some(Forward)) => "weft forward",
            Self::Height(Some(Weft), Some(Return)) => "weft return",
            Self::Friction(None | Some(Forward)) => "friction",
            Self::Friction(Some(Return)) => "friction return",
            Self::Skip => "left out",
        }
    }

    /// The role of a word: `x`, `t`, `height`, `forward`, `return`, `warp-forward`, `mu`, `skip` …
    pub fn from_word(word: &str) -> Option<Self> {
        let role = role_of(&tokens(word))?;
        (word == "skip" || role != Self::Skip).then_some(role)
    }
}

/// The words of a text, lower-case; the micro sign is a u.
pub(super) fn tokens(text: &str) -> Vec<String> {
    let plain = text.to_lowercase().replace(['µ', 'μ'], "u");
    let is_part = |c: char| !(c.is_alphanumeric() || c == '#');
    plain
        .split(is_part)
        .filter(|token| !token.is_empty())
        .map(ToOwned::to_owned)
        .collect()
}

fn has(tokens: &[String], words: &[&str]) -> bool {
    tokens.iter().any(|token| words.contains(&token.as_str()))
}

/// The axis that words name.
pub(super) fn axis_of(tokens: &[String]) -> Option<TextileAxis> {
    let holds = |part: &str| tokens.iter().any(|token| token.contains(part));
    if holds("warp") || has(tokens, &["kette", "wale", "wales"]) {
        return Some(TextileAxis::Warp);
    }
    let is_weft = holds("weft") || has(tokens, &["fill", "filling", "schuss", "course", "courses"]);
    is_weft.then_some(TextileAxis::Weft)
}

/// The side that words name.
pub(super) fn side_of(tokens: &[String]) -> Option<StrokeSide> {
    let forward = ["forward", "fwd", "forth", "out", "outward", "hin", "f"];
    let back = [
        "backward", "bwd", "back", "return", "reverse", "rev", "zurück", "b", "r",
    ];
    let ends = |words: &[&str]| {
        let long = words
            .iter()
            .filter(|word| word.len() > 5 || word.contains('w'));
        let is_end = |token: &String| long.clone().any(|word| token.ends_with(word));
        has(tokens, words) || tokens.iter().any(is_end)
    };
    if ends(&back) {
        return Some(StrokeSide::Return);
    }
    ends(&forward).then_some(StrokeSide::Forward)
}

fn role_of(tokens: &[String]) -> Option<ColumnRole> {
    let (axis, side) = (axis_of(tokens), side_of(tokens));
    if has(tokens, &["mu", "u", "miu", "friction", "reibung"]) {
        return Some(ColumnRole::Friction(side));
    }
    let heights = [
        "height",
        "heights",
        "roughness",
        "thickness",
        "z",
        "smd",
        "höhe",
        "signal",
        "voltage",
    ];
    if axis.is_some() || side.is_some() || has(tokens, &heights) {
        return Some(ColumnRole::Height(axis, side));
    }
    let places = [
        "x", "distance", "dist", "position", "pos", "place", "travel", "weg",
    ];
    if has(tokens, &places) {
        return Some(ColumnRole::Distance);
    }
    if has(tokens, &["t", "time", "zeit", "seconds"]) {
        return Some(ColumnRole::Time);
    }
    let counts = [
        "no", "nr", "n", "#", "index", "sample", "point", "count", "skip",
    ];
    has(tokens, &counts).then_some(ColumnRole::Skip)
}

fn unit_of(tokens: &[String]) -> Option<Unit> {
    let known: [(&[&str], Unit); 8] = [
        (
            &["um", "micron", "microns", "micrometre", "micrometer"],
            Unit::Length(LengthUnit::Micrometre),
        ),
        (&["mm"], Unit::Length(LengthUnit::Millimetre)),
        (&["cm"], Unit::Length(LengthUnit::Centimetre)),
        (&["m"], Unit::Length(LengthUnit::Metre)),
        (&["mv"], Unit::Millivolt),
        (&["v", "volt", "volts"], Unit::Volt),
        (&["s", "sec"], Unit::Second),
        (
            &[
                "gf", "g", "n", "cn", "mn", "kpa", "pa", "ms", "hz", "in", "inch", "mil",
            ],
            Unit::Other,
        ),
    ];
    // The unit follows the name: the last word that is one.
    tokens
        .iter()
        .skip(usize::from(tokens.len() > 1))
        .rev()
        .find_map(|token| {
            let mut of = known.iter();
            of.find(|(words, _)| words.contains(&token.as_str()))
                .map(|(_, unit)| *unit)
        })
}

/// The columns of a table; what is wrong otherwise, and how to say it.
pub(super) fn columns_of(
    table: &RawTable,
    said: Option<&[ColumnRole]>,
) -> Result<Vec<Column>, String> {
    let n = table.columns.len();
    let names: Option<Vec<Vec<String>>> = table
        .headings(n)
        .map(|names| names.iter().map(|name| tokens(name)).collect());
    let unit = |index: usize| names.as_ref().and_then(|names| unit_of(&names[index]));
    let column = |(index, role)| Column {
        role,
        unit: unit(index),
    };
    if let Some(said) = said {
        if said.len() != n {
            return Err(format!("{n} columns where {} are named", said.len()));
        }
        return Ok(said.iter().copied().enumerate().map(column).collect());
    }
    let by_name: Option<Vec<ColumnRole>> = names
        .as_ref()
        .and_then(|names| names.iter().map(|name| role_of(name)).collect());
    let is_useful = |roles: &Vec<ColumnRole>| {
        let is_measured =
            |role: &ColumnRole| matches!(role, ColumnRole::Height(..) | ColumnRole::Friction(_));
        roles.iter().any(is_measured)
    };
    let roles = match by_name.filter(is_useful) {
        Some(roles) => roles,
        None => by_number(table).ok_or_else(|| format!("{n} columns without names"))?,
    };
    Ok(roles.into_iter().enumerate().map(column).collect())
}

/// What unnamed columns are: places first, if the first rises or falls throughout, or goes out and
/// back; then forward and return, of the warp and of the weft.
fn by_number(table: &RawTable) -> Option<Vec<ColumnRole>> {
    use StrokeSide::{Forward, Return};
    use TextileAxis::{Warp, Weft};

    let height = |axis, side| ColumnRole::Height(axis, side);
    let strokes = |n| {
        Some(match n {
            1 => vec![height(None, None)],
            2 => vec![height(None, Some(Forward)), height(None, Some(Return))],
            4 => vec![
                height(Some(Warp), Some(Forward)),
                height(Some(Warp), Some(Return)),
                height(Some(Weft), Some(Forward)),
                height(Some(Weft), Some(Return)),
            ],
            _ => return None,
        })
    };
    let n = table.columns.len();
    let first = table.columns.first()?;
    let has_places = n > 1 && super::places::is_ordered(first);
    let mut roles = strokes(n - usize::from(has_places))?;
    if has_places {
        roles.insert(0, ColumnRole::Distance);
    }
    Some(roles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number_table::table_of;

    fn columns(text: &str) -> Result<Vec<Column>, String> {
        columns_of(&table_of(text, None).unwrap(), None)
    }

    fn roles(text: &str) -> Vec<ColumnRole> {
        columns(text)
            .unwrap()
            .iter()
            .map(|column| column.role)
            .collect()
    }

    #[test]
    fn columns_go_by_their_names() {
        use ColumnRole::{Distance, Friction, Height, Time};
        let found = columns("No;Distance [mm];Roughness (µm)\n1;0;5\n2;1;7\n").unwrap();
        assert_eq!(found[0].role, ColumnRole::Skip);
        assert_eq!(
            (found[1].role, found[1].unit),
            (Distance, Some(Unit::Length(LengthUnit::Millimetre)))
        );
        assert_eq!(found[2].unit, Some(Unit::Length(LengthUnit::Micrometre)));
        assert_eq!(found[2].role, Height(None, None));
        let found = columns("time\tsignal\ns\tV\n0\t5\n0.1\t7\n").unwrap();
        assert_eq!((found[0].role, found[0].unit), (Time, Some(Unit::Second)));
        assert_eq!(found[1].unit, Some(Unit::Volt));
        assert_eq!(roles("x,mu\n0,0.2\n1,0.3\n"), [Distance, Friction(None)]);
        assert_eq!(
            roles("x weftForward weft_return\n0 5 6\n1 7 8\n"),
            [
                Distance,
                Height(Some(TextileAxis::Weft), Some(StrokeSide::Forward)),
                Height(Some(TextileAxis::Weft), Some(StrokeSide::Return)),
            ]
        );
    }

    #[test]
    fn columns_without_names_go_by_their_number() {
        use ColumnRole::{Distance, Height};
        assert_eq!(roles("5\n7\n6\n"), [Height(None, None)]);
        assert_eq!(roles("0 5\n1 7\n2 6\n"), [Distance, Height(None, None)]);
        let pair = [
            Height(None, Some(StrokeSide::Forward)),
            Height(None, Some(StrokeSide::Return)),
        ];
        assert_eq!(roles("3 5\n1 7\n2 6\n1 2\n"), pair);
        assert_eq!(roles("0 3 5\n1 1 7\n")[1..], pair);
        assert_eq!(roles("0 1 2 3 4\n1 4 3 2 1\n").len(), 5);
        assert_eq!(
            columns("0 1 2 3 4 5\n1 4 3 2 1 5\n").unwrap_err(),
            "6 columns without names"
        );
    }

    #[test]
    fn words_name_roles() {
        assert_eq!(ColumnRole::from_word("x"), Some(ColumnRole::Distance));
        assert_eq!(ColumnRole::from_word("skip"), Some(ColumnRole::Skip));
        let role = ColumnRole::from_word("warp-return").unwrap();
        assert_eq!(
            role,
            ColumnRole::Height(Some(TextileAxis::Warp), Some(StrokeSide::Return))
        );
        assert_eq!(ColumnRole::from_word("colour"), None);
    }
}
