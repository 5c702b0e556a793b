//! The results of the machine that builds, to compare the other targets with.

use std::fmt::{Result, Write};

struct Console;

impl Write for Console {
    fn write_str(&mut self, text: &str) -> Result {
        print!("{text}");
        Ok(())
    }
}

fn main() -> Result {
    piezobeam_embedded::results(&mut Console)
}
