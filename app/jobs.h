#pragma once

#include <cstddef>
#include <functional>

namespace feldspar
{
/// Runs job(0) … job(n - 1), begun in this order, as many at a time as there are threads. Each is done whole by one thread before it begins
/// another, though its own loops may get help. The first exception ends the rest and is thrown on.
void for_each_job(std::size_t n, const std::function<void(std::size_t)>& job);
} // namespace feldspar
