//! Shapes with their positions along a motion.

use pc_expr::{Backend, Evaluator, Inputs, Program};
use pc_mech::{Expr, MechError};
use pc_model::{Assembly, Model, ModelError, Shape};
use serde_json::{Value, json};

use crate::base64::numbers;
use crate::recording::Recording;

/// The largest number of values in all stills together, which take up a third of a megabyte.
const MOST_NUMBERS: usize = 60_000;

/// A shape, whose numbers are stored in the stills, shape by shape.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SceneShape {
    /// Three numbers: the position of a dot with a label.
    Point(Option<String>),
    /// Three numbers for each of this many corners.
    Line(usize),
    /// The centre, the normal and the radius.
    Disc,
    /// The centre and the radius.
    Sphere,
    /// The centre, the edge lengths, and the rows of a rotation matrix.
    Box,
    /// The common point of the axes, and the rows of a rotation matrix.
    Axes,
    /// The two ends.
    Spring,
    /// Three numbers: the point that leaves a trace.
    Trace,
    /// Three numbers: the point at which the words begin.
    Text(String),
}

impl SceneShape {
    /// The number of values that the shape has in each still.
    pub fn numbers(&self) -> usize {
        match self {
            SceneShape::Point(_) | SceneShape::Trace | SceneShape::Text(_) => 3,
            SceneShape::Line(corners) => 3 * corners,
            SceneShape::Disc => 7,
            SceneShape::Sphere => 4,
            SceneShape::Box => 15,
            SceneShape::Axes => 12,
            SceneShape::Spring => 6,
        }
    }

    /// The name of the shape in the script, and its text.
    fn word(&self) -> (&'static str, &str) {
        match self {
            SceneShape::Point(label) => ("point", label.as_deref().unwrap_or_default()),
            SceneShape::Line(_) => ("line", ""),
            SceneShape::Disc => ("disc", ""),
            SceneShape::Sphere => ("sphere", ""),
            SceneShape::Box => ("box", ""),
            SceneShape::Axes => ("axes", ""),
            SceneShape::Spring => ("spring", ""),
            SceneShape::Trace => ("trace", ""),
            SceneShape::Text(text) => ("text", text),
        }
    }
}

impl From<Shape<'_>> for SceneShape {
    fn from(shape: Shape<'_>) -> SceneShape {
        match shape {
            Shape::Point { label, .. } => SceneShape::Point(label),
            Shape::Line { through } => SceneShape::Line(through.len()),
            Shape::Disc { .. } => SceneShape::Disc,
            Shape::Sphere { .. } => SceneShape::Sphere,
            Shape::Box { .. } => SceneShape::Box,
            Shape::Axes { .. } => SceneShape::Axes,
            Shape::Spring { .. } => SceneShape::Spring,
            Shape::Trace { .. } => SceneShape::Trace,
            Shape::Text { text, .. } => SceneShape::Text(text),
        }
    }
}

/// The indices of the rows that are shown: all, or every n-th and the last one.
fn shown(rows: usize, width: usize) -> Vec<usize> {
    let stride = (rows * width).div_ceil(MOST_NUMBERS).max(1);
    let last = rows.saturating_sub(1);
    let between = (0..last).step_by(stride);
    between.chain((rows > 0).then_some(last)).collect()
}

/// Shapes along a motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The shapes.
    pub shapes: Vec<SceneShape>,
    /// The times of the stills.
    pub times: Vec<f64>,
    /// The numbers of all shapes, still by still.
    pub stills: Vec<f32>,
    /// The acceleration of gravity at the start; up is opposite to it.
    pub gravity: [f64; 3],
}

impl Scene {
    /// The drawing of a model along a motion; `None` if there is nothing to draw, or if variables that it
    /// needs were not computed.
    ///
    /// # Errors
    /// [`ModelError`] if the shapes cannot be resolved or compiled.
    pub fn of(
        model: &Model,
        assembly: &Assembly<'_>,
        record: &Recording,
    ) -> Result<Option<Scene>, ModelError> {
        let drawing = model.drawing(assembly)?;
        if drawing.is_empty() || record.rows.times.is_empty() {
            return Ok(None);
        }
        let (system, graph) = (&assembly.system, assembly.system.graph());
        let functions: Vec<Expr<'_>> = drawing.iter().flat_map(Shape::functions).collect();
        let state = system.state();
        let column = |symbol: &Expr<'_>| {
            let name = symbol.symbol_name()?;
            let mut columns = record.rows.columns.iter().flat_map(|columns| &columns.list);
            columns.find(|(known, _)| *known == name).map(|(_, values)| values)
        };
        let columns: Vec<Option<&Vec<f64>>> = state.iter().map(column).collect();
        let missing = |symbol: &Expr<'_>| {
            state.iter().zip(&columns).any(|(known, column)| known == symbol && column.is_none())
        };
        if graph.symbols_of(&functions).iter().any(missing) {
            return Ok(None);
        }
        let parameters = system.parameters().iter().map(|&(symbol, _)| symbol).collect();
        let inputs = Inputs { time: Some(system.frame().time()), parameters, state };
        let program = assembly.placed(Program::new(graph, &inputs, &functions).map_err(MechError::from))?;
        let mut evaluator = Evaluator::new(program, Backend::Interpreter);
        let numbers: Vec<f64> = system.parameters().iter().map(|&(_, value)| value).collect();
        let (mut values, mut stills) = (vec![0.0; functions.len()], Vec::new());
        let shown = shown(record.rows.times.len(), functions.len());
        for &i in &shown {
            let t = record.rows.times[i];
            let state: Vec<f64> =
                columns.iter().map(|column| column.map_or(f64::NAN, |values| values[i])).collect();
            evaluator.eval(t, &state, &numbers, &mut values);
            stills.extend(values.iter().map(|&value| value as f32));
        }
        let mut at = assembly.at_start();
        at.extend(system.parameters());
        let gravity = graph.evaluate(&system.gravity(), &at).unwrap_or_else(|_| vec![0.0; 3]);
        Ok(Some(Scene {
            shapes: drawing.into_iter().map(SceneShape::from).collect(),
            times: shown.iter().map(|&i| record.rows.times[i]).collect(),
            stills,
            gravity: [gravity[0], gravity[1], gravity[2]],
        }))
    }

    /// The number of values that all shapes together have in each still.
    pub fn width(&self) -> usize {
        self.shapes.iter().map(SceneShape::numbers).sum()
    }

    /// The data for the player: names, then times and numbers in IEEE 754 single precision, least significant
    /// byte first, encoded in base 64.
    pub fn data(&self) -> Value {
        let shapes: Vec<Value> = self
            .shapes
            .iter()
            .map(|shape| {
                let (kind, text) = shape.word();
                json!([kind, shape.numbers(), text])
            })
            .collect();
        let single: Vec<f32> = self.times.iter().map(|&t| t as f32).collect();
        json!({
            "shapes": shapes,
            "gravity": self.gravity,
            "times": numbers(&single),
            "frames": numbers(&self.stills),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_shapes_have_fewer_stills() {
        assert_eq!(shown(3, 10), [0, 1, 2]);
        let few = shown(601, 148);
        assert!(few.len() * 148 <= MOST_NUMBERS + 148 && few.first() == Some(&0) && few.last() == Some(&600));
        assert!(shown(0, 3).is_empty());
    }
}
