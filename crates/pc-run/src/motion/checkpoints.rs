//! Checkpoints of a run: written during the integration, and read to resume it.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::num::NonZeroU64;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

use pc_model::{Flow, Model};
use pc_solve::{Checkpoint, CheckpointError, Ending, Options, Resumable, Solution, SolveError, SolveFailure};

use crate::error::RunError;
use crate::files::error::FileError;
use crate::files::target::Target;
use crate::motion::checkpoint_error::CheckpointFileError;
use crate::motion::identity;
use crate::motion::identity::Identity;
use crate::motion::sensitivities::Derivatives;
use crate::observer::Observer;
use crate::plan::Plan;

/// The shortest time between two writes of the file, in multiples of the time that the last write took. This time does
/// not affect the numbers.
const PATIENCE: u32 = 20;

/// The files in which a run keeps its checkpoints, and from which it continues.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CheckpointFiles {
    /// The file in which to keep checkpoints.
    pub checkpoint: Option<PathBuf>,
    /// The number of internal steps from one checkpoint to the next.
    pub every: Option<NonZeroU64>,
    /// The file from which to continue; further checkpoints are kept in it unless another file is named.
    pub resume: Option<PathBuf>,
}

impl CheckpointFiles {
    /// The file in which checkpoints are kept, if any are.
    pub fn path(&self) -> Option<&Path> {
        self.checkpoint.as_deref().or(self.resume.as_deref())
    }
}

/// Checkpoints of one run.
#[derive(Debug)]
pub(crate) struct Checkpoints {
    place: Target,
    every: NonZeroU64,
    identity: Identity,
    /// The checkpoint from which to begin; if there is none, the run begins at the start.
    from: Option<Checkpoint>,
}

impl Checkpoints {
    /// Checkpoints that are written to a file, and possibly continued from one; none if no file is given.
    ///
    /// # Errors
    /// [`CheckpointFileError`]; [`FileError::Place`] if the file cannot be written.
    pub(crate) fn new(
        files: &CheckpointFiles,
        model: &Model,
        plan: &Plan,
    ) -> Result<Option<Checkpoints>, RunError> {
        let Some(path) = files.path() else {
            return if files.every.is_some() { Err(CheckpointFileError::Nowhere.into()) } else { Ok(None) };
        };
        // A file would replace a device.
        let place = Target::regular(path).map_err(|source| FileError::no_place(path, source))?;
        let overwritten = files.checkpoint.as_ref().and_then(|path| beginning(path).ok());
        if overwritten.is_some_and(|bytes| !bytes.is_empty() && !Checkpoint::is_one(&bytes)) {
            return Err(CheckpointFileError::Occupied { path: path.to_owned() }.into());
        }
        let mut identity = identity::of_motion(model, plan);
        identity.insert(1, ("--rows".to_owned(), plan.samples.to_string()));
        let mut checkpoints =
            Checkpoints { place, every: files.every.unwrap_or(Checkpoint::EVERY), identity, from: None };
        if let Some(path) = &files.resume {
            checkpoints.take_up(path, files.every)?;
        }
        checkpoints.identity.push((INTERVAL.to_owned(), checkpoints.every.to_string()));
        Ok(Some(checkpoints))
    }

    /// Reads the checkpoint from which to continue.
    fn take_up(&mut self, path: &Path, every: Option<NonZeroU64>) -> Result<(), CheckpointFileError> {
        let bytes =
            read(path).map_err(|source| CheckpointFileError::Read { path: path.to_owned(), source })?;
        let unusable = |source| CheckpointFileError::Unusable { path: path.to_owned(), source };
        let (checkpoint, label) = Checkpoint::from_bytes(&bytes).map_err(unusable)?;
        let then: Identity = serde_json::from_str(&label).map_err(|_| unusable(CheckpointError::Foreign))?;
        let known = then.iter().find(|(name, _)| name == INTERVAL).and_then(|(_, every)| every.parse().ok());
        self.every = every.or(known).unwrap_or(Checkpoint::EVERY);
        let mut now = self.identity.clone();
        now.push((INTERVAL.to_owned(), self.every.to_string()));
        if let Some(what) = identity::difference(&then, &now) {
            return Err(CheckpointFileError::OtherRun { path: path.to_owned(), what });
        }
        self.from = Some(checkpoint);
        Ok(())
    }

    /// Integrates the motion of `flow` from its start or from the checkpoint, together with its derivatives
    /// if any are requested.
    ///
    /// # Errors
    /// [`FileError::Write`] if the file cannot be written at the beginning; later failures are only
    /// reported.
    pub(crate) fn solve(
        &mut self,
        flow: &Flow,
        (plan, options): (&Plan, &Options),
        derivatives: Option<&mut Derivatives>,
        step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
        observer: &dyn Observer,
    ) -> Result<(Solution, Option<SolveError>), RunError> {
        let from = self.from.take().unwrap_or_else(|| Checkpoint::start(plan.t_start, &flow.start));
        let label = serde_json::to_string(&self.identity);
        let label = label.map_err(|error| FileError::cannot_write(self.place.path(), error.into()))?;
        let write = |checkpoint: &Checkpoint| {
            self.place
                .write(|out| out.write_all(&checkpoint.to_bytes(&label)))
                .map_err(|source| FileError::cannot_write(self.place.path(), source))
        };
        let start = Instant::now();
        write(&from)?;
        let (mut took, mut written) = (start.elapsed(), Instant::now());
        let save = |checkpoint: &Checkpoint, last: bool| {
            if last || written.elapsed() >= took * PATIENCE {
                let start = Instant::now();
                if let Err(error) = write(checkpoint) {
                    observer.trouble(&error);
                }
                (took, written) = (start.elapsed(), Instant::now());
            }
        };
        // The equations as compiled, without memory of earlier evaluations; the checkpoint knows
        // the values of kept integrals after a reset.
        let times = plan.times();
        let (motion, error) = match derivatives {
            Some(derivatives) => {
                derivatives.follow_checkpointed(flow, (&times, options), (from, self.every), save, step)
            }
            None => {
                let parts = || (flow.motion.clone(), flow.events.clone());
                let solved =
                    Resumable::new(parts, from).method(options).every(self.every).run(&times, save, step);
                SolveFailure::split(solved)
            }
        };
        let is_ended = error.as_ref().is_some_and(|error: &SolveError| error.ended().is_some());
        if motion.ending == Some(Ending::Stopped) || is_ended {
            let path = self.place.path().display();
            observer
                .remark(&format!("the same command with --resume {path} continues from the last checkpoint"));
        }
        Ok((motion, error))
    }
}

/// The number of bytes of a file that are enough to tell whether it is a checkpoint.
const BEGINNING: u64 = 256;

fn beginning(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(BEGINNING).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The bytes of a checkpoint, or only the beginning of any other file.
fn read(path: &Path) -> io::Result<Vec<u8>> {
    let bytes = beginning(path)?;
    if Checkpoint::is_one(&bytes) { fs::read(path) } else { Ok(bytes) }
}

/// The name that the number of steps between checkpoints has in an identity.
const INTERVAL: &str = "--every";
