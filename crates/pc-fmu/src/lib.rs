//! A model as a Functional Mock-up Unit (FMU), for Model Exchange and Co-Simulation, in FMI 2.0 and 3.0.
//!
//! A [`Model`](pc_model::Model) and its [`Assembly`](pc_model::Assembly) become an [`Fmu`]: `modelDescription.xml`, sources in
//! C that depend on nothing, and on request a binary for this machine. The equations are those of `pc emit`; around them stands
//! a runtime of a thousand lines of C, `src/c`: events with their resets, directional derivatives, and for Co-Simulation an
//! integrator. `docs/fmu.md` says what an FMU has of a model.
//!
//! Read `options` and `error`; `contents` with `events`, what an FMU is made of; `experiment`, how it integrates; then what is written:
//! `layout`, a header in C, `dependencies`, `units` and `description`, the XML, whose elements `xml` writes, and `token`, which binds
//! them; `platform`, the compiler; `fmu` puts them together. In `c`: `instance.h`, `inputs.h`, `state.h`, `events.h`, `variables.h`,
//! `derivatives.h`, then `step.h` and `advance.h`, the integration, and `fmi2.c` or `fmi3.c` with its headers, the interface.
//!
//! # Around it
//!
//! Below: [`pc_model`], the model. Above: [pc-cli](../pc_cli/index.html), where it is `pc emit --fmu`.

mod contents;
mod dependencies;
mod description;
mod error;
mod events;
mod experiment;
mod fmu;
mod layout;
mod options;
mod platform;
mod token;
mod units;
mod xml;

pub use error::FmuError;
pub use fmu::Fmu;
pub use options::{FmiVersion, FmuOptions, FmuSolver};
