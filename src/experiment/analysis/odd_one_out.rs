//! The odd one of three (Allerkamp et al.): how often it was found and how easily, which fabrics
//! were mistaken, and the distances that follow.

use super::draw::{Bar, bars};
use super::included_trials::{Experiment, Subject};
use super::map::Mapping;
use super::model::{
    Cell, Drawn, Section, Table, ends, matrix, percent_interval, resampled, summaries, tests,
};
use super::odd_one_out_answers::{grade_weights, n_right, percent, triad_answer, triads};
use super::odd_one_out_craven::Craven;
use super::options::Options;
use super::properties::Measures;
use super::{odd_one_out_craven, odd_one_out_variants};
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_statistics::detection::{Correction, triangle};
use selvedge_statistics::mds::{Loss, Ties};
use selvedge_statistics::ranking::{Grade, GradeWeights, OddOneOut, TriadAnswer};
use selvedge_statistics::variance::friedman;
use selvedge_statistics::{
    Computed, Outcome, Sides, Summary, Undefined, exact_binomial, one_sample_t,
    wilcoxon_signed_rank,
};

const CHANCE: f64 = 1.0 / 3.0;
const CHANCE_PERCENT: f64 = 100.0 / 3.0;

pub(super) fn sections(
    experiment: &Experiment<'_>,
    own_weights: [f64; 3],
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<Vec<Section>, Cancelled> {
    let names = experiment.ids();
    let all: Vec<TriadAnswer> = experiment.subjects.iter().flat_map(triads).collect();
    let mut sections = vec![accuracy(experiment, options), grades(experiment)];
    let found = match OddOneOut::of(names.len(), &all, grade_weights(own_weights)) {
        Ok(found) => found,
        Err(why) => {
            sections[0].note(format!("No distances: {}.", why.reason));
            return Ok(sections);
        }
    };
    let craven = Craven::of(&found);
    sections.push(distances(experiment, &found, &names));
    sections.push(odd_one_out_craven::section(
        experiment, &found, &craven, &names,
    ));
    let measures = Measures::of(experiment, options, progress)?;
    let of_subject = |subject: &Subject<'_>| {
        let own = OddOneOut::of(names.len(), &triads(subject), grade_weights(own_weights)).ok()?;
        Some(own.mean_weights())
    };
    let subjects: Vec<Vec<Option<f64>>> =
        experiment.subjects.iter().filter_map(of_subject).collect();
    // Sums compare only where every pair was asked as often.
    let is_balanced = found.is_balanced();
    let mapping = Mapping {
        key: experiment.key("map"),
        title: format!("{}: map", experiment.design.title),
        names,
        values: if is_balanced {
            found.distances()
        } else {
            found.mean_weights()
        },
        subjects,
        loss: Loss::Stress1,
        ties: Ties::Primary,
        measures: &measures,
    };
    let mut map = mapping.section(options, progress)?;
    map.note("Primary ties: sums of weights pile up at their ceiling and floor.");
    if !is_balanced {
        map.note("Pairs were not asked equally often: mapped is the mean weight, not the sum.");
    }
    sections.push(map);
    sections.push(odd_one_out_variants::section(
        (experiment, &mapping),
        (&found, &all, &craven),
        options,
        progress,
    )?);
    Ok(sections)
}

const SHARES: [(&str, &str); 11] = [
    ("subject", "subject"),
    ("session", "session"),
    ("triads", "triads"),
    ("right", "right"),
    ("percent", "%"),
    ("ci_low_percent", "95 % CI from"),
    ("ci_high_percent", "to"),
    ("p", "exact binomial p, above ⅓"),
    ("d_prime", "d′, triangle"),
    ("d_prime_ci_low", "95 % CI from"),
    ("d_prime_ci_high", "to"),
];

fn share_row(subject: &str, session: Cell, answers: &[TriadAnswer]) -> Vec<Cell> {
    let (right, n) = (n_right(answers), answers.len() as u64);
    let choice = triangle(right, n, Correction::LogLinear);
    let mut row = vec![subject.into(), session, n.into(), right.into()];
    row.push(if n > 0 {
        percent(answers).into()
    } else {
        Cell::none("no triads")
    });
    row.extend(ends(&percent_interval(right, n)));
    row.push(Cell::of(
        &exact_binomial(right, n, CHANCE, Sides::Greater).map(|o| o.p),
    ));
    row.push(Cell::of(
        &choice.as_ref().map(|c| c.d_prime).map_err(Clone::clone),
    ));
    row.extend(ends(&choice.and_then(|c| c.interval)));
    row
}

fn accuracy(experiment: &Experiment<'_>, options: &Options) -> Section {
    let title = format!("{}: accuracy", experiment.design.title);
    let mut section = Section::new(experiment.key("accuracy"), title);
    section.note(
        "Chance is ⅓. d′ is that of the triangle test without bias; below chance it is 0. \
         Intervals of shares are Wilson's, p is exact (binomial).",
    );
    let mut table = Table::new("subjects", "Right answers by subject and session", &SHARES);
    let mut shown = Vec::new();
    for subject in &experiment.subjects {
        for session in &subject.sessions {
            let own: Vec<TriadAnswer> = session
                .trials
                .iter()
                .filter_map(|r| triad_answer(r))
                .collect();
            let number = Cell::from(f64::from(session.found.subject.session));
            table.push(share_row(subject.name, number, &own));
        }
        let all = triads(subject);
        if subject.sessions.len() > 1 {
            table.push(share_row(subject.name, "all".into(), &all));
        }
        let ends = percent_interval(n_right(&all), all.len() as u64).ok();
        shown.push(Bar {
            name: subject.name.to_owned(),
            group: String::new(),
            value: percent(&all),
            interval: ends.map(|i| [i.low, i.high]),
        });
    }
    section.tables.push(table);
    let (percents, d_primes) = scores(experiment);
    let means = [
        ("right, %".to_owned(), percents.clone()),
        ("d′".to_owned(), d_primes),
    ];
    section
        .tables
        .push(summaries("group", "Over subjects", &means));
    section.tables.push(resampled(&means, options.resampling()));
    let mut found = vec![
        (
            "right, % against 33.3".to_owned(),
            Summary::of(&percents).and_then(|s| one_sample_t(&s, CHANCE_PERCENT)),
        ),
        (
            "right, % against 33.3".to_owned(),
            wilcoxon_signed_rank(&percents, CHANCE_PERCENT),
        ),
    ];
    found.push(("sessions, right, %".to_owned(), over_sessions(experiment)));
    section.tables.push(tests(
        "tests",
        "Against chance, and session against session",
        &found,
    ));
    section
        .figures
        .push(by_subject(experiment, shown, &percents));
    section
}

fn by_subject(experiment: &Experiment<'_>, mut shown: Vec<Bar>, percents: &[f64]) -> Drawn {
    if let Ok(s) = Summary::of(percents) {
        shown.push(Bar {
            name: "mean ± SE".to_owned(),
            group: String::new(),
            value: s.mean,
            interval: Some([s.mean - s.se, s.mean + s.se]),
        });
    }
    let title = format!("{}: right answers", experiment.design.title);
    let label = "right, % (95 % interval)";
    let range = Some([0.0, 100.0]);
    bars(
        "subjects-bars",
        &title,
        label,
        (&shown, range),
        &[(CHANCE_PERCENT, "chance")],
    )
}

/// Every subject's right answers, %, and d′.
fn scores(experiment: &Experiment<'_>) -> (Vec<f64>, Vec<f64>) {
    let percents = experiment.subjects.iter().map(|s| percent(&triads(s)));
    let d_primes: Vec<f64> = experiment
        .subjects
        .iter()
        .filter_map(|s| {
            let all = triads(s);
            Some(
                triangle(n_right(&all), all.len() as u64, Correction::LogLinear)
                    .ok()?
                    .d_prime,
            )
        })
        .collect();
    (percents.collect(), d_primes)
}

/// Whether sessions differ, over subjects who took part in as many.
fn over_sessions(experiment: &Experiment<'_>) -> Computed<Outcome> {
    let most = experiment
        .subjects
        .iter()
        .map(|s| s.sessions.len())
        .max()
        .unwrap_or(0);
    if most < 2 {
        return Err(Undefined::because("one session each"));
    }
    let with_all = experiment
        .subjects
        .iter()
        .filter(|s| s.sessions.len() == most);
    let rows: Vec<Vec<f64>> = with_all
        .map(|subject| {
            let of = |session: &super::included_trials::Session<'_>| {
                let own: Vec<TriadAnswer> = session
                    .trials
                    .iter()
                    .filter_map(|r| triad_answer(r))
                    .collect();
                percent(&own)
            };
            subject.sessions.iter().map(of).collect()
        })
        .collect();
    friedman(&rows)
}

/// Answers with a grade, and every subject's share of them among its right or wrong ones, %.
fn graded(experiment: &Experiment<'_>, is_correct: bool, grade: Grade) -> (usize, Vec<f64>) {
    let mut count = 0_usize;
    let mut shares = Vec::new();
    for subject in &experiment.subjects {
        let all = triads(subject);
        let own: Vec<&TriadAnswer> = all.iter().filter(|a| a.is_correct == is_correct).collect();
        let n = own.iter().filter(|a| a.grade == grade).count();
        count += n;
        if !own.is_empty() {
            shares.push(100.0 * n as f64 / own.len() as f64);
        }
    }
    (count, shares)
}

/// Easy, normal and hard, of right and of wrong answers.
fn grades(experiment: &Experiment<'_>) -> Section {
    let title = format!("{}: easy, normal, hard", experiment.design.title);
    let mut section = Section::new(experiment.key("grades"), title);
    section.note(
        "Shares of a subject's right (or wrong) answers with each grade; mean ± SE over subjects.",
    );
    let columns = [
        ("answers", "answers"),
        ("grade", "grade"),
        ("count", "count"),
        ("subjects", "n"),
        ("mean_percent", "mean share, %"),
        ("se_percent", "SE"),
    ];
    let mut table = Table::new("grades", "Grades of right and wrong answers", &columns);
    let mut shown = Vec::new();
    for (name, is_correct) in [("right", true), ("wrong", false)] {
        for grade in [Grade::Easy, Grade::Normal, Grade::Hard] {
            let (count, shares) = graded(experiment, is_correct, grade);
            let told = crate::Grade::ALL[grade as usize].name();
            let summary = Summary::of(&shares);
            let mean = selvedge_statistics::mean(&shares);
            table.push([
                name.into(),
                told.into(),
                count.into(),
                shares.len().into(),
                Cell::of(&mean),
                Cell::of(&summary.as_ref().map(|s| s.se).map_err(Clone::clone)),
            ]);
            if let Ok(mean) = mean {
                shown.push(Bar {
                    name: told.to_owned(),
                    group: format!("{name} answers"),
                    value: mean,
                    interval: summary.ok().map(|s| [mean - s.se, mean + s.se]),
                });
            }
        }
    }
    section.tables.push(table);
    let title = format!(
        "{}: how hard right and wrong answers were",
        experiment.design.title
    );
    section.figures.push(bars(
        "bars",
        &title,
        "share of answers, % (± SE)",
        (&shown, Some([0.0, 100.0])),
        &[],
    ));
    section
}

/// Sums of weights, and errors by fabric.
fn distances(experiment: &Experiment<'_>, found: &OddOneOut, names: &[String]) -> Section {
    let title = format!("{}: distances", experiment.design.title);
    let mut section = Section::new(experiment.key("distances"), title);
    let GradeWeights { easy, normal, hard } = found.weights;
    section.note(format!(
        "A right answer counts {easy}, {normal} or {hard} as it was easy, normal or hard, a \
         wrong one 0; the distance of two fabrics is the sum over all answers. {} pairs are \
         at the ceiling (always right and easy), {} at the floor, {} were never asked.",
        found.n_ceiling, found.n_floor, found.n_missing
    ));
    let cells = found.distances().into_iter();
    let cells = cells.map(|d| d.map_or_else(|| Cell::none("itself, or never asked"), Cell::from));
    section.tables.push(matrix(
        "distances",
        "Sums of weights",
        names,
        cells.collect(),
    ));
    section.tables.push(errors_by_fabric(found, names));
    section
}

fn errors_by_fabric(found: &OddOneOut, names: &[String]) -> Table {
    let columns = [
        ("item", "fabric"),
        ("triads", "triads with it"),
        ("wrong", "wrong"),
        ("percent", "%"),
        ("ci_low_percent", "95 % CI from"),
        ("ci_high_percent", "to"),
    ];
    let title = "Wrong answers by fabric; both fabrics of a triad count";
    let mut table = Table::new("errors", title, &columns);
    for (name, errors) in names.iter().zip(&found.errors) {
        let (wrong, n) = (errors.n_wrong as u64, errors.n_triads as u64);
        let mut row = vec![Cell::from(name.as_str()), n.into(), wrong.into()];
        row.push(if n > 0 {
            (100.0 * wrong as f64 / n as f64).into()
        } else {
            Cell::none("never asked")
        });
        row.extend(ends(&percent_interval(wrong, n)));
        table.push(row);
    }
    table
}
