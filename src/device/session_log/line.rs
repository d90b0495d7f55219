//! A line of CSV and what stands in it: see [`COLUMNS`].
//!
//! The detail of a note is `name=value` pairs with the unit in the name, or a text, in quotes; that
//! of a packet has neither commas nor quotes. The lines of packets are most of a log: they have no
//! `utc`, which follows from the other time, and of that mostly the step from the packet before.

use std::fmt::Write as _;
use std::time::{Duration, Instant, SystemTime};

use super::bodies::kind_name;
use super::events::{COLUMNS, event};
use super::note::{Entry, HostCounters, Note};
use super::packets::PacketWords;
use crate::message::{
    Caps, Config, DeviceCounters, DeviceState, LARGEST_CHANNELS, Status, StopHow, fault_bit,
};
use selvedge_foundation::numerics::to_whole;
use selvedge_foundation::quantity::rfc3339;

/// The first line of a log.
pub(super) fn header() -> String {
    format!("{}\n", COLUMNS.join(","))
}

/// The moment that a log's times count from, by both clocks of the system.
#[derive(Clone, Copy, Debug)]
pub(super) struct Epoch {
    pub(super) utc: SystemTime,
    pub(super) monotonic: Instant,
}

impl Epoch {
    pub(super) fn now() -> Self {
        Self {
            utc: SystemTime::now(),
            monotonic: Instant::now(),
        }
    }
}

/// Appends the line of an entry.
pub(super) fn write_entry(lines: &mut String, entry: &Entry, epoch: Epoch) {
    let since = entry.at.saturating_duration_since(epoch.monotonic);
    let (event, detail) = words(&entry.note);
    let detail = detail.replace('"', "\"\"");
    let optional = |number: Option<u64>| number.map_or_else(String::new, |n| n.to_string());
    let fields = [
        rfc3339(epoch.utc + since),
        format!("{:.6}", since.as_secs_f64()),
        optional(entry.tick.map(u64::from)),
        optional(entry.device_us),
        event.to_owned(),
        format!("\"{detail}\""),
    ];
    lines.push_str(&fields.join(","));
    lines.push('\n');
}

/// Tenths of a ms in a second, in which the times of packets are written.
const PER_S: i64 = 10_000;
/// From one time of a packet that is whole to the next, the same.
const WHOLE_TIME_EVERY: i64 = PER_S;
/// A log is never open for longer, s.
pub(super) const LONGEST_S: f64 = 1e9;

/// The times of a link's packets: whole once a second, differences between.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PacketTimes {
    /// Of the packet before, and of the last whole one, in tenths of a ms.
    last: Option<[i64; 2]>,
}

impl PacketTimes {
    /// How a time is written: s since the log was opened, or signed tenths of a ms since the packet
    /// before.
    fn write(&mut self, since: Duration) -> String {
        let now = i64::try_from(since.as_micros() / 100).unwrap_or(i64::MAX);
        match self.last {
            Some([last, whole]) if now - whole < WHOLE_TIME_EVERY => {
                self.last = Some([now, whole]);
                format!("{:+}", now - last)
            }
            _ => {
                self.last = Some([now, now]);
                format!("{}.{:04}", now / PER_S, now % PER_S)
            }
        }
    }

    /// A difference that was written so, as the time that it means, s.
    pub(super) fn read_step(&mut self, text: &str) -> Option<f64> {
        let [last, whole] = self.last?;
        let now = last.checked_add(text.parse().ok()?)?;
        self.last = Some([now, whole]);
        (now >= 0).then_some(now as f64 / PER_S as f64)
    }

    /// The time of a packet that was written whole, s: not longer than a log is open.
    pub(super) fn take_whole(&mut self, s: f64) {
        let now = to_whole((s * PER_S as f64).round());
        self.last = Some([now, now]);
    }
}

/// Appends the line of a packet.
pub(super) fn write_packet(
    lines: &mut String,
    at: Instant,
    words: &PacketWords,
    (epoch, times): (Epoch, &mut PacketTimes),
) {
    let time = times.write(at.saturating_duration_since(epoch.monotonic));
    let tick = words.tick.map_or_else(String::new, |tick| tick.to_string());
    let PacketWords { event, detail, .. } = words;
    let written = writeln!(lines, ",{time},{tick},,{event},{detail}");
    debug_assert!(written.is_ok(), "a String takes everything");
}

fn words(note: &Note) -> (&'static str, String) {
    match note {
        Note::Hello(nonce) => (event::HELLO, format!("session={nonce:08x}")),
        Note::Caps(caps) => (event::CAPS, caps_words(caps)),
        Note::Config(config) => (event::CONFIG, config_words(config)),
        Note::Effective(config) => (event::CFG, config_words(config)),
        Note::Arm => (event::ARM, String::new()),
        Note::Armed => (event::ARMED, String::new()),
        Note::Stop(how) => (event::STOP, format!("how={}", how_word(*how))),
        Note::StopBySwitch(how) => (event::STOP_SWITCH, format!("how={}", how_word(*how))),
        Note::Stopped => (event::STOPPED, String::new()),
        Note::Clear => (event::CLEAR, String::new()),
        Note::Cleared => (event::CLEARED, String::new()),
        Note::Refused(kind, code) => {
            let what = format!("message={} code={}", kind_name(*kind), code.code());
            (event::REFUSED, format!("{what} ({})", code.describe()))
        }
        Note::Fault(fault) => {
            let channel = match fault.channel {
                u16::MAX => "none".to_owned(),
                channel => channel.to_string(),
            };
            let (names, value) = (fault_bit::names(fault.faults), fault.value);
            let bits = fault.faults;
            let what = format!("bits={bits:#06x} channel={channel} value={value} ({names})");
            (event::FAULT, what)
        }
        Note::State(code) => (event::STATE, format!("state={}", state_name(*code))),
        Note::Telemetry(status, predicted) => {
            (event::TELEMETRY, telemetry_words(status, *predicted))
        }
        Note::DeviceCounters(counters) => (event::DEVICE_COUNTERS, device_words(counters)),
        Note::HostCounters(counters) => (event::HOST_COUNTERS, host_words(counters)),
        Note::Depth(depth, lead) => {
            let lead_ms = lead.as_secs_f64() * 1e3;
            (event::DEPTH, format!("ticks={depth} lead_ms={lead_ms:.2}"))
        }
        Note::Said(event, text) => (event, one_line(text)),
        Note::Missing(n) => (event::ENTRIES_LOST, format!("n={n}")),
    }
}

fn state_name(code: u8) -> &'static str {
    DeviceState::from_code(code).map_or("unknown", DeviceState::name)
}

fn one_line(text: &str) -> String {
    text.replace(|letter: char| letter.is_control(), " ")
}

fn how_word(how: StopHow) -> &'static str {
    match how {
        StopHow::Ramp => "ramp",
        StopHow::Now => "now",
    }
}

fn caps_words(caps: &Caps) -> String {
    let [major, minor, patch] = caps.firmware;
    let uid = caps.uid.map(|byte| format!("{byte:02x}")).concat();
    format!(
        "name=\"{}\" firmware={major}.{minor}.{patch} uid={uid} session={:08x} version={} \
         components={} channels={} rows={} cols={} pitch_um={} tick_us={} queue={} dac_bits={} \
         modes={:#06x} fs_mv={} hv_max_dv={} slew_max={} max_body={} sample_hz={} freq_mhz={}/{} \
         comp_limit={}/{}",
        caps.shown_name(),
        caps.session,
        caps.version,
        caps.n_comp,
        caps.n_ch,
        caps.rows,
        caps.cols,
        caps.pitch_um,
        caps.tick_us,
        caps.queue,
        caps.dac_bits,
        caps.modes,
        caps.fs_mv,
        caps.hv_max_dv,
        caps.slew_max,
        caps.max_body,
        caps.sample_hz,
        caps.freq_mhz[0],
        caps.freq_mhz[1],
        caps.comp_limit[0],
        caps.comp_limit[1],
    )
}

fn config_words(config: &Config) -> String {
    format!(
        "mode={} flags={} hold_ms={} ramp_ms={} slew={} hv_dv={} comp_limit={}/{} mask={}",
        config.mode,
        config.flags,
        config.hold_ms,
        config.ramp_ms,
        config.slew,
        config.hv_dv,
        config.comp_limit[0],
        config.comp_limit[1],
        mask_words(config),
    )
}

/// The mask: its words from channel 0 on, 32 channels each, in hexadecimal digits. Which of them
/// exist is told by CAPS.
fn mask_words(config: &Config) -> String {
    let word = |first: usize| {
        let bits = (first..first + 32).map(|channel| config.mask.contains(channel));
        bits.rev()
            .fold(0_u32, |word, is_on| word << 1 | u32::from(is_on))
    };
    let mut words: Vec<u32> = (0..LARGEST_CHANNELS).step_by(32).map(word).collect();
    while words.len() > 1 && words.last() == Some(&0) {
        words.pop();
    }
    let digits: Vec<String> = words.iter().map(|word| format!("{word:08x}")).collect();
    digits.join("/")
}

fn telemetry_words(status: &Status, predicted: f64) -> String {
    format!(
        "hv_v={:.1} i_ma={} temp_c={:.2} amp_sum={} predicted_sum={predicted:.0} state={} \
         queued={} age_ms={} faults={:#06x}",
        f64::from(status.hv_dv) / 10.0,
        status.i_ma,
        f64::from(status.temp_cdeg) / 100.0,
        status.amp_sum,
        state_name(status.state),
        status.queued,
        status.age_ms,
        status.faults,
    )
}

fn device_words(counters: &DeviceCounters) -> String {
    format!(
        "underrun={} late={} dup={} bad={} clipped={}",
        counters.underrun, counters.late, counters.dup, counters.bad, counters.clipped
    )
}

fn host_words(counters: &HostCounters) -> String {
    format!(
        "rejected={} superseded={} bad_received={} events_dropped={} write_timeouts={}",
        counters.rejected,
        counters.superseded,
        counters.bad_received,
        counters.events_dropped,
        counters.write_timeouts
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::message::{AckCode, kind};
    use std::time::UNIX_EPOCH;

    fn line_of(note: Note) -> String {
        let epoch = Epoch {
            utc: UNIX_EPOCH,
            monotonic: Instant::now(),
        };
        let entry = Entry {
            at: epoch.monotonic + Duration::from_millis(1500),
            tick: Some(60),
            device_us: Some(1_499_000),
            note,
        };
        let mut line = String::new();
        write_entry(&mut line, &entry, epoch);
        line
    }

    #[test]
    fn a_line_has_both_times_of_the_host_and_both_of_the_device() {
        assert_eq!(
            line_of(Note::Stop(StopHow::Now)),
            "1970-01-01T00:00:01.500000Z,1.500000,60,1499000,stop,\"how=now\"\n"
        );
        assert!(
            line_of(Note::Refused(kind::FRAME, AckCode::QueueFull))
                .ends_with(",refused,\"message=FRAME code=3 (queue full)\"\n")
        );
    }

    #[test]
    fn words_of_others_stay_in_their_field_and_on_their_line() {
        let line = line_of(Note::Said("device-log", "a \"b\",\r\nc".to_owned()));
        assert!(
            line.ends_with(",device-log,\"a \"\"b\"\",  c\"\n"),
            "{line}"
        );
        assert_eq!(line.lines().count(), 1);
        assert_eq!(header().split(',').count(), 6);
    }
}
