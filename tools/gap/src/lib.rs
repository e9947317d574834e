//! Field logs against the simulator.
