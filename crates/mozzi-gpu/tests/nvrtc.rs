//! Kernels through NVRTC, which needs no GPU; and what calls report without a GPU.
#![allow(missing_docs)]

use crate::common;

use common::{LAYOUTS, PRECISIONS, embedded, form, nvrtc, quantities, robots};
use mozzi::quantities::{ForwardDynamics, InverseDynamics, MassMatrix, Query};
use mozzi_engine::{CudaLayout, Precision};
use mozzi_gpu::{Arch, Device, Error, Nvrtc, Source};
use std::sync::Arc;

#[test]
fn arms_keep_their_numbers_in_registers() {
    let Some(nvrtc) = nvrtc() else { return };
    let ur5 = embedded("ur5");
    let panda = embedded("panda").with_locked_joints(&[("panda_finger_joint1", 0.0)]).expect("it has fingers");
    for model in [ur5, panda] {
        for layout in LAYOUTS {
            for query in [Query::from(InverseDynamics), ForwardDynamics.into(), MassMatrix.into()] {
                let source = Source::new(&model, query, form(Precision::F32, layout)).expect("a text");
                let found = source.compile(&nvrtc, Arch::SM_90).expect("a binary").resources().expect("counts");
                let what = format!("{} {layout:?}: {found:?}", source.entry());
                assert!((20..=80).contains(&found.registers), "{what}");
                assert_eq!((found.spill_stores, found.spill_loads, found.stack_bytes), (0, 0, 0), "{what}");
                assert_eq!(found.shared_bytes > 0, layout == CudaLayout::Rows, "{what}");
                assert!(found.shared_bytes <= 48 * 1024, "{what}");
            }
        }
    }
}

#[test]
fn every_kernel_compiles() {
    let Some(nvrtc) = nvrtc() else { return };
    for model in robots() {
        for query in quantities() {
            for (precision, layout) in PRECISIONS.into_iter().zip(LAYOUTS) {
                let source = Source::new(&model, query, form(precision, layout)).expect("a text");
                let binary = source.compile(&nvrtc, "sm_80".parse().expect("valid")).expect("a binary");
                assert!(binary.code().starts_with(b"\x7fELF") && binary.resources().is_some());
                assert!(String::from_utf8_lossy(binary.code()).contains(source.entry()));
            }
        }
    }
}

#[test]
fn equal_texts_are_compiled_once() {
    let Some(nvrtc) = nvrtc() else { return };
    let source =
        || Source::new(&embedded("ur5"), MassMatrix, form(Precision::F32, CudaLayout::Columns)).expect("a text");
    let [first, second] = [0, 1].map(|_| source().compile(&nvrtc, Arch::SM_90).expect("a binary"));
    assert!(Arc::ptr_eq(&first, &second));
    let other = source().compile(&nvrtc, "sm_80".parse().expect("valid")).expect("a binary");
    assert!(!Arc::ptr_eq(&first, &other) && other.arch() != first.arch());
}

#[test]
fn an_unknown_architecture_is_named() {
    let Some(nvrtc) = nvrtc() else { return };
    let source = Source::new(&embedded("ur5"), MassMatrix, form(Precision::F32, CudaLayout::Rows)).expect("a text");
    let error = source.compile(&nvrtc, "sm_11".parse().expect("the form of one")).expect_err("too old");
    assert!(matches!(error, Error::Compile { .. }));
    let text = error.to_string();
    assert!(text.contains("ur5_mass_matrix_rows") && text.contains("sm_11"), "{text}");
}

#[test]
fn without_a_gpu_calls_name_what_is_missing() {
    match Device::first() {
        Ok(device) => assert!(Device::count().is_ok_and(|count| count > 0) && !device.name().is_empty()),
        Err(error) => {
            let text = error.to_string();
            assert!(matches!(error, Error::NoDriver { .. } | Error::NoDevice { .. }), "{text}");
            assert!(text.starts_with("no CUDA device: "), "{text}");
            if let Error::NoDriver { searched } = error {
                assert!(searched.contains(&"libcuda.so.1".to_string()) && text.contains("libcuda.so.1"));
            }
        }
    }
    let error = Nvrtc::open("no such file".as_ref()).expect_err("no file").to_string();
    assert!(error.contains("no such file is not NVRTC"), "{error}");
}
