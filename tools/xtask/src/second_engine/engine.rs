//! The engines by name, and how MuJoCo is set for a fair race.

/// One engine with its settings.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Engine {
    /// Our reference, on rapier3d.
    Rapier,
    /// Our fast core.
    Reduced,
    /// MuJoCo with the true friction cone and the Newton solver: what it is most exact with.
    MujocoElliptic,
    /// MuJoCo with the pyramid in place of the cone and conjugate gradients: quicker, less exact.
    MujocoPyramidal,
}

impl Engine {
    /// As tables have it.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Rapier => "rapier",
            Self::Reduced => "reduced",
            Self::MujocoElliptic => "MuJoCo elliptic, Newton",
            Self::MujocoPyramidal => "MuJoCo pyramidal, CG",
        }
    }

    /// As our side's programs take it; `None` for what is not ours.
    pub(crate) fn argument(self) -> Option<&'static str> {
        match self {
            Self::Rapier => Some("rapier"),
            Self::Reduced => Some("reduced"),
            Self::MujocoElliptic | Self::MujocoPyramidal => None,
        }
    }

    /// Arguments of MuJoCo's side.
    pub(crate) fn mujoco_arguments(self) -> &'static [&'static str] {
        match self {
            Self::MujocoPyramidal => &["--cone=pyramidal", "--solver=CG"],
            Self::Rapier | Self::Reduced | Self::MujocoElliptic => &[],
        }
    }
}
