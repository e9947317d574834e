//! The safety kernel: allow, clamp or block, without allocation.
