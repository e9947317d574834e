//! Turns `xt28.dbc` into typed messages; refuses a bad database with all that is wrong in it.

#![allow(clippy::disallowed_macros, clippy::disallowed_methods)] // how a build script speaks to cargo

use std::path::Path;
use std::{env, fs};

use xt28_dbc_model::{Database, generate};

fn main() {
    println!("cargo::rerun-if-changed=xt28.dbc");
    let text = fs::read_to_string("xt28.dbc").expect("dbc/xt28.dbc is there");
    let database = Database::parse(&text, "dbc/xt28.dbc").unwrap_or_else(|e| panic!("{e}"));
    let source = generate(&database).unwrap_or_else(|e| panic!("dbc/xt28.dbc is bad:\n{e}"));
    let out = env::var_os("OUT_DIR").expect("cargo sets OUT_DIR");
    fs::write(Path::new(&out).join("messages.rs"), source).expect("OUT_DIR can be written");
}
