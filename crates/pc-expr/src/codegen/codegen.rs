//! Programs as source text: the statements of one straight-line function.
//!
//! The source computes what the [interpreter](crate::Interpreter) computes, operation by operation. A value
//! used once is written in place, with brackets wherever the order of operations requires them; any other
//! value becomes a local constant.

use crate::codegen::function_body::Printer;
use crate::codegen::layout::{FunctionBody, Language, Layout};
use crate::program::program::Program;

impl Program {
    /// The program as the body of a function. Multiply-adds are fused only in a [fused](Program::fused)
    /// program.
    ///
    /// ```
    /// use pc_expr::{Graph, Inputs, Language, Layout, Place, Program, Slot};
    ///
    /// let graph = Graph::new();
    /// let [theta, g] = graph.symbols(["θ", "g"]);
    /// let inputs = Inputs { time: None, state: vec![theta], parameters: vec![g] };
    /// let program = Program::new(&graph, &inputs, &[-g * theta.sin()])?;
    /// let layout = Layout {
    ///     inputs: Language::C.identifiers(&["θ", "g"], &["torque"]),
    ///     slots: vec![Slot { place: Place::Entry("*torque".into()), comment: "N m".into(), local: String::new() }],
    ///     skip_zeros: false,
    ///     prefix: "pendulum_".into(),
    ///     reserved: vec!["torque".into()],
    /// };
    /// let body = program.emit(Language::C, &layout);
    /// assert_eq!(
    ///     body.inputs,
    ///     "    const double theta = y[0]; /* θ */\n    const double g = p[0];\n    (void)t;\n"
    /// );
    /// assert_eq!(body.statements, "    *torque = -g*sin(theta); /* N m */\n");
    /// # Ok::<(), pc_expr::ExprError>(())
    /// ```
    ///
    /// # Panics
    /// If `layout` does not have as many identifiers as there are inputs besides time, or as many slots as there
    /// are outputs.
    pub fn emit(&self, language: Language, layout: &Layout) -> FunctionBody {
        assert_eq!(layout.inputs.len(), self.state_len() + self.parameters_len(), "identifiers of inputs");
        assert_eq!(layout.slots.len(), self.outputs_len(), "slots of outputs");
        Printer::new(self, language, layout).print()
    }
}
