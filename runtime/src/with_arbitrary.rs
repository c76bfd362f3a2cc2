//! `arbitrary` for messages and frames, for fuzzing, behind the feature `arbitrary`. Generated code
//! calls it.

use arbitrary::{Arbitrary, Result, Unstructured};

use crate::{Data, Frame, Layout};

/// Decodes eight arbitrary bytes. The values fit their signals, but not always the limits of
/// requests.
///
/// # Errors
///
/// Passes on errors of the source of bytes.
pub fn layout<L: Layout>(unstructured: &mut Unstructured<'_>) -> Result<L> {
    Data::arbitrary(unstructured).map(|data| L::decode(&data))
}

impl<'a> Arbitrary<'a> for Frame {
    fn arbitrary(unstructured: &mut Unstructured<'a>) -> Result<Self> {
        let (id, extended, data, length) = Arbitrary::arbitrary(unstructured)?;
        Ok(Self::new_raw(id, extended, data, length))
    }
}
