//! How strong every textile of the scene's library is under the scene's filters.
//!
//! The library's index says it for the filters that it was made with. Under others every textile
//! is measured on a thread, anew whenever filters or library change; until that is done the figures
//! under the filters before stand, and whoever shows them says that they are old.

use std::collections::BTreeMap;
use std::sync::Arc;

use eframe::egui;

use crate::bench::background::Executor;
use crate::bench::latest::{Computed, Latest};
use crate::bench::library_view::LibraryView;
use crate::bench::view::{LibraryDot, LibraryEntry};
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_render::scene::LoadedScene;
use selvedge_textile::surface::Surface;
use selvedge_textile::tactile::{Filters, Levels, loudest_um};
use selvedge_textile::{Library, Textile};

/// Surfaces that are kept for the next filters; those of more textiles are read again.
const MAX_SURFACES: usize = 32;

/// What levels are of.
#[derive(Debug, Clone)]
struct Key {
    library: Arc<Library>,
    filters: Filters,
    /// Textiles that need not be read, since the scene has them.
    loaded: Vec<Arc<Textile>>,
}

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.library, &other.library) && self.filters == other.filters
    }
}

/// The levels of a library's textiles by their ids; those that cannot be read are left out.
#[derive(Debug, Default)]
struct Measured {
    levels: BTreeMap<String, Levels>,
    loudest_um: BTreeMap<String, Vec<[f64; 2]>>,
    surfaces: BTreeMap<String, Arc<Surface>>,
}

impl Computed<Key> for Measured {
    const THREAD: &str = "selvedge-levels";

    fn compute(
        key: &Key,
        prior: Option<(&Key, &Self)>,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let prior = prior.filter(|(before, _)| Arc::ptr_eq(&before.library, &key.library));
        let known = |id: &str| {
            let loaded = key.loaded.iter().find(|textile| textile.id() == id);
            let loaded = loaded.map(|textile| textile.surface());
            loaded.or_else(|| prior?.1.surfaces.get(id)).map(Arc::clone)
        };
        let mut measured = Self::default();
        let ids = key.library.ids();
        for (done, id) in ids.iter().enumerate() {
            progress.step(done as f64 / ids.len() as f64, id)?;
            let read = || Some(Arc::clone(key.library.load(id).ok()?.surface()));
            let Some(surface) = known(id).or_else(read) else {
                continue;
            };
            let levels = Levels::of(&surface, &key.filters);
            measured.levels.insert(id.clone(), levels);
            let loudest_um = loudest_um(&surface, &key.filters);
            measured.loudest_um.insert(id.clone(), loudest_um);
            if measured.surfaces.len() < MAX_SURFACES {
                measured.surfaces.insert(id.clone(), surface);
            }
        }
        Ok(measured)
    }

    fn broken(_: &Key, _: &str) -> Self {
        Self::default()
    }

    fn serves(under_way: &Key, now: &Key) -> bool {
        under_way == now
    }
}

/// The textiles of the scene's library that have a level.
#[derive(Debug, Default)]
pub(crate) struct LibraryLevels {
    /// In the library's order.
    pub(crate) dots: Vec<LibraryDot>,
    /// Whether those outside the scene are still under the filters before.
    pub(crate) is_stale: bool,
    latest: Latest<Key, Measured>,
}

impl LibraryLevels {
    /// Has the whole library measured under the present filters, as long as it is asked for that,
    /// and takes what was measured. The index has levels, but not what is loudest.
    pub(crate) fn follow(
        &mut self,
        (ctx, executor): (&egui::Context, &Executor),
        loaded: &LoadedScene,
        library_view: &LibraryView,
        wants_loudest: bool,
    ) {
        let before = self.latest.value().map(Arc::as_ptr);
        self.latest.poll();
        if self.is_stale || wants_loudest {
            let key = Key {
                library: Arc::clone(library_view.library()),
                filters: loaded.scene().filters,
                loaded: loaded.textiles().to_vec(),
            };
            self.latest.follow(ctx, executor, &key);
        }
        if self.latest.value().map(Arc::as_ptr) != before {
            self.renew(loaded, library_view);
        }
    }

    /// The loudest pairs of amplitudes of a textile under filters, by [`loudest_um`]; `None` until
    /// the library was measured.
    pub(crate) fn loudest_um(&self, id: &str, filters: &Filters) -> Option<&[[f64; 2]]> {
        let key = self.latest.key();
        let is_fresh = key.is_some_and(|key| key.filters == *filters);
        let measured = self.latest.value().filter(|_| is_fresh)?;
        measured.loudest_um.get(id).map(Vec::as_slice)
    }

    /// Makes the dots anew: of the scene as it is, and of the library as far as it is measured.
    pub(crate) fn renew(&mut self, loaded: &LoadedScene, library_view: &LibraryView) {
        let filters = &loaded.scene().filters;
        let library = library_view.library();
        let is_indexed = library.index().is_some() && *filters == Filters::default();
        let key = self.latest.key();
        let is_fresh = |key: &Key| Arc::ptr_eq(&key.library, library) && key.filters == *filters;
        self.is_stale = !is_indexed && !key.is_some_and(is_fresh);
        let of_library = key.filter(|key| key.library.root() == library.root());
        let measured = of_library.and_then(|_| self.latest.value());
        let is_stale = self.is_stale;
        let dot = |item: &LibraryEntry| {
            let placed = loaded.textiles().iter().find(|one| one.id() == item.id);
            let (mean_um, level_db) = match placed {
                _ if is_indexed => (item.mean_um, item.level_db),
                Some(textile) => figures(&Levels::of(textile.surface(), filters)),
                None => match measured.and_then(|all| all.levels.get(&item.id)) {
                    Some(levels) => figures(levels),
                    None if is_stale => (item.mean_um, item.level_db),
                    None => return None,
                },
            };
            Some(LibraryDot {
                id: item.id.clone(),
                name: item.name.clone(),
                mean_um,
                gain_db: item.gain_db,
                level_db: level_db?,
                is_placed: placed.is_some(),
            })
        };
        self.dots = library_view.items().iter().filter_map(dot).collect();
    }
}

fn figures(levels: &Levels) -> ([f64; 2], Option<f64>) {
    (levels.mean_um, levels.level_db())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::command::edit::Edit;
    use crate::bench::{Bench, Drive};

    fn wider(bench: &mut Bench, octaves: f64) {
        let filters = Filters::LogGaussian { octaves };
        bench.edit(&Edit::Filters(filters));
        while bench.engine_scene.loaded.scene().filters != filters {
            bench.poll_prepared();
            std::thread::yield_now();
        }
    }

    #[test]
    fn other_filters_leave_the_range_that_of_the_whole_library() {
        let ctx = egui::Context::default();
        let mut bench = Bench::new(&ctx, None, Drive::Stepped).unwrap();
        assert_eq!(bench.library.levels.dots.len(), 16, "from the index");
        wider(&mut bench, 2.5);
        let levels = &bench.library.levels;
        assert!(
            levels.is_stale && levels.dots.len() == 16,
            "not measured yet"
        );
        bench.follow_library_levels();
        let levels = &bench.library.levels;
        assert!(levels.dots.len() == 16 && !levels.is_stale);
        let library = bench.library.view.library();
        for dot in &levels.dots {
            let textile = library.load(&dot.id).unwrap();
            let filters = Filters::LogGaussian { octaves: 2.5 };
            let expected = Levels::of(textile.surface(), &filters);
            assert_eq!(dot.mean_um, expected.mean_um, "{}", dot.id);
        }
    }

    #[test]
    fn the_levels_before_stand_until_the_new_ones_are_there() {
        let ctx = egui::Context::default();
        let mut bench = Bench::new(&ctx, None, Drive::Stepped).unwrap();
        wider(&mut bench, 2.5);
        bench.follow_library_levels();
        let before = bench.library.levels.dots.clone();
        bench.executor = Executor::Threads(ctx);
        for octaves in [3.0, 3.5] {
            wider(&mut bench, octaves);
            bench.follow_library_levels();
        }
        let levels = &bench.library.levels;
        assert!(levels.is_stale && levels.dots.len() == before.len());
        while bench.library.levels.is_stale {
            bench.follow_library_levels();
            std::thread::yield_now();
        }
        assert_ne!(bench.library.levels.dots, before);
    }
}
