//! How long things take on the link: round trips and frame intervals as distributions, how late a
//! frame may be made, and where all that happens is written down.

use std::time::Duration;

use eframe::egui::{Label, Margin, Role, Sense, Ui, WidgetInfo, vec2};

use crate::bench::command::Commands;
use crate::bench::command::device::DeviceCommand;
use crate::bench::view::{BridgeView, LinkTiming};
use crate::kit::pane::paint_sentence;
use crate::kit::plot;
use crate::kit::plot::Setting;
use crate::kit::theme::Palette;
use crate::kit::widgets::text::{button, field_row, quiet, quiet_pair, small};
use crate::tools::bridge::export::chart;
use selvedge_device::{BridgeState, Distribution, Spread};
use selvedge_foundation::quantity;

/// Height of a distribution, points.
const HEIGHT: f32 = 54.0;
/// Room around it for its axis, points.
const MARGIN: Margin = Margin {
    left: 2,
    right: 2,
    top: 2,
    bottom: 16,
};

/// What matters of the times while they are folded away.
pub(crate) fn summary(bridge: Option<&BridgeView>) -> String {
    let round_trip = bridge.map(|bridge| bridge.timing.round_trip.spread);
    let measured = round_trip.filter(|spread| spread.n > 0);
    measured.map_or_else(String::new, |spread| {
        format!("round trip {} ms", milliseconds(spread.median))
    })
}

/// A way out of a fault whose cause is gone.
pub(crate) fn show_fault(ui: &mut Ui, bridge: Option<&BridgeView>, commands: &mut Commands) {
    if bridge.is_some_and(|bridge| bridge.state == BridgeState::Faulted.label()) {
        let tip = "Ask the device to clear the fault; while its cause lasts it refuses. Arming is \
                   a step of its own";
        if button(ui, "Clear the fault", tip, None) {
            commands.push(DeviceCommand::ClearFaults.into());
        }
    }
}

/// Shows what is measured on the link.
pub(crate) fn show(ui: &mut Ui, bridge: Option<&BridgeView>, commands: &mut Commands) {
    let none = LinkTiming::default();
    let timing = bridge.map_or(&none, |bridge| &bridge.timing);
    show_latching(ui, timing);
    ui.columns_const(|[left, right]: &mut [Ui; 2]| {
        let tip = "From a PING to its answer, asked once a second while frames are sent";
        show_distribution(left, "Round trip", &timing.round_trip, tip);
        let tip = "From the end of one frame's write to the end of the next";
        show_distribution(right, "Frame interval", &timing.frame_interval, tip);
    });
    show_log(ui, timing, commands);
}

fn show_latching(ui: &mut Ui, timing: &LinkTiming) {
    let lead = timing.lead.map_or_else(|| "–".to_owned(), milliseconds);
    let rate = timing.clock.filter(|clock| clock.n_answers > 0);
    let rate = rate.map_or_else(
        || "–".to_owned(),
        |clock| quantity::fixed(clock.rate_ppm, 1),
    );
    ui.columns_const(|[left, right]: &mut [Ui; 2]| {
        let tip = "How long before the tick in which it is felt a frame is made: what 999 of 1000 \
                   frames needed until the device had them, and 3 ms";
        quiet_pair(left, "Made ahead", &lead, "ms").on_hover_text(tip);
        let tip = "How much faster than ours the device's clock runs, in parts per million; it \
                   paces, so this costs nothing";
        quiet_pair(right, "Device clock", &rate, "ppm").on_hover_text(tip);
    });
}

fn milliseconds(time: Duration) -> String {
    quantity::fixed(time.as_secs_f64() * 1e3, 2)
}

fn show_distribution(ui: &mut Ui, name: &str, distribution: &Distribution, tip: &str) {
    let title = quiet(name);
    ui.label(title).on_hover_text(tip);
    let size = vec2(ui.available_width(), HEIGHT);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let setting = Setting {
        name,
        margin: MARGIN,
        wheel: false,
        hover: false,
        has_legend: false,
        ..Setting::default()
    };
    if let Some(shown) = plot::show(ui, rect, &chart(name, distribution), &setting) {
        let words = words(name, &distribution.spread);
        let response = shown.response;
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, &words));
        response.on_hover_text(&words);
    }
    if distribution.spread.n == 0 {
        paint_sentence(ui.painter(), rect - MARGIN, "none yet");
    }
    let Spread {
        median,
        p99,
        max,
        n,
    } = distribution.spread;
    for (name, time) in [("median", median), ("99 %", p99), ("longest", max)] {
        let value = if n == 0 {
            "–".to_owned()
        } else {
            milliseconds(time)
        };
        quiet_pair(ui, name, &value, "ms");
    }
}

fn words(name: &str, spread: &Spread) -> String {
    if spread.n == 0 {
        return format!("{name}: nothing was measured yet");
    }
    let [median, p99, max] = [spread.median, spread.p99, spread.max].map(milliseconds);
    format!(
        "{name}: median {median} ms, 99 of 100 within {p99} ms, longest {max} ms, of {}",
        spread.n
    )
}

/// Where the log of the links is, and why it is not whole if so.
fn show_log(ui: &mut Ui, timing: &LinkTiming, commands: &mut Commands) {
    let Some(path) = &timing.log else { return };
    let palette = Palette::in_ui(ui);
    field_row(ui, "Session log", |ui| {
        let tip = "Copy the path of the log: every setting, arming, stop, fault, refusal and \
                   change of a counter, one line each; five files of 1 MB are kept";
        if button(ui, "Copy path", tip, None) {
            commands.push(DeviceCommand::CopyLogPath.into());
        }
        if button(
            ui,
            "Open folder",
            "Show the log's folder in the file manager",
            None,
        ) {
            commands.push(DeviceCommand::OpenLogFolder.into());
        }
    });
    let (words, ink) = match &timing.log_failure {
        Some(why) => (format!("not written: {why}"), palette.danger),
        None => (path.clone(), palette.dim),
    };
    let label = Label::new(small(&words, ink));
    ui.add(label.truncate()).on_hover_text(words);
}

/// Whether another window that comes to the front stops the device.
pub(crate) fn show_focus(ui: &mut Ui, stops_on_focus_loss: bool, commands: &mut Commands) {
    let mut is_on = stops_on_focus_loss;
    let words = "All off when the focus is lost";
    let tip = "Stops an armed device as Esc does, as soon as this window loses the keyboard";
    if ui.checkbox(&mut is_on, words).on_hover_text(tip).changed() {
        commands.push(DeviceCommand::StopOnFocusLoss(is_on).into());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_distribution_is_told_in_numbers_or_as_empty() {
        let ms = Duration::from_millis;
        let spread = Spread {
            n: 40,
            median: ms(25),
            p99: ms(26),
            max: ms(31),
        };
        assert_eq!(
            words("Frame interval", &spread),
            "Frame interval: median 25.00 ms, 99 of 100 within 26.00 ms, longest 31.00 ms, of 40"
        );
        assert!(words("Round trip", &Spread::default()).ends_with("nothing was measured yet"));
    }
}
