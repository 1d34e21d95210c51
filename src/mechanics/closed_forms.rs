//! The closed forms that take elimination: accelerations and multipliers solved for, the Legendre
//! transform, and whether H separates. They are for reading, for the rates of observables, for
//! brackets and for splitting methods; a motion is integrated without them.
//!
//! In: equations as [`derive_for_motion`](super::derive_for_motion) leaves them. Out: the same, with
//! the fields asked for filled in. Each is found once. Never here: the elimination itself.

use std::collections::BTreeSet;

use super::derive::too_large;
use super::equations::{CLOSED_FORM_LIMIT, Equations, Flow, NoClosedForm, Separable};
use super::structure::Separation;
use super::{constrain, hamilton, legendre, linear};
use crate::expr::{Expr, Pool, Symbol, Zero};

/// The largest number of coordinates, coupled each with each by a moving mass matrix, that are
/// eliminated: of one more, the solved form has grown beyond [`CLOSED_FORM_LIMIT`] nodes or nearly
/// so, after a thousand times the time that everything else takes.
const MOST_COUPLED: usize = 4;

impl Equations {
    /// Finds all closed forms that have not been found yet.
    pub fn find_closed_forms(&mut self) {
        self.solved();
        self.hamiltonian();
        self.lagrangian();
        self.separable();
        self.separation();
        self.find_named_ramps();
    }

    /// Returns whether a closed form has not been searched for yet.
    pub fn has_pending_forms(&self) -> bool {
        self.pending.solved
            || self.pending.transform
            || self.pending.separable
            || self.supplements.separation.is_none()
            || self.supplements.law_with_ramps_named.is_some()
    }

    /// Whether Hamilton–Jacobi separates in the file's coordinates.
    pub fn separation(&mut self) -> &Separation {
        if self.supplements.separation.is_none() {
            let attempt = self.pool.begin(u64::MAX);
            self.find_separation();
            if !self.pool.end(attempt) {
                let why = "Levi-Civita's conditions grow beyond all bounds".to_owned();
                self.supplements.separation = Some(Separation::Unknown(why));
            }
        }
        self.supplements.separation.get_or_insert(Separation::Unknown(String::new()))
    }

    /// q̈ as a function of (q, q̇, t), or q̇ then ṗ of a Hamiltonian system; one for each coordinate.
    ///
    /// # Errors
    /// The reason why there is none: the equations are not linear in the unknowns, or too long to write.
    pub fn solved(&mut self) -> &Result<Vec<Expr>, NoClosedForm> {
        self.solve();
        &self.solved
    }

    /// λ of each constraint as a function of (q, q̇, t).
    ///
    /// # Errors
    /// The reason why there is none, as for [`Equations::solved`].
    pub fn multipliers(&mut self) -> &Result<Vec<Expr>, NoClosedForm> {
        self.solve();
        &self.multipliers
    }

    /// H(q, p, t).
    ///
    /// # Errors
    /// The reason why the Legendre transform has no closed form.
    pub fn hamiltonian(&mut self) -> &Result<Expr, NoClosedForm> {
        if self.is_lagrangian() {
            self.transform();
        }
        &self.hamiltonian
    }

    /// q̇(q, p, t), one for each coordinate.
    ///
    /// # Errors
    /// The reason why the Legendre transform has no closed form.
    pub fn velocities(&mut self) -> &Result<Vec<Expr>, NoClosedForm> {
        if self.is_lagrangian() {
            self.transform();
        }
        &self.velocities
    }

    /// L(q, q̇, t).
    ///
    /// # Errors
    /// The reason why the Legendre transform has no closed form.
    pub fn lagrangian(&mut self) -> &Result<Expr, NoClosedForm> {
        if !self.is_lagrangian() {
            self.transform();
        }
        &self.lagrangian
    }

    /// H = T(p) + V(q, t), if H separates in this way and nothing else acts.
    ///
    /// # Errors
    /// The reason why it does not separate.
    pub fn separable(&mut self) -> &Result<Separable, NoClosedForm> {
        if self.pending.separable {
            self.pending.separable = false;
            let hamiltonian = self.hamiltonian().clone();
            let (coordinates, time) = (self.coordinates.clone(), self.symbols.time);
            let beside = self.beside;
            self.separable = if self.supplements.auxiliary.is_empty() {
                self.within_bounds(|pool| {
                    hamilton::separate(pool, &coordinates, time, hamiltonian.as_ref(), beside)
                })
            } else {
                Err(NoClosedForm("numbers are carried along that do not follow from H".to_owned()))
            };
        }
        &self.separable
    }

    /// Returns whether L is quadratic in the velocities; `false` for a Hamiltonian system.
    pub fn is_quadratic(&self) -> bool {
        let velocities: Vec<Symbol> = self.coordinates.iter().map(|c| c.velocity).collect();
        let Flow::Lagrange { mass, .. } = &self.flow else { return false };
        mass.iter().flatten().all(|&m| !self.pool.depends_on_any(m, &velocities))
    }

    /// Returns whether M, free of the velocities, is proved to change with a coordinate or the time.
    /// Then H = T(p) + V(q, t) does not hold, for ∂²H/∂p² = M⁻¹ changes as well.
    pub fn has_moving_mass(&mut self) -> bool {
        let Flow::Lagrange { mass, .. } = &self.flow else { return false };
        if !self.is_quadratic() {
            return false;
        }
        let entries: Vec<Expr> =
            mass.iter().enumerate().flat_map(|(i, row)| &row[..=i]).copied().collect();
        let moving: Vec<Symbol> = self.coordinates.iter().map(|c| c.position).collect();
        let moving: Vec<Symbol> = moving.into_iter().chain([self.symbols.time]).collect();
        entries.into_iter().any(|m| {
            moving.iter().any(|&s| {
                if !self.pool.depends(m, s) {
                    return false;
                }
                let slope = self.pool.derivative(m, s);
                self.pool.is_zero(slope) == Zero::No
            })
        })
    }

    fn solve(&mut self) {
        if !self.pending.solved {
            return;
        }
        self.pending.solved = false;
        let Flow::Lagrange { mass, force, .. } = self.flow.clone() else { return };
        let rows = self.constraints.clone();
        let found = self.worth_eliminating(&mass).and_then(|()| {
            self.within_bounds(|pool| {
                let (mut accelerations, mut multipliers) = if rows.is_empty() {
                    (linear::solve(pool, &mass, &force)?.x?, Vec::new())
                } else {
                    constrain::solve(pool, &mass, &force, &rows)?
                };
                // elimination leaves one fraction inside another
                for e in accelerations.iter_mut().chain(&mut multipliers) {
                    *e = pool.as_one_fraction(*e);
                }
                Ok((accelerations, multipliers))
            })
        });
        let none = self.constraints.is_empty();
        (self.solved, self.multipliers) = match found {
            Ok((solved, multipliers)) => (Ok(solved), Ok(multipliers)),
            Err(why) if none => (Err(why), Ok(Vec::new())),
            Err(why) => (Err(why.clone()), Err(why)),
        };
    }

    fn transform(&mut self) {
        if !self.pending.transform {
            return;
        }
        self.pending.transform = false;
        let (coordinates, law) = (self.coordinates.clone(), self.law);
        let momenta = self.momenta.clone();
        match self.flow.clone() {
            Flow::Lagrange { mass, .. } => {
                let found = self.worth_eliminating(&mass).and_then(|()| {
                    self.within_bounds(|pool| {
                        legendre::lagrangian_to_hamiltonian(pool, &coordinates, law, momenta, mass)
                    })
                });
                (self.hamiltonian, self.velocities) = match found {
                    Ok((h, velocities)) => (Ok(h), velocities),
                    Err(why) => (Err(why.clone()), Err(why)),
                };
            }
            Flow::Hamilton { .. } => {
                self.lagrangian = self.within_bounds(|pool| {
                    legendre::hamiltonian_to_lagrangian(pool, &coordinates, law)
                });
            }
            Flow::Poisson { .. } => {}
        }
    }

    /// Looks for a form; one that outgrows the pool leaves it as it was.
    fn within_bounds<T>(
        &mut self,
        find: impl FnOnce(&mut Pool) -> Result<T, NoClosedForm>,
    ) -> Result<T, NoClosedForm> {
        self.pool.attempt(u64::MAX, |pool| Some(find(pool))).unwrap_or_else(|| Err(too_large()))
    }

    /// Returns an error if a moving mass matrix couples too many coordinates to be eliminated.
    fn worth_eliminating(&self, mass: &[Vec<Expr>]) -> Result<(), NoClosedForm> {
        let mut moving: Vec<Symbol> = vec![self.symbols.time];
        moving.extend(self.coordinates.iter().flat_map(|c| [c.position, c.velocity]));
        let moves = |i: usize| mass[i].iter().any(|&m| self.pool.depends_on_any(m, &moving));
        let coupled = largest_front(mass, moves);
        if coupled <= MOST_COUPLED {
            return Ok(());
        }
        Err(NoClosedForm(format!(
            "the mass matrix changes during the motion and couples {coupled} coordinates each with \
             each; it is eliminated for up to {MOST_COUPLED}, beyond which the forms outgrow \
             {CLOSED_FORM_LIMIT} nodes"
        )))
    }
}

/// The largest number of coordinates that are coupled each with each on the way of an elimination,
/// which takes the coordinate with the fewest neighbours first (minimum degree; A. George, J. Liu,
/// SIAM Review 31, 1, 1989). Only those count of which one moves, or is coupled with one that does.
fn largest_front(matrix: &[Vec<Expr>], moves: impl Fn(usize) -> bool) -> usize {
    let n = matrix.len();
    let mut moving: Vec<bool> = (0..n).map(moves).collect();
    let neighbours = |i: usize| (0..n).filter(move |&j| j != i && matrix[i][j] != Expr::ZERO);
    let mut coupled: Vec<BTreeSet<usize>> = (0..n).map(|i| neighbours(i).collect()).collect();
    let mut left: Vec<usize> = (0..n).collect();
    let mut largest = 0;
    while let Some(place) = (0..left.len()).min_by_key(|&k| coupled[left[k]].len()) {
        let removed = left.swap_remove(place);
        let others = std::mem::take(&mut coupled[removed]);
        if moving[removed] || others.iter().any(|&i| moving[i]) {
            largest = largest.max(others.len() + 1);
        }
        for &i in &others {
            moving[i] |= moving[removed];
            coupled[i].remove(&removed);
            coupled[i].extend(others.iter().filter(|&&j| j != i));
        }
    }
    largest
}
