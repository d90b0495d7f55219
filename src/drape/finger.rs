//! A finger on the cloth: a proxy that a spring pulls to where the hand wants it, and its pad.
//!
//! What points of the pad touch is found anew at every Newton step and held during its line search.
//! Friction holds each point by a spring to an anchor in the cloth; the anchor slips where the
//! spring pulls more than friction holds, and only that is felt as motion.

use super::coupling::{Coupling, led};
use super::mesh::{Mesh, Vector};
use super::pad::{self, POINT_M2, PULP_PA_PER_M, Pulp, REACH_M};
use super::place::{Spot, find};
use super::precondition::LinePreconditioner;
use super::sheet::{Energy, Lag};

/// Stiffness of a point along the cloth, Pa/m.
const ALONG_PA_PER_M: f64 = 0.5 * PULP_PA_PER_M;
/// A point under less than this feels nothing, Pa.
const LEAST_PA: f64 = 50.0;

/// A finger.
#[derive(Debug, Clone)]
pub(crate) struct Finger {
    /// Its proxy among the nodes.
    node: usize,
    /// Where the hand wants it, m, and how fast that moves, m/s.
    pub(crate) target: Vector,
    target_speed: Vector,
    /// The side of the cloth that it is on by itself, and the one that it came to: +1 is the face.
    own_side: f64,
    side: Option<f64>,
    /// Where its lowest point is above the cloth.
    below: Option<Spot>,
    pub(crate) points: Vec<Point>,
    pulp: Pulp,
    pub(crate) friction: f64,
    half_thickness_m: f64,
    pub(crate) coupling: Coupling,
    /// Whether it pressed when last asked.
    pressed: bool,
    /// Whether it is only led: it touches nothing, and nothing pulls at the hand.
    is_led_only: bool,
}

/// A point of the pad.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Point {
    offset: Vector,
    /// What it is above, with the cloth's normal there.
    pub(crate) spot: Option<Spot>,
    /// Where it holds on to the cloth.
    pub(crate) anchor: Option<Spot>,
    /// How far the anchor slipped along warp and weft since it was last asked, m.
    pub(crate) slipped_m: [f64; 2],
    pub(crate) pressure_pa: f64,
    /// What friction can hold in this Newton step, N.
    holds_n: f64,
    normal_tangent: f64,
    /// Tangent along the cloth, and its direction of slip if it slips.
    along: (f64, Option<Vector>),
}

impl Finger {
    /// Stiffness that its points add at most, Pa/m: across and along the cloth.
    pub(crate) const STIFFNESS_PA_PER_M: f64 = PULP_PA_PER_M + ALONG_PA_PER_M;

    pub(crate) fn new(
        node: usize,
        (own_side, rotation_deg): (f64, f64),
        fabric: &super::fabric::Fabric,
        start: Vector,
    ) -> Self {
        let point = |offset| Point {
            offset,
            spot: None,
            anchor: None,
            slipped_m: [0.0; 2],
            pressure_pa: 0.0,
            holds_n: 0.0,
            normal_tangent: 0.0,
            along: (0.0, None),
        };
        Self {
            node,
            target: start,
            target_speed: Vector::zeros(),
            own_side,
            side: None,
            below: None,
            points: pad::points(rotation_deg).map(point).collect(),
            pulp: Pulp::new(&fabric.compression),
            friction: fabric.friction,
            half_thickness_m: 0.5 * fabric.compression.thickness_m,
            coupling: Coupling::default(),
            pressed: false,
            is_led_only: false,
        }
    }

    /// Lets it touch nothing from now on.
    pub(crate) fn lead_only(&mut self) {
        self.is_led_only = true;
    }

    /// Goes on where a finger of the same form is, with all that it holds.
    pub(crate) fn take_up(&mut self, other: &Self) {
        (self.target, self.side, self.below) = (other.target, other.side, other.below);
        self.pressed = other.pressed;
        self.points.clone_from(&other.points);
    }

    /// Leads it towards a place over a step, not faster than it may. A place that is no number
    /// leaves it where it is.
    pub(crate) fn lead(&mut self, to: Vector, step_s: f64) {
        let moved = led(self.target, to, step_s);
        self.target += moved;
        self.target_speed = moved / step_s;
    }

    /// Work that the hand did in the step that ends, J.
    pub(crate) fn work_j(&self, step_s: f64) -> f64 {
        -self.coupling.force.dot(&self.target_speed) * step_s
    }

    /// Begins a step: the coupling's spring and damper become one spring.
    pub(crate) fn begin(&mut self, lag: &Lag) {
        if self.is_led_only {
            return;
        }
        let hand = (self.target, self.target_speed);
        self.coupling = Coupling::new(hand, lag.hat[self.node], lag.sigma);
    }

    /// Where its pad begins to touch on its own side, if it stands just behind the cloth.
    pub(crate) fn cleared(&self, mesh: &Mesh, x: &[Vector]) -> Option<Vector> {
        let apex = x[self.node];
        let below = find(mesh, x, apex, None)?;
        let normal = below.normal * self.own_side;
        let gap = normal.dot(&(apex - below.at(x)));
        let is_behind = gap <= 0.0 && gap > -2.0 * REACH_M;
        is_behind.then(|| apex + normal * (self.half_thickness_m - gap))
    }

    /// Finds what it touches; says whether that is anything.
    pub(crate) fn look(&mut self, mesh: &Mesh, x: &[Vector]) -> bool {
        if self.is_led_only {
            return false;
        }
        let apex = x[self.node];
        self.below = find(mesh, x, apex, self.below.map(|spot| spot.place));
        let gap = self.below.map(|spot| spot.normal.dot(&(apex - spot.at(x))));
        self.side = match gap {
            // It keeps the side that it came from until it is away.
            Some(gap) if gap.abs() < 2.0 * REACH_M => self.side.or_else(|| {
                let is_clear = gap.abs() > self.half_thickness_m;
                Some(if is_clear {
                    gap.signum()
                } else {
                    self.own_side
                })
            }),
            _ => None,
        };
        let mut touches = false;
        for point in &mut self.points {
            let Some((side, below)) = self.side.zip(self.below) else {
                (point.spot, point.anchor, point.pressure_pa) = (None, None, 0.0);
                continue;
            };
            let at = apex + point.offset_on(side);
            let warm = point.spot.map_or(below.place, |spot| spot.place);
            point.spot = find(mesh, x, at, Some(warm));
            let pressure = point.spot.map_or(0.0, |spot| {
                let overlap = self.half_thickness_m - side * spot.normal.dot(&(at - spot.at(x)));
                self.pulp.at(overlap)[1]
            });
            point.pressure_pa = pressure;
            point.holds_n = self.friction * pressure * POINT_M2;
            touches |= pressure > 0.0;
        }
        touches
    }

    pub(crate) fn evaluate(&mut self, x: &[Vector], grad: &mut [Vector]) -> Energy {
        let mut energy = self.couple(x, grad);
        let Some(side) = self.side else {
            return energy;
        };
        for point in &mut self.points {
            let at = x[self.node] + point.offset_on(side);
            let Some(spot) = point.spot else {
                (point.normal_tangent, point.along) = (0.0, (0.0, None));
                continue;
            };
            let normal = spot.normal * side;
            let overlap = self.half_thickness_m - normal.dot(&(at - spot.at(x)));
            let [stored, pressure, slope] = self.pulp.at(overlap);
            point.pressure_pa = pressure;
            point.normal_tangent = POINT_M2 * slope;
            energy.stored += POINT_M2 * stored;
            let push = normal * (POINT_M2 * pressure);
            grad[self.node] -= push;
            spot.add(grad, push);
            point.along = (0.0, None);
            if let Some(anchor) = point.anchor {
                let (part, force) = point.rub(at - anchor.at(x));
                energy += part;
                grad[self.node] += force;
                anchor.add(grad, -force);
            }
        }
        energy
    }

    /// The coupling's energy: what the spring holds is stored, the rest is damping's.
    fn couple(&mut self, x: &[Vector], grad: &mut [Vector]) -> Energy {
        if self.is_led_only {
            return Energy::default();
        }
        let value = self.coupling.pull(x[self.node]);
        grad[self.node] += self.coupling.force;
        let stored = Coupling::stored_j((x[self.node] - self.target).norm());
        Energy {
            stored,
            lost: value - stored,
        }
    }

    pub(crate) fn product(&self, p: &[Vector], out: &mut [Vector]) {
        out[self.node] += p[self.node] * self.coupling.tangent;
        for point in &self.points {
            let Some(spot) = point.spot.filter(|_| point.normal_tangent > 0.0) else {
                continue;
            };
            let normal = spot.normal;
            let pressed = normal.dot(&(p[self.node] - spot.at(p)));
            let push = normal * (point.normal_tangent * pressed);
            out[self.node] += push;
            spot.add(out, -push);
            if let (Some(anchor), (tangent, slips)) = (point.anchor, point.along)
                && tangent > 0.0
            {
                let moved = p[self.node] - anchor.at(p);
                let mut along = moved - normal * normal.dot(&moved);
                if let Some(direction) = slips {
                    along -= direction * direction.dot(&along);
                }
                let force = along * tangent;
                out[self.node] += force;
                anchor.add(out, -force);
            }
        }
    }

    pub(crate) fn precondition(&self, proxy: usize, lines: &mut LinePreconditioner) {
        let mut own = Vector::repeat(self.coupling.tangent);
        for point in &self.points {
            if let Some(spot) = point.spot.filter(|_| point.normal_tangent > 0.0) {
                own += spot.normal.map(|axis| axis * axis * point.normal_tangent);
                for (vertex, weight) in spot.shares() {
                    lines.add_normal(vertex, weight * weight * point.normal_tangent);
                }
                if let Some(anchor) = point.anchor {
                    own += spot.normal.map(|axis| (1.0 - axis * axis) * point.along.0);
                    for (vertex, weight) in anchor.shares() {
                        lines.add_everywhere(vertex, weight * weight * point.along.0);
                    }
                }
            }
        }
        lines.add_proxy(proxy, own);
    }

    /// Ends a step: anchors slip to where friction holds them, new ones are set, and those of
    /// points that left are given up.
    pub(crate) fn settle(&mut self, mesh: &Mesh, x: &[Vector]) {
        self.look(mesh, x);
        let Some(side) = self.side else { return };
        for point in &mut self.points {
            let at = x[self.node] + point.offset_on(side);
            let touched = point.spot.filter(|_| point.pressure_pa > 0.0);
            point.anchor = touched.and_then(|spot| match point.anchor {
                None => Some(spot),
                Some(anchor) => point.slip(mesh, x, (anchor, at)),
            });
        }
    }

    /// Force on the hand, N.
    pub(crate) fn force_n(&self) -> Vector {
        self.coupling.force
    }

    /// Force of the pad on the cloth along its normals, N.
    pub(crate) fn press_n(&self) -> f64 {
        self.points
            .iter()
            .map(|point| POINT_M2 * point.pressure_pa)
            .sum()
    }

    /// Whether it touches the cloth and did not when last asked.
    pub(crate) fn has_come(&mut self) -> bool {
        let presses = self.press_n() > 0.0;
        !std::mem::replace(&mut self.pressed, presses) && presses
    }

    /// Unit normal of the cloth below it, towards the finger; `None` where it touches nothing.
    pub(crate) fn normal(&self) -> Option<Vector> {
        let touched = self.points.iter().filter_map(|point| {
            let spot = point.spot?;
            Some(spot.normal * point.pressure_pa)
        });
        let sum: Vector = touched.sum();
        Some(sum.try_normalize(0.0)? * self.side?)
    }

    /// Whether it is on the back of the cloth.
    pub(crate) fn is_behind(&self) -> bool {
        self.side.unwrap_or(self.own_side) < 0.0
    }

    /// Whether it is so near that the cloth has to be awake.
    pub(crate) fn is_near(&self) -> bool {
        self.side.is_some()
    }

    /// Stiffness over mass that its points add at most where they touch, 1/s².
    pub(crate) fn stiffness_per_kg(&self, density_kg_per_m2: f64) -> f64 {
        let touches = self.points.iter().any(|point| point.spot.is_some());
        if touches {
            Self::STIFFNESS_PA_PER_M / density_kg_per_m2
        } else {
            0.0
        }
    }
}

impl Point {
    /// Whether what it moves over is felt.
    pub(crate) fn is_felt(&self) -> bool {
        self.spot.is_some() && self.pressure_pa >= LEAST_PA
    }

    fn offset_on(&self, side: f64) -> Vector {
        Vector::new(self.offset.x, self.offset.y, side * self.offset.z)
    }

    /// Friction's part at so much from the anchor: its energy, and the force on the finger's node.
    fn rub(&mut self, from_anchor: Vector) -> (Energy, Vector) {
        let Some(spot) = self.spot else {
            return (Energy::default(), Vector::zeros());
        };
        let along = from_anchor - spot.normal * spot.normal.dot(&from_anchor);
        let (stiffness, length) = (ALONG_PA_PER_M * POINT_M2, along.norm());
        if stiffness * length <= self.holds_n {
            self.along = (stiffness, None);
            let stored = 0.5 * stiffness * length * length;
            return (Energy { stored, lost: 0.0 }, along * stiffness);
        }
        let reach = self.holds_n / stiffness;
        self.along = (self.holds_n / length, Some(along / length));
        let energy = Energy {
            stored: 0.5 * self.holds_n * reach,
            lost: self.holds_n * (length - reach),
        };
        (energy, along * (self.holds_n / length))
    }

    /// Where an anchor is held after a step; `None` off the cloth.
    fn slip(&mut self, mesh: &Mesh, x: &[Vector], (anchor, at): (Spot, Vector)) -> Option<Spot> {
        let spot = self.spot?;
        let off = at - anchor.at(x);
        let along = off - spot.normal * spot.normal.dot(&off);
        let held = self.holds_n / (ALONG_PA_PER_M * POINT_M2);
        let over = along.norm() - held;
        if over <= 0.0 {
            return Some(anchor);
        }
        let moved = anchor.material(mesh, x, along * (over / along.norm()))?;
        let place = [0, 1].map(|axis| anchor.place[axis] + moved[axis]);
        (0..2).for_each(|axis| self.slipped_m[axis] += moved[axis]);
        Spot::new(mesh, x, place)
    }
}
