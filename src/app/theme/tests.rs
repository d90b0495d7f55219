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
fn graphics_stand_out_from_panel_and_floor() {
    for palette in both() {
        for ground in [palette.floor, palette.panel] {
            let inks = [
                palette.low,
                palette.high,
                palette.contactor,
                palette.danger,
                palette.line,
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

#[test]
fn colours_beyond_the_scale_are_its_ends() {
    for map in ColourMap::ALL {
        assert_eq!(map.colour(-3.0), map.colour(0.0));
        assert_eq!(map.colour(f64::INFINITY), map.colour(1.0));
        assert_eq!(map.colour(f64::NAN), map.colour(0.0));
    }
}
