//! The results of a board in an emulator, by semihosting, and what they cost.
#![no_std]
#![no_main]

use core::arch::global_asm;
use core::fmt::{Result, Write};
use core::ptr::{addr_of, read_volatile, write_volatile};
use piezobeam_embedded::{cost, results};
use semihosting::process::exit;

// A Cortex-M starts with the stack pointer and the address in the table. Its floating-point unit is off, and has
// to be on before the first compiled function. A fault ends the emulation (SYS_EXIT, run-time error).
#[cfg(target_arch = "arm")]
global_asm!(
    ".section .start, \"a\"",
    ".word stack_top, reset, fault, fault",
    ".section .text.reset, \"ax\"",
    ".global reset",
    ".thumb_func",
    "reset:",
    "ldr r0, =0xe000ed88",
    "ldr r1, =0x00f00000",
    "str r1, [r0]",
    "dsb",
    "isb",
    "bl run",
    ".thumb_func",
    "fault:",
    "movs r0, 0x18",
    "ldr r1, =0x20023",
    "bkpt 0xab",
);

#[cfg(target_arch = "riscv32")]
global_asm!(".section .start, \"ax\"", ".global reset", "reset:", "la sp, stack_top", "call run",);

// Floating point is trapped until CPACR_EL1 says otherwise.
#[cfg(target_arch = "aarch64")]
global_asm!(
    ".section .start, \"ax\"",
    ".global reset",
    "reset:",
    "mov x0, 0x300000",
    "msr cpacr_el1, x0",
    "isb",
    "ldr x0, =stack_top",
    "mov sp, x0",
    "bl run",
);

unsafe extern "C" {
    static stack_end: u32;
}

/// What the unused stack is filled with.
const PAINT: u32 = 0x5ca1_ab1e;
/// What is left of the stack for the painter itself, in bytes.
const MARGIN: usize = 128;

struct Console;

impl Write for Console {
    fn write_str(&mut self, text: &str) -> Result {
        semihosting::print!("{text}");
        Ok(())
    }
}

#[unsafe(no_mangle)]
extern "C" fn run() -> ! {
    let ok = results(&mut Console).is_ok() && cost::table(&mut Console, measure).is_ok();
    exit(i32::from(!ok))
}

/// Counts the instructions of `work` and the stack below this function.
#[inline(never)]
fn measure(work: &mut dyn FnMut()) -> cost::Cost {
    let here = 0_u32;
    let top = addr_of!(here) as usize;
    // SAFETY: between the linker's `stack_end` and a margin below this frame there is nothing but unused stack.
    unsafe {
        let end = addr_of!(stack_end).cast_mut();
        let words = (top - MARGIN - end as usize) / size_of::<u32>();
        for word in 0..words {
            write_volatile(end.add(word), PAINT);
        }
        let before = clock();
        work();
        let instructions = elapsed(before, clock());
        let mut untouched = 0;
        while untouched < words && read_volatile(end.add(untouched)) == PAINT {
            untouched += 1;
        }
        cost::Cost { instructions, stack: top - end.add(untouched) as usize }
    }
}

/// SysTick counts down 24 bits at 25 MHz, the clock of the board.
#[cfg(target_arch = "arm")]
fn clock() -> u64 {
    const SYST: *mut u32 = 0xe000_e010 as *mut u32;
    // SAFETY: the registers of the timer, which nothing else uses.
    unsafe {
        if read_volatile(SYST) == 0 {
            write_volatile(SYST.add(1), 0x00ff_ffff);
            write_volatile(SYST.add(2), 0);
            write_volatile(SYST, 0b101);
        }
        u64::from(read_volatile(SYST.add(2)))
    }
}

/// The emulator's clock moves by a nanosecond for each instruction: 40 of them are one tick.
#[cfg(target_arch = "arm")]
fn elapsed(before: u64, after: u64) -> u64 {
    40 * (before.wrapping_sub(after) & 0x00ff_ffff)
}

#[cfg(target_arch = "riscv32")]
fn clock() -> u64 {
    let count: u32;
    // SAFETY: reads a counter.
    unsafe { core::arch::asm!("csrr {}, minstret", out(reg) count) };
    u64::from(count)
}

#[cfg(target_arch = "riscv32")]
fn elapsed(before: u64, after: u64) -> u64 {
    after.wrapping_sub(before) & 0xffff_ffff
}

#[cfg(target_arch = "aarch64")]
fn clock() -> u64 {
    let count: u64;
    // SAFETY: reads a counter.
    unsafe { core::arch::asm!("mrs {}, cntvct_el0", out(reg) count) };
    count
}

/// 62.5 MHz: 16 instructions are one tick.
#[cfg(target_arch = "aarch64")]
fn elapsed(before: u64, after: u64) -> u64 {
    16 * after.wrapping_sub(before)
}
