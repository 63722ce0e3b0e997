//! The text below the help of each command: examples that can be typed as they are.

pub(super) const CHECK: &str = "\
Examples:
  pc check my-model.toml
  pc check chaplygin-sleigh --set a=0.2
  pc models tilted-disk | pc check - --format json";

pub(super) const DERIVE: &str = "\
Examples:
  pc derive my-model.toml
  pc derive heavy-top-euler --form canonical
  pc derive chaplygin-sleigh --form voronets --format latex
  pc derive charged-particle --form hamel \"u=ρ'\"";

pub(super) const THEORY: &str = "\
Examples:
  pc theory my-model.toml
  pc theory euler-top --degree 4
  pc theory suslov --format json";

pub(super) const RUN: &str = "\
Examples:
  pc run my-model.toml -o motion.csv --plot motion.svg
  pc run heavy-top-euler --t-end 20 --rows 2001 --set mg=0.5 -o top.npz
  pc run chaplygin-sleigh --outputs reactions > sleigh.csv
  pc run stiff-sleigh --method bdf --checkpoint sleigh.check -o sleigh.csv";

pub(super) const SWEEP: &str = "\
Examples:
  pc sweep heavy-top-lagrange --vary mg=0.5:2:100 -o sweep.csv
  pc sweep heavy-top-lagrange --members 1000 --random \"I1=normal(1,0.05)\" --seed 7 -o cloud.npz
  pc sweep whipple-bicycle --of linearize --set roll=0 --vary v0=0:10:101 -o roots.csv
  pc sweep chaplygin-sleigh --of check --vary a=0,0.1,0.5 -o checks.csv";

pub(super) const EMIT: &str = "\
Examples:
  pc emit my-model.toml --lang c -o src
  pc emit heavy-top-euler --lang rust -o - > top.rs
  pc emit tilted-disk --lang c --no-jacobian -o src";

pub(super) const IMPORT: &str = "\
Examples:
  pc import robot.urdf -o robot.toml
  pc import robot.urdf --floating | pc check -
  xacro robot.urdf.xacro | pc import - -o robot.toml
  pc import robot.urdf --fix-massless -o robot.toml";

pub(super) const EXPORT: &str = "\
Examples:
  pc export my-arm.toml -o my-arm.urdf
  pc export my-arm.toml --set damping=0 | pc import - -o undamped.toml";

pub(super) const MODELS: &str = "\
Examples:
  pc models
  pc models --tag nonholonomic --tag rolling
  pc models --tags
  pc models bouncing-ball > ball.toml";

pub(super) const NEW: &str = "\
Examples:
  pc new coordinates -o pendulum.toml
  pc new joints -o arm.toml --schema
  pc new nonholonomic | pc check -

The comments of the text explain the format. A file that is there already is kept as it is.";

pub(super) const SCHEMA: &str = "\
Examples:
  pc schema -o pc-model.schema.json
  pc schema | less

Editors with Taplo, such as Even Better TOML in VS Code, take it for a model whose first line is

  #:schema ./pc-model.schema.json

as `pc new --schema` writes it.";

pub(super) const COMPARE: &str = "\
Examples:
  pc compare heavy-top-euler --form poincare,canonical
  pc compare my-model.toml other-model.toml --columns x,z --tolerance 1e-3
  pc compare heavy-top-quaternion heavy-top-euler --map \"1-2*(q1^2+q2^2)=cos(θ)\"

A difference counts where it is more than 3 times the errors of integration of both motions, which a second, more accurate \
integration of each tells, and more than rounding; D + P·(the largest value of its column) is allowed in addition. Where the errors \
leave less than three digits, as in a chaotic motion, the column is undecided. A difference of the energy counts where --columns \
names it. Columns are compared as numbers: an angle and the same one a turn later, or a quaternion and its negative, differ. \
Both motions are integrated at the same times, each with the tolerances of its file unless these are given here.
Exit codes: 0 nothing differs; 1 something does; 7 undecided; others as for `pc run`.";

pub(super) const BENCH: &str = "\
Examples:
  pc bench heavy-top-euler
  pc bench my-model.toml --seconds 10 --format json

Stages of the derivation: text, the document; system, frame, energies and constraints; equations, of motion in quasi-velocities; \
programs, of the right-hand side, its Jacobian and what is observed; machine code, of the right-hand side with its first \
evaluation. Kernels take turns of about 100 µs; compare times of one table only, and the minimum before the others.";

pub(super) const COMPLETIONS: &str = "\
Examples:
  pc completions bash > ~/.local/share/bash-completion/completions/pc
  pc completions zsh > \"${fpath[1]}/_pc\"
  pc completions fish > ~/.config/fish/completions/pc.fish";

pub(super) const MAN: &str = "\
Examples:
  pc man -o ~/.local/share/man/man1
  pc man run | man -l -";
