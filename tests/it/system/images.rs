//! Images under canonical maps that cannot be written down, against another way of solving their equations.

use phaselab::mechanics::derive;
use phaselab::model::Model;
use phaselab::num::math;
use phaselab::preset;
use phaselab::system::{Form, State, System};

const HEAD: &str = "title = \"t\"\n[parameters]\na = 0.1\n[coordinates]\nq = { initial = 0.4, momentum = 0.3 }\n\
    [hamiltonian]\nH = \"p_q^2/2 + q^2/2\"\n[[transformations]]\nname = \"map\"\nnew = [\"Q\", \"P\"]\n";

const VIEWS: &str = "[[views]]\nkind = \"transformation\"\nx = \"Q\"\ny = \"P\"\n\
    [[views]]\nkind = \"time\"\ny = \"Q*P\"\n";

fn compiled(law: &str) -> (Model, System) {
    super::compile(&format!("{HEAD}{law}\n{VIEWS}"))
}

/// The images (Q, P) of points (q, p), looked at one after the other.
fn images(law: &str, points: &[[f64; 2]], a: f64) -> Vec<[f64; 2]> {
    let (_, system) = compiled(law);
    let place = |name: &str| {
        let mut all = system.channels().iter();
        all.position(|channel| channel.name == name).expect("it is a channel")
    };
    let (q, p, product) = (place("Q"), place("P"), place("Q*P"));
    let mut observer = system.observer(&[a]);
    let mut out = vec![0.0; system.channels().len()];
    let mut all = Vec::new();
    for (k, &[x, y]) in points.iter().enumerate() {
        let state = State::new(k as f64, Form::Momentum, vec![x, y]);
        observer.observe(&state, &mut out).expect("values");
        let image = [out[q], out[p]];
        let apart = (out[product] - image[0] * image[1]).abs();
        assert!(image[0].is_nan() || apart <= 1e-15, "expressions of them follow");
        all.push(image);
    }
    all
}

/// p = P + a cos(q + P) and Q = q + a cos(q + P), by iterating P = p − a cos(q + P).
#[test]
fn a_twist_is_that_of_a_fixed_point() {
    let points: Vec<[f64; 2]> =
        (0..40).map(|k| [math::sin(0.3 * f64::from(k)), math::cos(0.3 * f64::from(k))]).collect();
    for a in [0.1, 0.4] {
        let found = images("kind = \"F2\"\nF = \"q*P + a*sin(q + P)\"", &points, a);
        for (&[q, p], image) in points.iter().zip(found) {
            let mut new = p;
            for _ in 0..200 {
                new = p - a * math::cos(q + new);
            }
            let expected = [q + a * math::cos(q + new), new];
            let off = (image[0] - expected[0]).abs().max((image[1] - expected[1]).abs());
            assert!(off <= 4e-16, "{image:?} is not {expected:?}");
        }
    }
}

/// p = P + P⁵/5 − P² has three solutions P between its extrema, p = 1/5 at P = 1 and p ≈ 0.2576 at P ≈ 0.5437. An image
/// stays on its branch as far as that exists, so that the way down is not the way up.
#[test]
fn a_branch_is_followed_to_its_caustic_and_another_beyond() {
    let law = "kind = \"F2\"\nF = \"q*P + (P^5/5 - P^2)*q\"";
    let relation = |new: f64| new + math::powi(new, 5) / 5.0 - new * new;
    let down: Vec<[f64; 2]> = (0..50).map(|k| [1.0, 0.5 - 0.01 * f64::from(k)]).collect();
    let found = images(law, &down, 0.0);
    let up: Vec<[f64; 2]> = down.iter().rev().copied().collect();
    let back = images(law, &[&down[..], &up[..]].concat(), 0.0).split_off(down.len());
    for (points, images) in [(&down, &found), (&up, &back)] {
        for (&[_, p], &[q, new]) in points.iter().zip(images.iter()) {
            assert!(new.is_nan() || (relation(new) - p).abs() <= 1e-15, "{new} at {p}");
            // Q = ∂F/∂P
            let slope = 1.0 + math::powi(new, 4) - 2.0 * new;
            assert!(new.is_nan() || (q - slope).abs() <= 1e-14, "{q} at {p}");
        }
    }
    let lost = |images: &[[f64; 2]]| images.iter().filter(|image| image[1].is_nan()).count();
    assert_eq!((lost(&found), lost(&back)), (1, 1), "one is left out where a branch ends");
    for ((&[_, p], falling), rising) in down.iter().zip(&found).zip(back.iter().rev()) {
        if p > 0.205 {
            assert!(falling[1] > 1.0, "{} at {p}", falling[1]);
        }
        if p < 0.255 && !rising[1].is_nan() {
            assert!(rising[1] < 0.5437, "{} at {p}", rising[1]);
        }
    }
}

/// p = P + t P² has P = (√(4 t p + 1) − 1)/(2 t), which is 0/0 at the start t = 0, where P = p.
#[test]
fn where_a_solved_form_is_not_defined_at_the_start_the_relations_are_solved() {
    let points = [[0.4, 0.3], [0.7, 0.5], [-0.2, 0.1]];
    let found = images("kind = \"F2\"\nF = \"q*P + t*q*P^2\"", &points, 0.1);
    for ((t, [q, p]), image) in [0.0, 1.0, 2.0].into_iter().zip(points).zip(found) {
        // by t = 0 without division
        let new = 2.0 * p / (1.0 + (4.0 * t * p + 1.0_f64).sqrt());
        let expected = [q + 2.0 * t * q * new, new];
        let off = (image[0] - expected[0]).abs().max((image[1] - expected[1]).abs());
        assert!(off <= 1e-15, "{image:?} is not {expected:?}");
    }
}

/// What has no image at all stays what it was: an error, not a column without values.
#[test]
fn a_function_that_gives_no_map_is_refused() {
    let text = format!("{HEAD}kind = \"F2\"\nF = \"q^2 + P^2\"\n{VIEWS}");
    let model = preset::read(&text).expect("a file").model;
    let equations = derive(&model).expect("small enough");
    let refused = System::compile(&model, &equations, &[]).expect_err("there are no images");
    assert!(refused.to_string().contains("has no value"), "{refused}");
}
