//! The parts that the handwritten monitors share: their result, the reward, and closeness.

use std::num::NonZeroU32;

/// What the verdict would be if the trace ended here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    Satisfied,
    Holding,
    Pending,
    Violated,
}

/// The result of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    pub state: usize,
    pub label: &'static str,
    pub verdict: Verdict,
    pub accepting: bool,
    pub done: bool,
    pub progress: f64,
    pub reward: f64,
    pub robustness: f64,
    pub limiting: Option<&'static str>,
    pub failed_clause: Option<&'static str>,
    pub failed_atom: Option<&'static str>,
    pub failed_step: Option<NonZeroU32>,
}

/// A sample that cannot be taken; the state stays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    NotFinite(&'static str),
    Together,
}

/// An episode so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Episode {
    pub steps: u32,
    pub progress: f64,
    pub done: bool,
    pub failed_step: Option<NonZeroU32>,
}

impl Episode {
    /// Count a step with this progress; returns its reward.
    #[inline]
    pub fn advance(&mut self, progress: f64, violated: bool, ends: bool, limit: u32) -> f64 {
        self.steps += 1;
        let best = self.progress.max(progress);
        let mut reward = 0.0;
        if !self.done {
            reward = best - self.progress - 1.0 / f64::from(limit);
            if violated {
                reward -= f64::from(limit - self.steps) / f64::from(limit);
            }
        }
        self.progress = best;
        if violated && self.failed_step.is_none() {
            self.failed_step = NonZeroU32::new(self.steps);
        }
        self.done = self.done || ends || self.steps >= limit;
        reward
    }
}

/// The value of a signal.
///
/// # Errors
///
/// It is not finite.
#[inline]
pub fn finite(name: &'static str, value: f64) -> Result<f64, Refused> {
    if value.is_finite() { Ok(value) } else { Err(Refused::NotFinite(name)) }
}

/// Closeness in -1 to 1: 1 at the target, 0 at 1 m, -1 from `level_size` on.
#[inline]
pub fn near(distance: f64, level_size: f64) -> f64 {
    if distance < 1.0 {
        return 1.0 - distance.max(0.0);
    }
    if distance > level_size {
        return -1.0;
    }
    let rest = (level_size - distance) / (level_size - 1.0);
    rest * rest - 1.0
}
