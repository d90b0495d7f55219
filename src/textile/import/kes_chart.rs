//! The picture of an import: every stroke with its marks, and the evaluated section on it.

use super::kes::KesImport;
use crate::curve::{corners, line, row};
use crate::kes::{KesStroke, MarkKind};
use selvedge_chart::{At, Axis, Chart, Extent, Figure, Ink, Row, Rule, Series, Style, Weight};
use selvedge_foundation::quantity::fixed;

/// The height of a panel, px.
const HEIGHT_PX: f64 = 120.0;

impl KesImport {
    /// The strokes and the friction as they were read, with what is evaluated of them.
    pub fn figure(&self, name: &str) -> Figure {
        let mut rows: Vec<Row> = self
            .reading()
            .strokes
            .iter()
            .map(|one| self.row(one))
            .collect();
        rows.extend(self.friction_row());
        self.share_places(&mut rows);
        let mut notes = vec![
            "Black: the evaluated section. Grey: left out. Dots: outliers, which are marked and \
             kept. One straight line was taken off every stroke of heights."
                .to_owned(),
        ];
        notes.extend(self.reading().notes.iter().cloned());
        let about = |[file, sha256]: &[String; 2]| (format!("sha256 {file}"), sha256.clone());
        Figure {
            title: format!("{name}: strokes of the surface tester"),
            rows,
            notes,
            about: self.reading().files.iter().map(about).collect(),
        }
    }

    /// Gives all panels the same places, labelled below the last.
    fn share_places(&self, rows: &mut [Row]) {
        let friction = self.reading().friction.as_ref().map(|friction| {
            let length_mm = friction.mu.len() as f64 * friction.step_mm;
            [friction.start_mm, friction.start_mm + length_mm]
        });
        let strokes = self.reading().strokes.iter().map(KesStroke::range_mm);
        let range = strokes
            .chain(friction)
            .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        let last = rows.len().saturating_sub(1);
        for (index, row) in rows.iter_mut().enumerate() {
            for panel in &mut row.panels {
                "place along the forward stroke, mm".clone_into(&mut panel.x.label);
                panel.x.range = range;
                panel.is_x_shared = index < last;
            }
        }
    }

    /// The lowest and the highest height of all strokes, so that they share a scale.
    fn height_range_um(&self) -> Option<[f64; 2]> {
        let heights = self
            .reading()
            .strokes
            .iter()
            .flat_map(|stroke| &stroke.heights_um);
        let wide = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], z| {
            [low.min(*z), high.max(*z)]
        });
        let margin_um = (0.05 * (wide[1] - wide[0])).max(0.05);
        let range = [wide[0] - margin_um, wide[1] + margin_um];
        range.iter().all(|end| end.is_finite()).then_some(range)
    }

    fn row(&self, stroke: &KesStroke) -> Row {
        let samples = self.samples(stroke);
        let heights = &stroke.heights_um;
        let part = |range: std::ops::Range<usize>, ink, weight| {
            let place = |i| stroke.place_mm(range.start + i);
            line(corners(place, &heights[range.clone()]), ink, weight)
        };
        let outliers = stroke.marks.iter();
        let outliers = outliers.filter(|mark| mark.kind == MarkKind::Outlier);
        let spikes = outliers.flat_map(|mark| mark.samples.clone());
        let spikes = Series {
            points: spikes.map(|i| [stroke.place_mm(i), heights[i]]).collect(),
            style: Style::Dots,
            ..Series::default()
        };
        let smd = self.figures().smd_um.iter();
        let smd_um = smd
            .clone()
            .find(|(direction, _)| *direction == stroke.direction);
        let smd_um = smd_um.map_or(f64::NAN, |(_, smd_um)| *smd_um);
        let label = stroke.direction.label();
        let title = format!("{label}: SMD {} µm", fixed(smd_um, 2));
        let ends = [samples.start, samples.end.saturating_sub(1)];
        let mut rules: Vec<Rule> = ends.map(|end| edge(stroke.place_mm(end), "")).to_vec();
        rules.extend(marked_ends(stroke));
        let panel = Chart {
            title,
            y: Axis {
                range: self.height_range_um(),
                ..Axis::linear("height, µm")
            },
            series: vec![
                part(0..heights.len(), Ink::Grey, Weight::Thin),
                part(samples, Ink::Black, Weight::Normal),
                spikes,
            ],
            rules,
            ..Chart::default()
        };
        row(vec![panel], HEIGHT_PX)
    }

    fn friction_row(&self) -> Option<Row> {
        let friction = self.reading().friction.as_ref()?;
        let section = self.friction_section()?;
        let place = |i: usize| friction.start_mm + i as f64 * friction.step_mm;
        let is_evaluated = |i: &usize| (section.from_mm..section.to_mm).contains(&place(*i));
        let inside: Vec<usize> = (0..friction.mu.len()).filter(is_evaluated).collect();
        let first = inside.first().copied().unwrap_or(0);
        let last = inside.last().copied().unwrap_or(0);
        let whole = corners(place, &friction.mu);
        let part = corners(|i| place(first + i), &friction.mu[first..=last]);
        let figure = |value: Option<f64>| fixed(value.unwrap_or(f64::NAN), 4);
        let (miu, mmd) = (figure(self.figures().miu), figure(self.figures().mmd));
        let panel = Chart {
            title: format!("friction: MIU {miu}, MMD {mmd}"),
            y: Axis::linear("coefficient"),
            series: vec![
                line(whole, Ink::Grey, Weight::Thin),
                line(part, Ink::Black, Weight::Normal),
            ],
            rules: vec![edge(section.from_mm, ""), edge(section.to_mm, "")],
            ..Chart::default()
        };
        Some(row(vec![panel], HEIGHT_PX))
    }
}

/// Where run-in and turn-round end.
fn marked_ends(stroke: &KesStroke) -> impl Iterator<Item = Rule> + '_ {
    let ends = stroke
        .marks
        .iter()
        .filter(|mark| mark.kind != MarkKind::Outlier);
    ends.map(|mark| {
        let inner = if mark.samples.start == 0 {
            mark.samples.end
        } else {
            mark.samples.start
        };
        Rule {
            extent: Extent::Dashed,
            ..edge(stroke.place_mm(inner), mark.kind.label())
        }
    })
}

fn edge(place_mm: f64, label: &str) -> Rule {
    Rule {
        at: At::X(place_mm),
        label: label.to_owned(),
        ink: Ink::Black,
        extent: Extent::Across,
    }
}
