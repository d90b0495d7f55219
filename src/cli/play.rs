//! `selvedge play`: an exploration in real time on a device.
//!
//! The device paces: every tick that it announces is answered with the amplitudes of the next tick
//! of the path, so that what is felt is what `selvedge render` computes, tick for tick. Whatever
//! happens, the device is told to stop, and its answer is waited for.

use std::panic;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use clap::Args;

use super::method::MethodArgs;
use super::play_log::PlayLog;
use super::play_report::PlayReport;
use super::play_source::{Moving, SourceArgs};
use super::record::{self, RecordArgs};
use super::{CliError, array, output, play_audio, signals, terminal};

use selvedge_device::{
    ArrayProfile, Bridge, BridgeError, BridgeEvent, BridgeState, DisarmedBy, SessionLog,
    StopHandle, StopHow, Target, fault_bit,
};
use selvedge_engine::{Notice, PreparedScene};
use selvedge_render::scene::LoadedScene;

/// How long to wait for the device before something is said of it: it is polled this often.
const NAP: Duration = Duration::from_millis(20);
/// The last STOP is sent again every 250 ms, eight times; then the session itself gives up.
const STOP_PATIENCE: Duration = Duration::from_secs(4);

/// Longest wait for the STOP of a program that fails.
const LAST_WORD: Duration = Duration::from_millis(250);

/// What to play, and where.
#[derive(Debug, Args)]
pub(super) struct PlayArgs {
    /// Scene file
    scene: PathBuf,
    #[command(flatten)]
    source: SourceArgs,
    /// Serial port of the device
    #[arg(long, value_name = "PORT", required_unless_present = "audio")]
    port: Option<PathBuf>,
    /// Sound card to play on instead, one channel a contactor: its name or a part of it
    #[arg(long, value_name = "DEVICE", conflicts_with_all = ["port", "log", "session_log"])]
    audio: Option<String>,
    #[arg(long, value_name = "ARRAY", help = array::HELP, value_parser = array::profile)]
    array: Option<Box<ArrayProfile>>,
    /// Every frame sent: apply tick, soft-start gain, amplitudes and codes
    #[arg(long, value_name = "L.csv")]
    log: Option<PathBuf>,
    #[command(flatten)]
    record: RecordArgs,
    #[command(flatten)]
    how: MethodArgs,
}

impl PlayArgs {
    /// The files whose hashes a session log holds.
    fn files(&self) -> Vec<(&'static str, &Path)> {
        let path = self.source.path_file().map(|path| ("path", path));
        [("scene", self.scene.as_path())]
            .into_iter()
            .chain(path)
            .collect()
    }
}

/// Plays, and says how punctual it was.
pub(super) fn run(args: &PlayArgs) -> Result<(), CliError> {
    let loaded = LoadedScene::read(&args.scene, selvedge_workbench::build_cache().as_ref())?;
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
    let profile = scene.profile().clone();
    let moving = Moving::begin(&args.source, scene, loaded.scene().size_mm)?;
    let port = match (&args.port, &args.audio) {
        (_, Some(card)) => return play_audio::play(card, moving, &profile, &stop),
        (port, None) => port.clone().unwrap_or_default(),
    };
    let profile_told = profile.clone();
    let mut player = Player::open(port, profile, moving, log);
    if let Some(session_log) = &session_log {
        let mut feed = session_log.feed(player.bridge.target());
        record::say_what(&mut feed, &profile_told, &args.files());
        player.bridge.log_to(feed);
    }
    let played = player.play(&stop);
    let stopped = player.stop();
    let closed = player.close();
    session_log.map_or(Ok(()), SessionLog::finish)?;
    let report = closed?;
    played?;
    stopped?;
    output::print(&report.to_string())
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

/// Lets a panic stop the device before it is reported as it was.
fn stop_on_panic(handle: StopHandle) {
    let report = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        handle.stop(StopHow::Now);
        handle.wait_written(LAST_WORD);
        report(info);
    }));
}

/// A path on its way to a device.
struct Player {
    moving: Moving,
    bridge: Bridge,
    log: Option<PlayLog>,
    started: Option<Instant>,
    last_tick: Option<u32>,
    /// The device tick that is to be answered, and when.
    asked: Option<(u32, Instant)>,
    n_frames: u64,
    n_missed: u64,
    n_bad_lines: u64,
    has_ended: bool,
}

impl Player {
    fn open(port: PathBuf, profile: ArrayProfile, moving: Moving, log: Option<PlayLog>) -> Self {
        let waiting = thread::current();
        let n_felt = moving.core.felt_um().len();
        let target = Target::Port(port);
        let bridge = Bridge::open(target, profile, n_felt, move || waiting.unpark());
        if let Some(handle) = bridge.stop_handle() {
            stop_on_panic(handle);
        }
        Self {
            moving,
            bridge,
            log,
            started: None,
            last_tick: None,
            asked: None,
            n_frames: 0,
            n_missed: 0,
            n_bad_lines: 0,
            has_ended: false,
        }
    }

    /// Handshake, arming, and the path to its end or until `stop` is set.
    fn play(&mut self, stop: &AtomicBool) -> Result<(), CliError> {
        while !self.has_ended && !stop.load(Ordering::Relaxed) {
            self.asked = self.hear()?.or(self.asked);
            let now = Instant::now();
            match self.asked.take_if(|(_, due)| *due <= now) {
                Some((tick, _)) if self.bridge.state().takes_frames() => self.answer(tick)?,
                _ => thread::park_timeout(self.asked.map_or(NAP, |(_, due)| (due - now).min(NAP))),
            }
            match self.bridge.state() {
                BridgeState::Ready if self.started.is_none() => {
                    self.bridge.arm();
                }
                BridgeState::Faulted => {
                    let what = "the device has a fault and cannot be armed; switch it off and on";
                    return Err(CliError::Failed(self.of_target(what)));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Takes all news, and gives the last device tick that began, if one did, and when its answer
    /// is due.
    fn hear(&mut self) -> Result<Option<(u32, Instant)>, CliError> {
        let mut newest = None;
        loop {
            let was_opening = self.bridge.state() == BridgeState::Opening;
            match self.bridge.poll() {
                Some(BridgeEvent::Tick { tick, due, .. }) => newest = Some((tick, due)),
                // A port that cannot even be opened is the wrong one.
                Some(BridgeEvent::Lost(reason)) if was_opening => {
                    return Err(CliError::Input(self.of_target(&reason)));
                }
                Some(other) => self.heed(other)?,
                None => return Ok(newest),
            }
        }
    }

    /// A sentence of the device, with the port before it.
    fn of_target(&self, what: &str) -> String {
        let target = self.bridge.target();
        if what.starts_with(target) {
            what.to_owned()
        } else {
            format!("{target}: {what}")
        }
    }

    fn heed(&mut self, event: BridgeEvent) -> Result<(), CliError> {
        let describe = |what: &str| terminal::notice(&self.of_target(what));
        match event {
            BridgeEvent::Refused(reason)
            | BridgeEvent::Lost(reason)
            | BridgeEvent::Disarmed {
                by: DisarmedBy::Device,
                reason,
            } => return Err(CliError::Failed(self.of_target(&reason))),
            BridgeEvent::Connected(caps) => {
                if let Some(log) = &mut self.log {
                    log.set_link(self.bridge.link_scale());
                }
                if let Some(doubt) = array::doubt(self.moving.core.scene().profile(), &caps) {
                    terminal::notice(&self.of_target(&doubt));
                }
            }
            BridgeEvent::Fault(fault) => {
                let names = fault_bit::names(fault.faults);
                describe(&format!("the device reports a fault: {names}"));
            }
            BridgeEvent::DepthRaised(depth) => {
                let what = "frames came late: now sent";
                describe(&format!(
                    "{what} {depth} ticks ahead, felt more than 40 ms late"
                ));
            }
            BridgeEvent::Log(text) => describe(&format!("the device says: {text}")),
            BridgeEvent::Armed => self.started = Some(Instant::now()),
            _ => {}
        }
        Ok(())
    }

    /// Answers a device tick with the next tick of the path.
    fn answer(&mut self, tick: u32) -> Result<(), CliError> {
        let since = self.last_tick.map_or(1, |last| tick.wrapping_sub(last));
        self.last_tick = Some(tick);
        self.n_missed += u64::from(since.saturating_sub(1));
        let has_ended = &mut self.has_ended;
        self.moving.core.tick(Instant::now(), &mut |notice| {
            *has_ended |= matches!(notice, Notice::SourceEnded);
        });
        if self.has_ended {
            return Ok(());
        }
        let felt_um = self.moving.core.felt_um();
        if let Some(sent) = self.bridge.send(felt_um, self.moving.core.fresh_stamp()) {
            self.n_frames += 1;
            if let Some(log) = &mut self.log {
                log.frame(&sent, &self.moving.core.pose(), felt_um)?;
            }
        }
        self.moving.write_tick();
        self.describe_bad_lines();
        Ok(())
    }

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

    /// Tells the device to stop, if it plays, and waits for its answer.
    fn stop(&mut self) -> Result<(), CliError> {
        if !self.bridge.state().is_live() {
            return Ok(());
        }
        self.bridge.stop(StopHow::Ramp);
        let deadline = Instant::now() + STOP_PATIENCE;
        while self.bridge.state().is_live() {
            self.hear()?;
            if Instant::now() > deadline {
                let target = self.bridge.target();
                let what = "did not acknowledge the last STOP; switch its power off";
                return Err(CliError::Failed(format!("{target} {what}")));
            }
            thread::park_timeout(NAP);
        }
        Ok(())
    }

    /// Ends the link and the log.
    fn close(self) -> Result<PlayReport, CliError> {
        let report = PlayReport {
            target: self.bridge.target().to_owned(),
            duration: self
                .started
                .map_or(Duration::ZERO, |started| started.elapsed()),
            n_frames: self.n_frames,
            n_missed: self.n_missed,
            n_bad_lines: self.n_bad_lines,
            input: (self.moving.core.input_rate(), self.moving.core.losses()),
            counters: self.bridge.counters(),
            timings: self.bridge.timings(),
        };
        let closed: Result<(), BridgeError> = self.bridge.close(STOP_PATIENCE);
        if let Some(log) = self.log {
            log.finish()?;
        }
        closed?;
        Ok(report)
    }
}
