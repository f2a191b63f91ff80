/// Where the values of a field live.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Location {
    /// One value (tuple) a point of the mesh.
    Point,
    /// One value (tuple) a cell of the mesh, blocks in order.
    Cell,
}

/// A named array for output.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Name, after Abaqus where it has one: `U`, `S`, `CPRESS`.
    pub name: String,
    /// Points or cells.
    pub location: Location,
    /// Numbers a point or cell: 1, 3 (vector) or 6 (symmetric tensor xx yy zz xy yz xz).
    pub components: usize,
    /// Values, `components` a point or cell.
    pub values: Vec<f64>,
}

/// Fields of strain: their shear components are engineering ones, twice those of the tensor.
const STRAINS: [&str; 2] = ["E", "THE"];

impl Field {
    /// Lets something be done to the values of a field of symmetric tensors as components of tensors, whatever its shear components are.
    pub fn as_tensors(&mut self, act: impl FnOnce(&mut [f64])) {
        let factor = match STRAINS.contains(&self.name.as_str()) {
            true => 0.5,
            false => 1.0,
        };
        let shears = |values: &mut [f64], factor: f64| {
            let each = values.chunks_exact_mut(6).flat_map(|t| &mut t[3..]);
            each.for_each(|shear| *shear *= factor);
        };
        shears(&mut self.values, factor);
        act(&mut self.values);
        shears(&mut self.values, 1.0 / factor);
    }
}

/// The fields of one output time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Fields {
    /// In the order they were added.
    pub all: Vec<Field>,
}

impl Fields {
    /// The field of this name.
    pub fn get(&self, name: &str) -> Option<&Field> {
        self.all.iter().find(|f| f.name == name)
    }

    /// The field of this name, made of `fill` with the given shape if it is not there yet. Interfaces share one field
    /// over all points of the mesh; where no interface is, it keeps `fill`.
    pub fn shared(
        &mut self,
        name: &str,
        location: Location,
        components: usize,
        count: usize,
        fill: f64,
    ) -> &mut Field {
        let i = match self.all.iter().position(|f| f.name == name) {
            Some(i) => i,
            None => {
                self.all.push(Field {
                    name: name.to_string(),
                    location,
                    components,
                    values: vec![fill; count * components],
                });
                self.all.len() - 1
            }
        };
        &mut self.all[i]
    }
}
