//! One page over HTTP, on 127.0.0.1 alone. Each connection has a thread and deadlines, so that none blocks another.

pub mod request;

use crate::failure::{self, Failure};
use crate::interrupt;
use crate::json::print;
use request::{Head, Reply};
use serde_json::json;
use std::collections::VecDeque;
use std::io::{ErrorKind, Read, Result, Write};
use std::net::{Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::{Arc, Weak};
use std::thread;
use std::time::{Duration, Instant};

/// Time limit for the request's head.
const FOR_HEAD: Duration = Duration::from_secs(5);
/// Time limits for sending a piece of the response, and all of it: this time, and more for each byte (100 kB/s).
const FOR_PIECE: Duration = Duration::from_secs(10);
const FOR_ANSWER: Duration = Duration::from_secs(20);
const PER_BYTE: Duration = Duration::from_micros(10);
const PIECE: usize = 1 << 16;
/// Limits on time and bytes for data that a client still sends after the response.
const FOR_REST: Duration = Duration::from_secs(1);
const LONGEST_REST: usize = 8 << 20;
/// Connections at the same time; a further one ends the oldest, so that slow clients keep nobody out.
const MOST: usize = 128;
const PAUSE: Duration = Duration::from_millis(20);

pub struct Server(TcpListener);

impl Server {
    /// Listens on this port; 0 is a free one.
    pub fn new(port: u16) -> Result<Self> {
        TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map(Server)
    }

    pub fn address(&self) -> Result<SocketAddr> {
        self.0.local_addr()
    }

    /// Serves until Ctrl-C ends the program. No client can end it.
    pub fn run(&self, page: String) -> Result<()> {
        interrupt::end_at_once();
        let (port, page) = (self.address()?.port(), Arc::<str>::from(page));
        let mut open: VecDeque<Weak<TcpStream>> = VecDeque::new();
        loop {
            let Ok((stream, _)) = self.0.accept() else {
                thread::sleep(PAUSE); // the system has no room for a connection
                continue;
            };
            open.retain(|visitor| visitor.strong_count() > 0);
            if open.len() >= MOST
                && let Some(oldest) = open.pop_front().and_then(|oldest| oldest.upgrade())
            {
                let _ = oldest.shutdown(Shutdown::Both); // it may have closed itself
            }
            let (page, stream) = (Arc::clone(&page), Arc::new(stream));
            open.push_back(Arc::downgrade(&stream));
            let started = thread::Builder::new().stack_size(1 << 18).spawn(move || drop(visit(&stream, port, &page)));
            if started.is_err() {
                thread::sleep(PAUSE); // the system has no room for a thread
            }
        }
    }
}

/// Serves a page until Ctrl-C, and prints its address: on standard error, with `is_json` also on standard output.
pub fn show(
    robot: &str,
    page: String,
    size: &str,
    port: Option<u16>,
    is_json: bool,
) -> std::result::Result<(), Failure> {
    let cannot = |error: std::io::Error| Failure::wrong(format!("the page cannot be served on 127.0.0.1: {error}"));
    let server = Server::new(port.unwrap_or(0)).map_err(cannot)?;
    let address = server.address().map_err(cannot)?;
    failure::write(&format!("{robot} is at http://{address}/ on this machine only ({size}); Ctrl-C ends it\n"));
    if is_json {
        // before the page is served, which takes until Ctrl-C
        let object = json!({ "robot": robot, "address": format!("http://{address}/") });
        let mut output = std::io::stdout().lock();
        output.write_all(print(&object).as_bytes()).and_then(|()| output.flush()).map_err(cannot)?;
    }
    server.run(page).map_err(cannot)
}

/// Reads one request and sends the response.
fn visit(stream: &TcpStream, port: u16, page: &str) -> Result<()> {
    let end = Instant::now() + FOR_HEAD;
    let head = request::head(|piece| {
        let left = end.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        stream.set_read_timeout(Some(left))?;
        (&mut &*stream).read(piece)
    })?;
    let head = match head {
        Head::Whole(head) => head,
        Head::Late => return answer(stream, "408 Request Timeout", "text/plain", Some("the request took too long")),
        Head::Long => {
            answer(stream, "431 Request Header Fields Too Large", "text/plain", Some("the request is too long"))?;
            return rest(stream);
        }
    };
    let Reply { status, kind, body, is_head } = request::reply(&head, port, page);
    if is_head {
        start(stream, status, kind, body.len())?;
    } else {
        answer(stream, status, kind, Some(body))?;
    }
    rest(stream)
}

fn start(mut stream: &TcpStream, status: &str, kind: &str, length: usize) -> Result<()> {
    stream.set_write_timeout(Some(FOR_PIECE))?;
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}; charset=utf-8\r\nContent-Length: {length}\r\nCache-Control: no-store\r\n\
         X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n"
    );
    stream.write_all(head.as_bytes())
}

fn answer(mut stream: &TcpStream, status: &str, kind: &str, body: Option<&str>) -> Result<()> {
    let (end, body) = (Instant::now() + FOR_ANSWER, body.unwrap_or_default());
    let end = end + PER_BYTE * u32::try_from(body.len()).unwrap_or(u32::MAX);
    start(stream, status, kind, body.len())?;
    for piece in body.as_bytes().chunks(PIECE) {
        if Instant::now() > end {
            return Err(ErrorKind::TimedOut.into());
        }
        stream.write_all(piece)?;
    }
    stream.flush()
}

/// Reads remaining data for a while: if the connection were closed earlier, the system would drop the response.
fn rest(mut stream: &TcpStream) -> Result<()> {
    stream.shutdown(Shutdown::Write)?;
    let end = Instant::now() + FOR_REST;
    let (mut piece, mut read) = ([0; 4096], 0);
    while read < LONGEST_REST {
        let left = end.saturating_duration_since(Instant::now());
        if left.is_zero() {
            break;
        }
        stream.set_read_timeout(Some(left))?;
        match stream.read(&mut piece)? {
            0 => break,
            count => read += count,
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::request::LONGEST_HEAD;
    use super::*;

    fn serve(page: &str) -> SocketAddr {
        let server = Server::new(0).expect("a free port");
        let address = server.address().expect("an address");
        assert!(address.ip().is_loopback());
        let page = page.to_string();
        thread::spawn(move || server.run(page));
        address
    }

    fn ask(address: SocketAddr, request: &[u8]) -> String {
        let mut stream = TcpStream::connect(address).expect("connected");
        stream.write_all(request).expect("sent");
        let mut text = String::new();
        stream.read_to_string(&mut text).expect("text");
        text
    }

    fn get(address: SocketAddr, path: &str, host: &str) -> String {
        ask(address, format!("GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n").as_bytes())
    }

    #[test]
    fn it_answers_this_machine_and_its_own_name_only() {
        let address = serve("<p>page</p>");
        let port = address.port();
        for us in [format!("127.0.0.1:{port}"), format!("localhost:{port}"), format!("LocalHost:{port}")] {
            let page = get(address, "/", &us);
            assert!(page.starts_with("HTTP/1.1 200 OK\r\n") && page.ends_with("\r\n\r\n<p>page</p>"), "{page}");
        }
        let us = format!("127.0.0.1:{port}");
        assert!(get(address, "/favicon.ico", &us).starts_with("HTTP/1.1 404"));
        for other in ["evil.example:80", "127.0.0.1", &format!("{us}\r\nHost: evil.example")] {
            assert!(get(address, "/", other).starts_with("HTTP/1.1 403"), "{other}");
        }
        let of = |method: &str| ask(address, format!("{method} / HTTP/1.1\r\nhOsT:{us}\r\n\r\n").as_bytes());
        assert!(of("POST").starts_with("HTTP/1.1 405"));
        assert!(of("HEAD").ends_with("Content-Length: 11\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n"));
    }

    #[test]
    fn slow_and_silent_visitors_hold_up_nobody() {
        let page = "p".repeat(20 << 20);
        let address = serve(&page);
        let us = format!("127.0.0.1:{}", address.port());
        let request = format!("GET / HTTP/1.1\r\nHost: {us}\r\n\r\n");
        let silent: Vec<_> = (0..100).map(|_| TcpStream::connect(address).expect("connected")).collect();
        // more than are served at a time, and none reads the page
        let stuck: Vec<_> = (0..2 * MOST)
            .map(|_| {
                let mut stuck = TcpStream::connect(address).expect("connected");
                stuck.write_all(request.as_bytes()).expect("sent");
                stuck
            })
            .collect();
        // sends one letter at a time
        let mut slow = TcpStream::connect(address).expect("connected");
        let dripping = thread::spawn(move || {
            let begin = Instant::now();
            let mut text = String::new();
            while slow.write_all(b"G").is_ok() && begin.elapsed() < 2 * FOR_HEAD {
                thread::sleep(Duration::from_millis(100));
                slow.set_read_timeout(Some(Duration::from_millis(1))).expect("set");
                if slow.read_to_string(&mut text).is_ok() || !text.is_empty() {
                    break;
                }
            }
            (text, begin.elapsed())
        });
        let begin = Instant::now();
        let found = get(address, "/", &us);
        assert!(found.ends_with(&page[..1000]) && found.len() > page.len(), "{} bytes", found.len());
        assert!(begin.elapsed() < FOR_HEAD, "{:?}", begin.elapsed());
        drop((silent, stuck));
        let (said, took) = dripping.join().expect("no panic");
        assert!(said.starts_with("HTTP/1.1 408") && took < 2 * FOR_HEAD, "{said} after {took:?}");
    }

    #[test]
    fn a_long_head_is_refused() {
        let address = serve("page");
        let start = format!("GET / HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nX-Long: ", address.port());
        for length in [LONGEST_HEAD, 1 << 20] {
            let said = ask(address, format!("{start}{}\r\n\r\n", "x".repeat(length)).as_bytes());
            assert!(said.starts_with("HTTP/1.1 431"), "{said}");
        }
        assert!(ask(address, format!("{start}{}\r\n\r\n", "x".repeat(8000)).as_bytes()).starts_with("HTTP/1.1 200"));
    }
}
