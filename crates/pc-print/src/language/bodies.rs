//! The equations of large trees of bodies, written body by body.
//!
//! Written out in full, they are longer than a page and grow with the number of bodies; written body by body,
//! they are the same few equations for each, with its own rotation, position and mass.

use std::fmt::Write as _;

use pc_expr::Style;
use pc_mech::{Expr, Graph, Matrix, System, Tree};
use serde_json::{Value, json};

use crate::equations::operations::Operations;
use crate::layout::layout::Layout;

/// The equations common to all bodies, in text and in LaTeX.
const LAWS: [(&str, &str, &str); 6] = [
    (
        "From the axes of a body to those of its parent, by R, and to those of the world",
        "W = W_p R",
        r"W &= W_{p} R",
    ),
    (
        "Velocities of a body against those of its parent p",
        "ω = Rᵀ ω_p + ω_r,   v = Rᵀ (v_p + ω_p × r) + v_r",
        r"\omega &= R^{T} \omega_{p} + \omega_{r}, & v &= R^{T} (v_{p} + \omega_{p} \times r) + v_{r}",
    ),
    (
        "Accelerations, those of the world being 0 and -g",
        "α = Rᵀ α_p + ω × ω_r + ω_r',   a = Rᵀ (a_p + α_p × r + ω_p × (ω_p × r)) + (2 ω - ω_r) × v_r + v_r'",
        r"\alpha &= R^{T} \alpha_{p} + \omega \times \omega_{r} + \dot\omega_{r}, & a &= R^{T} \bigl(a_{p} + \alpha_{p} \times r + \omega_{p} \times (\omega_{p} \times r)\bigr) + (2\omega - \omega_{r}) \times v_{r} + \dot v_{r}",
    ),
    (
        "Force and moment that its joint exerts, the sums over the bodies k that hang on it",
        "f = m (a + α × c + ω × (ω × c)) - Wᵀ F + Σ R_k f_k",
        r"f &= m \bigl(a + \alpha \times c + \omega \times (\omega \times c)\bigr) - W^{T} F + \sum_{k} R_{k} f_{k}",
    ),
    (
        "",
        "n = I α + ω × I ω + c × (m (a + α × c + ω × (ω × c)) - Wᵀ F) - N + Σ (R_k n_k + r_k × R_k f_k)",
        r"n &= I \alpha + \omega \times I \omega + c \times \bigl(m (a + \alpha \times c + \omega \times (\omega \times c)) - W^{T} F\bigr) - N + \sum_{k} (R_{k} n_{k} + r_{k} \times R_{k} f_{k})",
    ),
    (
        "Equation of each quasi-velocity η of its joint",
        "n · ∂ω_r/∂η + f · ∂v_r/∂η = Q_η",
        r"n \cdot \frac{\partial \omega_{r}}{\partial \eta} + f \cdot \frac{\partial v_{r}}{\partial \eta} &= Q_{\eta}",
    ),
];

/// The last of these laws where a quasi-velocity moves several joints, or a joint has an armature.
const OF_SEVERAL: (&str, &str, &str) = (
    "Equation of each quasi-velocity η, the sum over the bodies whose joints it moves, J being armatures",
    "Σ (n · ∂ω_r/∂η + f · ∂v_r/∂η + J η') = Q_η",
    r"\sum \Bigl(n \cdot \frac{\partial \omega_{r}}{\partial \eta} + f \cdot \frac{\partial v_{r}}{\partial \eta} + J \dot\eta\Bigr) &= Q_{\eta}",
);

/// The bodies of a tree in the graph of a page, and the acceleration of gravity along the axes of the world.
pub(crate) struct TreeOnPage<'p> {
    bodies: Vec<BodyOnPage<'p>>,
    gravity: [Expr<'p>; 3],
    /// Whether a quasi-velocity moves several joints.
    is_geared: bool,
}

impl TreeOnPage<'_> {
    fn laws(&self) -> [(&'static str, &'static str, &'static str); 6] {
        let [laws @ .., of_joint] = LAWS;
        let of_several = self.is_geared || self.bodies.iter().any(|body| !body.armature.is_zero());
        let last = if of_several { OF_SEVERAL } else { of_joint };
        let mut all = [last; 6];
        all[..5].copy_from_slice(&laws);
        all
    }
}

/// A body with the data that enter its equations.
struct BodyOnPage<'p> {
    name: String,
    parent: String,
    /// The letters used in print, the identifiers used by programs, and the vectors they denote.
    vectors: Vec<(&'static str, &'static str, [Expr<'p>; 3])>,
    matrices: Vec<(&'static str, &'static str, Matrix<Expr<'p>>)>,
    mass: Expr<'p>,
    armature: Expr<'p>,
    /// Each η with its Q_η, which does not include loads on bodies.
    forces: Vec<(Expr<'p>, Expr<'p>)>,
    kinematics: Vec<(Expr<'p>, Expr<'p>)>,
}

/// The tree, rebuilt in the graph of a page.
pub(crate) fn tree_on_page<'p>(system: &System<'_>, tree: &Tree<'_>, paper: &'p Graph) -> TreeOnPage<'p> {
    let graph = system.graph();
    let one = |expression: Expr<'_>| graph.typeset(&[expression], paper)[0];
    let all = |vector: [Expr<'_>; 3]| vector.map(one);
    let applied = system.joint_forces();
    let rates = system.frame().velocities(system.quasi_velocities());
    let rate = |name: &str| {
        let place = system.frame().coordinates().iter().position(|x| x.to_string() == name);
        place.map(|place| one(rates[place]))
    };
    let body = |body: &pc_mech::TreeBody<'_>| {
        let joint = tree.joint_motion(body.name())?;
        let (mass, centre, inertia) = body.mass_properties();
        let (force, torque) = body.loads();
        let force_of = |eta: &Expr<'_>| {
            let place = system.quasi_velocities().iter().position(|known| known == eta);
            place.map(|place| (one(*eta), one(applied[place])))
        };
        let of_joint = tree.joint_coordinates(body.name());
        let kinematic = |x: &Expr<'_>| rate(&x.to_string()).map(|rate| (one(*x), rate));
        Some(BodyOnPage {
            name: body.name().to_owned(),
            parent: body.parent().unwrap_or("world").to_owned(),
            vectors: vec![
                ("r", "place", all(joint.place)),
                ("ω_r", "angular_velocity", all(joint.angular_velocity)),
                ("v_r", "velocity", all(joint.velocity)),
                ("c", "center", all(centre)),
                ("F", "force", all(force)),
                ("N", "torque", all(torque)),
            ],
            matrices: vec![("R", "rotation", joint.rotation.map(one)), ("I", "inertia", inertia.map(one))],
            mass: one(mass),
            armature: one(joint.armature),
            forces: joint.quasi_velocities.iter().filter_map(force_of).collect(),
            kinematics: of_joint.iter().filter_map(kinematic).collect(),
        })
    };
    TreeOnPage {
        bodies: tree.bodies().iter().filter_map(body).collect(),
        gravity: all(system.gravity()),
        is_geared: tree.bodies().iter().any(|body| body.followed().is_some()),
    }
}

fn vanishes(vector: &[Expr<'_>; 3]) -> bool {
    vector.iter().all(|component| component.is_zero())
}

/// The equations as text; `heading` is the title with the name of the form.
pub(crate) fn text(heading: &str, tree: &TreeOnPage<'_>, operations: &Operations, layout: &Layout) -> String {
    let mut page = crate::language::text::underlined(heading);
    page +=
        "Written from body to body: as a whole the equations would be longer than a page.\n\nFor each body\n";
    for (about, law, _) in tree.laws() {
        if !about.is_empty() {
            page += &format!("  {about}\n");
        }
        let terms: Vec<String> = law.split(' ').map(str::to_owned).collect();
        let law = Layout { width: layout.width.saturating_sub(4), ..*layout }.flowed("", &terms);
        law.iter().for_each(|line| page += &format!("    {line}\n"));
    }
    page += "  F is a force at the mass centre c, along the axes of the world, N a torque; other vectors stand along\n  the axes of the body, r along those of its parent.\n";
    let gravity: Vec<String> = tree.gravity.iter().map(|g| g.display(Style::Book)).collect();
    if !vanishes(&tree.gravity) {
        page += &format!("\nGravity\n  g = ({})\n", gravity.join(", "));
    }
    for body in &tree.bodies {
        page += &format!("\n{} on {}\n", body.name, body.parent);
        let written = |expression: &Expr<'_>| expression.display(Style::Book);
        let mut put = |left: &str, right: String| {
            let terms: Vec<String> = right.split(' ').map(str::to_owned).collect();
            for line in layout.flowed(&format!("{left} = "), &terms) {
                page += &format!("  {line}\n");
            }
        };
        for (letter, _, matrix) in &body.matrices {
            if matrix.entries().iter().all(|entry| entry.is_zero()) {
                continue;
            }
            let rows = matrix.to_rows();
            let rows: Vec<String> =
                rows.iter().map(|row| row.iter().map(written).collect::<Vec<_>>().join(", ")).collect();
            put(letter, format!("({})", rows.join("; ")));
        }
        put("m", written(&body.mass));
        if !body.armature.is_zero() {
            put("J", written(&body.armature));
        }
        for (letter, _, vector) in body.vectors.iter().filter(|(.., vector)| !vanishes(vector)) {
            put(letter, format!("({})", vector.iter().map(written).collect::<Vec<_>>().join(", ")));
        }
        for (eta, force) in body.forces.iter().filter(|(_, force)| !force.is_zero()) {
            put(&format!("Q_{}", written(eta)), written(force));
        }
        for (x, rate) in body.kinematics.iter().filter(|(x, rate)| rate.to_string() != format!("{x}'")) {
            put(&format!("{}'", written(x)), written(rate));
        }
    }
    page += "\nOperations of one right-hand side\n";
    operations.lines().iter().for_each(|line| page += &format!("  {line}\n"));
    page
}

/// As LaTeX.
pub(crate) fn latex(heading: &str, tree: &TreeOnPage<'_>) -> String {
    let mut page =
        format!("% {heading}, from body to body (needs amsmath)\n\n% For each body\n\\begin{{align*}}\n");
    page += &tree.laws().map(|(_, _, law)| law).join(" \\\\\n");
    let gravity: Vec<String> = tree.gravity.iter().map(|g| g.display(Style::Latex)).collect();
    let _ = write!(page, " \\\\\ng &= ({})", gravity.join(", \\; ")); // writing to a string cannot fail
    page += "\n\\end{align*}\n";
    for body in &tree.bodies {
        let set = |expression: &Expr<'_>| expression.display(Style::Latex);
        let mut lines = Vec::new();
        for (letter, _, matrix) in &body.matrices {
            if matrix.entries().iter().all(|entry| entry.is_zero()) {
                continue;
            }
            let rows = matrix.to_rows();
            let rows: Vec<String> =
                rows.iter().map(|row| row.iter().map(set).collect::<Vec<_>>().join(" & ")).collect();
            lines.push(format!("{letter} &= \\begin{{pmatrix}} {} \\end{{pmatrix}}", rows.join(" \\\\ ")));
        }
        lines.push(format!("m &= {}", set(&body.mass)));
        if !body.armature.is_zero() {
            lines.push(format!("J &= {}", set(&body.armature)));
        }
        for (letter, _, vector) in body.vectors.iter().filter(|(.., vector)| !vanishes(vector)) {
            let letter = letter.replace("ω_r", "\\omega_{r}").replace("v_r", "v_{r}");
            let components = vector.iter().map(set).collect::<Vec<_>>().join(", \\; ");
            lines.push(format!("{letter} &= ({components})"));
        }
        for (eta, force) in body.forces.iter().filter(|(_, force)| !force.is_zero()) {
            lines.push(format!("Q_{{{}}} &= {}", set(eta), set(force)));
        }
        // Writing to a string cannot fail.
        let _ = write!(
            page,
            "\n% {} on {}\n\\begin{{align*}}\n{}\n\\end{{align*}}\n",
            crate::words::visible::one_line(&body.name),
            crate::words::visible::one_line(&body.parent),
            lines.join(" \\\\\n")
        );
    }
    page
}

/// As JSON.
pub(crate) fn programs(
    title: &str,
    system: &System<'_>,
    tree: &TreeOnPage<'_>,
    operations: &Operations,
) -> Value {
    let text = |expression: &Expr<'_>| expression.to_string();
    let list = |vector: &[Expr<'_>; 3]| vector.iter().map(text).collect::<Vec<_>>();
    let body = |body: &BodyOnPage<'_>| {
        let mut object = serde_json::Map::new();
        object.insert("name".to_owned(), json!(body.name));
        object.insert("parent".to_owned(), json!(body.parent));
        object.insert("mass".to_owned(), json!(text(&body.mass)));
        object.insert("armature".to_owned(), json!(text(&body.armature)));
        for (_, key, vector) in &body.vectors {
            object.insert((*key).to_owned(), json!(list(vector)));
        }
        for (_, key, matrix) in &body.matrices {
            let rows: Vec<Vec<String>> =
                matrix.to_rows().iter().map(|row| row.iter().map(text).collect()).collect();
            object.insert((*key).to_owned(), json!(rows));
        }
        let named = |pairs: &[(Expr<'_>, Expr<'_>)]| -> Value {
            Value::Object(pairs.iter().map(|(name, value)| (name.to_string(), json!(text(value)))).collect())
        };
        object.insert("forces".to_owned(), named(&body.forces));
        object.insert("rates".to_owned(), named(&body.kinematics));
        Value::Object(object)
    };
    let names = |list: &[Expr<'_>]| list.iter().map(Expr::to_string).collect::<Vec<_>>();
    let parameters = system.parameters().iter().map(|(name, value)| (name.to_string(), json!(value)));
    json!({
        "model": title,
        "coordinates": names(system.frame().coordinates()),
        "quasi_velocities": names(system.quasi_velocities()),
        "parameters": Value::Object(parameters.collect()),
        "gravity": list(&tree.gravity),
        "laws": tree.laws().map(|(_, law, _)| law),
        "bodies": tree.bodies.iter().map(body).collect::<Vec<_>>(),
        "operations": operations.object(),
    })
}
