//! Texts: what their headings state, what is asked for, and where both differ.

use super::super::{HeightOptions, LengthUnit, Measured};
use crate::error::TextileError;
use std::path::Path;

pub(in super::super) const TWO_COLUMNS: &str = "0.0 1.0\n0.1 2.0\n0.2 3.0\n";

pub(in super::super) fn read_text(
    text: &str,
    asked: &HeightOptions,
) -> Result<Measured, TextileError> {
    Measured::open(text.as_bytes(), Path::new("a.txt"), asked)
}

#[test]
fn units_that_are_given_count_and_what_is_known_better_is_said() {
    let mut asked = HeightOptions {
        height_unit: Some(LengthUnit::Nanometre),
        ..HeightOptions::default()
    };
    let error = read_text(TWO_COLUMNS, &asked).unwrap_err().to_string();
    assert!(
        error.contains("the unit of the places is not stated"),
        "{error}"
    );
    asked.length_unit = Some(LengthUnit::Millimetre);
    let profile = read_text(TWO_COLUMNS, &asked).unwrap();
    assert_eq!(
        (profile.step_mm[0], profile.heights_um.row(0)[2]),
        (0.1, 0.003)
    );
    let falling = read_text("0.2;3,0\n0.1;2,0\n0.0;1,5\n", &asked).unwrap();
    assert_eq!(
        falling.heights_um.row(0)[0],
        0.0015,
        "falling places are turned round"
    );
    let line = refused("x_mm,height_m\n0,1\n0.1,2\n0.2,3\n", &asked);
    assert!(
        line.contains("states the heights in m, nm was asked for"),
        "{line}"
    );
}

fn refused(text: &str, asked: &HeightOptions) -> String {
    read_text(text, asked).unwrap_err().to_string()
}

#[test]
fn steps_that_are_stated_are_not_overridden() {
    let text = "x_mm,height_um\n0,1\n0.1,2\n0.2,3\n";
    let with_step = |step_mm: f64| HeightOptions {
        step_mm: Some(step_mm),
        ..HeightOptions::default()
    };
    let line = refused(text, &with_step(0.2));
    assert!(line.contains("lie 0.1 mm apart, not 0.2 mm"), "{line}");
    assert_eq!(read_text(text, &with_step(0.1)).unwrap().step_mm[0], 0.1);
    // Numbers without a unit are no places for sure: the step stands for them.
    let bare = read_text("x;height_um\n0;1\n1;2\n2;3\n", &with_step(0.2)).unwrap();
    assert_eq!(bare.step_mm[0], 0.2);
}

#[test]
fn uneven_places_are_brought_to_even_steps_where_that_is_wanted() {
    let text = "x_mm,height_um\n0,0\n0.1,10\n0.4,40\n0.5,\n0.6,60\n";
    let line = refused(text, &HeightOptions::default());
    assert!(line.contains("--resample"), "{line}");
    let asked = HeightOptions {
        resample: true,
        ..HeightOptions::default()
    };
    let even = read_text(text, &asked).unwrap();
    assert!((even.step_mm[0] - 0.15).abs() < 1e-9, "{:?}", even.step_mm);
    let heights = even.heights_um.row(0);
    for (found, expected) in heights.iter().zip([0.0, 15.0, 30.0, f64::NAN, 60.0]) {
        let is_near = (found - expected).abs() < 1e-9;
        assert!(
            is_near || (found.is_nan() && expected.is_nan()),
            "{heights:?}"
        );
    }
    assert!(
        even.warnings[0].contains("brought to even steps"),
        "{even:?}"
    );
    let falling = "x_mm,height_um\n0.6,60\n0.4,40\n0.1,10\n0,0\n";
    let falling = read_text(falling, &asked).unwrap();
    let heights = falling.heights_um.row(0);
    assert!((heights[1] - 20.0).abs() < 1e-9, "{heights:?}");
    let same = refused("x_mm,height_um\n1,0\n1,10\n1,40\n", &asked);
    assert!(!same.contains('\n'), "{same}");
}

#[test]
fn headers_of_matrices_state_sizes_of_a_pixel_and_units() {
    let rows = "1 2 3 4 5\n2 3 4 5 6\n3 4 5 6 7\n";
    for (header, step_mm) in [
        ("# Pixel size: 5 µm\n# Height unit: nm\n", [0.005; 2]),
        (
            "# Pixel size x [um] = 5\n# Pixel size y [um] = 10\n# z unit = nm\n",
            [0.005, 0.01],
        ),
        ("# dx: 0.005 mm\n# dy: 5um\n# Heights: nm\n", [0.005; 2]),
    ] {
        let read = read_text(&format!("{header}{rows}"), &HeightOptions::default());
        let read = read.unwrap_or_else(|error| panic!("{header}: {error}"));
        assert_eq!((read.heights_um.width(), read.heights_um.height()), (5, 3));
        for axis in [0, 1] {
            let off = (read.step_mm[axis] - step_mm[axis]).abs();
            assert!(off < 1e-12, "{header} {:?}", read.step_mm);
        }
        assert_eq!(read.heights_um.row(2)[0], 0.001, "{header}");
    }
    let asked = HeightOptions {
        step_mm: Some(0.05),
        ..HeightOptions::default()
    };
    let line = refused(&format!("# Pixel size: 5 µm\n# z unit: nm\n{rows}"), &asked);
    assert!(line.contains("lie 0.005 mm apart, not 0.05 mm"), "{line}");
    let line = refused(
        &format!("# Pixel size: 5 furlongs\n{rows}"),
        &HeightOptions::default(),
    );
    assert!(!line.contains('\n'), "{line}");
}

#[test]
fn a_column_among_many_is_chosen_by_name_or_number() {
    let text = ",first,second\n0,1.5,7\n1,2.5,8\n2,,9\n";
    let mut asked = HeightOptions {
        height_unit: Some(LengthUnit::Micrometre),
        ..HeightOptions::default()
    };
    for column in ["first", "2"] {
        asked.column = Some(column.to_owned());
        let error = Measured::open(text.as_bytes(), Path::new("a.csv"), &asked).unwrap_err();
        assert!(
            error
                .to_string()
                .contains("distance of points is not stated"),
            "{error}"
        );
        let with_step = HeightOptions {
            step_mm: Some(0.01),
            ..asked.clone()
        };
        let read = Measured::open(text.as_bytes(), Path::new("a.csv"), &with_step).unwrap();
        assert_eq!(read.heights_um.values(), [1.5, 2.5]);
    }
    asked.column = Some("third".to_owned());
    let error = Measured::open(text.as_bytes(), Path::new("a.csv"), &asked)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("no column \"third\"; the columns are 1, 2 \"first\""),
        "{error}"
    );
}
