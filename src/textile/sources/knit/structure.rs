//! Which stitch stands where: the structures of common weft knits as repeats of stitches.

use crate::recipe::choice;

choice! {
    /// A knitted structure, seen on the side that is touched.
    pub(crate) enum Structure {
        /// Single jersey, face: the legs of the loops make columns of Vs.
        Jersey = "jersey",
        /// Single jersey, back: heads and feet make rows of arcs.
        ReverseJersey = "reverse-jersey",
        /// Rib: one wale of face stitches, one of back stitches.
        Rib11 = "rib-1-1",
        /// Rib: two wales of face stitches, two of back stitches.
        Rib22 = "rib-2-2",
        /// Interlock: two 1×1 ribs that lock; both sides show face stitches, every second wale a
        /// little higher.
        Interlock = "interlock",
        /// Piqué: tuck stitches on every second wale, two courses at a time, seen from the back.
        Pique = "pique",
        /// Jersey back with a loop of pile drawn out of every stitch.
        Terry = "terry",
        /// Jersey back with a float yarn laid in and brushed: the nap comes from the yarn's hairs.
        Fleece = "fleece",
        /// Jersey back with a tuft of cut pile standing on every stitch: plush, velour.
        Plush = "plush",
    }
}

/// What stands out of the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pile {
    /// Loops.
    Loops,
    /// Sheared loops.
    Cut,
}

/// One stitch of a repeat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stitch {
    /// +1: legs in front (face), −1: arcs in front (back).
    pub face: f64,
    /// Height of the stitch, in units of the recipe's relief.
    pub lift: f64,
    /// Shift along the wale, in courses.
    pub shift: f64,
    /// Length of the loop, in units of the recipe's loop height.
    pub length: f64,
}

const FACE: Stitch = Stitch {
    face: 1.0,
    lift: 0.0,
    shift: 0.0,
    length: 1.0,
};
const BACK: Stitch = Stitch { face: -1.0, ..FACE };

impl Structure {
    /// Wales and courses in a repeat.
    pub(crate) fn repeat(self) -> [usize; 2] {
        match self {
            Self::Jersey | Self::ReverseJersey | Self::Terry | Self::Fleece | Self::Plush => [1, 1],
            Self::Rib11 | Self::Interlock => [2, 1],
            Self::Rib22 => [4, 1],
            Self::Pique => [2, 4],
        }
    }

    /// The stitch on a wale of a course.
    pub(crate) fn stitch(self, wale: usize, course: usize) -> Stitch {
        let rib = |is_face: bool| {
            if is_face {
                Stitch { lift: 0.5, ..FACE }
            } else {
                Stitch { lift: -0.5, ..BACK }
            }
        };
        match self {
            Self::Jersey => FACE,
            Self::ReverseJersey | Self::Terry | Self::Fleece | Self::Plush => BACK,
            Self::Rib11 => rib(wale.is_multiple_of(2)),
            Self::Rib22 => rib(wale % 4 < 2),
            Self::Interlock => {
                let shift = if wale.is_multiple_of(2) { 0.1 } else { -0.1 };
                Stitch { shift, ..FACE }
            }
            Self::Pique => {
                // A tuck lies across the loop that it did not knit through: both stand out.
                let is_tuck = wale.is_multiple_of(2) == (course % 4 < 2);
                if is_tuck {
                    Stitch {
                        lift: 0.6,
                        length: 0.95,
                        ..BACK
                    }
                } else {
                    Stitch {
                        lift: -0.4,
                        length: 1.03,
                        ..BACK
                    }
                }
            }
        }
    }

    /// Whether a second bed of loops lies behind the first.
    pub(crate) fn has_second_bed(self) -> bool {
        matches!(self, Self::Interlock)
    }

    /// The pile that stands out of the ground, if any.
    pub(crate) fn pile(self) -> Option<Pile> {
        match self {
            Self::Terry => Some(Pile::Loops),
            Self::Plush => Some(Pile::Cut),
            _ => None,
        }
    }

    /// Whether its fibres were raised on the side that the recipe describes, and only there.
    pub(crate) fn is_brushed(self) -> bool {
        matches!(self, Self::Fleece)
    }
}
