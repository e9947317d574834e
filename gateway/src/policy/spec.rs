//! Policies by name, as a command line or a scenario gives them.

use std::path::{Path, PathBuf};

use xt28_machine::Machine;
use xt28_terrain::Terrain;

use super::{Goto, Hold, Network, NetworkError, Policy, Script, ScriptError};
use crate::{GatewayConfig, Pose};

/// Why a policy could not be had.
#[derive(Debug, thiserror::Error)]
pub enum SpecError {
    /// No policy of that name.
    #[error(
        "no policy {spec:?}; give goto:X,Y,HEADING_DEG, network:FILE[@X,Y,HEADING_DEG], script:FILE, \
         rosbridge:[ADDRESS:]PORT[,tick] or hold"
    )]
    Unknown {
        /// What was given.
        spec: String,
    },
    /// The numbers of a goal are not three finite numbers.
    #[error(
        "bad goal in {spec:?}; give goto:X,Y,HEADING_DEG in metres and degrees, as goto:25,0,0, and to a network \
         network:FILE@25,0,0"
    )]
    Goal {
        /// What was given.
        spec: String,
    },
    /// The address of a `rosbridge` is none.
    #[error(
        "bad address in {spec:?}; give rosbridge:9090 for controllers on this machine, \
         rosbridge:192.168.0.5:9090 to listen there, and ,tick behind it for 100 Hz"
    )]
    Address {
        /// What was given.
        spec: String,
    },
    /// A controller elsewhere, where nothing listens for one.
    #[error("{spec:?} needs a program that listens; give it to `gateway` or to `xt28 run`")]
    Elsewhere {
        /// What was given.
        spec: String,
    },
    /// The script was refused.
    #[error(transparent)]
    Script(#[from] ScriptError),
    /// The network was refused.
    #[error(transparent)]
    Network(#[from] NetworkError),
}

/// The policy that `spec` names: `goto:X,Y,HEADING_DEG`, `network:FILE[@X,Y,HEADING_DEG]`, `script:FILE` or `hold`. A
/// controller elsewhere is had by [`crate::Remote`]. `map` is for a network that looks at the heights around it.
///
/// # Errors
/// [`SpecError`], with what would be right.
pub fn from_spec(
    spec: &str,
    machine: &Machine,
    map: Option<&Terrain>,
) -> Result<Box<dyn Policy>, SpecError> {
    let pose = |goal| goal_pose(goal).ok_or_else(|| SpecError::Goal { spec: spec.to_owned() });
    match spec.split_once(':') {
        Some(("goto", goal)) => Ok(Box::new(Goto::new(machine, pose(goal)?))),
        Some(("network", network)) => {
            let (file, goal) = network_parts(network);
            let goal = goal.map(pose).transpose()?;
            Ok(Box::new(Network::load(Path::new(file), machine, goal, map)?))
        }
        Some(("script", file)) => {
            let limits = GatewayConfig::new(machine).limits;
            Ok(Box::new(Script::load(Path::new(file), &limits)?))
        }
        None if spec == "hold" => Ok(Box::new(Hold)),
        _ if crate::Listen::parse(spec)?.is_some() => {
            Err(SpecError::Elsewhere { spec: spec.to_owned() })
        }
        _ => Err(SpecError::Unknown { spec: spec.to_owned() }),
    }
}

/// Files that a network of this name is read from, as far as they can be told; of other policies none.
#[must_use]
pub fn network_files(spec: &str) -> Vec<PathBuf> {
    let network = spec.strip_prefix("network:").map(network_parts);
    network.map_or(Vec::new(), |(file, _)| Network::files(Path::new(file)))
}

/// Whether a policy of this name may look at a map of the ground.
#[must_use]
pub fn takes_map(spec: &str) -> bool {
    ["network:", "rosbridge:"].iter().any(|kind| spec.starts_with(kind))
}

/// The file of a network, and its goal: names of files may have an `@` as well.
fn network_parts(network: &str) -> (&str, Option<&str>) {
    match network.rsplit_once('@') {
        Some((file, goal)) if !goal.contains('/') && !is_policy_file(goal) => (file, Some(goal)),
        _ => (network, None),
    }
}

/// Whether a name is that of a policy file, as far as a name says.
fn is_policy_file(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
}

/// No goal is further from its origin, m: nothing on the ground is.
const COORDINATE_MAX: f64 = 1e6;

fn goal_pose(text: &str) -> Option<Pose> {
    let numbers: Vec<f64> =
        text.split(',').map(|n| n.trim().parse().ok()).collect::<Option<_>>()?;
    let [east_m, north_m, heading_deg] = numbers[..] else { return None };
    numbers.iter().all(|n| n.abs() <= COORDINATE_MAX).then(|| Pose {
        east_m,
        north_m,
        heading_rad: crate::pose::wrap(heading_deg.to_radians()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_network_has_its_goal_behind_its_file() {
        assert_eq!(network_parts("a@b/p.toml@25,0,0"), ("a@b/p.toml", Some("25,0,0")));
        assert_eq!(network_parts("a@b/p.toml"), ("a@b/p.toml", None));
        for name in ["p@2.toml", "p@2.TOML", "a@b/policy"] {
            assert_eq!(network_parts(name), (name, None));
        }
    }

    #[test]
    fn names_are_understood_or_refused_with_the_remedy() {
        let machine = Machine::xt28();
        for good in ["goto:25,0,0", "goto: 24.5, -4.98, -23", "hold"] {
            assert!(from_spec(good, &machine, None).is_ok(), "{good}");
        }
        for bad in ["goto:25,0", "goto:25,0,nan", "goto:1e300,0,0", "goto:", "goto:1,2,3,4"] {
            let error = from_spec(bad, &machine, None).err().unwrap().to_string();
            assert!(error.contains("goto:25,0,0"), "{error}");
        }
        for bad in ["", "drive", "hold:1", "onnx:policy"] {
            let error = from_spec(bad, &machine, None).err().unwrap().to_string();
            assert!(error.starts_with("no policy"), "{error}");
        }
        let error = from_spec("rosbridge:9090", &machine, None).err().unwrap().to_string();
        assert!(error.contains("xt28 run"), "{error}");
        let error = from_spec("script:no/such.toml", &machine, None).err().unwrap().to_string();
        assert!(error.contains("no/such.toml") && error.contains("existing file"), "{error}");
        let error =
            from_spec("network:no/such.toml@1,2", &machine, None).err().unwrap().to_string();
        assert!(error.contains("network:FILE@25,0,0"), "{error}");
        let error = from_spec("network:no/such.toml", &machine, None).err().unwrap().to_string();
        assert!(error.starts_with("no/such.toml: cannot read it"), "{error}");
    }
}
