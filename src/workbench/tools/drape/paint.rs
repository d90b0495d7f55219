//! A cloth as it hangs, its pads, contactors and forces, on the screen: one mesh for the cloth,
//! painted from back to front.

use eframe::egui::{
    Align2, Color32, Mesh, Painter, Pos2, Rect, Shape, Stroke, TextureId, pos2, vec2,
};
use eframe::epaint::{Vertex, WHITE_UV};

use crate::kit::amplitude::AmplitudeScale;
use crate::kit::swatch::ClothPicture;
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::theme::{self, Palette};
use crate::kit::widgets::relief3d::mesh::lit;
use crate::kit::widgets::text::paint_quiet;
use crate::tools::drape::camera::Sight;
use crate::tools::drape::hung::ClothFrame;
use selvedge_drape::Pad;
use selvedge_foundation::numerics::to_single;
use selvedge_foundation::quantity::{fixed, with_unit};

/// Towards the light as the viewer has it: from the upper left, before the cloth.
const LIGHT: [f32; 3] = [-0.58, 0.5, 0.64];
/// How bright what lies in the shade is.
const AMBIENT: f32 = 0.42;
/// How much of a pad covers what is behind.
const PAD: f32 = 0.30;
/// Half the pad as it is drawn, across and along, mm, and its parts.
const PAD_MM: [f64; 2] = [7.0, 10.5];
const PAD_RINGS: u32 = 4;
const PAD_SECTORS: u32 = 24;
/// Points of an arrow a N.
const ARROW: f32 = 90.0;
/// A smaller force has no arrow, N.
const LEAST_N: f64 = 0.02;
/// Radius of a contactor, mm.
const DOT_MM: f32 = 0.75;

/// What a cloth is painted with.
pub(crate) struct Dress<'a> {
    pub(crate) palette: &'a Palette,
    /// How its textile looks, once that is known.
    pub(crate) picture: Option<ClothPicture>,
    pub(crate) map: ColourMap,
    pub(crate) scale: AmplitudeScale,
    /// The strain at the upper end of the colours, where strain is shown in place of the textile.
    pub(crate) strain: Option<f32>,
}

/// Paints all of it.
pub(crate) fn cloth(painter: &Painter, sight: &Sight, cloth: &ClothFrame, dress: &Dress<'_>) {
    let face = if sight.sees_face() { 1.0 } else { -1.0 };
    let pads = || cloth.pads.iter().zip(&cloth.amplitudes_um);
    for pad in pads().filter(|(pad, _)| pad.side * face < 0.0) {
        paint_pad(painter, sight, pad, dress);
    }
    painter.add(Shape::mesh(mesh(sight, cloth, dress)));
    paint_bar(painter, sight, cloth, dress);
    for pad in pads().filter(|(pad, _)| pad.side * face >= 0.0) {
        paint_pad(painter, sight, pad, dress);
    }
    for (pad, felt) in cloth.pads.iter().zip(&cloth.fingers) {
        paint_force(painter, sight, pad, felt.force_n, dress);
    }
}

/// The cloth: lit vertices, cells from the farthest to the nearest.
fn mesh(sight: &Sight, cloth: &ClothFrame, dress: &Dress<'_>) -> Mesh {
    let [n_warp, n_weft] = cloth.grid;
    let strains = dress.strain.map(|most| (cloth.strains(), most));
    let picture = dress.picture.filter(|_| strains.is_none());
    let tint = match picture {
        Some(_) => Color32::WHITE,
        None => dress.palette.resting_cloth,
    };
    let mut near = Vec::with_capacity(cloth.places_mm.len());
    let mut mesh = Mesh {
        texture_id: picture.map_or_else(TextureId::default, |picture| picture.texture),
        ..Mesh::default()
    };
    for vertex in 0..cloth.places_mm.len() {
        let (pos, depth) = sight.at(cloth.places_mm[vertex]);
        near.push(depth);
        let own = strains.as_ref().map_or(tint, |(strains, most)| {
            dress.map.colour(f64::from(strains[vertex] / most))
        });
        mesh.vertices.push(Vertex {
            pos,
            uv: picture.map_or(WHITE_UV, |picture| uv(cloth, vertex, picture)),
            color: lit(own, brightness(sight, cloth, vertex)),
        });
    }
    let mut cells: Vec<(f32, usize)> = Vec::with_capacity(n_warp * n_weft);
    for row in 0..n_weft.saturating_sub(1) {
        for column in 0..n_warp.saturating_sub(1) {
            let corner = row * n_warp + column;
            let depth = near[corner] + near[corner + 1] + near[corner + n_warp];
            cells.push((depth + near[corner + n_warp + 1], corner));
        }
    }
    cells.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, corner) in cells {
        let [a, b, c, d] = [corner, corner + 1, corner + n_warp, corner + n_warp + 1]
            .map(|vertex| u32::try_from(vertex).unwrap_or(0));
        mesh.add_triangle(a, b, c);
        mesh.add_triangle(b, d, c);
    }
    mesh
}

/// Where in its tiled picture a vertex is: row 0 of a picture is its top.
fn uv(cloth: &ClothFrame, vertex: usize, picture: ClothPicture) -> Pos2 {
    let [n_warp, n_weft] = cloth.grid;
    let share = |at: usize, n: usize| at as f32 / n.saturating_sub(1).max(1) as f32;
    let (along, across) = (
        share(vertex % n_warp, n_warp),
        share(vertex / n_warp, n_weft),
    );
    let [width, height] = cloth.size_mm.map(to_single);
    let tile = picture.tile_mm.max(vec2(1e-3, 1e-3));
    pos2(along * width / tile.x, 1.0 - across * height / tile.y)
}

/// How much light a vertex gets; the side that is seen is lit, whichever it is.
fn brightness(sight: &Sight, cloth: &ClothFrame, vertex: usize) -> f32 {
    let [n_warp, n_weft] = cloth.grid;
    let (column, row) = (vertex % n_warp, vertex / n_warp);
    let at = |column: usize, row: usize| cloth.places_mm[row * n_warp + column];
    let between = |a: [f32; 3], b: [f32; 3]| [0, 1, 2].map(|axis| b[axis] - a[axis]);
    let u = between(
        at(column.saturating_sub(1), row),
        at((column + 1).min(n_warp - 1), row),
    );
    let w = between(
        at(column, row.saturating_sub(1)),
        at(column, (row + 1).min(n_weft - 1)),
    );
    let cross = [
        u[1] * w[2] - u[2] * w[1],
        u[2] * w[0] - u[0] * w[2],
        u[0] * w[1] - u[1] * w[0],
    ];
    let normal = sight.turned(cross);
    let length = normal.iter().map(|x| x * x).sum::<f32>().sqrt().max(1e-9);
    let facing = normal.iter().zip(LIGHT).map(|(n, l)| n * l).sum::<f32>() / length;
    let facing = if normal[2] < 0.0 { -facing } else { facing };
    AMBIENT + (1.0 - AMBIENT) * 1.25 * facing.max(0.0)
}

/// The bar that the upper edge hangs on, if it does.
fn paint_bar(painter: &Painter, sight: &Sight, cloth: &ClothFrame, dress: &Dress<'_>) {
    let [n_warp, _] = cloth.grid;
    let top = &cloth.places_mm[cloth.places_mm.len().saturating_sub(n_warp)..];
    let height = to_single(cloth.size_mm[1]);
    if top
        .iter()
        .all(|place| (place[1] - height).abs() < 1e-3 && place[2].abs() < 1e-3)
    {
        let ends = [top[0], top[top.len() - 1]].map(|place| sight.at(place).0);
        let beyond = 0.02 * (ends[1] - ends[0]);
        let ends = [ends[0] - beyond, ends[1] + beyond];
        painter.line_segment(ends, Stroke::new(4.0, dress.palette.line));
    }
}

/// A translucent cap with its contactors: a colour by amplitude, a ring where nothing is touched.
fn paint_pad(
    painter: &Painter,
    sight: &Sight,
    (pad, amplitudes): (&Pad, &[Option<[f64; 2]>; 24]),
    dress: &Dress<'_>,
) {
    painter.add(Shape::mesh(cap(sight, pad, dress.palette)));
    let radius = (DOT_MM * sight.scale).clamp(1.2, 6.0);
    for (place, felt) in pad.contactors_mm().into_iter().zip(amplitudes) {
        let (at, _) = sight.at(place.map(to_single));
        let Some([low, high]) = felt else {
            let rim = Stroke::new(1.0, dress.palette.contactor.gamma_multiply(0.8));
            painter.circle_stroke(at, 0.8 * radius, rim);
            continue;
        };
        let colour = dress.map.colour(dress.scale.share(low.max(*high)));
        let rim = Stroke::new(1.0, dress.palette.contactor);
        painter.circle(at, radius, colour, rim);
    }
}

fn cap(sight: &Sight, pad: &Pad, palette: &Palette) -> Mesh {
    let mut mesh = Mesh::default();
    let ink = palette.text;
    let at = |ring: u32, sector: u32| {
        let share = f64::from(ring) / f64::from(PAD_RINGS);
        let turn = std::f64::consts::TAU * f64::from(sector) / f64::from(PAD_SECTORS);
        let place = pad.at_mm([
            share * PAD_MM[0] * turn.cos(),
            share * PAD_MM[1] * turn.sin(),
        ]);
        sight.at(place.map(to_single)).0
    };
    mesh.colored_vertex(at(0, 0), ink.gamma_multiply(0.4 * PAD));
    for ring in 1..=PAD_RINGS {
        let share = ring as f32 / PAD_RINGS as f32;
        for sector in 0..PAD_SECTORS {
            mesh.colored_vertex(
                at(ring, sector),
                ink.gamma_multiply(PAD * (0.4 + 0.6 * share)),
            );
        }
    }
    let index = |ring: u32, sector: u32| 1 + (ring - 1) * PAD_SECTORS + sector % PAD_SECTORS;
    for sector in 0..PAD_SECTORS {
        mesh.add_triangle(0, index(1, sector), index(1, sector + 1));
        for ring in 1..PAD_RINGS {
            let [a, b] = [index(ring, sector), index(ring, sector + 1)];
            let [c, d] = [index(ring + 1, sector), index(ring + 1, sector + 1)];
            mesh.add_triangle(a, c, b);
            mesh.add_triangle(b, c, d);
        }
    }
    mesh
}

/// The force on a hand as an arrow from its pad, with its size.
fn paint_force(painter: &Painter, sight: &Sight, pad: &Pad, force_n: [f64; 3], dress: &Dress<'_>) {
    let size_n = force_n.iter().map(|n| n * n).sum::<f64>().sqrt();
    if size_n < LEAST_N {
        return;
    }
    let (from, _) = sight.at(pad.tip_mm.map(to_single));
    let [right, up, _] = sight.turned(force_n.map(to_single));
    let way = vec2(right, -up) * ARROW;
    let stroke = Stroke::new(2.0, dress.palette.selection);
    let rim = Stroke::new(4.0, dress.palette.floor.gamma_multiply(0.6));
    painter.line_segment([from, from + way], rim);
    painter.arrow(from, way, stroke);
    let anchor = if way.x < 0.0 {
        Align2::RIGHT_CENTER
    } else {
        Align2::LEFT_CENTER
    };
    let at = from + way + vec2(if way.x < 0.0 { -8.0 } else { 8.0 }, 0.0);
    let words = with_unit(size_n, 2, "N");
    let font = theme::small_number();
    let galley = painter.layout_no_wrap(words, font, dress.palette.text);
    let ground = anchor.anchor_size(at, galley.size());
    painter.rect_filled(ground.expand(2.0), 3, dress.palette.tag.gamma_multiply(0.8));
    painter.galley(ground.min, galley, dress.palette.text);
}

/// The bar of strains, with its ends.
pub(crate) fn strain_bar(painter: &Painter, bar: Rect, dress: &Dress<'_>, most: f32) {
    crate::kit::widgets::bar::colour_bar(painter, bar, |share| dress.map.colour(share));
    let percent = 100.0 * f64::from(most);
    let decimals = usize::from(percent < 1.0);
    let ink = dress.palette.dim;
    for (y, value) in [(bar.top() + 4.0, percent), (bar.bottom() - 4.0, 0.0)] {
        let (at, font) = (pos2(bar.right() + 7.0, y), theme::small_number());
        painter.text(at, Align2::LEFT_CENTER, fixed(value, decimals), font, ink);
    }
    let unit_at = pos2(bar.left(), bar.top() - 11.0);
    paint_quiet(painter, unit_at, Align2::LEFT_CENTER, "strain, %");
}
