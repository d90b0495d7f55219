//! What the emulator's contactors would do, beside what they are told: looked at while shown.
//!
//! Nothing is modelled while the section is closed or its pane out of sight. Which finger lies on
//! them is transient.

use eframe::egui;
use std::time::Duration;

use selvedge_device::{ActuatorReading, Bimorph, ContactorModel, FULL_CODE, Skin};
use selvedge_engine::Engine;

/// How soon a first reading is looked for again.
const SOON: Duration = Duration::from_millis(100);
/// A displacement below this is rest, µm.
const REST_UM: f64 = 0.005;

/// What the user chose, and what was seen last.
#[derive(Debug)]
pub(crate) struct ActuatorPeek {
    /// Whether the section is open.
    pub is_open: bool,
    /// The finger on the contactors.
    pub skin: Skin,
    /// Whether its pane was drawn in this frame.
    is_drawn: bool,
    /// What is shown of it.
    pub view: PlantView,
}

impl Default for ActuatorPeek {
    fn default() -> Self {
        Self {
            is_open: false,
            skin: Skin::LIGHT,
            is_drawn: false,
            view: PlantView::default(),
        }
    }
}

/// What the section shows.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct PlantView {
    /// Whether it is open.
    pub is_open: bool,
    /// Columns of the array.
    pub n_columns: usize,
    /// Contactors in index order; none before the first reading.
    pub contactors: Vec<PlantCell>,
    /// The finger on them.
    pub skin: Skin,
    /// The beams: `25 × 1.5 × 0.6 mm, Q 40`.
    pub beams: String,
}

/// One contactor, told and modelled.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct PlantCell {
    /// Amplitudes [A40, A320] that the device was told and puts out, µm.
    pub told_um: [f64; 2],
    /// Displacement of the pin at 40 and 320 Hz, by the model, µm.
    pub(crate) moved_um: [f64; 2],
    /// Root mean square and peak of the amplifier's current, mA.
    pub current_ma: [f64; 2],
    /// Share of the time without skin on the pin, 0…1.
    pub lost_share: f64,
    /// Share of the time in which the amplifier was held back, 0…1.
    pub(crate) held_share: f64,
}

impl ActuatorPeek {
    /// What the section shows; `None` where no emulator of this program is connected. To be called
    /// while its pane is drawn.
    pub(crate) fn look(&mut self, ctx: &egui::Context, engine: &mut Engine) -> Option<&PlantView> {
        let full_scale_um = engine.profile().full_scale_um;
        let n_columns = usize::from(engine.profile().cols);
        let watch = engine.actuators()?;
        self.is_drawn = true;
        if watch.model().skin != self.skin {
            let model = *watch.model();
            watch.set_model(ContactorModel {
                skin: self.skin,
                ..model
            });
        }
        watch.look(self.is_open);
        let model = *watch.model();
        let view = &mut self.view;
        view.is_open = self.is_open;
        view.skin = self.skin;
        view.n_columns = n_columns;
        view.beams = beams(&model);
        view.contactors.clear();
        if self.is_open {
            let reading = watch.reading();
            view.contactors.extend(cells(reading, full_scale_um));
            let moves = view.contactors.iter().any(|cell| {
                let [low, high] = cell.moved_um;
                low.max(high) > REST_UM
            });
            if moves || view.contactors.is_empty() {
                ctx.request_repaint_after(SOON);
            }
        }
        Some(&self.view)
    }

    /// Lets the model rest whose pane is out of sight, or was not drawn in the last frame. To be
    /// called before every frame.
    pub(crate) fn rest(&mut self, engine: &mut Engine, is_in_sight: bool) {
        let was_drawn = std::mem::take(&mut self.is_drawn) && is_in_sight;
        if let Some(watch) = engine.actuators().filter(|_| !was_drawn) {
            watch.look(false);
        }
    }
}

fn beams(model: &ContactorModel) -> String {
    let Bimorph {
        length_mm,
        width_mm,
        thickness_mm,
    } = model.bimorph;
    let quality = model.quality;
    format!("{length_mm} × {width_mm} × {thickness_mm} mm, Q {quality}")
}

/// Contactors of a reading; none before the first.
fn cells(reading: &ActuatorReading, full_scale_um: [f64; 2]) -> impl Iterator<Item = PlantCell> {
    let n = if reading.n_ticks > 0 {
        reading.contactors.len()
    } else {
        0
    };
    let both = reading.contactors.iter().zip(&reading.codes).take(n);
    both.map(move |(one, codes)| PlantCell {
        told_um: [0, 1]
            .map(|band| full_scale_um[band] * f64::from(codes[band]) / f64::from(FULL_CODE)),
        moved_um: one.amplitude_um,
        current_ma: [one.current_rms_ma, one.current_peak_ma],
        lost_share: one.lost_share,
        held_share: one.saturated_share,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::Drive;
    use crate::bench::command::device::DeviceCommand;
    use crate::shell::window::Workbench;

    #[test]
    fn contactors_are_modelled_only_while_the_open_section_is_drawn() {
        let ctx = egui::Context::default();
        let mut window = Workbench::new(&ctx, None, Drive::Stepped).unwrap();
        let mut peek = ActuatorPeek::default();
        let none = peek.look(&ctx, &mut window.bench.engine);
        assert!(none.is_none(), "no emulator yet");
        window.dispatch(DeviceCommand::ConnectEmulator.into());
        assert!(!peek.look(&ctx, &mut window.bench.engine).unwrap().is_open);
        let is_looking =
            |window: &mut Workbench| window.bench.engine.actuators().unwrap().is_looking();
        assert!(!is_looking(&mut window), "the section is closed");
        peek.is_open = true;
        assert!(peek.look(&ctx, &mut window.bench.engine).unwrap().is_open);
        peek.rest(&mut window.bench.engine, true);
        assert!(is_looking(&mut window), "it was drawn in the last frame");
        peek.rest(&mut window.bench.engine, true);
        assert!(!is_looking(&mut window), "it was not drawn in the next");
        peek.look(&ctx, &mut window.bench.engine);
        peek.rest(&mut window.bench.engine, false);
        assert!(!is_looking(&mut window), "its pane is out of sight");
    }

    #[test]
    fn the_finger_that_is_chosen_outlasts_the_link() {
        let ctx = egui::Context::default();
        let mut window = Workbench::new(&ctx, None, Drive::Stepped).unwrap();
        let mut peek = ActuatorPeek::default();
        window.dispatch(DeviceCommand::ConnectEmulator.into());
        peek.skin = Skin::FIRM;
        let shown = peek.look(&ctx, &mut window.bench.engine).unwrap().skin;
        assert_eq!(shown, Skin::FIRM);
        assert_eq!(
            window.bench.engine.actuators().unwrap().model().skin,
            Skin::FIRM
        );
        window.dispatch(DeviceCommand::Disconnect.into());
        assert!(peek.look(&ctx, &mut window.bench.engine).is_none());
        window.dispatch(DeviceCommand::ConnectEmulator.into());
        let shown = peek.look(&ctx, &mut window.bench.engine).unwrap().skin;
        assert_eq!(shown, Skin::FIRM);
    }

    #[test]
    fn what_is_told_is_the_codes_share_of_full_scale() {
        let mut reading = ActuatorReading::new(2);
        assert_eq!(cells(&reading, [50.0; 2]).count(), 0, "before the first");
        reading.n_ticks = 1;
        reading.codes[1] = [65_535, 13_107];
        let found: Vec<PlantCell> = cells(&reading, [50.0, 40.0]).collect();
        assert_eq!(found[1].told_um, [50.0, 8.0]);
    }
}
