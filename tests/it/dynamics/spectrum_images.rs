//! Images of lines that are too fast for the values of a spectrum.

use phaselab::dynamics::{SampledSpectrum, SpectrumRequest, sampled_spectrum};

/// A sawtooth of period 1 has a line at every multiple of 2π, of amplitude 1/(πn): those too fast for the values have images among
/// them, which are no lines of it, and that it has faster ones is said.
#[test]
fn the_images_of_a_motion_that_jumps_are_no_lines() {
    let mut sample = |times: &[f64]| times.iter().map(|t| 0.5 - t.rem_euclid(1.0)).collect();
    let request = SpectrumRequest {
        span: [0.0, 300.0],
        counts: [2048, 4096],
        is_angle: false,
        lines: (10, 1),
        drive: None,
    };
    let found = sampled_spectrum(&request, &mut sample, &mut |_| true).unwrap();
    assert!(!found.is_resolved() && found.has_images());
    assert!(found.spectrum.lines.len() >= 3, "{:?}", found.spectrum.lines);
    for line in &found.spectrum.lines {
        let multiple = line.frequency / std::f64::consts::TAU;
        assert!((multiple - multiple.round()).abs() < 1e-3, "{line:?}");
        assert!((line.amplitude * multiple * std::f64::consts::PI - 1.0).abs() < 0.1, "{line:?}");
    }
}

/// The spectrum of 400 values at intervals of 1 of cos t/2 beside other lines.
fn unit_sampled(others: &[(f64, f64)]) -> SampledSpectrum {
    let quantity = |t: f64| {
        let lines = others.iter().map(|&(amplitude, frequency)| amplitude * (frequency * t).cos());
        (0.5 * t).cos() + lines.sum::<f64>()
    };
    let request = SpectrumRequest {
        span: [0.0, 400.0],
        counts: [400; 2],
        is_angle: false,
        lines: (8, 1),
        drive: None,
    };
    let mut sample = |times: &[f64]| times.iter().map(|&t| quantity(t)).collect();
    sampled_spectrum(&request, &mut sample, &mut |_| true).unwrap()
}

/// An image is left out whether or not what it is the image of is most of the quantity: the line that belongs to it is there.
#[test]
fn a_line_beside_a_strong_image_is_found() {
    for amplitude in [0.25, 0.3, 0.9, 3.0] {
        let found = unit_sampled(&[(amplitude, 7.1)]);
        assert!(!found.is_false() && !found.is_resolved(), "{amplitude}: {found:?}");
        assert_eq!(found.is_strongest_left_out(), amplitude > 1.0);
        let lines = &found.spectrum.lines;
        assert!(lines.len() == 1 && (lines[0].frequency - 0.5).abs() < 1e-9, "{lines:?}");
        let image = 7.1 - std::f64::consts::TAU;
        assert!(found.images.len() == 1 && (found.images[0].frequency - image).abs() < 1e-9);
    }
    // where nothing but the image is there, nothing belongs to the quantity
    assert!(unit_sampled(&[(-1.0, 0.5), (1.0, 7.1)]).is_false());
}

/// The image of order k leaves 2 |sin πkg| of itself at the golden section g: 0.35 for k = 8, but 0.22 for 13 and 0.13 for 21. The last
/// two are known by lying at |ω − 2πk| of a multiple ω of ½; lines of the quantity at other places are none.
#[test]
fn images_of_every_order_are_left_out_and_other_lines_are_not() {
    for (order, multiple) in [(1, 14), (8, 99), (13, 161), (21, 267), (34, 429)] {
        let fast = 0.5 * f64::from(multiple);
        let image = (fast - std::f64::consts::TAU * f64::from(order)).abs();
        assert!(image < std::f64::consts::PI, "{image}");
        let found = unit_sampled(&[(0.1, fast)]);
        assert!(
            found.images.len() == 1 && (found.images[0].frequency - image).abs() < 1e-8,
            "{found:?}"
        );
        assert_eq!(found.spectrum.lines.len(), 1, "{order}: {:?}", found.spectrum.lines);
        // the quantity has these lines itself
        for own in [image, 1.0, 1.5] {
            let found = unit_sampled(&[(0.1, own)]);
            assert!(found.is_resolved(), "{order}: {found:?}");
            assert_eq!(found.spectrum.lines.len(), 2, "{order}: {:?}", found.spectrum.lines);
        }
    }
}

/// A line of the quantity that faster ones disturb between the values by a quarter of it is kept; by two fifths it is taken for an image.
#[test]
fn a_line_is_an_image_by_what_it_leaves_between_the_values() {
    // fast lines that fall onto 1.1 leave 2 |sin πg| = 1.86 of their own amplitude beside it
    for (amplitude, is_kept) in [(0.25, true), (0.4, false)] {
        let disturbing = 0.1 * amplitude / 1.864;
        let fast = 1.1 + std::f64::consts::TAU;
        let found = unit_sampled(&[(0.1 - disturbing, 1.1), (disturbing, fast)]);
        let kept = found.spectrum.lines.iter().any(|line| (line.frequency - 1.1).abs() < 1e-6);
        assert_eq!(kept, is_kept, "{amplitude}: {found:?}");
        assert!(!found.is_resolved());
    }
}
