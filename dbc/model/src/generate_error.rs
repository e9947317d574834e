//! Why no source was made from a database.

/// Why no source was made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GenerateError {
    /// The database is bad; all that is wrong, a line each.
    #[error("{0}")]
    Problems(String),
    /// Generated structs cannot say this yet; decode it at run time.
    #[error("{place}: {what}; read this message at run time instead")]
    Unsupported {
        /// Message and signal.
        place: String,
        /// What is not supported.
        what: &'static str,
    },
}
