//! A case worked by hand, and what is said of the rest.

use crate::bench::on_finger::OnFinger;
use crate::bench::perceptual_level::PerceptualLevel;
use crate::tools::why::explanation::{Explanation, Output};
use crate::tools::why::text::{sheet, to_text};
use selvedge_device::{ArrayProfile, Coder, LinkScale};
use selvedge_foundation::geometry::{Frame, Point, Velocity};
use selvedge_render::array::ContactInspector;
use selvedge_render::scene::Pose;
use selvedge_render::{ContactorArray, PlacedLevel, PlacedSurface, RenderScene};
use selvedge_textile::surface::{Profile, Surface};
use selvedge_textile::tactile::{Filters, Tuning};

/// One textile of 50 mm whose warp is a sine of 10 µm and 1 mm and whose weft is flat; a display of
/// one contactor.
fn scene() -> RenderScene {
    let step_mm = 1.0 / 230.0;
    let sine = |i: u32| 10.0 * (f64::from(i) * step_mm * std::f64::consts::TAU).sin();
    let warp = Profile::new(step_mm, (0..4600).map(sine).collect()).unwrap();
    let flat = Profile::new(step_mm, vec![0.0; 4600]).unwrap();
    let surface = Surface::from_profiles([Some(warp), None, Some(flat), None], 0.0).unwrap();
    let textile = PlacedSurface {
        workspace_from_textile: Frame::default(),
        size_mm: [50.0, 50.0],
        manifest_gain_db: 1.0,
        scene_gain_db: -3.0,
        scene_band_gains_db: [0.0; 2],
        within_mm: None,
        level: PlacedLevel::Known(4.0),
        surface: std::sync::Arc::new(surface),
    };
    RenderScene {
        textiles: vec![textile],
        displays: vec![ContactorArray {
            offsets: vec![selvedge_foundation::geometry::Displacement::default()],
            rotation_deg: 0.0,
        }],
        filters: Filters::default(),
        tuning: Tuning {
            gain_db: 6.0,
            gain_40_db: 2.0,
            compression: 0.5,
            compression_reference_db: Some(0.0),
            ..Tuning::default()
        },
        library_reference_db: None,
    }
}

fn why(place: [f64; 2], velocity: [f64; 2]) -> Explanation {
    let pose = Pose {
        position: Point::new(place[0], place[1]),
        velocity: Velocity {
            x_mm_per_s: velocity[0],
            y_mm_per_s: velocity[1],
        },
        ..Pose::default()
    };
    let trace = ContactInspector::new(&scene()).trace(0, 0, &pose).unwrap();
    let output = Output::of(
        (&ArrayProfile::default(), 0),
        trace.amplitudes_um,
        (None, None),
        [OnFinger::ShownOnly; 2],
    );
    Explanation {
        contactor: 0,
        cell: Some((0, 0)),
        tick: 7,
        trace,
        known_db: None,
        textile: Some("1 Sine".to_owned()),
        on_finger: [OnFinger::ShownOnly; 2],
        perceptual_level: PerceptualLevel::default(),
        is_stylus: false,
        output,
    }
}

#[test]
fn a_case_worked_by_hand_reads_as_it_was_worked() {
    // 40 mm/s along the warp over 1 cycle/mm sounds at 40 Hz, three octaves below 320 Hz, where the
    // filter of two octaves passes 2^(−9/2); the power of a 10 µm sine is 50 µm². Gains:
    // 6 + 2 + 1 − 3 − ½·4 = 4 dB at 40 Hz and 2 dB at 320 Hz. The window blurs the line a little.
    let explained = why([10.2, 20.0], [40.0, 0.0]);
    let [low, high] = explained.bare_um();
    assert!((low / 10.0 - 1.0).abs() < 0.02, "{low} µm at 40 Hz");
    let passed = 2.0_f64.powf(-4.5);
    assert!((high / (10.0 * passed) - 1.0).abs() < 0.2, "{high} µm");
    let touch = explained.touch().unwrap();
    assert_eq!(touch.gains.map(|terms| terms.total_db()), [4.0, 2.0]);
    let factor = 10.0_f64.powf(4.0 / 20.0);
    let ratio = explained.trace.amplitudes_um[0] / low;
    assert!((ratio / factor - 1.0).abs() < 1e-12, "{ratio}");
    let text = to_text(&explained);
    for line in [
        "Contactor 0, row 0, column 0, tick 7 (40 Hz / 320 Hz)",
        "Position      10.2 / 20.0 mm",
        "Textile       1 Sine, at 10.2 / 20.0 mm",
        "Warp / weft   40.0 / 0.0 mm/s",
        "+ master      6.00 / 6.00 dB",
        "+ compression −2.00 / −2.00 dB",
        "= gain        4.00 / 2.00 dB",
        "Limits        50.0 / 50.0 µm, not met",
    ] {
        assert!(text.lines().any(|said| said == line), "{line}\n{text}");
    }
    assert!(text.contains("Warp forward  point 10, "), "{text}");
    assert!(
        !text.contains("Weft forward"),
        "nothing moves along the weft"
    );
    let expected = (65535.0 * explained.trace.amplitudes_um[0] / 50.0).round();
    assert_eq!(f64::from(explained.output.codes[0]), expected);
}

#[test]
fn what_it_feels_like_is_told_and_marked_as_a_model() {
    let mut explained = why([10.2, 20.0], [40.0, 0.0]);
    let amplitudes_um = explained.trace.amplitudes_um;
    explained.perceptual_level = PerceptualLevel::of(std::iter::once(amplitudes_um));
    // 10 µm and 4 dB are 24 dB re 1 µm; the threshold at 40 Hz is 8 dB, alone at 320 Hz 5.5 dB.
    let [low_db, high_db] = explained.perceptual_level.above_db(amplitudes_um);
    assert!((low_db - 16.0).abs() < 0.2, "{low_db} dB SL");
    assert!(high_db < low_db, "{high_db} dB SL");
    let text = to_text(&explained);
    assert!(
        text.contains("Sensation     15.9 / −9.7 dB SL (model)"),
        "{text}"
    );
    assert!(text.contains("dB SL (model)"), "{text}");
    assert!(text.contains("Display feels intensity "), "{text}");
    let csv = csv_of(&explained);
    assert!(csv.contains("\nsensation level by model,,,15.9"), "{csv}");
    assert!(to_text(&why([5.0, 5.0], [0.0, 0.0])).contains("silent / silent dB SL (model)"));
}

#[test]
fn outside_at_rest_and_silent_are_said() {
    assert!(to_text(&why([-5.0, 0.0], [40.0, 0.0])).contains("none: silent"));
    assert!(to_text(&why([5.0, 5.0], [0.0, 0.0])).contains("below 0.01 mm/s"));
    let mut held = why([5.0, 5.0], [40.0, 0.0]);
    let amplitudes = held.trace.amplitudes_um;
    held.output = Output::of(
        (&ArrayProfile::default(), 0),
        amplitudes,
        (Some(1.0), None),
        [OnFinger::Held, OnFinger::Felt],
    );
    held.on_finger = [OnFinger::Held, OnFinger::Felt];
    assert!(held.output.codes[0] == 0 && held.output.codes[1] > 0);
    assert!(to_text(&held).contains("held / sent"));
}

fn csv_of(explained: &Explanation) -> String {
    let path = std::path::Path::new("why.csv");
    let origin = crate::bench::export::origin::Origin::default();
    String::from_utf8(sheet(explained).to_csv(&origin.pairs(), path).unwrap()).unwrap()
}

#[test]
fn the_table_holds_every_bin_and_its_powers_add_up() {
    let explained = why([10.2, 20.0], [40.0, 0.0]);
    let csv = csv_of(&explained);
    assert_eq!(
        csv.lines()
            .filter(|line| line.starts_with("power,"))
            .count(),
        500
    );
    let sum: f64 = explained.energies().iter().map(|(_, taken)| taken[0]).sum();
    let [warp, weft] = explained.powers_um2();
    assert!((sum - warp[0] - weft[0]).abs() < 1e-9 * sum, "{sum}");
    assert!(
        csv.lines().all(|line| line.split(',').count() == 6),
        "six columns"
    );
}

#[test]
fn limits_that_hold_are_named() {
    let loud = Output::of(
        (&ArrayProfile::default(), 0),
        [80.0, 1.0],
        (Some(1.0), None),
        [OnFinger::Felt; 2],
    );
    assert!(loud.limiter.limited[0] && loud.is_sent, "{loud:?}");
    let mut explained = why([10.2, 20.0], [40.0, 0.0]);
    explained.output = loud;
    assert!(to_text(&explained).contains("40 Hz is capped"));
}

#[test]
fn the_limit_that_comes_first_is_shown_and_whose_it_is() {
    let profile = ArrayProfile {
        limit_um: [40.0, 20.0],
        ..ArrayProfile::default()
    };
    let mut explained = why([10.2, 20.0], [40.0, 0.0]);
    // Half of 50 µm at 40 Hz is the device's; at 320 Hz it would take more than the profile.
    let of_50_v = |comp_limit| LinkScale {
        comp_limit,
        fs_mv: 50_000,
    };
    let half = [32_768, 32_768];
    let described = Output::of(
        (&profile, 0),
        [30.0, 30.0],
        (Some(1.0), Some(of_50_v(half))),
        [OnFinger::Felt; 2],
    );
    assert_eq!(
        described.limits.map(|limit| limit.is_of_device),
        [true, false]
    );
    assert_eq!(described.limiter.by_device, [true, false]);
    assert_eq!(described.limiter.limited, [true, true]);
    explained.output = described;
    let text = to_text(&explained);
    assert!(
        text.contains("25.0 (device) / 20.0 µm, both are capped"),
        "{text}"
    );
    // What the device was asked for because of the profile is the profile's.
    let asked = Coder::new(&profile, 24).comp_limit(50_000);
    let described = Output::of(
        (&profile, 0),
        [60.0, 60.0],
        (Some(1.0), Some(of_50_v(asked))),
        [OnFinger::Felt; 2],
    );
    assert_eq!(described.limiter.by_device, [false, false]);
    assert_eq!(described.limits.map(|limit| limit.um), profile.limit_um);
}

#[test]
fn levels_that_were_not_measured_are_said_to_lie_from_where_to_where() {
    let mut explained = why([10.2, 20.0], [40.0, 0.0]);
    assert!(!to_text(&explained).contains("Known to"), "it was measured");
    explained.known_db = Some([[-6.0, 2.0], [-1.0, 4.0]]);
    let line = "Known to      −6.0 to +2.0 / −1.0 to +4.0 dB of that: heights from a picture";
    let text = to_text(&explained);
    assert!(text.lines().any(|said| said == line), "{text}");
}
