//! A controller of charging modules in groups, of any protocol that has the quantities.
//!
//! It asks each module in rounds. While a group delivers, a round is: the set-point, the switch-on, and what is to be
//! read. The switch-on is sent once, and only after the echo of the set-point has agreed in the same round. So no module
//! is switched on without its set-point after a restart. It only must take longer to start than the switch-on waits for
//! the bus. The next round renews both. No module is left alone for longer than a round.
//!
//! A stop goes to the group first, and then to each module in its rounds. Only what a module says of its output
//! afterwards shows that it is off. What says nothing is unknown.
//!
//! Requests that come from the bus are those of another controller. From then on the station only reads, until the
//! program delivers or stops again. So the driver must not hand over the frames that the station itself has sent.
#![no_std]

use canspec_runtime::client::{Client, Full, Heard, Pace, Step, Ticket};
use canspec_runtime::{Addressed, Error, Frame, Protocol, Quantities, Quantity, Received, Request, Severity};

/// What is read in each round, the state last.
const READINGS: [Quantity; 3] = [Quantity::OUTPUT_VOLTAGE, Quantity::OUTPUT_CURRENT, Quantity::DELIVERING];

/// What a round sets at most, in the order in which it is sent.
type Values = [(Quantity, i32); 3];

/// The values of a module that is off. The last one switches it off.
const OFF: Values = [(Quantity::OUTPUT_VOLTAGE, 0), (Quantity::OUTPUT_CURRENT, 0), (Quantity::DELIVERING, 0)];

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

impl Task {
    /// Returns what a round sets while no more than a current is allowed, and the first value of it that is sent.
    fn values(self, most_ma: i32) -> (Values, usize) {
        let Self::Deliver { voltage_mv, current_ma } = self else {
            return (OFF, if self == Self::Stop { 2 } else { OFF.len() });
        };
        let mut values = OFF.map(|(quantity, _)| (quantity, 1));
        (values[0].1, values[1].1) = (voltage_mv, current_ma.min(most_ma));
        (values, 0)
    }
}

/// How a station works. Times are in milliseconds.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// How fast it asks.
    pub pace: Pace,
    /// The time from one round of a module to the next: a part of the watchdog's, and more than two waits.
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
    /// When its stop is sent again.
    due: u32,
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
pub struct Station<P: Quantities + Addressed, const M: usize, const G: usize, const R: usize> {
    settings: Settings,
    client: Client<P, R>,
    modules: [Module<P>; M],
    groups: [Group<P::Target>; G],
    has_rival: bool,
}

impl<P: Quantities + Addressed, const M: usize, const G: usize, const R: usize> Station<P, M, G, R> {
    /// Returns a station that only reads. It looks for modules at `addresses`. Each group has its number and its address.
    pub fn new(settings: Settings, addresses: [u8; M], groups: [(u8, P::Target); G]) -> Self {
        let group = |(number, target)| Group { number, target, task: Task::Watch, due: 0 };
        Self {
            settings,
            client: Client::new(settings.pace),
            modules: addresses.map(Module::new),
            groups: groups.map(group),
            has_rival: false,
        }
    }

    /// Returns the modules that have been found.
    pub fn modules(&self) -> impl Iterator<Item = &Module<P>> {
        self.modules.iter().filter(|module| module.group.is_some())
    }

    /// Tests whether a group is known to be off: it has modules, and each has said so since it was stopped.
    pub fn is_off(&self, group: u8) -> bool {
        let mut members = self.modules.iter().filter(|module| module.group == Some(group)).peekable();
        members.peek().is_some() && members.all(|module| module.state == State::Off)
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
        let task = Task::Deliver { voltage_mv, current_ma };
        let known = self.groups.iter().find(|known| known.number == group).ok_or(Refused::Group)?;
        drop(P::set(&task.values(current_ma).0, known.target).map_err(Refused::Output)?);
        self.has_rival = false;
        self.begin(group, task, now)
    }

    /// Switches a group off. It goes on to do so until each module has said that it is off, and as long as it has found
    /// none.
    ///
    /// # Errors
    ///
    /// Refuses an unknown group.
    pub fn stop(&mut self, group: u8, now: u32) -> Result<(), Refused> {
        self.begin(group, Task::Stop, now)
    }

    /// Takes a frame from the bus.
    pub fn handle(&mut self, frame: &impl embedded_can::Frame, now: u32) {
        match self.client.handle(frame) {
            Heard::Answer { ticket, received } => {
                self.asked(ticket).into_iter().for_each(|module| module.answered(&received));
            }
            Heard::Refusal { ticket, .. } | Heard::ShortRefusal(ticket) => {
                self.asked(ticket).into_iter().for_each(|module| module.failed(false));
            }
            Heard::Other(received) if received.is_to_module() => self.give_way(now),
            // The request waits on, or has ended before.
            _ => {}
        }
    }

    /// Returns the next frame to send. Call it until there is none, after all frames from the bus were handled.
    pub fn poll(&mut self, now: u32) -> Option<Frame> {
        loop {
            // What finds no room is asked later.
            let _ = self.ask(now);
            match self.client.poll(now) {
                Step::Send { frame, .. } => return Some(frame),
                Step::Lost(ticket) => self.asked(ticket).into_iter().for_each(|module| module.failed(true)),
                // Groups are asked again, and modules say more than their silence does.
                Step::Done(_) | Step::Missing { .. } | Step::Silent(_) | Step::Back(_) => {}
                Step::Wait(_) => return None,
            }
        }
    }

    /// Asks what is due: stops of groups, then the modules.
    fn ask(&mut self, now: u32) -> Result<(), Full> {
        let once = Pace { tries: 1, ..self.settings.pace };
        for (place, Group { number, target, task, due }) in self.groups.into_iter().enumerate() {
            if task == Task::Stop && is_due(due, now) && !self.is_off(number) {
                for request in P::set(&OFF[2..], target).into_iter().flatten() {
                    let ticket = self.client.ask_at(once, request, now)?;
                    self.client.hurry(ticket, now);
                }
                self.groups[place].due = now.wrapping_add(self.settings.round);
            }
        }
        for module in &mut self.modules {
            let group = self.groups.iter().find(|group| module.group == Some(group.number));
            let task = group.map_or(Task::Watch, |group| group.task);
            if let Some(request) = module.next(task, &self.settings, now) {
                let pace = if module.is_asked_once() { once } else { self.settings.pace };
                module.asked = Some(self.client.ask_at(pace, request, now)?);
            }
        }
        Ok(())
    }

    /// Begins a task of a group.
    fn begin(&mut self, number: u8, task: Task, now: u32) -> Result<(), Refused> {
        let group = self.groups.iter_mut().find(|group| group.number == number).ok_or(Refused::Group)?;
        (group.task, group.due) = (task, now);
        for module in self.modules.iter_mut().filter(|module| module.group == Some(number)) {
            (module.state, module.step, module.round) = (State::Unknown, 0, now);
            module.asked.take().into_iter().for_each(|ticket| self.client.cancel(ticket));
        }
        Ok(())
    }

    /// Returns the module to which a request goes, if it is not one to a group.
    fn asked(&mut self, ticket: Ticket) -> Option<&mut Module<P>> {
        self.modules.iter_mut().find(|module| module.asked == Some(ticket))
    }

    /// Leaves the modules to another controller. What is stopped stays stopped.
    fn give_way(&mut self, now: u32) {
        self.has_rival = true;
        for group in self.groups.into_iter().filter(|group| matches!(group.task, Task::Deliver { .. })) {
            // It is one of the station's.
            let _ = self.begin(group.number, Task::Watch, now);
        }
    }
}

/// What is known of the output of a module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// Nothing: it is silent, or has not said anything since it was told something else.
    Unknown,
    /// It has said that it is off. While its group is stopped, it has also confirmed the switch-off before.
    Off,
    /// It has said that it is on.
    On,
}

/// An address, and the module that has it if one was found.
#[derive(Clone, Copy, Debug)]
pub struct Module<P: Protocol> {
    /// The address, as the document counts.
    pub node: u8,
    /// The number of its group, if it has said so.
    pub group: Option<u8>,
    /// What is known of its output.
    pub state: State,
    /// The voltage at its output in mV.
    pub voltage_mv: Option<i32>,
    /// The current at its output in mA.
    pub current_ma: Option<i32>,
    /// What it has said of its state last, for [`Received::conditions`].
    pub status: Option<Received<P>>,
    asked: Option<Ticket>,
    /// When the round begins, or has begun.
    round: u32,
    step: usize,
    /// What the round sets, the first value of it that is sent, and in how many requests.
    values: (Values, usize),
    sets: usize,
    /// Whether every echo of the round has agreed so far.
    is_confirmed: bool,
    /// The current that a whole round has set, in mA.
    reached_ma: i32,
}

impl<P: Quantities + Addressed> Module<P> {
    const fn new(node: u8) -> Self {
        Self {
            node,
            group: None,
            state: State::Unknown,
            voltage_mv: None,
            current_ma: None,
            status: None,
            asked: None,
            round: 0,
            step: 0,
            values: (OFF, OFF.len()),
            sets: 0,
            is_confirmed: true,
            reached_ma: 0,
        }
    }

    /// Returns the worst of what it reports, if it reports anything with a severity.
    pub fn severity(&self) -> Option<Severity> {
        self.status.as_ref()?.conditions().filter_map(|bit| bit.severity).max()
    }

    /// Returns the next request of the round, if one is due.
    fn next(&mut self, task: Task, settings: &Settings, now: u32) -> Option<Request<P, ()>> {
        if self.asked.is_some() || !is_due(self.round, now) {
            return None;
        }
        if self.step == 0 {
            (self.round, self.is_confirmed) = (now, true);
            self.values = task.values(self.reached_ma.saturating_add(settings.rise_ma));
        }
        let target = P::module(self.node.into())?;
        let sets = || P::set(&self.values.0[self.values.1..], target).into_iter().flatten();
        let reads = P::read(if self.group.is_some() { &READINGS } else { &[Quantity::GROUP] }, target);
        let request = sets().chain(reads.into_iter().flatten()).nth(self.step);
        self.sets = sets().count();
        if request.is_none() {
            (self.step, self.round) = (0, self.round.wrapping_add(settings.round));
        }
        request
    }

    /// Tests whether a request is not repeated before the next round: what sets something, and what looks for a module.
    const fn is_asked_once(&self) -> bool {
        self.is_set() || self.group.is_none()
    }

    /// Tests whether the request under way sets something.
    const fn is_set(&self) -> bool {
        self.step < self.sets
    }

    /// Takes the answer to the request under way.
    fn answered(&mut self, received: &Received<P>) {
        if self.is_set() && !self.agrees(received) {
            return self.failed(false);
        }
        self.voltage_mv = received.quantity(Quantity::OUTPUT_VOLTAGE).or(self.voltage_mv);
        self.current_ma = received.quantity(Quantity::OUTPUT_CURRENT).or(self.current_ma);
        if let Some(is_on) = received.quantity(Quantity::DELIVERING) {
            self.status = Some(*received);
            (self.state, self.reached_ma) = match (is_on, self.is_confirmed) {
                (0, true) => (State::Off, 0),
                (0, false) => (State::Unknown, 0),
                (_, true) => (State::On, self.values.0[1].1),
                (_, false) => (State::On, self.reached_ma),
            };
        }
        let group = received.quantity(Quantity::GROUP).and_then(|group| u8::try_from(group).ok()).or(self.group);
        // The first round begins when the group is known.
        self.step = if self.group.is_none() && group.is_some() { 0 } else { self.step + 1 };
        (self.asked, self.group) = (None, group);
    }

    /// Goes on after a request that failed. What follows a set-point in the round is left out with it.
    fn failed(&mut self, is_silent: bool) {
        self.asked = None;
        if self.is_set() {
            (self.is_confirmed, self.step) = (false, self.sets);
            return;
        }
        self.step += 1;
        if is_silent {
            (self.state, self.reached_ma) = (State::Unknown, 0);
            (self.voltage_mv, self.current_ma, self.status) = (None, None, None);
        }
    }

    /// Tests whether an echo says what the round sets.
    fn agrees(&self, received: &Received<P>) -> bool {
        let said = |(quantity, value): &(Quantity, i32)| {
            // INFY prints an echo that differs by 23 mV.
            let tolerance = if *quantity == Quantity::DELIVERING { 0 } else { 100 };
            Some(received.setting(*quantity)?.abs_diff(*value) <= tolerance)
        };
        self.values.0[self.values.1..].iter().filter_map(said).reduce(|one, other| one && other) == Some(true)
    }
}

/// Tests whether a time has come. It may lie up to 24 days back.
const fn is_due(time: u32, now: u32) -> bool {
    now.wrapping_sub(time) < 1 << 31
}
