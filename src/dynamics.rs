//! What follows from the derivatives of a motion: its flow map, its exponents, the periodic orbits and
//! equilibria near it.
//!
//! In: a system, a method, a state. Out: numbers, with what they are sure of. Never here: text,
//! files, threads.

mod action;
mod amplified_rounding;
mod bare_motion;
mod carrier;
mod casimirs;
mod closing;
mod conformal;
mod conjugate;
mod constrained_balance;
mod continuation;
mod direction;
mod displacement_units;
mod drive;
mod driven_orbit;
mod eigenvalue_error;
mod end_state;
mod equilibria;
mod equilibrium;
mod equilibrium_names;
mod equilibrium_units;
mod error;
mod excursion;
mod family;
mod family_course;
mod first_return;
mod flow_course;
mod flow_map;
mod frequency_drift;
mod gali;
mod halton;
mod kind;
mod levels;
mod linear;
mod lobatto;
mod loop_action;
mod lyapunov;
mod lyapunov_batch;
mod lyapunov_course;
mod megno;
mod method_step;
mod module_basis;
mod newton;
mod orbit;
mod orbit_multipliers;
mod orbit_stability;
mod orbit_units;
mod path_search;
mod phase_space;
mod power;
mod principle;
mod regular_step;
mod resonance;
mod return_growth;
mod rotation;
mod sampled_motion;
mod sampled_spectrum;
mod search_budget;
mod singular_orbit;
mod small_oscillation;
mod spectral_fit;
mod spectral_line;
mod spectrum;
mod stationary_path;
mod step_growth;
mod symplectic;
mod tangent_growth;
mod tangent_step;
mod torus;
mod transverse;
mod turning;
mod unclosed_motion;
mod unit_circle;
mod unresolved_lines;
mod variation;
mod vector_fidelity;
mod virtual_work;
mod wandering;

pub use action::{Lagrangian, Path};
pub use carrier::Carrier;
pub use conformal::conformal_rate;
pub use conjugate::{conjugate_points, conjugate_points_at_energy};
pub use continuation::DrivePeriod;
pub use drive::drive_period;
pub use driven_orbit::{driven_orbit, nearest_driven_orbit};
pub use equilibria::{equilibria, equilibria_watched, with_virtual_work};
pub use equilibrium::{Equilibria, Equilibrium};
pub use equilibrium_names::name_equilibria;
pub use error::DynamicsError;
pub use family::{Along, Bifurcation, Family, Member, NOT_ISOLATED};
pub use family_course::{FamilyCourse, driven_family, family};
pub use flow_course::{FlowMoment, flow_course};
pub use flow_map::{FlowMap, flow_map};
pub use frequency_drift::{FrequencyDrift, frequency_drift};
pub use gali::{Gali, gali};
pub use kind::Kind;
pub use lyapunov::{Chaos, Lyapunov, lyapunov};
pub use lyapunov_batch::{LyapunovOrbit, lyapunov_of_all};
pub use method_step::MethodStep;
pub use newton::Fixed;
pub use orbit::{Orbit, nearest_orbit, periodic_orbit};
pub use orbit_stability::{NOTICED_ROUNDING, OrbitStability};
pub use path_search::stationary_path_between;
pub use phase_space::{PhaseSpace, VectorField};
pub use principle::{Hamiltonian, abbreviated_action, action_at_energy};
pub use return_growth::{ReturnGrowth, growth_after, return_growth};
pub use rotation::{NoRotation, Rotation, Turning, angle_rotation, rotation};
pub use sampled_motion::MotionSpan;
pub use sampled_spectrum::{NoSpectrum, SampledSpectrum, SpectrumRequest, sampled_spectrum};
pub use small_oscillation::Mode;
pub use spectral_line::SpectralLine;
pub use spectrum::{MeanRate, Spectrum, independent_frequencies, mean_rate, spectrum};
pub use stationary_path::{
    PathKind, StationaryPath, morse_index, nearest_stationary_path, stationary_path,
};
pub use transverse::Removed;
pub use unclosed_motion::explained;
pub use variation::{
    EndSlope, VARIATIONS, VariedAction, varied_abbreviated_action, varied_action,
    varied_phase_action,
};
pub use virtual_work::VirtualWork;
