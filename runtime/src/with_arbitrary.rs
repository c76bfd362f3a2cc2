//! `arbitrary` of messages and frames, for fuzzing; generated code calls it. Behind the feature `arbitrary`.

use arbitrary::{Arbitrary, Result, Unstructured};

use crate::{Data, Frame, Layout};

/// Decodes eight arbitrary bytes: the values fit their signals, though not always the limits of requests.
///
/// # Errors
///
/// Passes on what the source of bytes refuses.
pub fn layout<L: Layout>(unstructured: &mut Unstructured<'_>) -> Result<L> {
    Data::arbitrary(unstructured).map(|data| L::decode(&data))
}

impl<'a> Arbitrary<'a> for Frame {
    fn arbitrary(unstructured: &mut Unstructured<'a>) -> Result<Self> {
        let (id, extended, data, length) = Arbitrary::arbitrary(unstructured)?;
        Ok(Self::new_raw(id, extended, data, length))
    }
}
