//! What moves the display in `selvedge play`, and who else hears of it.

use std::io::{self, BufReader};
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;

use super::output::InFile;
use super::{CliError, terminal};
use selvedge_engine::{
    Area, EngineCore, EngineError, InputDevice, InputSource, PreparedScene, ProgramLink, Tap,
    loopback,
};
use selvedge_render::scene::ExplorationPath;

const PATH_HELP: &str = "Exploration: a path file, or - for lines of x_mm,y_mm or \
                         t_s,x_mm,y_mm[,angle_deg] on standard input";

const INPUT_HELP: &str = "A tablet or touch frame that is read directly: evdev:/dev/input/eventN";

/// Where positions come from.
#[derive(Debug, Args)]
pub(super) struct SourceArgs {
    #[arg(
        long,
        value_name = "PATH.csv",
        help = PATH_HELP,
        required_unless_present_any = ["input", "listen"],
        conflicts_with = "input"
    )]
    path: Option<InFile>,
    #[arg(long, value_name = "DEVICE", help = INPUT_HELP, value_parser = device)]
    input: Option<PathBuf>,
    /// Where the device's surface lies in the workspace, mm (as large as its driver says and in the
    /// middle, if it says so; else over all of it)
    #[arg(
        long,
        value_name = "X,Y,W,H",
        requires = "input",
        allow_hyphen_values = true
    )]
    area_mm: Option<Area>,
    /// Let other programs of this machine join: amplitudes out as lines, one a tick, and positions
    /// in where neither a path nor a device is named
    #[arg(long, value_name = "127.0.0.1:PORT", value_parser = loopback)]
    listen: Option<SocketAddr>,
    /// Begin again at the end of the path, until SIGINT or SIGTERM
    #[arg(long = "loop")]
    does_loop: bool,
}

impl SourceArgs {
    /// The path's file, if there is one.
    pub(super) fn path_file(&self) -> Option<&Path> {
        let path = self.path.as_ref().filter(|path| !path.is_stream());
        path.map(|path| &**path)
    }
}

/// A device as it is named on the command line.
fn device(text: &str) -> Result<PathBuf, String> {
    let path = text.strip_prefix("evdev:").filter(|path| !path.is_empty());
    path.map(PathBuf::from).ok_or_else(|| {
        "write evdev:/dev/input/eventN; \"selvedge input list\" names them".to_owned()
    })
}

/// A display that moves.
pub(super) struct Moving {
    /// What is felt.
    pub(super) core: EngineCore,
    /// The programs that joined; lets them go when dropped.
    _programs: Option<ProgramLink>,
    tap: Option<Tap>,
}

impl Moving {
    /// Feels `scene`, moved as `args` say; the scene's workspace is `size_mm` wide and high.
    pub(super) fn begin(
        args: &SourceArgs,
        scene: PreparedScene,
        size_mm: [f64; 2],
    ) -> Result<Self, CliError> {
        let programs = args.listen.map(ProgramLink::listen).transpose()?;
        if let Some(programs) = &programs {
            let address = programs.address();
            terminal::notice(&format!("other programs may join at {address}"));
        }
        let source = source_of(args, programs.as_ref(), size_mm)?;
        let tap = programs.as_ref();
        let tap = tap.and_then(|programs| programs.tap(scene.n_felt()));
        let (mut core, _pointer) = EngineCore::new(Box::new(scene));
        core.play(source, args.does_loop)?;
        Ok(Self {
            core,
            _programs: programs,
            tap,
        })
    }

    /// Tells the programs the tick that was just done.
    pub(super) fn write_tick(&mut self) {
        if let Some(tap) = &mut self.tap {
            self.core.write_to(tap);
        }
    }
}

fn source_of(
    args: &SourceArgs,
    programs: Option<&ProgramLink>,
    size_mm: [f64; 2],
) -> Result<InputSource, CliError> {
    if let Some(device) = &args.input {
        let opened = InputDevice::open(device, args.area_mm, size_mm);
        return Ok(InputSource::Live(opened.map_err(EngineError::from)?));
    }
    match (&args.path, programs) {
        (None, Some(programs)) => Ok(programs.source()),
        (Some(path), _) if !path.is_stream() => {
            let path = ExplorationPath::read(path)?;
            Ok(InputSource::Replay(Arc::new(path)))
        }
        _ if args.does_loop => {
            let what = "a stream on standard input cannot begin again; leave out --loop";
            Err(CliError::Input(what.to_owned()))
        }
        _ => Ok(InputSource::Lines(Box::new(BufReader::new(io::stdin())))),
    }
}
