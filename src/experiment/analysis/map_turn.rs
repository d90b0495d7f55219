//! Maps turned towards what was measured, and measures fitted into them.

use super::draw_map::MapDrawing;
use super::map::{Mapping, loss_heading};
use super::model::{Cell, Section, Table, cells, or_undefined};
use super::options::Options;
use super::properties::Measure;
use selvedge_foundation::numerics::Random;
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_foundation::quantity::fixed;
use selvedge_statistics::mds::Map;
use selvedge_statistics::properties::{BestTurn, Ellipse, PropertyVector};
use selvedge_statistics::{Computed, Interval, f_upper};

/// Measures that the plane map is turned to, the first that exist for the figure.
const PAIRS: [(&str, &str); 5] = [
    ("a40_db", "a320_db"),
    ("a40_um", "a320_um"),
    ("sum", "difference"),
    ("a40_db_own_speed", "a320_db_own_speed"),
    ("sum_own_speed", "difference_own_speed"),
];

const TURNS: &str = "first: axis 1 to; second: axis 2 to; n; r1: r of axis 1; r1_ci_low: 95 % CI \
    from; r1_ci_high: to; p1: p; r2: r of axis 2; r2_ci_low: 95 % CI from; r2_ci_high: to; p2: p; \
    p_sum: p of both; angle_deg: angle, °; is_mirrored: mirrored";

impl Mapping<'_> {
    /// The plane map as it is and turned to A40 and A320, drawn where it is worth it.
    ///
    /// # Errors
    /// It was cancelled.
    pub(super) fn turned(
        &self,
        (plane, ellipses, is_drawn): (&Map, &[Ellipse], bool),
        options: &Options,
        section: &mut Section,
        progress: &mut Progress<'_>,
    ) -> Result<(), Cancelled> {
        self.measures.describe(section);
        let measures = self.measures;
        self.fitted(plane, section);
        let mut turns = Table::new("turns", "The plane map turned to two measures", TURNS);
        let mut best = None;
        for (first, second) in PAIRS {
            let pair = measures.named(first).zip(measures.named(second));
            let Some((first, second)) = pair else {
                continue;
            };
            progress.step(0.9, "turns by chance")?;
            let turn = self.turn(plane, [first, second], options, &mut turns);
            best = best.or_else(|| turn.ok());
        }
        if !turns.rows.is_empty() {
            section.note(
                "Turned, with reflection allowed, so that r(axis 1, first measure) + r(axis 2, \
                 second) is largest; p by permutation, the turn sought again each time; the \
                 interval is Fisher's z and knows nothing of the turn, so it is optimistic.",
            );
            section.table(turns);
        }
        let turned = best.as_ref().map(|turn| {
            let ellipses = ellipses.iter().map(|e| turned_ellipse(e, turn)).collect();
            (&turn.points, ["towards A40", "towards A320"], ellipses)
        });
        let (points, axes, ellipses): (_, _, Vec<Ellipse>) = turned.unwrap_or_else(|| {
            (
                &plane.points,
                ["dimension 1", "dimension 2"],
                ellipses.to_vec(),
            )
        });
        section.tables.extend(self.own_speeds(best.as_ref()));
        if !is_drawn {
            return Ok(());
        }
        let directions = self.directions(points);
        let drawing = MapDrawing {
            names: &self.names,
            points,
            axes,
            ellipses: &ellipses,
            directions: &directions,
        };
        let note = format!(
            "{} {}, {} ties. A bar is as long as the multiple correlation.",
            loss_heading(self.loss),
            fixed(plane.loss(self.loss), 4),
            self.ties.name()
        );
        section.figure(drawing.drawn("map", &format!("{}, in the plane", self.title), vec![note]));
        Ok(())
    }

    /// What was measured, and every measure fitted into a map.
    fn fitted(&self, plane: &Map, section: &mut Section) {
        let measures = self.measures;
        if measures.all.is_empty() {
            return;
        }
        let fits: Vec<(&Measure, Computed<PropertyVector>)> = measures
            .all
            .iter()
            .map(|m| (m, PropertyVector::of(&plane.points, &m.values)))
            .collect();
        section.table(measures.table(&self.names));
        section.table(vectors(&fits, self.names.len()));
    }

    /// Where the levels of both bands rise in a map.
    fn directions(&self, points: &[Vec<f64>]) -> Vec<(String, [f64; 2])> {
        let arrows = ["a40_db", "a320_db"].into_iter().filter_map(|name| {
            let measure = self.measures.named(name)?;
            let fit = PropertyVector::of(points, &measure.values).ok()?;
            let of = |axis: usize| fit.direction[axis] * fit.multiple_r;
            let band = if name == "a40_db" { "40 Hz" } else { "320 Hz" };
            Some((format!("level at {band} rises"), [of(0), of(1)]))
        });
        arrows.collect()
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
        let n = self.names.len();
        let part = |axis: usize| {
            let found = turn
                .as_ref()
                .and_then(|turn| Ok((turn.r[axis], p.as_ref()?[axis + 1])));
            or_undefined(
                found.map(|(r, p)| cells![r, Interval::fisher_z(r, n, 0.95), p]),
                4,
            )
        };
        let way = turn
            .as_ref()
            .map(|t| cells![t.angle_rad.to_degrees(), t.is_mirrored]);
        table.push(cells![
            pair.map(|measure| &measure.heading),
            n,
            part(0),
            part(1),
            p.as_ref().map(|p| p[0]),
            or_undefined(way, 2),
        ]);
        turn
    }
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
    let columns = "measure; n; multiple_r: multiple R; f: F; df; df_error: df error; p; x1: \
        direction x₁; x2: x₂";
    let title = "Measures fitted into the plane map, whatever its turn";
    let mut table = Table::new("vectors", title, columns);
    for (measure, fit) in fits {
        let found = fit.as_ref().map(|fit| {
            let [df, df_error] = fit.df.map(|df| df as f64);
            let p = f_upper(fit.f, df, df_error);
            let direction: Vec<Cell> = fit.direction.iter().map(|x| Cell::from(*x)).collect();
            cells![fit.multiple_r, fit.f, df, df_error, p, direction]
        });
        table.push(cells![&measure.heading, n, or_undefined(found, 7)]);
    }
    table
}
