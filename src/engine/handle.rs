//! The handle on the engine: commands in, snapshots and notices out.
//!
//! It belongs to the window or to a command line. It prepares what commands need, and drops what
//! they replaced; the engine's thread does neither.

mod array;
mod body;
mod device;

use std::fmt;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use rtrb::{Consumer, Producer, RingBuffer};
use triple_buffer::Output;

use super::input::{Control, playable};
use super::ready::{CoreCommand, MAX_RETIRED, NextScene, ReadyCommand, Retired};
use super::recording::recording;
use super::runner::{Channels, Clock, NoticeRing, Runner};
use super::sequence::Sequence;
use super::snapshot_summary::Waker;
use super::tick_sample::{SampledTick, TickSampler, TickSamples};
use super::{
    Command, EngineCore, EngineError, Notice, PointerSender, PreparedScene, Recording, Snapshot,
    StopSwitch, TickSample,
};
use array::DrivenArray;
use body::Body;
use device::DeviceHandle;
use selvedge_device::{ActuatorWatch, ArrayProfile, SessionLog};

/// Commands on the way.
const MAX_COMMANDS: usize = 64;
/// Notices on the way.
const MAX_NOTICES: usize = 256;

/// What an engine starts with.
pub struct EngineConfig {
    /// The scene to feel.
    pub scene: PreparedScene,
    /// Called on a thread of its own when a snapshot shows something new or a notice came.
    pub on_news: Option<Box<dyn Fn() + Send>>,
}

/// A running engine. Dropping it stops the device and ends the thread.
pub struct Engine {
    body: Body,
    commands: Producer<ReadyCommand>,
    commands_sent: u64,
    retired: Consumer<Retired>,
    notices: Consumer<Notice>,
    samples: TickSamples,
    snapshots: Output<Snapshot>,
    /// Channels of scenes that are on their way, oldest first.
    coming: Vec<Output<Snapshot>>,
    switch: StopSwitch,
    pointer: Option<PointerSender>,
    news: Option<JoinHandle<()>>,
    driven: DrivenArray,
    device: DeviceHandle,
}

impl Engine {
    /// Starts an engine on a thread of its own, ticking at once.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn start(config: EngineConfig) -> Result<Self, EngineError> {
        let mut engine = Self::without_thread(config, Instant::now())?;
        if let Body::Still(mut runner) = std::mem::replace(&mut engine.body, Body::Thread(None)) {
            runner.clock = Clock::Real;
            let builder = thread::Builder::new().name("selvedge-engine".to_owned());
            let joined = builder
                .spawn(move || runner.run())
                .map_err(EngineError::Thread)?;
            engine.switch.set_engine(joined.thread().clone());
            engine.body = Body::Thread(Some(joined));
        }
        Ok(engine)
    }

    /// An engine that only moves when it is told to, from `start` on: the same every time.
    ///
    /// # Errors
    /// The system gives no thread for the news.
    pub fn without_thread(config: EngineConfig, start: Instant) -> Result<Self, EngineError> {
        let scene = Box::new(config.scene);
        let driven = DrivenArray::of(&scene);
        let (snapshots_in, snapshots) = triple_buffer::triple_buffer(&scene.first_snapshot());
        let (commands, commands_out) = RingBuffer::new(MAX_COMMANDS);
        // One more than a command needs, for a stop that comes right after it.
        let (retired_in, retired) = RingBuffer::new(2 * MAX_RETIRED);
        let (notices_in, notices) = RingBuffer::new(MAX_NOTICES);
        let (sampler, samples) = TickSampler::new();
        let channels = Channels {
            commands: commands_out,
            retired: retired_in,
            notices: NoticeRing::new(notices_in),
            snapshots: snapshots_in,
            sampler,
            tap: None,
            sound: None,
        };
        let (waker, news) = match config.on_news {
            Some(listener) => {
                let (waker, joined) = Waker::start(listener)?;
                (waker, Some(joined))
            }
            None => (Waker::default(), None),
        };
        let switch = StopSwitch::default();
        let (core, pointer) = EngineCore::new(scene);
        let runner = Runner::new(core, channels, switch.clone(), Clock::Told(start), waker);
        Ok(Self {
            body: Body::Still(Box::new(runner)),
            commands,
            commands_sent: 0,
            retired,
            notices,
            samples,
            snapshots,
            coming: Vec::new(),
            switch,
            pointer: Some(pointer),
            news,
            driven,
            device: DeviceHandle::default(),
        })
    }

    /// Tells an engine without a thread what time it is; it does one step. A running one is left
    /// alone.
    pub fn advance(&mut self, now: Instant) {
        self.step_uncollected(now);
        self.collect();
    }

    /// As [`advance`](Self::advance), but leaves what was replaced and recorded where it is until
    /// the next call: all that this does is what the engine's thread would do.
    pub fn step_uncollected(&mut self, now: Instant) {
        if let Body::Still(runner) = &mut self.body {
            runner.clock = Clock::Told(now);
            runner.step();
        }
    }

    /// Lets an engine without a thread do `n_ticks` ticks, 25 ms apart, and returns its time. A
    /// running one is left alone.
    pub fn advance_ticks(&mut self, n_ticks: u64) -> Option<Instant> {
        for _ in 0..n_ticks {
            if let Body::Still(runner) = &mut self.body {
                runner.clock = Clock::Told(runner.next_due());
                runner.step();
            }
            self.collect();
        }
        self.body.told()
    }

    /// Lets emulated devices that are connected from now on live in the time that an engine
    /// without a thread is told, too: the same every time.
    pub fn step_emulators(&mut self) {
        self.device.is_stepped = true;
    }

    /// Sends a command. It takes effect at the next tick; a stop takes effect at once.
    ///
    /// # Errors
    /// The queue is full, a stroke makes no sense, or the system gives no thread for a stream of
    /// lines. Nothing happened then.
    pub fn send(&mut self, command: Command) -> Result<(), EngineError> {
        self.collect();
        if self.commands.is_full() && !matches!(command, Command::StopAll) {
            return Err(EngineError::Busy);
        }
        let command = match command {
            Command::SetScene(scene) => self.ready_scene(scene, false),
            Command::UpdateScene(scene) => self.ready_scene(scene, true),
            Command::SetArray(array) => self.driven.choose(array),
            Command::Identify(is_begun) => ReadyCommand::Identify(is_begun),
            Command::IdentifyChannel {
                channel,
                amplitude_um,
                duration_ms,
            } => ReadyCommand::IdentifyChannel {
                channel,
                how: (amplitude_um, duration_ms),
            },
            Command::SetSource(source) => CoreCommand::Source(playable(source)?).into(),
            Command::Connect(target) => self.connect(0, target)?,
            Command::ConnectSecond(target) => self.connect(1, target)?,
            Command::Disconnect => self.disconnect(0),
            Command::DisconnectSecond => self.disconnect(1),
            Command::Arm => ReadyCommand::Arm {
                presses: self.switch.presses(),
            },
            Command::StopAll => {
                self.switch.press();
                return Ok(());
            }
            Command::SetTuning(tuning) => CoreCommand::gains(tuning, Vec::new()).into(),
            Command::SetGains {
                tuning,
                textiles_db,
            } => CoreCommand::gains(tuning, textiles_db).into(),
            Command::SetLevels(levels) => CoreCommand::Levels(levels).into(),
            Command::SetContactorMask(mask) => CoreCommand::Mask(mask).into(),
            Command::PlaySequence(steps) => CoreCommand::PlaySequence(Sequence::of(steps)).into(),
            Command::SetCloth(cloth) => CoreCommand::Cloth(cloth).into(),
            Command::SetStylus(stylus) => CoreCommand::Stylus(stylus).into(),
            Command::SetAngle(angle_deg) => ReadyCommand::Core(CoreCommand::Angle(angle_deg)),
            Command::TurnBy(by_deg) => ReadyCommand::Core(CoreCommand::Turn(by_deg)),
            Command::Play => ReadyCommand::control(Control::Play),
            Command::Pause => ReadyCommand::control(Control::Pause),
            Command::Step => ReadyCommand::control(Control::Step),
            Command::Rewind => ReadyCommand::control(Control::Rewind),
            Command::Seek(tick) => ReadyCommand::control(Control::Seek(tick)),
            Command::SetLoop(does_loop) => ReadyCommand::control(Control::Loop(does_loop)),
            Command::LoopWithin(ticks) => ReadyCommand::control(Control::LoopWithin(ticks)),
            Command::StopRecording => ReadyCommand::Core(CoreCommand::EndRecording),
            Command::Disarm => ReadyCommand::Disarm,
            Command::Resume => ReadyCommand::Resume,
            Command::ClearFaults => ReadyCommand::ClearFaults,
            Command::SampleTicks(is_heard) => ReadyCommand::SampleTicks(is_heard),
            Command::Watch(contactor) => ReadyCommand::Watch(contactor),
            Command::WatchDisplay(display) => ReadyCommand::WatchDisplay(display),
            Command::SetTap(tap) => ReadyCommand::Tap(tap),
            Command::SetSound(feed) => ReadyCommand::Sound(feed),
            Command::Shutdown => ReadyCommand::Shutdown,
        };
        self.push(command)
    }

    /// The latest snapshot.
    pub fn snapshot(&mut self) -> &Snapshot {
        self.collect();
        if let Some(newest) = self.coming.iter().rposition(Output::updated) {
            // Those before it will not be written to any more.
            self.snapshots = self.coming.swap_remove(newest);
            self.coming.drain(..newest);
        }
        self.snapshots.read()
    }

    /// Commands that were sent, but for stops. A snapshot whose
    /// [`commands_obeyed`](super::EngineCounters::commands_obeyed) is less does not show all of
    /// them yet.
    pub fn commands_sent(&self) -> u64 {
        self.commands_sent
    }

    /// The oldest notice that was not taken yet.
    pub fn next_notice(&mut self) -> Option<Notice> {
        self.notices.pop().ok()
    }

    /// The oldest sample that was not taken yet, of those left since
    /// [`Command::SampleTicks`] asked for them.
    pub fn next_tick_sample(&mut self) -> Option<TickSample> {
        self.next_felt_tick().map(|(sample, ..)| sample)
    }

    /// The same with the amplitudes [A40, A320] of the contactors of all displays one after the
    /// other, after gains and before output limits, µm, and the poses of all displays, none where
    /// there is one.
    pub fn next_felt_tick(&mut self) -> Option<SampledTick<'_>> {
        self.samples.next()
    }

    /// The end of the ring for live samples; there is one.
    pub fn take_pointer(&mut self) -> Option<PointerSender> {
        self.pointer.take()
    }

    /// The switch that stops everything, for Esc, signals and other threads.
    pub fn stop_switch(&self) -> StopSwitch {
        self.switch.clone()
    }

    /// Begins to record the exploration from the next tick on, whether it is felt or only shown. A
    /// recording that runs ends.
    ///
    /// # Errors
    /// The queue of commands is full; nothing happened then.
    pub fn record(&mut self) -> Result<Recording, EngineError> {
        self.collect();
        let (recorder, recording) = recording([self.driven.n_others, self.driven.n_contactors]);
        self.push(ReadyCommand::Core(CoreCommand::Record(Box::new(recorder))))?;
        Ok(recording)
    }

    /// The array profile in force for the scene's first display: the one that was set last, or the
    /// scene's own.
    pub fn profile(&self) -> &ArrayProfile {
        &self.driven.profile
    }

    /// A look at the contactors of the emulator that was connected last; `None` of other devices.
    pub fn actuators(&mut self) -> Option<&mut ActuatorWatch> {
        self.device.actuators.as_mut()
    }

    /// Writes what happens on every link that is opened from now on to a log.
    pub fn log_links_to(&mut self, log: SessionLog) {
        self.device.session_log = Some(log);
    }

    /// Says in the log of every link, of this one and of those to come, what is felt: `name` with
    /// its unit or kind. The last value of a name holds.
    pub fn say_what(&mut self, name: &'static str, value: String) {
        self.device.say(name, value);
    }

    /// The log that links are written to.
    pub fn session_log(&self) -> Option<&SessionLog> {
        self.device.session_log.as_ref()
    }

    /// Whether the engine's thread is still there; an engine without one always is.
    pub fn is_running(&self) -> bool {
        self.body.is_running()
    }

    pub(super) fn push(&mut self, command: ReadyCommand) -> Result<(), EngineError> {
        self.commands
            .push(command)
            .map_err(|_full| EngineError::Busy)?;
        self.commands_sent += 1;
        self.switch.wake_engine();
        Ok(())
    }

    /// Another scene, with a channel for snapshots of its size.
    fn ready_scene(&mut self, mut scene: Box<PreparedScene>, is_edited: bool) -> ReadyCommand {
        let are_others = self.driven.follow(&mut scene);
        for (display, _) in (0..).zip(are_others).filter(|(_, is_other)| *is_other) {
            self.switch.set_device(display, None);
        }
        let (input, output) = triple_buffer::triple_buffer(&scene.first_snapshot());
        self.coming.push(output);
        ReadyCommand::Scene(NextScene { scene, is_edited }, input)
    }

    /// Takes what came back.
    fn collect(&mut self) {
        while let Ok(retired) = self.retired.pop() {
            drop(retired);
        }
        // Commands may have waited for room among the retired.
        if self.commands.slots() < MAX_COMMANDS {
            self.switch.wake_engine();
        }
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        self.switch.press();
        if let Body::Thread(Some(joined)) = std::mem::replace(&mut self.body, Body::Thread(None)) {
            while !joined.is_finished() {
                self.collect();
                // A full queue is emptied by and by; the thread is never waited for in vain.
                drop(self.push(ReadyCommand::Shutdown));
                joined.thread().unpark();
                thread::sleep(Duration::from_millis(1));
            }
            // A thread that panicked has stopped its device already.
            drop(joined.join());
        }
        self.collect();
        if let Some(news) = self.news.take() {
            drop(news.join());
        }
    }
}

impl fmt::Debug for Engine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Engine")
            .field("is_running", &self.is_running())
            .finish_non_exhaustive()
    }
}

impl fmt::Debug for EngineConfig {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("EngineConfig")
            .field("scene", &self.scene)
            .finish_non_exhaustive()
    }
}
