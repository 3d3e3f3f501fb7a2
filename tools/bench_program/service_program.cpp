#include "service_program.hpp"

#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <spawn.h>
#include <stdexcept>
#include <sys/wait.h>
#include <tuple>
#include <unistd.h>
#include <utility>

namespace weave::bench {

namespace {

/// Starts a program beside this one; its process, and where its answer can be read.
std::pair<pid_t, int> spawn(const std::string& name, std::vector<std::string> words, const std::filesystem::path& told) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, told.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    words.insert(words.begin(), (std::filesystem::read_symlink("/proc/self/exe").parent_path() / name).string());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    pid_t process = 0;
    const int code = ::posix_spawn(&process, pointers.front(), &actions, nullptr, pointers.data(), ::environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    if (code == 0) return {process, ends[0]};
    ::close(ends[0]);
    throw std::runtime_error("cannot start " + words.front());
}

/// What there is to read up to `end`, or to the end.
std::string read_until(int number, char end) {
    std::string text;
    for (char c = 0; ::read(number, &c, 1) == 1 && c != end;) text += c;
    return text;
}

int wait_for(pid_t process) {
    int status = 0;
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {}
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

WorkFolder::WorkFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "weave-bench-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder to work in");
    m_path = name;
}

WorkFolder::~WorkFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(m_path, ignored);
}

ServiceProgram::ServiceProgram(const std::string& name, std::vector<std::string> words, const std::filesystem::path& told) {
    std::tie(m_process, m_answer) = spawn(name, std::move(words), told);
    const std::string line = read_until(m_answer, '\n');
    auto answer = parse_json(line);
    if (answer && !answer->contains("error")) {
        m_introduction = std::move(*answer);
        return;
    }
    end(SIGKILL);
    throw std::runtime_error(name + " does not serve: " + line);
}

ServiceProgram::~ServiceProgram() {
    if (m_process > 0) end(SIGKILL);
}

int ServiceProgram::end(int signal) {
    ::kill(m_process, signal);
    const int code = wait_for(m_process);
    m_process = 0;
    ::close(m_answer);
    return code;
}

Json answer_of_program(const std::string& name, std::vector<std::string> words, const std::filesystem::path& told) {
    const auto [process, answer] = spawn(name, std::move(words), told);
    const std::string text = read_until(answer, '\0');
    ::close(answer);
    const int code = wait_for(process);
    const auto json = parse_json(text);
    if (code != 0 || !json) throw std::runtime_error(name + " ends with " + std::to_string(code) + ": " + text);
    return *json;
}

}  // namespace weave::bench
