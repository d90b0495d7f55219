//! How much a map hangs on what answers count: the design's weights against others and against
//! Craven's distances.

use super::included_trials::Experiment;
use super::map::Mapping;
use super::model::{Cell, Section, Table, cells, or_undefined};
use super::odd_one_out_craven::Craven;
use super::options::Options;
use selvedge_foundation::numerics::Random;
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_statistics::mds::{Dissimilarities, Map, Mds};
use selvedge_statistics::procrustes::Procrustes;
use selvedge_statistics::ranking::{GradeWeights, OddOneOut, TriadAnswer};
use selvedge_statistics::{Computed, Ranks, Undefined, pearson_r};

/// Weights of easy, normal and hard that maps are tried with besides the design's.
const OTHER_WEIGHTS: [[f64; 3]; 2] = [[1.0, 0.6, 0.3], [1.0, 1.0, 1.0]];

/// One way to take distances.
struct Variant {
    described: String,
    n_ceiling: usize,
    n_floor: usize,
    values: Vec<Option<f64>>,
}

impl Variant {
    fn weighted(found: &OddOneOut) -> Self {
        let GradeWeights { easy, normal, hard } = found.weights;
        Self {
            described: format!("weights {easy} / {normal} / {hard}"),
            n_ceiling: found.n_ceiling,
            n_floor: found.n_floor,
            values: if found.is_balanced() {
                found.distances()
            } else {
                found.mean_weights()
            },
        }
    }

    /// Its maps on a line and in the plane, the same way as the design's.
    fn maps(
        &self,
        names: &[String],
        mds: &Mds,
        progress: &mut Progress<'_>,
    ) -> Result<Computed<Vec<Map>>, Cancelled> {
        let data = match Dissimilarities::new(names.to_vec(), &self.values) {
            Ok(data) => data,
            Err(why) => return Ok(Err(why)),
        };
        mds.maps(&data, 1..=2, progress).map(Ok)
    }
}

const VARIANTS: &str = "distances: distances by; ceiling: pairs at the ceiling; floor: at the \
    floor; pairs; spearman: rank correlation with the design's; stress1_line: stress-1 on a line; \
    m2_line: m² against the design's line; p_line: PROTEST p; stress1_plane: stress-1 in the \
    plane; m2_plane: m² against the design's plane; p_plane: PROTEST p; remark";

/// Distances by other weights and by Craven beside the design's, and their maps laid over its map.
///
/// # Errors
/// It was cancelled.
pub(super) fn section(
    (experiment, mapping): (&Experiment<'_>, &Mapping<'_>),
    (found, all, craven): (&OddOneOut, &[TriadAnswer], &Craven),
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<Section, Cancelled> {
    let mut section = experiment.section("variants", "maps by other distances");
    section.note(
        "What easy, normal and hard count is arbitrary; so each map is laid over the design's by \
         Procrustes (moved, turned, mirrored, scaled). m² is what is left over, 0 for maps alike \
         and 1 for nothing in common; PROTEST's p is how often items dealt anew fit as well.",
    );
    if found.is_balanced() {
        section.note(
            "Every pair was asked as often, so Craven's distances are in the order of weights \
             1 / 1 / 1: a map by order alone is the same.",
        );
    }
    let mds = mapping.mds(options);
    let names = &mapping.names;
    let own = Variant::weighted(found);
    let own_maps = own.maps(names, &mds, progress)?;
    let mut table = Table::new("variants", "Maps by other distances", VARIANTS);
    let mut places = Table::new("coordinates", "Plane maps, laid over the design's", PLACES);
    table.push(own.row(&own, (&own_maps, None), options));
    enter(&mut places, &own.described, names, &plane(&own_maps));
    for variant in variants(names.len(), all, craven) {
        let maps = variant.maps(names, &mds, progress)?;
        table.push(variant.row(&own, (&maps, Some(&own_maps)), options));
        let laid = plane(&maps).and_then(|map| {
            let over = plane(&own_maps)?;
            Ok(Procrustes::of(&map, &over)?.moved)
        });
        enter(&mut places, &variant.described, names, &laid);
    }
    section.table(table);
    if !places.rows.is_empty() {
        section.table(places);
    }
    Ok(section)
}

fn variants(n_items: usize, all: &[TriadAnswer], craven: &Craven) -> Vec<Variant> {
    let weighted = |other: [f64; 3]| OddOneOut::of(n_items, all, other.into()).ok();
    let others = OTHER_WEIGHTS.into_iter().filter_map(weighted);
    let mut variants: Vec<Variant> = others.map(|found| Variant::weighted(&found)).collect();
    variants.push(Variant {
        described: "Craven's d′".to_owned(),
        n_ceiling: craven.n_ceiling,
        n_floor: craven.n_floor,
        values: craven.distances.clone(),
    });
    variants
}

type Maps = Computed<Vec<Map>>;

fn plane(maps: &Maps) -> Computed<Vec<Vec<f64>>> {
    of_dims(maps, 2).map(|map| map.points.clone())
}

fn of_dims(maps: &Maps, dims: usize) -> Computed<&Map> {
    let maps = maps.as_ref().map_err(Clone::clone)?;
    let found = maps.iter().find(|map| map.dims == dims);
    found.ok_or_else(|| Undefined::because("no map in so many dimensions"))
}

impl Variant {
    /// `own_maps` are the design's; `None` for the design itself.
    fn row(
        &self,
        own: &Self,
        (maps, own_maps): (&Maps, Option<&Maps>),
        options: &Options,
    ) -> Vec<Cell> {
        let both = own.values.iter().zip(&self.values);
        let both: Vec<[f64; 2]> = both.filter_map(|(a, b)| Some([(*a)?, (*b)?])).collect();
        let rank = |at: usize| Ranks::of(&both.iter().map(|d| d[at]).collect::<Vec<f64>>()).ranks;
        let n_pairs = self.values.iter().flatten().count() / 2;
        let itself = || Cell::none("the design's own");
        let r = own_maps.map_or_else(itself, |_| (&pearson_r(&rank(0), &rank(1))).into());
        let in_dims = |dims: usize| {
            let against = own_maps.map_or_else(
                || vec![itself(); 2],
                |own| laid(of_dims(maps, dims), of_dims(own, dims), options),
            );
            cells![of_dims(maps, dims).map(|map| map.stress1), against]
        };
        let remark = match maps {
            Ok(_) => String::new(),
            Err(why) => format!("no map: {}", why.reason),
        };
        let (ceiling, floor) = (self.n_ceiling, self.n_floor);
        cells![
            &self.described,
            ceiling,
            floor,
            n_pairs,
            r,
            in_dims(1),
            in_dims(2),
            remark
        ]
    }
}

/// m² of a map against the design's, and its p.
fn laid(map: Computed<&Map>, own: Computed<&Map>, options: &Options) -> Vec<Cell> {
    let both = map.and_then(|map| Ok((&map.points, &own?.points)));
    let found = both.map(|(map, own)| {
        let mut random = Random::new(options.seed).branch("maps by chance");
        let m2 = Procrustes::of(map, own).map(|found| found.m2);
        cells![
            m2,
            Procrustes::protest(map, own, options.n_permutations, &mut random)
        ]
    });
    or_undefined(found, 2)
}

const PLACES: &str = "distances: distances by; item: fabric; x1: x₁; x2: x₂";

fn enter(table: &mut Table, described: &str, names: &[String], points: &Computed<Vec<Vec<f64>>>) {
    for (name, point) in names.iter().zip(points.iter().flatten()) {
        let place: Vec<Cell> = point.iter().map(|x| Cell::from(*x)).collect();
        table.push(cells![described, name, place]);
    }
}
