//! Where a machine's logs part from the simulator: each block on measured inputs, so that an error
//! stays where it arises.
//!
//! | Step | Where |
//! |---|---|
//! | the log on one clock | [`Signals`] |
//! | whether its readings agree with each other | [`ensure_agreeing`] |
//! | each block driven with what was measured | [`Generator`], its [`Residual`]s in units of a floor |
//! | what ordinary tolerances explain | [`Knob`]s, all at once, in [`Evidence`] |
//! | what an effect would explain beyond that | [`Hypothesis`] |

mod agreement;
mod beginning;
mod belief;
mod blend;
mod candidate;
mod candidates;
pub mod details;
mod diagnose;
mod evidence;
mod excitation;
mod floor;
mod floors;
mod gauge;
mod generator;
mod how_far;
mod hypothesis;
mod inquiry;
mod instant;
mod judgement;
mod kinematics;
mod knob;
mod likely_wheels;
mod next_drive;
mod noise;
mod onset;
mod overlap;
mod scales;
mod search;
mod signals;
mod stands;
mod two_looks;
mod unshrunk;
mod vague_laws;
mod verdict;
mod wheel_torques;

pub use agreement::{
    AttitudeScale, JointScale, LoadScale, OddHeading, SideOrder, SpeedScale, StrokeScale, Swap,
    SwappedChambers, TurnedValves, WheelScale, ensure_agreeing, swapped_wheels,
};
pub(crate) use agreement::{
    ensure_motions_agreeing, ensure_pressures_agreeing, ensure_valves_agreeing,
};
pub use beginning::Beginning;
pub use belief::{Base, Belief};
pub use candidate::Candidate;
pub use details::Details;
pub use diagnose::Progress;
pub use evidence::{Echo, Evidence, Left, Uneven};
pub use excitation::not_testable;
pub use floor::{Floor, Signal};
pub use floors::{BlockKey, Floors};
pub use generator::{Generator, Residual, share_resistance};
pub use how_far::{Horizon, HowFar, Quantity, Refit, Traces, overlay};
pub use hypothesis::{Fit, Hypothesis};
pub use inquiry::{FieldRun, Inquiry};
pub use judgement::{Findings, HeldOut, HeldOutSignal, SignalFindings};
pub(crate) use knob::SHIFT_MAX;
pub use knob::{Knob, TOLERANCES, Tolerance};
pub(crate) use next_drive::scripted_drive;
pub use next_drive::{Manoeuvre, next_drive, untested_drive};
pub use noise::with_noise_of;
pub use onset::Onset;
pub use scales::{Chances, Grounds, Scales};
pub use search::search;
pub use signals::{DT_S, Samples, Signals, StrokeJump};
pub(crate) use signals::{needed, sampled};
pub(crate) use verdict::WORTH_TELLING;
pub use verdict::{
    Cause, Diagnosis, Drive, Estimate, Next, NotTestable, Place, ShareOf, Shrink, Spot, Together,
    Verdict,
};
