//! A program on a pseudo-terminal: it gets keys, signals and resizes, and its screen is read.
//!
//! Nothing here sleeps for a result: tests wait for conditions, up to a deadline far beyond the expected time.

use std::ffi::OsString;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use portable_pty::{Child, CommandBuilder, MasterPty, PtySize, native_pty_system};
use rustix::process::{Pid, Signal, WaitOptions, kill_process, waitpid};
use tempfile::TempDir;

/// The time after which a condition counts as never met.
const NEVER: Duration = Duration::from_secs(20);

/// The program to be started, and its environment.
pub(super) struct Setup {
    command: Vec<OsString>,
    size: (u16, u16),
    environment: Vec<(&'static str, OsString)>,
    folder: PathBuf,
}

impl Setup {
    /// A program with its arguments, on a terminal of 80 columns and 24 rows in a UTF-8 locale.
    pub(super) fn new(program: impl Into<OsString>, arguments: &[&str]) -> Self {
        let mut command = vec![program.into()];
        command.extend(arguments.iter().map(OsString::from));
        let environment = [("TERM", "xterm-256color"), ("LANG", "C.UTF-8")];
        let environment = environment.map(|(name, value)| (name, value.into())).to_vec();
        let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        Self { command, size: (80, 24), environment, folder }
    }

    /// The page of `examples/page.rs`.
    pub(super) fn page() -> Self {
        Self::new(page(), &[])
    }

    /// A shell's command line in which `$0` is the page.
    pub(super) fn page_under(line: &str) -> Self {
        let mut setup = Self::new("sh", &["-c", line]);
        setup.command.push(page().into());
        setup
    }

    /// Sets the size: columns, rows.
    pub(super) fn size(mut self, columns: u16, rows: u16) -> Self {
        self.size = (columns, rows);
        self
    }

    /// Adds an argument.
    pub(super) fn argument(mut self, argument: impl Into<OsString>) -> Self {
        self.command.push(argument.into());
        self
    }

    /// Sets an environment variable; the last value of a name is used.
    pub(super) fn variable(mut self, name: &'static str, value: impl Into<OsString>) -> Self {
        self.environment.push((name, value.into()));
        self
    }

    /// Sets the working directory.
    pub(super) fn folder(mut self, folder: &Path) -> Self {
        folder.clone_into(&mut self.folder);
        self
    }

    pub(super) fn start(self) -> Session {
        Session::start(self)
    }
}

/// The example's program, which `cargo test` builds along with this test.
fn page() -> PathBuf {
    let test = std::env::current_exe().expect("this test");
    let folder = test.parent().and_then(|deps| deps.parent()).expect("target/debug/deps");
    let page = folder.join("examples/page");
    assert!(page.exists(), "the example `page` is not built: run `cargo build --example page`");
    page
}

/// A program that runs on a pseudo-terminal.
pub(super) struct Session {
    master: Box<dyn MasterPty + Send>,
    keyboard: Box<dyn Write + Send>,
    child: Box<dyn Child + Send + Sync>,
    output: Receiver<Vec<u8>>,
    /// While this lock is held, the terminal takes no output.
    gate: Arc<Mutex<()>>,
    /// Everything that the program has sent so far.
    pub(super) sent: Vec<u8>,
    screen: vt100::Parser,
    /// The terminal's settings before the program started.
    before: String,
    /// The program's state directory, unless the test sets another.
    _state: TempDir,
}

impl Session {
    fn start(setup: Setup) -> Self {
        let (cols, rows) = setup.size;
        let pair = native_pty_system().openpty(pty_size(cols, rows)).expect("a pseudo-terminal");
        let mut command = CommandBuilder::from_argv(setup.command);
        command.env_clear();
        command.env("PATH", std::env::var_os("PATH").unwrap_or_default());
        command.env("HOME", "/nonexistent");
        let state = tempfile::tempdir().expect("a folder of its own");
        command.env("XDG_STATE_HOME", state.path());
        setup.environment.iter().for_each(|(name, value)| command.env(name, value));
        command.cwd(setup.folder);

        let before = settings(&*pair.master);
        let mut reader = pair.master.try_clone_reader().expect("a reader");
        let keyboard = pair.master.take_writer().expect("a writer");
        let child = pair.slave.spawn_command(command).expect("the program starts");
        let (sender, output) = channel();
        let gate = Arc::new(Mutex::new(()));
        let gated = Arc::clone(&gate);
        thread::spawn(move || {
            let mut buffer = [0; 4096];
            while let Ok(count @ 1..) = reader.read(&mut buffer) {
                if sender.send(buffer[..count].to_vec()).is_err() {
                    break;
                }
                drop(gated.lock());
            }
        });
        // A terminal of zero size is treated as one of the usual size.
        let (rows, cols) = if cols == 0 { (24, 80) } else { (rows, cols) };
        let screen = vt100::Parser::new(rows, cols, 0);
        let master = pair.master;
        let sent = Vec::new();
        Self { master, keyboard, child, output, gate, sent, screen, before, _state: state }
    }

    /// Sends keys.
    pub(super) fn press(&mut self, keys: &str) {
        self.keyboard.write_all(keys.as_bytes()).expect("the terminal takes input");
    }

    /// Sends a signal to the program.
    pub(super) fn signal(&self, signal: Signal) {
        kill_process(self.pid(), signal).expect("the program is there");
    }

    /// Changes the window's size.
    pub(super) fn resize(&mut self, columns: u16, rows: u16) {
        self.master.resize(pty_size(columns, rows)).expect("the terminal can be resized");
    }

    /// Runs a closure while the terminal takes no output.
    pub(super) fn stalled<T>(&mut self, run: impl FnOnce(&mut Self) -> T) -> T {
        let gate = Arc::clone(&self.gate);
        let closed = gate.lock();
        let result = run(self);
        drop(closed);
        result
    }

    /// Waits until the screen shows a text.
    pub(super) fn shows(&mut self, text: &str) {
        self.until(&format!("the screen shows {text:?}"), |session| session.text().contains(text));
    }

    /// Waits until a condition is true.
    pub(super) fn until(&mut self, what: &str, holds: impl Fn(&Self) -> bool) {
        let end = Instant::now() + NEVER;
        while !holds(self) {
            assert!(Instant::now() < end, "never: {what}; the screen:\n{}", self.text());
            self.listen(Duration::from_millis(20));
        }
    }

    /// The number of bytes that arrive within a time.
    pub(super) fn bytes_in(&mut self, time: Duration) -> usize {
        let (before, end) = (self.sent.len(), Instant::now() + time);
        while Instant::now() < end {
            self.listen(end.saturating_duration_since(Instant::now()));
        }
        self.sent.len() - before
    }

    /// Waits until nothing has been sent for a time.
    pub(super) fn quiet(&mut self, time: Duration) {
        let end = Instant::now() + NEVER;
        while self.bytes_in(time) > 0 {
            assert!(Instant::now() < end, "never quiet");
        }
    }

    /// Waits for the end and all output; returns the exit status, and how long it took.
    pub(super) fn ends(&mut self) -> (u32, Duration) {
        let start = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().expect("a child of ours") {
                assert_eq!(status.signal(), None, "killed by a signal");
                let took = start.elapsed();
                while self.listen(Duration::from_millis(200)) {}
                return (status.exit_code(), took);
            }
            assert!(start.elapsed() < NEVER, "it does not end; the screen:\n{}", self.text());
            self.listen(Duration::from_millis(5));
        }
    }

    /// Presses a key repeatedly until the program ends; returns the exit status.
    pub(super) fn press_until_it_ends(&mut self, key: &str) -> u32 {
        let end = Instant::now() + NEVER;
        while self.child.try_wait().expect("a child of ours").is_none() {
            assert!(Instant::now() < end, "it does not end");
            self.press(key);
            self.listen(Duration::from_millis(100));
        }
        self.ends().0
    }

    /// Waits until the program is stopped, as a shell would see it.
    pub(super) fn stops(&mut self) {
        let end = Instant::now() + NEVER;
        let options = WaitOptions::UNTRACED | WaitOptions::NOHANG;
        loop {
            let status = waitpid(Some(self.pid()), options).expect("a child of ours");
            match status {
                Some((_, status)) if status.stopped() => break,
                Some((_, status)) => panic!("it ended with {status:?}"),
                None => assert!(Instant::now() < end, "it does not stop"),
            }
            self.listen(Duration::from_millis(5));
        }
        self.listen(Duration::from_millis(20));
    }

    /// Closes the terminal, as when a connection is lost.
    pub(super) fn hang_up(self) -> Box<dyn Child + Send + Sync> {
        self.child
    }

    /// The text on the screen.
    pub(super) fn text(&self) -> String {
        self.screen.screen().contents()
    }

    pub(super) fn screen(&self) -> &vt100::Screen {
        self.screen.screen()
    }

    /// Whether the terminal's settings are the same as before the start.
    pub(super) fn is_cooked(&self) -> bool {
        settings(&*self.master) == self.before
    }

    /// Asserts that the terminal is restored: settings, screen, cursor, modes.
    #[track_caller]
    pub(super) fn assert_restored(&self) {
        assert!(self.is_cooked(), "the terminal's settings have changed");
        let screen = self.screen();
        assert!(!screen.alternate_screen(), "still on the alternate screen");
        assert!(!screen.hide_cursor(), "the cursor is hidden");
        assert!(!screen.bracketed_paste(), "pastes are still bracketed");
        assert_eq!(screen.mouse_protocol_mode(), vt100::MouseProtocolMode::None);
        assert_eq!(self.modes_on(), Vec::<String>::new());
    }

    /// The private modes that were switched on and still are; the cursor, which is on initially, if it is off.
    pub(super) fn modes_on(&self) -> Vec<String> {
        let mut on = Vec::new();
        let sent = self.sent();
        for rest in sent.split("\x1b[?").skip(1) {
            let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
            let (mode, switched) = (rest[..end].to_owned(), rest[end..].starts_with('h'));
            on.retain(|other| *other != mode);
            if switched != (mode == "25") {
                on.push(mode);
            }
        }
        on
    }

    /// The number of frames that arrive within a time.
    pub(super) fn frames_in(&mut self, time: Duration) -> usize {
        let before = self.sent.len();
        self.bytes_in(time);
        String::from_utf8_lossy(&self.sent[before..]).matches("\x1b[?2026h").count()
    }

    /// The program's output as text.
    pub(super) fn sent(&self) -> String {
        String::from_utf8_lossy(&self.sent).into_owned()
    }

    /// Reads the program's output for at most `time`; returns `false` if there was none.
    fn listen(&mut self, time: Duration) -> bool {
        match self.output.recv_timeout(time) {
            Ok(bytes) => {
                self.screen.process(&bytes);
                self.sent.extend(bytes);
                true
            }
            Err(RecvTimeoutError::Timeout) => false,
            Err(RecvTimeoutError::Disconnected) => {
                // The function that waits for the end will notice it.
                thread::sleep(Duration::from_millis(1));
                false
            }
        }
    }

    pub(super) fn pid(&self) -> Pid {
        let id = self.child.process_id().expect("it has started");
        Pid::from_raw(id as i32).expect("not zero")
    }
}

fn pty_size(cols: u16, rows: u16) -> PtySize {
    PtySize { rows, cols, pixel_width: 0, pixel_height: 0 }
}

/// The terminal's settings, in a form that can be compared.
fn settings(master: &dyn MasterPty) -> String {
    format!("{:?}", master.get_termios().expect("a terminal has settings"))
}

/// Quits the laboratory with its key: it ends well and leaves the terminal as it was.
#[track_caller]
pub(super) fn quits(mut lab: Session) {
    lab.press("q");
    assert_eq!(lab.ends().0, 0);
    lab.assert_restored();
}
