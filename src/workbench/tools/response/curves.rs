//! A textile's amplitudes over direction and over speed, as the Response pane draws them.
//!
//! Computed before gains, so that no slider computes anything; on a thread of its own, and anew
//! only when a curve's own inputs change. Until that is done the last curves stay, unless the
//! textile is another.

use eframe::egui;

use crate::bench::job::{Job, Polled};
use crate::bench::probe::{Probe, SPEEDS_MM_PER_S};
use selvedge_foundation::geometry::Velocity;
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

/// The curves as they were last computed.
#[derive(Debug, Default)]
pub(crate) struct Curves {
    around: Option<Curve>,
    over_speed: Option<Curve>,
    here: Option<Curve>,
    job: Option<Job<Vec<(Kind, Curve)>>>,
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

/// What a curve was computed for, and its values.
#[derive(Debug, Clone)]
struct Curve {
    wanted: Wanted,
    values: Vec<PointSpread>,
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
        let values = match kind {
            Kind::Direction => {
                let speed_mm_per_s = self.probe.speed_mm_per_s;
                self.response
                    .by_direction(speed_mm_per_s, self.points, N_A_QUARTER)
            }
            Kind::Speed => {
                let along = |speed| self.probe.with_speed(speed).velocity();
                speeds_mm_per_s().map(|speed| at(along(speed))).collect()
            }
            Kind::Here => vec![at(self.probe.velocity())],
        };
        Curve {
            wanted: self.clone(),
            values,
        }
    }
}

/// The speeds of a curve, rising, mm/s.
pub(crate) fn speeds_mm_per_s() -> impl Iterator<Item = f64> {
    let [least, most] = SPEEDS_MM_PER_S;
    let share = |i: u8| f64::from(i) / f64::from(N_SPEEDS - 1);
    (0..N_SPEEDS).map(move |i| least * (most / least).powf(share(i)))
}

impl Curves {
    /// Has the curves as they are wanted, at once or as soon as a thread has computed them.
    pub(crate) fn catch_up(&mut self, ctx: &egui::Context, wanted: Wanted, is_at_once: bool) {
        self.take();
        let wanted = Wanted {
            response: wanted.response.without_gains(),
            ..wanted
        };
        let kinds = [Kind::Direction, Kind::Speed, Kind::Here];
        let mut stale = Vec::new();
        for kind in kinds {
            let place = self.place(kind);
            let is_other = |curve: &Curve| !curve.wanted.is_same_cloth(&wanted);
            if place.as_ref().is_some_and(is_other) {
                *place = None;
            }
            let is_same = |curve: &Curve| curve.wanted.is_same(&wanted, kind);
            if !place.as_ref().is_some_and(is_same) {
                stale.push(kind);
            }
        }
        if stale.is_empty() || self.job.is_some() {
            return;
        }
        self.n_computed += stale.len() as u64;
        let work = move || -> Vec<(Kind, Curve)> {
            let computed = |kind| (kind, wanted.computed(kind));
            stale.into_iter().map(computed).collect()
        };
        if is_at_once {
            self.put(work());
        } else {
            // Without a thread the curves stay as they were; the next frame asks again.
            self.job = Job::start("selvedge-curves", ctx, work).ok();
        }
    }

    fn take(&mut self) {
        match self.job.as_ref().map(Job::poll) {
            Some(Polled::Done(curves)) => {
                self.job = None;
                self.put(curves);
            }
            Some(Polled::BrokeOff) => self.job = None,
            Some(Polled::Working) | None => {}
        }
    }

    fn put(&mut self, curves: Vec<(Kind, Curve)>) {
        for (kind, curve) in curves {
            *self.place(kind) = Some(curve);
        }
    }

    fn place(&mut self, kind: Kind) -> &mut Option<Curve> {
        match kind {
            Kind::Direction => &mut self.around,
            Kind::Speed => &mut self.over_speed,
            Kind::Here => &mut self.here,
        }
    }

    /// Amplitudes before gains over the direction of movement, evenly apart all around,
    /// counter-clockwise from the warp; empty until they are computed.
    pub(crate) fn around(&self) -> &[PointSpread] {
        values(self.around.as_ref())
    }

    /// The same over [`speeds_mm_per_s`].
    pub(crate) fn over_speed(&self) -> &[PointSpread] {
        values(self.over_speed.as_ref())
    }

    /// The same at the chosen velocity itself.
    pub(crate) fn here(&self) -> Option<&PointSpread> {
        values(self.here.as_ref()).first()
    }

    /// Curves computed so far: it stands still while nothing changes or nobody looks.
    pub(crate) fn n_computed(&self) -> u64 {
        self.n_computed
    }
}

fn values(curve: Option<&Curve>) -> &[PointSpread] {
    curve.map_or(&[], |curve| &curve.values)
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
            curves.catch_up(&ctx, wanted(&inspector, textile, probe), true);
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
            curves.catch_up(&ctx, wanted(inspector, textile, probe), true);
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
        let scene = RenderScene::of(&LoadedScene::shipped().unwrap());
        let inspector = ContactInspector::new(&scene);
        let mut curves = Curves::default();
        for textile in [0, 1] {
            let wanted = || wanted(&inspector, textile, Probe::default());
            curves.catch_up(&ctx, wanted(), false);
            assert!(curves.around().is_empty() && curves.here().is_none());
            while curves.here().is_none() {
                curves.catch_up(&ctx, wanted(), false);
                std::thread::yield_now();
            }
            assert_eq!(curves.over_speed().len(), usize::from(N_SPEEDS));
        }
        assert_eq!(curves.n_computed(), 6);
    }
}
