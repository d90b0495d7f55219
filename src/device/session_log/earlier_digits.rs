//! Codes of a FRAME as earlier versions wrote them: differences to the frame before alone, six bits
//! to a digit. Only read.

use super::digits::unfold;

const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
const BITS_PER_DIGIT: u32 = 6;
const MAX_LOW_BITS: u32 = 15;

/// Reads such digits into `codes`, which hold the frame before. `None`, and codes that mean
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

fn value_of(digit: u8) -> Option<u32> {
    let place = DIGITS.iter().position(|known| *known == digit)?;
    u32::try_from(place).ok()
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
    use super::*;

    const WRITTEN: &str = "JL7oACAd8z8DgAA";

    #[test]
    fn what_an_earlier_version_wrote_is_read() {
        // Three channels of 0, then at [1000, 2], [7, 60000] and [7, 0].
        let mut codes = [[0; 2]; 3];
        unpack(WRITTEN, &mut codes).unwrap();
        assert_eq!(codes, [[1000, 2], [7, 60000], [7, 0]]);
        for bad in ["", "A", "zz", &WRITTEN[1..], &format!("{WRITTEN}A")] {
            assert_eq!(unpack(bad, &mut [[0; 2]; 3]), None, "{bad}");
        }
    }
}
