//! Families of periodic orbits.

use phaselab::dynamics::{
    Along, Bifurcation, Family, Fixed, Member, OrbitStability, drive_period, driven_family,
    driven_orbit, family, periodic_orbit,
};

use super::{Case, file, taylor};
use crate::fixtures::lowered;

fn of(case: &Case, period: Option<f64>, (along, fixed): (Along, Fixed), values: &[f64]) -> Family {
    let orbit = periodic_orbit(&case.space, taylor(), &case.start, period, fixed).unwrap();
    family(&case.space, taylor(), &orbit, (along, fixed), (values, &|_| ())).unwrap()
}

fn asked(family: &Family) -> Vec<&Member> {
    family.members.iter().filter(|member| member.bifurcation.is_none()).collect()
}

#[test]
fn the_swings_of_a_pendulum_have_their_closed_form_periods() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0.6, momentum = 0 }\n\
                [hamiltonian]\nH = \"1/2*p_x^2 + 1 - cos(x)\"\n";
    let case = file(text, &[]);
    // of amplitudes of 60° and 120°, in 2π: E = 1 − cos θ₀
    let (small, large) = (1.073182007149364, 1.37288050061835);
    let tau = std::f64::consts::TAU;
    let found = of(&case, None, (Along::Energy, Fixed::Energy(0.2)), &[0.5, 1.5]);
    let [one, two] = asked(&found)[..] else { panic!("{found:?}") };
    assert!((one.orbit.period - small * tau).abs() < 1e-10 && one.value == 0.5);
    assert!((two.orbit.period - large * tau).abs() < 1e-10 && two.value == 1.5);
    assert!(found.ended.is_empty());
    // and by their period
    let values = [small * tau, large * tau];
    let found = of(&case, None, (Along::Period, Fixed::Energy(0.2)), &values);
    let energies: Vec<f64> = asked(&found).iter().map(|member| member.orbit.energy).collect();
    assert!((energies[0] - 0.5).abs() < 1e-9 && (energies[1] - 1.5).abs() < 1e-9, "{energies:?}");
}

/// Swings shrink to rest: there their family ends with the period of small oscillations, and each of them is there once. Nothing
/// turns back.
#[test]
fn a_family_ends_at_an_equilibrium() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0.6, momentum = 0 }\n\
                [hamiltonian]\nH = \"1/2*p_x^2 + 3 - 4*cos(x)\"\n";
    let case = file(text, &[]);
    // ω = 2, and E = −1 at rest
    let values = [-1.5, -0.9, -0.5, 0.5];
    let energy = 3.0 - 4.0 * 0.6_f64.cos();
    let found = of(&case, None, (Along::Energy, Fixed::Energy(energy)), &values);
    let seen: Vec<f64> = found.members.iter().map(|member| member.value).collect();
    assert_eq!(seen, [-0.9, -0.5, 0.5], "{:?}", found.ended);
    let said = "the family ends at -1, at an equilibrium, where its period is 3.14159";
    assert_eq!(found.ended, [said]);
}

/// The swings of a pendulum end at its separatrix from wherever on one of them they are followed: rotations, of which several turns
/// last as long, are another family, and nothing turns back.
#[test]
fn a_family_does_not_cross_a_separatrix() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0.6, momentum = 0, period = \"2*pi\" }\n\
                [hamiltonian]\nH = \"1/2*p_x^2 - 9.81*cos(x)\"\n";
    for (x, p) in [(-0.35_f64, 5.157062493233964), (-1.31, 3.6364568705466476), (1.9, 0.0)] {
        let case = file(text, &[x, p]);
        let energy = 0.5 * p * p - 9.81 * x.cos();
        let along = (Along::Energy, Fixed::Energy(energy));
        let found = of(&case, None, along, &[5.0, 9.0, 11.0, 13.0]);
        let seen: Vec<(f64, Option<Bifurcation>)> =
            found.members.iter().map(|member| (member.value, member.bifurcation)).collect();
        assert_eq!(seen, [(5.0, None), (9.0, None)], "{x}: {:?}", found.ended);
        let [why] = &found.ended[..] else { panic!("{:?}", found.ended) };
        assert!(why.contains("its period grows"), "{why}");
    }
}

/// Kepler's force and one of 1/r³: with p_φ = 1 the angle goes round twice in a period of r, T = 2π/(−2E)^(3/2), on all ellipses of
/// E > −2. There they have shrunk to a circle, which is one of a family of circles.
#[test]
fn rosettes_shrink_to_a_circle_of_another_family() {
    let text = "title = \"t\"\n[coordinates]\nr = { initial = 0.5, momentum = 0 }\n\
                f = { initial = 0, momentum = 1, period = \"2*pi\" }\n\
                [hamiltonian]\nH = \"1/2*p_r^2 + (p_f^2 - 3/4)/(2*r^2) - 1/r\"\n";
    let case = file(text, &[]);
    let period = |energy: f64| std::f64::consts::TAU / (-2.0 * energy).powf(1.5);
    for values in [[-2.2, -1.8, -1.2], [-2.0, -1.6, -0.2]] {
        let found = of(&case, None, (Along::Energy, Fixed::Energy(-1.5)), &values);
        let seen: Vec<f64> = found.members.iter().map(|member| member.value).collect();
        assert_eq!(seen, values[1..], "{:?}", found.ended);
        assert!(!found.isolated);
        for member in &found.members {
            let (found, wanted) = (member.orbit.period, period(member.value));
            assert!((found - wanted).abs() < 1e-9 * wanted, "{found} is not {wanted}");
        }
        let said = "the family ends near -2, at an orbit of another, from which it branches off, where its period is 0.7854";
        assert_eq!(found.ended, [said]);
    }
}

/// In the isochrone potential the angle goes round twice in three periods of r, T = 6π/(−2E)^(3/2), on all rosettes with
/// p_φ = 1/√2: they shrink to a circle at E = −1/4, which is no fold, however near to it the way past leads.
#[test]
fn rosettes_that_nearly_meet_their_circle_end_there() {
    let text = "title = \"t\"\n[coordinates]\nr = { initial = 2.0816659994661326, momentum = 0 }\n\
                f = { initial = 0, momentum = 0.7071067811865476, period = \"2*pi\" }\n\
                [hamiltonian]\nH = \"1/2*p_r^2 + p_f^2/(2*r^2) - 1/(1 + sqrt(1 + r^2))\"\n";
    let case = file(text, &[]);
    let (r, p) = (2.081_665_999_466_132_6_f64, 0.5_f64.sqrt());
    let energy = p * p / (2.0 * r * r) - 1.0 / (1.0 + (1.0 + r * r).sqrt());
    let period = |energy: f64| 3.0 * std::f64::consts::TAU / (-2.0 * energy).powf(1.5);
    let first = Some(period(energy));
    let along = (Along::Energy, Fixed::Energy(energy));
    let found = of(&case, first, along, &[-0.25, -0.247]);
    let seen: Vec<(f64, Option<Bifurcation>)> =
        found.members.iter().map(|member| (member.value, member.bifurcation)).collect();
    assert_eq!(seen, [(-0.247, None)], "{:?}", found.ended);
    assert!((found.members[0].orbit.period - period(-0.247)).abs() < 1e-8);
    let said = "the family ends near -0.25, at an orbit of another, from which it branches off, where its period is 53.31";
    assert_eq!(found.ended, [said]);
}

/// In its angles a planar swing of the spherical pendulum jumps at the bottom: nothing is said to turn back there.
#[test]
fn beside_a_singularity_of_its_coordinates_an_orbit_has_no_known_family() {
    let text = "title = \"t\"\n[coordinates]\nq = { initial = 1, momentum = 0 }\n\
                f = { initial = 0, momentum = 1e-9, period = \"2*pi\" }\n\
                [hamiltonian]\nH = \"1/2*p_q^2 + p_f^2/(2*sin(q)^2) - cos(q)\"\n";
    let case = file(text, &[]);
    let fixed = Fixed::Energy(-1.0_f64.cos());
    let orbit = periodic_orbit(&case.space, taylor(), &case.start, None, fixed).unwrap();
    let found =
        family(&case.space, taylor(), &orbit, (Along::Energy, fixed), (&[-0.6, -0.4], &|_| ()));
    let why = found.unwrap_err().to_string();
    assert!(why.contains("passes close to a singularity"), "{why}");
}

/// All of Kepler's ellipses close: their multipliers are 1, and rounding changes no sign. So do, but for less and less, the
/// orbits of Hénon and Heiles's family below its period doubling (tr M⊥ − 2 = −1.9e-4 at E = 0.09, −8e-11 at 0.07).
#[test]
fn multipliers_that_are_one_within_rounding_branch_nowhere() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 1, velocity = 0 }\ny = { initial = 0, velocity = 0.9 }\n\
                [lagrangian]\nL = \"1/2*(x'^2 + y'^2) + 1/sqrt(x^2 + y^2)\"\n";
    let case = file(text, &[]);
    let found = of(&case, None, (Along::Energy, Fixed::Energy(-0.595)), &[-0.6, -0.57, -0.55]);
    assert!(!asked(&found).is_empty(), "{found:?}");
    assert!(found.members.iter().all(|member| member.bifurcation.is_none()), "{found:?}");
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0, momentum = 0.45975654576795759 }\n\
                y = { initial = -0.18540508709080214, momentum = 0 }\n\
                [hamiltonian]\nH = \"1/2*(p_x^2 + p_y^2 + x^2 + y^2) + x^2*y - y^3/3\"\n";
    let case = file(text, &[]);
    let found = of(&case, None, (Along::Energy, Fixed::Energy(0.125)), &[0.05, 0.1, 0.125]);
    let branching = |member: &&Member| {
        matches!(member.bifurcation, Some(Bifurcation::Branching | Bifurcation::Fold))
    };
    let unknown = found.members.iter().filter(branching).count();
    assert!(unknown <= 1, "{found:?}");
}

#[test]
fn orbits_bifurcate_at_the_characteristic_values_of_mathieu() {
    // across the orbit x = ½ cos t, y = 0: ÿ + (δ + ½ cos t) y = 0, which is Mathieu's equation with
    // a = 4 δ and |q| = 1; a₀, b₁, a₁, b₂, a₂ of M. Abramowitz, I. A. Stegun, table 20.1
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0.5, momentum = 0 }\n\
                y = { initial = 0, momentum = 0 }\n[parameters]\ndelta = 0.2\n\
                [hamiltonian]\nH = \"1/2*(p_x^2 + p_y^2) + 1/2*x^2 + 1/2*delta*y^2 + 1/2*x*y^2\"\n";
    let case = file(text, &[]);
    let fixed = Fixed::Energy(0.125);
    let found = of(&case, Some(6.3), (Along::Parameter(0), fixed), &[-0.2, 0.3, 1.2]);
    let bifurcations: Vec<(Bifurcation, f64)> = found
        .members
        .iter()
        .filter_map(|member| Some((member.bifurcation?, 4.0 * member.value)))
        .collect();
    let expected = [
        (Bifurcation::Branching, -0.45513860),
        (Bifurcation::PeriodDoubling, -0.11024882),
        (Bifurcation::PeriodDoubling, 1.85910807),
        (Bifurcation::Branching, 3.91702477),
        (Bifurcation::Branching, 4.37130098),
    ];
    assert_eq!(bifurcations.len(), expected.len(), "{bifurcations:?} {:?}", found.ended);
    // where two multipliers meet at 1 or −1, to whichever side of it they were found
    for member in found.members.iter().filter(|member| member.bifurcation.is_some()) {
        assert_eq!((member.stability(), member.is_stable()), (OrbitStability::Parabolic, None));
    }
    for ((kind, value), (wanted, at)) in bifurcations.iter().zip(expected) {
        assert_eq!(*kind, wanted);
        assert!((value - at).abs() < 2e-7, "{value} is not {at}");
    }
    // below a₀ and between b₁ and a₁ it is unstable, above a₂ stable
    for member in asked(&found) {
        assert!((member.orbit.energy - 0.125).abs() < 1e-10);
        assert_eq!(member.orbit.stable, member.value == 1.2, "{}", member.value);
    }
}

#[test]
fn a_family_turns_back_at_its_fold() {
    // r' = r (μ + r² − r⁴), φ' = −1: circles r² = (1 ± √(1 + 4μ))/2, which meet at μ = −1/4
    let text = "title = \"t\"\n[variables]\nx = { initial = 0.95 }\ny = { initial = 0 }\n\
                [parameters]\nmu = { value = -0.1, min = -1, max = 1 }\n\
                [definitions]\ng = \"mu + (x^2 + y^2) - (x^2 + y^2)^2\"\n\
                [poisson]\nH = \"1/2*(x^2 + y^2)\"\nbrackets = [[\"x\", \"y\", \"1\"]]\n\
                forces = { x = \"x*g\", y = \"y*g\" }\n";
    let case = file(text, &[]);
    let values = [-0.3, -0.2, -0.15, -0.08];
    let found = of(&case, Some(6.3), (Along::Parameter(0), Fixed::Nothing), &values);
    let folds: Vec<&Member> = found.members.iter().filter(|m| m.bifurcation.is_some()).collect();
    let [fold] = folds[..] else { panic!("{found:?}") };
    assert_eq!(fold.bifurcation, Some(Bifurcation::Fold));
    assert!((fold.value + 0.25).abs() < 1e-9, "{}", fold.value);
    let square = |member: &Member| member.orbit.state.values.iter().map(|x| x * x).sum::<f64>();
    assert!((square(fold) - 0.5).abs() < 1e-4);
    let mut both = asked(&found);
    both.sort_by(|a, b| square(a).total_cmp(&square(b)));
    assert_eq!(both.len(), 6);
    for (k, member) in both.iter().enumerate() {
        let root = (1.0 + 4.0 * member.value).sqrt();
        let sign = if k < 3 { -1.0 } else { 1.0 };
        assert!((square(member) - 0.5 * (1.0 + sign * root)).abs() < 1e-9);
        assert!((member.orbit.period - std::f64::consts::TAU).abs() < 1e-10);
        assert_eq!(member.orbit.stable, k >= 3);
    }
}

/// A driven oscillator with friction, of which the period of the drive is the parameter.
fn driven(cubic: &str, start: &[f64]) -> (phaselab::app::Loaded, Case) {
    let text = format!(
        "title = \"t\"\n[coordinates]\nx = {{ initial = 0.3, momentum = 0 }}\n[parameters]\nw = 1.0\n[hamiltonian]\n\
         H = \"1/2*p_x^2 + 1/2*x^2 {cubic} - 0.3*x*cos(w*t)\"\nforces = {{ x = \"-0.1*p_x\" }}\n"
    );
    let loaded = lowered(&text);
    let case = super::case(&loaded, &[], start);
    (loaded, case)
}

fn along_the_drive(loaded: &phaselab::app::Loaded, case: &Case, values: &[f64]) -> Family {
    let period = case.space.drive().unwrap();
    let orbit = driven_orbit(&case.space, taylor(), &case.start, period).unwrap();
    let drive = |parameters: &[f64]| {
        drive_period(&loaded.model, &loaded.equations, case.space.system(), parameters)
    };
    driven_family(&case.space, taylor(), &orbit, (Along::Parameter(0), &drive), (values, &|_| ()))
        .unwrap()
}

/// x = A(ω) cos ωt + B(ω) sin ωt: the period is that of the drive at each ω.
#[test]
fn the_orbits_of_a_driven_oscillator_have_the_period_of_the_drive_at_each_frequency() {
    let (loaded, case) = driven("", &[0.3, 0.0]);
    let found = along_the_drive(&loaded, &case, &[0.8, 1.2, 1.7]);
    let members = asked(&found);
    assert_eq!(members.len(), 3, "{:?}", found.ended);
    for member in members {
        let w = member.value;
        let (stiff, loss) = (1.0 - w * w, 0.1 * w);
        let size = 0.3 / (stiff * stiff + loss * loss);
        let state = case.space.variables(&member.orbit.state);
        // members are located to 1e-9 of their values
        assert!((member.orbit.period - std::f64::consts::TAU / w).abs() < 1e-8, "{w}");
        assert!((state[0] - size * stiff).abs() < 1e-8, "{w}: {state:?}");
        assert!((state[1] - size * loss * w).abs() < 1e-8, "{w}: {state:?}");
    }
}

/// Duffing's oscillator bends to higher frequencies: the folds are those at which det(M − 1) vanishes by another integrator
/// (heyoka with its variational equations, Newton's method).
#[test]
fn the_resonance_of_duffings_oscillator_folds_where_another_integrator_says() {
    let (loaded, case) = driven("+ 1/4*x^4", &[1.0, 0.2]);
    let found = along_the_drive(&loaded, &case, &[1.0, 2.2]);
    let folds: Vec<f64> = (found.members.iter())
        .filter(|member| member.bifurcation == Some(Bifurcation::Fold))
        .map(|member| member.value)
        .collect();
    let [upper, lower] = folds[..] else { panic!("{folds:?} {:?}", found.ended) };
    assert!((upper - 1.779_719_52).abs() < 1e-6, "{upper}");
    assert!((lower - 1.324_236_20).abs() < 1e-6, "{lower}");
}

/// x = c + a cos(wt/2) solves ẍ + α x + β x² = F cos wt with a² = 2F/β, β c² + α c + F = 0 and w²/4 = α + 2βc, so at every w for
/// α = √(w⁴/16 + 4βF): an orbit of twice the period of the drive.
#[test]
fn an_orbit_of_two_periods_of_the_drive_keeps_their_number() {
    let (b, f) = (0.4_f64, 0.05_f64);
    let (size, middle) = ((2.0 * f / b).sqrt(), |w: f64| {
        let square = w * w / 4.0;
        (square - (square * square + 4.0 * b * f).sqrt()) / (2.0 * b)
    });
    let text = format!(
        "title = \"t\"\n[coordinates]\nx = {{ initial = 0.3, momentum = 0 }}\n[parameters]\nw = 2.0\n[hamiltonian]\n\
         H = \"1/2*p_x^2 + 1/2*sqrt(w^4/16 + 4*{b}*{f})*x^2 + {b}/3*x^3 - {f}*x*cos(w*t)\"\n"
    );
    let loaded = lowered(&text);
    let case = super::case(&loaded, &[], &[middle(2.0) + size + 0.01, 0.01]);
    let found = along_the_drive(&loaded, &case, &[1.7, 2.2, 2.6]);
    let members = asked(&found);
    assert_eq!(members.len(), 3, "{:?}", found.ended);
    for member in members {
        let w = member.value;
        let state = case.space.variables(&member.orbit.state);
        assert!((member.orbit.period - 2.0 * std::f64::consts::TAU / w).abs() < 1e-8, "{w}");
        assert!((state[0] - middle(w) - size).abs() < 1e-7, "{w}: {state:?}");
        assert!(state[1].abs() < 1e-7, "{w}: {state:?}");
    }
}

/// The motion in x does not feel the drive of y, which stays at rest: its period is no multiple of the drive's, and stays what it
/// is along the family, while the period of the drive changes. ẍ = −x³ has the period 4√2 K/a with K = ∫ du/√(1 − u⁴) for the
/// amplitude a, and the energy a⁴/4.
#[test]
fn a_period_that_is_no_multiple_of_the_drives_is_kept() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 1, momentum = 0 }\ny = { initial = 0, momentum = 0 }\n\
                [parameters]\nw = 1.3\n[hamiltonian]\n\
                H = \"1/2*(p_x^2 + p_y^2) + 1/4*x^4 + 1/2*(2 + 0.3*cos(w*t))*y^2\"\n";
    let loaded = lowered(text);
    let period = 7.0;
    let amplitude = 4.0 * 2.0_f64.sqrt() * 1.311_028_777_146_059_9 / period;
    let case = super::case(&loaded, &[], &[amplitude, 0.0, 0.0, 0.0]);
    assert!(case.space.drive().is_some());
    let fixed = Fixed::Period(period);
    let orbit = periodic_orbit(&case.space, taylor(), &case.start, Some(period), fixed).unwrap();
    let drive = |parameters: &[f64]| {
        drive_period(&loaded.model, &loaded.equations, case.space.system(), parameters)
    };
    let along = (Along::Parameter(0), &drive as &dyn Fn(&[f64]) -> Option<f64>);
    let found =
        driven_family(&case.space, taylor(), &orbit, along, (&[1.2, 1.5, 1.9], &|_| ())).unwrap();
    let members = asked(&found);
    assert_eq!(members.len(), 3, "{:?}", found.ended);
    for member in members {
        let orbit = &member.orbit;
        assert!((orbit.period - period).abs() < 1e-12, "{}: {}", member.value, orbit.period);
        let state = case.space.variables(&orbit.state);
        let energy = 0.5 * state[2] * state[2] + 0.25 * state[0].powi(4);
        assert!((energy - 0.25 * amplitude.powi(4)).abs() < 1e-9, "{state:?}");
    }
}
