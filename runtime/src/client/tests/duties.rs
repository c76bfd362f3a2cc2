//! What a heater is to do, against what it says.
//!
//! The reply to a read says whether it is on. The read also takes the part of the switch-on.

use super::order::{Asking, REFRESH, echo, on, sent, set};
use super::{PACE, Polled};
use crate::client::{Duty, Heard, Output, repeats};
use crate::tests::heaters::{Heat, Message, frame};
use crate::{Frame, Request};

/// Heater 3, and the program that tells it.
struct Told {
    client: Asking,
    duty: Duty,
}

impl Told {
    const fn nothing() -> Self {
        Self { client: Asking::new(PACE), duty: Duty::new(3) }
    }

    fn hold<const N: usize>(&mut self, requests: [Request<Message, Heat>; N], now: u32) {
        let requests = requests.map(Request::untyped);
        self.duty.hold(&mut self.client, requests, REFRESH, repeats, now).expect("there is room");
    }

    /// Takes a reply. Returns whether it confirms what is held.
    fn hears(&mut self, frame: &Frame) -> bool {
        let Heard::Answer { ticket, received } = self.client.hear(frame) else { panic!("{frame} answers nothing") };
        self.duty.answered(ticket, &received)
    }

    /// Reads whether the heater is on. Returns what is known then.
    fn reads(&mut self, is_on: u8, now: u32) -> Output {
        self.client.ask(on(3), now).expect("there is room");
        sent(&mut self.client, now..now + 40);
        self.hears(&frame(0x010C_F003, [is_on, 0, 0, 0]));
        self.duty.output()
    }
}

#[test]
fn a_heater_is_off_only_if_it_says_so_after_it_has_confirmed_that() {
    let mut told = Told::nothing();
    assert_eq!(told.duty.output(), Output::Unknown);
    assert_eq!([told.reads(0, 0), told.reads(1, 300)], [Output::Off, Output::On], "it was told nothing");
    for (is_on, known) in [(0, Output::Unknown), (1, Output::On)] {
        told = Told::nothing();
        told.hold([set(0.0)], 0);
        assert_eq!(sent(&mut told.client, 0..1), [(0, *set(0.0).frame())]);
        assert_eq!(told.reads(is_on, 20), known);
        assert!(told.hears(&echo(0)));
        assert_eq!(told.duty.output(), known, "the echo says nothing of it");
        assert_eq!(told.reads(0, 300), Output::Off);
        told.duty.forget();
        assert_eq!([told.duty.output(), told.reads(0, 600)], [Output::Unknown; 2]);
    }
}

#[test]
fn the_last_request_confirms_and_the_first_leads() {
    let mut told = Told::nothing();
    told.hold([set(1500.0), on(3)], 0);
    assert_eq!(sent(&mut told.client, 0..50), [(0, *set(1500.0).frame())]);
    assert!(!told.hears(&echo(150)));
    assert_eq!(sent(&mut told.client, 50..60), [(50, *on(3).frame())]);
}

#[test]
fn a_duty_that_ends_is_not_renewed_and_needs_a_new_confirmation() {
    let mut told = Told::nothing();
    told.hold([set(1500.0), on(3)], 0);
    assert_eq!(sent(&mut told.client, 0..50), [(0, *set(1500.0).frame())]);
    told.hears(&echo(150));
    told.duty.end(&mut told.client);
    assert_eq!(sent(&mut told.client, 50..5000), []);
    assert_eq!(told.duty.output(), Output::Unknown);
    assert_eq!(told.reads(0, 5000), Output::Unknown);
}

#[test]
fn what_is_held_again_goes_on_and_anything_else_is_to_be_confirmed() {
    let mut told = Told::nothing();
    told.hold([set(0.0)], 0);
    sent(&mut told.client, 0..1);
    told.hears(&echo(0));
    assert_eq!(told.reads(0, 20), Output::Off);
    told.hold([set(0.0)], 100);
    assert_eq!(told.duty.output(), Output::Off);
    told.hold([set(10.0)], 100);
    assert_eq!([told.duty.output(), told.reads(0, 200)], [Output::Unknown; 2]);
    // Nothing is held any more, so nothing is to be confirmed.
    told.duty.end(&mut told.client);
    told.hold([], 300);
    assert_eq!(told.reads(0, 400), Output::Off);
}

#[test]
fn an_answer_of_another_module_says_nothing_of_this_one() {
    let mut told = Told::nothing();
    assert_eq!(told.duty.node(), 3);
    told.hold([set(0.0)], 0);
    assert_eq!(sent(&mut told.client, 0..1), [(0, *set(0.0).frame())]);
    assert!(told.hears(&echo(0)));
    assert_eq!(told.reads(0, 300), Output::Off);
    let mut other = Duty::new(4);
    other.hold(&mut told.client, [set(0.0).untyped()], REFRESH, repeats, 350).expect("it is held");
    let ticket = told.client.ask(on(3), 600).expect("there is room");
    assert_eq!(sent(&mut told.client, 600..640), [(600, *on(3).frame())]);
    let Heard::Answer { received, .. } = told.client.hear(&frame(0x010C_F003, [1, 0, 0, 0])) else { panic!("asked") };
    assert_eq!([other.answered(ticket, &received), told.duty.answered(ticket, &received)], [false; 2]);
    assert_eq!([other.output(), told.duty.output()], [Output::Unknown, Output::On]);
}
