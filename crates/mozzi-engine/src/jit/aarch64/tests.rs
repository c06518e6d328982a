//! Compares each form with a disassembler.

use super::*;
use crate::jit::shape::Machine;
use crate::jit::target::LARGEST_ON_STACK;
use yaxpeax_arch::{Arch, Decoder, U8Reader};
use yaxpeax_arm::armv8::a64::ARMv8;

const BYTES: usize = 1 << 20;
/// Of each group that is saved or not.
const REGISTERS: [Register; 7] = [0, 3, 7, 8, 15, 23, 31];

fn ours() -> impl Iterator<Item = Shape> {
    Shape::ALL.into_iter().filter(|shape| shape.machine() == Machine::AArch64)
}

fn assembler(shape: Shape) -> Arm {
    Arm::new(shape, &[BYTES; MOST_ARRAYS - 1])
}

/// The text of each instruction, blanks and commas as one blank.
fn decoded(bytes: &[u8]) -> Vec<String> {
    let decoder = <ARMv8 as Arch>::Decoder::default();
    let text = |word: &[u8]| {
        let found = decoder.decode(&mut U8Reader::new(word));
        let text = found.unwrap_or_else(|error| panic!("{word:02x?}: {error:?}")).to_string();
        text.split([' ', ',']).filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" ")
    };
    bytes.chunks_exact(4).map(text).collect()
}

fn body(assembler: &Arm) -> Vec<String> {
    decoded(&assembler.body.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>())
}

/// One instruction is what the disassembler says.
fn check(shape: Shape, expected: &str, write: impl FnOnce(&mut Arm)) {
    let mut assembler = assembler(shape);
    write(&mut assembler);
    assert_eq!(body(&assembler), [expected], "{shape:?}, {:08x?}", assembler.body);
    assert_eq!(assembler.tally.instructions, 1);
}

/// A register as a number, or as its lanes.
fn named(shape: Shape, register: Register) -> String {
    let number = number(register);
    match (shape.is_scalar(), shape.is_f64()) {
        (true, true) => format!("d{number}"),
        (true, false) => format!("s{number}"),
        (false, true) => format!("v{number}.2d"),
        (false, false) => format!("v{number}.4s"),
    }
}

/// As bits.
fn bits(shape: Shape, register: Register) -> String {
    format!("v{}.{}", number(register), if shape.is_scalar() { "8b" } else { "16b" })
}

/// As one integer or several.
fn integers(shape: Shape, register: Register) -> String {
    match (shape.is_scalar(), shape.is_f64()) {
        (true, false) => format!("v{}.2s", number(register)),
        _ => named(shape, register),
    }
}

/// Three registers, many times.
fn triples() -> impl Iterator<Item = [Register; 3]> {
    let of = |skip: usize| REGISTERS.into_iter().cycle().skip(skip);
    of(0).zip(of(3)).zip(of(5)).map(|((a, b), c)| [a, b, c]).take(REGISTERS.len())
}

#[test]
fn operations_on_one_and_two_numbers() {
    use Operation::*;
    for shape in ours() {
        let of_numbers = [(Add, "fadd"), (Sub, "fsub"), (Mul, "fmul"), (Div, "fdiv"), (Min, "fmin"), (Max, "fmax")];
        for ((operation, name), [target, a, b]) in of_numbers.into_iter().flat_map(|o| triples().map(move |r| (o, r))) {
            let [t, x, y] = [target, a, b].map(|register| named(shape, register));
            check(shape, &format!("{name} {t} {x} {y}"), |it| it.apply(operation, target, a, Operand::Register(b)));
        }
        for ((operation, name), [target, a, b]) in
            [(And, "and"), (Xor, "eor")].into_iter().flat_map(|o| triples().map(move |r| (o, r)))
        {
            let [t, x, y] = [target, a, b].map(|register| bits(shape, register));
            check(shape, &format!("{name} {t} {x} {y}"), |it| it.apply(operation, target, a, Operand::Register(b)));
        }
        for [target, a, b] in triples() {
            let [t, x, y] = [target, a, b].map(|register| integers(shape, register));
            check(shape, &format!("sub {t} {x} {y}"), |it| it.apply(SubBits, target, a, Operand::Register(b)));
            check(shape, &format!("shl {t} {x} #0x1d"), |it| it.apply(ShiftLeft(29), target, a, Operand::Register(a)));
            let [t, x] = [target, a].map(|register| named(shape, register));
            check(shape, &format!("fneg {t} {x}"), |it| it.apply(Neg, target, a, Operand::Register(a)));
            check(shape, &format!("fsqrt {t} {x}"), |it| it.apply(Sqrt, target, a, Operand::Register(a)));
            let copy = match shape.is_scalar() {
                true => format!("fmov {t} {x}"),
                false => format!("mov {} {}", bits(shape, target), bits(shape, a)),
            };
            check(shape, &copy, |it| it.load(target, Operand::Register(a)));
        }
    }
}

#[test]
fn operations_on_three_values() {
    use Operation::*;
    for (shape, [target, a, b]) in ours().flat_map(|shape| triples().map(move |r| (shape, r))) {
        let c = (target + 5) % 32;
        let [t, x, y, z] = [target, a, b, c].map(|register| named(shape, register));
        let of_one = [(MulAdd, "fmadd"), (MulSub, "fnmsub"), (NegMulAdd, "fmsub"), (NegMulSub, "fnmadd")];
        for (operation, name) in of_one.into_iter().filter(|_| shape.is_scalar()) {
            check(shape, &format!("{name} {t} {x} {y} {z}"), |it| it.product_of_one(operation, target, [a, b, c]));
        }
        for (operation, name) in [(MulAdd, "fmla"), (NegMulAdd, "fmls")].into_iter().filter(|_| !shape.is_scalar()) {
            check(shape, &format!("{name} {t} {x} {y}"), |it| it.product_of_lanes(operation, target, [a, b]));
        }
        let [t, x, y] = [target, a, b].map(|register| bits(shape, register));
        for (where_set, name) in [(true, "bit"), (false, "bif")] {
            check(shape, &format!("{name} {t} {x} {y}"), |it| it.insert(where_set, target, a, b));
        }
    }
}

#[test]
fn moves_between_lanes() {
    for (shape, [target, a, b]) in ours().filter(|s| !s.is_scalar()).flat_map(|s| triples().map(move |r| (s, r))) {
        for (half, name) in [(Half::Lower, "zip1"), (Half::Upper, "zip2")] {
            for (grain, lanes) in [(Grain::Bits64, "2d"), (Grain::Bits32, "4s")] {
                let [t, x, y] = [target, a, b].map(|register| format!("v{}.{lanes}", number(register)));
                let operation = Operation::Interleave(half, grain);
                check(shape, &format!("{name} {t} {x} {y}"), |it| it.apply(operation, target, a, Operand::Register(b)));
            }
        }
    }
}

/// The address of an instruction's text, `[x2 #0x10]`, and the value of its register after additions before it.
fn accessed(lines: &[String]) -> (usize, usize) {
    let mut pointers = std::collections::HashMap::<&str, (usize, usize)>::new();
    let immediate = |text: &str| usize::from_str_radix(text.trim_start_matches("#0x"), 16).expect("hexadecimal");
    for line in &lines[..lines.len() - 1] {
        let parts: Vec<&str> = line.split(' ').collect();
        let ["add", to, from, by, ref shift @ ..] = parts[..] else { panic!("{line}") };
        let (array, byte) = pointers.get(from).copied().unwrap_or_else(|| (from[1..].parse().expect("a number"), 0));
        let by = immediate(by) << if shift.is_empty() { 0 } else { 12 };
        pointers.insert(to, (array, byte + by));
    }
    let text = lines[lines.len() - 1].rsplit_once('[').expect("an address").1.trim_end_matches(']');
    let (base, offset) = text.split_once(' ').map_or((text, 0), |(base, offset)| (base, immediate(offset)));
    let (array, byte) = pointers.get(base).copied().unwrap_or_else(|| (base[1..].parse().expect("a number"), 0));
    (array - usize::from(FIRST_BASE), byte + offset)
}

#[test]
fn loads_and_stores_near_and_far() {
    for shape in ours() {
        let (width, letter) =
            (shape.width(), ["s", "d", "", "q"][shape.width().ilog2() as usize - 2 + usize::from(shape.width() == 16)]);
        for (k, target) in (0..).zip(REGISTERS.into_iter().cycle()).take(400) {
            let (memory, step) = (k % (MOST_ARRAYS - 1), [1, width, 8, 4, 257][k % 5]);
            let byte = (k * k * step * 3) % (BYTES - width);
            for is_load in [true, false] {
                let mut it = assembler(shape);
                if is_load {
                    it.load(target, Operand::Lanes(memory, byte))
                } else {
                    it.store(memory, byte, target)
                }
                let lines = body(&it);
                let (last, name) = (&lines[lines.len() - 1], if is_load { "ld" } else { "st" });
                let register = format!("{letter}{}", number(target));
                assert!(
                    last.starts_with(&format!("{name}r {register} "))
                        || last.starts_with(&format!("{name}ur {register} ")),
                    "{last}"
                );
                assert_eq!(accessed(&lines), (memory, byte), "{shape:?} {lines:?}");
                assert!(lines.len() <= 3 && it.tally.addresses == lines.len() - 1);
                assert!(lines.len() == 1 || byte > 255 && (!byte.is_multiple_of(width) || byte / width > 4095));
                // the same pointer serves again
                it.load(target, Operand::Lanes(memory, byte));
                assert_eq!(it.body.len(), lines.len() + 1);
            }
        }
    }
}

#[test]
fn parts_of_registers_end_where_rows_end() {
    for shape in ours().filter(|shape| !shape.is_scalar()) {
        for numbers in 1..shape.lanes() {
            let end = 4096 + numbers * shape.number();
            let mut it = Arm::new(shape, &[end]);
            it.store_part(0, 4096, 9, numbers);
            let lines = body(&it);
            let of = |letter: char| format!("str {letter}17 [x2 #0x1000]");
            match numbers * shape.number() {
                4 => assert_eq!(lines, [of('s')]),
                8 => assert_eq!(lines, [of('d')]),
                _ => {
                    assert_eq!(lines[0], of('d'));
                    assert_eq!(lines[lines.len() - 1], "st1 {v17.s}[2] [x16]");
                    assert_eq!(accessed(&lines[1..]), (0, 4096 + 8));
                }
            }
        }
    }
}

#[test]
#[should_panic(expected = "byte 16 of array 0")]
fn parts_of_registers_end_within_the_array() {
    Arm::new(Shape::FourF32, &[12]).store_part(0, 4, 0, 3);
}

#[test]
#[should_panic(expected = "byte 16 of array 0")]
fn nothing_beyond_an_array_is_written() {
    Arm::new(Shape::OneF64Neon, &[8]).store(0, 8, 0);
}

#[test]
fn a_frame_beyond_all_reach_is_told() {
    let mut it = Arm::new(Shape::TwoF64, &[64]);
    it.store(it.frame(), 1 << 25, 0);
    assert_eq!((it.frame_bytes(), it.body.len()), ((1 << 25) + 16, 0));
}

#[test]
fn a_function_keeps_what_is_its_callers() {
    for arrays in 1..MOST_ARRAYS {
        for (frame, repeats) in [0, 64, 5000, 40_000, 100_000].into_iter().flat_map(|f| [(f, false), (f, true)]) {
            for registers in [4, 24, 25, 26, 32] {
                let mut it = Arm::new(Shape::TwoF64, &vec![64; arrays]);
                if frame > 0 {
                    it.store(it.frame(), frame - 16, 1);
                }
                (0..registers).for_each(|register| it.load(register, Operand::Lanes(0, 0)));
                let steps: Vec<usize> = if repeats { (0..arrays).map(|k| 5000 * k).collect() } else { Vec::new() };
                let length = it.body.len();
                let lines = decoded(&it.finish(&steps).0);
                check_function(&lines, length, arrays, frame, registers.into(), &steps);
            }
        }
    }
}

fn check_function(lines: &[String], length: usize, arrays: usize, frame: usize, registers: usize, steps: &[usize]) {
    let number = |text: &str| usize::from_str_radix(text.trim_start_matches("#0x"), 16).expect("hexadecimal");
    let by = |parts: &[&str]| number(parts[3]) << if parts.len() > 4 { 12 } else { 0 };
    let parts: Vec<Vec<&str>> = lines.iter().map(|line| line.split(' ').collect()).collect();
    assert_eq!(lines[0], "hint #0x22"); // bti c
    assert_eq!(lines[lines.len() - 1], "ret");
    // the stack goes down and up by the same, and is touched on every page
    let moved = |name: &str| parts.iter().filter(|p| p[0] == name && p[1] == "sp").map(|p| by(p)).sum::<usize>();
    let is_on_stack = frame <= LARGEST_ON_STACK;
    let saved = registers.saturating_sub(24).div_ceil(2);
    let room = if is_on_stack { frame.next_multiple_of(16) } else { 0 } + 16 * saved;
    assert_eq!((moved("sub"), moved("add")), (room, room));
    assert!(parts.iter().all(|p| p[0] != "sub" || p[1] != "sp" || by(p) <= 4096));
    let touched = lines.iter().filter(|line| *line == "str xzr [sp]").count();
    assert_eq!(touched, if is_on_stack { frame.next_multiple_of(16) / 4096 } else { 0 });
    // v8 to v15 come back from where they went
    let pairs = |name: &str| lines.iter().filter_map(|l| l.strip_prefix(name).map(String::from)).collect::<Vec<_>>();
    let kept = pairs("stp ");
    assert_eq!(kept, pairs("ldp "));
    let expected = (0..saved).map(|k| match k {
        0 => "d8 d9 [sp]".to_string(),
        _ => format!("d{} d{} [sp #{:#x}]", 8 + 2 * k, 9 + 2 * k, 16 * k),
    });
    assert_eq!(kept, expected.collect::<Vec<_>>());
    // each array's address comes from its place, the frame's from the stack, both aligned to 16
    for memory in 0..arrays + usize::from(!is_on_stack) {
        let place = if memory == 0 { "[x0]".to_string() } else { format!("[x0 #{:#x}]", 8 * memory) };
        let load = format!("ldr x{} {place}", 2 + memory);
        assert_eq!(lines.iter().filter(|line| **line == load).count(), 1, "{load} in {lines:?}");
    }
    let frame_base = |line: &&String| {
        line.starts_with(&format!("mov x{} sp", 2 + arrays))
            || line.starts_with(&format!("add x{} sp #0x0", 2 + arrays))
    };
    assert_eq!(lines.iter().filter(frame_base).count(), usize::from(is_on_stack), "{lines:?}");
    // each address goes on by its step, and the code begins again behind the prologue
    let jump = lines.iter().position(|line| line.starts_with("b.ne"));
    assert_eq!(jump.is_some(), !steps.is_empty());
    let Some(jump) = jump else { return };
    assert_eq!(lines[jump - 1], "subs x1 x1 #0x1");
    for (memory, &step) in steps.iter().enumerate() {
        let base = format!("x{}", 2 + memory);
        let adds = parts.iter().filter(|p| p[0] == "add" && p[1] == base && p[2] == base);
        assert_eq!(adds.map(|p| by(p)).sum::<usize>(), step);
    }
    let back: i64 = {
        let text = parts[jump][1];
        let (minus, text) = text.split_once("-").map_or((1, text), |(_, rest)| (-1, rest));
        minus
            * i64::from_str_radix(text.trim_start_matches(['$', '#', '+']).trim_start_matches("0x"), 16)
                .expect("a number")
    };
    let begin = (jump as i64 + back / 4) as usize;
    assert!(parts[begin - 1][0] == "ldr" || frame_base(&&lines[begin - 1]), "{} before the loop", lines[begin - 1]);
    assert!(jump - begin >= length);
}
