//! What can be done in the lab.

use selvedge_foundation::files::KeyValue;
use selvedge_textile::Place;
use selvedge_textile::surface::Direction;

/// What a recipe begins with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Beginning {
    /// The example of a kind of recipe.
    Example(&'static str),
    /// A copy of the recipe of a textile of the library.
    Copy(String),
    /// What repeats in the profiles of a textile of the library.
    Restore(String),
}

/// Something that is wanted of the lab. Never part of the scene's undo.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum LabCommand {
    /// Begin with this recipe.
    Begin(Beginning),
    /// Set a parameter, or leave it out.
    Set(Place, Option<KeyValue>),
    /// Take the last change back.
    Undo,
    /// Bring it back again.
    Redo,
    /// Back to what it began with.
    Restart,
    /// Compare with this textile of the library, or with none.
    Compare(Option<String>),
    /// Look at the surface this way.
    Look(Look),
    /// Show these controls.
    Show(Page),
    /// Stop what is being computed.
    Stop,
    /// Compute what was stopped after all.
    GoOn,
    /// Try this family.
    TryFamily(Plan),
    /// Keep the recipe as a textile, and lay it under the display if it is to be felt.
    Keep {
        /// Whether it is felt at once.
        feels: bool,
    },
    /// Keep every textile of the family that was tried.
    KeepFamily,
}

/// Which controls are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Page {
    /// The parameters.
    #[default]
    Recipe,
    /// Several recipes that differ in one parameter.
    Family,
    /// How the textile is called that is kept.
    Keep,
}

impl Page {
    /// All three, with their titles.
    pub(crate) const ALL: [(Self, &'static str); 3] = [
        (Self::Recipe, "Recipe"),
        (Self::Family, "Family"),
        (Self::Keep, "Keep"),
    ];
}

/// Which stroke is looked at, and how much of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Look {
    /// The stroke.
    pub direction: Direction,
    /// Where the view begins, mm.
    pub from_mm: f64,
    /// How much of it is in sight, mm.
    pub span_mm: f64,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            direction: Direction::WarpForward,
            from_mm: 0.0,
            span_mm: 20.0,
        }
    }
}

/// A family: one parameter over several values, evenly apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Plan {
    /// The parameter.
    pub place: Place,
    /// Its first and its last value.
    pub ends: [f64; 2],
    /// How many values.
    pub n: u8,
}

impl Plan {
    /// Most textiles of a family.
    pub(crate) const MOST: u8 = 12;

    /// The values, evenly apart from end to end.
    pub(crate) fn values(&self) -> Vec<f64> {
        let n = self.n.clamp(2, Self::MOST);
        let [first, last] = self.ends;
        let share = |i: u8| f64::from(i) / f64::from(n - 1);
        let value = |i: u8| first + (last - first) * share(i);
        // Ten digits: what is evenly apart is as short in files as when it is typed.
        (0..n).map(|i| (value(i) * 1e9).round() / 1e9).collect()
    }
}
