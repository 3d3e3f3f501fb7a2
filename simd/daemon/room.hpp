#pragma once

#include <weave/sim/forecast.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>

namespace weave::simd {

using sim::expected_bytes;
using sim::memory_text;

/// The memory of the machine that workers may have, and who has been promised how much.
class Room {
  public:
    explicit Room(std::uint64_t bytes) : m_bytes(bytes) {}

    [[nodiscard]] std::uint64_t whole() const { return m_bytes; }
    [[nodiscard]] std::uint64_t taken() const;
    [[nodiscard]] std::uint64_t left() const { return m_bytes - std::min(m_bytes, taken()); }
    /// Whether there is room for this worker with so many bytes, in place of what it has been promised before; then it has them.
    bool take(std::uint64_t worker, std::uint64_t bytes);
    void give_back(std::uint64_t worker) { m_promised.erase(worker); }
    [[nodiscard]] std::uint64_t promised(std::uint64_t worker) const;

  private:
    std::uint64_t m_bytes;
    std::map<std::uint64_t, std::uint64_t> m_promised;
};

}  // namespace weave::simd
