//! The plant: a rapier3d vehicle made of blocks that can be stepped alone.
