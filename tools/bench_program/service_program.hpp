#pragma once

#include <weave/core/json.hpp>

#include <filesystem>
#include <string>
#include <sys/types.h>
#include <vector>

namespace weave::bench {

/// A folder for a benchmark, gone with it.
class WorkFolder {
  public:
    WorkFolder();
    ~WorkFolder();
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return m_path; }

  private:
    std::filesystem::path m_path;
};

/// One of our services, which lies beside this program, at work until the object ends. What goes wrong is an exception: a
/// benchmark has nothing to go on with.
class ServiceProgram {
  public:
    /// Starts it with these words and waits for its first line, which must be JSON. What it tells people goes to the end of `told`.
    ServiceProgram(const std::string& name, std::vector<std::string> words, const std::filesystem::path& told);
    ~ServiceProgram();
    ServiceProgram(const ServiceProgram&) = delete;
    ServiceProgram& operator=(const ServiceProgram&) = delete;

    [[nodiscard]] const Json& introduction() const { return m_introduction; }
    [[nodiscard]] pid_t process() const { return m_process; }
    /// Ends it with a signal, and waits; the exit status, -1 where the signal ended it.
    int end(int signal);

  private:
    pid_t m_process = 0;
    int m_answer = -1;
    Json m_introduction;
};

/// What a program beside this one answers, which must be JSON.
Json answer_of_program(const std::string& name, std::vector<std::string> words, const std::filesystem::path& told);

}  // namespace weave::bench
