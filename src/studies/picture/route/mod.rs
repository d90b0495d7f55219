//! Three ways to a cloth that is felt: its picture, the surface tester's strokes, and what is
//! restored of those; against the relief of model cloths (after Allerkamp et al., section VI, who
//! say that fine cloths which are alike become falsely distinct by the second).

mod cloths;
mod felt;
mod results;
mod ways;

use crate::{Bench, Findings, ReportError, Study};
use cloths::cloths;
use results::Tried;
use ways::Subject;

/// What is felt of model cloths by four routes.
pub(crate) const STUDY: Study = Study {
    name: "picture-route",
    question: "Does a picture tell how a cloth feels as well as the surface tester does?",
    reference: "The relief of a model cloth under a wire 1 mm wide, at five places, without \
                friction or noise.",
    error: ("level error", "dB"),
    cost_of: "cloth",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    // 20 mm at a scanner's 635 points an inch, and 10 mm at 1270.
    let pictures = bench.effort.pick(vec![[240, 2]], vec![[500, 2], [500, 1]]);
    let mut findings = Findings::default();
    for (done, picture) in pictures.iter().enumerate() {
        bench.step(done as f64 / pictures.len() as f64, "weaving and knitting")?;
        let mut results = Vec::new();
        let all = cloths(bench.effort)?;
        let n = all.len() as f64;
        for (number, cloth) in all.into_iter().enumerate() {
            let share = (done as f64 + number as f64 / n) / pictures.len() as f64;
            bench.step(share, &cloth.name)?;
            let is_timed = number == 0;
            let subject = Subject::new(cloth, *picture, bench.seed)?;
            results.push(Tried::of(&subject, is_timed, bench));
        }
        results::report(&results, setting(*picture), done == 0, &mut findings);
    }
    findings.notes.push(
        "The level error is the larger of both bands' at 100 mm/s. smd_error_percent and \
         spectrum_error_percent are against the same wire; the spectrum is compared by \
         amplitude alone, since neither a mean cell nor a restored profile keeps phases. \
         Heights of pictures are scaled to the SMD that the tester reads on the cloth, so a \
         picture alone tells no height. A mean cell holds the lattice's own waves alone: what \
         varies from yarn to yarn, most of what 40 Hz is made of on fine cloths at 100 mm/s \
         (waves of 2.5 mm), is averaged away; the picture without lattice keeps it. Pictures \
         have an even albedo, one light, no shadows \
         cast and noise of 1 % of white: a photograph is worse."
            .to_owned(),
    );
    Ok(findings)
}

/// How a picture was taken, in words.
fn setting([_, points_a_px]: [usize; 2]) -> &'static str {
    if points_a_px == 1 {
        "50 px/mm"
    } else {
        "25 px/mm"
    }
}
