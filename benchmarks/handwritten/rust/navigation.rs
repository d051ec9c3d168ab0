//! Navigation: near(s1), then near(s2), then near(exit); judged at the goal, 300 steps.

use super::common::{Episode, Refused, Step, Verdict, finite, near};

const ATOMS: [&str; 3] = ["near(s1)", "near(s2)", "near(exit)"];
const LABELS: [&str; 4] = [
    "F(near(s1) & X F(near(s2) & X F near(exit)))",
    "F(near(s2) & X F near(exit))",
    "F near(exit)",
    "true",
];
const ENGLISH: [&str; 4] = [
    "Reach near(s1), then near(s2), then near(exit).",
    "Reach near(s2), then near(exit).",
    "Reach near(exit).",
    "Nothing remains to be done.",
];
const GOAL: usize = 3;
const LIMIT: u32 = 300;

#[derive(Clone, Copy, Debug)]
pub struct Signals {
    pub distance_s1: f64,
    pub distance_s2: f64,
    pub distance_exit: f64,
}

/// The state is the number of marks that were reached in order.
#[derive(Clone, Debug)]
pub struct Monitor {
    level_size: f64,
    state: usize,
    episode: Episode,
}

impl Monitor {
    pub fn new(level_size: f64) -> Self {
        Monitor { level_size, state: 0, episode: Episode::default() }
    }

    pub fn reset(&mut self) {
        *self = Monitor::new(self.level_size);
    }

    /// Take one sample.
    ///
    /// # Errors
    ///
    /// A signal is not finite; the state stays.
    pub fn step(&mut self, signals: &Signals) -> Result<Step, Refused> {
        let distances = [
            finite("distance(s1)", signals.distance_s1)?,
            finite("distance(s2)", signals.distance_s2)?,
            finite("distance(exit)", signals.distance_exit)?,
        ];
        let (mut robustness, mut progress, mut limiting) = (1.0, 1.0, None);
        if self.state < GOAL {
            let closeness = near(distances[self.state], self.level_size);
            if closeness > 0.0 {
                self.state += 1;
                robustness = closeness;
                progress = self.state as f64 / 3.0;
            } else {
                robustness = -closeness;
                progress = (self.state as f64 + 1.0 + closeness) / 3.0;
                limiting = Some(ATOMS[self.state]);
            }
        }
        let accepting = self.state == GOAL;
        let reward = self.episode.advance(progress, false, accepting, LIMIT);
        Ok(Step {
            state: self.state,
            label: LABELS[self.state],
            verdict: if accepting { Verdict::Satisfied } else { Verdict::Pending },
            accepting,
            done: self.episode.done,
            progress: self.episode.progress,
            reward,
            robustness,
            limiting,
            failed_clause: None,
            failed_atom: None,
            failed_step: None,
        })
    }
}

impl Step {
    /// The label in words.
    pub fn label_english(&self) -> &'static str {
        ENGLISH[self.state]
    }
}
