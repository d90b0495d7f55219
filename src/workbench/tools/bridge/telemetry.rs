//! What the device measures of itself, and how loud it is beside what our own frames allow.

use eframe::egui::{Rect, Role, Sense, Ui, WidgetInfo, vec2};

use crate::bench::view::{BridgeView, Telemetry};
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::quiet_pair;
use selvedge_foundation::numerics::to_single;
use selvedge_foundation::quantity;

/// Height of the bar of output, points.
const BAR: f32 = 6.0;

/// What matters while the part is folded away.
pub(crate) fn summary(bridge: Option<&BridgeView>) -> String {
    let telemetry = bridge.and_then(|bridge| bridge.telemetry);
    telemetry.map_or_else(String::new, |now| {
        let [volts, celsius] = [now.high_v, now.celsius].map(|value| quantity::fixed(value, 1));
        format!("{volts} V, {} mA, {celsius} °C", now.current_ma)
    })
}

/// Shows it.
pub(crate) fn show(ui: &mut Ui, bridge: Option<&BridgeView>) {
    let telemetry = bridge.and_then(|bridge| bridge.telemetry);
    let of =
        |pick: fn(&Telemetry) -> String| telemetry.as_ref().map_or_else(|| "–".to_owned(), pick);
    ui.columns_const(|[left, right]: &mut [Ui; 2]| {
        let volts = of(|now| quantity::fixed(now.high_v, 1));
        let tip = "Measured by the device; output ends where it is 10 % and 2 V above what is in \
                   force";
        quiet_pair(left, "High voltage", &volts, "V").on_hover_text(tip);
        let tip = "Measured by the device; judged where the array states i_ma_max";
        let current = of(|now| now.current_ma.to_string());
        quiet_pair(right, "Current", &current, "mA").on_hover_text(tip);
    });
    ui.columns_const(|[left, right]: &mut [Ui; 2]| {
        let tip = "Output ends outside −10 to 70 °C, or what the array states as temperature_c";
        let celsius = of(|now| quantity::fixed(now.celsius, 1));
        quiet_pair(left, "Temperature", &celsius, "°C").on_hover_text(tip);
        let tip = "Sum of all drive codes that the device says it puts out";
        quiet_pair(right, "Output", &of(|now| now.codes.to_string()), "").on_hover_text(tip);
    });
    let most = of(|now| quantity::fixed(now.most_codes, 0));
    let tip = "The largest sum of drive codes that our own frames allow the device at this tick; \
               output above it ends the session";
    quiet_pair(ui, "Output allowed by our frames", &most, "").on_hover_text(tip);
    show_bar(ui, telemetry.as_ref());
}

/// Output as a part of what is allowed.
fn show_bar(ui: &mut Ui, telemetry: Option<&Telemetry>) {
    let palette = Palette::in_ui(ui);
    let size = vec2(ui.available_width(), BAR);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    ui.painter().rect_filled(rect, 2, palette.line);
    if let Some(part) = telemetry.and_then(part) {
        let filled = Rect::from_min_size(rect.min, vec2(rect.width() * part.min(1.0), BAR));
        let ink = if part > 1.01 {
            palette.danger
        } else {
            palette.text
        };
        ui.painter().rect_filled(filled, 2, ink);
        let words = format!("Output {:.0} % of what is allowed", 100.0 * part);
        response.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, &words));
        response.on_hover_text(words);
    }
    ui.add_space(STEP);
}

/// Output over what is allowed; `None` where nothing is.
fn part(now: &Telemetry) -> Option<f32> {
    (now.most_codes > 0.0).then(|| to_single(f64::from(now.codes) / now.most_codes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_measured_stands_beside_the_name_and_nothing_before_the_first_status() {
        assert_eq!(summary(None), "");
        let now = Telemetry {
            high_v: 59.96,
            current_ma: 12,
            celsius: 24.84,
            codes: 500,
            most_codes: 1000.0,
        };
        let bridge = BridgeView {
            telemetry: Some(now),
            ..BridgeView::default()
        };
        assert_eq!(summary(Some(&bridge)), "60.0 V, 12 mA, 24.8 °C");
        assert_eq!(part(&now), Some(0.5));
        let silent = Telemetry {
            most_codes: 0.0,
            ..now
        };
        assert_eq!(part(&silent), None);
    }
}
