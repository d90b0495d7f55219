//! Adjustment: what parameters were left at, by stimulus and by where they began; gains matched to
//! real cloth, and the compression that follows from them (Philpott & Summers 2012, § 3.1).

use std::collections::BTreeMap;

use super::draw::{Bar, bars, scatter};
use super::included_trials::{Experiment, Subject};
use super::model::{Cell, Drawn, Section, Table, cells, or_undefined};
use super::options::Options;
use super::properties::Measures;
use super::tables::tests;
use super::variance::{complete_rows, effects, every_two};
use crate::AnswerValue;
use crate::design::{Standard, Tunable, TunedParameter};
use selvedge_chart::{Axis, Series, Style};
use selvedge_foundation::numerics::LineFit;
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_foundation::quantity::{factor_of_gain, fixed};
use selvedge_statistics::psychometric::{Adjustments, Settings, Starts};
use selvedge_statistics::variance::{Answer as CellAnswer, Crossed, Repeated, friedman};
use selvedge_statistics::{
    Computed, Interval, Outcome, Summary, Undefined, mean, one_sample_t, paired_t, t_quantile_upper,
};

/// A setting of one parameter.
#[derive(Clone, Copy)]
struct Setting<'a> {
    subject: &'a str,
    item: usize,
    start: f64,
    value: f64,
}

fn settings<'a>(experiment: &Experiment<'a>, nth: usize) -> Vec<Setting<'a>> {
    let mut all = Vec::new();
    for subject in &experiment.subjects {
        for record in subject.trials() {
            let task = &record.trial.task;
            if let Some(AnswerValue::Adjusted { values, .. }) = record.value()
                && let (Some(item), Some(start)) = (task.item(), task.starts.get(nth))
                && let Some(value) = values.get(nth)
            {
                all.push(Setting {
                    subject: subject.name,
                    item,
                    start: *start,
                    value: *value,
                });
            }
        }
    }
    all
}

pub(super) fn sections(
    experiment: &Experiment<'_>,
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<Vec<Section>, Cancelled> {
    let mut sections = Vec::new();
    let reference = experiment.design.composition.presentation.reference;
    for (nth, parameter) in experiment
        .design
        .composition
        .parameters()
        .iter()
        .enumerate()
    {
        let all = settings(experiment, nth);
        sections.push(parameter_section(experiment, parameter, &all));
        let is_matching = parameter.what == Tunable::Gain && reference == Standard::RealCloth;
        if is_matching {
            let measures = Measures::of(experiment, options, progress)?;
            sections.push(compression(experiment, &all, &measures));
        }
    }
    Ok(sections)
}

const STIMULI: &str = "item: stimulus; n: settings; mean; sd; se: SE; ascending_n: from below; \
    ascending_mean: mean; descending_n: from above; descending_mean: mean; difference: from below \
    less from above; difference_p: p (Welch); geometric_mean: geometric mean; log_sd: sd of \
    logarithms; subjects; ci_low: 95 % CI of the mean over subjects from; ci_high: to";

fn parameter_section(
    experiment: &Experiment<'_>,
    parameter: &TunedParameter,
    all: &[Setting<'_>],
) -> Section {
    let key = parameter.what.name();
    let title = format!("{}: settings of {key}", experiment.design.title);
    let mut section = Section::new(experiment.key(&super::model::file_name(key, '-')), title);
    section.note(
        "All settings of all subjects; sd with n − 1. From below: begun in the lower half \
         of the range; from above: in the upper half. Logarithms where every setting is above 0.",
    );
    let names = experiment.ids();
    let mut table = Table::new(
        "stimuli",
        &format!("Settings of {key} by stimulus"),
        STIMULI,
    );
    let mut shown = Vec::new();
    let middle = 0.5 * (parameter.from + parameter.to);
    for (item, name) in names.iter().enumerate() {
        let own: Vec<&Setting<'_>> = all.iter().filter(|s| s.item == item).collect();
        let means = means_of_subjects(&own);
        table.push(stimulus_row(name, (&own, &means), middle));
        shown.extend(Bar::mean(
            name,
            &experiment.design.stimuli[item].group,
            &means,
        ));
    }
    section.table(table);
    let title = format!(
        "{}: {key}, mean over subjects (95 % interval)",
        experiment.design.title
    );
    section.figure(bars("bars", &title, key, (&shown, None), &[]));
    let crossed = by_subject(all, &names);
    let (rows, pairs) = (complete_rows(&crossed), every_two("pairs", &crossed));
    let variance = crossed.and_then(|table| Repeated::one_way(&table));
    section.table(effects("anova", "Stimuli, within subjects", &variance));
    section.table(pairs);
    let hysteresis = start_effect(experiment, all, middle)
        .and_then(|d| Summary::of(&d))
        .and_then(|s| one_sample_t(&s, 0.0));
    let mut found = vec![
        ("stimuli".to_owned(), rows.and_then(|rows| friedman(&rows))),
        (
            "begun high less begun low, subject by subject".to_owned(),
            hysteresis,
        ),
    ];
    found.extend(by_group(experiment, key, all, &mut section));
    section.table(tests("tests", "Stimuli, and where it began", &found));
    section
}

/// Each group of stimuli by itself, and every two of them subject by subject.
fn by_group(
    experiment: &Experiment<'_>,
    key: &str,
    all: &[Setting<'_>],
    section: &mut Section,
) -> Vec<(String, Computed<Outcome>)> {
    let (names, groups) = (experiment.ids(), experiment.groups());
    let mut means: Vec<(&String, Vec<f64>)> = Vec::new();
    for group in &groups {
        let is_own = |one: &&Setting<'_>| experiment.design.stimuli[one.item].is_of(Some(group));
        let own: Vec<Setting<'_>> = all.iter().filter(is_own).copied().collect();
        let variance = by_subject(&own, &names).and_then(|table| Repeated::one_way(&table));
        let key = super::model::file_name(&format!("anova-{group}"), '-');
        section.table(effects(
            &key,
            &format!("Stimuli, within subjects: {group}"),
            &variance,
        ));
        means.push((group, means_of_subjects(&own.iter().collect::<Vec<_>>())));
    }
    let mut found = Vec::new();
    for (nth, (a, first)) in means.iter().enumerate() {
        for (b, second) in &means[nth + 1..] {
            let outcome = if first.len() == second.len() {
                paired_t(first, second)
            } else {
                Err(Undefined::because("a subject lacks one of the groups"))
            };
            found.push((format!("{a} less {b}, {key}"), outcome));
        }
    }
    found
}

/// The mean setting of every subject.
fn means_of_subjects(own: &[&Setting<'_>]) -> Vec<f64> {
    let mut of: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for setting in own {
        of.entry(setting.subject).or_default().push(setting.value);
    }
    of.values().filter_map(|values| mean(values).ok()).collect()
}

fn stimulus_row(name: &str, (own, means): (&[&Setting<'_>], &[f64]), middle: f64) -> Vec<Cell> {
    let part = |is_low: bool| -> Vec<f64> {
        let from = own.iter().filter(|s| (s.start < middle) == is_low);
        from.map(|s| s.value).collect()
    };
    let (ascending, descending) = (part(true), part(false));
    let starts = Starts {
        ascending: &ascending,
        descending: &descending,
    };
    let linear = Adjustments::of(starts, Settings::Linear);
    let log = Adjustments::of(starts, Settings::Log);
    let spread = linear
        .as_ref()
        .map(|a| cells![a.all.mean, a.all.sd, a.all.se]);
    let difference = linear
        .as_ref()
        .map_err(Clone::clone)
        .and_then(|a| a.difference.clone());
    let estimate = difference.clone().and_then(|d| d.estimate).map(|e| e.value);
    cells![
        name,
        own.len(),
        or_undefined(spread, 3),
        [&ascending, &descending].map(|values| cells![values.len(), mean(values)]),
        estimate,
        difference.map(|d| d.p),
        log.as_ref().map(|a| a.centre),
        log.as_ref().map(|a| a.all.sd),
        means.len(),
        Summary::of(means).and_then(|summary| summary.interval(0.95)),
    ]
}

/// Subjects by stimuli, means of repeats.
/// Settings crossed, stimuli in the order of the design whatever the order of the trials.
fn by_subject(all: &[Setting<'_>], names: &[String]) -> Computed<Crossed> {
    let answer = |s: &Setting<'_>| CellAnswer {
        subject: s.subject.to_owned(),
        levels: vec![names[s.item].clone()],
        value: s.value,
    };
    let mut in_order: Vec<&Setting<'_>> = all.iter().collect();
    in_order.sort_by_key(|setting| setting.item);
    let answers: Vec<CellAnswer> = in_order.into_iter().map(answer).collect();
    Crossed::of_answers(&["stimulus"], &answers)
}

/// What subjects set when it began high less when it began low.
fn start_effect(
    experiment: &Experiment<'_>,
    all: &[Setting<'_>],
    middle: f64,
) -> Computed<Vec<f64>> {
    let mean_of = |name: &str, is_low: bool| {
        let own = all
            .iter()
            .filter(|s| s.subject == name && (s.start < middle) == is_low);
        mean(&own.map(|s| s.value).collect::<Vec<f64>>())
    };
    let of =
        |subject: &Subject<'_>| Ok(mean_of(subject.name, false)? - mean_of(subject.name, true)?);
    experiment.subjects.iter().map(of).collect()
}

/// The slope of matched gain on level with its interval by Student's t.
pub(super) fn slope(points: &[[f64; 2]]) -> Computed<(LineFit, Interval)> {
    let line = LineFit::through(points)
        .ok_or_else(|| Undefined::because("the levels of the stimuli do not differ"))?;
    let df = points.len() as f64 - 2.0;
    let t = t_quantile_upper(0.025, df)
        .map_err(|_none| Undefined::because("two stimuli leave no scatter about a line"))?;
    let half = t * line.slope_error;
    let interval = Interval::new([line.slope - half, line.slope + half], 0.95);
    Ok((line, interval))
}

/// The compression that the matched gains amount to: gain = offset − κ (level − reference).
fn compression(experiment: &Experiment<'_>, all: &[Setting<'_>], measures: &Measures) -> Section {
    let mut section = experiment.section("compression", "compression from matched gains");
    section.note(
        "Matched gain over the textile's level, of both bands at 100 mm/s: a line of slope \
         −κ is what a compression κ makes. κ is fitted to the means over subjects, and to each \
         subject's own; the interval of the group is Student's t over subjects.",
    );
    let Some(level) = measures.named("level_db") else {
        section.notes.extend(measures.notes.iter().cloned());
        section.note("**No compression**: the levels of the textiles are not known.");
        return section;
    };
    if let Some(tuning) = experiment.design.tuning.filter(|t| t.compression > 0.0) {
        section.note(format!(
            "The design's own compression of {} was in force: κ is what is asked for besides.",
            tuning.compression
        ));
    }
    let means = |name: Option<&str>| -> Vec<[f64; 2]> {
        let of = |(item, level): (usize, &f64)| {
            let own = all
                .iter()
                .filter(|s| s.item == item && name.is_none_or(|n| s.subject == n));
            let mean = mean(&own.map(|s| s.value).collect::<Vec<f64>>());
            Some([*level, mean.ok()?])
        };
        level.values.iter().enumerate().filter_map(of).collect()
    };
    let (table, kappas) = kappas(experiment, &means);
    section.table(table);
    let t = Summary::of(&kappas).and_then(|s| one_sample_t(&s, 0.0));
    section.table(tests("tests", "κ over subjects against none", &[("κ", t)]));
    section.figure(gain_plot(experiment, &means(None)));
    section
}

/// κ of every subject and of the means over them; those of the subjects alone.
fn kappas(
    experiment: &Experiment<'_>,
    means: &dyn Fn(Option<&str>) -> Vec<[f64; 2]>,
) -> (Table, Vec<f64>) {
    let columns = "subject; n: stimuli; kappa: κ; ci_low: 95 % CI from; ci_high: to; \
        gain_at_0_db: gain at 0 dB re 1 µm, dB; amplitude_factor_at_0_db: as a factor";
    let mut table = Table::new("kappa", "Compression", columns);
    let mut kappas = Vec::new();
    let names = experiment.subjects.iter().map(|s| Some(s.name));
    for name in names.chain([None]) {
        let points = means(name);
        let found = slope(&points);
        if let (Ok((line, _)), Some(_)) = (&found, name) {
            kappas.push(-line.slope);
        }
        let found = found.map(|(line, interval)| {
            let kappa = [-line.slope, -interval.high, -interval.low];
            cells![kappa, line.offset, factor_of_gain(line.offset)]
        });
        let name = name.unwrap_or("means over subjects");
        table.push(cells![name, points.len(), or_undefined(found, 5)]);
    }
    (table, kappas)
}

fn gain_plot(experiment: &Experiment<'_>, points: &[[f64; 2]]) -> Drawn {
    let means = points.iter().copied();
    let mut all = vec![Series::of("mean over subjects", Style::Dots, means)];
    if let Ok((line, _)) = slope(points) {
        let x = points.iter().map(|p| p[0]);
        let low = x.clone().fold(f64::INFINITY, f64::min);
        let high = x.fold(f64::NEG_INFINITY, f64::max);
        let ends = [low, high].map(|x| [x, line.offset + line.slope * x]);
        let name = format!("κ = {}", fixed(-line.slope, 2));
        all.push(Series::of(name, Style::Line, ends));
    }
    let axes = [
        Axis::linear("level of the textile, dB re 1 µm"),
        Axis::linear("matched gain, dB"),
    ];
    scatter(
        "gain",
        &experiment.titled("matched gain over level"),
        axes,
        all,
    )
}
