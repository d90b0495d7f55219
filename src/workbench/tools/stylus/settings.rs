//! What holds the stylus and how it is computed, and whether that can be held: asked before it is
//! applied.

pub(crate) use crate::bench::settings::stylus::StylusSettings;
use crate::kit::widgets::scale::{Curve, Scale};
use selvedge_render::contact::{
    ContactLaw, DeviceSpec, ForceParts, Hand, Sampling, Standing, StylusSetup, WallCase,
};

use super::ground::Ground;

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

impl StylusSettings {
    /// The case of a wall that this is.
    pub(crate) fn case(&self) -> WallCase {
        WallCase {
            mass_kg: self.mass_kg,
            damping_n_s_per_m: self.own_damping_n_s_per_m,
            stiffness_n_per_m: self.stiffness_n_per_m,
            wall_damping_n_s_per_m: self.damping_n_s_per_m,
            period_s: 1.0 / self.rate_hz,
            delay_ticks: self.sampling().map(|sampling| sampling.delay_ticks),
            method: self.method,
        }
    }

    fn sampling(&self) -> Option<Sampling> {
        self.is_sampled.then(|| Sampling {
            delay_ticks: selvedge_foundation::numerics::to_index(self.delay_ticks),
            is_kept_passive: false,
        })
    }

    /// The same within the ends of every slider; what is no number is as at first.
    fn within(mut self) -> Self {
        for dial in &DIALS {
            let value = (dial.field)(&mut self);
            if value.is_nan() {
                *value = dial.scale.resting;
            }
            *value = value.clamp(dial.scale.least, dial.scale.most);
        }
        self.delay_ticks = self.delay_ticks.round();
        self
    }

    /// Why it should not be applied unasked: a line with the limit; `None` if it can be held.
    pub(crate) fn warning(&self) -> Option<String> {
        let case = self.case();
        (case.standing() == Standing::Unstable).then(|| case.advice())
    }

    /// All of a run on a surface.
    pub(crate) fn setup(&self, ground: &Ground) -> StylusSetup {
        let mut contact = ground.contact.clone();
        // Numbers from the sliders are a law; any other leaves the default, which holds.
        let law = ContactLaw {
            stiffness_n_per_m: self.stiffness_n_per_m,
            damping_n_s_per_m: self.damping_n_s_per_m,
            parts: if self.is_lateral {
                ForceParts::Both
            } else {
                ForceParts::Normal
            },
            ..*contact.law()
        };
        drop(contact.set_law(law));
        StylusSetup {
            contact,
            device: DeviceSpec {
                mass_kg: self.mass_kg,
                damping_n_s_per_m: self.own_damping_n_s_per_m,
                ..DeviceSpec::default()
            },
            hand: Hand {
                press_n: self.press_n,
                leads: None,
            },
            method: self.method,
            rate_hz: self.rate_hz,
            sampling: self.sampling(),
        }
    }
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
            self.ask(settings.within());
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
