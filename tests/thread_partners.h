#pragma once

#include "dem/sharing/partners.h"

#include <algorithm>
#include <barrier>
#include <cstddef>
#include <exception>
#include <functional>
#include <span>
#include <stdexcept>
#include <thread>
#include <vector>

namespace feldspar::tests
{
/// Threads in the place of the processes that compute one body together.
class ThreadPartners
{
public:
  explicit ThreadPartners(const unsigned int n)
    : meeting(std::ptrdiff_t(n))
    , bytes(n)
    , messages(n)
    , n_partners(n)
  {
  }

  /// Calls work(partners) as each of them.
  void run(const std::function<void(Partners&)>& work)
  {
    std::vector<std::exception_ptr> failures(n_partners);
    std::vector<std::thread> threads;
    for (unsigned int p = 0; p < n_partners; ++p)
      threads.emplace_back([&, p] {
        try
          {
            One one(*this, p);
            work(one);
          }
        catch (...)
          {
            failures[p] = std::current_exception();
            meeting.arrive_and_drop();
          }
      });
    for (auto& thread : threads)
      thread.join();
    for (const auto& failure : failures)
      if (failure)
        std::rethrow_exception(failure);
  }

private:
  class One : public Partners
  {
  public:
    One(ThreadPartners& all, const unsigned int number_of_it)
      : those(all)
      , own_number(number_of_it)
    {
    }
    unsigned int number() const override { return those.n_partners; }
    unsigned int mine() const override { return own_number; }

    std::vector<std::byte> gathered(const std::span<const std::byte> own, std::vector<std::size_t>& sizes) override
    {
      those.bytes[own_number].assign(own.begin(), own.end());
      those.meeting.arrive_and_wait();
      std::vector<std::byte> all;
      std::vector<std::size_t> found;
      for (const auto& one : those.bytes)
        {
          all.insert(all.end(), one.begin(), one.end());
          found.push_back(one.size());
        }
      if (!sizes.empty() && sizes != found)
        throw std::logic_error("sizes that were known are others");
      sizes = found;
      those.meeting.arrive_and_wait();
      return all;
    }

    std::vector<std::byte> gathered_by_first(const std::span<const std::byte> own) override
    {
      std::vector<std::size_t> sizes;
      auto all = gathered(own, sizes);
      return own_number == 0 ? std::move(all) : std::vector<std::byte>();
    }

    void exchange(const std::vector<double>& sent, const std::vector<std::size_t>& first_sent,
                  std::vector<double>& received, const std::vector<std::size_t>& first_received) override
    {
      auto& own = those.messages[own_number];
      own.clear();
      for (unsigned int p = 0; p < number(); ++p)
        own.emplace_back(sent.begin() + std::ptrdiff_t(first_sent[p]),
                         sent.begin() + std::ptrdiff_t(first_sent[p + 1]));
      those.meeting.arrive_and_wait();
      for (unsigned int p = 0; p < number(); ++p)
        {
          const auto& message = those.messages[p][own_number];
          if (message.size() != first_received[p + 1] - first_received[p])
            throw std::logic_error("a message of another length");
          std::copy(message.begin(), message.end(), received.begin() + std::ptrdiff_t(first_received[p]));
        }
      those.meeting.arrive_and_wait();
    }

  private:
    ThreadPartners& those;
    unsigned int own_number;
  };

  std::barrier<> meeting;
  std::vector<std::vector<std::byte>> bytes;
  std::vector<std::vector<std::vector<double>>> messages;
  unsigned int n_partners;
};
} // namespace feldspar::tests
