//! The odd one of three (Allerkamp et al.): how often it was found and how easily, which fabrics
//! were mistaken, and the distances that follow.

use super::answers::{n_right, percent, triad_answer, triads};
use super::draw::{Bar, bars, share_bars};
use super::included_trials::{Experiment, Session, Subject};
use super::map::Mapping;
use super::model::{Cell, Section, Table, cells, known, percent_interval, percent_of};
use super::odd_one_out_craven::Craven;
use super::options::Options;
use super::properties::Measures;
use super::tables::{D_PRIME_NOTE, SUMMARY, group_d_prime, matrix, summary_cells, tests};
use super::{odd_one_out_craven, odd_one_out_variants};
use crate::design::{Composition, Confidence};
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_statistics::detection::{Correction, Relation};
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
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<Vec<Section>, Cancelled> {
    let names = experiment.ids();
    let own_weights = grade_weights(&experiment.design.composition);
    let all: Vec<TriadAnswer> = experiment.subjects.iter().flat_map(triads).collect();
    let mut sections = vec![accuracy(experiment, options), grades(experiment)];
    let found = match OddOneOut::of(names.len(), &all, own_weights) {
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
        let own = OddOneOut::of(names.len(), &triads(subject), own_weights).ok()?;
        Some(own.mean_weights())
    };
    let subjects: Vec<Vec<Option<f64>>> =
        experiment.subjects.iter().filter_map(of_subject).collect();
    // Sums compare only where every pair was asked as often.
    let is_balanced = found.is_balanced();
    let mapping = Mapping {
        key: experiment.key("map"),
        title: experiment.titled("map"),
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

/// What a right answer is worth by its grade.
pub(crate) fn grade_weights(composition: &Composition) -> GradeWeights {
    match &composition.response.confidence {
        Confidence::Words(words) => {
            let weight = |at: usize| words.get(at).map_or(1.0, |(_, weight)| *weight);
            [0, 1, 2].map(weight).into()
        }
        _ => [1.0; 3].into(),
    }
}

const SHARES: &str = "subject; session; triads; right; percent: %; ci_low_percent: 95 % CI from; \
    ci_high_percent: to; p: exact binomial p, above ⅓; d_prime: d′, triangle; d_prime_ci_low: 95 \
    % CI from; d_prime_ci_high: to";

fn share_row(subject: &str, session: Cell, answers: &[TriadAnswer]) -> Vec<Cell> {
    let (right, n) = (n_right(answers), answers.len() as u64);
    let choice = Relation::Triangle.choice(right, n, Correction::LogLinear);
    cells![
        subject,
        session,
        n,
        right,
        percent_of(right, n, "no triads"),
        percent_interval(right, n),
        exact_binomial(right, n, CHANCE, Sides::Greater).map(|o| o.p),
        choice.as_ref().map(|c| c.d_prime),
        choice.and_then(|c| c.interval),
    ]
}

fn accuracy(experiment: &Experiment<'_>, options: &Options) -> Section {
    let mut section = experiment.section("accuracy", "accuracy");
    section.note(
        "Chance is ⅓. d′ is that of the triangle test without bias; below chance it is 0. \
         Intervals of shares are Wilson's, p is exact (binomial).",
    );
    section.note(D_PRIME_NOTE);
    let mut table = Table::new("subjects", "Right answers by subject and session", SHARES);
    let mut shown = Vec::new();
    for subject in &experiment.subjects {
        for session in &subject.sessions {
            let number = session.found.subject.session.into();
            table.push(share_row(subject.name, number, &of_session(session)));
        }
        let all = triads(subject);
        if subject.sessions.len() > 1 {
            table.push(share_row(subject.name, "all".into(), &all));
        }
        shown.push(Bar::share(subject.name, n_right(&all), all.len() as u64));
    }
    section.table(table);
    let subjects = experiment.subjects.iter();
    let counts: Vec<[u64; 2]> = subjects.map(|one| one.n_right().into()).collect();
    let percents: Vec<f64> = experiment
        .subjects
        .iter()
        .map(Subject::percent_right)
        .collect();
    let group = Some(group_d_prime(
        counts.len(),
        Relation::Triangle.group(&counts),
    ));
    section.over_subjects(&[("right, %", percents.clone())], group, options);
    let against = "right, % against 33.3";
    let t = Summary::of(&percents).and_then(|s| one_sample_t(&s, CHANCE_PERCENT));
    let found = [
        (against, t),
        (against, wilcoxon_signed_rank(&percents, CHANCE_PERCENT)),
        ("sessions, right, %", over_sessions(experiment)),
    ];
    let title = "Against chance, and session against session";
    section.table(tests("tests", title, &found));
    shown.extend(Bar::mean("mean", "", &percents));
    let title = experiment.titled("right answers");
    let words = (title.as_str(), "right, %");
    let rule = (CHANCE_PERCENT, "chance");
    section.figure(share_bars("subjects-bars", words, &shown, rule));
    section
}

fn of_session(session: &Session<'_>) -> Vec<TriadAnswer> {
    session
        .trials
        .iter()
        .filter_map(|r| triad_answer(r))
        .collect()
}

/// Whether sessions differ, over subjects who took part in as many.
fn over_sessions(experiment: &Experiment<'_>) -> Computed<Outcome> {
    let subjects = &experiment.subjects;
    let most = subjects.iter().map(|s| s.sessions.len()).max();
    if most.is_none_or(|most| most < 2) {
        return Err(Undefined::because("one session each"));
    }
    let of = |session: &Session<'_>| percent(&of_session(session));
    let with_all = subjects.iter().filter(|s| Some(s.sessions.len()) == most);
    let rows: Vec<Vec<f64>> = with_all
        .map(|subject| subject.sessions.iter().map(of).collect())
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
    let mut section = experiment.section("grades", "easy, normal, hard");
    section.note("Shares of a subject's right (or wrong) answers with each grade.");
    let columns = format!("answers; grade; count; {SUMMARY}");
    let title = "Grades of right and wrong answers: shares over subjects, %";
    let mut table = Table::new("grades", title, &columns);
    let mut shown = Vec::new();
    for (name, is_correct) in [("right", true), ("wrong", false)] {
        for grade in Grade::ALL {
            let (count, shares) = graded(experiment, is_correct, grade);
            let described = grade.name();
            table.push(cells![name, described, count, summary_cells(&shares)]);
            shown.extend(Bar::mean(described, &format!("{name} answers"), &shares));
        }
    }
    section.table(table);
    let title = experiment.titled("how hard right and wrong answers were");
    let shown = (shown.as_slice(), Some([0.0, 100.0]));
    section.figure(bars(
        "bars",
        &title,
        "share of answers, % (95 % interval)",
        shown,
        &[],
    ));
    section
}

/// Sums of weights, and errors by fabric.
fn distances(experiment: &Experiment<'_>, found: &OddOneOut, names: &[String]) -> Section {
    let mut section = experiment.section("distances", "distances");
    let GradeWeights { easy, normal, hard } = found.weights;
    section.note(format!(
        "A right answer counts {easy}, {normal} or {hard} as it was easy, normal or hard, a \
         wrong one 0; the distance of two fabrics is the sum over all answers. {} pairs are \
         at the ceiling (always right and easy), {} at the floor, {} were never asked.",
        found.n_ceiling, found.n_floor, found.n_missing
    ));
    let cells = found.distances().into_iter();
    let cells = cells.map(|d| known(d, "itself, or never asked"));
    section.table(matrix("distances", "Sums of weights", names, cells));
    section.table(errors_by_fabric(found, names));
    section
}

fn errors_by_fabric(found: &OddOneOut, names: &[String]) -> Table {
    let columns = "item: fabric; triads: triads with it; wrong; percent: %; ci_low_percent: 95 % \
        CI from; ci_high_percent: to";
    let title = "Wrong answers by fabric; both fabrics of a triad count";
    let mut table = Table::new("errors", title, columns);
    for (name, errors) in names.iter().zip(&found.errors) {
        let (wrong, n) = (errors.n_wrong as u64, errors.n_triads as u64);
        let share = percent_of(wrong, n, "never asked");
        table.push(cells![name, n, wrong, share, percent_interval(wrong, n)]);
    }
    table
}
