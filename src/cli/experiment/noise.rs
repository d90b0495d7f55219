//! `selvedge experiment noise`: a noise that covers what contactors can be heard by.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::terminal::Meter;
use crate::{CliError, signals};
use selvedge_experiment::{Colour, MOST_NOISE_MINUTES, MaskingNoise};
use selvedge_foundation::progress::{CancelFlag, Progress};

/// A noise and its file.
#[derive(Debug, Args)]
pub(crate) struct NoiseArgs {
    /// Where it is written: one channel of 16 bits at 48 kHz, for any player
    #[arg(long, value_name = "WAV")]
    out: PathBuf,
    /// How long it lasts; without a fade it can be repeated without a seam
    #[arg(long, value_name = "MINUTES", default_value_t = 10,
        value_parser = clap::value_parser!(u16).range(1..=i64::from(MOST_NOISE_MINUTES)))]
    minutes: u16,
    /// As strong in every third of an octave, or in every Hz; both from 30 Hz to 6 kHz
    #[arg(long, value_enum, default_value_t = ColourArg::Pink)]
    colour: ColourArg,
    /// What chance begins with
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Fade in and out for so long, for a file that is played once
    #[arg(
        long,
        value_name = "SECONDS",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    fade_s: f64,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum ColourArg {
    Pink,
    White,
}

/// Writes it.
pub(super) fn run(args: &NoiseArgs) -> Result<(), CliError> {
    let noise = MaskingNoise {
        colour: match args.colour {
            ColourArg::Pink => Colour::Pink,
            ColourArg::White => Colour::White,
        },
        seed: args.seed,
        minutes: args.minutes,
        fade_s: args.fade_s,
    };
    let mut meter = Meter::new("writing");
    let mut report = |share: f64, what: &str| meter.show(share, what);
    let mut progress = Progress::new(&mut report, CancelFlag::shared(signals::stop_flag()?));
    Ok(noise.write(&args.out, &mut progress)?)
}
