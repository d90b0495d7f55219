//! Which textiles are listed, and in which order.

use std::cmp::Ordering;

use crate::bench::view::LibraryEntry;
use crate::tools::collection::measure::Measure;
use crate::tools::collection::state::Entry;
use selvedge_textile::tactile::Band;

/// Which textiles are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Only {
    /// All of them.
    #[default]
    All,
    /// Those of a construction, as files spell it.
    Construction(&'static str),
    /// Those of a weave or a knit.
    Structure(&'static str),
}

impl Only {
    /// What can be chosen among these textiles: constructions, then weaves and knits, in the order
    /// in which they first come.
    pub(crate) fn all(items: &[LibraryEntry]) -> Vec<Self> {
        let constructions = items.iter().map(|item| item.construction);
        let named = constructions.filter(|word| !word.is_empty());
        let structures = items.iter().filter_map(|item| item.structure);
        let mut all = vec![Self::All];
        for only in named
            .map(Self::Construction)
            .chain(structures.map(Self::Structure))
        {
            if !all.contains(&only) {
                all.push(only);
            }
        }
        all
    }

    /// Its name for people.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::All => "all kinds",
            Self::Construction(word) | Self::Structure(word) => word,
        }
    }

    /// Whether a textile is one of them.
    pub(crate) fn takes(self, item: &LibraryEntry) -> bool {
        match self {
            Self::All => true,
            Self::Construction(word) => item.construction == word,
            Self::Structure(word) => item.structure == Some(word),
        }
    }
}

/// What textiles are ordered by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum SortBy {
    /// The library's own order.
    #[default]
    Library,
    /// Name.
    Name,
    /// Mean amplitude of a band.
    Amplitude(Band),
    /// Level.
    Level,
    /// Mean absolute deviation of height.
    Roughness,
    /// How they are made, and of what.
    Kind,
}

/// An order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Sort {
    /// By what.
    pub by: SortBy,
    /// From the largest down.
    pub is_falling: bool,
}

impl Sort {
    /// The order after its heading was clicked: rising first, then falling, then the library's.
    pub(crate) fn after(self, by: SortBy) -> Self {
        match (self.by == by, self.is_falling) {
            (false, _) => Self {
                by,
                is_falling: false,
            },
            (true, false) => Self {
                by,
                is_falling: true,
            },
            (true, true) => Self::default(),
        }
    }

    /// Puts textiles in order; of equals the library's stays, and those without a value come last.
    pub(crate) fn order(self, entries: &mut [Entry<'_>], is_tuned: bool) {
        let numbers = |measure: Measure| {
            move |one: &Entry<'_>, other: &Entry<'_>| {
                let [one, other] = [one, other].map(|entry| entry.value(&measure, is_tuned));
                self.numbered(one, other)
            }
        };
        let words = |text: fn(&LibraryEntry) -> String| {
            move |one: &Entry<'_>, other: &Entry<'_>| {
                let order = text(one.item).cmp(&text(other.item));
                self.turned(order)
            }
        };
        match self.by {
            SortBy::Library => {}
            SortBy::Name => entries.sort_by(words(|item| item.name.to_lowercase())),
            SortBy::Kind => entries.sort_by(words(|item| item.kind.to_lowercase())),
            SortBy::Amplitude(band) => entries.sort_by(numbers(Measure::Amplitude(band))),
            SortBy::Level => entries.sort_by(numbers(Measure::Level)),
            SortBy::Roughness => {
                entries.sort_by(|one, other| {
                    let [one, other] = [one, other].map(|entry| smd_um(entry).0);
                    self.numbered(one, other)
                });
            }
        }
    }

    fn turned(self, order: Ordering) -> Ordering {
        if self.is_falling {
            order.reverse()
        } else {
            order
        }
    }

    fn numbered(self, one: Option<f64>, other: Option<f64>) -> Ordering {
        match (one, other) {
            (Some(one), Some(other)) => self.turned(one.total_cmp(&other)),
            (Some(_), None) => Ordering::Less,
            (None, Some(_)) => Ordering::Greater,
            (None, None) => Ordering::Equal,
        }
    }
}

/// The SMD of a textile, µm, and whether its manifest states it; else it is that of the heights.
pub(crate) fn smd_um(entry: &Entry<'_>) -> (Option<f64>, bool) {
    let measured = entry.value(&Measure::Figure("SMD".to_owned()), false);
    let of_heights = || entry.value(&Measure::Roughness, false);
    (measured.or_else(of_heights), measured.is_some())
}
