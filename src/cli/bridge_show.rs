//! `selvedge bridge emulate --show`: what the emulated contactors do, on the terminal.
//!
//! It stands on stderr and only where that is a terminal; the first line of stdout stays the link.

use std::io::{self, IsTerminal as _, Write as _};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{Builder, JoinHandle};
use std::time::Duration;

use clap::Args;

use super::{CliError, terminal};
use selvedge_device::{
    ActuatorReading, ActuatorWatch, Bimorph, ContactorModel, ContactorReading, DeviceState, Skin,
};
use selvedge_foundation::quantity;

/// Between two pictures.
const REFRESH: Duration = Duration::from_millis(250);
/// Columns of contactors beyond which the grids stand one below the other.
const MOST_BESIDE: usize = 5;
/// Letters of a cell.
const CELL: usize = 7;

/// The contactors of an emulated device, and whether they are shown.
#[derive(Debug, Args)]
pub(super) struct PlantArgs {
    /// Show displacement and current of every contactor, a model estimate, on the terminal
    #[arg(long)]
    show: bool,
    #[command(flatten)]
    contactors: ContactorArgs,
}

/// What is assumed of contactors.
#[derive(Debug, Args)]
pub(super) struct ContactorArgs {
    /// The finger on them: free, light, firm, or KS,CS or KS,CS,PRELOAD in N/m, N s/m and µm
    #[arg(long, value_name = "SKIN", default_value = "light", value_parser = skin)]
    skin: Skin,
    /// The beams: length, width and thickness of both layers in mm
    #[arg(long, value_name = "LxWxT", default_value = "25x1.5x0.6", value_parser = bimorph)]
    bimorph: Bimorph,
    /// Quality factor of a free beam, 0.1 to 1000
    #[arg(long, value_name = "Q", default_value_t = 40.0)]
    quality: f64,
}

fn skin(text: &str) -> Result<Skin, String> {
    text.parse().map_err(|error| format!("{error}"))
}

fn bimorph(text: &str) -> Result<Bimorph, String> {
    let numbers: Result<Vec<f64>, _> = text.split(['x', '×']).map(|n| n.trim().parse()).collect();
    let Ok(&[length_mm, width_mm, thickness_mm]) = numbers.as_deref() else {
        return Err("give length, width and thickness in mm: 25x1.5x0.6".to_owned());
    };
    let bimorph = Bimorph {
        length_mm,
        width_mm,
        thickness_mm,
    };
    bimorph.check().map_err(|error| error.to_string())?;
    Ok(bimorph)
}

impl ContactorArgs {
    /// The contactors that are asked for.
    pub(super) fn model(&self) -> Result<ContactorModel, CliError> {
        let model = ContactorModel {
            bimorph: self.bimorph,
            quality: self.quality,
            skin: self.skin,
            ..ContactorModel::default()
        };
        model.check()?;
        Ok(model)
    }
}

impl PlantArgs {
    /// The contactors that are asked for.
    pub(super) fn model(&self) -> Result<ContactorModel, CliError> {
        self.contactors.model()
    }

    /// Whether they are to be shown and there is a terminal for it.
    pub(super) fn is_shown(&self) -> bool {
        let is_terminal = io::stderr().is_terminal();
        if self.show && !is_terminal {
            terminal::notice("--show needs a terminal on stderr; nothing is shown");
        }
        self.show && is_terminal
    }
}

/// A view that is renewed until it is dropped.
#[derive(Debug)]
pub(super) struct PlantView {
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl PlantView {
    /// Shows an array of `n_columns` columns on stderr.
    pub(super) fn start(mut watch: ActuatorWatch, n_columns: usize) -> Result<Self, CliError> {
        let is_over = Arc::new(AtomicBool::new(false));
        let seen = Arc::clone(&is_over);
        watch.look(true);
        let body = move || {
            let mut n_lines = 0;
            while !seen.load(Ordering::Acquire) {
                let model = *watch.model();
                let lines = picture(watch.reading(), &model, n_columns);
                draw(&lines, n_lines);
                n_lines = lines.len();
                std::thread::park_timeout(REFRESH);
            }
        };
        let thread = Builder::new().name("bridge-show".to_owned()).spawn(body);
        let thread = thread.map_err(|error| CliError::Failed(format!("no thread: {error}")))?;
        Ok(Self {
            is_over,
            thread: Some(thread),
        })
    }
}

impl Drop for PlantView {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Release);
        if let Some(thread) = self.thread.take() {
            thread.thread().unpark();
            drop(thread.join());
        }
    }
}

/// Puts a picture over the last one. Errors of stderr are dropped: there is nowhere to tell them.
fn draw(lines: &[String], n_last: usize) {
    let up = if n_last > 0 {
        format!("\x1b[{n_last}A")
    } else {
        String::new()
    };
    let fresh = lines.iter().map(|line| format!("\x1b[2K{line}\n"));
    let text: String = std::iter::once(up).chain(fresh).collect();
    let mut stderr = io::stderr().lock();
    drop(stderr.write_all(text.as_bytes()));
    drop(stderr.flush());
}

/// The lines of a tick's picture; as many every time.
fn picture(reading: &ActuatorReading, model: &ContactorModel, n_columns: usize) -> Vec<String> {
    let Bimorph {
        length_mm,
        width_mm,
        thickness_mm,
    } = model.bimorph;
    let beams = format!(
        "beams {length_mm} × {width_mm} × {thickness_mm} mm, Q {}",
        model.quality
    );
    let mut lines = vec![
        state_words(reading),
        format!("skin {}; {beams}", model.skin),
        String::new(),
    ];
    let left = grid("displacement, µm peak", reading, n_columns, |one| {
        quantity::fixed(one.peak_um, 1)
    });
    let right = grid("current, mA rms", reading, n_columns, |one| {
        quantity::fixed(one.current_rms_ma, 2)
    });
    if n_columns <= MOST_BESIDE {
        let both = left.iter().zip(&right);
        lines.extend(both.map(|(left, right)| format!("{left}    {right}")));
    } else {
        lines.extend(left.into_iter().chain(right));
    }
    lines.push(String::new());
    lines.push(share_words("skin off", reading, |one| one.lost_share));
    lines.push(share_words("amplifier held back", reading, |one| {
        one.saturated_share
    }));
    let total = quantity::with_unit(reading.current_ma(), 2, "mA");
    lines.push(format!(
        "all together {total}; a model estimate from design-sheet values"
    ));
    lines
}

fn state_words(reading: &ActuatorReading) -> String {
    let armed = match reading.state {
        DeviceState::Armed | DeviceState::Run | DeviceState::Hold | DeviceState::Ramp => {
            "armed, high voltage on"
        }
        DeviceState::Idle | DeviceState::Ready | DeviceState::Fault => "not armed",
    };
    format!("{}, {armed}", reading.state)
}

/// Rows of numbers, the fingertip's end first, with a heading; all lines equally wide.
fn grid(
    heading: &str,
    reading: &ActuatorReading,
    n_columns: usize,
    of: fn(&ContactorReading) -> String,
) -> Vec<String> {
    let width = (CELL * n_columns).max(heading.chars().count());
    let mut lines = vec![format!("{heading:>width$}")];
    for row in reading.contactors.chunks(n_columns.max(1)) {
        let cells: Vec<String> = row
            .iter()
            .map(|one| format!("{:>CELL$}", of(one)))
            .collect();
        let cells = cells.concat();
        lines.push(format!("{cells:>width$}"));
    }
    lines
}

/// How many contactors have a share above 0, and the largest.
fn share_words(what: &str, reading: &ActuatorReading, of: fn(&ContactorReading) -> f64) -> String {
    let shares = || reading.contactors.iter().map(of);
    let n = shares().filter(|share| *share > 0.0).count();
    if n == 0 {
        return format!("{what}: none");
    }
    let most = quantity::with_unit(100.0 * shares().fold(0.0, f64::max), 0, "%");
    format!(
        "{what}: on {n} of {}, up to {most} of the time",
        reading.contactors.len()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_picture_names_state_units_and_load_and_keeps_its_height() {
        let mut reading = ActuatorReading::new(24);
        let model = ContactorModel::default();
        let still = picture(&reading, &model, 4);
        reading.state = DeviceState::Run;
        reading.contactors[5] = ContactorReading {
            peak_um: 12.34,
            current_rms_ma: 0.256,
            lost_share: 0.5,
            ..ContactorReading::default()
        };
        let text = picture(&reading, &model, 4);
        assert_eq!(text.len(), still.len());
        assert!(
            text.iter().all(|line| line.chars().count() <= 80),
            "{text:#?}"
        );
        let [text, still] = [text, still].map(|lines| lines.join("\n"));
        for words in [
            "RUN, armed",
            "µm peak",
            "mA rms",
            "12.3",
            "0.26",
            "light (200 N/m, 0.05 N s/m)",
            "skin off: on 1 of 24, up to 50 % of the time",
            "model estimate",
        ] {
            assert!(text.contains(words), "{words} in\n{text}");
        }
        assert!(still.contains("IDLE, not armed"), "{still}");
        assert!(
            text.lines().all(|line| line.chars().count() <= 80),
            "{text}"
        );
    }

    #[test]
    fn beams_are_read_in_millimetres() {
        assert_eq!(bimorph("25x1.5x0.6"), Ok(Bimorph::default()));
        assert!(bimorph("25x1.5").unwrap_err().contains("25x1.5x0.6"));
        assert!(bimorph("0x1x1").unwrap_err().contains("length"));
    }
}
