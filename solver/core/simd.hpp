// Eight doubles side by side. Compiler vectors, not intrinsics: the same source gives AVX-512, AVX2 or SSE2 code, and
// each lane does plain IEEE arithmetic. A lane has the bits of the scalar formula where multiply-adds are not
// contracted (PLUMB_PORTABLE); elsewhere the compiler may contract the two differently, in the last bit.
#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>

#ifdef __AVX512F__
#include <immintrin.h>
#endif

namespace plumb {

inline constexpr int pack_width = 8;
using Pack [[gnu::vector_size(64)]] = double;
using PackMask [[gnu::vector_size(64)]] = std::int64_t; // lanes are 0 or -1

template <class T> using MaskOf = std::conditional_t<std::is_same_v<T, Pack>, PackMask, bool>;

template <class T> inline T broadcast(double x) {
    if constexpr (std::is_same_v<T, Pack>)
        return Pack{x, x, x, x, x, x, x, x};
    else
        return x;
}

inline double square_root(double x) { return std::sqrt(x); }
inline Pack square_root(Pack x) {
#ifdef __AVX512F__                        // the compiler makes two halves of the loop below
    return _mm512_maskz_sqrt_pd(0xff, x); // the plain one alarms g++ 12 (uninitialised __Y)
#else
    Pack r;
    for (int lane = 0; lane < pack_width; ++lane) r[lane] = std::sqrt(x[lane]);
    return r;
#endif
}

inline double select(bool m, double a, double b) { return m ? a : b; }
inline Pack select(PackMask m, Pack a, Pack b) { return m ? a : b; }

inline double larger(double a, double b) { return a > b ? a : b; }
inline double smaller(double a, double b) { return a < b ? a : b; }
#ifdef __AVX512F__ // one instruction with the very meaning of the comparison; the compiler makes two
inline Pack larger(Pack a, Pack b) { return _mm512_maskz_max_pd(0xff, a, b); }
inline Pack smaller(Pack a, Pack b) { return _mm512_maskz_min_pd(0xff, a, b); }
#else
inline Pack larger(Pack a, Pack b) { return a > b ? a : b; }
inline Pack smaller(Pack a, Pack b) { return a < b ? a : b; }
#endif

inline bool any(bool m) { return m; }
inline bool any(PackMask m) {
#ifdef __AVX512DQ__ // one instruction; the loop below is not recognised as such
    return _mm512_movepi64_mask(reinterpret_cast<__m512i>(m)) != 0;
#else
    std::int64_t bits = 0;
    for (int lane = 0; lane < pack_width; ++lane) bits |= m[lane];
    return bits != 0;
#endif
}

/// Bit k is set where a < b in lane k.
inline unsigned lanes_below(Pack a, Pack b) {
#ifdef __AVX512F__ // straight from the comparison; of a PackMask the compiler makes a register first
    return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ);
#else
    const PackMask below = a < b;
    unsigned bits = 0;
    for (int lane = 0; lane < pack_width; ++lane) bits |= static_cast<unsigned>(below[lane] & 1) << lane;
    return bits;
#endif
}

/// Three numbers of space in a register of four; the fourth lane is 0.
using HalfPack [[gnu::vector_size(32)]] = double;

[[gnu::always_inline]] inline HalfPack load3(const double* at) { return HalfPack{at[0], at[1], at[2], 0.0}; }
[[gnu::always_inline]] inline void store3(double* at, HalfPack a) { at[0] = a[0], at[1] = a[1], at[2] = a[2]; }
[[gnu::always_inline]] inline double dot3(HalfPack a, HalfPack b) {
    const HalfPack c = a * b;
    return c[0] + c[1] + c[2];
}

/// A vector of space whose components are doubles or packs.
template <class T> struct Space {
    T x, y, z;

    friend Space operator+(const Space& a, const Space& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Space operator-(const Space& a, const Space& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Space operator*(const T& s, const Space& a) { return {s * a.x, s * a.y, s * a.z}; }
};
template <class T> inline T dot(const Space<T>& a, const Space<T>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T> inline Space<T> cross(const Space<T>& a, const Space<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T> inline Space<T> select(MaskOf<T> m, const Space<T>& a, const Space<T>& b) {
    return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

/// Transposes eight records of eight doubles: r[k][c] becomes r[c][k].
[[gnu::always_inline]] inline void transpose(Pack (&r)[8]) {
    Pack a[8], b[8];
    for (int k = 0; k < 8; k += 2) {
        a[k] = __builtin_shufflevector(r[k], r[k + 1], 0, 8, 2, 10, 4, 12, 6, 14);
        a[k + 1] = __builtin_shufflevector(r[k], r[k + 1], 1, 9, 3, 11, 5, 13, 7, 15);
    }
    for (int k = 0; k < 8; k += 4)
        for (int c = 0; c < 2; ++c) {
            b[k + c] = __builtin_shufflevector(a[k + c], a[k + c + 2], 0, 1, 8, 9, 4, 5, 12, 13);
            b[k + c + 2] = __builtin_shufflevector(a[k + c], a[k + c + 2], 2, 3, 10, 11, 6, 7, 14, 15);
        }
    for (int c = 0; c < 4; ++c) {
        r[c] = __builtin_shufflevector(b[c], b[c + 4], 0, 1, 2, 3, 8, 9, 10, 11);
        r[c + 4] = __builtin_shufflevector(b[c], b[c + 4], 4, 5, 6, 7, 12, 13, 14, 15);
    }
}

} // namespace plumb
