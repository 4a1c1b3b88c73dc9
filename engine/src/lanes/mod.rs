//! Numbers side by side: the same contact law for one contact or for eight at a time.
//!
//! A law is written once, for any `R:` [`Lanes`]. Of `f64` it is the plain law that a reader checks by
//! hand; of [`Eight`] the compiler makes vector instructions of the same lines, with the same bits in each
//! lane. There are no branches in lanes: `a.select(mask, b)` is `a` where the mask holds, else `b`, and both
//! are computed.
//!
//! Eight, not four: a law is one long chain of square roots and divisions, and a processor sees only so many
//! instructions ahead. With more lanes it has more to do while it waits.

mod eight;

use std::fmt::Debug;
use std::ops::{BitAnd, BitOr, Not};

use nalgebra::{
    ClosedAddAssign, ClosedDivAssign, ClosedMulAssign, ClosedSubAssign, SVector, Scalar,
};
use num_traits::{One, Zero};

pub use eight::{Eight, EightBools};

/// How many lanes the widest kind has.
pub const MOST_LANES: usize = 8;

/// Something for each lane. Of an array this long the compiler makes a call of every `map`.
#[inline(always)]
pub(crate) fn per_lane<T>(mut of: impl FnMut(usize) -> T) -> [T; MOST_LANES] {
    [of(0), of(1), of(2), of(3), of(4), of(5), of(6), of(7)]
}

/// One number, or several side by side; comparisons give a mask. Operations act lane by lane.
pub trait Lanes:
    Scalar
    + Copy
    + Send
    + Sync
    + Zero
    + One
    + std::ops::Neg<Output = Self>
    + ClosedAddAssign
    + ClosedSubAssign
    + ClosedMulAssign
    + ClosedDivAssign
{
    /// How many numbers, at most [`MOST_LANES`].
    const COUNT: usize;

    /// The answer to a question, lane by lane.
    type Mask: Mask;

    /// The same number in every lane.
    fn splat(number: f64) -> Self;

    /// The numbers of the lanes, in order.
    fn from_lanes(of: impl FnMut(usize) -> f64) -> Self;

    /// The number of one lane, below [`Self::COUNT`].
    fn lane(&self, lane: usize) -> f64;

    /// Whether it is above `other`.
    fn simd_gt(self, other: Self) -> Self::Mask;

    /// Whether it is below `other`.
    fn simd_lt(self, other: Self) -> Self::Mask;

    /// Whether it differs from `other`.
    fn simd_ne(self, other: Self) -> Self::Mask;

    /// The larger one; `other` if the two do not compare.
    fn simd_max(self, other: Self) -> Self;

    /// The smaller one; `other` if the two do not compare.
    fn simd_min(self, other: Self) -> Self;

    /// Without its sign.
    fn simd_abs(self) -> Self;

    /// With the sign of `sign`.
    fn simd_copysign(self, sign: Self) -> Self;

    /// √.
    fn simd_sqrt(self) -> Self;

    /// Itself where `mask` holds, `other` elsewhere.
    fn select(self, mask: Self::Mask, other: Self) -> Self;

    /// `of` the number of each lane.
    #[inline(always)]
    fn map_lanes(self, of: impl Fn(f64) -> f64) -> Self {
        Self::from_lanes(|lane| of(self.lane(lane)))
    }

    /// Which of as many `numbers` as there are lanes differ from `one`, from the lowest bit.
    fn differ(numbers: &[u32], one: u32) -> u32;

    /// Four numbers of each lane, `rows[lane]`, as four in lanes.
    fn columns(rows: [&[f64; 4]; MOST_LANES]) -> [Self; 4];

    /// The way back: four numbers of each lane.
    fn rows(columns: [Self; 4]) -> [[f64; 4]; MOST_LANES];

    /// The same of two numbers of each lane.
    fn columns_of_two(rows: [&[f64; 2]; MOST_LANES]) -> [Self; 2];

    /// The way back: two numbers of each lane.
    fn rows_of_two(columns: [Self; 2]) -> [[f64; 2]; MOST_LANES];

    /// `one` and `other`, rounded to six digits, in the room of one number: not a number to compute with.
    fn pack(one: Self, other: Self) -> Self;

    /// What [`Lanes::pack`] put there.
    fn unpack(self) -> [Self; 2];

    /// The sum over the lanes, from the first to the last.
    fn sum_of_lanes(&self) -> f64 {
        (1..Self::COUNT).fold(self.lane(0), |sum, lane| sum + self.lane(lane))
    }
}

/// A yes or no in each lane.
pub trait Mask:
    Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self>
{
    /// The answers, from the lowest bit.
    fn bits(self) -> u32;

    /// Whether any is yes.
    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }
}

impl Mask for bool {
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self)
    }
}

impl Lanes for f64 {
    const COUNT: usize = 1;

    type Mask = bool;

    #[inline(always)]
    fn splat(number: f64) -> Self {
        number
    }

    #[inline(always)]
    fn from_lanes(mut of: impl FnMut(usize) -> f64) -> Self {
        of(0)
    }

    #[inline(always)]
    fn lane(&self, _: usize) -> f64 {
        *self
    }

    #[inline(always)]
    fn simd_gt(self, other: Self) -> bool {
        self > other
    }

    #[inline(always)]
    fn simd_lt(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn simd_ne(self, other: Self) -> bool {
        self.partial_cmp(&other) != Some(std::cmp::Ordering::Equal)
    }

    #[inline(always)]
    fn simd_max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    #[inline(always)]
    fn simd_min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }

    #[inline(always)]
    fn simd_abs(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn simd_copysign(self, sign: Self) -> Self {
        self.copysign(sign)
    }

    #[inline(always)]
    fn simd_sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn select(self, mask: bool, other: Self) -> Self {
        if mask { self } else { other }
    }

    #[inline(always)]
    fn differ(numbers: &[u32], one: u32) -> u32 {
        u32::from(numbers[0] != one)
    }

    #[inline(always)]
    fn columns(rows: [&[f64; 4]; MOST_LANES]) -> [Self; 4] {
        *rows[0]
    }

    #[inline(always)]
    fn rows(columns: [Self; 4]) -> [[f64; 4]; MOST_LANES] {
        [columns; MOST_LANES]
    }

    #[inline(always)]
    fn columns_of_two(rows: [&[f64; 2]; MOST_LANES]) -> [Self; 2] {
        *rows[0]
    }

    #[inline(always)]
    fn rows_of_two(columns: [Self; 2]) -> [[f64; 2]; MOST_LANES] {
        [columns; MOST_LANES]
    }

    #[inline(always)]
    fn pack(one: Self, other: Self) -> Self {
        let [one, other] = [one, other].map(|number| number.to_bits().wrapping_add(HALF_OF_LAST));
        Self::from_bits(one >> 32 | other & UPPER)
    }

    #[inline(always)]
    fn unpack(self) -> [Self; 2] {
        let bits = self.to_bits();
        [bits << 32, bits & UPPER].map(Self::from_bits)
    }
}

/// A vector of `N` components, each in lanes.
pub type Vector<R, const N: usize> = SVector<R, N>;

/// A vector of its components. Those of nalgebra go through memory piece by piece, which costs more than
/// what is then computed with them.
#[inline(always)]
pub fn vector_of<R: Lanes, const N: usize>(component: impl FnMut(usize) -> R) -> Vector<R, N> {
    Vector::from(std::array::from_fn(component))
}

/// `vector` where the mask holds, zero elsewhere.
#[inline(always)]
pub fn vector_where<R: Lanes, const N: usize>(mask: R::Mask, vector: Vector<R, N>) -> Vector<R, N> {
    vector_of(|at| vector[at].select(mask, R::zero()))
}

/// `one` where the mask holds, `other` elsewhere.
#[inline(always)]
pub fn select_vector<R: Lanes, const N: usize>(
    mask: R::Mask,
    one: Vector<R, N>,
    other: Vector<R, N>,
) -> Vector<R, N> {
    vector_of(|at| one[at].select(mask, other[at]))
}

/// The length of `vector`; that of a single component takes no root.
#[inline(always)]
pub fn length<R: Lanes, const N: usize>(vector: Vector<R, N>) -> R {
    if N == 1 { vector[0].simd_abs() } else { vector.dot(&vector).simd_sqrt() }
}

/// `vector`, shortened to `limit` (not negative) where it is longer, and where that is.
#[inline(always)]
pub fn shortened<R: Lanes, const N: usize>(
    vector: Vector<R, N>,
    limit: R,
) -> (Vector<R, N>, R::Mask) {
    if N == 1 {
        let is_longer = vector[0].simd_abs().simd_gt(limit);
        let cut = |at: usize| limit.simd_copysign(vector[at]).select(is_longer, vector[at]);
        (vector_of(cut), is_longer)
    } else {
        let square = vector.dot(&vector);
        let is_longer = square.simd_gt(limit * limit);
        (vector * (limit / square.simd_sqrt()).select(is_longer, R::one()), is_longer)
    }
}

/// Something made of numbers in a fixed order: what a law remembers or books. [`crate::record!`] makes
/// one of a struct.
pub trait Record<R: Lanes>: Copy {
    /// How many numbers, each in lanes.
    const LEN: usize;

    /// Takes its numbers from `next`, in order.
    fn read(next: &mut impl FnMut() -> R) -> Self;

    /// Hands its numbers to `put`, in order.
    fn write(&self, put: &mut impl FnMut(R));

    /// All numbers zero.
    #[inline(always)]
    fn zero() -> Self {
        Self::read(&mut R::zero)
    }
}

impl<R: Lanes> Record<R> for R {
    const LEN: usize = 1;

    #[inline(always)]
    fn read(next: &mut impl FnMut() -> R) -> Self {
        next()
    }

    #[inline(always)]
    fn write(&self, put: &mut impl FnMut(R)) {
        put(*self);
    }
}

impl<R: Lanes, const N: usize> Record<R> for Vector<R, N> {
    const LEN: usize = N;

    #[inline(always)]
    fn read(next: &mut impl FnMut() -> R) -> Self {
        vector_of(|_| next())
    }

    #[inline(always)]
    fn write(&self, put: &mut impl FnMut(R)) {
        for component in self.iter() {
            put(*component);
        }
    }
}

/// The upper half of a number: its sign, its exponent and twenty bits behind the point.
const UPPER: u64 = 0xFFFF_FFFF_0000_0000;

/// Half of the last of them, with which numbers are rounded.
const HALF_OF_LAST: u64 = 1 << 31;

/// By how much of itself a number of a [`Coarse`] record is off, at most (–).
pub const COARSE_ERROR: f64 = 1.0 / (1 << 21) as f64;

/// How many numbers a [`Coarse`] record has at most.
const MOST_COARSE: usize = 8;

/// A record that keeps six digits, two of its numbers in the room of one: for what laws remember for the ledger
/// alone, where steps are good for fewer. Forces are to depend on none of it.
#[derive(Clone, Copy, Debug)]
pub struct Coarse<T>(pub T);

impl<R: Lanes, T: Record<R>> Record<R> for Coarse<T> {
    const LEN: usize = T::LEN.div_ceil(2);

    #[inline(always)]
    fn read(next: &mut impl FnMut() -> R) -> Self {
        const { assert!(T::LEN <= MOST_COARSE) }
        let mut numbers = [R::zero(); MOST_COARSE];
        for two in numbers.as_chunks_mut().0.iter_mut().take(Self::LEN) {
            *two = next().unpack();
        }
        let mut at = 0;
        Self(T::read(&mut || {
            at += 1;
            numbers[at - 1]
        }))
    }

    #[inline(always)]
    fn write(&self, put: &mut impl FnMut(R)) {
        let mut numbers = [R::zero(); MOST_COARSE];
        let mut at = 0;
        self.0.write(&mut |number| {
            numbers[at] = number;
            at += 1;
        });
        for [one, other] in numbers.as_chunks().0.iter().take(Self::LEN) {
            put(R::pack(*one, *other));
        }
    }
}

/// A struct of numbers in lanes that is a [`Record`]: fields are lanes, vectors or other records.
///
/// ```
/// engine::record! {
///     /// What a contact remembers.
///     pub struct Memory<R, const N: usize> {
///         /// Of the tangential spring (m).
///         pub stretch: engine::lanes::Vector<R, N>,
///         /// Damping force (N).
///         pub damping: R,
///     }
/// }
/// use engine::lanes::Record;
/// assert_eq!(<Memory<f64, 3> as Record<f64>>::LEN, 4);
/// ```
#[macro_export]
macro_rules! record {
    (
        $(#[$meta:meta])*
        $vis:vis struct $name:ident<$r:ident $(, const $n:ident: usize)?> {
            $($(#[$field_meta:meta])* $field_vis:vis $field:ident: $type:ty,)*
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug)]
        $vis struct $name<$r: $crate::lanes::Lanes $(, const $n: usize)?> {
            $($(#[$field_meta])* $field_vis $field: $type,)*
        }

        impl<$r: $crate::lanes::Lanes $(, const $n: usize)?> $crate::lanes::Record<$r>
            for $name<$r $(, $n)?>
        {
            const LEN: usize = 0 $(+ <$type as $crate::lanes::Record<$r>>::LEN)*;

            #[inline(always)]
            fn read(next: &mut impl FnMut() -> $r) -> Self {
                Self { $($field: <$type as $crate::lanes::Record<$r>>::read(next),)* }
            }

            #[inline(always)]
            fn write(&self, put: &mut impl FnMut($r)) {
                $($crate::lanes::Record::write(&self.$field, put);)*
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_numbers_in_the_room_of_one_keep_six_digits_and_their_signs() {
        let numbers = [0.0, -0.0, 1.0, -1.0 / 3.0, 1e-300, -7.7e11, f64::MIN_POSITIVE, 0.1];
        for one in numbers {
            for other in numbers {
                let packed = f64::pack(one, other);
                assert!(packed.is_finite());
                for (kept, number) in packed.unpack().into_iter().zip([one, other]) {
                    assert!(
                        (kept - number).abs() <= COARSE_ERROR * number.abs(),
                        "{kept} {number}"
                    );
                    assert_eq!(kept.is_sign_negative(), number.is_sign_negative());
                }
                let in_lanes = Eight::pack(Eight::splat(one), Eight::splat(other));
                assert_eq!(in_lanes.lane(7).to_bits(), packed.to_bits());
                let kept = in_lanes.unpack().map(|part| part.lane(3).to_bits());
                assert_eq!(kept, packed.unpack().map(f64::to_bits));
            }
        }
    }

    #[test]
    fn one_component_is_shortened_as_the_same_vector_in_space() {
        for number in [-3.0, -0.5, 0.0, 0.5, 1.0, 3.0] {
            let in_plane = Vector::from([number]);
            let in_space = Vector::from([0.0, number, 0.0]);
            let (cut, is_cut) = shortened::<f64, 1>(in_plane, 1.0);
            let (cut_in_space, is_cut_in_space) = shortened::<f64, 3>(in_space, 1.0);
            assert_eq!((cut.x, is_cut), (cut_in_space.y, is_cut_in_space));
            assert_eq!(cut.x.to_bits(), f64::clamp(number, -1.0, 1.0).to_bits());
            assert_eq!(length::<f64, 1>(in_plane).to_bits(), length::<f64, 3>(in_space).to_bits());
        }
    }
}
