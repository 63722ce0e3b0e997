//! End states of the built-in models, to sixteen digits.
//!
//! Each comes from an extrapolated integration of the classical equations in arithmetic of 34 digits, rounded once.

/// The state in which a built-in model must arrive.
#[derive(Clone, Copy, Debug)]
pub struct Reference {
    /// Name of the built-in model.
    pub model: &'static str,
    /// Time of arrival; all motions start at t = 0.
    pub t_end: f64,
    /// Names of the columns of [`start`](Reference::start) and [`state`](Reference::state): the coordinates, then
    /// the quasi-velocities.
    pub columns: &'static [&'static str],
    /// State at t = 0.
    pub start: &'static [f64],
    /// State at [`t_end`](Reference::t_end); where a frame differs from that of the integration, only the
    /// coordinates, which do not depend on it.
    pub state: &'static [f64],
    /// Integrals that must not drift, under their names in the model, and `energy` where it is conserved.
    pub conserved: &'static [&'static str],
}

const TOP_COLUMNS: &[&str] = &["γ1", "γ2", "γ3", "ω1", "ω2", "ω3"];
const POLAR_COLUMNS: &[&str] = &["ρ", "φ", "η1", "η2"];

/// The reference states, in the order of the models' names.
pub const REFERENCES: &[Reference] = &[
    Reference {
        model: "charged-particle",
        t_end: 5.0,
        columns: POLAR_COLUMNS,
        start: &[1.0, 0.0, 0.5, 1.0],
        state: &[1.927817594925555, -0.3893520536655847, -0.6761895280781433, -0.8903750457629963],
        conserved: &["energy", "momentum", "speed"],
    },
    Reference {
        model: "charged-particle-induction",
        t_end: 5.0,
        columns: POLAR_COLUMNS,
        start: &[1.0, 0.0, 0.5, 1.0],
        state: &[1.527118794726238, 0.4656202772068477, 0.7951484031033378, 0.5847802797579092],
        conserved: &["momentum"],
    },
    Reference {
        model: "damped-oscillator",
        t_end: 6.0,
        columns: &["x", "x'"],
        start: &[1.0, 1.0],
        state: &[0.08997074669880486, 0.4693973985383837],
        conserved: &["oscillation"],
    },
    Reference {
        model: "damped-oscillator-scaled-frame",
        t_end: 6.0,
        columns: &["x", "η"],
        start: &[1.0, 0.75],
        state: &[0.08997074669880486],
        conserved: &["oscillation"],
    },
    Reference {
        model: "euler-top",
        t_end: 20.0,
        columns: &["ω1", "ω2", "ω3"],
        start: &[1.0, 0.0, 1.0],
        state: &[0.7098439425137012, -0.7043589832440595, 0.9135787546280825],
        conserved: &["energy", "momentum"],
    },
    Reference {
        model: "heavy-top-euler",
        t_end: 5.0,
        columns: &["ψ", "θ", "φ", "ω1", "ω2", "ω3"],
        start: &[0.0, 1.0, 0.3, 0.2, -0.3, 1.5],
        state: &[
            1.981103127723329,
            1.299801188059093,
            8.973805250671948,
            0.03288669493537087,
            -0.1405046567169479,
            2.077619872425167,
        ],
        conserved: &["energy", "area"],
    },
    Reference {
        model: "heavy-top-goryachev-chaplygin",
        t_end: 10.0,
        columns: TOP_COLUMNS,
        start: &[0.6, 0.0, 0.8, 0.5, 0.7, -1.5],
        state: &[
            -0.7418946089984687,
            0.6618796438652827,
            -0.1072740703794526,
            -0.4796317515838717,
            -0.6315799429085291,
            -2.319057966578223,
        ],
        conserved: &["energy", "area", "norm", "chaplygin"],
    },
    Reference {
        model: "heavy-top-kovalevskaya",
        t_end: 10.0,
        columns: TOP_COLUMNS,
        start: &[0.6, 0.0, 0.8, 0.3, 0.5, 1.0],
        state: &[
            0.3588684777850783,
            -0.6337286751308474,
            -0.6852746762934712,
            -0.1667844520320693,
            -0.2482238749705394,
            -1.408331904538056,
        ],
        conserved: &["energy", "area", "norm", "kovalevskaya"],
    },
    Reference {
        model: "heavy-top-lagrange",
        t_end: 10.0,
        columns: TOP_COLUMNS,
        start: &[0.6, 0.0, 0.8, 0.1, -0.2, 3.0],
        state: &[
            -0.5983375993973925,
            -0.1486439622069561,
            0.7873354365496211,
            -0.06583376642272503,
            -0.2664489483922874,
            3.0,
        ],
        conserved: &["energy", "area", "norm", "spin"],
    },
    // start: (cos ½ cos 0.15, sin ½ cos 0.15, −sin ½ sin 0.15, cos ½ sin 0.15), the start of heavy-top-euler
    Reference {
        model: "heavy-top-quaternion",
        t_end: 5.0,
        columns: &["q0", "q1", "q2", "q3", "ω1", "ω2", "ω3"],
        start: &[
            0.8677282556982173,
            0.47404210659574547,
            -0.07164445714916154,
            0.1311442991402941,
            0.2,
            -0.3,
            1.5,
        ],
        state: &[
            0.5513965939869315,
            -0.5674275018884854,
            0.2101923761598471,
            -0.5742882475242561,
            0.03288669493537087,
            -0.1405046567169479,
            2.077619872425167,
        ],
        conserved: &["energy", "norm", "area"],
    },
    Reference {
        model: "relativistic-particle",
        t_end: 12.0,
        columns: POLAR_COLUMNS,
        start: &[1.0, 0.0, 0.0, 1.1],
        state: &[3.621624706292534, 3.398956171624926, -0.001269525149962165, 0.3578105416826175],
        conserved: &["energy", "momentum"],
    },
    Reference {
        model: "rigid-body-spring",
        t_end: 5.0,
        columns: &["x", "y", "z", "q0", "q1", "q2", "q3", "ω1", "ω2", "ω3", "v1", "v2", "v3"],
        start: &[1.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 0.2, 1.0, -0.5, 0.0, 1.0, 0.25],
        state: &[
            -1.140945166148047,
            0.7263254744283224,
            -0.7227663253423252,
            0.3897601027424155,
            -0.01097431943109551,
            -0.1266670633709688,
            -0.9120976272747457,
            0.5008907877012798,
            -0.3061340288325673,
            -0.4985240296966563,
            0.9778134749615663,
            -1.157454528508979,
            -0.02097596715975546,
        ],
        conserved: &["energy", "norm", "Hx", "Hy", "Hz"],
    },
];

/// The reference of a built-in model, or `None` where there is none.
pub fn reference(model: &str) -> Option<&'static Reference> {
    REFERENCES.iter().find(|reference| reference.model == model)
}

#[cfg(test)]
mod tests {
    use super::*;
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

    /// Rounding: a few thousand steps of 1e-16 relative each, magnified by the divergence of nearby motions.
    const TOLERANCE: f64 = 1e-11;

    #[test]
    fn classical_equations_lead_to_the_reference_states() {
        for reference in REFERENCES {
            let f = classical(reference.model).expect(reference.model);
            let steps = (16.0 * reference.t_end) as usize;
            let end = extrapolated_midpoint(f, reference.start, reference.t_end, steps);
            let error = distance(&end, reference.state);
            assert!(error < TOLERANCE, "{}: {error:e}", reference.model);
        }
    }

    #[test]
    fn columns_start_and_state_belong_together() {
        for reference in REFERENCES {
            assert_eq!(reference.columns.len(), reference.start.len(), "{}", reference.model);
            let coordinates_only = reference.model == "damped-oscillator-scaled-frame";
            let length = if coordinates_only { 1 } else { reference.columns.len() };
            assert_eq!(reference.state.len(), length, "{}", reference.model);
        }
        assert!(REFERENCES.is_sorted_by(|a, b| a.model < b.model));
    }

    /// The attitude of the quaternion is that of Euler's angles, at the start and at the end.
    #[test]
    fn euler_angles_and_quaternion_tell_one_motion() {
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
}
