//! What follows from a law of motion as a fragment for LaTeX with amsmath.

use crate::expr::{Expr, Symbol};
use crate::mechanics::{Equations, Flow};
use crate::model::{Mechanics, Model};

pub(super) fn write(model: &Model, equations: &Equations) -> String {
    let pool = &equations.pool;
    let symbol = |s: Symbol| pool.symbol_info(s).latex.clone();
    let mut lines: Vec<String> = Vec::new();
    if let (Some(body), Some(whole)) = (&model.body, &equations.supplements.body) {
        let names = body.names;
        let mut add =
            |s: Symbol, e: Expr| lines.push(format!("{} &= {}", symbol(s), pool.latex(e)));
        add(names.mass, whole.mass);
        names.centre.into_iter().zip(whole.centre).for_each(|(s, e)| add(s, e));
        names.inertia.into_iter().zip(whole.inertia).for_each(|(s, e)| add(s, e));
    }
    let (name, law) = model.mechanics.function();
    lines.push(format!("{name} &= {}", pool.latex(law)));
    let dissipation = model.mechanics.dissipation();
    if dissipation != Expr::ZERO {
        lines.push(format!("F &= {}", pool.latex(dissipation)));
    }
    let forces = model.mechanics.forces();
    let forces = model.coordinates.iter().zip(forces).filter(|(_, force)| **force != Expr::ZERO);
    let letter = if model.is_poisson() { 'f' } else { 'Q' };
    lines.extend(forces.map(|(c, &force)| {
        format!("{letter}_{{{}}} &= {}", symbol(c.position), pool.latex(force))
    }));
    let variable = |i: usize| symbol(model.coordinates[i].position);
    lines.extend(
        model.mechanics.brackets().into_iter().map(|(i, j, e)| {
            format!("\\{{{}, {}\\}} &= {}", variable(i), variable(j), pool.latex(e))
        }),
    );
    if let Mechanics::Poisson { casimirs, .. } = &model.mechanics {
        let casimirs = casimirs.iter().enumerate();
        lines.extend(
            casimirs.map(|(i, (_, e, _))| format!("C_{{{}}} &= {}", i + 1, pool.latex(*e))),
        );
    }
    for c in &model.constraints {
        lines.push(format!("{} &= 0", pool.latex(c.expression)));
    }
    if model.is_lagrangian() {
        for (c, &p) in model.coordinates.iter().zip(&equations.momenta) {
            lines.push(format!("{} &= {}", symbol(c.momentum), pool.latex(p)));
        }
    }
    let rates = rates(model, &symbol);
    match (&equations.solved, &equations.flow) {
        (Ok(solved), _) => {
            let solved = rates.iter().zip(solved);
            lines.extend(solved.map(|(rate, &e)| format!("{rate} &= {}", pool.latex(e))));
        }
        (Err(_), Flow::Lagrange { mass, force, .. }) => {
            let row = |row: &Vec<_>| row.iter().map(|&m| pool.latex(m)).collect::<Vec<_>>();
            let mass: Vec<String> = mass.iter().map(|m| row(m).join(" & ")).collect();
            lines.push(format!("{} {} &= {}", matrix(&mass), matrix(&rates), matrix(&row(force))));
        }
        // q̇ and ṗ are solved for as they stand
        (Err(_), Flow::Hamilton { .. } | Flow::Poisson { .. }) => {}
    }
    for impulse in &model.impulses {
        let changes = model.coordinates.iter().zip(&impulse.change);
        for (c, &e) in changes.filter(|(_, e)| **e != Expr::ZERO) {
            let moved = if model.is_poisson() { c.position } else { c.momentum };
            lines.push(format!("\\Delta {} &= {}", symbol(moved), pool.latex(e)));
        }
    }
    for event in &model.events {
        // no equation of motion: the sign of this is looked at
        let name = event.name.replace(|c: char| !c.is_alphanumeric(), " ");
        lines.push(format!("&\\text{{event {name}: sign change of }} {}", pool.latex(event.when)));
    }
    if let Ok(solved) = &equations.multipliers {
        let solved = equations.constraints.iter().zip(solved);
        lines.extend(
            solved.map(|(row, &e)| format!("{} &= {}", symbol(row.multiplier), pool.latex(e))),
        );
    }
    if model.is_lagrangian() {
        lines.extend(equations.hamiltonian.iter().map(|&h| format!("H &= {}", pool.latex(h))));
        lines.push(format!("E &= {}", pool.latex(equations.energy)));
    }
    lines.push(format!("\\frac{{dE}}{{dt}} &= {}", pool.latex(equations.energy_rate)));
    let title = model.info.title.replace('\n', " ");
    format!("% {title}\n\\begin{{align*}}\n{}\n\\end{{align*}}\n", lines.join(" \\\\\n"))
}

fn matrix(rows: &[String]) -> String {
    format!("\\begin{{pmatrix}} {} \\end{{pmatrix}}", rows.join(" \\\\ "))
}

/// The left sides of the equations of motion.
fn rates(model: &Model, symbol: &dyn Fn(Symbol) -> String) -> Vec<String> {
    let all = model.coordinates.iter();
    if model.is_lagrangian() {
        return all.map(|c| symbol(c.acceleration)).collect();
    }
    let velocities = all.clone().map(|c| symbol(c.velocity));
    velocities.chain(all.map(|c| format!("\\dot {}", symbol(c.momentum)))).collect()
}
