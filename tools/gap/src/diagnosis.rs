//! Where a machine's logs part from the simulator: each block on measured inputs, so that an error
//! stays where it arises.
//!
//! | Step | Where |
//! |---|---|
//! | the log on one clock | [`Signals`] |
//! | each block driven with what was measured | [`Generator`], its [`Residual`]s in units of a floor |
//! | what ordinary tolerances explain | [`Knob`]s, all at once, in [`Evidence`] |
//! | what an effect would explain beyond that | [`Hypothesis`] |

mod along;
mod attitude_scale;
mod belief;
mod candidates;
mod chamber_order;
pub mod details;
mod diagnose;
mod evidence;
mod excitation;
mod floor;
mod floors;
mod gauge;
mod generator;
mod heading_sense;
mod how_far;
mod hypothesis;
mod inquiry;
mod instant;
mod joint_scale;
mod judgement;
mod kinematics;
mod knob;
mod load_scale;
mod next_drive;
mod noise;
mod overlap;
mod scales;
mod search;
mod signals;
mod speed_scale;
mod stands;
mod stroke_scale;
mod unshrunk;
mod verdict;
mod wheel_order;
mod wheel_scale;

pub use attitude_scale::{AttitudeScale, attitude_scale};
pub use belief::{Base, Belief};
pub use candidates::Candidate;
pub use chamber_order::{SwappedChambers, swapped_chambers};
pub use details::Details;
pub use diagnose::Progress;
pub use evidence::{Echo, Evidence, Left, Uneven};
pub use excitation::not_testable;
pub use floor::{Floor, Signal};
pub use floors::{BlockKey, Floors};
pub use generator::{Generator, Residual, share_resistance};
pub use heading_sense::{OddHeading, odd_heading};
pub use how_far::{Horizon, HowFar, Quantity, Refit, Traces, overlay};
pub use hypothesis::{Fit, Hypothesis};
pub use inquiry::{FieldRun, Inquiry};
pub use joint_scale::{JointScale, Odd, OddJoint, joint_scale};
pub use judgement::Findings;
pub(crate) use knob::SHIFT_MAX;
pub use knob::{Knob, TOLERANCES, Tolerance};
pub use load_scale::{LoadScale, load_scale};
pub(crate) use next_drive::scripted_drive;
pub use next_drive::{Manoeuvre, next_drive, untested_drive};
pub use noise::with_noise_of;
pub use scales::{Chances, Grounds, Scales};
pub use search::search;
pub use signals::{DT_S, Samples, Signals};
pub(crate) use signals::{needed, sampled};
pub use speed_scale::{SpeedScale, speed_scale};
pub use stroke_scale::{StrokeScale, stroke_scale};
pub(crate) use verdict::WORTH_TELLING;
pub use verdict::{
    Beginning, Cause, Diagnosis, Drive, Estimate, Next, NotTestable, Place, ShareOf, Shrink, Spot,
    Together, Verdict,
};
pub use wheel_order::{Swap, swapped_wheels};
pub use wheel_scale::{WheelScale, wheel_scale};
