//! Numbers side by side: the same contact law for one contact or for four at a time.
//!
//! A law is written once, for any `R:` [`Lanes`]. Of `f64` it is the plain law that a reader checks by
//! hand; of [`Four`] the compiler makes vector instructions of the same lines, with the same bits in each
//! lane. There are no branches in lanes: `a.select(mask, b)` is `a` where the mask holds, else `b`, and both
//! are computed.

use nalgebra::SVector;
pub use simba::simd::SimdBool;
use simba::simd::{SimdRealField, WideBoolF64x4, WideF64x4};

/// Four numbers.
pub type Four = WideF64x4;

/// How many lanes the widest kind has.
pub const MOST_LANES: usize = 4;

/// One number, or several side by side; comparisons give a mask ([`SimdBool`]).
pub trait Lanes: SimdRealField<Element = f64> + Copy + Send + Sync {
    /// How many numbers, at most [`MOST_LANES`].
    const COUNT: usize;

    /// The numbers of the lanes, in order.
    fn from_lanes(of: impl FnMut(usize) -> f64) -> Self;

    /// The number of one lane, below [`Self::COUNT`].
    fn lane(&self, lane: usize) -> f64;

    /// Whether a mask holds, lane by lane from the lowest bit.
    fn bits(mask: Self::SimdBool) -> u64;

    /// Four numbers of each lane, `rows[lane]`, as four in lanes.
    fn columns(rows: [&[f64; 4]; MOST_LANES]) -> [Self; 4];

    /// The way back: four numbers of each lane.
    fn rows(columns: [Self; 4]) -> [[f64; 4]; MOST_LANES];

    /// The sum over the lanes, from the first to the last.
    fn sum_of_lanes(&self) -> f64 {
        (1..Self::COUNT).fold(self.lane(0), |sum, lane| sum + self.lane(lane))
    }
}

impl Lanes for f64 {
    const COUNT: usize = 1;

    #[inline(always)]
    fn from_lanes(mut of: impl FnMut(usize) -> f64) -> Self {
        of(0)
    }

    #[inline(always)]
    fn lane(&self, _: usize) -> f64 {
        *self
    }

    #[inline(always)]
    fn bits(mask: bool) -> u64 {
        u64::from(mask)
    }

    #[inline(always)]
    fn columns(rows: [&[f64; 4]; MOST_LANES]) -> [Self; 4] {
        *rows[0]
    }

    #[inline(always)]
    fn rows(columns: [Self; 4]) -> [[f64; 4]; MOST_LANES] {
        [columns; MOST_LANES]
    }
}

impl Lanes for Four {
    const COUNT: usize = 4;

    #[inline(always)]
    fn from_lanes(mut of: impl FnMut(usize) -> f64) -> Self {
        Self::from_arr([of(0), of(1), of(2), of(3)])
    }

    #[inline(always)]
    fn lane(&self, lane: usize) -> f64 {
        self.into_arr()[lane]
    }

    #[inline(always)]
    fn bits(mask: WideBoolF64x4) -> u64 {
        mask.0.move_mask() as u64
    }

    #[inline(always)]
    fn columns(rows: [&[f64; 4]; MOST_LANES]) -> [Self; 4] {
        transposed(rows.map(|row| Self::from_arr(*row)))
    }

    #[inline(always)]
    fn rows(columns: [Self; 4]) -> [[f64; 4]; MOST_LANES] {
        transposed(columns).map(Self::into_arr)
    }
}

/// Rows to columns. Left to itself the compiler loads number by number, which takes twice as long.
#[cfg(target_feature = "avx")]
#[inline(always)]
fn transposed(rows: [Four; 4]) -> [Four; 4] {
    use safe_arch::{m256d, permute2z_m256d, unpack_hi_m256d, unpack_lo_m256d};
    let [a, b, c, d] = rows.map(|row| m256d::from_array(row.into_arr()));
    let even = [unpack_lo_m256d(a, b), unpack_lo_m256d(c, d)];
    let odd = [unpack_hi_m256d(a, b), unpack_hi_m256d(c, d)];
    [
        permute2z_m256d::<0x20>(even[0], even[1]),
        permute2z_m256d::<0x20>(odd[0], odd[1]),
        permute2z_m256d::<0x31>(even[0], even[1]),
        permute2z_m256d::<0x31>(odd[0], odd[1]),
    ]
    .map(|column| Four::from_arr(column.to_array()))
}

/// Rows to columns.
#[cfg(not(target_feature = "avx"))]
#[inline(always)]
fn transposed(rows: [Four; 4]) -> [Four; 4] {
    let [a, b, c, d] = rows.map(Four::into_arr);
    [0, 1, 2, 3].map(|at| Four::from_arr([a[at], b[at], c[at], d[at]]))
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
pub fn vector_where<R: Lanes, const N: usize>(
    mask: R::SimdBool,
    vector: Vector<R, N>,
) -> Vector<R, N> {
    vector_of(|at| vector[at].select(mask, R::zero()))
}

/// `one` where the mask holds, `other` elsewhere.
#[inline(always)]
pub fn select_vector<R: Lanes, const N: usize>(
    mask: R::SimdBool,
    one: Vector<R, N>,
    other: Vector<R, N>,
) -> Vector<R, N> {
    vector_of(|at| one[at].select(mask, other[at]))
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
    #[must_use]
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
