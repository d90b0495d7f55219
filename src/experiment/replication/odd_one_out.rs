//! The odd one of three (Allerkamp et al.): seven similar fabrics, four subjects each with real
//! cloth under a pen, with textiles by the optical model and with textiles by the Kawabata model.

use super::comparison::{DesignWithStimuli, Kind, Options, Replication, bar, by_levels, guessing};
use super::maps::{chance, dimensions};
use super::studies::{Case, Subjects, each_study, percents_right};
use crate::ExperimentError;
use crate::analysis::{
    Bar, Cell, Drawn, Section, Table, bars, cells, grade_weights, percent_of, triad_answer,
};
use selvedge_foundation::progress::Progress;
use selvedge_statistics::mds::{Dissimilarities, Elbow, Loss, Map, Mds, Null, Ties};
use selvedge_statistics::ranking::{Grade, OddOneOut, TriadAnswer};
use selvedge_statistics::{Computed, Undefined, mean};

const PAPER: &str = "Allerkamp et al., odd one out";
/// The paper ends with this many dimensions for virtual fabrics, by the elbow.
const PRINTED_DIMENSIONS: f64 = 1.0;
/// Starts of maps: few objects, so that few are needed.
const N_STARTS: usize = 10;
const N_STARTS_ON_A_LINE: usize = 100;
/// How often lines are turned to their mean.
const N_TURNED: usize = 5;
/// More dimensions than these leave seven fabrics nothing to fit.
const MOST_DIMENSIONS: usize = 4;

/// The paper's groups of subjects: a design each.
pub(super) const GROUPS: [&str; 3] = ["odd-one-out-pen", "odd-one-out-optical", "odd-one-out"];
/// What the figures call them, and the last of them, of which nothing is felt.
const NAMES: [&str; 4] = [
    "real cloth, pen",
    "optical model",
    "Kawabata model",
    "guesses",
];
const ASSUMED: [&str; 4] = [
    "under a pen cloth feels as the array would render it",
    "near relatives stand in for the optical model's textiles",
    "nothing",
    "nothing",
];

const ELBOW: &str = "group; one; two; more; below_chance: a map below the 5 % point of random \
    ranks; studies";

/// What one study came to.
struct Found {
    percent: f64,
    /// Of right answers, %: easy, normal, hard.
    grades: [f64; 3],
    /// Of wrong answers, %: those to triads with the fabric.
    errors: Vec<f64>,
    /// Pairs at the ceiling and at the floor.
    ends: [f64; 2],
    /// From one dimension on.
    maps: Computed<Vec<Map>>,
}

/// Right answers, how easy they were, and how many dimensions the elbow finds.
///
/// # Errors
/// A study cannot be held, or it was cancelled.
pub(super) fn section(
    laid: &[DesignWithStimuli; 3],
    options: &Options,
    all: &mut Replication,
    progress: &mut Progress<'_>,
) -> Result<Section, ExperimentError> {
    let mut section = Section::new("odd-one-out", "The odd one of three: seven similar fabrics");
    section.note(
        "Twelve observers, four in each group, every pair of seven fabrics once. The distance of \
         a pair is the sum of weights of its right answers; stress-1 with primary ties, since sums \
         pile up at their ends. Nothing of a pen is simulated, and no photographs of fabrics are \
         part of the program: near relatives of the library stand in for the optical model's.",
    );
    section.note(
        "The paper's figures 7 and 9 to 12 are of this study; which of them shows what is not \
         known here, nor its shares of right answers. Drawn is what its numbers come to: right \
         answers, easy, normal and hard, errors by fabric, stress over dimensions, and the map on \
         a line. Intervals hold 95 of 100 studies.",
    );
    let laid = laid.iter().chain(laid.last());
    let cases: Vec<Case<'_>> = laid.zip(kinds()).collect();
    let names: Vec<String> = cases[0]
        .0
        .design
        .stimuli
        .iter()
        .map(|s| s.id.clone())
        .collect();
    let chance = progress.within([0.0, 0.2], |part| {
        chance(&names, &mds(), (MOST_DIMENSIONS, options.n_studies), part)
    })?;
    let found = progress.within([0.2, 1.0], |part| {
        each_study(&cases, "triads", options, part, found)
    })?;
    let title = "How many dimensions the elbow finds, share of studies, %";
    let mut chosen = Table::new("elbow", title, ELBOW);
    for ((_, kind), found) in cases.iter().zip(&found) {
        let elbows = found.iter().filter_map(|f| elbow(f, &chance).ok());
        let elbows: Vec<Elbow> = elbows.collect();
        compare(found, &elbows, kind, all);
        chosen.push(shares(kind, &elbows));
    }
    section.figures.extend(figures(&found, &chance, &names));
    section.table(chosen);
    Ok(section)
}

/// An observer of every group, and one that guesses.
fn kinds() -> impl Iterator<Item = Kind> {
    NAMES
        .into_iter()
        .zip(ASSUMED)
        .map(|(description, assumed)| {
            let is_guess = description == guessing().description;
            let kind = if is_guess { guessing() } else { by_levels() };
            Kind {
                description,
                assumed,
                ..kind
            }
        })
}

fn found(subjects: &Subjects, laid: &DesignWithStimuli) -> Found {
    let rows = || subjects.iter().flatten();
    let answers: Vec<TriadAnswer> = rows().filter_map(triad_answer).collect();
    let percents = percents_right(subjects);
    let (right, wrong): (Vec<&TriadAnswer>, Vec<&TriadAnswer>) =
        answers.iter().partition(|a| a.is_correct);
    let percent = |n: usize, of: usize| 100.0 * n as f64 / of as f64;
    let grades = Grade::ALL.map(|grade| {
        let n = right.iter().filter(|a| a.grade == grade).count();
        percent(n, right.len())
    });
    let names: Vec<String> = laid.design.stimuli.iter().map(|s| s.id.clone()).collect();
    let errors = (0..names.len()).map(|item| {
        let n = wrong.iter().filter(|a| a.pair.contains(&item)).count();
        percent(n, wrong.len())
    });
    let errors = errors.collect();
    let weights = grade_weights(&laid.design.composition);
    let tally = OddOneOut::of(names.len(), &answers, weights);
    let ends = tally.as_ref().map_or([f64::NAN; 2], |tally| {
        [tally.n_ceiling as f64, tally.n_floor as f64]
    });
    let data = tally.and_then(|tally| Dissimilarities::new(names, &tally.distances()));
    let maps = data.and_then(|data| {
        let maps = Progress::unheard(|progress| mds().maps(&data, 1..=MOST_DIMENSIONS, progress));
        maps.map_err(|_stopped| Undefined::because("stopped"))
    });
    Found {
        percent: percents.iter().sum::<f64>() / percents.len() as f64,
        grades,
        errors,
        ends,
        maps,
    }
}

/// On one thread: studies are what threads share.
fn mds() -> Mds {
    Mds {
        loss: Loss::Stress1,
        ties: Ties::Primary,
        n_starts: N_STARTS,
        n_starts_on_a_line: N_STARTS_ON_A_LINE,
        n_exchanged: 2,
        n_threads: 1,
        ..Mds::default()
    }
}

fn elbow(found: &Found, chance: &[Null]) -> Computed<Elbow> {
    let maps = found.maps.as_ref().map_err(Clone::clone)?;
    let losses: Vec<(usize, f64)> = maps.iter().map(|map| (map.dims, map.stress1)).collect();
    let five: Vec<f64> = chance.iter().map(Null::five_percent).collect();
    Ok(Elbow::of(&losses, chance.first().map(Null::mean), &five))
}

fn compare(found: &[Found], elbows: &[Elbow], kind: &Kind, all: &mut Replication) {
    let mut add = |quantity: &str, printed: Option<f64>, values: Vec<f64>| {
        let finite: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).collect();
        all.add((PAPER, kind), (quantity, printed), &finite);
    };
    let of = |of: &dyn Fn(&Found) -> f64| found.iter().map(of).collect::<Vec<f64>>();
    add("right answers, %", None, of(&|f| f.percent));
    add("pairs at the ceiling, of 21", None, of(&|f| f.ends[0]));
    add("pairs at the floor, of 21", None, of(&|f| f.ends[1]));
    let dims = elbows.iter().filter_map(|elbow| elbow.by_bend);
    let is_virtual = NAMES[1..3].contains(&kind.description);
    let printed = is_virtual.then_some(PRINTED_DIMENSIONS);
    let dims = dims.map(|k| k as f64).collect();
    add("dimensions by the elbow", printed, dims);
}

fn shares(kind: &Kind, elbows: &[Elbow]) -> Vec<Cell> {
    let n = elbows.len();
    let percent = |is_it: &dyn Fn(&Elbow) -> bool| {
        let n_such = elbows.iter().filter(|elbow| is_it(elbow)).count();
        percent_of(n_such as u64, n as u64, "no study had a map")
    };
    let found = [
        percent(&|elbow| elbow.by_bend == Some(1)),
        percent(&|elbow| elbow.by_bend == Some(2)),
        percent(&|elbow| elbow.by_bend > Some(2)),
        percent(&|elbow| elbow.below_chance.is_some()),
    ];
    cells![kind.description, found, n]
}

/// What the numbers of the groups come to, drawn.
fn figures(found: &[Vec<Found>], chance: &[Null], names: &[String]) -> Vec<Drawn> {
    let groups = || NAMES.into_iter().zip(found);
    let of = |name: &str, group: &str, own: &[Found], of: &dyn Fn(&Found) -> Option<f64>| {
        let values = own.iter().filter_map(of).filter(|value| value.is_finite());
        bar(name, group, &values.collect::<Vec<f64>>())
    };
    let [mut right, mut grades, mut errors, mut stress, mut line]: [Vec<Bar>; 5] =
        Default::default();
    let mut towards = Vec::new();
    for (group, own) in groups() {
        right.extend(of(group, "", own, &|f| Some(f.percent)));
        let felt = group != guessing().description;
        for (nth, grade) in Grade::ALL.into_iter().enumerate().filter(|_| felt) {
            grades.extend(of(grade.name(), group, own, &|f| Some(f.grades[nth])));
        }
        for (item, name) in names.iter().enumerate().filter(|_| felt) {
            errors.extend(of(name, group, own, &|f| Some(f.errors[item])));
        }
        for dims in (1..=MOST_DIMENSIONS).filter(|_| felt) {
            let stress1 = |f: &Found| Some(f.maps.as_ref().ok()?.get(dims - 1)?.stress1);
            stress.extend(of(&dimensions(dims), group, own, &stress1));
        }
        if felt {
            line.extend(places_on_a_line(group, own, names, &mut towards));
        }
    }
    for (dims, null) in (1..).zip(chance) {
        stress.extend(bar(&dimensions(dims), "random ranks", &null.losses));
    }
    let percent = Some([0.0, 100.0]);
    [
        ("right", "right answers", "right, %", right, percent),
        (
            "grades",
            "easy, normal, hard",
            "of right answers, %",
            grades,
            percent,
        ),
        (
            "errors",
            "errors by fabric",
            "of wrong answers, %",
            errors,
            percent,
        ),
        ("stress", "how well maps fit", "stress-1", stress, None),
        ("line", "the map on a line", "place", line, None),
    ]
    .map(|(key, title, label, shown, range)| {
        let title = format!("Allerkamp et al., odd one out: {title}");
        let label = format!("{label} (95 of 100 studies)");
        let chance = [(100.0 / 3.0, "chance")];
        let rules = if key == "right" { &chance[..] } else { &[] };
        bars(key, &title, &label, (&shown, range), rules)
    })
    .into()
}

/// Where the fabrics lie on the maps on a line, every one pointing as the mean of all does, which
/// points as that of the group before.
fn places_on_a_line(
    group: &str,
    found: &[Found],
    names: &[String],
    towards: &mut Vec<f64>,
) -> Vec<Bar> {
    let on_a_line = |one: &Found| {
        let map = one.maps.as_ref().ok()?.first()?;
        map.points
            .iter()
            .map(|point| point.first().copied())
            .collect()
    };
    let lines: Vec<Vec<f64>> = found.iter().filter_map(on_a_line).collect();
    let values = |towards: &[f64], item: usize| -> Vec<f64> {
        let sign = |line: &Vec<f64>| {
            let along = towards.iter().zip(line).map(|(a, b)| a * b).sum::<f64>();
            1.0_f64.copysign(along)
        };
        lines.iter().map(|line| sign(line) * line[item]).collect()
    };
    if towards.is_empty() {
        towards.extend(lines.first().into_iter().flatten());
    }
    for _ in 0..N_TURNED {
        let mean = |item| mean(&values(towards, item)).unwrap_or(0.0);
        *towards = (0..names.len()).map(mean).collect();
    }
    let place = |(item, name): (usize, &String)| bar(name, group, &values(towards, item));
    names.iter().enumerate().filter_map(place).collect()
}
