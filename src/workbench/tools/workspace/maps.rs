//! Maps of textiles: what each would give all over at one velocity, as pictures for the workspace.
//!
//! A map repeats with the points of its profiles, so its picture holds one pixel a pair of points
//! and is tiled over the cloth. It is made on a thread of its own, and anew only when something
//! that it shows has changed; until it is done the last one stays, unless the textile is another.

use std::fmt;

use eframe::egui::{
    self, Color32, ColorImage, TextureFilter, TextureHandle, TextureOptions, TextureWrapMode,
};

use crate::bench::job::{Job, Polled};
use crate::kit::amplitude::AmplitudeScale;
use crate::kit::theme::colour_map::ColourMap;
use selvedge_foundation::geometry::Velocity;
use selvedge_render::array::{ContactInspector, TextileResponse, VelocityMap};
use selvedge_textile::tactile::Band;

/// Cells are told apart where they are large, and blend where several share a pixel.
const OPTIONS: TextureOptions = TextureOptions {
    magnification: TextureFilter::Nearest,
    minification: TextureFilter::Linear,
    wrap_mode: TextureWrapMode::Repeat,
    mipmap_mode: None,
};

/// What maps are wanted for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wanted {
    /// The velocity in the workspace.
    pub velocity: Velocity,
    /// Which amplitude.
    pub band: Band,
    /// The scale of amplitudes.
    pub scale: AmplitudeScale,
    /// The colours on it.
    pub colours: ColourMap,
}

/// The maps of a scene's textiles, by their place in its list.
#[derive(Default)]
pub(crate) struct Maps {
    slots: Vec<Option<Slot>>,
    job: Option<Job<Vec<Made>>>,
    n_computed: u64,
}

/// What one map shows.
#[derive(Debug, Clone)]
struct Key {
    response: TextileResponse,
    wanted: Wanted,
}

/// A map as it is shown.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ShownMap<'a> {
    /// The amplitudes.
    pub map: &'a VelocityMap,
    /// What they are of, and how they are coloured.
    pub wanted: Wanted,
}

/// A map and its picture on the graphics card.
struct Slot {
    key: Key,
    map: VelocityMap,
    texture: TextureHandle,
}

/// What a thread brings back: which textile, what it shows, its picture.
struct Made {
    index: usize,
    key: Key,
    map: VelocityMap,
    image: ColorImage,
}

impl Key {
    fn is_same(&self, other: &Self) -> bool {
        self.wanted == other.wanted && self.response.is_same(&other.response)
    }
}

impl Maps {
    /// Has every textile's map as it is wanted, at once or as soon as a thread has made it.
    pub(crate) fn catch_up(
        &mut self,
        ctx: &egui::Context,
        inspector: &ContactInspector,
        wanted: Wanted,
        is_at_once: bool,
    ) {
        self.take(ctx);
        let responses = (0..).map_while(|textile| inspector.response(textile));
        let mut stale = Vec::new();
        let mut n_textiles = 0;
        for (index, response) in responses.enumerate() {
            n_textiles = index + 1;
            self.slots
                .resize_with(self.slots.len().max(n_textiles), || None);
            let slot = &mut self.slots[index];
            let is_other = |slot: &Slot| !slot.key.response.is_same_cloth(&response);
            if slot.as_ref().is_some_and(is_other) {
                *slot = None;
            }
            let key = Key { response, wanted };
            if !slot.as_ref().is_some_and(|slot| slot.key.is_same(&key)) {
                stale.push((index, key));
            }
        }
        self.slots.truncate(n_textiles);
        if stale.is_empty() || self.job.is_some() {
            return;
        }
        self.n_computed += stale.len() as u64;
        let most = ctx.input(|input| input.max_texture_side);
        let work = move || -> Vec<Made> {
            let made = |(index, key)| made(index, key, most);
            stale.into_iter().filter_map(made).collect()
        };
        if is_at_once {
            self.put(ctx, work());
        } else {
            // Without a thread the map stays as it was; the next frame asks again.
            self.job = Job::start("selvedge-maps", ctx, work).ok();
        }
    }

    /// Takes what a thread has made.
    fn take(&mut self, ctx: &egui::Context) {
        match self.job.as_ref().map(Job::poll) {
            Some(Polled::Done(made)) => {
                self.job = None;
                self.put(ctx, made);
            }
            Some(Polled::BrokeOff) => self.job = None,
            Some(Polled::Working) | None => {}
        }
    }

    fn put(&mut self, ctx: &egui::Context, made: Vec<Made>) {
        for Made {
            index,
            key,
            map,
            image,
        } in made
        {
            let Some(place) = self.slots.get_mut(index) else {
                continue;
            };
            if let Some(slot) = place {
                slot.texture.set(image, OPTIONS);
                (slot.key, slot.map) = (key, map);
            } else {
                let texture = ctx.load_texture(format!("map {index}"), image, OPTIONS);
                *place = Some(Slot { key, map, texture });
            }
        }
    }

    /// Forgets all maps, and what is on its way.
    pub(crate) fn clear(&mut self) {
        self.slots.clear();
        self.job = None;
    }

    /// The picture of a textile's map and the points along warp and weft that it holds; `None`
    /// while there is none, and for a textile that is not felt at all.
    pub(crate) fn picture(&self, textile: usize) -> Option<(egui::TextureId, [usize; 2])> {
        let slot = self.slots.get(textile)?.as_ref()?;
        let factor = slot.key.response.factors()[slot.key.wanted.band.index()];
        (factor > 0.0).then(|| (slot.texture.id(), slot.map.n_points()))
    }

    /// The map of a textile; `None` while there is none, and for a textile that is not felt at all.
    pub(crate) fn shown(&self, textile: usize) -> Option<ShownMap<'_>> {
        self.picture(textile)?;
        let slot = self.slots.get(textile)?.as_ref()?;
        Some(ShownMap {
            map: &slot.map,
            wanted: slot.key.wanted,
        })
    }

    /// The amplitude that a textile's map shows at a place along its warp and weft, mm; in µm.
    pub(crate) fn amplitude_um(&self, textile: usize, place_mm: [f64; 2]) -> Option<f64> {
        let slot = self.slots.get(textile)?.as_ref()?;
        let amplitudes_um = slot.map.amplitudes_um(place_mm);
        Some(amplitudes_um[slot.key.wanted.band.index()])
    }

    /// Maps computed so far: it stands still while nothing changes or nobody looks.
    pub(crate) fn n_computed(&self) -> u64 {
        self.n_computed
    }
}

impl fmt::Debug for Maps {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Maps")
            .field("n_slots", &self.slots.len())
            .field("n_computed", &self.n_computed)
            .finish_non_exhaustive()
    }
}

/// Makes a map; `None` when its picture has more pixels along a side than the graphics card takes.
fn made(index: usize, key: Key, most: usize) -> Option<Made> {
    let velocity = key.response.along(key.wanted.velocity);
    let map = key.response.map(velocity);
    let image = image_of(&map, &key.wanted);
    (image.width().max(image.height()) <= most).then_some(Made {
        index,
        key,
        map,
        image,
    })
}

/// One pixel a pair of points: columns along the warp, rows along the weft.
fn image_of(map: &VelocityMap, wanted: &Wanted) -> ColorImage {
    let [n_warp, n_weft] = map.n_points();
    let cells = (0..n_weft).flat_map(|j| (0..n_warp).map(move |i| [i, j]));
    let colour = |cell| -> Color32 {
        let amplitude_um = map.at_points_um(cell)[wanted.band.index()];
        wanted.colours.colour(wanted.scale.share(amplitude_um))
    };
    ColorImage::new([n_warp, n_weft], cells.map(colour).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::geometry::Point;
    use selvedge_render::RenderScene;
    use selvedge_render::array::{Accuracy, ArrayRenderer, Method};
    use selvedge_render::scene::{LoadedScene, Pose};

    fn wanted(velocity: Velocity, band: Band) -> Wanted {
        Wanted {
            velocity,
            band,
            scale: AmplitudeScale::default(),
            colours: ColourMap::Viridis,
        }
    }

    #[test]
    fn a_map_shows_what_the_reference_renders_and_is_made_once() {
        let ctx = egui::Context::default();
        let scene = RenderScene::of(&LoadedScene::shipped().unwrap());
        let inspector = ContactInspector::new(&scene);
        let exact = Accuracy::default();
        let mut reference = ArrayRenderer::prepare(&scene, Method::Reference, &exact).unwrap();
        let mut maps = Maps::default();
        let n_textiles = scene.textiles.len() as u64;
        for (n, velocity) in [(1, [90.0, 30.0]), (2, [-12.0, -40.0]), (3, [0.0, 250.0])] {
            let velocity = Velocity::new(velocity[0], velocity[1]);
            let wanted = wanted(velocity, Band::High);
            for _ in 0..3 {
                maps.catch_up(&ctx, &inspector, wanted, true);
            }
            assert_eq!(maps.n_computed(), n * n_textiles, "once a velocity");
            for (textile, placed) in scene.textiles.iter().enumerate() {
                assert!(maps.picture(textile).is_some(), "{textile}");
                for place in [[20.3, 30.9], [41.0, 22.6]] {
                    let at = placed.workspace_from_textile.point(place.into());
                    let offset = scene.displays[0].offsets[0];
                    let pose = Pose {
                        position: Point::new(at.x_mm - offset.x_mm, at.y_mm - offset.y_mm),
                        velocity,
                        ..Pose::default()
                    };
                    let expected = reference.tick(&[pose])[0].amplitude_um(0)[1];
                    let found = maps.amplitude_um(textile, place).unwrap();
                    assert!((found / expected - 1.0).abs() < 1e-9, "{found}, {expected}");
                }
            }
        }
    }

    #[test]
    fn a_thread_makes_the_map_and_the_last_one_stays_meanwhile() {
        let ctx = egui::Context::default();
        let mut scene = RenderScene::of(&LoadedScene::shipped().unwrap());
        let mut inspector = ContactInspector::new(&scene);
        let mut maps = Maps::default();
        let slow = wanted(Velocity::new(20.0, 0.0), Band::Low);
        maps.catch_up(&ctx, &inspector, slow, false);
        assert!(maps.picture(0).is_none(), "still to come");
        while maps.picture(0).is_none() {
            maps.catch_up(&ctx, &inspector, slow, false);
            std::thread::yield_now();
        }
        let before = maps.amplitude_um(0, [3.0, 3.0]).unwrap();
        let n_made = maps.n_computed();
        scene.textiles[0].scene_gain_db = f64::NEG_INFINITY;
        inspector.set_gains(&scene);
        maps.catch_up(&ctx, &inspector, slow, false);
        assert_eq!(maps.n_computed(), n_made + 1, "one textile has other gains");
        assert_eq!(maps.amplitude_um(0, [3.0, 3.0]), Some(before));
        while maps.picture(0).is_some() {
            maps.catch_up(&ctx, &inspector, slow, false);
            std::thread::yield_now();
        }
        assert_eq!(maps.amplitude_um(0, [3.0, 3.0]), Some(0.0), "silent now");
        maps.catch_up(
            &ctx,
            &ContactInspector::new(&RenderScene::default()),
            slow,
            false,
        );
        assert_eq!(maps.amplitude_um(1, [3.0, 3.0]), None, "no textile, no map");
        maps.clear();
    }
}
