//! The command line: the same work without a window, and the way into the workbench.
//!
//! Results go to standard output or `--out`, notices and progress to stderr. Exit codes: 0 done, 2
//! bad usage or bad input, 1 the work itself failed; with one line that says what, where and how to
//! mend it.
//!
//! # Invariants
//! - the one home of `clap` and `signal-hook`
//! - commands are thin: what they do is done by the floors below, for the window likewise
//! - a result file appears when it is whole, or not at all
//! - a reader that closes our output is no failure
#![cfg_attr(
    test,
    expect(clippy::float_cmp, reason = "tests compare exact results on purpose")
)]

mod array;
mod bridge;
mod bridge_abilities;
mod bridge_faults;
mod bridge_kit;
mod bridge_show;
mod certify;
mod doctor;
mod drape;
mod examples;
mod experiment;
mod failure;
mod figure;
#[cfg(feature = "friction")]
mod friction;
mod help;
mod identify;
mod input;
mod manual;
mod mds;
mod mds_json;
mod method;
mod output;
mod paths;
mod picture;
mod picture_folder;
mod picture_relief;
mod play;
mod play_audio;
mod play_log;
mod play_report;
mod play_source;
mod probe;
mod probe_surface;
mod record;
mod render;
mod render_out;
mod repeats;
mod replay;
mod report;
mod screenshot;
mod stage;
mod terminal;
mod textile;
mod textile_catalogue;
mod textile_import;
mod textile_kes;
mod textile_levels;
mod textile_make;
mod textile_models;
mod textile_words;
mod usage;
mod workbench;

pub(crate) use failure::CliError;

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory as _, FromArgMatches as _, Parser, Subcommand};
use selvedge_foundation::signals;

/// Virtual textiles, felt through a fingertip array of vibrating contactors.
///
/// Without a command: the workbench, on SCENE or on the shipped scene of four textiles.
#[derive(Debug, Parser)]
#[command(
    name = "selvedge",
    bin_name = "selvedge",
    version,
    args_conflicts_with_subcommands = true
)]
#[command(disable_help_subcommand = true)]
struct Cli {
    /// Scene file to open in the workbench
    scene: Option<PathBuf>,
    /// The public face over the whole screen, for visitors of an exhibition
    #[arg(long, visible_alias = "demo")]
    stage: bool,
    /// Tell what is wrong with SCENE in the window: for launchers, which show no stderr
    #[arg(long, conflicts_with = "stage")]
    from_desktop: bool,
    /// What the operator decides: PIN, port, width of the screen (stage.toml among the settings)
    #[arg(long, value_name = "TOML", requires = "stage")]
    operator: Option<PathBuf>,
    /// No notices and no progress on stderr: errors alone
    #[arg(long, short, global = true)]
    quiet: bool,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Replay an exploration: the amplitudes of every contactor at every tick
    Render(render::RenderArgs),
    /// A stylus over a surface: place, force, friction, vibration and energy at every step
    Probe(probe::ProbeArgs),
    /// A hanging cloth under two fingers: forces, slip and shape at every step
    Drape(drape::DrapeArgs),
    /// Draw a whole exploration on one page: the way, amplitudes, spectra, levels, a caption
    Figure(figure::FigureArgs),
    /// Play an exploration in real time on a device
    Play(play::PlayArgs),
    /// The library of textiles
    #[command(subcommand)]
    Textile(textile::TextileCommand),
    /// The repeats of a cloth from a picture, and the cell that repeats
    Picture(picture::PictureArgs),
    /// Friction from a picture of cloth, and how far a network gets
    #[cfg(feature = "friction")]
    #[command(subcommand)]
    Friction(friction::FrictionCommand),
    /// Tablets and touch frames
    #[command(subcommand)]
    Input(input::InputCommand),
    /// A map from dissimilarities: non-metric multidimensional scaling
    Mds(mds::MdsArgs),
    /// Experiments on people
    #[command(subcommand)]
    Experiment(experiment::ExperimentCommand),
    /// Serial ports and devices
    #[command(subcommand)]
    Bridge(bridge::BridgeCommand),
    /// What works on this machine, and how to mend what does not
    Doctor(doctor::DoctorArgs),
    /// Error against run time, stability, what is left out: tables and plots
    Report(report::ReportArgs),
    /// What visitors did
    #[command(subcommand)]
    Stage(stage::StageCommand),
    /// The workbench as a picture, no display needed
    Screenshot(screenshot::ScreenshotArgs),
    /// The guide, page by page, and what each command takes
    Help(help::HelpArgs),
    /// What a shell completes commands by, printed: bash, zsh, fish and others
    Completions(manual::CompletionsArgs),
    /// A manual page for every command
    Man(manual::ManArgs),
}

/// The command line as it is declared, with examples.
fn command() -> clap::Command {
    examples::added(Cli::command())
}

/// Runs the command line of this process.
pub fn main() -> ExitCode {
    let mut args: Vec<OsString> = std::env::args_os().collect();
    usage::switch_behind_command(&mut args);
    signals::leave_nothing_behind();
    let mut command = command();
    let words = args.get(1..).unwrap_or_default();
    if let Some(line) = usage::unknown_command(words, &command) {
        terminal::line(&line);
        return ExitCode::from(2);
    }
    let parsed = command.try_get_matches_from_mut(&args);
    let parsed = parsed.and_then(|matches| Ok((Cli::from_arg_matches(&matches)?, matches)));
    let (cli, matches) = match parsed {
        Ok(parsed) => parsed,
        Err(error) => return usage::answer(&error, words, &command),
    };
    let ended = paths::check(&command, &matches).and_then(|()| run(cli));
    terminal::end();
    match ended {
        Ok(()) | Err(CliError::OutputClosed) => ExitCode::SUCCESS,
        Err(error) => {
            let code = error.exit_code();
            if code != 0 {
                terminal::line(&one_line(&error.to_string()));
            }
            ExitCode::from(code)
        }
    }
}

fn run(cli: Cli) -> Result<(), CliError> {
    if cli.quiet {
        terminal::be_quiet();
    }
    match cli.command {
        None if cli.stage => stage::open(cli.scene.as_deref(), cli.operator.as_deref()),
        None if cli.from_desktop => workbench::open_from_desktop(cli.scene.as_deref()),
        None => workbench::open(cli.scene.as_deref()),
        Some(Command::Render(args)) => render::run(&args),
        Some(Command::Probe(args)) => probe::run(&args),
        Some(Command::Drape(args)) => drape::run(&args),
        Some(Command::Figure(args)) => figure::run(&args),
        Some(Command::Play(args)) => play::run(&args),
        Some(Command::Textile(command)) => textile::run(&command),
        Some(Command::Picture(args)) => picture::run(&args),
        #[cfg(feature = "friction")]
        Some(Command::Friction(command)) => friction::run(&command),
        Some(Command::Input(command)) => input::run(&command),
        Some(Command::Mds(args)) => mds::run(&args),
        Some(Command::Experiment(command)) => experiment::run(&command),
        Some(Command::Bridge(command)) => bridge::run(&command),
        Some(Command::Doctor(args)) => doctor::run(&args),
        Some(Command::Report(args)) => report::run(&args),
        Some(Command::Stage(command)) => stage::run(&command),
        Some(Command::Screenshot(args)) => screenshot::run(&args),
        Some(Command::Help(args)) => help::run(&args),
        Some(Command::Completions(args)) => manual::print_completions(&args),
        Some(Command::Man(args)) => manual::write_pages(&args),
    }
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
