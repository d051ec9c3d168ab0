//! Cover and Hide: near(s1), then near(s2), then near(exit), alive throughout; judged at the goal, 400 steps.  The three
//! places exclude each other.

use super::common::{Episode, Refused, Step, Verdict, finite, near};

const ATOMS: [&str; 3] = ["near(s1)", "near(s2)", "near(exit)"];
const LABELS: [&str; 5] = [
    "F(near(s1) & X F(near(s2) & X F near(exit))) & G alive",
    "F(near(s2) & X F near(exit)) & G alive",
    "false",
    "F near(exit) & G alive",
    "G alive",
];
const ENGLISH: [&str; 5] = [
    "Reach near(s1), then near(s2), then near(exit), and keep alive throughout.",
    "Reach near(s2), then near(exit), and keep alive throughout.",
    "The spec is violated.",
    "Reach near(exit), and keep alive throughout.",
    "Keep alive throughout.",
];
const VERDICTS: [Verdict; 5] =
    [Verdict::Pending, Verdict::Pending, Verdict::Violated, Verdict::Pending, Verdict::Holding];
const TRAP: usize = 2;
const GOAL: usize = 4;
const LIMIT: u32 = 400;

#[derive(Clone, Copy, Debug)]
pub struct Signals {
    pub distance_s1: f64,
    pub distance_s2: f64,
    pub distance_exit: f64,
    pub health: f64,
}

/// States 0, 1 and 3 wait for a place, 4 is the goal, 2 is the trap.
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
    /// A signal is not finite, or two places are near at once; the state stays.
    pub fn step(&mut self, signals: &Signals) -> Result<Step, Refused> {
        let closeness = [
            near(finite("distance(s1)", signals.distance_s1)?, self.level_size),
            near(finite("distance(s2)", signals.distance_s2)?, self.level_size),
            near(finite("distance(exit)", signals.distance_exit)?, self.level_size),
        ];
        let alive = finite("health", signals.health)?.clamp(0.0, 1.0);
        if closeness.iter().filter(|&&value| value > 0.0).count() > 1 {
            return Err(Refused::Together);
        }
        let mut progress = 0.0;
        let mut limiting = None;
        let robustness = match self.state {
            TRAP => 1.0,
            _ if alive <= 0.0 => {
                self.state = TRAP;
                0.0
            }
            GOAL => {
                progress = 1.0;
                alive
            }
            waiting => {
                let (place, next) = [(0, 1), (1, 3), (0, 0), (2, 4)][waiting];
                let here: f64 = closeness[place];
                if here > 0.0 {
                    self.state = next;
                    progress = (place + 1) as f64 / 3.0;
                    here.min(alive)
                } else {
                    progress = (place as f64 + 1.0 + here) / 3.0;
                    limiting = Some(ATOMS[place]);
                    // At another place the player is certainly not here, because the places exclude each other.
                    let elsewhere = closeness[(place + 1) % 3].max(closeness[(place + 2) % 3]);
                    elsewhere.max(-here).min(alive)
                }
            }
        };
        let (trapped, accepting) = (self.state == TRAP, self.state == GOAL);
        let reward = self.episode.advance(progress, trapped, trapped || accepting, LIMIT);
        Ok(Step {
            state: self.state,
            label: LABELS[self.state],
            verdict: VERDICTS[self.state],
            accepting,
            done: self.episode.done,
            progress: self.episode.progress,
            reward,
            robustness,
            limiting,
            failed_clause: trapped.then_some("keep alive"),
            failed_atom: trapped.then_some("alive"),
            failed_step: self.episode.failed_step,
        })
    }
}

impl Step {
    /// The label in words.
    pub fn label_english(&self) -> &'static str {
        ENGLISH[self.state]
    }
}
