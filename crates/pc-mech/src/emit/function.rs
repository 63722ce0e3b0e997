//! Functions that are written in addition to the functions for the equations.

use pc_expr::Expr;

/// A function of (t, y, p) for [emitted source](crate::Equations::emit_with) that writes an array of values.
#[derive(Clone, Debug)]
pub struct SourceFunction<'g> {
    pub(super) name: String,
    pub(super) purpose: String,
    pub(super) values: Vec<(String, Expr<'g>)>,
    pub(super) is_directional: bool,
}

impl<'g> SourceFunction<'g> {
    /// A function with this name, which must be an identifier, that writes these values, each given with a
    /// word for its meaning. The values may contain the [symbols of the
    /// accelerations](crate::System::accelerations). The purpose is used as the end of a sentence that begins
    /// with “Writes”.
    pub fn new(
        name: impl Into<String>,
        purpose: impl Into<String>,
        values: Vec<(String, Expr<'g>)>,
    ) -> SourceFunction<'g> {
        SourceFunction { name: name.into(), purpose: purpose.into(), values, is_directional: false }
    }

    /// A function that writes the derivatives of ẏ, then the derivatives of these values, along a direction
    /// (δy, δp), which comes after p in the array of parameters:
    ///
    ///   δẏ = (∂ẏ/∂y) δy + (∂ẏ/∂p) δp,   δv = (∂v/∂y) δy + (∂v/∂p) δp.
    ///
    /// ```
    /// use pc_mech::{EmitOptions, Graph, Language, SourceFunction, System};
    ///
    /// let graph = Graph::new();
    /// let [k, x, v] = graph.symbols(["k", "x", "x'"]);
    /// let oscillator = System::builder(&graph)
    ///     .parameter(k, 1.0)
    ///     .coordinates(["x"])
    ///     .lagrangian(|_, x, v| (v[0].square() - k * x[0].square()) / 2.0)
    ///     .build()?
    ///     .poincare()?;
    /// let power = vec![("power".to_owned(), k * x * v)];
    /// let along = SourceFunction::directional("along", "derivatives along a direction", power);
    /// let source = |language| oscillator.emit_with(&EmitOptions::new(language, "it"), &[along.clone()]);
    /// let c = &source(Language::C)?[1].text;
    /// assert!(c.contains("void it_along(double t, const double *y, const double *p, double *values)"));
    /// assert!(c.contains("const double dx = p[1];") && c.contains("const double dk = p[3];"));
    /// // ẍ = −k x, so that δẍ = −(x δk + k δx).
    /// assert!(c.contains("v1 = x*dk;") && c.contains("v2 = k*dx;") && c.contains("values[1] = -(v1 + v2);"));
    /// let rust = &source(Language::Rust)?[0].text;
    /// assert!(rust.contains("p: &[f64; DIM + 2 * PARAMETERS]"));
    /// # Ok::<(), pc_mech::MechError>(())
    /// ```
    pub fn directional(
        name: impl Into<String>,
        purpose: impl Into<String>,
        values: Vec<(String, Expr<'g>)>,
    ) -> SourceFunction<'g> {
        SourceFunction { is_directional: true, ..SourceFunction::new(name, purpose, values) }
    }
}
