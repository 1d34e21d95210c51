//! Derivatives of motions that constraints hold, against independent coordinates and closed forms.

use nalgebra::{DMatrix, DVector};
use phaselab::dynamics::{
    Along, Chaos, DynamicsError, Fixed, FlowMap, Orbit, PhaseSpace, family, flow_map, gali,
    lyapunov, periodic_orbit,
};

use super::{Case, case_in, file, method, taylor};
use crate::fixtures::lowered;

fn held(text: &str) -> Case {
    case_in(&lowered(text), &[], &[], PhaseSpace::on_constraints)
}

fn map(case: &Case, until: f64) -> FlowMap {
    let found = flow_map(&case.space, taylor(), &case.start, until, &mut |_| {}).unwrap();
    assert!(found.error.is_none(), "{:?}", found.error);
    found
}

fn near(found: &DMatrix<f64>, wanted: &DMatrix<f64>, within: f64) {
    let off = (found - wanted).amax() / wanted.amax();
    assert!(off < within, "{off:e}: {found} {wanted}");
}

const ROD: &str = "title = \"t\"\n[coordinates]\nx = { initial = \"sin(0.7)\", velocity = \"1.3*cos(0.7)\" }\n\
     y = { initial = \"-cos(0.7)\", velocity = \"1.3*sin(0.7)\" }\n[parameters]\ng = 9.81\n\
     [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - g*y\"\n[[constraints]]\nname = \"rod\"\nexpression = \"x^2 + y^2 - 1\"\n";

/// The derivative of (x, y, p_x, p_y) by (θ, p_θ) on a circle of radius 1.
fn embedding(theta: f64, p: f64) -> DMatrix<f64> {
    let (s, c) = theta.sin_cos();
    DMatrix::from_row_slice(4, 2, &[c, 0.0, s, 0.0, -p * s, c, p * c, s])
}

#[test]
fn the_displacements_allowed_on_a_circle_are_along_it() {
    let case = held(ROD);
    let (matrix, dimension) = case.space.allowed_displacements(&case.start).unwrap();
    assert_eq!(dimension, 2);
    let along = embedding(0.7, 1.3);
    near(&(&matrix * &along), &along, 1e-15);
    near(&(&matrix * &matrix), &matrix, 1e-15);
    // M is the unit matrix: coordinates are moved at right angles to the circle
    let normal = DVector::from_vec(vec![0.7_f64.sin(), -0.7_f64.cos()]);
    let wanted = DMatrix::identity(2, 2) - &normal * normal.transpose();
    near(&matrix.view((0, 0), (2, 2)).into_owned(), &wanted, 1e-15);
    // and a momentum across it is taken up by the rod
    let across = &matrix * DVector::from_vec(vec![0.0, 0.0, normal[0], normal[1]]);
    assert!(across.amax() < 1e-15, "{across}");
}

#[test]
fn a_pendulum_on_a_rod_has_the_tangent_map_of_its_angle() {
    let rod = held(ROD);
    let angle = "title = \"t\"\n[coordinates]\na = { initial = 0.7, velocity = 1.3 }\n[parameters]\ng = 9.81\n\
                 [lagrangian]\nL = \"1/2*a'^2 + g*cos(a)\"\n";
    let angle = file(angle, &[]);
    let (found, wanted) = (map(&rod, 3.0), map(&angle, 3.0));
    let end = angle.space.variables(&wanted.state);
    near(
        &(&found.matrix * embedding(0.7, 1.3)),
        &(embedding(end[0], end[1]) * &wanted.matrix),
        1e-13,
    );
    assert_eq!(found.dimension, 2);
    assert!((found.determinant.unwrap() - 1.0).abs() < 1e-13);
    assert!(found.symplectic_residual.unwrap() < 1e-13);
}

/// Entries of the form have units: in those of atoms and of galaxies they are 1e13 and 1e22, and so is their rounding.
#[test]
fn the_residual_of_the_form_is_its_rounding_in_any_units() {
    for [m, l, w] in [[1.0, 1.0, 1.0], [1e-30, 5e-11, 1e17], [1e40, 1e19, 1e-17]] {
        let text = format!(
            "title = \"t\"\n[coordinates]\nx = {{ initial = \"l*sin(0.7)\", velocity = \"1.3*w*l*cos(0.7)\" }}\n\
             y = {{ initial = \"-l*cos(0.7)\", velocity = \"1.3*w*l*sin(0.7)\" }}\n\
             [parameters]\nm = {m:e}\nl = {l:e}\nw = {w:e}\n\
             [lagrangian]\nL = \"1/2*m*(x'^2 + y'^2) - m*w^2*l*y\"\n\
             [[constraints]]\nname = \"rod\"\nexpression = \"x^2 + y^2 - l^2\"\n"
        );
        let found = map(&held(&text), 3.0 / w);
        let (residual, rounding) =
            (found.symplectic_residual.unwrap(), found.symplectic_rounding.unwrap());
        assert!(residual < 10.0 * rounding, "{m:e}: {residual:e} {rounding:e}");
        assert!((found.determinant.unwrap() - 1.0).abs() < 1e-13, "{m:e}");
    }
}

#[test]
fn two_rods_have_the_tangent_map_of_two_angles() {
    let rods = "title = \"t\"\n[coordinates]\nx1 = { initial = \"sin(a)\", velocity = 0 }\n\
                y1 = { initial = \"-cos(a)\", velocity = 0 }\nx2 = { initial = \"sin(a) + sin(b)\", velocity = 0 }\n\
                y2 = { initial = \"-cos(a) - cos(b)\", velocity = 0 }\n[parameters]\na = 1.1\nb = 0.4\ng = 9.81\n\
                [lagrangian]\nL = \"1/2*(x1'^2 + y1'^2 + x2'^2 + y2'^2) - g*(y1 + y2)\"\n\
                [[constraints]]\nname = \"first\"\nexpression = \"x1^2 + y1^2 - 1\"\n\
                [[constraints]]\nname = \"second\"\nexpression = \"(x2 - x1)^2 + (y2 - y1)^2 - 1\"\n";
    let angles = "title = \"t\"\n[coordinates]\na = { initial = 1.1 }\nb = { initial = 0.4 }\n[parameters]\ng = 9.81\n\
                  [lagrangian]\nL = \"a'^2 + 1/2*b'^2 + a'*b'*cos(a - b) + 2*g*cos(a) + g*cos(b)\"\n";
    let (rods, angles) = (held(rods), file(angles, &[]));
    // (x₁, y₁, x₂, y₂) and their momenta, which are their velocities here, by the angles and their velocities
    let embedding = |q: [f64; 2], v: [f64; 2]| {
        let mut all = DMatrix::zeros(8, 4);
        for (k, (q, v)) in q.into_iter().zip(v).enumerate() {
            let (s, c) = q.sin_cos();
            for place in k..2 {
                for (i, (first, second)) in [(c, -s * v), (s, c * v)].into_iter().enumerate() {
                    all[(2 * place + i, k)] = first;
                    all[(4 + 2 * place + i, k)] = second;
                    all[(4 + 2 * place + i, 2 + k)] = first;
                }
            }
        }
        all
    };
    // (δq, δq̇) → (δq, δp) for p_a = 2a' + b' cos(a − b), p_b = b' + a' cos(a − b)
    let momenta = |q: [f64; 2], v: [f64; 2]| {
        let (s, c) = (q[0] - q[1]).sin_cos();
        DMatrix::from_row_slice(
            4,
            4,
            &[
                1.0,
                0.0,
                0.0,
                0.0, //
                0.0,
                1.0,
                0.0,
                0.0, //
                -v[1] * s,
                v[1] * s,
                2.0,
                c, //
                -v[0] * s,
                v[0] * s,
                c,
                1.0,
            ],
        )
    };
    let (found, wanted) = (map(&rods, 2.0), map(&angles, 2.0));
    let end = angles.space.variables(&wanted.state);
    let q = [end[0], end[1]];
    let c = (q[0] - q[1]).cos();
    // p = M v, M = [[2, c], [c, 1]]
    let v = [(end[2] - c * end[3]) / (2.0 - c * c), (2.0 * end[3] - c * end[2]) / (2.0 - c * c)];
    let start = ([1.1, 0.4], [0.0, 0.0]);
    let back = momenta(q, v).try_inverse().unwrap();
    near(
        &(&found.matrix * embedding(start.0, start.1)),
        &(embedding(q, v) * back * &wanted.matrix * momenta(start.0, start.1)),
        1e-12,
    );
    assert_eq!((found.dimension, wanted.dimension), (4, 4));
    assert!((found.determinant.unwrap() - 1.0).abs() < 1e-12);
    assert!(found.symplectic_residual.unwrap() < 1e-12);
}

#[test]
fn a_wire_that_is_turned_has_the_tangent_map_of_its_closed_form() {
    // r'' = ω² r on the wire, whose direction turns: r = r₀ cosh ωt + (r₀'/ω) sinh ωt
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0.8, velocity = 0.3 }\n\
                y = { initial = 0, velocity = \"w*0.8\" }\n[parameters]\nw = 1.5\n\
                [lagrangian]\nL = \"1/2*(x'^2 + y'^2)\"\n\
                [[constraints]]\nname = \"wire\"\nexpression = \"x*sin(w*t) - y*cos(w*t)\"\n";
    let (w, until) = (1.5_f64, 1.2);
    let found = map(&held(text), until);
    // (x, y, p_x, p_y) by (r, r') at a time
    let embedding = |time: f64| {
        let (s, c) = (w * time).sin_cos();
        DMatrix::from_row_slice(4, 2, &[c, 0.0, s, 0.0, -w * s, c, w * c, s])
    };
    let (sinh, cosh) = ((w * until).sinh(), (w * until).cosh());
    let along = DMatrix::from_row_slice(2, 2, &[cosh, sinh / w, w * sinh, cosh]);
    near(&(&found.matrix * embedding(0.0)), &(embedding(until) * along), 1e-14);
    assert!((found.determinant.unwrap() - 1.0).abs() < 1e-14);
}

#[test]
fn a_blade_has_the_tangent_map_of_its_closed_form() {
    // along circles of radius v/ω: not holonomic, so no form is preserved and no volume is claimed
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0.2 }\ny = { initial = -0.1 }\n\
                f = { initial = 0.6, velocity = 0.9 }\n[parameters]\nm = 2.0\nI = 0.7\nv = 1.4\n\
                [lagrangian]\nL = \"1/2*m*(x'^2 + y'^2) + 1/2*I*f'^2\"\n\
                [[constraints]]\nname = \"blade\"\nexpression = \"x'*sin(f) - y'*cos(f)\"\n";
    let text =
        text.replace("x = { initial = 0.2 }", "x = { initial = 0.2, velocity = \"v*cos(0.6)\" }");
    let case = held(&text);
    let (m, inertia, v, w, until) = (2.0, 0.7, 1.4, 0.9, 2.5);
    // (x, y, φ, p_x, p_y, p_φ) by (x₀, y₀, φ₀, v, ω) at a time
    let embedding = |time: f64| {
        let (f0, f) = (0.6, 0.6 + w * time);
        let (s0, c0, s, c) = (f64::sin(f0), f64::cos(f0), f64::sin(f), f64::cos(f));
        DMatrix::from_row_slice(
            6,
            5,
            &[
                1.0,
                0.0,
                v / w * (c - c0),
                (s - s0) / w,
                v / w * (time * c - (s - s0) / w),
                0.0,
                1.0,
                v / w * (s - s0),
                -(c - c0) / w,
                v / w * (time * s + (c - c0) / w),
                0.0,
                0.0,
                1.0,
                0.0,
                time,
                0.0,
                0.0,
                -m * v * s,
                m * c,
                -m * v * s * time,
                0.0,
                0.0,
                m * v * c,
                m * s,
                m * v * c * time,
                0.0,
                0.0,
                0.0,
                0.0,
                inertia,
            ],
        )
    };
    let found = map(&case, until);
    near(&(&found.matrix * embedding(0.0)), &embedding(until), 1e-14);
    assert_eq!(found.dimension, 5);
    assert_eq!((found.determinant, found.symplectic_residual), (None, None));
}

#[test]
fn exponents_under_constraints_are_those_of_independent_coordinates() {
    // a pendulum upright on its rod: δ'' = g δ
    let upright = ROD
        .replace("\"sin(0.7)\", velocity = \"1.3*cos(0.7)\"", "0.0, velocity = 0")
        .replace("\"-cos(0.7)\", velocity = \"1.3*sin(0.7)\"", "1.0, velocity = 0");
    let case = held(&upright);
    let found = lyapunov(&case.space, taylor(), &case.start, 20.0, &mut |_| {}).unwrap();
    assert_eq!(found.exponents.len(), 2);
    let wanted = 9.81_f64.sqrt();
    for (exponent, wanted) in found.exponents.iter().zip([wanted, -wanted]) {
        assert!((exponent - wanted).abs() < 1e-2, "{:?}", found.exponents);
    }
    // and a particle on a sphere with no force goes round on great circles: no exponent but 0
    let sphere = "title = \"t\"\n[coordinates]\nx = { initial = 1, velocity = 0 }\ny = { initial = 0, velocity = 1 }\n\
                  z = { initial = 0, velocity = 0.5 }\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2 + z'^2)\"\n\
                  [[constraints]]\nname = \"sphere\"\nexpression = \"x^2 + y^2 + z^2 - 1\"\n";
    let case = held(sphere);
    let found = lyapunov(&case.space, taylor(), &case.start, 200.0, &mut |_| {}).unwrap();
    assert_eq!(found.exponents.len(), 4);
    assert_eq!(found.verdict, Chaos::Regular, "{}", found.reason);
    assert!(found.exponents[0].abs() < 1e-2, "{:?}", found.exponents);
    let found = gali(&case.space, taylor(), (&case.start, 400.0), 4, &mut |_| {}).unwrap();
    // of a periodic orbit with two degrees of freedom GALI₂, ₃, ₄ fall like t⁻¹, t⁻², t⁻⁴ (T. Manos, Ch. Skokos,
    // Ch. Antonopoulos, Int. J. Bifurcation Chaos 22 (2012) 1250218)
    for (k, power) in [(2, -1.0), (3, -2.0), (4, -4.0)] {
        let all = found.of(k);
        let early = all.iter().find(|(time, _)| *time >= 40.0).unwrap();
        let last = all.last().unwrap();
        let slope = (last.1 - early.1) / (last.0 / early.0).ln();
        assert!((slope - power).abs() < 0.1, "GALI{k}: {slope}");
    }
    let more = gali(&case.space, taylor(), (&case.start, 50.0), 5, &mut |_| {});
    assert!(more.is_err(), "four displacements are allowed, not five");
}

#[test]
fn fixed_steps_and_impulses_under_constraints_are_refused() {
    let case = held(ROD);
    let found = flow_map(&case.space, method("rk4", Some(0.01)), &case.start, 1.0, &mut |_| {});
    let Err(DynamicsError::Unsuited(why)) = found else { panic!("rk4 is let pass") };
    assert!(why.contains("projection"), "{why}");
    let found = flow_map(&case.space, method("dop853", None), &case.start, 1.0, &mut |_| {});
    near(&found.unwrap().matrix, &map(&case, 1.0).matrix, 1e-10);
    let pushed =
        format!("{ROD}[[impulses]]\nname = \"kick\"\nat = [0.5]\nchange = {{ p_x = \"1\" }}\n");
    let loaded = lowered(&pushed);
    let parameters = loaded.model.parameter_values();
    let (model, equations) = (&loaded.model, &loaded.equations);
    let space = PhaseSpace::on_constraints((model, equations, &loaded.system), &parameters);
    assert!(matches!(space, Err(DynamicsError::Unsuited(_))));
}

fn orbit(case: &Case) -> Orbit {
    let energy = case.space.system().energy(&case.start, case.space.parameters()).unwrap();
    periodic_orbit(&case.space, taylor(), &case.start, None, Fixed::Energy(energy)).unwrap()
}

/// Released at 2 rad with g = l = 1 the period is 4 K(sin² 1) and ∮ p dq = 16 (E(k) − cos² 1 K(k)).
#[test]
fn a_pendulum_on_a_rod_closes_after_its_period() {
    let rod = held(
        "title = \"t\"\n[coordinates]\nx = { initial = \"sin(2)\", velocity = 0 }\ny = { initial = \"-cos(2)\" }\n\
         [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - y\"\n[[constraints]]\nname = \"rod\"\nexpression = \"x^2 + y^2 - 1\"\n",
    );
    let found = orbit(&rod);
    assert!((found.period - 8.349752926918493).abs() < 1e-13, "{}", found.period);
    assert!(found.closure < 1e-14 && found.stable, "{}", found.closure);
    assert!(found.multipliers.is_empty(), "{:?}", found.multipliers);
    assert!((found.action.unwrap() - ACTION).abs() < 1e-12, "{:?}", found.action);
}

const ACTION: f64 = 10.039416280433402;

/// Two bobs on two rods, in x and y, near the slow mode of the double pendulum at an energy where the orbit is far from that of
/// small oscillations: period, ∮ p dq and multipliers are those of the angles.
#[test]
fn orbits_of_a_double_pendulum_by_constraints_are_those_of_its_angles() {
    let rods = held(
        "title = \"t\"\n[coordinates]\nx = { initial = \"sin(0.5)\", velocity = 0 }\ny = { initial = \"-cos(0.5)\" }\n\
         u = { initial = \"sin(0.5) + sin(0.7)\", velocity = 0 }\nv = { initial = \"-cos(0.5) - cos(0.7)\" }\n\
         [lagrangian]\nL = \"1/2*(x'^2 + y'^2 + u'^2 + v'^2) - y - v\"\n\
         [[constraints]]\nname = \"upper\"\nexpression = \"x^2 + y^2 - 1\"\n\
         [[constraints]]\nname = \"lower\"\nexpression = \"(u - x)^2 + (v - y)^2 - 1\"\n",
    );
    let angles = file(
        "title = \"t\"\n[coordinates]\na = { initial = 0.5, velocity = 0 }\nb = { initial = 0.7, velocity = 0 }\n\
         [lagrangian]\nL = \"a'^2 + 1/2*b'^2 + a'*b'*cos(a - b) + 2*cos(a) + cos(b)\"\n",
        &[],
    );
    let (found, wanted) = (orbit(&rods), orbit(&angles));
    assert!((found.period - wanted.period).abs() < 1e-10, "{} {}", found.period, wanted.period);
    assert!((found.action.unwrap() - wanted.action.unwrap()).abs() < 1e-10);
    assert!((found.energy - wanted.energy).abs() < 1e-12);
    assert_eq!((found.multipliers.len(), found.stable), (2, wanted.stable));
    for (one, other) in found.multipliers.iter().zip(&wanted.multipliers) {
        assert!((one[0] - other[0]).abs() + (one[1] - other[1]).abs() < 1e-9, "{one:?} {other:?}");
    }
    let upper = found.state.values[0].powi(2) + found.state.values[1].powi(2);
    assert!((upper - 1.0).abs() < 1e-15, "{upper}");
}

/// The same system with the length of its lower rod as a parameter, on which a constraint depends: families in the energy and in
/// that length have the members and the bifurcations of those in its angles.
#[test]
fn families_under_constraints_are_those_of_independent_coordinates() {
    let rods = held(
        "title = \"t\"\n[coordinates]\nx = { initial = \"sin(0.5)\", velocity = 0 }\ny = { initial = \"-cos(0.5)\" }\n\
         u = { initial = \"sin(0.5) + l*sin(0.7)\", velocity = 0 }\nv = { initial = \"-cos(0.5) - l*cos(0.7)\" }\n\
         [parameters]\nl = 1.0\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2 + u'^2 + v'^2) - y - v\"\n\
         [[constraints]]\nname = \"upper\"\nexpression = \"x^2 + y^2 - 1\"\n\
         [[constraints]]\nname = \"lower\"\nexpression = \"(u - x)^2 + (v - y)^2 - l^2\"\n",
    );
    let angles = file(
        "title = \"t\"\n[coordinates]\na = { initial = 0.5, velocity = 0 }\nb = { initial = 0.7, velocity = 0 }\n\
         [parameters]\nl = 1.0\n[lagrangian]\n\
         L = \"a'^2 + 1/2*l^2*b'^2 + l*a'*b'*cos(a - b) + 2*cos(a) + l*cos(b)\"\n",
        &[],
    );
    let walk = |case: &Case, along: Along, values: &[f64]| {
        let first = orbit(case);
        let found = family(
            &case.space,
            taylor(),
            &first,
            (along, Fixed::Energy(first.energy)),
            (values, &|_| ()),
        );
        let found = found.unwrap();
        assert!(found.ended.is_empty(), "{:?}", found.ended);
        found.members
    };
    for (along, values) in [(Along::Energy, [-2.7, -2.3]), (Along::Parameter(0), [0.9, 1.1])] {
        let (found, wanted) = (walk(&rods, along, &values), walk(&angles, along, &values));
        assert_eq!(found.len(), wanted.len());
        assert_eq!(wanted.iter().filter(|member| member.bifurcation.is_none()).count(), 2);
        for (one, other) in found.iter().zip(&wanted) {
            assert_eq!(one.bifurcation, other.bifurcation);
            assert!((one.value - other.value).abs() < 1e-8, "{} {}", one.value, other.value);
            let (one, other) = (&one.orbit, &other.orbit);
            assert!((one.period - other.period).abs() < 1e-7, "{} {}", one.period, other.period);
            assert!((one.energy - other.energy).abs() < 1e-9);
            let (a, b) = (one.transverse.trace(), other.transverse.trace());
            assert!((a - b).abs() < 1e-6 * (1.0 + b.abs()), "{a} {b}");
        }
    }
}
