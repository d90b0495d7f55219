//! What can be drawn over the cloth in the workspace, and what of it is.

use selvedge_textile::tactile::Band;

/// Something that is drawn over the cloth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Overlay {
    /// The points of the profiles, 1 mm apart.
    Points,
    /// The points that the contactors read.
    ChosenPoints,
    /// How the contactors move, and along which directions that is felt.
    Motion,
    /// The amplitude of a band that textiles would give all over at the chosen velocity.
    Map(Band),
}

/// What is drawn over the cloth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Overlays {
    points: bool,
    chosen_points: bool,
    motion: bool,
    /// The band whose map is drawn.
    pub(crate) map: Option<Band>,
}

/// What settings call each overlay, in the order of [`Overlays::ALL`].
const WORDS: [&str; 5] = [
    "points",
    "chosen points",
    "motion",
    "map 40 Hz",
    "map 320 Hz",
];

impl Overlays {
    /// Every overlay with its name, in the order in which they are offered.
    pub(crate) const ALL: [(Overlay, &'static str); 5] = [
        (Overlay::Points, "Points, 1 mm apart"),
        (Overlay::ChosenPoints, "Points that contactors read"),
        (Overlay::Motion, "Velocities and directions"),
        (Overlay::Map(Band::Low), "Map of 40 Hz"),
        (Overlay::Map(Band::High), "Map of 320 Hz"),
    ];

    /// With one more or less; of the maps one at a time.
    pub(crate) fn toggled(mut self, overlay: Overlay) -> Self {
        match overlay {
            Overlay::Points => self.points = !self.points,
            Overlay::ChosenPoints => self.chosen_points = !self.chosen_points,
            Overlay::Motion => self.motion = !self.motion,
            Overlay::Map(band) => self.map = (self.map != Some(band)).then_some(band),
        }
        self
    }

    /// Whether it is drawn.
    pub(crate) fn shows(self, overlay: Overlay) -> bool {
        match overlay {
            Overlay::Points => self.points,
            Overlay::ChosenPoints => self.chosen_points,
            Overlay::Motion => self.motion,
            Overlay::Map(band) => self.map == Some(band),
        }
    }

    /// Whether anything is drawn that needs to know what contactors read.
    pub(crate) fn need_readings(self) -> bool {
        self.chosen_points || self.motion
    }

    /// What settings keep.
    pub(crate) fn words(self) -> Vec<String> {
        let named = Self::ALL.into_iter().zip(WORDS);
        let shown = named.filter(|((overlay, _), _)| self.shows(*overlay));
        shown.map(|(_, word)| word.to_owned()).collect()
    }

    /// What settings kept; `None` when a word is not known.
    pub(crate) fn from_words(words: &[String]) -> Option<Self> {
        words.iter().try_fold(Self::default(), |overlays, word| {
            let place = WORDS.iter().position(|known| known == word)?;
            let (overlay, _) = Self::ALL[place];
            let is_new = !overlays.shows(overlay);
            Some(if is_new {
                overlays.toggled(overlay)
            } else {
                overlays
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overlays_are_switched_one_by_one_and_maps_one_at_a_time() {
        let mut overlays = Overlays::default();
        for (overlay, _) in Overlays::ALL {
            assert!(!overlays.shows(overlay), "{overlay:?}");
            overlays = overlays.toggled(overlay);
            assert!(overlays.shows(overlay), "{overlay:?}");
        }
        assert_eq!(overlays.map, Some(Band::High), "the last one chosen");
        assert_eq!(overlays.toggled(Overlay::Map(Band::High)).map, None);
    }

    #[test]
    fn what_settings_keep_comes_back() {
        let mut overlays = Overlays::default();
        for (overlay, _) in Overlays::ALL {
            overlays = overlays.toggled(overlay);
            assert_eq!(Overlays::from_words(&overlays.words()), Some(overlays));
        }
        assert_eq!(Overlays::from_words(&["ghosts".to_owned()]), None);
        let twice = ["points".to_owned(), "points".to_owned()];
        assert!(Overlays::from_words(&twice).is_some_and(|o| o.shows(Overlay::Points)));
    }
}
