//! The server side of rosbridge v2: topics and services as JSON over WebSocket, without ROS.
//!
//! roslibpy, roslibjs and whatever else speaks the protocol of the rosbridge suite can subscribe to what the
//! owner of a [`Server`] publishes, publish what it takes, and call its services. The [`Catalogue`] says what
//! there is; nothing else exists, and a client that asks for it is told so by a `status` message.
//!
//! | Module | What |
//! |---|---|
//! | [`Catalogue`] | topics and services with their types |
//! | [`Bridge`] | the protocol, sans-IO: texts in, texts and events out |
//! | [`Server`] | the socket: one thread that sleeps until something happens |
//!
//! Of the protocol's operations there are `advertise`, `unadvertise`, `publish`, `subscribe` (with
//! `throttle_rate`), `unsubscribe`, `call_service` and `set_level`. Messages are JSON: other compressions,
//! fragments, and services or actions that a client would offer are refused. Of rosapi there are `topics`,
//! `topic_type`, `services`, `service_type` and `get_time`.
//!
//! Time is the publisher's: a message goes out with the time it was published at, and `throttle_rate` counts by that.
#![forbid(unsafe_code)]

mod bridge;
mod catalogue;
mod connection;
mod errand;
mod host;
mod op;
mod printable;
mod queue;
mod rationed;
mod rosapi;
mod server;
mod session;

pub use bridge::{Bridge, Call, ClientId, Event, Heard};
pub use catalogue::{Catalogue, Distil, Service, Taken, Topic};
pub use printable::printable;
pub use server::Server;
