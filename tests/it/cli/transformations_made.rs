//! Transformations made of others, and the other generating functions of one: against maps written out by hand, and
//! against the differential of the function.

use serde_json::{Value, json};

use super::{phaselab, with_file};
use crate::build::{names, read, sample};

pub(super) const FREE: &str = "title = \"T\"\n[coordinates]\nq = { initial = 1.0, momentum = 0.3 }\n\
                    [parameters]\nm = 1.3\nc = 2.0\n[hamiltonian]\nH = \"p_q^2/(2*m) + q^4\"\n";

fn derived(rest: &[&str]) -> Vec<Value> {
    let text = format!("{FREE}{}", rest.join("\n"));
    let found = with_file(&text, &["derive", "system.toml", "--format", "json"]).json();
    found["transformations"].as_array().expect("a list").clone()
}

pub(super) const SHEAR: &str = "[[transformations]]\nname = \"shear\"\nkind = \"explicit\"\n\
                     Q = { A = \"q + p_q^2\" }\nP = { B = \"p_q\" }";
const SWAP: &str =
    "[[transformations]]\nname = \"swap\"\nkind = \"F1\"\nF = \"q*C\"\nnew = [\"C\", \"D\"]";

pub(super) fn made(name: &str, kind: &str, of: &str, new: &str) -> String {
    format!("[[transformations]]\nname = \"{name}\"\nkind = \"{kind}\"\nof = [{of}]\nnew = [{new}]")
}

#[test]
fn the_first_acts_first() {
    let one = made("one", "compose", "\"shear\", \"swap\"", "\"X\", \"Y\"");
    let other = made("other", "compose", "\"swap\", \"shear\"", "\"U\", \"V\"");
    let thrice = made("thrice", "compose", "\"swap\", \"swap\", \"swap\"", "\"R\", \"S\"");
    let found = derived(&[SHEAR, SWAP, &one, &other, &thrice]);
    assert_eq!(found[1]["new"], json!({ "C": "p_q", "D": "-q" }));
    assert_eq!(found[2]["new"], json!({ "X": "p_q", "Y": "-p_q^2 - q" }));
    assert_eq!(found[3]["new"], json!({ "U": "p_q + q^2", "V": "-q" }));
    assert_eq!(found[4]["new"], json!({ "R": "-p_q", "S": "q" }));
    for made in &found[2..] {
        assert_eq!((&made["canonical"], &made["proved"]), (&json!(true), &json!(true)));
    }
}

#[test]
fn an_inverse_undoes() {
    let back = made("back", "inverse", "\"shear\"", "\"X\", \"Y\"");
    let identity = made("identity", "compose", "\"shear\", \"back\"", "\"U\", \"V\"");
    let again = made("again", "inverse", "\"swap\"", "\"R\", \"S\"");
    let twice = made("twice", "inverse", "\"again\"", "\"K1\", \"K2\"");
    let found = derived(&[SHEAR, SWAP, &back, &identity, &again, &twice]);
    assert_eq!(found[2]["new"], json!({ "X": "q - p_q^2", "Y": "p_q" }));
    assert_eq!(found[3]["new"], json!({ "U": "q", "V": "p_q" }));
    assert_eq!(found[4]["new"], json!({ "R": "-p_q", "S": "q" }));
    assert_eq!(found[5]["new"], json!({ "K1": "p_q", "K2": "-q" }));
    assert!(found.iter().all(|one| one["canonical"] == true), "{found:?}");
}

/// F1 = ½ q² cot Q leaves open which of ±√(2P) (sin Q, cos Q) undoes it; its inverse is the one that does, all around the circle.
#[test]
fn the_inverse_of_a_generating_function_is_on_its_branch() {
    let angle = "[[transformations]]\nname = \"angle\"\nkind = \"F1\"\nF = \"q^2/2/tan(A)\"\nnew = [\"A\", \"B\"]";
    let back = made("back", "inverse", "\"angle\"", "\"X\", \"Y\"");
    let found = derived(&[angle, &back]);
    let root = "sqrt(2)*sqrt(p_q)";
    let expected = json!({ "X": format!("{root}*sin(q)"), "Y": format!("{root}*cos(q)") });
    assert_eq!(found[1]["new"], expected);
    assert_eq!((&found[1]["canonical"], &found[1]["proved"]), (&json!(true), &json!(true)));
}

/// A function is said not to exist only where its variables are not independent: det ∂(x, y)/∂(a, b) of this one is −a (3a + 10)²/250.
#[test]
fn a_function_is_denied_only_where_its_variables_depend_on_each_other() {
    let text = "title = \"mixed\"\n[coordinates]\nx = { initial = 0.7, momentum = 0.4 }\n\
                y = { initial = 0.3, momentum = -0.2 }\n[hamiltonian]\nH = \"p_x^2/2 + p_y^2/2 + x*y\"\n";
    let law = "[[transformations]]\nname = \"mixed\"\ntypes = [\"F3\", \"F4\"]\n\
               F = \"-p_x*a - 0.2*p_x^2*a + p_y*d*(1 + 0.3*a)\"\nnew = [\"a\", \"b\", \"c\", \"d\"]\n";
    let arguments = ["derive", "system.toml", "--format", "json"];
    let found = with_file(&format!("{text}{law}"), &arguments).json();
    let functions = &found["transformations"][0]["generating_functions"];
    for name in ["F1", "F2", "F1, F4", "F4, F3"] {
        assert!(functions[name]["F"].is_string(), "{name}: {functions}");
    }
    // neither c nor d is there to replace y
    for name in ["F3", "F4"] {
        assert_eq!(functions[name]["exists"], json!(false), "{name}: {functions}");
    }
}

/// A boost, Q = q − ct, P = p − mc, and its inverse by the function of the third kind.
#[test]
fn with_the_time() {
    let boost = "[[transformations]]\nname = \"boost\"\nkind = \"F2\"\nF = \"(q - c*t)*(B + m*c)\"\n\
                 new = [\"A\", \"B\"]";
    let back = made("back", "inverse", "\"boost\"", "\"X\", \"Y\"");
    let by_hand = "[[transformations]]\nname = \"by hand\"\nkind = \"F3\"\nF = \"-(U - c*t)*(p_q + m*c)\"\n\
                   new = [\"U\", \"V\"]";
    let found = derived(&[boost, &back, by_hand]);
    let rename = |value: &Value| -> String {
        value.as_str().expect("K").replace('X', "U").replace('Y', "V")
    };
    assert_eq!(found[1]["new"]["X"], found[2]["new"]["U"]);
    assert_eq!(found[1]["new"]["Y"], found[2]["new"]["V"]);
    assert_eq!(rename(&found[1]["K"]), rename(&found[2]["K"]));
}

/// Valences are multiplied, and a map that is not canonical stays so.
#[test]
fn scale_transformations_make_a_group_with_their_valences() {
    let two = "[[transformations]]\nname = \"two\"\nkind = \"explicit\"\nQ = { A = \"2*q\" }\nP = { B = \"p_q\" }";
    let three = "[[transformations]]\nname = \"three\"\nkind = \"explicit\"\nQ = { C = \"q\" }\nP = { D = \"3*p_q\" }";
    let six = made("six", "compose", "\"two\", \"three\"", "\"X\", \"Y\"");
    let half = made("half", "inverse", "\"two\"", "\"U\", \"V\"");
    let none = made("none", "compose", "\"two\", \"half\"", "\"R\", \"S\"");
    let found = derived(&[two, three, &six, &half, &none]);
    let valences: Vec<&Value> = found.iter().map(|one| &one["valence"]).collect();
    assert_eq!(valences[..4], [&json!("2"), &json!("3"), &json!("6"), &json!("1/2")]);
    assert_eq!(found[2]["canonical"], false);
    assert_eq!(found[4]["canonical"], true);
    assert_eq!(found[2]["failing_brackets"][0]["is"], "6");
    assert_eq!(found[0]["generating_functions"], json!({}));
}

#[test]
fn what_is_made_of_nothing_is_an_error() {
    let check = |rest: &[&str], words: &[&str]| {
        let text = format!("{FREE}{}", rest.join("\n"));
        with_file(&text, &["derive", "system.toml"]).fails(65, words);
    };
    check(
        &[&made("b", "inverse", "\"sher\"", ""), SHEAR],
        &["unknown transformation `sher`: only those above this one"],
    );
    check(&[SHEAR, &made("b", "inverse", "\"sheer\"", "")], &["did you mean `shear`?"]);
    check(
        &[SHEAR, &made("b", "inverse", "\"b\"", "")],
        &["unknown transformation `b`: only those above this one"],
    );
    check(&[SHEAR, &made("b", "compose", "\"shear\"", "")], &["two or more"]);
    check(
        &[SHEAR, &made("b", "inverse", "\"shear\", \"shear\"", "")],
        &["`inverse` needs one other transformation"],
    );
    check(
        &[SHEAR, "[[transformations]]\nname = \"b\"\nkind = \"F2\"\nof = [\"shear\"]\nF = \"q*P\""],
        &["`of`"],
    );
}

/// Zeros are located along a step; of an image that is solved for that is refused with its reason, of one in closed form
/// it is done.
#[test]
fn an_event_on_an_image_that_is_solved_numerically_is_refused() {
    let text = |f: &str, when: &str| {
        format!(
            "title = \"T\"\n[coordinates]\nq = {{ initial = 0.4, momentum = 0.3 }}\n[hamiltonian]\n\
             H = \"p_q^2/2 + q^2/2\"\n[[transformations]]\nname = \"twist\"\nkind = \"F2\"\nnew = [\"Q\", \"P\"]\n\
             F = \"{f}\"\n[[events]]\nname = \"zero\"\nwhen = \"{when}\"\naction = \"mark\"\n"
        )
    };
    let implicit = text("q*P + 0.1*sin(q + P)", "P - 0.1");
    for command in ["check", "run", "derive"] {
        with_file(&implicit, &[command, "system.toml"]).fails(
            65,
            &["zeros cannot be located on `P`", "`twist` has no closed form", "old variables"],
        );
    }
    // a surface that is asked for has no place in the file
    let plain = text("q*P + 0.1*sin(q + P)", "p_q");
    for asked in [
        &["section", "system.toml", "--on", "P - 0.1", "--count", "2"][..],
        &[
            "sweep",
            "system.toml",
            "--grid",
            "q=0.3:0.4:2",
            "--until",
            "1",
            "--measure",
            "crossings=P - 0.1",
        ],
    ] {
        let refused = with_file(&plain, asked);
        assert!(!refused.stderr.contains("[coordinates]"), "{}", refused.stderr);
        refused.fails(2, &["zeros cannot be located on `P`", "old variables"]);
    }
    // beside an error of the file, which is shown in its place, it is reported as well
    let both = with_file(&implicit, &["section", "system.toml", "--on", "P - 0.2", "--count", "2"]);
    assert_eq!(both.stderr.matches("zeros cannot be located on `P`").count(), 2, "{}", both.stderr);
    both.fails(65, &["when = \"P - 0.1\"", "1 error in"]);
    let until = ["run", "system.toml", "--until", "3"];
    assert_eq!(with_file(&text("q*P + 0.1*q^2", "P - 0.1"), &until).code, 0);
    assert_eq!(with_file(&text("q*P + 0.1*sin(q + P)", "p_q - 0.1"), &until).code, 0);
}

/// The differential of each generating function, by differences at points of the map: p dq − P dQ and the like.
fn check_functions(given: &str, old: [&str; 2], expected: [bool; 4]) {
    let found = derived(&[given]).remove(0);
    let functions = &found["generating_functions"];
    for (k, name) in ["F1", "F2", "F3", "F4"].iter().enumerate() {
        let one = &functions[name];
        let Some(text) = one["F"].as_str() else {
            assert!(!expected[k], "{name}: {one}");
            assert!(
                one["why"].as_str().is_some_and(|why| why.contains("not independent")),
                "{one}"
            );
            continue;
        };
        assert!(expected[k], "{name} = {text}");
        let mut model = names(&["z"], &["q", "pq", "Q", "P", "m", "c"]);
        let mut expression = |text: &str| read(&mut model, &text.replace("p_q", "pq"));
        let function = expression(text);
        let map = old.map(&mut expression);
        let value = |e, q: f64, p: f64, new: [f64; 2]| {
            model.pool.evaluate(e, &|s| match model.pool.symbol_info(s).name.as_str() {
                "q" => q,
                "pq" => p,
                "Q" => new[0],
                "P" => new[1],
                "m" => 1.3,
                "c" => 2.0,
                _ => 0.0,
            })
        };
        let image = |q: f64, p: f64| map.map(|e| value(e, q, p, [0.0; 2]));
        for seed in 0..6 {
            let mut at = names(&["u", "v"], &[]);
            let [u, v] = ["u", "v"].map(|name| at.pool.symbol(name));
            let (q, p) = (0.9 + 0.1 * sample(seed)(u), 0.3 + 0.1 * sample(seed)(v));
            let [new_q, new_p] = image(q, p);
            for (dq, dp) in [(1.0, 0.0), (0.0, 1.0), (0.6, -0.8)] {
                let h = 1e-5;
                let ends = [h, -h].map(|h| {
                    let (q, p) = (q + h * dq, p + h * dp);
                    let new = image(q, p);
                    (value(function, q, p, new), new)
                });
                let slope = |a: f64, b: f64| (a - b) / (2.0 * h);
                let left = slope(ends[0].0, ends[1].0);
                let [d_q, d_p] = [0, 1].map(|i| slope(ends[0].1[i], ends[1].1[i]));
                let old = if k < 2 { p * dq } else { -q * dp };
                let new = if k % 2 == 0 { -new_p * d_q } else { new_q * d_p };
                assert!((left - old - new).abs() < 1e-6, "{name} = {text}: {left} {}", old + new);
            }
        }
    }
}

/// F2 = q P + h H(q, P) of a particle with the mass 1 + q²: p is quadratic in P, but Q = q + h P/(1 + q²) is linear, so that F1 has
/// no root in it and holds on both branches. By hand F1 = ½ h q² − (1 + q²)(Q − q)²/(2h).
#[test]
fn legendre_transforms_choose_no_branch() {
    let found = phaselab(&["derive", "two-roots", "--format", "json"]).json();
    let function = found["transformations"][0]["generating_functions"]["F1"]["F"].as_str();
    let function = function.expect("F1");
    let mut model = names(&["z"], &["q", "Q", "h"]);
    let [function, by_hand] =
        [function, "h*q^2/2 - (1 + q^2)*(Q - q)^2/(2*h)"].map(|text| read(&mut model, text));
    for seed in 0..20 {
        let sample = sample(seed);
        let at = |s| sample(s) * if seed % 2 == 0 { 1.0 } else { -1.7 };
        let values = [function, by_hand].map(|e| model.pool.evaluate(e, &at));
        assert!((values[0] - values[1]).abs() < 1e-12 * (1.0 + values[1].abs()), "{values:?}");
    }
}

/// A turn by a, twice: H = (p² + q²)/2 keeps its form, and nothing is divided by cos 2a.
#[test]
fn k_of_a_linear_map_is_short() {
    let found = phaselab(&["derive", "four-generators", "--format", "json"]).json();
    let all = found["transformations"].as_array().expect("a list");
    let twice = all.iter().find(|one| one["name"] == "twice").expect("a composition");
    assert_eq!(twice["K"], "1/2*P5^2 + 1/2*Q5^2");
}

/// Those of a linear map are written by its coefficients, and nothing is multiplied out: `twice` is a turn by 2a.
#[test]
fn generating_functions_of_a_linear_map_are_short() {
    let found = phaselab(&["derive", "four-generators", "--format", "json"]).json();
    let all = found["transformations"].as_array().expect("a list");
    let twice = all.iter().find(|one| one["name"] == "twice").expect("a composition");
    for name in ["F1", "F2", "F3", "F4"] {
        let one = &twice["generating_functions"][name];
        let function = one["F"].as_str().expect("a function");
        assert!(function.len() < 90, "{name}: {function}");
        assert_eq!(one["proved"], true, "{name}: {function}");
    }
}

#[test]
fn the_other_three_generating_functions() {
    let by = |kind: &str, f: &str| {
        format!("[[transformations]]\nname = \"a\"\nkind = \"{kind}\"\nF = \"{f}\"")
    };
    // the identity, the exchange, a shear
    check_functions(&by("F2", "q*P"), ["q", "p_q"], [false, true, true, false]);
    check_functions(&by("F1", "q*Q"), ["p_q", "-q"], [true, false, false, true]);
    check_functions(&by("F2", "q*P + 1/2*c*q^2"), ["q", "p_q - c*q"], [false, true, true, true]);
    // a general linear map has all four, from whichever it is given by
    let linear = ["2*q + 3*p_q", "q + 2*p_q"];
    let explicit = format!(
        "[[transformations]]\nname = \"a\"\nkind = \"explicit\"\nQ = {{ Q = \"{}\" }}\nP = {{ P = \"{}\" }}",
        linear[0], linear[1]
    );
    check_functions(&explicit, linear, [true; 4]);
    // a point transformation
    let point = by("F2", "q^3*P");
    check_functions(&point, ["q^3", "p_q/(3*q^2)"], [false, true, true, true]);
}

/// F2 = q P + 0.1 (P³ + q⁵) has Q = q + 0.3 P² and p = P + 0.5 q⁴, and so F4 with q = (2 (p − P))^¼. F3 would need
/// q from Q = q + 0.3 (p − 0.5 q⁴)²: it is there wherever ∂Q/∂q does not vanish, but has no closed form.
#[test]
fn a_function_without_a_closed_form_is_not_said_to_be_none() {
    let text = "[[transformations]]\nname = \"a\"\nkind = \"F2\"\nF = \"q*P + 0.1*P^3 + 0.1*q^5\"";
    let found = derived(&[text]).remove(0);
    let functions = &found["generating_functions"];
    assert!(functions["F4"]["F"].is_string() && functions["F2"]["F"].is_string(), "{functions}");
    let third = &functions["F3"];
    assert_eq!((&third["F"], &third["exists"]), (&json!(null), &json!(true)), "{functions}");
    let why = "exists where p and Q are independent; no closed form of it was found";
    assert_eq!(third["why"], why);
    // the identity has none of this type
    let text = "[[transformations]]\nname = \"a\"\nkind = \"F2\"\nF = \"q*P\"";
    let found = derived(&[text]).remove(0);
    let first = &found["generating_functions"]["F1"];
    assert_eq!(first["exists"], false);
    assert_eq!(first["why"], "none: q and Q are not independent");
}

/// A determinant that is too long to be written down does not vanish for that. At the start computer algebra gives those that the
/// types F4, (F2, F4), (F3, F4) and (F1, F3) need as 0.0215, −0.0096, 0.0112 and 1.
#[test]
fn a_determinant_too_long_to_be_written_does_not_vanish() {
    let text = "title = \"T\"\n[coordinates]\nx = { initial = 0.7, momentum = 0.4 }\ny = { initial = 0.3, momentum = -0.2 }\n\
        [hamiltonian]\nH = \"p_x^2/2 + p_y^2/2 + x^4/4 + x*y + y^2\"\n[[transformations]]\nname = \"one\"\n\
        types = [\"F1\", \"F2\"]\nF = \"x*Q1 + 0.2*x^2*Q1*y + y*P2 + 0.1*Q1*P2*x\"\n";
    let found = with_file(text, &["derive", "system.toml", "--format", "json"]).json();
    let functions = &found["transformations"][0]["generating_functions"];
    for name in ["F4", "F2, F4", "F3, F4", "F1, F3"] {
        assert!(functions[name].is_object(), "{functions}");
        assert_ne!(functions[name]["exists"], false, "{name}: {functions}");
    }
    assert_eq!(functions["F1"]["exists"], false, "{functions}");
}

/// F = x A₁ + y B₂ + c x y, of type F1 in the first pair and F2 in the second: A₁ = p_x − c y, A₂ = y, B₁ = −x, B₂ = p_y − c x,
/// and by hand five of the sixteen choices have independent variables. None is the same for both pairs.
#[test]
fn of_mixed_types_the_others_that_exist() {
    let text = "title = \"T\"\n[coordinates]\nx = { initial = 0.3, momentum = 0.2 }\ny = { initial = 0.1, momentum = 0.4 }\n\
        [parameters]\nc = 0.7\n[hamiltonian]\nH = \"p_x^2/2 + p_y^2/2\"\n[[transformations]]\nname = \"a\"\n\
        types = [\"F1\", \"F2\"]\nF = \"x*A1 + y*B2 + c*x*y\"\nnew = [\"A1\", \"A2\", \"B1\", \"B2\"]\n";
    let found = with_file(text, &["derive", "system.toml", "--format", "json"]).json();
    let functions = found["transformations"][0]["generating_functions"].as_object().expect("some");
    assert_eq!(functions.len(), 16);
    let mut model = names(&["z"], &["x", "y", "px", "py", "A1", "B1", "A2", "B2", "c"]);
    let expected = [
        ("F1, F2", "x*A1 + y*B2 + c*x*y"),
        ("F1, F3", "x*A1 - py*A2 + c*x*A2"),
        ("F4, F2", "px*B1 + y*B2 - c*y*B1"),
        ("F4, F3", "px*B1 - py*A2 - c*A2*B1"),
        ("F3, F4", "-(px - A1)*(py - B2)/c"),
    ];
    for (name, one) in functions {
        let by_hand = expected.iter().find(|(known, _)| known == name);
        let written = one["F"].as_str();
        assert_eq!(written.is_some(), by_hand.is_some(), "{name}: {one}");
        match (written, by_hand) {
            (Some(written), Some((_, by_hand))) => {
                let written = written.replace("p_x", "px").replace("p_y", "py");
                let both = [written.as_str(), *by_hand].map(|text| read(&mut model, text));
                let apart = model.pool.sub(both[0], both[1]);
                assert_eq!(
                    model.pool.is_zero(apart),
                    phaselab::expr::Zero::Proved,
                    "{name} = {written}"
                );
                assert_eq!(one["proved"], true, "{name}");
            }
            _ => assert!(
                one["why"].as_str().is_some_and(|why| why.contains("not independent")),
                "{one}"
            ),
        }
    }
}

/// Symplectic Euler is F2 = q P + h H(q, P); Störmer and Verlet's step is one of half the length and then the inverse of one
/// backwards: the map of these generating functions is the step that the method takes, to rounding.
/// Source: Hairer, Lubich & Wanner, *Geometric Numerical Integration*, §§ II.4, VI.5.
#[test]
fn a_step_of_the_leapfrog_is_a_composition_of_generating_functions() {
    let file = "title = \"T\"\n[coordinates]\nq = { initial = 0.8, momentum = 0.5 }\n[parameters]\nh = 0.1\n\
                [hamiltonian]\nH = \"p_q^2/2 - cos(q)\"\n";
    let euler = |name: &str, sign: &str, new: &str| {
        format!(
            "[[transformations]]\nname = \"{name}\"\nkind = \"F2\"\nnew = [{new}, \"{name}P\"]\n\
             F = \"q*{name}P {sign} 1/2*h*({name}P^2/2 - cos(q))\"\n"
        )
    };
    let text = format!(
        "{file}{}{}{}\n{}\n",
        euler("a", "+", "\"aQ\""),
        euler("b", "-", "\"bQ\""),
        made("c", "inverse", "\"b\"", "\"cQ\", \"cP\""),
        made("step", "compose", "\"a\", \"c\"", "\"X\", \"Y\"")
    );
    let maps = with_file(&text, &["derive", "system.toml", "--format", "json"]).json();
    for map in maps["transformations"].as_array().expect("a list") {
        assert_eq!((&map["canonical"], &map["proved"]), (&json!(true), &json!(true)), "{map}");
    }
    check_step(&text, "leapfrog", 0.1, [["X", "q"], ["Y", "p_q"]]);
}

/// Whether new variables at the start are old ones after one step of a method, to rounding.
fn check_step(text: &str, method: &str, step: f64, pairs: [[&str; 2]; 2]) {
    let row = |words: &[&str]| -> (Vec<String>, Vec<f64>) {
        let words = [&["run", "system.toml", "--format", "json"], words].concat();
        // the long step is warned of on standard error
        let found: Value =
            serde_json::from_str(&with_file(text, &words).stdout).expect("an object");
        let names = found["columns"].as_array().expect("columns").iter();
        let last = found["rows"].as_array().expect("rows").last().expect("a row").as_array();
        let last = last.expect("a row").iter().map(|x| x.as_f64().unwrap_or(f64::NAN)).collect();
        (names.map(|name| name.as_str().expect("a name").to_owned()).collect(), last)
    };
    let of = |(names, row): &(Vec<String>, Vec<f64>), name: &str| {
        row[names.iter().position(|n| n == name).unwrap_or_else(|| panic!("{name}: {names:?}"))]
    };
    let observed = pairs.map(|[new, _]| format!("{new}={new}"));
    let start = row(&["--at", "0", "--observe", &observed[0], "--observe", &observed[1]]);
    let step = step.to_string();
    let stepped = row(&["--method", method, "--step", &step, "--at", &step]);
    for [new, old] in pairs {
        let (map, taken) = (of(&start, new), of(&stepped, old));
        assert!((map - taken).abs() < 1e-15, "{method}: {new} = {map}, {old} = {taken}");
        // and that is no accident of a step that does nothing
        assert!((taken - of(&start, old)).abs() > 0.01, "{method}: {old} = {taken}");
    }
}

/// The shipped preset's map is the method's step; so it is where H does not separate, at two degrees of freedom, where
/// the map is solved numerically as the step is, and explicit Euler's map is not.
#[test]
fn a_step_of_symplectic_euler_is_the_map_of_its_generating_function() {
    let preset = include_str!("../../../presets/canonical/symplectic-euler.toml");
    check_step(preset, "symplectic-euler", 0.1, [["Q1", "q"], ["P1", "p_q"]]);
    let explicit = std::panic::catch_unwind(|| {
        check_step(preset, "symplectic-euler", 0.1, [["Q2", "q"], ["P2", "p_q"]]);
    });
    assert!(explicit.is_err(), "a step of explicit Euler is another map");
    let entangled = "title = \"T\"\n\
        [coordinates]\nx = { initial = 0.8, momentum = 0.5 }\ny = { initial = -0.3, momentum = 0.7 }\n\
        [parameters]\nh = 0.05\n[hamiltonian]\nH = \"(1 + x^2)*p_x^2/2 + p_y^2/(2 + cos(x*y)) + x^4*p_y + sin(y)\"\n\
        [[transformations]]\nname = \"step\"\nkind = \"F2\"\nnew = [\"X\", \"Y\", \"U\", \"V\"]\n\
        F = \"x*U + y*V + h*((1 + x^2)*U^2/2 + V^2/(2 + cos(x*y)) + x^4*V + sin(y))\"\n";
    check_step(entangled, "symplectic-euler", 0.05, [["X", "x"], ["U", "p_x"]]);
    check_step(entangled, "symplectic-euler", 0.05, [["Y", "y"], ["V", "p_y"]]);
}

/// Q = λ q, P = μ p with λ μ = 1: F2 = λ q P, F3 = −p Q/λ, K = Q²/(2 λ²) + ½ λ² P² for H = ½ p² + ½ q², with μ written by λ.
/// Where λ μ is not 1 there is no function, and K = λ μ H.
#[test]
fn a_scale_transformation_with_reciprocal_scales_has_its_functions() {
    let text = |scales: &str, [q, p]: [&str; 2]| {
        format!(
            "title = \"T\"\n[coordinates]\nq = {{ initial = 1.0, momentum = 0.3 }}\n[parameters]\n{scales}\n\
             [hamiltonian]\nH = \"p_q^2/2 + q^2/2\"\n[[transformations]]\nname = \"scaled\"\nkind = \"explicit\"\n\
             Q = {{ Q = \"{q}\" }}\nP = {{ P = \"{p}\" }}\n"
        )
    };
    let derived = |text: &str| {
        let found = with_file(text, &["derive", "system.toml", "--format", "json"]).json();
        found["transformations"][0].clone()
    };
    let value = |text: &str, values: &[(&str, f64)]| {
        let mut model = names(&["z"], &["q", "pq", "Q", "P", "lambda", "mu", "a", "b"]);
        let e = read(&mut model, &text.replace("p_q", "pq"));
        let other = sample(5);
        model.pool.evaluate(e, &|s| {
            let name = model.pool.symbol_info(s).name.as_str();
            let given = values.iter().find(|(given, _)| *given == name);
            given.map_or_else(|| other(s), |&(_, value)| value)
        })
    };
    let same = |found: &Value, expected: &str, values: &[(&str, f64)]| {
        let found = found.as_str().unwrap_or_else(|| panic!("no {expected}: {found}"));
        let [is, expected] = [found, expected].map(|text| value(text, values));
        assert!(
            (is - expected).abs() < 1e-12 * (1.0 + expected.abs()),
            "{found}: {is}, {expected}"
        );
    };
    let by_names = ["lambda*q", "mu*p_q"];
    for (scales, written, values) in [
        ("", ["2*q", "p_q/2"], [("lambda", 2.0), ("mu", 0.5)]),
        ("", ["10*q", "0.1*p_q"], [("lambda", 10.0), ("mu", 0.1)]),
        ("lambda = 2.0\nmu = 0.5", by_names, [("lambda", 2.0), ("mu", 0.5)]),
        ("lambda = 3.0\nmu = 0.3333333333333333", by_names, [("lambda", 3.0), ("mu", 1.0 / 3.0)]),
        ("lambda = -4.0\nmu = -0.25", by_names, [("lambda", -4.0), ("mu", -0.25)]),
    ] {
        let found = derived(&text(scales, written));
        assert_eq!(found["canonical"], json!(true), "{scales}: {found}");
        let functions = &found["generating_functions"];
        same(&functions["F2"]["F"], "lambda*q*P", &values);
        same(&functions["F3"]["F"], "-p_q*Q/lambda", &values);
        for name in ["F1", "F4"] {
            assert_eq!(functions[name]["exists"], json!(false), "{name}: {functions}");
        }
        same(&found["K"], "Q^2/(2*lambda^2) + lambda^2*P^2/2", &values);
        if !scales.is_empty() {
            assert_eq!(found["canonical_where"], json!({ "mu": "1/lambda" }));
            // no product that is known to be 1 is left
            let words = [&found["K"], &functions["F2"]["F"], &functions["F3"]["F"]];
            assert!(words.iter().all(|e| !e.as_str().unwrap().contains("mu")), "{words:?}");
            for one in [&functions["F2"], &functions["F3"]] {
                assert_eq!(one["proved"], json!(true));
            }
        }
    }
    // one of three parameters: 5 λ a b = 3 (a + λ)
    let three = "lambda = 2.0\na = 3.0\nb = 0.5";
    let found = derived(&text(three, ["lambda*a*b*q", "p_q/(a + lambda)*5/3"]));
    let solved = found["canonical_where"].as_object().unwrap_or_else(|| panic!("{found}"));
    assert_eq!(solved.len(), 1);
    for (name, solved) in solved {
        let solved = value(solved.as_str().expect("an expression"), &[]);
        same(&json!("5*lambda*a*b/(3*(a + lambda))"), "1", &[(name.as_str(), solved)]);
    }
    let pairs = "title = \"T\"\n[coordinates]\nx = { initial = 1.0, momentum = 0.3 }\ny = { initial = 1.0, momentum = 0.3 }\n\
                 [parameters]\na = 2.0\nb = 0.5\nc = 4.0\nd = 0.25\n[hamiltonian]\nH = \"p_x^2/2 + p_y^2/2\"\n\
                 [[transformations]]\nname = \"both\"\nkind = \"explicit\"\n\
                 Q = { X = \"a*x\", Y = \"c*y\" }\nP = { PX = \"b*p_x\", PY = \"d*p_y\" }\n";
    assert_eq!(derived(pairs)["canonical_where"], json!({ "b": "1/a", "d": "1/c" }));
    let wrong = derived(&text("lambda = 2.0\nmu = 0.75", by_names));
    assert_eq!((&wrong["canonical"], &wrong["valence"]), (&json!(false), &json!("lambda*mu")));
    assert_eq!(
        (&wrong["canonical_where"], &wrong["generating_functions"]),
        (&Value::Null, &json!({}))
    );
    same(&wrong["K"], "lambda*mu*(Q^2/(2*lambda^2) + P^2/(2*mu^2))", &[]);
    let shown = with_file(&text("lambda = 2.0\nmu = 0.5", by_names), &["derive", "system.toml"]);
    let shown = shown.success();
    for line in ["with μ = 1/λ:", "F2 = λ q P", "K = Q²/(2 λ²) + ½ λ² P²"] {
        assert!(shown.contains(line), "{line}: {shown}");
    }
}

/// P = (r/c)^(1/s) with r² = p² + m² ω² q² has [Q, P] = m ω/(f f′), f = c P^s: one for s = ½ and c = √(2 m ω) alone. There K = ω P
/// and F1 = ½ m ω q² cot Q.
#[test]
fn the_f_of_p_that_is_searched_for_has_its_hamiltonian() {
    let preset =
        phaselab::preset::Catalog::with_folder(None).find("finding-f").expect("a preset").text;
    let text = preset.replace("c     = { value = 1.0", "c     = { value = 2.0");
    let text = text.replace("s     = { value = 1.0", "s     = { value = 0.5");
    let text = &text[..text.find("[expect]").expect("claims")];
    let found = with_file(text, &["derive", "system.toml", "--format", "json"]).json();
    let found = &found["transformations"][0];
    assert_eq!(found["canonical"], json!(true), "{found}");
    assert_eq!(found["canonical_where"]["s"], json!("1/2"), "{found}");
    assert_eq!(found["K"], json!("omega*P"), "{found}");
    let text =
        found["generating_functions"]["F1"]["F"].as_str().unwrap_or_else(|| panic!("{found}"));
    let mut model = names(&["z"], &["q", "Q", "m", "omega"]);
    let [f, expected] = [text, "m*omega*q^2/(2*tan(Q))"].map(|text| read(&mut model, text));
    for seed in 0..5 {
        let at = sample(seed);
        let [f, expected] = [f, expected].map(|e| model.pool.evaluate(e, &at));
        assert!((f - expected).abs() < 1e-12 * expected.abs(), "{text}");
    }
}
