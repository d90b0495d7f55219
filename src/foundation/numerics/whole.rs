//! Whole numbers of numbers that are none.
#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "saturates, as is said"
)]

/// Whole numbers that [`to_whole`] makes.
pub trait Whole: Sized {
    /// The whole part of a number.
    fn of(x: f64) -> Self;
}

macro_rules! whole {
    ($($kind:ty)+) => {$(
        impl Whole for $kind {
            #[inline]
            fn of(x: f64) -> Self {
                x as Self
            }
        }
    )+};
}
whole!(u8 u16 u32 u64 usize i16 i32 i64 isize);

/// The whole part of a number: 0 of what is no number, and the nearest there is of what lies beyond
/// its kind.
#[inline]
pub fn to_whole<T: Whole>(x: f64) -> T {
    T::of(x)
}
