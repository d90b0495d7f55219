//! Little-endian fields at running offsets, for the message tables.
//!
//! A reader that runs out of bytes answers zeros and remembers it, so a decoder reads all its
//! fields and asks once. It knows no message.

use super::framing::LARGEST_BODY;

/// Appends fields to a payload of at most [`LARGEST_BODY`] bytes; what does not fit is dropped and
/// remembered.
#[derive(Debug)]
pub(super) struct FieldWriter {
    bytes: [u8; LARGEST_BODY],
    len: usize,
    overflowed: bool,
}

impl FieldWriter {
    pub(super) fn new() -> Self {
        Self {
            bytes: [0; LARGEST_BODY],
            len: 0,
            overflowed: false,
        }
    }

    pub(super) fn bytes(&mut self, bytes: &[u8]) -> &mut Self {
        let end = self.len + bytes.len();
        match self.bytes.get_mut(self.len..end) {
            Some(room) => {
                room.copy_from_slice(bytes);
                self.len = end;
            }
            None => self.overflowed = true,
        }
        self
    }

    pub(super) fn put(&mut self, field: impl Field) -> &mut Self {
        field.write(self);
        self
    }

    /// The payload, or `None` when it did not fit.
    pub(super) fn finish(&self) -> Option<&[u8]> {
        (!self.overflowed).then(|| &self.bytes[..self.len])
    }
}

/// What stands in one field of a message.
pub(super) trait Field: Copy {
    fn read(fields: &mut FieldReader<'_>) -> Self;
    fn write(self, fields: &mut FieldWriter);
}

macro_rules! number_fields {
    ($($number:ident),+) => {$(
        impl Field for $number {
            fn read(fields: &mut FieldReader<'_>) -> Self {
                Self::from_le_bytes(fields.bytes())
            }

            fn write(self, fields: &mut FieldWriter) {
                fields.bytes(&self.to_le_bytes());
            }
        }
    )+};
}
number_fields!(u8, u16, i16, u32, i32);

macro_rules! pair_fields {
    ($($number:ty),+) => {$(
        impl Field for [$number; 2] {
            fn read(fields: &mut FieldReader<'_>) -> Self {
                [fields.take(), fields.take()]
            }

            fn write(self, fields: &mut FieldWriter) {
                fields.put(self[0]).put(self[1]);
            }
        }
    )+};
}
pair_fields!(u16, u32);

/// Reads some fields of a message in order.
macro_rules! read_fields {
    ($from:expr, $message:ident { $($field:ident)+ }) => {
        $($message.$field = $from.take();)+
    };
}
pub(super) use read_fields;

/// Writes some fields of a message in order.
macro_rules! write_fields {
    ($to:expr, $message:ident { $($field:ident)+ }) => {
        $($to.put($message.$field);)+
    };
}
pub(super) use write_fields;

impl<const N: usize> Field for [u8; N] {
    fn read(fields: &mut FieldReader<'_>) -> Self {
        fields.bytes()
    }

    fn write(self, fields: &mut FieldWriter) {
        fields.bytes(&self);
    }
}

/// Reads fields from a payload.
#[derive(Debug)]
pub(super) struct FieldReader<'a> {
    rest: &'a [u8],
    short: bool,
}

impl<'a> FieldReader<'a> {
    pub(super) fn new(payload: &'a [u8]) -> Self {
        Self {
            rest: payload,
            short: false,
        }
    }

    pub(super) fn bytes<const N: usize>(&mut self) -> [u8; N] {
        if let Some((head, rest)) = self.rest.split_first_chunk::<N>() {
            self.rest = rest;
            *head
        } else {
            self.short = true;
            self.rest = &[];
            [0; N]
        }
    }

    pub(super) fn take<T: Field>(&mut self) -> T {
        T::read(self)
    }

    /// Everything after the fixed fields.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.rest
    }

    /// `value` if the payload was long enough for everything read.
    pub(super) fn finish<T>(&self, value: T) -> Option<T> {
        (!self.short).then_some(value)
    }
}

/// The low 32 bits, as ticks, clocks and numbers of samples travel.
#[expect(
    clippy::cast_possible_truncation,
    reason = "they wrap at 2³² on the wire"
)]
pub(crate) fn wrapped_u32(count: u64) -> u32 {
    count as u32
}
