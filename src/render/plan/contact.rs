//! Where the contactors of a display touch which textile, and how they move over it.

use std::sync::Arc;

use super::counters::Counters;
use super::motion::{Axis, Component};
use super::point::PointGrid;
use crate::PlacedSurface;
use crate::scene::{EDGE_MM, is_on};
use selvedge_foundation::geometry::{Displacement, Frame, Point, Rotation, Velocity};
use selvedge_textile::surface::Surface;

/// No textile: the contactor lies outside.
pub(crate) const OUTSIDE: u16 = u16::MAX;

/// Where a placed textile lies, whatever it is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ground {
    origin: Point,
    pub(crate) textile_from_workspace: Rotation,
    size_mm: [f64; 2],
    within_mm: Option<[Point; 2]>,
}

/// A placed textile, ready to be asked for contacts.
#[derive(Debug, Clone)]
pub(crate) struct TextilePlan {
    pub(crate) ground: Ground,
    pub(crate) surface: Arc<Surface>,
    /// The spectra of each direction in the pool.
    pub spectra: [usize; 4],
    /// How places become points, for each direction.
    pub points: [PointGrid; 4],
}

/// How the contactors of a display move in a textile's frame.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Motion<'a> {
    /// All alike.
    Together(Velocity),
    /// Each its own way: components along warp and weft, mm/s.
    Turning(&'a [f64], &'a [f64]),
}

/// The contacts of one display with one textile in one tick.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Contacts<'a> {
    /// Which textile.
    pub textile: usize,
    /// Which textile every contactor lies on.
    pub(crate) owners: &'a [u16],
    /// Places along warp and weft of every contactor, mm.
    pub places_mm: [&'a [f64]; 2],
    /// How they move.
    pub motion: Motion<'a>,
    /// How many contactors lie on this textile.
    pub n_contactors: usize,
}

/// What a contactor feels along one axis.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Feel {
    /// Which spectra of the pool.
    pub spectra: usize,
    /// The point of these spectra that it touches.
    pub point: usize,
    /// How fast it moves along the axis, mm/s.
    pub speed_mm_per_s: f64,
}

impl Contacts<'_> {
    /// What a contactor feels along an axis; `None`, counted, where it does not move along it or
    /// too fast.
    #[inline]
    pub(crate) fn feel(
        &self,
        textile: &TextilePlan,
        axis: Axis,
        contactor: usize,
        counters: &mut Counters,
    ) -> Option<Feel> {
        let (d, speed_mm_per_s) = self.felt(axis, contactor, 1, counters)?;
        let [u_mm, w_mm] = self.places_mm.map(|places_mm| places_mm[contactor]);
        let point = match axis {
            Axis::Warp => textile.points[d].nearest(u_mm, w_mm),
            Axis::Weft => textile.points[d].nearest(w_mm, u_mm),
        };
        Some(Feel {
            spectra: textile.spectra[d],
            point,
            speed_mm_per_s,
        })
    }

    /// The direction, by its number, in which a contactor is felt to move along an axis, and how
    /// fast, mm/s; `None`, counted for `n` contactors, where it does not move along it or too fast.
    #[inline]
    pub(crate) fn felt(
        &self,
        axis: Axis,
        contactor: usize,
        n: u64,
        counters: &mut Counters,
    ) -> Option<(usize, f64)> {
        match self.component(axis, contactor) {
            Component::Felt {
                speed_mm_per_s,
                is_reverse,
            } => return Some((axis.direction(is_reverse).index(), speed_mm_per_s)),
            Component::AtRest => counters.directions_at_rest += n,
            Component::TooFast => counters.directions_over_speed += n,
        }
        None
    }

    /// Whether a contactor lies on this textile.
    #[inline]
    pub(crate) fn owns(&self, contactor: usize) -> bool {
        usize::from(self.owners[contactor]) == self.textile
    }

    /// Does something with the output of every contactor on this textile.
    #[inline]
    pub(crate) fn for_each_owned<T>(&self, outputs: &mut [T], mut act: impl FnMut(usize, &mut T)) {
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
    pub(crate) fn for_each_placed<T>(
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

    /// The same with the place along an axis, mm, and the velocity along it, mm/s. One loop for
    /// all and for some, so that what is done stands in it once.
    #[inline]
    pub(crate) fn for_each_moving<T>(
        &self,
        (axis, along_mm_per_s): (Axis, &[f64]),
        outputs: &mut [T],
        mut act: impl FnMut(f64, f64, &mut T),
    ) {
        let moving = self.places_mm[axis as usize].iter().zip(along_mm_per_s);
        let is_all = self.n_contactors == self.owners.len();
        for ((output, (&place, &own)), &owner) in outputs.iter_mut().zip(moving).zip(self.owners) {
            if is_all || usize::from(owner) == self.textile {
                act(place, own, output);
            }
        }
    }

    /// A contactor's velocity component along an axis.
    #[inline]
    pub(crate) fn component(&self, axis: Axis, contactor: usize) -> Component {
        Component::of(self.velocity_mm_per_s(contactor)[axis as usize])
    }

    /// A contactor's velocity along warp and weft, mm/s.
    #[inline]
    pub(crate) fn velocity_mm_per_s(&self, contactor: usize) -> [f64; 2] {
        match self.motion {
            Motion::Together(velocity) => [velocity.x_mm_per_s, velocity.y_mm_per_s],
            Motion::Turning(along_warp, along_weft) => {
                [along_warp[contactor], along_weft[contactor]]
            }
        }
    }
}

impl TextilePlan {
    pub(super) fn new(placed: &PlacedSurface, spectra: [usize; 4]) -> Self {
        let points = selvedge_textile::surface::Direction::ALL
            .map(|direction| PointGrid::new(placed.surface.spectra(direction).shape()));
        let frame = placed.workspace_from_textile;
        Self {
            ground: Ground::new(frame, placed.size_mm, placed.within_mm),
            surface: Arc::clone(&placed.surface),
            spectra,
            points,
        }
    }
}

impl Ground {
    pub(crate) fn new(
        workspace_from_textile: Frame,
        size_mm: [f64; 2],
        within_mm: Option<[Point; 2]>,
    ) -> Self {
        Self {
            origin: workspace_from_textile.origin,
            textile_from_workspace: workspace_from_textile.rotation.inverse(),
            size_mm,
            within_mm,
        }
    }

    /// A place of the workspace in the textile's frame.
    pub(crate) fn place_of(&self, at: Point) -> Point {
        Point::default() + self.textile_from_workspace.turn(at - self.origin)
    }

    /// Whether anything within a radius of a place of its frame may lie on it.
    pub(super) fn is_reached(&self, place: Point, radius_mm: f64) -> bool {
        let reaches =
            |place: f64, extent: f64| place + radius_mm >= -EDGE_MM && place - radius_mm < extent;
        let [width, height] = self.size_mm;
        reaches(place.x_mm, width) && reaches(place.y_mm, height)
    }

    /// Whether everything within a radius of a place of its frame lies on it.
    pub(super) fn covers(&self, place: Point, radius_mm: f64) -> bool {
        let covers = |place: f64, extent: f64| {
            place - radius_mm >= 0.0 && place + radius_mm < extent - 2.0 * EDGE_MM
        };
        let [width, height] = self.size_mm;
        self.within_mm.is_none() && covers(place.x_mm, width) && covers(place.y_mm, height)
    }

    pub(crate) fn contains(&self, u_mm: f64, w_mm: f64) -> bool {
        let in_workspace = || {
            let turned = self.textile_from_workspace.inverse();
            self.origin + turned.turn(Displacement::new(u_mm, w_mm))
        };
        let place = Point::new(u_mm, w_mm);
        is_on(place, in_workspace, self.size_mm, self.within_mm)
    }
}
