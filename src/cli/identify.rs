//! `selvedge bridge identify`: which channel drives which contactor, asked on a terminal or
//! answered from a file; the profile with what was found is written.
//!
//! One channel at a time is driven for a moment; no frame is sent.

use std::collections::VecDeque;
use std::io::{self, BufRead as _, IsTerminal as _, Write as _};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::thread;

use clap::Args;

use super::output::OutFile;
use super::record::{self, RecordArgs};
use super::{CliError, array, output, play, signals, terminal};
use selvedge_device::wiring::{Answer, WiringWalk};
use selvedge_device::{
    ArrayProfile, Bridge, BridgeEvent, DeviceUid, Driver, FrameSource, SessionLog, Target,
};
use selvedge_foundation::files::{self, FileError};

/// How long one channel is driven, ms.
const PULSE_MS: u16 = 600;
/// More answers than any array asks for.
const MAX_ANSWERS: usize = 10_000;
/// Part of the limit at 320 Hz that it is driven with.
const SHARE: f64 = 0.5;

/// What to identify.
#[derive(Debug, Args)]
pub(super) struct IdentifyArgs {
    /// Serial port of the device
    #[arg(long, value_name = "PORT")]
    port: PathBuf,
    #[arg(long, value_name = "ARRAY", default_value = "exeter-24", help = array::HELP,
          value_parser = array::profile)]
    array: Box<ArrayProfile>,
    #[command(flatten)]
    baud: array::BaudArgs,
    /// The profile with the wiring that was found
    #[arg(long, value_name = "PROFILE.toml")]
    out: OutFile,
    /// Answers, one a line, instead of asking on the terminal
    #[arg(long, value_name = "FILE")]
    answers: Option<PathBuf>,
    #[command(flatten)]
    record: RecordArgs,
}

/// Walks the channels, and writes the profile.
pub(super) fn run(args: &IdentifyArgs) -> Result<(), CliError> {
    play::check_port(&args.port)?;
    let answers = Answers::open(args.answers.as_deref())?;
    let stop = signals::stop_flag()?;
    let mut array = (*args.array).clone();
    args.baud.set(&mut array);
    let n = array.n_contactors();
    let log = args.record.open()?;
    let mut driver = Driver::open(Target::Port(args.port.clone()), array.clone(), n);
    if let Some(log) = &log {
        let mut feed = driver.bridge().feed_of(log);
        record::say_what(&mut feed, &array, &[]);
        driver.bridge_mut().log_to(feed);
    }
    let mut bench = Bench::of(args, answers, driver.bridge().target());
    let ended = driver.run(&mut bench, &stop);
    let uid = driver
        .bridge()
        .session()
        .caps()
        .map(|caps| DeviceUid(caps.uid));
    driver.close();
    log.map_or(Ok(()), SessionLog::finish)?;
    ended?;
    // A signal, or a terminal that closed: nobody is there to answer.
    let Some((found, uid)) = bench.walk.found().zip(uid) else {
        terminal::notice("stopped; nothing was written");
        return Ok(());
    };
    let profile = found.in_profile(&args.array, uid);
    profile.write(&args.out)?;
    let mut lines = found.lines();
    let place = args.out.display();
    lines.push(format!("wiring of device {uid} written to {place}\n"));
    output::print(&lines.join("\n"))
}

/// Where answers come from.
enum Answers {
    File {
        path: PathBuf,
        lines: VecDeque<(usize, String)>,
    },
    Terminal(Receiver<String>),
}

impl Answers {
    fn open(path: Option<&Path>) -> Result<Self, CliError> {
        if let Some(path) = path {
            let text = files::read_text(path)?;
            let lines = text.lines().enumerate();
            let lines = lines.map(|(index, line)| (index + 1, line.trim().to_owned()));
            let is_answer =
                |(_, line): &(usize, String)| !line.is_empty() && !line.starts_with('#');
            let answers = lines.filter(is_answer).take(MAX_ANSWERS + 1);
            let lines: VecDeque<_> = answers.collect();
            if lines.is_empty() || lines.len() > MAX_ANSWERS {
                let what = "this file holds no answer, or too many";
                let mend = "write an answer for every channel, one a line";
                return Err(FileError::whole(path, what, mend).into());
            }
            let path = path.to_owned();
            return Ok(Self::File { path, lines });
        }
        if !io::stdin().is_terminal() {
            let what = "answers are typed on a terminal, and standard input is none; \
                        give --answers FILE";
            return Err(CliError::Input(what.to_owned()));
        }
        let (sender, typed) = sync_channel(1);
        let listen = move || {
            let lines = io::stdin().lock().lines().map_while(Result::ok);
            lines
                .take_while(|line| sender.send(line.clone()).is_ok())
                .for_each(drop);
        };
        let listener = thread::Builder::new().name("answers".to_owned());
        listener
            .spawn(listen)
            .map_err(|error| CliError::Failed(format!("cannot listen to the terminal: {error}")))?;
        Ok(Self::Terminal(typed))
    }
}

/// What was said.
enum Said {
    Answer(Answer),
    Again,
    Back,
}

/// What a line of text says of an array of `n` contactors in rows of `n_columns`.
fn said(line: &str, n: usize, n_columns: usize) -> Option<Said> {
    let number = |text: &str| text.trim().parse::<usize>().ok();
    let contactor = match line.split_once(',') {
        Some((row, column)) => {
            let column = number(column).filter(|column| *column < n_columns)?;
            number(row)?.checked_mul(n_columns)?.checked_add(column)
        }
        None => number(line),
    };
    match (contactor, line.trim()) {
        (Some(contactor), _) => {
            (contactor < n).then_some(Said::Answer(Answer::Contactor(contactor)))
        }
        (None, "n" | "none") => Some(Said::Answer(Answer::Nothing)),
        (None, "a" | "again") => Some(Said::Again),
        (None, "b" | "back") => Some(Said::Back),
        (None, _) => None,
    }
}

/// What is waited for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wait {
    /// The next tick, to drive a channel.
    Tick,
    /// The device, to drive it.
    Device,
    /// A person.
    Answer,
}

/// A walk over the channels of a device, and somebody who answers.
struct Bench {
    target: String,
    n_columns: usize,
    amplitude_um: f32,
    walk: WiringWalk,
    /// Contradictions that were told.
    n_told: usize,
    answers: Answers,
    wait: Wait,
}

impl FrameSource for Bench {
    type Error = CliError;

    fn event(&mut self, event: &BridgeEvent) -> Result<(), CliError> {
        match event {
            BridgeEvent::Armed if matches!(self.answers, Answers::Terminal(_)) => {
                terminal::notice(&format!(
                    "one channel at a time is driven: type the contactor that moved (0 to {}, or \
                     row,column from 0), n for none, a for again, b for back",
                    self.walk.n_channels() - 1
                ));
            }
            BridgeEvent::Identified { channel } => {
                self.wait = Wait::Answer;
                self.ask(usize::from(*channel));
            }
            BridgeEvent::NotIdentified { channel, reason } => {
                return Err(self.failed(&format!("channel {channel}: {reason}")));
            }
            _ => {}
        }
        Ok(())
    }

    /// Drives the channel that is asked for, or takes what was said of it.
    fn tick(&mut self, bridge: &mut Bridge) -> Result<ControlFlow<()>, CliError> {
        let Some(channel) = self.walk.channel() else {
            return Ok(ControlFlow::Break(()));
        };
        match self.wait {
            Wait::Tick => {
                let channel = u16::try_from(channel).unwrap_or(u16::MAX);
                let asked = bridge.identify(channel, (self.amplitude_um, PULSE_MS));
                asked.map_err(|why| self.failed(why))?;
                self.wait = Wait::Device;
            }
            Wait::Device => {}
            Wait::Answer => return self.take_answer(channel),
        }
        Ok(ControlFlow::Continue(()))
    }
}

impl Bench {
    fn of(args: &IdentifyArgs, answers: Answers, target: &str) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "amplitudes travel as f32")]
        let amplitude_um = (SHARE * args.array.limit_um[1]) as f32;
        Self {
            target: target.to_owned(),
            n_columns: usize::from(args.array.cols),
            amplitude_um,
            walk: WiringWalk::new(args.array.n_contactors()),
            n_told: 0,
            answers,
            wait: Wait::Tick,
        }
    }

    fn ask(&self, channel: usize) {
        if matches!(self.answers, Answers::Terminal(_)) {
            drop(write!(io::stderr(), "channel {channel}: which contactor? "));
            drop(io::stderr().flush());
        }
    }

    /// Takes what was said of a channel, if something was. A terminal that closed ends the walk.
    fn take_answer(&mut self, channel: usize) -> Result<ControlFlow<()>, CliError> {
        let said = match &mut self.answers {
            Answers::File { path, lines } => {
                let line = lines.pop_front();
                let size = (self.walk.n_channels(), self.n_columns);
                Some(said_in_file(path, line, channel, size)?)
            }
            Answers::Terminal(typed) => match typed.try_recv() {
                Err(TryRecvError::Disconnected) => return Ok(ControlFlow::Break(())),
                Err(TryRecvError::Empty) => return Ok(ControlFlow::Continue(())),
                Ok(text) => said(&text, self.walk.n_channels(), self.n_columns),
            },
        };
        match said {
            None => {
                let most = self.walk.n_channels() - 1;
                terminal::notice(&format!("type 0 to {most}, row,column, n, a or b"));
                self.ask(channel);
                return Ok(ControlFlow::Continue(()));
            }
            Some(Said::Again) => {}
            Some(Said::Back) => self.walk.back(),
            Some(Said::Answer(answer)) => {
                self.walk.answer(answer);
            }
        }
        self.describe_conflicts();
        self.wait = Wait::Tick;
        Ok(ControlFlow::Continue(()))
    }

    fn describe_conflicts(&mut self) {
        for conflict in self.walk.conflicts().iter().skip(self.n_told) {
            terminal::notice(&format!(
                "channels {:?} were all said to drive contactor {}: asked again; answer n for \
                 the weaker one if both do",
                conflict.channels, conflict.contactor
            ));
        }
        self.n_told = self.walk.conflicts().len();
    }

    fn failed(&self, what: &str) -> CliError {
        CliError::Failed(format!("{}: {what}", self.target))
    }
}

/// What a line of a file says of a channel.
fn said_in_file(
    path: &Path,
    line: Option<(usize, String)>,
    channel: usize,
    (n, n_columns): (usize, usize),
) -> Result<Said, CliError> {
    let path = path.display();
    let Some((line, text)) = line else {
        let what = format!(
            "{path}: there is no answer for channel {channel}; add a line for each question"
        );
        return Err(CliError::Input(what));
    };
    let most = n - 1;
    let what =
        format!("{path}:{line}: {text:?} is no answer; write 0 to {most}, row,column, n, a or b");
    said(&text, n, n_columns).ok_or(CliError::Input(what))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_are_numbers_places_or_words() {
        let contactor = |line| match said(line, 24, 4) {
            Some(Said::Answer(Answer::Contactor(contactor))) => Some(contactor),
            _ => None,
        };
        assert_eq!(contactor("7"), Some(7));
        assert_eq!(contactor(" 5, 3 "), Some(23));
        assert_eq!(contactor("24"), None);
        assert_eq!(contactor("0,4"), None);
        assert_eq!(contactor("18446744073709551615,3"), None);
        assert!(matches!(
            said("none", 24, 4),
            Some(Said::Answer(Answer::Nothing))
        ));
        assert!(matches!(said("a", 24, 4), Some(Said::Again)));
        assert!(matches!(said("back", 24, 4), Some(Said::Back)));
        assert!(said("what?", 24, 4).is_none());
        assert!(said("", 24, 4).is_none());
    }
}
