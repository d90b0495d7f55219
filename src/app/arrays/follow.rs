//! What a frame does about array profiles: the engine follows, files are written, the wiring of a
//! device that was not measured is doubted.

use std::time::Duration;

use eframe::egui;

use crate::app::query;
use crate::app::view::BridgePhase;
use crate::app::window::Workbench;
use crate::bridge::{ArrayProfile, BridgeEvent, DeviceUid};
use crate::engine::{Command, Notice};

impl Workbench {
    /// The profile that ought to be in force.
    pub(crate) fn array(&self) -> ArrayProfile {
        let chosen = self.settings.kept.array.as_deref();
        let display = self.document.scene().displays.first();
        display.map_or_else(ArrayProfile::default, |display| {
            self.arrays.in_force(chosen, display)
        })
    }

    /// Lets the engine follow the profile in force as far as the device allows, and keeps files.
    pub(crate) fn follow_array(&mut self, ctx: &egui::Context) {
        let wanted = self.array();
        let held = self.engine.profile();
        // A scene with another display is still on its way to the engine.
        let fits = wanted.n_contactors() == held.n_contactors();
        let is_due = fits && (wanted != *held || self.arrays.is_refused);
        let phase = self
            .transient
            .live
            .bridge
            .as_ref()
            .map(|bridge| bridge.phase);
        let is_live = phase == Some(BridgePhase::Armed);
        let may = !is_live || (wanted.only_lowers(held) && !self.arrays.is_refused);
        self.arrays.waits = is_due && !may;
        // A device at rest is configured once a drag is over, not at each of its steps.
        let is_dragged = ctx.input(|input| input.pointer.any_down());
        if is_due && may && (is_live || !is_dragged) {
            self.arrays.is_refused = false;
            self.send(Command::SetArray(Some(Box::new(wanted))));
        }
        if self.arrays.wizard.is_some()
            && !matches!(phase, Some(BridgePhase::Ready | BridgePhase::Armed))
        {
            self.arrays.wizard = None;
            self.send(Command::Identify(false));
            let words = "The device is gone: what was identified of it is lost; connect and begin \
                         again";
            self.transient.notices.give(words);
        }
        self.save_arrays(ctx);
    }

    /// Takes in what the engine says that concerns the array.
    pub(crate) fn hear_of_array(&mut self, notice: &Notice) {
        match notice {
            Notice::ArrayWaits => self.arrays.is_refused = true,
            Notice::Bridge(event) => {
                if let Some(wizard) = &mut self.arrays.wizard {
                    wizard.hear(event);
                }
                if let BridgeEvent::Connected(caps) = event {
                    self.doubt_wiring(DeviceUid(caps.uid));
                }
            }
            _ => {}
        }
    }

    /// Says once of each device that it is not the one that was measured.
    fn doubt_wiring(&mut self, uid: DeviceUid) {
        let doubt = self.array().wiring_doubt(uid);
        if let Some(words) = doubt
            && self.arrays.doubted.replace(uid) != Some(uid)
        {
            self.transient.notices.give(query::capitalised(&words));
        }
    }

    fn save_arrays(&mut self, ctx: &egui::Context) {
        let now_s = ctx.input(|input| input.time);
        let (failure, wait_s) = self.arrays.save_if_changed(ctx, now_s);
        if let Some(wait_s) = wait_s {
            ctx.request_repaint_after(Duration::from_secs_f64(wait_s));
        }
        if let Some(failure) = failure {
            self.transient.notices.give(failure);
        }
    }
}
