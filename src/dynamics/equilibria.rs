//! Equilibria and the small oscillations about them.
//!
//! In: a phase space and where to look. Out: every place in reach where the rates vanish; with
//! cyclic coordinates also where all others rest while these go on with their momenta (relative
//! equilibria), with kind, eigenvalues, frequencies and modes. Never here: text.
//!
//! The places are found by Newton's method with many beginnings (a sequence of Halton's), so that
//! what is found is certain and what is not found is likely, but not certain, to be absent. The
//! kind is that of the effective potential: the least energy at fixed coordinates, whose second
//! derivative is H_qq − H_qp H_pp⁻¹ H_pq.

use nalgebra::{DMatrix, DVector};

use super::error::DynamicsError;
use super::linear;
use super::phase_space::{PhaseSpace, VectorField};
use super::virtual_work::{VirtualWork, virtual_work};
use crate::mechanics::Equations;
use crate::model::Model;
use crate::num::math;
use crate::system::{Form, MotionErrorKind, State};

/// The number of beginnings of the search, and of its steps.
const BEGINNINGS: usize = 600;
const STEPS: usize = 60;

/// How far around its centre a coordinate without period is searched, in its size there plus its
/// unit.
const RADII: [f64; 5] = [0.5, 1.5, 4.0, 12.0, 40.0];

/// How many of these are searched where the units are ordinary. In other units a start says how large a coordinate is there,
/// which may be a small part of what the forces reach over.
const ORDINARY_RADII: usize = 3;

/// A rate counts as zero up to this part of what the variables can cause.
const ZERO: f64 = 1e-12;

/// Half a turn itself is not taken for its opposite by rounding.
const HALF_A_TURN: f64 = 0.5 + 1e-9;

/// Two places are the same up to this distance relative to their size plus their unit.
const SAME: f64 = 1e-7;

/// An eigenvalue counts as zero up to this part of the largest.
const VANISHES: f64 = 1e-8;

/// A coordinate whose start is smaller or larger than 1 by no more than this factor has the unit 1, any
/// other one the size of its start, and one that starts at 0 that of the largest of the others; the
/// units of momenta follow.
const ORDINARY: f64 = 1e3;

/// The largest number of equilibria.
const MOST: usize = 100;

/// What the effective potential does at an equilibrium.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// It grows in all directions.
    Minimum,
    /// It grows in some and falls in others.
    Saddle,
    /// It falls in all directions.
    Maximum,
    /// It changes by less than a square in some direction.
    Degenerate,
}

/// A small oscillation.
#[derive(Clone, PartialEq, Debug)]
pub struct Mode {
    /// Its angular frequency.
    pub frequency: f64,
    /// The displacement of each coordinate, the largest is 1: its part in phase with that …
    pub in_phase: Vec<f64>,
    /// … and the part a quarter of a period earlier.
    pub quadrature: Vec<f64>,
}

/// An equilibrium.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    /// The variables.
    pub variables: Vec<f64>,
    /// The energy.
    pub energy: f64,
    /// What the effective potential does there; `None` for brackets.
    pub kind: Option<Kind>,
    /// The eigenvalues of the linearised motion, of the coordinates that are not cyclic.
    pub eigenvalues: Vec<[f64; 2]>,
    /// The small oscillations, the slowest first.
    pub modes: Vec<Mode>,
    /// Whether nothing grows in the linearised motion; `None` where zero eigenvalues leave it open.
    pub stable: Option<bool>,
    /// The rates of the cyclic coordinates, by index.
    pub rates: Vec<(usize, f64)>,
    /// The forces that balance there, once [`with_virtual_work`] has written them.
    pub work: Vec<VirtualWork>,
}

/// What a search has found.
#[derive(Clone, Debug)]
pub struct Equilibria {
    /// The equilibria by energy.
    pub found: Vec<Equilibrium>,
    /// The coordinates in which the law is periodic, with the period: of places that differ by it one is found.
    pub periods: Vec<(usize, f64)>,
    /// Whether the search was cancelled.
    pub cancelled: bool,
}

/// Writes into each equilibrium the forces that balance there.
pub fn with_virtual_work(law: (&Model, &Equations), parameters: &[f64], found: &mut [Equilibrium]) {
    let places: Vec<_> = found.iter().map(|one| (&one.variables[..], &one.rates[..])).collect();
    let works = virtual_work(law, parameters, &places);
    for (one, work) in found.iter_mut().zip(works) {
        one.work = work;
    }
}

/// Searches around the coordinates of `start`; cyclic coordinates have its momenta.
///
/// # Errors
/// Returns an error if the law of motion depends on time.
pub fn equilibria(space: &PhaseSpace, start: &State) -> Result<Equilibria, DynamicsError> {
    equilibria_watched(space, start, &mut |_, _| ())
}

/// Like [`equilibria`]; after each of its beginnings it hands on how many of all are done.
///
/// # Errors
/// Returns an error if the law of motion depends on time.
pub fn equilibria_watched(
    space: &PhaseSpace,
    start: &State,
    look: &mut dyn FnMut(usize, usize),
) -> Result<Equilibria, DynamicsError> {
    if !space.is_autonomous() {
        return Err(DynamicsError::Unsuited(
            "the law of motion depends on time, and nothing stays at rest in it".to_owned(),
        ));
    }
    let mut search = EquilibriumSearch::new(space, start);
    let mut found: Vec<Equilibrium> = Vec::new();
    let mut cancelled = false;
    for beginning in 0..BEGINNINGS {
        if space.system().cancel().is_cancelled() {
            cancelled = true;
            break;
        }
        look(beginning, BEGINNINGS);
        let Some(variables) = search.from(beginning) else { continue };
        if found.iter().any(|known| search.alike(&known.variables, &variables)) {
            continue;
        }
        let Some(one) = search.described(variables)? else { continue };
        // of a family of equilibria one is enough
        let family = one.kind == Some(Kind::Degenerate)
            && found.iter().any(|known| {
                let size = known.energy.abs() + 1.0;
                known.kind == one.kind && (known.energy - one.energy).abs() <= SAME * size
            });
        if !family {
            found.push(one);
        }
        if found.len() == MOST {
            break;
        }
    }
    found.sort_by(|a, b| a.energy.total_cmp(&b.energy));
    let periods = search.resting.iter().filter_map(|&i| Some((i, space.turns()[i]?))).collect();
    Ok(Equilibria { found, periods, cancelled })
}

struct EquilibriumSearch<'a> {
    space: &'a PhaseSpace,
    start: &'a State,
    field: VectorField,
    /// The variables that rest, by index.
    resting: Vec<usize>,
    /// The cyclic coordinates.
    cyclic: Vec<usize>,
    /// The number of coordinates, or of the variables of brackets.
    degrees: usize,
    /// The unit of each variable.
    units: Vec<f64>,
}

impl<'a> EquilibriumSearch<'a> {
    fn new(space: &'a PhaseSpace, start: &'a State) -> EquilibriumSearch<'a> {
        let degrees = space.system().degrees();
        let canonical = space.form() == Form::Momentum;
        let cyclic = if canonical { space.cyclic().to_vec() } else { Vec::new() };
        let resting = (0..space.dimension()).filter(|i| !cyclic.contains(&(i % degrees))).collect();
        let mut field = space.vector_field();
        let units = units(space, start, &mut field);
        EquilibriumSearch { space, start, field, resting, cyclic, degrees, units }
    }

    /// How far around its centre a coordinate is searched.
    fn radii(&self) -> &'static [f64] {
        let mut lengths = (0..self.degrees).filter(|&i| self.space.turns()[i].is_none());
        let ordinary = lengths.all(|i| self.units[i] == 1.0);
        if ordinary { &RADII[..ORDINARY_RADII] } else { &RADII }
    }

    /// The variables at which a search begins: the start itself, then places around it.
    fn beginning(&self, index: usize) -> Vec<f64> {
        let mut variables = self.space.variables(self.start).to_vec();
        let canonical = self.space.form() == Form::Momentum;
        let radii = self.radii();
        let radius = radii[index % radii.len()];
        for (k, &i) in self.resting.iter().enumerate() {
            if canonical && i >= self.degrees {
                variables[i] = 0.0;
            } else if index > 0 {
                let part = halton(index, PRIMES[k % PRIMES.len()]);
                let centre = variables[i];
                variables[i] += match self.space.turns()[i] {
                    Some(period) => (part - 0.5) * period,
                    None => (2.0 * part - 1.0) * radius * (self.units[i] + centre.abs()),
                };
            }
        }
        variables
    }

    /// The same in the units of the variables.
    fn look_in_units(&mut self, variables: &[f64]) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let (mut f, mut df) = self.look(variables)?;
        let unit = |k: usize| self.units[self.resting[k]];
        for i in 0..f.len() {
            f[i] /= unit(i);
            for j in 0..f.len() {
                df[(i, j)] *= unit(j) / unit(i);
            }
        }
        Some((f, df))
    }

    /// f and ∂f/∂z of the resting variables.
    fn look(&mut self, variables: &[f64]) -> Option<(DVector<f64>, DMatrix<f64>)> {
        self.field.evaluate(self.start.time, variables).ok()?;
        let (rate, derivative) = (self.field.rate(), self.field.derivative());
        let n = self.resting.len();
        let f = DVector::from_fn(n, |i, _| rate[self.resting[i]]);
        let df = DMatrix::from_fn(n, n, |i, j| derivative[(self.resting[i], self.resting[j])]);
        f.iter().chain(df.iter()).all(|x| x.is_finite()).then_some((f, df))
    }

    /// Newton's method from a beginning.
    fn from(&mut self, index: usize) -> Option<Vec<f64>> {
        let mut variables = self.beginning(index);
        if self.resting.is_empty() {
            return None;
        }
        let (mut f, mut df) = self.look_in_units(&variables)?;
        let mut settled = 0;
        for _ in 0..STEPS {
            if self.space.system().cancel().is_cancelled() {
                return None;
            }
            let sizes = self.resting.iter().map(|&i| (variables[i] / self.units[i]).abs());
            let size = sizes.fold(1.0, f64::max);
            if f.amax() <= ZERO * size * df.amax() {
                settled += 1;
                if settled > 2 {
                    return self.accepted(variables);
                }
            }
            let step = linear::least_squares(&df, &(-&f), VANISHES * df.amax())?;
            let mut part = 1.0_f64.min(2.0 * size / step.amax().max(f64::MIN_POSITIVE));
            let next = loop {
                let mut there = variables.clone();
                for (k, &i) in self.resting.iter().enumerate() {
                    there[i] += part * step[k] * self.units[i];
                }
                match self.look_in_units(&there) {
                    Some((g, dg)) if settled > 0 || g.norm() < f.norm() => {
                        break Some((there, g, dg));
                    }
                    _ if part < 1e-4 => break None,
                    _ => part *= 0.5,
                }
            };
            let Some(next) = next else { break };
            (variables, f, df) = next;
        }
        if settled > 0 { self.accepted(variables) } else { None }
    }

    /// The variables nearest to the start among their periods, if they are in reach; angles within half a turn of zero,
    /// however often the motion has gone round.
    fn accepted(&mut self, mut variables: Vec<f64>) -> Option<Vec<f64>> {
        let start = self.space.variables(self.start);
        for &i in &self.resting {
            if let Some(period) = self.space.turns()[i] {
                let turns = ((variables[i] - start[i]) / period).round();
                variables[i] -= turns * period;
            }
            let far = self.radii()[self.radii().len() - 1] * (self.units[i] + start[i].abs());
            if i < self.degrees && (variables[i] - start[i]).abs() > far {
                return None;
            }
            if let Some(period) = self.space.periods()[i] {
                variables[i] -= period * (variables[i] / period - HALF_A_TURN).ceil();
            }
            // a zero but for rounding
            if variables[i].abs() < 1e-14 * self.units[i] {
                variables[i] = 0.0;
            }
        }
        // a force on a cyclic coordinate, as friction, lets nothing rest
        self.look(&variables)?;
        let (rate, derivative) = (self.field.rate(), self.field.derivative());
        let part = |i: usize, j: usize| derivative[(i, j)].abs() * self.units[j] / self.units[i];
        let all = 0..self.units.len();
        let caused = all.clone().flat_map(|i| all.clone().map(move |j| (i, j)));
        let caused = caused.map(|(i, j)| part(i, j)).fold(0.0, f64::max);
        let of = |i: usize| rate[i].abs() / self.units[i];
        let size = all.clone().map(of).fold(caused, f64::max);
        let pushed = |i: &usize| of(self.degrees + i) > 1e3 * ZERO * size;
        (!self.cyclic.iter().any(pushed)).then_some(variables)
    }

    fn alike(&self, a: &[f64], b: &[f64]) -> bool {
        self.resting.iter().all(|&i| {
            let mut apart = a[i] - b[i];
            if let Some(period) = self.space.turns()[i] {
                apart -= (apart / period).round() * period;
            }
            apart.abs() <= SAME * (self.units[i] + a[i].abs())
        })
    }

    fn described(&mut self, variables: Vec<f64>) -> Result<Option<Equilibrium>, DynamicsError> {
        let state = self.space.state_at(self.start, &variables);
        let energy = match self.space.system().energy(&state, self.space.parameters()) {
            Ok(energy) => energy,
            Err(fault) if fault.kind == MotionErrorKind::Cancelled => return Err(fault.into()),
            Err(_) => return Ok(None),
        };
        let Some((_, df)) = self.look(&variables) else { return Ok(None) };
        let rate = self.field.rate();
        let eigenvalues = linear::eigenvalues(&df);
        let scale = eigenvalues.iter().map(|z| math::hypot(z[0], z[1])).fold(0.0, f64::max);
        let canonical = self.space.form() == Form::Momentum;
        let grows = eigenvalues.iter().any(|z| z[0] > VANISHES.sqrt() * scale);
        let rests = eigenvalues.iter().any(|z| math::hypot(z[0], z[1]) <= VANISHES.sqrt() * scale);
        let stable = if grows {
            Some(false)
        } else if rests {
            None
        } else {
            Some(true)
        };
        let modes = match self.look_in_units(&variables).filter(|_| canonical) {
            Some((_, in_units)) => self.modes(&in_units, &eigenvalues, scale),
            None => Vec::new(),
        };
        let rates = self.cyclic.iter().map(|&i| (i, rate[i])).collect();
        let kind = canonical.then(|| kind(&df));
        let work = Vec::new();
        Ok(Some(Equilibrium { variables, energy, kind, eigenvalues, modes, stable, rates, work }))
    }

    /// The modes, from ∂f/∂z in units.
    fn modes(&self, df: &DMatrix<f64>, eigenvalues: &[[f64; 2]], scale: f64) -> Vec<Mode> {
        let oscillates =
            |z: &&[f64; 2]| z[1] > VANISHES.sqrt() * scale && z[0].abs() <= VANISHES.sqrt() * scale;
        let mut frequencies: Vec<f64> =
            eigenvalues.iter().filter(oscillates).map(|z| z[1]).collect();
        frequencies.sort_by(f64::total_cmp);
        let mut modes: Vec<Mode> = Vec::new();
        for (k, &frequency) in frequencies.iter().enumerate() {
            let equal = |other: &&f64| (frequency - **other).abs() <= 1e-7 * frequency;
            let rank = frequencies[..k].iter().filter(equal).count();
            let Some(vector) = linear::null_vector(df, frequency, rank) else { continue };
            let mut places = vec![0.0; self.degrees];
            let mut quarter = places.clone();
            let half = self.resting.len() / 2;
            let unit = |k: usize| self.units[self.resting[k]];
            let largest = (0..half).max_by(|&a, &b| {
                (vector[a].norm() * unit(a)).total_cmp(&(vector[b].norm() * unit(b)))
            });
            let Some(largest) = largest else { continue };
            for (k, &i) in self.resting[..half].iter().enumerate() {
                let z = vector[k] / vector[largest] * (unit(k) / unit(largest));
                let clean = |x: f64| if x.abs() < 1e-12 { 0.0 } else { x };
                (places[i], quarter[i]) = (clean(z.re), clean(z.im));
            }
            modes.push(Mode { frequency, in_phase: places, quadrature: quarter });
        }
        modes
    }
}

/// The unit of each variable: that of a momentum makes the forces that move it as large, in one oscillation, as the
/// velocity that it causes.
fn units(space: &PhaseSpace, start: &State, field: &mut VectorField) -> Vec<f64> {
    let ordinary = |x: f64| (1.0 / ORDINARY..=ORDINARY).contains(&x);
    let variables = space.variables(start);
    let n = space.dimension();
    let canonical = space.form() == Form::Momentum;
    let degrees = if canonical { n / 2 } else { n };
    let lengths = (0..degrees).filter(|&i| space.turns()[i].is_none());
    let largest = lengths.map(|i| variables[i].abs()).fold(0.0, f64::max);
    let own = |i: usize| match variables[i].abs() {
        _ if space.turns()[i].is_some() => 1.0,
        size => match if size == 0.0 { largest } else { size } {
            size if size == 0.0 || ordinary(size) => 1.0,
            size => size,
        },
    };
    let mut units: Vec<f64> = (0..n).map(own).collect();
    if !canonical {
        return units;
    }
    units[degrees..].fill(1.0);
    if field.evaluate(start.time, variables).is_ok() {
        let derivative = field.derivative();
        for i in 0..degrees {
            let stiffness = derivative[(degrees + i, i)].abs();
            let mobility = derivative[(i, degrees + i)].abs();
            let impedance = (stiffness / mobility).sqrt();
            // where nothing pulls, the momentum that the force gives on that way
            let force = field.rate()[degrees + i].abs();
            let given = (force * units[i] / mobility).sqrt();
            let unit = if stiffness > 0.0 { impedance * units[i] } else { given };
            // the square of a momentum's unit over its mass is compared with forces: no unit is ordinary by itself
            if unit.is_finite() && unit > 0.0 {
                units[degrees + i] = unit;
            }
        }
    }
    units
}

/// What the effective potential does, from ∂(q̇, ṗ)/∂(q, p).
fn kind(df: &DMatrix<f64>) -> Kind {
    let n = df.nrows() / 2;
    let part = |i: usize, j: usize| df.view((i * n, j * n), (n, n)).into_owned();
    let (a, b, c, d) = (part(0, 0), part(0, 1), part(1, 0), part(1, 1));
    let inertia = (&b + b.transpose()) * 0.5;
    let positive = inertia.clone().cholesky().is_some();
    let stiffness = match b.try_inverse() {
        Some(mass) if positive => -(c - d * mass * a),
        // no kinetic energy that is positive: the energy itself decides
        _ => {
            let mut hessian = DMatrix::zeros(2 * n, 2 * n);
            hessian.view_mut((0, 0), (n, n)).copy_from(&(-part(1, 0)));
            hessian.view_mut((0, n), (n, n)).copy_from(&(-part(1, 1)));
            hessian.view_mut((n, 0), (n, n)).copy_from(&part(0, 0));
            hessian.view_mut((n, n), (n, n)).copy_from(&part(0, 1));
            hessian
        }
    };
    let symmetric = (&stiffness + stiffness.transpose()) * 0.5;
    let values = symmetric.symmetric_eigenvalues();
    let largest = values.amax();
    if largest == 0.0 || values.iter().any(|x| x.abs() <= VANISHES * largest) {
        return Kind::Degenerate;
    }
    match (values.min() > 0.0, values.max() < 0.0) {
        (true, _) => Kind::Minimum,
        (_, true) => Kind::Maximum,
        _ => Kind::Saddle,
    }
}

/// The bases of the sequence, one for each coordinate in turn.
const PRIMES: [usize; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];

/// The radical inverse of a number (J. H. Halton, Numer. Math. 2 (1960) 84).
fn halton(index: usize, base: usize) -> f64 {
    let (mut rest, mut part, mut sum) = (index, 1.0, 0.0);
    while rest > 0 {
        part /= base as f64;
        sum += part * (rest % base) as f64;
        rest /= base;
    }
    sum
}
