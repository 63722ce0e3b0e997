//! Reads the text of a model as a document, section by section.
//!
//! ```
//! use pc_model::{Document, Source};
//! let text = "coordinates.x = 1.0\nlagrangian.kinetic = \"x'^2/2\"";
//! let document = Document::parse(Source::new("free.toml", text))?;
//! assert_eq!(document.coordinates[0].name.text, "x");
//! # Ok::<(), pc_model::ModelError>(())
//! ```

use pc_expr::parse::nearest;

use crate::deep::deep;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::{ErrorKind, SECTIONS};
use crate::diagnostics::source::Source;
use crate::document::contents::Document;
use crate::document::loops::{self, Loop};
use crate::document::reader::{Item, Table};
use crate::document::{
    bodies, checks, contacts, draw, drawing, functions, hanging, inputs, sections, simulation, syntax, tree,
    units,
};

impl Document {
    /// The document of a model file.
    ///
    /// # Errors
    /// The first error in the file, if the file is not a model.
    pub fn parse(source: Source) -> Result<Self, ModelError> {
        deep(|| Document::parsed(source))
    }

    fn parsed(source: Source) -> Result<Self, ModelError> {
        let (mut document, mut loops) = (Self::default(), Vec::new());
        let entries = syntax::table(&source)?;
        let declared = functions::declared(&Table::root(&source, &entries, &[]))?;
        for item in Table::root(&source, &entries, &declared).items() {
            document.read(&item, &mut loops)?;
        }
        document.source = source;
        contacts::declare_coordinates(&mut document)?;
        hanging::declare(&mut document, loops, &declared)?;
        contacts::declare(&mut document)?;
        checks::check_names(&document)?;
        checks::require_motion(&document)?;
        checks::require_energy(&document)?;
        checks::require_bodies(&document)?;
        checks::check_tolerances(&document)?;
        units::check_units(&document)?;
        checks::check_hidden(&document)?;
        checks::check_carriers(&document)?;
        Ok(document)
    }

    /// The document of a model file as read from disk.
    ///
    /// # Errors
    /// As for [`Document::parse`], and also if the bytes are not UTF-8.
    pub fn from_bytes(name: impl Into<String>, bytes: &[u8]) -> Result<Self, ModelError> {
        Self::parse(Source::from_bytes(name, bytes))
    }

    /// Reads one section.
    fn read(&mut self, item: &Item<'_>, loops: &mut Vec<Loop>) -> Result<(), ModelError> {
        let key = item.key();
        if !SECTIONS.contains(&key) {
            let name = key.to_owned();
            return Err(item.key_error(if item.is_table() {
                ErrorKind::UnknownSection { name, nearest: nearest(key, SECTIONS.iter().copied()) }
            } else {
                ErrorKind::OutsideSection { key: name }
            }));
        }
        if key == "draw" {
            self.draw = draw::draw(item)?;
            return Ok(());
        }
        let table = item.section(key, &format!("[{key}]"))?;
        match key {
            "model" => self.model = sections::heading(&table)?,
            "parameters" => self.parameters = table.declarations()?,
            "inputs" => self.inputs = inputs::inputs(&table)?,
            "functions" => self.functions = functions::functions(&table)?,
            "definitions" => self.definitions = table.declarations()?,
            "coordinates" => self.coordinates = table.declarations()?,
            "quasi_velocities" => sections::quasi_velocities(&table, self)?,
            "states" => self.states = sections::states(&table)?,
            "kinematics" => self.kinematics = table.expressions()?,
            "algebra" => self.algebra = Some(sections::algebra(&table)?),
            "constraints" => self.constraints = sections::constraints(&table)?,
            "lagrangian" => self.lagrangian = Some(sections::lagrangian(&table)?),
            "bodies" => (self.bodies, self.tree) = tree::bodies(&table)?,
            "points" => self.points = tree::points(&table)?,
            "contacts" => self.contacts = contacts::contacts(&table)?,
            "loops" => *loops = loops::loops(&table)?,
            "gravity" => self.gravity = Some(bodies::gravity(&table)?),
            "forces" => self.forces = table.on_velocities()?,
            "integrals" => self.integrals = table.declarations()?,
            "outputs" => self.outputs = table.declarations()?,
            "units" => self.units = units::units(&table)?,
            "drawing" => self.drawing = drawing::drawing(&table)?,
            "hamilton_jacobi" => self.hamilton_jacobi = Some(sections::hamilton_jacobi(&table)?),
            "events" => self.events = simulation::events(&table)?,
            _ => self.simulation = simulation::simulation(&table)?,
        }
        Ok(())
    }
}
