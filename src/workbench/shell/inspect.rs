//! What a test or another program may want to know of a workbench, and do with it.

use std::path::PathBuf;

use crate::bench::command::device::DeviceCommand;
use crate::bench::command::{FileCommand, Purpose};
use crate::bench::pane::Pane;
use crate::bench::view::{BridgePhase, Source};
use crate::shell::window::Workbench;
use crate::tools::accuracy::Accuracy;
use crate::tools::collection::Collection;
use crate::tools::compare::Compare;
use crate::tools::import::Import;
use crate::tools::lab::Lab;
use crate::tools::picture::Picture;
use crate::tools::response::Response;
use crate::tools::spectra::contact::ContactSpectrum;
use crate::tools::spectra::drive::DriveSpectrum;
use crate::tools::workspace::Workspace;
use selvedge_render::LevelDifference;
use selvedge_render::scene::Scene;
use selvedge_textile::tactile::Tuning;

impl Workbench {
    /// Peak amplitudes [A40, A320] of every contactor after gains, before output limits, µm.
    pub fn amplitudes_um(&self) -> Vec<[f64; 2]> {
        self.bench
            .live
            .dots
            .iter()
            .map(|dot| dot.amplitude_um)
            .collect()
    }

    /// Gains and compression in force.
    pub fn tuning(&self) -> Tuning {
        self.bench.document.tuning()
    }

    /// The scene as it is edited.
    pub fn scene(&self) -> &Scene {
        self.bench.document.scene()
    }

    /// The display's turn on top of the scene's, degrees counter-clockwise.
    pub fn turn_deg(&self) -> f64 {
        self.bench.live.turn_deg
    }

    /// Whether the exploration is being recorded.
    pub fn is_recording(&self) -> bool {
        self.bench.live.play.is_recording
    }

    /// Ticks of the recording that can be replayed; `None` without one.
    pub fn n_recorded_ticks(&self) -> Option<u64> {
        self.bench
            .exploration
            .at_hand
            .as_ref()
            .map(|take| take.path().n_ticks())
    }

    /// The tick of the recording that is replayed; `None` while something else moves the display.
    pub fn replayed_tick(&self) -> Option<u64> {
        let play = self.bench.live.play;
        (play.source == Source::Recording).then_some(play.tick)
    }

    /// How often each pane was drawn, by its title.
    pub fn panes_drawn(&self) -> Vec<(&'static str, u64)> {
        let drawn = Pane::ALL.into_iter().zip(self.shell.n_drawn);
        drawn
            .map(|(pane, n_drawn)| (pane.title(), n_drawn))
            .collect()
    }

    /// Columns computed for the contact spectrum and for the drive spectrum.
    pub fn columns_computed(&self) -> [u64; 2] {
        let contact = self.tools.get::<ContactSpectrum>();
        let drive = self.tools.get::<DriveSpectrum>();
        [
            contact.map_or(0, ContactSpectrum::n_columns_computed),
            drive.map_or(0, DriveSpectrum::n_columns_computed),
        ]
    }

    /// Comparisons that were begun.
    pub fn n_comparisons(&self) -> u64 {
        self.tools.get::<Compare>().map_or(0, Compare::n_begun)
    }

    /// The differences that were found last.
    pub fn comparison(&self) -> Option<&LevelDifference> {
        self.tools.get::<Compare>()?.found()
    }

    /// Ticks that were checked against `reference` since the statistics began, and ticks left out.
    pub fn ticks_checked(&self) -> [u64; 2] {
        let accuracy = self.tools.get::<Accuracy>();
        let tally = accuracy.map(|accuracy| accuracy.tally).unwrap_or_default();
        [tally.sampled, tally.busy + tally.changed]
    }

    /// The name of the rendering method that runs.
    pub fn rendered_by(&self) -> &'static str {
        self.bench.live.status.method
    }

    /// The level error that rendering may make, dB.
    pub fn error_budget_db(&self) -> f64 {
        self.bench.settings.preferences.rendering.budget_db
    }

    /// Methods that were measured on this scene.
    pub fn n_methods_measured(&self) -> usize {
        let accuracy = self.tools.get::<Accuracy>();
        let measured = accuracy.and_then(|accuracy| accuracy.measured.as_ref());
        measured.map_or(0, |measured| measured.rows.len())
    }

    /// The textile and the contactor that the pointer rests on, in whichever view.
    pub fn hovered(&self) -> [Option<usize>; 2] {
        let hovered = self.bench.selection.hovered;
        [hovered.cloth, hovered.contactor]
    }

    /// The textile and the contactor that are chosen in all views.
    pub fn chosen(&self) -> [Option<usize>; 2] {
        [self.bench.selection.cloth, self.bench.selection.contactor]
    }

    /// Maps over the cloth and curves over direction and speed computed so far.
    pub fn responses_computed(&self) -> [u64; 2] {
        let curves = self.tools.get::<Response>();
        let n_curves = curves.map_or(0, |response| response.curves.n_computed());
        let workspace = self.tools.get::<Workspace>();
        let n_maps = workspace.map_or(0, |workspace| workspace.maps.n_computed());
        [n_maps, n_curves]
    }

    /// Previews of recipes that were begun in the textile lab.
    pub fn previews_computed(&self) -> u64 {
        self.tools
            .get::<Lab>()
            .map_or(0, |lab| lab.previews.n_begun())
    }

    /// The textiles of the library that are selected, by their ids in order.
    pub fn selected_textiles(&self) -> Vec<String> {
        self.bench.library.selection.0.iter().cloned().collect()
    }

    /// Textiles of the library measured so far, at whichever speed.
    pub fn n_textiles_measured(&self) -> u64 {
        let collection = self.tools.get::<Collection>();
        collection.map_or(0, |collection| collection.measurements.n_measured)
    }

    /// The scene's name.
    pub fn scene_name(&self) -> &str {
        &self.bench.document.scene().name
    }

    /// Steps that undo can take back now.
    pub fn n_undo_steps(&self) -> usize {
        self.steps().n_done
    }

    /// Whether the scene differs from its file.
    pub fn is_edited(&self) -> bool {
        self.bench.document.is_edited()
    }

    /// Whether high voltage is on, or about to be.
    pub fn is_armed(&self) -> bool {
        self.bench.live.is_armed()
    }

    /// Whether the device is ready to be armed.
    pub fn is_ready(&self) -> bool {
        let bridge = self.bench.live.bridge.as_ref();
        bridge.is_some_and(|bridge| bridge.phase == BridgePhase::Ready)
    }

    /// Whether a device would play silence: everything is off, or a replay or stroke is held.
    pub fn is_silent(&self) -> bool {
        self.bench.live.is_silent
    }

    /// Whether everything was switched off and nothing was armed since.
    pub fn is_stopped(&self) -> bool {
        self.bench.live.is_stopped
    }

    /// Readings of measurements that were begun.
    pub fn n_measurements_read(&self) -> u64 {
        self.tools.get::<Import>().map_or(0, Import::n_read)
    }

    /// The figures of what is imported, one line each: SMD of every stroke, or of every place.
    pub fn imported_figures(&self) -> Vec<String> {
        let found = self.tools.get::<Import>().and_then(Import::found);
        found.map_or_else(Vec::new, |found| found.figures())
    }

    /// Takes a file of measurements, as when it is dropped or chosen.
    pub fn import_file(&mut self, path: PathBuf) {
        self.dispatch(FileCommand::Use(Purpose::ImportFiles, path).into());
    }

    /// Runs of the stages from a picture to a textile that were begun.
    pub fn n_pictures_worked_out(&self) -> u64 {
        self.tools.get::<Picture>().map_or(0, Picture::n_begun)
    }

    /// The lattice vectors found on the picture, px: x right, y down.
    pub fn picture_lattice(&self) -> Option<[[f64; 2]; 2]> {
        let found = self.tools.get::<Picture>()?.found()?;
        let cloth = found.cloth.as_ref()?;
        let lattice = cloth.found.as_ref().ok()?.lattice;
        Some([lattice.p1_px, lattice.p2_px])
    }

    /// Takes a picture of a cloth, as when it is dropped or chosen.
    pub fn open_picture(&mut self, path: PathBuf) {
        self.dispatch(FileCommand::Use(Purpose::OpenPicture(Pane::Picture), path).into());
    }

    /// Takes a further picture of the cloth, turned.
    pub fn add_turned_picture(&mut self, path: PathBuf) {
        self.dispatch(FileCommand::Use(Purpose::AddTurned, path).into());
    }

    /// Ticks that never were because the engine came too late.
    pub fn n_ticks_missed(&self) -> u64 {
        self.bench.live.status.missed
    }

    /// The sentences that are shown.
    pub fn notices(&self) -> Vec<String> {
        self.bench
            .notices
            .shown()
            .iter()
            .map(|notice| notice.text.clone())
            .collect()
    }

    /// Connects to the emulator in this process, as the window does when it starts.
    pub fn connect_emulator(&mut self) {
        self.dispatch(DeviceCommand::ConnectEmulator.into());
    }

    /// Opens a path file: it moves the display, and waits at its first tick.
    pub fn open_recording(&mut self, path: PathBuf) {
        self.bench.open_recording(path);
    }

    /// Opens the scene at this path, as the field does that asks for one.
    pub fn open_scene(&mut self, path: PathBuf) {
        self.dispatch(FileCommand::Use(Purpose::OpenScene, path).into());
    }
}
