//! Choosing what moves the display, and who else hears of it.

use std::net::{Ipv4Addr, SocketAddr};
use std::path::Path;

use crate::bench::Bench;
use crate::bench::background::finished;
use crate::bench::sources::{Opened, SourceCommand, SourcesView, SurfaceView};
use crate::bench::view::Source;
use selvedge_engine::{Area, InputDevice, InputSource, ProgramLink};
use selvedge_foundation::progress::Progress;

/// Where other programs find this one, if the port is free; otherwise any port is taken.
const PORT: u16 = 7240;

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
        let sources = &self.exploration.sources;
        let surface = sources.chosen_device().map(|device| {
            let own = self
                .settings
                .preferences
                .hand
                .tablet_areas
                .get(&device.name);
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
        let areas = &mut self.settings.preferences.hand.tablet_areas;
        match area.map(str::parse).transpose() {
            Ok(Some(area)) => drop(areas.insert(name.to_owned(), area)),
            Ok(None) => drop(areas.remove(name)),
            Err(error) => return self.notices.give(error.to_string()),
        }
        let device = self.exploration.sources.chosen_device();
        let path = device.filter(|device| device.name == name);
        let path = path.map(|device| device.path.clone());
        let is_read = self.live.play.source == Source::Device;
        if let Some(path) = path.filter(|_| is_read) {
            self.open_device(&path);
        }
    }

    fn list_devices(&mut self) {
        if self.exploration.sources.listing.is_none() {
            let list = |_: &mut Progress<'_>| InputDevice::list().map_err(|e| e.to_string());
            let task = self.executor.start("selvedge-inputs", list);
            self.exploration.sources.listing = Some(task);
            self.poll_sources();
        }
    }

    fn open_device(&mut self, path: &Path) {
        let size_mm = self.document.scene().size_mm;
        let device = path.to_owned();
        let name = self
            .exploration
            .sources
            .listed(path)
            .map(|found| &found.name);
        let area = name.and_then(|name| self.settings.preferences.hand.tablet_areas.get(name));
        let area = area.copied();
        let chosen = SourceCommand::Device(path.to_owned());
        self.exploration.sources.chosen = Some((chosen, path.display().to_string()));
        let task = self.executor.start("selvedge-input", move |_| {
            InputDevice::open(&device, area, size_mm).map_err(|error| error.to_string())
        });
        self.exploration.sources.opening = Some(task);
        self.poll_sources();
    }

    fn take_device(&mut self, opened: Result<Opened, String>) {
        match opened {
            Ok(input) => self.send(selvedge_engine::Command::SetSource(InputSource::Live(
                input,
            ))),
            Err(line) => self.notices.give(line),
        }
    }

    fn listen(&mut self) {
        let at = |port| ProgramLink::listen(SocketAddr::from((Ipv4Addr::LOCALHOST, port)));
        match at(PORT).or_else(|_taken| at(0)) {
            Ok(link) => {
                let display = self.inspection.scene.displays.first();
                let n_contactors = display.map_or(0, |display| display.offsets.len());
                let tap = link.tap(n_contactors).map(Box::new);
                self.exploration.sources.link = Some(link);
                self.send(selvedge_engine::Command::SetTap(tap));
            }
            Err(error) => self.notices.give(error.to_string()),
        }
    }

    fn end_listening(&mut self) {
        self.send(selvedge_engine::Command::SetTap(None));
        self.exploration.sources.link = None;
    }

    fn follow_program(&mut self) {
        let Some(link) = &self.exploration.sources.link else {
            let words = "No program can join yet: let other programs join first";
            return self.notices.give(words);
        };
        let source = link.source();
        let name = "the program that joined".to_owned();
        self.exploration.sources.chosen = Some((SourceCommand::Program, name));
        self.send(selvedge_engine::Command::SetSource(source));
    }

    /// Takes what was listed and opened. To be called every frame.
    pub(crate) fn poll_sources(&mut self) {
        let sources = &mut self.exploration.sources;
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
    use crate::shell::window::Workbench;
    use selvedge_engine::{AxisRange, InputDevice};

    #[test]
    fn a_program_that_joins_moves_the_display_and_hears_what_is_felt() {
        let ctx = eframe::egui::Context::default();
        let mut window = Workbench::new(&ctx, None, Drive::Stepped).unwrap();
        window.dispatch(SourceCommand::Listen.into());
        window.dispatch(SourceCommand::Program.into());
        let (address, _) = window.bench.exploration.sources.view().programs.unwrap();
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
            window.bench.engine.advance_ticks(1).unwrap();
            let line = lines.next().unwrap().unwrap();
            if line.contains(",61.5,70.25,0,") {
                break;
            }
            assert!(Instant::now() < deadline, "{line}");
        }
        window.bench.take_news(&ctx);
        assert_eq!(window.bench.live.play.source, Source::Lines);
        let counts = window.bench.exploration.sources.view().programs.unwrap().1;
        assert!(counts.has_writer && counts.connected == 1, "{counts:?}");
        window.dispatch(SourceCommand::EndListening.into());
        assert!(window.bench.exploration.sources.view().programs.is_none());
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
        let mut window = Workbench::new(&ctx, None, Drive::Stepped).unwrap();
        window
            .bench
            .exploration
            .sources
            .take_listed(Ok(vec![Ok(tablet())]));
        assert_eq!(window.bench.sources_view().surface, None, "none was chosen");
        window.dispatch(SourceCommand::Device("/nowhere/event7".into()).into());
        let usual = window.bench.sources_view().surface.unwrap();
        assert_eq!((usual.area_mm[2], usual.is_own), (216.0, false));
        let area = |text: &str| {
            let text = Some(text.to_owned());
            SourceCommand::Area("Pen tablet".to_owned(), text).into()
        };
        window.dispatch(area("10,20,100,62.5"));
        let own = window.bench.sources_view().surface.unwrap();
        assert_eq!((own.area_mm, own.is_own), ([10.0, 20.0, 100.0, 62.5], true));
        for wrong in ["10,20,0,62.5", "10,20,-4,62.5", "10,20,wide,62.5"] {
            window.dispatch(area(wrong));
            let shown = window.bench.notices.shown();
            let last = &shown.last().unwrap().text;
            assert!(
                last.contains(wrong) && last.contains("is no area"),
                "{last}"
            );
            assert_eq!(window.bench.sources_view().surface.as_ref(), Some(&own));
        }
        window.dispatch(SourceCommand::Area("Pen tablet".to_owned(), None).into());
        assert_eq!(window.bench.sources_view().surface, Some(usual));
        assert!(
            window
                .bench
                .settings
                .preferences
                .hand
                .tablet_areas
                .is_empty()
        );
    }

    #[test]
    fn a_device_that_is_not_there_is_a_notice() {
        let ctx = eframe::egui::Context::default();
        let mut window = Workbench::new(&ctx, None, Drive::Stepped).unwrap();
        window.dispatch(SourceCommand::Device("/nowhere/event1".into()).into());
        let shown = window.bench.notices.shown();
        assert!(
            shown[0].text.starts_with("/nowhere/event1"),
            "{}",
            shown[0].text
        );
        window.dispatch(SourceCommand::List.into());
        assert!(window.bench.exploration.sources.view().is_known);
    }
}
