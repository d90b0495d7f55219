//! Table: powers tabulated over log speed, interpolated in every tick.
//!
//! Preparing sets memory aside and computes no power: nodes are made when a tick first needs them,
//! at most two for each contactor, axis and tick, and stay.
//!
//! A power of a point, a direction and a band is smooth between the speeds at which a bin crosses
//! 1 kHz and jumps there; tables are cut at those speeds and keep both values. Inside, linear
//! interpolation over log speed keeps within an error known from the filter alone.

mod grid;
mod nodes;
mod rows;
mod segments;
mod touched;

pub(super) use grid::Grid;
pub(super) use rows::RowTable;
pub(super) use touched::{MAX_TABLE_BYTES, table_bytes};

use std::sync::Arc;

use super::ErrorBound;
use crate::plan::{
    Axis, Component, Contacts, Counters, Feel, Motion, PointIndex, ScenePlan, TextilePlan,
};
use crate::{RenderError, single};
use grid::MIN_POWER_GAIN;
use nodes::NodeGains;
use segments::{Segments, Spot};
use selvedge_textile::surface::{Direction, LocalSpectra};
use selvedge_textile::tactile::Filters;
use touched::{Heard, TouchedTables};

/// Points of a direction up to this many times the contactors are interpolated all at once.
const BLEND_ALL: usize = 2;

/// Looks powers up.
#[derive(Debug, Clone)]
pub(super) struct TableEvaluator {
    segments: Arc<Segments>,
    gains: NodeGains,
    /// By place in the pool; `None` for spectra with many points.
    tables: Vec<Option<RowTable>>,
    /// What each textile's powers are stored as a share of, as an amplitude, µm.
    unit_um: Vec<f64>,
    /// Both directions' powers of every point at the speed at hand.
    blended: [Vec<[f32; 2]>; 2],
    /// In place of the tables of spectra with many points.
    touched: Option<Box<TouchedTables>>,
}

impl TableEvaluator {
    pub(super) fn prepare(
        filters: &Filters,
        plan: &ScenePlan,
        grid: &Grid,
    ) -> Result<(Self, ErrorBound), RenderError> {
        let n_bytes = table_bytes(plan, grid);
        if n_bytes > MAX_TABLE_BYTES {
            let megabytes = n_bytes / 1_000_000;
            return Err(RenderError::TableTooLarge { megabytes });
        }
        let (units_um2, n_nodes) = (units_um2(plan), grid.segments.nodes().len());
        let table = |(spectra, unit_um2): (&Arc<LocalSpectra>, &f64)| {
            RowTable::suits(spectra).then(|| RowTable::new(spectra, *unit_um2, n_nodes))
        };
        let tables: Vec<_> = plan.pool.iter().zip(&units_um2).map(table).collect();
        let of_few: usize = tables.iter().flatten().map(RowTable::n_bytes).sum();
        let touched = tables.iter().any(Option::is_none).then(|| {
            let n_bytes = n_bytes.saturating_sub(of_few);
            Box::new(TouchedTables::new(plan, &units_um2, n_nodes, n_bytes))
        });
        let longest = tables.iter().flatten().map(|table| table.n_points).max();
        let longest = longest.unwrap_or(1);
        let unit_um = |textile: &TextilePlan| units_um2[textile.spectra[0]].sqrt();
        let evaluator = Self {
            segments: Arc::clone(&grid.segments),
            gains: NodeGains::new(&grid.segments, filters),
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

    /// Bytes set aside.
    pub(super) fn n_bytes(&self) -> usize {
        let of_few: usize = self.tables.iter().flatten().map(RowTable::n_bytes).sum();
        let touched = self.touched.as_ref().map_or(0, |touched| touched.n_bytes());
        of_few + touched + self.gains.n_bytes()
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
            Motion::Turning(warp, weft) => {
                let each = (contacts, [warp, weft]);
                self.turning(textile, each, amplitudes_um, counters);
            }
        }
        // A gain of many hundred dB must not make a number of silence: 0 · ∞ is none.
        let [low_factor, high_factor] =
            factors.map(|factor| single(factor * unit_um).min(f32::MAX));
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
            heard[axis as usize] = self.heard_by_point(textile, d, spot);
            if heard[axis as usize].is_some() {
                counters.directions_evaluated += n as u64;
                continue;
            }
            let Some(table) = &mut self.tables[textile.spectra[d]] else {
                continue;
            };
            let n_points = table.n_points;
            let rows = table.rows(spot, (&mut self.gains, counters));
            if n_points <= BLEND_ALL * n {
                rows.blend(&mut self.blended[axis as usize]);
                points[axis as usize] = textile.points[d].along;
                counters.directions_evaluated += n_points.min(n) as u64;
                counters.directions_repeated += n.saturating_sub(n_points) as u64;
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
            touched.add_all(heard, contacts, powers, (&mut self.gains, counters));
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

    /// What is heard in a direction of a surface with many points; `None` of any other.
    #[inline]
    fn heard_by_point(&self, textile: &TextilePlan, d: usize, spot: Spot) -> Option<Heard> {
        let (spectra, points) = (textile.spectra[d], textile.points[d]);
        self.tables[spectra].is_none().then_some(Heard {
            spectra,
            points,
            spot,
        })
    }

    /// Powers of contactors that each move their own way.
    fn turning(
        &mut self,
        textile: &TextilePlan,
        (contacts, along_mm_per_s): (&Contacts<'_>, [&[f64]; 2]),
        powers: &mut [[f32; 2]],
        counters: &mut Counters,
    ) {
        for axis in Axis::BOTH {
            let directions = [false, true].map(|is_reverse| axis.direction(is_reverse).index());
            if directions
                .iter()
                .all(|d| self.tables[textile.spectra[*d]].is_some())
            {
                let moving = (axis, along_mm_per_s[axis as usize]);
                self.turning_over_rows(textile, (contacts, moving), powers, counters);
                continue;
            }
            contacts.for_each_owned(powers, |contactor, power| {
                if let Some(feel) = contacts.feel(textile, axis, contactor, counters) {
                    add(power, self.look_up(feel, counters));
                    counters.directions_evaluated += 1;
                }
            });
        }
    }

    fn look_up(&mut self, feel: Feel, counters: &mut Counters) -> [f32; 2] {
        let spot = self.segments.find(feel.speed_mm_per_s);
        let making = (&mut self.gains, counters);
        match (&mut self.tables[feel.spectra], &mut self.touched) {
            (Some(table), _) => table.rows(spot, making).at(feel.point),
            (None, Some(touched)) => touched.at((feel.spectra, feel.point), spot, making),
            (None, None) => [0.0; 2],
        }
    }

    /// The powers along an axis where both its directions have tables of rows: a loop over numbers
    /// that lie beside each other, with nothing to be asked that all contactors share.
    fn turning_over_rows(
        &mut self,
        textile: &TextilePlan,
        (contacts, moving): (&Contacts<'_>, (Axis, &[f64])),
        powers: &mut [[f32; 2]],
        counters: &mut Counters,
    ) {
        let directions = [false, true].map(|is_reverse| {
            let d = moving.0.direction(is_reverse).index();
            (textile.spectra[d], textile.points[d].along)
        });
        let (mut n_felt, mut n_at_rest, mut n_too_fast) = (0, 0, 0);
        contacts.for_each_moving(moving, powers, |place_mm, component_mm_per_s, power| {
            let (speed_mm_per_s, is_reverse) = match Component::of(component_mm_per_s) {
                Component::Felt {
                    speed_mm_per_s,
                    is_reverse,
                } => (speed_mm_per_s, is_reverse),
                Component::AtRest => return n_at_rest += 1,
                Component::TooFast => return n_too_fast += 1,
            };
            let (spectra, points) = directions[usize::from(is_reverse)];
            if let Some(table) = &mut self.tables[spectra] {
                let spot = self.segments.find(speed_mm_per_s);
                let making = (&mut self.gains, &mut *counters);
                table.add_at(points.nearest(place_mm), spot, making, power);
            }
            n_felt += 1;
        });
        counters.directions_evaluated += n_felt;
        counters.directions_at_rest += n_at_rest;
        counters.directions_over_speed += n_too_fast;
    }
}

/// What the powers of each set of spectra are stored as a share of, µm²: the largest power of any
/// point of the surfaces that use it, so that very low and very high surfaces keep all digits.
/// 0 for flat ones.
fn units_um2(plan: &ScenePlan) -> Vec<f64> {
    let own = |spectra: &Arc<LocalSpectra>| spectra.largest_um2();
    let own: Vec<f64> = plan.pool.iter().map(own).collect();
    let mut units = own.clone();
    // A surface's four directions share a unit, because their powers are added.
    for textile in &plan.textiles {
        let unit = textile.spectra.iter().map(|&s| own[s]).fold(0.0, f64::max);
        for d in Direction::ALL {
            units[textile.spectra[d.index()]] = unit;
        }
    }
    units
}

#[inline]
fn add(power: &mut [f32; 2], [low, high]: [f32; 2]) {
    power[0] += low;
    power[1] += high;
}
