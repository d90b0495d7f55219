//! A display's contactors in a tick: where they lie on the textile at hand, and who owns each.

use std::ops::Range;

use super::contact::{Contacts, Ground, Motion, OUTSIDE};
use super::counters::Counters;
use crate::ContactorArray;
use crate::scene::Pose;
use selvedge_foundation::geometry::{Displacement, Point, Rotation, Velocity};
use selvedge_textile::tactile::MIN_SPEED_MM_PER_S;

/// A display's contactors, their places on the textile at hand, and who owns each.
#[derive(Debug, Clone)]
pub(crate) struct DisplayPlan {
    x_mm: Vec<f64>,
    y_mm: Vec<f64>,
    radius_mm: f64,
    rotation_deg: f64,
    turned: (f64, Rotation),
    u_mm: Vec<f64>,
    w_mm: Vec<f64>,
    velocity_u: Vec<f64>,
    velocity_w: Vec<f64>,
    pub(crate) owners: Vec<u16>,
    pub n_owned: usize,
    /// Where and how turned it rested in the last tick; `None` if it moved.
    rested: Option<(Point, f64)>,
    /// The one textile that it feels, whatever lies upon it; `None`: all of them.
    uncovered: Option<usize>,
}

/// What a contactor touches by itself, where no pose tells it: of a cloth that is no plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaterialContact {
    /// The place on the cloth along its warp and weft, mm.
    pub place_mm: [f64; 2],
    /// How fast the contactor slips over it along warp and weft, mm/s of the cloth's own length.
    pub velocity_mm_per_s: [f64; 2],
}

/// Where a display's centre is in a textile's frame, and how it lies there.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Placing {
    centre: Point,
    textile_from_display: Rotation,
    /// Every contactor lies on the textile.
    pub(crate) is_covered: bool,
}

impl DisplayPlan {
    pub(crate) fn new(array: &ContactorArray) -> Self {
        let zeros = vec![0.0; array.offsets.len()];
        let longest = |far: f64, by: &Displacement| far.max(by.length_mm());
        // A hair more than the farthest contactor, for what turning rounds.
        let radius_mm = array.offsets.iter().fold(0.0, longest) * (1.0 + 1e-12) + 1e-9;
        Self {
            x_mm: array.offsets.iter().map(|by| by.x_mm).collect(),
            y_mm: array.offsets.iter().map(|by| by.y_mm).collect(),
            radius_mm,
            rotation_deg: array.rotation_deg,
            turned: (
                array.rotation_deg,
                Rotation::from_degrees(array.rotation_deg),
            ),
            u_mm: zeros.clone(),
            w_mm: zeros.clone(),
            velocity_u: zeros.clone(),
            velocity_w: zeros,
            owners: vec![OUTSIDE; array.offsets.len()],
            n_owned: 0,
            rested: None,
            uncovered: None,
        }
    }

    pub(crate) fn n_contactors(&self) -> usize {
        self.owners.len()
    }

    /// Where a contactor sits in the display's own frame; `None` when there is no such contactor.
    pub(crate) fn offset(&self, contactor: usize) -> Option<Displacement> {
        let (x_mm, y_mm) = (self.x_mm.get(contactor)?, self.y_mm.get(contactor)?);
        Some(Displacement::new(*x_mm, *y_mm))
    }

    /// Whether the display rests where it rested the tick before: then its frame stands, silent as
    /// it is, whatever became of gains. Counted.
    pub(crate) fn stands(&mut self, pose: &Pose, counters: &mut Counters) -> bool {
        let rested = is_at_rest(pose).then_some((pose.position, pose.angle_deg));
        let before = std::mem::replace(&mut self.rested, rested);
        let (Some(before), Some(now)) = (before, rested) else {
            return false;
        };
        let bits = |(at, angle_deg): (Point, f64)| [at.x_mm, at.y_mm, angle_deg].map(f64::to_bits);
        let stands = bits(before) == bits(now);
        if stands {
            counters.displays_standing += 1;
            counters.directions_at_rest += 2 * self.n_owned as u64;
        }
        stands
    }

    /// Whether textiles beneath those that were claimed need not be asked.
    pub(crate) fn is_taken(&self) -> bool {
        self.n_owned == self.owners.len()
    }

    /// Forgets where it rested: its frame is no longer that of the last tick.
    pub(crate) fn forget(&mut self) {
        self.rested = None;
    }

    /// Feels one textile alone, or all.
    pub(crate) fn uncover(&mut self, textile: Option<usize>) {
        if std::mem::replace(&mut self.uncovered, textile) != textile {
            self.forget();
        }
    }

    /// Which of so many textiles it may feel: their places in the list.
    pub(crate) fn felt(&self, n_textiles: usize) -> Range<usize> {
        self.uncovered
            .map_or(0..n_textiles, |one| one..n_textiles.min(one + 1))
    }

    /// Begins a tick: nobody owns a contactor yet. Returns how the display is turned.
    pub(crate) fn begin(&mut self, path_angle_deg: f64, counters: &mut Counters) -> Rotation {
        self.owners.fill(OUTSIDE);
        self.n_owned = 0;
        let angle_deg = self.rotation_deg + path_angle_deg;
        // Sine and cosine only when the angle changed; most strokes do not turn.
        if angle_deg.to_bits() == self.turned.0.to_bits() {
            counters.angles_repeated += 1;
        } else {
            self.turned = (angle_deg, Rotation::from_degrees(angle_deg));
        }
        self.turned.1
    }

    /// How the display lies in a textile's frame; `None` when none of its contactors can lie on it.
    pub(crate) fn placing(&self, ground: &Ground, at: Point) -> Option<Placing> {
        let centre = ground.place_of(at);
        ground.is_reached(centre, self.radius_mm).then(|| Placing {
            centre,
            textile_from_display: ground.textile_from_workspace.after(self.turned.1),
            is_covered: ground.covers(centre, self.radius_mm),
        })
    }

    /// Gives a textile the contactors that lie on it and that nobody above it took. `None` when
    /// there are none.
    pub(crate) fn claim(
        &mut self,
        (ground, number): (&Ground, usize),
        placing: &Placing,
        pose: &Pose,
        counters: &mut Counters,
    ) -> Option<Contacts<'_>> {
        self.place(placing);
        let n_before = self.n_owned;
        let owner = owner_of(number);
        if placing.is_covered && n_before == 0 {
            self.owners.fill(owner);
            self.n_owned = self.owners.len();
            counters.touches_covered += self.n_owned as u64;
        } else {
            self.claim_each(ground, owner);
        }
        let n_contactors = self.n_owned - n_before;
        counters.touches_beneath += n_before as u64;
        counters.touches_outside += (self.owners.len() - self.n_owned) as u64;
        (n_contactors > 0).then(|| {
            let motion = self.set_in_motion(ground, placing, pose);
            let each = Motion::Turning(&self.velocity_u, &self.velocity_w);
            Contacts {
                textile: number,
                owners: &self.owners,
                places_mm: [&self.u_mm, &self.w_mm],
                motion: motion.map_or(each, Motion::Together),
                n_contactors,
            }
        })
    }

    /// Gives a textile the contactors that touch it by themselves; `None` when there are none.
    pub(crate) fn lay(
        &mut self,
        number: usize,
        contacts: &[Option<MaterialContact>],
    ) -> Option<Contacts<'_>> {
        self.forget();
        self.owners.fill(OUTSIDE);
        self.n_owned = 0;
        for (contactor, contact) in contacts.iter().take(self.owners.len()).enumerate() {
            let Some(contact) =
                contact.filter(|contact| contact.place_mm.iter().all(|mm| mm.is_finite()))
            else {
                continue;
            };
            [self.u_mm[contactor], self.w_mm[contactor]] = contact.place_mm;
            let velocity = contact.velocity_mm_per_s;
            [self.velocity_u[contactor], self.velocity_w[contactor]] = velocity;
            self.owners[contactor] = owner_of(number);
            self.n_owned += 1;
        }
        (self.n_owned > 0).then(|| Contacts {
            textile: number,
            owners: &self.owners,
            places_mm: [&self.u_mm, &self.w_mm],
            motion: Motion::Turning(&self.velocity_u, &self.velocity_w),
            n_contactors: self.n_owned,
        })
    }

    /// How the contactors move in a textile's frame: together, or, with velocities computed for
    /// each, `None`.
    fn set_in_motion(
        &mut self,
        ground: &Ground,
        placing: &Placing,
        pose: &Pose,
    ) -> Option<Velocity> {
        let velocity = ground.textile_from_workspace.turn_velocity(pose.velocity);
        let is_turning = pose.angular_rad_per_s != 0.0;
        if is_turning {
            self.move_each(placing, velocity, pose.angular_rad_per_s);
        }
        (!is_turning).then_some(velocity)
    }

    fn claim_each(&mut self, ground: &Ground, owner: u16) {
        let places = self.u_mm.iter().zip(&self.w_mm);
        for (taken, (&u_mm, &w_mm)) in self.owners.iter_mut().zip(places) {
            if *taken == OUTSIDE && ground.contains(u_mm, w_mm) {
                *taken = owner;
                self.n_owned += 1;
            }
        }
    }

    /// Places of all contactors in a textile's frame: `centre + R·offset`.
    fn place(&mut self, placing: &Placing) {
        let (cos, sin) = placing.textile_from_display.cos_sin();
        let Point { x_mm: u0, y_mm: w0 } = placing.centre;
        let offsets = self.x_mm.iter().zip(&self.y_mm);
        let places = self.u_mm.iter_mut().zip(&mut self.w_mm);
        for ((u, w), (x, y)) in places.zip(offsets) {
            *u = u0 + (cos * x - sin * y);
            *w = w0 + (sin * x + cos * y);
        }
    }

    /// Velocities `v + ω × r` of all contactors in a textile's frame.
    fn move_each(&mut self, placing: &Placing, velocity: Velocity, angular_rad_per_s: f64) {
        let (cos, sin) = placing.textile_from_display.cos_sin();
        let offsets = self.x_mm.iter().zip(&self.y_mm);
        let velocities = self.velocity_u.iter_mut().zip(&mut self.velocity_w);
        for ((along_u, along_w), (x, y)) in velocities.zip(offsets) {
            let offset = Displacement::new(cos * x - sin * y, sin * x + cos * y);
            let own = velocity.at_offset(offset, angular_rad_per_s);
            (*along_u, *along_w) = (own.x_mm_per_s, own.y_mm_per_s);
        }
    }
}

/// A textile's place in the list, as contactors name their owner.
#[expect(clippy::cast_possible_truncation, reason = "at most 65,000 textiles")]
fn owner_of(textile: usize) -> u16 {
    textile as u16
}

/// Whether no contactor of a display can feel anything: it does not turn, and whichever way a
/// textile lies, both components stay below the speed of rest.
pub(crate) fn is_at_rest(pose: &Pose) -> bool {
    const LIMIT: f64 = MIN_SPEED_MM_PER_S * (1.0 - 1e-9);
    let [x, y] = [pose.velocity.x_mm_per_s, pose.velocity.y_mm_per_s];
    pose.angular_rad_per_s == 0.0 && x * x + y * y < LIMIT * LIMIT
}

/// The pose, at rest if its motion is not finite, which is counted; `None` if its place is not.
pub(crate) fn finite_pose(pose: &Pose, counters: &mut Counters) -> Option<Pose> {
    let is_placed = pose.position.is_finite() && pose.angle_deg.is_finite();
    let is_moving = pose.velocity.is_finite() && pose.angular_rad_per_s.is_finite();
    counters.poses_not_finite += u64::from(!(is_placed && is_moving));
    is_placed.then(|| if is_moving { *pose } else { pose.at_rest() })
}
