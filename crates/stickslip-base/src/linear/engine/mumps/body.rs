use std::io;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, PoisonError};

use super::job::Job;
use super::options::MumpsOptions;
use super::words::{WordReader, WordWriter};
use crate::linear::engine::contract::{FactorEffort, Interior, Ordered};
use crate::linear::engine::split::Split;
use crate::linear::{BlockCsr, LinearError, Numbers, Workspace};

/// Largest error, relative to the whole, of displacements that are known beforehand: what is worse comes of a singular matrix.
const TRUST: f64 = 1e-3;

/// Bytes of a mebibyte.
const MIB: u64 = 1 << 20;

/// What to try where memory does not suffice.
const MEMORY: &str = "more ranks on more machines, `solver.engine.mumps.out-of-core = true`, a larger `solver.engine.mumps.memory`, or `low-rank`";

/// A body before it is factored.
#[derive(Debug)]
pub(super) struct Body {
    pub job: Arc<Job>,
    pub options: MumpsOptions,
    pub split: Split,
}

/// The factor of a body, on the ranks.
#[derive(Debug)]
struct Factor {
    body: Arc<Body>,
    number: Number,
    effort: FactorEffort,
    /// The forces reduced last, as far as ranks still have them half solved.
    last: Mutex<Vec<f64>>,
}

/// The number of a body, which it gives back.
#[derive(Debug)]
struct Number {
    job: Arc<Job>,
    number: usize,
    factored: bool,
}

impl Drop for Number {
    fn drop(&mut self) {
        self.job.give_number(self.number, self.factored);
    }
}

impl Ordered for Body {
    fn interior(&self) -> &[u32] {
        &self.split.interior
    }

    fn root(&self) -> &[u32] {
        &self.split.root
    }

    fn effort(&self) -> FactorEffort {
        FactorEffort {
            bytes: 8 * (self.split.root.len() as u64).pow(2),
            ..FactorEffort::default()
        }
    }

    fn longest(&self) -> usize {
        self.split.root.len().pow(2)
    }

    fn bytes(&self) -> u64 {
        self.split.bytes()
    }

    fn is_alive(&self) -> bool {
        self.job.is_alive()
    }

    fn factor(
        self: Arc<Self>,
        matrix: &BlockCsr,
        workspace: &Workspace,
    ) -> Result<(Box<dyn Interior>, Numbers), LinearError> {
        let c = self.split.root.len();
        let mut schur = workspace.take(c * c)?;
        schur.fill(0.0);
        let factor = Factor::new(&self, matrix, &mut schur)?;
        factor.test(matrix, &schur)?;
        Ok((Box::new(factor), schur))
    }
}

impl Body {
    /// Writes the lower triangle, in shares of as many entries for each rank.
    fn write(&self, matrix: &BlockCsr) -> Result<String, LinearError> {
        let (name, path) = self.job.new_file();
        let (mut all, mut infinite) = (0_u64, None);
        for i in 0..self.split.len() {
            self.split.row(matrix, i, |j, value| {
                all += u64::from(j <= i);
                if !value.is_finite() {
                    infinite = Some(self.split.dof(i));
                }
            });
        }
        if let Some(dof) = infinite {
            return Err(LinearError::NotFinite { dof });
        }
        let ranks = self.options.ranks as u64;
        let write = || -> io::Result<()> {
            let (mut row, mut rest) = (0, Vec::new());
            for rank in 0..ranks {
                let share = (rank + 1) * all / ranks - rank * all / ranks;
                let path = path.with_extension(rank.to_string());
                let mut file = WordWriter::new(&path, 1 + 2 * share)?;
                file.word(share)?;
                let mut written = 0;
                while written < share {
                    if rest.is_empty() {
                        self.split.row(matrix, row, |j, value| {
                            if j <= row {
                                rest.push((row as u64 | (j as u64) << 32, value));
                            }
                        });
                        row += 1;
                    }
                    let now = rest.len().min((share - written) as usize);
                    for (place, value) in rest.drain(..now) {
                        file.word(place)?;
                        file.word(value.to_bits())?;
                    }
                    written += now as u64;
                }
                file.finish()?;
            }
            Ok(())
        };
        write().map_err(|e| self.job.trouble(&e))?;
        Ok(name)
    }
}

impl Factor {
    /// Factors a body; its Schur complement goes to `schur`.
    fn new(body: &Arc<Body>, matrix: &BlockCsr, schur: &mut [f64]) -> Result<Factor, LinearError> {
        let mut number = Number {
            job: Arc::clone(&body.job),
            number: body.job.take_number()?,
            factored: false,
        };
        let file = body.write(matrix)?;
        let (n, c) = (body.split.len(), body.split.root.len());
        let MumpsOptions {
            out_of_core,
            low_rank,
            memory,
            ..
        } = body.options;
        let answer = body.job.ask(&format!(
            "factor {} {n} {c} {} {:e} {} {file}",
            number.number,
            u8::from(out_of_core),
            low_rank.unwrap_or(0.0),
            memory.map_or(0, |bytes| (bytes / MIB).max(1)),
        ))?;
        let figures = answer.map_err(|words| refusal(&words))?;
        number.factored = true;
        let figure = |at: usize| figures.get(at).and_then(|w| w.parse::<f64>().ok());
        for (at, most) in body.job.memory.iter().enumerate() {
            let bytes = 1024.0 * figure(at).unwrap_or(0.0);
            most.fetch_max(bytes as u64, Ordering::Relaxed);
        }
        let path = body.job.folder().join(format!("{file}.schur"));
        let mut read = || -> io::Result<()> {
            let mut reader = WordReader::new(&path, c * (c + 1) / 2)?;
            for (j, column) in schur.chunks_exact_mut(c.max(1)).enumerate() {
                reader.numbers(&mut column[j..])?;
            }
            reader.finish()
        };
        if c > 0 {
            read().map_err(|e| body.job.trouble(&e))?;
        }
        Ok(Factor {
            body: Arc::clone(body),
            number,
            effort: FactorEffort {
                flops: figure(2).unwrap_or(0.0),
                nonzeros: figure(3).unwrap_or(0.0),
                bytes: body.effort().bytes,
            },
            last: Mutex::default(),
        })
    }

    /// Finds displacements that are known from the forces that belong to them, and refuses a factor that does not: MUMPS says of no pivot how small it is.
    fn test(&self, matrix: &BlockCsr, schur: &[f64]) -> Result<(), LinearError> {
        let split = &self.body.split;
        let (n, inner, c) = (split.len(), split.interior.len(), split.root.len());
        let known: Vec<f64> = (0..n)
            .map(|i| ((i * 7919 + 13) % 1009) as f64 / 504.5 - 1.0)
            .collect();
        let mut forces = vec![0.0; n];
        for (i, force) in forces.iter_mut().enumerate() {
            split.row(matrix, i, |j, value| *force += value * known[j]);
        }
        let (interior, root) = forces.split_at_mut(inner);
        self.reduce(interior, root, 1)?;
        let mut left = root.to_vec();
        for (j, column) in schur.chunks_exact(c.max(1)).enumerate() {
            let (x, mut sum) = (&known[inner..], 0.0);
            for i in j + 1..c {
                left[i] -= column[i] * x[j];
                sum += column[i] * x[i];
            }
            left[j] -= column[j] * x[j] + sum;
        }
        self.recover(interior, &known[inner..], 1)?;
        let size = |v: &mut dyn Iterator<Item = f64>| {
            v.fold(0.0, |m: f64, x| if x.is_nan() { x } else { m.max(x.abs()) })
        };
        let wrong = size(&mut interior.iter().zip(&known).map(|(a, b)| a - b));
        let odd = size(&mut left.iter().copied())
            / size(&mut root.iter().copied()).max(f64::MIN_POSITIVE);
        if wrong < TRUST && (odd < TRUST || c == 0) {
            return Ok(());
        }
        Err(match self.body.options.low_rank {
            Some(eps) => LinearError::Engine {
                message: format!(
                    "MUMPS: with `low-rank = {eps:e}` solutions are wrong by {:.1e}",
                    wrong.max(odd)
                ),
                help: "a smaller `solver.engine.mumps.low-rank`, or none".into(),
            },
            None => LinearError::Indefinite,
        })
    }

    /// Lets the ranks solve: vectors go there, and the result is written to `out`.
    fn solve(&self, command: &str, vectors: &[&[f64]], out: &mut [f64]) -> Result<(), LinearError> {
        let job = &self.body.job;
        let (name, path) = job.new_file();
        let write = || -> io::Result<()> {
            let count: usize = vectors.iter().map(|v| v.len()).sum();
            let mut file = WordWriter::new(&path, count as u64)?;
            vectors.iter().try_for_each(|v| file.numbers(v))?;
            file.finish()
        };
        write().map_err(|e| job.trouble(&e))?;
        let answer = job.ask(&format!("{command} {name}"))?;
        answer.map_err(|words| refusal(&words))?;
        let result = path.with_extension("out");
        let mut read = || -> io::Result<()> {
            let mut reader = WordReader::new(&result, out.len())?;
            reader.numbers(out)?;
            reader.finish()
        };
        read().map_err(|e| job.trouble(&e))
    }
}

impl Interior for Factor {
    fn ordered(&self) -> &dyn Ordered {
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
        let mut vectors: Vec<&[f64]> = Vec::with_capacity(2 * columns);
        for k in 0..columns {
            vectors.push(&interior[k * inner..(k + 1) * inner]);
            vectors.push(&root[k * c..(k + 1) * c]);
        }
        let mut out = vec![0.0; root.len()];
        let number = self.number.number;
        self.solve(&format!("reduce {number} {columns}"), &vectors, &mut out)?;
        root.copy_from_slice(&out);
        last.extend_from_slice(interior);
        Ok(())
    }

    fn recover(
        &self,
        interior: &mut [f64],
        root: &[f64],
        columns: usize,
    ) -> Result<(), LinearError> {
        self.lengths(interior, root, columns);
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        // In motion the forces are those that were reduced last, and half of the work is done.
        let known = *last == *interior;
        last.clear();
        let command = format!(
            "expand {} {columns} {}",
            self.number.number,
            u8::from(!known)
        );
        let mut out = vec![0.0; interior.len()];
        match known {
            true => self.solve(&command, &[root], &mut out)?,
            false => self.solve(&command, &[interior, root], &mut out)?,
        }
        interior.copy_from_slice(&out);
        Ok(())
    }

    fn bytes(&self) -> u64 {
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        8 * last.capacity() as u64
    }

    fn effort(&self) -> FactorEffort {
        self.effort
    }

    fn is_alive(&self) -> bool {
        self.body.job.is_alive()
    }
}

impl Factor {
    /// Checks the lengths and returns the numbers of eliminated and of kept dofs.
    fn lengths(&self, interior: &[f64], root: &[f64], columns: usize) -> (usize, usize) {
        let split = &self.body.split;
        let (n, c) = (split.interior.len(), split.root.len());
        assert_eq!(interior.len(), n * columns, "length of the interior");
        assert_eq!(root.len(), c * columns, "length of the root");
        (n, c)
    }
}

/// What MUMPS complains of: `INFOG(1) INFOG(2) PHASE`.
fn refusal(words: &[String]) -> LinearError {
    let number = |at: usize| words.get(at).and_then(|w| w.parse::<i64>().ok());
    let (code, detail) = (number(0).unwrap_or(0), number(1).unwrap_or(0));
    let phase = words.get(2..).map_or(String::new(), |rest| rest.join(" "));
    let (what, help) = match code {
        -10 | -6 => return LinearError::Indefinite,
        -5 | -7 | -13 => ("memory could not be had", MEMORY),
        -8 | -9 | -11 | -14 | -15 | -17 | -19 | -20 => {
            ("the memory that a rank may take does not suffice", MEMORY)
        }
        -90 => (
            "factors could not be written to disk",
            "let STICKSLIP_MUMPS_DIR name a folder with enough space, or leave `out-of-core` out",
        ),
        -51 | -52 => (
            "the body is too large for the integers of this MUMPS",
            "a MUMPS with 64-bit integers",
        ),
        _ => (
            "it gave up",
            "the users' guide of MUMPS says what INFOG means; leave `solver.engine` out to use the built-in engine",
        ),
    };
    LinearError::Engine {
        message: format!("MUMPS, {phase}: {what} (INFOG(1) = {code}, INFOG(2) = {detail})"),
        help: help.into(),
    }
}
