//! Times the three codecs on a million distinct frames and on a loop of sixteen.

use std::time::Duration;

use canspec_benches::Codec;
use canspec_benches::by_hand::Hand;
use canspec_benches::dbc::Dbc;
use canspec_benches::frame::Frame;
use canspec_benches::frames;
use canspec_benches::generated::Generated;
use canspec_benches::processor_time::ProcessorTime;
use canspec_benches::work::{Prepared, Work};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

const SECOND: Duration = Duration::from_secs(1);

fn codecs(criterion: &mut Criterion<ProcessorTime>) {
    for (name, frames) in [("distinct", frames::distinct(frames::MANY)), ("loop", frames::few())] {
        all::<Generated>(criterion, name, &frames);
        all::<Hand>(criterion, name, &frames);
        all::<Dbc>(criterion, name, &frames);
    }
}

fn all<C: Codec>(criterion: &mut Criterion<ProcessorTime>, name: &str, frames: &[Frame]) {
    let works = Work::ALL.into_iter().map(|work| (work, Prepared::new::<C>(work, frames)));
    for (work, prepared) in works.filter(|(_, prepared)| prepared.count() > 0) {
        one(criterion, &format!("{} {name}", work.name()), C::NAME, prepared.count(), || prepared.run());
    }
}

fn one(criterion: &mut Criterion<ProcessorTime>, group: &str, codec: &str, count: usize, mut work: impl FnMut()) {
    let mut group = criterion.benchmark_group(group);
    group.throughput(Throughput::Elements(count as u64));
    group.bench_function(codec, |bencher| bencher.iter(&mut work));
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().with_measurement(ProcessorTime).sample_size(50).warm_up_time(SECOND).measurement_time(2 * SECOND);
    targets = codecs
}
criterion_main!(benches);
