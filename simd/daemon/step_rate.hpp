#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace weave::simd {

/// How many steps a second a worker makes, over the last second or more that it told of.
class StepRate {
  public:
    using Clock = std::chrono::steady_clock;

    void add(Clock::time_point now, std::uint64_t step) {
        m_told = now;
        const Clock::duration passed = now - m_since;
        if (passed < std::chrono::seconds(1)) return;
        const bool is_known = m_since != Clock::time_point{};
        m_per_second = is_known && step > m_step ? static_cast<double>(step - m_step) / std::chrono::duration<double>(passed).count() : 0;
        if (is_known) m_over = passed;
        m_since = now;
        m_step = step;
    }
    /// 0 where nothing was told of for long.
    [[nodiscard]] double per_second(Clock::time_point now) const { return is_told(now) ? m_per_second : 0; }
    /// Whether the worker has lately told how far it is: within ten seconds, or three times what its last steps took.
    [[nodiscard]] bool is_told(Clock::time_point now) const { return now - m_told <= std::max<Clock::duration>(std::chrono::seconds(10), 3 * m_over); }

  private:
    Clock::time_point m_since{}, m_told{};
    Clock::duration m_over{};
    std::uint64_t m_step = 0;
    double m_per_second = 0;
};

}  // namespace weave::simd
