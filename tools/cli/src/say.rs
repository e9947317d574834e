//! Data on stdout. Whoever reads it may go away, as `head` does: that ends the program, and is no failure.

use std::fmt;
use std::io::{ErrorKind, Write as _, stdout};
use std::process::exit;

/// Prints to stdout as `print!` does.
macro_rules! say {
    ($($text:tt)*) => { $crate::say::print(format_args!($($text)*)) };
}
pub(crate) use say;

/// Ends the program where nobody reads any more, or nothing can be written.
pub(crate) fn print(text: fmt::Arguments<'_>) {
    match stdout().write_fmt(text) {
        Ok(()) => {}
        Err(error) if error.kind() == ErrorKind::BrokenPipe => exit(0),
        Err(error) => {
            eprintln!("xt28: cannot write to stdout: {error}");
            exit(2);
        }
    }
}
