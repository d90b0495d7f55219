//! The window's state and its frame: inboxes are emptied, then everything is drawn from views that
//! do not change while they are drawn.

use std::fmt;
use std::path::Path;

use eframe::egui;

use crate::bench::error::AppError;
use crate::bench::tool::{PublicFace, Tools};
use crate::bench::{Bench, Drive};
use crate::shell::dialogs::Dialogs;
use crate::shell::frame;
use crate::shell::pointer::PointerTap;
use crate::shell::state::Shell;
use crate::tools;

/// The window: the bench, the tools around it, and the shell that shows them.
pub struct Workbench {
    pub(crate) bench: Bench,
    pub(crate) tools: Tools,
    pub(crate) shell: Shell,
    /// What the public sees in place of all that.
    pub(crate) face: Option<Box<dyn PublicFace>>,
}

impl Workbench {
    /// A workbench on the scene at `scene` (`None`: the one that the program ships), disarmed and
    /// without a device.
    ///
    /// # Errors
    /// The scene cannot be opened, or the engine cannot start.
    pub fn new(ctx: &egui::Context, scene: Option<&Path>, drive: Drive) -> Result<Self, AppError> {
        let mut bench = Bench::new(ctx, scene, drive)?;
        let dialogs = match drive {
            Drive::Live => Dialogs::of_desktop(),
            Drive::OnStage | Drive::Stepped => Dialogs::default(),
        };
        let tap = PointerTap::new(bench.engine.take_pointer());
        let mut tools = Tools::new(tools::all());
        for tool in tools.iter_mut() {
            tool.begin(&mut bench);
        }
        Ok(Self {
            bench,
            tools,
            shell: Shell::new(tap, dialogs, tools::bar()),
            face: None,
        })
    }
}

impl eframe::App for Workbench {
    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        self.bench.clock.look(ctx);
        if self.stage_logic(ctx) {
            return;
        }
        self.take_keys(ctx);
        self.take_news(ctx);
        self.take_close_request(ctx);
        self.take_dropped(ctx);
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.bench.clock.draw();
        if self.stage_ui(ui) {
            return;
        }
        let mut commands = frame::show(self, ui);
        if !commands.is_empty() || !self.bench.commands.is_empty() {
            // What was wished for shows in the next frame.
            ui.ctx().request_repaint();
        }
        self.bench.commands.append(&mut commands);
        self.settle();
    }

    fn raw_input_hook(&mut self, _ctx: &egui::Context, input: &mut egui::RawInput) {
        if let Some(face) = &self.face {
            face.filter(input);
        }
    }

    fn on_exit(&mut self, _gl: Option<&eframe::glow::Context>) {
        if self.end_stage() {
            return;
        }
        self.bench.engine.stop_switch().press();
        self.bench.end_recording();
        let parts = self.unsaved();
        drop(self.bench.files.recovery.end(parts));
        self.keep_settings();
        // The window is gone and nobody is left to tell; the file that was there is still whole.
        drop(self.bench.settings.save_now());
        drop(self.bench.device.arrays.save_now());
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.extreme_bg_color.to_normalized_gamma_f32()
    }
}

impl fmt::Debug for Workbench {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Workbench")
            .field("scene", &self.scene_name())
            .finish_non_exhaustive()
    }
}
