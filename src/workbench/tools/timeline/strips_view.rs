//! The timeline: a take from its first tick to its last, to be scrubbed, or what was felt last.

use eframe::egui::{
    Align2, EventFilter, Key, Painter, Rect, Response, Sense, Shape, Stroke, Ui, WidgetInfo, pos2,
};

use crate::bench::command::{Commands, PlayCommand};
use crate::bench::recording::Recording;
use crate::bench::recording::strips::Felt;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::tools::timeline::picture::drawn;
use crate::tools::timeline::plot::Plot;
use crate::tools::timeline::transport::{TICK_MS, TransportView};
use crate::tools::timeline::{Timeline, felt, plot};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// Ticks that an arrow key moves with Shift.
const LEAP: u64 = 40;

/// Shows the timeline in `rect`.
pub(crate) fn show(
    ui: &Ui,
    rect: Rect,
    view: &TransportView<'_>,
    state: &mut Timeline,
    commands: &mut Commands,
) {
    match view.shown_take() {
        Some(take) => show_take(ui, rect, take, view.tick, (state, commands)),
        None => felt::show(ui, rect, view),
    }
}

fn show_take(
    ui: &Ui,
    rect: Rect,
    take: &Recording,
    tick: u64,
    (state, commands): (&mut Timeline, &mut Commands),
) {
    let strips = take.strips();
    let plot = Plot::new(rect, strips.fastest_mm_per_s());
    let id = ui.scope_id().with("timeline");
    let response = ui.interact(rect, id, Sense::click_and_drag());
    response.widget_info(|| {
        let label = format!("Timeline of {}, tick", take.name());
        WidgetInfo::slider(true, tick as f64, label)
    });
    if !plot.has_room() {
        return;
    }
    let asked = asked_tick(ui, &response, &plot, strips.n_ticks(), tick);
    // An engine that has not followed yet is not asked twice.
    if let Some(asked) = asked.filter(|asked| *asked != tick && state.asked != Some(*asked)) {
        commands.push(PlayCommand::Seek(asked).into());
    }
    state.asked = asked;
    paint_title(ui, &plot, &take_title(take), strips.has_levels());
    plot.paint_axes(ui.painter(), strips.has_levels());
    paint_times(ui.painter(), &plot, strips.n_ticks());
    ui.painter()
        .extend(drawn(ui, &plot, strips, &mut state.picture));
    paint_playhead(ui, &plot, share_of(asked.unwrap_or(tick), strips.n_ticks()));
    if let Some(pointer) = response.hover_pos() {
        let at = tick_at(plot.share_at(pointer.x), strips.n_ticks());
        if let Some(felt) = strips.at(at) {
            let x = plot.x_at(share_of(at, strips.n_ticks()));
            let head = format!("{}   tick {at}", quantity::clock(at * TICK_MS));
            describe(
                ui,
                &response,
                &plot,
                x,
                &described(&head, felt, "of the contactors that vibrate"),
            );
        }
    }
}

/// The tick that pointer or keys ask for.
fn asked_tick(ui: &Ui, response: &Response, plot: &Plot, n_ticks: u64, tick: u64) -> Option<u64> {
    if response.is_pointer_button_down_on() || response.clicked() {
        let pointer = response.interact_pointer_pos()?;
        return Some(tick_at(plot.share_at(pointer.x), n_ticks));
    }
    if !response.has_focus() {
        return None;
    }
    let filter = EventFilter {
        horizontal_arrows: true,
        ..EventFilter::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    let (ups, downs, is_leap) = ui.input(|input| {
        let presses = |key| input.num_presses(key) as u64;
        let (ups, downs) = (presses(Key::ArrowRight), presses(Key::ArrowLeft));
        (ups, downs, input.modifiers.shift)
    });
    let size = if is_leap { LEAP } else { 1 };
    let moved = (tick + ups * size).saturating_sub(downs * size);
    (ups != downs).then(|| moved.min(n_ticks.saturating_sub(1)))
}

/// Where a tick stands: the first on the left end, the last on the right.
pub(crate) fn share_of(tick: u64, n_ticks: u64) -> f64 {
    let last = n_ticks.saturating_sub(1).max(1);
    (tick as f64 / last as f64).min(1.0)
}

/// The tick at a share of the width.
pub(crate) fn tick_at(share: f64, n_ticks: u64) -> u64 {
    let last = n_ticks.saturating_sub(1);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and the last tick"
    )]
    let tick = (share.clamp(0.0, 1.0) * last as f64).round() as u64;
    tick.min(last)
}

fn take_title(take: &Recording) -> String {
    let last = take.strips().n_ticks().saturating_sub(1);
    let length = quantity::clock(last * TICK_MS);
    format!("{}   {length}", take.name())
}

/// What there is to say of a place of the timeline; `over` says which contactors count.
pub(crate) fn described(head: &str, felt: Felt, over: &str) -> String {
    let speed = quantity::with_unit(felt.speed_mm_per_s, 1, "mm/s");
    let Some(mean_um) = felt.mean_um else {
        return format!(
            "{head}\nspeed  {speed}\nHow strong it is depends on the scene: a file of positions \
             holds no levels"
        );
    };
    let level = |band: Band| {
        let um = mean_um[band.index()];
        let name = quantity::fixed(band.carrier_hz(), 0);
        let amplitude = quantity::with_unit(um, 2, "µm");
        if um > 0.0 {
            let level = quantity::with_unit(quantity::level_db(um), 1, "dB");
            format!("{name} Hz  {level}   {amplitude}")
        } else {
            format!("{name} Hz  silent")
        }
    };
    format!(
        "{head}\nspeed  {speed}\n{}\n{}\nMean peak {over},\nafter gains, before output \
         limits; dB re 1 µm",
        level(Band::Low),
        level(Band::High)
    )
}

/// A line at the place that is read, and the words.
pub(crate) fn describe(ui: &Ui, response: &Response, plot: &Plot, x: f32, words: &str) {
    let palette = Palette::in_ui(ui);
    let line = Stroke::new(1.0, palette.line);
    let x = ui.painter().round_to_pixel_center(x);
    ui.painter().vline(x, plot.area.y_range(), line);
    response.clone().on_hover_ui_at_pointer(|ui| {
        ui.label(words);
    });
}

fn paint_playhead(ui: &Ui, plot: &Plot, share: f64) {
    let palette = Palette::in_ui(ui);
    let painter = ui.painter();
    let x = painter.round_to_pixel_center(plot.x_at(share));
    let (top, bottom) = (plot.area.top(), plot.area.bottom());
    painter.vline(x, top..=bottom, Stroke::new(1.5, palette.selection));
    let corners = vec![
        pos2(x - 4.5, top - 6.0),
        pos2(x + 4.5, top - 6.0),
        pos2(x, top + 1.0),
    ];
    painter.add(Shape::convex_polygon(
        corners,
        palette.selection,
        Stroke::NONE,
    ));
}

/// What is shown, and on the right which line is what.
pub(crate) fn paint_title(ui: &Ui, plot: &Plot, title: &str, has_levels: bool) {
    let palette = Palette::in_ui(ui);
    let (painter, area) = (ui.painter(), plot.area);
    let y = area.top() - 9.0;
    let mut names = vec![("speed".to_owned(), palette.dim)];
    if has_levels {
        let name = |band: Band| format!("{} Hz", quantity::fixed(band.carrier_hz(), 0));
        names.extend(Band::ALL.map(|band| (name(band), palette.band(band))));
    }
    let mut right = area.right();
    for (name, ink) in names.into_iter().rev() {
        let at = pos2(right, y);
        let written = painter.text(at, Align2::RIGHT_CENTER, name, theme::small(), ink);
        right = written.left() - 12.0;
    }
    let room = Rect::from_min_max(pos2(area.left(), y - 8.0), pos2(right, y + 8.0));
    let clipped = painter.with_clip_rect(room.intersect(painter.clip_rect()));
    clipped.text(
        room.left_center(),
        Align2::LEFT_CENTER,
        title,
        theme::small(),
        palette.dim,
    );
}

fn paint_times(painter: &Painter, plot: &Plot, n_ticks: u64) {
    let last_ms = n_ticks.saturating_sub(1) * TICK_MS;
    let step = plot::step_ms(last_ms, plot.area.width());
    let mark = |mark: u64| {
        let time_ms = mark * step;
        let share = time_ms as f64 / last_ms.max(1) as f64;
        (share, plot::time_words(time_ms, step))
    };
    let marks: Vec<_> = (0..=last_ms / step.max(1)).map(mark).collect();
    plot.paint_times(painter, &marks);
}
