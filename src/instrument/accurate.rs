//! The flow beside that of a method of fixed step, by which the errors of the method are known.
//!
//! In: a flow. Out: the same by the default method. Never here: what is done with it.

use crate::ensemble::SystemFlow;
use crate::integrate::{METHODS, Settings, Stepping};

/// The same flow by the default method; `None` where the steps follow a tolerance anyway.
pub(super) fn accurate(flow: &SystemFlow) -> Option<SystemFlow> {
    let fixed = flow.method.0.stepping == Stepping::Fixed;
    fixed.then(|| SystemFlow { method: (&METHODS[0], Settings::default()), ..flow.clone() })
}
