//! What part of a chart is shown: zoomed and moved by the pointer and the keys, never beyond the
//! ends that the chart has at rest.

use eframe::egui::{EventFilter, Id, InputState, Key, PointerButton, Rect, Response, Ui};

use crate::kit::plot::{Drag, Setting};

/// A full view is at most so many times as wide as a zoomed one.
const MOST_ZOOM: f64 = 2000.0;
/// What a key zooms by.
const KEY_ZOOM: f64 = 1.25;
/// What part of the view a key moves by.
const KEY_SHARE: f64 = 0.1;
/// How much the wheel is turned for a factor of e, points.
const WHEEL: f64 = 240.0;

/// The part of a chart that is shown, as places on its axes; `None` is all of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct View {
    axes: [Option<[f64; 2]>; 2],
}

/// What is asked of a view.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Gesture {
    /// Where the pointer is, as shares of the frame from its lower left corner.
    pub(crate) at: [f64; 2],
    /// By what factor less is to be shown; 1 leaves it.
    pub(crate) closer: f64,
    /// By what share of the frame the content moves, to the right and up.
    pub(crate) by: [f64; 2],
    /// Whether everything is to be shown.
    pub(crate) is_reset: bool,
}

impl Gesture {
    fn moves(&self) -> bool {
        self.by.iter().any(|by| by.abs() > 0.0)
    }
}

impl View {
    /// The view of a chart, which it shares along the horizontal axis with those of its link.
    pub(crate) fn load(ui: &Ui, id: Id, link: Option<&'static str>) -> Self {
        let own: Self = ui.data(|data| data.get_temp(id)).unwrap_or_default();
        let Some(link) = link else { return own };
        let x: Option<Option<[f64; 2]>> = ui.data(|data| data.get_temp(Id::unique(link)));
        Self {
            axes: [x.unwrap_or_default(), own.axes[1]],
        }
    }

    /// Keeps it.
    pub(crate) fn store(self, ui: &Ui, id: Id, link: Option<&'static str>) {
        ui.data_mut(|data| {
            data.insert_temp(id, self);
            if let Some(link) = link {
                data.insert_temp(Id::unique(link), self.axes[0]);
            }
        });
        // Those of the link that were already drawn follow at once.
        ui.ctx().request_repaint();
    }

    /// Its ends, where these are the chart's at rest.
    pub(crate) fn ends(self, rest: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
        [0, 1].map(|axis| within(self.axes[axis].unwrap_or(rest[axis]), rest[axis]))
    }

    /// The view after a gesture.
    pub(crate) fn after(self, gesture: &Gesture, rest: [[f64; 2]; 2]) -> Self {
        if gesture.is_reset {
            return Self::default();
        }
        if (gesture.closer - 1.0).abs() < 1e-9 && !gesture.moves() {
            return self;
        }
        let ends = self.ends(rest);
        let axes = [0, 1].map(|axis| {
            let [low, high] = ends[axis];
            let whole = rest[axis][1] - rest[axis][0];
            let span = high - low;
            let zoomed = (span / gesture.closer).clamp(whole / MOST_ZOOM, whole);
            let start = low + gesture.at[axis] * (span - zoomed) - gesture.by[axis] * zoomed;
            let ends = within([start, start + zoomed], rest[axis]);
            let is_whole = zoomed > whole * (1.0 - 1e-9);
            (!is_whole && ends.iter().all(|end| end.is_finite())).then_some(ends)
        });
        Self { axes }
    }
}

/// Ends moved, and cut off where they are too far apart, to lie within others.
fn within([low, high]: [f64; 2], [least, most]: [f64; 2]) -> [f64; 2] {
    let span = high - low;
    if !(span > 0.0 && span < most - least) {
        return [least, most];
    }
    let low = low.clamp(least, most - span);
    [low, low + span]
}

/// What the pointer and the keys ask of a chart's view.
pub(crate) fn gesture(ui: &Ui, response: &Response, area: Rect, setting: &Setting<'_>) -> Gesture {
    let mut gesture = Gesture {
        at: [0.5; 2],
        closer: 1.0,
        ..Gesture::default()
    };
    if setting.drag == Drag::ByPane {
        return gesture;
    }
    let (size, pans) = (area.size(), setting.drag == Drag::Pans);
    if let Some(at) = response.hover_pos().filter(|at| area.contains(*at)) {
        gesture.at = [
            f64::from((at.x - area.left()) / size.x),
            f64::from((area.bottom() - at.y) / size.y),
        ];
        gesture.closer = f64::from(ui.input(InputState::zoom_delta));
        if setting.wheel {
            let turned = ui.input(|input| input.smooth_scroll_delta().y);
            gesture.closer *= (f64::from(turned) / WHEEL).exp();
        }
        gesture.is_reset = response.double_clicked() && pans;
    }
    let is_dragged = response.dragged_by(PointerButton::Secondary)
        || pans && response.dragged_by(PointerButton::Primary);
    if is_dragged {
        let by = response.drag_delta();
        gesture.by = [f64::from(by.x / size.x), f64::from(-by.y / size.y)];
    }
    if pans && response.clicked() {
        response.request_focus();
    }
    if response.has_focus() {
        add_keys(ui, response, setting, &mut gesture);
    }
    gesture
}

fn add_keys(ui: &Ui, response: &Response, setting: &Setting<'_>, gesture: &mut Gesture) {
    let presses =
        |key: Key| ui.input(|input| f64::from(u8::try_from(input.num_presses(key)).unwrap_or(0)));
    let steps = presses(Key::Plus) + presses(Key::Equals) - presses(Key::Minus);
    gesture.closer *= KEY_ZOOM.powf(steps);
    gesture.is_reset |= presses(Key::Backspace) > 0.0;
    if setting.drag == Drag::Chooses {
        // The arrows choose a value there.
        return;
    }
    let filter = EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        ..EventFilter::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    gesture.by[0] += KEY_SHARE * (presses(Key::ArrowLeft) - presses(Key::ArrowRight));
    gesture.by[1] += KEY_SHARE * (presses(Key::ArrowDown) - presses(Key::ArrowUp));
}

#[cfg(test)]
mod tests {
    use super::*;

    const REST: [[f64; 2]; 2] = [[0.0, 10.0], [-1.0, 1.0]];

    fn zoomed(closer: f64, at: [f64; 2]) -> Gesture {
        Gesture {
            at,
            closer,
            ..Gesture::default()
        }
    }

    #[test]
    fn zooming_keeps_what_is_under_the_pointer() {
        let view = View::default().after(&zoomed(2.0, [0.2, 0.5]), REST);
        assert_eq!(view.ends(REST), [[1.0, 6.0], [-0.5, 0.5]]);
        let back = view.after(&zoomed(0.4, [0.2, 0.5]), REST);
        assert_eq!(back, View::default(), "no farther than everything");
    }

    #[test]
    fn nothing_leads_beyond_the_ends_at_rest() {
        let mut view = View::default().after(&zoomed(4.0, [0.5, 0.5]), REST);
        for step in 0_u32..2000 {
            let odd = |n: u32| f64::from(step.wrapping_mul(n) % 17) / 8.0 - 1.0;
            let gesture = Gesture {
                at: [odd(7).abs().min(1.0), odd(5).abs().min(1.0)],
                closer: 1.0 + 0.4 * odd(3),
                by: [odd(11), odd(13)],
                is_reset: false,
            };
            view = view.after(&gesture, REST);
            for (ends, rest) in view.ends(REST).into_iter().zip(REST) {
                assert!(rest[0] <= ends[0] && ends[1] <= rest[1] + 1e-9, "{ends:?}");
                assert!(
                    ends[1] - ends[0] > 0.9 * (rest[1] - rest[0]) / MOST_ZOOM,
                    "{ends:?}"
                );
            }
        }
        let reset = Gesture {
            is_reset: true,
            ..Gesture::default()
        };
        assert_eq!(view.after(&reset, REST), View::default());
    }

    #[test]
    fn a_view_that_no_longer_fits_the_chart_shows_all_of_it() {
        let view = View {
            axes: [Some([2.0, 8.0]), None],
        };
        assert_eq!(view.ends([[0.0, 5.0], [0.0, 1.0]])[0], [0.0, 5.0]);
        assert_eq!(view.ends([[4.0, 14.0], [0.0, 1.0]])[0], [4.0, 10.0]);
    }
}
