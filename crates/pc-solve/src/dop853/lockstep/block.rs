//! The members in the lanes of one thread.

use pc_expr::LANES;

use super::kernels::Kernels;
use super::members::Members;
use super::octet::Octet;
use super::plan::Plan;
use super::waiting::Waiting;

/// The number of vectors whose steps alternate: a step ends with a chain of dependent operations,
/// and meanwhile the processor begins the step of the other vector.
const OCTETS: usize = 2;
/// The maximum number of members in a block.
pub(crate) const WIDTH: usize = OCTETS * LANES;
/// The number of steps between two checks of whether to go on.
const UNWATCHED: usize = 64;

/// Lanes that integrate members with the same program.
pub(crate) struct Block<'a, N> {
    octets: Vec<Octet<'a, N>>,
    waiting: Waiting<'a, N>,
    plan: &'a Plan,
}

impl<'a, N> Block<'a, N> {
    /// A block that uses `width` lanes, at most [`WIDTH`].
    pub(crate) fn new(plan: &'a Plan, kernels: &'a Kernels, width: usize) -> Self {
        let width = width.clamp(1, WIDTH);
        let octets = (0..width).step_by(LANES).map(|first| Octet::new(plan, kernels, width - first));
        Block { octets: octets.collect(), waiting: Waiting::new(kernels), plan }
    }

    /// Integrates members until there are no more.
    pub(crate) fn run(&mut self, members: &mut impl Members<Name = N>) {
        let mut unwatched = 0;
        while self.fill(members) {
            while unwatched < UNWATCHED {
                unwatched += 1;
                let calls = self.octets.iter_mut().fold(false, |calls, octet| octet.step() | calls);
                if calls {
                    self.octets.iter_mut().for_each(|octet| octet.attend(members));
                    break;
                }
            }
            if unwatched >= UNWATCHED {
                unwatched = 0;
                if self.plan.deadline.as_ref().is_some_and(|deadline| deadline.passed().is_some()) {
                    // Integrated alone, each reports the deadline.
                    self.octets.iter_mut().for_each(|octet| octet.clear(members));
                }
            }
        }
    }

    /// Assigns members to free lanes; returns whether any lane has a member.
    fn fill(&mut self, members: &mut impl Members<Name = N>) -> bool {
        if members.is_stopped() {
            return false;
        }
        let mut free: usize = self.octets.iter().map(Octet::free).sum();
        let mut is_idle = self.octets.iter().all(Octet::is_idle);
        for octet in &mut self.octets {
            while let Some(lane) = octet.free_lane() {
                let Some(ready) = self.waiting.next(free, is_idle, members) else { return !is_idle };
                octet.begin(lane, ready, &self.waiting);
                free -= 1;
                is_idle = false;
            }
        }
        !is_idle
    }
}
