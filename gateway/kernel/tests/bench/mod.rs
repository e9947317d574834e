//! A kernel with a healthy machine around it, for the tests to spoil.
#![allow(dead_code)] // each test file uses its part

use xt28_safety::{
    Arms, Command, Input, Limits, Link, Measured, Order, Stamps, State, Verdict, step,
};

pub(crate) const TICK_NS: u64 = 10_000_000;
pub(crate) const LIMITS: Limits = Limits::XT28;

/// Kernel, time and the counters both sides are at.
pub(crate) struct Bench {
    pub(crate) limits: Limits,
    pub(crate) state: State,
    pub(crate) now_ns: u64,
    pub(crate) counter: u8,
    pub(crate) measured: Measured,
    pub(crate) is_braked: bool,
}

impl Bench {
    /// Disarmed, with readings that have been steady for long enough.
    pub(crate) fn new() -> Self {
        let mut bench = Self::at_power_up();
        for _ in 0..=LIMITS.steady_ns / TICK_NS {
            bench.run(Order::None, coast());
        }
        bench
    }

    /// Before the first step.
    pub(crate) fn at_power_up() -> Self {
        let measured = Measured {
            stroke_m: [0.17; 6],
            front_angle_rad: 0.0,
            speed_m_s: 0.0,
            roll_rad: 0.0,
            pitch_rad: 0.0,
        };
        let (state, is_braked) = (State::new(), false);
        Self { limits: LIMITS, state, now_ns: 1_000_000_000, counter: 0, measured, is_braked }
    }

    /// Armed, after an order and a whole handshake.
    pub(crate) fn armed() -> Self {
        Self::armed_within(LIMITS)
    }

    /// The same held to other limits.
    pub(crate) fn armed_within(limits: Limits) -> Self {
        let mut bench = Self { limits, ..Self::new() };
        bench.run(Order::Arm, coast());
        for _ in 0..LIMITS.handshake_steps {
            bench.run(Order::None, coast());
        }
        assert!(bench.state.is_armed());
        bench
    }

    /// What a healthy machine gives at this instant.
    pub(crate) fn input(&self, order: Order, request: Command) -> Input {
        let fresh = Some(self.now_ns);
        let link = Link {
            heard_at_ns: fresh,
            ready: true,
            sent: Some(self.counter),
            accepted: (self.counter + LIMITS.counter_modulus - 1) % LIMITS.counter_modulus,
        };
        Input {
            order,
            request: Some(request),
            measured: self.measured,
            is_braked: self.is_braked,
            arm: link,
            drive: link,
            stamps: Stamps { sensors_ns: fresh, observation_ns: fresh, policy_ns: fresh },
            bus_ok: true,
            alone: true,
        }
    }

    /// One step on `input`, then one period on.
    pub(crate) fn feed(&mut self, input: &Input) -> Verdict {
        let (state, verdict) = step(&self.limits, self.state, input, self.now_ns);
        self.state = state;
        self.now_ns += TICK_NS;
        self.counter = (self.counter + 1) % LIMITS.counter_modulus;
        verdict
    }

    pub(crate) fn run(&mut self, order: Order, request: Command) -> Verdict {
        let input = self.input(order, request);
        self.feed(&input)
    }
}

/// Roll on, arms held.
pub(crate) fn coast() -> Command {
    Command { throttle: 0.0, front_angle_rad: 0.0, arms: Arms::Position([None; 6]), brake: false }
}

pub(crate) fn strokes(stroke_m: f64) -> Command {
    Command { arms: Arms::Position([Some(stroke_m); 6]), ..coast() }
}
