#include <simd/daemon/daemon.hpp>

#include <weave/core/log.hpp>

#include <algorithm>
#include <future>
#include <utility>

namespace weave::simd {

namespace {

constexpr std::chrono::milliseconds tick_time{10};

Error none_such(const char* what, std::uint64_t number) {
    return {ErrorCode::refused, "there is no such " + std::string(what), std::string(what) + " " + std::to_string(number)};
}

}  // namespace

Daemon::Daemon(std::unique_ptr<Store> store, const DaemonSettings& settings)
    : m_settings(settings), m_store(std::move(store)), m_crew(m_lock, settings.crew) {}

Result<std::unique_ptr<Daemon>> Daemon::start(std::unique_ptr<Store> store, const DaemonSettings& settings) {
    std::unique_ptr<Daemon> daemon(new Daemon(std::move(store), settings));
    if (settings.slurm) {
        daemon->m_slurm = std::make_unique<SlurmCrew>(daemon->m_lock, *daemon->m_store, *settings.slurm);
        WEAVE_CHECK_OK(daemon->m_slurm->take_up());
    }
    WEAVE_CHECK_OK(daemon->take_up());
    if (daemon->m_slurm) daemon->m_slurm->work();
    daemon->m_thread = std::thread([&floor = *daemon] { floor.work(); });
    daemon->m_writer = std::thread([&floor = *daemon] { floor.write_events(); });
    return daemon;
}

Daemon::~Daemon() {
    {
        const std::lock_guard lock(m_lock);
        m_ends = true;
    }
    m_wants_writing.notify_all();
    if (m_thread.joinable()) m_thread.join();
    if (m_writer.joinable()) m_writer.join();
    const std::lock_guard lock(m_lock);
    m_sessions.clear();
    m_jobs.clear();
}

Status Daemon::take_up() {
    const std::lock_guard lock(m_lock);
    WEAVE_TRY(const std::vector<KeptSession> sessions, m_store->sessions());
    for (const KeptSession& kept : sessions) {
        WEAVE_TRY(const SessionTask task, m_store->task_of_session(kept.number));
        WEAVE_TRY(const std::vector<KeptChange> journal, m_store->changes(kept.number));
        std::vector<JournaledChange> changes;
        for (const KeptChange& change : journal) {
            auto read = change_from(change.text);
            if (!read) return std::move(read).error().in("the journal of session " + std::to_string(kept.number));
            changes.push_back({change.number, change.request, std::move(*read), change.step, change.flip_told});
        }
        m_sessions.push_back(std::make_unique<Session>(around_session(), kept, task, std::move(changes)));
        WEAVE_CHECK_OK(m_sessions.back()->remember_events());
        m_sessions.back()->take_up();
    }
    WEAVE_TRY(const std::vector<KeptJob> jobs, m_store->jobs());
    for (const KeptJob& kept : jobs) {
        m_jobs.push_back(std::make_unique<Job>(around_job(), kept));
        m_jobs.back()->take_up();
    }
    return {};
}

Session::Surroundings Daemon::around_session() {
    return {*m_store, m_crew, m_settings.folder / "sessions", [this] {
                m_has_to_write = true;
                m_wants_writing.notify_all();
            }, [this] { return expected_wait_s(); }};
}

std::optional<double> Daemon::expected_wait_s() const {
    std::optional<double> least;
    const auto take = [&](double seconds) { least = std::max(0.0, std::min(least.value_or(seconds), seconds)); };
    for (const auto& job : m_jobs) {
        if (const auto left = job->left_s(); left && job->is_at_work()) take(*left);
    }
    for (const auto& session : m_sessions) {
        const auto alone = session->has_ended() || !session->is_accepted() ? std::nullopt : session->left_alone();
        if (alone) take(std::chrono::duration<double>(m_settings.expire - *alone).count());
    }
    return least;
}

Job::Surroundings Daemon::around_job() {
    return {*m_store, m_crew, m_slurm.get(), m_settings.folder / "jobs", m_settings.sign, [this](const Job& job) { job_ended(job); }};
}

// ---- Its own thread ----

void Daemon::work() {
    while (true) {
        {
            const std::lock_guard lock(m_lock);
            if (m_ends) return;
            tick(Clock::now());
        }
        m_crew.bury();
        std::this_thread::sleep_for(tick_time);
    }
}

/// Writes what sessions have to tell, without the lock: a disk takes its time to flush, and nobody is to wait for that who has
/// nothing to write.
void Daemon::write_events() {
    constexpr std::chrono::milliseconds until_another_try{500};
    std::unique_lock lock(m_lock);
    while (true) {
        m_wants_writing.wait_for(lock, until_another_try, [this] { return m_has_to_write || m_ends; });
        if (m_ends) return;
        m_has_to_write = false;
        std::vector<Session::Writing> all;
        for (const auto& session : m_sessions) {
            if (auto writing = session->is_accepted() ? session->to_write() : std::nullopt) all.push_back(std::move(*writing));
        }
        for (const Session::Writing& writing : all) {
            lock.unlock();
            Status written = writing.events.empty() ? Status() : m_store->add_events(writing.number, writing.events, writing.dated);
            if (written && writing.state) written = m_store->change_session(writing.number, *writing.state);
            if (written && writing.acknowledged) written = m_store->acknowledge(writing.number, *writing.acknowledged);
            lock.lock();
            const auto session = std::ranges::find(m_sessions, writing.number, [](const auto& one) { return one->number(); });
            if (session == m_sessions.end()) continue;  // forgotten meanwhile
            const std::string trouble = written ? std::string() : written.error().text();
            if (trouble != std::exchange(m_write_trouble, trouble)) {  // told once, not at every try
                log(LogLevel::warning, written ? "the disk takes what sessions have to tell again"
                                               : "what sessions have to tell waits for the disk: " + trouble);
            }
            if (written) (*session)->written(writing);
        }
    }
}

void Daemon::tick(Clock::time_point now) {
    m_crew.tick(now);
    for (const auto& session : m_sessions) session->tick(now, m_settings.expire);
    for (const auto& job : m_jobs) job->tick();
    for (const ClientPtr& client : m_clients) tell_ended_jobs(client);
    if (!m_is_stopping) begin_jobs();
    forget_what_is_over();
    if (now - m_jobs_told < std::chrono::seconds(1)) return;
    m_jobs_told = now;
    send_away(now);
    tell_jobs();
    count();
}

void Daemon::forget_what_is_over() {
    std::erase_if(m_sessions, [&](const std::unique_ptr<Session>& session) {
        if (!session->is_over()) return false;
        if (session->is_accepted()) {
            if (const Status forgotten = m_store->forget_session(session->number()); !forgotten) return false;  // tried again
            std::error_code ignored;
            std::filesystem::remove_all(m_settings.folder / "sessions" / std::to_string(session->number()), ignored);
        }
        return true;
    });
}

/// Those whose right has ended, and those that came and say nothing.
void Daemon::send_away(Clock::time_point now) {
    constexpr std::chrono::seconds until_hello{10};
    for (const ClientPtr& client : m_clients) {
        if (!client->may_stay()) client->close(1008, "the token has ended");
        else if (!client->is_greeted && now - client->opened() > until_hello) client->close(1002, "no hello came");
    }
}

void Daemon::tell_jobs() {
    const Outlook outlook = this->outlook();
    for (const auto& job : m_jobs) {
        if (job->is_over()) continue;
        const wire::JobState state = told_state(*job, outlook);
        for (const ClientPtr& client : m_clients) {
            if (client->is_greeted && client->person() == job->person()) client->tell(wire::JobProgress{state});
        }
    }
}

void Daemon::count() {
    if (!m_settings.metrics) return;
    net::Metrics& metrics = *m_settings.metrics;
    std::size_t running = 0, computing = 0;
    for (const auto& session : m_sessions) running += session->is_accepted() && !session->has_ended() ? 1 : 0;
    for (const auto& job : m_jobs) computing += job->is_at_work() ? 1 : 0;
    metrics.gauge("simd_sessions", "Sessions that have not ended").set(static_cast<double>(running));
    metrics.gauge("simd_jobs_at_work", "Jobs that have a worker").set(static_cast<double>(computing));
    metrics.gauge("simd_jobs_waiting", "Jobs in the queue").set(static_cast<double>(queue().size()));
    if (m_slurm) metrics.gauge("simd_jobs_in_slurm", "Jobs that Slurm has").set(static_cast<double>(m_slurm->size()));
    metrics.gauge("simd_workers", "Worker processes").set(static_cast<double>(m_crew.size()));
    metrics.gauge("simd_memory_promised_bytes", "Memory that workers were promised").set(static_cast<double>(m_crew.room().taken()));
    metrics.gauge("simd_memory_bytes", "Memory for all workers together").set(static_cast<double>(m_crew.room().whole()));
    metrics.gauge("simd_clients", "Open connections").set(static_cast<double>(m_clients.size()));
    metrics.gauge("simd_turns_waiting", "Workers that wait to compute").set(static_cast<double>(m_crew.turns().waiting()));
}

// ---- The queue ----

/// Waiting jobs in the order in which they begin: everybody's first, then everybody's second …, each the oldest first; who has
/// jobs at work already comes as much later.
std::vector<Job*> Daemon::queue() {
    std::map<std::string, std::size_t> had;
    for (const auto& job : m_jobs) had[job->person()] += job->is_at_work() && !job->is_over() ? 1 : 0;
    std::vector<std::pair<std::pair<std::size_t, std::uint64_t>, Job*>> order;
    for (const auto& job : m_jobs) {
        if (job->waits()) order.push_back({{had[job->person()]++, job->number()}, job.get()});
    }
    std::ranges::sort(order, {}, [](const auto& entry) { return entry.first; });
    std::vector<Job*> queue;
    for (const auto& [place, job] : order) queue.push_back(job);
    return queue;
}

void Daemon::begin_jobs() {
    constexpr std::chrono::minutes let_pass{10};
    if (m_slurm) return hand_over_jobs();
    auto at_work = static_cast<std::size_t>(std::ranges::count_if(m_jobs, [](const auto& job) { return job->is_at_work() && !job->is_over(); }));
    if (at_work >= m_settings.jobs_at_once) return;
    for (Job* const job : queue()) {
        if (job->expected() > m_crew.room().left()) {
            if (job->waited() < let_pass) continue;
            return;  // others have gone before it long enough
        }
        job->begin();
        if (++at_work >= m_settings.jobs_at_once) return;
    }
}

/// Slurm has a queue of its own.
void Daemon::hand_over_jobs() {
    std::size_t room = m_slurm->room();
    if (room == 0) return;
    for (Job* const job : queue()) {
        job->begin();
        if (--room == 0) return;
    }
}

/// Found out once for all jobs that are told of: there may be thousands.
Daemon::Outlook Daemon::outlook() {
    Outlook outlook;
    for (const Job* const job : queue()) outlook.places.emplace(job, outlook.places.size() + 1);
    for (const auto& job : m_jobs) {
        const auto left_s = job->left_s();
        if (left_s) outlook.first_s = std::min(outlook.first_s.value_or(*left_s), *left_s);
    }
    double usual = 0;
    for (const double seconds : m_job_seconds) usual += seconds / static_cast<double>(m_job_seconds.size());
    const auto works = [](const auto& job) { return job->is_at_work() && !job->is_over(); };
    const auto at_work = static_cast<std::size_t>(std::ranges::count_if(m_jobs, works));
    if (!outlook.first_s && !m_job_seconds.empty()) outlook.first_s = at_work < m_settings.jobs_at_once ? 0 : usual / 2;  // in the middle of it
    outlook.each_s = usual / static_cast<double>(std::max<std::size_t>(1, m_settings.jobs_at_once));
    return outlook;
}

std::optional<double> Daemon::Outlook::wait_s(std::size_t place) const {
    if (!first_s) return {};
    return *first_s + each_s * static_cast<double>(place - 1);
}

wire::JobState Daemon::told_state(const Job& job, const Outlook& outlook) {
    wire::JobState state = job.state();
    const auto place = outlook.places.find(&job);
    if (place == outlook.places.end()) return state;
    state.place = place->second;
    state.wait_s = outlook.wait_s(place->second);
    return state;
}

void Daemon::job_ended(const Job& job) {
    constexpr std::size_t recent = 20;
    if (job.phase() == wire::JobPhase::done) {
        m_job_seconds.push_back(job.ending().report.value("seconds", 0.0));
        if (m_job_seconds.size() > recent) m_job_seconds.erase(m_job_seconds.begin());
    }
    for (const ClientPtr& client : m_clients) {
        if (client->is_greeted && client->person() == job.person()) client->untold_jobs.push_back(job.number());
    }
}

/// As fast as the client takes it.
void Daemon::tell_ended_jobs(const ClientPtr& client) {
    while (!client->untold_jobs.empty() && !client->is_full()) {
        const Job* const job = job_of(client->person(), client->untold_jobs.front());
        client->untold_jobs.pop_front();
        if (job != nullptr && job->is_over()) client->tell(job->ending());
    }
}

// ---- Who is connected ----

void Daemon::enter(const ClientPtr& client) {
    const std::lock_guard lock(m_lock);
    m_clients.insert(client);
}

void Daemon::greet(const ClientPtr& client) {
    const std::lock_guard lock(m_lock);
    client->is_greeted = true;
    for (const auto& job : m_jobs) {
        if (job->is_over() && job->person() == client->person()) client->untold_jobs.push_back(job->number());
    }
    tell_ended_jobs(client);
}

void Daemon::leave(const ClientPtr& client) {
    const std::lock_guard lock(m_lock);
    m_clients.erase(client);
    for (const auto& session : m_sessions) session->leave(client);
}

Session* Daemon::session_of(const std::string& person, std::uint64_t number) {
    for (const auto& session : m_sessions) {
        if (session->is_accepted() && session->number() == number && session->person() == person && !session->is_over()) return session.get();
    }
    return nullptr;
}

Job* Daemon::job_of(const std::string& person, std::uint64_t number) {
    for (const auto& job : m_jobs) {
        if (job->number() == number && job->person() == person) return job.get();
    }
    return nullptr;
}

// ---- Files ----

Result<std::filesystem::path> Daemon::session_yarns(const std::string& person, std::uint64_t number) {
    constexpr std::chrono::seconds patience{60};
    auto promise = std::make_shared<std::promise<Result<std::filesystem::path>>>();
    std::future<Result<std::filesystem::path>> written = promise->get_future();
    {
        const std::lock_guard lock(m_lock);
        Session* const session = session_of(person, number);
        if (session == nullptr) return none_such("session", number);
        session->write_yarns([promise](Result<std::filesystem::path> path) { promise->set_value(std::move(path)); });
    }
    if (written.wait_for(patience) != std::future_status::ready)
        return Error{ErrorCode::refused, "it is busy with a long step: try again", "session " + std::to_string(number)};
    return written.get();
}

Result<std::filesystem::path> Daemon::job_yarns(const std::string& person, std::uint64_t number) {
    const std::lock_guard lock(m_lock);
    Job* const job = job_of(person, number);
    if (job == nullptr) return none_such("job", number);
    if (const auto path = job->yarns()) return *path;
    return Error{ErrorCode::refused, job->is_over() ? "it has ended without yarns" : "it has not ended yet", "job " + std::to_string(number)};
}

Result<std::string> Daemon::job_evidence(const std::string& person, std::uint64_t number) {
    const std::lock_guard lock(m_lock);
    Job* const job = job_of(person, number);
    if (job == nullptr) return none_such("job", number);
    if (job->evidence()) return *job->evidence();
    return Error{ErrorCode::refused, job->is_over() ? "this machine has signed no evidence for it" : "it has not ended yet", "job " + std::to_string(number)};
}

// ---- What can be seen of it ----

Json Daemon::status(bool with_names) {
    const std::lock_guard lock(m_lock);
    Json sessions = Json::array(), jobs = Json::array();
    for (const auto& session : m_sessions) {
        if (session->is_accepted() && !session->has_ended()) sessions.push_back(session->status(with_names));
    }
    for (const auto& job : m_jobs) {
        if (!job->is_over()) jobs.push_back(job->status(with_names));
    }
    return {{"up_s", std::chrono::duration<double>(Clock::now() - m_began).count()},
            {"threads", m_settings.crew.turns.threads},
            {"memory", {{"bytes", m_crew.room().whole()}, {"promised_bytes", m_crew.room().taken()}}},
            {"clients", m_clients.size()},
            {"turns_waiting", m_crew.turns().waiting()},
            {"sessions", std::move(sessions)},
            {"jobs", std::move(jobs)}};
}

std::vector<net::HealthCheck> Daemon::health() {
    std::vector<net::HealthCheck> checks;
    if (m_slurm) checks.push_back({"slurm", [this] { return m_slurm->trouble(); }});
    checks.insert(checks.end(),
           {{"store", [this] { return m_store->last_write(); }},
            {"disk", [this]() -> Status {
                 constexpr std::uintmax_t least = 64U << 20U;
                 std::error_code code;
                 const auto space = std::filesystem::space(m_settings.folder, code);
                 if (code || space.available < least) return system_fault("there is hardly any room left on the disk", m_settings.folder.string());
                 return {};
             }}});
    return checks;
}

void Daemon::stop(std::chrono::milliseconds patience) {
    {
        const std::lock_guard lock(m_lock);
        m_is_stopping = true;
        for (const auto& session : m_sessions) session->put_away();
        for (const auto& job : m_jobs) job->put_away();
    }
    const Clock::time_point late = Clock::now() + patience;
    while (Clock::now() < late) {
        {
            const std::lock_guard lock(m_lock);
            const auto away = [](const auto& task) { return task->is_put_away(); };
            const auto written = [](const auto& session) { return session->is_written(); };
            if (std::ranges::all_of(m_sessions, away) && std::ranges::all_of(m_sessions, written) && std::ranges::all_of(m_jobs, away)) return;
        }
        std::this_thread::sleep_for(tick_time);
    }
}

}  // namespace weave::simd
