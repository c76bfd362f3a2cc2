//! Quantities: one program drives every vendor's devices. The frames are those that the documents print.

use canspec_protocols::{daly, gcp, huawei, infy, megmeet, mxr, trio};
use canspec_runtime::client::{Client, Duty, Heard, Output, Pace, Step};
use canspec_runtime::sim::{Answer, Device, Keeper};
use canspec_runtime::{Addressed, Error, Frame, Quantities, Quantity, Reason, Received, Request};
use canspec_tests::{
    devices_any_vendor as feature, devices_any_vendor_in_steps as in_steps, devices_any_vendor_switched as in_f32,
    features_controller_report as charging, infy_in_steps,
};

const VOLTAGE: Quantity = Quantity::OUTPUT_VOLTAGE;
const CURRENT: Quantity = Quantity::OUTPUT_CURRENT;
const DELIVERING: Quantity = Quantity::DELIVERING;
const AMBIENT: Quantity = Quantity::AMBIENT_TEMPERATURE;

fn frame(id: u32, data: u64) -> Frame {
    let (extended, data) = (id > 0x7FF, data.to_be_bytes());
    Frame::new_raw(id, extended, data, 8)
}

/// Returns the frames that set quantities.
fn sets<P: Quantities + Addressed>(target: P::Target, values: &[(Quantity, i32)]) -> Result<Vec<Frame>, Error> {
    Ok(P::set(values, target)?.map(|request| *request.frame()).collect())
}

/// Returns the frames that read quantities.
fn reads<P: Quantities + Addressed>(target: P::Target, wanted: &[Quantity]) -> Result<Vec<Frame>, Error> {
    Ok(P::read(wanted, target)?.map(|request| *request.frame()).collect())
}

/// Returns the value of a quantity that a frame shows.
fn shown<P: Quantities>(id: u32, data: u64, quantity: Quantity) -> Option<i32> {
    Received::<P>::decode(&frame(id, data)).expect("a frame of the document").quantity(quantity)
}

#[test]
fn infy_is_set_and_read_by_the_frames_of_its_document() {
    let all = infy::Target::Broadcast;
    let module = <infy::Message as Addressed>::module(0).expect("module 0");
    let set = sets::<infy::Message>;
    // Section 2.4, 0x1C: 300 V and 10 A for all modules, then 200 V and 5 A for module 0.
    assert_eq!(set(all, &[(VOLTAGE, 300_000), (CURRENT, 10_000)]), Ok(vec![frame(0x029C_3FF0, 0x0004_93E0_0000_2710)]));
    assert_eq!(
        set(module, &[(CURRENT, 5000), (VOLTAGE, 200_000)]),
        Ok(vec![frame(0x029C_00F0, 0x0003_0D40_0000_1388)])
    );
    // Section 2.4, 0x1A: all modules off, module 0 on.
    assert_eq!(set(all, &[(DELIVERING, 0)]), Ok(vec![frame(0x029A_3FF0, 0x0100_0000_0000_0000)]));
    assert_eq!(set(module, &[(DELIVERING, 1)]), Ok(vec![frame(0x029A_00F0, 0)]));
    // Section 2.4, 0x03 and 0x0A.
    let show = shown::<infy::Message>;
    assert_eq!(show(0x0283_F000, 0x43FA_0000_4060_0000, VOLTAGE), Some(500_000));
    assert_eq!(show(0x0283_F000, 0x43FA_0000_4060_0000, CURRENT), Some(3500));
    assert_eq!(show(0x028A_F000, 0x02EE_0064_0100_05DC, Quantity::MAXIMUM_VOLTAGE), Some(750_000));
    assert_eq!(show(0x028A_F000, 0x02EE_0064_0100_05DC, Quantity::MINIMUM_VOLTAGE), Some(100_000));
    assert_eq!(show(0x028A_F000, 0x02EE_0064_0100_05DC, Quantity::MAXIMUM_CURRENT), Some(25_600));
    assert_eq!(show(0x028A_F000, 0x02EE_0064_0100_05DC, Quantity::RATED_POWER), Some(15_000_000));
    // Section 2.4, 0x04: group 2, 16 °C, and the DC side is not off.
    let status = |quantity| show(0x02C4_F000, 0x0000_0200_1000_4000, quantity);
    assert_eq!([Quantity::GROUP, AMBIENT, DELIVERING].map(status), [Some(2), Some(16_000), Some(1)]);
    assert_eq!(status(VOLTAGE), None, "another message has it");
    // The lowest bit of status 1 says that the DC side is off.
    assert_eq!(show(0x02C4_F000, 0x0000_0200_1000_4100, DELIVERING), Some(0));
    // Section 2.2: error code 7 is an error reply, whose values mean nothing.
    assert_eq!(show(0x1E83_F000, 0x43FA_0000_4060_0000, VOLTAGE), None);
    // The reply to a set-point repeats it. It is no measured voltage.
    assert_eq!(show(0x029C_F000, 0x0003_0D31_0000_1388, VOLTAGE), None);
}

#[test]
fn gcp_is_set_and_read_by_the_frames_of_its_document() {
    let set = sets::<gcp::Message>;
    let module = <gcp::Message as Addressed>::module(1).expect("module 1");
    assert_eq!(module, gcp::Target::Module(1));
    // Section 4.3, then 3.3: 0 is on and 1 is off.
    let output = [(VOLTAGE, 750_000), (CURRENT, 15_000), (DELIVERING, 1)];
    let expected = [frame(0x029C_3FF0, 0x000B_71B0_0000_3A98), frame(0x029A_3FF0, 0)];
    assert_eq!(set(gcp::Target::Broadcast, &output), Ok(expected.to_vec()));
    assert_eq!(set(module, &[(DELIVERING, 0)]), Ok(vec![frame(0x029A_01F0, 0x0100_0000_0000_0000)]));
    let show = shown::<gcp::Message>;
    assert_eq!(show(0x0283_F000, 0x43FA_0000_4060_0000, VOLTAGE), Some(500_000));
    assert_eq!(show(0x0283_F000, 0x43FA_0000_4060_0000, CURRENT), Some(3500));
    let status = |quantity| show(0x0284_F001, 0x0000_0200_1B00_4000, quantity);
    assert_eq!([Quantity::GROUP, Quantity::TEMPERATURE, DELIVERING].map(status), [Some(2), Some(27_000), Some(1)]);
    // Section 3.3, table of status 1: bit 0 is 1 if the DC side is off.
    assert_eq!(show(0x0284_F001, 0x0000_0200_1B00_4100, DELIVERING), Some(0));
}

#[test]
fn mxr_is_set_and_read_by_the_frames_of_its_document() {
    let set = sets::<mxr::Message>;
    let module = <mxr::Message as Addressed>::module(1).expect("module 1");
    // Section 2.3.1: 700 V, start up, shut down. Section 3.1: 10 A are 0x2800.
    let output = [(VOLTAGE, 700_000), (CURRENT, 10_000), (DELIVERING, 1)];
    let expected =
        [0x0300_0021_442F_0000, 0x0300_001B_0000_2800, 0x0300_0030_0000_0000].map(|data| frame(0x0608_0F80, data));
    assert_eq!(set(module, &output), Ok(expected.to_vec()));
    assert_eq!(set(module, &[(DELIVERING, 0)]), Ok(vec![frame(0x0608_0F80, 0x0300_0030_0001_0000)]));
    // Section 2.3.2.
    assert_eq!(reads::<mxr::Message>(module, &[VOLTAGE]), Ok(vec![frame(0x0608_0F80, 0x1000_0001_0000_0000)]));
    let show = shown::<mxr::Message>;
    assert_eq!(show(0x060F_8008, 0x41F0_0001_442F_0000, VOLTAGE), Some(700_000));
    assert_eq!(show(0x060F_8008, 0x42F0_0040_0000_0100, DELIVERING), Some(1));
    // Section 3.2: bit 22 is 1 if the DC/DC side is off.
    assert_eq!(show(0x060F_8008, 0x42F0_0040_0040_0000, DELIVERING), Some(0));
}

#[test]
fn megmeet_is_set_and_read_by_the_frames_of_its_document() {
    let set = sets::<megmeet::Message>;
    let module = <megmeet::Message as Addressed>::module(1).expect("module 1");
    // Sections 3.1 and 3.2: 53.5 V for all modules, and for module 1.
    assert_eq!(
        set(megmeet::Target::Broadcast, &[(VOLTAGE, 53_500)]),
        Ok(vec![frame(0x1080_80FE, 0x0100_0000_0000_D600)])
    );
    assert_eq!(set(module, &[(VOLTAGE, 53_500)]), Ok(vec![frame(0x1081_80FE, 0x0100_0000_0000_D600)]));
    // Section 2.2.2: signal 0x132 is 0 for on and 1 for off, of type V, whose value is byte 3 (2.2.3).
    assert_eq!(set(module, &[(DELIVERING, 1)]), Ok(vec![frame(0x1081_80FE, 0x0132_0000_0000_0000)]));
    assert_eq!(set(module, &[(DELIVERING, 0)]), Ok(vec![frame(0x1081_80FE, 0x0132_0001_0000_0000)]));
    assert_eq!(set(module, &[(CURRENT, 5000)]), Err(Error::NotSet { quantity: "output_current" }));
    let show = shown::<megmeet::Message>;
    // Section 2.2.2: a module of 100 A has 0x2710 as its rated current. Section 3.1: 53.5 V are 0xD600.
    assert_eq!(show(0x1081_827E, 0x0188_2710_0000_0000, Quantity::RATED_CURRENT), Some(100_000));
    assert_eq!(show(0x1081_827E, 0x0175_0000_0000_D600, VOLTAGE), Some(53_500));
    // Section 2.2.3: bit 9 is 1 while the module is shut down.
    assert_eq!(show(0x1081_827E, 0x0183_0000_0000_0200, DELIVERING), Some(0));
    assert_eq!(show(0x1081_827E, 0x0183_0000_0000_0000, DELIVERING), Some(1));
}

#[test]
fn trio_is_set_by_one_frame_and_read_by_the_reports_of_its_document() {
    let set = sets::<trio::Message>;
    let module = <trio::Message as Addressed>::module(0xE6).expect("module 7");
    // Section 3.3, 0x10: remote mode, on, 48 V.
    assert_eq!(set(module, &[(DELIVERING, 1), (VOLTAGE, 48_000)]), Ok(vec![frame(0x1810_E6F3, 0x0180_01E0_0000_0000)]));
    let missing = Error::NotGiven { message: "control", quantity: "delivering" };
    assert_eq!(set(module, &[(VOLTAGE, 48_000)]), Err(missing));
    assert_eq!(missing.to_string(), "`control` sets `delivering` too, which has no value");
    assert_eq!(reads::<trio::Message>(module, &[VOLTAGE, DELIVERING]), Ok(vec![]), "modules report them by themselves");
    let show = shown::<trio::Message>;
    // Section 3.3, 0x20: operation off, 23.5 to 29.8 V. 0x21: 0.1 V, 0.2 A, 0 W. 0x22: -10 °C.
    let reference = |quantity| show(0x1820_F3E2, 0x0000_00F0_012A_00EB, quantity);
    let wanted = [DELIVERING, Quantity::MINIMUM_VOLTAGE, Quantity::MAXIMUM_VOLTAGE];
    assert_eq!(wanted.map(reference), [Some(0), Some(23_500), Some(29_800)]);
    assert_eq!(show(0x1820_F3E2, 0x0080_00F0_012A_00EB, DELIVERING), Some(1), "0x80 is on");
    assert_eq!(show(0x1820_F3E2, 0x0001_00F0_012A_00EB, DELIVERING), None, "no state is 1");
    let output = |quantity| show(0x1821_F3E4, 0x0001_0002_0000_0008, quantity);
    assert_eq!([VOLTAGE, CURRENT, Quantity::OUTPUT_POWER].map(output), [Some(100), Some(200), Some(0)]);
    assert_eq!(show(0x1822_F3E1, 0xFFF6_0BB8_0CCE_0000, Quantity::TEMPERATURE), Some(-10_000));
}

#[test]
fn huawei_and_daly_are_set_and_read_by_the_frames_of_their_examples() {
    let module = <huawei::Message as Addressed>::module(1).expect("unit 1");
    // Section 7.1: 0x132 with 1 is standby, and with 0 on.
    let set = sets::<huawei::Message>;
    assert_eq!(set(module, &[(VOLTAGE, 51_000)]), Ok(vec![frame(0x1081_80FE, 0x0100_0000_0000_CC00)]));
    assert_eq!(set(module, &[(DELIVERING, 0)]), Ok(vec![frame(0x1081_80FE, 0x0132_0001_0000_0000)]));
    assert_eq!(set(module, &[(DELIVERING, 1)]), Ok(vec![frame(0x1081_80FE, 0x0132_0000_0000_0000)]));
    assert_eq!(shown::<huawei::Message>(0x1082_827E, 0x0175_0000_0000_D000, VOLTAGE), Some(52_000));
    // Section 9.2 and P35: active is giving voltage, which a PSU in standby does not.
    let state = |data| shown::<huawei::Message>(0x1081_11FE, data, DELIVERING);
    assert_eq!([0x0003_0000_0001_0000, 0x0003_0000_0000_0000].map(state), [Some(1), Some(0)]);
    // Section 8.1, D03.
    let pack = |quantity| shown::<daly::Message>(0x1890_4001, 0x0200_01FF_7431_01D9, quantity);
    let wanted = [Quantity::BATTERY_VOLTAGE, Quantity::BATTERY_CURRENT, Quantity::STATE_OF_CHARGE];
    assert_eq!(wanted.map(pack), [Some(51_200), Some(-25_500), Some(47_300)]);
}

#[test]
fn a_request_reads_all_quantities_of_its_message() {
    let wanted = [VOLTAGE, CURRENT, DELIVERING, AMBIENT];
    let infy = reads::<infy::Message>(infy::Target::Module(0), &wanted).expect("three of them in one mode");
    assert_eq!(infy, [frame(0x0283_00F0, 0), frame(0x0284_00F0, 0)]);
    let mxr = reads::<mxr::Message>(mxr::Target::Module(1), &wanted).expect("all of them");
    let registers = mxr.iter().map(|frame| frame.bytes()[3]);
    assert_eq!(registers.collect::<Vec<_>>(), [0x01, 0x02, 0x40, 0x0B]);
    let unknown = reads::<infy::Message>(infy::Target::Module(0), &[VOLTAGE, Quantity::new("humidity")]);
    assert_eq!(unknown, Err(Error::NotRead { quantity: "humidity" }));
    let mode = reads::<infy::Message>(infy::Target::Broadcast, &wanted);
    assert!(matches!(mode, Err(Error::Mode { message: "module_output", .. })), "{mode:?}");
}

#[test]
fn what_a_request_sets_and_its_reply_says_is_shown() {
    fn setting<P: Quantities>(id: u32, data: u64) -> [Option<i32>; 3] {
        let received = Received::<P>::decode(&frame(id, data)).expect("a frame of the document");
        [VOLTAGE, CURRENT, DELIVERING].map(|quantity| received.setting(quantity))
    }
    let infy = setting::<infy::Message>;
    // Section 2.4, 0x1C and 0x1A: the module says 199.985 V to 200 V.
    assert_eq!(infy(0x029C_00F0, 0x0003_0D40_0000_1388), [Some(200_000), Some(5000), None]);
    assert_eq!(infy(0x029C_F000, 0x0003_0D31_0000_1388), [Some(199_985), Some(5000), None]);
    assert_eq!(infy(0x029A_3FF0, 0x0100_0000_0000_0000), [None, None, Some(0)]);
    assert_eq!(infy(0x029A_F000, 0), [None, None, Some(1)]);
    assert_eq!(infy(0x029A_F000, 0x0200_0000_0000_0000), [None; 3], "2 is no state of the switch");
    assert_eq!(infy(0x1E9A_F000, 0x0100_0000_0000_0000), [None; 3], "it is an error reply");
    assert_eq!(infy(0x0283_F000, 0x43FA_0000_4060_0000), [None; 3], "it is read, not set");
    let mxr = setting::<mxr::Message>;
    // Section 2.3.1.
    assert_eq!(mxr(0x0608_0F80, 0x0300_0021_442F_0000), [Some(700_000), None, None]);
    assert_eq!(mxr(0x0608_0F80, 0x0300_0030_0001_0000), [None, None, Some(0)]);
}

#[test]
fn an_echo_confirms_what_was_asked_within_a_tolerance() {
    fn confirms<P: Quantities>(asked: (u32, u64), said: (u32, u64), tolerance: u32) -> bool {
        let [asked, said] = [asked, said].map(|(id, data)| Received::<P>::decode(&frame(id, data)).expect("printed"));
        said.confirms(&asked, tolerance)
    }
    let infy = confirms::<infy::Message>;
    // Section 2.4, 0x1C: the module says 199.985 V to 200 V.
    let (asked, said) = ((0x029C_00F0, 0x0003_0D40_0000_1388), (0x029C_F000, 0x0003_0D31_0000_1388));
    assert_eq!([14, 15, 16].map(|tolerance| infy(asked, said, tolerance)), [false, true, true]);
    assert!(!infy(asked, (0x029C_F000, 0x0003_0D40_0000_1770), 999), "6 A, not 5 A");
    assert!(!infy(asked, asked, 100), "it is no reply");
    assert!(!infy(said, said, 100), "it is no request");
    assert!(!infy(asked, (0x029C_F001, 0x0003_0D40_0000_1388), 100), "it is another module");
    assert!(infy((0x029C_3FF0, asked.1), said, 15), "one of all modules");
    assert!(!infy(asked, (0x1E9C_F000, 0x0003_0D40_0000_1388), 100), "it is an error reply");
    // A switch has no tolerance, and what only reads confirms nothing.
    let (off, on) = (0x0100_0000_0000_0000, 0);
    assert_eq!([off, on].map(|said| infy((0x029A_00F0, off), (0x029A_F000, said), 9999)), [true, false]);
    assert!(!infy((0x0283_00F0, 0), (0x0283_F000, 0x43FA_0000_4060_0000), 100));
}

/// A module that has been told something, and says nothing of its own.
fn told<P: Quantities + Addressed<Target: PartialEq>>(told: &[(u32, u64)]) -> (Keeper<P, 4>, Vec<Answer<P>>) {
    let mut module = Keeper::new(|_, _| Answer::Silence);
    let requests = told.iter().map(|(id, data)| Received::decode(&frame(*id, *data)).expect("a request"));
    let answers = requests.map(|request| module.answer(&request, 0)).collect();
    (module, answers)
}

#[test]
fn a_simulated_module_does_with_a_value_out_of_range_what_its_document_says() {
    let set = |millivolts: u64, milliamperes: u64| (0x029C_00F0, millivolts << 32 | milliamperes);
    // Section 3.3 of INFY: a voltage is ignored, and too high a current is limited. No model has more than 50 A.
    let (module, answers) = told::<infy::Message>(&[set(500_000, 10_000), set(5_000_000, 60_000)]);
    assert_eq!([VOLTAGE, CURRENT].map(|quantity| module.value(quantity)), [Some(500_000), Some(50_000)]);
    assert!(matches!(answers[..], [Answer::Values(_), Answer::Silence]));
    // Section 7.3 of the document of Huawei: it is refused. 51 V, then 60 V.
    let (module, answers) =
        told::<huawei::Message>(&[(0x1081_80FE, 0x0100_0000_0000_CC00), (0x1081_80FE, 0x0100_0000_0000_F000)]);
    assert_eq!(module.value(VOLTAGE), Some(51_000));
    assert!(matches!(answers[..], [Answer::Values(_), Answer::Silence]));
}

#[test]
fn a_simulated_module_forgets_without_power_what_its_document_does_not_keep() {
    let after_restart = |mut module: Keeper<infy::Message, 4>| {
        module.power_on(0);
        [VOLTAGE, Quantity::GROUP].map(|quantity| module.value(quantity))
    };
    let (module, _) = told(&[(0x029C_00F0, 0x0007_A120_0000_2710), (0x0296_00F0, 0x0500_0000_0000_0000)]);
    assert_eq!([VOLTAGE, Quantity::GROUP].map(|quantity| module.value(quantity)), [Some(500_000), Some(5)]);
    assert_eq!(after_restart(module), [None; 2]);
    // Section 4 of Maxwell: the group is stored.
    let (mut module, _) =
        told::<mxr::Message>(&[(0x0608_0F80, 0x0300_0021_442F_0000), (0x0608_0F80, 0x0300_001E_0000_0005)]);
    module.power_on(0);
    assert_eq!([VOLTAGE, Quantity::GROUP].map(|quantity| module.value(quantity)), [None, Some(5)]);
}

/// Module 2 of INFY, what it is to do, and the program that tells it.
struct Told {
    client: Client<infy::Message, 8>,
    duty: Duty,
    now: u32,
}

impl Told {
    fn hold(&mut self, values: &[(Quantity, i32)]) {
        let requests = infy::Message::set(values, infy::Target::Module(2)).expect("it is legal");
        let agrees = |asked: &infy::Received, said: &infy::Received| said.confirms(asked, 0);
        self.duty.hold(&mut self.client, requests, 1000, agrees, self.now).expect("there is room");
    }

    /// Returns the next frame that is sent.
    fn sent(&mut self) -> Frame {
        loop {
            match self.client.poll(self.now) {
                Step::Send { frame, .. } => return frame,
                Step::Wait(until) => self.now = until.expect("there is something to do"),
                Step::Lost(_)
                | Step::Done(_)
                | Step::Missing { .. }
                | Step::Silent(_)
                | Step::Back(_)
                | Step::ClockBack(_) => {}
            }
        }
    }

    /// Takes a reply. Returns whether it confirms what is held, and what is known of the output.
    fn hears(&mut self, id: u32, data: u64) -> (bool, Output) {
        let Heard::Answer { ticket, received } = self.client.handle(&frame(id, data), self.now) else {
            panic!("it is asked")
        };
        (self.duty.answered(ticket, &received), self.duty.output())
    }

    /// Asks whether the module is on, and takes its reply. Bit 0 of byte 6 is set while it is off.
    fn reads(&mut self, is_off: bool) -> Output {
        let request: Request<_, _> = infy::ModuleStatus::read(infy::Target::Module(2)).expect("a module");
        self.client.ask(request, self.now).expect("there is room");
        while self.sent() != *request.frame() {}
        self.hears(0x0284_F002, if is_off { 0x0100 } else { 0 }).1
    }
}

#[test]
fn a_module_is_off_only_if_it_says_so_after_it_has_confirmed_that() {
    let client = Client::new(Pace { gap: 50, wait: 100, tries: 2, late: 0 });
    let mut told = Told { client, duty: Duty::new(2), now: 0 };
    assert_eq!(told.duty.output(), Output::Unknown);
    // It was told nothing.
    assert_eq!([true, false].map(|is_off| told.reads(is_off)), [Output::Off, Output::On]);
    told.hold(&[(VOLTAGE, 500_000), (CURRENT, 10_000), (DELIVERING, 1)]);
    let set_point = frame(0x029C_02F0, 0x0007_A120_0000_2710);
    assert_eq!(told.sent(), set_point);
    assert_eq!(told.hears(0x029C_F002, 0x0007_A120_0000_2710), (false, Output::Unknown));
    assert_eq!(told.sent(), frame(0x029A_02F0, 0));
    assert_eq!(told.hears(0x029A_F002, 0), (true, Output::Unknown));
    assert_eq!(told.reads(false), Output::On);
    told.duty.end(&mut told.client);
    assert_eq!(told.duty.output(), Output::Unknown);
    told.hold(&[(DELIVERING, 0)]);
    // What was held is not renewed. A module that is off, and has not confirmed it, can still be switched on.
    let off = 0x0100_0000_0000_0000;
    assert_eq!([told.sent(), told.sent()], [frame(0x029A_02F0, off); 2]);
    assert_eq!([true, false].map(|is_off| told.reads(is_off)), [Output::Unknown, Output::On]);
    while told.sent() != frame(0x029A_02F0, off) {}
    assert_eq!(told.hears(0x029A_F002, off), (true, Output::On));
    assert_eq!(told.reads(true), Output::Off);
    told.duty.forget();
    assert_eq!([told.duty.output(), told.reads(true)], [Output::Unknown; 2]);
}

#[test]
fn what_was_confirmed_counts_no_more_once_something_else_is_held() {
    let client = Client::new(Pace { gap: 50, wait: 100, tries: 2, late: 0 });
    let mut told = Told { client, duty: Duty::new(2), now: 0 };
    let (on, off) = (0, 0x0100_0000_0000_0000);
    told.hold(&[(DELIVERING, 1)]);
    assert_eq!(told.sent(), frame(0x029A_02F0, on));
    assert_eq!(told.hears(0x029A_F002, on), (true, Output::Unknown));
    // The same again changes nothing.
    assert_eq!(told.reads(false), Output::On);
    told.hold(&[(DELIVERING, 1)]);
    assert_eq!(told.duty.output(), Output::On);
    told.hold(&[(DELIVERING, 0)]);
    // Its reading is from before the switch-off.
    assert_eq!([told.duty.output(), told.reads(true)], [Output::Unknown; 2]);
    while told.sent() != frame(0x029A_02F0, off) {}
    assert_eq!(told.hears(0x029A_F002, off), (true, Output::Unknown));
    assert_eq!(told.reads(true), Output::Off);
}

#[test]
fn an_output_is_switched_on_after_its_set_points_only() {
    let (early, set) = (Err(Error::TooEarly { quantity: "delivering" }), sets::<mxr::Message>);
    let module = mxr::Target::Module(1);
    let (volts, amperes) = ((VOLTAGE, 700_000), (CURRENT, 10_000));
    assert_eq!(set(module, &[(DELIVERING, 1), volts]), early);
    assert_eq!(set(module, &[volts, (DELIVERING, 1), amperes]), early);
    assert_eq!(set(module, &[(DELIVERING, 0), volts]).map(|frames| frames.len()), Ok(2));
    // In INFY, voltage and current travel in one frame.
    let infy = sets::<infy::Message>;
    let module = infy::Target::Module(0);
    assert_eq!(infy(module, &[(VOLTAGE, 500_000), (DELIVERING, 1), (CURRENT, 10_000)]), early);
    let off = [(VOLTAGE, 500_000), (DELIVERING, 0), (CURRENT, 10_000)];
    let ids = infy(module, &off).map(|frames| frames.iter().map(Frame::raw_id).collect::<Vec<_>>());
    assert_eq!(ids, Ok(vec![0x029A_00F0, 0x029C_00F0]));
}

#[test]
fn nothing_is_sent_if_one_value_is_refused() {
    let set = sets::<infy::Message>;
    let module = infy::Target::Module(0);
    assert_eq!(set(module, &[(DELIVERING, 1), (DELIVERING, 0)]), Err(Error::SetTwice { quantity: "delivering" }));
    let output = [(VOLTAGE, 300_000), (CURRENT, 10_000)];
    assert_eq!(
        set(module, &[&output[..], &[(DELIVERING, 2)]].concat()),
        Err(Error::State { quantity: "delivering", value: 2 })
    );
    let unknown = [&output[..], &[(Quantity::TEMPERATURE, 0)]].concat();
    assert_eq!(set(module, &unknown), Err(Error::NotSet { quantity: "temperature" }));
    // Of all models in section 3.3, none takes more than 750 V.
    let refused = set(module, &[(VOLTAGE, 750_001), (CURRENT, 10_000)]).expect_err("too high");
    assert_eq!(refused.to_string(), "`voltage` of `set_module_output` is 750.001 V, but its limits are 50 and 750 V");
    assert!(set(module, &[(VOLTAGE, 750_000), (CURRENT, 10_000)]).is_ok());
    let refused = set(infy::Target::Module(0x3C), &output).expect_err("no such module");
    assert!(matches!(refused, Error::Address { number: 0x3C, .. }), "{refused:?}");
}

#[test]
fn a_model_has_limits_of_its_own() {
    // Section 3.3: a REG50040 takes 100 to 550 V, and up to 35 A.
    let set = |voltage| {
        let values = [(VOLTAGE, voltage), (CURRENT, 35_000)];
        let requests = infy::Message::set_within(infy::Model::Reg50040, &values, infy::Target::Module(0));
        requests.map(Iterator::count)
    };
    assert_eq!([100_000, 550_000].map(set), [Ok(1), Ok(1)]);
    assert!([99_999, 550_001].map(set).iter().all(Result::is_err));
}

#[test]
fn every_build_reads_and_sets_the_same() {
    let wanted = [VOLTAGE, CURRENT, Quantity::TEMPERATURE, Quantity::GROUP];
    let voltage = Quantity::new("voltage_setting");
    // 1/1024 V is 0.9765625 mV, so raw 1025 is 1000.9765625 mV. The float is 3.1415927 A.
    let replies = [
        (0x0401_8207_4049_0FDB, [Some(1001), Some(3142), Some(25_000), Some(7)]),
        (0x0200_FE00_C0A0_0000, [Some(500), Some(-5000), None, Some(0)]),
        (0x0000_FFFF_7F80_0000, [Some(0), None, None, Some(255)]),
        (0xFFFF_0001_4F00_0000, [Some(63_999), None, Some(-40_000), Some(1)]),
        (0x0001_FDFF_8000_0000, [Some(1), Some(0), Some(86_500), Some(255)]),
    ];
    for (data, expected) in replies {
        assert_eq!(wanted.map(|quantity| shown::<feature::Message>(0x411, data, quantity)), expected, "{data:X}");
        assert_eq!(wanted.map(|quantity| shown::<in_f32::Message>(0x411, data, quantity)), expected, "{data:X}");
        assert_eq!(wanted.map(|quantity| shown::<in_steps::Message>(0x411, data, quantity)), expected, "{data:X}");
    }
    // The reply to a setting carries no values, though that to a read of the same message does.
    assert_eq!(shown::<feature::Message>(0x631, 0, voltage), None);
    let empty = Received::<feature::Message>::decode(&frame(0x631, 0)).expect("a reply to a setting");
    assert_eq!([VOLTAGE, CURRENT, DELIVERING].map(|quantity| empty.setting(quantity)), [None; 3]);
    assert_eq!(shown::<feature::Message>(0x431, 0x0000_0FA0_4128_0000, voltage), Some(400_000));
    assert_eq!(shown::<feature::Message>(0x421, 0x2000_0000_0000_0000, DELIVERING), Some(0));
    assert_eq!(shown::<feature::Message>(0x421, 0x1F00_0000_0000_0000, DELIVERING), Some(1));
    assert_eq!(shown::<feature::Message>(0x231, 0x0100_0FA0_4128_0000, voltage), None, "a request");

    // The limits are 10 and 500.06 V. So 5000 steps are legal, and nothing beyond them.
    for (millivolts, raw) in
        [(400_000, Some(4000)), (399_949, Some(3999)), (399_950, Some(4000)), (399_951, Some(4000))]
            .into_iter()
            .chain([(10_000, Some(100)), (9_999, None), (500_000, Some(5000)), (500_001, None), (500_060, None)])
    {
        let data = raw.map(|raw: u64| frame(0x231, 0x0101_0000_4128_0000 | raw << 32));
        let values = [(VOLTAGE, millivolts), (CURRENT, 10_500), (DELIVERING, 0)];
        let first = |frames: Result<Vec<Frame>, Error>| frames.ok().map(|frames| frames[0]);
        assert_eq!(first(sets::<feature::Message>(feature::Target::Unit(1), &values)), data, "{millivolts}");
        assert_eq!(first(sets::<in_f32::Message>(in_f32::Target::Unit(1), &values)), data, "{millivolts}");
        assert_eq!(first(sets::<in_steps::Message>(in_steps::Target::Unit(1), &values)), data, "{millivolts}");
    }
    // 12.1 A is no float. The nearest one, 0x4141999A, is legal.
    for (milliamperes, bits) in
        [(12_100, Some(0x4141_999A)), (12_101, None), (-1, None), (0, Some(0)), (1, Some(0x3A83_126F))]
    {
        let data = bits.map(|bits: u64| frame(0x231, 0x0100_0064_0000_0000 | bits));
        let values = [(VOLTAGE, 10_000), (CURRENT, milliamperes), (DELIVERING, 1)];
        let first = |frames: Result<Vec<Frame>, Error>| frames.ok().map(|frames| frames[0]);
        assert_eq!(first(sets::<feature::Message>(feature::Target::Unit(1), &values)), data, "{milliamperes}");
        assert_eq!(first(sets::<in_f32::Message>(in_f32::Target::Unit(1), &values)), data, "{milliamperes}");
        assert_eq!(first(sets::<in_steps::Message>(in_steps::Target::Unit(1), &values)), data, "{milliamperes}");
    }
}

#[test]
fn a_shipped_protocol_in_whole_steps_sets_the_same() {
    let values = [(VOLTAGE, 500_001), (CURRENT, 15_001)];
    let expected = Ok(vec![frame(0x029C_00F0, 0x0007_A121_0000_3A99)]);
    assert_eq!(sets::<infy::Message>(infy::Target::Module(0), &values), expected);
    assert_eq!(sets::<infy_in_steps::Message>(infy_in_steps::Target::Module(0), &values), expected);
}

#[test]
fn a_module_of_a_number_is_the_target_that_its_frames_show() {
    assert_eq!(<trio::Message as Addressed>::module(0xE6), Some(trio::Target::Module(0xE6)));
    assert_eq!(<trio::Message as Addressed>::module(256), None, "no byte holds it");
    assert_eq!(<trio::Message as Addressed>::module(-1), None);
    let received = trio::Message::decode(&frame(0x1821_F3E4, 0)).expect("a report");
    assert_eq!(received.node().and_then(<trio::Message as Addressed>::module), received.target());
}

#[test]
fn a_report_of_the_controller_sets_what_it_carries() {
    let [delivered, demanded] = ["delivered_voltage", "demanded_voltage"].map(Quantity::new);
    let set = |voltage| sets::<charging::Message>(charging::Target::ToVehicle, &[(delivered, voltage)]);
    let report = |id, voltage: u32| Frame::new_raw(id, false, (u64::from(voltage) << 48).to_be_bytes(), 4);
    // 4000 steps of 0.1 V, and a limit of 1000 V.
    assert_eq!(set(400_000), Ok(vec![report(0x101, 4000)]));
    assert!(set(1_000_100).is_err_and(|error| matches!(error.reason(), Some(Reason::Limits { .. }))));
    let shown = |id, quantity| {
        let received = charging::Message::decode(&report(id, 4000)).expect("a report");
        [received.setting(quantity), received.quantity(quantity)]
    };
    assert_eq!(shown(0x101, delivered), [Some(400_000), None]);
    assert_eq!(shown(0x081, demanded), [None, Some(400_000)]);
    assert_eq!(shown(0x081, delivered), [None, None], "the vehicle sends it");
}
