//! What a display's contactors are told to do in one tick.

use crate::ContactorArray;
use crate::plan::OUTSIDE;
use selvedge_foundation::geometry::{Displacement, Point, Rotation};

/// One display's amplitudes after a tick: after gains, before the limits of an output.
#[derive(Debug, Clone)]
pub struct DisplayFrame {
    pub(super) amplitudes_um: Vec<[f32; 2]>,
    /// The same before rounding to f32; empty for methods that have no more digits.
    pub(super) exact_um: Vec<[f64; 2]>,
    pub(super) owners: Vec<u16>,
    pub(super) position: Point,
    pub(super) rotation: Rotation,
    offsets: Vec<Displacement>,
}

impl DisplayFrame {
    pub(super) fn new(array: &ContactorArray, is_exact: bool) -> Self {
        let n_contactors = array.offsets.len();
        Self {
            amplitudes_um: vec![[0.0; 2]; n_contactors],
            exact_um: vec![[0.0; 2]; if is_exact { n_contactors } else { 0 }],
            owners: vec![OUTSIDE; n_contactors],
            position: Point::default(),
            rotation: Rotation::from_degrees(array.rotation_deg),
            offsets: array.offsets.clone(),
        }
    }

    /// Number of contactors.
    pub fn n_contactors(&self) -> usize {
        self.amplitudes_um.len()
    }

    /// `[A40, A320]` of every contactor, µm peak.
    pub fn amplitudes_um(&self) -> &[[f32; 2]] {
        &self.amplitudes_um
    }

    /// `[A40, A320]` of a contactor, µm peak, with every digit that the method has: f64 for
    /// `reference` and `banded`, widened f32 for `table`.
    ///
    /// # Panics
    /// When there is no such contactor.
    pub fn amplitude_um(&self, contactor: usize) -> [f64; 2] {
        let exact = self.exact_um.get(contactor).copied();
        exact.unwrap_or_else(|| self.amplitudes_um[contactor].map(f64::from))
    }

    /// The textile under a contactor: its place in the scene's list; `None` outside.
    pub fn textile(&self, contactor: usize) -> Option<usize> {
        let owner = self
            .owners
            .get(contactor)
            .filter(|&&owner| owner != OUTSIDE);
        owner.map(|&owner| usize::from(owner))
    }

    /// Where a contactor is in the workspace; the display's centre when there is no such one.
    pub fn contactor_position(&self, contactor: usize) -> Point {
        let offset = self.offsets.get(contactor).copied().unwrap_or_default();
        self.position + self.rotation.turn(offset)
    }

    /// Where the display's centre is in the workspace.
    pub fn position(&self) -> Point {
        self.position
    }

    /// Begins a tick: no amplitudes yet.
    pub(super) fn begin(&mut self) {
        self.amplitudes_um.fill([0.0; 2]);
        self.exact_um.fill([0.0; 2]);
    }

    /// Silence at no place.
    pub(super) fn silence(&mut self) {
        self.amplitudes_um.fill([0.0; 2]);
        self.exact_um.fill([0.0; 2]);
        self.owners.fill(OUTSIDE);
    }

    /// Silences contactors whose place holds false; those beyond the mask's end are felt.
    pub(super) fn mask(&mut self, is_felt: &[bool]) {
        let masked = |&(_, is_felt): &(usize, &bool)| !is_felt;
        for (contactor, _) in is_felt.iter().enumerate().filter(masked) {
            if let Some(amplitudes) = self.amplitudes_um.get_mut(contactor) {
                *amplitudes = [0.0; 2];
            }
            if let Some(exact) = self.exact_um.get_mut(contactor) {
                *exact = [0.0; 2];
            }
        }
    }

    /// Gives every contactor these amplitudes, µm.
    pub(super) fn vibrate(&mut self, amplitude_um: [f32; 2]) {
        self.amplitudes_um.fill(amplitude_um);
        self.exact_um.fill(amplitude_um.map(f64::from));
    }

    /// Gives contactors amplitudes of their own, µm; those beyond the end of the list are silent.
    pub(super) fn give(&mut self, amplitudes_um: impl Iterator<Item = [f64; 2]>) {
        self.begin();
        for (contactor, given) in amplitudes_um.take(self.n_contactors()).enumerate() {
            self.amplitudes_um[contactor] = given.map(crate::single);
            if let Some(exact) = self.exact_um.get_mut(contactor) {
                *exact = given;
            }
        }
    }

    /// Rounds the exact amplitudes into the stream.
    pub(super) fn round(&mut self) {
        for (rounded, exact) in self.amplitudes_um.iter_mut().zip(&self.exact_um) {
            *rounded = exact.map(crate::single);
        }
    }
}
