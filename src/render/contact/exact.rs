//! Exact steps: between two changes of a contact the motion has a closed form, so a step is as many
//! pieces as contacts begin, end, leave without force or meet the ceiling within it.

use super::kernel::Kernel;
use super::law::Spring;
use super::stepper::{Column, Motion, crossing};

/// How exactly the end of a contact is located, as a part of its piece.
const EVENT: f64 = 1e-12;
/// After which part of a piece a change that began it shows beyond rounding.
const SURE: f64 = 1e-9;
/// Pieces of one step at which a stiff wall that rings is taken as it is.
const MAX_PIECES: u32 = 1_000_000;
/// How long a piece may be, as a part of 1/ω: an eighth of a period.
const PIECE: f64 = 0.785;

/// How a contact stands to the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Touch {
    Away,
    /// Deeper than 0, but leaving so fast that the damper would pull.
    Loose,
    Pressed,
    /// At the force ceiling.
    Full,
}

/// A linear piece: `m z̈ + c ż + k z = f + g t`, t from the start of the step.
#[derive(Debug, Clone, Copy, Default)]
struct Piece {
    k: f64,
    c: f64,
    f: f64,
    g: f64,
}

impl Touch {
    /// By depth, force of spring and damper, and ceiling.
    fn of([depth_m, force_n, ceiling_n]: [f64; 3]) -> Self {
        if depth_m <= 0.0 {
            Self::Away
        } else if force_n < 0.0 {
            Self::Loose
        } else if force_n >= ceiling_n {
            Self::Full
        } else {
            Self::Pressed
        }
    }

    /// How far that is from its end; below 0 beyond it.
    fn left(self, [depth_m, force_n, ceiling_n]: [f64; 3]) -> f64 {
        match self {
            Self::Away => -depth_m,
            Self::Loose => depth_m.min(-force_n),
            // It leaves without force before it leaves the depth.
            Self::Pressed => force_n.min(ceiling_n - force_n),
            Self::Full => force_n - ceiling_n,
        }
    }
}

/// When what is left of a contact is none any more, between the start of a piece and its end.
fn located([start, end]: [(f64, f64); 2], left: impl Fn(f64) -> f64) -> f64 {
    // At 0 it has not changed yet.
    let beyond = |s: f64| left(s) + f64::MIN_POSITIVE;
    let from = |start| crossing([start, end], EVENT * end.0, beyond)[1];
    let (event_s, sure_s) = (from(start), SURE * end.0);
    if event_s > EVENT * end.0 {
        return event_s;
    }
    match beyond(sure_s) {
        // It was rounding that changed it, and would change it back without end.
        left if left > 0.0 => from((sure_s, left)),
        _ => event_s,
    }
}

impl Column<'_> {
    /// How fast a contact's surface rises over a step: evenly.
    fn rise_m_per_s(&self, contact: usize, step_s: f64) -> f64 {
        (self.floors[2][contact].height_m - self.floors[0][contact].height_m) / step_s
    }

    /// Depth, force and ceiling of a contact at a time after the start of a step.
    fn figures(&self, contact: usize, at: Motion, (t_s, step_s): (f64, f64)) -> [f64; 3] {
        let floor = &self.floors[0][contact];
        let rise_m_per_s = self.rise_m_per_s(contact, step_s);
        let depth_m = floor.height_m + rise_m_per_s * t_s - at.z_m;
        let damper_n = self.spring.b * (rise_m_per_s - at.v_m_per_s);
        let force_n = self.spring.k * depth_m + damper_n;
        [depth_m, force_n, self.spring.ceiling_n(floor)]
    }

    fn piece(&self, at: Motion, (t_s, step_s): (f64, f64)) -> Piece {
        let mut piece = Piece {
            c: self.damping,
            f: self.push_n,
            ..Piece::default()
        };
        let Spring { k, b, .. } = *self.spring;
        for (contact, floor) in self.floors[0].iter().enumerate() {
            match Touch::of(self.figures(contact, at, (t_s, step_s))) {
                Touch::Away | Touch::Loose => {}
                Touch::Full => piece.f += self.spring.ceiling_n(floor),
                Touch::Pressed => {
                    let rise_m_per_s = self.rise_m_per_s(contact, step_s);
                    piece.k += k;
                    piece.c += b;
                    piece.f += k * floor.height_m + b * rise_m_per_s;
                    piece.g += k * rise_m_per_s;
                }
            }
        }
        piece
    }

    /// Whether no contact changes how it touches until the step is over: about the even motion that
    /// spring and surface lead to, `½ m ẏ² + ½ k y²` only falls, so a ringing never swings wider
    /// than it does now.
    fn is_calm(&self, piece: &Piece, at: Motion, (t_s, step_s): (f64, f64)) -> bool {
        let v_m_per_s = piece.g / piece.k;
        let led = |t_s: f64| Motion {
            z_m: (piece.f + piece.g * t_s - piece.c * v_m_per_s) / piece.k,
            v_m_per_s,
        };
        let away_m = at.z_m - led(t_s).z_m;
        let faster = at.v_m_per_s - v_m_per_s;
        let twice_j = self.mass_kg * faster * faster + piece.k * away_m * away_m;
        let Spring { k, b, .. } = *self.spring;
        let swing_m = (twice_j / piece.k).sqrt();
        let swing_n = ((k * k / piece.k + b * b / self.mass_kg) * twice_j).sqrt();
        (0..self.floors[0].len()).all(|contact| {
            let now = Touch::of(self.figures(contact, at, (t_s, step_s)));
            [t_s, step_s].into_iter().all(|t_s| {
                let [depth_m, force_n, ceiling_n] = self.figures(contact, led(t_s), (t_s, step_s));
                let swings = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
                swings.into_iter().all(|(m, n)| {
                    let then = [depth_m + m * swing_m, force_n + n * swing_n, ceiling_n];
                    Touch::of(then) == now
                })
            })
        })
    }

    /// Piece after piece until the step is over.
    pub(super) fn exact(&self, from: Motion, step_s: f64) -> Motion {
        let (mut at, mut t_s) = (from, 0.0);
        // A wall that rings is cut into pieces of one length: their responses are found once.
        let mut ringing: Option<([u64; 2], Kernel)> = None;
        for _ in 0..MAX_PIECES {
            let (start, begun_s) = (at, t_s);
            let piece = self.piece(start, (begun_s, step_s));
            let left_s = step_s - begun_s;
            let rings_s = PIECE * (self.mass_kg / piece.k).sqrt();
            let is_calm = left_s > rings_s && self.is_calm(&piece, start, (begun_s, step_s));
            let is_whole = is_calm || left_s <= rings_s;
            let length_s = if is_whole { left_s } else { rings_s };
            let after = |after_s: f64| self.kernel(&piece, after_s);
            let motion = |after_s: f64| self.along(&piece, start, begun_s, &after(after_s));
            // How far the contact that changes first is from that.
            let left = |after_s: f64, motion: Motion| {
                let of = |contact: usize| {
                    let before = self.figures(contact, start, (begun_s, step_s));
                    let now = self.figures(contact, motion, (begun_s + after_s, step_s));
                    Touch::of(before).left(now)
                };
                (0..self.floors[0].len())
                    .map(of)
                    .fold(f64::INFINITY, f64::min)
            };
            let of = [piece.k, piece.c].map(f64::to_bits);
            let known = ringing.filter(|(known, _)| !is_whole && *known == of);
            let kernel = known.map_or_else(|| after(length_s), |(_, kernel)| kernel);
            if !is_whole {
                ringing = Some((of, kernel));
            }
            at = self.along(&piece, start, begun_s, &kernel);
            t_s = begun_s + length_s;
            let at_end = left(length_s, at);
            if at_end < 0.0 {
                let ends = [(0.0, left(0.0, start)), (length_s, at_end)];
                let event_s = located(ends, |s| left(s, motion(s)));
                (at, t_s) = (motion(event_s), begun_s + event_s);
            }
            if t_s >= step_s || (at_end >= 0.0 && is_whole) {
                return at;
            }
        }
        at
    }

    /// The responses of a piece after so long.
    fn kernel(&self, piece: &Piece, length_s: f64) -> Kernel {
        let m = self.mass_kg;
        Kernel::new(piece.c / m, piece.k / m, length_s)
    }

    /// Along a piece from an instant of the step, for as long as its responses are of.
    fn along(&self, piece: &Piece, from: Motion, t_s: f64, kernel: &Kernel) -> Motion {
        let m = self.mass_kg;
        let Motion { z_m, v_m_per_s: v } = from;
        let pull = (piece.f + piece.g * t_s - piece.k * z_m) / m;
        // The damper's part of the acceleration is in the kernel.
        let [gone_m, speed] = kernel.moved(v, pull, piece.g / m);
        Motion {
            z_m: z_m + gone_m,
            v_m_per_s: speed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::law::Floor;

    #[test]
    fn a_tip_that_leaves_within_rounding_leaves_once() {
        let mut spring = Spring::NONE;
        (spring.k, spring.b) = (1e9, 1_732.050_807_568_877_4);
        let height_m = 1.681_474_723_892_1e-4;
        let rise_m_per_s = -4.060_321_957_064_915e-4;
        let step_s = 9.001_086_838_893_561e-4;
        let floor = |t_s: f64| {
            [Floor {
                height_m: height_m + rise_m_per_s * t_s,
                ..Floor::default()
            }]
        };
        let floors = [floor(0.0), floor(0.5 * step_s), floor(step_s)];
        let column = Column {
            mass_kg: 0.075,
            damping: 0.0,
            push_n: -1.0,
            spring: &spring,
            floors: floors.each_ref().map(|floor| &floor[..]),
        };
        let depth_m = 1.4e-10;
        // So fast that spring and damper are at balance, but for rounding.
        let leaving = rise_m_per_s + spring.k * depth_m / spring.b;
        let after = |nth: f64| {
            let from = Motion {
                z_m: height_m - depth_m,
                v_m_per_s: leaving + nth * 1e-20,
            };
            column.exact(from, step_s)
        };
        let free = after(1e6);
        assert!((free.z_m - height_m).abs() > 1e-8, "{free:?}: it flew");
        for nth in -20..20 {
            let at = after(f64::from(nth));
            assert!((at.z_m - free.z_m).abs() < 1e-13, "{nth}: {at:?} {free:?}");
        }
    }
}
