//! The balance of forces where constraints hold the coordinates: with Lagrange's multipliers, the places on the surface of
//! the constraints at which V is stationary.
//!
//! The unknowns are the coordinates that rest and the velocities of the cyclic ones. The accelerations that the constraints
//! leave must vanish and the velocities that they prescribe, the cyclic momenta have their values, and the coordinates lie on
//! the surface: more equations than unknowns, which agree at an equilibrium.
//!
//! Around one, displacements along the surface are q = N s, with N the directions that the constraints allow. They follow
//! s̈ = K s + C ṡ, and −(Nᵀ M N) K is the second derivative of V, the multipliers' part included, along the surface.
//!
//! In: a phase space, a place. Out: the equations and their derivatives; the motion around a place. Never here: the search.

use nalgebra::{DMatrix, DVector};

use super::error::DynamicsError;
use super::flow_direction::basis_of_range;
use super::phase_space::PhaseSpace;
use crate::num::math;
use crate::system::{ConstraintProjector, Form, MotionError, Rates, State, SurfaceRow, System};

/// What is left of the largest entry where entries of a matrix cancel.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The forces, constraints and momenta of a system whose coordinates are constrained.
pub(super) struct ConstrainedBalance {
    space: PhaseSpace,
    /// The system with a tangent vector for each coordinate and velocity.
    displaced: System,
    rates: Rates,
    projector: ConstraintProjector,
    /// The start (q, q̇), with all vectors.
    like: State,
    /// The coordinates that rest, and the cyclic ones.
    resting: Vec<usize>,
    cyclic: Vec<usize>,
    momenta: Vec<f64>,
}

/// The motion around an equilibrium, along the surface, in units of the coordinates.
pub(super) struct AroundPlace {
    /// ∂(ṡ, s̈)/∂(s, ṡ), in the unit of `time`.
    pub(super) matrix: DMatrix<f64>,
    /// The unit of time, in which the fastest motion is of order one.
    pub(super) time: f64,
    /// The displacements of the coordinates that rest, of each variable of the matrix.
    pub(super) displacements: DMatrix<f64>,
    /// The second derivative of the potential along the surface and the mass matrix there; `None` if a constraint is not
    /// holonomic, so that there is no surface.
    pub(super) potential: Option<(DMatrix<f64>, DMatrix<f64>)>,
}

/// What is known of a place: accelerations, momenta, and their derivatives by (q, q̇).
struct Local {
    acceleration: DVector<f64>,
    acceleration_slope: DMatrix<f64>,
    momentum: DVector<f64>,
    momentum_slope: DMatrix<f64>,
    surface: Vec<SurfaceRow>,
}

impl Local {
    /// ∂A₀/∂q of each constraint A q̇ + A₀ = 0. Where nothing moves A ∂q̈/∂q̇ is its opposite. It is zero where it is but rounding.
    fn prescribed_slopes(&self) -> Vec<Vec<f64>> {
        let degrees = self.acceleration.len();
        let slope = |one: &SurfaceRow, j: usize| {
            let terms =
                (0..degrees).map(|i| one.row[i] * self.acceleration_slope[(i, degrees + j)]);
            let (sum, size) =
                terms.fold((0.0, 0.0), |(sum, size): (f64, f64), x| (sum - x, size + x.abs()));
            if sum.abs() <= ROUNDING * size { 0.0 } else { sum }
        };
        let slopes = |one: &SurfaceRow| (0..degrees).map(|j| slope(one, j)).collect();
        self.surface.iter().map(slopes).collect()
    }

    /// Whether some constraint prescribes a velocity that does not change with the place.
    fn drives_everywhere(&self) -> bool {
        let slopes = self.prescribed_slopes();
        let mut all = self.surface.iter().zip(slopes);
        all.any(|(one, slopes)| one.rate != 0.0 && slopes.iter().all(|x| *x == 0.0))
    }
}

impl ConstrainedBalance {
    /// The balance of the motions that have the cyclic momenta of `start`, and what it has of each constraint on the
    /// velocities that is constant.
    pub(super) fn new(
        space: &PhaseSpace,
        start: &State,
    ) -> Result<ConstrainedBalance, DynamicsError> {
        let (system, parameters) = (space.system(), space.parameters());
        let native = system.convert(start, Form::Velocity, parameters)?;
        let Some(mut projector) = system.projector(parameters) else {
            return Err(DynamicsError::Unsuited("no constraint acts on the motion".to_owned()));
        };
        projector.take_levels(&native);
        let displaced = system.with_tangents(2 * system.degrees());
        let mut rates = displaced.native_rates();
        rates.set_parameters(parameters);
        let cyclic = space.cyclic().to_vec();
        let degrees = system.degrees();
        let resting = (0..degrees).filter(|i| !cyclic.contains(i)).collect();
        let momenta = cyclic.iter().map(|i| start.values[degrees + i]).collect();
        let mut like = displaced.extended(&native, system);
        for i in 0..2 * degrees {
            like.values[displaced.tangent_place(i) + i] = 1.0;
        }
        let space = space.clone();
        let mut balance = ConstrainedBalance {
            space,
            displaced,
            rates,
            projector,
            like,
            resting,
            cyclic,
            momenta,
        };
        let start = balance.start();
        if balance.evaluate(&start, false).is_some_and(|local| local.drives_everywhere()) {
            let why = "a constraint prescribes a velocity, which does not depend on the place, and nothing rests under it";
            return Err(DynamicsError::Unsuited(why.to_owned()));
        }
        Ok(balance)
    }

    pub(super) fn unknowns(&self) -> Vec<usize> {
        let degrees = self.space.system().degrees();
        self.resting.iter().copied().chain(self.cyclic.iter().map(|i| degrees + i)).collect()
    }

    /// The start as (q, q̇), where all that rests does.
    pub(super) fn start(&self) -> Vec<f64> {
        let degrees = self.space.system().degrees();
        let mut variables = self.like.values[..2 * degrees].to_vec();
        self.resting.iter().for_each(|i| variables[degrees + i] = 0.0);
        variables
    }

    /// A state (q, q̇) in the variables of the space.
    pub(super) fn state(&self, variables: &[f64]) -> Result<State, MotionError> {
        let system = self.space.system();
        let place = system.extended(&self.place(variables), &self.displaced);
        system.convert(&place, Form::Momentum, self.space.parameters())
    }

    /// The same with all vectors.
    fn place(&self, variables: &[f64]) -> State {
        let mut place = self.like.clone();
        for (i, &x) in variables.iter().enumerate() {
            (place.values[i], place.carry[i]) = (x, 0.0);
        }
        place
    }

    fn evaluate(&mut self, variables: &[f64], with_momenta: bool) -> Option<Local> {
        let degrees = self.space.system().degrees();
        let place = self.place(variables);
        let mut out = vec![0.0; self.displaced.state_len()];
        self.rates.evaluate(place.time, &place.values, &mut out).ok()?;
        let columns = |numbers: &[f64]| {
            DMatrix::from_fn(degrees, 2 * degrees, |i, j| {
                numbers[self.displaced.tangent_place(j) + degrees + i]
            })
        };
        let rates = |numbers: &[f64]| DVector::from_column_slice(&numbers[degrees..2 * degrees]);
        let (momentum, momentum_slope) = if with_momenta || !self.cyclic.is_empty() {
            let parameters = self.space.parameters();
            let canonical = self.displaced.convert(&place, Form::Momentum, parameters).ok()?;
            (rates(&canonical.values), columns(&canonical.values))
        } else {
            (DVector::zeros(0), DMatrix::zeros(0, 0))
        };
        Some(Local {
            acceleration: rates(&out),
            acceleration_slope: columns(&out),
            momentum,
            momentum_slope,
            surface: self.projector.surface(&place),
        })
    }

    /// The equations and their derivatives by the unknowns, in these units of (q, q̇).
    pub(super) fn equations(
        &mut self,
        variables: &[f64],
        units: &[f64],
    ) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let local = self.evaluate(variables, false)?;
        let degrees = self.space.system().degrees();
        let unknowns = self.unknowns();
        let mut rows: Vec<(f64, Vec<f64>)> = Vec::new();
        for &i in &self.resting {
            let slopes = unknowns.iter().map(|&j| {
                let slope = local.acceleration_slope[(i, j)];
                slope * units[j] / units[i]
            });
            rows.push((local.acceleration[i] / units[i], slopes.collect()));
        }
        // the other rows are made as large as these
        let steepest =
            rows.iter().flat_map(|row| &row.1).fold(0.0_f64, |most, x| most.max(x.abs()));
        let steepest = if steepest > 0.0 { steepest } else { 1.0 };
        let mut push = |value: f64, slopes: Vec<f64>| {
            let largest = slopes.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let scale = if largest > 0.0 { steepest / largest } else { 1.0 };
            rows.push((value * scale, slopes.into_iter().map(|x| x * scale).collect()));
        };
        for (&i, &momentum) in self.cyclic.iter().zip(&self.momenta) {
            let slopes = unknowns.iter().map(|&j| local.momentum_slope[(i, j)] * units[j]);
            push(local.momentum[i] - momentum, slopes.collect());
        }
        for (one, by_place) in local.surface.iter().zip(local.prescribed_slopes()) {
            // the velocities that it prescribes vanish too
            if one.rate != 0.0 || by_place.iter().any(|x| *x != 0.0) {
                let slope = |&j: &usize| if j < degrees { by_place[j] * units[j] } else { 0.0 };
                let slopes = unknowns.iter().map(slope);
                push(one.rate, slopes.collect());
            }
            let Some(distance) = one.distance else { continue };
            let slope = |&j: &usize| if j < degrees { one.row[j] * units[j] } else { 0.0 };
            let slopes = unknowns.iter().map(slope);
            push(distance, slopes.collect());
        }
        let values = DVector::from_iterator(rows.len(), rows.iter().map(|row| row.0));
        let slopes = DMatrix::from_fn(rows.len(), unknowns.len(), |i, j| rows[i].1[j]);
        values.iter().chain(slopes.iter()).all(|x| x.is_finite()).then_some((values, slopes))
    }

    /// The motion around an equilibrium, in these units of the coordinates.
    pub(super) fn around(&mut self, variables: &[f64], units: &[f64]) -> Option<AroundPlace> {
        let local = self.evaluate(variables, true)?;
        let degrees = self.space.system().degrees();
        let rates = |indices: &[usize]| indices.iter().map(|i| degrees + i).collect::<Vec<_>>();
        let (resting, cyclic) = (&self.resting, &self.cyclic);
        let (moving, going) = (rates(resting), rates(cyclic));
        let part = |matrix: &DMatrix<f64>, rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |i, j| matrix[(rows[i], columns[j])])
        };
        let (a, p) = (&local.acceleration_slope, &local.momentum_slope);
        let (mut k, mut c) = (part(a, resting, resting), part(a, resting, &moving));
        let mut mass = part(p, resting, &moving);
        if !cyclic.is_empty() {
            // their velocities change so that their momenta do not
            let inverse = part(p, cyclic, &going).try_inverse()?;
            let by_place = -(&inverse * part(p, cyclic, resting));
            let by_rate = -(&inverse * part(p, cyclic, &moving));
            let effect = part(a, resting, &going);
            k += &effect * by_place;
            c += &effect * &by_rate;
            mass += part(p, resting, &going) * by_rate;
        }
        let unit = |i: usize| units[resting[i]];
        let count = resting.len();
        let in_units =
            |m: DMatrix<f64>| DMatrix::from_fn(count, count, |i, j| m[(i, j)] * unit(j) / unit(i));
        let (k, c) = (in_units(k), in_units(c));
        let mass = DMatrix::from_fn(count, count, |i, j| mass[(i, j)] * unit(i) * unit(j));
        let allowed = |which: &dyn Fn(&&SurfaceRow) -> bool| {
            let rows: Vec<&SurfaceRow> = local.surface.iter().filter(which).collect();
            let entry = |i: usize, j: usize| rows[i].row[resting[j]] * unit(j);
            allowed_directions(&DMatrix::from_fn(rows.len(), count, entry))
        };
        let along = allowed(&|one| one.distance.is_some())?;
        let directions = allowed(&|_| true)?;
        // the velocities that the constraints prescribe beside the place
        let row = |i: usize, j: usize| local.surface[i].row[resting[j]] * unit(j);
        let rows = DMatrix::from_fn(local.surface.len(), count, row);
        let slopes = local.prescribed_slopes();
        let slope = |i: usize, j: usize| -slopes[i][resting[j]] * unit(j);
        let slope = DMatrix::from_fn(rows.nrows(), count, slope);
        let prescribed = least_velocities(&rows, &slope)? * &along;
        let (places, speeds) = (along.ncols(), directions.ncols());
        let mut matrix = DMatrix::zeros(places + speeds, places + speeds);
        // what cancels but for rounding on the way to the surface is zero
        let projected = |m: &DMatrix<f64>, right: &DMatrix<f64>| {
            let most = ROUNDING * m.amax();
            (directions.transpose() * m * right).map(|x| if x.abs() <= most { 0.0 } else { x })
        };
        let stiffness = projected(&k, &along) + projected(&c, &prescribed);
        let time = time_unit(&k, &c, &prescribed);
        matrix
            .view_mut((0, places), (places, speeds))
            .copy_from(&(along.transpose() * &directions));
        matrix
            .view_mut((0, 0), (places, places))
            .copy_from(&(along.transpose() * &prescribed * time));
        matrix.view_mut((places, 0), (speeds, places)).copy_from(&(&stiffness * time * time));
        let damping = projected(&c, &directions) * time;
        matrix.view_mut((places, places), (speeds, speeds)).copy_from(&damping);
        let mut displacements = DMatrix::zeros(count, places + speeds);
        displacements.view_mut((0, 0), (count, places)).copy_from(&along);
        let potential = (places == speeds).then(|| {
            let mass = directions.transpose() * mass * &directions;
            (-(&mass * stiffness), mass)
        });
        Some(AroundPlace { matrix, time, displacements, potential })
    }
}

/// The unit of time in which motions with this stiffness, this damping and these prescribed rates are neither fast nor slow: a power of
/// two, so that no digit changes.
fn time_unit(stiffness: &DMatrix<f64>, damping: &DMatrix<f64>, rates: &DMatrix<f64>) -> f64 {
    let fastest = stiffness.amax().sqrt().max(damping.amax()).max(rates.amax());
    if fastest.is_normal() { math::powi(2.0, -math::log2(fastest).round() as i32) } else { 1.0 }
}

/// The smallest velocities that these rows, which are independent, take to these values.
fn least_velocities(rows: &DMatrix<f64>, values: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    if values.iter().all(|x| *x == 0.0) {
        return Some(DMatrix::zeros(rows.ncols(), values.ncols()));
    }
    let square = (rows * rows.transpose()).try_inverse()?;
    Some(rows.transpose() * square * values)
}

/// Orthonormal directions that all rows of a matrix, which are independent, take to zero.
fn allowed_directions(rows: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let (count, columns) = rows.shape();
    let unit = DMatrix::identity(columns, columns);
    if count == 0 {
        return Some(unit);
    }
    // rows of equal size, so that none is taken for dependent
    let scaled = DMatrix::from_fn(count, columns, |i, j| rows[(i, j)] / rows.row(i).amax());
    let square = (&scaled * scaled.transpose()).try_inverse()?;
    let projection = unit - scaled.transpose() * square * scaled;
    Some(basis_of_range(&projection, columns - count))
}
