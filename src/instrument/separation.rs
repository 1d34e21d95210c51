//! `separation`: how far the motions beside the main one are from it, as ln d against time.
//!
//! Neighbours part like e^{λt} where the motion is chaotic, and in proportion to t where it is regular; the slope is that
//! of the straight line while d is small beside the motion ([`SeparationPlot`](crate::analysis::DistanceHistory)).

mod way_back;

use std::sync::Arc;

use super::{
    Across, Columns, Entry, Heading, Ink, Instrument, Layer, Level, Measure, Need, Offer, Physics,
    Picture, Plot, PlotContext, Present, Properties, Returned, Stroke, Upwards,
};
use crate::analysis::{DistanceHistory as Distances, Slope};
use crate::num::significant;

const CURVES: Level = 1;
const SLOPE: Level = 2;

pub(super) struct SeparationPlot;

/// What is said of the straight line through a distance: its slope and how well that is known, and where it was measured.
fn sentences(number: usize, slope: Option<Slope>) -> Vec<String> {
    let Some(slope) = slope else { return vec![format!("{number}: too short for a slope")] };
    let short = |x: f64| significant(x, 3, 1e-4..1e4).replace('-', "−");
    let (rate, error) = (short(slope.rate), significant(slope.error, 1, 1e-4..1e4));
    vec![
        format!("{number}: slope {rate} ± {error}"),
        format!("from t = {} to {}", short(slope.from), short(slope.to)),
        format!("grown by e^{:.1}", slope.grown).replace('-', "−"),
    ]
}

const PROPERTIES: Properties = Properties {
    name: "separation",
    measures: &[
        Measure::new("motions", "how many motions are beside the main one", |context| {
            Some(context.present.separations.len() as f64)
        }),
        Measure::new(
            "slope",
            "the slope of ln d of the newest neighbour while d is small",
            |context| newest(context.present)?.2.map(|slope| slope.rate),
        ),
        Measure::new("grown", "by how much ln d has grown along that line", |context| {
            newest(context.present)?.2.map(|slope| slope.grown)
        }),
        Measure::new(
            "error",
            "the return error: how far a motion that was reversed came back to from its start",
            |context| context.present.returned?.error,
        ),
        Measure::new(
            "expected",
            "the same as it is expected: the errors of all steps so far, each grown on the way back since",
            |PlotContext { present, answer, .. }| {
                let returned = present.returned?;
                way_back::expected(returned, answer, returned.elapsed[0])
            },
        ),
        Measure::new(
            "distance",
            "the distance of the newest motion from the main one",
            |context| {
                let last = newest(context.present)?.1.points().last()?;
                Some(crate::num::math::exp(last[1]))
            },
        ),
    ],
    ..Properties::PLAIN
};

impl Instrument for SeparationPlot {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
    }

    fn offers(&self, _physics: Physics<'_>) -> Vec<Offer> {
        vec![Offer::new(
            "separation",
            "ln of the distance from the motions beside this one, against time",
            Columns::new(),
        )]
    }

    fn words(&self, _plot: &Plot, _physics: Physics<'_>) -> String {
        "separation of motions".to_owned()
    }

    fn heading(&self, _plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        if let Some(returned) = present.returned {
            return Some(way_back::heading(returned));
        }
        let entries = match newest(present) {
            None => vec![Entry::Words("none beside this motion: d adds a neighbour".to_owned())],
            Some((number, _, None)) => {
                vec![Entry::Words(format!("{number}: too short for a slope"))]
            }
            Some((number, _, Some(slope))) => vec![
                Entry::Number(format!("{number}: slope"), slope.rate),
                Entry::Words(format!("grown by e^{:.1}", slope.grown)),
            ],
        };
        Some(Heading { title: "Separation ln d".to_owned(), given: false, entries })
    }

    fn across(&self, PlotContext { present, .. }: PlotContext<'_>) -> Across {
        if let Some(Returned { elapsed: [_, all], .. }) = present.returned {
            return Across::Named(
                "time run backwards".to_owned(),
                [0.0, all.max(f64::MIN_POSITIVE)],
            );
        }
        Across::Times(range(present, 0).unwrap_or([present.time, present.time + 1.0]))
    }

    fn awaits(&self, PlotContext { present, .. }: PlotContext<'_>) -> Option<String> {
        let none = present.separations.is_empty() && present.returned.is_none();
        none.then(|| {
            "ln d against time: how far another motion departs from this one. d adds a neighbour that \
             starts close by, P pins this run."
                .to_owned()
        })
    }

    fn picture(&self, context: PlotContext<'_>, _seen: [f64; 2]) -> Option<Picture> {
        let PlotContext { present, answer, .. } = context;
        let mut layers = Vec::new();
        for (number, distances) in present.separations {
            let ink = Ink::Companion(*number);
            layers.push((CURVES, Layer::Line(distances.points().to_vec(), ink.into())));
        }
        if let Some(returned) = present.returned {
            return Some(way_back::picture((returned, answer), layers, range(present, 1)));
        }
        if present.separations.is_empty() {
            let none = "no motion beside this one: d adds a neighbour, P pins this run";
            layers.push((SLOPE, Layer::Legend(vec![none.to_owned()])));
        }
        if let Some((_, _, Some(slope))) = newest(present) {
            let ends = [slope.from, slope.to].map(|t| [t, slope.level + slope.rate * t]);
            let stroke = Stroke { ink: Ink::Accent, covering: Some(0.5) };
            layers.push((SLOPE, Layer::Line(ends.to_vec(), stroke)));
        }
        let range = range(present, 1).unwrap_or([-1.0, 1.0]);
        if let Some((number, _, slope)) = newest(present) {
            layers.push((SLOPE, Layer::Legend(sentences(number, slope))));
        }
        let upwards = Upwards::Named("ln d".to_owned(), range);
        Some(Picture::Axes { upwards, layers, occurrences: None })
    }

    fn job(&self, context: PlotContext<'_>) -> Need {
        way_back::job(context)
    }
}

/// The last of the motions: its number, its distances and their slope.
fn newest<'a>(present: &Present<'a>) -> Option<(usize, &'a Arc<Distances>, Option<Slope>)> {
    let (number, distances) = present.separations.last()?;
    Some((*number, distances, distances.slope()))
}

fn range(present: &Present<'_>, axis: usize) -> Option<[f64; 2]> {
    let all = present.separations.iter().flat_map(|(_, d)| d.points()).map(|p| p[axis]);
    let (least, greatest) =
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| (lo.min(x), hi.max(x)));
    (least < greatest).then_some([least, greatest])
}
