//! What an emulated device did, as CSV: every applied frame and every change of state, by the
//! device's own clock.
//!
//! `dev_us,tick,event,state,seq,age_ms,gain,amp_sum,a40_0,a320_0,…`. A `frame` row carries the
//! codes as received; a `state` row has no seq and no codes, nor has a row of an injected fault,
//! whose event begins with `fault`. `gain` is the hold and ramp gain, `amp_sum` the sum of the
//! output codes from then on.

use std::fs::File;
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};

use crate::BridgeError;
use crate::device::{AppliedFrame, Moment};
use crate::wire::Injection;

/// A log being written. The first error is kept and given by [`finish`](Self::finish).
#[derive(Debug)]
pub(crate) struct DeviceLog {
    out: BufWriter<File>,
    path: PathBuf,
    n_channels: usize,
    line: String,
    failed: Option<io::Error>,
}

impl DeviceLog {
    /// Creates the file and writes the header for `n_channels` channels.
    pub(crate) fn create(path: &Path, n_channels: usize) -> Result<Self, BridgeError> {
        let file = File::create(path).map_err(BridgeError::file("create the log", path))?;
        let mut log = Self {
            out: BufWriter::new(file),
            path: path.to_path_buf(),
            n_channels,
            line: String::from("dev_us,tick,event,state,seq,age_ms,gain,amp_sum"),
            failed: None,
        };
        for channel in 0..n_channels {
            log.text(format_args!(",a40_{channel},a320_{channel}"));
        }
        log.end_line();
        Ok(log)
    }

    /// A FRAME took effect.
    pub(crate) fn frame(&mut self, frame: &AppliedFrame<'_>) {
        self.moment("frame", &frame.moment, Some(frame.seq));
        for [code_40, code_320] in frame.codes {
            self.text(format_args!(",{code_40},{code_320}"));
        }
        self.end_line();
    }

    /// The state changed. Changes are rare and matter: they reach the disk at once.
    pub(crate) fn change(&mut self, moment: &Moment) {
        self.moment("state", moment, None);
        self.end_row_without_codes();
        let flushed = self.out.flush();
        self.keep(flushed);
    }

    /// A fault was injected: `event` says which and how much of it.
    pub(crate) fn injected(&mut self, moment: &Moment, injection: &Injection) {
        self.moment(&injection.to_string(), moment, None);
        self.end_row_without_codes();
        if injection.is_rare() {
            let flushed = self.out.flush();
            self.keep(flushed);
        }
    }

    /// Writes what is left.
    pub(crate) fn finish(mut self) -> Result<(), BridgeError> {
        let flushed = self.out.flush();
        self.keep(flushed);
        match self.failed {
            Some(error) => Err(BridgeError::file("write the log", &self.path)(error)),
            None => Ok(()),
        }
    }

    fn moment(&mut self, event: &str, moment: &Moment, seq: Option<u16>) {
        let Moment {
            dev_us,
            tick,
            state,
            age_ms,
            gain,
            amp_sum,
            ..
        } = moment;
        let seq = seq.map(|seq| seq.to_string()).unwrap_or_default();
        self.text(format_args!(
            "{dev_us},{tick},{event},{state},{seq},{age_ms},{gain},{amp_sum}"
        ));
    }

    fn text(&mut self, text: std::fmt::Arguments<'_>) {
        self.line.push_str(&std::fmt::format(text));
    }

    fn end_row_without_codes(&mut self) {
        for _ in 0..self.n_channels {
            self.text(format_args!(",,"));
        }
        self.end_line();
    }

    fn end_line(&mut self) {
        self.line.push('\n');
        let written = self.out.write_all(self.line.as_bytes());
        self.line.clear();
        self.keep(written);
    }

    fn keep(&mut self, result: io::Result<()>) {
        if let Err(error) = result {
            self.failed.get_or_insert(error);
        }
    }
}
