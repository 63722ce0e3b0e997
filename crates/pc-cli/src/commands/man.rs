//! `pc man`: the help of the command line as manual pages.

use std::fs;
use std::io::{self, Write};

use clap::{Command, CommandFactory};
use clap_mangen::Man;
use pc_expr::parse::nearest;

use crate::args::command_line::Arguments;
use crate::args::tools::ManArguments;
use crate::error::CliError;
use crate::output::standard_output::{self, print};
use crate::terminal::text::say;
use pc_run::files::error::FileError;
use pc_run::files::target::{Target, file};

/// Prints a page, or writes all of them into a directory.
///
/// # Errors
/// [`CliError::NoSuchCommand`]; `FileError::Write`.
pub fn command(arguments: &ManArguments) -> Result<(), CliError> {
    let pages = pages().map_err(standard_output::error)?;
    let Some(directory) = file(arguments.output.as_deref()) else {
        let wanted = arguments.command.as_ref().map_or("pc".to_owned(), |name| format!("pc-{name}"));
        let found = pages.iter().find(|(name, _)| *name == wanted);
        let Some((_, page)) = found else { return Err(no_such_command(&wanted, &pages)) };
        return print(|out| out.write_all(page));
    };
    fs::create_dir_all(directory).map_err(|source| FileError::cannot_write(directory, source))?;
    for (name, page) in &pages {
        let path = directory.join(format!("{name}.1"));
        let place = Target::regular(&path).map_err(|source| FileError::cannot_write(&path, source))?;
        place.write(|out| out.write_all(page)).map_err(|source| FileError::cannot_write(&path, source))?;
        say(format_args!("{}\n", path.display()));
    }
    Ok(())
}

/// The pages by their names: the program, then each command.
fn pages() -> io::Result<Vec<(String, Vec<u8>)>> {
    let mut program = Arguments::command().disable_help_subcommand(true);
    program.build();
    let commands: Vec<Command> = program.get_subcommands().cloned().collect();
    std::iter::once(program).chain(commands).map(page).collect()
}

fn page(command: Command) -> io::Result<(String, Vec<u8>)> {
    let name = command.get_display_name().unwrap_or(command.get_name()).to_owned();
    let more = command.get_after_help().map_or_else(String::new, ToString::to_string);
    let has_commands = command.has_subcommands();
    let mut page = Vec::new();
    let man = Man::new(command).source(concat!("pc ", env!("CARGO_PKG_VERSION")));
    man.render_title(&mut page)?;
    man.render_name_section(&mut page)?;
    man.render_synopsis_section(&mut page)?;
    man.render_description_section(&mut page)?;
    man.render_options_section(&mut page)?;
    if has_commands {
        man.render_subcommands_section(&mut page)?;
    }
    page.extend_from_slice(sections(&more).as_bytes());
    Ok((name, page))
}

/// The text below the help: examples as they are typed in, then notes, a paragraph per line.
fn sections(more: &str) -> String {
    let (examples, notes) = match more.strip_prefix("Examples:\n") {
        Some(rest) => rest.split_once("\n\n").unwrap_or((rest, "")),
        None => ("", more),
    };
    let mut text = String::new();
    if !examples.is_empty() {
        text += &format!(".SH EXAMPLES\n{}", verbatim(examples.lines()));
    }
    if !notes.is_empty() {
        text += ".SH NOTES\n";
    }
    for line in notes.lines().filter(|line| !line.is_empty()) {
        text += ".PP\n";
        text += &if line.starts_with(' ') { verbatim([line]) } else { escaped(line) };
    }
    text
}

/// Lines that are neither filled nor moved.
fn verbatim<'l>(lines: impl IntoIterator<Item = &'l str>) -> String {
    format!(".nf\n{}.fi\n", lines.into_iter().map(|line| escaped(line.trim())).collect::<String>())
}

/// A line of text, escaped so that no formatter takes it for a request.
fn escaped(line: &str) -> String {
    format!("\\&{}\n", line.replace('\\', "\\e").replace('-', "\\-").replace('\'', "\\(aq"))
}

fn no_such_command(wanted: &str, pages: &[(String, Vec<u8>)]) -> CliError {
    let known: Vec<String> =
        pages.iter().filter_map(|(name, _)| name.strip_prefix("pc-")).map(str::to_owned).collect();
    let name = wanted.strip_prefix("pc-").unwrap_or(wanted).to_owned();
    let nearest = nearest(&name, known.iter().map(String::as_str)).map(str::to_owned);
    CliError::NoSuchCommand { name, nearest, known }
}
