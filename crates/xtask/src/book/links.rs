//! Links of built pages: to pages, to headings of them, and to files of the repository, which are put beside the pages.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Component, Path, PathBuf};

use crate::error::Error;

/// Looks up every link of the pages in `book/pages`, and returns their number. What they name outside is copied from the same
/// place below `root` into the book.
///
/// # Errors
/// [`Error::Links`] with those that lead nowhere.
pub(crate) fn settle(root: &Path, book: &Path, pages: &str) -> Result<usize, Error> {
    let mut texts = BTreeMap::new();
    for path in files(&book.join(pages))? {
        // What a server shows in place of a page counts from its own root.
        let is_substitute = path.file_name().is_some_and(|name| name == "404.html");
        if !is_substitute && path.extension().is_some_and(|ending| ending == "html") {
            let text = fs::read_to_string(&path).map_err(|source| file(&path, source))?;
            let below = path.strip_prefix(book).unwrap_or(&path).to_path_buf();
            texts.insert(below, text);
        }
    }
    let anchors: BTreeMap<&PathBuf, BTreeSet<String>> =
        texts.iter().map(|(page, text)| (page, attributes(text, " id=\"").collect())).collect();
    let (mut lost, mut count) = (Vec::new(), 0);
    for (page, text) in &texts {
        for link in attributes(text, " href=\"").chain(attributes(text, " src=\"")) {
            if link.contains("://") || link.starts_with("data:") || link.starts_with("mailto:") {
                continue;
            }
            count += 1;
            let (path, heading) = link.split_once('#').unwrap_or((&link, ""));
            let target = match path {
                "" => Some(page.clone()),
                path => within(&page.with_file_name(""), path),
            };
            let found = match &target {
                None => false,
                Some(target) => match anchors.get(target) {
                    Some(anchors) => heading.is_empty() || anchors.contains(heading),
                    None => book.join(target).exists() || brought(root, book, target)?,
                },
            };
            if !found {
                lost.push(format!("{}: {link}", page.display()));
            }
        }
    }
    if lost.is_empty() { Ok(count) } else { Err(Error::Links { lost }) }
}

/// The values of an attribute, as they are meant.
fn attributes<'t>(text: &'t str, name: &'t str) -> impl Iterator<Item = String> + 't {
    text.split(name).skip(1).filter_map(|rest| rest.split('"').next()).map(|value| {
        let value =
            value.replace("&#x27;", "'").replace("&quot;", "\"").replace("&lt;", "<").replace("&gt;", ">");
        unescaped(&value.replace("&amp;", "&"))
    })
}

/// A link with bytes in place of %XX.
fn unescaped(link: &str) -> String {
    let (mut bytes, mut rest) = (Vec::with_capacity(link.len()), link.as_bytes());
    while let Some((&first, after)) = rest.split_first() {
        let digits = after.get(..2).and_then(|digits| std::str::from_utf8(digits).ok());
        let byte = digits.and_then(|digits| u8::from_str_radix(digits, 16).ok());
        match byte {
            Some(byte) if first == b'%' => {
                bytes.push(byte);
                rest = &after[2..];
            }
            _ => {
                bytes.push(first);
                rest = after;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The place of a link without `..`; none where it leaves the book.
fn within(directory: &Path, link: &str) -> Option<PathBuf> {
    let mut place = PathBuf::new();
    for component in directory.join(link).components() {
        match component {
            Component::Normal(name) => place.push(name),
            Component::CurDir => {}
            Component::ParentDir if place.pop() => {}
            Component::ParentDir | Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    Some(place)
}

/// Whether there is such a file or folder in the repository, which then is in the book too.
fn brought(root: &Path, book: &Path, place: &Path) -> Result<bool, Error> {
    let (from, to) = (root.join(place), book.join(place));
    if from.is_dir() {
        for path in files(&from)? {
            if let Some(name) = path.file_name().filter(|_| path.is_file()) {
                copy(&path, &to.join(name))?;
            }
        }
    } else if from.is_file() {
        copy(&from, &to)?;
    } else {
        return Ok(false);
    }
    Ok(true)
}

fn copy(from: &Path, to: &Path) -> Result<(), Error> {
    if let Some(folder) = to.parent() {
        fs::create_dir_all(folder).map_err(|source| file(folder, source))?;
    }
    fs::copy(from, to).map(drop).map_err(|source| file(from, source))
}

fn files(directory: &Path) -> Result<Vec<PathBuf>, Error> {
    let entries = fs::read_dir(directory).map_err(|source| file(directory, source))?;
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    Ok(paths)
}

fn file(path: &Path, source: std::io::Error) -> Error {
    Error::File { path: path.display().to_string(), source }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_that_lead_nowhere_are_named_and_files_are_brought() {
        let directory = tempfile::tempdir().unwrap();
        let (root, book) = (directory.path().join("root"), directory.path().join("book"));
        let write = |path: PathBuf, text: &str| {
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        write(root.join("include/pc.h"), "int;");
        write(root.join("secret"), "");
        write(
            book.join("docs/a.html"),
            "<h1 id=\"θ\">θ</h1><a href=\"#%CE%B8\"></a><a href=\"b.html#it&#x27;s\"></a><a href=\"../include\"></a>\
             <img src=\"data:,\"><a href=\"https://x\"></a>",
        );
        write(book.join("docs/b.html"), "<h1 id=\"it's\"></h1><a href=\"../include/pc.h\"></a>");
        assert_eq!(settle(&root, &book, "docs").unwrap(), 4);
        assert_eq!(fs::read_to_string(book.join("include/pc.h")).unwrap(), "int;");

        write(
            book.join("docs/c.html"),
            "<a href=\"a.html#φ\"></a><a href=\"d.html\"></a><a href=\"../../elsewhere/secret\"></a><img src=\"x.svg\">",
        );
        let error = settle(&root, &book, "docs").unwrap_err().to_string();
        let names = ["a.html#φ", "d.html", "../../elsewhere/secret", "x.svg"];
        assert!(names.iter().all(|name| error.contains(&format!("c.html: {name}"))), "{error}");
        assert_eq!(error.lines().count(), 1 + names.len());
    }
}
