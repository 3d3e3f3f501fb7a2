#include <simd/daemon/crew.hpp>

#include <weave/core/log.hpp>

#include <algorithm>
#include <set>
#include <simd/link/error_form.hpp>
#include <utility>

namespace weave::simd {

namespace {

/// What one may take that still plans, of what all may: two plan at once, and most of it is for those that compute.
std::uint64_t planning_bytes(std::uint64_t memory_bytes) {
    return std::max(std::uint64_t{2} << 30, memory_bytes / 8);
}

}  // namespace

Crew::Crew(std::mutex& lock, const Rules& rules)
    : m_lock(lock), m_rules(rules), m_room(rules.memory_bytes),
      m_turns(rules.turns, {[this](Id id, std::size_t threads) { tell_of_turn(id, {{"do", "turn"}, {"threads", threads}}); },
                            [this](Id id) { tell_of_turn(id, {{"do", "yield"}}); }}) {}

Crew::~Crew() {
    std::vector<std::unique_ptr<WorkerProcess>> processes;
    {
        const std::lock_guard lock(m_lock);
        const std::lock_guard links(m_links_lock);
        m_links.clear();
        for (auto& [id, member] : m_members) {
            member.task = nullptr;
            if (member.process) processes.push_back(std::move(member.process));
        }
        m_members.clear();
    }
    processes.clear();  // whose threads want the lock
    bury();
}

Crew::Id Crew::hire(Task& task, const std::string& person, bool is_job) {
    Member& member = m_members[++m_last];
    member.task = &task;
    member.person = person;
    member.is_job = is_job;
    m_to_start.push_back(m_last);
    return m_last;
}

/// How long it has been planning; nothing where it is not.
std::optional<Crew::Clock::duration> Crew::planning_for(const Member& member, Clock::time_point now) const {
    if (!member.process || member.is_admitted) return {};
    return now - member.started;
}

/// Those that wait to be started, the first first, but for people who have one that plans for long already.
void Crew::start_some(Clock::time_point now) {
    std::size_t planning = 0;
    std::set<std::string> slow;
    for (const auto& [id, member] : m_members) {
        const auto time = planning_for(member, now);
        if (time && *time > m_rules.planning_patience) slow.insert(member.person);
        else if (time) ++planning;
    }
    std::deque<Id> later;  // a start that fails may add to the list
    for (const Id id : std::exchange(m_to_start, {})) {
        const auto found = m_members.find(id);
        if (found == m_members.end()) continue;
        if (planning >= m_rules.planning_at_once || slow.contains(found->second.person)) {
            later.push_back(id);
            continue;
        }
        ++planning;
        start(id, found->second);
    }
    m_to_start.insert(m_to_start.begin(), later.begin(), later.end());
}

void Crew::start(Id id, Member& member) {
    WorkOrder order = member.task->order();
    order.backend = m_rules.backend;
    order.planning_bytes = planning_bytes(m_rules.memory_bytes);
    m_turns.add(id, member.person, member.is_job);  // before its thread may hear of a turn
    auto process = WorkerProcess::start(m_rules.program, to_json(order),
                                        {[this, id](LinkMessage message) { heard(id, std::move(message)); },
                                         [this, id](std::string how) { lost(id, std::move(how)); }});
    if (process) {
        member.process = std::move(*process);
        member.started = Clock::now();
        const std::lock_guard links(m_links_lock);  // it gets no turn before it is admitted, which takes the daemon's lock
        m_links[id] = &member.process->link();
        return;
    }
    Task& task = *member.task;
    m_turns.remove(id, Clock::now());
    m_members.erase(id);
    task.ended({"could not be started", process.error(), false});
}

/// A worker that somebody still waits for; null: none.
Crew::Member* Crew::served(Id id) {
    const auto found = m_members.find(id);
    return found == m_members.end() || found->second.task == nullptr ? nullptr : &found->second;
}

void Crew::heard(Id id, LinkMessage message) {
    try {
        if (!message.is_frame) return heard_words(id, Json::parse(message.bytes));
        const std::lock_guard lock(m_lock);
        if (Member* const member = served(id)) member->task->shown(std::move(message.bytes));
    } catch (const std::exception& fault) {  // what is not as a worker of this program writes it
        log(LogLevel::warning, std::string("a worker said what no worker says, and is ended: ") + fault.what());
        const std::lock_guard lock(m_lock);
        kill(id);
    }
}

void Crew::heard_words(Id id, const Json& message) {
    const std::string what = message.at("say");
    if (heard_of_turn(id, what, message)) return;
    const std::lock_guard lock(m_lock);
    if (Member* const member = served(id)) obey(*member, what, message);
}

/// Without the daemon's lock: whoever has it may wait for the disk, and the next one is to compute meanwhile.
bool Crew::heard_of_turn(Id id, const std::string& what, const Json& message) {
    if (what == "turn_over") return m_turns.over(id, Clock::now()), true;
    if (what != "turn") return false;
    if (message.at("again") == true) m_turns.again(id, Clock::now());
    else m_turns.want(id, Clock::now());
    return true;
}

void Crew::tell_of_turn(Id id, const Json& message) {
    const std::lock_guard lock(m_links_lock);
    const auto found = m_links.find(id);
    if (found != m_links.end()) static_cast<void>(found->second->post(message));  // the thread that listens finds out that it is gone
}

void Crew::obey(Member& member, const std::string& what, const Json& message) {
    if (what == "planned") {
        member.task->planned(message);
    } else if (what == "failed") {
        member.end.failure = error_from(message.at("error"));
        member.end.is_final = message.at("is_final");
    } else {
        member.task->said(what, message);
    }
}

void Crew::lost(Id id, std::string how) {
    const std::lock_guard lock(m_lock);
    const auto found = m_members.find(id);
    if (found == m_members.end()) return;
    Member member = std::move(found->second);
    m_members.erase(found);
    {
        const std::lock_guard links(m_links_lock);
        m_links.erase(id);
    }
    m_turns.remove(id, Clock::now());
    m_room.give_back(id);
    m_dead.push_back(std::move(member.process));
    member.end.how = std::move(how);
    if (member.task != nullptr) member.task->ended(member.end);
}

bool Crew::admit(Id id, std::uint64_t bytes, Json also) {
    const auto found = m_members.find(id);
    if (found == m_members.end() || !m_room.take(id, bytes)) return false;
    found->second.is_admitted = true;
    // Estimates err. What takes far more than its own must not take that of others.
    // A device's driver takes memory of the process too, and fails without it; then the processor goes on.
    constexpr std::uint64_t twice = 2, spare = 256U << 20U, for_driver = 1024U << 20U;
    also["do"] = "admitted";
    also["bytes"] = twice * bytes + spare + (m_rules.backend == "cpu" ? 0 : for_driver);
    post(id, also);
    return true;
}

void Crew::post(Id id, const Json& message) {
    const auto found = m_members.find(id);
    if (found == m_members.end() || !found->second.process) return;
    static_cast<void>(found->second.process->link().post(message));  // the thread that listens finds out that it is gone
}

void Crew::ask_to_end(Id id, bool with_report) {
    const auto found = m_members.find(id);
    if (found == m_members.end()) return;
    found->second.asked_to_end = Clock::now();
    post(id, {{"do", "finish"}, {"with_report", with_report}});
}

void Crew::kill(Id id) {
    const auto found = m_members.find(id);
    if (found != m_members.end() && found->second.process) found->second.process->kill();
}

void Crew::dismiss(Id id) {
    const auto found = m_members.find(id);
    if (found == m_members.end()) return;
    found->second.task = nullptr;
    if (found->second.process) return found->second.process->kill();
    std::erase(m_to_start, id);
    m_members.erase(found);
}

void Crew::tick(Clock::time_point now) {
    start_some(now);
    m_turns.tick(now);
    end_stuck(now);
}

void Crew::end_stuck(Clock::time_point now) {
    for (auto& [id, member] : m_members) {
        if (member.end.failure || !member.process) continue;
        member.end.failure = why_stuck(id, member, now);
        if (!member.end.failure) continue;
        member.end.is_final = planning_for(member, now).has_value();  // it would plan as long again
        kill(id);
    }
}

std::optional<Error> Crew::why_stuck(Id id, const Member& member, Clock::time_point now) const {
    const std::string time = " for " + std::to_string(m_rules.stall.count()) + " s";
    const auto planning = planning_for(member, now);
    if (planning && *planning >= m_rules.stall)
        return Error{ErrorCode::refused, "it was being planned" + time + ", as long as anything may: simulate a part of it", "simulation"};
    const auto kept = m_turns.kept_since_asked(id, now);
    if (kept && *kept >= m_rules.stall) return system_fault("it no longer answered" + time);
    const auto turn = m_turns.turn_for(id, now);
    const bool is_to_speak = (turn && *turn >= m_rules.stall) || (member.asked_to_end && now - *member.asked_to_end >= m_rules.stall);
    if (is_to_speak && member.process->silent_for(now) >= m_rules.stall) return system_fault("it said nothing" + time);
    return {};
}

void Crew::bury() {
    std::vector<std::unique_ptr<WorkerProcess>> dead;
    {
        const std::lock_guard lock(m_lock);
        dead.swap(m_dead);
    }
    dead.clear();  // joins their threads, which may still be about to let go of the lock
}

std::optional<pid_t> Crew::process(Id id) const {
    const auto found = m_members.find(id);
    if (found == m_members.end() || !found->second.process) return {};
    return found->second.process->id();
}

std::uint64_t Crew::memory_bytes(Id id) const {
    const auto found = m_members.find(id);
    return found == m_members.end() || !found->second.process ? 0 : found->second.process->memory_bytes();
}

}  // namespace weave::simd
