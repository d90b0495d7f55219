//! A textile's amplitudes over direction and over speed, as the Response pane draws them.
//!
//! Computed before gains, so that no slider computes anything; on a thread of its own, and anew
//! only when a curve's own inputs change. Until that is done the last curves stay, unless the
//! textile is another.

use std::sync::Arc;

use eframe::egui;

use crate::bench::background::Executor;
use crate::bench::latest::{Computed, Latest};
use crate::bench::probe::{Probe, SPEEDS_MM_PER_S};
use selvedge_foundation::geometry::Velocity;
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_render::array::{PointSpread, TextileResponse};

/// Steps of direction in a quarter turn: 5° each.
const N_A_QUARTER: usize = 18;
/// Speeds of a curve, evenly apart on a logarithmic axis.
const N_SPEEDS: u8 = 97;

/// What curves are wanted for.
#[derive(Debug, Clone)]
pub(crate) struct Wanted {
    /// The textile.
    pub response: TextileResponse,
    /// The points of the chosen place, one for each direction of the surface.
    pub points: Option<[usize; 4]>,
    /// The chosen velocity.
    pub probe: Probe,
}

/// The curves of the textile that is wanted, as they were last computed.
#[derive(Debug, Default)]
pub(crate) struct Curves {
    latest: Latest<Wanted, Computation>,
    /// Those to show; none while they are of another textile.
    shown: Option<Arc<Computation>>,
}

/// Amplitudes before gains.
type Curve = Arc<[PointSpread]>;

/// The curves for one thing that was wanted.
#[derive(Debug, Default)]
struct Computation {
    around: Curve,
    over_speed: Curve,
    here: Curve,
    /// Curves computed so far.
    n_computed: u64,
}

/// What a curve runs over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Direction, counter-clockwise from the warp, at one speed.
    Direction,
    /// Speed, in one direction.
    Speed,
    /// Nothing: the chosen velocity itself.
    Here,
}

impl Wanted {
    fn is_same_cloth(&self, other: &Self) -> bool {
        self.response.is_same_cloth(&other.response)
    }

    /// Whether a curve is the same for both.
    fn is_same(&self, other: &Self, kind: Kind) -> bool {
        let (own, other_probe) = (self.probe, other.probe);
        let is_speed = own.speed_mm_per_s.to_bits() == other_probe.speed_mm_per_s.to_bits();
        let is_direction = own.direction_deg.to_bits() == other_probe.direction_deg.to_bits();
        let is_velocity = match kind {
            Kind::Direction => is_speed,
            Kind::Speed => is_direction,
            Kind::Here => is_speed && is_direction,
        };
        is_velocity && self.points == other.points && self.is_same_cloth(other)
    }

    fn computed(&self, kind: Kind) -> Curve {
        let at = |velocity: Velocity| {
            let own = self.response.along(velocity);
            self.response.at(own, self.points)
        };
        match kind {
            Kind::Direction => {
                let speed_mm_per_s = self.probe.speed_mm_per_s;
                let around = self
                    .response
                    .by_direction(speed_mm_per_s, self.points, N_A_QUARTER);
                around.into()
            }
            Kind::Speed => {
                let along = |speed| self.probe.with_speed(speed).velocity();
                speeds_mm_per_s().map(|speed| at(along(speed))).collect()
            }
            Kind::Here => [at(self.probe.velocity())].into(),
        }
    }
}

impl PartialEq for Wanted {
    fn eq(&self, other: &Self) -> bool {
        self.is_same(other, Kind::Here)
    }
}

impl Computed<Wanted> for Computation {
    const THREAD: &str = "selvedge-curves";

    fn compute(
        wanted: &Wanted,
        prior: Option<(&Wanted, &Self)>,
        _: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let prior = prior.filter(|(_, before)| before.n_computed > 0);
        let mut n_computed = prior.map_or(0, |(_, before)| before.n_computed);
        let mut curve = |kind, of: fn(&Self) -> &Curve| match prior {
            Some((for_, before)) if for_.is_same(wanted, kind) => Arc::clone(of(before)),
            _ => {
                n_computed += 1;
                wanted.computed(kind)
            }
        };
        Ok(Self {
            around: curve(Kind::Direction, |of| &of.around),
            over_speed: curve(Kind::Speed, |of| &of.over_speed),
            here: curve(Kind::Here, |of| &of.here),
            n_computed,
        })
    }

    fn broken(_: &Wanted, _: &str) -> Self {
        Self::default()
    }

    fn serves(_: &Wanted, _: &Wanted) -> bool {
        true
    }
}

/// The speeds of a curve, rising, mm/s.
pub(crate) fn speeds_mm_per_s() -> impl Iterator<Item = f64> {
    let [least, most] = SPEEDS_MM_PER_S;
    let share = |i: u8| f64::from(i) / f64::from(N_SPEEDS - 1);
    (0..N_SPEEDS).map(move |i| least * (most / least).powf(share(i)))
}

impl Curves {
    /// Lets the curves follow what is wanted.
    pub(crate) fn follow(&mut self, ctx: &egui::Context, executor: &Executor, wanted: Wanted) {
        let wanted = Wanted {
            response: wanted.response.without_gains(),
            ..wanted
        };
        self.latest.poll();
        self.latest.follow(ctx, executor, &wanted);
        let is_of_it = self
            .latest
            .key()
            .is_some_and(|of| of.is_same_cloth(&wanted));
        self.shown = self.latest.value().filter(|_| is_of_it).cloned();
    }

    /// Amplitudes before gains over the direction of movement, evenly apart all around,
    /// counter-clockwise from the warp; empty until they are computed.
    pub(crate) fn around(&self) -> &[PointSpread] {
        self.curve(|shown| &shown.around)
    }

    /// The same over [`speeds_mm_per_s`].
    pub(crate) fn over_speed(&self) -> &[PointSpread] {
        self.curve(|shown| &shown.over_speed)
    }

    /// The same at the chosen velocity itself.
    pub(crate) fn here(&self) -> Option<&PointSpread> {
        self.curve(|shown| &shown.here).first()
    }

    /// Curves computed so far: it stands still while nothing changes or nobody looks.
    pub(crate) fn n_computed(&self) -> u64 {
        self.latest.value().map_or(0, |value| value.n_computed)
    }

    fn curve(&self, of: fn(&Computation) -> &Curve) -> &[PointSpread] {
        self.shown.as_deref().map_or(&[], |shown| of(shown))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::geometry::Point;
    use selvedge_render::RenderScene;
    use selvedge_render::array::{Accuracy, ArrayRenderer, ContactInspector, Method};
    use selvedge_render::scene::{LoadedScene, Pose};

    const PLACE: [f64; 2] = [31.2, 47.8];

    fn wanted(inspector: &ContactInspector, textile: usize, probe: Probe) -> Wanted {
        let response = inspector.response(textile).unwrap();
        Wanted {
            points: Some(response.points_at(PLACE)),
            response,
            probe,
        }
    }

    #[test]
    fn the_curves_are_what_the_reference_renders() {
        let ctx = egui::Context::default();
        let scene = RenderScene::of(&LoadedScene::shipped().unwrap());
        let inspector = ContactInspector::new(&scene);
        let exact = Accuracy::default();
        let mut reference = ArrayRenderer::prepare(&scene, Method::Reference, &exact).unwrap();
        let mut curves = Curves::default();
        let offset = scene.displays[0].offsets[0];
        for (textile, placed) in scene.textiles.iter().enumerate() {
            let at = placed.workspace_from_textile.point(PLACE.into());
            let mut rendered = |velocity: Velocity| {
                let pose = Pose {
                    position: Point::new(at.x_mm - offset.x_mm, at.y_mm - offset.y_mm),
                    velocity,
                    ..Pose::default()
                };
                reference.tick(&[pose])[0].amplitude_um(0)
            };
            let probe = Probe::default().with_speed(63.0).with_direction(55.0);
            curves.follow(&ctx, &Executor::InLine, wanted(&inspector, textile, probe));
            let factors = inspector.response(textile).unwrap().factors();
            let mut check = |spread: &PointSpread, velocity: Velocity| {
                let found = spread.scaled(factors).at_place_um.unwrap();
                for (a, b) in found.iter().zip(rendered(velocity)) {
                    assert!((a / b - 1.0).abs() < 1e-9, "{a} for {b} at {velocity:?}");
                }
            };
            let turned = placed.workspace_from_textile.rotation;
            assert_eq!(curves.around().len(), 72);
            for (k, spread) in (0..72_u8).zip(curves.around()) {
                let along = Probe::default().with_direction(5.0 * f64::from(k));
                let own = along.with_speed(63.0).velocity();
                check(spread, turned.turn_velocity(own));
            }
            for (speed, spread) in speeds_mm_per_s().zip(curves.over_speed()) {
                check(spread, probe.with_speed(speed).velocity());
            }
            check(curves.here().unwrap(), probe.velocity());
        }
    }

    #[test]
    fn only_what_depends_on_a_change_is_computed_anew_and_gains_compute_nothing() {
        let ctx = egui::Context::default();
        let mut scene = RenderScene::of(&LoadedScene::shipped().unwrap());
        let mut inspector = ContactInspector::new(&scene);
        let mut curves = Curves::default();
        let probe = Probe::default();
        let mut n_after = |inspector: &ContactInspector, textile, probe| {
            curves.follow(&ctx, &Executor::InLine, wanted(inspector, textile, probe));
            curves.n_computed()
        };
        assert_eq!(n_after(&inspector, 0, probe), 3);
        assert_eq!(n_after(&inspector, 0, probe.with_follow(true)), 3);
        assert_eq!(n_after(&inspector, 0, probe.with_speed(20.0)), 5);
        assert_eq!(n_after(&inspector, 0, probe.with_direction(20.0)), 8);
        scene.tuning.gain_db = -20.0;
        inspector.set_gains(&scene);
        assert_eq!(n_after(&inspector, 0, probe.with_direction(20.0)), 8);
        assert_eq!(n_after(&inspector, 1, probe.with_direction(20.0)), 11);
    }

    #[test]
    fn a_thread_computes_the_curves_of_another_textile_and_none_is_shown_meanwhile() {
        let ctx = egui::Context::default();
        let threads = Executor::Threads(ctx.clone());
        let scene = RenderScene::of(&LoadedScene::shipped().unwrap());
        let inspector = ContactInspector::new(&scene);
        let mut curves = Curves::default();
        for textile in [0, 1] {
            let wanted = || wanted(&inspector, textile, Probe::default());
            curves.follow(&ctx, &threads, wanted());
            assert!(curves.around().is_empty() && curves.here().is_none());
            while curves.here().is_none() {
                curves.follow(&ctx, &threads, wanted());
                std::thread::yield_now();
            }
            assert_eq!(curves.over_speed().len(), usize::from(N_SPEEDS));
        }
        assert_eq!(curves.n_computed(), 6);
    }
}
