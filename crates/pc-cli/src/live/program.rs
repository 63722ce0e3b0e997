//! Commands as processes of their own, as a user runs them.

use std::io::{self, Cursor, Write};
use std::path::Path;
use std::process::{ExitStatus, Stdio};
use std::{env, fs};

use pc_model::{Document, Source};
use tempfile::TempDir;
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWriteExt};
use tokio::process::{Child, Command};
use tokio::task::spawn;
use tokio::time::timeout;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::live::desk::Desk;
use crate::live::order::{Line, Written};

/// The largest result that is sent to the page.
const LARGEST: u64 = 256 << 20;

/// What came of a command.
pub(super) enum Outcome {
    /// What it printed, or the file that it wrote, with the ending of its name.
    Done(Vec<u8>, &'static str),
    /// The message with which it ended.
    Failed(String),
}

/// Runs a command for a text. Where the future is dropped, the process is killed.
///
/// # Errors
/// [`io::Error`] where there can be no process, or its result cannot be read.
pub(super) async fn run(desk: &Desk, line: &Line, text: &str) -> io::Result<Outcome> {
    let place = TempDir::new()?;
    let stem = desk.original.stem();
    // The result lies beside nothing else, and has the name that the reader will see.
    let results = place.path().join("results");
    fs::create_dir(&results)?;
    let (path, ending) = match line.file {
        None => (None, ""),
        Some(Written::File(extension)) => (Some(results.join(format!("{stem}.{extension}"))), extension),
        Some(Written::Directory) => (Some(results), "zip"),
    };
    let mut command = Command::new(env::current_exe()?);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).kill_on_drop(true);
    command.arg(line.command);
    // Tables are found from the directory of the model, where the text may be another than in the file.
    let input = match desk.original.directory().filter(|_| has_tables(text)) {
        Some(directory) => {
            command.arg("-").current_dir(directory);
            text
        }
        None => {
            let name = format!("{stem}.toml");
            fs::write(place.path().join(&name), text)?;
            command.arg(format!("./{name}")).current_dir(place.path());
            ""
        }
    };
    command.args(&line.options).args(path.iter().flat_map(|path| [Path::new("-o"), path]));
    command
        .arg(format!("--limit-memory={}", desk.memory))
        .arg(format!("--limit-time={}", desk.time.as_secs_f64()));
    // The limits of a command begin with its work, and some of what it does after a motion is not limited.
    let patience = desk.time * 2;
    let Ok(ended) = timeout(patience, communicated(command.spawn()?, input)).await else {
        return Ok(Outcome::Failed(format!("ended after {} s", patience.as_secs())));
    };
    let (status, printed, said) = ended?;
    let result = match (&path, line.file) {
        _ if !status.success() => return Ok(Outcome::Failed(String::from_utf8_lossy(&said).into_owned())),
        (Some(path), Some(Written::Directory)) => archive(path)?,
        (Some(path), _) => fs::read(path)?,
        (None, _) => [printed, said].concat(),
    };
    Ok(Outcome::Done(result, ending))
}

fn has_tables(text: &str) -> bool {
    Document::parse(Source::new("", text)).is_ok_and(|document| !document.files().is_empty())
}

/// Gives a process its input, and takes what it prints and says.
async fn communicated(mut child: Child, text: &str) -> io::Result<(ExitStatus, Vec<u8>, Vec<u8>)> {
    let (input, text) = (child.stdin.take(), text.to_owned());
    spawn(async move {
        if let Some(mut input) = input {
            // Who does not read to the end says why.
            _ = input.write_all(text.as_bytes()).await;
        }
    });
    let said = spawn(read(child.stderr.take()));
    let printed = read(child.stdout.take()).await?;
    let said = said.await.map_err(io::Error::other)??;
    Ok((child.wait().await?, printed, said))
}

async fn read(pipe: Option<impl AsyncRead + Unpin>) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    if let Some(pipe) = pipe {
        pipe.take(LARGEST).read_to_end(&mut bytes).await?;
    }
    Ok(bytes)
}

/// The files of a directory as an archive.
fn archive(directory: &Path) -> io::Result<Vec<u8>> {
    let mut names: Vec<_> =
        fs::read_dir(directory)?.map(|entry| Ok(entry?.file_name())).collect::<io::Result<_>>()?;
    names.sort();
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(DateTime::default());
    for name in names {
        archive.start_file(name.to_string_lossy(), options)?;
        archive.write_all(&fs::read(directory.join(&name))?)?;
    }
    Ok(archive.finish()?.into_inner())
}
