//! Builds the requests that read and set quantities.

use crate::layout::Decode;
use crate::{
    AnySignal, Data, Destination, Error, Exchange, Layout, Payload, Quantities, Quantity, ReadPath, Request, Route,
};

/// Builds the requests that read quantities, each message once.
pub fn read<P: Quantities, T: Destination<Protocol = P>>(
    wanted: &[Quantity],
    route: Route<T>,
) -> Result<impl Iterator<Item = Request<P, ()>>, Error> {
    let asked = |quantity: Quantity| path::<P>(quantity).and_then(|path| path.request);
    wanted.iter().try_for_each(|quantity| {
        let path = path::<P>(*quantity).ok_or(Error::NotRead { quantity: quantity.name() })?;
        if path.comes() { Ok(()) } else { Err(Error::NotAsked { message: path.message(), quantity: quantity.name() }) }
    })?;
    let requests = wanted.iter().enumerate().filter_map(move |(index, quantity)| {
        let request = asked(*quantity)?;
        let is_same = |earlier: &Quantity| asked(*earlier).is_some_and(|earlier| earlier.is(request));
        (!wanted.iter().take(index).any(is_same)).then(|| request.request_to(route, &()))
    });
    all(requests)
}

/// Builds the requests that set quantities, each message once, for a device model if one is given.
pub fn set<P: Quantities, T: Destination<Protocol = P>>(
    model: Option<u8>,
    values: &[(Quantity, i32)],
    route: Route<T>,
) -> Result<impl Iterator<Item = Request<P, ()>>, Error> {
    values.iter().enumerate().try_for_each(|(index, (known, value))| {
        let (quantity, mut later) = (known.name(), values.iter().skip(index + 1));
        if later.clone().any(|(later, _)| later == known) {
            return Err(Error::SetTwice { quantity });
        }
        let own = set_by::<P>(*known).ok_or(Error::NotSet { quantity })?;
        let switches_on = (*known, *value) == (Quantity::DELIVERING, 1);
        let is_early = switches_on && later.any(|(later, _)| !is_set_by::<P>(*later, own));
        if is_early { Err(Error::TooEarly { quantity }) } else { Ok(()) }
    })?;
    let requests = values.iter().enumerate().filter_map(move |(index, (quantity, _))| {
        let own = set_by::<P>(*quantity)?;
        let is_last = !values.iter().skip(index + 1).any(|(later, _)| is_set_by::<P>(*later, own));
        is_last.then(|| setting::<P, T>(own, model, values, route))
    });
    all(requests)
}

/// Returns the requests, if none is refused.
fn all<P: Quantities>(
    requests: impl Iterator<Item = Result<Request<P, ()>, Error>> + Clone,
) -> Result<impl Iterator<Item = Request<P, ()>>, Error> {
    requests.clone().try_for_each(|request| request.map(|_| ()))?;
    Ok(requests.filter_map(Result::ok))
}

/// Builds the request of one message, with all of its quantities.
fn setting<P: Quantities, T: Destination<Protocol = P>>(
    own: &'static Exchange,
    model: Option<u8>,
    values: &[(Quantity, i32)],
    route: Route<T>,
) -> Result<Request<P, ()>, Error> {
    if !own.is_of(model) {
        return Err(Error::Model { message: own.message() });
    }
    let mut payload = Payload::within_limits(own.message(), [0; 8]).for_model(model);
    for path in P::SETS.iter().filter(|path| path.request.is(own)) {
        let given = values.iter().find(|(quantity, _)| *quantity == path.quantity);
        let Some((_, value)) = given else {
            return Err(Error::NotGiven { message: own.message(), quantity: path.quantity.name() });
        };
        path.write(*value, &mut payload)?;
    }
    own.request_to(route, &Written(*payload.data()))
}

fn path<P: Quantities>(quantity: Quantity) -> Option<&'static ReadPath> {
    P::READS.iter().find(|path| path.quantity == quantity)
}

/// Returns the request that sets a quantity.
fn set_by<P: Quantities>(quantity: Quantity) -> Option<&'static Exchange> {
    P::SETS.iter().find(|path| path.quantity == quantity).map(|path| path.request)
}

fn is_set_by<P: Quantities>(quantity: Quantity, request: &Exchange) -> bool {
    set_by::<P>(quantity).is_some_and(|own| own.is(request))
}

/// The bits of all signals of a message, written before.
struct Written(Data);

impl Layout for Written {
    const SIGNALS: &'static [&'static dyn AnySignal] = &[];
    const DECODE: Decode<Self> = |data| Self(*data);

    fn write_to(&self, payload: &mut Payload) -> bool {
        let constants = u64::from_be_bytes(*payload.data());
        payload.replace((constants | u64::from_be_bytes(self.0)).to_be_bytes());
        true
    }
}
