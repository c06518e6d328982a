//! One page over HTTP, on 127.0.0.1 alone.

use std::io::{BufRead, BufReader, Read, Result, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::time::Duration;

/// A request is one line and some headers; a longer one is none that a browser sends here.
const LONGEST_REQUEST: u64 = 64 << 10;

pub struct Server(TcpListener);

impl Server {
    /// On this port; 0 is a free one.
    pub fn new(port: u16) -> Result<Self> {
        TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map(Server)
    }

    pub fn address(&self) -> Result<SocketAddr> {
        self.0.local_addr()
    }

    /// Answers until the program is ended. A visitor who leaves early ends nothing.
    pub fn run(&self, page: &str) -> Result<()> {
        let port = self.address()?.port();
        loop {
            let (stream, _) = self.0.accept()?;
            let _ = answer(stream, port, page);
        }
    }
}

fn answer(mut stream: TcpStream, port: u16, page: &str) -> Result<()> {
    stream.set_read_timeout(Some(Duration::from_secs(5)))?;
    let mut lines = BufReader::new((&stream).take(LONGEST_REQUEST)).lines();
    let request = lines.next().transpose()?.unwrap_or_default();
    let mut host = String::new();
    for line in lines {
        let line = line?;
        if line.is_empty() {
            break;
        }
        if let Some((name, value)) = line.split_once(':')
            && name.eq_ignore_ascii_case("host")
        {
            host = value.trim().to_string();
        }
    }
    // a page from elsewhere whose name was made to mean 127.0.0.1 says that name here
    let is_us = [format!("127.0.0.1:{port}"), format!("localhost:{port}")].contains(&host);
    let mut words = request.split(' ');
    let (status, body) = match (is_us, words.next(), words.next()) {
        (false, ..) => ("403 Forbidden", "this page is for 127.0.0.1"),
        (_, Some("GET" | "HEAD"), Some("/")) => ("200 OK", page),
        (_, Some("GET" | "HEAD"), _) => ("404 Not Found", "the only page is /"),
        _ => ("405 Method Not Allowed", "only GET and HEAD are allowed"),
    };
    let kind = if status == "200 OK" { "text/html" } else { "text/plain" };
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}; charset=utf-8\r\nContent-Length: {}\r\nCache-Control: no-store\r\n\
         X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n",
        body.len()
    )?;
    if !request.starts_with("HEAD") {
        stream.write_all(body.as_bytes())?;
    }
    stream.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_answers_this_machine_and_its_own_name_only() {
        let server = Server::new(0).expect("a free port");
        let address = server.address().expect("an address");
        assert!(address.ip().is_loopback());
        std::thread::spawn(move || server.run("<p>page</p>"));
        let ask = |request: &str| {
            let mut stream = TcpStream::connect(address).expect("connected");
            stream.write_all(request.as_bytes()).expect("sent");
            let mut text = String::new();
            stream.read_to_string(&mut text).expect("text");
            text
        };
        let get = |path: &str, host: &str| ask(&format!("GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n"));
        let us = format!("127.0.0.1:{}", address.port());
        let page = get("/", &us);
        assert!(page.starts_with("HTTP/1.1 200 OK\r\n") && page.ends_with("\r\n\r\n<p>page</p>"), "{page}");
        assert!(get("/favicon.ico", &us).starts_with("HTTP/1.1 404"));
        assert!(get("/", "evil.example:80").starts_with("HTTP/1.1 403"));
        assert!(ask(&format!("POST / HTTP/1.1\r\nHost: {us}\r\n\r\n")).starts_with("HTTP/1.1 405"));
        assert!(ask(&format!("HEAD / HTTP/1.1\r\nHost: {us}\r\n\r\n")).ends_with("\r\n\r\n"));
    }
}
