//! Requests of a client: each ends once.

use std::collections::HashMap;

use canspec_runtime::client::{Client, Heard, Step, Ticket};
use canspec_runtime::sim::{Complaint, Event};
use canspec_runtime::{Addressed, Quantities, Quantity, Request};
use canspec_station::pace;

use super::Run;

impl<P: Quantities + Addressed<Target: PartialEq>, const N: usize, const G: usize> Run<P, N, G> {
    /// Asks modules at random while they fail. Each request ends once, by its own answer or after all tries.
    pub fn requests(&mut self) -> Result<(), String> {
        // The last frame of the station can have been sent just now.
        let start = self.fleet.bus.now + pace::<P>().gap;
        self.draw_faults(0);
        self.nodes.clone().into_iter().for_each(|node| self.answer_all(node));
        let mut client: Client<P, 12> = Client::new(pace::<P>());
        let mut asked: HashMap<Ticket, Asked> = HashMap::new();
        for now in start..start + 20_000 {
            while let Some(event) = self.fleet.bus.bench.poll(now) {
                let (frame, at) = match event {
                    Event::Frame { frame, at } => (frame, at),
                    // This client does not feed modules.
                    Event::Complaint(Complaint::Unfed { .. }) => continue,
                    Event::Complaint(complaint) => return Err(complaint.to_string()),
                };
                match client.handle(&frame, at) {
                    Heard::Answer { ticket, received } => {
                        let said = received.setting(Quantity::OUTPUT_VOLTAGE);
                        let own = asked.get_mut(&ticket).ok_or("an answer to what was not asked")?;
                        if said != Some(own.voltage_mv) {
                            return Err(format!("an answer to {} mV says {said:?}", own.voltage_mv));
                        }
                        own.answered += 1;
                    }
                    Heard::Refusal { ticket, .. } | Heard::ShortRefusal(ticket) => {
                        asked.get_mut(&ticket).ok_or("a refusal of what was not asked")?.answered += 1;
                    }
                    _ => {}
                }
            }
            loop {
                match client.poll(now) {
                    Step::Send { frame, ticket } => {
                        asked.get_mut(&ticket).ok_or("what was not asked is sent")?.sent += 1;
                        self.fleet.bus.bench.send(&frame, now);
                    }
                    Step::Lost(ticket) => asked.get_mut(&ticket).ok_or("what was not asked is lost")?.lost += 1,
                    Step::Done(_) | Step::Missing { .. } | Step::Silent(_) | Step::Back(_) => {}
                    Step::ClockBack(_) => return Err("the clock goes back".into()),
                    Step::Wait(_) => break,
                }
            }
            if now < start + 8000 && self.random.chance(5) {
                let voltage_mv = self.fleet.other_mv + 10 * i32::try_from(asked.len()).expect("few");
                if let Ok(ticket) = client.ask(self.request(voltage_mv), now) {
                    asked.insert(ticket, Asked { voltage_mv, sent: 0, answered: 0, lost: 0 });
                }
            }
        }
        let tries = pace::<P>().tries.into();
        let ends_once = |own: &Asked| own.answered + own.lost == 1 && (own.lost == 0 || own.sent == tries);
        if asked.len() < 20 || !asked.values().all(ends_once) {
            return Err(format!("of {} requests, one does not end once, or is lost too early", asked.len()));
        }
        self.counts.add("requests answered or refused", asked.values().map(|own| own.answered).sum());
        self.counts.add("requests lost", asked.values().map(|own| own.lost).sum());
        Ok(())
    }

    /// Sets the voltage of one of two modules.
    fn request(&mut self, voltage_mv: i32) -> Request<P, ()> {
        let node = self.nodes[usize::try_from(self.random.below(2)).expect("below 2")];
        self.sets(node, voltage_mv)
    }
}

/// A request, and how often it was sent and ended.
struct Asked {
    voltage_mv: i32,
    sent: u64,
    answered: u64,
    lost: u64,
}
