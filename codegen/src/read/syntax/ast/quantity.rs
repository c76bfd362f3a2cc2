//! Quantities as they are written: vendor-neutral names of signals.

use serde::Deserialize;

use super::Map;

/// Where a quantity is read and set.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Quantity {
    /// Message and signal of a reply or a report that has the value: `output.voltage`. A status bit stands behind its
    /// word: `status.alarms.off`. A switch also has its states: `{signal: status.alarms.off, active: 0, inactive: 1}`. If
    /// absent, nobody reads it.
    pub read: Option<SignalPath>,
    /// Message and signal of a request that sets the value: `set_output.voltage`. A switch also has its states:
    /// `{signal: switch.power, active: "on", inactive: "off"}`. If absent, nobody sets it.
    pub set: Option<SignalPath>,
    /// List of other fields of requests that set it, as in a total or as a default: `[set_total.voltage]`; none if
    /// absent.
    #[serde(default)]
    pub also: Vec<String>,
}

/// What is true of a product, and not of the devices in it.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Product {
    /// Limits of quantities, each with its unit: `{output_voltage: 150..450 V}`. No request of any kind to any device
    /// model passes them; none if absent.
    #[serde(default)]
    pub limits: Map<String>,
}

/// The path to a signal. It is a map if more must be said.
#[derive(Clone, Debug)]
pub struct SignalPath {
    /// Names of the message, the signal and of a status bit, with a dot between.
    pub signal: String,
    /// The states of a switch.
    pub states: Option<[Option<String>; 2]>,
    /// Values of other signals of the same request.
    pub with: Map<String>,
    /// Whether it is written as a map.
    pub is_map: bool,
}

/// The path to a signal as a map.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct States {
    /// Names of the message, the signal and of a status bit, with a dot between: `status.alarms.off`.
    pub signal: String,
    /// Of a switch: name or raw value of the signal while it is on: `0`; absent for a number.
    pub active: Option<String>,
    /// Of a switch: name or raw value of the signal while it is off: `1`; absent for a number.
    pub inactive: Option<String>,
    /// Values that other signals of the request always have, with `set`: `{mode: remote}`; none if absent.
    #[serde(default)]
    pub with: Map<String>,
}
