//! The transformations of a model, with those made of others: the inverse of one, and several applied one after the other.
//!
//! In: transformations whose laws are known. Out: the law of the one made of them, of the same kinds as those of a file where it
//! can be written down, and else a chain of them. Never here: whether it is canonical, which is asked of it as of any other.
//!
//! With G = −F, old and new variables exchanged, the inverse of F1(q, Q) is the F1 of G, that of F2(q, P) the F3, that of
//! F3(p, Q) the F2, that of F4(p, P) the F4.
//! Source: *The Principles of Dynamics*, § 3.2.

use std::collections::HashMap;

use super::canonical::{LEADS_BACK, PhaseMap};
use super::equations::{Equations, ImplicitMap};
use super::isolate::Solution;
use super::sampling::{FAR_POINTS, POINTS};
use super::structure_error::StructureError;
use super::valuation::Valuation;
use crate::expr::{Expr, Symbol};
use crate::model::{ChainPart, GeneratingType, Model, Transformation, TransformationLaw};

pub(super) fn find(equations: &mut Equations, model: &Model) {
    let shared: Vec<Symbol> = model.new_variables().into_iter().map(|(_, s)| s).collect();
    let mut all: Vec<Option<Solution>> = Vec::new();
    let mut residuals = Solution::new();
    for given in &model.transformations {
        let before = equations.supplements.maps.laws.clone();
        let law = resolved(model, equations, given, &before, &all);
        let written = Transformation { law: law.clone(), ..given.clone() };
        let map = PhaseMap::relations(&mut equations.pool, model, &written);
        let own = written_inverse(model, equations, (given, &map), &all);
        let mut forwards = own.or_else(|| map.find_forwards(model, equations));
        if let Some(found) = &mut forwards {
            found.sort_by_key(|(symbol, _)| map.implicit.new.iter().position(|s| s == symbol));
        }
        // a root that is 0/0 at the start is no value, though the relations have one there
        let has_value = forwards.as_ref().is_some_and(|forwards| {
            let start = Valuation::at_start(model, equations);
            forwards.iter().all(|&(_, e)| start.value(&equations.pool, e).is_finite())
        });
        if let Some(symbol) = given.residual {
            let residual = map.largest_residual(&mut equations.pool);
            residuals.push((symbol, residual));
        }
        if !has_value && given.new.iter().flatten().all(|symbol| shared.contains(symbol)) {
            let start = Valuation::at_start(model, equations);
            let at_start = || map.image(&equations.pool, &start);
            let at = if forwards.is_some() {
                at_start()
            } else {
                // maps one after the other are solved for all at once along the motion, and begin where each has been solved
                let known = if map.parts.is_empty() { None } else { at_start() };
                known.or_else(|| map.images(model, equations, 1).pop())
            };
            if let Some(at) = at {
                let image = map.implicit.new.iter().map(|&s| at.at(s)).collect();
                equations.supplements.maps.implicit.push((map.implicit, image));
            }
        }
        equations.supplements.maps.laws.push(law);
        all.push(forwards);
    }
    let maps = equations.supplements.maps.implicit.iter();
    let solved: Vec<Symbol> = maps.flat_map(|(map, _)| map.new.clone()).collect();
    let known = all.iter().flatten().flatten().copied();
    equations.supplements.maps.new_variables =
        known.filter(|(symbol, _)| shared.contains(symbol) && !solved.contains(symbol)).collect();
    equations.supplements.maps.new_variables.extend(residuals);
    equations.supplements.maps.written = all;
}

/// The transformations of a model with their laws, those made of others written out, and the maps as they were found with
/// its equations.
pub(super) fn written_maps(
    model: &Model,
    equations: &mut Equations,
) -> Vec<(Transformation, PhaseMap)> {
    let found = equations.supplements.maps.written.clone();
    let laws = equations.supplements.maps.laws.clone();
    let pool = &mut equations.pool;
    let all = model.transformations.iter().zip(found).zip(laws);
    let maps = all.map(|((given, forwards), law)| {
        let given = Transformation { law, ..given.clone() };
        let mut map = PhaseMap::relations(pool, model, &given);
        map.forwards = forwards;
        (given, map)
    });
    maps.collect()
}

/// The maps alone.
pub fn phase_maps(model: &Model, equations: &mut Equations) -> Vec<PhaseMap> {
    written_maps(model, equations).into_iter().map(|(_, map)| map).collect()
}

/// The relations of the transformation at a place of the file; `None` if it is explicit.
pub fn relations_of(model: &Model, equations: &mut Equations, place: usize) -> Option<ImplicitMap> {
    let law = equations.supplements.maps.laws.get(place)?.clone();
    let solved = matches!(law, TransformationLaw::Generating { .. } | TransformationLaw::Chain(_));
    let given = Transformation { law, ..model.transformations.get(place)?.clone() };
    solved.then(|| PhaseMap::relations(&mut equations.pool, model, &given).implicit)
}

/// The law of a transformation, given those before it and their new variables as functions of the old ones.
pub(super) fn resolved(
    model: &Model,
    equations: &mut Equations,
    given: &Transformation,
    before: &[TransformationLaw],
    forwards: &[Option<Solution>],
) -> TransformationLaw {
    match &given.law {
        TransformationLaw::Inverse(k) => {
            let law = before[*k].clone();
            if let TransformationLaw::Chain(parts) = law {
                let back = parts.into_iter().rev();
                let back = back.map(|part| ChainPart { inverted: !part.inverted, ..part });
                return TransformationLaw::Chain(back.collect());
            }
            let of = Transformation { law, ..model.transformations[*k].clone() };
            let written = inverse(model, equations, given, (&of, forwards[*k].as_ref()));
            // what cannot be written down is solved for, too
            let solved = || TransformationLaw::Chain(vec![ChainPart { of, inverted: true }]);
            written.unwrap_or_else(solved)
        }
        TransformationLaw::Composition(parts) => {
            let known = |&k: &usize| {
                let solution = forwards[k].clone()?;
                Some((model.transformations[k].new.concat(), solution))
            };
            let Some(known) = parts.iter().map(known).collect::<Option<Vec<_>>>() else {
                return chain(model, parts, before);
            };
            composition(model, equations, given, &known)
        }
        law => law.clone(),
    }
}

fn old_variables(model: &Model) -> Vec<Symbol> {
    let positions = model.coordinates.iter().map(|c| c.position);
    positions.chain(model.coordinates.iter().map(|c| c.momentum)).collect()
}

/// New variables in the order Q…, P….
pub(super) fn in_order(new: &[[Symbol; 2]]) -> Vec<Symbol> {
    [0, 1].iter().flat_map(|&half| new.iter().map(move |pair| pair[half])).collect()
}

fn inverse(
    model: &Model,
    equations: &mut Equations,
    given: &Transformation,
    (of, forwards): (&Transformation, Option<&Solution>),
) -> Option<TransformationLaw> {
    let old = old_variables(model);
    let (theirs, own) = (in_order(&of.new), in_order(&given.new));
    let pool = &mut equations.pool;
    let mut exchanged: HashMap<Symbol, Expr> = HashMap::new();
    for k in 0..old.len() {
        exchanged.insert(theirs[k], pool.variable(old[k]));
        exchanged.insert(old[k], pool.variable(own[k]));
    }
    if let TransformationLaw::Generating { types, function } = &of.law {
        let function = pool.substitute(*function, &exchanged);
        let function = pool.neg(function);
        let types = types.iter().map(|of| match of {
            GeneratingType::F1 => GeneratingType::F1,
            GeneratingType::F2 => GeneratingType::F3,
            GeneratingType::F3 => GeneratingType::F2,
            GeneratingType::F4 => GeneratingType::F4,
        });
        return Some(TransformationLaw::Generating { types: types.collect(), function });
    }
    let mut map = PhaseMap::relations(pool, model, of);
    let backwards = map.backwards(model, equations)?;
    map.forwards = forwards.cloned();
    // what is an inverse near the start alone is solved for elsewhere
    if map.is_inverse_local(model, equations, &backwards) {
        return None;
    }
    let pool = &mut equations.pool;
    let mut all = Vec::new();
    for &symbol in &old {
        let &(_, e) = backwards.iter().find(|(found, _)| *found == symbol)?;
        all.push(pool.substitute(e, &exchanged));
    }
    let momenta = all.split_off(old.len() / 2);
    Some(TransformationLaw::Explicit { positions: all, momenta })
}

/// The new variables of an inverse as functions of the old ones where those of the transformation that it is the inverse of are
/// written down: a generating function leaves open which of its branches undoes that one.
fn written_inverse(
    model: &Model,
    equations: &mut Equations,
    (given, map): (&Transformation, &PhaseMap),
    forwards: &[Option<Solution>],
) -> Option<Solution> {
    let TransformationLaw::Inverse(k) = given.law else { return None };
    let of = &model.transformations[k];
    let known = forwards[k].as_ref()?;
    let (old, theirs, own) = (old_variables(model), in_order(&of.new), in_order(&given.new));
    let value = |symbol: &Symbol| known.iter().find(|(s, _)| s == symbol).map(|&(_, e)| e);
    let mut positions: Vec<Expr> = theirs.iter().map(value).collect::<Option<_>>()?;
    let momenta = positions.split_off(old.len() / 2);
    let law = TransformationLaw::Explicit { positions, momenta };
    let explicit = Transformation { law, ..of.clone() };
    let back = PhaseMap::relations(&mut equations.pool, model, &explicit);
    let back = back.backwards(model, equations)?;
    // it leads back wherever the transformation has an image
    let near = (0..POINTS as u64).map(|n| Valuation::near_start(model, equations, n));
    let far = (0..FAR_POINTS).map(|n| Valuation::far_from_start(model, equations, n));
    let points: Vec<Valuation> = near.chain(far).collect();
    let pool = &mut equations.pool;
    let leads_back = |point: &Valuation| {
        let image = known.iter().map(|&(s, e)| (s, point.value(pool, e)));
        let at = point.clone().with(image.collect::<Vec<_>>());
        back.iter().all(|&(symbol, e)| {
            at.value(pool, e).is_nan() || at.agrees(pool, e, point.at(symbol), LEADS_BACK)
        })
    };
    if !points.iter().all(leads_back) {
        return None;
    }
    let mut exchanged: HashMap<Symbol, Expr> = HashMap::new();
    for i in 0..old.len() {
        exchanged.insert(theirs[i], pool.variable(old[i]));
    }
    let mut found = Solution::new();
    for (&symbol, &new) in old.iter().zip(&own) {
        let &(_, e) = back.iter().find(|(s, _)| *s == symbol)?;
        found.push((new, pool.substitute(e, &exchanged)));
    }
    let holds = |point: &Valuation| {
        let image = found.iter().map(|&(s, e)| (s, point.value(pool, e)));
        map.implicit.holds(pool, &point.clone().with(image.collect::<Vec<_>>()))
    };
    let (mut right, mut wrong) = (0, 0);
    for is_right in points.iter().filter_map(holds) {
        if is_right { right += 1 } else { wrong += 1 }
    }
    (right > 0 && wrong == 0).then_some(found)
}

/// The parts one after the other where the new variables of some are not known in closed form.
fn chain(model: &Model, parts: &[usize], before: &[TransformationLaw]) -> TransformationLaw {
    let mut all = Vec::new();
    for &k in parts {
        match before[k].clone() {
            TransformationLaw::Chain(parts) => all.extend(parts),
            law => {
                let of = Transformation { law, ..model.transformations[k].clone() };
                all.push(ChainPart { of, inverted: false });
            }
        }
    }
    TransformationLaw::Chain(all)
}

/// The parts one after the other, the first one first.
fn composition(
    model: &Model,
    equations: &mut Equations,
    given: &Transformation,
    parts: &[(Vec<Symbol>, Solution)],
) -> TransformationLaw {
    let old = old_variables(model);
    let pool = &mut equations.pool;
    let mut values: Vec<Expr> = old.iter().map(|&s| pool.variable(s)).collect();
    for (new, solution) in parts {
        let pairs: Vec<[Symbol; 2]> = new.chunks(2).map(|pair| [pair[0], pair[1]]).collect();
        let before: HashMap<Symbol, Expr> = old.iter().copied().zip(values.clone()).collect();
        let ordered = in_order(&pairs);
        values = ordered
            .into_iter()
            .map(|symbol| {
                let known = solution.iter().find(|(found, _)| *found == symbol);
                let e = known.map_or(Expr::ZERO, |&(_, e)| e);
                let e = pool.substitute(e, &before);
                pool.simplify(e)
            })
            .collect();
    }
    let momenta = values.split_off(given.new.len());
    TransformationLaw::Explicit { positions: values, momenta }
}

/// The events and surfaces of section on the new variables of a transformation that is solved numerically.
///
/// Zeros are located on the dense output of a step, by slopes too; the image of a map that is solved numerically is known
/// at the states that are observed, one after the other, and ends at caustics.
pub(super) fn structure_errors(model: &Model, equations: &Equations) -> Vec<StructureError> {
    let pool = &equations.pool;
    let new = equations.supplements.maps.implicit.iter().flat_map(|(map, _)| &map.new);
    let new: Vec<Symbol> = new.copied().collect();
    let all = model.events.iter().chain(&model.sections).filter_map(|event| {
        let symbol = *new.iter().find(|&&symbol| pool.depends(event.when, symbol))?;
        let mut laws = model.transformations.iter();
        let law = laws.find(|law| law.new.iter().flatten().any(|&s| s == symbol))?;
        let (name, law) = (&pool.symbol_info(symbol).name, &law.name);
        Some(StructureError {
            place: event.place.clone(),
            message: format!(
                "zeros cannot be located on `{name}`: `{law}` has no closed form, so that its image is solved for at \
                 single states and is not a function along a step"
            ),
            help: "write it in the old variables, which the relations of the transformation give along a level of \
                   the new ones, or write the transformation out as an explicit one"
                .to_owned(),
        })
    });
    all.collect()
}
