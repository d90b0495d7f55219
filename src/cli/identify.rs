//! `selvedge bridge identify`: which channel drives which contactor, asked on a terminal or
//! answered from a file; the profile with what was found is written.
//!
//! One channel at a time is driven for a moment; the device is stopped at the end, whatever
//! happens.

use std::collections::VecDeque;
use std::io::{self, BufRead as _, IsTerminal as _, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use clap::Args;

use super::{CliError, array, output, play, signals, terminal};
use selvedge_device::wiring::{Answer, WiringFound, WiringWalk};
use selvedge_device::{ArrayProfile, Bridge, BridgeEvent, BridgeState, DeviceUid, StopHow, Target};
use selvedge_foundation::files;

/// How long one channel is driven, ms.
const PULSE_MS: u16 = 600;
/// Part of the limit at 320 Hz that it is driven with.
const SHARE: f64 = 0.5;
const NAP: Duration = Duration::from_millis(5);
/// The session itself gives up earlier.
const PATIENCE: Duration = Duration::from_secs(10);

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
    out: PathBuf,
    /// Answers, one a line, instead of asking on the terminal
    #[arg(long, value_name = "FILE")]
    answers: Option<PathBuf>,
}

/// Walks the channels, and writes the profile.
pub(super) fn run(args: &IdentifyArgs) -> Result<(), CliError> {
    play::check_port(&args.port)?;
    let answers = Answers::open(args.answers.as_deref())?;
    let stop = signals::stop_flag()?;
    let mut array = (*args.array).clone();
    args.baud.set(&mut array);
    let mut bench = Bench::open(&args.port, array.clone(), answers, &stop);
    let found = bench.walk();
    // Whatever happened, the device is told to stop and its answer is waited for.
    let uid = bench.uid();
    let closed = bench.bridge.close(PATIENCE);
    let found = found?;
    closed?;
    let uid = uid.ok_or_else(|| CliError::Failed("the device has no number".to_owned()))?;
    let profile = found.in_profile(&array, uid);
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
            return Ok(Self::File {
                path: path.to_owned(),
                lines: lines.filter(is_answer).collect(),
            });
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

/// A device, a walk over its channels, and somebody who answers.
struct Bench<'a> {
    bridge: Bridge,
    profile: ArrayProfile,
    walk: WiringWalk,
    answers: Answers,
    stop: &'a AtomicBool,
}

impl<'a> Bench<'a> {
    fn open(port: &Path, profile: ArrayProfile, answers: Answers, stop: &'a AtomicBool) -> Self {
        let n = profile.n_contactors();
        let target = Target::Port(port.to_owned());
        Self {
            bridge: Bridge::open(target, profile.clone(), n, || {}),
            walk: WiringWalk::new(n),
            profile,
            answers,
            stop,
        }
    }

    fn uid(&self) -> Option<DeviceUid> {
        self.bridge.caps().map(|caps| DeviceUid(caps.uid))
    }

    fn walk(&mut self) -> Result<WiringFound, CliError> {
        self.until("become ready", |event| {
            matches!(event, BridgeEvent::Ready(_))
        })?;
        if self.bridge.state() != BridgeState::Ready || !self.bridge.arm() {
            return Err(self.failed("the device cannot be armed"));
        }
        self.until("arm", |event| *event == BridgeEvent::Armed)?;
        let n = self.profile.n_contactors();
        if matches!(self.answers, Answers::Terminal(_)) {
            terminal::notice(&format!(
                "one channel at a time is driven: type the contactor that moved (0 to {}, or \
                 row,column from 0), n for none, a for again, b for back",
                n - 1
            ));
        }
        let mut n_told = 0;
        while let Some(channel) = self.walk.channel() {
            self.drive(channel)?;
            let answer = self.answer(channel)?;
            match answer {
                Said::Again => {}
                Said::Back => self.walk.back(),
                Said::Answer(answer) => {
                    self.walk.answer(answer);
                }
            }
            for conflict in self.walk.conflicts().iter().skip(n_told) {
                terminal::notice(&format!(
                    "channels {:?} were all said to drive contactor {}: asked again; answer n for \
                     the weaker one if both do",
                    conflict.channels, conflict.contactor
                ));
            }
            n_told = self.walk.conflicts().len();
        }
        let found = self.walk.found();
        found.ok_or_else(|| CliError::Failed("the walk did not come to its end".to_owned()))
    }

    /// Drives one channel and waits until the device says that it does.
    fn drive(&mut self, channel: usize) -> Result<(), CliError> {
        #[expect(clippy::cast_possible_truncation, reason = "amplitudes travel as f32")]
        let amplitude_um = (SHARE * self.profile.limit_um[1]) as f32;
        let channel = u16::try_from(channel).unwrap_or(u16::MAX);
        let asked = self.bridge.identify(channel, (amplitude_um, PULSE_MS));
        asked.map_err(|why| self.failed(why))?;
        let mut refused = None;
        self.until("drive a channel", |event| match event {
            BridgeEvent::NotIdentified { reason, .. } => {
                refused = Some(reason.clone());
                true
            }
            event => *event == BridgeEvent::Identified { channel },
        })?;
        refused.map_or(Ok(()), |reason| {
            Err(self.failed(&format!("channel {channel}: {reason}")))
        })
    }

    fn answer(&mut self, channel: usize) -> Result<Said, CliError> {
        let (n, n_columns) = (self.walk.n_channels(), usize::from(self.profile.cols));
        if let Answers::File { path, lines } = &mut self.answers {
            let Some((line, text)) = lines.pop_front() else {
                let what = format!(
                    "{}: there is no answer for channel {channel}; add a line for each question",
                    path.display()
                );
                return Err(CliError::Input(what));
            };
            let what = format!(
                "{}:{line}: {text:?} is no answer; write 0 to {}, row,column, n, a or b",
                path.display(),
                n - 1
            );
            return said(&text, n, n_columns).ok_or(CliError::Input(what));
        }
        loop {
            drop(write!(io::stderr(), "channel {channel}: which contactor? "));
            drop(io::stderr().flush());
            let text = self.typed()?;
            if let Some(said) = said(&text, n, n_columns) {
                return Ok(said);
            }
            let most = n - 1;
            terminal::notice(&format!("type 0 to {most}, row,column, n, a or b"));
        }
    }

    /// The next line from the terminal; the session lives meanwhile.
    fn typed(&mut self) -> Result<String, CliError> {
        loop {
            self.hear(&mut |_| false)?;
            let Answers::Terminal(typed) = &self.answers else {
                return Err(self.failed("nobody answers"));
            };
            match typed.try_recv() {
                Ok(line) => return Ok(line),
                Err(TryRecvError::Disconnected) => return Err(self.failed("the terminal closed")),
                Err(TryRecvError::Empty) => {}
            }
            if let Ok(line) = typed.recv_timeout(NAP) {
                return Ok(line);
            }
        }
    }

    /// Takes all news; whether one of them is `wanted`.
    fn hear(&mut self, wanted: &mut dyn FnMut(&BridgeEvent) -> bool) -> Result<bool, CliError> {
        if self.stop.load(Ordering::Relaxed) {
            self.bridge.stop(StopHow::Now);
            return Err(self.failed("stopped; nothing was written"));
        }
        let mut is_there = false;
        while let Some(event) = self.bridge.poll() {
            match &event {
                BridgeEvent::Refused(reason)
                | BridgeEvent::Lost(reason)
                | BridgeEvent::Disarmed { reason, .. } => {
                    let reason = reason.clone();
                    return Err(self.failed(&reason));
                }
                event => is_there |= wanted(event),
            }
        }
        Ok(is_there)
    }

    fn until(
        &mut self,
        what: &str,
        mut wanted: impl FnMut(&BridgeEvent) -> bool,
    ) -> Result<(), CliError> {
        let deadline = Instant::now() + PATIENCE;
        while Instant::now() < deadline {
            if self.hear(&mut wanted)? {
                return Ok(());
            }
            thread::sleep(NAP);
        }
        Err(self.failed(&format!("the device did not {what}")))
    }

    fn failed(&self, what: &str) -> CliError {
        CliError::Failed(format!("{}: {what}", self.bridge.target()))
    }
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
