#pragma once

#include <cstdio>
#include <string>

namespace weave::bench {

/// A value for people, such as `12.3 ms` by "%.1f ms".
inline std::string form(const char* how, double value) {
    char text[80];
    std::snprintf(text, sizeof text, how, value);
    return text;
}

/// What was measured, with the aim beside it, as a table that people read and Markdown takes.
class AimTable {
  public:
    explicit AimTable(const std::string& heading) : m_text(heading + "\n\n| What | Measured | Aim |\n|---|---|---|\n") {}

    void row(const std::string& what, const std::string& measured, const std::string& aim = "none was set") {
        m_text += "| " + what + " | " + measured + " | " + aim + " |\n";
    }
    /// The same with a judgement.
    void row(const std::string& what, const std::string& measured, const std::string& aim, bool is_reached) {
        row(what, measured, aim + (is_reached ? ": reached" : ": NOT reached"));
    }
    [[nodiscard]] const std::string& text() const { return m_text; }

  private:
    std::string m_text;
};

}  // namespace weave::bench
