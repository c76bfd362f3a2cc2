//! Quantities: names for what devices of any vendor measure and take.
//!
//! A spec leads from each name to a signal of its messages. So one program reads and sets the same
//! quantity on the devices of every vendor.

mod path;
mod request;
pub(crate) mod single;
#[cfg(test)]
mod tests;

pub use path::{OutOfRange, ReadPath, SetPath, States};

use crate::{Destination, Error, Kind, Protocol, Received, Request, Route};

/// The name of what a device measures or takes. It is the same for every vendor.
///
/// Its value is an integer:
/// - thousandths of its unit, such as millivolts, if it has one,
/// - 1 or 0 of a switch,
/// - the number itself otherwise, as of a group.
///
/// ```
/// use canspec_runtime::Quantity;
///
/// const CELL_TEMPERATURE: Quantity = Quantity::new("cell_temperature");
///
/// assert_eq!(Quantity::OUTPUT_VOLTAGE.name(), "output_voltage");
/// assert_ne!(CELL_TEMPERATURE, Quantity::TEMPERATURE);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Quantity(&'static str);

/// Makes the constants of the standard names, and the list of them with their kinds.
macro_rules! standard {
    ($($(#[$comment:meta])* $constant:ident $name:literal $kind:expr;)*) => {
        impl Quantity {
            $($(#[$comment])* pub const $constant: Self = Self::new($name);)*

            /// Every standard name, with what its values are.
            pub const STANDARD: &'static [(Self, QuantityKind)] = &[$((Self::$constant, $kind)),*];
        }
    };
}

/// What the values of a quantity are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuantityKind {
    /// Thousandths of a unit.
    Unit(&'static str),
    /// Numbers without a unit.
    Count,
    /// 1 or 0.
    Switch,
}

impl Quantity {
    /// Returns the quantity of a name in specs.
    pub const fn new(name: &'static str) -> Self {
        Self(name)
    }

    /// Returns the name in specs.
    pub const fn name(self) -> &'static str {
        self.0
    }
}

standard! {
    /// Voltage at the output, in mV.
    OUTPUT_VOLTAGE "output_voltage" QuantityKind::Unit("V");
    /// Current at the output, in mA.
    OUTPUT_CURRENT "output_current" QuantityKind::Unit("A");
    /// Power at the output, in mW.
    OUTPUT_POWER "output_power" QuantityKind::Unit("W");
    /// Whether the output delivers: 1 while it is switched on, and 0 while it is switched off.
    DELIVERING "delivering" QuantityKind::Switch;
    /// Voltage at the input, in mV.
    INPUT_VOLTAGE "input_voltage" QuantityKind::Unit("V");
    /// Current at the input, in mA.
    INPUT_CURRENT "input_current" QuantityKind::Unit("A");
    /// Power at the input, in mW.
    INPUT_POWER "input_power" QuantityKind::Unit("W");
    /// Frequency at the input, in mHz.
    INPUT_FREQUENCY "input_frequency" QuantityKind::Unit("Hz");
    /// Temperature of the device itself, in m°C.
    TEMPERATURE "temperature" QuantityKind::Unit("°C");
    /// Temperature of the air around the device, in m°C.
    AMBIENT_TEMPERATURE "ambient_temperature" QuantityKind::Unit("°C");
    /// The least voltage that the output can be set to, in mV.
    MINIMUM_VOLTAGE "minimum_voltage" QuantityKind::Unit("V");
    /// The greatest voltage that the output can be set to, in mV.
    MAXIMUM_VOLTAGE "maximum_voltage" QuantityKind::Unit("V");
    /// The greatest current that the output can be set to, in mA.
    MAXIMUM_CURRENT "maximum_current" QuantityKind::Unit("A");
    /// Rated current of the output, in mA.
    RATED_CURRENT "rated_current" QuantityKind::Unit("A");
    /// Rated power of the output, in mW.
    RATED_POWER "rated_power" QuantityKind::Unit("W");
    /// Voltage of a battery, in mV.
    BATTERY_VOLTAGE "battery_voltage" QuantityKind::Unit("V");
    /// Current of a battery, in mA, positive while it charges.
    BATTERY_CURRENT "battery_current" QuantityKind::Unit("A");
    /// Charge of a battery as a share of its capacity, in thousandths of a percent.
    STATE_OF_CHARGE "state_of_charge" QuantityKind::Unit("%");
    /// Number of the group of the device.
    GROUP "group" QuantityKind::Count;
}

/// A protocol whose spec says where its messages have quantities. Generated code implements it.
pub trait Quantities: Protocol {
    /// Where quantities are read.
    const READS: &'static [ReadPath];
    /// Where quantities are set.
    const SETS: &'static [SetPath];

    /// Builds the requests that read quantities. Those in one message share a request.
    ///
    /// What devices only report by themselves needs no request. [`Received::quantity`] takes the values out of the
    /// frames that come.
    ///
    /// # Errors
    ///
    /// Refuses
    /// - a quantity that the protocol cannot read,
    /// - one for which only requests with values ask,
    /// - other addressing modes, and undocumented addresses.
    fn read<T: Destination<Protocol = Self>>(
        wanted: &[Quantity],
        route: impl Into<Route<T>>,
    ) -> Result<impl Iterator<Item = Request<Self, ()>>, Error> {
        request::read(wanted, route.into())
    }

    /// Builds the requests that set quantities, in the order of `values`. Those in one message share a request, at the
    /// place of the last one.
    ///
    /// # Errors
    ///
    /// Refuses
    /// - a quantity that the protocol cannot set, or that is given twice,
    /// - to switch the output on before another message sets the rest,
    /// - values without another one that their message needs,
    /// - a value outside the limits of its signal, or between its last step and the limit,
    /// - a value of a switch that is not 0 or 1,
    /// - other addressing modes, and undocumented addresses.
    fn set<T: Destination<Protocol = Self>>(
        values: &[(Quantity, i32)],
        route: impl Into<Route<T>>,
    ) -> Result<impl Iterator<Item = Request<Self, ()>>, Error> {
        request::set(None, values, route.into())
    }

    /// Builds the same requests as [`set`](Self::set), within the limits of a device model.
    ///
    /// # Errors
    ///
    /// The same as those of [`set`](Self::set). It also refuses messages that the model does not have.
    fn set_within<T: Destination<Protocol = Self>>(
        model: impl Into<u8>,
        values: &[(Quantity, i32)],
        route: impl Into<Route<T>>,
    ) -> Result<impl Iterator<Item = Request<Self, ()>>, Error> {
        request::set(Some(model.into()), values, route.into())
    }
}

impl<P: Quantities> Received<P> {
    /// Returns the value of a quantity that the frame shows: thousandths of its unit, 1 or 0 of a switch, or a plain
    /// number. Between two integers it is the nearest one, with ties away from zero.
    ///
    /// It is `None` if
    /// - the frame does not carry the quantity, or is an error reply,
    /// - the bits mean something else than a number, or no state of the switch,
    /// - an `i32` cannot hold it.
    pub fn quantity(&self, quantity: Quantity) -> Option<i32> {
        let path = P::READS.iter().find(|path| path.quantity == quantity && path.is_in(self))?;
        if self.is_error_reply() { None } else { path.value.read(self.frame(), self.model()) }
    }

    /// Returns the value of a quantity that a request sets, or that its reply says is in effect. It counts as
    /// [`quantity`](Self::quantity) does.
    ///
    /// It is `None` if
    /// - the frame is no request, no report of the controller and no reply that carries it,
    /// - the bits mean something else than a number, or no state of the switch,
    /// - the frame is an error reply, or an `i32` cannot hold the value.
    pub fn setting(&self, quantity: Quantity) -> Option<i32> {
        let path = P::SETS.iter().find(|path| path.quantity == quantity && path.is_in(self))?;
        if self.is_error_reply() { None } else { path.read(self.frame()) }
    }

    /// Tests whether the reply says that all quantities which a request sets are in effect. Values of a unit may differ
    /// by `tolerance` thousandths of it.
    ///
    /// It is false if
    /// - the request sets nothing, or the reply does not say all of it,
    /// - the request goes to another module than that which replies.
    pub fn confirms(&self, request: &Self, tolerance: u32) -> bool {
        let mut paths = P::SETS.iter().filter(|path| path.is_in(request)).peekable();
        let is_said = |path: &SetPath| {
            let tolerance = if path.unit.is_some() { tolerance } else { 0 };
            let both = request.setting(path.quantity).zip(self.setting(path.quantity));
            both.is_some_and(|(asked, said)| asked.abs_diff(said) <= tolerance)
        };
        let is_its = [request.kind(), self.kind()] == [Kind::Request, Kind::Reply]
            && request.node().is_none_or(|node| self.node() == Some(node));
        is_its && paths.peek().is_some() && paths.all(is_said)
    }
}
