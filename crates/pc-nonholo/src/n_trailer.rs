//! A car with any number of trailers.

use pc_mech::{Expr, Graph, System, SystemBuilder};

use crate::error::NonholoError;
use crate::reduction::constrained::Constrained;

/// A body on one axle that does not slip sideways.
#[derive(Clone, Copy, Debug)]
pub struct Wagon<'g> {
    /// Mass.
    pub mass: Expr<'g>,
    /// The moment of inertia about the vertical through the mass centre.
    pub inertia: Expr<'g>,
    /// The distance by which the mass centre is ahead of the axle.
    pub ahead: Expr<'g>,
}

/// A car with n trailers, each hitched to the midpoint of the axle in front of it [Laumond 1993].
///
/// The coordinates are the midpoint (x, y) of the car's axle and the headings θ0..θn; the quasi-velocities
/// are the car's speed v, its turning rate ω, and the sideways velocities u0..un of the axles, which the
/// wheels prevent. If v_i is the forward speed of axle i and ℓ_i its distance from the preceding axle,
///
///   v_i = v_{i−1} cos δ − u_{i−1} sin δ,   ℓ_i θ̇_i = v_{i−1} sin δ + u_{i−1} cos δ − u_i,   δ = θ_{i−1} − θ_i.
///
/// ```
/// use pc_mech::Graph;
/// use pc_nonholo::{NTrailer, Wagon};
///
/// let graph = Graph::new();
/// let [m, j, l, w] = graph.symbols(["m", "J", "l", "ω"]);
/// let wagon = Wagon { mass: m, inertia: j, ahead: 0.into() };
/// let train = (0..3).fold(NTrailer::new(&graph, wagon), |train, _| train.trailer(l, wagon)).constrained()?;
/// // Only v and ω are free, and the heading of the first trailer follows.
/// assert_eq!(train.equations().right_hand_side().len(), 2);
/// let [v, car, first] = graph.symbols(["v", "θ0", "θ1"]);
/// assert_eq!(train.equations().velocities()[2..4], [w, v * (car - first).sin() / l]);
/// # Ok::<(), pc_nonholo::NonholoError>(())
/// ```
#[derive(Clone, Debug)]
pub struct NTrailer<'g> {
    graph: &'g Graph,
    car: Wagon<'g>,
    /// The distance ℓ_i and the body of each trailer.
    trailers: Vec<(Expr<'g>, Wagon<'g>)>,
}

/// The motion of an axle: v_i, u_i and θ̇_i.
#[derive(Clone, Copy)]
struct Axle<'g> {
    ahead: Expr<'g>,
    sideways: Expr<'g>,
    turning: Expr<'g>,
}

impl<'g> NTrailer<'g> {
    /// The car alone.
    pub fn new(graph: &'g Graph, car: Wagon<'g>) -> NTrailer<'g> {
        NTrailer { graph, car, trailers: Vec::new() }
    }

    /// The train with one more trailer at its end, whose axle is at the distance `length` from the last axle.
    #[must_use]
    pub fn trailer(mut self, length: Expr<'g>, wagon: Wagon<'g>) -> Self {
        self.trailers.push((length, wagon));
        self
    }

    /// The symbols u0..un of the quasi-velocities that vanish.
    pub fn slips(&self) -> Vec<Expr<'g>> {
        (0..=self.trailers.len()).map(|i| self.graph.symbol(&format!("u{i}"))).collect()
    }

    /// The system without its constraints, to which parameters, forces and outputs can be added.
    pub fn builder(&self) -> SystemBuilder<'g> {
        let names =
            |letter: &str| (0..=self.trailers.len()).map(|i| format!("{letter}{i}")).collect::<Vec<_>>();
        System::builder(self.graph)
            .coordinates([vec!["x".to_owned(), "y".to_owned()], names("θ")].concat())
            .quasi_velocities([vec!["v".to_owned(), "ω".to_owned()], names("u")].concat())
            .kinematics(|_, x, eta| {
                let (heading, velocity) = (x[2], self.axles(x, eta));
                let (s, c) = (heading.sin(), heading.cos());
                let car = velocity[0];
                let place = [car.ahead * c - car.sideways * s, car.ahead * s + car.sideways * c];
                place.into_iter().chain(velocity.into_iter().map(|axle| axle.turning)).collect::<Vec<_>>()
            })
            .kinetic(|_, x, eta| {
                let wagons = std::iter::once(&self.car).chain(self.trailers.iter().map(|(_, wagon)| wagon));
                self.graph.sum(wagons.zip(self.axles(x, eta)).map(|(wagon, axle)| {
                    let across = axle.sideways + wagon.ahead * axle.turning;
                    let along = wagon.mass * (axle.ahead.square() + across.square());
                    (along + wagon.inertia * axle.turning.square()) / 2.0
                }))
            })
    }

    /// The equations of motion without forces.
    ///
    /// # Errors
    /// [`NonholoError::Mech`], for example if a length or all masses are zero.
    pub fn constrained(&self) -> Result<Constrained<'g>, NonholoError> {
        Constrained::new(&self.builder().build()?, &self.slips())
    }

    /// The motion of each axle, from the car's to the last, for x = (x, y, θ0..θn) and η = (v, ω, u0..un).
    fn axles(&self, x: &[Expr<'g>], eta: &[Expr<'g>]) -> Vec<Axle<'g>> {
        let mut axles = vec![Axle { ahead: eta[0], sideways: eta[2], turning: eta[1] }];
        for (i, &(length, _)) in self.trailers.iter().enumerate() {
            let (before, sideways) = (axles[i], eta[i + 3]);
            let (s, c) = ((x[i + 2] - x[i + 3]).sin(), (x[i + 2] - x[i + 3]).cos());
            axles.push(Axle {
                ahead: before.ahead * c - before.sideways * s,
                sideways,
                turning: (before.ahead * s + before.sideways * c - sideways) / length,
            });
        }
        axles
    }
}
