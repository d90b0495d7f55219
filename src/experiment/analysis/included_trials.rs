//! What of the sessions is analysed: experiments apart, practice and aborted trials left out, then
//! the design's own rules, every one of them listed.

use std::collections::BTreeMap;

use super::model::{Cell, Section, Table, cells, file_name};
use super::what_counts::{catch_verdicts, is_pilot, left_out_void, out_row, planned};
use crate::design::{Design, Rules};
use crate::record::{Outcome, Record};
use crate::session::Found;
use crate::{Course, Validity};

/// One experiment: a design, and the subjects whose trials count.
#[derive(Debug)]
pub(super) struct Experiment<'a> {
    /// Begins the keys of its sections; no two experiments share one.
    pub(super) key: String,
    pub(super) design: &'a Design,
    /// By pseudonym.
    pub(super) subjects: Vec<Subject<'a>>,
    /// Sessions of this design, left out or not.
    pub(super) sessions: Vec<&'a Found>,
    found: Section,
}

/// A subject's trials that count, session by session.
#[derive(Debug)]
pub(super) struct Subject<'a> {
    pub(super) name: &'a str,
    pub(super) sessions: Vec<Session<'a>>,
}

/// The trials of a session that count.
#[derive(Debug)]
pub(super) struct Session<'a> {
    pub(super) found: &'a Found,
    pub(super) trials: Vec<&'a Record>,
}

impl<'a> Subject<'a> {
    /// Right answers, and answers that are right or wrong.
    pub(super) fn n_right(&self) -> (u64, u64) {
        let verdicts = self.trials().filter_map(|r| r.is_correct);
        verdicts.fold((0, 0), |(right, n), is_right| {
            (right + u64::from(is_right), n + 1)
        })
    }

    /// Right answers, %.
    pub(super) fn percent_right(&self) -> f64 {
        let (right, n) = self.n_right();
        100.0 * right as f64 / n as f64
    }

    /// All trials, session after session.
    pub(super) fn trials(&self) -> impl Iterator<Item = &'a Record> + '_ {
        self.sessions.iter().flat_map(|s| s.trials.iter().copied())
    }
}

impl Experiment<'_> {
    /// What the section on what was found begins with.
    pub(super) fn sessions_section(&self) -> Section {
        self.found.clone()
    }

    pub(super) fn ids(&self) -> Vec<String> {
        self.design.stimuli.iter().map(|s| s.id.clone()).collect()
    }

    /// The groups that stimuli are kept apart by, in the order of the design; none where all are of
    /// one.
    pub(super) fn groups(&self) -> Vec<String> {
        let mut groups: Vec<String> = Vec::new();
        for stimulus in &self.design.stimuli {
            if !stimulus.group.is_empty() && !groups.contains(&stimulus.group) {
                groups.push(stimulus.group.clone());
            }
        }
        groups.retain(|group| self.design.stimuli.iter().any(|one| one.group != *group));
        groups
    }

    /// An empty section of this experiment.
    pub(super) fn section(&self, of: &str, title: &str) -> Section {
        Section::new(self.key(of), self.titled(title))
    }

    pub(super) fn titled(&self, what: &str) -> String {
        format!("{}: {what}", self.design.title)
    }

    /// The key of a section of this experiment.
    pub(super) fn key(&self, of: &str) -> String {
        format!("{}-{of}", self.key)
    }
}

/// The hash of a design, and the sessions that were held by it.
type Version<'a> = (&'a str, Vec<&'a Found>);

/// The experiments in some sessions: one for every study, experiment and text of a design.
pub(super) fn experiments(all: &[Found]) -> Vec<Experiment<'_>> {
    let mut groups: BTreeMap<(&str, &str), Vec<Version<'_>>> = BTreeMap::new();
    for found in all {
        let design = &found.design;
        let of_name = groups
            .entry((&design.study, &design.experiment))
            .or_default();
        match of_name.iter_mut().find(|(hash, _)| *hash == design.hash) {
            Some((_, sessions)) => sessions.push(found),
            None => of_name.push((&design.hash, vec![found])),
        }
    }
    let mut experiments: Vec<Experiment<'_>> = Vec::new();
    for ((study, experiment), versions) in groups {
        let n_versions = versions.len();
        for (nth, (_, sessions)) in versions.into_iter().enumerate() {
            let version = if n_versions > 1 {
                format!("-design-{}", nth + 1)
            } else {
                String::new()
            };
            let own = file_name(&format!("{experiment}{version}"), '-');
            let is_taken = experiments.iter().any(|e| e.key == own);
            let key = if is_taken || own.is_empty() {
                file_name(&format!("{study}-{experiment}{version}"), '-')
            } else {
                own
            };
            let mut kept = keep(key, sessions);
            if n_versions > 1 {
                kept.found.note(format!(
                    "**{n_versions} different designs share this name.** Their sessions are \
                     analysed apart: this is design {}, SHA-256 {}…",
                    nth + 1,
                    &kept.design.hash[..12]
                ));
            }
            experiments.push(kept);
        }
    }
    experiments
}

fn keep(key: String, mut sessions: Vec<&Found>) -> Experiment<'_> {
    sessions.sort_by(|a, b| {
        let key = |found: &Found| (found.subject.pseudonym.clone(), found.subject.session);
        key(a).cmp(&key(b))
    });
    let design = &sessions[0].design;
    let mut section = Section::new(
        format!("{key}-sessions"),
        format!("{}: sessions", design.title),
    );
    describe_rules(design, &mut section);
    let mut table = Table::new("held", "Sessions, and what became of them", HELD);
    let mut left_out = Table::new("left-out", "What the rules leave out", LEFT_OUT);
    let mut subjects: Vec<Subject<'_>> = Vec::new();
    let are_all_pilots = sessions.iter().all(|found| is_pilot(found));
    for &found in &sessions {
        let session = Session {
            found,
            trials: answered(found, false),
        };
        table.push(held_row(&session));
        left_out_void(found, &mut left_out);
        if let Some(why) = why_out(&session, are_all_pilots) {
            left_out.push(out_row(found, &session.trials, &why));
            continue;
        }
        let session = without_fast(session, &mut left_out);
        let name = found.subject.pseudonym.as_str();
        match subjects.last_mut().filter(|subject| subject.name == name) {
            Some(subject) => subject.sessions.push(session),
            None => subjects.push(Subject {
                name,
                sessions: vec![session],
            }),
        }
    }
    subjects.retain(|subject| is_right_enough(subject, &design.rules, &mut left_out));
    subjects.retain(|subject| subject.trials().next().is_some());
    if let Some(planned) = planned(&sessions, subjects.len()) {
        section.table(planned);
    }
    section.table(table);
    if left_out.rows.is_empty() {
        section.note("The rules leave nothing out.");
    } else {
        section.table(left_out);
    }
    Experiment {
        key,
        design,
        subjects,
        sessions,
        found: section,
    }
}

/// Why a whole session is left out.
fn why_out(session: &Session<'_>, are_all_pilots: bool) -> Option<String> {
    let found = session.found;
    if let Some(first) = found.breaks.first() {
        return Some(match found.breaks.len() - 1 {
            0 => format!("not as it was written: {first}"),
            n => format!("not as it was written: {first}; and {n} more, see verify"),
        });
    }
    if is_pilot(found) && !are_all_pilots {
        return Some("a pilot: felt by nobody".to_owned());
    }
    let (n, least) = (session.trials.len(), found.design.rules.least_trials);
    (n < least).then(|| format!("{n} trials, fewer than {least}"))
}

const HELD: &str = "subject; session; trials: trials answered; planned: of at most; practice; \
    aborted; void; state; device; software: log";
const LEFT_OUT: &str = "subject; session; trials; why";

fn describe_rules(design: &Design, section: &mut Section) {
    let rules = &design.rules;
    section.note(format!(
        "Study `{}`, experiment `{}`, method {}, seed {}, design SHA-256 {}.",
        design.study,
        design.experiment,
        design.composition.kind().name(),
        design.seed,
        design.hash
    ));
    let mut texts = vec![match rules.subjects {
        0 => "the number of subjects was left open".to_owned(),
        n => format!("{n} subjects planned"),
    }];
    let left_out = rules.exclusions().into_iter();
    texts.extend(left_out.map(|what| format!("{what} is left out")));
    section.note(format!(
        "Settled in the design before the first subject: {}. Practice and aborted trials never \
         count.",
        texts.join("; ")
    ));
}

/// The trials of a session that were answered and count as presented, without practice: those that
/// catch, or the others.
pub(super) fn answered(found: &Found, is_catch: bool) -> Vec<&Record> {
    let counts = |record: &&Record| {
        let is_void = record.presentation.validity() == Validity::Void;
        let is_asked = !record.trial.is_practice && record.trial.task.is_catch == is_catch;
        is_asked && record.answer().is_some() && !is_void
    };
    found.records.iter().filter(counts).collect()
}

fn held_row(session: &Session<'_>) -> Vec<Cell> {
    let found = session.found;
    let n_practice = found.records.iter().filter(|r| r.trial.is_practice).count();
    let is_void = |r: &&Record| r.presentation.validity() == Validity::Void;
    let n_void = found.records.iter().filter(is_void).count();
    let is_aborted = |r: &&Record| r.outcome == Outcome::Aborted && !is_void(r);
    let n_aborted = found.records.iter().filter(is_aborted).count();
    let (planned, state) = match Course::resume(&found.design, &found.subject, &found.records) {
        Ok(course) => {
            let (n_done, n_all) = course.progress();
            let planned = n_all.saturating_sub(found.design.course.practice_trials);
            let state = match (course.is_over(), found.has_torn_row) {
                (true, _) => "complete".to_owned(),
                (false, false) => format!("**incomplete** ({n_done} of {n_all} with practice)"),
                (false, true) => "**incomplete**; its last row is torn and left out".to_owned(),
            };
            (Cell::from(planned), state)
        }
        Err(error) => (
            Cell::none("the log does not follow its design"),
            error.to_string(),
        ),
    };
    let device = found
        .records
        .last()
        .map_or("", |r| r.apparatus.device.as_str());
    let log = found.log.file_name().unwrap_or_default().to_string_lossy();
    let counts = [n_practice, n_aborted, n_void];
    cells![
        &found.subject.pseudonym,
        found.subject.session,
        session.trials.len(),
        planned,
        counts,
        state,
        device,
        log.into_owned(),
    ]
}

fn without_fast<'a>(mut session: Session<'a>, left_out: &mut Table) -> Session<'a> {
    let least_s = session.found.design.rules.least_response_s;
    let is_fast = |record: &&Record| record.timing.response_ms() < 1000.0 * least_s;
    let (fast, kept): (Vec<&Record>, Vec<&Record>) =
        session.trials.into_iter().partition(|r| is_fast(r));
    if !fast.is_empty() {
        let why = format!("answered in less than {least_s} s");
        left_out.push(out_row(session.found, &fast, &why));
    }
    session.trials = kept;
    session
}

fn is_right_enough(subject: &Subject<'_>, rules: &Rules, left_out: &mut Table) -> bool {
    let verdicts = subject.trials().filter_map(|r| r.is_correct).collect();
    let correct = (verdicts, rules.least_share_correct, "right");
    let catches = catch_verdicts(subject);
    let caught = (catches, rules.least_share_caught, "catch trials right");
    is_enough(subject, correct, left_out) && is_enough(subject, caught, left_out)
}

fn is_enough(
    subject: &Subject<'_>,
    (verdicts, least, what): (Vec<bool>, f64, &str),
    left_out: &mut Table,
) -> bool {
    if least <= 0.0 || verdicts.is_empty() {
        return true;
    }
    let n_right = verdicts.iter().filter(|right| **right).count();
    let share = n_right as f64 / verdicts.len() as f64;
    if share >= least {
        return true;
    }
    let why = format!(
        "{n_right} of {} {what}, less than {} %",
        verdicts.len(),
        100.0 * least
    );
    for session in &subject.sessions {
        left_out.push(out_row(session.found, &session.trials, &why));
    }
    false
}
