//! A new textile in a library: in the folder that the library is, or in a folder that begins as a
//! copy of it.
//!
//! Nothing that is there is changed: a textile whose id is taken is kept under the next free one,
//! and the library's reference level stays, so that nobody's gain moves.

use std::path::Path;

use super::Library;
use super::build::{files_of, hash_of, means_um};
use super::id::id_of;
use super::index::{INDEX, Index, IndexEntry};
use super::parallel::for_each;
use crate::build::{BuiltFile, write};
use crate::error::TextileError;
use crate::manifest::MANIFEST;
use selvedge_foundation::files::write_atomic;
use selvedge_foundation::progress::Progress;

/// Textiles that may share a name but for a number.
const MAX_ALIKE: u32 = 9999;

impl Library {
    /// Keeps textiles, each a wished id and its files, in the folder `to`.
    ///
    /// The folder is the library's own, or one that then has copies of all textiles of the library
    /// that it lacked. Returns the library of that folder and the ids that the textiles got. The
    /// work is shared among `n_threads`, which changes no byte.
    ///
    /// # Errors
    /// Files that are no textile, before anything is written; a folder that cannot be written;
    /// cancelling, which leaves copies behind and no new textile.
    pub fn add(
        &self,
        textiles: &[(String, Vec<BuiltFile>)],
        to: &Path,
        n_threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<(Self, Vec<String>), TextileError> {
        let mut entries = Vec::with_capacity(textiles.len());
        for (wished, files) in textiles {
            entries.push(entry_of(wished, files)?);
        }
        self.copy_to(to, n_threads, progress)?;
        let there = if to.is_dir() {
            Some(Self::open(to)?)
        } else {
            None
        };
        let mut index = there.as_ref().and_then(|there| there.index().cloned());
        index = index.or_else(|| self.index().cloned());
        for ((_, files), entry) in textiles.iter().zip(&mut entries) {
            entry.id = free_id(&entry.id, to, index.as_ref())?;
            write(files, &to.join(&entry.id))?;
            if let Some(index) = &mut index {
                index.textiles.push(entry.clone());
            }
        }
        if let Some(mut index) = index {
            let ids: Vec<String> = index
                .textiles
                .iter()
                .map(|entry| entry.id.clone())
                .collect();
            index.content_hash = hash_of(&Self::of_folder(to, &ids))?;
            let path = to.join(INDEX);
            write_atomic(&path, index.to_toml(&path)?.as_bytes())?;
        }
        let ids = entries.into_iter().map(|entry| entry.id).collect();
        Ok((Self::open(to)?, ids))
    }

    /// Copies every textile into a folder that it is not in yet.
    fn copy_to(
        &self,
        to: &Path,
        n_threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<(), TextileError> {
        let missing = |id: &&String| !to.join(id.as_str()).join(MANIFEST).is_file();
        let ids: Vec<String> = self.ids().iter().filter(missing).cloned().collect();
        for_each(&ids, n_threads, progress, |id| {
            Ok(write(&files_of(self, id)?, &to.join(id))?)
        })?;
        Ok(())
    }
}

/// The place in a library of files that are one of its textiles.
fn entry_of(wished: &str, files: &[BuiltFile]) -> Result<IndexEntry, TextileError> {
    let id = id_of(wished);
    if id.is_empty() {
        let words = format!("\"{wished}\" makes no id; give a name with letters a to z or digits");
        return Err(TextileError::Model(words));
    }
    let textile = Library::of_files(&id, files.to_vec()).load(&id)?;
    let [a40_um, a320_um] = means_um(textile.surface());
    Ok(IndexEntry {
        id,
        a40_um,
        a320_um,
    })
}

/// The id itself or the first of `ID-2`, `ID-3`, … that is not taken.
fn free_id(id: &str, folder: &Path, index: Option<&Index>) -> Result<String, TextileError> {
    let is_free = |id: &String| {
        !folder.join(id).exists() && index.is_none_or(|index| index.entry(id).is_none())
    };
    let with_number = |n: u32| format!("{id}-{n}");
    std::iter::once(id.to_owned())
        .chain((2..=MAX_ALIKE).map(with_number))
        .find(is_free)
        .ok_or_else(|| {
            let words = format!("there are {MAX_ALIKE} textiles called {id}; give another name");
            TextileError::Model(words)
        })
}
