//! An entry as a line of CSV: `utc,monotonic_s,device_tick,device_us,event,detail`.
//!
//! The detail is `name=value` pairs with the unit in the name, or a text in quotes.

use std::time::{Instant, SystemTime};

use super::note::{Entry, HostCounters, Note};
use crate::message::{Caps, Config, DeviceCounters, DeviceState, StopHow, fault_bit, kind};
use selvedge_foundation::quantity::rfc3339;

/// The first line of a log.
pub(super) const HEADER: &str = "utc,monotonic_s,device_tick,device_us,event,detail\n";

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
pub(super) fn write(line: &mut String, entry: &Entry, epoch: Epoch) {
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
    line.push_str(&fields.join(","));
    line.push('\n');
}

fn words(note: &Note) -> (&'static str, String) {
    match note {
        Note::Hello(nonce) => ("hello", format!("session={nonce:08x}")),
        Note::Caps(caps) => ("caps", caps_words(caps)),
        Note::Config(config) => ("config", config_words(config)),
        Note::Effective(config) => ("cfg", config_words(config)),
        Note::Arm => ("arm", String::new()),
        Note::Armed => ("armed", String::new()),
        Note::Stop(how) => ("stop", format!("how={}", how_word(*how))),
        Note::StopBySwitch(how) => ("stop-switch", format!("how={}", how_word(*how))),
        Note::Stopped => ("stopped", String::new()),
        Note::Clear => ("clear", String::new()),
        Note::Cleared => ("cleared", String::new()),
        Note::Refused(kind, code) => {
            let what = format!("message={} code={}", kind_name(*kind), code.code());
            ("refused", format!("{what} ({})", code.describe()))
        }
        Note::Fault(fault) => {
            let channel = match fault.channel {
                u16::MAX => "none".to_owned(),
                channel => channel.to_string(),
            };
            let (names, value) = (fault_bit::names(fault.faults), fault.value);
            let bits = fault.faults;
            let what = format!("bits={bits:#06x} channel={channel} value={value} ({names})");
            ("fault", what)
        }
        Note::State(code) => {
            let name = DeviceState::from_code(*code).map_or("unknown", DeviceState::name);
            ("state", format!("state={name}"))
        }
        Note::DeviceCounters(counters) => ("device-counters", device_words(counters)),
        Note::HostCounters(counters) => ("host-counters", host_words(counters)),
        Note::Depth(depth, lead) => {
            let lead_ms = lead.as_secs_f64() * 1e3;
            ("depth", format!("ticks={depth} lead_ms={lead_ms:.2}"))
        }
        Note::Said(event, text) => (event, one_line(text)),
        Note::Missing(n) => ("entries-lost", format!("n={n}")),
    }
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
        "name={:?} firmware={major}.{minor}.{patch} uid={uid} version={} channels={} rows={} \
         cols={} queue={} modes={:#06x} fs_mv={} hv_max_dv={} slew_max={} max_body={} \
         sample_hz={} comp_limit={}/{}",
        caps.shown_name(),
        caps.version,
        caps.n_ch,
        caps.rows,
        caps.cols,
        caps.queue,
        caps.modes,
        caps.fs_mv,
        caps.hv_max_dv,
        caps.slew_max,
        caps.max_body,
        caps.sample_hz,
        caps.comp_limit[0],
        caps.comp_limit[1],
    )
}

fn config_words(config: &Config) -> String {
    let n_on = (0..crate::message::LARGEST_CHANNELS)
        .filter(|&channel| config.mask.contains(channel))
        .count();
    format!(
        "mode={} flags={} hold_ms={} ramp_ms={} slew={} hv_dv={} comp_limit={}/{} \
         channels_on={n_on}",
        config.mode,
        config.flags,
        config.hold_ms,
        config.ramp_ms,
        config.slew,
        config.hv_dv,
        config.comp_limit[0],
        config.comp_limit[1],
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

fn kind_name(kind: u8) -> &'static str {
    match kind {
        kind::HELLO => "HELLO",
        kind::CONFIG => "CONFIG",
        kind::ARM => "ARM",
        kind::FRAME => "FRAME",
        kind::STOP => "STOP",
        kind::PING => "PING",
        kind::CLEAR => "CLEAR",
        kind::SAMPLES => "SAMPLES",
        kind::IDENT => "IDENT",
        _ => "unknown",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::message::AckCode;
    use std::time::{Duration, UNIX_EPOCH};

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
        write(&mut line, &entry, epoch);
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
        assert_eq!(HEADER.split(',').count(), 6);
    }
}
