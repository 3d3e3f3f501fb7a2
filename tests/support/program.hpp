#pragma once

#include <catch2/catch.hpp>

#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace weave::testing {

/// One of our programs, with its answer in a pipe and what it tells people at the end of a file.
class Program {
  public:
    Program(const std::string& name, std::vector<std::string> words, const std::string& told) {
        int ends[2];
        REQUIRE(::pipe(ends) == 0);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
        posix_spawn_file_actions_addclose(&actions, ends[0]);
        posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, told.c_str(), O_WRONLY | O_CREAT | O_APPEND,
                                         0600);
        words.insert(words.begin(),
                     (std::filesystem::path(WEAVE_PROGRAM).parent_path() / name).string());
        std::vector<char*> pointers;
        for (auto& word : words) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        REQUIRE(::posix_spawn(&m_process, pointers.front(), &actions, nullptr, pointers.data(), ::environ) ==
                0);
        posix_spawn_file_actions_destroy(&actions);
        ::close(ends[1]);
        m_answer = ends[0];
    }
    ~Program() {
        if (m_process > 0) ::kill(m_process, SIGKILL), ::waitpid(m_process, nullptr, 0);
        ::close(m_answer);
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    /// The first line of its answer; what there is of it where the program ends before.
    [[nodiscard]] std::string line() const {
        std::string text;
        for (char c = 0; ::read(m_answer, &c, 1) == 1 && c != '\n';) text += c;
        return text;
    }
    /// All that is left of its answer, until it ends.
    [[nodiscard]] std::string rest() const {
        std::string text;
        for (char c = 0; ::read(m_answer, &c, 1) == 1;) text += c;
        return text;
    }
    void end(int signal) const { ::kill(m_process, signal); }
    /// Stands still when this returns: a signal alone may leave it the time for an answer.
    void suspend() const {
        int status = 0;
        ::kill(m_process, SIGSTOP);
        ::waitpid(m_process, &status, WUNTRACED);
    }
    [[nodiscard]] pid_t process() const { return m_process; }
    /// Waits for its end.
    int exit_code() {
        int status = 0;
        ::waitpid(m_process, &status, 0);
        m_process = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;  // -1: a signal ended it
    }

  private:
    pid_t m_process = 0;
    int m_answer = -1;
};

}  // namespace weave::testing
