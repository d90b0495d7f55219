//! Tables as they might have been: other densities, interpolations and digits, for the study alone.
//!
//! The product renders with [`selvedge_render::array::Method::Table`]. These share its spectra, its
//! filters and its definition of a segment, and nothing else: one textile that lies at the origin
//! and is not turned, one display that is not turned either.

use std::ops::{Add, Mul};
use std::sync::Arc;

use super::Case;
use crate::readable::whole;
use crate::{Bench, ReportError, Row};
use selvedge_foundation::geometry::Displacement;
use selvedge_render::RenderScene;
use selvedge_render::scene::Pose;
use selvedge_textile::surface::{BIN_SPACING_PER_MM, Direction, LocalSpectra, N_BINS};
use selvedge_textile::tactile::{
    Filters, MAX_FREQUENCY_HZ, MAX_SPEED_MM_PER_S, MIN_SPEED_MM_PER_S, SpeedResponse,
    n_audible_bins,
};

/// Rows of the tables that the product might have had.
pub(super) fn table_rows(bench: &mut Bench<'_>, case: &Case) -> Result<Vec<Row>, ReportError> {
    let densities = bench
        .effort
        .pick(&[2, 24, 48][..], &[2, 6, 12, 24, 48, 96][..]);
    let mut rows = Vec::new();
    for &per_octave in densities {
        bench.step(0.5, &case.name)?;
        let table = StudyTable::new(&case.scene, Nodes::new(per_octave, true), Reading::Linear);
        for reading in [Reading::Linear, Reading::Cubic] {
            rows.push(table.as_read::<f32>(reading).row(bench, case, per_octave));
            rows.push(table.as_read::<f64>(reading).row(bench, case, per_octave));
        }
    }
    let uncut = StudyTable::new(&case.scene, Nodes::new(48, false), Reading::Cubic);
    rows.push(uncut.row(bench, case, 48));
    Ok(rows)
}

/// A number as a table holds it.
pub(super) trait Digits: Copy + Add<Output = Self> + Mul<Output = Self> + Into<f64> {
    /// What it is called.
    const NAME: &'static str;
    /// The nearest to a number.
    fn of(x: f64) -> Self;
}

impl Digits for f32 {
    const NAME: &'static str = "f32";

    #[expect(clippy::cast_possible_truncation, reason = "that is the question")]
    fn of(x: f64) -> Self {
        x as Self
    }
}

impl Digits for f64 {
    const NAME: &'static str = "f64";

    fn of(x: f64) -> Self {
        x
    }
}

/// How a table is read between its nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reading {
    /// From the two nodes around.
    Linear,
    /// From the four nodes around, within the segment; from fewer where it has no four.
    Cubic,
}

impl Reading {
    /// What it is called, and the nodes that it reads.
    fn name_and_nodes(self) -> (&'static str, usize) {
        match self {
            Self::Linear => ("linear", 2),
            Self::Cubic => ("cubic", 4),
        }
    }
}

/// Nodes from one speed to another, evenly over its logarithm.
#[derive(Debug, Clone, Copy)]
struct Segment {
    start: f64,
    parts_per_octave: f64,
    n_parts: usize,
    first_node: usize,
}

/// Where nodes are: in segments by the number of bins that sound, or in one segment for all.
#[derive(Debug, Clone)]
pub(super) struct Nodes {
    segments: Vec<Segment>,
    /// Speed, and how many bins count there.
    places: Vec<(f64, usize)>,
    is_cut: bool,
}

impl Nodes {
    /// Nodes at most 1/`per_octave` octave apart. Cut, segments end where a bin crosses 1 kHz; else
    /// there is one from the lowest speed to the highest.
    pub(super) fn new(per_octave: usize, is_cut: bool) -> Self {
        let mut found = Self {
            segments: Vec::new(),
            places: Vec::new(),
            is_cut,
        };
        if is_cut {
            let at_1_khz = |k: usize| MAX_FREQUENCY_HZ / (BIN_SPACING_PER_MM * k as f64);
            for n_bins in 1..=N_BINS {
                let lowest = if n_bins == N_BINS {
                    MIN_SPEED_MM_PER_S
                } else {
                    at_1_khz(n_bins + 1)
                };
                found.add([lowest, at_1_khz(n_bins)], per_octave, Some(n_bins));
            }
        } else {
            let ends = [MIN_SPEED_MM_PER_S, MAX_SPEED_MM_PER_S.next_down()];
            found.add(ends, per_octave, None);
        }
        found
    }

    fn add(&mut self, [low, high]: [f64; 2], per_octave: usize, n_bins: Option<usize>) {
        let octaves = (high / low).log2();
        let n_parts = whole((octaves * per_octave as f64 - 1e-9).ceil().max(1.0));
        self.segments.push(Segment {
            start: low.log2(),
            parts_per_octave: n_parts as f64 / octaves,
            n_parts,
            first_node: self.places.len(),
        });
        for part in 0..=n_parts {
            let speed = low * (octaves * part as f64 / n_parts as f64).exp2();
            let counted = n_bins.unwrap_or_else(|| n_audible_bins(speed.min(high)));
            self.places.push((speed, counted));
        }
    }

    /// The first node to read at a speed, and the weights of it and those that follow.
    fn find<T: Digits>(&self, speed_mm_per_s: f64, reading: Reading) -> (usize, [T; 4]) {
        let place = if self.is_cut {
            n_audible_bins(speed_mm_per_s).max(1) - 1
        } else {
            0
        };
        let segment = &self.segments[place];
        let at = (speed_mm_per_s.log2() - segment.start) * segment.parts_per_octave;
        let n_nodes = reading.name_and_nodes().1.min(segment.n_parts + 1);
        let before = at.clamp(0.0, segment.n_parts as f64) - (n_nodes as f64 / 2.0 - 1.0);
        let last = segment.n_parts + 1 - n_nodes;
        let first = whole(before).min(last);
        let mut weights = [T::of(0.0); 4];
        for (i, weight) in weights.iter_mut().enumerate().take(n_nodes) {
            let others = (0..n_nodes).filter(|&j| j != i);
            let factor = |j: usize| (at - (first + j) as f64) / (i as f64 - j as f64);
            *weight = T::of(others.map(factor).product());
        }
        (segment.first_node + first, weights)
    }
}

/// The tables of one textile's four directions.
#[derive(Debug, Clone)]
pub(super) struct StudyTable<T> {
    nodes: Arc<Nodes>,
    reading: Reading,
    offsets: Vec<Displacement>,
    /// Which table each direction reads.
    of_direction: [usize; 4],
    /// Points, and node by node a row of them: `2 Σ P H²` for both bands.
    tables: Vec<(usize, Vec<[T; 2]>)>,
}

impl StudyTable<f64> {
    /// Tables for the first textile and the first display of a scene.
    pub(super) fn new(scene: &RenderScene, nodes: Nodes, reading: Reading) -> Self {
        let mut spectra: Vec<&Arc<LocalSpectra>> = Vec::new();
        let mut of_direction = [0; 4];
        for surface in scene.textiles.iter().take(1).map(|placed| &placed.surface) {
            of_direction = Direction::ALL.map(|d| {
                let own = surface.spectra(d);
                let known = spectra.iter().position(|other| Arc::ptr_eq(other, own));
                known.unwrap_or_else(|| {
                    spectra.push(own);
                    spectra.len() - 1
                })
            });
        }
        let tables = spectra
            .into_iter()
            .map(|own| (own.n_points(), powers_at(&nodes, own, &scene.filters)));
        Self {
            tables: tables.collect(),
            nodes: Arc::new(nodes),
            reading,
            offsets: scene
                .displays
                .iter()
                .flat_map(|d| d.offsets.clone())
                .collect(),
            of_direction,
        }
    }
}

/// A squared amplitude of every point at every node, for both bands, µm².
fn powers_at(nodes: &Nodes, spectra: &LocalSpectra, filters: &Filters) -> Vec<[f64; 2]> {
    let mut powers = Vec::with_capacity(nodes.places.len() * spectra.n_points());
    for &(speed_mm_per_s, n_bins) in &nodes.places {
        // One bin more sounds just below a segment's end than at it.
        let just_below = speed_mm_per_s.min(MAX_SPEED_MM_PER_S) * (1.0 - 1e-12);
        let response = SpeedResponse::at(just_below.max(MIN_SPEED_MM_PER_S), filters);
        let gains = response.power_gains();
        let gains = &gains[..n_bins.min(gains.len())];
        for point in 0..spectra.n_points() {
            let mut sums = [0.0; 2];
            for (power, gain) in spectra.powers_um2(point).iter().zip(gains) {
                sums[0] += power * gain[0];
                sums[1] += power * gain[1];
            }
            powers.push(sums.map(|sum| 2.0 * sum));
        }
    }
    powers
}

impl<T: Digits> StudyTable<T> {
    /// The same tables read in another way, with other digits.
    pub(super) fn as_read<U: Digits>(&self, reading: Reading) -> StudyTable<U> {
        let digits = |rows: &Vec<[T; 2]>| rows.iter().map(|p| p.map(|x| U::of(x.into()))).collect();
        StudyTable {
            nodes: Arc::clone(&self.nodes),
            reading,
            offsets: self.offsets.clone(),
            of_direction: self.of_direction,
            tables: self
                .tables
                .iter()
                .map(|(n, rows)| (*n, digits(rows)))
                .collect(),
        }
    }

    fn row(&self, bench: &mut Bench<'_>, case: &Case, per_octave: usize) -> Row {
        let uncut = if self.nodes.is_cut { "" } else { ", uncut" };
        let method = format!("{} {}{uncut}", self.reading.name_and_nodes().0, T::NAME);
        let setting = format!("{per_octave} nodes an octave");
        let row = case.row(bench, (&method, setting), |poses, out| {
            out.resize(self.offsets.len(), [0.0; 2]);
            self.tick(&poses[0], out);
        });
        row.bytes(
            self.tables
                .iter()
                .map(|(_, rows)| size_of_val(&rows[..]))
                .sum(),
        )
    }

    /// Amplitudes of all contactors at a pose, µm.
    pub(super) fn tick(&self, pose: &Pose, amplitudes_um: &mut [[f64; 2]]) {
        let mut powers = [[T::of(0.0); 2]; MAX_CONTACTORS];
        let n_nodes = self.reading.name_and_nodes().1;
        let velocity = [pose.velocity.x_mm_per_s, pose.velocity.y_mm_per_s];
        for (axis, component) in velocity.into_iter().enumerate() {
            let speed_mm_per_s = component.abs();
            if !(MIN_SPEED_MM_PER_S..MAX_SPEED_MM_PER_S).contains(&speed_mm_per_s) {
                continue;
            }
            let table = self.of_direction[2 * axis + usize::from(component < 0.0)];
            let (n_points, rows) = &self.tables[table];
            let (first, weights) = self.nodes.find::<T>(speed_mm_per_s, self.reading);
            for (power, offset) in powers.iter_mut().zip(&self.offsets) {
                let place_mm = match axis {
                    0 => pose.position.x_mm + offset.x_mm,
                    _ => pose.position.y_mm + offset.y_mm,
                };
                let point = nearest(place_mm, *n_points);
                for (node, weight) in weights.iter().take(n_nodes).enumerate() {
                    let Some(stored) = rows.get((first + node) * n_points + point) else {
                        continue;
                    };
                    power[0] = power[0] + stored[0] * *weight;
                    power[1] = power[1] + stored[1] * *weight;
                }
            }
        }
        for (out, power) in amplitudes_um.iter_mut().zip(powers) {
            // A cubic may swing below nothing.
            *out = power.map(|power| power.into().max(0.0).sqrt());
        }
    }
}

/// Most contactors of a study's display.
const MAX_CONTACTORS: usize = 24;

/// The nearest point of a profile.
fn nearest(place_mm: f64, n_points: usize) -> usize {
    whole(place_mm + 0.5 + 1e-6) % n_points.max(1)
}
