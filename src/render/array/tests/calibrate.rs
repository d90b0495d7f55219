//! Temporary.
use super::*;
use crate::array::auto;
use crate::scene::{ExplorationPath, LoadedScene, PathRow};
use std::hint::black_box;
use std::time::Instant;

fn time<T>(n: usize, mut work: impl FnMut() -> T) -> f64 {
    black_box(work());
    let mut best = f64::INFINITY;
    for _ in 0..7 {
        let start = Instant::now();
        for _ in 0..n {
            black_box(work());
        }
        best = best.min(start.elapsed().as_secs_f64() * 1e9 / n as f64);
    }
    best
}

fn path(n_ticks: u32, turn_deg: f64) -> ExplorationPath {
    let row = |tick: u32| {
        let t_s = f64::from(tick) / 40.0;
        let [x_mm, y_mm] = [1.3, 1.9].map(|rate: f64| 130.0 + 110.0 * (rate * t_s).sin());
        PathRow { t_s, position: Point::new(x_mm, y_mm), angle_deg: turn_deg * t_s, velocity: None }
    };
    ExplorationPath::new((0..n_ticks).map(row).collect()).unwrap()
}

#[test]
#[ignore]
fn calibrate() {
    let scene = RenderScene::of(&LoadedScene::shipped().unwrap());
    let accuracy = Accuracy::default();
    for method in METHODS3 {
        println!("prepare {method:?}: {:.0} ns", time(20, || ArrayRenderer::prepare(&scene, method, &accuracy)));
    }
    let plan = crate::plan::ScenePlan::of(&scene);
    println!("plan {:.0}", time(50, || crate::plan::ScenePlan::of(&scene)));
    println!("grid {:.0}", time(50, || crate::array::table::Grid::new(&scene.filters, 0.05)));
    let receptor = selvedge_textile::tactile::Filters::Receptor;
    println!("grid receptor {:.0}", time(2, || crate::array::table::Grid::new(&receptor, 0.05)));
    println!("banded {:.0}", time(50, || crate::array::banded::BandedEvaluator::prepare(&plan, &scene.filters, 1e-6)));
    for (v, w) in [(100.0, 70.0), (5.0, 7.0), (900.0, 400.0)] {
        for omega in [0.0, 2.0] {
            let at = Pose { angular_rad_per_s: omega, ..pose([60.0, 60.0], [v, w]) };
            for method in METHODS3 {
                let mut r = renderer(&scene, method);
                r.tick(&[at]);
                let mut other = at;
                let t = time(200, || { other.position.x_mm = 120.0 - other.position.x_mm + 0.5; r.tick(&[other]); });
                println!("{v} {w} omega {omega} {method:?}: {t:.0} ns a tick");
            }
        }
    }
    for turn in [0.0, 40.0] {
        for n in [40, 2400, 24000] {
            let p = path(n, turn);
            let poses: Vec<Pose> = p.ticks().map(|(_, pose)| pose).collect();
            println!("count of {n}: {:.0} ns", time(2, || auto::tests::work(&scene, &plan, &p)));
            println!("  {:?}", auto::tests::work(&scene, &plan, &p));
            println!("  {:?}", auto::tests::costs(&scene, &plan, &p));
            for method in [Method::Banded, Method::Table] {
                let t = time(1, || { let mut r = renderer(&scene, method); for pose in &poses { r.tick(std::slice::from_ref(pose)); } });
                let mut r = renderer(&scene, method);
                for pose in &poses { r.tick(std::slice::from_ref(pose)); }
                let bins = r.counters().bins_evaluated;
                let warm = time(1, || { for pose in &poses { r.tick(std::slice::from_ref(pose)); } });
                println!("  {method:?} {n} turn {turn}: {t:.0} ns, warm {warm:.0}, bins {bins} nodes {}", r.counters().nodes_made);
            }
        }
    }
}
const METHODS3: [Method; 3] = [Method::Reference, Method::Banded, Method::Table];
