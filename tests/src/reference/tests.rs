//! The reference states against the classical equations and the closed forms.

use super::*;
use crate::classical::nonholonomic::along_the_blade;
use crate::classical::{Rhs, classical};
use crate::closed_form;

/// Integrates ẏ = f(t, y) from 0 to `t_end` by `steps` steps of the midpoint rule, each extrapolated to the
/// order 2·`COLUMNS` [Gragg 1965; Bulirsch and Stoer 1966].
fn extrapolated_midpoint(f: Rhs, start: &[f64], t_end: f64, steps: usize) -> Vec<f64> {
    const COLUMNS: usize = 8;
    let (dim, step) = (start.len(), t_end / steps as f64);
    let (mut y, mut slope, mut slope_at_start) = (start.to_vec(), vec![0.0; dim], vec![0.0; dim]);
    for number in 0..steps {
        let t = step * number as f64;
        f(t, &y, &mut slope_at_start);
        let mut table: Vec<Vec<f64>> = Vec::new(); // the row of the last refinement, order rising
        for j in 1..=COLUMNS {
            let substeps = 2 * j;
            let h = step / substeps as f64;
            let mut before = y.clone();
            let mut now: Vec<f64> = (0..dim).map(|i| y[i] + h * slope_at_start[i]).collect();
            for m in 1..substeps {
                f(t + h * m as f64, &now, &mut slope);
                let next = (0..dim).map(|i| before[i] + 2.0 * h * slope[i]).collect();
                before = std::mem::replace(&mut now, next);
            }
            f(t + step, &now, &mut slope);
            let mut row = vec![(0..dim).map(|i| (before[i] + now[i] + h * slope[i]) / 2.0).collect()];
            for m in 1..j {
                let ratio = (j as f64 / (j - m) as f64).powi(2);
                let (coarse, fine): (&Vec<f64>, &Vec<f64>) = (&table[m - 1], &row[m - 1]);
                row.push((0..dim).map(|i| fine[i] + (fine[i] - coarse[i]) / (ratio - 1.0)).collect());
            }
            table = row;
        }
        y = table.pop().expect("at least one column");
    }
    y
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Rounding: a few thousand steps of 1e-16 of the largest component each, magnified by the divergence of nearby motions.
const TOLERANCE: f64 = 1e-11;

/// The one reference that no explicit method reaches.
const STIFF: &str = "stiff-sleigh";

#[test]
fn classical_equations_lead_to_the_reference_states() {
    for reference in references().filter(|reference| reference.model != STIFF) {
        let f = classical(reference.model).expect(reference.model);
        let steps = (64.0 * reference.t_end) as usize;
        let end = extrapolated_midpoint(f, reference.start, reference.t_end, steps);
        let size = reference.state.iter().fold(1.0, |size, v| f64::max(size, v.abs()));
        let error = distance(&end, reference.state) / size;
        assert!(error < TOLERANCE, "{}: {error:e}", reference.model);
    }
}

/// The steered sleigh on its slow motion. With ε = 1/K = 1/D and h = ½ sin t − φ, ω = h − ε (5/4 ḣ + ½ v h) + O(ε²); in
/// the layer of the time τ = 5/4 ε at the start, where ω − h decays from Δ as Δ e^(−t/τ), φ gains τΔ and v gains
/// τ (h Δ + Δ²/4).
#[test]
fn the_steered_sleigh_creeps_to_its_reference_state() {
    const EPSILON: f64 = 1.0 / 1.25e6;
    fn slow(t: f64, y: &[f64]) -> f64 {
        let h = t.sin() / 2.0 - y[2];
        h - EPSILON * (1.25 * (t.cos() / 2.0 - h) + y[3] * h / 2.0)
    }
    let f: Rhs = |t, y, dy| {
        let omega = slow(t, y);
        let (sin, cos) = y[2].sin_cos();
        dy[0] = y[3] * cos;
        dy[1] = y[3] * sin;
        dy[2] = omega;
        dy[3] = omega * omega / 2.0 + along_the_blade(t, y[3]);
    };
    let sleigh = reference(STIFF).expect("listed");
    let (layer, start) = (1.25 * EPSILON, sleigh.start[2]);
    let left = sleigh.start[4] + start; // h = −φ at t = 0
    let mut y = sleigh.start[..4].to_vec();
    y[2] += layer * left;
    y[3] += layer * (left * left / 4.0 - start * left);
    let mut end = extrapolated_midpoint(f, &y, sleigh.t_end, 256);
    end.push(slow(sleigh.t_end, &end));
    // ε² = 6e-13, times numbers of order ten
    assert!(distance(&end, sleigh.state) < 1e-11, "{end:?}");
}

/// Names that are not columns have no value.
#[test]
fn columns_are_picked_by_name() {
    let disk = reference("vertical-disk").expect("listed");
    assert_eq!(disk.pick(["θ'", "X"], disk.start), [3.0, 1.0]);
    assert!(disk.pick(["ω"], disk.start)[0].is_nan());
}

#[test]
fn columns_start_and_state_belong_together() {
    for reference in references() {
        assert_eq!(reference.columns.len(), reference.start.len(), "{}", reference.model);
        let coordinates_only = reference.model == "damped-oscillator-scaled-frame";
        let length = if coordinates_only { 1 } else { reference.columns.len() };
        assert_eq!(reference.state.len(), length, "{}", reference.model);
    }
    assert!(HOLONOMIC.is_sorted_by(|a, b| a.model < b.model));
    assert!(NONHOLONOMIC.is_sorted_by(|a, b| a.model < b.model));
}

/// The attitude of the quaternion is that of Euler's angles, at the start and at the end.
#[test]
fn euler_angles_and_quaternion_describe_one_motion() {
    let vertical_of_angles = |x: &[f64]| [x[1].sin() * x[2].sin(), x[1].sin() * x[2].cos(), x[1].cos()];
    let vertical_of_quaternion = |q: &[f64]| {
        let [q0, q1, q2, q3] = [q[0], q[1], q[2], q[3]];
        [2.0 * (q1 * q3 - q0 * q2), 2.0 * (q2 * q3 + q0 * q1), q0 * q0 - q1 * q1 - q2 * q2 + q3 * q3]
    };
    let angles = reference("heavy-top-euler").expect("listed");
    let quaternion = reference("heavy-top-quaternion").expect("listed");
    for (x, q) in [(angles.start, quaternion.start), (angles.state, quaternion.state)] {
        assert!(distance(&vertical_of_angles(x), &vertical_of_quaternion(q)) < 2e-15);
        assert_eq!(x[3..], q[4..]);
    }
}

#[test]
fn reference_states_lie_on_the_closed_forms() {
    let state = |model| reference(model).expect("listed").state;
    assert!(distance(state("euler-top"), &closed_form::euler_top(20.0)) < 1e-14);
    assert!(distance(state("charged-particle"), &closed_form::charged_particle(2.0, 5.0)) < 1e-14);
    assert!(distance(state("damped-oscillator"), &closed_form::damped_oscillator(6.0)) < 1e-14);
    assert!(distance(state("turning-wire"), &closed_form::turning_wire(2.5)) < 1e-14);
    assert!(distance(state("rotating-oscillator"), &closed_form::rotating_oscillator(8.0)) < 1e-14);
    assert!(
        (state("spherical-pendulum-cartesian")[2] - closed_form::spherical_pendulum_height(3.0)).abs()
            < 1e-14
    );
    let nutation = closed_form::symmetric_top_nutation(10.0);
    assert!((state("heavy-top-euler-symmetric")[1] - nutation).abs() < 1e-13); // an arccosine and two of K
    let fall = closed_form::relativistic_fall(2.0, 3.0, 2.0);
    assert!((state("relativistic-constant-force")[0] - fall).abs() < 1e-15);
    assert!(distance(state("appell-hamel"), &closed_form::appell_hamel(2.0)) < 1e-14);
    assert!(distance(state("chaplygin-sleigh"), &closed_form::chaplygin_sleigh(5.0)) < 1e-13); // a sum of 4000
    assert!(distance(state("vertical-disk-driven"), &closed_form::vertical_disk(0.3, 4.0)) < 1e-14);
    assert!(distance(&state("vertical-disk")[..4], &closed_form::vertical_disk(0.0, 4.0)[..4]) < 1e-14);
    assert!(distance(state("nonholonomic-particle"), &closed_form::nonholonomic_particle(6.0)) < 1e-14);
    assert!(distance(&state("suslov")[4..], &closed_form::suslov(10.0)) < 1e-14);
    assert!(distance(&state("turntable")[4..6], &closed_form::turntable_centre(5.0)) < 1e-14);
    assert!(distance(&state("ball-in-cylinder")[4..], &closed_form::ball_in_cylinder(5.0)) < 1e-13);
    assert!(distance(&state("carriage")[7..8], &closed_form::carriage_turn(5.0)) < 1e-14);
    let [radius, angle, ..] = *state("relativistic-particle") else { unreachable!("four columns") };
    assert!((1.0 / radius - closed_form::relativistic_orbit(angle)).abs() < 1e-14);
}

#[test]
fn symmetric_top_in_euler_angles_nutates_as_the_closed_form() {
    let f = classical("heavy-top-euler-symmetric").expect("listed");
    for t_end in [1.0, 4.0, 10.0] {
        let end = extrapolated_midpoint(f, &[0.0, 0.5, 0.0, 0.0, 0.0, 4.0], t_end, 160);
        assert!((end[1] - closed_form::symmetric_top_nutation(t_end)).abs() < TOLERANCE, "t = {t_end}");
    }
}

/// The masses of the chain hang where the angles say, at the start and at the end.
#[test]
fn angles_and_positions_of_a_chain_describe_one_motion() {
    let places = |angles: &[f64]| {
        let mut end = [0.0; 2];
        let ends = angles.iter().flat_map(|angle| {
            end = [end[0] + angle.sin(), end[1] - angle.cos()];
            end
        });
        ends.collect::<Vec<f64>>()
    };
    let angles = reference("pendulum-chain").expect("listed");
    let plane = reference("pendulum-chain-cartesian").expect("listed");
    for (angles, plane) in [(angles.start, plane.start), (angles.state, plane.state)] {
        assert!(distance(&places(&angles[..4]), &plane[..8]) < 2e-15);
        assert_eq!(angles[4..], plane[8..]);
    }
}
