//! The last seconds as charts: forces, opening, amplitudes, energy; and as the command's table.

use std::collections::VecDeque;
use std::sync::Arc;

use crate::kit::plot::thinned;
use crate::tools::drape::hung::{Frame, Sample};
use selvedge_chart::{At, Axis, Chart, Columns, Ink, Rule, Series, Style, Weight};
use selvedge_drape::Drape;

/// What is shown, s.
pub(crate) const SHOWN_S: f64 = 8.0;
/// Lines are drawn by the least and the largest of so many parts.
const N_PARTS: usize = 300;
/// Columns of a row of forces.
const FORCES: std::ops::Range<usize> = 2..5;
const ENERGY: usize = 7;
/// What cloths side by side are drawn with.
pub(crate) const INKS: [(Ink, Style); 5] = [
    (Ink::Black, Style::Line),
    (Ink::Violet, Style::Line),
    (Ink::Rose, Style::Line),
    (Ink::Grey, Style::Line),
    (Ink::Black, Style::Dashed),
];

/// What charts are made of.
pub(crate) struct Seconds<'a> {
    pub(crate) samples: &'a VecDeque<Sample>,
    pub(crate) frames: &'a VecDeque<Arc<Frame>>,
    /// Names of the cloths.
    pub(crate) titles: Vec<&'a str>,
    pub(crate) n_fingers: usize,
    /// The instant that is looked back at, s.
    pub(crate) looked_at_s: Option<f64>,
}

impl Seconds<'_> {
    /// Force, opening, amplitude, energy.
    pub(crate) fn charts(&self) -> Vec<Chart> {
        vec![
            self.forces(),
            self.openings(),
            self.amplitudes(),
            self.energies(),
        ]
    }

    fn end_s(&self) -> f64 {
        self.frames.back().map_or(0.0, |frame| frame.t_s)
    }

    fn is_one(&self) -> bool {
        self.titles.len() < 2
    }

    fn chart(&self, title: &str, y: Axis, series: Vec<Series>) -> Chart {
        let end_s = self.end_s().max(SHOWN_S);
        let looked_at = self.looked_at_s.map(|t_s| Rule {
            at: At::X(t_s),
            ink: Ink::Black,
            ..Rule::default()
        });
        Chart {
            title: title.to_owned(),
            x: Axis::linear("time, s").within([end_s - SHOWN_S, end_s]),
            y: above_zero(y, &series),
            series,
            rules: looked_at.into_iter().collect(),
            ..Chart::default()
        }
    }

    fn line(name: &str, (ink, style): (Ink, Style), points: &[[f64; 2]]) -> Series {
        Series {
            ink,
            weight: Weight::Thin,
            ..Series::of(name, style, thinned(points, N_PARTS))
        }
    }

    fn of_samples(&self, value: impl Fn(&Sample) -> f64) -> Vec<[f64; 2]> {
        let from_s = self.end_s() - SHOWN_S;
        let first = self.samples.partition_point(|sample| sample.t_s < from_s);
        let shown = self.samples.range(first..);
        shown.map(|sample| [sample.t_s, value(sample)]).collect()
    }

    fn of_frames(&self, value: impl Fn(&Frame) -> f64) -> Vec<[f64; 2]> {
        let from_s = self.end_s() - SHOWN_S;
        let first = self.frames.partition_point(|frame| frame.t_s < from_s);
        let shown = self.frames.range(first..);
        shown.map(|frame| [frame.t_s, value(frame)]).collect()
    }

    /// Its number where several hang.
    fn name(&self, nth: usize) -> String {
        if self.is_one() {
            return String::new();
        }
        (nth + 1).to_string()
    }

    /// A line for each cloth, by the place of its first row in a sample.
    fn by_cloth(&self, value: impl Fn(&[f64; 9]) -> f64) -> Vec<Series> {
        let n_rows = self.n_fingers.max(1);
        let cloths = INKS.into_iter().take(self.titles.len()).enumerate();
        cloths
            .map(|(nth, ink)| {
                let of = |sample: &Sample| sample.rows.get(nth * n_rows).map_or(0.0, &value);
                Self::line(&self.name(nth), ink, &self.of_samples(of))
            })
            .collect()
    }

    fn forces(&self) -> Chart {
        let y = Axis::linear("force, N");
        if !self.is_one() {
            return self.chart("Force on the first finger", y, self.by_cloth(force));
        }
        let fingers = ["first", "second"].into_iter().zip([INKS[0], INKS[4]]);
        let lines = fingers.take(self.n_fingers).enumerate();
        let lines = lines.map(|(nth, (name, (_, style)))| {
            let of = |sample: &Sample| sample.rows.get(nth).map_or(0.0, force);
            Self::line(name, (Ink::Black, style), &self.of_samples(of))
        });
        self.chart("Force of the fingers", y, lines.collect())
    }

    fn openings(&self) -> Chart {
        let of = |frame: &Frame| frame.hands.first().map_or(0.0, |hand| hand.opening_mm);
        let line = Self::line("", INKS[0], &self.of_frames(of));
        let y = Axis::linear("opening, mm");
        Chart {
            y,
            ..self.chart("Opening of the hand", Axis::default(), vec![line])
        }
    }

    fn amplitudes(&self) -> Chart {
        let y = Axis::linear("mean amplitude, µm");
        if !self.is_one() {
            let cloths = INKS.into_iter().take(self.titles.len()).enumerate();
            let lines = cloths.map(|(nth, ink)| {
                let of = |frame: &Frame| mean_um(frame, nth, 0)[1];
                Self::line(&self.name(nth), ink, &self.of_frames(of))
            });
            return self.chart("First finger, 320 Hz", y, lines.collect());
        }
        let mut lines = Vec::new();
        for (finger, style) in [Style::Line, Style::Dashed].into_iter().enumerate() {
            for (band, (name, ink)) in [("40 Hz", Ink::Amber), ("320 Hz", Ink::Cyan)]
                .into_iter()
                .enumerate()
            {
                let of = |frame: &Frame| mean_um(frame, 0, finger)[band];
                let name = if finger == 0 { name } else { "" };
                lines.push(Self::line(name, (ink, style), &self.of_frames(of)));
            }
        }
        lines.truncate(2 * self.n_fingers.max(1));
        self.chart("Contactors, mean of a pad", y, lines)
    }

    fn energies(&self) -> Chart {
        let lines = self.by_cloth(|row| 1e3 * row[ENERGY]);
        let y = Axis::linear("energy, mJ");
        Chart {
            y,
            ..self.chart("Energy of cloth and fingers", Axis::default(), lines)
        }
    }

    /// Every step that is remembered, as the command writes it; where several cloths hang, with
    /// which.
    pub(crate) fn columns(&self) -> Columns {
        let n_rows = self.n_fingers.max(1);
        let mut columns = Columns::default();
        if !self.is_one() {
            let title = |row: usize| self.titles.get(row / n_rows).copied().unwrap_or_default();
            let rows = self.samples.iter().flat_map(|sample| 0..sample.rows.len());
            let names: Vec<String> = rows.map(|row| title(row).to_owned()).collect();
            columns = columns.with("cloth", names);
        }
        for (of, name) in Drape::FORCE_COLUMNS.into_iter().enumerate() {
            let rows = self.samples.iter().flat_map(|sample| &sample.rows);
            columns = columns.with(name, rows.map(|row| row[of]).collect::<Vec<f64>>());
        }
        columns
    }
}

fn mean_um(frame: &Frame, cloth: usize, finger: usize) -> [f64; 2] {
    let cloth = frame.cloths.get(cloth);
    cloth.map_or([0.0; 2], |cloth| cloth.mean_um(finger))
}

fn force(row: &[f64; 9]) -> f64 {
    row[FORCES].iter().map(|n| n * n).sum::<f64>().sqrt()
}

/// An axis from zero up to what is there, and to something where nothing is.
fn above_zero(axis: Axis, series: &[Series]) -> Axis {
    let values = series.iter().flat_map(|one| &one.points);
    let most = values.map(|point| point[1]).fold(0.0, f64::max);
    axis.within([0.0, if most > 1e-9 { 1.1 * most } else { 1.0 }])
}
