//! Reports of a tablet or touch frame as positions and lifts: no device, no clock.
//!
//! A report is a run of events that ends in SYN. A pen or single touch is in contact while
//! `BTN_TOUCH` says so, or by its pressure where it has no such button; several fingers come in
//! slots, and each that touches takes the first number that is free and keeps it until it lifts.
//! When the kernel had to drop events nothing more is believed until the state was asked for anew.

use crate::MAX_FINGERS;

/// Kinds and codes of events, as `linux/input-event-codes.h` numbers them.
pub(super) mod code {
    pub(in super::super) const SYN: u16 = 0;
    pub(in super::super) const SYN_REPORT: u16 = 0;
    pub(in super::super) const SYN_DROPPED: u16 = 3;
    pub(in super::super) const KEY: u16 = 1;
    pub(in super::super) const ABS: u16 = 3;
    pub(in super::super) const ABS_X: u16 = 0x00;
    pub(in super::super) const ABS_Y: u16 = 0x01;
    pub(in super::super) const ABS_PRESSURE: u16 = 0x18;
    pub(in super::super) const MT_SLOT: u16 = 0x2f;
    pub(in super::super) const MT_X: u16 = 0x35;
    pub(in super::super) const MT_Y: u16 = 0x36;
    pub(in super::super) const MT_ID: u16 = 0x39;
    /// Pen, rubber, brush, pencil, airbrush.
    pub(in super::super) const TOOLS: std::ops::RangeInclusive<u16> = 0x140..=0x144;
    pub(in super::super) const TOUCH: u16 = 0x14a;
}

/// Bytes of an event where a time has two numbers of 64 bits.
pub(super) const EVENT_BYTES: usize = 24;
/// Slots that are followed: more fingers than a hand has.
pub(super) const MAX_SLOTS: usize = 16;

/// One event.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Event {
    /// The kernel's time, µs.
    pub(super) time_us: i64,
    pub(super) kind: u16,
    pub(super) code: u16,
    pub(super) value: i32,
}

impl Event {
    /// The events in whole pieces of `bytes`.
    pub(super) fn read(bytes: &[u8]) -> impl Iterator<Item = Self> + '_ {
        let (events, _) = bytes.as_chunks::<EVENT_BYTES>();
        events.iter().map(|bytes| {
            let [s, us] = [0, 8].map(|at| i64::from_ne_bytes(part(bytes, at)));
            Self {
                time_us: s.saturating_mul(1_000_000).saturating_add(us),
                kind: u16::from_ne_bytes(part(bytes, 16)),
                code: u16::from_ne_bytes(part(bytes, 18)),
                value: i32::from_ne_bytes(part(bytes, 20)),
            }
        })
    }
}

fn part<const N: usize>(bytes: &[u8; EVENT_BYTES], at: usize) -> [u8; N] {
    let mut part = [0; N];
    for (slot, byte) in part.iter_mut().zip(bytes.iter().skip(at)) {
        *slot = *byte;
    }
    part
}

/// How a device tells of contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Contact {
    /// Fingers in slots.
    Slots,
    /// A button that is pressed by touching.
    Button,
    /// Pressure above nothing.
    Pressure,
    /// It does not: it always touches.
    Always,
}

/// One finger's slot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Slot {
    /// Below 0: no finger.
    pub(super) id: i32,
    pub(super) at: [i32; 2],
}

impl Slot {
    pub(super) const EMPTY: Self = Self { id: -1, at: [0; 2] };
}

/// Everything that events change: what a device says when asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct State {
    pub(super) at: [i32; 2],
    pub(super) pressure: i32,
    pub(super) is_touching: bool,
    /// The tools in range, a bit each; `None` of devices that do not tell.
    pub(super) tools: Option<u8>,
    pub(super) slot: usize,
    pub(super) slots: [Slot; MAX_SLOTS],
}

impl State {
    /// No finger, nothing known.
    pub(super) const NOTHING: Self = Self {
        at: [0; 2],
        pressure: 0,
        is_touching: false,
        tools: None,
        slot: 0,
        slots: [Slot::EMPTY; MAX_SLOTS],
    };
}

/// What a report says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Report {
    /// The finger of this number is here, in the device's units.
    At {
        finger: usize,
        /// The kernel's time, µs.
        time_us: i64,
        /// x and y.
        at: [i32; 2],
    },
    /// The finger of this number left.
    Lifted(usize),
    /// The kernel dropped events: ask for the state anew.
    Lost,
}

/// Follows a device's events.
#[derive(Debug)]
pub(super) struct Decoder {
    contact: Contact,
    state: State,
    /// The slots of fingers that are followed, by their numbers, and which were down.
    followed: [Option<usize>; MAX_FINGERS],
    was_down: [bool; MAX_FINGERS],
    is_lost: bool,
}

impl Decoder {
    /// A decoder of a device that is in this state.
    pub(super) fn new(contact: Contact, state: State) -> Self {
        let mut down = (0..MAX_SLOTS).filter(|slot| state.slots[*slot].id >= 0);
        Self {
            contact,
            state,
            followed: std::array::from_fn(|_| down.next()),
            was_down: [false; MAX_FINGERS],
            is_lost: false,
        }
    }

    /// Takes the state that the device told after a loss; a finger that is down begins anew.
    pub(super) fn resume(&mut self, state: State) {
        *self = Self::new(self.contact, state);
    }

    /// Takes an event; the end of a report says what it was about.
    pub(super) fn take(&mut self, event: Event, say: &mut dyn FnMut(Report)) {
        match (event.kind, event.code) {
            (code::SYN, code::SYN_DROPPED) => self.is_lost = true,
            (code::SYN, code::SYN_REPORT) => self.report(event.time_us, say),
            _ if self.is_lost => {}
            (code::KEY, code::TOUCH) => self.state.is_touching = event.value != 0,
            (code::KEY, tool) if code::TOOLS.contains(&tool) => {
                let bit = 1 << (tool - code::TOOLS.start());
                let tools = self.state.tools.unwrap_or(0);
                let is_near = event.value != 0;
                self.state.tools = Some(if is_near { tools | bit } else { tools & !bit });
            }
            (code::ABS, axis) => self.axis(axis, event.value),
            _ => {}
        }
    }

    fn axis(&mut self, axis: u16, value: i32) {
        let state = &mut self.state;
        match axis {
            code::ABS_X => state.at[0] = value,
            code::ABS_Y => state.at[1] = value,
            code::ABS_PRESSURE => state.pressure = value,
            code::MT_SLOT => state.slot = usize::try_from(value).unwrap_or(MAX_SLOTS),
            _ => {
                let current = state.slot;
                // Fingers beyond the last slot are not followed.
                let Some(slot) = state.slots.get_mut(current) else {
                    return;
                };
                match axis {
                    code::MT_X => slot.at[0] = value,
                    code::MT_Y => slot.at[1] = value,
                    code::MT_ID => {
                        let is_other = value != slot.id;
                        slot.id = value;
                        if is_other {
                            self.follow(current, value >= 0);
                        }
                    }
                    _ => {}
                }
            }
        }
    }

    /// Another finger is in a slot, or none any more.
    fn follow(&mut self, slot: usize, is_down: bool) {
        let known = self.followed.iter().position(|known| *known == Some(slot));
        if let Some(finger) = known {
            // Another finger in its slot is not the one that was followed.
            self.followed[finger] = None;
        } else if is_down {
            let mut fingers = self.followed.iter_mut().zip(self.was_down);
            let free = fingers.find(|(followed, was_down)| followed.is_none() && !was_down);
            if let Some((followed, _)) = free {
                *followed = Some(slot);
            }
        }
    }

    fn report(&mut self, time_us: i64, say: &mut dyn FnMut(Report)) {
        if std::mem::take(&mut self.is_lost) {
            self.was_down = [false; MAX_FINGERS];
            self.followed = [None; MAX_FINGERS];
            return say(Report::Lost);
        }
        for finger in 0..MAX_FINGERS {
            let at = self.place_of(finger);
            let was_down = std::mem::replace(&mut self.was_down[finger], at.is_some());
            match at {
                Some(at) => say(Report::At {
                    finger,
                    time_us,
                    at,
                }),
                None if was_down => say(Report::Lifted(finger)),
                None => {}
            }
        }
    }

    /// Where a finger is that touches; a pen is the first.
    fn place_of(&self, finger: usize) -> Option<[i32; 2]> {
        let state = &self.state;
        let of_pen = |touches: bool| (touches && finger == 0).then_some(state.at);
        let at = match self.contact {
            Contact::Slots => self.followed[finger].map(|slot| state.slots[slot].at),
            Contact::Button => of_pen(state.is_touching),
            Contact::Pressure => of_pen(state.pressure > 0),
            Contact::Always => of_pen(true),
        };
        at.filter(|_| state.tools != Some(0))
    }
}

#[cfg(test)]
#[path = "decode_tests.rs"]
mod tests;
