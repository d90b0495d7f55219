//! `selvedge probe`: a stylus over a surface, row by row.

use std::sync::atomic::Ordering;

use clap::Args;

use super::output::{InFile, OutFile, TableOut};
use super::probe_surface::{FeltArgs, felt, tip};
use super::terminal::{self, Meter};
use super::{CliError, signals};
use selvedge_foundation::geometry::Point;
use selvedge_foundation::numerics::to_whole;
use selvedge_foundation::progress::Cancelled;
use selvedge_render::contact::{
    Contact, ContactLaw, DeviceSpec, ForceParts, Friction, Hand, Sampling, Standing, Stepper,
    StylusRow, StylusRun, StylusSetup, StylusStart,
};
use selvedge_render::scene::{ExplorationPath, Stroke};

/// Most rows of one table.
const MAX_ROWS: f64 = 2e7;
/// What can be lost from the last row by rounding, in rows.
const LAST_ROW_SLACK: f64 = 1e-6;

/// What is felt, by what, and how.
#[derive(Debug, Args)]
pub(super) struct ProbeArgs {
    /// A textile's id, "flat", or a file of heights
    #[arg(long, value_name = "ID|FILE")]
    surface: String,
    #[command(flatten)]
    felt: FeltArgs,
    #[command(flatten)]
    way: WayArgs,
    #[command(flatten)]
    wall: WallArgs,
    #[command(flatten)]
    how: HowArgs,
    #[command(flatten)]
    device: DeviceArgs,
    /// The table (standard output if none is named)
    #[arg(long, value_name = "F.csv")]
    out: Option<OutFile>,
}

/// Where the stylus goes.
#[derive(Debug, Args)]
struct WayArgs {
    /// Exploration in the textile's own frame: a path file, as of render; `-` is standard input
    #[arg(long, value_name = "PATH.csv", conflicts_with = "stroke")]
    path: Option<InFile>,
    /// A line there and back: X,Y:X,Y in mm
    #[arg(long, value_name = "X,Y:X,Y", value_parser = stroke, allow_hyphen_values = true)]
    stroke: Option<[Point; 2]>,
    /// Speed of the stroke, mm/s
    #[arg(
        long,
        value_name = "MM_PER_S",
        default_value_t = 50.0,
        requires = "stroke"
    )]
    speed: f64,
    /// How long (as long as the path, or there and back once; 1 s in place)
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
    /// Released so far above the surface, at rest (it rests on the surface if not said)
    #[arg(long, value_name = "MM")]
    drop: Option<f64>,
    /// With what force the hand presses down, N
    #[arg(long, value_name = "N", default_value_t = 1.0)]
    hand_force: f64,
    /// How stiffly the hand leads the tip along the surface, N/m (the tip is where the path is if
    /// not said)
    #[arg(long, value_name = "N_PER_M")]
    hand_stiffness: Option<f64>,
}

/// What the surface does to it.
#[derive(Debug, Args)]
struct WallArgs {
    /// Stiffness of the surface, N/m
    #[arg(
        long,
        value_name = "K",
        default_value_t = 1000.0,
        allow_negative_numbers = true
    )]
    stiffness: f64,
    /// Damping of the surface, N·s/m
    #[arg(
        long,
        value_name = "B",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    damping: f64,
    /// Largest contact force, N
    #[arg(long, value_name = "N")]
    ceiling: Option<f64>,
    /// Which part of the force is given: normal, lateral or both
    #[arg(long, value_name = "PART", default_value = "both")]
    force: ForceParts,
    /// Coefficient of friction (the textile's measured trace if it has one, else none)
    #[arg(long, value_name = "MU")]
    friction: Option<f64>,
    /// Leave out the softness that a textile's compression figures give it
    #[arg(long)]
    rigid: bool,
    /// What touches: stylus, fingertip or an array (exeter-24, 5x5, 10x10)
    #[arg(long, value_name = "TIP", default_value = "stylus")]
    tip: String,
    /// Radius of the tip, mm
    #[arg(long, value_name = "MM", default_value_t = 0.5)]
    tip_radius: f64,
}

/// How it is computed.
#[derive(Debug, Args)]
struct HowArgs {
    /// How to step: explicit-euler, semi-implicit-euler, rk4, trapezoid, implicit-euler, exact or
    /// auto
    #[arg(long, value_name = "METHOD", default_value = "auto")]
    method: Stepper,
    /// Steps, or ticks of the controller, a second
    #[arg(long, value_name = "HZ", default_value_t = 1000.0)]
    rate: f64,
    /// Whether the force acts at all times or is sampled and held: continuous, sampled
    #[arg(long, value_name = "KIND", default_value = "continuous",
          value_parser = ["continuous", "sampled"])]
    controller: String,
    /// Ticks by which a sampled force is late
    #[arg(long, value_name = "N", default_value_t = 0)]
    delay: usize,
    /// Let the passivity controller change a sampled force
    #[arg(long)]
    passive: bool,
}

/// What holds it.
#[derive(Debug, Args)]
struct DeviceArgs {
    /// Mass of the tip, kg
    #[arg(long, value_name = "KG", default_value_t = DeviceSpec::default().mass_kg)]
    mass: f64,
    /// Damping of the device itself, N·s/m
    #[arg(long, value_name = "B", default_value_t = 0.0)]
    device_damping: f64,
    /// Coulomb friction of the device itself, N
    #[arg(long, value_name = "N", default_value_t = 0.0)]
    device_friction: f64,
    /// Resolution of its encoders, mm
    #[arg(long, value_name = "MM", default_value_t = 0.0)]
    resolution: f64,
    /// What is faster goes to vibration, Hz
    #[arg(long, value_name = "HZ", default_value_t = DeviceSpec::default().bandwidth_hz)]
    bandwidth: f64,
}

/// Feels it.
pub(super) fn run(args: &ProbeArgs) -> Result<(), CliError> {
    let way = Way::of(&args.way)?;
    let setup = setup(args)?;
    let (rate_hz, mut case, (method, why)) = (setup.rate_hz, setup.case(), setup.chosen());
    let felt_as = format!("{}: {}", args.surface, setup.contact.relief().reading());
    let start = args
        .way
        .drop
        .map_or(StylusStart::Resting, StylusStart::Above);
    let mut from_row = 0;
    // What is no setting is refused before anything is said of it.
    let mut run = StylusRun::new(setup, way.place_mm(0.0, &mut from_row), start)?;
    let n_steps = (way.seconds * rate_hz + LAST_ROW_SLACK).floor();
    if !(0.0..=MAX_ROWS).contains(&n_steps) {
        let what = format!(
            "{} s at {rate_hz} Hz are no table; give at most {MAX_ROWS:e} rows",
            way.seconds
        );
        return Err(CliError::Input(what));
    }
    terminal::notice(&felt_as);
    if args.how.method == Stepper::Auto {
        terminal::notice(&format!("method {}: {why}", method.name()));
    }
    case.method = method;
    if case.standing() != Standing::Stable {
        terminal::notice(&case.advice());
    }
    let mut table = TableOut::new(
        args.out.as_deref(),
        &StylusRow::COLUMNS.map(|(name, _)| name),
    )?;
    let (stop, mut meter) = (signals::stop_flag()?, Meter::new("feeling"));
    write(&mut table, run.row())?;
    for nth in 1..=to_whole::<u64>(n_steps) {
        if stop.load(Ordering::Relaxed) {
            return Err(Cancelled.into());
        }
        let row = run.step(way.place_mm(nth as f64 / rate_hz, &mut from_row))?;
        write(&mut table, row)?;
        meter.show(nth as f64 / n_steps, method.name());
    }
    table.finish()
}

fn write(table: &mut TableOut, row: &StylusRow) -> Result<(), CliError> {
    let rows = table.rows();
    for (_, figure) in StylusRow::COLUMNS {
        rows.number(figure(row));
    }
    Ok(rows.end_row()?)
}

/// Where the stylus is led.
struct Way {
    kind: WayKind,
    seconds: f64,
}

enum WayKind {
    Place,
    Path(ExplorationPath),
    Stroke(Stroke),
}

impl Way {
    fn of(args: &WayArgs) -> Result<Self, CliError> {
        let (kind, own_seconds) = match (&args.path, args.stroke) {
            (Some(path), _) => {
                let path = ExplorationPath::read(path)?;
                let seconds = path.duration_s();
                (WayKind::Path(path), seconds)
            }
            (None, Some(_)) if !(args.speed > 0.0 && args.speed.is_finite()) => {
                let what = format!("the speed is {} mm/s; give more than 0 mm/s", args.speed);
                return Err(CliError::Input(what));
            }
            (None, Some([start, end])) => {
                let stroke = Stroke::Line {
                    start,
                    end,
                    speed_mm_per_s: args.speed,
                };
                stroke.check()?;
                (WayKind::Stroke(stroke), stroke.period_s())
            }
            (None, None) if args.drop.is_some() => (WayKind::Place, 1.0),
            (None, None) => {
                let what = "the stylus goes nowhere; give --path, --stroke or --drop";
                return Err(CliError::Input(what.to_owned()));
            }
        };
        let seconds = args.seconds.unwrap_or(own_seconds);
        Ok(Self { kind, seconds })
    }

    /// Where it is at a time; `from` is where a path was looked at last.
    fn place_mm(&self, t_s: f64, from: &mut usize) -> [f64; 2] {
        let place = match &self.kind {
            WayKind::Place => Point::new(0.0, 0.0),
            WayKind::Stroke(stroke) => stroke.at(t_s).0,
            WayKind::Path(path) => {
                let (row, at) = path.row_at(path.rows()[0].t_s + t_s, *from);
                *from = at;
                row.position
            }
        };
        [place.x_mm, place.y_mm]
    }
}

fn setup(args: &ProbeArgs) -> Result<StylusSetup, CliError> {
    let (wall, device, how) = (&args.wall, &args.device, &args.how);
    let tip = tip(&wall.tip, wall.tip_radius)?;
    let mut felt = felt(&args.surface, &args.felt, &tip)?;
    if let Some(mu) = wall.friction {
        felt.friction = Friction::coulomb(mu);
    }
    let law = ContactLaw {
        stiffness_n_per_m: wall.stiffness,
        damping_n_s_per_m: wall.damping,
        ceiling_n: wall.ceiling.unwrap_or(f64::INFINITY),
        parts: wall.force,
        cloth: felt.cloth.filter(|_| !wall.rigid),
    };
    law.check()?;
    let sampling = Sampling {
        delay_ticks: how.delay,
        is_kept_passive: how.passive,
    };
    let is_sampled = how.controller == "sampled";
    if !is_sampled && (how.delay > 0 || how.passive) {
        let what = "a force that acts at all times is never late nor corrected; give --controller \
                    sampled";
        return Err(CliError::Input(what.to_owned()));
    }
    Ok(StylusSetup {
        contact: Contact::new(&felt.relief, tip, law, felt.friction)?,
        device: DeviceSpec {
            mass_kg: device.mass,
            damping_n_s_per_m: device.device_damping,
            friction_n: device.device_friction,
            resolution_mm: device.resolution,
            bandwidth_hz: device.bandwidth,
            ..DeviceSpec::default()
        },
        hand: Hand {
            press_n: args.way.hand_force,
            leads: args.way.hand_stiffness.map(|stiffness| [stiffness, 0.0]),
        },
        method: how.method,
        rate_hz: how.rate,
        sampling: is_sampled.then_some(sampling),
    })
}

fn stroke(text: &str) -> Result<[Point; 2], String> {
    let number = |text: &str| text.trim().parse().ok().filter(|mm: &f64| mm.is_finite());
    let place = |text: &str| {
        let (x, y) = text.split_once(',')?;
        Some(Point::new(number(x)?, number(y)?))
    };
    let ends = text.split_once(':');
    ends.and_then(|(start, end)| Some([place(start)?, place(end)?]))
        .ok_or_else(|| "give two places in mm, such as 0,0:30,0".to_owned())
}
