#include <simd/daemon/turns.hpp>

#include <algorithm>

namespace weave::simd {

namespace {

constexpr double session_weight = 4, job_weight = 1;

double seconds(Turns::Clock::duration time) {
    return std::chrono::duration<double>(time).count();
}

}  // namespace

void Turns::add(Id id, const std::string& person, bool is_job) {
    const std::lock_guard lock(m_mutex);
    Worker& worker = m_workers[id];
    worker.person = person;
    worker.is_job = is_job;
    ++m_people[person].workers;
}

void Turns::want(Id id, Clock::time_point now) {
    const std::lock_guard lock(m_mutex);
    const auto found = m_workers.find(id);
    if (found == m_workers.end() || found->second.threads > 0 || found->second.wants) return;
    catch_up(found->second, now);
    found->second.wants = true;
    hand_out(now);
}

/// People, and the work of one, begin where the others are that have had least.
void Turns::catch_up(Worker& worker, Clock::time_point now) {
    for (auto& [id, other] : m_workers) {
        if (other.threads > 0) charge(other, now);
    }
    double least_person = -1, least_share = -1;
    for (const auto& [id, other] : m_workers) {
        if (&other == &worker || (!other.wants && other.threads == 0)) continue;
        const double spent = m_people[other.person].spent;
        if (other.person != worker.person && (least_person < 0 || spent < least_person)) least_person = spent;
        if (other.person == worker.person && (least_share < 0 || other.share < least_share)) least_share = other.share;
    }
    const bool is_alone = least_share < 0;  // of its person: nothing else of theirs computes
    Person& person = m_people[worker.person];
    if (is_alone && least_person >= 0) person.spent = std::max(person.spent, least_person);
    if (!is_alone) worker.share = std::max(worker.share, least_share);
}

void Turns::charge(Worker& worker, Clock::time_point now) {
    const double had = seconds(now - worker.charged) * static_cast<double>(worker.threads);
    worker.charged = now;
    worker.spent += had;
    worker.share += had / (worker.is_job ? job_weight : session_weight);
    m_people[worker.person].spent += had;
}

void Turns::take_back(Worker& worker, Clock::time_point now) {
    if (worker.threads > 0) charge(worker, now);
    worker.threads = 0;
    worker.wants = worker.is_asked_back = worker.is_overdue = false;
}

void Turns::over(Id id, Clock::time_point now) {
    const std::lock_guard lock(m_mutex);
    const auto found = m_workers.find(id);
    if (found == m_workers.end()) return;
    take_back(found->second, now);
    hand_out(now);
}

void Turns::again(Id id, Clock::time_point now) {
    const std::lock_guard lock(m_mutex);
    const auto found = m_workers.find(id);
    if (found == m_workers.end()) return;
    take_back(found->second, now);
    found->second.wants = true;
    hand_out(now);
}

void Turns::remove(Id id, Clock::time_point now) {
    const std::lock_guard lock(m_mutex);
    const auto found = m_workers.find(id);
    if (found == m_workers.end()) return;
    take_back(found->second, now);  // what it had counts for its person
    const std::string person = found->second.person;
    m_workers.erase(found);
    if (--m_people[person].workers == 0) m_people.erase(person);
    hand_out(now);
}

std::size_t Turns::waiting() const {
    const std::lock_guard lock(m_mutex);
    return count_waiting();
}

std::size_t Turns::count_waiting() const {
    return static_cast<std::size_t>(std::ranges::count_if(m_workers, [](const auto& entry) { return entry.second.wants; }));
}

std::size_t Turns::threads_in_use() const {
    std::size_t threads = 0;
    for (const auto& [id, worker] : m_workers) threads += worker.is_overdue ? 0 : worker.threads;
    return threads;
}

std::size_t Turns::threads_of_a_turn() const {
    std::size_t active = 0;
    for (const auto& [id, worker] : m_workers) active += worker.wants || (worker.threads > 0 && !worker.is_overdue) ? 1 : 0;
    return std::max<std::size_t>(1, m_rules.threads / std::max<std::size_t>(1, active));
}

/// Of the person who has had least, what has had least for its weight.
Turns::Worker* Turns::next(Id& id) {
    Worker* best = nullptr;
    for (auto& [candidate, worker] : m_workers) {
        if (!worker.wants) continue;
        if (best != nullptr) {
            const double mine = m_people[worker.person].spent, theirs = m_people[best->person].spent;
            const bool same = worker.person == best->person;
            if (same ? worker.share >= best->share : mine >= theirs) continue;
        }
        best = &worker;
        id = candidate;
    }
    return best;
}

void Turns::hand_out(Clock::time_point now) {
    while (threads_in_use() < m_rules.threads) {
        Id id = 0;
        const std::size_t threads = std::min(threads_of_a_turn(), m_rules.threads - threads_in_use());
        Worker* const worker = next(id);
        if (worker == nullptr) return;
        worker->wants = worker->is_asked_back = worker->is_overdue = false;
        worker->threads = threads;
        worker->since = worker->charged = now;
        m_tell.give(id, threads);
    }
}

void Turns::tick(Clock::time_point now) {
    const std::lock_guard lock(m_mutex);
    const bool others_wait = count_waiting() > 0;
    for (auto& [id, worker] : m_workers) {
        if (worker.threads == 0) continue;
        if (worker.is_asked_back) {
            worker.is_overdue = worker.is_overdue || now - worker.asked_back > m_rules.patience;
        } else if (others_wait && now - worker.since >= m_rules.quantum) {
            worker.is_asked_back = true;
            worker.asked_back = now;
            m_tell.ask_back(id);
        }
    }
    hand_out(now);
}

std::optional<Turns::Clock::duration> Turns::kept_since_asked(Id id, Clock::time_point now) const {
    const std::lock_guard lock(m_mutex);
    const auto found = m_workers.find(id);
    if (found == m_workers.end() || !found->second.is_asked_back) return {};
    return now - found->second.asked_back;
}

std::optional<Turns::Clock::duration> Turns::turn_for(Id id, Clock::time_point now) const {
    const std::lock_guard lock(m_mutex);
    const auto found = m_workers.find(id);
    if (found == m_workers.end() || found->second.threads == 0) return {};
    return now - found->second.since;
}

double Turns::spent_s(Id id, Clock::time_point now) const {
    const std::lock_guard lock(m_mutex);
    const auto found = m_workers.find(id);
    if (found == m_workers.end()) return 0;
    const Worker& worker = found->second;
    return worker.spent + (worker.threads > 0 ? seconds(now - worker.charged) * static_cast<double>(worker.threads) : 0);
}

}  // namespace weave::simd
