//! What a frame of the window costs the thread that draws it: logic, layout and tessellation, with
//! the display exploring by itself, at 1400 × 900: once as a new user sees it, once with the drive
//! spectrum beside everything else, and with four hours on the line of time. What the graphics card
//! then does is not counted.
//!
//! Runs without a display. The accessibility tree is on, which a window without a reader leaves
//! out: the figures are an upper bound.

#![expect(clippy::print_stdout, reason = "a bench prints its figures")]
#![expect(
    clippy::unwrap_used,
    reason = "a bench that cannot run says so by panicking"
)]

use std::collections::BTreeMap;
use std::hint::black_box;
use std::time::Instant;

use eframe::egui::epaint::{ClippedPrimitive, Primitive};
use eframe::egui::{
    Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, Shape, TouchPhase, pos2, vec2,
};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use selvedge_foundation::numerics::{median, quantile};
use selvedge_foundation::progress::thread_cpu_seconds;
use selvedge_foundation::quantity::time_span;
use selvedge_workbench::{Drive, Workbench};

const FRAMES: u16 = 400;

fn main() {
    let start = Instant::now();
    let mut harness = Harness::builder()
        .with_size(vec2(1400.0, 900.0))
        .with_step_dt(1.0 / 30.0)
        .build_eframe(|cc| Workbench::new(&cc.egui_ctx, None, Drive::Stepped).unwrap());
    println!(
        "scene opened, first frames: {}",
        time_span(start.elapsed().as_secs_f64())
    );
    harness.key_press(Key::Space);
    harness.run_steps(20);
    println!("as a new user sees it:");
    measure(&mut harness);
    dock_drive_spectrum(&mut harness);
    println!("with both spectra beside everything else:");
    measure(&mut harness);
    measure_four_hours(&mut harness);
}

/// Four hours of to and fro on the line of time: replayed, and zoomed in and out with every frame.
fn measure_four_hours(harness: &mut Harness<'_, Workbench>) {
    let file = std::env::temp_dir().join(format!("selvedge-four-hours-{}.csv", std::process::id()));
    let row = |nth: u32| format!("{},{},{}\n", nth, 30 + 150 * (nth % 2), 40 + nth % 140);
    let rows: String = (0..4 * 3600).map(row).collect();
    std::fs::write(&file, format!("t_s,x_mm,y_mm\n{rows}")).unwrap();
    let start = Instant::now();
    harness.state_mut().open_recording(file.clone());
    harness.run_steps(3);
    let made = time_span(start.elapsed().as_secs_f64());
    println!(
        "four hours on the line of time: every tick rendered and its spectrum taken in {made}"
    );
    std::fs::remove_file(file).unwrap();
    harness.key_press(Key::Space);
    harness.run_steps(3);
    println!("four hours, replayed:");
    measure(harness);
    println!("four hours, zoomed with every frame:");
    let mut frame_s = Vec::new();
    let lanes = harness.get_by_label_contains("Timeline of").rect().center();
    for frame in 0..FRAMES {
        harness.hover_at(lanes);
        harness.event(Event::MouseWheel {
            unit: MouseWheelUnit::Point,
            delta: vec2(0.0, if frame % 100 < 50 { 40.0 } else { -40.0 }),
            source: MouseWheelSource::Unknown,
            phase: TouchPhase::Move,
            modifiers: Modifiers::NONE,
        });
        let start_s = thread_cpu_seconds();
        harness.step();
        frame_s.push(thread_cpu_seconds() - start_s);
    }
    show("  logic and layout", &mut frame_s);
}

/// Drags the drive spectrum by its title from behind the contact spectrum to below it.
fn dock_drive_spectrum(harness: &mut Harness<'_, Workbench>) {
    let from = harness.get_by_label("Drive spectrum").rect().center();
    let plot = harness.get_by_label_contains("Contact spectrum of").rect();
    let to = plot.center_bottom() - vec2(0.0, 0.1 * plot.height());
    harness.hover_at(from);
    harness.step();
    harness.drag_at(from);
    harness.step();
    for nth in 1..=10_u8 {
        harness.hover_at(from.lerp(to, f32::from(nth) / 10.0));
        harness.step();
    }
    harness.drop_at(to);
    harness.run_steps(20);
    let drawn = |harness: &Harness<'_, Workbench>| {
        let panes = harness.state().panes_drawn();
        let is_spectrum = |title: &str| title.ends_with("spectrum");
        let spectra = panes.into_iter().filter(|(title, _)| is_spectrum(title));
        spectra.map(|(_, n_drawn)| n_drawn).collect::<Vec<_>>()
    };
    let before = drawn(harness);
    harness.run_steps(1);
    let after = drawn(harness);
    assert!(
        after
            .iter()
            .zip(&before)
            .all(|(after, before)| after > before),
        "both spectra are in sight: {before:?}, {after:?}"
    );
}

fn measure(harness: &mut Harness<'_, Workbench>) {
    let mut logic_and_layout_s = Vec::new();
    let mut tessellation_s = Vec::new();
    let mut frame_s = Vec::new();
    for frame in 0..FRAMES {
        let x = 300.0 + f32::from(frame % 200);
        harness.hover_at(pos2(x, 480.0));
        let start_s = thread_cpu_seconds();
        harness.step();
        let laid_out_s = thread_cpu_seconds();
        let output = harness.output();
        black_box(
            harness
                .ctx
                .tessellate(output.shapes.clone(), output.pixels_per_point),
        );
        let end_s = thread_cpu_seconds();
        logic_and_layout_s.push(laid_out_s - start_s);
        tessellation_s.push(end_s - laid_out_s);
        frame_s.push(end_s - start_s);
    }
    show("  logic and layout", &mut logic_and_layout_s);
    show("  tessellation", &mut tessellation_s);
    show("  together", &mut frame_s);
    count(harness);
}

/// What the graphics card is given in a frame: where software stands in for it, every vertex costs
/// time of the thread that draws.
fn count(harness: &Harness<'_, Workbench>) {
    let output = harness.output();
    let scale = output.pixels_per_point;
    let drawn = harness.ctx.tessellate(output.shapes.clone(), scale);
    let mut by_kind: BTreeMap<&str, usize> = BTreeMap::new();
    for shape in &output.shapes {
        let alone = harness.ctx.tessellate(vec![shape.clone()], scale);
        *by_kind.entry(kind(&shape.shape)).or_default() += n_vertices(&alone);
    }
    let parts = by_kind.iter().map(|(kind, n)| format!("{n} {kind}"));
    println!(
        "  a frame: {} draw calls, {} vertices ({})",
        drawn.len(),
        n_vertices(&drawn),
        parts.collect::<Vec<_>>().join(", ")
    );
}

fn n_vertices(drawn: &[ClippedPrimitive]) -> usize {
    let in_mesh = drawn.iter().map(|part| match &part.primitive {
        Primitive::Mesh(mesh) => mesh.vertices.len(),
        Primitive::Callback(_) => 0,
    });
    in_mesh.sum()
}

fn kind(shape: &Shape) -> &'static str {
    match shape {
        Shape::Text(_) => "in text",
        Shape::Path(_) | Shape::LineSegment { .. } | Shape::Vec(_) => "in lines",
        Shape::Mesh(_) => "in pictures",
        _ => "in plain shapes",
    }
}

fn show(what: &str, times_s: &mut [f64]) {
    let p99 = quantile(times_s, 0.99);
    println!(
        "{what}: CPU a frame, median {}, p99 {}, {FRAMES} frames",
        time_span(median(times_s)),
        time_span(p99)
    );
}
