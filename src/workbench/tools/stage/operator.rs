//! The operator's page: behind a PIN, what notices would say, and the permission to arm.

use eframe::egui::{Align2, Key, Rect, Ui, pos2, vec2};

use crate::bench::Bench;
use crate::tools::stage::brush::{Brush, Look};
use crate::tools::stage::machine::Machine;
use crate::tools::stage::pin::{Access, Lock};

/// What was wanted on the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wish {
    Digit(char),
    Back,
    Enter,
    Close,
    Permit(bool),
    /// End the program.
    End,
}

/// Most notices that are shown.
const MOST_NOTICES: usize = 6;

/// Draws what there is before the PIN, or after it.
pub(crate) fn show(
    ui: &Ui,
    brush: &mut Brush<'_>,
    lock: &Lock,
    lines: &[String],
    machine: &Machine,
) -> Vec<Wish> {
    let whole = brush.layout.whole;
    brush.painter.rect_filled(whole, 0, brush.palette.panel);
    let column = whole.shrink(40.0 * brush.layout.unit);
    let mut wishes = typed(ui);
    if lock.access() == Access::Open {
        write(brush, column, lines);
        let is_permitted = machine.voltage.is_permitted();
        let permit = if is_permitted {
            "Forbid arming"
        } else {
            "Permit arming"
        };
        let places = brush.layout.places::<3>(brush.layout.row, [60.0, 25.0]);
        let acts = [
            (permit, Wish::Permit(!is_permitted)),
            ("End program", Wish::End),
            ("Back", Wish::Close),
        ];
        for (rect, (words, wish)) in places.into_iter().zip(acts) {
            if brush
                .button(ui, rect, (words, words), Look::default())
                .clicked()
            {
                wishes.push(wish);
            }
        }
        return wishes;
    }
    let left_s = lock.locked_s(machine.now_s());
    let asked = if left_s > 0.0 {
        format!("Wait {left_s:.0} s")
    } else {
        format!("PIN {}", "•".repeat(lock.n_digits()))
    };
    let mut written = lines.to_vec();
    written.push(asked);
    write(brush, column, &written);
    show_pad(ui, brush, &mut wishes);
    wishes
}

/// What the page tells. `has_pin`: whether there is a way into it.
pub(crate) fn lines(
    bench: &Bench,
    access: Access,
    [log, pace]: [String; 2],
    has_pin: bool,
) -> Vec<String> {
    if !has_pin {
        let words = [
            "No PIN is set: nobody can permit arming.",
            "Write pin = \"…\" with 6 digits or more into stage.toml.",
            "SIGTERM, or Ctrl+C where it was started, ends the program.",
        ];
        return words.map(str::to_owned).into();
    }
    if access != Access::Open {
        return vec!["Operator".to_owned()];
    }
    let device = &bench.device;
    let state = bench
        .live
        .bridge
        .as_ref()
        .map_or("none", |bridge| bridge.state);
    let name = device.target.as_deref().unwrap_or("Device");
    let mut lines = vec![format!("{name}: {state}")];
    lines.extend(device.trouble.clone());
    lines.push(format!("Sound: {}", sound_words(bench)));
    lines.push(log);
    let status = &bench.live.status;
    lines.push(format!(
        "Ticks missed {}, late {}",
        status.missed, status.late
    ));
    lines.push(pace);
    let notices = bench.notices.shown().iter().rev().take(MOST_NOTICES);
    lines.extend(notices.map(|notice| notice.text.clone()));
    lines
}

fn sound_words(bench: &Bench) -> String {
    use selvedge_engine::SoundState;
    match bench.device.sound.state() {
        None => "off".to_owned(),
        Some(SoundState::Opening) => "opening".to_owned(),
        Some(SoundState::Playing { .. }) => "playing".to_owned(),
        Some(SoundState::Absent(why)) => why,
    }
}

fn write(brush: &mut Brush<'_>, column: Rect, lines: &[String]) {
    let height = 1.5 * brush.layout.label;
    let mut top = column.top();
    for line in lines {
        let within = Rect::from_min_size(pos2(column.left(), top), vec2(column.width(), height));
        let look = (brush.layout.label, brush.palette.text);
        brush.line(within, Align2::LEFT_CENTER, look, line);
        top += height;
    }
}

/// Digits to be typed on the screen.
fn show_pad(ui: &Ui, brush: &mut Brush<'_>, wishes: &mut Vec<Wish>) {
    let area = brush.layout.area;
    let keys = ["123", "456", "789", "←0✔"];
    let height = (28.0 * brush.layout.mm).min(0.2 * area.height());
    for (nth, row) in keys.into_iter().enumerate() {
        let top = area.bottom() - (4 - nth) as f32 * height;
        let place = Rect::from_min_size(pos2(area.left(), top), vec2(area.width(), height));
        let places = brush.layout.places::<3>(place.shrink(4.0), [25.0, 25.0]);
        for (rect, key) in places.into_iter().zip(row.chars()) {
            let words = key.to_string();
            if brush
                .button(ui, rect, (&words, &words), Look::default())
                .clicked()
            {
                wishes.push(match key {
                    '←' => Wish::Back,
                    '✔' => Wish::Enter,
                    digit => Wish::Digit(digit),
                });
            }
        }
    }
    let [_, close] = brush.layout.places::<2>(brush.layout.row, [60.0, 20.0]);
    if brush
        .button(ui, close, ("Back", "Back"), Look::default())
        .clicked()
    {
        wishes.push(Wish::Close);
    }
}

/// What the keyboard said.
fn typed(ui: &Ui) -> Vec<Wish> {
    const DIGITS: [(Key, char); 10] = [
        (Key::Num0, '0'),
        (Key::Num1, '1'),
        (Key::Num2, '2'),
        (Key::Num3, '3'),
        (Key::Num4, '4'),
        (Key::Num5, '5'),
        (Key::Num6, '6'),
        (Key::Num7, '7'),
        (Key::Num8, '8'),
        (Key::Num9, '9'),
    ];
    let has_focus = ui.memory(|memory| memory.focused().is_some());
    ui.input(|input| {
        let pressed = DIGITS.iter().filter(|(key, _)| input.key_pressed(*key));
        let mut wishes: Vec<Wish> = pressed.map(|(_, digit)| Wish::Digit(*digit)).collect();
        if input.key_pressed(Key::Backspace) {
            wishes.push(Wish::Back);
        }
        if input.key_pressed(Key::Enter) && !has_focus {
            wishes.push(Wish::Enter);
        }
        if input.key_pressed(Key::Escape) {
            wishes.push(Wish::Close);
        }
        wishes
    })
}
