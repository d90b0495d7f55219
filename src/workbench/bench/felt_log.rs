//! The log of links to devices, and what it says of what is felt: the scene as its file would be,
//! and the recording that is replayed.

use std::sync::Arc;

use selvedge_device::SessionLog;
use selvedge_foundation::files::sha256_hex;
use selvedge_render::scene::ExplorationPath;

use crate::bench::background::finished;
use crate::bench::settings::session_log;
use crate::bench::{Bench, LOG_BOUND};

impl Bench {
    /// Lets every link to a device be logged in the user's own folder.
    pub(crate) fn log_links(&mut self) {
        let Some(path) = session_log() else { return };
        // The program's own folder is made; what is wrong with it is said below.
        drop(path.parent().map(std::fs::create_dir_all));
        match SessionLog::append(&path, Some(LOG_BOUND)) {
            Ok(log) => self.engine.log_links_to(log),
            Err(error) => self.notices.give(error.to_string()),
        }
    }

    /// Tells the log which scene is felt, whenever it is another. To be called every frame.
    pub(crate) fn log_what_is_felt(&mut self) {
        if let Some(Ok(hash)) = finished(&mut self.device.felt_log.hashing) {
            self.engine.say_what("path_sha256", hash);
        }
        let scene = self.document.scene();
        if self.device.felt_log.scene.as_ref() == Some(scene) {
            return;
        }
        // A scene that cannot be written cannot be felt either.
        if let Ok(text) = scene.to_toml() {
            let hash = sha256_hex([text.as_bytes()]);
            self.device.felt_log.scene = Some(scene.clone());
            self.engine.say_what("scene_sha256", hash);
        }
    }

    /// Tells the log which path is replayed: the hash of the file that it would be exported to.
    pub(crate) fn log_path(&mut self, path: &Arc<ExplorationPath>) {
        let path = Arc::clone(path);
        let task = self.executor.start("selvedge-hash", move |_| {
            let text = path.to_csv().map_err(|error| error.to_string())?;
            Ok(sha256_hex([text.as_bytes()]))
        });
        self.device.felt_log.hashing = Some(task);
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::bench::command::device::DeviceCommand;
    use crate::bench::command::{Edit, PlayCommand};
    use crate::shell::headless::Headless;
    use selvedge_scratch::ScratchFolder;

    /// What the log says by this name, in order.
    fn said(log: &str, name: &str) -> Vec<String> {
        let begins = format!("{name}=");
        let hash = |line: &str| {
            let (_, hash) = line.split_once(&begins)?;
            Some(hash.trim_end_matches('"').to_owned())
        };
        log.lines().filter_map(hash).collect()
    }

    #[test]
    fn the_log_says_which_scene_and_which_path_were_felt() {
        let root = ScratchFolder::made("felt");
        let file = root.join("bridge.csv");
        let mut window = Headless::shipped();
        let log = SessionLog::append(&file, None).unwrap();
        window.workbench.bench.engine.log_links_to(log);
        window.dispatch(DeviceCommand::ConnectEmulator);
        window.pass(2);
        let hash = |window: &Headless| {
            let text = window.workbench.bench.document.scene().to_toml().unwrap();
            sha256_hex([text.as_bytes()])
        };
        let mut expected = vec![hash(&window)];
        window.dispatch(Edit::MasterGain(-6.0));
        window.pass(2);
        expected.push(hash(&window));
        window.dispatch(PlayCommand::ToggleRecording);
        window.pass_ticks(20);
        window.dispatch(PlayCommand::ToggleRecording);
        window.pass(4);
        window.workbench.bench.replay();
        window.pass(2);
        let at_hand = window.workbench.bench.exploration.at_hand.clone().unwrap();
        let path = at_hand.path().to_csv().unwrap();
        drop(window);
        let text = fs::read_to_string(&file).unwrap();
        assert_eq!(said(&text, "scene_sha256"), expected, "{text}");
        let paths = said(&text, "path_sha256");
        assert_eq!(paths.last(), Some(&sha256_hex([path.as_bytes()])), "{text}");
    }
}
