//! Movements that wait for the next frame that a stage has planned.
//!
//! The toolkit draws a frame for every movement that it hears of, as fast as the machine can: four
//! times as many as are planned while somebody strokes, and as many while a mouse only passes by.
//! The engine has heard of them before ([`super::ear`]), so nothing is felt later; a press, a lift
//! and a key are drawn at once, with the movements before them.

use std::time::{Duration, Instant};

use winit::event::{TouchPhase, WindowEvent};
use winit::window::WindowId;

/// None waits longer: from frame to frame while somebody strokes.
const LONGEST: Duration = Duration::from_millis(50);

/// The last movement of everything that moves, in the order in which they began to.
#[derive(Debug, Default)]
pub(crate) struct HeldMoves {
    held: Vec<(Mover, WindowId, WindowEvent)>,
    /// When the first of them came.
    since: Option<Instant>,
}

/// What moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mover {
    Pointer,
    Finger(u64),
}

impl HeldMoves {
    /// Holds a movement in place of the one before it; any other event comes back.
    pub(crate) fn hold(
        &mut self,
        now: Instant,
        id: WindowId,
        event: WindowEvent,
    ) -> Option<WindowEvent> {
        let mover = match &event {
            WindowEvent::CursorMoved { .. } => Mover::Pointer,
            WindowEvent::Touch(touch) if touch.phase == TouchPhase::Moved => {
                Mover::Finger(touch.id)
            }
            _ => return Some(event),
        };
        self.since.get_or_insert(now);
        let known = self.held.iter_mut().find(|(known, ..)| *known == mover);
        match known {
            Some(known) => (known.1, known.2) = (id, event),
            None => self.held.push((mover, id, event)),
        }
        None
    }

    /// Whether something is held that may not wait any longer.
    pub(crate) fn is_due(&self, now: Instant) -> bool {
        (self.since).is_some_and(|since| now.saturating_duration_since(since) >= LONGEST)
    }

    /// What is held.
    pub(crate) fn take(&mut self) -> impl Iterator<Item = (WindowId, WindowEvent)> + use<> {
        self.since = None;
        let held = std::mem::take(&mut self.held);
        held.into_iter().map(|(_, id, event)| (id, event))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use winit::dpi::PhysicalPosition;
    use winit::event::{DeviceId, Touch};

    fn moved(x: f64) -> WindowEvent {
        WindowEvent::CursorMoved {
            device_id: DeviceId::dummy(),
            position: PhysicalPosition::new(x, 0.0),
        }
    }

    fn touch(id: u64, phase: TouchPhase, x: f64) -> WindowEvent {
        WindowEvent::Touch(Touch {
            device_id: DeviceId::dummy(),
            phase,
            location: PhysicalPosition::new(x, 0.0),
            force: None,
            id,
        })
    }

    #[test]
    fn the_last_movement_of_each_waits_and_nothing_else_does() {
        let (mut held, id) = (HeldMoves::default(), WindowId::dummy());
        let now = Instant::now();
        for x in [1.0, 2.0, 3.0] {
            assert_eq!(held.hold(now, id, moved(x)), None);
            for finger in [4, 5] {
                let move_of = touch(finger, TouchPhase::Moved, x + finger as f64);
                assert_eq!(held.hold(now, id, move_of), None);
            }
        }
        assert!(!held.is_due(now + LONGEST / 2) && held.is_due(now + LONGEST));
        let told: Vec<WindowEvent> = held.take().map(|(_, event)| event).collect();
        let last = |finger: u64| touch(finger, TouchPhase::Moved, 3.0 + finger as f64);
        assert_eq!(told, [moved(3.0), last(4), last(5)]);
        assert_eq!(held.take().count(), 0, "they are told once");
        assert!(!held.is_due(now + LONGEST));
        for phase in [
            TouchPhase::Started,
            TouchPhase::Ended,
            TouchPhase::Cancelled,
        ] {
            let event = touch(4, phase, 0.0);
            assert_eq!(held.hold(now, id, event.clone()), Some(event));
        }
        let frame = WindowEvent::RedrawRequested;
        assert_eq!(held.hold(now, id, frame.clone()), Some(frame));
    }
}
