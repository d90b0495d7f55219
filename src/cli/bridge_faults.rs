//! The options of `selvedge bridge emulate` that make the device or its link fail.

use clap::Args;

use crate::bridge::{
    Direction, Faults, LaneFaults, Latency, Lie, Miswiring, OneOff, OneOffKind, parse_latency,
    parse_lie, parse_one_off, parse_rate, parse_rate_and_time, parse_swap, parse_time_us,
};

const HICCUP_US: u64 = 50_000;
const LINK: &str = "Faults of the link";
const DEVICE: &str = "Faults of the device";
const ONCE: &str = "Faults at a time since the start (5s, 5s+300ms for how long; 5s,20s for two)";

/// What is to go wrong. Nothing, unless it is asked for.
#[derive(Debug, Args)]
pub(super) struct FaultArgs {
    /// Where random faults begin; the same seed gives the same faults
    #[arg(long, value_name = "N", default_value_t = 1, help_heading = LINK)]
    seed: u64,
    /// How long bytes take: none, cdc (1 ms frames), ftdi (16 ms timer) or mean~deviation
    #[arg(long, value_name = "LATENCY", default_value = "none", help_heading = LINK,
          value_parser = parse_latency)]
    latency: [Latency; 2],
    /// Share of writes that take 50 ms, or TIME, longer
    #[arg(long, value_name = "RATE[:TIME]", help_heading = LINK, value_parser = hiccup)]
    hiccup: Option<(f64, u64)>,
    /// Share of bytes lost
    #[arg(long, value_name = "RATE", default_value = "0", help_heading = LINK,
          value_parser = parse_rate)]
    drop: f64,
    /// Share of bytes changed
    #[arg(long, value_name = "RATE", default_value = "0", help_heading = LINK,
          value_parser = parse_rate)]
    flip: f64,
    /// Share of bytes that a random one comes before
    #[arg(long, value_name = "RATE", default_value = "0", help_heading = LINK,
          value_parser = parse_rate)]
    insert: f64,
    /// Share of 64-byte USB packets lost
    #[arg(long, value_name = "RATE", default_value = "0", help_heading = LINK,
          value_parser = parse_rate)]
    lose_usb: f64,
    /// Share of writes that arrive twice
    #[arg(long, value_name = "RATE", default_value = "0", help_heading = LINK,
          value_parser = parse_rate)]
    repeat: f64,
    /// Mean time between bursts of random bytes
    #[arg(long, value_name = "TIME", help_heading = LINK, value_parser = parse_time_us)]
    garbage_every: Option<u64>,
    /// Which way all of these act: to-device, to-host or both
    #[arg(long, value_name = "WAY", default_value = "both", help_heading = LINK,
          value_parser = way)]
    way: Way,
    /// A modem manager asks AT+GCAP before each visit of a host
    #[arg(long, help_heading = LINK)]
    chatter: bool,
    /// The device sends a boot banner after each boot
    #[arg(long, help_heading = LINK)]
    banner: bool,

    /// How much faster the device's clock runs, in parts per million
    #[arg(long, value_name = "PPM", default_value_t = 0, help_heading = DEVICE,
          allow_negative_numbers = true)]
    clock_ppm: i32,
    /// How far ticks lie from their place, at most 10ms
    #[arg(long, value_name = "TIME", default_value = "0ms", help_heading = DEVICE,
          value_parser = parse_time_us)]
    tick_jitter: u64,
    /// What CAPS say although it is not so: version=2, rows=5, cols, channels, components,
    /// tick-us, low-mhz, high-mhz, max-body; cut=40 cuts them short
    #[arg(long, value_name = "KEY=VALUE", help_heading = DEVICE, value_parser = parse_lie)]
    lie: Vec<Lie>,
    /// A channel that moves nothing, from 0
    #[arg(long, value_name = "CHANNEL", help_heading = DEVICE, value_delimiter = ',')]
    dead: Vec<u16>,
    /// Two channels that move each other's contactor
    #[arg(long, value_name = "A,B", help_heading = DEVICE, value_parser = parse_swap)]
    swap: Vec<[u16; 2]>,

    /// The device reads nothing, for 300ms
    #[arg(long, value_name = "TIME", help_heading = ONCE, value_delimiter = ',',
          value_parser = once(OneOffKind::StallReading))]
    stall_reading_at: Vec<OneOff>,
    /// Nothing arrives from the device, for 300ms
    #[arg(long, value_name = "TIME", help_heading = ONCE, value_delimiter = ',',
          value_parser = once(OneOffKind::StallWriting))]
    stall_writing_at: Vec<OneOff>,
    /// The cable is out, for 2s; then the port comes back as PATH-2
    #[arg(long, value_name = "TIME", help_heading = ONCE, value_delimiter = ',',
          value_parser = once(OneOffKind::Unplug))]
    unplug_at: Vec<OneOff>,
    /// The device starts anew, within 300ms
    #[arg(long, value_name = "TIME", help_heading = ONCE, value_delimiter = ',',
          value_parser = once(OneOffKind::Reboot))]
    reboot_at: Vec<OneOff>,
    /// The watchdog starts the device anew, within 300ms
    #[arg(long, value_name = "TIME", help_heading = ONCE, value_delimiter = ',',
          value_parser = once(OneOffKind::Watchdog))]
    watchdog_at: Vec<OneOff>,
    /// The device is too hot, for 2s
    #[arg(long, value_name = "TIME", help_heading = ONCE, value_delimiter = ',',
          value_parser = once(OneOffKind::OverTemperature))]
    over_temperature_at: Vec<OneOff>,
    /// The amplifier takes too much current, for 2s
    #[arg(long, value_name = "TIME", help_heading = ONCE, value_delimiter = ',',
          value_parser = once(OneOffKind::OverCurrent))]
    over_current_at: Vec<OneOff>,
    /// The high voltage breaks down, for 2s
    #[arg(long, value_name = "TIME", help_heading = ONCE, value_delimiter = ',',
          value_parser = once(OneOffKind::HvSag))]
    hv_sag_at: Vec<OneOff>,
}

impl FaultArgs {
    /// The faults that were asked for.
    pub(super) fn faults(&self) -> Faults {
        let once = [
            &self.stall_reading_at,
            &self.stall_writing_at,
            &self.unplug_at,
            &self.reboot_at,
            &self.watchdog_at,
            &self.over_temperature_at,
            &self.over_current_at,
            &self.hv_sag_at,
        ];
        Faults {
            seed: self.seed,
            to_device: self.lane(Direction::ToDevice),
            to_host: self.lane(Direction::ToHost),
            clock_ppm: self.clock_ppm,
            tick_jitter_us: u32::try_from(self.tick_jitter).unwrap_or(u32::MAX),
            lies: self.lie.clone(),
            wiring: Miswiring {
                dead: self.dead.clone(),
                swapped: self.swap.clone(),
            },
            once: once.into_iter().flatten().copied().collect(),
        }
    }

    fn lane(&self, direction: Direction) -> LaneFaults {
        let (at, chatter) = match direction {
            Direction::ToDevice => (0, self.chatter),
            Direction::ToHost => (1, self.banner),
        };
        let spoken = LaneFaults {
            chatter,
            ..LaneFaults::default()
        };
        if self.way.0.is_some_and(|only| only != direction) {
            return spoken;
        }
        let (hiccup_rate, hiccup_us) = self.hiccup.unwrap_or_default();
        LaneFaults {
            latency: self.latency[at],
            hiccup_rate,
            hiccup_us,
            drop_rate: self.drop,
            flip_rate: self.flip,
            insert_rate: self.insert,
            usb_loss_rate: self.lose_usb,
            repeat_rate: self.repeat,
            garbage_every_us: self.garbage_every,
            ..spoken
        }
    }
}

/// One direction only, or both.
#[derive(Clone, Copy, Debug)]
struct Way(Option<Direction>);

fn way(text: &str) -> Result<Way, String> {
    match text {
        "both" => Ok(Way(None)),
        "to-device" => Ok(Way(Some(Direction::ToDevice))),
        "to-host" => Ok(Way(Some(Direction::ToHost))),
        _ => Err("the ways are to-device, to-host and both".to_owned()),
    }
}

fn hiccup(text: &str) -> Result<(f64, u64), String> {
    parse_rate_and_time(text, HICCUP_US)
}

fn once(kind: OneOffKind) -> impl Fn(&str) -> Result<OneOff, String> + Clone + Send + Sync {
    move |text| parse_one_off(kind, text)
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        faults: FaultArgs,
    }

    fn read(words: &str) -> Result<Faults, String> {
        let line = Line::try_parse_from(std::iter::once("emulate").chain(words.split(' ')));
        line.map(|line| line.faults.faults())
            .map_err(|error| error.to_string())
    }

    #[test]
    fn without_an_option_nothing_goes_wrong() {
        assert!(read("--seed 7").unwrap().is_none());
    }

    #[test]
    fn every_option_becomes_its_fault_and_one_way_leaves_the_other_alone() {
        let faults = read(
            "--seed 7 --latency ftdi --hiccup 1%:20ms --drop 0.1 --flip 0.2 --insert 0.3 \
             --lose-usb 0.4 --repeat 0.5 --garbage-every 2s --way to-host --chatter --banner \
             --clock-ppm -100 --tick-jitter 3ms --lie rows=5 --lie cut=40 --dead 3,4 --swap 5,6 \
             --stall-reading-at 1s,2s+1s --stall-writing-at 3s --unplug-at 4s --reboot-at 5s \
             --watchdog-at 6s --over-temperature-at 7s --over-current-at 8s --hv-sag-at 9s",
        )
        .unwrap();
        let host = faults.to_host;
        let rates = [
            host.hiccup_rate,
            host.drop_rate,
            host.flip_rate,
            host.insert_rate,
            host.usb_loss_rate,
            host.repeat_rate,
        ];
        assert_eq!(rates, [0.01, 0.1, 0.2, 0.3, 0.4, 0.5]);
        assert_eq!((host.hiccup_us, host.chatter), (20_000, true));
        assert_eq!(host.garbage_every_us, Some(2_000_000));
        assert_eq!(host.latency, Latency::Timer(16_000));
        let only_chatter = LaneFaults {
            chatter: true,
            ..LaneFaults::default()
        };
        assert_eq!(faults.to_device, only_chatter);
        assert_eq!((faults.clock_ppm, faults.tick_jitter_us), (-100, 3000));
        assert_eq!(faults.lies, [Lie::Rows(5), Lie::Cut(40)]);
        assert_eq!(faults.wiring.dead, [3, 4]);
        assert_eq!(faults.wiring.swapped, [[5, 6]]);
        let kinds: Vec<OneOffKind> = faults.once.iter().map(|once| once.kind).collect();
        assert_eq!(kinds[0], OneOffKind::StallReading);
        assert_eq!(kinds[1..], OneOffKind::ALL);
        assert_eq!(faults.once[1].for_us, 1_000_000);
    }

    #[test]
    fn what_is_not_understood_says_what_is() {
        for (words, told) in [
            ("--drop 3", "0 to 1"),
            ("--latency slow", "5ms~2ms"),
            ("--reboot-at soon", "300ms"),
            ("--way up", "to-device"),
            ("--lie hue=3", "max-body"),
            ("--swap 3", "two channels"),
        ] {
            let error = read(words).unwrap_err();
            assert!(error.contains(told), "{error}");
        }
        let check = |words| read(words).unwrap().check(24).unwrap_err();
        assert!(check("--dead 24").contains("channels 0 to 23"));
        assert!(check("--clock-ppm 20000").contains("10000"));
        assert!(check("--tick-jitter 20ms").contains("10 ms"));
    }
}
