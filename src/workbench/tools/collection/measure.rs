//! What an axis can show of a textile: its name, its unit, and its value where there is one.

use crate::bench::view::LibraryEntry;
use crate::tools::collection::measuring::Figures;
use selvedge_foundation::quantity::factor_of_gain;
use selvedge_textile::tactile::Band;

/// A number that textiles have.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Measure {
    /// Mean amplitude of a band at the chosen speed, µm.
    Amplitude(Band),
    /// Mean of both levels at the chosen speed, dB re 1 µm.
    Level,
    /// Coefficient of variation of a band's amplitude over all points and directions, %.
    Variation(Band),
    /// Level of the strongest direction over the weakest, dB.
    Anisotropy(Band),
    /// Mean absolute deviation of the heights, µm.
    Roughness,
    /// A figure that the manifest states, by its symbol.
    Figure(String),
}

impl Measure {
    /// What can be shown of these textiles.
    pub(crate) fn all(items: &[LibraryEntry]) -> Vec<Self> {
        let bands = |of: fn(Band) -> Self| Band::ALL.map(of);
        let mut all = bands(Self::Amplitude).to_vec();
        all.push(Self::Level);
        all.extend(bands(Self::Variation));
        all.extend(bands(Self::Anisotropy));
        all.push(Self::Roughness);
        for figure in items.iter().flat_map(|item| &item.measured) {
            let measure = Self::Figure(figure.name.clone());
            if !all.contains(&measure) {
                all.push(measure);
            }
        }
        all
    }

    /// Its name for people, without a unit.
    pub(crate) fn name(&self) -> String {
        let hz = |band: &Band| match band {
            Band::Low => "40",
            Band::High => "320",
        };
        match self {
            Self::Amplitude(band) => format!("A{}", hz(band)),
            Self::Level => "level".to_owned(),
            Self::Variation(band) => format!("variation of A{}", hz(band)),
            Self::Anisotropy(band) => format!("anisotropy of A{}", hz(band)),
            Self::Roughness => "SMD of the heights".to_owned(),
            Self::Figure(name) => format!("{name}, measured"),
        }
    }

    /// Its unit; empty where it has none.
    pub(crate) fn unit(&self, items: &[LibraryEntry]) -> &'static str {
        match self {
            Self::Amplitude(_) | Self::Roughness => "µm",
            Self::Level => "dB re 1 µm",
            Self::Variation(_) => "%",
            Self::Anisotropy(_) => "dB",
            Self::Figure(name) => {
                let mut figures = items.iter().flat_map(|item| &item.measured);
                figures
                    .find(|figure| figure.name == *name)
                    .map_or("", |figure| figure.unit)
            }
        }
    }

    /// What an axis of it is called: name and unit.
    pub(crate) fn label(&self, items: &[LibraryEntry]) -> String {
        let unit = self.unit(items);
        if unit.is_empty() {
            self.name()
        } else {
            format!("{}, {unit}", self.name())
        }
    }

    /// Whether its axis is logarithmic.
    pub(crate) fn is_log(&self) -> bool {
        matches!(self, Self::Amplitude(_))
    }

    /// The band that it is of, if it is the band's own amplitude.
    pub(crate) fn band(&self) -> Option<Band> {
        match self {
            Self::Amplitude(band) => Some(*band),
            _ => None,
        }
    }

    /// Its value for a textile, after gains in dB by band; `None` where it was not measured or has
    /// no place on the axis, as silence has none among levels.
    pub(crate) fn value(
        &self,
        item: &LibraryEntry,
        figures: Option<&Figures>,
        gains_db: [f64; 2],
    ) -> Option<f64> {
        if let Self::Figure(name) = self {
            let mut measured = item.measured.iter();
            return measured
                .find(|figure| figure.name == *name)
                .map(|figure| figure.value);
        }
        let Figures { levels, smd_um, .. } = figures?;
        let value = match self {
            Self::Amplitude(band) => {
                let b = band.index();
                let um = levels.mean_um[b] * factor_of_gain(gains_db[b]);
                return (um > 0.0 && um.is_finite()).then_some(um);
            }
            Self::Level => levels.level_db()? + 0.5 * (gains_db[0] + gains_db[1]),
            Self::Variation(band) => 100.0 * levels.cv[band.index()],
            Self::Anisotropy(band) => levels.anisotropy_db[band.index()],
            Self::Roughness => *smd_um,
            Self::Figure(_) => return None,
        };
        value.is_finite().then_some(value)
    }
}
