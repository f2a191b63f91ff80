//! Plots with logarithmic axes, as SVG.

use std::fmt::Write;

/// A line with marks.
pub struct Series {
    /// What the legend says.
    pub name: String,
    /// Abscissae and ordinates, all positive.
    pub points: Vec<(f64, f64)>,
}

/// One plot.
pub struct Panel {
    /// Above it.
    pub title: &'static str,
    /// Unit of the ordinate.
    pub unit: &'static str,
    /// Its lines.
    pub series: Vec<Series>,
}

/// Size of a panel with its margins, and of what lies inside its axes.
const PANEL: [f64; 2] = [400.0, 340.0];
const LEFT: f64 = 60.0;
const TOP: f64 = 40.0;
const INSIDE: [f64; 2] = [320.0, 240.0];

/// Dark enough on white, and told apart by those who see few colours; marks differ too.
const COLOURS: [&str; 4] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7"];

/// A logarithmic axis.
struct Axis {
    from: f64,
    to: f64,
    length: f64,
}

impl Axis {
    /// An axis over these values, with some room at both ends.
    fn over(values: impl Iterator<Item = f64>, length: f64) -> Self {
        let (from, to) = values
            .map(f64::log10)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
                (a.min(v), b.max(v))
            });
        let (from, to) = if from.is_finite() {
            (from, to)
        } else {
            (0.0, 1.0)
        };
        Axis {
            from: from - 0.15,
            to: to + 0.15,
            length,
        }
    }

    fn at(&self, value: f64) -> f64 {
        (value.log10() - self.from) / (self.to - self.from) * self.length
    }

    /// Values 1, 2 and 5 of each decade on the axis.
    fn ticks(&self) -> Vec<f64> {
        let decades = self.from.floor() as i32..=self.to.ceil() as i32;
        let values = decades.flat_map(|d| [1.0, 2.0, 5.0].map(|k| k * 10f64.powi(d)));
        values
            .filter(|v| (self.from..=self.to).contains(&v.log10()))
            .collect()
    }
}

/// `20000` as `20k`, `0.5` as it is.
fn label(value: f64) -> String {
    match value {
        v if v >= 0.99e6 => format!("{}M", (v / 1e5).round() / 10.0),
        v if v >= 0.99e3 => format!("{}k", (v / 1e2).round() / 10.0),
        v if v >= 0.99 => format!("{}", v.round()),
        v => format!("{}", (v * 1e3).round() / 1e3),
    }
}

/// The panels side by side.
pub fn svg(abscissa: &str, panels: &[Panel]) -> String {
    let width = PANEL[0] * panels.len() as f64;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {}\" width=\"{width}\" height=\"{}\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
        PANEL[1], PANEL[1]
    );
    for (k, panel) in panels.iter().enumerate() {
        let left = PANEL[0] * k as f64 + LEFT;
        // writing to a string cannot fail
        let _ = writeln!(out, "<g transform=\"translate({left} {TOP})\">");
        draw(&mut out, abscissa, panel);
        out.push_str("</g>\n");
    }
    out.push_str("</svg>\n");
    out
}

fn draw(out: &mut String, abscissa: &str, panel: &Panel) {
    let [width, height] = INSIDE;
    let all = || panel.series.iter().flat_map(|s| &s.points);
    let x = Axis::over(all().map(|p| p.0), width);
    let y = Axis::over(all().map(|p| p.1), height);
    let mut put = |text: std::fmt::Arguments| {
        let _ = writeln!(out, "{text}");
    };
    for tick in x.ticks() {
        let at = x.at(tick);
        put(format_args!(
            "<path d=\"M{at:.1} 0V{height}\" stroke=\"#dddddd\"/><text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
            height + 16.0,
            label(tick)
        ));
    }
    for tick in y.ticks() {
        let at = height - y.at(tick);
        put(format_args!(
            "<path d=\"M0 {at:.1}H{width}\" stroke=\"#dddddd\"/><text x=\"-6\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            at + 4.0,
            label(tick)
        ));
    }
    put(format_args!(
        "<rect width=\"{width}\" height=\"{height}\" fill=\"none\" stroke=\"#333333\"/>\
         <text x=\"0\" y=\"-12\" font-size=\"14\">{} [{}]</text>\
         <text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{abscissa}</text>",
        panel.title,
        panel.unit,
        width / 2.0,
        height + 36.0
    ));
    for (k, series) in panel.series.iter().enumerate() {
        let colour = COLOURS[k % COLOURS.len()];
        let places: Vec<(f64, f64)> = series
            .points
            .iter()
            .map(|p| (x.at(p.0), height - y.at(p.1)))
            .collect();
        let path: Vec<String> = places
            .iter()
            .map(|p| format!("{:.1} {:.1}", p.0, p.1))
            .collect();
        put(format_args!(
            "<path d=\"M{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>",
            path.join("L")
        ));
        for (a, b) in places {
            put(format_args!("{}", mark(k, a, b, colour)));
        }
        let row = 20.0 + 18.0 * k as f64;
        put(format_args!(
            "{}<text x=\"26\" y=\"{}\">{}</text>",
            mark(k, 14.0, row - 4.0, colour),
            row,
            series.name
        ));
    }
}

/// A disc or a square.
fn mark(k: usize, a: f64, b: f64, colour: &str) -> String {
    if k.is_multiple_of(2) {
        format!("<circle cx=\"{a:.1}\" cy=\"{b:.1}\" r=\"4\" fill=\"{colour}\"/>")
    } else {
        format!(
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"8\" height=\"8\" fill=\"{colour}\"/>",
            a - 4.0,
            b - 4.0
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_lie_inside_the_axes() {
        let axis = Axis::over([10.0, 1000.0].into_iter(), 100.0);
        assert!(axis.at(10.0) > 0.0 && axis.at(1000.0) < 100.0);
        assert!((axis.at(100.0) - 50.0).abs() < 1e-9);
        assert_eq!(
            axis.ticks(),
            [10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0]
        );
    }

    #[test]
    fn labels_are_short() {
        let labels = [0.05, 0.5, 20.0, 1000.0, 20000.0, 1e6].map(label);
        assert_eq!(labels, ["0.05", "0.5", "20", "1k", "20k", "1M"]);
    }

    #[test]
    fn a_plot_has_a_mark_for_each_point_and_one_in_the_legend() {
        let series = Series {
            name: "a".into(),
            points: vec![(1.0, 2.0), (3.0, 4.0)],
        };
        let text = svg(
            "x",
            &[Panel {
                title: "t",
                unit: "s",
                series: vec![series],
            }],
        );
        assert_eq!(text.matches("<circle").count(), 3);
        assert!(text.starts_with("<svg") && text.ends_with("</svg>\n"));
    }
}
