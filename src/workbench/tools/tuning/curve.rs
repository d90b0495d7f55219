//! What compression does: level in, level out, and the library's textiles as dots on the curve.

use eframe::egui::{Id, Margin, Pos2, Rect, Ui};

use crate::bench::command::edit::Edit;
use crate::bench::command::{Commands, Part, ShowCommand};
use crate::bench::export::Exported;
use crate::bench::export::origin::Origin;
use crate::bench::view::{LibraryDot, SceneView};
use crate::kit::pane::paint_sentence;
use crate::kit::plot;
use crate::kit::plot::{Drag, Setting, Shown};
use crate::kit::widgets::scale::Scale;
use selvedge_chart::{Axis, Chart, Columns, Ink, Series, Style, Tone, Words};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::{Band, Tuning};

/// The line is not turned by a place as near to the level that it leaves alone, dB.
const NEAREST_DB: f64 = 2.0;
/// Least height of the plot, points.
pub(crate) const HEIGHT: f32 = 90.0;

/// The spread of a library's mean amplitudes, by band, dB.
pub(crate) fn ranges_db(library: &[LibraryDot], tuning: &Tuning, reference_db: f64) -> [f64; 2] {
    Band::ALL.map(|band| {
        let levels = library.iter().map(|dot| {
            quantity::level_db(dot.mean_um[band.index()])
                + dot.gain_db
                + tuning.compression_gain_db(Some(dot.level_db), reference_db)
        });
        let heard = levels.filter(|level| level.is_finite());
        let (least, most) = heard.fold(
            (f64::INFINITY, f64::NEG_INFINITY),
            |(least, most), level| (least.min(level), most.max(level)),
        );
        (most - least).max(0.0)
    })
}

/// The ends of both axes: whole tens of decibels around every level.
fn ends_db(library: &[LibraryDot], reference_db: f64) -> [f64; 2] {
    let levels = library.iter().map(|dot| dot.level_db).chain([reference_db]);
    let (least, most) = levels.fold(
        (f64::INFINITY, f64::NEG_INFINITY),
        |(least, most), level| (least.min(level), most.max(level)),
    );
    [
        (least / 10.0 - 0.2).floor() * 10.0,
        (most / 10.0 + 0.2).ceil() * 10.0,
    ]
}

/// The curve with the library's textiles as dots on it, those outside the scene first.
fn chart(scene: &SceneView, reference_db: f64) -> Chart {
    let library = &scene.library;
    let out = |level_db: f64| out_db(&scene.tuning, reference_db, level_db);
    let ends = ends_db(library, reference_db);
    let line = |name: &str, of: &dyn Fn(f64) -> f64, ink, style| Series {
        name: name.to_owned(),
        points: ends.map(|level_db| [level_db, of(level_db)]).to_vec(),
        style,
        ink,
        ..Series::default()
    };
    let at = |dot: &LibraryDot| [dot.level_db, out(dot.level_db) + scene_gain_db(scene, dot)];
    let dots = |name: &str, is_placed: bool, ink| {
        let own = library.iter().filter(|dot| dot.is_placed == is_placed);
        Series {
            name: name.to_owned(),
            points: own.map(at).collect(),
            ink,
            ..Series::default()
        }
    };
    let named = |dot: &LibraryDot| Words {
        at: at(dot),
        text: dot.name.clone(),
        tone: Tone::Aside,
    };
    let percent = quantity::with_unit(100.0 * scene.tuning.compression, 0, "%");
    let placed = library.iter().filter(|dot| dot.is_placed);
    Chart {
        x: Axis::linear("level in, dB re 1 µm").within(ends),
        y: Axis::linear("level out, dB re 1 µm").within(ends),
        series: vec![
            line("uncompressed", &|db| db, Ink::Grey, Style::Dashed),
            line(
                &format!("compression {percent}"),
                &out,
                Ink::Black,
                Style::Line,
            ),
            dots("library", false, Ink::Grey),
            dots("in the scene", true, Ink::Black),
        ],
        words: placed.map(named).collect(),
        columns: columns(library, |level_db| {
            let tuning = &scene.tuning;
            tuning.compression_gain_db(Some(level_db), reference_db)
        }),
        ..Chart::default()
    }
}

/// The gain that the scene gives a textile where it is placed first, dB; 0 where it is not, or is
/// silenced.
fn scene_gain_db(scene: &SceneView, dot: &LibraryDot) -> f64 {
    let placed = scene
        .placed(&dot.id)
        .and_then(|index| scene.cloths.get(index));
    let gain_db = placed.map_or(0.0, |cloth| cloth.gain_db);
    if gain_db.is_finite() { gain_db } else { 0.0 }
}

fn columns(library: &[LibraryDot], gain_db: impl Fn(f64) -> f64) -> Columns {
    let number = |of: &dyn Fn(&LibraryDot) -> f64| -> Vec<f64> { library.iter().map(of).collect() };
    let names: Vec<String> = library.iter().map(|dot| dot.name.clone()).collect();
    let is_placed = library.iter().map(|dot| u64::from(dot.is_placed));
    Columns::default()
        .with("textile", names)
        .with("mean_a40_um", number(&|dot| dot.mean_um[0]))
        .with("mean_a320_um", number(&|dot| dot.mean_um[1]))
        .with("level_in_db", number(&|dot| dot.level_db))
        .with("compression_gain_db", number(&|dot| gain_db(dot.level_db)))
        .with(
            "level_out_db",
            number(&|dot| dot.level_db + gain_db(dot.level_db)),
        )
        .with("is_in_scene", is_placed.collect::<Vec<u64>>())
}

fn out_db(tuning: &Tuning, reference_db: f64, level_db: f64) -> f64 {
    level_db + tuning.compression_gain_db(Some(level_db), reference_db)
}

/// The curve with its numbers.
pub(crate) fn exported(scene: &SceneView, reference_db: f64, origin: Origin) -> Exported {
    let note = "Level of a textile: mean over both bands of its mean amplitudes at 100 mm/s, \
                without other gains.";
    let chart = chart(scene, reference_db);
    Exported::of_chart("Compression of the library", chart, 420.0, note, origin)
}

/// Shows the curve in `rect`, or what it waits for; a click on a dot chooses its textile, if it is
/// placed.
pub(crate) fn show(ui: &Ui, rect: Rect, scene: &SceneView, commands: &mut Commands) {
    let Some(reference_db) = scene.reference_db.filter(|_| !scene.library.is_empty()) else {
        paint_sentence(
            ui.painter(),
            rect,
            "Levels are being computed: compression is pending",
        );
        return;
    };
    let mut chart = chart(scene, reference_db);
    // Hovering names the dots: there is no room for words among them.
    chart.words.clear();
    for (series, is_placed) in chart.series[2..].iter_mut().zip([false, true]) {
        let own = scene
            .library
            .iter()
            .filter(|dot| dot.is_placed == is_placed);
        let marked = own
            .enumerate()
            .filter(|(_, dot)| scene.is_marked_id(&dot.id));
        series.marked = marked.map(|(nth, _)| nth).collect();
    }
    let setting = Setting {
        name: "Compression curve",
        margin: Margin {
            left: 30,
            right: 6,
            top: 6,
            bottom: 18,
        },
        wheel: false,
        drag: Drag::ByPane,
        hover: false,
        has_legend: false,
        ..Setting::default()
    };
    let Some(shown) = plot::show(ui, rect, &chart, &setting) else {
        return;
    };
    answer(ui, &shown, (scene, reference_db), commands);
}

/// Names the dot under the pointer, and takes clicks and drags.
fn answer(
    ui: &Ui,
    shown: &Shown,
    (scene, reference_db): (&SceneView, f64),
    commands: &mut Commands,
) {
    let out = |dot: &LibraryDot| {
        out_db(&scene.tuning, reference_db, dot.level_db) + scene_gain_db(scene, dot)
    };
    let pointer = shown.response.hover_pos();
    let distance = |dot: &&LibraryDot, at: Pos2| shown.at([dot.level_db, out(dot)]).distance(at);
    let near_to = |at: Pos2| {
        let near = scene.library.iter().filter(|dot| distance(dot, at) < 8.0);
        near.min_by(|a, b| distance(a, at).total_cmp(&distance(b, at)))
    };
    let near = pointer.and_then(near_to);
    if let Some(dot) = near {
        if let Some(index) = scene.placed(&dot.id) {
            commands.push(ShowCommand::Hover(Part::Cloth(index)).into());
            if shown.response.clicked() {
                commands.push(ShowCommand::SelectCloth(Some(index)).into());
            }
        }
        let words = format!(
            "{}\nlevel {} → {}\nmean of both bands at 100 mm/s, re 1 µm, without other gains\ndrag \
             a textile of the scene for its gain, the line for the compression",
            dot.name,
            quantity::with_unit(dot.level_db, 1, "dB"),
            quantity::with_unit(out(dot), 1, "dB"),
        );
        shown.response.clone().on_hover_text_at_pointer(words);
    }
    let pressed_at = ui.input(|input| input.pointer.press_origin());
    let pressed = pressed_at.and_then(near_to);
    drag(ui, shown, (scene, reference_db), pressed, commands);
}

/// What is dragged since the press: a placed textile, or the line.
fn drag(
    ui: &Ui,
    shown: &Shown,
    (scene, reference_db): (&SceneView, f64),
    pressed: Option<&LibraryDot>,
    commands: &mut Commands,
) {
    let id = Id::unique("dragged on the curve");
    if shown.response.drag_started() {
        let taken = pressed.and_then(|dot| scene.placed(&dot.id));
        ui.data_mut(|data| data.insert_temp(id, taken));
    }
    let at = shown.response.interact_pointer_pos();
    let Some(at) = at.filter(|_| shown.response.dragged()) else {
        return;
    };
    let [level_db, out_at_db] = shown.values_at(at);
    let taken: Option<usize> = ui.data(|data| data.get_temp(id).unwrap_or_default());
    let dot = taken.and_then(|index| {
        let cloth = scene.cloths.get(index)?;
        let dot = scene.library.iter().find(|dot| dot.id == cloth.id)?;
        Some((index, dot))
    });
    match dot {
        Some((index, dot)) => {
            let gain_db = out_at_db - out_db(&scene.tuning, reference_db, dot.level_db);
            let gain_db = Scale::gain(0.0).stepped(gain_db);
            commands.push(Edit::TextileGain(index, gain_db).into());
        }
        None if (level_db - reference_db).abs() > NEAREST_DB => {
            let slope = (out_at_db - reference_db) / (level_db - reference_db);
            let compression = Scale::share(0.0).stepped(1.0 - slope);
            commands.push(Edit::Compression(compression).into());
        }
        None => {}
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Event, PointerButton, vec2};

    use super::*;
    use crate::bench::gain_set::GainSet;
    use crate::shell::headless::Headless;
    use selvedge_foundation::numerics::to_single;

    fn library() -> Vec<LibraryDot> {
        let dot = |low_um: f64, high_um: f64| LibraryDot {
            id: String::new(),
            name: String::new(),
            mean_um: [low_um, high_um],
            gain_db: 0.0,
            level_db: 0.5 * (quantity::level_db(low_um) + quantity::level_db(high_um)),
            is_placed: false,
        };
        vec![dot(1.0, 1.0), dot(10.0, 10.0), dot(100.0, 1.0)]
    }

    #[test]
    fn without_compression_the_range_is_the_librarys_own() {
        let range = ranges_db(&library(), &Tuning::default(), 0.0);
        assert!(
            (range[0] - 40.0).abs() < 1e-9 && (range[1] - 20.0).abs() < 1e-9,
            "{range:?}"
        );
    }

    #[test]
    fn full_compression_leaves_only_what_tells_the_bands_apart() {
        let tuning = Tuning {
            compression: 1.0,
            ..Tuning::default()
        };
        let range = ranges_db(&library(), &tuning, -3.0);
        // Levels 0, 20, 20 dB: out of 40 Hz come −3, −3, +17 dB.
        assert!((range[0] - 20.0).abs() < 1e-9, "{range:?}");
    }

    #[test]
    fn a_library_without_textiles_has_no_range() {
        assert_eq!(ranges_db(&[], &Tuning::default(), 0.0), [0.0, 0.0]);
    }

    /// A press at a place of the curve, a drag to another, and what came of it.
    fn dragged(window: &mut Headless, [from, to]: [[f64; 2]; 2]) -> GainSet {
        let scene = window.workbench.bench.plain_scene_view();
        let [x, y] = chart(&scene, scene.reference_db.unwrap())
            .rulers()
            .map(|ruler| ruler.ends());
        let id = Id::unique(("chart", "Compression curve"));
        let rect = window.ctx.read_response(id).unwrap().rect;
        let area = Rect::from_min_max(rect.min + vec2(30.0, 6.0), rect.max - vec2(6.0, 18.0));
        let place = |at: [f64; 2]| {
            let share = |db: f64, ends: [f64; 2]| to_single((db - ends[0]) / (ends[1] - ends[0]));
            let [across, up] = [share(at[0], x), share(at[1], y)];
            area.left_bottom() + vec2(across * area.width(), -up * area.height())
        };
        let [from, to] = [from, to].map(place);
        let button = |pos: Pos2, pressed| Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: eframe::egui::Modifiers::NONE,
        };
        window.events = vec![Event::PointerMoved(from), button(from, true)];
        window.pass(2);
        for share in [0.3, 0.6, 1.0] {
            let at = from + share * (to - from);
            window.events = vec![Event::PointerMoved(at)];
            window.pass(2);
        }
        window.events = vec![button(to, false)];
        window.pass(2);
        window.workbench.bench.gain_set()
    }

    #[test]
    fn a_textile_is_dragged_to_its_gain_and_the_line_to_its_compression_in_a_step_each() {
        let mut window = Headless::drawn();
        window.pass(3);
        let bench = &window.workbench.bench;
        let (scene, before) = (bench.plain_scene_view(), bench.gain_set());
        let n_steps = bench.document.steps().n_done;
        let reference_db = scene.reference_db.unwrap();
        // The one that is farthest from what compression leaves alone has nothing beside it.
        let far = |dot: &&LibraryDot| (dot.level_db - reference_db).abs();
        let placed = scene.library.iter().filter(|dot| dot.is_placed);
        let dot = placed.max_by(|a, b| far(a).total_cmp(&far(b))).unwrap();
        let index = scene.placed(&dot.id).unwrap();
        let at = [
            dot.level_db,
            out_db(&scene.tuning, reference_db, dot.level_db) + scene_gain_db(&scene, dot),
        ];
        let after = dragged(&mut window, [at, [at[0], at[1] + 4.0]]);
        let by_db = after.gains_db[index] - before.gains_db[index];
        assert!((by_db - 4.0).abs() < 0.6, "{by_db} dB");
        assert_eq!(after.tuning, before.tuning);
        let steps = |window: &Headless| window.workbench.bench.document.steps().n_done;
        assert_eq!(steps(&window), n_steps + 1);
        // Away from every textile the line itself is taken: to where nothing is left of 12 dB.
        let level_db = reference_db - 12.0;
        let free = [level_db, reference_db + 6.0];
        let turned = dragged(&mut window, [free, [level_db, reference_db]]);
        let compression = turned.tuning.compression;
        assert!((compression - 1.0).abs() < 0.06, "{compression}");
        assert_eq!(turned.gains_db, after.gains_db);
        assert_eq!(steps(&window), n_steps + 2);
    }
}
