//! The blocks that a design is built of: which keys each holds, what they are for, and when they
//! have a meaning. The names that a key takes are the design's own.

use selvedge_foundation::files::{EditedKeys, KeyValue};

/// What a key holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Holds {
    /// Words of one's own.
    Words,
    /// Several lines of them.
    Paragraph,
    /// A name that the file knows; whether it may be left out.
    Name(bool),
    /// A stimulus, or none.
    Stimulus,
    /// A number.
    Number,
    /// A whole number.
    Count,
    /// Yes or no.
    Flag,
    /// Words or numbers, with commas between.
    List,
}

/// What a key is at first, where it cannot be left out.
#[derive(Debug, Clone, Copy)]
pub(crate) enum First {
    /// It can.
    Nothing,
    Word(&'static str),
    Count(i64),
    Number(f64),
    Numbers(&'static [f64]),
}

impl First {
    /// The value.
    pub(crate) fn value(self) -> Option<KeyValue> {
        match self {
            Self::Nothing => None,
            Self::Word(word) => Some(word.into()),
            Self::Count(n) => Some(n.into()),
            Self::Number(number) => Some(number.into()),
            Self::Numbers(all) => Some(KeyValue::Array(
                all.iter().copied().map(KeyValue::from).collect(),
            )),
        }
    }
}

impl First {
    fn is_nothing(self) -> bool {
        matches!(self, Self::Nothing)
    }
}

/// A key of a block.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Field {
    pub(crate) table: &'static str,
    pub(crate) key: &'static str,
    /// What people call it, and its unit or what stands for nothing.
    pub(crate) name: &'static str,
    pub(crate) hint: &'static str,
    pub(crate) holds: Holds,
    first: First,
    /// Whether it has a meaning.
    applies: fn(&EditedKeys) -> bool,
}

impl Field {
    const fn new(
        (table, key): (&'static str, &'static str),
        (name, hint): (&'static str, &'static str),
        holds: Holds,
    ) -> Self {
        Self {
            table,
            key,
            name,
            hint,
            holds,
            first: First::Nothing,
            applies: |_| true,
        }
    }

    const fn when(self, applies: fn(&EditedKeys) -> bool) -> Self {
        Self { applies, ..self }
    }

    const fn first(self, first: First) -> Self {
        Self { first, ..self }
    }

    /// Whether it has a meaning in this design.
    pub(crate) fn applies(&self, keys: &EditedKeys) -> bool {
        (self.applies)(keys)
    }
}

/// Tables of one name, each a row of a block.
#[derive(Debug)]
pub(crate) struct Rows {
    pub(crate) table: &'static str,
    /// What one of them is called.
    pub(crate) one: &'static str,
    pub(crate) fields: &'static [Field],
    applies: fn(&EditedKeys) -> bool,
    /// Whether there has to be one.
    is_needed: bool,
}

impl Rows {
    /// Whether they have a meaning in this design.
    pub(crate) fn applies(&self, keys: &EditedKeys) -> bool {
        (self.applies)(keys)
    }

    /// What a new one states.
    pub(crate) fn firsts(&self) -> Vec<(&'static str, KeyValue)> {
        let stated = |field: &Field| Some((field.key, field.first.value()?));
        self.fields.iter().filter_map(stated).collect()
    }
}

/// A part of a design.
#[derive(Debug)]
pub(crate) struct Block {
    pub(crate) title: &'static str,
    /// Tables that it stands for, the first its own.
    pub(crate) tables: &'static [&'static str],
    pub(crate) fields: &'static [Field],
    pub(crate) rows: &'static [Rows],
}

/// What a key says in words; empty where it says nothing.
pub(crate) fn word(keys: &EditedKeys, table: &str, key: &str) -> String {
    let value = keys.value((table, 0, key));
    value
        .as_ref()
        .and_then(KeyValue::as_str)
        .unwrap_or_default()
        .to_owned()
}

fn asks(keys: &EditedKeys, kinds: &[&str]) -> bool {
    kinds.contains(&word(keys, "response", "kind").as_str())
}

fn shows(keys: &EditedKeys, kinds: &[&str]) -> bool {
    kinds.contains(&word(keys, "presentation", "kind").as_str())
}

/// Whether a number follows the answers.
pub(crate) fn adapts(keys: &EditedKeys) -> bool {
    keys.n_tables("adaptation") > 0
}

/// The tables of which one says how the next value is found.
pub(crate) const TRACKS: [(&str, &str); 3] = [
    ("adaptation.staircase", "staircase"),
    ("adaptation.quest_plus", "QUEST+"),
    ("adaptation.constant", "constant stimuli"),
];

/// The one of a design.
pub(crate) fn track(keys: &EditedKeys) -> Option<&'static str> {
    let mut tracks = TRACKS.iter().map(|(table, _)| *table);
    tracks.find(|table| keys.n_tables(table) > 0)
}

const ADAPTED: &str = "adaptation";
const STAIRCASE: &str = TRACKS[0].0;
const QUEST: &str = TRACKS[1].0;
const CONSTANT: &str = TRACKS[2].0;
const STOP: &str = "adaptation.stop";

/// The blocks, in the order of a design.
pub(crate) const BLOCKS: [Block; 8] = [
    Block {
        title: "Study",
        tables: &[""],
        fields: &[
            Field::new(
                ("", "title"),
                ("title", "what people call it"),
                Holds::Words,
            ),
            Field::new(("", "study"), ("study", "names files"), Holds::Words),
            Field::new(
                ("", "experiment"),
                ("experiment", "names files"),
                Holds::Words,
            ),
            Field::new(("", "medium"), ("medium", ""), Holds::Name(false)),
            Field::new(("", "seed"), ("seed", "0"), Holds::Count),
            Field::new(
                ("", "library"),
                ("library", "the shipped sixteen"),
                Holds::Words,
            ),
        ],
        rows: &[],
    },
    Block {
        title: "Presentation",
        tables: &["presentation"],
        fields: &[
            Field::new(
                ("presentation", "kind"),
                ("shown as", ""),
                Holds::Name(false),
            ),
            Field::new(("presentation", "n"), ("how many", "2"), Holds::Count)
                .when(|keys| shows(keys, &["places", "intervals"]))
                .first(First::Count(2)),
            Field::new(
                ("presentation", "reference"),
                ("compared with", ""),
                Holds::Name(true),
            )
            .when(|keys| !shows(keys, &["intervals", "set"])),
            Field::new(
                ("presentation", "standard"),
                ("standard", "none"),
                Holds::Stimulus,
            )
            .when(|keys| !adapts(keys)),
            Field::new(
                ("presentation", "interval_ms"),
                ("interval", "500 ms"),
                Holds::Count,
            )
            .when(|keys| shows(keys, &["intervals"])),
            Field::new(
                ("presentation", "masker_db"),
                ("masker", "none, dB re 1 µm"),
                Holds::Number,
            )
            .when(|keys| shows(keys, &["intervals"])),
        ],
        rows: &[],
    },
    Block {
        title: "Question",
        tables: &["question", "question.texts"],
        fields: &[Field::new(
            ("question", "language"),
            ("language", "as below; de, pt-BR"),
            Holds::Words,
        )],
        rows: &[],
    },
    Block {
        title: "Response",
        tables: &["response", "response.scale", "response.parameter"],
        fields: &[
            Field::new(
                ("response", "kind"),
                ("answered by", ""),
                Holds::Name(false),
            ),
            Field::new(("response", "words"), ("words", "yes, no"), Holds::List)
                .when(|keys| asks(keys, &["yes-no", "best-worst"])),
            Field::new(
                ("response", "right"),
                ("right is", "a condition, or later"),
                Holds::Words,
            )
            .when(|keys| asks(keys, &["choice", "yes-no"]) && !adapts(keys)),
            Field::new(("response", "modulus"), ("modulus", "none"), Holds::Number)
                .when(|keys| asks(keys, &["number"])),
            Field::new(
                ("response", "confidence_grades"),
                ("how sure", "not asked"),
                Holds::Count,
            )
            .when(|keys| asks(keys, &["choice", "yes-no", "same-different"])),
            Field::new(
                ("response", "confidence_words"),
                ("or in words", "easy, hard"),
                Holds::List,
            )
            .when(|keys| asks(keys, &["choice", "yes-no", "same-different"])),
            Field::new(
                ("response", "confidence_weights"),
                ("worth", "1, 0.5"),
                Holds::List,
            )
            .when(|keys| {
                let words = keys.value(("response", 0, "confidence_words"));
                words.is_some() && asks(keys, &["choice", "yes-no", "same-different"])
            }),
        ],
        rows: &[
            Rows {
                table: "response.scale",
                one: "scale",
                fields: &[
                    Field::new(("response.scale", "key"), ("name", "smooth"), Holds::Words)
                        .first(First::Word("rough")),
                    Field::new(
                        ("response.scale", "low"),
                        ("low end", "smooth"),
                        Holds::Words,
                    )
                    .first(First::Word("smooth")),
                    Field::new(
                        ("response.scale", "high"),
                        ("high end", "rough"),
                        Holds::Words,
                    )
                    .first(First::Word("rough")),
                    Field::new(
                        ("response.scale", "points"),
                        ("points", "a line"),
                        Holds::Count,
                    ),
                ],
                applies: |keys| asks(keys, &["sliders"]),
                is_needed: true,
            },
            Rows {
                table: "response.parameter",
                one: "parameter",
                fields: &[
                    Field::new(
                        ("response.parameter", "key"),
                        ("what", ""),
                        Holds::Name(false),
                    )
                    .first(First::Word("gain_db")),
                    Field::new(("response.parameter", "from"), ("from", ""), Holds::Number)
                        .first(First::Number(-20.0)),
                    Field::new(("response.parameter", "to"), ("to", ""), Holds::Number)
                        .first(First::Number(0.0)),
                    Field::new(("response.parameter", "step"), ("step", ""), Holds::Number)
                        .first(First::Number(1.0)),
                ],
                applies: |keys| asks(keys, &["adjustment"]),
                is_needed: true,
            },
        ],
    },
    Block {
        title: "Order",
        tables: &["order"],
        fields: &[
            Field::new(("order", "sets"), ("come together", ""), Holds::Name(true))
                .when(|keys| !adapts(keys)),
            Field::new(("order", "repeats"), ("repeats", "1"), Holds::Count)
                .when(|keys| !adapts(keys)),
            Field::new(("order", "sequence"), ("sequence", ""), Holds::Name(true))
                .when(|keys| !adapts(keys)),
            Field::new(
                ("order", "catch_trials"),
                ("catch trials", "0 a block"),
                Holds::Count,
            )
            .when(|keys| !adapts(keys)),
        ],
        rows: &[],
    },
    Block {
        title: "Adaptation",
        tables: &[ADAPTED, STAIRCASE, QUEST, CONSTANT, STOP],
        fields: &[
            Field::new((ADAPTED, "parameter"), ("what", ""), Holds::Name(false))
                .when(adapts)
                .first(First::Word("gain_db")),
            Field::new(
                (ADAPTED, "band_hz"),
                ("band", "40 or 320 Hz"),
                Holds::Number,
            )
            .when(|keys| word(keys, ADAPTED, "parameter") == "level_db")
            .first(First::Count(40)),
            Field::new(
                (ADAPTED, "reference"),
                ("reference", "none: a threshold"),
                Holds::Number,
            )
            .when(adapts),
            Field::new((ADAPTED, "range"), ("range", "-12, 12"), Holds::List)
                .when(adapts)
                .first(First::Numbers(&[-12.0, 12.0])),
            Field::new((ADAPTED, "seeks"), ("seeks", ""), Holds::Name(true)).when(adapts),
            Field::new((STAIRCASE, "up"), ("up after wrong", "1"), Holds::Count)
                .when(|keys| track(keys) == Some(STAIRCASE))
                .first(First::Count(1)),
            Field::new((STAIRCASE, "down"), ("down after right", "2"), Holds::Count)
                .when(|keys| track(keys) == Some(STAIRCASE))
                .first(First::Count(2)),
            Field::new((STAIRCASE, "steps"), ("steps", "4, 2, 1"), Holds::List)
                .when(|keys| track(keys) == Some(STAIRCASE))
                .first(First::Numbers(&[4.0, 2.0, 1.0])),
            Field::new((STAIRCASE, "starts"), ("starts at", "10, 2"), Holds::List)
                .when(|keys| track(keys) == Some(STAIRCASE))
                .first(First::Numbers(&[10.0])),
            Field::new(
                (STAIRCASE, "up_over_down"),
                ("up over down", "1"),
                Holds::Number,
            )
            .when(|keys| track(keys) == Some(STAIRCASE)),
            Field::new((QUEST, "grid"), ("grid", "1"), Holds::Number)
                .when(|keys| track(keys) == Some(QUEST))
                .first(First::Number(0.5)),
            Field::new((CONSTANT, "values"), ("values", "-6, 0, 6"), Holds::List)
                .when(|keys| track(keys) == Some(CONSTANT))
                .first(First::Numbers(&[-6.0, -3.0, 0.0, 3.0, 6.0])),
            Field::new(
                (CONSTANT, "repeats"),
                ("each comes", "10 times"),
                Holds::Count,
            )
            .when(|keys| track(keys) == Some(CONSTANT))
            .first(First::Count(10)),
            Field::new((STOP, "trials"), ("ends after", "… trials"), Holds::Count)
                .when(|keys| matches!(track(keys), Some(STAIRCASE | QUEST)))
                .first(First::Count(40)),
            Field::new((STOP, "reversals"), ("or reversals", "none"), Holds::Count)
                .when(|keys| track(keys) == Some(STAIRCASE)),
            Field::new(
                (STOP, "posterior_sd"),
                ("or below an sd of", "none"),
                Holds::Number,
            )
            .when(|keys| track(keys) == Some(QUEST)),
            Field::new((STOP, "needs"), ("needs", ""), Holds::Name(true))
                .when(|keys| matches!(track(keys), Some(STAIRCASE | QUEST))),
        ],
        rows: &[],
    },
    Block {
        title: "Course",
        tables: &["course", "course.familiarisation"],
        fields: &[
            Field::new(
                ("course", "instructions"),
                ("instructions", "what the participant reads first"),
                Holds::Paragraph,
            ),
            Field::new(
                ("course", "practice_trials"),
                ("practice", "0 trials"),
                Holds::Count,
            ),
            Field::new(
                ("course", "break_after_blocks"),
                ("a break after", "0 blocks"),
                Holds::Count,
            ),
            Field::new(("course", "break_s"), ("of at least", "0 s"), Holds::Number),
            Field::new(
                ("course", "masking_noise"),
                ("masking noise", ""),
                Holds::Flag,
            ),
        ],
        rows: &[Rows {
            table: "course.familiarisation",
            one: "movement",
            fields: &[
                Field::new(
                    ("course.familiarisation", "movement"),
                    ("course", ""),
                    Holds::Name(false),
                )
                .first(First::Word("circular")),
                Field::new(
                    ("course.familiarisation", "for_s"),
                    ("for", "s"),
                    Holds::Number,
                )
                .first(First::Number(30.0)),
                Field::new(
                    ("course.familiarisation", "speed_mm_per_s"),
                    ("speed", "100 mm/s"),
                    Holds::Number,
                ),
            ],
            applies: |_| true,
            is_needed: false,
        }],
    },
    Block {
        title: "Rules",
        tables: &["rules"],
        fields: &[
            Field::new(
                ("rules", "subjects"),
                ("subjects", "left open"),
                Holds::Count,
            ),
            Field::new(
                ("rules", "least_trials"),
                ("least trials", "0"),
                Holds::Count,
            ),
            Field::new(
                ("rules", "least_response_s"),
                ("least time", "0 s"),
                Holds::Number,
            ),
            Field::new(
                ("rules", "least_share_correct"),
                ("least right", "0 to 1"),
                Holds::Number,
            ),
        ],
        rows: &[],
    },
];

/// The fields of a stimulus, beyond its id.
pub(crate) const STIMULUS: Rows = Rows {
    table: "stimulus",
    one: "stimulus",
    fields: &[
        Field::new(
            ("stimulus", "id"),
            ("id", "a name of its own"),
            Holds::Words,
        ),
        Field::new(
            ("stimulus", "textile"),
            ("textile", "as the id"),
            Holds::Words,
        ),
        Field::new(("stimulus", "cloth"), ("real cloth", "none"), Holds::Words),
        Field::new(
            ("stimulus", "material"),
            ("material", "as the id"),
            Holds::Words,
        ),
        Field::new(
            ("stimulus", "condition"),
            ("condition", "none"),
            Holds::Words,
        ),
        Field::new(("stimulus", "gain_db"), ("gain", "0 dB"), Holds::Number),
        Field::new(
            ("stimulus", "band_hz"),
            ("vibration", "40 or 320 Hz"),
            Holds::Number,
        ),
        Field::new(
            ("stimulus", "level_db"),
            ("level", "dB re 1 µm"),
            Holds::Number,
        ),
    ],
    applies: |_| true,
    is_needed: false,
};

/// Takes away what has no meaning any more, and adds what cannot be left out: after a choice that
/// others hang on.
pub(crate) fn settle(keys: &mut EditedKeys) {
    if adapts(keys) && track(keys).is_none() {
        let up = First::Count(1).value();
        keys.set((STAIRCASE, 0, "up"), up.as_ref());
    }
    // What is asked decides on what hangs on it: twice, since some hang on those.
    for _ in 0..2 {
        for block in &BLOCKS {
            for field in block.fields {
                let place = (field.table, 0, field.key);
                let is_stated = keys.value(place).is_some();
                if !field.applies(keys) {
                    keys.set(place, None);
                } else if !is_stated && !field.first.is_nothing() {
                    keys.set(place, field.first.value().as_ref());
                }
            }
            for rows in block.rows {
                let applies = rows.applies(keys);
                while !applies && keys.n_tables(rows.table) > 0 {
                    keys.remove(rows.table, 0);
                }
                if applies && rows.is_needed && keys.n_tables(rows.table) == 0 {
                    keys.push(rows.table, &rows.firsts());
                }
            }
        }
    }
}

/// Lets a number follow the answers, found so, or no longer.
pub(crate) fn set_track(keys: &mut EditedKeys, chosen: Option<&'static str>) {
    for (table, _) in TRACKS {
        if chosen != Some(table) {
            keys.remove(table, 0);
        }
    }
    let Some(table) = chosen else {
        keys.remove(ADAPTED, 0);
        return settle(keys);
    };
    let firsts = BLOCKS.iter().flat_map(|block| block.fields);
    for field in firsts.filter(|field| field.table == table || field.table == ADAPTED) {
        if keys.value((field.table, 0, field.key)).is_none() && field.key != "band_hz" {
            keys.set((field.table, 0, field.key), field.first.value().as_ref());
        }
    }
    let range = keys.value((ADAPTED, 0, "range"));
    let numbers = |value: &KeyValue| -> Option<[f64; 2]> {
        let all = value.as_array()?.iter();
        let number = |one: &KeyValue| one.as_float().or_else(|| one.to_string().parse().ok());
        all.map(number)
            .collect::<Option<Vec<f64>>>()?
            .try_into()
            .ok()
    };
    if let Some([low, high]) = range.as_ref().and_then(numbers) {
        // Values lie in the range: a staircase begins where it is easy.
        let at = |share: f64| KeyValue::Float(low + share * (high - low));
        let (place, values) = match table {
            STAIRCASE => ((table, 0, "starts"), vec![at(1.0)]),
            _ => (
                (table, 0, "values"),
                [0.0, 0.25, 0.5, 0.75, 1.0].map(at).to_vec(),
            ),
        };
        if table != QUEST {
            keys.set(place, Some(&KeyValue::Array(values)));
        }
    }
    settle(keys);
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use selvedge_experiment::design::{Design, names_of};

    fn keys(name: &str) -> EditedKeys {
        let text = Design::shipped_text(name).unwrap();
        EditedKeys::parse(text, Path::new(name)).unwrap()
    }

    fn read(keys: &EditedKeys) -> Result<Design, String> {
        Design::from_toml(&keys.text(), Path::new("a.toml")).map_err(|error| error.to_string())
    }

    #[test]
    fn every_name_has_names_and_every_design_says_nothing_without_a_meaning() {
        let rows = BLOCKS.iter().flat_map(|block| block.rows);
        let fields = BLOCKS.iter().flat_map(|block| block.fields);
        for field in fields.chain(rows.flat_map(|rows| rows.fields)) {
            let has_names = !names_of(field.table, field.key).is_empty();
            let is_name = matches!(field.holds, Holds::Name(_));
            assert_eq!(is_name, has_names, "{}.{}", field.table, field.key);
        }
        for name in Design::shipped_names() {
            let mut settled = keys(name);
            let before = read(&settled).unwrap();
            settle(&mut settled);
            let after = read(&settled).unwrap();
            assert_eq!(before.composition, after.composition, "{name}");
        }
    }

    #[test]
    fn whatever_is_chosen_to_be_answered_by_is_a_design_again_or_says_why_not() {
        let mut n_good = 0;
        for name in Design::shipped_names() {
            for kind in names_of("response", "kind") {
                let mut keys = keys(name);
                keys.set(("response", 0, "kind"), Some(&kind.into()));
                settle(&mut keys);
                match read(&keys) {
                    Ok(_) => n_good += 1,
                    Err(line) => {
                        assert!(line.contains("; ") && !line.contains("unknown"), "{line}")
                    }
                }
            }
        }
        assert!(n_good >= 20, "{n_good}");
    }

    #[test]
    fn a_number_that_follows_the_answers_is_added_and_taken_away() {
        let mut keys = keys("jnd-40");
        for (table, _) in TRACKS {
            set_track(&mut keys, Some(table));
            assert_eq!(track(&keys), Some(table));
            assert!(
                read(&keys).is_ok(),
                "{table}: {:?}\n{}",
                read(&keys),
                keys.text()
            );
        }
        set_track(&mut keys, None);
        assert!(!adapts(&keys) && !keys.text().contains("adaptation"));
    }
}
