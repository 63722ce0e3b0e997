//! The ways in which one page states the equations of motion: each has to give the same accelerations.

use pc_mech::{Expr, Graph};
use pc_print::{Balance, ForceSheet, InertiaSheet, MaggiSheet, Sheet};

/// The equations M η̇ = r, or ẏ = r, as one part of a page states them.
pub(crate) struct Way<'g> {
    /// Appended to the name of a rate.
    pub(crate) label: &'static str,
    /// M row by row; empty if rates of momenta are printed.
    pub(crate) mass: Vec<Expr<'g>>,
    pub(crate) right: Vec<Expr<'g>>,
}

/// The equations in every way in which they are printed; `time` is the symbol of time on the page.
pub(crate) fn ways<'g>(sheet: &Sheet<'g>, time: Expr<'g>, page: &'g Graph) -> Vec<Way<'g>> {
    let both = |mass: Vec<Expr<'g>>, right: &[Expr<'g>], written: &[Expr<'g>]| {
        let plain = Way { label: "", mass: mass.clone(), right: right.to_vec() };
        vec![plain, Way { label: ", multiplied out", mass, right: written.to_vec() }]
    };
    match &sheet.balance {
        Balance::Velocities { mass, right, written, .. } => both(mass.entries().into_owned(), right, written),
        Balance::Momenta { right, written, .. } => both(Vec::new(), right, written),
        Balance::Maggi(maggi) => vec![of_maggi(maggi, sheet, time, page)],
        Balance::Forces(forces) => of_forces(forces, page),
    }
}

/// ẋ_i = b_is η_s + b_i0 in forms of forces, of which Kane's prints b beside ẋ, as partial velocities; nothing for other forms.
pub(crate) fn by_b<'g>(sheet: &Sheet<'g>, page: &'g Graph) -> Vec<Expr<'g>> {
    let Balance::Forces(_) = &sheet.balance else { return Vec::new() };
    let (b, b_0) = &sheet.frame;
    let terms = |i: usize| b.nonzero(i).map(|(s, entry)| entry * sheet.quasi_velocities[s]);
    (0..b.rows()).map(|i| page.sum(terms(i).chain([b_0[i]]))).collect()
}

/// Kane's and Gibbs–Appell's equations: as equations, and by their forces of inertia or Gibbs' function.
fn of_forces<'g>(forces: &ForceSheet<'g>, page: &'g Graph) -> Vec<Way<'g>> {
    let slopes = match &forces.inertia {
        InertiaSheet::Forces(inertia) => inertia.iter().map(|&force| -force).collect(),
        InertiaSheet::Gibbs(function) => page.gradient(*function, &forces.accelerations),
    };
    let label = match &forces.inertia {
        InertiaSheet::Forces(_) => ", by forces of inertia",
        InertiaSheet::Gibbs(_) => ", by Gibbs' function",
    };
    let way = |label: &'static str, slopes: &[Expr<'g>]| {
        Way::linear(label, slopes, &forces.active, &forces.accelerations, page)
    };
    vec![way("", &forces.slopes), way(label, &slopes)]
}

/// Maggi's equations, with ẋ and ẍ from the printed kinematics.
fn of_maggi<'g>(maggi: &MaggiSheet<'g>, sheet: &Sheet<'g>, time: Expr<'g>, page: &'g Graph) -> Way<'g> {
    let rate = |x: &Expr<'g>| page.symbol(&format!("{x}'"));
    let accelerations: Vec<Expr<'g>> = sheet.quasi_velocities.iter().map(rate).collect();
    let velocities: Vec<Expr<'g>> = sheet.rates.iter().map(|&(_, value)| value).collect();
    let x = sheet.coordinates.iter().copied().zip(velocities.iter().copied());
    let eta = sheet.quasi_velocities.iter().copied().zip(accelerations.iter().copied());
    let along: Vec<_> = x.chain(eta).chain(page.in_time(time)).collect();
    let second = page.directional(&velocities, &along);
    let moving = sheet.rates.iter().map(|&(symbol, _)| symbol);
    let known: Vec<_> =
        moving.clone().zip(velocities).chain(moving.map(|symbol| rate(&symbol)).zip(second)).collect();
    let sums = page.substitute(&maggi.sums, &maggi.expressions);
    let sums = page.substitute(&sums, &known);
    let zeros = vec![Expr::ZERO; sums.len()];
    Way::linear("", &sums, &zeros, &accelerations, page)
}

impl<'g> Way<'g> {
    /// The equations left(η̇) = right, whose left-hand sides are affine in η̇.
    fn linear(
        label: &'static str,
        left: &[Expr<'g>],
        right: &[Expr<'g>],
        accelerations: &[Expr<'g>],
        page: &'g Graph,
    ) -> Way<'g> {
        let at_rest: Vec<_> = accelerations.iter().map(|&symbol| (symbol, Expr::ZERO)).collect();
        let rest = page.substitute(left, &at_rest);
        Way {
            label,
            mass: left.iter().flat_map(|&left| page.gradient(left, accelerations)).collect(),
            right: right.iter().zip(rest).map(|(&right, rest)| right - rest).collect(),
        }
    }
}
