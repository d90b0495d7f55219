//! The options of `selvedge bridge emulate` that make the device or its link fail: the rows of
//! [`FaultOption`] as arguments.

use std::ffi::OsStr;

use clap::builder::TypedValueParser;
use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, Error, FromArgMatches};

use selvedge_device::{FaultKind, FaultOption, FaultWords, Faults};

/// The value that asks for all the values there are.
const LIST: &str = "list";

/// What is to go wrong. Nothing, unless it is asked for.
#[derive(Debug)]
pub(super) struct FaultArgs {
    words: FaultWords,
}

impl FaultArgs {
    /// The faults that were asked for.
    ///
    /// # Errors
    /// What cannot be read, by its option. Arguments were read when they were parsed.
    pub(super) fn faults(&self) -> Result<Faults, String> {
        let faults = self.words.faults();
        faults.map_err(|(option, why)| format!("--{}: {why}", option.name))
    }
}

impl Args for FaultArgs {
    fn augment_args(command: Command) -> Command {
        command.args(FaultOption::ALL.iter().map(argument))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for FaultArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let mut args = Self {
            words: FaultWords::default(),
        };
        args.update_from_arg_matches(matches)?;
        Ok(args)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        for option in FaultOption::ALL {
            if matches.value_source(option.name) != Some(ValueSource::CommandLine) {
                continue;
            }
            let text = if option.kind == FaultKind::Switch {
                FaultWords::ON.to_owned()
            } else {
                let texts = matches
                    .get_many::<String>(option.name)
                    .into_iter()
                    .flatten();
                texts.map(String::as_str).collect::<Vec<_>>().join(" ")
            };
            self.words.say(option, &text);
        }
        Ok(())
    }
}

fn argument(option: &'static FaultOption) -> Arg {
    let argument = Arg::new(option.name)
        .long(option.name)
        .help(option.help)
        .help_heading(option.group.heading());
    let argument = match option.kind {
        FaultKind::Switch => return argument.action(ArgAction::SetTrue),
        FaultKind::One => argument.action(ArgAction::Set),
        FaultKind::Many => argument.action(ArgAction::Append),
    };
    let argument = argument
        .value_name(option.value)
        .allow_negative_numbers(true)
        .value_parser(TextOf(option));
    if option.usual.is_empty() {
        argument
    } else {
        argument.default_value(option.usual)
    }
}

/// Checks the text of an option, or tells all that can be said.
#[derive(Clone)]
struct TextOf(&'static FaultOption);

impl TypedValueParser for TextOf {
    type Value = String;

    fn parse_ref(
        &self,
        command: &Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<String, Error> {
        let option = self.0;
        if let Some(listing) = option.listing().filter(|_| value == LIST) {
            return Err(Error::raw(ErrorKind::DisplayHelp, listing));
        }
        let check = move |text: &str| option.check(text).map(|()| text.to_owned());
        check.parse_ref(command, argument, value)
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use selvedge_device::{Latency, LinkFaults, OneOffKind};

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        faults: FaultArgs,
    }

    fn read(words: &str) -> Result<Faults, String> {
        let line = Line::try_parse_from(std::iter::once("emulate").chain(words.split(' ')));
        line.map_err(|error| error.to_string())?.faults.faults()
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
             --clock-ppm -100 --tick-jitter 3ms --firmware-lie caps.rows=5 \
             --firmware-lie no-ramp --dead 3,4 --swap 5,6 \
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
        let only_chatter = LinkFaults {
            chatter: true,
            ..LinkFaults::default()
        };
        assert_eq!(faults.to_device, only_chatter);
        assert_eq!((faults.clock_ppm, faults.tick_jitter_us), (-100, 3000));
        let lies: Vec<String> = faults.lies.iter().map(ToString::to_string).collect();
        assert_eq!(lies, ["caps.rows=5", "no-ramp"]);
        assert_eq!(faults.wiring.dead, [3, 4]);
        assert_eq!(faults.wiring.swapped, [[5, 6]]);
        let kinds: Vec<OneOffKind> = faults.once.iter().map(|once| once.kind).collect();
        assert_eq!(kinds[0], OneOffKind::StallReading);
        assert_eq!(kinds[1..], OneOffKind::ALL);
        assert_eq!(faults.once[1].for_us, 1_000_000);
    }

    #[test]
    fn all_firmware_lies_are_listed_on_request() {
        let listing = read("--firmware-lie list").unwrap_err();
        assert!(listing.contains("\ncaps.rows=") && listing.contains("\nno-ramp "));
    }

    #[test]
    fn what_is_not_understood_says_what_is() {
        for (words, described) in [
            ("--drop 3", "0 to 1"),
            ("--latency slow", "5ms~2ms"),
            ("--reboot-at soon", "300ms"),
            ("--way up", "to-device"),
            ("--firmware-lie caps.hue=3", "caps.max-body"),
            ("--firmware-lie hue", "no-ramp"),
            ("--swap 3", "two channels"),
        ] {
            let error = read(words).unwrap_err();
            assert!(error.contains(described), "{error}");
        }
        let check = |words| read(words).unwrap().check(24).unwrap_err();
        assert!(check("--dead 24").contains("channels 0 to 23"));
        assert!(check("--clock-ppm 20000").contains("10000"));
        assert!(check("--tick-jitter 20ms").contains("10 ms"));
    }
}
