//! A file of recipes: a library whose textiles are built when they are asked for.
//!
//! Every `[[textile]]` is a manifest without a `[source]` of files: any model. `like = "ID"` begins
//! with the keys of a textile further up and changes what is stated; `sides = ["face", "back"]`
//! makes two surfaces of one textile, the second with `-back` after its id.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::cache::BuildCache;
use super::index::Index;
use crate::build::{BuiltFile, build};
use crate::error::TextileError;
use crate::manifest::Manifest;
use crate::recipe::Side;
use crate::shipped;
use selvedge_foundation::files::{
    FileError, Keys, keys_from_str, keys_to_string, lay_over, line_of_key, read_text, sha256_hex,
    take_text,
};

/// What the library of all textiles is called where a folder or a file is.
pub(crate) const SEVENTY_FOUR: &str = "seventy-four";
/// The same of the materials of Wall & Harwin (1999).
pub(crate) const WALL_HARWIN: &str = "wall-harwin";
/// What stands after the id of a textile's other side.
const BACK: &str = "-back";

/// What the bytes of a built textile follow from besides its recipe: this program. Raise it when a
/// model changes what it makes; most changes show in the shipped library's own hash as well.
const MODEL: &str = "selvedge models 2";

/// Says which models build: other models, other text.
fn version() -> String {
    let program = env!("CARGO_PKG_VERSION");
    let shipped = sha256_hex([shipped::INDEX.as_bytes()]);
    format!("{MODEL}\n{program}\n{shipped}\n")
}

/// The recipes of a file, in its order.
#[derive(Debug)]
pub(crate) struct Recipes {
    path: PathBuf,
    surfaces: Vec<Recipe>,
    index: Option<Index>,
    cache: Option<BuildCache>,
}

/// One surface.
#[derive(Debug)]
struct Recipe {
    id: String,
    manifest: Manifest,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(rename = "textile", default)]
    textiles: Vec<Keys>,
}

impl Recipes {
    /// The recipes of a library that is part of the program, by its name.
    pub(crate) fn of_the_program(
        name: &Path,
        cache: Option<BuildCache>,
    ) -> Result<Self, TextileError> {
        if name == Path::new(WALL_HARWIN) {
            return Self::parse(shipped::WALL_HARWIN, name, cache);
        }
        let mut recipes = Self::parse(shipped::RECIPES, Path::new(SEVENTY_FOUR), cache)?;
        let path = index_path(Path::new("seventy-four.toml"));
        recipes.index = Some(Index::from_toml(shipped::RECIPES_INDEX, &path)?);
        Ok(recipes)
    }

    /// The recipes of a file, with the index `NAME.library.toml` beside it if that is there and
    /// lists the same textiles.
    pub(crate) fn read(path: &Path, cache: Option<BuildCache>) -> Result<Self, TextileError> {
        let mut recipes = Self::parse(&read_text(path)?, path, cache)?;
        let beside = index_path(path);
        if beside.is_file() {
            let index = Index::from_toml(&read_text(&beside)?, &beside)?;
            let listed = index.textiles.iter().map(|entry| &entry.id);
            if listed.eq(recipes.surfaces.iter().map(|recipe| &recipe.id)) {
                recipes.index = Some(index);
            }
        }
        Ok(recipes)
    }

    fn parse(text: &str, path: &Path, cache: Option<BuildCache>) -> Result<Self, TextileError> {
        let file: File = keys_from_str(text, path)?;
        let mut cloths: Vec<(String, Keys)> = Vec::with_capacity(file.textiles.len());
        let mut surfaces: Vec<Recipe> = Vec::new();
        for (nth, keys) in file.textiles.into_iter().enumerate() {
            let wrong = |key: &str, what: String, mend: &str| {
                FileError::content(path, line_of_key(text, "textile", nth, key), what, mend)
            };
            let (id, sides, keys) = cloth(keys, &cloths, &wrong)?;
            for side in sides {
                let recipe = Recipe::of(&id, side, &keys, path)
                    .map_err(|error| within(&id, error, &wrong))?;
                if surfaces.iter().any(|known| known.id == recipe.id) {
                    let what = format!("textile \"{}\" twice", recipe.id);
                    return Err(wrong("id", what, "give it another id").into());
                }
                surfaces.push(recipe);
            }
            cloths.push((id, keys));
        }
        Ok(Self {
            path: path.to_owned(),
            surfaces,
            index: None,
            cache,
        })
    }

    /// The file, or the name of the library.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// The ids, in order.
    pub(crate) fn ids(&self) -> Vec<String> {
        self.surfaces
            .iter()
            .map(|recipe| recipe.id.clone())
            .collect()
    }

    /// Levels that were measured before.
    pub(crate) fn index(&self) -> Option<&Index> {
        self.index.as_ref()
    }

    /// The manifest of a textile before it is built; `None` if there is none of that id.
    pub(crate) fn manifest(&self, id: &str) -> Option<&Manifest> {
        let recipe = self.surfaces.iter().find(|recipe| recipe.id == id)?;
        Some(&recipe.manifest)
    }

    /// The files of a textile: from the cache, or built now and kept there.
    pub(crate) fn built(&self, id: &str) -> Result<Vec<BuiltFile>, TextileError> {
        let path = self.path.join(id);
        let Some(manifest) = self.manifest(id) else {
            return Err(TextileError::unknown(id, &self.path, &self.ids()));
        };
        let Some(cache) = &self.cache else {
            return build(manifest, &path);
        };
        let recipe = manifest.to_toml(&path)?;
        let key = sha256_hex([version().as_bytes(), recipe.as_bytes()]);
        if let Some(files) = cache.get(&key) {
            return Ok(files);
        }
        let files = build(manifest, &path)?;
        cache.put(&key, &files);
        Ok(files)
    }
}

impl Recipe {
    fn of(id: &str, side: Side, keys: &Keys, path: &Path) -> Result<Self, TextileError> {
        let text = keys_to_string(keys, path)?;
        let mut manifest = Manifest::from_toml(&text, path)?;
        let mut id = id.to_owned();
        if side == Side::Back {
            id.push_str(BACK);
            manifest.name.push_str(", back");
        }
        // A model without sides is the face of itself.
        let is_made = side == Side::Face && manifest.source.is_recipe();
        if !manifest.source.keys_mut().set_side(side) && !is_made {
            return Err(manifest.source.no_recipe(path));
        }
        Ok(Self { id, manifest })
    }
}

/// A textile's id, sides and all its keys, with those of the textile that it is like.
fn cloth(
    mut keys: Keys,
    known: &[(String, Keys)],
    wrong: &impl Fn(&str, String, &str) -> FileError,
) -> Result<(String, Vec<Side>, Keys), FileError> {
    #[derive(Deserialize, Serialize)]
    struct Sides {
        sides: Vec<Side>,
    }

    let id = take_text(&mut keys, "id").filter(|id| is_name(id));
    let Some(id) = id else {
        let mend = "give it an id of letters, digits and hyphens, in quotes";
        return Err(wrong("id", "a textile without an id".to_owned(), mend));
    };
    let sides = match keys.remove("sides") {
        None => vec![Side::Face],
        Some(sides) => {
            let text = format!("sides = {sides}");
            match keys_from_str::<Sides>(&text, Path::new("sides")) {
                Ok(Sides { sides }) if !sides.is_empty() => sides,
                _ => {
                    let mend = "give sides = [\"face\"], [\"back\"] or [\"face\", \"back\"]";
                    return Err(wrong("sides", format!("sides is {sides}"), mend));
                }
            }
        }
    };
    if !keys.contains_key("like") {
        return Ok((id, sides, keys));
    }
    let like = take_text(&mut keys, "like").unwrap_or_default();
    let Some((_, model)) = known.iter().find(|(known, _)| *known == like) else {
        let what = format!("textile \"{id}\" is like \"{like}\", which is not above it");
        return Err(wrong("like", what, "name a textile further up"));
    };
    let mut all = model.clone();
    lay_over(&mut all, keys);
    Ok((id, sides, all))
}

/// Whether an id can be the name of a folder everywhere.
fn is_name(id: &str) -> bool {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    !id.is_empty() && id.chars().all(is_plain)
}

/// What is wrong with a manifest, said of the place in the recipe file.
fn within(
    id: &str,
    error: TextileError,
    wrong: &impl Fn(&str, String, &str) -> FileError,
) -> TextileError {
    match error {
        TextileError::File(FileError::Content { what, mend, .. }) => {
            wrong("id", format!("textile \"{id}\": {what}"), &mend).into()
        }
        TextileError::NoRecipe { kind, .. } => {
            let what = format!("textile \"{id}\": a source of kind \"{kind}\" makes no such side");
            let mend = "give a model; of these kind = \"weave\" and \"knit\" have a back";
            wrong("id", what, mend).into()
        }
        other => other,
    }
}

/// Where the levels of a file of recipes are kept: `NAME.library.toml` beside it.
fn index_path(recipes: &Path) -> PathBuf {
    recipes.with_extension("library.toml")
}

/// Whether a library of this name is part of the program.
pub fn is_of_the_program(name: &Path) -> bool {
    [SEVENTY_FOUR, WALL_HARWIN].map(Path::new).contains(&name)
}
