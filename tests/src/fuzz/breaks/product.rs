//! A text run by the program's libraries, as `pc run` does.

use pc_mech::Graph;
use pc_model::{Document, Flow, Model, Source, Variables};
use pc_solve::{Method, Options, Sensitivities, Solve};

use super::specimen::{ATOL, RTOL, Specimen};

/// A model with its text, ready to be run.
pub(super) struct Product<'a> {
    specimen: &'a Specimen,
    model: Model,
}

/// Rows of coordinates, velocities and states.
pub(super) type Rows = Vec<Vec<f64>>;

fn options(method: Method) -> Options {
    Options::new(method).relative_tolerance(RTOL).absolute_tolerance(ATOL)
}

impl<'a> Product<'a> {
    /// # Errors
    /// What is wrong with the text.
    pub(super) fn of(specimen: &'a Specimen, text: &str) -> Result<Product<'a>, String> {
        let document = Document::parse(Source::new("model.toml", text)).map_err(|error| error.to_string())?;
        Ok(Product { specimen, model: Model::new(document) })
    }

    fn flow(&self, model: &Model, variables: Variables) -> Result<Flow, String> {
        let graph = Graph::new();
        let assembly = model.assemble(&graph).map_err(|error| error.to_string())?;
        Flow::new(model, &assembly, variables).map_err(|error| error.to_string())
    }

    /// The places of the variables among the columns.
    fn places(&self, names: &[String]) -> Result<Vec<usize>, String> {
        let place = |name: String| names.iter().position(|known| *known == name).ok_or(name);
        let places = self.specimen.variables().into_iter().map(place).collect::<Result<_, _>>();
        places.map_err(|name| format!("there is no column {name}"))
    }

    /// The rows of the motion.
    ///
    /// # Errors
    /// Why there are none.
    pub(super) fn rows(&self, method: Method, variables: Variables) -> Result<Rows, String> {
        let mut flow = self.flow(&self.model, variables)?;
        let start = flow.start.clone();
        let solved = Solve::new(&mut flow.motion, 0.0, &start)
            .method(&options(method))
            .events(&mut flow.events)
            .run(&self.specimen.times())
            .map_err(|failure| failure.error.to_string())?;
        let places = self.places(&flow.names)?;
        let rows = solved.trajectory.iter().map(|(t, y)| {
            let row = flow.row(t, y);
            places.iter().map(|&place| row[place]).collect()
        });
        Ok(rows.collect())
    }

    /// The rows of the derivatives by each parameter that is asked for.
    ///
    /// # Errors
    /// Why there are none.
    pub(super) fn derivatives(&self, method: Method) -> Result<Vec<Rows>, String> {
        let mut model = self.model.clone();
        model.differentiate_by_parameters(true);
        let variables = Variables::QuasiVelocities;
        let mut flow = self.flow(&model, variables)?;
        let asked = &self.specimen.asked;
        let mut wanted = Sensitivities::new();
        for &j in asked {
            let start = model.derived(|assembly| flow.start_by_parameter(&model, assembly, j));
            let start = start.map_err(|error| error.to_string())?;
            wanted = wanted.by_parameter_from(j, start);
        }
        let (motion, start) = (&mut flow.motion, flow.start.clone());
        let times = self.specimen.times();
        let solved = Solve::new(motion, 0.0, &start)
            .method(&options(method))
            .events(&mut flow.events)
            .sensitivities(&wanted)
            .run(&times)
            .map_err(|failure| failure.error.to_string())?;
        let places = self.places(&flow.names)?;
        let mut all = vec![Vec::new(); asked.len()];
        for (t, y, matrix) in solved.trajectory.iter() {
            for ((rows, &j), column) in all.iter_mut().zip(asked).zip(matrix.chunks_exact(y.len())) {
                let row = flow.derivative(t, y, column, j);
                rows.push(places.iter().map(|&place| row[place]).collect());
            }
        }
        Ok(all)
    }
}
