//! Titles and labels with characters that have a meaning in the output formats.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use pc_model::document::is_hidden;

/// A title that would end comments, lines and tags, move the cursor, and reverse the direction of
/// writing.
const TITLE: &str =
    r#"a\n\\input{secret}\r\n%*/ </text><script>&amp;\" ??/\n#error\\\u001b[31m\u009b2J\u202e"#;

/// The title as the reader sees it, without the escapes of TOML.
const PLAIN: &str =
    "a\n\\input{secret}\r\n%*/ </text><script>&amp;\" ??/\n#error\\\u{1b}[31m\u{9b}2J\u{202e}";

/// A label of a constraint that would separate columns, end groups and lead to other directories.
const LABEL: &str = r#"rod,\"=}$\\input{x}%&#^~</text>/../../x"#;

fn model(title: &str, label: &str) -> String {
    format!(
        "[model]\nname = \"{title}\"\n[coordinates]\nx = 1.0\ny = 0.0\n[constraints]\n\"{label}\" = \"x^2 + y^2 - 1\"\n\
         [lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"y\"\n[simulation]\nt_end = 1.0\nsamples = 3\n"
    )
}

fn pc(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).current_dir(directory).output().expect("pc starts")
}

/// The text on standard output and on standard error.
#[track_caller]
fn printed(directory: &Path, arguments: &[&str]) -> (String, String) {
    let output = pc(directory, arguments);
    let [out, said] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("UTF-8"));
    assert!(output.status.success(), "{said}");
    for text in [&out, &said] {
        assert!(!text.contains(|c| is_hidden(c) && c != '\n'), "{text:?}");
    }
    (out, said)
}

fn directory() -> tempfile::TempDir {
    let directory = tempfile::tempdir().expect("a directory");
    fs::write(directory.path().join("m.toml"), model(TITLE, LABEL)).expect("written");
    directory
}

/// The title on one line.
const SHOWN: &str = "a \\input{secret} %*/ </text><script>&amp;\" ??/ #error\\\u{fffd}[31m\u{fffd}2J\u{fffd}";

#[test]
fn a_title_is_printed_on_one_line() {
    let directory = directory();
    for arguments in [&["derive", "m.toml"][..], &["check", "m.toml"], &["run", "m.toml"]] {
        let (out, said) = printed(directory.path(), arguments);
        let first = [out.lines().next(), said.lines().next()];
        assert!(first.iter().flatten().any(|line| line.starts_with(SHOWN)), "{arguments:?}: {first:?}");
    }
    let (_, said) = printed(directory.path(), &["sweep", "m.toml", "--vary", "y'=0:0:1", "-o", "a.csv"]);
    assert!(said.starts_with(SHOWN), "{said}");
    // An error message shows the wrong text.
    let wrong = model(TITLE, LABEL).replace("potential = \"y\"", "potential = \"\u{9b}2J\"");
    fs::write(directory.path().join("wrong.toml"), wrong).expect("written");
    let output = pc(directory.path(), &["check", "wrong.toml"]);
    let said = String::from_utf8(output.stderr).expect("UTF-8");
    assert!(output.status.code() == Some(3) && !said.contains(|c| is_hidden(c) && c != '\n'), "{said:?}");
}

#[test]
fn json_has_the_title_unchanged() {
    let directory = directory();
    for arguments in [["derive", "m.toml", "--format", "json"], ["check", "m.toml", "--format", "json"]] {
        let (out, _) = printed(directory.path(), &arguments);
        let value: serde_json::Value = serde_json::from_str(&out).expect("JSON");
        assert_eq!(value["model"], PLAIN);
    }
    printed(directory.path(), &["run", "m.toml", "-o", "a.json"]);
    let file = fs::read(directory.path().join("a.json")).expect("a file");
    let value: serde_json::Value = serde_json::from_slice(&file).expect("JSON");
    assert_eq!(value["model"], PLAIN);
}

#[test]
fn latex_inputs_nothing() {
    let directory = directory();
    for form in ["poincare", "lagrange", "canonical"] {
        let (page, _) = printed(directory.path(), &["derive", "m.toml", "--format", "latex", "--form", form]);
        let heading = page.lines().next().expect("a line");
        assert!(heading.starts_with(&format!("% {SHOWN}")), "{heading}");
        let live: Vec<&str> = page.lines().filter(|line| !line.starts_with('%')).collect();
        let live = live.join("\n");
        assert!(!live.contains("\\input") && !live.contains("<script>"), "{live}");
        // Each group is closed, and special characters are escaped.
        let (mut depth, mut escaped) = (0i32, false);
        for c in live.chars() {
            match c {
                _ if escaped => escaped = false,
                '\\' => escaped = true,
                '{' => depth += 1,
                '}' => depth -= 1,
                '$' | '%' | '#' | '~' => panic!("{c} in {live}"),
                _ => {}
            }
            assert!(depth >= 0, "{live}");
        }
        assert_eq!(depth, 0, "{live}");
    }
    let (page, _) =
        printed(directory.path(), &["derive", "m.toml", "--format", "latex", "--form", "lagrange"]);
    let label = r#"\lambda_{\mathrm{rod,"=\}\$\backslash{}input\{x\}\%\&\#\wedge{}\sim{}</text>/../../x}}"#;
    assert!(page.contains(label), "{page}");
}

#[test]
fn a_picture_stays_well_formed() {
    let directory = directory();
    printed(directory.path(), &["run", "m.toml", "--plot", "a.svg"]);
    let svg = fs::read_to_string(directory.path().join("a.svg")).expect("a file");
    let title = "a \\input{secret} %*/ &lt;/text&gt;&lt;script&gt;&amp;amp;&quot; ??/ #error\\\u{fffd}[31m\u{fffd}2J\u{fffd}";
    assert!(svg.contains(&format!(">{title}</text>")), "{svg}");
    let mut open = Vec::new();
    for tag in svg.split('<').skip(1) {
        let (tag, text) = tag.split_once('>').expect(tag);
        assert!(!text.contains(|c: char| c.is_control() && c != '\n'), "{text}");
        for entity in text.split('&').skip(1) {
            assert!(
                ["lt;", "gt;", "amp;", "quot;", "#39;"].iter().any(|known| entity.starts_with(known)),
                "{text}"
            );
        }
        match tag.strip_prefix('/') {
            Some(name) => assert_eq!(open.pop(), Some(name)),
            None if tag.ends_with('/') => {}
            None => open.push(tag.split(' ').next().unwrap_or_default()),
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

#[test]
fn a_column_is_one_column() {
    let directory = directory();
    let run = ["run", "m.toml", "--outputs", "reactions"];
    let (csv, _) = printed(directory.path(), &run);
    let mut lines = csv.lines();
    let header = "t,x,y,x',y',energy,\"λ_rod,\"\"=}$\\input{x}%&#^~</text>/../../x\"";
    assert_eq!(lines.next(), Some(header));
    assert!(lines.all(|line| line.split(',').count() == 7), "{csv}");
    printed(directory.path(), &[&run[..], &["-o", "a.npz"]].concat());
    let archive = fs::File::open(directory.path().join("a.npz")).expect("a file");
    let archive = zip::ZipArchive::new(archive).expect("an archive");
    let names: Vec<String> = archive.file_names().map(|name| name.expect("UTF-8").into_owned()).collect();
    assert_eq!(names.len(), 7);
    let entry = "λ_rod,\"=}$%5Cinput{x}%25&#^~</text>%2F..%2F..%2Fx.npy";
    assert!(names.iter().any(|name| name == entry), "{names:?}");
    assert!(names.iter().all(|name| !name.split(['/', '\\']).any(|part| matches!(part, "" | "." | ".."))));
}

#[test]
fn source_has_the_title_in_comments_only() {
    let directory = directory();
    for (language, file) in [("c", "m.c"), ("rust", "m.rs")] {
        printed(directory.path(), &["emit", "m.toml", "--lang", language, "-o", "."]);
        let text = fs::read_to_string(directory.path().join(file)).expect("a file");
        assert!(text.contains("\\input{secret}") && !text.contains(|c| is_hidden(c) && c != '\n'), "{text}");
    }
    let compiled = |program: &str, arguments: &[&str]| {
        let output = Command::new(program).args(arguments).current_dir(directory.path()).output();
        let output = output.expect("a compiler");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    compiled("cc", &["-std=c99", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "m.c"]);
    compiled("rustc", &["--crate-type", "lib", "--emit", "metadata", "m.rs"]);
}

#[test]
fn labels_are_visible_or_refused() {
    let directory = tempfile::tempdir().expect("a directory");
    let refused = |text: &str, message: &str| {
        fs::write(directory.path().join("m.toml"), text).expect("written");
        let output = pc(directory.path(), &["check", "m.toml"]);
        assert_eq!(
            (output.status.code(), String::from_utf8_lossy(&output.stderr).as_ref()),
            (Some(3), message)
        );
    };
    let help = "help: a label stands on one line, in what is printed and in columns: leave out what controls terminals, ends \
                lines or turns the direction of writing";
    let hidden = "contains invisible characters";
    refused(
        &model("", "rod\\n  verified"),
        &format!(
            "pc: m.toml:7:1: [constraints] rod\u{fffd}  verified: the label `rod\\n  verified` {hidden}\n    \
             \"rod\\n  verified\" = \"x^2 + y^2 - 1\"\n    ^^^^^^^^^^^^^^^^^\n  {help}\n"
        ),
    );
    let event =
        "[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\n[events.\"\\u001b[2J\"]\nwhen = \"x\"\n";
    refused(
        event,
        &format!(
            "pc: m.toml:5:9: [events] \u{fffd}[2J: the label `\\u{{1b}}[2J` {hidden}\n    [events.\"\\u001b[2J\"]\n            \
             ^^^^^^^^^^^\n  {help}\n"
        ),
    );
}
