//! The instructions of both instruction sets.

use iced_x86::Code;

use super::super::instruction_set::InstructionSet;
use super::super::tape::{Binary, Fused};

/// The operand of a fused multiply-add that is overwritten.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// d ← d · third ± second
    ByThird,
    /// d ← second · d ± third
    BySecond,
    /// d ← second · third ± d
    Sum,
}

/// An instruction with two operands; a comparison also has its predicate.
pub(super) fn binary(set: InstructionSet, operation: Binary) -> (Code, Option<u32>) {
    let wide = set == InstructionSet::Avx512;
    let pick = |avx512, avx2| (if wide { avx512 } else { avx2 }, None);
    let compare = |predicate| {
        let code = if wide {
            Code::EVEX_Vcmppd_kr_k1_zmm_zmmm512b64_imm8_sae
        } else {
            Code::VEX_Vcmppd_ymm_ymm_ymmm256_imm8
        };
        (code, Some(predicate))
    };
    match operation {
        Binary::Add => pick(Code::EVEX_Vaddpd_zmm_k1z_zmm_zmmm512b64_er, Code::VEX_Vaddpd_ymm_ymm_ymmm256),
        Binary::Subtract => {
            pick(Code::EVEX_Vsubpd_zmm_k1z_zmm_zmmm512b64_er, Code::VEX_Vsubpd_ymm_ymm_ymmm256)
        }
        Binary::Multiply => {
            pick(Code::EVEX_Vmulpd_zmm_k1z_zmm_zmmm512b64_er, Code::VEX_Vmulpd_ymm_ymm_ymmm256)
        }
        Binary::Divide => pick(Code::EVEX_Vdivpd_zmm_k1z_zmm_zmmm512b64_er, Code::VEX_Vdivpd_ymm_ymm_ymmm256),
        Binary::Lesser => {
            pick(Code::EVEX_Vminpd_zmm_k1z_zmm_zmmm512b64_sae, Code::VEX_Vminpd_ymm_ymm_ymmm256)
        }
        Binary::Greater => {
            pick(Code::EVEX_Vmaxpd_zmm_k1z_zmm_zmmm512b64_sae, Code::VEX_Vmaxpd_ymm_ymm_ymmm256)
        }
        Binary::And => pick(Code::EVEX_Vpandq_zmm_k1z_zmm_zmmm512b64, Code::VEX_Vandpd_ymm_ymm_ymmm256),
        Binary::Or => pick(Code::EVEX_Vporq_zmm_k1z_zmm_zmmm512b64, Code::VEX_Vorpd_ymm_ymm_ymmm256),
        Binary::Xor => pick(Code::EVEX_Vpxorq_zmm_k1z_zmm_zmmm512b64, Code::VEX_Vxorpd_ymm_ymm_ymmm256),
        Binary::IntegerAdd => {
            pick(Code::EVEX_Vpaddq_zmm_k1z_zmm_zmmm512b64, Code::VEX_Vpaddq_ymm_ymm_ymmm256)
        }
        Binary::IntegerSubtract => {
            pick(Code::EVEX_Vpsubq_zmm_k1z_zmm_zmmm512b64, Code::VEX_Vpsubq_ymm_ymm_ymmm256)
        }
        // Comparisons that raise no exceptions: LT_OQ, LE_OQ, UNORD_Q.
        Binary::Less => compare(0x11),
        Binary::LessOrEqual => compare(0x12),
        Binary::Unordered => compare(0x03),
    }
}

/// Whether the operands a and b may be exchanged.
pub(super) fn commutes(operation: Binary) -> bool {
    matches!(
        operation,
        Binary::Add
            | Binary::Multiply
            | Binary::And
            | Binary::Or
            | Binary::Xor
            | Binary::IntegerAdd
            | Binary::Unordered
    )
}

pub(super) fn fused(set: InstructionSet, operation: Fused, form: Form) -> Code {
    match set {
        InstructionSet::Avx512 => match (operation, form) {
            (Fused::MultiplyAdd, Form::ByThird) => Code::EVEX_Vfmadd132pd_zmm_k1z_zmm_zmmm512b64_er,
            (Fused::MultiplyAdd, Form::BySecond) => Code::EVEX_Vfmadd213pd_zmm_k1z_zmm_zmmm512b64_er,
            (Fused::MultiplyAdd, Form::Sum) => Code::EVEX_Vfmadd231pd_zmm_k1z_zmm_zmmm512b64_er,
            (Fused::MultiplySubtract, Form::ByThird) => Code::EVEX_Vfmsub132pd_zmm_k1z_zmm_zmmm512b64_er,
            (Fused::MultiplySubtract, Form::BySecond) => Code::EVEX_Vfmsub213pd_zmm_k1z_zmm_zmmm512b64_er,
            (Fused::MultiplySubtract, Form::Sum) => Code::EVEX_Vfmsub231pd_zmm_k1z_zmm_zmmm512b64_er,
            (Fused::NegateMultiplyAdd, Form::ByThird) => Code::EVEX_Vfnmadd132pd_zmm_k1z_zmm_zmmm512b64_er,
            (Fused::NegateMultiplyAdd, Form::BySecond) => Code::EVEX_Vfnmadd213pd_zmm_k1z_zmm_zmmm512b64_er,
            (Fused::NegateMultiplyAdd, Form::Sum) => Code::EVEX_Vfnmadd231pd_zmm_k1z_zmm_zmmm512b64_er,
            (Fused::NegateMultiplySubtract, Form::ByThird) => {
                Code::EVEX_Vfnmsub132pd_zmm_k1z_zmm_zmmm512b64_er
            }
            (Fused::NegateMultiplySubtract, Form::BySecond) => {
                Code::EVEX_Vfnmsub213pd_zmm_k1z_zmm_zmmm512b64_er
            }
            (Fused::NegateMultiplySubtract, Form::Sum) => Code::EVEX_Vfnmsub231pd_zmm_k1z_zmm_zmmm512b64_er,
        },
        _ => match (operation, form) {
            (Fused::MultiplyAdd, Form::ByThird) => Code::VEX_Vfmadd132pd_ymm_ymm_ymmm256,
            (Fused::MultiplyAdd, Form::BySecond) => Code::VEX_Vfmadd213pd_ymm_ymm_ymmm256,
            (Fused::MultiplyAdd, Form::Sum) => Code::VEX_Vfmadd231pd_ymm_ymm_ymmm256,
            (Fused::MultiplySubtract, Form::ByThird) => Code::VEX_Vfmsub132pd_ymm_ymm_ymmm256,
            (Fused::MultiplySubtract, Form::BySecond) => Code::VEX_Vfmsub213pd_ymm_ymm_ymmm256,
            (Fused::MultiplySubtract, Form::Sum) => Code::VEX_Vfmsub231pd_ymm_ymm_ymmm256,
            (Fused::NegateMultiplyAdd, Form::ByThird) => Code::VEX_Vfnmadd132pd_ymm_ymm_ymmm256,
            (Fused::NegateMultiplyAdd, Form::BySecond) => Code::VEX_Vfnmadd213pd_ymm_ymm_ymmm256,
            (Fused::NegateMultiplyAdd, Form::Sum) => Code::VEX_Vfnmadd231pd_ymm_ymm_ymmm256,
            (Fused::NegateMultiplySubtract, Form::ByThird) => Code::VEX_Vfnmsub132pd_ymm_ymm_ymmm256,
            (Fused::NegateMultiplySubtract, Form::BySecond) => Code::VEX_Vfnmsub213pd_ymm_ymm_ymmm256,
            (Fused::NegateMultiplySubtract, Form::Sum) => Code::VEX_Vfnmsub231pd_ymm_ymm_ymmm256,
        },
    }
}
