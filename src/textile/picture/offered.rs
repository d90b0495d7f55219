//! Lattices beside the one that is found: those that explain the maxima next best, and one that
//! somebody gives.

use super::autocorrelation::Autocorrelation;
use super::basis::Basis;
use super::candidates::judge;
use super::directions::Directions;
use super::held_out;
use super::lattice::{Lattice, candidates, levels};
use super::maxima::Maxima;
use super::multiples::Evidence;
use super::significant::SignificantMaxima;

/// Lattices that are offered beside the one that is found.
const N_OFFERED: usize = 3;

impl Lattice {
    /// A lattice that somebody gives, with the evidence for it. Nobody counted how often such
    /// people are right: no confidence is stated.
    pub fn given(
        (rho, maxima, significant): (&Autocorrelation, &Maxima, &SignificantMaxima),
        basis: Basis,
    ) -> Self {
        let evidence = Evidence {
            rho,
            maxima,
            significant,
        };
        let basis = basis.reduced();
        let [explained, _] = held_out::explained(&evidence, &basis);
        let judged = judge(maxima, significant, basis, rho.radius());
        let (level, level_between) = levels(&evidence, &basis).unwrap_or_default();
        Self {
            p1_px: basis.p1,
            p2_px: basis.p2,
            confidence: 0.0,
            false_alarm_rate: 1.0,
            method: "given",
            thread_grid: held_out::thread_grid(&evidence, &[basis], &basis),
            held_out: (explained.n_neighbours > 0).then_some(explained.share),
            level,
            level_between,
            cover: judged.as_ref().map_or(0.0, |one| one.cover),
            hit: judged.as_ref().map_or(0.0, |one| one.hit),
        }
    }

    /// Lattices that explain the maxima next best after one that is found, best first.
    pub fn others(
        (rho, maxima, significant): (&Autocorrelation, &Maxima, &SignificantMaxima),
        directions: &Directions,
        found: Option<&Self>,
    ) -> Vec<Self> {
        let evidence = Evidence {
            rho,
            maxima,
            significant,
        };
        let mut all: Vec<Basis> = found.map(Self::basis).into_iter().collect();
        let n_found = all.len();
        for (candidate, _) in candidates(&evidence, directions).unwrap_or_default() {
            let basis = candidate.basis.reduced();
            let is_known = |known: &Basis| known.distance_to(&basis) < 0.08 * known.shorter();
            if !all.iter().any(is_known) && all.len() < n_found + N_OFFERED {
                all.push(basis);
            }
        }
        let others = all.into_iter().skip(n_found);
        others
            .map(|basis| Self::given((rho, maxima, significant), basis))
            .collect()
    }
}
