//! `selvedge drape`: a hanging cloth under two fingers, step by step; and its testers.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::{Args, Subcommand};
use serde::Serialize;

use super::output::{self, InFile, OutFile, TableOut};
use super::render_out::{AMPLITUDE_COLUMNS, write_amplitudes};
use super::terminal::{self, Meter};
use super::{CliError, signals};
use selvedge_drape::{
    Drape, DrapeCounters, DrapeError, DrapeScene, Felt, Hand, HandPath, Integrator, test_fabric,
};
use selvedge_foundation::files::{read_text, to_json_string};
use selvedge_foundation::numerics::to_whole;
use selvedge_foundation::progress::Cancelled;
use selvedge_foundation::quantity::fixed;
use selvedge_render::MaterialContact;
use selvedge_render::scene::TICKS_PER_S;

const PATH_HELP: &str =
    "Hands: t_s and per finger x_mm,y_mm,z_mm,opening_mm (without it: the shape at rest)";
/// Shapes are written as often as a display is given amplitudes, s.
const MESH_EVERY_S: f64 = 1.0 / TICKS_PER_S;
/// Most steps of one run.
const MAX_STEPS: f64 = 2e7;
/// What can be lost from the last step by rounding, in steps.
const LAST_STEP_SLACK: f64 = 1e-6;

/// What hangs, who touches it, and what to write.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(super) struct DrapeArgs {
    /// Scene file of a hanging cloth
    #[arg(required = true)]
    scene: Option<InFile>,
    #[arg(long, value_name = "FINGERS.csv", help = PATH_HELP)]
    path: Option<InFile>,
    /// Forces on the fingers, a row a step or, if that is shorter, a millisecond; without --path
    /// the shape at rest (standard output if no file is asked for)
    #[arg(long, value_name = "F.csv")]
    out: Option<OutFile>,
    /// Where every vertex is, forty times a second
    #[arg(long, value_name = "M.csv")]
    mesh: Option<OutFile>,
    /// Amplitudes of the contactors on both pads, a row a contactor a tick; places are the cloth's
    #[arg(long, value_name = "A.csv", requires = "path")]
    amplitudes: Option<OutFile>,
    /// How to step: explicit, ie, bdf2, xpbd, pd or auto (the scene's)
    #[arg(long, value_name = "METHOD")]
    integrator: Option<Integrator>,
    /// Length of a step, ms (the scene's, or by the integrator)
    #[arg(long, value_name = "MS")]
    dt: Option<f64>,
    /// Steps, iterations, energy and what was left out, as JSON
    #[arg(long, value_name = "S.json")]
    stats: Option<OutFile>,
    #[command(subcommand)]
    command: Option<DrapeCommand>,
}

/// What else there is.
#[derive(Debug, Subcommand)]
enum DrapeCommand {
    /// The Kawabata testers on the simulated cloth, beside the figures that went in
    Test {
        /// A textile's id, or a scene file of a hanging cloth
        fabric: String,
    },
}

/// What `--stats` writes.
#[derive(Debug, Serialize)]
struct StatsFile<'a> {
    program: &'static str,
    version: &'static str,
    scene: &'a Path,
    path: Option<&'a Path>,
    /// Keys of figures that nobody measured.
    plausible_figures: &'a [String],
    vertices: [usize; 2],
    integrator: &'static str,
    why: &'a str,
    step_ms: f64,
    simulated_s: f64,
    /// At the start, and the largest by which it rose above that and the hands' work.
    energy_start_j: f64,
    energy_gained_j: f64,
    work_j: f64,
    counters: DrapeCounters,
}

/// Lets it hang, and touches it.
pub(super) fn run(args: &DrapeArgs) -> Result<(), CliError> {
    if let Some(DrapeCommand::Test { fabric }) = &args.command {
        return test(fabric);
    }
    let Some(file) = &args.scene else {
        return Err(CliError::Input("no scene is named; give one".to_owned()));
    };
    let scene = DrapeScene::from_text(&read_text(file)?, file.place())?;
    scene.notes().for_each(terminal::notice);
    let mut drape = Drape::new(&scene, args.integrator, args.dt.map(|ms| 1e-3 * ms))?;
    let (integrator, why) = drape.integrator();
    let step_ms = 1e3 * drape.step_s();
    let plausible = scene.plausible();
    let plausible = plausible.map_or_else(String::new, |words| format!("; {words}"));
    terminal::notice(&format!(
        "{} at {} ms: {why}{plausible}",
        integrator.name(),
        fixed(step_ms, 3)
    ));
    let stop = signals::stop_flag()?;
    let energy = if let Some(path) = &args.path {
        let hands = HandPath::read(path, &scene)?;
        let felt = args.amplitudes.as_deref();
        let felt = felt
            .map(|path| AmplitudesOut::new(path, &scene))
            .transpose()?;
        follow((args, felt), &mut drape, &hands, &stop)?
    } else {
        let place = args.out.as_deref().or(args.mesh.as_deref());
        let mut mesh = TableOut::new(place, &MESH_COLUMNS)?;
        write_mesh(&mut mesh, &drape)?;
        mesh.finish()?;
        [drape.energy_j()[0], 0.0]
    };
    let DrapeCounters {
        overstretched,
        steps,
        ..
    } = *drape.counters();
    if overstretched > 0 {
        terminal::notice(&format!(
            "yarns were stretched farther than EMT in {overstretched} of {steps} steps: from there \
             on the curve is a straight line"
        ));
    }
    match &args.stats {
        Some(place) => write_stats((args, &scene), place, &mut drape, energy),
        None => Ok(()),
    }
}

/// Leads the fingers along their path; says the energy at the start and the most that was gained.
fn follow(
    (args, mut felt): (&DrapeArgs, Option<AmplitudesOut>),
    drape: &mut Drape,
    path: &HandPath,
    stop: &Arc<AtomicBool>,
) -> Result<[f64; 2], CliError> {
    let [start_s, end_s] = path.span_s();
    let step_s = drape.step_s();
    let n_steps = ((end_s - start_s) / step_s + LAST_STEP_SLACK).floor();
    if n_steps > MAX_STEPS {
        let what = format!("the path takes {n_steps} steps of {} ms", 1e3 * step_s);
        return Err(CliError::Input(format!(
            "{what}; give a shorter one, or a larger --dt"
        )));
    }
    let mut hands: Vec<Hand> = drape.start_hands();
    path.at(start_s, &mut hands);
    drape.place(&hands);
    // Before anything is written.
    drape.holds()?;
    let mesh = args.mesh.as_deref();
    let mesh = mesh.map(|path| TableOut::new(Some(path), &MESH_COLUMNS));
    let mut mesh = mesh.transpose()?;
    let [start_j, _] = drape.energy_j();
    let (mut gained_j, mut next_mesh) = (0.0_f64, 0.0);
    let mut forces = ForcesOut::new(args.out.as_deref(), (step_s, start_j))?;
    let mut meter = Meter::new("draping");
    for nth in 1..=to_whole::<u64>(n_steps) {
        if stop.load(Ordering::Relaxed) {
            return Err(Cancelled.into());
        }
        if let Some(mesh) = mesh.as_mut().filter(|_| drape.t_s() >= next_mesh - 1e-9) {
            write_mesh(mesh, drape)?;
            next_mesh += MESH_EVERY_S;
        }
        let to_s = Drape::after_s(nth, step_s);
        while let Some(t_s) = forces.next_between(to_s) {
            path.at(start_s + t_s, &mut hands);
            drape.feel(&hands, &mut forces.between_n);
            forces.write(drape, t_s)?;
        }
        path.at(start_s + to_s, &mut hands);
        drape.step(&hands)?;
        let [energy_j, work_j] = drape.energy_j();
        gained_j = gained_j.max(energy_j - start_j - work_j);
        forces.energy_j = energy_j;
        if !forces.is_between {
            forces.write(drape, drape.t_s())?;
        }
        if let Some(felt) = &mut felt {
            felt.take(drape)?;
        }
        meter.show(nth as f64 / n_steps, drape.integrator().0.name());
    }
    if let Some(mut mesh) = mesh {
        write_mesh(&mut mesh, drape)?;
        mesh.finish()?;
    }
    felt.map_or(Ok(()), |felt| felt.table.finish())?;
    forces.table.finish()?;
    Ok([start_j, gained_j])
}

/// What the contactors are given at every tick of their displays.
struct AmplitudesOut {
    table: TableOut,
    felt: Felt,
    textiles: Vec<String>,
}

impl AmplitudesOut {
    fn new(path: &Path, scene: &DrapeScene) -> Result<Self, CliError> {
        Ok(Self {
            felt: Felt::new(scene)?,
            table: TableOut::new(Some(path), &AMPLITUDE_COLUMNS)?,
            textiles: scene.surfaces().map(str::to_owned).collect(),
        })
    }

    /// Writes the tick that a step has come to, if it has.
    fn take(&mut self, drape: &mut Drape) -> Result<(), CliError> {
        let (t_s, table) = (drape.t_s(), &mut self.table);
        let textiles = &self.textiles;
        self.felt.take(drape, |felt| {
            let textile = textiles.get(felt.surface).map_or("", String::as_str);
            for (contactor, contact) in felt.contacts.iter().enumerate() {
                let rows = table.rows();
                rows.number(felt.tick).number(t_s);
                rows.number(felt.finger).number(contactor);
                if let Some(MaterialContact { place_mm, .. }) = contact {
                    rows.number(place_mm[0]).number(place_mm[1]).text(textile);
                } else {
                    rows.text("").text("").text("");
                }
                write_amplitudes(table, felt.frame, contactor);
                table.rows().end_row()?;
            }
            Ok(())
        })
    }
}

/// Forces at every step, or where those are longer at every millisecond.
struct ForcesOut {
    table: TableOut,
    /// Whether steps are longer: hands feel the cloth between them.
    is_between: bool,
    tick: u64,
    between_n: [[f64; 3]; 2],
    /// After the last step.
    energy_j: f64,
}

impl ForcesOut {
    fn new(path: Option<&Path>, (step_s, energy_j): (f64, f64)) -> Result<Self, CliError> {
        Ok(Self {
            table: TableOut::new(path, &Drape::FORCE_COLUMNS)?,
            is_between: step_s > Drape::FEELS_EVERY_S * (1.0 + LAST_STEP_SLACK),
            tick: 0,
            between_n: [[0.0; 3]; 2],
            energy_j,
        })
    }

    /// The next millisecond up to a time, s.
    fn next_between(&mut self, to_s: f64) -> Option<f64> {
        let t_s = (self.tick + 1) as f64 / Drape::FEELS_EVERY_S.recip();
        let is_due = self.is_between && t_s <= to_s + LAST_STEP_SLACK * Drape::FEELS_EVERY_S;
        self.tick += u64::from(is_due);
        is_due.then_some(t_s)
    }

    /// A row for each finger; one of no finger where there is none.
    fn write(&mut self, drape: &Drape, t_s: f64) -> Result<(), CliError> {
        let n_fingers = drape.start_hands().len().max(1);
        for finger in 0..n_fingers {
            let mut row = drape.force_row(finger, self.energy_j);
            if self.is_between {
                row[0] = t_s;
            }
            if self.is_between && drape.has_touch() {
                row[2..5].copy_from_slice(&self.between_n[finger]);
            }
            let rows = self.table.rows();
            for value in row {
                // What is not told stays empty.
                rows.optional(Some(value).filter(|value| !value.is_nan()));
            }
            rows.end_row()?;
        }
        Ok(())
    }
}

/// Columns of a table of shapes.
const MESH_COLUMNS: [&str; 6] = ["t_s", "i", "j", "x_mm", "y_mm", "z_mm"];

fn write_mesh(mesh: &mut TableOut, drape: &Drape) -> Result<(), CliError> {
    let [n_warp, _] = drape.grid();
    for (vertex, place) in drape.places_mm().enumerate() {
        let rows = mesh.rows().number(drape.t_s());
        rows.number(vertex % n_warp).number(vertex / n_warp);
        for mm in place {
            rows.number(mm);
        }
        rows.end_row()?;
    }
    Ok(())
}

fn write_stats(
    (args, scene): (&DrapeArgs, &DrapeScene),
    place: &Path,
    drape: &mut Drape,
    [energy_start_j, energy_gained_j]: [f64; 2],
) -> Result<(), CliError> {
    let [_, work_j] = drape.energy_j();
    let (integrator, why) = drape.integrator();
    let file = StatsFile {
        program: "selvedge",
        version: env!("CARGO_PKG_VERSION"),
        scene: args
            .scene
            .as_ref()
            .map_or_else(|| Path::new(""), InFile::place),
        plausible_figures: scene.plausible_figures(),
        path: args.path.as_deref(),
        vertices: drape.grid(),
        integrator: integrator.name(),
        why,
        step_ms: 1e3 * drape.step_s(),
        simulated_s: drape.t_s(),
        energy_start_j,
        energy_gained_j,
        work_j,
        counters: *drape.counters(),
    };
    output::write_text(Some(place), &to_json_string(&file, place)?)
}

/// Prints what the simulated testers find.
fn test(fabric: &str) -> Result<(), CliError> {
    let path = Path::new(fabric);
    let scene = if path.is_file() {
        DrapeScene::read(path)
    } else {
        DrapeScene::of_textile(fabric)
    };
    let scene = scene.map_err(|error| match error {
        DrapeError::Textile(error) => CliError::Input(error.to_string()),
        other => other.into(),
    })?;
    scene.notes().for_each(terminal::notice);
    if let Some(words) = scene.plausible() {
        terminal::notice(&words);
    }
    let head = ["figure", "given", "found", "off %", "unit"].map(str::to_owned);
    let rows = test_fabric(&scene)?.into_iter().map(|figure| {
        let off = 100.0 * (figure.found / figure.given - 1.0);
        [
            figure.name,
            fixed(figure.given, 4),
            fixed(figure.found, 4),
            fixed(off, 2),
            figure.unit.to_owned(),
        ]
    });
    let line = |[name, given, found, off, unit]: [String; 5]| {
        let line = format!("{name:10} {given:>10} {found:>10} {off:>8}  {unit}");
        line.trim_end().to_owned() + "\n"
    };
    let text: String = std::iter::once(head).chain(rows).map(line).collect();
    output::print(&text)
}
