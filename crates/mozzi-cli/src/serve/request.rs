//! An HTTP request: its head, and the response.

use std::io::{ErrorKind, Result};

/// Longest head of a request, bytes; a browser sends a tenth of it.
pub const LONGEST_HEAD: usize = 16 << 10;

pub enum Head {
    /// The text before the empty line.
    Whole(Vec<u8>),
    Late,
    Long,
}

/// The request up to its empty line. `read` fills a piece like [`std::io::Read::read`], until its deadline.
pub fn head(mut read: impl FnMut(&mut [u8]) -> Result<usize>) -> Result<Head> {
    let (mut head, mut piece) = (Vec::new(), [0; 4096]);
    loop {
        let count = match read(&mut piece) {
            Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
            Ok(count) => count,
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => return Ok(Head::Late),
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        };
        let begin = head.len().saturating_sub(3); // the empty line may have begun
        head.extend_from_slice(&piece[..count]);
        let is_end = |at: usize| head[at..].starts_with(b"\r\n\r\n") || head[at..].starts_with(b"\n\n");
        if let Some(at) = (begin..head.len()).find(|&at| is_end(at)) {
            head.truncate(at);
        } else if head.len() < LONGEST_HEAD + 4 {
            continue;
        }
        return Ok(if head.len() > LONGEST_HEAD { Head::Long } else { Head::Whole(head) });
    }
}

pub struct Reply<'p> {
    pub status: &'static str,
    pub kind: &'static str,
    pub body: &'p str,
    /// The method is HEAD: the body is not sent.
    pub is_head: bool,
}

/// The page, or an error status.
pub fn reply<'p>(head: &[u8], port: u16, page: &'p str) -> Reply<'p> {
    let head = String::from_utf8_lossy(head);
    let mut lines = head.lines();
    let mut words = lines.next().unwrap_or_default().split(' ');
    let hosts: Vec<&str> = lines
        .filter_map(|line| line.split_once(':'))
        .filter(|(name, _)| name.eq_ignore_ascii_case("host"))
        .map(|(_, value)| value.trim())
        .collect();
    // DNS rebinding: a page from elsewhere whose host name resolves to 127.0.0.1 sends that name here
    let is_us = matches!(hosts[..], [host] if is_here(host, port));
    let (method, target) = (words.next(), words.next());
    let is_http = words.next().is_some_and(|version| version.starts_with("HTTP/"));
    let (status, kind, body) = match (is_us, method, target) {
        (false, ..) => ("403 Forbidden", "text/plain", "this page is for 127.0.0.1"),
        _ if !is_http => ("400 Bad Request", "text/plain", "the first line is no request of HTTP"),
        (_, Some("GET" | "HEAD"), Some("/")) => ("200 OK", "text/html", page),
        (_, Some("GET" | "HEAD"), _) => ("404 Not Found", "text/plain", "the only page is /"),
        _ => ("405 Method Not Allowed", "text/plain", "only GET and HEAD are allowed"),
    };
    Reply { status, kind, body, is_head: method == Some("HEAD") }
}

fn is_here(host: &str, port: u16) -> bool {
    let names = ["127.0.0.1", "localhost"];
    let is = |name: &str| host.eq_ignore_ascii_case(name);
    names.iter().any(|name| is(&format!("{name}:{port}")) || port == 80 && is(name))
}
