//! Where results go: files written whole or not at all, and standard output.
//!
//! A file is written beside its final name and then renamed, so nobody reads half of it and a failed run leaves
//! what was there. An existing file is replaced only if asked.

use std::fmt;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use crate::scene_file::printable;

/// An output that could not be written; the message names it and the next step.
#[derive(Debug)]
pub enum OutputError {
    Exists(PathBuf),
    Directory(PathBuf),
    Write(PathBuf, io::Error),
    Stdout(io::Error),
}

impl fmt::Display for OutputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exists(path) => {
                write!(f, "{} exists; pass --force to replace it, or choose another name", shown(path))
            }
            Self::Directory(path) => {
                write!(f, "{} is a directory; name a file in it", shown(path))
            }
            Self::Write(path, e) => {
                write!(f, "cannot write {}: ", shown(path))?;
                match e.kind() {
                    ErrorKind::NotFound => write!(f, "its directory does not exist; make it first"),
                    ErrorKind::NotADirectory => {
                        write!(f, "a part of its path is a file; name a directory there")
                    }
                    ErrorKind::AlreadyExists => write!(f, "a file has this name; choose another"),
                    ErrorKind::PermissionDenied => {
                        write!(f, "it is not permitted; choose another directory, or change its permissions")
                    }
                    ErrorKind::StorageFull => {
                        write!(f, "the disk is full; free some space or choose another disk")
                    }
                    // Without the name of the temporary file, which says nothing to the user.
                    _ => match e.get_ref().and_then(|inner| inner.source()) {
                        Some(cause) => write!(f, "{cause}"),
                        None => write!(f, "{e}"),
                    },
                }
            }
            Self::Stdout(e) => {
                write!(f, "cannot write to standard output: {e}; write to a file with --out FILE")
            }
        }
    }
}

/// A path as it is safe to print.
pub fn shown(path: &Path) -> String {
    printable(&path.to_string_lossy())
}

impl std::error::Error for OutputError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Write(_, e) | Self::Stdout(e) => Some(e),
            Self::Exists(_) | Self::Directory(_) => None,
        }
    }
}

/// Fails if writing `path` would be refused: for asking before a long computation. [`write_all`] asks again.
pub fn check(path: &Path, force: bool) -> Result<(), OutputError> {
    target(path, force).map(drop)
}

/// Writes all files or, where one is refused or a disk is full, none of them.
///
/// With `force` an error between two renames can leave some files replaced and others not; each is still whole.
pub fn write_all<P: AsRef<Path>, C: AsRef<[u8]>>(files: &[(P, C)], force: bool) -> Result<(), OutputError> {
    let mut staged = Vec::with_capacity(files.len());
    for (path, content) in files {
        let path = path.as_ref();
        let target = target(path, force)?;
        let error = |e| OutputError::Write(path.to_owned(), e);
        staged.push((path, stage(target, content.as_ref()).map_err(error)?));
    }
    let mut made = Vec::new();
    for (path, staged) in staged {
        if let Err(e) = staged.commit(path, force) {
            for path in made {
                // Undoing is best effort: the error to report is the one that stopped the run.
                let _ = fs::remove_file(path);
            }
            return Err(e);
        }
        if !force {
            made.push(path.to_owned());
        }
    }
    Ok(())
}

/// Whether two paths name one file, also by way of links and of `./`, and also before it exists.
pub fn same(a: &Path, b: &Path) -> bool {
    identity(a) == identity(b)
}

fn identity(path: &Path) -> PathBuf {
    let beside = |path: &Path| Some(fs::canonicalize(directory_of(path)).ok()?.join(path.file_name()?));
    fs::canonicalize(path).ok().or_else(|| beside(path)).unwrap_or_else(|| path.to_owned())
}

fn directory_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

/// Makes `directory` and its parents where they are missing.
pub fn make_directory(directory: &Path) -> Result<(), OutputError> {
    fs::create_dir_all(directory).map_err(|e| OutputError::Write(directory.to_owned(), e))
}

/// Writes to standard output. A reader that has gone away (`| head`) is no error.
pub fn print(text: &str) -> Result<(), OutputError> {
    stream(&mut io::stdout().lock(), text)
}

/// Says on standard error what went wrong; where that cannot be written either, the exit status has to do.
pub fn complain(message: impl fmt::Display) {
    let _ = writeln!(io::stderr(), "piezobeam: {message}");
}

fn stream(out: &mut impl Write, text: &str) -> Result<(), OutputError> {
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(OutputError::Stdout(e)),
        _ => Ok(()),
    }
}

/// What a path stands for.
enum Target {
    /// A file to create or replace by renaming.
    File(PathBuf),
    /// A pipe or device, which must be written to and never be replaced.
    Device(PathBuf),
}

fn target(path: &Path, force: bool) -> Result<Target, OutputError> {
    let Ok(link) = fs::symlink_metadata(path) else {
        return Ok(Target::File(path.to_owned()));
    };
    match fs::metadata(path) {
        Ok(there) if there.is_dir() => Err(OutputError::Directory(path.to_owned())),
        Ok(there) if !there.is_file() => Ok(Target::Device(path.to_owned())),
        _ if !force => Err(OutputError::Exists(path.to_owned())),
        // Through a link, the file it names is replaced and the link stays; a link to nothing is replaced itself.
        Ok(_) if link.is_symlink() => {
            fs::canonicalize(path).map(Target::File).map_err(|e| OutputError::Write(path.to_owned(), e))
        }
        _ => Ok(Target::File(path.to_owned())),
    }
}

/// Content on its way to a path.
enum Staged<'a> {
    File(NamedTempFile, PathBuf),
    Device(PathBuf, &'a [u8]),
}

fn stage(target: Target, content: &[u8]) -> io::Result<Staged<'_>> {
    let path = match target {
        Target::File(path) => path,
        Target::Device(path) => return Ok(Staged::Device(path, content)),
    };
    let mut builder = Builder::new();
    builder.prefix(".piezobeam-");
    // Temporary files are private by default; a result is as readable as any new file, or as the one it replaces.
    #[cfg(unix)]
    let builder = {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666))
    };
    let mut file = builder.tempfile_in(directory_of(&path))?;
    file.write_all(content)?;
    if let Ok(old) = fs::metadata(&path) {
        file.as_file().set_permissions(old.permissions())?;
    }
    file.as_file().sync_all()?;
    Ok(Staged::File(file, path))
}

impl Staged<'_> {
    fn commit(self, shown: &Path, force: bool) -> Result<(), OutputError> {
        let error = |e| OutputError::Write(shown.to_owned(), e);
        match self {
            Self::Device(path, content) => {
                let mut device = File::options().write(true).open(path).map_err(error)?;
                device.write_all(content).map_err(error)
            }
            Self::File(file, path) if force => file.persist(path).map(drop).map_err(|e| error(e.error)),
            Self::File(file, path) => match file.persist_noclobber(path) {
                Ok(_) => Ok(()),
                Err(e) if e.error.kind() == ErrorKind::AlreadyExists => {
                    Err(OutputError::Exists(shown.to_owned()))
                }
                Err(e) => Err(error(e.error)),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(path: &Path, text: &str, force: bool) -> Result<(), OutputError> {
        write_all(&[(path, text.to_owned())], force)
    }

    #[test]
    fn refuses_then_replaces() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.json");
        write(&path, "one", false).unwrap();
        let message = write(&path, "two", false).unwrap_err().to_string();
        assert!(message.contains("a.json") && message.contains("--force"), "{message}");
        assert!(check(&path, false).is_err() && check(&path, true).is_ok());
        assert_eq!(fs::read_to_string(&path).unwrap(), "one");
        write(&path, "two", true).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "two");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1, "no temporary file is left");
    }

    #[test]
    fn a_file_that_appears_meanwhile_is_kept() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a");
        let staged = stage(Target::File(path.clone()), b"mine").unwrap();
        fs::write(&path, "theirs").unwrap();
        assert!(matches!(staged.commit(&path, false), Err(OutputError::Exists(_))));
        assert_eq!(fs::read_to_string(&path).unwrap(), "theirs");
    }

    #[test]
    fn all_or_none() {
        let dir = tempfile::tempdir().unwrap();
        let (a, b) = (dir.path().join("a"), dir.path().join("b"));
        fs::write(&b, "old").unwrap();
        let files = [(&a, "new".to_owned()), (&b, "new".to_owned())];
        assert!(matches!(write_all(&files, false), Err(OutputError::Exists(p)) if p == b));
        assert!(!a.exists());
        // The same name twice passes the first look and fails at the second rename: the first is undone.
        let twice = [(&a, "1".to_owned()), (&a, "2".to_owned())];
        assert!(write_all(&twice, false).is_err() && !a.exists());
        write_all(&files, true).unwrap();
        assert_eq!(fs::read_to_string(&b).unwrap(), "new");
    }

    #[test]
    fn directories() {
        let dir = tempfile::tempdir().unwrap();
        let message = write(dir.path(), "x", true).unwrap_err().to_string();
        assert!(message.contains("is a directory"), "{message}");
        let deep = dir.path().join("no/such/file");
        let message = write(&deep, "x", false).unwrap_err().to_string();
        assert!(message.contains("directory does not exist"), "{message}");
        make_directory(deep.parent().unwrap()).unwrap();
        write(&deep, "x", false).unwrap();
    }

    #[test]
    fn one_file_has_many_names() {
        let dir = tempfile::tempdir().unwrap();
        let (file, other) = (dir.path().join("a"), dir.path().join("b"));
        let again = dir.path().join("./a");
        assert!(same(&file, &again) && !same(&file, &other), "before it exists");
        fs::write(&file, "").unwrap();
        assert!(same(&file, &again) && !same(&file, &other));
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(&file, &other).unwrap();
            assert!(same(&file, &other));
        }
        assert!(same(Path::new("no/where"), Path::new("no/where")));
    }

    #[cfg(unix)]
    #[test]
    fn links_and_permissions() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let dir = tempfile::tempdir().unwrap();
        let (file, link) = (dir.path().join("file"), dir.path().join("link"));
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        symlink(&file, &link).unwrap();
        assert!(matches!(write(&link, "new", false), Err(OutputError::Exists(p)) if p == link));
        write(&link, "new", true).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&file).unwrap(), "new");
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);

        let dangling = dir.path().join("dangling");
        symlink(dir.path().join("nowhere"), &dangling).unwrap();
        assert!(matches!(write(&dangling, "x", false), Err(OutputError::Exists(_))));

        // As readable as a file made in the ordinary way.
        let (plain, fresh) = (dir.path().join("plain"), dir.path().join("fresh"));
        fs::write(&plain, "").unwrap();
        write(&fresh, "", false).unwrap();
        let mode = |p: &Path| fs::metadata(p).unwrap().permissions().mode();
        assert_eq!(mode(&plain), mode(&fresh));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn devices_are_written_not_replaced() {
        use std::os::unix::fs::FileTypeExt;
        write(Path::new("/dev/null"), "x", false).unwrap();
        assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
        let message = write(Path::new("/dev/full"), "x", true).unwrap_err().to_string();
        assert!(message.contains("the disk is full"), "{message}");
        let mut full = File::options().write(true).open("/dev/full").unwrap();
        let message = stream(&mut full, "x").unwrap_err().to_string();
        assert!(message.contains("standard output") && message.contains("No space"), "{message}");
    }

    #[test]
    fn a_gone_reader_is_no_error() {
        struct Gone;
        impl Write for Gone {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(ErrorKind::BrokenPipe.into())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        stream(&mut Gone, "x").unwrap();
    }
}
