//! Table: powers tabulated over log speed when a scene is prepared, interpolated in every tick.
//!
//! A power of a point, a direction and a band is smooth between the speeds at which a bin crosses
//! 1 kHz and jumps there; tables are cut at those speeds and keep both values. Inside, linear
//! interpolation over log speed keeps within an error known from the filter alone.

mod build;
mod cache;
mod grid;
mod segments;
mod stored;
mod touched;

pub use cache::TableCache;
pub(super) use grid::Grid;
pub(super) use touched::{MAX_TABLE_BYTES, table_bytes};

use std::sync::Arc;

use super::ErrorBound;
use crate::plan::{Axis, Contacts, Counters, Feel, Motion, PointIndex, ScenePlan, TextilePlan};
use crate::{RenderError, RenderScene, single};
use grid::MIN_POWER_GAIN;
use segments::{Segments, Spot};
use stored::Table;
use touched::{Heard, TouchedTables};

/// Points of a direction up to this many times the contactors are interpolated all at once.
const BLEND_ALL: usize = 2;

/// Looks powers up.
#[derive(Debug, Clone)]
pub(super) struct TableEvaluator {
    segments: Arc<Segments>,
    tables: Vec<Arc<Table>>,
    /// What each textile's powers are stored as a share of, as an amplitude, µm.
    unit_um: Vec<f64>,
    /// Both directions' powers of every point at the speed at hand.
    blended: [Vec<[f32; 2]>; 2],
    /// In place of the tables of areal spectra.
    touched: Option<Box<TouchedTables>>,
}

impl TableEvaluator {
    pub(super) fn prepare(
        scene: &RenderScene,
        plan: &ScenePlan,
        grid: &Grid,
        cache: &mut TableCache,
    ) -> Result<(Self, ErrorBound), RenderError> {
        let n_bytes = table_bytes(plan, grid);
        if n_bytes > MAX_TABLE_BYTES {
            let megabytes = n_bytes / 1_000_000;
            return Err(RenderError::TableTooLarge { megabytes });
        }
        let (tables, units_um2) = cache.tables(plan, &scene.filters, grid);
        let is_areal = plan.pool.iter().any(|spectra| spectra.is_areal());
        let touched = is_areal.then(|| {
            let prepared: usize = tables.iter().map(|table| table.n_bytes()).sum();
            let gains = cache.node_gains(&scene.filters, grid);
            let n_bytes = n_bytes.saturating_sub(prepared);
            Box::new(TouchedTables::new(plan, &units_um2, gains, n_bytes))
        });
        let longest = tables.iter().map(|table| table.n_points.max(1)).max();
        let longest = longest.unwrap_or(1);
        let unit_um = |textile: &TextilePlan| units_um2[textile.spectra[0]].sqrt();
        let evaluator = Self {
            segments: Arc::clone(&grid.segments),
            unit_um: plan.textiles.iter().map(unit_um).collect(),
            blended: [vec![[0.0; 2]; longest], vec![[0.0; 2]; longest]],
            tables,
            touched,
        };
        let bound = ErrorBound {
            level_db: grid.density.level_db,
            floor: MIN_POWER_GAIN.sqrt(),
        };
        Ok((evaluator, bound))
    }

    /// Bytes of its tables.
    pub(super) fn n_bytes(&self) -> usize {
        let prepared: usize = self.tables.iter().map(|table| table.n_bytes()).sum();
        let touched = self.touched.as_ref().map_or(0, |touched| touched.n_bytes());
        prepared + touched
    }

    /// Amplitudes of the contactors on one textile, µm.
    pub(super) fn evaluate(
        &mut self,
        plan: &ScenePlan,
        contacts: &Contacts<'_>,
        factors: [f64; 2],
        amplitudes_um: &mut [[f32; 2]],
        counters: &mut Counters,
    ) {
        let textile = &plan.textiles[contacts.textile];
        let unit_um = self.unit_um[contacts.textile];
        match contacts.motion {
            Motion::Together(_) => self.together(textile, contacts, amplitudes_um, counters),
            Motion::Turning(..) => self.turning(textile, contacts, amplitudes_um, counters),
        }
        let [low_factor, high_factor] = factors.map(|factor| single(factor * unit_um));
        contacts.for_each_owned(amplitudes_um, |_, [low, high]| {
            *low = low.sqrt() * low_factor;
            *high = high.sqrt() * high_factor;
        });
    }

    /// Powers of contactors that share a velocity: a direction's speed is looked up once, and its
    /// powers are interpolated at all points if these are few.
    fn together(
        &mut self,
        textile: &TextilePlan,
        contacts: &Contacts<'_>,
        powers: &mut [[f32; 2]],
        counters: &mut Counters,
    ) {
        let n = contacts.n_contactors;
        let mut points = [PointIndex::new(1); 2];
        let mut heard = [None; 2];
        for axis in Axis::BOTH {
            self.blended[axis as usize][0] = [0.0; 2];
            let felt = contacts.felt(axis, 0, n as u64, counters);
            let Some((d, speed_mm_per_s)) = felt else {
                continue;
            };
            let spot = self.segments.find(speed_mm_per_s);
            counters.speeds_repeated += n as u64 - 1;
            heard[axis as usize] = self.heard_areally(textile, d, spot);
            if heard[axis as usize].is_some() {
                counters.directions_evaluated += n as u64;
                continue;
            }
            let table = &self.tables[textile.spectra[d]];
            let rows = table.rows(spot);
            if table.n_points <= BLEND_ALL * n {
                rows.blend(&mut self.blended[axis as usize]);
                points[axis as usize] = textile.points[d].along;
                counters.directions_evaluated += table.n_points.min(n) as u64;
                counters.directions_repeated += n.saturating_sub(table.n_points) as u64;
            } else {
                let places_mm = contacts.places_mm[axis as usize];
                let points = textile.points[d].along;
                contacts.for_each_owned(powers, |contactor, power| {
                    add(power, rows.at(points.nearest(places_mm[contactor])));
                });
                counters.directions_evaluated += n as u64;
            }
        }
        if let Some(touched) = &mut self.touched {
            touched.add_all(heard, contacts, powers, counters);
            if heard.iter().all(Option::is_some) {
                return;
            }
        }
        let [warp, weft] = [&self.blended[0][..], &self.blended[1][..]];
        contacts.for_each_placed(powers, |[u_mm, w_mm], power| {
            add(power, warp[points[0].nearest(u_mm)]);
            add(power, weft[points[1].nearest(w_mm)]);
        });
    }

    /// What is heard of an areal surface in a direction; `None` of any other.
    #[inline]
    fn heard_areally(&self, textile: &TextilePlan, d: usize, spot: Spot) -> Option<Heard> {
        let (spectra, points) = (textile.spectra[d], textile.points[d]);
        let is_areal = self.touched.as_ref().is_some_and(|t| t.has(spectra));
        is_areal.then_some(Heard {
            spectra,
            points,
            spot,
        })
    }

    #[inline]
    fn look_up(&mut self, feel: Feel, counters: &mut Counters) -> [f32; 2] {
        let spot = self.segments.find(feel.speed_mm_per_s);
        match &mut self.touched {
            Some(touched) if touched.has(feel.spectra) => {
                touched.at((feel.spectra, feel.point), spot, counters)
            }
            _ => self.tables[feel.spectra].rows(spot).at(feel.point),
        }
    }

    /// Powers of contactors that each move their own way.
    fn turning(
        &mut self,
        textile: &TextilePlan,
        contacts: &Contacts<'_>,
        powers: &mut [[f32; 2]],
        counters: &mut Counters,
    ) {
        contacts.for_each_owned(powers, |contactor, power| {
            for axis in Axis::BOTH {
                let Some(feel) = contacts.feel(textile, axis, contactor, counters) else {
                    continue;
                };
                add(power, self.look_up(feel, counters));
                counters.directions_evaluated += 1;
            }
        });
    }
}

#[inline]
fn add(power: &mut [f32; 2], [low, high]: [f32; 2]) {
    power[0] += low;
    power[1] += high;
}
