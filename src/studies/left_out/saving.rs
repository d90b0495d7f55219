//! What is left out because nothing needs it, and how much of it was.

use selvedge_render::Rule;

use crate::Row;

/// Something that is left out.
#[derive(Debug, Clone, Copy)]
pub(super) struct Saving {
    /// Who leaves it out: a floor of the program.
    pub(super) floor: &'static str,
    pub(super) name: &'static str,
    /// What is left out, one sentence.
    what: &'static str,
    /// What its counter counts.
    unit: &'static str,
    n_left_out: u64,
}

impl Saving {
    /// A rule of the renderer, without a count.
    pub(super) fn of_rendering(rule: Rule) -> Self {
        Self {
            floor: "render",
            name: rule.name(),
            what: rule.what(),
            unit: rule.unit(),
            n_left_out: 0,
        }
    }

    /// Textiles of a library that a scene never places.
    pub(super) const fn never_placed(n_left_out: u64) -> Self {
        Self {
            floor: "scene",
            name: "never placed",
            what: "A textile that the scene does not place is never read.",
            unit: "textiles",
            n_left_out,
        }
    }

    /// Glimpses that nobody asked for.
    pub(super) const fn unasked_glimpses(n_left_out: u64) -> Self {
        Self {
            floor: "engine",
            name: "unasked glimpses",
            what: "A tick leaves no glimpse for plots over time unless somebody asked for them.",
            unit: "glimpses",
            n_left_out,
        }
    }

    /// Frames that nobody would play.
    pub(super) const fn unheard_frames(n_left_out: u64) -> Self {
        Self {
            floor: "engine",
            name: "unheard frames",
            what: "Drive codes are not made unless an armed device listens.",
            unit: "frames",
            n_left_out,
        }
    }

    /// What it leaves out, in a line.
    pub(super) fn note(&self) -> String {
        format!("{}, {}: {}", self.floor, self.name, self.what)
    }

    /// The setting in which nothing else is left out.
    pub(super) fn alone(&self) -> String {
        format!("only {}", self.name)
    }

    /// It in a row of its own.
    pub(super) fn row(&self) -> Row {
        Row {
            method: self.floor.to_owned(),
            setting: self.alone(),
            more: vec![
                ("left_out_a_tick_of_all", self.n_left_out.to_string()),
                ("left_out", self.unit.to_owned()),
            ],
            ..Row::default()
        }
    }
}
