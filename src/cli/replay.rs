//! `selvedge bridge replay`: what the finger got by a session log, and whether the device told the
//! truth.

use std::path::Path;

use clap::Args;

use super::bridge_show::ContactorArgs;
use super::output::{InFile, OutFile, TableOut};
use super::{CliError, output, terminal};
use selvedge_device::{ReplayedLink, ReplayedTick};
use selvedge_foundation::files::TableWriter;

/// What to replay.
#[derive(Debug, Args)]
pub(super) struct ReplayArgs {
    /// Session log
    log: InFile,
    /// One row a tick of the device; without it on standard output
    #[arg(long, value_name = "T.csv")]
    out: Option<OutFile>,
    #[command(flatten)]
    contactors: ContactorArgs,
}

/// Replays every link, writes the rows, and says what was found.
pub(super) fn run(args: &ReplayArgs) -> Result<(), CliError> {
    let contactors = args.contactors.model()?;
    let mut rows = Rows {
        out: args.out.as_deref(),
        table: None,
        n_channels: 0,
    };
    let links = ReplayedLink::of_log(&args.log, &contactors, |tick| rows.add(tick))?;
    rows.finish()?;
    let report: String = links.iter().map(ToString::to_string).collect();
    if output::named_file(args.out.as_deref()).is_some() {
        output::print(&report)?;
    } else {
        terminal::notice(report.trim_end());
    }
    let n_wrong = links.iter().filter(|link| !link.agrees()).count();
    if n_wrong == 0 {
        return Ok(());
    }
    let (log, n) = (args.log.display(), links.len());
    Err(CliError::Failed(format!(
        "{log}: in {n_wrong} of {n} links the device's numbers are not the emulator's"
    )))
}

/// The table of ticks, which has as many columns as the first tick needs.
struct Rows<'a> {
    out: Option<&'a Path>,
    table: Option<TableOut>,
    n_channels: usize,
}

impl Rows<'_> {
    fn add(&mut self, tick: &ReplayedTick) -> Result<(), CliError> {
        let n_channels = tick.codes.len();
        let table = if let Some(table) = &mut self.table {
            table
        } else {
            self.n_channels = n_channels;
            self.table.insert(open(self.out, n_channels)?)
        };
        // Of a link without frames nothing is known of a channel.
        if n_channels != self.n_channels && n_channels > 0 {
            let (link, columns) = (tick.link, self.n_channels);
            return Err(CliError::Input(format!(
                "link {link} has {n_channels} channels, the rows before {columns}; \
                 divide the log at its \"link\" lines"
            )));
        }
        write(table.rows(), tick, self.n_channels)
    }

    fn finish(self) -> Result<(), CliError> {
        match self.table {
            Some(table) => table.finish(),
            None => open(self.out, 0)?.finish(),
        }
    }
}

fn open(out: Option<&Path>, n_channels: usize) -> Result<TableOut, CliError> {
    let fixed = [
        "link",
        "tick",
        "state",
        "gain",
        "amp_sum",
        "device_state",
        "device_amp_sum",
    ];
    let of_channel = |channel| {
        let names = ["code40", "code320", "peak_um"];
        names.map(|name| format!("{name}_{channel}"))
    };
    let channels: Vec<String> = (0..n_channels).flat_map(of_channel).collect();
    let header: Vec<&str> = fixed
        .into_iter()
        .chain(channels.iter().map(String::as_str))
        .collect();
    TableOut::new(out, &header)
}

fn write<W: std::io::Write>(
    row: &mut TableWriter<W>,
    tick: &ReplayedTick,
    n_channels: usize,
) -> Result<(), CliError> {
    row.number(tick.link).number(tick.tick);
    row.text(tick.state.name()).number(tick.gain);
    row.optional(tick.amp_sum);
    let (state, amp_sum) = tick.told.unzip();
    row.optional(state).optional(amp_sum);
    for ([low, high], peak_um) in tick.codes.iter().zip(&tick.peak_um) {
        row.number(low).number(high).number(peak_um);
    }
    for _ in tick.codes.len()..n_channels {
        row.text("").text("").text("");
    }
    Ok(row.end_row()?)
}
