//! Printed equations of mechanisms: complete, in lines that fit, with names before their use.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::process::Command;

const FORMS: [&str; 4] = ["poincare", "canonical", "lagrange", "voronets"];

fn mechanism(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/mechanisms").join(format!("{name}.toml"))
}

/// `pc derive`, unless it refuses.
fn derived(model: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new(env!("CARGO_BIN_EXE_pc"))
        .arg("derive")
        .arg(model)
        .args(arguments)
        .output()
        .expect("pc starts");
    output.status.success().then(|| String::from_utf8(output.stdout).expect("UTF-8"))
}

fn mechanisms() -> impl Iterator<Item = PathBuf> {
    ["arm-on-wall", "crank-rocker", "rattleback", "slider-crank", "squeezer", "whipple-bicycle"]
        .into_iter()
        .map(mechanism)
}

/// The lines under a heading, without indentation.
fn section(text: &str, heading: &str) -> String {
    let lines = text.lines().skip_while(|&line| line != heading).skip(1).take_while(|line| !line.is_empty());
    lines.map(|line| format!("{}\n", line.trim())).collect()
}

/// Whether a word is z and a number.
fn is_named(word: &str) -> bool {
    word.strip_prefix('z').is_some_and(|rest| !rest.is_empty() && rest.chars().all(|c| c.is_ascii_digit()))
}

#[test]
fn lines_fit_and_names_stand_before_their_use() {
    for model in mechanisms() {
        for form in FORMS {
            let text = derived(&model, &["--form", form]).expect("a form of its equations");
            let place = format!("{} {form}", model.display());
            assert!(!text.contains('…'), "{place}: something is left out");
            let mut known = HashSet::new();
            for line in text.lines().skip(2) {
                assert!(line.chars().count() <= 100, "{place}: {line}");
                let words: Vec<&str> = line
                    .split(|c: char| !c.is_alphanumeric() && c != '_')
                    .filter(|word| is_named(word))
                    .collect();
                let defines = line
                    .trim_start()
                    .split_once('=')
                    .map(|(left, _)| left.trim())
                    .filter(|left| is_named(left));
                let used = if defines.is_some() { &words[1..] } else { &words[..] };
                for name in used {
                    assert!(known.contains(*name), "{place}: {name} is not known in {line}");
                }
                if let Some(name) = defines {
                    assert!(known.insert(name.to_owned()), "{place}: {name} is said twice");
                }
            }
        }
    }
}

#[test]
fn lines_have_the_requested_width() {
    let text = derived(&mechanism("squeezer"), &["--width", "72"]).expect("equations");
    let widest = text.lines().skip(2).map(|line| line.chars().count()).max();
    assert!(widest <= Some(72), "{widest:?}");
}

/// The rates of a four-bar linkage by the law of sines [any book on mechanisms], from two loop equations.
#[test]
fn the_rates_of_a_four_bar_linkage() {
    let text = derived(&mechanism("crank-rocker"), &[]).expect("equations");
    assert_eq!(
        section(&text, "Kinematics"),
        "α' = -c rocker sin(β - γ)/(a sin(α - β))\n\
         β' = c rocker sin(α - γ)/(l sin(α - β))\n\
         γ' = rocker\n"
    );
}

/// The rates of the joints of an arm, by the same law, from the velocity of its tool along a wall
/// and the rotation of its last link.
#[test]
fn the_rates_of_an_arm_with_its_tool_on_a_wall() {
    let text = derived(&mechanism("arm-on-wall"), &[]).expect("equations");
    let kinematics = section(&text, "Kinematics");
    for rate in ["q1' = ", "q2' = ", "q3' = "] {
        let line = kinematics.lines().find(|line| line.starts_with(rate)).expect("a rate");
        assert!(line.contains("sin(q2)") && !line.contains("cos"), "{kinematics}");
    }
}

#[test]
fn brief_equations_are_one_line_each() {
    let bicycle = mechanism("whipple-bicycle");
    let (brief, whole) = (derived(&bicycle, &["--brief"]), derived(&bicycle, &[]));
    let (brief, whole) = (brief.expect("equations"), whole.expect("equations"));
    assert!(brief.lines().count() * 10 < whole.lines().count());
    assert!(section(&brief, "Energy").ends_with("…\n"), "{brief}");
}

#[test]
fn definitions_keep_their_names_unless_written_out() {
    let top = Path::new("heavy-top-euler");
    let named = derived(top, &[]).expect("equations");
    assert!(named.contains("γ3 = cos(θ)") && named.contains("r2 mg γ3"), "{named}");
    let inline = derived(top, &["--inline"]).expect("equations");
    assert!(!inline.contains("γ3") && inline.contains("r2 mg cos(θ)"), "{inline}");
}

/// Tested where LaTeX is installed.
#[test]
fn latex_takes_all_pages() {
    if Command::new("pdflatex").arg("--version").output().is_err() {
        eprintln!("pdflatex is not installed: nothing is set");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let mut page =
        "\\documentclass{article}\n\\usepackage[a4paper,margin=2cm]{geometry}\n\\usepackage{amsmath}\n\
                    \\allowdisplaybreaks\n\\begin{document}\n"
            .to_owned();
    let models = pc_model::BUILTIN.iter().map(|model| PathBuf::from(model.name)).chain(mechanisms());
    for model in models {
        for form in FORMS {
            page += &derived(&model, &["--form", form, "--format", "latex"]).unwrap_or_default();
        }
    }
    page += "\\end{document}\n";
    std::fs::write(folder.path().join("all.tex"), page).expect("a file");
    let output = Command::new("pdflatex")
        .args(["-interaction=nonstopmode", "-halt-on-error", "all.tex"])
        .current_dir(folder.path())
        .output()
        .expect("pdflatex starts");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{}", said.lines().rev().take(30).collect::<Vec<_>>().join("\n"));
}
