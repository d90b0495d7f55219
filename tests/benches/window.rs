//! What a frame of the window costs the thread that draws it: logic, layout and tessellation, with
//! the pointer stroking cloth, at 1400 × 900. What the graphics card then does is not counted.
//!
//! Runs without a display. The accessibility tree is on, which a window without a reader leaves
//! out: the figures are an upper bound.

#![expect(clippy::print_stdout, reason = "a bench prints its figures")]
#![expect(
    clippy::unwrap_used,
    reason = "a bench that cannot run says so by panicking"
)]

use std::hint::black_box;
use std::time::Instant;

use eframe::egui::{pos2, vec2};
use egui_kittest::Harness;
use selvedge::app::{Drive, Workbench};
use selvedge::numerics::{median, quantile};
use selvedge::progress::thread_cpu_seconds;
use selvedge::quantity::time_span;

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
    let mut logic_and_layout_s = Vec::new();
    let mut tessellation_s = Vec::new();
    let mut frame_s = Vec::new();
    for frame in 0..FRAMES {
        let x = 200.0 + f32::from(frame % 200);
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
    show("logic and layout", &mut logic_and_layout_s);
    show("tessellation", &mut tessellation_s);
    show("together", &mut frame_s);
}

fn show(what: &str, times_s: &mut [f64]) {
    let p99 = quantile(times_s, 0.99);
    println!(
        "{what}: CPU a frame, median {}, p99 {}, {FRAMES} frames",
        time_span(median(times_s)),
        time_span(p99)
    );
}
