//! Codes of a FRAME as few printable digits: what changed since the frame before.
//!
//! Neighbouring frames differ little, so each code is written as its difference to the one before,
//! modulo 2¹⁶, with small differences in few bits (Rice's code, Golomb 1966 with a power of two),
//! six bits to a digit. The number of low bits is chosen for each band of each frame and stands in
//! front, one digit a band.

/// Digits for 0…63.
const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
const BITS_PER_DIGIT: u32 = 6;
/// Low bits beyond which nothing is gained.
const MAX_LOW_BITS: u32 = 15;

/// Writes `codes` as what they are apart from `before`, which has as many channels.
pub(super) fn pack(codes: &[[u16; 2]], before: &[[u16; 2]], text: &mut String) {
    let low_bits = [0, 1].map(|band| best_low_bits(codes, before, band));
    for bits in low_bits {
        push_digit(text, bits);
    }
    let mut out = Packing {
        text,
        bits: 0,
        n_bits: 0,
    };
    for (code, before) in codes.iter().zip(before) {
        for band in 0..2 {
            let folded = fold(code[band], before[band]);
            for _ in 0..folded >> low_bits[band] {
                out.push(1, 1);
            }
            out.push(0, 1);
            out.push(folded & ((1 << low_bits[band]) - 1), low_bits[band]);
        }
    }
    out.finish();
}

/// Reads what [`pack`] wrote into `codes`, which hold the frame before. `None`, and codes that mean
/// nothing, when it is not that.
pub(super) fn unpack(text: &str, codes: &mut [[u16; 2]]) -> Option<()> {
    let mut digits = text.bytes().map(value_of);
    let low_bits = [digits.next()??, digits.next()??];
    if low_bits.iter().any(|bits| *bits > MAX_LOW_BITS) {
        return None;
    }
    let mut from = Unpacking {
        digits,
        bits: 0,
        n_bits: 0,
    };
    for code in codes {
        for band in 0..2 {
            let mut high = 0_u32;
            while from.take(1)? == 1 {
                high += 1;
            }
            let low = from.take(low_bits[band])?;
            let folded = high.checked_shl(low_bits[band])? | low;
            code[band] = unfold(u16::try_from(folded).ok()?, code[band]);
        }
    }
    // Nothing may be left but the padding of the last digit.
    let is_padding = from.n_bits < BITS_PER_DIGIT && from.bits & ((1 << from.n_bits) - 1) == 0;
    (is_padding && from.digits.next().is_none()).then_some(())
}

/// The difference modulo 2¹⁶ as 0, −1, 1, −2, … → 0, 1, 2, 3, …
fn fold(code: u16, before: u16) -> u32 {
    let step = i32::from(code.wrapping_sub(before).cast_signed());
    ((step << 1) ^ (step >> 31)).cast_unsigned()
}

fn unfold(folded: u16, before: u16) -> u16 {
    let half = folded >> 1;
    let step = if folded & 1 == 0 { half } else { !half };
    before.wrapping_add(step)
}

/// The number of low bits with which a band takes the fewest in all.
fn best_low_bits(codes: &[[u16; 2]], before: &[[u16; 2]], band: usize) -> u32 {
    let n_bits = |low_bits: u32| -> u64 {
        let pairs = codes.iter().zip(before);
        pairs
            .map(|(code, before)| u64::from(fold(code[band], before[band]) >> low_bits))
            .map(|high| high + 1 + u64::from(low_bits))
            .sum()
    };
    (0..=MAX_LOW_BITS)
        .min_by_key(|bits| n_bits(*bits))
        .unwrap_or(0)
}

fn push_digit(text: &mut String, value: u32) {
    let digit = DIGITS.get(value as usize).copied().unwrap_or(b'A');
    text.push(char::from(digit));
}

fn value_of(digit: u8) -> Option<u32> {
    let place = DIGITS.iter().position(|known| *known == digit)?;
    u32::try_from(place).ok()
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
            if self.n_bits == BITS_PER_DIGIT {
                push_digit(self.text, self.bits);
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

struct Unpacking<I> {
    digits: I,
    bits: u32,
    n_bits: u32,
}

impl<I: Iterator<Item = Option<u32>>> Unpacking<I> {
    fn take(&mut self, n_bits: u32) -> Option<u32> {
        while self.n_bits < n_bits {
            let digit = self.digits.next()??;
            self.bits = (self.bits & ((1 << self.n_bits) - 1)) << BITS_PER_DIGIT | digit;
            self.n_bits += BITS_PER_DIGIT;
        }
        self.n_bits -= n_bits;
        Some(self.bits >> self.n_bits & ((1 << n_bits) - 1))
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
        for bad in [&text[..text.len() - 1], &format!("{text}A"), "", "A", "zz"] {
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
            // Six bits a digit, 16 a code and its end, two digits in front.
            prop_assert!(text.len() <= 2 + (2 * codes.len() * 18).div_ceil(6));
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
