//! `lrp FILE`: the screen on a running program. One loop takes what comes from keys, the engine and the system, lets the
//! app answer, and draws when something changed.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use crossterm::event::{Event as TerminalEvent, KeyCode, KeyModifiers};
use ratatui::layout::Size;

use super::app::{App, Effect, Event, Options, WriteBack};
use super::cadence::Cadence;
use super::clipboard::{self, Between};
use super::editor::{self, Launch, Manner};
use super::input::{Hold, Input, Received};
use super::pointer::Hand;
use super::settings::Settings;
use super::terminal::Screen;
use super::tour::{Tour, folder};
use super::view::Choices;
use crate::runtime::record::Finding;
use crate::runtime::{Command, Explain, Record};
use crate::session::engine_thread::{End, News};
use crate::session::headless::STUCK;
use crate::session::live::{Session, Setup};
use crate::session::signals::{Signal, Signals};
use crate::session::trace::Trace;
use crate::session::write_back::NotWritten;

enum Happened {
    Terminal(Received),
    News(News),
    Signal(Signal),
    EditorEnded(Result<(), String>),
    Written(Vec<(WriteBack, Result<(), NotWritten>)>),
}

/// A tour, and the folder that keeps how far it was taken.
pub struct Guide {
    pub tour: Tour,
    pub folder: PathBuf,
}

/// Exit code 0: quit, terminated or hung up; 1: it couldn't begin or failed; 130: interrupted.
/// `settings`: with what was found wrong with them.
pub fn run(setup: Setup, settings: (Settings, Vec<Finding>), trace: Option<PathBuf>, guide: Option<Guide>) -> ExitCode {
    match live(setup, settings, trace, guide) {
        Ok(code) => code,
        Err(why) => {
            let _ = writeln!(io::stderr(), "lrp: {why}");
            ExitCode::FAILURE
        }
    }
}

fn live(
    setup: Setup,
    settings: (Settings, Vec<Finding>),
    trace: Option<PathBuf>,
    guide: Option<Guide>,
) -> Result<ExitCode, String> {
    let (settings, findings) = settings;
    let mouse = settings.mouse;
    Screen::check().map_err(|error| error.to_string())?;
    if trace.as_deref() == Some(Path::new("-")) {
        return Err(
            "the screen needs standard output for itself: name a file for --trace, or use `lrp run`".to_string()
        );
    }
    let trace = trace.as_deref().map(|path| Trace::create(path, setup.conditions())).transpose();
    let trace = trace.map_err(|error| format!("the trace can't be written: {error}"))?;
    let app = |size| {
        let file = setup.file.display().to_string().into();
        App::new(Options {
            file,
            rate: setup.pacing.rate.hz(),
            choices: Choices {
                on_edit: setup.options.on_edit,
                saves: setup.options.saves,
                on_error: setup.options.on_error,
            },
            settings,
            size,
        })
    };
    let (happened, inbox) = channel();
    let signals = send(&happened, Happened::Signal);
    let _signals = Signals::watch(signals).map_err(|error| error.to_string())?;
    let size = crossterm::terminal::size().map(|(width, height)| Size { width, height }).unwrap_or_default();
    let (tour, tour_folder) = guide.map(|guide| (guide.tour, guide.folder)).unzip();
    let mut app = match tour {
        Some(tour) => app(size).guided(tour),
        None => app(size),
    };
    app.found_in_config(&findings);
    let session = Session::start(setup, send(&happened, Happened::News)).map_err(|why| why.to_string())?;
    let stop = session.commands().clone();
    let screen = Screen::enter(mouse, move || stop.halt()).map_err(|error| error.to_string())?;
    let input = Input::read(send(&happened, Happened::Terminal)).map_err(|error| error.to_string())?;
    let mut live = Live {
        app,
        screen,
        session,
        input,
        hand: Hand::default(),
        trace,
        happened,
        writing: Vec::new(),
        held: None,
        warned: false,
        failed: None,
        explain: Explain::Off,
    };
    let code = live.run(&inbox);
    let Live { mut app, screen, session, failed, mut trace, writing, .. } = live;
    drop(session);
    drop(screen);
    // A panic there has been reported.
    writing.into_iter().for_each(|writing| drop(writing.join()));
    // The robot's stop, and what came before it.
    for happened in inbox.try_iter() {
        match (happened, &mut trace) {
            (Happened::News(News::Records(records)), Some(trace)) => {
                records.iter().for_each(|record| trace.record(record));
            }
            (Happened::Written(all), _) => app.written(all),
            _ => (),
        }
    }
    for line in app.farewell() {
        // Whoever hung up doesn't read it.
        let _ = writeln!(io::stderr(), "{line}");
    }
    if let Some((tour, kept)) = app.tour().zip(tour_folder)
        && let Err(error) = folder::keep(&kept, tour)
    {
        let _ = writeln!(io::stderr(), "lrp: how far you came can't be kept in {}: {error}", kept.display());
    }
    match failed {
        Some(why) => Err(why),
        None => Ok(code),
    }
}

/// Hands things of one kind on to the loop; when that has ended there is nobody to tell.
pub fn send<T: 'static, H: Send + 'static>(
    happened: &Sender<H>,
    kind: impl Fn(T) -> H + Clone + Send + 'static,
) -> impl Fn(T) + Clone + Send + 'static {
    let happened = happened.clone();
    move |thing| drop(happened.send(kind(thing)))
}

struct Live {
    app: App,
    screen: Screen,
    session: Session,
    input: Input,
    hand: Hand,
    trace: Option<Trace>,
    happened: Sender<Happened>,
    /// Files that are being written.
    writing: Vec<JoinHandle<()>>,
    /// While an editor has the terminal.
    held: Option<Hold>,
    /// Said that an editor will cover the runstop.
    warned: bool,
    /// What went wrong in lrp itself.
    failed: Option<String>,
    /// What the engine was asked for last.
    explain: Explain,
}

/// What becomes of the loop.
enum Next {
    Go,
    Answer,
    End(ExitCode),
}

impl Live {
    fn run(&mut self, inbox: &Receiver<Happened>) -> ExitCode {
        let started = Instant::now();
        let mut cadence = Cadence::default();
        loop {
            self.send_explain();
            if self.app.dirty() && cadence.wait(started.elapsed()).is_zero() {
                if let Err(gone) = self.draw() {
                    return self.terminal_gone(&gone);
                }
                cadence.drawn(started.elapsed());
            }
            let wait = if self.app.dirty() { cadence.wait(started.elapsed()) } else { Duration::MAX };
            let mut next = match inbox.recv_timeout(wait) {
                Ok(happened) => Some(happened),
                Err(RecvTimeoutError::Timeout) => None,
                Err(RecvTimeoutError::Disconnected) => return ExitCode::FAILURE,
            };
            while let Some(happened) = next {
                match self.take(happened) {
                    Next::Go => {}
                    Next::Answer => cadence.ask(),
                    Next::End(code) => return code,
                }
                next = inbox.try_recv().ok();
            }
        }
    }

    /// Guards are told only while somebody sees them.
    fn send_explain(&mut self) {
        let mode = self.app.explain();
        if std::mem::replace(&mut self.explain, mode) != mode {
            self.session.commands().send(Command::Explain { mode });
        }
    }

    fn draw(&mut self) -> io::Result<()> {
        let app = &self.app;
        self.screen.draw(|frame| app.draw(frame))?;
        self.app.drawn();
        Ok(())
    }

    /// Nobody is there to see or to say anything: the robot is stopped by the end of the session.
    fn terminal_gone(&mut self, _: &io::Error) -> ExitCode {
        ExitCode::SUCCESS
    }

    fn take(&mut self, happened: Happened) -> Next {
        match happened {
            Happened::Terminal(Received::Event(event)) => self.terminal(event),
            Happened::Terminal(Received::Gone) | Happened::Signal(Signal::HangUp | Signal::Terminate) => {
                Next::End(ExitCode::SUCCESS)
            }
            Happened::Signal(Signal::Interrupt) => Next::End(ExitCode::from(130)),
            Happened::Signal(Signal::Suspend) => self.effect(Effect::Suspend),
            // It may have been stopped unheard, and a shell had the terminal. What an editor covers is drawn when it ends.
            Happened::Signal(Signal::Continue) if self.held.is_none() => self.effect(Effect::Redraw),
            Happened::Signal(Signal::Continue) => Next::Go,
            Happened::News(News::Records(records)) => {
                records.iter().for_each(|record| self.record(record));
                self.flush();
                Next::Go
            }
            Happened::News(News::Stuck) => {
                self.app.stopped();
                self.app.notice(STUCK);
                Next::Answer
            }
            Happened::News(News::Ended(End::Failed(why))) => {
                self.failed = Some(format!("something in lrp itself went wrong, and it stopped the robot: {why}"));
                Next::End(ExitCode::FAILURE)
            }
            Happened::News(News::Ended(End::TimeIsUp | End::Asked)) => Next::End(ExitCode::SUCCESS),
            Happened::EditorEnded(result) => self.editor_ended(result),
            Happened::Written(all) => {
                self.app.written(all);
                Next::Answer
            }
        }
    }

    fn record(&mut self, record: &Record) {
        self.app.record(record);
        if let Some(trace) = &mut self.trace {
            trace.record(record);
        }
    }

    fn flush(&mut self) {
        if let Some(trace) = &mut self.trace {
            trace.flush();
            if let Some(why) = trace.trouble() {
                self.app.notice(why);
            }
        }
    }

    fn terminal(&mut self, event: TerminalEvent) -> Next {
        let event = match event {
            TerminalEvent::Key(key) => Event::Key(key),
            TerminalEvent::Resize(width, height) => Event::Resize(Size { width, height }),
            TerminalEvent::Mouse(mouse) => match self.hand.read(mouse, Instant::now()) {
                Some(pointer) => Event::Pointer(pointer),
                None => return Next::Go,
            },
            _ => return Next::Go,
        };
        let interrupts = matches!(event, Event::Key(key) if key.code == KeyCode::Char('c') && key.modifiers == KeyModifiers::CONTROL);
        for effect in self.app.event(event) {
            match self.effect(effect) {
                Next::End(_) if interrupts => return Next::End(ExitCode::from(130)),
                Next::End(code) => return Next::End(code),
                Next::Go | Next::Answer => {}
            }
        }
        Next::Answer
    }

    fn effect(&mut self, effect: Effect) -> Next {
        match effect {
            Effect::Command(command) => {
                if command == Command::Runstop {
                    self.app.stopped();
                }
                self.session.commands().send(command);
            }
            Effect::OpenEditor { file, line, column } => self.open_editor(&file, line, column),
            Effect::WriteBack(all) => self.write_back(all),
            Effect::Copy(text) => self.copy(&text),
            Effect::Quit => return Next::End(ExitCode::SUCCESS),
            Effect::Suspend => {
                self.app.stopped();
                let commands = self.session.commands();
                commands.send(Command::Runstop);
                if let Err(error) = commands.at_rest(|| self.screen.suspend()) {
                    self.app.notice(format!("can't be suspended: {error}"));
                }
            }
            Effect::Mouse(mouse) => {
                if let Err(error) = self.screen.set_mouse(mouse) {
                    return Next::End(self.terminal_gone(&error));
                }
            }
            Effect::Redraw => {
                if let Err(error) = self.screen.resume() {
                    return Next::End(self.terminal_gone(&error));
                }
            }
        }
        Next::Answer
    }

    fn copy(&mut self, text: &str) {
        match clipboard::sequence(text, Between::here()) {
            // A terminal that is gone is found out when the next frame is drawn.
            Some(sequence) => drop(self.screen.send(&sequence)),
            None => self.app.notice("that is too long for the clipboard"),
        }
    }

    /// Beside this thread: a disk may take its time, and the stop key must not wait for it.
    fn write_back(&mut self, all: Vec<WriteBack>) {
        let written = send(&self.happened, Happened::Written);
        let write = move || {
            let write = |it: WriteBack| {
                let result = it.rewrite.write();
                (it, result)
            };
            written(all.into_iter().map(write).collect());
        };
        self.writing.retain(|writing| !writing.is_finished());
        match Builder::new().name("write".into()).spawn(write) {
            Ok(writing) => self.writing.push(writing),
            Err(error) => self.app.notice(format!("not written: the system is short of something: {error}")),
        }
    }

    fn open_editor(&mut self, file: &Arc<str>, line: usize, column: usize) {
        let size = self.app.options().size;
        let launch = match Launch::new(Path::new(&**file), line, column, &editor::Surroundings::here(size)) {
            Ok(launch) => launch,
            Err(why) => return self.app.notice(why.to_string()),
        };
        if launch.manner == Manner::Covering {
            if !std::mem::replace(&mut self.warned, true) {
                let warning = "the editor will cover this screen and its stop key while the robot goes on; again to open it (tmux splits instead)";
                return self.app.notice(warning);
            }
            self.held = Some(self.input.hold());
            self.screen.leave();
        }
        let ended = send(&self.happened, Happened::EditorEnded);
        if let Err(error) = launch.start(ended) {
            self.editor_ended(Err(format!("the editor can't be opened: {error}")));
        }
    }

    fn editor_ended(&mut self, result: Result<(), String>) -> Next {
        if self.held.take().is_some()
            && let Err(error) = self.screen.resume()
        {
            return Next::End(self.terminal_gone(&error));
        }
        if let Err(why) = result {
            self.app.notice(why);
        }
        Next::Answer
    }
}
