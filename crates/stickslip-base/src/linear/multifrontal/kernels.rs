//! Substitution with one column. Four columns of the factor at a time: the vector is touched a quarter as often.

/// What one step takes of a panel: its columns from row `from` on.
#[inline(always)]
fn four(panel: &[f64], height: usize, column: usize, from: usize) -> [&[f64]; 4] {
    std::array::from_fn(|k| &panel[(column + k) * height + from..(column + k + 1) * height])
}

/// A panel `[L₁₁; L₂₁]`, column by column, and the vector `[x, w]` it acts on.
struct Step<'a, const BACK: bool> {
    panel: &'a [f64],
    columns: usize,
    vector: &'a mut [f64],
}

impl<const BACK: bool> pulp::NullaryFnOnce for Step<'_, BACK> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        if BACK {
            backward(self.panel, self.columns, self.vector);
        } else {
            forward(self.panel, self.columns, self.vector);
        }
    }
}

/// `x := L₁₁⁻¹ x` and `w -= L₂₁ x` for `vector = [x, w]` and a panel `[L₁₁; L₂₁]` column by column.
pub(super) fn substitute(panel: &[f64], columns: usize, vector: &mut [f64]) {
    pulp::Arch::new().dispatch(Step::<false> {
        panel,
        columns,
        vector,
    });
}

/// `x := L₁₁⁻ᵀ (x - L₂₁ᵀ w)` for `vector = [x, w]` and a panel `[L₁₁; L₂₁]` column by column.
pub(super) fn back_substitute(panel: &[f64], columns: usize, vector: &mut [f64]) {
    pulp::Arch::new().dispatch(Step::<true> {
        panel,
        columns,
        vector,
    });
}

#[inline(always)]
fn forward(panel: &[f64], columns: usize, vector: &mut [f64]) {
    let height = vector.len();
    let mut j = 0;
    while j + 4 <= columns {
        let (head, rest) = vector[j..].split_at_mut(4);
        let l = four(panel, height, j, j);
        let x0 = head[0] / l[0][0];
        let x1 = (head[1] - l[0][1] * x0) / l[1][1];
        let x2 = (head[2] - l[0][2] * x0 - l[1][2] * x1) / l[2][2];
        let x3 = (head[3] - l[0][3] * x0 - l[1][3] * x1 - l[2][3] * x2) / l[3][3];
        head.copy_from_slice(&[x0, x1, x2, x3]);
        let [l0, l1, l2, l3] = l.map(|l| &l[4..]);
        let n = rest.len();
        let (l0, l1, l2, l3) = (&l0[..n], &l1[..n], &l2[..n], &l3[..n]);
        for i in 0..n {
            rest[i] -= (l0[i] * x0 + l1[i] * x1) + (l2[i] * x2 + l3[i] * x3);
        }
        j += 4;
    }
    while j < columns {
        let (head, rest) = vector[j..].split_at_mut(1);
        let l = &panel[j * height + j..(j + 1) * height];
        head[0] /= l[0];
        let x = head[0];
        for (r, l) in rest.iter_mut().zip(&l[1..]) {
            *r -= l * x;
        }
        j += 1;
    }
}

/// Partial sums of a scalar product; fixed, as they decide about its last bits.
const LANES: usize = 8;

/// Four scalar products with one vector.
#[inline(always)]
fn products(l: [&[f64]; 4], x: &[f64]) -> [f64; 4] {
    let n = x.len();
    let (xs, xr) = x.as_chunks::<LANES>();
    let (l0, r0) = l[0][..n].as_chunks::<LANES>();
    let (l1, r1) = l[1][..n].as_chunks::<LANES>();
    let (l2, r2) = l[2][..n].as_chunks::<LANES>();
    let (l3, r3) = l[3][..n].as_chunks::<LANES>();
    let mut sums = [[0.0; LANES]; 4];
    for ((((x, l0), l1), l2), l3) in xs.iter().zip(l0).zip(l1).zip(l2).zip(l3) {
        for k in 0..LANES {
            sums[0][k] += l0[k] * x[k];
            sums[1][k] += l1[k] * x[k];
            sums[2][k] += l2[k] * x[k];
            sums[3][k] += l3[k] * x[k];
        }
    }
    let mut totals = sums.map(|s| s.iter().sum::<f64>());
    for (total, rest) in totals.iter_mut().zip([r0, r1, r2, r3]) {
        *total += rest.iter().zip(xr).map(|(l, x)| l * x).sum::<f64>();
    }
    totals
}

#[inline(always)]
fn backward(panel: &[f64], columns: usize, vector: &mut [f64]) {
    let height = vector.len();
    let mut j = columns;
    while !j.is_multiple_of(4) {
        j -= 1;
        let l = &panel[j * height + j..(j + 1) * height];
        let sum: f64 = l[1..]
            .iter()
            .zip(&vector[j + 1..])
            .map(|(l, x)| l * x)
            .sum();
        vector[j] = (vector[j] - sum) / l[0];
    }
    while j > 0 {
        j -= 4;
        let (head, rest) = vector[j..].split_at_mut(4);
        let l = four(panel, height, j, j);
        let s = products(l.map(|l| &l[4..]), rest);
        let x3 = (head[3] - s[3]) / l[3][3];
        let x2 = (head[2] - s[2] - l[2][3] * x3) / l[2][2];
        let x1 = (head[1] - s[1] - l[1][2] * x2 - l[1][3] * x3) / l[1][1];
        let x0 = (head[0] - s[0] - l[0][1] * x1 - l[0][2] * x2 - l[0][3] * x3) / l[0][0];
        head.copy_from_slice(&[x0, x1, x2, x3]);
    }
}
