//! The libraries as the window shows them: what each textile is called, and how it looks.
//!
//! Names come from manifests, which are small and read when a library is opened. Pictures are read
//! only of textiles that are in sight, on a thread of their own. Everywhere a textile is known by
//! the id by which the scene finds it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::{self, Color32, ColorImage, TextureHandle, Vec2, vec2};

use crate::bench::background::{Executor, Task, finished};
use crate::bench::library_shelf::{OWN, SHIPPED, Shelf, plain_id};
use crate::bench::settings::build_cache;
use crate::bench::view::{ClothPicture, LibraryEntry};
use crate::kit::tile::{TILED, tile};
use selvedge_foundation::numerics::to_single;
use selvedge_foundation::progress::Progress;
use selvedge_textile::{Appearance, Library, elsewhere};

/// Most pictures that are read in one go.
const AT_ONCE: usize = 8;

/// A picture as it was read, and how much cloth it shows, mm; `None` for a textile without one.
type Read = (String, Result<Option<(ColorImage, Vec2)>, String>);

/// A picture that is wanted: the textile's id in a library, and that by which the scene finds it.
struct Wanted {
    library: Arc<Library>,
    id: String,
    key: String,
}

/// The libraries in sight: the scene's, the user's own, and others as far as they were opened.
pub(crate) struct LibraryView {
    scene: Shelf,
    others: Vec<Shelf>,
    opening: Vec<Task<Shelf>>,
    /// Libraries that were asked for, whatever came of it.
    known: BTreeSet<PathBuf>,
    pictures: BTreeMap<String, (TextureHandle, ClothPicture)>,
    /// Textiles whose pictures were asked for, whatever came of it.
    asked: BTreeSet<String>,
    wanted: Vec<String>,
    coming: Option<Task<Vec<Read>>>,
}

impl LibraryView {
    /// The textiles of the scene's library, without pictures yet.
    pub(crate) fn new(library: Arc<Library>, items: Vec<LibraryEntry>) -> Self {
        Self {
            scene: Shelf::of_scene(library, items),
            others: Vec::new(),
            opening: Vec::new(),
            known: BTreeSet::new(),
            pictures: BTreeMap::new(),
            asked: BTreeSet::new(),
            wanted: Vec::new(),
            coming: None,
        }
    }

    /// Opens a library beside the scene's, once, unless it is the scene's.
    pub(crate) fn open(&mut self, title: &str, name: &Path, executor: &Executor) {
        let is_own = self.scene.library.root() == name
            || (self.scene.library.is_shipped() && name == Path::new(SHIPPED[0].1));
        if is_own || !self.known.insert(name.to_owned()) {
            return;
        }
        let (title, name) = (title.to_owned(), name.to_owned());
        let open = move |_: &mut Progress<'_>| Shelf::open((&title, &name), build_cache().as_ref());
        self.opening.push(executor.start("selvedge-library", open));
    }

    /// Forgets a library that was opened.
    pub(crate) fn close(&mut self, name: &Path) {
        self.known.remove(name);
        self.others.retain(|shelf| shelf.name() != Some(name));
    }

    /// Every library that is open, the user's own first.
    pub(crate) fn shelves(&self) -> impl Iterator<Item = &Shelf> {
        let (own, rest): (Vec<&Shelf>, Vec<&Shelf>) =
            self.others.iter().partition(|shelf| &*shelf.title == OWN);
        own.into_iter().chain([&self.scene]).chain(rest)
    }

    /// Whether libraries are being opened.
    pub(crate) fn is_opening(&self) -> bool {
        !self.opening.is_empty()
    }

    /// The library in which a scene finds a textile by this id, if it is open.
    pub(crate) fn shelf_of(&self, key: &str) -> &Shelf {
        let named = elsewhere(key).map(|(name, _)| name);
        let other = named.and_then(|name| self.others.iter().find(|one| one.name() == Some(name)));
        other.unwrap_or(&self.scene)
    }

    /// The textiles of a folder as they are now. Pictures of `changed` ones are read again.
    pub(crate) fn renew(&mut self, library: &Arc<Library>, changed: &[String]) {
        let root = library.root();
        let all = std::iter::once(&mut self.scene).chain(&mut self.others);
        for shelf in all.filter(|shelf| shelf.library.root() == root) {
            *shelf = shelf.renewed(Arc::clone(library));
        }
        for key in changed {
            self.pictures.remove(key);
            self.asked.remove(key);
        }
    }

    /// The textiles of the scene's library, in its order.
    pub(crate) fn items(&self) -> &[LibraryEntry] {
        &self.scene.items
    }

    /// The same, to keep while it is drawn.
    pub(crate) fn shared_items(&self) -> Arc<[LibraryEntry]> {
        Arc::clone(&self.scene.items)
    }

    /// The textiles of every library that is open.
    pub(crate) fn all_items(&self) -> impl Iterator<Item = &LibraryEntry> {
        self.shelves().flat_map(|shelf| shelf.items.iter())
    }

    /// The scene's library.
    pub(crate) fn library(&self) -> &Arc<Library> {
        &self.scene.library
    }

    /// The textile that the scene finds by this id.
    pub(crate) fn item(&self, id: &str) -> Option<&LibraryEntry> {
        let items = &self.shelf_of(id).items;
        items.iter().find(|item| item.id == id)
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

    /// Takes libraries and pictures that came and sends for pictures that are wanted; says what
    /// could not be read.
    pub(crate) fn work(&mut self, ctx: &egui::Context, executor: &Executor) -> Vec<String> {
        let mut flaws = self.take_shelves();
        flaws.extend(self.take(ctx));
        while self.coming.is_none() && !self.wanted.is_empty() {
            let n = self.wanted.len().min(AT_ONCE);
            let some: Vec<String> = self.wanted.drain(..n).collect();
            let some: Vec<Wanted> = some.into_iter().map(|key| self.wanted_of(key)).collect();
            let read = move |_: &mut Progress<'_>| Ok(read_all(some));
            self.coming = Some(executor.start("selvedge-pictures", read));
            flaws.extend(self.take(ctx));
        }
        flaws
    }

    /// A library that is not open is opened for a moment by the scene's.
    fn wanted_of(&self, key: String) -> Wanted {
        let shelf = self.shelf_of(&key);
        let id = match shelf.name() {
            Some(_) => plain_id(&key),
            None => &key,
        };
        Wanted {
            library: Arc::clone(&shelf.library),
            id: id.to_owned(),
            key,
        }
    }

    fn take_shelves(&mut self) -> Vec<String> {
        let mut flaws = Vec::new();
        for task in std::mem::take(&mut self.opening) {
            let mut task = Some(task);
            match finished(&mut task) {
                Some(Ok(shelf)) => self.others.push(shelf),
                Some(Err(line)) => flaws.push(line),
                None => {}
            }
            self.opening.extend(task);
        }
        // Threads end in any order.
        self.others.sort_by(|a, b| a.name().cmp(&b.name()));
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
        let mut flaws = Vec::new();
        for (id, picture) in read {
            match picture {
                Ok(Some((image, tile_mm))) => {
                    let handle = ctx.load_texture(format!("textile {id}"), image, TILED);
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
            .field("others", &self.others)
            .field("pictures", &self.pictures.len())
            .finish_non_exhaustive()
    }
}

impl LibraryEntry {
    /// Whether all words of a search are found in its name, its id or what it is, in any order and
    /// in letters of any size.
    pub(crate) fn matches(&self, sought: &str) -> bool {
        let structure = self.structure.unwrap_or_default();
        let texts = [
            self.name.as_str(),
            plain_id(&self.id),
            &self.kind,
            structure,
        ];
        let texts = texts.map(str::to_lowercase);
        let sought = sought.to_lowercase();
        let mut words = sought.split_whitespace();
        words.all(|word| texts.iter().any(|text| text.contains(word)))
    }
}

fn read_all(textiles: Vec<Wanted>) -> Vec<Read> {
    let read = |Wanted { library, id, key }: Wanted| {
        let picture = library.appearance(&id).map_err(|error| error.to_string());
        (key, picture.map(|found| found.map(|found| image(&found))))
    };
    textiles.into_iter().map(read).collect()
}

fn image(appearance: &Appearance) -> (ColorImage, Vec2) {
    let image = &appearance.image;
    let pixels = image
        .pixels
        .iter()
        .map(|&[r, g, b]| Color32::from_rgb(r, g, b))
        .collect();
    let [width, height] = [image.width, image.height].map(|n| n as f32);
    let px_per_mm = to_single(appearance.px_per_mm.max(1e-3));
    let tile_mm = vec2(width, height) / px_per_mm;
    let picture = ColorImage::new([image.width, image.height], pixels);
    (tile(&picture), tile_mm)
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
    use crate::bench::library_shelf::items_of;

    fn shipped() -> LibraryView {
        let library = Arc::new(Library::shipped().unwrap());
        let items = items_of(&library, None);
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
    fn a_library_beside_the_scenes_is_opened_once_and_its_textiles_say_where_they_live() {
        let mut view = shipped();
        for (title, name) in SHIPPED.into_iter().chain(SHIPPED) {
            view.open(title, Path::new(name), &Executor::InLine);
        }
        assert!(view.is_opening());
        assert_eq!(view.take_shelves(), Vec::<String>::new());
        let titles: Vec<&str> = view.shelves().map(|shelf| &*shelf.title).collect();
        assert_eq!(
            titles,
            ["Shipped 16", "Shipped 74"],
            "the scene’s is there already"
        );
        assert_eq!(view.all_items().count(), 16 + 74);
        let other = view.all_items().nth(16).unwrap().clone();
        assert!(other.id.starts_with("seventy-four:") && &*other.home == "Shipped 74");
        assert_eq!(view.item(&other.id), Some(&other));
        view.close(Path::new("seventy-four"));
        assert_eq!(view.all_items().count(), 16);
        view.open("Away", Path::new("/none/of/these"), &Executor::InLine);
        assert_eq!(view.take_shelves().len(), 1, "said once");
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
