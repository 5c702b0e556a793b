//! Opening a scene file without ever blocking or reading without bound.

use std::fs::{self, File, FileType};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

use super::SceneFile;
use super::error::FileError;

/// The largest scene file, in bytes.
const LARGEST: u64 = 1 << 20;

/// Reads the scene file at `path`.
///
/// # Errors
///
/// When the path is not a regular file of at most 1 MiB of UTF-8 text, or when
/// the text is not a scene.
pub fn read(path: &Path) -> Result<SceneFile, FileError> {
    let name = path.to_string_lossy();
    from_bytes(&bytes(path, &name)?, &name)
}

/// The name which messages use, and the text.
pub(super) fn load(path: &Path) -> Result<(String, String), FileError> {
    let name = path.to_string_lossy();
    let bytes = bytes(path, &name)?;
    let text = text(&bytes, &name)?.to_owned();
    Ok((name.into_owned(), text))
}

/// Reads the scene in the `bytes` of a file which messages call `name`.
///
/// # Errors
///
/// When they are not UTF-8 text, or when the text is not a scene.
pub fn from_bytes(bytes: &[u8], name: &str) -> Result<SceneFile, FileError> {
    super::parse(text(bytes, name)?, name)
}

/// The content of a regular file of bounded size.
fn bytes(path: &Path, name: &str) -> Result<Vec<u8>, FileError> {
    let failed = |error: io::Error| unreadable(&error, name);
    // Opening a FIFO waits for a writer, so the kind is looked at first; the
    // opened file is looked at again because the path may have changed hands.
    let before = fs::metadata(path).map_err(failed)?;
    regular(before.file_type(), name)?;
    bounded(before.len(), name)?;
    let file = File::open(path).map_err(failed)?;
    regular(file.metadata().map_err(failed)?.file_type(), name)?;
    let mut bytes = Vec::new();
    file.take(LARGEST + 1).read_to_end(&mut bytes).map_err(failed)?;
    bounded(bytes.len() as u64, name)?;
    Ok(bytes)
}

/// Refuses everything but regular files.
fn regular(kind: FileType, name: &str) -> Result<(), FileError> {
    if kind.is_file() {
        return Ok(());
    }
    let found = if kind.is_dir() { "a directory" } else { "a device, a pipe or a socket" };
    Err(FileError::new(name, format!("expected a scene file, found {found}"))
        .hint("give the path of a regular TOML file"))
}

/// Refuses files beyond the limit.
fn bounded(size: u64, name: &str) -> Result<(), FileError> {
    if size <= LARGEST {
        return Ok(());
    }
    Err(FileError::new(name, "larger than 1 MiB, which no scene needs to be")
        .hint("check that this is the file you meant"))
}

/// The complaint of the operating system.
fn unreadable(error: &io::Error, name: &str) -> FileError {
    match error.kind() {
        ErrorKind::NotFound => {
            FileError::new(name, "there is no such file").hint("check the path of the scene file")
        }
        ErrorKind::PermissionDenied => {
            FileError::new(name, "reading the file is not permitted").hint("check its permissions")
        }
        _ => FileError::new(name, format!("cannot read the file: {error}")),
    }
}

/// The bytes as text.
fn text<'a>(bytes: &'a [u8], name: &str) -> Result<&'a str, FileError> {
    let error = match std::str::from_utf8(bytes) {
        Ok(text) => return Ok(text),
        Err(error) => error,
    };
    let wide = matches!(bytes, [0xff, 0xfe, ..] | [0xfe, 0xff, ..]);
    let found = if wide { "the text is UTF-16, not UTF-8" } else { "the text is not UTF-8" };
    let before = &bytes[..error.valid_up_to()];
    let line = before.split(|&byte| byte == b'\n').count();
    Err(FileError::new(name, found).at_line(Some(line)).hint("save the file as UTF-8"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    /// A directory of its own for one test, removed at the end.
    struct Scratch(PathBuf);

    impl Scratch {
        fn new(test: &str) -> Self {
            let unique = format!("piezobeam-{}-{test}", std::process::id());
            let path = std::env::temp_dir().join(unique);
            fs::create_dir_all(&path).expect("a scratch directory");
            Self(path)
        }

        fn file(&self, name: &str, content: &[u8]) -> PathBuf {
            let path = self.0.join(name);
            fs::write(&path, content).expect("a scratch file");
            path
        }
    }

    impl Drop for Scratch {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    /// The message of a refused path, without the path.
    fn refusal(path: &Path) -> String {
        let text = read(path).expect_err("a refusal").to_string();
        let shown = path.to_string_lossy();
        text.strip_prefix(&*shown).expect("the message starts with the path").to_owned()
    }

    #[test]
    fn a_scene_is_read() {
        let scratch = Scratch::new("good");
        let path = scratch.file("good.toml", b"length = 1\n[beam]\nbending = 2.0\n");
        let scene = read(&path).expect("a scene");
        assert_eq!(scene.name, path.to_string_lossy());
        assert_eq!(scene.length.to_bits(), 1.0_f64.to_bits());
    }

    #[test]
    fn missing_files_and_directories() {
        let scratch = Scratch::new("missing");
        assert_eq!(
            refusal(&scratch.0.join("none.toml")),
            ": there is no such file; check the path of the scene file"
        );
        assert_eq!(
            refusal(&scratch.0),
            ": expected a scene file, found a directory; give the path of a regular TOML file"
        );
    }

    #[test]
    fn sizes_are_bounded() {
        let scratch = Scratch::new("large");
        let path = scratch.file("large.toml", &vec![b'#'; 2 << 20]);
        assert_eq!(
            refusal(&path),
            ": larger than 1 MiB, which no scene needs to be; \
             check that this is the file you meant"
        );
        let mut most = b"length = 1\nbeam.bending = 1\n#".to_vec();
        most.resize(1 << 20, b'#');
        assert!(read(&scratch.file("most.toml", &most)).is_ok());
    }

    #[test]
    fn bytes_which_are_not_text() {
        let scratch = Scratch::new("bytes");
        let path = scratch.file("latin.toml", b"length = 1\n# Tr\xe4ger\n");
        assert_eq!(refusal(&path), ":2: the text is not UTF-8; save the file as UTF-8");
        let path = scratch.file("wide.toml", b"\xff\xfel\0e\0n\0");
        assert_eq!(refusal(&path), ":1: the text is UTF-16, not UTF-8; save the file as UTF-8");
        let path = scratch.file("nul.toml", b"length = 1\n\0\n");
        assert_eq!(
            refusal(&path),
            ":2: a NUL character stands here; a scene is plain text, save the file anew"
        );
        let path = scratch.file("empty.toml", b"");
        assert_eq!(
            refusal(&path),
            ": the file is empty; a scene has at least length and [beam] with bending"
        );
    }

    #[cfg(unix)]
    #[test]
    fn devices_and_pipes_do_not_block() {
        const MESSAGE: &str = ": expected a scene file, found a device, a pipe or a socket; \
                               give the path of a regular TOML file";
        assert_eq!(refusal(Path::new("/dev/zero")), MESSAGE);
        assert_eq!(refusal(Path::new("/dev/null")), MESSAGE);
        let scratch = Scratch::new("pipe");
        let path = scratch.0.join("pipe.toml");
        let made = std::process::Command::new("mkfifo").arg(&path).status();
        if made.is_ok_and(|status| status.success()) {
            assert_eq!(refusal(&path), MESSAGE);
        }
    }

    #[cfg(unix)]
    #[test]
    fn names_which_are_not_text() {
        use std::ffi::OsStr;
        use std::os::unix::ffi::OsStrExt;
        let path = Path::new(OsStr::from_bytes(b"/nowhere/\xff\x1b[1m"));
        assert_eq!(
            read(path).expect_err("a refusal").to_string(),
            "/nowhere/\u{fffd}\\u{1b}[1m: there is no such file; \
             check the path of the scene file"
        );
    }
}
