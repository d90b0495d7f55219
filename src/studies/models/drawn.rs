//! Model cloths: what the distance of the points on which their yarns are drawn costs in level.

use crate::{Bench, Findings, ReportError, Row, Study, textiles};
use selvedge_foundation::numerics::Random;
use selvedge_foundation::quantity::level_db;
use selvedge_textile::Library;
use selvedge_textile::surface::{HeightMap, Probe, Surface};
use selvedge_textile::tactile::{Filters, Levels};

/// Fine, coarse, ridged by their twist, and knitted; and how near levels are where yarns are drawn
/// as models of the library are, dB. Fine threads are wide for a wire 0.02 mm from point to point.
const CLOTHS: [(&str, f64); 4] = [
    ("polyamide-taffeta", 0.75),
    ("jute-plain", 0.2),
    ("silk-crepe", 0.65),
    ("polyamide-jersey", 0.25),
];
/// The distance at which models of the library are drawn, mm: levels there are promised.
const OWN_MM: f64 = 0.02;

/// Error of both levels by the distance of a relief's points, and what drawing costs.
pub(crate) const STUDY: Study = Study {
    name: "model-relief",
    chapter: "surfaces",
    question: "How finely must the yarns of a model cloth be drawn for its levels?",
    reference: "The same yarns on the finest points: half or a quarter of the distance at which \
                models are drawn.",
    error: ("level error", "dB"),
    cost_of: "mm² of cloth",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let library = Library::shipped()?;
    let cloths = &CLOTHS[..bench.effort.pick(1, CLOTHS.len())];
    let finest_mm = bench.effort.pick(0.5, 0.25) * OWN_MM;
    let mut rows = Vec::new();
    for (done, (id, promised_db)) in cloths.iter().enumerate() {
        bench.step(done as f64 / cloths.len() as f64, id)?;
        let source = library.manifest(id)?.source;
        let truth = if bench.wants_errors() {
            Some(levels_db(
                &textiles::known(id, source.relief(finest_mm))?,
                id,
            )?)
        } else {
            None
        };
        for step_mm in [0.16, 0.08, 0.04, OWN_MM] {
            let map = textiles::known(id, source.relief(step_mm))?;
            let cost = bench
                .time(1, || source.relief(step_mm))
                .times(1.0 / sq_mm(&map));
            let mut row = Row::of("yarns on points", format!("{step_mm} mm"), *id).cost(cost);
            if let Some(truth) = truth {
                let found = levels_db(&map, id)?;
                let off_db = [0, 1].map(|band| found[band] - truth[band]);
                row = row
                    .error(off_db[0].abs().max(off_db[1].abs()))
                    .promised((step_mm <= OWN_MM).then_some(*promised_db))
                    .number("off_40_hz_db", 3, off_db[0])
                    .number("off_320_hz_db", 3, off_db[1]);
            }
            rows.push(row);
        }
    }
    let notes = [
        format!(
            "Levels at 100 mm/s of the tester's wire without noise. A model of the library is \
             drawn on points {OWN_MM} mm apart, which is promised cloth by cloth; what is only \
             looked at is drawn more coarsely."
        ),
        "Where filaments are hardly wider than that distance, the error of 320 Hz falls with the \
         distance itself, not with its square: yarns meet in cusps, which points cut off. Against \
         yarns without points it is about a third more than against the finest points here."
            .to_owned(),
    ];
    Ok(Findings::new(rows, Vec::new(), notes))
}

fn sq_mm(map: &HeightMap) -> f64 {
    map.size_mm().iter().product()
}

/// Levels of both bands under the tester's wire, dB re 1 µm.
fn levels_db(map: &HeightMap, id: &str) -> Result<[f64; 2], ReportError> {
    let failed = textiles::wrong(id);
    let middle_mm = map.size_mm().map(|mm| 0.5 * mm);
    let profiles = map.strokes(&Probe::ideal(), middle_mm, &Random::new(1));
    let surface = profiles.and_then(|profiles| Surface::from_profiles(profiles, 0.0));
    let surface = surface.map_err(|(_, error)| failed(error))?;
    Ok(Levels::of(&surface, &Filters::default())
        .mean_um
        .map(level_db))
}
