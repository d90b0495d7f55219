//! What a frame does about array profiles: the engine follows, files are written, the wiring of a
//! device that was not measured is doubted.

use std::time::Duration;

use eframe::egui;

use crate::bench::view::BridgePhase;
use crate::bench::{Bench, query};
use selvedge_device::{ArrayProfile, BridgeEvent, DeviceUid, DisarmedBy};
use selvedge_engine::{Command, Notice};

impl Bench {
    /// The profile that ought to be in force.
    pub(crate) fn array(&self) -> ArrayProfile {
        let chosen = self.settings.preferences.array.as_deref();
        let display = self.document.scene().displays.first();
        let profile = display.map_or_else(ArrayProfile::default, |display| {
            self.device.arrays.in_force(chosen, display)
        });
        match self.device.ceiling {
            Some(ceiling) => profile.capped(ceiling),
            None => profile,
        }
    }

    /// Lets the engine follow the profile in force as far as the device allows, and keeps files.
    pub(crate) fn follow_array(&mut self, ctx: &egui::Context) {
        let wanted = self.array();
        let held = self.engine.profile();
        // A scene with another display is still on its way to the engine.
        let fits = wanted.n_contactors() == held.n_contactors();
        let is_due = fits && (wanted != *held || self.device.arrays.is_refused);
        let phase = self.live.bridge.as_ref().map(|bridge| bridge.phase);
        let is_live = phase == Some(BridgePhase::Armed);
        let may = !is_live || (wanted.only_lowers(held) && !self.device.arrays.is_refused);
        self.device.arrays.waits = is_due && !may;
        // A device at rest is configured once a drag is over, not at each of its steps.
        let is_dragged = ctx.input(|input| input.pointer.any_down());
        if is_due && may && (is_live || !is_dragged) {
            self.device.arrays.is_refused = false;
            self.send(Command::SetArray(Some(Box::new(wanted))));
        }
        if self.device.arrays.wizard.is_some()
            && !matches!(phase, Some(BridgePhase::Ready | BridgePhase::Armed))
        {
            self.device.arrays.wizard = None;
            self.send(Command::Identify(false));
            let words = "The device is gone: what was identified of it is lost; connect and begin \
                         again";
            self.notices.give(words);
        }
        self.save_arrays(ctx);
    }

    /// Takes in what the engine says that concerns the array.
    pub(crate) fn hear_of_array(&mut self, notice: &Notice) {
        match notice {
            Notice::ArrayWaits => self.device.arrays.is_refused = true,
            Notice::Bridge(event) => {
                if let Some(wizard) = &mut self.device.arrays.wizard {
                    wizard.hear(event);
                }
                if let BridgeEvent::Connected(caps) = event {
                    self.doubt_wiring(DeviceUid(caps.uid));
                }
                self.keep_trouble(event);
            }
            _ => {}
        }
    }

    /// What stands beside the device's state until it is armed again.
    fn keep_trouble(&mut self, event: &BridgeEvent) {
        match event {
            BridgeEvent::Refused(why) | BridgeEvent::Lost(why) => {
                self.device.trouble = Some(query::capitalised(why));
            }
            BridgeEvent::Disarmed {
                by: DisarmedBy::Device,
                reason,
            } => self.device.trouble = Some(query::capitalised(reason)),
            BridgeEvent::Armed => self.device.trouble = None,
            _ => {}
        }
    }

    /// Says once of each device that it is not the one that was measured.
    fn doubt_wiring(&mut self, uid: DeviceUid) {
        let doubt = self.array().wiring_doubt(uid);
        if let Some(words) = doubt
            && self.device.arrays.doubted.replace(uid) != Some(uid)
        {
            self.notices.give(query::capitalised(&words));
        }
    }

    fn save_arrays(&mut self, ctx: &egui::Context) {
        let arrays = &mut self.device.arrays;
        let (failure, wait_s) = arrays.save_if_changed(&self.executor, self.clock.now_s());
        if let Some(wait_s) = wait_s {
            ctx.request_repaint_after(Duration::from_secs_f64(wait_s));
        }
        if let Some(failure) = failure {
            self.notices.give(failure);
        }
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{self};

    use crate::bench::command::array::ArrayCommand;
    use crate::bench::command::{PlayCommand, PlaySource, ShowCommand};
    use crate::bench::pane::Pane;
    use crate::shell::headless::Headless;
    use crate::shell::raster::Rasteriser;
    use crate::tools::why::Why;
    use selvedge_device::{ArrayProfile, Calibration};
    use selvedge_textile::tactile::Band;

    #[test]
    fn what_is_changed_of_a_profile_reaches_the_engine_and_stays_with_the_user() {
        let mut window = Headless::shipped();
        window.pass(2);
        window.dispatch(ArrayCommand::Limit(Band::High, 12.5));
        window.pass(2);
        assert_eq!(
            window.workbench.bench.engine.profile().limit_um,
            [50.0, 12.5]
        );
        assert!(window.workbench.bench.device.arrays.is_own("exeter-24"));
        window.dispatch(ArrayCommand::Copy("rig 2".to_owned()));
        window.dispatch(ArrayCommand::Limit(Band::Low, 1.0));
        window.pass(2);
        assert_eq!(window.workbench.bench.engine.profile().name, "rig 2");
        assert_eq!(
            window.workbench.bench.settings.preferences.array.as_deref(),
            Some("rig 2")
        );
        window.dispatch(ArrayCommand::Choose(Some("exeter-24".to_owned())));
        window.pass(2);
        assert_eq!(
            window.workbench.bench.engine.profile().limit_um,
            [50.0, 12.5]
        );
        window.dispatch(ArrayCommand::Copy("exeter-24".to_owned()));
        let notices = window.workbench.notices();
        assert!(
            notices[0].contains("is the name of an array already"),
            "{notices:?}"
        );
        window.dispatch(ArrayCommand::Forget);
        window.pass(2);
        assert_eq!(
            *window.workbench.bench.engine.profile(),
            ArrayProfile::default()
        );
        assert!(
            window.workbench.bench.document.steps().undo().is_none(),
            "no edit of the scene"
        );
    }

    /// Writes a picture where `SELVEDGE_PICTURES` says, for people to look at.
    #[test]
    fn limits_that_bite_are_marked_in_every_view_of_the_contactor() {
        let mut window = Headless::shipped();
        window.ctx.set_theme(egui::Theme::Dark);
        let mut rasteriser = Rasteriser::default();
        rasteriser.apply(&mut window.run().textures_delta);
        window.dispatch(PlayCommand::Source(PlaySource::Stroke));
        window.dispatch(ShowCommand::Pane(Pane::Why));
        window.dispatch(ArrayCommand::Limit(Band::Low, 1.0));
        for contactor in [6, 13] {
            let off = Calibration {
                is_off: true,
                ..Calibration::default()
            };
            window.dispatch(ArrayCommand::Calibrate(contactor, off));
        }
        for _ in 0..12 {
            rasteriser.apply(&mut window.run_after(4).textures_delta);
        }
        let dots = &window.workbench.bench.live.dots;
        let off: Vec<usize> = (0..24).filter(|index| dots[*index].limiter.off).collect();
        assert_eq!(off, [6, 13]);
        for dot in dots.iter().filter(|dot| !dot.limiter.off) {
            assert_eq!(dot.limiter.limited[0], dot.amplitude_um[0] > 1.0, "{dot:?}");
        }
        assert!(dots.iter().any(|dot| dot.limiter.limited[0]));
        let why = window.workbench.tools.get::<Why>().unwrap();
        let why = why.shown.as_ref().unwrap();
        assert_eq!(why.output.limits.map(|limit| limit.um), [1.0, 50.0]);
        assert!(why.output.limiter.limited[0], "{:?}", why.output);
        let mut last = window.run();
        rasteriser.apply(&mut last.textures_delta);
        let Ok(folder) = std::env::var("SELVEDGE_PICTURES") else {
            last.drop_without_applying_deltas();
            return;
        };
        let primitives = window.ctx.tessellate(last.shapes, 1.0);
        let picture = rasteriser.draw(&primitives, [1400, 900], 1.0, egui::Color32::BLACK);
        let path = std::path::Path::new(&folder).join("limits.png");
        let png =
            selvedge_foundation::files::encode_png_rgba(&picture.rgba, 1400, 900, &path).unwrap();
        std::fs::write(&path, png).unwrap();
    }
}
