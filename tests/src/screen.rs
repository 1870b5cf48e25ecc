//! An invisible screen (Xvfb) with mouse and keys (xdotool), for tests of the editor's real window.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::command::impasto;

/// The longest that a test waits for anything; a busy machine may be slow.
const PATIENCE: Duration = Duration::from_secs(120);
const PAUSE: Duration = Duration::from_millis(30);

/// Width and height of a screen in pixels: the size with which the editor's window opens.
pub const SIZE_PX: [usize; 2] = [1280, 800];

/// Repeats `look` until it returns something.
///
/// # Panics
/// When `look` returns nothing within `PATIENCE`; the message says what was awaited.
pub fn wait_for<T>(what: &str, mut look: impl FnMut() -> Option<T>) -> T {
    let began = Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(began.elapsed() < PATIENCE, "waited {} s in vain: {what}", PATIENCE.as_secs());
        std::thread::sleep(PAUSE);
    }
}

/// A running Xvfb. It ends when this is dropped, and also when the tests crash or are killed.
pub struct Screen {
    shell: Child,
    display: String,
    folder: tempfile::TempDir,
}

impl Screen {
    /// Opens a screen; `None`, with a line on stderr, if Xvfb or xdotool is missing.
    ///
    /// # Panics
    /// When one of them is missing in CI (`CI` is set), or Xvfb does not start.
    pub fn open() -> Option<Self> {
        for program in ["Xvfb", "xdotool"] {
            let path = std::env::var_os("PATH").unwrap_or_default();
            if std::env::split_paths(&path).any(|folder| folder.join(program).is_file()) {
                continue;
            }
            assert!(std::env::var_os("CI").is_none(), "{program} is missing; `cargo xtask test` installs it");
            // Not `eprintln!`: the test runner shows its output only for failing tests.
            let _ =
                writeln!(std::io::stderr(), "ignored: {program} is missing; `cargo xtask test` installs it");
            return None;
        }
        let folder = tempfile::tempdir().expect("a temporary folder");
        // `cat` ends when the pipe to the shell closes, however the tests end; then the shell kills Xvfb. The shell
        // closes its own stdout, so that reading the display's number below ends even if Xvfb does not start.
        let script = r#"trap "" INT; "$@" & exec >/dev/null; cat; kill $! 2>/dev/null; wait"#;
        let mut shell = Command::new("sh")
            .args([
                "-c",
                script,
                "sh",
                "Xvfb",
                "-displayfd",
                "1",
                "-nolisten",
                "tcp",
                "-noreset",
                "-screen",
                "0",
            ])
            .arg(format!("{}x{}x24", SIZE_PX[0], SIZE_PX[1]))
            .arg("-fbdir")
            .arg(folder.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(std::fs::File::create(folder.path().join("words")).expect("a file for its words"))
            .spawn()
            .expect("a shell");
        let mut number = String::new();
        let out = shell.stdout.take().expect("its stdout is a pipe");
        BufReader::new(out).read_line(&mut number).expect("a number, or nothing");
        let screen = Self { shell, display: format!(":{}", number.trim()), folder };
        let words = std::fs::read_to_string(screen.folder.path().join("words")).unwrap_or_default();
        assert!(!number.trim().is_empty(), "Xvfb does not start: {words}");
        Some(screen)
    }

    /// Saves the screen as a PNG in `editor_window/` of the target folder, for people to look at; returns its path.
    ///
    /// # Panics
    /// When Xvfb's picture is not of `SIZE_PX` with 32 bits a pixel, or the PNG cannot be written.
    pub fn keep_picture(&self, name: &str) -> PathBuf {
        let target = impasto().ancestors().nth(2).expect("target/debug/impasto lies two folders down");
        let folder = target.join("editor_window");
        std::fs::create_dir_all(&folder).expect("a folder for pictures");
        let path = folder.join(format!("{name}.png"));
        let xwd = std::fs::read(self.folder.path().join("Xvfb_screen0")).expect("Xvfb's picture");
        // The header in X11/XWDFile.h: words of 32 bits, most significant byte first.
        let word = |index: usize| {
            let bytes = xwd[4 * index..4 * index + 4].try_into().expect("four bytes");
            u32::from_be_bytes(bytes) as usize
        };
        let (width, height, line, colours) = (word(4), word(5), word(12), word(19));
        assert_eq!([width, height, word(11)], [SIZE_PX[0], SIZE_PX[1], 32]);
        let first = word(0) + 12 * colours;
        let rgb: Vec<u8> = (0..height)
            .flat_map(|row| xwd[first + row * line..][..4 * width].chunks_exact(4))
            .flat_map(|pixel| [pixel[2], pixel[1], pixel[0]])
            .collect();
        let file = std::fs::File::create(&path).expect("a file for the picture");
        let mut encoder = png::Encoder::new(file, width as u32, height as u32);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(&rgb).expect("pixels");
        path
    }

    /// Runs xdotool; returns what it prints, or `None` if it fails or takes too long.
    pub fn try_xdotool(&self, arguments: &[&str]) -> Option<String> {
        let mut process = Command::new("xdotool")
            .args(arguments)
            .env("DISPLAY", &self.display)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("xdotool starts");
        let status = wait_or_kill(&mut process, PATIENCE)?;
        let mut printed = String::new();
        process.stdout.take().expect("its stdout is a pipe").read_to_string(&mut printed).expect("text");
        status.success().then(|| printed.trim_end().to_owned())
    }

    /// Runs xdotool, which moves the mouse and presses keys.
    ///
    /// # Panics
    /// When xdotool fails.
    pub fn xdotool(&self, arguments: &[&str]) {
        assert!(self.try_xdotool(arguments).is_some(), "xdotool {} failed", arguments.join(" "));
    }

    /// Clicks with the left button at a place of the screen.
    ///
    /// # Panics
    /// When xdotool fails.
    pub fn click(&self, [x, y]: [i32; 2]) {
        self.xdotool(&["mousemove", &x.to_string(), &y.to_string(), "click", "1"]);
    }

    /// Types a text into what has the keyboard's focus.
    ///
    /// # Panics
    /// When xdotool fails.
    pub fn type_text(&self, text: &str) {
        self.xdotool(&["type", "--delay", "40", text]);
    }

    /// Drags with the left button from one place of the screen to another, in even steps.
    ///
    /// # Panics
    /// When xdotool fails.
    pub fn drag(&self, from: [i32; 2], to: [i32; 2]) {
        const STEPS: i32 = 20;
        let mut script = format!("mousemove {} {} sleep 0.1 mousedown 1 sleep 0.05", from[0], from[1]);
        for step in 1..=STEPS {
            let [x, y] = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * step / STEPS);
            script += &format!(" mousemove {x} {y} sleep 0.03");
        }
        script += " mouseup 1";
        self.xdotool(&script.split(' ').collect::<Vec<_>>());
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        drop(self.shell.stdin.take());
        wait_or_kill(&mut self.shell, Duration::from_secs(10));
    }
}

/// Waits for a process to end, and returns its status; `None` if it had to be killed after `most`.
fn wait_or_kill(process: &mut Child, most: Duration) -> Option<std::process::ExitStatus> {
    let began = Instant::now();
    while began.elapsed() < most {
        if let Ok(Some(status)) = process.try_wait() {
            return Some(status);
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let _ended_already = process.kill();
    let _ = process.wait();
    None
}

/// Where a control of the window lies, in pixels of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ControlRect {
    /// X and Y of its upper left corner.
    pub corner: [i32; 2],
    /// Width and height.
    pub size: [i32; 2],
}

impl ControlRect {
    /// The place at these shares of its width and height.
    pub fn at(&self, shares: [f64; 2]) -> [i32; 2] {
        [0, 1].map(|axis| self.corner[axis] + (f64::from(self.size[axis]) * shares[axis]).round() as i32)
    }

    /// Its middle.
    pub fn middle(&self) -> [i32; 2] {
        self.at([0.5; 2])
    }
}

/// `impasto edit` with its window on a [`Screen`], at the screen's upper left corner, with the keyboard's focus.
/// Dropping this ends the editor; a test that fails leaves a picture of the screen.
pub struct EditorWindow<'a> {
    /// The screen that it is on.
    pub screen: &'a Screen,
    name: &'static str,
    process: Child,
    window: String,
    /// The file that its stderr is written to.
    words: PathBuf,
}

impl<'a> EditorWindow<'a> {
    /// Opens a file of a folder and waits until it is painted. The folder is also the user's home, and takes the
    /// editor's preferences. Names of saved pictures begin with `name`.
    ///
    /// # Panics
    /// When the window does not come, or is never painted.
    pub fn open(screen: &'a Screen, name: &'static str, folder: &Path, file: &str) -> Self {
        let mut editor = Self::start(screen, name, folder, &[file]);
        editor.rest_after(0);
        editor
    }

    /// Like [`EditorWindow::open`] with these arguments (none for an empty window), but waits only for the window.
    ///
    /// # Panics
    /// When the window does not come.
    pub fn start(screen: &'a Screen, name: &'static str, folder: &Path, arguments: &[&str]) -> Self {
        let words = folder.join("words");
        let process = Command::new(impasto())
            .arg("edit")
            .args(arguments)
            .args(["--in-app-dialogs", "--tell"])
            .current_dir(folder)
            .env("DISPLAY", &screen.display)
            .env("WINIT_X11_SCALE_FACTOR", "1")
            .env("IMPASTO_CONFIG_DIR", folder.join("config"))
            .env("HOME", folder)
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(std::fs::File::create(&words).expect("a file for its words"))
            .spawn()
            .expect("impasto starts");
        let mut editor = Self { screen, name, process, window: String::new(), words };
        editor.window = wait_for("a window", || {
            editor.assert_runs();
            let found = screen.try_xdotool(&["search", "--onlyvisible", "--name", " - Impasto$"])?;
            found.lines().next().map(str::to_owned)
        });
        // There is no window manager to place and focus the window.
        screen.xdotool(&[
            "windowmove",
            "--sync",
            &editor.window,
            "0",
            "0",
            "windowfocus",
            "--sync",
            &editor.window,
        ]);
        editor
    }

    fn assert_runs(&mut self) {
        if let Ok(Some(status)) = self.process.try_wait() {
            panic!("the editor ended ({status})");
        }
    }

    fn lines(&self) -> Vec<String> {
        let words = std::fs::read(&self.words).unwrap_or_default();
        String::from_utf8_lossy(&words).lines().map(str::to_owned).collect()
    }

    /// The version of the document in the last finished picture (0 before the first), and what a screen reader says
    /// of the viewport.
    pub fn rest(&self) -> (u64, String) {
        let of_line = |line: &String| {
            let (version, value) = line.strip_prefix("impasto edit: at rest, version ")?.split_once(": ")?;
            Some((version.parse().ok()?, value.to_owned()))
        };
        self.lines().iter().rev().find_map(of_line).unwrap_or_default()
    }

    /// The lines so far that begin with `impasto edit: ` and `kind`, without that beginning.
    pub fn printed(&self, kind: &str) -> Vec<String> {
        let begin = format!("impasto edit: {kind}");
        self.lines().iter().filter_map(|line| line.strip_prefix(&begin)).map(str::to_owned).collect()
    }

    /// Waits for a finished picture of a later version than `version`, and returns its version.
    ///
    /// # Panics
    /// When none comes.
    pub fn rest_after(&mut self, version: u64) -> u64 {
        wait_for(&format!("a picture later than of version {version}"), || {
            self.assert_runs();
            Some(self.rest().0).filter(|shown| *shown > version)
        })
    }

    /// Waits until a screen reader would say this of the viewport.
    ///
    /// # Panics
    /// When it never does.
    pub fn wait_for_value(&mut self, value: &str) {
        wait_for(&format!("the viewport's value {value:?}"), || {
            self.assert_runs();
            (self.rest().1 == value).then_some(())
        });
    }

    /// The controls of this name, as the window last listed them.
    pub fn controls_named(&self, name: &str) -> Vec<ControlRect> {
        let lines = self.lines();
        let mut lists = lines.iter().rev().filter_map(|line| line.strip_prefix("impasto edit: controls:\t"));
        // The last line may be half written.
        let Some(last) = lists.find_map(|line| line.strip_suffix("\tend")) else { return Vec::new() };
        let parts: Vec<&str> = last.split('\t').collect();
        let number = |text: &str| text.parse::<i32>().expect("a number");
        let named = parts.chunks_exact(5).filter(|control| control[0] == name);
        named
            .map(|control| ControlRect {
                corner: [number(control[1]), number(control[2])],
                size: [number(control[3]), number(control[4])],
            })
            .collect()
    }

    /// Waits for the control of this name, and returns where it lies.
    ///
    /// # Panics
    /// When it never appears, or two controls have the name.
    pub fn control(&mut self, name: &str) -> ControlRect {
        wait_for(&format!("the control {name:?}"), || {
            self.assert_runs();
            let found = self.controls_named(name);
            assert!(found.len() <= 1, "{} controls have the name {name:?}", found.len());
            found.first().copied()
        })
    }

    /// Waits until no control has this name.
    ///
    /// # Panics
    /// When a control keeps the name.
    pub fn wait_until_gone(&mut self, name: &str) {
        wait_for(&format!("the end of the control {name:?}"), || {
            self.assert_runs();
            self.controls_named(name).is_empty().then_some(())
        });
    }

    /// Clicks in the middle of the control of this name, once it is there.
    ///
    /// # Panics
    /// As [`EditorWindow::control`].
    pub fn click(&mut self, name: &str) {
        let middle = self.control(name).middle();
        self.screen.click(middle);
    }

    /// The words in its title bar.
    pub fn title(&self) -> String {
        self.screen.try_xdotool(&["getwindowname", &self.window]).unwrap_or_default()
    }

    /// Waits for these words in its title bar.
    ///
    /// # Panics
    /// When they never come.
    pub fn wait_for_title(&mut self, title: &str) {
        wait_for(&format!("the title {title:?}"), || {
            self.assert_runs();
            (self.title() == title).then_some(())
        });
    }

    /// Presses keys one after the other, by their X names: `ctrl+s`.
    ///
    /// # Panics
    /// When xdotool fails.
    pub fn keys(&self, keys: &[&str]) {
        self.screen.xdotool(&[&["key", "--delay", "60"], keys].concat());
    }

    /// Keeps a picture of the screen as it is now.
    pub fn keep_picture(&self, moment: &str) -> PathBuf {
        self.screen.keep_picture(&format!("{}_{moment}", self.name))
    }

    /// Quits by Ctrl Q, waits for the end, and returns the exit code.
    ///
    /// # Panics
    /// When it does not end.
    pub fn quit(mut self) -> Option<i32> {
        self.keys(&["ctrl+q"]);
        wait_for("the end, by Ctrl Q", || self.process.try_wait().ok().flatten()).code()
    }
}

impl Drop for EditorWindow<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            eprintln!("the screen as it was: {}", self.keep_picture("failed").display());
            eprintln!("the editor's words: {:#?}", self.lines());
        }
        let _ended_already = self.process.kill();
        let _ = self.process.wait();
    }
}
