//! Compares each form with a disassembler.

use super::*;
use crate::jit::shape::Machine;
use crate::jit::target::LARGEST_ON_STACK;
use iced_x86::Register as Named;
use iced_x86::{Code, Decoder, DecoderOptions, Instruction, Mnemonic, OpKind};

const BYTES: usize = 1 << 16;
/// Low, high, and with the fifth bit set.
const REGISTERS: [Register; 8] = [0, 3, 7, 8, 15, 16, 23, 31];

fn ours() -> impl Iterator<Item = Shape> {
    Shape::ALL.into_iter().filter(|shape| shape.machine() == Machine::X86_64)
}

fn decoded(bytes: &[u8]) -> Vec<Instruction> {
    Decoder::new(64, bytes, DecoderOptions::NONE).into_iter().collect()
}

fn base(memory: Memory) -> Named {
    use Named::*;
    [RAX, RCX, RDX, RSI, R8, R9, R10, R11, RDI, RBX, R13, R14, R15][memory]
}

fn registers(shape: Shape) -> impl Iterator<Item = Register> + Clone {
    REGISTERS.into_iter().filter(move |&register| usize::from(register) < shape.registers())
}

fn named(shape: Shape, register: Register) -> Named {
    let first = match shape.width() {
        64 => Named::ZMM0,
        32 => Named::YMM0,
        _ => Named::XMM0,
    };
    first + u32::from(register)
}

/// Places in memory near and far, within and beyond the reach of short displacements, in arrays with every base
/// register.
fn places(shape: Shape) -> impl Iterator<Item = (Memory, usize)> {
    let width = shape.width();
    (0..MOST_ARRAYS - 1).map(move |memory| {
        (memory, [0, width, 127 * width, 128 * width, 127, 128, 129, 8, 4, 3 * width, 1000, 4096, 60_000][memory % 13])
    })
}

fn assembler(shape: Shape) -> X86 {
    X86::new(shape, &[BYTES; MOST_ARRAYS - 1])
}

/// One instruction, decoded, with the mnemonic that is expected.
fn check(shape: Shape, mnemonic: &str, write: impl FnOnce(&mut X86)) -> Instruction {
    let mut assembler = assembler(shape);
    write(&mut assembler);
    let found = decoded(&assembler.body);
    let [instruction] = found[..] else { panic!("{mnemonic} {shape:?}: {} instructions", found.len()) };
    let name = format!("{:?}", instruction.mnemonic()).to_lowercase();
    assert_eq!(name, mnemonic, "{shape:?}, bytes {:02x?}", assembler.body);
    assert_ne!(instruction.code(), Code::INVALID);
    instruction
}

fn check_memory(shape: Shape, found: &Instruction, operand: u32, (memory, byte): (Memory, usize), repeated: bool) {
    assert_eq!(found.op_kind(operand), OpKind::Memory, "{found:?}");
    assert_eq!((found.memory_base(), found.memory_index()), (base(memory), Named::None), "{found:?}");
    assert_eq!(found.memory_displacement64(), byte as u64, "{shape:?} {found:?}");
    assert_eq!(found.is_broadcast(), repeated, "{found:?}");
    let size = if repeated { shape.number() } else { shape.width() };
    assert_eq!(found.memory_size().size(), size, "{found:?}");
}

/// Where the last operand can be.
fn last_operands(shape: Shape, takes_memory: bool) -> Vec<Operand> {
    let mut operands: Vec<_> = registers(shape).map(Operand::Register).collect();
    if takes_memory {
        operands.extend(places(shape).map(|(memory, byte)| Operand::Lanes(memory, byte)));
    }
    if takes_memory && shape.repeats() {
        operands.extend(places(shape).map(|(memory, byte)| Operand::Repeated(memory, byte)));
    }
    operands
}

fn check_last(shape: Shape, found: &Instruction, operand: u32, last: Operand) {
    match last {
        Operand::Register(register) => assert_eq!(found.op_register(operand), named(shape, register)),
        Operand::Lanes(memory, byte) => check_memory(shape, found, operand, (memory, byte), false),
        Operand::Repeated(memory, byte) => check_memory(shape, found, operand, (memory, byte), true),
    }
}

fn suffix(shape: Shape) -> &'static str {
    match (shape.is_scalar(), shape.is_f64()) {
        (true, true) => "sd",
        (true, false) => "ss",
        (false, true) => "pd",
        (false, false) => "ps",
    }
}

#[test]
fn operations_on_two_numbers() {
    for shape in ours() {
        let (letter, evex) = (if shape.is_f64() { "q" } else { "d" }, shape.encoding() == Encoding::Evex);
        let numbers = |name: &str| format!("v{name}{}", suffix(shape));
        let table = [
            (Operation::Add, numbers("add")),
            (Operation::Sub, numbers("sub")),
            (Operation::Mul, numbers("mul")),
            (Operation::Div, numbers("div")),
            (Operation::Min, numbers("min")),
            (Operation::Max, numbers("max")),
            (Operation::And, if evex { format!("vpand{letter}") } else { "vpand".to_string() }),
            (Operation::Xor, if evex { format!("vpxor{letter}") } else { "vpxor".to_string() }),
            (Operation::SubBits, format!("vpsub{letter}")),
        ];
        for (operation, mnemonic) in table {
            let takes_memory = assembler(shape).takes_memory(operation);
            for last in last_operands(shape, takes_memory) {
                for (target, a) in registers(shape).zip(registers(shape).cycle().skip(3)) {
                    let found = check(shape, &mnemonic, |assembler| assembler.apply(operation, target, a, last));
                    assert_eq!(found.op_register(0), named(shape, target));
                    assert_eq!(found.op_register(1), named(shape, a));
                    check_last(shape, &found, 2, last);
                }
            }
        }
    }
}

#[test]
fn operations_on_one_number() {
    for shape in ours() {
        for (target, from) in registers(shape).zip(registers(shape).cycle().skip(3)) {
            let (to, register) = (named(shape, target), Operand::Register(from));
            let root =
                check(shape, &format!("vsqrt{}", suffix(shape)), |a| a.apply(Operation::Sqrt, target, from, register));
            assert_eq!(root.op_register(0), to);
            (1..root.op_count()).for_each(|k| assert_eq!(root.op_register(k), named(shape, from)));
            let shift = if shape.is_f64() { "vpsllq" } else { "vpslld" };
            let shift = check(shape, shift, |a| a.apply(Operation::ShiftLeft(29), target, from, register));
            assert_eq!((shift.op_register(0), shift.op_register(1)), (to, named(shape, from)));
            assert_eq!((shift.op_count(), shift.immediate8()), (3, 29));
        }
    }
}

#[test]
fn moves_between_lanes() {
    for shape in ours().filter(|shape| !shape.is_scalar()) {
        let evex = shape.encoding() == Encoding::Evex;
        let pick = match (evex, shape.is_f64()) {
            (false, _) => "vperm2f128",
            (true, true) => "vshuff64x2",
            (true, false) => "vshuff32x4",
        };
        let table = [
            (Operation::Interleave(Half::Lower, Grain::Bits64), "vunpcklpd", None),
            (Operation::Interleave(Half::Upper, Grain::Bits64), "vunpckhpd", None),
            (Operation::Interleave(Half::Lower, Grain::Bits32), "vunpcklps", None),
            (Operation::Interleave(Half::Upper, Grain::Bits32), "vunpckhps", None),
            (Operation::Pick(0xdd), pick, Some(0xdd)),
        ];
        for (operation, mnemonic, immediate) in table {
            if operation == Operation::Interleave(Half::Lower, Grain::Bits32) && shape.is_f64() {
                break; // halves of numbers
            }
            let takes_memory = assembler(shape).takes_memory(operation);
            for last in last_operands(shape, takes_memory) {
                for (target, a) in registers(shape).zip(registers(shape).cycle().skip(3)) {
                    let found = check(shape, mnemonic, |assembler| assembler.apply(operation, target, a, last));
                    assert_eq!(found.op_register(0), named(shape, target));
                    assert_eq!(found.op_register(1), named(shape, a));
                    check_last(shape, &found, 2, last);
                    if let Some(immediate) = immediate {
                        assert_eq!((found.op_count(), found.immediate8()), (4, immediate));
                    }
                }
            }
        }
    }
}

#[test]
fn parts_of_registers_are_stored_under_masks() {
    for shape in ours().filter(|shape| shape.repeats()) {
        let moves = format!("vmovu{}", suffix(shape));
        for (from, place) in registers(shape).cycle().zip(places(shape)) {
            for numbers in 1..shape.lanes() {
                let store = check(shape, &moves, |a| a.store_part(place.0, place.1, from, numbers));
                assert_eq!((store.op_register(1), store.op_mask()), (named(shape, from), Named::K1));
                assert!(!store.zeroing_masking());
                check_memory(shape, &store, 0, place, false);
            }
        }
        // up to the array's end and no further; the masks are set at the beginning
        let mut assembler = X86::new(shape, &[3 * shape.number()]);
        assembler.store_part(0, 0, 1, 3);
        assembler.store_part(0, 0, 1, 2);
        assembler.store_part(0, shape.number(), 1, 2);
        let found = decoded(&assembler.finish(&[]).0);
        let values = found.iter().filter(|x| x.mnemonic() == Mnemonic::Mov && x.op1_kind() == OpKind::Immediate32);
        assert_eq!(
            values.map(|x| (x.op0_register(), x.immediate32())).collect::<Vec<_>>(),
            [(Named::EAX, 7), (Named::EAX, 3)]
        );
        let masks = found.iter().filter(|x| x.mnemonic() == Mnemonic::Kmovw);
        let masks: Vec<_> = masks.map(|x| (x.op0_register(), x.op1_register())).collect();
        assert_eq!(masks, [(Named::K1, Named::EAX), (Named::K2, Named::EAX)]);
    }
}

#[test]
#[should_panic(expected = "byte 16 of array 0")]
fn masks_end_within_the_array() {
    X86::new(Shape::EightF64, &[32]).store_part(0, 16, 0, 3);
}

#[test]
fn fused_products() {
    let operations = [
        (Operation::MulAdd, "vfmadd"),
        (Operation::MulSub, "vfmsub"),
        (Operation::NegMulAdd, "vfnmadd"),
        (Operation::NegMulSub, "vfnmsub"),
    ];
    type Write = fn(&mut X86, Operation, Register, Register, Operand);
    let orders: [(&str, Write); 3] = [("231", X86::fused_231), ("213", X86::fused_213), ("132", X86::fused_132)];
    for shape in ours() {
        for ((operation, name), (order, write)) in operations.into_iter().flat_map(|o| orders.map(|w| (o, w))) {
            for last in last_operands(shape, true) {
                for (target, a) in registers(shape).zip(registers(shape).cycle().skip(3)) {
                    let mnemonic = format!("{name}{order}{}", suffix(shape));
                    let found = check(shape, &mnemonic, |assembler| write(assembler, operation, target, a, last));
                    assert_eq!(found.op_register(0), named(shape, target));
                    assert_eq!(found.op_register(1), named(shape, a));
                    check_last(shape, &found, 2, last);
                }
            }
        }
    }
}

#[test]
fn loads_and_stores() {
    for shape in ours() {
        let moves =
            if shape.is_scalar() { format!("vmov{}", suffix(shape)) } else { format!("vmovu{}", suffix(shape)) };
        let copies = if shape.is_f64() { "vmovapd" } else { "vmovaps" };
        for (target, place) in registers(shape).cycle().zip(places(shape)) {
            let (memory, byte) = place;
            let load = check(shape, &moves, |a| a.load(target, Operand::Lanes(memory, byte)));
            assert_eq!(load.op_register(0), named(shape, target));
            check_memory(shape, &load, 1, place, false);
            let store = check(shape, &moves, |a| a.store(memory, byte, target));
            assert_eq!(store.op_register(1), named(shape, target));
            check_memory(shape, &store, 0, place, false);
            if !shape.is_scalar() {
                let mnemonic = if shape.is_f64() { "vbroadcastsd" } else { "vbroadcastss" };
                let load = check(shape, mnemonic, |a| a.load(target, Operand::Repeated(memory, byte)));
                assert_eq!(load.op_register(0), named(shape, target));
                assert_eq!((load.memory_base(), load.memory_displacement64()), (base(memory), byte as u64));
                assert_eq!(load.memory_size().size(), shape.number());
            }
            let from = (target + 5) % shape.registers() as u8;
            let copy = check(shape, copies, |a| a.load(target, Operand::Register(from)));
            assert_eq!((copy.op_register(0), copy.op_register(1)), (named(shape, target), named(shape, from)));
        }
    }
}

#[test]
fn a_function_keeps_what_is_its_callers() {
    for arrays in 1..MOST_ARRAYS {
        for (frame, repeats) in
            [0, 64, 5000, 40_000, 100_000].into_iter().flat_map(|frame| [(frame, false), (frame, true)])
        {
            let mut assembler = X86::new(Shape::EightF64, &vec![64; arrays]);
            let (own, mut expected) = (assembler.frame(), Vec::new());
            if frame > 0 {
                assembler.store(own, frame - 64, 1);
            }
            (0..arrays).for_each(|memory| assembler.load(2, Operand::Lanes(memory, 0)));
            let steps: Vec<usize> = if repeats { (0..arrays).map(|k| 64 * k).collect() } else { Vec::new() };
            let (code, _) = assembler.finish(&steps);
            let found = decoded(&code);
            // pushed registers are popped in reverse order, and each array's address is loaded from its place
            let of = |mnemonic| found.iter().filter(move |x| x.mnemonic() == mnemonic).map(|x| x.op0_register());
            let (pushed, mut popped): (Vec<_>, Vec<_>) = (of(Mnemonic::Push).collect(), of(Mnemonic::Pop).collect());
            popped.reverse();
            assert_eq!(pushed, popped);
            assert_eq!(pushed[0], Named::RBP);
            for memory in 0..=own {
                if (9..).contains(&memory) {
                    expected.push(base(memory));
                }
            }
            expected.extend(repeats.then_some(Named::R12));
            assert_eq!(pushed[1..], expected);
            // each array's address goes on by its step, and the code begins again behind the prologue
            let adds: Vec<_> = found.iter().filter(|x| x.mnemonic() == Mnemonic::Add).collect();
            let steps = steps.iter().enumerate().filter(|(_, step)| **step > 0);
            assert!(
                adds.iter()
                    .map(|x| (x.op0_register(), x.immediate32to64()))
                    .eq(steps.map(|(k, &step)| (base(k), step as i64)))
            );
            let jumps: Vec<_> = found.iter().filter(|x| x.mnemonic() == Mnemonic::Jne).collect();
            assert_eq!(jumps.len(), usize::from(repeats));
            if let [jump] = jumps[..] {
                let is_before = |x: &Instruction| {
                    x.mnemonic() == Mnemonic::And || x.mnemonic() == Mnemonic::Mov && x.memory_base() == Named::RDI
                };
                let last = found.iter().rposition(is_before).expect("addresses");
                assert_eq!(jump.near_branch_target(), found[last].next_ip());
                let before = |k: usize| &found[found.iter().position(|x| x == jump).expect("found") - k];
                assert_eq!((before(1).mnemonic(), before(1).op0_register()), (Mnemonic::Dec, Named::R12));
                let counter = found.iter().find(|x| x.mnemonic() == Mnemonic::Mov && x.op0_register() == Named::R12);
                assert_eq!(counter.map(|x| x.op1_register()), Some(Named::RSI));
            }
            let loads: Vec<_> =
                found.iter().filter(|x| x.mnemonic() == Mnemonic::Mov && x.memory_base() == Named::RDI).collect();
            let is_on_stack = frame <= LARGEST_ON_STACK;
            let given_addresses = arrays + usize::from(!is_on_stack);
            assert_eq!(loads.len(), given_addresses);
            for memory in 0..given_addresses {
                let at = |x: &&&Instruction| {
                    x.memory_displacement64() == 8 * memory as u64 && x.op0_register() == base(memory)
                };
                assert_eq!(loads.iter().filter(at).count(), 1, "array {memory}");
            }
            assert!(loads[..loads.len() - 1].iter().all(|x| x.op0_register() != Named::RDI), "rdi last");
            // the frame lies within the allocated stack, whatever its alignment was
            let given: u64 = found
                .iter()
                .filter(|x| x.mnemonic() == Mnemonic::Sub && x.op0_register() == Named::RSP)
                .map(|x| u64::from(x.immediate32()))
                .sum();
            let mut lea = found.iter().filter(|x| x.mnemonic() == Mnemonic::Lea);
            if is_on_stack {
                assert!(given >= frame as u64 + 63, "{given} bytes for {frame}");
                let lea = lea.next().expect("the frame's address");
                assert_eq!(
                    (lea.op0_register(), lea.memory_base(), lea.memory_displacement64()),
                    (base(own), Named::RSP, 63)
                );
                let and = found.iter().find(|x| x.mnemonic() == Mnemonic::And).expect("an alignment");
                assert_eq!((and.op0_register(), and.immediate8to64()), (base(own), -64));
            }
            let back = lea.next().expect("the saved registers' address");
            assert_eq!((back.op0_register(), back.memory_base()), (Named::RSP, Named::RBP));
            assert_eq!(back.memory_displacement64() as i64, -8 * expected.len() as i64);
            let end: Vec<_> = found.iter().rev().take(3).map(|x| x.mnemonic()).collect();
            assert_eq!(end, [Mnemonic::Ret, Mnemonic::Vzeroupper, Mnemonic::Pop]);
        }
    }
}

#[test]
#[should_panic(expected = "byte 8 of array 0")]
fn nothing_beyond_an_array_is_written() {
    X86::new(Shape::OneF64, &[8]).store(0, 8, 0);
}

#[test]
#[should_panic(expected = "no such register")]
fn avx2_has_sixteen_registers() {
    X86::new(Shape::OneF64, &[8]).load(16, Operand::Lanes(0, 0));
}
