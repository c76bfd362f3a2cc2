//! A station: it controls charging modules in groups, of any protocol that has the quantities.
//!
//! It has no input and output of its own, and no clock. The program gives it every frame with the time at which it was
//! received, and then polls it until it waits:
//!
//! ```
//! use canspec_runtime::station::{Station, Step};
//! use canspec_runtime::{Addressed, Frame, Quantities};
//!
//! fn turn<P: Quantities + Addressed>(
//!     station: &mut Station<P, 8, 2, 64>,
//!     now: u32,
//!     send: impl Fn(Frame) -> bool,
//!     received: impl IntoIterator<Item = (Frame, u32)>,
//! ) -> u32 {
//!     for (frame, at) in received {
//!         station.handle(&frame, at);
//!     }
//!     loop {
//!         match station.poll(now) {
//!             Step::Send { frame, ticket } if !send(frame) => station.not_sent(ticket, now),
//!             Step::Send { .. } => {}
//!             Step::Event(event) => println!("{event:?}"),
//!             Step::Wait(until) => break until,
//!         }
//!     }
//! }
//! ```
//!
//! # What it promises
//!
//! - *Set-points come first.* A module is switched on only after the echo of its set-point has agreed, in each renewal
//!   anew. So a module that restarts is not switched on without one, unless it starts faster than a switch-on waits for
//!   the bus.
//! - *A stop cannot fail.* It goes to the group first, and then to each module, again and again, also to those that do
//!   not answer. There is always room for it. [`is_off`](Station::is_off) tells whether each module has said since
//!   then that it is off.
//! - *What the program wants comes first after silence.* Some modules come back as they were as soon as they
//!   [hear anything](crate::AfterSilence). So a module that has not answered in time is not read. It is told what it
//!   is to do until it answers.
//! - *Everything known has an age.* What was said longer ago than [`valid`](Settings::valid) does not count. Only
//!   [`group`](Station::group) and [`status`](Station::status) are what was said last.
//! - *No limit is passed.* Each output goes through the [`Limits`].
//!
//! Frames that the program itself has sent must not be handed over.

mod drive;
mod driver;
mod event;
mod fit;
mod hear;
mod known;
mod module;
mod request;
mod round;
mod settings;
#[cfg(test)]
mod tests;

use crate::client::{Bus, Client, Heard, Output, Step as Asked, Ticket};
use crate::clock::{Steady, has_come};
use crate::{Addressed, Quantities, Request};
pub use drive::{Drive, pump};
pub use driver::{Blocking, Driver, NonBlocking, listen};
pub use event::{Event, Rival, Step};
use hear::sender;
pub use known::Known;
use module::{Goal, Module, Placed, Task};
pub use settings::{Beyond, Found, Limits, Refused, Rivals, SetPoint, Settings, Unfit};

/// A group of modules.
#[derive(Clone, Copy, Debug)]
struct Group<T> {
    number: u8,
    /// What addresses all of its modules, if anything does.
    target: Option<T>,
    task: Task,
    /// Whether a module can hear what goes to it.
    is_heard: bool,
    /// Its stop, which goes to all of its modules.
    stop: Option<Ticket>,
}

/// Controls the modules at `M` addresses, in `G` groups, with room for `R` requests.
///
/// `R` must be at least [`ROOM`](Self::ROOM), which is tested while the program is compiled.
#[derive(Clone, Copy, Debug)]
pub struct Station<P: Quantities + Addressed, const M: usize, const G: usize, const R: usize> {
    settings: Settings,
    client: Client<P, R, G>,
    modules: [Module<P>; M],
    groups: [Group<P::Target>; G],
    /// The task of modules without a group.
    others: Task,
    has_emergency: bool,
    clock: Steady,
    news: News,
    /// When there is something to do, if no frame comes before. None means at once.
    next: Option<u32>,
}

/// What the program is to be told of the bus.
#[derive(Clone, Copy, Debug)]
struct News {
    rival: Option<Rival>,
    is_kept_on: bool,
    may_wake: bool,
}

impl<P: Quantities + Addressed, const M: usize, const G: usize, const R: usize> Station<P, M, G, R> {
    /// The least room for requests: what each module reads and sets, its group, and a stop of each module and group.
    pub const ROOM: usize = M * (request::each_round::<P>() + 2) + G;

    /// Returns a station that looks for modules at `addresses`. Each group has its number, and what addresses all of
    /// its modules, if the document has that.
    ///
    /// Modules of protocols with a [group](crate::Quantity::GROUP) say which one they are in. Others are
    /// [assigned](Self::assign) by the program.
    ///
    /// # Errors
    ///
    /// Refuses
    /// - a round that is too short for these modules or for an answer, or longer than a third of the watchdog,
    /// - values that count for less than a round, or longer than the watchdog,
    /// - a protocol in which no module answers when it is switched off, or none is asked whether it delivers,
    /// - an address at which no module is switched off, as the document says,
    /// - what is to be adopted if it would be [refused](Self::deliver) to deliver it,
    /// - an address or a group that is named twice, and limits that contradict each other.
    pub fn new(settings: Settings, addresses: [u8; M], groups: [(u8, Option<P::Target>); G]) -> Result<Self, Unfit> {
        const { assert!(R >= Self::ROOM, "the station needs more room for requests: at least `Station::ROOM`") }
        let may_wake = fit::fits::<P>(&settings, &addresses, groups.iter().map(|(number, _)| *number))?;
        let client = Client::new(settings.pace);
        let mut station = Self {
            settings,
            client: settings.model.map_or(client, |model| client.for_model(model)),
            modules: addresses.map(Module::new),
            groups: groups.map(|(number, target)| Group {
                number,
                target,
                task: Task::AsFound,
                is_heard: false,
                stop: None,
            }),
            others: Task::AsFound,
            has_emergency: false,
            clock: Steady::NEW,
            news: News { rival: None, is_kept_on: false, may_wake },
            next: None,
        };
        station.know_members();
        Ok(station)
    }

    /// Lets each module of a group deliver. Its current comes to a greater one step by step. To say it again changes
    /// nothing. A new set-point is sent when the last one is in effect, or after a round, or at once if it is lower.
    ///
    /// # Errors
    ///
    /// Refuses an unknown group, an output beyond a limit, one without a current if the protocol can set that, and what
    /// the document does not allow or nobody answers. The group then goes on as before. It also refuses to deliver until
    /// an emergency has been [ended](Self::end_emergency).
    pub fn deliver(&mut self, group: u8, point: SetPoint, now: u32) -> Result<(), Refused> {
        let index = self.place_of(group)?;
        if self.has_emergency {
            return Err(Refused::Emergency);
        }
        let targets = self.modules.iter().filter_map(|module| P::module(module.node().into()));
        for target in targets {
            fit::allows::<P>(&self.settings, target, point)?;
        }
        self.note(now);
        self.begin(index, Task::Deliver(point));
        Ok(())
    }

    /// Switches a group off, again and again, until the program lets it deliver. What cannot be sent now is sent later.
    ///
    /// # Errors
    ///
    /// Refuses an unknown group.
    pub fn stop(&mut self, group: u8, now: u32) -> Result<(), Refused> {
        let index = self.place_of(group)?;
        self.note(now);
        self.begin(index, Task::Stop);
        Ok(())
    }

    /// Only reads a group, and leaves it as it is, until the program says more. That can
    /// [wake](Event::MayWake) modules that were not heard for long.
    ///
    /// # Errors
    ///
    /// Refuses an unknown group, and to watch until an emergency has been [ended](Self::end_emergency).
    pub fn watch(&mut self, group: u8, now: u32) -> Result<(), Refused> {
        let index = self.place_of(group)?;
        if self.has_emergency {
            return Err(Refused::Emergency);
        }
        self.note(now);
        self.news.may_wake |= fit::can_wake::<P>();
        self.begin(index, Task::Watch);
        Ok(())
    }

    /// Stops all groups and all modules, before anything else. None delivers until the emergency has
    /// [ended](Self::end_emergency).
    pub fn emergency(&mut self, now: u32) {
        self.note(now);
        self.has_emergency = true;
        self.others = Task::Stop;
        self.modules.iter_mut().for_each(|module| module.due = None);
        (0..G).for_each(|index| self.begin(index, Task::Stop));
    }

    /// Ends an emergency. All groups stay stopped until the program lets them deliver.
    pub fn end_emergency(&mut self) {
        self.has_emergency = false;
    }

    /// Puts a module into a group, whatever it says of its group itself, or into none.
    ///
    /// # Errors
    ///
    /// Refuses an unknown address or group, and to take a module out of a group while it answers and is not known to be
    /// off.
    pub fn assign(&mut self, node: u8, group: Option<u8>, now: u32) -> Result<(), Refused> {
        group.map_or(Ok(()), |group| self.place_of(group).map(|_| ()))?;
        let now = self.note(now);
        let valid = self.settings.valid;
        let module = self.modules.iter_mut().find(|module| module.node() == node).ok_or(Refused::Address(node))?;
        if module.group == group {
            module.placed = Placed::ByProgram;
            return Ok(());
        }
        if module.group.is_some() && module.heard.is_some() && module.output(valid, now) != Output::Off {
            return Err(Refused::NotOff);
        }
        (module.placed, module.due) = (Placed::ByProgram, None);
        self.join(node, group);
        Ok(())
    }

    /// Takes a frame from the bus, and when it was received. The driver may have kept it for a while.
    pub fn handle(&mut self, frame: &impl embedded_can::Frame, received_at: u32) {
        self.next = None;
        let at = self.clock.steady(received_at);
        match self.client.handle(frame, at) {
            Heard::Answer { ticket, received } => self.answered(ticket, &received, at),
            Heard::Late { received, .. } => self.answers(&received, at),
            Heard::NotInEffect { ticket, received } | Heard::Refusal { ticket, received } => {
                self.refused(ticket, &received, at);
            }
            Heard::Twice { ticket, received } => {
                self.answers(&received, at);
                if let Some(module) = sender(&mut self.modules, &received) {
                    module.answered_twice(ticket, &received);
                }
            }
            Heard::Starting { received, .. } => {
                self.answers(&received, at);
                if let Some(module) = sender(&mut self.modules, &received) {
                    module.forget();
                    module.told.starting.begin();
                }
            }
            Heard::ShortRefusal(ticket) | Heard::Broken(ticket) => self.speaks(ticket, at),
            Heard::Rival(received) => self.overheard(&received),
            // What it reports by itself does not show that it has heard anything.
            Heard::Other(received) => sender(&mut self.modules, &received).into_iter().for_each(|module| {
                module.measured(&received, at);
            }),
            Heard::Unrecognised(_) => {}
        }
    }

    /// Says what to do next. Call it until it waits, after all frames from the bus were handled.
    pub fn poll(&mut self, now: u32) -> Step {
        let now = self.clock.pass(now);
        if let Some(by) = self.clock.went_back() {
            return Step::Event(Event::ClockBack { by });
        }
        if let Some(next) = self.next.filter(|next| !has_come(*next, now)) {
            return Step::Wait(self.clock.of_program(next));
        }
        self.next = None;
        self.stop_groups(now);
        (0..M).for_each(|place| self.look_after(place, now));
        if let Some(event) = self.event(now) {
            return Step::Event(event);
        }
        loop {
            match self.client.poll(now) {
                Asked::Send { frame, ticket } => {
                    self.modules.iter_mut().for_each(|module| module.sent(ticket));
                    return Step::Send { frame, ticket };
                }
                Asked::Lost(ticket) => self.modules.iter_mut().for_each(|module| module.lost(ticket)),
                Asked::Done(_) | Asked::Missing { .. } | Asked::Silent(_) | Asked::Back(_) | Asked::ClockBack(_) => {}
                Asked::Wait(until) => {
                    let next = self.deadline(until, now);
                    self.next = Some(next);
                    return Step::Wait(self.clock.of_program(next));
                }
            }
        }
    }

    /// Takes back a frame that the driver did not take. It counts as no try, and is sent again after the gap. Call it
    /// before the next [`poll`](Self::poll).
    pub fn not_sent(&mut self, ticket: Ticket, now: u32) {
        let now = self.note(now);
        self.client.not_sent(ticket, now);
        self.modules.iter_mut().for_each(|module| module.not_sent(ticket));
    }

    /// Notes that the bus is on or off. While it is off, nothing is sent, and no request is lost. A module that was not
    /// heard in time meanwhile is told first what the program wants of it.
    pub fn bus(&mut self, bus: Bus, now: u32) {
        if bus == self.client.bus_told() {
            return;
        }
        let now = self.note(now);
        self.client.bus(bus, now);
    }

    /// Takes the time of the program's clock, when the program tells something. After that there may be something to do.
    fn note(&mut self, now: u32) -> u32 {
        self.next = None;
        self.clock.pass(now)
    }

    fn place_of(&self, number: u8) -> Result<usize, Refused> {
        self.groups.iter().position(|group| group.number == number).ok_or(Refused::Group(number))
    }

    /// Begins a task of a group.
    fn begin(&mut self, index: usize, task: Task) {
        let Self { client, modules, .. } = self;
        let Some(group) = self.groups.get_mut(index).filter(|group| group.task != task) else { return };
        group.task = task;
        group.stop.take().into_iter().for_each(|ticket| client.cancel(ticket));
        for module in modules.iter_mut().filter(|module| module.group == Some(group.number)) {
            // Faster than it is in effect, it would never be switched on.
            let waits = !module.is_met && is_raised(module.goal, task);
            module.due = module.due.filter(|_| waits);
        }
    }

    /// Sends the stops of groups that are not sent yet.
    fn stop_groups(&mut self, now: u32) {
        let Self { client, groups, settings, .. } = self;
        for group in groups.iter_mut().filter(|group| group.task == Task::Stop && group.is_heard) {
            if group.stop.is_none() {
                let request = group.target.and_then(|target| request::switch_off::<P>(settings, target).ok()?);
                // What is asked of each module shows whether it is off. Without room, the group is stopped later.
                let unanswered = request.map(Request::unanswered);
                group.stop = unanswered.and_then(|request| client.every(settings.round, request, now).ok());
            }
            group.stop.into_iter().for_each(|ticket| client.hurry(ticket, now));
        }
    }
}

/// Tests whether nothing about an output is to fall.
fn is_raised(goal: Goal, task: Task) -> bool {
    match (goal, task) {
        (Goal::Output { point, .. }, Task::Deliver(new)) => {
            new.voltage_mv >= point.voltage_mv && new.current_ma >= point.current_ma
        }
        _ => false,
    }
}
