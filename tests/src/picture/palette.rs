//! Colours: one hue an axle, dark on the right and light on the left; told apart by the colour-blind.

use xt28_machine::Wheel;

pub(super) const ROLL: &str = "#7b3294";
pub(super) const PITCH: &str = "#e08214";
pub(super) const FRONT: &str = "#08519c";
pub(super) const REAR: &str = "#238b45";
pub(super) const SPEED: &str = "#555555";
pub(super) const PATH: &str = "#222222";
pub(super) const TARGET: &str = "#c51b7d";
pub(super) const GROUND: &str = "#e8dcc5";

/// The colour of a wheel, its arm and its cylinder.
pub(super) const fn of(wheel: Wheel) -> &'static str {
    match wheel {
        Wheel::Fr => "#08519c",
        Wheel::Fl => "#6baed6",
        Wheel::Mr => "#a63603",
        Wheel::Ml => "#fd8d3c",
        Wheel::Br => "#1b7a3d",
        Wheel::Bl => "#74c476",
    }
}
