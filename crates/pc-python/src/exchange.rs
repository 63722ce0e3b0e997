//! Models from other formats, and for other programs.

use std::io::Cursor;
use std::io::Write;
use std::path::{Path, PathBuf};

use pc_fmu::{FmiVersion, Fmu, FmuOptions, FmuSolver};
use pc_model::import::{Directories, ImportOptions, model_of_robot};
use pc_model::{Source, deep};
use pc_run::files::error::FileError;
use pc_run::files::target::Target;
use pc_verify::Outlet;
use pyo3::prelude::*;

use crate::error::Error;
use crate::model::{ModelCore, renewed, variables, vouched};
use crate::task::attended;

/// The model text of a robot in URDF, and remarks on what was left out of it.
#[pyfunction]
pub(crate) fn text_of_urdf(
    name: String,
    urdf: String,
    floating: bool,
    fix_massless: bool,
) -> Result<(String, Vec<String>), Error> {
    let path = Path::new(&name);
    let directories = Some(Directories::of_files(path, path));
    let options = ImportOptions { floating, fix_massless, directories, ..ImportOptions::default() };
    Ok(model_of_robot(&Source::new(name.as_str(), urdf), options)?)
}

/// How an FMU integrates on its own, given by the name of the method and, for fixed steps, their length.
fn solver(name: &str, step: Option<f64>) -> Result<FmuSolver, Error> {
    match name {
        "dop853" => Ok(FmuSolver::Dop853),
        "radau5" => Ok(FmuSolver::Radau5),
        "rk4" => Ok(FmuSolver::RungeKutta4 { step: step.unwrap_or(f64::NAN) }),
        _ => Err(Error::Choice {
            what: "the solver",
            given: name.to_owned(),
            known: vec!["dop853", "radau5", "rk4"],
        }),
    }
}

#[pymethods]
impl ModelCore {
    /// Writes the model as an FMU, either completely or not at all, and returns remarks on it.
    #[expect(clippy::too_many_arguments, reason = "those of Python")]
    fn write_fmu(
        &self,
        py: Python<'_>,
        path: PathBuf,
        name: String,
        version: u8,
        form: &str,
        solves: Option<(String, Option<f64>)>,
        compiled: bool,
    ) -> PyResult<Vec<String>> {
        let form = variables(form)?;
        if form.has_momenta() {
            let why = "FMUs are in velocities; use poincare, reduced, orthonormal, voronets or hamel";
            return Err(Error::Unsupported { what: "an FMU in this form", why }.into());
        }
        let version = match version {
            2 => FmiVersion::V2,
            3 => FmiVersion::V3,
            other => {
                let known = vec!["2", "3"];
                return Err(Error::Choice { what: "the version", given: other.to_string(), known }.into());
            }
        };
        let mut options = FmuOptions::new(version, name);
        if let Some((name, step)) = solves {
            options = options.solver(solver(&name, step)?);
        }
        let (mut model, verify) = (self.model.clone(), self.verify);
        let cancel = renewed(&mut model);
        let work = move || {
            deep(|| {
                let place = Target::regular(&path).map_err(|source| FileError::no_place(&path, source))?;
                let graph = model.graph();
                let assembly = model.assemble(&graph)?;
                if verify {
                    vouched(&model, &assembly, Outlet::Source(form))?;
                }
                let mut fmu = Fmu::new(&model, &assembly, form, &options)?;
                let notes = fmu.notes().to_vec();
                if compiled {
                    fmu = fmu.compiled()?;
                }
                let mut archive = Cursor::new(Vec::new());
                let unwritten = |source| FileError::cannot_write(&path, source);
                fmu.write(&mut archive).map_err(unwritten)?;
                place.write(|out| out.write_all(archive.get_ref())).map_err(unwritten)?;
                Ok(notes)
            })
        };
        attended(py, &cancel, |_| Ok(()), work)
    }
}
