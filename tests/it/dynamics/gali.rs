//! GALI against its laws: exponents in chaos, powers of the time on a torus.

use phaselab::dynamics::{PhaseSpace, gali, lyapunov};
use phaselab::integrate::{Settings, method_named};
use phaselab::system::InitialOverride::{Momentum, Position};
use phaselab::system::{InitialOverride, State};

use super::file;
use crate::fixtures::loaded;

fn henon_heiles(given: &[InitialOverride]) -> (PhaseSpace, State) {
    let loaded = loaded("henon-heiles", 1);
    let parameters = loaded.model.parameter_values();
    let space =
        PhaseSpace::of((&loaded.model, &loaded.equations, &loaded.system), &parameters).unwrap();
    let state = loaded.system.initial(0.0, &parameters, given).unwrap();
    let state = space.state(&state).unwrap();
    (space, state)
}

/// The slope of the line nearest to points.
fn slope(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x / count, b + y / count));
    let common: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    common / points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum::<f64>()
}

/// The mean rate of points with the weight e^{−1/(s(1−s))} of the part s of the time, as exponents are averaged.
fn weighted_rate(points: &[(f64, f64)]) -> f64 {
    let (begin, end) = (points[0].0, points[points.len() - 1].0);
    let (mut grown, mut whole) = (0.0, 0.0);
    for pair in points.windows(2) {
        let [(t, x), (u, y)] = [pair[0], pair[1]];
        let s = (0.5 * (t + u) - begin) / (end - begin);
        let weight = (-1.0 / (s * (1.0 - s))).exp();
        grown += weight * (y - x);
        whole += weight * (u - t);
    }
    grown / whole
}

#[test]
fn in_chaos_it_falls_by_one_two_and_four_times_the_exponent() {
    let (space, start) = henon_heiles(&[]);
    let method = (method_named("taylor").unwrap(), Settings::default());
    let until = 2000.0;
    let sigma = lyapunov(&space, method, &start, until, &mut |_| ()).unwrap();
    let largest = sigma.exponents[0];
    let found = gali(&space, method, (&start, until), 4, &mut |_| ()).unwrap();
    for (k, times) in [(2, 1.0), (3, 2.0), (4, 4.0)] {
        // what the linear growth along the motion adds is 1/t in the mean
        let rate = -weighted_rate(&found.of(k));
        let expected = times * largest;
        assert!((rate - expected).abs() < 0.15 * expected, "GALI{k}: {rate} {expected}");
    }
    // far below what rounding leaves of a determinant
    assert!(found.of(4).last().unwrap().1 < -300.0);
}

#[test]
fn beside_an_unstable_periodic_orbit_it_falls_with_its_exponent() {
    // orbit B at E = 1/8: λ = 0.19195453623623
    let (space, start) = henon_heiles(&[
        Position(0, 0.0),
        Position(1, -0.185_405_087_090_802_14),
        Momentum(0, 0.459_756_545_767_957_59),
        Momentum(1, 0.0),
    ]);
    let method = (method_named("taylor").unwrap(), Settings::default());
    let found = gali(&space, method, (&start, 110.0), 4, &mut |_| ()).unwrap();
    for (k, times) in [(2, 1.0), (3, 2.0), (4, 4.0)] {
        let late: Vec<_> = found.of(k).into_iter().filter(|(t, _)| *t > 30.0).collect();
        let rate = -slope(&late) / times;
        assert!((rate - 0.191_954_536).abs() < 0.02, "GALI{k}: {rate}");
    }
}

#[test]
fn on_a_torus_of_two_dimensions_it_stays_or_falls_by_powers_of_the_time() {
    let (space, start) =
        henon_heiles(&[Position(1, 0.483), Momentum(0, 0.278_980_39), Momentum(1, 0.0)]);
    let method = (method_named("taylor").unwrap(), Settings::default());
    let found = gali(&space, method, (&start, 3000.0), 4, &mut |_| ()).unwrap();
    assert!(found.of(2).iter().all(|(_, x)| *x > 0.01_f64.ln()), "GALI2 stays");
    for (k, power) in [(3, -2.0), (4, -4.0)] {
        let late = found.of(k).into_iter().filter(|(t, _)| *t > 100.0);
        let late: Vec<_> = late.map(|(t, x)| (t.ln(), x)).collect();
        let found = slope(&late);
        assert!((found - power).abs() < 0.15 * power.abs(), "GALI{k} ∝ t^{found}");
    }
}

#[test]
fn too_many_vectors_are_refused() {
    let (space, start) = henon_heiles(&[]);
    let method = (method_named("taylor").unwrap(), Settings::default());
    for count in [0, 1, 5] {
        let refused = gali(&space, method, (&start, 1.0), count, &mut |_| ()).unwrap_err();
        assert!(refused.to_string().contains("from 2 to 4"), "{refused}");
    }
}

/// The same motion in units of nature, of an atom and of a galaxy: on a torus GALI₂ stays of order 1, in chaos it falls.
#[test]
fn units_do_not_make_a_torus_chaotic() {
    for [mass, length, time] in
        [[1.0, 1.0, 1.0], [9.109e-31, 5.292e-11, 2.419e-17], [1.989e30, 3.086e16, 3.156e13]]
    {
        let energy = mass * length * length / (time * time);
        let last = |[x, y, u, v]: [f64; 4]| {
            let text = format!(
                "title = \"a\"\n[coordinates]\nx = {{ initial = {:e}, velocity = {:e} }}\n\
                 y = {{ initial = {:e}, velocity = {:e} }}\n[lagrangian]\n\
                 L = \"1/2*{mass:e}*(x'^2 + y'^2) - {energy:e}*(1/2*((x/{length:e})^2 + (y/{length:e})^2) \
                 + (x/{length:e})^2*(y/{length:e}) - (y/{length:e})^3/3)\"\n",
                x * length,
                u * length / time,
                y * length,
                v * length / time
            );
            let case = file(&text, &[]);
            let method = (method_named("taylor").unwrap(), Settings::default());
            let found =
                gali(&case.space, method, (&case.start, 300.0 * time), 2, &mut |_| ()).unwrap();
            found.of(2).last().unwrap().1
        };
        let regular = last([0.0, 0.1, 0.42, 0.15]);
        assert!((-5.0..=0.0).contains(&regular), "{length:e}: {regular}");
        let chaotic = last([0.0, -0.1, 0.49, 0.27]);
        assert!((-60.0..-20.0).contains(&chaotic), "{length:e}: {chaotic}");
    }
}
