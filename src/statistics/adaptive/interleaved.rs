//! Several procedures at once, one trial of either by chance, so that nobody can follow them.

use super::{Procedure, over};
use crate::{Computed, undefined};
use selvedge_foundation::numerics::Random;

/// Procedures taken in turn by chance among those that are not over.
#[derive(Debug, Clone)]
pub struct Interleaved<P> {
    procedures: Vec<P>,
    random: Random,
    next: Option<usize>,
    order: Vec<usize>,
}

impl<P: Procedure> Interleaved<P> {
    /// Of one or more procedures; the seed decides their turns.
    ///
    /// # Errors
    /// None.
    pub fn new(procedures: Vec<P>, seed: u64) -> Computed<Self> {
        if procedures.is_empty() {
            return undefined("no procedures to take turns");
        }
        let mut interleaved = Self {
            procedures,
            random: Random::new(seed).branch("interleaved"),
            next: None,
            order: Vec::new(),
        };
        interleaved.draw();
        Ok(interleaved)
    }

    /// Whose turn it is and its stimulus; `None` when all are over.
    pub fn stimulus(&self) -> Option<(usize, f64)> {
        let next = self.next?;
        self.procedures[next].stimulus().map(|x| (next, x))
    }

    /// Takes the answer to that trial.
    ///
    /// # Errors
    /// All are over, or the stimulus is not one that the procedure could have meant.
    pub fn answer(&mut self, presented: f64, is_right: bool) -> Computed<()> {
        let next = self.next.ok_or_else(over)?;
        self.procedures[next].answer(presented, is_right)?;
        self.order.push(next);
        self.draw();
        Ok(())
    }

    /// The procedures as far as they came.
    pub fn procedures(&self) -> &[P] {
        &self.procedures
    }

    /// Whose turn each trial was.
    pub fn order(&self) -> &[usize] {
        &self.order
    }

    fn draw(&mut self) {
        let is_open = |&i: &usize| self.procedures[i].stimulus().is_some();
        let open: Vec<usize> = (0..self.procedures.len()).filter(is_open).collect();
        self.next = (!open.is_empty()).then(|| open[self.random.index(open.len())]);
    }
}
