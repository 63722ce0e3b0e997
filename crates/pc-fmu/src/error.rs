//! What can go wrong.

use std::io;
use std::path::PathBuf;

use pc_model::ModelError;

/// An error of an export.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FmuError {
    /// Something wrong with the model, or an equation that it does not have.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A reset that needs numbers that C does not compute.
    #[error(
        "the event `{event}` resets velocities or coordinates, which its constraints then move to the nearest ones they allow: an FMU \
         does not do that; state the constraints as quasi-velocities that vanish, or reset first-order states only"
    )]
    ResetUnderConstraints {
        /// The event.
        event: String,
    },
    /// Joints with rigid stops or stiction, or bodies that roll where dry friction suffices.
    #[error(
        "an FMU computes no impacts on rigid stops, no stiction, and no rolling by dry friction: give the joints `stop_stiffness` \
         in place of `restitution`, leave `stiction` out, and give the friction of contacts `creep`"
    )]
    HeldAtRest,
    /// A form without some of the coordinates.
    #[error("the events use all coordinates, but this form has fewer: use another form")]
    EventsNeedCoordinates,
    /// Forces that are computed by a callback.
    #[error(
        "the external force on `{on}` is computed by the program that holds the model: make it an input, in [inputs]"
    )]
    ExternalForce {
        /// What it acts on.
        on: String,
    },
    /// A method with fixed steps whose length is none.
    #[error("a step cannot have the length {step}: it has to be positive")]
    Step {
        /// The length.
        step: f64,
    },
    /// A file that could not be made or read on the way.
    #[error("cannot write {}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The archive or its descriptions could not be written.
    #[error("the FMU could not be put together")]
    Archive(#[source] io::Error),
    /// There is no C compiler.
    #[error(
        "there is no C compiler `{compiler}` to build the FMU for this machine: install one, name it by the environment variable CC, \
         or write the sources alone, which importers compile"
    )]
    NoCompiler {
        /// As it was called.
        compiler: String,
        /// Why it could not be called.
        source: io::Error,
    },
    /// The compiler refuses the sources.
    #[error("`{command}` failed:\n{output}")]
    Compiler {
        /// The command.
        command: String,
        /// What it said.
        output: String,
    },
    /// A machine for which FMI has no name.
    #[error(
        "FMI has no name for binaries of {system} on {processor}: write the sources alone, which importers compile"
    )]
    Platform {
        /// The operating system.
        system: &'static str,
        /// The processor.
        processor: &'static str,
    },
}

impl FmuError {
    /// Whether it lies in the model, and not in the machine or in what was asked for.
    pub fn is_of_model(&self) -> bool {
        match self {
            FmuError::Model(_)
            | FmuError::ResetUnderConstraints { .. }
            | FmuError::HeldAtRest
            | FmuError::EventsNeedCoordinates
            | FmuError::ExternalForce { .. } => true,
            FmuError::Step { .. }
            | FmuError::Io { .. }
            | FmuError::Archive(_)
            | FmuError::NoCompiler { .. }
            | FmuError::Compiler { .. }
            | FmuError::Platform { .. } => false,
        }
    }
}
