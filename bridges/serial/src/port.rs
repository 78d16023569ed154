//! Which ports there are, which one is meant, and opening it; what stands in the way as a person needs to hear it.

use std::fs::{File, OpenOptions, canonicalize, metadata, read_dir, read_link, read_to_string};
use std::io;
use std::os::unix::fs::{FileTypeExt, MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::time::Duration;

use lrp_bridge::Found;
use serialport::{ClearBuffer, SerialPort, TTYPort};

use crate::settings::Line;

/// Names that stay the same wherever a board is plugged in.
const BY_ID: &str = "/dev/serial/by-id";

/// How long a read waits: also how often is looked for what waits to be sent, and for calls that take too long.
const TICK: Duration = Duration::from_millis(20);

pub struct Opened {
    /// To be read.
    pub port: TTYPort,
    /// To be written, without blocking, as `port` does where the robot doesn't read.
    pub file: File,
}

pub fn open(line: &Line) -> Result<Opened, String> {
    let path = locate(line.port.as_deref())?;
    // Before the port, which then keeps others from opening it.
    let file = OpenOptions::new().write(true).custom_flags(libc::O_NONBLOCK | libc::O_NOCTTY).open(&path);
    let file = file.map_err(|error| explain(&path, error.kind(), &error.to_string()))?;
    let port = serialport::new(path.to_string_lossy(), line.baud).timeout(TICK).open_native();
    let port = port.map_err(|error| explain(&path, kind_of(&error), &error.description))?;
    // What came at another speed, or before anybody listened.
    let _ = port.clear(ClearBuffer::Input);
    Ok(Opened { port, file })
}

/// The one path that is meant.
fn locate(wanted: Option<&str>) -> Result<PathBuf, String> {
    let Some(wanted) = wanted else { return only_one() };
    let pattern = if wanted.contains('/') {
        PathBuf::from(wanted)
    } else if !matching(&Path::new(BY_ID).join(wanted)).is_empty() {
        Path::new(BY_ID).join(wanted)
    } else {
        Path::new("/dev").join(wanted)
    };
    let mut found = matching(&pattern);
    match found.len() {
        0 => Err(format!("there is no port `{wanted}`; {}", there_are())),
        1 => Ok(found.remove(0)),
        _ => Err(format!("`{wanted}` fits several ports: {}; name one of them", listed(&found))),
    }
}

fn only_one() -> Result<PathBuf, String> {
    let mut found = boards();
    match found.len() {
        1 => Ok(found.remove(0)),
        0 => Err(format!("no USB port is there; {}", there_are())),
        _ => Err(format!("there are several ports: {}; say which with `port`", listed(&found))),
    }
}

fn matching(pattern: &Path) -> Vec<PathBuf> {
    let name = pattern.file_name().unwrap_or_default().to_string_lossy();
    if !name.contains(['*', '?']) {
        return Some(pattern.to_path_buf()).filter(|path| path.exists()).into_iter().collect();
    }
    let all = entries(pattern.parent().unwrap_or(Path::new("/")));
    let fits = |path: &PathBuf| path.file_name().is_some_and(|file| fits(&name, &file.to_string_lossy()));
    all.into_iter().filter(fits).collect()
}

/// Whether a name is as a pattern of `*` and `?` wants it.
fn fits(pattern: &str, name: &str) -> bool {
    match pattern.chars().next() {
        None => name.is_empty(),
        Some('*') => {
            let rest = &pattern[1..];
            name.char_indices().map(|(at, _)| at).chain([name.len()]).any(|at| fits(rest, &name[at..]))
        }
        Some(wanted) => name.chars().next().is_some_and(|first| {
            (wanted == '?' || wanted == first) && fits(&pattern[wanted.len_utf8()..], &name[first.len_utf8()..])
        }),
    }
}

/// Ports that are boards and adapters rather than the computer's own.
fn boards() -> Vec<PathBuf> {
    let named = entries(Path::new(BY_ID));
    if !named.is_empty() {
        return named;
    }
    let plain = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        name.starts_with("ttyACM") || name.starts_with("ttyUSB")
    };
    entries(Path::new("/dev")).into_iter().filter(plain).collect()
}

/// Boards first, then what else there is.
pub fn found() -> Vec<Found> {
    let boards = boards();
    let real: Vec<PathBuf> = boards.iter().filter_map(|path| canonicalize(path).ok()).collect();
    let others =
        serialport::available_ports().unwrap_or_default().into_iter().map(|port| PathBuf::from(port.port_name));
    let others: Vec<PathBuf> = others.filter(|path| !boards.contains(path) && !real.contains(path)).collect();
    boards.into_iter().chain(others).map(|path| as_found(&path)).collect()
}

fn as_found(path: &Path) -> Found {
    let leads_to = read_link(path).ok().and_then(|_| canonicalize(path).ok());
    Found {
        name: path.display().to_string(),
        what: "port".into(),
        doc: leads_to.map(|path| format!("now {}", path.display())).unwrap_or_default(),
        setting: Some("port".into()),
        ..Found::default()
    }
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let mut all: Vec<PathBuf> = read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    all.sort();
    all
}

fn there_are() -> String {
    let found: Vec<PathBuf> = found().into_iter().map(|found| found.name.into()).collect();
    match found.is_empty() {
        true => "there is none at all: is the board plugged in, with a cable that carries data?".into(),
        false => format!("there are: {}", listed(&found)),
    }
}

fn listed(paths: &[PathBuf]) -> String {
    paths.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ")
}

fn explain(path: &Path, kind: io::ErrorKind, error: &str) -> String {
    let shown = path.display();
    let is_device = metadata(path).is_ok_and(|found| found.file_type().is_char_device());
    match kind {
        io::ErrorKind::PermissionDenied => format!("may not open {shown}: {}", join_group(path)),
        io::ErrorKind::NotFound => format!("there is no port {shown}; {}", there_are()),
        io::ErrorKind::ResourceBusy if is_device => format!("{shown} is in use by {}", holder(path)),
        _ if !is_device => format!("{shown} is no serial port"),
        _ => format!("{shown} can't be opened: {error}"),
    }
}

fn kind_of(error: &serialport::Error) -> io::ErrorKind {
    match error.kind {
        serialport::ErrorKind::Io(kind) => kind,
        serialport::ErrorKind::NoDevice => io::ErrorKind::ResourceBusy,
        _ => io::ErrorKind::Other,
    }
}

fn join_group(path: &Path) -> String {
    let group = metadata(path).ok().and_then(|found| group_name(found.gid()));
    match group {
        Some(group) if group != "root" => {
            format!("join the group `{group}` with `sudo usermod -aG {group} $USER`, then log in anew")
        }
        _ => "its rights are for others only; a udev rule can change that".into(),
    }
}

fn group_name(id: u32) -> Option<String> {
    let groups = read_to_string("/etc/group").ok()?;
    groups.lines().find_map(|line| {
        let mut fields = line.split(':');
        let name = fields.next()?;
        (fields.nth(1)?.parse() == Ok(id)).then(|| name.to_string())
    })
}

/// The program that has a port open, as far as we may see.
fn holder(path: &Path) -> String {
    let (Ok(port), own) = (canonicalize(path), std::process::id().to_string()) else { return "another program".into() };
    let holds = |process: &PathBuf| {
        entries(&process.join("fd")).iter().any(|open| read_link(open).is_ok_and(|target| target == port))
    };
    let number = |path: &PathBuf| path.file_name().is_some_and(|name| name.to_string_lossy().parse::<u32>().is_ok());
    let others = entries(Path::new("/proc")).into_iter().filter(number).filter(|process| !process.ends_with(&own));
    match others.filter(holds).find_map(|process| read_to_string(process.join("comm")).ok()) {
        Some(name) => format!("another program, `{}`; end that first", name.trim()),
        None => "another program; end that first".into(),
    }
}
