//! Maps of textiles: what each would give all over at one velocity, as pictures for the workspace.
//!
//! A map repeats with the points of its profiles, so its picture holds one pixel a pair of points
//! and is tiled over the cloth. It is made on a thread of its own, and anew only when something
//! that it shows has changed; until it is done the last one stays, unless the textile is another.

use std::sync::Arc;

use eframe::egui::{
    self, Color32, ColorImage, ImageData, TextureFilter, TextureHandle, TextureOptions,
    TextureWrapMode,
};

use crate::bench::background::Executor;
use crate::bench::latest::{Computed, Latest};
use crate::kit::amplitude::AmplitudeScale;
use crate::kit::theme::colour_map::ColourMap;
use selvedge_foundation::geometry::Velocity;
use selvedge_foundation::progress::{Cancelled, Progress};
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
    latest: Latest<Vec<Key>, Computation>,
    /// Maps and their pictures on the graphics card.
    slots: Vec<Option<(Arc<Made>, TextureHandle)>>,
    /// Maps computed before all were forgotten.
    n_before: u64,
}

/// What one map shows.
#[derive(Debug, Clone)]
struct Key {
    response: TextileResponse,
    wanted: Wanted,
    /// The longest side of a picture that the graphics card takes.
    max_px: usize,
}

/// A map as it is shown.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ShownMap<'a> {
    /// The amplitudes.
    pub map: &'a VelocityMap,
    /// What they are of, and how they are coloured.
    pub wanted: Wanted,
}

/// A map that was made.
struct Made {
    key: Key,
    map: VelocityMap,
    image: Arc<ColorImage>,
}

/// The maps of all textiles; none of one whose map is too large.
#[derive(Default)]
struct Computation {
    maps: Vec<Option<Arc<Made>>>,
    /// Maps computed so far.
    n_computed: u64,
}

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        self.wanted == other.wanted && self.response.is_same(&other.response)
    }
}

impl Computed<Vec<Key>> for Computation {
    const THREAD: &str = "selvedge-maps";

    fn compute(
        keys: &Vec<Key>,
        prior: Option<(&Vec<Key>, &Self)>,
        _: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let (known, before) = prior.map_or((&[][..], &[][..]), |(keys, of)| (keys, &of.maps));
        let mut n_computed = prior.map_or(0, |(_, before)| before.n_computed);
        let mut map = |(index, key): (usize, &Key)| {
            if let Some(map) = before.get(index)
                && known.get(index) == Some(key)
            {
                return map.clone();
            }
            n_computed += 1;
            Made::of(key).map(Arc::new)
        };
        let maps = keys.iter().enumerate().map(&mut map).collect();
        Ok(Self { maps, n_computed })
    }

    fn broken(_: &Vec<Key>, _: &str) -> Self {
        Self::default()
    }

    fn serves(_: &Vec<Key>, _: &Vec<Key>) -> bool {
        true
    }
}

impl Maps {
    /// Lets every textile's map follow what is wanted.
    pub(crate) fn follow(
        &mut self,
        ctx: &egui::Context,
        executor: &Executor,
        (inspector, wanted): (&ContactInspector, Wanted),
    ) {
        let max_px = ctx.input(|input| input.max_texture_side);
        let responses = (0..).map_while(|textile| inspector.response(textile));
        let key = |response| Key {
            response,
            wanted,
            max_px,
        };
        let keys: Vec<Key> = responses.map(key).collect();
        self.latest.poll();
        self.latest.follow(ctx, executor, &keys);
        self.slots.resize_with(keys.len(), || None);
        let maps = self.latest.value().map_or(&[][..], |value| &value.maps);
        for (index, (slot, key)) in self.slots.iter_mut().zip(&keys).enumerate() {
            let map = maps.get(index).and_then(Option::as_ref);
            let is_of_it = |map: &&Arc<Made>| map.key.response.is_same_cloth(&key.response);
            let Some(map) = map.filter(is_of_it) else {
                *slot = None;
                continue;
            };
            if let Some((shown, texture)) = slot {
                if !Arc::ptr_eq(shown, map) {
                    texture.set(ImageData::Color(Arc::clone(&map.image)), OPTIONS);
                    *shown = Arc::clone(map);
                }
            } else {
                let name = format!("map {index}");
                let image = ImageData::Color(Arc::clone(&map.image));
                let texture = ctx.load_texture(name, image, OPTIONS);
                *slot = Some((Arc::clone(map), texture));
            }
        }
    }

    /// Forgets all maps, and what is on its way.
    pub(crate) fn clear(&mut self) {
        *self = Self {
            n_before: self.n_computed(),
            ..Self::default()
        };
    }

    /// The picture of a textile's map and the points along warp and weft that it holds; `None`
    /// while there is none, and for a textile that is not felt at all.
    pub(crate) fn picture(&self, textile: usize) -> Option<(egui::TextureId, [usize; 2])> {
        let (shown, texture) = self.slots.get(textile)?.as_ref()?;
        let factor = shown.key.response.factors()[shown.key.wanted.band.index()];
        (factor > 0.0).then(|| (texture.id(), shown.map.n_points()))
    }

    /// The map of a textile; `None` while there is none, and for a textile that is not felt at all.
    pub(crate) fn shown(&self, textile: usize) -> Option<ShownMap<'_>> {
        self.picture(textile)?;
        let (shown, _) = self.slots.get(textile)?.as_ref()?;
        Some(ShownMap {
            map: &shown.map,
            wanted: shown.key.wanted,
        })
    }

    /// The amplitude that a textile's map shows at a place along its warp and weft, mm; in µm.
    pub(crate) fn amplitude_um(&self, textile: usize, place_mm: [f64; 2]) -> Option<f64> {
        let (shown, _) = self.slots.get(textile)?.as_ref()?;
        let amplitudes_um = shown.map.amplitudes_um(place_mm);
        Some(amplitudes_um[shown.key.wanted.band.index()])
    }

    /// Maps computed so far: it stands still while nothing changes or nobody looks.
    pub(crate) fn n_computed(&self) -> u64 {
        let value = self.latest.value();
        self.n_before + value.map_or(0, |value| value.n_computed)
    }
}

impl Made {
    /// Makes a map; `None` when its picture has more pixels along a side than the graphics card
    /// takes.
    fn of(key: &Key) -> Option<Self> {
        let velocity = key.response.along(key.wanted.velocity);
        let map = key.response.map(velocity);
        let image = Arc::new(image_of(&map, &key.wanted));
        let key = key.clone();
        (image.width().max(image.height()) <= key.max_px).then_some(Self { key, map, image })
    }
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
                maps.follow(&ctx, &Executor::InLine, (&inspector, wanted));
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
        let threads = Executor::Threads(ctx.clone());
        let mut scene = RenderScene::of(&LoadedScene::shipped().unwrap());
        let mut inspector = ContactInspector::new(&scene);
        let mut maps = Maps::default();
        let slow = wanted(Velocity::new(20.0, 0.0), Band::Low);
        maps.follow(&ctx, &threads, (&inspector, slow));
        assert!(maps.picture(0).is_none(), "still to come");
        while maps.picture(0).is_none() {
            maps.follow(&ctx, &threads, (&inspector, slow));
            std::thread::yield_now();
        }
        let before = maps.amplitude_um(0, [3.0, 3.0]).unwrap();
        let n_made = maps.n_computed();
        scene.textiles[0].scene_gain_db = f64::NEG_INFINITY;
        inspector.set_gains(&scene);
        maps.follow(&ctx, &threads, (&inspector, slow));
        assert_eq!(maps.amplitude_um(0, [3.0, 3.0]), Some(before));
        while maps.picture(0).is_some() {
            maps.follow(&ctx, &threads, (&inspector, slow));
            std::thread::yield_now();
        }
        assert_eq!(maps.amplitude_um(0, [3.0, 3.0]), Some(0.0), "silent now");
        assert_eq!(maps.n_computed(), n_made + 1, "one textile has other gains");
        let none = ContactInspector::new(&RenderScene::default());
        maps.follow(&ctx, &threads, (&none, slow));
        assert_eq!(maps.amplitude_um(1, [3.0, 3.0]), None, "no textile, no map");
        maps.clear();
    }
}
