#pragma once

#include <deque>
#include <map>
#include <simd/store/store.hpp>
#include <support/random.hpp>
#include <variant>

namespace weave::simd::testing {

using weave::testing::Random;

/// Whose requests the operations make.
inline const std::vector<std::string> people{"dora", "abel", "otto"};
/// Few, so that they come again.
constexpr std::size_t request_count = 60;

inline std::string request_of(std::size_t k) {
    return "request-" + std::to_string(k);
}

/// One call to the store.
struct Operation {
    enum class Kind {
        remember,
        answer_of,
        add_session,
        change_session,
        forget_session,
        add_events,
        events_after,
        acknowledge,
        add_change,
        add_job,
        start_job,
        job_progress,
        end_job,
        forget_job
    };
    static constexpr std::size_t kinds = 14;

    Kind kind = Kind::remember;
    Number number = 0;
    Number other = 0;  // a seq, or a step
    std::string person, request, text;
    SessionState state;
    std::vector<Event> events;
    std::vector<Dated> dated;
    JobEnd end;
};

/// What the store should hold, in plain containers.
class Model {
  public:
    /// What the operation should answer, in words.
    std::string apply(const Operation& operation);
    /// What a daemon that is started anew finds.
    void reopen();
    /// All that is held, in words.
    [[nodiscard]] std::string told() const;
    /// An operation that mostly makes sense.
    [[nodiscard]] Operation random(Random& random) const;

  private:
    struct Session {
        KeptSession kept;
        SessionTask task;
        std::vector<Event> events;
        std::vector<KeptChange> changes;
    };
    struct Job {
        KeptJob kept;
        JobTask task;
    };
    struct Answer {
        std::string request;
        Made made;
    };

    std::string add_session(const Operation& operation);
    std::string add_events(const Operation& operation);
    std::string add_change(const Operation& operation);
    std::string add_job(const Operation& operation);
    std::string of_session(const Operation& operation, Session& session);
    std::string of_job(const Operation& operation, Job& job);
    [[nodiscard]] const Made* before(const std::string& person, const std::string& request) const;
    void remember(const std::string& person, const std::string& request, Made made);
    static void drop_acknowledged(Session& session);

    std::map<Number, Session> m_sessions;
    std::map<Number, Job> m_jobs;
    std::map<std::string, std::deque<Answer>> m_answers;
    Number m_last_session = 0, m_last_job = 0;
};

/// What the store answers to the operation, in the model's words.
std::string apply(Store& store, const Operation& operation);

/// All that the store holds, in the model's words; "fails: …" where it cannot be read.
std::string told(Store& store);

}  // namespace weave::simd::testing
