//! The program of a motion that slides along surfaces.

use crate::program::program::{Instruction, Program, Register};
use crate::taylor::assembler::Assembler;

/// The derivatives of the functions of surfaces: a program of the inputs of f, and for each of its relevant outputs the
/// number of the surface and the component of (t, y).
#[derive(Clone, Copy, Debug)]
pub struct Normals<'a> {
    /// The derivatives.
    pub program: &'a Program,
    /// Output, surface, and component, which is 0 for time and i + 1 for component i of the state.
    pub entries: &'a [(usize, usize, usize)],
}

impl Program {
    /// The program of the [motion that slides](crate::Sliding) along surfaces, from that of f, whose first outputs are
    /// ẏ, one for each component of the state. The sides of the surfaces are the parameters at `sides`; f is assumed to
    /// be a sum of the changes at them:
    /// ```text
    /// ẏ = f̄ + Σ_i σ_i D_i,   D_i = (f(all above) − f(i below))/2,   f̄ = f(all above) − Σ_i D_i,
    /// Σ_j (n_i D_j) σ_j = −(g_t + n_i f̄),   n_i = ∂g_i/∂y
    /// ```
    /// The outputs after ẏ are those of f on the positive side of all surfaces.
    ///
    /// ```
    /// # use pc_expr::{Backend, Evaluator, Graph, Inputs, Normals, Program};
    /// // v̇ = push − 3 side with the sign of v for the side: along v = 0 the body rests.
    /// let graph = Graph::new();
    /// let [v, push, side] = graph.symbols(["v", "push", "side"]);
    /// let inputs = Inputs { time: None, state: vec![v], parameters: vec![push, side] };
    /// let program = Program::new(&graph, &inputs, &[push - 3.0 * side])?;
    /// let slope = Program::new(&graph, &inputs, &[1.into()])?;
    /// let normals = Normals { program: &slope, entries: &[(0, 0, 1)] };
    /// let mut rests = Evaluator::new(program.sliding(&[1], normals), Backend::Interpreter);
    /// let mut rate = [f64::NAN];
    /// rests.eval(0.0, &[0.0], &[2.0, 1.0], &mut rate);
    /// assert!(rate[0].abs() < 1e-15);
    /// # Ok::<(), pc_expr::ExprError>(())
    /// ```
    ///
    /// # Panics
    /// If the programs do not have the same inputs, or a side is not a parameter.
    pub fn sliding(&self, sides: &[usize], normals: Normals<'_>) -> Program {
        let inputs = (self.state, self.parameters);
        assert_eq!(inputs, (normals.program.state, normals.program.parameters), "the same inputs");
        assert!(sides.iter().all(|&side| side < self.parameters), "a parameter for each side");
        let (dim, m) = (self.state, sides.len());
        let mut writer = Assembler::default();
        let [one, half] = [1.0, 0.5].map(|value| writer.number(value));
        let minus = writer.number(-1.0);
        let all_above: Vec<(usize, Register)> = sides.iter().map(|&side| (side, one)).collect();
        let above = copy(&mut writer, self, &all_above);
        let slopes = copy(&mut writer, normals.program, &all_above);
        let mut middle = above[..dim].to_vec();
        let mut changes = Vec::with_capacity(m);
        for below in 0..m {
            let mut at = all_above.clone();
            at[below].1 = minus;
            let other = copy(&mut writer, self, &at);
            let mut change = Vec::with_capacity(dim);
            for i in 0..dim {
                let difference = writer.subtract(above[i], other[i]);
                let part = writer.multiply(half, difference);
                middle[i] = writer.subtract(middle[i], part);
                change.push(part);
            }
            changes.push(change);
        }
        let zero = writer.number(0.0);
        let mut rows = vec![vec![zero; m + 1]; m];
        for &(output, surface, component) in normals.entries {
            let slope = slopes[output];
            for (j, change) in changes.iter().enumerate() {
                if component > 0 {
                    let term = writer.multiply(slope, change[component - 1]);
                    rows[surface][j] = writer.add(rows[surface][j], term);
                }
            }
            let term = if component == 0 { slope } else { writer.multiply(slope, middle[component - 1]) };
            rows[surface][m] = writer.subtract(rows[surface][m], term);
        }
        let weights = solve(&mut writer, rows);
        let mut rates = middle;
        for (weight, change) in weights.into_iter().zip(&changes) {
            for (rate, &change) in rates.iter_mut().zip(change) {
                let term = writer.multiply(weight, change);
                *rate = writer.add(*rate, term);
            }
        }
        writer.finish((dim, 0, self.parameters), rates.into_iter().chain(above[dim..].iter().copied()))
    }
}

/// Writes the operations of a program, with some of its parameters replaced; returns its outputs.
fn copy(writer: &mut Assembler, program: &Program, replaced: &[(usize, Register)]) -> Vec<Register> {
    let mut places: Vec<Register> = program.constants.iter().map(|&value| writer.number(value)).collect();
    places.push(Assembler::time());
    places.extend((0..program.state).map(Assembler::state));
    let parameter = |place: usize| {
        let other = replaced.iter().find(|&&(known, _)| known == place);
        other.map_or_else(|| Assembler::parameter(place), |&(_, register)| register)
    };
    places.extend((0..program.parameters).map(parameter));
    for &instruction in &program.code {
        let instruction: Instruction = instruction.map(|register| places[register.index()]);
        places.push(writer.emit(instruction));
    }
    program.outputs.iter().map(|output| places[output.index()]).collect()
}

/// The solution of linear equations, each row ending with its right-hand side, by elimination in the given
/// order.
fn solve(writer: &mut Assembler, mut rows: Vec<Vec<Register>>) -> Vec<Register> {
    let m = rows.len();
    for pivot in 0..m {
        for row in pivot + 1..m {
            let factor = writer.divide(rows[row][pivot], rows[pivot][pivot]);
            for column in pivot + 1..=m {
                let term = writer.multiply(factor, rows[pivot][column]);
                rows[row][column] = writer.subtract(rows[row][column], term);
            }
        }
    }
    let mut solution = vec![rows[0][m]; m];
    for i in (0..m).rev() {
        let mut rest = rows[i][m];
        for j in i + 1..m {
            let term = writer.multiply(rows[i][j], solution[j]);
            rest = writer.subtract(rest, term);
        }
        solution[i] = writer.divide(rest, rows[i][i]);
    }
    solution
}
