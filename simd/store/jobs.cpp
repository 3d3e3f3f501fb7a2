#include <array>
#include <simd/store/rows.hpp>
#include <simd/store/store.hpp>

namespace weave::simd {

namespace {

const std::array<std::string, 5> phase_words{"waiting", "running", "done", "failed", "cancelled"};

const std::string& word_of(JobPhase phase) {
    return phase_words[static_cast<std::size_t>(phase)];
}

JobPhase phase_of(const std::string& word) {
    std::size_t k = 0;
    while (k + 1 < phase_words.size() && phase_words[k] != word) ++k;
    return static_cast<JobPhase>(k);
}

bool has_ended(JobPhase phase) {
    return phase != JobPhase::waiting && phase != JobPhase::running;
}

std::string all_where(const std::string& condition) {
    return "SELECT number, person, request, title, phase, attempts, step, residual, error, report, evidence, "
           "yarns FROM job" +
           condition + " ORDER BY number";
}

// Connection knows a statement by the address of its text.
const std::string by_number = all_where(" WHERE number = ?");
const std::string all_jobs = all_where("");

KeptJob job_of(const sql::Row& row) {
    KeptJob job;
    job.number = number_at(row, 0);
    job.person = row.bytes(1);
    job.request = row.bytes(2);
    job.title = row.bytes(3);
    job.phase = phase_of(row.bytes(4));
    job.attempts = number_at(row, 5);
    job.step = number_at(row, 6);
    if (!row.is_null(7)) job.residual = row.real(7);
    if (has_ended(job.phase))
        job.end = JobEnd{job.phase, optional_text_at(row, 8), row.bytes(9), optional_text_at(row, 10),
                         optional_text_at(row, 11)};
    return job;
}

Result<KeptJob> find_job(sql::Connection& connection, Number job) {
    WEAVE_TRY(auto found, connection.one(by_number.c_str(), job_of, whole(job)));
    if (!found) return no_such("job", job);
    return *std::move(found);
}

Error not_so(Number job, const std::string& why) {
    return {ErrorCode::usage, why, "job " + std::to_string(job)};
}

}  // namespace

Result<Made> Store::add_job(const NewJob& job, const AnswerOf& answer) {
    Made made;
    const auto add = [&](sql::Connection& connection) -> Status {
        WEAVE_TRY(const auto before, made_before(connection, job.person, job.request));
        if (before) return made = *before, Status();
        WEAVE_TRY(const std::int64_t number,
                  connection.number("INSERT INTO job (person, request, title) VALUES (?, ?, ?) RETURNING number", job.person,
                                    job.request, job.title));
        WEAVE_CHECK_OK(
            connection.run("INSERT INTO job_task (job, document, simulation) VALUES (?, ?, ?)",
                           number, job.document, job.simulation));
        made.number = static_cast<Number>(number);
        made.answer = answer(made.number);
        return remember_answer(connection, job.person, job.request, made.answer, made.number);
    };
    WEAVE_CHECK_OK(write(add));
    return made;
}

Status Store::start_job(Number job) {
    WEAVE_CHECK_OK(write([&](sql::Connection& connection) -> Status {
        WEAVE_TRY(const KeptJob found, find_job(connection, job));
        if (has_ended(found.phase)) return not_so(job, "has ended");
        if (found.phase == JobPhase::running) return {};  // asked again after a failure of the disk
        return connection.run("UPDATE job SET phase = 'running', attempts = attempts + 1 WHERE number = ?",
                              whole(job));
    }));
    const std::lock_guard lock(m_mutex);
    m_progress.try_emplace(job);
    return {};
}

void Store::job_progress(Number job, Number step, std::optional<double> residual) {
    const std::lock_guard lock(m_mutex);
    const auto running = m_progress.find(job);
    if (running != m_progress.end()) running->second = {step, residual};
}

Status Store::end_job(Number job, const JobEnd& end) {
    if (!has_ended(end.phase)) return not_so(job, "does not end by going on");
    WEAVE_CHECK_OK(write([&](sql::Connection& connection) -> Status {
        WEAVE_TRY(const KeptJob found, find_job(connection, job));
        if (found.end) return *found.end == end ? Status() : Status(not_so(job, "has ended otherwise"));
        const auto known = m_progress.find(job);
        const Progress last = known != m_progress.end() ? known->second : Progress{};
        return connection.run(
            "UPDATE job SET phase = ?, step = ?, residual = ?, error = ?, report = ?, evidence = ?, yarns = "
            "? "
            "WHERE number = ?",
            word_of(end.phase), whole(last.step), last.residual, end.error, end.report, end.evidence,
            end.yarns, whole(job));
    }));
    const std::lock_guard lock(m_mutex);
    m_progress.erase(job);
    return {};
}

Result<JobTask> Store::task_of_job(Number job) {
    std::optional<JobTask> found;
    WEAVE_CHECK_OK(read([&](sql::Connection& connection) -> Status {
        WEAVE_TRY(found, connection.one(
                             "SELECT document, simulation FROM job_task WHERE job = ?",
                             [](const sql::Row& row) {
                                 return JobTask{row.bytes(0), row.bytes(1)};
                             },
                             whole(job)));
        return {};
    }));
    if (!found) return no_such("job", job);
    return *std::move(found);
}

Result<std::vector<KeptJob>> Store::jobs() {
    std::vector<KeptJob> found;
    WEAVE_CHECK_OK(read([&](sql::Connection& connection) -> Status {
        WEAVE_TRY(found, connection.all(all_jobs.c_str(), job_of));
        for (KeptJob& job : found) {
            const auto running = m_progress.find(job.number);
            if (running == m_progress.end()) continue;
            job.step = running->second.step;
            job.residual = running->second.residual;
        }
        return {};
    }));
    return found;
}

Status Store::forget_job(Number job) {
    return write([&](sql::Connection& connection) -> Status {
        WEAVE_TRY(const auto found, connection.one(by_number.c_str(), job_of, whole(job)));
        if (!found) return {};
        if (!found->end) return not_so(job, "has not ended");
        return connection.run("DELETE FROM job WHERE number = ?", whole(job));
    });
}

}  // namespace weave::simd
