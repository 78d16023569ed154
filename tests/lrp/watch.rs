//! Saves as editors make them, on a real disk. Waits are for what must come, with time to spare; that nothing came is
//! seen from what comes next.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver};
use std::time::{Duration, Instant};

use lrp::session::loader::Unreadable;
use lrp::session::watch::{Saved, Watch, Watched};

const AMPLE: Duration = Duration::from_secs(20);

struct Desk {
    folder: tempfile::TempDir,
    path: PathBuf,
}

impl Desk {
    fn new() -> Desk {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.lrp");
        fs::write(&path, "old").unwrap();
        Desk { folder, path }
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn rename_over(&self, path: &Path, text: &str) {
        let temporary = self.at("4913~");
        fs::write(&temporary, text).unwrap();
        fs::rename(&temporary, path).unwrap();
    }

    fn known(&self) -> Watched {
        Watched { path: self.path.clone(), text: Some("old".into()) }
    }
}

fn watch(files: impl IntoIterator<Item = Watched>) -> (Watch, Receiver<Saved>) {
    let (tell, told) = mpsc::channel();
    // The last ones may come when the test has seen enough.
    let watch = Watch::new(files, move |saved| drop(tell.send(saved))).unwrap();
    (watch, told)
}

fn text(path: &Path, text: &str) -> Saved {
    Saved::Text { path: path.into(), text: text.into() }
}

fn next(told: &Receiver<Saved>) -> Saved {
    told.recv_timeout(AMPLE).expect("a report")
}

fn measure(way: &str, save: impl Fn(&Desk, &str)) {
    let desk = Desk::new();
    let (_watch, told) = watch([desk.known()]);
    let mut took: Vec<Duration> = (0..20)
        .map(|n| {
            let new = format!("(var x := [{n}])");
            save(&desk, &new);
            let complete = Instant::now();
            assert_eq!(next(&told), text(&desk.path, &new));
            complete.elapsed()
        })
        .collect();
    took.sort();
    println!("{way}: median {:?}, worst {:?} after the save", took[took.len() / 2], took[took.len() - 1]);
    assert!(took[took.len() / 2] < Duration::from_millis(100), "{way}: {took:?}");
}

#[test]
fn a_save_by_rename_is_told_within_100_ms() {
    measure("rename", |desk, text| desk.rename_over(&desk.path, text));
}

#[test]
fn a_save_by_truncating_and_writing_is_told_within_100_ms() {
    measure("truncate and write", |desk, text| fs::write(&desk.path, text).unwrap());
}

#[test]
fn a_save_in_two_steps_is_told_within_100_ms() {
    measure("backup, create and write", |desk, text| {
        fs::rename(&desk.path, desk.at("a.lrp~")).unwrap();
        fs::write(&desk.path, text).unwrap();
    });
}

#[test]
fn a_file_that_grows_for_a_second_is_told_once_at_its_end() {
    let desk = Desk::new();
    let (_watch, told) = watch([desk.known()]);
    let mut file = File::create(&desk.path).unwrap();
    let mut whole = String::new();
    for n in 0..10 {
        let line = format!("; line {n}\n");
        file.write_all(line.as_bytes()).unwrap();
        whole += &line;
        assert!(told.recv_timeout(Duration::from_millis(100)).is_err(), "told before its end");
    }
    drop(file);
    assert_eq!(next(&told), text(&desk.path, &whole));
}

#[test]
fn the_same_text_again_is_not_told() {
    let desk = Desk::new();
    let (_watch, told) = watch([desk.known()]);
    fs::write(&desk.path, "old").unwrap();
    assert!(told.recv_timeout(Duration::from_millis(100)).is_err());
    desk.rename_over(&desk.path, "old");
    assert!(told.recv_timeout(Duration::from_millis(100)).is_err());
    desk.rename_over(&desk.path, "new");
    assert_eq!(next(&told), text(&desk.path, "new"));
}

#[test]
fn a_change_before_the_watch_began_is_told() {
    let desk = Desk::new();
    fs::write(&desk.path, "changed while loading").unwrap();
    let (_watch, told) = watch([desk.known()]);
    assert_eq!(next(&told), text(&desk.path, "changed while loading"));
}

#[test]
fn a_deleted_file_is_missed_after_a_second_and_welcomed_back() {
    let desk = Desk::new();
    let (_watch, told) = watch([desk.known()]);
    let gone = Instant::now();
    fs::remove_file(&desk.path).unwrap();
    assert_eq!(next(&told), Saved::Missing { path: desk.path.clone() });
    assert!(gone.elapsed() >= Duration::from_secs(1));
    fs::write(&desk.path, "old").unwrap();
    assert_eq!(next(&told), Saved::Back { path: desk.path.clone() });
    fs::write(&desk.path, "new").unwrap();
    assert_eq!(next(&told), text(&desk.path, "new"));
}

#[test]
fn an_empty_file_is_told_after_a_second() {
    let desk = Desk::new();
    let (_watch, told) = watch([desk.known()]);
    fs::write(&desk.path, "").unwrap();
    let why = Unreadable::Empty { path: desk.path.clone() };
    assert_eq!(next(&told), Saved::Unreadable { path: desk.path.clone(), why });
    fs::write(&desk.path, "new").unwrap();
    assert_eq!(next(&told), text(&desk.path, "new"));
}

#[test]
fn a_deleted_folder_may_come_back() {
    let desk = Desk::new();
    let folder = desk.at("inner");
    let path = folder.join("b.lrp");
    fs::create_dir(&folder).unwrap();
    fs::write(&path, "old").unwrap();
    let (_watch, told) = watch([Watched { path: path.clone(), text: Some("old".into()) }]);
    fs::remove_dir_all(&folder).unwrap();
    assert_eq!(next(&told), Saved::Missing { path: path.clone() });
    fs::create_dir(&folder).unwrap();
    fs::write(&path, "new").unwrap();
    assert_eq!(next(&told), text(&path, "new"));
}

#[test]
fn the_target_of_a_link_is_watched_wherever_it_lies() {
    let desk = Desk::new();
    fs::create_dir(desk.at("real")).unwrap();
    let target = desk.at("real/target.lrp");
    fs::write(&target, "old").unwrap();
    let link = desk.at("link.lrp");
    symlink("real/target.lrp", &link).unwrap();
    let (_watch, told) = watch([Watched { path: link.clone(), text: Some("old".into()) }]);
    fs::write(&target, "in place").unwrap();
    assert_eq!(next(&told), text(&link, "in place"));
    desk.rename_over(&target, "by rename");
    assert_eq!(next(&told), text(&link, "by rename"));
    fs::remove_file(&link).unwrap();
    symlink("a.lrp", &link).unwrap();
    assert_eq!(next(&told), text(&link, "old"), "it leads elsewhere now");
    fs::write(&desk.path, "elsewhere").unwrap();
    assert_eq!(next(&told), text(&link, "elsewhere"));
}

#[test]
fn a_link_to_a_folder_that_is_replaced_is_noticed() {
    let desk = Desk::new();
    for (name, text) in [("one", "old"), ("two", "new")] {
        fs::create_dir(desk.at(name)).unwrap();
        fs::write(desk.at(name).join("b.lrp"), text).unwrap();
    }
    symlink("one", desk.at("current")).unwrap();
    let path = desk.at("current/b.lrp");
    let (_watch, told) = watch([Watched { path: path.clone(), text: Some("old".into()) }]);
    symlink("two", desk.at("next")).unwrap();
    fs::rename(desk.at("next"), desk.at("current")).unwrap();
    assert_eq!(next(&told), text(&path, "new"));
}

#[test]
fn the_set_of_files_may_change() {
    let desk = Desk::new();
    let other = desk.at("other.lrp");
    let (watch, told) = watch([desk.known()]);
    watch.set_paths([desk.known(), Watched { path: other.clone(), text: None }]);
    fs::write(&other, "imported").unwrap();
    assert_eq!(next(&told), text(&other, "imported"));
    fs::write(&desk.path, "new").unwrap();
    assert_eq!(next(&told), text(&desk.path, "new"));
    watch.set_paths([Watched { path: other.clone(), text: Some("imported".into()) }]);
    fs::write(&desk.path, "no longer watched").unwrap();
    fs::write(&other, "still watched").unwrap();
    assert_eq!(next(&told), text(&other, "still watched"));
}

#[test]
fn another_text_than_the_one_known_is_told_whatever_was_told_before() {
    let desk = Desk::new();
    let (watch, told) = watch([desk.known()]);
    fs::write(&desk.path, "new").unwrap();
    assert_eq!(next(&told), text(&desk.path, "new"));
    for known in ["half", "another half"] {
        watch.set_paths([Watched { path: desk.path.clone(), text: Some(known.into()) }]);
        assert_eq!(next(&told), text(&desk.path, "new"));
    }
    watch.set_paths([Watched { path: desk.path.clone(), text: None }]);
    assert_eq!(next(&told), text(&desk.path, "new"));
    watch.set_paths([Watched { path: desk.path.clone(), text: Some("new".into()) }]);
    fs::write(&desk.path, "newer").unwrap();
    assert_eq!(next(&told), text(&desk.path, "newer"));
}

#[test]
fn of_many_saves_the_last_is_always_told() {
    let desk = Desk::new();
    let (_watch, told) = watch([desk.known()]);
    let before = open_files();
    for n in 0..1000 {
        let new = format!("(var x := [{n}])");
        match n % 2 {
            0 => desk.rename_over(&desk.path, &new),
            _ => fs::write(&desk.path, &new).unwrap(),
        }
    }
    let complete = Instant::now();
    let last = text(&desk.path, "(var x := [999])");
    let mut seen = BTreeSet::new();
    loop {
        let Saved::Text { path, text: whole } = next(&told) else { panic!("a text") };
        assert!(seen.insert(whole.clone()), "told twice: {whole}");
        if (Saved::Text { path, text: whole }) == last {
            break;
        }
    }
    println!("1,000 saves: {} told, the last after {:?}", seen.len(), complete.elapsed());
    assert!(open_files() <= before + 64, "files are left open");
}

#[test]
fn the_thread_ends_with_the_watch() {
    let desk = Desk::new();
    let (watch, told) = watch([desk.known()]);
    OpenOptions::new().append(true).open(&desk.path).unwrap().write_all(b"er").unwrap();
    assert_eq!(next(&told), text(&desk.path, "older"));
    drop(watch);
    assert!(told.recv().is_err(), "the callback is gone");
}

fn open_files() -> usize {
    fs::read_dir("/proc/self/fd").unwrap().count()
}
