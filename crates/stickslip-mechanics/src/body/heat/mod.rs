//! Temperatures that are given: what the problem file names under `temperature`, one file a kind.

mod linear;
mod model;
mod nodes;
mod radial;
mod uniform;

pub use linear::Linear;
pub use model::{Spot, TemperatureModel};
pub use nodes::Nodes;
pub use radial::Radial;
pub use uniform::Uniform;

crate::family! {
    /// Fields of temperature.
    TemperatureKind: "temperature", dyn TemperatureModel {
        /// The same everywhere.
        Uniform(Uniform) = "uniform",
        /// Changing along a straight line.
        Linear(Linear) = "linear",
        /// A table over the distance from an axis.
        Radial(Radial) = "radial",
        /// A number for each node.
        Nodes(Nodes) = "nodes",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Space;
    use crate::registry::Family;

    #[test]
    fn samples_are_sound_and_round_trip() {
        for kind in TemperatureKind::samples() {
            assert_eq!(kind.as_dyn().faults(Space::Solid), []);
            let text = serde_json::to_string(&kind).expect("plain data");
            let back: TemperatureKind = serde_json::from_str(&text).expect("its own text");
            assert_eq!(back, kind);
            let spot = Spot {
                node: 7,
                x: [0.01, 0.02, 0.0],
            };
            let t = kind.as_dyn().at(Space::Solid, &spot);
            assert!(t.is_some_and(f64::is_finite), "{}", kind.kind());
        }
    }

    #[test]
    fn fields_are_what_their_numbers_say() {
        let spot = Spot {
            node: 3,
            x: [3.0, 4.0, 9.0],
        };
        let linear = Linear {
            value: 10.0,
            point: vec![1.0, 0.0, 0.0],
            gradient: vec![2.0, 0.5, 0.0],
        };
        assert_eq!(linear.at(Space::Solid, &spot), Some(16.0));
        let radial = Radial {
            table: vec![[4.0, 100.0], [6.0, 300.0]],
            point: None,
            axis: Some(vec![0.0, 0.0, 2.0]),
        };
        assert_eq!(radial.at(Space::Solid, &spot), Some(200.0));
        assert_eq!(radial.at(Space::Axisymmetric, &spot), Some(100.0));
        let nodes = Nodes {
            values: vec![[3.0, 50.0]],
        };
        assert_eq!(nodes.at(Space::Solid, &spot), Some(50.0));
        let other = Spot { node: 4, ..spot };
        assert_eq!(nodes.at(Space::Solid, &other), None);
    }

    #[test]
    fn what_means_nothing_is_said_by_key() {
        let keys = |kind: &dyn TemperatureModel, space| -> Vec<&'static str> {
            kind.faults(space).into_iter().map(|f| f.0).collect()
        };
        let mut radial = Radial {
            table: vec![[1.0, 0.0], [1.0, 5.0]],
            point: None,
            axis: None,
        };
        assert_eq!(keys(&radial, Space::Solid), ["table", "axis"]);
        radial.axis = Some(vec![0.0, 1.0]);
        assert_eq!(keys(&radial, Space::Axisymmetric), ["table", "axis"]);
        let nodes = Nodes {
            values: vec![[1.5, 0.0], [2.0, 1.0], [2.0, 3.0]],
        };
        assert_eq!(keys(&nodes, Space::Solid), ["values", "values"]);
        let linear = Linear {
            value: 0.0,
            point: vec![0.0],
            gradient: vec![0.0, f64::INFINITY],
        };
        let plane = Space::PlaneStress { thickness: 1.0 };
        assert_eq!(keys(&linear, plane), ["point", "gradient"]);
    }
}
