//! From document and snapshot to the views that panes draw: pure queries, and the words for what
//! the engine has to say.

use std::collections::BTreeMap;

use super::document::Document;
use super::view::{
    BridgePhase, BridgeView, Cloth, ClothPicture, Dot, LibraryDot, Live, SceneView, Source, Status,
};
use crate::bridge::{BridgeEvent, BridgeState, DisarmedBy, Target};
use crate::engine::{LinkView, Notice, Snapshot, SourceKind};
use crate::scene::{LoadedScene, Scene};
use crate::tactile::{Filters, Levels};

/// The scene as panes draw it.
pub(crate) fn scene_view(
    document: &Document,
    loaded: &LoadedScene,
    library: &[LibraryDot],
    pictures: &BTreeMap<String, ClothPicture>,
    reference_db: Option<f64>,
) -> SceneView {
    let scene = document.scene();
    let placed = scene.textiles.iter().zip(loaded.textiles());
    let cloths = placed.map(|(placed, textile)| Cloth {
        id: placed.id.clone(),
        label: placed.label.clone(),
        name: textile.manifest().name.clone(),
        workspace_from_textile: placed.workspace_from_textile(),
        size_mm: placed.size_mm,
        rotation_deg: placed.rotation_deg,
        is_muted: false,
        gain_db: placed.gain_db,
        picture: pictures.get(&placed.id).copied(),
    });
    SceneView {
        name: scene.name.clone(),
        path: document.path().cloned(),
        is_edited: document.is_edited(),
        size_mm: scene.size_mm,
        cloths: cloths.collect(),
        tuning: document.tuning(),
        default_tuning: document.default_tuning(),
        reference_db,
        filters: scene.filters,
        grid: scene
            .displays
            .first()
            .and_then(|display| display.geometry.grid()),
        library: library.to_vec(),
        undo: document.undo_name(),
        redo: document.redo_name(),
    }
}

/// The textiles of the scene's library that have a level: from the library's index where the
/// scene's filters are those that the index was made with, else the placed ones alone.
pub(crate) fn library_dots(loaded: &LoadedScene) -> Vec<LibraryDot> {
    let scene = loaded.scene();
    let is_placed = |id: &str| scene.textiles.iter().any(|placed| placed.id == id);
    let library = loaded.library();
    let index = library
        .index()
        .filter(|_| scene.filters == Filters::default());
    if let Some(index) = index {
        let dot = |entry: &crate::textile::IndexEntry| {
            let manifest = library.manifest(&entry.id).ok()?;
            Some(LibraryDot {
                name: manifest.name,
                mean_um: [entry.a40_um, entry.a320_um],
                gain_db: manifest.gain_db,
                level_db: entry.level_db()?,
                is_placed: is_placed(&entry.id),
            })
        };
        return index.textiles.iter().filter_map(dot).collect();
    }
    let mut seen = Vec::new();
    let mut dots = Vec::new();
    for textile in loaded.textiles() {
        if seen.contains(&textile.id()) {
            continue;
        }
        seen.push(textile.id());
        let levels = Levels::of(textile.surface(), &scene.filters);
        dots.extend(levels.level_db().map(|level_db| LibraryDot {
            name: textile.manifest().name.clone(),
            mean_um: levels.mean_um,
            gain_db: textile.manifest().gain_db,
            level_db,
            is_placed: true,
        }));
    }
    dots
}

/// The engine as panes draw it.
pub(crate) fn live_view(snapshot: &Snapshot, frame_interval_s: Option<f64>) -> Live {
    let contactors = snapshot
        .displays
        .first()
        .map_or(&[][..], |display| &display.contactors);
    let is_placed = snapshot.source != SourceKind::Pointer || snapshot.pointer.is_known;
    Live {
        tick: snapshot.tick,
        centre: is_placed.then_some(snapshot.pose.position),
        speed_mm_per_s: if snapshot.is_silent {
            0.0
        } else {
            snapshot.pose.velocity.speed_mm_per_s()
        },
        dots: contactors.iter().map(dot).collect(),
        is_stopped: snapshot.is_stopped,
        source: match snapshot.source {
            SourceKind::Pointer => Source::Pointer,
            SourceKind::Stroke => Source::Stroke {
                is_playing: snapshot.playback.is_playing,
            },
            SourceKind::Replay | SourceKind::Lines => Source::Other,
        },
        status: Status {
            method: snapshot.method.name(),
            tick_cost_s: (snapshot.clock.cost_ns > 0)
                .then_some(snapshot.clock.cost_ns as f64 * 1e-9),
            bound_db: snapshot.bound.level_db,
            missed: snapshot.clock.missed,
            late: snapshot.clock.late,
            felt_age_s: snapshot.pointer.felt_age.map(|age| age.as_secs_f64()),
        },
        bridge: snapshot
            .link
            .as_ref()
            .map(|link| bridge_view(link, frame_interval_s)),
    }
}

fn dot(contactor: &crate::engine::ContactorView) -> Dot {
    Dot {
        position: contactor.position,
        cloth: contactor.textile.map(usize::from),
        amplitude_um: contactor.amplitude_um.map(f64::from),
        is_limited: contactor.bite.any(),
        is_muted: false,
    }
}

fn bridge_view(link: &LinkView, frame_interval_s: Option<f64>) -> BridgeView {
    let (device, codes) = (link.counters.device, link.counters.codes);
    BridgeView {
        state: link.state.label(),
        phase: phase(link.state),
        depth: link.depth,
        frame_interval_s,
        stamp_to_write_s: Some(link.timings.stamp_to_write)
            .filter(|spread| spread.n > 0)
            .map(|spread| spread.p99.as_secs_f64()),
        gain: link
            .sent
            .filter(|_| link.state.takes_frames())
            .map(|sent| sent.gain),
        frames_sent: link.counters.frames_sent,
        troubles: vec![
            ("underruns", device.underrun),
            ("late", device.late),
            ("repeated", device.dup),
            ("garbled", device.bad + link.counters.bad_received),
            ("clipped", device.clipped),
            ("rejected", link.counters.frames_rejected),
            ("superseded", link.counters.frames_superseded),
            ("write time-outs", link.counters.write_timeouts),
            ("messages lost", link.counters.events_dropped),
            ("not finite", codes.non_finite),
        ],
    }
}

/// What a device is called: its path, or what it is.
pub(crate) fn device_name(target: &Target) -> String {
    match target {
        Target::Emulator => "Emulator".to_owned(),
        Target::Port(path) => path.display().to_string(),
    }
}

/// What may be done with a device in this state.
pub(crate) fn phase(state: BridgeState) -> BridgePhase {
    match state {
        BridgeState::Opening | BridgeState::Greeting | BridgeState::Configuring => {
            BridgePhase::Opening
        }
        BridgeState::Ready => BridgePhase::Ready,
        BridgeState::Arming
        | BridgeState::Armed
        | BridgeState::Streaming
        | BridgeState::Stopping => BridgePhase::Armed,
        BridgeState::Faulted | BridgeState::Refused | BridgeState::Lost => BridgePhase::Broken,
    }
}

/// The sentence for something that the user ought to know; `None` for what panes show anyway.
/// `device` is what the device is called.
pub(crate) fn words(notice: &Notice, device: &str) -> Option<String> {
    match notice {
        Notice::Bridge(event) => bridge_words(event, device),
        Notice::Refused(why) | Notice::RecordingEnded(why) => Some(capitalised(why)),
        Notice::GainIgnored(error) => Some(capitalised(&error.to_string())),
        Notice::DisplayChanged => Some(
            "This scene's display has another number of contactors: the device was let go; connect \
             it again"
                .to_owned(),
        ),
        Notice::Stopped | Notice::SourceEnded => None,
    }
}

fn bridge_words(event: &BridgeEvent, device: &str) -> Option<String> {
    match event {
        BridgeEvent::Refused(why) | BridgeEvent::Lost(why) => Some(format!("{device}: {why}")),
        BridgeEvent::Disarmed {
            by: DisarmedBy::Device,
            reason,
        } => Some(format!("{device} disarmed itself: {reason}")),
        BridgeEvent::Fault(fault) => Some(format!(
            "{device} reports fault {:#06x}; mend its cause, then connect again",
            fault.faults
        )),
        BridgeEvent::DepthRaised(depth) => Some(format!(
            "Frames came late: they are now sent {depth} ticks ahead, so everything is felt later"
        )),
        _ => None,
    }
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters
        .next()
        .map(|letter| letter.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

/// The interval between frames, by the device's own clock.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct IntervalMeter {
    last: Option<(u32, u32)>,
    interval_s: Option<f64>,
}

impl IntervalMeter {
    /// Takes in the device's last tick and its clock in µs (modulo 2³²).
    pub(crate) fn take(&mut self, status: Option<(u32, u32)>) -> Option<f64> {
        let before = std::mem::replace(&mut self.last, status);
        match (before, status) {
            (Some((tick0, us0)), Some((tick1, us1))) if tick1 != tick0 => {
                let n_ticks = f64::from(tick1.wrapping_sub(tick0));
                self.interval_s = Some(f64::from(us1.wrapping_sub(us0)) / (1e6 * n_ticks));
            }
            (_, None) => self.interval_s = None,
            _ => {}
        }
        self.interval_s
    }
}

/// The textiles whose scene gain differs between two scenes of the same textiles: place and gain.
pub(crate) fn changed_gains(before: &Scene, after: &Scene) -> Vec<(usize, f64)> {
    let pairs = before.textiles.iter().zip(&after.textiles).enumerate();
    pairs
        .filter(|(_, (old, new))| old.gain_db.total_cmp(&new.gain_db).is_ne())
        .map(|(index, (_, new))| (index, new.gain_db))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_is_the_devices_own_and_survives_its_clocks_wrap() {
        let mut meter = IntervalMeter::default();
        assert_eq!(meter.take(Some((10, u32::MAX - 9_999))), None);
        assert_eq!(meter.take(Some((12, 40_000))), Some(0.025));
        assert_eq!(
            meter.take(Some((12, 40_000))),
            Some(0.025),
            "no new tick, no new interval"
        );
        assert_eq!(meter.take(None), None);
    }

    #[test]
    fn every_state_that_may_move_the_device_shows_as_armed() {
        let states = [
            BridgeState::Opening,
            BridgeState::Ready,
            BridgeState::Arming,
            BridgeState::Armed,
            BridgeState::Streaming,
            BridgeState::Stopping,
            BridgeState::Faulted,
            BridgeState::Lost,
        ];
        for state in states {
            assert_eq!(
                phase(state) == BridgePhase::Armed,
                state.is_live(),
                "{state:?}"
            );
        }
    }

    #[test]
    fn notices_name_the_device() {
        let lost = Notice::Bridge(BridgeEvent::Lost(
            "no such port; check the cable".to_owned(),
        ));
        let sentence = words(&lost, "/dev/x");
        assert_eq!(
            sentence.as_deref(),
            Some("/dev/x: no such port; check the cable")
        );
        assert_eq!(words(&Notice::Stopped, "/dev/x"), None);
    }
}
