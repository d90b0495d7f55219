//! Codes of a FRAME as few printable digits.
//!
//! Each code is written as its difference, modulo 2¹⁶, to what is expected of it: the code before,
//! nothing, or the code of a channel nearby in the same frame, whichever takes least. A bit says
//! whether there is a difference; small ones take few bits (Rice's code, Golomb 1966 with a power
//! of two). Expectation and number of low bits are chosen for each band of each frame and stand in
//! front of its bits, four each. Thirteen bits make two digits of 91.

/// What printable text has but blank, quote, comma and equals sign.
const DIGITS: &[u8; BASE as usize] =
    b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789\
    !#$%&()*+-./:;<>?@[]^_`{|}~'\\";
const BASE: u32 = 91;
/// Bits of a pair of digits.
const PAIR_BITS: u32 = 13;
/// Low bits beyond which nothing is gained.
pub(super) const MAX_LOW_BITS: u32 = 15;
/// Ways to expect a code.
const N_WAYS: u32 = 16;

/// How the codes of a band are written.
#[derive(Clone, Copy, Debug)]
struct Shape {
    /// 0: as before; 1: nothing; n: as so many channels less one before in the same frame.
    way: u32,
    low_bits: u32,
}

impl Shape {
    /// What is expected of a channel of a band.
    fn expected(self, before: &[[u16; 2]], codes: &[[u16; 2]], at: [usize; 2]) -> u16 {
        let [channel, band] = at;
        let code = |codes: &[[u16; 2]], channel: usize| codes.get(channel).map_or(0, |it| it[band]);
        match self.way {
            0 => code(before, channel),
            1 => 0,
            way => channel
                .checked_sub(way as usize - 1)
                .map_or(0, |near| code(codes, near)),
        }
    }

    /// With the fewest bits in all.
    fn best(codes: &[[u16; 2]], before: &[[u16; 2]], band: usize) -> Self {
        let shapes = (0..N_WAYS).map(|way| {
            let shape = Self { way, low_bits: 0 };
            let folded: Vec<u32> = (0..codes.len())
                .map(|at| fold(codes[at][band], shape.expected(before, codes, [at, band])))
                .filter(|folded| *folded > 0)
                .collect();
            let n_bits = |low_bits: u32| -> u64 {
                let high = folded.iter().map(|it| u64::from((it - 1) >> low_bits));
                high.map(|high| high + 1 + u64::from(low_bits)).sum()
            };
            let best = (0..=MAX_LOW_BITS)
                .map(|low_bits| (n_bits(low_bits), low_bits))
                .min();
            let (n_bits, low_bits) = best.unwrap_or_default();
            (n_bits, Self { way, low_bits })
        });
        let best = shapes.min_by_key(|(n_bits, _)| *n_bits);
        best.map_or(
            Self {
                way: 0,
                low_bits: 0,
            },
            |(_, shape)| shape,
        )
    }
}

/// Writes `codes`, which follow on `before` of as many channels.
pub(super) fn pack(codes: &[[u16; 2]], before: &[[u16; 2]], text: &mut String) {
    let mut out = Packing {
        text,
        bits: 0,
        n_bits: 0,
    };
    for band in 0..2 {
        let shape = Shape::best(codes, before, band);
        out.push(shape.way, 4);
        out.push(shape.low_bits, 4);
        for (channel, code) in codes.iter().enumerate() {
            let folded = fold(code[band], shape.expected(before, codes, [channel, band]));
            out.push(u32::from(folded > 0), 1);
            if let Some(more) = folded.checked_sub(1) {
                for _ in 0..more >> shape.low_bits {
                    out.push(1, 1);
                }
                out.push(0, 1);
                out.push(more & ((1 << shape.low_bits) - 1), shape.low_bits);
            }
        }
    }
    out.finish();
}

/// Reads what [`pack`] wrote into `codes`, which hold the frame before. `None`, and codes that mean
/// nothing, when it is not that.
pub(super) fn unpack(text: &str, codes: &mut [[u16; 2]]) -> Option<()> {
    let before = codes.to_vec();
    let mut from = Unpacking::new(pairs(text), PAIR_BITS);
    for band in 0..2 {
        let shape = Shape {
            way: from.take(4)?,
            low_bits: from.take(4)?,
        };
        for channel in 0..codes.len() {
            let expected = shape.expected(&before, codes, [channel, band]);
            codes[channel][band] = if from.take(1)? == 0 {
                expected
            } else {
                let folded = from.take_number(shape.low_bits)?.checked_add(1)?;
                unfold(u16::try_from(folded).ok()?, expected)
            };
        }
    }
    from.has_ended().then_some(())
}

/// The difference modulo 2¹⁶ as 0, −1, 1, −2, … → 0, 1, 2, 3, …
fn fold(code: u16, before: u16) -> u32 {
    let step = i32::from(code.wrapping_sub(before).cast_signed());
    ((step << 1) ^ (step >> 31)).cast_unsigned()
}

/// The other way.
pub(super) fn unfold(folded: u16, before: u16) -> u16 {
    let half = folded >> 1;
    let step = if folded & 1 == 0 { half } else { !half };
    before.wrapping_add(step)
}

fn push_digit(text: &mut String, value: u32) {
    let digit = DIGITS.get(value as usize).copied().unwrap_or(b'A');
    text.push(char::from(digit));
}

struct Packing<'a> {
    text: &'a mut String,
    bits: u32,
    n_bits: u32,
}

impl Packing<'_> {
    /// The lowest `n_bits` of `value`, highest first.
    fn push(&mut self, value: u32, n_bits: u32) {
        for at in (0..n_bits).rev() {
            self.bits = self.bits << 1 | (value >> at & 1);
            self.n_bits += 1;
            if self.n_bits == PAIR_BITS {
                push_digit(self.text, self.bits / BASE);
                push_digit(self.text, self.bits % BASE);
                (self.bits, self.n_bits) = (0, 0);
            }
        }
    }

    fn finish(mut self) {
        while self.n_bits > 0 {
            self.push(0, 1);
        }
    }
}

/// The digits two by two.
fn pairs(text: &str) -> impl Iterator<Item = Option<u32>> {
    text.as_bytes().chunks(2).map(|pair| {
        let &[high, low] = pair else { return None };
        let pair = value_of(high, DIGITS)? * BASE + value_of(low, DIGITS)?;
        (pair >> PAIR_BITS == 0).then_some(pair)
    })
}

pub(super) fn value_of(digit: u8, digits: &[u8]) -> Option<u32> {
    let place = digits.iter().position(|known| *known == digit)?;
    u32::try_from(place).ok()
}

/// Bits out of groups of them, the highest first.
pub(super) struct Unpacking<I> {
    groups: I,
    group_bits: u32,
    bits: u32,
    n_bits: u32,
}

impl<I: Iterator<Item = Option<u32>>> Unpacking<I> {
    pub(super) fn new(groups: I, group_bits: u32) -> Self {
        Self {
            groups,
            group_bits,
            bits: 0,
            n_bits: 0,
        }
    }

    pub(super) fn take(&mut self, n_bits: u32) -> Option<u32> {
        while self.n_bits < n_bits {
            let group = self.groups.next()??;
            self.bits = (self.bits & ((1 << self.n_bits) - 1)) << self.group_bits | group;
            self.n_bits += self.group_bits;
        }
        self.n_bits -= n_bits;
        Some(self.bits >> self.n_bits & ((1 << n_bits) - 1))
    }

    /// A number with so many low bits.
    fn take_number(&mut self, low_bits: u32) -> Option<u32> {
        let mut high = 0_u32;
        while self.take(1)? == 1 {
            high += 1;
        }
        // No difference is larger than 2¹⁶.
        let high = u32::from(u16::try_from(high).ok()?);
        let low = self.take(low_bits)?;
        high.checked_mul(1 << low_bits)?.checked_add(low)
    }

    /// Whether nothing is left but the padding of the last group.
    pub(super) fn has_ended(mut self) -> bool {
        let is_padding = self.n_bits < self.group_bits && self.bits & ((1 << self.n_bits) - 1) == 0;
        is_padding && self.groups.next().is_none()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_frame_that_hardly_changes_takes_a_third_of_its_bytes() {
        let before: Vec<[u16; 2]> = (0..24).map(|at| [900 * at, 65_000 - at]).collect();
        let codes: Vec<_> = before
            .iter()
            .map(|[low, high]| [low + 9, high - 30])
            .collect();
        let mut text = String::new();
        pack(&codes, &before, &mut text);
        assert!(text.len() < 60, "{} digits for 96 bytes", text.len());
    }

    #[test]
    fn what_is_left_over_or_missing_is_refused() {
        let (codes, before) = ([[1000, 2]; 5], [[0; 2]; 5]);
        let mut text = String::new();
        pack(&codes, &before, &mut text);
        for bad in [
            &text[..text.len() - 2],
            &format!("{text}AA"),
            "",
            "A",
            "\\\\",
        ] {
            assert_eq!(unpack(bad, &mut before.clone()), None, "{bad}");
        }
    }

    proptest! {
        #[test]
        fn any_codes_come_back(
            pairs in prop::collection::vec(any::<([u16; 2], [u16; 2])>(), 0..254),
        ) {
            let (codes, before): (Vec<_>, Vec<_>) = pairs.into_iter().unzip();
            let mut text = String::new();
            pack(&codes, &before, &mut text);
            // Two digits for 13 bits: at most 18 a code, and eight for each band.
            prop_assert!(text.len() <= 2 * (16 + 2 * codes.len() * 18).div_ceil(13));
            let mut back = before;
            prop_assert_eq!(unpack(&text, &mut back), Some(()));
            prop_assert_eq!(back, codes);
        }

        #[test]
        fn any_text_is_read_or_refused(text in ".{0,60}") {
            let _read = unpack(&text, &mut [[7; 2]; 9]);
        }
    }
}
