//! `selvedge play`: an exploration in real time on a device.
//!
//! The device paces: every tick that it announces is answered with the amplitudes of the next tick
//! of the path, so that what is felt is what `selvedge render` computes, tick for tick.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;

use super::method::MethodArgs;
use super::output::{InFile, OutFile};
use super::play_log::PlayLog;
use super::play_report::PlayReport;
use super::play_source::{Moving, SourceArgs};
use super::record::{self, RecordArgs};
use super::{CliError, array, output, play_audio, signals, terminal};

use selvedge_device::{
    ArrayProfile, Bridge, BridgeEvent, Driver, Ended, FrameSource, SessionLog, Target,
};
use selvedge_engine::{CardChannels, Notice, PreparedScene};
use selvedge_foundation::files::read_text;
use selvedge_render::scene::LoadedScene;

/// What to play, and where.
#[derive(Debug, Args)]
pub(super) struct PlayArgs {
    /// Scene file; `-` is standard input
    scene: InFile,
    #[command(flatten)]
    source: SourceArgs,
    /// Serial port of the device
    #[arg(long, value_name = "PORT", required_unless_present = "audio")]
    port: Option<PathBuf>,
    /// Sound card to play on instead, one channel a contactor: its name or a part of it
    #[arg(long, value_name = "DEVICE", conflicts_with_all = ["port", "baud", "log", "session_log"])]
    audio: Option<String>,
    /// The card's channel of each contactor in order, counted from 1, such as 1,2,5-8; without it
    /// the first ones
    #[arg(long, value_name = "CHANNELS", requires = "audio")]
    channels: Option<CardChannels>,
    #[arg(long, value_name = "ARRAY", help = array::HELP, value_parser = array::profile)]
    array: Option<Box<ArrayProfile>>,
    #[command(flatten)]
    baud: array::BaudArgs,
    /// Every frame sent: apply tick, soft-start gain, amplitudes and codes
    #[arg(long, value_name = "L.csv")]
    log: Option<OutFile>,
    #[command(flatten)]
    record: RecordArgs,
    #[command(flatten)]
    how: MethodArgs,
}

impl PlayArgs {
    /// The files whose hashes a session log holds.
    fn files(&self) -> Vec<(&'static str, &Path)> {
        let path = self.source.path_file().map(|path| ("path", path));
        let scene = (!self.scene.is_stream()).then_some(("scene", &*self.scene));
        scene.into_iter().chain(path).collect()
    }
}

/// Plays, and says how punctual it was.
pub(super) fn run(args: &PlayArgs) -> Result<(), CliError> {
    let cache = selvedge_workbench::build_cache();
    let text = read_text(&args.scene)?;
    let loaded = LoadedScene::from_text(&text, args.scene.place(), cache.as_ref())?;
    if let Some(changed) = loaded.changed() {
        terminal::notice(&changed);
    }
    if let Some(port) = &args.port {
        check_port(port)?;
    }
    let mut scene = PreparedScene::prepare(&loaded, args.how.method, &args.how.accuracy())?;
    if let Some(array) = &args.array {
        array::fit(array, &loaded)?;
        scene.drive_as(array);
    }
    let log = match &args.log {
        Some(place) => Some(PlayLog::create(place, scene.profile(), scene.n_felt())?),
        None => None,
    };
    let session_log = args.record.open()?;
    let stop = signals::stop_flag()?;
    let mut profile = scene.profile().clone();
    args.baud.set(&mut profile);
    let moving = Moving::begin(&args.source, scene, loaded.scene().size_mm)?;
    let port = match (&args.port, &args.audio) {
        (_, Some(card)) => {
            let channels = args.channels.as_ref();
            return play_audio::play(card, channels, moving, &profile, &stop);
        }
        (port, None) => port.clone().unwrap_or_default(),
    };
    let n_felt = moving.core.felt_um().len();
    let mut driver = Driver::open(Target::Port(port), profile.clone(), n_felt);
    if let Some(session_log) = &session_log {
        let mut feed = driver.bridge().feed_of(session_log);
        record::say_what(&mut feed, &profile, &args.files());
        driver.bridge_mut().log_to(feed);
    }
    let mut player = Player {
        target: driver.bridge().target().to_owned(),
        moving,
        log,
        n_frames: 0,
        n_bad_lines: 0,
    };
    let ended = driver.run(&mut player, &stop);
    let report = player.report(&driver);
    driver.close();
    let logged = session_log.map_or(Ok(()), SessionLog::finish);
    let written = player.log.map_or(Ok(()), PlayLog::finish);
    let ended = ended?;
    logged?;
    written?;
    let printed = output::print(&report.to_string());
    // A signal may have come from a terminal that closed: nobody is there to read this.
    if ended == Ended::ByRequest {
        Ok(())
    } else {
        printed
    }
}

/// Refuses what is no port before anything is prepared.
pub(super) fn check_port(port: &Path) -> Result<(), CliError> {
    let name = port.display();
    let mend = "\"selvedge bridge list\" names the ports, \"selvedge bridge emulate\" makes one";
    // Elsewhere ports are names that no file system knows.
    if cfg!(unix) && !port.exists() {
        return Err(CliError::Input(format!("there is no port {name}; {mend}")));
    }
    if port.is_dir() || port.is_file() {
        return Err(CliError::Input(format!("{name} is no serial port; {mend}")));
    }
    Ok(())
}

/// A path on its way to a device.
struct Player {
    target: String,
    moving: Moving,
    log: Option<PlayLog>,
    n_frames: u64,
    n_bad_lines: u64,
}

impl FrameSource for Player {
    type Error = CliError;

    fn event(&mut self, event: &BridgeEvent) -> Result<(), CliError> {
        let describe = |what: &str| terminal::notice(&format!("{}: {what}", self.target));
        match event {
            BridgeEvent::Connected(caps) => {
                if let Some(doubt) = array::doubt(self.moving.core.scene().profile(), caps) {
                    describe(&doubt);
                }
            }
            BridgeEvent::DepthRaised(depth) => {
                let what = "frames came late: now sent";
                describe(&format!(
                    "{what} {depth} ticks ahead, felt more than 40 ms late"
                ));
            }
            BridgeEvent::Log(text) => {
                terminal::heard(&format!("{}: the device says: {text}", self.target));
            }
            _ => {}
        }
        Ok(())
    }

    /// Answers a tick of the device with the next tick of the path.
    fn tick(&mut self, bridge: &mut Bridge) -> Result<ControlFlow<()>, CliError> {
        let mut has_ended = false;
        self.moving.core.tick(Instant::now(), &mut |notice| {
            has_ended |= matches!(notice, Notice::SourceEnded);
        });
        if has_ended {
            return Ok(ControlFlow::Break(()));
        }
        let felt_um = self.moving.core.felt_um();
        if let Some(sent) = bridge.send(felt_um, self.moving.core.fresh_stamp()) {
            self.n_frames += 1;
            if let Some(log) = &mut self.log {
                log.set_link(bridge.session().link_scale());
                log.frame(&sent, &self.moving.core.pose(), felt_um)?;
            }
        }
        self.moving.write_tick();
        self.describe_bad_lines();
        Ok(ControlFlow::Continue(()))
    }
}

impl Player {
    /// Lines that were no position are dropped; the first is told at once, all at the end.
    fn describe_bad_lines(&mut self) {
        let n_bad = self.moving.core.losses().bad_lines;
        if n_bad > 0 && self.n_bad_lines == 0 {
            terminal::notice(
                "a line is no position and was dropped; write x_mm,y_mm or t_s,x_mm,y_mm",
            );
        }
        self.n_bad_lines = n_bad;
    }

    fn report(&self, driver: &Driver) -> PlayReport {
        PlayReport {
            target: self.target.clone(),
            duration: driver.elapsed(),
            n_frames: self.n_frames,
            n_missed: driver.missed(),
            n_bad_lines: self.n_bad_lines,
            input: (self.moving.core.input_rate(), self.moving.core.losses()),
            counters: driver.bridge().counters(),
            timings: driver.bridge().timings(),
        }
    }
}
