//! What makes the way stimuli are shown wrong, and how to mend it.

use super::check_adaptation::check_level;
use super::needs::{need, need_within};
use super::{Design, Medium, Shown, Source, Standard, Stimulus};
use selvedge_foundation::files::Flaw;

/// Most places of a trial.
pub(super) const MOST_PLACES: usize = 9;
/// Most stimuli that are sorted at once.
pub(super) const MOST_SET: usize = 25;

type Checked = Result<(), Flaw>;

/// The first thing that is wrong with it.
pub(super) fn check_presentation(design: &Design) -> Checked {
    let presentation = &design.composition.presentation;
    let place = |key| ("presentation", 0, key);
    let n = presentation.n;
    let (bounds, of) = match presentation.shown {
        Shown::Single => (1..=1, " of a single one"),
        Shown::Pair => (2..=2, " of a pair"),
        Shown::Places => (2..=MOST_PLACES, " places"),
        Shown::Intervals => (2..=8, " intervals"),
        Shown::Set => (2..=MOST_SET, " stimuli of a set"),
    };
    need_within(place("n"), &n, bounds, of)?;
    let is_nothing_virtual = design.medium == Medium::RealCloth;
    let is_possible = presentation.reference != Standard::Virtual || !is_nothing_virtual;
    let mend = "give \"real-cloth\": nothing is virtual here";
    let what = "the reference is virtual";
    need(is_possible, place("reference"), what, mend)?;
    let are_played = design.plays_vibrations();
    let is_in_time = presentation.shown == Shown::Intervals;
    check_intervals(design)?;
    check_stylus(design)?;
    check_hanging(design)?;
    let is_felt_alone = is_in_time || presentation.shown == Shown::Single;
    let what = "vibrations do not lie at places";
    let mend = "give kind = \"intervals\" or \"single\"";
    need(!are_played || is_felt_alone, place("kind"), what, mend)?;
    let Some(masker_db) = presentation.masker_db else {
        return Ok(());
    };
    let (what, mend) = ("a masker without intervals", "take masker_db away");
    need(is_in_time, place("masker_db"), what, mend)?;
    check_level(place("masker_db"), masker_db)
}

/// A stylus is led over textiles that lie there; without one nothing is given as force.
fn check_stylus(design: &Design) -> Checked {
    let presentation = &design.composition.presentation;
    let Some(stylus) = &presentation.stylus else {
        let is_force = |one: &Stimulus| match &one.source {
            Source::Textile { variant, .. } => variant.is_force_alone,
            Source::RealCloth(_) | Source::Vibration { .. } => false,
        };
        let lone = design.stimuli.iter().find(|one| is_force(one));
        let what = format!(
            "{:?} is to be felt by force alone",
            lone.map_or("", |one| &one.id)
        );
        let mend = "add [presentation.stylus], or take force_alone away";
        return need(lone.is_none(), ("presentation", 0, "kind"), what, mend);
    };
    let place = ("presentation", 0, "stylus");
    if let Err(error) = stylus.check() {
        return Err(Flaw::described(place, &error.to_string(), "give less"));
    }
    let is_cloth = |one: &Stimulus| matches!(one.source, Source::Textile { .. });
    let is_led = presentation.shown != Shown::Intervals
        && !design.plays_vibrations()
        && design.stimuli.iter().all(is_cloth);
    let what = "a stylus feels what lies still, and textiles of a library alone";
    let mend =
        "give kind = \"single\", \"pair\", \"places\" or \"set\" of textiles, or take it away";
    need(is_led, place, what, mend)
}

/// A cloth hangs alone, and is a textile.
fn check_hanging(design: &Design) -> Checked {
    let presentation = &design.composition.presentation;
    let is_as_it_is = |one: &Stimulus| match &one.source {
        Source::Textile { variant, .. } => {
            let mut numbers = variant.numbers().into_iter();
            numbers.all(|(_, value, _)| value == 0.0)
        }
        Source::RealCloth(_) => true,
        Source::Vibration { .. } => false,
    };
    let is_alone = presentation.shown == Shown::Single
        && design.medium == Medium::Array
        && presentation.stylus.is_none()
        && design.composition.adaptation.is_none()
        && design.stimuli.iter().all(is_as_it_is);
    let what = "what hangs is one textile as it is, felt by the array";
    let mend = "give kind = \"single\", medium = \"array\", textiles without gains or turns, no \
                stylus and nothing adapted, or take hangs away";
    need(
        is_alone || !presentation.hangs,
        ("presentation", 0, "hangs"),
        what,
        mend,
    )
}

/// Intervals are of vibrations, or of textiles, which a finger takes time to feel.
fn check_intervals(design: &Design) -> Checked {
    let presentation = &design.composition.presentation;
    let place = |key| ("presentation", 0, key);
    let is_in_time = presentation.shown == Shown::Intervals;
    let has = |is_one: fn(&Source) -> bool| design.stimuli.iter().any(|one| is_one(&one.source));
    let is_on_the_table = presentation.reference == Standard::RealCloth
        || has(|source| matches!(source, Source::RealCloth(_)));
    let mend = "give textiles, vibrations, or kind = \"places\"";
    let what = "cloth on the table does not come in intervals";
    need(!is_in_time || !is_on_the_table, place("kind"), what, mend)?;
    let are_mixed =
        design.plays_vibrations() && has(|source| matches!(source, Source::Textile { .. }));
    let mend = "give stimuli of one kind, or kind = \"single\"";
    let what = "textiles and vibrations in the same intervals";
    need(!is_in_time || !are_mixed, place("kind"), what, mend)?;
    let is_of_cloth = is_in_time && !design.plays_vibrations();
    let (bounds_ms, of) = if is_of_cloth {
        (1500..=20_000, " for cloth, which is felt in movement")
    } else {
        (50..=5000, "")
    };
    let length_ms = &presentation.interval_ms;
    need_within(place("interval_ms"), length_ms, bounds_ms, of)?;
    let is_masked = presentation.masker_db.is_some();
    let mend = "take masker_db away: it lies under vibrations alone";
    let what = "a masker under cloth";
    need(!is_of_cloth || !is_masked, place("masker_db"), what, mend)
}
