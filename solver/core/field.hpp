// Storage of one field: contiguous, aligned to a cache line so that a record never straddles two.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace plumb {

inline constexpr std::size_t cache_line = 64; // [bytes] on every x86-64 machine

/// Allocator for std::vector that aligns to a cache line.
template <class T>
struct CacheAligned {
    using value_type = T;
    CacheAligned() = default;
    template <class U>
    CacheAligned(const CacheAligned<U>& /*other*/) {}
    T* allocate(std::size_t n) {
        return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{cache_line}));
    }
    void deallocate(T* p, std::size_t /*n*/) noexcept { ::operator delete (p, std::align_val_t{cache_line}); }
    friend bool operator==(const CacheAligned& /*a*/, const CacheAligned& /*b*/) { return true; }
};

template <class T>
using Field = std::vector<T, CacheAligned<T>>;

} // namespace plumb
