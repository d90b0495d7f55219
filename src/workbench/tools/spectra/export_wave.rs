//! The drive waveform: the last two ticks of what drives a contactor.

use crate::bench::export::Exported;
use crate::bench::export::origin::Origin;
use crate::bench::export::sheet::Sheet;
use crate::tools::spectra::export_spectrograms::ink;
use crate::tools::spectra::wave::{DriveWaveView, WaveScale};
use selvedge_chart::{At, Axis, Extent, Ink, Panel, Row, Rule, Series, Style, Weight};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// Samples a millisecond: 62 in a cycle of 320 Hz.
const SAMPLES_PER_MS: u32 = 20;
/// What is shown, ms.
const SHOWN_MS: u32 = 50;

/// Time, s, and both waves, µm.
type Sample = [f64; 3];

/// The waveform on the axis that the pane has.
pub(crate) fn waveform(
    view: &DriveWaveView,
    scale: WaveScale,
    contactor: usize,
    tick: u64,
    origin: Origin,
) -> Exported {
    let view = view.finite();
    let samples: Vec<Sample> = (0..=SHOWN_MS * SAMPLES_PER_MS)
        .map(|sample| {
            let t_ms = f64::from(sample) / f64::from(SAMPLES_PER_MS);
            let waves_um = view.waves_um(t_ms);
            [t_ms * 1e-3, waves_um[0], waves_um[1]]
        })
        .collect();
    let column = |of: &dyn Fn(&Sample) -> f64| -> Vec<f64> { samples.iter().map(of).collect() };
    let sheet = Sheet::default()
        .with("t_s", column(&|sample| sample[0]))
        .with("wave_40_um", column(&|sample| sample[1]))
        .with("wave_320_um", column(&|sample| sample[2]))
        .with("sum_um", column(&|sample| sample[1] + sample[2]));
    let row = Row {
        panels: vec![panel(&samples, &view, scale.most_um().max(view.reach_um()))],
        height_px: 300.0,
        bar: None,
    };
    let [low, high] = view.limit_um.map(|um| quantity::with_unit(um, 1, "µm"));
    let note = format!(
        "The last two ticks of the drive, after gains and before output limits ({low} at 40 Hz, \
         {high} at 320 Hz, dashed where they lie on the axis); amplitudes change at ticks, where \
         both waves cross zero."
    );
    let origin = told(origin.of_contactor(contactor), &view);
    let origin = origin.in_ticks([tick.saturating_sub(1), tick].into_iter());
    let title = format!("Waveform that drives contactor {contactor}");
    Exported::new(title, sheet, vec![row], &note, origin)
}

fn panel(samples: &[Sample], view: &DriveWaveView, most_um: f64) -> Panel {
    let series = |name: &str, ink, weight, of: &dyn Fn(&Sample) -> f64| Series {
        name: name.to_owned(),
        points: samples
            .iter()
            .map(|sample| [sample[0], of(sample)])
            .collect(),
        style: Style::Line,
        ink,
        weight,
        ..Series::default()
    };
    Panel {
        x: Axis::linear("time, s").within([0.0, f64::from(SHOWN_MS) * 1e-3]),
        y: Axis::linear("displacement, µm").within([-most_um, most_um]),
        series: vec![
            series("40 Hz", Ink::Amber, Weight::Normal, &|sample| sample[1]),
            series("320 Hz", Ink::Cyan, Weight::Normal, &|sample| sample[2]),
            series("sum", Ink::Black, Weight::Thin, &|sample| {
                sample[1] + sample[2]
            }),
        ],
        rules: limits(view.limit_um, most_um),
        ..Panel::default()
    }
}

/// The amplitudes of both ticks.
fn told(origin: Origin, view: &DriveWaveView) -> Origin {
    let pair = |[low, high]: [f64; 2]| format!("{low} and {high}");
    origin
        .and("amplitudes_before_um", &pair(view.before_um), "")
        .and("amplitudes_now_um", &pair(view.now_um), "")
        .and("limits_um", &pair(view.limit_um), "")
}

fn limits(limit_um: [f64; 2], most_um: f64) -> Vec<Rule> {
    let of = |band: Band| {
        let um = limit_um[band.index()];
        let rule = |um| Rule {
            at: At::Y(um),
            ink: ink(band),
            extent: Extent::Dashed,
            ..Rule::default()
        };
        let is_on_axis = um > 0.0 && um <= most_um;
        is_on_axis.then(|| [rule(-um), rule(um)])
    };
    Band::ALL.into_iter().filter_map(of).flatten().collect()
}
