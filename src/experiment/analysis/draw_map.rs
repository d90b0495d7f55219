//! Maps of named points, and squares of colours.

use super::draw::{figure, list};
use super::model::{Cell, Drawn, Table, cells, known};
use selvedge_chart::{
    Axis, Chart, ColourBar, Ink, Raster, Scale, Series, Style, Tone, Upright, Weight, Words,
};
use selvedge_statistics::properties::Ellipse;

/// Corners of an ellipse.
const N_CORNERS: u32 = 48;

/// A map of named points with ellipses around them and directions in which measures rise.
pub(super) struct MapDrawing<'a> {
    pub(super) names: &'a [String],
    pub(super) points: &'a [Vec<f64>],
    pub(super) axes: [&'a str; 2],
    pub(super) ellipses: &'a [Ellipse],
    /// Name and direction, as long as its multiple correlation.
    pub(super) directions: &'a [(String, [f64; 2])],
}

impl MapDrawing<'_> {
    /// The drawing of a plane map; on a line, the second axis is 0.
    pub(super) fn drawn(&self, key: &str, title: &str, notes: Vec<String>) -> Drawn {
        let at = |p: &[f64]| {
            [
                p.first().copied().unwrap_or(0.0),
                p.get(1).copied().unwrap_or(0.0),
            ]
        };
        let places: Vec<[f64; 2]> = self.points.iter().map(|p| at(p)).collect();
        let mut series: Vec<Series> = self.ellipses.iter().map(outline).collect();
        let mut words = Vec::new();
        for (name, direction) in self.directions {
            series.push(Series {
                weight: Weight::Bold,
                ..Series::of(name, Style::Line, [[0.0; 2], *direction])
            });
        }
        series.push(Series {
            points: places.clone(),
            ink: Ink::Black,
            ..Series::default()
        });
        for (name, place) in self.names.iter().zip(&places) {
            words.push(Words {
                at: *place,
                text: name.clone(),
                tone: Tone::Aside,
            });
        }
        let corners = series.iter().flat_map(|s| s.points.iter().flatten());
        let reach = 1.12 * corners.fold(0.5_f64, |most, x| most.max(x.abs()));
        // Both axes to one scale: a frame is about 1.6 times as wide as it is high.
        let height_px = 520.0;
        let wide = reach * 780.0 / height_px;
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
        let mut figure = figure(title, vec![panel], height_px, None);
        figure.notes = notes;
        Drawn {
            key: key.to_owned(),
            figure,
            points: self.table(),
        }
    }

    fn table(&self) -> Table {
        let columns = [
            ("name", ""),
            ("x1", "x₁"),
            ("x2", "x₂"),
            ("ellipse_x1", "middle x₁"),
            ("ellipse_x2", "middle x₂"),
            ("half_axis_1", "half axis"),
            ("half_axis_2", "half axis"),
            ("angle_deg", "angle, °"),
        ];
        let mut table = Table::new("points", "", &columns);
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

fn outline(ellipse: &Ellipse) -> Series {
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
        ink: Ink::Grey,
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
    let columns = [("row", "row"), ("column", "column"), ("value", label)];
    let mut points = Table::new("points", "", &columns);
    for (at, value) in values.iter().enumerate() {
        let value = known(*value, "never met, or itself");
        points.push(cells![&names[at / n], &names[at % n], value]);
    }
    points
}

/// From nearly white to deep blue.
fn shade(share: f64) -> [u8; 3] {
    let (light, dark) = ([247.0, 250.0, 253.0], [8.0, 48.0, 107.0]);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and 255"
    )]
    let mix = |i: usize| (light[i] + (dark[i] - light[i]) * share.clamp(0.0, 1.0)).round() as u8;
    [0, 1, 2].map(mix)
}
