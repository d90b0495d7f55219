//! `selvedge experiment run`: a session at a desk, on a terminal or from lines that are piped in.
//!
//! The experimenter lays what is said and types what the participant answers. Vibrations and
//! virtual textiles are presented by the window; here only where something else presents them.

use std::fs;
use std::io::{self, IsTerminal as _, Write as _};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant, SystemTime};

use clap::Args;

use super::super::{CliError, output, terminal};
use super::desk::{Bench, Desk, Ended, Moment};
use selvedge_experiment::by_hand::needs_array;
use selvedge_experiment::design::{Design, Subject};
use selvedge_experiment::session::{Found, Origin, Session, log_path};
use selvedge_experiment::{Apparatus, Course, Participant, Participants, Particulars, Proof};
use selvedge_foundation::files;
use selvedge_foundation::quantity::moment_of;
use selvedge_textile::Manifest;
use selvedge_textile::tactile::Tuning;

/// What presents cloth on the table.
const TABLE: &str = "cloth on the table";
/// How often a countdown is renewed.
const STEP: Duration = Duration::from_millis(100);

/// What to hold, with whom.
#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    /// Design: a file, or a name that "selvedge experiment designs" lists
    design: PathBuf,
    /// Pseudonym of the participant: letters, digits, - and _, and no real name
    #[arg(long, value_name = "PSEUDONYM")]
    subject: String,
    /// Which session of this participant, from 1 (the latest that was begun, or 1)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=9999))]
    session: Option<u32>,
    /// Folder of the study (the study's id, here)
    #[arg(long, value_name = "DIR")]
    folder: Option<PathBuf>,
    #[command(flatten)]
    described: ToldArgs,
    /// Go on with a session that was begun
    #[arg(long, conflicts_with = "restart")]
    resume: bool,
    /// Leave a session that was begun as it is, and begin the next
    #[arg(long)]
    restart: bool,
    /// Noted with the first trial that is answered
    #[arg(long, value_name = "TEXT")]
    note: Option<String>,
    /// Something else presents what only an array can: its name, for the log
    #[arg(long, value_name = "DEVICE", num_args = 0..=1, require_equals = true,
          default_missing_value = "elsewhere")]
    presented_elsewhere: Option<String>,
}

/// What is told of the participant.
#[derive(Debug, Args)]
struct ToldArgs {
    /// Age of the participant, years
    #[arg(long, value_name = "YEARS")]
    age: Option<u32>,
    /// female, male or other
    #[arg(long)]
    sex: Option<String>,
    /// right, left or both
    #[arg(long, value_name = "HAND")]
    handedness: Option<String>,
    /// One word: naive, practised, …
    #[arg(long, value_name = "WORD")]
    experience: Option<String>,
    /// One word: where the session is held
    #[arg(long, value_name = "WORD")]
    room: Option<String>,
}

/// Holds the session.
pub(super) fn run(args: &RunArgs) -> Result<(), CliError> {
    let design = super::designs::design(&args.design)?;
    let apparatus = apparatus(args, &design)?;
    let mut bench = Terminal::new();
    let mut session = opened(args, design, &apparatus.device, bench.now().utc)?;
    let (done, all) = session.progress();
    let begun = format!(
        "{}, participant {}, session {}: {done} of {all} trials done",
        session.design().title,
        session.subject().pseudonym,
        session.subject().session
    );
    let mut out = io::stdout().lock();
    writeln!(out, "{begun}")?;
    let log = session.log().to_owned();
    let mut desk = Desk {
        session: &mut session,
        typed: io::stdin().lock(),
        out,
        bench,
        apparatus,
        proof: match args.presented_elsewhere {
            None => Proof::RealCloth,
            Some(_) => Proof::Elsewhere,
        },
        notes: args.note.iter().cloned().collect(),
    };
    let ended = desk.hold()?;
    let (done, all) = session.progress();
    let left = format!("{done} of {all} trials are in {}", log.display());
    match ended {
        Ended::Finished => Ok(()),
        Ended::Quit => {
            terminal::notice(&format!("{left}; go on with --resume"));
            Ok(())
        }
        Ended::Silent => Err(CliError::Failed(format!(
            "nothing more was typed: {left}; go on with --resume"
        ))),
    }
}

/// What presents the stimuli.
fn apparatus(args: &RunArgs, design: &Design) -> Result<Apparatus, CliError> {
    let Some(device) = &args.presented_elsewhere else {
        if needs_array(design) {
            let what = "an array presents what this design asks about: hold it in the window \
                        (menu Experiment), or give --presented-elsewhere if something else \
                        presents it";
            return Err(CliError::Input(what.to_owned()));
        }
        return Ok(Apparatus {
            device: TABLE.to_owned(),
            ..Apparatus::default()
        });
    };
    Ok(Apparatus {
        device: device.clone(),
        tuning: tuning(args, design)?,
        // What was really presented is not known here.
        stimulus_hash: String::new(),
    })
}

/// The tuning that the design asks for: its own, or its library's.
fn tuning(args: &RunArgs, design: &Design) -> Result<Tuning, CliError> {
    match design.tuning {
        Some(tuning) => Ok(tuning),
        None if !design.textile_ids().is_empty() => {
            Ok(design.open_library(folder_of(args), None)?.default_tuning())
        }
        None => Ok(Tuning::default()),
    }
}

/// Opens what was begun, or begins.
fn opened(
    args: &RunArgs,
    design: Design,
    device: &str,
    now: SystemTime,
) -> Result<Session, CliError> {
    let described = &args.described;
    let participant = Participant::new(
        &args.subject,
        Particulars {
            age_years: described.age,
            sex: described.sex.as_deref(),
            handedness: described.handedness.as_deref(),
            experience: described.experience.as_deref(),
            room: described.room.as_deref(),
        },
    )?;
    let folder = args
        .folder
        .clone()
        .unwrap_or_else(|| PathBuf::from(&design.study));
    let latest = latest(&folder, &design, &args.subject);
    let session = args.session.or(latest).unwrap_or(1);
    let subject = |session, nth| Subject {
        pseudonym: args.subject.clone(),
        nth,
        session,
    };
    let log = log_path(&folder, &design, &subject(session, 0));
    let is_begun = log.exists() && has_row(&log)?;
    if is_begun && !args.restart {
        return begun(args, &design, (&log, device), now);
    }
    if args.resume {
        let what = format!(
            "there is no session {session} of {} in {}; leave --resume out to begin it",
            args.subject,
            folder.display()
        );
        return Err(CliError::Input(what));
    }
    let next = if is_begun {
        latest.unwrap_or(session).saturating_add(1)
    } else {
        session
    };
    output::make_folder(&folder, "choose another with --folder")?;
    let known = manifests(args, &design)?;
    let known = known.iter().map(|(id, manifest)| (id.as_str(), manifest));
    let origin = Origin::file(device, &args.design).knowing(known);
    let nth = Participants::enrol(&folder, &participant, now)?;
    Ok(Session::create(
        &folder,
        design,
        subject(next, nth),
        origin,
    )?)
}

/// What is known of the textiles that the design asks about: levels may be known to a band only.
fn manifests(args: &RunArgs, design: &Design) -> Result<Vec<(String, Manifest)>, CliError> {
    let ids = design.textile_ids();
    if ids.is_empty() {
        return Ok(Vec::new());
    }
    let library = design.open_library(folder_of(args), None)?;
    let of = |id: String| Ok((id.clone(), library.manifest(&id)?));
    ids.into_iter().map(of).collect()
}

/// The folder of the design, from which its library is found.
fn folder_of(args: &RunArgs) -> &Path {
    args.design.parent().unwrap_or_else(|| Path::new(""))
}

/// A session whose log is there: what is in it is told, and it is opened where that was asked for.
fn begun(
    args: &RunArgs,
    design: &Design,
    (log, device): (&Path, &str),
    now: SystemTime,
) -> Result<Session, CliError> {
    let found = Found::read(log)?;
    let (done, all) = Course::resume(&found.design, &found.subject, &found.records)?.progress();
    let last = found.records.last();
    let last = last.and_then(|last| moment_of(&last.timing.response_utc));
    let gap = last.and_then(|last| now.duration_since(last).ok());
    let gap = gap.map_or_else(String::new, |gap| format!(", the last {} ago", span(gap)));
    let (nth, who) = (found.subject.session, &found.subject.pseudonym);
    let described = format!("session {nth} of {who} has {done} of {all} trials done{gap}");
    if !args.resume {
        let what = if done == all {
            format!("{described}: it is finished; --restart begins another")
        } else {
            format!("{described}; give --resume to go on, or --restart to begin another")
        };
        return Err(CliError::Input(what));
    }
    if found.design.hash != design.hash {
        let what = format!(
            "{} was changed since session {nth} of {who} was begun; resume with the design as it \
             was, which {} holds, or give --restart to begin another session",
            args.design.display(),
            log.with_extension("json").display()
        );
        return Err(CliError::Input(what));
    }
    let session = Session::resume(log, device)?;
    terminal::notice(&described);
    let aside = session.openings().last();
    if let Some(aside) = aside.and_then(|opening| opening.set_aside.as_ref()) {
        terminal::notice(&format!(
            "a row was cut off; it was put into {aside}, and its trial comes again"
        ));
    }
    Ok(session)
}

/// The highest session of a subject that was begun.
fn latest(folder: &Path, design: &Design, pseudonym: &str) -> Option<u32> {
    let stem = format!("{}_{}_{pseudonym}_", design.study, design.experiment);
    let entries = fs::read_dir(folder).ok()?;
    let number = |name: &str| -> Option<u32> {
        let name = name.strip_prefix(&stem)?.strip_suffix(".csv")?;
        name.parse().ok()
    };
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    names.filter_map(|name| number(&name)).max()
}

/// Whether there is a row below the header of a log.
fn has_row(log: &Path) -> Result<bool, CliError> {
    let is_empty = log.metadata().is_ok_and(|file| file.len() == 0);
    Ok(!is_empty && files::read_text(log)?.lines().nth(1).is_some())
}

/// A gap as people say it.
fn span(gap: Duration) -> String {
    let minutes = gap.as_secs() / 60;
    let (hours, days) = (minutes / 60, minutes / (24 * 60));
    match (days, hours) {
        (0, 0) => format!("{minutes} min"),
        (0, _) => format!("{hours} h {} min", minutes % 60),
        _ => format!("{days} d {} h", hours % 24),
    }
}

/// The clocks of this machine, and a countdown on stderr.
struct Terminal {
    opened: Instant,
    is_terminal: bool,
}

impl Terminal {
    fn new() -> Self {
        Self {
            opened: Instant::now(),
            is_terminal: io::stderr().is_terminal(),
        }
    }
}

impl Bench for Terminal {
    fn now(&mut self) -> Moment {
        let since_ns = self.opened.elapsed().as_nanos();
        Moment {
            utc: SystemTime::now(),
            since_ns: u64::try_from(since_ns).unwrap_or(u64::MAX),
        }
    }

    fn count_down(&mut self, seconds: f64) -> io::Result<()> {
        let begun = Instant::now();
        let all = Duration::try_from_secs_f64(seconds).unwrap_or_default();
        while let Some(left) = all.checked_sub(begun.elapsed()) {
            if left.is_zero() {
                break;
            }
            if self.is_terminal {
                let shown = left.as_secs_f64().ceil();
                write!(io::stderr(), "\r\x1b[2K{shown} s")?;
                io::stderr().flush()?;
            }
            thread::sleep(left.min(STEP));
        }
        if self.is_terminal {
            write!(io::stderr(), "\r\x1b[2K")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_is_told_in_what_matters_of_it() {
        let described = |minutes: u64| span(Duration::from_secs(60 * minutes));
        assert_eq!(described(0), "0 min");
        assert_eq!(described(59), "59 min");
        assert_eq!(described(61), "1 h 1 min");
        assert_eq!(described(24 * 60 * 3 + 125), "3 d 2 h");
    }
}
