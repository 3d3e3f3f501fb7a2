#include <simd/store/rows.hpp>
#include <simd/store/store.hpp>

namespace weave::simd {

namespace {

struct SubmittedRow {
    Number submission = 0;
    std::optional<Number> slurm_id;
    SubmittedJob job;
};

SubmittedRow row_of(const sql::Row& row) {
    return {number_at(row, 0), optional_number_at(row, 1), {number_at(row, 2), number_at(row, 3), number_at(row, 4)}};
}

/// Those whose jobs were all given to later ones or forgotten.
Status forget_empty_submissions(sql::Connection& connection) {
    return connection.run("DELETE FROM submission WHERE NOT EXISTS (SELECT 1 FROM submitted WHERE submission = submission.number)");
}

}  // namespace

Result<std::string> Store::cluster_id() {
    std::optional<std::string> id;
    WEAVE_CHECK_OK(read([&](sql::Connection& connection) -> Status {
        WEAVE_TRY(id, connection.one("SELECT id FROM cluster", [](const sql::Row& row) { return row.bytes(0); }));
        return {};
    }));
    if (!id) return system_fault("has lost the id of its jobs in Slurm", m_path.string());
    return *std::move(id);
}

Result<Number> Store::add_submission(const std::vector<Number>& jobs) {
    Number made = 0;
    const auto add = [&](sql::Connection& connection) -> Status {
        WEAVE_TRY(const std::int64_t submission, connection.number("INSERT INTO submission DEFAULT VALUES RETURNING number"));
        std::int64_t place = 0;
        for (const Number job : jobs) {
            WEAVE_TRY(const auto phase, connection.one("SELECT phase FROM job WHERE number = ?", [](const sql::Row& row) { return row.bytes(0); }, whole(job)));
            if (!phase) return no_such("job", job);
            if (*phase != "waiting" && *phase != "running") return Error{ErrorCode::usage, "has ended", "job " + std::to_string(job)};
            WEAVE_CHECK_OK(connection.run("INSERT INTO submitted (job, submission, place) VALUES (?, ?, ?) "
                                          "ON CONFLICT (job) DO UPDATE SET submission = excluded.submission, place = excluded.place",
                                          whole(job), submission, place++));
        }
        WEAVE_CHECK_OK(forget_empty_submissions(connection));
        made = static_cast<Number>(submission);
        return {};
    };
    WEAVE_CHECK_OK(write(add));
    return made;
}

Status Store::name_submission(Number submission, Number slurm_id) {
    return write([&](sql::Connection& connection) {
        return connection.run("UPDATE submission SET slurm_id = ? WHERE number = ?", whole(slurm_id), whole(submission));
    });
}

Result<std::vector<KeptSubmission>> Store::submissions() {
    std::vector<KeptSubmission> found;
    WEAVE_CHECK_OK(read([&](sql::Connection& connection) -> Status {
        WEAVE_TRY(const auto rows, connection.all("SELECT submission, slurm_id, job, place, attempt FROM submitted "
                                                  "JOIN submission ON submission.number = submitted.submission "
                                                  "ORDER BY submission, place",
                                                  row_of));
        for (const SubmittedRow& row : rows) {
            if (found.empty() || found.back().number != row.submission) found.push_back({row.submission, row.slurm_id, {}});
            found.back().jobs.push_back(row.job);
        }
        return {};
    }));
    return found;
}

Status Store::note_attempt(Number job, Number attempt) {
    return write([&](sql::Connection& connection) -> Status {
        WEAVE_TRY(const auto noted, connection.one("SELECT attempt FROM submitted WHERE job = ?", [](const sql::Row& row) { return number_at(row, 0); }, whole(job)));
        if (!noted) return no_such("job in Slurm", job);
        if (attempt < *noted)
            return Error{ErrorCode::refused, "attempt " + std::to_string(attempt) + " is stale: attempt " + std::to_string(*noted) + " has begun since", "job " + std::to_string(job)};
        if (attempt == *noted) return {};
        return connection.run("UPDATE submitted SET attempt = ? WHERE job = ?", whole(attempt), whole(job));
    });
}

}  // namespace weave::simd
