//! What is chosen for this charger.

use canspec_runtime::client::Pace;
use canspec_runtime::station::{Found, Limits, Settings};

/// What no module exceeds: its contactor and its cable bear no more.
const LIMITS: Limits = Limits {
    least_mv: 200_000,
    most_mv: 750_000,
    most_ma: 20_000,
    most_mw: 12_000_000,
    group_ma: 60_000,
    rise_ma: 5_000,
    open_mv: 60_000,
};

/// The document wants 50 ms between two requests, and says neither how long to wait nor how often to try.
const PACE: Pace = Pace { gap: 50, wait: 120, tries: 3, late: 120 };

/// Four modules take 800 ms for a round, and switch off after 10 s of silence. What runs when the program starts is
/// switched off.
pub const SETTINGS: Settings = Settings::new(PACE, 2000, Found::Off, LIMITS);
