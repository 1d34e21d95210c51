//! What is done with a motion on the way to its Lyapunov exponents, whoever takes its steps.
//!
//! Tangent vectors are carried along and made orthonormal again and again; the logarithms of their growth add up. One more
//! vector, in general position, is never turned: MEGNO is that of its length.
//!
//! In: a start, then each step of the motion from there with its vectors. Out: the vectors to begin with, after a step those
//! to continue with where they are renewed, at last the growth. Never here: steps, verdicts.

use nalgebra::{DMatrix, DMatrixView, DVector};

use super::displacement_units::{displacement_units, scaled};
use super::error::DynamicsError;
use super::excursion::{Departure, Excursion};
use super::flow_direction::{FlowDirection, basis_of_range};
use super::flow_map::Divergence;
use super::megno::Megno;
use super::phase_space::{NOTHING_MOVES, PhaseSpace};
use super::step_growth::StepGrowth;
use super::tangent_growth::TangentGrowth;
use super::tangent_step::TangentStep;
use super::transverse::{self, Removed};
use crate::integrate::Settings;
use crate::num::math;
use crate::system::State;

/// Vectors are made orthonormal where one has grown or shrunk by this factor.
pub(super) const GROWN: f64 = 8.0;

/// Vectors are made orthonormal as well where the part of one across those before it is less than this of its length:
/// on a limit cycle all keep their lengths and turn into the direction of the flow.
const FLAT: f64 = 1e-4;

/// The steps after which that is checked, since a check costs as much as a part of a step.
const CHECKED: u64 = 4;

/// The least number of times that vectors are made orthonormal on the way.
pub(super) const LEAST_ROUNDS: f64 = 256.0;

/// The parts of a step at which MEGNO is summed.
const MEGNO_PARTS: u32 = 4;

pub(super) struct CarriedMotion {
    pub(super) settings: Settings,
    /// Whether all steps are equal.
    pub(super) fixed: bool,
    pub(super) steps: u64,
}

/// The course of a motion and its vectors.
pub(super) struct LyapunovCourse {
    direction: FlowDirection,
    excursion: Excursion,
    what: Removed,
    units: DVector<f64>,
    in_units: DVector<f64>,
    /// The vectors that are made orthonormal.
    count: usize,
    until: f64,
    /// The longest time between two renewals.
    round: f64,
    growth: TangentGrowth,
    megno: Megno,
    single_steps: StepGrowth,
    volume: Option<PhaseVolume>,
    steps: u64,
}

/// How the volume of phase space changes along a motion by Liouville's theorem, in logarithms.
struct PhaseVolume {
    divergence: Divergence,
    /// ∫ div f dt up to the end of the last step.
    flowed: f64,
    /// The same with all impulses up to where the vectors were renewed last.
    renewed: f64,
}

impl LyapunovCourse {
    /// A course from a state of a space until a time, and the vectors to be carried from there: across the directions whose exponents
    /// are zero where a motion keeps returning, or if `all` are asked for in all directions.
    ///
    /// # Errors
    /// Returns an error if the motion has no direction there, or nothing can move.
    pub(super) fn begin(
        space: &PhaseSpace,
        start: &State,
        until: f64,
        all: bool,
    ) -> Result<(LyapunovCourse, DMatrix<f64>), DynamicsError> {
        if until <= start.time {
            return Err(DynamicsError::WrongRequest(
                "exponents are means over the time to come: the end lies after the start"
                    .to_owned(),
            ));
        }
        let n = space.dimension();
        let mut direction = FlowDirection::new(space);
        let moves = direction.moves(start, until - start.time)?;
        let what = if all { Removed::Nothing } else { removed(space, moves) };
        let units = displacement_units(space, start, until - start.time);
        let rates = direction.at(start)?.component_div(&units);
        let (allowed, dimension) = space.allowed_displacements(start)?;
        if dimension == 0 {
            return Err(DynamicsError::Unsuited(NOTHING_MOVES.to_owned()));
        }
        let frame = if space.is_constrained() {
            transverse::frame_within(&basis_of_range(&allowed, dimension), &rates, what)
        } else {
            transverse::frame(&rates, what, space.is_hamiltonian())
        };
        let count = frame.ncols();
        // one more vector, in general position, that is never turned: for MEGNO
        let free = DVector::from_fn(n, |i, _| 0.5 + math::sin(2.4 * (i as f64 + 1.0)).abs());
        let free = allowed * free;
        let mut vectors = frame.insert_column(count, 0.0);
        vectors.set_column(count, &free.normalize());
        let vectors = scaled(&vectors, &units);
        let mut excursion = Excursion::begin(space, (start, until), &units, moves);
        if count == 0 {
            excursion.of_one_degree();
        }
        let is_whole = count == n && !space.is_constrained();
        let volume = is_whole.then(|| PhaseVolume {
            divergence: Divergence::rough(space),
            flowed: 0.0,
            renewed: 0.0,
        });
        let course = LyapunovCourse {
            volume,
            direction,
            excursion,
            what,
            in_units: units.map(|unit| 1.0 / unit),
            units,
            count,
            until,
            round: (until - start.time) / LEAST_ROUNDS,
            growth: TangentGrowth { times: vec![start.time], logarithms: vec![vec![0.0; count]] },
            megno: Megno::new(start.time),
            single_steps: StepGrowth::default(),
            steps: 0,
        };
        Ok((course, vectors))
    }

    /// The number of vectors to be carried.
    pub(super) fn vectors(&self) -> usize {
        self.count + 1
    }

    /// Which directions are taken out.
    pub(super) fn removed(&self) -> Removed {
        self.what
    }

    /// How the motion departs from one for which the directions that were taken out have the exponent 0.
    pub(super) fn departure(&self) -> Option<Departure> {
        self.excursion.departure().filter(|_| self.what != Removed::Nothing)
    }

    /// The motion is known to be back where it began.
    pub(super) fn has_closed(&mut self) {
        self.excursion.has_closed();
    }

    /// The way of the motion.
    pub(super) fn excursion(&self) -> &Excursion {
        &self.excursion
    }

    pub(super) fn growth(&self) -> &TangentGrowth {
        &self.growth
    }

    pub(super) fn single_steps(&self) -> &StepGrowth {
        &self.single_steps
    }

    /// The logarithms of the factors by which the volume of all vectors has grown, and by which that of phase space has; `None`
    /// where the vectors are not in all directions.
    pub(super) fn volumes(&self) -> Option<[f64; 2]> {
        let volume = self.volume.as_ref()?;
        Some([self.growth.logarithms.last()?.iter().sum(), volume.renewed])
    }

    pub(super) fn megno(&self) -> &Megno {
        &self.megno
    }

    /// Observes a step. Returns the state and the vectors to continue from, where they are others than those reached.
    ///
    /// # Errors
    /// Returns an error if the states or the vectors in it cannot be evaluated.
    pub(super) fn observe(
        &mut self,
        space: &PhaseSpace,
        step: &mut dyn TangentStep,
    ) -> Result<Option<(State, DMatrix<f64>)>, DynamicsError> {
        let (begin, end) = step.interval();
        if let Some(volume) = &mut self.volume {
            volume.flowed += volume.divergence.along(space, &mut *step, [begin, end])?;
        }
        let mut at_end = None;
        for part in 1..=MEGNO_PARTS {
            let now = begin + (end - begin) * f64::from(part) / f64::from(MEGNO_PARTS);
            let free = if now == end {
                let (_, vectors) = at_end.insert(step.at(end)?);
                vectors.column(self.count).into_owned()
            } else {
                step.vector(self.count, now)?
            };
            let size = math::ln(free.component_mul(&self.in_units).norm());
            self.megno.add(now, size);
            if part == MEGNO_PARTS {
                self.single_steps.reach(end, size);
            }
        }
        let (state, vectors) = match at_end {
            Some(found) => found,
            None => step.at(end)?,
        };
        self.excursion.reaches(space, &state);
        let mut vectors = scaled(&vectors, &self.in_units);
        let last = self.growth.times.len() - 1;
        let due = end - self.growth.times[last] >= self.round || end >= self.until;
        let sizes = vectors.column_iter().map(|v| v.norm());
        let due = due || sizes.into_iter().any(|size| !(1.0 / GROWN..GROWN).contains(&size));
        self.steps += 1;
        let checked = self.count > 1 && self.steps.is_multiple_of(CHECKED);
        let due = due || checked && is_flat(&vectors.columns(0, self.count));
        if !due || step.awaits_occurrence() {
            if self.excursion.wants_rates() {
                self.excursion.moves_on(space, &state, &mut self.direction)?;
            }
            return Ok(None);
        }
        let rates = self.excursion.moves_on(space, &state, &mut self.direction)?;
        let rates = rates.component_div(&self.units);
        let free = vectors.column(self.count).into_owned();
        self.megno.rescale(free.norm());
        self.single_steps.renew();
        let mut turned = vectors.columns(0, self.count).into_owned();
        let lengths = if space.is_constrained() {
            let (allowed, dimension) = space.allowed_displacements(&state)?;
            let basis = basis_of_range(&allowed, dimension);
            transverse::orthonormalise_within(&mut turned, &basis, &rates, self.what)
        } else {
            transverse::orthonormalise(&mut turned, &rates, self.what)
        };
        let sums = self.growth.logarithms[last].iter().zip(&lengths);
        let now = sums.map(|(sum, x)| sum + math::ln(*x)).collect();
        if let Some(volume) = &mut self.volume {
            volume.renewed = volume.flowed + step.jump_logarithm();
        }
        self.growth.times.push(end);
        self.growth.logarithms.push(now);
        vectors.columns_mut(0, self.count).copy_from(&turned);
        vectors.set_column(self.count, &free.normalize());
        Ok(Some((state, scaled(&vectors, &self.units))))
    }
}

/// Whether one of some vectors lies nearly in the space of those before it.
fn is_flat(vectors: &DMatrixView<'_, f64>) -> bool {
    let across = vectors.clone_owned().qr().unpack_r();
    vectors.column_iter().enumerate().any(|(i, vector)| {
        let part = across.get((i, i)).map_or(0.0, |x| x.abs());
        part < FLAT * vector.norm()
    })
}

/// Which directions are taken out.
fn removed(space: &PhaseSpace, moves: bool) -> Removed {
    match (space.is_hamiltonian(), moves && space.is_autonomous()) {
        (true, true) => Removed::FlowAndEnergy,
        (false, true) if space.is_conservative() => Removed::Flow,
        // with friction a motion may come to rest, and has no direction there
        _ => Removed::Nothing,
    }
}
