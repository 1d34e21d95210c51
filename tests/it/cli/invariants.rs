//! `phaselab invariants` and `phaselab symmetries`.

use serde_json::Value;

use super::{phaselab, with_file};

fn json(words: &[&str]) -> Value {
    serde_json::from_str(&phaselab(words).success()).expect("JSON")
}

#[test]
fn the_vector_of_kepler_is_found_and_named() {
    let answer =
        json(&["invariants", "kepler-brackets", "--degree", "2", "--format", "json", "--jacobi"]);
    for key in ["searched", "known", "found", "none_up_to", "verdict", "brackets", "parameters"] {
        assert!(!answer[key].is_null() || key == "none_up_to", "{key}: {answer:#}");
    }
    let text = phaselab(&["invariants", "kepler-brackets", "--degree", "2"]).success();
    assert!(text.contains("searched"), "{text}");
}

/// Numbers in units of SI are no short fractions, and their products are rounded: the search is as strong with them as
/// with parameters of the same values, and the constants it writes can be read back.
#[test]
fn numbers_in_odd_units_are_as_good_as_parameters() {
    let atom = "1/2*M*(x'^2 + y'^2) + K/sqrt(x^2 + y^2)";
    let crystal = "1/2*M*(x'^2 + y'^2) - 1/2*K*x^2 - 2*K*y^2";
    let galaxy = "1/2*M*(x'^2 + y'^2) - 1/2*K*(x^2 + y^2)";
    let field = "1/2*M*(x'^2 + y'^2) + 1/2*K*(x*y' - y*x')";
    for (l, m, k, constants) in [
        (atom, "9.1093837e-31", "2.3070775e-28", 3),
        (crystal, "9.1093837e-31", "1.6021766e-15", 3),
        (galaxy, "1.98847e30", "7.1326912e-2", 3),
        (field, "1.67262192e-27", "1.602176634e-19", 3),
    ] {
        let head = "title = \"SI\"\n[coordinates]\nx = { initial = 1, velocity = 0 }\n\
                    y = { initial = 0.5, velocity = 2 }\n";
        let literals = l.replace('M', m).replace('K', k);
        let literals = format!("{head}[lagrangian]\nL = \"{literals}\"\n");
        let named = format!("{head}[parameters]\nM = {m}\nK = {k}\n[lagrangian]\nL = \"{l}\"\n");
        let search = |text: &str| {
            let words = ["invariants", "system.toml", "--degree", "2", "--format", "json"];
            with_file(text, &words).json()
        };
        let (literal, by_name) = (search(&literals), search(&named));
        let independent = |answer: &Value| {
            let count = |list: &str| {
                let all = answer[list].as_array().expect("a list");
                all.iter().filter(|c| c["independent"] == true).count()
            };
            count("known") + count("found")
        };
        assert_eq!(independent(&by_name), constants, "{named}: {by_name:#}");
        assert_eq!(independent(&literal), constants, "{literals}: {literal:#}");
        assert_eq!(literal["parameters"], serde_json::json!({}));
        for constant in literal["found"].as_array().expect("a list") {
            assert_eq!(constant["proved"], true, "{constant:#}");
            // as an observable of the file it is proved once more, by its time derivative
            let f = constant["expression"].as_str().expect("an expression");
            let read = format!("{literals}[[observables]]\nname = \"I\"\nexpression = \"{f}\"\n");
            with_file(&format!("{read}conserved = true\n"), &["check", "system.toml"]).success();
        }
        let claim = format!("{literals}[expect]\ninvariants = {constants}\n");
        with_file(&claim, &["check", "system.toml"]).success();
        let claim = format!("{literals}[expect]\ninvariants = {}\n", constants - 1);
        assert_eq!(with_file(&claim, &["check", "system.toml"]).code, 65);
    }
}

/// A travelling wave leaves H − v p: a law that contains the time is another one where time is reversed, so that even and odd
/// powers of the momentum do not separate. Waves of two velocities leave nothing.
#[test]
fn the_energy_beside_a_travelling_wave_is_conserved() {
    let wave = |v: &str, constants: u32| {
        let text = format!(
            "title = \"Wave\"\n[coordinates]\nx = {{ initial = 1, velocity = 0.3 }}\n[lagrangian]\n\
             L = \"1/2*x'^2 - ({v})\"\n[expect]\ninvariants = {constants}\n"
        );
        let out = with_file(&text, &["check", "system.toml"]);
        assert_eq!(out.code, 0, "{v}: {}", out.stderr);
    };
    for v in ["cos(x - 2*t)", "1/(1 + (x - 2*t)^2)", "exp(x - 2*t)", "(x - 2*t)^4"] {
        wave(v, 1);
    }
    wave("cos(x - 2*t) + cos(x)", 0);
}

/// Names that a number has elsewhere are parameters all the same.
#[test]
fn parameters_keep_their_names_in_json() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 1.0 }\n[parameters]\ninf = 2.0\nnan = 1.0\n[lagrangian]\n\
                L = \"1/2*nan*x'^2 - 1/2*inf*x^2\"\n";
    let words = ["invariants", "system.toml", "--degree", "1", "--format", "json"];
    let answer = with_file(text, &words).json();
    assert_eq!(answer["parameters"], serde_json::json!({ "inf": 2.0, "nan": 1.0 }));
}

#[test]
fn absence_is_stated_with_what_was_searched() {
    let answer = json(&["invariants", "henon-heiles", "--degree", "3", "--format", "json"]);
    assert_eq!(answer["found"], serde_json::json!([]));
    assert_eq!(answer["none_up_to"], 3);
    let searched = answer["searched"].as_str().expect("text");
    assert!(searched.contains("polynomials in p_x, p_y"), "{searched}");
}

#[test]
fn a_scan_finds_the_ratio_of_swinging_atwood() {
    let words = ["invariants", "swinging-atwood", "--degree", "2", "--format", "json"];
    let answer = json(&[&words[..], &["--scan", "M=2:4:1"]].concat());
    let values = answer["scan"]["values"].as_array().expect("a list");
    let found: Vec<u64> = values.iter().map(|v| v["found"].as_u64().expect("a number")).collect();
    assert_eq!(found, [0, 1, 0]);
}

#[test]
fn wrong_scans_are_refused() {
    for scan in ["M", "M=1:2", "M=2:1:1", "M=1:2:0", "M=1:2:1e-9"] {
        phaselab(&["invariants", "swinging-atwood", "--scan", scan]).fails(2, &["--scan"]);
    }
    phaselab(&["invariants", "swinging-atwood", "--scan", "q=1:2:1"])
        .fails(2, &["unknown parameter `q`", "M, m, g"]);
    phaselab(&["invariants", "planet", "--degree", "0"]).fails(2, &["--degree"]);
}

#[test]
fn symmetries_are_reported_with_their_constants() {
    let answer = json(&["symmetries", "free-particle", "--format", "json"]);
    let all = answer["symmetries"].as_array().expect("a list");
    assert!(!all.is_empty());
    for symmetry in all {
        assert_eq!(symmetry["proved"], true);
        for key in ["name", "time", "coordinates", "gauge", "conserved"] {
            assert!(!symmetry[key].is_null(), "{key}");
        }
    }
    let text = phaselab(&["symmetries", "free-particle"]).success();
    assert!(text.contains("time shift"), "{text}");
}

/// Kepler's third law is a symmetry without an integral; its averages are those of the virial theorem.
#[test]
fn similarity_is_reported() {
    let answer = json(&["symmetries", "planet", "--format", "json"]);
    let all = answer["point_symmetries"]["found"].as_array().expect("a list");
    let law = all.iter().find(|s| s["noether"] == false).unwrap_or_else(|| panic!("{answer}"));
    assert_eq!(law["name"], "dilation");
    assert_eq!(law["proved"], true);
    assert_eq!(answer["similarity"]["degree"], "-1");
    assert_eq!(answer["similarity"]["period_exponent"], "3/2");
    assert_eq!(answer["similarity"]["mean_T_over_mean_V"], "-1/2");
    let text = phaselab(&["symmetries", "planet"]).success();
    for part in ["not Noether's", "virial theorem"] {
        assert!(text.contains(part), "{text}");
    }
    let latex = phaselab(&["symmetries", "planet", "--format", "latex"]).success();
    assert!(latex.contains("\\langle T \\rangle"), "{latex}");
    // where friction acts there is no similarity, and nothing of Noether's
    let answer = json(&["symmetries", "damped-pendulum", "--format", "json"]);
    assert!(answer["similarity"].is_null());
    assert_eq!(answer["symmetries"], serde_json::json!([]));
    assert_eq!(answer["point_symmetries"]["found"][0]["name"], "time shift");
}

/// Mass, length and time of natural, atomic, galactic and other units.
const UNITS: [(f64, f64, f64); 4] = [
    (1.0, 1.0, 1.0),
    (9.109_383_7e-31, 5.291_77e-11, 2.418_884_3e-17),
    (1.988_92e30, 3.085_7e16, 3.155_76e13),
    (0.3, 2.7, 0.011),
];

/// A particle in the plane in a potential with the parameters k (of the dimension given by the powers of mass, length and time) and
/// a (an inverse length).
fn in_units((m, l, t): (f64, f64, f64), potential: &str, [a, b, c]: [i32; 3]) -> String {
    let k = m.powi(a) * l.powi(b) * t.powi(c);
    format!(
        "title = \"Units\"\n[parameters]\nm = {m:?}\nk = {k:?}\na = {:?}\n[coordinates]\n\
         x = {{ initial = {:?}, velocity = {:?} }}\ny = {{ initial = {:?}, velocity = {:?} }}\n\
         [lagrangian]\nL = \"1/2*m*(x'^2 + y'^2) - ({potential})\"\n",
        1.0 / l,
        0.4 * l,
        0.1 * l / t,
        0.7 * l,
        0.3 * l / t
    )
}

/// Values with so many digits that their products are rounded change no relation between them: what is found is the same in
/// all units, with the names of the parameters, and no more is independent than there can be.
#[test]
fn constants_are_the_same_in_any_units() {
    for (potential, dimension, found) in [
        ("-k/sqrt(x^2 + y^2)", [1, 3, -2], 3),
        ("1/2*k*(x^2 + y^2)", [1, 0, -2], 3),
        ("k*(exp(a*(x - y)) + exp(-a*(x + y)))", [1, 2, -2], 2),
        ("k*(1 - exp(-a*x))^2 + k*(1 - exp(-a*y))^2", [1, 2, -2], 2),
    ] {
        let reported = UNITS.map(|units| {
            let text = in_units(units, potential, dimension);
            let out = with_file(&text, &["invariants", "system.toml", "--degree", "2"]).success();
            let independent = out.lines().nth(1).unwrap_or_default();
            let expected = match found {
                2 => "2 in involution: integrable".to_owned(),
                n => format!("{n} independent constants of the motion"),
            };
            assert!(independent.contains(&expected), "{potential} {units:?}: {out}");
            let constants =
                out.lines().filter(|line| line.starts_with("  I") && line.contains('='));
            constants.collect::<Vec<_>>().join("\n")
        });
        assert!(reported.iter().all(|text| *text == reported[0]), "{potential}: {reported:#?}");
    }
}

/// A search through a Morse potential whose numbers are not short fractions finds the symmetry under time, and makes no claim
/// on others; with literals it says what to do.
#[test]
fn symmetries_of_a_law_with_long_numbers_are_searched() {
    let potential = "k*(1 - exp(-a*x))^2 + k*(1 - exp(-a*y))^2";
    for units in UNITS {
        let text = in_units(units, potential, [1, 2, -2]);
        let out = with_file(&text, &["symmetries", "system.toml"]).success();
        assert!(out.contains("time shift"), "{units:?}: {out}");
        assert_eq!(
            out.contains("there are no others (proved)"),
            units.0 == 1.0,
            "{units:?}: {out}"
        );
    }
    // a number in an exponent that is no short fraction is as good as a parameter
    let literal = "title = \"Morse\"\n[coordinates]\nx = { initial = 1 }\n\
                   [lagrangian]\nL = \"1/2*x'^2 - 5*(1 - exp(-0.48148148148148145*x))^2\"\n";
    let out = with_file(literal, &["symmetries", "system.toml"]).success();
    assert!(out.contains("time shift") && out.contains("1 found among"), "{out}");
}

/// Measured values have so many digits that exact products of them overflow. As literals or as parameters they are as good as
/// short ones: the same constants are found, as many of them independent, and the same brackets vanish.
#[test]
fn numbers_with_many_digits_find_what_short_ones_find() {
    let kepler = "1/2*M*(x'^2 + y'^2 + z'^2) + K/sqrt(x^2 + y^2 + z^2)";
    let springs = "1/2*M*(x'^2 + z'^2) + 1/2*K*y'^2 - 1/2*C*((x - y)^2 + (y - z)^2)";
    let plane = "1/2*M*(x'^2 + y'^2) - 1/2*C*(x^2 + y^2) - K*(x^2 + y^2)^2";
    let quartic = "1/2*M*x'^2 + 1/2*K*y'^2 - 1/4*C*(x - y)^4";
    for (law, degrees) in [(kepler, 3), (springs, 3), (plane, 2), (quartic, 2)] {
        let reported = |numbers: [&str; 3], named: bool| {
            let values = ["M", "K", "C"].iter().zip(numbers);
            let mut text = "title = \"Digits\"\n".to_owned();
            let mut law = law.to_owned();
            if named {
                text.push_str("[parameters]\n");
                values.for_each(|(name, value)| text.push_str(&format!("{name} = {value}\n")));
            } else {
                values.for_each(|(name, value)| law = law.replace(name, value));
            }
            text.push_str("[coordinates]\n");
            for (name, place) in ["x", "y", "z"].iter().zip([1.0, 0.3, 0.1]).take(degrees) {
                text.push_str(&format!("{name} = {{ initial = {place}, velocity = 0.2 }}\n"));
            }
            text.push_str(&format!("[lagrangian]\nL = \"{law}\"\n"));
            let words = ["invariants", "system.toml", "--degree", "2", "--format", "json"];
            let answer: serde_json::Value =
                serde_json::from_str(&with_file(&text, &words).success()).expect("JSON");
            let found = answer["found"].as_array().expect("a list");
            let found: Vec<_> =
                found.iter().map(|c| (c["degree"].clone(), c["independent"].clone())).collect();
            (answer["independent"].clone(), found, answer["in_involution"].clone())
        };
        let short = reported(["1", "16", "5"], false);
        let long = ["1.00794123457", "15.99491461956", "5.1234567891234"];
        for named in [false, true] {
            assert_eq!(reported(long, named), short, "{law}, named: {named}");
        }
    }
}

/// The energy of phase space is written as H is, and not as E with the momenta put in.
#[test]
fn the_energy_is_written_as_the_hamiltonian_is() {
    let derived = phaselab(&["derive", "rotating-frame"]).success();
    let hamiltonian = derived.lines().find_map(|line| line.trim().strip_prefix("H = "));
    let known = phaselab(&["invariants", "rotating-frame", "--degree", "1"]).success();
    let energy = known.lines().find_map(|line| line.trim().strip_prefix("energy = "));
    assert_eq!(energy, hamiltonian);
    assert_eq!(energy, Some("((p_x + m ω y)² + (p_y − m ω x)²)/(2 m) + ½ (k − m ω²) (x² + y²)"));
}

/// A Casimir is one whose brackets vanish once they are simplified, for all values of a parameter in them: of three variables one
/// degree of freedom is left, with the energy as its constant.
#[test]
fn a_casimir_is_no_constant_of_the_motion_beside_the_energy() {
    let text = "title = \"Nambu\"\n[variables]\nx = 0.5\ny = 1.0\nz = -0.3\n[parameters]\na = 0.7\n[definitions]\n\
                C = \"x^3/3 + y^2*z + a*z^2 + x*y\"\n[poisson]\nH = \"x^2 + y^2/2 + z*y\"\n\
                brackets = [[\"x\", \"y\", \"y^2 + 2*a*z\"], [\"y\", \"z\", \"x^2 + y\"], [\"z\", \"x\", \"2*y*z + x\"]]\n\
                casimirs = { C = \"C\" }\n";
    let found = with_file(text, &["invariants", "system.toml"]).success();
    assert!(found.contains("1 degree of freedom, 1 in involution: integrable"), "{found}");
}
