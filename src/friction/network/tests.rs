//! What learning promises: it learns more than a mean, it goes on where it was broken off, a cloth
//! between two lies between them.

use super::learn::Network as _;
use super::*;
use crate::baseline::Baseline;
use crate::example::{Example, all_taken};
use crate::score::{Measure, Prediction, score};
use crate::split::Split;
use selvedge_foundation::progress::Progress;

fn small(method: Method) -> Lesson {
    Lesson {
        size: Size {
            width: 4,
            n_layers: 1,
        },
        n_rounds: 2,
        ..Lesson::usual(method, 3)
    }
}

fn examples() -> Vec<Example> {
    all_taken(&Split::Places.windows(2)[0], 2)
}

#[test]
fn learning_goes_on_where_it_was_broken_off_to_the_same_bytes() {
    let examples = examples();
    for method in Method::ALL {
        let lesson = small(method);
        let mut whole = Learning::begin(lesson, &examples);
        let first = Progress::unheard(|progress| whole.round(&examples, progress)).unwrap();
        let checkpoint = whole.checkpoint();
        let second = Progress::unheard(|progress| whole.round(&examples, progress)).unwrap();
        assert!(
            second.spectra < first.spectra,
            "{method:?}: {first:?}, {second:?}"
        );
        let mut resumed = Learning::resume(lesson, &examples, &checkpoint).unwrap();
        assert_eq!(resumed.n_rounds_done(), 1);
        assert_eq!(
            Progress::unheard(|progress| resumed.round(&examples, progress)).unwrap(),
            second
        );
        let [a, b] = [&whole, &resumed].map(|l| l.network().predict(&examples[0]).trace);
        assert!(a == b, "{method:?}");
        assert!(Learning::resume(lesson, &examples, &checkpoint[..20]).is_err());
    }
}

/// Mean distance of spectra from held-back windows, dB.
fn held_out(held_back: &[Example], predict: &dyn Fn(&Example) -> Prediction) -> f64 {
    let one = |example| Measure::LogSpectral.of(&score(&predict(example), &example.trace));
    held_back.iter().map(one).sum::<f64>() / held_back.len() as f64
}

#[test]
fn a_short_training_is_better_on_what_was_held_back_than_before_it_and_than_the_mean() {
    let [learnt, held_back] = Split::Cloths
        .windows(4)
        .map(|windows| all_taken(&windows, 2));
    let mean = Baseline::Mean.fitted(&learnt);
    let of_mean = held_out(&held_back, &|example| mean.predict(example));
    // FrictGAN begins with the mean magnitude of each bin, so that being better shows nothing.
    for method in [Method::Ours, Method::OursAdversarial] {
        let lesson = small(method);
        let mut learning = Learning::begin(lesson, &learnt);
        let error = |learning: &Learning| {
            let network = learning.network();
            held_out(&held_back, &|example| network.predict(example))
        };
        let before = error(&learning);
        for _ in 0..lesson.n_rounds {
            Progress::unheard(|progress| learning.round(&learnt, progress)).unwrap();
        }
        let after = error(&learning);
        assert!(
            after < before && after < of_mean,
            "{method:?}: {after} after {before}, mean {of_mean}"
        );
    }
}

#[test]
fn weights_come_back_from_their_file() {
    let examples = examples();
    let lesson = small(Method::Ours);
    let network = Learning::begin(lesson, &examples).network();
    let bytes = network.weights().unwrap().to_bytes();
    let weights = Weights::from_bytes(&bytes).unwrap();
    let back = OurNetwork::from_weights(&weights, lesson.size).unwrap();
    let traces = [back.predict(&examples[0]), network.predict(&examples[0])].map(|p| p.trace);
    assert!(traces[0] == traces[1]);
    assert!(OurNetwork::from_weights(&weights, Size::default()).is_err());
    for cut in [0, 8, 15, 16, bytes.len() - 1] {
        assert!(Weights::from_bytes(&bytes[..cut]).is_err(), "{cut}");
    }
}

#[test]
fn a_cloth_between_two_lies_between_them() {
    let examples = examples();
    let lesson = small(Method::Ours);
    let weights = Learning::begin(lesson, &examples)
        .network()
        .weights()
        .unwrap();
    let network = OurNetwork::from_weights(&weights, lesson.size).unwrap();
    let [a, b] = [&examples[0].looks, &examples[5].looks];
    let own = |looks| network.courses(&[looks]).pop().unwrap();
    assert_eq!(network.between(a, b, 0.0).unwrap(), own(a));
    assert_eq!(network.between(a, b, 1.0).unwrap(), own(b));
    let middle = network.between(a, b, 0.5).unwrap();
    assert!(middle != own(a) && middle != own(b));
}
