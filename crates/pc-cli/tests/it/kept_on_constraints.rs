//! Motions that stay on their constraints in spite of rounding errors of different sizes.

use std::process::{Command, Output, Stdio};

use crate::piped;

fn run(model: &str, arguments: &[&str]) -> Output {
    piped::pc(model, &[&["run", "-"], arguments].concat())
}

/// The columns and rows of a run that succeeds.
#[track_caller]
fn table(model: &str, arguments: &[&str]) -> (Vec<String>, Vec<Vec<f64>>) {
    let output = run(model, arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let mut lines = text.lines();
    let header = lines.next().expect("a header").split(',').map(str::to_owned).collect();
    let row = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
    (header, lines.map(row).collect())
}

#[track_caller]
fn agree(one: &[Vec<f64>], other: &[Vec<f64>], tolerance: f64) {
    assert_eq!(one.len(), other.len());
    for (a, b) in one.iter().zip(other) {
        for (x, y) in a.iter().zip(b) {
            assert!((x - y).abs() <= tolerance * (1.0 + x.abs()), "at {}: {x} {y}", a[0]);
        }
    }
}

const BICYCLE: &str = include_str!("whipple-bicycle.toml");

/// Five constraints whose residuals have rounding errors of very different size, at all speeds: none of them stalls.
#[test]
fn a_bicycle_rides_at_every_speed() {
    let directory = tempfile::tempdir().expect("a directory");
    let [model, table] = ["bicycle.toml", "speeds.csv"].map(|name| directory.path().join(name));
    std::fs::write(&model, BICYCLE).expect("written");
    // The error of the integration in a few hundred steps: it varies with the speed by a factor of
    // ten and more, and decreases with the tolerance, which an error of the projection would not.
    for (tolerance, bound) in [("1e-9", 1e-8), ("1e-11", 1e-10)] {
        let mut sweep = Command::new(env!("CARGO_BIN_EXE_pc"));
        sweep.arg("sweep").arg(&model).args(["--vary", "v0=4:6:41", "--rtol", tolerance, "-o"]).arg(&table);
        assert!(sweep.stderr(Stdio::null()).status().expect("pc starts").success());
        let text = std::fs::read_to_string(&table).expect("a table");
        let names: Vec<&str> = text.lines().next().expect("a header").split(',').collect();
        let [status, energy, drift] = ["status", "energy", "drift(energy)"]
            .map(|name| names.iter().position(|known| *known == name).expect("a column"));
        assert_eq!(text.lines().count(), 42);
        for row in text.lines().skip(1).map(|row| row.split(',').collect::<Vec<_>>()) {
            assert_eq!(row[status], "completed", "{row:?}");
            let number = |j: usize| row[j].parse::<f64>().expect("a number");
            assert!(number(drift) < bound * number(energy).abs(), "{tolerance}: {row:?}");
        }
        std::fs::remove_file(&table).expect("the table is there");
    }
}

/// At 5e-324, the smallest number, products are rounded so coarsely that no step of Newton's method
/// makes 0.56 x' vanish.
#[test]
fn the_smallest_number_counts_as_rounding() {
    let model = |c: &str, start: &str, other: &str| {
        format!(
            "[coordinates]\nx = 0.0\ny = 0.0\n[quasi_velocities]\n\"x'\" = {start}\n\"y'\" = {other}\n[constraints]\n\
             k = \"{c}*x'\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n[simulation]\nt_end = 1.0\nsamples = 2\n"
        )
    };
    for (c, start, other) in [
        ("0.56", "5e-324", "1.0"),
        ("0.56", "5e-324", "0.0"),
        ("0.7", "-1.5e-323", "1e-300"),
        ("1e100", "5e-324", "1.0"),
        ("3", "2e-310", "5e-324"),
    ] {
        let (_, rows) = table(&model(c, start, other), &[]);
        let way = (rows[1][2] - rows[0][4]).abs(); // a few steps, each with one rounding
        // Parts of the smallest number itself round to it or to nothing.
        let rounding = 1e-14 * rows[0][4] + f64::from_bits(1);
        assert!(rows[1][1].abs() < 1e-300 && way <= rounding, "{c}, {start}: {rows:?}");
    }
}

/// At rest, the computed accelerations are only rounding, and the energy can be kept.
#[test]
fn energy_is_kept_where_its_rate_is_only_rounding() {
    let still = "[quasi_velocities]\nw1 = 0.0\nw2 = 0.19879861614865244\nw3 = 0.22336923162769937\n[algebra]\n\
                 name = \"heisenberg\"\n[constraints]\nk0 = \"w2 - 0.89*w3 + 1.14*w1\"\nk1 = \"w1\"\n[lagrangian]\n\
                 kinetic = \"1.568*w2^2/2 + 0.82*w3^2/2\"\n[simulation]\nt_end = 1.0\n";
    let (_, rows) = table(still, &["--project", "energy"]);
    for row in &rows {
        for (value, start) in row[1..].iter().zip(&rows[0][1..]) {
            assert!((value - start).abs() < 1e-15, "{row:?}"); // a few roundings
        }
    }
    // A true rate of that size counts.
    let slow = "[coordinates]\nx = 1.0\n[quasi_velocities]\n\"x'\" = 7e-19\n[lagrangian]\nkinetic = \"x'^2/2\"\n\
                [integrals]\nplace = \"x\"\n[simulation]\nt_end = 1.0\n";
    assert_eq!(run(slow, &["--project", "place"]).status.code(), Some(4));
}

/// A bead on a circle that is slowed down where it passes `place`.
const BRAKED: &str = "[parameters]\nplace = 0.3\n[coordinates]\nx = 0.6\ny = -0.8\n[constraints]\ncircle = \"x^2 + y^2 - 1\"\n\
                      [lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"y\"\n[events.brake]\nwhen = \"x - place\"\n\
                      reset = { \"x'\" = \"0.5*x'\" }\n[simulation]\nt_end = 2.0\nsamples = 2\n";

/// The projection after a reset leaves the bead on its side of the place, so that it passes only
/// once, in all forms and for all places.
#[test]
fn a_reset_under_constraints_occurs_once() {
    let (_, rows) = table(BRAKED, &["--form", "canonical"]);
    // The expected x and x' are from an integration in the angle, whose speed is halved.
    assert!((rows[1][1] + 0.023_134_9).abs() < 1e-7 && (rows[1][3] + 0.410_445_7).abs() < 1e-7, "{rows:?}");
    for i in 0..49 {
        let place = format!("place={}", 0.05 + 0.01 * f64::from(i));
        let mut ends = Vec::new();
        for form in ["poincare", "canonical"] {
            let arguments = ["--set", &place, "--form", form];
            let said = String::from_utf8(run(BRAKED, &arguments).stderr).expect("UTF-8");
            assert!(said.contains("  events   brake  once: "), "{form}, {place}: {said}");
            ends.push(table(BRAKED, &arguments).1);
        }
        agree(&ends[0], &ends[1], 1e-7); // a hundred times the tolerance of the integration
    }
}

/// A particle on a sphere, thrown from near the equator over the poles.
const SPHERE: &str = "[parameters]\ng = 1.0\n[coordinates]\nx = 0.0\ny = 0.6\nz = 0.8\n[quasi_velocities]\n\"x'\" = 0.9\n\
                      \"y'\" = 2.4\n\"z'\" = -1.8\n[constraints]\nsphere = \"x^2 + y^2 + z^2 - 1\"\n[lagrangian]\n\
                      kinetic = \"(x'^2 + y'^2 + z'^2)/2\"\npotential = \"g*z\"\n[simulation]\nt_end = 12.0\nsamples = 49\n";

/// No two of the three velocities are independent everywhere on a sphere, and the motion crosses
/// all three great circles where a choice fails; in momenta it is the same motion, by each method
/// and with any integral kept.
#[test]
fn momenta_cross_where_any_choice_of_velocities_fails() {
    for arguments in [&["--rtol", "1e-12"][..], &["--rtol", "1e-12", "--set", "g=0"]] {
        let usual = table(SPHERE, arguments);
        for j in 1..=3 {
            let sides = |side: f64| usual.1.iter().any(|row| row[j] * side > 0.1);
            assert!(sides(1.0) && sides(-1.0), "it crosses the plane of {}", usual.0[j]);
        }
        for more in [&["--form", "canonical"][..], &["--form", "canonical", "--project", "energy"]] {
            let momenta = table(SPHERE, &[arguments, more].concat());
            assert_eq!(usual.0, momenta.0);
            // After several turns past the poles the errors of both are 1e4 times the tolerances,
            // and decrease with them.
            agree(&usual.1, &momenta.1, 1e-7);
            for row in &momenta.1 {
                let radius = row[1].hypot(row[2]).hypot(row[3]);
                assert!((radius - 1.0).abs() < 1e-14, "projected to rounding: {row:?}");
            }
        }
    }
    let bdf = ["--method", "bdf", "--rtol", "1e-8"];
    agree(
        &table(SPHERE, &bdf).1,
        &table(SPHERE, &[&bdf[..], &["--form", "canonical"]].concat()).1,
        1e-4, // BDF with 1e-8 a step
    );
}

/// A pendulum of length one between two stops, which give back 0.8 of its speed; in these coordinates and velocities.
fn stopped(coordinates: &str, [kinetic, height, place]: [&str; 3], reset: &str) -> String {
    format!(
        "[coordinates]\n{coordinates}[lagrangian]\nkinetic = \"{kinetic}\"\npotential = \"{height}\"\n[events.right]\n\
         when = \"{place} - 0.7\"\ndirection = \"rising\"\nreset = {{ {reset} }}\n[events.left]\nwhen = \"{place} + 0.3\"\n\
         direction = \"falling\"\nreset = {{ {reset} }}\n[outputs]\nheight = \"{height}\"\nspeed = \"{kinetic}\"\n\
         [simulation]\nt_end = 4.0\nsamples = 21\nrtol = 1e-11\natol = 1e-13\n"
    )
}

/// The same motion in the angle and in Cartesian coordinates, whichever velocities state the impact.
#[test]
fn stops_give_back_a_part_of_the_speed_in_any_coordinates() {
    let angle = stopped(
        "q = \"asin(0.6)\"\n[quasi_velocities]\n\"q'\" = 1.25\n",
        ["q'^2/2", "-cos(q)", "sin(q)"],
        "\"q'\" = \"-0.8*q'\"",
    );
    let seen = |model: &str, arguments: &[&str]| {
        let (names, rows) = table(model, arguments);
        let place = |name: &str| names.iter().position(|known| known == name).expect("a column");
        let (height, speed) = (place("height"), place("speed"));
        rows.iter().map(|row| vec![row[0], row[height], row[speed]]).collect::<Vec<_>>()
    };
    let expected = seen(&angle, &[]);
    let velocities = "\"x'\" = 1.0\n\"y'\" = 0.75\n";
    let variants = [
        (velocities, "\"x'\" = \"-0.8*x'\""),
        (velocities, "\"y'\" = \"-0.8*y'\", \"x'\" = \"-0.8*x'\""),
        ("w = { is = \"x'\", start = 1.0 }\n", "w = \"-0.8*w\""),
        ("w = { is = \"x' + x*y'/2\", start = 1.225 }\n", "w = \"-0.8*w\""),
        (
            "u = { is = \"x' + y'\", start = 1.75 }\nv = { is = \"x' - 2*y'\", start = -0.5 }\n",
            "u = \"-0.8*u\"",
        ),
    ];
    for (velocities, reset) in variants {
        let coordinates = format!(
            "x = 0.6\ny = -0.8\n[quasi_velocities]\n{velocities}[constraints]\nrod = \"x^2 + y^2 - 1\"\n"
        );
        let model = stopped(&coordinates, ["(x'^2 + y'^2)/2", "y", "x"], reset);
        for form in ["poincare", "canonical"] {
            // A hundred times the tolerance of the integration, grown by four impacts.
            agree(&expected, &seen(&model, &["--form", form]), 1e-8);
        }
    }
}
