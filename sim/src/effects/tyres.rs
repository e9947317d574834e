//! What may be true between wheel and ground.

pub(super) mod slippery_ground;
pub(super) mod soft_tyres;

pub use slippery_ground::SlipperyGround;
pub use soft_tyres::SoftTyre;
