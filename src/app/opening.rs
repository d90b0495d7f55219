//! Opening a scene: everything that takes longer than a frame, done on a named thread.
//!
//! What comes back is complete (textiles, tables, pictures) or one line that says what is wrong;
//! until then, and after a failure, the last scene stays.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::thread;

use eframe::egui::{self, Color32, ColorImage, Vec2, vec2};

use super::error::AppError;
use crate::engine::PreparedScene;
use crate::render::array::{Accuracy, Method};
use crate::scene::LoadedScene;
use crate::textile::Textile;

/// A scene that is ready to be shown and felt.
#[derive(Debug)]
pub(crate) struct Opened {
    /// Where it came from.
    pub(crate) path: Option<PathBuf>,
    /// The scene with its textiles.
    pub(crate) loaded: LoadedScene,
    /// The same, ready for the engine.
    pub(crate) prepared: PreparedScene,
    /// How its textiles look, by id, and how much cloth one picture shows, mm.
    pub(crate) pictures: BTreeMap<String, (Arc<ColorImage>, Vec2)>,
    /// Pictures that could not be read, one line each: the scene is felt all the same.
    pub(crate) flaws: Vec<String>,
}

/// A scene on its way.
#[derive(Debug)]
pub(crate) struct Opening {
    /// Where it comes from.
    pub(crate) path: PathBuf,
    result: Receiver<Result<Box<Opened>, AppError>>,
}

impl Opening {
    /// Begins to open the scene at `path`; `ctx` is woken when that is done.
    pub(crate) fn start(path: PathBuf, ctx: &egui::Context) -> std::io::Result<Self> {
        let (sender, result) = sync_channel(1);
        let (from, ctx) = (path.clone(), ctx.clone());
        thread::Builder::new()
            .name("selvedge-open".to_owned())
            .spawn(move || {
                // Nobody waits any more when another scene was asked for meanwhile.
                drop(sender.send(open(Some(&from)).map(Box::new)));
                ctx.request_repaint();
            })?;
        Ok(Self { path, result })
    }

    /// The outcome, once it is there.
    pub(crate) fn poll(&self) -> Option<Result<Box<Opened>, AppError>> {
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => {
                let what = format!("{}: opening it broke off", self.path.display());
                let mend = "please report the scene".to_owned();
                Some(Err(crate::scene::SceneError::Value { what, mend }.into()))
            }
        }
    }
}

/// Opens a scene on this thread; without a path the one that the program ships.
pub(crate) fn open(path: Option<&Path>) -> Result<Opened, AppError> {
    let loaded = match path {
        Some(path) => LoadedScene::read(path)?,
        None => LoadedScene::shipped()?,
    };
    let prepared = PreparedScene::prepare(&loaded, Method::Auto, &Accuracy::default())?;
    let mut pictures = BTreeMap::new();
    let mut flaws = Vec::new();
    for textile in loaded.textiles() {
        if pictures.contains_key(textile.id()) {
            continue;
        }
        match picture(textile) {
            Ok(Some(picture)) => drop(pictures.insert(textile.id().to_owned(), picture)),
            Ok(None) => {}
            Err(error) => flaws.push(error.to_string()),
        }
    }
    flaws.dedup();
    Ok(Opened {
        path: path.map(Path::to_owned),
        loaded,
        prepared,
        pictures,
        flaws,
    })
}

fn picture(textile: &Textile) -> Result<Option<(Arc<ColorImage>, Vec2)>, AppError> {
    let Some(appearance) = textile.appearance()? else {
        return Ok(None);
    };
    let image = &appearance.image;
    let pixels = image
        .pixels
        .iter()
        .map(|&[r, g, b]| Color32::from_rgb(r, g, b))
        .collect();
    let [width, height] = [image.width, image.height].map(|n| n as f32);
    #[expect(clippy::cast_possible_truncation, reason = "a scale, for the screen")]
    let px_per_mm = appearance.px_per_mm.max(1e-3) as f32;
    let tile_mm = vec2(width, height) / px_per_mm;
    Ok(Some((
        Arc::new(ColorImage::new([image.width, image.height], pixels)),
        tile_mm,
    )))
}
