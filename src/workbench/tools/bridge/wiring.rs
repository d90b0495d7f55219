//! Which channel drives which contactor: what is known of it, and the walk that finds it out.

use eframe::egui::{self, Align2, Painter, Rect, RichText, Sense, Stroke, Ui, WidgetInfo, vec2};

use crate::bench::arrays::wizard::{Wizard, WizardCommand};
use crate::bench::command::array::ArrayCommand;
use crate::bench::command::{Commands, Part, ShowCommand};
use crate::bench::query;
use crate::bench::view::BridgePhase;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::{button, paragraph, quiet, row};
use crate::tools::bridge::view::BridgePane;
use selvedge_device::DeviceUid;
use selvedge_device::wiring::{Answer, WiringFound};
use selvedge_foundation::numerics::{extent, to_single};

/// Height of the picture of the array, points.
const PICTURE: f32 = 190.0;
/// Largest dot of it, points.
const DOT: f32 = 13.0;

/// What matters of the wiring while it is folded away.
pub(crate) fn summary(view: &BridgePane<'_>) -> String {
    let profile = view.array.profile;
    let Some(wiring) = &profile.wiring else {
        return "not measured: straight".to_owned();
    };
    if doubt(view).is_some() {
        return "measured on another device".to_owned();
    }
    let elsewhere = |(contactor, channel): &(usize, &u16)| usize::from(**channel) != *contactor;
    match wiring.channels.iter().enumerate().filter(elsewhere).count() {
        0 => "measured: straight".to_owned(),
        n => format!("measured: {n} elsewhere"),
    }
}

fn connected(view: &BridgePane<'_>) -> Option<DeviceUid> {
    view.live.bridge.as_ref()?.uid
}

fn doubt(view: &BridgePane<'_>) -> Option<String> {
    view.array.profile.wiring_doubt(connected(view)?)
}

/// Shows what is known.
pub(crate) fn show(ui: &mut Ui, view: &BridgePane<'_>, commands: &mut Commands) {
    for line in lines(view) {
        paragraph(ui, quiet(line));
    }
    row(ui, "", |ui| {
        let tip = "Drive one channel after the other, and click the contactor that moves";
        if button(ui, "Identify channels…", tip, refusal(view)) {
            commands.push(ArrayCommand::Identify(WizardCommand::Begin).into());
        }
        let is_straight = view.array.profile.wiring.is_none();
        let refusal = is_straight.then_some("Nothing was measured");
        let tip = "Forget what was measured: channel 0 drives contactor 0, and so on";
        if button(ui, "Forget", tip, refusal) {
            commands.push(ArrayCommand::WireStraight.into());
        }
    });
}

/// Why channels cannot be identified now.
fn refusal(view: &BridgePane<'_>) -> Option<&'static str> {
    match view.live.bridge.as_ref() {
        None => Some("Connect a device first"),
        Some(bridge) if bridge.phase == BridgePhase::Armed => Some("Disarm the device first"),
        Some(bridge) if bridge.phase != BridgePhase::Ready => Some("The device is not ready"),
        Some(bridge) if !bridge.can_identify => Some("This device cannot drive one channel alone"),
        Some(_) => None,
    }
}

fn lines(view: &BridgePane<'_>) -> Vec<String> {
    let profile = view.array.profile;
    let Some(wiring) = &profile.wiring else {
        return vec!["Each contactor is taken to be on the channel of its number.".to_owned()];
    };
    let mut lines = vec![format!("Measured on device {}.", wiring.device_uid)];
    if doubt(view).is_some() {
        let connected = connected(view).map_or_else(String::new, |uid| uid.to_string());
        lines.push(format!(
            "The device that is connected is another one, {connected}: identify its channels again."
        ));
    }
    let wired = wiring.channels.iter().enumerate();
    let elsewhere = wired.filter(|(contactor, channel)| usize::from(**channel) != *contactor);
    let pairs: Vec<String> = elsewhere
        .map(|(contactor, channel)| format!("{contactor} on {channel}"))
        .collect();
    lines.push(if pairs.is_empty() {
        "Every contactor is on the channel of its number.".to_owned()
    } else {
        format!("Contactors on other channels: {}.", pairs.join(", "))
    });
    lines
}

/// Shows the walk over the channels.
pub(crate) fn show_wizard(
    ui: &mut Ui,
    wizard: &Wizard,
    view: &BridgePane<'_>,
    commands: &mut Commands,
) {
    let palette = Palette::in_ui(ui);
    let n = wizard.walk.n_channels();
    row(ui, "Identify channels", |ui| {
        let done = format!("{} of {n}", wizard.walk.n_answered());
        ui.label(RichText::new(done).font(theme::number()).color(palette.dim));
    });
    let is_armed = view.live.takes_ident();
    for words in instructions(wizard, is_armed) {
        paragraph(ui, RichText::new(words).color(palette.text));
    }
    if wizard.walk.channel().is_some() {
        show_array(ui, wizard, view, commands);
        show_answers(ui, wizard, is_armed, commands);
    } else {
        show_found(ui, wizard, commands);
    }
}

/// What to do now.
fn instructions(wizard: &Wizard, is_armed: bool) -> Vec<String> {
    let mut lines = Vec::new();
    for conflict in wizard.walk.conflicts() {
        let channels: Vec<String> = conflict.channels.iter().map(ToString::to_string).collect();
        lines.push(format!(
            "Channels {} were all felt on contactor {}: they are asked again. If both drive it, \
             answer \"nothing\" for the weaker one.",
            channels.join(" and "),
            conflict.contactor
        ));
    }
    lines.extend(twice_named(wizard));
    lines.extend(wizard.trouble.clone());
    lines.push(match wizard.walk.channel() {
        None => "This was found:".to_owned(),
        Some(_) if !is_armed => {
            "Arm the device to begin. One contactor at a time moves for 0.6 s, at half the limit \
             at 320 Hz; nothing else is played."
                .to_owned()
        }
        Some(channel) if wizard.driven != Some(channel) => {
            format!("Drive channel {channel}, and click the contactor that moves.")
        }
        Some(channel) => format!("Channel {channel} moved. Which contactor was it?"),
    });
    lines
}

/// Contactors that two channels were said to drive, while there are channels left to ask for.
fn twice_named(wizard: &Wizard) -> Vec<String> {
    let named = (0..wizard.walk.n_channels()).map(|contactor| {
        let channels = wizard.walk.channels_of(contactor);
        let numbers: Vec<String> = channels.iter().map(ToString::to_string).collect();
        (contactor, numbers)
    });
    let twice = named.filter(|(_, channels)| channels.len() > 1);
    let words = twice.map(|(contactor, channels)| {
        let channels = channels.join(" and ");
        format!("Channels {channels} are both on contactor {contactor}: they will be asked again.")
    });
    words.collect()
}

/// The array, whose contactors are the answers.
fn show_array(ui: &mut Ui, wizard: &Wizard, view: &BridgePane<'_>, commands: &mut Commands) {
    let palette = Palette::in_ui(ui);
    let size = vec2(ui.available_width(), PICTURE);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let (places, radius) = fitted(&view.array.places_mm, rect.shrink(DOT + STEP));
    let is_armed = view.live.takes_ident();
    for (contactor, at) in places.into_iter().enumerate() {
        let reach = Rect::from_center_size(at, vec2(2.0, 2.0) * (radius + 1.0));
        let id = ui.scope_id().with(("answer", contactor));
        let response = ui.interact(reach, id, Sense::click());
        let name = format!("It was contactor {contactor}");
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, is_armed, &name));
        let channels = wizard.walk.channels_of(contactor);
        let is_pointed = response.hovered() || response.has_focus();
        let dot = Dot {
            at,
            radius,
            channels: &channels,
            is_pointed,
            is_doubtful: channels.len() > 1
                || wizard
                    .walk
                    .conflicts()
                    .iter()
                    .any(|conflict| conflict.contactor == contactor),
        };
        dot.paint(ui.painter(), palette);
        if response.clicked() && is_armed {
            let answer = Answer::Contactor(contactor);
            commands.push(ArrayCommand::Identify(WizardCommand::Answer(answer)).into());
        }
        if response.hovered() {
            commands.push(ShowCommand::Hover(Part::Contactor(contactor)).into());
        }
        response.on_hover_text(dot_words(contactor, &channels));
    }
}

fn dot_words(contactor: usize, channels: &[usize]) -> String {
    let numbers: Vec<String> = channels.iter().map(ToString::to_string).collect();
    if numbers.is_empty() {
        format!("Contactor {contactor}: no channel yet")
    } else {
        format!("Contactor {contactor}: channel {}", numbers.join(" and "))
    }
}

/// A contactor as an answer.
struct Dot<'a> {
    at: egui::Pos2,
    radius: f32,
    channels: &'a [usize],
    is_pointed: bool,
    is_doubtful: bool,
}

impl Dot<'_> {
    fn paint(&self, painter: &Painter, palette: &Palette) {
        let Self { at, radius, .. } = *self;
        let ring = Stroke::new(1.25, palette.contactor);
        if self.channels.is_empty() {
            painter.circle_stroke(at, radius, ring);
        } else {
            painter.circle_filled(at, radius, palette.contactor);
            let numbers: Vec<String> = self.channels.iter().map(ToString::to_string).collect();
            let font = theme::small_number();
            let words = numbers.join(" ");
            painter.text(at, Align2::CENTER_CENTER, words, font, palette.panel);
        }
        if self.is_pointed || self.is_doubtful {
            let strength = if self.is_pointed { 1.0 } else { 0.6 };
            let edge = Stroke::new(1.5, palette.selection.gamma_multiply(strength));
            painter.circle_stroke(at, radius + 2.5, edge);
        }
    }
}

/// Places on the screen of contactors in mm, as large as fits, and the radius of their dots.
fn fitted(places_mm: &[[f64; 2]], rect: Rect) -> (Vec<egui::Pos2>, f32) {
    let reach = |axis: usize| {
        let [least, most] = extent(places_mm.iter().map(|place| place[axis]));
        if most < least {
            [0.0; 2]
        } else {
            [least, most]
        }
    };
    let [[left, right], [bottom, top]] = [reach(0), reach(1)];
    let across = f64::from(rect.width()) / (right - left).max(1e-6);
    let up = f64::from(rect.height()) / (top - bottom).max(1e-6);
    let points_per_mm = across.min(up).min(22.0);
    let place = |mm: &[f64; 2]| {
        let x = (mm[0] - 0.5 * (left + right)) * points_per_mm;
        let y = (0.5 * (bottom + top) - mm[1]) * points_per_mm;
        rect.center() + vec2(to_single(x), to_single(y))
    };
    let nearest = nearest_mm(places_mm);
    let radius = to_single(0.40 * nearest * points_per_mm);
    (
        places_mm.iter().map(place).collect(),
        radius.clamp(2.0, DOT),
    )
}

/// The smallest distance between two places, mm.
fn nearest_mm(places_mm: &[[f64; 2]]) -> f64 {
    let pairs = places_mm.iter().enumerate().flat_map(|(at, a)| {
        let others = places_mm.get(at + 1..).unwrap_or_default().iter();
        others.map(move |b| (a[0] - b[0]).hypot(a[1] - b[1]))
    });
    let nearest = pairs.fold(f64::MAX, f64::min);
    if nearest < f64::MAX { nearest } else { 2.0 }
}

fn show_answers(ui: &mut Ui, wizard: &Wizard, is_armed: bool, commands: &mut Commands) {
    let mut wish = |command| commands.push(ArrayCommand::Identify(command).into());
    let unarmed = (!is_armed).then_some("Arm the device first");
    row(ui, "", |ui| {
        if button(
            ui,
            "End",
            "End without keeping anything; the device is disarmed",
            None,
        ) {
            wish(WizardCommand::End);
        }
        let is_first = wizard.walk.channel() == Some(0);
        let refusal = unarmed.or_else(|| is_first.then_some("This is the first channel"));
        if button(ui, "Back", "Ask for the channel before again", refusal) {
            wish(WizardCommand::Back);
        }
        if button(ui, "Nothing", "Nothing moved: the channel is dead", unarmed) {
            wish(WizardCommand::Answer(Answer::Nothing));
        }
        let has_moved = wizard.driven == wizard.walk.channel();
        let word = if has_moved { "Again" } else { "Drive" };
        if button(ui, word, "Drive the channel for 0.6 s", unarmed) {
            wish(WizardCommand::Drive(None));
        }
    });
}

fn show_found(ui: &mut Ui, wizard: &Wizard, commands: &mut Commands) {
    let found = wizard.walk.found();
    for line in found.iter().flat_map(WiringFound::lines) {
        paragraph(ui, quiet(query::capitalised(&line)));
    }
    let mut wish = |command| commands.push(ArrayCommand::Identify(command).into());
    row(ui, "", |ui| {
        if button(
            ui,
            "Keep",
            "Keep this wiring in the profile; the device is disarmed",
            None,
        ) {
            wish(WizardCommand::Keep);
        }
        if button(
            ui,
            "Discard",
            "Keep the wiring as it was; the device is disarmed",
            None,
        ) {
            wish(WizardCommand::End);
        }
        if button(ui, "Back", "Ask for the last channel again", None) {
            wish(WizardCommand::Back);
        }
    });
}

#[cfg(test)]
mod tests {
    use eframe::egui::pos2;

    use super::*;

    #[test]
    fn every_contactor_has_its_place_and_the_fingertip_is_up() {
        let rect = Rect::from_min_size(pos2(0.0, 0.0), vec2(300.0, 190.0));
        for name in selvedge_device::ArrayProfile::SHIPPED {
            let profile = selvedge_device::ArrayProfile::shipped(name).unwrap();
            let (places, radius) = fitted(&profile.places_mm(), rect);
            assert!(places.iter().all(|at| rect.contains(*at)), "{name}");
            assert!(places[0].y < places[places.len() - 1].y, "{name}");
            let apart = places[0].distance(places[1]);
            assert!(2.0 * radius < apart, "{name}: {radius} {apart}");
        }
        let (one, radius) = fitted(&[[3.0, 4.0]], rect);
        assert_eq!((one, radius), (vec![rect.center()], DOT));
        assert_eq!(fitted(&[], rect).0, Vec::new());
    }
}
