//! From document and snapshot to the views that panes draw: pure queries, and the words for what
//! the engine has to say.

use std::sync::Arc;

use crate::bench::document::Document;
use crate::bench::library_levels::LibraryLevels;
use crate::bench::library_view::LibraryView;
use crate::bench::mute_solo::MuteSolo;
use crate::bench::notices::Until;
use crate::bench::on_finger::OnFinger;
use crate::bench::part::Part;
use crate::bench::perceptual_level::PerceptualLevel;
use crate::bench::selection::Selection;
use crate::bench::view::{
    BridgePhase, BridgeView, Cloth, Dot, EngineView, InputView, LinkTiming, Marks, OtherDisplay,
    PlayView, SceneView, Source, Status, Telemetry,
};
use selvedge_device::{BridgeEvent, BridgeState, Caps, DeviceUid, DisarmedBy, Target};
use selvedge_engine::{LinkView, Notice, PointerView, Snapshot, SourceKind};
use selvedge_textile::tactile::Band;

/// The scene as panes draw it. A textile that is not ready yet is drawn already.
pub(crate) fn scene_view(
    document: &Document,
    library_view: &LibraryView,
    levels: &LibraryLevels,
    selection: &Selection,
    reference_db: Option<f64>,
) -> SceneView {
    let scene = document.scene();
    let placed = scene.textiles.iter().enumerate();
    let cloths = placed.map(|(index, placed)| Cloth {
        id: placed.id.clone(),
        label: placed.label.clone(),
        name: library_view
            .item(&placed.id)
            .map_or_else(|| placed.id.clone(), |item| item.name.clone()),
        workspace_from_textile: placed.workspace_from_textile(),
        size_mm: placed.size_mm,
        rotation_deg: placed.rotation_deg,
        is_muted: !selection.mute_solo.is_felt(Part::Cloth(index)),
        gain_db: placed.gain_db,
        band_gains_db: Band::ALL.map(|band| placed.band_gain_db(band)),
        within_mm: placed.within_mm,
        picture: library_view.picture(&placed.id),
    });
    let display = scene.displays.get(selection.display);
    let display = display.or_else(|| scene.displays.first());
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
        grid: display.and_then(|display| display.geometry.grid()),
        library: levels.dots.clone(),
        library_is_stale: levels.is_stale,
        marks: Marks::default(),
        picked: Arc::default(),
    }
}

/// The contactors of a display as panes draw them, and what a finger on it gets as a whole.
fn dots(snapshot: &Snapshot, display: usize, mute_solo: &MuteSolo) -> (Vec<Dot>, OnFinger) {
    let on_finger = OnFinger::of_display(snapshot, display);
    let view = snapshot.displays.get(display);
    let contactors = view.iter().flat_map(|view| &view.contactors).enumerate();
    let dots = contactors.map(|(index, contactor)| {
        let parts = (display == 0).then_some(index);
        let of = |band| on_finger.of_band((parts, contactor), band, mute_solo);
        dot(contactor, Band::ALL.map(of))
    });
    (dots.collect(), on_finger)
}

/// The engine as panes draw it that look at this display.
pub(crate) fn live_view(
    snapshot: &Snapshot,
    frame_interval_s: Option<f64>,
    (display, mute_solo): (usize, &MuteSolo),
) -> EngineView {
    let n_displays = snapshot.displays.len();
    let display = display.min(n_displays.saturating_sub(1));
    let pose = (snapshot.displays.get(display)).map_or(snapshot.pose, |view| view.pose);
    let is_placed = snapshot.source != SourceKind::Pointer || snapshot.pointer.is_known;
    let play = play_view(snapshot);
    // All off silences a display that goes on moving; one that is held stands still.
    let goes_on = snapshot.source == SourceKind::Pointer || play.is_playing;
    let (felt, on_finger) = dots(snapshot, display, mute_solo);
    let others = (0..n_displays).filter(|other| *other != display && is_placed);
    let is_held = snapshot.is_silent && !(snapshot.is_stopped && goes_on);
    EngineView {
        tick: snapshot.tick,
        centre: is_placed.then_some(pose.position),
        pose,
        speed_mm_per_s: if is_held {
            0.0
        } else {
            pose.velocity.speed_mm_per_s()
        },
        perceptual_level: PerceptualLevel::of(felt.iter().map(|dot| dot.amplitude_um)),
        dots: felt,
        others: others
            .map(|display| OtherDisplay {
                display,
                dots: dots(snapshot, display, mute_solo).0,
            })
            .collect(),
        on_finger,
        is_stopped: snapshot.is_stopped,
        is_silent: snapshot.is_silent,
        play,
        turn_deg: snapshot.turn_deg,
        status: Status {
            method: snapshot.rendering.method.name(),
            tick_cost_s: (snapshot.clock.cost_ns > 0)
                .then_some(snapshot.clock.cost_ns as f64 * 1e-9),
            bound_db: snapshot.rendering.bound.level_db,
            missed: snapshot.clock.missed,
            late: snapshot.clock.late,
            felt_age_s: snapshot.pointer.felt_age.map(|age| age.as_secs_f64()),
        },
        reference_db: snapshot.rendering.compression_reference_db,
        input: input_view(&snapshot.pointer),
        sequence_step: snapshot.sequence_step,
        stylus: snapshot.stylus,
        is_cloth: snapshot.rendering.is_cloth,
        bridge: snapshot
            .link
            .as_ref()
            .map(|link| bridge_view(link, frame_interval_s)),
        second_bridge: snapshot
            .second_link
            .as_ref()
            .map(|link| bridge_view(link, None)),
    }
}

fn input_view(pointer: &PointerView) -> InputView {
    let samples = &pointer.samples;
    InputView {
        rate: pointer.rate,
        is_lifted: pointer.is_lifted,
        n_lost: samples.overflowed + samples.bad_lines + samples.lost_in_system,
    }
}

fn play_view(snapshot: &Snapshot) -> PlayView {
    PlayView {
        source: match snapshot.source {
            SourceKind::Pointer => Source::Pointer,
            SourceKind::Stroke => Source::Stroke,
            SourceKind::Replay => Source::Recording,
            SourceKind::Lines | SourceKind::Program => Source::Lines,
            SourceKind::Device => Source::Device,
        },
        is_playing: snapshot.playback.is_playing,
        does_loop: snapshot.playback.does_loop,
        tick: snapshot.playback.tick,
        n_ticks: snapshot.playback.n_ticks,
        is_recording: snapshot.recording.is_recording,
        n_recorded: snapshot.recording.n_ticks,
    }
}

fn dot(contactor: &selvedge_engine::ContactorView, on_finger: [OnFinger; 2]) -> Dot {
    Dot {
        position: contactor.position,
        cloth: contactor.textile.map(usize::from),
        amplitude_um: contactor.amplitude_um.map(f64::from),
        limiter: contactor.limiter,
        on_finger,
    }
}

fn bridge_view(link: &LinkView, frame_interval_s: Option<f64>) -> BridgeView {
    let (device, codes) = (link.counters.device, link.counters.codes);
    BridgeView {
        state: link.state.label(),
        phase: phase(link.state),
        uid: link.caps.map(|caps| DeviceUid(caps.uid)),
        scale: link.scale,
        can_identify: link
            .caps
            .is_some_and(|caps| caps.modes & Caps::MODE_IDENT != 0),
        depth: link.depth,
        frame_interval_s,
        status_to_frame_s: Some(link.timings.due_to_write)
            .filter(|spread| spread.n > 0)
            .map(|spread| [spread.p99, spread.max].map(|span| span.as_secs_f64())),
        stamp_to_write_s: Some(link.timings.stamp_to_write)
            .filter(|spread| spread.n > 0)
            .map(|spread| spread.p99.as_secs_f64()),
        gain: link
            .sent
            .filter(|_| link.state.takes_frames())
            .map(|sent| sent.gain),
        frames_sent: link.counters.frames_sent,
        telemetry: link.status.map(|status| Telemetry {
            high_v: f64::from(status.hv_dv) / 10.0,
            current_ma: status.i_ma,
            celsius: f64::from(status.temp_cdeg) / 100.0,
            codes: status.amp_sum,
            most_codes: link.predicted_sum,
        }),
        troubles: vec![
            ("underruns", device.underrun),
            ("late", device.late),
            ("repeated", device.dup),
            ("STATUS astray", link.counters.stray_status),
            ("garbled", device.bad + link.counters.bad_received),
            ("clipped", device.clipped),
            ("rejected", link.counters.frames_rejected),
            ("superseded", link.counters.frames_superseded),
            ("write time-outs", link.counters.write_timeouts),
            ("messages lost", link.counters.events_dropped),
            ("not finite", codes.non_finite),
        ],
        timing: LinkTiming {
            lead: Some(link.lead),
            clock: Some(link.clock),
            round_trip: link.timings.round_trip,
            frame_interval: link.timings.frame_interval,
            ..LinkTiming::default()
        },
    }
}

/// What a device is called: its path, or what it is.
pub(crate) fn device_name(target: &Target) -> String {
    match target {
        Target::Emulator => "Emulator".to_owned(),
        Target::FaultyEmulator(_) => "Emulator with faults".to_owned(),
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

/// The sentence for something that the user ought to know, and when it is over; `None` for what
/// panes show anyway. `device` is what the device is called.
pub(crate) fn words(notice: &Notice, device: &str) -> Option<(Until, String)> {
    match notice {
        Notice::Bridge(event) => bridge_words(event, device),
        Notice::SecondBridge(event) => bridge_words(event, "The second display’s device"),
        Notice::Refused(why) => Some((Until::Armed, capitalised(why))),
        Notice::RecordingEnded(why) => Some((Until::PutAway, capitalised(why))),
        Notice::GainIgnored(error) => Some((Until::PutAway, capitalised(&error.to_string()))),
        Notice::DisplayChanged => {
            let words = "A display of this scene has another number of contactors: its device was \
                         let go; connect it again";
            Some((Until::Ready, words.to_owned()))
        }
        Notice::Stopped | Notice::SourceEnded | Notice::ArrayWaits => None,
    }
}

/// How a device says why it disarmed itself, before the reason.
const BY_ITSELF: &str = "the device ";

fn bridge_words(event: &BridgeEvent, device: &str) -> Option<(Until, String)> {
    match event {
        BridgeEvent::Refused(why) | BridgeEvent::Lost(why) => {
            Some((Until::Ready, format!("{device}: {why}")))
        }
        BridgeEvent::OtherDevice(why) => Some((Until::PutAway, format!("{device}: {why}"))),
        BridgeEvent::Disarmed {
            by: DisarmedBy::Device,
            reason,
        } => {
            let sentence = match reason.strip_prefix(BY_ITSELF) {
                Some(did) => format!("{device} {did}"),
                None => format!("{device}: {reason}"),
            };
            Some((Until::Armed, sentence))
        }
        BridgeEvent::DepthRaised(depth) => Some((
            Until::InTime,
            format!(
                "Frames came late: they are now sent {depth} ticks ahead, so everything is felt \
                 more than 40 ms late"
            ),
        )),
        BridgeEvent::DepthLowered(depth) => Some((
            Until::Read,
            format!(
                "No frame came late for a minute: they are now sent {depth} {} ahead again",
                if *depth == 1 { "tick" } else { "ticks" }
            ),
        )),
        _ => None,
    }
}

pub(crate) fn capitalised(text: &str) -> String {
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
        let expected = "/dev/x: no such port; check the cable".to_owned();
        assert_eq!(sentence, Some((Until::Ready, expected)));
        assert_eq!(words(&Notice::Stopped, "/dev/x"), None);
        let disarmed = Notice::Bridge(BridgeEvent::Disarmed {
            by: DisarmedBy::Device,
            reason: "the device disarmed itself: no frame reached it in time".to_owned(),
        });
        let expected = "Emulator disarmed itself: no frame reached it in time".to_owned();
        let said_once = words(&disarmed, "Emulator");
        assert_eq!(said_once, Some((Until::Armed, expected)));
    }
}
