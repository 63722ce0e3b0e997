//! Shapes with their positions along a motion.

use std::borrow::Cow;
use std::path::PathBuf;

use pc_expr::{Backend, Evaluator, Inputs, Program};
use pc_mech::{Expr, Graph, MechError};
use pc_model::{Arrow, Assembly, ConstraintFormulation, Model, ModelError, Quantity, Shape};
use serde_json::{Value, json};

use crate::base64::numbers;
use crate::mesh::Mesh;
use crate::recording::{ColumnKind, Recording};
use crate::surfaces::Surfaces;

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
    /// The centre, the normal and the radius.
    Ring,
    /// The centre and the radius.
    Sphere,
    /// The centre, the edge lengths, and the rows of a rotation matrix.
    Box,
    /// The common point of the axes, and the rows of a rotation matrix.
    Axes,
    /// The place of the middle of a surface with this index, and the rows of a rotation matrix.
    Mesh(usize),
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
            SceneShape::Disc | SceneShape::Ring => 7,
            SceneShape::Sphere => 4,
            SceneShape::Box => 15,
            SceneShape::Axes | SceneShape::Mesh(_) => 12,
            SceneShape::Spring => 6,
        }
    }

    /// The name of the shape in the script, and its text.
    fn word(&self) -> (&'static str, Cow<'_, str>) {
        let (kind, text) = match self {
            SceneShape::Mesh(index) => return ("mesh", index.to_string().into()),
            SceneShape::Point(label) => ("point", label.as_deref().unwrap_or_default()),
            SceneShape::Line(_) => ("line", ""),
            SceneShape::Disc => ("disc", ""),
            SceneShape::Ring => ("ring", ""),
            SceneShape::Sphere => ("sphere", ""),
            SceneShape::Box => ("box", ""),
            SceneShape::Axes => ("axes", ""),
            SceneShape::Spring => ("spring", ""),
            SceneShape::Trace => ("trace", ""),
            SceneShape::Text(text) => ("text", text.as_str()),
        };
        (kind, text.into())
    }

    /// The shape of a drawing; `mesh` has the index of each surface.
    fn of(shape: Shape<'_>, mesh: impl FnOnce(PathBuf, [f64; 3]) -> usize) -> SceneShape {
        match shape {
            Shape::Mesh { file, scale, .. } => SceneShape::Mesh(mesh(file, scale)),
            Shape::Point { label, .. } => SceneShape::Point(label),
            Shape::Line { through } => SceneShape::Line(through.len()),
            Shape::Disc { .. } => SceneShape::Disc,
            Shape::Ring { .. } => SceneShape::Ring,
            Shape::Sphere { .. } => SceneShape::Sphere,
            Shape::Box { .. } => SceneShape::Box,
            Shape::Axes { .. } => SceneShape::Axes,
            Shape::Spring { .. } => SceneShape::Spring,
            Shape::Trace { .. } => SceneShape::Trace,
            Shape::Text { text, .. } => SceneShape::Text(text),
        }
    }
}

/// A vector along the axes of space, stored by the indices of its numbers in each still.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneArrow {
    /// What it stands for.
    pub quantity: Quantity,
    /// The body or contact to which it belongs.
    pub of: String,
    /// The index of the first coordinate of the point where it begins.
    pub at: usize,
    /// The index of its first component.
    pub vector: usize,
}

impl SceneArrow {
    /// The name of the quantity in the script.
    fn word(&self) -> &'static str {
        match self.quantity {
            Quantity::Velocity => "velocity",
            Quantity::AngularVelocity => "turning",
            Quantity::Force => "force",
            Quantity::Reaction => "reaction",
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
    /// The vectors that can be shown with them.
    pub arrows: Vec<SceneArrow>,
    /// The numbers of all shapes and then of arrows, still by still.
    pub stills: Vec<f32>,
    /// The acceleration of gravity at the start; up is opposite to it.
    pub gravity: [f64; 3],
    /// The direction that the text says is up.
    pub up: Option<[f64; 3]>,
    /// The surfaces of triangles, as a page has them and as a still has them.
    pub meshes: Vec<[Mesh; 2]>,
}

/// What is known of a motion: the symbols of its state and of its outputs, with their columns.
struct Known<'r, 'g> {
    symbols: Vec<Expr<'g>>,
    columns: Vec<Option<&'r [f64]>>,
    graph: &'g Graph,
    /// The symbols that have values besides.
    others: Vec<Expr<'g>>,
    /// The quasi-velocities that constraints express by those of the columns, with their values.
    dependent: Vec<(Expr<'g>, Expr<'g>)>,
}

impl<'r, 'g> Known<'r, 'g> {
    fn of(assembly: &Assembly<'g>, record: &'r Recording) -> Known<'r, 'g> {
        let (system, graph) = (&assembly.system, assembly.system.graph());
        let columns = || record.rows.columns.iter().flat_map(|columns| &columns.list);
        let column = |symbol: &Expr<'_>| {
            let name = symbol.symbol_name()?;
            columns().find(|(known, _)| *known == name).map(|(_, values)| values.as_slice())
        };
        let mut symbols = system.state();
        let mut known: Vec<Option<&[f64]>> = symbols.iter().map(column).collect();
        let outputs = record.rows.columns.iter().filter(|columns| columns.kind == ColumnKind::Outputs);
        for (name, values) in outputs.flat_map(|columns| &columns.list) {
            let symbol = graph.symbol(name);
            if !symbols.contains(&symbol) {
                symbols.push(symbol);
                known.push(Some(values));
            }
        }
        let mut others: Vec<Expr<'g>> = system.parameters().iter().map(|&(symbol, _)| symbol).collect();
        others.push(system.frame().time());
        let dependent = dependent(assembly, |eta| column(eta).is_some());
        Known { symbols, columns: known, graph, others, dependent }
    }

    /// Functions with what depends on the columns expressed by them.
    fn by_columns(&self, functions: &[Expr<'g>]) -> Vec<Expr<'g>> {
        match self.dependent.is_empty() {
            true => functions.to_vec(),
            false => self.graph.substitute(functions, &self.dependent),
        }
    }

    /// Whether functions contain nothing else.
    fn have(&self, functions: &[Expr<'g>]) -> bool {
        let is_known = |symbol: &Expr<'g>| {
            let mut known = self.symbols.iter().zip(&self.columns);
            self.others.contains(symbol) || known.any(|(known, column)| known == symbol && column.is_some())
        };
        self.graph.symbols_of(functions).iter().all(is_known)
    }

    /// The values in a row.
    fn at(&self, row: usize) -> Vec<f64> {
        self.columns.iter().map(|column| column.map_or(f64::NAN, |values| values[row])).collect()
    }
}

/// The quasi-velocities without columns, as functions of those with columns, if constraints say so.
fn dependent<'g>(
    assembly: &Assembly<'g>,
    has_column: impl Fn(&Expr<'g>) -> bool,
) -> Vec<(Expr<'g>, Expr<'g>)> {
    let all = assembly.system.quasi_velocities();
    let (free, others): (Vec<Expr<'g>>, Vec<Expr<'g>>) = all.iter().copied().partition(has_column);
    let is_bound = match assembly.constraints.formulation() {
        ConstraintFormulation::Free => false,
        ConstraintFormulation::Vanishing(held) => others.iter().all(|eta| held.vanishing().contains(eta)),
        ConstraintFormulation::Multipliers(_) => !others.is_empty(),
    };
    if !is_bound {
        return Vec::new();
    }
    let values = assembly.quasi_velocities_of(&free).unwrap_or_default();
    all.iter().copied().zip(values).filter(|(eta, _)| others.contains(eta)).collect()
}

/// Where three functions stand among all; they are added if they are not there.
fn place<'g>(functions: &mut Vec<Expr<'g>>, wanted: &[Expr<'g>]) -> usize {
    functions.windows(3).position(|three| three == wanted).unwrap_or_else(|| {
        functions.extend(wanted);
        functions.len() - 3
    })
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
        let surfaces = Surfaces::of(model, &drawing)?;
        let graph = assembly.system.graph();
        let drawing: Vec<Shape<'_>> =
            drawing.into_iter().map(|shape| surfaces.centred(graph, shape)).collect();
        let known = Known::of(assembly, record);
        let functions: Vec<Expr<'_>> = drawing.iter().flat_map(Shape::functions).collect();
        let mut functions = known.by_columns(&functions);
        if !known.have(&functions) {
            return Ok(None);
        }
        let mut arrows = Vec::new();
        for Arrow { quantity, of, at, vector } in model.arrows(assembly)? {
            let numbers = known.by_columns(&[at, vector].concat());
            if known.have(&numbers) {
                let (at, vector) =
                    (place(&mut functions, &numbers[..3]), place(&mut functions, &numbers[3..]));
                arrows.push(SceneArrow { quantity, of, at, vector });
            }
        }
        let (system, graph) = (&assembly.system, assembly.system.graph());
        let parameters = system.parameters().iter().map(|&(symbol, _)| symbol).collect();
        let inputs = Inputs { time: Some(system.frame().time()), parameters, state: known.symbols.clone() };
        let program = assembly.placed(Program::new(graph, &inputs, &functions).map_err(MechError::from))?;
        let mut evaluator = Evaluator::new(program, Backend::Interpreter);
        let (signals, mut numbers) = (model.signals(), Vec::new());
        numbers.extend(system.parameters().iter().map(|&(_, value)| value));
        let (mut values, mut stills) = (vec![0.0; functions.len()], Vec::new());
        let shown = shown(record.rows.times.len(), functions.len());
        for &i in &shown {
            let t = record.rows.times[i];
            // Outside a table, an input is as it was last.
            let _ = signals.show(t, &mut numbers);
            evaluator.eval(t, &known.at(i), &numbers, &mut values);
            stills.extend(values.iter().map(|&value| value as f32));
        }
        let mut at = assembly.at_start();
        at.extend(system.parameters());
        let gravity = graph.evaluate(&system.gravity(), &at).unwrap_or_else(|_| vec![0.0; 3]);
        Ok(Some(Scene {
            shapes: drawing
                .into_iter()
                .map(|shape| {
                    let index = |file: PathBuf, scale| surfaces.index(&file, scale).unwrap_or_default();
                    SceneShape::of(shape, index)
                })
                .collect(),
            meshes: surfaces.simplified(),
            arrows,
            times: shown.iter().map(|&i| record.rows.times[i]).collect(),
            stills,
            gravity: [gravity[0], gravity[1], gravity[2]],
            up: model.document().drawing.up,
        }))
    }

    /// The number of values that all shapes and arrows together have in each still.
    pub fn width(&self) -> usize {
        let shapes = self.shapes.iter().map(SceneShape::numbers).sum();
        self.arrows.iter().map(|arrow| arrow.at.max(arrow.vector) + 3).fold(shapes, usize::max)
    }

    /// The direction in which things fall, or that the text says is down.
    pub(crate) fn down(&self) -> [f64; 3] {
        self.up.map_or(self.gravity, |up| up.map(|part| -part))
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
        let arrows = self.arrows.iter();
        let arrows: Vec<Value> =
            arrows.map(|arrow| json!([arrow.word(), arrow.of, arrow.at, arrow.vector])).collect();
        let meshes = self.meshes.iter().map(|[mesh, _]| {
            let faces: Vec<f32> = mesh.faces.iter().flatten().map(|&corner| corner as f32).collect();
            json!({ "corners": numbers(&mesh.corners.concat()), "faces": numbers(&faces) })
        });
        let meshes: Vec<Value> = meshes.collect();
        let single: Vec<f32> = self.times.iter().map(|&t| t as f32).collect();
        json!({
            "shapes": shapes,
            "arrows": arrows,
            "meshes": meshes,
            "width": self.width(),
            "gravity": self.gravity,
            "up": self.up,
            "times": numbers(&single),
            "frames": numbers(&self.stills),
        })
    }
}

#[cfg(test)]
mod tests {
    use pc_model::{Document, Source};

    use super::*;
    use crate::recording::{Columns, Samples};

    #[test]
    fn many_shapes_have_fewer_stills() {
        assert_eq!(shown(3, 10), [0, 1, 2]);
        let few = shown(601, 148);
        assert!(few.len() * 148 <= MOST_NUMBERS + 148 && few.first() == Some(&0) && few.last() == Some(&600));
        assert!(shown(0, 3).is_empty());
    }

    /// A pendulum of length 2, pulled by a wind whose force is a table, and a cart that its angle drives.
    const PENDULUM: &str = "[inputs]\nw = { times = [0, 1], values = [1, 3] }\n[coordinates]\n\"φ\" = 0.5\nx = 0\n[bodies.cart]\nmass = 1\nposition = [\"x\", 0, 0]\n[bodies.bob]\n\
        mass = 0.5\nposition = [\"2*sin(φ)\", \"-2*cos(φ)\", 0]\nforce = [\"w\", 0, 0]\n\
        [gravity]\nacceleration = [0, -10, 0]\n[constraints]\nrail = \"x' - 2*φ'\"\n[drawing]\nup = [1, 0]\n";

    fn scene() -> Scene {
        let model = Model::new(Document::parse(Source::new("model.toml", PENDULUM)).unwrap());
        let column = |name: &str, values: [f64; 2]| (name.to_owned(), values.to_vec());
        let of_kind = |kind, list| Columns { kind, list };
        let graph = model.graph();
        let assembly = model.assemble(&graph).unwrap();
        let rate = |eta: &Expr<'_>| match eta.to_string() {
            name if name == "φ'" => column(&name, [1.0, 2.0]),
            name => column(&name, [0.0; 2]),
        };
        let velocities = assembly.system.quasi_velocities().iter().map(rate).collect();
        let columns = vec![
            of_kind(ColumnKind::Coordinates, vec![column("φ", [0.5, 1.5]), column("x", [0.0; 2])]),
            of_kind(ColumnKind::QuasiVelocities, velocities),
            of_kind(
                ColumnKind::Outputs,
                ["x", "y", "z"].map(|axis| column(&format!("F_rail_bob_{axis}"), [7.0, 8.0])).to_vec(),
            ),
        ];
        let rows = Samples { times: vec![0.0, 0.5], columns };
        let record = Recording { rows, ..Recording::default() };
        Scene::of(&model, &assembly, &record).unwrap().unwrap()
    }

    /// v = 2 φ' (cos φ, sin φ), the weight, the wind at its time, and the reaction as it is in the table.
    #[test]
    fn arrows_are_those_of_the_run() {
        let scene = scene();
        let of_bob: Vec<&SceneArrow> = scene.arrows.iter().filter(|arrow| arrow.of == "bob").collect();
        let quantities: Vec<Quantity> = of_bob.iter().map(|arrow| arrow.quantity).collect();
        use Quantity::{Force, Reaction, Velocity};
        assert_eq!(quantities, [Velocity, Force, Force, Reaction]);
        let width = scene.width();
        assert_eq!(
            (width, scene.stills.len()),
            (2 * 3 + 6 * 3, 2 * width),
            "the mass centres are shapes already"
        );
        for (n, (angle, rate)) in [(0.5f64, 1.0), (1.5, 2.0)].into_iter().enumerate() {
            let still = &scene.stills[n * width..(n + 1) * width];
            let vector = |i: usize| &still[i..i + 3];
            assert_eq!(vector(of_bob[0].at), [2.0 * angle.sin(), -2.0 * angle.cos(), 0.0].map(|x| x as f32));
            let wanted = [
                [2.0 * rate * angle.cos(), 2.0 * rate * angle.sin(), 0.0],
                [0.0, -5.0, 0.0],
                [[1.0, 2.0][n], 0.0, 0.0],
                [[7.0, 8.0][n]; 3],
            ];
            for (arrow, wanted) in of_bob.iter().zip(wanted) {
                let near = |(found, wanted): (&f32, f64)| (f64::from(*found) - wanted).abs() < 1e-6;
                assert!(vector(arrow.vector).iter().zip(wanted).all(near), "{arrow:?}: {still:?}");
            }
        }
    }

    #[test]
    fn the_text_says_which_way_is_up() {
        let scene = scene();
        assert_eq!((scene.up, scene.down()), (Some([1.0, 0.0, 0.0]), [-1.0, 0.0, 0.0]));
        assert_eq!(scene.data()["arrows"][0], json!(["velocity", "cart", 0, 6]));
    }
}
