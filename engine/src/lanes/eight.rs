//! Eight numbers side by side.

use std::ops::{
    Add, AddAssign, BitAnd, BitOr, Div, DivAssign, Mul, MulAssign, Neg, Not, Sub, SubAssign,
};

use num_traits::{One, Zero};
use wide::bytemuck::cast;
use wide::{f64x8, u32x8, u64x8};

use super::{HALF_OF_LAST, Lanes, MOST_LANES, Mask, UPPER, per_lane};

/// Eight numbers: one vector where the processor has such wide ones, else two of four.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eight(f64x8);

/// Eight times yes or no: all bits of a lane, or none.
#[derive(Clone, Copy, Debug)]
pub struct EightBools(f64x8);

/// An operation on the numbers in each lane.
macro_rules! lane_by_lane {
    ($($operation:ident $operate:ident, $assignment:ident $assign:ident;)*) => {$(
        impl $operation for Eight {
            type Output = Self;

            #[inline(always)]
            fn $operate(self, other: Self) -> Self {
                Self(self.0.$operate(other.0))
            }
        }

        impl $assignment for Eight {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                *self = self.$operate(other);
            }
        }
    )*};
}

lane_by_lane! {
    Add add, AddAssign add_assign;
    Sub sub, SubAssign sub_assign;
    Mul mul, MulAssign mul_assign;
    Div div, DivAssign div_assign;
}

impl Neg for Eight {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Zero for Eight {
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }

    fn is_zero(&self) -> bool {
        *self == Self::zero()
    }
}

impl One for Eight {
    #[inline(always)]
    fn one() -> Self {
        Self::splat(1.0)
    }
}

impl BitAnd for EightBools {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl BitOr for EightBools {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl Not for EightBools {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

impl Mask for EightBools {
    #[inline(always)]
    fn bits(self) -> u32 {
        self.0.to_bitmask()
    }
}

impl Lanes for Eight {
    const COUNT: usize = 8;

    type Mask = EightBools;

    #[inline(always)]
    fn splat(number: f64) -> Self {
        Self(f64x8::splat(number))
    }

    #[inline(always)]
    fn from_lanes(of: impl FnMut(usize) -> f64) -> Self {
        Self(f64x8::new(per_lane(of)))
    }

    #[inline(always)]
    fn lane(&self, lane: usize) -> f64 {
        self.0.to_array()[lane]
    }

    #[inline(always)]
    fn simd_gt(self, other: Self) -> EightBools {
        EightBools(self.0.simd_gt(other.0))
    }

    #[inline(always)]
    fn simd_lt(self, other: Self) -> EightBools {
        EightBools(self.0.simd_lt(other.0))
    }

    #[inline(always)]
    fn simd_ne(self, other: Self) -> EightBools {
        EightBools(self.0.simd_ne(other.0))
    }

    #[inline(always)]
    fn simd_max(self, other: Self) -> Self {
        Self(self.0.fast_max(other.0))
    }

    #[inline(always)]
    fn simd_min(self, other: Self) -> Self {
        Self(self.0.fast_min(other.0))
    }

    #[inline(always)]
    fn simd_abs(self) -> Self {
        Self(self.0.abs())
    }

    #[inline(always)]
    fn simd_copysign(self, sign: Self) -> Self {
        let bit = f64x8::splat(-0.0);
        Self((bit & sign.0) | (!bit & self.0))
    }

    #[inline(always)]
    fn simd_sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    #[inline(always)]
    fn select(self, mask: EightBools, other: Self) -> Self {
        Self(mask.0.select(self.0, other.0))
    }

    #[inline(always)]
    fn differ(numbers: &[u32], one: u32) -> u32 {
        let numbers = u32x8::new(per_lane(|lane| numbers[lane]));
        !numbers.simd_eq(u32x8::splat(one)).to_bitmask() & 0xFF
    }

    #[inline(always)]
    fn columns(rows: [&[f64; 4]; MOST_LANES]) -> [Self; 4] {
        transposition::to_columns(rows).map(Self)
    }

    #[inline(always)]
    fn rows(columns: [Self; 4]) -> [[f64; 4]; MOST_LANES] {
        transposition::to_rows(columns.map(|column| column.0))
    }

    #[inline(always)]
    fn columns_of_two(rows: [&[f64; 2]; MOST_LANES]) -> [Self; 2] {
        transposition::to_columns_of_two(rows).map(Self)
    }

    #[inline(always)]
    fn rows_of_two(columns: [Self; 2]) -> [[f64; 2]; MOST_LANES] {
        transposition::to_rows_of_two(columns.map(|column| column.0))
    }

    #[inline(always)]
    fn pack(one: Self, other: Self) -> Self {
        let round = |numbers: Self| cast::<_, u64x8>(numbers.0) + u64x8::splat(HALF_OF_LAST);
        Self(cast((round(one) >> 32) | (round(other) & u64x8::splat(UPPER))))
    }

    #[inline(always)]
    fn unpack(self) -> [Self; 2] {
        let bits = cast::<_, u64x8>(self.0);
        [Self(cast(bits << 32)), Self(cast(bits & u64x8::splat(UPPER)))]
    }
}

/// Rows to columns and back. Left to itself the compiler moves number by number, which takes twice as
/// long.
#[cfg(target_feature = "avx512f")]
mod transposition {
    use safe_arch::{
        cast_m256d_to_m512d, cast_to_m512d_from_m512i, cast_to_m512i_from_m512d,
        insert_m256d_to_m512d, m256d, m512d, m512i, shuffle_abv_i64_all_m512i, shuffle_m512d,
    };
    use wide::f64x8;

    use super::per_lane;

    /// The numbers of `one` (0 to 7) and `other` (8 to 15) that stand in `order`.
    #[inline(always)]
    fn chosen(one: m512d, other: m512d, order: [i64; 8]) -> m512d {
        let [one, other] = [one, other].map(cast_to_m512i_from_m512d);
        cast_to_m512d_from_m512i(shuffle_abv_i64_all_m512i(one, m512i::from(order), other))
    }

    #[inline(always)]
    pub(super) fn to_columns(rows: [&[f64; 4]; 8]) -> [f64x8; 4] {
        let [a, b, c, d, e, f, g, h] = per_lane(|lane| m256d::from(*rows[lane]));
        let beside = |one, other| insert_m256d_to_m512d::<1>(cast_m256d_to_m512d(one), other);
        let [one, other] = [[beside(a, c), beside(b, d)], [beside(e, g), beside(f, h)]];
        // Of lanes 0 to 3: column 0 and 2, then 1 and 3; the same of lanes 4 to 7.
        let even =
            [shuffle_m512d::<0x00>(one[0], one[1]), shuffle_m512d::<0x00>(other[0], other[1])];
        let odd =
            [shuffle_m512d::<0xFF>(one[0], one[1]), shuffle_m512d::<0xFF>(other[0], other[1])];
        let first = |[one, other]: [m512d; 2]| chosen(one, other, [0, 1, 4, 5, 8, 9, 12, 13]);
        let second = |[one, other]: [m512d; 2]| chosen(one, other, [2, 3, 6, 7, 10, 11, 14, 15]);
        [first(even), first(odd), second(even), second(odd)]
            .map(|column| f64x8::new(column.to_array()))
    }

    #[inline(always)]
    pub(super) fn to_rows(columns: [f64x8; 4]) -> [[f64; 4]; 8] {
        let [a, b, c, d] = columns.map(|column| m512d::from(column.to_array()));
        let even = [shuffle_m512d::<0x00>(a, b), shuffle_m512d::<0x00>(c, d)];
        let odd = [shuffle_m512d::<0xFF>(a, b), shuffle_m512d::<0xFF>(c, d)];
        // Two rows each.
        let near = |[one, other]: [m512d; 2]| chosen(one, other, [0, 1, 8, 9, 4, 5, 12, 13]);
        let far = |[one, other]: [m512d; 2]| chosen(one, other, [2, 3, 10, 11, 6, 7, 14, 15]);
        let halves = |two: m512d| {
            let [a, b, c, d, e, f, g, h] = two.to_array();
            [[a, b, c, d], [e, f, g, h]]
        };
        let ([r_0, r_4], [r_1, r_5]) = (halves(near(even)), halves(near(odd)));
        let ([r_2, r_6], [r_3, r_7]) = (halves(far(even)), halves(far(odd)));
        [r_0, r_1, r_2, r_3, r_4, r_5, r_6, r_7]
    }

    #[inline(always)]
    pub(super) fn to_columns_of_two(rows: [&[f64; 2]; 8]) -> [f64x8; 2] {
        let [[a, b], [c, d], [e, f], [g, h], [i, j], [k, l], [m, n], [o, p]] = rows;
        let even = m512d::from([*a, *b, *e, *f, *i, *j, *m, *n]);
        let odd = m512d::from([*c, *d, *g, *h, *k, *l, *o, *p]);
        [shuffle_m512d::<0x00>(even, odd), shuffle_m512d::<0xFF>(even, odd)]
            .map(|column| f64x8::new(column.to_array()))
    }

    #[inline(always)]
    pub(super) fn to_rows_of_two(columns: [f64x8; 2]) -> [[f64; 2]; 8] {
        let [one, other] = columns.map(|column| m512d::from(column.to_array()));
        let [a, b, e, f, i, j, m, n] = shuffle_m512d::<0x00>(one, other).to_array();
        let [c, d, g, h, k, l, o, p] = shuffle_m512d::<0xFF>(one, other).to_array();
        [[a, b], [c, d], [e, f], [g, h], [i, j], [k, l], [m, n], [o, p]]
    }
}

/// Rows to columns and back.
#[cfg(not(target_feature = "avx512f"))]
mod transposition {
    use wide::{f64x4, f64x8};

    use super::per_lane;

    #[inline(always)]
    pub(super) fn to_columns(rows: [&[f64; 4]; 8]) -> [f64x8; 4] {
        let half =
            |from: usize| f64x4::transpose([0, 1, 2, 3].map(|lane| f64x4::new(*rows[from + lane])));
        let [low, high] = [half(0), half(4)].map(|columns| columns.map(f64x4::to_array));
        [0, 1, 2, 3].map(|at| {
            let ([a, b, c, d], [e, f, g, h]) = (low[at], high[at]);
            f64x8::new([a, b, c, d, e, f, g, h])
        })
    }

    #[inline(always)]
    pub(super) fn to_rows(columns: [f64x8; 4]) -> [[f64; 4]; 8] {
        let columns = columns.map(f64x8::to_array);
        let half = |from: usize| {
            let column = |at: usize| [0, 1, 2, 3].map(|lane| columns[at][from + lane]);
            f64x4::transpose([0, 1, 2, 3].map(|at| f64x4::new(column(at)))).map(f64x4::to_array)
        };
        let ([a, b, c, d], [e, f, g, h]) = (half(0), half(4));
        [a, b, c, d, e, f, g, h]
    }

    #[inline(always)]
    pub(super) fn to_columns_of_two(rows: [&[f64; 2]; 8]) -> [f64x8; 2] {
        [0, 1].map(|at| f64x8::new(per_lane(|lane| rows[lane][at])))
    }

    #[inline(always)]
    pub(super) fn to_rows_of_two(columns: [f64x8; 2]) -> [[f64; 2]; 8] {
        let [one, other] = columns.map(f64x8::to_array);
        per_lane(|lane| [one[lane], other[lane]])
    }
}
