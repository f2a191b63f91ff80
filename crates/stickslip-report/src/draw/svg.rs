//! A canvas of shapes as text.

use super::png;

use super::canvas::{Anchor, Canvas, Pen};
use crate::colour::{Rgb, hex};
use crate::pack::base64;

/// A picture as SVG. Texts are texts, in a sans-serif font of the reader's system.
pub struct Svg(String);

impl Svg {
    /// A white picture.
    pub fn new([width, height]: [u32; 2]) -> Self {
        Svg(format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"DejaVu Sans, Verdana, sans-serif\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
        ))
    }
}

/// Hundredths of a pixel are enough.
fn short(x: f64) -> String {
    let text = format!("{x:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text {
        "-0" => "0".into(),
        text => text.into(),
    }
}

fn points(points: &[[f64; 2]]) -> String {
    let words: Vec<String> = points
        .iter()
        .map(|[x, y]| format!("{},{}", short(*x), short(*y)))
        .collect();
    words.join(" ")
}

fn escape(text: &str) -> String {
    text.chars()
        .map(|c| match c {
            '&' => "&amp;".into(),
            '<' => "&lt;".into(),
            '>' => "&gt;".into(),
            '"' => "&quot;".into(),
            c if c.is_control() => " ".into(),
            c => c.to_string(),
        })
        .collect()
}

impl Canvas for Svg {
    fn fill(&mut self, shape: &[[f64; 2]], colour: Rgb) {
        self.0 += &format!(
            "<polygon points=\"{}\" fill=\"{}\"/>\n",
            points(shape),
            hex(colour)
        );
    }

    fn line(&mut self, line: &[[f64; 2]], pen: Pen) {
        let dash = pen.dash.map_or_else(String::new, |[on, off]| {
            format!(" stroke-dasharray=\"{} {}\"", short(on), short(off))
        });
        self.0 += &format!(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"{dash}/>\n",
            points(line),
            hex(pen.colour),
            short(pen.width)
        );
    }

    fn text(
        &mut self,
        [x, y]: [f64; 2],
        text: &str,
        size: f64,
        anchor: Anchor,
        colour: Rgb,
        up: bool,
    ) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let (x, y) = (short(x), short(y));
        let turn = match up {
            true => format!(" transform=\"rotate(-90 {x} {y})\""),
            false => String::new(),
        };
        self.0 += &format!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"{anchor}\" fill=\"{}\"{turn}>{}</text>\n",
            short(size),
            hex(colour),
            escape(text)
        );
    }

    fn picture(&mut self, [x, y]: [f64; 2], size: [usize; 2], fine: usize, pixels: &[u8]) {
        let Some(file) = png::file(size, pixels) else {
            return;
        };
        let [w, h] = size.map(|n| short(n as f64 / fine as f64));
        self.0 += &format!(
            "<image x=\"{}\" y=\"{}\" width=\"{w}\" height=\"{h}\" href=\"data:image/png;base64,{}\"/>\n",
            short(x),
            short(y),
            base64(&file)
        );
    }

    fn finish(self: Box<Self>) -> Vec<u8> {
        (self.0 + "</svg>\n").into_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_users_are_escaped() {
        let mut svg = Box::new(Svg::new([10, 10]));
        svg.text(
            [0.0, -0.001],
            "</svg><b a=\"&\">\u{7}",
            9.0,
            Anchor::End,
            [0; 3],
            true,
        );
        let text = String::from_utf8(svg.finish()).unwrap();
        assert!(
            text.contains(">&lt;/svg&gt;&lt;b a=&quot;&amp;&quot;&gt; </text>"),
            "{text}"
        );
        assert!(text.contains("x=\"0\" y=\"0\""));
    }
}
