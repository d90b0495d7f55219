//! How costs grow with size: the exponent of a power, process by process, so that it carries the
//! interval that its times have.

use super::Findings;
use selvedge_foundation::numerics::{LineFit, median};

/// A sentence a method, where a study says with what its costs grow.
pub(super) fn sentences(findings: &Findings) -> Vec<String> {
    let Some(size) = findings.grows_with else {
        return Vec::new();
    };
    let mut methods: Vec<&str> = Vec::new();
    for row in &findings.rows {
        if !methods.contains(&row.method.as_str()) {
            methods.push(&row.method);
        }
    }
    let sentence = |method: &&str| {
        let mut exponents = exponents(findings, method);
        let middle = median(&mut exponents);
        let [low, high] = [exponents.first()?, exponents.last()?];
        let of = match exponents.len() {
            1 => "one process, which has no interval".to_owned(),
            n => format!("{low:.2} … {high:.2} in {n} processes"),
        };
        Some(format!(
            "CPU time of {method} grows with the {size} to the power {middle:.2} ({of})."
        ))
    };
    methods.iter().filter_map(sentence).collect()
}

/// The exponents e of `time = c·sizeᵉ` that fit a method best over the logarithms, one a process,
/// rising.
fn exponents(findings: &Findings, method: &str) -> Vec<f64> {
    let own = findings.rows.iter().filter(|row| row.method == method);
    let sized = own.filter_map(|row| Some((row.size?, row.cost?)));
    let sized: Vec<_> = sized.collect();
    let n_processes = sized
        .iter()
        .map(|(_, cost)| cost.of_processes().len())
        .min();
    let of_process = |process: usize| {
        let points = sized
            .iter()
            .map(|(size, cost)| [*size, cost.of_processes()[process]]);
        let logs: Vec<[f64; 2]> = points.map(|point| point.map(f64::ln)).collect();
        let fit = LineFit::through(&logs).map(|line| line.slope);
        fit.filter(|slope| slope.is_finite())
    };
    let mut found: Vec<f64> = (0..n_processes.unwrap_or(0))
        .filter_map(of_process)
        .collect();
    found.sort_by(f64::total_cmp);
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Row;
    use crate::pareto::tests::row;

    #[test]
    fn an_exponent_has_the_span_of_its_processes() {
        let sized = |size: f64, cpu_s: [f64; 2]| -> Row {
            let row = row("a", 0.1, cpu_s[0]).size(size);
            let cost = row.cost.map(|cost| cost.and(&[(cpu_s[1], cpu_s[1], 3)]));
            Row { cost, ..row }
        };
        // The second process is slower, and grows faster.
        let rows = vec![sized(10.0, [1.0, 2.0]), sized(100.0, [100.0, 2000.0])];
        let mut findings = Findings {
            rows,
            grows_with: Some("number of things"),
            ..Findings::default()
        };
        let found = sentences(&findings);
        assert_eq!(found.len(), 1);
        let words =
            "grows with the number of things to the power 2.50 (2.00 … 3.00 in 2 processes).";
        assert!(found[0].ends_with(words), "{found:?}");
        findings.grows_with = None;
        assert!(sentences(&findings).is_empty(), "nothing is said of it");
    }
}
