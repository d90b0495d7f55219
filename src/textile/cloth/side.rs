//! Which side of a cloth is touched: the same yarns, seen and felt from above or from below.

use serde::{Deserialize, Serialize};

use super::strand::{Cloth, Strand};

/// The side that is touched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// The side that the recipe describes.
    #[default]
    Face,
    /// The other side of the same cloth.
    Back,
}

impl Side {
    /// Whether it is the side that the recipe describes.
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
    pub(crate) fn is_face(&self) -> bool {
        *self == Self::Face
    }
}

/// Turns strands over about the warp: what was below is above, and the weft runs the other way.
/// Twist keeps its sense: a helix has the same hand from either side.
pub(crate) fn turn_over(strands: &mut [Strand], width_mm: f64) {
    for node in strands.iter_mut().flat_map(|strand| &mut strand.nodes) {
        node.z_um = -node.z_um;
        node.w_mm = width_mm - node.w_mm;
    }
}

impl Cloth {
    /// The lowest that a strand reaches, µm; 0 without strands.
    pub(crate) fn lowest_um(&self) -> f64 {
        let nodes = self.strands.iter().flat_map(|strand| &strand.nodes);
        let bottoms = nodes.map(|node| node.z_um - node.half_thickness_um);
        bottoms.fold(0.0, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::Node;

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
        let strand = Strand {
            nodes: vec![node],
            flatness: 0.0,
            ridge_um: 5.0,
            colour: [1.0; 3],
        };
        let mut strands = vec![strand.clone()];
        turn_over(&mut strands, 2.0);
        let turned = strands[0].nodes[0];
        assert_eq!((turned.z_um, turned.w_mm), (-30.0, 1.75));
        assert_eq!(turned.u_mm, node.u_mm, "turned about the warp");
        turn_over(&mut strands, 2.0);
        assert_eq!(strands, [strand]);
    }
}
