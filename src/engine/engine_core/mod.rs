//! The work of a tick, without thread, clock or device: position in, amplitudes out.
//!
//! It is told what time it is, so that a test, a picture or a benchmark may drive it as it likes.

mod motion;
mod obey;
mod stylus;

use std::time::{Duration, Instant};

use stylus::FeltStylus;

use super::fingers::{self, Fingers};
use super::input::{
    Control, InputLosses, LiveInput, PointerInput, PointerSender, Reading, live_ring, playable,
};
use super::ready::Retired;
use super::recording::{LinkTally, RecordedTick, Recorder};
use super::sequence::Sequence;
use super::track::Track;
use super::{
    ClothDrive, EngineError, InputRate, InputSource, Notice, Playback, Played, PreparedScene,
    RecordingView, RenderingView, Snapshot, SourceKind, VelocityMethod,
};
use selvedge_device::{Coder, LinkScale, SentFrame};
use selvedge_render::scene::Pose;

/// From a command's refusal to the window: every tick has at most a few.
type Say<'a> = &'a mut dyn FnMut(Notice);

/// What is felt in place of the array on the scene.
#[derive(Debug, Default)]
struct InPlace {
    stylus: FeltStylus,
    cloth: Option<Box<ClothDrive>>,
}

/// Position in, amplitudes out, one tick at a time.
#[derive(Debug)]
pub struct EngineCore {
    scene: Box<PreparedScene>,
    tick: u64,
    pose: Pose,
    /// The pose that was rendered last: at rest where the pointer's own motion is not felt.
    rendered: Pose,
    live: LiveInput,
    playable: Option<Box<dyn PointerInput>>,
    track: Track,
    fingers: Fingers,
    angle_deg: f64,
    last_angle_deg: Option<f64>,
    is_stopped: bool,
    is_held: bool,
    /// Whether the coming tick, and the last one, only show where a held source was put to.
    is_sought: [bool; 2],
    has_ended: bool,
    recorder: Option<Box<Recorder>>,
    ignored: u64,
    /// Which contactors of the first display are felt; those beyond its end are.
    mask: Vec<bool>,
    /// What is felt in place of the whole scene.
    sequence: Sequence,
    in_place: InPlace,
    revision: u64,
}

impl EngineCore {
    /// A core that feels this scene, and the end of the ring for live samples.
    pub fn new(scene: Box<PreparedScene>) -> (Self, PointerSender) {
        let (sender, live) = live_ring();
        let pose = Pose {
            position: scene.start(),
            ..Pose::default()
        };
        let mut core = Self {
            scene,
            tick: 0,
            pose,
            rendered: pose,
            live,
            playable: None,
            track: Track::new(VelocityMethod::default()),
            fingers: Fingers::new(VelocityMethod::default()),
            angle_deg: 0.0,
            last_angle_deg: None,
            is_stopped: false,
            is_held: false,
            is_sought: [false; 2],
            has_ended: false,
            recorder: None,
            ignored: 0,
            mask: Vec::new(),
            sequence: Sequence::default(),
            in_place: InPlace::default(),
            revision: 0,
        };
        core.render_again();
        (core, sender)
    }

    /// Takes positions from this source, which moves on from the next tick: for whoever drives a
    /// core without an [`Engine`](super::Engine). Allocates.
    ///
    /// # Errors
    /// A stroke makes no sense, or the system gives no thread for a stream of lines.
    pub fn play(&mut self, source: InputSource, does_loop: bool) -> Result<(), EngineError> {
        drop(self.set_source(playable(source)?));
        self.control(Control::Loop(does_loop));
        self.control(Control::Play);
        Ok(())
    }

    /// The pose that was rendered last.
    #[expect(
        clippy::misnamed_getters,
        reason = "the other pose is where the pointer is"
    )]
    pub fn pose(&self) -> Pose {
        self.rendered
    }

    /// What the source lost before anybody could look at it.
    pub fn losses(&self) -> InputLosses {
        self.source()
            .map_or_else(|| self.live.losses(), PointerInput::losses)
    }

    /// How steadily the source reports.
    pub fn input_rate(&self) -> InputRate {
        self.track.rate()
    }

    /// Does one tick. Allocates nothing.
    pub fn tick(&mut self, now: Instant, say: Say<'_>) {
        let reading = self.read(now);
        self.is_held = false;
        self.is_sought = [false, self.is_sought[0]];
        match reading {
            Reading::Samples => self.follow(),
            Reading::Pose(pose) => self.pose = self.as_told(pose),
            Reading::Held => {
                self.is_held = true;
                if self.is_turnable() {
                    // Turned where it stands; that is no turning once it goes on.
                    self.pose.angle_deg = self.angle_deg;
                    self.last_angle_deg = Some(self.angle_deg);
                }
            }
            Reading::Lifted => {
                self.follow();
                self.pose = self.pose.at_rest();
            }
            Reading::Ended => {
                if !self.has_ended {
                    say(Notice::SourceEnded);
                }
                self.pose = self.pose.at_rest();
            }
        }
        self.has_ended = reading == Reading::Ended;
        if let (Some(recorder), false) = (&self.recorder, self.is_held) {
            self.pose = recorder.as_replayed(self.pose);
        }
        self.rendered = if self.is_stopped {
            self.pose.at_rest()
        } else {
            self.pose
        };
        let told = self.playable.as_deref().and_then(PointerInput::path);
        self.fingers.follow((&self.pose, self.has_ended), now, told);
        let played = self.sequence.next_tick();
        self.lead_stylus();
        if let Some(cloth) = &mut self.in_place.cloth {
            cloth.next_tick();
        }
        self.render(played);
        self.tick += 1;
    }

    fn render(&mut self, played: Option<Played>) {
        // What the scene would give is not looked up while a cloth is felt in its place.
        let cloth = self.in_place.cloth.as_ref().filter(|_| played.is_none());
        let cloth = cloth.map(|cloth| cloth.felt());
        let (pose, rests) = match cloth {
            Some(_) => (self.rendered.at_rest(), true),
            None => (self.rendered, self.is_stopped),
        };
        let poses = (pose, self.fingers.rendered(rests));
        let first = (played, self.in_place.stylus.driven());
        let cloth = cloth.filter(|_| !self.is_stopped);
        self.scene.render(poses, &self.mask, first, cloth.as_ref());
    }

    /// Renders the last tick anew, after something else than the pose changed.
    fn render_again(&mut self) {
        let played = self.sequence.played();
        self.render(played);
    }

    /// Adds the tick to the recording, with the frame that went to the device. The recording comes
    /// back if that was its end.
    pub(super) fn record(
        &mut self,
        (sent, tally): (Option<SentFrame>, LinkTally),
        say: Say<'_>,
    ) -> Option<Retired> {
        if self.is_held {
            return None;
        }
        let recorder = self.recorder.as_mut()?;
        let tick = RecordedTick {
            tick: self.tick,
            // While everything is off the display is rendered at rest, but it goes on moving.
            pose: self.pose,
            sent,
            sequence_step: self.sequence.step(),
            tally,
        };
        let (fingers, first) = (&self.fingers, self.pose);
        let others = 1..=fingers::n_others(self.scene.n_displays());
        let others = others.map(|display| fingers.pose(display).unwrap_or(first));
        let Err(why) = recorder.push(tick, others, self.scene.amplitudes_um()) else {
            return None;
        };
        say(Notice::RecordingEnded(why));
        self.end_recording()
    }

    /// What the device plays now: amplitudes [A40, A320] of the first display after gains and
    /// before output limits, µm; zeros while stopped or held.
    pub fn felt_um(&self) -> &[[f32; 2]] {
        self.felt_um_of(0)
    }

    /// The same of any display: what a device that drove it would play, µm.
    pub(super) fn felt_um_of(&self, display: usize) -> &[[f32; 2]] {
        self.scene.felt_um(display, self.is_silent())
    }

    /// Whether the device plays silence: stopped or held.
    pub(super) fn is_silent(&self) -> bool {
        self.is_stopped || self.is_held
    }

    /// Whether the last tick stood still because its source is held.
    pub(super) fn is_held(&self) -> bool {
        self.is_held
    }

    /// Whether the last tick only showed the place that a held source was put to.
    pub(super) fn is_sought(&self) -> bool {
        self.is_sought[1]
    }

    /// Where a display is and how it moves, felt or not.
    pub(super) fn shown_pose(&self, display: usize) -> Pose {
        self.fingers.pose(display).unwrap_or(self.pose)
    }

    /// Times that displays beside the first moved by themselves.
    pub(super) fn others_moved(&self) -> u64 {
        self.fingers.n_moves()
    }

    /// The stamp of the newest live sample, if it came for the last tick.
    pub fn fresh_stamp(&self) -> Option<Instant> {
        self.track.fresh_stamp()
    }

    /// Ticks done.
    pub(crate) fn tick_count(&self) -> u64 {
        self.tick
    }

    /// The scene that is felt.
    pub fn scene(&self) -> &PreparedScene {
        &self.scene
    }

    /// Everything off: silent until [`resume`](Self::resume), a replay held, the recording over.
    pub(super) fn stop(&mut self) -> Option<Retired> {
        self.is_stopped = true;
        self.sequence.end();
        self.control(Control::Pause);
        self.rendered = self.pose.at_rest();
        self.render_again();
        self.end_recording()
    }

    /// Ends the silence of [`stop`](Self::stop).
    pub(super) fn resume(&mut self) {
        self.is_stopped = false;
    }

    /// Other limits and calibration from now on; what there was before comes back in `coder`.
    pub(super) fn exchange_coder(&mut self, coder: &mut Coder) {
        self.scene.exchange_coder(coder);
        self.render_again();
        self.revision += 1;
    }

    /// A device that makes this of codes is connected, or none any more.
    pub(super) fn set_link(&mut self, link: Option<LinkScale>) {
        self.scene.set_link(link);
    }

    /// Writes the state into a snapshot that was made for this scene; clock and device are the
    /// caller's. `until_felt` is how long after a tick the middle of that comes in which a device
    /// plays it.
    pub(super) fn fill(&self, snapshot: &mut Snapshot, until_felt: Option<Duration>) {
        snapshot.scene_serial = self.scene.serial();
        snapshot.revision = self.revision;
        snapshot.tick = self.tick;
        snapshot.pose = self.pose;
        snapshot.rendered = self.rendered;
        snapshot.turn_deg = self.angle_deg;
        let pose = |display| self.shown_pose(display);
        self.scene.fill(&mut snapshot.displays, pose);
        snapshot.is_stopped = self.is_stopped;
        snapshot.is_silent = self.is_silent();
        snapshot.sequence_step = self.sequence.step();
        snapshot.rendering = RenderingView::of(&self.scene.renderer);
        snapshot.rendering.is_cloth = self.in_place.cloth.is_some();
        snapshot.pointer = self.track.view(self.losses(), until_felt);
        self.fingers.count_into(&mut snapshot.pointer.samples);
        snapshot.source = self
            .source()
            .map_or(SourceKind::Pointer, PointerInput::kind);
        snapshot.playback = self.playback();
        snapshot.recording = self.recording_view();
        snapshot.stylus = self.stylus();
        snapshot.counters.stylus_steps = self.in_place.stylus.n_steps();
        snapshot.counters.others_moved = self.fingers.n_moves();
        snapshot.counters.ignored = self.ignored;
    }

    fn control(&mut self, control: Control) {
        if let Some(playable) = &mut self.playable {
            let is_seek = matches!(control, Control::Seek(_));
            self.is_sought[0] = is_seek && !playable.playback().is_playing;
            playable.control(control);
        }
    }

    fn end_recording(&mut self) -> Option<Retired> {
        let mut recorder = self.recorder.take()?;
        recorder.hand_over();
        Some(Retired::Recorder(recorder))
    }

    fn source(&self) -> Option<&dyn PointerInput> {
        self.playable.as_deref()
    }

    fn playback(&self) -> Playback {
        let live = Playback {
            is_playing: true,
            ..Playback::default()
        };
        self.source().map_or(live, PointerInput::playback)
    }

    fn recording_view(&self) -> RecordingView {
        let n_ticks = self
            .recorder
            .as_ref()
            .map_or(0, |recorder| recorder.n_ticks());
        RecordingView {
            is_recording: self.recorder.is_some(),
            n_ticks,
        }
    }
}
