//! `equilibria`: the balance of forces in words.

use super::with_file;

/// What the forces leave on a disc that stands upright, and what the equations for the multipliers leave on a crank, is rounding: no force of a
/// constraint balances it, and every balance ends with 0.
#[test]
fn forces_that_are_rounding_are_none() {
    let disc = "title = \"Disc\"\n[coordinates]\nth = { initial = 0.4, velocity = 0 }\nf = { initial = 0, velocity = 2 }\n\
                ps = { initial = 0, velocity = -1 }\nx = { initial = 0 }\ny = { initial = 0 }\n[parameters]\nR = 0.5\ng = 9.81\n\
                [lagrangian]\nL = \"1/2*(x'^2 + y'^2 + (R*th'*cos(th))^2) + 1/8*R^2*(th'^2 + f'^2*sin(th)^2) \
                + 1/4*R^2*(ps' + f'*cos(th))^2 - g*R*sin(th)\"\n\
                [[constraints]]\nname = \"a\"\nexpression = \"x' - R*(th'*sin(th)*sin(f) - cos(f)*(ps' + f'*cos(th)))\"\n\
                [[constraints]]\nname = \"b\"\nexpression = \"y' - R*(-th'*sin(th)*cos(f) - sin(f)*(ps' + f'*cos(th)))\"\n";
    let crank = r#"title = "Crank"
[coordinates]
th = { initial = 0.5, velocity = 3.0 }
ph = { initial = "asin(r/l*sin(0.5))" }
x = { initial = "r*cos(0.5)+l*cos(asin(r/l*sin(0.5)))" }
[parameters]
r = 0.4
l = 1.0
g = 9.81
[lagrangian]
L = "1/10*th'^2 + 3/4*x'^2 + 0.3*l^2*ph'^2 - 0.7*g*(r*sin(th) - l/2*sin(ph))"
[[constraints]]
name = "px"
expression = "x - r*cos(th) - l*cos(ph)"
[[constraints]]
name = "py"
expression = "r*sin(th) - l*sin(ph)"
"#;
    for file in [disc, crank] {
        let text = with_file(file, &["equilibria", "system.toml"]).success();
        let balances: Vec<&str> = text.lines().filter(|line| line.contains("δW/δ")).collect();
        assert!(!balances.is_empty(), "{text}");
        for line in balances {
            assert!(line.ends_with("= 0") && !line.contains("e−"), "{line}");
        }
    }
}
