#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace feldspar
{
/// Memory that begins with a line of the cache. Large arrays begin with a large page and ask for large ones: whoever
/// walks through hundreds of megabytes otherwise waits for the addresses of small ones.
template <typename T>
struct PageAllocator
{
  using value_type = T;

  PageAllocator() = default;
  template <typename Other>
  PageAllocator(const PageAllocator<Other>&) // NOLINT(google-explicit-constructor): containers convert allocators
  {
  }

  T* allocate(const std::size_t n)
  {
    constexpr std::size_t line = 64, large_page = 2u << 20;
    const std::size_t bytes = n * sizeof(T);
    const std::size_t alignment = bytes >= large_page ? large_page : line;
    const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
    void* const memory = std::aligned_alloc(alignment, whole);
    if (!memory)
      throw std::bad_alloc();
#ifdef __linux__
    if (alignment == large_page)
      madvise(memory, whole, MADV_HUGEPAGE); // advice; without it all is well but slower
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* const memory, std::size_t) { std::free(memory); }

  friend bool operator==(const PageAllocator&, const PageAllocator&) { return true; }
};

/// Numbers of a whole body, which every step walks through.
template <typename T>
using LargeVector = std::vector<T, PageAllocator<T>>;
} // namespace feldspar
