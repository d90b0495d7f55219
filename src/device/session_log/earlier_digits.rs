//! Codes of a FRAME as earlier versions wrote them: differences to the frame before alone, six bits
//! to a digit. Only read.

use super::digits::{MAX_LOW_BITS, Unpacking, unfold, value_of};

const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
const BITS_PER_DIGIT: u32 = 6;

/// Reads such digits into `codes`, which hold the frame before. `None`, and codes that mean
/// nothing, when it is not that.
pub(super) fn unpack(text: &str, codes: &mut [[u16; 2]]) -> Option<()> {
    let mut digits = text.bytes().map(|digit| value_of(digit, DIGITS));
    let low_bits = [digits.next()??, digits.next()??];
    if low_bits.iter().any(|bits| *bits > MAX_LOW_BITS) {
        return None;
    }
    let mut from = Unpacking::new(digits, BITS_PER_DIGIT);
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
    from.has_ended().then_some(())
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
