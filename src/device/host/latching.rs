//! Late latching: how long before a tick of the device its frame is made, and for how many ticks
//! ahead.
//!
//! A frame must be accepted before its tick begins, and the later it is made the younger is what it
//! tells. The time it takes (render, write, link) is measured on every frame: the device says how
//! old the last accepted frame was at the start of a tick. From the 99.9th percentile of these
//! delays and a margin follows the *lead*: how long before the tick the work begins. It starts at
//! whole ticks (a frame is made as soon as the tick before begins), shrinks slowly as evidence
//! comes, and grows at once when a frame comes too late. When even whole ticks do not suffice,
//! frames are sent one tick further ahead, and nearer again after a long clean time.
//!
//! Pure and deterministic: it is told what happened and when.

use std::time::{Duration, Instant};

use super::clock::TICK;

/// What is added to the 99.9th percentile of the delays.
const MARGIN: Duration = Duration::from_millis(3);
/// Frames measured before the lead begins to shrink: a second.
const FEW: u32 = 40;
/// Frames that a 99.9th percentile needs; until then a reserve is added that shrinks to nothing.
const ENOUGH: u32 = 1000;
const RESERVE: Duration = Duration::from_millis(5);
/// How fast the lead shrinks: 4 ms a second.
const STEP: Duration = Duration::from_micros(100);
/// Frames to a generation of evidence: a minute. The last two generations count.
const GENERATION: u32 = 2400;
/// No lead grows shorter for so long after a frame came late.
const CALM: Duration = Duration::from_secs(10);
/// The depth rises at most once in so long.
const RESTED: Duration = Duration::from_secs(10);
/// How long nothing may come late before frames are sent less far ahead, and before the delay of a
/// late frame is forgotten.
const CLEAN: Duration = Duration::from_mins(1);
/// A frame is never held back longer than to this long before the next tick announces itself.
const ELBOW_ROOM: Duration = Duration::from_millis(5);
const DEEPEST: u8 = 3;

const BIN: Duration = Duration::from_micros(250);
const N_BINS: usize = 400;

/// How often each delay was met, in bins of 0.25 ms to 100 ms.
#[derive(Clone, Debug)]
struct Delays {
    counts: [u32; N_BINS],
    n: u32,
}

impl Delays {
    const EMPTY: Self = Self {
        counts: [0; N_BINS],
        n: 0,
    };

    fn add(&mut self, delay: Duration) {
        let bin = usize::try_from(delay.as_micros() / BIN.as_micros()).unwrap_or(N_BINS);
        self.counts[bin.min(N_BINS - 1)] += 1;
        self.n += 1;
    }
}

/// What became of the depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Deepened {
    No,
    Raised,
    Lowered,
}

/// Chooses lead and depth.
#[derive(Clone, Debug)]
pub(super) struct Latching {
    depth: u8,
    deepest: u8,
    lead: Duration,
    /// This minute's delays, and the last one's.
    delays: [Delays; 2],
    last_trouble: Option<Instant>,
    last_late: Option<Instant>,
    changed: Option<Instant>,
    /// The longest that news of a tick took, forgotten slowly.
    news: Duration,
    /// When the lead last grew to whole ticks because something went wrong.
    grew: Option<Instant>,
    last_delay: Duration,
    /// The longest delay of frames that came late, until none did for a minute: it counts as one
    /// that comes often.
    worst: Duration,
}

impl Latching {
    pub(super) fn new() -> Self {
        Self {
            depth: 1,
            deepest: DEEPEST,
            lead: TICK,
            delays: [Delays::EMPTY; 2],
            last_trouble: None,
            last_late: None,
            changed: None,
            news: Duration::ZERO,
            grew: None,
            last_delay: Duration::ZERO,
            worst: Duration::ZERO,
        }
    }

    /// The device holds this many frames.
    pub(super) fn set_queue(&mut self, queue: u8) {
        self.deepest = queue.clamp(1, DEEPEST);
    }

    /// Ticks that frames are sent ahead, 1…3.
    pub(super) fn depth(&self) -> u8 {
        self.depth
    }

    /// From the moment a frame is due to the start of the tick in which it is felt.
    pub(super) fn lead(&self) -> Duration {
        self.lead
    }

    /// The 99.9th percentile of the delays and how many were measured; zero before the first.
    pub(super) fn delay(&self) -> (Duration, u32) {
        let n = self.n();
        let mut above = n / ENOUGH;
        for bin in (0..N_BINS).rev() {
            let count: u32 = self.delays.iter().map(|delays| delays.counts[bin]).sum();
            if count > above {
                let edge = u32::try_from(bin + 1).unwrap_or(u32::MAX);
                return (BIN * edge, n);
            }
            above -= count;
        }
        (Duration::ZERO, 0)
    }

    /// When the answer to the tick that began at `tick_start` is due; never before its STATUS
    /// arrived.
    pub(super) fn due(&self, tick_start: Instant, received: Instant) -> Instant {
        let held = (TICK * u32::from(self.depth)).saturating_sub(self.lead);
        (tick_start + held).max(received)
    }

    /// A frame was accepted so long after it was due.
    pub(super) fn accepted(&mut self, delay: Duration) {
        if self.delays[0].n >= GENERATION {
            self.delays.swap(0, 1);
            self.delays[0] = Delays::EMPTY;
        }
        self.delays[0].add(delay);
        self.last_delay = delay;
    }

    /// What was measured means nothing any more: the clock by which it was moved.
    pub(super) fn forget(&mut self) {
        self.delays = [Delays::EMPTY; 2];
        self.lead = self.whole();
    }

    /// News of a tick of the device came so long after it began, and since the last one so many
    /// frames came `late` and so many ticks went without one.
    pub(super) fn tick(
        &mut self,
        now: Instant,
        news: Duration,
        [late, missing]: [u64; 2],
    ) -> Deepened {
        self.news = news.max(self.news.saturating_sub(STEP));
        if late + missing > 0 {
            return self.trouble(now, late > 0);
        }
        let clean_since = |trouble: Option<Instant>, patience| {
            trouble.is_none_or(|then| now.saturating_duration_since(then) >= patience)
        };
        if clean_since(self.last_late, CLEAN) {
            self.worst = Duration::ZERO;
        }
        if self.depth > 1
            && clean_since(self.last_trouble, CLEAN)
            && clean_since(self.changed, CLEAN)
            && self.wanted() + self.news + BIN <= TICK * u32::from(self.depth - 1)
        {
            self.depth -= 1;
            self.lead = self.whole();
            self.changed = Some(now);
            return Deepened::Lowered;
        }
        let shortest = TICK * u32::from(self.depth - 1) + self.elbow_room();
        let target = self.wanted().clamp(shortest, self.whole());
        if target >= self.lead {
            self.lead = target;
        } else if clean_since(self.last_trouble, CALM) {
            self.lead = target.max(self.lead.saturating_sub(STEP));
        }
        Deepened::No
    }

    fn trouble(&mut self, now: Instant, is_late: bool) -> Deepened {
        let is_within = |span| move |then: Instant| now.saturating_duration_since(then) < span;
        if self.lead < self.whole() {
            self.grew = Some(now);
            self.lead = self.whole();
        }
        // A tick that went without its frame is told one tick before that this frame came late.
        let had_slack = self.grew.is_some_and(is_within(4 * TICK));
        self.last_trouble = Some(now);
        if !is_late {
            return Deepened::No;
        }
        self.last_late = Some(now);
        self.worst = self.worst.max(self.last_delay);
        let rested = !self.changed.is_some_and(is_within(RESTED));
        if !had_slack && rested && self.depth < self.deepest {
            self.depth += 1;
            self.lead = self.whole();
            self.changed = Some(now);
            return Deepened::Raised;
        }
        Deepened::No
    }

    /// The lead that the evidence asks for, whatever the depth.
    fn wanted(&self) -> Duration {
        let (delay, n) = self.delay();
        if n < FEW {
            return self.whole();
        }
        let reserve = RESERVE * ENOUGH.saturating_sub(n) / ENOUGH;
        delay.max(self.worst) + MARGIN + reserve
    }

    fn whole(&self) -> Duration {
        TICK * u32::from(self.depth)
    }

    fn elbow_room(&self) -> Duration {
        if self.depth > 1 { ELBOW_ROOM } else { MARGIN }
    }

    fn n(&self) -> u32 {
        self.delays.iter().map(|delays| delays.n).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    /// Ticks of a device whose frames take so long, in virtual time.
    struct Line {
        latching: Latching,
        now: Instant,
        changes: Vec<Deepened>,
    }

    impl Line {
        fn new() -> Self {
            Self {
                latching: Latching::new(),
                now: Instant::now(),
                changes: Vec::new(),
            }
        }

        /// So many ticks; a frame whose delay exceeds the lead comes late. Gives how many did.
        fn run(&mut self, n: u32, mut delay: impl FnMut(u32) -> Duration) -> u64 {
            let mut n_late = 0;
            for k in 0..n {
                let delay = delay(k);
                let late = u64::from(delay > self.latching.lead());
                n_late += late;
                self.latching.accepted(delay);
                self.now += TICK;
                let change = self.latching.tick(self.now, Duration::ZERO, [late, 0]);
                if change != Deepened::No {
                    self.changes.push(change);
                }
            }
            n_late
        }

        fn lead_ms(&self) -> f64 {
            self.latching.lead().as_secs_f64() * 1e3
        }
    }

    #[test]
    fn the_lead_starts_at_a_whole_tick_and_shrinks_to_the_delays_and_a_margin() {
        let mut line = Line::new();
        line.run(FEW - 1, |_| 2 * MS);
        assert_eq!(line.latching.lead(), TICK, "too few to know");
        line.run(400, |_| 2 * MS);
        let early_ms = line.lead_ms();
        assert!((8.0..10.0).contains(&early_ms), "a reserve: {early_ms}");
        line.run(1000, |_| 2 * MS);
        assert!((line.lead_ms() - 5.25).abs() < 1e-9, "{}", line.lead_ms());
        assert!(line.changes.is_empty());
    }

    #[test]
    fn one_frame_in_a_thousand_may_take_longer_and_more_may_not() {
        let mut line = Line::new();
        line.run(4000, |k| if k % 1500 == 7 { 9 * MS } else { 4 * MS });
        assert!((line.lead_ms() - 7.25).abs() < 1e-9, "{}", line.lead_ms());
        line.run(2000, |k| if k % 100 == 7 { 5 * MS } else { 4 * MS });
        assert!((line.lead_ms() - 8.25).abs() < 1e-9, "{}", line.lead_ms());
    }

    #[test]
    fn a_late_frame_costs_a_whole_tick_at_once_and_a_second_one_another() {
        let mut line = Line::new();
        assert_eq!(line.run(2000, |_| 2 * MS), 0);
        assert_eq!(line.run(1, |_| 15 * MS), 1);
        assert_eq!((line.latching.lead(), line.latching.depth()), (TICK, 1));
        line.run(399, |_| 2 * MS);
        assert_eq!(line.latching.lead(), TICK, "10 s of patience");
        line.run(400, |_| 2 * MS);
        assert!((line.lead_ms() - 18.0).abs() < 1e-9, "a minute's memory");
        assert_eq!(line.run(1, |_| 24 * MS), 1);
        assert_eq!(line.latching.depth(), 1, "long after the first");
        line.run(8, |_| 2 * MS);
        assert_eq!(line.run(1, |_| 26 * MS), 1);
        assert_eq!(line.changes, [Deepened::Raised]);
        assert_eq!(line.latching.lead(), 2 * TICK);
    }

    #[test]
    fn frames_that_need_more_than_a_tick_are_sent_further_ahead_until_they_do_not() {
        let mut line = Line::new();
        line.run(4000, |_| 28 * MS);
        assert_eq!(line.latching.depth(), 2);
        assert!((line.lead_ms() - 31.25).abs() < 1e-9, "{}", line.lead_ms());
        assert_eq!(line.run(2000, |_| 28 * MS), 0);
        assert_eq!(line.changes, [Deepened::Raised]);
        // The slow ones have to be forgotten first, which takes two minutes.
        line.run(2 * 4800, |_| 6 * MS);
        assert_eq!(line.changes, [Deepened::Raised, Deepened::Lowered]);
        assert_eq!(line.latching.depth(), 1);
        assert!((line.lead_ms() - 9.25).abs() < 1e-9, "{}", line.lead_ms());
    }

    #[test]
    fn depth_stays_within_three_and_within_the_devices_queue() {
        for (queue, deepest) in [(1, 1), (2, 2), (4, 3)] {
            let mut line = Line::new();
            line.latching.set_queue(queue);
            line.run(4000, |_| 99 * MS);
            assert_eq!(line.latching.depth(), deepest);
            assert_eq!(line.latching.lead(), TICK * u32::from(deepest));
        }
    }

    #[test]
    fn missing_frames_grow_the_lead_and_not_the_depth() {
        let mut line = Line::new();
        line.run(2000, |_| 2 * MS);
        for _ in 0..5 {
            line.now += TICK;
            line.latching.tick(line.now, Duration::ZERO, [0, 1]);
        }
        assert_eq!((line.latching.lead(), line.latching.depth()), (TICK, 1));
    }

    #[test]
    fn an_answer_is_due_its_lead_before_the_tick_and_never_before_its_status() {
        let mut line = Line::new();
        line.run(2000, |_| 2 * MS);
        let start = line.now;
        let due = line.latching.due(start, start + MS);
        assert_eq!(due + line.latching.lead(), start + TICK);
        let slow = start + 22 * MS;
        assert_eq!(line.latching.due(start, slow), slow);
        line.latching.forget();
        assert_eq!(line.latching.due(start, start + MS), start + MS);
    }
}
