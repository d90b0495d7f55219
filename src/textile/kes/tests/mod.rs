//! Every layout holds the same textile; what files do not say is asked for.

mod sections;

use std::f64::consts::PI;
use std::path::Path;

use proptest::prelude::*;

use super::*;
use crate::surface::Direction;
use selvedge_foundation::numerics::Random;

/// Distance of samples, mm.
const STEP_MM: f64 = 0.02;
/// Samples of a stroke of 30 mm.
const N: usize = 1500;

/// A textile that is not alike both ways: yarns of uneven height.
fn cloth(seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    let mut drift = 0.0;
    (0..N)
        .map(|i| {
            drift = 0.98 * drift + 0.5 * random.normal();
            let x_mm = i as f64 * STEP_MM;
            let height = 8.0 * (2.0 * PI * 2.3 * x_mm).sin() + drift + 0.2 * random.normal();
            (height * 100.0).round() / 100.0
        })
        .collect()
}

/// How a file is spelt.
#[derive(Debug, Clone, Copy)]
struct Spelling {
    separator: &'static str,
    decimal: char,
    has_header: bool,
}

const SPELLINGS: [Spelling; 7] = {
    const fn of(separator: &'static str, decimal: char, has_header: bool) -> Spelling {
        Spelling {
            separator,
            decimal,
            has_header,
        }
    }
    [
        of("\t", '.', true),
        of("\t", ',', false),
        of(",", '.', true),
        of(";", ',', true),
        of(";", '.', false),
        of("  ", '.', false),
        of(" ", ',', true),
    ]
};

impl Spelling {
    fn number(self, value: f64) -> String {
        let text = format!("{value:.2}");
        text.replace('.', &self.decimal.to_string())
    }

    fn file(self, names: &[&str], columns: &[&[f64]]) -> String {
        let mut text = String::new();
        if self.has_header {
            text.push_str("KES-FB4 surface tester\r\nSample: 7\r\n\r\n");
            text.push_str(&names.join(self.separator));
            text.push_str("\r\n");
        }
        for row in 0..columns[0].len() {
            let cells: Vec<String> = columns
                .iter()
                .map(|column| self.number(column[row]))
                .collect();
            text.push_str(&cells.join(self.separator));
            text.push_str("\r\n");
        }
        text
    }
}

fn read(files: &[(&str, &str)], options: &KesOptions) -> Result<KesReading, String> {
    let files: Vec<KesFile<'_>> = files
        .iter()
        .map(|(name, text)| KesFile {
            path: Path::new(*name),
            bytes: text.as_bytes(),
        })
        .collect();
    KesReading::of(&files, None, options).map_err(|error| {
        let error = error.to_string();
        assert!(
            !error.contains('\n') && error.contains("; "),
            "no mend: {error}"
        );
        error
    })
}

/// The places of a stroke.
fn places() -> Vec<f64> {
    (0..N).map(|i| i as f64 * STEP_MM).collect()
}

fn turned(values: &[f64]) -> Vec<f64> {
    values.iter().rev().copied().collect()
}

/// The same heights but for a straight line: which samples it was laid through is no matter here.
fn expect_alike(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    let [found, expected] = [found, expected].map(|heights| {
        let mut heights = heights.to_vec();
        reading::remove_tilt(&mut heights, &[], STEP_MM);
        heights
    });
    for (found, expected) in found.iter().zip(&expected) {
        assert!(
            (found - expected).abs() < 1e-6,
            "{found} against {expected}"
        );
    }
}

/// What a stroke must be: the textile without its tilt, in the order of travel.
fn expect(reading: &KesReading, direction: Direction, cloth: &[f64]) {
    let stroke = reading.stroke(direction);
    let stroke = stroke.unwrap_or_else(|| panic!("no {direction:?}"));
    let mut expected = cloth.to_vec();
    if direction.is_reverse() {
        expected.reverse();
    }
    assert!(
        (stroke.step_mm - STEP_MM).abs() < 1e-9,
        "{}",
        stroke.step_mm
    );
    expect_alike(&stroke.heights_um, &expected);
    let [low, high] = stroke.range_mm();
    assert!(
        low.abs() < 1e-6 && (high - (N - 1) as f64 * STEP_MM).abs() < 1e-6,
        "{low} {high}"
    );
}

#[test]
fn one_file_an_axis_holds_both_ways_in_either_order() {
    let (x, z) = (places(), cloth(1));
    for spelling in SPELLINGS {
        for back in [z.clone(), turned(&z)] {
            let names = ["x (mm)", "forward (um)", "return (um)"];
            let text = spelling.file(&names, &[&x, &z, &back]);
            let reading = read(&[("cloth.txt", &text)], &KesOptions::default()).unwrap();
            expect(&reading, Direction::WarpForward, &z);
            expect(&reading, Direction::WarpReverse, &z);
        }
    }
}

#[test]
fn four_files_go_by_their_names() {
    let (x, z, w) = (places(), cloth(1), cloth(2));
    for spelling in SPELLINGS {
        let file = |x: &[f64], z: &[f64]| spelling.file(&["distance mm", "height um"], &[x, z]);
        let files = [
            file(&x, &z),
            file(&turned(&x), &turned(&z)),
            file(&x, &w),
            file(&x, &w),
        ];
        let names = [
            "silk_warp_fwd.txt",
            "silk_warp_bwd.txt",
            "silk_weft_fwd.csv",
            "silk-weft-b.dat",
        ];
        let files: Vec<(&str, &str)> = names
            .iter()
            .copied()
            .zip(files.iter().map(String::as_str))
            .collect();
        let reading = read(&files, &KesOptions::default()).unwrap();
        for (direction, cloth) in Direction::ALL.into_iter().zip([&z, &z, &w, &w]) {
            expect(&reading, direction, cloth);
        }
    }
}

#[test]
fn one_trace_goes_out_and_back() {
    let (x, z) = (places(), cloth(3));
    let (there, back): (Vec<f64>, Vec<f64>) = (
        [x.clone(), turned(&x)].concat(),
        [z.clone(), turned(&z)].concat(),
    );
    let text = SPELLINGS[3].file(&["x", "height"], &[&there, &back]);
    let reading = read(&[("a.txt", &text)], &KesOptions::default()).unwrap();
    expect(&reading, Direction::WarpForward, &z);
    let stroke = reading.stroke(Direction::WarpReverse).unwrap();
    assert_eq!(stroke.heights_um.len(), N);
}

#[test]
fn five_columns_hold_a_whole_textile() {
    let (x, z, w) = (places(), cloth(1), cloth(2));
    let text = SPELLINGS[5].file(&[], &[&x, &z, &z, &w, &turned(&w)]);
    let reading = read(&[("a.txt", &text)], &KesOptions::default()).unwrap();
    for (direction, cloth) in Direction::ALL.into_iter().zip([&z, &z, &w, &w]) {
        expect(&reading, direction, cloth);
    }
}

#[test]
fn without_a_distance_the_step_is_asked_for_and_taken() {
    let z = cloth(4);
    let text = SPELLINGS[1].file(&[], &[&z]);
    let files = [("a.txt", text.as_str())];
    let error = read(&files, &KesOptions::default()).unwrap_err();
    assert!(
        error.contains("no column of distance; say --step-mm"),
        "{error}"
    );
    let by_rate = KesOptions {
        speed_mm_per_s: Some(1.0),
        rate_hz: Some(50.0),
        ..KesOptions::default()
    };
    expect(&read(&files, &by_rate).unwrap(), Direction::WarpForward, &z);
    let by_step = KesOptions {
        step_mm: Some(STEP_MM),
        ..KesOptions::default()
    };
    expect(&read(&files, &by_step).unwrap(), Direction::WarpForward, &z);
    let times: Vec<f64> = (0..N).map(|i| i as f64 * 0.01).collect();
    let text = SPELLINGS[0].file(&["time s", "height um"], &[&times, &z]);
    let files = [("a.txt", text.as_str())];
    let error = read(&files, &KesOptions::default()).unwrap_err();
    assert!(error.contains("say --speed-mm-per-s"), "{error}");
    let at_speed = KesOptions {
        speed_mm_per_s: Some(2.0),
        ..KesOptions::default()
    };
    expect(
        &read(&files, &at_speed).unwrap(),
        Direction::WarpForward,
        &z,
    );
}

#[test]
fn volts_take_a_sensitivity() {
    let (x, z) = (places(), cloth(5));
    let volts: Vec<f64> = z
        .iter()
        .map(|height| (height * 50.0).round() / 100.0)
        .collect();
    for header in ["x mm\tsignal V", "x mm\troughness (volts)"] {
        let body = SPELLINGS[5].file(&[], &[&x, &volts]).replace("  ", "\t");
        let text = format!("{header}\n{body}");
        let files = [("a.txt", text.as_str())];
        let error = read(&files, &KesOptions::default()).unwrap_err();
        assert!(
            error.contains("heights in volts; say --um-per-volt"),
            "{error}"
        );
        let options = KesOptions {
            um_per_volt: Some(2.0),
            ..KesOptions::default()
        };
        let reading = read(&files, &options).unwrap();
        let expected: Vec<f64> = volts.iter().map(|volts| 2.0 * volts).collect();
        expect_alike(&reading.strokes[0].heights_um, &expected);
    }
}

#[test]
fn what_files_do_not_say_is_asked_for() {
    let x = places();
    let sine: Vec<f64> = x.iter().map(|x| 9.0 * (2.0 * PI * x).sin()).collect();
    let plain = SPELLINGS[0];
    let both = plain.file(&["x", "forward", "back"], &[&x, &sine, &sine]);
    let one = plain.file(&["x", "height"], &[&x, &sine]);
    let um: Vec<f64> = x.iter().map(|x| x * 1e3).collect();
    let in_um = plain.file(&["x", "height"], &[&um, &sine]);
    let six = plain.file(&["a", "b", "c", "d", "e", "f"], &[&x, &x, &x, &x, &x, &x]);
    let wide: Vec<f64> = sine.iter().map(|z| z * 1e4).collect();
    let wide = plain.file(&["x", "height"], &[&x, &wide]);
    for (files, expected) in [
        (vec![("a.txt", &both)], "say --return-order"),
        (vec![("a.txt", &one), ("b.txt", &one)], "say --direction"),
        (vec![("weft.txt", &one)], "no stroke along the warp"),
        (
            vec![("warp1.txt", &one), ("warp2.txt", &one)],
            "a second stroke warp forward",
        ),
        (
            vec![("a.txt", &in_um)],
            "the step is 20 mm, not 0.0005 to 0.5; say --x-unit",
        ),
        (vec![("a.txt", &six)], "say --columns"),
        (
            vec![("a.txt", &wide)],
            "more than any cloth; say --height-unit",
        ),
    ] {
        let files: Vec<(&str, &str)> = files
            .iter()
            .map(|(name, text)| (*name, text.as_str()))
            .collect();
        let error = read(&files, &KesOptions::default()).unwrap_err();
        assert!(error.contains(expected), "{error}");
    }
    let in_um_said = KesOptions {
        x_unit: Some(LengthUnit::Micrometre),
        ..KesOptions::default()
    };
    assert!(
        read(&[("a.txt", &in_um)], &in_um_said).is_ok(),
        "said in µm"
    );
}

#[test]
fn what_is_no_export_is_refused_by_line() {
    let rows = |rows: &str| format!("x\theight\n{rows}");
    let row = |i: i32| format!("{:.2}\t{}\n", f64::from(i) * 0.02, i % 7);
    let good: String = (0..300).map(row).collect();
    let lines: Vec<&str> = good.split_inclusive('\n').collect();
    for (text, expected) in [
        (String::new(), "a.txt:1: this file is empty"),
        (
            "no numbers here\nat all\n".to_owned(),
            "a.txt:1: no table of numbers",
        ),
        ("\u{0}\u{1}\u{2}".to_owned(), "a.txt:1: this is not text"),
        (
            rows(&good.replace("0.40\t", "0.38\t")),
            "a.txt:22: x is 0.38 twice",
        ),
        (
            rows(&good.replace("0.40\t6", "0.40\tNaN")),
            "a.txt:22: \"0.40",
        ),
        (
            rows(&good.replace("0.40\t", "0.405\t")),
            "a.txt:22: x goes on by 0.025 mm",
        ),
        (
            rows(&lines[..80].concat()),
            "a.txt: 80 samples where one window takes 217",
        ),
        (
            format!("{}end of file\n", rows(&good)),
            "a.txt:302: \"end of file\"",
        ),
    ] {
        let error = read(&[("a.txt", &text)], &KesOptions::default()).unwrap_err();
        assert!(error.starts_with(expected), "{error}, not {expected}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn any_spelling_of_any_stroke_reads_back(
        which in 0..SPELLINGS.len(),
        seed in 0_u64..1000,
        n in 320_usize..700,
        first in 0_i32..500,
        layout in 0..4_usize,
    ) {
        let spelling = SPELLINGS[which];
        let z = &cloth(seed)[..n];
        let x: Vec<f64> = (0..n).map(|i| f64::from(first) * 0.1 + i as f64 * STEP_MM).collect();
        let back = turned(z);
        let (names, columns): (&[&str], Vec<&[f64]>) = match layout {
            0 => (&["x", "height"], vec![&x, z]),
            1 => (&["height"], vec![z]),
            2 => (&["x", "forward", "return"], vec![&x, z, &back]),
            _ => (&["forward", "return"], vec![z, &back]),
        };
        let text = spelling.file(names, &columns);
        let options = KesOptions {
            step_mm: (layout % 2 == 1).then_some(STEP_MM),
            return_order: Some(ReturnOrder::Travel),
            ..KesOptions::default()
        };
        let reading = read(&[("a.txt", &text)], &options);
        let reading = reading.map_err(TestCaseError::fail)?;
        prop_assert_eq!(reading.strokes.len(), if layout < 2 { 1 } else { 2 });
        expect_alike(&reading.strokes[0].heights_um, z);
    }
}
