//! Runs the generated and the handwritten monitor over the same traces, which have a line of numbers for each sample.
//!
//!     driver rows TRACE...               a row for each step, first of the generated, then of the handwritten one
//!     driver time ROUNDS SECONDS TRACE   JSON lines: steps per second of CPU time in each round
//!
//! All results are written to memory, so that no field of them is left out.

use std::hint::black_box;

#[path = "@SPEC@_monitor.rs"]
mod generated;

#[allow(dead_code)]
mod by_hand {
    #[path = "@BY_HAND@/common.rs"]
    mod common;
    #[path = "@BY_HAND@/@SPEC@.rs"]
    mod monitor;
    pub use common::Step;
    pub use monitor::{Monitor, Signals};
}

extern "C" {
    // CPU time of this process, in microseconds.
    fn clock() -> i64;
}

trait Pass {
    fn run(&mut self);
    fn rewards(&self) -> f64;
    fn print(&self);
}

macro_rules! pass {
    ($who:ident, $name:ident, $new:expr) => {
        struct $who {
            monitor: $name::Monitor,
            samples: Vec<$name::Signals>,
            steps: Vec<$name::Step>,
        }

        impl $who {
            fn new(rows: &[Vec<f64>]) -> Self {
                let samples: Vec<_> = rows.iter().map(|row| $name::Signals { @ASSIGNMENTS@ }).collect();
                let mut monitor = $new;
                let steps = samples.iter().map(|sample| monitor.step(sample).expect("a sample is refused")).collect();
                $who { monitor, samples, steps }
            }
        }

        impl Pass for $who {
            #[inline(never)]
            fn run(&mut self) {
                self.monitor.reset();
                for (sample, step) in self.samples.iter().zip(self.steps.iter_mut()) {
                    *step = self.monitor.step(sample).expect("a sample is refused");
                }
            }

            fn rewards(&self) -> f64 {
                self.steps.iter().map(|step| step.reward).sum()
            }

            fn print(&self) {
                for step in &self.steps {
                    let verdict = format!("{:?}", step.verdict).to_lowercase();
                    print!("{}\t{}\t{}\t{verdict}\t", stringify!($name), step.state, step.label);
                    print!("{}\t{}\t{:?}\t{:?}\t", step.accepting, step.done, step.progress, step.reward);
                    print!("{:?}\t{}\t{}\t", step.robustness, step.limiting.unwrap_or(""), step.label_english());
                    print!("{}\t{}\t", step.failed_clause.unwrap_or(""), step.failed_atom.unwrap_or(""));
                    println!("{}", step.failed_step.map_or(String::new(), |number| number.to_string()));
                }
            }
        }
    };
}

pass!(Generated, generated, generated::Monitor::new());
pass!(ByHand, by_hand, by_hand::Monitor::new(20.0));

fn seconds_of(pass: &mut dyn Pass, count: u64) -> f64 {
    let started = unsafe { clock() };
    for _ in 0..count {
        black_box(&mut *pass).run();
    }
    (unsafe { clock() } - started) as f64 / 1e6
}

fn rows(path: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).expect("a trace");
    let numbers = |line: &str| line.split(' ').map(|number| number.parse().expect("a number")).collect();
    text.lines().map(numbers).collect()
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if words[0] == "rows" {
        for path in &words[1..] {
            let trace = rows(path);
            let mut passes: [Box<dyn Pass>; 2] = [Box::new(Generated::new(&trace)), Box::new(ByHand::new(&trace))];
            for pass in &mut passes {
                pass.run();
                pass.print();
            }
        }
        return;
    }
    let (rounds, enough_s): (usize, f64) = (words[1].parse().expect("rounds"), words[2].parse().expect("seconds"));
    let trace = rows(&words[3]);
    let mut passes: [Box<dyn Pass>; 2] = [Box::new(Generated::new(&trace)), Box::new(ByHand::new(&trace))];
    let repeats = [0, 1].map(|who| {
        let mut count = 1;
        while seconds_of(passes[who].as_mut(), count) < enough_s {
            count *= 2;
        }
        count
    });
    for _ in 0..rounds {
        let rates = [0, 1].map(|who| {
            let seconds = seconds_of(passes[who].as_mut(), repeats[who]);
            trace.len() as f64 * repeats[who] as f64 / seconds
        });
        let rewards = [passes[0].rewards(), passes[1].rewards()];
        println!("{{\"generated\": {:.0}, \"by_hand\": {:.0}, \"rewards\": {rewards:?}}}", rates[0], rates[1]);
    }
}
