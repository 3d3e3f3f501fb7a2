#include <simd/worker/inbox.hpp>

#include <simd/worker/memory.hpp>
#include <utility>

namespace weave::simd {

Inbox::Inbox(Link& link) : m_link(link), m_thread([this] { read(); }) {}

Inbox::~Inbox() {
    m_link.stop_receiving();
    m_thread.join();
}

void Inbox::begin(const WorkOrder& order) {
    const std::lock_guard lock(m_mutex);
    m_runs = order.runs || order.is_job;
    m_pause_at = order.pause_at;
    m_changes.insert(m_changes.begin(), order.changes.begin(), order.changes.end());
}

void Inbox::read() {
    while (true) {
        const auto message = m_link.receive();
        const std::lock_guard lock(m_mutex);
        m_news = true;
        if (!message || !*message) {
            m_finish = Finish::gone;
            m_came.notify_all();
            return;
        }
        try {
            obey(Json::parse((*message)->bytes));
        } catch (const std::exception&) {  // a daemon that speaks another language than this program
            m_finish = Finish::gone;
        }
        m_came.notify_all();
    }
}

void Inbox::obey(const Json& message) {
    const std::string what = message.at("do");
    if (what == "admitted") {
        m_admitted = message;
        static_cast<void>(limit_memory(message.at("bytes").get<std::uint64_t>()));  // unlimited it may go on as well
    } else if (what == "go_on") {
        m_runs = true;
        m_pause_at.reset();
        m_steps.reset();
        if (!message.at("steps").is_null()) m_steps = Steps{message.at("steps").get<std::uint64_t>(), message.at("id").get<std::uint64_t>()};
    } else if (what == "pause") {
        m_runs = false;
        m_steps.reset();
    } else if (what == "change") {
        auto change = journaled_change_from(message.at("change"));
        if (change) m_changes.push_back(std::move(*change));
    } else if (what == "turn") {
        m_turn = message.at("threads").get<std::size_t>();
        m_must_yield = false;
    } else if (what == "yield") {
        m_must_yield = true;
    } else if (what == "frames") {
        const double wanted = message.at("per_second");
        m_newly_watched = m_newly_watched || (wanted > 0 && m_frames_per_second <= 0);
        m_frames_per_second = wanted;
    } else if (what == "checkpoint" || what == "yarns") {
        m_requests.push_back(message);
    } else if (what == "finish") {
        m_finish = message.at("with_report") == true ? Finish::report : Finish::keep;
    }
}

void Inbox::wait(std::optional<Clock::time_point> until) {
    std::unique_lock lock(m_mutex);
    const auto has_come = [this] { return m_news; };
    if (until) m_came.wait_until(lock, *until, has_come);
    else m_came.wait(lock, has_come);
    m_news = false;
}

Finish Inbox::finish() {
    const std::lock_guard lock(m_mutex);
    return m_finish;
}

std::optional<Json> Inbox::admitted() {
    const std::lock_guard lock(m_mutex);
    return m_admitted;
}

bool Inbox::goes_on(std::uint64_t step) {
    std::optional<Steps> asked;
    bool goes_on = false;
    {
        const std::lock_guard lock(m_mutex);
        asked = std::exchange(m_steps, {});
        if (asked) m_pause_at = step + asked->count;
        goes_on = m_runs && (!m_pause_at || step < *m_pause_at);
    }
    if (asked) static_cast<void>(m_link.send(Json{{"say", "pauses_at"}, {"step", step + asked->count}, {"id", asked->id}}));
    return goes_on;
}

bool Inbox::change_is_due(std::uint64_t step) {
    const std::lock_guard lock(m_mutex);
    return !m_changes.empty() && m_changes.front().step.value_or(step) <= step;
}

std::optional<JournaledChange> Inbox::take_change(std::uint64_t step) {
    const std::lock_guard lock(m_mutex);
    if (m_changes.empty() || m_changes.front().step.value_or(step) > step) return {};
    JournaledChange change = std::move(m_changes.front());
    m_changes.pop_front();
    return change;
}

void Inbox::skip_changes(std::uint64_t up_to) {
    const std::lock_guard lock(m_mutex);
    while (!m_changes.empty() && m_changes.front().number <= up_to) m_changes.pop_front();
}

std::optional<std::size_t> Inbox::turn() {
    const std::lock_guard lock(m_mutex);
    return m_turn;
}

bool Inbox::must_yield() {
    const std::lock_guard lock(m_mutex);
    return m_must_yield;
}

void Inbox::turn_given_back() {
    const std::lock_guard lock(m_mutex);
    m_turn.reset();
    m_must_yield = false;
}

std::vector<Json> Inbox::take_requests() {
    const std::lock_guard lock(m_mutex);
    return std::exchange(m_requests, {});
}

double Inbox::frames_per_second() {
    const std::lock_guard lock(m_mutex);
    return m_frames_per_second;
}

bool Inbox::take_newly_watched() {
    const std::lock_guard lock(m_mutex);
    return std::exchange(m_newly_watched, false);
}

}  // namespace weave::simd
