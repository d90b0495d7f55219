//! A session that was begun as the study board knows it, and what a study lacks.

use std::path::PathBuf;

use crate::bench::session::title_of;
use selvedge_experiment::design::Subject;
use selvedge_experiment::session::Found;
use selvedge_experiment::{Course, Proof, Validity};

/// A session that was begun.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Held {
    /// Its log.
    pub(crate) log: PathBuf,
    /// The design's title.
    pub(crate) title: String,
    /// SHA-256 of the design.
    pub(crate) design_sha256: String,
    /// Who took part.
    pub(crate) subject: Subject,
    /// Trials answered and trials there are at most.
    pub(crate) progress: (usize, usize),
    /// Rows that count, that do not, and of which that is not known.
    pub(crate) counts: [usize; 3],
    /// Who felt nothing; `None` where somebody did.
    pub(crate) unfelt: Option<&'static str>,
    /// How it stands.
    pub(crate) standing: Standing,
}

/// How a session stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Standing {
    /// All is answered, and its log closed.
    Complete,
    /// It can be resumed.
    Open,
    /// It is being held now.
    Held,
    /// Its files are not as they were written: what is wrong, a line each.
    Broken(Vec<String>),
}

impl Held {
    /// Of a session that was found.
    pub(crate) fn of(found: &Found) -> Self {
        let course = Course::resume(&found.design, &found.subject, &found.records);
        let progress = course
            .as_ref()
            .map_or((found.records.len(), 0), Course::progress);
        let rows = found.records.iter().filter(|row| !row.trial.is_practice);
        let mut counts = [0; 3];
        for row in rows {
            counts[match row.presentation.validity() {
                Validity::Valid => 0,
                Validity::Void => 1,
                Validity::Unknown => 2,
            }] += usize::from(row.answer().is_some() || !row.presentation.void.is_empty());
        }
        let proof = found.records.iter().find_map(|row| row.presentation.proof);
        let is_over = course.is_ok_and(|course| course.is_over());
        Self {
            log: found.log.clone(),
            title: title_of(&found.design),
            design_sha256: found.design.hash.clone(),
            subject: found.subject.clone(),
            progress,
            counts,
            unfelt: match proof {
                Some(Proof::Emulator) => Some("on an emulator"),
                Some(Proof::Screen) => Some("a pilot"),
                Some(Proof::Simulated) => Some("simulated"),
                _ => None,
            },
            standing: if !found.breaks.is_empty() {
                Standing::Broken(found.breaks.iter().map(ToString::to_string).collect())
            } else if found.is_held() {
                Standing::Held
            } else if found.is_closed || is_over {
                Standing::Complete
            } else {
                Standing::Open
            },
        }
    }
}

/// What a study has and lacks, in lines: by its design, as far as sessions are by that.
pub(crate) fn missing(found: &[Held], n_planned: usize, design_sha256: &str) -> Vec<String> {
    let own = || {
        found
            .iter()
            .filter(|one| one.design_sha256 == design_sha256)
    };
    let names = |wanted: &dyn Fn(&Held) -> bool| {
        let mut names: Vec<&str> = Vec::new();
        for one in own().filter(|one| wanted(one)) {
            let name = one.subject.pseudonym.as_str();
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names
    };
    let complete = names(&|one| one.standing == Standing::Complete && one.unfelt.is_none());
    let mut lines = vec![match n_planned {
        0 => format!(
            "{} subjects have a complete session that counts",
            complete.len()
        ),
        n => {
            let missing = n.saturating_sub(complete.len());
            let n_complete = complete.len();
            format!("{n_complete} of {n} subjects have a complete session; {missing} are missing")
        }
    }];
    let mut say = |what: &str, names: &[&str]| {
        if !names.is_empty() {
            lines.push(format!("{what}: {}", names.join(", ")));
        }
    };
    say(
        "Open, can be resumed",
        &names(&|one| one.standing == Standing::Open),
    );
    say(
        "Left out",
        &names(&|one| matches!(one.standing, Standing::Broken(_))),
    );
    say("Felt by nobody", &names(&|one| one.unfelt.is_some()));
    let n_other = found.len() - own().count();
    if n_other > 0 {
        lines.push(format!(
            "{n_other} sessions are by another design than the one at hand"
        ));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn held(name: &str, standing: Standing, unfelt: Option<&'static str>) -> Held {
        Held {
            log: format!("{name}.csv").into(),
            title: "A study".to_owned(),
            design_sha256: "abc".to_owned(),
            subject: Subject {
                pseudonym: name.to_owned(),
                nth: 0,
                session: 1,
            },
            progress: (1, 9),
            counts: [1, 0, 0],
            unfelt,
            standing,
        }
    }

    #[test]
    fn what_is_missing_is_told_by_name() {
        let broken = Standing::Broken(vec!["p03.csv:4: cut".to_owned()]);
        let mut all = vec![
            held("p01", Standing::Complete, None),
            held("p01", Standing::Open, None),
            held("p02", Standing::Complete, Some("on an emulator")),
            held("p03", broken, None),
        ];
        let lines = missing(&all, 8, "abc");
        assert_eq!(
            lines,
            [
                "1 of 8 subjects have a complete session; 7 are missing",
                "Open, can be resumed: p01",
                "Left out: p03",
                "Felt by nobody: p02",
            ]
        );
        all[0].design_sha256 = "other".to_owned();
        let lines = missing(&all, 0, "abc");
        assert!(lines[0].starts_with("0 subjects"), "{lines:?}");
        assert!(
            lines[4].starts_with("1 sessions are by another design"),
            "{lines:?}"
        );
    }
}
