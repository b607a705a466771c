// Storage of one field: contiguous, aligned to a cache line so that a record never straddles two.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <vector>

namespace plumb {

inline constexpr std::size_t cache_line = 64; // [bytes] on every x86-64 machine

inline constexpr std::size_t huge_page = std::size_t{1} << 21U; // [bytes]

/// Allocator for std::vector that aligns to a cache line. Large fields ask for huge pages: the sweep over pairs reads
/// records in random order, and with small pages it would wait for address translation.
template <class T> struct CacheAligned {
    using value_type = T;
    CacheAligned() = default;
    template <class U> CacheAligned(const CacheAligned<U>& /*other*/) {}
    T* allocate(std::size_t n) {
        const std::size_t bytes = n * sizeof(T);
        void* p = ::operator new(bytes, alignment(n));
        if (bytes >= huge_page) madvise(p, bytes, MADV_HUGEPAGE); // advice only: a refusal changes nothing
        return static_cast<T*>(p);
    }
    void deallocate(T* p, std::size_t n) noexcept { ::operator delete(p, alignment(n)); }
    static std::align_val_t alignment(std::size_t n) {
        return std::align_val_t{n * sizeof(T) >= huge_page ? huge_page : cache_line};
    }
    friend bool operator==(const CacheAligned& /*a*/, const CacheAligned& /*b*/) { return true; }
};

template <class T> using Field = std::vector<T, CacheAligned<T>>;

/// Changes the size of a vector whose entries will all be written anew; resize() would copy the old ones and double the
/// memory each time it grows by a few.
template <class Vector> void renew_size(Vector& v, std::size_t n) {
    if (n > v.capacity()) {
        Vector().swap(v);
        v.reserve(n + n / 32);
    }
    v.resize(n);
}

} // namespace plumb
