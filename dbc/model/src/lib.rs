//! The database model behind generated and run-time codecs: parse, check, encode, decode, generate.
