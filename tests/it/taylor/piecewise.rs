//! Potentials of straight pieces, written in every way that hides a kink, against parabolas put together at the kinks.

use super::{Run, near};

/// The motion of a unit mass under a force that is constant between places: `forces[i]` before `places[i]`.
fn walk(places: &[f64], forces: &[f64], [mut x, mut v]: [f64; 2], mut left: f64) -> [f64; 2] {
    let mut piece = places.iter().filter(|&&place| place < x || place == x && v > 0.0).count();
    loop {
        let force = forces[piece];
        // the time to a place, by the root of the quadratic that does not cancel
        let time = |place: f64, up: bool| {
            let (far, speed2) = (place - x, v * v + 2.0 * force * (place - x));
            let at = if up { speed2.sqrt() } else { -speed2.sqrt() };
            let time = if far == 0.0 { -2.0 * v / force } else { 2.0 * far / (v + at) };
            (time.is_finite() && time > 0.0).then_some((time, at))
        };
        let above = places.get(piece).and_then(|&p| Some((time(p, true)?, p, piece + 1)));
        let below = piece.checked_sub(1).map(|i| places[i]);
        let below = below.and_then(|p| Some((time(p, false)?, p, piece - 1)));
        let next = [above, below].into_iter().flatten().min_by(|a, b| a.0.0.total_cmp(&b.0.0));
        match next {
            Some(((time, speed), place, there)) if time <= left => {
                (x, v, piece, left) = (place, speed, there, left - time);
            }
            _ => return [x + left * (v + 0.5 * left * force), v + left * force],
        }
    }
}

/// A potential in units of energy of a place in units of length, its places and forces, and the start.
type Law = (&'static str, Vec<f64>, Vec<f64>, [f64; 2]);

fn laws() -> Vec<Law> {
    let wedge = |text| (text, vec![0.0], vec![1.0, -1.0], [1.0, 0.2]);
    let pi = std::f64::consts::PI;
    let turns: Vec<f64> = (-30..=30).map(|n| pi * f64::from(n)).collect();
    let half_turns: Vec<f64> = turns.iter().map(|x| x + 0.5 * pi).collect();
    let alternating =
        |first: f64| (0..62).map(|i| if i % 2 == 0 { first } else { -first }).collect();
    vec![
        wedge("abs(X)"),
        wedge("max(X, -X)"),
        wedge("-min(X, -X)"),
        wedge("sqrt(X^2)"),
        wedge("(X^2)^0.5"),
        wedge("X*sign(X)"),
        wedge("(X^4)^(1/4)"),
        ("max(X, -2*X)", vec![0.0], vec![2.0, -1.0], [1.0, 0.2]),
        ("abs(abs(X) - 1)", vec![-1.0, 0.0, 1.0], vec![1.0, -1.0, 1.0, -1.0], [0.3, 1.6]),
        ("sqrt((X - 1)^2) + abs(X)/2", vec![0.0, 1.0], vec![1.5, 0.5, -1.5], [3.0, 0.2]),
        // rises from 0 to π, and falls again
        ("acos(cos(X))", turns, alternating(1.0), [0.5, 1.9]),
        ("asin(sin(X))", half_turns, alternating(-1.0), [0.5, 1.9]),
    ]
}

#[test]
fn straight_pieces_however_they_are_written() {
    for (potential, places, forces, start) in laws() {
        for [mass, length, time] in
            [[1.0, 1.0, 1.0], [9.1e-31, 5.3e-11, 2.4e-17], [2e30, 3.1e16, 3.2e13]]
        {
            let energy = mass * length * length / (time * time);
            let mut run = Run::new(&format!(
                "title = \"Pieces\"\n[coordinates]\nx = {{ initial = {:e}, velocity = {:e} }}\n\
                 [lagrangian]\nL = \"1/2*{mass:e}*x'^2 - {energy:e}*({})\"\n",
                start[0] * length,
                start[1] * length / time,
                potential.replace('X', &format!("(x/{length:e})"))
            ));
            for part in [0.7, 3.1, 11.3, 20.0] {
                let state = run.to(part * time);
                let [x, v] = [state[0] / length, state[1] * time / length];
                let expected = walk(&places, &forces, start, part);
                let off = (x - expected[0]).abs().max((v - expected[1]).abs());
                assert!(off < 1e-12, "{potential} at {part} in {length:e}: {off:e}");
            }
        }
    }
}

/// The oracle itself: a wedge from 1 is back after 4 √2.
#[test]
fn the_walk_of_a_wedge_has_its_period() {
    let period = 4.0 * 2.0_f64.sqrt();
    near(&walk(&[0.0], &[1.0, -1.0], [1.0, 0.0], period), &[1.0, 0.0], 1e-15);
    near(&walk(&[0.0], &[1.0, -1.0], [1.0, 0.0], 0.5 * period), &[-1.0, 0.0], 1e-15);
}
