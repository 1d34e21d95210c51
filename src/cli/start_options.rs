//! The options that change where a motion begins, or how it is integrated.
//!
//! In: options. Out: what they give, as it is written. Never here: which system it is for.

use super::assignment::Assignment;
use super::method_options::MethodOptions;

/// What differs from the file where the motion begins.
#[derive(Debug, clap::Args)]
#[group(skip)]
pub(super) struct StartOptions {
    /// Sets a parameter.
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub(super) set: Vec<Assignment>,
    /// Sets an initial value: a coordinate `x`, a velocity `x'` or a momentum `p_x`.
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub(super) init: Vec<Assignment>,
    #[command(flatten)]
    pub(super) integrator: MethodOptions,
}
