//! A finger that leaves the surface: silent at once, and no velocity across the air.

use std::collections::VecDeque;

use super::*;

/// What a source says tick by tick: places, or that the finger is off.
#[derive(Debug)]
struct Script(VecDeque<Option<Point>>);

impl PointerInput for Script {
    fn kind(&self) -> SourceKind {
        SourceKind::Device
    }

    fn poll(&mut self, now: Instant, take: &mut dyn FnMut(PointerSample)) -> Reading {
        let Some(said) = self.0.pop_front() else {
            return Reading::Ended;
        };
        let Some(position) = said else {
            return Reading::Lifted;
        };
        // Three reports a tick, 8 ms apart, on the way to there.
        for back in [2_u32, 1, 0] {
            let stamp = now.checked_sub(Duration::from_millis(8) * back).unwrap();
            let x_mm = position.x_mm - 0.8 * f64::from(back);
            let position = Point::new(x_mm, position.y_mm);
            take(PointerSample { stamp, position });
        }
        Reading::Samples
    }
}

#[test]
fn a_lifted_finger_is_silent_at_once_and_touches_again_without_a_jump() {
    let (mut engine, start) = engine(Method::Table);
    let at = |x_mm: f64| Some(Point::new(x_mm, 60.0));
    let touch = (0..8).map(|n| at(40.0 + 2.4 * f64::from(n)));
    let air = [None, None];
    let again = (0..4).map(|n| at(90.0 - 2.4 * f64::from(n)));
    let script = Script(touch.chain(air).chain(again).collect());
    let source = InputSource::Live(Box::new(script));
    engine.send(Command::SetSource(source)).unwrap();
    let mut felt = Vec::new();
    for tick in 0..14 {
        engine.advance(start + TICK * tick);
        let snapshot = engine.snapshot();
        felt.push((
            is_silent(snapshot),
            snapshot.pointer.is_lifted,
            snapshot.pose.velocity.speed_mm_per_s(),
        ));
    }
    assert!(!felt[7].0 && felt[7].2 > 50.0, "it moves: {:?}", felt[7]);
    for (is_silent, is_lifted, speed_mm_per_s) in &felt[8..10] {
        assert!(is_silent & is_lifted, "{felt:?}");
        assert_eq!(*speed_mm_per_s, 0.0);
    }
    // 40 mm of air in two ticks would be 800 mm/s.
    assert!(
        felt[10..]
            .iter()
            .all(|(_, is_lifted, speed)| !is_lifted && *speed < 200.0)
    );
    assert!(!felt[13].0, "it is felt again");
    assert_eq!(engine.snapshot().source, SourceKind::Device);
}
