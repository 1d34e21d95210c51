//! `time`: quantities against time, each in its colour.

use super::{
    Across, Axis, Columns, Entry, Heading, Ink, Instrument, Layer, Level, MarkerShape, MotionCurve,
    Offer, Physics, Picture, Plot, PlotContext, Present, Properties, Upwards,
};

/// The levels of the picture: the marks lie over the curves, and the current state over the marks. The curves share one, so that
/// where two of them cross neither has a gap.
const CURVES: Level = 200;
const MARK: Level = 201;
const NOW: Level = 202;

pub(super) struct Time;

const PROPERTIES: Properties = Properties {
    name: "time",
    written: &[Axis { several: true, ..Axis::UPWARDS }],
    curve: Some(MotionCurve::AgainstTime),
    is_over_time: true,
    // the window ends at the current time
    anchor: 1.0,
    ..Properties::PLAIN
};

impl Instrument for Time {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
    }

    fn opening(&self, physics: Physics<'_>) -> Vec<Columns> {
        physics.positions().map(|(_, channel)| vec![vec![channel]]).collect()
    }

    fn offers(&self, _physics: Physics<'_>) -> Vec<Offer> {
        vec![Offer::new("t", "one or several quantities over time", Columns::new())]
    }

    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String {
        let shown = plot.columns.iter().flatten().map(|channel| physics.shown(*channel));
        format!("{} against t", shown.collect::<Vec<_>>().join(", "))
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let curves = plot.columns.first()?.iter().enumerate();
        let mut entries: Vec<Entry> =
            curves.map(|(i, channel)| Entry::Curve(i, *channel)).collect();
        entries.push(Entry::Occurrences);
        Some(plot.heading(present.physics, "Time", entries))
    }

    fn across(&self, _context: PlotContext<'_>) -> Across {
        Across::Time
    }

    fn picture(&self, context: PlotContext<'_>, _seen: [f64; 2]) -> Option<Picture> {
        let PlotContext { plot, present, .. } = context;
        let channels = plot.columns.first()?;
        let curve = |(index, &channel): (usize, &usize)| {
            let now = [present.time, present.value(channel)];
            [
                (CURVES, Layer::Curve { index, channel }),
                (NOW, Layer::Point(now, MarkerShape::Disc, Ink::Curve(index))),
            ]
        };
        let beside = channels.iter().map(|channel| (CURVES, Layer::CompanionCurves(*channel)));
        let curves = channels.iter().enumerate().rev().flat_map(curve);
        let layers = beside.chain(curves).collect();
        let occurrences = Some((MARK, [None, channels.first().copied()]));
        Some(Picture::Axes { upwards: Upwards::Shared(channels.clone()), layers, occurrences })
    }
}
