//! What there is: topics and services by their names in ROS, with their types.

use serde_json::Value;

/// What is left of a message for the owner, or why it is none. It runs on the server's thread: what a client sends is
/// read and thrown away there, however much it is, and the owner gets what it can use.
pub type Distil = fn(&Value) -> Result<Value, String>;

/// A topic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Topic {
    /// Its name, from the root, as `/xt28/status`.
    pub name: &'static str,
    /// The type of its messages, as `std_msgs/String`.
    pub kind: &'static str,
}

/// A topic that the owner takes.
#[derive(Clone, Copy, Debug)]
pub struct Taken {
    /// Its name and type.
    pub topic: Topic,
    /// What is taken of a message.
    pub distil: Distil,
}

/// A service.
#[derive(Clone, Copy, Debug)]
pub struct Service {
    /// Its name, from the root.
    pub name: &'static str,
    /// Its type, as `std_srvs/Trigger`.
    pub kind: &'static str,
    /// Whether a call goes before all else that waits for the owner.
    pub urgent: bool,
    /// What is taken of a call's arguments.
    pub distil: Distil,
}

/// All that clients may use.
#[derive(Clone, Copy, Debug)]
pub struct Catalogue {
    /// Topics that the owner publishes and clients subscribe to.
    pub published: &'static [Topic],
    /// Topics that clients publish and the owner takes.
    pub taken: &'static [Taken],
    /// Services that clients call.
    pub services: &'static [Service],
}

impl Catalogue {
    /// Every topic, published or taken.
    pub(crate) fn topics(&self) -> impl Iterator<Item = &'static Topic> {
        self.published.iter().chain(self.taken.iter().map(|taken| &taken.topic))
    }
}

/// Whether `asked`, as a client spells it, is `name`: from the root, or relative to it.
pub(crate) fn is_name(asked: &str, name: &str) -> bool {
    asked == name || Some(asked) == name.strip_prefix('/')
}

/// Whether `asked` is `kind`: types of ROS 2 have `msg` or `srv` in their middle.
pub(crate) fn is_kind(asked: &str, kind: &str) -> bool {
    let mut parts = asked.split('/').filter(|part| !matches!(*part, "msg" | "srv"));
    kind.split('/').all(|part| parts.next() == Some(part)) && parts.next().is_none()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_may_be_relative_to_the_root_and_types_of_either_ros() {
        assert!(is_name("/xt28/status", "/xt28/status") && is_name("xt28/status", "/xt28/status"));
        assert!(!is_name("status", "/xt28/status") && !is_name("", "/xt28/status"));
        assert!(is_kind("std_msgs/String", "std_msgs/String"));
        assert!(is_kind("std_msgs/msg/String", "std_msgs/String"));
        assert!(!is_kind("std_msgs/Bool", "std_msgs/String") && !is_kind("", "std_msgs/String"));
        assert!(!is_kind("std_msgs/String/x", "std_msgs/String"));
    }
}
