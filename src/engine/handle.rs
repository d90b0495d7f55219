//! The handle on the engine: commands in, snapshots, notices and recordings out.
//!
//! It belongs to the window or to a command line. It prepares what commands need, and drops what
//! they replaced; the engine's thread does neither.

mod device;
mod scene;

use std::fmt;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use rtrb::{Consumer, Producer, RingBuffer};
use triple_buffer::Output;

use super::gist::Waker;
use super::glimpse::{Glimpser, MOST_GLIMPSES};
use super::input::{Control, PointerInput, ReplayInput, StrokeInput, start_lines};
use super::order::{CoreOrder, MOST_RETIRED, NextScene, Order, Retired};
use super::recording::recording;
use super::runner::{Channels, Clock, NoticeRing, Runner};
use super::vibration::Vibration;
use super::{
    Command, EngineCore, EngineError, Glimpse, InputSource, Notice, PointerSender, PreparedScene,
    Recording, Snapshot, StopSwitch,
};
use selvedge_device::{ArrayProfile, PlantWatch, SessionLog};

/// Commands on the way.
const MOST_ORDERS: usize = 64;
/// Notices on the way.
const MOST_NOTICES: usize = 256;

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
    orders: Producer<Order>,
    commands_sent: u64,
    retired: Consumer<Retired>,
    notices: Consumer<Notice>,
    glimpses: Consumer<Glimpse>,
    snapshots: Output<Snapshot>,
    /// Channels of scenes that are on their way, oldest first.
    coming: Vec<Output<Snapshot>>,
    switch: StopSwitch,
    pointer: Option<PointerSender>,
    recording: Option<Recording>,
    news: Option<JoinHandle<()>>,
    n_contactors: usize,
    n_felt: usize,
    profile: ArrayProfile,
    plant: Option<PlantWatch>,
    pub(super) session_log: Option<SessionLog>,
    /// The scene's own.
    scene_profile: ArrayProfile,
    /// The one that was chosen instead.
    array: Option<Box<ArrayProfile>>,
}

enum Body {
    /// A thread that keeps the real time.
    Thread(Option<JoinHandle<()>>),
    /// Stepped by its owner.
    Still(Box<Runner>),
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
        let (n_contactors, n_felt) = (scene.n_contactors(), scene.n_felt());
        let profile = scene.profile().clone();
        let (snapshots_in, snapshots) = triple_buffer::triple_buffer(&Snapshot::of(&scene));
        let (orders, orders_out) = RingBuffer::new(MOST_ORDERS);
        // One more than an order needs, for a stop that comes right after it.
        let (retired_in, retired) = RingBuffer::new(2 * MOST_RETIRED);
        let (notices_in, notices) = RingBuffer::new(MOST_NOTICES);
        let (glimpses_in, glimpses) = RingBuffer::new(MOST_GLIMPSES);
        let channels = Channels {
            orders: orders_out,
            retired: retired_in,
            notices: NoticeRing::new(notices_in),
            snapshots: snapshots_in,
            glimpser: Glimpser::new(glimpses_in),
            tap: None,
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
            orders,
            commands_sent: 0,
            retired,
            notices,
            glimpses,
            snapshots,
            coming: Vec::new(),
            switch,
            session_log: None,
            pointer: Some(pointer),
            recording: None,
            news,
            n_contactors,
            n_felt,
            scene_profile: profile.clone(),
            profile,
            plant: None,
            array: None,
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
        match &self.body {
            Body::Still(runner) => Some(runner.clock.now()),
            Body::Thread(_) => None,
        }
    }

    /// Sends a command. It takes effect at the next tick; a stop takes effect at once.
    ///
    /// # Errors
    /// The queue is full, a stroke makes no sense, or the system gives no thread for a stream of
    /// lines. Nothing happened then.
    pub fn send(&mut self, command: Command) -> Result<(), EngineError> {
        self.collect();
        if self.orders.is_full() && !matches!(command, Command::StopAll) {
            return Err(EngineError::Busy);
        }
        let order = match command {
            Command::SetScene(scene) => self.scene_order(NextScene::Other(scene)),
            Command::UpdateScene(scene) => self.scene_order(NextScene::Edited(scene)),
            Command::SetArray(array) => self.array_order(array),
            Command::Identify(is_begun) => Order::Identify(is_begun),
            Command::IdentifyChannel {
                channel,
                amplitude_um,
                duration_ms,
            } => Order::IdentifyChannel {
                channel,
                how: (amplitude_um, duration_ms),
            },
            Command::SetSource(source) => Order::Core(CoreOrder::Source(playable(source)?)),
            Command::Connect(target) => self.connect_order(target),
            Command::Disconnect => {
                self.switch.set_device(None);
                self.plant = None;
                Order::Disconnect
            }
            Command::Arm => Order::Arm {
                presses: self.switch.presses(),
            },
            Command::StopAll => {
                self.switch.press();
                return Ok(());
            }
            Command::StartRecording => self.recording_order(),
            Command::SetTuning(tuning) => Order::Core(CoreOrder::Tuning(tuning)),
            Command::SetTextileGain { textile, gain_db } => {
                Order::Core(CoreOrder::TextileGain { textile, gain_db })
            }
            Command::SetLevels(levels) => Order::Core(CoreOrder::Levels(levels)),
            Command::SetContactorMask(mask) => Order::Core(CoreOrder::Mask(mask)),
            Command::Vibrate(steps) => Order::Core(CoreOrder::Vibrate(Vibration::of(steps))),
            Command::SetVelocityMethod(method) => Order::Core(CoreOrder::Velocity(method)),
            Command::SetAngle(angle_deg) => Order::Core(CoreOrder::Angle(angle_deg)),
            Command::TurnBy(by_deg) => Order::Core(CoreOrder::Turn(by_deg)),
            Command::Play => Order::control(Control::Play),
            Command::Pause => Order::control(Control::Pause),
            Command::Step => Order::control(Control::Step),
            Command::Rewind => Order::control(Control::Rewind),
            Command::Seek(tick) => Order::control(Control::Seek(tick)),
            Command::SetLoop(does_loop) => Order::control(Control::Loop(does_loop)),
            Command::StopRecording => Order::Core(CoreOrder::EndRecording),
            Command::Disarm => Order::Disarm,
            Command::ClearFaults => Order::ClearFaults,
            Command::Glimpses(is_heard) => Order::Glimpses(is_heard),
            Command::Watch(contactor) => Order::Watch(contactor),
            Command::SetTap(tap) => Order::Tap(tap),
            Command::Shutdown => Order::Shutdown,
        };
        self.push(order)
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

    /// The oldest glimpse that was not taken yet, of those left since
    /// [`Command::Glimpses`] asked for them.
    pub fn next_glimpse(&mut self) -> Option<Glimpse> {
        self.glimpses.pop().ok()
    }

    /// The end of the ring for live samples; there is one.
    pub fn take_pointer(&mut self) -> Option<PointerSender> {
        self.pointer.take()
    }

    /// The switch that stops everything, for Esc, signals and other threads.
    pub fn stop_switch(&self) -> StopSwitch {
        self.switch.clone()
    }

    /// The recording as far as it was collected. Call this or [`snapshot`](Self::snapshot) every
    /// few seconds while one runs: the engine has room for thirty.
    pub fn recording(&mut self) -> Option<&Recording> {
        self.collect();
        self.recording.as_ref()
    }

    /// Takes the recording, if it has ended.
    pub fn take_recording(&mut self) -> Option<Recording> {
        self.collect();
        self.recording.take_if(|recording| recording.has_ended())
    }

    /// The array profile in force for the scene's first display: the one that was set last, or the
    /// scene's own.
    pub fn profile(&self) -> &ArrayProfile {
        &self.profile
    }

    /// Whether the engine's thread is still there; an engine without one always is.
    pub fn is_running(&self) -> bool {
        match &self.body {
            Body::Thread(joined) => joined.as_ref().is_some_and(|joined| !joined.is_finished()),
            Body::Still(_) => true,
        }
    }

    pub(super) fn push(&mut self, order: Order) -> Result<(), EngineError> {
        self.orders.push(order).map_err(|_full| EngineError::Busy)?;
        self.commands_sent += 1;
        self.switch.wake_engine();
        Ok(())
    }

    fn recording_order(&mut self) -> Order {
        let (recorder, recording) = recording(self.n_contactors);
        self.recording = Some(recording);
        Order::Core(CoreOrder::Record(Box::new(recorder)))
    }

    /// Takes what came back.
    fn collect(&mut self) {
        if let Some(recording) = &mut self.recording {
            recording.collect();
        }
        while let Ok(retired) = self.retired.pop() {
            if let (Retired::Recorder(recorder), Some(recording)) = (&retired, &mut self.recording)
                && recording.is_of(recorder)
            {
                recording.end();
            }
        }
        // Orders may have waited for room among the retired.
        if self.orders.slots() < MOST_ORDERS {
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
                drop(self.push(Order::Shutdown));
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

/// A source as the engine polls it; `None` for live samples.
pub(super) fn playable(source: InputSource) -> Result<Option<Box<dyn PointerInput>>, EngineError> {
    Ok(match source {
        InputSource::Pointer => None,
        InputSource::Replay(path) => Some(Box::new(ReplayInput::new(path))),
        InputSource::Stroke(stroke) => {
            stroke.check()?;
            Some(Box::new(StrokeInput::new(stroke)))
        }
        InputSource::Lines(lines) => Some(Box::new(start_lines(lines)?)),
        InputSource::Live(input) => Some(input),
    })
}
