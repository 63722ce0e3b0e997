//! `cargo xtask gallery`: docs/gallery.md, which shows the models that come with the program, and the pictures on it.
//!
//! The page follows from the texts of the models and the list of their tags, so that it is made, and compared with what is in the
//! tree, without the program. The pictures are stills of the viewer, which take a browser and a while.

use std::fmt::Write;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

use crate::command::{announce_and_run, build_as_for_tests, built_program, workspace_root};
use crate::error::Error;

/// The page, in the workspace.
const PAGE: &str = "docs/gallery.md";

/// The script that takes the pictures.
const SCRIPT: &str = "crates/xtask/gallery/pictures.mjs";

const OPENING: &str = "\
# Gallery

These models come with the program. `pc animate NAME -o NAME.html` makes the page from which a picture is taken: there the model
moves, and can be turned and zoomed. `pc report NAME -o NAME.html` adds equations, analysis and plots, `pc models NAME` prints the
text, to begin a model of your own with, and `pc models --long` lists all models with references.
";

/// A part of the gallery: its heading, and the tags of its models. A model stands in the first part that has one of its tags.
struct Part {
    heading: &'static str,
    tags: &'static [&'static str],
}

const PARTS: &[Part] = &[
    Part { heading: "Tops", tags: &["top"] },
    Part { heading: "Pendulums", tags: &["pendulum"] },
    Part { heading: "Disks, wheels and balls that roll", tags: &["rolling"] },
    Part { heading: "Machines and robots", tags: &["mechanism"] },
    Part { heading: "Satellites and free bodies", tags: &["spacecraft", "free-body"] },
    Part { heading: "Sleighs, and particles with nonholonomic constraints", tags: &["nonholonomic"] },
    Part { heading: "Impacts and friction", tags: &["events"] },
    Part { heading: "Particles", tags: &["particle"] },
];

/// What the gallery says of a model.
struct Model {
    name: String,
    title: String,
    description: String,
}

/// Writes the page; with `--pictures`, takes those of the models named after it, or of all.
///
/// # Errors
/// [`Error::Usage`], that of a file, and that of the first program that fails.
pub(crate) fn run(rest: &[String]) -> Result<(), Error> {
    match rest {
        [] => {}
        [flag, names @ ..] if flag == "--pictures" => take(names)?,
        [other, ..] => {
            return Err(Error::Usage { message: format!("`gallery` does not take `{other}`") });
        }
    }
    let path = workspace_root().join(PAGE);
    fs::write(&path, page()?).map_err(|source| Error::of_file(&path, source))?;
    println!("{}", path.display());
    Ok(())
}

fn take(names: &[String]) -> Result<(), Error> {
    build_as_for_tests(&["--bin", "pc"])?;
    let mut node = Command::new("node");
    announce_and_run(node.arg(SCRIPT).arg(built_program()?).args(names).current_dir(workspace_root()))
}

/// The text of the page.
fn page() -> Result<String, Error> {
    let path = workspace_root().join("crates/pc-model/src/model/tags.rs");
    let tags = tags(&fs::read_to_string(&path).map_err(|source| Error::of_file(&path, source))?);
    let mut page = OPENING.to_owned();
    let mut shown: Vec<&str> = Vec::new();
    for part in PARTS {
        let tagged = tags.iter().filter(|(tag, _)| part.tags.contains(&tag.as_str()));
        let _ = write!(page, "\n## {}\n\n<div class=\"gallery\">\n\n| | |\n|---|---|\n", part.heading);
        for name in tagged.flat_map(|(_, models)| models) {
            if !shown.contains(&name.as_str()) {
                shown.push(name);
                page.push_str(&row(&model(name)?));
            }
        }
        page.push_str("\n</div>\n");
    }
    Ok(page)
}

fn row(Model { name, title, description }: &Model) -> String {
    format!(
        "| ![{title}](pictures/gallery/{name}.webp) | **{title}**<br>{description}.<br>`pc animate {name} -o {name}.html` |\n"
    )
}

/// The tags in the source that lists them, each with its models.
fn tags(source: &str) -> Vec<(String, Vec<String>)> {
    let list = source.split_once("TAGS: &[Tag] = &[").map_or("", |(_, list)| list);
    let list = list.split_once("\n];").map_or(list, |(list, _)| list);
    let quoted = |text: &str| text.split('"').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>();
    let tags = list.split("Tag {").filter_map(|tag| tag.split_once("models: "));
    tags.filter_map(|(head, models)| Some((quoted(head).into_iter().next()?, quoted(models)))).collect()
}

/// What the text of a model says of it at its head.
fn model(name: &str) -> Result<Model, Error> {
    let path = models().join(format!("{name}.toml"));
    let text = fs::read_to_string(&path).map_err(|source| Error::of_file(&path, source))?;
    let head = text.split_once("[model]").map_or("", |(_, head)| head);
    let entry = |key: &str| {
        let line = head.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(" = \""));
        let value = line.and_then(|rest| rest.strip_suffix('"'));
        value.map(in_a_table).ok_or_else(|| Error::Unfit {
            wrong: format!("{}: `[model]` has no `{key}` on a line of its own", path.display()),
        })
    };
    Ok(Model { name: name.to_owned(), title: entry("name")?, description: entry("description")? })
}

/// A text as Markdown shows it in a table.
fn in_a_table(text: &str) -> String {
    let mut shown = String::new();
    for letter in text.chars() {
        if matches!(letter, '|' | '*' | '[' | ']' | '<' | '\\' | '`') {
            shown.push('\\');
        }
        shown.push(letter);
    }
    shown
}

/// Where the texts of the models are.
fn models() -> PathBuf {
    workspace_root().join("crates/pc-model/models")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bytes of one picture, and of all of them.
    const LARGEST: u64 = 12_000;
    const ALL: u64 = 600_000;

    fn files(folder: PathBuf, ending: &str) -> Vec<String> {
        let names =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> =
            names.filter_map(|name| name.strip_suffix(ending).map(str::to_owned)).collect();
        names.sort();
        names
    }

    #[test]
    fn the_gallery_is_the_one_of_these_models() {
        let written = fs::read_to_string(workspace_root().join(PAGE)).unwrap();
        assert!(
            written == page().unwrap(),
            "{PAGE} is not that of the models: `cargo xtask gallery` writes it"
        );
        for name in files(models(), ".toml") {
            let command = format!("`pc animate {name} -o {name}.html`");
            assert_eq!(
                written.matches(&command).count(),
                1,
                "{name} is in no part of the gallery: give it a tag"
            );
        }
    }

    #[test]
    fn each_model_has_a_small_picture() {
        let pictures = workspace_root().join("docs/pictures/gallery");
        let taken = files(pictures.clone(), ".webp");
        assert_eq!(taken, files(models(), ".toml"), "`cargo xtask gallery --pictures NAME` takes a picture");
        let size = |name: &String| fs::metadata(pictures.join(format!("{name}.webp"))).unwrap().len();
        for name in &taken {
            assert!(size(name) <= LARGEST, "{name}: {} bytes", size(name));
        }
        let sum: u64 = taken.iter().map(size).sum();
        assert!(sum <= ALL, "the pictures have {sum} bytes");
    }

    #[test]
    fn tags_are_read_from_their_source() {
        let source = "pub const TAGS: &[Tag] = &[\n    Tag { name: \"top\", meaning: \"fixed point\", models: &[\"a\"] },\n    \
                      Tag {\n        name: \"spring\",\n        meaning: \"soft\",\n        models: &[\n            \"b\",\n            \
                      \"c\",\n        ],\n    },\n];\nfn f() { \"no\" }";
        let read = [
            ("top".to_owned(), vec!["a".to_owned()]),
            ("spring".to_owned(), vec!["b".to_owned(), "c".to_owned()]),
        ];
        assert_eq!(tags(source), read);
    }

    #[test]
    fn marks_of_markdown_are_shown_as_they_are() {
        assert_eq!(in_a_table("[X_1, X_2] = *|"), "\\[X_1, X_2\\] = \\*\\|");
    }
}
