//! Three ways to a cloth that is felt: its picture, the surface tester's strokes, and what is
//! restored of those; against the relief of model cloths (after Allerkamp et al., section VI, who
//! say that fine cloths which are alike become falsely distinct by the second).

mod cloths;
mod felt;
mod results;
mod ways;

use crate::{Bench, Effort, Findings, ReportError, Study};
use cloths::{LIGHT, Taking, cloths};
use results::Tried;
use selvedge_textile::Lamp;
use selvedge_textile::picture::shading::Light;
use ways::Subject;

/// What is felt of model cloths by four routes.
pub(crate) const STUDY: Study = Study {
    name: "picture-route",
    chapter: "pictures",
    question: "Does a picture tell how a cloth feels as well as the surface tester does?",
    reference: "The relief of a model cloth under a wire 1 mm wide, at five places, without \
                friction or noise.",
    error: ("level error", "dB"),
    cost_of: "cloth",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let mut takings = takings(bench.effort);
    let mut findings = Findings::default();
    bench.step(0.0, "weaving and knitting")?;
    let mut all = cloths(bench.effort)?;
    // The first cloth of the first taking is timed: where times alone are asked for, it is all.
    if !bench.wants_errors() {
        takings.truncate(1);
        all.truncate(1);
    }
    for (done, taking) in takings.iter().enumerate() {
        let is_first = done == 0;
        let mut results = Vec::new();
        // Doubles are looked at once.
        for (number, cloth) in all
            .iter()
            .filter(|cloth| is_first || !cloth.is_double)
            .enumerate()
        {
            let share = (done as f64 + number as f64 / all.len() as f64) / takings.len() as f64;
            bench.step(share, &format!("{}, {}", taking.name(), cloth.name))?;
            let subject = Subject::new(cloth.clone(), taking, bench.seed)?;
            results.push(Tried::of(&subject, is_first && number == 0, bench));
        }
        results::report(&results, &taking.name(), is_first, &mut findings);
    }
    findings.notes.push(
        "The level error is the larger of both bands' at 100 mm/s. smd_error_percent and \
         spectrum_error_percent are against the same wire; the spectrum is compared by \
         amplitude alone, since neither a mean cell nor a restored profile keeps phases. \
         Heights of pictures are scaled to the SMD that the tester reads on the cloth, so a \
         picture alone tells no height. A mean cell holds the lattice's own waves alone: what \
         varies from yarn to yarn, most of what 40 Hz is made of on fine cloths at 100 mm/s \
         (waves of 2.5 mm), is averaged away; the picture without lattice keeps it. The picture \
         as it is, by evidence, is what a textile of a picture keeps: reliefs of two models \
         under many lights, weighed. What it is tuned by was chosen on these very cloths. \
         Pictures have an even albedo, one light, no shadows cast and noise of 1 % of white or \
         more: a photograph is worse."
            .to_owned(),
    );
    Ok(findings)
}

/// How pictures are taken: 12 mm at a scanner's 635 points an inch, with more or less known of the
/// light, bits and noise, the plainest first; then 6 mm at 1270.
fn takings(effort: Effort) -> Vec<Taking> {
    let plain = Taking::PLAIN;
    let off = Lamp::Known {
        light: Light {
            tilt_deg: LIGHT.tilt_deg + 15.0,
            ..LIGHT
        },
        within_deg: Lamp::WITHIN_DEG,
    };
    if effort == Effort::Quick {
        let quick = Taking {
            side_px: 160,
            ..plain
        };
        return vec![
            quick,
            Taking {
                lamp: Lamp::Unknown,
                ..quick
            },
        ];
    }
    let mut all = Vec::new();
    for lamp in [plain.lamp, off, Lamp::Unknown] {
        for (bits, noise) in [(16, 0.01), (8, 0.03)] {
            let taking = Taking {
                noise,
                bits,
                lamp,
                ..plain
            };
            all.push(taking);
        }
    }
    all.push(Taking {
        points_a_px: 1,
        ..plain
    });
    all
}
