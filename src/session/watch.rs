//! Watches the program's files and reports each save once, whole. Knows nothing of what is in them.

mod folders;
pub mod settling;
pub mod stamp;

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use folders::{Folders, Happened, trail};
use settling::{News, Settling};
use stamp::Stamp;

use super::loader::{self, Unreadable};

/// A file to watch, and its text as the caller has it: another one is news. Without a text, any is, and its absence isn't.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Watched {
    pub path: PathBuf,
    pub text: Option<Arc<str>>,
}

/// What became of a watched file; its path as it was given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Saved {
    /// Saved with another text than the last one known.
    Text { path: PathBuf, text: Arc<str> },
    /// Readable again after trouble, with the text known from before.
    Back { path: PathBuf },
    /// There is something, but no text to be had; an empty file for a second at least.
    Unreadable { path: PathBuf, why: Unreadable },
    /// Gone for a second at least.
    Missing { path: PathBuf },
}

/// Reports from a thread of its own, which ends when this is dropped.
pub struct Watch {
    notes: Sender<Note>,
    thread: Option<JoinHandle<()>>,
}

enum Note {
    Happened(Happened),
    Files(Vec<Watched>),
    Stop,
}

impl Watch {
    /// No change after this returns is missed. Fails only where no thread can be started.
    pub fn new(files: impl IntoIterator<Item = Watched>, on: impl Fn(Saved) + Send + 'static) -> io::Result<Watch> {
        let (notes, inbox) = mpsc::channel();
        let heard = notes.clone();
        let folders = Folders::new(move |happened| {
            // Once the watch has ended nobody listens.
            let _ = heard.send(Note::Happened(happened));
        });
        let began = Instant::now();
        let mut watching = Watching { began, inbox, folders, files: BTreeMap::new(), next_poll: POLL, on };
        watching.watch(files.into_iter().collect());
        let thread = thread::Builder::new().name("watch".into()).spawn(move || watching.run())?;
        Ok(Watch { notes, thread: Some(thread) })
    }

    /// Watches these files from now on. Another text than the one given is news, whatever was told before.
    pub fn set_paths(&self, files: impl IntoIterator<Item = Watched>) {
        // The thread listens for as long as this lives, unless its callback panicked.
        let _ = self.notes.send(Note::Files(files.into_iter().collect()));
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        let _ = self.notes.send(Note::Stop);
        if let Some(thread) = self.thread.take() {
            // A panic there has already been reported.
            let _ = thread.join();
        }
    }
}

/// How often to look without being told of a change: over NFS, nobody tells.
const POLL: Duration = Duration::from_millis(250);

struct Watching<F> {
    began: Instant,
    inbox: Receiver<Note>,
    folders: Folders,
    files: BTreeMap<PathBuf, Settling>,
    next_poll: Duration,
    on: F,
}

/// Whether to go on.
enum Then {
    Continue,
    End,
}

impl<F: Fn(Saved)> Watching<F> {
    fn run(&mut self) {
        while let Then::Continue = self.turn() {}
    }

    fn turn(&mut self) -> Then {
        let due = self.files.values().filter_map(Settling::due).min();
        let wake = due.map_or(self.next_poll, |due| due.min(self.next_poll));
        match self.inbox.recv_timeout(wake.saturating_sub(self.now())) {
            Ok(note) => {
                if let Then::End = self.take(note) {
                    return Then::End;
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Then::End,
        }
        if let Then::End = self.take_all() {
            return Then::End;
        }
        if self.now() >= self.next_poll {
            self.poll();
        }
        self.read_what_is_due()
    }

    fn now(&self) -> Duration {
        self.began.elapsed()
    }

    fn take_all(&mut self) -> Then {
        while let Ok(note) = self.inbox.try_recv() {
            if let Then::End = self.take(note) {
                return Then::End;
            }
        }
        Then::Continue
    }

    fn take(&mut self, note: Note) -> Then {
        match note {
            Note::Happened(happened) => self.stir(&happened),
            Note::Files(files) => self.watch(files),
            Note::Stop => return Then::End,
        }
        Then::Continue
    }

    fn stir(&mut self, happened: &Happened) {
        let now = self.now();
        for (path, file) in &mut self.files {
            // The name is enough: a namesake in another folder costs one look in vain.
            let concerned = happened
                .name
                .as_deref()
                .is_none_or(|name| trail(path).iter().any(|place| place.file_name() == Some(name)));
            if concerned {
                file.look(Stamp::of(path), now);
                file.stir(happened.how, now);
            }
        }
    }

    fn watch(&mut self, files: Vec<Watched>) {
        let now = self.now();
        let mut known = std::mem::take(&mut self.files);
        for Watched { path, text } in files {
            let file = match known.remove(&path) {
                Some(file) => file.knowing(text),
                None => Settling::new(text, now),
            };
            self.files.insert(path, file);
        }
        self.poll();
    }

    fn poll(&mut self) {
        let places: BTreeSet<PathBuf> = self.files.keys().flat_map(|path| trail(path)).collect();
        self.folders.follow(&places);
        let now = self.now();
        for (path, file) in &mut self.files {
            file.poll(Stamp::of(path), now);
        }
        self.next_poll = now + POLL;
    }

    fn read_what_is_due(&mut self) -> Then {
        let now = self.now();
        let due: Vec<PathBuf> =
            self.files.iter().filter(|(_, file)| file.is_due(now)).map(|(path, _)| path.clone()).collect();
        for path in due {
            if let Then::End = self.read(path) {
                return Then::End;
            }
        }
        Then::Continue
    }

    /// Reports what is in a file, unless it stirred before or while it was read.
    fn read(&mut self, path: PathBuf) -> Then {
        self.look(&path);
        if !self.is_due(&path) {
            return Then::Continue;
        }
        let found = loader::read_file(&path).map(|source| source.text);
        self.look(&path);
        if let Then::End = self.take_all() {
            return Then::End;
        }
        let now = self.now();
        if let Some(file) = self.files.get_mut(&path).filter(|file| file.is_due(now))
            && let Some(news) = file.found(found, now)
        {
            (self.on)(saved(path, news));
        }
        Then::Continue
    }

    fn look(&mut self, path: &PathBuf) {
        let now = self.now();
        if let Some(file) = self.files.get_mut(path) {
            file.look(Stamp::of(path), now);
        }
    }

    fn is_due(&self, path: &PathBuf) -> bool {
        self.files.get(path).is_some_and(|file| file.is_due(self.now()))
    }
}

fn saved(path: PathBuf, news: News) -> Saved {
    match news {
        News::Text(text) => Saved::Text { path, text },
        News::Back => Saved::Back { path },
        News::Missing => Saved::Missing { path },
        News::Unreadable(why) => Saved::Unreadable { path, why },
    }
}
