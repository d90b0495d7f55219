//! The pane under the hands of a simulated user.

use eframe::egui::{Event, Id, PointerButton, Pos2, pos2};

use super::*;
use crate::bench::command::ShowCommand;
use crate::shell::headless::Headless;

fn window() -> Headless {
    let mut window = Headless::shipped();
    window.dispatch(ShowCommand::Reveal(Pane::Levels));
    window.pass(3);
    window
}

fn levels(window: &Headless) -> Vec<Placed> {
    let bench = &window.workbench.bench;
    placed(bench, &bench.plain_scene_view())
}

#[test]
fn what_is_proposed_levels_the_scene_and_is_one_step_of_undo() {
    let mut window = window();
    let before = levels(&window);
    assert!(
        before
            .iter()
            .all(|one| one.row.peaks.headroom_db([0.0; 2]).is_some()),
        "the library is measured while the pane is in sight"
    );
    let spread = |all: &[Placed]| {
        let mean = all
            .iter()
            .map(|one| 0.5 * (one.row.level_db[0] + one.row.level_db[1]));
        let (least, most) = mean.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), db| {
            (least.min(db), most.max(db))
        });
        most - least
    };
    assert!(spread(&before) > 5.0, "{}", spread(&before));
    let rows: Vec<Row> = before.iter().map(|one| one.row.clone()).collect();
    let bench = &window.workbench.bench;
    let n_steps = bench.document.steps().n_done;
    let after = changed(&bench.gain_set(), &propose(&rows, [].iter()));
    window.dispatch(Edit::Gains(after));
    window.pass(2);
    let now = levels(&window);
    assert!(spread(&now) < 3.0, "{} dB", spread(&now));
    let clips = now
        .iter()
        .filter_map(|one| one.row.peaks.headroom_db([0.0; 2]));
    assert!(clips.into_iter().all(|headroom_db| headroom_db > -0.01));
    assert_eq!(window.workbench.bench.document.steps().n_done, n_steps + 1);
}

#[test]
fn a_target_is_kept_in_the_scene_and_undone_like_any_edit() {
    let mut window = window();
    let set = |target_db| Edit::TargetLevel(2, Band::High, target_db);
    window.dispatch(set(Some(18.0)));
    assert_eq!(levels(&window)[2].row.target_db, [None, Some(18.0)]);
    let text = window.workbench.bench.document.scene().to_toml().unwrap();
    assert!(text.contains("target_320_db_sl = 18.0"), "{text}");
    window.dispatch(crate::bench::command::Command::Undo);
    assert_eq!(levels(&window)[2].row.target_db, [None, None]);
}

#[test]
fn a_textile_is_dragged_through_the_plane_to_more_of_both_bands() {
    let mut window = window();
    window
        .workbench
        .tools
        .get_mut::<LevelBench>()
        .unwrap()
        .shows_plane = true;
    window.pass(3);
    let all = levels(&window);
    let chart = plane::chart(&all, None);
    let [x, y] = chart.rulers().map(|ruler| ruler.ends());
    let id = Id::unique(("chart", "Levels of both bands"));
    let rect = window.ctx.read_response(id).unwrap().rect;
    let [left, right, top, bottom] = [34.0, 8.0, 8.0, 18.0];
    let place = |at: [f64; 2]| {
        let share = [
            (at[0] - x[0]) / (x[1] - x[0]),
            (at[1] - y[0]) / (y[1] - y[0]),
        ];
        let share = share.map(selvedge_foundation::numerics::to_single);
        let width = rect.width() - left - right;
        let height = rect.height() - top - bottom;
        pos2(
            rect.left() + left + share[0] * width,
            rect.bottom() - bottom - share[1] * height,
        )
    };
    let at = place(all[1].row.level_db);
    let button = |pos: Pos2, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: eframe::egui::Modifiers::NONE,
    };
    let to = place(all[1].row.level_db.map(|db| db - 4.0));
    window.events = vec![Event::PointerMoved(at), button(at, true)];
    window.pass(2);
    for share in [0.3, 0.6, 1.0] {
        window.events = vec![Event::PointerMoved(at + share * (to - at))];
        window.pass(2);
    }
    window.events = vec![button(to, false)];
    window.pass(2);
    let now = levels(&window);
    let by_db = now[1].gain_db - all[1].gain_db;
    assert!((by_db + 4.0).abs() < 0.5, "{by_db} dB");
    for (other, before) in now.iter().zip(&all).filter(|(one, _)| one.index != 1) {
        assert_eq!(other.gain_db, before.gain_db, "{}", other.name);
    }
}

#[test]
fn levels_that_were_not_measured_have_lines_from_where_to_where_they_may_lie() {
    let mut all = levels(&window());
    let n_lines = |all: &[Placed]| {
        let is_line =
            |series: &&selvedge_chart::Series| series.style == selvedge_chart::Style::Line;
        plane::chart(all, None)
            .series
            .iter()
            .filter(is_line)
            .count()
    };
    let before = n_lines(&all);
    all[1].known_db = Some([[-6.0, 2.0], [-1.0, 4.0]]);
    assert_eq!(n_lines(&all), before + 2);
    let chart = plane::chart(&all, None);
    let [x, y] = all[1].row.level_db;
    let has = |ends: [[f64; 2]; 2]| chart.series.iter().any(|series| series.points == ends);
    assert!(has([[x - 6.0, y], [x + 2.0, y]]), "40 Hz");
    assert!(has([[x, y - 1.0], [x, y + 4.0]]), "320 Hz");
    let low = chart.columns.points("low_40_db", "high_320_db");
    assert_eq!(low[1], [-6.0, 4.0]);
    assert!(low[0][0].is_nan(), "the others are measured");
}
