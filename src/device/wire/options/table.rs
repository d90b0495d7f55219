//! The table of everything that can be asked to go wrong, and how each text is read.

use super::{FaultGroup, FaultKind, FaultOption, ON};
use crate::array::ArrayProfile;
use crate::device::{FirmwareLie, Miswiring};
use crate::wire::faults::{Direction, Faults, Latency, LinkFaults, OneOff, OneOffKind};
use crate::wire::parse;

/// How much longer a write takes when nothing else is said, µs.
const HICCUP_US: u64 = 50_000;
/// The option whose values are a table of their own.
pub(super) const FIRMWARE_LIE: &str = "firmware-lie";

/// What was said, before it is dealt out to the directions of the link.
#[derive(Debug)]
pub(super) struct Spoken {
    /// What holds for the device.
    faults: Faults,
    /// What bytes suffer, whichever way.
    link: LinkFaults,
    latency: [Latency; 2],
    /// One direction only, or both.
    way: Option<Direction>,
    chatter: bool,
    banner: bool,
}

impl Default for Spoken {
    fn default() -> Self {
        Self {
            faults: Faults {
                seed: 1,
                ..Faults::default()
            },
            link: LinkFaults::default(),
            latency: [Latency::None; 2],
            way: None,
            chatter: false,
            banner: false,
        }
    }
}

impl Spoken {
    /// What was said, as it acts.
    pub(super) fn faults(self) -> Faults {
        Faults {
            to_device: self.faults_of(Direction::ToDevice),
            to_host: self.faults_of(Direction::ToHost),
            ..self.faults
        }
    }

    fn faults_of(&self, direction: Direction) -> LinkFaults {
        let (latency, chatter) = match direction {
            Direction::ToDevice => (self.latency[0], self.chatter),
            Direction::ToHost => (self.latency[1], self.banner),
        };
        if self.way.is_some_and(|only| only != direction) {
            return LinkFaults {
                chatter,
                baud: self.link.baud,
                ..LinkFaults::default()
            };
        }
        LinkFaults {
            latency,
            chatter,
            ..self.link
        }
    }

    /// Adds what happens at each of some times.
    fn once(&mut self, kind: OneOffKind, text: &str) -> Result<(), String> {
        let times: Result<Vec<OneOff>, String> =
            items(text).map(|text| parse::one_off(kind, text)).collect();
        self.faults.once.extend(times?);
        Ok(())
    }
}

/// What stands between commas and spaces.
fn items(text: &str) -> impl Iterator<Item = &str> {
    let parts = text.split(|letter: char| letter == ',' || letter.is_whitespace());
    parts.filter(|part| !part.is_empty())
}

/// A whole number from 0 to `T`'s largest.
fn whole<T: std::str::FromStr>(text: &str, what: &str) -> Result<T, String> {
    let number = text.trim().parse().ok();
    number.ok_or_else(|| format!("\"{text}\" is no {what}: write a whole number"))
}

fn switch(text: &str) -> Result<bool, String> {
    if text == ON {
        Ok(true)
    } else {
        Err(format!("\"{text}\": write {ON} or nothing"))
    }
}

fn way(text: &str) -> Result<Option<Direction>, String> {
    match text {
        "both" => Ok(None),
        "to-device" => Ok(Some(Direction::ToDevice)),
        "to-host" => Ok(Some(Direction::ToHost)),
        _ => Err("the ways are to-device, to-host and both".to_owned()),
    }
}

fn hiccup(link: &mut LinkFaults, text: &str) -> Result<(), String> {
    let (rate, longer_us) = parse::rate_and_time(text, HICCUP_US)?;
    if rate > 0.0 {
        (link.hiccup_rate, link.hiccup_us) = (rate, longer_us);
    }
    Ok(())
}

fn serial(text: &str) -> Result<Option<u32>, String> {
    if text == "usb" {
        return Ok(None);
    }
    let rate = ArrayProfile::read_baud(text);
    rate.map(Some).map_err(|why| format!("{why}, or usb"))
}

fn jitter_us(text: &str) -> Result<u32, String> {
    parse::time_us(text).map(|us| u32::try_from(us).unwrap_or(u32::MAX))
}

fn dead(wiring: &mut Miswiring, text: &str) -> Result<(), String> {
    let channels: Result<Vec<u16>, String> =
        items(text).map(|text| whole(text, "channel")).collect();
    wiring.dead.extend(channels?);
    Ok(())
}

fn swapped(wiring: &mut Miswiring, text: &str) -> Result<(), String> {
    let pairs: Result<Vec<[u16; 2]>, String> = text.split_whitespace().map(parse::swap).collect();
    wiring.swapped.extend(pairs?);
    Ok(())
}

fn lies(lies: &mut Vec<FirmwareLie>, text: &str) -> Result<(), String> {
    let described: Result<Vec<FirmwareLie>, String> =
        text.split_whitespace().map(FirmwareLie::read).collect();
    lies.extend(described?);
    Ok(())
}

/// An option: name, label, group, kind, value, usual text, example, help, reader.
macro_rules! option {
    ($name:expr, $label:literal, $group:ident, $kind:ident, $value:literal,
     $usual:literal, $example:literal, $help:literal, $read:expr) => {
        FaultOption {
            name: $name,
            label: $label,
            group: FaultGroup::$group,
            kind: FaultKind::$kind,
            value: $value,
            usual: $usual,
            example: $example,
            help: $help,
            read: $read,
        }
    };
}

/// An option that happens at told times.
macro_rules! once {
    ($name:literal, $label:literal, $group:ident, $kind:ident, $help:literal) => {
        option!(
            $name,
            $label,
            $group,
            Many,
            "TIME",
            "",
            "5s",
            $help,
            |said, text| { said.once(OneOffKind::$kind, text) }
        )
    };
}

/// An option with a share of something.
macro_rules! share {
    ($name:literal, $label:literal, $field:ident, $help:literal) => {
        option!(
            $name,
            $label,
            Bytes,
            One,
            "RATE",
            "0",
            "0.1%",
            $help,
            |said, text| { parse::rate(text).map(|rate| said.link.$field = rate) }
        )
    };
}

/// An option that is on or off.
macro_rules! switch {
    ($name:literal, $label:literal, $field:ident, $help:literal) => {
        option!(
            $name,
            $label,
            Bytes,
            Switch,
            "",
            "",
            "",
            $help,
            |said, text| { switch(text).map(|is_on| said.$field = is_on) }
        )
    };
}

/// Every option, group by group.
#[rustfmt::skip]
pub(super) const OPTIONS: &[FaultOption] = &[
    option!("seed", "Seed", All, One, "N", "1", "7",
        "Where random faults begin; the same seed gives the same faults",
        |said, text| whole(text, "seed").map(|seed| said.faults.seed = seed)),
    option!("way", "Way", All, One, "WAY", "both", "to-host",
        "Which way late, lost and changed bytes go: to-device, to-host or both",
        |said, text| way(text).map(|way| said.way = way)),
    option!("latency", "Latency", Latency, One, "LATENCY", "none", "ftdi",
        "How long bytes take: none, cdc (1 ms frames), ftdi (16 ms timer) or mean~deviation",
        |said, text| parse::latency(text).map(|both| said.latency = both)),
    option!("baud", "Baud", Latency, One, "BAUD", "usb", "115200",
        "Rate of a serial line: its bytes take their time; usb: they take none",
        |said, text| serial(text).map(|baud| said.link.baud = baud)),
    option!("hiccup", "Hiccup", Latency, One, "RATE[:TIME]", "", "1%:50ms",
        "Share of writes that take 50 ms, or TIME, longer",
        |said, text| hiccup(&mut said.link, text)),
    share!("drop", "Drop", drop_rate, "Share of bytes lost"),
    share!("flip", "Flip", flip_rate, "Share of bytes changed"),
    share!("insert", "Insert", insert_rate, "Share of bytes that a random one comes before"),
    share!("lose-usb", "Lose USB packets", usb_loss_rate, "Share of 64-byte USB packets lost"),
    share!("repeat", "Repeat", repeat_rate, "Share of writes that arrive twice"),
    option!("garbage-every", "Garbage every", Bytes, One, "TIME", "", "2s",
        "Mean time between bursts of random bytes",
        |said, text| parse::time_us(text).map(|us| said.link.garbage_every_us = Some(us))),
    switch!("chatter", "Modem manager's chatter", chatter,
        "A modem manager asks AT+GCAP before each visit of a host"),
    switch!("banner", "Boot banner", banner, "The device sends a boot banner after each boot"),
    option!("clock-ppm", "Clock error", Clock, One, "PPM", "0", "100",
        "How much faster the device's clock runs, in parts per million",
        |said, text| whole(text, "clock error").map(|ppm| said.faults.clock_ppm = ppm)),
    option!("tick-jitter", "Tick jitter", Clock, One, "TIME", "0ms", "2ms",
        "How far ticks lie from their place, at most 10ms",
        |said, text| jitter_us(text).map(|us| said.faults.tick_jitter_us = us)),
    once!("stall-reading-at", "Stall reading at", Stalls, StallReading,
        "The device reads nothing, for 300ms"),
    once!("stall-writing-at", "Stall writing at", Stalls, StallWriting,
        "Nothing arrives from the device, for 300ms"),
    once!("unplug-at", "Unplug at", Stalls, Unplug,
        "The cable is out, for 2s; then the port comes back as PATH-2"),
    once!("reboot-at", "Reboot at", Device, Reboot, "The device starts anew, within 300ms"),
    once!("watchdog-at", "Watchdog reset at", Device, Watchdog,
        "The watchdog starts the device anew, within 300ms"),
    once!("over-temperature-at", "Over-temperature at", Device, OverTemperature,
        "The device is too hot, for 2s"),
    once!("over-current-at", "Over-current at", Device, OverCurrent,
        "The amplifier takes too much current, for 2s"),
    option!("over-current-above", "Over-current above", Device, One, "MA", "", "5",
        "The supply trips where the amplifiers take more than so many mA",
        |said, text| whole(text, "current in mA")
            .map(|max_ma| said.faults.over_current_ma = Some(max_ma))),
    once!("hv-sag-at", "High voltage sags at", Device, HvSag,
        "The high voltage breaks down, for 2s"),
    option!("dead", "Dead channels", Channels, Many, "CHANNEL", "", "3",
        "Channels that move nothing, from 0",
        |said, text| dead(&mut said.faults.wiring, text)),
    option!("swap", "Swapped channels", Channels, Many, "A,B", "", "5,6",
        "Two channels that move each other's contactor",
        |said, text| swapped(&mut said.faults.wiring, text)),
    option!(FIRMWARE_LIE, "Firmware lies", Firmware, Many, "NAME[=VALUE]", "", "caps.rows=5",
        "What the firmware says although it is not so, or a rule that it breaks: caps.rows=5, \
         status.tick=-1, no-ramp; @TICK at the end: from that tick on; list: all there are",
        |said, text| lies(&mut said.faults.lies, text)),
];
