//! `selvedge bridge certify` and its quick half, `selvedge bridge test`: a device is tried, and a
//! report says what held.

use std::path::PathBuf;
use std::time::{SystemTime, UNIX_EPOCH};

use clap::Args;

use super::output::OutFile;
use super::record::{self, RecordArgs};
use super::{CliError, array, output, play, signals, terminal};
use selvedge_device::{
    ArrayProfile, Certificate, CertificateFolder, DirectLine, Extent, SessionLog, Target, Trial,
};

/// What to certify, and where the report goes.
#[derive(Debug, Args)]
pub(super) struct CertifyArgs {
    #[command(flatten)]
    line: LineArgs,
    /// Folder of the report: certificate-UID-FIRMWARE.md and .json
    #[arg(long, value_name = "DIR")]
    out: OutFile,
}

/// What to test.
#[derive(Debug, Args)]
pub(super) struct TestArgs {
    #[command(flatten)]
    line: LineArgs,
    #[arg(long, value_name = "ARRAY", default_value = "exeter-24", help = array::HELP,
          value_parser = array::profile)]
    array: Box<ArrayProfile>,
}

/// The device, and what is recorded of it.
#[derive(Debug, Args)]
struct LineArgs {
    /// Serial port of the device
    #[arg(long, value_name = "PORT")]
    port: PathBuf,
    #[command(flatten)]
    baud: array::BaudArgs,
    #[command(flatten)]
    record: RecordArgs,
}

/// Tries everything and writes the report; passed only if all of it was.
pub(super) fn certify(args: &CertifyArgs) -> Result<(), CliError> {
    play::check_port(&args.line.port)?;
    terminal::notice(
        "take the finger off the array: for up to a minute the device is tried with faint \
         amplitudes, and with large codes at 0 V",
    );
    let certificate = args.line.tried(ArrayProfile::default(), Extent::Full)?;
    let report = CertificateFolder::new(&args.out).write(&certificate)?;
    // The workbench looks here; a system without such a place has no workbench that does.
    if let Some(folder) = selvedge_workbench::own_certificates()
        && let Err(error) = CertificateFolder::new(&folder).write(&certificate)
    {
        terminal::notice(&format!(
            "{error}; the workbench will not know of this certificate"
        ));
    }
    output::print(&format!("{certificate}\n{}\n", report.display()))?;
    args.line.judged(&certificate)
}

/// Tries the quick half.
pub(super) fn test(args: &TestArgs) -> Result<(), CliError> {
    play::check_port(&args.line.port)?;
    let certificate = args.line.tried((*args.array).clone(), Extent::Quick)?;
    if let Some(doubt) = array::certified_doubt(&args.array, &certificate) {
        terminal::notice(&doubt);
    }
    output::print(&format!("{certificate}\n"))?;
    args.line.judged(&certificate)
}

impl LineArgs {
    fn tried(&self, mut profile: ArrayProfile, extent: Extent) -> Result<Certificate, CliError> {
        self.baud.set(&mut profile);
        let stop = signals::stop_flag()?;
        let log = self.record.open()?;
        let target = Target::Port(self.port.clone());
        let feed = log.as_ref().map(|log| {
            let mut feed = log.feed(&target.name());
            record::say_what(&mut feed, &profile, &[]);
            feed
        });
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        let trial = Trial {
            extent,
            nonce: since.unwrap_or_default().subsec_nanos(),
        };
        let mut line = DirectLine::open(target, &profile, feed)?;
        let mut progress = |section: &str| terminal::notice(section);
        let certificate = Certificate::of(&mut line, trial, &stop, &mut progress);
        line.close();
        log.map_or(Ok(()), SessionLog::finish)?;
        Ok(certificate)
    }

    fn judged(&self, certificate: &Certificate) -> Result<(), CliError> {
        let Some(first) = certificate.first_trouble() else {
            return Ok(());
        };
        let what = format!(
            "{}: {first}; check power and cable, then the firmware",
            self.port.display()
        );
        Err(CliError::Failed(what))
    }
}
