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

#[test]
fn what_is_no_table_is_refused() {
    let unknown = "there is no column `z`; the columns are x, y";
    plotted(DIAGONAL, &["--x", "z"]).fails(2, &[unknown]);
    plotted(DIAGONAL, &["--size", "9x9"]).fails(2, &["COLUMNSxROWS"]);
    plotted("a,b\none,two\n", &[]).fails(2, &["no row has numbers for both `a` and `b`"]);
    plotted("a\n", &[]).fails(65, &["no two columns with rows"]);
}
