//! What a picture says, as numbers and words: it is drawn from these.

use super::axis::{between, number};
use super::symbols::Acts;

/// What a picture of the bodies says of one time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Facts {
    /// Its time `[time]`.
    pub time: f64,
    /// The factor of the displacements.
    pub factor: f64,
    /// The field in colour.
    pub field: Option<String>,
    /// What the ends of the colours stand for.
    pub range: [f64; 2],
    /// The least and the largest value of what is drawn; `None` where it has none.
    pub extremes: Option<[f64; 2]>,
    /// Where the largest value is, displacements as they are `[length]`.
    pub place: [f64; 3],
    /// What stands under the colours: how they were chosen, and what they leave out.
    pub words: Vec<String>,
    /// The bodies that are drawn.
    pub bodies: Vec<String>,
    /// By how much each of them is moved aside `[length]`.
    pub offsets: Vec<[f64; 3]>,
    /// The part of the faces in contact that is seen, of a field of contact in space.
    pub in_view: Option<f64>,
    /// How many strips along surfaces there are in a plane, pieces of one colour.
    pub strips: usize,
    /// The largest contact pressure that is labelled, as the run has found it.
    pub peak: Option<f64>,
    /// How much acts, where supports and loads are drawn.
    pub acts: Option<Acts>,
    /// How many contact points are open, stick and slip, as the run has counted them.
    pub statuses: Option<[usize; 3]>,
}

impl Facts {
    /// What stands under the colours: the values, and where colours leave some out, which. `given`: whether the reader has chosen the range; `dim`: 2 or 3.
    pub(super) fn said(&self, given: bool, dim: usize) -> Vec<String> {
        let Some([least, most]) = self.extremes else {
            return Vec::new();
        };
        if [least, most] == [0.0; 2] {
            let name = self.field.as_deref().unwrap_or("the field");
            return vec![format!("{name} is zero everywhere at this time")];
        }
        let [low, high] = self.range;
        let room = 1e-6 * (high - low).abs();
        if given || (least >= low - room && most <= high + room) {
            return vec![between([least, most])];
        }
        let place: Vec<String> = self.place[..dim].iter().map(|x| number(*x, 4)).collect();
        let beyond = match most > high {
            true => format!(
                "largest value {} at ({})",
                number(most, 3),
                place.join(", ")
            ),
            false => format!("least value {}", number(least, 3)),
        };
        vec!["colours to 99 % of area".into(), beyond]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_colours_leave_out_is_said_with_its_place() {
        let facts = Facts {
            range: [0.0, 120e6],
            extremes: Some([0.0, 8.4e9]),
            place: [0.005, 0.01, 0.0],
            ..Facts::default()
        };
        let words = [
            "colours to 99 % of area",
            "largest value 8.4e9 at (0.005, 0.01)",
        ];
        assert_eq!(facts.said(false, 2), words);
        assert_eq!(facts.said(true, 2), ["0 … 8.4e9"]);
        let whole = Facts {
            range: [0.0, 8.4e9],
            ..facts
        };
        assert_eq!(whole.said(false, 2), ["0 … 8.4e9"]);
        let zero = Facts {
            field: Some("CWEAR".into()),
            extremes: Some([0.0; 2]),
            ..Facts::default()
        };
        assert_eq!(
            zero.said(false, 2),
            ["CWEAR is zero everywhere at this time"]
        );
        assert_eq!(Facts::default().said(false, 3), Vec::<String>::new());
    }
}
