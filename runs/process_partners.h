#pragma once

#include "base/ranks/ranks.h"
#include "dem/sharing/partners.h"

#include <cstddef>
#include <span>
#include <vector>

namespace feldspar
{
/// The processes of base/ranks.
class ProcessesAsPartners : public Partners
{
public:
  unsigned int number() const override { return ranks::number(); }
  unsigned int mine() const override { return ranks::mine(); }

  std::vector<std::byte> gathered(const std::span<const std::byte> own, std::vector<std::size_t>& sizes) override
  {
    return ranks::gathered_by_all(own, sizes);
  }
  std::vector<std::byte> gathered_by_first(const std::span<const std::byte> own) override
  {
    return ranks::gathered_by_first(own);
  }
  void exchange(const std::vector<double>& sent, const std::vector<std::size_t>& first_sent,
                std::vector<double>& received, const std::vector<std::size_t>& first_received) override
  {
    ranks::exchange(sent, first_sent, received, first_received);
  }
};
} // namespace feldspar
