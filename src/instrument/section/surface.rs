//! The surface of a section in words, and what it is for a motion to cross it.
//!
//! In: a view of the file with a section. Out: its equation, its direction, the word for a crossing. Never here: crossings.

use crate::expr::Expr;
use crate::instrument::{Physics, Plot};
use crate::model::{Direction, View};

pub(super) fn view<'a>(plot: &Plot, physics: Physics<'a>) -> Option<&'a View> {
    physics.model.views.get(plot.view?).filter(|view| view.section.is_some())
}

/// What a crossing is: of a surface, or of an instant, once in a period of the time; if only one impulse is repeated, the time
/// from each to the next is its period.
pub(super) fn crossing<'a>(physics: Physics<'a>, view: &View) -> &'a str {
    let model = physics.model;
    let surface = view.section.and_then(|index| model.sections.get(index));
    let of_state = model
        .coordinates
        .iter()
        .flat_map(|c| [c.position, c.velocity, c.acceleration, c.momentum])
        .collect::<Vec<_>>();
    let is_instant = |on: Expr| {
        model.pool.depends(on, model.symbols.time) && !model.pool.depends_on_any(on, &of_state)
    };
    if !surface.is_some_and(|surface| is_instant(surface.when)) {
        return "crossing";
    }
    let mut repeated = model.impulses.iter().filter(|impulse| impulse.period.is_some());
    match (repeated.next(), repeated.next()) {
        (Some(impulse), None) => &impulse.name,
        _ => "period",
    }
}

/// The surface in words: `x = 0, rising`.
pub(super) fn surface(physics: Physics<'_>, view: &View) -> String {
    let section = view.section.and_then(|index| physics.model.sections.get(index));
    let direction = match section.map_or(Direction::Either, |section| section.direction) {
        Direction::Either => String::new(),
        direction => format!(", {}", direction.word()),
    };
    zero(physics, view) + &direction
}

/// The equation of the surface of a view, in mathematical notation: `sin(ω t) = 0`.
pub(in crate::instrument) fn zero(physics: Physics<'_>, view: &View) -> String {
    // the last of the axes, as it was read
    let on = view.axes.last().and_then(|axis| axis.first());
    let on = on.map_or_else(String::new, |on| physics.model.pool.unicode(on.expression));
    // a time, where there is one term beside it
    let time = on.strip_prefix("t − ").filter(|rest| !rest.contains([' ', '(']));
    time.map_or_else(|| format!("{on} = 0"), |time| format!("t = {time}"))
}
