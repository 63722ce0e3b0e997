//! Closures as vector fields.

use pc_expr::{Failure, Pattern, TimeDependence, VectorField};

/// A function of (t, y) that writes to its last argument.
type Write = fn(f64, &[f64], &mut [f64]) -> Result<(), Failure>;
/// A function of (t, y, v) that writes to its last argument.
type WriteProduct = fn(f64, &[f64], &[f64], &mut [f64]) -> Result<(), Failure>;
/// A function of t that changes y.
type Change = fn(f64, &mut [f64]) -> Result<(), Failure>;

/// A vector field given by closures; it is made by [`from_fn`].
///
/// ```
/// use pc_solve::{Options, Pattern, from_fn, solve};
///
/// // ẏ₁ = −k y₁, ẏ₂ = k y₁ with its derivatives and its invariant.
/// let k = 0.5;
/// let decay = from_fn(2, move |_t, y, ydot| {
///     ydot.copy_from_slice(&[-k * y[0], k * y[0]]);
///     Ok(())
/// })
/// .with_sparsity(Pattern::from_columns(2, [vec![0, 1], vec![]]))
/// .with_sparse_jacobian(move |_t, _y, values| {
///     values.copy_from_slice(&[-k, k]);
///     Ok(())
/// })
/// .with_jvp(move |_t, _y, v, product| {
///     product.copy_from_slice(&[-k * v[0], k * v[0]]);
///     Ok(())
/// })
/// .with_parameters(1, |_t, y, by_k| {
///     by_k.copy_from_slice(&[-y[0], y[0]]);
///     Ok(())
/// })
/// .with_projection(|_t, y| {
///     let excess = (y[0] + y[1] - 1.0) / 2.0; // y₁ + y₂ = 1
///     y.iter_mut().for_each(|y| *y -= excess);
///     Ok(())
/// })
/// .with_names(["mother", "daughter"]);
/// let motion = solve(decay, 0.0, &[1.0, 0.0], &[2.0], &Options::default())?;
/// assert!((motion.state(0)[0] - (-1.0_f64).exp()).abs() < 1e-8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct FnField<R, J = Write, S = Write, V = WriteProduct, P = Write, C = Change, W = WriteProduct> {
    shape: Shape,
    rhs: R,
    jacobian: Option<J>,
    sparse_jacobian: Option<S>,
    jvp: Option<V>,
    parameter_jacobian: Option<P>,
    projection: Option<C>,
    vjp: Option<W>,
}

/// The data that are not closures.
#[derive(Debug, Clone, Default)]
struct Shape {
    dim: usize,
    names: Vec<String>,
    pattern: Option<Pattern>,
    parameters: usize,
    autonomous: bool,
}

/// The vector field of dimension `dim` whose closure writes f(t, y) to its last argument.
///
/// Both slices have length `dim`. Where f is not defined, the closure returns an error as
/// [`VectorField::rhs`] does.
pub fn from_fn<R>(dim: usize, rhs: R) -> FnField<R>
where
    R: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
{
    FnField {
        shape: Shape { dim, ..Shape::default() },
        rhs,
        jacobian: None,
        sparse_jacobian: None,
        jvp: None,
        parameter_jacobian: None,
        projection: None,
        vjp: None,
    }
}

/// The field with one closure replaced by a closure of another type.
macro_rules! with {
    ($field:expr, $name:ident = $closure:expr, $($kept:ident),*) => {{
        let field = $field;
        FnField { shape: field.shape, rhs: field.rhs, $name: Some($closure), $($kept: field.$kept),* }
    }};
}

impl<R, J, S, V, P, C, W> FnField<R, J, S, V, P, C, W> {
    /// The same field with a closure that writes ∂fᵢ/∂yⱼ to entry `i + j * dim` of its last
    /// argument.
    ///
    /// Every entry must be written, including zeros.
    pub fn with_jacobian<K>(self, jacobian: K) -> FnField<R, K, S, V, P, C, W>
    where
        K: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    {
        with!(self, jacobian = jacobian, sparse_jacobian, jvp, parameter_jacobian, projection, vjp)
    }

    /// The same field, declared to have ∂fᵢ/∂yⱼ that vanish outside the dim × dim `pattern`.
    pub fn with_sparsity(self, pattern: Pattern) -> Self {
        FnField { shape: Shape { pattern: Some(pattern), ..self.shape }, ..self }
    }

    /// The same field with a closure that writes the ∂fᵢ/∂yⱼ of the
    /// [pattern](FnField::with_sparsity), in its order, to its last argument.
    ///
    /// Every entry must be written. The closure also provides the dense Jacobian, unless the dense
    /// Jacobian has a closure of its own.
    pub fn with_sparse_jacobian<K>(self, sparse_jacobian: K) -> FnField<R, J, K, V, P, C, W>
    where
        K: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    {
        with!(self, sparse_jacobian = sparse_jacobian, jacobian, jvp, parameter_jacobian, projection, vjp)
    }

    /// The same field with a closure of (t, y, v) that writes (∂f/∂y) v to its last argument.
    pub fn with_jvp<K>(self, jvp: K) -> FnField<R, J, S, K, P, C, W>
    where
        K: FnMut(f64, &[f64], &[f64], &mut [f64]) -> Result<(), Failure>,
    {
        with!(self, jvp = jvp, jacobian, sparse_jacobian, parameter_jacobian, projection, vjp)
    }

    /// The same field with a closure of (t, y, w) that writes (∂f/∂y)ᵀ w to its last argument.
    pub fn with_vjp<K>(self, vjp: K) -> FnField<R, J, S, V, P, C, K>
    where
        K: FnMut(f64, &[f64], &[f64], &mut [f64]) -> Result<(), Failure>,
    {
        with!(self, vjp = vjp, jacobian, sparse_jacobian, jvp, parameter_jacobian, projection)
    }

    /// The same field with a number of parameters p and a closure that writes ∂fᵢ/∂pⱼ to entry
    /// `i + j * dim` of its last argument.
    ///
    /// Every entry must be written, including zeros.
    pub fn with_parameters<K>(self, parameters: usize, parameter_jacobian: K) -> FnField<R, J, S, V, K, C, W>
    where
        K: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    {
        let field = FnField { shape: Shape { parameters, ..self.shape }, ..self };
        with!(field, parameter_jacobian = parameter_jacobian, jacobian, sparse_jacobian, jvp, projection, vjp)
    }

    /// The same field with a closure that moves its last argument onto the surface of possible
    /// states at time t.
    ///
    /// Far from that surface it returns an error, as [`VectorField::project`] does.
    pub fn with_projection<K>(self, projection: K) -> FnField<R, J, S, V, P, K, W>
    where
        K: FnMut(f64, &mut [f64]) -> Result<(), Failure>,
    {
        with!(self, projection = projection, jacobian, sparse_jacobian, jvp, parameter_jacobian, vjp)
    }

    /// The same field, declared not to depend on t explicitly, so that an integrator need not check
    /// for such dependence.
    pub fn autonomous(self) -> Self {
        FnField { shape: Shape { autonomous: true, ..self.shape }, ..self }
    }

    /// The same field with names of its components, for messages; a component without a name is
    /// called `y[i]`.
    pub fn with_names<N: Into<String>>(self, names: impl IntoIterator<Item = N>) -> Self {
        let names = names.into_iter().map(Into::into).collect();
        FnField { shape: Shape { names, ..self.shape }, ..self }
    }
}

impl<R, J, S, V, P, C, W> VectorField for FnField<R, J, S, V, P, C, W>
where
    R: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    J: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    S: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    V: FnMut(f64, &[f64], &[f64], &mut [f64]) -> Result<(), Failure>,
    P: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    C: FnMut(f64, &mut [f64]) -> Result<(), Failure>,
    W: FnMut(f64, &[f64], &[f64], &mut [f64]) -> Result<(), Failure>,
{
    fn dim(&self) -> usize {
        self.shape.dim
    }

    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        (self.rhs)(t, y, ydot)
    }

    fn has_jacobian(&self) -> bool {
        self.jacobian.is_some() || self.sparse_jacobian.is_some()
    }

    fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        match (&mut self.jacobian, &mut self.sparse_jacobian, &self.shape.pattern) {
            (Some(evaluate), ..) => evaluate(t, y, jacobian),
            (None, Some(evaluate), Some(pattern)) => {
                let mut values = vec![f64::NAN; pattern.len()];
                evaluate(t, y, &mut values)?;
                pattern.scatter(&values, jacobian);
                Ok(())
            }
            (None, Some(_), None) => Err(Failure::fatal(Missing("zero pattern, but a sparse Jacobian"))),
            (None, None, _) => Err(Failure::fatal(Missing("Jacobian"))),
        }
    }

    fn sparsity(&self) -> Option<&Pattern> {
        self.shape.pattern.as_ref()
    }

    fn sparse_jacobian(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        if let Some(evaluate) = &mut self.sparse_jacobian {
            return evaluate(t, y, values);
        }
        let mut dense = vec![f64::NAN; self.shape.dim * self.shape.dim];
        self.jacobian(t, y, &mut dense)?;
        match &self.shape.pattern {
            Some(pattern) => pattern.gather(&dense, values),
            None => return Err(Failure::fatal(Missing("zero pattern"))),
        }
        Ok(())
    }

    fn has_jvp(&self) -> bool {
        self.jvp.is_some()
    }

    fn jvp(&mut self, t: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), Failure> {
        match &mut self.jvp {
            Some(evaluate) => evaluate(t, y, v, product),
            None => Err(Failure::fatal(Missing("product with its Jacobian"))),
        }
    }

    fn has_vjp(&self) -> bool {
        self.vjp.is_some()
    }

    fn vjp(&mut self, t: f64, y: &[f64], w: &[f64], product: &mut [f64]) -> Result<(), Failure> {
        match &mut self.vjp {
            Some(evaluate) => evaluate(t, y, w, product),
            None => Err(Failure::fatal(Missing("product with its transposed Jacobian"))),
        }
    }

    fn parameters_len(&self) -> usize {
        self.shape.parameters
    }

    fn has_parameter_jacobian(&self) -> bool {
        self.parameter_jacobian.is_some()
    }

    fn parameter_jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        match &mut self.parameter_jacobian {
            Some(evaluate) => evaluate(t, y, jacobian),
            None => Err(Failure::fatal(Missing("derivative by parameters"))),
        }
    }

    fn has_projection(&self) -> bool {
        self.projection.is_some()
    }

    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        match &mut self.projection {
            Some(project) => project(t, y),
            None => Ok(()),
        }
    }

    fn time_dependence(&self) -> TimeDependence {
        if self.shape.autonomous { TimeDependence::Absent } else { TimeDependence::Unknown }
    }

    fn component_name(&self, i: usize) -> String {
        self.shape.names.get(i).map_or_else(|| format!("y[{i}]"), Clone::clone)
    }
}

/// The error for a closure or a pattern that the vector field lacks.
#[derive(Debug, thiserror::Error)]
#[error("this vector field was given no {0}")]
struct Missing(&'static str);
