//! A little program with a screen: the test binary plays it when started by a test. Each key does one thing.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Sender};
use std::thread;

use crossterm::event::{Event, KeyCode};
use lrp::session::signals::{Signal, Signals};
use lrp::ui::editor::{Launch, Manner};
use lrp::ui::input::{Hold, Input, Received};
use lrp::ui::pointer::Mouse;
use lrp::ui::terminal::Screen;

/// Names the file to which the program writes what can't be seen on its screen.
pub const JOURNAL: &str = "LRP_TEST_JOURNAL";

enum Happened {
    Received(Received),
    Signal(Signal),
    Edited(Result<(), String>),
}

struct Program {
    screen: Screen,
    input: Input,
    held: Option<Hold>,
    tell: Sender<Happened>,
    journal: PathBuf,
    line: String,
    lost: Vec<&'static str>,
}

pub fn play(journal: &Path) {
    let stop = journal.to_owned();
    let screen = match Screen::enter(Mouse::Ours, move || note(&stop, "robot stopped")) {
        Ok(screen) => screen,
        Err(error) => return note(journal, &error.to_string()),
    };
    let (tell, told) = mpsc::channel();
    let (signals, keys) = (tell.clone(), tell.clone());
    let _signals = Signals::watch(move |signal| drop(signals.send(Happened::Signal(signal)))).unwrap();
    let input = Input::read(move |received| drop(keys.send(Happened::Received(received)))).unwrap();
    let journal = journal.to_owned();
    let mut program = Program { screen, input, held: None, tell, journal, line: "ready".into(), lost: Vec::new() };
    while program.draw() {
        if !program.take(told.recv().unwrap()) {
            break;
        }
    }
}

fn note(journal: &Path, what: &str) {
    let mut file = OpenOptions::new().create(true).append(true).open(journal).unwrap();
    writeln!(file, "{what}").unwrap();
}

impl Program {
    fn draw(&mut self) -> bool {
        let line = format!("<{}>", self.line);
        let drawn = self.screen.draw(|frame| frame.render_widget(line, frame.area()));
        if drawn.is_err() && self.lost.len() == 2 {
            note(&self.journal, "no output");
            return false;
        }
        true
    }

    fn take(&mut self, happened: Happened) -> bool {
        match happened {
            Happened::Received(Received::Event(Event::Key(key))) => return self.press(key.code),
            Happened::Received(Received::Event(Event::Resize(width, height))) => {
                self.line = format!("{width}x{height}")
            }
            Happened::Received(Received::Event(_)) => {}
            Happened::Received(Received::Gone) => self.lose("gone"),
            Happened::Signal(Signal::HangUp) => self.lose("hung up"),
            Happened::Signal(Signal::Suspend) => self.suspend(),
            // A terminal that hangs up continues its programs too, for they might be stopped.
            Happened::Signal(Signal::Continue) => drop(self.screen.resume()),
            Happened::Signal(signal) => {
                note(&self.journal, &format!("{signal:?}"));
                return false;
            }
            Happened::Edited(result) => {
                self.screen.resume().unwrap();
                self.held = None;
                self.line = format!("edited: {result:?}");
            }
        }
        true
    }

    fn lose(&mut self, what: &'static str) {
        note(&self.journal, what);
        self.lost.push(what);
        self.line = what.into();
    }

    fn press(&mut self, key: KeyCode) -> bool {
        match key {
            KeyCode::Char('q') => return false,
            KeyCode::Char('p') => panic!("on purpose"),
            KeyCode::Char('t') => {
                let broken = thread::Builder::new().name("aside".into()).spawn(|| panic!("elsewhere")).unwrap();
                self.line = format!("it panicked: {}", broken.join().is_err());
            }
            KeyCode::Char('z') => self.suspend(),
            KeyCode::Char('e') => self.edit(),
            key => self.line = format!("{key:?}"),
        }
        true
    }

    fn suspend(&mut self) {
        self.screen.suspend().unwrap();
        self.line = "continued".into();
    }

    fn edit(&mut self) {
        self.held = Some(self.input.hold());
        self.screen.leave();
        let script = "read a; echo \"read $a\"; kill -TSTP $$; read b; echo \"read $b\"";
        let command = ["/bin/sh", "-c", script].map(Into::into).into();
        let tell = self.tell.clone();
        Launch { manner: Manner::Covering, command }
            .start(move |result| drop(tell.send(Happened::Edited(result))))
            .unwrap();
    }
}
