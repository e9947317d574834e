//! What may be changed bit by bit into another of its kind.

/// Something that a filtered reading may show half of, while it follows a jump.
pub(super) trait Blend: Copy {
    /// The same with `share` of it changed for `other`.
    #[must_use]
    fn toward(self, other: &Self, share: f64) -> Self;
}

impl Blend for f64 {
    fn toward(self, other: &Self, share: f64) -> Self {
        self + share * (other - self)
    }
}
