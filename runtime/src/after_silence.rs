//! What devices do after silence.

/// What a device does after the controller was silent for as long as its [watchdog](crate::Timing::watchdog) waits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum AfterSilence {
    /// The document does not say it.
    #[default]
    Unknown,
    /// The output goes off, and stays off until it is switched on.
    Off,
    /// The output goes off. It comes back as it was when the device hears any request, also one that only reads.
    Resumes,
    /// The device delivers by itself, also if it was switched off.
    Starts,
    /// The device goes on as it was.
    Keeps,
}
