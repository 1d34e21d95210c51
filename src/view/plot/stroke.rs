//! Strokes: the dots of straight lines, clipped, thin and bounded in number.
//!
//! In: end points in dot coordinates, with any bits. Out: calls with dots inside the plot. Never here: cells or colours.

/// The part of the segment `a`–`b` inside `[0, wide] × [0, high]` (Liang and Barsky, 1984), or `None` if there is none.
///
/// The ends must be finite and not so far apart that their difference overflows.
pub(super) fn clip(
    a: [f64; 2],
    b: [f64; 2],
    [wide, high]: [f64; 2],
) -> Option<([f64; 2], [f64; 2])> {
    let within = |[x, y]: [f64; 2]| x >= 0.0 && x <= wide && y >= 0.0 && y <= high;
    // This is the case for nearly every segment of a trail.
    if within(a) && within(b) {
        return Some((a, b));
    }
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (delta, room) in [(-dx, a[0]), (dx, wide - a[0]), (-dy, a[1]), (dy, high - a[1])] {
        if delta == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if delta < 0.0 {
            enter = enter.max(room / delta);
        } else {
            leave = leave.min(room / delta);
        }
    }
    let at = |t: f64| [a[0] + t * dx, a[1] + t * dy];
    // An end inside is returned unchanged.
    let first = if enter == 0.0 { a } else { at(enter) };
    let last = if leave == 1.0 { b } else { at(leave) };
    (enter <= leave).then_some((first, last))
}

/// A pen tip that follows segments and draws a line one dot wide.
///
/// Stepping along a smooth curve visits both dots at every corner of the staircase; the tip looks one dot ahead
/// and leaves those corners out.
#[derive(Clone, Debug)]
pub(super) struct Tip<Ink> {
    drawn: Option<[i32; 2]>,
    pending: Option<([i32; 2], Ink)>,
}

impl<Ink: Copy> Tip<Ink> {
    /// Creates a tip that does not touch the raster.
    pub(super) fn lifted() -> Self {
        Self { drawn: None, pending: None }
    }

    /// Follows a clipped segment. `last` is the greatest dot index on each axis.
    pub(super) fn follow(
        &mut self,
        (a, b): ([f64; 2], [f64; 2]),
        last: [i32; 2],
        ink: Ink,
        mut dot: impl FnMut([i32; 2], Ink),
    ) {
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        // Sampled at the middle of each step, where a line through the corners of dots is unambiguous.
        let mut sample = |t: f64| {
            let (x, y) = ((a[0] + t * dx) as i32, (a[1] + t * dy) as i32);
            self.touch([x.clamp(0, last[0]), y.clamp(0, last[1])], ink, &mut dot);
        };
        let length = dx.abs().max(dy.abs());
        if length <= 1.0 {
            return sample(0.5);
        }
        let steps = length.ceil() as u32;
        for step in 0..steps {
            sample((f64::from(step) + 0.5) / f64::from(steps));
        }
    }

    /// Draws the pending dot and lifts the pen.
    pub(super) fn lift(&mut self, mut dot: impl FnMut([i32; 2], Ink)) {
        if let Some((pending, ink)) = self.pending.take() {
            dot(pending, ink);
        }
        self.drawn = None;
    }

    fn touch(&mut self, next: [i32; 2], ink: Ink, dot: &mut impl FnMut([i32; 2], Ink)) {
        let before = self.pending.replace((next, ink));
        let Some((pending, old)) = before.filter(|(pending, _)| *pending != next) else { return };
        let corner =
            self.drawn.is_some_and(|d| (next[0] - d[0]).abs() == 1 && (next[1] - d[1]).abs() == 1);
        if !corner {
            dot(pending, old);
            self.drawn = Some(pending);
        }
    }
}
