//! What a station hears.

use super::module::{Goal, Module, Placed, Task};
use super::{Found, Group, Rival, Rivals, Station};
use crate::client::{Nodes, Output, Ticket};
use crate::{Addressed, Protocol, Quantities, Quantity, Received};

impl<P: Quantities + Addressed, const M: usize, const G: usize, const R: usize> Station<P, M, G, R> {
    /// Takes an answer.
    pub(super) fn answered(&mut self, ticket: Ticket, received: &Received<P>, at: u32) {
        self.answers(received, at);
        let Self { client, modules, .. } = self;
        let Some(module) = sender(modules, received) else { return };
        if module.answered(ticket, received, at) {
            module.tell_anew(client);
        }
    }

    /// Notes that a module has answered something, and takes its group.
    pub(super) fn answers(&mut self, received: &Received<P>, at: u32) {
        let Some(module) = sender(&mut self.modules, received) else { return };
        module.answers(at);
        let said = received.quantity(Quantity::GROUP).and_then(|group| u8::try_from(group).ok());
        let Some(group) = said else { return };
        if module.placed == Placed::ByProgram {
            return;
        }
        module.placed = Placed::ByItself;
        if module.group != Some(group) {
            let (node, left) = (module.node(), module.group);
            let delivers =
                |known: &Group<P::Target>| Some(known.number) == left && matches!(known.task, Task::Deliver(_));
            // Nobody may keep it on that does not know of it.
            module.has_left |= self.groups.iter().any(delivers) && module.duty.output() != Output::Off;
            self.join(node, Some(group));
        }
    }

    /// Takes a refusal, or an answer that says something else.
    pub(super) fn refused(&mut self, ticket: Ticket, received: &Received<P>, at: u32) {
        self.answers(received, at);
        let is_held = self.client.holds(ticket);
        let Some(module) = sender(&mut self.modules, received) else { return };
        module.lost(ticket);
        if is_held {
            module.told.unmet.begin();
        }
    }

    /// Notes that a module has answered something that cannot be read.
    pub(super) fn speaks(&mut self, ticket: Ticket, at: u32) {
        let node = self.client.node(ticket);
        let Some(module) = self.modules.iter_mut().find(|module| node == Some(module.node())) else { return };
        module.lost(ticket);
        module.answers(at);
    }

    /// Puts a module into a group.
    pub(super) fn join(&mut self, node: u8, group: Option<u8>) {
        let Self { client, modules, .. } = self;
        let Some(module) = modules.iter_mut().find(|module| module.node() == node) else { return };
        module.tell_anew(client);
        module.group = group;
        self.know_members();
    }

    /// Tells the client which modules hear what goes to a group. What nobody hears is not sent.
    pub(super) fn know_members(&mut self) {
        let Self { client, modules, groups, .. } = self;
        for group in groups {
            let members: Nodes = modules.iter().filter(|module| module.hears(group.number)).map(Module::node).collect();
            group.is_heard = !members.is_empty();
            if !group.is_heard {
                group.stop.take().into_iter().for_each(|ticket| client.cancel(ticket));
            }
            // There is room for each group.
            let Some(target) = group.target else { continue };
            let _ = client.members(target, members);
        }
    }

    /// Takes a request of another controller. One that only reads is no rival.
    pub(super) fn overheard(&mut self, received: &Received<P>) {
        let set = |quantity| received.setting(quantity);
        let rival = Rival {
            node: received.node().and_then(|node| u8::try_from(node).ok()),
            voltage_mv: set(Quantity::OUTPUT_VOLTAGE),
            current_ma: set(Quantity::OUTPUT_CURRENT),
            is_on: set(Quantity::DELIVERING).map(|is_on| is_on != 0),
        };
        if (rival.voltage_mv, rival.current_ma, rival.is_on) == (None, None, None) {
            return;
        }
        self.news.rival = Some(rival);
        self.give_way();
        if rival.is_on == Some(true) {
            self.stop_anew();
        }
    }

    /// Leaves what delivers to another controller.
    fn give_way(&mut self) {
        let adopts = matches!(self.settings.found, Found::Adopt(_));
        let task = match self.settings.rivals {
            Rivals::Leave => Task::Leave,
            Rivals::Watch => Task::Watch,
        };
        let gives_way = |known: Task| matches!(known, Task::Deliver(_)) || known == Task::AsFound && adopts;
        let tasks = self.groups.iter_mut().map(|group| &mut group.task).chain([&mut self.others]);
        let mut has_given = false;
        for known in tasks.filter(|known| gives_way(**known)) {
            *known = task;
            has_given = true;
        }
        self.news.is_kept_on |= has_given && task == Task::Watch;
        if has_given {
            // Nobody knows from which current it rises when the program takes it back.
            self.modules.iter_mut().for_each(|module| {
                module.due = None;
                module.rise_anew();
            });
        }
    }

    /// Sends what stops modules again, as another controller may have switched them on.
    fn stop_anew(&mut self) {
        for group in &mut self.groups {
            group.stop.take().into_iter().for_each(|ticket| self.client.cancel(ticket));
        }
        for module in self.modules.iter_mut().filter(|module| module.goal == Goal::Off) {
            module.tell_anew(&mut self.client);
        }
    }
}

/// Returns the module that has sent a frame.
pub fn sender<'a, P: Protocol>(modules: &'a mut [Module<P>], received: &Received<P>) -> Option<&'a mut Module<P>> {
    let node = received.sender()?;
    modules.iter_mut().find(|module| module.node() == node)
}
