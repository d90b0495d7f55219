//! How long things take on the link to the device.

use crate::bench::export::origin::Origin;
use crate::bench::export::{Exported, Sheet};
use crate::bench::view::LinkTiming;
use selvedge_chart::{Axis, Chart, Ink, Row, Series, Style};
use selvedge_device::{Distribution, DistributionBar};

/// Both distributions of the pane; `None` where nothing was measured.
pub(crate) fn distributions(timing: &LinkTiming, origin: Origin) -> Option<Exported> {
    let both = [
        ("round trip", &timing.round_trip),
        ("frame interval", &timing.frame_interval),
    ];
    if both
        .iter()
        .all(|(_, distribution)| distribution.spread.n == 0)
    {
        return None;
    }
    let bars: Vec<(&str, DistributionBar)> = both
        .iter()
        .flat_map(|(name, distribution)| distribution.bars().map(|bar| (*name, bar)))
        .collect();
    let column = |of: fn(&DistributionBar) -> f64| -> Vec<f64> {
        bars.iter().map(|(_, bar)| of(bar)).collect()
    };
    let names: Vec<String> = bars.iter().map(|(name, _)| (*name).to_owned()).collect();
    let counts: Vec<u64> = bars.iter().map(|(_, bar)| u64::from(bar.count)).collect();
    let sheet = Sheet::default()
        .with("of", names)
        .with("from_s", column(|bar| bar.from.as_secs_f64()))
        .with("to_s", column(|bar| bar.to.as_secs_f64()))
        .with("count", counts);
    let panels = both.map(|(name, distribution)| chart(name, distribution));
    let row = Row {
        panels: panels.into(),
        height_px: 300.0,
        bar: None,
    };
    let origin = both
        .into_iter()
        .fold(origin, |origin, (name, distribution)| {
            let spread = distribution.spread;
            let [median, p99, max] =
                [spread.median, spread.p99, spread.max].map(|time| time.as_secs_f64().to_string());
            let key = if name == "round trip" {
                "round_trip_median_p99_max_s"
            } else {
                "frame_interval_median_p99_max_s"
            };
            origin.and(key, &format!("{median} {p99} {max}"), "")
        });
    let note = "Bars of a quarter of an octave. Round trip: from a PING to its answer. Frame \
                interval: from the end of one frame's write to the end of the next.";
    let title = "Times on the link to the device".to_owned();
    Some(Exported::new(title, sheet, vec![row], note, origin))
}

/// How often a thing took how long.
pub(crate) fn chart(name: &str, distribution: &Distribution) -> Chart {
    let heard = distribution.bars().filter(|bar| bar.count > 0);
    let points: Vec<[f64; 2]> = heard
        .map(|bar| {
            let [from, to] = [bar.from, bar.to].map(|edge| edge.as_secs_f64());
            [(from.max(0.5 * to) * to).sqrt(), f64::from(bar.count)]
        })
        .collect();
    let most = points.iter().map(|[_, count]| *count).fold(1.0, f64::max);
    Chart {
        title: name.to_owned(),
        x: Axis::log("time, s").within([3e-5, 0.3]),
        y: Axis::linear("how often").within([0.0, 1.05 * most]),
        series: vec![Series {
            points,
            style: Style::Stems,
            ink: Ink::Black,
            ..Series::default()
        }],
        ..Chart::default()
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn there_is_nothing_to_export_before_anything_was_measured() {
        let nothing = distributions(&LinkTiming::default(), Origin::default());
        assert_eq!(nothing, None);
    }

    #[test]
    fn every_duration_is_in_a_row_of_the_table_and_a_stem_of_the_figure() {
        let ms = Duration::from_millis;
        let timing = LinkTiming {
            round_trip: Distribution::of(&[ms(1), ms(1), ms(9)]),
            frame_interval: Distribution::of(&[ms(25); 40]),
            ..LinkTiming::default()
        };
        let exported = distributions(&timing, Origin::default()).unwrap();
        let path = std::path::Path::new("link.csv");
        let csv = exported
            .sheet
            .to_csv(&exported.origin.pairs(), path)
            .unwrap();
        let csv = String::from_utf8(csv).unwrap();
        let counts: u32 = csv
            .lines()
            .filter_map(|line| line.split(',').nth(3)?.parse::<u32>().ok())
            .sum();
        assert_eq!(counts, 43, "{csv}");
        assert!(csv.contains("frame interval,") && csv.contains("round_trip_median"));
        let stems = exported.figure.rows[0].panels[0].series[0].points.len();
        assert_eq!(stems, 2, "two sizes of round trips");
    }
}
