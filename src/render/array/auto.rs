//! Which method is the cheapest within an error budget, preparing included.
//!
//! Decided from bounds known before the first tick and from counts of what ticks will evaluate,
//! never from a clock: the choice, and so every result, depends on the scene, the budget and the
//! path alone. Along a path its own ticks are counted, or so many of them that the rest is like
//! them; live, a minute of a usual stroke is.

use super::table::{Grid, MAX_TABLE_BYTES, RowTable, table_bytes};
use super::{Accuracy, ErrorBound, Method};
use crate::RenderScene;
use crate::plan::{Axis, Contacts, Counters, DisplayPlan, Motion, ScenePlan, finite_pose};
use crate::scene::{ExplorationPath, PathCursor, Pose, TICKS_PER_S};
use selvedge_foundation::numerics::{to_index, to_whole};
use selvedge_textile::tactile::{MIN_SPEED_MM_PER_S, n_audible_bins};

/// What operations cost, ns: fitted once to the times of explorations of 40 to 24,000 ticks,
/// straight and turning, on a machine of 2.5 GHz. Only their ratios matter; the study `total-cost`
/// of the report shows whether they still hold.
mod ns {
    /// A bin of the reference: a logarithm and an exponential for each band.
    pub(super) const REFERENCE_BIN: f64 = 21.0;
    /// Gains of both bands at a bin.
    pub(super) const GAIN: f64 = 1.4;
    /// A bin of a sum with gains at hand.
    pub(super) const SUM_BIN: f64 = 1.1;
    /// A bin of a row of a table, where points are summed together.
    pub(super) const ROW_BIN: f64 = 0.28;
    /// A speed: where its gains begin and end.
    pub(super) const SPEED: f64 = 25.0;
    /// Its place in tables.
    pub(super) const SPEED_IN_TABLES: f64 = 8.0;
    /// A look-up in tables.
    pub(super) const LOOK_UP: f64 = 2.4;
    /// Preparing `banded`.
    pub(super) const BANDED: f64 = 20e3;
    /// Preparing a table, whatever the scene, and for each set of spectra.
    pub(super) const TABLE: f64 = 130e3;
    pub(super) const TABLE_OF_SPECTRA: f64 = 2.5e3;
}

/// How long somebody who explores is assumed to go on, ticks: a minute.
const LIVE_TICKS: f64 = 60.0 * TICKS_PER_S;
/// How fast, along either axis, mm/s.
const LIVE_SPEED_MM_PER_S: f64 = 100.0;
/// Nodes of each direction that such an exploration needs.
const LIVE_NODES: f64 = 200.0;
/// So many ticks of a path are counted at least, and at most; between, one in so many.
const COUNTED: [u64; 2] = [1024, 4096];
const COUNTED_OF: u64 = 32;

/// The method that `auto` stands for, and the nodes of its tables if it has any.
pub(super) fn resolve(
    scene: &RenderScene,
    plan: &ScenePlan,
    accuracy: &Accuracy,
    path: Option<&ExplorationPath>,
) -> (Method, Option<Grid>) {
    let work = match path {
        Some(path) => Work::along(scene, plan, path),
        None => Work::live(scene, plan),
    };
    let mut by_cost = work.costs_ns(plan);
    by_cost.sort_by(|(_, a), (_, b)| a.total_cmp(b));
    for (method, _) in by_cost {
        match method {
            Method::Table => {
                let grid = Grid::new(&scene.filters, accuracy.budget_db);
                let is_within = grid.density.level_db <= accuracy.budget_db;
                if is_within && table_bytes(plan, &grid) <= MAX_TABLE_BYTES {
                    return (method, Some(grid));
                }
            }
            Method::Banded => {
                let bound = ErrorBound::of_floor(accuracy.banded_floor);
                if bound.level_db <= accuracy.budget_db {
                    return (method, None);
                }
            }
            Method::Reference | Method::Auto => break,
        }
    }
    (Method::Reference, None)
}

/// What all ticks together evaluate.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Work {
    /// Directions of contactors that are felt.
    directions: f64,
    /// Their bins.
    bins: f64,
    /// Speeds, each of a tick told apart.
    speeds: f64,
    /// Their bins.
    speed_bins: f64,
    /// Bins of directions that no other of their tick repeats.
    point_bins: f64,
    /// Bins of the gains that nodes of tables are made with, and of the powers there.
    node_bins_made: [f64; 2],
}

impl Work {
    /// What each method costs, the most exact first.
    fn costs_ns(&self, plan: &ScenePlan) -> [(Method, f64); 3] {
        let reference = self.bins * ns::REFERENCE_BIN;
        let banded = ns::BANDED
            + self.speeds * ns::SPEED
            + self.speed_bins * ns::GAIN
            + self.point_bins * ns::SUM_BIN;
        let [gains, powers] = self.node_bins_made;
        let preparing = ns::TABLE + plan.pool.len() as f64 * ns::TABLE_OF_SPECTRA;
        let table = preparing
            + self.speeds * ns::SPEED_IN_TABLES
            + self.directions * ns::LOOK_UP
            + gains * ns::GAIN
            + powers * ns::ROW_BIN;
        [
            (Method::Reference, reference),
            (Method::Banded, banded),
            (Method::Table, table),
        ]
    }

    /// A minute of strokes on one textile after another.
    fn live(scene: &RenderScene, plan: &ScenePlan) -> Self {
        let n_contactors = scene
            .displays
            .iter()
            .map(|d| d.offsets.len())
            .sum::<usize>() as f64;
        let n_points = plan.pool.iter().map(|spectra| spectra.n_points());
        let n_points = n_points.max().unwrap_or(0) as f64;
        let n_bins = n_audible_bins(LIVE_SPEED_MM_PER_S) as f64;
        let n_directions = 2.0 * n_contactors * LIVE_TICKS;
        let n_speeds = 2.0 * scene.displays.len() as f64 * LIVE_TICKS;
        Self {
            directions: n_directions,
            bins: n_directions * n_bins,
            speeds: n_speeds,
            speed_bins: n_speeds * n_bins,
            point_bins: n_speeds * n_bins * n_contactors.min(n_points),
            node_bins_made: [1.0, plan.pool.len() as f64 * n_points.min(64.0)]
                .map(|n| n * LIVE_NODES * n_bins),
        }
    }

    /// The ticks of a path.
    fn along(scene: &RenderScene, plan: &ScenePlan, path: &ExplorationPath) -> Self {
        let n_ticks = path.n_ticks();
        let n_counted = n_counted(n_ticks);
        let mut count = Count::of(scene);
        for nth in 0..n_counted {
            if nth == n_counted / 2 {
                count.n_first_pairs = count.pairs.len();
            }
            count.add(plan, path, nth_counted(nth, n_ticks));
        }
        count.scaled(plan, n_ticks as f64 / n_counted as f64)
    }
}

/// How many of so many ticks are counted.
fn n_counted(n_ticks: u64) -> u64 {
    let [least, most] = COUNTED;
    n_ticks.min((n_ticks / COUNTED_OF).clamp(least, most))
}

/// The nth tick to be counted: all in their order, or spread evenly over more than can be, however
/// many and whatever repeats.
fn nth_counted(nth: u64, n_ticks: u64) -> u64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    if n_counted(n_ticks) == n_ticks {
        return nth;
    }
    to_whole((nth as f64 * GOLDEN).fract() * n_ticks as f64)
}

/// A pair of neighbouring nodes that a table would need: of which spectra, of which point where
/// each has nodes of its own, how many bins sound there, and which part of an octave it is.
type NodePair = (usize, usize, usize, usize);

/// Counting what ticks evaluate, without evaluating it.
struct Count {
    displays: Vec<DisplayPlan>,
    poses: Vec<Pose>,
    work: Work,
    /// One for each tick and direction that needs it.
    pairs: Vec<NodePair>,
    /// How many of them came from the first half of the ticks.
    n_first_pairs: usize,
}

impl Count {
    /// Parts of an octave that share a pair of nodes.
    const PARTS_PER_OCTAVE: f64 = 48.0;
    /// Nodes to be made for a pair: its neighbours have made one of them as often as not.
    const NODES_A_PAIR: f64 = 1.5;

    fn of(scene: &RenderScene) -> Self {
        Self {
            displays: scene.displays.iter().map(DisplayPlan::new).collect(),
            poses: vec![Pose::default(); scene.displays.len()],
            work: Work::default(),
            pairs: Vec::new(),
            n_first_pairs: 0,
        }
    }

    /// Counts a tick of a path.
    fn add(&mut self, plan: &ScenePlan, path: &ExplorationPath, tick: u64) {
        let Some((_, pose)) = PathCursor::at(path, tick).step(path) else {
            return;
        };
        path.poses_into(&pose, &mut self.poses);
        let counters = &mut Counters::default();
        for (display, pose) in self.displays.iter_mut().zip(&self.poses) {
            let Some(pose) = finite_pose(pose, counters) else {
                continue;
            };
            display.begin(pose.angle_deg, counters);
            let (work, pairs) = (&mut self.work, &mut self.pairs);
            plan.for_each_touched(display, &pose, counters, |contacts, _| {
                for axis in Axis::BOTH {
                    work.add(plan, (contacts, axis), pairs);
                }
            });
        }
    }

    /// The work of `factor` times as many ticks.
    fn scaled(mut self, plan: &ScenePlan, factor: f64) -> Work {
        let of_gains = self
            .pairs
            .iter()
            .map(|(_, _, n_bins, part)| (0, 0, *n_bins, *part));
        let mut of_gains: Vec<NodePair> = of_gains.collect();
        let n_points = |(spectra, ..): &NodePair| {
            let spectra = &plan.pool[*spectra];
            if RowTable::suits(spectra) {
                spectra.n_points() as f64
            } else {
                1.0
            }
        };
        let most = most_node_bins(&self.pairs);
        let mut touched: Vec<usize> = self.pairs.iter().map(|(spectra, ..)| *spectra).collect();
        touched.sort_unstable();
        touched.dedup();
        let touched = touched
            .into_iter()
            .map(|spectra| plan.pool[spectra].n_points());
        let n_touched = touched.sum::<usize>() as f64;
        let n_first = self.n_first_pairs;
        let work = &self.work;
        Work {
            directions: factor * work.directions,
            bins: factor * work.bins,
            speeds: factor * work.speeds,
            speed_bins: factor * work.speed_bins,
            point_bins: factor * work.point_bins,
            node_bins_made: [
                node_bins(&mut of_gains, (n_first, factor), |_| 1.0).min(most),
                node_bins(&mut self.pairs, (n_first, factor), n_points).min(most * n_touched),
            ],
        }
    }
}

impl Work {
    /// Adds what contactors on a textile feel along an axis in a tick, and the nodes of tables that
    /// it takes.
    fn add(
        &mut self,
        plan: &ScenePlan,
        (contacts, axis): (&Contacts<'_>, Axis),
        pairs: &mut Vec<NodePair>,
    ) {
        let textile = &plan.textiles[contacts.textile];
        let is_together = matches!(contacts.motion, Motion::Together(_));
        let (mut n_speeds, mut seen) = (0.0, [0_u64; 4]);
        for contactor in (0..contacts.owners.len()).filter(|&nth| contacts.owns(nth)) {
            let feel = contacts.feel(textile, axis, contactor, &mut Counters::default());
            let Some(feel) = feel else {
                continue;
            };
            let n_bins = n_audible_bins(feel.speed_mm_per_s);
            self.directions += 1.0;
            self.bins += n_bins as f64;
            if !is_together || n_speeds == 0.0 {
                n_speeds += 1.0;
                self.speed_bins += n_bins as f64;
            }
            // A display is smaller than 256 mm: no two of its points share a bit.
            let (word, bit) = (feel.point / 64 % seen.len(), 1 << (feel.point % 64));
            if !is_together || seen[word] & bit == 0 {
                self.point_bins += n_bins as f64;
            }
            seen[word] |= bit;
            let octaves = feel.speed_mm_per_s.log2() - MIN_SPEED_MM_PER_S.log2();
            let part = to_index(octaves * Count::PARTS_PER_OCTAVE);
            let by_row = RowTable::suits(&plan.pool[feel.spectra]);
            let pair = (
                feel.spectra,
                if by_row { 0 } else { feel.point },
                n_bins,
                part,
            );
            if pairs.last() != Some(&pair) {
                pairs.push(pair);
            }
        }
        self.speeds += n_speeds;
    }
}

/// Bins of all nodes of some pairs, weighted, had there been `factor` times as many ticks: new ones
/// come as they came from the first half of the ticks to all, by a power law, as new words do in a
/// text (Heaps 1978).
fn node_bins(
    pairs: &mut [NodePair],
    (n_first, factor): (usize, f64),
    weight: impl Fn(&NodePair) -> f64,
) -> f64 {
    let distinct = |pairs: &mut [NodePair]| -> f64 {
        pairs.sort_unstable();
        let alike = pairs.chunk_by(|a, b| a == b);
        alike
            .map(|alike| alike[0].2 as f64 * weight(&alike[0]))
            .sum()
    };
    let first = distinct(&mut pairs[..n_first]);
    let all = distinct(pairs);
    let exponent = (all / first).log2().clamp(0.0, 1.0);
    let growth = if exponent.is_finite() {
        factor.powf(exponent)
    } else {
        1.0
    };
    Count::NODES_A_PAIR * all * growth
}

/// Bins of all nodes between the slowest and the fastest of some pairs.
fn most_node_bins(pairs: &[NodePair]) -> f64 {
    let parts = pairs.iter().map(|(_, _, _, part)| *part);
    let (Some(slowest), Some(fastest)) = (parts.clone().min(), parts.max()) else {
        return 0.0;
    };
    let bins = pairs.iter().map(|(_, _, n_bins, _)| *n_bins);
    let (fewest, most) = (bins.clone().min().unwrap_or(1), bins.max().unwrap_or(1));
    // Every segment has its own two ends, and so many parts between.
    let ends: f64 = (fewest..=most).map(|k| 2.0 * k as f64).sum();
    ends + (fastest - slowest + 1) as f64 * most as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::array::ArrayRenderer;
    use crate::scene::{LoadedScene, PathRow};
    use selvedge_foundation::geometry::Point;

    fn four() -> RenderScene {
        RenderScene::of(&LoadedScene::shipped().unwrap())
    }

    /// To and fro over all four textiles, turning or not.
    fn path(n_ticks: u32, turn_deg: f64) -> ExplorationPath {
        let row = |tick: u32| {
            let t_s = f64::from(tick) / TICKS_PER_S;
            let [x_mm, y_mm] = [1.3, 1.9].map(|rate: f64| 130.0 + 110.0 * (rate * t_s).sin());
            PathRow {
                t_s,
                position: Point::new(x_mm, y_mm),
                angle_deg: turn_deg * t_s,
                velocity: None,
            }
        };
        ExplorationPath::new((0..n_ticks).map(row).collect()).unwrap()
    }

    fn chosen(scene: &RenderScene, path: &ExplorationPath, budget_db: f64) -> Method {
        let accuracy = Accuracy::within_db(budget_db);
        let renderer = ArrayRenderer::prepare_along(scene, Method::Auto, &accuracy, path);
        renderer.unwrap().method()
    }

    #[test]
    fn what_is_counted_is_what_the_methods_do() {
        let scene = four();
        let plan = ScenePlan::of(&scene);
        for path in [path(300, 0.0), path(300, 40.0)] {
            let work = Work::along(&scene, &plan, &path);
            let accuracy = Accuracy {
                banded_floor: 0.0,
                ..Accuracy::default()
            };
            let counters = [Method::Reference, Method::Banded, Method::Table].map(|method| {
                let mut renderer = ArrayRenderer::prepare(&scene, method, &accuracy).unwrap();
                for (_, pose) in path.ticks() {
                    renderer.tick(&[pose]);
                }
                *renderer.counters()
            });
            let [reference, banded, table] = counters;
            let is = |found: f64, bins: u64| (2.0 * found - bins as f64).abs() < 0.5;
            assert!(is(work.bins, reference.bins_evaluated), "{work:?}");
            assert!(is(work.point_bins, banded.bins_evaluated), "{work:?}");
            let directions = reference.directions_evaluated as f64;
            assert!((work.directions - directions).abs() < 0.5, "{work:?}");
            let made = 0.5 * table.bins_evaluated as f64;
            let ratio = work.node_bins_made[1] / made;
            assert!((0.5..2.0).contains(&ratio), "{ratio}");
        }
    }

    #[test]
    fn a_part_of_the_ticks_tells_of_all() {
        let scene = four();
        let plan = ScenePlan::of(&scene);
        let long = path(8000, 0.0);
        let work = Work::along(&scene, &plan, &long);
        let mut count = Count::of(&scene);
        for tick in 0..8000 {
            count.add(&plan, &long, tick);
        }
        let whole = count.scaled(&plan, 1.0);
        let near = |a: f64, b: f64, share: f64| (a / b - 1.0).abs() < share;
        assert!(near(work.bins, whole.bins, 0.1), "{work:?} for {whole:?}");
        assert!(
            near(work.point_bins, whole.point_bins, 0.1),
            "{work:?} for {whole:?}"
        );
        let nodes =
            [0, 1].map(|kind: usize| (work.node_bins_made[kind], whole.node_bins_made[kind]));
        assert!(nodes.iter().all(|(a, b)| near(*a, *b, 0.5)), "{nodes:?}");
    }

    #[test]
    fn preparing_is_weighed_against_the_ticks_that_follow() {
        let scene = four();
        assert_eq!(
            chosen(&scene, &path(1, 0.0), 0.05),
            Method::Reference,
            "it rests"
        );
        assert_eq!(chosen(&scene, &path(40, 0.0), 0.05), Method::Banded);
        assert_eq!(chosen(&scene, &path(144_000, 0.0), 0.05), Method::Table);
        assert_eq!(chosen(&scene, &path(24_000, 40.0), 0.05), Method::Table);
        assert_eq!(chosen(&scene, &path(2400, 0.0), 1e-5), Method::Banded);
        assert_eq!(chosen(&scene, &path(2400, 0.0), 0.0), Method::Reference);
        let beside = ExplorationPath::new(vec![
            PathRow {
                position: Point::new(-500.0, 0.0),
                ..PathRow::default()
            },
            PathRow {
                t_s: 3600.0,
                position: Point::new(-900.0, 0.0),
                ..PathRow::default()
            },
        ]);
        assert_eq!(chosen(&scene, &beside.unwrap(), 0.05), Method::Reference);
    }
}
