// The time of the day goes back by an hour with each look at it: preloaded (LD_PRELOAD) before a program. Clocks that count
// from the start of the machine are not touched.

#include <dlfcn.h>
#include <sys/time.h>
#include <time.h>

#include <atomic>

namespace
{
/// [s]
long set_back()
{
  static std::atomic<long> n_looks = 0;
  constexpr long hour = 3600;
  return hour * ++n_looks;
}

template <typename Function>
Function* next(const char* const name)
{
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}
} // namespace

extern "C"
{
  int clock_gettime(const clockid_t clock, timespec* const now)
  {
    static auto* const real = next<int(clockid_t, timespec*)>("clock_gettime");
    const int result = real(clock, now);
    if (clock == CLOCK_REALTIME)
      now->tv_sec -= set_back();
    return result;
  }

  int gettimeofday(timeval* const now, void* const zone)
  {
    static auto* const real = next<int(timeval*, void*)>("gettimeofday");
    const int result = real(now, zone);
    now->tv_sec -= set_back();
    return result;
  }

  time_t time(time_t* const now)
  {
    static auto* const real = next<time_t(time_t*)>("time");
    const time_t result = real(nullptr) - set_back();
    if (now)
      *now = result;
    return result;
  }
}
