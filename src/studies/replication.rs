//! The study of the papers' experiments: simulated observers, printed beside obtained.

use selvedge_experiment::design::Design;
use selvedge_experiment::observer::{Observer, Stimuli};
use selvedge_experiment::replication::{Comparison, Options, replicate};
use selvedge_experiment::{ExperimentError, Simulation, simulated_subject};
use selvedge_foundation::progress::unheard;
use selvedge_foundation::quantity;

use super::{Bench, Findings, ReportError, Row, Study, Timing};

/// Printed and obtained.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ReplicationStudy;

impl Study for ReplicationStudy {
    fn name(&self) -> &'static str {
        "replication"
    }

    fn question(&self) -> &'static str {
        "How near do simulated observers, with noise from published just noticeable differences \
         and nothing fitted, come to what the papers print of people?"
    }

    fn reference(&self) -> &'static str {
        "Philpott & Summers 2012, Allerkamp et al. and Cai et al. 2021, as printed."
    }

    fn error_measure(&self) -> (&'static str, &'static str) {
        ("distance from what is printed", "")
    }

    fn cost_of(&self) -> &'static str {
        "simulated session"
    }

    fn run(&self, bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
        let cost = session(bench)?;
        let options = Options {
            seed: bench.seed,
            n_studies: bench.effort.pick(20, 200),
            n_swept: bench.effort.pick(3, 50),
            n_maps: bench.effort.pick(8, 50),
            is_detailed: false,
            cache: None,
        };
        let found = bench
            .heard(|progress| replicate(&options, progress))
            .map_err(failed)?;
        let mut rows: Vec<Row> = found.comparisons.iter().map(row).collect();
        rows.push(Row {
            method: Observer::default().strategy.name().to_owned(),
            case: "eighty rankings, cost alone".to_owned(),
            cost: Some(cost),
            ..Row::default()
        });
        let mut findings = Findings {
            rows,
            plots: found.sweeps,
            ..Findings::default()
        };
        for section in &found.analysis.sections {
            findings.notes.extend(section.notes.iter().cloned());
        }
        Ok(findings)
    }
}

fn failed(error: ExperimentError) -> ReportError {
    match error {
        ExperimentError::Cancelled(_) => ReportError::Cancelled,
        other => ReportError::Study(other.to_string()),
    }
}

/// What a session of eighty rankings costs.
fn session(bench: &mut Bench<'_>) -> Result<Timing, ReportError> {
    let missing = || ReportError::Study("a shipped design is missing".to_owned());
    let design = Design::shipped("ranking-virtual-target").ok_or_else(missing)?;
    let folder = std::path::Path::new("");
    let library = design.open_library(folder, None);
    let library = library.map_err(|error| failed(error.into()))?;
    let stimuli = unheard(|progress| Stimuli::of(&design, &library, progress)).map_err(failed)?;
    let simulation = Simulation {
        design: &design,
        stimuli: &stimuli,
        observer: &Observer::default(),
        seed: bench.seed,
    };
    let subject = simulated_subject(0, 1);
    Ok(bench.time(1, || {
        simulation.records(&subject).map(|rows| rows.len()).ok()
    }))
}

fn row(one: &Comparison) -> Row {
    let said = |value: f64| quantity::fixed(value, 3);
    let spread = one.obtained;
    let within = match one.is_within() {
        Some(true) => "yes",
        Some(false) => "no",
        None => "",
    };
    Row {
        method: one.observer.to_owned(),
        setting: one.paper.to_owned(),
        case: one.quantity.clone(),
        error: one.printed.map(|printed| (spread.mean - printed).abs()),
        more: vec![
            ("printed", one.printed.map(said).unwrap_or_default()),
            ("obtained", said(spread.mean)),
            ("obtained_error", said(spread.se)),
            ("studies_from", said(spread.low)),
            ("studies_to", said(spread.high)),
            ("printed_within", within.to_owned()),
            ("studies", spread.n.to_string()),
            ("assumed", one.assumed.to_owned()),
        ],
        ..Row::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_experiment::replication::Spread;

    #[test]
    fn a_row_says_what_was_printed_what_came_out_and_whether_it_lies_within() {
        let one = |printed| Comparison {
            paper: "a paper",
            quantity: "right, %".to_owned(),
            printed,
            observer: "levels",
            assumed: "nothing",
            obtained: Spread {
                n: 20,
                mean: 50.0,
                se: 0.5,
                low: 45.0,
                high: 55.0,
            },
        };
        let beyond = row(&one(Some(64.0)));
        assert_eq!(beyond.error, Some(14.0));
        assert_eq!(beyond.further("printed_within"), Some("no"));
        let inside = row(&one(Some(54.9)));
        assert_eq!(inside.further("printed_within"), Some("yes"));
        let nothing = row(&one(None));
        assert_eq!(nothing.error, None);
        assert_eq!(nothing.further("printed_within"), Some(""));
        assert_eq!(nothing.further("obtained"), Some("50.000"));
    }
}
