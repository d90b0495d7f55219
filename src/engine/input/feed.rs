//! From a thread that reads a device, a stream or a connection to the engine: a bounded ring of
//! positions and of lifts, and one more for fingers beside the first.
//!
//! A lift ends what came before it: the poll that meets one hands over nothing that follows, so
//! that no velocity spans the air between two touches.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

use rtrb::{Consumer, Producer, PushError, RingBuffer};

use super::live::Touched;
use super::pointer::{InputLosses, PointerInput, Reading, SourceKind};
use crate::PointerSample;

/// Room for positions between two ticks: 8 kHz and then some.
pub(super) const CAPACITY: usize = 1024;

/// What a reader found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum FeedItem {
    /// The finger is here; the angle of the display where the source tells it, degrees.
    Sample(PointerSample, Option<f64>),
    /// The finger left the surface.
    Lift,
}

#[derive(Debug, Default)]
struct Shared {
    overflowed: AtomicU64,
    bad_lines: AtomicU64,
    lost_in_system: AtomicU64,
    has_ended: AtomicBool,
}

/// The reader's end.
#[derive(Debug)]
pub(crate) struct FeedSender {
    ring: Producer<FeedItem>,
    others: Producer<Touched>,
    shared: Arc<Shared>,
}

/// The engine's end.
#[derive(Debug)]
pub(crate) struct FeedInput {
    ring: Consumer<FeedItem>,
    others: Consumer<Touched>,
    shared: Arc<Shared>,
    kind: SourceKind,
    angle_deg: Option<f64>,
    is_lifted: bool,
}

/// Both ends of a feed of this kind.
pub(crate) fn feed(kind: SourceKind) -> (FeedSender, FeedInput) {
    let (sender, ring) = RingBuffer::new(CAPACITY);
    let (to_others, others) = RingBuffer::new(CAPACITY);
    let shared = Arc::new(Shared::default());
    let input = FeedInput {
        ring,
        others,
        shared: Arc::clone(&shared),
        kind,
        angle_deg: None,
        is_lifted: false,
    };
    let sender = FeedSender {
        ring: sender,
        others: to_others,
        shared,
    };
    (sender, input)
}

impl FeedSender {
    /// Hands over an item; it comes back when there is no room.
    pub(crate) fn offer(&mut self, item: FeedItem) -> Result<(), FeedItem> {
        self.ring.push(item).map_err(|PushError::Full(item)| item)
    }

    /// Hands over an item, or drops and counts it when there is no room.
    pub(crate) fn push(&mut self, item: FeedItem) {
        if self.offer(item).is_err() {
            self.shared.overflowed.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// The finger of this number, of which the first is 0, is here, or left the surface.
    pub(crate) fn push_of(&mut self, finger: usize, sample: Option<PointerSample>) {
        if finger == 0 {
            return self.push(sample.map_or(FeedItem::Lift, |at| FeedItem::Sample(at, None)));
        }
        let touched = Touched {
            display: finger,
            sample,
        };
        if self.others.push(touched).is_err() {
            self.shared.overflowed.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Counts a line that was no position.
    pub(crate) fn count_bad_line(&self) {
        self.shared.bad_lines.fetch_add(1, Ordering::Relaxed);
    }

    /// Counts reports that the system dropped before they could be read.
    #[cfg(target_os = "linux")]
    pub(crate) fn count_lost_in_system(&self) {
        self.shared.lost_in_system.fetch_add(1, Ordering::Relaxed);
    }

    /// Whether nobody listens any more.
    pub(crate) fn is_abandoned(&self) -> bool {
        self.ring.is_abandoned()
    }

    /// Nothing will follow.
    pub(crate) fn end(&self) {
        self.shared.has_ended.store(true, Ordering::Release);
    }
}

impl PointerInput for FeedInput {
    fn kind(&self) -> SourceKind {
        self.kind
    }

    fn poll(&mut self, _now: Instant, take: &mut dyn FnMut(PointerSample)) -> Reading {
        // Read before the ring is emptied: what the reader pushed before it ended is then in it.
        let has_ended = self.shared.has_ended.load(Ordering::Acquire);
        for n_taken in 0..CAPACITY {
            match self.ring.pop() {
                Ok(FeedItem::Sample(sample, angle_deg)) => {
                    self.angle_deg = angle_deg.filter(|deg| deg.is_finite()).or(self.angle_deg);
                    self.is_lifted = false;
                    take(sample);
                }
                Ok(FeedItem::Lift) => {
                    self.is_lifted = true;
                    return Reading::Lifted;
                }
                Err(_) if has_ended && n_taken == 0 => return Reading::Ended,
                Err(_) => break,
            }
        }
        if self.is_lifted {
            Reading::Lifted
        } else {
            Reading::Samples
        }
    }

    fn poll_others(&mut self, take: &mut dyn FnMut(usize, Option<PointerSample>)) {
        for _ in 0..CAPACITY {
            let Ok(touched) = self.others.pop() else {
                break;
            };
            take(touched.display, touched.sample);
        }
    }

    fn angle_deg(&self) -> Option<f64> {
        self.angle_deg
    }

    fn losses(&self) -> InputLosses {
        let of = |count: &AtomicU64| count.load(Ordering::Relaxed);
        InputLosses {
            overflowed: of(&self.shared.overflowed),
            bad_lines: of(&self.shared.bad_lines),
            lost_in_system: of(&self.shared.lost_in_system),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::geometry::Point;

    fn sample(x_mm: f64) -> FeedItem {
        let position = Point::new(x_mm, 0.0);
        let stamp = Instant::now();
        FeedItem::Sample(PointerSample { stamp, position }, None)
    }

    fn poll(input: &mut FeedInput) -> (Reading, Vec<f64>) {
        let mut taken = Vec::new();
        let reading = input.poll(Instant::now(), &mut |s| taken.push(s.position.x_mm));
        (reading, taken)
    }

    #[test]
    fn a_lift_holds_back_what_follows_it_and_lasts_until_then() {
        let (mut sender, mut input) = feed(SourceKind::Device);
        for item in [sample(1.0), FeedItem::Lift, sample(2.0)] {
            sender.push(item);
        }
        assert_eq!(poll(&mut input), (Reading::Lifted, vec![1.0]));
        assert_eq!(poll(&mut input), (Reading::Samples, vec![2.0]));
        sender.push(FeedItem::Lift);
        for _ in 0..3 {
            assert_eq!(poll(&mut input), (Reading::Lifted, vec![]));
        }
        sender.push(sample(3.0));
        assert_eq!(poll(&mut input), (Reading::Samples, vec![3.0]));
        sender.end();
        assert_eq!(poll(&mut input).0, Reading::Ended);
    }

    #[test]
    fn a_full_feed_drops_the_newest_and_counts_it() {
        let (mut sender, mut input) = feed(SourceKind::Device);
        for x in 0..CAPACITY + 3 {
            sender.push(sample(x as f64));
        }
        assert_eq!(poll(&mut input).1.len(), CAPACITY);
        assert_eq!(input.losses().overflowed, 3);
    }

    #[test]
    fn an_angle_stays_until_another_is_told() {
        let (mut sender, mut input) = feed(SourceKind::Program);
        let described = |angle_deg| match sample(0.0) {
            FeedItem::Sample(sample, _) => FeedItem::Sample(sample, angle_deg),
            lift @ FeedItem::Lift => lift,
        };
        for angle_deg in [Some(30.0), None, Some(f64::NAN)] {
            sender.push(described(angle_deg));
        }
        poll(&mut input);
        assert_eq!(input.angle_deg(), Some(30.0));
    }
}
