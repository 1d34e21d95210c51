//! Equilibria and small oscillations.

use phaselab::dynamics::{
    DynamicsError, Equilibrium, EquilibriumKind, PhaseSpace, equilibria, with_virtual_work,
};

use super::{Case, case_in, file, preset};
use crate::fixtures::{loaded, lowered};

fn of(case: &Case) -> Vec<Equilibrium> {
    equilibria(&case.space, &case.start).unwrap().found
}

fn frequencies(one: &Equilibrium) -> Vec<f64> {
    one.modes.iter().map(|mode| mode.frequency).collect()
}

fn close(a: f64, b: f64, within: f64) {
    assert!((a - b).abs() <= within, "{a} is not {b}");
}

#[test]
fn the_double_pendulum_has_four() {
    let found = of(&preset("double-pendulum", &[], &[]));
    let kinds: Vec<_> = found.iter().map(|one| (one.kind.unwrap(), one.stable)).collect();
    let saddle = (EquilibriumKind::Saddle, Some(false));
    assert_eq!(
        kinds,
        [
            (EquilibriumKind::Minimum, Some(true)),
            saddle,
            saddle,
            (EquilibriumKind::Maximum, Some(false))
        ]
    );
    // ω² = (2 ∓ √2) g/l, and the amplitudes 1 : ±√2
    let g = 9.81;
    let modes = &found[0].modes;
    for (mode, sign) in modes.iter().zip([-1.0, 1.0]) {
        close(mode.frequency * mode.frequency, (2.0 + sign * 2.0_f64.sqrt()) * g, 1e-11);
        close(mode.in_phase[0] / mode.in_phase[1], -sign / 2.0_f64.sqrt(), 1e-10);
    }
    // upright both, the same numbers grow
    let grows: Vec<f64> = found[3].eigenvalues.iter().map(|z| z[0]).collect();
    close(grows[0], modes[1].frequency, 1e-10);
    assert!(found[3].modes.is_empty());
}

#[test]
fn the_points_of_lagrange_are_found_and_judged() {
    // L1, L2, L3 at μ = 0.01215 by their quintics; L4 and L5 by equilateral triangles
    let mu = 0.01215;
    let found = of(&preset("restricted-three-body", &[("mu", mu), ("x0", 0.5)], &[]));
    assert_eq!(found.len(), 5);
    let force = |x: f64| {
        let (a, b) = (x + mu, x - 1.0 + mu);
        x - (1.0 - mu) * a / a.abs().powi(3) - mu * b / b.abs().powi(3)
    };
    let root = |mut low: f64, mut high: f64| {
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if (force(middle) < 0.0) == (force(low) < 0.0) { low = middle } else { high = middle }
        }
        low
    };
    let collinear = [root(0.5, 0.95), root(1.01, 1.5), root(-1.5, -0.5)];
    for (one, x) in found.iter().zip(collinear) {
        close(one.variables[0], x, 1e-13);
        assert_eq!((one.kind, one.stable), (Some(EquilibriumKind::Saddle), Some(false)));
    }
    for one in &found[3..] {
        close(one.variables[0], 0.5 - mu, 1e-12);
        close(one.variables[1].abs(), 3.0_f64.sqrt() / 2.0, 1e-12);
        // a maximum beside which all oscillates: λ⁴ + λ² + (27/4) μ (1 − μ) = 0, which proves nothing of the full motion
        assert_eq!((one.kind, one.stable), (Some(EquilibriumKind::Maximum), None));
        assert_eq!(one.stability(), "linearly stable");
        let root = (1.0 - 27.0 * mu * (1.0 - mu)).sqrt();
        let expected = [(0.5 * (1.0 - root)).sqrt(), (0.5 * (1.0 + root)).sqrt()];
        for (frequency, expected) in frequencies(one).iter().zip(expected) {
            close(*frequency, expected, 1e-11);
        }
    }
    // beyond Routh's ratio they are not
    let found = of(&preset("restricted-three-body", &[("mu", 0.05), ("x0", 0.5)], &[]));
    assert!(
        found[3..]
            .iter()
            .all(|one| one.stable == Some(false) && one.kind == Some(EquilibriumKind::Maximum))
    );
}

#[test]
fn equal_frequencies_have_two_modes() {
    let found = of(&preset("henon-heiles", &[], &[]));
    assert_eq!(found.len(), 4);
    let [first, second] = &found[0].modes[..] else { panic!("{:?}", found[0]) };
    close(first.frequency, 1.0, 1e-12);
    close(second.frequency, 1.0, 1e-12);
    let (a, b) = (&first.in_phase, &second.in_phase);
    // one along each coordinate, as both swing by themselves
    assert_eq!((&a[..], &b[..]), (&[1.0, 0.0][..], &[0.0, 1.0][..]));
    assert!([first, second].iter().all(|mode| mode.quadrature == [0.0, 0.0]));
    for saddle in &found[1..] {
        assert_eq!(saddle.kind, Some(EquilibriumKind::Saddle));
        close(saddle.energy, 1.0 / 6.0, 1e-14);
    }
}

/// Two bodies with equal frequencies in both directions and a magnetic force: the eigenvalues of the file's linear motion, by
/// another program (LAPACK): ±1.840 ± 0.020 i, so that it falls away from the equilibrium.
#[test]
fn what_turns_as_it_grows_is_unstable() {
    let text = "title = \"two\"\n[coordinates]\nx = 0.3\ny = 0.2\nu = 0.1\nv = 0.1\n[lagrangian]\n\
        L = \"1/2*1.17*(x'^2 + y'^2) + 1/2*1.7*(u'^2 + v'^2) - 0.21*(x'*u' + y'*v') + 0.03*(x*y' - y*x') \
        + 0.03*(u*v' - v*u') + 1/2*2.64*(x^2 + y^2) + 1/2*1.8*(u^2 + v^2) - 3.0*(x*u + y*v)\"\n";
    let found = of(&file(text, &[]));
    assert_eq!((found.len(), found[0].stable), (1, Some(false)));
    assert_eq!(found[0].eigenvalues.len(), 8);
    let grows = found[0].eigenvalues.iter().filter(|z| (z[0] - 1.840).abs() < 2e-3).count();
    assert_eq!(grows, 2, "{:?}", found[0].eigenvalues);
}

/// A body that rests in space, as a turntable sees it, circles with the turntable's rate; one that moves goes off along
/// ζ = (a + b t) e^{−iΩt}. The frequency is there twice and the mode once. So it is for L₄ at Routh's ratio of masses,
/// (1 − √69/9)/2; beside it there are two modes, or it grows.
#[test]
fn equal_frequencies_with_one_mode_are_not_stable() {
    let turns = of(&preset("rotating-frame", &[("k", 0.0)], &[]));
    assert_eq!((turns[0].stable, turns[0].modes.len()), (None, 1), "{:?}", turns[0]);
    assert!(turns[0].stability().contains("equal frequencies"));
    let routh = (1.0 - 69.0_f64.sqrt() / 9.0) / 2.0;
    let neutral = "neutral: equal frequencies with fewer modes";
    for (mu, stability) in
        [(routh, neutral), (routh - 1e-4, "linearly stable"), (routh + 1e-4, "unstable")]
    {
        let found = of(&preset("restricted-three-body", &[("mu", mu)], &[]));
        let fourth = found.iter().find(|one| one.variables[1] > 0.5).expect("L4");
        assert_eq!(fourth.stability(), stability, "{mu}: {fourth:?}");
    }
}

/// The energy of a motion in one coordinate that is held back by x and pushed by a force Q, and that of Cherry's equations, from
/// near the equilibrium: both leave it, however slowly, although the linearised motion only oscillates.
#[test]
fn oscillations_of_the_linearised_motion_prove_nothing() {
    let pushed = |force: &str, function: &str| {
        of(&file(
            &format!(
                "title = \"t\"\n[coordinates]\nx = {{ initial = 0.05, velocity = 0 }}\n[parameters]\nc = 0.2\n[lagrangian]\n\
                 L = \"1/2*x'^2 - 1/2*x^2\"\n{function}forces = {{ x = \"{force}\" }}\n"
            ),
            &[],
        ))
    };
    let verdict = |force: &str, function: &str| {
        let found = pushed(force, function);
        let [one] = &found[..] else { panic!("{found:?}") };
        assert_eq!(one.kind, Some(EquilibriumKind::Minimum));
        (one.stable, one.stability())
    };
    let open = (None, "linearly stable");
    for force in ["c*x'^3", "c*x^2*x'", "c*(x^2 - 1)*x'^3"] {
        assert_eq!(verdict(force, ""), open, "{force}");
    }
    // what only takes energy leaves it stable, even where the linearised motion does not see it
    for force in ["-c*x'^3", "-c*x^2*x'", "-c*(x^2 + 1)*x'^3"] {
        assert_eq!(verdict(force, "").0, Some(true), "{force}");
    }
    assert_eq!(verdict("0", "dissipation = \"c*x'^4\"\n").0, Some(true));
    assert_eq!(verdict("c*x'", ""), (Some(false), "unstable"));
    assert_eq!(verdict("-c*x'", "").0, Some(true));
    // damping that decides in the linearised motion, whatever comes later
    assert_eq!(verdict("-c*x' + x'^3", "").0, Some(true));
    let cherry = "1/2*(x^2 + p_x^2) - (y^2 + p_y^2) + 1/2*(y*(x^2 - p_x^2) - 2*x*p_x*p_y)";
    let hamilton = |h: &str| {
        of(&file(
            &format!(
                "title = \"t\"\n[coordinates]\nx = {{ initial = 0.05, momentum = 0 }}\ny = {{ initial = 0.035, momentum = 0 }}\n\
                 [hamiltonian]\nH = \"{h}\"\n"
            ),
            &[],
        ))
    };
    let origin = |h: &str| {
        let found = hamilton(h);
        let one = found.into_iter().find(|one| one.variables.iter().all(|x| x.abs() < 1e-9));
        one.expect("the origin")
    };
    assert_eq!((origin(cherry).stable, origin(cherry).stability()), open);
    // an energy that is greatest is as good as one that is least
    let greatest = origin("-1/2*(x^2 + p_x^2) - (y^2 + p_y^2) + 1/3*x^3");
    assert_eq!(greatest.stable, Some(true), "{greatest:?}");
}

/// x = 0.05 of Cherry's equations leaves the equilibrium that its linearised motion circles, and so does x of the pushed motion: that is why
/// neither is called stable.
#[test]
fn what_is_linearly_stable_may_be_left() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0.05, momentum = 0 }\ny = { initial = 0.035, momentum = 0 }\n\
                [hamiltonian]\nH = \"1/2*(x^2 + p_x^2) - (y^2 + p_y^2) + 1/2*(y*(x^2 - p_x^2) - 2*x*p_x*p_y)\"\n";
    let mut motion = crate::experiment::build(text, |_| {});
    crate::experiment::run(&mut motion, 30.0);
    let x = crate::experiment::value(&motion, "x");
    let p = crate::experiment::value(&motion, "p_x");
    assert!(x.hypot(p) > 0.25, "{x} {p}");
}

/// A free body turns steadily about its principal axes: about the middle one it does not keep to it, about the others it does, since the
/// energy at the angular momentum is least or greatest there (L. Poinsot).
#[test]
fn rotations_about_the_outer_axes_are_stable() {
    let found = of(&preset("free-rigid-body", &[], &[]));
    let stable = found.iter().filter(|one| one.stable == Some(true)).count();
    let unstable = found.iter().filter(|one| one.stable == Some(false)).count();
    assert_eq!((stable, unstable), (4, 2), "{found:?}");
}

#[test]
fn what_is_cyclic_goes_on() {
    // a steady precession of the top: A cosθ Ω² − C ω₃ Ω + Mgl = 0
    let case = preset("heavy-top", &[], &[]);
    let found = of(&case);
    let one = found.iter().find(|one| one.variables[0] > 0.0 && one.variables[0] < 3.0).unwrap();
    let [(phi, precession), (psi, spin)] = one.rates[..] else { panic!("{one:?}") };
    assert_eq!((phi, psi), (1, 2));
    let cos = one.variables[0].cos();
    let whole = spin + precession * cos;
    let parameter = |name: &str| {
        let loaded = crate::fixtures::loaded("heavy-top", 1);
        case.space.parameters()[loaded.model.parameter(name).unwrap()]
    };
    let (a, c, mgl) = (parameter("I1"), parameter("I3"), parameter("Mgl"));
    close(a * cos * precession * precession - c * whole * precession + mgl, 0.0, 1e-12);
    assert_eq!((one.kind, one.stable), (Some(EquilibriumKind::Minimum), Some(true)));
    // of a planet: a circle of radius p²/mk, whose radial frequency is that of the revolution
    let found = of(&preset("planet", &[], &[]));
    let [circle] = &found[..] else { panic!("{found:?}") };
    let momentum = circle.variables[3];
    close(circle.variables[0], momentum * momentum / 39.47841760435743, 1e-13);
    close(frequencies(circle)[0], circle.rates[0].1, 1e-10);
}

#[test]
fn friction_damps_and_brackets_have_eigenvalues_only() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0.5, momentum = 0 }\n\
                [hamiltonian]\nH = \"1/2*p_x^2 - cos(x)\"\nforces = { x = \"-0.2*p_x\" }\n";
    let found = of(&file(text, &[]));
    let low = found.iter().find(|one| one.variables[0] == 0.0).unwrap();
    assert_eq!(
        (low.kind, low.stable, low.modes.len()),
        (Some(EquilibriumKind::Minimum), Some(true), 0)
    );
    close(low.eigenvalues[0][0], -0.1, 1e-13);
    close(low.eigenvalues[0][1], 0.99_f64.sqrt(), 1e-13);
    // none where there is a force everywhere, or where the law depends on time
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0.5, momentum = 0 }\n\
                [hamiltonian]\nH = \"1/2*p_x^2 + exp(x)\"\n";
    assert!(of(&file(text, &[])).is_empty());
    let case = preset("kapitza", &[], &[]);
    assert!(matches!(equilibria(&case.space, &case.start), Err(DynamicsError::Unsuited(_))));
    let body = of(&preset("free-rigid-body", &[], &[]));
    assert!(body.iter().all(|one| one.kind.is_none()));
}

#[test]
fn units_do_not_change_what_is_found() {
    // the same pendulum-like well of an atom in SI units and in its own: V = D (1 − e^{−a x})²
    let well = |mass: f64, depth: f64, rate: f64, start: f64| {
        let text = format!(
            "title = \"a well\"\n[coordinates]\nx = {{ initial = {start:e} }}\n[parameters]\nm = {mass:e}\n\
             D = {depth:e}\na = {rate:e}\n[hamiltonian]\nH = \"p_x^2/(2*m) + D*(1 - exp(-a*x))^2\"\n"
        );
        of(&file(&text, &[]))
    };
    for (mass, depth, rate, start) in
        [(1.0, 1.0, 1.0, 0.3), (1.6e-27, 7.2e-19, 1.9e10, 1e-11), (2e30, 1e42, 3e-17, 1e16)]
    {
        let found = well(mass, depth, rate, start);
        let places: Vec<f64> = found.iter().map(|one| one.variables[0]).collect();
        assert_eq!(found.len(), 1, "{places:?}");
        assert!(places[0].abs() <= 1e-9 / rate, "{places:?}");
        assert_eq!((found[0].kind, found[0].stable), (Some(EquilibriumKind::Minimum), Some(true)));
        let frequency = rate * (2.0 * depth / mass).sqrt();
        close(found[0].modes[0].frequency / frequency, 1.0, 1e-10);
    }
}

#[test]
fn two_wells_of_an_atom_are_two() {
    // V = −k x²/2 + c x⁴/4 with rests at 0 and ±√(k/c) = ±2e-10 m
    let (k, c) = (1e2_f64, 2.5e21_f64);
    let text = format!(
        "title = \"two wells\"\n[coordinates]\nx = {{ initial = 1e-10 }}\n[parameters]\nm = 9.1e-31\n\
         k = {k:e}\nc = {c:e}\n[hamiltonian]\nH = \"p_x^2/(2*m) - 1/2*k*x^2 + 1/4*c*x^4\"\n"
    );
    let mut found = of(&file(&text, &[]));
    found.sort_by(|a, b| a.variables[0].total_cmp(&b.variables[0]));
    assert_eq!(found.len(), 3);
    let well = (k / c).sqrt();
    for (one, (x, kind)) in found.iter().zip([
        (-well, EquilibriumKind::Minimum),
        (0.0, EquilibriumKind::Maximum),
        (well, EquilibriumKind::Minimum),
    ]) {
        close(one.variables[0], x, 1e-12 * well);
        assert_eq!(one.kind, Some(kind));
    }
    assert_eq!(
        found.iter().map(|one| one.stable).collect::<Vec<_>>(),
        [Some(true), Some(false), Some(true)]
    );
}

/// V = ω² T(q̇ → q): every displacement is a mode, and the three that are given are real and orthogonal by the kinetic energy.
#[test]
fn modes_of_one_frequency_are_orthogonal_by_the_kinetic_energy() {
    let kinetic = |x: &str, y: &str, z: &str| {
        format!("({x}^2 + 3/2*{y}^2 + {z}^2 + 1/2*{x}*{y} - 1/3*{y}*{z})")
    };
    let text = format!(
        "title = \"three\"\n[coordinates]\nx = 0.1\ny = 0.2\nz = 0.1\n[lagrangian]\nL = \"{} - 4*{}\"\n",
        kinetic("x'", "y'", "z'"),
        kinetic("x", "y", "z")
    );
    let found = of(&file(&text, &[]));
    let [one] = &found[..] else { panic!("{found:?}") };
    assert_eq!(one.modes.len(), 3);
    let mass = [[2.0, 0.5, 0.0], [0.5, 3.0, -1.0 / 3.0], [0.0, -1.0 / 3.0, 2.0]];
    let product = |a: &[f64], b: &[f64]| -> f64 {
        (0..3).map(|i| (0..3).map(|j| a[i] * mass[i][j] * b[j]).sum::<f64>()).sum()
    };
    for (k, mode) in one.modes.iter().enumerate() {
        close(mode.frequency, 2.0, 1e-12);
        assert!(mode.quadrature.iter().all(|x| *x == 0.0), "{mode:?}");
        for other in &one.modes[..k] {
            close(product(&mode.in_phase, &other.in_phase), 0.0, 1e-9);
        }
    }
}

/// Two equal oscillators are two modes, each of which moves by itself.
#[test]
fn modes_of_one_frequency_differ_in_any_units() {
    for [length, time, energy] in
        [[1.0, 1.0, 1.0], [5e-11, 2.4e-17, 4.4e-18], [3.1e19, 3.2e15, 2.7e41], [1.9e70, 1e60, 4e80]]
    {
        let [q, rate] = [format!("/{length:e}"), format!("*{:e}", time / length)];
        let text = format!(
            "title = \"two\"\n[coordinates]\nx = {{ initial = {:e} }}\ny = {{ initial = {:e} }}\n[lagrangian]\n\
             L = \"{energy:e}*(1/2*((x'{rate})^2 + (y'{rate})^2) - 1/2*((x{q})^2 + (y{q})^2) - (x{q})^2*(y{q}) + 1/3*(y{q})^3)\"\n",
            0.1 * length,
            0.15 * length
        );
        let found = of(&file(&text, &[]));
        let rest =
            found.iter().find(|one| one.kind == Some(EquilibriumKind::Minimum)).expect("a minimum");
        assert_eq!(rest.modes.len(), 2, "{text}");
        for frequency in frequencies(rest) {
            close(frequency * time, 1.0, 1e-9);
        }
        for (k, mode) in rest.modes.iter().enumerate() {
            assert!(mode.in_phase[1 - k].abs() < 1e-9, "{:?}", rest.modes);
            close(mode.in_phase[k], 1.0, 1e-15);
        }
    }
}

/// Where a coordinate enters by sines and cosines alone, places a turn apart are one, also where the file gives it no period:
/// cos θ = g/(l φ'²) of the conical pendulum and its mirror image. A constant torque tells them apart by their energy.
#[test]
fn of_places_a_turn_apart_one_is_found() {
    let case = preset("spherical-pendulum", &[], &[]);
    let found = equilibria(&case.space, &case.start).unwrap();
    let tau = std::f64::consts::TAU;
    assert_eq!(found.periods, [(0, tau)]);
    assert_eq!(found.found.len(), 2);
    for one in &found.found {
        let (_, turning) = one.rates[0];
        close(one.variables[0].cos() * turning * turning, 9.81, 1e-11);
    }
    close(found.found[0].variables[0] + found.found[1].variables[0], 0.0, 1e-12);
    let text = |term: &str| {
        format!(
            "title = \"t\"\n[coordinates]\nx = {{ initial = 0.5, momentum = 0 }}\n[hamiltonian]\n\
             H = \"1/2*p_x^2 - cos(2*x) - cos(3*x)/4{term}\"\n"
        )
    };
    // V' = 2 sin 2x + ¾ sin 3x has a common period 2π and, by its changes of sign, four zeros in it
    let case = file(&text(""), &[]);
    let found = equilibria(&case.space, &case.start).unwrap();
    assert_eq!(found.periods, [(0, tau)]);
    let slope = |x: f64| 2.0 * (2.0 * x).sin() + 0.75 * (3.0 * x).sin();
    let grid = |k: u32| 0.001 + tau * f64::from(k) / 4000.0;
    let changes = (0..4000).filter(|&k| slope(grid(k)) * slope(grid(k + 1)) < 0.0).count();
    assert_eq!(found.found.len(), changes);
    let case = file(&text(" - x/10"), &[]);
    let found = equilibria(&case.space, &case.start).unwrap();
    assert!(found.periods.is_empty() && found.found.len() > 4, "{found:?}");
}

/// The same where constraints may hold the coordinates.
fn held(text: &str, start: &[f64]) -> Vec<Equilibrium> {
    let case = case_in(&lowered(text), &[], start, PhaseSpace::without_impulses);
    equilibria(&case.space, &case.start).unwrap().found
}

fn kinds(found: &[Equilibrium]) -> Vec<(Option<EquilibriumKind>, Option<bool>)> {
    found.iter().map(|one| (one.kind, one.stable)).collect()
}

const MINIMUM: (Option<EquilibriumKind>, Option<bool>) =
    (Some(EquilibriumKind::Minimum), Some(true));
const SADDLE: (Option<EquilibriumKind>, Option<bool>) =
    (Some(EquilibriumKind::Saddle), Some(false));
const MAXIMUM: (Option<EquilibriumKind>, Option<bool>) =
    (Some(EquilibriumKind::Maximum), Some(false));

#[test]
fn a_rod_holds_a_bob_below_and_above() {
    let found = held(
        "title = \"t\"\n[coordinates]\nx = { initial = \"l*sin(0.7)\", velocity = 0 }\ny = { initial = \"-l*cos(0.7)\" }\n\
         [parameters]\ng = 9.81\nl = 0.8\nm = 3\n[lagrangian]\nL = \"1/2*m*(x'^2 + y'^2) - m*g*y\"\n\
         [[constraints]]\nname = \"rod\"\nexpression = \"x^2 + y^2 - l^2\"\n",
        &[],
    );
    assert_eq!(kinds(&found), [MINIMUM, MAXIMUM]);
    for (one, side) in found.iter().zip([-1.0, 1.0]) {
        close(one.variables[0], 0.0, 1e-14);
        close(one.variables[1], side * 0.8, 1e-14);
        close(one.energy, side * 3.0 * 9.81 * 0.8, 1e-13);
    }
    let rate = (9.81_f64 / 0.8).sqrt();
    let [mode] = &found[0].modes[..] else { panic!("{:?}", found[0]) };
    close(mode.frequency, rate, 1e-13);
    assert_eq!((&mode.in_phase[..], &mode.quadrature[..]), (&[1.0, 0.0][..], &[0.0, 0.0][..]));
    close(found[1].eigenvalues[0][0], rate, 1e-13);
}

/// A bead on the wire y = x⁴/4 − x²/2 + c x, whose bottom and top have V″ = m g y″ and, at rest, the mass m.
#[test]
fn a_bead_rests_where_its_wire_is_level() {
    let (g, c) = (3.7, 0.1);
    let found = held(
        "title = \"t\"\n[coordinates]\nx = { initial = 0.3, velocity = 0 }\ny = { initial = \"x^4/4 - x^2/2 + c*x\" }\n\
         [parameters]\ng = 3.7\nc = 0.1\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2) - g*y\"\n\
         [[constraints]]\nname = \"wire\"\nexpression = \"y - x^4/4 + x^2/2 - c*x\"\n"
            .replace("\"x^4/4 - x^2/2 + c*x\" }", "-0.012975 }")
            .as_str(),
        &[],
    );
    // x³ − x + c = 0 by trigonometry
    let third = (-(27.0_f64 / 4.0).sqrt() * c).acos() / 3.0;
    let root = |k: f64| 2.0 / 3.0_f64.sqrt() * (third - 2.0 * std::f64::consts::PI * k / 3.0).cos();
    let mut wanted: Vec<(f64, f64)> =
        (0..3).map(|k| root(f64::from(k))).map(|x| (x, 3.0 * x * x - 1.0)).collect();
    let height = |x: f64| x.powi(4) / 4.0 - x * x / 2.0 + c * x;
    wanted.sort_by(|a, b| height(a.0).total_cmp(&height(b.0)));
    assert_eq!(kinds(&found), [MINIMUM, MINIMUM, MAXIMUM]);
    for (one, (x, bends)) in found.iter().zip(wanted) {
        close(one.variables[0], x, 1e-12);
        close(one.variables[1], height(x), 1e-12);
        close(one.energy, g * height(x), 1e-12);
        let [[real, imaginary], _] = one.eigenvalues[..] else { panic!("{one:?}") };
        close(real * real - imaginary * imaginary, -g * bends, 1e-11);
    }
}

/// Two bobs in x and y on two rods: the double pendulum by constraints, against the one by angles.
#[test]
fn a_double_pendulum_by_constraints_has_the_equilibria_of_its_angles() {
    let rods = "title = \"t\"\n[coordinates]\nx = { initial = \"l*sin(0.4)\", velocity = 0 }\ny = { initial = \"-l*cos(0.4)\" }\n\
         u = { initial = \"l*sin(0.4) + k*sin(0.9)\", velocity = 0 }\nv = { initial = \"-l*cos(0.4) - k*cos(0.9)\" }\n\
         [parameters]\ng = 9.81\nl = 1.2\nk = 0.7\nm = 1.5\nn = 0.6\n\
         [lagrangian]\nL = \"1/2*m*(x'^2 + y'^2) + 1/2*n*(u'^2 + v'^2) - m*g*y - n*g*v\"\n\
         [[constraints]]\nname = \"upper\"\nexpression = \"x^2 + y^2 - l^2\"\n\
         [[constraints]]\nname = \"lower\"\nexpression = \"(u - x)^2 + (v - y)^2 - k^2\"\n";
    let angles = "title = \"t\"\n[coordinates]\na = { initial = 0.4, velocity = 0 }\nb = { initial = 0.9, velocity = 0 }\n\
         [parameters]\ng = 9.81\nl = 1.2\nk = 0.7\nm = 1.5\nn = 0.6\n\
         [lagrangian]\nL = \"1/2*(m + n)*l^2*a'^2 + 1/2*n*k^2*b'^2 + n*l*k*a'*b'*cos(a - b) + (m + n)*g*l*cos(a) + n*g*k*cos(b)\"\n";
    let (found, wanted) = (held(rods, &[]), of(&file(angles, &[])));
    assert_eq!(kinds(&found), [MINIMUM, SADDLE, SADDLE, MAXIMUM]);
    assert_eq!(wanted.len(), found.len());
    for (one, wanted) in found.iter().zip(&wanted) {
        let (a, b) = (wanted.variables[0], wanted.variables[1]);
        let place = [
            1.2 * a.sin(),
            -1.2 * a.cos(),
            1.2 * a.sin() + 0.7 * b.sin(),
            -1.2 * a.cos() - 0.7 * b.cos(),
        ];
        for (x, place) in one.variables.iter().zip(place) {
            close(*x, place, 1e-12);
        }
        close(one.energy, wanted.energy, 1e-11);
        assert_eq!(one.eigenvalues.len(), wanted.eigenvalues.len());
        let size = wanted.eigenvalues[0].iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for value in &wanted.eigenvalues {
            let near = one.eigenvalues.iter().any(|other| {
                (other[0] - value[0]).abs() + (other[1] - value[1]).abs() < 1e-11 * size
            });
            assert!(near, "{:?} {:?}", one.eigenvalues, wanted.eigenvalues);
        }
        // a mode of the angles, carried to the plane; heights do not change
        for (mode, wanted) in one.modes.iter().zip(&wanted.modes) {
            let (da, db) = (wanted.in_phase[0], wanted.in_phase[1]);
            let plane = [1.2 * a.cos() * da, 0.0, 1.2 * a.cos() * da + 0.7 * b.cos() * db, 0.0];
            let largest = if plane[0].abs() > plane[2].abs() { plane[0] } else { plane[2] };
            for (x, plane) in mode.in_phase.iter().zip(plane) {
                close(*x, plane / largest, 1e-10);
            }
        }
    }
}

/// A bead on the bowl z = r²/2 in cylindrical coordinates goes round: at p² = g r⁴ on a circle of radius r, and its radius
/// oscillates with ω² = 4 g/(1 + r²), by the effective potential p²/2r² + g r²/2 and the mass 1 + r².
#[test]
fn a_bead_in_a_bowl_goes_round() {
    let found = held(
        "title = \"t\"\n[coordinates]\nr = { initial = 1.3, velocity = 0 }\nphi = { initial = 0, velocity = 1.1, period = \"2*pi\" }\n\
         z = { initial = \"1.3^2/2\" }\n[parameters]\ng = 2\n[lagrangian]\nL = \"1/2*(r'^2 + r^2*phi'^2 + z'^2) - g*z\"\n\
         [[constraints]]\nname = \"bowl\"\nexpression = \"z - r^2/2\"\n",
        &[],
    );
    let p: f64 = 1.3 * 1.3 * 1.1;
    let r = (p * p / 2.0).powf(0.25);
    let outside: Vec<_> = found.iter().filter(|one| one.variables[0] > 0.0).collect();
    let [one] = outside[..] else { panic!("{found:?}") };
    assert_eq!((one.kind, one.stable), MINIMUM);
    close(one.variables[0], r, 1e-13);
    close(one.variables[2], r * r / 2.0, 1e-13);
    close(one.variables[4], p, 1e-13);
    let [(1, going)] = one.rates[..] else { panic!("{one:?}") };
    close(going, p / (r * r), 1e-13);
    let [mode] = &one.modes[..] else { panic!("{one:?}") };
    close(mode.frequency, (8.0 / (1.0 + r * r)).sqrt(), 1e-12);
    close(mode.in_phase[0] * r, mode.in_phase[2], 1e-12);
    assert_eq!(mode.in_phase[1], 0.0);
}

/// A disc of radius R that rolls on its edge, upright: it falls over with λ² = m g R/(I + m R²), whichever way it looks, and
/// hanging below the table it would oscillate with that. Its places and headings are a family.
#[test]
fn a_disc_on_its_edge_falls_over() {
    let found = equilibria_of("rolling-coin");
    assert_eq!(kinds(&found), [(None, None), (None, Some(false))]);
    // I = m R²/4 about a diameter: λ² = 4 g/5 R
    close(found[1].eigenvalues[0][0], (0.8_f64 * 9.81 / 0.5).sqrt(), 1e-11);
    close(found[0].modes[0].frequency, (0.8_f64 * 9.81 / 0.5).sqrt(), 1e-11);
}

fn equilibria_of(name: &str) -> Vec<Equilibrium> {
    let case = case_in(&loaded(name, 1), &[], &[], PhaseSpace::without_impulses);
    equilibria(&case.space, &case.start).unwrap().found
}

/// A wheel that rolls without slipping on a hill, where x = r θ is kept from the start on: it rests in the valleys.
#[test]
fn a_rolling_wheel_rests_in_a_valley() {
    let found = held(
        "title = \"t\"\n[coordinates]\nx = { initial = 0.2 }\ntheta = { initial = 1, velocity = 0 }\n[parameters]\nr = 0.5\n\
         [lagrangian]\nL = \"1/2*x'^2 + 1/2*r^2*theta'^2 + cos(x)\"\n\
         [[constraints]]\nname = \"rolling\"\nexpression = \"r*theta' - x'\"\n",
        &[],
    );
    let valley = found.iter().find(|one| one.variables[0].abs() < 1.0).unwrap();
    assert_eq!((valley.kind, valley.stable), MINIMUM);
    close(valley.variables[0], 0.0, 1e-13);
    close(valley.variables[1], 1.0 - 0.2 / 0.5, 1e-12);
    close(frequencies(valley)[0], 0.5_f64.sqrt(), 1e-12);
}

#[test]
fn a_constraint_that_drives_lets_nothing_rest() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0.2 }\ny = { initial = 1, velocity = 0 }\n\
         [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - y^2/2\"\n\
         [[constraints]]\nname = \"belt\"\nexpression = \"x' - 2\"\n";
    let case = case_in(&lowered(text), &[], &[], PhaseSpace::without_impulses);
    let Err(DynamicsError::Unsuited(why)) = equilibria(&case.space, &case.start) else { panic!() };
    assert!(why.contains("prescribes a velocity"), "{why}");
}

/// ẋ = (x − y)/2 is prescribed, and nothing acts on y but its spring: at the origin alone nothing moves. It is left with
/// e^(t/2), while y oscillates with 1. Of ẋ = y/2 every place with y = 0 is one.
#[test]
fn what_rests_where_a_prescribed_velocity_vanishes() {
    let under = |constraint: &str| {
        held(
            &format!(
                "title = \"t\"\n[coordinates]\nx = {{ initial = 0.1 }}\ny = {{ initial = 0.2 }}\n\
                 [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - 1/2*x^2 - 1/2*y^2\"\n\
                 [[constraints]]\nname = \"c\"\nexpression = \"{constraint}\"\n"
            ),
            &[],
        )
    };
    let found = under("x' + 0.5*y - 0.5*x");
    assert_eq!(found.len(), 1);
    let origin = &found[0];
    assert!(origin.variables.iter().all(|x| x.abs() < 1e-12), "{:?}", origin.variables);
    assert_eq!(origin.stable, Some(false));
    let mut values = origin.eigenvalues.clone();
    values.sort_by(|a, b| (b[0], b[1]).partial_cmp(&(a[0], a[1])).unwrap());
    for (value, wanted) in values.iter().zip([[0.5, 0.0], [0.0, 1.0], [0.0, -1.0]]) {
        (0..2).for_each(|k| assert!((value[k] - wanted[k]).abs() < 1e-12, "{values:?}"));
    }
    let found = under("x' - 0.5*y");
    assert!(!found.is_empty());
    assert!(found.iter().all(|one| one.variables[1].abs() < 1e-12));
}

/// Two steep centres, a coupling and a spring: V is the same at (−x, −y), and so are its equilibria. The gradient's zeros were
/// searched for in `SciPy` from 6000 random places: there are eleven but for the centre's pair.
#[test]
fn places_that_few_beginnings_reach_are_found() {
    let found = of(&file(
        "title = \"t\"\n[coordinates]\nx = { initial = 0.4, velocity = 0.1 }\ny = { initial = 1.1, velocity = -0.2 }\n\
         [parameters]\nk = 0.3\n[lagrangian]\nL = \"1/2*(x'^2 + 2*y'^2) - (1/((x-1)^2+y^2)^6 - 1/((x-1)^2+y^2)^3) \
         - (1/((x+1)^2+y^2)^6 - 1/((x+1)^2+y^2)^3) - k*x*y - y^2/4\"\n",
        &[],
    ));
    for one in &found {
        let opposite = |other: &Equilibrium| {
            (0..2).all(|i| (other.variables[i] + one.variables[i]).abs() < 1e-9)
        };
        assert!(found.iter().any(opposite), "{:?}", one.variables);
    }
    assert_eq!(found.len(), 11, "{:?}", found.iter().map(|one| &one.variables).collect::<Vec<_>>());
}

/// Units of mass, length and time: natural, of a laboratory, of an atom, of a galaxy.
const UNITS: [[f64; 3]; 4] = [
    [1.0, 1.0, 1.0],
    [0.15, 0.8, 0.35],
    [9.109e-31, 5.292e-11, 2.419e-17],
    [1.989e30, 3.086e16, 3.156e13],
];

/// The kinds found of a law with the terms c₀, c₁, … of these dimensions (powers of mass, length, time), written as numbers
/// or as parameters.
fn kinds_in_units(
    law: &str,
    terms: &[[i32; 3]],
    start: [[f64; 2]; 2],
    units: [f64; 3],
    named: bool,
) -> Vec<EquilibriumKind> {
    let size =
        |powers: [i32; 3]| -> f64 { units.iter().zip(powers).map(|(u, n)| u.powi(n)).product() };
    let (mut law, mut parameters) = (law.to_owned(), String::new());
    for (i, &powers) in terms.iter().enumerate() {
        if named {
            parameters += &format!("c{i} = {:e}\n", size(powers));
        } else {
            law = law.replace(&format!("c{i}"), &format!("{:e}", size(powers)));
        }
    }
    let [x, y] = start.map(|[place, speed]| {
        format!(
            "{{ initial = {:e}, velocity = {:e} }}",
            place * units[1],
            speed * units[1] / units[2]
        )
    });
    let text = format!(
        "title = \"a\"\n[parameters]\n{parameters}[coordinates]\nx = {x}\ny = {y}\n[lagrangian]\nL = \"{law}\"\n"
    );
    let found = of(&file(&text, &[]));
    found.iter().map(|one| one.kind.unwrap()).collect()
}

/// The minimum and the three saddles of Hénon and Heiles's potential, from a start a tenth of the way to them; and none of a
/// constant force, however small it is in its units.
#[test]
fn a_law_has_the_same_equilibria_in_any_units() {
    let energy = |lengths: i32| [1, 2 - lengths, -2];
    let henon = "1/2*c0*(x'^2 + y'^2) - 1/2*c1*(x^2 + y^2) - c2*(x^2*y - y^3/3)";
    let fall = "1/2*c0*(x'^2 + y'^2) - c1*y";
    for (units, named) in UNITS.map(|units| (units, false)).into_iter().chain([(UNITS[2], true)]) {
        let start = [[0.0, 0.42], [0.1, 0.15]];
        let found = kinds_in_units(henon, &[[1, 0, 0], energy(2), energy(3)], start, units, named);
        let four = [
            EquilibriumKind::Minimum,
            EquilibriumKind::Saddle,
            EquilibriumKind::Saddle,
            EquilibriumKind::Saddle,
        ];
        assert_eq!(found, four, "{units:?} {named}");
        let start = [[1.0, 0.2], [0.3, 0.9]];
        let found = kinds_in_units(fall, &[[1, 0, 0], energy(1)], start, units, named);
        assert_eq!(found, [], "{units:?} {named}");
    }
}

/// Where the forces vanish to a higher order there is one equilibrium as well, and none where they vanish only in the limit.
#[test]
fn a_zero_of_higher_order_is_one_equilibrium() {
    let of_potential = |potential: &str, start: f64| -> Vec<f64> {
        let found = held(
            &format!(
                "title = \"one\"\n[coordinates]\nx = {{ initial = {start} }}\n[lagrangian]\n\
                 L = \"1/2*x'^2 - ({potential})\"\n"
            ),
            &[],
        );
        assert!(
            found.iter().all(|one| one.kind == Some(EquilibriumKind::Degenerate)),
            "{potential}"
        );
        found.iter().map(|one| one.variables[0]).collect()
    };
    for potential in ["x^4", "1e12*x^4", "x^3", "x^6", "x^20", "cosh(x) - 1 - x^2/2", "x^4 + x^8"] {
        let found = of_potential(potential, 1.0);
        assert!(found.len() == 1 && found[0].abs() < 1e-3, "{potential}: {found:?}");
    }
    let found = of_potential("(x - 1)^4", 0.3);
    assert!(found.len() == 1 && (found[0] - 1.0).abs() < 1e-9, "{found:?}");
    // π is not a floating-point number
    let text = "title = \"one\"\n[coordinates]\nx = { initial = 1.0 }\n[lagrangian]\nL = \"1/2*x'^2 - V\"\n";
    let found = held(&text.replace('V', "sin(x)^4"), &[]);
    assert!(found.iter().any(|one| one.kind == Some(EquilibriumKind::Maximum)));
    for one in found {
        let flat = one.variables[0].sin().abs() < 0.5;
        let kind = if flat { EquilibriumKind::Degenerate } else { EquilibriumKind::Maximum };
        assert_eq!(one.kind, Some(kind), "{:?}", one.variables);
        assert!(one.modes.is_empty(), "{:?}", one.modes);
    }
    // a narrow well far away is 0 here, and takes nothing away
    let two = text.replace('V', "(x^2 - 1)^2 - exp(-10*(x - 30)^2)");
    let loaded = lowered(&two);
    let case = case_in(&loaded, &[], &[], PhaseSpace::without_impulses);
    let mut found = equilibria(&case.space, &case.start).unwrap().found;
    with_virtual_work((&loaded.model, &loaded.equations), case.space.parameters(), &mut found);
    let places: Vec<_> =
        found.iter().map(|one| one.variables[0]).filter(|x| x.abs() < 2.0).collect();
    assert_eq!(places, [1.0, -1.0, 0.0], "{found:?}");
    // at x = 0 there is a maximum or a minimum; beyond it the force falls, and is 0 only for want of smaller numbers
    for (potential, kind) in
        [("exp(-x^2)", EquilibriumKind::Maximum), ("(1 - exp(-x^4))", EquilibriumKind::Degenerate)]
    {
        let loaded = lowered(&text.replace('V', potential));
        let case = case_in(&loaded, &[], &[], PhaseSpace::without_impulses);
        let mut found = equilibria(&case.space, &case.start).unwrap().found;
        with_virtual_work((&loaded.model, &loaded.equations), case.space.parameters(), &mut found);
        let places: Vec<_> = found.iter().map(|one| (one.variables[0], one.kind)).collect();
        assert_eq!(places, [(0.0, Some(kind))]);
    }
}

/// At L₄ the first component of the linearised motion, (−ω² − U_xx) x − 2iω y = U_xy y, gives y/x; at L₁ the ellipse has the
/// axis of the bodies as one of its own.
#[test]
fn modes_have_all_their_digits() {
    let case = preset("restricted-three-body", &[], &[]);
    let mu = 0.012277471_f64;
    let found = of(&case);
    let near = |x: f64, y: f64| {
        let is_there =
            |one: &&Equilibrium| (one.variables[0] - x).hypot(one.variables[1] - y) < 0.02;
        found.iter().find(is_there).expect("an equilibrium")
    };
    for side in [1.0, -1.0] {
        let one = near(0.5 - mu, side * 0.75_f64.sqrt());
        assert_eq!(one.modes.len(), 2);
        for mode in &one.modes {
            let (w, a) = (mode.frequency, 0.75);
            let b = side * 27.0_f64.sqrt() / 4.0 * (1.0 - 2.0 * mu);
            // (−ω² − a)/(b + 2iω)
            let size = (-w * w - a) / (b * b + 4.0 * w * w);
            let ratio = [size * b, -size * 2.0 * w];
            // at q = (in phase + i quadrature) e^{iωt}, or its conjugate
            assert!((mode.in_phase[0] - 1.0).abs() < 1e-15, "{mode:?}");
            close(mode.in_phase[1], ratio[0], 1e-12);
            close(mode.quadrature[1].abs(), ratio[1].abs(), 1e-12);
        }
    }
    let one = near(0.836, 0.0);
    assert_eq!((one.modes[0].in_phase[0], one.modes[0].quadrature[1]), (0.0, 0.0));
}

/// Euler's equations have a family of permanent rotations along each principal axis, about which their rates are quadratic.
#[test]
fn a_free_body_rotates_about_its_axes() {
    let found = of(&preset("t-handle", &[], &[]));
    let rotates = found.iter().filter(|one| one.variables.iter().any(|x| x.abs() > 0.1)).count();
    assert!(rotates >= 2, "{found:?}");
}

/// On the sphere |L| of its start a body rotates about its three axes, either way round, and about the middle one not for long
/// (L. Euler).
#[test]
fn the_equilibria_of_brackets_are_those_on_their_casimirs() {
    let case = file(crate::poisson::BODY, &[]);
    let square: f64 = case.start.values[..3].iter().map(|x| x * x).sum();
    let found = of(&case);
    assert_eq!(found.len(), 6, "{found:?}");
    for one in &found {
        let largest = one.variables.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        close(largest, square.sqrt(), 1e-12);
        let axis = one.variables.iter().position(|x| x.abs() == largest);
        close(one.energy, square / (2.0 * (axis.unwrap() + 1) as f64), 1e-12);
        assert_eq!(one.stable, Some(axis != Some(1)), "{one:?}");
    }
}

/// Two minima of fourth order are two, however small V is and whatever constant it has.
#[test]
fn flat_minima_are_told_apart_in_any_unit_of_energy() {
    for (unit, constant) in [("1", "0"), ("1e-18", "0"), ("1", "1e9"), ("1e12", "0")] {
        let text = format!(
            "title = \"t\"\n[coordinates]\nx = {{ initial = 0.3, velocity = 0 }}\n[lagrangian]\n\
             L = \"1/2*{unit}*x'^2 - {unit}*(x^2 - 1)^4 - {constant}\"\n"
        );
        let mut places: Vec<f64> =
            of(&file(&text, &[])).iter().map(|one| one.variables[0]).collect();
        places.sort_by(f64::total_cmp);
        let expected = [-1.0, 0.0, 1.0];
        assert_eq!(places.len(), 3, "{unit}, {constant}: {places:?}");
        for (place, x) in places.iter().zip(expected) {
            close(*place, x, 1e-3);
        }
    }
}

/// A Casimir given three times is one: u runs away with any v, whatever is declared.
#[test]
fn casimirs_that_depend_on_each_other_are_one() {
    let stable = |casimirs: &str| {
        let text = format!(
            "title = \"t\"\n[variables]\nx = 0.7\ny = 0.0\nu = 0.2\nv = 0.1\nC1 = 1.0\n[poisson]\n\
             H = \"y^2/2 + C1*x^2/2 + v^2/2\"\nbrackets = [[\"x\", \"y\", \"1\"], [\"u\", \"v\", \"1\"]]\n\
             casimirs = {{ {casimirs} }}\n"
        );
        of(&file(&text, &[])).iter().map(|one| one.stable).collect::<Vec<_>>()
    };
    for casimirs in ["S = \"C1\"", "S = \"C1\", S2 = \"C1^2\", S3 = \"C1^3\""] {
        let found = stable(casimirs);
        assert!(!found.is_empty() && found.iter().all(Option::is_none), "{found:?}");
    }
}

/// A family of equilibria has one member listed, the one nearest to the start, with the directions along it; what is no family
/// is not called so.
#[test]
fn a_curve_of_equilibria_is_a_family() {
    let plane = |potential: &str| {
        held(
            &format!(
                "title = \"t\"\n[coordinates]\nx = {{ initial = 1.3, velocity = 0 }}\ny = {{ initial = 0.4, velocity = 0 }}\n\
                 [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - ({potential})\"\n"
            ),
            &[],
        )
    };
    let zeros = |one: &Equilibrium| one.eigenvalues.iter().filter(|z| **z == [0.0, 0.0]).count();
    // the circle of minima, and the maximum in its middle
    let found = plane("(x^2 + y^2 - 1)^2");
    assert_eq!(found.iter().map(|one| one.family.len()).collect::<Vec<_>>(), [1, 0]);
    let radius = 1.3_f64.hypot(0.4);
    let circle = &found[0];
    close(circle.variables[0], 1.3 / radius, 1e-7);
    close(circle.variables[1], 0.4 / radius, 1e-7);
    close(circle.variables[0].hypot(circle.variables[1]), 1.0, 1e-14);
    let along = &circle.family[0];
    close(along[0] * circle.variables[0] + along[1] * circle.variables[1], 0.0, 1e-12);
    assert_eq!(zeros(circle), 2);
    close(frequencies(circle)[0], 8.0_f64.sqrt(), 1e-12);
    assert_eq!(found[1].kind, Some(EquilibriumKind::Maximum));
    // two circles of one energy are two, a valley is one, and so is a line
    let circles = plane("(x^2 + y^2 - 1)^2*(x^2 + y^2 - 4)^2");
    assert_eq!(circles.iter().filter(|one| one.family.len() == 1).count(), 3, "{circles:?}");
    let radii = |one: &Equilibrium| one.variables[0].hypot(one.variables[1]);
    let bottoms = circles.iter().filter(|one| one.energy < 1e-9).map(radii);
    let mut bottoms: Vec<f64> = bottoms.collect();
    bottoms.sort_by(f64::total_cmp);
    close(bottoms[0], 1.0, 1e-13);
    close(bottoms[1], 2.0, 1e-13);
    for potential in ["(y - x^2)^2", "1/2*(x - y)^2", "(y - sin(3*x))^2"] {
        let found = plane(potential);
        let families: Vec<usize> = found.iter().map(|one| one.family.len()).collect();
        assert_eq!(families, [1], "{potential}: {found:?}");
        assert_eq!(zeros(&found[0]), 2, "{potential}");
    }
    // V that grows like a fourth power has no family, and two zeros of one energy are two
    let found = plane("x^4 + y^2/2");
    assert_eq!(found.iter().map(|one| one.family.len()).collect::<Vec<_>>(), [0]);
    let found = plane("x^4*(x - 1)^4 + y^2");
    let mut places: Vec<f64> = found.iter().map(|one| one.variables[0]).collect();
    places.sort_by(f64::total_cmp);
    assert_eq!(places.len(), 3, "{places:?}");
    for (place, x) in places.iter().zip([0.0, 0.5, 1.0]) {
        close(*place, x, 1e-4);
    }
}

/// A bead on a circle rests everywhere, and on a sphere its equilibria are a surface.
#[test]
fn a_bead_that_nothing_pulls_rests_everywhere() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0.6, velocity = 0 }\ny = { initial = 0.8, velocity = 0 }\n\
                z = { initial = 0, velocity = 0 }\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2 + z'^2) - V\"\n\
                [[constraints]]\nname = \"wire\"\nexpression = \"x^2 + y^2 + c*z^2 - 1\"\n[parameters]\nc = C\n";
    for (potential, c, dimension) in [("z^2", "0", 1), ("0", "1", 2)] {
        let found = held(&text.replace('V', potential).replace('C', c), &[]);
        let [one] = &found[..] else { panic!("{found:?}") };
        assert_eq!(one.family.len(), dimension);
        close(one.variables[0], 0.6, 1e-12);
        close(one.variables[1], 0.8, 1e-12);
    }
}

/// Two wells 1e-5 apart are two, with the maximum between them; next to the pole of a centrifugal force nothing rests.
#[test]
fn equilibria_close_to_each_other_are_told_apart_and_poles_are_none() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0.5, velocity = 0 }\n[lagrangian]\n\
                L = \"1/2*x'^2 - (x^2 - 0.25e-10)^2*(x^2 + 1)\"\n";
    let found = held(text, &[]);
    assert_eq!(kinds(&found), [MINIMUM, MINIMUM, MAXIMUM]);
    let mut places: Vec<f64> = found.iter().map(|one| one.variables[0]).collect();
    places.sort_by(f64::total_cmp);
    for (place, x) in places.iter().zip([-5e-6, 0.0, 5e-6]) {
        close(*place, x, 1e-15);
    }
    // about x = ½ the force has an error of 1e-16, which leaves the wells uncertain by 1e-6, and they are listed once each
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0.5, velocity = 0 }\n[lagrangian]\n\
                L = \"1/2*x'^2 - ((x - 1/2)^2 - 0.25e-10)^2\"\n";
    let found = held(text, &[]);
    let mut places: Vec<f64> = found.iter().map(|one| one.variables[0]).collect();
    places.sort_by(f64::total_cmp);
    assert_eq!(places.len(), 3, "{places:?}");
    for (place, x) in places.iter().zip([-5e-6, 0.0, 5e-6]) {
        close(*place, 0.5 + x, 2e-6);
    }
    let half = std::f64::consts::FRAC_PI_2;
    let case = preset("spherical-pendulum", &[], &[half]);
    let found = of(&case);
    assert_eq!(found.len(), 2, "{found:?}");
    for one in &found {
        let (_, turning) = one.rates[0];
        close(one.variables[0].cos() * turning * turning, 9.81, 1e-11);
    }
}

/// L₄ and L₅ have one energy: which comes first is no matter of where the search begins.
#[test]
fn equilibria_of_one_energy_have_an_order_of_their_own() {
    for x0 in [0.5, -0.5, 0.994] {
        let found = of(&preset("restricted-three-body", &[("x0", x0)], &[]));
        let above: Vec<bool> = found[3..].iter().map(|one| one.variables[1] > 0.0).collect();
        assert_eq!(above, [true, false], "{x0}");
    }
}

/// Laws of SI units, with the places of their equilibria in the length a: two softened charges from half-way between them, where the forces'
/// own derivatives vanish; three atoms of Lennard-Jones; a cosine; a double well from its top; a tail that underflows.
#[test]
fn a_law_of_si_units_has_the_equilibria_of_its_numbers() {
    let one = "x = { initial = S }";
    let two = "x = { initial = S }\ny = { initial = T }";
    // three in a line: d⁶ = 2 (2 + 2⁻¹²)/(2 + 2⁻⁶)
    let line = (2.0 * (2.0 + 2.0_f64.powi(-12)) / (2.0 + 2.0_f64.powi(-6))).powf(1.0 / 6.0);
    let laws: [(&str, &str, [f64; 2], &[f64]); 5] = [
        (
            two,
            "k/sqrt(x^2 + y^2 + 0.1*a^2) - k/sqrt((x - 2*a)^2 + y^2 + 0.1*a^2)",
            [1.0, 0.5],
            &[-0.007569475, 2.007569475],
        ),
        (
            two,
            "-4*k/a*((a/x)^12 - (a/x)^6) - 8*k/a*(a^12/(x^2/4 + y^2)^6 - a^6/(x^2/4 + y^2)^3)",
            [1.1, 0.9],
            &[-2.0 * line, -1.122462048, -1.122462048, 1.122462048, 1.122462048, 2.0 * line],
        ),
        (one, "k/a*cos(x/a)", [2.5, 0.0], &[0.0, std::f64::consts::PI]),
        (one, "-k/a*((x/a)^2 - 1)^2", [0.0, 0.0], &[-1.0, 0.0, 1.0]),
        (
            one,
            "-k/a*(x/a)^4*exp(-(x/a)^2)",
            [1.5, 0.0],
            &[-std::f64::consts::SQRT_2, 0.0, std::f64::consts::SQRT_2],
        ),
    ];
    for (coordinates, potential, start, places) in laws {
        for [mass, length, time] in [UNITS[0], UNITS[2], UNITS[3]] {
            let energy = mass * length * length / (time * time);
            let [s, t] = start.map(|x| format!("{:e}", x * length));
            let coordinates = coordinates.replace('S', &s).replace('T', &t);
            let kinetic = if start[1] > 0.0 { "(x'^2 + y'^2)" } else { "x'^2" };
            let text = format!(
                "title = \"t\"\n[coordinates]\n{coordinates}\n[parameters]\nm = {mass:e}\na = {length:e}\n\
                 k = {:e}\n[lagrangian]\nL = \"1/2*m*{kinetic} + {potential}\"\n",
                energy * length
            );
            let loaded = lowered(&text);
            let case = case_in(&loaded, &[], &[], PhaseSpace::without_impulses);
            let mut found = of(&case);
            let law = (&*loaded.model, &*loaded.equations);
            with_virtual_work(law, case.space.parameters(), &mut found);
            let mut there: Vec<f64> = found.iter().map(|one| one.variables[0] / length).collect();
            there.sort_by(f64::total_cmp);
            assert_eq!(there.len(), places.len(), "{potential} in {length:e}: {there:?}");
            for (x, place) in there.iter().zip(places) {
                close(*x, *place, 1e-8);
            }
        }
    }
}

/// A charge on a plane in a uniform field B, with p_φ = q B r²/2: it rests where the velocity that belongs to the momentum vanishes.
#[test]
fn a_cyclic_coordinate_may_rest() {
    let text = "title = \"t\"\n[coordinates]\nr = { initial = 1.0 }\nphi = { initial = 0, velocity = 0.5 }\n\
                [lagrangian]\nL = \"1/2*r'^2 + 1/2*r^2*phi'^2 + 0.35*r^2*phi'\"\n";
    let loaded = lowered(text);
    let case = case_in(&loaded, &[], &[], PhaseSpace::without_impulses);
    let mut found = of(&case);
    with_virtual_work((&loaded.model, &loaded.equations), case.space.parameters(), &mut found);
    let radius = (0.85_f64 / 0.35).sqrt();
    assert_eq!(found.len(), 2);
    for (one, r) in found.iter().zip([radius, -radius]) {
        close(one.variables[0], r, 1e-13);
        assert_eq!((one.kind, one.rates[0]), (Some(EquilibriumKind::Minimum), (1, 0.0)));
        // the frequency of a cyclotron
        close(one.modes[0].frequency, 0.7, 1e-12);
    }
}

/// H = p⁴ − p² + x²/2 has minima at p = ±1/√2; H = cosh p_x + cos p_y + … rests with sin p_y = 0 as well as with p_y = 0.
#[test]
fn equilibria_differ_by_their_momenta() {
    let found = held(
        "title = \"t\"\n[coordinates]\nx = { initial = 0.5, momentum = 0.9 }\n[hamiltonian]\nH = \"p_x^4 - p_x^2 + 1/2*x^2\"\n",
        &[],
    );
    assert_eq!(found.len(), 3, "{found:?}");
    for (one, (p, energy)) in found.iter().zip([(1.0, -0.25), (-1.0, -0.25), (0.0, 0.0)]) {
        close(one.variables[0], 0.0, 1e-12);
        close(one.variables[1], p * std::f64::consts::FRAC_1_SQRT_2, 1e-12);
        close(one.energy, energy, 1e-12);
    }
}

/// A rotating bar: the narrow minimum at its centre, far from the start, and the places of corotation; (0, −y) is out of reach, but the
/// image of one that is not.
#[test]
fn a_narrow_well_at_the_origin_is_found() {
    let found = held(
        "title = \"t\"\n[coordinates]\nx = { initial = 3.0, velocity = 20 }\ny = { initial = 0.5, velocity = 180 }\n\
         [lagrangian]\nL = \"1/2*((x' - 39*y)^2 + (y' + 39*x)^2) - 1/2*220^2*ln(0.2^2 + x^2 + y^2/0.8^2)\"\n",
        &[],
    );
    assert_eq!(found.len(), 5, "{found:?}");
    // Ω² (r_c² + x²) = v₀², and Ω² (q² r_c² + y²) = v₀²
    let squared = (220.0_f64 / 39.0).powi(2);
    let (x, y) = ((squared - 0.04).sqrt(), (squared - 0.64 * 0.04).sqrt());
    for place in [[0.0, 0.0], [x, 0.0], [-x, 0.0], [0.0, y], [0.0, -y]] {
        let is_there = |one: &&Equilibrium| {
            place.iter().zip(&one.variables).all(|(a, b)| (a - b).abs() < 1e-10)
        };
        assert_eq!(found.iter().filter(is_there).count(), 1, "{place:?} {found:?}");
    }
}

/// In the plane, from (x, y): what is found of a potential.
fn in_plane(potential: &str, [x, y]: [f64; 2]) -> Vec<Equilibrium> {
    let text = format!(
        "title = \"t\"\n[coordinates]\nx = {{ initial = {x} }}\ny = {{ initial = {y} }}\n\
         [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - ({potential})\"\n"
    );
    of(&file(&text, &[]))
}

/// V = (x² + y² − 1)⁴ has one circle of equilibria and its middle, V = (xy − 1)² (x² + y² − 9)² a circle and both branches of a
/// hyperbola, which meet the circle in four places, and beside them what ∇V = 0 leaves: x = y = 0, x = y = ±√(11/4), x = −y = ±√(7/4).
#[test]
fn families_may_be_flat_and_may_cross() {
    let found = in_plane("(x^2 + y^2 - 1)^4", [2.0, 0.3]);
    assert_eq!(found.iter().map(|one| one.family.len()).collect::<Vec<_>>(), [1, 0], "{found:?}");
    let circle = &found[0];
    close(circle.variables[0].hypot(circle.variables[1]), 1.0, 1e-9);
    close(circle.variables[1] / circle.variables[0], 0.15, 1e-5);
    close(circle.family[0][0] / circle.family[0][1], -0.15, 1e-5);
    assert_eq!(
        (found[1].kind, &found[1].variables[..2]),
        (Some(EquilibriumKind::Maximum), &[0.0, 0.0][..])
    );
    let found = in_plane("(x*y - 1)^2*(x^2 + y^2 - 9)^2", [0.5, 0.4]);
    let (families, others): (Vec<_>, Vec<_>) = found.iter().partition(|one| !one.family.is_empty());
    let [circle, branch, opposite] = families[..] else { panic!("{families:?}") };
    let size = 0.5_f64.hypot(0.4);
    close(circle.variables[0], 3.0 * 0.5 / size, 1e-8);
    close(circle.variables[1], 3.0 * 0.4 / size, 1e-8);
    for (one, sign) in [(branch, 1.0), (opposite, -1.0)] {
        let [x, y] = [one.variables[0], one.variables[1]];
        close(x * y, 1.0, 1e-12);
        assert!(x * sign > 0.0, "{x}");
        // the way to the start is across the branch
        close((0.5 - x) * -x + (0.4 - y) * y, 0.0, 1e-8);
    }
    let mut diagonals: Vec<f64> = others.iter().map(|one| one.variables[0]).collect();
    diagonals.sort_by(f64::total_cmp);
    let (far, near) = (2.75_f64.sqrt(), 1.75_f64.sqrt());
    assert_eq!(diagonals.len(), 5, "{others:?}");
    for (x, place) in diagonals.iter().zip([-far, -near, 0.0, near, far]) {
        close(*x, place, 1e-12);
    }
}

/// What is soft is found and judged beside what is stiff; a ring that a weak force tilts is a minimum and a saddle.
#[test]
fn a_soft_direction_is_seen_beside_a_stiff_one() {
    for (potential, stable) in [
        ("x^4 + 1/2*1e6*y^2", Some(true)),
        ("x^60 + 1/2*1e6*y^2", Some(true)),
        ("x^4 - x^6 + 1/2*1e6*y^2", None),
        ("x^3 + 1/2*1e6*y^2", None),
    ] {
        let found = in_plane(potential, [0.3, 0.3]);
        let flat = found.iter().find(|one| one.variables[0].abs() < 0.1).expect("at 0");
        let kind = Some(EquilibriumKind::Degenerate);
        assert_eq!((flat.kind, flat.stable), (kind, stable), "{potential}: {found:?}");
    }
    for stiffness in ["1e12", "1e17"] {
        let found = in_plane(&format!("1/2*{stiffness}*x^2 + 1/2*y^2"), [1.3, 0.4]);
        assert_eq!(kinds(&found), [MINIMUM], "{stiffness}");
    }
    let found = in_plane("(x^2 - 1e-8)^2*1e16 + y^2", [1.3, 0.4]);
    assert_eq!(kinds(&found), [MINIMUM, MINIMUM, SADDLE]);
    let found = in_plane("(x^2 + y^2 - 1)^2 + 1e-9*x", [1.3, 0.4]);
    assert_eq!(kinds(&found), [SADDLE, MINIMUM, MAXIMUM]);
    for (one, x) in found.iter().zip([1.0, -1.0, 0.0]) {
        close(one.variables[0], x, 1e-9);
        close(one.variables[1], 0.0, 1e-12);
    }
    // V_yy = −1e-9 at (1, 0)
    close(found[0].eigenvalues[2][0], 1e-9_f64.sqrt(), 1e-9);
}

/// A law with more equilibria than are listed says so.
#[test]
fn a_list_that_is_full_says_so() {
    let text = |wells: u32| {
        format!(
            "title = \"t\"\n[coordinates]\nx = {{ initial = 0.1 }}\ny = {{ initial = 0.2 }}\n\
             [lagrangian]\nL = \"1/2*(x'^2 + y'^2) + cos({wells}*x)*cos({wells}*y) - x^2/100 - y^2/50\"\n"
        )
    };
    let search = |wells: u32| {
        let case = file(&text(wells), &[]);
        equilibria(&case.space, &case.start).unwrap()
    };
    let (many, few) = (search(9), search(0));
    assert_eq!((many.found.len(), many.is_complete), (100, false));
    assert_eq!((few.found.len(), few.is_complete), (1, true));
}

/// The member listed is the place nearest to the start, whatever the momenta are there: a free body's is along the axis of its start,
/// a charge in a field rests where it is, and the top's circle is listed once.
#[test]
fn the_member_of_a_family_is_the_nearest_place() {
    let mirror = of(&preset("magnetic-mirror", &[], &[]));
    let [one] = &mirror[..] else { panic!("{mirror:?}") };
    for (x, place) in one.variables.iter().zip([1.0, 0.0, 0.0]) {
        close(*x, place, 1e-9);
    }
    let top = of(&preset("heavy-top-body", &[], &[]));
    assert_eq!(top.iter().map(|one| one.family.len()).collect::<Vec<_>>(), [1, 0, 0], "{top:?}");
    close(top[0].variables[0], 0.0, 1e-9);
}

/// At θ = x = 0 the masses x′θ′ cos θ and the others make a singular matrix: only the two wells beside it are equilibria.
#[test]
fn a_singular_mass_matrix_is_no_equilibrium() {
    let found = held(
        "title = \"t\"\n[coordinates]\nth = { initial = 0.5, period = \"2*pi\" }\nx = { initial = 0.1 }\n[lagrangian]\n\
         L = \"1/2*(th'^2 + x'^2 + 2*x'*th'*cos(th)) + 8*(x + sin(th))^2 - 25/2*x^2 + 9.81*cos(th)\"\n",
        &[],
    );
    assert_eq!(kinds(&found), [MINIMUM, MINIMUM], "{found:?}");
    // ∂V/∂x = 0 at 9 x = 16 sin θ
    for one in &found {
        close(9.0 * one.variables[1], 16.0 * one.variables[0].sin(), 1e-11);
    }
}

/// E. Lorenz's equations are the same in (−x, −y, z): both of C± = (±√(b (r − 1)), ±√(b (r − 1)), r − 1) are found, though one of them
/// is farther from the start than the search goes.
#[test]
fn a_twin_is_found_beyond_the_reach_of_the_search() {
    for start in [[1.0, 2.0, 20.0], [-1.0, -2.0, 20.0]] {
        let [x, y, z] = start;
        let text = format!(
            "title = \"t\"\n[variables]\nx = {x:?}\ny = {y:?}\nz = {z:?}\n[parameters]\nr = 28.0\n[poisson]\n\
             H = \"0\"\nbrackets = [[\"x\", \"y\", \"0\"]]\n\
             forces = {{ x = \"10*(y - x)\", y = \"x*(r - z) - y\", z = \"x*y - 8/3*z\" }}\n"
        );
        let mut places: Vec<[f64; 3]> = of(&file(&text, &[]))
            .iter()
            .map(|one| [one.variables[0], one.variables[1], one.variables[2]])
            .collect();
        places.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let c = 72.0_f64.sqrt();
        let expected = [[-c, -c, 27.0], [0.0; 3], [c, c, 27.0]];
        assert_eq!(places.len(), 3, "{places:?}");
        for (place, expected) in places.iter().flatten().zip(expected.iter().flatten()) {
            close(*place, *expected, 1e-12);
        }
    }
}

/// A bob on a rod has λ² = ∓g/l, however fast or slow that is: in units of 1, those of an atom, and of a year.
#[test]
fn a_rod_is_found_to_swing_however_fast() {
    let rod = |mass: f64, weight: f64, [x, y]: [f64; 2]| {
        let square = x * x + y * y;
        held(
            &format!(
                "title = \"t\"\n[coordinates]\nx = {{ initial = {x:e}, velocity = 0 }}\ny = {{ initial = {y:e} }}\n[parameters]\n\
                 m = {mass:e}\nw = {weight:e}\nl2 = {square:e}\n[lagrangian]\nL = \"1/2*m*(x'^2 + y'^2) - w*y\"\n\
                 [[constraints]]\nname = \"rod\"\nexpression = \"x^2 + y^2 - l2\"\n"
            ),
            &[],
        )
    };
    for (mass, weight, start) in [
        (1.0, 1e12, [0.6, -0.8]),
        (1.0, 1e16, [0.6, -0.8]),
        (1.0, 1e-18, [0.6, -0.8]),
        (1.67e-27, 1e-12, [3e-10, -4e-10]),
        (6e24, 3.5e22, [9e10, -1.2e11]),
    ] {
        let found = rod(mass, weight, start);
        let rate = (weight / mass / start[0].hypot(start[1])).sqrt();
        assert_eq!(kinds(&found), [MINIMUM, MAXIMUM], "{mass:e} {weight:e}: {found:?}");
        close(found[0].eigenvalues[0][1] / rate, 1.0, 1e-9);
        close(found[0].modes[0].frequency / rate, 1.0, 1e-9);
        close(found[1].eigenvalues[0][0] / rate, 1.0, 1e-9);
    }
}

/// What is slow beside something fast on which it does not act has its own eigenvalues and its mode.
#[test]
fn a_slow_oscillator_beside_a_fast_one_keeps_its_frequency() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0.5, velocity = 0 }\ny = { initial = 0.3, velocity = 0 }\n[lagrangian]\n\
                L = \"1/2*(x'^2 + y'^2) - 1e30*x^2/2 - y^2/2\"\n";
    let found = of(&file(text, &[]));
    assert_eq!(kinds(&found), [MINIMUM]);
    assert_eq!(found[0].eigenvalues[2..], [[0.0, 1.0], [0.0, -1.0]]);
    assert_eq!(frequencies(&found[0])[0], 1.0);
    assert_eq!(found[0].modes[0].in_phase, [0.0, 1.0]);
}

/// What grows slowly beside something fast, or by a small part of what turns: a pendulum upright on a stiff rod, λ = √g; a saddle of
/// 10⁻¹⁴; a summit that a magnetic force holds up, with friction (W. Thomson, P. G. Tait, Treatise on Natural Philosophy, §345:
/// unstable however small it is; λ = a friction of −d/2 (1 ∓ 3/√5)); a force across the displacement, λ ≈ c/2; a push along the velocity, λ = c/2.
#[test]
fn slow_growth_is_told_from_rounding() {
    let file_of = |law: &str, starts: &str| {
        let text = format!("title = \"t\"\n[coordinates]\n{starts}\n[lagrangian]\n{law}\n");
        of(&file(&text, &[]))
    };
    let at = |found: Vec<Equilibrium>, near: [f64; 2]| {
        let off = |one: &Equilibrium| {
            let pairs = one.variables.iter().zip(near);
            pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
        };
        found.into_iter().find(|one| off(one) < 0.1).expect("an equilibrium")
    };
    let judged = |law: &str, starts: &str, near: [f64; 2], stability: &str, growth: f64| {
        let one = at(file_of(law, starts), near);
        assert_eq!(one.stability(), stability, "{law}: {:?}", one.eigenvalues);
        let fastest = one.eigenvalues.iter().map(|z| z[0]).fold(f64::NEG_INFINITY, f64::max);
        assert!((fastest / growth - 1.0).abs() < 1e-3, "{law}: {fastest:e} is not {growth:e}");
    };
    let plane = "x = 0.01\ny = 0.02";
    let rod = "L = \"1/2*(r'^2 + r^2*a'^2) - 9.81*r*cos(a) - 1/2*1e14*(r - 1)^2\"";
    judged(rod, "a = 0.05\nr = 1.0", [0.0, 1.0], "unstable", 9.81_f64.sqrt());
    let saddle = "L = \"1/2*(x'^2 + y'^2) + 1e-14*x^2/2 - 1e4*y^2/2\"";
    judged(saddle, plane, [0.0; 2], "unstable", 1e-7);
    let root = 5.0_f64.sqrt();
    for size in [1e-6, 1e-9] {
        let held = "L = \"1/2*(x'^2 + y'^2) + 3/2*(x*y' - y*x') + (x^2 + y^2)/2\"";
        let held = format!("{held}\ndissipation = \"{size:e}*(x'^2 + y'^2)/2\"");
        judged(&held, plane, [0.0; 2], "unstable", size * (3.0 / root - 1.0) / 2.0);
        let across = "L = \"1/2*(x'^2 + y'^2) - (x^2 + y^2)/2\"";
        let across = format!("{across}\nforces = {{ x = \"{size:e}*y\", y = \"-{size:e}*x\" }}");
        judged(&across, plane, [0.0; 2], "unstable", size / 2.0);
        for (sign, stability) in [("-", "unstable"), ("", "stable")] {
            let growth = if sign == "-" { size / 2.0 } else { -size / 2.0 };
            let law = format!("L = \"1/2*x'^2 - x^2/2\"\ndissipation = \"{sign}{size:e}*x'^2/2\"");
            judged(&law, "x = 0.01", [0.0, 0.0], stability, growth);
        }
    }
}

/// Lagrange and Dirichlet: a strict minimum of V is stable, also where its second derivatives vanish; its form proves that.
#[test]
fn a_flat_minimum_of_even_powers_is_stable() {
    let one = |mechanics: &str| {
        let found = held(&format!("title = \"t\"\n{mechanics}"), &[]);
        assert_eq!(found.len(), 1, "{mechanics}: {found:?}");
        (found[0].kind, found[0].stable)
    };
    let lagrangian = |law: &str| {
        one(&format!(
            "[coordinates]\nx = {{ initial = 0.6 }}\ny = {{ initial = 0.3 }}\n[parameters]\nk = 2\n[lagrangian]\n{law}"
        ))
    };
    let flat = |stable| (Some(EquilibriumKind::Degenerate), stable);
    for (law, stable) in [
        ("L = \"1/2*(x'^2 + y'^2) - k*(x - y)^4 - (x + y - 1)^6\"", Some(true)),
        ("L = \"1/2*(1 + x^2)*x'^2 + x'*y' + y'^2 + x*y' - k*x^4 - y^2 + 3\"", Some(true)),
        ("L = \"1/2*(x'^2 + y'^2) - x^4 - y^4\"\ndissipation = \"k*x'^2\"", Some(true)),
        // what drives it adds energy, and a sum that does not determine a place has no strict minimum
        ("L = \"1/2*(x'^2 + y'^2) - x^4 - y^4\"\nforces = { x = \"k*x'^3\" }", None),
        ("L = \"1/2*(x'^2 - y'^2) - x^4 - y^4\"", None),
    ] {
        assert_eq!(lagrangian(law), flat(stable), "{law}");
    }
    let hamiltonian = |law: &str| {
        one(&format!("[coordinates]\nx = {{ initial = 0.6 }}\n[hamiltonian]\nH = \"{law}\""))
    };
    assert_eq!(hamiltonian("p_x^2/2 + x^4"), flat(Some(true)));
    assert_eq!(hamiltonian("p_x^2/2 + x^4 + x^3*p_x"), flat(None));
}
