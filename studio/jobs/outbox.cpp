#include <studio/jobs/outbox.hpp>

#include <QMetaObject>
#include <QObject>

#include <algorithm>
#include <utility>

namespace weave::studio {

namespace {

/// A plot shows no more, so a window that does not look for minutes costs no memory.
constexpr std::size_t most_history = 4096;

bool is_state(const Happening& happening) {
    return std::holds_alternative<std::shared_ptr<const Frame>>(happening) ||
           std::holds_alternative<Progress>(happening) ||
           std::holds_alternative<std::shared_ptr<const Yarns>>(happening) ||
           std::holds_alternative<Inspected>(happening);
}

void thin_out(std::vector<ResidualPoint>& history) {
    if (history.size() < most_history) return;
    for (std::size_t k = 0; 2 * k < history.size(); ++k) history[k] = history[2 * k];
    history.resize((history.size() + 1) / 2);
}

/// The curve of residuals has no gaps where progress was not told.
void take_over(std::vector<ResidualPoint>& history, const std::vector<ResidualPoint>& earlier) {
    history.insert(history.begin(), earlier.begin(), earlier.end());
    thin_out(history);
}

}  // namespace

void Outbox::open(QObject* receiver, std::function<void()> deliver) {
    const std::lock_guard lock(m_mutex);
    m_receiver = receiver;
    m_deliver = std::move(deliver);
}

void Outbox::close() {
    const std::lock_guard lock(m_mutex);
    m_receiver = nullptr;
    m_deliver = {};
    m_waiting.clear();
}

void Outbox::forget_older(Happening& newest) {
    if (!is_state(newest)) return;
    const auto older = std::ranges::find(m_waiting, newest.index(), &Happening::index);
    if (older == m_waiting.end()) return;
    if (auto* progress = std::get_if<Progress>(&newest))
        take_over(progress->history, std::get<Progress>(*older).history);
    m_waiting.erase(older);
}

void Outbox::tell(Happening happening) {
    const std::lock_guard lock(m_mutex);
    if (m_receiver == nullptr) return;
    forget_older(happening);
    m_waiting.push_back(std::move(happening));
    if (std::exchange(m_is_called, true)) return;
    QMetaObject::invokeMethod(m_receiver, m_deliver, Qt::QueuedConnection);
}

std::vector<Happening> Outbox::take() {
    const std::lock_guard lock(m_mutex);
    m_is_called = false;
    return std::exchange(m_waiting, {});
}

}  // namespace weave::studio
