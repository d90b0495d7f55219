//! A hundred simulated observers of known parameters: what the analysis finds of them, and how
//! often their own intervals hold what they are.

use super::*;
use crate::observer::{Jnd, Observer, Stimuli, tests::stimuli};
use crate::simulate::{Simulation, simulated_subject};
use selvedge_foundation::numerics::Random;
use selvedge_foundation::quantity::factor_of_gain;
use selvedge_statistics::detection::{Answers, Correction, YesNo};
use selvedge_textile::tactile::{Band, Levels, Tuning};

/// Observers of a study.
const N: usize = 100;
/// The difference that they just notice, dB, at all levels.
const JND_DB: f64 = 2.4;
/// How many differences more than nothing are two of three right among three intervals: their d′,
/// 1.1159, times the noise of a look, 1/(√2 Φ⁻¹(¾)).
const TWO_THIRDS: f64 = 1.115_898_341_233_256 * 1.048_358_082_507_530_5;
const SEED: u64 = 1;

/// The sessions of observers from one number to another.
fn sessions(design: &Design, observer: &Observer, numbers: std::ops::Range<usize>) -> Vec<Found> {
    held_with(&stimuli(design), design, observer, numbers)
}

/// Stimuli far above threshold, where a level is felt as it is turned; those of no material of the
/// design are 6 dB stronger.
fn loud(design: &Design) -> Stimuli {
    let of_textile = |id: &str| {
        let is_material = design
            .stimuli
            .iter()
            .any(|stimulus| stimulus.material == id);
        let more_db = if is_material { 0.0 } else { 6.0 };
        let mean_um = [36.0, 26.0].map(|db| factor_of_gain(db + more_db));
        let levels = Levels {
            mean_um,
            cv: [0.0; 2],
            anisotropy_db: [0.0; 2],
            direction_mean_um: [mean_um; 4],
        };
        Some((levels, 0.0))
    };
    Stimuli::from_levels(design, Tuning::default(), of_textile).unwrap()
}

fn held_with(
    stimuli: &Stimuli,
    design: &Design,
    observer: &Observer,
    numbers: std::ops::Range<usize>,
) -> Vec<Found> {
    let simulation = Simulation {
        design,
        stimuli,
        observer,
        seed: SEED,
    };
    let of_subject = |nth| {
        let subject = simulated_subject(nth, 1);
        let log = PathBuf::from(format!("nowhere/{}.csv", subject.pseudonym));
        let records = simulation.records(&subject).unwrap();
        Found::of_records(log, (design, subject), records)
    };
    numbers.map(of_subject).collect()
}

fn name_in(table: &Table, row: usize) -> &str {
    match table.cell(row, "subject") {
        Some(Cell::Text(name)) => name,
        other => panic!("{row}: {other:?}"),
    }
}

/// How many rows hold the truth of their subject.
fn held(table: &Table, ends: [&str; 2], truth: impl Fn(&str) -> f64) -> usize {
    let holds = |row: &usize| {
        let [low, high] = ends.map(|end| value(table, *row, end));
        (low..=high).contains(&truth(name_in(table, *row)))
    };
    (0..table.rows.len()).filter(holds).count()
}

/// What is drawn once for a subject.
fn of_person(subject: &str, what: &str) -> f64 {
    let person = Random::new(SEED).branch("observers").branch(subject);
    person.branch(what).normal()
}

#[test]
fn thresholds_of_a_hundred_observers_are_found_and_held() {
    let mut n_held = [0, 0];
    let cases = [
        ("jnd-40", None, 0.0),
        ("jnd-40", None, 0.2),
        ("jnd-320", None, 0.2),
        ("threshold-40", Some(Band::Low), 0.2),
        ("threshold-320", Some(Band::High), 0.2),
    ];
    let n_cases = cases.len();
    for (name, band, jnd_spread) in cases {
        let observer = Observer {
            jnd: Jnd::Fixed([JND_DB; 2]),
            jnd_spread,
            lapse: 0.1 * jnd_spread,
            ..Observer::default()
        };
        let truth_db = |noise: f64| match band {
            None => JND_DB * noise,
            Some(band) => band.detection_threshold_db(24) + (TWO_THIRDS * noise - 1.0) * JND_DB,
        };
        let design = Design::shipped(name).unwrap();
        let analysis = analysed(&sessions(&design, &observer, 0..N));
        let key = format!("{name}-thresholds");
        let (group, fits) = (
            table(&analysis, &key, "group"),
            table(&analysis, &key, "fits"),
        );
        let at = value(group, 0, "mean");
        let bias = match band {
            None => at / truth_db(1.0) - 1.0,
            Some(_) => 10.0_f64.powf((at - truth_db(1.0)) / 20.0) - 1.0,
        };
        let own = |subject: &str| truth_db((jnd_spread * of_person(subject, "noise")).exp());
        let held = [
            ["ci_low_db", "ci_high_db"],
            ["pooled_low_db", "pooled_high_db"],
        ]
        .map(|ends| held(fits, ends, own));
        println!(
            "{name}, noise differs by {jnd_spread}: {at:.3} ({:.3} to {:.3}) of {:.3} dB, \
             {:+.1} %; held by {} own and {} pooled intervals of {}",
            value(group, 0, "ci_low"),
            value(group, 0, "ci_high"),
            truth_db(1.0),
            100.0 * bias,
            held[0],
            held[1],
            fits.rows.len()
        );
        assert!(bias.abs() <= 0.05, "{name}: {bias}");
        assert!(held.iter().all(|n| *n >= 90), "{name}: {held:?}");
        n_held = [n_held[0] + held[0], n_held[1] + held[1]];
    }
    let shares = n_held.map(|n| n as f64 / (n_cases * N) as f64);
    assert!(
        shares.iter().all(|share| (0.9..=0.99).contains(share)),
        "{shares:?}"
    );
}

/// What a mean over subjects is to be, and the ends of subjects' own intervals of it.
struct Known<'a> {
    /// Section, and what its table `group` is of.
    group: (&'a str, &'a str),
    /// The table of subjects in the same section, and the ends of their intervals.
    subjects: (&'a str, [&'a str; 2]),
    /// Of everybody, and of a subject.
    truth: (f64, &'a dyn Fn(&str) -> f64),
}

impl Known<'_> {
    /// Refuses means that are more than 5 % off over all studies, and intervals that hold too few
    /// or too many. A bias is of the mean of many studies: one differs from the next, printed as ±.
    fn check(&self, studies: &[Analysis]) {
        let ((section, what), (of_subjects, ends)) = (self.group, self.subjects);
        let (mut off, mut n_held, mut n) = (Vec::new(), 0, 0);
        for analysis in studies {
            let group = table(analysis, section, "group");
            let is_it = |row: &usize| matches!(&group.rows[*row][0], Cell::Text(of) if of == what);
            let row = (0..group.rows.len()).find(is_it).unwrap();
            off.push(100.0 * (value(group, row, "mean") / self.truth.0 - 1.0));
            let mut subjects = table(analysis, section, of_subjects).clone();
            // Of one condition alone, and without the group.
            subjects.rows.retain(|cells| match &cells[..2] {
                [Cell::Text(condition), Cell::Text(name)] => {
                    name != "group" && what.contains(condition.as_str())
                }
                _ => true,
            });
            n_held += held(&subjects, ends, self.truth.1);
            n += subjects.rows.len();
        }
        let bias = selvedge_statistics::mean(&off).unwrap();
        let error = selvedge_statistics::Summary::of(&off).map_or(f64::NAN, |one| one.sd);
        let share = n_held as f64 / n as f64;
        println!(
            "{section}, {what}, {:.3}: bias {bias:+.1} % (a study ± {error:.1} %); {n_held} of {n} \
             intervals hold, {:.1} %",
            self.truth.0,
            100.0 * share
        );
        assert!(bias.abs() <= 5.0, "{section}, {what}: {bias} %");
        assert!((0.9..=0.99).contains(&share), "{section}, {what}: {share}");
    }
}

/// Studies of a hundred observers each.
fn studies(stimuli: &Stimuli, design: &Design, observer: &Observer, n: usize) -> Vec<Analysis> {
    let of = |study| held_with(stimuli, design, observer, study * N..(study + 1) * N);
    (0..n).map(|study| analysed(&of(study))).collect()
}

/// So many studies tell a bias of 5 % from none, where one study alone is off by as much.
const N_STUDIES: usize = 8;
/// How much the noise of observers differs: standard deviation of its logarithm.
const SPREAD: f64 = 0.2;

/// A number of observers whose noise is e^(0.2 z) times as large: a parabola through long runs
/// whose z are −2, 0 and 2.
struct Along([f64; 3]);

impl Along {
    fn at(&self, z: f64) -> f64 {
        let [low, middle, high] = self.0;
        middle + 0.25 * (high - low) * z + 0.125 * (low - 2.0 * middle + high) * z * z
    }

    /// Over all observers.
    fn mean(&self) -> f64 {
        let [low, middle, high] = self.0;
        middle + 0.125 * (low - 2.0 * middle + high)
    }
}

/// The share of right answers of observers that nobody else sees, with `times` the noise.
fn long_run(design: &Design, times: f64) -> f64 {
    let observer = Observer {
        jnd: Jnd::Fixed([3.0 * JND_DB * times; 2]),
        ..Observer::default()
    };
    let found = sessions(design, &observer, N_STUDIES * N..N_STUDIES * N + 1000);
    let records = found.iter().flat_map(|found| &found.records);
    let verdicts = records.filter(|r| !r.trial.is_practice);
    let [right, n] = verdicts
        .filter_map(|r| r.is_correct)
        .fold([0.0, 0.0], |[right, n], is_right| {
            [right + f64::from(u8::from(is_right)), n + 1.0]
        });
    right / n
}

#[test]
fn shares_right_of_a_hundred_observers_are_found_and_held() {
    let observer = Observer {
        jnd: Jnd::Fixed([3.0 * JND_DB; 2]),
        jnd_spread: SPREAD,
        ..Observer::default()
    };
    for (name, section, percent) in [
        ("odd-one-out", "accuracy", "right, %"),
        ("odd-one-out-optical", "accuracy", "right, %"),
        ("odd-one-out-pen", "accuracy", "right, %"),
        (
            "ranking-virtual-target",
            "identification",
            "targets identified, %",
        ),
        (
            "ranking-real-target",
            "identification",
            "targets identified, %",
        ),
    ] {
        let design = Design::shipped(name).unwrap();
        let relation = design.composition.relation().unwrap();
        let shares = [-2.0, 0.0, 2.0_f64].map(|z| long_run(&design, (SPREAD * z).exp()));
        let of_noise = |along: &Along, subject: &str| along.at(of_person(subject, "noise"));
        let right = Along(shares.map(|share| 100.0 * share));
        let d_prime = Along(shares.map(|share| relation.d_prime(share).unwrap()));
        let studies = studies(&stimuli(&design), &design, &observer, N_STUDIES);
        let key = format!("{name}-{section}");
        for (what, ends, truth) in [
            (percent, ["ci_low_percent", "ci_high_percent"], &right),
            ("d′", ["d_prime_ci_low", "d_prime_ci_high"], &d_prime),
        ] {
            let known = Known {
                group: (&key, what),
                subjects: ("subjects", ends),
                truth: (truth.mean(), &|subject| of_noise(truth, subject)),
            };
            known.check(&studies);
        }
    }
}

#[test]
fn sensitivity_of_a_hundred_observers_is_found_and_held() {
    let observer = Observer {
        jnd: Jnd::Fixed([JND_DB; 2]),
        ..Observer::default()
    };
    let design = Design::shipped("real-or-generated").unwrap();
    let stimuli = loud(&design);
    let mut answers = Answers {
        hits: 0,
        n_signal: 0,
        false_alarms: 0,
        n_noise: 0,
    };
    let found = held_with(
        &stimuli,
        &design,
        &observer,
        N_STUDIES * N..N_STUDIES * N + 1000,
    );
    for record in found.iter().flat_map(|found| &found.records) {
        let is_real = record.value() == Some(&AnswerValue::Chosen(0));
        // Said to be real and right, or wrong and real.
        if record.is_correct == Some(is_real) {
            answers.n_signal += 1;
            answers.hits += u64::from(is_real);
        } else {
            answers.n_noise += 1;
            answers.false_alarms += u64::from(is_real);
        }
    }
    let d_prime = YesNo::of(answers, Correction::LogLinear).unwrap().d_prime;
    let known = Known {
        group: ("single-judgements-sensitivity", "d′"),
        subjects: ("subjects", ["d_prime_ci_low", "d_prime_ci_high"]),
        truth: (d_prime, &|_| d_prime),
    };
    known.check(&studies(&stimuli, &design, &observer, N_STUDIES));
}

#[test]
fn exponents_of_a_hundred_observers_are_found_and_held() {
    let design = Design::shipped("magnitude").unwrap();
    let studies = studies(&stimuli(&design), &design, &Observer::default(), N_STUDIES);
    // As the model of perception has them, and as subjects differ.
    for (what, exponent) in [("exponent, 40 Hz", 0.95), ("exponent, 320 Hz", 0.58)] {
        let known = Known {
            group: ("magnitude-exponents", what),
            subjects: ("exponents", ["ci_low", "ci_high"]),
            truth: (exponent, &|subject| {
                exponent * (0.1 * of_person(subject, "exponent")).exp()
            }),
        };
        known.check(&studies);
    }
}

#[test]
fn a_hundred_observers_set_gains_to_what_the_cloth_has() {
    for (name, gain) in [
        ("adjustment-two-gains", "gain-40-db"),
        ("adjustment-two-gains", "gain-320-db"),
        ("gain-matching", "gain-db"),
    ] {
        let design = Design::shipped(name).unwrap();
        let observer = Observer::default();
        let analysis = analysed(&held_with(&loud(&design), &design, &observer, 0..N));
        let key = format!("{name}-{gain}");
        let stimuli = table(&analysis, &key, "stimuli");
        let mut n_held = 0;
        for row in 0..stimuli.rows.len() {
            let bias = 10.0_f64.powf(value(stimuli, row, "mean") / 20.0) - 1.0;
            println!(
                "{key}, {:?}: {:+.1} % of 0 dB, {:.3} to {:.3} dB",
                stimuli.rows[row][0],
                100.0 * bias,
                value(stimuli, row, "ci_low"),
                value(stimuli, row, "ci_high"),
            );
            assert!(bias.abs() <= 0.05, "{key} {row}: {bias}");
            n_held += usize::from(
                value(stimuli, row, "ci_low") <= 0.0 && value(stimuli, row, "ci_high") >= 0.0,
            );
        }
        assert!(n_held + 1 >= stimuli.rows.len(), "{key}: {n_held}");
    }
}

#[test]
fn ratings_of_a_hundred_observers_are_found_and_held() {
    let design = Design::shipped("rating").unwrap();
    let (observer, n_studies) = (Observer::default(), 20);
    let n_items = design.stimuli.len();
    let mut sums = vec![[0.0; 2]; design.composition.scales().len() * n_items];
    // Where a scale begins is a subject's own, so that all stimuli of a scale miss together: a
    // study is four intervals rather than sixty-four, and many studies say how many hold. What they
    // are to hold is known to a fifth of their width.
    for found in sessions(&design, &observer, n_studies * N..n_studies * N + 2500) {
        for record in found.records.iter().filter(|r| !r.trial.is_practice) {
            let Some(AnswerValue::Ratings(values)) = record.value() else {
                continue;
            };
            for (scale, value) in values.iter().enumerate() {
                let [sum, n] = &mut sums[scale * n_items + record.trial.task.item().unwrap()];
                (*sum, *n) = (*sum + value, *n + 1.0);
            }
        }
    }
    let mut off = vec![0.0; sums.len()];
    let mut n_held = 0;
    for study in studies(&stimuli(&design), &design, &observer, n_studies) {
        let found = table(&study, "rating-ratings", "means");
        assert_eq!(found.rows.len(), sums.len());
        for (row, [sum, n]) in sums.iter().enumerate() {
            let truth = sum / n;
            let [low, high] = ["ci_low", "ci_high"].map(|end| value(found, row, end));
            n_held += usize::from((low..=high).contains(&truth));
            off[row] += (value(found, row, "mean") - truth) / n_studies as f64;
        }
    }
    // Of what the scale spans, 0 to 100.
    let largest = off.iter().fold(0.0, |most: f64, off| most.max(off.abs()));
    let n = n_studies * sums.len();
    let share = n_held as f64 / n as f64;
    println!("rating: bias {largest:.2} % at most; {n_held} of {n} intervals hold, {share:.3}");
    assert!(largest <= 5.0, "{largest}");
    assert!((0.9..=0.99).contains(&share), "{share}");
}
