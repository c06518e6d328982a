//! Invalid XML, and XML that is not accepted.

use super::refused;
use mozzi_urdf::parse;

#[test]
fn broken_xml() {
    refused(&[
        ("§", "empty", "the file is empty, expected a <robot>"),
        ("§ \n\n ", "empty", "the file is empty, expected a <robot>"),
        ("§hello", "syntax", "found `hello`, expected an element"),
        ("<robot name='a'>\n  <§link name='b'>\n", "syntax", "the file ends before <link> is closed"),
        ("<robot name='a'>\n  §<link name='b", "syntax", "the file ends inside a tag that opens here"),
        ("<robot name='a'>§<!-- never </robot>", "syntax", "the file ends inside a comment that opens here"),
        ("<robot name='a'>§<![CDATA[ never </robot>", "syntax", "the file ends inside a CDATA section that opens here"),
        ("<robot name='a'><link name='b'>§</robot></link>", "syntax", "</robot> closes <link>, expected </link>"),
        (
            "<robot name='a'><link name='b' §name='c'/></robot>",
            "syntax",
            "the attribute `name` occurs twice on one element",
        ),
        ("<robot name='§&who;'/>", "syntax", "the entity `&who;` is unknown; entities are not expanded"),
        ("<robot name='a§&b'/>", "syntax", "`&` begins no entity here"),
        ("<robot name='a>\n §<link name='b'/>\n</robot>", "syntax", "`<` is inside an attribute's value"),
        ("<robot name=§a/>", "syntax", "expected a quote, found `a`"),
        ("<robot name§/>", "syntax", "expected `=`, found `/`"),
        (
            "<robot name='a'/>\n§<robot name='b'/>",
            "syntax",
            "a second root element begins here, expected the file's end",
        ),
        (
            "<?xml version='1.0'?>\n§<!DOCTYPE robot [<!ENTITY a 'b'>]>\n<robot name='&a;'/>",
            "document_type",
            "the file has a document type (<!DOCTYPE>), expected none: entities are not expanded",
        ),
    ]);
}

#[test]
fn too_much() {
    let deep = format!("<robot name='a'>{}<§b>{}", "<b>".repeat(255), "<b>".repeat(9000));
    let wide =
        format!("<robot name='a'><§link {}/></robot>", (0..257).map(|k| format!("a{k}='' ")).collect::<String>());
    let spaces: String = (0..65).map(|k| format!(" xmlns:n{k}='{k}'")).collect();
    let spaces = format!("<§robot name='a'{spaces}/>");
    refused(&[
        (deep.leak(), "too_deep", "257 nested elements, expected at most 256"),
        (wide.leak(), "too_many_attributes", "257 attributes on this element, expected at most 256"),
        (spaces.leak(), "too_many_namespaces", "65 namespaces in scope, expected at most 64"),
    ]);
    let long = format!("<robot name='a'><link name='§{}'/></robot>", "b".repeat(257));
    refused(&[(long.leak(), "long_name", "link: name: has 257 bytes, expected at most 256")]);
    let large = parse("a.urdf", vec![b' '; (64 << 20) + 1]).expect_err("too large").to_string();
    assert!(large.ends_with("a.urdf:1:1: error: the file has 67108865 bytes, expected at most 67108864"), "{large}");
}

#[test]
fn encodings() {
    let robot = "<robot name='ä'><link name='b'/></robot>";
    let with_mark = [&[0xef, 0xbb, 0xbf], robot.as_bytes()].concat();
    assert_eq!(parse("a.urdf", with_mark).expect("a byte order mark").description.name, "ä");

    let latin: Vec<u8> = robot.chars().map(|c| c as u8).collect();
    let error = parse("a.urdf", latin).expect_err("Latin-1").to_string();
    assert!(error.ends_with("a.urdf:1:14: error: byte 13 of the file is 0xe4, which is not UTF-8"), "{error}");

    let wide: Vec<u8> = robot.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let error = parse("a.urdf", [vec![0xff, 0xfe], wide].concat()).expect_err("UTF-16").to_string();
    assert!(error.ends_with("a.urdf:1:1: error: the file is encoded as UTF-16, expected UTF-8"), "{error}");
}
