//! `arbitrary` for messages and frames, for fuzzing, behind the feature `arbitrary`. Generated code
//! calls it.

use arbitrary::{Arbitrary, Error, Result, Unstructured};

use crate::{Data, Frame, Layout, LongLayout};

/// Most data bytes of a long message.
const MOST_BYTES: usize = 4095;

/// Decodes eight arbitrary bytes. The values fit their signals, but not always the limits of
/// requests.
///
/// # Errors
///
/// Passes on errors of the source of bytes.
pub fn layout<L: Layout>(unstructured: &mut Unstructured<'_>) -> Result<L> {
    Data::arbitrary(unstructured).map(|data| L::decode(&data))
}

/// Decodes arbitrary bytes of a long message. Its arrays have at least as many elements as the
/// document allows.
///
/// # Errors
///
/// Passes on errors of the source of bytes.
pub fn long_layout<L: LongLayout>(unstructured: &mut Unstructured<'_>) -> Result<L> {
    let (least, most) = L::ELEMENTS.unwrap_or_default();
    let length = L::BYTES(unstructured.int_in_range(least..=most)?);
    let mut data = [0; MOST_BYTES];
    let data = data.get_mut(..length).ok_or(Error::IncorrectFormat)?;
    unstructured.fill_buffer(data)?;
    L::decode(data).ok_or(Error::IncorrectFormat)
}

impl<'a> Arbitrary<'a> for Frame {
    fn arbitrary(unstructured: &mut Unstructured<'a>) -> Result<Self> {
        let (id, extended, data, length) = Arbitrary::arbitrary(unstructured)?;
        Ok(Self::new_raw(id, extended, data, length))
    }
}
