//! The methods that are compared, each with several settings.

use selvedge_engine::VelocityMethod;

/// A method and its setting in words.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Candidate {
    /// The method.
    pub(super) method: VelocityMethod,
    /// Its setting in words; empty without any.
    pub(super) setting: String,
}

/// Windows of the line fit, s.
const WINDOWS_S: [f64; 6] = [0.040, 0.020, 0.030, 0.050, 0.060, 0.080];
/// α and β.
const ALPHA_BETA: [[f64; 2]; 4] = [[0.5, 0.2], [0.3, 0.05], [0.4, 0.1], [0.8, 0.5]];
/// Acceleration density, mm²/s³.
const KALMAN: [f64; 6] = [1e4, 1e3, 3e4, 1e5, 1e6, 1e7];
/// What the Kalman filters take a coordinate's noise to be, mm.
const KALMAN_NOISE_MM: f64 = 0.05;
/// Cutoff at rest in Hz, β in 1/mm, derivative cutoff in Hz.
const ONE_EURO: [[f64; 3]; 6] = [
    [3.0, 0.05, 5.0],
    [1.0, 0.02, 1.0],
    [1.0, 0.1, 5.0],
    [20.0, 0.5, 10.0],
    [5.0, 0.2, 10.0],
    [10.0, 0.2, 10.0],
];

/// The candidates: `n_settings` of each method, the default among them.
pub(super) fn candidates(n_settings: usize) -> Vec<Candidate> {
    let line_fit = |window_s| VelocityMethod::LineFit { window_s };
    let alpha_beta = |[alpha, beta]: [f64; 2]| VelocityMethod::AlphaBeta { alpha, beta };
    let kalman = |acceleration_mm2_per_s3| VelocityMethod::Kalman {
        acceleration_mm2_per_s3,
        noise_mm: KALMAN_NOISE_MM,
    };
    let one_euro =
        |[min_cutoff_hz, beta_per_mm, derivative_cutoff_hz]: [f64; 3]| VelocityMethod::OneEuro {
            min_cutoff_hz,
            beta_per_mm,
            derivative_cutoff_hz,
        };
    let mut methods = vec![VelocityMethod::FiniteDifference];
    methods.extend(WINDOWS_S.into_iter().take(n_settings).map(line_fit));
    methods.extend(ALPHA_BETA.into_iter().take(n_settings).map(alpha_beta));
    methods.extend(KALMAN.into_iter().take(n_settings).map(kalman));
    methods.extend(ONE_EURO.into_iter().take(n_settings).map(one_euro));
    if !methods.contains(&VelocityMethod::default()) {
        methods.push(VelocityMethod::default());
    }
    let candidate = |method| Candidate {
        method,
        setting: setting(method),
    };
    methods.into_iter().map(candidate).collect()
}

fn setting(method: VelocityMethod) -> String {
    match method {
        VelocityMethod::FiniteDifference => String::new(),
        VelocityMethod::LineFit { window_s } => format!("{:.0} ms", 1e3 * window_s),
        VelocityMethod::AlphaBeta { alpha, beta } => format!("α {alpha}, β {beta}"),
        VelocityMethod::Kalman {
            acceleration_mm2_per_s3,
            noise_mm,
        } => format!("{acceleration_mm2_per_s3:.0e} mm²/s³, {noise_mm} mm"),
        VelocityMethod::OneEuro {
            min_cutoff_hz,
            beta_per_mm,
            derivative_cutoff_hz,
        } => format!("{min_cutoff_hz} Hz + {beta_per_mm}/mm, {derivative_cutoff_hz} Hz"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_candidate_is_sound_and_the_default_is_among_them() {
        for n_settings in [1, 6] {
            let all = candidates(n_settings);
            assert!(
                all.iter().all(|candidate| candidate.method.is_sound()),
                "sound"
            );
            let is_default = |c: &&Candidate| c.method == VelocityMethod::default();
            assert_eq!(all.iter().filter(is_default).count(), 1);
            let mut labels: Vec<_> = all.iter().map(|c| c.method.label()).collect();
            labels.dedup();
            assert!(labels.len() >= 5, "{labels:?}");
        }
    }
}
