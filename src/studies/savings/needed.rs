//! What a scene needs, counted contactor by contactor from places and velocities, without the
//! renderer's rules and counters.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::Case;
use selvedge_render::array::{ContactInspector, ContactorReading};
use selvedge_render::scene::Pose;
use selvedge_textile::surface::{BIN_SPACING_PER_MM, LocalSpectra};
use selvedge_textile::tactile::{Band, Filters, MAX_FREQUENCY_HZ};

/// The share of a band's power that keeps its level within 0.05 dB.
const KEEPS: f64 = 0.988_553_094_656_939;

/// Least work for all ticks of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Needed {
    /// Displays that moved since the tick before, or did not rest.
    pub(super) displays: u64,
    /// Angles that are another than the tick before.
    pub(super) angles: u64,
    /// Textiles that contactors of a moved display lie on.
    pub(super) textiles: u64,
    /// Contactors of moved displays that do not all lie on one textile, or on none.
    pub(super) tests: u64,
    /// Contactors of moved displays that lie on a textile.
    pub(super) touches: u64,
    /// Distinct spectra, points and speeds of each tick.
    pub(super) directions: u64,
    /// Distinct speeds of each tick.
    pub(super) speeds: u64,
    /// The fewest bins of each distinct direction that keep 0.05 dB, both bands counted.
    pub(super) bins: u64,
}

impl Needed {
    pub(super) fn of(case: &Case) -> Self {
        let mut needed = Self::default();
        let mut inspector = ContactInspector::new(&case.scene);
        let mut readings = Vec::new();
        let (mut before, mut angle_deg) = (None, 0.0_f64);
        for pose in &case.poses {
            inspector.readings_into(0, pose, &mut readings);
            let is_still = before.replace(*pose).is_some_and(|before: Pose| {
                before.position == pose.position
                    && before.angle_deg.to_bits() == pose.angle_deg.to_bits()
            });
            if is_still && readings.iter().all(is_unfelt) {
                continue;
            }
            needed.displays += 1;
            needed.angles += u64::from(pose.angle_deg.to_bits() != angle_deg.to_bits());
            angle_deg = pose.angle_deg;
            needed.add_places(&readings);
            needed.add_directions(&readings, case);
        }
        needed
    }

    fn add_places(&mut self, readings: &[ContactorReading]) {
        let textile = |contactor: &ContactorReading| contactor.reading.map(|it| it.textile);
        let owners: BTreeSet<Option<usize>> = readings.iter().map(textile).collect();
        self.textiles += owners.iter().flatten().count() as u64;
        if owners.len() > 1 {
            self.tests += readings.len() as u64;
        }
        self.touches += readings.iter().filter_map(textile).count() as u64;
    }

    fn add_directions(&mut self, readings: &[ContactorReading], case: &Case) {
        let (mut distinct, mut speeds) = (BTreeSet::new(), BTreeSet::new());
        for reading in readings.iter().filter_map(|contactor| contactor.reading) {
            let components = reading.directions.iter().zip(reading.velocity_mm_per_s);
            for (direction, component) in components {
                let Some(direction) = *direction else {
                    continue;
                };
                let spectra = case.scene.textiles[reading.textile]
                    .surface
                    .spectra(direction);
                let (point, speed) = (reading.points[direction.index()], component.abs());
                speeds.insert(speed.to_bits());
                if distinct.insert((Arc::as_ptr(spectra), point, speed.to_bits())) {
                    self.bins += fewest_bins(spectra, (point, speed), &case.scene.filters);
                }
            }
        }
        self.directions += distinct.len() as u64;
        self.speeds += speeds.len() as u64;
    }
}

/// Whether a contactor feels nothing.
fn is_unfelt(contactor: &ContactorReading) -> bool {
    contactor
        .reading
        .is_none_or(|reading| reading.directions == [None; 2])
}

/// How many bins hold the share of a point's power that keeps 0.05 dB, in both bands.
fn fewest_bins(
    spectra: &LocalSpectra,
    (point, speed_mm_per_s): (usize, f64),
    filters: &Filters,
) -> u64 {
    let of_band = |band: Band| {
        let hz = |k: u32| speed_mm_per_s * BIN_SPACING_PER_MM * f64::from(k);
        let bins = (1..).zip(spectra.powers_um2(point));
        let heard = bins.take_while(|(k, _)| hz(*k) < MAX_FREQUENCY_HZ);
        let mut powers: Vec<f64> = heard
            .map(|(k, power_um2)| power_um2 * filters.power_gain(band, hz(k)))
            .collect();
        powers.sort_by(|a, b| b.total_cmp(a));
        let enough = KEEPS * powers.iter().sum::<f64>();
        let mut sum = 0.0;
        let is_missed = |power: &&f64| {
            let is_missed = sum < enough;
            sum += **power;
            is_missed
        };
        powers.iter().take_while(is_missed).count() as u64
    };
    Band::ALL.into_iter().map(of_band).sum()
}
