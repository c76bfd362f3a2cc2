//! A controller of charging modules in groups, of any protocol that has the quantities.
//!
//! The station holds what each module is to do. While a group delivers, that is the set-point, and after it the
//! switch-on. The switch-on is sent only when the echo of the set-point has agreed, in each renewal anew. So a module
//! that restarts is not switched on without its set-point. It only must take longer to start than the switch-on waits
//! for the bus. What is held and what is read keeps modules alive.
//!
//! A stop goes to the group first, and then to each module, again and again. Only what a module says of its output
//! afterwards shows that it is off. What says nothing is unknown.
//!
//! Requests that come from the bus are those of another controller. From then on the station only reads, until the
//! program delivers or stops again. So the driver must not hand over the frames that the station itself has sent.
#![no_std]

use canspec_runtime::client::{Client, Duty, Heard, Nodes, NotHeld, Output, Pace, Step, Ticket};
use canspec_runtime::{Addressed, Error, Frame, Protocol, Quantities, Quantity, Received, Severity};

/// What is read in each round. The first one says whether a module delivers.
const READINGS: [Quantity; 3] = [Quantity::DELIVERING, Quantity::OUTPUT_VOLTAGE, Quantity::OUTPUT_CURRENT];

/// What switches a module off.
const OFF: [(Quantity, i32); 1] = [(Quantity::DELIVERING, 0)];

/// How far an echo may differ, in mV and mA. INFY prints one that differs by 15 mV.
const TOLERANCE: u32 = 100;

/// What a group is to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Task {
    /// It is read only.
    Watch,
    /// Each module is to deliver this voltage and current.
    Deliver { voltage_mv: i32, current_ma: i32 },
    /// Each module is to be off.
    Stop,
}

/// How a station works. Times are in milliseconds.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// How fast it asks.
    pub pace: Pace,
    /// The time from one round of a module to the next: a part of the watchdog's, and more than all waits of a round.
    pub round: u32,
    /// How far the current rises from one round to the next, in mA.
    pub rise_ma: i32,
}

/// A group of modules.
#[derive(Clone, Copy)]
struct Group<T> {
    number: u8,
    target: T,
    task: Task,
    /// Its stop, which goes to all of its modules.
    stop: Option<Ticket>,
}

/// Why a group is not told to do something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refused {
    /// The station does not know the group.
    Group,
    /// The document does not allow the output.
    Output(Error),
}

/// Controls the modules at `M` addresses, in `G` groups, with room for `R` requests.
///
/// A module takes one request for each message that reads or sets something. An address without a module takes one,
/// and a group that is stopped takes one.
pub struct Station<P: Quantities + Addressed, const M: usize, const G: usize, const R: usize> {
    settings: Settings,
    client: Client<P, R, G>,
    modules: [Module<P>; M],
    groups: [Group<P::Target>; G],
    has_rival: bool,
    /// When there is something to do, if no frame comes before.
    next: u32,
}

impl<P: Quantities + Addressed, const M: usize, const G: usize, const R: usize> Station<P, M, G, R> {
    /// Returns a station that only reads. It looks for modules at `addresses`. Each group has its number and its address.
    pub fn new(settings: Settings, addresses: [u8; M], groups: [(u8, P::Target); G]) -> Self {
        Self {
            settings,
            client: Client::new(settings.pace),
            modules: addresses.map(Module::new),
            groups: groups.map(|(number, target)| Group { number, target, task: Task::Watch, stop: None }),
            has_rival: false,
            next: 0,
        }
    }

    /// Returns the modules that have been found.
    pub fn modules(&self) -> impl Iterator<Item = &Module<P>> {
        self.modules.iter().filter(|module| module.group.is_some())
    }

    /// Tests whether a group is known to be off: it has modules, and each has said so since it was stopped.
    pub fn is_off(&self, group: u8) -> bool {
        let mut members = self.modules.iter().filter(|module| module.group == Some(group)).peekable();
        members.peek().is_some() && members.all(|module| module.duty.output() == Output::Off)
    }

    /// Tests whether another controller has been heard since the program let a group deliver.
    pub const fn has_rival(&self) -> bool {
        self.has_rival
    }

    /// Lets each module of a group deliver. It comes to a greater current step by step.
    ///
    /// # Errors
    ///
    /// Refuses an unknown group, and what the document does not allow. The group then goes on as before.
    pub fn deliver(&mut self, group: u8, voltage_mv: i32, current_ma: i32, now: u32) -> Result<(), Refused> {
        let known = self.groups.iter().find(|known| known.number == group).ok_or(Refused::Group)?;
        drop(P::set(&output(voltage_mv, current_ma), known.target).map_err(Refused::Output)?);
        self.has_rival = false;
        self.begin(group, Task::Deliver { voltage_mv, current_ma }, now)
    }

    /// Switches a group off, again and again, until the program lets it deliver.
    ///
    /// # Errors
    ///
    /// Refuses an unknown group.
    pub fn stop(&mut self, group: u8, now: u32) -> Result<(), Refused> {
        self.begin(group, Task::Stop, now)
    }

    /// Takes a frame from the bus.
    pub fn handle(&mut self, frame: &impl embedded_can::Frame, now: u32) {
        self.next = now;
        match self.client.handle(frame, now) {
            Heard::Answer { ticket, received } => self.answered(Some(ticket), &received, now),
            // A late answer tells of no request, but of the module.
            Heard::Late { received, .. } => self.answered(None, &received, now),
            Heard::Starting { received, .. } => {
                let node = received.node();
                self.forget(|module| node == Some(module.node.into()));
            }
            Heard::Rival(_) => self.give_way(now),
            // What is held or read is asked again in the next round.
            _ => {}
        }
    }

    /// Returns the next frame to send. Call it until there is none, after all frames from the bus were handled.
    pub fn poll(&mut self, now: u32) -> Option<Frame> {
        if !is_due(self.next, now) {
            return None;
        }
        for place in 0..M {
            if is_due(self.modules[place].due, now) {
                self.modules[place].due = now.wrapping_add(self.settings.round);
                // What finds no room is asked in the next round.
                let _ = self.ask(place, now);
            }
        }
        loop {
            match self.client.poll(now) {
                Step::Send { frame, .. } => return Some(frame),
                Step::Lost(ticket) => self.forget(|module| module.watch == Some(ticket)),
                Step::Silent(node) => self.forget(|module| module.node == node),
                // A module that is back tells its state, and groups are asked again.
                Step::Done(_) | Step::Missing { .. } | Step::Back(_) | Step::ClockBack(_) => {}
                Step::Wait(until) => {
                    let rounds = self.modules.iter().map(|module| module.due).chain(until);
                    let latest = now.wrapping_add(self.settings.round);
                    self.next = rounds.fold(latest, |one, other| if is_due(one, other) { one } else { other });
                    return None;
                }
            }
        }
    }

    /// Looks for a module, or reads it and holds what its group is to do.
    fn ask(&mut self, place: usize, now: u32) -> Result<(), NotHeld> {
        let Self { client, groups, settings: Settings { pace, round, rise_ma }, .. } = self;
        let module = &mut self.modules[place];
        let Some(target) = P::module(module.node.into()) else { return Ok(()) };
        let Some(group) = groups.iter().find(|group| module.group == Some(group.number)) else {
            let once = Pace { tries: 1, ..*pace };
            let requests = P::read(&[Quantity::GROUP], target).into_iter().flatten();
            return requests
                .map(|request| client.ask_at(once, request, now))
                .try_for_each(|asked| asked.map(|_| ()).map_err(|_| NotHeld::Full));
        };
        for request in P::read(&READINGS, target).into_iter().flatten().skip(module.reads) {
            let ticket = client.every(*round, request, now).map_err(|_| NotHeld::Full)?;
            module.watch.get_or_insert(ticket);
            module.reads += 1;
        }
        let values = match group.task {
            Task::Watch => &[],
            Task::Deliver { voltage_mv, current_ma } => {
                module.step_ma = current_ma.min(module.reached_ma.saturating_add(*rise_ma));
                &output(voltage_mv, module.step_ma)[..]
            }
            Task::Stop => &OFF,
        };
        module.duty.hold(client, P::set(values, target).into_iter().flatten(), *round, agrees, now)
    }

    /// Begins a task of a group.
    fn begin(&mut self, number: u8, task: Task, now: u32) -> Result<(), Refused> {
        let Self { client, modules, settings, .. } = self;
        self.next = now;
        let group = self.groups.iter_mut().find(|group| group.number == number).ok_or(Refused::Group)?;
        let members = modules.iter_mut().filter(|module| module.group == Some(number));
        members.for_each(|module| {
            module.duty.end(client);
            module.due = now;
        });
        group.task = task;
        group.stop.take().into_iter().for_each(|ticket| client.cancel(ticket));
        let stop = P::set(&OFF, group.target).into_iter().flatten().filter(|_| task == Task::Stop);
        for request in stop {
            group.stop = client.every(settings.round, request, now).ok();
            group.stop.into_iter().for_each(|ticket| client.hurry(ticket, now));
        }
        Ok(())
    }

    /// Takes what a module says.
    fn answered(&mut self, ticket: Option<Ticket>, received: &Received<P>, now: u32) {
        let node = received.node();
        let Some(module) = self.modules.iter_mut().find(|module| node == Some(module.node.into())) else { return };
        if let Some(ticket) = ticket {
            module.answered(ticket, received);
        }
        let group = received.quantity(Quantity::GROUP).and_then(|group| u8::try_from(group).ok());
        if group.is_some() && group != module.group {
            module.group = group;
            module.duty.end(&mut self.client);
            module.due = now;
            for Group { number, target, .. } in self.groups {
                let members = self.modules.iter().filter(|module| module.group == Some(number));
                // There is room for each group.
                let _ = self.client.members(target, members.map(|module| module.node).collect::<Nodes>());
            }
        }
    }

    /// Leaves the modules to another controller. What is stopped stays stopped.
    fn give_way(&mut self, now: u32) {
        self.has_rival = true;
        for group in self.groups.into_iter().filter(|group| matches!(group.task, Task::Deliver { .. })) {
            // It is one of the station's.
            let _ = self.begin(group.number, Task::Watch, now);
        }
    }

    /// Knows no more of some modules than that they are there.
    fn forget(&mut self, is_one: impl Fn(&Module<P>) -> bool) {
        for module in self.modules.iter_mut().filter(|module| is_one(module)) {
            module.duty.forget();
            module.reached_ma = 0;
            (module.voltage_mv, module.current_ma, module.status) = (None, None, None);
        }
    }
}

/// An address, and the module that has it if one was found.
#[derive(Clone, Copy, Debug)]
pub struct Module<P: Protocol> {
    /// The address, as the document counts.
    pub node: u8,
    /// The number of its group, if it has said so.
    pub group: Option<u8>,
    /// What it is to do, and what is known of its output.
    pub duty: Duty,
    /// The voltage at its output in mV.
    pub voltage_mv: Option<i32>,
    /// The current at its output in mA.
    pub current_ma: Option<i32>,
    /// What it has said of its state last, for [`Received::conditions`].
    pub status: Option<Received<P>>,
    /// When the next round begins.
    due: u32,
    /// What reads its state, and how many requests read it.
    watch: Option<Ticket>,
    reads: usize,
    /// The current that is asked for, and the one that was in effect, in mA.
    step_ma: i32,
    reached_ma: i32,
}

impl<P: Quantities + Addressed> Module<P> {
    const fn new(node: u8) -> Self {
        Self {
            node,
            group: None,
            duty: Duty::new(node),
            voltage_mv: None,
            current_ma: None,
            status: None,
            due: 0,
            watch: None,
            reads: 0,
            step_ma: 0,
            reached_ma: 0,
        }
    }

    /// Returns the worst of what it reports, if it reports anything with a severity.
    pub fn severity(&self) -> Option<Severity> {
        self.status.as_ref()?.conditions().filter_map(|bit| bit.severity).max()
    }

    /// Takes an answer.
    fn answered(&mut self, ticket: Ticket, received: &Received<P>) {
        if self.duty.answered(ticket, received) {
            self.reached_ma = self.step_ma;
        }
        self.voltage_mv = received.quantity(Quantity::OUTPUT_VOLTAGE).or(self.voltage_mv);
        self.current_ma = received.quantity(Quantity::OUTPUT_CURRENT).or(self.current_ma);
        if let Some(is_on) = received.quantity(Quantity::DELIVERING) {
            self.status = Some(*received);
            self.reached_ma = if is_on == 0 { 0 } else { self.reached_ma };
        }
    }
}

/// Returns what lets a module deliver, in the order in which it is sent.
const fn output(voltage_mv: i32, current_ma: i32) -> [(Quantity, i32); 3] {
    [(Quantity::OUTPUT_VOLTAGE, voltage_mv), (Quantity::OUTPUT_CURRENT, current_ma), (Quantity::DELIVERING, 1)]
}

/// Tests whether an echo says what was asked for.
fn agrees<P: Quantities>(asked: &Received<P>, said: &Received<P>) -> bool {
    said.confirms(asked, TOLERANCE)
}

/// Tests whether a time has come. It may lie up to 24 days back.
const fn is_due(time: u32, now: u32) -> bool {
    now.wrapping_sub(time) < 1 << 31
}
