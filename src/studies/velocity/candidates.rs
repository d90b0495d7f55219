//! The methods that are compared, each with several settings.

use selvedge_engine::VelocityMethod;

/// Acceleration density, mm²/s³.
const KALMAN: [f64; 6] = [1e4, 1e3, 3e4, 1e5, 1e6, 1e7];
/// What the Kalman filters take a coordinate's noise to be, mm.
const KALMAN_NOISE_MM: f64 = 0.05;

/// The candidates: `n_settings` of each method, the default among them.
pub(super) fn candidates(n_settings: usize) -> Vec<VelocityMethod> {
    let kalman = |acceleration_mm2_per_s3| VelocityMethod::Kalman {
        acceleration_mm2_per_s3,
        noise_mm: KALMAN_NOISE_MM,
    };
    let mut methods = vec![VelocityMethod::FiniteDifference];
    methods.extend(KALMAN.into_iter().take(n_settings).map(kalman));
    if !methods.contains(&VelocityMethod::default()) {
        methods.push(VelocityMethod::default());
    }
    methods
}

/// A method's setting in words; empty without any.
pub(super) fn setting(method: VelocityMethod) -> String {
    match method {
        VelocityMethod::FiniteDifference => String::new(),
        VelocityMethod::Kalman {
            acceleration_mm2_per_s3,
            noise_mm,
        } => format!("{acceleration_mm2_per_s3:.0e} mm²/s³, {noise_mm} mm"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_methods_and_the_default_are_among_the_candidates() {
        for n_settings in [1, 6] {
            let all = candidates(n_settings);
            let is_default = |method: &&VelocityMethod| **method == VelocityMethod::default();
            assert_eq!(all.iter().filter(is_default).count(), 1);
            let mut labels: Vec<_> = all.iter().map(|method| method.label()).collect();
            labels.dedup();
            assert!(labels.len() == 2, "{labels:?}");
        }
    }
}
