//! Frames waiting for their tick.

/// One waiting FRAME.
#[derive(Clone, Debug)]
pub(super) struct Waiting {
    pub(super) tick: u32,
    pub(super) seq: u16,
    /// As received.
    pub(super) received: Vec<[u16; 2]>,
    /// After mask, limit and sum guard.
    pub(super) allowed: Vec<[u16; 2]>,
    /// Values that are to be counted as clipped when it is played.
    pub(super) clipped: u16,
    full: bool,
}

/// At most `queue` frames, one a tick; the last writer wins. Never allocates after it was made.
#[derive(Clone, Debug)]
pub(super) struct FrameQueue {
    slots: Vec<Waiting>,
}

impl FrameQueue {
    pub(super) fn new(queue: u8, n_channels: usize) -> Self {
        let empty = Waiting {
            tick: 0,
            seq: 0,
            received: vec![[0; 2]; n_channels],
            allowed: vec![[0; 2]; n_channels],
            clipped: 0,
            full: false,
        };
        Self {
            slots: vec![empty; usize::from(queue.max(1))],
        }
    }

    pub(super) fn len(&self) -> u8 {
        self.slots.iter().filter(|slot| slot.full).map(|_| 1).sum()
    }

    /// Channels that all slots hold room for.
    #[cfg(test)]
    pub(super) fn held(&self) -> usize {
        let room = |slot: &Waiting| slot.received.capacity() + slot.allowed.capacity();
        self.slots.iter().map(room).sum()
    }

    pub(super) fn clear(&mut self) {
        for slot in &mut self.slots {
            slot.full = false;
        }
    }

    /// The slot of `tick`, an empty one otherwise. Ticks 1…queue ahead always find one.
    pub(super) fn slot(&mut self, tick: u32, seq: u16) -> Option<&mut Waiting> {
        let same = self
            .slots
            .iter()
            .position(|slot| slot.full && slot.tick == tick);
        let index = same.or_else(|| self.slots.iter().position(|slot| !slot.full))?;
        let slot = &mut self.slots[index];
        slot.full = true;
        slot.tick = tick;
        slot.seq = seq;
        slot.clipped = 0;
        Some(slot)
    }

    /// Whether a frame waits for `tick`.
    pub(super) fn holds(&self, tick: u32) -> bool {
        self.slots.iter().any(|slot| slot.full && slot.tick == tick)
    }

    /// Puts the frames that wait in the order of their seqs.
    pub(super) fn order_by_seq(&mut self) {
        let waiting = || self.slots.iter().filter(|slot| slot.full);
        let mut ticks: Vec<u32> = waiting().map(|slot| slot.tick).collect();
        ticks.sort_unstable();
        self.slots.sort_by_key(|slot| (!slot.full, slot.seq));
        for (slot, tick) in self.slots.iter_mut().zip(ticks) {
            slot.tick = tick;
        }
    }

    /// Takes the frame of `tick` out; its contents stay readable until the slot is used again.
    pub(super) fn take(&mut self, tick: u32) -> Option<&Waiting> {
        let slot = self
            .slots
            .iter_mut()
            .find(|slot| slot.full && slot.tick == tick)?;
        slot.full = false;
        Some(slot)
    }
}
