//! All printed expressions of equations, in the graph of a page.
//!
//! A page has its own graph, in which expressions keep the form in which they are written and are not
//! rewritten into the form that is cheapest to compute.

use pc_algebra::{CATALOGUE, LieAlgebra, StructureCoefficients};
use pc_expr::{Function, Given, Graph};
use pc_mech::{Canonical, Constraint, Equations, Expr, Matrix, System};
use pc_model::Assembly;
use pc_nonholo::ConstraintKind;

use crate::equations::derived::Derived;
use crate::equations::principle::{ForceSheet, MaggiSheet, Principle, SMALL, shorter};

/// The contents of a page of equations of motion.
#[derive(Clone, Debug)]
pub struct Sheet<'p> {
    /// Parameters with their numbers.
    pub parameters: Vec<(String, f64)>,
    /// Coordinates x.
    pub coordinates: Vec<Expr<'p>>,
    /// Independent quasi-velocities η, those of the equations.
    pub quasi_velocities: Vec<Expr<'p>>,
    /// The quasi-velocities that are not those of the model, each with its definition.
    pub changed: Vec<(Expr<'p>, Expr<'p>)>,
    /// The vanishing left-hand sides, with the names of the constraints.
    pub constraints: Vec<(String, Expr<'p>, ConstraintKind)>,
    /// The matrix b and the column b_0 of ẋ = b η + b_0 (3).
    pub frame: (Matrix<Expr<'p>>, Vec<Expr<'p>>),
    /// Each ẋ_i with its expression.
    pub rates: Vec<(Expr<'p>, Expr<'p>)>,
    /// The brackets that are not zero.
    pub brackets: Brackets<'p>,
    /// The equations of motion.
    pub balance: Balance<'p>,
    /// Each ż_j with its expression.
    pub states: Vec<(Expr<'p>, Expr<'p>)>,
    /// The energy, or Hamilton's function.
    pub energy: Expr<'p>,
    /// A remark on the energy.
    pub energy_remark: Option<&'static str>,
    /// Each reaction with its expression.
    pub reactions: Vec<(Expr<'p>, Expr<'p>)>,
    /// Each velocity with the force of the reactions on it.
    pub reaction_forces: Vec<(Expr<'p>, Expr<'p>)>,
    /// The definitions that the model makes.
    pub definitions: Vec<Given<'p>>,
}

/// The equations of motion in one of two kinds of variables, or by one of the principles of mechanics.
#[derive(Clone, Debug)]
pub enum Balance<'p> {
    /// M η̇ = r.
    Velocities {
        /// M
        mass: Matrix<Expr<'p>>,
        /// η̇
        accelerations: Vec<Expr<'p>>,
        /// r in the form in which it is computed.
        right: Vec<Expr<'p>>,
        /// r as sums of products of quasi-velocities, if it is a polynomial.
        written: Vec<Expr<'p>>,
    },
    /// ẏ = r.
    Momenta {
        /// y
        momenta: Vec<Expr<'p>>,
        /// ẏ
        rates: Vec<Expr<'p>>,
        /// y = ∂L/∂η as functions of η.
        of_velocities: Vec<Expr<'p>>,
        /// η as functions of y; none if the equations are not closed, in which case η in the equations
        /// denotes the solution of y = ∂L/∂η.
        velocities: Option<Vec<Expr<'p>>>,
        /// r in the form in which it is computed.
        right: Vec<Expr<'p>>,
        /// r as sums of products of momenta, if it is a polynomial.
        written: Vec<Expr<'p>>,
    },
    /// Maggi's equations.
    Maggi(MaggiSheet<'p>),
    /// Kane's or Gibbs–Appell's equations.
    Forces(ForceSheet<'p>),
}

/// The brackets [X_r, X_s] = c_rs^m X_m of the free operators and of X_0, the operator of time.
#[derive(Clone, Debug)]
pub struct Brackets<'p> {
    /// Names of X_1, …: the free quasi-velocities, then those that vanish.
    pub operators: Vec<String>,
    /// The brackets that are not zero.
    pub nonzero: Vec<Bracket<'p>>,
    /// Whether the free operators commute.
    pub commute: bool,
    /// Whether components along nonholonomic constraints are left out.
    pub left_out: bool,
    /// The name of the algebra of the operators, if it is a known one.
    pub algebra: Option<&'static str>,
}

/// One bracket.
#[derive(Clone, Debug)]
pub struct Bracket<'p> {
    /// r < s
    pub pair: [usize; 2],
    /// The coefficients c_rs^m that are not zero, each with its m.
    pub components: Vec<(usize, Expr<'p>)>,
}

impl<'p> Sheet<'p> {
    /// The sheet of equations in velocities, in the graph of a page.
    pub fn of_velocities<'g>(assembly: &Assembly<'g>, derived: &Derived<'g>, page: &'p Graph) -> Sheet<'p> {
        let equations: &Equations<'g> = &derived.equations;
        let system = equations.system();
        let writing = Writing::new(system, system.quasi_velocities(), page);
        let forces = |balance, gibbs| {
            Balance::Forces(ForceSheet::of(balance, gibbs, (system, &assembly.system), page))
        };
        let (balance, energy) = match &derived.principle {
            Principle::Poincare => writing.solved(equations),
            Principle::Maggi(maggi) => {
                (Balance::Maggi(MaggiSheet::of(maggi, system, page)), writing.one(equations.energy()))
            }
            Principle::Kane(balance) => (forces(balance, false), writing.one(equations.energy())),
            Principle::GibbsAppell(balance) => (forces(balance, true), writing.one(equations.energy())),
        };
        let rates = system.states().iter().map(|&(_, rate)| rate).collect::<Vec<_>>();
        let parts = Parts {
            vanishing: &derived.vanishing,
            velocities: equations.velocities(),
            states: &rates,
            energy,
        };
        writing.sheet(assembly, derived, &parts, balance)
    }

    /// The sheet of canonical equations, in the graph of a page.
    pub fn of_momenta<'g>(
        assembly: &Assembly<'g>,
        derived: &Derived<'g>,
        equations: &Canonical<'g>,
        page: &'p Graph,
    ) -> Sheet<'p> {
        let system = equations.system();
        let moving = [system.quasi_velocities(), equations.momenta()].concat();
        let writing = Writing::new(system, &moving, page);
        let right = writing.all(equations.right_hand_side());
        let written = shorter(right.clone(), equations.written(page), page);
        let balance = Balance::Momenta {
            momenta: writing.all(equations.momenta()),
            rates: equations.momenta().iter().map(|y| writing.rate(y)).collect(),
            of_velocities: writing.all(equations.momenta_of_velocities()),
            velocities: equations.is_closed().then(|| writing.all(equations.quasi_velocities())),
            written,
            right,
        };
        let parts = Parts {
            vanishing: &[],
            velocities: equations.velocities(),
            states: equations.state_rates(),
            energy: writing.one(equations.hamiltonian()),
        };
        let derived = Derived { reactions: Vec::new(), ..derived.clone() };
        writing.sheet(assembly, &derived, &parts, balance)
    }
}

/// The parts of the equations whose names differ between forms.
struct Parts<'a, 'g, 'p> {
    vanishing: &'a [Expr<'g>],
    velocities: &'a [Expr<'g>],
    states: &'a [Expr<'g>],
    energy: Expr<'p>,
}

/// The expressions of a system rebuilt in the graph of a page.
struct Writing<'a, 'g, 'p> {
    system: &'a System<'g>,
    page: &'p Graph,
}

impl<'a, 'g, 'p> Writing<'a, 'g, 'p> {
    /// Creates the symbols of the page in the order that a book would use: parameters, coordinates, then
    /// velocities or momenta.
    fn new(system: &'a System<'g>, moving: &[Expr<'g>], page: &'p Graph) -> Writing<'a, 'g, 'p> {
        let parameters = system.parameters().iter().map(|(symbol, _)| symbol);
        for symbol in parameters.chain(system.frame().coordinates()).chain(moving) {
            page.symbol(&symbol.symbol_name().unwrap_or_default());
        }
        Writing { system, page }
    }

    fn all(&self, expressions: &[Expr<'g>]) -> Vec<Expr<'p>> {
        self.system.graph().typeset(expressions, self.page)
    }

    fn one(&self, expression: Expr<'g>) -> Expr<'p> {
        self.all(&[expression])[0]
    }

    fn matrix(&self, matrix: &Matrix<Expr<'g>>) -> Matrix<Expr<'p>> {
        let entries = self.all(&matrix.nonzero_entries());
        let mut entries = entries.into_iter();
        let row = |i| matrix.nonzero(i).map(|(j, _)| j).zip(entries.by_ref()).collect();
        Matrix::from_rows(matrix.columns(), (0..matrix.rows()).map(row).collect())
    }

    /// The equations M η̇ = r, with their energy.
    fn solved(&self, equations: &Equations<'g>) -> (Balance<'p>, Expr<'p>) {
        let right = self.all(equations.right_hand_side());
        let written = shorter(right.clone(), equations.written(self.page), self.page);
        let mass = self.matrix(equations.mass_matrix());
        let energy = self.energy(equations, &mass);
        let accelerations = self.system.quasi_velocities().iter().map(|eta| self.rate(eta)).collect();
        (Balance::Velocities { mass, accelerations, right, written }, energy)
    }

    /// The energy; if it is long, it is written as ½ M_rs η_r η_s plus the rest, provided that this is shorter,
    /// since the `mass` matrix is printed anyway.
    fn energy(&self, equations: &Equations<'g>, mass: &Matrix<Expr<'p>>) -> Expr<'p> {
        let (graph, eta) = (self.system.graph(), self.system.quasi_velocities());
        let energy = equations.energy();
        let whole = self.one(energy);
        let at_rest: Vec<(Expr<'g>, Expr<'g>)> = eta.iter().map(|&eta| (eta, Expr::ZERO)).collect();
        let rest = graph.substitute(&[energy], &at_rest)[0];
        let squares = |matrix: &Matrix<Expr<'g>>| {
            let row = |r: usize| matrix.nonzero(r).map(move |(s, entry)| 0.5 * entry * eta[r] * eta[s]);
            graph.sum((0..matrix.rows()).flat_map(row))
        };
        if rest.is_undefined() || !(squares(equations.mass_matrix()) + rest - energy).is_zero() {
            return whole;
        }
        let moving = self.all(eta);
        let below = |r: usize| mass.nonzero(r).filter(move |&(s, _)| s <= r);
        let term = |r: usize, s: usize, entry: Expr<'p>| match r == s {
            true => 0.5 * entry * moving[r].square(),
            false => entry * moving[r] * moving[s],
        };
        let moving = (0..mass.rows()).flat_map(|r| below(r).map(move |(s, entry)| term(r, s, entry)));
        let divided = self.page.sum(moving.chain([self.one(rest)]));
        let printed = mass.nonzero_entries();
        let beside = |energy: Expr<'p>| self.page.size(&[&printed[..], &[energy]].concat());
        let is_long = self.page.size(&[whole]) > SMALL / 2;
        if is_long && beside(divided) < beside(whole) { divided } else { whole }
    }

    /// Each ẋ_i with its value, with sines and cosines merged if that is shorter: for linkages this gives the
    /// law of sines.
    fn rates(&self, values: &[Expr<'g>]) -> Vec<(Expr<'p>, Expr<'p>)> {
        let (graph, x) = (self.system.graph(), self.system.frame().coordinates());
        let plain = self.all(values);
        // Forms not needed are not made in the graph: of equal values the first form made is used in later
        // ones.
        let of_angles = |&value: &Expr<'g>| {
            graph.applies(value, x, |function| matches!(function, Function::Sin | Function::Cos))
        };
        let has_angles = values.iter().any(of_angles);
        let merged = if has_angles { self.all(&graph.merged_angles(values)) } else { plain.clone() };
        let shorter = if self.page.size(&merged) < self.page.size(&plain) { merged } else { plain };
        self.system.frame().coordinates().iter().map(|x| self.rate(x)).zip(shorter).collect()
    }

    /// The brackets, with their components along the `vanishing` quasi-velocities if the form includes these.
    fn brackets(&self, derived: &Derived<'g>, vanishing: &[Expr<'g>]) -> Brackets<'p> {
        let system = self.system;
        let is_within = system.structure().operators() == system.quasi_velocities().len();
        let is_nonholonomic = |(_, kind): &(Constraint<'g>, ConstraintKind)| {
            matches!(kind, ConstraintKind::Nonholonomic { .. })
        };
        let within = Brackets::of(system, vanishing, self.page);
        if !derived.dependent.is_empty() {
            return self.along_constraints(derived, &within);
        }
        let left_out = (is_within || vanishing.is_empty()) && derived.constraints.iter().any(is_nonholonomic);
        Brackets { left_out, ..within }
    }

    /// The brackets of the operators ∂/∂x_i + α_ri ∂/∂x_r of Voronets' equations, c_ji^r ∂/∂x_r, in which the operators ∂/∂x_r
    /// have the names of the ẋ_r.
    fn along_constraints(&self, derived: &Derived<'g>, within: &Brackets<'p>) -> Brackets<'p> {
        let free = within.operators.len();
        let nonzero = derived.coefficients.iter().map(|bracket| Bracket {
            pair: bracket.pair,
            components: bracket.components.iter().map(|&(r, c)| (free + r + 1, self.one(c))).collect(),
        });
        let dependent = derived.dependent.iter().map(Expr::to_string);
        Brackets {
            nonzero: nonzero.collect(),
            commute: derived.coefficients.is_empty(),
            operators: within.operators.iter().cloned().chain(dependent).collect(),
            ..within.clone()
        }
    }

    /// The symbol of a rate.
    fn rate(&self, x: &Expr<'g>) -> Expr<'p> {
        self.page.symbol(&format!("{x}'"))
    }

    fn sheet(
        &self,
        assembly: &Assembly<'g>,
        derived: &Derived<'g>,
        parts: &Parts<'_, 'g, 'p>,
        balance: Balance<'p>,
    ) -> Sheet<'p> {
        let system = self.system;
        let frame = system.frame();
        let with_rates = |symbols: &[Expr<'g>], values: &[Expr<'g>]| -> Vec<(Expr<'p>, Expr<'p>)> {
            symbols.iter().map(|x| self.rate(x)).zip(self.all(values)).collect()
        };
        let states: Vec<Expr<'g>> = system.states().iter().map(|&(z, _)| z).collect();
        let constraints = derived.constraints.iter();
        let constraints = constraints
            .map(|(constraint, kind)| {
                (constraint.name().to_owned(), self.one(derived.vanishing(constraint)), *kind)
            })
            .collect();
        let both = |list: &[(Expr<'g>, Expr<'g>)]| -> Vec<(Expr<'p>, Expr<'p>)> {
            list.iter().map(|&(name, value)| (self.one(name), self.one(value))).collect()
        };
        let definitions = assembly.definitions.iter();
        let definitions = definitions
            .map(|(name, value)| Given { name: name.clone(), value: self.one(*value), shorthand: false })
            .collect();
        Sheet {
            parameters: system
                .parameters()
                .iter()
                .map(|(symbol, value)| (symbol.to_string(), *value))
                .collect(),
            coordinates: self.all(frame.coordinates()),
            quasi_velocities: self.all(system.quasi_velocities()),
            changed: both(&derived.quasi_velocities),
            constraints,
            frame: (self.matrix(frame.b()), self.all(frame.b0())),
            rates: self.rates(parts.velocities),
            brackets: self.brackets(derived, parts.vanishing),
            balance,
            states: with_rates(&states, parts.states),
            energy: parts.energy,
            energy_remark: derived.energy_remark,
            reactions: both(&derived.reactions),
            reaction_forces: both(&derived.reaction_forces),
            definitions,
        }
    }
}

impl<'p> Brackets<'p> {
    /// The brackets of a system, including components along vanishing quasi-velocities, in the graph of a
    /// page.
    pub(crate) fn of<'g>(system: &System<'g>, vanishing: &[Expr<'g>], page: &'p Graph) -> Brackets<'p> {
        let (structure, free) = (system.structure(), system.quasi_velocities());
        let one = |expression: Expr<'g>| system.graph().typeset(&[expression], page)[0];
        let operators: Vec<String> = free.iter().chain(vanishing).map(Expr::to_string).collect();
        let nonzero: Vec<_> =
            structure.nonzero().filter(|&(_, s, m, _)| s <= free.len() && m <= operators.len()).collect();
        let pairs = nonzero.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).map(|pair| {
            let components = pair.iter().map(|&(_, _, m, c)| (m, one(c))).collect();
            Bracket { pair: [pair[0].0, pair[0].1], components }
        });
        Brackets {
            operators,
            nonzero: pairs.collect(),
            commute: nonzero.is_empty() && system.frame().restricted(free.len()).commutes(),
            left_out: false,
            algebra: recognised(structure).filter(|_| vanishing.is_empty()),
        }
    }
}

/// The name of the algebra, if the structure coefficients are those of an algebra in the catalogue.
pub fn recognised(structure: &StructureCoefficients<'_>) -> Option<&'static str> {
    let algebra = structure.lie_algebra().filter(|_| structure.nonzero().all(|(r, ..)| r > 0))?;
    let known = CATALOGUE.iter().find(|entry| LieAlgebra::named(entry.name).as_ref() == Ok(&algebra));
    known.map(|entry| entry.name)
}
