//! Files that a window has opened before anything is exported.

use super::*;
use crate::bench::background::Executor;
use crate::tools::import::Import;
use crate::tools::import::tests::export;
use crate::tools::picture::Picture;

impl Headless {
    /// Reads strokes of the tester.
    pub(crate) fn import(&mut self) {
        let folder = ScratchFolder::made("strokes");
        let path = folder.write("twill.txt", export());
        self.dispatch(FileCommand::Use(Purpose::ImportFiles, path));
        let import: &mut Import = self.workbench.tools.get_mut().unwrap();
        import.follow(&self.ctx, &Executor::InLine);
    }

    /// Predicts the friction of a cloth of one colour.
    #[cfg(feature = "friction")]
    pub(crate) fn ask_friction(&mut self) {
        let plain = selvedge_foundation::numerics::Grid::filled(600, 120, 0.5);
        self.dispatch(crate::bench::command::friction::PictureAtHand {
            name: "plain.png".to_owned(),
            brightness: std::sync::Arc::new(plain),
            px_per_mm: 10.0,
        });
    }

    /// Lets a cloth hang for a while.
    pub(crate) fn hang_cloth(&mut self) {
        self.dispatch(ShowCommand::Reveal(Pane::Drape));
        self.pass(12);
        self.dispatch(ShowCommand::Reveal(Pane::Workspace));
    }

    /// Works out a picture of a cloth.
    pub(crate) fn open_picture(&mut self) {
        let folder = ScratchFolder::made("picture");
        let path = folder.join("weave.png");
        let grey = |i: u32| {
            let (x, y) = (f64::from(i % 160), f64::from(i / 160));
            let shares = [0.45 * x, 0.35 * y, 0.45 * x + 0.35 * y].map(f64::sin);
            0.5 + 0.15 * shares.iter().sum::<f64>()
        };
        let picture = files::GrayImage::of_shares([160, 120], (0..160 * 120).map(grey));
        fs::write(&path, picture.to_png(&path).unwrap()).unwrap();
        self.dispatch(FileCommand::Use(Purpose::OpenPicture(Pane::Picture), path));
        let picture: &mut Picture = self.workbench.tools.get_mut().unwrap();
        picture.follow(&self.ctx, &Executor::InLine);
    }
}
