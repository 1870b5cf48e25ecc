//! Builds and runs peers, the programs that Impasto is timed beside: C++ from `bench/peers/*.cpp`, Python from
//! `bench/peers/*.py`. They talk with the benchmark like this:
//!
//! ```text
//! start: arguments name files of little-endian f32 and u32
//!        the peer does its task once and writes its answer to a file
//!        peer ─▶ {"ready": true}, with the seconds of this first run if they are useful
//! round: "go 3" ─▶ peer does the task three times ─▶ {"secs": 1.25}, the seconds of all three
//! end:   the peer's input is closed
//! ```

pub mod files;
pub mod toolchain;

use std::fs::File;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use anyhow::{Context as _, bail};

use toolchain::{build_cpp, make_python};

/// Builds and starts peers.
pub struct Peers {
    root: PathBuf,
    /// The Python interpreter, or why there is none; `None` until it is first needed.
    python: Option<Result<PathBuf, String>>,
    may_fetch: bool,
}

/// A running peer that waits for rounds.
pub struct Peer {
    name: String,
    child: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    first_secs: f64,
    errors: PathBuf,
}

impl Peers {
    /// The peers of the repository at this folder. `may_fetch` allows Python packages to be fetched from the network.
    pub fn new(root: &Path, may_fetch: bool) -> Self {
        Self { root: root.to_path_buf(), python: None, may_fetch }
    }

    /// The folder for files exchanged with peers.
    pub fn folder(&self) -> anyhow::Result<PathBuf> {
        let folder = self.root.join("out/bench/tmp");
        std::fs::create_dir_all(&folder).with_context(|| format!("{} cannot be made", folder.display()))?;
        Ok(folder)
    }

    /// Builds and starts `bench/peers/NAME.cpp`.
    ///
    /// # Errors
    /// When it cannot be built or started on this machine.
    pub fn cpp(&self, name: &str, arguments: &[String]) -> anyhow::Result<Peer> {
        let program = build_cpp(&self.root.join("bench/peers"), name)?;
        Peer::start(&self.folder()?, name, Command::new(program), arguments)
    }

    /// Starts `bench/peers/SCRIPT.py WAY`.
    ///
    /// # Errors
    /// When Python or a package is missing, or the peer does not start.
    pub fn python(&mut self, script: &str, way: &str, arguments: &[String]) -> anyhow::Result<Peer> {
        let (root, may_fetch) = (&self.root, self.may_fetch);
        let python =
            self.python.get_or_insert_with(|| make_python(root, may_fetch).map_err(|why| format!("{why:#}")));
        let python = python.clone().map_err(anyhow::Error::msg)?;
        let folder = self.folder()?;
        let mut command = Command::new(python);
        command.arg(root.join(format!("bench/peers/{script}.py"))).arg(way);
        command.env("PYTHONDONTWRITEBYTECODE", "1").env("NUMBA_CACHE_DIR", folder.join("numba"));
        Peer::start(&folder, &format!("{script}_{way}"), command, arguments)
    }
}

impl Peer {
    fn start(folder: &Path, name: &str, mut command: Command, arguments: &[String]) -> anyhow::Result<Self> {
        let threads = rayon::current_num_threads().to_string();
        for name in ["OMP_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS", "BENCH_THREADS"] {
            command.env(name, &threads);
        }
        // A peer that waits for its round must not keep the processor busy.
        command.env("OMP_WAIT_POLICY", "PASSIVE");
        let errors = folder.join(format!("{name}.err"));
        command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(File::create(&errors)?);
        let mut child = command.spawn().with_context(|| format!("{name} cannot be started"))?;
        let input = child.stdin.take();
        let output = BufReader::new(child.stdout.take().context("a peer without output")?);
        let mut peer = Self { name: name.to_owned(), child, input, output, first_secs: 0.0, errors };
        let ready = peer.reply()?;
        if ready["ready"] != true {
            bail!("{} did not report that it is ready", peer.name);
        }
        peer.first_secs = ready["secs"].as_f64().unwrap_or(0.0);
        Ok(peer)
    }

    /// Seconds of the first run, before it was ready; 0 where the peer does not report them.
    pub fn first_secs(&self) -> f64 {
        self.first_secs
    }

    /// Runs the task `times` times; returns the seconds of all runs together.
    ///
    /// # Errors
    /// When the peer has ended, or its reply has no seconds.
    pub fn go(&mut self, times: usize) -> anyhow::Result<f64> {
        let input = self.input.as_mut().context("a peer without input")?;
        writeln!(input, "go {times}")
            .and_then(|()| input.flush())
            .with_context(|| format!("{} has ended", self.name))?;
        let reply = self.reply()?;
        reply["secs"].as_f64().with_context(|| format!("{} reported no seconds", self.name))
    }

    /// The next line of the peer's output that is JSON.
    fn reply(&mut self) -> anyhow::Result<serde_json::Value> {
        let mut line = String::new();
        loop {
            line.clear();
            if self.output.read_line(&mut line)? == 0 {
                let said = std::fs::read_to_string(&self.errors).unwrap_or_default();
                let last = said.lines().rev().find(|line| !line.trim().is_empty());
                let last = last.unwrap_or("without a message").trim();
                if last.contains("cannot open shared object file") {
                    bail!("{last}: {}", toolchain::advice());
                }
                bail!("{} ended: {last}", self.name);
            }
            if line.starts_with('{') {
                return serde_json::from_str(&line)
                    .with_context(|| format!("{} wrote invalid JSON", self.name));
            }
        }
    }

    /// This peer as a function that runs a round, for a [`crate::race::Contender`].
    pub fn rounds(mut self) -> impl FnMut(usize) -> anyhow::Result<f64> {
        move |times| self.go(times)
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        // A peer ends when its input is closed. If it has not ended after two seconds, it is killed.
        drop(self.input.take());
        for _ in 0..40 {
            if matches!(self.child.try_wait(), Ok(Some(_)) | Err(_)) {
                return;
            }
            std::thread::sleep(std::time::Duration::from_millis(50));
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
