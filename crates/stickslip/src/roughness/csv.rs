//! Heights as text: numbers separated by commas, semicolons, tabs or spaces.

use super::map::HeightMap;

/// Numbers of a line; a missing one is not a number.
fn numbers(line: &str) -> Option<Vec<f64>> {
    let separator = [',', ';', '\t'].into_iter().find(|&c| line.contains(c));
    let words: Vec<&str> = match separator {
        Some(c) => line.split(c).map(str::trim).collect(),
        None => line.split_whitespace().collect(),
    };
    let number = |word: &&str| match *word {
        "" => Some(f64::NAN),
        word => word.parse().ok(),
    };
    words.iter().map(number).collect()
}

/// Reads a matrix of heights at distances `spacing`, or a list of nodes with their coordinates where none is given.
///
/// # Errors
/// What is wrong, with the line.
pub(super) fn read(text: &str, spacing: Option<[f64; 2]>) -> Result<HeightMap, String> {
    let mut lines = text.lines().enumerate().filter(|(_, line)| {
        let line = line.trim();
        !line.is_empty() && !line.starts_with('#')
    });
    let mut rows: Vec<(usize, Vec<f64>)> = Vec::new();
    if let Some((at, first)) = lines.next() {
        // Names of columns, if it holds no numbers.
        rows.extend(numbers(first).map(|row| (at, row)));
    }
    for (at, line) in lines {
        let row = numbers(line).ok_or_else(|| {
            format!(
                "line {}: there is something that is no number: {line:.60}",
                at + 1
            )
        })?;
        rows.push((at, row));
    }
    let Some((_, first)) = rows.first() else {
        return Err("there are no numbers in it".into());
    };
    let columns = first.len();
    if let Some((at, row)) = rows.iter().find(|(_, row)| row.len() != columns) {
        let count = row.len();
        return Err(format!(
            "line {}: it has {count} numbers, the first one {columns}",
            at + 1
        ));
    }
    match (spacing, columns) {
        (Some(spacing), _) => Ok(HeightMap {
            columns,
            rows: rows.len(),
            spacing,
            heights: rows.into_iter().flat_map(|(_, row)| row).collect(),
            repeat: false,
        }),
        (None, 2 | 3) => listed(&rows, columns - 1),
        (None, _) => Err(format!(
            "it has {columns} numbers a line: a matrix of heights, to which `spacing = [DX, DY]` belongs"
        )),
    }
}

/// A grid from nodes with `axes` coordinates each.
fn listed(rows: &[(usize, Vec<f64>)], axes: usize) -> Result<HeightMap, String> {
    if let Some((at, _)) = rows
        .iter()
        .find(|(_, row)| row[..axes].iter().any(|x| !x.is_finite()))
    {
        return Err(format!("line {}: a coordinate is missing", at + 1));
    }
    let mut grid = [(0.0, 1.0, 1); 2];
    for (axis, grid) in grid.iter_mut().enumerate().take(axes) {
        let mut x: Vec<f64> = rows.iter().map(|(_, row)| row[axis]).collect();
        x.sort_by(f64::total_cmp);
        let (first, last) = (x[0], x[x.len() - 1]);
        x.dedup_by(|b, a| *b - *a <= 1e-9 * (last - first));
        let count = x.len();
        let step = (last - first) / (count as f64 - 1.0);
        if count < 2 {
            return Err("all nodes lie in one place along an axis".into());
        }
        if let Some(pair) = x
            .windows(2)
            // A grid is regular if distances between nodes deviate from their mean by no more than this part of it.
            .find(|p| (p[1] - p[0] - step).abs() > 0.02 * step)
        {
            return Err(format!(
                "nodes are no regular grid: the distance from {:e} to {:e} is not {step:e} as in the mean",
                pair[0], pair[1]
            ));
        }
        *grid = (first, step, count);
    }
    let (columns, lines) = (grid[0].2, grid[1].2);
    let mut heights = vec![f64::NAN; columns.saturating_mul(lines).min(4 * rows.len())];
    if columns * lines > heights.len() {
        return Err(format!(
            "{columns} by {lines} nodes, of which {} are given",
            rows.len()
        ));
    }
    for (_, row) in rows {
        let place = |axis: usize| ((row[axis] - grid[axis].0) / grid[axis].1).round() as usize;
        let j = if axes == 2 { place(1) } else { 0 };
        heights[j * columns + place(0)] = row[axes];
    }
    Ok(HeightMap {
        columns,
        rows: lines,
        spacing: [grid[0].1, grid[1].1],
        heights,
        repeat: false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matrices_and_lists_say_the_same() {
        let matrix = read("# scan\n1, 2, 3\n4, , 6\n", Some([0.5, 2.0])).expect("a matrix");
        let list = "x;y;z\n0;0;1\n0.5;0;2\n1;0;3\n0;2;4\n1;2;6\n";
        let list = read(list, None).expect("a list");
        let same = |a: &f64, b: &f64| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
        assert!(
            matrix
                .heights
                .iter()
                .zip(&list.heights)
                .all(|(a, b)| same(a, b))
        );
        assert_eq!(
            (matrix.columns, matrix.rows, matrix.spacing),
            (3, 2, [0.5, 2.0])
        );
        assert_eq!((list.columns, list.rows, list.spacing), (3, 2, [0.5, 2.0]));
        let profile = read("0 1e-6\n1e-3 2e-6\n2e-3 0", None).expect("a profile");
        assert_eq!((profile.columns, profile.rows), (3, 1));
        assert_eq!(profile.heights, [1e-6, 2e-6, 0.0]);
    }

    #[test]
    fn what_is_no_map_is_said_with_its_line() {
        let cases = [
            ("", None, "no numbers"),
            ("x,z\n", None, "no numbers"),
            ("1 2\n3 four\n", None, "line 2: there is something"),
            ("1,2,3,4\n", None, "spacing"),
            ("1,2\n1,2,3\n", Some([1.0; 2]), "line 2: it has 3 numbers"),
            ("0,1\n1,1\n3,1\n", None, "no regular grid"),
            ("0,1\n,1\n", None, "line 2: a coordinate"),
            ("1,1\n1,2\n", None, "one place"),
            (
                "0,0,1\n1,1,1\n2,2,1\n3,3,1\n4,4,1\n5,5,1\n",
                None,
                "6 by 6 nodes",
            ),
        ];
        for (text, spacing, says) in cases {
            let error = read(text, spacing).expect_err(text);
            assert!(error.contains(says), "{text:?}: {error}");
        }
    }
}
