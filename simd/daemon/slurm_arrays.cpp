#include <simd/daemon/slurm_arrays.hpp>

#include <weave/core/log.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <utility>

namespace weave::simd {

namespace {

constexpr std::chrono::seconds until_another_try{30};
constexpr std::size_t most_cancelled = 500;  // in one call

}  // namespace

Status SlurmArrays::take_up() {
    WEAVE_TRY(m_id, m_store.cluster_id());
    WEAVE_TRY(const std::vector<KeptJob> jobs, m_store.jobs());
    WEAVE_TRY(const std::vector<KeptSubmission> submissions, m_store.submissions());
    std::map<Number, const KeptJob*> by_number;
    for (const KeptJob& job : jobs) by_number[job.number] = &job;
    for (const KeptSubmission& submission : submissions) {
        Array array;
        array.slurm_id = submission.slurm_id;
        for (const SubmittedJob& submitted : submission.jobs) {
            const auto job = by_number.find(submitted.job);
            if (job == by_number.end()) continue;
            const Place place{submission.number, submitted.place};
            if (job->second->end) {
                m_dropped[place] = submitted.job;
                continue;
            }
            array.person = job->second->person;
            array.jobs[submitted.place] = submitted.job;
            m_places[submitted.job] = place;
        }
        if (!array.jobs.empty()) m_arrays[submission.number] = std::move(array);
    }
    clear_away();
    return {};
}

Status SlurmArrays::add(const std::string& person, const std::set<std::string>& avoided, const std::vector<std::uint64_t>& jobs) {
    WEAVE_TRY(const Number number, m_store.add_submission(jobs));
    Array array;
    array.person = person;
    array.avoided = avoided;
    for (std::uint64_t place = 0; place < jobs.size(); ++place) {
        if (m_places.contains(jobs[place])) drop(jobs[place]);  // an earlier array's
        array.jobs[place] = jobs[place];
        m_places[jobs[place]] = {number, place};
    }
    m_arrays[number] = std::move(array);
    return {};
}

void SlurmArrays::drop(std::uint64_t job) {
    const auto place = m_places.find(job);
    if (place == m_places.end()) return m_gone.push_back(job);
    const auto [number, at] = place->second;
    m_dropped[place->second] = job;
    m_places.erase(place);
    const auto array = m_arrays.find(number);
    array->second.jobs.erase(at);
    if (!array->second.jobs.empty()) return;
    m_arrays.erase(array);  // what of it is in the queue is nobody's
    clear_away();
}

/// Files of arrays that are no more, and what their jobs told.
void SlurmArrays::clear_away() const {
    std::error_code code;
    for (const auto& entry : std::filesystem::directory_iterator(m_rules.shared.arrays(), code)) {
        const std::string name = entry.path().filename().string();
        const auto number = parse_whole(name.substr(0, name.find_first_of("-.")));
        if (number && *number > 0 && !m_arrays.contains(static_cast<std::uint64_t>(*number))) std::filesystem::remove(entry.path(), code);
    }
}

std::optional<std::uint64_t> SlurmArrays::array_named(const std::string& name) const {
    const std::string ours = "simd-" + m_id + "-";
    if (!name.starts_with(ours)) return {};
    const auto number = parse_whole(name.substr(ours.size()));
    return number && *number > 0 ? std::optional(static_cast<std::uint64_t>(*number)) : std::nullopt;
}

Result<SlurmArrays::Look> SlurmArrays::look() {
    WEAVE_TRY(const std::vector<QueuedJob> lines, m_slurm.queue());
    Look look;
    std::vector<std::string> unwanted;
    m_dropped_alive.clear();
    recognise(lines);
    for (const QueuedJob& line : lines) {
        if (const auto array = array_named(line.name)) sort_in(line, *array, look, unwanted);
    }
    for (auto& [number, array] : m_arrays) {
        if (!array.slurm_id) {
            submit(number, array);
            continue;
        }
        for (const auto& [place, job] : array.jobs) {
            const auto found = look.jobs.find(job);
            if (found == look.jobs.end() || !found->second.is_alive()) look.missing.insert(job);
            else let_go_on(found->second);
        }
    }
    for (std::size_t k = 0; k < unwanted.size(); k += most_cancelled) {
        const auto end = unwanted.begin() + static_cast<std::ptrdiff_t>(std::min(unwanted.size(), k + most_cancelled));
        try_to(m_slurm.cancel({unwanted.begin() + static_cast<std::ptrdiff_t>(k), end}));
    }
    std::erase_if(m_dropped, [&](const auto& entry) {
        if (m_dropped_alive.contains(entry.first)) return false;
        m_gone.push_back(entry.second);
        return true;
    });
    // Taken after all, or no longer wanted.
    if (std::ranges::none_of(m_arrays, [](const auto& entry) { return entry.second.refused.has_value(); })) m_refusal = {};
    return look;
}

/// Arrays that Slurm took without our hearing of it. One of which it has several, for a call that seemed to fail was only slow, is the one
/// that lives: those that ended, and above all those that we had cancelled, say nothing of its jobs.
void SlurmArrays::recognise(const std::vector<QueuedJob>& lines) {
    const auto rank = [](const QueuedJob& line) { return line.is_alive() ? 2 : line.state == "CANCELLED" ? 0 : 1; };
    std::map<std::uint64_t, const QueuedJob*> best;
    for (const QueuedJob& line : lines) {
        const auto number = array_named(line.name);
        const auto array = number ? m_arrays.find(*number) : m_arrays.end();
        if (array == m_arrays.end() || array->second.slurm_id) continue;
        const QueuedJob*& known = best[*number];
        if (known == nullptr || rank(line) > rank(*known)) known = &line;
    }
    for (const auto& [number, line] : best) name(number, m_arrays.at(number), line->array);
}

/// A line is of a job that is wanted where it is, or is to go away: of a job that is over, or of an array that was submitted twice.
void SlurmArrays::sort_in(const QueuedJob& line, std::uint64_t number, Look& look, std::vector<std::string>& unwanted) {
    const auto array = m_arrays.find(number);
    if (array != m_arrays.end() && array->second.slurm_id == line.array) {
        const auto job = array->second.jobs.find(line.place);
        if (job != array->second.jobs.end()) {
            look.jobs[job->second] = line;
            return;
        }
    }
    if (!line.is_alive()) return;
    unwanted.push_back(line.id());
    m_dropped_alive.insert({number, line.place});
}

void SlurmArrays::name(std::uint64_t number, Array& array, std::uint64_t slurm_id) {
    array.slurm_id = slurm_id;
    array.refused.reset();
    const Status kept = m_store.name_submission(number, slurm_id);
    if (!kept) log(LogLevel::warning, "array " + std::to_string(slurm_id) + " of Slurm: " + kept.error().text());  // its name tells, at the next start
}

void SlurmArrays::submit(std::uint64_t number, Array& array) {
    if (array.refused && Clock::now() - *array.refused < until_another_try) return;
    const auto made = try_to_submit(number, array);
    if (made) return name(number, array, *made);
    m_refusal = made.error();
    array.refused = Clock::now();
    array.avoided.clear();  // there may be no other node
    log(LogLevel::warning, counted(array.jobs.size(), "job") + " not taken by Slurm, tried again in " + std::to_string(until_another_try.count()) + " s: " + made.error().text());
}

/// Its file is written each time: a daemon that died may have left the array in the store alone.
Result<std::uint64_t> SlurmArrays::try_to_submit(std::uint64_t number, const Array& array) const {
    WEAVE_CHECK_OK(write_array(m_rules.shared.array(number), {array.jobs.begin(), array.jobs.end()}));
    SlurmArray wanted;
    wanted.name = name_of(number);
    wanted.person = array.person;
    for (const auto& [place, job] : array.jobs) wanted.places.push_back(place);
    wanted.avoided.assign(array.avoided.begin(), array.avoided.end());
    wanted.command = {m_rules.program.string(), "job", m_rules.shared.array(number).string()};
    wanted.script = m_rules.shared.script();
    wanted.log = m_rules.shared.arrays() / (std::to_string(number) + "-%a.log");
    return m_slurm.submit(wanted, m_rules.wishes);
}

/// A job that was put back waits for two minutes unless it is told otherwise; one whose node could not start it is held until somebody
/// looks into it, and had better go to another node: that one is drained by Slurm.
void SlurmArrays::let_go_on(const QueuedJob& job) {
    if (job.state != "PENDING") return;
    if (job.reason == "BeginTime") try_to(m_slurm.start_now(job.id()));
    if (job.reason.find("launch failed requeued held") != std::string::npos || job.reason.find("launch_failed_requeued_held") != std::string::npos) try_to(m_slurm.release(job.id()));
}

/// What did not go well is seen again at the next look.
void SlurmArrays::try_to(Status status) {
    if (!status) log(LogLevel::warning, status.error().text());
}

std::vector<std::uint64_t> SlurmArrays::take_gone() {
    return std::exchange(m_gone, {});
}

}  // namespace weave::simd
