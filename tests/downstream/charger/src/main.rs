//! A charging controller on Linux: four modules of INFY at a serial adapter, as one output.
//!
//! It takes `deliver MILLIVOLTS MILLIAMPERES`, `stop`, `emergency` and `show` from its input, a line each. It prints
//! what happens. When its input ends, it stops, and ends as soon as all modules are off.

mod settings;

/// The protocol of the modules.
pub mod infy {
    canspec_runtime::include_protocol!("infy");
}

use std::error::Error;
use std::io::stdin;
use std::sync::mpsc::{TryRecvError, channel};
use std::thread;
use std::time::Instant;

use canspec_runtime::clock::time_left;
use canspec_runtime::slcan::{BitRate, Port};
use canspec_runtime::station::{Drive, SetPoint, Station};

/// The number of the group that all modules are in.
const GROUP: u8 = 1;

type Charger = Station<infy::Message, 4, 1, 32>;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("name the serial port of the adapter")?;
    let mut drive = Drive::new(Port::open(path, BitRate::Kbit125)?);
    let groups = [(GROUP, Some(infy::Target::Group(GROUP)))];
    let mut charger = Charger::new(settings::SETTINGS, [0, 1, 2, 3], groups)?;

    let start = Instant::now();
    let clock = || u32::try_from(start.elapsed().as_millis() & 0xFFFF_FFFF).unwrap_or_default();
    let (commands, received) = channel();
    thread::spawn(move || stdin().lines().map_while(Result::ok).try_for_each(|line| commands.send(line)));
    loop {
        match received.try_recv() {
            Ok(line) => {
                let done = obey(&mut charger, &line, clock());
                println!("{line}: {}", done.map_or_else(|refused| refused.to_string(), |()| "done".to_owned()));
            }
            Err(TryRecvError::Disconnected) if charger.is_off(GROUP, clock()) => return Ok(()),
            Err(TryRecvError::Disconnected) => charger.stop(GROUP, clock())?,
            Err(TryRecvError::Empty) => {}
        }
        let until = drive.turn(&mut charger, clock, |_, event| println!("{event:?}"))?;
        drive.driver().wait(time_left(until, clock()).min(20));
    }
}

/// Does what a line says.
fn obey(charger: &mut Charger, line: &str, now: u32) -> Result<(), Box<dyn Error>> {
    match line.split(' ').collect::<Vec<_>>()[..] {
        ["deliver", voltage, current] => {
            let point = SetPoint { voltage_mv: voltage.parse()?, current_ma: Some(current.parse()?) };
            charger.deliver(GROUP, point, now)?;
        }
        ["stop"] => charger.stop(GROUP, now)?,
        ["emergency"] => charger.emergency(now),
        ["show"] => (0..4).for_each(|node| {
            println!("{node} {:?} {:?}", charger.output(node, now), charger.voltage_mv(node, now));
        }),
        _ => return Err("it is none of deliver, stop, emergency and show".into()),
    }
    Ok(())
}
