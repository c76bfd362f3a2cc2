//! How the identifier shows where a frame goes: by one of its fields after another.
//!
//! Generated code writes out at each end what is done with the frame, which is long. So each end that
//! leads somewhere stands there only once.

use std::collections::BTreeSet;
use std::iter;

use indexmap::{IndexMap, IndexSet};
use proc_macro2::Ident;

use super::comparison::{Range, Test, field_place, field_test, range};
use crate::model::{FieldId, FieldTest, Protocol};

/// How the identifier shows where a frame goes.
pub enum Heading {
    /// It is known.
    Known {
        /// The frame can go to a module.
        to_module: bool,
        /// The frame can go to the controller.
        to_controller: bool,
    },
    /// A field says how to go on.
    By {
        /// Place of the field.
        place: Ident,
        /// Whether the field has at most eight bits.
        is_byte: bool,
        /// Values of the field, and what they show.
        cases: Vec<(Vec<Range>, Self)>,
        /// What all other values show.
        otherwise: Box<Self>,
    },
    /// Two tests say it, since one end would stand there twice.
    Tests {
        /// The frame can go to a module.
        to_module: Test,
        /// The frame can go to the controller.
        to_controller: Test,
    },
}

impl Heading {
    /// Plans how to tell where frames go. The field that is read first is the first one that leads to each end once.
    pub fn new(protocol: &Protocol) -> Self {
        let [to_module, to_controller] = [&protocol.recognition.to_module, &protocol.recognition.to_controller];
        let open = |lists: &[Vec<FieldTest>]| Lists(lists.to_vec()).shortened();
        let open = Open { to_module: open(&to_module.any), to_controller: open(&to_controller.any) };
        let fields: IndexSet<FieldId> = open.tests().map(|test| test.field).collect();
        let orders = fields.iter().map(|first| iter::once(*first).chain(fields.iter().copied()).collect());
        let mut planned = orders.filter_map(|order| Planner { protocol, order, ends: Vec::new() }.heading(&open));
        match planned.next() {
            Some(heading) => heading,
            None if fields.is_empty() => open.end(),
            None => Self::Tests {
                to_module: test(protocol, &open.to_module),
                to_controller: test(protocol, &open.to_controller),
            },
        }
    }
}

/// Lists of tests that are still to be made. One list must hold as a whole.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Lists(Vec<Vec<FieldTest>>);

/// What is still to be tested of an identifier.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Open {
    to_module: Lists,
    to_controller: Lists,
}

struct Planner<'a> {
    protocol: &'a Protocol,
    /// The fields in the order in which they are read.
    order: Vec<FieldId>,
    /// The ends that are reached already.
    ends: Vec<Open>,
}

impl Planner<'_> {
    /// Plans how to go on. Returns `None` if an end would stand there twice.
    fn heading(&mut self, open: &Open) -> Option<Heading> {
        let Some(field) = self.order.iter().copied().find(|field| open.tests().any(|test| test.field == *field)) else {
            return self.end(open);
        };
        let mut cases = self.cases(open, field);
        let most = cases.iter().enumerate().max_by_key(|(_, (_, ranges))| count(ranges)).map(|(place, _)| place)?;
        let (others, _) = cases.shift_remove_index(most)?;
        let otherwise = self.heading(&others)?;
        if cases.is_empty() {
            return Some(otherwise);
        }
        let (place, width) = field_place(self.protocol, field);
        let named = |ranges: Vec<(u32, u32)>| ranges.into_iter().map(|ends| range(ends, width)).collect();
        let cases = cases.into_iter().map(|(open, ranges)| Some((named(ranges), self.heading(&open)?)));
        let cases = cases.collect::<Option<_>>()?;
        Some(Heading::By { place, is_byte: width <= 8, cases, otherwise: Box::new(otherwise) })
    }

    fn end(&mut self, open: &Open) -> Option<Heading> {
        let is_there = self.ends.contains(open);
        if !is_there && open.leads_on() {
            self.ends.push(open.clone());
        }
        (!is_there).then(|| open.end())
    }

    /// Returns what is still to be tested after each value of a field, with the values as ranges.
    fn cases(&self, open: &Open, field: FieldId) -> IndexMap<Open, Vec<(u32, u32)>> {
        let last = u32::MAX >> (32 - u32::from(self.protocol[field].width));
        let starts: BTreeSet<u32> = open.starts(field).filter(|start| *start <= last).collect();
        let ends = starts.iter().skip(1).map(|next| next - 1).chain([last]);
        let mut cases: IndexMap<Open, Vec<(u32, u32)>> = IndexMap::new();
        for (start, end) in starts.iter().copied().zip(ends) {
            let ranges = cases.entry(open.after(field, start)).or_default();
            match ranges.last_mut() {
                Some((_, before)) if *before + 1 == start => *before = end,
                _ => ranges.push((start, end)),
            }
        }
        cases
    }
}

fn test(protocol: &Protocol, Lists(lists): &Lists) -> Test {
    let tests = |tests: &Vec<FieldTest>| tests.iter().map(|test| field_test(protocol, test)).collect();
    Test { any: lists.iter().map(tests).collect() }
}

/// Counts the values in some ranges.
fn count(ranges: &[(u32, u32)]) -> u64 {
    ranges.iter().map(|(first, last)| u64::from(last - first) + 1).sum()
}

impl Open {
    fn tests(&self) -> impl Iterator<Item = &FieldTest> {
        [&self.to_controller, &self.to_module].into_iter().flat_map(|Lists(lists)| lists.iter().flatten())
    }

    /// Tests whether a frame goes anywhere, once nothing is left to test.
    fn leads_on(&self) -> bool {
        self.to_module.hold() || self.to_controller.hold()
    }

    /// Returns where a frame goes, once nothing is left to test.
    fn end(&self) -> Heading {
        Heading::Known { to_module: self.to_module.hold(), to_controller: self.to_controller.hold() }
    }

    /// Returns the values of a field at which the outcome of a test can change.
    fn starts(&self, field: FieldId) -> impl Iterator<Item = u32> {
        let tests = self.tests().filter(move |test| test.field == field);
        let ends = |(first, last): &(u32, u32)| [*first, last.saturating_add(1)];
        tests.flat_map(move |test| test.ranges.iter().flat_map(ends)).chain([0])
    }

    /// Returns what is still to be tested after a value of a field.
    fn after(&self, field: FieldId, value: u32) -> Self {
        let after = |lists: &Lists| lists.after(field, value);
        Self { to_module: after(&self.to_module), to_controller: after(&self.to_controller) }
    }
}

impl Lists {
    /// Tests whether nothing is left to test in one list.
    fn hold(&self) -> bool {
        self.0.iter().any(Vec::is_empty)
    }

    /// Leaves out what cannot matter any more.
    fn shortened(self) -> Self {
        if self.hold() { Self(vec![Vec::new()]) } else { self }
    }

    fn after(&self, field: FieldId, value: u32) -> Self {
        let mut lists: Vec<Vec<FieldTest>> = Vec::new();
        for tests in &self.0 {
            let (now, later): (Vec<_>, Vec<_>) = tests.iter().partition(|test| test.field == field);
            let later: Vec<_> = later.into_iter().cloned().collect();
            if now.into_iter().all(|test| test.holds(value)) && !lists.contains(&later) {
                lists.push(later);
            }
        }
        Self(lists).shortened()
    }
}
