//! Times the codecs on a million distinct frames and on a loop of sixteen.

use std::time::Duration;

use canspec_benches::frame::Frame;
use canspec_benches::processor_time::ProcessorTime;
use canspec_benches::workload::Workload;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

const SECOND: Duration = Duration::from_secs(1);

fn codecs(criterion: &mut Criterion<ProcessorTime>) {
    for workload in Workload::timed() {
        for kind in workload.kinds {
            let frames = (kind.frames)(Workload::TIMED);
            for (set, count) in Workload::SETS {
                all(criterion, &frames[..count], |work| workload.group(work, kind, set), workload);
            }
        }
    }
}

/// Times all works of all codecs on some frames.
fn all(
    criterion: &mut Criterion<ProcessorTime>,
    frames: &[Frame],
    group: impl Fn(&str) -> String,
    workload: &Workload,
) {
    let works = workload.codecs.iter().flat_map(|codec| codec.works.iter().map(|work| (codec.codec, work)));
    for (codec, work) in works {
        let prepared = (work.prepare)(frames);
        if prepared.count() > 0 {
            let mut group = criterion.benchmark_group(group(work.name));
            group.throughput(Throughput::Elements(prepared.count() as u64));
            group.bench_function(codec, |bencher| bencher.iter(|| prepared.run()));
            group.finish();
        }
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().with_measurement(ProcessorTime).sample_size(50).warm_up_time(SECOND).measurement_time(2 * SECOND);
    targets = codecs
}
criterion_main!(benches);
