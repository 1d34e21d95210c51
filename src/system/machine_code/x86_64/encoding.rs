//! Instructions of x86-64 as bytes.
//!
//! In: operations on vector registers and memory. Out: their bytes. Never here: which number lies in which register.
//!
//! Source: Intel 64 and IA-32 Architectures Software Developer's Manual, volume 2, 2.3 (the VEX prefix), 2.7 (the EVEX
//! prefix, which instructions on eight numbers have) and the pages of the instructions.

use super::basic_block::{Operation, Width};
use super::layout::{Address, Area};

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct VectorRegister(pub(super) u8);

/// What an instruction reads last.
#[derive(Clone, Copy, Debug)]
pub(super) enum Source {
    Register(VectorRegister),
    Memory(Place),
}

/// A place in memory: so many bytes behind where a general register points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    base: General,
    displacement: i32,
}

impl Place {
    /// So many `f64` behind where a register points.
    pub(super) fn behind(base: General, count: usize) -> Place {
        Place { base, displacement: 8 * count as i32 }
    }
}

impl From<Address> for Place {
    fn from(address: Address) -> Place {
        Place::behind(base(address.area), address.offset)
    }
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct General(u8);

impl General {
    /// Those that belong to nobody: rax, r10 and r11.
    pub(super) const RAX: General = General(0);
    pub(super) const R10: General = General(10);
    pub(super) const R11: General = General(11);
}

/// The opcode maps.
const MAP_0F: u8 = 1;
const MAP_0F38: u8 = 2;
const MAP_0F3A: u8 = 3;

/// The prefixes that choose between packed and scalar forms.
const PACKED_SINGLE: u8 = 0;
const PACKED: u8 = 1;
const SCALAR: u8 = 3;

/// The operand of an instruction with one source.
const NONE: VectorRegister = VectorRegister(0);

/// What comes before the bytes of the operands.
#[derive(Clone, Copy)]
struct Opcode {
    map: u8,
    prefix: u8,
    /// The bit W.
    wide: bool,
    width: Width,
    code: u8,
}

#[derive(Debug, Default)]
pub(super) struct Bytes(pub(super) Vec<u8>);

impl Bytes {
    /// `to = left ∘ right`.
    pub(super) fn binary(
        &mut self,
        operation: Operation,
        width: Width,
        to: VectorRegister,
        left: VectorRegister,
        right: Source,
    ) {
        let arithmetic = |code| match width {
            Width::One => (MAP_0F, SCALAR, code),
            Width::Two | Width::Four | Width::Eight => (MAP_0F, PACKED, code),
        };
        let (map, prefix, code) = match operation {
            Operation::Add => arithmetic(0x58),
            Operation::Multiply => arithmetic(0x59),
            Operation::Subtract => arithmetic(0x5C),
            Operation::Divide => arithmetic(0x5E),
            Operation::Root => arithmetic(0x51),
            Operation::Xor => (MAP_0F, PACKED, 0x57),
            Operation::Pair => match right {
                // vunpcklpd
                Source::Register(_) => (MAP_0F, PACKED, 0x14),
                // vmovhpd
                Source::Memory(_) => (MAP_0F, PACKED, 0x16),
            },
            // vinsertf128
            Operation::Join => (MAP_0F3A, PACKED, 0x18),
            // vunpckhpd
            Operation::Odd => (MAP_0F, PACKED, 0x15),
            // vperm2f128
            Operation::Upper => (MAP_0F3A, PACKED, 0x06),
        };
        let of_four = matches!(operation, Operation::Join | Operation::Upper);
        let width = if of_four { Width::Four } else { width };
        self.vex(Opcode { map, prefix, wide: false, width, code }, to, left, right);
        if of_four {
            // the upper half of what is made; of the first operand, the upper half
            self.0.push(1);
        }
    }

    /// `to = to · right − product` with one rounding.
    pub(super) fn product_error(
        &mut self,
        width: Width,
        to: VectorRegister,
        right: VectorRegister,
        product: VectorRegister,
    ) {
        // vfmsub213sd, vfmsub213pd
        let code = if width == Width::One { 0xAB } else { 0xAA };
        let opcode = Opcode { map: MAP_0F38, prefix: PACKED, wide: true, width, code };
        self.vex(opcode, to, right, Source::Register(product));
    }

    pub(super) fn copy(&mut self, width: Width, to: VectorRegister, from: VectorRegister) {
        // vmovapd
        let width = if width == Width::Eight { width } else { Width::Four };
        let opcode = Opcode { map: MAP_0F, prefix: PACKED, wide: false, width, code: 0x28 };
        self.vex(opcode, to, NONE, Source::Register(from));
    }

    pub(super) fn zero(&mut self, to: VectorRegister) {
        // vxorps, which clears what lies beyond as well
        let (prefix, width) = (PACKED_SINGLE, Width::Two);
        let opcode = Opcode { map: MAP_0F, prefix, wide: false, width, code: 0x57 };
        self.vex(opcode, to, to, Source::Register(to));
    }

    pub(super) fn load(&mut self, width: Width, to: VectorRegister, from: impl Into<Place>) {
        self.vex(moves(width, 0x10), to, NONE, Source::Memory(from.into()));
    }

    pub(super) fn store(&mut self, width: Width, from: VectorRegister, to: Address) {
        self.vex(moves(width, 0x11), from, NONE, Source::Memory(to.into()));
    }

    /// Loads the number so many bytes behind an address, both in the stretch of work.
    pub(super) fn load_behind(&mut self, to: VectorRegister, from: Address, offset: Address) {
        // mov rax, [offset]
        self.0.extend_from_slice(&[0x48, 0x8B]);
        self.memory(General::RAX.0, offset.into(), true);
        // vmovsd to, [from + rax]
        let opcode = moves(Width::One, 0x10);
        self.prefixes(opcode, to, NONE, false);
        let index = 4;
        self.0.push(0x80 | (to.0 & 7) << 3 | index);
        let from = Place::from(from);
        self.0.push(General::RAX.0 << 3 | from.base.0);
        self.0.extend_from_slice(&from.displacement.to_le_bytes());
    }

    /// Returns to the caller of the function.
    pub(super) fn end(&mut self) {
        // vzeroupper
        self.0.extend_from_slice(&[0xC5, 0xF8, 0x77]);
        self.back();
    }

    pub(super) fn back(&mut self) {
        // ret
        self.0.push(0xC3);
    }

    pub(super) fn point(&mut self, register: General, place: impl Into<Place>) {
        // lea
        let place = place.into();
        let (high, extended) = (u8::from(register.0 >= 8), u8::from(place.base.0 >= 8));
        self.0.extend_from_slice(&[0x48 | high << 2 | extended, 0x8D]);
        self.memory(register.0, place, true);
    }

    /// Points a register so many `f64` farther.
    pub(super) fn move_on(&mut self, register: General, count: usize) {
        // add, with an immediate operand
        self.0.extend_from_slice(&[0x48 | u8::from(register.0 >= 8), 0x81, 0xC0 | register.0 & 7]);
        self.0.extend_from_slice(&(8 * count as i32).to_le_bytes());
    }

    pub(super) fn count(&mut self, register: General, repetitions: u32) {
        // mov, of the lower half, which clears the upper one
        if register.0 >= 8 {
            self.0.push(0x41);
        }
        self.0.push(0xB8 | register.0 & 7);
        self.0.extend_from_slice(&repetitions.to_le_bytes());
    }

    /// Takes one from a register of at least one, and goes back to a place among the bytes unless it is zero then.
    pub(super) fn repeat(&mut self, register: General, from: usize) {
        // dec
        if register.0 >= 8 {
            self.0.push(0x41);
        }
        self.0.extend_from_slice(&[0xFF, 0xC8 | register.0 & 7]);
        // jnz
        self.0.extend_from_slice(&[0x0F, 0x85]);
        self.distance_to(from);
    }

    /// Calls what will begin elsewhere, and returns the call, which [`Bytes::begins`] completes.
    pub(super) fn call(&mut self) -> Call {
        // call
        self.0.push(0xE8);
        let call = Call(self.0.len());
        self.0.extend_from_slice(&[0; 4]);
        call
    }

    /// Completes a call with the place at which the called code begins.
    pub(super) fn begins(&mut self, Call(at): Call, place: usize) {
        let distance = place as i32 - (at as i32 + 4);
        self.0[at..at + 4].copy_from_slice(&distance.to_le_bytes());
    }

    /// The bytes from behind an instruction that ends with this distance to a place.
    fn distance_to(&mut self, place: usize) {
        let distance = place as i32 - (self.0.len() as i32 + 4);
        self.0.extend_from_slice(&distance.to_le_bytes());
    }

    fn vex(
        &mut self,
        opcode: Opcode,
        register: VectorRegister,
        left: VectorRegister,
        last: Source,
    ) {
        match last {
            Source::Register(last) => {
                self.prefixes(opcode, register, left, last.0 >= 8);
                self.0.push(0xC0 | (register.0 & 7) << 3 | last.0 & 7);
            }
            Source::Memory(place) => {
                self.prefixes(opcode, register, left, place.base.0 >= 8);
                // the short displacements of the EVEX prefix are counted in vectors
                self.memory(register.0, place, opcode.width != Width::Eight);
            }
        }
    }

    /// The VEX prefix, or the EVEX prefix, and the opcode; `extended` says whether the last operand is one of the upper eight registers.
    fn prefixes(
        &mut self,
        opcode: Opcode,
        register: VectorRegister,
        left: VectorRegister,
        extended: bool,
    ) {
        let Opcode { map, prefix, wide, width, code } = opcode;
        let inverted_extension = if register.0 < 8 { 0x80 } else { 0 };
        if width == Width::Eight {
            let inverted_base = if extended { 0 } else { 0x20 };
            let second = inverted_extension | 0x50 | inverted_base | map;
            self.0.extend_from_slice(&[
                0x62,
                second,
                0x84 | (!left.0 & 15) << 3 | prefix,
                0x48,
                code,
            ]);
            return;
        }
        let rest = (!left.0 & 15) << 3 | u8::from(width == Width::Four) << 2 | prefix;
        if map == MAP_0F && !wide && !extended {
            self.0.extend_from_slice(&[0xC5, inverted_extension | rest, code]);
        } else {
            let inverted_base = if extended { 0 } else { 0x20 };
            let second = inverted_extension | 0x40 | inverted_base | map;
            self.0.extend_from_slice(&[0xC4, second, u8::from(wide) << 7 | rest, code]);
        }
    }

    /// The operand in memory beside a register.
    fn memory(&mut self, register: u8, place: Place, may_be_short: bool) {
        let (low, base) = ((register & 7) << 3, place.base.0 & 7);
        if may_be_short && let Ok(short) = i8::try_from(place.displacement) {
            self.0.extend_from_slice(&[0x40 | low | base, short as u8]);
        } else {
            self.0.push(0x80 | low | base);
            self.0.extend_from_slice(&place.displacement.to_le_bytes());
        }
    }
}

/// A call of what begins at a place that is not known yet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Call(usize);

fn moves(width: Width, code: u8) -> Opcode {
    // vmovsd, vmovupd
    let prefix = if width == Width::One { SCALAR } else { PACKED };
    Opcode { map: MAP_0F, prefix, wide: false, width, code }
}

/// The general register that holds the address of a stretch of memory: those in which the System V convention passes the
/// arguments: rdi, rsi, rdx, rcx, r8, r9.
fn base(area: Area) -> General {
    General(match area {
        Area::Values => 7,
        Area::Work => 6,
        Area::Series => 2,
        Area::State => 1,
        Area::ExactSeries => 8,
        Area::ExactState => 9,
    })
}
