//! A window without a display: frames are run when told, 25 ms apart, and nothing depends on a
//! clock.

use std::path::Path;

use eframe::App as _;
use eframe::egui::{Context, FullOutput, Pos2, RawInput, Rect, Vec2};
#[cfg(test)]
use eframe::egui::{Event, Key, Modifiers};

use crate::bench::Drive;
use crate::bench::command::Command;
use crate::bench::error::AppError;
use crate::bench::stage::{StageOptions, StagePicture};
use crate::shell::window::Workbench;

/// Ticks from frame to frame where time passes quickly.
#[cfg(test)]
const TICKS_A_FRAME: u32 = 4;

/// A workbench, the toolkit around it, and no display.
pub(crate) struct Headless {
    pub(crate) ctx: Context,
    pub(crate) workbench: Workbench,
    frame: eframe::Frame,
    size: Vec2,
    pixels_per_point: f32,
    n_ticks: u32,
    /// What the user does in the next frame.
    #[cfg(test)]
    pub(crate) events: Vec<Event>,
}

impl Headless {
    /// A workbench on a scene (`None`: the one that the program ships) in a window of this size in
    /// points, before its first frame.
    ///
    /// # Errors
    /// As [`Workbench::new`].
    pub(crate) fn new(
        scene: Option<&Path>,
        size: Vec2,
        pixels_per_point: f32,
    ) -> Result<Self, AppError> {
        Self::around(size, pixels_per_point, |ctx| {
            Workbench::new(ctx, scene, Drive::Stepped)
        })
    }

    /// One on the shipped scene, in a window as it opens at first.
    #[cfg(test)]
    pub(crate) fn shipped() -> Self {
        Self::new(None, Vec2::new(1400.0, 900.0), 1.0).unwrap()
    }

    /// The same once it was drawn.
    #[cfg(test)]
    pub(crate) fn drawn() -> Self {
        let mut window = Self::shipped();
        window.pass(2);
        window
    }

    /// The same with a stage.
    pub(crate) fn on_stage(
        options: StageOptions,
        size: Vec2,
        pixels_per_point: f32,
    ) -> Result<Self, AppError> {
        Self::around(size, pixels_per_point, |ctx| {
            Workbench::on_stage(ctx, options, Drive::Stepped)
        })
    }

    fn around(
        size: Vec2,
        pixels_per_point: f32,
        window: impl FnOnce(&Context) -> Result<Workbench, AppError>,
    ) -> Result<Self, AppError> {
        let ctx = Context::default();
        Ok(Self {
            workbench: window(&ctx)?,
            frame: eframe::Frame::_new_kittest(),
            ctx,
            size,
            pixels_per_point,
            n_ticks: 0,
            #[cfg(test)]
            events: Vec::new(),
        })
    }

    /// Does what a user could want.
    pub(crate) fn dispatch(&mut self, command: impl Into<Command>) {
        self.workbench.dispatch(command.into());
    }

    /// Brings the stage to a state.
    pub(crate) fn go_to(&mut self, picture: StagePicture) {
        if let Some(face) = &mut self.workbench.face {
            face.go_to(picture);
        }
    }

    /// Runs the next frame.
    pub(crate) fn run(&mut self) -> FullOutput {
        self.run_after(1)
    }

    /// Runs a frame so many ticks after the last one.
    pub(crate) fn run_after(&mut self, n_ticks: u32) -> FullOutput {
        self.n_ticks += n_ticks;
        let mut input = self.input();
        self.workbench.raw_input_hook(&self.ctx, &mut input);
        let Self {
            ctx,
            workbench,
            frame,
            ..
        } = self;
        ctx.run_ui(input, |ui| {
            workbench.logic(ui.ctx(), frame);
            workbench.ui(ui, frame);
        })
    }

    /// Runs so many frames that nobody looks at.
    pub(crate) fn pass(&mut self, n_frames: u32) {
        for _ in 0..n_frames {
            self.run().textures_delta.clear();
        }
    }

    /// Presses a key, and draws what becomes of it.
    #[cfg(test)]
    pub(crate) fn press(&mut self, modifiers: Modifiers, key: Key) {
        self.events.extend([true, false].map(|pressed| Event::Key {
            key,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers,
        }));
        self.pass(3);
    }

    /// Lets so many ticks pass with fewer frames, which nobody looks at.
    #[cfg(test)]
    pub(crate) fn pass_ticks(&mut self, n_ticks: u32) {
        let end = self.n_ticks + n_ticks;
        while self.n_ticks < end {
            let next = TICKS_A_FRAME.min(end - self.n_ticks);
            self.run_after(next).drop_without_applying_deltas();
        }
    }

    #[cfg_attr(
        not(test),
        expect(clippy::needless_pass_by_ref_mut, reason = "tests take events out")
    )]
    fn input(&mut self) -> RawInput {
        let mut input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, self.size)),
            time: Some(f64::from(self.n_ticks) / 40.0),
            predicted_dt: 0.025,
            focused: true,
            ..RawInput::default()
        };
        #[cfg(test)]
        input.events.append(&mut self.events);
        input
            .viewports
            .entry(input.viewport_id)
            .or_default()
            .native_pixels_per_point = Some(self.pixels_per_point);
        input
    }
}
