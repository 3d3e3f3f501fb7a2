#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace weave::simd {

/// Of sessions, jobs, steps, frames, events: up to 2^53 - 1.
using Number = std::uint64_t;

/// What a session or job is made of; texts as the protocol has them.
struct NewSession {
    std::string person;
    std::string request;
    std::string title;
    std::string document;
    std::string simulation;
};

/// How far a session is, as far as it is kept.
struct SessionState {
    std::string phase;
    Number step = 0;
    std::optional<Number> pause_at;  ///< the step at which it pauses by itself
    Number frame = 0;                ///< the last; 0: none yet
    Number layout = 0;               ///< the last; 0: none yet
    Number checkpoint_step = 0;
    bool operator==(const SessionState&) const = default;
};

/// A session that is not forgotten. Its task is asked for by itself: a document may have 16 MB.
struct KeptSession {
    Number number = 0;
    std::string person;
    std::string request;
    std::string title;
    SessionState state;
    Number last_seq = 0;      ///< of its events; 0: none yet
    Number acknowledged = 0;  ///< up to which event
    bool ended = false;       ///< its last event is there
};

/// What a worker needs to begin with.
struct SessionTask {
    std::string document;
    std::string simulation;
};

enum class EventKind : std::uint8_t { layout, phase, other, ended };

/// An event of a session, as its clients are told it.
struct Event {
    Number seq = 0;
    EventKind kind = EventKind::other;
    std::string text;
    bool operator==(const Event&) const = default;
};

/// At which step a change of the journal took effect, and whether it was told how its flip ended.
struct Dated {
    Number change = 0;
    Number step = 0;
    bool flip_told = false;
};

/// A change of a session's journal.
struct KeptChange {
    Number number = 0;  ///< in its session, from 1
    std::string request;
    std::string text;
    std::optional<Number> step;  ///< at which it took effect; none: it has not yet
    bool flip_told = false;      ///< it was told how its flip ended
    bool operator==(const KeptChange&) const = default;
};

/// A job as it is submitted.
struct NewJob {
    std::string person;
    std::string request;
    std::string title;
    std::string document;
    std::string simulation;
};

struct JobTask {
    std::string document;
    std::string simulation;
};

enum class JobPhase : std::uint8_t { waiting, running, done, failed, cancelled };

/// How a job ended.
struct JobEnd {
    JobPhase phase = JobPhase::done;  ///< done, failed or cancelled
    std::optional<std::string> error;
    std::string report;
    std::optional<std::string> evidence;
    std::optional<std::string> yarns;  ///< name of the file of its yarns
    bool operator==(const JobEnd&) const = default;
};

/// A job that is not forgotten, without its task.
struct KeptJob {
    Number number = 0;
    std::string person;
    std::string request;
    std::string title;
    JobPhase phase = JobPhase::waiting;
    Number attempts = 0;  ///< how often it was started
    Number step = 0;
    std::optional<double> residual;
    std::optional<JobEnd> end;  ///< there once it has ended
};

/// A job that Slurm has.
struct SubmittedJob {
    Number job = 0;
    Number place = 0;    ///< in its array, from 0
    Number attempt = 0;  ///< the newest that has begun; 0: none yet
    bool operator==(const SubmittedJob&) const = default;
};

/// An array of jobs as Slurm has it.
struct KeptSubmission {
    Number number = 0;
    std::optional<Number> slurm_id;  ///< none: Slurm has not told it yet
    std::vector<SubmittedJob> jobs;  ///< those that were not given to a later one
    bool operator==(const KeptSubmission&) const = default;
};

/// The answer to a request that made something.
struct Made {
    Number number = 0;   ///< of the session, job or change
    std::string answer;  ///< to be sent
    bool anew = true;    ///< false: it was asked before, and nothing was done
};

}  // namespace weave::simd
