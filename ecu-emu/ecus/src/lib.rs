//! The two ECUs, sans-IO: frames and electrical signals in and out, time as an argument.
