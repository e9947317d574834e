//! What a terrain is made of: each layer adds its heights to the others'.

pub(crate) mod ramp;
