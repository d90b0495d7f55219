//! What to do about a band that is too wide, by what makes it wide for the picture at hand.

use super::super::height_scale::HeightScale;
use super::{Ensemble, Lamp, Member};
use crate::manifest::Uncertainty;

impl Ensemble {
    /// What to do about a band that is too wide, by what makes it wide for this picture.
    pub(super) fn advice(&self, levels: &[[f64; 4]], scale: HeightScale) -> Option<String> {
        let band = Uncertainty {
            levels: levels.to_vec(),
            ..Uncertainty::default()
        };
        let [hz, deg, low, high] = band.too_wide()?;
        let way = if deg < 45.0 { "warp" } else { "weft" };
        let b = usize::from(hz > 100.0);
        let level = |member: &Member| member.levels_db[usize::from(deg >= 45.0)][b];
        let members = self.members.iter();
        let (shaded, deep): (Vec<&Member>, Vec<&Member>) = members.partition(|one| one.is_shaded());
        let [deep, deep_spread] = mean_and_variance(&deep, level);
        let [shade, spread] = mean_and_variance(&shaded, level);
        let p = self.belief_in_shading();
        let between = p * (1.0 - p) * (shade - deep).powi(2);
        let within = p * spread + (1.0 - p) * deep_spread;
        let percent = 100.0 * p;
        let why = if between > within {
            format!(
                "shading and dark-is-deep both explain this picture ({percent:.0} % to {:.0} %) \
                 and differ by {:.0} dB",
                100.0 - percent,
                (shade - deep).abs()
            )
        } else if self.lamp == Lamp::Unknown {
            "the light is not known, and lights from several sides explain this picture".to_owned()
        } else {
            "the light leaves that much open on this picture".to_owned()
        };
        let lamp = if self.lamp == Lamp::Unknown {
            "the light (--light), "
        } else {
            ""
        };
        let smd = match scale {
            HeightScale::SmdUm(_) => "",
            _ => "the SMD (--smd-um), ",
        };
        Some(format!(
            "A{hz} along the {way} may lie {} dB from what is felt: {why}; \
             give {lamp}{smd}a stroke of the tester, or further pictures of it, turned (--turned)",
            Uncertainty::range_words([low, high])
        ))
    }
}

/// Weighted mean and variance of a level, dB.
fn mean_and_variance(members: &[&Member], level: impl Fn(&Member) -> f64) -> [f64; 2] {
    let sum = |of: &dyn Fn(&Member) -> f64| -> f64 {
        members.iter().map(|one| one.weight * of(one)).sum()
    };
    let all = sum(&|_| 1.0).max(f64::MIN_POSITIVE);
    let mean = sum(&level) / all;
    [mean, sum(&|one| (level(one) - mean).powi(2)) / all]
}
