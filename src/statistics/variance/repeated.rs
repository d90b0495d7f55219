//! Repeated measures: one or two factors within subjects, each effect against its own interaction
//! with subjects.
//!
//! Every effect is a set of orthonormal contrasts between cells. A subject's value of a contrast is
//! one number; over subjects, n times its squared mean is its part of the effect, and the squares
//! about its mean are its part of the error (Maxwell & Delaney, chapters 11 to 13). Summed over
//! an effect's contrasts these are the classical sums of squares of A and A×S, B and B×S, AB and
//! ABS, and the products of contrasts with each other say whether they are spherical.

use super::crossed::{Crossed, Factor};
use super::effect::{Effect, Sphericity, Sums};
use crate::summary::{centred, is_rounding, largest, sum_of_squares};
use crate::{Computed, Undefined, undefined};

/// The analysis of a table of repeated measures.
#[derive(Debug, Clone, PartialEq)]
pub struct Repeated {
    /// Subjects.
    pub n: usize,
    /// Sum of squares between subjects.
    pub(crate) ss_subjects: f64,
    /// The factors in order, then their interaction.
    pub effects: Vec<Effect>,
}

impl Repeated {
    /// One factor within subjects.
    ///
    /// # Errors
    /// A table with other than one factor, missing cells (with their list), fewer than two subjects
    /// or levels.
    pub fn one_way(table: &Crossed) -> Computed<Self> {
        let [a] = table.factors.as_slice() else {
            return Err(wrong_factors(table, "one"));
        };
        let terms = vec![(a.name.clone(), contrasts(a.levels.len()))];
        analyse(table, &average(a.levels.len()), &terms)
    }

    /// Two crossed factors within subjects: A against A×S, B against B×S, A×B against A×B×S.
    ///
    /// # Errors
    /// A table with other than two factors, missing cells (with their list), fewer than two
    /// subjects or levels.
    pub fn two_way(table: &Crossed) -> Computed<Self> {
        let [a, b] = table.factors.as_slice() else {
            return Err(wrong_factors(table, "two"));
        };
        let (n_a, n_b) = (a.levels.len(), b.levels.len());
        let terms = vec![
            (a.name.clone(), crossed(&contrasts(n_a), &average(n_b))),
            (b.name.clone(), crossed(&average(n_a), &contrasts(n_b))),
            (
                format!("{} × {}", a.name, b.name),
                crossed(&contrasts(n_a), &contrasts(n_b)),
            ),
        ];
        analyse(table, &crossed(&average(n_a), &average(n_b)), &terms)
    }
}

fn wrong_factors(table: &Crossed, wanted: &str) -> Undefined {
    let names: Vec<&str> = table.factors.iter().map(|f| f.name.as_str()).collect();
    Undefined::because(format!("{wanted} factor(s) wanted, not {names:?}"))
}

/// Rows of coefficients, one a cell.
type Contrasts = Vec<Vec<f64>>;

/// Helmert's k − 1 orthonormal contrasts.
fn contrasts(k: usize) -> Contrasts {
    let row = |j: usize| {
        let size = (j as f64 * (j as f64 + 1.0)).sqrt();
        let coefficient = |i: usize| match i {
            i if i < j => 1.0 / size,
            i if i == j => -(j as f64) / size,
            _ => 0.0,
        };
        (0..k).map(coefficient).collect()
    };
    (1..k).map(row).collect()
}

/// The mean of k levels, as a row of length 1.
fn average(k: usize) -> Contrasts {
    vec![vec![1.0 / (k as f64).sqrt(); k]]
}

/// Kronecker's product: cells with the first factor outermost.
fn crossed(a: &Contrasts, b: &Contrasts) -> Contrasts {
    let products = |x: &Vec<f64>, y: &Vec<f64>| {
        let cells = x.iter().flat_map(|x| y.iter().map(move |y| x * y));
        cells.collect::<Vec<f64>>()
    };
    let rows = a.iter().flat_map(|x| b.iter().map(move |y| products(x, y)));
    rows.collect()
}

fn analyse(
    table: &Crossed,
    of_subjects: &Contrasts,
    terms: &[(String, Contrasts)],
) -> Computed<Repeated> {
    let is_short = |f: &Factor| f.levels.len() < 2;
    if let Some(factor) = table.factors.iter().find(|f| is_short(f)) {
        return undefined(format!("{} has fewer than two levels", factor.name));
    }
    let n = table.subjects.len();
    if n < 2 {
        return undefined("one subject alone");
    }
    let values = table.complete()?;
    let (_, about_mean) = centred(&values);
    let data = Data {
        rows: about_mean.chunks(table.n_cells()).collect(),
        scale: largest(&values),
    };
    let ss_subjects = data.measure(of_subjects).error();
    let measured: Vec<Measured> = terms.iter().map(|(_, c)| data.measure(c)).collect();
    let ss_within: f64 = measured.iter().map(Measured::error).sum();
    let rows = terms.iter().zip(&measured).map(|((name, _), measured)| {
        let sums = measured.sums();
        let mut effect = sums.row(name, sums.ss + ss_subjects + ss_within);
        if measured.p > 1 {
            effect.sphericity = Sphericity::of(&measured.products, measured.p, n, &effect.f).ok();
        }
        effect
    });
    Ok(Repeated {
        n,
        ss_subjects,
        effects: rows.collect(),
    })
}

/// Cells about the grand mean, one row a subject.
struct Data<'a> {
    rows: Vec<&'a [f64]>,
    scale: f64,
}

/// What contrasts found: the effect's sum of squares, and sums of products about the means.
struct Measured {
    n: usize,
    p: usize,
    ss: f64,
    products: Vec<f64>,
}

impl Data<'_> {
    fn measure(&self, contrasts: &Contrasts) -> Measured {
        let (n, p) = (self.rows.len(), contrasts.len());
        let value = |row: &&[f64], contrast: &Vec<f64>| -> f64 {
            row.iter().zip(contrast).map(|(x, c)| x * c).sum()
        };
        let mut ss = 0.0;
        let mut deviations = Vec::with_capacity(p);
        for contrast in contrasts {
            let values: Vec<f64> = self.rows.iter().map(|row| value(row, contrast)).collect();
            let (mean, about) = centred(&values);
            ss += n as f64 * mean * mean;
            deviations.push(self.clean(about));
        }
        let pairs = deviations.iter().flat_map(|a| {
            let product = move |b: &Vec<f64>| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            deviations.iter().map(product)
        });
        Measured {
            n,
            p,
            ss: if self.is_rounding(ss, n * p) { 0.0 } else { ss },
            products: pairs.collect(),
        }
    }

    /// Deviations that are nothing but rounding become exactly 0.
    fn clean(&self, deviations: Vec<f64>) -> Vec<f64> {
        if self.is_rounding(sum_of_squares(&deviations), deviations.len()) {
            vec![0.0; deviations.len()]
        } else {
            deviations
        }
    }

    /// A contrast adds up the rounding of all cells.
    fn is_rounding(&self, sum: f64, n: usize) -> bool {
        let n_cells = self.rows.first().map_or(1, |row| row.len());
        is_rounding(sum, n * n_cells, self.scale)
    }
}

impl Measured {
    fn error(&self) -> f64 {
        self.products.iter().step_by(self.p + 1).sum()
    }

    fn sums(&self) -> Sums {
        let df = self.p as f64;
        Sums {
            ss: self.ss,
            df,
            ss_error: self.error(),
            df_error: df * (self.n as f64 - 1.0),
        }
    }
}

#[cfg(test)]
mod tests;
