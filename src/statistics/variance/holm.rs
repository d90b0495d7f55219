//! Many comparisons at once.

/// p values adjusted for their number by Holm's method (1979), in the order given: the j-th
/// smallest times m − j + 1, none below the one before it, none above 1.
pub fn holm(p: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|&a, &b| p[a].total_cmp(&p[b]));
    let mut adjusted = vec![0.0; p.len()];
    let mut least: f64 = 0.0;
    for (place, &which) in order.iter().enumerate() {
        least = least.max((p.len() - place) as f64 * p[which]).min(1.0);
        adjusted[which] = least;
    }
    adjusted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_is_multiplied_most_and_order_is_kept() {
        assert_eq!(holm(&[0.5, 0.125, 0.03125]), [0.5, 0.25, 0.09375]);
        assert_eq!(holm(&[0.4, 0.25, 0.3]), [0.75, 0.75, 0.75], "never below");
        assert_eq!(holm(&[0.9, 0.6]), [1.0, 1.0], "never above one");
        assert!(holm(&[]).is_empty(), "nothing to adjust");
    }
}
