//! Scaling in single precision, against exact integers; and which specs suit it.

use canspec_codegen::diagnostic::Diagnostics;
use canspec_codegen::emit::Scaled;
use canspec_codegen::{check, compile, source::Source};
use canspec_runtime::plumbing::{Integer, Scale};
use canspec_runtime::{Payload, Place, Signal};
use canspec_tests::features_limits_between_steps_switched as in_single_precision;
use canspec_tests::{features_limits_between_steps, features_limits_between_steps_in_steps};

/// physical = (raw × `step` + `start`) / `common`.
#[derive(Clone, Copy, Debug)]
struct Grid {
    step: i64,
    start: i64,
    common: i64,
}

impl Grid {
    fn scale(self) -> Scale {
        Scale::new(self.step, self.common).offset(self.start, self.common)
    }

    /// Tests whether no other single is nearer to the physical value, by integers alone.
    fn is_nearest(self, raw: i64, physical: f32) -> bool {
        let sum = i128::from(raw * self.step + self.start);
        let (mantissa, power) = taken_apart(physical);
        let error = mantissa * i128::from(self.common) - (sum << power);
        2 * error.abs() <= i128::from(self.common)
    }

    /// Returns the nearest raw value, ties away from zero, by integers alone.
    fn nearest_raw(self, physical: f32) -> i64 {
        let (mantissa, power) = taken_apart(physical);
        let above = mantissa * i128::from(self.common) - (i128::from(self.start) << power);
        let below = i128::from(self.step) << power;
        let magnitude = (2 * above.abs() + below.abs()) / (2 * below.abs());
        i64::try_from(magnitude * above.signum() * below.signum()).expect("a raw value")
    }
}

/// Returns m and n of m / 2ⁿ, where m has the 24 bits of a single unless it is 0.
fn taken_apart(value: f32) -> (i128, u32) {
    let (exponent, fraction) = (value.to_bits() >> 23 & 0xFF, value.to_bits() & 0x7F_FFFF);
    if value == 0.0 {
        return (0, 0);
    }
    assert!((1..=150).contains(&exponent), "{value} is normal and below 2^24");
    let mantissa = i128::from(fraction | 0x80_0000);
    (if value < 0.0 { -mantissa } else { mantissa }, 150 - exponent)
}

fn comes_back(grid: Grid, raw: i64) {
    let physical = grid.scale().physical_f32(raw);
    assert!(grid.is_nearest(raw, physical), "{grid:?}: {raw} is not {physical}");
    assert_eq!(grid.scale().raw_f32(physical), Some(raw), "{grid:?}: {physical}");
}

const GRIDS: [Grid; 10] = [
    Grid { step: 1, start: 0, common: 10 },
    Grid { step: 1, start: 0, common: 100 },
    Grid { step: 1, start: 0, common: 1000 },
    Grid { step: 1, start: 0, common: 1027 },
    Grid { step: 1, start: 0, common: 1024 },
    Grid { step: 1, start: -80, common: 2 },
    Grid { step: 1, start: -400, common: 10 },
    Grid { step: 7, start: 500, common: 30 },
    Grid { step: 10, start: 0, common: 1 },
    Grid { step: -1, start: 253, common: 3 },
];

#[test]
fn every_raw_value_of_16_bits_comes_back() {
    for grid in GRIDS {
        (-0x8000..=0xFFFF).for_each(|raw| comes_back(grid, raw));
    }
}

#[test]
fn raw_values_come_back_up_to_the_limit_of_the_rule() {
    let mut random = fastrand::Rng::with_seed(0xF32);
    for _ in 0..1_000_000 {
        let width = random.u32(1..24);
        let (common, step) = (random.i64(1..1 << width), random.i64(1..=16));
        let start = random.i64(-(1 << 21)..=1 << 21);
        let room = ((1 << 22) - 1 - start.abs()) / step;
        comes_back(Grid { step, start, common }, random.i64(-room..=room));
    }
}

#[test]
fn the_first_raw_value_that_is_lost_lies_beyond_the_limit_of_the_rule() {
    let grid = Grid { step: 1, start: 0, common: 1027 };
    ((1 << 22) - 4096..1 << 22).for_each(|raw| comes_back(grid, raw));
    assert_ne!(grid.scale().raw_f32(grid.scale().physical_f32(4_207_191)), Some(4_207_191));
}

#[test]
fn a_common_denominator_that_is_a_power_of_two_loses_nothing_below_2_to_the_24() {
    for common in [1, 2, 1024] {
        let grid = Grid { step: 1, start: 0, common };
        ((1 << 24) - 4096..1 << 24).chain((1 << 22..1 << 24).step_by(997)).for_each(|raw| comes_back(grid, raw));
    }
}

/// Returns `millivolts` as a person writes them in volts: the text decides the single, not an operation of ours.
fn volts(millivolts: u32) -> f32 {
    let text = format!("{}.{:03}", millivolts / 1000, millivolts % 1000);
    text.parse().expect("a decimal number")
}

#[test]
fn every_set_point_of_a_million_in_steps_of_a_millivolt_meets_its_own_raw_value() {
    const VOLTAGE: Signal<u32, f32> = Signal::new("voltage", Place::bytes(0, 3)).unit("V").scale(1, 1000);
    for millivolts in 0..=1_000_000 {
        let mut payload = Payload::new("message", [0; 8]);
        VOLTAGE.encode(volts(millivolts), &mut payload).expect("the value fits 32 bits");
        assert_eq!(payload.data()[..4], millivolts.to_be_bytes());
        assert_eq!(VOLTAGE.decode(payload.data()).to_bits(), volts(millivolts).to_bits());
    }
}

#[test]
fn ties_go_away_from_zero() {
    let millivolts = GRIDS[2];
    let half_tenths = GRIDS[0];
    for sixteenth in -12_000_i16..=12_000 {
        // An odd number of sixteenths of a volt lies between two millivolts, and of halves between two tenths or on one.
        let physical = f32::from(sixteenth) / 16.0;
        for grid in [millivolts, half_tenths] {
            assert_eq!(grid.scale().raw_f32(physical), Some(grid.nearest_raw(physical)), "{grid:?}: {physical}");
        }
    }
    assert_eq!([0.0625, -0.0625, 0.1875].map(|volts| millivolts.nearest_raw(volts)), [63, -63, 188]);
}

fn refusal<R: Integer>(signal: &'static Signal<R, f32>, physical: f32) -> String {
    let mut payload = Payload::within_limits("message", [0; 8]);
    signal.encode(physical, &mut payload).expect_err("a refusal").to_string()
}

#[test]
fn limits_and_special_values_are_singles() {
    const VOLTAGE: Signal<u16, f32> = Signal::new("voltage", Place::bytes(0, 1))
        .unit("V")
        .scale(1, 10)
        .limits(0.1, 25.7)
        .specials(&[(0xFFFF, "none")]);
    let mut payload = Payload::within_limits("message", [0; 8]);
    assert_eq!(VOLTAGE.encode(0.1, &mut payload), Ok(()));
    assert_eq!(VOLTAGE.encode(25.7, &mut payload), Ok(()));
    assert_eq!(VOLTAGE.encode(6553.5, &mut payload), Ok(()));
    assert_eq!(refusal(&VOLTAGE, 25.8), "`voltage` of `message` is 25.8 V, but its limits are 0.1 and 25.7 V");
    assert_eq!(refusal(&VOLTAGE, f32::NAN), "`voltage` of `message` is no finite number");
    let mut reply = Payload::new("message", [0; 8]);
    let wide = VOLTAGE.encode(6553.6, &mut reply).expect_err("a refusal").to_string();
    assert_eq!(wide, "`voltage` of `message` is 6553.6 V, but its limits are 0 and 6553.5 V");
}

/// Returns what is said in short of a spec with this field for code whose scaled values are `scaled`.
fn said(field: &str, scaled: Scaled) -> String {
    diagnostics(field, scaled).concise()
}

fn diagnostics(field: &str, scaled: Scaled) -> Diagnostics {
    let field = field.replacen('{', "{title: Level, ", 1);
    let spec = include_str!("../specs/rules/grid/good.yaml")
        .replace("in: [reply], ", "")
        .replace("      inside:  {bytes: 0..1, scale: 1/10, unit: °C}\n", "")
        .replace("      elapsed: {bytes: 2..7, unit: s}\n", &format!("      level: {field}\n"));
    let mut outcome = compile(Source::new("heater.yaml", spec.into()).expect("plain text"));
    if let Some(protocol) = &outcome.protocol {
        check::fits(protocol, scaled, &mut outcome.diagnostics);
    }
    outcome.diagnostics
}

#[test]
fn a_spec_that_does_not_suit_single_precision_is_refused_for_it() {
    for (field, why) in [
        ("{bytes: 0..3, scale: 1/1000}", "32 bits in steps of 0.001 are too many for a single, while 22 bits fit"),
        (
            "{bytes: 0..3, scale: 1/1000, range: 0..4194.304}",
            "raw values from 0 to 4194304 in steps of 0.001 are too many for a single, while 22 bits fit",
        ),
        (
            "{bytes: 0..3, scale: 1/1000, range: 0..750, values: {4194304: none}}",
            "raw values from 0 to 4194304 in steps of 0.001 are too many for a single, while 22 bits fit",
        ),
        ("{bytes: 0..3, scale: 1/1024}", "32 bits in steps of 1/1024 are too many for a single, while 24 bits fit"),
        ("{bytes: 0, scale: 1/16777217}", "steps of 1/16777217 from 0 on are too fine for a single"),
    ] {
        let said = said(field, Scaled::F32);
        assert!(said.ends_with(&format!("error[grid]: `temperature.level`: {why}")), "{field}: {said}");
    }
    let said = said("{bytes: 0..3, range: 0..16777216.5}", Scaled::F32);
    assert!(
        said.ends_with("the limits of `temperature.level` reach 2^24, beyond which a single misses integers"),
        "{said}"
    );
}

#[test]
fn what_single_precision_misses_is_compiled_in_whole_steps() {
    for field in ["{bytes: 0..3, scale: 1/1000}", "{bytes: 0..3, range: 0..16777216.5}"] {
        let shown = diagnostics(field, Scaled::F32).render(false);
        assert!(shown.contains("help: generate code in whole steps or with `f64`"), "{shown}");
        assert!(!said(field, Scaled::Steps).contains("error["), "{field}");
    }
}

#[test]
fn a_spec_that_suits_single_precision_is_not_refused_for_it() {
    for field in [
        "{bytes: 0..1, scale: 1/1000}",
        "{bytes: 0..3, scale: 1/1000, range: 0..4194.303}",
        "{bytes: 0..2, scale: 1/1024}",
        "{bytes: 0..2, scale: 1024}",
        "{bytes: 0..3, scale: 1/1024, range: 0..16384}",
        "{bytes: 0..3, scale: 1/1024, offset: -1024, range: 14336..15360}",
        "{bytes: 0..3, range: 0..16777217}",
        "{bytes: 0..3}",
    ] {
        let said = said(field, Scaled::F32);
        assert!(!said.contains("error["), "{field}: {said}");
    }
    let between_steps = "{bytes: 0..3, range: 0..8388607.5}";
    assert_eq!(said(between_steps, Scaled::F32), said(between_steps, Scaled::F64));
    assert_eq!(said("{bytes: 0..3, scale: 1/1000}", Scaled::F64), "");
}

/// The step of 1/1024 below 3604.47939453125 is raw 3690986, and the one above has the same nearest single.
#[test]
fn a_step_beyond_a_limit_is_refused_though_both_have_the_same_nearest_float() {
    use in_single_precision::{SetReach, Target};
    let sends = |reach, share| SetReach { reach, share }.write(Target::Charger).is_ok();
    assert_eq!([3_690_986.0 / 1024.0, -3_690_986.0 / 1024.0].map(|reach| sends(reach, 0.0)), [true; 2]);
    assert_eq!([3_690_987.0 / 1024.0, -3_690_987.0 / 1024.0].map(|reach| sends(reach, 0.0)), [false; 2]);
    assert_eq!([0.299, 0.3].map(|share| sends(0.0, share)), [true, false]);
}

/// 0.3 and 0.29999999999999999 have the same nearest double.
#[test]
fn doubles_and_whole_steps_refuse_the_same_step() {
    use features_limits_between_steps::{SetReach, Target};
    use features_limits_between_steps_in_steps as in_steps;
    let sends = |reach, share| SetReach { reach, share }.write(Target::Charger).is_ok();
    assert_eq!([3_690_986.0 / 1024.0, -3_690_986.0 / 1024.0].map(|reach| sends(reach, 0.0)), [true; 2]);
    assert_eq!([3_690_987.0 / 1024.0, -3_690_987.0 / 1024.0].map(|reach| sends(reach, 0.0)), [false; 2]);
    assert_eq!([0.299, 0.3].map(|share| sends(0.0, share)), [true, false]);

    let sends =
        |reach_raw, share_raw| in_steps::SetReach { reach_raw, share_raw }.write(in_steps::Target::Charger).is_ok();
    assert_eq!([3_690_986, -3_690_986].map(|reach| sends(reach, 0)), [true; 2]);
    assert_eq!([3_690_987, -3_690_987].map(|reach| sends(reach, 0)), [false; 2]);
    assert_eq!([299, 300].map(|share| sends(0, share)), [true, false]);
}

#[test]
fn a_double_holds_wide_steps_of_powers_of_two() {
    // The first one has 49 significant bits, the second one 52, and each of the others 53.
    for (scale, raw, physical) in [
        (Scale::new(16, 1), (1 << 49) - 1, 9_007_199_254_740_976.0),
        (Scale::new(1, 8), (1 << 52) - 1, 4_503_599_627_370_495.0 / 8.0),
        (Scale::new(16, 1), (1 << 53) - 1, 144_115_188_075_855_856.0),
        (Scale::new(1, 1024), (1 << 53) - 1, 9_007_199_254_740_991.0 / 1024.0),
        (Scale::new(1, 2), -(1 << 53) + 1, -4_503_599_627_370_495.5),
        (Scale::new(-1024, 1), (1 << 53) - 1, -9_223_372_036_854_774_784.0),
    ] {
        for (raw, physical) in [(raw, physical), (raw - 1, physical - scale.physical(1))] {
            assert_eq!((scale.physical(raw), scale.raw(physical)), (physical, Some(raw)));
        }
    }
    for field in ["{bytes: 0..5, scale: 16}", "{bytes: 0..5, scale: -48}", "{bytes: 0..5, scale: 31/8}"] {
        assert_eq!(said(field, Scaled::F64), "", "{field}");
    }
    for (field, why) in [
        ("{bytes: 0..5, scale: 33/8}", "48 bits in steps of 4.125 are too many for an `f64`, while 47 bits fit"),
        ("{bytes: 0..5, scale: 66}", "48 bits in steps of 66 are too many for an `f64`, while 47 bits fit"),
        ("{bytes: 0, scale: 1/9007199254740993}", "steps of 1/9007199254740993 from 0 on are too fine for an `f64`"),
    ] {
        let said = said(field, Scaled::F64);
        assert!(said.ends_with(why), "{field}: {said}");
    }
}
