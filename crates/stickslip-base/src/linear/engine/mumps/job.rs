use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::folder::Folder;
use super::program;
use super::refusal::refusal;
use super::words::{WordReader, WordWriter};
use crate::linear::LinearError;

/// Version of the protocol.
const PROTOCOL: &str = "3";

/// Bodies with a factor at a time.
const BODIES: usize = 256;

/// How long the ranks may take to start.
const START: Duration = Duration::from_secs(120);

/// How long they may take to end.
const TIME_TO_END: Duration = Duration::from_secs(10);

/// Lines of what a job says on its standard error that are kept, and shown.
const KEPT_LINES: usize = 100;
const SHOWN: usize = 4;

/// What to do.
const NOT_STARTED: &str = "try `mpirun -n 2 hostname`; the program must have been built with the MPI whose mpirun starts it: `cargo xtask engine mumps`";
const DIED: &str = "what it was working on is lost; start again, or go on from the last checkpoint by `stickslip resume`";

/// An MPI job, its folder, and the talk with its rank 0.
#[derive(Debug)]
pub(super) struct Job {
    /// Its version of MUMPS.
    pub version: String,
    folder: Folder,
    talk: Mutex<Talk>,
    alive: AtomicBool,
    files: AtomicU64,
    /// Most memory of a rank so far, and that of all of them `[bytes]`.
    pub memory: [AtomicU64; 2],
    dealt: Mutex<Dealt>,
}

/// What the ranks were given for the matrices of all bodies.
#[derive(Debug, Clone, Default)]
pub(super) struct Dealt {
    /// Cells that each rank has computed, and the bytes it was sent for them.
    pub cells: Vec<u64>,
    pub bytes: Vec<u64>,
    /// Entries that were computed here.
    pub entries: u64,
}

#[derive(Debug)]
struct Talk {
    child: Child,
    input: Option<ChildStdin>,
    answers: Receiver<String>,
    errors: Arc<Mutex<Vec<String>>>,
    name: String,
    /// Marks of numbers that bodies are known by.
    taken: [bool; BODIES],
    /// Why it ended.
    over: Option<LinearError>,
}

impl Job {
    /// Starts the ranks.
    ///
    /// # Errors
    /// [`LinearError::Engine`].
    pub fn start(ranks: usize) -> Result<Job, LinearError> {
        let folder = Folder::new().map_err(|e| unusable(&e))?;
        let (mut command, name) = program::command(ranks, folder.path())?;
        let mut child = command
            .spawn()
            .map_err(|e| program::no_launcher(&name, &e))?;
        let (sender, answers) = channel();
        if let Some(out) = child.stdout.take() {
            let lines = BufReader::new(out).lines().map_while(Result::ok);
            std::thread::spawn(move || lines.map(|l| sender.send(l)).all(|sent| sent.is_ok()));
        }
        let errors = Arc::new(Mutex::new(Vec::new()));
        if let Some(out) = child.stderr.take() {
            let kept = Arc::clone(&errors);
            std::thread::spawn(move || listen(out, &kept));
        }
        let mut talk = Talk {
            input: child.stdin.take(),
            child,
            answers,
            errors,
            name,
            taken: [false; BODIES],
            over: None,
        };
        let version = match talk.greeting(ranks) {
            Ok(version) => version,
            Err(error) => {
                talk.end();
                return Err(error);
            }
        };
        Ok(Job {
            version,
            folder,
            talk: Mutex::new(talk),
            alive: AtomicBool::new(true),
            files: AtomicU64::new(0),
            memory: Default::default(),
            dealt: Mutex::default(),
        })
    }

    pub fn is_alive(&self) -> bool {
        self.alive.load(Ordering::Relaxed)
    }

    /// Why it has ended, if it has.
    pub fn fault(&self) -> Option<LinearError> {
        if self.is_alive() {
            return None;
        }
        let mut talk = self.talk.lock().unwrap_or_else(PoisonError::into_inner);
        Some(match &talk.over {
            Some(over) => over.clone(),
            None => talk.died("has died", DIED),
        })
    }

    /// What the ranks were given so far.
    pub fn dealt(&self) -> MutexGuard<'_, Dealt> {
        self.dealt.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// A name for a file that no other has, and its path.
    pub fn new_file(&self) -> (String, PathBuf) {
        let name = format!("f{}", self.files.fetch_add(1, Ordering::Relaxed));
        let path = self.folder().join(&name);
        (name, path)
    }

    /// A number for a body.
    ///
    /// # Errors
    /// [`LinearError::Engine`] if there are too many.
    pub fn take_number(&self) -> Result<usize, LinearError> {
        let mut talk = self.talk.lock().unwrap_or_else(PoisonError::into_inner);
        let free = talk.taken.iter().position(|taken| !taken);
        let free = free.ok_or_else(|| LinearError::Engine {
            message: format!("the engine `mumps` has factors of {BODIES} bodies already"),
            help: "leave `solver.engine` out: it is for few large bodies".into(),
        })?;
        talk.taken[free] = true;
        Ok(free)
    }

    /// A body is gone: so is its factor if it has one.
    pub fn give_number(&self, number: usize, factored: bool) {
        let freed = factored.then(|| self.ask(&format!("free {number}")));
        // A job that has ended has no factors.
        drop(freed);
        let mut talk = self.talk.lock().unwrap_or_else(PoisonError::into_inner);
        talk.taken[number] = false;
    }

    /// That a file could not be written or read: as ranks end they take the folder along, and then that is the reason.
    pub fn trouble(&self, error: &std::io::Error) -> LinearError {
        if self.folder().is_dir() {
            return unusable(error);
        }
        self.alive.store(false, Ordering::Relaxed);
        self.fault().unwrap_or_else(|| unusable(error))
    }

    /// Has the ranks do something with vectors. Returns the path of their file, beside which there are those of what came of it.
    ///
    /// # Errors
    /// [`LinearError::Engine`], and what MUMPS complains of.
    pub fn send(&self, command: &str, vectors: &[&[f64]]) -> Result<PathBuf, LinearError> {
        let (name, path) = self.new_file();
        let write = || -> io::Result<()> {
            let mut file = WordWriter::new(&path)?;
            vectors.iter().try_for_each(|v| file.numbers(v))?;
            file.finish()
        };
        write().map_err(|e| self.trouble(&e))?;
        let answer = self.ask(&format!("{command} {name}"))?;
        answer.map_err(|words| refusal(&words))?;
        Ok(path)
    }

    /// The same, and reads what came of it.
    ///
    /// # Errors
    /// As for [`send`](Job::send).
    pub fn vectors(
        &self,
        command: &str,
        vectors: &[&[f64]],
        out: &mut [f64],
    ) -> Result<(), LinearError> {
        let result = self.send(command, vectors)?.with_extension("out");
        let read = WordReader::new(&result).and_then(|mut reader| {
            reader.numbers(out)?;
            reader.finish()
        });
        read.map_err(|e| self.trouble(&e))
    }

    /// Sends a command, and waits for its answer: the words behind `ok`, or behind `error`. Nothing in here uses the threads of rayon: one that waits for others could
    /// take up work that comes here as well.
    ///
    /// # Errors
    /// [`LinearError::Engine`] if the job has ended.
    pub fn ask(&self, command: &str) -> Result<Answer, LinearError> {
        let mut talk = self.talk.lock().unwrap_or_else(PoisonError::into_inner);
        let answer = talk.ask(command);
        if answer.is_err() {
            self.alive.store(false, Ordering::Relaxed);
            self.folder.remove();
        }
        answer
    }
}

impl Drop for Job {
    fn drop(&mut self) {
        let talk = self.talk.get_mut();
        talk.unwrap_or_else(PoisonError::into_inner).end();
    }
}

/// What came of a command: the words behind `ok`, or those behind `error`.
pub(super) type Answer = Result<Vec<String>, Vec<String>>;

impl Talk {
    /// The version of MUMPS, when all ranks are there.
    fn greeting(&mut self, ranks: usize) -> Result<String, LinearError> {
        let started = Instant::now();
        loop {
            let left = START.saturating_sub(started.elapsed());
            let line = match self.answers.recv_timeout(left) {
                Ok(line) => line,
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(self.died("did not start", NOT_STARTED));
                }
                Err(RecvTimeoutError::Timeout) => {
                    let late = format!("was not ready in {} s", START.as_secs());
                    return Err(self.died(&late, NOT_STARTED));
                }
            };
            let words: Vec<&str> = line.split_whitespace().collect();
            let ["ready", protocol, version, there] = words[..] else {
                continue;
            };
            if protocol != PROTOCOL {
                return Err(LinearError::Engine {
                    message: format!(
                        "stickslip-mumps speaks version {protocol} of the protocol, and this program {PROTOCOL}"
                    ),
                    help: "build both from the same source: `cargo xtask engine mumps`".into(),
                });
            }
            if there != ranks.to_string() {
                return Err(LinearError::Engine {
                    message: format!("{ranks} ranks were asked for, and stickslip-mumps knows of {there}"),
                    help: "it was built with another MPI than the one that started it: see `mpirun --version` and `mpicc --version`".into(),
                });
            }
            return Ok(version.to_string());
        }
    }

    fn ask(&mut self, command: &str) -> Result<Answer, LinearError> {
        if let Some(over) = &self.over {
            return Err(over.clone());
        }
        let input = self.input.as_mut();
        // If it cannot be written, no answer will come either, and that says more.
        let _ = input.map(|i| {
            i.write_all(format!("{command}\n").as_bytes())
                .and_then(|()| i.flush())
        });
        loop {
            let Ok(line) = self.answers.recv() else {
                return Err(self.died("has died", DIED));
            };
            let mut words = line.split_whitespace().map(str::to_string);
            match words.next().as_deref() {
                Some("ok") => return Ok(Ok(words.collect())),
                Some("error") => return Ok(Err(words.collect())),
                // What libraries print.
                _ => {}
            }
        }
    }

    /// The job has ended, or is to.
    fn died(&mut self, how: &str, help: &str) -> LinearError {
        self.end();
        let status = self.child.try_wait().ok().flatten();
        let status = status.map_or(String::new(), |s| format!(" ({}: {s})", self.name));
        // Its last words may still be under way.
        std::thread::sleep(Duration::from_millis(50));
        let errors = self.errors.lock().unwrap_or_else(PoisonError::into_inner);
        let said = telling(&errors);
        let over = LinearError::Engine {
            message: format!("the engine `mumps` {how}{status}{said}"),
            help: help.into(),
        };
        self.over = Some(over.clone());
        over
    }

    /// Ends the job, in one way or another.
    fn end(&mut self) {
        if let Some(mut input) = self.input.take() {
            // It may have ended.
            let _ = input.write_all(b"quit\n");
        }
        let started = Instant::now();
        while started.elapsed() < TIME_TO_END {
            match self.child.try_wait() {
                Ok(None) => std::thread::sleep(Duration::from_millis(5)),
                _ => return,
            }
        }
        // The ranks see that their parent is gone.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Keeps the last lines.
fn listen(out: impl Read, kept: &Mutex<Vec<String>>) {
    for line in BufReader::new(out).lines().map_while(Result::ok) {
        let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.len() == KEPT_LINES {
            kept.remove(0);
        }
        kept.push(line);
    }
}

/// What a job said: what the program itself said, or what MPI says of the process that ended first, or what was said last.
fn telling(lines: &[String]) -> String {
    let mut said: Vec<&str> = lines.iter().map(|l| l.trim()).collect();
    said.retain(|l| l.chars().any(char::is_alphanumeric));
    let with = |word: &str| -> Vec<&str> {
        let lines = said.iter().copied();
        lines.filter(|l| l.contains(word)).collect()
    };
    let told = [
        with("stickslip-mumps, rank"),
        with("noticed that process"),
        said.clone(),
    ];
    let told = told.into_iter().find(|l| !l.is_empty()).unwrap_or_default();
    let first = told.len().saturating_sub(SHOWN);
    match told[first..].join(" ") {
        nothing if nothing.is_empty() => nothing,
        words => format!(": {words}"),
    }
}

/// That files cannot be exchanged.
fn unusable(error: &std::io::Error) -> LinearError {
    LinearError::Engine {
        message: format!("files for the engine `mumps`: {error}"),
        help: "let STICKSLIP_MUMPS_DIR name a folder with enough space that all machines of the job see".into(),
    }
}
