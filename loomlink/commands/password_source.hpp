#pragma once

#include <weave/core/result.hpp>

#include <optional>
#include <string>

namespace weave::loomlink {

/// Where passwords come from: typed at the terminal without being shown, or, for scripts, a line each of a
/// file or of standard input. Never a word of the command line, which every user of the machine can read.
class PasswordSource {
  public:
    /// `file`: empty for the terminal, `-` for standard input. A file that others may read is refused once it
    /// is asked.
    explicit PasswordSource(std::string file) : m_file(std::move(file)) {}
    ~PasswordSource();
    PasswordSource(const PasswordSource&) = delete;
    PasswordSource& operator=(const PasswordSource&) = delete;

    /// The next password; `prompt` says which. Errors: usage where there is no terminal; bad_input where
    /// nothing is left, or more than 1,024 bytes stand on a line.
    Result<std::string> ask(const std::string& prompt);
    /// The same for one that is chosen now: at a terminal it is typed twice.
    Result<std::string> ask_new(const std::string& prompt);

  private:
    Result<std::string> next_line();

    std::string m_file;
    std::optional<std::string> m_rest;  ///< of the file, once it was read
};

}  // namespace weave::loomlink
