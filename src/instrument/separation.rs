//! `separation`: how far the motions beside the main one are from it, as ln d against time.
//!
//! Neighbours part like e^{λt} where the motion is chaotic, and in proportion to t where it is regular; the slope is that
//! of the straight line while d is small beside the motion ([`SeparationPlot`](crate::analysis::DistanceHistory)).

use std::sync::Arc;

use super::{
    Across, Answer, Columns, Entry, Heading, Ink, Instrument, Layer, Level, Measure, Offer,
    Physics, Picture, Plot, Present, Returned, Stroke, Upwards,
};
use crate::analysis::{DistanceHistory as Distances, Slope, expected_return};
use crate::num::significant;

/// The levels of the picture.
const CURVES: Level = 1;
const SLOPE: Level = 2;

/// The pieces of the line of what is expected.
const PARTS: u32 = 60;

/// The row.
pub(super) struct SeparationPlot;

impl Instrument for SeparationPlot {
    fn name(&self) -> &'static str {
        "separation"
    }

    fn shows_a_view(&self) -> bool {
        false
    }

    fn offers(&self, _physics: Physics<'_>) -> Vec<Offer> {
        vec![Offer {
            label: "separation".to_owned(),
            about: "ln of the distance from the motions beside this one, against time".to_owned(),
            columns: Columns::new(),
            view: None,
            over: Vec::new(),
        }]
    }

    fn words(&self, _plot: &Plot, _physics: Physics<'_>) -> String {
        "separation of motions".to_owned()
    }

    fn heading(&self, _plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        if let Some(returned) = present.returned {
            return Some(return_heading(present, returned));
        }
        let entries = match newest(present) {
            None => vec![Entry::Words("none beside this motion: d adds a neighbour".to_owned())],
            Some((number, _, None)) => {
                vec![Entry::Words(format!("{number}: too short for a slope"))]
            }
            Some((number, _, Some(slope))) => vec![
                Entry::Number(format!("{number}: λ ≈"), slope.rate),
                Entry::Words(format!("grown by e^{:.1}", slope.grown)),
            ],
        };
        Some(Heading { title: "Separation ln d".to_owned(), given: false, entries })
    }

    fn across(&self, _plot: &Plot, present: &Present<'_>, _answer: Option<&Answer>) -> Across {
        if let Some(Returned { gone: [_, all], .. }) = present.returned {
            return Across::Named("time gone back".to_owned(), [0.0, all.max(f64::MIN_POSITIVE)]);
        }
        Across::Times(range(present, 0).unwrap_or([present.time, present.time + 1.0]))
    }

    fn picture(
        &self,
        _plot: &Plot,
        present: &Present<'_>,
        _seen: [f64; 2],
        _answer: Option<&Answer>,
    ) -> Option<Picture> {
        let mut layers = Vec::new();
        for (number, distances) in present.separations {
            let ink = Ink::Companion(*number);
            layers.push((CURVES, Layer::Line(distances.points().to_vec(), ink.into())));
        }
        if let Some(returned) = present.returned {
            return Some(way_back(present, returned, layers));
        }
        if let Some((_, _, Some(slope))) = newest(present) {
            let ends = [slope.from, slope.to].map(|t| [t, slope.level + slope.rate * t]);
            let stroke = Stroke { ink: Ink::Accent, covering: Some(0.5) };
            layers.push((SLOPE, Layer::Line(ends.to_vec(), stroke)));
        }
        let range = range(present, 1).unwrap_or([-1.0, 1.0]);
        // among tabs there is no room for it in the heading
        let name = match newest(present) {
            Some((number, _, Some(slope))) => {
                let rate = significant(slope.rate, 3, 1e-4..1e4);
                format!("ln d   {number}: λ = {rate}, grown by e^{:.1}", slope.grown)
            }
            _ => "ln d".to_owned(),
        };
        Some(Picture::Axes { upwards: Upwards::Named(name, range), layers, occurrences: None })
    }

    fn measures(&self) -> &'static [Measure] {
        &[
            Measure {
                word: "motions",
                about: "how many motions are beside the main one",
                value: |_, present, _| Some(present.separations.len() as f64),
            },
            Measure {
                word: "slope",
                about: "the slope of ln d of the newest neighbour while d is small",
                value: |_, present, _| newest(present)?.2.map(|slope| slope.rate),
            },
            Measure {
                word: "grown",
                about: "by how much ln d has grown along that line",
                value: |_, present, _| newest(present)?.2.map(|slope| slope.grown),
            },
            Measure {
                word: "error",
                about: "the return error: how far a motion that was reversed came back to from its start",
                value: |_, present, _| present.returned?.error,
            },
            Measure {
                word: "expected",
                about: "ε e^{λT} for the time gone back, ε the error of a step, λ measured or the slope",
                value: |_, present, _| {
                    let returned = present.returned?;
                    Some(expected(present, returned, returned.gone[0])?.1)
                },
            },
            Measure {
                word: "distance",
                about: "the distance of the newest motion from the main one",
                value: |_, present, _| {
                    let last = newest(present)?.1.points().last()?;
                    Some(crate::num::math::exp(last[1]))
                },
            },
        ]
    }
}

/// λ and the error that is expected after a time gone back, ε e^{λT} or the sum of all steps': λ is that of an instrument, or else the slope of ln d. No distance is seen below
/// the rounding of what is compared.
fn expected(present: &Present<'_>, returned: Returned, gone: f64) -> Option<(f64, f64)> {
    let slope = || newest(present)?.2.map(|slope| slope.rate);
    let rate = returned.exponent.or_else(slope)?;
    Some((rate, expected_return(returned.step_error, rate.max(0.0), gone)))
}

/// What stands above the distance of a motion that goes back.
fn return_heading(present: &Present<'_>, returned: Returned) -> Heading {
    let mut entries = Vec::new();
    match (returned.error, returned.distance) {
        (Some(error), _) => entries.push(Entry::Number("returned to".to_owned(), error)),
        (None, Some(distance)) => entries.push(Entry::Number("d =".to_owned(), distance)),
        (None, None) => {}
    }
    if let Some((rate, value)) = expected(present, returned, returned.gone[0]) {
        entries.push(Entry::Number(format!("{} =", growth(returned)), value));
        entries.push(Entry::Number("λ ≈".to_owned(), rate));
    }
    Heading { title: "Return error ln d".to_owned(), given: false, entries }
}

/// What the error is expected to be, in a few words.
fn growth(returned: Returned) -> &'static str {
    if returned.step_error.1.is_some() { "ε Σ e^λt" } else { "ε e^λT" }
}

/// The distance from the run before over the time gone back, with what is expected of it.
fn way_back(present: &Present<'_>, returned: Returned, mut layers: Vec<(Level, Layer)>) -> Picture {
    let all = returned.gone[1];
    let mut name = match returned.distance {
        Some(0.0) => "ln d   identical, to the last bit".to_owned(),
        _ => "ln d from the run before".to_owned(),
    };
    let mut range = range(present, 1);
    let ln = crate::num::math::ln;
    let (error, step) = returned.step_error;
    if let (Some((rate, _)), true) = (expected(present, returned, all), error > 0.0) {
        let first = step.unwrap_or(0.0).min(all);
        let at = |k: u32| {
            let gone = first + (all - first) * f64::from(k) / f64::from(PARTS);
            [gone, ln(expected_return(returned.step_error, rate.max(0.0), gone))]
        };
        let line: Vec<[f64; 2]> = (0..=PARTS).map(at).collect();
        let (low, high) = (line[0][1], line[PARTS as usize][1]);
        let stroke = Stroke { ink: Ink::Accent, covering: Some(0.5) };
        layers.push((SLOPE, Layer::Line(line, stroke)));
        let seen = range.unwrap_or([low, high]);
        range = Some([seen[0].min(low), seen[1].max(high)]);
        let written = [rate, error].map(|x| significant(x, 3, 1e-4..1e4));
        let growth = growth(returned);
        name = format!("ln d   line: {growth}, λ = {}, ε = {}", written[0], written[1]);
    }
    let upwards = Upwards::Named(name, range.unwrap_or([-40.0, 0.0]));
    Picture::Axes { upwards, layers, occurrences: None }
}

/// The last of the motions: its number, its distances and their slope.
fn newest<'a>(present: &Present<'a>) -> Option<(usize, &'a Arc<Distances>, Option<Slope>)> {
    let (number, distances) = present.separations.last()?;
    Some((*number, distances, distances.slope()))
}

/// The range of all points.
fn range(present: &Present<'_>, axis: usize) -> Option<[f64; 2]> {
    let all = present.separations.iter().flat_map(|(_, d)| d.points()).map(|p| p[axis]);
    let (least, greatest) =
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| (lo.min(x), hi.max(x)));
    (least < greatest).then_some([least, greatest])
}
