#pragma once

#include <weave/sim/pace.hpp>
#include <weave/sim/relax.hpp>
#include <weave/wire/message.hpp>

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace weave::program {

/// Tells how far a relaxation has come and how long it may still take: on a terminal in one line, else after a second
/// and then once in ten.
class Teller {
  public:
    explicit Teller(double goal);

    /// What relaxes from now on, such as ` the whole cloth`, and to which residual if not the same as before.
    void turn_to(std::string what, std::optional<double> goal = {});

    /// Whether to go on.
    bool operator()(const sim::Progress& progress);
    /// The same of a job on a server, which estimates by itself how long it takes.
    void operator()(const wire::JobState& job);
    /// A line beside the progress, such as a connection that broke.
    void note(const std::string& line);
    void end();

  private:
    [[nodiscard]] double seconds() const;
    /// Remembers the residual; whether to tell of it now.
    bool is_due(double residual, std::size_t iteration);
    void tell(const std::string& line);
    void tell_residual(double residual, std::size_t iteration, const std::string& order, std::optional<double> left);

    static constexpr double first_after = 1;

    double m_goal;
    std::string m_what;
    bool m_terminal, m_open = false;
    double m_next = first_after;
    std::size_t m_iteration = 0;
    sim::Pace m_pace;
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

}  // namespace weave::program
