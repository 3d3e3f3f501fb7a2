#include <studio/jobs/run_meter.hpp>

#include <utility>

namespace weave::studio {

void RunMeter::aim_at(double goal) {
    if (m_pace && m_now.goal == goal) return;
    m_now.goal = goal;
    m_pace.emplace(goal);
}

void RunMeter::pass_step(std::uint64_t step, double residual) {
    m_now.step = step;
    m_now.residual = residual;
    if (residual > 0) m_now.history.push_back({step, residual});
    if (m_pace) m_pace->add(seconds(), residual);
}

void RunMeter::end_leg(std::uint64_t step, double residual) {
    if (m_now.step != step || m_now.residual != residual) pass_step(step, residual);
}

void RunMeter::go_on() {
    if (!m_since) m_since = Clock::now();
}

void RunMeter::stand() {
    if (!m_since) return;
    m_spent += Clock::now() - *m_since;
    m_since.reset();
}

double RunMeter::seconds() const {
    return std::chrono::duration<double>(m_since ? m_spent + (Clock::now() - *m_since) : m_spent).count();
}

Progress RunMeter::take() {
    Progress told = m_now;
    told.seconds = seconds();
    if (m_pace && told.residual > told.goal) told.seconds_left = m_pace->seconds_left();
    m_now.history.clear();
    return told;
}

}  // namespace weave::studio
