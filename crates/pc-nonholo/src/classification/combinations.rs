//! Combinations of constraints that have an integral although no single constraint has one.

use pc_mech::{Constraint, Expr, Graph, Multipliers, Number, System};

use crate::classification::classification::ConstraintKind;
use crate::classification::involutive::along;
use crate::classification::reach::{Reach, affine};
use crate::error::NonholoError;

/// A combination μ_α φ_α = dF/dt of nonholonomic constraints φ_α = C_α η + c_α0: these constraints keep F(t,
/// x) constant.
#[derive(Clone, Debug, PartialEq)]
pub struct IntegrableCombination<'g> {
    /// The names of the constraints, each with its coefficient μ_α(t, x); none of these is 0.
    pub coefficients: Vec<(String, Expr<'g>)>,
    /// F
    pub integral: Expr<'g>,
}

/// A differential form f_i dx_i + f_0 dt that is a linear combination of the forms of the constraints.
#[derive(Clone)]
struct Form<'g> {
    /// The coefficients of the combination, one for each constraint.
    coefficients: Vec<Expr<'g>>,
    /// f_1..f_n, f_0
    components: Vec<Expr<'g>>,
}

impl<'g> IntegrableCombination<'g> {
    /// Finds combinations in closed form among the `count` independent ones that constraints of these `kinds`
    /// [have](crate::ConstraintClassification::integrable_combinations): combinations whose coefficients are
    /// constant, or functions of time and coordinates, or constant for the given values of the parameters. The
    /// combinations found are independent of each other, and their integrability is proved. No combination is
    /// found unless there are as many quasi-velocities as coordinates.
    ///
    /// `at` are values of time, coordinates, quasi-velocities and parameters where the constraints are regular.
    ///
    /// # Errors
    /// As for [`ConstraintClassification::new`](crate::ConstraintClassification::new).
    ///
    /// ```
    /// use pc_mech::{Constraint, Graph, System};
    /// use pc_nonholo::{ConstraintClassification, IntegrableCombination};
    ///
    /// // ż = y ẋ and ẇ = y ẋ + ẏ: neither binds positions, but z − w + y is constant.
    /// let graph = Graph::new();
    /// let particle = System::builder(&graph)
    ///     .coordinates(["x", "y", "z", "w"])
    ///     .lagrangian(|_, _, v| v.iter().map(|v| v.square()).sum())
    ///     .build()?;
    /// let [y, z, w, vx, vy, vz, vw] = graph.symbols(["y", "z", "w", "x'", "y'", "z'", "w'"]);
    /// let constraints = [Constraint::new("a", vz - y * vx), Constraint::new("b", vw - y * vx - vy)];
    /// let at: Vec<_> =
    ///     ["x", "y", "z", "w", "x'", "y'", "z'", "w'", "t"].map(|name| (graph.symbol(name), 0.5)).into();
    /// let all = ConstraintClassification::new(&particle, &constraints, &at)?;
    /// assert_eq!(all.integrable_combinations(), 1);
    /// let held = all.multipliers().unwrap();
    /// let found = IntegrableCombination::find(held, all.kinds(), 1, &at)?;
    /// assert_eq!(found[0].integral, z - w + y);
    /// # Ok::<(), pc_nonholo::NonholoError>(())
    /// ```
    pub fn find(
        multipliers: &Multipliers<'g>,
        kinds: &[ConstraintKind],
        count: usize,
        at: &[(Expr<'g>, f64)],
    ) -> Result<Vec<IntegrableCombination<'g>>, NonholoError> {
        let (places, Some(multipliers)) = affine(multipliers)? else { return Ok(Vec::new()) };
        if count == 0 {
            return Ok(Vec::new());
        }
        let system = multipliers.equations().system();
        let reach = Reach::new(&multipliers, at)?;
        let Some(forms) = forms(system, &reach) else { return Ok(Vec::new()) };
        let kinds = places.into_iter().map(|a| kinds[a]).enumerate();
        let nonholonomic = kinds.filter(|(_, kind)| matches!(kind, ConstraintKind::Nonholonomic { .. }));
        let nonholonomic = nonholonomic.map(|(a, _)| a).collect();
        let search = Search { system, nonholonomic, reach: &reach, variables: variables(system) };
        let mut found: Vec<(Form<'g>, Expr<'g>)> = Vec::new();
        // Parameters are replaced by numbers only if nothing is found otherwise.
        let ways: [&dyn Fn() -> Vec<(Form<'g>, Expr<'g>)>; 3] =
            [&|| search.with_constants(&forms), &|| search.with_functions(&forms, count), &|| {
                search.with_constants(&search.bound(&forms))
            }];
        for way in ways {
            if found.len() < count {
                for (form, integral) in way() {
                    if search.is_new(&found, integral) && search.is_kept(integral) {
                        found.push((form, integral));
                    }
                }
            }
        }
        let names: Vec<&str> = multipliers.constraints().iter().map(Constraint::name).collect();
        let named = |form: Form<'g>| {
            let all = names.iter().map(|&name| name.to_owned()).zip(form.coefficients);
            all.filter(|(_, mu)| !mu.is_zero()).collect()
        };
        let combination = |(form, integral)| IntegrableCombination { coefficients: named(form), integral };
        Ok(found.into_iter().take(count).map(combination).collect())
    }
}

/// (x, t)
fn variables<'g>(system: &System<'g>) -> Vec<Expr<'g>> {
    system.frame().coordinates().iter().copied().chain([system.frame().time()]).collect()
}

/// The forms φ_α dt = C_α (a dx + a_0 dt) + c_α0 dt (2), if the frame determines them.
fn forms<'g>(system: &System<'g>, reach: &Reach<'g>) -> Option<Vec<Form<'g>>> {
    let (graph, frame) = (system.graph(), system.frame());
    if frame.coordinates().len() != frame.operators() {
        return None;
    }
    let (a, a0) = frame.definitions().ok()?;
    let m = reach.rows.len();
    let form = |(alpha, row): (usize, &Vec<Expr<'g>>)| {
        let dx = (0..a.columns()).map(|i| graph.dot(row.iter().copied(), a.column(i)));
        let dt = reach.rests[alpha] + graph.dot(row.iter().copied(), a0.iter().copied());
        let components = graph.shorten(&dx.chain([dt]).collect::<Vec<_>>(), &[]);
        let unit = |beta| if beta == alpha { Expr::ONE } else { Expr::ZERO };
        Form { coefficients: (0..m).map(unit).collect(), components }
    };
    Some(reach.rows.iter().enumerate().map(form).collect())
}

struct Search<'a, 'g> {
    system: &'a System<'g>,
    /// The indices of the constraints that have no integral by themselves.
    nonholonomic: Vec<usize>,
    reach: &'a Reach<'g>,
    /// (x, t)
    variables: Vec<Expr<'g>>,
}

impl<'g> Search<'_, 'g> {
    fn graph(&self) -> &'g Graph {
        self.system.graph()
    }

    /// The forms with the present values of the parameters substituted.
    fn bound(&self, forms: &[Form<'g>]) -> Vec<Form<'g>> {
        let numbers = self.system.numbers();
        let bind = |form: &Form<'g>| Form {
            components: self.graph().substitute(&form.components, &numbers),
            ..form.clone()
        };
        forms.iter().map(bind).collect()
    }

    /// The combinations with rational coefficients that are closed, ∂f_i/∂x_j = ∂f_j/∂x_i, and whose integral can
    /// be found.
    fn with_constants(&self, forms: &[Form<'g>]) -> Vec<(Form<'g>, Expr<'g>)> {
        let of = |a: &usize| &forms[*a];
        let columns: Vec<Vec<Expr<'g>>> = self.nonholonomic.iter().map(|a| self.derivative(of(a))).collect();
        let relations = self.graph().linear_relations(&columns).into_iter();
        let sum = |relation: Vec<Number>| {
            let coefficients = relation.into_iter().map(Expr::from);
            let form = self.sum(coefficients.zip(self.nonholonomic.iter().map(of)));
            self.integrated(form)
        };
        relations.filter_map(sum).collect()
    }

    /// Combinations whose coefficients are functions of time and coordinates: those that vanish on all fields
    /// reached by commutators, solved for the differentials of some of the variables. Each cyclic order of
    /// the variables is tried.
    fn with_functions(&self, forms: &[Form<'g>], count: usize) -> Vec<(Form<'g>, Expr<'g>)> {
        let Some(vanishing) = self.vanishing(forms) else { return Vec::new() };
        let places = self.variables.len();
        let mut best = Vec::new();
        for first in 0..places {
            let order: Vec<usize> = (first..places).chain(0..first).collect();
            let solved = self.solved(vanishing.clone(), &order);
            let found: Vec<_> = solved.into_iter().filter_map(|form| self.integrated(form)).collect();
            if found.len() > best.len() {
                best = found;
            }
            if best.len() >= count {
                break;
            }
        }
        best
    }

    /// A basis of the combinations of nonholonomic constraints that vanish on the fields reached by
    /// commutators.
    fn vanishing(&self, forms: &[Form<'g>]) -> Option<Vec<Form<'g>>> {
        let graph = self.graph();
        // μ_α U^α = 0: each field reached eliminates one constraint from the others.
        let mut basis: Vec<(Form<'g>, Vec<Expr<'g>>)> = self
            .nonholonomic
            .iter()
            .map(|&a| {
                let along = self.reach.reached.iter().map(|along| graph.sum(along[a].iter().copied()));
                (forms[a].clone(), graph.shorten(&along.collect::<Vec<_>>(), &[]))
            })
            .collect();
        for field in 0..self.reach.reached.len() {
            let shortest = |&p: &usize| basis[p].1[field].tree_cost();
            let pivot =
                (0..basis.len()).filter(|&p| !self.is_zero(basis[p].1[field])).min_by_key(shortest)?;
            let (pivot_form, pivot_along) = basis.remove(pivot);
            for (form, along) in &mut basis {
                let factor = -along[field] / pivot_along[field];
                *form = self.sum([(Expr::ONE, &*form), (factor, &pivot_form)]);
                let eliminated = along.iter().zip(&pivot_along).map(|(&u, &p)| u + factor * p);
                *along = graph.shorten(&eliminated.collect::<Vec<_>>(), &[]);
            }
        }
        Some(basis.into_iter().map(|(form, _)| form).collect())
    }

    /// The forms solved for the differentials of the first variables, in this order, that the forms determine;
    /// each such differential has the coefficient 1 in one form and 0 in the others.
    fn solved(&self, mut forms: Vec<Form<'g>>, order: &[usize]) -> Vec<Form<'g>> {
        let mut done = 0;
        for &place in order {
            let Some(pivot) = (done..forms.len()).find(|&f| !self.is_zero(forms[f].components[place])) else {
                continue;
            };
            forms.swap(done, pivot);
            forms[done] = self.sum([(Expr::ONE / forms[done].components[place], &forms[done])]);
            let row = forms[done].clone();
            for (f, form) in forms.iter_mut().enumerate() {
                if f != done {
                    *form = self.sum([(Expr::ONE, &*form), (-form.components[place], &row)]);
                }
            }
            done += 1;
        }
        forms
    }

    /// The exterior derivative of a form: its components ∂f_i/∂x_j − ∂f_j/∂x_i.
    fn derivative(&self, form: &Form<'g>) -> Vec<Expr<'g>> {
        let rows: Vec<Vec<Expr<'g>>> =
            form.components.iter().map(|&f| self.graph().gradient(f, &self.variables)).collect();
        (0..rows.len()).flat_map(|i| (0..i).map(|j| rows[i][j] - rows[j][i]).collect::<Vec<_>>()).collect()
    }

    fn sum<'f>(&self, terms: impl IntoIterator<Item = (Expr<'g>, &'f Form<'g>)>) -> Form<'g>
    where
        'g: 'f,
    {
        let graph = self.graph();
        let zero = Form {
            coefficients: vec![Expr::ZERO; self.reach.rows.len()],
            components: vec![Expr::ZERO; self.variables.len()],
        };
        let add = |sum: &[Expr<'g>], factor: Expr<'g>, more: &[Expr<'g>]| -> Vec<Expr<'g>> {
            sum.iter().zip(more).map(|(&sum, &more)| sum + factor * more).collect()
        };
        let sum = terms.into_iter().fold(zero, |sum, (factor, form)| Form {
            coefficients: add(&sum.coefficients, factor, &form.coefficients),
            components: add(&sum.components, factor, &form.components),
        });
        Form {
            coefficients: graph.shorten(&sum.coefficients, &[]),
            components: graph.shorten(&sum.components, &[]),
        }
    }

    /// The form with its integral, if an integral is found.
    fn integrated(&self, form: Form<'g>) -> Option<(Form<'g>, Expr<'g>)> {
        let integral = self.graph().potential(&form.components, &self.variables)?;
        Some((form, integral))
    }

    /// Whether F is independent of the known integrals.
    fn is_new(&self, known: &[(Form<'g>, Expr<'g>)], integral: Expr<'g>) -> bool {
        // For the values of the parameters: some contain these as symbols, others as numbers.
        let all: Vec<Expr<'g>> = known.iter().map(|&(_, known)| known).chain([integral]).collect();
        let all = self.graph().substitute(&all, &self.system.numbers()).into_iter();
        let rows: Vec<Vec<Expr<'g>>> = all.map(|f| self.graph().gradient(f, &self.variables)).collect();
        self.graph().generic_rank(&rows) == rows.len()
    }

    /// Whether no allowed velocity changes F; this is verified numerically.
    fn is_kept(&self, integral: Expr<'g>) -> bool {
        let numbers = self.system.numbers();
        self.reach.allowed.iter().all(|field| {
            let rate = along(self.system, field, &[integral])[0];
            self.is_zero(self.graph().substitute(&[rate], &numbers)[0])
        })
    }

    fn is_zero(&self, value: Expr<'g>) -> bool {
        value.is_zero() || self.reach.near.vanishes(self.graph(), value)
    }
}
