//! Kernels run with the widest instructions of the processor.
//!
//! In: a kernel, whose loops the compiler turns into vector instructions. Out: its result, which has
//! the same bits whatever the instructions: sums are added up in the order that the kernel fixes,
//! and a fused multiply-add is used only for what it gives exactly, the rounding error of a product.

/// A computation that gains from vector instructions.
pub trait Kernel {
    /// Its result.
    type Output;
    /// Whether its numbers are those of several orbits side by side, which fill the widest vectors.
    const OF_SEVERAL: bool = false;
    /// Computes it. `FUSED` says whether a fused multiply-add is one instruction. Must be inlined
    /// into its caller to have the instructions.
    fn run<const FUSED: bool>(self) -> Self::Output;
}

/// Runs a kernel with AVX2 and FMA where the processor has them, one of several orbits with AVX-512 where it has that, and
/// with the instructions that the program was built for elsewhere.
#[inline]
pub fn vectorized<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    {
        use std::sync::LazyLock;

        use pulp::x86::V4;
        static WIDEST: LazyLock<Option<V4>> = LazyLock::new(V4::try_new);
        struct Call<K>(K);
        impl<K: Kernel> pulp::NullaryFnOnce for Call<K> {
            type Output = K::Output;
            #[inline(always)]
            fn call(self) -> K::Output {
                self.0.run::<true>()
            }
        }
        if K::OF_SEVERAL
            && let Some(widest) = *WIDEST
        {
            return widest.vectorize(Call(kernel));
        }
        if let Some(wide) = wide() {
            return wide.vectorize(Call(kernel));
        }
    }
    run_plainly(kernel)
}

/// AVX2 and FMA, where the processor has them.
#[cfg(target_arch = "x86_64")]
#[inline]
pub(super) fn wide() -> Option<pulp::x86::V3> {
    use std::sync::LazyLock;

    use pulp::x86::V3;
    static WIDE: LazyLock<Option<V3>> = LazyLock::new(V3::try_new);
    *WIDE
}

/// Whether a fused multiply-add is one of the instructions that the program was built for.
pub(super) const FUSED_PLAINLY: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));

/// Runs a kernel with the instructions that the program was built for.
#[inline]
pub(super) fn run_plainly<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<FUSED_PLAINLY>()
}
