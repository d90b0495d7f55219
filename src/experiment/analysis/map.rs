//! Maps from dissimilarities: stress by dimensions, the elbow, Shepard's diagram, ellipses over
//! subjects.

use super::draw::scatter;
use super::model::{Drawn, Section, Table, cells, known};
use super::options::Options;
use super::properties::Measures;
use super::tables::{matrix, tests};
use selvedge_chart::{Axis, Series, Style};
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_statistics::mds::{Dissimilarities, Elbow, Loss, Map, Mds, Null, Ties};
use selvedge_statistics::properties::Ellipse;
use selvedge_statistics::variance::friedman;
use selvedge_statistics::{Computed, Outcome, Undefined};

/// The share of resampled subjects that an ellipse holds.
const ELLIPSE_SHARE: f64 = 0.95;

/// What is mapped, and how.
pub(super) struct Mapping<'a> {
    pub(super) key: String,
    pub(super) title: String,
    pub(super) names: Vec<String>,
    /// Of all subjects, row by row.
    pub(super) values: Vec<Option<f64>>,
    /// Of each subject.
    pub(super) subjects: Vec<Vec<Option<f64>>>,
    pub(super) loss: Loss,
    pub(super) ties: Ties,
    pub(super) measures: &'a Measures,
}

impl Mapping<'_> {
    pub(super) fn mds(&self, options: &Options) -> Mds {
        Mds {
            ties: self.ties,
            loss: self.loss,
            n_starts: options.n_starts,
            n_starts_on_a_line: options.n_starts_on_a_line,
            seed: options.seed,
            ..Mds::default()
        }
    }

    /// The section of the maps in one to five dimensions.
    ///
    /// # Errors
    /// It was cancelled.
    pub(super) fn section(
        &self,
        options: &Options,
        progress: &mut Progress<'_>,
    ) -> Result<Section, Cancelled> {
        let mut section = Section::new(self.key.clone(), self.title.clone());
        let cells = self.values.iter();
        let cells = cells.map(|value| known(*value, "itself, or never met"));
        let title = "Dissimilarities, symmetric";
        section.table(matrix("dissimilarities", title, &self.names, cells));
        section.table(tests(
            "agreement",
            "Agreement of subjects on the order of pairs (Kendall's W)",
            &[("dissimilarities of pairs", self.agreement())],
        ));
        let data = match Dissimilarities::new(self.names.clone(), &self.values) {
            Ok(data) => data,
            Err(why) => {
                section.note(format!("**No map**: {}.", why.reason));
                return Ok(section);
            }
        };
        let mds = self.mds(options);
        let maps = mds.maps(&data, 1..=5, progress)?;
        section.note(format!(
            "Non-metric multidimensional scaling; {} made small, {} ties. {} pairs, {} missing.",
            loss_heading(self.loss),
            self.ties.name(),
            data.pairs().len(),
            data.n_missing()
        ));
        let chance = self.stress(&maps, (&mds, &data, options), &mut section, progress)?;
        section.table(coordinates(&self.names, &maps));
        if let Some(plane) = maps.iter().find(|map| map.dims == 2) {
            let is_worth = self.is_below_chance(plane, &chance);
            if is_worth {
                section.figure(shepard(plane));
            } else {
                section.note(
                    "**The plane is not drawn**: random ranks lie in one as well, more than one \
                     time in twenty. Its coordinates stand in the table.",
                );
            }
            let ellipses = self.ellipses(plane, (&mds, options), &mut section, progress)?;
            self.turned(
                (plane, &ellipses, is_worth),
                options,
                &mut section,
                progress,
            )?;
        }
        for map in &maps {
            let warnings = map.warnings.iter();
            section
                .notes
                .extend(warnings.map(|w| format!("{} dimensions: {w}", map.dims)));
        }
        Ok(section)
    }

    fn stress(
        &self,
        maps: &[Map],
        (mds, data, options): (&Mds, &Dissimilarities, &Options),
        section: &mut Section,
        progress: &mut Progress<'_>,
    ) -> Result<Vec<Null>, Cancelled> {
        let n_sets = options.n_random_data;
        let random_data = &options.random_data;
        let chance = random_data.of(maps, (mds, data), n_sets, progress)?;
        let losses: Vec<(usize, f64)> = maps.iter().map(|m| (m.dims, m.loss(self.loss))).collect();
        let five: Vec<f64> = chance.iter().map(Null::five_percent).collect();
        let elbow = Elbow::of(&losses, chance.first().map(Null::mean), &five);
        section.table(stress_table(maps, (&elbow, self.loss), &chance));
        section.note(match elbow.by_bend {
            Some(k) => {
                format!("The elbow, the largest second difference of the stress, is at {k}.")
            }
            None => "No elbow: too few dimensions to bend.".to_owned(),
        });
        match elbow.below_chance {
            Some(k) => section.note(format!(
                "Below the 5 % point of {n_sets} sets of random ranks from {k} on."
            )),
            None if chance.is_empty() => section
                .note("A bend at one dimension shows only against random ranks (not asked for)."),
            None => section.note("**No map lies below the 5 % point of random ranks.**"),
        }
        let line = |name: &str, of: &dyn Fn(&Map) -> f64| {
            let points = maps.iter().map(|map| [map.dims as f64, of(map)]);
            Series::of(name, Style::LineAndDots, points)
        };
        let mut all = vec![
            line("S-stress", &|m| m.sstress),
            line("stress-1", &|m| m.stress1),
        ];
        if !five.is_empty() {
            let points = maps.iter().zip(&five).map(|(m, v)| [m.dims as f64, *v]);
            all.push(Series::of("5 % of random ranks", Style::Dashed, points));
        }
        let most = losses.iter().fold(0.1, |m: f64, (_, l)| m.max(*l));
        let dims = Axis::whole("dimensions");
        let stress = Axis::linear("stress").within([0.0, 1.3 * most]);
        let title = format!("{}: stress by dimensions", self.title);
        section.figure(scatter("elbow", &title, [dims, stress], all));
        Ok(chance)
    }

    /// Whether a map's loss lies below the 5 % point of random ranks; nobody knows where they were
    /// not asked for.
    fn is_below_chance(&self, map: &Map, chance: &[Null]) -> bool {
        let own = chance.iter().find(|null| null.dims == map.dims);
        own.is_none_or(|null| map.loss(self.loss) < null.five_percent())
    }

    fn ellipses(
        &self,
        plane: &Map,
        (mds, options): (&Mds, &Options),
        section: &mut Section,
        progress: &mut Progress<'_>,
    ) -> Result<Vec<Ellipse>, Cancelled> {
        if options.n_maps == 0 || self.subjects.len() < 2 {
            section.note("No ellipses: they need two subjects or more.");
            return Ok(Vec::new());
        }
        let few = Mds {
            n_starts: mds.n_starts.min(10),
            ..*mds
        };
        let draws = (2, options.n_maps);
        let resampled = few.resampled(&self.names, &self.subjects, draws, progress)?;
        match Ellipse::of_bootstrap(&plane.points, &resampled.maps, ELLIPSE_SHARE) {
            Ok(ellipses) => {
                section.note(format!(
                    "Ellipses hold {} % of the maps of {} draws of {} subjects with replacement, \
                     each laid over the map by Procrustes; {} draws had no map.",
                    100.0 * ELLIPSE_SHARE,
                    resampled.maps.len(),
                    self.subjects.len(),
                    resampled.n_unmapped
                ));
                Ok(ellipses)
            }
            Err(why) => {
                section.note(format!("No ellipses: {}.", why.reason));
                Ok(Vec::new())
            }
        }
    }

    /// How well subjects agree on the order of the pairs that all of them met: Kendall's W.
    pub(super) fn agreement(&self) -> Computed<Outcome> {
        let n = self.names.len();
        let upper = (0..n).flat_map(|i| (i + 1..n).map(move |j| i * n + j));
        let is_met = |at: &usize| {
            let met = |subject: &Vec<Option<f64>>| subject.get(*at).is_some_and(Option::is_some);
            self.subjects.iter().all(met)
        };
        let cells: Vec<usize> = upper.filter(is_met).collect();
        if self.subjects.len() < 2 || cells.len() < 2 {
            let (n, pairs) = (self.subjects.len(), cells.len());
            let reason = format!("{n} subjects with {pairs} pairs in common have no agreement");
            return Err(Undefined::because(reason));
        }
        let row = |subject: &Vec<Option<f64>>| cells.iter().filter_map(|at| subject[*at]).collect();
        let rows: Vec<Vec<f64>> = self.subjects.iter().map(row).collect();
        friedman(&rows).map(|mut outcome| {
            let note = "takes pairs for independent, which share their items";
            outcome.notes.push(note.to_owned());
            outcome
        })
    }
}

/// A loss as people write it.
pub(super) fn loss_heading(loss: Loss) -> &'static str {
    match loss {
        Loss::Stress1 => "stress-1",
        Loss::SStress => "S-stress",
    }
}

fn stress_table(maps: &[Map], (elbow, loss): (&Elbow, Loss), chance: &[Null]) -> Table {
    let columns = "dims: dimensions; sstress: S-stress; stress1: stress-1; spearman: Spearman of \
        distances; starts; reached_best: reached the best; first_difference: fall to here; \
        second_difference: second difference; random_mean: mean of random ranks; \
        random_5_percent: 5 % of them; random_p: p against them";
    let mut table = Table::new("stress", "Maps in one to five dimensions", columns);
    for (i, map) in maps.iter().enumerate() {
        let differences = [&elbow.first_differences, &elbow.second_differences].map(|all| {
            let value = all.get(i).copied().flatten();
            known(value, "nothing on one side to compare with")
        });
        let by_chance = |null: &Null| {
            [
                null.mean(),
                null.five_percent(),
                null.p_value(map.loss(loss)),
            ]
            .map(Some)
        };
        let by_chance = chance.get(i).map_or([None; 3], by_chance);
        table.push(cells![
            map.dims,
            [map.sstress, map.stress1],
            &map.spearman,
            [map.n_starts, map.n_reached],
            differences,
            by_chance.map(|value| known(value, "not asked for")),
        ]);
    }
    table
}

fn coordinates(names: &[String], maps: &[Map]) -> Table {
    let columns = "dims: dimensions; item; x1: x₁; x2: x₂; x3: x₃; x4: x₄; x5: x₅; stress: stress \
        of its pairs";
    let title = "Coordinates: centred, principal axes, mean square distance 1";
    let mut table = Table::new("coordinates", title, columns);
    for map in maps {
        for (i, name) in names.iter().enumerate() {
            let x = &map.points[i];
            let place = [0, 1, 2, 3, 4]
                .map(|axis| known(x.get(axis).copied(), "a map of fewer dimensions"));
            table.push(cells![map.dims, name, place, map.stress_per_point[i]]);
        }
    }
    table
}

/// Distances and disparities over dissimilarities.
fn shepard(map: &Map) -> Drawn {
    let distances = map.shepard.iter().map(|pair| [pair.delta, pair.distance]);
    let disparities = map.shepard.iter().map(|pair| [pair.delta, pair.disparity]);
    let all = vec![
        Series::of("distance", Style::Dots, distances),
        Series::of("disparity", Style::Line, disparities),
    ];
    let axes = [Axis::linear("dissimilarity"), Axis::linear("distance")];
    scatter("shepard", "Shepard's diagram, two dimensions", axes, all)
}
