//! Pixel by pixel: coverage, blending, clipping, textures.

use eframe::egui::{
    ColorImage, ImageData, Mesh, Pos2, Rect, TextureFilter, TextureOptions, pos2, vec2,
};
use eframe::epaint::{ImageDelta, Vertex, WHITE_UV};

use super::*;

const TEXTURE: TextureId = TextureId::Managed(0);

fn rasteriser(size: [usize; 2], pixels: Vec<Color32>, options: TextureOptions) -> Rasteriser {
    let mut rasteriser = Rasteriser::default();
    let mut delta = TexturesDelta::default();
    let image = ImageData::Color(ColorImage::new(size, pixels).into());
    delta.push(TEXTURE, ImageDelta::full(image, options));
    rasteriser.apply(&mut delta);
    rasteriser
}

fn white() -> Rasteriser {
    rasteriser([1, 1], vec![Color32::WHITE], TextureOptions::NEAREST)
}

fn frame(mesh: Mesh, clip: Rect) -> [ClippedPrimitive; 1] {
    [ClippedPrimitive {
        clip_rect: clip,
        primitive: Primitive::Mesh(mesh),
    }]
}

fn everywhere() -> Rect {
    Rect::from_min_size(Pos2::ZERO, vec2(100.0, 100.0))
}

fn quad(corners: [Pos2; 4], colour: Color32) -> Mesh {
    let vertices = corners
        .map(|pos| Vertex {
            pos,
            uv: WHITE_UV,
            color: colour,
        })
        .to_vec();
    Mesh {
        indices: vec![0, 1, 2, 0, 2, 3],
        vertices,
        texture_id: TEXTURE,
    }
}

fn pixel(picture: &Picture, x: usize, y: usize) -> [u8; 4] {
    let first = 4 * (y * picture.width + x);
    [0, 1, 2, 3].map(|i| picture.rgba[first + i])
}

#[test]
fn triangles_that_share_an_edge_cover_every_pixel_once() {
    // Half-transparent: a pixel drawn twice would come out brighter, a gap darker.
    let half = Color32::from_rgba_premultiplied(100, 100, 100, 100);
    let corners = [
        pos2(0.5, 0.5),
        pos2(9.3, 1.2),
        pos2(8.5, 9.5),
        pos2(1.5, 8.1),
    ];
    let picture = white().draw(
        &frame(quad(corners, half), everywhere()),
        [10, 10],
        1.0,
        Color32::BLACK,
    );
    let mut seen = picture.rgba.chunks(4).map(|p| p[0]).collect::<Vec<_>>();
    assert!(seen.contains(&100), "{seen:?}");
    seen.retain(|&v| v != 0 && v != 100);
    assert!(seen.is_empty(), "pixels drawn more than once: {seen:?}");
}

#[test]
fn the_top_left_pixel_belongs_to_the_shape_and_the_bottom_right_does_not() {
    let corners = [
        pos2(1.5, 1.5),
        pos2(3.5, 1.5),
        pos2(3.5, 3.5),
        pos2(1.5, 3.5),
    ];
    let mesh = quad(corners, Color32::WHITE);
    let picture = white().draw(&frame(mesh, everywhere()), [5, 5], 1.0, Color32::BLACK);
    assert_eq!(pixel(&picture, 1, 1)[0], 255);
    assert_eq!(pixel(&picture, 2, 2)[0], 255);
    assert_eq!(pixel(&picture, 3, 3)[0], 0);
    assert_eq!(picture.rgba.chunks(4).filter(|p| p[0] == 255).count(), 4);
}

#[test]
fn blending_is_premultiplied_and_in_gamma_space() {
    let veil = Color32::from_rgba_premultiplied(64, 0, 0, 128);
    let corners = [
        pos2(0.0, 0.0),
        pos2(4.0, 0.0),
        pos2(4.0, 4.0),
        pos2(0.0, 4.0),
    ];
    let below = Color32::from_rgb(200, 100, 0);
    let picture = white().draw(
        &frame(quad(corners, veil), everywhere()),
        [4, 4],
        1.0,
        below,
    );
    assert_eq!(pixel(&picture, 2, 2), [164, 50, 0, 255]);
}

#[test]
fn nothing_is_drawn_outside_the_clip_rectangle_or_the_picture() {
    let corners = [
        pos2(-50.0, -50.0),
        pos2(90.0, -50.0),
        pos2(90.0, 90.0),
        pos2(-50.0, 90.0),
    ];
    let clip = Rect::from_min_max(pos2(2.0, 3.0), pos2(4.0, 99.0));
    let mesh = quad(corners, Color32::WHITE);
    let picture = white().draw(&frame(mesh, clip), [6, 6], 1.0, Color32::BLACK);
    assert_eq!(
        picture.rgba.chunks(4).filter(|p| p[0] == 255).count(),
        2 * 3
    );
    assert_eq!(pixel(&picture, 3, 3)[0], 255);
}

#[test]
fn points_are_scaled_to_pixels() {
    let corners = [
        pos2(1.0, 1.0),
        pos2(2.0, 1.0),
        pos2(2.0, 2.0),
        pos2(1.0, 2.0),
    ];
    let mesh = quad(corners, Color32::WHITE);
    let picture = white().draw(&frame(mesh, everywhere()), [6, 6], 2.0, Color32::BLACK);
    assert_eq!(picture.rgba.chunks(4).filter(|p| p[0] == 255).count(), 4);
    assert_eq!(pixel(&picture, 2, 2)[0], 255);
}

#[test]
fn a_repeated_texture_starts_again_and_a_linear_one_mixes() {
    let two = vec![Color32::BLACK, Color32::WHITE];
    let options = TextureOptions {
        wrap_mode: egui::TextureWrapMode::Repeat,
        ..TextureOptions::NEAREST
    };
    let mut mesh = quad(
        [
            pos2(0.0, 0.0),
            pos2(4.0, 0.0),
            pos2(4.0, 1.0),
            pos2(0.0, 1.0),
        ],
        Color32::WHITE,
    );
    for (vertex, u) in mesh.vertices.iter_mut().zip([0.0, 2.0, 2.0, 0.0]) {
        vertex.uv = pos2(u, 0.5);
    }
    let draw = |options| {
        let rasteriser = rasteriser([2, 1], two.clone(), options);
        let picture = rasteriser.draw(
            &frame(mesh.clone(), everywhere()),
            [4, 1],
            1.0,
            Color32::RED,
        );
        [0, 1, 2, 3].map(|x| pixel(&picture, x, 0)[0])
    };
    assert_eq!(draw(options), [0, 255, 0, 255]);
    let clamped = TextureOptions {
        magnification: TextureFilter::Linear,
        ..TextureOptions::NEAREST
    };
    assert_eq!(draw(clamped), [0, 255, 255, 255]);
}

#[test]
fn a_fine_texture_seen_from_afar_is_its_mean() {
    let checks = (0..64).map(|i| {
        if (i + i / 8) % 2 == 0 {
            Color32::BLACK
        } else {
            Color32::WHITE
        }
    });
    let options = TextureOptions {
        mipmap_mode: Some(TextureFilter::Linear),
        ..TextureOptions::LINEAR_REPEAT
    };
    let rasteriser = rasteriser([8, 8], checks.collect(), options);
    let mut mesh = quad(
        [
            pos2(0.0, 0.0),
            pos2(4.0, 0.0),
            pos2(4.0, 4.0),
            pos2(0.0, 4.0),
        ],
        Color32::WHITE,
    );
    for (vertex, uv) in
        mesh.vertices
            .iter_mut()
            .zip([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    {
        vertex.uv = pos2(uv[0], uv[1]);
    }
    let picture = rasteriser.draw(&frame(mesh, everywhere()), [4, 4], 1.0, Color32::RED);
    assert!(
        picture.rgba.chunks(4).all(|p| p[0].abs_diff(128) <= 1),
        "{:?}",
        picture.rgba
    );
}

#[test]
fn part_of_a_texture_can_be_replaced_and_a_freed_one_draws_nothing() {
    let mut rasteriser = rasteriser([2, 1], vec![Color32::BLACK; 2], TextureOptions::NEAREST);
    let mut delta = TexturesDelta::default();
    let image = ImageData::Color(ColorImage::new([1, 1], vec![Color32::WHITE]).into());
    delta.push(
        TEXTURE,
        ImageDelta {
            image,
            options: TextureOptions::NEAREST,
            pos: Some([1, 0]),
        },
    );
    rasteriser.apply(&mut delta);
    let mut mesh = quad(
        [
            pos2(0.0, 0.0),
            pos2(2.0, 0.0),
            pos2(2.0, 1.0),
            pos2(0.0, 1.0),
        ],
        Color32::WHITE,
    );
    for (vertex, u) in mesh.vertices.iter_mut().zip([0.0, 1.0, 1.0, 0.0]) {
        vertex.uv = pos2(u, 0.5);
    }
    let draw = |rasteriser: &Rasteriser| {
        let picture = rasteriser.draw(
            &frame(mesh.clone(), everywhere()),
            [2, 1],
            1.0,
            Color32::RED,
        );
        [pixel(&picture, 0, 0), pixel(&picture, 1, 0)]
    };
    assert_eq!(draw(&rasteriser), [[0, 0, 0, 255], [255; 4]]);
    delta.free(TEXTURE);
    rasteriser.apply(&mut delta);
    assert_eq!(draw(&rasteriser), [[255, 0, 0, 255]; 2]);
}

#[test]
fn corners_that_are_nowhere_draw_nothing_and_harm_nothing() {
    let nowhere = pos2(f32::NAN, f32::INFINITY);
    let mesh = quad(
        [nowhere, pos2(1.0, 1.0), pos2(f32::MAX, 2.0), nowhere],
        Color32::WHITE,
    );
    let picture = white().draw(&frame(mesh, everywhere()), [4, 4], 1.0, Color32::BLACK);
    assert_eq!(picture.rgba.len(), 64);
}
