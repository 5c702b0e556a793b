//! The program as a test runs it.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses its own part")]

use std::path::Path;
use std::process::{Command, Output};

pub const HALVES: &str = include_str!("../../scenes/halves.toml");

pub fn piezobeam(folder: &Path, line: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_piezobeam"))
        .args(line.split_whitespace())
        .current_dir(folder)
        .output()
        .expect("the program runs")
}

pub fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    write(&folder, "halves.toml", HALVES);
    folder
}

pub fn write(folder: &tempfile::TempDir, name: &str, text: &str) {
    std::fs::write(folder.path().join(name), text).expect("a file");
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The one line that a run with exit status 2 says.
pub fn refusal(folder: &tempfile::TempDir, line: &str) -> String {
    let output = piezobeam(folder.path(), line);
    assert_eq!(output.status.code(), Some(2), "{line}: {}", text(&output.stdout));
    assert!(output.stdout.is_empty(), "{line} printed a result");
    text(&output.stderr).trim_end().to_owned()
}
