//! The line follower of the article in a few lines, ten steps a second, with the constants to try.

use lrp_sim::{Noise, Sim, Twist, World};

const PERIOD_US: u64 = 100_000;
const LIMIT: u8 = 128;
const MARGIN: u8 = 10;
/// Turning round after a bump: rad/s, and steps that make half a turn.
const TURN: f64 = 1.0;
const TURN_STEPS: u32 = 31;
const BACK: f64 = -0.2;
const BACK_STEPS: u32 = 10;

/// Which way a follower looks for the line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Search {
    BothWays,
    OnlyLeft,
    OnlyRight,
}

#[derive(Debug, Clone, Copy)]
pub struct Follower {
    /// m/s
    pub forward: f64,
    /// rad/s
    pub search: f64,
    /// Steps of the first look to one side.
    pub maxlook: u32,
    pub ways: Search,
}

/// How a run went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Run {
    /// Where the robot bumped, in the order it happened, and when, s.
    pub bumps: [Option<(f64, f64, f64)>; 2],
}

impl Run {
    /// When the robot had bumped at two different ends of the course, s.
    pub fn finished(&self) -> Option<f64> {
        let [Some((_, x, y)), Some((time, other_x, other_y))] = self.bumps else {
            return None;
        };
        ((x - other_x).hypot(y - other_y) > 0.5).then_some(time)
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum State {
    Moving,
    /// Sweep number, counted in quarters, and steps left in this quarter.
    Looking {
        quarter: u32,
        left: u32,
    },
    Back {
        left: u32,
    },
    Turn {
        left: u32,
    },
}

impl Follower {
    pub fn run(&self, world: &World, noise: Noise, seed: u64, seconds: u64) -> Run {
        let mut sim = Sim::new(world.clone(), noise, seed);
        let mut state = self.looking();
        let mut run = Run { bumps: [None; 2] };
        for step in 0..seconds * 10 {
            sim.advance_to(step * PERIOD_US);
            if sim.bumper() && matches!(state, State::Moving | State::Looking { .. }) {
                let bump = Some((step as f64 / 10.0, sim.pose().x, sim.pose().y));
                if run.bumps[0].is_some() {
                    run.bumps[1] = bump;
                    return run;
                }
                run.bumps[0] = bump;
                state = State::Back { left: BACK_STEPS };
            }
            state = self.next(state, sim.light());
            sim.drive(self.twist(state)).unwrap();
        }
        run
    }

    fn looking(&self) -> State {
        State::Looking { quarter: 0, left: self.maxlook }
    }

    fn next(&self, state: State, light: u8) -> State {
        match state {
            State::Moving if light > LIMIT + MARGIN => self.looking(),
            State::Looking { .. } if light < LIMIT - MARGIN => State::Moving,
            State::Looking { quarter, left: 1 } => {
                let sweep = (quarter + 1) / 4;
                State::Looking { quarter: quarter + 1, left: self.maxlook << sweep.min(12) }
            }
            State::Looking { quarter, left } => State::Looking { quarter, left: left - 1 },
            State::Back { left: 1 } => State::Turn { left: TURN_STEPS },
            State::Back { left } => State::Back { left: left - 1 },
            State::Turn { left: 1 } => self.looking(),
            State::Turn { left } => State::Turn { left: left - 1 },
            State::Moving => State::Moving,
        }
    }

    fn twist(&self, state: State) -> Twist {
        let (linear, angular) = match state {
            State::Moving => (self.forward, 0.0),
            State::Looking { quarter, .. } => (0.0, self.search * self.side(quarter % 4)),
            State::Back { .. } => (BACK, 0.0),
            State::Turn { .. } => (0.0, TURN),
        };
        Twist { linear, angular }
    }

    /// Look to a side, return, look to the other side, return; a one-sided follower looks to the same side again.
    fn side(&self, quarter: u32) -> f64 {
        match (self.ways, quarter) {
            (Search::BothWays, 0 | 3) | (Search::OnlyLeft, 0 | 2) | (Search::OnlyRight, 1 | 3) => 1.0,
            _ => -1.0,
        }
    }
}
