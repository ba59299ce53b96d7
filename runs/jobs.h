#pragma once

#include <cstddef>
#include <functional>

namespace feldspar
{
/// Runs job(0) … job(n - 1), begun in this order, as many at a time as there are threads. Each is done whole by one
/// thread before it begins another, though its own loops may get help. After an exception no job is begun any more; the
/// first is thrown on once the running ones have ended.
void for_each_job(std::size_t n, const std::function<void(std::size_t)>& job);
} // namespace feldspar
