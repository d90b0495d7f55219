//! The files of a study: table, plots as SVG and PNG. Each appears when it is whole.

use std::path::Path;

use super::chart::error_against_time;
use super::columns::csv_of;
use super::{Findings, ReportError, Study};
use selvedge_chart::Plot;
use selvedge_foundation::files::{encode_png_rgba, write_atomic};

/// Pixels across a PNG.
const PNG_WIDTH: u32 = 1720;

/// Writes `NAME.csv`, `NAME.svg`, `NAME.png` and the further plots of a study.
pub(super) fn findings(
    study: &dyn Study,
    findings: &Findings,
    out: &Path,
) -> Result<(), ReportError> {
    let name = format!("{}.csv", study.name());
    text(&name, out, &csv_of(study, findings, &out.join(&name))?)?;
    for (name, plot) in plots(study, findings) {
        text(&format!("{name}.svg"), out, &plot.to_svg())?;
        let path = out.join(format!("{name}.png"));
        let pixels = plot.to_pixels(PNG_WIDTH)?;
        let png = encode_png_rgba(&pixels.rgba, pixels.width, pixels.height, &path)?;
        write_atomic(&path, &png)?;
    }
    Ok(())
}

/// Every plot of a study with the name of its files: error against run time first.
pub(super) fn plots(study: &dyn Study, findings: &Findings) -> Vec<(String, Plot)> {
    let first = error_against_time(study, findings).map(|plot| (study.name().to_owned(), plot));
    let further = findings.plots.iter().map(|(name, plot)| {
        let begins_with_study = name.starts_with(study.name());
        let name = if begins_with_study && name != study.name() {
            name.clone()
        } else {
            format!("{}-{name}", study.name())
        };
        (name, plot.clone())
    });
    first.into_iter().chain(further).collect()
}

/// Writes a text file of the report.
pub(super) fn text(name: &str, out: &Path, text: &str) -> Result<(), ReportError> {
    Ok(write_atomic(&out.join(name), text.as_bytes())?)
}
