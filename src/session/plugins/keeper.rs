//! Keeps a bridge alive on a thread of its own: starts its process, says why it was lost, and starts it anew after a while;
//! also when the plugin's file was built anew.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use lrp_bridge::{Event, Form, Level};

use super::Plugins;
use super::folders::{Folders, Plugin};
use super::incoming::Said;
use super::life::Life;
use super::line::Line;
use super::process::{Heard, Process};
use crate::runtime::record::Health;
use crate::session::watch::stamp::Stamp;

/// Between a loss and the next start: doubled each time, up to the second.
const BACK_OFF: [Duration; 2] = [Duration::from_millis(500), Duration::from_secs(10)];
/// A process that lived this long is no part of a series of losses.
const STEADY: Duration = Duration::from_secs(30);
pub(super) const LOOK_EVERY: Duration = Duration::from_millis(500);
const NOTES: usize = 256;

/// Ends when dropped: the bridge stops its robot and goes.
pub struct Keeper {
    line: Arc<Line>,
    notes: SyncSender<Note>,
    thread: Option<JoinHandle<()>>,
}

pub(super) enum Note {
    /// From the process with this number.
    Heard(u64, Heard),
    Form(Form),
    End,
}

impl Keeper {
    /// Fails only where no thread can be started.
    pub fn start(plugins: Plugins, kind: String, form: Form) -> std::io::Result<Keeper> {
        let (notes, inbox) = sync_channel(NOTES);
        let line = Arc::<Line>::default();
        let mut work = Work {
            line: Arc::clone(&line),
            plugins,
            kind,
            form,
            notes: notes.clone(),
            processes: 0,
            losses: 0,
            // What a bridge is from the moment it is made.
            heard_of: Some((Health::Connecting, None)),
        };
        let thread = Builder::new().name("bridge".into()).stack_size(256 << 10).spawn(move || work.run(&inbox))?;
        Ok(Keeper { line, notes, thread: Some(thread) })
    }

    pub fn line(&self) -> &Arc<Line> {
        &self.line
    }

    /// The form was edited.
    pub fn configure(&self, form: Form) {
        // A keeper that has ended has nothing to configure.
        let _ = self.notes.send(Note::Form(form));
    }

    /// Lets the bridge go without waiting for it; gives what to wait on before this process ends.
    pub fn end(mut self) -> Option<JoinHandle<()>> {
        self.thread.take().inspect(|_| drop(self.notes.send(Note::End)))
    }
}

impl Drop for Keeper {
    fn drop(&mut self) {
        if let Some(thread) = self.thread.take() {
            let _ = self.notes.send(Note::End);
            let _ = thread.join();
        }
    }
}

pub(super) struct Work {
    pub line: Arc<Line>,
    plugins: Plugins,
    kind: String,
    pub form: Form,
    pub notes: SyncSender<Note>,
    /// Started so far.
    pub processes: u64,
    /// In a row.
    losses: u32,
    /// The last state told, so that the same isn't told again.
    heard_of: Option<(Health, Option<String>)>,
}

/// Why a process is no longer there.
pub(super) enum Loss {
    /// Nobody needs it any more.
    Ended,
    /// The plugin's file is another one now.
    Rebuilt,
    /// It closed its output; how it ended is still to be learnt.
    Closed,
    Failed(String),
    /// Starting it again makes no difference before its file changes.
    Refused(String),
}

impl Work {
    fn run(&mut self, inbox: &Receiver<Note>) {
        loop {
            let (loss, stamp) = match self.plugins.folders.find(&self.kind) {
                Some(plugin) => {
                    let stamp = Stamp::of(&plugin.path);
                    (self.life(inbox, &plugin, stamp), Some((plugin.path, stamp)))
                }
                None => (Loss::Refused(missing(&self.kind, &self.plugins.folders)), None),
            };
            self.line.connect(None);
            let wait = match loss {
                Loss::Ended => return,
                Loss::Rebuilt => continue,
                Loss::Closed => Some(self.failed("it has closed its output")),
                Loss::Failed(why) => Some(self.failed(&why)),
                Loss::Refused(why) => {
                    self.tell(Health::Lost, Some(why));
                    None
                }
            };
            if self.wait(inbox, wait, stamp) == Wait::Ended {
                return;
            }
        }
    }

    /// How long to wait before it is started again.
    fn failed(&mut self, why: &str) -> Duration {
        let wait = (BACK_OFF[0] * 2u32.pow(self.losses.min(8))).min(BACK_OFF[1]);
        self.losses += 1;
        self.tell(Health::Lost, Some(format!("{why}; started again in {} s", wait.as_secs_f64())));
        wait
    }

    /// Until it is time to start again, or the plugin's file is another one.
    fn wait(
        &mut self,
        inbox: &Receiver<Note>,
        wait: Option<Duration>,
        known: Option<(PathBuf, Option<Stamp>)>,
    ) -> Wait {
        let until = wait.map(|wait| Instant::now() + wait);
        loop {
            let left =
                until.map_or(LOOK_EVERY, |until| until.saturating_duration_since(Instant::now()).min(LOOK_EVERY));
            match inbox.recv_timeout(left) {
                Ok(Note::End) | Err(RecvTimeoutError::Disconnected) => return Wait::Ended,
                Ok(Note::Form(form)) => self.form = form,
                Ok(Note::Heard(..)) => continue,
                Err(RecvTimeoutError::Timeout) => {}
            }
            let file = self.plugins.folders.find(&self.kind).map(|plugin| (Stamp::of(&plugin.path), plugin.path));
            let changed = file.map(|(stamp, path)| (path, stamp)) != known;
            if changed || until.is_some_and(|until| until <= Instant::now()) {
                return Wait::Over;
            }
        }
    }

    /// From the start of a process to its end.
    fn life(&mut self, inbox: &Receiver<Note>, plugin: &Plugin, stamp: Option<Stamp>) -> Loss {
        self.processes += 1;
        let (number, notes) = (self.processes, self.notes.clone());
        // When the keeper is gone, so is whoever would hear it.
        let heard = move |heard| drop(notes.send(Note::Heard(number, heard)));
        let line = Arc::clone(&self.line);
        let sorted = move |what: Heard| match what {
            Heard::Event(Event::Input { name, value, .. }, length) => line.incoming.input(name, value, length),
            Heard::Event(Event::Time { ms }, _) => line.incoming.time(ms),
            other => heard(other),
        };
        let process = match Process::start(plugin, &self.plugins.host, sorted) {
            Ok(process) => process,
            Err(error) => return Loss::Failed(format!("{} can't be started: {error}", plugin.path.display())),
        };
        let mut life = Life::new(process, plugin, stamp);
        let loss = life.last(self, inbox);
        if life.since.elapsed() >= STEADY {
            self.losses = 0;
        }
        life.end(loss, self, inbox)
    }

    pub fn tell(&mut self, state: Health, message: Option<String>) {
        let now = Some((state, message));
        if self.heard_of != now
            && let Some((state, message)) = now.clone()
        {
            self.line.incoming.say(Said::State { state, message });
            self.heard_of = now;
        }
    }

    pub fn log(&self, level: Level, message: String) {
        self.line.incoming.say(Said::Log { level, message, from: None });
    }
}

#[derive(PartialEq, Eq)]
enum Wait {
    Over,
    Ended,
}

/// `there is no bridge of kind `ev4``, and where one was looked for.
fn missing(kind: &str, folders: &Folders) -> String {
    let looked = folders.paths().iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ");
    format!("there is no bridge of kind `{kind}` in {looked}")
}
