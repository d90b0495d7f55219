//! What a saving of any floor says of itself: the report lists them all alike.

use std::fmt::Debug;

use selvedge_render::{Counters, Rule};

/// A saving: something that is left out because nothing needs it, and how often it was.
pub(crate) trait SavingRule: Debug + Send + Sync {
    /// Who leaves it out: a floor of the program.
    fn floor(&self) -> &'static str;

    /// Its name.
    fn name(&self) -> &'static str;

    /// What is left out, one sentence.
    fn what(&self) -> &'static str;

    /// What its counter counts.
    fn unit(&self) -> &'static str;

    /// How much was left out so far.
    fn left_out(&self) -> u64;
}

/// A saving of rendering, with the counters of a run.
#[derive(Debug, Clone, Copy)]
pub(super) struct OfRendering {
    pub(super) rule: Rule,
    pub(super) counters: Counters,
}

impl SavingRule for OfRendering {
    fn floor(&self) -> &'static str {
        "render"
    }

    fn name(&self) -> &'static str {
        self.rule.name()
    }

    fn what(&self) -> &'static str {
        self.rule.what()
    }

    fn unit(&self) -> &'static str {
        self.rule.unit()
    }

    fn left_out(&self) -> u64 {
        self.rule.left_out(&self.counters)
    }
}

/// Textiles of a library that a scene never places.
#[derive(Debug, Clone, Copy)]
pub(super) struct NeverPlaced {
    pub(super) n_known: usize,
    pub(super) n_placed: usize,
}

impl SavingRule for NeverPlaced {
    fn floor(&self) -> &'static str {
        "scene"
    }

    fn name(&self) -> &'static str {
        "never placed"
    }

    fn what(&self) -> &'static str {
        "A textile that the scene does not place is never read."
    }

    fn unit(&self) -> &'static str {
        "textiles"
    }

    fn left_out(&self) -> u64 {
        self.n_known.saturating_sub(self.n_placed) as u64
    }
}
