//! Live samples: a bounded ring from whoever sees the pointer to the engine.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use rtrb::{Consumer, Producer, RingBuffer};

use super::pointer::{InputLosses, PointerInput, Reading, SourceKind};
use crate::PointerSample;

/// Room for samples between two ticks: a mouse with 8 kHz and then some.
const CAPACITY: usize = 1024;

/// The end of the ring that takes samples, for the thread that sees the pointer move.
///
/// It neither locks nor waits. A full ring drops the sample and counts it.
#[derive(Debug)]
pub struct PointerSender {
    ring: Producer<PointerSample>,
    overflowed: Arc<AtomicU64>,
}

impl PointerSender {
    /// Hands over a sample; false if there was no room and it was dropped.
    pub fn push(&mut self, sample: PointerSample) -> bool {
        let has_room = self.ring.push(sample).is_ok();
        if !has_room {
            self.overflowed.fetch_add(1, Ordering::Relaxed);
        }
        has_room
    }
}

/// The end of the ring that the engine reads.
#[derive(Debug)]
pub(crate) struct LiveInput {
    ring: Consumer<PointerSample>,
    overflowed: Arc<AtomicU64>,
}

/// A ring for live samples.
pub(crate) fn live_ring() -> (PointerSender, LiveInput) {
    let (sender, ring) = RingBuffer::new(CAPACITY);
    let overflowed = Arc::new(AtomicU64::new(0));
    (
        PointerSender {
            ring: sender,
            overflowed: Arc::clone(&overflowed),
        },
        LiveInput { ring, overflowed },
    )
}

impl PointerInput for LiveInput {
    fn kind(&self) -> SourceKind {
        SourceKind::Pointer
    }

    fn poll(&mut self, _now: Instant, take: &mut dyn FnMut(PointerSample)) -> Reading {
        for _ in 0..CAPACITY {
            let Ok(sample) = self.ring.pop() else { break };
            take(sample);
        }
        Reading::Samples
    }

    fn losses(&self) -> InputLosses {
        let overflowed = self.overflowed.load(Ordering::Relaxed);
        InputLosses {
            overflowed,
            ..InputLosses::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::geometry::Point;

    #[test]
    fn a_full_ring_drops_the_newest_and_counts_it() {
        let (mut sender, mut live) = live_ring();
        let now = Instant::now();
        let sample = |x: usize| PointerSample {
            stamp: now,
            position: Point::new(x as f64, 0.0),
        };
        for x in 0..CAPACITY {
            assert!(sender.push(sample(x)), "room for sample {x}");
        }
        assert!(!sender.push(sample(CAPACITY)));
        let mut taken = Vec::new();
        live.poll(now, &mut |sample| taken.push(sample.position.x_mm));
        assert_eq!(
            (taken.len(), taken[0], taken[CAPACITY - 1]),
            (CAPACITY, 0.0, 1023.0)
        );
        assert_eq!(live.losses().overflowed, 1);
        assert!(sender.push(sample(0)), "there is room again");
    }
}
