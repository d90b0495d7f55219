//! Yarns and fibres as bent tubes, and a patch of cloth made of them.
//!
//! A strand is a polyline of its centre with a racetrack section: a flat middle and round flanks.
//! Twist shows as ridges that run around the surface of the yarn.

/// A place on the centre line of a strand, and the section there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Node {
    /// Along the warp, mm.
    pub u_mm: f64,
    /// Along the weft, mm.
    pub w_mm: f64,
    /// Height of the centre, µm.
    pub(crate) z_um: f64,
    /// Half the width of the section, mm.
    pub(crate) half_width_mm: f64,
    /// Half the thickness of the section, µm.
    pub(crate) half_thickness_um: f64,
    /// Phase of the twist ridges, radians.
    pub(crate) twist_rad: f64,
}

/// A yarn or a fibre.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Strand {
    /// The centre line. It may leave the patch: the cloth repeats.
    pub nodes: Vec<Node>,
    /// Share of the width that is flat, 0 (elliptic) to 0.9.
    pub(crate) flatness: f64,
    /// Depth of the twist ridges, µm.
    pub(crate) ridge_um: f64,
    /// Colour, red, green, blue 0…1.
    pub colour: [f64; 3],
}

/// A patch of cloth that repeats after its size in both directions.
#[derive(Debug, Clone, PartialEq)]
pub struct Cloth {
    /// Along the warp and along the weft, mm.
    pub size_mm: [f64; 2],
    /// All strands; where they overlap the highest is seen.
    pub(crate) strands: Vec<Strand>,
    /// What lies beneath the cloth, µm.
    pub floor_um: f64,
}
