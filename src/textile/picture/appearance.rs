//! What brightness that was cut from a picture looks like: the picture's own colours.

use super::analysis::Found;
use super::brightness::Brightness;
use super::light::mean_and_variance;
use super::relief::ReliefOf;
use super::source::LUMINANCE;
use super::turned::Turned;
use selvedge_foundation::numerics::Grid;

impl Brightness {
    /// Red, green and blue of what was cut, 0…1, by the shares of red and green in the picture,
    /// grey without: point by point, or by their mean where cells were averaged or laid straight.
    pub fn colours(
        &self,
        (shares, turned): (Option<&Grid<[u16; 2]>>, &[Turned]),
        (relief_of, found): (ReliefOf, Option<&Found>),
    ) -> [Grid<f64>; 3] {
        let region = Turned::common(turned).ok().filter(|_| !turned.is_empty());
        let part = region.and_then(|region| shares?.part(region));
        let shares = part.as_ref().or(shares);
        let is_laid = turned.is_empty() && found.is_some_and(|found| found.unwarped.is_some());
        let is_straight = relief_of != ReliefOf::Cell && !is_laid;
        let channel =
            |i: usize| shares.map(|all| all.map(|share| f64::from(share[i]) / f64::from(u16::MAX)));
        let laid = |grid: Option<Grid<f64>>| {
            let grid = grid.unwrap_or_else(|| Grid::filled(1, 1, 1.0 / 3.0));
            let (mean, _) = mean_and_variance(&grid);
            let cut = Self::of_picture(&grid, self.angle_rad).values;
            let size = |grid: &Grid<f64>| (grid.width(), grid.height());
            let is_like = is_straight && size(&cut) == size(&self.values);
            if is_like {
                cut
            } else {
                self.values.map(|_| mean)
            }
        };
        let [red, green] = [0, 1].map(|i| laid(channel(i)));
        let mut all = [
            self.values.clone(),
            self.values.clone(),
            self.values.clone(),
        ];
        for (i, (r, g)) in red.values().iter().zip(green.values()).enumerate() {
            let shares = [*r, *g, 1.0 - r - g];
            let weight: f64 = shares.iter().zip(LUMINANCE).map(|(a, b)| a * b).sum();
            for (to, share) in all.iter_mut().zip(shares) {
                let value = &mut to.values_mut()[i];
                *value = (*value * share / weight.max(0.05)).clamp(0.0, 1.0);
            }
        }
        all
    }
}
