//! Data on stdout, talk on stderr. Whoever reads them may go away, as `head` does: that is no failure, and no verdict
//! either.

use std::fmt;
use std::io::{ErrorKind, Write as _, stderr, stdout};
use std::process::exit;

/// Prints to stdout as `print!` does.
macro_rules! say {
    ($($text:tt)*) => { $crate::say::print(format_args!($($text)*)) };
}
pub(crate) use say;

/// Says a line on stderr as `eprintln!` does, which would end the program where nobody reads it.
macro_rules! tell {
    ($($text:tt)*) => { $crate::say::remark(format_args!($($text)*)) };
}
pub(crate) use tell;

/// Ends the program where nothing can be written. Where nobody reads any more it says nothing and goes on: files
/// are still to be written, and the verdict is the exit status.
pub(crate) fn print(text: fmt::Arguments<'_>) {
    match stdout().write_fmt(text) {
        Ok(()) => {}
        Err(error) if error.kind() == ErrorKind::BrokenPipe => {}
        Err(error) => {
            tell!("xt28: cannot write to stdout: {error}");
            exit(2);
        }
    }
}

/// Goes on where it cannot be written, whatever the reason: there is nobody to tell it to.
pub(crate) fn remark(text: fmt::Arguments<'_>) {
    let _ = writeln!(stderr(), "{text}");
}
