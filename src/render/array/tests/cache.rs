//! Tables that are kept give the amplitudes of tables that are computed.

use super::*;
use crate::array::TableCache;
use crate::scene::LoadedScene;
use selvedge_textile::tactile::Filters;

fn shipped() -> RenderScene {
    RenderScene::of(&LoadedScene::shipped().unwrap())
}

/// Amplitudes along a stroke that turns and crosses the textiles.
fn stroke(mut renderer: ArrayRenderer) -> Vec<Vec<[f32; 2]>> {
    let pose = |n: u32| {
        let (sin, cos) = (f64::from(n) * 0.05).sin_cos();
        Pose {
            position: Point::new(110.0 + 70.0 * cos, 110.0 + 70.0 * sin),
            velocity: Velocity::new(-(f64::from(n)) * sin, f64::from(n) * cos),
            angle_deg: f64::from(n),
            angular_rad_per_s: if n.is_multiple_of(3) { 0.4 } else { 0.0 },
            ..Pose::default()
        }
    };
    let tick = |n| renderer.tick(&[pose(n)])[0].amplitudes_um().to_vec();
    (0..200).map(tick).collect()
}

fn cached(scene: &RenderScene, cache: &mut TableCache) -> ArrayRenderer {
    let accuracy = Accuracy::default();
    ArrayRenderer::prepare_with_cache(scene, Method::Auto, &accuracy, cache).unwrap()
}

fn has_all(scene: &RenderScene, cache: &TableCache) -> bool {
    cache.has_all(scene, Method::Auto, &Accuracy::default())
}

#[test]
fn a_scene_from_the_cache_is_felt_as_one_computed_anew_bit_for_bit() {
    let mut cache = TableCache::default();
    let mut scene = shipped();
    assert!(!has_all(&scene, &cache), "nothing is known yet");
    let first = cached(&scene, &mut cache);
    assert_eq!(first.method(), Method::Table);
    // Moved, turned, one of them gone, and one under another's gain.
    scene.textiles[0].workspace_from_textile.origin = Point::new(31.0, 47.0);
    scene.textiles[1].workspace_from_textile.rotation = Rotation::from_degrees(20.0);
    scene.textiles[2].scene_gain_db = -6.0;
    scene.textiles.remove(3);
    assert!(has_all(&scene, &cache), "only places and gains changed");
    let n_bytes = cache.n_bytes();
    let edited = stroke(cached(&scene, &mut cache));
    assert_eq!(cache.n_bytes(), n_bytes, "nothing was computed");
    let anew = ArrayRenderer::prepare(&scene, Method::Auto, &Accuracy::default()).unwrap();
    assert!(edited.iter().flatten().filter(|a| a[0] > 0.0).count() > 1000);
    assert_eq!(edited, stroke(anew));
}

#[test]
fn other_filters_budgets_and_surfaces_are_computed_anew() {
    let mut cache = TableCache::default();
    let scene = shipped();
    drop(cached(&scene, &mut cache));
    for filters in [Filters::Receptor, Filters::LogGaussian { octaves: 1.3 }] {
        let other = RenderScene {
            filters,
            ..scene.clone()
        };
        assert!(!has_all(&other, &cache));
        let anew = ArrayRenderer::prepare(&other, Method::Auto, &Accuracy::default()).unwrap();
        assert_eq!(stroke(cached(&other, &mut cache)), stroke(anew));
        assert!(has_all(&other, &cache));
    }
    let finer = Accuracy::within_db(0.01);
    assert!(!cache.has_all(&scene, Method::Auto, &finer));
    let by_cache = ArrayRenderer::prepare_with_cache(&scene, Method::Table, &finer, &mut cache);
    let anew = ArrayRenderer::prepare(&scene, Method::Table, &finer).unwrap();
    assert_eq!(stroke(by_cache.unwrap()), stroke(anew));
    // The same textiles loaded again are other surfaces: they lie elsewhere in memory.
    assert!(!has_all(&shipped(), &cache));
    assert!(cache.has_all(&shipped(), Method::Banded, &Accuracy::default()));
}

#[test]
fn the_cache_forgets_what_the_newest_scene_does_not_use() {
    let (one, other) = (shipped(), shipped());
    let mut cache = TableCache::default();
    drop(cached(&one, &mut cache));
    let n_bytes = cache.n_bytes();
    let mut cache = TableCache::with_limit(n_bytes * 3 / 2);
    drop(cached(&one, &mut cache));
    drop(cached(&other, &mut cache));
    assert_eq!(cache.n_bytes(), n_bytes, "only one of them fits");
    assert!(has_all(&other, &cache) && !has_all(&one, &cache));
    // A scene that is larger than the cache stays while it is in use.
    let mut small = TableCache::with_limit(1);
    drop(cached(&one, &mut small));
    assert!(has_all(&one, &small));
    let mut fewer = one.clone();
    fewer.textiles.truncate(1);
    drop(cached(&fewer, &mut small));
    assert!(small.n_bytes() < n_bytes / 2);
    assert!(has_all(&fewer, &small) && !has_all(&one, &small));
}

#[test]
fn a_clone_shares_its_tables_and_goes_its_own_way() {
    let mut cache = TableCache::default();
    let scene = shipped();
    let mut filled = cache.clone();
    drop(cached(&scene, &mut filled));
    assert!(has_all(&scene, &filled) && !has_all(&scene, &cache));
    cache = filled;
    assert!(has_all(&scene, &cache));
}
