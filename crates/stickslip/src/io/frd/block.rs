use super::columns;
use super::layout::{Encoding, Layout};

/// What the components of a quantity are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// One number.
    Scalar,
    /// Three components along the axes; programs that read the format make its size of them, `ALL`.
    Vector,
    /// Six components xx yy zz xy yz zx.
    Tensor,
}

impl Shape {
    /// Numbers at a node.
    pub fn count(self) -> usize {
        match self {
            Shape::Scalar => 1,
            Shape::Vector => 3,
            Shape::Tensor => 6,
        }
    }

    /// The number that the format has for it, and the axes of its components.
    fn axes(self) -> (usize, &'static [[usize; 2]]) {
        match self {
            Shape::Scalar => (1, &[[0, 0]]),
            Shape::Vector => (2, &[[1, 0], [2, 0], [3, 0]]),
            Shape::Tensor => (4, &[[1, 1], [2, 2], [3, 3], [1, 2], [2, 3], [3, 1]]),
        }
    }
}

/// A quantity at points.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// Its name, up to eight characters: `DISP`.
    pub name: &'static str,
    /// The names of its components, as many as its shape has.
    pub components: &'static [&'static str],
    /// What they are.
    pub shape: Shape,
    /// Points of the mesh.
    pub points: Vec<usize>,
    /// Its components at these points.
    pub values: Vec<f64>,
}

/// When values were taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// Number of the step, from 1.
    pub step: usize,
    /// Number of the increment in its step.
    pub increment: usize,
    /// `[the problem's unit of time]`.
    pub time: f64,
}

impl Block {
    /// Adds the block, which is the so-manieth of the file and of the so-manieth output, counted from 1.
    pub(super) fn write(
        &self,
        layout: &Layout,
        moment: &Moment,
        block: usize,
        output: usize,
        out: &mut Vec<u8>,
    ) {
        let flag = match layout.encoding {
            Encoding::Text => 1,
            Encoding::Binary => 2,
        };
        let (set, output) = (columns::whole(100 + output, 5), columns::whole(output, 5));
        let head = format!(
            "    1PSTEP{block:>26}{:>12}{:>12}{:10}\n  100CL{set}{}{:>12}{:20} 0{output}{:10}{flag:>2}\n",
            moment.increment,
            moment.step,
            "",
            columns::time(moment.time),
            self.points.len(),
            "",
            ""
        );
        out.extend(head.bytes());
        self.write_names(out);
        let values = self.values.chunks_exact(self.shape.count());
        for (&point, values) in self.points.iter().zip(values) {
            let number = layout.number(point);
            match layout.encoding {
                Encoding::Text => {
                    out.extend(format!(" -1{number:>10}").bytes());
                    values.iter().for_each(|&v| columns::push_value(out, v));
                    out.push(b'\n');
                }
                Encoding::Binary => {
                    out.extend((number as i32).to_le_bytes());
                    out.extend(values.iter().flat_map(|&v| (v as f32).to_le_bytes()));
                }
            }
        }
        if layout.encoding == Encoding::Text {
            out.extend(b" -3\n");
        }
    }

    fn write_names(&self, out: &mut Vec<u8>) {
        let (kind, axes) = self.shape.axes();
        let size = usize::from(self.shape == Shape::Vector);
        let count = self.components.len() + size;
        let mut text = format!(" -4  {:<8}{count:>5}{:>5}\n", self.name, 1);
        for (name, [i, j]) in self.components.iter().zip(axes) {
            text += &format!(" -5  {name:<8}{:>5}{kind:>5}{i:>5}{j:>5}\n", 1);
        }
        if size == 1 {
            // It is named only: readers compute it.
            text += &format!(
                " -5  {:<8}{:>5}{kind:>5}{:>5}{:>5}{:>5}ALL\n",
                "ALL", 1, 0, 0, 1
            );
        }
        out.extend(text.bytes());
    }
}
