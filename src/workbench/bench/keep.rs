//! New textiles from the window: kept in a library, and felt if that is wanted.
//!
//! A scene with a folder of textiles of its own keeps them there, any other in the user's own
//! library. Where a textile with the same name or id is there already, somebody decides.

use std::sync::Arc;

use crate::bench::background::Task;
use crate::bench::library_shelf::plain_id;
use crate::bench::pane::Pane;
use crate::bench::view::LibraryEntry;
use selvedge_textile::{BuiltFile, Textile};

/// What the button “Keep…” says of itself, wherever it stands.
pub(crate) const KEEP_TIP: &str =
    "Feel it beside textiles of the library, then keep it in your own library, or in the scene’s";

/// A textile that was made in the window and lies in no folder yet.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NewTextile {
    /// The id that it is wished to have.
    pub id: String,
    /// Its name.
    pub name: String,
    /// Its files, the manifest among them.
    pub files: Vec<BuiltFile>,
}

/// New textiles of one act.
pub(crate) type NewTextiles = Arc<Vec<NewTextile>>;

/// What is done with new textiles.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Keep {
    /// They.
    pub(crate) textiles: NewTextiles,
    /// Whether the first is laid into the scene.
    pub(crate) is_felt: bool,
    /// What is done where a textile with the same name or id is there; `None` asks.
    pub(crate) when_taken: Option<WhenTaken>,
}

/// New textiles that are listened to.
#[derive(Debug)]
pub(crate) struct Listening {
    /// They.
    pub(crate) textiles: NewTextiles,
    /// The pane that they come from, and that comes back afterwards.
    pub(super) from: Pane,
    /// The first of them and its mean amplitudes as those of the library's index are, µm; `None`
    /// until it is read.
    pub(crate) new: Option<(Arc<Textile>, [f64; 2])>,
    /// The textiles of the library that it is compared with.
    pub(crate) references: [Option<String>; 2],
    /// What is felt: the new one (0), or a reference (1, 2).
    pub(crate) felt: usize,
    pub(super) reading: Option<Task<Arc<Textile>>>,
}

impl Listening {
    /// The new textile, once it is there, while it is what is felt.
    pub(super) fn felt_new(&self) -> Option<&Arc<Textile>> {
        let (new, _) = self.new.as_ref()?;
        (self.felt == 0).then_some(new)
    }

    /// The id of what is felt, once it is there.
    pub(super) fn id(&self) -> Option<&str> {
        match self.felt.checked_sub(1) {
            None => self.felt_new().map(|new| new.id()),
            Some(nth) => self.references.get(nth)?.as_deref(),
        }
    }
}

/// What is done with a new textile whose name or id is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum WhenTaken {
    /// It takes the place of the one that is there, which stays as a version.
    Replace,
    /// Both stay; the new one gets a number.
    KeepBoth,
}

/// New textiles that wait for an answer.
#[derive(Debug, Clone)]
pub(crate) struct Taken {
    /// What was wanted.
    pub(crate) keep: Keep,
    /// Name and id of those that are there, in the order of the new ones.
    pub(crate) there: Vec<[String; 2]>,
    /// The library, as people call it.
    pub(crate) home: Arc<str>,
}

/// Where a new textile goes: the id that it gets or is wished to have, its name, and whether it
/// takes the place of the one with that id.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Place {
    pub(crate) id: String,
    pub(crate) name: String,
    pub(crate) replaces: bool,
}

impl Keep {
    /// Of textiles that are to be felt, or not.
    pub(crate) fn of(textiles: NewTextiles, is_felt: bool) -> Self {
        Self {
            textiles,
            is_felt,
            when_taken: None,
        }
    }

    /// Name and id of the textiles of a library in whose way the new ones are.
    pub(crate) fn taken(&self, items: &[LibraryEntry]) -> Vec<[String; 2]> {
        let there = |new: &NewTextile| alike(new, items);
        let all = self.textiles.iter().filter_map(there);
        all.map(|item| [item.name.clone(), plain_id(&item.id).to_owned()])
            .collect()
    }

    /// Where each goes among the textiles of a library.
    pub(crate) fn places(&self, items: &[LibraryEntry]) -> Vec<Place> {
        let place = |new: &NewTextile| match (alike(new, items), self.when_taken) {
            (Some(item), Some(WhenTaken::Replace)) => Place {
                id: plain_id(&item.id).to_owned(),
                name: new.name.clone(),
                replaces: true,
            },
            _ => Place {
                id: new.id.clone(),
                name: free_name(&new.name, items),
                replaces: false,
            },
        };
        self.textiles.iter().map(place).collect()
    }
}

/// The textile of a library that has the id or the name of a new one.
fn alike<'a>(new: &NewTextile, items: &'a [LibraryEntry]) -> Option<&'a LibraryEntry> {
    let has_id = |item: &&LibraryEntry| plain_id(&item.id) == new.id;
    let has_name = |item: &&LibraryEntry| item.name == new.name;
    (items.iter().find(has_id)).or_else(|| items.iter().find(has_name))
}

/// The name, or the first of `NAME 2`, `NAME 3`, … that no textile of the library has.
pub(crate) fn free_name(name: &str, items: &[LibraryEntry]) -> String {
    let is_free = |name: &String| items.iter().all(|item| item.name != *name);
    let with_number = |n: usize| format!("{name} {n}");
    let mut names = std::iter::once(name.to_owned()).chain((2..=items.len() + 2).map(with_number));
    names.find(is_free).unwrap_or_else(|| name.to_owned())
}
