//! Maps from dissimilarities: stress by dimensions, the elbow, Shepard's diagram, ellipses over
//! subjects, and what the axes have to do with what was measured.

use super::Options;
use super::draw::{MapDrawing, axis, scatter};
use super::model::{Cell, Section, Table, ends, matrix};
use super::properties::{Measure, Measures};
use crate::figure::{Series, Style};
use crate::numerics::Random;
use crate::progress::{Cancelled, Progress};
use crate::statistics::mds::{Dissimilarities, Elbow, Loss, Map, Mds, Null, NullKind, Ties};
use crate::statistics::properties::{BestTurn, Ellipse, PropertyVector, bootstrap_ellipses};
use crate::statistics::{Computed, Undefined, f_upper, fisher_z};

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
    fn mds(&self, options: &Options) -> Mds {
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
        let cells = self.values.iter().map(|value| {
            value.map_or_else(|| Cell::none("itself, or never met"), Cell::from)
        });
        let title = "Dissimilarities, symmetric";
        section.tables.push(matrix("dissimilarities", title, &self.names, cells.collect()));
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
            "Non-metric multidimensional scaling; {} made small, {} ties; stress-1 and S-stress of \
             the same points beside each other. {} pairs, {} missing.",
            self.loss.name(),
            self.ties.name(),
            data.pairs().len(),
            data.n_missing()
        ));
        self.stress(&maps, (&mds, &data, options), &mut section, progress)?;
        section.tables.push(coordinates(&self.names, &maps));
        if let Some(plane) = maps.iter().find(|map| map.dims == 2) {
            section.figures.push(shepard(plane));
            let ellipses = self.ellipses(plane, (&mds, options), &mut section, progress)?;
            self.turned(plane, &ellipses, options, &mut section);
        }
        for map in &maps {
            let told = map.warnings.iter();
            section.notes.extend(told.map(|w| format!("{} dimensions: {w}", map.dims)));
        }
        Ok(section)
    }

    fn stress(
        &self,
        maps: &[Map],
        (mds, data, options): (&Mds, &Dissimilarities, &Options),
        section: &mut Section,
        progress: &mut Progress<'_>,
    ) -> Result<(), Cancelled> {
        let mut chance: Vec<Null> = Vec::new();
        for map in maps.iter().filter(|_| options.n_random_data > 0) {
            let sets = (map.dims, options.n_random_data);
            chance.push(Null::of(mds, data, NullKind::RandomRanks, sets, progress)?);
        }
        let losses: Vec<(usize, f64)> = maps.iter().map(|m| (m.dims, m.loss(self.loss))).collect();
        let five: Vec<f64> = chance.iter().map(Null::five_percent).collect();
        let elbow = Elbow::of(&losses, chance.first().map(Null::mean), &five);
        section.tables.push(stress_table(maps, &elbow, &five));
        section.note(match elbow.by_bend {
            Some(k) => format!("The elbow, the largest second difference of the stress, is at {k}."),
            None => "No elbow: too few dimensions to bend.".to_owned(),
        });
        match elbow.below_chance {
            Some(k) => section.note(format!("Below the 5 % point of random ranks from {k} on.")),
            None if chance.is_empty() => section.note(
                "A bend at one dimension shows only against random ranks, which were not asked for.",
            ),
            None => section.note("**No map lies below the 5 % point of random ranks.**"),
        }
        let line = |name: &str, of: &dyn Fn(&Map) -> f64| Series {
            name: name.to_owned(),
            points: maps.iter().map(|map| [map.dims as f64, of(map)]).collect(),
            style: Style::LineAndDots,
            ..Series::default()
        };
        let mut series = vec![line("S-stress", &|m| m.sstress), line("stress-1", &|m| m.stress1)];
        if !five.is_empty() {
            series.push(Series {
                name: "5 % of random ranks".to_owned(),
                points: maps.iter().zip(&five).map(|(m, v)| [m.dims as f64, *v]).collect(),
                style: Style::Dashed,
                ..Series::default()
            });
        }
        let mut dims = axis("dimensions");
        dims.scale = crate::figure::Scale::Whole;
        let mut stress = axis("stress");
        stress.range = Some([0.0, losses.iter().fold(0.1, |m: f64, (_, l)| m.max(*l)) * 1.3]);
        let title = format!("{}: stress by dimensions", self.title);
        section.figures.push(scatter("stress", &title, [dims, stress], series));
        Ok(())
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
        let few = Mds { n_starts: mds.n_starts.min(10), ..*mds };
        let draws = (2, options.n_maps);
        let resampled = few.resampled(&self.names, &self.subjects, draws, progress)?;
        match bootstrap_ellipses(&plane.points, &resampled.maps, ELLIPSE_SHARE) {
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

    /// The plane map as it is and turned to A40 and A320.
    fn turned(&self, plane: &Map, ellipses: &[Ellipse], options: &Options, section: &mut Section) {
        self.measures.tell(section);
        let measures = self.measures;
        let fits: Vec<(&Measure, Computed<PropertyVector>)> = measures
            .all
            .iter()
            .map(|m| (m, PropertyVector::of(&plane.points, &m.values)))
            .collect();
        if !measures.all.is_empty() {
            section.tables.push(measures.table(&self.names));
            section.tables.push(vectors(&fits, self.names.len()));
        }
        let mut turns = Table::new("turns", "The plane map turned to two measures", &TURNS);
        let mut best = None;
        for (first, second) in PAIRS {
            let pair = measures.named(first).zip(measures.named(second));
            let Some((first, second)) = pair else {
                continue;
            };
            let turn = self.turn(plane, [first, second], options, &mut turns);
            best = best.or(turn.ok());
        }
        if !turns.rows.is_empty() {
            section.note(
                "Turned, with reflection allowed, so that r(axis 1, first measure) + r(axis 2, \
                 second) is largest; p by permutation, the turn sought again each time; the interval \
                 is Fisher's z and knows nothing of the turn, so it is optimistic.",
            );
            section.tables.push(turns);
        }
        let (points, axes, angle) = match &best {
            Some(turn) => (&turn.points, ["towards A40", "towards A320"], Some(turn)),
            None => (&plane.points, ["dimension 1", "dimension 2"], None),
        };
        let turned_ellipses: Vec<Ellipse> = match angle {
            Some(turn) => ellipses.iter().map(|e| turned_ellipse(e, turn)).collect(),
            None => ellipses.to_vec(),
        };
        let arrows = ["a40_db", "a320_db"].into_iter().filter_map(|name| {
            let measure = measures.named(name)?;
            let fit = PropertyVector::of(points, &measure.values).ok()?;
            let of = |axis: usize| fit.direction[axis] * fit.multiple_r;
            let band = if name == "a40_db" { "40 Hz" } else { "320 Hz" };
            Some((format!("level at {band} rises"), [of(0), of(1)]))
        });
        let drawing = MapDrawing {
            names: &self.names,
            points,
            axes,
            ellipses: &turned_ellipses,
            directions: &arrows.collect::<Vec<_>>(),
        };
        let note = format!(
            "{} {}, {} ties; stress-1 {:.4}. An arrow is as long as the multiple correlation.",
            self.loss.name(),
            crate::quantity::fixed(plane.loss(self.loss), 4),
            self.ties.name(),
            plane.stress1
        );
        section.figures.push(drawing.drawn("map", &format!("{}: the plane map", self.title), vec![note]));
    }

    fn turn(
        &self,
        plane: &Map,
        pair: [&Measure; 2],
        options: &Options,
        table: &mut Table,
    ) -> Computed<BestTurn> {
        let values = pair.map(|m| m.values.as_slice());
        let turn = BestTurn::of(&plane.points, values);
        let p = turn.clone().and_then(|turn| {
            let mut random = Random::new(options.seed).branch("turns by chance");
            turn.p_values(&plane.points, values, options.n_permutations, &mut random)
        });
        let part = |axis: usize| match (&turn, &p) {
            (Ok(turn), Ok(p)) => {
                let mut cells = vec![Cell::from(turn.r[axis])];
                cells.extend(ends(&fisher_z(turn.r[axis], self.names.len(), 0.95)));
                cells.push(p[axis + 1].into());
                cells
            }
            (Err(why), _) | (_, Err(why)) => undefined(why, 4),
        };
        let mut row = vec![
            Cell::from(pair[0].heading.as_str()),
            pair[1].heading.as_str().into(),
            self.names.len().into(),
        ];
        row.extend(part(0));
        row.extend(part(1));
        row.push(match &p {
            Ok(p) => p[0].into(),
            Err(why) => Cell::Undefined(why.reason.clone()),
        });
        row.extend(match &turn {
            Ok(t) => [
                t.angle_rad.to_degrees().into(),
                if t.is_mirrored { "yes" } else { "no" }.into(),
            ],
            Err(why) => [(); 2].map(|()| Cell::Undefined(why.reason.clone())),
        });
        table.push(row);
        turn
    }
}

/// Measures that the plane map is turned to, the first that exist for the figure.
const PAIRS: [(&str, &str); 5] = [
    ("a40_db", "a320_db"),
    ("a40_um", "a320_um"),
    ("sum", "difference"),
    ("a40_db_own_speed", "a320_db_own_speed"),
    ("sum_own_speed", "difference_own_speed"),
];

const TURNS: [(&str, &str); 14] = [
    ("first", "axis 1 to"),
    ("second", "axis 2 to"),
    ("n", "n"),
    ("r1", "r of axis 1"),
    ("r1_ci_low", "95 % CI from"),
    ("r1_ci_high", "to"),
    ("p1", "p"),
    ("r2", "r of axis 2"),
    ("r2_ci_low", "95 % CI from"),
    ("r2_ci_high", "to"),
    ("p2", "p"),
    ("p_sum", "p of both"),
    ("angle_deg", "angle, °"),
    ("is_mirrored", "mirrored"),
];

pub(super) fn undefined(why: &Undefined, n: usize) -> Vec<Cell> {
    (0..n).map(|_| Cell::Undefined(why.reason.clone())).collect()
}

fn turned_ellipse(ellipse: &Ellipse, turn: &BestTurn) -> Ellipse {
    let mirror = if turn.is_mirrored { -1.0 } else { 1.0 };
    let (sin, cos) = turn.angle_rad.sin_cos();
    let [x, y] = [ellipse.middle[0], mirror * ellipse.middle[1]];
    Ellipse {
        middle: [cos * x - sin * y, sin * x + cos * y],
        half_axes: ellipse.half_axes,
        angle_rad: mirror * ellipse.angle_rad + turn.angle_rad,
    }
}

fn vectors(fits: &[(&Measure, Computed<PropertyVector>)], n: usize) -> Table {
    let columns = [
        ("measure", "measure"),
        ("n", "n"),
        ("multiple_r", "multiple R"),
        ("f", "F"),
        ("df", "df"),
        ("df_error", "df error"),
        ("p", "p"),
        ("x1", "direction x₁"),
        ("x2", "x₂"),
    ];
    let title = "Measures fitted into the plane map, whatever its turn";
    let mut table = Table::new("vectors", title, &columns);
    for (measure, fit) in fits {
        let mut row = vec![Cell::from(measure.heading.as_str()), n.into()];
        match fit {
            Ok(fit) => {
                let [df, df_error] = fit.df.map(|df| df as f64);
                row.extend([Cell::from(fit.multiple_r), fit.f.into(), df.into(), df_error.into()]);
                row.push(Cell::of(&f_upper(fit.f, df, df_error)));
                row.extend(fit.direction.iter().map(|x| Cell::from(*x)));
            }
            Err(why) => row.extend(undefined(why, 7)),
        }
        table.push(row);
    }
    table
}

fn stress_table(maps: &[Map], elbow: &Elbow, five: &[f64]) -> Table {
    let columns = [
        ("dims", "dimensions"),
        ("sstress", "S-stress"),
        ("stress1", "stress-1"),
        ("spearman", "Spearman of distances"),
        ("starts", "starts"),
        ("reached_best", "reached the best"),
        ("first_difference", "fall to here"),
        ("second_difference", "second difference"),
        ("random_5_percent", "5 % of random ranks"),
    ];
    let mut table = Table::new("stress", "Maps in one to five dimensions", &columns);
    for (i, map) in maps.iter().enumerate() {
        let difference = |all: &[Option<f64>]| {
            let value = all.get(i).copied().flatten();
            value.map_or_else(|| Cell::none("nothing on one side to compare with"), Cell::from)
        };
        let chance = five.get(i);
        table.push([
            map.dims.into(),
            map.sstress.into(),
            map.stress1.into(),
            Cell::of(&map.spearman),
            map.n_starts.into(),
            map.n_reached.into(),
            difference(&elbow.first_differences),
            difference(&elbow.second_differences),
            chance.map_or_else(|| Cell::none("not asked for"), |v| (*v).into()),
        ]);
    }
    table
}

fn coordinates(names: &[String], maps: &[Map]) -> Table {
    let columns = [
        ("dims", "dimensions"), ("item", "item"), ("x1", "x₁"), ("x2", "x₂"), ("x3", "x₃"),
        ("x4", "x₄"), ("x5", "x₅"), ("stress", "stress of its pairs"),
    ];
    let title = "Coordinates: centred, principal axes, mean square distance 1";
    let mut table = Table::new("coordinates", title, &columns);
    for map in maps {
        for (i, name) in names.iter().enumerate() {
            let mut row = vec![Cell::from(map.dims), name.as_str().into()];
            let x = &map.points[i];
            let coordinate = |axis: usize| {
                x.get(axis).map_or_else(|| Cell::none("a map of fewer dimensions"), |x| (*x).into())
            };
            row.extend((0..5).map(coordinate));
            row.push(map.stress_per_point[i].into());
            table.push(row);
        }
    }
    table
}

/// Distances and disparities over dissimilarities.
fn shepard(map: &Map) -> super::model::Drawn {
    let series = |name: &str, style: Style, of: &dyn Fn(usize) -> f64| Series {
        name: name.to_owned(),
        points: (0..map.shepard.len()).map(|i| [map.shepard[i].delta, of(i)]).collect(),
        style,
        ..Series::default()
    };
    let all = vec![
        series("distance", Style::Dots, &|i| map.shepard[i].distance),
        series("disparity", Style::Line, &|i| map.shepard[i].disparity),
    ];
    let axes = [axis("dissimilarity"), axis("distance")];
    scatter("shepard", "Shepard's diagram, two dimensions", axes, all)
}
