//! Drive codes: closed forms, limits, calibration and wiring.

use proptest::prelude::*;

use super::*;
use crate::array::{DeviceUid, Wiring};

fn coder() -> Coder {
    Coder::new(&ArrayProfile::default(), 1)
}

/// A device of the profile's own voltage with these limits.
fn of_50_v(comp_limit: [u16; 2]) -> LinkScale {
    LinkScale {
        comp_limit,
        fs_mv: 50_000,
    }
}

fn code(a40: f32, a320: f32) -> [u16; 2] {
    coder().encode(&[[a40, a320]], 1.0)[0]
}

#[test]
fn codes_follow_the_closed_form() {
    assert_eq!(code(0.0, 0.0), [0, 0]);
    assert_eq!(code(50.0, 0.0), [65535, 0]);
    assert_eq!(code(0.0, 50.0), [0, 65535]);
    assert_eq!(code(10.0, 20.0), [13107, 26214]);
    // 65535 · 0.000381… rounds half up at exactly one half: 25 µm is 32767.5.
    assert_eq!(code(25.0, 0.0), [32768, 0]);
    assert_eq!(coder().encode(&[[20.0, 10.0]], 0.05)[0], [1311, 655]);
}

#[test]
fn codes_are_volts_whatever_a_device_makes_of_full_code() {
    let on = |fs_mv| {
        let mut coder = coder();
        coder.set_link(Some(LinkScale {
            comp_limit: [65535; 2],
            fs_mv,
        }));
        coder.encode(&[[10.0, 20.0]], 1.0)[0]
    };
    assert_eq!(on(50_000), [13107, 26214]);
    assert_eq!(on(200_000), [3277, 6554], "a quarter of the codes, half up");
    assert_eq!(on(800_000), [819, 1638]);
    // A device of 200 V holds a limit of 16384 at 50 V, which is full scale.
    let mut coder = coder();
    coder.set_link(Some(LinkScale {
        comp_limit: [8192, 65535],
        fs_mv: 200_000,
    }));
    let codes = coder.encode(&[[50.0, 0.0]], 1.0)[0];
    assert_eq!(codes, [8192, 0]);
    assert_eq!(coder.comp_limit(200_000), [16384; 2]);
    let limit = coder.limits(0)[0];
    assert!((limit.um - 25.0).abs() < 1e-3 && limit.is_of_device);
    // Both bands at once: full drive is that of the profile.
    coder.set_link(Some(LinkScale {
        comp_limit: [65535; 2],
        fs_mv: 200_000,
    }));
    let [low, high] = coder.encode(&[[50.0, 50.0]], 1.0)[0];
    assert_eq!(low + high, 16384);
}

#[test]
fn two_halves_never_exceed_full_drive() {
    let mut coder = coder();
    assert_eq!(coder.encode(&[[25.0, 25.0]], 1.0)[0], [32768, 32767]);
    assert_eq!(coder.counters().guarded, 0, "exactly full is not too much");
    assert_eq!(coder.encode(&[[50.0, 50.0]], 1.0)[0], [32768, 32767]);
    assert_eq!(coder.counters().guarded, 1);
    assert!(coder.limited()[0].guarded);
}

#[test]
fn numbers_that_are_none_are_silent_and_counted() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0] {
        let mut coder = coder();
        assert_eq!(coder.encode(&[[bad, 10.0]], 1.0)[0], [0, 13107]);
        assert_eq!(coder.encode(&[[bad, bad]], 1.0)[0], [0, 0]);
        assert_eq!(coder.counters().non_finite, 3);
        assert!(coder.limited()[0].any());
    }
    assert_eq!(coder().encode(&[[10.0, 10.0]], f64::NAN)[0], [0, 0]);
    assert_eq!(coder().encode(&[[10.0, 0.0]], 7.0)[0], [13107, 0]);
}

#[test]
fn limits_are_counted_per_band_and_the_link_lowers_them() {
    let profile = ArrayProfile {
        limit_um: [5.0, 40.0],
        ..ArrayProfile::default()
    };
    let mut coder = Coder::new(&profile, 2);
    assert_eq!(
        coder.encode(&[[6.0, 6.0], [5.0, 0.0]], 1.0),
        [[6554, 7864], [6554, 0]]
    );
    assert_eq!(coder.counters().limited, [1, 0]);
    assert_eq!(coder.limited()[0].limited, [true, false]);
    assert!(!coder.limited()[1].any());
    for limit in [0, 1, 999, 32768, 65535] {
        coder.set_link(Some(of_50_v([65535, limit])));
        let expected = limit.min(52428);
        assert_eq!(coder.encode(&[[0.0, 50.0]], 1.0)[0], [0, expected]);
    }
}

#[test]
fn a_profile_that_makes_no_sense_is_silent() {
    for full_scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let profile = ArrayProfile {
            full_scale_um: [full_scale, 50.0],
            ..ArrayProfile::default()
        };
        assert_eq!(
            Coder::new(&profile, 1).encode(&[[10.0, 10.0]], 1.0)[0],
            [0, 13107]
        );
    }
}

#[test]
fn missing_amplitudes_are_silent() {
    let mut codes = [[7, 7]; 3];
    coder().encode_into(&[[50.0, 0.0]], 1.0, &mut codes);
    assert_eq!(codes, [[65535, 0], [0, 0], [0, 0]]);
}

proptest! {
    #[test]
    fn the_sum_never_exceeds_full_drive(
        a in any::<f32>(), b in any::<f32>(), g in any::<f64>(),
    ) {
        let [low, high] = coder().encode(&[[a, b]], g)[0];
        prop_assert!(u32::from(low) + u32::from(high) <= 65535);
    }

    #[test]
    fn more_amplitude_is_never_less_code(a in 0f32..60.0, more in 0f32..60.0, g in 0.0..1.0) {
        let [low, _] = coder().encode(&[[a, 0.0]], g)[0];
        let [high, _] = coder().encode(&[[a + more, 0.0]], g)[0];
        prop_assert!(low <= high);
    }

    #[test]
    fn sharing_full_drive_keeps_the_ratio(a in 25f32..50.0, b in 25f32..50.0) {
        let [low, high] = coder().encode(&[[a, b]], 1.0)[0];
        let share = f64::from(a) / (f64::from(a) + f64::from(b));
        prop_assert!((f64::from(low) - 65535.0 * share).abs() <= 0.5 + 1e-6);
        prop_assert!(u32::from(low) + u32::from(high) >= 65534);
    }
}

fn wired(channels: &[u16], calibration: &[Calibration]) -> ArrayProfile {
    ArrayProfile {
        rows: 1,
        cols: 3,
        calibration: calibration.to_vec(),
        wiring: Some(Wiring {
            device_uid: DeviceUid([7; 12]),
            channels: channels.to_vec(),
        }),
        ..ArrayProfile::default()
    }
}

fn gains(low: f64, high: f64) -> Calibration {
    Calibration {
        drive_gain: [low, high],
        is_off: false,
    }
}

const OFF: Calibration = Calibration {
    drive_gain: [1.0; 2],
    is_off: true,
};

#[test]
fn wiring_sends_each_contactors_codes_to_its_channel() {
    let mut coder = Coder::new(&wired(&[2, 0, 1], &[]), 3);
    let amplitudes_um = [[50.0, 0.0], [10.0, 20.0], [60.0, 0.0]];
    assert_eq!(
        coder.encode(&amplitudes_um, 1.0),
        [[13107, 26214], [65535, 0], [65535, 0]]
    );
    let limiters: Vec<bool> = coder
        .limited()
        .iter()
        .map(|limiter| limiter.any())
        .collect();
    assert_eq!(
        limiters,
        [false, false, true],
        "bites stay in contactor order"
    );
    for broken in [&[0, 1][..], &[0, 1, 1], &[0, 1, 3]] {
        let straight = Coder::new(&wired(broken, &[]), 3).encode(&amplitudes_um, 1.0);
        assert_eq!(
            straight,
            [[65535, 0], [13107, 26214], [65535, 0]],
            "{broken:?}"
        );
    }
}

#[test]
fn calibration_drives_weak_contactors_more_and_limits_hold_what_they_do() {
    let profile = ArrayProfile {
        limit_um: [20.0, 30.0],
        ..wired(&[0, 1, 2], &[gains(1.25, 0.5), OFF, gains(4.0, 1.0)])
    };
    let mut coder = Coder::new(&profile, 3);
    // 10 µm at a gain of 1.25 need the drive of 12.5 µm; 40 µm are held at 30, driven as 15.
    let codes = coder.encode(&[[10.0, 40.0], [10.0, 10.0], [20.0, 0.0]], 1.0);
    assert_eq!(codes, [[16384, 19661], [0, 0], [65535, 0]]);
    let limiters = coder.limited();
    assert_eq!(limiters[0].limited, [false, true]);
    assert!(limiters[1].off && limiters[1].any());
    assert!(limiters[2].guarded, "80 µm of drive share 50");
    assert_eq!((coder.counters().off, coder.counters().guarded), (1, 1));
    assert_eq!(
        coder.comp_limit(50_000),
        [65535, 39321],
        "the strongest drive that may be needed"
    );
    assert_eq!(coder.encode(&[[0.0; 2]; 3], 1.0), [[0; 2]; 3]);
    assert!(
        !coder.limited()[1].any(),
        "an off contactor that nothing is asked of"
    );
}

#[test]
fn the_devices_limit_holds_the_drive_and_the_profiles_the_contactor() {
    let profile = wired(
        &[0, 1, 2],
        &[gains(2.0, 2.0), gains(1.0, 1.0), gains(0.5, 0.5)],
    );
    let mut coder = Coder::new(&profile, 3);
    coder.set_link(Some(of_50_v([13107, 65535])));
    let codes = coder.encode(&[[10.0, 0.0], [10.0, 0.0], [10.0, 0.0]], 1.0);
    assert_eq!(codes, [[13107, 0], [13107, 0], [6554, 0]]);
    let limited: Vec<bool> = coder
        .limited()
        .iter()
        .map(|limiter| limiter.limited[0])
        .collect();
    assert_eq!(limited, [true, false, false]);
    let mut next = Coder::new(&ArrayProfile::default(), 3);
    next.go_on_from(&coder);
    assert_eq!(next.counters().limited, [1, 0]);
    assert_eq!(next.encode(&[[50.0, 0.0]], 1.0)[0], [13107, 0]);
}

#[test]
fn a_gain_that_makes_no_sense_switches_its_contactor_off() {
    for gain in [f64::NAN, 0.0, -1.0, 5.0, f64::INFINITY] {
        let profile = wired(
            &[0, 1, 2],
            &[gains(gain, 1.0), gains(1.0, 1.0), gains(1.0, 1.0)],
        );
        let codes = Coder::new(&profile, 3).encode(&[[10.0, 10.0]; 2], 1.0);
        assert_eq!(codes, [[0, 0], [13107, 13107]], "{gain}");
    }
}

#[test]
fn an_identified_channel_keeps_to_every_limit_and_knows_no_calibration() {
    let profile = ArrayProfile {
        limit_um: [50.0, 20.0],
        ..wired(&[2, 1, 0], &[gains(4.0, 4.0), OFF, gains(1.0, 1.0)])
    };
    let mut coder = Coder::new(&profile, 3);
    assert_eq!(coder.ident_code(10.0), 13107);
    assert_eq!(coder.ident_code(40.0), 26214);
    assert_eq!(coder.ident_code(f32::NAN), 0);
    coder.set_link(Some(of_50_v([0, 1000])));
    assert_eq!(coder.ident_code(40.0), 1000);
}

#[test]
fn one_contactor_is_explained_as_the_array_drives_it() {
    let profile = wired(&[1, 2, 0], &[gains(1.0, 1.0), gains(2.0, 0.5), OFF]);
    let amplitudes_um = [[3.0, 7.0], [11.0, 13.0], [5.0, 5.0]];
    let all = Coder::new(&profile, 3).encode(&amplitudes_um, 1.0);
    for (contactor, amplitude_um) in amplitudes_um.into_iter().enumerate() {
        let mut one = Coder::of_contactor(&profile, contactor);
        let channel = profile.channel_of(contactor);
        assert_eq!(one.encode(&[amplitude_um], 1.0), [all[channel]]);
    }
}

proptest! {
    #[test]
    fn calibration_of_one_and_straight_wiring_give_the_same_bytes(
        amplitudes in proptest::collection::vec(any::<[f32; 2]>(), 24),
        gain in 0.0..1.0,
        limit in any::<[u16; 2]>(),
        limit_um in [0.0..50.0, 0.0..50.0],
    ) {
        let plain = ArrayProfile { limit_um, ..ArrayProfile::default() };
        let spelt = ArrayProfile {
            calibration: vec![Calibration::default(); 24],
            wiring: Some(Wiring {
                device_uid: DeviceUid([0; 12]),
                channels: (0..24).collect(),
            }),
            ..plain.clone()
        };
        let [mut a, mut b] = [plain, spelt].map(|profile| Coder::new(&profile, 24));
        prop_assert_eq!(a.encode(&amplitudes, gain), b.encode(&amplitudes, gain));
        a.set_link(Some(of_50_v(limit)));
        b.set_link(Some(of_50_v(limit)));
        prop_assert_eq!(a.encode(&amplitudes, gain), b.encode(&amplitudes, gain));
        prop_assert_eq!(a.comp_limit(50_000), b.comp_limit(50_000));
        // The formula of one contactor, spelt out: what the program has always sent.
        for (pair, code) in amplitudes.iter().zip(a.encode(&amplitudes, gain)) {
            prop_assert_eq!(code, plainly(*pair, gain, limit_um, limit));
        }
    }
}

/// `a ← min(a·g, limit)`, shared full drive, `⌊65535·a/F + ½⌋`, the 320 Hz code lowered by one.
fn plainly(pair: [f32; 2], gain: f64, limit_um: [f64; 2], comp_limit: [u16; 2]) -> [u16; 2] {
    let full_um = 50.0;
    let band = |band: usize| {
        let a = f64::from(pair[band]);
        let link_um = f64::from(comp_limit[band]) * full_um / 65535.0;
        if a.is_finite() && a >= 0.0 {
            (a * gain).min(limit_um[band].min(link_um))
        } else {
            0.0
        }
    };
    let mut driven_um = [band(0), band(1)];
    let share = driven_um[0] / full_um + driven_um[1] / full_um;
    if share > 1.0 {
        driven_um = driven_um.map(|a| a / share);
    }
    let [low, high] = driven_um.map(|a| round_half_up(65535.0 * a / full_um));
    [low, high.min(FULL_CODE - low)]
}

#[test]
fn what_limits_leave_of_an_amplitude_is_what_its_code_stands_for() {
    let mut profile = ArrayProfile {
        limit_um: [30.0, 40.0],
        ..ArrayProfile::default()
    };
    let weak = Calibration {
        drive_gain: [1.25, 0.8],
        is_off: false,
    };
    profile.set_calibration(0, weak);
    profile.set_calibration(
        1,
        Calibration {
            is_off: true,
            ..weak
        },
    );
    let mut coder = Coder::new(&profile, 3);
    for asked in [[4.0, 9.0], [45.0, 1.0], [30.0, 40.0], [f32::NAN, 5.0]] {
        let codes = coder.encode(&[asked; 3], 1.0);
        assert_eq!(coder.limited_um(1, asked), [0.0; 2], "it is off");
        for (contactor, gains) in [(0, weak.drive_gain), (2, [1.0; 2])] {
            let left_um = coder.limited_um(contactor, asked);
            for band in 0..2 {
                let um = f64::from(codes[contactor][band]) / 65_535.0 * 50.0 / gains[band];
                assert!((um - f64::from(left_um[band])).abs() < 2e-3, "{left_um:?}");
            }
        }
    }
}
