use std::vec::Vec;

use super::{Full, Schedule};

fn due<const N: usize>(schedule: &mut Schedule<u8, N>, now: u32) -> Vec<u8> {
    core::iter::from_fn(|| schedule.due(now, |_| true)).take(N + 1).collect()
}

#[test]
fn what_is_sent_in_cycles_keeps_its_rounds() {
    let mut schedule = Schedule::<u8, 2>::new();
    assert_eq!((schedule.every(1, 50, 7), schedule.next(7)), (Ok(()), Some(7)));
    assert_eq!((due(&mut schedule, 7), schedule.next(7)), ([1].into(), Some(57)));
    assert_eq!((due(&mut schedule, 56), due(&mut schedule, 60)), ([].into(), [1].into()));
    assert_eq!(schedule.next(60), Some(107), "a round that is late moves no other");
    assert_eq!((due(&mut schedule, 207), schedule.next(207)), ([1].into(), Some(257)), "two rounds are left out");
    assert_eq!((schedule.every(2, 0, 207), due(&mut schedule, 207)), (Ok(()), [2].into()));
    assert_eq!(schedule.next(207), Some(208));
}

#[test]
fn a_period_is_at_most_half_of_what_the_clock_counts() {
    for period in [(1 << 31) - 1, 1 << 31, (1 << 31) + 1, u32::MAX] {
        let mut schedule = Schedule::<u8, 1>::new();
        assert_eq!((schedule.every(1, period, 7), due(&mut schedule, 7)), (Ok(()), [1].into()), "{period}");
        assert_eq!((schedule.next(7), due(&mut schedule, 0x8000_0005)), (Some(0x8000_0006), [].into()), "{period}");
        assert_eq!(due(&mut schedule, 0x8000_0006), [1], "{period}");
    }
}

#[test]
fn a_wait_ends_once_and_starts_anew() {
    let mut schedule = Schedule::<u8, 2>::new();
    assert_eq!((schedule.once(1, 100, 0), schedule.once(1, 100, 60)), (Ok(()), Ok(())));
    assert_eq!((due(&mut schedule, 159), schedule.has(1)), ([].into(), true));
    assert_eq!((due(&mut schedule, 160), schedule.has(1), schedule.next(160)), ([1].into(), false, None));
    assert_eq!((schedule.once(1, 5, 0), schedule.every(2, 5, 0), schedule.once(3, 5, 0)), (Ok(()), Ok(()), Err(Full)));
    schedule.cancel(1);
    assert_eq!((schedule.once(3, 5, 0), due(&mut schedule, 5)), (Ok(()), [2, 3].into()));
    schedule.clear();
    assert_eq!(schedule.next(5), None);
}

#[test]
fn what_is_due_longest_comes_first_also_when_time_wraps_around() {
    let mut schedule = Schedule::<u8, 3>::new();
    let start = u32::MAX - 10;
    for (key, delay) in [(1, 30), (2, 5), (3, 20)] {
        schedule.once(key, delay, start).expect("room");
    }
    assert_eq!(schedule.next(start), Some(u32::MAX - 5));
    assert_eq!(schedule.due(start.wrapping_add(25), |key| key != 2), Some(3), "the other one may not");
    assert_eq!(schedule.next(start.wrapping_add(25)), Some(start.wrapping_add(25)), "it is still due");
    assert_eq!(due(&mut schedule, start.wrapping_add(40)), [2, 1]);
}
