#include <simd/slurm/attempt.hpp>

#include <weave/core/log.hpp>
#include <weave/core/text.hpp>
#include <weave/sim/forecast.hpp>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <simd/link/error_form.hpp>
#include <sys/stat.h>
#include <utility>

namespace weave::simd {

namespace {

constexpr std::chrono::milliseconds between_looks{1000}, at_most_waited{200};

std::string word_of_environment(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? std::string() : std::string(value);
}

std::uint64_t number_of_environment(const char* name, std::uint64_t otherwise) {
    const auto number = parse_whole(word_of_environment(name));
    return number && *number > 0 ? static_cast<std::uint64_t>(*number) : otherwise;
}

/// Kept for whoever waits for it: threads that begin later keep it as well.
void hold_signals() {
    sigset_t held;
    sigemptyset(&held);
    for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2}) sigaddset(&held, signal);
    ::pthread_sigmask(SIG_BLOCK, &held, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is an error like a full disk
}

bool was_signalled() {
    sigset_t held;
    sigemptyset(&held);
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&held, signal);
    const timespec at_once{0, 0};
    return ::sigtimedwait(&held, nullptr, &at_once) > 0;
}

}  // namespace

Attempt::Node Attempt::node_of_environment() {
    constexpr std::uint64_t mib = std::uint64_t{1} << 20;
    Node node;
    node.name = word_of_environment("SLURMD_NODENAME");
    node.gpus = word_of_environment("SLURM_JOB_GPUS");
    node.cpus = number_of_environment("SLURM_CPUS_PER_TASK", 1);
    node.memory_bytes = number_of_environment("SLURM_MEM_PER_NODE", number_of_environment("SLURM_MEM_PER_CPU", 0) * node.cpus) * mib;
    return node;
}

Attempt::Attempt(JobFolder folder, WorkOrder order, std::uint64_t number, Node node)
    : m_folder(std::move(folder)), m_order(std::move(order)), m_number(number), m_node(std::move(node)) {
    m_news.node = m_node.name;
    m_news.gpus = m_node.gpus;
    m_order.folder = m_folder.attempt(m_number).string();
    m_order.takes_up = true;
}

/// The newest that is there; the worker finds out whether it is whole, and begins anew where it is not. A copy that still writes
/// there puts each of its own into place as a whole.
void Attempt::take_checkpoint() {
    for (std::uint64_t earlier = m_number - 1; earlier > 0; --earlier) {
        const std::filesystem::path theirs = m_folder.attempt(earlier) / "checkpoint";
        std::error_code code;
        if (!std::filesystem::exists(theirs, code)) continue;
        std::filesystem::copy_file(theirs, m_folder.attempt(m_number) / "checkpoint", std::filesystem::copy_options::overwrite_existing, code);
        if (!code) return;
        log(LogLevel::warning, theirs.string() + ": cannot be taken up: " + code.message());
    }
}

JobExit Attempt::run(const std::filesystem::path& program) {
    take_checkpoint();
    m_folder.tell(m_number, m_news);
    auto worker = WorkerProcess::start(program, to_json(m_order),
                                       {[this](LinkMessage message) {
                                            if (message.is_frame) return;
                                            auto json = parse_json(message.bytes);
                                            if (!json) return;
                                            const std::lock_guard lock(m_mutex);
                                            m_heard.push_back(std::move(*json));
                                            m_came.notify_all();
                                        },
                                        [this](std::string how) {
                                            const std::lock_guard lock(m_mutex);
                                            m_ended = std::move(how);
                                            m_came.notify_all();
                                        }});
    if (!worker) return fail(Outcome::again, worker.error(), true);
    m_worker = std::move(*worker);
    while (true) {
        std::deque<Json> heard;
        std::optional<std::string> ended;
        {
            std::unique_lock lock(m_mutex);
            m_came.wait_for(lock, at_most_waited, [this] { return !m_heard.empty() || m_ended; });
            heard.swap(m_heard);
            ended = m_ended;
        }
        for (const Json& message : heard) hear(message);
        if (ended) return finish(*ended);
        if (was_signalled()) {
            m_was_asked_to_end = true;
            tell_worker({{"do", "finish"}, {"with_report", false}});
        }
        look();
    }
}

void Attempt::hear(const Json& message) {
    const std::string what = message.at("say");
    if (what == "planned") admit(message);
    else if (what == "turn") tell_worker({{"do", "turn"}, {"threads", m_node.cpus}});
    else if (what == "progress") {
        m_news.step = message.at("step");
        m_news.residual = std::min(message.at("residual").get<double>(), 1e300);
        m_news.goal = message.at("goal");
        m_news.lost.reset();
        if (message.contains("lost")) m_news.lost = message.at("lost").get<std::uint64_t>();
    } else if (what == "checkpoint") {
        m_news.trouble = message.contains("error") ? error_from(message.at("error")).text() : std::string();
    } else if (what == "failed") {
        m_failure = error_from(message.at("error"));
        m_is_final = message.at("is_final");
    } else if (what == "done") {
        m_done = message;
    }
}

/// What does not fit into the memory that Slurm has given is refused before the node's own watch ends it.
void Attempt::admit(const Json& plan) {
    constexpr std::uint64_t own = std::uint64_t{64} << 20;  // of this process
    const std::size_t repeats = m_order.flips.empty() ? 1 : plan.at("repeats").get<std::size_t>();
    m_news.points = plan.at("points").get<std::size_t>() * repeats;
    const std::uint64_t bytes = plan.at(m_order.flips.empty() ? "bytes" : "unfolded_bytes");
    if (m_node.memory_bytes > 0 && bytes + own > m_node.memory_bytes) {
        m_failure = Error{ErrorCode::refused,
                          "the cloth needs " + sim::memory_text(bytes + own) + ", and a job gets " + sim::memory_text(m_node.memory_bytes) +
                              " here (slurm.memory_mib of simd's configuration): simulate a part of it, or fewer points",
                          "simulation"};
        m_is_final = true;
        return m_worker->kill();
    }
    const std::uint64_t bound = m_node.memory_bytes > 0 ? m_node.memory_bytes - own : 0;
    tell_worker({{"do", "admitted"}, {"bytes", bound}, {"number", m_order.number}, {"folder", m_order.folder}});
}

void Attempt::tell_worker(const Json& message) {
    static_cast<void>(m_worker->link().post(message));  // its end is heard of
}

/// Whether it is still wanted; and tells how far it is.
void Attempt::look() {
    if (Clock::now() - m_looked < between_looks) return;
    m_looked = Clock::now();
    if (newer()) {
        m_is_stale = true;
        return m_worker->kill();
    }
    const std::optional<Stop> stop = m_folder.is_gone() ? Stop::at_once : m_folder.stop();
    if (stop && stop != m_stop) {
        m_stop = stop;
        if (stop == Stop::with_yarns && m_news.points > 0) {
            tell_worker({{"do", "finish"}, {"with_report", true}});
        } else {
            m_is_unwanted = true;
            m_worker->kill();
        }
    }
    if (m_told == m_news) return;
    m_folder.tell(m_number, m_news);
    m_told = m_news;
}

/// The attempt that has begun since; nothing where this one is the newest.
std::optional<std::uint64_t> Attempt::newer() const {
    const auto newest = m_folder.newest_attempt();
    return newest && *newest > m_number ? std::optional(*newest) : std::nullopt;
}

JobExit Attempt::finish(const std::string& how) {
    if (m_is_unwanted) return JobExit::done;
    if (const auto newest = newer(); newest || m_is_stale) {
        const std::string message = "attempt " + std::to_string(m_number) + " is stale: attempt " + std::to_string(newest.value_or(m_number + 1)) + " has begun since";
        return fail(Outcome::never, {ErrorCode::refused, message, "job " + std::to_string(m_order.number)});
    }
    if (m_done) return hand_in();
    if (m_failure) {
        // What the design does not allow, no node does; a disk or a device may be better elsewhere.
        const bool is_the_nodes_fault = m_failure->code == ErrorCode::system;
        return fail(m_is_final && !is_the_nodes_fault ? Outcome::never : Outcome::again, *m_failure, is_the_nodes_fault);
    }
    if (m_was_asked_to_end) return fail(Outcome::again, system_fault("Slurm has asked it to end"));
    return fail(Outcome::again, system_fault("the worker " + how));
}

JobExit Attempt::hand_in() {
    AttemptEnd end;
    end.input_sha256 = input_sha256(m_order);
    end.node = m_node.name;
    end.was_stopped = m_stop == Stop::with_yarns;
    end.step = m_done->at("step");
    end.report = m_done->at("report");
    const Status written = m_folder.end(m_number, end);
    if (!written) return fail(Outcome::again, written.error(), true);
    return JobExit::done;
}

/// The word of a failure may find no room either: then the daemon sees the job leave the queue without one.
JobExit Attempt::fail(Outcome outcome, Error error, bool is_the_nodes_fault) {
    log(LogLevel::warning, "job " + std::to_string(m_order.number) + ", attempt " + std::to_string(m_number) + ": " + error.text());
    AttemptEnd end;
    end.outcome = outcome;
    end.input_sha256 = input_sha256(m_order);
    end.node = m_node.name;
    end.step = m_news.step;
    end.is_the_nodes_fault = is_the_nodes_fault;
    end.error = std::move(error);
    const Status written = m_folder.end(m_number, end);
    if (!written) log(LogLevel::warning, written.error().text());
    return outcome == Outcome::never ? JobExit::never : JobExit::again;
}

namespace {

/// Whether the newest attempt has left the result of this very order. (One before it was refused, or will be.)
bool is_done(const JobFolder& folder, const WorkOrder& order, std::uint64_t newest) {
    const auto end = folder.end_of(newest);
    return end && *end && (*end)->outcome == Outcome::done && (*end)->input_sha256 == input_sha256(order);
}

Result<JobExit> run_job(const std::filesystem::path& file) {
    const auto place = parse_whole(word_of_environment("SLURM_ARRAY_TASK_ID"));
    if (!place || *place < 0) return Error{ErrorCode::usage, "is started by Slurm alone, as part of an array (SLURM_ARRAY_TASK_ID)", "simd job"};
    WEAVE_TRY(const std::uint64_t number, job_at(file, static_cast<std::uint64_t>(*place)));
    const SharedFolder shared{file.parent_path().parent_path()};
    const JobFolder folder = shared.job(number);
    if (folder.stop()) return JobExit::done;
    WEAVE_TRY(WorkOrder order, folder.order());
    WEAVE_TRY(const std::uint64_t newest, folder.newest_attempt());
    if (is_done(folder, order, newest)) return JobExit::done;
    WEAVE_TRY(const std::uint64_t attempt, folder.begin_attempt());
    return Attempt(folder, std::move(order), attempt, Attempt::node_of_environment()).run(std::filesystem::read_symlink("/proc/self/exe"));
}

}  // namespace

int run_job_of_array(const std::filesystem::path& file) try {
    hold_signals();
    ::umask(0077);
    const auto exit = run_job(file);
    if (exit) return static_cast<int>(*exit);
    log(LogLevel::warning, exit.error().text());
    return static_cast<int>(exit.error().code == ErrorCode::system ? JobExit::again : JobExit::never);
} catch (const std::exception& fault) {
    log(LogLevel::warning, std::string("a fault of the program: ") + fault.what());
    return static_cast<int>(JobExit::again);
}

}  // namespace weave::simd
