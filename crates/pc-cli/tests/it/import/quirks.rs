//! What files in URDF contain besides links and joints: document types, macros, quaternions, links without
//! mass, names and moments that a model cannot have.

use pc_model::Source;
use pc_model::import::{ImportOptions, model_of_robot};

use super::motion::{alike, flow, imported, rates, text_of};

/// The accelerations of Pinocchio 4.1.0 (`pinocchio.aba`), to all digits, for the same robot with attitudes as
/// roll, pitch and yaw.
#[test]
fn a_crane_moves_as_in_pinocchio() {
    let (text, left_out) = imported("crane", false);
    assert!(left_out.is_empty(), "{left_out:?}");
    assert!(text.contains("acceleration 2, jerk 10"), "{text}");
    let mut flow = flow(&text);
    assert_eq!(flow.names[..4], ["slew", "luff", "run", "swing"]);
    for (state, accelerations) in [
        ([0.0; 8], [-3.747485296169389, 8.726938537444983, 0.8105652234145883, 30.752851112855044]),
        (
            [0.3, -0.6, 0.2, 0.9, 0.5, -0.4, 0.7, 1.1],
            [-4.86584593825671, 7.651112810138749, 3.729434608793924, 10.653160254226455],
        ),
        (
            [-2.0, 0.8, -0.1, -1.7, -1.3, 2.1, -0.5, 0.4],
            [-4.543983170480644, 6.118488137707767, -5.386759541794178, -10.08897339173296],
        ),
    ] {
        alike(&rates(&mut flow, &state)[4..], &accelerations);
    }
}

const MOMENTS: &str = r#"ixy="0" ixz="0" iyz="0""#;

/// A body on a ball joint, m = 2 at r = (0, 0, −0.5) with moments (0.3, 0.4, 0.2): about the joint
/// I = (0.8, 0.9, 0.2), and I ω̇ = I ω × ω + r × m g − d ω where the body is upright.
#[test]
fn a_spherical_joint_is_eulers_top() {
    let urdf = format!(
        r#"<robot name="r"><link name="base"/><link name="top"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
        <inertia ixx="0.3" iyy="0.4" izz="0.2" {MOMENTS}/></inertial></link>
        <joint name="ball" type="spherical"><parent link="base"/><child link="top"/><dynamics damping="0.1"/></joint></robot>"#
    );
    let mut flow = flow(&text_of(&urdf).0);
    assert_eq!(flow.names, ["top_q0", "top_q1", "top_q2", "top_q3", "top_ω1", "top_ω2", "top_ω3"]);
    let (a, b, c) = (0.7, -1.1, 2.0);
    let rates = rates(&mut flow, &[1.0, 0.0, 0.0, 0.0, a, b, c]);
    let expected = [
        ((0.9 - 0.2) * b * c - 0.1 * a) / 0.8,
        ((0.2 - 0.8) * c * a - 0.1 * b) / 0.9,
        ((0.8 - 0.9) * a * b - 0.1 * c) / 0.2,
    ];
    alike(&rates[4..], &expected);
}

/// A universal joint is two joints with a link without mass between them.
#[test]
fn a_universal_joint_is_two_revolute_ones() {
    let link = |name: &str| {
        format!(
            r#"<link name="{name}"><inertial><origin xyz="0.1 0.2 -0.5"/><mass value="2"/>
            <inertia ixx="0.3" iyy="0.4" izz="0.2" {MOMENTS}/></inertial></link>"#
        )
    };
    let one = format!(
        r#"<robot name="r"><link name="base"/>{}<joint name="u" type="universal"><origin xyz="0 0 1" rpy="0.1 0.2 0.3"/>
        <parent link="base"/><child link="l"/><axis xyz="1 0 0"/><axis2 xyz="0 1 1"/><dynamics damping="0.2"/></joint></robot>"#,
        link("l")
    );
    let two = format!(
        r#"<robot name="r"><link name="base"/><link name="cross"/>{}
        <joint name="a" type="revolute"><origin xyz="0 0 1" rpy="0.1 0.2 0.3"/><parent link="base"/><child link="cross"/>
        <axis xyz="1 0 0"/><dynamics damping="0.2"/></joint>
        <joint name="b" type="revolute"><parent link="cross"/><child link="l"/><axis xyz="0 1 1"/><dynamics damping="0.2"/></joint></robot>"#,
        link("l")
    );
    let (mut one, mut two) = (flow(&text_of(&one).0), flow(&text_of(&two).0));
    assert_eq!(one.names[..2], ["l_1", "l_2"]);
    let state = [0.4, -0.9, 1.2, 0.7];
    alike(&rates(&mut one, &state), &rates(&mut two, &state));
}

/// An arm with a wrist and a tool without mass.
pub(super) const ENDS: &str = r#"<robot name="r"><link name="base"/>
<link name="arm"><inertial><origin xyz="0.3 0 0"/><mass value="2"/>
<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
<link name="wrist"/>
<link name="tool"/>
<joint name="a" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/></joint>
<joint name="turn" type="continuous"><parent link="arm"/><child link="wrist"/><axis xyz="1 0 0"/><dynamics damping="1"/></joint>
<joint name="hold" type="floating"><parent link="wrist"/><child link="tool"/></joint></robot>"#;

#[test]
fn links_without_mass_are_fixed_on_request() {
    let source = Source::new("r.urdf", ENDS);
    let fixing = ImportOptions { fix_massless: true, ..ImportOptions::default() };
    let (text, notes) = model_of_robot(&source, fixing).unwrap();
    assert_eq!(
        notes,
        [
            "the joint `turn` is fixed instead of continuous: it moves no mass",
            "the joint `hold` is fixed instead of floating: it moves no mass"
        ]
    );
    insta::assert_snapshot!("links_without_mass", text);
    // (I + m r²) ä = m g r cos a
    alike(&rates(&mut flow(&text), &[0.3, 0.0]), &[0.0, 2.0 * 9.81 * 0.3 * 0.3_f64.cos() / 0.28]);
}

/// Names that differ in what a model cannot tell apart, and names that a model has already.
#[test]
fn names_are_told_apart() {
    let link = |name: &str| {
        format!(
            r#"<link name="{name}"><inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" {MOMENTS}/></inertial></link>"#
        )
    };
    let urdf = format!(
        r#"<robot name="r">{}{}{}{}
        <joint name="energy" type="revolute"><parent link="a-b"/><child link="a b"/></joint>
        <joint name="g" type="prismatic"><parent link="a-b"/><child link="a_b"/></joint>
        <joint name="f" type="floating"><parent link="a-b"/><child link="a.b"/></joint></robot>"#,
        link("a-b"),
        link("a b"),
        link("a_b"),
        link("a.b")
    );
    let (text, _) = text_of(&urdf);
    insta::assert_snapshot!("names_told_apart", text);
    assert_eq!(flow(&text).names[..3], ["energy_", "g_", "a_b____x"]);
}

#[test]
fn moments_that_no_body_has_are_noted() {
    let urdf = format!(
        r#"<robot name="r"><link name="base"/><link name="l"><inertial><mass value="2"/>
        <inertia ixx="1" iyy="2" izz="3.5" {MOMENTS}/></inertial></link>
        <joint name="j" type="revolute"><parent link="base"/><child link="l"/></joint></robot>"#
    );
    let (text, notes) = text_of(&urdf);
    let note = "no body has the principal moments of inertia 1, 2 and 3.5 of the link `l`: one is negative, or larger \
                than the sum of the others";
    assert_eq!(notes, [note]);
    assert!(text.contains(&format!("# {note}.\n")), "{text}");
    alike(&rates(&mut flow(&text), &[0.0, 1.0]), &[1.0, 0.0]);
}

/// A flat body has Izz = Ixx + Iyy, whatever the digits of the file.
#[test]
fn moments_of_a_plate_are_those_of_a_body() {
    let urdf = format!(
        r#"<robot name="r"><link name="l"><inertial><mass value="2"/>
        <inertia ixx="0.3333333" iyy="0.1666667" izz="0.5000001" {MOMENTS}/></inertial></link></robot>"#
    );
    assert!(text_of(&urdf).1.is_empty());
}
