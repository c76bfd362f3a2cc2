//! Times the three codecs on a million distinct frames and on a loop of sixteen.

use std::time::Duration;

use canspec_benches::dbc::Dbc;
use canspec_benches::frame::Frame;
use canspec_benches::generated::Generated;
use canspec_benches::hand::Hand;
use canspec_benches::processor_time::ProcessorTime;
use canspec_benches::{Codec, decode, encode, frames, received, request, requests};
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
    let (received, requests) = (received::<C>(frames), requests::<C>(frames));
    one(criterion, &format!("decode {name}"), C::NAME, frames.len(), || decode::<C>(frames));
    one(criterion, &format!("encode {name}"), C::NAME, received.len(), || encode::<C>(&received));
    one(criterion, &format!("request {name}"), C::NAME, requests.len(), || request::<C>(&requests));
}

fn one(criterion: &mut Criterion<ProcessorTime>, group: &str, codec: &str, frames: usize, mut work: impl FnMut()) {
    let mut group = criterion.benchmark_group(group);
    group.throughput(Throughput::Elements(frames as u64));
    group.bench_function(codec, |bencher| bencher.iter(&mut work));
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().with_measurement(ProcessorTime).sample_size(50).warm_up_time(SECOND).measurement_time(2 * SECOND);
    targets = codecs
}
criterion_main!(benches);
