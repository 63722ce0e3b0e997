//! Many motions at once: different initial states and parameter sets, integrated on all cores.
//!
//! Each member has its own vector field and its own solver. A consumer receives the results in the
//! order of the members, so that nothing depends on the number of threads. The failure of a member
//! is a result like any other; the others continue.
//! ```
//! use std::ops::ControlFlow;
//! use pc_solve::{Ensemble, Failure, Options, from_fn};
//!
//! // φ̈ = −sin φ, released at ten angles.
//! let pendulum = |member: u64| {
//!     let field = from_fn(2, |_t, y, ydot| {
//!         ydot[0] = y[1];
//!         ydot[1] = -y[0].sin();
//!         Ok(())
//!     });
//!     Ok::<_, Failure>((field, vec![0.1 * member as f64, 0.0]))
//! };
//! let mut ends = Vec::new();
//! Ensemble::new().solve(0..10, pendulum, 0.0, &[1.0], &Options::default(), |member, motion| {
//!     let motion = motion.expect("pendulums swing");
//!     ends.push((member, motion.state(0)[0]));
//!     ControlFlow::Continue(())
//! })?;
//! assert!(ends.iter().map(|end| end.0).eq(0..10));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::any::Any;
use std::cell::RefCell;
use std::error::Error;
use std::fmt;
use std::num::NonZeroUsize;
use std::ops::{ControlFlow, Range};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::AtomicBool;
use std::thread;

use pc_expr::VectorField;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

use crate::dop853::lockstep::block::WIDTH;
use crate::dop853::lockstep::shelf::Shelf;
use crate::ensemble::ordered::Queue;
use crate::ensemble::stop::Stop;
use crate::integration::integration::Ending;
use crate::integration::trajectory::Trajectory;
use crate::settings::options::Options;
use crate::solve::failure::SolveFailure;
use crate::solve::solution::Solution;
use crate::solve::solve::Solve;

/// The number of members per thread that may have begun ahead of the member to be consumed next.
const WINDOW: usize = 64;

/// The maximum number of threads: more threads would not help, and many more would exhaust the
/// memory and end the program.
const MOST_THREADS: usize = 1024;

/// The stack size of a thread in bytes, the usual size for the main thread: making a member may
/// involve deep recursion.
const STACK: usize = 8 << 20;

/// Options for the computation of an ensemble.
///
/// These options also cache the machine code compiled for the steps of the last members, and share
/// it with their clones.
#[derive(Debug, Clone)]
pub struct Ensemble<'a> {
    threads: NonZeroUsize,
    window: Option<NonZeroUsize>,
    flag: Option<&'a AtomicBool>,
    /// The number of lanes used by a thread.
    pub(super) lanes: usize,
    pub(super) shelf: Shelf,
}

impl Default for Ensemble<'_> {
    fn default() -> Self {
        Ensemble::new()
    }
}

impl<'a> Ensemble<'a> {
    /// A thread for each core.
    pub fn new() -> Self {
        let threads = thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
        Ensemble { threads, window: None, flag: None, lanes: WIDTH, shelf: Shelf::default() }
    }

    /// The number of threads, at most 1024. The results are the same for any number.
    pub fn threads(self, threads: NonZeroUsize) -> Self {
        Ensemble { threads, ..self }
    }

    /// The maximum number of members begun and not yet consumed, by default 64 for each thread.
    /// This limits the memory in use, since results that wait for an earlier one are held in
    /// memory.
    pub fn window(self, members: NonZeroUsize) -> Self {
        Ensemble { window: Some(members), ..self }
    }

    /// The maximum number of members that a thread integrates [together](Ensemble::map_in_lanes),
    /// by default 16, in two vectors of eight. The results are the same for any number.
    pub fn lanes(self, lanes: NonZeroUsize) -> Self {
        Ensemble { lanes: lanes.get(), ..self }
    }

    /// Stops as soon as `flag` is true: members in progress end at their next internal step and are
    /// dropped.
    pub fn stopped_by(self, flag: &'a AtomicBool) -> Self {
        Ensemble { flag: Some(flag), ..self }
    }

    /// Integrates each member as [`solve`](crate::solve()) does, and passes the trajectories to
    /// `consume` in the order of the members.
    ///
    /// `make` returns the vector field of a member and its state at `t0`. `make` is called on the
    /// thread that integrates the member.
    ///
    /// With [`Method::Auto`](crate::Method::Auto) and [`Method::Dop853`](crate::Method::Dop853),
    /// members whose fields are [programs](VectorField::lanes) that do not read the time are
    /// integrated sixteen at a time, each in a lane of a vector, as described for
    /// [`map_in_lanes`](Ensemble::map_in_lanes).
    ///
    /// # Errors
    /// [`EnsembleError`] if threads cannot be started. If a member fails, its error is its result.
    pub fn solve<F, E>(
        &self,
        members: Range<u64>,
        make: impl Fn(u64) -> Result<(F, Vec<f64>), E> + Sync,
        t0: f64,
        times: &[f64],
        options: &Options,
        mut consume: impl FnMut(u64, Result<Trajectory, MemberError<E>>) -> ControlFlow<()>,
    ) -> Result<Ending, EnsembleError>
    where
        F: VectorField,
        E: Send,
    {
        // None if the member was stopped.
        let alone = |made: Result<(F, Vec<f64>), MemberError<E>>, stop: &Stop<'_>| {
            let reached = RefCell::new(None);
            let solved = caught(|| {
                let (field, start) = made?;
                let observe = |t, y: &[f64]| {
                    keep(&mut reached.borrow_mut(), t, y);
                    if stop.requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
                };
                let solved = Solve::new(field, t0, &start).method(options).run_observed(times, observe);
                let failed = |failure: Box<SolveFailure<Solution>>| failure.map(|reached| reached.trajectory);
                solved
                    .map(|solution| solution.trajectory)
                    .map_err(|failure| MemberError::Solve(Box::new(failed(failure))))
            });
            match solved {
                Ok(Ok(motion)) if !motion.is_complete() => None,
                Ok(solved) => Some(solved),
                Err(message) => Some(Err(MemberError::Panic { message, reached: reached.into_inner() })),
            }
        };
        let make = |member| make(member).map_err(MemberError::Make);
        let begin = |member| {
            let mut made = make(member);
            let lane = made.as_mut().ok().and_then(|(field, start)| {
                let lanes = field.lanes().filter(|_| field.breaks().is_empty());
                lanes.map(|lanes| (lanes, start.clone()))
            });
            (made, lane)
        };
        let consume = |member, solved: Result<Option<_>, Panicked>| match solved {
            Ok(Some(solved)) => consume(member, solved),
            Ok(None) => ControlFlow::Break(()),
            Err(Panicked { message }) => consume(member, Err(MemberError::Panic { message, reached: None })),
        };
        let in_lane = |_, _, motion| Some(Ok(motion));
        let alone = |_, made, stop: &Stop<'_>| alone(made, stop);
        self.map_in_lanes(members, (t0, times, options), begin, in_lane, alone, consume)
    }

    /// Does any `work` for each member and passes its result to `consume` in the order of the
    /// members.
    ///
    /// The work should check [`Stop`] regularly, and end when that is requested. `consume` is
    /// called on this thread.
    ///
    /// # Errors
    /// [`EnsembleError`] if threads cannot be started. A panic of the work is the result of its
    /// member.
    pub fn map<T: Send>(
        &self,
        members: Range<u64>,
        work: impl Fn(u64, &Stop<'_>) -> T + Sync,
        mut consume: impl FnMut(u64, Result<T, Panicked>) -> ControlFlow<()>,
    ) -> Result<Ending, EnsembleError> {
        let worker = |queue: &Queue<'_, Result<T, Panicked>>, stop: &Stop<'_>| {
            while let Some(member) = queue.begin() {
                let result = caught(|| work(member, stop)).map_err(|message| Panicked { message });
                queue.finish(member, result);
            }
        };
        self.of_items(members, self.items_in_window(), worker, &mut consume)
    }

    /// The number of worker threads.
    pub(super) fn workers(&self) -> usize {
        self.threads.get().min(MOST_THREADS)
    }

    /// The maximum number of members begun and not yet consumed.
    pub(super) fn items_in_window(&self) -> u64 {
        self.window.map_or(WINDOW.saturating_mul(self.workers()), NonZeroUsize::get) as u64
    }

    /// Runs a worker on each thread; workers take items from a queue and return their results,
    /// which are consumed in the order of the items. At most `window` items are begun and not yet
    /// consumed.
    pub(super) fn of_items<R: Send>(
        &self,
        items: Range<u64>,
        window: u64,
        worker: impl Fn(&Queue<'_, R>, &Stop<'_>) + Sync,
        consume: &mut impl FnMut(u64, R) -> ControlFlow<()>,
    ) -> Result<Ending, EnsembleError> {
        let threads = self.workers();
        let stopped = AtomicBool::new(false);
        let stop = Stop { own: &stopped, flag: self.flag };
        let queue = Queue::new(items.clone(), window, &stop);
        let consume_all = |pool: &ThreadPool| {
            pool.in_place_scope(|scope| {
                // One worker for each thread; work that is itself parallel cannot start another.
                scope.spawn_broadcast(|_, _| {
                    // What panics outside the work of a member ends all; the scope passes it on.
                    let _breaking = queue.breaking();
                    worker(&queue, &stop);
                });
                // Ends the threads however this one ends.
                let _closing = queue.closing();
                for item in items {
                    let Some(result) = queue.take(item) else { return Ending::Stopped };
                    if consume(item, result).is_break() {
                        return Ending::Stopped;
                    }
                }
                Ending::Completed
            })
        };
        thread::scope(|scope| {
            let mut handles = Vec::with_capacity(threads);
            let pool = ThreadPoolBuilder::new().num_threads(threads).spawn_handler(|worker| {
                let thread = thread::Builder::new().stack_size(STACK);
                handles.push(thread.spawn_scoped(scope, || worker.run())?);
                Ok(())
            });
            let pool = pool.build()?;
            let ending = consume_all(&pool);
            drop(pool);
            // The scope waits for their work only, but the caller may unload this library: wait
            // until they end.
            for handle in handles {
                let joined = handle.join();
                debug_assert!(joined.is_ok(), "what panics is caught");
            }
            Ok(ending)
        })
    }
}

/// Why a member of an ensemble has no complete trajectory.
#[derive(Debug)]
#[non_exhaustive]
pub enum MemberError<E> {
    /// The member could not be made.
    Make(E),
    /// The integration of the member failed; this holds the outputs reached before the failure.
    Solve(Box<SolveFailure>),
    /// The vector field of the member panicked.
    Panic {
        /// The message of the panic.
        message: String,
        /// The time and state (t, y) at the end of the last internal step, if there was one.
        reached: Option<(f64, Vec<f64>)>,
    },
}

impl<E> MemberError<E> {
    /// The last time and state reached, (t, y), if the integration had begun.
    pub fn reached(&self) -> Option<(f64, &[f64])> {
        match self {
            MemberError::Make(_) => None,
            MemberError::Solve(failure) => failure.error.reached(),
            MemberError::Panic { reached, .. } => reached.as_ref().map(|(t, y)| (*t, &y[..])),
        }
    }
}

impl<E: fmt::Display> fmt::Display for MemberError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MemberError::Make(error) => error.fmt(f),
            MemberError::Solve(failure) => failure.fmt(f),
            MemberError::Panic { message, .. } => write!(f, "the vector field panicked: {message}"),
        }
    }
}

impl<E: Error> Error for MemberError<E> {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            MemberError::Make(error) => error.source(),
            MemberError::Solve(failure) => failure.source(),
            MemberError::Panic { .. } => None,
        }
    }
}

/// The work of a member panicked.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("panicked: {message}")]
pub struct Panicked {
    /// The message of the panic.
    pub message: String,
}

/// Why an ensemble was not computed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EnsembleError {
    /// The threads cannot be started.
    #[error("cannot start the threads")]
    Threads(#[from] ThreadPoolBuildError),
}

/// The result of `compute`, or the message of its panic.
pub(super) fn caught<T>(compute: impl FnOnce() -> T) -> Result<T, String> {
    // Unwind safe: the data of the computation are dropped with it.
    catch_unwind(AssertUnwindSafe(compute)).map_err(|panic: Box<dyn Any + Send>| {
        let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
        text.unwrap_or_else(|| "a panic without a message".to_owned())
    })
}

/// Overwrites the last (t, y) without allocating again.
fn keep(last: &mut Option<(f64, Vec<f64>)>, t: f64, y: &[f64]) {
    let (time, state) = last.get_or_insert_with(|| (t, y.to_vec()));
    *time = t;
    state.copy_from_slice(y);
}
