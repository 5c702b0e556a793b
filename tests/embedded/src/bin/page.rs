//! The results of a WebAssembly module; its host gives `print`.
#![no_std]
#![no_main]

use core::fmt::{Result, Write};
use core::panic::PanicInfo;

#[link(wasm_import_module = "host")]
unsafe extern "C" {
    fn print(text: *const u8, bytes: usize);
}

struct Console;

impl Write for Console {
    fn write_str(&mut self, text: &str) -> Result {
        // SAFETY: the host only reads the text.
        unsafe { print(text.as_ptr(), text.len()) };
        Ok(())
    }
}

/// Prints all; 0 where that went well.
#[unsafe(no_mangle)]
pub extern "C" fn run() -> i32 {
    i32::from(piezobeam_embedded::results(&mut Console).is_err())
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    core::arch::wasm32::unreachable()
}
