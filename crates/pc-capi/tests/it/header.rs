//! The header is that of the sources, and the library exports what it declares and nothing else.

use crate::generate;
use std::collections::BTreeSet;
use std::ffi::CStr;
use std::path::{Path, PathBuf};
use std::process::Command;

fn committed() -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../include/pc.h")).unwrap()
}

#[test]
fn the_header_is_that_of_the_sources() {
    let (committed, fresh) = (committed(), generate::header());
    let differing = committed.lines().zip(fresh.lines()).find(|(old, new)| old != new);
    assert!(committed == fresh, "include/pc.h is old, write it with `cargo xtask header`: {differing:?}");
}

#[test]
fn lines_of_the_header_end_before_column_100() {
    let header = committed();
    let long: Vec<_> = header.lines().filter(|line| line.chars().count() > 99).collect();
    assert!(long.is_empty(), "{long:#?}");
}

/// Names of functions that the header declares.
fn declared() -> BTreeSet<String> {
    let header = committed();
    let code: String = header.lines().filter(|line| !line.trim_start().starts_with(['*', '/'])).collect();
    let words = code.split(|c: char| !(c.is_alphanumeric() || "_(".contains(c)));
    let names = words.filter_map(|word| word.split_once('(')).map(|(name, _)| name);
    names.filter(|name| name.starts_with("pc_")).map(str::to_owned).collect()
}

/// The shared library that was built with this test.
fn library() -> PathBuf {
    let deps = std::env::current_exe().unwrap().parent().unwrap().to_path_buf();
    [deps.join("libpc.so"), deps.parent().unwrap().join("libpc.so")]
        .into_iter()
        .find(|path| path.exists())
        .unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn the_library_exports_what_the_header_declares_and_nothing_else() {
    let listing = Command::new("nm").args(["-D", "--defined-only"]).arg(library()).output().unwrap();
    assert!(listing.status.success());
    let listing = String::from_utf8(listing.stdout).unwrap();
    let exported: BTreeSet<String> =
        listing.lines().filter_map(|line| line.split_whitespace().nth(2)).map(str::to_owned).collect();
    assert!(exported.len() > 80, "{exported:?}");
    assert_eq!(exported, declared());
}

#[cfg(target_os = "linux")]
#[test]
fn the_library_is_named_for_its_binary_interface() {
    let dynamic = Command::new("objdump").arg("-p").arg(library()).output().unwrap();
    let dynamic = String::from_utf8(dynamic.stdout).unwrap();
    let soname = dynamic.lines().find(|line| line.contains("SONAME")).unwrap();
    assert_eq!(soname.split_whitespace().nth(1), Some(format!("libpc.so.{}", pc::PC_ABI_VERSION).as_str()));
}

#[test]
fn versions_agree() {
    // SAFETY: static text.
    let version = unsafe { CStr::from_ptr(pc::pc_version()) }.to_str().unwrap();
    let numbers = [pc::PC_VERSION_MAJOR, pc::PC_VERSION_MINOR, pc::PC_VERSION_PATCH].map(|n| n.to_string());
    assert_eq!(version, numbers.join("."));
    let [major, minor, patch] = [pc::PC_VERSION_MAJOR, pc::PC_VERSION_MINOR, pc::PC_VERSION_PATCH];
    assert!(minor < 100 && patch < 100, "a larger number overtakes the next one before it");
    assert_eq!(pc::PC_VERSION_NUMBER, 10_000 * major + 100 * minor + patch);
    assert_eq!(pc::pc_version_number(), pc::PC_VERSION_NUMBER);
}
