//! `selvedge mds`, run as a user runs it.

use crate::program::{Lab, Outcome};

/// Six corners of a bent line, as far apart as they are.
const TABLE: &str = "\
,a,b,c,d,e,f
a,,1,2.1,3.3,4.2,5.4
b,1,,1.1,2.2,3.4,4.6
c,,,0,1.3,2.3,3.5
d,3.3,2.2,1.3,,1.2,2.4
e,4.2,3.4,2.3,1.2,,1.4
f,5.4,4.6,3.5,2.4,1.4,
";

fn mds(table: &str, more: &[&str]) -> (Lab, Outcome) {
    let lab = Lab::new();
    lab.write("d.csv", table);
    let outcome = lab.run(&[&["mds", "d.csv", "--dims", "1-2"], more].concat());
    (lab, outcome)
}

#[test]
fn maps_are_written_for_programs_and_told_to_people() {
    let (lab, outcome) = mds(TABLE, &["--json", "m.json", "--starts", "5"]);
    assert_eq!((outcome.code, outcome.err.as_str()), (0, ""), "{outcome:?}");
    assert!(
        outcome
            .out
            .contains("6 objects, 15 pairs, 0 missing; primary ties"),
        "{outcome:?}"
    );
    assert!(
        outcome.out.contains("2-D: 6 objects fit into 2 dimensions"),
        "{outcome:?}"
    );
    let json = lab.read("m.json");
    for text in [
        "\"names\": [",
        "\"ties\": \"primary\"",
        "\"loss\": \"stress1\"",
        "\"dims\": 1",
        "\"starts\": 1000",
        "\"starts\": 5",
        "\"reached_best\": ",
        "\"stress_per_point\": [",
        "\"shepard\": [",
        "\"bends_at\": null",
    ] {
        assert!(json.contains(text), "{text}: {json}");
    }
    assert!(!json.contains("NaN"), "{json}");
    let (_, printed) = mds(TABLE, &["--json", "-", "--starts", "5", "--threads", "1"]);
    assert_eq!(printed.out, json, "the same bytes, and nothing else");
}

#[test]
fn chance_stands_beside_the_map_when_it_is_asked_for() {
    let more = [
        "--random-data",
        "20",
        "--permutations",
        "19",
        "--starts",
        "3",
        "--json",
        "-",
    ];
    let (_, outcome) = mds(TABLE, &more);
    assert_eq!(outcome.code, 0, "{outcome:?}");
    for text in [
        "\"random_data\": {",
        "\"five_percent\"",
        "\"p\": 0.05",
        "\"bends_at\": 1",
    ] {
        assert!(outcome.out.contains(text), "{text}: {}", outcome.out);
    }
}

#[test]
fn tables_that_are_no_dissimilarities_are_refused_in_one_line() {
    let asymmetric = TABLE.replace("b,1,", "b,1.5,");
    for (table, said) in [
        (",a,b\na,,1\n", "1 rows and 2 columns"),
        (",a\na,\n", "at least three objects"),
        (
            "0,1,2\n1,0\n2,3,0\n",
            "d.csv:2: 2 cells where there are 3 objects",
        ),
        (
            ",a,b,c\na,,1,2\nx,1,,3\nc,2,3,\n",
            "a row is called x where the column is called b",
        ),
        (
            asymmetric.as_str(),
            "a to b is 1, b to a is 1.5; mend the table, or take the mean",
        ),
        (",a,b,c\na,,1,2\nb,1,,-3\nc,2,,\n", "b to c is negative"),
        (
            ",a,b,c\na,,1,NaN\nb,1,,3\nc,2,3,\n",
            "d.csv:2: a, c is \"NaN\"",
        ),
        (
            ",a,b,c\na,,1,1\nb,1,,1\nc,1,1,\n",
            "all pairs are equally unlike",
        ),
        (
            ",a,b,c,d\na,,1,,\nb,1,,,\nc,,,,2\nd,,,2,\n",
            "no chain of pairs joins a and c",
        ),
        (",a,b\na,1\n", "at least three objects"),
        ("", "d.csv: this file is empty; "),
    ] {
        let (_, outcome) = mds(table, &[]);
        let is_one_line = outcome.err.trim_end().lines().count() == 1;
        assert!(outcome.code == 2 && is_one_line, "{outcome:?}");
        assert!(outcome.err.contains(said), "{said}: {outcome:?}");
    }
    let (_, averaged) = mds(&asymmetric, &["--average"]);
    assert_eq!(averaged.code, 0, "{averaged:?}");
    let lab = Lab::new();
    let wrong = lab.run(&["mds", "d.csv", "--dims", "2-9"]);
    assert!(
        wrong.code == 2 && wrong.err.contains("1 to 5 dimensions"),
        "{wrong:?}"
    );
}
