//! An edited scene on its way to the engine.
//!
//! Tables are made as they are touched, so that moving a textile, other filters or another error
//! budget cost little; a new textile is read, which takes longer, on a thread of its own. Edits
//! that come meanwhile wait, and only the last of them is prepared.

use crate::bench::background::{Executor, Task, finished};
use crate::bench::rendering::Rendering;
use selvedge_engine::PreparedScene;
use selvedge_render::scene::{LoadedScene, PlacedTextile, Scene};

/// A scene that is ready for the engine.
#[derive(Debug)]
pub(crate) struct Ready {
    /// The scene with its textiles.
    pub loaded: LoadedScene,
    /// The same as the engine takes it.
    pub prepared: Box<PreparedScene>,
    /// How it was prepared.
    pub rendering: Rendering,
}

/// Prepares edited scenes, one at a time.
#[derive(Default)]
pub(crate) struct Preparing {
    task: Option<Task<Ready>>,
    next: Option<Scene>,
}

impl Preparing {
    /// Whether a thread is at work.
    pub(crate) fn is_busy(&self) -> bool {
        self.task.is_some()
    }

    /// Prepares a scene whose textiles are mostly those of `loaded`. What takes no time comes back
    /// now.
    pub(crate) fn ask(
        &mut self,
        loaded: &LoadedScene,
        (scene, rendering): (Scene, Rendering),
        executor: &Executor,
    ) -> Option<Result<Ready, String>> {
        if self.task.is_some() {
            self.next = Some(scene);
            return None;
        }
        if scene.textiles.iter().all(|cloth| loaded.knows(&cloth.id)) {
            return Some(prepare(loaded, (scene, rendering)));
        }
        let loaded = loaded.clone();
        self.task = Some(executor.start("selvedge-prepare", move |_| {
            prepare(&loaded, (scene, rendering))
        }));
        None
    }

    /// What was prepared, if it is done, and the scene that waited meanwhile.
    pub(crate) fn poll(&mut self) -> Option<(Result<Ready, String>, Option<Scene>)> {
        let outcome = finished(&mut self.task)?;
        Some((outcome, self.next.take()))
    }
}

fn prepare(loaded: &LoadedScene, (scene, rendering): (Scene, Rendering)) -> Result<Ready, String> {
    let loaded = loaded
        .with_scene(scene)
        .map_err(|error| error.to_string())?;
    let accuracy = rendering.accuracy();
    let prepared = PreparedScene::prepare(&loaded, rendering.method, &accuracy);
    Ok(Ready {
        prepared: Box::new(prepared.map_err(|error| error.to_string())?),
        loaded,
        rendering,
    })
}

/// Whether two scenes differ in anything but gains, so that the engine needs a new one.
pub(crate) fn differs(before: &Scene, after: &Scene) -> bool {
    let placed = |scene: &Scene| -> Vec<PlacedTextile> {
        scene.textiles.iter().map(PlacedTextile::untuned).collect()
    };
    let is_same = before.filters == after.filters
        && before.displays == after.displays
        && placed(before) == placed(after);
    !is_same
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::command::edit::Edit;
    use crate::bench::editing::apply;
    use selvedge_foundation::geometry::Point;
    use selvedge_textile::tactile::Filters;

    #[test]
    fn gains_and_labels_need_no_new_scene_and_places_do() {
        let loaded = LoadedScene::shipped().unwrap();
        let before = loaded.scene();
        let needs = |edit: Edit| {
            let mut after = before.clone();
            apply(&edit, &mut after, loaded.tuning());
            differs(before, &after)
        };
        assert!(!needs(Edit::TextileGain(0, 3.0)) && !needs(Edit::Compression(0.5)));
        assert!(!needs(Edit::Label(0, "A".to_owned())));
        assert!(needs(Edit::MoveCloth(0, Point::new(1.0, 2.0))));
        assert!(needs(Edit::TurnCloth(1, 10.0)) && needs(Edit::RemoveCloth(2)));
        assert!(needs(Edit::Filters(Filters::Receptor)));
    }

    #[test]
    fn a_moved_textile_is_ready_at_once_and_a_new_one_later() {
        let threads = Executor::Threads(eframe::egui::Context::default());
        let loaded = LoadedScene::shipped().unwrap();
        let mut preparing = Preparing::default();
        let mut scene = loaded.scene().clone();
        apply(
            &Edit::MoveCloth(0, Point::new(1.0, 2.0)),
            &mut scene,
            loaded.tuning(),
        );
        let how = Rendering::default();
        let ready = preparing.ask(&loaded, (scene.clone(), how), &threads);
        let moved = ready.expect("at once").expect("it makes sense").loaded;
        assert_eq!(*moved.scene(), scene);
        let add = |scene: &mut Scene, id: &str| {
            let edit = Edit::AddCloth(id.to_owned(), Point::new(50.0, 50.0));
            apply(&edit, scene, loaded.tuning());
        };
        let new = loaded
            .library()
            .ids()
            .iter()
            .find(|id| scene.textiles.iter().all(|cloth| cloth.id != **id))
            .unwrap();
        add(&mut scene, new);
        let asked = preparing.ask(&moved, (scene.clone(), how), &threads);
        assert!(asked.is_none(), "it takes a while");
        let mut last = scene.clone();
        add(&mut last, new);
        let asked = preparing.ask(&moved, (last.clone(), how), &threads);
        assert!(asked.is_none(), "it waits");
        let (outcome, waiting) = loop {
            if let Some(done) = preparing.poll() {
                break done;
            }
            std::thread::yield_now();
        };
        assert_eq!(*outcome.unwrap().loaded.scene(), scene);
        assert_eq!(waiting, Some(last), "the last edit is still to come");
    }
}
