//! `selvedge bridge certify` and its quick half, `selvedge bridge test`: a device is tried, and a
//! report says what held.

use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use clap::Args;

use super::{CliError, array, output, play, signals, terminal};
use selvedge_device::{ArrayProfile, Certificate, CertificateFolder, Extent, Trial, certify_port};

/// What to certify, and where the report goes.
#[derive(Debug, Args)]
pub(super) struct CertifyArgs {
    /// Serial port of the device
    #[arg(long, value_name = "PORT")]
    port: PathBuf,
    /// Folder of the report: certificate-UID-FIRMWARE.md and .json
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    baud: array::BaudArgs,
}

/// What to test.
#[derive(Debug, Args)]
pub(super) struct TestArgs {
    /// Serial port of the device
    #[arg(long, value_name = "PORT")]
    port: PathBuf,
    #[arg(long, value_name = "ARRAY", default_value = "exeter-24", help = array::HELP,
          value_parser = array::profile)]
    array: Box<ArrayProfile>,
    #[command(flatten)]
    baud: array::BaudArgs,
}

/// Tries everything and writes the report; passed only if all of it was.
pub(super) fn certify(args: &CertifyArgs) -> Result<(), CliError> {
    play::check_port(&args.port)?;
    terminal::notice(
        "take the finger off the array: for up to a minute the device is tried with faint \
         amplitudes, and with large codes at 0 V",
    );
    let certificate = tried(
        &args.port,
        args.baud.rate(&ArrayProfile::default()),
        Extent::Full,
    )?;
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
    judged(&args.port, &certificate)
}

/// Tries the quick half.
pub(super) fn test(args: &TestArgs) -> Result<(), CliError> {
    play::check_port(&args.port)?;
    let certificate = tried(&args.port, args.baud.rate(&args.array), Extent::Quick)?;
    if let Some(doubt) = array::certified_doubt(&args.array, &certificate) {
        terminal::notice(&doubt);
    }
    output::print(&format!("{certificate}\n"))?;
    judged(&args.port, &certificate)
}

fn tried(port: &Path, baud: u32, extent: Extent) -> Result<Certificate, CliError> {
    let stop = signals::stop_flag()?;
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    let trial = Trial {
        extent,
        nonce: since.unwrap_or_default().subsec_nanos(),
    };
    let mut progress = |section: &str| terminal::notice(section);
    Ok(certify_port((port, baud), trial, &stop, &mut progress)?)
}

fn judged(port: &Path, certificate: &Certificate) -> Result<(), CliError> {
    let Some(first) = certificate.first_trouble() else {
        return Ok(());
    };
    let what = format!(
        "{}: {first}; check power and cable, then the firmware",
        port.display()
    );
    Err(CliError::Failed(what))
}
