//! Whether what a design asks for can be played: levels of vibrations against what an array may.

use super::design::{Design, Source};
use selvedge_foundation::quantity::factor_of_gain;
use selvedge_textile::tactile::Band;

impl Design {
    /// The vibrations of a design that are stronger than an array may play, a line each; `limit_um`
    /// are its largest amplitudes at 40 and 320 Hz, µm.
    pub fn over_limits(&self, limit_um: [f64; 2]) -> Vec<String> {
        let limit_of = |band: Band| limit_um[usize::from(band == Band::High)];
        let stimuli = self.stimuli.iter().filter_map(|one| match one.source {
            Source::Vibration { band, level_db } => Some((one.id.clone(), band, level_db)),
            _ => None,
        });
        let adaptation = self.composition.adaptation.as_ref();
        let adaptation = adaptation.filter(|one| one.is_vibration());
        let adapted = adaptation.into_iter().flat_map(|one| {
            let [_, highest] = one.range;
            let reference = one
                .reference
                .map(|level_db| ("the reference", one.band, level_db));
            let masker_db = self.composition.presentation.masker_db;
            let masker = masker_db.map(|level_db| ("the masker", other(one.band), level_db));
            let highest = Some(("the highest level", one.band, highest));
            let all = [highest, reference, masker].into_iter().flatten();
            all.map(|(what, band, level_db)| (what.to_owned(), band, level_db))
        });
        let over = |(what, band, level_db): (String, Band, f64)| {
            let (um, limit_um) = (factor_of_gain(level_db), limit_of(band));
            (um > limit_um).then(|| {
                format!(
                    "{what}: {um:.1} µm at {} Hz, but the array may play {limit_um:.1} µm",
                    band.carrier_hz()
                )
            })
        };
        stimuli.chain(adapted).filter_map(over).collect()
    }
}

fn other(band: Band) -> Band {
    match band {
        Band::Low => Band::High,
        Band::High => Band::Low,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_stronger_than_the_array_may_play_is_named() {
        let design = |name: &str| Design::shipped(name).unwrap();
        for name in Design::shipped_names() {
            // The array that the program ships.
            assert!(design(name).over_limits([50.0; 2]).is_empty(), "{name}");
        }
        // 33 dB re 1 µm are 44.7 µm.
        let lines = design("magnitude").over_limits([40.0, 50.0]);
        assert_eq!(lines.len(), 1, "{lines:?}");
        assert!(
            lines[0].contains("40-hz-33-db: 44.7 µm at 40 Hz"),
            "{lines:?}"
        );
        let lines = (design("jnd-40")).over_limits([10.0, 50.0]);
        assert_eq!(lines.len(), 2, "{lines:?}");
    }
}
