//! Where textiles stand in the plot: axes over what there is, and places on the screen. Knows
//! nothing of painting.

use eframe::egui::{Pos2, Rect, pos2};

use crate::kit::widgets::axis::Axis;
use crate::tools::collection::measure::Measure;
use crate::tools::collection::state::{CollectionView, Entry};

/// Axes end on steps of this part of a decade, so that points that come later rarely move others.
const STEPS_A_DECADE: f64 = 8.0;
/// Room beyond the outermost points, as a factor and as a share of the range.
const BEYOND: f64 = 1.25;
const BESIDE: f64 = 0.06;

/// A textile in the plot.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Placed<'a> {
    /// The textile.
    pub(crate) entry: Entry<'a>,
    /// Where it stands.
    pub(crate) at: Pos2,
    /// Where it would stand without the tuning, if that is elsewhere.
    pub(crate) raw: Option<Pos2>,
}

/// The plot: where it is, and its axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plot {
    /// The part of the screen that it takes.
    pub(crate) area: Rect,
    /// The horizontal axis.
    pub(crate) x: Axis,
    /// The vertical axis.
    pub(crate) y: Axis,
}

impl Plot {
    /// Axes over all textiles of a view; `None` while none of them has both values.
    pub(crate) fn of(area: Rect, view: &CollectionView<'_>) -> Option<Self> {
        let [x, y] = &view.choice.axes;
        let tunings: &[bool] = if view.choice.is_tuned {
            &[true, false]
        } else {
            &[false]
        };
        let both = view.entries.iter().flat_map(|entry| {
            let pair = move |is_tuned: &bool| {
                Some([entry.value(x, *is_tuned)?, entry.value(y, *is_tuned)?])
            };
            tunings.iter().filter_map(pair)
        });
        let both: Vec<[f64; 2]> = both.collect();
        let ends =
            |axis: usize, measure: &Measure| ends(both.iter().map(|pair| pair[axis]), measure);
        let (mut x_ends, mut y_ends) = (ends(0, x)?, ends(1, y)?);
        if x.is_log() && y.is_log() {
            alike(area, &mut x_ends, &mut y_ends);
        }
        let axis = |measure: &Measure, [least, most]: [f64; 2]| {
            if measure.is_log() {
                Axis::log(least, most)
            } else {
                Axis::linear(least, most)
            }
        };
        Some(Self {
            area,
            x: axis(x, x_ends),
            y: axis(y, y_ends),
        })
    }

    /// The place of a pair of values.
    pub(crate) fn at(&self, [x, y]: [f64; 2]) -> Pos2 {
        let (area_x, area_y) = (self.area.x_range(), self.area.y_range());
        pos2(self.x.x(area_x, x), self.y.y(area_y, y))
    }

    /// The textiles that have both values, in the view's order.
    pub(crate) fn placed<'a>(&self, view: &CollectionView<'a>) -> Vec<Placed<'a>> {
        let [x, y] = &view.choice.axes;
        let is_tuned = view.choice.is_tuned;
        let placed = |entry: &Entry<'a>| {
            let pair = |is_tuned| Some([entry.value(x, is_tuned)?, entry.value(y, is_tuned)?]);
            let at = self.at(pair(is_tuned)?);
            let raw = pair(false).map(|raw| self.at(raw));
            Some(Placed {
                entry: *entry,
                at,
                raw: raw.filter(|raw| is_tuned && raw.distance(at) > 1.0),
            })
        };
        view.entries.iter().filter_map(placed).collect()
    }
}

/// The ends of an axis over some values; `None` without any.
fn ends(values: impl Iterator<Item = f64>, measure: &Measure) -> Option<[f64; 2]> {
    let [least, most] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    });
    if !(least.is_finite() && most.is_finite()) {
        return None;
    }
    if measure.is_log() {
        let step = |value: f64, round: fn(f64) -> f64| {
            10_f64.powf(round(STEPS_A_DECADE * value.log10()) / STEPS_A_DECADE)
        };
        return Some([
            step(least / BEYOND, f64::floor),
            step(most * BEYOND, f64::ceil),
        ]);
    }
    let beside = BESIDE * (most - least).max(1e-9);
    let from_zero = least >= 0.0 && least < 0.5 * most;
    Some([if from_zero { 0.0 } else { least - beside }, most + beside])
}

/// Widens the shorter of two logarithmic axes, so that a decade is as long on both.
fn alike(area: Rect, x: &mut [f64; 2], y: &mut [f64; 2]) {
    let decades = |ends: &[f64; 2]| (ends[1] / ends[0]).log10();
    let each = [
        decades(x) / f64::from(area.width()),
        decades(y) / f64::from(area.height()),
    ];
    let most = each[0].max(each[1]);
    for (ends, length) in [(x, area.width()), (y, area.height())] {
        let missing = (most * f64::from(length) - decades(ends)) / 2.0;
        let factor = 10_f64.powf(missing.max(0.0));
        *ends = [ends[0] / factor, ends[1] * factor];
    }
}
