//! An FMU: its files, and the archive of them.

use std::io::{self, Seek, Write};

use pc_expr::Language;
use pc_mech::EmitOptions;
use pc_model::{Assembly, Model, Variables};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::contents::Contents;
use crate::description;
use crate::description::{Title, build_description, model_description};
use crate::error::FmuError;
use crate::experiment::Experiment;
use crate::layout::layout;
use crate::options::{FmiVersion, FmuOptions};
use crate::platform;
use crate::token::token;
use crate::units::Units;

/// What is the same for all models.
const RUNTIME: [(&str, &str); 9] = [
    ("instance.h", include_str!("c/instance.h")),
    ("inputs.h", include_str!("c/inputs.h")),
    ("state.h", include_str!("c/state.h")),
    ("events.h", include_str!("c/events.h")),
    ("variables.h", include_str!("c/variables.h")),
    ("derivatives.h", include_str!("c/derivatives.h")),
    ("step.h", include_str!("c/step.h")),
    ("dop853.h", include_str!("c/dop853.h")),
    ("advance.h", include_str!("c/advance.h")),
];

/// The functions of FMI 2.0.
const FMI2: [(&str, &str); 1] = [("fmi2.c", include_str!("c/fmi2.c"))];

/// Those of FMI 3.0; the first file is compiled.
const FMI3: [(&str, &str); 3] = [
    ("fmi3.c", include_str!("c/fmi3.c")),
    ("fmi3_types.h", include_str!("c/fmi3_types.h")),
    ("fmi3_none.h", include_str!("c/fmi3_none.h")),
];

/// A model as a Functional Mock-up Unit, for Model Exchange and Co-Simulation.
///
/// ```
/// use pc_fmu::{FmiVersion, Fmu, FmuOptions};
/// use pc_model::{Builtin, Model, Variables};
///
/// let model = Model::new(Builtin::named("bouncing-ball").unwrap().document()?);
/// let graph = model.graph();
/// let options = FmuOptions::new(FmiVersion::V3, "ball");
/// let fmu = Fmu::new(&model, &model.assemble(&graph)?, Variables::QuasiVelocities, &options)?;
/// assert!(fmu.model_description().contains("<Float64 name=\"y&apos;\" valueReference=\"2\""));
/// assert!(fmu.files().iter().any(|(name, _)| name == "sources/ball_model.c"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Fmu {
    version: FmiVersion,
    identifier: String,
    files: Vec<(String, Vec<u8>)>,
    /// The names of the files that are compiled.
    sources: Vec<String>,
    notes: Vec<String>,
}

impl Fmu {
    /// That of the equations of a model in these variables, with its sources and without a binary.
    ///
    /// # Errors
    /// [`FmuError`] for equations in momenta, and for what an FMU cannot do: resets under constraints, external forces.
    pub fn new(
        model: &Model,
        assembly: &Assembly<'_>,
        variables: Variables,
        options: &FmuOptions,
    ) -> Result<Fmu, FmuError> {
        let contents = Contents::new(model, assembly, variables)?;
        let experiment = Experiment::new(model, assembly, variables, options)?;
        let identifier = Language::C.identifiers(&[&options.name], &[]).remove(0);
        let prefix = format!("{identifier}_model");
        let emit = EmitOptions::new(Language::C, prefix.as_str()).title(model.title());
        let emitted = assembly.placed(contents.equations.emit_with(&emit, &contents.functions()))?;
        let interface = match options.version {
            FmiVersion::V2 => FMI2.as_slice(),
            FmiVersion::V3 => FMI3.as_slice(),
        };
        let mut sources = vec![interface[0].0.to_owned()];
        let mut files: Vec<(String, Vec<u8>)> = Vec::new();
        for file in emitted {
            sources.extend(Some(file.name.clone()).filter(|name| name.ends_with(".c")));
            files.push((file.name, file.text.into_bytes()));
        }
        files.extend(
            interface.iter().chain(&RUNTIME).map(|&(name, text)| (name.to_owned(), text.as_bytes().to_vec())),
        );

        let document = model.document();
        let description = document.model.description.as_ref().map_or("", |text| text.value.as_str());
        let description = std::iter::once(description).chain(contents.notes.iter().map(String::as_str));
        let description = description.filter(|text| !text.is_empty()).collect::<Vec<_>>().join(" ");
        let variables = description::variables(&contents, &Units::new(document), options.version);
        let described = |token: &str| -> Result<_, FmuError> {
            let (name, description, sources) = (model.title(), description.as_str(), sources.as_slice());
            let title = Title { identifier: &identifier, name, description, token, sources };
            let header = layout(&contents, &experiment, &document.simulation, (&prefix, token));
            let xml = model_description(options.version, &title, &contents, &variables, &experiment);
            let build = build_description(&title).map_err(FmuError::Archive)?;
            Ok((header.into_bytes(), xml.map_err(FmuError::Archive)?, build))
        };
        // The token is that of all the rest.
        let (header, xml, _) = described("")?;
        let token = token(files.iter().map(|(_, bytes)| bytes).chain([&header, &xml]));
        let (header, xml, build) = described(&token)?;
        files.push(("layout.h".to_owned(), header));
        if options.version == FmiVersion::V3 {
            files.push(("buildDescription.xml".to_owned(), build));
        }
        files.sort();
        let inside = files.into_iter().map(|(name, bytes)| (format!("sources/{name}"), bytes));
        let files = std::iter::once(("modelDescription.xml".to_owned(), xml)).chain(inside).collect();
        Ok(Fmu { version: options.version, identifier, files, sources, notes: contents.notes })
    }

    /// The files of the archive by their names.
    pub fn files(&self) -> &[(String, Vec<u8>)] {
        &self.files
    }

    /// The text of `modelDescription.xml`.
    pub fn model_description(&self) -> &str {
        std::str::from_utf8(&self.files[0].1).unwrap_or_default()
    }

    /// What is not as in a run of the model, in sentences; they are part of the description of the FMU too.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The same with a binary for this machine, made by its C compiler: the one that the environment variable CC names, else `cc`.
    ///
    /// # Errors
    /// [`FmuError`] where there is no compiler, it refuses, or FMI has no name for the machine.
    pub fn compiled(mut self) -> Result<Fmu, FmuError> {
        let name = platform::binary(self.version, &self.identifier)?;
        let files: Vec<(String, Vec<u8>)> = self
            .files
            .iter()
            .filter_map(|(name, bytes)| Some((name.strip_prefix("sources/")?.to_owned(), bytes.clone())))
            .collect();
        let binary = platform::compile(&files, &self.sources)?;
        self.files.insert(1, (name, binary));
        Ok(self)
    }

    /// Writes the archive. It bears no date, so that the same FMU gives the same bytes.
    ///
    /// # Errors
    /// [`io::Error`]
    pub fn write(&self, out: impl Write + Seek) -> io::Result<()> {
        let mut archive = ZipWriter::new(out);
        for (name, bytes) in &self.files {
            let options = SimpleFileOptions::default()
                .compression_method(CompressionMethod::Stored)
                .last_modified_time(DateTime::default())
                .unix_permissions(if name.starts_with("binaries/") { 0o755 } else { 0o644 });
            archive.start_file(name.as_str(), options)?;
            archive.write_all(bytes)?;
        }
        archive.finish()?;
        Ok(())
    }
}
