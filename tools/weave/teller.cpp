#include "teller.hpp"

#include "interrupt.hpp"

#include <weave/core/text.hpp>

#include <algorithm>
#include <cstdio>
#include <unistd.h>
#include <utility>

namespace weave::program {

namespace {

/// Nothing before crossings were looked up first.
std::string order_of(std::optional<std::size_t> lost_crossings) {
    if (!lost_crossings) return "";
    return *lost_crossings == 0 ? "order kept, " : counted(*lost_crossings, "crossing") + " out of order, ";
}

std::string some_seconds(double seconds) {
    char text[40];
    std::snprintf(text, sizeof text, "some %.*f s", seconds < 10 ? 1 : 0, seconds);
    return text;
}

std::string so_far(double seconds) {
    char text[40];
    std::snprintf(text, sizeof text, "so far %.1f s", seconds);
    return text;
}

}  // namespace

Teller::Teller(double goal) : m_goal(goal), m_terminal(::isatty(STDERR_FILENO) == 1), m_pace(goal) {}

void Teller::turn_to(std::string what, std::optional<double> goal) {
    m_what = std::move(what);
    m_goal = goal.value_or(m_goal);
    m_pace = sim::Pace(m_goal);
    m_next = std::min(m_next, seconds() + first_after);
}

bool Teller::operator()(const sim::Progress& progress) {
    if (is_due(progress.residual, progress.iteration)) tell_residual(progress.residual, progress.iteration, order_of(progress.lost_crossings), m_pace.seconds_left());
    return !interrupted();
}

void Teller::operator()(const wire::JobState& job) {
    if (job.phase == wire::JobPhase::waiting) {
        if (seconds() < m_next) return;
        const std::string place = job.place ? "place " + std::to_string(*job.place) + " in the queue, " : "";
        const std::string wait = job.wait_s ? "begins in " + some_seconds(*job.wait_s) + ", " : "";
        const std::string batch = job.batch ? on_one_line(*job.batch) + ", " : "";
        return tell("waiting" + m_what + " ... " + place + wait + batch + so_far(seconds()));
    }
    if (is_due(job.residual.value_or(0), job.step)) tell_residual(*job.residual, job.step, order_of(job.lost_crossings), job.left_s ? job.left_s : m_pace.seconds_left());
}

void Teller::note(const std::string& line) {
    end();
    std::fprintf(stderr, "weave: %s\n", line.c_str());
}

void Teller::end() {
    if (m_open) std::fprintf(stderr, "\r\033[K");
    m_open = false;
}

double Teller::seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
}

bool Teller::is_due(double residual, std::size_t iteration) {
    if (iteration < m_iteration) m_pace = sim::Pace(m_goal);  // another run
    m_iteration = iteration;
    if (!(residual > 0)) return false;
    const double now = seconds();
    m_pace.add(now, residual);
    return now >= m_next;
}

void Teller::tell(const std::string& line) {
    std::fprintf(stderr, "%s%s%s", m_terminal ? "\r" : "", line.c_str(), m_terminal ? "\033[K" : "\n");
    m_open = m_terminal;
    m_next = seconds() + (m_terminal ? 0.2 : 10);
}

void Teller::tell_residual(double residual, std::size_t iteration, const std::string& order, std::optional<double> left) {
    char line[160];
    std::snprintf(line, sizeof line, " ... residual %.2e (goal %.0e) after %zu steps, ", residual, m_goal, iteration);
    tell("relaxing" + m_what + line + order + (left ? "to go " + some_seconds(*left) + ", " : "") + so_far(seconds()));
}

}  // namespace weave::program
