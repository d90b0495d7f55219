//! Keeping textiles that the window has made.

use crate::app::keep::Keep;
use crate::app::window::Workbench;
use crate::textile;

impl Workbench {
    /// Writes a new textile into the scene's library, where that is a folder.
    pub(super) fn keep_textile(&mut self, keep: &Keep) {
        let (Keep::Save(made) | Keep::Feel(made)) = keep;
        let document = &self.document;
        let scene = document.path().map(std::path::PathBuf::as_path);
        let folder = scene.and_then(|path| document.scene().library_folder(path));
        let Some(folder) = folder.filter(|folder| folder.is_dir()) else {
            let words = format!(
                "{} was not kept: save the scene with a library folder of its own first",
                made.name
            );
            return self.transient.notices.give(words);
        };
        if let Err(error) = textile::write(&made.files, &folder.join(&made.id)) {
            self.transient.notices.give(error.to_string());
        }
    }
}
