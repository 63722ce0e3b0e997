//! `bench solve`: whole integrations, by us and by C that calls the same CVODES with right-hand sides by hand.

use std::env;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Instant;

use pc_mech::{Graph, Motion};
use pc_model::{Builtin, Model};
use pc_solve::{Method, Options, Statistics, solve};

use crate::error::Error;
use crate::measure::Times;
use crate::report::{Report, target_directory, triple};
use crate::systems::pendulum;

/// Least number of integrations of each variant, and how long they are repeated.
const ROUNDS: usize = 15;
const SECONDS: f64 = 2.0;
/// By how much the start, relative to itself, is another one from round to round: how many steps are taken is a matter of
/// rounding within some percent, which evens out over many starts.
const SPREAD: f64 = 1e-6;
const TOLERANCES: [f64; 3] = [1e-6, 1e-8, 1e-10];

/// Makes a motion and the state it starts from.
type Start = fn() -> Result<(Motion, Vec<f64>), Error>;

/// One integration.
struct Problem {
    /// What the C program calls it.
    name: &'static str,
    about: &'static str,
    method: Method,
    end: f64,
    motion: Start,
    /// By how much errors grow from start to end: ends may differ by this times the tolerance.
    growth: f64,
}

const PROBLEMS: [Problem; 4] = [
    Problem {
        name: "top",
        about: "heavy top, 100 time units, Adams",
        method: Method::Adams,
        end: 100.0,
        motion: || builtin("heavy-top-lagrange"),
        growth: 1e5,
    },
    Problem {
        name: "disk",
        about: "tilted disk, 100 time units, Adams",
        method: Method::Adams,
        end: 100.0,
        motion: || builtin("tilted-disk"),
        growth: 1e6,
    },
    Problem {
        name: "pendulum",
        about: "pendulum of 16 links, 10 time units, Adams",
        method: Method::Adams,
        end: 10.0,
        motion: || {
            let graph = Graph::new();
            let motion = pendulum(&graph, 16)?.poincare()?.compile()?;
            Ok((motion, [vec![0.2; 16], vec![0.0; 16]].concat()))
        },
        growth: 1e6,
    },
    Problem {
        name: "sleigh",
        about: "stiff sleigh, 5 time units, BDF",
        method: Method::Bdf,
        end: 5.0,
        motion: || builtin("stiff-sleigh"),
        growth: 1e5,
    },
];

fn builtin(name: &'static str) -> Result<(Motion, Vec<f64>), Error> {
    let mut document = Builtin::named(name).ok_or(Error::NoModel { name })?.document()?;
    document.simulation.project.clear();
    let model = Model::new(document);
    let graph = Graph::new();
    let assembly = model.assemble(&graph)?;
    Ok(model.compile(&assembly)?)
}

/// Times all problems at all tolerances; the last line is the worst ratio.
///
/// # Errors
/// [`Error::Apart`] if the two variants of a problem do not end at the same state.
pub(crate) fn run(report: &mut Report) -> Result<(), Error> {
    let directory =
        tempfile::tempdir().map_err(|source| Error::Start { command: "tempdir".into(), source })?;
    let program = compiled(directory.path())?;
    report.line(format!(
        "ms from the creation of the solver to its destruction: minimum, 10th percentile and median of at least \
         {ROUNDS} integrations of each variant in turns. `C` calls the same library, compiled as ours is, with \
         right-hand side and Jacobian by hand, `cc -O3 -march=native`. `/ C` is the median of the ratios of \
         neighbours, which have the same start, another one each round; steps are those of the last. The absolute tolerance is a thousandth of the relative one.\n"
    ));
    report.columns(&["problem", "rtol", "variant", "steps", "evaluations", "ms", "/ C"]);
    let mut worst: f64 = 0.0;
    for problem in &PROBLEMS {
        let (mut motion, start) = (problem.motion)()?;
        for rtol in TOLERANCES {
            let options = Options::new(problem.method)
                .relative_tolerance(rtol)
                .absolute_tolerance(rtol * 1e-3)
                .max_steps(10_000_000);
            let ours = |motion: &mut Motion, scale: f64| -> Result<Answer, Error> {
                let start: Vec<f64> = start.iter().map(|y| scale * y).collect();
                let begun = Instant::now();
                let found = solve(motion, 0.0, &start, &[problem.end], &options)?;
                let milliseconds = begun.elapsed().as_secs_f64() * 1e3;
                let Statistics { steps, rhs_evaluations: evaluations, .. } = *found.statistics();
                Ok(Answer { milliseconds, steps, evaluations, end: found.state(0).to_vec() })
            };
            let mut plain = Plain::start(&program, problem.name, rtol)?;
            let (mut ours_took, mut plain_took) = (Times::default(), Times::default());
            let begun = Instant::now();
            let (mut a, mut b) = (ours(&mut motion, 1.0)?, plain.integrate(1.0)?); // to warm up
            while ours_took.0.len() < ROUNDS || begun.elapsed().as_secs_f64() < SECONDS {
                let scale = 1.0 + SPREAD * ours_took.0.len() as f64;
                (a, b) = (ours(&mut motion, scale)?, plain.integrate(scale)?);
                check(problem, rtol, &a, &b)?;
                ours_took.0.push(a.milliseconds);
                plain_took.0.push(b.milliseconds);
            }
            let ratio = ours_took.ratio_to(&plain_took);
            worst = worst.max(ratio);
            for (name, answer, times, ratio) in [("C", &b, &plain_took, 1.0), ("ours", &a, &ours_took, ratio)]
            {
                report.row(&[
                    problem.about.to_owned(),
                    format!("{rtol:e}"),
                    name.to_owned(),
                    answer.steps.to_string(),
                    answer.evaluations.to_string(),
                    triple(times, 3),
                    format!("{ratio:.2}"),
                ]);
            }
        }
    }
    report.line(format!("\nworst time ratio to C CVODE: {worst:.2}"));
    Ok(())
}

/// What came of one integration.
pub(crate) struct Answer {
    milliseconds: f64,
    pub(crate) steps: u64,
    evaluations: u64,
    end: Vec<f64>,
}

fn check(problem: &Problem, rtol: f64, a: &Answer, b: &Answer) -> Result<(), Error> {
    let pairs = a.end.iter().zip(&b.end);
    let distance = pairs.map(|(a, b)| (a - b).abs() / (1.0 + b.abs())).fold(0.0, f64::max);
    let allowed = problem.growth * rtol;
    if a.end.len() == b.end.len() && distance <= allowed {
        Ok(())
    } else {
        Err(Error::Apart { system: problem.name, rtol, distance })
    }
}

/// The C program, waiting for its turn.
pub(crate) struct Plain {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    command: String,
}

impl Plain {
    pub(crate) fn start(program: &Path, system: &str, rtol: f64) -> Result<Plain, Error> {
        let arguments = [system.to_owned(), format!("{rtol:e}"), format!("{:e}", rtol * 1e-3)];
        let command = format!("plain_cvode {}", arguments.join(" "));
        let failed = |source| Error::Start { command: command.clone(), source };
        let mut child = Command::new(program)
            .args(&arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(failed)?;
        let pipes = child.stdin.take().zip(child.stdout.take());
        let (input, output) = pipes.ok_or_else(|| failed(std::io::ErrorKind::BrokenPipe.into()))?;
        Ok(Plain { child, input, output: BufReader::new(output), command })
    }

    pub(crate) fn integrate(&mut self, scale: f64) -> Result<Answer, Error> {
        let mut answer = String::new();
        self.input
            .write_all(format!("{scale:e}\n").as_bytes())
            .and_then(|()| self.output.read_line(&mut answer))
            .map_err(|source| Error::Start { command: self.command.clone(), source })?;
        read(&answer).ok_or_else(|| Error::Answer { command: self.command.clone(), answer })
    }
}

impl Drop for Plain {
    fn drop(&mut self) {
        // It ends with its input; if it has ended before, there is nothing to do.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn read(answer: &str) -> Option<Answer> {
    let mut words = answer.split_whitespace();
    Some(Answer {
        milliseconds: words.next()?.parse::<f64>().ok()? / 1e6,
        steps: words.next()?.parse().ok()?,
        evaluations: words.next()?.parse().ok()?,
        end: words.map(|word| word.parse().ok()).collect::<Option<_>>()?,
    })
}

/// The C program, compiled against the library that is linked to us.
pub(crate) fn compiled(directory: &Path) -> Result<PathBuf, Error> {
    let sundials = sundials()?;
    let program = directory.join(format!("plain_cvode{}", env::consts::EXE_SUFFIX));
    let mut command = Command::new(env::var_os("CC").unwrap_or_else(|| "cc".into()));
    command
        .args(["-std=c99", "-O3", "-march=native", "-I"])
        .arg(sundials.join("include"))
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("bench-c/plain_cvode.c"))
        .arg("-o")
        .arg(&program)
        .arg("-L")
        .arg(sundials.join("lib"))
        .args(["-lsundials_cvodes", "-lsundials_nvecserial", "-lsundials_core", "-lm"]);
    let name = "cc plain_cvode.c".to_owned();
    let output = command.output().map_err(|source| Error::Start { command: name.clone(), source })?;
    if output.status.success() {
        return Ok(program);
    }
    Err(Error::Failed { command: name, message: String::from_utf8_lossy(&output.stderr).into_owned() })
}

/// Where the build script of `sundials-sys` has put library and headers.
fn sundials() -> Result<PathBuf, Error> {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command
        .args(["build", "--release", "--quiet", "-p", "pc-tests", "--bin", "bench"]) // as we were built
        .args(["--message-format=json", "--target-dir"])
        .arg(target_directory())
        .current_dir(env!("CARGO_MANIFEST_DIR"));
    let name = "cargo build --bin bench".to_owned();
    let output = command.output().map_err(|source| Error::Start { command: name, source })?;
    let directory = |line: &str| {
        let message: serde_json::Value = serde_json::from_str(line).ok()?;
        let built = message["reason"] == "build-script-executed";
        let ours = message["package_id"].as_str()?.contains("sundials-sys");
        (built && ours).then(|| message["out_dir"].as_str().map(PathBuf::from))?
    };
    String::from_utf8_lossy(&output.stdout).lines().find_map(directory).ok_or(Error::NoSundials)
}
