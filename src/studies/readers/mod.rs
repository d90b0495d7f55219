//! The study of readers: what reading measured heights costs by format and size, and how exactly
//! they come back.

use std::path::Path;

use super::{Bench, Findings, ReportError, Row, Study};
use selvedge_chart::{Axis, Chart, Series, Style};
use selvedge_foundation::files::Number;
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_textile::LengthUnit;
use selvedge_textile::metrology::{About, Coding, HeightOptions, Measured, open, write, write_x3p};

/// Reading time and error of Sq over formats and sizes.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ReadersStudy;

/// A format, and how exactly Sq comes back from it.
#[derive(Debug, Clone, Copy)]
struct Written {
    name: &'static str,
    /// The ending of the file; X3P in another coding has one too.
    ending: &'static str,
    x3p: Option<Coding>,
    /// Relative error of Sq that the number type allows.
    promised: f64,
}

const fn x3p(name: &'static str, number: Number, is_list: bool, promised: f64) -> Written {
    let x3p = Some(Coding { number, is_list });
    Written {
        name,
        ending: "x3p",
        x3p,
        promised,
    }
}

const fn plain(name: &'static str, ending: &'static str, promised: f64) -> Written {
    Written {
        name,
        ending,
        x3p: None,
        promised,
    }
}

/// Steps of 16 bits are 1/65535 of the relief, rounding errors of points cancel in Sq.
const WRITTEN: [Written; 8] = [
    x3p("X3P float64", Number::F64, false, 1e-12),
    x3p("X3P float32", Number::F32, false, 1e-6),
    x3p("X3P int16", Number::I16, false, 1e-4),
    x3p("X3P list", Number::F64, true, 1e-12),
    plain("GSF", "gsf", 1e-6),
    plain("NPY", "npy", 1e-12),
    plain("PNG 16 bits", "png", 1e-4),
    plain("TIFF 16 bits", "tif", 1e-4),
];

impl Written {
    fn bytes(self, map: &Measured) -> Result<Vec<u8>, ReportError> {
        let path = Path::new("map").with_extension(self.ending);
        Ok(match self.x3p {
            Some(coding) => write_x3p(map, coding, &path)?,
            None => write(map, &path)?,
        })
    }
}

impl Study for ReadersStudy {
    fn name(&self) -> &'static str {
        "readers"
    }

    fn question(&self) -> &'static str {
        "What does reading measured heights cost, and how exactly does their roughness come back?"
    }

    fn reference(&self) -> &'static str {
        "Sq of the map that was written."
    }

    fn error_measure(&self) -> (&'static str, &'static str) {
        ("error of Sq", "of Sq")
    }

    fn cost_of(&self) -> &'static str {
        "point read"
    }

    fn run(&self, bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
        let sides = bench.effort.pick(vec![64, 256], vec![64, 256, 1024]);
        let mut findings = Findings::default();
        let mut lines: Vec<Vec<[f64; 2]>> = vec![Vec::new(); WRITTEN.len()];
        for (done, &side) in sides.iter().enumerate() {
            bench.step(done as f64 / sides.len() as f64, "reading")?;
            let map = map(side, bench.seed)?;
            for (written, line) in WRITTEN.iter().zip(&mut lines) {
                let row = row(bench, *written, &map)?;
                let n_points = (side * side) as f64;
                line.extend(row.cost.map(|cost| [n_points, cost.cpu_s * n_points]));
                findings.rows.push(row);
            }
        }
        findings
            .plots
            .push(("readers-time".to_owned(), plot(lines)));
        findings.notes.push(
            "Maps are rough with a ripple; every file was written by this program, and read with \
             its checksums and sizes checked."
                .to_owned(),
        );
        Ok(findings)
    }
}

fn row(bench: &mut Bench<'_>, written: Written, map: &Measured) -> Result<Row, ReportError> {
    let bytes = written.bytes(map)?;
    let path = Path::new("map");
    let asked = HeightOptions {
        height_unit: (written.ending == "npy").then_some(LengthUnit::Micrometre),
        step_mm: (written.ending == "npy").then_some(map.step_mm[0]),
        ..HeightOptions::default()
    };
    let read = open(&bytes, path, &asked)?;
    let n_points = map.heights_um.values().len();
    let cost = bench.time(n_points, || {
        open(&bytes, path, &asked).map(|read| read.n_missing())
    });
    let side = map.heights_um.width();
    let n_bytes = bytes.len();
    Ok(Row {
        method: written.name.to_owned(),
        case: format!("{side} × {side}"),
        size: Some(n_points as f64),
        error: Some((read.sq_um() / map.sq_um() - 1.0).abs()),
        promised: Some(written.promised),
        cost: Some(cost),
        more: vec![("file_bytes", n_bytes.to_string())],
        ..Row::default()
    })
}

/// A rough map with a ripple, 10 µm steps.
fn map(side: usize, seed: u64) -> Result<Measured, ReportError> {
    let mut random = Random::new(seed).branch("readers");
    let height = |i: usize| 5.0 * ((i % side) as f64 * 0.2).sin() + random.normal();
    let heights = (0..side * side).map(height).collect();
    let heights_um = Grid::from_rows(side, heights);
    Ok(Measured {
        heights_um: heights_um.ok_or_else(|| ReportError::Study("an empty map".to_owned()))?,
        step_mm: [0.01; 2],
        about: About::default(),
        warnings: Vec::new(),
        layers: Vec::new(),
    })
}

fn plot(lines: Vec<Vec<[f64; 2]>>) -> Chart {
    let series = WRITTEN.iter().zip(lines).map(|(written, points)| Series {
        name: written.name.to_owned(),
        points,
        style: Style::LineAndDots,
        ..Series::default()
    });
    Chart {
        title: "Reading measured heights".to_owned(),
        x: Axis::log("points"),
        y: Axis::log("CPU time, s"),
        series: series.collect(),
        ..Chart::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_format_keeps_the_sq_it_promises() {
        let map = map(64, 1).unwrap();
        for written in WRITTEN {
            let bytes = written.bytes(&map).unwrap();
            let asked = HeightOptions {
                height_unit: Some(LengthUnit::Micrometre).filter(|_| written.ending == "npy"),
                step_mm: Some(0.01).filter(|_| written.ending == "npy"),
                ..HeightOptions::default()
            };
            let read = open(&bytes, Path::new("map"), &asked).unwrap();
            let off = (read.sq_um() / map.sq_um() - 1.0).abs();
            assert!(off <= written.promised, "{}: {off:e}", written.name);
        }
    }
}
