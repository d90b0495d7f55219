//! Where the contactors of a display touch which textile, and how they move over it.

use super::{Axis, Component, Counters, OUTSIDE, PointIndex};
use crate::geometry::{Displacement, Point, Rotation, Velocity};
use crate::render::{ContactorArray, PlacedSurface};
use crate::scene::Pose;

/// How far outside its left and lower edge a textile is still felt, and how far inside its right
/// and upper edge no longer, mm.
const EDGE_MM: f64 = 1e-6;

/// A placed textile, ready to be asked for contacts.
#[derive(Debug, Clone)]
pub(in crate::render) struct TextilePlan {
    origin: Point,
    textile_from_workspace: Rotation,
    size_mm: [f64; 2],
    /// The spectra of each direction in the pool.
    pub(in crate::render) spectra: [usize; 4],
    /// How places become points, for each direction.
    pub(in crate::render) points: [PointIndex; 4],
}

/// Where a display's centre is in a textile's frame, and how it lies there.
#[derive(Debug, Clone, Copy)]
pub(in crate::render) struct Placing {
    centre: Point,
    textile_from_display: Rotation,
    /// Every contactor lies on the textile.
    is_covered: bool,
}

/// How the contactors of a display move in a textile's frame.
#[derive(Debug, Clone, Copy)]
pub(in crate::render) enum Motion<'a> {
    /// All alike.
    Together(Velocity),
    /// Each its own way: components along warp and weft, mm/s.
    Turning(&'a [f64], &'a [f64]),
}

/// The contacts of one display with one textile in one tick.
#[derive(Debug, Clone, Copy)]
pub(in crate::render) struct Contacts<'a> {
    /// Which textile.
    pub(in crate::render) textile: usize,
    /// Which textile every contactor lies on.
    pub(in crate::render) owners: &'a [u16],
    /// Places along warp and weft of every contactor, mm.
    pub(in crate::render) places_mm: [&'a [f64]; 2],
    /// How they move.
    pub(in crate::render) motion: Motion<'a>,
    /// How many contactors lie on this textile.
    pub(in crate::render) n_contactors: usize,
}

/// What a contactor feels along one axis.
#[derive(Debug, Clone, Copy)]
pub(in crate::render) struct Feel {
    /// Which spectra of the pool.
    pub(in crate::render) spectra: usize,
    /// The point of these spectra that it touches.
    pub(in crate::render) point: usize,
    /// How fast it moves along the axis, mm/s.
    pub(in crate::render) speed_mm_per_s: f64,
}

impl Contacts<'_> {
    /// What a contactor feels along an axis; `None`, counted, where it does not move along it or
    /// too fast.
    #[inline]
    pub(in crate::render) fn feel(
        &self,
        textile: &TextilePlan,
        axis: Axis,
        contactor: usize,
        counters: &mut Counters,
    ) -> Option<Feel> {
        let component = self.component(axis, contactor);
        let Component::Felt {
            speed_mm_per_s,
            is_reverse,
        } = component
        else {
            counters.left_out(component, 1);
            return None;
        };
        let d = axis.direction(is_reverse).index();
        Some(Feel {
            spectra: textile.spectra[d],
            point: textile.points[d].nearest(self.places_mm[axis as usize][contactor]),
            speed_mm_per_s,
        })
    }

    /// Whether a contactor lies on this textile.
    #[inline]
    pub(in crate::render) fn owns(&self, contactor: usize) -> bool {
        usize::from(self.owners[contactor]) == self.textile
    }

    /// Does something with the output of every contactor on this textile.
    #[inline]
    pub(in crate::render) fn for_each_owned<T>(
        &self,
        outputs: &mut [T],
        mut act: impl FnMut(usize, &mut T),
    ) {
        if self.n_contactors == self.owners.len() {
            // Without a question for each, the loop runs several contactors at a time.
            outputs
                .iter_mut()
                .enumerate()
                .for_each(|(i, output)| act(i, output));
        } else {
            let owned = outputs.iter_mut().enumerate().zip(self.owners);
            owned
                .filter(|&(_, &owner)| usize::from(owner) == self.textile)
                .for_each(|((i, output), _)| act(i, output));
        }
    }

    /// The same with the contactor's place along warp and weft, mm.
    #[inline]
    pub(in crate::render) fn for_each_placed<T>(
        &self,
        outputs: &mut [T],
        mut act: impl FnMut([f64; 2], &mut T),
    ) {
        let places = self.places_mm[0].iter().zip(self.places_mm[1]);
        let placed = outputs.iter_mut().zip(places);
        if self.n_contactors == self.owners.len() {
            placed.for_each(|(output, (&u, &w))| act([u, w], output));
        } else {
            let owned = placed.zip(self.owners);
            owned
                .filter(|&(_, &owner)| usize::from(owner) == self.textile)
                .for_each(|((output, (&u, &w)), _)| act([u, w], output));
        }
    }

    /// A contactor's velocity component along an axis.
    #[inline]
    pub(in crate::render) fn component(&self, axis: Axis, contactor: usize) -> Component {
        Component::of(self.velocity_mm_per_s(contactor)[axis as usize])
    }

    /// A contactor's velocity along warp and weft, mm/s.
    #[inline]
    pub(in crate::render) fn velocity_mm_per_s(&self, contactor: usize) -> [f64; 2] {
        match self.motion {
            Motion::Together(velocity) => [velocity.x_mm_per_s, velocity.y_mm_per_s],
            Motion::Turning(along_warp, along_weft) => {
                [along_warp[contactor], along_weft[contactor]]
            }
        }
    }
}

/// A display's contactors, their places on the textile at hand, and who owns each.
#[derive(Debug, Clone)]
pub(in crate::render) struct DisplayPlan {
    x_mm: Vec<f64>,
    y_mm: Vec<f64>,
    radius_mm: f64,
    rotation_deg: f64,
    turned: (f64, Rotation),
    u_mm: Vec<f64>,
    w_mm: Vec<f64>,
    velocity_u: Vec<f64>,
    velocity_w: Vec<f64>,
    pub(in crate::render) owners: Vec<u16>,
    pub(in crate::render) n_owned: usize,
}

impl TextilePlan {
    pub(super) fn new(placed: &PlacedSurface, spectra: [usize; 4]) -> Self {
        let points = crate::surface::Direction::ALL
            .map(|direction| PointIndex::new(placed.surface.spectra(direction).n_points()));
        Self {
            origin: placed.workspace_from_textile.origin,
            textile_from_workspace: placed.workspace_from_textile.rotation.inverse(),
            size_mm: placed.size_mm,
            spectra,
            points,
        }
    }

    /// How a display lies in the textile's frame; `None` when none of its contactors can lie on it.
    pub(in crate::render) fn placing(&self, display: &DisplayPlan, at: Point) -> Option<Placing> {
        let centre = Point::default() + self.textile_from_workspace.turn(at - self.origin);
        let radius = display.radius_mm;
        let reaches =
            |place: f64, extent: f64| place + radius >= -EDGE_MM && place - radius < extent;
        let covers = |place: f64, extent: f64| {
            place - radius >= 0.0 && place + radius < extent - 2.0 * EDGE_MM
        };
        let [width, height] = self.size_mm;
        let is_near = reaches(centre.x_mm, width) && reaches(centre.y_mm, height);
        is_near.then(|| Placing {
            centre,
            textile_from_display: self.textile_from_workspace.after(display.turned.1),
            is_covered: covers(centre.x_mm, width) && covers(centre.y_mm, height),
        })
    }

    fn contains(&self, u_mm: f64, w_mm: f64) -> bool {
        let within = |place: f64, extent: f64| -EDGE_MM <= place && place < extent - EDGE_MM;
        within(u_mm, self.size_mm[0]) && within(w_mm, self.size_mm[1])
    }
}

impl DisplayPlan {
    pub(in crate::render) fn new(array: &ContactorArray) -> Self {
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
        }
    }

    pub(in crate::render) fn n_contactors(&self) -> usize {
        self.owners.len()
    }

    /// Where a contactor sits in the display's own frame; `None` when there is no such contactor.
    pub(in crate::render) fn offset(&self, contactor: usize) -> Option<Displacement> {
        let (x_mm, y_mm) = (self.x_mm.get(contactor)?, self.y_mm.get(contactor)?);
        Some(Displacement::new(*x_mm, *y_mm))
    }

    /// Begins a tick: nobody owns a contactor yet. Returns how the display is turned.
    pub(in crate::render) fn begin(&mut self, path_angle_deg: f64) -> Rotation {
        self.owners.fill(OUTSIDE);
        self.n_owned = 0;
        let angle_deg = self.rotation_deg + path_angle_deg;
        // Sine and cosine only when the angle changed; most strokes do not turn.
        if angle_deg.to_bits() != self.turned.0.to_bits() {
            self.turned = (angle_deg, Rotation::from_degrees(angle_deg));
        }
        self.turned.1
    }

    /// Gives a textile the contactors that lie on it and that nobody above it took. `None` when
    /// there are none.
    pub(in crate::render) fn claim(
        &mut self,
        (textile, number): (&TextilePlan, usize),
        placing: &Placing,
        pose: &Pose,
    ) -> Option<Contacts<'_>> {
        self.place(placing);
        let n_before = self.n_owned;
        #[expect(clippy::cast_possible_truncation, reason = "at most 65,000 textiles")]
        let owner = number as u16;
        if placing.is_covered && n_before == 0 {
            self.owners.fill(owner);
            self.n_owned = self.owners.len();
        } else {
            self.claim_each(textile, owner);
        }
        let n_contactors = self.n_owned - n_before;
        (n_contactors > 0).then(|| {
            let velocity = textile.textile_from_workspace.turn_velocity(pose.velocity);
            let is_turning = pose.angular_rad_per_s != 0.0;
            if is_turning {
                self.move_each(placing, velocity, pose.angular_rad_per_s);
            }
            Contacts {
                textile: number,
                owners: &self.owners,
                places_mm: [&self.u_mm, &self.w_mm],
                motion: if is_turning {
                    Motion::Turning(&self.velocity_u, &self.velocity_w)
                } else {
                    Motion::Together(velocity)
                },
                n_contactors,
            }
        })
    }

    fn claim_each(&mut self, textile: &TextilePlan, owner: u16) {
        let places = self.u_mm.iter().zip(&self.w_mm);
        for (taken, (&u_mm, &w_mm)) in self.owners.iter_mut().zip(places) {
            if *taken == OUTSIDE && textile.contains(u_mm, w_mm) {
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
