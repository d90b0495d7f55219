//! Profiles: shape and places, what only lowers, and the file, read strictly.

use std::path::Path;

use super::*;

fn read(text: &str) -> Result<ArrayProfile, String> {
    ArrayProfile::from_toml(text, Path::new("a.toml")).map_err(|error| error.to_string())
}

/// A profile with everything in it that a file can hold.
fn rich() -> ArrayProfile {
    let mut profile = ArrayProfile {
        name: String::from("Rig 2, \"left\""),
        rows: 1,
        cols: 3,
        pitch_um: 0,
        contactors_mm: vec![[0.0, 0.5], [-1.25, 0.1 + 0.2], [3.0, -2.0]],
        full_scale_um: [48.7, 61.3],
        limit_um: [30.0, 0.1],
        full_scale_mv: 55_000,
        hv_dv: Some(555),
        i_ma_max: Some(20),
        temperature_c: Some([5.0, 45.5]),
        baud: 115_200,
        wiring: Some(Wiring {
            device_uid: DeviceUid([0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0xab, 0xff]),
            channels: vec![2, 0, 1],
        }),
        ..ArrayProfile::default()
    };
    let calibration = Calibration {
        drive_gain: [1.25, 0.9],
        is_off: true,
    };
    profile.set_calibration(1, calibration);
    profile
}

#[test]
fn shipped_profiles_are_the_arrays_that_scenes_name() {
    let exeter = ArrayProfile::shipped("exeter-24").unwrap();
    assert_eq!(exeter, ArrayProfile::default());
    for (name, n, pitch_um) in [
        ("exeter-24", 24, 2000),
        ("5x5", 25, 2000),
        ("10x10", 100, 1000),
    ] {
        let profile = ArrayProfile::shipped(name).unwrap();
        assert_eq!(profile.name, name);
        assert_eq!((profile.n_contactors(), profile.pitch_um), (n, pitch_um));
        let text = profile.to_toml().unwrap();
        assert_eq!(Some(text.as_str()), shipped::text(name), "as it is written");
    }
    assert_eq!(ArrayProfile::shipped("3x3"), None);
    let places = exeter.places_mm();
    assert_eq!(
        (places[0], places[4], places[23]),
        ([-3.0, 5.0], [-3.0, 3.0], [3.0, -5.0])
    );
}

#[test]
fn a_profile_survives_writing_and_reading() {
    for profile in [ArrayProfile::default(), rich()] {
        let text = profile.to_toml().unwrap();
        assert_eq!(read(&text), Ok(profile), "{text}");
    }
    let text = rich().to_toml().unwrap();
    assert!(
        text.contains("device_uid = \"00010203040506070809abff\""),
        "{text}"
    );
    assert!(text.contains("hv_v = 55.5"), "{text}");
}

/// What stands in the text of `rich`, what stands there instead, and what is said of it.
const WRONG: &[(&str, &str, &str)] = &[
    (
        "hold_ms = 60",
        "hold_ms = 60\ncolour = 3",
        "unknown field `colour`",
    ),
    ("hold_ms = 60", "hold_ms = 61", "hold and ramp take 101 ms"),
    ("hold_ms = 60", "hold_ms = 200", "hold_ms is 200"),
    ("[30.0, 0.1]", "[nan, 0.1]", "a limit of NaN µm"),
    (
        "[30.0, 0.1]",
        "[49.0, 0.1]",
        "a limit of 49 µm where full scale is 48.7 µm",
    ),
    ("[30.0, 0.1]", "[-1.0, 0.1]", "a limit of -1 µm"),
    ("[48.7, 61.3]", "[inf, 61.3]", "a full scale of inf µm"),
    ("[48.7, 61.3]", "[0.0, 61.3]", "a full scale of 0 µm"),
    (
        "channels = [2, 0, 1]",
        "channels = [2, 0, 0]",
        "contactors 1 and 2 are both on channel 0",
    ),
    (
        "channels = [2, 0, 1]",
        "channels = [2, 0, 3]",
        "contactor 2 is on channel 3",
    ),
    (
        "channels = [2, 0, 1]",
        "channels = [0, 1]",
        "2 channels for 3 contactors",
    ),
    ("09abff", "09abf", "is no device's number"),
    (
        "[1.0, 1.25, 1.0]",
        "[1.0, 5.0, 1.0]",
        "contactor 1 has a drive gain of 5",
    ),
    (
        "[1.0, 1.25, 1.0]",
        "[1.0, nan, 1.0]",
        "contactor 1 has a drive gain of NaN",
    ),
    (
        "[1.0, 1.25, 1.0]",
        "[1.0, 1.25]",
        "2 gains for 3 contactors",
    ),
    ("off = [1]", "off = [3]", "there is no contactor 3"),
    ("cols = 3", "cols = 2", "for 2 contactors"),
    ("cols = 3", "cols = 3\npitch_mm = 2.0", "both given"),
    ("hv_v = 55.5", "hv_v = 55.55", "hv_v is 55.55"),
    ("hv_v = 55.5", "hv_v = 501.0", "a high voltage of 501 V"),
    (
        "[3.0, -2.0]",
        "[0.0, 0.5]",
        "contactors 0 and 2 are at the same place",
    ),
    ("[3.0, -2.0]", "[inf, 0.5]", "contactor 2 is at"),
];

#[test]
fn what_is_wrong_is_named_with_its_line_and_a_mend() {
    let good = rich().to_toml().unwrap();
    assert!(read(&good).is_ok());
    for &(from, to, what) in WRONG {
        assert!(good.contains(from), "{from} in {good}");
        let text = good.replace(from, to);
        let error = read(&text).unwrap_err();
        assert!(error.contains(what), "{to}: {error}");
        let line = text
            .lines()
            .position(|line| line.contains(to.lines().last().unwrap()));
        let place = format!("a.toml:{}:", line.unwrap() + 1);
        let is_elsewhere = [
            "2 gains for 3",
            "for 2 contactors",
            "take 101 ms",
            "both given",
        ]
        .iter()
        .any(|late| what.contains(late));
        assert!(error.starts_with(&place) || is_elsewhere, "{to}: {error}");
    }
    let most = "name = \"a\"\nrows = 20\ncols = 20\npitch_mm = 1.0\nfull_scale_um = [50.0, 50.0]\n\
                limit_um = [50.0, 50.0]\nhold_ms = 60\nramp_ms = 40\nhv_v = 60.0\n";
    assert!(read(most).unwrap_err().contains("give 1 to 253 contactors"));
    assert!(read("").unwrap_err().starts_with("a.toml:1: "));
}

#[test]
fn what_only_lowers_is_told_from_what_may_raise() {
    let base = rich();
    let with = |change: fn(&mut ArrayProfile)| {
        let mut changed = rich();
        change(&mut changed);
        changed.only_lowers(&base)
    };
    assert!(with(|_| ()));
    assert!(with(|p| p.limit_um[0] = 20.0));
    assert!(with(|p| p.set_calibration(
        0,
        Calibration {
            drive_gain: [0.5, 1.0],
            is_off: false
        }
    )));
    assert!(with(|p| p.set_calibration(
        2,
        Calibration {
            drive_gain: [4.0, 4.0],
            is_off: true
        }
    )));
    assert!(!with(|p| p.limit_um = [20.0, 0.2]), "one lower, one higher");
    assert!(!with(|p| p.set_calibration(
        0,
        Calibration {
            drive_gain: [1.1, 1.0],
            is_off: false
        }
    )));
    assert!(
        !with(|p| p.set_calibration(1, Calibration::default())),
        "switched on"
    );
    assert!(!with(|p| p.wiring = None), "other channels");
    assert!(!with(|p| p.full_scale_um[0] = 60.0), "another scale");
    assert!(
        !with(|p| p.hv_dv = Some(500)),
        "the device must be asked anew"
    );
}

#[test]
fn another_device_than_the_one_that_was_measured_is_doubted() {
    let (profile, other) = (rich(), DeviceUid(*b"selvedge-emu"));
    let measured = profile.wiring.as_ref().unwrap().device_uid;
    assert_eq!(profile.wiring_doubt(measured), None);
    let words = profile.wiring_doubt(other).unwrap();
    assert!(words.contains("00010203040506070809abff"), "{words}");
    assert!(words.contains("73656c76656467652d656d75"), "{words}");
    assert_eq!(ArrayProfile::default().wiring_doubt(other), None);
    assert_eq!(DeviceUid::parse(&other.to_string()), Some(other));
    assert_eq!(DeviceUid::parse("ä"), None);
}
