//! The study of readers: what reading measured heights costs by format and size, and how exactly
//! they come back.

use std::path::Path;

use super::chart::{chart, lines_by};
use super::{Bench, Findings, ReportError, Row, Study};
use selvedge_chart::Axis;
use selvedge_foundation::files::Number;
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_textile::LengthUnit;
use selvedge_textile::metrology::{About, Coding, HeightOptions, Measured, write, write_x3p};

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

/// Distance of the points, mm.
const STEP_MM: f64 = 0.01;

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
    /// What a reader is told that the file does not say.
    fn asked(self) -> HeightOptions {
        let is_bare = self.ending == "npy";
        HeightOptions {
            height_unit: is_bare.then_some(LengthUnit::Micrometre),
            step_mm: is_bare.then_some(STEP_MM),
            ..HeightOptions::default()
        }
    }

    fn bytes(self, map: &Measured) -> Result<Vec<u8>, ReportError> {
        let path = Path::new("map").with_extension(self.ending);
        Ok(match self.x3p {
            Some(coding) => write_x3p(map, coding, &path)?,
            None => write(map, &path)?,
        })
    }
}

/// Reading time and error of Sq over formats and sizes.
pub(crate) const STUDY: Study = Study {
    name: "readers",
    chapter: "surfaces",
    question: "What does reading measured heights cost, and how exactly does their roughness \
               come back?",
    reference: "Sq of the map that was written.",
    error: ("error of Sq", "of Sq"),
    cost_of: "point read",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let sides = bench.effort.pick(&[64, 256][..], &[64, 256, 1024][..]);
    let mut rows = Vec::new();
    for (done, &side) in sides.iter().enumerate() {
        bench.step(done as f64 / sides.len() as f64, "reading")?;
        let map = map(side, bench.seed)?;
        for written in WRITTEN {
            rows.push(row(bench, written, &map)?);
        }
    }
    let whole = |row: &Row| Some([row.size?, row.cost?.cpu_s * row.size?]);
    let plot = chart(
        "Reading measured heights",
        Axis::log("points"),
        Axis::log("CPU time, s"),
        lines_by(&rows, |row| &row.method, whole),
        "",
    );
    let note = "Maps are rough with a ripple; every file was written by this program, and read \
                with its checksums and sizes checked.";
    let plots = vec![("readers-time".to_owned(), plot)];
    Ok(Findings::new(rows, plots, [note]))
}

fn row(bench: &mut Bench<'_>, written: Written, map: &Measured) -> Result<Row, ReportError> {
    let bytes = written.bytes(map)?;
    let path = Path::new("map");
    let asked = written.asked();
    let read = Measured::open(&bytes, path, &asked)?;
    let n_points = map.heights_um.values().len();
    let cost = bench.time(n_points, || {
        Measured::open(&bytes, path, &asked).map(|read| read.n_missing())
    });
    let side = map.heights_um.width();
    Ok(Row::of(written.name, "", format!("{side} × {side}"))
        .size(n_points as f64)
        .error((read.sq_um() / map.sq_um() - 1.0).abs())
        .promised(written.promised)
        .cost(cost)
        .with("file_bytes", bytes.len()))
}

/// A rough map with a ripple, 10 µm steps.
fn map(side: usize, seed: u64) -> Result<Measured, ReportError> {
    let mut random = Random::new(seed).branch("readers");
    let height = |i: usize| 5.0 * ((i % side) as f64 * 0.2).sin() + random.normal();
    let heights = (0..side * side).map(height).collect();
    let heights_um = Grid::from_rows(side, heights);
    Ok(Measured {
        heights_um: heights_um.ok_or_else(|| ReportError::Study("an empty map".to_owned()))?,
        step_mm: [STEP_MM; 2],
        about: About::default(),
        warnings: Vec::new(),
        layers: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_format_keeps_the_sq_it_promises() {
        let map = map(64, 1).unwrap();
        for written in WRITTEN {
            let bytes = written.bytes(&map).unwrap();
            let read = Measured::open(&bytes, Path::new("map"), &written.asked()).unwrap();
            let off = (read.sq_um() / map.sq_um() - 1.0).abs();
            assert!(off <= written.promised, "{}: {off:e}", written.name);
        }
    }
}
