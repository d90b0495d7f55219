//! How far a method can be trusted under a light, in words.

use super::shape::{Blind, Method};
use super::{Light, tsai_shah};

/// A sentence or two for people.
pub(super) fn words(method: Method, light: Light, blind: Blind) -> String {
    let first = match method {
        Method::TsaiShah => tsai_shah_words(light),
        Method::Linear => slant_words(
            light,
            "Good for gentle slopes; steep ones come out too low and leaning towards the light.",
        ),
        Method::Variational => slant_words(
            light,
            "Good as far as the surface is matt, of one colour, without steps and cast shadows.",
        ),
        Method::DarkIsDeep => "Good where gaps are dark because light does not reach them; colour \
                               and dirt are taken for depth, and the height has no scale."
            .to_owned(),
    };
    if !matches!(method, Method::Linear | Method::Variational) {
        return first;
    }
    let vectors = 100.0 * blind.share_of_vectors;
    let energy = 100.0 * blind.share_of_energy;
    let mut words = format!(
        "{first} Waves across the light cannot be seen: {vectors:.1} % of all; {energy:.1} % of \
         the picture's contrast lies there and is left out"
    );
    words.push_str(if energy > 5.0 {
        ", so colour, noise or shadow is in it: average more repeats, or turn the light."
    } else {
        "."
    });
    words
}

fn tsai_shah_words(light: Light) -> String {
    let [ps, qs] = light.lean();
    let sum = ps + qs;
    let sketch = "A sketch: the iteration looks at each point's own brightness and stops short of \
                  the height; take it to compare with published work";
    // Ps + Qs is 0 in the worst and √2 tan slant in the best direction.
    let is_near = tsai_shah::is_singular(light) || sum.abs() < 0.2 * ps.hypot(qs);
    if is_near {
        format!(
            "{sketch}. The light is near the direction in which it stands still (135° or −45°)."
        )
    } else {
        format!("{sketch}.")
    }
}

fn slant_words(light: Light, otherwise: &str) -> String {
    let slant = light.slant_deg;
    let word = match slant {
        ..15.0 => "The light is nearly frontal: slopes hardly show and noise is amplified.",
        ..25.0 => {
            "The light is rather frontal: slopes along it show weakly, and steepness of any \
                   direction darkens as much."
        }
        ..=65.0 => otherwise,
        _ => {
            "The light grazes: what lies behind a yarn is in its shadow, which is not reckoned \
              with."
        }
    };
    word.to_owned()
}
