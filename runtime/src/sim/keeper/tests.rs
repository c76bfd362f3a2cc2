use super::Keeper;
use crate::sim::{Answer, Device};
use crate::tests::heaters::{Message, frame};
use crate::{AfterSilence, Quantity, Received};

/// A heater that limits its power to 2000 W, and keeps it without power.
type Heater = Keeper<Message, 1>;

/// Tells a heater its power in steps of 10 W. Returns whether it obeys, and what it keeps.
fn told(heater: &mut Heater, steps: u8) -> (bool, Option<i32>) {
    let request = Received::decode(&frame(0x0107_03F0, [1, 0, 0, steps])).expect("a request");
    let is_obeyed = matches!(heater.answer(&request, 0), Answer::Values(_));
    (is_obeyed, heater.value(Quantity::OUTPUT_POWER))
}

#[test]
fn a_value_out_of_range_is_limited_on_the_way_from_the_one_before() {
    let mut heater = Heater::new(|_, _| Answer::Silence);
    assert_eq!(told(&mut heater, 250), (false, None), "there is none before");
    assert_eq!(told(&mut heater, 150), (true, Some(1_500_000)));
    assert_eq!(told(&mut heater, 250), (false, Some(2_000_000)));
    assert_eq!(told(&mut heater, 0), (true, Some(0)));
}

#[test]
fn what_a_device_keeps_without_power_is_there_when_it_starts_anew() {
    let mut heater = Heater::new(|_, _| Answer::Silence);
    told(&mut heater, 150);
    heater.power_on(0);
    assert_eq!(heater.value(Quantity::OUTPUT_POWER), Some(1_500_000));
    heater.keep(Quantity::OUTPUT_POWER, 0);
    assert_eq!(heater.value(Quantity::OUTPUT_POWER), Some(0));
    let mut other = Heater::new(|_, _| Answer::Silence);
    other.keep(Quantity::GROUP, 3);
    other.power_on(0);
    assert_eq!(other.value(Quantity::GROUP), None, "nothing says that it is kept");
}

#[test]
fn a_device_does_after_silence_what_the_document_says() {
    use AfterSilence::{Keeps, Off, Resumes, Starts, Unknown};
    let states = |heater: Heater, delivers| {
        let mut heater = heater;
        heater.keep(Quantity::DELIVERING, delivers);
        heater.silence(0);
        let alone = heater.value(Quantity::DELIVERING);
        heater.wake(0);
        [alone, heater.value(Quantity::DELIVERING)].map(|state| state == Some(1))
    };
    let heater = Heater::new(|_, _| Answer::Silence);
    let both = |after_silence| [1, 0].map(|delivers| states(heater.after_silence(after_silence), delivers));
    assert_eq!([Off, Unknown].map(both), [[[false, false]; 2]; 2]);
    assert_eq!(both(Resumes), [[false, true], [false, false]]);
    assert_eq!(both(Starts), [[true, true]; 2]);
    assert_eq!(both(Keeps), [[true, true], [false, false]]);
    assert_eq!(states(heater, 1), [false, true], "the document of the heaters says that they resume");
}

#[test]
fn a_device_that_starts_anew_does_not_resume() {
    let mut heater = Heater::new(|_, _| Answer::Silence);
    heater.keep(Quantity::DELIVERING, 1);
    heater.silence(0);
    heater.power_on(0);
    heater.wake(0);
    assert_eq!(heater.value(Quantity::DELIVERING), None);
}

#[test]
fn a_device_resumes_only_once() {
    let mut heater = Heater::new(|_, _| Answer::Silence);
    heater.keep(Quantity::DELIVERING, 1);
    heater.silence(0);
    heater.wake(0);
    heater.keep(Quantity::DELIVERING, 0);
    heater.wake(0);
    assert_eq!(heater.value(Quantity::DELIVERING), Some(0));
}
