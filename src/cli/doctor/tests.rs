//! What is said of machines that lack something, and that our own numbers are the stored ones.

use std::fs;
use std::path::Path;
use std::time::Duration;

use super::machine::{arrays_in, place, ports_of, punctuality, rule_among, stage_by};
use super::program::{CODES_HASH, codes_hash, display_as, sound_as};
use super::{Finding, State, n_wrong};
use selvedge_device::{ArrayProfile, BridgeError, PortEntry, ProfileFolder};
use selvedge_engine::SoundState;
use selvedge_scratch::ScratchFolder;
use selvedge_workbench::AppError;

fn assert_is(finding: &Finding, state: State, words: &str) {
    assert_eq!(finding.state, state, "{finding:?}");
    assert!(finding.what.contains(words), "{words}: {finding:?}");
}

#[test]
fn this_processor_makes_the_stored_drive_codes() {
    assert_eq!(codes_hash().unwrap(), CODES_HASH);
}

#[test]
fn a_machine_without_display_is_usable_and_one_with_a_broken_display_is_not() {
    let without = display_as(None, Err(AppError::NoDisplay));
    let no_gl = Err(AppError::NoGraphics("no GL".to_owned()));
    let broken = display_as(Some("DISPLAY"), no_gl);
    let wrong_name = display_as(Some("DISPLAY"), Err(AppError::NoDisplay));
    assert_is(&broken, State::Wrong, "OpenGL 2.1 or later");
    assert_is(&wrong_name, State::Wrong, "that DISPLAY names; correct it");
    assert_is(&without, State::Note, "set DISPLAY or WAYLAND_DISPLAY");
    assert_eq!(
        n_wrong(&[without, broken, wrong_name]),
        2,
        "the first is none"
    );
}

#[test]
fn ports_are_none_or_usable_or_say_who_may_use_them() {
    let port = |path: &str| PortEntry {
        path: path.to_owned(),
        description: "USB 2e8a:000a".to_owned(),
        usb: None,
    };
    let none = ports_of(Ok(Vec::new()), |_| Ok(()));
    assert_is(&none[0], State::Note, "the emulator, which needs none");
    let refuse = |path: &str| match path {
        "/dev/ttyACM0" => Ok(()),
        _ => Err(BridgeError::Open {
            port: path.to_owned(),
            reason: "no permission".to_owned(),
        }),
    };
    let found = ports_of(Ok(vec![port("/dev/ttyACM0"), port("/dev/ttyS0")]), refuse);
    assert_is(&found[0], State::Ok, "/dev/ttyACM0, USB 2e8a:000a");
    assert_is(&found[1], State::Wrong, "/dev/ttyS0");
    let unlisted = ports_of(Err(BridgeError::List("no sysfs".to_owned())), |_| Ok(()));
    assert_is(&unlisted[0], State::Wrong, "no sysfs");
}

#[test]
fn a_folder_that_is_not_there_yet_is_tried_where_it_will_be_made_and_left_alone() {
    let scratch = ScratchFolder::made("doctor");
    let path = scratch.join("not/yet");
    assert_is(&place("sessions", &path), State::Ok, "not/yet");
    assert_eq!(fs::read_dir(&*scratch).unwrap().count(), 0, "nothing stays");
    // Nobody writes there, not even root.
    let closed = place("sessions", Path::new("/proc/selvedge"));
    if cfg!(target_os = "linux") {
        assert_is(&closed, State::Wrong, "/proc cannot be written");
    }
    let rule = scratch.join("99-selvedge.rules");
    assert_is(&rule_among(&[&rule])[0], State::Note, "--udev-rule");
    fs::write(&rule, "").unwrap();
    assert_is(&rule_among(&[&rule])[0], State::Ok, "99-selvedge.rules");
}

#[test]
fn late_ticks_and_missing_sound_are_noted_with_a_mend() {
    let ms = Duration::from_millis;
    let good = punctuality(Duration::from_nanos(30), &mut [ms(2), ms(1), ms(0)]);
    assert_is(
        &good,
        State::Ok,
        "by 1.00 ms in the middle, 2.00 ms at most",
    );
    let late = punctuality(Duration::from_nanos(30), &mut [ms(0), ms(9)]);
    assert_is(&late, State::Note, "end other programs");
    let playing = SoundState::Playing {
        by: "aplay",
        latency: Some(ms(20)),
    };
    assert_is(&sound_as(playing), State::Ok, "by aplay, 20 ms late");
    let absent = sound_as(SoundState::Absent("no server".to_owned()));
    assert_is(&absent, State::Note, "none (no server): start PulseAudio");
    assert_is(
        &sound_as(SoundState::Opening),
        State::Note,
        "nothing answers",
    );
}

#[test]
fn profiles_and_the_operators_file_are_read_as_they_will_be() {
    let folder = ScratchFolder::made("doctor-own");
    let none = arrays_in(&folder.join("arrays"));
    assert_is(&none[0], State::Ok, "no profile of your own");
    let own = ArrayProfile {
        name: "bench-7".to_owned(),
        ..ArrayProfile::default()
    };
    ProfileFolder::new(&folder.join("arrays"))
        .write(&own)
        .unwrap();
    assert_is(&arrays_in(&folder.join("arrays"))[0], State::Ok, "bench-7");
    fs::write(folder.join("arrays/broken.toml"), "rows = \"six\"\n").unwrap();
    let found = arrays_in(&folder.join("arrays"));
    assert_is(&found[0], State::Ok, "bench-7");
    assert_is(&found[1], State::Wrong, "broken.toml");
    let stage = folder.join("stage.toml");
    assert_is(
        &stage_by(&stage),
        State::Ok,
        "not there; the stage never arms",
    );
    for (text, state, words) in [
        (
            "ceiling_percent = 20\n",
            State::Ok,
            "no PIN, so it never arms, at most 20 %",
        ),
        ("pin = \"271828\"\n", State::Ok, "a PIN, at most 50 %"),
        ("ceiling_percent = 80\n", State::Wrong, "give 1 to 50"),
        ("pin = \"12\"\n", State::Wrong, "6 digits or more"),
    ] {
        fs::write(&stage, text).unwrap();
        assert_is(&stage_by(&stage), state, words);
    }
}
