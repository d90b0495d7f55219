//! Whole figures: what is drawn, what is left out, the same bytes twice.

use super::*;

fn sample() -> Chart {
    let line = |name: &str, points: &[[f64; 2]], style| Series {
        name: name.to_owned(),
        points: points.to_vec(),
        style,
        ..Series::default()
    };
    let mut table = line("table", &[[2e-7, 0.04], [4e-7, 0.005]], Style::LineAndDots);
    table.marked = vec![0];
    Chart {
        title: "Rendering: level error against time a tick".to_owned(),
        x: Axis::log("CPU time a tick, s"),
        y: Axis::log("level error, dB"),
        series: vec![
            table,
            line("banded", &[[3e-6, 0.01], [9e-6, 0.001]], Style::Dots),
            line("promised", &[[2e-7, 0.05], [9e-6, 0.05]], Style::Dashed),
        ],
        footnote: "Seed 1.".to_owned(),
        ..Chart::default()
    }
}

#[test]
fn a_figure_has_its_texts_dots_rings_and_dashes() {
    let svg = sample().to_svg();
    for text in [
        ">Rendering: level error against time a tick</text>",
        ">CPU time a tick</text>",
        ">level error, dB</text>",
        ">1 µs</text>",
        ">0.05</text>",
        ">banded</text>",
        ">Seed 1.</text>",
    ] {
        assert!(svg.contains(text), "{text}: {svg}");
    }
    assert_eq!(svg.matches("r=\"8\"").count(), 1, "one point is marked");
    assert_eq!(
        svg.matches("stroke-dasharray").count(),
        2,
        "a line and its legend"
    );
    assert!(!svg.contains("left out"), "nothing is left out");
}

#[test]
fn points_stand_where_their_values_are() {
    let mut plot = sample();
    plot.series = vec![Series {
        points: vec![[0.0, 0.0], [10.0, 100.0]],
        ..Series::default()
    }];
    plot.x = Axis::default();
    plot.y = Axis::default();
    let svg = plot.to_svg();
    assert!(
        svg.contains("<circle cx=\"76.00\" cy=\"426.00\" r=\"4\""),
        "{svg}"
    );
    assert!(
        svg.contains("<circle cx=\"840.00\" cy=\"66.00\" r=\"4\""),
        "{svg}"
    );
}

#[test]
fn the_same_plot_gives_the_same_bytes() {
    assert_eq!(sample().to_svg(), sample().to_svg());
    let pixels = || sample().to_pixels(430).unwrap();
    assert_eq!(pixels(), pixels());
}

#[test]
fn points_without_a_place_are_left_out_and_counted() {
    let mut plot = sample();
    let wrong = [0.0, -1.0, f64::NAN, f64::INFINITY].map(|y| [1e-6, y]);
    plot.series[0].points.extend(wrong);
    let svg = plot.to_svg();
    assert!(
        svg.contains("Seed 1. 4 points have no place on these axes"),
        "{svg}"
    );
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    plot.series[0].points.truncate(3);
    assert!(plot.to_svg().contains("1 point has no place"));
}

#[test]
fn empty_and_senseless_plots_are_still_figures() {
    let nan = Series {
        name: "\u{0}<script>".to_owned(),
        points: vec![[f64::NAN; 2]; 3],
        style: Style::Line,
        marked: vec![0, 99],
        ..Series::default()
    };
    let senseless = Chart {
        title: "a < b & \"c\"".to_owned(),
        series: vec![nan],
        ..Chart::default()
    };
    for plot in [Chart::default(), senseless] {
        let svg = plot.to_svg();
        assert!(!svg.contains("NaN") && !svg.contains("<script"), "{svg}");
        let pixels = plot.to_pixels(300).unwrap();
        assert_eq!(pixels.rgba.len(), pixels.width * pixels.height * 4);
    }
}

#[test]
fn pixels_show_ink_on_white_at_the_width_asked_for() {
    let pixels = sample().to_pixels(860).unwrap();
    assert_eq!(pixels.width, 860);
    assert_eq!(pixels.rgba[..4], [255, 255, 255, 255]);
    let dark_in = |rows: std::ops::Range<usize>| {
        let bytes = &pixels.rgba[rows.start * 860 * 4..rows.end * 860 * 4];
        bytes.chunks_exact(4).filter(|pixel| pixel[0] < 128).count()
    };
    assert!(dark_in(12..32) > 300, "the title is drawn with its letters");
    assert!(sample().to_pixels(0).is_err() && sample().to_pixels(1 << 20).is_err());
}
