//! The ways through addressing modes, by which identifiers show who sends a frame and whom it reaches.

use proc_macro2::Ident;

use super::address::{Addresses, Number, Pattern, target_names};
use super::comparison::field_place;
use super::naming::ident;
use crate::model::{self, AddressPattern, AddressTypeId, ModeId, Protocol, Who};

/// A way through an addressing mode.
pub struct Way {
    /// The mode.
    pub mode: ModeId,
    /// Who sends a frame to the controller.
    pub who: Option<Ident>,
    /// What the identifier shows.
    pub pattern: Pattern,
    /// The route of a request that it shows, if it shows all of it.
    pub route: Option<Route>,
    /// The address of the module that sends or is asked.
    pub node: Option<Shown>,
}

/// The route of a request, as an identifier shows it.
pub struct Route {
    /// Variant of the target.
    pub variant: Ident,
    /// The target's address and the type of its number, if it has one.
    pub target: Option<(Shown, Number)>,
    /// The sender's own address.
    pub sender: Option<Shown>,
}

/// An address that an identifier shows.
#[derive(Clone)]
pub struct Shown {
    /// Place of the field.
    pub place: Ident,
    /// Constant of the kind of address.
    pub kind: Ident,
}

impl Way {
    /// Plans the ways through all modes.
    pub fn all(protocol: &Protocol, addresses: &Addresses) -> Vec<Self> {
        let planner = Planner { protocol, addresses };
        let names = target_names(protocol);
        let senders = [None, Some(Who::One), Some(Who::Each), Some(Who::Coordinator)];
        let ways = protocol.modes.ids().flat_map(|mode| senders.map(|who| (mode, who)));
        ways.filter_map(|(mode, who)| planner.way(mode, who, &names[mode])).collect()
    }
}

struct Planner<'a> {
    protocol: &'a Protocol,
    addresses: &'a Addresses,
}

impl Planner<'_> {
    fn way(&self, mode: ModeId, who: Option<Who>, variant: &Ident) -> Option<Way> {
        let known = &self.protocol[mode];
        let pattern = known.pattern(who.is_none(), who.unwrap_or(Who::Nobody))?;
        Some(Way {
            mode,
            who: who.map(|who| ident(name(who))),
            pattern: Pattern::new(self.protocol, self.addresses, pattern),
            route: self.route(known, pattern, variant),
            node: self.protocol.node(known, who).and_then(|kind| self.shown(pattern, kind)),
        })
    }

    fn route(&self, mode: &model::Mode, pattern: &AddressPattern, variant: &Ident) -> Option<Route> {
        mode.request.as_ref()?;
        let target = match mode.target {
            Some(kind) => Some((self.shown(pattern, kind)?, Number::of(&self.protocol[kind]))),
            None => None,
        };
        let sender = self.protocol.controller(mode).and_then(|kind| self.shown(pattern, kind));
        Some(Route { variant: variant.clone(), target, sender })
    }

    /// Finds the field that holds a kind of address.
    fn shown(&self, pattern: &AddressPattern, kind: AddressTypeId) -> Option<Shown> {
        let address = pattern.addresses.iter().find(|address| address.address_type == kind)?;
        let (place, _) = field_place(self.protocol, address.field);
        Some(Shown { place, kind: self.addresses[kind].clone() })
    }
}

fn name(who: Who) -> &'static str {
    match who {
        Who::One => "One",
        Who::Each => "Each",
        Who::Coordinator => "Coordinator",
        Who::Nobody => "Nobody",
    }
}
