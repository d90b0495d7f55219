//! Yarns and fibres as bent tubes, and a patch of cloth made of them.
//!
//! A strand is a polyline of its centre with a racetrack section: a flat middle and round flanks.
//! Twist shows as ridges that run around the surface of the yarn.

/// A place on the centre line of a strand, and the section there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Along the warp, mm.
    pub u_mm: f64,
    /// Along the weft, mm.
    pub w_mm: f64,
    /// Height of the centre, µm.
    pub z_um: f64,
    /// Half the width of the section, mm.
    pub half_width_mm: f64,
    /// Half the thickness of the section, µm.
    pub half_thickness_um: f64,
    /// Phase of the twist ridges, radians.
    pub twist_rad: f64,
}

/// A yarn or a fibre.
#[derive(Debug, Clone, PartialEq)]
pub struct Strand {
    /// The centre line. It may leave the patch: the cloth repeats.
    pub nodes: Vec<Node>,
    /// Share of the width that is flat, 0 (elliptic) to 0.9.
    pub flatness: f64,
    /// Depth of the twist ridges, µm.
    pub ridge_um: f64,
    /// Colour, red, green, blue 0…1.
    pub colour: [f64; 3],
}

/// A patch of cloth that repeats after its size in both directions.
#[derive(Debug, Clone, PartialEq)]
pub struct Cloth {
    /// Along the warp and along the weft, mm.
    pub size_mm: [f64; 2],
    /// All strands; where they overlap the highest is seen.
    pub strands: Vec<Strand>,
    /// What lies beneath the cloth, µm.
    pub floor_um: f64,
}
