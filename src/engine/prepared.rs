//! A scene made ready to be felt: everything that the real-time thread must not make itself.

use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};

use super::{
    ClockView, ClothTick, ContactorView, DisplayView, EngineCounters, EngineError, Playback,
    Played, PointerView, RecordingView, RenderingView, Snapshot, SourceKind,
};
use selvedge_device::{ArrayProfile, Coder, LinkScale};
use selvedge_foundation::geometry::Point;
use selvedge_render::RenderScene;
use selvedge_render::array::{Accuracy, ArrayRenderer, DisplayFrame, Method};
use selvedge_render::scene::{Display, LoadedScene, Pose};

/// A renderer with its tables, and room for everything a tick writes. Made off the engine's thread.
pub struct PreparedScene {
    serial: u64,
    start: Point,
    profile: ArrayProfile,
    pub(super) renderer: ArrayRenderer,
    poses: Vec<Pose>,
    outputs: Vec<Output>,
}

/// What the limits of an output make of one display.
struct Output {
    coder: Coder,
    codes: Vec<[u16; 2]>,
    silence: Vec<[f32; 2]>,
}

impl PreparedScene {
    /// Prepares a loaded scene, which takes about a millisecond. The pointer starts in its middle.
    ///
    /// # Errors
    /// What [`ArrayRenderer::prepare`] refuses.
    pub fn prepare(
        loaded: &LoadedScene,
        method: Method,
        accuracy: &Accuracy,
    ) -> Result<Self, EngineError> {
        let (profile, start) = place_of(loaded);
        Self::from_parts(&RenderScene::of(loaded), profile, start, (method, accuracy))
    }

    /// Prepares a scene given as rendering sees it, for a device of this profile, with the pointer
    /// at `start`.
    ///
    /// # Errors
    /// What [`ArrayRenderer::prepare`] refuses.
    pub fn from_parts(
        scene: &RenderScene,
        profile: ArrayProfile,
        start: Point,
        (method, accuracy): (Method, &Accuracy),
    ) -> Result<Self, EngineError> {
        let renderer = ArrayRenderer::prepare(scene, method, accuracy)?;
        Ok(Self::around(renderer, profile, start))
    }

    fn around(renderer: ArrayRenderer, profile: ArrayProfile, start: Point) -> Self {
        static SERIAL: AtomicU64 = AtomicU64::new(1);
        let output = |frame: &DisplayFrame| Output {
            coder: Coder::new(&profile, frame.n_contactors()),
            codes: vec![[0; 2]; frame.n_contactors()],
            silence: vec![[0.0; 2]; frame.n_contactors()],
        };
        Self {
            serial: SERIAL.fetch_add(1, Ordering::Relaxed),
            start,
            poses: vec![Pose::default(); renderer.frames().len()],
            outputs: renderer.frames().iter().map(output).collect(),
            profile,
            renderer,
        }
    }

    /// A number that no other prepared scene has; snapshots carry it.
    pub fn serial(&self) -> u64 {
        self.serial
    }

    /// The device that the first display needs.
    pub fn profile(&self) -> &ArrayProfile {
        &self.profile
    }

    /// Contactors of the first display: those that a device plays.
    pub fn n_felt(&self) -> usize {
        self.n_felt_of(0)
    }

    /// The same of any display; 0 where there is none.
    pub(super) fn n_felt_of(&self, display: usize) -> usize {
        let output = self.outputs.get(display);
        output.map_or(0, |output| output.codes.len())
    }

    /// Contactors of all displays together.
    pub fn n_contactors(&self) -> usize {
        self.outputs.iter().map(|output| output.codes.len()).sum()
    }

    /// Whether the displays of another scene have as many contactors, one by one.
    pub(super) fn has_arrays_of(&self, other: &Self) -> bool {
        let counts = |output: &Output| output.codes.len();
        let others = other.outputs.iter().map(counts);
        self.outputs.iter().map(counts).eq(others)
    }

    /// The renderer, before the engine has it: its method, bound and levels.
    pub fn renderer(&self) -> &ArrayRenderer {
        &self.renderer
    }

    /// Where the pointer starts.
    pub(super) fn start(&self) -> Point {
        self.start
    }

    /// Displays of the scene.
    pub(super) fn n_displays(&self) -> usize {
        self.poses.len()
    }

    /// Renders every display at this pose, or those beside the first at poses of their own as far
    /// as `apart` has them, and looks which output limits their amplitudes meet.
    /// Contactors of the first display that the mask says are not felt do nothing. Where something
    /// is played, the first display feels that in place of the whole scene; else what a stylus
    /// drives it with, if one is felt. What a cloth that hangs gives replaces all of both displays.
    pub(super) fn render(
        &mut self,
        (pose, apart): (Pose, &[Pose]),
        mask: &[bool],
        (played, stylus): (Option<Played>, Option<(usize, [f64; 2])>),
        cloth: Option<&ClothTick>,
    ) {
        self.poses.fill(pose);
        for (place, own) in self.poses.iter_mut().skip(1).zip(apart) {
            *place = *own;
        }
        let textile = match played {
            Some(Played::Textile(textile)) => Some(textile),
            Some(Played::Vibration(_)) | None => None,
        };
        self.renderer.uncover(0, textile);
        self.renderer.tick(&self.poses);
        match (played, stylus) {
            (Some(Played::Vibration(amplitude_um)), _) => {
                self.renderer.vibrate_display(0, amplitude_um);
            }
            (None, Some((textile, amplitude_um))) => {
                self.renderer.drive_display(0, textile, amplitude_um);
            }
            (Some(Played::Textile(_)) | None, _) => {}
        }
        for (display, given) in cloth.into_iter().flatten().enumerate() {
            self.renderer.give_display(display, given);
        }
        self.renderer.mask_display(0, mask);
        for (output, frame) in self.outputs.iter_mut().zip(self.renderer.frames()) {
            output
                .coder
                .encode_into(frame.amplitudes_um(), 1.0, &mut output.codes);
        }
    }

    /// Lets the first display be driven as this array, if it has as many contactors; otherwise
    /// nothing changes. Allocates.
    pub fn drive_as(&mut self, profile: &ArrayProfile) {
        if profile.n_contactors() != self.n_felt() {
            return;
        }
        if let Some(output) = self.outputs.first_mut() {
            output.coder = Coder::new(profile, output.codes.len());
            self.profile = profile.clone();
        }
    }

    /// Exchanges what makes codes of the first display's amplitudes; counters and the device's
    /// limits go on.
    pub(super) fn exchange_coder(&mut self, coder: &mut Coder) {
        if let Some(output) = self.outputs.first_mut() {
            coder.go_on_from(&output.coder);
            std::mem::swap(&mut output.coder, coder);
        }
    }

    /// What the device makes of the codes of the first display.
    pub(super) fn set_link(&mut self, link: Option<LinkScale>) {
        if let Some(output) = self.outputs.first_mut() {
            output.coder.set_link(link);
        }
    }

    /// Amplitudes of every display, µm.
    pub(super) fn amplitudes_um(&self) -> impl Iterator<Item = &[[f32; 2]]> {
        self.renderer
            .frames()
            .iter()
            .map(DisplayFrame::amplitudes_um)
    }

    /// What is felt of a display, or silence, µm; a device plays the first.
    pub(super) fn felt_um(&self, display: usize, is_silent: bool) -> &[[f32; 2]] {
        let silence = || (self.outputs.get(display)).map(|output| &output.silence[..]);
        let amplitudes = || self.amplitudes_um().nth(display);
        if is_silent { silence() } else { amplitudes() }.unwrap_or_default()
    }

    /// What the limits leave of an amplitude of the first display's contactor, µm.
    pub(super) fn limited_um(&self, contactor: usize, amplitude_um: [f32; 2]) -> [f32; 2] {
        let output = self.outputs.first();
        output.map_or(amplitude_um, |output| {
            output.coder.limited_um(contactor, amplitude_um)
        })
    }

    /// A snapshot before the first tick, with room for every contactor.
    pub(super) fn first_snapshot(&self) -> Snapshot {
        let pose = Pose {
            position: self.start,
            ..Pose::default()
        };
        Snapshot {
            scene_serial: self.serial,
            revision: 0,
            tick: 0,
            pose,
            rendered: pose,
            turn_deg: 0.0,
            displays: self.empty_views(),
            is_stopped: false,
            is_silent: false,
            sequence_step: None,
            stylus: None,
            rendering: RenderingView::of(&self.renderer),
            pointer: PointerView::default(),
            source: SourceKind::Pointer,
            playback: Playback {
                is_playing: true,
                ..Playback::default()
            },
            recording: RecordingView::default(),
            clock: ClockView::default(),
            counters: EngineCounters::default(),
            link: None,
            second_link: None,
        }
    }

    /// Views with room for every contactor.
    fn empty_views(&self) -> Vec<DisplayView> {
        let pose = Pose {
            position: self.start,
            ..Pose::default()
        };
        let view = |output: &Output| DisplayView {
            pose,
            rendered: pose,
            contactors: vec![ContactorView::default(); output.codes.len()],
        };
        self.outputs.iter().map(view).collect()
    }

    /// Writes what every contactor does into views that were made for this scene; `pose` says where
    /// a display is.
    pub(super) fn fill(&self, views: &mut [DisplayView], pose: impl Fn(usize) -> Pose) {
        let frames = self.renderer.frames().iter().zip(&self.outputs);
        let rendered = self.poses.iter().zip(frames).enumerate();
        for (view, (index, (rendered, (frame, output)))) in views.iter_mut().zip(rendered) {
            (view.pose, view.rendered) = (pose(index), *rendered);
            let limiters = output.coder.limited();
            for (index, contactor) in view.contactors.iter_mut().enumerate() {
                contactor.position = frame.contactor_position(index);
                contactor.textile = frame.textile(index).and_then(|n| u16::try_from(n).ok());
                contactor.amplitude_um = frame
                    .amplitudes_um()
                    .get(index)
                    .copied()
                    .unwrap_or_default();
                contactor.limiter = limiters.get(index).copied().unwrap_or_default();
            }
        }
    }
}

/// The device that a scene needs, and its middle.
fn place_of(loaded: &LoadedScene) -> (ArrayProfile, Point) {
    let scene = loaded.scene();
    let start = Point::new(scene.size_mm[0] / 2.0, scene.size_mm[1] / 2.0);
    let profile = scene.displays.first().map(array_of).unwrap_or_default();
    (profile, start)
}

/// The array that a display is, as at first: the program's profile of that name, or one row of its
/// contactors.
pub fn array_of(display: &Display) -> ArrayProfile {
    let geometry = &display.geometry;
    if let Some(profile) = ArrayProfile::shipped(&geometry.label()) {
        return profile;
    }
    let places = geometry.contactors();
    let places = places.iter().map(|offset| [offset.x_mm, offset.y_mm]);
    let (rows, cols) = geometry
        .grid()
        .unwrap_or_else(|| (1, geometry.n_contactors()));
    let byte = |count: usize| u8::try_from(count).unwrap_or(u8::MAX);
    ArrayProfile {
        name: geometry.label(),
        rows: byte(rows),
        cols: byte(cols),
        contactors_mm: places.collect(),
        ..ArrayProfile::default()
    }
}

impl fmt::Debug for PreparedScene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PreparedScene")
            .field("serial", &self.serial)
            .finish_non_exhaustive()
    }
}
