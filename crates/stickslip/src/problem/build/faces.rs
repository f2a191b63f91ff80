//! Smooth parts of a surface, and normals averaged over them.

use std::collections::BTreeMap;

use crate::contact::surface::edges;
use crate::math::{Vec3, add, dot, normalize};
use crate::shape::ElementKind;

/// Which faces belong to one smooth part, and the normals at their nodes.
pub(super) struct FaceGroups {
    groups: Vec<usize>,
    normals: Vec<Vec<Vec3>>,
}

impl FaceGroups {
    /// From faces as kind and points, and their unit normals: neighbours across an edge belong together if their normals differ by less than
    /// `angle` `[rad]`.
    pub fn new(faces: &[(ElementKind, Vec<usize>)], normals: &[Vec3], angle: f64) -> Self {
        let mut parent: Vec<usize> = (0..faces.len()).collect();
        fn root(parent: &mut [usize], mut k: usize) -> usize {
            while parent[k] != k {
                parent[k] = parent[parent[k]];
                k = parent[k];
            }
            k
        }
        let mut across: BTreeMap<Vec<usize>, Vec<usize>> = BTreeMap::new();
        for (k, (kind, nodes)) in faces.iter().enumerate() {
            for edge in edges(*kind) {
                let mut key: Vec<usize> = edge.iter().map(|&i| nodes[i]).collect();
                key.sort_unstable();
                across.entry(key).or_default().push(k);
            }
        }
        for neighbours in across.values() {
            for pair in neighbours.windows(2) {
                if dot(normals[pair[0]], normals[pair[1]]) >= angle.cos() {
                    let (a, b) = (root(&mut parent, pair[0]), root(&mut parent, pair[1]));
                    parent[a.max(b)] = a.min(b);
                }
            }
        }
        let groups: Vec<usize> = (0..faces.len()).map(|k| root(&mut parent, k)).collect();
        let mut sums: BTreeMap<(usize, usize), Vec3> = BTreeMap::new();
        for (k, (_, nodes)) in faces.iter().enumerate() {
            for &node in nodes {
                let sum = sums.entry((node, groups[k])).or_default();
                *sum = add(*sum, normals[k]);
            }
        }
        let normals = (faces.iter().enumerate())
            .map(|(k, (_, nodes))| {
                let at = |&node: &usize| normalize(sums[&(node, groups[k])]).unwrap_or(normals[k]);
                nodes.iter().map(at).collect()
            })
            .collect();
        FaceGroups { groups, normals }
    }

    /// The part a face belongs to.
    pub fn group(&self, face: usize) -> usize {
        self.groups[face]
    }

    /// Unit normals at its nodes.
    pub fn normals(&self, face: usize) -> &[Vec3] {
        &self.normals[face]
    }
}
