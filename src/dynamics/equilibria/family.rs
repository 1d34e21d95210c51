//! Families of equilibria: curves and surfaces each of whose places is one, as the circle of minima of V = (x² + y² − 1)².
//!
//! At a member the rates do not change along the family, so that their derivative J has a kernel; but V = x⁴ has one too, that of
//! (x² + y² − 1)⁴ is larger than the family, and so is any where two families cross. The kernel only says where to look: from places
//! a little along it the rates vanish again somewhere, and where that is not where it began there is a direction of the family.
//! Then it is followed: at each step the place may move across the family alone, and the rates must vanish there, as far as a unit away
//! or round a closed curve.
//!
//! In: a place at which the rates vanish, in units. Out: the family it belongs to, the member nearest to another place, whether two are
//! of one family. Never here: isolated equilibria.

use nalgebra::{DMatrix, DVector};

use super::search::{EquilibriumSearch, size_of};
use crate::dynamics::linear;
use crate::system::Form;

/// Singular values of J up to this part of the largest there, or a little way off, belong to its kernel: no direction of a family is
/// outside it.
const VANISHES: f64 = 1e-6;

/// Those of a kernel that is no larger than the family, which has its directions to all digits.
const EXACT: f64 = 1e-8;

/// How far along the kernel another zero is searched for, in the size of the place, and the least part of it that a zero moves away.
const BESIDE: f64 = 0.02;
const MOVED: f64 = 0.2;

/// The distance to members whose difference is a direction of the family.
const SECANT: f64 = 1e-3;

/// The longest step along a family, in the size of the place, and the shortest.
const LONGEST: f64 = 0.1;
const SHORTEST: f64 = 1e-6;

/// A family is followed as far as the size of the place, or by so many steps where it is curved more.
const STEPS: usize = 24;
const ATTEMPTS: usize = 120;

/// A step across the family is no more than this part of the one along it.
const ACROSS: f64 = 0.7;

/// Two places are the same up to this part of their size.
const SAME: f64 = 1e-6;

/// The number of steps between two members, and how near to the nearest member they lead, in the size of the place.
const STEPS_TO_MEMBER: usize = 80;
const NEAREST: f64 = 1e-10;

/// The members that are kept of each family.
const MOST_MEMBERS: usize = 300;

/// Orthonormal directions.
pub(super) type Directions = Vec<DVector<f64>>;

/// A family of equilibria, in the units of the search.
pub(super) struct EquilibriumFamily {
    members: Vec<FamilyPlace>,
}

/// A place of a family, and its directions there.
#[derive(Clone)]
struct FamilyPlace {
    place: DVector<f64>,
    along: Directions,
}

/// What a place is at which the rates vanish.
pub(super) enum Belonging {
    /// The only one around it.
    Isolated,
    /// One of a family.
    Member(EquilibriumFamily),
    /// Where several families meet: places of each.
    Crossing(Vec<Vec<f64>>),
}

impl EquilibriumSearch<'_> {
    /// Directions beside which every one along a family has no part: the kernel of J.
    fn kernel(&mut self, place: &DVector<f64>) -> Option<Directions> {
        let (_, df) = self.evaluate(place)?;
        let beside = [1.0, -1.0].map(|side| {
            let moved = side * LONGEST * size_of(place);
            self.evaluate(&place.add_scalar(moved)).map_or(0.0, |(_, df)| df.amax())
        });
        let cut = VANISHES * df.amax().max(beside[0]).max(beside[1]);
        below(df, cut)
    }

    /// Whether J has a kernel at a place at which the rates vanish.
    pub(super) fn is_degenerate(&mut self, variables: &[f64]) -> bool {
        let place = self.in_units(variables);
        self.kernel(&place).is_none_or(|kernel| !kernel.is_empty())
    }

    /// What a place is at which the rates vanish.
    pub(super) fn belonging(&mut self, variables: &[f64]) -> Belonging {
        let place = self.in_units(variables);
        let Some(kernel) = self.kernel(&place) else { return Belonging::Isolated };
        let directions = self.directions(&place, kernel);
        if directions.is_empty() {
            return Belonging::Isolated;
        }
        let first = FamilyPlace { place, along: directions.clone() };
        if let Some(family) = self.family(&first) {
            return Belonging::Member(family);
        }
        // the directions of several families together are those of none
        let mut met = Vec::new();
        for direction in &directions {
            for side in [1.0, -1.0] {
                let beside = &first.place + direction * (side * LONGEST * size_of(&first.place));
                let Some(there) = self.approached(&beside, &[]) else { continue };
                let only = FamilyPlace { place: there, along: vec![direction.clone()] };
                if directions.len() > 1 || self.family(&only).is_some() {
                    met.push(self.unscaled(&only.place));
                }
            }
        }
        if directions.len() == 1 || met.is_empty() {
            Belonging::Isolated
        } else {
            Belonging::Crossing(met)
        }
    }

    /// Whether a place is so near to one where families meet that its directions are those of several.
    pub(super) fn is_beside(&self, crossing: &[f64], variables: &[f64]) -> bool {
        let place = self.in_units(crossing);
        let apart = self.way(&place, &self.in_units(variables)).norm();
        apart <= 2.0 * BESIDE * size_of(&place)
    }

    /// Directions, within a kernel, in which there are other zeros beside one.
    fn directions(&mut self, place: &DVector<f64>, kernel: Directions) -> Directions {
        let distance = BESIDE * size_of(place);
        let mut found: Directions = Vec::new();
        for candidate in kernel {
            let Some(candidate) = outside(&candidate, &found, MOVED) else { continue };
            for side in [1.0, -1.0] {
                let beside = place + &candidate * (side * distance);
                let Some(there) = self.approached(&beside, &[]) else { continue };
                let moved = (there - place) / distance;
                if is_elsewhere(moved.norm()) {
                    continue;
                }
                if let Some(direction) = outside(&moved, &found, MOVED) {
                    found.push(direction);
                    break;
                }
            }
        }
        found
    }

    /// The directions of a family at a place, from those a little way off.
    fn turned(&mut self, place: &DVector<f64>, before: &Directions) -> Option<Directions> {
        let (_, df) = self.evaluate(place)?;
        let cut = EXACT * df.amax();
        let kernel = below(df, cut)?;
        if kernel.len() == before.len() {
            return Some(kernel);
        }
        let distance = SECANT * size_of(place);
        let mut found: Directions = Vec::new();
        for direction in before {
            let mut secant = |distance: f64| {
                let [ahead, behind] = [distance, -distance]
                    .map(|by| self.approached(&(place + direction * by), before));
                Some((ahead? - behind?) / (2.0 * distance))
            };
            // its error is of fourth order
            let (near, far) = (secant(distance)?, secant(2.0 * distance)?);
            found.push(outside(&(&near + (&near - far) / 3.0), &found, MOVED)?);
        }
        Some(found)
    }

    /// The member that is reached by a step along a family.
    fn stepped(&mut self, from: &FamilyPlace, step: &DVector<f64>) -> Option<FamilyPlace> {
        let place = self.approached(&(&from.place + step), &from.along)?;
        let across = (&place - &from.place - step).norm();
        if is_across(across, step.norm()) {
            return None;
        }
        let along = self.turned(&place, &from.along)?;
        Some(FamilyPlace { place, along })
    }

    /// The family of a place that has these directions, if it is one of all of them.
    fn family(&mut self, first: &FamilyPlace) -> Option<EquilibriumFamily> {
        let along = self.turned(&first.place, &first.along)?;
        let first = FamilyPlace { along, ..first.clone() };
        let mut members = vec![first.clone()];
        for direction in &first.along {
            let sides = [1.0, -1.0].map(|side| self.traced(&first, &(direction * side)));
            if sides.iter().all(Option::is_none) {
                return None;
            }
            members.extend(sides.into_iter().flatten().flatten());
        }
        let all = first.along.iter().fold(DVector::zeros(first.place.len()), |sum, one| sum + one);
        let size = size_of(&first.place);
        [BESIDE, -BESIDE]
            .into_iter()
            .find_map(|part| self.stepped(&first, &(&all * (part * size))))?;
        Some(EquilibriumFamily { members })
    }

    /// Members in a direction of a family, as far as a unit away; `None` where they end before.
    fn traced(
        &mut self,
        first: &FamilyPlace,
        direction: &DVector<f64>,
    ) -> Option<Vec<FamilyPlace>> {
        let size = size_of(&first.place);
        let (mut step, mut longest, mut covered) = (LONGEST * size, 0.0_f64, 0.0);
        let (mut member, mut direction) = (first.clone(), direction.clone());
        let mut members = Vec::new();
        for _ in 0..ATTEMPTS {
            if covered >= size || (members.len() >= STEPS && step >= longest / 8.0) {
                return Some(members);
            }
            let next = self.stepped(&member, &(&direction * step));
            let next = next.and_then(|next| {
                let along = within(&direction, &next.along);
                (along.norm() >= ACROSS).then(|| (next, along.normalize()))
            });
            let Some((next, along)) = next else {
                step *= 0.5;
                if step < SHORTEST * size {
                    return None;
                }
                continue;
            };
            covered += step;
            longest = longest.max(step);
            step = (2.0 * step).min(LONGEST * size);
            direction = along;
            member = next;
            members.push(member.clone());
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
        let place = self.in_units(variables);
        let everything = DVector::from_element(place.len(), 1.0);
        let mut near: Vec<(f64, usize)> = Vec::new();
        for (k, member) in family.members.iter().enumerate() {
            near.push((self.way(&member.place, &place).norm(), k));
        }
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, k) in near.into_iter().take(2) {
            let from = &family.members[k];
            let size = size_of(&place);
            let step = within(&self.way(&from.place, &place), &from.along);
            if step.norm() <= LONGEST * size {
                let (there, along) = (&from.place + step, from.along.clone());
                let there = self.approached(&there, &along);
                if there.is_some_and(|there| is_same(self.way(&there, &place).norm(), size)) {
                    return true;
                }
            }
            let reached = self.nearest(family.members[k].clone(), &place, &everything);
            if is_same(self.way(&reached.place, &place).norm(), size) {
                if family.members.len() < MOST_MEMBERS {
                    family.members.push(reached);
                }
                return true;
            }
        }
        false
    }

    /// The member nearest to a place that a walk along the family reaches, where variables count by their weights.
    fn nearest(
        &mut self,
        from: FamilyPlace,
        to: &DVector<f64>,
        weights: &DVector<f64>,
    ) -> FamilyPlace {
        let mut member = from;
        let size = size_of(to).max(size_of(&member.place));
        let mut longest = LONGEST * size;
        let mut before: Option<(DVector<f64>, DVector<f64>)> = None;
        for _ in 0..STEPS_TO_MEMBER {
            let way = self.way(&member.place, to).component_mul(weights);
            let Some(along) = shortest(&member.along, &way, weights) else { break };
            if along.norm() <= NEAREST * size {
                break;
            }
            // the family is curved: how much less is left after a step says how far it is (J. Barzilai, J. Borwein, IMA J. Numer. Anal. 8,
            // 141 (1988))
            let far = before.as_ref().map_or(1.0, |(moved, left)| {
                let part = moved.norm_squared() / moved.dot(&(left - &along));
                if part.is_finite() && part > 0.0 { part } else { 1.0 }
            });
            let mut step = &along * far;
            if step.norm() > longest {
                step *= longest / step.norm();
            }
            let next = self.stepped(&member, &step).filter(|next| {
                let left = self.way(&next.place, to).component_mul(weights);
                left.norm() < way.norm() || is_same(along.norm(), size)
            });
            match next {
                Some(next) => {
                    before = Some((self.way(&member.place, &next.place), along));
                    member = next;
                    longest = (2.0 * longest).min(LONGEST * size);
                }
                None => (longest, before) = (0.5 * step.norm(), None),
            }
            if longest < SHORTEST * SHORTEST * size {
                break;
            }
        }
        member
    }

    /// By what the distance to the start counts along a family: by places, unless its members differ in momenta alone.
    fn weights(&self, along: &Directions) -> DVector<f64> {
        let canonical = self.space.form() == Form::Momentum;
        let is_place = |i: &usize| f64::from(u8::from(!canonical || *i < self.degrees));
        let places =
            DVector::from_iterator(self.unknowns.len(), self.unknowns.iter().map(is_place));
        let moved: Directions = along.iter().map(|one| one.component_mul(&places)).collect();
        let moves = DMatrix::from_columns(&moved).singular_values().min() > MOVED * SECANT;
        if moves { places } else { DVector::from_element(self.unknowns.len(), 1.0) }
    }

    /// The member of a family that is nearest to where the search began: its variables, and directions along the family, in units.
    pub(super) fn representative(
        &mut self,
        family: &EquilibriumFamily,
    ) -> Option<(Vec<f64>, Directions)> {
        let start = self.in_units(&self.middle.clone());
        let weights = self.weights(&family.members.first()?.along);
        let distance =
            |member: &&FamilyPlace| self.way(&member.place, &start).component_mul(&weights).norm();
        let from = family.members.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        let member = self.nearest(from.clone(), &start, &weights);
        let mut variables = self.unscaled(&member.place);
        self.within_periods(&mut variables);
        Some((variables, member.along))
    }

    /// A direction in the variables, in the largest of its coordinates or else of its momenta.
    pub(super) fn tangent(&self, direction: &DVector<f64>) -> Option<Vec<f64>> {
        let mut tangent = vec![0.0; self.middle.len()];
        for (k, &i) in self.unknowns.iter().enumerate() {
            tangent[i] = direction[k] * self.units[i];
        }
        let of = |values: &[f64]| values.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs()));
        let largest = of(&tangent[..self.degrees]).filter(|x| *x != 0.0).or(of(&tangent))?;
        // what is left of the largest is rounding
        let part = |x: f64| if is_rounding(x, largest) { 0.0 } else { x / largest };
        Some(tangent.into_iter().map(part).collect())
    }
}

/// The vectors that a matrix takes to no more than this.
fn below(matrix: DMatrix<f64>, cut: f64) -> Option<Directions> {
    let (rows, columns) = matrix.shape();
    // with rows of zeros below, so that all its right singular vectors are known
    let found = linear::singular_values(&matrix.resize_vertically(rows.max(columns), 0.0))?;
    let small = (0..columns).filter(|&k| found.sizes[k] <= cut);
    Some(small.map(|k| found.right.column(k).into_owned()).collect())
}

/// The part of a vector outside these directions, normalised; `None` if it is shorter than this.
fn outside(vector: &DVector<f64>, directions: &Directions, least: f64) -> Option<DVector<f64>> {
    let left = vector - within(vector, directions);
    (left.norm() >= least).then(|| left.normalize())
}

/// The part of a vector along these directions.
fn within(vector: &DVector<f64>, directions: &Directions) -> DVector<f64> {
    let parts = directions.iter().map(|one| one * one.dot(vector));
    parts.fold(DVector::zeros(vector.len()), |sum, part| sum + part)
}

/// The step along directions that comes nearest to the end of a way, where variables count by their weights.
fn shortest(
    directions: &Directions,
    way: &DVector<f64>,
    weights: &DVector<f64>,
) -> Option<DVector<f64>> {
    let along = DMatrix::from_columns(directions);
    let weighted =
        DMatrix::from_fn(along.nrows(), along.ncols(), |i, j| along[(i, j)] * weights[i]);
    let parts = linear::least_squares(&weighted, way, 0.0)?;
    Some(along * parts)
}

fn is_same(apart: f64, size: f64) -> bool {
    apart <= SAME * size
}

/// Whether a step has led across a family by so much, beside its length.
fn is_across(across: f64, length: f64) -> bool {
    across > ACROSS * length
}

/// Whether a zero that has moved so many times as far as the place beside it is none of the same family.
fn is_elsewhere(moved: f64) -> bool {
    moved > 1.0 / MOVED
}

fn is_rounding(part: f64, largest: f64) -> bool {
    part.abs() <= EXACT * largest.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_a_member_to_a_millionth_of_its_size() {
        assert!(is_same(1.9e-6, 2.0) && !is_same(2.1e-6, 2.0));
    }

    #[test]
    fn a_step_along_a_family_leads_less_far_across_it() {
        assert!(is_across(1.41, 2.0) && !is_across(1.39, 2.0));
    }

    #[test]
    fn a_zero_five_times_as_far_is_another() {
        assert!(is_elsewhere(5.1) && !is_elsewhere(4.9));
    }

    #[test]
    fn a_direction_is_rounded_at_1e_8_of_its_largest_part() {
        assert!(is_rounding(1.9e-8, -2.0) && !is_rounding(-2.1e-8, -2.0));
    }

    /// Directions with a part of 1/5 outside those that are known are new.
    #[test]
    fn a_direction_with_a_fifth_outside_the_known_ones_is_another() {
        let known = vec![DVector::from_vec(vec![1.0, 0.0])];
        let at = |part: f64| DVector::from_vec(vec![(1.0 - part * part).sqrt(), part]);
        assert!(outside(&at(0.21), &known, MOVED).is_some());
        assert!(outside(&at(0.19), &known, MOVED).is_none());
    }
}
