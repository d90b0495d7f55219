//! The core in C behind its line protocol, and our own device obeying the same lines.

use std::fmt::Write as _;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use selvedge_device::{DeviceCore, DeviceModel};

/// Something that answers each line with one line, as `hbp_host` does.
pub(crate) trait Obedient {
    /// The answer to `line`.
    fn obey(&mut self, line: &str) -> String;
}

/// The core in C, a process.
pub(crate) struct CCore {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
}

impl CCore {
    /// Starts `program`.
    pub(crate) fn start(program: &Path) -> Self {
        let mut command = Command::new(program);
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let input = child.stdin.take().unwrap();
        let output = BufReader::new(child.stdout.take().unwrap());
        Self {
            child,
            input,
            output,
        }
    }
}

impl Obedient for CCore {
    fn obey(&mut self, line: &str) -> String {
        writeln!(self.input, "{line}").unwrap();
        let mut answer = String::new();
        self.output.read_line(&mut answer).unwrap();
        answer.trim_end().to_owned()
    }
}

impl Drop for CCore {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }
}

/// Our own device.
pub(crate) struct OurCore {
    model: DeviceModel,
    core: DeviceCore,
    now_us: u64,
    sent: Vec<u8>,
}

impl OurCore {
    /// A device that has just booted.
    pub(crate) fn new(model: DeviceModel) -> Self {
        Self {
            core: DeviceCore::new(model.clone()),
            model,
            now_us: 0,
            sent: Vec::new(),
        }
    }

    /// Output codes per channel.
    pub(crate) fn output(&self) -> Vec<[u16; 2]> {
        self.core.output()
    }

    fn fault(&mut self, numbers: &[i64]) {
        let [bits, channel, value] = numbers else {
            panic!("fault BITS CHANNEL VALUE: {numbers:?}")
        };
        let (bits, channel) = (u16::try_from(*bits), u16::try_from(*channel));
        let value = i32::try_from(*value).unwrap();
        let (bits, channel) = (bits.unwrap(), channel.unwrap());
        self.core.raise_fault(bits, channel, value, &mut self.sent);
    }

    fn answer(&mut self) -> String {
        let moment = self.core.moment();
        let mut answer = format!("{} {} ", moment.state, moment.amp_sum);
        if self.sent.is_empty() {
            answer.push('-');
        }
        for byte in self.sent.drain(..) {
            write!(answer, "{byte:02x}").unwrap();
        }
        answer
    }

    fn codes(&self) -> String {
        let codes: Vec<String> = self.output().iter().flatten().map(u16::to_string).collect();
        codes.join(" ")
    }
}

impl Obedient for OurCore {
    fn obey(&mut self, line: &str) -> String {
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        let numbers = || -> Vec<i64> {
            let parse = |number: &str| number.parse().unwrap();
            rest.split_whitespace().map(parse).collect()
        };
        match word {
            "boot" => *self = Self::new(self.model.clone()),
            "at" => {
                self.now_us = rest.trim().parse().unwrap();
                self.core.advance(self.now_us, &mut self.sent);
            }
            "in" => self.core.receive(self.now_us, &bytes(rest), &mut self.sent),
            "fault" => self.fault(&numbers()),
            "cured" => {
                let bits = u16::try_from(numbers()[0]).unwrap();
                self.core.end_fault_cause(bits);
            }
            "lost" => self.core.hang_up(&mut self.sent),
            "codes" => return self.codes(),
            _ => panic!("no such line: {line}"),
        }
        self.answer()
    }
}

/// Bytes of hex digits, with blanks or without; `-` is none.
pub(crate) fn bytes(hex: &str) -> Vec<u8> {
    let digits: Vec<char> = hex.chars().filter(char::is_ascii_hexdigit).collect();
    let pairs = digits.chunks(2).map(|pair| pair.iter().collect::<String>());
    pairs
        .map(|pair| u8::from_str_radix(&pair, 16).unwrap())
        .collect()
}

/// `bytes` as hex digits with blanks.
pub(crate) fn hex(bytes: &[u8]) -> String {
    let pairs: Vec<String> = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    pairs.join(" ")
}
