//! Maps of named points, and squares of colours.

use super::draw::{figure, list};
use super::model::{Cell, Drawn, Table, cells, known};
use selvedge_chart::{
    Axis, Chart, ColourBar, Ink, Raster, Scale, Series, Style, Tone, Upright, Weight, Words,
};
use selvedge_foundation::numerics::to_whole;
use selvedge_statistics::properties::Ellipse;

/// Corners of an ellipse.
const N_CORNERS: u32 = 48;
/// What points and their ellipses are drawn with, in turn.
const INKS: [Ink; 4] = [Ink::Violet, Ink::Rose, Ink::Black, Ink::Grey];
/// A map's frame, about.
const WIDTH_PX: f64 = 780.0;
const HEIGHT_PX: f64 = 520.0;
/// Half the height of a label, half the width of a letter, and what a dot keeps free around it.
const LABEL_PX: f64 = 7.0;
const LETTER_PX: f64 = 3.1;
const DOT_PX: f64 = 6.0;

/// A map of named points with ellipses around them and directions in which measures rise.
pub(crate) struct MapDrawing<'a> {
    pub(crate) names: &'a [String],
    pub(crate) points: &'a [Vec<f64>],
    pub(crate) axes: [&'a str; 2],
    pub(crate) ellipses: &'a [Ellipse],
    /// Name and direction, as long as its multiple correlation.
    pub(crate) directions: &'a [(String, [f64; 2])],
}

impl MapDrawing<'_> {
    /// The drawing of a plane map; on a line, the second axis is 0.
    pub(crate) fn drawn(&self, key: &str, title: &str, notes: Vec<String>) -> Drawn {
        let at = |p: &[f64]| {
            [
                p.first().copied().unwrap_or(0.0),
                p.get(1).copied().unwrap_or(0.0),
            ]
        };
        let places: Vec<[f64; 2]> = self.points.iter().map(|p| at(p)).collect();
        let inks = || INKS.into_iter().cycle();
        let outlines = self.ellipses.iter().zip(inks());
        let mut series: Vec<Series> = outlines.map(|(one, ink)| outline(one, ink)).collect();
        for (name, direction) in self.directions {
            series.push(Series {
                weight: Weight::Bold,
                ..Series::of(name, Style::Line, [[0.0; 2], *direction])
            });
        }
        series.extend(places.iter().zip(inks()).map(|(place, ink)| Series {
            points: vec![*place],
            ink,
            ..Series::default()
        }));
        let corners = series.iter().flat_map(|s| s.points.iter().flatten());
        let reach = 1.12 * corners.fold(0.5_f64, |most, x| most.max(x.abs()));
        // Both axes to one scale: a frame is about 1.6 times as wide as it is high.
        let wide = reach * WIDTH_PX / HEIGHT_PX;
        let words = labels(self.names, &places, HEIGHT_PX / (2.0 * reach));
        let axis = |label: &str, reach: f64| Axis {
            label: label.to_owned(),
            range: Some([-reach, reach]),
            ..Axis::default()
        };
        let panel = Chart {
            x: axis(self.axes[0], wide),
            y: axis(self.axes[1], reach),
            series,
            words,
            ..Chart::default()
        };
        let mut figure = figure(title, vec![panel], HEIGHT_PX, None);
        figure.notes = notes;
        Drawn {
            key: key.to_owned(),
            figure,
            points: self.table(),
        }
    }

    fn table(&self) -> Table {
        let columns = "name: ; x1: x₁; x2: x₂; ellipse_x1: middle x₁; ellipse_x2: middle x₂; \
            half_axis_1: half axis; half_axis_2: half axis; angle_deg: angle, °";
        let mut table = Table::new("points", "", columns);
        for (i, (name, point)) in self.names.iter().zip(self.points).enumerate() {
            let place = [0, 1].map(|axis| known(point.get(axis).copied(), "a line has one axis"));
            let ellipse = self.ellipses.get(i).map_or_else(
                || vec![Cell::none("no ellipse"); 5],
                |e| cells![e.middle, e.half_axes, e.angle_rad.to_degrees()],
            );
            table.push(cells![name, place, ellipse]);
        }
        for (name, direction) in self.directions {
            let blank = vec![Cell::none("a direction"); 5];
            table.push(cells![name, *direction, blank]);
        }
        table
    }
}

/// Names beside their points: each where it covers the fewest dots and names before it.
fn labels(names: &[String], places: &[[f64; 2]], px_per_unit: f64) -> Vec<Words> {
    let dots: Vec<[f64; 4]> = places
        .iter()
        .map(|[x, y]| [x * px_per_unit, y * px_per_unit, DOT_PX, DOT_PX])
        .collect();
    let mut taken = dots.clone();
    let mut words = Vec::with_capacity(names.len());
    for (name, [x, y, ..]) in names.iter().zip(dots) {
        let half = LETTER_PX * name.chars().count() as f64;
        let (aside, above) = (half + DOT_PX + 2.0, LABEL_PX + DOT_PX);
        let ways = [
            [aside, 0.0],
            [-aside, 0.0],
            [0.0, above],
            [0.0, -above],
            [aside, above],
            [-aside, above],
            [aside, -above],
            [-aside, -above],
        ];
        let boxes = ways.map(|[right, up]| [x + right, y + up, half, LABEL_PX]);
        let n_covered = |label: &[f64; 4]| taken.iter().filter(|one| touch(label, one)).count();
        let Some(label) = boxes.into_iter().min_by_key(n_covered) else {
            continue;
        };
        taken.push(label);
        words.push(Words {
            at: [label[0] / px_per_unit, label[1] / px_per_unit],
            text: name.clone(),
            tone: Tone::Dark,
        });
    }
    words
}

/// Whether two boxes, their middles and halves of their sides, share anything.
fn touch(a: &[f64; 4], b: &[f64; 4]) -> bool {
    (a[0] - b[0]).abs() < a[2] + b[2] && (a[1] - b[1]).abs() < a[3] + b[3]
}

fn outline(ellipse: &Ellipse, ink: Ink) -> Series {
    let (sin, cos) = ellipse.angle_rad.sin_cos();
    let corner = |nth: u32| {
        let turn = f64::from(nth) / f64::from(N_CORNERS) * std::f64::consts::TAU;
        let [a, b] = [
            ellipse.half_axes[0] * turn.cos(),
            ellipse.half_axes[1] * turn.sin(),
        ];
        [
            ellipse.middle[0] + a * cos - b * sin,
            ellipse.middle[1] + a * sin + b * cos,
        ]
    };
    Series {
        ink,
        weight: Weight::Thin,
        ..Series::of("", Style::Line, (0..=N_CORNERS).map(corner))
    }
}

/// A square of colours, darker for more, with names beside the rows.
pub(super) fn heat(
    key: &str,
    title: &str,
    label: &str,
    names: &[String],
    values: &[Option<f64>],
) -> Drawn {
    let n = names.len();
    let known = values.iter().flatten().copied();
    let (low, high) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
        (low.min(v), high.max(v))
    });
    let (low, high) = if high > low {
        (low, high)
    } else {
        (0.0, 1.0_f64.max(high))
    };
    let colour = |value: f64| shade((value - low) / (high - low));
    let range = Some([0.5, n as f64 + 0.5]);
    let of_names = || Axis {
        scale: Scale::Whole,
        range,
        ..Axis::default()
    };
    let numbered: Vec<String> = names
        .iter()
        .zip(1_u32..)
        .map(|(name, at)| format!("{at} {name}"))
        .collect();
    let numbered: Vec<&str> = numbered.iter().map(String::as_str).collect();
    let square = Chart {
        x: Axis {
            label: "as in the list".to_owned(),
            ..of_names()
        },
        y: of_names(),
        upright: Upright::Downward,
        raster: Some(Raster {
            n_columns: n,
            cells: values.iter().map(|v| v.map(colour)).collect(),
        }),
        width: 1.0,
        ..Chart::default()
    };
    let bar = ColourBar {
        axis: Axis {
            label: label.to_owned(),
            range: Some([low, high]),
            ..Axis::default()
        },
        colours: (0..=32).map(|i| shade(f64::from(i) / 32.0)).collect(),
    };
    let points = heat_table(label, names, values);
    Drawn {
        key: key.to_owned(),
        figure: figure(title, vec![square, list(&numbered)], 420.0, Some(bar)),
        points,
    }
}

fn heat_table(label: &str, names: &[String], values: &[Option<f64>]) -> Table {
    let n = names.len();
    let mut points = Table::new("points", "", "row; column; value");
    label.clone_into(&mut points.columns[2].heading);
    for (at, value) in values.iter().enumerate() {
        let value = known(*value, "never met, or itself");
        points.push(cells![&names[at / n], &names[at % n], value]);
    }
    points
}

/// From nearly white to deep blue.
fn shade(share: f64) -> [u8; 3] {
    let (light, dark) = ([247.0, 250.0, 253.0], [8.0, 48.0, 107.0]);
    let mix = |i: usize| light[i] + (dark[i] - light[i]) * share.clamp(0.0, 1.0);
    [0, 1, 2].map(|i| to_whole(mix(i).round()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_lies_on_a_dot_or_on_another_name() {
        let places = [
            [0.0, 0.0],
            [0.12, 0.0],
            [0.0, 0.05],
            [-0.4, 0.1],
            [0.5, -0.3],
        ];
        let names: Vec<String> = (0..5).map(|at| format!("textile-{at}")).collect();
        let found = labels(&names, &places, 400.0);
        let boxes: Vec<[f64; 4]> = found
            .iter()
            .map(|one| {
                [
                    one.at[0] * 400.0,
                    one.at[1] * 400.0,
                    9.0 * LETTER_PX,
                    LABEL_PX,
                ]
            })
            .collect();
        for (i, label) in boxes.iter().enumerate() {
            let dots = places.map(|[x, y]| [x * 400.0, y * 400.0, 3.0, 3.0]);
            assert!(!dots.iter().any(|dot| touch(label, dot)), "{i} on a dot");
            assert!(
                !boxes[i + 1..].iter().any(|other| touch(label, other)),
                "{i} on a name"
            );
        }
    }
}
