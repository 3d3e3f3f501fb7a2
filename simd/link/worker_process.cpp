#include <simd/link/worker_process.hpp>

#include <weave/core/log.hpp>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

extern char** environ;

namespace weave::simd {

namespace {

/// Where a worker finds its link.
constexpr int link_number = 3;

std::string ended_how(int status) {
    if (WIFSIGNALED(status)) {
        const char* const name = ::strsignal(WTERMSIG(status));
        return std::string("was ended by a signal (") + (name == nullptr ? "unknown" : name) + ")";
    }
    return "ended with status " + std::to_string(WEXITSTATUS(status));
}

/// Descriptors and signals as a worker is to have them.
class SpawnPlan {
  public:
    explicit SpawnPlan(int link) {
        ::posix_spawn_file_actions_init(&m_files);
        ::posix_spawn_file_actions_addopen(&m_files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        ::posix_spawn_file_actions_adddup2(&m_files, STDERR_FILENO, STDOUT_FILENO);
        ::posix_spawn_file_actions_adddup2(&m_files, link, link_number);
        ::posix_spawn_file_actions_addclosefrom_np(&m_files, link_number + 1);
        ::posix_spawnattr_init(&m_attributes);
        sigset_t none;
        sigemptyset(&none);
        ::posix_spawnattr_setsigmask(&m_attributes, &none);
        ::posix_spawnattr_setflags(&m_attributes, POSIX_SPAWN_SETSIGMASK);
    }
    ~SpawnPlan() {
        ::posix_spawn_file_actions_destroy(&m_files);
        ::posix_spawnattr_destroy(&m_attributes);
    }
    SpawnPlan(const SpawnPlan&) = delete;
    SpawnPlan& operator=(const SpawnPlan&) = delete;

    [[nodiscard]] const posix_spawn_file_actions_t* files() const { return &m_files; }
    [[nodiscard]] const posix_spawnattr_t* attributes() const { return &m_attributes; }

  private:
    posix_spawn_file_actions_t m_files{};
    posix_spawnattr_t m_attributes{};
};

}  // namespace

Result<std::unique_ptr<WorkerProcess>> WorkerProcess::start(const std::filesystem::path& program, Json order, Listener listener) {
    WEAVE_TRY(auto ends, Link::pair());
    std::string path = program.string(), word = "worker";
    std::array<char*, 3> words{path.data(), word.data(), nullptr};
    // dup2() onto itself would leave the flag that closes it.
    const Descriptor inherited(::fcntl(ends.second.number(), F_DUPFD_CLOEXEC, link_number + 1));
    if (inherited.number() < 0) return system_fault(std::string("cannot start a worker: ") + std::strerror(errno));
    const SpawnPlan plan(inherited.number());
    pid_t id = 0;
    const int fault = ::posix_spawn(&id, path.c_str(), plan.files(), plan.attributes(), words.data(), environ);
    if (fault != 0) return system_fault(std::string("cannot start a worker: ") + std::strerror(fault));
    return std::unique_ptr<WorkerProcess>(new WorkerProcess(id, std::move(ends.first), std::move(order), std::move(listener)));
}

WorkerProcess::WorkerProcess(pid_t id, Descriptor link, Json order, Listener listener)
    : m_id(id), m_handle(static_cast<int>(::syscall(SYS_pidfd_open, id, 0))), m_link(std::move(link)), m_listener(std::move(listener)),
      m_thread([this, first = std::move(order)] { listen(first); }) {}

WorkerProcess::~WorkerProcess() {
    kill();
    m_thread.join();
    if (m_handle >= 0) ::close(m_handle);
}

void WorkerProcess::kill() {
    if (m_handle >= 0) ::syscall(SYS_pidfd_send_signal, m_handle, SIGKILL, nullptr, 0);
    m_link.cut();
}

void WorkerProcess::listen(const Json& order) {
    static_cast<void>(m_link.send(order));  // where it is gone already, that is found out below
    while (true) {
        auto message = m_link.receive();
        if (!message) log(LogLevel::warning, "a worker was ended: " + message.error().text());
        if (!message || !*message) break;
        m_heard = std::chrono::steady_clock::now();
        m_listener.message(std::move(**message));
    }
    // Whoever has closed the link has nothing more to say, and must not go on computing.
    if (m_handle >= 0) ::syscall(SYS_pidfd_send_signal, m_handle, SIGKILL, nullptr, 0);
    int status = 0;
    while (::waitpid(m_id, &status, 0) < 0 && errno == EINTR) {}
    m_listener.ended(ended_how(status));
}

std::uint64_t WorkerProcess::memory_bytes() const {
    std::ifstream file("/proc/" + std::to_string(m_id) + "/statm");
    std::uint64_t whole = 0, resident = 0;
    file >> whole >> resident;
    return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace weave::simd
