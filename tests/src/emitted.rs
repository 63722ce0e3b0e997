//! A workbench for emitted source: both languages, a driver that calls the routines, and numbers in and out.
//!
//! A driver serves any number of models. For each in turn it reads a count (64 bits) and so many inputs t, y,
//! p from its standard input, and writes what the routines make of them, all as the bytes of numbers.

use std::fmt::Write as _;
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use pc_mech::{EmitOptions, EmittedFile, Equations, Language, MechError};

/// A function of the source.
#[derive(Clone, Copy, Debug)]
pub struct Routine {
    /// Its name in Rust, and in C after that of the model.
    pub name: &'static str,
    /// The numbers that it writes; `None` for one that it returns.
    pub outputs: Option<usize>,
}

/// A model as source in both languages.
#[derive(Clone, Debug)]
pub struct Emitted {
    /// Its name as an identifier.
    pub name: String,
    /// The files, without directory.
    pub files: Vec<EmittedFile>,
    /// What a driver calls.
    pub routines: Vec<Routine>,
}

impl Emitted {
    /// The source of `equations`, with routines to call.
    ///
    /// # Errors
    /// [`MechError`] of the emission.
    pub fn new(
        equations: &Equations<'_>,
        options: impl Fn(Language) -> EmitOptions,
        routines: Vec<Routine>,
    ) -> Result<Emitted, MechError> {
        let mut files = equations.emit(&options(Language::C))?;
        files.extend(equations.emit(&options(Language::Rust))?);
        let name = files[0].name.trim_end_matches(".h").to_owned();
        Ok(Emitted { name, files, routines })
    }

    /// The file whose name ends so.
    pub fn file(&self, suffix: &str) -> Option<&EmittedFile> {
        self.files.iter().find(|file| file.name.ends_with(suffix))
    }

    /// How many numbers the routines write or return.
    pub fn outputs(&self) -> usize {
        self.routines.iter().map(|routine| routine.outputs.unwrap_or(1)).sum()
    }

    fn c_function(&self) -> String {
        let (name, capitals) = (&self.name, self.name.to_uppercase());
        let mut calls = String::new();
        let mut place = 0;
        for routine in &self.routines {
            let call = format!("{name}_{}(in[0], in + 1, in + 1 + {capitals}_DIM", routine.name);
            let _ = match routine.outputs {
                Some(_) => writeln!(calls, "        {call}, out + {place});"),
                None => writeln!(calls, "        out[{place}] = {call});"),
            };
            place += routine.outputs.unwrap_or(1);
        }
        format!(
            "
static void run_{name}(void)
{{
    static double in[1 + {capitals}_DIM + {capitals}_PARAMETERS], out[{place}];
    uint64_t count;
    for (get(&count, sizeof count); count > 0; count--) {{
        get(in, sizeof in);
{calls}        put(out, sizeof out);
    }}
}}
"
        )
    }

    fn rust_function(&self) -> String {
        let name = &self.name;
        let mut calls = String::new();
        for routine in &self.routines {
            let call = format!("{name}::{}(t, &y, &p", routine.name);
            let _ = match routine.outputs {
                Some(count) => writeln!(
                    calls,
                    "        let mut values = [f64::NAN; {count}];
        {call}, &mut values);
        put(out, &values);"
                ),
                None => writeln!(calls, "        put(out, &[{call})]);"),
            };
        }
        format!(
            "
fn run_{name}(input: &mut impl Read, out: &mut impl Write) {{
    for _ in 0..u64::from_ne_bytes(word(input)) {{
        let mut get = || f64::from_ne_bytes(word(input));
        let t = get();
        let y: [f64; {name}::DIM] = std::array::from_fn(|_| get());
        let p: [f64; {name}::PARAMETERS] = std::array::from_fn(|_| get());
{calls}    }}
}}
"
        )
    }
}

fn c_driver(models: &[Emitted]) -> String {
    let mut text = String::from("#include <stdint.h>\n#include <stdio.h>\n#include <stdlib.h>\n");
    for model in models {
        // Twice, as headers are.
        let _ = writeln!(text, "#include \"{0}.h\"\n#include \"{0}.h\"", model.name);
    }
    text += "
static void get(void *bytes, size_t size)
{
    if (fread(bytes, size, 1, stdin) != 1)
        exit(1);
}

static void put(const void *bytes, size_t size)
{
    if (fwrite(bytes, size, 1, stdout) != 1)
        exit(1);
}
";
    text.extend(models.iter().map(Emitted::c_function));
    text += "\nint main(void)\n{\n";
    text.extend(models.iter().map(|model| format!("    run_{}();\n", model.name)));
    text + "    return 0;\n}\n"
}

fn rust_driver(models: &[Emitted]) -> String {
    let mut text = String::from("use std::io::{Read, Write};\n");
    text.extend(models.iter().map(|model| format!("mod {};\n", model.name)));
    text += "
fn word(input: &mut impl Read) -> [u8; 8] {
    let mut bytes = [0; 8];
    input.read_exact(&mut bytes).unwrap();
    bytes
}

fn put(out: &mut impl Write, values: &[f64]) {
    for value in values {
        out.write_all(&value.to_ne_bytes()).unwrap();
    }
}
";
    text.extend(models.iter().map(Emitted::rust_function));
    text += "\nfn main() {\n    let input = &mut std::io::stdin().lock();\n";
    text += "    let out = &mut std::io::BufWriter::new(std::io::stdout().lock());\n";
    text.extend(models.iter().map(|model| format!("    run_{}(input, out);\n", model.name)));
    text + "}\n"
}

/// Writes the files of models into a directory.
///
/// # Panics
/// If they cannot be written.
pub fn write_files(directory: &Path, models: &[Emitted]) {
    for file in models.iter().flat_map(|model| &model.files) {
        write(&directory.join(&file.name), &file.text);
    }
}

fn write(path: &Path, text: &str) {
    fs::write(path, text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}

/// A fresh directory, whatever was there before.
///
/// # Panics
/// If it cannot be made.
pub fn fresh_directory(path: PathBuf) -> PathBuf {
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    path
}

/// Far more than a compiler or a driver takes on the slowest machine: what takes longer hangs.
const PATIENCE: Duration = Duration::from_secs(600);

/// How a process ends that is given `input`; one that hangs is killed.
fn ended(mut child: Child, input: &[u8]) -> io::Result<Output> {
    let (stdin, id) = (child.stdin.take(), child.id().to_string());
    let (end, ends) = mpsc::channel::<()>();
    thread::scope(|scope| {
        scope.spawn(|| stdin.map(|mut stdin| stdin.write_all(input)));
        scope.spawn(move || {
            if ends.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                let _ = Command::new("kill").args(["-KILL", &id]).status();
            }
        });
        let output = child.wait_with_output();
        drop(end);
        output
    })
}

/// Runs a command with `input`, and answers what it prints.
///
/// # Panics
/// If it fails or hangs, or says anything on standard error: a compiler must not even warn.
pub fn execute(command: &mut Command, input: &[u8]) -> Vec<u8> {
    let child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap_or_else(|error| panic!("{command:?} does not run: {error}"));
    let output = ended(child, input).unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?} fails, {}:\n{message}", output.status);
    assert!(message.is_empty(), "{command:?} says:\n{message}");
    output.stdout
}

/// The rustc that cargo uses.
pub fn rustc() -> Command {
    Command::new(std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned()))
}

/// The program of models and their driver in C, compiled in `directory`.
///
/// # Panics
/// If the compiler does not take it in silence.
pub fn compile_c(directory: &Path, compiler: &str, flags: &[&str], models: &[Emitted]) -> PathBuf {
    write_files(directory, models);
    write(&directory.join("driver.c"), &c_driver(models));
    let mut command = Command::new(compiler);
    command.current_dir(directory).args(flags).args(["-o", "driver", "driver.c"]);
    command.args(models.iter().map(|model| format!("{}.c", model.name))).arg("-lm");
    execute(&mut command, &[]);
    directory.join("driver")
}

/// The program of models and their driver in Rust, compiled in `directory`.
///
/// # Panics
/// If the compiler does not take it in silence.
pub fn compile_rust(directory: &Path, flags: &[&str], models: &[Emitted]) -> PathBuf {
    write_files(directory, models);
    write(&directory.join("driver.rs"), &rust_driver(models));
    let mut command = rustc();
    command.current_dir(directory).args(["--edition=2021", "-O", "-Dwarnings"]).args(flags).arg("driver.rs");
    execute(&mut command, &[]);
    directory.join("driver")
}

/// What the routines of each model make of its inputs (t, y, p): for each input their outputs, one after the
/// other.
///
/// # Panics
/// If the program fails or writes too little or too much.
pub fn run<'a>(
    program: &Path,
    models: impl IntoIterator<Item = (&'a Emitted, &'a [Vec<f64>])> + Clone,
) -> Vec<Vec<Vec<f64>>> {
    let mut input = Vec::new();
    for (_, inputs) in models.clone() {
        input.extend((inputs.len() as u64).to_ne_bytes());
        input.extend(inputs.iter().flatten().flat_map(|value| value.to_ne_bytes()));
    }
    let output = execute(&mut Command::new(program), &input);
    let numbers: usize =
        models.clone().into_iter().map(|(model, inputs)| inputs.len() * model.outputs()).sum();
    assert_eq!(output.len(), 8 * numbers, "bytes written by {}", program.display());
    let (words, _) = output.as_chunks::<8>();
    let mut numbers = words.iter().copied().map(f64::from_ne_bytes);
    let mut of = |model: &Emitted, inputs: &[Vec<f64>]| -> Vec<Vec<f64>> {
        inputs.iter().map(|_| numbers.by_ref().take(model.outputs()).collect()).collect()
    };
    models.into_iter().map(|(model, inputs)| of(model, inputs)).collect()
}
