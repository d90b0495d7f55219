use super::batch::*;
use super::ours::*;
use crate::example::*;
use crate::score::*;
use crate::signal::*;
use burn::optim::{AdamConfig, GradientsParams};
use burn::tensor::Device;
use burn::module::Module;
use selvedge_foundation::numerics::{Grid, Random};
use std::time::Instant;

#[test]
#[ignore = "exploration"]
fn explore() {
    let var = |name: &str, usual: usize| std::env::var(name).map_or(usual, |n| n.parse().unwrap());
    let scale = var("N", 40);
    let [learnt, held_back] = Split::Cloths.windows(40);
    let mut learnt = learnt;
    if scale > 40 {
        learnt = Split::Cloths.windows(scale + 10)[0].clone();
        learnt.retain(|w| !(40..50).contains(&w.seed));
    }
    let t = Instant::now();
    let [learnt, held_back] = [learnt, held_back].map(|windows| all_taken(&windows, 2));
    println!("{} examples in {:?}", learnt.len(), t.elapsed());
    let device = Device::flex().autodiff();
    let mut model = drawn(Ours::new(var("W", 16), var("L", 3), &device), 1);
    println!("{} parameters", model.num_params());
    let mut optim = AdamConfig::new().init();
    let scales = Scales::of(&learnt);
    let n_epochs = var("E", 10);
    let batch = var("B", 8);
    let mut random = Random::new(5);
    let mut order: Vec<usize> = (0..learnt.len()).collect();
    let total = n_epochs * learnt.len() / batch;
    let mut step = 0;
    let start = Instant::now();
    for epoch in 0..n_epochs {
        random.shuffle(&mut order);
        let mut sum = [0.0_f32; 3];
        for part in order.chunks_exact(batch) {
            let examples: Vec<&Example> = part.iter().map(|&n| &learnt[n]).collect();
            let [b, f] = [batch, 11];
            let out = model.forward(inputs(&examples, &scales, &device));
            let log: Vec<f32> = examples.iter().flat_map(|e| e.course.log_magnitudes.values().chunks(N_BINS).flat_map(|row| row.iter().zip(&scales.logs).map(|(v, [m, _])| v - m))).collect();
            let level: Vec<f32> = examples.iter().map(|e| of_level(e.course.level) as f32).collect();
            let trend: Vec<f32> = examples.iter().flat_map(|e| e.course.trend.iter().map(|t| (t / 0.01) as f32)).collect();
            let l1 = (out.log - tensor(log, [b, f, N_BINS], &device)).abs().mean();
            let l2 = (out.level - tensor(level, [b, 1], &device)).abs().mean();
            let l3 = (out.trend - tensor(trend, [b, f], &device)).abs().mean();
            sum[0] += l1.clone().into_scalar::<f32>();
            sum[1] += l2.clone().into_scalar::<f32>();
            sum[2] += l3.clone().into_scalar::<f32>();
            let loss = l1 + l2.mul_scalar(0.3) + l3.mul_scalar(0.05);
            let grads = GradientsParams::from_grads(loss.backward(), &model);
            let share = step as f64 / total as f64;
            let lr = var("LR", 2) as f64 * 1e-3 * (0.5 + 0.5 * (std::f64::consts::PI * share).cos()) + 1e-5;
            model = optim.step(lr, model, grads);
            step += 1;
        }
        let n = (learnt.len() / batch) as f32;
        println!("epoch {epoch}: {:?} {:.0?}", sum.map(|s| s / n), start.elapsed());
    }
    let plain = Device::flex();
    let model = model.valid();
    let _ = plain;
    let mut mean = [0.0; MEASURES.len()];
    let mut time = 0.0;
    for example in &held_back {
        let t = Instant::now();
        let out = model.forward(inputs(&[example], &scales, &device.clone().inner()));
        let log: Vec<f32> = out.log.into_data().to_vec().unwrap();
        let trend: Vec<f32> = out.trend.into_data().to_vec().unwrap();
        let level: Vec<f32> = out.level.into_data().to_vec().unwrap();
        time += t.elapsed().as_secs_f64();
        let course = Course {
            level: 0.38 + 0.05 * f64::from(level[0]),
            trend: trend.iter().map(|&t| 0.01 * f64::from(t)).collect(),
            log_magnitudes: Grid::from_rows(N_BINS, log.iter().enumerate().map(|(n, l)| (l + scales.logs[n % N_BINS][0]).max(0.0)).collect()).unwrap(),
        };
        let found = score(&Prediction::of_course(&course), &example.trace);
        mean.iter_mut().zip(found).for_each(|(sum, x)| *sum += x / held_back.len() as f64);
    }
    println!("ours {mean:8.3?}; forward {:.1} ms", 1e3 * time / held_back.len() as f64);
}
