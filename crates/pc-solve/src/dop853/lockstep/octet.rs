//! Eight lanes that step together.

use pc_expr::{LANES, Lanes};

use super::dense::TERMS;
use super::kernels::{Inside, Kernels};
use super::members::Members;
use super::plan::Plan;
use super::step::{Output, ROWS, Row};
use super::waiting::{Ready, Waiting};
use crate::integration::statistics::Statistics;
use crate::integration::trajectory::Trajectory;

/// A member that occupies a lane.
struct Occupant<N> {
    name: N,
    motion: Trajectory,
    /// The index of the next output time.
    next: usize,
    /// The number of steps up to the last output.
    steps: u64,
}

/// A vector whose lanes hold members with the same program.
pub(super) struct Octet<'a, N> {
    plan: &'a Plan,
    kernels: &'a Kernels,
    /// The lanes in use.
    width: usize,
    lanes: [Option<Occupant<N>>; LANES],
    /// The number of lanes with members.
    working: usize,
    frame: Vec<Lanes>,
    polynomial: Vec<Lanes>,
    value: Vec<Lanes>,
    /// Room for a state.
    y: Vec<f64>,
}

impl<'a, N> Octet<'a, N> {
    /// An octet that uses `width` lanes, at most [`LANES`].
    pub(super) fn new(plan: &'a Plan, kernels: &'a Kernels, width: usize) -> Self {
        let frames = |inside: &Inside| (inside.polynomial.frame(), inside.value.frame());
        let (polynomial, value) = kernels.inside.as_ref().map(frames).unwrap_or_default();
        Octet {
            plan,
            kernels,
            width: width.min(LANES),
            lanes: std::array::from_fn(|_| None),
            working: 0,
            frame: kernels.step.frame(),
            polynomial,
            value,
            y: vec![0.0; kernels.dim],
        }
    }

    /// Whether no lane has a member.
    pub(super) fn is_idle(&self) -> bool {
        self.working == 0
    }

    /// The number of free lanes.
    pub(super) fn free(&self) -> usize {
        self.width - self.working
    }

    /// A free lane.
    pub(super) fn free_lane(&self) -> Option<usize> {
        if self.free() == 0 { None } else { self.lanes[..self.width].iter().position(Option::is_none) }
    }

    /// Starts a member in a lane.
    pub(super) fn begin(&mut self, lane: usize, ready: Ready<N>, waiting: &Waiting<'_, N>) {
        // An idle octet fills all lanes, so that no stale values, which could be slow to compute
        // with, remain.
        let lanes = if self.is_idle() { 0..LANES } else { lane..lane + 1 };
        let start = self.plan.start;
        let (y, found) = waiting.columns(ready.lane);
        let mut motion = Trajectory::with_capacity(self.kernels.dim, self.plan.times.len());
        let mut next = 0;
        if self.plan.times[0] == start {
            self.y.clear();
            self.y.extend(waiting.columns(ready.lane).0);
            motion.push(start, &self.y);
            next = 1;
        }
        let mut write = |row: usize, value: f64| self.frame[row].0[lanes.clone()].fill(value);
        for row in [Row::Active, Row::Refused, Row::Steps, Row::Tries, Row::First, Row::Suspect, Row::Clear] {
            write(row as usize, 0.0);
        }
        write(Row::Time as usize, start);
        write(Row::Length as usize, waiting.length(ready.lane));
        write(Row::Due as usize, self.plan.times[next]);
        y.chain(found).enumerate().for_each(|(i, value)| write(ROWS + i, value));
        self.set(Row::Active, lane, f64::from_bits(u64::MAX));
        self.lanes[lane] = Some(Occupant { name: ready.name, motion, next, steps: 0 });
        self.working += 1;
    }

    /// Makes a step in each lane; returns whether any lane needs attention.
    #[inline]
    pub(super) fn step(&mut self) -> bool {
        if self.is_idle() {
            return false;
        }
        self.kernels.step.run(&mut self.frame);
        self.result(Output::Attention).iter().fold(0, |bits, mask| bits | mask.to_bits()) != 0
    }

    /// Handles the lanes that need attention after the last step.
    pub(super) fn attend(&mut self, members: &mut impl Members<Name = N>) {
        let (attention, broken) = (self.result(Output::Attention), self.result(Output::Broken));
        let (from, to) = (self.result(Output::From), self.frame[Row::Time as usize].0);
        let mut is_inside = false;
        for lane in (0..LANES).filter(|&lane| attention[lane].to_bits() != 0) {
            if broken[lane].to_bits() != 0 {
                self.leave(lane, members);
            } else if let Some(occupant) = &self.lanes[lane] {
                is_inside |= (self.plan.times[occupant.next] - to[lane]) * self.plan.direction < 0.0;
            }
        }
        if is_inside {
            self.expand();
        }
        for lane in (0..LANES).filter(|&lane| attention[lane].to_bits() != 0) {
            self.put_out(lane, (from[lane], to[lane]), members);
        }
    }

    /// Computes the polynomials of the last step.
    fn expand(&mut self) {
        let Some(inside) = &self.kernels.inside else { return };
        let dim = self.kernels.dim;
        let from = self.kernels.step.first_output() + Output::Signed as usize;
        // h, y, ẏ, seven stages; y and ẏ at the end; the numbers of the member.
        let (begin, end) = (1 + 9 * dim, 2 * dim + self.kernels.numbers);
        self.polynomial[..begin].copy_from_slice(&self.frame[from..from + begin]);
        self.polynomial[begin..begin + end].copy_from_slice(&self.frame[ROWS..ROWS + end]);
        inside.polynomial.run(&mut self.polynomial);
        let terms = &self.polynomial[inside.polynomial.first_output()..][..TERMS * dim];
        self.value[..terms.len()].copy_from_slice(terms);
    }

    /// Records the outputs that lie in the last step of a lane, if the lane still has a member.
    fn put_out(&mut self, lane: usize, (from, to): (f64, f64), members: &mut impl Members<Name = N>) {
        let plan = self.plan;
        loop {
            let Some(occupant) = &mut self.lanes[lane] else { return };
            let Some(&t) = plan.times.get(occupant.next) else {
                return self.complete(lane, (from, to), members);
            };
            if (t - to) * plan.direction > 0.0 {
                return self.set(Row::Due, lane, t);
            }
            if t == to {
                self.y.iter_mut().zip(&self.frame[ROWS..]).for_each(|(y, row)| *y = row.0[lane]);
            } else if !self.inside(lane, (t - from) / (to - from)) {
                return self.leave(lane, members);
            }
            let Some(occupant) = &mut self.lanes[lane] else { return };
            occupant.motion.push(t, &self.y);
            occupant.next += 1;
            occupant.steps += std::mem::take(&mut self.frame[Row::Steps as usize].0[lane]) as u64;
        }
    }

    /// Evaluates y at the fraction s of the last step of a lane; returns whether the state is
    /// valid.
    fn inside(&mut self, lane: usize, s: f64) -> bool {
        let Some(inside) = &self.kernels.inside else { return false };
        let terms = TERMS * self.kernels.dim;
        let known = self.polynomial[inside.polynomial.first_output() + terms].0[lane];
        self.value[terms] = Lanes::splat(s);
        inside.value.run(&mut self.value);
        let found = &self.value[inside.value.first_output()..];
        self.y.iter_mut().zip(found).for_each(|(y, row)| *y = row.0[lane]);
        known.to_bits() != 0 && self.y.iter().all(|y| y.is_finite())
    }

    /// Finishes a member that has reached its last output.
    fn complete(&mut self, lane: usize, (from, to): (f64, f64), members: &mut impl Members<Name = N>) {
        let Some(Occupant { name, mut motion, steps, .. }) = self.vacate(lane) else { return };
        let read = |row: Row| self.frame[row as usize].0[lane];
        let tries = read(Row::Tries) as u64;
        let statistics = Statistics {
            steps,
            lane_steps: steps,
            // For each attempt, for the start, and for the length of the first step.
            rhs_evaluations: 12 * tries + 1 + u64::from(self.plan.first.is_none()),
            error_test_failures: tries - steps,
            last_order: 8,
            current_order: 8,
            first_step: read(Row::First),
            last_step: to - from,
            current_step: read(Row::Length) * self.plan.direction,
            current_time: to,
            ..Statistics::default()
        };
        motion.finish(true, statistics);
        members.end(name, Some(motion));
    }

    /// Gives up all members, so that each is integrated alone.
    pub(super) fn clear(&mut self, members: &mut impl Members<Name = N>) {
        (0..LANES).for_each(|lane| self.leave(lane, members));
    }

    /// Gives up a member, so that it is integrated alone; its lane goes on with the values of
    /// another member, if there is one.
    fn leave(&mut self, lane: usize, members: &mut impl Members<Name = N>) {
        let Some(occupant) = self.vacate(lane) else { return };
        if let Some(other) = self.lanes.iter().position(Option::is_some) {
            let rows = ROWS + 2 * self.kernels.dim + self.kernels.numbers;
            self.frame[..rows].iter_mut().for_each(|row| row.0[lane] = row.0[other]);
        }
        self.set(Row::Active, lane, 0.0);
        members.end(occupant.name, None);
    }

    fn vacate(&mut self, lane: usize) -> Option<Occupant<N>> {
        let occupant = self.lanes[lane].take()?;
        self.working -= 1;
        self.set(Row::Active, lane, 0.0);
        Some(occupant)
    }

    fn result(&self, result: Output) -> [f64; LANES] {
        self.frame[self.kernels.step.first_output() + result as usize].0
    }

    fn set(&mut self, row: Row, lane: usize, value: f64) {
        self.frame[row as usize].0[lane] = value;
    }
}
