//! Robots in MJCF: motions as in MuJoCo, closed loops, and what is refused.

use pc_model::Source;
use pc_model::import::{ImportOptions, model_of_robot};

use super::motion::{alike, flow, rates};

fn gantry() -> String {
    let path = format!("{}/../../tests/robots/gantry.xml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).unwrap()
}

fn model_of(text: &str) -> (String, Vec<String>) {
    let source = Source::new("robot.xml", text);
    model_of_robot(&source, ImportOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// The accelerations of MuJoCo 4.0.0 (`mj_forward`, without limits and dry friction) for the same file and the
/// same control: of rail, pan, tilt, twist; of the ball; and of the free block, whose velocity in MuJoCo is along
/// fixed axes, v̇ = Rᵀ a − ω × v.
#[test]
fn a_gantry_moves_as_in_mujoco() {
    let (text, notes) = model_of(&gantry());
    insta::assert_snapshot!("gantry", text);
    assert_eq!(
        notes,
        [
            "one <jointpos> is left out",
            "the coordinate of the joint `tilt` is that of MuJoCo less its `ref`, 0.174533",
        ]
    );
    let controls = |values: [f64; 4]| {
        let mut text = text.replace("\ntwist_friction = 0.2\n", "\ntwist_friction = 0.0\n");
        for (name, value) in ["drive", "hold", "spin", "servo"].iter().zip(values) {
            text = text.replace(&format!("\n{name} = 0.0\n"), &format!("\n{name} = {value:?}\n"));
        }
        flow(&text)
    };
    let mut still = controls([0.0; 4]);
    insta::assert_snapshot!("names_of_the_gantry", still.names.join(" "));
    let accelerations = |rates: &[f64], names: &[String]| -> Vec<f64> {
        let velocities = names.iter().zip(rates).filter(|(name, _)| name.contains(['\'', 'v', 'ω']));
        velocities.map(|(_, rate)| *rate).collect()
    };
    let names = still.names.clone();
    let start = still.start.clone();
    let order = |values: &[(&str, &[f64])]| -> Vec<f64> {
        let mut state = start.clone();
        for (first, values) in values {
            let at =
                names.iter().position(|name| name == first).unwrap_or_else(|| panic!("{first}: {names:?}"));
            state[at..at + values.len()].copy_from_slice(values);
        }
        state
    };
    let expected = |singles: [f64; 4], ball: [f64; 3], block: [f64; 6]| {
        let zero = vec![0.0; start.len()];
        let mut all = zero;
        for (first, values) in [
            ("rail'", &singles[..1]),
            ("pan'", &singles[1..2]),
            ("tilt'", &singles[2..3]),
            ("twist'", &singles[3..]),
            ("pendulum_ω1", &ball[..]),
            ("block_v1", &block[..]),
        ] {
            let at =
                names.iter().position(|name| name == first).unwrap_or_else(|| panic!("{first}: {names:?}"));
            all[at..at + values.len()].copy_from_slice(values);
        }
        accelerations(&all, &names)
    };
    let found = accelerations(&rates(&mut still, &start), &names);
    let resting = expected(
        [1.2110789475054975, -8.652939143460078, 27.008286686275977, 19.83773728850315],
        [-30.380913477968413, -5.741600279212218, -11.909399291511622],
        [-7.848, 0.0, -5.886, 0.0, 0.0, 0.0],
    );
    alike(&found, &resting);
    let state = order(&[
        ("rail", &[0.2]),
        ("pan", &[-0.5]),
        ("tilt", &[0.7]),
        ("twist", &[1.1]),
        ("pendulum_q0", &[0.5, 0.5, -0.5, 0.5]),
        ("block_x", &[0.1, -0.2, 0.3, 0.1, 0.7, -0.1, 0.7]),
        ("rail'", &[0.4]),
        ("pan'", &[-0.8]),
        ("tilt'", &[1.2]),
        ("twist'", &[0.5]),
        ("pendulum_ω1", &[0.6, -1.0, 0.3]),
        ("block_v1", &[0.2, 0.1, -0.4, 1.0, -0.5, 0.7]),
    ]);
    let found = accelerations(&rates(&mut controls([0.5, -1.2, 0.8, 0.3]), &state), &names);
    let moving = expected(
        [-438.2058246847506, 20259.989791348013, -941.850971310919, -2275.1787303436463],
        [25906.1613644592, 19457.16446433006, -7382.368649546928],
        [
            -5.989706401184415,
            1.6752105377828501,
            -7.764355639504072,
            -0.06239137050362353,
            -0.4905562418800091,
            -0.2788455779591782,
        ],
    );
    alike(&found, &moving);
}

/// Four bars that start at rest, driven by 0.7: the accelerations and the force of the pin by the mass matrix, the
/// bias and the Jacobians of MuJoCo 4.0.0, where M q̈ − Jᵀ λ = f and J q̈ = 0 (the constraint of MuJoCo itself is
/// soft).
#[test]
fn four_bars_move_as_in_mujoco() {
    let path = format!("{}/../../tests/robots/four-bars.xml", env!("CARGO_MANIFEST_DIR"));
    let (text, notes) = model_of(&std::fs::read_to_string(path).unwrap());
    assert!(notes.is_empty(), "{notes:?}");
    insta::assert_snapshot!("four_bars", text);
    let mut flow = flow(&text.replace("motor = 0.0", "motor = 0.7"));
    assert_eq!(flow.names, ["crank", "rocker", "coupler", "crank'", "rocker'", "coupler'"]);
    let expected = [4.7153923880094295, 2.8292354328056577, -4.7153923880094295];
    alike(&rates(&mut flow, &[0.0; 6])[3..], &expected);
}

const BLOCK: &str = r#"<inertial pos="0.1 0 0.05" mass="1.5" diaginertia="0.02 0.03 0.04"/>"#;

/// A block that is welded to an arm is a part of the arm, whatever the frames of both.
#[test]
fn what_is_welded_moves_as_one() {
    let robot = |loose: &str, rigid: &str, equality: &str| {
        format!(
            r#"<mujoco><worldbody><body name="arm" pos="0 0 1" euler="20 0 0"><joint name="a" axis="0 1 0" pos="0.05 0 0"/>
            <inertial pos="0.2 0 0" mass="1" diaginertia="0.01 0.02 0.02"/>{rigid}</body>{loose}</worldbody>{equality}</mujoco>"#
        )
    };
    let inner = format!(r#"<body name="b" pos="0.3 0.1 0" euler="0 40 0">{BLOCK}</body>"#);
    let (one, _) = model_of(&robot("", &inner, ""));
    // The same pose along fixed axes: Rx(20°) (0.3, 0.1, 0) + (0, 0, 1), and Rx(20°) Ry(40°).
    let (sin, cos) = 20_f64.to_radians().sin_cos();
    let (x, z) = (10_f64.to_radians().sin_cos(), 20_f64.to_radians().sin_cos());
    let quat = [x.1 * z.1, x.0 * z.1, x.1 * z.0, x.0 * z.0];
    let outer = format!(
        r#"<body name="b" pos="0.3 {} {}" quat="{} {} {} {}"><freejoint/>{BLOCK}</body>"#,
        0.1 * cos,
        1.0 + 0.1 * sin,
        quat[0],
        quat[1],
        quat[2],
        quat[3]
    );
    let (two, _) =
        model_of(&robot(&outer, "", r#"<equality><weld name="glue" body1="arm" body2="b"/></equality>"#));
    let (mut one, mut two) = (flow(&one), flow(&two));
    let at = two.names.iter().position(|name| name == "a'").unwrap();
    let start = two.start.clone();
    alike(&rates(&mut one, &[0.0, 0.0])[1..], &rates(&mut two, &start)[at..=at]);
}

/// ẍ of a slide x = 0.1 + 2 y − y², coupled to a slide y with gravity along it: from the energy
/// (m x_y² + M) ẏ²/2 + M g y at rest, ÿ = −M g/(m x_y² + M). Where x is linear in y, it follows y.
#[test]
fn coordinates_are_coupled_by_polynomials() {
    let robot = |coefficients: &str| {
        format!(
            r#"<mujoco><worldbody><body name="p"><joint name="x" type="slide" axis="1 0 0"/><inertial pos="0 0 0" mass="2"/></body>
            <body name="q"><joint name="y" type="slide"/><inertial pos="0 0 0" mass="3"/></body></worldbody>
            <equality><joint joint1="x" joint2="y" polycoef="{coefficients}"/></equality></mujoco>"#
        )
    };
    for (coefficients, slope) in [("0.1 2 -1 0 0", 2.0), ("0.1 2", 2.0), ("0.1 -0.5 0 0 0", -0.5)] {
        let mut flow = flow(&model_of(&robot(coefficients)).0);
        let place = |name: &str| flow.names.iter().position(|known| known == name);
        let (x, y, half) = (place("x"), place("y").unwrap(), flow.start.len() / 2);
        assert_eq!(x.is_some(), coefficients.contains("-1"));
        assert_eq!((x.map_or(0.1, |x| flow.start[x]), flow.start[y]), (0.1, 0.0));
        let start = flow.start.clone();
        let rates = rates(&mut flow, &start);
        let falls = -3.0 * 9.81 / (2.0 * slope * slope + 3.0);
        alike(&[x.map_or(slope * falls, |x| rates[half + x]), rates[half + y]], &[slope * falls, falls]);
    }
}

/// A part of a robot, and the message.
const REFUSED: &[(&str, &str)] = &[
    (
        "<include file=\"a.xml\"/>",
        "r.xml:2:1: <include>: the contents of another file belong here\n    <include file=\"a.xml\"/>\n    ^^^^^^^^\n  help: save the compiled file from MuJoCo, by `mj_saveLastXML`, and import that",
    ),
    (
        "<compiler settotalmass=\"3\"/>",
        "r.xml:2:25: <compiler>: `settotalmass` = 3 has no place in a model\n    <compiler settotalmass=\"3\"/>\n                            ^\n  help: save the compiled file from MuJoCo, by `mj_saveLastXML`, and import that",
    ),
    (
        "<worldbody><body name=\"b\"><joint type=\"hinge\" class=\"c\"/></body></worldbody>",
        "r.xml:2:54: <joint>: there is no class `c` of defaults\n    <worldbody><body name=\"b\"><joint type=\"hinge\" class=\"c\"/></body></worldbody>\n                                                         ^\n  help: declare it in <default>",
    ),
    (
        "<worldbody><body name=\"b\"><joint/><geom type=\"mesh\" mesh=\"m\"/></body></worldbody>",
        "r.xml:2:47: <geom>: the mass of a mesh is not known here\n    <worldbody><body name=\"b\"><joint/><geom type=\"mesh\" mesh=\"m\"/></body></worldbody>\n                                                  ^^^^\n  help: give the body an <inertial>, or the geom the mass 0",
    ),
    (
        "<worldbody><body name=\"b\"><body name=\"c\"><freejoint/></body></body></worldbody>",
        "r.xml:2:42: <freejoint>: a free joint has no place here\n    <worldbody><body name=\"b\"><body name=\"c\"><freejoint/></body></body></worldbody>\n                                             ^^^^^^^^^^\n  help: it is the only joint of a body in <worldbody>",
    ),
    (
        "<worldbody><body name=\"b\"><joint/></body></worldbody>",
        "r.xml:2:12: <link b>: the link `b` can move, and neither it nor what hangs on it has mass\n    <worldbody><body name=\"b\"><joint/></body></worldbody>\n               ^^^^^\n  help: give it an <inertial>, make its joint `fixed`, or fix all such joints by `--fix-massless`",
    ),
    (
        "<worldbody><frame><joint/></frame></worldbody>",
        "r.xml:2:19: <joint>: <joint> has no place in <frame>\n    <worldbody><frame><joint/></frame></worldbody>\n                      ^^^^^^\n  help: joints and masses are those of a <body>",
    ),
    (
        "<worldbody/>",
        "r.xml:1:1: <mujoco>: there is no <body>\n    <mujoco>\n    ^^^^^^^\n  help: a model has bodies in its <worldbody>",
    ),
    (
        "<worldbody><body name=\"b\" quat=\"0 0 0 0\"/></worldbody>",
        "r.xml:2:33: <body b>: `0 0 0 0` is no attitude\n    <worldbody><body name=\"b\" quat=\"0 0 0 0\"/></worldbody>\n                                    ^^^^^^^\n  help: a `quat` is w x y z, an `axisangle` x y z φ, `xyaxes` are six numbers, others three",
    ),
    (
        "<worldbody><body name=\"b\"/></worldbody>\n<actuator><motor joint=\"j\"/></actuator>",
        "r.xml:3:25: <motor>: there is no joint `j`\n    <actuator><motor joint=\"j\"/></actuator>\n                            ^\n  help: name one that is there",
    ),
];

#[test]
fn what_is_wrong_is_shown_where_it_stands() {
    let mut complaints = Vec::new();
    for (part, message) in REFUSED {
        let source = Source::new("r.xml", format!("<mujoco>\n{part}\n</mujoco>"));
        match model_of_robot(&source, ImportOptions::default()) {
            Ok((text, _)) => complaints.push(format!("{message}\nis accepted:\n{text}")),
            Err(error) if error.to_string().trim_end() != *message => {
                complaints.push(format!("{error}\ninstead of\n{message}"));
            }
            Err(_) => {}
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n\n"));
    let floating = ImportOptions { floating: true, ..ImportOptions::default() };
    let error = model_of_robot(&Source::new("r.xml", gantry()), floating).unwrap_err().to_string();
    assert!(error.contains("--floating has no place here: MJCF says which bodies move freely"), "{error}");
}

/// What a model does not have is named.
#[test]
fn what_is_left_out_is_noted() {
    let (_, notes) = model_of(
        r#"<mujoco><option density="1.2"/><worldbody><body name="b" gravcomp="1"><joint name="j" range="-10 20"/>
        <geom size="0.1"/><body name="c"><joint name="k" type="ball" stiffness="2"/><geom size="0.1"/></body></body></worldbody>
        <tendon><spatial/><fixed/></tendon><contact><pair/></contact>
        <equality><connect site1="s" site2="t"/><weld body1="b" active="false"/><tendon tendon1="t"/></equality>
        <actuator><muscle joint="j"/><position joint="j" dampratio="1"/><motor joint="j" ctrlrange="-1 1"/></actuator></mujoco>"#,
    );
    insta::assert_snapshot!("notes_of_mjcf", notes.join("\n"));
}
