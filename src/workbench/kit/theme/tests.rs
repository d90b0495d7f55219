//! Contrast of every colour, and lightness of every colour map, computed.

use super::*;

/// WCAG 2 relative luminance.
fn luminance(colour: Color32) -> f64 {
    let [r, g, b, _] = colour.to_array().map(|c| {
        let c = f64::from(c) / 255.0;
        if c <= 0.040_45 {
            c / 12.92
        } else {
            ((c + 0.055) / 1.055).powf(2.4)
        }
    });
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

fn contrast(a: Color32, b: Color32) -> f64 {
    let (a, b) = (luminance(a), luminance(b));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

fn both() -> [&'static Palette; 2] {
    [egui::Theme::Dark, egui::Theme::Light].map(Palette::of)
}

#[test]
fn text_stands_out_from_every_ground_it_is_written_on() {
    for palette in both() {
        for ground in [palette.floor, palette.panel, palette.raised, palette.tag] {
            for ink in [palette.text, palette.dim, palette.selection] {
                assert!(
                    contrast(ink, ground) >= 4.5,
                    "{ink:?} on {ground:?}: {}",
                    contrast(ink, ground)
                );
            }
        }
        assert!(
            contrast(palette.text, palette.hovered) >= 4.5,
            "text under the pointer"
        );
        assert!(
            contrast(palette.on_danger, palette.danger) >= 4.5,
            "{}",
            contrast(palette.on_danger, palette.danger)
        );
        for ink in [palette.low, palette.high] {
            assert!(
                contrast(ink, palette.panel) >= 4.5,
                "band titles: {}",
                contrast(ink, palette.panel)
            );
        }
    }
}

#[test]
fn words_on_a_stage_are_read_from_a_metre_away() {
    for palette in [Palette::of(egui::Theme::Dark), Palette::stark()] {
        for ground in [palette.floor, palette.raised, palette.hovered, palette.tag] {
            for ink in [palette.text, palette.faint] {
                let contrast = contrast(ink, ground);
                assert!(contrast >= 7.0, "{ink:?} on {ground:?}: {contrast}");
            }
        }
        assert!(contrast(palette.floor, palette.selection) >= 7.0);
    }
    for ground in [Palette::stark().floor, Palette::stark().hovered] {
        assert!(contrast(Palette::stark().line, ground) >= 7.0);
    }
}

#[test]
fn graphics_stand_out_from_panel_and_floor() {
    for palette in both() {
        for ground in [palette.floor, palette.panel] {
            let inks = [
                palette.low,
                palette.high,
                palette.contactor,
                palette.danger,
                palette.line,
                palette.others()[0],
                palette.others()[1],
            ];
            for ink in inks {
                assert!(
                    contrast(ink, ground) >= 3.0,
                    "{ink:?} on {ground:?}: {}",
                    contrast(ink, ground)
                );
            }
        }
    }
}

#[test]
fn lit_contactors_stand_out_from_their_rim_on_any_cloth() {
    for palette in both() {
        for cloth in [0_u8, 64, 128, 192, 255] {
            let dimmed = u16::from(cloth) * u16::from(255 - palette.rim.a()) / 255;
            let rim = Color32::from_gray(u8::try_from(dimmed).unwrap());
            for ink in [palette.lit, palette.faint] {
                assert!(contrast(ink, rim) >= 3.0, "{}", contrast(ink, rim));
            }
        }
    }
}

#[test]
fn every_colour_map_only_gets_lighter() {
    for map in ColourMap::ALL {
        let lightness: Vec<f64> = (0..=200)
            .map(|i| luminance(map.colour(f64::from(i) / 200.0)))
            .collect();
        assert!(
            lightness.windows(2).all(|pair| pair[1] >= pair[0]),
            "{map:?}: {lightness:?}"
        );
        assert!(
            lightness[200] > lightness[0] + 0.5,
            "{map:?} spans dark to bright"
        );
    }
}

/// A colour as eyes without red (0), green (1) or blue (2) cones see it, linear: Machado, Oliveira
/// and Fernandes (2009) at full severity.
fn seen_without(cone: usize, colour: Color32) -> [f64; 3] {
    const SEEN: [[[f64; 3]; 3]; 3] = [
        [
            [0.152_286, 1.052_583, -0.204_868],
            [0.114_503, 0.786_281, 0.099_216],
            [-0.003_882, -0.048_116, 1.051_998],
        ],
        [
            [0.367_322, 0.860_646, -0.227_968],
            [0.280_085, 0.672_501, 0.047_413],
            [-0.011_820, 0.042_940, 0.968_881],
        ],
        [
            [1.255_528, -0.076_749, -0.178_779],
            [-0.078_411, 0.930_809, 0.147_602],
            [0.004_733, 0.691_367, 0.303_900],
        ],
    ];
    let [r, g, b, _] = colour.to_array().map(|c| (f64::from(c) / 255.0).powf(2.2));
    SEEN[cone].map(|[x, y, z]| x * r + y * g + z * b)
}

#[test]
fn differences_leave_zero_alike_and_are_told_apart_by_every_colour_vision() {
    for palette in both() {
        let map = palette.differences();
        let away = |share: f64| contrast(map.colour(share), map.colour(0.0));
        for sign in [-1.0, 1.0] {
            let arm: Vec<f64> = (0..=20).map(|i| away(sign * f64::from(i) / 20.0)).collect();
            assert!(arm.windows(2).all(|pair| pair[1] >= pair[0]), "{arm:?}");
        }
        let [below, above] = [away(-1.0), away(1.0)];
        assert!(below >= 5.0 && above >= 5.0, "{below} {above}");
        assert!((below / above).ln().abs() < 0.2, "{below} {above}");
        for cone in 0..3 {
            for share in [0.3, 0.6, 1.0] {
                let [one, other] = [-share, share].map(|s| seen_without(cone, map.colour(s)));
                let apart: f64 = (0..3).map(|i| (one[i] - other[i]).abs()).sum();
                assert!(apart > 0.05, "{share} without cone {cone}: {apart}");
            }
        }
        assert_eq!(map.colour(f64::NAN), map.colour(0.0));
        assert_eq!(map.colour(7.0), map.colour(1.0));
    }
}

#[test]
fn colours_beyond_the_scale_are_its_ends() {
    for map in ColourMap::ALL {
        assert_eq!(map.colour(-3.0), map.colour(0.0));
        assert_eq!(map.colour(f64::INFINITY), map.colour(1.0));
        assert_eq!(map.colour(f64::NAN), map.colour(0.0));
    }
}
