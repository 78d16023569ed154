//! When a file that is being saved may be read, and what of it is news. Knows neither clock nor disk: times are since
//! any fixed moment.

use std::sync::Arc;
use std::time::Duration;

use super::stamp::Stamp;
use crate::session::loader::Unreadable;

/// How long a file must be still before it is read.
pub const SETTLE: Duration = Duration::from_millis(20);

/// How long saves may follow on each other before the next whole one is read without waiting for stillness.
pub const BUSY: Duration = Duration::from_millis(60);

/// How long a save may stay unfinished: the file gone, empty, or open in its writer's hands without another byte.
pub const PATIENCE: Duration = Duration::from_secs(1);

/// How long two different texts may look alike from outside, on file systems that count time in whole seconds.
pub const COARSE: Duration = Duration::from_secs(3);

/// What is known to have happened to a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stir {
    /// Bytes were written, and the writer will say when it is done.
    Written,
    /// Its writer closed it, or it was moved here.
    Whole,
    /// Something else, or one can't tell.
    Touched,
}

/// What changed since the last news.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum News {
    Text(Arc<str>),
    /// After trouble, the text from before it.
    Back,
    Missing,
    Unreadable(Unreadable),
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Trouble {
    Missing,
    Unreadable(Unreadable),
}

/// One file, and what has been told of it.
#[derive(Debug)]
pub struct Settling {
    stamp: Option<Stamp>,
    stirred: Duration,
    last: Stir,
    unread: bool,
    /// When a whole save first waited to be read.
    waiting: Option<Duration>,
    /// Since when it was found missing or empty.
    vanished: Option<Duration>,
    text: Option<Arc<str>>,
    trouble: Option<Trouble>,
}

impl Settling {
    /// A file whose text, or absence, is no news.
    pub fn new(text: Option<Arc<str>>, now: Duration) -> Settling {
        let trouble = text.is_none().then_some(Trouble::Missing);
        let last = Stir::Touched;
        Settling { stamp: None, stirred: now, last, unread: true, waiting: None, vanished: None, text, trouble }
    }

    /// The same file, whose text is no news now, nor its absence where there is none.
    pub fn knowing(mut self, text: Option<Arc<str>>) -> Settling {
        if self.text != text {
            if self.text.is_none() || text.is_none() {
                self.trouble = text.is_none().then_some(Trouble::Missing);
            }
            self.text = text;
            self.unread = true;
        }
        self
    }

    pub fn stir(&mut self, how: Stir, now: Duration) {
        self.stirred = now;
        self.unread = true;
        if how == Stir::Whole {
            self.waiting.get_or_insert(now);
        }
        if how != Stir::Touched || self.last == Stir::Whole {
            self.last = how;
        }
    }

    /// How the file looks now; None where there is none.
    pub fn look(&mut self, stamp: Option<Stamp>, now: Duration) {
        if stamp != self.stamp {
            self.stamp = stamp;
            self.stir(Stir::Touched, now);
        }
    }

    /// A look from time to time, for changes nobody reports.
    pub fn poll(&mut self, stamp: Option<Stamp>, now: Duration) {
        self.look(stamp, now);
        self.unread |= now < self.stirred + COARSE;
    }

    /// When to read the file; None while there is no reason to.
    pub fn due(&self) -> Option<Duration> {
        let busy = self.waiting.is_some_and(|since| self.stirred >= since + BUSY);
        let rest = match self.last {
            Stir::Written => PATIENCE,
            Stir::Whole if busy => Duration::ZERO,
            Stir::Whole | Stir::Touched => SETTLE,
        };
        let settled = self.unread.then_some(self.stirred + rest);
        settled.or(self.vanished.map(|since| since + PATIENCE))
    }

    pub fn is_due(&self, now: Duration) -> bool {
        self.due().is_some_and(|due| due <= now)
    }

    /// What reading it gave. To be called when it is due, also after the reading.
    pub fn found(&mut self, found: Result<Arc<str>, Unreadable>, now: Duration) -> Option<News> {
        self.unread = false;
        self.waiting = None;
        self.last = Stir::Touched;
        match found {
            Ok(text) => self.readable(text),
            Err(why) => self.unreadable(why, now),
        }
    }

    fn readable(&mut self, text: Arc<str>) -> Option<News> {
        self.vanished = None;
        let trouble = self.trouble.take();
        if self.text.as_ref() == Some(&text) {
            return trouble.map(|_| News::Back);
        }
        self.text = Some(text.clone());
        Some(News::Text(text))
    }

    fn unreadable(&mut self, why: Unreadable, now: Duration) -> Option<News> {
        let may_pass =
            matches!(why, Unreadable::Missing { .. } | Unreadable::NoFolder { .. } | Unreadable::Empty { .. });
        if may_pass && now < *self.vanished.get_or_insert(now) + PATIENCE {
            return None;
        }
        self.vanished = None;
        let trouble = match why {
            Unreadable::Missing { .. } | Unreadable::NoFolder { .. } => Trouble::Missing,
            why => Trouble::Unreadable(why),
        };
        if self.trouble.as_ref() == Some(&trouble) {
            return None;
        }
        self.trouble = Some(trouble.clone());
        Some(match trouble {
            Trouble::Missing => News::Missing,
            Trouble::Unreadable(why) => News::Unreadable(why),
        })
    }
}
