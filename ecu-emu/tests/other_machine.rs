//! A machine file other than the nominal one: what the bus says is what the plant does.

use ecu_emu::{Emulator, EmulatorConfig, TICK};
use xt28_dbc::Outbox;
use xt28_dbc::messages::{PosFront, PosMidRear, WheelSpeedJoint};
use xt28_machine::{Machine, PerWheel, SimTime};
use xt28_sim::{Terrain, VehicleState};

/// Cylinders half as long again, and joints that turn further than a sensor of the nominal machine tells.
fn machine() -> Machine {
    let mut machine = Machine::xt28();
    machine.arms.stroke_max_m = 0.75;
    machine.articulation.angle_max_deg = 40.0;
    machine
}

/// Strokes, mm, and joint angles, deg, as the bus has them of a machine that is held at `state`.
fn said(machine: &Machine, state: &VehicleState) -> (Vec<f64>, Option<[f64; 2]>) {
    let config = EmulatorConfig::new(machine.clone(), Terrain::Flat, None);
    let mut emulator = Emulator::set_down(&config);
    let (mut strokes_mm, mut joints_deg) = (Vec::new(), None);
    let mut now = SimTime::ZERO;
    for _ in 0..3 {
        let mut out = Outbox::default();
        emulator.track(now, state, &mut out);
        strokes_mm.clear();
        for frame in out.frames() {
            if let Ok(PosFront { fr_mm, fl_mm }) = PosFront::decode(frame) {
                strokes_mm.extend([fr_mm, fl_mm]);
            }
            if let Ok(PosMidRear { mr_mm, ml_mm, br_mm, bl_mm }) = PosMidRear::decode(frame) {
                strokes_mm.extend([mr_mm, ml_mm, br_mm, bl_mm]);
            }
            if let Ok(joint) = WheelSpeedJoint::decode(frame) {
                joints_deg = Some([joint.front_joint_deg, joint.rear_joint_deg]);
            }
        }
        now += TICK;
    }
    (strokes_mm, joints_deg)
}

#[test]
fn long_cylinders_and_wide_joints_are_read_to_their_ends() {
    let machine = machine();
    let config = EmulatorConfig::new(machine.clone(), Terrain::Flat, None);
    let mut vehicle = config.solver.vehicle(
        &machine,
        &config.effects,
        &Terrain::Flat,
        PerWheel::splat(0.7),
        TICK,
    );
    vehicle.step(&xt28_sim::Actuation::idle(1200.0));
    let state = VehicleState { joint_rad: [0.6, -0.5], ..*vehicle.state() };
    let (strokes_mm, joints_deg) = said(&machine, &state);
    assert_eq!(strokes_mm.len(), 6);
    assert!(strokes_mm.iter().all(|mm| (mm - 700.0).abs() < 15.0), "{strokes_mm:?}");
    let joints_deg = joints_deg.unwrap();
    for (said_deg, true_rad) in joints_deg.into_iter().zip(state.joint_rad) {
        assert!((said_deg - true_rad.to_degrees()).abs() < 0.5, "{joints_deg:?}");
    }
}
