//! `selvedge experiment noise`: a noise that covers what contactors can be heard by.

use clap::Args;

use super::super::output::OutFile;
use crate::CliError;
use crate::terminal::with_meter;
use crate::usage::one_of;
use selvedge_experiment::{Colour, MaskingNoise};

/// A noise and its file.
#[derive(Debug, Args)]
pub(crate) struct NoiseArgs {
    /// Where it is written: one channel of 16 bits at 48 kHz, for any player
    #[arg(long, value_name = "WAV")]
    out: OutFile,
    /// How long it lasts; without a fade it can be repeated without a seam
    #[arg(long, value_name = "MINUTES", default_value_t = 10,
        value_parser = clap::value_parser!(u16).range(1..=i64::from(MaskingNoise::MOST_MINUTES)))]
    minutes: u16,
    /// As strong in every third of an octave, or in every Hz; both from 30 Hz to 6 kHz
    #[arg(long, default_value = "pink",
        value_parser = one_of(Colour::ALL.map(|one| (one.name(), one))))]
    colour: Colour,
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

/// Writes it.
pub(super) fn run(args: &NoiseArgs) -> Result<(), CliError> {
    let noise = MaskingNoise {
        colour: args.colour,
        seed: args.seed,
        minutes: args.minutes,
        fade_s: args.fade_s,
    };
    Ok(with_meter("writing", |progress| {
        noise.write(&args.out, progress)
    })??)
}
