//! The list of channels, and the programs that compute them: one in double-double for tables and
//! diagnostics, one in `f64` for drawing only.

use std::sync::Arc;

use rustc_hash::FxHashMap;

use super::channel::{Channel, ChannelKind};
use super::image::ImageProgram;
use super::kkt::ConstraintSystem;
use super::lower::Lowering;
use super::program::{Program, Register};
use super::rhs::ProgramBuilder;
use crate::expr::{Expr, FunctionId, Node, Symbol, with_subscripts};
use crate::mechanics::{Equations, Flow, ImplicitMap};
use crate::model::{self, Follow, Mechanics, Model, Shape};

#[derive(Clone, Debug)]
pub(super) struct Observables {
    pub(super) channels: Vec<Channel>,
    /// The number of leading channels that are the columns of a run.
    pub(super) columns: usize,
    pub(super) index: FxHashMap<Expr, usize>,
    /// The leading channels, as functions of (q, native rates, action, work).
    pub(super) precise: Arc<Program>,
    /// The other channels, of the same inputs.
    pub(super) drawn: Arc<Program>,
    /// The maps whose images are the last inputs.
    pub(super) images: Vec<ImageProgram>,
}

/// A list of channels under construction, with their expressions; the balance has none.
#[derive(Default)]
pub(super) struct ObservableList {
    channels: Vec<Channel>,
    expressions: Vec<Option<Expr>>,
    index: FxHashMap<Expr, usize>,
    columns: usize,
    precise: usize,
}

/// Whether work is done on the energy: by what acts on the motion, by impulses, or by steps of the law in time. Where these are in the
/// momenta, what moves is known on one side of them only.
pub(super) fn has_work(model: &Model, equations: &Equations) -> bool {
    equations.energy_rate != Expr::ZERO
        || !model.impulses.is_empty()
        || equations.energy_jumps_in_time()
}

impl ObservableList {
    pub(super) fn of(
        model: &Model,
        equations: &mut Equations,
        extra: &[model::WrittenExpr],
    ) -> ObservableList {
        let mut list = ObservableList::default();
        list.add_state(model, equations);
        for (i, o) in model.observables.iter().enumerate() {
            let shown = with_subscripts(&o.name);
            list.add(ChannelKind::Observable(i), &o.name, &shown, o.expression);
            if let Some(channel) = list.channels.last_mut() {
                channel.unit.clone_from(&o.unit);
            }
        }
        for (i, c) in extra.iter().enumerate() {
            let shown = model.pool.with_shown_names(&c.written);
            list.add(ChannelKind::Extra(i), &c.written, &shown, c.expression);
        }
        list.columns = list.channels.len();
        // by how much it jumps with the law is in no rate, and known only where that is located
        if has_work(model, equations) && !equations.energy_jumps_elsewhere_in_time() {
            list.push(ChannelKind::EnergyBalance, "energy balance", "energy balance", None);
        }
        for (i, c) in equations.conserved.iter().enumerate() {
            let mut momenta = model.coordinates.iter().map(|q| model.pool.symbol_info(q.momentum));
            let known = momenta.find(|info| info.name == c.name);
            let shown = known.map_or_else(|| with_subscripts(&c.name), |info| info.unicode.clone());
            list.add(ChannelKind::Conserved(i), &c.name, &shown, c.expression);
        }
        if let Some(matrix) = equations.supplements.attitude_symbols {
            for (i, symbol) in matrix.into_iter().flatten().enumerate() {
                let e = equations.pool.variable(symbol);
                let name = equations.pool.symbol_info(symbol).unicode.clone();
                list.add(ChannelKind::Attitude(i), &name, &name, e);
            }
        }
        for (name, e, _) in &model.expect.conserves {
            if !list.index.contains_key(e) {
                let shown = model.pool.with_shown_names(name);
                list.add(ChannelKind::Expression, name, &shown, *e);
            }
        }
        // A quantity is not named after a value expected of it at one time; a view may name it.
        for value in &model.expect.values {
            list.add_hidden(value.expression);
        }
        list.precise = list.channels.len();
        for view in &model.views {
            for c in view.axes.iter().flatten() {
                list.add_hidden(c.expression);
                let symbol = model.pool.as_symbol(c.expression);
                let shown = symbol.map(|s| model.pool.symbol_info(s).unicode.clone());
                list.name(c, &shown.unwrap_or_else(|| model.pool.with_shown_names(&c.written)));
            }
        }
        list.add_new_variables(model, equations);
        let own = model.views.iter().flat_map(|view| view.shapes.iter().flatten());
        for e in model.picture.shapes.iter().chain(own).flat_map(numbers_of).chain(followed(model))
        {
            list.add_hidden(e);
        }
        for frame in &model.frames {
            for e in frame.axis.into_iter().chain([frame.angle]).chain(frame.origin) {
                list.add_hidden(e);
            }
        }
        for seen in equations.supplements.frames.iter().flatten() {
            let forces = [seen.centrifugal, seen.coriolis, seen.euler, seen.dragging];
            for e in seen.at.into_iter().chain(forces.into_iter().flatten()) {
                list.add_hidden(e);
            }
        }
        list.find_units(model, equations);
        list.find_angles(equations);
        for (channel, e) in list.channels.iter_mut().zip(&list.expressions) {
            channel.is_place =
                !channel.name.is_empty() && e.is_some_and(|e| equations.is_place(model, e));
        }
        list
    }

    /// Marks what is an angle because it is written as `atan2(y, x)`: it jumps by a turn, as a periodic coordinate does.
    fn find_angles(&mut self, equations: &Equations) {
        let pool = &equations.pool;
        let new = &equations.supplements.maps.new_variables;
        let written = |e: Expr| {
            let symbol = pool.as_symbol(e)?;
            new.iter().find(|(s, _)| *s == symbol).map(|(_, e)| *e)
        };
        for (channel, e) in self.channels.iter_mut().zip(&self.expressions) {
            let e = e.map(|e| written(e).unwrap_or(e));
            if e.is_some_and(|e| matches!(pool.node(e), Node::Call(FunctionId::Atan2, _))) {
                channel.periodic = true;
                if channel.unit.is_empty() && !channel.name.is_empty() {
                    "rad".clone_into(&mut channel.unit);
                }
            }
        }
    }

    fn add_state(&mut self, model: &Model, equations: &mut Equations) {
        for (i, c) in model.coordinates.iter().enumerate() {
            let e = equations.pool.variable(c.position);
            self.add(ChannelKind::Position(i), &c.name, &c.shown, e);
            if let Some(channel) = self.channels.last_mut() {
                channel.unit.clone_from(&c.unit);
                channel.periodic = c.period.is_some();
            }
        }
        let moving = if model.is_poisson() { &[] } else { &model.coordinates[..] };
        let symbols: Vec<_> = moving.iter().map(|c| (c.velocity, c.momentum)).collect();
        let time = model.time_unit();
        let (energy_unit, momentum_units) = equations.units(model);
        for (i, &(velocity, _)) in symbols.iter().enumerate() {
            self.add_symbol(ChannelKind::Velocity(i), equations, velocity);
            let unit = &model.coordinates[i].unit;
            if let (Some(channel), false, false) =
                (self.channels.last_mut(), unit.is_empty(), time.is_empty())
            {
                channel.unit = format!("{unit}/{time}");
            }
        }
        for (i, &(_, momentum)) in symbols.iter().enumerate() {
            self.add_symbol(ChannelKind::Momentum(i), equations, momentum);
            if let Some(channel) = self.channels.last_mut() {
                channel.unit.clone_from(&momentum_units[i]);
            }
            self.index.entry(equations.momenta[i]).or_insert(self.channels.len() - 1);
        }
        for (i, row) in equations.constraints.clone().iter().enumerate() {
            self.add_symbol(ChannelKind::Multiplier(i), equations, row.multiplier);
            if let Some(channel) = self.channels.last_mut() {
                channel.unit = equations.multiplier_unit(model, i);
            }
        }
        let energy = equations.pool.variable(equations.symbols.energy);
        self.add(ChannelKind::Energy, "energy", "E", energy);
        if let Some(channel) = self.channels.last_mut() {
            channel.unit = energy_unit;
        }
        self.index.entry(equations.energy).or_insert(self.channels.len() - 1);
        if let Mechanics::Poisson { casimirs, .. } = &model.mechanics {
            for (i, (name, e, _)) in casimirs.iter().enumerate() {
                self.add(ChannelKind::Casimir(i), name, &with_subscripts(name), *e);
            }
        }
    }

    /// Lists what no view of the file shows: the new variables of its transformations and the constants of its complete
    /// integral, so that they can be chosen for an axis.
    fn add_new_variables(&mut self, model: &Model, equations: &mut Equations) {
        let supplements = &equations.supplements;
        let written = supplements.maps.new_variables.iter().map(|(symbol, _)| *symbol);
        let solved = supplements.maps.implicit.iter().flat_map(|(map, _)| map.new.clone());
        let known: Vec<Symbol> = written.chain(solved).collect();
        for (name, symbol) in model.new_variables() {
            if known.contains(&symbol) {
                let e = equations.pool.variable(symbol);
                self.add_hidden(e);
                let shown = equations.pool.symbol_info(symbol).unicode.clone();
                self.name(&model::WrittenExpr { written: name, expression: e }, &shown);
            }
        }
        // what several of them call by the same names is known by each of them
        let all = model.transformations.iter().zip(&equations.supplements.maps.written);
        for (law, forwards) in all {
            for &(symbol, e) in forwards.iter().flatten() {
                let info = equations.pool.symbol_info(symbol);
                let name = model.new_variable_name(law, symbol);
                if name != info.name {
                    let shown = format!("{} of {}", info.unicode, law.name);
                    self.push(ChannelKind::Expression, &name, &shown, Some(e));
                }
            }
        }
    }

    /// Assigns units to named quantities that have none yet, if they follow from those of the file.
    fn find_units(&mut self, model: &Model, equations: &Equations) {
        let energy = self.channels.iter().find(|c| c.kind == ChannelKind::Energy);
        let energy = energy.map_or_else(String::new, |channel| channel.unit.clone());
        for (channel, e) in self.channels.iter_mut().zip(&self.expressions) {
            if !channel.unit.is_empty() || channel.name.is_empty() {
                continue;
            }
            channel.unit = match e {
                Some(e) => equations.unit(model, *e),
                None => energy.clone(),
            };
        }
    }

    fn add_symbol(&mut self, kind: ChannelKind, equations: &mut Equations, symbol: Symbol) {
        let e = equations.pool.variable(symbol);
        let info = equations.pool.symbol_info(symbol).clone();
        self.add(kind, &info.name, &info.unicode, e);
    }

    fn add(&mut self, kind: ChannelKind, name: &str, shown: &str, e: Expr) {
        self.index.entry(e).or_insert(self.channels.len());
        self.push(kind, name, shown, Some(e));
    }

    fn add_hidden(&mut self, e: Expr) {
        if !self.index.contains_key(&e) {
            self.add(ChannelKind::Expression, "", "", e);
        }
    }

    /// Names a channel after a view if it has no name yet.
    fn name(&mut self, written: &model::WrittenExpr, shown: &str) {
        let channel = self.index.get(&written.expression).map(|&i| &mut self.channels[i]);
        if let Some(channel) = channel.filter(|channel| channel.name.is_empty()) {
            channel.name.clone_from(&written.written);
            shown.clone_into(&mut channel.shown);
        }
    }

    fn push(&mut self, kind: ChannelKind, name: &str, shown: &str, e: Option<Expr>) {
        let (name, shown) = (name.to_owned(), shown.to_owned());
        let channel =
            Channel { kind, name, shown, unit: String::new(), periodic: false, is_place: false };
        self.channels.push(channel);
        self.expressions.push(e);
    }

    /// Whether any channel depends on a symbol.
    pub(super) fn depends(&self, equations: &Equations, symbol: Symbol) -> bool {
        let all: Vec<Expr> = self.expressions.iter().flatten().copied().collect();
        let reached = equations.pool.reachable(&all);
        reached.into_iter().any(|e| equations.pool.as_symbol(e) == Some(symbol))
    }

    pub(super) fn compile(self, builder: &mut ProgramBuilder<'_>) -> Result<Observables, Symbol> {
        let equations = builder.equations;
        let maps = equations.supplements.maps.implicit.iter();
        let used: Vec<&(ImplicitMap, Vec<f64>)> =
            maps.filter(|(map, _)| map.new.iter().any(|&s| self.depends(equations, s))).collect();
        let images = used.iter().map(|map| ImageProgram::of(map, builder));
        let images = images.collect::<Result<_, _>>()?;
        let new: Vec<Symbol> = used.iter().flat_map(|(map, _)| map.new.clone()).collect();
        let (precise, drawn) = self.expressions.split_at(self.precise);
        let precise = program_with(builder, precise, &new)?;
        let drawn = program_with(builder, drawn, &new)?;
        Ok(Observables {
            channels: self.channels,
            columns: self.columns,
            index: self.index,
            precise,
            drawn,
            images,
        })
    }
}

/// A program of (q, native rates, auxiliary numbers, action, work) for channels' expressions. p, q̈
/// and the energy are computed first and bound to their symbols.
pub(super) fn program(
    builder: &mut ProgramBuilder<'_>,
    channels: &[Option<Expr>],
) -> Result<Arc<Program>, Symbol> {
    program_with(builder, channels, &[])
}

/// The same, with the new variables of implicit maps as its last inputs.
fn program_with(
    builder: &mut ProgramBuilder<'_>,
    channels: &[Option<Expr>],
    new: &[Symbol],
) -> Result<Arc<Program>, Symbol> {
    let equations = builder.equations;
    let accelerated = is_accelerated(builder, channels);
    let accelerations = match &equations.flow {
        Flow::Hamilton { velocities, .. } | Flow::Poisson { rates: velocities } if accelerated => {
            // q̈ = d/dt ∂H/∂p along the motion
            let seeds = equations.along_the_flow();
            velocities.iter().map(|&v| builder.pool.derivation(v, &seeds)).collect()
        }
        _ => Vec::new(),
    };
    let used: Vec<Symbol> =
        channels.iter().flatten().flat_map(|&e| builder.pool.symbols_of(e)).collect();
    let kkt = builder.kkt.clone();
    let mut lowering = builder.on_full_state();
    let (action, work) = (lowering.input(), lowering.input());
    lowering.bind(equations.symbols.action, action);
    for &symbol in new {
        let image = lowering.input();
        lowering.bind(symbol, image);
    }
    if channels.is_empty() {
        return lowering.finish(Vec::new());
    }
    bind_derived(&mut lowering, equations, &kkt, accelerated, &accelerations, &used);
    let energy = lowering.variable(equations.symbols.energy);
    let outputs: Vec<Register> = channels
        .iter()
        .map(|channel| match channel {
            Some(e) => lowering.lower(*e),
            None => lowering.difference(energy, work),
        })
        .collect();
    lowering.finish(outputs)
}

/// Whether any of the expressions depends on an acceleration or a multiplier.
fn is_accelerated(builder: &ProgramBuilder<'_>, channels: &[Option<Expr>]) -> bool {
    let all: Vec<Expr> = channels.iter().flatten().copied().collect();
    let accelerations = builder.equations.coordinates.iter().map(|c| c.acceleration);
    let multipliers = builder.equations.constraints.iter().map(|c| c.multiplier);
    let symbols: Vec<Symbol> = accelerations.chain(multipliers).collect();
    let reached = builder.pool.reachable(&all);
    reached.into_iter().any(|e| builder.pool.as_symbol(e).is_some_and(|s| symbols.contains(&s)))
}

fn bind_derived(
    lowering: &mut Lowering<'_>,
    equations: &Equations,
    kkt: &ConstraintSystem,
    accelerated: bool,
    accelerations: &[Expr],
    used: &[Symbol],
) {
    match &equations.flow {
        Flow::Lagrange { force, .. } => {
            let momenta = lowering.lower_all(&equations.momenta);
            for (c, p) in equations.coordinates.iter().zip(momenta) {
                lowering.bind(c.momentum, p);
            }
            if accelerated {
                kkt.bind(lowering, equations, force);
            }
        }
        Flow::Hamilton { velocities, .. } | Flow::Poisson { rates: velocities } => {
            let shown = equations.supplements.shown_velocities.as_ref();
            let velocities = lowering.lower_all(shown.unwrap_or(velocities));
            for (c, v) in equations.coordinates.iter().zip(velocities) {
                lowering.bind(c.velocity, v);
            }
            let accelerations = lowering.lower_all(accelerations);
            for (c, a) in equations.coordinates.iter().zip(accelerations) {
                lowering.bind(c.acceleration, a);
            }
        }
    }
    for (symbol, e) in equations.attitude_map() {
        if !used.contains(&symbol) {
            continue;
        }
        let entry = lowering.lower(e);
        lowering.bind(symbol, entry);
    }
    let energy = lowering.lower(equations.energy);
    lowering.bind(equations.symbols.energy, energy);
}

/// The expressions that decide where the camera is.
fn followed(model: &Model) -> Vec<Expr> {
    let numbers = |follow: &Follow| {
        [&follow.at[..], follow.beside.as_ref().map_or(&[][..], |at| at), &[follow.reach]].concat()
    };
    model.picture.follow.as_ref().map(numbers).unwrap_or_default()
}

fn numbers_of(shape: &Shape) -> Vec<Expr> {
    match shape {
        Shape::Line { from, to } | Shape::Spring { from, to } => [*from, *to].concat(),
        Shape::Circle { centre, radius, normal } => [&centre[..], &[*radius], &normal[..]].concat(),
        Shape::Mass { at, radius } => at.iter().copied().chain(*radius).collect(),
        Shape::Trace { at } | Shape::Body { at } | Shape::Caption { at, .. } => at.to_vec(),
        Shape::Disc { centre, radius, normal, shade } => {
            let numbers = [&centre[..], &[*radius], &normal[..]].concat();
            numbers.into_iter().chain(*shade).collect()
        }
        Shape::Sphere { centre, radius } => [&centre[..], &[*radius]].concat(),
        Shape::Cone { tip, base, radius } => [&tip[..], &base[..], &[*radius]].concat(),
        Shape::Cylinder { from, to, radius } => [&from[..], &to[..], &[*radius]].concat(),
        Shape::Vector { at, components, .. } => [*at, *components].concat(),
        Shape::Path { points } => points.concat(),
        Shape::Plane { at, normal, size } => [&at[..], &normal[..], &[*size]].concat(),
    }
}
