//! A look over the text before it is parsed: no scene nests deeply, and a
//! parser that follows every bracket of a hostile text could run out of stack.

use super::error::FileError;

/// The deepest nesting of brackets, and the longest dotted key.
const DEEPEST: usize = 32;

/// Refuses NUL characters and nesting beyond what any scene needs.
pub(super) fn check(text: &str, name: &str) -> Result<(), FileError> {
    let mut scan = Scan::default();
    let bytes = text.as_bytes();
    let mut at = 0;
    while at < bytes.len() {
        let byte = bytes[at];
        let line = scan.line;
        let step = match byte {
            b'"' | b'\'' => string(&bytes[at..], byte),
            b'#' => until_newline(&bytes[at..]),
            _ => {
                scan.plain(byte);
                1
            }
        };
        let passed = &bytes[at..at + step];
        if let Some(position) = passed.iter().position(|&byte| byte == 0) {
            let error = FileError::new(name, "a NUL character stands here")
                .at_line(Some(line + newlines(&passed[..position])))
                .hint("a scene is plain text, save the file anew");
            return Err(error);
        }
        if scan.depth > DEEPEST || scan.dots > DEEPEST {
            let error = FileError::new(name, format!("nested more than {DEEPEST} deep"))
                .at_line(Some(line))
                .hint("a scene needs no more than four brackets in one another");
            return Err(error);
        }
        scan.line += newlines(passed);
        at += step;
    }
    Ok(())
}

/// What has been seen outside strings and comments.
struct Scan {
    line: usize,
    depth: usize,
    /// Dots since the last character that cannot stand in a dotted key.
    dots: usize,
}

impl Default for Scan {
    fn default() -> Self {
        Self { line: 1, depth: 0, dots: 0 }
    }
}

impl Scan {
    fn plain(&mut self, byte: u8) {
        match byte {
            b'[' | b'{' => self.depth += 1,
            b']' | b'}' => self.depth = self.depth.saturating_sub(1),
            b'.' => {
                self.dots += 1;
                return;
            }
            _ => {}
        }
        if matches!(byte, b'[' | b']' | b'{' | b'}' | b'=' | b',' | b'\n') {
            self.dots = 0;
        }
    }
}

/// The length of the string at the start of `bytes`, or of what there is of it.
fn string(bytes: &[u8], quote: u8) -> usize {
    let multiline = bytes.get(1) == Some(&quote) && bytes.get(2) == Some(&quote);
    let opening = if multiline { 3 } else { 1 };
    let mut at = opening;
    while let Some(&byte) = bytes.get(at) {
        let rest = &bytes[at..];
        if byte == b'\\' && quote == b'"' {
            at += 2;
        } else if byte == quote && (!multiline || rest.starts_with(&[quote; 3])) {
            return at + opening;
        } else if byte == b'\n' && !multiline {
            return at;
        } else {
            at += 1;
        }
    }
    bytes.len()
}

/// The length of the comment at the start of `bytes`.
fn until_newline(bytes: &[u8]) -> usize {
    let end = bytes.iter().position(|&byte| byte == b'\n');
    end.unwrap_or(bytes.len())
}

fn newlines(bytes: &[u8]) -> usize {
    bytes.split(|&byte| byte == b'\n').count() - 1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(text: &str) -> String {
        check(text, "a.toml").expect_err("a refusal").to_string()
    }

    #[test]
    fn deep_nesting_is_refused() {
        const MESSAGE: &str = "a.toml:2: nested more than 32 deep; \
                               a scene needs no more than four brackets in one another";
        assert_eq!(refusal(&format!("\nx = {}", "[".repeat(100_000))), MESSAGE);
        assert_eq!(refusal(&format!("\nx = {}", "{a=".repeat(100_000))), MESSAGE);
        assert_eq!(refusal(&format!("\n{}a = 1", "a.".repeat(100_000))), MESSAGE);
        assert_eq!(refusal(&format!("\n[{}a]", "\"=\" . ".repeat(100_000))), MESSAGE);
    }

    #[test]
    fn brackets_in_strings_and_comments_do_not_count() {
        let many = "[{".repeat(100);
        let text =
            format!("a = \"{many}\\\"{many}\" # {many}\nb = '{many}' \nc = \"\"\"{many}\n{many}\"\"\"\n");
        assert_eq!(check(&text, "a.toml"), Ok(()));
        assert!(check(&format!("{text}d = {many}"), "a.toml").is_err());
    }

    #[test]
    fn long_arrays_are_not_deep() {
        let text = format!("a = [{}]\n", "[1.0, 2.5], ".repeat(10_000));
        assert_eq!(check(&text, "a.toml"), Ok(()));
    }

    #[test]
    fn unfinished_strings_end_with_the_text() {
        for text in ["a = \"", "a = '''\n", "a = \"\\", "\"\"", "'"] {
            assert_eq!(check(text, "a.toml"), Ok(()));
        }
    }

    #[test]
    fn nul_characters_are_refused_with_their_line() {
        assert_eq!(
            refusal("a = 1\n\n\0"),
            "a.toml:3: a NUL character stands here; a scene is plain text, save the file anew"
        );
        assert!(refusal("a = '''\n\n\0'''").starts_with("a.toml:3: a NUL"));
    }
}
