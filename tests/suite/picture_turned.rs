//! Several pictures of one cloth, turned: the command, what it keeps and what it refuses.

use selvedge_foundation::files::Rgb8Image;
use selvedge_foundation::numerics::{Random, to_byte};

use crate::program::Lab;

const SIDE: usize = 200;

/// Brightness of a fleece that repeats nowhere.
pub(crate) fn fleece(seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    let mut values = vec![0.5; SIDE * SIDE];
    for _ in 0..2500 {
        let (x, y) = (random.index(SIDE), random.index(SIDE));
        let up = random.uniform_in(-0.25, 0.25);
        for j in y.saturating_sub(4)..(y + 5).min(SIDE) {
            for i in x.saturating_sub(4)..(x + 5).min(SIDE) {
                let square = i.abs_diff(x).pow(2) + j.abs_diff(y).pow(2);
                values[j * SIDE + i] += up * (-0.25 * square as f64).exp();
            }
        }
    }
    values
}

/// A picture of it, reddish; turned by a quarter counter-clockwise so often.
pub(crate) fn picture(values: &[f64], n_quarters: usize) -> Vec<u8> {
    let at = |x: usize, y: usize| {
        let turned = |(x, y): (usize, usize)| (SIDE - 1 - y, x);
        let (x, y) = (0..n_quarters).fold((x, y), |place, _| turned(place));
        let value = 220.0 * values[y * SIDE + x].clamp(0.0, 1.0);
        [value, 0.5 * value, 0.25 * value].map(to_byte)
    };
    let image = Rgb8Image {
        width: SIDE,
        height: SIDE,
        pixels: (0..SIDE * SIDE).map(|i| at(i % SIDE, i / SIDE)).collect(),
    };
    image.to_png("cloth.png".as_ref()).unwrap()
}

const COMMAND: [&str; 10] = [
    "picture",
    "a.png",
    "--out",
    "made",
    "--px-per-mm",
    "10",
    "--relief-um",
    "200",
    "--textile",
    "cloth",
];

#[test]
fn turned_pictures_are_laid_over_the_first_kept_and_rebuilt() {
    let lab = Lab::new();
    let values = fleece(3);
    lab.write("a.png", picture(&values, 0));
    lab.write("b.png", picture(&values, 1));
    lab.write("c.png", picture(&values, 2));
    let said = lab.print(&[&COMMAND[..], &["--turned", "b.png", "--turned", "c.png"]].concat());
    assert!(
        said.contains("b.png shows it turned by 90.0° (match 0."),
        "{said}"
    );
    assert!(
        said.contains("c.png shows it turned by 180.0°") || said.contains("by -180.0°"),
        "{said}"
    );
    assert!(
        said.contains("The turned pictures put the tilt within"),
        "{said}"
    );
    let manifest = lab.read("cloth/textile.toml");
    assert_eq!(
        manifest.matches("[[source.turned]]").count(),
        2,
        "{manifest}"
    );
    assert!(manifest.contains("turn_deg = 90.0"), "{manifest}");
    assert!(manifest.contains("[uncertainty]"), "{manifest}");
    let before = ["appearance.png", "heights.png"]
        .map(|name| std::fs::read(lab.path("cloth").join(name)).unwrap());
    lab.print(&["textile", "rebuild", "cloth"]);
    let after = ["appearance.png", "heights.png"]
        .map(|name| std::fs::read(lab.path("cloth").join(name)).unwrap());
    assert_eq!(before, after, "it looks and is as it was");
    assert_eq!(lab.read("cloth/textile.toml"), manifest);
    // It looks like the photograph.
    let look = selvedge_foundation::files::Rgb16Image::decode(&after[0], "a".as_ref()).unwrap();
    let sums = look.pixels.iter().fold([0.0; 3], |sums, pixel| {
        [0, 1, 2].map(|i| sums[i] + f64::from(pixel[i]))
    });
    let [green, blue] = [sums[1] / sums[0], sums[2] / sums[0]];
    assert!(
        (green - 0.5).abs() < 0.03 && (blue - 0.25).abs() < 0.03,
        "{green} {blue}"
    );
}

#[test]
fn what_cannot_be_laid_over_the_first_is_refused_in_a_line() {
    let lab = Lab::new();
    lab.write("a.png", picture(&fleece(3), 0));
    lab.write("b.png", picture(&fleece(4), 1));
    lab.write("none.png", "no picture");
    for (more, part) in [
        (
            &["--turned", "b.png"][..],
            "b.png: it does not show the cloth",
        ),
        (&["--turned", "none.png"], "none.png"),
        (&["--turned", "missing.png"], "missing.png"),
        (
            &["--turned", "b.png", "--relief-of", "cell"],
            "--relief-of picture or synthesized",
        ),
        (
            &["--turned", "b.png", "--shading", "tsai-shah"],
            "takes one picture",
        ),
        (&["--turned", "b.png", "--region", "0,0,90,90"], "--region"),
        (
            &[
                "--turned", "b.png", "--turned", "b.png", "--turned", "b.png", "--turned", "b.png",
            ],
            "up to three",
        ),
    ] {
        let line = lab.refuse(&[&COMMAND[..], more].concat());
        assert!(line.contains(part), "{more:?}: {line}");
    }
}
