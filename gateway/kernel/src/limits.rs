//! The numbers the kernel holds everything to.

const DEGREE: f64 = core::f64::consts::PI / 180.0;
const MILLISECOND_NS: u64 = 1_000_000;

/// How many periods of a stream may pass without news.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Deadline {
    /// The stream's period, ns.
    pub period_ns: u64,
    /// Periods until it counts as lost.
    pub periods: u32,
}

impl Deadline {
    /// The longest silence, ns.
    #[must_use]
    pub const fn span_ns(self) -> u64 {
        self.period_ns.saturating_mul(self.periods as u64)
    }

    /// True unless `at_ns` is known, not in the future and young enough.
    #[must_use]
    pub const fn missed(self, at_ns: Option<u64>, now_ns: u64) -> bool {
        match at_ns {
            // A stamp from the future would never grow old, so it counts as none.
            Some(at) if at <= now_ns => now_ns - at > self.span_ns(),
            _ => true,
        }
    }
}

/// Limits of what may be commanded. [`Limits::XT28`] has the values and where they come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Strokes are commanded within 0 and this, m.
    pub stroke_max_m: f64,
    /// A target stroke moves no faster than this, m/s.
    pub stroke_rate_m_s: f64,
    /// A target stroke goes no further than this ahead of the measured one, m. Where that one leaps away, the
    /// target waits for it.
    pub stroke_error_m: f64,
    /// Valve openings stay within plus and minus this, share of full.
    pub opening_max: f64,
    /// Throttle stays within plus and minus this, share of full.
    pub throttle_max: f64,
    /// Throttle grows in magnitude no faster than this, 1/s. Letting go is free.
    pub throttle_rate_s: f64,
    /// The front joint's target stays within plus and minus this, rad.
    pub angle_max_rad: f64,
    /// The front joint's target moves no faster than this, rad/s.
    pub angle_rate_rad_s: f64,
    /// The front joint's target goes no further than this ahead of the measured angle, rad; as with strokes.
    pub angle_error_rad: f64,
    /// The parking brake does not close on a machine that is faster than this, either way, m/s.
    pub brake_speed_m_s: f64,
    /// So long after it was asked for the brake closes on a rolling machine as well, ns.
    pub brake_wait_ns: u64,
    /// More roll than this, either way, blocks, rad.
    pub roll_max_rad: f64,
    /// More pitch than this, either way, blocks, rad.
    pub pitch_max_rad: f64,
    /// A stroke sensor in order reads between these, m.
    pub stroke_read_m: [f64; 2],
    /// A joint sensor in order reads between plus and minus this, rad.
    pub angle_read_rad: f64,
    /// A reading is one to start from when it has not leapt for so long, and stops an armed machine when it was no
    /// reading of a sensor in order for longer, ns.
    pub steady_ns: u64,
    /// Silence allowed to each ECU's status frame.
    pub status: Deadline,
    /// Silence allowed to the sensors that the limits lean on (strokes, attitude, joints).
    pub sensors: Deadline,
    /// Age allowed to the observation the policy acted on.
    pub observation: Deadline,
    /// Age allowed to the policy's last answer.
    pub policy: Deadline,
    /// Time without an acknowledgement in step, from either ECU.
    pub acknowledgement: Deadline,
    /// Acknowledged steps in a row before arming.
    pub handshake_steps: u32,
    /// Longest handshake, ns.
    pub handshake_max_ns: u64,
    /// An ECU is in step while the counter it accepted is at most this far behind the one sent.
    pub counter_lag_max: u8,
    /// The alive counters count modulo this.
    pub counter_modulus: u8,
    /// Longest time a rate limit is given credit for, ns: a late step must not become a leap.
    pub step_max_ns: u64,
}

impl Limits {
    /// The Xt28 under a policy that acts at 8 Hz.
    ///
    /// From the paper (section 4): strokes 0 to 0.25 m, 30 % of full arm speed. The ECU clips the
    /// arm speed; a position target may lead the arm by 0.10 m, just above the 75 mm at which that
    /// clip is reached, so the limit softens steps without slowing the arm.
    /// From the firmware facts: joints within 25 degrees. All else assumed: roll 18 degrees, above
    /// the 14 the paper's machine met with locked arms on its ramp and about half of what tips a
    /// track of 2.35 m with the mass at 1.6 m; pitch 25 degrees; a joint target may lead by 25
    /// degrees (5/8 of the opening of the steering valve); silences of ten status or sensor periods
    /// and three fixes; a brake that waits up to a second for 0.1 m/s (the 2016 firmware refuses it
    /// above 150 per mille of filtered pedal, facts 4.4, which a throttle on the bus does not have); sensors that
    /// read 3 cm beyond either end of the cylinder's 0.5 m (an open wire reads 4.5 cm beyond) and 20 degrees beyond
    /// the joint's stop; readings that are started from once an ECU would have called them broken (after 200 ms, facts
    /// 3.2) and said so.
    pub const XT28: Self = Self {
        stroke_max_m: 0.25,
        stroke_rate_m_s: 0.20,
        stroke_error_m: 0.10,
        opening_max: 0.30,
        throttle_max: 1.0,
        throttle_rate_s: 1.0,
        angle_max_rad: 25.0 * DEGREE,
        angle_rate_rad_s: 30.0 * DEGREE,
        angle_error_rad: 25.0 * DEGREE,
        brake_speed_m_s: 0.1,
        brake_wait_ns: 1_000 * MILLISECOND_NS,
        roll_max_rad: 18.0 * DEGREE,
        pitch_max_rad: 25.0 * DEGREE,
        stroke_read_m: [-0.03, 0.53],
        angle_read_rad: 45.0 * DEGREE,
        steady_ns: 220 * MILLISECOND_NS,
        status: Deadline { period_ns: 10 * MILLISECOND_NS, periods: 10 },
        sensors: Deadline { period_ns: 10 * MILLISECOND_NS, periods: 10 },
        observation: Deadline { period_ns: 125 * MILLISECOND_NS, periods: 3 },
        policy: Deadline { period_ns: 125 * MILLISECOND_NS, periods: 3 },
        acknowledgement: Deadline { period_ns: 10 * MILLISECOND_NS, periods: 10 },
        handshake_steps: 10,
        handshake_max_ns: 5_000 * MILLISECOND_NS,
        counter_lag_max: 3,
        counter_modulus: 16,
        step_max_ns: 30 * MILLISECOND_NS,
    };

    /// True when every number can be held to: finite, none negative, the counter's range not empty.
    #[must_use]
    pub fn are_sound(&self) -> bool {
        let floats = [
            self.stroke_max_m,
            self.stroke_rate_m_s,
            self.stroke_error_m,
            self.opening_max,
            self.throttle_max,
            self.throttle_rate_s,
            self.angle_max_rad,
            self.angle_rate_rad_s,
            self.angle_error_rad,
            self.brake_speed_m_s,
            self.roll_max_rad,
            self.pitch_max_rad,
            self.stroke_read_m[1] - self.stroke_read_m[0],
            self.angle_read_rad,
        ];
        // With a lag as large as the range, a dead ECU would look alive.
        floats.iter().all(|x| x.is_finite() && *x >= 0.0)
            && self.counter_lag_max < self.counter_modulus.saturating_sub(1)
    }
}
