//! What is true of one foreign machine: the parameters of all its laws.
//!
//! Tolerances and causes change these numbers; the laws read them. Every number that is not the
//! machine file's is assumed, and says so.

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel};

/// Everything that the laws read.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Truth {
    /// Masses, geometry, and the nominal numbers.
    pub(crate) machine: Machine,
    pub(crate) body: BodyTruth,
    pub(crate) arms: PerWheel<ArmTruth>,
    pub(crate) supply: SupplyTruth,
    pub(crate) steering: SteeringTruth,
    pub(crate) drive: DriveTruth,
    pub(crate) ecu: EcuTruth,
    pub(crate) sensors: SensorTruth,
    pub(crate) bus: BusTruth,
}

/// What the rigid bodies are and stand on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BodyTruth {
    pub(crate) tyres: PerWheel<Tyre>,
    /// Logs in the bunk.
    pub(crate) logs: Logs,
    /// Front frame's centre of mass, from where the machine file has it, m.
    pub(crate) com_shift_m: [f64; 3],
    /// Rise of the ground ahead and to the left, rad.
    pub(crate) slope_rad: [f64; 2],
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tyre {
    pub(crate) stiffness_n_m: f64,
    pub(crate) damping_n_s_m: f64,
    pub(crate) friction: f64,
    /// Share of the rolling that is not travel.
    pub(crate) slip: f64,
    /// Slip over which soil comes to 63 % of its friction as it shears.
    pub(crate) shear: f64,
    /// How fast a standing foot gives way to a force along the ground, m/s/N.
    pub(crate) creep_m_s_n: f64,
    /// Drag torque over normal force and radius.
    pub(crate) rolling: f64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Logs {
    pub(crate) mass_kg: f64,
    /// Left of the centre line, m.
    pub(crate) lateral_m: f64,
    /// Ahead of the bunk's centre, m.
    pub(crate) ahead_m: f64,
}

/// An arm: current to spool to oil to rod.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ArmTruth {
    /// From the ECU's output to the pilot stage, s.
    pub(crate) delay_s: f64,
    /// Filling time of the pilot stage, s.
    pub(crate) pilot_s: f64,
    pub(crate) spool: SpoolTruth,
    /// Metering areas over nominal, extending and contracting.
    pub(crate) notches: [f64; 2],
    /// Pressure drop held over the spool, share of nominal.
    pub(crate) margin: f64,
    /// Share of the load pressure that the compensator lets through to the spool.
    pub(crate) compensator_loss: f64,
    /// Speed of creep under the mean load, m/s.
    pub(crate) leak_m_s: f64,
    /// Speed at which an unloaded arm draws out, m/s, and the load below which it does, N.
    pub(crate) sag_m_s: f64,
    pub(crate) sag_below_n: f64,
    /// Of the closed cylinder on its accumulator at mid stroke, N/m.
    pub(crate) stiffness_n_m: f64,
    /// Of the throttle between cylinder and accumulator, N s/m.
    pub(crate) damping_n_s_m: f64,
    /// Nitrogen instead of the spring in the bore side's accumulator.
    pub(crate) gas: Option<Gas>,
    pub(crate) seal: SealTruth,
    /// Share of the other side's spool command on the same axle that leaks into this pilot.
    pub(crate) cross_talk: f64,
    /// The output stage freezes for this long, s, once in every so many seconds.
    pub(crate) stuck_s: f64,
    pub(crate) stuck_every_s: f64,
    /// Damping as a share of nominal at the start, fading to its inverse with the oil's heat.
    pub(crate) cold_factor: f64,
    /// Time of that, s.
    pub(crate) heating_s: f64,
}

/// The main spool on its springs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SpoolTruth {
    pub(crate) natural_rad_s: f64,
    pub(crate) damping_ratio: f64,
    /// Opening below which the lands still cover the ports, share of full.
    pub(crate) overlap: f64,
    /// Dry friction, as the share of full travel by which it holds the spool off.
    pub(crate) friction: f64,
}

/// Nitrogen behind a bladder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Gas {
    pub(crate) precharge_pa: f64,
    pub(crate) volume_m3: f64,
    pub(crate) exponent: f64,
}

/// Friction of the rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SealTruth {
    pub(crate) coulomb_n: f64,
    /// Above Coulomb's, at rest.
    pub(crate) breakaway_n: f64,
    /// Speed over which breakaway fades, m/s.
    pub(crate) fade_m_s: f64,
}

/// The load-sensing pump of arms and steering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SupplyTruth {
    pub(crate) flow_m3_s: f64,
    /// Hunting of the pump's regulator: share of the margin, rad/s.
    pub(crate) hunting: f64,
    pub(crate) hunting_rad_s: f64,
}

/// Both articulation joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SteeringTruth {
    pub(crate) delay_s: f64,
    pub(crate) pilot_s: f64,
    pub(crate) spool: SpoolTruth,
    /// Flow over nominal.
    pub(crate) flow: f64,
    /// Clearance of the pins, whole width, rad.
    pub(crate) clearance_rad: f64,
    pub(crate) stiffness_nm: f64,
    pub(crate) damping_nms: f64,
    /// The joints' cylinders leak to one side: rate to the left, rad/s.
    pub(crate) creep_rad_s: f64,
}

/// Engine and the two closed circuits.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DriveTruth {
    /// From the throttle to the ECU's demand, s.
    pub(crate) delay_s: f64,
    /// Of the pumps' swash plates, s.
    pub(crate) swash_s: f64,
    /// Torque per wheel for 1 rad/s of the circuit's mean: what leakage leaves of it, Nm s.
    pub(crate) slip_nms: f64,
    /// Time in which a circuit's pressure settles: compliance over leakage, s.
    pub(crate) settle_s: f64,
    /// Speed lost at 20 kW, share.
    pub(crate) droop: f64,
    pub(crate) power_w: f64,
    /// Torque with which idle motors hold, Nm.
    pub(crate) idle_hold_nm: PerWheel<f64>,
    /// Drag of a bearing that binds once a turn, Nm.
    pub(crate) binding_nm: PerWheel<f64>,
}

/// Gains of the control laws, over the published ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EcuTruth {
    pub(crate) arm_kp: PerWheel<f64>,
    pub(crate) arm_ki: PerWheel<f64>,
    pub(crate) steer_kp: f64,
    pub(crate) steer_ki: f64,
    pub(crate) rear_filter_s: f64,
    pub(crate) rear_ratio: f64,
}

/// What the sensors make of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SensorTruth {
    pub(crate) stroke_bias_m: PerWheel<f64>,
    pub(crate) stroke_scale: PerWheel<f64>,
    /// Lag of the position sensors, s.
    pub(crate) stroke_lag_s: PerWheel<f64>,
    /// On the bore chamber.
    pub(crate) pressure_bias_pa: PerWheel<f64>,
    pub(crate) pressure_scale: PerWheel<f64>,
    /// Roll and pitch that the unit reads when level, rad.
    pub(crate) imu_tilt_rad: [f64; 2],
    pub(crate) gyro_scale: f64,
    pub(crate) wheel_speed_scale: PerWheel<f64>,
    pub(crate) gnss_latency_s: f64,
    pub(crate) antenna_shift_m: [f64; 2],
    /// All standard deviations times this; 0 for a machine without noise.
    pub(crate) noise: f64,
}

/// Between gateway and ECUs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BusTruth {
    /// Share of frames lost, each by itself.
    pub(crate) loss: f64,
    /// Commands come up to this late, s.
    pub(crate) late_s: f64,
    /// Ordinary unevenness of every sender, s.
    pub(crate) jitter_s: f64,
}

impl Truth {
    /// The machine as believed, with this plant's own dynamics where the belief has none.
    pub(crate) fn nominal() -> Self {
        let machine = Machine::xt28();
        let (v, w) = (&machine.vehicle, &machine.wheels);
        let tyre = Tyre {
            stiffness_n_m: v.tyre_stiffness_n_m,
            damping_n_s_m: v.tyre_damping_n_s_m,
            friction: w.friction,
            slip: 0.0,
            shear: 0.01,
            creep_m_s_n: 0.0,
            rolling: w.rolling_resistance,
        };
        // 32 Hz, well damped: a quick valve, 9 ms behind its command (assumed).
        let spool =
            SpoolTruth { natural_rad_s: 200.0, damping_ratio: 0.9, overlap: 0.001, friction: 0.0 };
        let one = PerWheel::splat(1.0);
        Self {
            body: BodyTruth {
                tyres: PerWheel::splat(tyre),
                logs: Logs::default(),
                com_shift_m: [0.0; 3],
                slope_rad: [0.0; 2],
            },
            arms: PerWheel::from_fn(|_| ArmTruth::nominal(&machine, spool)),
            supply: SupplyTruth { flow_m3_s: 0.02, hunting: 0.0, hunting_rad_s: 0.0 },
            steering: SteeringTruth {
                delay_s: 0.0,
                pilot_s: 0.0,
                spool,
                flow: 1.0,
                clearance_rad: 0.0,
                stiffness_nm: v.joint_stiffness_nm,
                damping_nms: v.joint_damping_nms,
                creep_rad_s: 0.0,
            },
            drive: DriveTruth {
                delay_s: 0.0,
                swash_s: 0.0,
                slip_nms: v.circuit_gain_nms,
                settle_s: 0.012,
                droop: 0.0,
                power_w: machine.drive.engine_power_w,
                idle_hold_nm: PerWheel::splat(0.0),
                binding_nm: PerWheel::splat(0.0),
            },
            ecu: EcuTruth {
                arm_kp: one,
                arm_ki: one,
                steer_kp: 1.0,
                steer_ki: 1.0,
                rear_filter_s: 0.0,
                rear_ratio: 1.0,
            },
            sensors: SensorTruth {
                stroke_bias_m: PerWheel::splat(0.0),
                stroke_scale: one,
                stroke_lag_s: PerWheel::splat(0.0),
                pressure_bias_pa: PerWheel::splat(0.0),
                pressure_scale: one,
                imu_tilt_rad: [0.0; 2],
                gyro_scale: 1.0,
                wheel_speed_scale: one,
                gnss_latency_s: 0.0,
                antenna_shift_m: [0.0; 2],
                noise: 0.0,
            },
            bus: BusTruth { loss: 0.0, late_s: 0.0, jitter_s: 0.0 },
            machine,
        }
    }

    /// Load of a cylinder under a sixth of the weight, N.
    pub(crate) fn mean_load_n(&self, stroke_m: f64) -> f64 {
        let weight_n = (self.machine.mass_kg() + self.body.logs.mass_kg) * GRAVITY_M_S2;
        weight_n / 6.0 / self.machine.linkage().at_stroke(stroke_m).force_ratio
    }
}

impl ArmTruth {
    fn nominal(machine: &Machine, spool: SpoolTruth) -> Self {
        Self {
            delay_s: 0.0,
            pilot_s: 0.0,
            spool,
            notches: [1.0; 2],
            margin: 1.0,
            compensator_loss: 0.0,
            leak_m_s: 0.0,
            sag_m_s: 0.0,
            sag_below_n: 0.0,
            stiffness_n_m: machine.hydraulics.lock_stiffness_n_m,
            damping_n_s_m: machine.hydraulics.lock_damping_n_s_m,
            gas: None,
            seal: SealTruth { coulomb_n: 0.0, breakaway_n: 0.0, fade_m_s: 0.01 },
            cross_talk: 0.0,
            stuck_s: 0.0,
            stuck_every_s: 1.0,
            cold_factor: 1.0,
            heating_s: 1.0,
        }
    }
}
