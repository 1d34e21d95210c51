//! Transformations one after the other, of which some have no closed form, the new Hamiltonian of compositions, and what a
//! transformation lacks of being canonical: against images found by halving intervals, and closed forms.

use nalgebra::Matrix4;
use serde_json::json;

use super::transformations_made::{FREE, SHEAR, made};
use super::with_file;

/// F2 = q P + a sin q cosh P cannot be solved in closed form; its image is found by halving intervals.
fn solved_by_halving(a: f64, [q, p]: [f64; 2]) -> [f64; 2] {
    let (mut low, mut high) = (p - 1.0, p + 1.0);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if middle + a * q.cos() * middle.cosh() < p { low = middle } else { high = middle }
    }
    [q + a * q.sin() * low.sinh(), low]
}

/// Maps that cannot be written down are applied one after the other, with an inverse and a map that can; the whole is canonical
/// where all parts are.
#[test]
fn maps_without_a_closed_form_are_composed() {
    let unsolved = |name: &str, new: &str| {
        format!(
            "[[transformations]]\nname = \"{name}\"\nkind = \"F2\"\nF = \"q*{new}P + 1/20*sin(q)*cosh({new}P)\"\n\
             new = [\"{new}Q\", \"{new}P\"]"
        )
    };
    let square = "[[transformations]]\nname = \"square\"\nkind = \"explicit\"\nQ = { sQ = \"q^2\" }\nP = { sP = \"p_q\" }";
    let text = [
        FREE.to_owned(),
        unsolved("a", "a"),
        made("b", "inverse", "\"a\"", "\"bQ\", \"bP\""),
        made("none", "compose", "\"a\", \"b\"", "\"X\", \"Y\""),
        made("twice", "compose", "\"a\", \"a\"", "\"U\", \"V\""),
        SHEAR.to_owned(),
        made("three", "compose", "\"twice\", \"shear\"", "\"R\", \"S\""),
        made("back", "inverse", "\"three\"", "\"C\", \"D\""),
        made("again", "compose", "\"three\", \"back\"", "\"M\", \"N\""),
        square.to_owned(),
        made("wrong", "compose", "\"a\", \"square\"", "\"wQ\", \"wP\""),
    ]
    .join("\n");
    let found = with_file(&text, &["derive", "system.toml", "--format", "json"]).json();
    for one in found["transformations"].as_array().expect("a list") {
        let is = !matches!(one["name"].as_str(), Some("square" | "wrong"));
        assert_eq!(
            (&one["canonical"], &one["proved"]),
            (&json!(is), &json!(one["name"] != "wrong")),
            "{one}"
        );
        if is {
            assert!(one["residual"].as_f64().unwrap() < 1e-13, "{one}");
        }
        if one["name"] == "wrong" {
            assert!(one["why"].as_str().unwrap().contains("`square` is not canonical"), "{one}");
        }
    }
    let names = ["q", "p_q", "X", "Y", "U", "V", "R", "S", "M", "N"];
    let mut words = vec!["run", "system.toml", "--until=2", "--every=0.25", "--format=json"];
    let observed: Vec<String> = names[2..].iter().map(|name| format!("--observe={name}")).collect();
    words.extend(observed.iter().map(String::as_str));
    let rows = with_file(&text, &words).json();
    let columns = rows["columns"].as_array().expect("columns");
    let place = names.map(|name| columns.iter().position(|c| c == name).expect("a column"));
    for row in rows["rows"].as_array().expect("rows") {
        let [q, p, x, y, u, v, r, s, m, n] =
            place.map(|k| row[k].as_f64().unwrap_or_else(|| panic!("no value: {row}")));
        let once = solved_by_halving(0.05, [q, p]);
        let twice = solved_by_halving(0.05, once);
        // the shear is (q + p², p)
        let expected = [q, p, twice[0], twice[1], twice[0] + twice[1] * twice[1], twice[1], q, p];
        for (value, expected) in [x, y, u, v, r, s, m, n].iter().zip(expected) {
            assert!((value - expected).abs() < 1e-13, "{value} is not {expected}: {row}");
        }
    }
    let found = with_file(&text, &["bracket", "system.toml", "R", "S", "--format=json"]).json();
    let value = found["value"].as_f64().unwrap_or_else(|| panic!("{found}"));
    assert!((value - 1.0).abs() < 1e-13, "{found}");
}

/// Kepler's equation q = x − ½ sin x has no solution in closed form: the inverse of a map with it is solved for.
#[test]
fn an_explicit_map_that_cannot_be_written_backwards_has_an_inverse() {
    let kepler = "[[transformations]]\nname = \"k\"\nkind = \"explicit\"\nQ = { A = \"q - 1/2*sin(q)\" }\n\
                  P = { B = \"p_q/(1 - 1/2*cos(q))\" }";
    let back = made("b", "inverse", "\"k\"", "\"X\", \"Y\"");
    let both = made("c", "compose", "\"b\", \"k\"", "\"U\", \"V\"");
    let text = [FREE, kepler, &back, &both].join("\n");
    let found = with_file(&text, &["derive", "system.toml", "--format", "json"]).json();
    for one in found["transformations"].as_array().expect("a list") {
        assert_eq!((&one["canonical"], &one["proved"]), (&json!(true), &json!(true)), "{one}");
    }
    let words = ["run", "system.toml", "--until=2", "--every=0.25", "--format=json"];
    let observed = ["X", "Y", "U", "V"].map(|name| format!("--observe={name}"));
    let words: Vec<&str> = words.into_iter().chain(observed.iter().map(String::as_str)).collect();
    let rows = with_file(&text, &words).json();
    let columns = rows["columns"].as_array().expect("columns");
    let names = ["q", "p_q", "X", "Y", "U", "V"];
    let place = names.map(|name| columns.iter().position(|c| c == name).expect("a column"));
    for row in rows["rows"].as_array().expect("rows") {
        let [q, p, x, y, u, v] = place.map(|k| row[k].as_f64().expect("a value"));
        let (mut low, mut high) = (q - 1.0, q + 1.0);
        for _ in 0..80 {
            let middle: f64 = 0.5 * (low + high);
            if middle - 0.5 * middle.sin() < q { low = middle } else { high = middle }
        }
        let expected = [low, p * (1.0 - 0.5 * low.cos()), q, p];
        for (value, expected) in [x, y, u, v].into_iter().zip(expected) {
            assert!((value - expected).abs() < 1e-13, "{value} is not {expected}: {row}");
        }
    }
}

/// K of maps one after the other is that of each of them in turn: of rotating axes and then polar coordinates it is
/// H − w p_θ, without a division by sin w t; and what multiplies out to less is multiplied out.
#[test]
fn the_new_hamiltonian_of_a_composition_is_short() {
    let text = [
        "title = \"T\"\n[coordinates]\nx = { initial = 0.7, momentum = 0.4 }\ny = { initial = 0.3, momentum = -0.2 }\n\
         [parameters]\nw = 0.8\nu = 1.3\n[hamiltonian]\nH = \"p_x^2/2 + p_y^2/2 + (x^2 + y^2)^2/4\"\n\
         [[transformations]]\nname = \"turn\"\nkind = \"F2\"\n\
         F = \"P1*(x*cos(w*t) + y*sin(w*t)) + P2*(y*cos(w*t) - x*sin(w*t))\"\n\
         [[transformations]]\nname = \"polar\"\nkind = \"F2\"\nF = \"sqrt(x^2 + y^2)*pr + atan2(y, x)*pth\"\n\
         new = [\"r\", \"th\", \"pr\", \"pth\"]\n\
         [[transformations]]\nname = \"boost\"\nkind = \"F2\"\nF = \"(x - u*t)*(G1 + u) + y*G2 - u^2*t/2\"\n\
         new = [\"X1\", \"X2\", \"G1\", \"G2\"]\n",
        &made("both", "compose", "\"turn\", \"polar\"", "\"R\", \"A\", \"B\", \"C\""),
    ]
    .concat();
    let found = with_file(&text, &["derive", "system.toml", "--format", "json"]).json();
    let k = |i: usize| found["transformations"][i]["K"].as_str().unwrap_or_default().to_owned();
    assert_eq!(k(3), "1/2*B^2 + 1/4*R^4 - w*C + 1/2*C^2/R^2", "{found}");
    assert_eq!(k(2), "1/2*G2^2 + 1/4*((X1 + u*t)^2 + X2^2)^2 + 1/2*G1^2 - u^2", "{found}");
}

/// What is cut off at first order in ε lacks −ε² 𝕁 G″ 𝕁 G″ 𝕁 of being canonical, here of G = x² p_y + ½ p_x² + ⅓ y³; a name makes
/// the largest entry a column. Of a generating function there is nothing to name.
#[test]
fn what_a_transformation_lacks_of_being_canonical_has_a_name() {
    let text = "title = \"T\"\n[coordinates]\nx = { initial = 0.7, momentum = 0.4 }\n\
                y = { initial = 0.3, momentum = -0.2 }\n[parameters]\ne = 0.1\n\
                [hamiltonian]\nH = \"(p_x^2 + p_y^2)/2 + (x^2 + 2*y^2)/2\"\n\
                [[transformations]]\nname = \"cut\"\nkind = \"explicit\"\n\
                Q = { A = \"x + e*p_x\", B = \"y + e*x^2\" }\n\
                P = { C = \"p_x - e*2*x*p_y\", D = \"p_y - e*y^2\" }\nresidual = \"lack\"\n\
                [[observables]]\nname = \"half\"\nexpression = \"lack/2\"\n";
    let words =
        ["run", "system.toml", "--until=3", "--every=0.5", "--observe=lack", "--format=json"];
    let found = with_file(text, &words).json();
    let columns = found["columns"].as_array().expect("columns");
    let names = ["x", "y", "p_x", "p_y", "lack", "half"];
    let place = names.map(|name| columns.iter().position(|c| c == name).expect("a column"));
    let unit = Matrix4::new(
        0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0,
    );
    let rows = found["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 7);
    for row in rows {
        let [x, y, _, p, lack, half] = place.map(|k| row[k].as_f64().expect("a number"));
        let second = Matrix4::new(
            2.0 * p,
            0.0,
            0.0,
            2.0 * x,
            0.0,
            2.0 * y,
            0.0,
            0.0,
            0.0,
            0.0,
            1.0,
            0.0,
            2.0 * x,
            0.0,
            0.0,
            0.0,
        );
        let expected = (unit * second * unit * second * unit * 0.01).amax();
        assert!(
            (lack - expected).abs() < 1e-15 && (half - lack / 2.0).abs() < 1e-16,
            "{lack} is not {expected}"
        );
    }
    let function = text.replace(
        "kind = \"explicit\"",
        "kind = \"F2\"\nF = \"x*C + y*D\"\nnew = [\"A\", \"B\", \"C\", \"D\"]",
    );
    let lines =
        function.lines().filter(|line| !line.starts_with("Q = ") && !line.starts_with("P = "));
    let function: Vec<&str> = lines.collect();
    with_file(&function.join("\n"), &["check", "system.toml"])
        .fails(65, &["`residual` is that of an explicit transformation"]);
}

/// K = c₂ (c₁ H + R₁) + R₂: a change of scale multiplies what the maps before it have added.
#[test]
fn a_change_of_scale_counts_in_the_new_hamiltonian() {
    let text = "[coordinates]\nq = { initial = 1.0, momentum = 0.3 }\n[parameters]\ng = 0.7\n\
                [hamiltonian]\nH = \"p_q^2/2 + q^4\"\n\
                [[transformations]]\nname = \"a\"\nkind = \"F2\"\n\
                F = \"q*aP + 1/20*sin(q)*cosh(aP) + g*t*q\"\nnew = [\"aQ\", \"aP\"]\n\
                [[transformations]]\nname = \"scale\"\nkind = \"explicit\"\n\
                Q = { sQ = \"2*q\" }\nP = { sP = \"3*p_q\" }";
    let text = [
        text.to_owned(),
        made("both", "compose", "\"a\", \"scale\"", "\"X\", \"Y\""),
        made("back", "inverse", "\"scale\"", "\"C\", \"D\""),
        made("less", "compose", "\"a\", \"back\"", "\"U\", \"V\""),
    ]
    .join("\n");
    let printed = with_file(&text, &["derive", "system.toml"]).success();
    for right in ["3 p_q² + 6 q⁴ + 6 g q", "p_q²/12 + ⅙ q⁴ + ⅙ g q"] {
        assert!(printed.contains(right), "{right} in\n{printed}");
    }
}
