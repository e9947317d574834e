//! Metal end stops: of a cylinder, of a joint.

/// A metal stop. It pushes back and never pulls: steel does not stick to steel.
///
/// The damping grows with the depth up to `damped_at`, so a part that arrives fast meets no jump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EndStop {
    /// Force per depth, N/m; of a joint Nm/rad.
    pub(crate) stiffness: f64,
    /// Force per speed of one who is deep in it, N s/m; of a joint Nm s/rad.
    pub(crate) damping: f64,
    /// Depth from which on the damping is in full, m; of a joint rad.
    pub(crate) damped_at: f64,
}

/// What a stop does at one depth and rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Push {
    /// Force out of the stop, above zero; N or Nm.
    pub(crate) force: f64,
    /// d(force)/d(depth).
    pub(crate) stiffness: f64,
    /// d(force)/d(rate).
    pub(crate) damping: f64,
}

impl EndStop {
    /// The push at this `depth` and at this `rate` into the stop; `None` where it is not touched, or
    /// left faster than it springs back.
    pub(crate) fn push(&self, depth: f64, rate: f64) -> Option<Push> {
        let damped = self.damping * (depth / self.damped_at).min(1.0);
        let force = self.stiffness * depth + damped * rate;
        let deepening = if depth < self.damped_at { self.damping / self.damped_at } else { 0.0 };
        let stiffness = self.stiffness + deepening * rate;
        (depth > 0.0 && force > 0.0).then_some(Push { force, stiffness, damping: damped })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STOP: EndStop = EndStop { stiffness: 2.0e7, damping: 2.0e5, damped_at: 1e-3 };

    #[test]
    fn it_pushes_only_and_without_a_jump() {
        for step in 0..=400 {
            for rate in [-1.0, -0.1, -0.01, 0.0, 0.2, 1.0] {
                let depth = 1e-5 * f64::from(step - 100);
                let force = |depth: f64| STOP.push(depth, rate).map_or(0.0, |push| push.force);
                assert!(force(depth) >= 0.0 && (depth > 0.0 || force(depth) == 0.0));
                assert!((force(depth + 1e-9) - force(depth)).abs() < 0.5, "{depth} m, {rate} m/s");
            }
        }
    }
}
