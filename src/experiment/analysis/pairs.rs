//! Scales from comparisons of two, subject by subject: Bradley and Terry's, Thurstone's, and how
//! consistent the comparisons are.

use super::model::{Cell, Section, Table, cells, or_undefined, percent_of};
use super::options::Options;
use super::tables::tests;
use selvedge_statistics::ranking::{
    BradleyTerry, Estimate, Majority, Mosteller, Preferences, Prior, Scale, Thurstone,
};
use selvedge_statistics::{Bootstrap, Computed, Outcome, Undefined};

/// Draws of subjects that errors over subjects follow from, at most.
const MOST_DRAWS: usize = 200;

/// Comparisons of two among some items.
pub(super) struct Pairs<'a> {
    names: &'a [String],
    /// Of each subject, by name.
    subjects: Vec<(&'a str, Preferences)>,
}

/// Draws of subjects for errors over subjects.
pub(super) fn draws(options: &Options) -> (usize, u64) {
    (options.n_resamples.clamp(20, MOST_DRAWS), options.seed)
}

/// What every section with such scales says of them.
pub(super) const NOTE: &str = "Bradley and Terry's values are logits: the natural logarithm of \
    the odds that one is preferred to the other is their difference. The unit of Thurstone's (Case \
    V) is the standard deviation of the difference of two sensations; times √2 it is that of one, \
    the unit of d′. Row means of z (Mosteller) are in the same unit. Scales have no zero of their \
    own: values sum to 0.";

const SCALES: &str = "item; preferred; compared: of comparisons; bradley_terry: Bradley & Terry, \
    logits; bradley_terry_se: SE, comparisons independent; bradley_terry_se_subjects: SE over \
    subjects; bradley_terry_ci_low: 95 % CI over subjects from; bradley_terry_ci_high: to; \
    thurstone: Thurstone, sd of a difference; thurstone_se: SE, comparisons independent; \
    thurstone_se_subjects: SE over subjects; thurstone_ci_low: 95 % CI over subjects from; \
    thurstone_ci_high: to; row_mean_z: row mean of z";

impl<'a> Pairs<'a> {
    /// Of each subject.
    ///
    /// # Errors
    /// The first subject's comparisons that are none.
    pub(super) fn of(
        names: &'a [String],
        subjects: impl Iterator<Item = (&'a str, Computed<Preferences>)>,
    ) -> Computed<Self> {
        let subjects = subjects.map(|(name, own)| Ok((name, own?)));
        Ok(Self {
            names,
            subjects: subjects.collect::<Computed<_>>()?,
        })
    }
}

impl Pairs<'_> {
    /// Everything of them: scales, tests, consistency, with keys that begin so.
    pub(super) fn describe(&self, key: &str, of: &str, options: &Options, section: &mut Section) {
        let together = Preferences::together(self.subjects.iter().map(|(_, own)| own));
        let all = match together {
            Ok(all) if all.n_comparisons() > 0 => all,
            _ => return section.note(format!("No scale of {of}: nothing was compared.")),
        };
        let (bt, th) = (self.bradley_terry(&all), self.thurstone(&all));
        if let Err(why) = &bt {
            section.note(format!("**No scale of {of}**: {}.", why.reason));
        }
        section.table(self.scales(key, of, (&all, &bt, &th), options));
        let found = tested(of, &bt, &th, &all);
        let title = format!("Pairs of {of}: differences and fit");
        section.table(tests(&format!("{key}-tests"), &title, &found));
        section.table(self.consistency(key, of, &all));
    }

    /// What comparisons do not hang together is told by names.
    fn check(&self, all: &Preferences) -> Computed<()> {
        all.connection().check(|item| self.names[item].clone())
    }

    fn bradley_terry(&self, all: &Preferences) -> Computed<BradleyTerry> {
        self.check(all)?;
        BradleyTerry::fit(all, Prior::None)
    }

    fn thurstone(&self, all: &Preferences) -> Computed<Thurstone> {
        self.check(all)?;
        Thurstone::fit(all)
    }

    /// Errors of the values that a model has, over draws of subjects.
    fn errors(
        &self,
        model: impl Fn(&Preferences) -> Computed<Vec<f64>>,
        options: &Options,
    ) -> Computed<Vec<f64>> {
        let of_drawn = |drawn: &[usize]| {
            let all = Preferences::together(drawn.iter().map(|at| &self.subjects[*at].1))?;
            model(&all)
        };
        Bootstrap::errors(self.subjects.len(), of_drawn, draws(options))
    }

    fn scales(
        &self,
        key: &str,
        of: &str,
        (all, bt, th): (&Preferences, &Computed<BradleyTerry>, &Computed<Thurstone>),
        options: &Options,
    ) -> Table {
        let bt_errors = bt.clone().and_then(|_| {
            let values = |all: &Preferences| Ok(self.bradley_terry(all)?.scale.values);
            self.errors(values, options)
        });
        let th_errors = th.clone().and_then(|_| {
            let values = |all: &Preferences| Ok(self.thurstone(all)?.scale.values);
            self.errors(values, options)
        });
        let z = Mosteller::of(all);
        let title = format!("Pairs of {of}: scales of how often each was preferred");
        let mut table = Table::new(&format!("{key}-scales"), &title, SCALES);
        for (item, name) in self.names.iter().enumerate() {
            let count =
                |wins: &dyn Fn(usize) -> u64| -> u64 { (0..self.names.len()).map(wins).sum() };
            let won = count(&|other| all.wins(item, other));
            let lost = count(&|other| all.wins(other, item));
            table.push(cells![
                name,
                won,
                won + lost,
                of_scale(bt.as_ref().map(|m| &m.scale), &bt_errors, item),
                of_scale(th.as_ref().map(|m| &m.scale), &th_errors, item),
                z.as_ref().map(|found| found.values[item]),
            ]);
        }
        table
    }

    fn consistency(&self, key: &str, of: &str, all: &Preferences) -> Table {
        let columns = "subject; pairs: pairs compared; undecided: as often either way; triads: \
            triads of decided pairs; circular; circular_percent: %, 25 by chance; zeta: Kendall's \
            ζ; p: p of as few by chance";
        let title = format!("Pairs of {of}: circular triads, each pair by majority");
        let mut table = Table::new(&format!("{key}-consistency"), &title, columns);
        let all = std::iter::once(("all together", all));
        let subjects = self.subjects.iter().map(|(name, own)| (*name, own));
        for (name, own) in subjects.chain(all) {
            let found = Majority::of(own);
            let (circular, triads) = (found.n_circular, found.n_triads);
            let share = percent_of(circular, triads, "no triad is decided");
            let why = "asks for every pair, decided, of three items or more";
            let whole = found
                .consistency
                .map(|whole| cells![whole.zeta, whole.p_of_chance]);
            let whole = whole.unwrap_or_else(|_| vec![Cell::none(why); 2]);
            let pairs = [found.n_pairs, found.n_undecided];
            table.push(cells![name, pairs, triads, circular, share, whole]);
        }
        table
    }
}

/// A value, its error by curvature, its error over subjects, and the interval of that.
fn of_scale(
    scale: Result<&Scale, &Undefined>,
    errors: &Computed<Vec<f64>>,
    item: usize,
) -> Vec<Cell> {
    let found = scale.map(|scale| {
        let own = scale.centred()[item];
        cells![own.value, own.se, over_subjects(own.value, errors, item)]
    });
    or_undefined(found, 5)
}

/// The error of a value over subjects and the interval by it.
pub(super) fn over_subjects(value: f64, errors: &Computed<Vec<f64>>, at: usize) -> Vec<Cell> {
    let found = errors.as_ref().map(|errors| {
        let se = errors[at];
        cells![se, Estimate { value, se }.interval(0.95)]
    });
    or_undefined(found, 3)
}

fn tested(
    of: &str,
    bt: &Computed<BradleyTerry>,
    th: &Computed<Thurstone>,
    all: &Preferences,
) -> Vec<(String, Computed<Outcome>)> {
    let bt = bt
        .as_ref()
        .map_err(Clone::clone)
        .map(|model| model.deviance);
    let th = th
        .as_ref()
        .map_err(Clone::clone)
        .map(|model| model.deviance);
    let equal = bt.clone().and_then(|d| d.against_equal());
    let z = Mosteller::of(all).and_then(|found| found.fit);
    let all = [
        ("Bradley & Terry, do they differ", equal),
        ("Bradley & Terry, fit", bt.and_then(|d| d.goodness_of_fit())),
        ("Thurstone, fit", th.and_then(|d| d.goodness_of_fit())),
        ("row means of z, fit", z),
    ];
    let independent = |mut outcome: Outcome| {
        outcome
            .notes
            .push("takes comparisons for independent".to_owned());
        outcome
    };
    all.map(|(what, outcome)| (format!("{of}: {what}"), outcome.map(independent)))
        .into()
}
