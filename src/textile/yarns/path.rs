//! Yarns and fibres as bent tubes, and a patch of textile made of them.
//!
//! A yarn is a polyline of its centre with a racetrack section: a flat middle and round flanks.
//! Twist shows as ridges that run around the surface of the yarn.

/// A place on the centre line of a yarn, and the section there.
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
pub(crate) struct YarnPath {
    /// The centre line. It may leave the patch: the textile repeats.
    pub nodes: Vec<Node>,
    /// Share of the width that is flat, 0 (elliptic) to 0.9.
    pub(crate) flatness: f64,
    /// Depth of the twist ridges, µm.
    pub(crate) ridge_um: f64,
    /// Colour, red, green, blue 0…1.
    pub colour: [f64; 3],
}

/// A patch of textile that repeats after its size in both directions.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct YarnGeometry {
    /// Along the warp and along the weft, mm.
    pub size_mm: [f64; 2],
    /// All yarns; where they overlap the highest is seen.
    pub(crate) paths: Vec<YarnPath>,
    /// What lies beneath the textile, µm.
    pub floor_um: f64,
}

/// Turns yarns over about the warp: what was below is above, and the weft runs the other way.
/// Twist keeps its sense: a helix has the same hand from either side.
pub(crate) fn turn_over(paths: &mut [YarnPath], width_mm: f64) {
    for node in paths.iter_mut().flat_map(|path| &mut path.nodes) {
        node.z_um = -node.z_um;
        node.w_mm = width_mm - node.w_mm;
    }
}

impl YarnGeometry {
    /// The lowest that a yarn reaches, µm; 0 without yarns.
    pub(crate) fn lowest_um(&self) -> f64 {
        let nodes = self.paths.iter().flat_map(|path| &path.nodes);
        let bottoms = nodes.map(|node| node.z_um - node.half_thickness_um);
        bottoms.fold(0.0, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cloth_that_is_turned_twice_lies_as_before() {
        let node = Node {
            u_mm: 1.0,
            w_mm: 0.25,
            z_um: 30.0,
            half_width_mm: 0.1,
            half_thickness_um: 50.0,
            twist_rad: 0.5,
        };
        let path = YarnPath {
            nodes: vec![node],
            flatness: 0.0,
            ridge_um: 5.0,
            colour: [1.0; 3],
        };
        let mut paths = vec![path.clone()];
        turn_over(&mut paths, 2.0);
        let turned = paths[0].nodes[0];
        assert_eq!((turned.z_um, turned.w_mm), (-30.0, 1.75));
        assert_eq!(turned.u_mm, node.u_mm, "turned about the warp");
        turn_over(&mut paths, 2.0);
        assert_eq!(paths, [path]);
    }
}
