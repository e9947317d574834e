//! Data on stdout. Whoever reads it may go away, as `head` does: that is no failure, and no verdict either.

use std::fmt;
use std::io::{ErrorKind, Write as _, stdout};
use std::process::exit;

/// Prints to stdout as `print!` does.
macro_rules! say {
    ($($text:tt)*) => { $crate::say::print(format_args!($($text)*)) };
}
pub(crate) use say;

/// Ends the program where nothing can be written. Where nobody reads any more it says nothing and goes on: files
/// are still to be written, and the verdict is the exit status.
pub(crate) fn print(text: fmt::Arguments<'_>) {
    match stdout().write_fmt(text) {
        Ok(()) => {}
        Err(error) if error.kind() == ErrorKind::BrokenPipe => {}
        Err(error) => {
            eprintln!("xt28: cannot write to stdout: {error}");
            exit(2);
        }
    }
}
