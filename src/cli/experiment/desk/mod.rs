//! A session as lines: what is to be laid and asked goes out, what was typed comes in.
//!
//! Knows no terminal and no clock: a [`Bench`] hands both in, so that a test can hold a session.

use std::io::{self, BufRead, Write};
use std::time::SystemTime;

use selvedge_experiment::by_hand::{Placed, form};
use selvedge_experiment::design::{Familiarisation, Movement};
use selvedge_experiment::session::{Circumstances, Session};
use selvedge_experiment::{
    Answer, Apparatus, ExperimentError, Presentation, Proof, Step, Timing, Trial,
};

/// What a session needs from the world.
pub(super) trait Bench {
    /// What time it is.
    fn now(&mut self) -> Moment;
    /// Waits for so many seconds, and shows those that are left.
    fn count_down(&mut self, seconds: f64) -> io::Result<()>;
}

/// A moment on two clocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Moment {
    /// On the wall.
    pub(super) utc: SystemTime,
    /// Since the session was opened, ns; never jumps.
    pub(super) since_ns: u64,
}

/// How it ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ended {
    /// Every trial is answered.
    Finished,
    /// The experimenter said so.
    Quit,
    /// There is nothing more to read.
    Silent,
}

/// Why it does not go on.
enum Stopped {
    Ended(Ended),
    /// The lines cannot be read or written.
    Lines(io::Error),
}

impl From<io::Error> for Stopped {
    fn from(error: io::Error) -> Self {
        Self::Lines(error)
    }
}

impl From<Ended> for Stopped {
    fn from(ended: Ended) -> Self {
        Self::Ended(ended)
    }
}

/// A session, somebody who types, and what they noted of the trial that waits.
pub(super) struct Desk<'a, R, W, B> {
    pub(super) session: &'a mut Session,
    pub(super) typed: R,
    pub(super) out: W,
    pub(super) bench: B,
    pub(super) apparatus: Apparatus,
    /// Who begins a trial confirms that it is presented: by this.
    pub(super) proof: Proof,
    pub(super) notes: Vec<String>,
}

/// What was typed.
enum Line {
    /// Nothing but Enter.
    Empty,
    Abort,
    Break,
    Text(String),
}

const COMMANDS: &str = "abort, note TEXT, break or quit";

impl<R: BufRead, W: Write, B: Bench> Desk<'_, R, W, B> {
    /// Holds the session to its end, or until somebody quits.
    ///
    /// # Errors
    /// The lines cannot be read or written. What was answered is on disk.
    pub(super) fn hold(&mut self) -> io::Result<Ended> {
        loop {
            let went_on = match self.session.step() {
                Step::Finished => {
                    let (n, log) = (self.session.n_rows(), self.session.log().display());
                    let described = format!("finished: {n} rows in {log}; thank you");
                    self.say(&described)?;
                    return Ok(Ended::Finished);
                }
                Step::Instructions(text) => {
                    let described = format!("read out:\n  {text}\nEnter goes on");
                    self.asked(&described)
                }
                Step::Familiarisation(movement) => self.practise(movement),
                Step::Break {
                    after_block,
                    least_s,
                } => self.rest(after_block, least_s),
                Step::Trial(trial) => {
                    let trial = trial.clone();
                    self.trial(&trial)
                }
            };
            match went_on {
                Ok(()) => {}
                Err(Stopped::Lines(error)) => return Err(error),
                Err(Stopped::Ended(ended)) => {
                    self.keep_notes()?;
                    return Ok(ended);
                }
            }
            if !matches!(self.session.step(), Step::Trial(_) | Step::Finished) {
                self.session.pass();
            }
        }
    }

    fn say(&mut self, text: &str) -> io::Result<()> {
        writeln!(self.out, "{text}")?;
        self.out.flush()
    }

    /// The next line that is no note, or how the session ends.
    fn line(&mut self) -> Result<Line, Stopped> {
        loop {
            let mut line = Vec::new();
            self.typed.read_until(b'\n', &mut line)?;
            if line.last() != Some(&b'\n') {
                // A line that was cut off is nobody's answer.
                return Err(Ended::Silent.into());
            }
            let line = String::from_utf8_lossy(&line);
            let (first, rest) = split(&line);
            match first {
                "" => return Ok(Line::Empty),
                "quit" => return Err(Ended::Quit.into()),
                "abort" => return Ok(Line::Abort),
                "break" => return Ok(Line::Break),
                "note" if rest.is_empty() => self.say("type note and what is to be noted")?,
                "note" => {
                    self.notes.push(rest.to_owned());
                    self.say("noted with the trial that waits")?;
                }
                _ => return Ok(Line::Text(line.trim().to_owned())),
            }
        }
    }

    /// Says something and waits for Enter.
    fn asked(&mut self, what: &str) -> Result<(), Stopped> {
        self.say(what)?;
        loop {
            match self.line()? {
                Line::Empty => return Ok(()),
                _ => self.say("press Enter to go on; note TEXT and quit work here too")?,
            }
        }
    }

    fn practise(&mut self, movement: Familiarisation) -> Result<(), Stopped> {
        let course = match movement.movement {
            Movement::Circular => "in circles",
            Movement::Linear => "to and fro on a line",
        };
        let Familiarisation {
            for_s,
            speed_mm_per_s,
            ..
        } = movement;
        let described = format!(
            "the participant practises moving {course} at {speed_mm_per_s} mm/s for {for_s} s: \
             Enter begins"
        );
        self.asked(&described)?;
        Ok(self.bench.count_down(for_s)?)
    }

    fn rest(&mut self, after_block: usize, least_s: f64) -> Result<(), Stopped> {
        let block = after_block + 1;
        if least_s > 0.0 {
            self.say(&format!(
                "a break of {least_s} s at least after block {block}"
            ))?;
            self.bench.count_down(least_s)?;
            return self.asked("Enter ends the break");
        }
        self.asked(&format!("a break after block {block}: Enter ends it"))
    }

    /// A trial until it is answered or given up.
    fn trial(&mut self, trial: &Trial) -> Result<(), Stopped> {
        loop {
            let Some(start) = self.begun(trial)? else {
                return Ok(());
            };
            let ask = form(self.session.design());
            self.say(&ask)?;
            loop {
                match self.line()? {
                    Line::Abort => return self.give_up(start),
                    Line::Break => {
                        self.pause()?;
                        break;
                    }
                    Line::Empty => self.say(&ask)?,
                    Line::Text(text) => {
                        let design = self.session.design();
                        match Answer::typed(design, &trial.task, &text) {
                            Ok(answer) => return self.write(Some(&answer), start),
                            Err(error) => self.say(&format!("{error} (or {COMMANDS})"))?,
                        }
                    }
                }
            }
        }
    }

    /// Says what to lay; the moment at which the participant begins, or none for a trial that was
    /// given up before.
    fn begun(&mut self, trial: &Trial) -> Result<Option<Moment>, Stopped> {
        let described = self.described(trial);
        loop {
            self.say(&described)?;
            match self.line()? {
                Line::Empty => return Ok(Some(self.bench.now())),
                Line::Abort => {
                    let now = self.bench.now();
                    return self.give_up(now).map(|()| None);
                }
                Line::Break => {
                    self.pause()?;
                }
                Line::Text(_) => {
                    self.say(&format!("the trial has not begun: Enter, {COMMANDS}"))?;
                }
            }
        }
    }

    fn described(&self, trial: &Trial) -> String {
        let (done, all) = self.session.progress();
        let kind = if trial.is_practice {
            "practice"
        } else {
            "trial"
        };
        let attempt = match self.session.attempt() {
            1 => String::new(),
            nth => format!(", attempt {nth}"),
        };
        let (number, block) = (trial.number + 1, trial.block + 1);
        let mut lines = vec![format!(
            "\n{kind} {number}, block {block}{attempt}: {done} of {all} done"
        )];
        let placed = Placed::all_of(self.session.design(), &trial.task).into_iter();
        lines.extend(placed.map(|placed| format!("  {:<16}{}", placed.place, placed.what)));
        lines.push("Enter when the participant begins".to_owned());
        lines.join("\n")
    }

    /// A break that the experimenter asked for; the trial begins anew after it.
    fn pause(&mut self) -> Result<(), Stopped> {
        let began = self.bench.now();
        self.asked("a break: Enter ends it, and the trial begins anew")?;
        let spent_ns = self.bench.now().since_ns.saturating_sub(began.since_ns);
        let seconds = spent_ns / 1_000_000_000;
        self.notes.push(format!("break of {seconds} s before this"));
        Ok(())
    }

    fn give_up(&mut self, start: Moment) -> Result<(), Stopped> {
        self.write(None, start)?;
        Ok(self.say("given up; it comes again")?)
    }

    /// Puts an answer on disk, or that the trial was given up; asks again while the disk refuses.
    fn write(&mut self, answer: Option<&Answer>, start: Moment) -> Result<(), Stopped> {
        let end = self.bench.now();
        let timing = Timing::between([start.utc, end.utc], [start.since_ns, end.since_ns]);
        loop {
            let Err(error) = self.put(answer, &timing) else {
                self.notes.clear();
                return Ok(());
            };
            let described = format!("{error}; nothing is lost: Enter writes the same answer again");
            self.asked(&described)?;
        }
    }

    fn put(&mut self, answer: Option<&Answer>, timing: &Timing) -> Result<(), ExperimentError> {
        let note = self.notes.join("; ");
        let circumstances = Circumstances {
            timing: timing.clone(),
            apparatus: self.apparatus.clone(),
            presentation: Presentation::confirmed(self.proof),
            note: &note,
            path: None,
            samples: &[],
        };
        match answer {
            Some(answer) => self.session.answer(answer, &circumstances).map(drop),
            None => self.session.abort(&circumstances),
        }
    }

    /// A note of a trial that was not answered is kept with the trial as given up.
    fn keep_notes(&mut self) -> io::Result<()> {
        let is_trial = matches!(self.session.step(), Step::Trial(_));
        if self.notes.is_empty() || !is_trial {
            return Ok(());
        }
        let now = self.bench.now();
        let timing = Timing::between([now.utc; 2], [now.since_ns; 2]);
        let Err(error) = self.put(None, &timing) else {
            return Ok(());
        };
        let notes = self.notes.join("; ");
        self.say(&format!("{error}; your note was not kept: {notes}"))
    }
}

/// The first word of a line, and the rest.
fn split(line: &str) -> (&str, &str) {
    let line = line.trim();
    let (first, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    (first, rest.trim())
}

#[cfg(test)]
mod tests;
