use std::io::{self, Read, Write};
use std::ops::{Add, AddAssign, Mul, Range};
use std::sync::{Arc, OnceLock};

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{
    LltError, LltRegularization, cholesky_in_place, cholesky_in_place_scratch,
};
use faer::linalg::cholesky::llt::inverse::{inverse, inverse_scratch};
use faer::{MatMut, MatRef, Par, Spec};
use rayon::prelude::*;

use super::DistributedOperator;
use super::elsewhere::Elsewhere;
use super::error::{LinearError, zeros};

/// The inverse of a dense symmetric positive definite matrix, for products with vectors.
///
/// Products read one triangle only: they are as fast as memory delivers half of the matrix. Their bits do not depend on the
/// number of threads. It may be with the processes of an engine: then there are products alone.
#[derive(Debug)]
pub struct Compliance {
    n: usize,
    /// Column by column, both triangles; nothing where an engine has them.
    values: Vec<f64>,
    single: OnceLock<Vec<f32>>,
    spread: Option<Elsewhere>,
}

/// Columns below which one task does everything.
const SMALL_PRODUCT: usize = 512;

/// Tasks of a product with a larger matrix.
const TASKS: usize = 8;

/// Numbers that a product can be made with.
trait Number:
    Copy + Send + Sync + Add<Output = Self> + AddAssign + Mul<Output = Self> + 'static
{
    const ZERO: Self;
    fn of(x: f64) -> Self;
    fn to(self) -> f64;
}

impl Number for f64 {
    const ZERO: f64 = 0.0;
    fn of(x: f64) -> f64 {
        x
    }
    fn to(self) -> f64 {
        self
    }
}

impl Number for f32 {
    const ZERO: f32 = 0.0;
    fn of(x: f64) -> f32 {
        x as f32
    }
    fn to(self) -> f64 {
        f64::from(self)
    }
}

impl Compliance {
    /// The inverse of a stiffness of shape `(n, n)`, column by column, of which the lower triangle is read and destroyed.
    ///
    /// # Errors
    /// [`LinearError::NotPositive`] with the row, [`LinearError::OutOfMemory`].
    ///
    /// # Panics
    /// If `stiffness` has not `n²` entries.
    pub fn of(n: usize, stiffness: &mut [f64]) -> Result<Compliance, LinearError> {
        assert_eq!(stiffness.len(), n * n, "size of a stiffness");
        if n == 0 {
            return Ok(Compliance::from_values(0, Vec::new()));
        }
        let scratch = cholesky_in_place_scratch::<f64>(n, Par::Seq, Spec::default())
            .or(inverse_scratch::<f64>(n, Par::Seq));
        let lost = LinearError::OutOfMemory {
            bytes: 16 * (n * n) as u64,
        };
        let Ok(mut memory) = MemBuffer::try_new(scratch) else {
            return Err(lost);
        };
        let mut values = zeros(n * n)?;
        let done = cholesky_in_place(
            MatMut::from_column_major_slice_mut(&mut *stiffness, n, n),
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Spec::default(),
        );
        if let Err(LltError::NonPositivePivot { index }) = done {
            return Err(LinearError::NotPositive { dof: index });
        }
        inverse(
            MatMut::from_column_major_slice_mut(&mut values, n, n),
            MatRef::from_column_major_slice(&*stiffness, n, n),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        mirror(n, &mut values);
        if let Some(at) = values.iter().position(|v| !v.is_finite()) {
            return Err(LinearError::NotFinite { dof: at % n });
        }
        Ok(Compliance::from_values(n, values))
    }

    /// A compliance given by all its values, column by column.
    ///
    /// # Panics
    /// If there are not `n²` of them.
    pub fn from_values(n: usize, values: Vec<f64>) -> Compliance {
        assert_eq!(values.len(), n * n, "size of a compliance");
        Compliance {
            n,
            values,
            single: OnceLock::new(),
            spread: None,
        }
    }

    /// One that the processes of an engine have.
    pub fn spread(n: usize, by: Arc<dyn DistributedOperator>) -> Compliance {
        Compliance::elsewhere(by, n, (0..n as u32).collect())
    }

    /// Whether its values are in this process.
    pub fn is_here(&self) -> bool {
        self.spread.is_none()
    }

    /// Some of its rows and columns, ascending.
    ///
    /// # Panics
    /// If one does not exist.
    pub fn cut(&self, own: impl ExactSizeIterator<Item = usize> + Clone) -> Compliance {
        if let Some(all) = &self.spread {
            let list = own.clone().map(|i| all.list[i]).collect();
            let by = Arc::clone(&all.by);
            return Compliance::elsewhere(by, all.size, list);
        }
        let mut cut = Vec::with_capacity(own.len() * own.len());
        for j in own.clone() {
            let column = &self.values[j * self.n..(j + 1) * self.n];
            cut.extend(own.clone().map(|i| column[i]));
        }
        Compliance::from_values(own.len(), cut)
    }

    fn elsewhere(by: Arc<dyn DistributedOperator>, size: usize, list: Vec<u32>) -> Compliance {
        Compliance {
            n: list.len(),
            values: Vec::new(),
            single: OnceLock::new(),
            spread: Some(Elsewhere { by, size, list }),
        }
    }

    /// Writes the lower triangle, column by column, little endian.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn encode(&self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(&(self.n as u64).to_le_bytes())?;
        let mut bytes = Vec::new();
        for (j, column) in self.values.chunks_exact(self.n.max(1)).enumerate() {
            bytes.clear();
            bytes.extend(column[j..].iter().flat_map(|v| v.to_le_bytes()));
            out.write_all(&bytes)?;
        }
        Ok(())
    }

    /// Reads a compliance of `n` rows that [`encode`](Compliance::encode) wrote. Memory grows with what is read.
    ///
    /// # Errors
    /// Those of `input`; [`io::ErrorKind::InvalidData`] for another size, or numbers that are not finite.
    pub fn decode(n: usize, input: &mut dyn Read) -> io::Result<Compliance> {
        let invalid = |what| Err(io::Error::new(io::ErrorKind::InvalidData, what));
        let mut size = [0; 8];
        input.read_exact(&mut size)?;
        if u64::from_le_bytes(size) != n as u64 {
            return invalid("a compliance of another size");
        }
        let mut triangle: Vec<f64> = Vec::new();
        let mut bytes = Vec::new();
        for j in 0..n {
            bytes.resize(8 * (n - j), 0);
            input.read_exact(&mut bytes)?;
            let (numbers, _) = bytes.as_chunks::<8>();
            triangle.extend(numbers.iter().map(|&b| f64::from_le_bytes(b)));
        }
        if !triangle.iter().all(|v| v.is_finite()) {
            return invalid("a compliance with wrong numbers");
        }
        let mut values = vec![0.0; n * n];
        let mut rest = &triangle[..];
        for (j, column) in values.chunks_exact_mut(n.max(1)).enumerate() {
            let (own, behind) = rest.split_at(n - j);
            column[j..].copy_from_slice(own);
            rest = behind;
        }
        mirror(n, &mut values);
        Ok(Compliance::from_values(n, values))
    }

    /// Rows.
    pub fn size(&self) -> usize {
        self.n
    }

    /// All values, column by column; none where an engine has them.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// A column in single precision.
    ///
    /// # Panics
    /// If an engine has them.
    pub fn column(&self, j: usize) -> &[f32] {
        &self.single()[j * self.n..(j + 1) * self.n]
    }

    fn single(&self) -> &[f32] {
        self.single
            .get_or_init(|| self.values.par_iter().map(|&v| v as f32).collect())
    }

    /// `y = W x`; not a number where an engine has died, which says so itself.
    ///
    /// # Panics
    /// If `x` or `y` has not one entry a row.
    pub fn mul(&self, x: &[f64], y: &mut [f64]) {
        match &self.spread {
            Some(spread) => spread.products(x, y),
            None => product(self.n, &self.values, x, y),
        }
    }

    /// The same with the matrix and the vector rounded to single precision, where this process has them.
    ///
    /// # Panics
    /// If `x` or `y` has not one entry a row.
    pub fn mul_single(&self, x: &[f64], y: &mut [f64]) {
        match &self.spread {
            Some(spread) => spread.products(x, y),
            None => product(self.n, self.single(), x, y),
        }
    }

    /// Products with several vectors, one behind the other.
    ///
    /// # Panics
    /// If `x` or `y` has not one entry a row and vector.
    pub fn mul_all(&self, x: &[f64], y: &mut [f64]) {
        assert!(x.len() == y.len(), "length of vectors");
        if let Some(spread) = &self.spread {
            return spread.products(x, y);
        }
        let n = self.n.max(1);
        for (x, y) in x.chunks(n).zip(y.chunks_mut(n)) {
            product(self.n, &self.values, x, y);
        }
    }

    /// Bytes held in this process.
    pub fn bytes(&self) -> u64 {
        let single = self.single.get().map_or(0, Vec::len);
        8 * self.values.len() as u64 + 4 * single as u64
    }
}

/// Copies the lower triangle to the upper one, tile by tile.
fn mirror(n: usize, values: &mut [f64]) {
    const TILE: usize = 32;
    for j0 in (0..n).step_by(TILE) {
        for i0 in (j0..n).step_by(TILE) {
            for j in j0..(j0 + TILE).min(n) {
                for i in i0.max(j + 1)..(i0 + TILE).min(n) {
                    values[i * n + j] = values[j * n + i];
                }
            }
        }
    }
}

/// First columns of tasks with about equal parts of the lower triangle.
fn partition(n: usize) -> Vec<usize> {
    let tasks = if n < SMALL_PRODUCT { 1 } else { TASKS };
    let mut starts: Vec<usize> = (0..tasks)
        .map(|k| {
            let left = 1.0 - k as f64 / tasks as f64;
            // columns come in fours
            ((n as f64 * (1.0 - left.sqrt())) as usize) & !3
        })
        .collect();
    starts.push(n);
    starts
}

fn product<T: Number>(n: usize, values: &[T], x: &[f64], y: &mut [f64]) {
    assert!(x.len() == n && y.len() == n, "length of a vector");
    let x: Vec<T> = x.iter().map(|&x| T::of(x)).collect();
    let starts = partition(n);
    let parts: Vec<Vec<T>> = starts
        .par_windows(2)
        .map(|range| {
            let mut part = vec![T::ZERO; n - range[0]];
            pulp::Arch::new().dispatch(LowerColumns {
                n,
                values,
                columns: range[0]..range[1],
                x: &x,
                y: &mut part,
            });
            part
        })
        .collect();
    y.fill(0.0);
    for (part, start) in parts.iter().zip(&starts) {
        for (y, p) in y[*start..].iter_mut().zip(part) {
            *y += p.to();
        }
    }
}

/// What some columns of the lower triangle and the rows that mirror them add to the product; `y` starts at the first of them.
struct LowerColumns<'a, T> {
    n: usize,
    values: &'a [T],
    columns: Range<usize>,
    x: &'a [T],
    y: &'a mut [T],
}

/// Numbers that go through the processor together.
const LANES: usize = 8;

impl<T: Number> pulp::NullaryFnOnce for LowerColumns<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let LowerColumns {
            n,
            values,
            columns,
            x,
            y,
        } = self;
        let first = columns.start;
        let mut j = first;
        while j < columns.end {
            let width = (columns.end - j).min(4);
            // the triangle on the diagonal
            for a in j..j + width {
                for b in j..=a {
                    let v = values[b * n + a];
                    y[a - first] += v * x[b];
                    if a != b {
                        y[b - first] += v * x[a];
                    }
                }
            }
            let below = j + width;
            let column = |k: usize| &values[(j + k) * n + below..(j + k + 1) * n];
            let sums = if width == 4 {
                let c = [column(0), column(1), column(2), column(3)];
                let s = [x[j], x[j + 1], x[j + 2], x[j + 3]];
                four_columns(c, s, &x[below..n], &mut y[below - first..])
            } else {
                let mut sums = [T::ZERO; 4];
                for (k, sum) in sums.iter_mut().enumerate().take(width) {
                    let x = &x[j..];
                    for ((v, y), xi) in column(k)
                        .iter()
                        .zip(&mut y[below - first..])
                        .zip(&x[width..])
                    {
                        *y += *v * x[k];
                        *sum += *v * *xi;
                    }
                }
                sums
            };
            for (k, sum) in sums.into_iter().enumerate().take(width) {
                y[j + k - first] += sum;
            }
            j += width;
        }
    }
}

/// `y += Σ cₖ sₖ` and the products `cₖ · x`.
#[inline(always)]
fn four_columns<T: Number>(c: [&[T]; 4], s: [T; 4], x: &[T], y: &mut [T]) -> [T; 4] {
    let mut lanes = [[T::ZERO; LANES]; 4];
    let (c0, r0) = c[0].as_chunks::<LANES>();
    let (c1, r1) = c[1].as_chunks::<LANES>();
    let (c2, r2) = c[2].as_chunks::<LANES>();
    let (c3, r3) = c[3].as_chunks::<LANES>();
    let (xs, xr) = x.as_chunks::<LANES>();
    let (ys, yr) = y.as_chunks_mut::<LANES>();
    for (((((y, x), c0), c1), c2), c3) in ys.iter_mut().zip(xs).zip(c0).zip(c1).zip(c2).zip(c3) {
        for l in 0..LANES {
            let low = c0[l] * s[0] + c1[l] * s[1];
            let high = c2[l] * s[2] + c3[l] * s[3];
            y[l] += low + high;
        }
        for l in 0..LANES {
            lanes[0][l] += c0[l] * x[l];
            lanes[1][l] += c1[l] * x[l];
            lanes[2][l] += c2[l] * x[l];
            lanes[3][l] += c3[l] * x[l];
        }
    }
    let mut sums = lanes.map(|lane| lane.iter().fold(T::ZERO, |a, &b| a + b));
    for (((((y, x), c0), c1), c2), c3) in yr.iter_mut().zip(xr).zip(r0).zip(r1).zip(r2).zip(r3) {
        for (k, c) in [c0, c1, c2, c3].into_iter().enumerate() {
            *y += *c * s[k];
            sums[k] += *c * *x;
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::super::testing::noise;
    use super::*;

    fn sample(n: usize) -> Vec<f64> {
        let b = noise(&mut 3, n * n);
        let product = |i: usize, j: usize| -> f64 {
            (0..n.min(20)).map(|k| b[i * n + k] * b[j * n + k]).sum()
        };
        (0..n * n)
            .map(|k| product(k / n, k % n) + if k % (n + 1) == 0 { 3.0 } else { 0.0 })
            .collect()
    }

    #[test]
    fn undoes_the_stiffness() {
        for n in [1, 3, 4, 7, 40, 61, 530] {
            let s = sample(n);
            let w = Compliance::of(n, &mut s.clone()).unwrap();
            let x = noise(&mut 9, n);
            let f: Vec<f64> = (0..n)
                .map(|i| (0..n).map(|j| s[i * n + j] * x[j]).sum())
                .collect();
            let mut y = vec![f64::NAN; n];
            w.mul(&f, &mut y);
            assert!(x.iter().zip(&y).all(|(x, y)| (x - y).abs() < 1e-11), "{n}");
            w.mul_single(&f, &mut y);
            assert!(x.iter().zip(&y).all(|(x, y)| (x - y).abs() < 2e-3), "{n}");
            let j = n / 2;
            for (i, &v) in w.column(j).iter().enumerate() {
                assert_eq!(v, w.values()[i * n + j] as f32);
            }
        }
    }

    #[test]
    fn products_do_not_depend_on_threads() {
        let w = Compliance::of(600, &mut sample(600)).unwrap();
        let x = noise(&mut 5, 600);
        let product = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let mut y = vec![0.0; 600];
            pool.build().unwrap().install(|| w.mul(&x, &mut y));
            y.iter().map(|v| v.to_bits()).collect::<Vec<_>>()
        };
        assert_eq!(product(1), product(3));
    }

    #[test]
    fn a_decoded_compliance_is_the_same() {
        for n in [0, 1, 5, 70] {
            let w = Compliance::of(n, &mut sample(n)).unwrap();
            let mut bytes = Vec::new();
            w.encode(&mut bytes).unwrap();
            assert_eq!(bytes.len(), 8 + 4 * n * (n + 1));
            let again = Compliance::decode(n, &mut &bytes[..]).unwrap();
            assert_eq!(again.values(), w.values());
            assert!(Compliance::decode(n + 1, &mut &bytes[..]).is_err());
            if let Some(last) = bytes.last_mut() {
                *last = 0xff;
            }
            assert!(n == 0 || Compliance::decode(n, &mut &bytes[..bytes.len() - 1]).is_err());
        }
    }

    #[test]
    fn what_is_not_positive_is_refused() {
        let mut s = sample(5);
        s[18] = -1.0;
        assert_eq!(
            Compliance::of(5, &mut s).unwrap_err(),
            LinearError::NotPositive { dof: 3 }
        );
        assert_eq!(Compliance::of(0, &mut []).unwrap().size(), 0);
    }
}
