//! What a card can do, from NVIDIA's data sheets.

use super::Count;
use mozzi_engine::Precision;

/// A card's figures.
pub struct Card {
    pub name: &'static str,
    /// Bytes of device memory per second.
    pub bandwidth: f64,
    /// Operations per second, two for a fused multiply-add.
    pub flops_f32: f64,
    pub flops_f64: f64,
}

/// "NVIDIA H100 Tensor Core GPU" and "NVIDIA H200 Tensor Core GPU", data sheets, columns SXM: FP32 67, FP64 34
/// teraFLOPS; 3.35 and 4.8 TB/s.
pub const CARDS: [Card; 2] = [
    Card { name: "H100 SXM", bandwidth: 3.35e12, flops_f32: 67e12, flops_f64: 34e12 },
    Card { name: "H200 SXM", bandwidth: 4.8e12, flops_f32: 67e12, flops_f64: 34e12 },
];

/// States per second that a kernel cannot exceed.
pub struct Bounds {
    /// Each number moved once at the full bandwidth.
    pub memory: f64,
    /// The arithmetic units always busy.
    pub arithmetic: f64,
    /// One instruction of a warp in each cycle of each scheduler; a multiprocessor's four schedulers issue as many
    /// threads as it has units for `f32` (128).
    pub issue: f64,
}

impl Bounds {
    pub fn of(card: &Card, count: &Count) -> Bounds {
        let threads_issued = card.flops_f32 / 2.0;
        let arithmetic = match count.form.precision {
            Precision::F32 => card.flops_f32 / 2.0,
            Precision::F64 => card.flops_f64 / 2.0,
        };
        Bounds {
            memory: card.bandwidth / count.bytes as f64,
            arithmetic: arithmetic / count.instructions.arithmetic() as f64,
            issue: threads_issued / count.instructions.all() as f64,
        }
    }

    /// The smallest, and its name.
    pub fn least(&self) -> (f64, &'static str) {
        let all = [(self.memory, "memory"), (self.arithmetic, "arithmetic"), (self.issue, "issue")];
        all.into_iter().fold((f64::INFINITY, ""), |least, one| if one.0 < least.0 { one } else { least })
    }
}
