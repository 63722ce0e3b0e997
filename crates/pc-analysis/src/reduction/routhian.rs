//! Routh's reduction by cyclic coordinates.

use pc_algebra::{affine, quadratic};
use pc_mech::{Expr, MechError, System};

use crate::error::AnalysisError;

/// A system without its cyclic coordinates x_c, whose momenta p_c = ∂L/∂ẋ_c are constants of the motion:
///
///   R(t, x, ẋ, p) = L − p_c ẋ_c with ẋ_c substituted,   d/dt ∂R/∂ẋ_i − ∂R/∂x_i = Q_i
///
/// for the other coordinates x_i (E. J. Routh, 1877). Others write −R.
#[derive(Clone, Debug)]
pub struct Routhian<'g> {
    /// The symbols x_c.
    pub cyclic: Vec<Expr<'g>>,
    /// The symbols p_c.
    pub momenta: Vec<Expr<'g>>,
    /// p_c as functions of (t, x, ẋ).
    pub momenta_of_velocities: Vec<Expr<'g>>,
    /// ẋ_c as functions of (t, x, ẋ, p) without ẋ_c.
    pub rates: Vec<Expr<'g>>,
    /// R.
    pub routhian: Expr<'g>,
    /// The system of the other coordinates, with R as its Lagrangian and p_c among its parameters; none if all
    /// coordinates are cyclic.
    pub system: Option<System<'g>>,
}

impl<'g> Routhian<'g> {
    /// The Routhian of a system, in terms of the velocities of its coordinates, whatever its quasi-velocities
    /// are. Coordinates are cyclic if neither L nor any force depends on them and no force acts along them.
    /// The values of p_c are those at the start of the motion; `at` gives the time and the state there.
    ///
    /// None if no coordinate is cyclic, if there are not as many quasi-velocities as coordinates, if the
    /// system has first-order states or forces that are computed outside, or if L is not quadratic in the
    /// ẋ_c.
    ///
    /// # Errors
    /// The errors of the change to velocities; [`ExprError`](pc_mech::ExprError) if p_c has no value.
    ///
    /// ```
    /// use pc_analysis::Routhian;
    /// use pc_mech::{Graph, System};
    ///
    /// // A central motion of the area integral p_φ.
    /// let graph = Graph::new();
    /// let central = System::builder(&graph)
    ///     .coordinates(["r", "φ"])
    ///     .lagrangian(|_, x, v| (v[0].square() + (x[0] * v[1]).square()) / 2.0 + 1.0 / x[0])
    ///     .build()?;
    /// let at: Vec<_> = [("t", 0.0), ("r", 2.0), ("φ", 0.0), ("r'", 0.0), ("φ'", 0.5)]
    ///     .map(|(name, value)| (graph.symbol(name), value))
    ///     .into();
    /// let routh = Routhian::of(&central, &at)?.unwrap();
    /// let [r, v, p] = graph.symbols(["r", "r'", "p_φ"]);
    /// assert_eq!(routh.routhian, v.square() / 2.0 - p.square() / (2.0 * r.square()) + 1.0 / r);
    /// assert_eq!(routh.system.unwrap().parameters(), [(p, 2.0)]);
    /// # Ok::<(), pc_analysis::AnalysisError>(())
    /// ```
    pub fn of(system: &System<'g>, at: &[(Expr<'g>, f64)]) -> Result<Option<Routhian<'g>>, AnalysisError> {
        let (frame, k) = (system.frame(), system.quasi_velocities().len());
        let is_plain = system.states().is_empty() && system.external_forces().is_empty();
        if frame.coordinates().len() != k || frame.rank() < k || k == 0 || !is_plain {
            return Ok(None);
        }
        let lagrange = system.in_velocities()?;
        let (graph, x, v) = (lagrange.graph(), lagrange.frame().coordinates(), lagrange.quasi_velocities());
        let (lagrangian, forces) = (lagrange.lagrangian(), lagrange.forces());
        let is_cyclic = |i: &usize| {
            let force = forces[*i].is_zero() && !forces.iter().any(|q| !q.derivative(x[*i]).is_zero());
            force && lagrangian.derivative(x[*i]).is_zero()
        };
        let (cyclic, rest): (Vec<usize>, Vec<usize>) = (0..k).partition(is_cyclic);
        let chosen = |list: &[Expr<'g>], places: &[usize]| -> Vec<Expr<'g>> {
            places.iter().map(|&i| list[i]).collect()
        };
        let v_cyclic = chosen(v, &cyclic);
        let (all_momenta, symbols) = (lagrange.momenta(), lagrange.momentum_symbols());
        let (momenta, values) = (chosen(&symbols, &cyclic), chosen(&all_momenta, &cyclic));
        if cyclic.is_empty() || quadratic(graph, lagrangian, &v_cyclic).is_none() {
            return Ok(None);
        }
        let Some(rates) = solved(graph, &values, &v_cyclic, &momenta) else { return Ok(None) };
        let v_rest = chosen(v, &rest);
        let order = [v_rest.as_slice(), &momenta].concat();
        let known: Vec<_> = v_cyclic.iter().copied().zip(rates.iter().copied()).collect();
        let put = |e: Expr<'g>| graph.substitute(&[e], &known)[0];
        let routhian = put(lagrangian) - graph.dot(momenta.iter().copied(), rates.iter().copied());
        let short = |e: Expr<'g>| graph.shorten(&[e], &order)[0];
        let routhian = short(routhian);
        let rates: Vec<Expr<'g>> = rates.into_iter().map(short).collect();
        if cyclic.iter().any(|&i| routhian.depends_on(x[i])) {
            return Ok(None); // terms that cancel are still written
        }

        let x_dot = frame.velocities(system.quasi_velocities());
        let velocities: Vec<_> = v.iter().copied().zip(x_dot).collect();
        let at_start = graph.substitute(&values, &velocities);
        let numbers: Vec<(Expr<'g>, f64)> = at.iter().chain(system.parameters()).copied().collect();
        let at_start = graph.evaluate(&at_start, &numbers)?;
        let of_rest = || -> Result<System<'g>, MechError> {
            let names: Vec<String> = rest.iter().map(|&i| x[i].to_string()).collect();
            let forces: Vec<Expr<'g>> = rest.iter().map(|&i| short(put(forces[i]))).collect();
            let builder = System::builder(graph).coordinates(names);
            let builder = builder.lagrangian(|_, _, _| routhian).forces(|_, _, _| forces);
            let signals = lagrange.signals();
            let given = lagrange.parameters().iter().fold(builder, |builder, &(p, value)| {
                if signals.contains(&p) { builder.signal(p, value) } else { builder.parameter(p, value) }
            });
            let all = momenta.iter().zip(&at_start);
            all.fold(given, |builder, (&p, &value)| builder.parameter(p, value))
                .near(numbers.iter().copied())
                .build()
        };
        Ok(Some(Routhian {
            system: if rest.is_empty() { None } else { Some(of_rest()?) },
            cyclic: chosen(x, &cyclic),
            momenta_of_velocities: graph.shorten(&values, v),
            momenta,
            rates,
            routhian,
        }))
    }
}

/// The velocities for which affine functions have the values `symbols`, if the functions determine them.
fn solved<'g>(
    graph: &'g pc_mech::Graph,
    functions: &[Expr<'g>],
    velocities: &[Expr<'g>],
    symbols: &[Expr<'g>],
) -> Option<Vec<Expr<'g>>> {
    let parts: Option<Vec<_>> = functions.iter().map(|&f| affine(graph, f, velocities)).collect();
    let (rows, rest): (Vec<Vec<Expr<'g>>>, Vec<Expr<'g>>) = parts?.into_iter().unzip();
    let size = velocities.len();
    let inverse = pc_algebra::inverse(graph, &pc_mech::Matrix::from_fn(size, size, |i, j| rows[i][j]))?;
    let right: Vec<Expr<'g>> = symbols.iter().zip(rest).map(|(&p, rest)| p - rest).collect();
    let row = |i: usize| graph.dot(inverse.row(i).iter().copied(), right.iter().copied());
    Some((0..size).map(row).collect())
}
