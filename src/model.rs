//! A checked system: every name resolved, nothing ambiguous, nothing derived yet.
//!
//! In: what `preset` has read and checked. Out: one [`Model`], the input of `mechanics`. Its
//! expressions live in its own [`Pool`](crate::expr::Pool). Never here: files, spans of TOML, equations of motion.

mod body;
mod claim;
mod constraint;
mod coordinate;
mod description;
mod kinks;
mod literal;
mod occurrence;
mod parameter;
mod picture;
mod ramp;
mod ramped;
mod scope;
mod transformation;
mod unit;

pub use body::{
    Attitude, AttitudeSource, Body, BodyNames, Comparison, Frame, Piece, PieceOrientation, Solid,
};
pub use claim::{
    Expect, ExpectedBracket, ExpectedCount, ExpectedEvent, ExpectedInvariants, ExpectedStep,
    ExpectedValue, Observable,
};
pub use constraint::{Constraint, multiplier_name};
pub use coordinate::Coordinate;
pub use description::{CommonSymbols, Info, Mechanics, Model, NamedEquilibrium, RunSettings};
pub use occurrence::{Direction, EventAction, Impulse, MotionEvent};
pub use parameter::{Parameter, RangeSpacing};
pub use picture::{Follow, Point, Shape, SpacePicture, Variation, View, Viewpoint, WrittenExpr};
pub use ramp::{Ramp, RampRefused, replace_by_ramps};
pub use ramped::{NamedRamp, RampForm, RampPart, RampProgress, Ramped};
pub use scope::{Allowed, Scope};
pub use transformation::{
    ChainPart, CompleteIntegral, GeneratingType, Generator, IntegralConstant, Transformation,
    TransformationLaw,
};
