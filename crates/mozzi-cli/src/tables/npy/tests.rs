use super::*;

fn parse(bytes: &[u8]) -> Result<(Header, Vec<f64>)> {
    let mut rest = bytes;
    let header = header(&"x.npy", &mut rest)?;
    let length = rest.len() as u64;
    let known = numbers(&"x.npy", &header, Some(length), &mut rest.to_vec().as_slice())?;
    let unknown = numbers(&"x.npy", &header, None, &mut rest)?;
    assert_eq!(known.len(), unknown.len());
    Ok((header, known))
}

fn file(header: &str, numbers: &[u8]) -> Vec<u8> {
    let length = (header.len() as u16).to_le_bytes();
    [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes(), numbers].concat()
}

#[test]
fn arrays_come_back() {
    for shape in [vec![], vec![6], vec![3, 2], vec![0, 4], vec![1, 3, 2], vec![5000, 3]] {
        let values: Vec<f64> = (0..shape.iter().product()).map(|k| (k as f64).sqrt()).collect();
        let written = bytes(&Array::new("x", shape.clone(), values.clone()));
        assert_eq!((written.len() - 8 * values.len()) % 64, 0);
        let (header, found) = parse(&written).expect("an array");
        assert_eq!((header.shape, header.is_structured, found), (shape, false, values));
    }
    assert_eq!(plain_header::<f64>(&[1, 7]).len(), plain_header::<f64>(&[usize::MAX, 7]).len());
    let single = parse(&bytes(&Array::new("x", vec![2], vec![0.5_f32, -3.0]))).expect("an array");
    assert_eq!(single.1, [0.5, -3.0]);
}

#[test]
fn named_columns_come_back() {
    let long: Vec<String> = (0..5000).map(|k| format!("theta_of_a_joint_{k}")).collect();
    for names in [vec!["t".to_string(), "it's \\ \"a\" \u{7} ö".to_string()], vec!["t".to_string()], long] {
        let written = structured_header(&names, 2);
        assert_eq!((written.len() % 64, written.len()), (0, structured_header(&names, usize::MAX).len()));
        let numbers: Vec<f64> = (0..2 * names.len()).map(|k| k as f64).collect();
        let data: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        let (header, found) = parse(&[written, data].concat()).expect("an array");
        let found_names: Vec<String> = header.fields.into_iter().map(|(name, _)| name).collect();
        assert_eq!((header.is_structured, found_names, found), (true, names, numbers));
    }
}

#[test]
fn columns_become_rows_and_big_ends_little() {
    let numbers: Vec<u8> = [1.0_f64, 4.0, 2.0, 5.0, 3.0, 6.0].iter().flat_map(|x| x.to_be_bytes()).collect();
    let found = parse(&file("{\"descr\": '>f8', 'fortran_order': True, 'shape': (2, 3)}", &numbers)).expect("an array");
    assert_eq!((found.0.shape, found.1), (vec![2, 3], vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
    let mixed = "{'descr': [('a', '>i2'), ('b', '<f4')], 'fortran_order': False, 'shape': (1,), }";
    let found = parse(&file(mixed, &[1, 2, 0, 0, 0, 63])).expect("an array");
    assert_eq!(found.1, [258.0, 0.5]);
}

#[test]
fn what_is_no_array_of_numbers_is_refused() {
    let of = |descr: &str, shape: &str| format!("{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}}}");
    let long = file(&of("'<f8'", "(99999999999, 99999999999)"), &[0; 16]);
    for (bytes, word) in [
        (b"PK\x03\x04".to_vec(), "does not begin"),
        (b"PK\x03\x04PK\x03\x04PK\x03\x04".to_vec(), "does not begin"),
        (b"\x93NUMPY".to_vec(), "ends inside its header"),
        (b"\x93NUMPY\x09\x00\x01\x00".to_vec(), "version is 9"),
        (b"\x93NUMPY\x01\x00\xc8\x00{".to_vec(), "ends inside its header"),
        (b"\x93NUMPY\x02\x00\xff\xff\xff\xff{".to_vec(), "header has 4294967295 bytes"),
        (file("{'descr': '<f8'}", &[]), "no `fortran_order`"),
        (file("'descr'", &[]), "is not a dictionary"),
        (file(&of("'<c16'", "(1,)"), &[0; 16]), "type <c16"),
        (file(&of("[('a', '<f8', (2,))]", "(1,)"), &[0; 16]), "no list of names"),
        (file(&of("[]", "(1,)"), &[]), "no list of names"),
        (file(&of("'<f8'", "(x,)"), &[0; 8]), "tuple of numbers"),
        (file(&of("'<f8'", "(2,)"), &[0; 8]), "8 bytes"),
        (file(&of("'<i8'", "(1,)"), &i64::MAX.to_le_bytes()), "entry 0 (counted from 0): 9223372036854775807"),
        (long, "16 bytes"),
    ] {
        let Err(Failure::Wrong(message)) = parse(&bytes) else { panic!("expected {word}") };
        assert!(message.starts_with("x.npy") && message.contains(word), "{message}");
    }
}
