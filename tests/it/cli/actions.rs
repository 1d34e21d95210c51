//! `actions`: closed forms, separatrices, regions from left to right, and refusals.

use std::f64::consts::{PI, SQRT_2};

use serde_json::Value;

use super::{phaselab, with_file};

/// A particle on a line in a potential.
fn line(potential: &str, initial: &str) -> String {
    format!(
        "title = \"A line\"\n[coordinates]\nx = {{ initial = {initial}, momentum = 0.1 }}\n\
         [hamiltonian]\nH = \"1/2*p_x^2 + {potential}\"\n"
    )
}

fn actions(file: &str, arguments: &[&str]) -> Value {
    let all = [&["actions", "system.toml", "--format=json"], arguments].concat();
    with_file(file, &all).json()
}

#[track_caller]
fn near(found: &Value, expected: f64, within: f64) {
    let found = found.as_f64().expect("a number");
    assert!((found - expected).abs() <= within, "{found} is not {expected} within {within}");
}

/// Quartic, Morse, tan² and isochrone: actions and periods in closed form (the first by the beta function).
#[test]
fn actions_of_closed_form() {
    let cases = [
        ("1/4*x^4", "1", 6.9921534781123195, 0.75 * 6.9921534781123195),
        ("(1 - exp(-x))^2", "0.5", 2.0 * PI * SQRT_2 * (1.0 - 0.5f64.sqrt()), 2.0 * PI),
        ("tan(x)^2", "1", 2.0 * PI * SQRT_2 * (SQRT_2 - 1.0), PI),
        // a kink: J = (8/3) √2 E^{3/2}, T = dJ/dE
        ("abs(x)", "1", 8.0 / 3.0 * SQRT_2, 4.0 * SQRT_2),
    ];
    for (potential, energy, action, period) in cases {
        let object = actions(&line(potential, "0"), &[&format!("--energy={energy}")]);
        let rows = object["rows"].as_array().unwrap();
        assert_eq!(rows.len(), 1, "{potential}: {rows:?}");
        assert_eq!(rows[0]["kind"], "libration");
        near(&rows[0]["action"], action, 2e-14);
        near(&rows[0]["period"], period, 2e-14);
        near(&rows[0]["frequency"], 1.0 / period, 2e-15);
        assert_eq!(object["separatrices"], serde_json::json!([]), "{potential}");
        assert_eq!(object["status"], "completed");
        assert_eq!(object["message"], serde_json::Value::Null);
    }
}

/// However far from the start a coordinate turns, it is bound; a bottom without end and the energy of infinity bind nothing.
#[test]
fn what_turns_far_away_is_bound() {
    // J = (8/3) √2 E^{3/2}; of ½ x², J = 2π E; of a Kepler orbit with L = 1, J = 2π (1/√(−2E) − 1), with 2π/(−2E)^{3/2} as period
    let kepler = "1/(2*x^2) - 1/x";
    let cases: [(&str, f64, Option<[f64; 2]>); 6] = [
        ("abs(x)", 1e6, Some([8.0 / 3.0 * SQRT_2 * 1e9, 4.0 * SQRT_2 * 1e3])),
        ("1/2*x^2", 1e14, Some([2.0 * PI * 1e14, 2.0 * PI])),
        (
            kepler,
            -1e-6,
            Some([2.0 * PI * (1.0 / 2e-6_f64.sqrt() - 1.0), 2.0 * PI / 2e-6_f64.powf(1.5)]),
        ),
        (kepler, 1e-3, None),
        ("-1/2*x^2", 1.0, None),
        ("-exp(-x^2)", 1e-6, None),
    ];
    for (potential, energy, expected) in cases {
        let object = actions(&line(potential, "1"), &[&format!("--energy={energy}")]);
        let row = &object["rows"][0];
        let kind = if expected.is_some() { "libration" } else { "unbounded" };
        assert_eq!(row["kind"], kind, "{potential}: {object}");
        if let Some([action, period]) = expected {
            near(&row["action"], action, 1e-9 * action);
            near(&row["period"], period, 1e-9 * period);
        }
    }
}

/// A well beside a place from which the potential falls without end: that fall is no scale of energies at the top.
#[test]
fn a_well_beside_a_fall_without_end() {
    // the cubic well; J and T by quadrature, of the separatrix ∮ √(2/3) (1 − x) √(x + ½) dx
    let object = actions(&line("1/2*x^2 - 1/3*x^3", "0.1"), &["--energy=0.1"]);
    let well = &object["rows"][0];
    assert_eq!(well["kind"], "libration", "{object}");
    near(&well["action"], 0.662_897_370_882_530_9, 1e-13);
    near(&well["period"], 7.105_957_147_227_559, 1e-12);
    near(&object["separatrices"][0]["energy"], 1.0 / 6.0, 1e-14);
    near(&object["separatrices"][0]["actions"][0], 1.2, 1e-12);

    // l²/2r² − 1/r − β/r³ of an orbit near a black hole: by quadrature
    let file = r#"
        title = "A fall into the centre"
        [coordinates]
        r = { initial = 15.0, momentum = 0.0 }
        phi = { initial = 0.0, momentum = 4.0, period = "2*pi" }
        [hamiltonian]
        H = "1/2*p_r^2 + p_phi^2/(2*r^2) - 1/r - p_phi^2/r^3"
    "#;
    let object = actions(file, &["--coordinate=r", "--energy=-0.025"]);
    let rows = object["rows"].as_array().unwrap();
    let well = rows
        .iter()
        .find(|row| row["turning_points"][0].as_f64() > Some(4.5))
        .expect("the outer region");
    assert_eq!(well["kind"], "libration", "{object}");
    near(&well["action"], 5.120_282_823_416_236, 1e-11);
    near(&well["period"], 571.637_187_724_718_7, 1e-8);
}

/// H = ¼ p⁴ + ½ q²: where q turns, q̇ = p³ has a threefold zero. J by the beta function, T = dJ/dE = ¾ J/E.
#[test]
fn the_return_of_a_momentum_to_the_fourth_power() {
    let file = "title = \"x\"\n[coordinates]\nq = { initial = 0.3, momentum = 0.2 }\n[hamiltonian]\nH = \"1/4*p_q^4 + 1/2*q^2\"\n";
    let object = actions(file, &["--energy=1"]);
    near(&object["rows"][0]["action"], 6.992_153_478_112_32, 1e-12);
    near(&object["rows"][0]["period"], 5.244_115_108_584_24, 1e-12);
}

#[test]
fn the_radial_action_of_the_isochrone() {
    let file = r#"
        title = "Isochrone"
        [coordinates]
        r = { initial = 1.0, momentum = 0.0 }
        phi = { initial = 0.3, momentum = 0.5, period = "2*pi" }
        [hamiltonian]
        H = "1/2*p_r^2 + p_phi^2/(2*r^2) - 1/(1 + sqrt(1 + r^2))"
    "#;
    let object = actions(file, &["--coordinate=r", "--energy=-0.2"]);
    let row = &object["rows"][0];
    near(&row["period"], 2.0 * PI / 0.25298221281347035, 1e-13);
    // M. Hénon, Annales d'Astrophysique 22, 126 (1959), with GM = b = 1
    let action = 2.0 * PI * (1.0 / f64::sqrt(0.4) - 0.5 * (0.5 + f64::sqrt(4.25)));
    near(&row["action"], action, 1e-13);
    // the angle advances by Ω_φ on the mean, and its action is 2π times its momentum
    let object = actions(file, &["--coordinate=phi", "--energy=-0.2"]);
    let row = &object["rows"][0];
    assert_eq!((&row["kind"], object["rows"].as_array().unwrap().len()), (&"rotation".into(), 1));
    near(&row["frequency"], 0.15716970596062999 / (2.0 * PI), 1e-14);
    near(&row["period"], 2.0 * PI / 0.15716970596062999, 1e-12);
    near(&row["action"], PI, 1e-14);
    // Ω_φ/Ω_r = ½ (1 + L/√(L² + 4)), of Hénon
    let ratio = 0.5 * (1.0 + 0.5 / f64::sqrt(4.25));
    near(&row["frequency"], ratio * 0.25298221281347035 / (2.0 * PI), 1e-14);
}

/// Without a `period` an angle has no turn and no action, but a mean rate.
#[test]
fn a_cyclic_coordinate_without_a_period_has_a_mean_rate() {
    let file = r#"
        title = "Isochrone"
        [coordinates]
        r = { initial = 1.0, momentum = 0.0 }
        phi = { initial = 0.3, momentum = 0.5 }
        [hamiltonian]
        H = "1/2*p_r^2 + p_phi^2/(2*r^2) - 1/(1 + sqrt(1 + r^2))"
    "#;
    let row = |coordinate: &str| actions(file, &[coordinate, "--energy=-0.2"])["rows"][0].clone();
    near(&row("--coordinate=r")["angular_frequency"], 0.25298221281347035, 1e-14);
    let angle = row("--coordinate=phi");
    near(&angle["angular_frequency"], 0.15716970596062999, 1e-14);
    assert_eq!(angle["kind"], "unbounded");
    for key in ["action", "period", "frequency"] {
        assert_eq!(angle[key], Value::Null, "{key}");
    }
    // what goes away has no rate
    let away = actions(&line("-x", "0"), &["--energy=1"])["rows"][0].clone();
    assert_eq!(away["angular_frequency"], Value::Null, "{away}");
}

#[test]
fn a_pendulum_exactly_on_its_separatrix_has_its_area() {
    for (set, energy, area) in [("g=1", "1", 16.0), ("g=4", "4", 32.0)] {
        let energy = format!("--energy={energy}");
        let set = format!("--set={set}");
        let object = phaselab(&["actions", "pendulum", &set, &energy, "--format=json"]).json();
        let rows = object["rows"].as_array().unwrap();
        assert_eq!(rows.len(), 1, "{object}");
        near(&rows[0]["action"], area, 1e-10);
        assert_eq!((&rows[0]["kind"], &rows[0]["period"]), (&"libration".into(), &Value::Null));
    }
}

#[test]
fn a_double_well_has_both_its_wells_and_its_lobes() {
    let file = line("1/4*x^4 - 1/2*x^2", "1");
    let object = actions(&file, &["--energy=-0.125,0.5,0"]);
    let rows = object["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 5);
    for (row, side) in rows[..2].iter().zip([-1.0, 1.0]) {
        near(&row["action"], 0.58793325565416153, 1e-14);
        near(&row["period"], 5.0378540936193069, 1e-13);
        let mut points =
            [f64::sqrt(1.0 - 0.5f64.sqrt()) * side, f64::sqrt(1.0 + 0.5f64.sqrt()) * side];
        points.sort_by(f64::total_cmp);
        near(&row["turning_points"][0], points[0], 1e-14);
        near(&row["turning_points"][1], points[1], 1e-14);
    }
    // above the hill ν = dE/dJ, by differences of the action itself
    let beside = actions(&file, &["--energy=0.4999,0.5001"]);
    let action = |i: usize| beside["rows"][i]["action"].as_f64().unwrap();
    near(&rows[2]["frequency"], 0.0002 / (action(1) - action(0)), 1e-8);
    // on the separatrix the motion takes for ever, and its area is that of the lobes
    for row in &rows[3..] {
        near(&row["action"], 4.0 / 3.0, 1e-12);
        assert_eq!((&row["period"], &row["frequency"]), (&Value::Null, &serde_json::json!(0.0)));
    }
    let separatrices = object["separatrices"].as_array().unwrap();
    assert_eq!(separatrices.len(), 1);
    assert_eq!(separatrices[0]["energy"], 0.0);
    near(&separatrices[0]["actions"][0], 4.0 / 3.0, 1e-12);
    near(&separatrices[0]["actions"][1], 4.0 / 3.0, 1e-12);
}

/// The pendulum's separatrix has the area 16 m l² √(g/l): J tends to it from below, and to half of it per turn from above.
#[test]
fn the_pendulum_librates_and_rotates_on_both_sides_of_its_separatrix() {
    let with = |energy: &str| {
        let energy = format!("--energy={energy}");
        phaselab(&["actions", "pendulum", "--set=g=1", &energy, "--format=json"]).json()
    };
    let object = with("0.99999999,1.00000001,0");
    let rows = object["rows"].as_array().unwrap();
    let kinds: Vec<&Value> = rows.iter().map(|row| &row["kind"]).collect();
    assert_eq!(kinds, ["libration", "rotation", "libration"]);
    near(&rows[0]["action"], 16.0, 5e-7);
    near(&rows[1]["action"], 8.0, 2.5e-7);
    assert_eq!(rows[1]["turning_points"], serde_json::json!([]));
    // 90°: T = 4 K(1/2); J = 16 (E(k) − (1 − k²) K(k)), k² = 1/2
    let (k, e) = (1.854074677301372, 1.350643881047675);
    near(&rows[2]["period"], 4.0 * k, 1e-13);
    near(&rows[2]["action"], 16.0 * (e - 0.5 * k), 1e-13);
    near(&rows[2]["turning_points"][0], -PI / 2.0, 1e-14);
    near(&object["separatrices"][0]["energy"], 1.0, 1e-15);
    near(&object["separatrices"][0]["actions"][0], 16.0, 1e-12);
    assert_eq!(object["separatrices"].as_array().unwrap().len(), 1);
    // a rotation of energy 3: p² = 2(3 + cos θ), J = 2π ⟨p⟩ by the trapezoidal rule, T = ∮ dθ/p
    let row = &with("3")["rows"][0];
    let p = |i: i32| f64::sqrt(2.0 * (3.0 + (2.0 * PI * f64::from(i) / 64.0).cos()));
    let mean = |f: &dyn Fn(i32) -> f64| (0..64).map(f).sum::<f64>() * 2.0 * PI / 64.0;
    near(&row["action"], mean(&p), 1e-13);
    near(&row["period"], mean(&|i| 1.0 / p(i)), 1e-13);
}

/// The start of J. Sussman and J. Wisdom's pendulum: θ = 0, p = 4.9006733894348145, with β = 9.8.
#[test]
fn without_energies_it_is_the_region_of_the_start() {
    let arguments = ["--set=g=9.8", "--init=theta=0", "--init=p_theta=4.9006733894348145"];
    let object =
        phaselab(&[&["actions", "pendulum", "--format=json"], &arguments[..]].concat()).json();
    let rows = object["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 1);
    near(&rows[0]["energy"], 2.20829983495726, 1e-13);
    near(&rows[0]["action"], 26.5963714139872, 2e-12);
    near(&rows[0]["period"], 2.0 * PI / 2.5043962735932013, 1e-14);
    near(&rows[0]["turning_points"][1], 1.79808495569394, 1e-13);
    // of the two wells that of the start alone
    let object = actions(&line("1/4*x^4 - 1/2*x^2", "-1"), &[]);
    let rows = object["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 1);
    assert!(rows[0]["turning_points"][1].as_f64().unwrap() < 0.0);
}

/// A particle that is pushed to the left comes from there and turns at its right: at x = E of a potential x.
#[test]
fn a_region_with_one_end_has_it_on_its_side() {
    let of = |potential: &str| {
        let text = format!(
            "title = \"A slope\"\n[coordinates]\nx = {{ initial = -1.0 }}\n[lagrangian]\nL = \"1/2*x'^2 - {potential}\"\n"
        );
        let done =
            with_file(&text, &["actions", "system.toml", "--energy", "1", "--format", "csv"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let row = done.stdout.lines().find(|line| line.contains("unbounded")).expect("a row");
        row.split(',').skip(2).take(2).map(|end| end.parse::<f64>().ok()).collect::<Vec<_>>()
    };
    let [left, right] = of("x")[..] else { panic!("two ends") };
    assert!(left.is_none_or(f64::is_nan) && (right.unwrap() - 1.0).abs() < 1e-12);
    let [left, right] = of("(-x)")[..] else { panic!("two ends") };
    assert!(right.is_none_or(f64::is_nan) && (left.unwrap() + 1.0).abs() < 1e-12);
}

/// Above its dissociation a Morse oscillator goes away.
#[test]
fn an_unbounded_motion_has_no_action() {
    let object = actions(&line("(1 - exp(-x))^2", "0"), &["--energy=1.5"]);
    let row = &object["rows"][0];
    assert_eq!(row["kind"], "unbounded");
    assert_eq!((&row["action"], &row["frequency"]), (&Value::Null, &Value::Null));
    near(&row["turning_points"][0], -f64::ln(1.0 + 1.5f64.sqrt()), 1e-14);
    // exactly there too, on either side, and beside it another energy has its row
    for potential in ["(1 - exp(-x))^2", "(1 - exp(x))^2"] {
        let object = actions(&line(potential, "0"), &["--energy=0.5,1"]);
        let kinds: Vec<&Value> =
            object["rows"].as_array().unwrap().iter().map(|row| &row["kind"]).collect();
        assert_eq!(kinds, ["libration", "unbounded"], "{potential}");
    }
}

#[test]
fn what_has_no_action_is_refused() {
    let refused = |arguments: &[&str], code: i32, said: &[&str]| {
        phaselab(&[&["actions"], arguments].concat()).fails(code, said);
    };
    refused(&["henon-heiles"], 2, &["--coordinate x or y"]);
    refused(&["henon-heiles", "--coordinate=z"], 2, &["unknown coordinate `z`"]);
    refused(&["henon-heiles", "--coordinate=x"], 1, &["does not separate"]);
    refused(&["duffing"], 1, &["not conserved"]);
    refused(&["kicked-rotor"], 1, &["not conserved"]);
    refused(&["free-rigid-body"], 2, &["brackets"]);
    refused(&["pendulum-rod"], 2, &["constraints"]);
    let below = phaselab(&["actions", "pendulum", "--energy=-100"]);
    assert_eq!(below.code, 1);
    assert!(below.stderr.contains("cannot move"), "{}", below.stderr);
}

/// The column of the action gives way to a coordinate or an observable of the same name.
#[test]
fn names_of_the_file_are_free() {
    let plain = "title = \"A\"\n[coordinates]\nx = { initial = 1.0, momentum = 0.0 }\n\
                 [hamiltonian]\nH = \"1/2*p_x^2 + 1/2*x^2\"\n";
    let expected = actions(plain, &[])["rows"].clone();
    let coordinate = plain.replace("p_x", "p_S").replace("x =", "S =").replace("x^2", "S^2");
    let observable =
        |name: &str| format!("{plain}[[observables]]\nname = \"{name}\"\nexpression = \"3*x\"\n");
    let both = observable("S") + "[[observables]]\nname = \"S_\"\nexpression = \"4*x\"\n";
    for file in [coordinate, observable("S"), observable("action_"), both] {
        assert_eq!(actions(&file, &[])["rows"], expected, "{file}");
    }
}

/// The action of the motion itself is known, and the separatrices as far as the wells are seen: the nearest have lobes of 16.
#[test]
fn an_angle_without_its_period_has_the_separatrices_that_are_seen() {
    let text = "title = \"A\"\n[coordinates]\nq = { initial = 0.1 }\n[lagrangian]\nL = \"1/2*q'^2 + cos(q)\"\n";
    let done = with_file(text, &["actions", "system.toml", "--format=json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(done.stderr.contains("give its `period`"), "{}", done.stderr);
    let object: Value = serde_json::from_str(&done.stdout).expect("JSON");
    let all = object["separatrices"].as_array().expect("separatrices");
    let finite = all.iter().flat_map(|one| one["actions"].as_array().expect("actions"));
    let actions: Vec<f64> = finite.filter_map(Value::as_f64).collect();
    let sixteen = actions.iter().filter(|action| (*action - 16.0).abs() < 1e-6).count();
    assert_eq!((sixteen, actions.len()), (15, 15), "{all:?}");
}

/// The motion of a preset followed by `actions --until`: rows by the names of their columns.
fn along(arguments: &[&str]) -> (Value, Vec<Vec<f64>>, Vec<String>) {
    let words = [&["actions"], arguments, &["--format=json"]].concat();
    let object = phaselab(&words).json();
    let part = &object["along"];
    let names = part["columns"].as_array().expect("columns").iter();
    let names = names.map(|name| name.as_str().expect("a name").to_owned()).collect();
    let rows = part["rows"].as_array().expect("rows").iter().map(|row| {
        row.as_array().expect("a row").iter().map(|x| x.as_f64().expect("a number")).collect()
    });
    (part.clone(), rows.collect(), names)
}

/// w grows by one in a period, 4 K(k) of a libration and 2 k K(k) of a rotation, wherever it is looked at.
#[test]
fn the_angle_variable_grows_evenly() {
    // 4 K(sin 1), 16 (E − k′² K); and with θ′ = 3 at θ = 0, k = 2/3: 2 k K(k), 8 E(k)/k
    let cases: [(&[&str], f64, f64); 2] = [
        (&[], 8.349_752_926_918_494, 10.039_416_280_433_402),
        (
            &["--init", "theta=0", "--init", "theta'=3"],
            2.412_889_993_982_118,
            16.537_247_254_799_795,
        ),
    ];
    for (start, period, action) in cases {
        let words = [&["pendulum-action", "--until=20", "--count=10"], start].concat();
        let (part, rows, names) = along(&words);
        assert_eq!(names, ["t", "theta", "energy", "action", "frequency", "angle", "residual"]);
        assert_eq!((rows.len(), &part["depends_on_time"]), (11, &false.into()));
        assert!(part["largest_residual"].as_f64().unwrap() < 1e-9, "{part}");
        for (k, row) in rows.iter().enumerate() {
            let time = 2.0 * k as f64;
            assert!((row[0] - time).abs() < 1e-15);
            assert!((row[3] - action).abs() < 1e-9, "{row:?}");
            assert!((row[4] - 1.0 / period).abs() < 1e-10, "{row:?}");
            assert!((row[5] - rows[0][5] - time / period).abs() < 1e-9, "{row:?}");
        }
    }
}

/// Of a law that depends on the time: those of the system held at each instant. Of an oscillator J = 2π E/ω, ν = ω/2π and
/// w = atan2(p, −m ω q)/2π, 0 where it turns on the left.
#[test]
fn along_a_ramp_action_and_angle_are_those_of_the_instant() {
    let (part, rows, names) = along(&["slow-oscillator", "--until=80", "--count=40"]);
    assert_eq!(names.last().map(String::as_str), Some("angle"));
    assert_eq!((&part["depends_on_time"], &part["largest_residual"]), (&true.into(), &Value::Null));
    let turns = 2.0 * PI;
    for row in &rows {
        let [time, q, energy, action, frequency, angle] = row[..] else { panic!("{row:?}") };
        let u = ((time - 10.0) / 60.0).clamp(0.0, 1.0);
        let omega = 1.0 + u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
        assert!((frequency - omega / turns).abs() < 1e-11, "{row:?}");
        assert!((action - turns * energy / omega).abs() < 1e-10, "{row:?}");
        let turned = -q * omega / (2.0 * energy).sqrt();
        assert!(((turns * angle).cos() - turned).abs() < 1e-6, "{row:?}");
    }
    let [first, last] = [&rows[0], &rows[40]];
    assert!((last[3] / first[3] - 1.0).abs() < 1e-4 && last[2] / first[2] > 1.99);
    // no turn is lost: 5 s and 5 s at the ends, and the mean of ω between
    let gone = last[5] - first[5];
    assert!((gone * turns - (10.0 + 90.0 + 20.0)).abs() < 0.01 * turns, "{gone}");
}

#[test]
fn what_has_no_angle_along_its_motion_says_so() {
    let refused = |arguments: &[&str], code: i32, said: &[&str]| {
        phaselab(&[&["actions"], arguments].concat()).fails(code, said);
    };
    refused(&["pendulum", "--until=0"], 2, &["not after"]);
    refused(&["pendulum", "--until=1", "--energy=1"], 2, &["--energy"]);
    refused(&["pendulum", "--count=3"], 2, &["--until"]);
    refused(&["henon-heiles", "--coordinate=x", "--until=1"], 1, &["does not separate"]);
    refused(&["damped-pendulum", "--until=1"], 1, &["forces change the energy"]);
    let csv = phaselab(&[
        "actions",
        "isochrone",
        "--coordinate=r",
        "--until=50",
        "--count=4",
        "--format=csv",
    ]);
    let csv = csv.success();
    let mut rows = csv.lines().filter(|line| !line.starts_with('#'));
    assert_eq!(rows.next(), Some("t,r,energy,action,frequency,angle,residual"));
    assert_eq!(rows.count(), 5);
}

/// An energy next to that of the separatrix is told from it, and the action of libration from that of a turn.
#[test]
fn a_separatrix_is_told_from_what_is_next_to_it() {
    let close = ["actions", "pendulum-action", "--energy=0.999999"];
    let text = phaselab(&close).success();
    assert!(text.contains("0.999999 ") && text.contains(" 15.9999"), "{text}");
    let said = "separatrix at energy 1: actions 16 of libration, 8 a turn of rotation";
    assert!(text.contains(said), "{text}");
    let object = phaselab(&[&close[..], &["--format=json"]].concat()).json();
    near(&object["separatrices"][0]["turn"], 8.0, 1e-12);
    // what has no turns has none of that action either
    let object = phaselab(&["actions", "double-well", "--format=json"]).json();
    assert_eq!(object["separatrices"][0]["turn"], Value::Null, "{object}");
    let text = phaselab(&["actions", "double-well"]).success();
    assert!(!text.contains("turn of rotation"), "{text}");
}

/// Tops of the same energy whose lobes meet have one separatrix, and a turn passes all lobes of a period, each one way.
#[test]
fn tops_of_the_same_energy_have_one_separatrix() {
    let rotor = |law: &str| {
        let file = format!(
            "title = \"A rotor\"\n[coordinates]\nx = {{ initial = 0.0, velocity = 0.3, period = \"2*pi\" }}\n\
             [lagrangian]\nL = \"1/2*x'^2 + {law}\"\n"
        );
        actions(&file, &["--energy=0.5"])
    };
    // p = 2 |cos x|; then p = |cos x| √(4 + 0.6 cos x), by quadrature (mpmath)
    let cases = [
        ("cos(2*x)", vec![8.0, 8.0], 8.0),
        (
            "cos(2*x) + 0.3*cos(x)^3",
            vec![8.457_155_927_207_6, 7.512_673_592_062_454],
            7.984_914_759_635_027,
        ),
    ];
    for (law, lobes, turn) in cases {
        let object = rotor(law);
        let [separatrix] = &object["separatrices"].as_array().unwrap()[..] else {
            panic!("{object}")
        };
        near(&separatrix["energy"], 1.0, 1e-14);
        near(&separatrix["turn"], turn, 1e-12);
        let mut found: Vec<f64> = separatrix["actions"]
            .as_array()
            .unwrap()
            .iter()
            .map(|action| action.as_f64().unwrap())
            .collect();
        found.sort_by(|a, b| b.total_cmp(a));
        assert_eq!(found.len(), 2, "{object}");
        for (found, lobe) in found.iter().zip(lobes) {
            assert!((found - lobe).abs() < 1e-12, "{found} {lobe}");
        }
    }
    // without a period: three wells between and beside two tops; no turn
    let wells = [f64::sqrt(6.0) / 6.0, f64::sqrt(6.0) / 3.0, f64::sqrt(6.0) / 6.0];
    let object = actions(&line("x^2*(x^2 - 1)^2", "0"), &["--energy=0.1"]);
    let [separatrix] = &object["separatrices"].as_array().unwrap()[..] else { panic!("{object}") };
    near(&separatrix["energy"], 4.0 / 27.0, 1e-15);
    assert_eq!(separatrix["turn"], Value::Null);
    for (action, expected) in separatrix["actions"].as_array().unwrap().iter().zip(wells) {
        near(action, expected, 1e-10);
    }
    assert_eq!(separatrix["actions"].as_array().unwrap().len(), 3);
}

/// Next to a separatrix the period is the logarithm of a difference of energies: T = 2√2 K(m)/b with a² = 1 − s, b² = 1 + s,
/// m = 1 − a²/b² and s = √(1 + 4E), in either lobe.
#[test]
fn a_period_next_to_a_separatrix_is_that_of_its_energy() {
    let object = actions(&line("1/4*x^4 - 1/2*x^2", "1"), &["--energy=-1e-9"]);
    let rows = object["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 2);
    for row in rows {
        near(&row["period"], 23.495_854_574_308_083, 1e-11);
    }
}

/// H = p⁴/4 + p²/2 + 0.3 x p + x⁴: rest is not where p vanishes. With p = −s x the separatrix through the origin is
/// x² = (0.3 s − s²/2)/(1 + s⁴/4), and the area of a lobe ½ ∫ x² ds over 0 ≤ s ≤ 0.6.
#[test]
fn lobes_that_lie_off_the_line_of_no_momentum_have_their_area() {
    let file = "title = \"Odd in p\"\n[coordinates]\nx = { initial = 0.7, momentum = 0.2 }\n\
                [hamiltonian]\nH = \"p_x^4/4 + p_x^2/2 + 0.3*x*p_x + x^4\"\n";
    let square = |s: f64| (0.3 * s - 0.5 * s * s) / (1.0 + s.powi(4) / 4.0);
    let (count, step) = (600, 1e-3);
    let simpson = |i: u32| if i.is_multiple_of(2) { 2.0 } else { 4.0 };
    let inside = (1..count).map(|i| simpson(i) * square(f64::from(i) * step)).sum::<f64>();
    let area = 0.5 * inside * step / 3.0;
    let object = actions(file, &["--energy=0"]);
    let lobes = &object["separatrices"][0];
    near(&lobes["energy"], 0.0, 1e-15);
    for lobe in 0..2 {
        near(&lobes["actions"][lobe], area, 1e-10);
    }
}

/// Where the energy is least, or stationary, at several momenta, no effective potential has the turning points: that is the
/// reason that is given.
#[test]
fn an_energy_with_several_momenta_of_rest_is_reported_as_such() {
    let file = |h: &str, momentum: f64| {
        format!(
            "title = \"Rest\"\n[coordinates]\nx = {{ initial = 0.5, momentum = {momentum} }}\n\
             [hamiltonian]\nH = \"{h}\"\n"
        )
    };
    // of two minima in p, the start lies beside one, and at rest the energy is greatest
    for energy in [&[][..], &["--energy=0.2"]] {
        let words = [&["actions", "system.toml"], energy].concat();
        with_file(&file("p_x^4 - p_x^2 + 1/2*x^2", 0.9), &words)
            .fails(1, &["greatest, and not least"]);
    }
    // the energy falls again beyond p = 1/2
    let below = with_file(&file("1/2*p_x^2 - p_x^4 + 1/2*x^2", 1.0), &["actions", "system.toml"]);
    assert_eq!(below.code, 1);
    assert!(
        below.stderr.contains("less energy at the start than it would have at rest"),
        "{}",
        below.stderr
    );
    // in a band of energies, E < 1 − cos 0 …, x turns where p = π
    let turned =
        with_file(&file("-cos(p_x) + 1/2*x^2", 0.0), &["actions", "system.toml", "--energy=1.5"]);
    assert_eq!(turned.code, 1, "{}", turned.stdout);
    assert!(turned.stderr.contains("not that of rest"), "{}", turned.stderr);
}

/// H = cos x + cos p falls on both sides of p = 0, where it is at rest: an effective potential is the least energy, and there is
/// none, whatever the energy.
#[test]
fn an_energy_that_is_greatest_at_rest_is_refused() {
    let file = |h: &str, period: &str| {
        format!(
            "title = \"Harper\"\n[coordinates]\nx = {{ initial = 1, momentum = 0{period} }}\n\
             [hamiltonian]\nH = \"{h}\"\n"
        )
    };
    for period in ["", ", period = \"2*pi\""] {
        let file = file("cos(p_x) + cos(x)", period);
        for energy in [&[][..], &["--energy=-1.5"], &["--energy=0"], &["--energy=1.9"]] {
            let refused = with_file(&file, &[&["actions", "system.toml"], energy].concat());
            assert_eq!(refused.code, 1, "{}", refused.stdout);
            assert!(!refused.stderr.contains("wells"), "{}", refused.stderr);
            refused.fails(1, &["greatest", "momentum of rest"]);
        }
    }
}

/// A flux A through a ring adds A to p and nothing to the motion: ∮ p dq is that of the pendulum, 2π ⟨√(2(E + cos f))⟩, plus 2π A
/// one way and less 2π A the other way.
#[test]
fn a_momentum_without_velocity_counts_one_way_and_against_it() {
    let flux = 0.2;
    let pendulum = |energy: f64| {
        let p = |i: i32| (2.0 * (energy + (2.0 * PI * f64::from(i) / 256.0).cos())).sqrt();
        (0..256).map(p).sum::<f64>() * 2.0 * PI / 256.0
    };
    let ring = |start: &str, others: &str| {
        format!(
            "[coordinates]\n{others}f = {{ initial = 0, velocity = {start}, period = '2*pi' }}\n[parameters]\nA = {flux}\n\
             [lagrangian]\nL = \"1/2*f'^2 + A*f' + cos(f)"
        )
    };
    let one = |start: &str| format!("{}\"\n", ring(start, ""));
    let of = |file: &str, words: &[&str]| {
        with_file(file, &[&["actions", "./system.toml", "--format=json"], words].concat()).json()
    };
    let energy = 2.5 * 2.5 / 2.0 - 1.0;
    for (start, kind, sign) in [("2.5", "rotation", 1.0), ("-2.5", "backward rotation", -1.0)] {
        let found = of(&one(start), &[]);
        assert_eq!(found["rows"][0]["kind"], kind);
        near(&found["rows"][0]["action"], pendulum(energy) + sign * 2.0 * PI * flux, 1e-12);
        let along = of(&one(start), &["--until=5", "--count=4"]);
        near(&along["along"]["rows"][4][3], pendulum(energy) + sign * 2.0 * PI * flux, 1e-11);
        // the separatrix: 8 a turn without the flux
        near(&found["separatrices"][0]["turn"], 8.0 + 2.0 * PI * flux, 1e-9);
        near(&found["separatrices"][0]["backward_turn"], 8.0 - 2.0 * PI * flux, 1e-9);
    }
    // of an energy both are rows
    let found = of(&one("0"), &["--energy=1.5"]);
    let kinds: Vec<&Value> =
        found["rows"].as_array().unwrap().iter().map(|row| &row["kind"]).collect();
    assert_eq!(kinds, ["rotation", "backward rotation"]);
    // beside another coordinate
    let two = ring("2.5", "x = { initial = 0.5, velocity = 0.2 }\n") + " + 1/2*x'^2 - x^2\"\n";
    let found = of(&two, &["--coordinate=f"]);
    near(&found["rows"][0]["action"], pendulum(energy) + 2.0 * PI * flux, 1e-12);
    // a flux that changes slowly leaves ∮ p dq as it is, that is E + A′s induction
    let words = ["run", "./system.toml", "--until=5", "--ramp=A=0.2:0.3:0:4", "--format=json"];
    let run = with_file(&one("-2.5"), &words).json();
    let invariants = run["invariants"].as_array().unwrap();
    let action = invariants.iter().find(|one| one["name"] == "action variable").unwrap();
    assert_eq!(action["verdict"], "adiabatic", "{action}");
    near(&action["initial"], pendulum(energy) - 2.0 * PI * flux, 1e-9);
}

/// ∮ w/p dq of a coordinate with p² = 2 g(q) that librates about zero.
fn around(g: impl Fn(f64) -> f64, weight: impl Fn(f64) -> f64) -> f64 {
    let (mut inside, mut outside) = (0.0, 3.0);
    for _ in 0..60 {
        let middle = f64::midpoint(inside, outside);
        if g(middle) > 0.0 { inside = middle } else { outside = middle }
    }
    let nodes = 2000;
    let at = |k: i32| PI * ((f64::from(k) + 0.5) / f64::from(nodes) - 0.5);
    let term = |theta: f64| {
        let q = inside * theta.sin();
        weight(q) * inside * theta.cos() / (2.0 * g(q)).sqrt()
    };
    2.0 * PI / f64::from(nodes) * (0..nodes).map(|k| term(at(k))).sum::<f64>()
}

/// Liouville's system (x⁴ + x² − cos y)/(2 + x² + cos y): with E and the separation constant α, J_x is ∮ √(2 (E f − u + α)) dx
/// and J_y is ∮ √(2 (E g − v − α)) dy; the frequencies are ∂E/∂J at the other action constant, from the inverse of ∂J/∂(E, α).
#[test]
fn where_one_coordinate_sets_the_rate_of_another_its_frequency_is_that_of_the_mean() {
    let file = "title = \"Liouville\"\n[coordinates]\nx = { initial = 0.4, velocity = 0.3 }\n\
                y = { initial = 0.2, velocity = 0.5 }\n[lagrangian]\n\
                L = \"1/2*(2+x^2+cos(y))*(x'^2+y'^2)-(x^4-cos(y)+x^2)/(2+x^2+cos(y))\"\n";
    let (x, y) = (0.4_f64, 0.2_f64);
    let f = |x: f64| 2.0 + x * x;
    let u = |x: f64| x.powi(4) + x * x;
    let total = f(x) + y.cos();
    let (p_x, p_y) = (0.3 * total, 0.5 * total);
    let energy = (0.5 * (p_x * p_x + p_y * p_y) + u(x) - y.cos()) / total;
    let alpha = 0.5 * p_x * p_x - energy * f(x) + u(x);
    let along_x = |q: f64| energy * f(q) - u(q) + alpha;
    let along_y = |q: f64| energy * q.cos() + q.cos() - alpha;
    let [a, b] = [around(along_x, f), around(along_x, |_| 1.0)];
    let [c, d] = [around(along_y, f64::cos), -around(along_y, |_| 1.0)];
    let determinant = a * d - b * c;
    for (coordinate, expected) in [("x", d / determinant), ("y", -b / determinant)] {
        let all = ["actions", "system.toml", "--format=json", "--coordinate", coordinate];
        let found: Value = serde_json::from_str(&with_file(file, &all).stdout).unwrap();
        near(&found["rows"][0]["frequency"], expected, 2e-10 * expected);
        let until = ["actions", "system.toml", "--until=10", "--coordinate", coordinate];
        with_file(file, &until).fails(1, &["take different times"]);
    }
}

/// A ball on a floor, from which an impulse throws it back: without it the ball falls without end.
#[test]
fn impulses_at_events_are_said_to_be_left_out() {
    let file = "title = \"Ball\"\n[coordinates]\nx = { initial = 0.5, velocity = 0.5 }\n[lagrangian]\n\
                L = \"1/2*x'^2 - x\"\n[[impulses]]\nname = \"bounce\"\nchange = { p_x = \"-2*x'\" }\n[[events]]\n\
                name = \"floor\"\nwhen = \"x\"\ndirection = \"falling\"\naction = \"impulse:bounce\"\n";
    let said = with_file(file, &["actions", "system.toml"]).stderr;
    assert!(said.contains("impulses at events are left out"), "{said}");
}
