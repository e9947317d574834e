//! Every message of `xt28.dbc`, typed: physical numbers with their unit in the name, enums where the
//! database names values. Generated.

use core::time::Duration;

use xt28_dbc_model::{Field, Kind};

use crate::codec::{expect, get, put};
use crate::{CanId, DecodeError, EncodeError, Frame, e2e};

include!(concat!(env!("OUT_DIR"), "/messages.rs"));
