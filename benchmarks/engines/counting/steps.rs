// Times steps of monitors that count: `steps ROUNDS MONITORS` prints nanoseconds per step, as JSON lines.
// `first` is the time of the first steps of a count, and `last` that of the last ones.

mod quiet_monitor;

use quiet_monitor::{Monitor, Signals};
use std::time::Instant;

const STEPS: usize = 20;
const BEFORE: usize = 570;

fn step(monitor: &mut Monitor, pit: bool) {
    std::hint::black_box(monitor.step(&Signals { pit: Some(pit) })).expect("a valid sample");
}

fn nanoseconds(count: usize, before: usize) -> f64 {
    let mut monitors = vec![Monitor::new(); count];
    for monitor in &mut monitors {
        step(monitor, true);
        for _ in 0..before {
            step(monitor, false);
        }
    }
    let start = Instant::now();
    for monitor in &mut monitors {
        for _ in 0..STEPS {
            step(monitor, false);
        }
    }
    start.elapsed().as_nanos() as f64 / (count * STEPS) as f64
}

fn main() {
    let words: Vec<usize> = std::env::args().skip(1).map(|word| word.parse().expect("a number")).collect();
    for _ in 0..words[0] {
        let first = nanoseconds(words[1], 0);
        let last = nanoseconds(words[1], BEFORE);
        println!("{{\"first\": {first:.3}, \"last\": {last:.3}}}");
    }
}
