//! `[[draw]]`, and the shapes drawn automatically.

use std::path::PathBuf;

use pc_mech::{Expr, Graph};
use pc_model::{Arrow, Assembly, Builtin, Document, Model, ModelError, Quantity, Shape, Source};

fn read(draw: &str) -> Result<Model, ModelError> {
    let text = format!(
        "[parameters]\nl = 2.0\n[coordinates]\n\"φ\" = 0.5\n[lagrangian]\nkinetic = \"l^2*φ'^2/2\"\n\
         potential = \"-9.81*l*cos(φ)\"\n{draw}"
    );
    Ok(Model::new(Document::parse(Source::new("model.toml", text))?))
}

/// The functions of each shape as written.
fn drawn(model: &Model) -> Result<Vec<String>, ModelError> {
    let graph = Graph::new();
    let assembly = model.assemble(&graph)?;
    let shapes = model.drawing(&assembly)?;
    let written = |shape: &Shape<'_>| {
        let functions: Vec<String> = shape.functions().iter().map(ToString::to_string).collect();
        functions.join(", ")
    };
    Ok(shapes.iter().map(written).collect())
}

#[test]
fn shapes_are_functions_of_the_state() {
    let model = read(
        "[[draw]]\nkind = \"line\"\nthrough = [[0, 0], [\"l*sin(φ)\", \"-l*cos(φ)\"]]\n\
         [[draw]]\nkind = \"disc\"\nat = [0, \"φ'\"]\nradius = \"l/2\"\n\
         [[draw]]\nkind = \"text\"\nat = [1, 2, 3]\ntext = \"here\"\n",
    );
    let shapes = drawn(&model.unwrap()).unwrap();
    assert_eq!(shapes, ["0, 0, 0, l*sin(φ), -l*cos(φ), 0", "0, φ', 0, 0, 0, 1, 1/2*l", "1, 2, 3"]);
}

#[test]
fn bodies_on_joints_are_rods_and_masses() {
    let model = Model::new(Builtin::named("four-bar-loop").unwrap().document().unwrap());
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let shapes = model.drawing(&assembly).unwrap();
    let rods = shapes.iter().filter(|shape| matches!(shape, Shape::Line { .. })).count();
    let labels = shapes.iter().filter(|shape| matches!(shape, Shape::Point { label: Some(_), .. })).count();
    assert_eq!((rods, labels), (3, 3), "crank, coupler, rocker");
}

/// Edges 1, 2 and 3 of a mass of 2: I = 2 (2² + 3²)/12 and cyclically.
#[test]
fn a_body_that_turns_is_the_box_of_its_inertia() {
    let body = "[coordinates]\nplate = 0.3\n[bodies.plate]\njoint = { kind = \"revolute\", axis = [0, 0, 1] }\nmass = 2.0\n\
                inertia = [\"13/6\", \"5/3\", \"5/6\"]\n";
    let read = |text: &str| Model::new(Document::parse(Source::new("model.toml", text)).unwrap());
    let shapes = drawn(&read(body)).unwrap();
    let [plate, centre] = &shapes[..] else { panic!("{shapes:?}") };
    let numbers: Vec<f64> = plate.split(", ").skip(3).take(3).map(|edge| edge.parse().unwrap()).collect();
    assert!(numbers.iter().zip([1.0, 2.0, 3.0]).all(|(edge, right)| (edge - right).abs() < 1e-12), "{plate}");
    assert!(plate.contains("cos(plate)") && centre == "0, 0, 0", "{shapes:?}");
    // A point leads to a rod, and a drawing of the text takes the place of the box.
    let with_end = drawn(&read(&format!("{body}[points.end]\nbody = \"plate\"\nat = [1, 0, 0]\n"))).unwrap();
    assert_eq!(with_end[..2], ["0, 0, 0, cos(plate), sin(plate), 0", "0, 0, 0"]);
    let own = drawn(&read(&format!("{body}[[draw]]\nkind = \"point\"\nat = [0, 0]\n"))).unwrap();
    assert_eq!(own, ["0, 0, 0", "0, 0, 0"]);
}

/// A hub on the world with two arms, of which one ends at a point.
const ARMS: &str = "[bodies.hub]\njoint = { kind = \"revolute\", axis = [0, 0, 1] }\nmass = 1.0\ninertia = [1, 1, 1]\n\
     [bodies.left]\nparent = \"hub\"\njoint = { kind = \"revolute\", axis = [0, 0, 1], at = [1, 0, 0] }\nmass = 1.0\n\
     center = [0.5, 0, 0]\ninertia = [1, 1, 1]\n[points.tip]\nbody = \"left\"\nat = [1, 0, 0]\n";

#[test]
fn what_is_hidden_is_not_drawn() {
    let shapes = |drawing: &str| {
        let document = Document::parse(Source::new("model.toml", format!("{ARMS}{drawing}"))).unwrap();
        drawn(&Model::new(document)).unwrap()
    };
    // Rod and mass centre of each body, and the point.
    let all = shapes("");
    assert_eq!(all.len(), 5, "{all:?}");
    assert_eq!(shapes("[drawing]\nhide = false\nup = [0, 0, 1]\n"), all);
    assert_eq!(shapes("[drawing]\nhide = [\"hub\"]\n"), all[2..]);
    // Without the point, the rod of the arm ends at its mass centre.
    let without_tip = shapes("[drawing]\nhide = [\"tip\"]\n");
    assert_eq!((&without_tip[..2], without_tip.len()), (&all[..2], 4));
    assert!(without_tip[2].ends_with(&format!(", {}", without_tip[3])), "{without_tip:?}");
    let own = shapes("[drawing]\nhide = true\n[[draw]]\nkind = \"point\"\nat = [\"tip_x\", 0]\n");
    assert_eq!(own.len(), 1, "{own:?}");
}

#[test]
fn a_drawing_of_what_is_not_there_is_refused_in_full() {
    let refused = |text: String| Document::parse(Source::new("m.toml", text)).unwrap_err().to_string();
    let of = |drawing: &str| {
        let text = refused(format!("[drawing]\n{drawing}\n{ARMS}"));
        text.trim_end().to_owned()
    };
    assert_eq!(
        of("hide = [\"left\", \"tib\"]"),
        "m.toml:2:17: [drawing] hide: no body or point is called `tib`\n    hide = [\"left\", \"tib\"]\n                    ^^^^^\n  \
         help: did you mean `tip`? the bodies and points are hub, left, tip"
    );
    assert_eq!(
        of("hide = \"left\""),
        "m.toml:2:8: [drawing] hide: expected true or a list of names, found a string\n    hide = \"left\"\n           ^^^^^^\n  \
         help: write `hide = [\"NAME\"]`"
    );
    assert_eq!(
        of("up = [0, 1, 1]"),
        "m.toml:2:6: [drawing] up: expected a direction along one of the fixed axes, found [0, 1, 1]\n    up = [0, 1, 1]\n         ^^^^^^^^^\n  \
         help: write `up = [0, 0, 1]`"
    );
    assert!(of("up = [1]").contains("2 or 3 numbers"));
    assert!(of("down = [0, 0, 1]").contains("the entries here are hide, up"));
    let nothing =
        refused("coordinates.x = 1\nlagrangian.kinetic = \"x'^2\"\ndrawing.hide = [\"x\"]".to_owned());
    assert!(nothing.contains("the model has no bodies and no points"), "{nothing}");
}

#[test]
fn a_free_body_that_carries_others_is_a_box() {
    for (name, boxes) in [("satellite", 4), ("quadruped", 5)] {
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let shapes = model.drawing(&assembly).unwrap();
        assert!(matches!(shapes[0], Shape::Box { .. }), "{name}: {:?}", shapes[0]);
        let count = shapes.iter().filter(|shape| matches!(shape, Shape::Box { .. })).count();
        assert_eq!(count, boxes, "{name}: also the wheels, or the hips");
    }
}

/// The values of functions, and of their rates along the motion, near the start.
fn values_and_rates<'g>(assembly: &Assembly<'g>, functions: &[Expr<'g>]) -> (Vec<f64>, Vec<f64>) {
    let (system, graph) = (&assembly.system, assembly.system.graph());
    let mut at = assembly.at_start();
    let coordinates = system.frame().coordinates();
    at.iter_mut().filter(|(symbol, _)| coordinates.contains(symbol)).for_each(|(_, value)| *value += 0.3);
    at.extend(system.parameters());
    let velocities = system.frame().velocities(system.quasi_velocities());
    let rate = |&f: &Expr<'g>| {
        let by_time = graph.gradient(f, &[system.frame().time()])[0];
        graph.dot(graph.gradient(f, coordinates), velocities.iter().copied()) + by_time
    };
    let rates: Vec<Expr<'g>> = functions.iter().map(rate).collect();
    (graph.evaluate(functions, &at).unwrap(), graph.evaluate(&rates, &at).unwrap())
}

fn close(found: &[f64], wanted: &[f64]) -> bool {
    let size = wanted.iter().fold(1.0f64, |size, value| size.max(value.abs()));
    found.len() == wanted.len() && found.iter().zip(wanted).all(|(f, w)| (f - w).abs() < 1e-10 * size)
}

fn across(a: &[f64], b: &[f64]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// ė = ω × e for the axes e of the drawings, with ω of the models along these axes.
#[test]
fn what_is_drawn_turns_as_the_model_does() {
    for (name, columns, omega) in [
        // The columns of the rotation of the box.
        ("quadrotor", [[9, 12, 15], [10, 13, 16], [11, 14, 17]], ["p", "q", "s"]),
        // The normal of the inner ring, its bearings, and the axis of the disc.
        ("gimbals", [[22, 23, 24], [29, 30, 31], [41, 42, 43]], ["u*cos(β)", "v", "u*sin(β)"]),
    ] {
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let shapes = model.drawing(&assembly).unwrap();
        let functions: Vec<Expr<'_>> = shapes.iter().flat_map(Shape::functions).collect();
        let omega = omega.map(str::to_owned);
        let along = omega.map(|text| model.function(&assembly, &text).unwrap());
        let all: Vec<Expr<'_>> = columns.iter().flatten().map(|&i| functions[i]).chain(along).collect();
        let (values, rates) = values_and_rates(&assembly, &all);
        let axes: Vec<&[f64]> = values[..9].chunks(3).collect();
        let omega: Vec<f64> =
            (0..3).map(|k| (0..3).map(|axis| values[9 + axis] * axes[axis][k]).sum()).collect();
        for (axis, rate) in axes.iter().zip(rates.chunks(3)) {
            assert!(close(rate, &across(&omega, axis)), "{name}: {axis:?}, {rate:?}");
        }
        let handed = across(axes[0], axes[1]);
        assert!(close(&handed, axes[2]), "{name}: {axes:?}");
    }
}

fn of<'a, 'g>(arrows: &'a [Arrow<'g>], quantity: Quantity) -> impl Iterator<Item = &'a Arrow<'g>> {
    arrows.iter().filter(move |arrow| arrow.quantity == quantity)
}

/// ṙ is the rate of the place where its arrow begins.
#[test]
fn arrows_of_velocity_begin_at_what_moves_so() {
    let mut count = 0;
    for builtin in Builtin::all() {
        let model = Model::new(builtin.document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let arrows = model.arrows(&assembly).unwrap();
        let velocities: Vec<&Arrow<'_>> = of(&arrows, Quantity::Velocity).collect();
        let places: Vec<Expr<'_>> = velocities.iter().flat_map(|arrow| arrow.at).collect();
        let vectors: Vec<Expr<'_>> = velocities.iter().flat_map(|arrow| arrow.vector).collect();
        let (_, rates) = values_and_rates(&assembly, &places);
        let (vectors, _) = values_and_rates(&assembly, &vectors);
        // The frames of joints have unit quaternions, which the values here are not.
        if assembly.system.unit_quaternions().is_empty() {
            assert!(close(&vectors, &rates), "{}: {vectors:?}, {rates:?}", builtin.name);
            count += velocities.len();
        }
    }
    assert!(count > 30, "{count} arrows");
}

/// A rotor on a tilted axis in a turning fork: ω = Ω e_z + n e, and its weight is at the mass centre.
#[test]
fn arrows_of_a_rotor_in_a_fork() {
    let text = "[bodies.fork]\njoint = { kind = \"revolute\", axis = [0, 0, 1] }\ninertia = [0, 0, 1]\n\
                [bodies.rotor]\nparent = \"fork\"\njoint = { kind = \"revolute\", axis = [0, 0, 1], at = [1, 0, 0], turns = [[\"y\", 0.5]] }\n\
                mass = 2.0\ninertia = [1, 1, 1]\nforce = [\"3*fork'\", 0, 0]\n\
                [quasi_velocities]\n\"fork'\" = 0.7\n\"rotor'\" = 5.0\n[gravity]\nacceleration = [0, 0, -9.81]\n";
    let model = Model::new(Document::parse(Source::new("model.toml", text)).unwrap());
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let arrows = model.arrows(&assembly).unwrap();
    let vectors = |quantity| -> Vec<f64> {
        let functions: Vec<Expr<'_>> = of(&arrows, quantity)
            .filter(|arrow| arrow.of == "rotor")
            .flat_map(|arrow| arrow.vector)
            .collect();
        values_and_rates(&assembly, &functions).0
    };
    // The fork stands at 0.3 there.
    let ([sin, cos], [s, c]) = ([0.3f64.sin(), 0.3f64.cos()], [0.5f64.sin(), 0.5f64.cos()]);
    assert!(close(&vectors(Quantity::Velocity), &[-0.7 * sin, 0.7 * cos, 0.0]));
    assert!(close(&vectors(Quantity::AngularVelocity), &[5.0 * s * cos, 5.0 * s * sin, 0.7 + 5.0 * c]));
    assert!(close(&vectors(Quantity::Force), &[0.0, 0.0, -19.62, 2.1, 0.0, 0.0]));
}

#[test]
fn a_drawing_that_cannot_be_drawn_is_refused_with_its_text() {
    let refused = |draw: &str| match read(draw).and_then(|model| drawn(&model)) {
        Err(error) => error.to_string(),
        Ok(shapes) => panic!("{draw}: {shapes:?}"),
    };
    for (draw, said) in [
        ("[draw]\nkind = \"point\"\nat = [0, 0]\n", "expected [[draw]]"),
        ("[[draw]]\nat = [0, 0]\n", "kind"),
        ("[[draw]]\nkind = \"dot\"\nat = [0, 0]\n", "dot"),
        ("[[draw]]\nkind = \"point\"\n", "at"),
        ("[[draw]]\nkind = \"point\"\nat = [0]\n", "2 or 3 expressions"),
        ("[[draw]]\nkind = \"point\"\nat = [0, 0]\nradius = 1\n", "radius"),
        ("[[draw]]\nkind = \"line\"\nthrough = [[0, 0]]\n", "2 to 64 places"),
        ("[[draw]]\nkind = \"point\"\nat = [\"nowhere\", 0]\n", "nowhere"),
    ] {
        let error = refused(draw);
        assert!(error.contains(said), "{draw}: {error}");
    }
}

#[test]
fn all_models_are_drawn() {
    for builtin in Builtin::all() {
        let model = Model::new(builtin.document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        assert!(!model.drawing(&assembly).unwrap().is_empty(), "{}", builtin.name);
    }
}

/// What is drawn in the axes of a body is where its points are, and turns with it.
#[test]
fn shapes_follow_the_bodies_that_carry_them() {
    let shapes = |drawn: &str| {
        let text = format!("{ARMS}[drawing]\nhide = [\"hub\", \"left\"]\n{drawn}");
        let model = Model::new(Document::parse(Source::new("robots/model.toml", text)).unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let shapes = model.drawing(&assembly).unwrap();
        let state = [("hub", 0.3), ("left", 0.4)].map(|(name, angle)| (graph.symbol(name), angle));
        let numbers = |shape: &Shape<'_>| graph.evaluate(&shape.functions(), &state).unwrap();
        (shapes.iter().map(numbers).collect::<Vec<_>>(), shapes.into_iter().next_back().map(kind_of))
    };
    fn kind_of(shape: Shape<'_>) -> Option<(PathBuf, [f64; 3])> {
        match shape {
            Shape::Mesh { file, scale, .. } => Some((file, scale)),
            _ => None,
        }
    }
    let near = |found: &[f64], wanted: &[f64]| {
        let is_near = found.len() == wanted.len()
            && found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-14);
        assert!(is_near, "{found:?}, not {wanted:?}");
    };
    let (point, _) = shapes("[[draw]]\nkind = \"point\"\nbody = \"left\"\nat = [1, 0, 0]\n");
    near(&point[1], &point[0]);
    let (sin, cos) = 0.7_f64.sin_cos();
    let (joint, turned) =
        ([0.3_f64.cos(), 0.3_f64.sin(), 0.0], [cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0]);
    let (disc, _) =
        shapes("[[draw]]\nkind = \"disc\"\nbody = \"left\"\nat = [0, 2]\nnormal = [1, 0, 0]\nradius = 0.5\n");
    near(&disc[1], &[joint[0] - 2.0 * sin, joint[1] + 2.0 * cos, 0.0, cos, sin, 0.0, 0.5]);
    let (boxed, _) = shapes("[[draw]]\nkind = \"box\"\nbody = \"left\"\nat = [0, 0]\nsize = [1, 2, 3]\n");
    near(&boxed[1], &[&joint[..], &[1.0, 2.0, 3.0], &turned].concat());
    let (mesh, of_file) = shapes(
        "[[draw]]\nkind = \"mesh\"\nbody = \"left\"\nfile = \"meshes/arm.stl\"\nscale = 0.001\n\
         rotation = [0, -1, 0, 1, 0, 0, 0, 0, 1]\n",
    );
    near(&mesh[1], &[&joint[..], &[-sin, -cos, 0.0, cos, -sin, 0.0, 0.0, 0.0, 1.0]].concat());
    assert_eq!(of_file, Some(Some((PathBuf::from("robots/meshes/arm.stl"), [0.001; 3]))));
}

#[test]
fn a_body_that_is_drawn_in_its_own_axes_is_no_box_but_others_are() {
    let model = Builtin::named("satellite").unwrap();
    let boxes = |drawn: &str| {
        let text = format!("{}\n{drawn}", model.text);
        let model = Model::new(Document::parse(Source::new("satellite.toml", text)).unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let shapes = model.drawing(&assembly).unwrap();
        shapes.iter().filter(|shape| matches!(shape, Shape::Box { .. })).count()
    };
    assert_eq!(boxes(""), 4);
    let document = model.document().unwrap();
    let first = &document.tree[0].name.text;
    assert_eq!(boxes(&format!("[[draw]]\nkind = \"mesh\"\nbody = \"{first}\"\nfile = \"a.obj\"\n")), 3);
    assert_eq!(boxes("[[draw]]\nkind = \"point\"\nat = [0, 0]\n"), 0);
}

#[test]
fn shapes_in_no_axes_and_of_no_size_are_refused_in_full() {
    let refused = |draw: &str, bodies: &str| {
        let text = format!("[[draw]]\n{draw}\n{bodies}");
        Document::parse(Source::new("m.toml", text)).unwrap_err().to_string()
    };
    let shapes = [
        ("kind = \"point\"\nbody = \"lift\"\nat = [0, 0]", ARMS),
        ("kind = \"mesh\"\nfile = \"a.stl\"\nscale = [1, 0, 1]", ARMS),
        ("kind = \"mesh\"\nfile = \"a.stl\"\nscale = [1, 1]", ARMS),
        ("kind = \"mesh\"\nbody = \"hub\"", ARMS),
        (
            "kind = \"mesh\"\nbody = \"top\"\nfile = \"a.stl\"",
            "[quasi_velocities]\n\"ω1\" = 0\n\"ω2\" = 0\n\"ω3\" = 0\n[algebra]\nname = \"so3\"\n[bodies.top]\nmass = 1\nposition = [0, 0, 0]\ninertia = [1, 1, 1]\n\
             angular_velocity = [\"ω1\", \"ω2\", \"ω3\"]\n",
        ),
    ];
    let messages: Vec<String> = shapes.iter().map(|(draw, bodies)| refused(draw, bodies)).collect();
    insta::assert_snapshot!(messages.join("\n"));
}
