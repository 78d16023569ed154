//! How a participant is built: without a multicast address for messages, and with its threads known.

use std::collections::BTreeSet;
use std::fs::{read_dir, read_to_string};
use std::io;
use std::net::{Ipv4Addr, SocketAddrV4};
use std::path::PathBuf;
use std::thread::sleep;
use std::time::{Duration, Instant};

use socket2::{Domain, Socket, Type};

/// Where messages to a multicast address go, by the RTPS specification (9.6.2.3).
const MESSAGES_PORT: u16 = 7401;
const PORTS_PER_DOMAIN: u16 = 250;

/// How long the port may be somebody else's.
const PORT_PATIENCE: Duration = Duration::from_millis(100);

/// Threads of RustDDS in this process.
pub fn threads() -> BTreeSet<PathBuf> {
    let all = read_dir("/proc/self/task").into_iter().flatten().flatten().map(|thread| thread.path());
    let is_one = |thread: &PathBuf| read_to_string(thread.join("comm")).is_ok_and(|name| name.starts_with("RustDDS"));
    all.filter(is_one).collect()
}

/// Builds a participant that offers no multicast address for messages, only one for discovery. RustDDS would offer both
/// that and its own address, and then Fast DDS sends everything twice, on wireless networks at a crawl; and the second copy
/// of a big message's last part is kept as if it were a message to come.
///
/// There is no setting for it, but RustDDS goes without where it can't have the port; so nobody else can for these few
/// milliseconds either.
pub fn without_multicast<T>(domain: u16, build: impl FnOnce() -> T) -> T {
    let address = SocketAddrV4::new(Ipv4Addr::UNSPECIFIED, MESSAGES_PORT + domain * PORTS_PER_DOMAIN);
    let end = Instant::now() + PORT_PATIENCE;
    let mut taken = take(address);
    // Another bridge may be at the same point.
    while taken.is_err() && Instant::now() < end {
        sleep(Duration::from_millis(5));
        taken = take(address);
    }
    let built = build();
    drop(taken);
    built
}

/// Takes a port that others may share, as those of Cyclone do, and from now on shares it with nobody else.
fn take(address: SocketAddrV4) -> io::Result<Socket> {
    let socket = Socket::new(Domain::IPV4, Type::DGRAM, None)?;
    socket.set_reuse_address(true)?;
    socket.bind(&address.into())?;
    socket.set_reuse_address(false)?;
    Ok(socket)
}
