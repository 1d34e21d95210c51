//! The motion in space: the file's shapes and the tracks they leave, seen through the camera.
//!
//! In: shapes, channels, the camera. Out: cells. Never here: the meaning of the shapes.

mod annotation;
mod arrow;
mod body;
mod circle;
mod colours;
mod common_scale;
mod edge_block;
mod filling;
mod ghost;
mod line;
mod mass_cells;
mod mechanics;
mod names;
mod outline;
mod reference_frame;
mod rod;
mod scene;
mod shading;
mod solid;
mod spring;
mod surface;
mod track;

use ratatui::layout::{Position, Rect};
use ratatui::style::Style;

use super::cache::FrameCache;
use super::canvas::Canvas;
use super::companions;
use super::glyphs::Glyphs;
use super::ink::is_colourless;
use super::plot::{Camera, DepthBuffer, Letters, Marker, Pen, PlotFrame, Raster, Visibility};
use super::quantity::Quantities;
use super::theme::Role;
use crate::instrument::CameraPose;
use crate::mechanics::Apparent;
use crate::model::{Point, Shape};
use annotation::{Label, LegendLine, compass, legend, legend_above};
use body::Outline;
use colours::colours;
use filling::Filling;
use mechanics::ComparedMechanics;
use reference_frame::ReferenceFrame;
use scene::Scene;
use shading::Shading;

/// The least radius, in cells, of a mass drawn with its size: in a plane, and in space, where tracks run across it.
const LEAST: [f64; 2] = [1.2, 2.0];

/// The least radius, in columns, of a mass where dots are blocks.
const BLOCKS: f64 = 1.5;

/// The layers of the picture, from the lowest.
const SURFACE: u8 = 0;
const GROUND: u8 = 1;
const TRACK: u8 = 2;
const SOLID: u8 = 3;
const BODY: u8 = 4;

/// The number of steps in which lines become dimmer with their distance.
const DISTANCES: usize = 4;

/// Draws the picture inside the frame.
pub(super) fn draw(canvas: &mut Canvas<'_>, area: Rect, q: &Quantities<'_>, eye: &CameraPose) {
    if area.is_empty() {
        return;
    }
    let pan = eye.pan.map(|offset| -offset);
    let camera = Camera { yaw: eye.yaw, pitch: eye.pitch, zoom: eye.zoom, pan, ..Camera::FACE_ON };
    let beside: Vec<_> =
        q.snapshot.companions.iter().map(|one| companions::as_main(q.snapshot, one)).collect();
    let beside: Vec<_> = beside.iter().map(|snapshot| Quantities { snapshot, ..*q }).collect();
    let reference_frame = ReferenceFrame::of(q, eye.frame);
    let outline = Outline::of(q, *eye);
    let scene = Scene::of((q, outline.as_ref()), *eye, reference_frame.as_ref());
    let colours = colours(q, *eye);
    let mechanics = ComparedMechanics::of(q, *eye, &colours);
    let whole = area;
    let lines = legend_lines(canvas, q, *eye, mechanics.as_ref());
    let (above, area) = legend_above(area, &lines);
    legend(canvas, above, &lines);
    let share = common_scale::share(canvas, whole, q, *eye);
    let frame = common_scale::widened(scene.frame(&camera, area), share);
    let raster = Raster::new(area, canvas.style.glyphs);
    let depth = DepthBuffer::new(&frame, raster.size());
    let mut painter = ScenePainter {
        mechanics,
        range: scene.depths(&camera),
        outline: outline.as_ref(),
        receding: Vec::new(),
        letters: None,
        labels: Vec::new(),
        surfaces: Vec::new(),
        depth,
        shading: Shading::new(area, canvas.style.glyphs),
        edges: Raster::new(area, canvas.style.glyphs),
        raster,
        frame,
        camera,
        q,
        reference_frame,
        seen: eye.frame,
        eye: *eye,
        beside: None,
        colours,
    };
    for (shape, _) in q.lab.shapes(*eye) {
        painter.surfaces(shape);
    }
    painter.fill();
    let mut cache = std::mem::take(&mut canvas.cache);
    for (one, there) in q.snapshot.companions.iter().zip(&beside) {
        painter.take(there, Some(one.number));
        for (shape, _) in q.lab.shapes(*eye) {
            painter.ghost(shape, q, &mut cache);
        }
    }
    painter.take(q, None);
    for (shape, rod) in q.lab.shapes(*eye) {
        match shape {
            Shape::Line { from, to } if painter.is_crowded_spoke([from, to]) => {}
            Shape::Line { from, to } if rod && !painter.is_scenery([from, to]) => {
                painter.rod(from, to);
            }
            _ => painter.shape(shape, &mut cache),
        }
    }
    painter.halos();
    painter.name_comparison_out_of_view();
    if canvas.regions.is_some() {
        canvas.masses = painter.draggable();
    }
    canvas.cache = cache;
    painter.apparent(apparent(q, *eye));
    painter.raster.draw(canvas.buffer);
    let shading = &painter.shading;
    // What is written comes before the surfaces, so that it has their backgrounds and stands out from them.
    let is_mark = |at| painter.raster.has_marker(at);
    let written = annotation::labels(canvas, area, &painter.frame, &painter.labels, is_mark);
    if eye.pitch < std::f64::consts::FRAC_PI_2 {
        compass(canvas, area, &camera);
    }
    let is_written = |at: Position| written.iter().any(|place| place.contains(at));
    painter
        .edges
        .draw_on_blank(canvas.buffer, |index, at| shading.has_edges(index) && !is_written(at));
    shading.draw(canvas.buffer, &canvas.style.theme, is_written);
}

/// The lines of the legend: what has a colour of its own. Without colours names stand beside what they name.
fn legend_lines(
    canvas: &Canvas<'_>,
    q: &Quantities<'_>,
    eye: CameraPose,
    mechanics: Option<&ComparedMechanics>,
) -> Vec<LegendLine> {
    if is_colourless(canvas.style) {
        return Vec::new();
    }
    let mut lines = annotation::forces(canvas, &arrow::apparent_forces(q, apparent(q, eye)));
    lines
        .extend(mechanics.into_iter().flat_map(|both| annotation::mechanics(canvas, both.colours)));
    lines
}

/// The apparent forces in the frame of reference of a picture.
fn apparent<'a>(q: &Quantities<'a>, eye: CameraPose) -> &'a [Apparent] {
    let frames = &q.lab.loaded.equations.supplements.frames;
    eye.frame.and_then(|frame| frames.get(frame)).map_or(&[][..], Vec::as_slice)
}

struct ScenePainter<'a> {
    raster: Raster,
    /// The edges of shaded surfaces; where these are dots, their edges are on the raster.
    edges: Raster,
    frame: PlotFrame,
    camera: Camera,
    q: &'a Quantities<'a>,
    reference_frame: Option<ReferenceFrame>,
    eye: CameraPose,
    /// The index of the reference frame.
    seen: Option<usize>,
    /// The number of the motion beside the main one that is being drawn.
    beside: Option<usize>,
    depth: DepthBuffer,
    /// The surfaces as they are lit.
    shading: Shading,
    surfaces: Vec<Filling>,
    /// The characters of lines in ASCII, where these are not what their layer gives them.
    letters: Option<Letters>,
    /// How near to the eye the back and the front of the scene are; `None` in a plane.
    range: Option<[f64; 2]>,
    /// The model's body, if there is one in the picture.
    outline: Option<&'a Outline>,
    /// Styles, and how they look at each distance.
    receding: Vec<(Style, [Style; DISTANCES])>,
    labels: Vec<Label>,
    colours: Vec<Point>,
    /// The right mechanics and the wrong one, where both are in the picture.
    mechanics: Option<ComparedMechanics>,
}

impl<'a> ScenePainter<'a> {
    /// Draws this motion from now on.
    fn take(&mut self, q: &'a Quantities<'a>, beside: Option<usize>) {
        (self.q, self.beside) = (q, beside);
        self.reference_frame = ReferenceFrame::of(q, self.seen);
    }
}

impl ScenePainter<'_> {
    fn shape(&mut self, shape: &Shape, cache: &mut FrameCache) {
        let theme = &self.q.style.theme;
        let solid = Pen::new(theme[Role::Text], SOLID);
        let ground = Pen::shaded(theme.line(Role::Level), GROUND);
        // a line in fragments cannot be told from the blanks beside it, so what is fixed is dim, but whole
        let fixed = Pen::new(ground.style, GROUND);
        match shape {
            Shape::Line { from, to } => {
                let pen = if self.is_scenery([from, to]) { &fixed } else { &solid };
                let (from, to) = (self.point(from), self.point(to));
                self.curve(&[from, to], pen);
            }
            Shape::Spring { from, to } => {
                let (from, to) = (self.point(from), self.point(to));
                self.spring(from, to, &solid);
            }
            Shape::Circle { centre, radius, normal } => {
                // In space a circle that does not turn is part of the scenery.
                let rests = scene::rests(self.q, normal)
                    && (self.range.is_some() || scene::rests(self.q, centre));
                let solid = self.own_pen(centre, solid);
                let (centre, normal) = (self.point(centre), self.direction(normal));
                let rim = circle::circle(centre, self.q.number(*radius), normal);
                let still = if self.range.is_some() { &ground } else { &fixed };
                self.curve(&rim, if rests { still } else { &solid });
            }
            Shape::Mass { at, radius } => {
                let radius = radius.map(|radius| self.q.number(radius));
                self.mass(at, radius);
            }
            Shape::Trace { at } => {
                self.track(at, cache);
                self.name_mechanics(at);
            }
            Shape::Caption { at, text } => {
                let at = self.point(at);
                if self.sight(at) == Visibility::Clear {
                    self.label(at, None, text, theme[Role::Text]);
                }
            }
            Shape::Vector { at, components, label } => {
                let (foot, along) = (self.point(at), self.direction(components));
                let style = self.vector_style(at, components);
                self.arrow(foot, along, &Pen::new(style, SOLID));
                let tip = [0, 1, 2].map(|k| foot[k] + along[k]);
                let some = !label.is_empty() && along != [0.0; 3];
                if some && self.sight(tip) != Visibility::Hidden {
                    self.label(tip, Some(foot), label, style);
                }
            }
            Shape::Disc { centre: own, .. }
            | Shape::Cone { base: own, .. }
            | Shape::Cylinder { from: own, .. } => {
                let pen = self.own_pen(own, solid);
                self.outline(shape, &pen);
            }
            Shape::Sphere { centre, radius } => {
                self.limb(self.point(centre), self.q.number(*radius).abs(), &ground);
            }
            Shape::Path { points } => {
                let rests = points.iter().all(|point| scene::rests(self.q, point));
                let pen = if rests && self.range.is_none() { &fixed } else { &ground };
                let points: Vec<_> = points.iter().map(|point| self.point(point)).collect();
                self.curve(&points, pen);
            }
            Shape::Body { at } => self.body(at),
            Shape::Plane { at, normal, size } => {
                let (at, normal) = (self.point(at), self.direction(normal));
                let edge = self.q.number(*size);
                let corners = circle::square(at, normal, edge);
                self.curve(&corners, &ground);
            }
        }
    }

    /// Whether a line between two points is part of the scenery: it stays where it is.
    fn is_scenery(&self, ends: [&Point; 2]) -> bool {
        ends.into_iter().all(|end| scene::rests(self.q, end))
    }

    /// The current position of a point of a shape in the reference frame.
    fn point(&self, point: &Point) -> [f64; 3] {
        let r = self.q.point(point);
        self.reference_frame
            .as_ref()
            .map_or(r, |reference_frame| reference_frame.point(&self.q.snapshot.values, r))
    }

    /// The current components of a direction in the reference frame.
    fn direction(&self, direction: &Point) -> [f64; 3] {
        self.direction_of(self.q.point(direction))
    }

    /// The components of a direction in the reference frame.
    fn direction_of(&self, v: [f64; 3]) -> [f64; 3] {
        self.reference_frame
            .as_ref()
            .map_or(v, |reference_frame| reference_frame.direction(&self.q.snapshot.values, v))
    }

    fn flat(&self, point: [f64; 3]) -> [f64; 2] {
        let [right, up, _] = self.camera.project(point);
        [right, up]
    }

    /// How a point is seen among the surfaces.
    fn sight(&self, point: [f64; 3]) -> Visibility {
        self.depth.sight_of(self.camera.project(point))
    }

    /// The pen for something at a point: dim behind a see-through surface, `None` behind another one.
    fn seen_at(&mut self, point: [f64; 3], pen: &Pen) -> Option<Pen> {
        match self.sight(point) {
            Visibility::Clear => Some(*pen),
            Visibility::Veiled => Some(self.dim(pen)),
            Visibility::Hidden => None,
        }
    }

    /// A pen as it looks at the back of the picture.
    fn dim(&mut self, pen: &Pen) -> Pen {
        Pen { style: self.receding(pen.style)[DISTANCES - 1], ..*pen }
    }

    /// The width of a column of cells.
    fn column(&self) -> f64 {
        (self.frame.x.hi - self.frame.x.lo).abs() / f64::from(self.frame.area.width.max(1))
    }

    /// A radius in cells, if it is large enough to be drawn.
    fn cells(&self, radius: f64) -> Option<f64> {
        let least = LEAST[usize::from(self.range.is_some())];
        Some(radius / self.column()).filter(|cells| cells.is_finite() && *cells > least)
    }

    /// The radius with which a mass is drawn as a disc: its own if it is large enough; where dots are blocks, which a marker among
    /// them is lost in, at least that of three of them.
    fn disc_radius(&self, radius: Option<f64>) -> Option<f64> {
        let own = radius.map(f64::abs).filter(|radius| self.cells(*radius).is_some());
        let of_blocks = self.q.style.glyphs == Glyphs::HalfBlock;
        own.or_else(|| of_blocks.then(|| BLOCKS * self.column()))
    }

    /// The rim of a solid, with as many corners as its size on the screen needs.
    fn rim(&self, centre: [f64; 3], radius: f64, normal: [f64; 3]) -> Vec<[f64; 3]> {
        circle::rim(centre, radius, normal, self.spacing(radius))
    }

    /// Every how many corners are enough for a rim.
    fn spacing(&self, radius: f64) -> usize {
        let dot = (self.frame.x.hi - self.frame.x.lo) / f64::from(self.raster.size()[0].max(1));
        circle::spacing((radius / dot).abs())
    }

    /// A point of the body, given from its centre of mass, in the reference frame.
    fn place(&self, centre: [f64; 3], own: [f64; 3]) -> [f64; 3] {
        let r = [0, 1, 2].map(|k| centre[k] + own[k]);
        let frame = self.reference_frame.as_ref();
        frame.map_or(r, |frame| frame.point(&self.q.snapshot.values, r))
    }

    /// Draws a point mass: a disc of its radius, or a marker if that is smaller than a cell.
    fn mass(&mut self, point: &Point, radius: Option<f64>) {
        let at = self.point(point);
        let style = self.q.style.theme.curve(self.colour(point));
        let pen = Pen::new(style, BODY);
        let centre = self.flat(at);
        let own = radius.map(f64::abs).filter(|radius| self.cells(*radius).is_some());
        if let Some(radius) = own {
            if !self.is_ball(radius) {
                self.raster.disc(&self.frame, centre, radius, &pen);
            }
        } else if self.sight(at) != Visibility::Hidden {
            // a mass is as bright behind what it is seen through, so that it is never lost
            match self.disc_radius(radius) {
                Some(radius) => self.raster.disc(&self.frame, centre, radius, &pen),
                None => self.raster.marker(&self.frame, centre, Marker::Disc, &pen),
            }
        }
    }

    /// The colour of the mass at a point, and of its trace: the masses that move are counted first, then one that stays
    /// where it is, such as a sun, then the traces of other points.
    fn colour(&self, point: &Point) -> usize {
        colours::colour(self.q, &self.colours, point)
    }

    /// Draws the pieces of the model's body and its principal axes, with its centre of mass at a point.
    fn body(&mut self, at: &Point) {
        let Some(outline) = self.outline else { return };
        let at = self.q.point(at);
        let place = |own: &[f64; 3]| self.place(at, *own);
        let placed = |lines: &[Vec<[f64; 3]>]| -> Vec<Vec<[f64; 3]>> {
            lines.iter().map(|line| line.iter().map(place).collect()).collect()
        };
        let axes = placed(&outline.axes);
        let edges: Vec<_> =
            outline.pieces.iter().map(|piece| (piece.extents, placed(&piece.edges))).collect();
        let points: Vec<_> = outline.points.iter().map(place).collect();
        let theme = &self.q.style.theme;
        for line in axes {
            self.curve(&line, &Pen::shaded(theme.line(Role::Separatrix), TRACK));
        }
        let pen = Pen::new(theme[Role::Text], SOLID);
        for (extents, edges) in edges {
            let lines: Vec<&[[f64; 3]]> = edges.iter().map(Vec::as_slice).collect();
            self.edge(extents, &lines, &pen, |painter, pen| {
                for line in &lines {
                    painter.curve(line, pen);
                }
            });
        }
        for point in points {
            if let Some(pen) = self.seen_at(point, &Pen::new(theme.curve(0), BODY)) {
                let flat = self.flat(point);
                self.raster.marker(&self.frame, flat, Marker::Disc, &pen);
            }
        }
    }
}
