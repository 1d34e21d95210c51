//! Families of equilibria: curves and surfaces each of whose places is one, as the circle of minima of V = (x² + y² − 1)².
//!
//! At a member the rates do not change along the family, so that their derivative J has a kernel. That alone is no proof: V = x⁴ has one
//! too. A place is a member if steps along the kernel, corrected by the Gauss–Newton method across it, lead to places at which the rates
//! vanish and J has a kernel of the same dimension, as far as a unit away or round a closed curve.
//!
//! In: a place at which the rates vanish, in units. Out: the family it belongs to, the member nearest to another place, whether two are
//! of one family. Never here: isolated equilibria.

use nalgebra::{DMatrix, DVector};

use super::search::EquilibriumSearch;
use crate::dynamics::linear::{self, SingularValues};

/// Singular values of J up to this part of the largest belong to its kernel.
const VANISHES: f64 = 1e-8;

/// Rates are rounding up to this part of what they would change by over the size of the place.
const ROUNDED: f64 = 64.0 * f64::EPSILON;

/// Rates that do not change but for rounding are lost in it up to this part of the largest change of others. Along the way of a family this
/// is enough; where a search ends it is not: the forces of V = x²⁰ are that small far from their zero.
const LOST: f64 = 8.0 * f64::EPSILON;

/// The number of corrections of a place. Across a family on which the rates vanish quadratically each gains a factor 1/2.
const CORRECTIONS: usize = 70;

/// The longest step along a family, in the size of the place, and the shortest.
const LONGEST: f64 = 0.1;
const SHORTEST: f64 = 1e-6;

/// A family is followed as far as the size of the place, or by so many steps where it is curved more.
const STEPS: usize = 24;
const ATTEMPTS: usize = 120;

/// What remains of a step after its correction is at least this part along the direction in which it was taken.
const ALONG: f64 = 0.7;

/// Two places are the same up to this part of their size.
const SAME: f64 = 1e-6;

/// The number of steps between two members, and the least part of the way to the other that a step may take.
const WALK: usize = 80;
const TOWARDS: f64 = 0.02;

/// The members that are kept of each family.
const KEPT: usize = 300;

/// A family of equilibria, in the units of the search.
pub(super) struct EquilibriumFamily {
    dimension: usize,
    members: Vec<DVector<f64>>,
}

/// A place at which the rates vanish, with their derivative.
struct Member {
    place: DVector<f64>,
    slopes: SingularValues,
}

impl Member {
    /// The dimension of the kernel.
    fn nullity(&self) -> usize {
        let cut = VANISHES * self.slopes.sizes.max();
        self.slopes.sizes.iter().filter(|size| **size <= cut).count()
    }

    /// The vectors of the kernel.
    fn kernel(&self) -> Vec<DVector<f64>> {
        let (count, nullity) = (self.slopes.sizes.len(), self.nullity());
        (count - nullity..count).map(|k| self.slopes.right.column(k).into_owned()).collect()
    }

    /// The part of a vector along the kernel.
    fn along(&self, vector: &DVector<f64>) -> DVector<f64> {
        let mut along = DVector::zeros(vector.len());
        for one in self.kernel() {
            along += &one * one.dot(vector);
        }
        along
    }
}

impl EquilibriumSearch<'_> {
    /// The unknowns of a place in their units.
    fn scaled(&self, variables: &[f64]) -> DVector<f64> {
        DVector::from_iterator(
            self.unknowns.len(),
            self.unknowns.iter().map(|&i| variables[i] / self.units[i]),
        )
    }

    /// The variables of a place in units; the others are those of the search.
    fn unscaled(&self, place: &DVector<f64>) -> Vec<f64> {
        let mut variables = self.middle.clone();
        for (k, &i) in self.unknowns.iter().enumerate() {
            variables[i] = place[k] * self.units[i];
        }
        variables
    }

    /// The place at which the rates vanish that is reached from one near it by steps across the kernel of J, whose dimension is the one
    /// given, or what J has there; `None` if there is none.
    fn corrected(&mut self, place: &DVector<f64>, nullity: Option<usize>) -> Option<Member> {
        self.corrected_to(place, nullity, LOST)
    }

    /// The same, with rates that are zero up to this part of the largest change.
    fn corrected_to(
        &mut self,
        place: &DVector<f64>,
        mut nullity: Option<usize>,
        lost: f64,
    ) -> Option<Member> {
        let mut place = place.clone();
        for _ in 0..CORRECTIONS {
            let variables = self.unscaled(&place);
            let (f, df) = self.look_in_units(&variables)?;
            let slopes = linear::singular_values(&tall(df.clone()))?;
            let kept = slopes.sizes.len()
                - *nullity.get_or_insert_with(|| {
                    let cut = VANISHES * slopes.sizes.max();
                    slopes.sizes.iter().filter(|size| **size <= cut).count()
                });
            if is_rounding(&f, &df, place.amax().max(1.0), lost) {
                return Some(Member { place, slopes });
            }
            let mut step = DVector::zeros(place.len());
            for k in 0..kept {
                let part = slopes.left.column(k).rows(0, f.len()).dot(&f) / slopes.sizes[k];
                step -= slopes.right.column(k) * part;
            }
            if !step.iter().all(|x| x.is_finite()) || step.norm() <= f64::EPSILON * place.norm() {
                return None;
            }
            place += step;
        }
        None
    }

    /// The place near this one at which the rates vanish to rounding, if J has a kernel there: Newton's method across it.
    pub(super) fn across(&mut self, variables: &[f64]) -> Option<Vec<f64>> {
        let place = self.scaled(variables);
        let (_, df) = self.look_in_units(variables)?;
        let slopes = linear::singular_values(&tall(df))?;
        let first = Member { place: place.clone(), slopes };
        let nullity = Some(first.nullity()).filter(|nullity| *nullity > 0)?;
        let member = self.corrected_to(&place, Some(nullity), 0.0)?;
        let near = (&member.place - &place).norm() <= VANISHES.sqrt() * place.norm().max(1.0);
        (near && member.nullity() > 0).then(|| self.unscaled(&member.place))
    }

    /// Whether J has a kernel at a place at which the rates vanish.
    pub(super) fn is_degenerate(&mut self, variables: &[f64]) -> bool {
        let place = self.scaled(variables);
        self.corrected(&place, None).is_some_and(|member| member.nullity() > 0)
    }

    /// The family that a place belongs to, at which the rates vanish.
    pub(super) fn family(&mut self, variables: &[f64]) -> Option<EquilibriumFamily> {
        let place = self.scaled(variables);
        let first = self.corrected(&place, None)?;
        let nullity = first.nullity();
        if nullity == 0 {
            return None;
        }
        let mut members = vec![first.place.clone()];
        let mut dimension = 0;
        for direction in first.kernel() {
            let sides = [1.0, -1.0].map(|side| self.traced(&first, &(&direction * side)));
            let found = sides.iter().flatten().count();
            dimension += usize::from(found > 0);
            members.extend(sides.into_iter().flatten().flatten());
        }
        (dimension > 0).then_some(EquilibriumFamily { dimension, members })
    }

    /// Members in a direction of the kernel, as far as a unit away; `None` where they end before.
    fn traced(&mut self, first: &Member, direction: &DVector<f64>) -> Option<Vec<DVector<f64>>> {
        let nullity = first.nullity();
        let size = first.place.amax().max(1.0);
        let (mut step, mut longest) = (LONGEST * size, 0.0_f64);
        let (mut place, mut direction) = (first.place.clone(), direction.clone());
        let mut members = Vec::new();
        let mut gone = 0.0;
        for _ in 0..ATTEMPTS {
            if gone >= size || (members.len() >= STEPS && step >= longest / 8.0) {
                return Some(members);
            }
            let there = &place + &direction * step;
            let next = self.corrected(&there, Some(nullity)).filter(|next| {
                let moved = &next.place - &place;
                next.nullity() == nullity
                    && moved.dot(&direction) >= ALONG * step
                    && moved.norm() * ALONG <= step
            });
            let Some(next) = next else {
                step *= 0.5;
                if step < SHORTEST * size {
                    return None;
                }
                continue;
            };
            let along = next.along(&direction);
            let length = along.norm();
            if length < ALONG {
                step *= 0.5;
                if step < SHORTEST * size {
                    return None;
                }
                continue;
            }
            gone += step;
            longest = longest.max(step);
            step = (2.0 * step).min(LONGEST * size);
            direction = along / length;
            place = next.place;
            members.push(place.clone());
        }
        None
    }

    /// The way from one place to another, by the shorter side of coordinates that are periodic.
    fn way(&self, from: &DVector<f64>, to: &DVector<f64>) -> DVector<f64> {
        let mut way = to - from;
        for (k, &i) in self.unknowns.iter().enumerate() {
            if let Some(period) = self.space.turns()[i] {
                let turn = period / self.units[i];
                way[k] -= (way[k] / turn).round() * turn;
            }
        }
        way
    }

    /// Whether a place at which the rates vanish is one of a family's, to which a way along its members leads.
    pub(super) fn belongs(&mut self, family: &mut EquilibriumFamily, variables: &[f64]) -> bool {
        let place = self.scaled(variables);
        let distance = |search: &Self, member: &DVector<f64>| search.way(member, &place).norm();
        let mut near: Vec<(f64, usize)> = Vec::new();
        for (k, member) in family.members.iter().enumerate() {
            near.push((distance(self, member), k));
        }
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, k) in near.into_iter().take(2) {
            let from = family.members[k].clone();
            if self.walked(&from, &place).is_some_and(|left| left <= SAME * place.amax().max(1.0)) {
                if family.members.len() < KEPT {
                    family.members.push(place);
                }
                return true;
            }
        }
        false
    }

    /// How far from a place the walk along a family ends that goes towards it.
    fn walked(&mut self, from: &DVector<f64>, to: &DVector<f64>) -> Option<f64> {
        self.nearest(from, to).map(|member| self.way(&member.place, to).norm())
    }

    /// The member nearest to a place that a walk along the family reaches.
    fn nearest(&mut self, from: &DVector<f64>, to: &DVector<f64>) -> Option<Member> {
        let mut member = self.corrected(from, None)?;
        let nullity = member.nullity();
        let size = to.amax().max(from.amax()).max(1.0);
        let mut longest = LONGEST * size;
        for _ in 0..WALK {
            let way = self.way(&member.place, to);
            let along = member.along(&way);
            let length = along.norm();
            if length <= (TOWARDS * SAME) * size || length <= TOWARDS * SAME * way.norm() {
                break;
            }
            let part = (longest / length).min(1.0);
            let there = &member.place + &along * part;
            let next = self.corrected(&there, Some(nullity)).filter(|next| {
                let moved = &next.place - &member.place;
                next.nullity() == nullity
                    && moved.dot(&along) >= ALONG * part * length * length
                    && self.way(&next.place, to).norm() < way.norm()
            });
            match next {
                Some(next) => {
                    member = next;
                    longest = (2.0 * longest).min(LONGEST * size);
                }
                None => longest = 0.5 * part * length,
            }
            if longest < SHORTEST * size {
                break;
            }
        }
        Some(member)
    }

    /// The member of a family that is nearest to where the search began, by its variables.
    pub(super) fn representative(&mut self, family: &EquilibriumFamily) -> Option<Vec<f64>> {
        let start = self.scaled(&self.middle.clone());
        let distance = |member: &&DVector<f64>| self.way(member, &start).norm();
        let from = family.members.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let from = from?.clone();
        let member = self.nearest(&from, &start)?;
        let mut variables = self.unscaled(&member.place);
        self.within_periods(&mut variables);
        Some(variables)
    }

    /// The directions along a family at a member, in the coordinates and momenta: as many as its dimension.
    pub(super) fn tangents(
        &mut self,
        family: &EquilibriumFamily,
        variables: &[f64],
    ) -> Vec<Vec<f64>> {
        let place = self.scaled(variables);
        let Some(member) = self.corrected(&place, None) else { return Vec::new() };
        let mut found: Vec<Vec<f64>> = Vec::new();
        for direction in member.kernel() {
            if found.len() == family.dimension || self.traced(&member, &direction).is_none() {
                continue;
            }
            let mut tangent = vec![0.0; self.middle.len()];
            for (k, &i) in self.unknowns.iter().enumerate() {
                tangent[i] = direction[k] * self.units[i];
            }
            let of =
                |values: &[f64]| values.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs()));
            let Some(largest) = of(&tangent[..self.degrees]).filter(|x| *x != 0.0).or(of(&tangent))
            else {
                continue;
            };
            // what is left of the largest is rounding
            let part = |x: f64| if x.abs() <= VANISHES * largest.abs() { 0.0 } else { x / largest };
            found.push(tangent.into_iter().map(part).collect());
        }
        found
    }
}

/// A matrix with rows of zeros below, so that all its right singular vectors are known.
fn tall(matrix: DMatrix<f64>) -> DMatrix<f64> {
    let (rows, columns) = matrix.shape();
    matrix.resize_vertically(rows.max(columns), 0.0)
}

/// Whether each rate is no more than the rounding of a place of this size leaves of it.
fn is_rounding(f: &DVector<f64>, df: &DMatrix<f64>, size: f64, lost: f64) -> bool {
    let lost = lost * size * df.amax();
    f.iter().enumerate().all(|(i, f)| {
        let slopes: f64 = df.row(i).iter().map(|x| x.abs()).sum();
        f.abs() <= ROUNDED * size * slopes + lost
    })
}
