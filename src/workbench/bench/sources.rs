//! What else can move the display, and who else hears of it: tablets that are read directly, and
//! other programs of this machine.
//!
//! Devices are listed and opened on threads of their own. The link to other programs lasts until
//! it is ended here; nothing of this is kept in files or undone.

use std::net::{Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};

use crate::bench::Bench;
use crate::bench::background::{Task, finished};
use crate::bench::view::Source;
use selvedge_engine::{
    Area, InputDevice, InputError, InputSource, PointerInput, ProgramCounts, ProgramLink,
    list_input_devices, open_input_device,
};
use selvedge_foundation::progress::Progress;

/// Where other programs find this one, if the port is free; otherwise any port is taken.
const PORT: u16 = 7240;

/// What can be done with sources.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum SourceCommand {
    /// Look anew which devices there are.
    List,
    /// Take positions from this device.
    Device(PathBuf),
    /// Let other programs join.
    Listen,
    /// Let no program join any more.
    EndListening,
    /// Take positions from the program that joined.
    Program,
    /// Where the surface of tablets of this name lies, `X,Y,WIDTH,HEIGHT` in mm of the workspace;
    /// `None`: where it usually does.
    Area(String, Option<String>),
}

/// Where the surface of the tablet that was chosen last lies.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SurfaceView {
    /// What the tablet calls itself.
    pub name: String,
    /// `[x, y, width, height]`, mm of the workspace.
    pub area_mm: [f64; 4],
    /// Whether the user said so.
    pub is_own: bool,
}

/// What is shown of the sources.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct SourcesView {
    /// Whether devices are being listed or opened now.
    pub(crate) is_busy: bool,
    /// Whether they have ever been listed.
    pub is_known: bool,
    /// Devices to choose from, and what they are.
    pub devices: Vec<(PathBuf, String)>,
    /// The surface of the one that was chosen last.
    pub surface: Option<SurfaceView>,
    /// Why some of them, or all, cannot be chosen.
    pub complaint: Option<String>,
    /// Where programs may join, and how it stands with them.
    pub programs: Option<(SocketAddr, ProgramCounts)>,
}

type Listed = Vec<Result<InputDevice, InputError>>;
type Opened = Box<dyn PointerInput>;

/// The sources that are known, and what is under way with them.
#[derive(Debug, Default)]
pub(crate) struct Sources {
    view: SourcesView,
    /// The devices as they were listed last.
    listed: Vec<InputDevice>,
    listing: Option<Task<Listed>>,
    opening: Option<Task<Opened>>,
    link: Option<ProgramLink>,
    /// What was chosen last.
    chosen: Option<(SourceCommand, String)>,
}

impl Sources {
    /// What is shown.
    pub(crate) fn view(&self) -> SourcesView {
        let link = self.link.as_ref();
        SourcesView {
            is_busy: self.listing.is_some() || self.opening.is_some(),
            programs: link.map(|link| (link.address(), link.counts())),
            ..self.view.clone()
        }
    }

    /// The device at this path, as it was listed last.
    fn listed(&self, path: &Path) -> Option<&InputDevice> {
        self.listed.iter().find(|device| device.path == path)
    }

    /// The device that was chosen last, if it was a device.
    fn chosen_device(&self) -> Option<&InputDevice> {
        match self.chosen()? {
            SourceCommand::Device(path) => self.listed(path),
            _ => None,
        }
    }

    /// What was chosen last, to be chosen again.
    pub(crate) fn chosen(&self) -> Option<&SourceCommand> {
        self.chosen.as_ref().map(|(chosen, _)| chosen)
    }

    /// What people call it.
    pub(crate) fn chosen_name(&self) -> Option<&str> {
        self.chosen.as_ref().map(|(_, name)| name.as_str())
    }

    fn take_listed(&mut self, listed: Result<Listed, String>) {
        self.view.is_known = true;
        let (found, mut complaint) = match listed {
            Ok(found) => (found, None),
            Err(line) => (Vec::new(), Some(line)),
        };
        self.listed.clear();
        for device in found {
            match device {
                Ok(device) => self.listed.push(device),
                Err(error) => complaint = complaint.or_else(|| Some(error.to_string())),
            }
        }
        let devices = self.listed.iter();
        self.view.devices = devices
            .map(|device| (device.path.clone(), described(device)))
            .collect();
        self.view.complaint = complaint;
    }
}

fn described(device: &InputDevice) -> String {
    match device.axes.map(|axis| axis.length_mm()) {
        [Some(width_mm), Some(height_mm)] => {
            format!("{}, {width_mm:.0} × {height_mm:.0} mm", device.name)
        }
        _ => device.name.clone(),
    }
}

impl Bench {
    /// Does what is wanted of sources.
    pub(crate) fn dispatch_source(&mut self, command: SourceCommand) {
        match command {
            SourceCommand::List => self.list_devices(),
            SourceCommand::Device(path) => self.open_device(&path),
            SourceCommand::Listen => self.listen(),
            SourceCommand::EndListening => self.end_listening(),
            SourceCommand::Program => self.follow_program(),
            SourceCommand::Area(name, area) => self.place_surface(&name, area.as_deref()),
        }
    }

    /// What is shown of the sources.
    pub(crate) fn sources_view(&self) -> SourcesView {
        let sources = &self.transient.sources;
        let surface = sources.chosen_device().map(|device| {
            let own = self.settings.preferences.tablet_areas.get(&device.name);
            let usual = || Area::usual(device.axes, self.document.scene().size_mm);
            SurfaceView {
                name: device.name.clone(),
                area_mm: own.copied().unwrap_or_else(usual).numbers(),
                is_own: own.is_some(),
            }
        });
        SourcesView {
            surface,
            ..sources.view()
        }
    }

    /// Keeps where the surface of tablets of this name lies; one that is read now is read so from
    /// now on.
    fn place_surface(&mut self, name: &str, area: Option<&str>) {
        let areas = &mut self.settings.preferences.tablet_areas;
        match area.map(str::parse).transpose() {
            Ok(Some(area)) => drop(areas.insert(name.to_owned(), area)),
            Ok(None) => drop(areas.remove(name)),
            Err(error) => return self.transient.notices.give(error.to_string()),
        }
        let device = self.transient.sources.chosen_device();
        let path = device.filter(|device| device.name == name);
        let path = path.map(|device| device.path.clone());
        let is_read = self.transient.live.play.source == Source::Device;
        if let Some(path) = path.filter(|_| is_read) {
            self.open_device(&path);
        }
    }

    fn list_devices(&mut self) {
        if self.transient.sources.listing.is_none() {
            let list = |_: &mut Progress<'_>| list_input_devices().map_err(|e| e.to_string());
            let task = self.executor.start("selvedge-inputs", list);
            self.transient.sources.listing = Some(task);
            self.poll_sources();
        }
    }

    fn open_device(&mut self, path: &Path) {
        let size_mm = self.document.scene().size_mm;
        let device = path.to_owned();
        let name = self.transient.sources.listed(path).map(|found| &found.name);
        let area = name.and_then(|name| self.settings.preferences.tablet_areas.get(name));
        let area = area.copied();
        let chosen = SourceCommand::Device(path.to_owned());
        self.transient.sources.chosen = Some((chosen, path.display().to_string()));
        let task = self.executor.start("selvedge-input", move |_| {
            open_input_device(&device, area, size_mm).map_err(|error| error.to_string())
        });
        self.transient.sources.opening = Some(task);
        self.poll_sources();
    }

    fn take_device(&mut self, opened: Result<Opened, String>) {
        match opened {
            Ok(input) => self.send(selvedge_engine::Command::SetSource(InputSource::Live(
                input,
            ))),
            Err(line) => self.transient.notices.give(line),
        }
    }

    fn listen(&mut self) {
        let at = |port| ProgramLink::listen(SocketAddr::from((Ipv4Addr::LOCALHOST, port)));
        match at(PORT).or_else(|_taken| at(0)) {
            Ok(link) => {
                let display = self.inspection.scene.displays.first();
                let n_contactors = display.map_or(0, |display| display.offsets.len());
                let tap = link.tap(n_contactors).map(Box::new);
                self.transient.sources.link = Some(link);
                self.send(selvedge_engine::Command::SetTap(tap));
            }
            Err(error) => self.transient.notices.give(error.to_string()),
        }
    }

    fn end_listening(&mut self) {
        self.send(selvedge_engine::Command::SetTap(None));
        self.transient.sources.link = None;
    }

    fn follow_program(&mut self) {
        let Some(link) = &self.transient.sources.link else {
            let words = "No program can join yet: let other programs join first";
            return self.transient.notices.give(words);
        };
        let source = link.source();
        let name = "the program that joined".to_owned();
        self.transient.sources.chosen = Some((SourceCommand::Program, name));
        self.send(selvedge_engine::Command::SetSource(source));
    }

    /// Takes what was listed and opened. To be called every frame.
    pub(crate) fn poll_sources(&mut self) {
        let sources = &mut self.transient.sources;
        if let Some(listed) = finished(&mut sources.listing) {
            sources.take_listed(listed);
        }
        if let Some(opened) = finished(&mut sources.opening) {
            self.take_device(opened);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::{BufRead as _, BufReader, Write as _};
    use std::net::TcpStream;
    use std::time::{Duration, Instant};

    use super::*;
    use crate::bench::Drive;
    use selvedge_engine::AxisRange;

    #[test]
    fn a_program_that_joins_moves_the_display_and_hears_what_is_felt() {
        let ctx = eframe::egui::Context::default();
        let mut bench = Bench::new(&ctx, None, Drive::Stepped).unwrap();
        bench.dispatch(SourceCommand::Listen.into());
        bench.dispatch(SourceCommand::Program.into());
        let (address, _) = bench.transient.sources.view().programs.unwrap();
        let mut program = TcpStream::connect(address).unwrap();
        program
            .set_read_timeout(Some(Duration::from_secs(20)))
            .unwrap();
        let mut lines = BufReader::new(program.try_clone().unwrap()).lines();
        let header = lines.next().unwrap().unwrap();
        assert!(
            header.starts_with("tick,t_s,x_mm,y_mm,angle_deg,a40_um_0"),
            "{header}"
        );
        program.write_all(b"61.5,70.25\n").unwrap();
        let deadline = Instant::now() + Duration::from_secs(20);
        loop {
            bench.engine.advance_ticks(1).unwrap();
            let line = lines.next().unwrap().unwrap();
            if line.contains(",61.5,70.25,0,") {
                break;
            }
            assert!(Instant::now() < deadline, "{line}");
        }
        bench.take_news(&ctx);
        assert_eq!(bench.transient.live.play.source, Source::Lines);
        let counts = bench.transient.sources.view().programs.unwrap().1;
        assert!(counts.has_writer && counts.connected == 1, "{counts:?}");
        bench.dispatch(SourceCommand::EndListening.into());
        assert!(bench.transient.sources.view().programs.is_none());
        while let Some(Ok(_)) = lines.next() {
            // What was on its way; then the connection ends.
        }
    }

    fn tablet() -> InputDevice {
        let axis = |mm: i32| AxisRange {
            min: 0,
            max: 100 * mm,
            per_mm: 100,
        };
        InputDevice {
            path: "/nowhere/event7".into(),
            name: "Pen tablet".to_owned(),
            axes: [axis(216), axis(135)],
            contact: "touch",
        }
    }

    #[test]
    fn the_area_of_a_tablet_is_kept_by_its_name_and_nonsense_is_refused_in_a_line() {
        let ctx = eframe::egui::Context::default();
        let mut bench = Bench::new(&ctx, None, Drive::Stepped).unwrap();
        bench.transient.sources.take_listed(Ok(vec![Ok(tablet())]));
        assert_eq!(bench.sources_view().surface, None, "none was chosen");
        bench.dispatch(SourceCommand::Device("/nowhere/event7".into()).into());
        let usual = bench.sources_view().surface.unwrap();
        assert_eq!((usual.area_mm[2], usual.is_own), (216.0, false));
        let area = |text: &str| {
            let text = Some(text.to_owned());
            SourceCommand::Area("Pen tablet".to_owned(), text).into()
        };
        bench.dispatch(area("10,20,100,62.5"));
        let own = bench.sources_view().surface.unwrap();
        assert_eq!((own.area_mm, own.is_own), ([10.0, 20.0, 100.0, 62.5], true));
        for wrong in ["10,20,0,62.5", "10,20,-4,62.5", "10,20,wide,62.5"] {
            bench.dispatch(area(wrong));
            let shown = bench.transient.notices.shown();
            let last = &shown.last().unwrap().text;
            assert!(
                last.contains(wrong) && last.contains("is no area"),
                "{last}"
            );
            assert_eq!(bench.sources_view().surface.as_ref(), Some(&own));
        }
        bench.dispatch(SourceCommand::Area("Pen tablet".to_owned(), None).into());
        assert_eq!(bench.sources_view().surface, Some(usual));
        assert!(bench.settings.preferences.tablet_areas.is_empty());
    }

    #[test]
    fn a_device_that_is_not_there_is_a_notice() {
        let ctx = eframe::egui::Context::default();
        let mut bench = Bench::new(&ctx, None, Drive::Stepped).unwrap();
        bench.dispatch(SourceCommand::Device("/nowhere/event1".into()).into());
        let shown = bench.transient.notices.shown();
        assert!(
            shown[0].text.starts_with("/nowhere/event1"),
            "{}",
            shown[0].text
        );
        bench.dispatch(SourceCommand::List.into());
        assert!(bench.transient.sources.view().is_known);
    }
}
