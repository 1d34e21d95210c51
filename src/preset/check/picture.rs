//! Views and shapes: their expressions parsed, their paths sampled.

use std::collections::HashMap;

use toml::Spanned;

use super::ModelBuilder;
use crate::diagnostic::{Diagnostic, nearest};
use crate::ensemble::section_name;
use crate::expr::{Expr, Symbol};
use crate::instrument::{Instrument, has_field};
use crate::model::{
    Allowed, Direction, EventAction, Follow, Mechanics, MotionEvent, Point, Scope, Shape,
    Variation, View, Viewpoint, WrittenExpr,
};
use crate::preset::draft::{
    DraftCamera, DraftFollow, DraftSection, DraftShape, DraftView, Formula, Formulas, ShapeKind,
};

/// The default number of segments of a path.
const SAMPLES: usize = 96;

/// The limit on the nodes of all sampled paths of a file.
const PATHS_LIMIT: usize = 1_000_000;

impl ModelBuilder<'_> {
    /// Reads the views that the screen opens with. `nodes` counts those of all paths.
    pub(super) fn views(&mut self, written: &[DraftView], nodes: &mut usize) {
        let mut scope = Scope::new(&self.model, Allowed::Observable, "a view");
        for view in written {
            let (mut axes, mut over) = (Vec::new(), Vec::new());
            for (place, formulas) in view.axes.iter().enumerate() {
                let axis = view.kind.properties().written.get(place);
                let mut channels = Vec::new();
                for formula in formulas {
                    let Some(expression) = self.formula(&mut scope, "a view", formula) else {
                        continue;
                    };
                    let written = formula.get_ref().trim().to_owned();
                    let channel = WrittenExpr { written, expression };
                    if axis.is_some_and(|axis| axis.coordinate) {
                        self.along_a_coordinate(&channel, formula, view.kind);
                    }
                    if axis.is_some_and(|axis| axis.transformed) {
                        self.is_transformed(&channel, formula);
                    }
                    if axis.is_some_and(|axis| axis.varied) {
                        over.extend(self.variation(&channel, formula));
                    }
                    channels.push(channel);
                }
                axes.push(channels);
            }
            if let Some(field) = view.field.as_ref().filter(|field| *field.get_ref()) {
                self.has_field(&axes, field);
            }
            let (kind, title) = (view.kind.name().to_owned(), view.title.clone());
            let frame = view.frame.as_ref().and_then(|name| self.frame_of_view(name));
            let shapes = view.shapes.as_ref().map(|written| self.shapes(written, nodes));
            let ranges = view.section.as_ref().map_or([None, None], |section| {
                [0, 1].map(|axis| self.axis_range(section.ranges[axis].as_ref()))
            });
            let section = match &view.section {
                None => None,
                Some(written) if written.on.is_none() && view.kind.properties().follows_motions => {
                    None
                }
                Some(written) => {
                    let Some((on, section)) = self.section(written, &view.place) else { continue };
                    axes.push(vec![on]);
                    Some(section)
                }
            };
            let named = view.over.as_ref().and_then(|name| self.parameter_of_view(name));
            over.extend(named.map(Variation::Parameter));
            let mut scope = Scope::new(&self.model, Allowed::Parameters, "a time");
            let until = view.until.as_ref();
            let until = until.and_then(|written| {
                let until = self.formula(&mut scope, "a time", written)?;
                self.lies_ahead(until, written).then_some(until)
            });
            self.model.views.push(View {
                kind,
                title,
                axes,
                frame,
                shapes,
                section,
                over,
                until,
                ranges,
                slope: view.slope,
                field: view.field.as_ref().is_some_and(|field| *field.get_ref()),
            });
        }
    }

    /// The plane of a view must have a vector field.
    fn has_field(&mut self, axes: &[Vec<WrittenExpr>], written: &Spanned<bool>) {
        let [Some(x), Some(y)] = [0, 1].map(|axis| axes.get(axis)?.first()) else { return };
        if let Err(why) = has_field(&self.model, [x, y]) {
            let why = format!("this plane has no vector field: {why}");
            let help = "leave out `field`";
            self.diagnostics.push(Diagnostic::error(written.span(), why).with_help(help));
        }
    }

    fn parameter_of_view(&mut self, name: &Spanned<String>) -> Option<usize> {
        let found = self.model.parameter(name.get_ref());
        if found.is_none() {
            let known: Vec<&str> = self.model.parameters.iter().map(|p| p.name.as_str()).collect();
            let help = match nearest(name.get_ref(), known.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None if known.is_empty() => "the file has no [parameters]".to_owned(),
                None => format!("the parameters are {}", known.join(", ")),
            };
            let message = format!("unknown parameter `{}`", name.get_ref());
            self.diagnostics.push(Diagnostic::error(name.span(), message).with_help(help));
        }
        found
    }

    /// Reads a surface of section: the expression, and its index among the model's surfaces.
    fn section(
        &mut self,
        written: &DraftSection,
        place: &std::ops::Range<usize>,
    ) -> Option<(WrittenExpr, usize)> {
        let mut scope = Scope::new(&self.model, Allowed::Event, "a section");
        let direction = written.direction.as_ref().map_or(Direction::Rising, |d| self.sense(d));
        let on = written.on.as_ref()?;
        let when = self.formula(&mut scope, "a section", on)?;
        if !self.changes(when, on) {
            return None;
        }
        let name = section_name(&self.model);
        let index = self.model.sections.len();
        let action = EventAction::Section(index);
        let place = Some(place.clone());
        self.model.sections.push(MotionEvent { name, when, direction, action, place });
        Some((WrittenExpr { written: on.get_ref().trim().to_owned(), expression: when }, index))
    }

    /// Reads the two ends of an axis, which may use the parameters.
    fn axis_range(&mut self, written: Option<&[Formula; 2]>) -> Option<[Expr; 2]> {
        let mut scope = Scope::new(&self.model, Allowed::Parameters, "a range");
        let [from, to] = written?;
        let from = self.formula(&mut scope, "a range", from);
        let to = self.formula(&mut scope, "a range", to);
        Some([from?, to?])
    }

    /// An axis of a transformation must be one of its new variables.
    fn is_transformed(&mut self, channel: &WrittenExpr, written: &Formula) {
        let symbol = self.model.pool.as_symbol(channel.expression);
        let all: Vec<_> = self.model.transformations.iter().flat_map(|t| t.new.concat()).collect();
        if symbol.is_some_and(|symbol| all.contains(&symbol)) {
            return;
        }
        let names: Vec<&str> =
            all.iter().map(|&s| self.model.pool.symbol_info(s).name.as_str()).collect();
        let message = "a transformation is shown in its new variables, and this is not one";
        let help = if names.is_empty() {
            "the file has no [[transformations]]".to_owned()
        } else {
            format!("write one of {}", names.join(", "))
        };
        self.diagnostics.push(Diagnostic::error(written.span(), message).with_help(help));
    }

    /// The end of the motions of a map must come after their start, at the file's parameters.
    fn lies_ahead(&mut self, until: Expr, written: &Formula) -> bool {
        let model = &self.model;
        let value = |symbol: Symbol| {
            let known = model.parameters.iter().find(|p| p.symbol == symbol);
            known.map_or(f64::NAN, |p| p.value)
        };
        let (end, start) = (model.pool.evaluate(until, &value), model.run.start);
        if end > start && end.is_finite() {
            return true;
        }
        let message = format!("the motions of a map begin at {start}, and this is {end}");
        let help = "write a later time";
        self.diagnostics.push(Diagnostic::error(written.span(), message).with_help(help));
        false
    }

    /// An axis of a map must be a parameter, or an initial value.
    fn variation(&mut self, channel: &WrittenExpr, written: &Formula) -> Option<Variation> {
        let model = &self.model;
        let symbol = model.pool.as_symbol(channel.expression);
        let is = |other: Symbol| symbol == Some(other);
        let parameter = model.parameters.iter().position(|p| is(p.symbol));
        let of = model.coordinates.iter();
        let position = of.clone().position(|c| is(c.position));
        let rate = of.clone().position(|c| {
            let velocity = model.is_lagrangian() && is(c.velocity);
            velocity || matches!(model.mechanics, Mechanics::Hamiltonian { .. }) && is(c.momentum)
        });
        let rate = rate.map(|rate| model.coordinates.len() + rate);
        let found = parameter.map(Variation::Parameter);
        let found = found.or(position.or(rate).map(Variation::Initial));
        if found.is_none() {
            let rates = if model.is_lagrangian() { "velocity" } else { "momentum" };
            let message =
                "an axis of a map is a parameter or an initial value, and this is neither";
            let help = format!("write a parameter, a coordinate or its {rates}");
            self.diagnostics.push(Diagnostic::error(written.span(), message).with_help(help));
        }
        found
    }

    /// The horizontal axis of this kind must be a coordinate, because everything else is fixed while it varies.
    fn along_a_coordinate(
        &mut self,
        x: &WrittenExpr,
        written: &Formula,
        kind: &'static dyn Instrument,
    ) {
        let symbol = self.model.pool.as_symbol(x.expression);
        if !self.model.coordinates.iter().any(|c| Some(c.position) == symbol) {
            let names: Vec<&str> = self.model.coordinates.iter().map(|c| c.name.as_str()).collect();
            let message = format!(
                "`x` of a view of kind `{}` is a coordinate, and this is not one",
                kind.name()
            );
            let help = format!("write one of {}", names.join(", "));
            self.diagnostics.push(Diagnostic::error(written.span(), message).with_help(help));
        }
    }

    /// Reads the shapes of a picture in space. `nodes` counts those of all paths.
    pub(super) fn shapes(&mut self, written: &[DraftShape], nodes: &mut usize) -> Vec<Shape> {
        let mut scope = Scope::new(&self.model, Allowed::Observable, "a shape");
        let mut shapes = Vec::new();
        for written in written {
            shapes.extend(match written.kind {
                ShapeKind::Path => self.path(written, nodes, &mut scope),
                ShapeKind::Body => {
                    let at = self.point(written.at.as_ref(), &mut scope);
                    if self.model.body.is_none() {
                        let message = "there is no [body] to draw";
                        let help = "put it together from pieces in [body]";
                        let diagnostic = Diagnostic::error(written.place.clone(), message);
                        self.diagnostics.push(diagnostic.with_help(help));
                    }
                    at.map(|at| Shape::Body { at })
                }
                _ => self.shape(written, &mut scope),
            });
        }
        shapes
    }

    /// Reads where the camera stands and what it follows.
    pub(super) fn camera(&mut self, written: &DraftCamera) {
        self.model.picture.follow =
            written.follow.as_ref().and_then(|written| self.follow(written));
        if let Some(elevation) = &written.elevation
            && !(-90.0..=90.0).contains(elevation.get_ref())
        {
            let message = "`elevation` is an angle from -90 to 90, in degrees";
            self.diagnostics.push(Diagnostic::error(elevation.span(), message));
        }
        let angle = |written: &Option<Spanned<f64>>| {
            written.as_ref().map(|degrees| degrees.get_ref().to_radians())
        };
        self.model.picture.viewpoint =
            Viewpoint { azimuth: angle(&written.azimuth), elevation: angle(&written.elevation) };
    }

    fn follow(&mut self, written: &DraftFollow) -> Option<Follow> {
        let mut scope = Scope::new(&self.model, Allowed::Observable, "the camera");
        let at = self.point(written.at.as_ref(), &mut scope);
        let reach = self.size(written.reach.as_ref(), &mut scope);
        let at = at?;
        let beside = self.model.comparison.as_ref().map(|comparison| {
            let pool = &mut self.model.pool;
            let others = self.model.coordinates.iter().zip(&comparison.symbols);
            let others: HashMap<Symbol, Expr> = others
                .flat_map(|(c, &(place, rate))| [(c.position, place), (c.velocity, rate)])
                .map(|(of, other)| (of, pool.variable(other)))
                .collect();
            at.map(|e| pool.substitute(e, &others))
        });
        Some(Follow { at, beside, reach: reach? })
    }

    /// Reads a shape other than a path or a body. All parts are read, even if one of them is missing or wrong.
    fn shape(&mut self, written: &DraftShape, scope: &mut Scope) -> Option<Shape> {
        let [at, to] = [&written.at, &written.to].map(|point| self.point(point.as_ref(), scope));
        let [size, shade] =
            [&written.size, &written.shade].map(|size| self.size(size.as_ref(), scope));
        let normal = self.normal(written.normal.as_ref(), scope);
        let text = written.text.clone();
        let (at, radius) = (at?, size);
        Some(match written.kind {
            ShapeKind::Path | ShapeKind::Body => return None,
            ShapeKind::Line => Shape::Line { from: at, to: to? },
            ShapeKind::Spring => Shape::Spring { from: at, to: to? },
            ShapeKind::Trace => Shape::Trace { at },
            ShapeKind::Circle => Shape::Circle { centre: at, radius: radius?, normal: normal? },
            ShapeKind::Mass => Shape::Mass { at, radius },
            ShapeKind::Disc => Shape::Disc { centre: at, radius: radius?, normal: normal?, shade },
            ShapeKind::Sphere => Shape::Sphere { centre: at, radius: radius? },
            ShapeKind::Cone => Shape::Cone { tip: at, base: to?, radius: radius? },
            ShapeKind::Cylinder => Shape::Cylinder { from: at, to: to?, radius: radius? },
            ShapeKind::Caption => Shape::Caption { at, text },
            ShapeKind::Vector => Shape::Vector { at, components: to?, label: text },
            ShapeKind::Plane => Shape::Plane { at, normal: normal?, size: size? },
        })
    }

    fn size(&mut self, written: Option<&Formula>, scope: &mut Scope) -> Option<Expr> {
        self.formula(scope, "a shape", written?)
    }

    /// Reads a point; the third component defaults to zero.
    fn point(&mut self, written: Option<&Formulas>, scope: &mut Scope) -> Option<Point> {
        let entries = written?.get_ref();
        let read: Vec<Option<Expr>> =
            entries.iter().map(|formula| self.formula(scope, "a shape", formula)).collect();
        let third = read.get(2).copied().unwrap_or(Some(Expr::ZERO));
        Some([read[0]?, read[1]?, third?])
    }

    /// Reads a direction; the default is z.
    fn normal(&mut self, written: Option<&Formulas>, scope: &mut Scope) -> Option<Point> {
        match written {
            None => Some([Expr::ZERO, Expr::ZERO, Expr::ONE]),
            Some(_) => self.point(written, scope),
        }
    }

    /// Reads a curve in its own parameter `s`, sampled at evenly spaced values. Inside a path `s` always means that
    /// parameter, whatever else has the name. `nodes` counts those of all paths.
    fn path(
        &mut self,
        written: &DraftShape,
        nodes: &mut usize,
        scope: &mut Scope,
    ) -> Option<Shape> {
        let count = self.samples(written.samples.as_ref());
        let [from, to] = written.ends.each_ref().map(|end| self.size(end.as_ref(), scope));
        let s = self.model.pool.symbol("s of a path");
        let along = self.model.pool.variable(s);
        let mut inner = scope.clone();
        inner.define("s", along);
        let s_was_used = self.used.contains("s");
        let curve = self.point(written.at.as_ref(), &mut inner);
        if !s_was_used {
            self.used.remove("s");
        }
        let (curve, from, to, count) = (curve?, from?, to?, count?);
        let exceeded = *nodes > PATHS_LIMIT;
        *nodes += self.model.pool.reachable(&curve).len() * (count + 1);
        if exceeded {
            return None;
        }
        if *nodes > PATHS_LIMIT {
            let message = "with this, the file's paths have more than a million nodes";
            self.error(written.place.clone(), message);
            return None;
        }
        let pool = &mut self.model.pool;
        let span = pool.sub(to, from);
        let points = (0..=count)
            .map(|i| {
                let share = pool.ratio(i as i64, count as i64);
                let share = pool.mul(share, span);
                let at = HashMap::from([(s, pool.add(from, share))]);
                curve.map(|e| pool.substitute(e, &at))
            })
            .collect();
        if pool.is_full() {
            let message = "with this, the file's expressions grow beyond a million nodes";
            self.error(written.place.clone(), message);
            return None;
        }
        Some(Shape::Path { points })
    }

    /// The number of segments of a path.
    fn samples(&mut self, written: Option<&Spanned<f64>>) -> Option<usize> {
        let Some(written) = written else { return Some(SAMPLES) };
        let count = *written.get_ref();
        if count.fract() != 0.0 || !(1.0..=1000.0).contains(&count) {
            self.error(written.span(), "`samples` must be a whole number from 1 to 1000");
            return None;
        }
        Some(count as usize)
    }
}
