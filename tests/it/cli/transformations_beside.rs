//! What is said of one transformation is the same whatever other ones are beside it, and however long it took to look for those.

use serde_json::Value;

use super::with_file;

const PLANE: &str = r#"
title = "Plane"
[coordinates]
x = { initial = 0.7, momentum = 0.9 }
y = { initial = -0.4, momentum = 0.5 }
[parameters]
a = 0.3
[hamiltonian]
H = "(p_x^2 + p_y^2)/2 + x^2/2 + y^2 + x*y/3"
"#;

/// Of which no inverse can be written down, and of whose functions some are long.
const LONG: &str = r#"
[[transformations]]
name = "long"
types = ["F1", "F2"]
F = "x*Q1 + y*P2 + a*x^2*Q1*P2/4 + a*sin(y)*P2^2/6 + t*x*y/10"
"#;

/// What `derive` says of each transformation of the plane.
fn derived(laws: &[&str]) -> Vec<Value> {
    let text = format!("{PLANE}{}", laws.concat());
    let found = with_file(&text, &["derive", "system.toml", "--format=json"]).json();
    found["transformations"].as_array().expect("transformations").clone()
}

#[test]
fn a_long_search_for_one_changes_nothing_of_the_next() {
    let identity = "[[transformations]]\nname = \"identity\"\ntypes = [\"F2\", \"F2\"]\nF = \"x*R1 + y*R2\"\n\
                    new = [\"X1\", \"X2\", \"R1\", \"R2\"]\n";
    let moving = "[[transformations]]\nname = \"moving\"\ntypes = [\"F4\", \"F3\"]\n\
                  F = \"p_x*U1 - p_y*Y2 + a*p_x*U1*Y2/3 + t*U1^2/7\"\nnew = [\"Y1\", \"Y2\", \"U1\", \"U2\"]\n";
    let beside = derived(&[LONG, identity, moving]);
    assert_eq!(beside[1]["K"], "1/2*R1^2 + 1/2*R2^2 + 1/2*X1^2 + X2^2 + 1/3*X1*X2");
    for (law, beside) in [identity, moving].into_iter().zip(&beside[1..]) {
        let alone = &derived(&[law])[0];
        for what in ["canonical", "proved", "new", "old", "K", "K_of_old"] {
            assert_eq!(alone[what], beside[what]);
        }
        // they may be written in another order
        let functions = |of: &Value| {
            let all = of["generating_functions"].as_object().expect("functions").clone();
            all.into_iter().map(|(name, one)| (name, one["F"].is_null(), one["why"].clone()))
        };
        assert!(functions(alone).eq(functions(beside)), "{alone} {beside}");
    }
}

/// F1 and F2 of a free particle in the plane: of some of the other functions no closed form is found, and the search for each ends.
#[test]
fn a_search_for_functions_ends() {
    let text = "title = \"T\"\n[coordinates]\nx = { initial = 0.7, momentum = 0.9 }\ny = { initial = -0.4, momentum = 0.5 }\n\
                [hamiltonian]\nH = \"p_x^2/2 + p_y^2/2\"\n[[transformations]]\nname = \"m\"\ntypes = [\"F1\", \"F2\"]\n\
                F = \"x*Q1 + y*P2 + x^2*Q1*P2 + x*y\"\n";
    let found = with_file(text, &["derive", "system.toml", "--format=json"]).json();
    let functions = &found["transformations"][0]["generating_functions"];
    let all = functions.as_object().expect("functions");
    assert_eq!(all["F1, F2"]["F"], "x*Q1 + y*P2 + x^2*Q1*P2 + x*y");
    let unwritten = all.values().filter(|one| one["F"].is_null() && one["exists"] == true);
    for one in unwritten {
        assert!(
            one["why"].as_str().expect("why").ends_with("no closed form of it was found"),
            "{one}"
        );
    }
}
