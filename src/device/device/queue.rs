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
        Some(slot)
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
