// A disk that is full from some write to a file on: preloaded (LD_PRELOAD) before a program. FELDSPAR_WRITES_LEFT: how
// many writes go through. Standard output and pipes are not touched.

#include <dlfcn.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>

namespace
{
bool has_room(const int descriptor)
{
  static std::atomic<long> left = [] {
    const char* const wanted = std::getenv("FELDSPAR_WRITES_LEFT");
    return wanted ? std::atol(wanted) : 0L;
  }();
  struct stat status = {};
  if (descriptor <= STDERR_FILENO || fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode) || left-- > 0)
    return true;
  errno = ENOSPC;
  return false;
}

template <typename Function>
Function* next(const char* const name)
{
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}
} // namespace

extern "C"
{
  ssize_t write(const int descriptor, const void* const buffer, const size_t size)
  {
    static auto* const real = next<ssize_t(int, const void*, size_t)>("write");
    return has_room(descriptor) ? real(descriptor, buffer, size) : -1;
  }

  ssize_t writev(const int descriptor, const iovec* const buffers, const int n)
  {
    static auto* const real = next<ssize_t(int, const iovec*, int)>("writev");
    return has_room(descriptor) ? real(descriptor, buffers, n) : -1;
  }

  ssize_t pwrite(const int descriptor, const void* const buffer, const size_t size, const off_t offset)
  {
    static auto* const real = next<ssize_t(int, const void*, size_t, off_t)>("pwrite");
    return has_room(descriptor) ? real(descriptor, buffer, size, offset) : -1;
  }

  ssize_t pwrite64(const int descriptor, const void* const buffer, const size_t size, const off64_t offset)
  {
    static auto* const real = next<ssize_t(int, const void*, size_t, off64_t)>("pwrite64");
    return has_room(descriptor) ? real(descriptor, buffer, size, offset) : -1;
  }
}
