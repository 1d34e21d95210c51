//! A compiled function and its call: the only place of the program with `unsafe` code.
//!
//! In: a function in Cranelift's intermediate form. Out: its call on slices. Never here: what it computes.
//!
//! Three things cannot be checked by the compiler of this source, and hold for these reasons:
//! - The code has the signature of [`Entry`]: [`signature`] writes it, in the calling convention of the platform, which
//!   is that of `extern "C"`.
//! - It reads and writes only inside the four stretches of memory that it is given. The emitter takes every address from
//!   a layout, and each call compares the lengths of the slices with those of that layout. What is read is numbers, for
//!   which every pattern of bits is valid; the only addresses that are read from memory are rows of a matrix, written
//!   by [`CompiledGrowth`](super::CompiledGrowth) before each call as a permutation of its rows.
//! - The code stays in memory as long as it may be called: it is freed when the function is dropped, which nobody can
//!   call then, since a call borrows it.
#![allow(unsafe_code, reason = "generated code is called and freed")]

use std::sync::{Mutex, PoisonError};

use cranelift_codegen::Context;
use cranelift_codegen::ir::{AbiParam, Function, Signature, UserFuncName, types};
use cranelift_codegen::isa::OwnedTargetIsa;
use cranelift_codegen::settings::{self, Configurable};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{Linkage, Module};

use super::layout::{Area, Layout};

/// The values, the work, the series, the state, and the unit of time.
type Entry = unsafe extern "C" fn(*const f64, *mut f64, *mut f64, *mut f64, f64);

/// A function in memory.
pub(super) struct CompiledFunction {
    entry: Entry,
    layout: Layout,
    module: Mutex<Option<JITModule>>,
}

/// Why no function was compiled.
#[derive(Debug)]
pub(super) struct NotCompiled;

/// A module for this machine, if it is one for which code can be generated.
pub(super) fn module() -> Result<JITModule, NotCompiled> {
    let mut flags = settings::builder();
    let wanted = [
        ("use_colocated_libcalls", "false"),
        ("is_pic", "false"),
        ("opt_level", "none"),
        ("enable_verifier", if cfg!(debug_assertions) { "true" } else { "false" }),
    ];
    for (name, value) in wanted {
        flags.set(name, value).map_err(|_| NotCompiled)?;
    }
    let target = cranelift_native::builder().map_err(|_| NotCompiled)?;
    let isa: OwnedTargetIsa =
        target.finish(settings::Flags::new(flags)).map_err(|_| NotCompiled)?;
    if isa.pointer_type() != types::I64 {
        return Err(NotCompiled);
    }
    let libcalls = cranelift_module::default_libcall_names();
    Ok(JITModule::new(JITBuilder::with_isa(isa, libcalls)))
}

/// The signature of [`Entry`].
pub(super) fn signature(module: &JITModule) -> Signature {
    let mut signature = module.make_signature();
    signature.params.extend([AbiParam::new(types::I64); 4]);
    signature.params.push(AbiParam::new(types::F64));
    signature
}

impl CompiledFunction {
    /// Compiles a function with that signature, whose addresses are those of a layout.
    pub(super) fn of(
        mut module: JITModule,
        mut function: Function,
        layout: Layout,
    ) -> Result<CompiledFunction, NotCompiled> {
        let failed = |_| NotCompiled;
        let id = module
            .declare_function("orders", Linkage::Local, &function.signature)
            .map_err(failed)?;
        function.name = UserFuncName::user(0, id.as_u32());
        let mut context = Context::for_function(function);
        module.define_function(id, &mut context).map_err(failed)?;
        module.finalize_definitions().map_err(failed)?;
        let code = module.get_finalized_function(id);
        // SAFETY: the code has this signature
        let entry = unsafe { std::mem::transmute::<*const u8, Entry>(code) };
        Ok(CompiledFunction { entry, layout, module: Mutex::new(Some(module)) })
    }

    /// Where its numbers lie.
    pub(super) fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Calls it.
    ///
    /// # Panics
    /// If a stretch of memory has another length than that of the layout.
    pub(super) fn call(
        &self,
        values: &[f64],
        work: &mut [f64],
        series: &mut [f64],
        state: &mut [f64],
        scale: f64,
    ) {
        let lengths = [values.len(), work.len(), series.len(), state.len()];
        let areas = [Area::Values, Area::Work, Area::Series, Area::State];
        assert_eq!(lengths, areas.map(|area| self.layout.length(area)));
        // SAFETY: the code stays within these lengths
        unsafe {
            (self.entry)(
                values.as_ptr(),
                work.as_mut_ptr(),
                series.as_mut_ptr(),
                state.as_mut_ptr(),
                scale,
            );
        }
    }
}

impl Drop for CompiledFunction {
    fn drop(&mut self) {
        let module = self.module.get_mut().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(module) = module {
            // SAFETY: nobody else has the entry, and nobody calls it
            unsafe { module.free_memory() };
        }
    }
}

impl std::fmt::Debug for CompiledFunction {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CompiledFunction").field("layout", &self.layout).finish_non_exhaustive()
    }
}
