//! What must hold of a run, each judged on the recorded bus alone (and on the truth where given). Only
//! grounding takes the truth: no sensor feels it.

mod arm_speed;
mod attitude;
mod clears_ground;
mod drives;
mod ecu_state;
mod ground_pressure;
mod holds_still;
mod leans;
mod level;
mod passes_states;
mod peak_load;
mod pose;
mod rear_joint;
pub(crate) mod sense;
mod standstill;
mod step_response;
mod strokes;
mod strokes_apart;
mod trouble;
mod unsupported;
mod weight;
mod wheel_load;

use serde::Deserialize;
use xt28_machine::Machine;

use crate::{Bound, Finding, Scenario, Trace, Truth};

pub use arm_speed::ArmSpeed;
pub use attitude::RollPeak;
pub use clears_ground::ClearsGround;
pub use drives::Drives;
pub use ecu_state::{Ecu, ReachesState};
pub use ground_pressure::EvenGroundPressure;
pub use holds_still::HoldsStill;
pub use leans::Leans;
pub use level::StaysLevel;
pub use passes_states::PassesStates;
pub use peak_load::PeakLoad;
pub use pose::ReachesPose;
pub use rear_joint::RearFollows;
pub use standstill::StandsStill;
pub use step_response::StepResponse;
pub use strokes::Strokes;
pub use strokes_apart::StrokesApart;
pub use trouble::ReportsTrouble;
pub use unsupported::Unsupported;
pub use weight::CarriesWeight;

/// One physical expectation, as a scenario file states it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Expectation {
    /// Ends at a pose.
    ReachesPose(ReachesPose),
    /// Ends standing.
    StandsStill(StandsStill),
    /// The wheels together carry the machine's weight.
    CarriesWeight(CarriesWeight),
    /// Arms move at the cap of their valves.
    ArmSpeed(ArmSpeed),
    /// The rear joint follows the front one.
    RearFollows(RearFollows),
    /// The greatest roll lies between two bounds.
    RollPeak(RollPeak),
    /// An ECU is in a state soon after commands stop.
    ReachesState(ReachesState),
    /// Arms answer steps of their targets.
    StepResponse(StepResponse),
    /// Roll and pitch stay small.
    StaysLevel(StaysLevel),
    /// The wheels share the weight.
    EvenGroundPressure(EvenGroundPressure),
    /// Wheels in the air carry nothing.
    Unsupported(Unsupported),
    /// The greatest load of a cylinder lies between two bounds.
    PeakLoad(PeakLoad),
    /// An ECU passes through states in an order.
    PassesStates(PassesStates),
    /// The arms stay where they are for a while.
    HoldsStill(HoldsStill),
    /// An ECU reports a trouble code.
    ReportsTrouble(ReportsTrouble),
    /// The machine leans by an angle.
    Leans(Leans),
    /// Nothing but wheels touches the ground; of a simulated machine alone.
    ClearsGround(ClearsGround),
    /// The machine drives.
    Drives(Drives),
    /// Arms stand between two bounds.
    Strokes(Strokes),
    /// Arms take up the heights of the ground.
    StrokesApart(StrokesApart),
}

/// A recorded run and what it ran: all that an expectation may look at.
#[derive(Clone, Copy, Debug)]
pub struct Evidence<'a> {
    /// The scenario that ran.
    pub scenario: &'a Scenario,
    /// The machine it ran on.
    pub machine: &'a Machine,
    /// What it carries beyond that, kg.
    pub payload_kg: f64,
    /// What the bus said.
    pub trace: &'a Trace,
    /// What was true, where the bench can know it.
    pub truth: Option<&'a Truth>,
}

impl Expectation {
    /// What this expectation found in `evidence`: at least one finding.
    #[must_use]
    pub fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        match self {
            Self::ReachesPose(e) => e.judge(evidence),
            Self::StandsStill(e) => e.judge(evidence),
            Self::CarriesWeight(e) => e.judge(evidence),
            Self::ArmSpeed(e) => e.judge(evidence),
            Self::RearFollows(e) => e.judge(evidence),
            Self::RollPeak(e) => e.judge(evidence),
            Self::ReachesState(e) => e.judge(evidence),
            Self::StepResponse(e) => e.judge(evidence),
            Self::StaysLevel(e) => e.judge(evidence),
            Self::EvenGroundPressure(e) => e.judge(evidence),
            Self::Unsupported(e) => e.judge(evidence),
            Self::PeakLoad(e) => e.judge(evidence),
            Self::PassesStates(e) => e.judge(evidence),
            Self::HoldsStill(e) => e.judge(evidence),
            Self::ReportsTrouble(e) => e.judge(evidence),
            Self::Leans(e) => e.judge(evidence),
            Self::ClearsGround(e) => e.judge(evidence),
            Self::Drives(e) => e.judge(evidence),
            Self::Strokes(e) => e.judge(evidence),
            Self::StrokesApart(e) => e.judge(evidence),
        }
    }
}

/// All findings on `evidence`: that the log is whole, then each expectation's in the file's order.
#[must_use]
pub fn judge(evidence: &Evidence<'_>) -> Vec<Finding> {
    let mut findings = whole(evidence);
    for expectation in &evidence.scenario.expectations {
        findings.extend(expectation.judge(evidence));
    }
    findings
}

/// Every run must fill its time with frames that decode.
fn whole(evidence: &Evidence<'_>) -> Vec<Finding> {
    let Evidence { scenario, trace, .. } = evidence;
    #[allow(clippy::cast_precision_loss)]
    let faults = trace.faults.len() as f64;
    let first = trace
        .faults
        .first()
        .map_or_else(String::new, |fault| format!("first at {:.3} s: {}", fault.at_s, fault.what));
    // The last tick's frames end within the tick.
    let length = Bound::Near { value: scenario.duration_s, tolerance: 0.5 };
    let covers = "log covers the run";
    vec![
        match trace.frames {
            0 => Finding::missing(covers, length, "s", "no frame in the log"),
            _ => Finding::of(covers, trace.end_s, length, "s"),
        },
        Finding::of("frames that do not decode", faults, Bound::AtMost(0.0), "").noting(first),
    ]
}
