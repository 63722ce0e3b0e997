//! A random model: what is written into its text, and what is known of it apart from the product.

use super::expression::Expression;

/// A coordinate in which the configurations of a specimen are described completely.
#[derive(Clone, Debug)]
pub struct Coordinate {
    /// Its name.
    pub name: String,
    /// Where it starts.
    pub start: f64,
    /// Whether the model has it. Where it has not, `[algebra]` says what the frame cannot.
    pub shown: bool,
}

/// A coordinate of the model that is a function of others, carried along by its kinematics.
#[derive(Clone, Debug)]
pub struct Carried {
    /// Its name.
    pub name: String,
    /// What it is, in the coordinates of the chart.
    pub value: Expression,
    /// Its rate, in coordinates and quasi-velocities of the model.
    pub velocity: Expression,
}

/// How velocities are described.
#[derive(Clone, Debug)]
pub enum Frame {
    /// η_s = ẋ_s
    Velocities,
    /// ẋ_i = b_ii η_i + Σ_{j<i} b_ij η_j + b_i0, given by `[kinematics]`.
    Triangular(Triangular),
    /// Left-invariant fields of a group, ẋ = b η + b_0 in `[kinematics]`, with η = a ẋ + a_0.
    Group {
        /// The quasi-velocities.
        eta: Vec<String>,
        /// ẋ of each coordinate of the chart.
        velocities: Vec<Expression>,
        /// η of each quasi-velocity.
        inverse: Vec<Expression>,
    },
    /// Quasi-velocities that are defined by `is`.
    Definitions(Vec<(String, Expression)>),
}

/// A frame ẋ = b η + b_0 with a lower triangular b.
#[derive(Clone, Debug)]
pub struct Triangular {
    /// The quasi-velocities, one for each coordinate.
    pub eta: Vec<String>,
    /// b_ii, which vanish nowhere.
    pub diagonal: Vec<Expression>,
    /// (i, j, b_ij), j < i
    pub lower: Vec<(usize, usize, Expression)>,
    /// b_i0
    pub drift: Vec<Expression>,
    /// The order in which the quasi-velocities are declared.
    pub order: Vec<usize>,
    /// Whether the text gives η by `is` rather than ẋ by `[kinematics]`.
    pub by_definitions: bool,
}

impl Triangular {
    fn velocities(&self) -> Vec<Expression> {
        (0..self.eta.len())
            .map(|i| {
                let mut terms = vec![Expression::product(vec![
                    self.diagonal[i].clone(),
                    Expression::symbol(&self.eta[i]),
                ])];
                terms.extend(self.lower.iter().filter(|entry| entry.0 == i).map(|(_, j, b)| {
                    Expression::product(vec![b.clone(), Expression::symbol(&self.eta[*j])])
                }));
                terms.push(self.drift[i].clone());
                Expression::sum(terms)
            })
            .collect()
    }

    fn inverse(&self, coordinates: &[Coordinate]) -> Vec<Expression> {
        let mut inverse: Vec<Expression> = Vec::new();
        for (i, coordinate) in coordinates.iter().enumerate() {
            let mut terms = vec![Expression::velocity(&coordinate.name), self.drift[i].clone().times(-1.0)];
            terms.extend(self.lower.iter().filter(|entry| entry.0 == i).map(|(_, j, b)| {
                Expression::product(vec![Expression::Number(-1.0), b.clone(), inverse[*j].clone()])
            }));
            inverse.push(Expression::sum(terms).over(self.diagonal[i].clone()));
        }
        inverse
    }
}

/// What a constraint restricts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Restricts {
    /// Positions; the expression keeps the value that it has at the start.
    Positions,
    /// Velocities: the expression, affine in them, vanishes.
    Velocities,
    /// Velocities: the expression, not affine in them, keeps the value that it has at the start.
    Nonlinearly,
}

/// A constraint.
#[derive(Clone, Debug)]
pub struct Constraint {
    /// Its name.
    pub name: String,
    /// What it restricts.
    pub restricts: Restricts,
    /// The expression, without the value that it keeps.
    pub expression: Expression,
}

/// A body.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// Its mass, which first-order states may change.
    pub mass: Expression,
    /// Where it is.
    pub position: [Expression; 3],
    /// The force on it.
    pub force: Option<[Expression; 3]>,
    /// Principal moments of inertia and how it turns.
    pub turning: Option<([f64; 3], Turning)>,
}

/// How a body turns.
#[derive(Clone, Debug)]
pub enum Turning {
    /// About the third axis by an angle, a multiple of a coordinate, on an axle tilted by a constant angle.
    About {
        /// The constant angle about the first axis.
        tilt: f64,
        /// The number of turns for one of the coordinate.
        ratio: f64,
        /// The coordinate.
        coordinate: String,
    },
    /// By its angular velocity in its own axes.
    AngularVelocity([Expression; 3]),
}

/// What happens where an expression passes through zero.
#[derive(Clone, Debug)]
pub struct Event {
    /// Its name.
    pub name: String,
    /// Where it vanishes.
    pub when: Expression,
    /// `rising`, `falling` or `both`.
    pub direction: &'static str,
    /// Whether it ends the motion.
    pub terminal: bool,
    /// New values of quasi-velocities, or of velocities `x'`.
    pub reset: Vec<(String, Expression)>,
}

/// A first-order state.
#[derive(Clone, Debug)]
pub struct State {
    /// Its name.
    pub name: String,
    /// Where it starts.
    pub start: f64,
    /// Its rate.
    pub rate: Expression,
}

/// A function of time that the text gives in numbers.
#[derive(Clone, Debug)]
pub enum Input {
    /// The same at all times.
    Constant(f64),
    /// A table.
    Table {
        /// In order.
        times: Vec<f64>,
        /// One for each.
        values: Vec<f64>,
        /// `linear`, `cubic` or `hold`.
        interpolation: &'static str,
    },
}

/// A random model.
#[derive(Clone, Debug)]
pub struct Specimen {
    /// Names and values of parameters.
    pub parameters: Vec<(String, f64)>,
    /// The coordinates of the configurations.
    pub chart: Vec<Coordinate>,
    /// Functions of these that the model has as coordinates.
    pub carried: Vec<Carried>,
    /// How velocities are described.
    pub frame: Frame,
    /// The text of `[algebra]`.
    pub algebra: Option<String>,
    /// The constraints.
    pub constraints: Vec<Constraint>,
    /// The terms of T.
    pub kinetic: Vec<Expression>,
    /// The terms of V.
    pub potential: Vec<Expression>,
    /// The terms of R.
    pub dissipation: Vec<Expression>,
    /// Forces on quasi-velocities or coordinates.
    pub forces: Vec<(String, Expression)>,
    /// Bodies.
    pub bodies: Vec<Body>,
    /// The acceleration with which bodies fall, of inputs and time.
    pub gravity: Option<[Expression; 3]>,
    /// First-order states, which stand in forces, energies and masses.
    pub states: Vec<State>,
    /// Inputs, which stand in forces, potentials and gravity.
    pub inputs: Vec<(String, Input)>,
    /// Functions that are asked for.
    pub outputs: Vec<(String, Expression)>,
    /// Events.
    pub events: Vec<Event>,
    /// Velocities of the coordinates before they are moved to where the constraints allow them.
    pub velocities: Vec<f64>,
    /// Start time.
    pub t_start: f64,
    /// End time, before the start where the motion is followed backwards.
    pub t_end: f64,
}

impl Specimen {
    /// The names of the quasi-velocities.
    pub fn quasi_velocities(&self) -> Vec<String> {
        match &self.frame {
            Frame::Velocities => Vec::new(),
            Frame::Triangular(frame) => frame.order.iter().map(|&s| frame.eta[s].clone()).collect(),
            Frame::Group { eta, .. } => eta.clone(),
            Frame::Definitions(definitions) => definitions.iter().map(|(name, _)| name.clone()).collect(),
        }
    }

    /// ẋ of each coordinate of the chart in quasi-velocities, where these determine it.
    pub fn chart_velocities(&self) -> Option<Vec<Expression>> {
        match &self.frame {
            Frame::Velocities => Some(self.chart.iter().map(|x| Expression::velocity(&x.name)).collect()),
            Frame::Triangular(frame) => Some(frame.velocities()),
            Frame::Group { velocities, .. } => Some(velocities.clone()),
            Frame::Definitions(_) => None,
        }
    }

    /// Each quasi-velocity, in the order of [`quasi_velocities`](Specimen::quasi_velocities), in ẋ of the chart.
    pub fn definitions(&self) -> Vec<(String, Expression)> {
        match &self.frame {
            Frame::Velocities => Vec::new(),
            Frame::Triangular(frame) => {
                let inverse = frame.inverse(&self.chart);
                frame.order.iter().map(|&s| (frame.eta[s].clone(), inverse[s].clone())).collect()
            }
            Frame::Group { eta, inverse, .. } => eta.iter().cloned().zip(inverse.iter().cloned()).collect(),
            Frame::Definitions(definitions) => definitions.clone(),
        }
    }

    /// Whether velocities do not vanish with the quasi-velocities: the energies of two frames differ then.
    pub fn has_drift(&self) -> bool {
        let zero: Vec<(String, Expression)> = self.chart.iter().map(at_rest).collect();
        self.definitions().iter().any(|(_, eta)| !eta.substitute(&zero).is_zero())
            || self.carried.iter().any(|carried| carried.value.mentions("t"))
    }

    /// Names of the coordinates of the model.
    pub fn coordinates(&self) -> Vec<String> {
        let shown = self.chart.iter().filter(|x| x.shown).map(|x| x.name.clone());
        shown.chain(self.carried.iter().map(|carried| carried.name.clone())).collect()
    }

    /// Every expression that a shorter model may have in a shorter form.
    pub fn expressions_mut(&mut self) -> Vec<&mut Expression> {
        let mut all: Vec<&mut Expression> = Vec::new();
        match &mut self.frame {
            Frame::Velocities | Frame::Group { .. } => {}
            Frame::Triangular(frame) => {
                all.extend(&mut frame.drift);
                all.extend(&mut frame.diagonal);
                all.extend(frame.lower.iter_mut().map(|(_, _, b)| b));
            }
            Frame::Definitions(definitions) => all.extend(definitions.iter_mut().map(|(_, is)| is)),
        }
        all.extend(self.constraints.iter_mut().map(|constraint| &mut constraint.expression));
        all.extend(self.kinetic.iter_mut().chain(&mut self.potential).chain(&mut self.dissipation));
        all.extend(self.forces.iter_mut().chain(&mut self.outputs).map(|(_, value)| value));
        for body in &mut self.bodies {
            all.push(&mut body.mass);
            all.extend(body.position.iter_mut().chain(body.force.iter_mut().flatten()));
        }
        all.extend(self.gravity.iter_mut().flatten());
        all.extend(self.states.iter_mut().map(|state| &mut state.rate));
        for event in &mut self.events {
            all.push(&mut event.when);
            all.extend(event.reset.iter_mut().map(|(_, value)| value));
        }
        all
    }
}

/// ẋ = 0
pub(super) fn at_rest(coordinate: &Coordinate) -> (String, Expression) {
    (format!("{}'", coordinate.name), Expression::Number(0.0))
}
