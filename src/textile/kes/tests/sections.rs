//! What is marked, which section is evaluated, and what becomes of it.

use std::f64::consts::PI;
use std::path::Path;

use super::*;
use crate::kes::section::EVALUATED_MM;
use crate::{Construction, Description, KesImport, Library};
use selvedge_scratch::ScratchFolder;

#[test]
fn run_in_turn_round_and_outliers_are_marked_and_stay() {
    let mut z = cloth(6);
    for (i, height) in z.iter_mut().enumerate() {
        let x_mm = i as f64 * STEP_MM;
        *height += 120.0 * (-x_mm / 0.7).exp();
        if x_mm > 28.0 {
            *height = 0.1;
        }
    }
    z[700] += 90.0;
    let text = SPELLINGS[0].file(&["x", "height"], &[&places(), &z]);
    let reading = read(&[("a.txt", &text)], &KesOptions::default()).unwrap();
    let marks = &reading.strokes[0].marks;
    let of = |kind| {
        marks
            .iter()
            .filter(move |mark| mark.kind == kind)
            .collect::<Vec<_>>()
    };
    let [run_in] = of(MarkKind::RunIn)[..] else {
        panic!("{marks:?}")
    };
    assert!((50..=200).contains(&run_in.samples.end), "{marks:?}");
    let [turn] = of(MarkKind::TurnRound)[..] else {
        panic!("{marks:?}")
    };
    assert!(
        (1350..=1400).contains(&turn.samples.start) && turn.samples.end == N,
        "{marks:?}"
    );
    let outliers = of(MarkKind::Outlier);
    assert!(
        outliers.iter().any(|mark| mark.samples == (700..701)),
        "{marks:?}"
    );
    assert!(
        outliers
            .iter()
            .map(|mark| mark.samples.len())
            .sum::<usize>()
            < 12,
        "{marks:?}"
    );
    let import = KesImport::new(reading, [None, None], false).unwrap();
    let section = *import.section(TextileAxis::Warp).unwrap();
    assert!(
        section.from_mm >= 1.0 && section.to_mm <= 28.05,
        "{section:?}"
    );
    assert!(
        (section.to_mm - section.from_mm - EVALUATED_MM).abs() < 1e-9,
        "{section:?}"
    );
}

#[test]
fn the_suggested_section_is_where_the_cloth_is_steady() {
    let z: Vec<f64> = places()
        .iter()
        .map(|x| if *x < 7.0 { 14.0 } else { 6.0 } * (2.0 * PI * 2.0 * x).sin())
        .collect();
    let text = SPELLINGS[0].file(&["x", "height"], &[&places(), &z]);
    let reading = read(&[("a.txt", &text)], &KesOptions::default()).unwrap();
    let import = KesImport::new(reading, [None, None], false).unwrap();
    let section = import.section(TextileAxis::Warp).unwrap();
    assert!(section.from_mm >= 6.9, "{section:?}");
    let [(_, smd_um)] = import.figures().smd_um[..] else {
        panic!("one stroke")
    };
    assert!((smd_um - 6.0 * 2.0 / PI).abs() < 0.15, "{smd_um}");
}

#[test]
fn a_said_section_is_the_same_cloth_both_ways() {
    let (x, z) = (places(), cloth(7));
    let text = SPELLINGS[0].file(&["x", "forward", "return"], &[&x, &z, &z]);
    let reading = read(&[("a.txt", &text)], &KesOptions::default()).unwrap();
    let import = KesImport::new(reading.clone(), [Some([4.0, 24.0]), None], true).unwrap();
    let [forward, back] = &import.reading().strokes[..] else {
        panic!("two strokes")
    };
    let (there, again) = (import.samples(forward), import.samples(back));
    let there = &forward.heights_um[there];
    let again = turned(&back.heights_um[again]);
    assert_eq!(there.len(), 1000);
    assert!(
        there.iter().zip(&again).all(|(a, b)| (a - b).abs() < 1e-9),
        "the same cloth"
    );
    let figures = import.figures();
    let (all, official) = (figures.smd_um[0].1, figures.smd_official_um[0].1);
    assert!(
        official < all && official > 0.5 * all,
        "{official} of {all}"
    );
    for said in [
        [-1.0, 19.0],
        [15.0, 35.0],
        [4.0, 6.0],
        [24.0, 4.0],
        [f64::NAN, 24.0],
    ] {
        let error = KesImport::new(reading.clone(), [Some(said), None], false);
        let error = error.unwrap_err().to_string();
        assert!(error.contains("say --section FROM,TO"), "{error}");
    }
}

#[test]
fn an_import_becomes_a_textile_with_its_friction_and_origin() {
    let (x, z) = (places(), cloth(8));
    let text = SPELLINGS[3].file(&["x", "forward", "return"], &[&x, &z, &z]);
    let mu: Vec<f64> = x
        .iter()
        .map(|x| 0.2 + 0.05 * (2.0 * PI * x).sin())
        .collect();
    let friction = SPELLINGS[3].file(&["x", "mu"], &[&x, &mu]);
    let file = |name, text: &'static str| KesFile {
        path: Path::new(name),
        bytes: text.as_bytes(),
    };
    let (text, friction): (&'static str, &'static str) = (text.leak(), friction.leak());
    let friction = Some(file("mu.txt", friction));
    let reading = KesReading::of(&[file("a.txt", text)], friction, &KesOptions::default()).unwrap();
    let import = KesImport::new(reading, [None, None], false).unwrap();
    let words = Description {
        construction: Construction::Woven,
        fibre: "cotton".to_owned(),
        ..Description::of("Twill")
    };
    let folder = ScratchFolder::new("kes");
    crate::write(&import.files(&words).unwrap(), &folder.join("twill")).unwrap();
    let textile = Library::open(&folder).unwrap().load("twill").unwrap();
    drop(folder);
    let trace = textile.friction();
    assert!(
        trace.is_err(),
        "friction is read when it is asked for, and the file is gone"
    );
    let smd_um = textile.surface().smd_um();
    let each = import.figures().smd_um.iter().map(|(_, um)| um);
    let mean_um = each.sum::<f64>() / import.figures().smd_um.len() as f64;
    assert!((smd_um - mean_um).abs() < 1e-3, "{smd_um}");
    let measured = &textile.manifest().measured;
    assert!((measured["miu"] - 0.2).abs() < 2e-3, "{measured:?}");
    assert!((measured["mmd"] - 0.1 / PI).abs() < 2e-3, "{measured:?}");
    let crate::Source::Profiles(profiles) = &textile.manifest().source else {
        panic!("profiles")
    };
    let origin = profiles.imported.as_ref().unwrap();
    assert_eq!(origin.files, ["a.txt", "mu.txt"]);
    assert_eq!(origin.tilt_um_per_mm.len(), 2);
    let svg = import.figure("Twill").to_svg().unwrap();
    assert!(
        svg.contains("warp reverse: SMD") && svg.contains("friction: MIU"),
        "the picture"
    );
}

#[test]
fn a_run_in_does_not_tilt_the_cloth() {
    let mut z: Vec<f64> = places()
        .iter()
        .map(|x| 5.0 * (9.0 * x).sin() + 0.9 * x)
        .collect();
    for (i, height) in z.iter_mut().enumerate() {
        *height += 90.0 * (-(i as f64) * STEP_MM / 0.6).exp();
    }
    let text = SPELLINGS[0].file(&["x", "height"], &[&places(), &z]);
    let reading = read(&[("a.txt", &text)], &KesOptions::default()).unwrap();
    let tilt = reading.strokes[0].tilt_um_per_mm;
    assert!((tilt - 0.9).abs() < 0.1, "{tilt}");
}
