//! The equations in print, and as C source.

use std::ffi::{c_char, c_int};

use ::pc_model::Variables;
use pc_mech::{EmitOptions, Expr, Graph, Language, Style, System};

use crate::entry::entry;
use crate::error::{Fault, pc_error};
use crate::pointer::{clear, handle, text, write};
use crate::status::pc_status;
use crate::strings::give;
use crate::system::{Inventory, pc_system};

/// How equations are printed.
#[repr(C)]
pub enum pc_format {
    /// As a book prints them, in UTF-8.
    PC_TEXT = 0,
    /// Displays of LaTeX with amsmath.
    PC_LATEX = 1,
}

/// Prints the equations, derived anew: kinematics, then M η̇ = r and the energy, or momenta, Hamiltonian and ẏ =
/// …; with multipliers without the reactions. `format` is a pc_format. Free the text with pc_string_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_print(
    system: *const pc_system,
    format: c_int,
    text: *mut *mut c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let print = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(text, "text") }?;
        let style = match format {
            0 => Style::Book,
            1 => Style::Latex,
            value => return Err(Fault::Choice { what: "pc_format", value: value.into() }),
        };
        // SAFETY: as above.
        let parts = parts(&unsafe { handle(system, "system") }?.inventory, style)?;
        let page = if style == Style::Latex { displays(&parts) } else { sections(&parts) };
        // SAFETY: as above.
        unsafe { write(text, give(&page), "text") }
    };
    // SAFETY: `error` is null or a place for a pointer.
    unsafe { entry(error, print) }
}

/// A title, and the sides of equations under it.
type Part = (&'static str, Vec<(String, String)>);

fn parts(inventory: &Inventory, style: Style) -> Result<Vec<Part>, Fault> {
    let (model, graph) = (&inventory.model, Graph::new());
    let assembly = model.assemble(&graph)?;
    let pairs = |left: &[Expr<'_>], right: &[Expr<'_>]| -> Vec<(String, String)> {
        let sides = left.iter().zip(right).map(|(l, r)| (l.display(style), r.display(style)));
        sides.filter(|(left, right)| left != right).collect()
    };
    let rates = |system: &System<'_>| -> Vec<String> {
        let rate = |x: &Expr<'_>| graph.symbol(&format!("{x}'")).display(style);
        system.frame().coordinates().iter().map(rate).collect()
    };
    let kinematics = |system: &System<'_>, velocities: &[Expr<'_>]| -> Vec<(String, String)> {
        let sides = rates(system).into_iter().zip(velocities.iter().map(|v| v.display(style)));
        sides.filter(|(left, right)| left != right).collect()
    };
    Ok(match inventory.variables {
        Variables::QuasiVelocities => {
            let equations = model.equations_in(&assembly, inventory.variables)?;
            vec![
                ("Kinematics", kinematics(equations.system(), equations.velocities())),
                ("Equations", equations.balance(style)),
                ("Energy", vec![("E".to_owned(), equations.energy().display(style))]),
            ]
        }
        Variables::Momenta => {
            let canonical = model.canonical_in(&assembly, inventory.variables)?;
            vec![
                ("Kinematics", kinematics(canonical.system(), canonical.velocities())),
                ("Momenta", pairs(canonical.momenta(), canonical.momenta_of_velocities())),
                ("Hamiltonian", vec![("H".to_owned(), canonical.hamiltonian().display(style))]),
                ("Equations", canonical.balance(style)),
            ]
        }
    })
}

fn sections(parts: &[Part]) -> String {
    let lines = |lines: &[(String, String)]| -> String {
        lines.iter().map(|(left, right)| format!("  {left} = {right}\n")).collect()
    };
    let section = |(title, pairs): &Part| format!("{title}\n{}", lines(pairs));
    let written: Vec<String> = parts.iter().filter(|(_, pairs)| !pairs.is_empty()).map(section).collect();
    written.join("\n")
}

fn displays(parts: &[Part]) -> String {
    let lines = |lines: &[(String, String)]| -> String {
        let lines: Vec<String> = lines.iter().map(|(left, right)| format!("  {left} &= {right}")).collect();
        lines.join(" \\\\\n")
    };
    let display =
        |(title, pairs): &Part| format!("% {title}\n\\begin{{align*}}\n{}\n\\end{{align*}}\n", lines(pairs));
    let written: Vec<String> = parts.iter().filter(|(_, pairs)| !pairs.is_empty()).map(display).collect();
    written.join("\n")
}

/// Writes the equations as C source that depends on nothing of this library: the text of NAME.h and of NAME.c,
/// where NAME is `name`, spelt as an identifier. The source has the right-hand side, its Jacobian, the mass
/// matrix, the energy, the integrals and the outputs of independent quasi-velocities, whatever the form of the
/// system, and says at its head how it is used. If `t_end` is finite, it can be compiled with -DNAME_MAIN (in
/// capitals) to a program that integrates from the start of the model to that time. Free both texts with
/// pc_string_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_emit_c(
    system: *const pc_system,
    name: *const c_char,
    t_end: f64,
    header: *mut *mut c_char,
    source: *mut *mut c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let emit = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(header, "header").and(clear(source, "source")) }?;
        // SAFETY: as above.
        let name = unsafe { text(name, "name") }?;
        // SAFETY: as above.
        let inventory = &unsafe { handle(system, "system") }?.inventory;
        let [written_header, written_source] = emitted(inventory, name, t_end)?;
        // SAFETY: as above; neither is null, so that both texts are handed over.
        unsafe {
            write(header, give(&written_header), "header")?;
            write(source, give(&written_source), "source")
        }
    };
    // SAFETY: `error` is null or a place for a pointer.
    unsafe { entry(error, emit) }
}

fn emitted(inventory: &Inventory, name: &str, t_end: f64) -> Result<[String; 2], Fault> {
    let (model, graph) = (&inventory.model, Graph::new());
    let assembly = model.assemble(&graph)?;
    let equations = assembly.equations().map_err(|error| model.constraint_error(error))?;
    let mut options = EmitOptions::new(Language::C, name);
    if let Some(title) = &model.document().model.name {
        options = options.title(title.value.clone());
    }
    if t_end.is_finite() {
        let state =
            [equations.system().frame().coordinates(), equations.system().quasi_velocities()].concat();
        options = options.start(assembly.t_start, &assembly.start_of(&state), t_end);
    }
    let files = equations.emit(&options).map_err(|error| model.derivation_error(error))?;
    let mut texts = files.into_iter().map(|file| file.text);
    Ok([texts.next().unwrap_or_default(), texts.next().unwrap_or_default()])
}
