//! The modules that answer a request to many.

use super::entry::Asked;
use super::{Client, Entry, Nodes, Ticket};
use crate::clock::has_come;
use crate::filter::IdFilter;
use crate::{Addressed, Destination, Error, Protocol, Replies, Request, Route};

/// Why members are not noted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoMembers {
    /// There is no room for another group.
    Full,
    /// The document does not name the target, as the error says.
    Target(Error),
}

impl core::fmt::Display for NoMembers {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Full => formatter.write_str("there is no room for another group"),
            Self::Target(error) => error.fmt(formatter),
        }
    }
}

impl core::error::Error for NoMembers {}

/// The members of a target, and who of them has not answered.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// What identifiers of requests to the target show.
    target: IdFilter,
    members: Nodes,
    /// The members that have not answered in this round, or not as they should.
    pub missing: Nodes,
    /// The members that have sent nothing in this round.
    unheard: Nodes,
    /// The request whose round this is. It began when these members were known.
    asked: Option<Ticket>,
    /// When this round began.
    since: u32,
}

/// Groups whose members are known.
#[derive(Clone, Copy, Debug)]
pub struct Groups<const G: usize>(pub [Option<Group>; G]);

impl<P: Addressed, const N: usize, const G: usize> Client<P, N, G> {
    /// Notes which modules answer requests to a target if each of several does. Such a request is then
    /// done as soon as all of them have answered. It is sent again as long as some are missing. Nobody
    /// else answers it. There is room for `G` targets, and no members mean that they are not known.
    ///
    /// One request to such a target is under way at a time, except one whose answers are late. A round that is
    /// under way when members are noted ends as it began: without them, and others can still answer it. Tell the
    /// client of members before you hold something of one of them, since it then knows what contradicts what.
    ///
    /// # Errors
    ///
    /// Refuses a target that the document does not name, and one more than there is room for.
    pub fn members(&mut self, target: impl Into<Route<P::Target>>, members: impl Into<Nodes>) -> Result<(), NoMembers> {
        let (route, members) = (target.into(), members.into());
        self.quiet = None;
        let target = route.target().request(route.sender()).map_err(NoMembers::Target)?;
        let groups = &mut self.groups.0;
        let known = groups.iter().position(|group| group.is_some_and(|group| group.target == target));
        let place = known.or_else(|| groups.iter().position(Option::is_none));
        let before = known.and_then(|place| groups.get(place).copied()?).map_or(Nodes::NONE, |group| group.members);
        let group = Group { target, members, missing: members, unheard: members, asked: None, since: 0 };
        let group = (!members.is_empty()).then_some(group);
        match place.and_then(|place| groups.get_mut(place)) {
            Some(slot) => *slot = group,
            None if group.is_some() => return Err(NoMembers::Full),
            None => {}
        }
        let entries = self.entries.iter_mut().flatten().filter(|entry| entry.is_under_way() && before != members);
        let asking =
            entries.filter(|entry| entry.request.has_many_answers() && target.matches(entry.request.frame().raw_id()));
        asking.for_each(|entry| entry.asked = Asked::Strangers);
        Ok(())
    }
}

impl<const G: usize> Groups<G> {
    /// Returns the group that a request asks, if its members are known.
    pub fn of<P>(&self, request: &Request<P, ()>) -> Option<&Group> {
        self.0.iter().flatten().find(|group| group.target.matches(request.frame().raw_id()))
    }

    /// Returns the group whose members answer a request.
    pub fn answering<P>(&mut self, request: &Request<P, ()>) -> Option<&mut Group> {
        if !request.has_many_answers() {
            return None;
        }
        let id = request.frame().raw_id();
        self.0.iter_mut().flatten().find(|group| group.target.matches(id))
    }

    /// Returns the group that a request has asked in this round.
    pub fn asked_by<P: Protocol>(&mut self, entry: &Entry<P>) -> Option<&mut Group> {
        self.answering(&entry.request).filter(|group| group.asked == Some(entry.ticket))
    }

    /// Notes that a module has spoken.
    pub fn heard(&mut self, node: u8, received_at: u32) {
        let groups = self.0.iter_mut().flatten().filter(|group| has_come(group.since, received_at));
        groups.for_each(|group| {
            group.unheard.remove(node);
        });
    }

    /// Returns the modules that a request goes to, if they are known.
    pub fn reach<P: Protocol>(&self, entry: &Entry<P>) -> Option<Nodes> {
        let group = || self.of(&entry.request).map(|group| group.members);
        entry.node().map(|node| Nodes::from([node])).or_else(group)
    }

    /// Returns the modules that answer a request, if they are known.
    fn answerers<P: Protocol>(&self, entry: &Entry<P>) -> Option<Nodes> {
        match entry.request.replies() {
            Replies::One(_) => entry.node().map(|node| Nodes::from([node])),
            Replies::Each(_) if entry.asked == Asked::Strangers => None,
            Replies::Each(_) => self.of(&entry.request).map(|group| group.members),
            Replies::Coordinator(_) | Replies::Nobody => None,
        }
    }

    /// Tests whether a frame answers a request, perhaps by a refusal, and a module that should answer sent it. The
    /// identifier of an answer to one module shows that already.
    pub fn is_answer<P: Protocol>(&self, entry: &Entry<P>, frame: &impl embedded_can::Frame) -> bool {
        let is_expected = || Some(self.answerers(entry)?.contains(entry.request.sender(frame)?));
        let is_of_group = || !entry.request.has_many_answers() || is_expected().unwrap_or(true);
        entry.request.refuses(frame).is_some() && is_of_group()
    }

    /// Tests whether a frame can answer both requests.
    pub fn is_like<P: Protocol>(&self, one: &Entry<P>, other: &Entry<P>) -> bool {
        let known = || self.answerers(one).zip(self.answerers(other));
        one.request.is_like(&other.request) && known().is_none_or(|(one, other)| !one.both(&other).is_empty())
    }

    /// Tests whether two requests wait for the members of one group.
    pub fn is_shared<P: Protocol>(&self, one: &Entry<P>, other: &Entry<P>) -> bool {
        let have_many = one.request.has_many_answers() && other.request.has_many_answers();
        let group = self.of(&one.request).filter(|_| have_many);
        group.is_some_and(|group| group.target.matches(other.request.frame().raw_id()))
    }

    /// Tests whether a request has asked the members of its group in this round.
    pub fn is_asked_by<P: Protocol>(&self, entry: &Entry<P>) -> bool {
        self.of(&entry.request).is_some_and(|group| group.asked == Some(entry.ticket))
    }
}

impl Group {
    /// Notes that a request is sent. If it is not the last one, or begins anew, nobody has answered.
    pub fn ask(&mut self, ticket: Ticket, is_anew: bool, now: u32) {
        if is_anew || self.asked != Some(ticket) {
            (self.missing, self.unheard) = (self.members, self.members);
            (self.asked, self.since) = (Some(ticket), now);
        }
    }

    /// Notes that a module has answered, as it should or not. Returns whether that is new, and it is a member.
    pub fn answered(&mut self, node: u8, is_good: bool) -> bool {
        if !self.members.contains(node) {
            return false;
        }
        if is_good {
            return self.missing.remove(node);
        }
        self.missing.insert(node);
        true
    }

    /// Returns the missing members that have sent nothing.
    pub fn silent(&self) -> Nodes {
        self.missing.both(&self.unheard)
    }
}
