#include <studio/jobs/inbox.hpp>

#include <algorithm>
#include <utility>

namespace weave::studio {

namespace {

void put_over(SystemScene& values, const SystemScene& newer) {
    if (newer.strain) values.strain = newer.strain;
    if (newer.stiffness_scale) values.stiffness_scale = newer.stiffness_scale;
    if (newer.radius_scale) values.radius_scale = newer.radius_scale;
}

/// Whether what waits last now asks for this too.
bool is_taken_in(Order& last, const Order& newer) {
    if (last.index() != newer.index()) return false;
    if (auto* values = std::get_if<wire::Parameters>(&last)) {
        put_over(values->warp, std::get<wire::Parameters>(newer).warp);
        put_over(values->weft, std::get<wire::Parameters>(newer).weft);
        return true;
    }
    if (!std::holds_alternative<wire::Pins>(last) && !std::holds_alternative<wire::Fields>(last))
        return false;
    last = newer;
    return true;
}

}  // namespace

void Inbox::order(Order order) {
    {
        const std::lock_guard lock(m_mutex);
        if (m_orders.empty() || !is_taken_in(m_orders.back(), order)) m_orders.push_back(std::move(order));
    }
    m_came.notify_all();
}

void Inbox::finish(Finish finish) {
    {
        const std::lock_guard lock(m_mutex);
        m_finish = std::max(m_finish, finish);
    }
    m_came.notify_all();
}

Finish Inbox::finish() {
    const std::lock_guard lock(m_mutex);
    return m_finish;
}

std::deque<Order> Inbox::take() {
    const std::lock_guard lock(m_mutex);
    return std::exchange(m_orders, {});
}

void Inbox::wait(std::optional<std::chrono::milliseconds> most) {
    std::unique_lock lock(m_mutex);
    const auto came = [this] { return !m_orders.empty() || m_finish != Finish::no; };
    if (most)
        m_came.wait_for(lock, *most, came);
    else
        m_came.wait(lock, came);
}

}  // namespace weave::studio
