//! `selvedge experiment simulate`: sessions of observers that are simulated, as those of people are
//! written.

use std::path::{Path, PathBuf};

use clap::Args;

use super::super::output::OutFile;
use crate::terminal::with_meter_until;
use crate::usage::one_of;
use crate::{CliError, output, signals};
use selvedge_experiment::observer::{Jnd, Observer, Stimuli, Strategy, Weighting};
use selvedge_experiment::{ExperimentError, Simulation};

/// A design, and who takes part.
#[derive(Debug, Args)]
pub(crate) struct SimulateArgs {
    /// Design file, or the name of a design of the program
    design: PathBuf,
    /// How many observers take part
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    observers: u16,
    /// What the chance of observers begins with; schedules have that of the design
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Folder for the logs; one that is there already is never overwritten
    #[arg(long, value_name = "DIR")]
    out: OutFile,
    /// What observers go by: nothing, the levels of both bands, these and their balance, variation
    /// over the textile or over directions, or all
    #[arg(long, default_value = "level",
        value_parser = one_of(Strategy::ALL.map(|one| (one.name(), one))))]
    strategy: Strategy,
    /// What each of these counts: as much as any other, or as much as it tells (practised)
    #[arg(long, default_value = "equal",
        value_parser = one_of(Weighting::ALL.map(|one| (one.name(), one))))]
    weighting: Weighting,
    /// Independent looks that exploring a stimulus is worth
    #[arg(long, value_name = "N", default_value_t = 1,
        value_parser = clap::value_parser!(u32).range(1..))]
    looks: u32,
    /// Share of trials that are answered by a guess
    #[arg(long, value_name = "SHARE", default_value_t = 0.0)]
    lapse: f64,
    /// Just noticeable differences at 40 and 320 Hz, dB, the same at all levels (as published, by
    /// level, if not given)
    #[arg(long, value_name = "DB,DB", value_parser = two_numbers)]
    jnd_db: Option<[f64; 2]>,
    /// Standard deviation of the differences between real cloth and its virtual one, dB
    #[arg(long, value_name = "DB", default_value_t = 0.0)]
    real_error_db: f64,
    /// Noise on every distance that is ranked, in just noticeable differences
    #[arg(long, value_name = "JND", default_value_t = 0.0)]
    rank_noise: f64,
    /// Noise of a target that is kept in mind, in just noticeable differences
    #[arg(long, value_name = "JND", default_value_t = 0.0)]
    memory_noise: f64,
    /// How much observers differ in their noise: standard deviation of its logarithm
    #[arg(long, value_name = "SD", default_value_t = 0.0)]
    spread: f64,
    /// Sessions of every observer
    #[arg(long, value_name = "K", default_value_t = 1,
        value_parser = clap::value_parser!(u32).range(1..=1000))]
    sessions: u32,
}

fn two_numbers(text: &str) -> Result<[f64; 2], String> {
    let mut parts = text.split(',').map(|part| part.trim().parse().ok());
    match (parts.next(), parts.next(), parts.next()) {
        (Some(Some(low)), Some(Some(high)), None) => Ok([low, high]),
        _ => Err("give two numbers of dB, such as 2.4,2.4".to_owned()),
    }
}

impl SimulateArgs {
    fn observer(&self) -> Observer {
        Observer {
            strategy: self.strategy,
            weighting: self.weighting,
            looks: self.looks,
            jnd: self.jnd_db.map_or(Jnd::Published, Jnd::Fixed),
            jnd_spread: self.spread,
            lapse: self.lapse,
            rank_noise_jnd: self.rank_noise,
            memory_noise_jnd: self.memory_noise,
            real_error_db: self.real_error_db,
            ..Observer::default()
        }
    }
}

/// Simulates, and writes the logs.
pub(super) fn run(args: &SimulateArgs) -> Result<(), CliError> {
    let observer = args.observer();
    observer.check()?;
    let design = super::designs::design(&args.design)?;
    let folder = args.design.parent().unwrap_or_else(|| Path::new(""));
    let library = design
        .open_library(folder, selvedge_workbench::build_cache().as_ref())
        .map_err(ExperimentError::from)?;
    let stop = signals::stop_flag()?;
    let stimuli = with_meter_until("reading", &stop, |progress| {
        Stimuli::of(&design, &library, progress)
    })?;
    let simulation = Simulation {
        design: &design,
        stimuli: &stimuli,
        observer: &observer,
        seed: args.seed,
    };
    let numbers = (usize::from(args.observers), args.sessions);
    let logs = with_meter_until("simulating", &stop, |progress| {
        simulation.write(&args.out, numbers, progress)
    })?;
    let described = format!(
        "{} sessions of {} {} in {}; {}\n",
        logs.len(),
        design.study,
        design.experiment,
        args.out.display(),
        observer.describe()
    );
    output::print(&described)
}
