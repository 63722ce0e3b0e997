//! Eight lanes at work.

use pc_expr::{LANES, LaneField, Lanes};

use super::dense::TERMS;
use super::field::FIXED;
use super::kernels::{Inside, Kernels};
use super::plan::Plan;
use super::step::{Output, ROWS, Row};
use crate::integration::statistics::Statistics;
use crate::integration::trajectory::Trajectory;

/// So many steps are made before somebody looks whether to go on.
const UNWATCHED: usize = 64;

/// What a block works on, and for whom.
pub(crate) trait Members {
    /// What a member is known by.
    type Name;

    /// The next member, with its field, whose kernels are those of the block, and its start; none if there is none now.
    fn next(&mut self, is_idle: bool) -> Option<(Self::Name, LaneField, Vec<f64>)>;

    /// Takes the complete motion of one; none where it is to be integrated alone.
    fn end(&mut self, name: Self::Name, motion: Option<Trajectory>);

    /// Whether to end now.
    fn is_stopped(&self) -> bool;
}

/// A member in its lane.
struct Occupant<N> {
    name: N,
    motion: Trajectory,
    /// The next of the output times.
    next: usize,
    steps: u64,
    tries: u64,
    first_step: Option<f64>,
    last_step: f64,
}

/// Lanes with members of one program.
pub(crate) struct Block<'a, N> {
    plan: &'a Plan,
    kernels: &'a Kernels,
    /// Lanes in use.
    width: usize,
    lanes: [Option<Occupant<N>>; LANES],
    frame: Vec<Lanes>,
    start: Vec<Lanes>,
    polynomial: Vec<Lanes>,
    value: Vec<Lanes>,
}

impl<'a, N> Block<'a, N> {
    /// With so many lanes in use, at most [`LANES`].
    pub(crate) fn new(plan: &'a Plan, kernels: &'a Kernels, width: usize) -> Self {
        let frames = |inside: &Inside| (inside.polynomial.frame(), inside.value.frame());
        let (polynomial, value) = kernels.inside.as_ref().map(frames).unwrap_or_default();
        Block {
            plan,
            kernels,
            width: width.clamp(1, LANES),
            lanes: std::array::from_fn(|_| None),
            frame: kernels.step.frame(),
            start: kernels.start.frame(),
            polynomial,
            value,
        }
    }

    /// Integrates members until there are no more.
    pub(crate) fn run(&mut self, members: &mut impl Members<Name = N>) {
        let attention = self.kernels.step.first_output() + Output::Attention as usize;
        let mut unwatched = 0;
        while self.fill(members) {
            loop {
                self.kernels.step.run(&mut self.frame);
                unwatched += 1;
                if self.frame[attention].0.iter().any(|mask| mask.to_bits() != 0) {
                    self.attend(members);
                    break;
                }
                if unwatched >= UNWATCHED {
                    break;
                }
            }
            if unwatched >= UNWATCHED {
                unwatched = 0;
                if self.plan.deadline.as_ref().is_some_and(|deadline| deadline.passed().is_some()) {
                    // Alone each will be told so.
                    (0..LANES).for_each(|lane| self.leave(lane, members));
                }
            }
        }
    }

    /// Gives free lanes to members; whether any is at work.
    fn fill(&mut self, members: &mut impl Members<Name = N>) -> bool {
        if members.is_stopped() {
            return false;
        }
        loop {
            let mut begun = [false; LANES];
            for lane in 0..self.width {
                while self.lanes[lane].is_none() {
                    let is_idle = self.lanes.iter().all(Option::is_none);
                    let Some((name, field, y)) = members.next(is_idle) else { break };
                    if self.accepts(&field, &y) {
                        self.place(lane, &field, &y);
                        let motion = Trajectory::new(self.kernels.dim);
                        let (steps, tries, first_step, last_step) = (0, 0, None, 0.0);
                        self.lanes[lane] =
                            Some(Occupant { name, motion, next: 0, steps, tries, first_step, last_step });
                        begun[lane] = true;
                    } else {
                        members.end(name, None);
                    }
                }
            }
            if !begun.contains(&true) {
                return self.lanes.iter().any(Option::is_some);
            }
            self.begin(begun, members);
        }
    }

    /// That a member is one of these and can begin.
    fn accepts(&self, field: &LaneField, y: &[f64]) -> bool {
        let watched = &field.watched;
        y.len() == self.kernels.dim
            && field.parameters.len() == self.kernels.parameters
            && watched.smallest > watched.vanishing * watched.largest
    }

    /// Writes the numbers of a member to a lane.
    fn place(&mut self, lane: usize, field: &LaneField, y: &[f64]) {
        let dim = self.kernels.dim;
        let watched = [field.watched.smallest, field.watched.largest];
        let numbers = || field.parameters.iter().chain(&watched);
        // No lane is left with numbers that are none, of which computing may take longer.
        let empty = self.lanes.iter().all(Option::is_none);
        let lanes = if empty { 0..LANES } else { lane..lane + 1 };
        for lane in lanes {
            for (row, value) in self.start.iter_mut().zip(y.iter().chain(numbers())) {
                row.0[lane] = *value;
            }
            for (row, value) in self.frame[ROWS + 2 * dim..].iter_mut().zip(numbers()) {
                row.0[lane] = *value;
            }
        }
    }

    /// Begins in these lanes.
    fn begin(&mut self, begun: [bool; LANES], members: &mut impl Members<Name = N>) {
        let dim = self.kernels.dim;
        self.kernels.start.run(&mut self.start);
        let results = self.kernels.start.first_output();
        let mut all = self.lanes.iter().zip(begun).all(|(lane, begun)| lane.is_none() || begun);
        for lane in (0..LANES).filter(|&lane| begun[lane]) {
            if self.start[results + dim + 1].0[lane].to_bits() == 0 {
                self.leave(lane, members);
                continue;
            }
            // The first is copied to where nobody is.
            let to = if std::mem::take(&mut all) { 0..LANES } else { lane..lane + 1 };
            for other in to {
                for i in 0..dim {
                    self.frame[ROWS + i].0[other] = self.start[i].0[lane];
                    self.frame[ROWS + dim + i].0[other] = self.start[results + i].0[lane];
                }
                self.set(Row::Time, other, self.plan.start);
                self.set(Row::Length, other, self.start[results + dim].0[lane]);
                // The first step is reported.
                self.set(Row::Due, other, self.plan.start);
                for row in [Row::Active, Row::Refused, Row::Steps, Row::Tries] {
                    self.set(row, other, 0.0);
                }
            }
            self.set(Row::Active, lane, f64::from_bits(u64::MAX));
            if self.plan.times[0] == self.plan.start {
                let Some(occupant) = &mut self.lanes[lane] else { continue };
                let y: Vec<f64> = (0..dim).map(|i| self.start[i].0[lane]).collect();
                occupant.motion.push(self.plan.start, &y);
                occupant.next = 1;
            }
        }
    }

    /// Deals with the lanes that have come to something.
    fn attend(&mut self, members: &mut impl Members<Name = N>) {
        let results = self.kernels.step.first_output();
        let read = |frame: &[Lanes], result: Output| frame[results + result as usize].0;
        let (attention, broken) = (read(&self.frame, Output::Attention), read(&self.frame, Output::Broken));
        let (from, times) = (read(&self.frame, Output::From), self.frame[Row::Time as usize].0);
        let mut is_inside = false;
        for lane in (0..LANES).filter(|&lane| attention[lane].to_bits() != 0) {
            if broken[lane].to_bits() != 0 {
                self.leave(lane, members);
                continue;
            }
            let Some(occupant) = &mut self.lanes[lane] else { continue };
            occupant.last_step = times[lane] - from[lane];
            occupant.first_step.get_or_insert(occupant.last_step);
            is_inside |= self.plan.times[occupant.next] != times[lane]
                && (self.plan.times[occupant.next] - times[lane]) * self.plan.direction < 0.0;
        }
        if is_inside {
            self.expand();
        }
        for lane in (0..LANES).filter(|&lane| attention[lane].to_bits() != 0) {
            self.put_out(lane, (from[lane], times[lane]), members);
        }
    }

    /// Makes the polynomials of the last step.
    fn expand(&mut self) {
        let Some(inside) = &self.kernels.inside else { return };
        let dim = self.kernels.dim;
        let from = self.kernels.step.first_output() + Output::Signed as usize;
        // h, y, ẏ, seven stages; y and ẏ at the end; the numbers of the member.
        let (begin, end) = (1 + 9 * dim, 2 * dim + self.kernels.parameters + FIXED);
        self.polynomial[..begin].copy_from_slice(&self.frame[from..from + begin]);
        self.polynomial[begin..begin + end].copy_from_slice(&self.frame[ROWS..ROWS + end]);
        inside.polynomial.run(&mut self.polynomial);
        let terms = &self.polynomial[inside.polynomial.first_output()..][..TERMS * dim];
        self.value[..terms.len()].copy_from_slice(terms);
    }

    /// Gives the outputs of the last step of a lane, if it is still at work.
    fn put_out(&mut self, lane: usize, (from, to): (f64, f64), members: &mut impl Members<Name = N>) {
        let (dim, plan) = (self.kernels.dim, self.plan);
        let mut y = vec![0.0; dim];
        loop {
            let Some(occupant) = &mut self.lanes[lane] else { return };
            let Some(&t) = plan.times.get(occupant.next) else { break };
            if t == to {
                (0..dim).for_each(|i| y[i] = self.frame[ROWS + i].0[lane]);
            } else if (t - to) * plan.direction > 0.0 {
                break;
            } else if !self.inside(lane, (t - from) / (to - from), &mut y) {
                return self.leave(lane, members);
            }
            let Some(occupant) = &mut self.lanes[lane] else { return };
            occupant.motion.push(t, &y);
            occupant.next += 1;
            let steps = std::mem::take(&mut self.frame[Row::Steps as usize].0[lane]);
            occupant.steps += steps as u64;
        }
        let Some(occupant) = &self.lanes[lane] else { return };
        match plan.times.get(occupant.next) {
            Some(&next) => self.set(Row::Due, lane, next),
            None => self.complete(lane, to, members),
        }
    }

    /// y in the part s of the last step of a lane; whether it is known.
    fn inside(&mut self, lane: usize, s: f64, y: &mut [f64]) -> bool {
        let Some(inside) = &self.kernels.inside else { return false };
        let dim = self.kernels.dim;
        let known = self.polynomial[inside.polynomial.first_output() + TERMS * dim].0[lane];
        self.value[TERMS * dim] = Lanes::splat(s);
        inside.value.run(&mut self.value);
        let first = inside.value.first_output();
        (0..dim).for_each(|i| y[i] = self.value[first + i].0[lane]);
        known.to_bits() != 0 && y.iter().all(|y| y.is_finite())
    }

    /// A member has come to its end.
    fn complete(&mut self, lane: usize, t: f64, members: &mut impl Members<Name = N>) {
        self.set(Row::Active, lane, 0.0);
        let Some(mut occupant) = self.lanes[lane].take() else { return };
        occupant.tries += self.frame[Row::Tries as usize].0[lane] as u64;
        let length = self.frame[Row::Length as usize].0[lane];
        let statistics = Statistics {
            steps: occupant.steps,
            lane_steps: occupant.steps,
            // Of each try, of the start and of the length of the first step.
            rhs_evaluations: 12 * occupant.tries + 1 + u64::from(self.plan.first.is_none()),
            error_test_failures: occupant.tries - occupant.steps,
            last_order: 8,
            current_order: 8,
            first_step: occupant.first_step.unwrap_or(0.0),
            last_step: occupant.last_step,
            current_step: length * self.plan.direction,
            current_time: t,
            ..Statistics::default()
        };
        occupant.motion.finish(true, statistics);
        members.end(occupant.name, Some(occupant.motion));
    }

    /// A member is better integrated alone; its lane goes on with the numbers of another one, if there is one.
    fn leave(&mut self, lane: usize, members: &mut impl Members<Name = N>) {
        let Some(occupant) = self.lanes[lane].take() else { return };
        if let Some(other) = self.lanes.iter().position(Option::is_some) {
            let rows = ROWS + 2 * self.kernels.dim + self.kernels.parameters + FIXED;
            self.frame[..rows].iter_mut().for_each(|row| row.0[lane] = row.0[other]);
        }
        self.set(Row::Active, lane, 0.0);
        members.end(occupant.name, None);
    }

    fn set(&mut self, row: Row, lane: usize, value: f64) {
        self.frame[row as usize].0[lane] = value;
    }
}
