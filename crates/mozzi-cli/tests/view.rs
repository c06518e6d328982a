//! `mozzi view` as a server: only Ctrl-C ends it.
#![cfg(unix)]

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A running server, and its address.
fn serve() -> (Child, String) {
    let mut program = Command::new(env!("CARGO_BIN_EXE_mozzi"))
        .args(["view", "double_pendulum"])
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let mut line = String::new();
    BufReader::new(program.stderr.as_mut().expect("piped")).read_line(&mut line).expect("a line");
    let address =
        line.split_once("http://").and_then(|(_, rest)| rest.split_once('/')).expect("an address").0.to_string();
    (program, address)
}

fn get(address: &str) -> String {
    let mut stream = TcpStream::connect(address).expect("connected");
    write!(stream, "GET / HTTP/1.1\r\nHOST: {address}\r\n\r\n").expect("sent");
    let mut text = String::new();
    stream.read_to_string(&mut text).expect("an answer");
    text
}

#[test]
fn ctrl_c_ends_it_with_130_though_others_are_connected() {
    let (mut program, address) = serve();
    let idle: Vec<TcpStream> = (0..20).map(|_| TcpStream::connect(&address).expect("connected")).collect();
    let begin = Instant::now();
    let page = get(&address);
    assert!(page.starts_with("HTTP/1.1 200 OK") && page.contains("double_pendulum"), "{page:.200}");
    let id = program.id().to_string();
    assert!(Command::new("kill").args(["-INT", &id]).status().expect("kill runs").success());
    let status = program.wait().expect("it ends");
    assert_eq!(status.code(), Some(130));
    // one after the other, twenty times five seconds
    assert!(begin.elapsed() < Duration::from_secs(60), "{:?}", begin.elapsed());
    drop(idle);
}
