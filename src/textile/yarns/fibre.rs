//! Loose fibres on a textile: hairiness, and the raised nap of a brushed one.

use std::f64::consts::{PI, TAU};

use super::path::{Node, YarnGeometry, YarnPath};
use super::variation::{Field, count};
use super::yarn::Yarn;
use selvedge_foundation::numerics::Random;

/// Straight pieces that an arched fibre is drawn with.
const PIECES: u8 = 5;
/// Size of the patches in which a nap is raised alike, mm.
const CLUMP_MM: f64 = 2.5;

/// Adds the loose fibres of `yarn` to a textile, rooted in the yarns with indices `from`….
pub(crate) fn add_hairs(
    geometry: &mut YarnGeometry,
    from: usize,
    yarn: &Yarn,
    random: &mut Random,
) {
    let area = geometry.size_mm[0] * geometry.size_mm[1];
    let n_hairs = count(yarn.hairs_per_mm2 * area);
    let n_roots = geometry.paths.len();
    if n_hairs == 0 || from >= n_roots {
        return;
    }
    let raised = Field::new(geometry.size_mm, CLUMP_MM, random);
    for _ in 0..n_hairs {
        let path = &geometry.paths[from + random.index(n_roots - from)];
        let root = path.nodes[random.index(path.nodes.len())];
        let clump = (yarn.hair_clump * raised.at(root.u_mm, root.w_mm)).exp();
        let colour = yarn.colour_of_one(random).map(|c| (1.08 * c).min(1.0));
        let nodes = arch(root, yarn, clump, random);
        geometry.paths.push(YarnPath {
            nodes,
            flatness: 0.0,
            ridge_um: 0.0,
            colour,
        });
    }
}

/// A fibre that leaves its yarn, arches and comes down again, bent in the plane.
fn arch(root: Node, yarn: &Yarn, clump: f64, random: &mut Random) -> Vec<Node> {
    let length = yarn.hair_mm * random.uniform_in(0.5, 1.5);
    let heading = random.uniform() * TAU;
    let bend = random.normal() * 1.2;
    let lift = yarn.hair_lift_um * random.uniform_in(0.4, 1.6) * clump;
    let base = root.z_um + root.half_thickness_um;
    let (mut u_mm, mut w_mm) = (root.u_mm, root.w_mm);
    let piece = length / f64::from(PIECES);
    let node = |k: u8| {
        let share = f64::from(k) / f64::from(PIECES);
        let (along_u, along_w) = (heading + bend * share).sin_cos();
        let here = Node {
            u_mm,
            w_mm,
            z_um: base + lift * (PI * share).sin(),
            half_width_mm: 0.0005 * yarn.hair_um,
            half_thickness_um: 0.5 * yarn.hair_um,
            twist_rad: 0.0,
        };
        u_mm += piece * along_u;
        w_mm += piece * along_w;
        here
    };
    (0..=PIECES).map(node).collect()
}
