//! What a picture and turned ones all show, cut alike: one brightness with several views.

use super::super::PictureError;
use super::super::analysis::Found;
use super::super::brightness::Brightness;
use super::super::light::mean_and_variance;
use super::super::shading::{Light, Turns, View};
use super::Turned;
use selvedge_foundation::numerics::Grid;

impl Brightness {
    /// The same of what a picture and turned ones all show, as bright in each on the mean.
    ///
    /// # Errors
    /// All together show too little.
    pub fn of_turned(
        luminance: &Grid<f64>,
        turned: &[Turned],
        found: Option<&Found>,
    ) -> Result<Self, PictureError> {
        let region = Turned::common(turned)?;
        let angle_rad = found.map_or(0.0, Found::turn_rad);
        let cut = |whole: &Grid<f64>| {
            let part = whole.part(region);
            Self::of_picture(part.as_ref().unwrap_or(whole), angle_rad)
        };
        let mut first = cut(luminance);
        let (level, _) = mean_and_variance(&first.values);
        for one in turned {
            let values = cut(&one.luminance).values;
            let factor = level / mean_and_variance(&values).0.max(f64::MIN_POSITIVE);
            let values = values.map(|value| (value * factor).clamp(0.0, 1.0));
            first.turned.push((values, one.map.turn_deg()));
        }
        Ok(first)
    }

    /// Itself and the turned ones under a light on the first picture.
    pub(crate) fn views(&self, on_picture: Light) -> Vec<View<'_>> {
        let first = (&self.values, self.light(on_picture));
        let others = self.turned.iter().map(|(values, turn_deg)| {
            let light = on_picture.turned(-turn_deg);
            (values, self.light(light))
        });
        std::iter::once(first).chain(others).collect()
    }

    /// What turned pictures say of the lamp; `None` of a single one.
    pub(crate) fn turns(&self) -> Option<Turns> {
        let others = self.turned.iter().map(|(values, turn)| (values, *turn));
        let pictures: Vec<_> = std::iter::once((&self.values, 0.0)).chain(others).collect();
        (pictures.len() > 1).then(|| Turns::of(&pictures))
    }
}
