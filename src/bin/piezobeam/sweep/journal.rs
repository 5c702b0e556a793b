//! The rows that are there already, beside the table to be: `FILE.partial`.
//!
//! Its first line says which sweep it is of; then come the rows, each with its number, in the order in which they
//! were solved. Lines are added whole and at once, so that a run that is killed leaves at most one torn line, at the
//! end, which the next one takes off.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fmt;
use std::fs::{self, File, TryLockError};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::output::{OutputError, shown};

/// An open journal, locked against a second run.
pub struct Journal {
    path: PathBuf,
    file: File,
    rows: BTreeMap<usize, String>,
}

/// A journal that cannot be used; the message says what to do.
#[derive(Debug)]
pub enum JournalError {
    Busy(PathBuf),
    Other(PathBuf),
    NoFile(PathBuf),
    Write(OutputError),
}

impl fmt::Display for JournalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Busy(path) => {
                write!(f, "{} is in use: another run is writing it; let it finish", shown(path))
            }
            Self::Other(path) => write!(
                f,
                "{} holds rows of another sweep, or of this scene before it was changed; remove it to start \
                 anew, or choose another --out",
                shown(path)
            ),
            Self::NoFile(path) => write!(
                f,
                "{} is no regular file, and solved rows are kept in one; remove it, or choose another --out",
                shown(path)
            ),
            Self::Write(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for JournalError {}

impl Journal {
    /// Opens the journal of the table `out`, which `key` describes, and reads the rows that it has in `range`.
    ///
    /// # Errors
    /// A journal of another table, one in use, or one that cannot be written.
    pub fn open(out: &Path, key: &str, range: Range<usize>) -> Result<Self, JournalError> {
        let mut path: OsString = out.into();
        path.push(".partial");
        let path = PathBuf::from(path);
        let error = |e| JournalError::Write(OutputError::Write(path.clone(), e));
        let mut options = File::options();
        let mut file =
            options.read(true).write(true).create(true).truncate(false).open(&path).map_err(error)?;
        // A device or a pipe may have no end.
        if !file.metadata().map_err(error)?.is_file() {
            return Err(JournalError::NoFile(path));
        }
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => return Err(JournalError::Busy(path)),
            Err(TryLockError::Error(e)) => return Err(error(e)),
            Ok(()) => {}
        }
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(error)?;
        let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |at| at + 1);
        let text = String::from_utf8_lossy(&bytes[..whole]).into_owned();
        let title = title(key);
        let (first, body) = text.split_at(text.find('\n').map_or(0, |at| at + 1));
        let mut rows = BTreeMap::new();
        if !first.is_empty() {
            if first != title {
                return Err(JournalError::Other(path));
            }
            for line in body.split_inclusive('\n') {
                if let Some((number, row)) = line.split_once(',')
                    && let Ok(number) = number.parse::<usize>()
                    && range.contains(&number)
                {
                    rows.insert(number, row.to_owned());
                }
            }
        }
        file.set_len(whole as u64).map_err(error)?;
        file.seek(SeekFrom::End(0)).map_err(error)?;
        if first.is_empty() {
            file.write_all(title.as_bytes()).map_err(error)?;
        }
        Ok(Self { path, file, rows })
    }

    /// The rows that were there when it was opened.
    pub fn rows(&self) -> &BTreeMap<usize, String> {
        &self.rows
    }

    /// Adds a row, a line with its end.
    pub fn add(&mut self, number: usize, row: &str) -> Result<(), JournalError> {
        let line = format!("{number},{row}");
        let error = |e: io::Error| JournalError::Write(OutputError::Write(self.path.clone(), e));
        self.file.write_all(line.as_bytes()).map_err(error)
    }

    /// Removes the file.
    pub fn remove(self) {
        // The table is written; a journal that stays is in nobody's way.
        let _ = fs::remove_file(&self.path);
    }
}

/// The first line: the key itself may be long.
fn title(key: &str) -> String {
    let mut hasher = DefaultHasher::new();
    key.hash(&mut hasher);
    format!("piezobeam sweep {:016x}\n", hasher.finish())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_again_but_for_a_torn_one() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("a.csv");
        let mut journal = Journal::open(&out, "key", 0..4).unwrap();
        assert!(journal.rows().is_empty());
        journal.add(2, "c,3\n").unwrap();
        journal.add(0, "a,1\n").unwrap();
        journal.file.write_all(b"1,b").unwrap();
        drop(journal);
        let mut journal = Journal::open(&out, "key", 0..4).unwrap();
        assert_eq!(
            journal.rows().iter().map(|(i, row)| (*i, row.as_str())).collect::<Vec<_>>(),
            [(0, "a,1\n"), (2, "c,3\n")]
        );
        journal.add(1, "b,2\n").unwrap();
        drop(journal);
        let journal = Journal::open(&out, "key", 0..2).unwrap();
        assert_eq!(journal.rows().len(), 2, "rows outside the range are none");
        journal.remove();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn other_sweeps_and_other_runs_are_kept_apart() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("a.csv");
        let journal = Journal::open(&out, "key", 0..4).unwrap();
        let busy = Journal::open(&out, "key", 0..4).err().unwrap().to_string();
        assert!(busy.contains("a.csv.partial is in use"), "{busy}");
        drop(journal);
        let other = Journal::open(&out, "other", 0..4).err().unwrap().to_string();
        assert!(other.contains("another sweep"), "{other}");
        let nowhere = Journal::open(&folder.path().join("no/a.csv"), "key", 0..4).err().unwrap().to_string();
        assert!(nowhere.contains("cannot write"), "{nowhere}");
    }
}
