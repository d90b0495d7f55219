//! Failing links and devices in virtual time.

use super::*;
