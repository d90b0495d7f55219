//! Maps over the cloth: what every textile of the scene would give all over at one velocity.

use crate::bench::export::origin::Origin;
use crate::bench::export::{Exported, Sheet, bar, ink, rgb};
use crate::bench::probe::Probe;
use crate::bench::view::Cloth;
use crate::tools::workspace::maps::ShownMap;
use selvedge_chart::{Axis, Chart, Raster, Row};
use selvedge_foundation::numerics::to_index;
use selvedge_foundation::quantity;

/// Most panels side by side.
const MOST_A_ROW: usize = 3;
/// Width that the panels of a row share, and what each needs for its labels, px.
const ROOM_PX: f64 = 720.0;
const LABELS_PX: f64 = 72.0;
/// The least and the most height of a panel, px.
const HEIGHTS_PX: [f64; 2] = [90.0, 420.0];

/// A textile and its map, cell by cell as it lies on the cloth.
struct Mapped<'a> {
    place: usize,
    cloth: &'a Cloth,
    shown: ShownMap<'a>,
    /// Cells along warp and weft.
    n_cells: [usize; 2],
}

impl Mapped<'_> {
    /// The amplitude of the cell around a point, u and w in mm along warp and weft.
    fn amplitude_um(&self, [u, w]: [usize; 2]) -> f64 {
        let [n_warp, n_weft] = self.shown.map.n_points();
        let band = self.shown.wanted.band.index();
        let repeated = [u % n_warp.max(1), w % n_weft.max(1)];
        self.shown.map.at_points_um(repeated)[band]
    }
}

/// The maps that are shown, of textiles by their places in the scene's list. `probe` is the
/// velocity in words that people chose.
pub(crate) fn maps(
    shown: Vec<(usize, &Cloth, ShownMap<'_>)>,
    probe: Probe,
    origin: Origin,
) -> Option<Exported> {
    let mapped = |(place, cloth, shown): (usize, _, _)| {
        let n_cells = cells_of(cloth);
        Mapped {
            place,
            cloth,
            shown,
            n_cells,
        }
    };
    let all: Vec<Mapped<'_>> = shown.into_iter().map(mapped).collect();
    let wanted = all.first()?.shown.wanted;
    let n_a_row = if all.len() == 4 { 2 } else { MOST_A_ROW };
    let ends = [wanted.scale.least_um(), wanted.scale.most_um()];
    let row = |some: &[Mapped<'_>]| Row {
        panels: some.iter().map(panel).collect(),
        height_px: height_px(some),
        bar: Some(bar(
            wanted.colours,
            Axis::log("peak amplitude, µm").within(ends),
        )),
    };
    let rows = all.chunks(n_a_row).map(row).collect();
    let band = format!("{} Hz", quantity::fixed(wanted.band.carrier_hz(), 0));
    let speed = quantity::with_unit(probe.speed_mm_per_s, 1, "mm/s");
    let direction = format!("{}°", quantity::fixed(probe.direction_deg, 0));
    let origin = origin
        .and("band_hz", &wanted.band.carrier_hz().to_string(), &band)
        .and("speed_mm_per_s", &probe.speed_mm_per_s.to_string(), &speed)
        .and("direction_deg", &probe.direction_deg.to_string(), "");
    let note = format!(
        "Peak amplitude at {band} after gains and before output limits that a contactor would \
         have at every point, 1 mm apart, moving at {speed} and {direction} from the workspace’s \
         x. u along the warp, w along the weft, from the textile’s origin."
    );
    let title = format!("{band} over the cloth at {speed}, {direction}");
    Some(Exported::new(
        title,
        sheet(&all, probe),
        rows,
        &note,
        origin,
    ))
}

/// Points of a textile along warp and weft whose cells are seen: half a millimetre beyond its edge.
fn cells_of(cloth: &Cloth) -> [usize; 2] {
    cloth
        .size_mm
        .map(|mm| 1 + to_index(mm.max(0.0) + 0.5 - 1e-6))
}

fn height_px(row: &[Mapped<'_>]) -> f64 {
    let n = row.len().max(1) as f64;
    let across: f64 = row.iter().map(|one| one.n_cells[0] as f64).sum();
    let upward = row
        .iter()
        .map(|one| one.n_cells[1] as f64)
        .fold(1.0, f64::max);
    let [least, most] = HEIGHTS_PX;
    let room_px = ROOM_PX - LABELS_PX * (n - 1.0);
    (room_px * upward / across.max(1.0))
        .clamp(least, most)
        .round()
}

fn panel(one: &Mapped<'_>) -> Chart {
    let wanted = &one.shown.wanted;
    let [n_warp, n_weft] = one.n_cells;
    // Rows of a raster come from the top, the weft runs upward.
    let places = (0..n_weft)
        .rev()
        .flat_map(|w| (0..n_warp).map(move |u| [u, w]));
    let colour = |place| {
        let share = wanted.scale.share(one.amplitude_um(place));
        Some(rgb(wanted.colours, share))
    };
    let ends = |n: usize| [-0.5, n as f64 - 0.5];
    Chart {
        title: format!("{} {}", one.cloth.label, one.cloth.name)
            .trim()
            .to_owned(),
        ink: ink(wanted.band),
        width: n_warp as f64,
        x: Axis::linear("u, mm").within(ends(n_warp)),
        y: Axis::linear("w, mm").within(ends(n_weft)),
        raster: Some(Raster {
            n_columns: n_warp,
            cells: places.map(colour).collect(),
        }),
        ..Chart::default()
    }
}

fn sheet(all: &[Mapped<'_>], probe: Probe) -> Sheet {
    let cells = || {
        all.iter().flat_map(|one| {
            let [n_warp, n_weft] = one.n_cells;
            (0..n_weft).flat_map(move |w| (0..n_warp).map(move |u| (one, [u, w])))
        })
    };
    let words = |of: fn(&Cloth) -> &str| -> Vec<String> {
        cells().map(|(one, _)| of(one.cloth).to_owned()).collect()
    };
    let number = |of: &dyn Fn(&Mapped<'_>, [usize; 2]) -> f64| -> Vec<f64> {
        cells().map(|(one, at)| of(one, at)).collect()
    };
    let places: Vec<u64> = cells().map(|(one, _)| one.place as u64).collect();
    Sheet::default()
        .with("textile", words(|cloth| &cloth.id))
        .with("u_mm", number(&|_, [u, _]| u as f64))
        .with("w_mm", number(&|_, [_, w]| w as f64))
        .with("amplitude_um", number(&|one, at| one.amplitude_um(at)))
        .with("place", places)
        .with("label", words(|cloth| &cloth.label))
        .with(
            "band_hz",
            number(&|one, _| one.shown.wanted.band.carrier_hz()),
        )
        .with("speed_mm_per_s", number(&|_, _| probe.speed_mm_per_s))
        .with("direction_deg", number(&|_, _| probe.direction_deg))
}
