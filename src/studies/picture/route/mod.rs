//! Three ways to a cloth that is felt: its picture, the surface tester's strokes, and what is
//! restored of those; against the relief of model cloths (after Allerkamp et al., section VI, who
//! say that fine cloths which are alike become falsely distinct by the second).

mod cloths;
mod felt;
mod plots;
mod results;
mod taking;
mod ways;

use crate::{Bench, Findings, ReportError, Study};
use cloths::{Kin, recipes};
use plots::plots;
use results::{Tried, report};
use taking::takings;
use ways::{Known, Subject};

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
    let mut all = recipes(bench.effort)?;
    // The first picture of the first cloth is timed: where times alone are asked for, it is all.
    if !bench.wants_errors() {
        all.truncate(1);
    }
    let mut results = Vec::new();
    let mut n_single = 0;
    for (done, recipe) in all.iter().enumerate() {
        let share = done as f64 / all.len() as f64;
        bench.step(share, &format!("weaving or knitting {}", recipe.name))?;
        let known = Known::of(recipe.cloth(bench.effort)?, bench.seed)?;
        let mut takings = takings(n_single, bench.effort);
        // Doubles are looked at once.
        let is_single = recipe.kin != Kin::Double;
        n_single += usize::from(is_single);
        if !is_single || !bench.wants_errors() {
            takings.truncate(1);
        }
        for (nth, taking) in takings.into_iter().enumerate() {
            bench.step(share, &recipe.name)?;
            let subject = Subject::new(&known, taking, bench.seed).ok_or(ReportError::Cancelled)?;
            let is_timed = results.is_empty();
            results.push(Tried::of(&subject, [nth == 0, is_timed], bench));
        }
    }
    let (rows, mut notes) = report(&results, bench.effort);
    notes.extend(NOTES.map(str::to_owned));
    Ok(Findings::new(rows, plots(&results), notes))
}

/// What a reader should know.
const NOTES: [&str; 3] = [
    "Twelve cloths are those that the methods were tuned on, twelve are fresh: of the models of \
     the seventy-four that the shipped library has not, every third. Each is taken once in the \
     plainest way (25 px/mm, light known, 16 bits, noise 1 %, flat) and, under a light that is \
     known, told 15° wrong and unknown, by two of four cameras: half of all ways by bits (16, 8), \
     noise (1, 3 %) and bend (flat; in waves of 8 % local stretch), chosen so that any two of \
     these meet at every level. Not every way is taken of every cloth.",
    "The level error is the larger of both bands' at 100 mm/s. smd_error_percent and \
     spectrum_error_percent are against the same wire; the spectrum is compared by amplitude \
     alone, since neither a mean cell nor a restored profile keeps phases. Heights of pictures \
     are scaled to the SMD that the tester reads on the cloth, so a picture alone tells no \
     height. A mean cell holds the lattice's own waves alone: what varies from yarn to yarn, \
     most of what 40 Hz is made of on fine cloths at 100 mm/s (waves of 2.5 mm), is averaged \
     away; the picture as it is keeps it. By evidence is what a textile of a picture keeps: \
     reliefs of two models under many lights, weighed.",
    "Pictures have an even albedo, one light and no shadows cast: a photograph is worse.",
];
