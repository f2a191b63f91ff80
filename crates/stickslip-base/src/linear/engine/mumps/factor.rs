use std::io;
use std::path::Path;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, PoisonError};

use super::body::Body;
use super::entries::{self, Written};
use super::number::Number;
use super::options::MumpsOptions;
use super::refusal::{not_finite, refusal};
use super::root::Root;
use super::words::WordReader;
use crate::linear::engine::contract::{Analysed, FactorEffort, Interior};
use crate::linear::{LinearError, Matrix, Numbers, Schur, Workspace};
use crate::number::digits;

/// Largest error, relative to the whole, of displacements that are known beforehand. A factor leaves about a machine epsilon times the condition of the
/// matrix, so that this much comes of a condition of 1e12 at least, where no digit of a result is left to trust; a singular matrix leaves about one.
const LARGEST_KNOWN_ERROR: f64 = 1e-3;

/// Bytes of a mebibyte.
const MIB: u64 = 1 << 20;

/// Numbers of right-hand sides that the first rank holds at a time.
const AT_ONCE: usize = 1 << 25;

/// The factor of a body, on the ranks.
#[derive(Debug)]
pub(super) struct Factor {
    body: Arc<Body>,
    number: Arc<Number>,
    effort: FactorEffort,
    /// The forces reduced last, as far as ranks still have them half solved.
    last: Mutex<Vec<f64>>,
}

impl Analysed for Body {
    fn interior(&self) -> &[u32] {
        &self.split.interior
    }

    fn root(&self) -> &[u32] {
        &self.split.root
    }

    fn effort(&self) -> FactorEffort {
        FactorEffort {
            bytes: 8 * self.longest() as u64,
            ..FactorEffort::default()
        }
    }

    fn longest(&self) -> usize {
        match self.spread {
            true => 0,
            false => self.split.root.len().pow(2),
        }
    }

    fn bytes(&self) -> u64 {
        self.split.bytes()
    }

    fn is_alive(&self) -> bool {
        self.job.is_alive()
    }

    fn compliance_is_here(&self) -> bool {
        !self.spread
    }

    fn note(&self) -> Option<String> {
        self.note.clone()
    }

    fn factor(
        self: Arc<Self>,
        matrix: &dyn Matrix,
        workspace: &Workspace,
    ) -> Result<(Box<dyn Interior>, Schur), LinearError> {
        let (factor, schur) = Factor::new(&self, matrix, workspace)?;
        factor.test(matrix, &schur)?;
        Ok((Box::new(factor), schur))
    }
}

impl Factor {
    /// Factors a body. Its Schur complement comes here, or stays.
    pub fn new(
        body: &Arc<Body>,
        matrix: &dyn Matrix,
        workspace: &Workspace,
    ) -> Result<(Factor, Schur), LinearError> {
        let mut number = Number {
            job: Arc::clone(&body.job),
            number: body.job.take_number()?,
            factored: false,
        };
        let Written {
            file,
            by_ranks,
            pieces,
        } = entries::write(body, matrix)?;
        let (n, c) = (body.split.len(), body.split.root.len());
        let MumpsOptions {
            out_of_core,
            low_rank,
            memory,
            ..
        } = body.options;
        let answer = body.job.ask(&format!(
            "factor {} {n} {c} {} {:e} {} {} {} {file}",
            number.number,
            u8::from(out_of_core),
            low_rank.unwrap_or(0.0),
            memory.map_or(0, |bytes| (bytes / MIB).max(1)),
            u8::from(body.spread),
            u8::from(by_ranks)
        ))?;
        let figures = answer.map_err(|words| match not_finite(&words) {
            Some(row) => LinearError::NotFinite {
                dof: body.split.dof(row.min(n - 1)),
            },
            None => refusal(&words),
        })?;
        number.factored = true;
        let figure = |at: usize| figures.get(at).and_then(|w| w.parse::<f64>().ok());
        for (at, most) in body.job.memory.iter().enumerate() {
            let bytes = 1024.0 * figure(at).unwrap_or(0.0);
            most.fetch_max(bytes as u64, Ordering::Relaxed);
        }
        let number = Arc::new(number);
        let schur = match body.spread {
            true => Schur::DistributedOperator(Arc::new(Root {
                number: Arc::clone(&number),
                pieces,
                trace: figure(4).unwrap_or(f64::NAN),
            })),
            false => Schur::Here(read_schur(body, &file, workspace)?),
        };
        let factor = Factor {
            body: Arc::clone(body),
            number,
            effort: FactorEffort {
                flops: figure(2).unwrap_or(0.0),
                nonzeros: figure(3).unwrap_or(0.0),
                bytes: body.effort().bytes,
            },
            last: Mutex::default(),
        };
        Ok((factor, schur))
    }

    /// Finds displacements that are known from the forces that belong to them, and refuses a factor that does not: MUMPS says of no pivot how small it is.
    pub fn test(&self, matrix: &dyn Matrix, schur: &Schur) -> Result<(), LinearError> {
        let split = &self.body.split;
        let (n, inner, c) = (split.len(), split.interior.len(), split.root.len());
        let known: Vec<f64> = (0..n)
            .map(|i| ((i * 7919 + 13) % 1009) as f64 / 504.5 - 1.0)
            .collect();
        let mut all = vec![0.0; matrix.points() * matrix.block_size()];
        known
            .iter()
            .enumerate()
            .for_each(|(i, x)| all[split.dof(i)] = *x);
        let all = matrix.times(&all);
        let mut forces: Vec<f64> = (0..n).map(|i| all[split.dof(i)]).collect();
        let (interior, root) = forces.split_at_mut(inner);
        self.reduce(interior, root, 1)?;
        let felt = schur.products(&[known[inner..].to_vec()])?.concat();
        self.recover(interior, &known[inner..], 1)?;
        let size = |v: &mut dyn Iterator<Item = f64>| {
            v.fold(0.0, |m: f64, x| if x.is_nan() { x } else { m.max(x.abs()) })
        };
        let wrong = size(&mut interior.iter().zip(&known).map(|(a, b)| a - b));
        let odd = size(&mut root.iter().zip(&felt).map(|(a, b)| a - b))
            / size(&mut root.iter().copied()).max(f64::MIN_POSITIVE);
        if wrong < LARGEST_KNOWN_ERROR && (odd < LARGEST_KNOWN_ERROR || c == 0) {
            return Ok(());
        }
        Err(match self.body.options.low_rank {
            Some(eps) => LinearError::Engine {
                message: format!(
                    "MUMPS: with `low-rank = {eps:e}` solutions are wrong by {}",
                    digits(wrong.max(odd), 2)
                ),
                help: "a smaller `solver.engine.mumps.low-rank`, or none".into(),
            },
            None => LinearError::Indefinite,
        })
    }
}

/// The Schur complement that rank 0 has written: of its lower triangle, column by column.
fn read_schur(body: &Body, file: &str, workspace: &Workspace) -> Result<Numbers, LinearError> {
    let c = body.split.root.len();
    let mut values = workspace.take(c * c)?;
    values.fill(0.0);
    let path = body.job.folder().join(format!("{file}.schur"));
    let mut read = || -> io::Result<()> {
        let mut reader = WordReader::new(&path)?;
        for (j, column) in values.chunks_exact_mut(c.max(1)).enumerate() {
            reader.numbers(&mut column[j..])?;
        }
        reader.finish()
    };
    if c > 0 {
        read().map_err(|e| body.job.trouble(&e))?;
    }
    Ok(values)
}

impl Interior for Factor {
    fn ordered(&self) -> &dyn Analysed {
        &*self.body
    }

    fn reduce(
        &self,
        interior: &mut [f64],
        root: &mut [f64],
        columns: usize,
    ) -> Result<(), LinearError> {
        let (inner, c) = self.lengths(interior, root, columns);
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        last.clear();
        let (at_once, number) = (self.at_once(), self.number.number);
        for first in (0..columns).step_by(at_once) {
            let some = first..columns.min(first + at_once);
            let vectors: Vec<&[f64]> = (some.clone())
                .flat_map(|k| [&interior[k * inner..][..inner], &root[k * c..][..c]])
                .collect();
            let command = format!("reduce {number} {}", some.len());
            let mut out = vec![0.0; c * some.len()];
            self.body.job.vectors(&command, &vectors, &mut out)?;
            root[c * some.start..c * some.end].copy_from_slice(&out);
        }
        if columns <= at_once {
            last.extend_from_slice(interior);
        }
        Ok(())
    }

    fn recover(
        &self,
        interior: &mut [f64],
        root: &[f64],
        columns: usize,
    ) -> Result<(), LinearError> {
        let (inner, c) = self.lengths(interior, root, columns);
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        // In motion the forces are those that were reduced last, and half of the work is done.
        let known = *last == *interior;
        last.clear();
        let (at_once, number) = (self.at_once(), self.number.number);
        for first in (0..columns).step_by(at_once) {
            let some = first..columns.min(first + at_once);
            let out = &mut interior[inner * some.start..inner * some.end];
            let root = &root[c * some.start..c * some.end];
            let command = format!("expand {number} {} {}", some.len(), u8::from(!known));
            let vectors: &[&[f64]] = if known { &[root] } else { &[out, root] };
            let file = self.body.job.send(&command, vectors)?;
            self.gather(&file, out)
                .map_err(|e| self.body.job.trouble(&e))?;
        }
        Ok(())
    }

    fn bytes(&self) -> u64 {
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        8 * last.capacity() as u64
    }

    fn effort(&self) -> FactorEffort {
        self.effort
    }

    fn fault(&self) -> Option<LinearError> {
        self.body.job.fault()
    }
}

impl Factor {
    /// Right-hand sides that go to the ranks at a time: the first of them has all of each.
    fn at_once(&self) -> usize {
        (AT_ONCE / self.body.split.len().max(1)).max(1)
    }

    /// Puts a solution together of what each rank has of it.
    fn gather(&self, file: &Path, out: &mut [f64]) -> io::Result<()> {
        let inner = self.body.split.interior.len();
        let mut all = 0;
        for rank in 0..self.body.options.ranks {
            let path = file.with_extension(format!("out.{rank}"));
            let mut reader = WordReader::new(&path)?;
            let rows: io::Result<Vec<u32>> = (0..reader.word()?)
                .map(|_| reader.word().map(|row| row as u32))
                .collect();
            let rows = rows?;
            all += rows.iter().filter(|&&row| (row as usize) < inner).count();
            let mut values = vec![0.0; rows.len()];
            for column in out.chunks_exact_mut(inner) {
                reader.numbers(&mut values)?;
                for (&row, value) in rows.iter().zip(&values) {
                    // Those of kept dofs are known.
                    if let Some(out) = column.get_mut(row as usize) {
                        *out = *value;
                    }
                }
            }
            reader.finish()?;
        }
        match all == inner {
            true => Ok(()),
            false => Err(io::Error::other("the ranks have another number of rows")),
        }
    }

    /// Checks the lengths and returns the numbers of eliminated and of kept dofs.
    fn lengths(&self, interior: &[f64], root: &[f64], columns: usize) -> (usize, usize) {
        let split = &self.body.split;
        let (n, c) = (split.interior.len(), split.root.len());
        assert_eq!(interior.len(), n * columns, "length of the interior");
        assert_eq!(root.len(), c * columns, "length of the root");
        (n, c)
    }
}
