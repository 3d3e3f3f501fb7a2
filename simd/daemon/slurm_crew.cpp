#include <simd/daemon/slurm_crew.hpp>

#include <weave/core/file.hpp>
#include <weave/core/log.hpp>
#include <weave/core/sha256.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <cctype>
#include <simd/link/work_order.hpp>
#include <utility>

namespace weave::simd {

namespace {

/// Jobs that come one after the other go to Slurm as one array.
constexpr std::chrono::milliseconds quiet_before_array{500}, longest_before_array{3000}, until_another_try{10000};
constexpr std::chrono::milliseconds tick{200};
/// So long may a copy take to put away its yarns.
constexpr std::chrono::seconds stop_patience{60};
/// A node's file system may show what it has written a little later than Slurm tells that it has ended.
constexpr std::size_t looks_before_lost = 2;
constexpr std::size_t longest_place = 300;
constexpr std::uint64_t most_yarns = std::uint64_t{8} << 30;
constexpr const char* yarns_name = "result.yarns";
constexpr std::string_view script_text = "#!/bin/sh\n# Slurm takes a script; this one becomes the program that it is given.\nexec \"$@\"\n";

std::string lower(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::string clipped_place(std::string text) {
    if (text.size() <= longest_place) return text;
    std::size_t end = longest_place;  // not within a character
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80U) --end;
    return text.substr(0, end);
}

}  // namespace

SlurmCrew::SlurmCrew(std::mutex& lock, Store& store, const Rules& rules)
    : m_lock(lock), m_store(store), m_rules(rules), m_shared{rules.shared}, m_arrays(store, m_slurm, {rules.wishes, m_shared, rules.program}) {}

SlurmCrew::~SlurmCrew() {
    m_ends = true;
    m_news.notify_all();
    if (m_thread.joinable()) m_thread.join();
}

// ---- Its beginning ----

Status SlurmCrew::take_up() {
    WEAVE_CHECK_OK(take_folder());
    WEAVE_CHECK_OK(m_arrays.take_up());
    WEAVE_TRY(const std::vector<KeptSubmission> submissions, m_store.submissions());
    for (const KeptSubmission& submission : submissions) {
        for (const SubmittedJob& job : submission.jobs) m_resumable[job.job] = job.attempt;
    }
    WEAVE_TRY(const std::vector<KeptJob> jobs, m_store.jobs());
    std::set<std::string> known;
    for (const KeptJob& job : jobs) known.insert(std::to_string(job.number));
    std::error_code code;
    for (const auto& entry : std::filesystem::directory_iterator(m_shared.jobs(), code)) {
        if (!known.contains(entry.path().filename().string())) std::filesystem::remove_all(entry.path(), code);
    }
    return {};
}

/// Two daemons with one folder would take each other's jobs for their own; and whoever can write there can forge results.
Status SlurmCrew::take_folder() {
    WEAVE_TRY(const std::string id, m_store.cluster_id());
    for (const std::filesystem::path& folder : {m_shared.jobs(), m_shared.arrays()}) {
        std::error_code code;
        std::filesystem::create_directories(folder, code);
        if (code) return system_fault("cannot be made: " + code.message(), folder.string());
    }
    std::error_code code;
    constexpr std::filesystem::perms others = std::filesystem::perms::group_write | std::filesystem::perms::others_write;
    if ((std::filesystem::status(m_shared.path, code).permissions() & others) != std::filesystem::perms::none)
        return Error{ErrorCode::refused, "can be written by others than its owner, who could forge results", m_shared.path.string()};
    if (std::filesystem::exists(m_shared.owner(), code)) {
        WEAVE_TRY(const std::string owner, read_file(m_shared.owner(), 100));
        if (owner != id + "\n") return Error{ErrorCode::refused, "holds jobs of another simd: each needs a folder of its own", m_shared.path.string()};
    } else {
        WEAVE_CHECK_OK(write_file(m_shared.owner(), id + "\n"));
    }
    return write_file(m_shared.script(), script_text);
}

void SlurmCrew::work() {
    m_thread = std::thread([this] { watch(); });
}

// ---- What its owner asks for ----

void SlurmCrew::hand_over(Task& task, std::uint64_t job, const std::string& person) {
    const bool is_first = std::ranges::none_of(m_entries, [](const auto& entry) { return entry.second.waits_here(); });
    Entry& entry = m_entries[job];
    entry.task = &task;
    entry.person = person;
    m_last_new = Clock::now();
    if (is_first) m_first_new = m_last_new;
}

bool SlurmCrew::resume(Task& task, std::uint64_t job, const std::string& person) {
    const auto kept = m_resumable.find(job);
    if (kept == m_resumable.end()) return false;
    Entry& entry = m_entries[job];
    entry.task = &task;
    entry.person = person;
    entry.is_in_array = true;
    entry.attempt = kept->second;
    m_resumable.erase(kept);
    return true;
}

void SlurmCrew::stop(std::uint64_t job) {
    const auto entry = m_entries.find(job);
    if (entry == m_entries.end() || entry->second.stopped) return;
    entry->second.stopped = Clock::now();
    m_hurries = true;
    m_news.notify_all();
}

void SlurmCrew::leave(std::uint64_t job) {
    if (m_entries.erase(job) == 0) return;
    m_left.push_back(job);
    m_hurries = true;
    m_news.notify_all();
}

void SlurmCrew::part(const Task& task) {
    for (auto& [job, entry] : m_entries) {
        if (entry.task == &task) entry.task = nullptr;
    }
}

std::size_t SlurmCrew::size() const {
    return static_cast<std::size_t>(std::ranges::count_if(m_entries, [](const auto& entry) { return entry.second.task != nullptr; }));
}

std::size_t SlurmCrew::room() const {
    return m_rules.jobs_at_once - std::min(m_rules.jobs_at_once, size());
}

std::string SlurmCrew::place_of(std::uint64_t job) const {
    const auto found = m_entries.find(job);
    if (found == m_entries.end()) return {};
    const Entry& entry = found->second;
    const Status trouble = this->trouble();
    const std::string but = trouble ? std::string() : "; " + trouble.error().message;
    if (!entry.queued) return clipped_place("Slurm: being handed over" + but);
    std::string text = "Slurm " + entry.queued->id() + ": " + lower(entry.queued->state);
    if (!entry.queued->node.empty()) text += " on " + entry.queued->node;
    if (!entry.queued->node.empty() && !entry.news.gpus.empty()) text += ", GPU " + entry.news.gpus;
    if (entry.queued->state == "PENDING") text += " (" + entry.queued->reason + ")";
    return clipped_place(on_one_line(text + but));
}

Status SlurmCrew::trouble() const {
    const std::lock_guard lock(m_trouble_lock);
    for (const Status* trouble : {&m_queue_trouble, &m_handing_trouble}) {
        if (!*trouble) return *trouble;
    }
    return m_disk_trouble;
}

/// What goes on going wrong is told once.
void SlurmCrew::note(Status& trouble, Status status) {
    const std::lock_guard lock(m_trouble_lock);
    const std::string before = trouble ? std::string() : trouble.error().text(), now = status ? std::string() : status.error().text();
    if (before != now) log(status ? LogLevel::info : LogLevel::warning, status ? "jobs in Slurm: all is well again" : now);
    trouble = std::move(status);
}

// ---- Its own thread ----

void SlurmCrew::watch() {
    Clock::time_point looked{};
    while (true) {
        bool has_new = false, hurries = false;
        {
            std::unique_lock lock(m_lock);
            m_news.wait_for(lock, tick, [this] { return m_hurries || m_ends; });
            if (m_ends) return;
            has_new = has_new_jobs(Clock::now());
            hurries = std::exchange(m_hurries, false);
        }
        if (has_new) hand_in();
        if (!has_new && !hurries && Clock::now() - looked < m_rules.watch) continue;
        look();
        looked = Clock::now();
    }
}

bool SlurmCrew::has_new_jobs(Clock::time_point now) const {
    if (now < m_not_before) return false;
    const bool any = std::ranges::any_of(m_entries, [](const auto& entry) { return entry.second.waits_here(); });
    return any && (now - m_last_new >= quiet_before_array || now - m_first_new >= longest_before_array);
}

/// An array for each person, and for each set of nodes to be avoided.
void SlurmCrew::hand_in() {
    std::map<std::pair<std::string, std::set<std::string>>, std::vector<std::uint64_t>> groups;
    {
        const std::lock_guard lock(m_lock);
        for (const auto& [job, entry] : m_entries) {
            if (entry.waits_here()) groups[{entry.person, entry.avoided}].push_back(job);
        }
    }
    Status all = has_room();
    for (const auto& [group, jobs] : groups) {
        if (!all) break;
        Status given = hand_in(group.first, group.second, jobs);
        if (!given) all = std::move(given);
    }
    const bool is_well = static_cast<bool>(all);
    note(m_handing_trouble, std::move(all));
    const std::lock_guard lock(m_lock);
    if (!is_well) m_not_before = Clock::now() + until_another_try;
}

/// A job that finds no room for its result there computes in vain.
Status SlurmCrew::has_room() const {
    constexpr std::uintmax_t least = 64U << 20U;
    std::error_code code;
    const auto space = std::filesystem::space(m_shared.path, code);
    if (code) return system_fault("the folder that nodes share cannot be reached: " + code.message(), m_shared.path.string());
    if (space.available < least) return system_fault("there is hardly any room left in the folder that nodes share", m_shared.path.string());
    return {};
}

Status SlurmCrew::hand_in(const std::string& person, const std::set<std::string>& avoided, const std::vector<std::uint64_t>& jobs) {
    for (const std::uint64_t job : jobs) WEAVE_CHECK_OK(give(job));
    WEAVE_CHECK_OK(m_arrays.add(person, avoided, jobs));
    const std::lock_guard lock(m_lock);
    for (const std::uint64_t job : jobs) {
        const auto entry = m_entries.find(job);
        if (entry == m_entries.end()) continue;  // it has left meanwhile, which the arrays hear of at the next look
        entry->second.is_in_array = true;
        entry->second.queued.reset();
        entry->second.gone = 0;
    }
    return {};
}

Status SlurmCrew::give(std::uint64_t job) {
    WEAVE_TRY(const JobTask task, m_store.task_of_job(job));
    WEAVE_TRY(SimulationWork work, simulation_from(task.simulation));
    WorkOrder order;
    order.is_job = true;
    order.number = job;
    order.document = task.document;
    order.simulation = std::move(work.simulation);
    order.flips = std::move(work.flips);
    order.backend = m_rules.backend;
    order.checkpoint_s = static_cast<std::uint64_t>(m_rules.checkpoint.count());
    return m_shared.job(job).give(order);
}

void SlurmCrew::look() {
    std::vector<std::uint64_t> left;
    {
        const std::lock_guard lock(m_lock);
        left.swap(m_left);
    }
    for (const std::uint64_t job : left) {
        m_shared.job(job).ask_to_stop(Stop::at_once);
        m_arrays.drop(job);
    }
    std::optional<SlurmArrays::Look> queue;
    if (auto seen = m_arrays.look()) {
        queue = std::move(*seen);
        note(m_queue_trouble, m_arrays.refusal());
    } else if (!m_ends) {
        note(m_queue_trouble, seen.error());
    }
    std::vector<Found> all;
    bool any_waits = false;
    {
        const std::lock_guard lock(m_lock);
        all = to_look_at(queue);
        any_waits = std::ranges::any_of(m_entries, [](const auto& entry) { return entry.second.waits_here(); });
    }
    if (!any_waits) note(m_handing_trouble, {});  // whoever could not be handed over has left
    Status disk;
    for (Found& found : all) {
        Status looked = look_at_folder(found);
        if (!looked) disk = std::move(looked);
        const std::lock_guard lock(m_lock);
        apply(found, queue);
    }
    note(m_disk_trouble, std::move(disk));
    clear_away();
}

/// Those that may have something to tell; of each the place in the queue is noted.
std::vector<SlurmCrew::Found> SlurmCrew::to_look_at(const std::optional<SlurmArrays::Look>& queue) {
    std::vector<Found> all;
    for (auto& [job, entry] : m_entries) {
        if (entry.task == nullptr || !entry.is_in_array) continue;
        if (queue) {
            const auto line = queue->jobs.find(job);
            if (line != queue->jobs.end()) entry.queued = line->second;
            entry.gone = queue->missing.contains(job) ? entry.gone + 1 : 0;
            const bool waits = entry.attempt == 0 && entry.gone == 0 && (!entry.queued || entry.queued->state == "PENDING");
            if (waits && !entry.stopped) continue;
        }
        all.push_back({job, entry.attempt, entry.stopped.has_value(), entry.refused, {}, {}});
    }
    return all;
}

/// A newer attempt counts from the moment in which the store has it.
Status SlurmCrew::look_at_folder(Found& found) {
    const JobFolder folder = m_shared.job(found.job);
    if (found.is_stopped) folder.ask_to_stop(Stop::with_yarns);
    WEAVE_TRY(const std::uint64_t newest, folder.newest_attempt());
    if (newest > found.attempt) {
        WEAVE_CHECK_OK(m_store.note_attempt(found.job, newest));
        found.attempt = newest;
    }
    refuse_stale(found);
    if (found.attempt == 0) return {};
    found.news = folder.news(found.attempt);
    WEAVE_TRY(found.end, folder.end_of(found.attempt));
    if (!found.end || found.end->outcome != Outcome::done) return {};
    Status home = bring_home(found);
    if (home) return {};
    if (home.error().code == ErrorCode::system) {  // our own disk: at the next look
        found.end.reset();
        return home;
    }
    folder.refuse(found.attempt);
    found.end->outcome = Outcome::again;
    found.end->error = home.error();
    return {};
}

/// Copies that were given up for lost may end all the same, after a newer one has begun.
void SlurmCrew::refuse_stale(Found& found) {
    const JobFolder folder = m_shared.job(found.job);
    for (std::uint64_t stale = 1; stale < found.attempt; ++stale) {
        if (found.refused.contains(stale)) continue;
        const auto end = folder.end_of(stale);
        if (!end || !*end || (*end)->outcome != Outcome::done) continue;
        const Status refused = m_store.note_attempt(found.job, stale);
        if (refused) continue;  // cannot be
        log(LogLevel::warning, "a result from " + on_one_line((*end)->node) + " is refused: " + refused.error().text());
        folder.refuse(stale);
        found.refused.insert(stale);
    }
}

/// A result comes home as a whole, once it is known to be what was asked for. Errors: system is of the disk here or of the shared
/// folder; bad input, of the result.
Status SlurmCrew::bring_home(const Found& found) {
    const JobFolder folder = m_shared.job(found.job);
    const std::string where = "job " + std::to_string(found.job);
    WEAVE_TRY(const WorkOrder order, folder.order());
    if (found.end->input_sha256 != input_sha256(order)) return bad_input("its result is of another order (SHA-256)", where);
    WEAVE_TRY(const std::string bytes, read_file(folder.attempt(found.attempt) / yarns_name, most_yarns));
    const auto told = found.end->report.find("yarns_sha256");
    if (told == found.end->report.end() || *told != sha256_hex(bytes)) return bad_input("its yarns are others than its report tells of (SHA-256)", where);
    const std::filesystem::path home = m_rules.home / std::to_string(found.job);
    std::error_code code;
    std::filesystem::create_directories(home, code);
    if (code) return system_fault("cannot be made: " + code.message(), home.string());
    return write_file(home / yarns_name, bytes);
}

void SlurmCrew::apply(const Found& found, const std::optional<SlurmArrays::Look>& queue) {
    const auto at = m_entries.find(found.job);
    if (at == m_entries.end() || at->second.task == nullptr || !at->second.is_in_array) return;
    Entry& entry = at->second;
    entry.attempt = found.attempt;
    entry.refused = found.refused;
    if (found.news) tell(entry, found);
    const auto& end = found.end;
    if (end && end->outcome == Outcome::done) {
        Json done{{"step", end->step}, {"report", end->report}, {"yarns", yarns_name}, {"was_stopped", end->was_stopped}};
        return entry.task->said("done", done);
    }
    if (end && end->outcome == Outcome::never) return tell_end(found.job, {"failed", end->error, true});
    if (entry.stopped && (Clock::now() - *entry.stopped > stop_patience || entry.gone >= looks_before_lost))
        return tell_end(found.job, {"", system_fault("what ran in Slurm did not put away its yarns"), true});
    if (!queue || entry.gone == 0) return;
    const std::string state = entry.queued && !entry.queued->is_alive() ? entry.queued->state : std::string();
    if (state == "CANCELLED") return tell_end(found.job, {"", Error{ErrorCode::refused, "was cancelled in Slurm", "job " + std::to_string(found.job)}, true});
    if (end) {
        if (end->is_the_nodes_fault) entry.avoided.insert(end->node);
        Error why = end->error.value_or(system_fault("it could not go on"));
        why.message += end->node.empty() ? "" : " (on " + on_one_line(end->node) + ")";
        return tell_end(found.job, {"", why, false});
    }
    if (entry.gone < looks_before_lost) return;
    if (state == "OUT_OF_MEMORY") return tell_end(found.job, {"", system_fault("out of memory: it took more than Slurm gave it (slurm.memory_mib of simd's configuration)"), true});
    tell_end(found.job, {"", system_fault("it has left the queue of Slurm without a result" + (state.empty() ? "" : " (" + lower(state) + ")")), false});
}

void SlurmCrew::tell(Entry& entry, const Found& found) {
    const AttemptNews& news = *found.news;
    if (!std::exchange(entry.has_begun, true) || news.points != entry.news.points) entry.task->said("begun", {{"points", news.points}});
    if (news.step > 0 && news != entry.news) {
        Json progress{{"step", news.step}, {"residual", news.residual}, {"goal", news.goal}};
        if (news.lost) progress["lost"] = *news.lost;
        entry.task->said("progress", progress);
    }
    if (!news.trouble.empty() && news.trouble != entry.news.trouble)
        log(LogLevel::warning, "job " + std::to_string(found.job) + " on " + on_one_line(news.node) + ": " + on_one_line(news.trouble));
    entry.news = news;
}

/// What is known of the job stays for when it is handed over again.
void SlurmCrew::tell_end(std::uint64_t job, WorkerEnd end) {
    Entry& entry = m_entries.at(job);
    Task* const task = std::exchange(entry.task, nullptr);
    entry.is_in_array = entry.has_begun = false;
    entry.queued.reset();
    entry.news = {};
    task->ended(end);
}

void SlurmCrew::clear_away() {
    for (const std::uint64_t job : m_arrays.take_gone()) {
        {
            const std::lock_guard lock(m_lock);
            if (m_entries.contains(job)) continue;  // it was handed over again
        }
        std::error_code ignored;
        std::filesystem::remove_all(m_shared.jobs() / std::to_string(job), ignored);
    }
}

}  // namespace weave::simd
