//! The window before the public: a face in place of header, panes and bar. No menus, dialogs and
//! keys of the workbench; nothing is kept but what the face keeps itself.

use std::sync::PoisonError;
use std::sync::atomic::Ordering;

use eframe::egui::{self, Ui};

use crate::bench::Drive;
use crate::bench::command::Commands;
use crate::bench::error::AppError;
use crate::bench::stage::StageOptions;
use crate::bench::tool::PaneContext;
use crate::shell::frame::feel;
use crate::shell::window::Workbench;
use crate::tools;

/// Textiles that a stage shows.
const N_CLOTHS: usize = 4;

impl Workbench {
    /// A stage, disarmed and without a device.
    ///
    /// # Errors
    /// As [`Self::new`]; the scene has fewer than four textiles.
    pub fn on_stage(
        ctx: &egui::Context,
        options: StageOptions,
        drive: Drive,
    ) -> Result<Self, AppError> {
        let mut window = Self::new(ctx, options.scene.as_deref(), drive)?;
        let n_cloths = window.bench.document.scene().textiles.len();
        if n_cloths < N_CLOTHS {
            return Err(AppError::Stage { n_cloths });
        }
        window.face = Some(tools::stage(options, &mut window.bench));
        Ok(window)
    }

    /// Lets time pass. Whether a stage is on.
    pub(crate) fn stage_logic(&mut self, ctx: &egui::Context) -> bool {
        let Some(face) = &mut self.face else {
            return false;
        };
        self.bench.take_news(ctx);
        face.logic(&mut self.bench);
        let is_asked = ctx.input(|input| input.viewport().close_requested());
        let is_told = self.shell.ends.load(Ordering::Relaxed);
        if !face.is_closed_by(is_asked && !is_told, &mut self.bench) && is_asked && !is_told {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
        }
        self.settle();
        true
    }

    /// Draws a frame of the stage. Whether one is on.
    pub(crate) fn stage_ui(&mut self, ui: &mut Ui) -> bool {
        let Some(mut face) = self.face.take() else {
            return false;
        };
        let scene = self.bench.scene_view();
        let (mut commands, mut ground) = (Commands::new(), None);
        face.ui(
            ui,
            &mut PaneContext {
                bench: &mut self.bench,
                scene: &scene,
                commands: &mut commands,
                ground: &mut ground,
                guest: &mut None,
            },
        );
        let stop = face.stop_area().map(|area| area * ui.pixels_per_point());
        let mut tap = (self.shell.tap.lock()).unwrap_or_else(PoisonError::into_inner);
        tap.set_stop(stop);
        drop(tap);
        self.face = Some(face);
        feel(self, ui.ctx(), ground);
        self.settle();
        true
    }

    /// The stage ends with the program.
    pub(crate) fn end_stage(&mut self) -> bool {
        let Some(face) = &mut self.face else {
            return false;
        };
        self.bench.engine.stop_switch().press();
        face.end();
        true
    }
}

/// Fills the screen, also where no window manager does it.
pub(crate) fn fill_screen(ctx: &egui::Context) {
    let size = ctx.input(|input| input.viewport().monitor_size);
    if let Some(size) = size {
        ctx.send_viewport_cmd(egui::ViewportCommand::InnerSize(size));
    }
}

/// Whether something that came down is to be felt: on a stage only what is pressed is.
pub(crate) fn is_felt(window: &Workbench, ctx: &egui::Context) -> bool {
    window.face.is_none() || ctx.input(|input| input.pointer.primary_down())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::Bench;

    #[test]
    fn a_scene_of_three_textiles_is_refused_in_one_line() {
        let error = AppError::Stage { n_cloths: 3 }.to_string();
        assert!(
            error.contains("four textiles") && error.contains('3'),
            "{error}"
        );
        let bench = Bench::new(&egui::Context::default(), None, Drive::Stepped).unwrap();
        assert!(bench.document.scene().textiles.len() >= N_CLOTHS);
    }
}
