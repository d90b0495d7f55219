//! Designs: those that are shipped are read, and what is wrong is said with its line.

use std::path::Path;

use super::*;

/// The message of a text's first flaw.
fn described(text: &str) -> String {
    match Design::from_toml(text, Path::new("a.toml")) {
        Ok(design) => panic!("{} was taken", design.title),
        Err(error) => error.to_string(),
    }
}

const HEAD: &str = "study = \"s\"\nexperiment = \"e\"\nmedium = \"array\"\nseed = 1\n";

#[test]
fn every_shipped_design_is_read_and_has_a_title() {
    for name in Design::shipped_names() {
        let text = Design::shipped_text(name).unwrap_or_default();
        let design = match Design::from_toml(text, Path::new(name)) {
            Ok(design) => design,
            Err(error) => panic!("{name}: {error}"),
        };
        assert!(!design.title.is_empty(), "{name}");
        assert_eq!(design.hash.len(), 64, "{name}");
    }
}

#[test]
fn an_unknown_medium_is_refused_with_those_that_are_known() {
    let text = HEAD.replace("array", "stylus");
    let described = described(&format!("{text}{NUMBER}"));
    assert!(described.contains("a.toml:3:"), "{described}");
    assert!(
        described.contains("\"array\" or \"real-cloth\""),
        "{described}"
    );
}

#[test]
fn a_design_says_how_it_shows_and_what_is_answered() {
    let none = described(HEAD);
    assert!(none.contains("there is no table [presentation]"), "{none}");
    let half = described(&format!("{HEAD}[presentation]\nkind = \"single\"\n"));
    assert!(half.contains("there is no table [response]"), "{half}");
    let two = described(&format!(
        "{HEAD}[magnitude]\n[ranking]\ntarget = \"virtual\"\n"
    ));
    assert!(two.contains("duplicate field"), "{two}");
}

#[test]
fn what_earlier_versions_wrote_is_the_composition_that_it_was() {
    let asked = |tables: &str| {
        let text = format!("{HEAD}textiles = [\"a\", \"b\", \"c\", \"d\"]\n{tables}");
        let design = Design::from_toml(&text, Path::new("a.toml"));
        design
            .unwrap_or_else(|error| panic!("{tables}: {error}"))
            .composition
    };
    let single = "[presentation]\nkind = \"single\"\n";
    for (old, new) in [
        (
            "[ranking]\ntarget = \"real-cloth\"\n".to_owned(),
            "[presentation]\nkind = \"places\"\nn = 4\nreference = \"real-cloth\"\n\
             [response]\nkind = \"rank\"\n[order]\nsets = \"targets\"\n"
                .to_owned(),
        ),
        (
            "[odd_one_out]\n".to_owned(),
            "[presentation]\nkind = \"places\"\nn = 3\n[response]\nkind = \"choice\"\n\
             confidence_words = [\"easy\", \"normal\", \"hard\"]\n\
             confidence_weights = [1.0, 0.5, 0.1]\n[order]\nsets = \"triads\"\n"
                .to_owned(),
        ),
        (
            format!("[adjustment]\nstandard = \"virtual\"\n[[adjustment.parameter]]\n{TURNED}"),
            format!(
                "{single}reference = \"virtual\"\n[order]\nrepeats = 2\n[response]\n\
                 kind = \"adjustment\"\n[[response.parameter]]\n{TURNED}"
            ),
        ),
        (
            "[magnitude]\nmodulus = 10.0\n".to_owned(),
            format!(
                "{single}[order]\nrepeats = 2\n[response]\nkind = \"number\"\nmodulus = 10.0\n"
            ),
        ),
        (
            format!("[rating]\n[[rating.scale]]\n{SCALE}"),
            format!("{single}[response]\nkind = \"sliders\"\n[[response.scale]]\n{SCALE}"),
        ),
    ] {
        assert_eq!(asked(&old), asked(&new), "{old}");
    }
}

#[test]
fn old_levels_and_judgements_are_the_shipped_ones() {
    for (name, old) in [
        (
            "jnd-40",
            "[levels]\nband_hz = 40\nreference_db = 21.0\nrange_db = [21.25, 33.25]\n\
             [levels.quest_plus]\ngrid_db = 0.25\nwidths_ln = [1.5, 2.0, 3.0, 4.0]\n\
             [levels.stop]\ntrials = 60\n",
        ),
        (
            "threshold-40",
            "[levels]\nband_hz = 40\nintervals = 3\nrange_db = [-20.0, 30.0]\n\
             [levels.staircase]\nup = 1\ndown = 3\nsteps_db = [4.0, 2.0, 1.0]\n\
             starts_db = [20.0, 10.0]\n[levels.stop]\ntrials = 80\nreversals = 8\n",
        ),
        (
            "real-or-generated",
            "[[stimulus]]\nid = \"a\"\ncondition = \"measured\"\n[[stimulus]]\nid = \"b\"\n\
             [judgement]\nreal = \"measured\"\nprotocol = \"single\"\nrepeats = 2\n\
             confidence_grades = 3\n",
        ),
    ] {
        let design = Design::from_toml(&format!("{HEAD}{old}"), Path::new("a.toml"));
        let shipped = Design::shipped(name).unwrap();
        assert_eq!(design.unwrap().composition, shipped.composition, "{name}");
    }
}

const TURNED: &str = "key = \"gain_db\"\nfrom = -6.0\nto = 6.0\nstep = 1.0\n";
const SCALE: &str = "key = \"roughness\"\nlow = \"smooth\"\nhigh = \"rough\"\n";
const NUMBER: &str = "[presentation]\nkind = \"single\"\n[response]\nkind = \"number\"\n";

const SINGLE: &str = "kind = \"single\"";
const PAIR: &str = "kind = \"pair\"";
const ADAPTED: &str = "[adaptation]\nparameter = \"compression\"\nrange = [0.1, 0.9]\n\
    reference = 0.0\n[adaptation.constant]\nvalues = [0.5]\nrepeats = 2";

/// Presentation, response and further tables, with what is said of them and how it is mended.
const MISFITS: [([&str; 3], &str, &str); 22] = [
    (
        [SINGLE, "kind = \"choice\"", ""],
        "one alone to choose",
        "two or more places",
    ),
    (
        [SINGLE, "kind = \"rank\"", ""],
        "are not ranked",
        "\"balanced\"",
    ),
    (
        ["kind = \"places\"\nn = 3", "kind = \"choice\"", ""],
        "which stimuli come together",
        "to [order]",
    ),
    (
        [
            "kind = \"places\"\nn = 3",
            "kind = \"choice\"",
            "[order]\nsets = \"targets\"",
        ],
        "\"targets\" of 3 at once",
        "n = 2 or 4",
    ),
    (
        [
            "kind = \"places\"\nn = 2",
            "kind = \"choice\"",
            "[order]\nsets = \"targets\"",
        ],
        "no target to compare with",
        "reference",
    ),
    (
        [SINGLE, "kind = \"yes-no\"", ""],
        "which word is right",
        "the condition",
    ),
    (
        [PAIR, "kind = \"yes-no\"", ""],
        "said of one alone",
        "\"single\"",
    ),
    (
        [SINGLE, "kind = \"same-different\"", ""],
        "only two are the same",
        "\"pairs\"",
    ),
    (
        [SINGLE, "kind = \"piles\"", ""],
        "only all at once",
        "\"set\"",
    ),
    (
        [
            "kind = \"intervals\"\nreference = \"real-cloth\"",
            "kind = \"choice\"",
            "[order]\nsets = \"targets\"",
        ],
        "cloth on the table does not come in intervals",
        "\"places\"",
    ),
    (
        [
            "kind = \"intervals\"\nmasker_db = 3",
            "kind = \"choice\"",
            "[order]\nsets = \"pairs\"",
        ],
        "a masker under cloth",
        "under vibrations alone",
    ),
    (
        [
            "kind = \"intervals\"\ninterval_ms = 1000",
            "kind = \"choice\"",
            "[order]\nsets = \"pairs\"",
        ],
        "interval_ms is 1000",
        "1500 to 20000 for cloth",
    ),
    (
        [PAIR, "kind = \"number\"\nconfidence_grades = 3", ""],
        "confidence is asked of no choice",
        "take it away",
    ),
    (
        [PAIR, "kind = \"choice\"\nmodulus = 3.0", ""],
        "modulus has no meaning",
        "take it away",
    ),
    (
        [
            "kind = \"single\"\nstandard = \"z\"",
            "kind = \"number\"",
            "",
        ],
        "\"z\" is no stimulus",
        "give the id",
    ),
    (
        [PAIR, "kind = \"choice\"", ADAPTED],
        "4 stimuli, and compression is adapted",
        "name one",
    ),
    (
        [
            SINGLE,
            "kind = \"adjustment\"\n[[response.parameter]]\nkey = \"rotation_deg\"\n\
             from = 0.0\nto = 6.0\nstep = 1.0",
            "",
        ],
        "rotation_deg is not turned by hand",
        "adapt it",
    ),
    (
        [
            SINGLE,
            "kind = \"adjustment\"\n[[response.parameter]]\nkey = \"level_db\"\n\
             from = 0.0\nto = 6.0\nstep = 1.0",
            "",
        ],
        "level_db is not turned by hand",
        "give a gain",
    ),
    (
        [PAIR, "kind = \"choice\"", "[order]\nsets = \"adapted\""],
        "nothing is adapted",
        "add [adaptation]",
    ),
    (
        [
            PAIR,
            "kind = \"choice\"",
            "[order]\ncatch_trials = 2\nsequence = \"zigzag\"",
        ],
        "sequence is \"zigzag\"",
        "\"williams\"",
    ),
    (
        [
            PAIR,
            "kind = \"same-different\"",
            "[rules]\nleast_share_caught = 0.5",
        ],
        "no catch trial here can be answered rightly",
        "add catch_trials",
    ),
    (
        [
            PAIR,
            "kind = \"choice\"",
            "[order]\ncatch_trials = 2\n[rules]\nleast_share_caught = 0.5",
        ],
        "no catch trial here can be answered rightly",
        "or take it away",
    ),
];

#[test]
fn parts_that_do_not_go_together_are_refused_in_one_line_that_says_what_to_do() {
    for ([presentation, response, rest], expected, mend) in MISFITS {
        let stimuli = "textiles = [\"a\", \"b\", \"c\", \"d\"]\n";
        let tables = format!("[presentation]\n{presentation}\n[response]\n{response}\n{rest}\n");
        let described = described(&format!("{HEAD}{stimuli}{tables}"));
        let is_said = described.contains(expected) && described.contains(mend);
        assert!(is_said, "{tables}: {described}");
        assert!(
            !described.contains('\n') && described.starts_with("a.toml:"),
            "{described}"
        );
    }
}

/// What is changed in a good design of an adapted length of time, by what, and what is said of it.
const OFF_THE_TICKS: [(&str, &str, &str); 8] = [
    (
        "reference = 300",
        "reference = 310",
        "reference makes 310 ms; give multiples of 25 ms",
    ),
    (
        "range = [325, 600]",
        "range = [325, 610]",
        "range makes 610 ms",
    ),
    (
        "range = [325, 600]",
        "range = [325, 9000]",
        "the range of duration_ms is 325 to 9000",
    ),
    ("steps = [50, 25]", "steps = [50, 30]", "steps makes 30 ms"),
    ("starts = [500]", "starts = [505]", "starts makes 505 ms"),
    (
        "steps = [50, 25]",
        "steps = [50, 25]\nup_over_down = 1.5",
        "up_over_down makes 37.5 ms",
    ),
    ("band_hz = 40\nlevel_db = 20.0\n", "", "has no duration_ms"),
    (
        "\"duration_ms\"",
        "\"rotation_deg\"",
        "has no rotation_deg; name a textile",
    ),
];

#[test]
fn an_adapted_length_is_whole_ticks_of_a_vibration() {
    let good = format!(
        "{HEAD}[[stimulus]]\nid = \"a\"\nband_hz = 40\nlevel_db = 20.0\n[presentation]\n\
         kind = \"intervals\"\n[response]\nkind = \"choice\"\n[adaptation]\n\
         parameter = \"duration_ms\"\nreference = 300\nrange = [325, 600]\n\
         [adaptation.staircase]\nup = 1\ndown = 2\nsteps = [50, 25]\nstarts = [500]\n\
         [adaptation.stop]\ntrials = 30\n"
    );
    Design::from_toml(&good, Path::new("a.toml")).unwrap();
    for (from, to, expected) in OFF_THE_TICKS {
        assert!(good.contains(from), "{from}");
        let described = described(&good.replacen(from, to, 1));
        assert!(
            described.contains(expected) && !described.contains('\n'),
            "{to}: {described}"
        );
    }
}

#[test]
fn fifteen_textiles_cannot_be_ranked_in_fours() {
    let ids: Vec<String> = (0..15).map(|n| format!("\"t{n}\"")).collect();
    let text = format!(
        "{HEAD}textiles = [{}]\n[presentation]\nkind = \"places\"\nn = 4\n\
         reference = \"virtual\"\n[response]\nkind = \"rank\"\n[order]\nsets = \"targets\"\n",
        ids.join(", ")
    );
    let described = described(&text);
    assert!(
        described.contains("a.toml:13: 15 stimuli cannot be ranked"),
        "{described}"
    );
}

#[test]
fn a_question_is_asked_in_the_language_that_is_chosen() {
    let stimuli = "textiles = [\"a\", \"b\"]\n";
    let question = |language: &str| {
        let text = format!(
            "{HEAD}{stimuli}{NUMBER}[question]\ntext = \"How rough?\"\n{language}\
             [question.texts]\nde = \"Wie rau?\"\n"
        );
        Design::from_toml(&text, Path::new("a.toml"))
            .unwrap()
            .composition
            .question()
    };
    assert_eq!(question(""), "How rough?");
    assert_eq!(question("language = \"de\"\n"), "Wie rau?");
    assert_eq!(question("language = \"fr\"\n"), "How rough?", "not there");
}

#[test]
fn two_stimuli_of_one_name_are_refused_at_the_second() {
    let stimuli = "[[stimulus]]\nid = \"a\"\n[[stimulus]]\nid = \"a\"\n";
    let described = described(&format!("{HEAD}{stimuli}{NUMBER}"));
    assert!(
        described.contains("a.toml:8: two stimuli are called \"a\""),
        "{described}"
    );
}

#[test]
fn intervals_are_of_one_kind_and_cloth_has_longer_ones() {
    let tables = "[presentation]\nkind = \"intervals\"\n[response]\nkind = \"choice\"\n\
                  [order]\nsets = \"pairs\"\n";
    let vibration = |id: &str| format!("[[stimulus]]\nid = \"{id}\"\nband_hz = 40\nlevel_db = 9\n");
    let textiles = "textiles = [\"a\", \"b\"]\n";
    let mixed = described(&format!("{HEAD}{textiles}{}{tables}", vibration("v")));
    assert!(
        mixed.contains("textiles and vibrations") && mixed.contains("of one kind"),
        "{mixed}"
    );
    let ms = |stimuli: &str| {
        let text = format!("{HEAD}{stimuli}{tables}");
        let design = Design::from_toml(&text, Path::new("a.toml")).unwrap();
        design.composition.presentation.interval_ms
    };
    assert_eq!(ms(textiles), 3000);
    assert_eq!(ms(&(vibration("v") + &vibration("w"))), 500);
}

#[test]
fn a_series_that_nothing_ends_is_refused() {
    let tables = "[presentation]\nkind = \"intervals\"\n[response]\nkind = \"choice\"\n\
                  [adaptation]\nparameter = \"level_db\"\nband_hz = 40\nrange = [0, 20]\n\
                  [adaptation.staircase]\nup = 1\ndown = 2\nsteps = [2.0]\nstarts = [10.0]\n";
    let described = described(&format!("{HEAD}{tables}"));
    assert!(described.contains("nothing ends a series"), "{described}");
}

#[test]
fn a_misspelt_key_is_named_with_its_line() {
    let described = described(&format!("{HEAD}{NUMBER}[order]\nrepeat = 3\n"));
    assert!(
        described.contains("a.toml:10:") && described.contains("`repeat`"),
        "{described}"
    );
}

#[test]
fn a_stylus_feels_textiles_that_lie_still_by_force_alone_or_with_vibration() {
    let shipped = Design::shipped_text("force-or-vibration").unwrap();
    let design = Design::from_toml(shipped, Path::new("a.toml")).unwrap();
    let stylus = design.composition.presentation.stylus.unwrap();
    assert_eq!((stylus.rate_hz, stylus.radius_mm), (4000.0, 0.25));
    let is_force = |one: &Stimulus| match &one.source {
        Source::Textile { variant, .. } => variant.is_force_alone,
        _ => false,
    };
    for one in &design.stimuli {
        assert_eq!(is_force(one), one.condition == "force", "{}", one.id);
    }
    let k = "stiffness_n_per_m = 1000.0";
    for (before, after, why) in [
        (
            k,
            "stiffness_n_per_m = -1.0",
            "the stiffness is -1 N/m; give",
        ),
        (k, "stiffness = 1000.0", "unknown field `stiffness`"),
        (
            k,
            "stiffness_n_per_m = 1e5\nsampled = true",
            "cannot be held; ",
        ),
        (k, "delay_ticks = 0.5", "a whole number of ticks"),
        (
            "kind = \"pair\"\nreference = \"real-cloth\"",
            "kind = \"intervals\"",
            "what lies still",
        ),
    ] {
        assert!(shipped.contains(before), "{before}");
        let said = described(&shipped.replace(before, after));
        assert!(said.contains(why), "{said}");
    }
    let first = shipped.find("[presentation.stylus]").unwrap();
    let last = shipped.find("[question]").unwrap();
    let without = described(&format!("{}{}", &shipped[..first], &shipped[last..]));
    assert!(
        without.contains("\"mouse-mat-force\" is to be felt by force alone; add"),
        "{without}"
    );
}
