//! The study of savings: what each rule was asked for, what was needed, and what was done.
//!
//! Counted, not timed: the renderer's own counters over seven scenes, with what the scene needs
//! counted apart from them, contactor by contactor. What the library and the engine leave out
//! stands beside them. Nothing depends on a clock or on chance, so that a later count that differs
//! is a change of the program.

mod needed;
mod scenes;
mod sinks;

use needed::Needed;
use scenes::Case;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use super::{Bench, Findings, ReportError, Row, Study, textiles};
use selvedge_foundation::geometry::Displacement;
use selvedge_render::array::Method;
use selvedge_render::scene::{ExplorationPath, LoadedScene, PathRow, PlacedTextile};
use selvedge_render::{Counters, Rule};
use selvedge_textile::surface::{Direction, N_BINS};

/// Methods whose rules are counted: what leaves out bins, and what looks powers up.
const METHODS: [Method; 2] = [Method::Banded, Method::Table];

/// What every rule is asked for, needs and does.
pub(crate) const STUDY: Study = Study {
    name: "savings",
    chapter: "savings",
    question: "What is a tick asked for, what of it does the scene need, what is done, and by \
               which rule is the rest left out?",
    reference: "What is needed, counted contactor by contactor from places and velocities alone; \
                of bins the fewest that keep 0.05 dB, known only afterwards.",
    error: ("done and not needed", ""),
    cost_of: "tick",
    run,
};

/// Work before and after a rule: what it was asked for, what is needed, what was left to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Work {
    unit: &'static str,
    asked: u64,
    /// `None` where a finer rule of the same unit follows.
    needed: Option<u64>,
    done: u64,
}

impl Work {
    /// A row of it. Where `is_least`, nothing that is not needed may be done.
    fn row(self, (floor, rule): (&str, &str), case: &str, is_least: bool) -> Row {
        let beyond = self.needed.map(|needed| self.done.abs_diff(needed) as f64);
        Row::of(floor, rule, case)
            .error(beyond)
            .promised(is_least.then_some(0.0))
            .with("counted", self.unit)
            .with("asked_for", self.asked)
            .with(
                "needed",
                self.needed.map_or_else(String::new, |n| n.to_string()),
            )
            .with("done", self.done)
            .with("left_out", self.asked - self.done)
    }
}

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let mut rows = Vec::new();
    let cases = scenes::cases(bench.effort)?;
    for (number, case) in cases.iter().enumerate() {
        bench.step(number as f64 / cases.len() as f64, case.name)?;
        let needed = Needed::of(case);
        for method in METHODS {
            rows.extend(rows_of(case, method, &needed)?);
        }
    }
    let idle = idle_rules(&rows);
    rows.push(shared_row(
        cases.iter().max_by_key(|case| case.scene.textiles.len()),
    )?);
    rows.extend(library_rows()?);
    rows.extend(sinks::rows()?);
    rows.extend(asleep_rows()?);
    let notes = Rule::ALL.map(|rule| format!("{}: {}", rule.name(), rule.what()));
    let idle = format!(
        "Rules that leave nothing out on any of these scenes: {}. They stand for what scenes at \
         their limits need, not to save.",
        idle.join(", ")
    );
    Ok(Findings::new(
        rows,
        Vec::new(),
        notes.into_iter().chain([idle]),
    ))
}

/// The rules whose rows left nothing out.
fn idle_rules(rows: &[Row]) -> Vec<&'static str> {
    let is_idle = |rule: &Rule| {
        let mut of_rule = rows.iter().filter(|row| row.setting == rule.name());
        of_rule.all(|row| row.further("left_out") == "0")
    };
    let idle = Rule::ALL.into_iter().filter(is_idle);
    idle.map(Rule::name).collect()
}

/// A row for every rule of a method on a scene.
fn rows_of(case: &Case, method: Method, needed: &Needed) -> Result<Vec<Row>, ReportError> {
    let mut renderer = textiles::prepared(&case.scene, method)?;
    for pose in &case.poses {
        renderer.tick(std::slice::from_ref(pose));
    }
    let of_bins = |rule: &Rule| matches!(rule, Rule::AboveBand | Rule::BelowFloor);
    let applies = |rule: &Rule| method == Method::Banded || !of_bins(rule);
    let row = |rule: Rule| {
        let work = work_of(rule, case, (renderer.counters(), needed));
        let is_least = match rule {
            Rule::Standing | Rule::SameAngle | Rule::Beneath => true,
            Rule::SamePoint => method == Method::Banded,
            _ => false,
        };
        work.row((method.name(), rule.name()), case.name, is_least)
    };
    Ok(Rule::ALL.into_iter().filter(applies).map(row).collect())
}

/// What a rule was asked for after those before it, and what it left to do.
fn work_of(rule: Rule, case: &Case, (counters, needed): (&Counters, &Needed)) -> Work {
    let left_out = |rule: Rule| rule.left_out(counters);
    let displays = counters.ticks;
    let moved = displays - left_out(Rule::Standing);
    let placed = moved * case.scene.textiles.len() as u64;
    let touches = (placed - left_out(Rule::OutOfReach)) * case.n_contactors() as u64;
    let off = left_out(Rule::Outside);
    let felt = 2 * counters.contactors_inside - left_out(Rule::AtRest);
    let heard = felt - left_out(Rule::TooFast);
    let bins = 2 * N_BINS as u64 * counters.directions_evaluated;
    let (asked, needed) = match rule {
        Rule::Standing => (displays, Some(needed.displays)),
        Rule::SameAngle => (moved, Some(needed.angles)),
        Rule::OutOfReach => (placed, Some(needed.textiles)),
        Rule::Covered => (touches - left_out(Rule::Beneath), Some(needed.tests)),
        Rule::Outside => (touches, None),
        Rule::Beneath => (touches - off, Some(needed.touches)),
        Rule::AtRest => (felt + left_out(Rule::AtRest), None),
        Rule::TooFast => (felt, None),
        Rule::SamePoint => (heard, Some(needed.directions)),
        Rule::SameSpeed => (heard, Some(needed.speeds)),
        Rule::AboveBand => (bins, None),
        Rule::BelowFloor => (bins - left_out(Rule::AboveBand), Some(needed.bins)),
    };
    Work {
        unit: rule.unit(),
        asked,
        needed,
        done: asked - left_out(rule),
    }
}

/// Bytes of the spectra of all textiles of a scene, of those that are different, and held.
fn shared_row(case: Option<&Case>) -> Result<Row, ReportError> {
    let case = case.ok_or_else(|| ReportError::Study("no scene".to_owned()))?;
    let held = textiles::prepared(&case.scene, Method::Reference)?.n_bytes();
    let placed = case.scene.textiles.iter();
    let spectra = placed.flat_map(|one| Direction::ALL.map(|side| one.surface.spectra(side)));
    let (mut asked, mut different) = (0, BTreeMap::new());
    for one in spectra {
        asked += one.n_bytes() as u64;
        different.insert(Arc::as_ptr(one), one.n_bytes() as u64);
    }
    let work = Work {
        unit: "bytes of spectra",
        asked,
        needed: Some(different.values().sum()),
        done: held as u64,
    };
    Ok(work.row(("scene", "shared spectra"), case.name, true))
}

/// Vertices of a cloth in a second, and those that were stepped: hanging still, and swinging.
fn asleep_rows() -> Result<[Row; 2], ReportError> {
    let row = |swings: bool| {
        let [asked, done] = crate::drape::stepped(swings)?;
        let work = Work {
            unit: "vertices stepped",
            asked,
            needed: swings.then_some(asked),
            done,
        };
        let case = if swings {
            "a cloth that swings"
        } else {
            "a cloth that hangs still"
        };
        Ok::<_, ReportError>(work.row(("cloth", "asleep"), case, swings))
    };
    Ok([row(false)?, row(true)?])
}

/// Textiles that the library knows, that a scene places and that an exploration feels, and what is
/// read of them.
fn library_rows() -> Result<[Row; 2], ReportError> {
    let loaded = LoadedScene::shipped()?;
    let all = loaded.library().ids();
    let placed: Vec<&PlacedTextile> = loaded.scene().textiles.iter().collect();
    let is_placed = |id: &&String| placed.iter().any(|placed| placed.id == **id);
    let never_placed = Work {
        unit: "textiles read",
        asked: all.len() as u64,
        needed: Some(all.iter().filter(is_placed).count() as u64),
        done: (placed.len() - loaded.unread().len()) as u64,
    };
    let text = (scenes::ALL_SIXTEEN, Path::new("all-sixteen.scene.toml"));
    let sixteen = LoadedScene::from_toml(text.0, text.1)?;
    let row_at = |(n, x_mm): (u32, f64)| PathRow {
        t_s: f64::from(n) / 40.0,
        position: sixteen.scene().textiles[0].origin_mm + Displacement::new(x_mm, 25.0),
        ..PathRow::default()
    };
    let path = ExplorationPath::new((0..).zip([20.0, 25.0, 30.0]).map(row_at).collect())?;
    let along = LoadedScene::from_text_along(text, None, &path)?;
    let n_placed = along.scene().textiles.len();
    let never_felt = Work {
        unit: "textiles read",
        asked: n_placed as u64,
        needed: Some(1),
        done: (n_placed - along.unread().len()) as u64,
    };
    Ok([
        never_placed.row(
            ("scene", "never placed"),
            "four alternatives of the library",
            true,
        ),
        never_felt.row(
            ("scene", "never felt"),
            "a stroke over one of sixteen",
            true,
        ),
    ])
}

#[cfg(test)]
mod tests;
