#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>

#include <cstdint>
#include <string>

namespace weave {

/// How an answer in JSON is laid out: over lines, to be read by people too, or on one, where answers may
/// follow each other.
enum class JsonLayout : std::uint8_t { over_lines, on_one_line };

/// What every command of a program has: whether another program reads along, and how it ended.
class CommandOutcome {
  public:
    /// `program` is what its messages begin with.
    CommandOutcome(std::string program, JsonLayout layout);

    bool json = false;  ///< a program reads along (--json)
    int exit_code = 0;

    /// Tells the error and remembers its exit code. A program that reads along gets it as the answer,
    /// `{"error": …}`, unless it has had a fuller one.
    void fail(const Error& error);
    /// Remembers that the command was done and found something: exit code 1.
    void found_something() { exit_code = 1; }
    /// A line for people on standard error.
    void note(const std::string& line) const;
    /// The answer: as JSON if a program reads along, else in words, on standard output. Names from outside
    /// must come through on_one_line() in `words`, whose line breaks are kept.
    void answer(const Json& json_answer, const std::string& words);

  private:
    std::string m_program;
    JsonLayout m_layout;
    bool m_answered = false;
};

}  // namespace weave
