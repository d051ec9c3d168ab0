//! Branching: three switches in order, then the exit behind an open barrier, alive throughout; 600 steps.

use super::common::{Episode, Refused, Step, Verdict, finite, near};

const ATOMS: [&str; 3] = ["near(s1)", "near(s2)", "near(s3)"];
const LABELS: [&str; 6] = [
    "F(near(s1) & X F(near(s2) & X F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left))))) & G alive",
    "F(near(s2) & X F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left)))) & G alive",
    "false",
    "F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left))) & G alive",
    "F(open_right & near(e_right) | open_left & near(e_left)) & G alive",
    "G alive",
];
const ENGLISH: [&str; 6] = [
    "Reach near(s1), then near(s2), then near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
    "Reach near(s2), then near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
    "The spec is violated.",
    "Reach near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
    "Reach (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
    "Keep alive throughout.",
];
const VERDICTS: [Verdict; 6] =
    [Verdict::Pending, Verdict::Pending, Verdict::Violated, Verdict::Pending, Verdict::Pending, Verdict::Holding];
const TRAP: usize = 2;
const EXITS: usize = 4;
const GOAL: usize = 5;
const LIMIT: u32 = 600;

#[derive(Clone, Copy, Debug)]
pub struct Signals {
    pub distance_s1: f64,
    pub distance_s2: f64,
    pub distance_s3: f64,
    pub distance_e_right: f64,
    pub distance_e_left: f64,
    pub open_right: bool,
    pub open_left: bool,
    pub health: f64,
}

/// States 0, 1 and 3 wait for a switch, 4 for an exit, 5 is the goal, 2 is the trap.
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
        let switches = [
            finite("distance(s1)", signals.distance_s1)?,
            finite("distance(s2)", signals.distance_s2)?,
            finite("distance(s3)", signals.distance_s3)?,
        ];
        let to_right = finite("distance(e_right)", signals.distance_e_right)?;
        let to_left = finite("distance(e_left)", signals.distance_e_left)?;
        let alive = finite("health", signals.health)?.clamp(0.0, 1.0);
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
            EXITS => {
                let right_open: f64 = if signals.open_right { 1.0 } else { -1.0 };
                let left_open: f64 = if signals.open_left { 1.0 } else { -1.0 };
                let (right_near, left_near) = (near(to_right, self.level_size), near(to_left, self.level_size));
                let (right, left) = (right_open.min(right_near), left_open.min(left_near));
                let nearest = right.max(left);
                if nearest > 0.0 {
                    self.state = GOAL;
                    progress = 1.0;
                    nearest.min(alive)
                } else {
                    progress = (4.0 + nearest) / 4.0;
                    limiting = Some(if right >= left {
                        if right_open <= right_near { "open_right" } else { "near(e_right)" }
                    } else if left_open <= left_near {
                        "open_left"
                    } else {
                        "near(e_left)"
                    });
                    alive.min(-nearest)
                }
            }
            waiting => {
                let (switch, next) = [(0, 1), (1, 3), (0, 0), (2, 4)][waiting];
                let closeness = near(switches[switch], self.level_size);
                if closeness > 0.0 {
                    self.state = next;
                    progress = (switch + 1) as f64 / 4.0;
                    closeness.min(alive)
                } else {
                    progress = (switch as f64 + 1.0 + closeness) / 4.0;
                    limiting = Some(ATOMS[switch]);
                    alive.min(-closeness)
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
