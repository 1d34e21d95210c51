//! Axes: lines at the left and below, ticks with labels, titles with units.
//!
//! In: two titled scales and an area. Out: the axes on the buffer, and the [`PlotFrame`] left for the plot. The frame is a
//! pure function of the area, so that mouse handling can compute it too. Never here: data.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;

use super::scale::{PlotFrame, Scale, ScaleKind};
use super::ticks::Ticks;
use crate::view::glyphs::{Glyphs, TextWidth};
use crate::view::number::power;
use crate::view::theme::{Role, Theme};

/// The least columns and rows for axes; below them the plot takes all the room.
const LEAST: (u16, u16) = (16, 5);

/// An axis with its title.
#[derive(Clone, Debug)]
pub struct DrawnAxis {
    /// The quantity: `θ`.
    pub title: String,
    /// The unit: `rad`; may be empty.
    pub unit: String,
    /// The range shown.
    pub scale: Scale,
}

impl DrawnAxis {
    /// Creates an axis from its parts.
    pub fn new(title: impl Into<String>, unit: impl Into<String>, scale: Scale) -> Self {
        Self { title: title.into(), unit: unit.into(), scale }
    }

    /// Returns `θ [rad] ×10⁻³`, without the empty parts.
    fn heading(&self, exponent: i32, glyphs: Glyphs) -> String {
        let title = glyphs.text(&self.title);
        let unit = match self.unit.as_str() {
            "" => String::new(),
            unit => format!("[{}]", glyphs.text(unit)),
        };
        let factor = if exponent == 0 { String::new() } else { power(exponent, glyphs) };
        [&*title, &unit, &factor]
            .into_iter()
            .filter(|part| !part.is_empty())
            .collect::<Vec<_>>()
            .join(" ")
    }
}

/// A pair of axes.
#[derive(Clone, Debug)]
pub struct Axes {
    /// The horizontal axis.
    pub x: DrawnAxis,
    /// The vertical axis.
    pub y: DrawnAxis,
    /// Whether a unit has the same length on both axes.
    pub equal: bool,
    /// By which parts of its width and height the window of such axes is moved.
    pub pan: [f64; 2],
}

/// The positions of everything.
struct Plan {
    frame: PlotFrame,
    x: Ticks,
    y: Ticks,
    bare: bool,
}

impl Axes {
    /// Creates axes with free proportions.
    pub fn new(x: DrawnAxis, y: DrawnAxis) -> Self {
        Self { x, y, equal: false, pan: [0.0; 2] }
    }

    /// Makes units equally long on both axes, so that circles are round.
    #[must_use]
    pub fn equal(self) -> Self {
        Self { equal: true, ..self }
    }

    /// The same axes with equal units, whose window is moved by parts of its width and height.
    #[must_use]
    pub fn panned(self, pan: [f64; 2]) -> Self {
        Self { pan, ..self }
    }

    /// Returns the frame left for the plot.
    pub fn frame(&self, area: Rect, glyphs: Glyphs) -> PlotFrame {
        self.beside_labels(area, glyphs).map_or_else(|| self.over(area), |(frame, _)| frame)
    }

    /// Draws the axes and returns the frame left for the plot.
    pub fn draw(
        &self,
        area: Rect,
        buffer: &mut Buffer,
        theme: &Theme,
        glyphs: Glyphs,
    ) -> PlotFrame {
        let plan = self.plan(area, glyphs);
        let mut context = StrokeContext { buffer, area, theme, glyphs };
        context.zero_lines(&plan.frame);
        if !plan.bare {
            context.left(&plan, &self.y.heading(plan.y.exponent, glyphs));
            context.below(&plan, &self.x.heading(plan.x.exponent, glyphs));
        }
        plan.frame
    }

    fn plan(&self, area: Rect, glyphs: Glyphs) -> Plan {
        let Some((frame, y)) = self.beside_labels(area, glyphs) else {
            let frame = self.over(area);
            return Plan { frame, x: Ticks::default(), y: Ticks::default(), bare: true };
        };
        let x = x_ticks(&frame, area, glyphs);
        Plan { frame, x, y, bare: false }
    }

    /// The frame beside the labels of the vertical axis, and its ticks; `None` in an area too small for labels.
    fn beside_labels(&self, area: Rect, glyphs: Glyphs) -> Option<(PlotFrame, Ticks)> {
        if area.width < LEAST.0 || area.height < LEAST.1 {
            return None;
        }
        let named = !self.y.title.is_empty() || !self.y.unit.is_empty();
        let (frame, y) = self.below_heading(area, u16::from(named), glyphs);
        // The power of ten that the labels share stands in the row of the heading.
        let factor = !named && y.exponent != 0;
        Some(if factor { self.below_heading(area, 1, glyphs) } else { (frame, y) })
    }

    /// The frame beside the labels and below so many rows of a heading, and the ticks.
    fn below_heading(&self, area: Rect, rows: u16, glyphs: Glyphs) -> (PlotFrame, Ticks) {
        let inside = |margin: u16| Rect {
            x: area.x.saturating_add(margin),
            y: area.y.saturating_add(rows),
            width: area.width - margin,
            height: area.height - rows - 2,
        };
        // The width of the labels depends on the range, which with equal units depends on the width; then two rounds suffice.
        let mut margin = 6;
        let mut frame = self.over(inside(margin));
        let mut y = Ticks::default();
        for _ in 0..if self.equal { 2 } else { 1 } {
            y = Ticks::of(&frame.y, usize::from(frame.area.height.div_ceil(3)).max(3), glyphs);
            let widest = y.marks.iter().map(|tick| tick.label.width()).max().unwrap_or(0);
            margin = (widest as u16 + 2).min(area.width / 3);
            frame = self.over(inside(margin));
        }
        (frame, y)
    }

    fn over(&self, area: Rect) -> PlotFrame {
        if !self.equal {
            return PlotFrame::new(self.x.scale, self.y.scale, area);
        }
        let still = PlotFrame::equal(self.x.scale, self.y.scale, area);
        match self.pan {
            [0.0, 0.0] => still,
            [right, up] => PlotFrame::new(still.x.panned(right), still.y.panned(up), area),
        }
    }
}

/// As many ticks as have room for separate labels.
fn x_ticks(frame: &PlotFrame, area: Rect, glyphs: Glyphs) -> Ticks {
    let most = usize::from(frame.area.width / 6).clamp(2, 12);
    let apart = |ticks: &Ticks| {
        let places: Vec<_> = label_places(ticks, frame, area).collect();
        places.windows(2).all(|pair| pair[0].0 + pair[0].1 + 2 <= pair[1].0)
    };
    (1..=most).rev().map(|most| Ticks::of(&frame.x, most, glyphs)).find(apart).unwrap_or_default()
}

/// The first column and the width of each label of the horizontal axis.
fn label_places(ticks: &Ticks, frame: &PlotFrame, area: Rect) -> impl Iterator<Item = (u16, u16)> {
    ticks.marks.iter().filter_map(move |tick| {
        let column = frame.cell([tick.value, frame.y.middle()])?.x;
        let width = tick.label.width() as u16;
        let last = area.right().saturating_sub(width);
        Some((column.saturating_sub(width / 2).clamp(area.left().min(last), last), width))
    })
}

/// The buffer and what is needed to draw on it.
struct StrokeContext<'a> {
    buffer: &'a mut Buffer,
    area: Rect,
    theme: &'a Theme,
    glyphs: Glyphs,
}

impl StrokeContext<'_> {
    fn put(&mut self, x: u16, y: u16, symbol: &str, style: Style) {
        let inside = self.area.contains(Position::new(x, y));
        if let Some(cell) = self.buffer.cell_mut((x, y)).filter(|_| inside) {
            cell.set_symbol(symbol).set_style(style);
        }
    }

    /// Writes text from a column on, cut at the end of the area.
    fn write(&mut self, x: u16, y: u16, text: &str, style: Style) {
        let room = self.area.right().min(self.buffer.area.right()).saturating_sub(x);
        if !self.buffer.area.contains(Position::new(x, y)) {
            return;
        }
        if self.glyphs.columns(text).is_none() {
            self.buffer.set_stringn(x, y, text, usize::from(room), style);
            return;
        }
        let from = self.buffer.index_of(x, y);
        let cells = &mut self.buffer.content[from..from + usize::from(room)];
        for (cell, letter) in cells.iter_mut().zip(text.chars()) {
            cell.set_char(letter).set_style(style);
        }
    }

    fn zero_lines(&mut self, frame: &PlotFrame) {
        let inside =
            |scale: &Scale| scale.kind != ScaleKind::Log && scale.lo < 0.0 && scale.hi > 0.0;
        let style = self.theme[Role::Border];
        let Rect { x, y, .. } = frame.area;
        let row = frame.cell([frame.x.middle(), 0.0]).filter(|_| inside(&frame.y));
        let column = frame.cell([0.0, frame.y.middle()]).filter(|_| inside(&frame.x));
        if let Some(row) = row {
            for x in (x..frame.area.right()).step_by(self.glyphs.pick(1, 2)) {
                self.put(x, row.y, self.glyphs.pick("┈", "."), style);
            }
        }
        if let Some(column) = column {
            for y in y..frame.area.bottom() {
                self.put(column.x, y, self.glyphs.pick("┊", "."), style);
            }
        }
    }

    fn left(&mut self, plan: &Plan, heading: &str) {
        let Rect { x, y, height, .. } = plan.frame.area;
        let line = x.saturating_sub(1);
        for row in y..y.saturating_add(height) {
            self.put(line, row, self.glyphs.pick("│", "|"), self.theme[Role::Border]);
        }
        let mut labelled = None;
        for tick in &plan.y.marks {
            let Some(cell) = plan.frame.cell([plan.frame.x.middle(), tick.value]) else { continue };
            self.put(line, cell.y, self.glyphs.pick("┤", "+"), self.theme[Role::Border]);
            // in a pane of few rows two ticks may share one, which has room for one label
            if labelled.replace(cell.y) == Some(cell.y) {
                continue;
            }
            let width = tick.label.width() as u16;
            let start = line.saturating_sub(width).max(self.area.x);
            self.write(start, cell.y, &tick.label, self.theme[Role::Dim]);
        }
        if y > self.area.y {
            let start = line.saturating_sub(heading.width() as u16 / 2).max(self.area.x);
            self.write(start, self.area.y, heading, self.theme[Role::Text]);
        }
    }

    fn below(&mut self, plan: &Plan, heading: &str) {
        let Rect { x, width, .. } = plan.frame.area;
        let row = plan.frame.area.bottom();
        let border = self.theme[Role::Border];
        self.put(x.saturating_sub(1), row, self.glyphs.pick("└", "+"), border);
        for column in x..x.saturating_add(width) {
            self.put(column, row, self.glyphs.pick("─", "-"), border);
        }
        let places: Vec<_> = label_places(&plan.x, &plan.frame, self.area).collect();
        for (tick, (start, _)) in plan.x.marks.iter().zip(places) {
            let Some(cell) = plan.frame.cell([tick.value, plan.frame.y.middle()]) else { continue };
            self.put(cell.x, row, self.glyphs.pick("┬", "+"), border);
            self.write(start, row.saturating_add(1), &tick.label, self.theme[Role::Dim]);
        }
        // The title is in the axis line itself, at its end, and takes no row.
        let long = heading.width() as u16 + 1;
        if !heading.is_empty() && long < width {
            let start = plan.frame.area.right() - long;
            self.write(start, row, &format!(" {heading}"), self.theme[Role::Text]);
        }
    }
}
