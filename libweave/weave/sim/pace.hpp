#pragma once

#include <optional>
#include <vector>

namespace weave::sim {

/// How long a relaxation may still take, by how fast its residual fell in the last third of the time.
class Pace {
  public:
    explicit Pace(double goal) : m_goal(goal) {}

    /// The residual that it has come to; one far above the last begins anew.
    void add(double seconds, double residual);
    /// Seconds from the last residual to the goal; nothing while it does not fall.
    [[nodiscard]] std::optional<double> seconds_left() const;

  private:
    struct Past {
        double seconds, log_residual;
    };
    double m_goal;
    std::vector<Past> m_past;
};

}  // namespace weave::sim
