//! What procedural cloth promises: the same place is the same in every part; figures of friction
//! lie where they were measured; a print changes the picture and not the friction.

use super::*;

fn strip(columns: [usize; 2]) -> Area {
    Area {
        columns,
        rows: [0, FINGER_ROWS],
    }
}

fn rubbed(recipe: &Recipe, area: Area, stroke: u64) -> Rubbed {
    recipe.rubbed(&recipe.relief_um(area), area, stroke)
}

#[test]
fn a_part_is_the_same_whatever_is_made_around_it() {
    for family in Family::ALL {
        let recipe = Recipe::of(family, 3);
        let whole = recipe.relief_um(Area {
            columns: [40, 200],
            rows: [0, 60],
        });
        let part = recipe.relief_um(Area {
            columns: [90, 50],
            rows: [20, 30],
        });
        assert_eq!(whole.part([50, 20, 50, 30]).unwrap(), part, "{family:?}");
        assert_eq!(recipe, Recipe::of(family, 3));
        assert_ne!(recipe, Recipe::of(family, 4));
    }
}

#[test]
fn friction_lies_where_it_was_measured() {
    let (mut means, mut deviations) = (Vec::new(), Vec::new());
    for family in Family::ALL {
        for seed in 0..6 {
            let recipe = Recipe::of(family, 100 + seed);
            let rubbed = rubbed(&recipe, strip([0, 1280]), 0);
            let mean = rubbed.friction.iter().sum::<f64>() / 1280.0;
            let variance = rubbed
                .friction
                .iter()
                .map(|f| (f - mean).powi(2))
                .sum::<f64>()
                / 1280.0;
            means.push(mean);
            deviations.push(variance.sqrt() / mean);
        }
    }
    assert!(
        means.iter().all(|mean| (0.2..0.65).contains(mean)),
        "{means:?}"
    );
    let middle = selvedge_foundation::numerics::median(&mut deviations);
    assert!((0.02..0.06).contains(&middle), "{deviations:?}");
}

#[test]
fn a_print_is_seen_and_not_felt() {
    let recipe = Recipe::of(Family::Plain, 9);
    let area = strip([0, 400]);
    let plain = Camera {
        print: 0.0,
        ..Camera::of(1)
    };
    let printed = Camera {
        print: 1.0,
        ..plain
    };
    let [a, b] =
        [plain, printed].map(|camera| recipe.photo(&recipe.relief_um(area), area, &camera));
    let mean = |photo: &Grid<f32>| {
        photo.values().iter().map(|&v| f64::from(v)).sum::<f64>() / photo.values().len() as f64
    };
    assert!(
        mean(&b) < 0.9 * mean(&a),
        "{} against {}",
        mean(&b),
        mean(&a)
    );
    assert!(a.values().iter().all(|v| (0.0..=1.0).contains(v)));
    assert_eq!(rubbed(&recipe, area, 1), rubbed(&recipe, area, 1));
    let [one, two] = [1, 2].map(|stroke| rubbed(&recipe, area, stroke));
    assert_eq!(one.of_surface, two.of_surface);
    assert_ne!(one.friction, two.friction);
}
