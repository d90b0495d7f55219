//! Figures of panels: what is drawn where, and that the picture shows what the SVG says.

use super::*;

/// A raster of many cells, red where the column is even, with one column of nothing.
fn stripes(n_columns: usize, n_rows: usize) -> Raster {
    let cell = |i: usize| match i % n_columns {
        0 => None,
        column if column % 2 == 0 => Some([255, 0, 0]),
        _ => Some([0, 0, 255]),
    };
    Raster {
        n_columns,
        cells: (0..n_columns * n_rows).map(cell).collect(),
    }
}

fn sample(raster: Raster) -> Figure {
    let picture = Chart {
        x: Axis::linear("time, s").within([-8.0, 0.0]),
        y: Axis::log("frequency, Hz").within([10.0, 1000.0]),
        width: 6.0,
        raster: Some(raster),
        rules: vec![Rule {
            at: At::Y(320.0),
            label: "320 Hz".to_owned(),
            ink: Ink::Cyan,
            extent: Extent::Edge,
        }],
        ..Chart::default()
    };
    let strip = Chart {
        x: Axis::linear("gain").within([0.0, 1.0]),
        y: Axis::log("frequency, Hz").within([10.0, 1000.0]),
        upright: Upright::Shared,
        series: vec![Series {
            name: "40 Hz".to_owned(),
            points: vec![[0.1, 10.0], [1.0, 40.0], [0.1, 160.0]],
            style: Style::Line,
            ..Series::default()
        }],
        ..Chart::default()
    };
    Figure {
        title: "Spectra <of> contactor 9".to_owned(),
        rows: vec![Row {
            panels: vec![picture, strip],
            height_px: 240.0,
            bar: Some(ColourBar {
                axis: Axis::linear("level, dB re 1 µm").within([-40.0, 20.0]),
                colours: vec![[0, 0, 255], [255, 0, 0]],
            }),
        }],
        notes: vec!["Program 1.0".to_owned()],
        about: vec![("program".to_owned(), "a & b\n1.0".to_owned())],
    }
}

#[test]
fn a_figure_has_its_panels_bar_legend_notes_and_provenance() {
    let svg = sample(stripes(320, 96)).to_svg().unwrap();
    for part in [
        ">Spectra &lt;of&gt; contactor 9</text>",
        ">time</text>",
        ">−8 s</text>",
        ">1 kHz</text>",
        ">level, dB re 1 µm</text>",
        ">40 Hz</text>",
        ">320 Hz</text>",
        ">Program 1.0</text>",
        "<desc>program = a &amp; b 1.0\n</desc>",
        "<linearGradient id=\"bar0\"",
        "href=\"data:image/png;base64,",
    ] {
        assert!(svg.contains(part), "{part}: {svg}");
    }
    assert_eq!(svg.matches("<clipPath").count(), 2, "one a panel");
    assert_eq!(
        svg.matches(">1 kHz</text>").count(),
        1,
        "the axis is shared"
    );
    assert!(svg.len() < 30_000, "{} bytes", svg.len());
}

#[test]
fn few_cells_are_rectangles_and_many_are_one_picture() {
    let few = sample(stripes(4, 6)).to_svg().unwrap();
    assert!(!few.contains("<image"), "{few}");
    assert_eq!(few.matches("fill=\"#0000ff\"").count(), 12, "two a row");
    let many = sample(stripes(320, 96)).to_svg().unwrap();
    assert_eq!(many.matches("<image").count(), 1);
}

#[test]
fn pixels_show_every_cell_of_a_raster_with_its_axes() {
    for (n_columns, n_rows) in [(4, 6), (320, 96)] {
        let figure = sample(stripes(n_columns, n_rows));
        let pixels = figure.to_pixels(1720).unwrap();
        assert_eq!(pixels.width, 1720);
        let n_of = |wanted: [u8; 3]| {
            let pixels = pixels.rgba.chunks_exact(4);
            pixels.filter(|pixel| pixel[..3] == wanted).count()
        };
        let (red, blue) = (n_of([255, 0, 0]), n_of([0, 0, 255]));
        assert!(red > 100_000 && blue > 100_000, "{red} red, {blue} blue");
        let more_blue = blue as f64 / red as f64;
        // Of 4 columns one is nothing, one red and two blue. Of 320 half are of either, and each is
        // three or four pixels wide.
        let (expected, within) = if n_columns == 4 {
            (2.0, 0.02)
        } else {
            (1.0, 0.35)
        };
        assert!((more_blue - expected).abs() < within, "{more_blue}");
        assert_eq!(figure.to_pixels(1720).unwrap(), pixels, "the same bytes");
    }
}

#[test]
fn rows_grow_downward_where_a_table_is_drawn() {
    let mut figure = sample(stripes(4, 6));
    let panel = &mut figure.rows[0].panels[0];
    panel.upright = Upright::Downward;
    panel.x = Axis::whole("column").within([-0.5, 3.5]);
    panel.y = Axis::whole("row").within([-0.5, 5.5]);
    panel.words = vec![Words {
        at: [0.0, 0.0],
        text: "first".to_owned(),
        tone: Tone::Dark,
    }];
    let svg = figure.to_svg().unwrap();
    let y_of = |word: &str| -> f64 {
        let before = svg.split(&format!(">{word}</text>")).next().unwrap();
        let y = before.rsplit("y=\"").next().unwrap();
        y.split('"').next().unwrap().parse().unwrap()
    };
    assert!(y_of("first") < y_of("5"), "row 0 is at the top: {svg}");
    for row in 0..6 {
        assert!(svg.contains(&format!(">{row}</text>")), "{row}");
    }
}

#[test]
fn nothing_senseless_harms_a_figure() {
    let nan = Series {
        name: "\u{0}<x>".to_owned(),
        points: vec![[f64::NAN; 2], [1.0, f64::INFINITY]],
        style: Style::Stems,
        ..Series::default()
    };
    let mut odd = sample(stripes(320, 96));
    odd.rows[0].panels[1].series = vec![nan];
    odd.rows[0].panels[0].rules[0].at = At::X(f64::NAN);
    odd.rows[0].bar = Some(ColourBar::default());
    for figure in [Figure::default(), odd] {
        let svg = figure.to_svg().unwrap();
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        assert!(figure.to_pixels(300).is_ok());
    }
    let empty = sample(Raster::default());
    assert!(empty.to_svg().is_ok(), "no cells are no rectangles");
}

#[test]
fn on_a_dark_ground_a_figure_has_no_paper_and_bright_letters() {
    let figure = sample(stripes(4, 6));
    let [white, dark] =
        [Paper::White, Paper::OnDark].map(|on| figure.to_pixels_on(on, 860).unwrap());
    let [width_px, height_px] = figure.size_px();
    assert_eq!([dark.width, dark.height], [white.width, white.height]);
    assert!((dark.width as f64 - width_px).abs() < 1.0 && dark.height as f64 >= height_px.floor());
    assert_eq!((white.rgba[3], dark.rgba[3]), (255, 0), "nothing behind");
    let title = |pixels: &Pixels, is_ink: fn(&[u8]) -> bool| {
        let rows = pixels.rgba.chunks_exact(4).take(36 * pixels.width);
        rows.filter(|pixel| pixel[3] > 200 && is_ink(pixel)).count()
    };
    let (is_dark, is_bright) = (|p: &[u8]| p[0] < 90, |p: &[u8]| p[0] > 200);
    assert!(title(&white, is_dark) > 100, "dark letters on white");
    assert!(title(&dark, is_bright) > 100, "bright letters on nothing");
    assert_eq!(title(&dark, is_dark), 0);
    let red = |pixels: &Pixels| {
        let pixels = pixels.rgba.chunks_exact(4);
        pixels.filter(|p| **p == [255, 0, 0, 255]).count()
    };
    assert_eq!(red(&white), red(&dark), "cells keep their colours");
}
