//! A terminal without a person: a program runs in it, and what it shows can be waited for.

use std::io::{Read, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver};
use std::sync::{Arc, Condvar, Mutex};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use portable_pty::{Child, CommandBuilder, ExitStatus, MasterPty, PtySize, SlavePty, native_pty_system};

const AMPLE: Duration = Duration::from_secs(20);

pub struct Pty {
    master: Box<dyn MasterPty + Send>,
    slave: Box<dyn SlavePty + Send>,
    keyboard: Box<dyn Write + Send>,
    shown: Arc<Shown>,
    reader: JoinHandle<()>,
    unplugged: Arc<AtomicBool>,
}

struct Shown {
    screen: Mutex<vt100::Parser>,
    changed: Condvar,
}

pub struct Running {
    pub id: i32,
    ended: Receiver<ExitStatus>,
}

impl Pty {
    pub fn new() -> Pty {
        let pair = native_pty_system().openpty(PtySize::default()).unwrap();
        let shown = Arc::new(Shown { screen: Mutex::new(vt100::Parser::new(24, 80, 0)), changed: Condvar::new() });
        let unplugged = Arc::new(AtomicBool::new(false));
        let mut output = pair.master.try_clone_reader().unwrap();
        let keyboard = pair.master.take_writer().unwrap();
        let (screen, plug) = (shown.clone(), unplugged.clone());
        let reader = thread::spawn(move || {
            let mut bytes = [0; 4096];
            while let Ok(count @ 1..) = output.read(&mut bytes) {
                screen.screen.lock().unwrap().process(&bytes[..count]);
                screen.changed.notify_all();
                if plug.load(Ordering::Acquire) {
                    break;
                }
            }
        });
        Pty { master: pair.master, slave: pair.slave, keyboard, shown, reader, unplugged }
    }

    pub fn run(&self, command: CommandBuilder) -> Running {
        let mut child: Box<dyn Child + Send + Sync> = self.slave.spawn_command(command).unwrap();
        let id = child.process_id().unwrap() as i32;
        let (tell, ended) = mpsc::channel();
        thread::spawn(move || drop(tell.send(child.wait().unwrap())));
        Running { id, ended }
    }

    pub fn type_in(&mut self, keys: &str) {
        self.keyboard.write_all(keys.as_bytes()).unwrap();
    }

    /// Shows what another program wrote, a shell for instance.
    pub fn scribble(&self, text: &str) {
        self.shown.screen.lock().unwrap().process(text.as_bytes());
    }

    pub fn resize(&self, cols: u16, rows: u16) {
        // A terminal of another size lays out anew: what is seen from here on is drawn for this one.
        self.shown.screen.lock().unwrap().screen_mut().set_size(rows, cols);
        self.master.resize(PtySize { rows, cols, ..PtySize::default() }).unwrap();
    }

    /// Waits until the screen is as wanted.
    pub fn wait_for(&self, what: &str, wanted: impl Fn(&vt100::Screen) -> bool) {
        let screen = self.shown.screen.lock().unwrap();
        let (screen, waited) =
            self.shown.changed.wait_timeout_while(screen, AMPLE, |screen| !wanted(screen.screen())).unwrap();
        assert!(!waited.timed_out(), "waiting for {what}, seeing:\n{}", screen.screen().contents());
    }

    /// The modes of the line, comparable.
    pub fn modes(&self) -> impl PartialEq + std::fmt::Debug + use<> {
        self.master.get_termios().unwrap()
    }

    pub fn is_raw(&self) -> bool {
        !format!("{:?}", self.master.get_termios().unwrap().local_flags).contains("ICANON")
    }

    /// Takes the terminal away. The keys make the program write once more.
    pub fn unplug(mut self, keys: &str) {
        self.unplugged.store(true, Ordering::Release);
        self.type_in(keys);
        self.reader.join().unwrap();
    }
}

impl Running {
    pub fn wait(&self) -> ExitStatus {
        self.ended.recv_timeout(AMPLE).expect("the program ends")
    }
}
