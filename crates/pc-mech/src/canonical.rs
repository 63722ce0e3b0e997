//! Chetaev's canonical equations (10), (11).

use pc_expr::{Expr, Style};

use crate::book::expanded;
use crate::compiled::first_order::FirstOrder;
use crate::compiled::ldl::Factors;
use crate::compiled::motion::{LONGEST_ELIMINATION, Motion};
use crate::compiled::options::CompileOptions;
use crate::error::MechError;
use crate::legendre::Legendre;
use crate::system::System;

/// The canonical equations in coordinates and momenta y_s = ∂L/∂η_s, with H(t, x, y) = y_s η_s − L:
///
///   ẏ_s = (c_rs^m ∂H/∂y_r + c_0s^m) y_m − X_s H + Q_s   (10),   ẋ_i = b_i0 + b_is ∂H/∂y_s   (11).
///
/// With η = ẋ these are Hamilton's equations, in redundant coordinates (17), in quasi-coordinates (19).
#[derive(Clone, Debug)]
pub struct Canonical<'g> {
    system: System<'g>,
    legendre: Legendre<'g>,
    momenta: Vec<Expr<'g>>,
    quasi_velocities: Vec<Expr<'g>>,
    hamiltonian: Expr<'g>,
    velocities: Vec<Expr<'g>>,
    right: Vec<Expr<'g>>,
}

impl<'g> System<'g> {
    /// The symbols of the momenta y_s: `p_` before the name of the quasi-velocity, `p_x` for the velocity `x'`.
    pub fn momentum_symbols(&self) -> Vec<Expr<'g>> {
        let name = |eta: &Expr<'g>| format!("p_{}", eta.to_string().trim_end_matches('\''));
        self.quasi_velocities.iter().map(|eta| self.unused(name(eta), "p_")).collect()
    }

    /// The canonical equations (10), (11).
    ///
    /// # Errors
    /// [`MechError::NotQuadratic`] if ∂L/∂η cannot be solved for η in closed form,
    /// [`MechError::DegenerateLagrangian`] if it cannot at all.
    pub fn canonical(&self) -> Result<Canonical<'g>, MechError> {
        let graph = self.graph();
        let legendre = Legendre::of(self)?;
        let momenta = self.momentum_symbols();
        let parameters = self.parameters.iter().map(|&(symbol, _)| symbol);
        let order: Vec<Expr<'g>> = momenta.iter().copied().chain(parameters).collect();

        let impulse = legendre.impulse(&momenta);
        let eta = graph.shorten(&Factors::of(graph, &legendre.mass).solve(graph, &impulse), &order);
        let kinetic = graph.dot(impulse.iter().copied(), eta.iter().copied()) / 2.0;
        let hamiltonian = graph.shorten(&[kinetic - legendre.lagrangian_at_rest], &order)[0];

        let slope = self.frame.contract(&graph.gradient(hamiltonian, self.frame.coordinates()));
        let gyroscopic = self.structure.gyroscopic(graph, &eta, &momenta);
        let values: Vec<_> = self.quasi_velocities.iter().copied().zip(eta.iter().copied()).collect();
        let forces = graph.substitute(&self.forces, &values);
        let right: Vec<Expr<'g>> =
            (0..eta.len()).map(|s| graph.sum([gyroscopic[s], -slope[s], forces[s]])).collect();
        graph.check(&right)?;
        Ok(Canonical {
            velocities: graph.shorten(&self.frame.velocities(&eta), &order),
            right: graph.shorten(&right, &order),
            system: self.clone(),
            quasi_velocities: eta,
            legendre,
            momenta,
            hamiltonian,
        })
    }
}

impl<'g> Canonical<'g> {
    /// The system they were derived from.
    pub fn system(&self) -> &System<'g> {
        &self.system
    }

    /// The symbols y_1..y_k of the momenta.
    pub fn momenta(&self) -> &[Expr<'g>] {
        &self.momenta
    }

    /// y_s = ∂L/∂η_s in terms of (t, x, η), length k.
    pub fn momenta_of_velocities(&self) -> Vec<Expr<'g>> {
        let order = self.system.collecting_order();
        self.system.graph().shorten(&self.system.momenta(), &order)
    }

    /// η_s = ∂H/∂y_s in terms of (t, x, y), length k.
    pub fn quasi_velocities(&self) -> &[Expr<'g>] {
        &self.quasi_velocities
    }

    /// H(t, x, y)
    pub fn hamiltonian(&self) -> Expr<'g> {
        self.hamiltonian
    }

    /// ẋ_i in terms of (t, x, y) (11), length n.
    pub fn velocities(&self) -> &[Expr<'g>] {
        &self.velocities
    }

    /// ẏ_s in terms of (t, x, y) (10), length k.
    pub fn right_hand_side(&self) -> &[Expr<'g>] {
        &self.right
    }

    /// The two sides of the equations (10), one pair of texts an equation: sums of products of momenta.
    pub fn balance(&self, style: Style) -> Vec<(String, String)> {
        let graph = self.system.graph();
        let sides = self.momenta.iter().zip(&self.right);
        sides
            .map(|(y, &right)| {
                let left = graph.symbol(&format!("{y}'")).display(style);
                (left, expanded(&self.system, right, &self.momenta, style))
            })
            .collect()
    }

    /// Compiles the equations as a vector field of the state (x, y); integrals, energy and outputs are observed as
    /// those of [`Equations`](crate::Equations) are.
    ///
    /// # Errors
    /// As for [`Equations::compile_for`](crate::Equations::compile_for).
    pub fn compile_for(&self, options: impl Into<CompileOptions>) -> Result<Motion, MechError> {
        self.first_order()?.compile(&options.into(), LONGEST_ELIMINATION)
    }

    /// The equations with w = η, M η = y − p_0: H need not be formed, since X_s H = −X_s L at fixed y and η.
    fn first_order(&self) -> Result<FirstOrder<'g>, MechError> {
        let (system, graph) = (&self.system, self.system.graph());
        let (x, eta) = (system.frame.coordinates(), &system.quasi_velocities);
        let slope = system.frame.contract(&graph.gradient(system.lagrangian, x));
        let gyroscopic = system.structure.gyroscopic(graph, eta, &self.momenta);
        let mut rates = system.frame.velocities(eta);
        rates.extend((0..eta.len()).map(|s| graph.sum([gyroscopic[s], slope[s], system.forces[s]])));
        let parameters = system.parameters.iter().map(|&(symbol, _)| symbol);
        Ok(FirstOrder {
            graph,
            time: system.frame.time(),
            state: x.iter().chain(&self.momenta).copied().collect(),
            coordinates: x.len(),
            parameters: system.run_time_inputs(),
            unknowns: eta.clone(),
            names: eta.iter().map(Expr::to_string).collect(),
            multipliers: 0,
            mass: self.legendre.mass.clone(),
            right: self.legendre.impulse(&self.momenta),
            rates: graph.shorten(&rates, &system.collecting_order()),
            collected_by: self.momenta.iter().copied().chain(parameters).collect(),
            observables: self.observables()?,
            conserved: system.integrals.len() + 1,
        })
    }

    /// Integrals, energy and outputs in terms of (t, x, η).
    fn observables(&self) -> Result<Vec<(String, Expr<'g>)>, MechError> {
        let (system, graph) = (&self.system, self.system.graph());
        let energy = ("energy".to_owned(), system.energy());
        let mut observables: Vec<_> =
            system.integrals.iter().chain([&energy]).chain(&system.outputs).cloned().collect();
        let symbols = system.accelerations();
        let values: Vec<Expr<'g>> = observables.iter().map(|&(_, value)| value).collect();
        if graph.symbols_of(&values).iter().any(|symbol| symbols.contains(symbol)) {
            let rates: Vec<_> = symbols.into_iter().zip(system.poincare()?.accelerations()).collect();
            for (_, value) in &mut observables {
                *value = graph.substitute(&[*value], &rates)[0];
            }
        }
        Ok(observables)
    }
}
