//! What is chosen of a stylus with sliders, and whether that can be held: asked before it is
//! applied.

use crate::kit::widgets::scale::{Curve, Scale};
pub(crate) use selvedge_render::stylus::StylusSettings;

/// A number that is chosen with a slider.
pub(crate) struct Dial {
    pub(crate) name: &'static str,
    pub(crate) scale: Scale,
    pub(crate) tip: &'static str,
    /// Where it stands in the settings.
    pub(crate) field: fn(&mut StylusSettings) -> &mut f64,
}

/// The row that does nothing where the force acts at all times.
pub(crate) const DELAY: &str = "Delay";
/// Stiffnesses of the slider and of the map, N/m.
pub(crate) const STIFFNESSES: [f64; 2] = [10.0, 1e5];
/// Dampings of the map, N·s/m.
pub(crate) const DAMPINGS: [f64; 2] = [0.1, 1e3];

/// A slider over decades that ends above zero.
const fn decades(
    ends: [f64; 2],
    decades: f64,
    resting: f64,
    (decimals, unit): (usize, &'static str),
) -> Scale {
    Scale {
        curve: Curve::Decades(decades),
        ..Scale::even(ends, resting, 0.01, (decimals, unit))
    }
}

const fn dial(
    name: &'static str,
    scale: Scale,
    tip: &'static str,
    field: fn(&mut StylusSettings) -> &mut f64,
) -> Dial {
    Dial {
        name,
        scale,
        tip,
        field,
    }
}

/// All of them, in the order of their rows.
pub(crate) const DIALS: [Dial; 9] = [
    dial(
        "Stiffness K",
        decades(STIFFNESSES, 4.0, 1000.0, (0, "N/m")),
        "How stiffly the surface pushes back; the mark is the largest that can be held",
        |settings| &mut settings.stiffness_n_per_m,
    ),
    dial(
        "Damping B",
        decades([0.0, 1000.0], 4.0, 5.0, (1, "N·s/m")),
        "What the surface takes of motion into and out of it",
        |settings| &mut settings.damping_n_s_per_m,
    ),
    dial(
        "Rate",
        decades([250.0, 40_000.0], 2.204_12, 1000.0, (0, "Hz")),
        "Steps a second, or ticks of the controller",
        |settings| &mut settings.rate_hz,
    ),
    dial(
        DELAY,
        Scale::even([0.0, 20.0], 0.0, 1.0, (0, "ticks")),
        "By how many ticks a sampled force is late",
        |settings| &mut settings.delay_ticks,
    ),
    dial(
        "Tip radius",
        decades([0.02, 2.0], 2.0, 0.5, (2, "mm")),
        "Valleys narrower than the ball at the tip are not felt",
        |settings| &mut settings.radius_mm,
    ),
    dial(
        "Mass",
        Scale {
            factor: 1000.0,
            ..decades([0.001, 1.0], 3.0, 0.075, (0, "g"))
        },
        "What moves with the tip",
        |settings| &mut settings.mass_kg,
    ),
    dial(
        "Device b",
        decades([0.0, 10.0], 3.0, 0.5, (2, "N·s/m")),
        "The device's own damping: what a sampled wall is held by",
        |settings| &mut settings.own_damping_n_s_per_m,
    ),
    dial(
        "Hand",
        decades([0.1, 10.0], 2.0, 0.3, (1, "N")),
        "With what force the hand presses down",
        |settings| &mut settings.press_n,
    ),
    dial(
        "Drive",
        decades([1.0, 1e4], 4.0, 200.0, (0, "µm/N")),
        "What a N of its vibration drives a device with, before gains and limits",
        |settings| &mut settings.um_per_n,
    ),
];

/// The same within the ends of every slider; what is no number is as at first.
fn within(mut settings: StylusSettings) -> StylusSettings {
    for dial in &DIALS {
        let value = (dial.field)(&mut settings);
        if value.is_nan() {
            *value = dial.scale.resting;
        }
        *value = value.clamp(dial.scale.least, dial.scale.most);
    }
    settings.delay_ticks = settings.delay_ticks.round();
    settings
}

/// The settings in force, and those that nobody has confirmed.
#[derive(Debug, Clone, Default)]
pub(crate) struct Chosen {
    pub(crate) applied: StylusSettings,
    /// What was asked for and cannot be held, and why.
    pub(crate) asked: Option<(StylusSettings, String)>,
}

impl Chosen {
    /// What the rows show: what was asked for last.
    pub(crate) fn shown(&self) -> StylusSettings {
        self.asked
            .as_ref()
            .map_or(self.applied, |(asked, _)| *asked)
    }

    /// Takes up what was kept: what cannot be held waits, whether it was applied or asked for.
    pub(crate) fn take_up(&mut self, applied: StylusSettings, asked: Option<StylusSettings>) {
        for settings in [Some(applied), asked].into_iter().flatten() {
            self.ask(within(settings));
        }
    }

    /// Applies settings that can be held; others wait for [`Self::confirm`].
    pub(crate) fn ask(&mut self, settings: StylusSettings) {
        // What was confirmed once is not asked for again.
        self.asked = if settings == self.applied {
            None
        } else {
            settings.warning().map(|why| (settings, why))
        };
        if self.asked.is_none() {
            self.applied = settings;
        }
    }

    /// Applies what waits although it cannot be held.
    pub(crate) fn confirm(&mut self) {
        if let Some((asked, _)) = self.asked.take() {
            self.applied = asked;
        }
    }
}
