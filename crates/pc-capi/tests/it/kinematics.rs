//! The Coriolis matrix and the Jacobians of bodies and momenta are those of the crates below, and belong to the equations.

use std::ptr;

use crate::common::{Model, Refusal, System, c, call};
use ::pc_model::Variables;
use pc::*;
use pc_mech::VelocityMap;

const OWN: Variables = Variables::QuasiVelocities;

/// The names of a state, its coordinates and its quasi-velocities.
fn sizes(system: &System) -> (usize, usize) {
    // SAFETY: a live system.
    let (n, states) =
        unsafe { (pc_system_coordinate_count(system.0.as_ref()), pc_system_state_count(system.0.as_ref())) };
    (n, system.dim() - n - states)
}

fn of_body(
    system: &System,
    (t, y): (f64, &[f64]),
    body: &str,
    at: Option<[f64; 3]>,
) -> Result<Vec<f64>, Refusal> {
    let (name, (_, k)) = (c(body), sizes(system));
    let mut columns = vec![0.0; 6 * (k + 2)];
    let (point, count) = at.as_ref().map_or((ptr::null(), 0), |at| (at.as_ptr(), 3));
    // SAFETY: a live system, text, and arrays as said.
    call(|error| unsafe {
        let (out, length) = (columns.as_mut_ptr(), columns.len());
        pc_system_body_jacobian(
            system.0,
            t,
            y.as_ptr(),
            y.len(),
            name.as_ptr(),
            point,
            count,
            out,
            length,
            error,
        )
    })
    .map(|()| columns)
}

fn columns(map: &mut VelocityMap, t: f64, y: &[f64]) -> Vec<f64> {
    let (rows, k) = (map.functions(), map.quasi_velocities());
    let mut all = vec![0.0; rows * (k + 2)];
    let (matrix, others) = all.split_at_mut(rows * k);
    let (rest, rates) = others.split_at_mut(rows);
    map.map(t, y, matrix, rest).unwrap();
    map.rates(t, y, rates).unwrap();
    all
}

#[test]
fn the_numbers_are_those_of_the_crates_below() {
    for (name, body) in [("puma-560", "hand"), ("satellite", "left"), ("four-bar-loop", "coupler")] {
        let system = System::of(name);
        let (t, mut y) = system.start();
        let (n, k) = sizes(&system);
        y[n..].iter_mut().enumerate().for_each(|(s, eta)| *eta += 0.3 + 0.1 * s as f64);
        let model = ::pc_model::Model::new(::pc_model::Builtin::named(name).unwrap().document().unwrap());
        let body = model.body_names().into_iter().find(|known| known == body);
        let body = body.unwrap_or_else(|| panic!("{name}: {:?}", model.body_names()));
        // Derived by themselves, as the library does: the order of a sum depends on what the graph contains.
        let derived: Result<_, ::pc_model::ModelError> = model.derived(|assembly| {
            let equations = assembly.equations_in(OWN)?;
            assembly.placed(equations.coriolis_of_motion())
        });
        let mut coriolis = derived.unwrap();
        let mut expected = vec![0.0; k * k];
        coriolis.eval(t, &y, &mut expected).unwrap();
        assert_eq!(system.at(pc_system_coriolis, t, &y, k * k), Ok(expected));
        let expected =
            columns(&mut model.derived(|assembly| model.centroidal_map(assembly, OWN)).unwrap(), t, &y);
        assert_eq!(system.at(pc_system_centroidal, t, &y, 6 * (k + 2)), Ok(expected));
        let mut centre = model.derived(|assembly| model.centre_of_mass(assembly, OWN)).unwrap();
        let expected = columns(&mut centre.velocity, t, &y);
        assert_eq!(system.at(pc_system_centre_of_mass_jacobian, t, &y, 3 * (k + 2)), Ok(expected));
        let mut place = [0.0; 3];
        centre.position.eval(t, &y, &system.parameters(), &mut place);
        assert_eq!(system.at(pc_system_centre_of_mass, t, &y, 3), Ok(place.to_vec()));
        let mut map = model.derived(|assembly| model.body_map(assembly, OWN, &body)).unwrap();
        for at in [None, Some([0.1, -0.2, 0.3]), None] {
            map.arguments_mut().copy_from_slice(&at.unwrap_or_default());
            assert_eq!(of_body(&system, (t, &y), &body, at), Ok(columns(&mut map, t, &y)), "{name}");
        }
    }
}

/// The forces of inertia, C η, are those of inverse dynamics less their value at rest, for the arm that has dampers for
/// half the difference of opposite velocities.
#[test]
fn coriolis_forces_are_those_of_inverse_dynamics() {
    let system = System::of("puma-560");
    let (t, mut y) = system.start();
    let (n, k) = sizes(&system);
    y[n..].iter_mut().enumerate().for_each(|(s, eta)| *eta = 0.7 - 0.4 * s as f64);
    let c = system.at(pc_system_coriolis, t, &y, k * k).unwrap();
    let bias = |sign: f64| {
        let mut y = y.clone();
        y[n..].iter_mut().for_each(|eta| *eta *= sign);
        system.at(pc_system_right_hand_side, t, &y, k).unwrap()
    };
    let (there, back, rest) = (bias(1.0), bias(-1.0), bias(0.0));
    let product: Vec<f64> = (0..k).map(|s| (0..k).map(|m| c[s + k * m] * y[n + m]).sum()).collect();
    for s in 0..k {
        let quadratic = rest[s] - (there[s] + back[s]) / 2.0;
        assert!((product[s] - quadratic).abs() < 1e-12 * rest.iter().fold(1.0, |a: f64, b| a.max(b.abs())));
    }
}

#[test]
fn what_does_not_exist_is_refused() {
    let system = System::of("puma-560");
    let (t, y) = system.start();
    let refused = of_body(&system, (t, &y), "foot", None).unwrap_err();
    assert_eq!(refused.status, pc_status::PC_NOT_FOUND);
    assert!(refused.message.starts_with("there is no body or point called `foot`"), "{}", refused.message);
    let bodiless = System::of("heavy-top-lagrange");
    let (t, y) = bodiless.start();
    let refused = bodiless.at(pc_system_centre_of_mass, t, &y, 3).unwrap_err();
    assert_eq!(refused.status, pc_status::PC_UNSUPPORTED, "{}", refused.message);
    let fast = Model::named("relativistic-particle").system(pc_form::PC_POINCARE).unwrap();
    let (t, y) = fast.start();
    let (_, k) = sizes(&fast);
    let refused = fast.at(pc_system_coriolis, t, &y, k * k).unwrap_err();
    assert_eq!(refused.status, pc_status::PC_INCONSISTENT_MODEL, "{}", refused.message);
}
