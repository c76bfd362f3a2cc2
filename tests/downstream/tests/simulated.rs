//! A simulated winch on a bus with faults.

use canspec_runtime::Received;
use canspec_runtime::client::{Client, Pace, Step, repeats};
use canspec_runtime::sim::{Answer, Bench, Device, Event, Faults, Rules};
use winch_driver::winch::{Message, Run, Target};

/// A winch that runs as it is told, and stands after power-on.
#[derive(Default)]
struct Winch {
    speed_rpm: i16,
}

impl Device<Message> for Winch {
    fn answer(&mut self, request: &Received<Message>, _now: u32) -> Answer<Message> {
        let Message::Run(run) = *request.content() else { return Answer::Silence };
        self.speed_rpm = run.speed_rpm;
        Answer::Values(Message::Run(run))
    }

    fn power_on(&mut self, _now: u32) {
        self.speed_rpm = 0;
    }
}

#[test]
fn a_winch_runs_again_after_it_started_anew() {
    let rules = Rules { gap: 20, boot: 300, ..Rules::default() };
    let mut bench = Bench::<Message, Winch, 1, 8>::new([(0x12, Winch::default())], rules, 7);
    *bench.faults(0x12).expect("there is one winch") =
        Faults { lost: 30, slowest: 50, restarts: Some(4000), ..Faults::NONE };
    let mut client: Client<Message, 8> = Client::new(Pace { gap: 20, wait: 100, tries: 3, late: 100 });
    let pull = Run { speed_rpm: 600, ramp_s: 2.5 }.set(Target::Winch(0x12)).expect("it is slow enough");
    client.hold(pull, 1000, repeats, 0).expect("there is room");
    let mut speeds = Vec::new();
    for now in 0..6000 {
        while let Some(event) = bench.poll(now) {
            match event {
                Event::Frame { frame, at } => drop(client.handle(&frame, at)),
                Event::Complaint(complaint) => panic!("{complaint}"),
            }
        }
        while let Step::Send { frame, .. } = client.poll(now) {
            bench.send(&frame, now);
        }
        let speed_rpm = bench.device(0x12).map(|winch| winch.speed_rpm);
        if speeds.last() != Some(&speed_rpm) {
            speeds.push(speed_rpm);
        }
    }
    assert_eq!(speeds, [600, 0, 600].map(Some));
}
