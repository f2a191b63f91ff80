//! A surface of a plane problem as a line over its length.

use std::collections::BTreeMap;

use super::super::chart::Chart;
use super::super::picture::Zoom;
use super::page::Page;
use crate::draw::Canvas;
use crate::sheet::Sheet;
use crate::units::behind;

/// The points of a surface in order, and how far along each is.
pub struct Arc {
    /// The points; one that closes a ring comes twice.
    pub points: Vec<usize>,
    /// Length from the first point `[length]`. From one unconnected part to the next it goes on by the distance between them.
    pub s: Vec<f64>,
    /// Where parts begin, but the first.
    breaks: Vec<usize>,
}

impl Arc {
    /// Goes along the lines of a surface. Points that stand at the same place, at both sides of a sharp edge, follow each other.
    pub fn of(sheet: &Sheet) -> Arc {
        let grid = &sheet.grid;
        let lines = (0..grid.types.len()).filter(|&i| grid.types[i] == 3);
        let lines: Vec<[usize; 2]> = lines.map(|i| [grid.cell(i)[0], grid.cell(i)[1]]).collect();
        let mut from: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        let mut entered = vec![false; grid.points.points.len()];
        for (k, line) in lines.iter().enumerate() {
            from.entry(line[0]).or_default().push(k);
            entered[line[1]] = true;
        }
        let mut done = vec![false; lines.len()];
        let mut chains: Vec<Vec<usize>> = Vec::new();
        // Open chains first, from their beginnings; what is left are rings.
        let starts = (0..lines.len()).filter(|&k| !entered[lines[k][0]]);
        for start in starts.chain(0..lines.len()) {
            if done[start] {
                continue;
            }
            let mut chain = vec![lines[start][0]];
            let mut next = Some(start);
            while let Some(k) = next {
                done[k] = true;
                chain.push(lines[k][1]);
                next = from
                    .get(&lines[k][1])
                    .and_then(|all| all.iter().copied().find(|&k| !done[k]));
            }
            chains.push(chain);
        }
        Arc::join(sheet, chains)
    }

    /// One after the other, the next always the one that begins nearest to where the last ended.
    fn join(sheet: &Sheet, mut chains: Vec<Vec<usize>>) -> Arc {
        let x = |i: usize| sheet.grid.points.points[i];
        let away = |a: usize, b: usize| {
            (0..3)
                .map(|c| (x(a)[c] - x(b)[c]).powi(2))
                .sum::<f64>()
                .sqrt()
        };
        let mut arc = Arc {
            points: Vec::new(),
            s: Vec::new(),
            breaks: Vec::new(),
        };
        while !chains.is_empty() {
            let last = arc.points.last().copied();
            let near = |chain: &Vec<usize>| last.map_or(0.0, |last| away(last, chain[0]));
            // An open chain that nothing leads to begins; afterwards what is nearest.
            let best =
                (0..chains.len()).min_by(|&a, &b| near(&chains[a]).total_cmp(&near(&chains[b])));
            let chain = chains.remove(best.unwrap_or(0));
            if last.is_some() {
                arc.breaks.push(arc.points.len());
            }
            for p in chain {
                let s = match arc.points.last() {
                    Some(&before) => arc.s[arc.s.len() - 1] + away(before, p),
                    None => 0.0,
                };
                arc.points.push(p);
                arc.s.push(s);
            }
        }
        arc
    }
}

impl Arc {
    /// The shear traction on the secondary in the direction in which the arc goes: components along x would change their sign where the surface turns back.
    fn shear(&self, sheet: &Sheet) -> Vec<f64> {
        let x = |i: usize| sheet.grid.points.points[self.points[i]];
        let last = self.points.len().saturating_sub(1);
        let along = |i: usize| {
            let (a, b) = (x(i.saturating_sub(1)), x((i + 1).min(last)));
            let t = [0, 1, 2].map(|c| b[c] - a[c]);
            let length = t.iter().map(|v| v * v).sum::<f64>().sqrt();
            let shear = sheet.shear(self.points[i]);
            (0..3).map(|c| shear[c] * t[c]).sum::<f64>() / length
        };
        (0..self.points.len()).map(along).collect()
    }
}

/// Draws pressure and shear over the arc, with the status below; of a tie the normal traction and shear.
pub fn draw(sheet: &Sheet, page: &Page, canvas: &mut dyn Canvas) -> Result<(), String> {
    let arc = Arc::of(sheet);
    // A break is a point without a value, so that lines are parted there.
    let column = |name: &str| -> Vec<f64> {
        let values = sheet.numbers(name);
        let value = |i: &usize| values.get(*i).copied().unwrap_or(f64::NAN);
        arc.points.iter().map(value).collect()
    };
    let with_breaks = |values: &[f64], gap: f64| -> Vec<f64> {
        let mut out = Vec::with_capacity(values.len() + arc.breaks.len());
        for (i, v) in values.iter().enumerate() {
            if arc.breaks.contains(&i) {
                out.push(if gap.is_nan() { gap } else { *v });
            }
            out.push(*v);
        }
        out
    };
    let s = with_breaks(&arc.s, 0.0);
    let tied = sheet.tied();
    let name = if tied { "TNORMAL" } else { "CPRESS" };
    let normal = with_breaks(&column(name), f64::NAN);
    let status = match tied {
        true => Vec::new(),
        false => with_breaks(&column("CSTATUS"), f64::NAN),
    };
    let shear = with_breaks(&arc.shear(sheet), f64::NAN);
    // A tie carries everywhere.
    let pressure: &[f64] = if tied { &[] } else { &normal };
    let most = pressure.iter().copied().fold(0.0, f64::max);
    let end = s.last().copied().unwrap_or(0.0);
    let pressing = s.iter().zip(pressure).filter(|(_, p)| **p > 1e-3 * most);
    let patch = crate::field::range(pressing.map(|(s, _)| *s));
    let [from, to] = match (page.zoom, patch) {
        (Zoom::Contact, None) => {
            return Err(
                "nothing presses at this time: there is no patch of contact to zoom on".into(),
            );
        }
        (Zoom::Whole, _) | (_, None) => [0.0, end],
        (zoom, Some([a, b])) => {
            let half = match zoom {
                Zoom::Times(times) => 0.5 * end / times,
                _ => (0.75 * (b - a)).max(0.01 * end),
            };
            let middle = (a + b) / 2.0;
            [(middle - half).max(0.0), (middle + half).min(end)]
        }
    };
    let stress = behind(&page.units.stress);
    let names = [
        match tied {
            true => format!("normal traction TNORMAL{stress}"),
            false => format!("contact pressure CPRESS{stress}"),
        },
        format!("shear traction along it{stress}"),
    ];
    let chart = Chart {
        title: &page.title,
        words: &page.words,
        x: &s,
        along: &format!("length along the surface{}", behind(&page.units.length)),
        from,
        to,
        lines: vec![(&names[0], &normal), (&names[1], &shear)],
        right: Vec::new(),
        statuses: &status,
    };
    let nothing = || "the surface has no values at this time".to_string();
    chart.draw(page.size, canvas).ok_or_else(nothing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use stickslip::io::vtu::Grid;

    #[test]
    fn lines_in_any_order_make_an_arc() {
        let mut grid = Grid::default();
        grid.points.points = (0..6).map(|i| [f64::from(i), 0.0, 0.0]).collect();
        for line in [[2, 3], [0, 1], [1, 2], [4, 5]] {
            grid.types.push(3);
            grid.connectivity.extend(line);
            grid.offsets.push(grid.connectivity.len());
        }
        let sheet = Sheet {
            name: "a".into(),
            grid,
        };
        let arc = Arc::of(&sheet);
        assert_eq!(arc.points, [0, 1, 2, 3, 4, 5]);
        assert_eq!(arc.s, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        assert_eq!(arc.breaks, [4]);
        // A ring is cut where it is first met.
        let mut ring = sheet.clone();
        ring.grid.connectivity = vec![0, 1, 1, 2, 2, 3, 3, 0];
        let arc = Arc::of(&ring);
        assert_eq!(arc.points, [0, 1, 2, 3, 0]);
        assert_eq!(arc.s, [0.0, 1.0, 2.0, 3.0, 6.0]);
    }
}
