//! A layout written by hand, as generated code has it.

use std::string::ToString;

use super::*;
use crate::plumbing::Lack;
use crate::{Bytes, Payload, Place, Reason, Signal, Text};

/// Eleven bytes at most: a count of cycles, four valves of two bits each, and one to four cells of two bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cells {
    cycles: u16,
    valve: [u8; 4],
    voltage_v: Elements<f64, 4>,
    group: Elements<u8, 4>,
}

impl Cells {
    const CYCLES: LongSignal<u16> = LongSignal::new(0, Signal::new("cycles", Place::bytes(1, 0)));
    const VALVE: LongSignal<u8> = LongSignal::new(2, Signal::new("valve", Place::byte(0).bits(7, 6))).every_bits(-2);
    const VOLTAGE: LongSignal<u16, f64> =
        LongSignal::new(3, Signal::new("voltage", Place::bytes(1, 0).bits(11, 0)).unit("V").scale(1, 100)).every(2);
    const GROUP: LongSignal<u8> = LongSignal::new(3, Signal::new("group", Place::byte(1).bits(7, 4))).every(2);
}

impl LongLayout for Cells {
    const MESSAGE: &'static str = "cells";
    const SHORTEST: usize = 3;
    const LONGEST: usize = 11;
    const ELEMENTS: Option<(usize, usize)> = Some((1, 4));
    const BYTES: fn(usize) -> usize =
        |elements| Self::SHORTEST.max(Self::VOLTAGE.reach(elements)).max(Self::GROUP.reach(elements));
    const DECODE: fn(&[u8]) -> Self = |data| {
        let count = Self::VOLTAGE.fitting(data.len()).min(Self::GROUP.fitting(data.len()));
        Self {
            cycles: Self::CYCLES.read(data, Signal::get),
            valve: Self::VALVE.read_array(data, Signal::get),
            voltage_v: Self::VOLTAGE.read_some(data, count, Signal::decode),
            group: Self::GROUP.read_some(data, count, Signal::get),
        }
    };
    const ENCODE: fn(&Self, &mut LongPayload<'_>) -> Result<(), Error> = |message, payload| {
        Self::CYCLES.write(message.cycles, payload, Signal::put)?;
        Self::VALVE.write_all(&message.valve, payload, Signal::put)?;
        Self::VOLTAGE.write_some(&message.voltage_v, payload, Signal::encode)?;
        Self::GROUP.write_some(&message.group, payload, Signal::put)
    };
}

/// 0x0102 are 258 cycles; `0b11_01_00_10` are four valves; 0x014A is 330, and 0x114B is 331 with group 1.
const DATA: [u8; 7] = [0x02, 0x01, 0b1101_0010, 0x4A, 0x01, 0x4B, 0x11];

fn cells() -> Cells {
    Cells {
        cycles: 258,
        valve: [3, 1, 0, 2],
        voltage_v: Elements::from_slice(&[3.3, 3.31]).expect("two of four"),
        group: Elements::from_slice(&[0, 1]).expect("two of four"),
    }
}

#[test]
fn values_are_read_from_the_joined_data_and_written_to_the_same_bytes() {
    assert_eq!(Cells::decode(&DATA), Some(cells()));
    assert_eq!(cells().encode(&mut [0xFF; Cells::LONGEST]), Ok(&DATA[..]));
}

#[test]
fn an_element_that_is_cut_off_is_none_and_too_few_bytes_are_no_message() {
    let lengths = (0..=9).map(|length| {
        let data = [&DATA[..], &[0; 2]].concat();
        Cells::decode(&data[..length]).map(|cells| cells.voltage_v.len())
    });
    let expected = [None, None, None, Some(0), Some(0), Some(1), Some(1), Some(2), Some(2), Some(3)];
    assert!(lengths.eq(expected));
    assert_eq!(Cells::decode(&[0; 40]).map(|cells| cells.group.len()), Some(4));
}

#[test]
fn arrays_vary_together_and_within_their_limits() {
    let refused = |cells: Cells| cells.encode(&mut [0; 11]).expect_err("a refusal").to_string();
    let group = Elements::from_slice(&[0]).expect("one of four");
    assert_eq!(refused(Cells { group, ..cells() }), "`group` of `cells` has 1 elements, but its limits are 2 and 2");
    let none = Cells::decode(&DATA[..3]).expect("all that is always there");
    assert_eq!(refused(none), "`voltage` of `cells` has 0 elements, but its limits are 1 and 4");
}

#[test]
fn a_value_that_does_not_fit_and_a_short_buffer_are_refused() {
    let error = Cells { valve: [0, 4, 0, 0], ..cells() }.encode(&mut [0; 11]).expect_err("two bits");
    assert_eq!(error.to_string(), "`valve` of `cells` is 4, but its limits are 0 and 3");
    let error = cells().encode(&mut [0; 6]).expect_err("six of seven bytes");
    assert_eq!(error.to_string(), "`cells` has 7 data bytes, and the buffer has room for 6");
}

#[test]
fn elements_can_run_against_the_order_of_bytes_and_bits() {
    const DOWN: LongSignal<u8> = LongSignal::new(3, Signal::new("down", Place::byte(0))).every(-1);
    const UP: LongSignal<u8> = LongSignal::new(0, Signal::new("up", Place::bytes(1, 0).bits(2, 0))).every_bits(3);
    assert_eq!(DOWN.read_array(&[1, 2, 3, 4], Signal::get), [4, 3, 2, 1]);
    // 0x4A01 is 0b100_101_000_000_001 in groups of three bits.
    assert_eq!(UP.read_array(&[0x01, 0x4A], Signal::get), [1, 0, 0, 5, 4]);
    assert_eq!(
        ([0, 1, 4].map(|count| DOWN.reach(count)), [1, 3, 5].map(|count| UP.reach(count))),
        ([0, 4, 4], [1, 2, 2])
    );
    let mut data = [0; 2];
    UP.write_all(
        &[1, 0, 0, 5, 4],
        &mut LongPayload::new(Payload::new("message", [0; 8]), None, &mut data),
        Signal::put,
    )
    .expect("three bits each");
    assert_eq!(data, [0x01, 0x4A]);
}

/// A code of two bytes, a name of nine letters in messages of at least eleven bytes, and a serial number of 12.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Plate {
    code: u16,
    name: Text<9, b' '>,
    serial: Option<Bytes<12>>,
}

impl Plate {
    const CODE: LongSignal<u16> = LongSignal::new(0, Signal::new("code", Place::bytes(0, 1)));
    const NAME: LongText<Text<9, b' '>> = LongText::new(2, Signal::new("name", Place::byte(0)));
    const SERIAL: LongText<Bytes<12>> =
        LongText::new(11, Signal::new("serial", Place::byte(0)).lacking(&[(7, Lack::Signal(0xFF, 0))]));
}

impl LongLayout for Plate {
    const MESSAGE: &'static str = "plate";
    const SHORTEST: usize = 11;
    const LONGEST: usize = 23;
    const DECODE: fn(&[u8]) -> Self = |data| Self {
        code: Self::CODE.read(data, Signal::get),
        name: Self::NAME.read(data),
        serial: Self::SERIAL.read_optional(data),
    };
    const ENCODE: fn(&Self, &mut LongPayload<'_>) -> Result<(), Error> = |message, payload| {
        payload.end_after(11);
        if message.serial.is_some() {
            payload.end_after(23);
        }
        Self::CODE.write(message.code, payload, Signal::put)?;
        Self::NAME.write(&message.name, payload)?;
        Self::SERIAL.write_optional(&message.serial, payload)
    };
}

#[test]
fn a_text_of_more_than_eight_bytes_has_them_in_their_order() {
    let data = *b"\x01\x02PUMP 4711\0\x01\x02\x03\x04\x05\x06\x07\x08\x09\x0A\x0B";
    let plate = Plate::decode(&data).expect("all bytes");
    assert_eq!((plate.code, plate.name.as_str()), (0x0102, Some("PUMP 4711")));
    assert_eq!(plate.serial, Bytes::from_hex("000102030405060708090A0B"));
    assert_eq!(plate.encode(&mut [0xEE; 23]), Ok(&data[..]));
    let short = Plate::decode(&data[..22]).expect("the name came");
    assert_eq!((short.serial, short.encode(&mut [0xEE; 11])), (None, Ok(&data[..11])));
    assert_eq!(plate.encode(&mut [0; 22]), Err(Error::Room { message: "plate", length: 23, room: 22 }));
    assert_eq!((Plate::NAME.reach(4), Plate::NAME.byte().own_name()), (6, "name"));
}

/// Returns message and signal of a refused value, and why it is refused.
fn said(error: Error) -> (&'static str, &'static str, Reason) {
    let Error::Value(error) = error else { panic!("{error}") };
    (error.message(), error.signal(), error.reason())
}

#[test]
fn a_text_cannot_be_left_out_before_the_end() {
    let mut data = [0; 23];
    let mut payload = LongPayload::new(Payload::new("plate", [0; 8]), None, &mut data);
    payload.end_after(22);
    assert_eq!(Plate::SERIAL.write_optional(&None, &mut payload), Ok(()));
    payload.end_after(23);
    let missing = Plate::SERIAL.write_optional(&None, &mut payload).expect_err("there is room for it");
    assert_eq!(said(missing), ("plate", "serial", Reason::Missing));
}

#[test]
fn a_device_model_has_only_blank_bytes_where_it_lacks_a_text() {
    let on = |model| Payload::within_limits("plate", [0; 8]).for_model(Some(model));
    let plate = |serial| Plate { code: 1, name: Text::default(), serial: Some(Bytes::new(serial)) };
    let mut last = [0; 12];
    last[11] = 1;
    assert!(plate([0; 12]).encode_by(on(7), 0, &mut [0; 23]).is_ok());
    let refused =
        plate(last).encode_by(on(7), 0, &mut [0; 23]).map(|data| data.len()).expect_err("model 7 has no serial");
    assert_eq!(said(refused), ("plate", "serial", Reason::Meaning));
    assert!(plate(last).encode_by(on(8), 0, &mut [0; 23]).is_ok());
}

/// The charge. A name of two bytes, two heaters and a power behind it are not on model 7, where their bits are 1.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Charge {
    percent: u8,
    name: Option<Bytes<2>>,
    heater: [Option<u8>; 2],
    power: Option<u16>,
}

impl Charge {
    const PERCENT: LongSignal<u8> = LongSignal::new(0, Signal::new("percent", Place::byte(0)));
    const NAME: LongText<Bytes<2>> =
        LongText::new(1, Signal::new("name", Place::byte(0)).lacking(&[(7, Lack::Signal(0xFF, 0xFF))]));
    const HEATER: LongSignal<u8> =
        LongSignal::new(3, Signal::new("heater", Place::byte(0)).lacking(&[(7, Lack::Signal(0xFF, 0xFF))])).every(1);
    const POWER: LongSignal<u16> =
        LongSignal::new(5, Signal::new("power", Place::bytes(0, 1)).lacking(&[(7, Lack::Signal(0xFFFF, 0xFFFF))]));
}

impl LongLayout for Charge {
    const MESSAGE: &'static str = "charge";
    const SHORTEST: usize = 1;
    const LONGEST: usize = 7;
    const BLANK: u8 = 0xFF;
    const DECODE: fn(&[u8]) -> Self = |data| Self {
        percent: Self::PERCENT.read(data, Signal::get),
        name: Self::NAME.read_optional(data),
        heater: Self::HEATER.read_optional_array(data, Signal::get_some),
        power: Self::POWER.read_optional(data, Signal::get_some),
    };
    const ENCODE: fn(&Self, &mut LongPayload<'_>) -> Result<(), Error> = |message, payload| {
        payload.end_after(1);
        if message.name.is_some() || payload.reaches(Self::NAME.byte()) {
            payload.end_after(3);
        }
        if message.heater[0].is_some() || message.heater[1].is_some() || payload.reaches(Self::HEATER.signal()) {
            payload.end_after(5);
        }
        if message.power.is_some() || payload.reaches(Self::POWER.signal()) {
            payload.end_after(7);
        }
        Self::PERCENT.write(message.percent, payload, Signal::put)?;
        Self::NAME.write_optional(&message.name, payload)?;
        Self::HEATER.write_all(&message.heater, payload, Signal::put_some)?;
        Self::POWER.write(message.power, payload, Signal::put_some)
    };

    fn on_model(mut self, data: &[u8], model: Option<u8>) -> Self {
        Self::NAME.hide(&mut self.name, data, model);
        Self::HEATER.hide_all(&mut self.heater, data, model);
        Self::POWER.hide(&mut self.power, data, model);
        self
    }
}

#[test]
fn what_a_device_model_does_not_have_is_there_only_if_bits_show_it() {
    let bare = Charge { percent: 84, name: None, heater: [None; 2], power: None };
    let (name, power) = (Bytes::new([0xFF, 0x41]), 0xFFFE);
    for (data, shown) in [
        ([84, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF], bare),
        ([84, 0xFF, 0x41, 0xFF, 0xFF, 0xFF, 0xFF], Charge { name: Some(name), ..bare }),
        ([84, 0xFF, 0xFF, 5, 0xFF, 0xFF, 0xFF], Charge { heater: [Some(5), None], ..bare }),
        ([84, 0xFF, 0xFF, 0xFF, 5, 0xFF, 0xFF], Charge { heater: [None, Some(5)], ..bare }),
        ([84, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFE], Charge { power: Some(power), ..bare }),
    ] {
        assert_eq!(Charge::decode_for(7, &data), Some(shown), "{data:?}");
        let whole = Charge::decode(&data);
        assert_eq!(Charge::decode_for(8, &data), whole, "{data:?}");
        assert!(whole.is_some_and(|whole| whole.name.is_some() && whole.power.is_some()));
    }
    assert_eq!(Charge::decode_for(7, &[84]), Some(bare));
    assert_eq!(Charge::decode_for(7, &[]), None);
}

#[test]
fn a_request_to_a_device_model_has_what_that_model_has() {
    let on = |model| Payload::within_limits("charge", [0; 8]).for_model(model);
    let bare = Charge { percent: 84, name: None, heater: [None; 2], power: None };
    let name = Some(Bytes::new([0x41, 0x42]));
    let sent = |rules, values: Charge| values.encode_by(rules, 0, &mut [0; 7]).map(|data| data.to_vec()).map_err(said);
    let missing = |signal| Err(("charge", signal, Reason::Missing));
    assert_eq!(sent(on(Some(7)), bare), Ok([84].to_vec()));
    assert_eq!(sent(on(None), bare), Ok([84].to_vec()));
    assert_eq!(sent(Payload::new("charge", [0; 8]).for_model(Some(8)), bare), Ok([84].to_vec()));
    assert_eq!(sent(on(Some(8)), bare), missing("name"));
    assert_eq!(sent(on(Some(8)), Charge { name, ..bare }), missing("heater"));
    let heated = Charge { name, heater: [Some(1), Some(2)], ..bare };
    assert_eq!(sent(on(Some(8)), heated), missing("power"));
    assert_eq!(sent(on(Some(8)), Charge { power: Some(3), ..heated }), Ok([84, 0x41, 0x42, 1, 2, 0, 3].to_vec()));
    // Bits that are blank show nothing.
    let blank = Charge { power: Some(0xFFFF), ..bare };
    assert_eq!(sent(on(Some(7)), blank), Ok([84, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF].to_vec()));
}

/// A count, and 2 to 6 letters or bytes behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Open<T> {
    count: u8,
    text: T,
}

impl<T: ByteRun + 'static> Open<T> {
    const COUNT: LongSignal<u8> = LongSignal::new(0, Signal::new("count", Place::byte(0)));
    const TEXT: LongText<T> = LongText::new(1, Signal::new("text", Place::byte(0))).at_least(2);
}

impl<T: ByteRun + 'static> LongLayout for Open<T> {
    const MESSAGE: &'static str = "open";
    const SHORTEST: usize = 3;
    const LONGEST: usize = 7;
    const ELEMENTS: Option<(usize, usize)> = Some((2, 6));
    const BYTES: fn(usize) -> usize = |elements| Self::TEXT.reach(elements).max(Self::SHORTEST);
    const DECODE: fn(&[u8]) -> Self =
        |data| Self { count: Self::COUNT.read(data, Signal::get), text: Self::TEXT.read(data) };
    const ENCODE: fn(&Self, &mut LongPayload<'_>) -> Result<(), Error> = |message, payload| {
        Self::COUNT.write(message.count, payload, Signal::put)?;
        Self::TEXT.write(&message.text, payload)
    };
}

#[test]
fn an_open_text_is_as_long_as_it_must_be_and_what_follows_fills_it_up() {
    let written = |text: &str, expected: &[u8], rest: &[u8]| {
        let open = Open { count: 5, text: Text::<6, b'_'>::new(text).expect("at most six letters") };
        let mut buffer = [0xEE; 7];
        let written = open.encode(&mut buffer).map(<[u8]>::to_vec);
        assert_eq!(written.as_deref(), Ok(expected));
        assert_eq!(buffer[expected.len()..], *rest);
        assert_eq!(Open::decode(expected), Some(open));
    };
    written("", b"\x05__", b"____");
    written("A", b"\x05A_", b"____");
    written("A_CD", b"\x05A_CD", b"__");
    written("ABCDEF", b"\x05ABCDEF", b"");
    assert_eq!(Open::<Text<6, b'_'>>::decode(b"\x05A"), None);
    let longer = Open::<Text<6, b'_'>>::decode(b"\x05AB____XY").expect("enough bytes");
    assert_eq!((longer.text.as_str(), longer.encode(&mut [0; 7])), (Some("AB"), Ok(&b"\x05AB"[..])));
}

#[test]
fn all_bytes_of_open_raw_bytes_belong_to_them() {
    let data = [5, 1, 0, 0];
    let open = Open::<Elements<u8, 6>>::decode(&data).expect("enough bytes");
    assert_eq!(*open.text, [1, 0, 0]);
    assert_eq!(open.encode(&mut [0xEE; 7]), Ok(&data[..]));
    let one = Open { count: 5, text: Elements::<u8, 6>::from_fn(1, |_| 9) };
    let too_few = Error::Elements { message: "open", signal: "text", count: 1, minimum: 2, maximum: 6 };
    assert_eq!(one.encode(&mut [0xEE; 7]), Err(too_few));
}

#[test]
fn a_device_model_that_lacks_an_open_text_is_sent_none_of_its_bytes() {
    const BYTE: Signal<u8> = Signal::new("text", Place::byte(0)).lacking(&[(7, Lack::Signal(0xFF, 0))]);
    const TEXT: LongText<Text<6, b'_'>> = LongText::new(1, BYTE);
    const TEXTS: [LongText<Text<6, b'_'>>; 2] = [TEXT.at_least(0), TEXT.at_least(1)];
    let written = |least: u16, letters: &str| {
        let mut data = [0xEE; 7];
        let rules = Payload::within_limits("open", [0; 8]).for_model(Some(7));
        let mut payload = LongPayload::new(rules, Some((least.into(), 6)), &mut data);
        let letters = Text::new(letters).expect("at most six letters");
        TEXTS[usize::from(least)].write(&letters, &mut payload).map(|()| data)
    };
    assert_eq!(written(0, ""), Ok(*b"\xEE______"));
    for (least, letters) in [(0, "A"), (1, "")] {
        let refused = written(least, letters).expect_err("model 7 has no text");
        assert_eq!(said(refused), ("open", "text", Reason::Meaning));
    }
}
