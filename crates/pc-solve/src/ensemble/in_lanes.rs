//! Integration of members of an ensemble together, in the lanes of vectors.

use std::collections::VecDeque;
use std::ops::{ControlFlow, Range};
use std::sync::Arc;

use pc_expr::LaneField;

use crate::dop853::lockstep::block::Block;
use crate::dop853::lockstep::kernels::Kernels;
use crate::dop853::lockstep::members::{Members, Source};
use crate::dop853::lockstep::plan::Plan;
use crate::dop853::lockstep::shelf::Shelf;
use crate::ensemble::ensemble::{Ensemble, EnsembleError, Panicked, caught};
use crate::ensemble::ordered::Queue;
use crate::ensemble::stop::Stop;
use crate::integration::integration::Ending;
use crate::integration::trajectory::Trajectory;
use crate::settings::options::Options;

/// The maximum number of members in a group, which is handed out as a whole to reduce the overhead.
const GROUP: u64 = 64;

impl Ensemble<'_> {
    /// Integrates members together in vector lanes, where possible, and passes their results to
    /// `consume` in order.
    ///
    /// `begin` returns any data that belong to a member and, if lanes can integrate it, its
    /// [field](pc_expr::VectorField::lanes) and its state at t₀. `in_lane` turns its complete
    /// motion into its result. `alone` integrates members that lanes do not support, or whose
    /// motion was not completed in a lane; it should check [`Stop`] regularly. All three closures
    /// are called on the thread that integrates the member.
    ///
    /// Lanes are used with [`Method::Auto`](crate::Method::Auto) and
    /// [`Method::Dop853`](crate::Method::Dop853), for fields that do not read time, without
    /// inequalities, a minimum step or a stop time before the last output. `begin` must not offer lanes a field with
    /// events or breaks. Lanes use the method of [`Dop853`](crate::Dop853), but with fused
    /// multiply-adds, so that the last digits differ. With `Auto` a member that turns out to be
    /// stiff is integrated `alone`; `Dop853` does not look for stiffness here. Each lane performs
    /// the same operations as it would alone: results depend neither on the number of threads or
    /// lanes nor on the other members.
    ///
    /// # Errors
    /// [`EnsembleError`] if threads cannot be started. If the work for a member panics, the panic
    /// is the result of the member.
    pub fn map_in_lanes<C, T: Send>(
        &self,
        members: Range<u64>,
        (t0, times, options): (f64, &[f64], &Options),
        begin: impl Fn(u64) -> (C, Option<(LaneField, Vec<f64>)>) + Sync,
        in_lane: impl Fn(u64, C, Trajectory) -> T + Sync,
        alone: impl Fn(u64, C, &Stop<'_>) -> T + Sync,
        mut consume: impl FnMut(u64, Result<T, Panicked>) -> ControlFlow<()>,
    ) -> Result<Ending, EnsembleError> {
        let Some(plan) = Plan::new(t0, times, options) else {
            return self.map(members, |member, stop| alone(member, begin(member).0, stop), consume);
        };
        let count = members.end.saturating_sub(members.start);
        let window = self.items_in_window();
        // Several groups for each thread, all of which fit in the window.
        let room = window.min(count / 2) / self.workers() as u64;
        let size = (room / 2).clamp(1, GROUP);
        let groups = 0..count.div_ceil(size);
        let of_group =
            |group: u64| members.start + group * size..(members.start + (group + 1) * size).min(members.end);
        // With few members each thread takes its share at most.
        let fair = count.div_ceil(self.workers() as u64);
        let width = self.lanes.min(usize::try_from(fair).unwrap_or(usize::MAX));
        let worker = |queue: &Queue<'_, Group<T>>, stop: &Stop<'_>| {
            let mut supply = Supply {
                queue,
                stop,
                plan: &plan,
                shelf: &self.shelf,
                kernels: None,
                of_group: &of_group,
                begin: &begin,
                in_lane: &in_lane,
                alone: &alone,
                open: VecDeque::new(),
                held: None,
            };
            while let Some(kernels) = supply.prepare() {
                Block::new(&plan, &kernels, width).run(&mut supply);
            }
            supply.give_up();
        };
        let mut consume_group = |group: u64, results: Group<T>| {
            for (member, result) in of_group(group).zip(results) {
                // None if the ensemble was stopped.
                let Some(result) = result else { return ControlFlow::Break(()) };
                consume(member, result)?;
            }
            ControlFlow::Continue(())
        };
        self.of_items(groups, (window / size).max(1), worker, &mut consume_group)
    }
}

/// The results of a group, as far as these are known.
type Group<T> = Vec<Option<Result<T, Panicked>>>;

/// A group in progress.
struct Open<T> {
    number: u64,
    members: Range<u64>,
    /// The next member to begin.
    next: u64,
    results: Group<T>,
    missing: usize,
}

/// The supply of members for the lanes of a thread.
struct Supply<'a, 'q, 's, C, T, G, B, L, A> {
    queue: &'a Queue<'q, Group<T>>,
    stop: &'a Stop<'s>,
    plan: &'a Plan,
    /// Kernels compiled by any thread.
    shelf: &'a Shelf,
    kernels: Option<Arc<Kernels>>,
    of_group: &'a G,
    begin: &'a B,
    in_lane: &'a L,
    alone: &'a A,
    /// Groups in progress; only the last may have members that have not begun.
    open: VecDeque<Open<T>>,
    /// A member that was begun and waits for a block with its program.
    held: Option<Begun<C>>,
}

/// A member that has begun.
type Begun<C> = (u64, C, LaneField, Vec<f64>);

impl<C, T, G, B, L, A> Supply<'_, '_, '_, C, T, G, B, L, A>
where
    G: Fn(u64) -> Range<u64>,
    B: Fn(u64) -> (C, Option<(LaneField, Vec<f64>)>),
    L: Fn(u64, C, Trajectory) -> T,
    A: Fn(u64, C, &Stop<'_>) -> T,
{
    /// The kernels for the next member in a lane; none if there is no member left, or if a stop is
    /// requested.
    fn prepare(&mut self) -> Option<Arc<Kernels>> {
        while !self.stop.requested()
            && let Some((member, known, field, start)) =
                self.held.take().or_else(|| self.first(Source::Awaited))
        {
            match self.kernels_of(&field) {
                Some(kernels) => {
                    self.kernels = Some(Arc::clone(&kernels));
                    self.held = Some((member, known, field, start));
                    return Some(kernels);
                }
                None => self.do_alone(member, known),
            }
        }
        None
    }

    /// The next member, with any program, that a lane can integrate.
    fn first(&mut self, from: Source) -> Option<Begun<C>> {
        while !self.stop.requested() {
            let member = self.next_member(from)?;
            match caught(|| (self.begin)(member)) {
                Ok((known, Some((field, start)))) => return Some((member, known, field, start)),
                Ok((known, None)) => self.do_alone(member, known),
                Err(message) => self.store(member, Err(Panicked { message })),
            }
        }
        None
    }

    /// The next member of the groups in progress, or of a new one.
    fn next_member(&mut self, from: Source) -> Option<u64> {
        let has_more = |open: &Open<T>| open.next < open.members.end;
        if !self.open.back().is_some_and(has_more) {
            let number = match from {
                Source::AtHand => return None,
                Source::Available => self.queue.begin_if_room(),
                Source::Awaited => self.queue.begin(),
            }?;
            let members = (self.of_group)(number);
            let missing = (members.end - members.start) as usize;
            let results = (0..missing).map(|_| None).collect();
            self.open.push_back(Open { number, next: members.start, members, results, missing });
        }
        let open = self.open.back_mut()?;
        open.next += 1;
        Some(open.next - 1)
    }

    fn kernels_of(&mut self, field: &LaneField) -> Option<Arc<Kernels>> {
        if let Some(kernels) = self.kernels.as_ref().filter(|kernels| kernels.are_of(field)) {
            return Some(Arc::clone(kernels));
        }
        self.shelf.kernels(field, self.plan)
    }

    fn do_alone(&mut self, member: u64, known: C) {
        let result = caught(|| (self.alone)(member, known, self.stop));
        self.store(member, result.map_err(|message| Panicked { message }));
    }

    /// Keeps the result of a member, and delivers its group when it is complete.
    fn store(&mut self, member: u64, result: Result<T, Panicked>) {
        let Some(place) = self.open.iter().position(|open| open.members.contains(&member)) else { return };
        let open = &mut self.open[place];
        open.results[(member - open.members.start) as usize] = Some(result);
        open.missing -= 1;
        if open.missing == 0
            && let Some(open) = self.open.remove(place)
        {
            self.queue.finish(open.number, open.results);
        }
    }

    /// Delivers the groups in progress, although they are incomplete, and ends.
    fn give_up(&mut self) {
        for open in self.open.drain(..) {
            self.queue.finish(open.number, open.results);
        }
        self.queue.leave();
    }
}

impl<C, T, G, B, L, A> Members for Supply<'_, '_, '_, C, T, G, B, L, A>
where
    G: Fn(u64) -> Range<u64>,
    B: Fn(u64) -> (C, Option<(LaneField, Vec<f64>)>),
    L: Fn(u64, C, Trajectory) -> T,
    A: Fn(u64, C, &Stop<'_>) -> T,
{
    type Name = (u64, C);

    fn next(&mut self, from: Source) -> Option<((u64, C), LaneField, Vec<f64>)> {
        let (member, known, field, start) = match self.held.take() {
            Some(begun) => begun,
            None => self.first(from)?,
        };
        if self.kernels.as_ref().is_some_and(|kernels| kernels.are_of(&field)) {
            return Some(((member, known), field, start));
        }
        self.held = Some((member, known, field, start));
        None
    }

    fn end(&mut self, (member, known): (u64, C), motion: Option<Trajectory>) {
        match motion {
            None => self.do_alone(member, known),
            Some(motion) => {
                let result = caught(|| (self.in_lane)(member, known, motion));
                self.store(member, result.map_err(|message| Panicked { message }));
            }
        }
    }

    fn is_stopped(&self) -> bool {
        self.stop.requested()
    }
}
