//! The form that a session begins with, and what its folder holds.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::bench::Bench;
use crate::bench::background::Task;
use crate::bench::latest::Latest;
use crate::bench::pane::Pane;
use crate::tools::experiment::builder::looked::{Looked, Looking};
use crate::tools::experiment::builder::study_text::{Chosen, StudyText};
use crate::tools::experiment::held::Held;
use crate::tools::experiment::who::Who;
use selvedge_experiment::design::{Design, Subject};
use selvedge_experiment::session::{Found, log_path};
use selvedge_experiment::{Participant, Participants, Plan, Preview};
use selvedge_foundation::progress::Progress;

/// The file of the masking noise in the folder of sessions.
pub(crate) const NOISE_FILE: &str = "masking-noise.wav";

/// The effect that power is said for at first.
const EFFECT: f64 = 1.0;

/// What the next session is to be.
#[derive(Debug)]
pub(crate) struct Form {
    /// The design at hand.
    pub(crate) study: StudyText,
    /// What it comes to, once somebody looked.
    pub(crate) looked: Latest<Looking, Looked>,
    /// The effect that power is said for.
    pub(crate) effect: f64,
    /// Who takes part.
    pub who: Who,
    /// Which session of this participant, from 1.
    pub session: String,
    /// Where sessions lie.
    pub folder: String,
    /// Why the last attempt to begin failed.
    pub failure: Option<String>,
    /// The sessions of the folder, as far as they were listed.
    pub found: Vec<Held>,
    /// Its logs that cannot be read, a line each.
    pub unread: Vec<String>,
    /// Who took part there, as far as that was listed.
    pub participants: Participants,
    /// Whether a masking noise lies there.
    pub(crate) has_noise: bool,
    /// They are being listed.
    pub listing: Option<Task<Listed>>,
    /// The folder that was listed last.
    listed: Option<String>,
}

/// What a folder holds.
#[derive(Debug, Default)]
pub(crate) struct Listed {
    /// Its sessions.
    pub found: Vec<Held>,
    /// Its logs that cannot be read, a line each.
    pub unread: Vec<String>,
    /// Its table of participants.
    pub participants: Participants,
    /// Whether a masking noise was written there.
    pub(crate) has_noise: bool,
}

impl Default for Form {
    fn default() -> Self {
        Self {
            study: StudyText::default(),
            looked: Latest::default(),
            effect: EFFECT,
            who: Who::default(),
            session: "1".to_owned(),
            folder: String::new(),
            failure: None,
            found: Vec::new(),
            unread: Vec::new(),
            participants: Participants::default(),
            has_noise: false,
            listing: None,
            listed: None,
        }
    }
}

impl Form {
    /// Takes another design; one that cannot be read is told, and the last one stays.
    pub(crate) fn choose(&mut self, chosen: Chosen) {
        self.failure = self.study.choose(chosen).err();
    }

    /// Counts what the design comes to, in the background.
    pub(crate) fn look(&mut self, bench: &Bench) {
        self.looked.poll();
        let is_seen = bench.shows(Pane::Experimenter) || bench.shows(Pane::Builder);
        if !is_seen || self.study.design().is_err() {
            return;
        }
        let looking = Looking {
            text: self.study.text().to_owned(),
            path: self.study.chosen().path().to_owned(),
            effect: self.effect,
        };
        self.looked.follow(&bench.ctx, &bench.executor, &looking);
    }

    /// What the design comes to, if that was counted.
    pub(crate) fn preview(&self) -> Option<&Preview> {
        self.looked.value()?.preview.as_ref().ok()
    }

    /// Why no session can begin yet, if so.
    pub(crate) fn refusal(&self) -> Option<String> {
        if let Err(fault) = self.study.design() {
            return Some(fault.line.clone());
        }
        if self.study.is_changed() {
            let mend = "The design was changed: save it in the Study builder first";
            return Some(mend.to_owned());
        }
        if !Design::is_name(self.who.pseudonym.trim()) {
            let mend = "Give a pseudonym of letters, digits, - and _, and no real name";
            return Some(mend.to_owned());
        }
        match self.who.participant() {
            Err(line) => return Some(line),
            Ok(described) => {
                let contradiction = self.participants.contradiction(&described);
                if contradiction.is_some() {
                    return contradiction;
                }
            }
        }
        if self.session_number().is_none() {
            return Some("Number the sessions of a participant from 1".to_owned());
        }
        if self.folder.trim().is_empty() {
            return Some("Say in which folder the session is kept".to_owned());
        }
        None
    }

    /// What begins, if nothing is missing.
    pub(crate) fn plan(&self) -> Option<SessionPlan> {
        if self.refusal().is_some() {
            return None;
        }
        Some(SessionPlan {
            design: self.study.design().ok()?.clone(),
            participant: Some(self.who.participant().ok()?),
            session: self.session_number()?,
            folder: self.folder(),
        })
    }

    /// Why no pilot can begin yet, if so.
    pub(crate) fn pilot_refusal(&self) -> Option<String> {
        match self.study.design() {
            Err(fault) => Some(fault.line.clone()),
            Ok(_) if self.folder.trim().is_empty() => {
                Some("Say in which folder the pilot is kept".to_owned())
            }
            Ok(_) => None,
        }
    }

    /// A pilot of the design: its logs lie in a folder of their own.
    pub(crate) fn pilot_plan(&self) -> Option<SessionPlan> {
        if self.pilot_refusal().is_some() {
            return None;
        }
        Some(SessionPlan {
            design: self.study.design().ok()?.clone(),
            participant: None,
            session: 1,
            folder: self.folder().join("pilots"),
        })
    }

    /// Takes up the folder and the design of the last run; a design that is none any more is left.
    pub(crate) fn take_up(&mut self, folder: Option<&str>, design: Option<&str>) {
        folder.unwrap_or_default().clone_into(&mut self.folder);
        if let Some(chosen) = design.and_then(Chosen::from_word) {
            self.choose(chosen);
            self.study.begin_here();
        }
    }

    /// The folder as it is kept for the next run.
    pub(crate) fn kept_folder(&self) -> Option<String> {
        let folder = self.folder.trim();
        (!folder.is_empty()).then(|| folder.to_owned())
    }

    /// Whether the folder that was typed is another than the one that was listed.
    pub(crate) fn is_to_be_listed(&self) -> bool {
        let folder = self.folder.trim();
        !folder.is_empty() && self.listing.is_none() && self.listed.as_deref() != Some(folder)
    }

    /// The folder is being listed.
    pub(crate) fn lists(&mut self, task: Task<Listed>) {
        self.listed = Some(self.folder.trim().to_owned());
        self.listing = Some(task);
    }

    /// Takes what a folder holds.
    pub(crate) fn take_listed(&mut self, listed: Listed) {
        self.found = listed.found;
        self.unread = listed.unread;
        self.participants = listed.participants;
        self.has_noise = listed.has_noise;
        self.who.leave_table();
        self.who.follow(&self.participants);
    }

    /// Where sessions lie.
    pub(crate) fn folder(&self) -> PathBuf {
        PathBuf::from(self.folder.trim())
    }

    fn session_number(&self) -> Option<u32> {
        let number = self.session.trim().parse().ok();
        number.filter(|number| *number >= 1)
    }
}

/// A session that is to begin, and with whom.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SessionPlan {
    /// By which design.
    pub design: Design,
    /// Who takes part; nobody in a pilot.
    pub participant: Option<Participant>,
    /// Which session of the participant, from 1.
    pub session: u32,
    /// Where sessions lie.
    pub folder: PathBuf,
}

impl SessionPlan {
    /// Who takes part, before they are enrolled.
    fn subject(&self) -> Subject {
        let participant = self.participant.as_ref();
        Subject {
            pseudonym: participant
                .map_or("pilot", Participant::pseudonym)
                .to_owned(),
            nth: 0,
            session: self.session,
        }
    }

    /// What will be written, a line each.
    pub(crate) fn describe(&self, device: &str) -> Vec<String> {
        let Self { design, folder, .. } = self;
        let log = log_path(folder, design, &self.subject());
        let plan = Plan::path(folder, design);
        let held = if plan.exists() {
            format!("by the plan {}", plan.display())
        } else {
            "by no plan".to_owned()
        };
        vec![
            format!("log {}", log.display()),
            format!("design SHA-256 {}…, {held}", &design.hash[..12]),
            format!("device {device}"),
        ]
    }

    /// Enrols the participant in the study's table, as the command line does, and numbers the
    /// session.
    ///
    /// # Errors
    /// The session was begun before, other particulars were told of this pseudonym, or the folder
    /// cannot be read or written.
    pub(crate) fn enrolled(&self) -> Result<Subject, String> {
        let Self { design, folder, .. } = self;
        let mut subject = self.subject();
        let Some(participant) = &self.participant else {
            while log_path(folder, design, &subject).exists() {
                subject.session += 1;
            }
            return Ok(subject);
        };
        if log_path(folder, design, &subject).exists() {
            let mend = "resume it on the Study board, or number another session";
            let (who, nth) = (&subject.pseudonym, subject.session);
            return Err(format!("session {nth} of {who} was begun before; {mend}"));
        }
        fs::create_dir_all(folder).map_err(|error| {
            let folder = folder.display();
            format!("cannot make the folder {folder}: {error}; choose another")
        })?;
        let enrolled = Participants::enrol(folder, participant, SystemTime::now());
        subject.nth = enrolled.map_err(|error| error.to_string())?;
        Ok(subject)
    }
}

/// What a folder holds; one that is not there yet holds nothing, unless it was asked for.
pub(crate) fn list(
    folder: &Path,
    is_asked: bool,
    progress: &mut Progress<'_>,
) -> Result<Listed, String> {
    if !folder.exists() {
        if !is_asked {
            return Ok(Listed::default());
        }
        let folder = folder.display();
        return Err(format!("there is no folder {folder}; check the path"));
    }
    let described = |error: selvedge_experiment::ExperimentError| error.to_string();
    let (mut found, unread) = Found::in_folder(folder).map_err(described)?;
    Found::verify_stimuli(&mut found, progress).map_err(described)?;
    Ok(Listed {
        found: found.iter().map(Held::of).collect(),
        unread: unread.into_iter().map(|one| described(one.error)).collect(),
        participants: Participants::read(folder).map_err(described)?,
        has_noise: folder.join(NOISE_FILE).is_file(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tools::experiment::builder::study_text::Target;

    #[test]
    fn folder_and_design_of_the_last_run_are_taken_up_unless_the_design_is_gone() {
        let mut form = Form::default();
        form.choose(Chosen::Shipped("rating"));
        form.folder = " /lab/study ".to_owned();
        let (folder, design) = (form.kept_folder(), form.study.chosen().word());
        let mut next = Form::default();
        next.take_up(folder.as_deref(), design.as_deref());
        assert_eq!(
            (next.folder.as_str(), next.study.chosen()),
            ("/lab/study", form.study.chosen())
        );
        let mut other = Form::default();
        other.take_up(None, Some("/nowhere/design.toml"));
        assert_eq!(
            (other.folder.as_str(), other.study.chosen()),
            ("", Form::default().study.chosen())
        );
        assert!(other.study.design().is_ok() && next.study.steps().names.is_empty());
    }

    #[test]
    fn a_form_says_what_is_missing_until_a_session_can_begin() {
        let mut form = Form::default();
        assert!(form.refusal().unwrap().contains("pseudonym"));
        form.who.pseudonym = "Ada Lovelace".to_owned();
        assert!(form.refusal().unwrap().contains("no real name"));
        form.who.pseudonym = " p07 ".to_owned();
        assert!(form.refusal().unwrap().contains("folder"));
        form.folder = "/tmp/sessions".to_owned();
        form.session = "0".to_owned();
        assert!(form.refusal().unwrap().contains("from 1"));
        form.session = "2".to_owned();
        let plan = form.plan().unwrap();
        let who = plan.participant.as_ref().map(Participant::pseudonym);
        assert_eq!((who, plan.session), (Some("p07"), 2));
        form.who.age = "thirty".to_owned();
        assert!(form.refusal().unwrap().contains("whole years"));
        form.who.age = "300".to_owned();
        assert!(form.refusal().unwrap().contains("1 to 120"));
        form.who.age = " 30 ".to_owned();
        form.who.room = "Ada's room".to_owned();
        assert!(form.refusal().unwrap().contains("one word"));
        form.who.room.clear();
        assert_eq!(form.refusal(), None);
        form.choose(Chosen::File("/nowhere/design.toml".into()));
        assert!(form.failure.as_ref().unwrap().contains("nowhere"));
        assert!(form.plan().is_some(), "the last design stays");
        let text = format!("{}\n# mine\n", form.study.text());
        let now = crate::bench::history::Moment::default();
        form.study.write(text, (Target::Text, "text"), now);
        assert!(form.refusal().unwrap().contains("save it"));
        assert!(form.pilot_plan().is_some(), "a pilot needs no file");
    }
}
