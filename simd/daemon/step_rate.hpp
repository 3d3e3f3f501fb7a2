#pragma once

#include <chrono>
#include <cstdint>

namespace weave::simd {

/// How many steps a second a worker makes, over the last second or more that it told of.
class StepRate {
  public:
    using Clock = std::chrono::steady_clock;

    void add(Clock::time_point now, std::uint64_t step) {
        const double passed = std::chrono::duration<double>(now - m_since).count();
        if (passed < 1) return;
        const bool is_known = m_since != Clock::time_point{};
        m_per_second = is_known && step > m_step ? static_cast<double>(step - m_step) / passed : 0;
        m_since = now;
        m_step = step;
    }
    [[nodiscard]] double per_second() const { return m_per_second; }

  private:
    Clock::time_point m_since{};
    std::uint64_t m_step = 0;
    double m_per_second = 0;
};

}  // namespace weave::simd
