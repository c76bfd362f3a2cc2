//! Requests of the generated code: the frames of the document, whom they address, and which frames answer them.

use canspec_protocols::infy::{
    Barcode, Error, ErrorCode, Failure, Frame, Identifier, Message, ModuleOutput, ModuleStatus, Power, Problem,
    Received, Replies, Reply, Request, SetModuleOutput, SetTotalOutput, Status0, Status1, Status2, SwitchModules,
    SystemOutput, Target, embedded_can::Frame as _,
};

/// Returns a frame as the document prints it.
fn frame(id: u32, data: u64) -> Frame {
    Frame::new_raw(id, true, data.to_be_bytes(), 8)
}

const OUTPUT: SetModuleOutput = SetModuleOutput { voltage_v: 750.0, current_a: 15.0 };

#[test]
fn a_set_point_for_all_modules_is_the_frame_of_the_document_and_nobody_answers() {
    let request = OUTPUT.set(Target::Broadcast).expect("0x1C can be broadcast");
    assert_eq!(request.frame(), &frame(0x029C_3FF0, 0x000B_71B0_0000_3A98));
    assert_eq!(request.replies(), Replies::Nobody);
}

#[test]
fn one_module_answers_a_set_point_with_the_values_in_effect() {
    let output = SetModuleOutput { voltage_v: 200.0, current_a: 5.0 };
    let request = output.set(Target::Module(0)).expect("0x1C can go to one module");
    assert_eq!(request.frame(), &frame(0x029C_00F0, 0x0003_0D40_0000_1388));
    let reply = request.reply(&frame(0x029C_F000, 0x0003_0D31_0000_1388)).expect("the reply of module 0");
    assert_eq!(reply.values, Ok(SetModuleOutput { voltage_v: 199.985, current_a: 5.0 }));
    assert!(!request.is_reply(&frame(0x029C_F001, 0x0003_0D31_0000_1388)), "that is module 1");
    assert!(!request.is_reply(&frame(0x0289_F000, 0x0003_0D31_0000_1388)), "that is another command");
    assert!(!request.is_reply(request.frame()), "that is the request");
}

#[test]
fn each_module_of_a_group_answers() {
    let request = OUTPUT.set(Target::Group(2)).expect("0x1C can go to a group");
    assert_eq!(request.frame().raw_id(), 0x02DC_02F0);
    assert!(matches!(request.replies(), Replies::Each(_)));
    assert!(request.is_reply(&frame(0x02DC_F000, 0)) && request.is_reply(&frame(0x02DC_F03B, 0)));
    assert!(!request.is_reply(&frame(0x029C_F000, 0)), "that answers a request to one module");
    assert!(!request.is_reply(&frame(0x02DC_F0F1, 0)), "that is another controller");
    let source = |id| request.reply(&frame(id, 0)).map(|reply| reply.identifier().source);
    assert_eq!([source(0x02DC_F000), source(0x02DC_F03B)], [Some(0x00), Some(0x3B)]);
}

#[test]
fn a_coordinator_answers_for_the_system_and_for_a_group() {
    let system = SystemOutput::read_total(Target::Broadcast).expect("0x01 can be broadcast");
    assert_eq!(system.frame(), &frame(0x0281_3FF0, 0));
    let output = system.reply(&frame(0x0281_F03F, 0x43FA_0000_4248_0000)).expect("the coordinator's reply");
    assert_eq!(output.values, Ok(SystemOutput { voltage_v: 500.0, current_a: 50.0 }));
    let group = SystemOutput::read_total(Target::Group(1)).expect("0x01 can go to a group");
    assert!(group.is_reply(&frame(0x02C1_F001, 0)) && !group.is_reply(&frame(0x02C1_F002, 0)));
}

#[test]
fn all_groups_take_only_totals_and_the_switch() {
    let off = SwitchModules { power: Power::Off }.set(Target::AllGroups).expect("0x1A can go to all groups");
    assert_eq!(off.frame(), &frame(0x02DA_3FF0, 0x0100_0000_0000_0000));
    let total = SetTotalOutput { voltage_v: 300.0, current_a: 10.0 };
    assert_eq!(total.set_total(Target::AllGroups).expect("0x1B can go to all groups").frame().raw_id(), 0x02DB_3FF0);
    assert!(matches!(OUTPUT.set(Target::AllGroups), Err(Error::Mode { .. })));
    assert!(matches!(ModuleOutput::read(Target::AllGroups), Err(Error::Mode { .. })));
    assert!(matches!(ModuleOutput::read(Target::Broadcast), Err(Error::Mode { .. })));
    assert!(matches!(total.set_total(Target::Module(0)), Err(Error::Mode { .. })));
}

#[test]
fn addresses_outside_the_document_are_refused() {
    assert!(ModuleOutput::read(Target::Module(0x3B)).is_ok());
    for number in [0x3C, 0x3F, 0xF0, 0xFF] {
        assert!(matches!(ModuleOutput::read(Target::Module(number)), Err(Error::Address { .. })), "{number:#X}");
    }
    let other = ModuleOutput::read(Target::Module(1).sent_by(0xF8)).expect("0xF8 is a controller");
    assert_eq!(other.frame().raw_id(), 0x0283_01F8);
    assert!(other.is_reply(&frame(0x0283_F801, 0)) && !other.is_reply(&frame(0x0283_F001, 0)));
    assert!(matches!(ModuleOutput::read(Target::Module(1).sent_by(0xF9)), Err(Error::Address { .. })));
}

#[test]
fn values_that_do_not_fit_are_refused_with_all_that_one_needs_to_know() {
    let output = SetModuleOutput { voltage_v: 5e6, current_a: 15.0 };
    let text = output.set(Target::Module(0)).expect_err("no model gives more than 750 V").to_string();
    for part in ["set_module_output", "voltage", "5000000", "V", "50 and 750"] {
        assert!(text.contains(part), "{part:?} is not in {text:?}");
    }
    for voltage_v in [f64::NAN, f64::INFINITY, -0.001] {
        assert!(SetModuleOutput { voltage_v, current_a: 0.0 }.set(Target::Module(0)).is_err(), "{voltage_v}");
    }
}

#[test]
fn an_error_reply_answers_the_request_but_carries_no_values() {
    let request: Request<SetModuleOutput> = OUTPUT.set(Target::Module(0)).expect("0x1C can go to one module");
    for length in [8, 0] {
        let refused = Frame::new_raw(0x0E9C_F000, true, 0x000B_71B0_0000_3A98_u64.to_be_bytes(), length);
        let reply: Reply<SetModuleOutput> = request.reply(&refused).expect("the refusal of module 0");
        assert_eq!((reply.identifier().error, reply.values), (ErrorCode::DataInvalid, Err(Failure::Error)));
    }
    let short = Frame::new_raw(0x029C_F000, true, [0; 8], 7);
    assert_eq!(request.reply(&short).map(|reply| reply.values), Some(Err(Failure::Length)));
}

#[test]
fn neither_a_command_nor_an_error_reply_is_taken_for_the_values_in_effect() {
    let received = |id| Message::decode(&frame(id, 0x000B_71B0_0000_3A98)).expect("a frame of this protocol");
    let output = Message::SetModuleOutput(OUTPUT);
    let [command, echo, refused]: [Received; 3] = [0x029C_00F0, 0x029C_F000, 0x0E9C_F000].map(received);
    assert_eq!((command.request(), command.reply(), command.report()), (Some(&output), None, None));
    assert_eq!((echo.request(), echo.reply(), echo.report()), (None, Some(Ok(&output)), None));
    assert_eq!((refused.request(), refused.reply(), refused.report()), (None, Some(Err(Failure::Error)), None));
    assert_eq!((refused.content(), refused.identifier().error), (&output, ErrorCode::DataInvalid));
    assert!(refused.is_error_reply() && !echo.is_error_reply());
}

#[test]
fn a_status_keeps_the_bits_that_have_no_name() {
    let status = ModuleStatus::read(Target::Module(0)).expect("0x04 can go to one module");
    assert_eq!(status.frame(), &frame(0x0284_00F0, 0));
    let reply = status.reply(&frame(0x0284_F000, 0x0000_0200_1600_40C0)).expect("the reply of module 0");
    let reply = reply.values.expect("no error");
    assert_eq!((reply.group, reply.temperature_c), (2, 22));
    assert_eq!((reply.status_2, reply.status_1), (Status2(0), Status1::WALK_IN_ENABLED));
    assert_eq!(reply.status_0, Status0(0xC0));
    assert_eq!(reply.status_0.unknown(), 0xC0);
}

#[test]
fn a_barcode_reads_as_it_is_printed_on_the_housing() {
    let barcode = Barcode::read(Target::Module(0)).expect("0x0B can go to one module");
    let reply = barcode.reply(&frame(0x028B_F000, 0x5613_0C15_A3FB_06A8)).expect("the reply of module 0");
    let reply = reply.values.expect("no error");
    assert_eq!(reply.value.to_string(), "081807123451V1704");
}

#[test]
fn frames_of_others_are_told_apart() {
    let problem = |id| Message::decode(&frame(id, 0)).map(|_| ()).expect_err("none of ours");
    assert_eq!(problem(0x0757_F801), Problem::Foreign);
    assert_eq!(problem(0x0290_00F0), Problem::UnknownMessage);
    assert_eq!(problem(0x0283_0001), Problem::Identifier);
    let short = Frame::new_raw(0x0283_00F0, true, [0; 8], 7);
    assert_eq!(Message::decode(&short).map(|_| ()), Err(Problem::Length));
    let standard = Frame::new_raw(0x123, false, [0; 8], 8);
    assert_eq!(Message::decode(&standard).map(|_| ()), Err(Problem::Identifier));
}

#[test]
fn an_identifier_keeps_every_field() {
    let identifier = Identifier::from_raw(0x0E9C_F03F);
    assert_eq!((identifier.device, identifier.command), (0xA, 0x1C));
    assert_eq!((identifier.target, identifier.source), (0xF0, 0x3F));
    assert_eq!(identifier.to_raw(), 0x0E9C_F03F);
    assert!(Message::decode(&frame(0x0E9C_F03F, 0)).expect("a reply").frame().is_extended());
}

#[test]
fn faults_and_alarms_are_the_set_bits_of_all_status_words_by_severity() {
    let names = |id, length| {
        let frame = Frame::new_raw(id, true, [0, 0, 2, 0, 0x16, 0x0A, 0x52, 0x20], length);
        let received = Message::decode(&frame).expect("a frame of the protocol");
        let faults: Vec<_> = received.faults().map(|bit| bit.name).collect();
        let alarms: Vec<_> = received.alarms().map(|bit| bit.name).collect();
        (faults, alarms, received.conditions().count())
    };
    let faults = vec!["duplicate_id", "fault", "discharge_abnormal"];
    assert_eq!(names(0x0284_F000, 8), (faults, vec!["input_phase_lost", "overtemperature"], 6));
    assert_eq!(names(0x0E84_F000, 8), (vec![], vec![], 0), "an error reply has no values");
}
