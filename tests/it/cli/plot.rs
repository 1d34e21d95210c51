//! `phaselab plot`: tables drawn as text.

use super::{Done, with_file};

/// Draws a table with these options.
fn plotted(table: &str, options: &[&str]) -> Done {
    with_file(table, &[&["plot", "system.toml"], options].concat())
}

/// A table of two columns whose points are the ends of a diagonal and its middle.
const DIAGONAL: &str =
    "# phaselab 0.1.0: A diagonal\n# method: name=taylor\nx,y\n0,0\n5,5\n10,10\n";

fn rows(text: &str) -> Vec<Vec<char>> {
    text.lines().map(|line| line.chars().collect()).collect()
}

#[test]
fn two_columns_are_points_on_axes() {
    let text = plotted(DIAGONAL, &["--ascii", "--size", "60x20"]).success();
    let lines = rows(&text);
    assert_eq!(lines.len(), 20, "{text}");
    assert!(text.starts_with("A diagonal\n") && text.is_ascii(), "{text}");
    assert!(text.contains("10") && text.contains('x') && text.contains('y'), "{text}");
    // the points: one at the lower left, one in the middle, one at the upper right
    let dots = || {
        let inside = lines.iter().enumerate().skip(2).take(15);
        inside.filter_map(|(row, line)| {
            let found = line.iter().rposition(|c| ".'`,-_:\"*".contains(*c))?;
            (found > 8).then_some((row, found))
        })
    };
    let all: Vec<_> = dots().collect();
    assert!(all.len() >= 2 && all[0].1 > all[all.len() - 1].1, "{all:?}\n{text}");
}

/// A lattice of two columns has its third one shaded, from the least to the greatest.
#[test]
fn the_table_of_a_map_is_shaded() {
    let mut table = "a,b,value\n".to_owned();
    for i in 0..20 {
        for j in 0..20 {
            table.push_str(&format!("{i},{j},{}\n", i + j));
        }
    }
    let text = plotted(&table, &["--ascii", "--size", "50x24"]).success();
    assert!(text.starts_with("value: . 0 to # 38"), "{text}");
    let lines = rows(&text);
    let [above, below] = [3, 19].map(|row: usize| lines[row].iter().collect::<String>());
    assert!(above.trim_end().ends_with('#') && !above.contains(" ."), "{text}");
    assert!(below.contains('.') && !below.contains('#'), "{text}");
}

/// Rows of three numbers are points where they are no lattice, however few there are.
#[test]
fn a_table_of_two_rows_is_no_map() {
    for table in ["t,x,y\n0,1,2\n1,3,4\n", "t,x,y\n0,1,2\n1,1,4\n2,3,5\n3,3,5\n"] {
        let text = plotted(table, &["--ascii", "--size", "50x20"]).success();
        assert!(!text.contains(" to # "), "{text}");
    }
    let whole = plotted("a,b,c\n0,1,2\n1,1,4\n0,3,5\n1,3,6\n", &["--ascii"]).success();
    assert!(whole.starts_with("c: . 2 to # 6"), "{whole}");
}

/// The difference of the greatest and the least number may be infinite.
#[test]
fn the_largest_numbers_have_their_shades() {
    let table = "a,b,c\n0,0,-1e308\n0,1,1e308\n1,0,1.7e308\n1,1,-1.7e308\n";
    let text = plotted(table, &["--ascii", "--size", "40x12"]).success();
    let lines = rows(&text);
    // from the upper left: 1e308 and −1.7e308, below −1e308 and 1.7e308
    let shades = |line: &Vec<char>| -> String {
        line.iter().skip(5).filter(|c| ".:+#".contains(**c)).collect()
    };
    let drawn: Vec<String> =
        lines[1..10].iter().map(shades).filter(|line| !line.is_empty()).collect();
    assert_eq!(drawn, ["#.", ".#"], "{text}");
}

/// Of a section the columns after those of the crossing are drawn; of a sweep words and what is the same in all rows are not.
#[test]
fn the_columns_of_other_commands_are_found() {
    let axes = |table: &str| {
        let text = plotted(table, &["--ascii", "--size", "40x12"]).success();
        let across = text.lines().find(|line| line.trim_start().starts_with('+')).unwrap();
        let across = across.rsplit(' ').next().unwrap().to_owned();
        [across, text.lines().next().unwrap().trim().to_owned()]
    };
    assert_eq!(axes("orbit,n,t,y,p_y\n1,1,0.5,1,2\n1,2,0.7,1.5,3\n"), ["y", "p_y"]);
    let section = "orbit,n,t,x,y,p_y\n1,1,0.5,0,1,2\n1,2,0.7,1e-30,1.5,3\n";
    assert_eq!(axes(section), ["y", "p_y"]);
    let sweep = "x0,status,t,x,energy_drift\n0.1,completed,10,1,0\n0.2,completed,10,2,0\n";
    assert_eq!(axes(sweep), ["x0", "x"]);
    // nothing but what is the same
    assert_eq!(axes("a,b\n1,2\n1,2\n"), ["a", "b"]);
}

#[test]
fn what_is_no_table_is_refused() {
    let empty = "no row has numbers for all of `a`, `b` and `c`";
    plotted("a,b,c\n1,2,\n3,4,\n", &["--of", "c"]).fails(2, &[empty]);
    let unknown = "there is no column `z`; the columns are x, y";
    plotted(DIAGONAL, &["--x", "z"]).fails(2, &[unknown]);
    plotted(DIAGONAL, &["--size", "9x9"]).fails(2, &["COLUMNSxROWS"]);
    plotted("a,b\none,two\n", &[]).fails(2, &["no row has numbers for both `a` and `b`"]);
    plotted("a\n", &[]).fails(65, &["no two columns with rows"]);
}
