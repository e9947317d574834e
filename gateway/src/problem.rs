//! What ends a run with exit code 2: one line that says what, where and the remedy.

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;

use gateway::listen_advice;
use gateway::policy::SpecError;
use xt28_bus::socket_can::{OpenError, SocketError};
use xt28_machine::MachineError;
use xt28_terrain::TerrainError;

/// A fault of usage or of the host.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Problem {
    #[error(transparent)]
    Bus(#[from] OpenError),
    #[error(transparent)]
    Socket(#[from] SocketError),
    #[error(transparent)]
    Machine(#[from] MachineError),
    #[error(transparent)]
    Policy(#[from] SpecError),
    #[error("{address}: cannot listen for a controller: {source}; see --policy, {}", listen_advice(.source))]
    Listen { address: SocketAddr, source: io::Error },
    #[error(transparent)]
    Map(#[from] TerrainError),
    #[error(
        "--map is for who looks at heights; give it with --policy network:FILE or rosbridge:PORT"
    )]
    MapUnused,
    #[error("{path}: cannot open the receiver's port: {source}; see --gnss and its permissions")]
    OpenGnss { path: PathBuf, source: io::Error },
    #[error("cannot read the receiver's port: {0}; plug it in again and restart")]
    ReadGnss(io::Error),
    #[error(
        "{path}: cannot create the log: {source}; give --record a writable path without a log in it"
    )]
    Record { path: PathBuf, source: io::Error },
    #[error("cannot write the log: {0}; is the disk full?")]
    Log(io::Error),
    #[error("cannot start a thread: {0}; is the process restricted?")]
    Thread(io::Error),
    #[error("cannot watch for signals: {0}; is the process restricted?")]
    Signals(io::Error),
    #[error("this policy steers by GNSS; give --gnss the receiver's port, as /dev/ttyACM0")]
    NoGnss,
}
