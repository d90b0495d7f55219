//! The library as the window shows it: what each textile is called, and how it looks.
//!
//! Names come from manifests, which are small and read when a scene is opened. Pictures are read
//! only of textiles that are in sight, on a thread of their own.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use eframe::egui::{
    self, Color32, ColorImage, TextureFilter, TextureHandle, TextureOptions, Vec2, vec2,
};

use crate::bench::background::{Executor, Task, finished};
use crate::bench::view::{ClothPicture, LibraryEntry};
use selvedge_foundation::progress::Progress;
use selvedge_textile::{Appearance, Library, kind_of, measured_figures};

/// Most pictures that are read in one go.
const AT_ONCE: usize = 8;

/// A picture as it was read, and how much cloth it shows, mm; `None` for a textile without one.
type Read = (String, Result<Option<(ColorImage, Vec2)>, String>);

/// A library in sight.
pub(crate) struct LibraryView {
    library: Arc<Library>,
    items: Arc<[LibraryEntry]>,
    pictures: BTreeMap<String, (TextureHandle, ClothPicture)>,
    /// Textiles whose pictures were asked for, whatever came of it.
    asked: BTreeSet<String>,
    wanted: Vec<String>,
    coming: Option<Task<Vec<Read>>>,
}

impl LibraryView {
    /// The textiles of a library, without pictures yet.
    pub(crate) fn new(library: Arc<Library>, items: Vec<LibraryEntry>) -> Self {
        Self {
            library,
            items: items.into(),
            pictures: BTreeMap::new(),
            asked: BTreeSet::new(),
            wanted: Vec::new(),
            coming: None,
        }
    }

    /// The same with the textiles of another library, which has all that this one had: pictures
    /// stay.
    pub(crate) fn with_library(self, library: Arc<Library>, items: Vec<LibraryEntry>) -> Self {
        Self {
            library,
            items: items.into(),
            ..self
        }
    }

    /// The textiles, in the library's order.
    pub(crate) fn items(&self) -> &[LibraryEntry] {
        &self.items
    }

    /// The same, to keep while it is drawn.
    pub(crate) fn shared_items(&self) -> Arc<[LibraryEntry]> {
        Arc::clone(&self.items)
    }

    /// The library that they stand in.
    pub(crate) fn library(&self) -> &Arc<Library> {
        &self.library
    }

    /// The textile with this id.
    pub(crate) fn item(&self, id: &str) -> Option<&LibraryEntry> {
        self.items.iter().find(|item| item.id == id)
    }

    /// How a textile looks, once its picture is there.
    pub(crate) fn picture(&self, id: &str) -> Option<ClothPicture> {
        self.pictures.get(id).map(|(_, picture)| *picture)
    }

    /// Says that a textile is in sight.
    pub(crate) fn want(&mut self, id: &str) {
        if !self.asked.contains(id) && self.asked.insert(id.to_owned()) {
            self.wanted.push(id.to_owned());
        }
    }

    /// Takes pictures that came and sends for those that are wanted; says what could not be read.
    pub(crate) fn work(&mut self, ctx: &egui::Context, executor: &Executor) -> Vec<String> {
        let mut flaws = self.take(ctx);
        while self.coming.is_none() && !self.wanted.is_empty() {
            let n = self.wanted.len().min(AT_ONCE);
            let some = self.wanted.drain(..n).collect();
            let library = Arc::clone(&self.library);
            let read = move |_: &mut Progress<'_>| Ok(read_all(&library, some));
            self.coming = Some(executor.start("selvedge-pictures", read));
            flaws.extend(self.take(ctx));
        }
        flaws
    }

    fn take(&mut self, ctx: &egui::Context) -> Vec<String> {
        match finished(&mut self.coming) {
            Some(Ok(read)) => self.hang(ctx, read),
            Some(Err(line)) => vec![line],
            None => Vec::new(),
        }
    }

    fn hang(&mut self, ctx: &egui::Context, read: Vec<Read>) -> Vec<String> {
        let options = TextureOptions {
            mipmap_mode: Some(TextureFilter::Linear),
            ..TextureOptions::LINEAR_REPEAT
        };
        let mut flaws = Vec::new();
        for (id, picture) in read {
            match picture {
                Ok(Some((image, tile_mm))) => {
                    let handle = ctx.load_texture(format!("textile {id}"), image, options);
                    let texture = handle.id();
                    let picture = ClothPicture { texture, tile_mm };
                    self.pictures.insert(id, (handle, picture));
                }
                Ok(None) => {}
                Err(flaw) => flaws.push(flaw),
            }
        }
        flaws
    }
}

impl std::fmt::Debug for LibraryView {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("LibraryView")
            .field("items", &self.items.len())
            .field("pictures", &self.pictures.len())
            .finish_non_exhaustive()
    }
}

impl LibraryEntry {
    /// Whether all words of a search are found in its name, its id or what it is, in any order and
    /// in letters of any size.
    pub(crate) fn matches(&self, sought: &str) -> bool {
        let structure = self.structure.unwrap_or_default();
        let texts = [&self.name, &self.id, &self.kind, structure].map(str::to_lowercase);
        let sought = sought.to_lowercase();
        let mut words = sought.split_whitespace();
        words.all(|word| texts.iter().any(|text| text.contains(word)))
    }
}

/// What the manifests of a library say; one that cannot be read is listed with the reason.
pub(crate) fn items_of(library: &Library) -> Vec<LibraryEntry> {
    let item = |id: &String| {
        let entry = library.index().and_then(|index| index.entry(id));
        let (level_db, mean_um) = entry.map_or((None, [0.0; 2]), |entry| {
            (entry.level_db(), [entry.a40_um, entry.a320_um])
        });
        match library.manifest(id) {
            Ok(manifest) => LibraryEntry {
                id: id.clone(),
                kind: kind(manifest.construction.word(), &manifest.fibre),
                construction: manifest.construction.word(),
                structure: kind_of(&manifest),
                measured: measured_figures(&manifest.measured),
                name: manifest.name,
                gain_db: manifest.gain_db,
                level_db,
                mean_um,
                flaw: None,
            },
            Err(error) => LibraryEntry {
                id: id.clone(),
                name: id.clone(),
                kind: String::new(),
                construction: "",
                structure: None,
                measured: Vec::new(),
                gain_db: 0.0,
                level_db,
                mean_um,
                flaw: Some(error.to_string()),
            },
        }
    };
    library.ids().iter().map(item).collect()
}

fn kind(construction: &str, fibre: &str) -> String {
    [construction, fibre]
        .into_iter()
        .filter(|word| !word.is_empty() && *word != "other")
        .collect::<Vec<_>>()
        .join(" · ")
}

fn read_all(library: &Library, ids: Vec<String>) -> Vec<Read> {
    let read = |id: String| {
        let picture = library.appearance(&id).map_err(|error| error.to_string());
        (id, picture.map(|found| found.map(|found| image(&found))))
    };
    ids.into_iter().map(read).collect()
}

fn image(appearance: &Appearance) -> (ColorImage, Vec2) {
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
    (
        ColorImage::new([image.width, image.height], pixels),
        tile_mm,
    )
}

/// A textile of the library that is carried by the pointer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct LibraryItem {
    /// Its place in the library.
    pub id: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shipped() -> LibraryView {
        let library = Arc::new(Library::shipped().unwrap());
        let items = items_of(&library);
        LibraryView::new(library, items)
    }

    #[test]
    fn every_shipped_textile_is_in_the_view() {
        let library_view = shipped();
        assert_eq!(library_view.items().len(), 16);
        for item in library_view.items() {
            assert_eq!(item.flaw, None, "{}", item.id);
            assert!(item.level_db.is_some() && !item.kind.is_empty(), "{item:?}");
        }
        assert!(
            library_view.item("felt-hat").is_none(),
            "there is none of that id"
        );
    }

    #[test]
    fn a_search_finds_words_in_any_order_in_name_kind_or_id() {
        let library_view = shipped();
        let silk = library_view.item("silk-crepe").unwrap();
        for sought in ["", " Silk ", "woven crêpe", "chine wov", "silk-cr", "plain"] {
            assert!(silk.matches(sought), "{sought}");
        }
        assert!(!silk.matches("silk knitted"));
    }

    #[test]
    fn only_wanted_pictures_are_read_and_each_once() {
        let ctx = egui::Context::default();
        let mut library_view = shipped();
        let id = library_view.items()[3].id.clone();
        assert_eq!(
            library_view.work(&ctx, &Executor::InLine),
            Vec::<String>::new()
        );
        assert!(library_view.pictures.is_empty(), "nobody asked");
        library_view.want(&id);
        library_view.want(&id);
        library_view.want("no-such-textile");
        assert_eq!(library_view.wanted.len(), 2);
        let flaws = library_view.work(&ctx, &Executor::InLine);
        assert_eq!(flaws.len(), 1, "{flaws:?}");
        assert!(library_view.picture(&id).is_some() && library_view.pictures.len() == 1);
        library_view.want("no-such-textile");
        assert!(
            library_view.wanted.is_empty(),
            "what failed is not tried at every frame"
        );
    }
}
