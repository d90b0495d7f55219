//! Banded: the formula of the reference, but only the bins that a filter can hear at this speed,
//! and nothing twice in a tick.
//!
//! A filter falls off on both sides of its peak. Bins outside the frequencies where it lets at
//! least the share `floor` of an amplitude through are left out, which takes less than
//! `floor²·2ΣP` off a squared amplitude. The filter's gains are computed once per speed.

use std::ops::Range;
use std::sync::Arc;

use super::bin_gains::{self, BinGains};
use super::reference::{amplitudes_of, evaluate_each};
use crate::plan::{Axis, Contacts, Counters, Feel, Motion, ScenePlan};
use selvedge_foundation::numerics::to_index;
use selvedge_textile::surface::{BIN_SPACING_PER_MM, LocalSpectra, N_BINS};
use selvedge_textile::tactile::{Band, Filters, MAX_FREQUENCY_HZ, n_audible_bins};

/// Sums the bins that matter, once for each point and speed.
#[derive(Debug, Clone)]
pub(super) struct BandedEvaluator {
    making: BinGains,
    pool: Vec<SpectraMemo>,
    rows: [GainRow; 2],
    tick: u64,
}

/// Spectra, and what was already evaluated of them.
#[derive(Debug, Clone)]
struct SpectraMemo {
    spectra: Arc<LocalSpectra>,
    points: Vec<Memo>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Memo {
    tick: u64,
    speed_mm_per_s: f64,
    sums: [f64; 2],
}

/// A filter pair's power gains at one speed.
#[derive(Debug, Clone)]
struct GainRow {
    speed_mm_per_s: f64,
    n_audible: usize,
    /// Slots of the bins that each band hears.
    heard: [Range<usize>; 2],
    /// By slot; 0 for a band that does not hear the bin.
    gains: Vec<[f64; 2]>,
    /// The frequencies that each band hears, Hz.
    heard_hz: [[f64; 2]; 2],
}

impl BandedEvaluator {
    pub(super) fn prepare(plan: &ScenePlan, filters: &Filters, floor: f64) -> Self {
        let memo = |spectra: &Arc<LocalSpectra>| SpectraMemo {
            spectra: Arc::clone(spectra),
            points: vec![Memo::default(); spectra.n_points()],
        };
        let heard_hz = Band::ALL.map(|band| heard_frequencies_hz(filters, band, floor));
        let row = || GainRow {
            speed_mm_per_s: 0.0,
            n_audible: 0,
            heard: [0..0, 0..0],
            gains: vec![[0.0; 2]; N_BINS],
            heard_hz,
        };
        // Without a floor nothing is left out and nothing approximated: the reference to the bit.
        let making = if floor > 0.0 {
            BinGains::new(filters)
        } else {
            BinGains::exact(filters)
        };
        Self {
            making,
            pool: plan.pool.iter().map(memo).collect(),
            rows: [row(), row()],
            tick: 0,
        }
    }

    /// Bytes of what it remembers beside the spectra.
    pub(super) fn n_bytes(&self) -> usize {
        let n_points: usize = self.pool.iter().map(|memo| memo.points.len()).sum();
        n_points * size_of::<Memo>() + 4 * N_BINS * size_of::<f64>()
    }

    pub(super) fn begin_tick(&mut self) {
        self.tick += 1;
    }

    /// Amplitudes of the contactors on one textile, µm.
    pub(super) fn evaluate(
        &mut self,
        plan: &ScenePlan,
        contacts: &Contacts<'_>,
        factors: [f64; 2],
        amplitudes_um: &mut [[f64; 2]],
        counters: &mut Counters,
    ) {
        if let Motion::Together(_) = contacts.motion {
            return self.evaluate_together(plan, contacts, factors, amplitudes_um, counters);
        }
        let sums_of = |axis, feel: Feel, counters: &mut Counters| {
            let row = &mut self.rows[axis as usize];
            row.move_to(feel.speed_mm_per_s, &mut self.making, counters);
            self.pool[feel.spectra].sums(feel.point, (self.tick, row), counters)
        };
        evaluate_each((plan, contacts), factors, amplitudes_um, counters, sums_of);
    }

    /// The same for contactors that move alike: what they share is found once,
    /// before the loop over them.
    fn evaluate_together(
        &mut self,
        plan: &ScenePlan,
        contacts: &Contacts<'_>,
        factors: [f64; 2],
        amplitudes_um: &mut [[f64; 2]],
        counters: &mut Counters,
    ) {
        let textile = &plan.textiles[contacts.textile];
        let n_contactors = contacts.n_contactors as u64;
        contacts.for_each_owned(amplitudes_um, |_, sums| *sums = [0.0; 2]);
        for axis in Axis::BOTH {
            let felt = contacts.felt(axis, 0, n_contactors, counters);
            let Some((d, speed_mm_per_s)) = felt else {
                continue;
            };
            let row = &mut self.rows[axis as usize];
            row.move_to(speed_mm_per_s, &mut self.making, counters);
            counters.speeds_repeated += n_contactors - 1;
            let (grid, memo) = (textile.points[d], &mut self.pool[textile.spectra[d]]);
            let (tick, row) = (self.tick, &*row);
            let mut n_anew = 0;
            contacts.for_each_placed(amplitudes_um, |[u_mm, w_mm], sums| {
                let point = match axis {
                    Axis::Warp => grid.nearest(u_mm, w_mm),
                    Axis::Weft => grid.nearest(w_mm, u_mm),
                };
                if !memo.points[point].is_of(tick, row) {
                    memo.remember(point, (tick, row), counters);
                    n_anew += 1;
                }
                let own = memo.points[point].sums;
                (0..2).for_each(|b| sums[b] += own[b]);
            });
            counters.directions_repeated += n_contactors - n_anew;
        }
        contacts.for_each_owned(amplitudes_um, |_, sums| {
            *sums = amplitudes_of(*sums, factors);
        });
    }
}

impl Memo {
    /// Whether it was made in this tick, at this speed.
    #[inline]
    fn is_of(&self, tick: u64, row: &GainRow) -> bool {
        self.tick == tick && self.speed_mm_per_s.to_bits() == row.speed_mm_per_s.to_bits()
    }
}

impl SpectraMemo {
    #[inline]
    fn sums(
        &mut self,
        point: usize,
        (tick, row): (u64, &GainRow),
        counters: &mut Counters,
    ) -> [f64; 2] {
        if self.points[point].is_of(tick, row) {
            counters.directions_repeated += 1;
        } else {
            self.remember(point, (tick, row), counters);
        }
        self.points[point].sums
    }

    /// Evaluates a point for the rest of the tick.
    fn remember(&mut self, point: usize, (tick, row): (u64, &GainRow), counters: &mut Counters) {
        let sums = self.sums_anew(point, row, counters);
        self.points[point] = Memo {
            tick,
            speed_mm_per_s: row.speed_mm_per_s,
            sums,
        };
    }

    /// The sums of a point that was not yet evaluated in this tick.
    #[inline(never)]
    fn sums_anew(&self, point: usize, row: &GainRow, counters: &mut Counters) -> [f64; 2] {
        let powers_um2 = self.spectra.powers_um2(point);
        // Areal spectra of a coarse map end at its Nyquist wavenumber.
        let n_bins = powers_um2.len();
        let n_audible = row.n_audible.min(n_bins);
        let heard = row.heard.clone();
        let heard = heard.map(|slots| slots.start.min(n_bins)..slots.end.min(n_bins));
        let n_heard = heard[0].len() + heard[1].len();
        let sums = row.sums(powers_um2);
        counters.directions_evaluated += 1;
        counters.bins_evaluated += n_heard as u64;
        counters.bins_below_floor += (2 * n_audible - n_heard) as u64;
        counters.bins_above_1_khz += 2 * (n_bins - n_audible) as u64;
        sums
    }
}

impl GainRow {
    /// Computes the gains at a speed, unless they are those at hand.
    #[inline]
    fn move_to(&mut self, speed_mm_per_s: f64, making: &mut BinGains, counters: &mut Counters) {
        if self.speed_mm_per_s.to_bits() == speed_mm_per_s.to_bits() {
            counters.speeds_repeated += 1;
        } else {
            self.compute(speed_mm_per_s, making);
        }
    }

    #[inline(never)]
    fn compute(&mut self, speed_mm_per_s: f64, making: &mut BinGains) {
        self.speed_mm_per_s = speed_mm_per_s;
        self.n_audible = n_audible_bins(speed_mm_per_s);
        let spacing_hz = speed_mm_per_s * BIN_SPACING_PER_MM;
        for band in Band::ALL {
            let b = band.index();
            let [low_hz, high_hz] = self.heard_hz[b];
            let first = n_bins_below(low_hz / spacing_hz).min(self.n_audible);
            let end = n_bins_below(high_hz / spacing_hz + 1.0).clamp(first, self.n_audible);
            self.heard[b] = first..end;
        }
        let slots = self.slots();
        making.fill(speed_mm_per_s, slots.start, &mut self.gains[..slots.end]);
        for (b, heard) in self.heard.iter().enumerate() {
            let unheard = (slots.start..heard.start).chain(heard.end..slots.end);
            unheard.for_each(|slot| self.gains[slot][b] = 0.0);
        }
    }

    /// The slots of the bins that a band hears.
    fn slots(&self) -> Range<usize> {
        let [low, high] = &self.heard;
        low.start.min(high.start)..low.end.max(high.end)
    }

    /// `Σ_k P_k H_b(f_k)²` for each band over the bins that it hears.
    fn sums(&self, powers_um2: &[f64]) -> [f64; 2] {
        let slots = self.slots();
        let first = slots.start.min(powers_um2.len());
        let [sums] = bin_gains::sums([&powers_um2[first..]], &self.gains[slots]);
        sums
    }
}

/// How many bins k ≥ 1 lie below a (real) bin number, at most 500.
fn n_bins_below(bin: f64) -> usize {
    to_index(bin.ceil() - 1.0).min(N_BINS)
}

/// The frequencies between which a filter lets at least the share `floor` of an amplitude through,
/// widened by a hair; by bisection on either side of the carrier, whose gain is 1.
fn heard_frequencies_hz(filters: &Filters, band: Band, floor: f64) -> [f64; 2] {
    let is_heard = |f_hz: f64| filters.power_gain(band, f_hz) >= floor * floor;
    let edge = |mut silent_hz: f64, mut heard_hz: f64| {
        if is_heard(silent_hz) {
            return silent_hz;
        }
        for _ in 0..60 {
            let middle_hz = (silent_hz * heard_hz).sqrt();
            let side = if is_heard(middle_hz) {
                &mut heard_hz
            } else {
                &mut silent_hz
            };
            *side = middle_hz;
        }
        silent_hz
    };
    let lowest_hz = 1e-3;
    let [low_hz, high_hz] = [lowest_hz, MAX_FREQUENCY_HZ].map(|end| edge(end, band.carrier_hz()));
    [
        if low_hz > lowest_hz {
            low_hz * (1.0 - 1e-12)
        } else {
            0.0
        },
        high_hz * (1.0 + 1e-12),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bin_left_out_is_below_the_floor() {
        for filters in [
            Filters::default(),
            Filters::LogGaussian { octaves: 0.5 },
            Filters::Receptor,
        ] {
            for floor in [0.0, 1e-6, 1e-3, 0.1, 0.99] {
                for band in Band::ALL {
                    let [low_hz, high_hz] = heard_frequencies_hz(&filters, band, floor);
                    for step in 0..20_000 {
                        let f_hz = 0.002_3 * 1.000_65_f64.powi(step);
                        let is_in = (low_hz..=high_hz).contains(&f_hz);
                        let gain = filters.gain(band, f_hz);
                        // At the peak of a receptor's curve the gain exceeds 1 and its fall is
                        // not always steep, so only what is left out is bounded.
                        assert!(is_in || gain < floor * (1.0 + 1e-9) || f_hz >= 1000.0);
                    }
                }
            }
        }
    }

    #[test]
    fn bins_below_a_real_bin_number_are_counted() {
        for (bin, n) in [
            (-3.0, 0),
            (0.0, 0),
            (1.0, 0),
            (1.5, 1),
            (2.0, 1),
            (1e300, 500),
        ] {
            assert_eq!(n_bins_below(bin), n, "{bin}");
        }
    }
}
