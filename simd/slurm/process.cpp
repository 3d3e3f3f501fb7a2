#include <simd/slurm/process.hpp>

#include <weave/core/descriptor.hpp>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace weave::simd {

namespace {

using Clock = std::chrono::steady_clock;

/// No answer that is understood here is longer; the rest is read and thrown away.
constexpr std::size_t most_answer = std::size_t{64} << 20;

struct Pipe {
    Descriptor reading, writing;
};

Result<Pipe> make_pipe() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) return system_fault(std::string("cannot make a pipe: ") + std::strerror(errno));
    return Pipe{Descriptor(ends[0]), Descriptor(ends[1])};
}

/// What this process knows beside may be secret, and would go to every node with a job.
std::vector<std::string> environment() {
    std::vector<std::string> kept;
    for (const char* name : {"PATH", "HOME", "LANG", "SLURM_CONF"}) {
        if (const char* const value = std::getenv(name)) kept.push_back(std::string(name) + "=" + value);
    }
    return kept;
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

Result<pid_t> spawn(std::vector<std::string> words, int answer, int told) {
    std::vector<std::string> known = environment();
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    sigset_t none;
    sigemptyset(&none);
    ::posix_spawn_file_actions_init(&files);
    ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&files, answer, STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&files, told, STDERR_FILENO);
    ::posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
    ::posix_spawnattr_init(&attributes);
    ::posix_spawnattr_setsigmask(&attributes, &none);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    pid_t id = 0;
    const int fault = ::posix_spawnp(&id, words.front().c_str(), &files, &attributes, pointers_to(words).data(), pointers_to(known).data());
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&files);
    if (fault != 0) return system_fault(std::string("cannot be started: ") + std::strerror(fault), words.front());
    return id;
}

/// Takes what there is; false once there is no more to come.
bool take(const Descriptor& from, std::string& into) {
    std::array<char, 65536> bytes{};
    const ssize_t got = ::read(from.number(), bytes.data(), bytes.size());
    if (got < 0) return errno == EINTR || errno == EAGAIN;
    if (into.size() < most_answer) into.append(bytes.data(), static_cast<std::size_t>(got));
    return got > 0;
}

/// Reads both until they end; false where that took too long.
bool listen(const Descriptor& answer, const Descriptor& told, Answered& answered, Clock::time_point late, const std::atomic<bool>& gives_up) {
    constexpr int look_ms = 100;
    std::array<pollfd, 2> both{{{answer.number(), POLLIN, 0}, {told.number(), POLLIN, 0}}};
    while (both[0].fd >= 0 || both[1].fd >= 0) {
        if (Clock::now() > late || gives_up) return false;
        if (::poll(both.data(), both.size(), look_ms) <= 0) continue;
        if (both[0].revents != 0 && !take(answer, answered.answer)) both[0].fd = -1;
        if (both[1].revents != 0 && !take(told, answered.told)) both[1].fd = -1;
    }
    return true;
}

}  // namespace

Result<Answered> run_command(const std::vector<std::string>& words, std::chrono::milliseconds patience, const std::atomic<bool>& gives_up) {
    WEAVE_TRY(Pipe answer, make_pipe());
    WEAVE_TRY(Pipe told, make_pipe());
    WEAVE_TRY(const pid_t id, spawn(words, answer.writing.number(), told.writing.number()));
    ::close(answer.writing.release());
    ::close(told.writing.release());
    Answered answered;
    const bool in_time = listen(answer.reading, told.reading, answered, Clock::now() + patience, gives_up);
    if (!in_time) ::kill(id, SIGKILL);
    int status = 0;
    while (::waitpid(id, &status, 0) < 0 && errno == EINTR) {}
    if (!in_time) return system_fault("does not answer within " + std::to_string(std::chrono::ceil<std::chrono::seconds>(patience).count()) + " s", words.front());
    answered.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return answered;
}

}  // namespace weave::simd
