//! A table of subjects by one or two factors, each subject in every cell.

use std::collections::BTreeMap;

use crate::{Computed, undefined};

/// A factor and its levels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Factor {
    /// Its name: `signal`.
    pub name: String,
    /// Its levels, in order.
    pub levels: Vec<String>,
}

/// One answer: who, at which level of each factor, and what.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The subject.
    pub subject: String,
    /// One level a factor.
    pub levels: Vec<String>,
    /// The answer.
    pub value: f64,
}

/// Values of subjects in the cells of one or two crossed factors.
#[derive(Debug, Clone, PartialEq)]
pub struct Crossed {
    /// The subjects.
    pub subjects: Vec<String>,
    /// One or two factors.
    pub(crate) factors: Vec<Factor>,
    /// Subject by subject, in each the first factor's levels, in each the second's.
    pub values: Vec<Option<f64>>,
}

impl Crossed {
    /// From answers in any order; several in a cell become their mean. Subjects and levels stand
    /// in the order in which they first occur.
    ///
    /// # Errors
    /// An answer that does not name one level a factor.
    pub fn of_answers(factors: &[&str], answers: &[Answer]) -> Computed<Self> {
        let mut table = Self {
            subjects: Vec::new(),
            factors: factors.iter().map(|name| Factor::named(name)).collect(),
            values: Vec::new(),
        };
        let mut sums: BTreeMap<(usize, Vec<usize>), (f64, f64)> = BTreeMap::new();
        for (index, answer) in answers.iter().enumerate() {
            if answer.levels.len() != factors.len() {
                let (found, wanted) = (answer.levels.len(), factors.len());
                let reason = format!("answer {}: {found} levels, not {wanted}", index + 1);
                return undefined(reason);
            }
            let subject = place_of(&mut table.subjects, &answer.subject);
            let named = table.factors.iter_mut().zip(&answer.levels);
            let levels = named
                .map(|(f, level)| place_of(&mut f.levels, level))
                .collect();
            let cell = sums.entry((subject, levels)).or_default();
            *cell = (cell.0 + answer.value, cell.1 + 1.0);
        }
        let n_cells = table.n_cells();
        table.values = vec![None; table.subjects.len() * n_cells];
        for ((subject, levels), (sum, count)) in sums {
            let strides = table.factors.iter().zip(&levels);
            let cell = strides.fold(0, |cell, (f, level)| cell * f.levels.len() + level);
            table.values[subject * n_cells + cell] = Some(sum / count);
        }
        Ok(table)
    }

    /// Levels of the first factor, in the order of cells.
    pub fn levels(&self) -> &[String] {
        self.factors.first().map_or(&[], |factor| &factor.levels)
    }

    /// Cells a subject has.
    pub fn n_cells(&self) -> usize {
        self.factors.iter().map(|f| f.levels.len()).product()
    }

    /// All values, if none is missing.
    ///
    /// # Errors
    /// Missing or infinite values, with their list; a table that does not fit its labels.
    pub fn complete(&self) -> Computed<Vec<f64>> {
        let n_expected = self.subjects.len() * self.n_cells();
        if self.values.len() != n_expected {
            let reason = format!("{} values for {n_expected} cells", self.values.len());
            return undefined(reason);
        }
        let is_missing = |v: &Option<f64>| !v.is_some_and(f64::is_finite);
        let missing: Vec<String> = self
            .values
            .iter()
            .enumerate()
            .filter(|(_, v)| is_missing(v))
            .map(|(index, _)| self.label(index))
            .collect();
        if !missing.is_empty() {
            return undefined(format!("missing cells: {}", missing.join("; ")));
        }
        Ok(self.values.iter().flatten().copied().collect())
    }

    /// `S03 · real · velvet`.
    fn label(&self, index: usize) -> String {
        let n_cells = self.n_cells();
        let mut rest = index % n_cells;
        let mut parts: Vec<&str> = Vec::new();
        for factor in self.factors.iter().rev() {
            parts.push(&factor.levels[rest % factor.levels.len()]);
            rest /= factor.levels.len();
        }
        parts.push(&self.subjects[index / n_cells]);
        parts.reverse();
        parts.join(" · ")
    }
}

impl Factor {
    fn named(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            levels: Vec::new(),
        }
    }
}

/// Where a name stands; it is added if it is new.
fn place_of(names: &mut Vec<String>, name: &str) -> usize {
    names.iter().position(|n| n == name).unwrap_or_else(|| {
        names.push(name.to_owned());
        names.len() - 1
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(subject: &str, signal: &str, material: &str, value: f64) -> Answer {
        Answer {
            subject: subject.to_owned(),
            levels: vec![signal.to_owned(), material.to_owned()],
            value,
        }
    }

    #[test]
    fn answers_in_any_order_fill_their_cells_with_means() -> Computed<()> {
        let answers = [
            answer("S1", "real", "felt", 1.0),
            answer("S2", "false", "silk", 8.0),
            answer("S1", "real", "felt", 2.0),
            answer("S1", "real", "silk", 3.0),
            answer("S1", "false", "silk", 4.0),
            answer("S2", "real", "felt", 5.0),
            answer("S1", "false", "felt", 6.0),
            answer("S2", "real", "silk", 7.0),
            answer("S2", "false", "felt", 9.0),
        ];
        let table = Crossed::of_answers(&["signal", "material"], &answers)?;
        assert_eq!(table.complete()?, [1.5, 3.0, 6.0, 4.0, 5.0, 7.0, 9.0, 8.0]);
        Ok(())
    }

    #[test]
    fn missing_cells_are_listed_by_name() -> Computed<()> {
        let answers = [
            answer("S1", "real", "felt", 1.0),
            answer("S1", "false", "silk", f64::NAN),
            answer("S2", "real", "silk", 2.0),
            answer("S2", "real", "felt", 2.0),
            answer("S2", "false", "felt", 2.0),
            answer("S2", "false", "silk", 2.0),
        ];
        let table = Crossed::of_answers(&["signal", "material"], &answers)?;
        let reason = table.complete().map_err(|e| e.reason);
        let expected = "missing cells: S1 · real · silk; S1 · false · felt; S1 · false · silk";
        assert_eq!(reason, Err(expected.to_owned()));
        let short = Crossed::of_answers(&["signal"], &answers).map_err(|e| e.reason);
        assert_eq!(short, Err("answer 1: 2 levels, not 1".to_owned()));
        Ok(())
    }
}
