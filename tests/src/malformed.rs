//! Model files that must be refused, each wrong in exactly one way, and what must be said of them.
//!
//! The files lie in `malformed/` beside `src/`. `pc run` must end on each with the exit code named here, without a
//! panic, and with a message on standard error that names the file and the line and shows the offending text.
//! Putting the [`cure`](Malformed::cure) in makes a model that runs: nothing else is wrong with it.

use std::path::PathBuf;

/// A model file that must be refused.
#[derive(Clone, Copy, Debug)]
pub struct Malformed {
    /// File name in `malformed/`.
    pub file: &'static str,
    /// What is wrong with it.
    pub fault: &'static str,
    /// 2: no end time; 3: the text is wrong; 4: the text is right and the model inconsistent.
    pub exit_code: i32,
    /// Texts of which at least one must occur in the message, in any case of letters.
    pub mentions: &'static [&'static str],
    /// The line the message must name, counted from 1, where one line is to blame.
    pub line: Option<usize>,
    /// The wrong text, which occurs once in the file, and what to put in its place.
    pub cure: Option<(&'static str, &'static str)>,
}

impl Malformed {
    /// Where the file lies.
    pub fn path(&self) -> PathBuf {
        directory().join(self.file)
    }
}

/// The directory of the malformed files.
pub fn directory() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("malformed")
}

/// The malformed files, in the order of their names.
pub const MALFORMED: &[Malformed] = &[
    Malformed {
        file: "acceleration-in-lagrangian.toml",
        fault: "an acceleration in the Lagrangian",
        exit_code: 3,
        mentions: &["d(phi')"],
        line: Some(18),
        cure: Some(("cos(phi) + d(phi')\"", "cos(phi)\"")),
    },
    Malformed {
        file: "algebra-too-large.toml",
        fault: "an algebra of three dimensions for two quasi-velocities",
        exit_code: 3,
        mentions: &["so3"],
        line: Some(16),
        cure: Some(("[algebra]\nname = \"so3\"\n\n[lagrangian]", "[lagrangian]")),
    },
    Malformed {
        file: "array-for-start.toml",
        fault: "an array where a start value must stand",
        exit_code: 3,
        mentions: &["phi"],
        line: Some(8),
        cure: Some(("phi = [1.0]", "phi = 1.0")),
    },
    Malformed {
        file: "array-of-sections.toml",
        fault: "a section written as an array of tables",
        exit_code: 3,
        mentions: &["parameters"],
        line: Some(3),
        cure: Some(("[[parameters]]", "[parameters]")),
    },
    Malformed {
        file: "bad-number.toml",
        fault: "a number with two decimal points",
        exit_code: 3,
        mentions: &["1.0.0"],
        line: Some(21),
        cure: Some(("t_end = 1.0.0", "t_end = 1.0")),
    },
    Malformed {
        file: "boolean-for-expression.toml",
        fault: "a truth value where an expression must stand",
        exit_code: 3,
        mentions: &["true"],
        line: Some(18),
        cure: Some(("potential = true", "potential = \"-g*l*cos(phi)\"")),
    },
    Malformed {
        file: "bracket-against-frame.toml",
        fault: "a bracket that the frame contradicts",
        exit_code: 4,
        mentions: &["drive"],
        line: Some(16),
        cure: Some(("\"drive,drift\" = \"drive\"", "\"drive,drift\" = \"0\"")),
    },
    Malformed {
        file: "bracket-not-constant.toml",
        fault: "a bracket whose coefficient is a coordinate",
        exit_code: 3,
        mentions: &["x*drive"],
        line: Some(16),
        cure: Some(("\"drive,drift\" = \"x*drive\"", "\"drive,drift\" = \"0\"")),
    },
    Malformed {
        file: "bracket-not-linear.toml",
        fault: "a bracket quadratic in the quasi-velocities",
        exit_code: 3,
        mentions: &["w2^2"],
        line: Some(13),
        cure: Some(("\"w3,w1\" = \"w2^2\"", "\"w3,w1\" = \"w2\"")),
    },
    Malformed {
        file: "bracket-not-skew.toml",
        fault: "a pair of brackets that is not skew",
        exit_code: 3,
        mentions: &["w2,w1"],
        line: Some(14),
        cure: Some(("\"w3,w1\" = \"w2\"\n\"w2,w1\" = \"w3\"", "\"w3,w1\" = \"w2\"")),
    },
    Malformed {
        file: "bracket-of-three.toml",
        fault: "a bracket of three quasi-velocities",
        exit_code: 3,
        mentions: &["w1,w2,w3"],
        line: Some(14),
        cure: Some(("\"w3,w1\" = \"w2\"\n\"w1,w2,w3\" = \"0\"", "\"w3,w1\" = \"w2\"")),
    },
    Malformed {
        file: "bracket-of-unknown.toml",
        fault: "a bracket with a quasi-velocity that does not exist",
        exit_code: 3,
        mentions: &["w9"],
        line: Some(13),
        cure: Some(("\"w3,w9\"", "\"w3,w1\"")),
    },
    Malformed {
        file: "bracket-of-wrong-sign.toml",
        fault: "brackets of so(2,1) for a frame of so(3)",
        exit_code: 4,
        mentions: &["w1", "w2", "w3"],
        line: None,
        cure: Some(("\"w1,w2\" = \"-w3\"", "\"w1,w2\" = \"w3\"")),
    },
    Malformed {
        file: "bracket-with-itself.toml",
        fault: "a bracket of a quasi-velocity with itself that is not zero",
        exit_code: 3,
        mentions: &["w1,w1"],
        line: Some(14),
        cure: Some(("\"w3,w1\" = \"w2\"\n\"w1,w1\" = \"w2\"", "\"w3,w1\" = \"w2\"")),
    },
    Malformed {
        file: "cyclic-definitions.toml",
        fault: "two definitions that need each other",
        exit_code: 3,
        mentions: &["scale"],
        line: Some(14),
        cure: Some(("weight = \"scale\"", "weight = \"g\"")),
    },
    Malformed {
        file: "definitions-dependent.toml",
        fault: "quasi-velocities that are proportional to each other",
        exit_code: 4,
        mentions: &["singular", "rank", "dependent"],
        line: None,
        cure: Some(("\"2*x' + 2*y'\"", "\"x' - y'\"")),
    },
    Malformed {
        file: "definitions-too-few.toml",
        fault: "fewer definitions of quasi-velocities than coordinates",
        exit_code: 4,
        mentions: &["definition", "quasi_velocities", "quasi-velocities"],
        line: None,
        cure: Some((
            "sum = { is = \"x' + y'\", start = 1.0 }",
            "sum = { is = \"x' + y'\", start = 1.0 }\ngap = { is = \"x' - y'\", start = 0.5 }",
        )),
    },
    Malformed {
        file: "division-by-zero.toml",
        fault: "a literal division by zero",
        exit_code: 3,
        mentions: &["1/0"],
        line: Some(18),
        cure: Some(("potential = \"1/0 - g*l*cos(phi)\"", "potential = \"-g*l*cos(phi)\"")),
    },
    Malformed {
        file: "duplicate-key.toml",
        fault: "one coordinate written twice",
        exit_code: 3,
        mentions: &["phi"],
        line: Some(9),
        cure: Some(("phi = 1.0\nphi = 2.0", "phi = 1.0")),
    },
    Malformed {
        file: "duplicate-table.toml",
        fault: "one section opened twice",
        exit_code: 3,
        mentions: &["coordinates"],
        line: Some(20),
        cure: Some(("[coordinates]\n\n[simulation]", "[simulation]")),
    },
    Malformed {
        file: "empty-expression.toml",
        fault: "an expression of no characters",
        exit_code: 3,
        mentions: &["potential"],
        line: Some(18),
        cure: Some(("potential = \"\"", "potential = \"-g*l*cos(phi)\"")),
    },
    Malformed {
        file: "empty.toml",
        fault: "nothing at all",
        exit_code: 3,
        mentions: &["lagrangian"],
        line: None,
        cure: None,
    },
    Malformed {
        file: "event-not-a-number.toml",
        fault: "an event whose function is no number at the start",
        exit_code: 4,
        mentions: &["sqrt(phi - 2)"],
        line: Some(21),
        cure: Some(("sqrt(phi - 2)", "sqrt(phi + 2)")),
    },
    Malformed {
        file: "event-of-unknown.toml",
        fault: "an event of a name that does not exist",
        exit_code: 3,
        mentions: &["chi"],
        line: Some(21),
        cure: Some(("when = \"chi\"", "when = \"phi\"")),
    },
    Malformed {
        file: "force-on-unknown.toml",
        fault: "a force on a name that does not exist",
        exit_code: 3,
        mentions: &["slip"],
        line: Some(21),
        cure: Some(("slip = \"-omega\"", "omega = \"-omega\"")),
    },
    Malformed {
        file: "fractional-samples.toml",
        fault: "a fractional number of samples",
        exit_code: 3,
        mentions: &["samples"],
        line: Some(22),
        cure: Some(("t_end = 1.0\nsamples = 2.5", "t_end = 1.0")),
    },
    Malformed {
        file: "frame-not-closed.toml",
        fault: "two fields whose bracket leaves their plane",
        exit_code: 4,
        mentions: &["drift"],
        line: None,
        cure: Some(("z = \"y*drive\"", "z = \"x*drive\"")),
    },
    Malformed {
        file: "infinite-literal.toml",
        fault: "a number beyond the range of arithmetic",
        exit_code: 3,
        mentions: &["1e999"],
        line: Some(18),
        cure: Some(("potential = \"-1e999*cos(phi)\"", "potential = \"-g*l*cos(phi)\"")),
    },
    Malformed {
        file: "infinite-parameter.toml",
        fault: "a parameter that is infinite",
        exit_code: 3,
        mentions: &["inf"],
        line: Some(5),
        cure: Some(("l = inf", "l = 1.0")),
    },
    Malformed {
        file: "integral-of-unknown.toml",
        fault: "an integral of a name that does not exist",
        exit_code: 3,
        mentions: &["chi"],
        line: Some(21),
        cure: Some(("fall = \"cos(chi)\"", "fall = \"cos(phi)\"")),
    },
    Malformed {
        file: "invalid-name.toml",
        fault: "a name that contains a space",
        exit_code: 3,
        mentions: &["free fall"],
        line: Some(21),
        cure: Some(("\"free fall\" = \"cos(phi)\"", "fall = \"cos(phi)\"")),
    },
    Malformed {
        file: "jacobi-violated.toml",
        fault: "brackets that violate the Jacobi identity",
        exit_code: 4,
        mentions: &["Jacobi"],
        line: None,
        cure: Some(("\"w2,w3\" = \"w2\"", "\"w2,w3\" = \"w1\"")),
    },
    Malformed {
        file: "junk.bin",
        fault: "binary junk",
        exit_code: 3,
        mentions: &["UTF-8"],
        line: None,
        cure: None,
    },
    Malformed {
        file: "kinematics-incomplete.toml",
        fault: "a coordinate without its kinematics",
        exit_code: 3,
        mentions: &["height"],
        line: None,
        cure: Some(("x = \"drive + drift\"", "x = \"drive\"\nheight = \"drift\"")),
    },
    Malformed {
        file: "kinematics-of-nothing.toml",
        fault: "kinematics of a coordinate that does not exist",
        exit_code: 3,
        mentions: &["zeta"],
        line: Some(14),
        cure: Some(("y = \"drift\"\nzeta = \"drift\"", "y = \"drift\"")),
    },
    Malformed {
        file: "lagrangian-degenerate.toml",
        fault: "a kinetic energy of one combination of two velocities",
        exit_code: 4,
        mentions: &["degenerate", "singular"],
        line: None,
        cure: Some(("\"(drive + drift)^2/2\"", "\"(drive^2 + drift^2)/2\"")),
    },
    Malformed {
        file: "lagrangian-without-velocity.toml",
        fault: "a kinetic energy that contains no velocity",
        exit_code: 4,
        mentions: &["degenerate", "singular"],
        line: None,
        cure: Some(("\"l^2*phi^2/2\"", "\"l^2*omega^2/2\"")),
    },
    Malformed {
        file: "latin1.toml",
        fault: "an accent written in Latin-1, not UTF-8",
        exit_code: 3,
        mentions: &["UTF-8"],
        line: Some(4),
        cure: None,
    },
    Malformed {
        file: "logarithm-of-negative.toml",
        fault: "the logarithm of a negative number at the start",
        exit_code: 4,
        mentions: &["log"],
        line: None,
        cure: Some(("x = -1.0", "x = 1.0")),
    },
    Malformed {
        file: "missing-end.toml",
        fault: "no end time",
        exit_code: 2,
        mentions: &["t_end"],
        line: None,
        cure: Some(("samples = 11", "t_end = 1.0")),
    },
    Malformed {
        file: "missing-equals.toml",
        fault: "an entry without its equals sign",
        exit_code: 3,
        mentions: &["t_end"],
        line: Some(21),
        cure: Some(("t_end 1.0", "t_end = 1.0")),
    },
    Malformed {
        file: "missing-lagrangian.toml",
        fault: "no Lagrangian",
        exit_code: 3,
        mentions: &["lagrangian"],
        line: None,
        cure: Some((
            "[simulation]",
            "[lagrangian]\nkinetic = \"l^2*omega^2/2\"\npotential = \"-g*l*cos(phi)\"\n\n[simulation]",
        )),
    },
    Malformed {
        file: "missing-operator.toml",
        fault: "two factors without the sign of multiplication",
        exit_code: 3,
        mentions: &["g l"],
        line: Some(18),
        cure: Some(("-g l*", "-g*l*")),
    },
    Malformed {
        file: "missing-value.toml",
        fault: "an entry without its value",
        exit_code: 3,
        mentions: &["omega"],
        line: Some(11),
        cure: Some(("omega =", "omega = 0.0")),
    },
    Malformed {
        file: "misspelt-key.toml",
        fault: "a misspelt key",
        exit_code: 3,
        mentions: &["kinetics"],
        line: Some(17),
        cure: Some(("kinetics =", "kinetic =")),
    },
    Malformed {
        file: "misspelt-section.toml",
        fault: "a misspelt section",
        exit_code: 3,
        mentions: &["lagrangan"],
        line: Some(16),
        cure: Some(("[lagrangan]", "[lagrangian]")),
    },
    Malformed {
        file: "name-of-parameter-again.toml",
        fault: "a coordinate with the name of a parameter",
        exit_code: 3,
        mentions: &["phi"],
        line: None,
        cure: Some(("l = 1.0\nphi = 2.0", "l = 1.0")),
    },
    Malformed {
        file: "name-of-velocity-again.toml",
        fault: "an integral with the name of a quasi-velocity",
        exit_code: 3,
        mentions: &["omega"],
        line: Some(21),
        cure: Some(("omega = \"cos(phi)\"", "fall = \"cos(phi)\"")),
    },
    Malformed {
        file: "nan-parameter.toml",
        fault: "a parameter that is not a number",
        exit_code: 3,
        mentions: &["nan"],
        line: Some(5),
        cure: Some(("l = nan", "l = 1.0")),
    },
    Malformed {
        file: "negative-tolerance.toml",
        fault: "a negative tolerance",
        exit_code: 3,
        mentions: &["rtol"],
        line: Some(22),
        cure: Some(("t_end = 1.0\nrtol = -1e-6", "t_end = 1.0")),
    },
    Malformed {
        file: "nonlinear-and-affine.toml",
        fault: "a constraint called nonlinear that is affine",
        exit_code: 3,
        mentions: &["\"nonlinear\""],
        line: Some(12),
        cure: Some((", kind = \"nonlinear\"", "")),
    },
    Malformed {
        file: "nonlinear-constraint.toml",
        fault: "a constraint quadratic in the velocities that is not said to be so",
        exit_code: 3,
        mentions: &["x'^2 + y'^2 - 25"],
        line: Some(12),
        cure: Some(("\"nonholonomic\"", "\"nonlinear\"")),
    },
    Malformed {
        file: "number-for-title.toml",
        fault: "a number where a title must stand",
        exit_code: 3,
        mentions: &["name"],
        line: Some(4),
        cure: Some(("[model]\nname = 3\n\n[parameters]", "[parameters]")),
    },
    Malformed {
        file: "one-sample.toml",
        fault: "one sample, where start and end make two",
        exit_code: 3,
        mentions: &["samples"],
        line: Some(22),
        cure: Some(("t_end = 1.0\nsamples = 1", "t_end = 1.0")),
    },
    Malformed {
        file: "output-of-unknown.toml",
        fault: "an output of a name that does not exist",
        exit_code: 3,
        mentions: &["chi"],
        line: Some(24),
        cure: Some(("height = \"-l*cos(chi)\"", "height = \"-l*cos(phi)\"")),
    },
    Malformed {
        file: "point-with-three-rotations.toml",
        fault: "a point on a sphere with three angular velocities, one of which has no energy",
        exit_code: 4,
        mentions: &["degenerate", "singular"],
        line: None,
        cure: Some(("\"(g1'^2 + g2'^2 + g3'^2)/2\"", "\"(w1^2 + 2*w2^2 + 3*w3^2)/2\"")),
    },
    Malformed {
        file: "pole-at-start.toml",
        fault: "a start at the pole of Euler's angles",
        exit_code: 4,
        mentions: &["theta"],
        line: None,
        cure: Some(("theta = 0.0", "theta = 1.0")),
    },
    Malformed {
        file: "product-kinematics.toml",
        fault: "kinematics with a product of two quasi-velocities",
        exit_code: 3,
        mentions: &["drive*drift"],
        line: Some(12),
        cure: Some(("x = \"drive*drift\"", "x = \"drive\"")),
    },
    Malformed {
        file: "quadratic-definition.toml",
        fault: "a quasi-velocity quadratic in the velocities",
        exit_code: 3,
        mentions: &["x'^2"],
        line: Some(8),
        cure: Some(("\"x'^2 + y'\"", "\"x' + y'\"")),
    },
    Malformed {
        file: "quadratic-kinematics.toml",
        fault: "kinematics quadratic in a quasi-velocity",
        exit_code: 3,
        mentions: &["drive^2"],
        line: Some(12),
        cure: Some(("x = \"drive + drive^2\"", "x = \"drive\"")),
    },
    Malformed {
        file: "rank-deficient-frame.toml",
        fault: "a frame of rank one with two quasi-velocities and brackets that no constants give",
        exit_code: 4,
        mentions: &["algebra"],
        line: None,
        cure: Some(("x = \"drive + x^2*drift\"\ny = \"0\"", "x = \"drive\"\ny = \"drift\"")),
    },
    Malformed {
        file: "reserved-energy.toml",
        fault: "an integral called energy, which is added by itself",
        exit_code: 3,
        mentions: &["energy"],
        line: Some(21),
        cure: Some(("energy = \"cos(phi)\"", "fall = \"cos(phi)\"")),
    },
    Malformed {
        file: "reserved-function.toml",
        fault: "a parameter called sin, which is a function",
        exit_code: 3,
        mentions: &["sin"],
        line: Some(6),
        cure: Some(("l = 1.0\nsin = 2.0", "l = 1.0")),
    },
    Malformed {
        file: "reserved-time.toml",
        fault: "a parameter called t, which is the time",
        exit_code: 3,
        mentions: &["t = "],
        line: Some(6),
        cure: Some(("l = 1.0\nt = 2.0", "l = 1.0")),
    },
    Malformed {
        file: "reset-of-parameter.toml",
        fault: "a reset of a parameter",
        exit_code: 3,
        mentions: &["l ="],
        line: Some(23),
        cure: Some(("{ l = ", "{ omega = ")),
    },
    Malformed {
        file: "root-of-negative.toml",
        fault: "the root of a negative number at the start",
        exit_code: 4,
        mentions: &["sqrt"],
        line: Some(11),
        cure: Some(("\"sqrt(x^2 - 4)\"", "\"sqrt(4 - x^2)\"")),
    },
    Malformed {
        file: "rotated-point.toml",
        fault: "a point moved by rotations, of which those about its own direction do nothing",
        exit_code: 4,
        mentions: &["rank 2 of 3, so ω3' is not determined"],
        line: None,
        cure: Some(("(x'^2 + y'^2 + z'^2)/2", "(x'^2 + y'^2 + z'^2 + ω1^2 + ω2^2 + ω3^2)/2")),
    },
    Malformed {
        file: "self-definition.toml",
        fault: "a definition that needs itself",
        exit_code: 3,
        mentions: &["weight + 1"],
        line: Some(14),
        cure: Some(("weight = \"weight + 1\"", "weight = \"g\"")),
    },
    Malformed {
        file: "start-from-coordinate.toml",
        fault: "a start value that needs another coordinate",
        exit_code: 3,
        mentions: &["2*x"],
        line: Some(5),
        cure: Some(("y = \"2*x\"", "y = 1.0")),
    },
    Malformed {
        file: "start-not-a-number.toml",
        fault: "a start value that is not a number",
        exit_code: 4,
        mentions: &["sqrt(-1)"],
        line: Some(4),
        cure: Some(("x = \"sqrt(-1)\"", "x = 1.0")),
    },
    Malformed {
        file: "start-velocity-of-nothing.toml",
        fault: "the start velocity of a coordinate that does not exist",
        exit_code: 3,
        mentions: &["zeta'"],
        line: Some(7),
        cure: Some(("\"zeta'\" = 0.5", "\"x'\" = 0.5")),
    },
    Malformed {
        file: "stray-character.toml",
        fault: "a character that no expression contains",
        exit_code: 3,
        mentions: &["$phi"],
        line: Some(18),
        cure: Some(("cos($phi)", "cos(phi)")),
    },
    Malformed {
        file: "string-for-parameter.toml",
        fault: "a word where a number must stand",
        exit_code: 3,
        mentions: &["one"],
        line: Some(5),
        cure: Some(("l = \"one\"", "l = 1.0")),
    },
    Malformed {
        file: "table-for-expression.toml",
        fault: "a table where an expression must stand",
        exit_code: 3,
        mentions: &["potential"],
        line: Some(18),
        cure: Some(("potential = { value = \"-g*l*cos(phi)\" }", "potential = \"-g*l*cos(phi)\"")),
    },
    Malformed {
        file: "too-few-arguments.toml",
        fault: "a function with an argument too few",
        exit_code: 3,
        mentions: &["atan2"],
        line: Some(18),
        cure: Some(("atan2(phi)", "cos(phi)")),
    },
    Malformed {
        file: "too-many-arguments.toml",
        fault: "a function with an argument too many",
        exit_code: 3,
        mentions: &["cos(phi, 1)"],
        line: Some(18),
        cure: Some(("cos(phi, 1)", "cos(phi)")),
    },
    Malformed {
        file: "trailing-operator.toml",
        fault: "an operator without its right operand",
        exit_code: 3,
        mentions: &["omega^2/2 +"],
        line: Some(17),
        cure: Some(("omega^2/2 +\"", "omega^2/2\"")),
    },
    Malformed {
        file: "two-lagrangians.toml",
        fault: "a Lagrangian given whole and in parts",
        exit_code: 3,
        mentions: &["lagrangian"],
        line: None,
        cure: Some(("lagrangian = \"l^2*omega^2/2 + g*l*cos(phi)\"", "potential = \"-g*l*cos(phi)\"")),
    },
    Malformed {
        file: "unclosed-header.toml",
        fault: "a section header that never closes",
        exit_code: 3,
        mentions: &["[simulation"],
        line: Some(20),
        cure: Some(("[simulation\n", "[simulation]\n")),
    },
    Malformed {
        file: "unclosed-parenthesis.toml",
        fault: "a parenthesis that never closes",
        exit_code: 3,
        mentions: &["cos(phi"],
        line: Some(18),
        cure: Some(("cos(phi\"", "cos(phi)\"")),
    },
    Malformed {
        file: "unclosed-string.toml",
        fault: "a string that never closes",
        exit_code: 3,
        mentions: &["potential"],
        line: Some(18),
        cure: Some(("cos(phi)", "cos(phi)\"")),
    },
    Malformed {
        file: "unknown-algebra.toml",
        fault: "an algebra that is not in the catalogue",
        exit_code: 3,
        mentions: &["so(3)"],
        line: Some(11),
        cure: Some(("name = \"so(3)\"", "name = \"so3\"")),
    },
    Malformed {
        file: "unknown-form.toml",
        fault: "a form of the equations that does not exist",
        exit_code: 3,
        mentions: &["hamilton"],
        line: Some(22),
        cure: Some(("t_end = 1.0\nform = \"hamilton\"", "t_end = 1.0")),
    },
    Malformed {
        file: "unknown-function.toml",
        fault: "a function that does not exist",
        exit_code: 3,
        mentions: &["cosine"],
        line: Some(18),
        cure: Some(("cosine(phi)", "cos(phi)")),
    },
    Malformed {
        file: "unknown-key-of-velocity.toml",
        fault: "a key that a quasi-velocity does not have",
        exit_code: 3,
        mentions: &["begin"],
        line: Some(9),
        cure: Some(("gap = { is = \"x' - y'\", begin", "gap = { is = \"x' - y'\", start")),
    },
    Malformed {
        file: "unknown-key.toml",
        fault: "a key that does not exist",
        exit_code: 3,
        mentions: &["tolerance"],
        line: Some(22),
        cure: Some(("t_end = 1.0\ntolerance = 1e-6", "t_end = 1.0")),
    },
    Malformed {
        file: "unknown-method.toml",
        fault: "a method that does not exist",
        exit_code: 3,
        mentions: &["rk45"],
        line: Some(22),
        cure: Some(("t_end = 1.0\nmethod = \"rk45\"", "t_end = 1.0")),
    },
    Malformed {
        file: "unknown-name.toml",
        fault: "a name that is declared nowhere",
        exit_code: 3,
        mentions: &["mass"],
        line: Some(17),
        cure: Some(("\"mass*l^2*omega^2/2\"", "\"l^2*omega^2/2\"")),
    },
    Malformed {
        file: "unknown-section.toml",
        fault: "a section that does not exist",
        exit_code: 3,
        mentions: &["constants"],
        line: Some(20),
        cure: Some(("[constants]\nm = 1.0\n\n[simulation]", "[simulation]")),
    },
    Malformed {
        file: "use-before-definition.toml",
        fault: "a definition used before it is made",
        exit_code: 3,
        mentions: &["weight"],
        line: Some(14),
        cure: Some(("scale = \"weight*l\"\nweight = \"g\"", "weight = \"g\"\nscale = \"weight*l\"")),
    },
    Malformed {
        file: "velocity-of-nothing.toml",
        fault: "the velocity of a coordinate that does not exist",
        exit_code: 3,
        mentions: &["zeta'"],
        line: Some(17),
        cure: Some(("\"l^2*omega^2/2 + zeta'^2\"", "\"l^2*omega^2/2\"")),
    },
    Malformed {
        file: "velocity-of-velocity.toml",
        fault: "the velocity of a quasi-velocity",
        exit_code: 3,
        mentions: &["omega'"],
        line: Some(17),
        cure: Some(("\"l^2*omega'^2/2\"", "\"l^2*omega^2/2\"")),
    },
    Malformed {
        file: "whitespace.toml",
        fault: "white space only",
        exit_code: 3,
        mentions: &["lagrangian"],
        line: None,
        cure: None,
    },
];

/// A model nested so deeply that a careless reader overflows its stack; too dull to be stored.
#[derive(Clone, Debug)]
pub struct DeeplyNested {
    /// What is nested.
    pub what: &'static str,
    /// The text of the model.
    pub text: String,
    /// Exit codes that are right: 3 for nesting beyond the bound, and 0 where a reader may do without nesting.
    pub exit_codes: &'static [i32],
}

/// Models nested to a depth of `depth`, such as 10 000.
pub fn deeply_nested(depth: usize) -> Vec<DeeplyNested> {
    let model = |start: &str, potential: &str| {
        format!(
            "[coordinates]\nx = {start}\n\n[quasi_velocities]\n\"x'\" = 1.0\n\n\
             [lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"{potential}\"\n\n\
             [simulation]\nt_end = 1.0\n"
        )
    };
    let around = |open: &str, middle: &str, close: &str| open.repeat(depth) + middle + &close.repeat(depth);
    let nested = |what, text, exit_codes| DeeplyNested { what, text, exit_codes };
    vec![
        nested("parentheses", model("0.5", &around("(", "x", ")")), &[3]),
        nested("open parentheses", model("0.5", &around("(", "x", "")), &[3]),
        nested("functions", model("0.5", &around("sin(", "x", ")")), &[3]),
        nested("powers", model("0.5", &around("x^", "x", "")), &[0, 3]),
        nested("minus signs", model("0.5", &around("-", "x", "")), &[0, 3]),
        nested("arrays", model(&around("[", "0.5", "]"), "x"), &[3]),
        nested("inline tables", model(&around("{ a = ", "0.5", " }"), "x"), &[3]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn table_and_directory_list_the_same_files() {
        let listed: BTreeSet<String> = MALFORMED.iter().map(|model| model.file.to_owned()).collect();
        assert_eq!(listed.len(), MALFORMED.len());
        assert!(MALFORMED.is_sorted_by_key(|model| model.file));
        let stored: BTreeSet<String> = std::fs::read_dir(directory())
            .expect("a directory")
            .map(|entry| entry.expect("an entry").file_name().into_string().expect("a UTF-8 name"))
            .collect();
        assert_eq!(listed, stored);
    }

    /// Where one text must be quoted and one line named, the text stands in that line.
    #[test]
    fn offending_text_stands_in_the_offending_line() {
        for model in MALFORMED {
            assert!(matches!(model.exit_code, 2..=4) && !model.mentions.is_empty(), "{}", model.file);
            let Ok(text) = String::from_utf8(std::fs::read(model.path()).expect(model.file)) else {
                assert_eq!(model.mentions, ["UTF-8"]);
                continue;
            };
            if let (Some(line), [mention]) = (model.line, model.mentions) {
                let line = text.lines().nth(line - 1).expect(model.file);
                assert!(line.contains(mention), "{}: {mention} not in {line}", model.file);
            }
        }
    }

    #[test]
    fn cures_apply_once() {
        for model in MALFORMED {
            let Some((wrong, right)) = model.cure else { continue };
            let text = std::fs::read_to_string(model.path()).expect(model.file);
            assert_eq!(text.matches(wrong).count(), 1, "{}", model.file);
            assert_ne!(wrong, right);
        }
    }

    #[test]
    fn deep_models_are_deep() {
        for model in deeply_nested(1000) {
            assert!(model.text.len() > 1000, "{}", model.what);
        }
        // shallow enough to be right, apart from the types of the last two
        assert!(deeply_nested(1).iter().any(|model| model.text.contains("potential = \"sin(x)\"")));
    }
}
