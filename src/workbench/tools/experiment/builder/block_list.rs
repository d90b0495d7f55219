//! The keys of every block, what they are for, and when they have a meaning. The names that a key
//! takes are the design's own.

use crate::tools::experiment::builder::blocks::{
    Block, Field, First, Holds, Rows, TRACKS, adapts, asks, shows, track, word,
};

pub(super) const ADAPTED: &str = "adaptation";
pub(super) const STAIRCASE: &str = TRACKS[0].0;
pub(super) const QUEST: &str = TRACKS[1].0;
pub(super) const CONSTANT: &str = TRACKS[2].0;
const STOP: &str = "adaptation.stop";

/// The blocks, in the order of a design.
pub(crate) const BLOCKS: [Block; 9] = [
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
        title: "Stimuli",
        tables: &["stimulus"],
        fields: &[],
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
            .when(|keys| !shows(keys, &["set"])),
            Field::new(
                ("presentation", "standard"),
                ("standard", "none"),
                Holds::Stimulus,
            )
            .when(|keys| !adapts(keys)),
            Field::new(
                ("presentation", "interval_ms"),
                ("interval", "500 ms, cloth 3000 ms"),
                Holds::Count,
            )
            .when(|keys| shows(keys, &["intervals"])),
            Field::new(
                ("presentation", "masker_db"),
                ("masker", "of vibrations, dB re 1 µm"),
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
            Field::new(
                ("rules", "least_share_caught"),
                ("least caught", "0 to 1 of catch trials"),
                Holds::Number,
            )
            .when(|keys| {
                let catches = keys.value(("order", 0, "catch_trials"));
                catches.is_some() && !asks(keys, &["choice"])
            }),
        ],
        rows: &[],
    },
];
