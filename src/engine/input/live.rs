//! Live samples: a bounded ring from whoever sees pointer and fingers to the engine.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use rtrb::{Consumer, Producer, RingBuffer};

use super::pointer::InputLosses;
use crate::PointerSample;

/// Room for samples between two ticks: a mouse with 8 kHz and then some.
const CAPACITY: usize = 1024;

/// What the pointer or a finger did, and which display of the scene it holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Touched {
    /// The display's place in the scene's list.
    pub(crate) display: usize,
    /// Where it is; `None`: it left the surface.
    pub(crate) sample: Option<PointerSample>,
}

impl Touched {
    /// The first display is here.
    pub(crate) fn first(sample: PointerSample) -> Self {
        Self {
            display: 0,
            sample: Some(sample),
        }
    }
}

/// The end of the ring that takes samples, for the thread that sees the pointer move.
///
/// It neither locks nor waits. A full ring drops the sample and counts it.
#[derive(Debug)]
pub struct PointerSender {
    ring: Producer<Touched>,
    overflowed: Arc<AtomicU64>,
}

impl PointerSender {
    /// Hands over a sample of what moves the first display; false if there was no room and it was
    /// dropped.
    pub fn push(&mut self, sample: PointerSample) -> bool {
        self.offer(Touched::first(sample))
    }

    /// The same for the display at this place of the scene's list.
    pub fn push_to(&mut self, display: usize, sample: PointerSample) -> bool {
        let sample = Some(sample);
        self.offer(Touched { display, sample })
    }

    /// The finger that holds this display left the surface.
    pub fn lift(&mut self, display: usize) -> bool {
        let sample = None;
        self.offer(Touched { display, sample })
    }

    fn offer(&mut self, touched: Touched) -> bool {
        let has_room = self.ring.push(touched).is_ok();
        if !has_room {
            self.overflowed.fetch_add(1, Ordering::Relaxed);
        }
        has_room
    }
}

/// The end of the ring that the engine reads.
#[derive(Debug)]
pub(crate) struct LiveInput {
    ring: Consumer<Touched>,
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

impl LiveInput {
    /// Hands over what arrived since the last call, oldest first.
    pub(crate) fn poll(&mut self, mut take: impl FnMut(Touched)) {
        for _ in 0..CAPACITY {
            let Ok(touched) = self.ring.pop() else { break };
            take(touched);
        }
    }

    /// What was lost on the way.
    pub(crate) fn losses(&self) -> InputLosses {
        let overflowed = self.overflowed.load(Ordering::Relaxed);
        InputLosses {
            overflowed,
            ..InputLosses::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

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
        live.poll(|touched| taken.extend(touched.sample.map(|sample| sample.position.x_mm)));
        assert_eq!(
            (taken.len(), taken[0], taken[CAPACITY - 1]),
            (CAPACITY, 0.0, 1023.0)
        );
        assert_eq!(live.losses().overflowed, 1);
        assert!(sender.push(sample(0)), "there is room again");
    }
}
