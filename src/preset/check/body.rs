//! A body and its attitude: pieces with valid sizes, and the names that follow from them.

use toml::Spanned;

use super::ModelBuilder;
use crate::diagnostic::Diagnostic;
use crate::expr::{Expr, Rank, Symbol, latex_name, unicode_name};
use crate::model::{
    Allowed, Attitude, AttitudeSource, Body, BodyNames, Mechanics, Piece, PieceOrientation, Point,
    Scope, Solid,
};
use crate::preset::draft::{DraftAttitude, DraftBody, DraftPiece, DraftTurn, Formula, Formulas};

impl ModelBuilder<'_> {
    /// Declares the names that follow from a body and its attitude, so that all expressions know
    /// them. Their values are read by [`ModelBuilder::body`] and [`ModelBuilder::attitude`].
    pub(super) fn body_names(
        &mut self,
        body: Option<&DraftBody>,
        attitude: Option<&DraftAttitude>,
    ) {
        if let Some(written) = body {
            let s = BodyNames::WRITTEN.map(|name| self.introduce(name, Rank::Constant));
            let names = BodyNames {
                inertia: [s[0], s[1], s[2], s[3], s[4], s[5]],
                principal: [s[6], s[7], s[8]],
                mass: s[9],
                centre: [s[10], s[11], s[12]],
            };
            let place = written.place.clone();
            self.model.body = Some(Body { pieces: Vec::new(), names, place });
        }
        if attitude.is_some() {
            let matrix =
                Attitude::WRITTEN.map(|row| row.map(|name| self.introduce(name, Rank::Variable)));
            let source = AttitudeSource::Euler([Expr::ZERO; 3]);
            self.model.attitude = Some(Attitude { matrix, source });
        }
    }

    pub(super) fn introduce(&mut self, name: &str, rank: Rank) -> Symbol {
        let symbol = self.model.pool.symbol(name);
        let (unicode, latex) = match name.strip_prefix('I') {
            Some(axes @ ("xx" | "yy" | "zz" | "xy" | "xz" | "yz")) => {
                (format!("I_{axes}"), format!("I_{{{axes}}}"))
            }
            _ => (unicode_name(name), latex_name(name)),
        };
        self.model.pool.describe(symbol, &unicode, &latex, rank);
        symbol
    }

    pub(super) fn body(&mut self, written: &DraftBody) {
        let mut scope = Scope::new(&self.model, Allowed::Pieces, "a piece of a body");
        let pieces: Vec<Option<Piece>> =
            written.pieces.iter().map(|piece| self.piece(piece, &mut scope)).collect();
        if pieces.iter().any(Option::is_none) {
            return;
        }
        let pieces: Vec<Piece> = pieces.into_iter().flatten().collect();
        let masses: Vec<f64> = pieces.iter().map(|piece| self.at_start(piece.mass)).collect();
        let (sum, size) = (masses.iter().sum::<f64>(), masses.iter().map(|m| m.abs()).sum::<f64>());
        if !pieces.is_empty() && sum <= 1e-12 * size {
            let is = if sum.abs() <= 1e-12 * size { 0.0 } else { sum };
            let message = format!("the masses of the pieces sum to {is}");
            let help = "a body needs a mass, or it has no centre of mass";
            let diagnostic = Diagnostic::error(written.place.clone(), message);
            self.diagnostics.push(diagnostic.with_help(help));
        }
        if let Some(body) = &mut self.model.body {
            body.pieces = pieces;
        }
    }

    /// Reads a piece. All parts are read, even if one of them is missing or wrong.
    fn piece(&mut self, written: &DraftPiece, scope: &mut Scope) -> Option<Piece> {
        let mass = self.constant(written.mass.as_ref(), "the mass of this piece", scope);
        let kind = written.solid.unwrap_or("point");
        let mut sizes: Vec<Option<Expr>> = Vec::new();
        for (key, formula) in &written.sizes {
            let what = format!("the {key} of this {kind}");
            let size = self.constant(formula.as_ref(), &what, scope);
            sizes.push(size.filter(|&e| self.not_negative(e, &what, formula.as_ref())));
        }
        let at = match &written.at {
            None => Some([Expr::ZERO; 3]),
            Some(at) => self.constants(Some(at), "the place of this piece", scope),
        };
        let turn = self.turn(&written.turn, scope);
        let sizes: Vec<Expr> = sizes.into_iter().collect::<Option<_>>()?;
        let solid = match (written.solid, &sizes[..]) {
            (None, _) => Solid::Point,
            (Some("sphere"), &[radius]) => Solid::Sphere(radius),
            (Some("spherical-shell" | "shell"), &[radius]) => Solid::SphericalShell(radius),
            (Some("cylinder"), &[radius, length]) => Solid::Cylinder { radius, length },
            (Some("cylindrical-shell"), &[radius, length]) => {
                Solid::CylindricalShell { radius, length }
            }
            (Some("cone"), &[radius, height]) => Solid::Cone { radius, height },
            (Some("disc"), &[radius]) => Solid::Disc(radius),
            (Some("ring"), &[radius]) => Solid::Ring(radius),
            (Some("rod"), &[length]) => Solid::Rod(length),
            (Some("cuboid"), &[x, y, z]) => Solid::Cuboid([x, y, z]),
            (Some(_), _) => return None,
        };
        Some(Piece { solid, mass: mass?, at: at?, turn: turn?, place: written.place.clone() })
    }

    fn turn(&mut self, written: &DraftTurn, scope: &mut Scope) -> Option<PieceOrientation> {
        Some(match written {
            DraftTurn::None => PieceOrientation::None,
            DraftTurn::Axis { axis, angle } => {
                let read = self.constants(axis.as_ref(), "the axis of this piece", scope);
                let angle = self.constant(angle.as_ref(), "the angle of this piece", scope);
                let read = read?;
                if read.into_iter().all(|e| self.at_start(e) == 0.0) {
                    let place = axis.as_ref().map_or(0..0, Spanned::span);
                    self.error(place, "this axis has no length, and so no direction");
                    return None;
                }
                PieceOrientation::Axis { axis: read, angle: angle? }
            }
            DraftTurn::Euler(angles) => PieceOrientation::Euler(self.constants(
                angles.as_ref(),
                "an angle of this piece",
                scope,
            )?),
        })
    }

    /// Reads an expression in parameters that has a value.
    fn constant(&mut self, f: Option<&Formula>, what: &str, scope: &mut Scope) -> Option<Expr> {
        let e = self.formula(scope, what, f?)?;
        self.finite(e, what, f?).then_some(e)
    }

    fn constants(&mut self, f: Option<&Formulas>, what: &str, scope: &mut Scope) -> Option<Point> {
        let read: Vec<Option<Expr>> =
            f?.get_ref().iter().map(|f| self.constant(Some(f), what, scope)).collect();
        Some([read[0]?, read[1]?, read[2]?])
    }

    fn not_negative(&mut self, e: Expr, what: &str, formula: Option<&Formula>) -> bool {
        let value = self.at_start(e);
        if let (true, Some(formula)) = (value < 0.0, formula) {
            let message = format!("{what} is {value}; a size must not be negative");
            self.error(formula.span(), message);
        }
        value >= 0.0
    }

    pub(super) fn attitude(&mut self, written: &DraftAttitude) {
        let source = match (&written.euler, &written.omega) {
            (Some(angles), None) => {
                let called = "an angle of [attitude]";
                let mut scope = Scope::new(&self.model, Allowed::Configuration, called);
                self.three(angles, called, &mut scope).map(AttitudeSource::Euler)
            }
            (None, Some(omega)) => {
                let called = "the angular velocity of [attitude]";
                let allowed = match self.model.mechanics {
                    Mechanics::Lagrangian { .. } => Allowed::Lagrangian,
                    Mechanics::Hamiltonian { .. } => Allowed::Hamiltonian,
                    Mechanics::Poisson { .. } => Allowed::Poisson,
                };
                let mut scope = Scope::new(&self.model, allowed, called);
                let omega = self.three(omega, called, &mut scope);
                let called = "the attitude at the start";
                let mut scope = Scope::new(&self.model, Allowed::Parameters, called);
                let start = match &written.start {
                    None => Some([Expr::ZERO; 3]),
                    Some(start) => self.constants(Some(start), called, &mut scope),
                };
                omega.zip(start).map(|(omega, start)| AttitudeSource::Rate { omega, start })
            }
            // reported where they were read
            _ => None,
        };
        if let (Some(attitude), Some(source)) = (&mut self.model.attitude, source) {
            attitude.source = source;
        }
    }

    fn three(&mut self, written: &Formulas, called: &str, scope: &mut Scope) -> Option<Point> {
        let read: Vec<Option<Expr>> =
            written.get_ref().iter().map(|f| self.formula(scope, called, f)).collect();
        Some([read[0]?, read[1]?, read[2]?])
    }
}
