//! The workspace seen from above on a page: cloth, the ways of displays, their contactors.

use crate::bench::error::AppError;
use crate::bench::recording::Recording;
use crate::tools::timeline::figure_moment::Moment;
use selvedge_chart::{Axis, Chart, Ink, Raster, Series, Style, Weight, Words};
use selvedge_foundation::geometry::{Point, Rotation};
use selvedge_foundation::numerics::to_index;
use selvedge_render::scene::LoadedScene;
use selvedge_textile::Appearance;

/// Cells along the longer side.
const N_CELLS: f64 = 260.0;
/// Most points of the way.
const MOST_POINTS: u64 = 4000;

/// The map.
///
/// # Errors
/// A textile's picture cannot be read.
pub(crate) fn map(
    loaded: &LoadedScene,
    recording: &Recording,
    moment: &Moment,
) -> Result<Chart, AppError> {
    let scene = loaded.scene();
    let [width_mm, height_mm] = scene.size_mm;
    let each = recording.path().n_ticks().div_ceil(MOST_POINTS).max(1);
    let path = recording.path();
    let series = scene
        .displays
        .iter()
        .enumerate()
        .flat_map(|(nth, display)| {
            let some = path.ticks().filter(|(tick, _)| tick.is_multiple_of(each));
            let way = some.map(|(_, first)| path.pose_of(nth, &first).position);
            let way = way.map(|at| [at.x_mm, at.y_mm]);
            let pose = path.pose_of(nth, &moment.first);
            let turn = Rotation::from_degrees(display.rotation_deg + pose.angle_deg);
            let offsets = display.geometry.contactors().into_iter();
            let contactors = offsets.map(|offset| pose.position + turn.turn(offset));
            let contactors = contactors.map(|at: Point| [at.x_mm, at.y_mm]);
            [
                Series {
                    ink: Ink::Violet,
                    weight: Weight::Bold,
                    ..Series::of("", Style::Line, way)
                },
                Series {
                    ink: Ink::Black,
                    ..Series::of("", Style::Dots, contactors)
                },
            ]
        });
    let label = |placed: &selvedge_render::scene::PlacedTextile| {
        let [u_mm, w_mm] = placed.size_mm.map(|side_mm| 0.5 * side_mm);
        let at = placed
            .workspace_from_textile()
            .point(Point::new(u_mm, w_mm));
        Words {
            at: [at.x_mm, at.y_mm],
            text: format!("{} {}", placed.label, placed.id).trim().to_owned(),
            ..Words::default()
        }
    };
    Ok(Chart {
        title: "from above".to_owned(),
        x: Axis::linear("x, mm").within([0.0, width_mm]),
        y: Axis::linear("y, mm").within([0.0, height_mm]),
        raster: Some(cloth(loaded)?),
        words: scene.textiles.iter().map(label).collect(),
        series: series.collect(),
        ..Chart::default()
    })
}

/// The textiles' pictures, bright, so that lines stand out.
fn cloth(loaded: &LoadedScene) -> Result<Raster, AppError> {
    let scene = loaded.scene();
    let [width_mm, height_mm] = scene.size_mm;
    let cell_mm = width_mm.max(height_mm) / N_CELLS;
    let textiles = loaded.textiles().iter();
    let pictures: Vec<Option<Appearance>> = textiles
        .map(|textile| textile.appearance())
        .collect::<Result<_, _>>()?;
    let [n_columns, n_rows] = scene
        .size_mm
        .map(|mm| to_index((mm / cell_mm).ceil()).max(1));
    let middle = |index: usize, n: usize, mm: f64| (index as f64 + 0.5) / n as f64 * mm;
    let mut cells = Vec::with_capacity(n_columns * n_rows);
    for row in (0..n_rows).rev() {
        for column in 0..n_columns {
            let at = Point::new(
                middle(column, n_columns, width_mm),
                middle(row, n_rows, height_mm),
            );
            cells.push(scene.textile_at(at).map(|place| {
                let placed = &scene.textiles[place];
                let local = placed.workspace_from_textile().into_point(at);
                let picture = pictures.get(place).and_then(Option::as_ref);
                picture.map_or([220; 3], |picture| bright(picture, local))
            }));
        }
    }
    Ok(Raster { n_columns, cells })
}

/// The picture's colour at a point of its textile, halfway to white.
fn bright(picture: &Appearance, at: Point) -> [u8; 3] {
    let image = &picture.image;
    let pixel = |mm: f64, n: usize| to_index(mm.max(0.0) * picture.px_per_mm) % n.max(1);
    let from_top = image
        .height
        .saturating_sub(1 + pixel(at.y_mm, image.height));
    let index = from_top * image.width + pixel(at.x_mm, image.width);
    let colour = image.pixels.get(index).copied().unwrap_or([220; 3]);
    colour.map(|channel| 255 - (255 - channel) / 2)
}
