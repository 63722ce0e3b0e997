//! Members that are about to begin.

use std::ops::Range;

use pc_expr::{LANES, LaneField, Lanes};

use super::kernels::Kernels;
use super::members::{Members, Source};

/// Waiting members with their initial rates and step lengths, which are computed for eight members
/// at once.
pub(super) struct Waiting<'a, N> {
    kernels: &'a Kernels,
    names: [Option<N>; LANES],
    /// The start of each member, in the lane of the member.
    frame: Vec<Lanes>,
}

/// A member that can begin, and the lane that holds its start.
pub(super) struct Ready<N> {
    pub(super) name: N,
    pub(super) lane: usize,
}

impl<'a, N> Waiting<'a, N> {
    pub(super) fn new(kernels: &'a Kernels) -> Self {
        Waiting { kernels, names: std::array::from_fn(|_| None), frame: kernels.start.frame() }
    }

    /// The next waiting member, or a new one. While lanes are free, new members are taken from any
    /// source; otherwise only from those that this thread already has, so as not to take work away
    /// from other threads.
    pub(super) fn next(
        &mut self,
        free: usize,
        is_idle: bool,
        members: &mut impl Members<Name = N>,
    ) -> Option<Ready<N>> {
        loop {
            if let Some(lane) = self.names.iter().position(Option::is_some) {
                return self.names[lane].take().map(|name| Ready { name, lane });
            }
            if !self.gather(free, is_idle, members) {
                return None;
            }
        }
    }

    /// Takes new members; returns false if there are none.
    fn gather(&mut self, free: usize, is_idle: bool, members: &mut impl Members<Name = N>) -> bool {
        let mut count = 0;
        while count < LANES {
            let from = match count {
                0 if is_idle => Source::Awaited,
                _ if count < free => Source::Available,
                _ => Source::AtHand,
            };
            let Some((name, field, y)) = members.next(from) else { break };
            if self.accepts(&field, &y) {
                self.place(count, &field, &y);
                self.names[count] = Some(name);
                count += 1;
            } else {
                members.end(name, None);
            }
        }
        if count == 0 {
            return false;
        }
        self.kernels.start.run(&mut self.frame);
        let well = self.frame[self.after() + 1];
        for (name, well) in self.names.iter_mut().zip(well.0) {
            if well.to_bits() == 0
                && let Some(name) = name.take()
            {
                members.end(name, None);
            }
        }
        true
    }

    /// Whether the kernels apply to a member and it can begin.
    fn accepts(&self, field: &LaneField, y: &[f64]) -> bool {
        let watched = &field.watched;
        y.len() == self.kernels.dim
            && field.parameters.len() == self.kernels.parameters
            && watched.smallest > watched.vanishing * watched.largest
    }

    /// Writes the state and the parameters of a member to a lane; the state and the parameters of
    /// the first member are written to all lanes.
    fn place(&mut self, lane: usize, field: &LaneField, y: &[f64]) {
        let watched = [field.watched.smallest, field.watched.largest];
        let numbers = y.iter().chain(&field.parameters).chain(&watched);
        for (row, &value) in self.frame.iter_mut().zip(numbers) {
            match lane {
                0 => *row = Lanes::splat(value),
                lane => row.0[lane] = value,
            }
        }
    }

    /// The values y, then ẏ and the constants, of the member in a lane.
    pub(super) fn columns(&self, lane: usize) -> (impl Iterator<Item = f64>, impl Iterator<Item = f64>) {
        let column = |rows: Range<usize>| self.frame[rows].iter().map(move |row| row.0[lane]);
        (column(0..self.kernels.dim), column(self.kernels.start.first_output()..self.after()))
    }

    /// The length of the first step of the member in a lane.
    pub(super) fn length(&self, lane: usize) -> f64 {
        self.frame[self.after()].0[lane]
    }

    /// The row after ẏ and the constants.
    fn after(&self) -> usize {
        self.kernels.start.first_output() + self.kernels.dim + self.kernels.numbers
    }
}
