//! Files of MPEG haptics, read by a reader of our own that insists on every required field.

use serde::Deserialize;

use super::*;
use selvedge_foundation::files::from_json_str;
use selvedge_foundation::progress::{CancelFlag, Progress};
use selvedge_scratch::ScratchFolder;

/// Required fields, as the reference parser of the format has them; none is optional here.
#[derive(Deserialize)]
struct Experience {
    version: String,
    profile: String,
    level: u32,
    date: String,
    description: String,
    timescale: u32,
    perceptions: Vec<Perception>,
    avatars: Vec<Avatar>,
    syncs: Vec<Sync>,
}

#[derive(Deserialize)]
struct Avatar {
    id: i32,
    lod: i32,
    r#type: String,
}

#[derive(Deserialize)]
struct Sync {}

#[derive(Deserialize)]
#[expect(clippy::struct_field_names, reason = "the format's own names")]
struct Perception {
    id: i32,
    avatar_id: i32,
    description: String,
    perception_modality: String,
    reference_devices: Vec<Sync>,
    effect_library: Vec<Sync>,
    channels: Vec<Channel>,
}

#[derive(Deserialize)]
struct Channel {
    id: i32,
    description: String,
    gain: f64,
    mixing_coefficient: f64,
    body_part_mask: u32,
    bands: Vec<ReadBand>,
}

#[derive(Deserialize)]
struct ReadBand {
    band_type: String,
    lower_frequency_limit: i32,
    upper_frequency_limit: i32,
    effects: Vec<Effect>,
}

#[derive(Deserialize)]
#[expect(clippy::struct_field_names, reason = "the format's own names")]
struct Effect {
    effect_type: String,
    position: i32,
    phase: f64,
    base_signal: String,
    keyframes: Vec<Keyframe>,
}

#[derive(Deserialize)]
struct Keyframe {
    relative_position: i32,
    amplitude_modulation: f64,
    frequency_modulation: i32,
}

fn spec(n_channels: usize) -> HjifSpec {
    HjifSpec {
        n_channels,
        full_scale_um: [50.0, 25.0],
        title: "A \"scene\"\n".to_owned(),
    }
}

fn written(name: &str, n_channels: usize, ticks: &[Vec<[f32; 2]>]) -> Experience {
    let folder = ScratchFolder::made(name);
    let path = folder.join("a.hjif");
    let mut writer = HjifWriter::create(&path, spec(n_channels)).unwrap();
    for tick in ticks {
        writer.take(tick).unwrap();
    }
    Progress::unheard(|progress| writer.finish(progress)).unwrap();
    let text = folder.read("a.hjif");
    check(from_json_str(&text, &path).unwrap())
}

/// What a reader may rely on, whatever was written.
fn check(read: Experience) -> Experience {
    assert_eq!(
        (read.version.as_str(), read.profile.as_str()),
        ("2023", "Main")
    );
    assert_eq!((read.timescale, read.date.len()), (1000, 10));
    assert!(
        read.description.starts_with("A \"scene\" "),
        "{}",
        read.description
    );
    assert!(read.syncs.is_empty(), "nothing to be in step with");
    let [avatar] = &read.avatars[..] else {
        panic!("one avatar");
    };
    assert_eq!((avatar.lod, avatar.r#type.as_str()), (0, "Vibration"));
    let [perception] = &read.perceptions[..] else {
        panic!("one perception");
    };
    assert_eq!((perception.id, perception.avatar_id), (1, avatar.id));
    assert!(
        perception.description.contains("50 um"),
        "the scale is told"
    );
    assert_eq!(perception.perception_modality, "Vibrotactile");
    assert!(perception.reference_devices.is_empty() && perception.effect_library.is_empty());
    let n_channels = perception.channels.len();
    assert_eq!(read.level, if n_channels > 128 { 2 } else { 1 });
    for (number, channel) in perception.channels.iter().enumerate() {
        assert_eq!(usize::try_from(channel.id).unwrap(), number);
        assert_eq!(channel.description, format!("contactor {number}"));
        assert_eq!(
            (channel.mixing_coefficient, channel.body_part_mask),
            (1.0, 0)
        );
        assert_eq!(channel.bands.len(), 2);
        for (band, carrier_hz) in channel.bands.iter().zip([40, 320]) {
            assert_eq!(band.band_type, "VectorialWave");
            let limits = band.lower_frequency_limit..band.upper_frequency_limit;
            assert!(limits.contains(&carrier_hz), "{limits:?}");
            let [effect] = &band.effects[..] else {
                panic!("one effect");
            };
            assert_eq!((effect.effect_type.as_str(), effect.position), ("Basis", 0));
            assert_eq!((effect.base_signal.as_str(), effect.phase), ("Sine", 0.0));
            for (n, keyframe) in effect.keyframes.iter().enumerate() {
                assert_eq!(usize::try_from(keyframe.relative_position).unwrap(), 25 * n);
                assert_eq!(keyframe.frequency_modulation, carrier_hz);
                let share = keyframe.amplitude_modulation;
                assert!((0.0..=1.0).contains(&share), "{share}");
            }
        }
    }
    read
}

fn amplitude_um(read: &Experience, [channel, band, tick]: [usize; 3]) -> f64 {
    let channel = &read.perceptions[0].channels[channel];
    let keyframe = &channel.bands[band].effects[0].keyframes[tick];
    keyframe.amplitude_modulation * channel.gain * spec(0).full_scale_um[band]
}

#[test]
fn every_amplitude_of_all_contactors_comes_back() {
    let of = |tick: u16, contactor: u16| [f32::from(tick % 40) / 7.0, f32::from(contactor) / 3.0];
    // More than a block of the spool.
    let ticks: Vec<Vec<[f32; 2]>> = (0..1030)
        .map(|tick| (0..8).map(|contactor| of(tick, contactor)).collect())
        .collect();
    let read = written("full", 8, &ticks);
    assert_eq!(read.perceptions[0].channels.len(), 8);
    for (tick, contactor) in [(0, 0), (1023, 3), (1024, 6), (1029, 7)] {
        let expected = of(tick, contactor);
        let at = |band| [usize::from(contactor), band, usize::from(tick)];
        for (band, expected) in expected.into_iter().enumerate() {
            let found = amplitude_um(&read, at(band));
            assert!((found - f64::from(expected)).abs() < 1e-5, "{found}");
        }
    }
    let keyframes = &read.perceptions[0].channels[0].bands[0].effects[0].keyframes;
    assert_eq!(keyframes.len(), 1031, "the last amplitude lasts a tick");
}

#[test]
fn the_gain_makes_room_for_what_is_louder_than_full_scale() {
    let read = written("loud", 1, &[vec![[20.0, 100.0]], vec![[0.0, 1.0]]]);
    assert_eq!(read.perceptions[0].channels[0].gain, 4.0);
    assert!((amplitude_um(&read, [0, 1, 0]) - 100.0).abs() < 1e-4);
    assert!((amplitude_um(&read, [0, 0, 0]) - 20.0).abs() < 1e-4);
}

#[test]
fn numbers_that_are_none_are_silent() {
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0];
    let ticks: Vec<Vec<[f32; 2]>> = bad.iter().map(|um| vec![[*um, *um]]).collect();
    let read = written("bad", 2, &ticks);
    for tick in 0..4 {
        for channel in 0..2 {
            assert_eq!(amplitude_um(&read, [channel, 0, tick]), 0.0);
        }
    }
    written("level", 130, &[vec![[1.0, 1.0]]]);
    written("none", 3, &[]);
}

#[test]
fn a_file_that_is_stopped_is_not_there() {
    let folder = ScratchFolder::made("stopped");
    let path = folder.join("a.hjif");
    let mut writer = HjifWriter::create(&path, spec(2)).unwrap();
    writer.take(&[[1.0, 1.0]; 2]).unwrap();
    let flag = CancelFlag::new();
    flag.cancel();
    let stopped = writer.finish(&mut Progress::new(&mut |_, _| {}, flag));
    assert!(
        matches!(stopped, Err(SinkError::Cancelled(_))),
        "{stopped:?}"
    );
    assert!(!path.exists());
}
