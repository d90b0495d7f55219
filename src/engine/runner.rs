//! The engine's loop: stops first, then commands, then the device, then a tick if one is due.
//!
//! One step never waits; how long to sleep until the next is its answer. The clock is either the
//! real one or one that is told, which makes a run repeatable.

mod devices;

use std::thread;
use std::time::{Duration, Instant};

use rtrb::{Consumer, Producer};
use triple_buffer::Input;

use super::link::Link;
use super::meters::{DurationHistogram, RecentMedian};
use super::ready::{CoreCommand, MAX_RETIRED, NextArray, NextScene, ReadyCommand, Retired};
use super::snapshot_summary::{SnapshotSummary, Waker};
use super::tick_sample::TickSampler;
use super::{ClockView, EngineCore, Notice, Snapshot, SoundFeed, StopSwitch, Tap};
use selvedge_device::{BridgeEvent, SentFrame, StopHow};

/// A tick that begins later than this after it was due is late.
const LATE: Duration = Duration::from_millis(1);
/// A device wants to be listened to at least this often.
const LONGEST_NAP: Duration = Duration::from_millis(50);

/// Where the time comes from.
#[derive(Debug, Clone, Copy)]
pub(super) enum Clock {
    /// The system.
    Real,
    /// Whoever drives the engine.
    Told(Instant),
}

impl Clock {
    pub(super) fn now(self) -> Instant {
        match self {
            Self::Real => Instant::now(),
            Self::Told(now) => now,
        }
    }
}

/// The rings that a runner reads and writes.
pub(super) struct Channels {
    pub(super) commands: Consumer<ReadyCommand>,
    pub(super) retired: Producer<Retired>,
    pub(super) notices: NoticeRing,
    pub(super) snapshots: Input<Snapshot>,
    pub(super) sampler: TickSampler,
    /// Whom to tell what is felt.
    pub(super) tap: Option<Box<Tap>>,
    /// What makes sound of it.
    pub(super) sound: Option<Box<SoundFeed>>,
}

/// Notices on their way to the handle; those that find no room are counted.
pub(super) struct NoticeRing {
    notices: Producer<Notice>,
    n_lost: u64,
}

impl NoticeRing {
    pub(super) fn new(notices: Producer<Notice>) -> Self {
        Self { notices, n_lost: 0 }
    }

    fn push(&mut self, notice: Notice) {
        self.n_lost += u64::from(self.notices.push(notice).is_err());
    }
}

/// Everything that the engine's thread owns.
pub(super) struct Runner {
    core: EngineCore,
    channels: Channels,
    switch: StopSwitch,
    presses_heard: u64,
    full_presses_heard: u64,
    /// Whether a device could move when it was looked at last.
    was_live: bool,
    pub(super) clock: Clock,
    link: Link,
    /// The device of the second display, which goes with the first: it is given the newest
    /// amplitudes at each of its own ticks, and never moves while the first may not.
    second: Link,
    lateness: DurationHistogram,
    late: u64,
    cost: RecentMedian,
    costs: DurationHistogram,
    commands_obeyed: u64,
    summary: SnapshotSummary,
    waker: Waker,
    is_over: bool,
}

impl Runner {
    pub(super) fn new(
        core: EngineCore,
        channels: Channels,
        switch: StopSwitch,
        clock: Clock,
        waker: Waker,
    ) -> Self {
        Self {
            core,
            channels,
            presses_heard: switch.presses(),
            full_presses_heard: switch.full_presses(),
            was_live: false,
            switch,
            clock,
            link: Link::new(clock.now()),
            second: Link::waiting(),
            lateness: DurationHistogram::default(),
            late: 0,
            cost: RecentMedian::new(),
            costs: DurationHistogram::default(),
            commands_obeyed: 0,
            summary: SnapshotSummary::default(),
            waker,
            is_over: false,
        }
    }

    /// Runs until it is told to end. Dropping what it owns stops the device, panic or not.
    pub(super) fn run(mut self) {
        while !self.is_over {
            let until = self.step();
            let nap = until.saturating_duration_since(self.clock.now());
            if !nap.is_zero() && !self.is_over {
                thread::park_timeout(nap.min(LONGEST_NAP));
            }
        }
    }

    /// Does what is due, and says when something will be due next.
    pub(super) fn step(&mut self) -> Instant {
        if let Clock::Told(now) = self.clock {
            self.link.tell(now);
            self.second.tell(now);
        }
        self.heed_stop();
        self.obey();
        if let Some(due) = self.turn() {
            self.tick(due);
        }
        self.turn_second();
        self.next_due()
    }

    /// When the next tick is due if no device tick comes first.
    pub(super) fn next_due(&self) -> Instant {
        let deadlines = [self.link.pacer.deadline(), self.second.pacer.deadline()];
        let deadline = deadlines.into_iter().flatten().min();
        deadline.unwrap_or_else(|| self.clock.now() + LONGEST_NAP)
    }

    /// Takes the news of the device, and says whether a tick is due, and since when.
    fn turn(&mut self) -> Option<Instant> {
        let (notices, mut is_other) = (&mut self.channels.notices, false);
        let due = self.link.turn(self.clock.now(), &mut |event| {
            match &event {
                BridgeEvent::Connected(_)
                | BridgeEvent::Ready(_)
                | BridgeEvent::Lost(_)
                | BridgeEvent::Refused(_) => is_other = true,
                BridgeEvent::Pong { .. } => return,
                _ => {}
            }
            notices.push(Notice::Bridge(event));
        });
        if is_other {
            self.core.set_link(self.link.scale());
        }
        due
    }

    fn tick(&mut self, due: Instant) {
        let started = self.clock.now();
        let notices = &mut self.channels.notices;
        self.core.tick(started, &mut |notice| notices.push(notice));
        // A stop that came while this tick was made must not be followed by its frame.
        self.heed_stop();
        let sent = self.send();
        let notices = &mut self.channels.notices;
        let felt = (sent, self.link.tally());
        let ended = self.core.record(felt, &mut |notice| notices.push(notice));
        self.retire(ended);
        let apply_tick = sent.map(|sent| sent.apply_tick);
        self.channels.sampler.look(&self.core, apply_tick);
        if let Some(tap) = &mut self.channels.tap {
            self.core.write_to(tap);
        }
        if let Some(feed) = &mut self.channels.sound {
            self.core.sound_to(feed);
        }
        let done = self.clock.now();
        self.late += u64::from(started.saturating_duration_since(due) > LATE);
        self.lateness.add(done.saturating_duration_since(due));
        self.cost.add(done.saturating_duration_since(started));
        if matches!(self.clock, Clock::Real) {
            self.costs.add(done.saturating_duration_since(started));
        }
        self.publish();
    }

    fn send(&mut self) -> Option<SentFrame> {
        self.link.send(self.core.felt_um(), self.core.fresh_stamp())
    }

    /// Stops everything if the switch was pressed since it was last looked at; where no device
    /// could move, the screen goes on unless it is to be silent too.
    fn heed_stop(&mut self) {
        let presses = self.switch.presses();
        if presses == self.presses_heard {
            return;
        }
        self.presses_heard = presses;
        let full_presses = self.switch.full_presses();
        let is_full = std::mem::replace(&mut self.full_presses_heard, full_presses) != full_presses;
        let is_everything = is_full || self.was_live || self.link.is_live();
        self.link.stop(StopHow::Now);
        self.second.stop(StopHow::Now);
        if is_everything {
            let retired = self.core.stop();
            self.retire(retired);
            self.say(Notice::Stopped);
        }
        self.publish();
    }

    /// Obeys commands while what they replace finds room.
    fn obey(&mut self) {
        while self.channels.retired.slots() >= MAX_RETIRED {
            let Ok(command) = self.channels.commands.pop() else {
                return;
            };
            self.commands_obeyed += 1;
            match command {
                ReadyCommand::Core(command) => self.obey_core(command),
                ReadyCommand::Scene(next, snapshots) => self.set_scene(next, snapshots),
                ReadyCommand::Connect(display, bridge) => self.connect(display, bridge),
                ReadyCommand::Array(array) => self.set_array(array),
                ReadyCommand::Identify(is_begun) => self.link.identify(is_begun),
                ReadyCommand::IdentifyChannel { channel, how } => {
                    self.identify_channel(channel, how);
                }
                ReadyCommand::Arm { presses } => self.arm(presses),
                ReadyCommand::Disarm => {
                    self.link.stop(StopHow::Ramp);
                    self.second.stop(StopHow::Ramp);
                }
                ReadyCommand::Resume => self.core.resume(),
                ReadyCommand::ClearFaults => {
                    self.link.clear_faults();
                    self.second.clear_faults();
                }
                ReadyCommand::SampleTicks(is_heard) => self.channels.sampler.listen(is_heard),
                ReadyCommand::Watch(contactor) => self.channels.sampler.watch(contactor),
                ReadyCommand::WatchDisplay(nth) => self.channels.sampler.watch_display(nth),
                ReadyCommand::Tap(tap) => {
                    let last = std::mem::replace(&mut self.channels.tap, tap);
                    self.retire(last.map(Retired::Tap));
                }
                ReadyCommand::Sound(feed) => {
                    let last = std::mem::replace(&mut self.channels.sound, feed);
                    self.retire(last.map(Retired::Sound));
                }
                ReadyCommand::Shutdown => {
                    self.link.stop(StopHow::Now);
                    self.second.stop(StopHow::Now);
                    self.is_over = true;
                }
            }
        }
    }

    fn obey_core(&mut self, command: CoreCommand) {
        let notices = &mut self.channels.notices;
        let mut say = |notice| notices.push(notice);
        for retired in self.core.obey(command, &mut say) {
            self.retire(retired);
        }
    }

    fn set_scene(&mut self, mut next: NextScene, snapshots: Input<Snapshot>) {
        for (display, link) in [self.link.is_some(), self.second.is_some()]
            .into_iter()
            .enumerate()
        {
            let [before, after] = [self.core.scene(), &*next.scene];
            if link && before.n_felt_of(display) != after.n_felt_of(display) {
                self.connect(display, None);
                self.say(Notice::DisplayChanged);
            }
        }
        next.scene.set_link(self.link.scale());
        self.obey_core(CoreCommand::Scene(next));
        let old = std::mem::replace(&mut self.channels.snapshots, snapshots);
        self.retire(Some(Retired::Snapshots(old)));
        self.publish();
    }

    fn set_array(&mut self, mut array: Box<NextArray>) {
        // Either refuses only what the other would: both may move, or neither.
        if self.link.set_array(&mut array.change) && self.second.set_array(&mut array.second) {
            self.core.exchange_coder(&mut array.coder);
        } else {
            self.say(Notice::ArrayWaits);
        }
        self.retire(Some(Retired::Array(array)));
    }

    fn identify_channel(&mut self, channel: u16, how: (f32, u16)) {
        if let Err(why) = self.link.identify_channel(channel, how) {
            self.say(Notice::Refused(why));
        }
    }

    /// Writes a snapshot and wakes the window if it shows something new.
    fn publish(&mut self) {
        let until_felt = self.link.until_felt();
        let (tick_samples_lost, notices_lost) =
            (self.channels.sampler.n_lost(), self.channels.notices.n_lost);
        let snapshot = self.channels.snapshots.input_buffer_mut();
        self.core.fill(snapshot, until_felt);
        snapshot.counters.notices_lost = notices_lost;
        snapshot.counters.tick_samples_lost = tick_samples_lost;
        snapshot.counters.commands_obeyed = self.commands_obeyed;
        snapshot.counters.frames_unheard = self.link.n_unheard();
        let pacer = &self.link.pacer;
        snapshot.clock = ClockView {
            is_device_paced: pacer.is_device_paced(),
            late: self.late,
            missed: pacer.missed(),
            fallbacks: pacer.fallbacks(),
            lateness: self.lateness.spread(),
            cost_ns: self.cost.median_ns(),
            costs: self.costs,
        };
        snapshot.link = self.link.view();
        snapshot.second_link = self.second.view();
        self.was_live = self.link.is_live();
        let summary = SnapshotSummary::of(snapshot);
        self.channels.snapshots.publish();
        if summary != self.summary {
            self.summary = summary;
            self.waker.wake();
        }
    }

    fn say(&mut self, notice: Notice) {
        self.channels.notices.push(notice);
        self.waker.wake();
    }

    /// There is room: commands are only obeyed while there is, and a stop retires one thing.
    fn retire(&mut self, retired: Option<Retired>) {
        if let Some(retired) = retired {
            drop(self.channels.retired.push(retired));
        }
    }
}
