//! Random bodies that touch random planes, derived by both routes.

use std::fmt::Write;

use pc_model::Model;
use pc_tests::fuzz::random::Random;
use pc_verify::{TOLERANCE, verify};

use super::run::{Run, document};

/// A body on a random joint that touches a random plane.
fn touching(random: &mut Random) -> String {
    let mut unit = || {
        let v: Vec<f64> = (0..4).map(|_| random.decimal(-1.0, 1.0)).collect();
        let length = v.iter().map(|part| part * part).sum::<f64>().sqrt().max(0.1);
        v.iter().map(|part| part / length).collect::<Vec<f64>>()
    };
    let (q, n) = (unit(), unit());
    let length = q.iter().map(|part| part * part).sum::<f64>().sqrt();
    let q: Vec<f64> = q.iter().map(|part| part / length).collect();
    let n = [n[0], n[1], n[2] + 1.5];
    let size = n.iter().map(|part| part * part).sum::<f64>().sqrt();
    let n = n.map(|part| part / size);
    // R_ij = (2 w² − 1) δ_ij + 2 u_i u_j − 2 w ε_ijk u_k
    let (w, u) = (q[0], [q[1], q[2], q[3]]);
    let turned = |i: usize, j: usize| match (3 + j - i) % 3 {
        0 => 0.0,
        1 => -u[3 - i - j],
        _ => u[3 - i - j],
    };
    let r = |i: usize, j: usize| {
        f64::from(u8::from(i == j)) * (2.0 * w * w - 1.0) + 2.0 * u[i] * u[j] + 2.0 * w * turned(i, j)
    };
    let to_body = [0, 1, 2].map(|j| (0..3).map(|i| r(i, j) * n[i]).sum::<f64>());
    let mut length = || random.decimal(0.2, 0.9);
    let (at, half) = ([length(), length(), length()], [length(), length(), length()]);
    let (shape, support) = match random.below(3) {
        0 => (format!("\"sphere\"\nradius = {}", half[0]), half[0]),
        1 => {
            let size = (to_body[0].powi(2) + to_body[1].powi(2)).sqrt();
            (format!("\"disc\"\naxis = [0, 0, -2]\nradius = {}", half[0]), half[0] * size)
        }
        _ => {
            let square: f64 = half.iter().zip(to_body).map(|(a, n)| (a * n).powi(2)).sum();
            (format!("\"ellipsoid\"\nsemi_axes = {half:?}"), square.sqrt())
        }
    };
    let height: f64 = (0..3).map(|i| to_body[i] * at[i]).sum::<f64>() - support;
    let mut text = String::new();
    writeln!(text, "[coordinates]\nb_q0 = {}\nb_q1 = {}\nb_q2 = {}\nb_q3 = {}", q[0], q[1], q[2], q[3])
        .unwrap();
    writeln!(text, "[quasi_velocities]\n\"b_ω1\" = 0.3\n\"b_ω2\" = -0.4\n\"b_ω3\" = 1.2").unwrap();
    writeln!(text, "[bodies.b]\njoint = {{ kind = \"free\" }}\nmass = 1.5").unwrap();
    writeln!(text, "center = [0.1, 0.2, -0.1]\ninertia = [0.5, 0.7, 0.6, 0.05, 0, 0.1]").unwrap();
    writeln!(
        text,
        "[gravity]\nacceleration = [0.2, 0.1, -9.81]\n[contacts.c]\nbody = \"b\"\nshape = {shape}"
    )
    .unwrap();
    writeln!(text, "at = {at:?}\nnormal = {n:?}\nthrough = {:?}", n.map(|part| part * height)).unwrap();
    text.push_str(match random.below(3) {
        0 => "motion = \"rolls\"\n",
        1 => "motion = \"slides\"\n",
        _ => "motion = \"slides\"\nfriction = 0.3\ncreep = 0.2\n",
    });
    writeln!(text, "[outputs]\nx = \"c_x\"\nspeed = \"c_y'\"\nslip = \"c_slip_2\"\nrate = \"d(c_slip_1)\"")
        .unwrap();
    text
}

#[test]
fn random_contacts_are_derived_alike_by_both_routes() {
    for number in 0..12 {
        let text = touching(&mut Random::new(23, number));
        let model = Model::new(document(&text));
        let options = pc_verify::Options { states: 3, seed: number, ..pc_verify::Options::default() };
        let agreement = model.derived(|assembly| verify(&model, assembly, &options));
        let agreement = agreement.unwrap_or_else(|error| panic!("contact {number}: {error}\n{text}"));
        assert!(agreement.error < TOLERANCE, "contact {number}: {agreement}\n{text}");
        let run = Run::of(&model, 0.3, 1e-10);
        let energy = run.column("energy");
        if text.contains("friction") {
            assert!(energy[20] < energy[0], "contact {number}: {energy:?}\n{text}");
        } else {
            assert!((energy[20] - energy[0]).abs() < 1e-7, "contact {number}: {energy:?}\n{text}");
        }
    }
}
