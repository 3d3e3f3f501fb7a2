#pragma once


#include <weave/core/result.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace weave::simd {

struct NewSession {
    std::string person, request, title, document, simulation;
};
/// What changes of a session and must outlive the daemon.
struct SessionState {
    std::string phase = "paused";  ///< running or paused: what was asked for
    std::uint64_t step = 0;
    std::optional<std::uint64_t> pause_at;
    std::uint64_t frame = 0;   ///< no frame up to this number may be given again
    std::uint64_t layout = 0;  ///< number of the newest
    std::optional<std::uint64_t> checkpoint_step;
    std::int64_t seen = 0;  ///< seconds of UTC when somebody was attached last
};
struct StoredSession {
    std::uint64_t number = 0;
    std::string person, request, title, document, simulation;
    SessionState state;
    std::uint64_t seq = 0;       ///< of the last event
    bool has_ended = false;      ///< has an event of the kind `ended`
    std::string layout_sha256;   ///< of the newest layout event, as it was given with it; empty: none
    std::string phase_event;     ///< text of the newest event of the kind `phase`; empty: none
};

enum class EventKind : std::uint8_t { layout, phase, other, ended };
struct Event {
    std::uint64_t seq = 0;
    EventKind kind = EventKind::other;
    std::string text;
    std::string layout_sha256 = {};  ///< of a layout
};
/// What became of a change of the journal.
struct ChangeNews {
    std::uint64_t number = 0;  ///< in its session, from 1
    std::uint64_t step = 0;    ///< before which it was made
    bool flip_told = false;    ///< how the flip ended was told
};
struct StoredChange {
    std::uint64_t number = 0;
    std::string request, text;
    std::optional<std::uint64_t> step;
    bool flip_told = false;
};

struct NewJob {
    std::string person, request, title, document, simulation;
};
struct StoredJob {
    std::uint64_t number = 0;
    std::string person, request, title, document, simulation;
    std::string phase = "waiting";  ///< waiting, running, done, failed, cancelled; one that ran when the daemon died waits again at open
    std::uint64_t attempts = 0, step = 0;
    std::optional<std::string> error, evidence, yarns;  ///< yarns: a file name
    std::string report = "{}";
};

/// Makes the text of an answer once the number of what was made is known.
using AnswerText = std::function<std::string(std::uint64_t number)>;

class Store {
  public:
    /// Opens or makes the database. Errors: system; refused: another program's or a newer version's.
    static Result<std::unique_ptr<Store>> open(const std::filesystem::path& file);
    ~Store();

    Result<std::uint64_t> add_session(const NewSession& session, const AnswerText& answer);
    Status change_session(std::uint64_t session, const SessionState& state);
    Result<std::vector<StoredSession>> sessions();
    Status forget_session(std::uint64_t session);

    Status add_events(std::uint64_t session, const std::vector<Event>& events, const std::vector<ChangeNews>& news);
    Result<std::vector<Event>> events_after(std::uint64_t session, std::uint64_t seq, std::size_t most);
    Status acknowledge(std::uint64_t session, std::uint64_t seq);
    Result<std::uint64_t> unacknowledged(std::uint64_t session);

    Result<std::uint64_t> add_change(std::uint64_t session, const std::string& person, const std::string& request, const std::string& text,
                                     const std::string& answer);
    Result<std::vector<StoredChange>> changes(std::uint64_t session);

    Status remember(const std::string& person, const std::string& request, const std::string& answer);
    Result<std::optional<std::string>> answer_of(const std::string& person, const std::string& request);

    Result<StoredJob> add_job(const NewJob& job, const AnswerText& answer);
    Status start_job(std::uint64_t job);
    Status job_progress(std::uint64_t job, std::uint64_t step, double residual);
    Status end_job(std::uint64_t job, const std::string& phase, const std::optional<std::string>& error, const std::string& report,
                   const std::optional<std::string>& evidence, const std::optional<std::string>& yarns);
    Result<std::vector<StoredJob>> jobs();  ///< all that are not forgotten, by number
    Status forget_job(std::uint64_t job);

    /// How the last write ended, for health.
    Status last_write();
};

}  // namespace weave::simd
