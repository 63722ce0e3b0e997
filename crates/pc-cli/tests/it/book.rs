//! The book in `docs` and the README: models are sound, commands succeed and print what is shown,
//! links have targets.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag, TagEnd};
use snapbox::IntoData;

use crate::live::Live;
use crate::patience::{ended, started};

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The pages, by their file names.
fn pages() -> Vec<String> {
    let files = fs::read_dir(docs()).expect("the book").map(|entry| entry.expect("an entry").file_name());
    let mut pages: Vec<String> = files.map(|name| name.to_string_lossy().into_owned()).collect();
    pages.retain(|name| name.ends_with(".md") && name != "SUMMARY.md");
    pages.sort();
    pages
}

/// The fenced blocks of a page: the words after the fence, and the text.
fn blocks(text: &str) -> Vec<(String, String)> {
    let (mut blocks, mut open): (Vec<(String, String)>, bool) = (Vec::new(), false);
    for event in Parser::new_ext(text, Options::ENABLE_TABLES) {
        match event {
            Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(words))) => {
                blocks.push((words.to_string(), String::new()));
                open = true;
            }
            Event::Text(piece) if open => {
                if let Some((_, text)) = blocks.last_mut() {
                    text.push_str(&piece);
                }
            }
            Event::End(TagEnd::CodeBlock) => open = false,
            _ => {}
        }
    }
    blocks
}

/// Where a page's examples are tried, with `pc` on the path.
struct Desk {
    directory: tempfile::TempDir,
    path: String,
}

impl Desk {
    fn new() -> Desk {
        let program = Path::new(env!("CARGO_BIN_EXE_pc")).parent().expect("a directory");
        let path = format!("{}:{}", program.display(), std::env::var("PATH").expect("a path"));
        Desk { directory: tempfile::tempdir().expect("a directory"), path }
    }

    /// The output of a command, both streams together as on a terminal, and whether it succeeds.
    fn run(&self, command: &str) -> (String, bool) {
        let mut shell = Command::new("sh");
        let shell = shell.args(["-c", &format!("exec 2>&1; {command}")]).current_dir(&self.directory);
        shell.env("PATH", &self.path).env_remove("NO_COLOR");
        let output = ended(started(shell.stdin(Stdio::null()).stdout(Stdio::piped())));
        (String::from_utf8(output.stdout).expect("UTF-8"), output.status.success())
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.directory.path().join(name), text).expect("written");
    }
}

/// The commands of a block with the lines that each prints.
fn commands(block: &str) -> Vec<(String, String)> {
    let mut commands: Vec<(String, String)> = Vec::new();
    for line in block.lines() {
        match (line.strip_prefix("$ "), commands.last_mut()) {
            (Some(command), _) => commands.push((command.to_owned(), String::new())),
            (None, Some((_, said))) => *said += &format!("{line}\n"),
            (None, None) => panic!("a block of commands begins with `{line}`"),
        }
    }
    commands
}

/// Tries the examples of a page. In the output shown, `...` stands for any lines and `[..]` for any
/// part of a line.
fn try_examples(page: &str) -> usize {
    let desk = Desk::new();
    let mut tried = 0;
    for (words, text) in blocks(&read(&docs().join(page))) {
        if words.starts_with("toml") {
            desk.write("model.toml", &text);
        }
        if words == "toml" {
            let (said, sound) = desk.run("pc check model.toml");
            assert!(sound, "{page}: {text}{said}");
            tried += 1;
        } else if let Some(name) = words.strip_prefix("csv ") {
            desk.write(name, &text);
        } else if words == "console" {
            for (command, expected) in commands(&text) {
                println!("{page}: {command}");
                let (said, _) = desk.run(&command);
                snapbox::assert_data_eq!(
                    said.trim_end().to_owned(),
                    expected.trim_end().to_owned().into_data()
                );
                tried += 1;
            }
        }
    }
    tried
}

#[test]
fn models_are_sound_and_commands_print_what_is_shown() {
    let tried = std::thread::scope(|scope| {
        let pages = pages().into_iter().map(|page| scope.spawn(move || try_examples(&page)));
        let pages: Vec<_> = pages.collect();
        pages.into_iter().map(|page| page.join().expect("the page is right")).sum::<usize>()
    });
    assert!(tried > 60, "only {tried} examples were tried");
}

/// The lines of shell blocks that begin with the program, without comments after them.
fn shell_commands(text: &str) -> Vec<String> {
    let shell = blocks(text).into_iter().filter(|(words, _)| words == "sh");
    let lines: Vec<String> =
        shell.flat_map(|(_, text)| text.lines().map(str::to_owned).collect::<Vec<_>>()).collect();
    let commands = lines.iter().filter(|line| line.starts_with("pc "));
    commands.map(|line| line.split(" #").next().unwrap_or_default().trim_end().to_owned()).collect()
}

/// Longer output must go to a file.
const LONGEST: usize = 150;

#[test]
fn commands_that_are_named_succeed() {
    let root = docs().join("..");
    let readme = read(&root.join("README.md"));
    let desk = Desk::new();
    let model = blocks(&readme).into_iter().find(|(words, _)| words == "toml").expect("a model").1;
    desk.write("top.toml", &model);
    desk.write("robot.urdf", &read(&root.join("tests/robots/arm.urdf")));
    let mut tried = 0;
    for page in ["README.md", "crates/pc-cli/README.md", "docs/running.md"] {
        for command in shell_commands(&read(&root.join(page))) {
            println!("{page}: {command}");
            if Live::named(desk.directory.path(), &command).is_some() {
                continue;
            }
            let (said, succeeds) = desk.run(&command);
            assert!(succeeds, "{page}: {command}\n{said}");
            assert!(said.lines().count() < LONGEST, "{page}: {command}: {} lines", said.lines().count());
            tried += 1;
        }
    }
    assert!(tried > 14, "only {tried} commands were tried");
    let (page, equations) = (desk.run("pc derive top.toml").0, "I3 ω3' = 0");
    let shown = blocks(&readme).into_iter().find(|(words, text)| words == "text" && text.contains(equations));
    let shown = shown.expect("the equations of the model").1;
    assert!(page.contains(shown.trim_end()), "{page}");
}

/// The name by which a link finds a heading: letters and digits in lower case, hyphens for spaces.
fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect::<String>().to_lowercase()
}

/// The anchors of a page and the places to which its links lead.
fn anchors_and_links(text: &str) -> (BTreeSet<String>, Vec<String>) {
    let (mut anchors, mut links, mut heading) = (BTreeSet::new(), Vec::new(), None::<String>);
    for event in Parser::new_ext(text, Options::ENABLE_TABLES) {
        match event {
            Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
            Event::End(TagEnd::Heading(_)) => anchors.extend(heading.take().map(|text| anchor(&text))),
            Event::Text(piece) | Event::Code(piece) => {
                if let Some(heading) = &mut heading {
                    heading.push_str(&piece);
                }
            }
            Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                links.push(dest_url.to_string());
            }
            _ => {}
        }
    }
    (anchors, links)
}

#[test]
fn links_lead_somewhere() {
    let root = docs().join("..");
    let mut files: Vec<PathBuf> = pages().iter().map(|page| docs().join(page)).collect();
    files.extend(
        [
            "docs/SUMMARY.md",
            "README.md",
            "CONTRIBUTING.md",
            "crates/pc-cli/README.md",
            "crates/pc-python/README.md",
            "examples-c/README.md",
        ]
        .map(|file| root.join(file)),
    );
    let (mut lost, mut count) = (Vec::new(), 0);
    for file in files {
        for link in anchors_and_links(&read(&file)).1 {
            if link.contains("://") {
                continue;
            }
            count += 1;
            let (path, place) =
                link.split_once('#').map_or((link.as_str(), None), |(path, at)| (path, Some(at)));
            let target = if path.is_empty() { file.clone() } else { file.with_file_name(path) };
            let found = match place {
                _ if !target.exists() => false,
                Some(place) => anchors_and_links(&read(&target)).0.contains(place),
                None => true,
            };
            if !found {
                lost.push(format!("{}: {link}", file.display()));
            }
        }
    }
    assert!(lost.is_empty(), "{lost:#?}");
    assert!(count > 60, "only {count} links");
}

#[test]
fn each_page_is_in_the_summary_once() {
    let mut listed = anchors_and_links(&read(&docs().join("SUMMARY.md"))).1;
    listed.sort();
    assert_eq!(listed, pages());
}
