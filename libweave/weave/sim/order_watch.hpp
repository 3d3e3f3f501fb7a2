#pragma once

#include <cstddef>

namespace weave::sim {

/// When crossings are looked up while yarns relax, so that a person may see whether all lie as the card says: at most every
/// two seconds, and for no more than a tenth of the time. Times are seconds since the relaxation began.
class OrderWatch {
  public:
    /// The first look is taken to cost what so many crossings do on a slow machine; each further one what the last cost.
    explicit OrderWatch(std::size_t crossings) : m_cost_s(5e-5 * static_cast<double>(crossings)) {}

    /// Whether a look that costs no more than expected leaves all looks together within their tenth.
    [[nodiscard]] bool is_due(double now_s) const {
        return (m_looks == 0 || now_s - m_last_s >= 2) && m_spent_s + m_cost_s <= share * now_s;
    }
    void looked(double from_s, double to_s) {
        m_cost_s = to_s - from_s;
        m_spent_s += m_cost_s;
        m_last_s = to_s;
        ++m_looks;
    }
    [[nodiscard]] double spent_s() const { return m_spent_s; }

  private:
    static constexpr double share = 0.1;
    double m_cost_s, m_spent_s = 0, m_last_s = 0;
    std::size_t m_looks = 0;
};

}  // namespace weave::sim
